//! Shares of the channels that a comb explains: at one offset, or at the many of a scan.

use super::comb::{BasebandComb, Columns, extension, power};
use super::kernels::{Signal, dot};
use super::scan::{Nodes, Scan, share};

/// The channels in a band: one signal an acceleration, and the forces one behind the other.
pub(super) struct Signals {
    pub(super) accelerations: Vec<Signal>,
    pub(super) forces: Signal,
}

impl Signals {
    /// Share of each acceleration, and of the forces as the last, that the orthonormal columns of `more`
    /// explain of the residual of those of `fit`, 0 to 1.
    pub(super) fn shares(&self, fit: &Columns, more: &Columns) -> Vec<f64> {
        let share = |signal: &Signal, fit: &[Signal], more: &[Signal]| {
            share(power(more, signal), dot(signal, signal).0 - power(fit, signal))
        };
        let accelerations = self.accelerations.iter().map(|signal| share(signal, &fit.sums, &more.sums));
        accelerations.chain([share(&self.forces, &fit.own, &more.own)]).collect()
    }

    /// The same of a comb in its own band, at each of `offsets_hz`: what it explains beside the orthonormal
    /// columns of `fit`.
    pub(super) fn scanned(&self, comb: &BasebandComb, fit: &Columns, offsets_hz: &[f64]) -> Vec<Vec<f64>> {
        let alone = |hz: f64| {
            let columns = comb.columns([(hz, comb.rate_hz)].into_iter()).remove(0);
            self.shares(fit, &fit.extension(columns))
        };
        let interpolated = self.interpolated(comb, fit, offsets_hz);
        let shares = offsets_hz.iter().zip(interpolated);
        shares.map(|(hz, shares)| shares.unwrap_or_else(|| alone(*hz))).collect()
    }

    /// The same by interpolation; `None` where that would lose digits.
    fn interpolated(&self, comb: &BasebandComb, fit: &Columns, offsets_hz: &[f64]) -> Vec<Option<Vec<f64>>> {
        let blocks = comb.blocks();
        let reach_hz = offsets_hz.iter().fold(0.0, |reach: f64, hz| reach.max(hz.abs()));
        let nodes = Nodes::new(reach_hz, blocks.reach_s);
        let columns = comb.columns(nodes.hz.iter().map(|hz| (*hz, comb.rate_hz)));
        let (sums, own): (Vec<_>, Vec<_>) = columns.into_iter().map(|c| (c.sums, c.own)).unzip();
        let accelerations: Vec<&Signal> = self.accelerations.iter().collect();
        let [accelerations, forces] = [(sums, accelerations, &fit.sums), (own, vec![&self.forces], &fit.own)]
            .map(|(columns, channels, fit)| {
                Scan::new(&blocks, &nodes, &columns, &channels, fit).shares(offsets_hz)
            });
        let both = accelerations.into_iter().zip(forces);
        both.map(|(accelerations, forces)| Some([accelerations?, forces?].concat())).collect()
    }
}

impl Columns {
    /// The part of `columns` that is orthogonal to these, orthonormal.
    pub(super) fn extension(&self, columns: Self) -> Self {
        Self { sums: extension(&self.sums, columns.sums), own: extension(&self.own, columns.own) }
    }

    pub(super) fn append(&mut self, more: Self) {
        self.sums.extend(more.sums);
        self.own.extend(more.own);
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use stribeck_testing::Noise;

    use super::*;
    use crate::families::{RecordedMotion, RollerTrack, Source};

    /// Twelve rollers under a load that is shared by the cosine, 30 ms, each of a spin of its own.
    fn motion() -> RecordedMotion {
        let rollers = (0..12).map(|number| {
            let place = TAU * f64::from(number) / 12.0;
            let angles = |hz: f64| (0..3000).map(move |n| place - TAU * hz * 1e-5 * f64::from(n));
            let orbit: Vec<f64> = angles(4.0).collect();
            let load_n = orbit.iter().map(|angle| 1e4 * angle.sin().max(0.0)).collect();
            RollerTrack { place, orbit, spin: angles(-40.0 - 0.1 * f64::from(number)).collect(), load_n }
        });
        RecordedMotion {
            interval_s: 1e-5,
            shaft_rad_s: -TAU * 9.0,
            outer_rad_s: 0.0,
            bpfo_hz: 48.0,
            rollers: rollers.collect(),
        }
    }

    /// Alone, and beside another comb in the fit; near the carrier and as far as scans reach.
    #[test]
    fn invariant_a_scan_explains_what_single_offsets_do() {
        let motion = motion();
        let observed = [0, 2, 5];
        let comb = |source| BasebandComb::of(&motion, source, &observed).expect("a comb");
        let comb_of_nodes = comb(Source::OuterNodes(600.0));
        let (comb, other) = (comb(Source::RotatedVertices(100.0)), comb_of_nodes);
        let mut noise = Noise::new(3);
        let mut sounding = |number: usize| {
            let roller = &motion.rollers[number];
            let tone = |n: usize| (100.0 * roller.spin[n]).cos() + noise.uniform();
            let sound: Vec<f64> = (0..3000).map(tone).collect();
            comb.baseband.bands(&[&comb.baseband.of_signal(&sound)], &[0.0]).remove(0).remove(0)
        };
        let signals = Signals {
            accelerations: vec![sounding(1), sounding(7)],
            forces: Signal::joined(observed.map(&mut sounding).into_iter()),
        };
        let beside = other.columns([(3.0, comb.rate_hz)].into_iter()).remove(0);
        let beside = Columns::default().extension(beside);
        for (fit, reach) in [(Columns::default(), 1.5), (beside, 5.0)] {
            let offsets_hz: Vec<f64> =
                (-30..=30).map(|n| reach * motion.bpfo_hz * (f64::from(n) / 30.0).powi(3)).collect();
            let scanned = signals.interpolated(&comb, &fit, &offsets_hz);
            for (hz, scanned) in offsets_hz.iter().zip(scanned) {
                let columns = comb.columns([(*hz, comb.rate_hz)].into_iter()).remove(0);
                let alone = signals.shares(&fit, &fit.extension(columns));
                for (a, b) in scanned.expect("columns that are well apart").iter().zip(alone) {
                    // Rounding over the square of the least column's part that is left.
                    assert!((a - b).abs() < 1e-9, "{hz} Hz: {a} and {b}");
                }
            }
        }
    }
}
