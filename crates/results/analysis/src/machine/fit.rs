//! A machine from measured records of known state: the gain of the path and the background, by third octaves.
//!
//! The power of a record in a third octave is that of the simulated force times the square of the gain, plus
//! that of the background. Gains are found by least squares of the logarithms of these powers over all records
//! of damaged bearings, with the second difference of their logarithms from octave to octave as a
//! regularisation; the background is what a record of the healthy machine has beyond its own force behind this
//! path. Both are found in turns.

use stribeck_dsp::{Sensor, statistics};
use stribeck_scene::machine::{BackgroundScene, GainScene, MachineScene, MachineSensorScene};
use stribeck_scene::scene::BearingScene;

use super::octaves::{Band, third_octaves};
use super::{Force, record};
use crate::Error;

/// Weight of the squared second difference of the gain's logarithm beside the squared misfit in one third
/// octave of one record: a bend of 6 dB from third to third counts as a misfit of 2 dB.
const SMOOTH: f64 = 0.1;
/// Rounds of gains and background in turns, and of the least squares in each; both end earlier when nothing
/// changes.
const ROUNDS: usize = 30;
const STEPS: usize = 20;
/// Largest change of a logarithm of a power in one step.
const LONGEST_STEP: f64 = 3.0;
/// Least share of the healthy record's power that is background: a force that explains more is not known so well.
const LEAST_SHARE: f64 = 0.05;
/// Part of the sample rate up to which records are compared: recorders filter what is above.
const COMPARED: f64 = 0.45;

/// Lowest frequency of a fitted path below its lowest third octave, as a ratio.
const SLOWER: f64 = 10.0;
/// Range of the fitted recorder over the largest sample of the records.
const ROOM: f64 = 10.0;

/// A measured record, and the force of the simulated bearing of its state.
#[derive(Debug, Clone)]
pub struct Known {
    /// Samples a second of the record [Hz].
    pub rate_hz: f64,
    /// The record [m/s²].
    pub measured: Vec<f64>,
    /// The force.
    pub force: Force,
    /// Whether the bearing is sound.
    pub is_sound: bool,
}

/// Third octaves of a record and of its force, as the record's recorder passes them.
#[derive(Debug, Clone)]
struct Octaves {
    measured: Vec<Band>,
    force: Vec<Band>,
    is_sound: bool,
}

impl Known {
    fn octaves(&self, highest_hz: f64) -> Result<Octaves, Error> {
        let force = Sensor::ideal(self.rate_hz)
            .record(&self.force.samples, self.force.rate_hz)
            .map_err(Error::Signal)?;
        Ok(Octaves {
            measured: third_octaves(&self.measured, self.rate_hz, highest_hz)?,
            force: third_octaves(&force, self.rate_hz, highest_hz)?,
            is_sound: self.is_sound,
        })
    }
}

/// The machine of some records, with the sensor of the first: the fitted path includes its resonance.
///
/// # Errors
/// [`Error::NoSignal`] without a record of a damaged bearing, [`Error::Signal`] for one that is too short.
pub fn fit(records: &[Known]) -> Result<MachineScene, Error> {
    let Some(rate_hz) = records.iter().map(|known| known.rate_hz).reduce(f64::min) else {
        return Err(Error::NoSignal("no record of a machine was given".to_owned()));
    };
    let highest_hz = COMPARED * rate_hz;
    let octaves = records.iter().map(|k| k.octaves(highest_hz)).collect::<Result<Vec<_>, _>>()?;
    let (sound, damaged): (Vec<&Octaves>, Vec<&Octaves>) = octaves.iter().partition(|o| o.is_sound);
    let Some(first) = damaged.first() else {
        return Err(Error::NoSignal(
            "a path is fitted on the record of a bearing with a spall of known length: a healthy bearing hardly \
             excites it"
                .to_owned(),
        ));
    };
    let hz: Vec<f64> = first.measured.iter().map(|band| band.hz).collect();
    let mut path = Path { gains: vec![0.0; hz.len()], background: vec![0.0; hz.len()] };
    path.start(&damaged);
    for _ in 0..ROUNDS {
        let before = path.clone();
        path.background = background(&sound, &path.gains);
        path.descend(&damaged);
        let moved = path.gains.iter().zip(&before.gains).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if moved < 1e-4 {
            break;
        }
    }
    let peak = records.iter().flat_map(|known| &known.measured).fold(0.0_f64, |most, x| most.max(x.abs()));
    let gains = hz.iter().zip(&path.gains).map(|(&hz, g)| GainScene { hz, gain: rounded((0.5 * g).exp()) });
    let gains: Vec<GainScene> = gains.collect();
    // Below the fitted octaves it yields as a spring does.
    let below = gains
        .first()
        .map(|first| GainScene { hz: first.hz / SLOWER, gain: rounded(first.gain / (SLOWER * SLOWER)) });
    let levels = hz.iter().zip(&path.background);
    let machine = MachineScene {
        gains: below.into_iter().chain(gains).collect(),
        background: levels.map(|(&hz, p)| BackgroundScene { hz, rms_m_s2: rounded(p.sqrt()) }).collect(),
        sensor: MachineSensorScene {
            rate_hz: records[0].rate_hz,
            // Beyond the record: the gains have what there is of it.
            resonance_hz: 1e6,
            noise_density: 0.0,
            range_m_s2: rounded(ROOM * peak),
            ..MachineSensorScene::default()
        },
        ..MachineScene::default()
    };
    ringing(machine, records)
}

/// How long a path may ring [ms]: from less than the shortest wave to the distance of two passages.
const RINGS_MS: [f64; 12] = [0.0, 0.2, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0];

/// The machine with the ringing that makes the kurtosis of the damaged bearings' records: the gains say nothing of
/// phases, and without ringing impacts are as sharp as gains allow.
fn ringing(machine: MachineScene, records: &[Known]) -> Result<MachineScene, Error> {
    let mut best = (f64::INFINITY, machine.clone());
    for ring_ms in RINGS_MS {
        let mut tried = MachineScene { ring_ms, ..machine.clone() };
        let mut off = 0.0;
        for known in records.iter().filter(|known| !known.is_sound) {
            tried.sensor.rate_hz = known.rate_hz;
            let heard = record(&tried, &BearingScene::default(), &known.force)?;
            let kurtosis = |samples: &[f64]| statistics::kurtosis(samples).map_err(Error::Signal);
            off += (kurtosis(&heard.samples)? / kurtosis(&known.measured)?).ln().powi(2);
        }
        if off < best.0 {
            tried.sensor.rate_hz = machine.sensor.rate_hz;
            best = (off, tried);
        }
    }
    Ok(best.1)
}

/// To four digits.
fn rounded(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let scale = 10_f64.powf(3.0 - x.log10().floor());
    (x * scale).round() / scale
}

/// Logarithms of the squared gains, and powers of the background.
#[derive(Debug, Clone)]
struct Path {
    gains: Vec<f64>,
    background: Vec<f64>,
}

/// What healthy records have beyond their force behind a path; nothing where there is none.
fn background(sound: &[&Octaves], gains: &[f64]) -> Vec<f64> {
    let of = |band: usize| {
        let rest = sound.iter().map(|o| {
            let (all, force) = (o.measured[band].rms.powi(2), o.force[band].rms.powi(2));
            (all - gains[band].exp() * force).max(LEAST_SHARE * all)
        });
        rest.sum::<f64>() / sound.len().max(1) as f64
    };
    (0..gains.len()).map(of).collect()
}

impl Path {
    /// Gains that explain the records without a background.
    fn start(&mut self, damaged: &[&Octaves]) {
        for (band, gain) in self.gains.iter_mut().enumerate() {
            let ratio = |o: &&Octaves| 2.0 * (o.measured[band].rms / o.force[band].rms).ln();
            *gain = damaged.iter().map(ratio).sum::<f64>() / damaged.len() as f64;
        }
    }

    /// Gauss–Newton steps of the least squares, until they are short.
    fn descend(&mut self, damaged: &[&Octaves]) {
        let n = self.gains.len();
        for _ in 0..STEPS {
            // Rows of the symmetric matrix from the diagonal on: a bend joins three neighbours.
            let (mut rows, mut right) = (vec![[0.0; 3]; n], vec![0.0; n]);
            for octaves in damaged {
                for band in 0..n {
                    let passed = self.gains[band].exp() * octaves.force[band].rms.powi(2);
                    let all = passed + self.background[band];
                    let (slope, misfit) = (passed / all, 2.0 * octaves.measured[band].rms.ln() - all.ln());
                    rows[band][0] += slope * slope;
                    right[band] += slope * misfit;
                }
            }
            for middle in 1..n.saturating_sub(1) {
                let (at, weights) = ([middle - 1, middle, middle + 1], [1.0, -2.0, 1.0]);
                let bend: f64 = at.iter().zip(weights).map(|(i, w)| w * self.gains[*i]).sum();
                for (i, w) in at.iter().zip(weights) {
                    right[*i] -= SMOOTH * w * bend;
                    for (beside, v) in weights[i + 1 - middle..].iter().enumerate() {
                        rows[*i][beside] += SMOOTH * w * v;
                    }
                }
            }
            // Where the background hides the force in every record, nothing but its neighbours holds a gain.
            rows.iter_mut().for_each(|row| row[0] += 1e-6);
            let Some(step) = solved(rows, right) else { return };
            let longest = step.iter().map(|step| step.abs()).fold(0.0, f64::max);
            let share = (LONGEST_STEP / longest).min(1.0);
            self.gains.iter_mut().zip(&step).for_each(|(gain, step)| *gain += share * step);
            if longest < 1e-6 {
                return;
            }
        }
    }
}

/// Solves a symmetric system of five diagonals from its rows, each from the diagonal on; `None` where it is not
/// positive definite.
fn solved(mut rows: Vec<[f64; 3]>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let n = rows.len();
    for i in 0..n {
        let pivot = rows[i];
        if pivot[0].is_nan() || pivot[0] <= 0.0 {
            return None;
        }
        for below in 1..pivot.len().min(n - i) {
            let factor = pivot[below] / pivot[0];
            (below..pivot.len()).for_each(|j| rows[i + below][j - below] -= factor * pivot[j]);
            right[i + below] -= factor * right[i];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = rows[i][1..].iter().zip(&right[i + 1..]).map(|(a, x)| a * x).sum();
        right[i] = (right[i] - known) / rows[i][0];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_scene::dice::Dice;
    use stribeck_testing::assert_refused;

    /// Blows of random size at a steady rate, as those of a spall, of a length that grows with `level`.
    fn force(level: f64, seed: u64) -> Force {
        let mut dice = Dice::new(seed);
        let mut samples = vec![0.0; 204_800];
        for at in (100..samples.len() - 100).step_by(476) {
            let size = level * (1.0 + 0.3 * dice.normal());
            samples[at..at + 6].iter_mut().for_each(|f| *f += size);
        }
        samples.iter_mut().for_each(|f| *f += 0.5 * dice.normal());
        Force { rate_hz: 51_200.0, from_s: 0.0, samples }
    }

    fn known(machine: &MachineScene, level: f64, seed: u64) -> Known {
        let force = force(level, seed);
        let of = MachineScene { seed, ..machine.clone() };
        let heard = record(&of, &BearingScene::default(), &force).expect("long enough");
        Known { rate_hz: heard.rate_hz, measured: heard.samples, force, is_sound: level == 0.0 }
    }

    fn planted() -> MachineScene {
        let gain = |&(hz, gain): &(f64, f64)| GainScene { hz, gain };
        let level = |&(hz, rms_m_s2): &(f64, f64)| BackgroundScene { hz, rms_m_s2 };
        MachineScene {
            gains: [(60.0, 0.01), (500.0, 0.02), (2000.0, 0.2), (5000.0, 0.05)].iter().map(gain).collect(),
            background: [(60.0, 0.01), (1000.0, 0.01), (5000.0, 0.03)].iter().map(level).collect(),
            sensor: MachineSensorScene { rate_hz: 25_600.0, resonance_hz: 1e6, ..Default::default() },
            ..MachineScene::default()
        }
    }

    /// A path behind which records were made is found again from one of them and one of the healthy machine, to 1.5
    /// dB where its bearing excites it: a third octave of random blows scatters by half a decibel, and straight
    /// lines between four gains have corners that a smooth path rounds.
    #[test]
    fn planted_a_path_is_found_again() {
        let machine = planted();
        let found = fit(&[known(&machine, 0.0, 1), known(&machine, 40.0, 2)]).expect("records");
        let between = |hz: f64| {
            let pair = machine.gains.windows(2).find(|pair| hz <= pair[1].hz).expect("a pair");
            let share = (hz / pair[0].hz).ln() / (pair[1].hz / pair[0].hz).ln();
            pair[0].gain * (pair[1].gain / pair[0].gain).powf(share)
        };
        for gain in found.gains.iter().filter(|gain| (100.0..4500.0).contains(&gain.hz)) {
            let off_db = 20.0 * (gain.gain / between(gain.hz)).log10();
            assert!(off_db.abs() < 1.5, "{} Hz: {off_db} dB", gain.hz);
        }
    }

    /// The fitted machine predicts the octaves of a record on which it was not fitted.
    #[test]
    fn planted_the_machine_predicts_another_record() {
        let machine = planted();
        let found = fit(&[known(&machine, 0.0, 1), known(&machine, 40.0, 2)]).expect("records");
        let other = known(&machine, 10.0, 3);
        let ours = record(&found, &BearingScene::default(), &other.force).expect("long enough");
        let of = |samples: &[f64]| third_octaves(samples, other.rate_hz, 10_000.0).expect("long");
        let off = crate::machine::octaves::above_db(&of(&ours.samples), &of(&other.measured));
        assert!(crate::machine::octaves::median_size(&off) < 1.0, "{off:?}");
    }

    /// The right side is the matrix times (1, 2, 3, 4); the second matrix has the eigenvalue −1.
    #[test]
    fn by_hand_five_diagonals_are_solved() {
        let rows = vec![[7.0, -4.0, 1.0], [8.0, -4.0, 1.0], [9.0, -4.0, 0.0], [10.0, 0.0, 0.0]];
        let found = solved(rows, vec![2.0, 4.0, 4.0, 30.0]).expect("positive definite");
        assert!(found.iter().zip([1.0, 2.0, 3.0, 4.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        assert_eq!(solved(vec![[1.0, 2.0, 0.0], [1.0, 0.0, 0.0]], vec![1.0, 1.0]), None);
    }

    #[test]
    fn refuses_sound_records_alone() {
        assert_refused(fit(&[known(&planted(), 0.0, 1)]), "spall of known length");
        stribeck_testing::assert_refused(fit(&[]), "no record of a machine");
    }
}
