//! The record of a machine's sensor: the force of the rolling elements on the outer ring behind a path, in a
//! background, by a sensor.
//!
//! The path is linear and does not act back on the bearing, so that the record follows from the force after the
//! run, exactly. [`fit`] finds path and background from measured records; [`octaves`] sets records side by
//! side.

pub mod agreement;
pub mod fit;
pub mod octaves;

use std::f64::consts::TAU;

use stribeck_dsp::{Mode, Response, Sensor};
use stribeck_scene::dice::Dice;
use stribeck_scene::machine::{BackgroundScene, MachineScene, MachineSensorScene};
use stribeck_scene::scene::{BearingScene, Scene};
use stribeck_store::run_dir::Run;

use crate::Error;
use crate::load::support;
use crate::record::Record;

/// Name of the channel of such a record.
pub const CHANNEL: &str = "sensor.machine.a_m_s2";

/// Beginning of a run that is left out of the record, in which its bearing settles [s], and its largest share.
const SETTLES_S: f64 = 0.05;
const MOST_OF: f64 = 0.1;

/// Width of a third octave over its middle: 2^(1/6) − 2^(−1/6).
const WIDTH: f64 = 0.231_56;

/// A record of a machine's sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineRecord {
    /// Samples a second [Hz].
    pub rate_hz: f64,
    /// Time of the first sample in the run [s].
    pub from_s: f64,
    /// Accelerations [m/s²].
    pub samples: Vec<f64>,
}

/// A force sampled evenly.
#[derive(Debug, Clone, PartialEq)]
pub struct Force {
    /// Samples a second [Hz].
    pub rate_hz: f64,
    /// Time of the first sample in the run [s].
    pub from_s: f64,
    /// Force [N].
    pub samples: Vec<f64>,
}

impl Force {
    /// The force of the rolling elements on the outer ring in the direction of a machine's sensor, without the
    /// beginning of the run.
    pub fn of_run(run: &Run, direction_deg: f64) -> Result<Self, Error> {
        let record = Record::whole(run)?;
        let (s, c) = direction_deg.to_radians().sin_cos();
        let mut samples = support(&record, [-c, -s]);
        let rate_hz = record.sample_rate_hz();
        let settled = ((SETTLES_S * rate_hz) as usize).min((MOST_OF * samples.len() as f64) as usize);
        samples.drain(..settled);
        Ok(Self { rate_hz, from_s: (settled + 1) as f64 / rate_hz, samples })
    }
}

/// The record of a run's machine; `None` where its scene has none.
///
/// # Errors
/// When the run cannot be read, or is too short for a record.
pub fn of_run(run: &Run) -> Result<Option<MachineRecord>, Error> {
    let Some(machine) = run.scene.written.housing.machine() else { return Ok(None) };
    let force = Force::of_run(run, machine.direction_deg)?;
    record(machine, &run.scene.written.bearing, &force).map(Some)
}

/// The record of a machine's sensor under a force.
///
/// # Errors
/// [`Error::Signal`] for a force of fewer than 16 samples, or a sensor faster than it.
pub fn record(machine: &MachineScene, bearing: &BearingScene, force: &Force) -> Result<MachineRecord, Error> {
    let highest_hz = 0.5 * force.rate_hz;
    let mut dice = Dice::new(machine.seed);
    let mut samples =
        path(machine, bearing, highest_hz)?.through(&force.samples, force.rate_hz).map_err(Error::Signal)?;
    let background = machine.background(highest_hz);
    let noise = coloured(&background, samples.len(), force.rate_hz, &mut dice)?;
    samples.iter_mut().zip(noise).for_each(|(x, n)| *x += n);
    for line in &machine.lines {
        let (turn, by) = (TAU * dice.share(), TAU * line.hz / force.rate_hz);
        if line.comb {
            // A pulse is one sample wide, between two samples shared by both; a train of them has all multiples.
            let period = force.rate_hz / line.hz;
            let (count, size) = (samples.len() as f64 - 1.0, 0.5 * line.amplitude_m_s2 * period);
            let at = (0..).map(|n| (turn / TAU + f64::from(n)) * period).take_while(|at| *at < count);
            for at in at {
                let share = at.fract();
                samples[at as usize] += (1.0 - share) * size;
                samples[at as usize + 1] += share * size;
            }
            continue;
        }
        let wave = |n: usize| line.amplitude_m_s2 * (turn + by * n as f64).cos();
        samples.iter_mut().enumerate().for_each(|(n, x)| *x += wave(n));
    }
    let sensor = sensor(&machine.sensor, dice.bits());
    let samples = sensor.record(&samples, force.rate_hz).map_err(Error::Signal)?;
    Ok(MachineRecord { rate_hz: sensor.rate_hz, from_s: force.from_s, samples })
}

fn path(machine: &MachineScene, bearing: &BearingScene, highest_hz: f64) -> Result<Response, Error> {
    let mut paths = Vec::new();
    if !machine.gains.is_empty() {
        let (hz, gains): (Vec<f64>, Vec<f64>) = machine.gains.iter().map(|g| (g.hz, g.gain)).unzip();
        let plain = Response::of_gains(&hz, &gains, highest_hz).map_err(Error::Signal)?;
        let rings = machine.ring_ms > 0.0;
        let path = if rings { plain.ringing(1e-3 * machine.ring_ms).map_err(Error::Signal)? } else { plain };
        paths.push(path);
    }
    let modes = machine.path_modes(bearing);
    if !modes.is_empty() {
        let mode = |m: &stribeck_scene::machine::PathModeScene| {
            let mass = m.gain.abs().recip();
            let mode = Mode::new(mass, mass * (TAU * m.hz).powi(2), m.damping)?;
            Ok(if m.gain < 0.0 { mode.against() } else { mode })
        };
        let modes = modes
            .iter()
            .filter(|m| m.gain != 0.0)
            .map(mode)
            .collect::<Result<Vec<_>, _>>()
            .map_err(Error::Signal)?;
        paths.push(Response::of_modes(modes).map_err(Error::Signal)?);
    }
    Ok(Response::sum(paths))
}

/// Noise with these levels in third octaves.
fn coloured(
    background: &[BackgroundScene],
    count: usize,
    rate_hz: f64,
    dice: &mut Dice,
) -> Result<Vec<f64>, Error> {
    if background.iter().all(|band| band.rms_m_s2 == 0.0) {
        return Ok(vec![0.0; count]);
    }
    let white: Vec<f64> = (0..count).map(|_| dice.normal()).collect();
    // White noise of unit variance has a density of two over the sample rate.
    let gain = |band: &BackgroundScene| {
        (band.rms_m_s2 * (0.5 * rate_hz / (WIDTH * band.hz)).sqrt()).max(f64::MIN_POSITIVE.sqrt())
    };
    let (hz, gains): (Vec<f64>, Vec<f64>) = background.iter().map(|band| (band.hz, gain(band))).unzip();
    let response = Response::of_gains(&hz, &gains, 0.5 * rate_hz).map_err(Error::Signal)?;
    response.through(&white, rate_hz).map_err(Error::Signal)
}

fn sensor(of: &MachineSensorScene, seed: u64) -> Sensor {
    Sensor {
        rate_hz: of.rate_hz,
        resonance: Some((of.resonance_hz, of.quality)),
        noise_density: of.noise_density,
        range: of.range_m_s2,
        bits: u32::try_from(of.bits).ok(),
        seed,
    }
}

/// Sampling interval [µs] of a run whose force makes records of this rate: an even part of theirs, and 50 kHz or
/// more.
pub fn interval_us(rate_hz: f64) -> f64 {
    const LEAST_HZ: f64 = 50_000.0;
    1e6 / (rate_hz * (LEAST_HZ / rate_hz).ceil().max(1.0))
}

/// What is usual and not given of the machine of a scene, in words.
pub fn assumed(scene: &Scene) -> Option<String> {
    scene.housing.machine().and_then(MachineScene::assumed)
}

#[cfg(test)]
mod tests {
    use super::octaves::third_octaves;
    use super::*;
    use stribeck_scene::machine::{GainScene, MachineLineScene};

    fn white(count: usize, seed: u64) -> Force {
        let mut dice = Dice::new(seed);
        let samples = (0..count).map(|_| 100.0 + 3.0 * dice.normal()).collect();
        Force { rate_hz: 51_200.0, from_s: 0.0, samples }
    }

    fn machine(text: &str) -> MachineScene {
        let scene = Scene::parse(
            &format!("(bearing: \"6205\", model: reduced(), film: None, housing: machine({text}))"),
            "machine.ron",
        );
        scene.expect("a machine").housing.machine().expect("there").clone()
    }

    fn quiet(gain: f64) -> MachineScene {
        MachineScene {
            gains: vec![GainScene { hz: 1000.0, gain }],
            ..machine("background: [(hz: 1000, rms_m_s2: 0)], sensor: (noise_density: 0, resonance_hz: 1e6)")
        }
    }

    fn heard(machine: &MachineScene, force: &Force) -> MachineRecord {
        record(machine, &BearingScene::default(), force).expect("long enough")
    }

    /// A path of one gain passes a force unchanged, and its mean not at all.
    #[test]
    fn planted_a_flat_path_passes_the_force() {
        let force = white(51_200, 3);
        let record = heard(&quiet(0.02), &force);
        assert_eq!((record.rate_hz, record.samples.len()), (25_600.0, 25_600));
        let [ours, theirs] = [
            (&record.samples, record.rate_hz),
            (&force.samples.iter().map(|f| 0.02 * (f - 100.0)).collect(), force.rate_hz),
        ]
        .map(|(samples, rate_hz)| third_octaves(samples, rate_hz, 5000.0).expect("long"));
        for (ours, theirs) in ours.iter().zip(&theirs) {
            // Both are the same samples below the recorder's filter, by other segments at other rates.
            assert!((ours.rms / theirs.rms - 1.0).abs() < 0.02, "{ours:?} {theirs:?}");
        }
    }

    /// A comb has as much power in each multiple: in an octave of 2 kHz and 50 Hz 28 lines, of 0.1 m/s² each.
    #[test]
    fn by_hand_a_comb_has_all_its_multiples() {
        let line = MachineLineScene { hz: 50.0, amplitude_m_s2: 0.1, comb: true };
        let of = MachineScene { lines: vec![line], ..quiet(1e-9) };
        let record = heard(&of, &white(204_800, 1));
        let found = third_octaves(&record.samples, record.rate_hz, 4000.0).expect("long");
        let power: f64 = found
            .iter()
            .filter(|band| band.hz > 1500.0 && band.hz < 2600.0)
            .map(|band| band.rms.powi(2))
            .sum();
        let lines = (2000.0 * (2.0_f64.sqrt() - 0.5_f64.sqrt()) / 50.0).floor();
        // A line at an end of the octave is in or out.
        assert!((power / (0.5 * 0.1 * 0.1 * lines) - 1.0).abs() < 1.5 / lines, "{power}");
    }

    /// A background has its levels. A third octave of n Hz over T seconds has a relative scatter of 1/√(nT) of
    /// its power; the lowest one here has 115 Hz over 4 s.
    #[test]
    fn planted_a_background_has_its_levels_and_lines() {
        let bands = [(500.0, 0.1), (1000.0, 0.2), (2000.0, 0.4), (4000.0, 0.2)];
        let text: String = bands.map(|(hz, rms)| format!("(hz: {hz}, rms_m_s2: {rms}),")).concat();
        let mut of = machine(&format!("background: [{text}], sensor: (noise_density: 0, resonance_hz: 1e6)"));
        of.gains = vec![GainScene { hz: 1000.0, gain: 1e-9 }];
        of.lines = vec![MachineLineScene { hz: 100.0, amplitude_m_s2: 0.5, comb: false }];
        let record = heard(&of, &white(204_800, 1));
        let found = third_octaves(&record.samples, record.rate_hz, 5000.0).expect("long");
        let at = |hz: f64| found.iter().find(|band| (band.hz / hz - 1.0).abs() < 0.01).expect("a band").rms;
        for (hz, rms) in bands {
            // 5 % of the power, four times, half of it in the amplitude; and the corner of the levels.
            assert!((at(hz) / rms - 1.0).abs() < 0.12, "{hz} Hz: {}", at(hz));
        }
        // That octave holds the line and what the noise has below its lowest level.
        assert!((at(99.2) / 0.5_f64.hypot(0.0) * 2.0_f64.sqrt() - 1.0).abs() < 0.05, "{}", at(99.2));
        assert_eq!(heard(&of, &white(204_800, 1)), record);
        assert_ne!(heard(&MachineScene { seed: 2, ..of }, &white(204_800, 1)), record);
    }
}
