//! Ragged edges of spalls: how much of them is gone where a roller meets them in its present passage (THEORY §6.4).

use std::f64::consts::{PI, TAU};

use crate::{
    bearing::Bearing,
    modal::parameters::Ragged,
    rollers::block::Block,
    row::{lanes, of_one},
};

impl Bearing {
    /// Draws for all rollers at the angle of the inner ring [rad]. A draw holds for a passage, from the place opposite
    /// to the spall to that place again.
    pub(crate) fn draw_edges(&self, shaft: f64, blocks: &mut [Block]) {
        let speeds = &self.operation.speeds;
        for (k, (ragged, ring)) in self.ragged.iter().zip([speeds.outer, speeds.shaft]).enumerate() {
            if ragged.by == 0.0 || speeds.shaft == 0.0 {
                continue;
            }
            let turns = shaft / speeds.shaft;
            for block in &mut *blocks {
                for lane in lanes(block.bits) {
                    let roller = block.first + lane;
                    let [x, y] = of_one(&block.centre, lane);
                    let seen = libm::atan2(y, x) - turns * ring;
                    let rolled = self.rollers.starts[roller].angle + turns * (speeds.cage - ring);
                    // Counted by rolling, placed by where it is: slip moves a passage and adds none.
                    let angle = seen + TAU * ((rolled - seen) / TAU).round();
                    block.contacts[k].ragged[lane] =
                        ragged.gone(roller, ((angle - ragged.at + PI) / TAU).floor());
                }
            }
        }
    }
}

impl Ragged {
    /// How much is gone for a roller in one of its passages [m].
    fn gone(&self, roller: usize, passage: f64) -> f64 {
        let key = [self.seed, roller as u64, passage as i64 as u64];
        let bits = key.iter().fold(0, |bits, part| mixed(bits ^ part));
        self.by * (bits >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A step of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014, §4).
fn mixed(bits: u64) -> u64 {
    let z = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
