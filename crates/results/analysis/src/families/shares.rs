//! Shares of the channels that a comb explains: at one offset, or at the many of a scan.

use super::comb::{AT_ONCE, BasebandComb, Columns, power};
use super::kernels::{Signal, dot};
use super::scan::{Nodes, Offsets, Scan, share};

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
        let mut shares = self.interpolated(comb, fit, offsets_hz);
        let missing: Vec<usize> = (0..shares.len()).filter(|n| shares[*n].is_none()).collect();
        for some in missing.chunks(AT_ONCE) {
            let columns = comb.columns(some.iter().map(|n| (offsets_hz[*n], comb.rate_hz)));
            for (n, columns) in some.iter().zip(columns) {
                shares[*n] = Some(self.shares(fit, &fit.extension(columns)));
            }
        }
        shares.into_iter().flatten().collect()
    }

    /// The same by interpolation; `None` where that would lose digits.
    fn interpolated(&self, comb: &BasebandComb, fit: &Columns, offsets_hz: &[f64]) -> Vec<Option<Vec<f64>>> {
        let blocks = comb.blocks();
        let reach_hz = offsets_hz.iter().fold(0.0, |reach: f64, hz| reach.max(hz.abs()));
        let nodes = Nodes::new(reach_hz, blocks.reach_s);
        let offsets = Offsets::new(offsets_hz, &nodes, &blocks);
        let columns = comb.columns(nodes.hz.iter().map(|hz| (*hz, comb.rate_hz)));
        let (sums, own): (Vec<_>, Vec<_>) = columns.into_iter().map(|c| (c.sums, c.own)).unzip();
        let accelerations: Vec<&Signal> = self.accelerations.iter().collect();
        let [accelerations, forces] = [(sums, accelerations, &fit.sums), (own, vec![&self.forces], &fit.own)]
            .map(|(columns, channels, fit)| {
                Scan::new(&nodes, &blocks, &columns, &channels, fit).shares(&offsets)
            });
        let both = accelerations.into_iter().zip(forces);
        both.map(|(accelerations, forces)| Some([accelerations?, forces?].concat())).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use stribeck_testing::Noise;

    use super::*;
    use crate::families::{RecordedMotion, RollerTrack, Source, scan::WELL_APART};

    /// Twelve rollers under a load that is shared by the cosine, 0.1 s, each of a spin of its own.
    fn motion() -> RecordedMotion {
        let rollers = (0..12).map(|number| {
            let place = TAU * f64::from(number) / 12.0;
            let angles = |hz: f64| (0..SAMPLES).map(move |n| place - TAU * hz * 1e-5 * n as f64);
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

    const SAMPLES: usize = 10_000;
    const OBSERVED: [usize; 3] = [0, 2, 5];
    /// Rounding, over a least pivot of 10⁻⁴ and over the least that is allowed.
    const ALONE: f64 = 1e-11;
    const BESIDE: f64 = 10.0 * f64::EPSILON / WELL_APART;

    fn comb(motion: &RecordedMotion, source: Source) -> BasebandComb {
        BasebandComb::of(motion, source, &OBSERVED).expect("a comb")
    }

    /// Tones of rollers and noise, in the band of a comb.
    fn signals(motion: &RecordedMotion, comb: &BasebandComb) -> Signals {
        let mut noise = Noise::new(3);
        let mut sounding = |number: usize| {
            let tone = |n: usize| (100.0 * motion.rollers[number].spin[n]).cos() + noise.uniform();
            let sound: Vec<f64> = (0..SAMPLES).map(tone).collect();
            comb.baseband.bands(&[&comb.baseband.of_signal(&sound)], &[0.0]).remove(0).remove(0)
        };
        Signals {
            accelerations: vec![sounding(1), sounding(7)],
            forces: Signal::joined(OBSERVED.map(sounding).into_iter()),
        }
    }

    fn alone(signals: &Signals, comb: &BasebandComb, fit: &Columns, hz: f64) -> Vec<f64> {
        let columns = comb.columns([(hz, comb.rate_hz)].into_iter()).remove(0);
        signals.shares(fit, &fit.extension(columns))
    }

    /// Alone, and beside a comb whose carrier is 3 Hz off; near the carrier and as far as scans reach.
    #[test]
    fn invariant_a_scan_explains_what_single_offsets_do() {
        let motion = motion();
        let [comb, other] =
            [Source::RotatedVertices(100.0), Source::OuterNodes(1110.0)].map(|s| comb(&motion, s));
        let signals = signals(&motion, &comb);
        let beside = other.columns([(3.0, comb.rate_hz)].into_iter()).remove(0);
        let beside = Columns::default().extension(beside);
        for (fit, reach, rounding) in [(Columns::default(), 1.5, ALONE), (beside, 5.0, BESIDE)] {
            let offsets_hz: Vec<f64> =
                (-30..=30).map(|n| reach * motion.bpfo_hz * (f64::from(n) / 30.0).powi(3)).collect();
            let scanned = signals.interpolated(&comb, &fit, &offsets_hz);
            for (hz, scanned) in offsets_hz.iter().zip(scanned) {
                let scanned = scanned.expect("columns that are well apart");
                for (a, b) in scanned.iter().zip(alone(&signals, &comb, &fit, *hz)) {
                    assert!((a - b).abs() < rounding, "{hz} Hz: {a} and {b}");
                }
            }
        }
    }

    /// A comb beside itself explains nothing, and there interpolation would lose all digits. Nor do channels
    /// of zeros hold anything, or of no numbers.
    #[test]
    fn invariant_a_scan_beside_the_comb_itself_is_taken_offset_by_offset() {
        let motion = motion();
        let comb = comb(&motion, Source::RotatedVertices(100.0));
        let mut signals = signals(&motion, &comb);
        let values = signals.accelerations[0].len();
        signals.accelerations.extend([0.0, f64::NAN].map(|value| Signal::constant((value, 0.0), values)));
        let own = comb.columns([(0.0, comb.rate_hz)].into_iter()).remove(0);
        let fit = Columns::default().extension(own);
        let offsets_hz = [-200.0, -120.0, 0.0, 120.0, 200.0];
        let interpolated = signals.interpolated(&comb, &fit, &offsets_hz);
        assert_eq!(
            interpolated.iter().map(Option::is_some).collect::<Vec<_>>(),
            [true, true, false, true, true]
        );
        let scanned = signals.scanned(&comb, &fit, &offsets_hz);
        assert_eq!(scanned.len(), offsets_hz.len());
        for (hz, scanned) in offsets_hz.iter().zip(scanned) {
            assert_eq!(scanned[2..4], [0.0; 2], "{hz} Hz");
            for (a, b) in scanned.iter().zip(alone(&signals, &comb, &fit, *hz)) {
                assert!((a - b).abs() < BESIDE, "{hz} Hz: {a} and {b}");
            }
        }
    }
}
