//! Speed and load over time, and the defect's family over the angle of the shaft (THEORY §7.11).
//!
//! Where the speed changes, a family has no frequency: it has an order, its number of periods in a turn of
//! the shaft. The squared envelope of the leading sensor, whose resonances are constant in time, is averaged
//! over equal steps of the shaft's angle, which the run records as a tachometer would; its spectrum then has
//! the family's lines at their orders.
//!
//! Families of raceways and rollers are in proportion to the difference of both rings' speeds. Where the
//! outer ring turns, too, their orders count turns of the shaft against it, and the angle is that between the
//! rings.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};
use stribeck_dsp::{
    Detrend, Envelope, PeriodCount, PeriodVerdict, Scaling, Spectrum, Welch, WelchOptions, Window,
    means_over_angle,
};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Run;
use stribeck_theory::kinematics::Kinematics;

use crate::Error;
use crate::defect::Shocks;
use crate::enveloping::band_hz;
use crate::kinematics::{KinematicsFinding, mean};
use crate::record::Record;
use crate::tones;
use stribeck_diagnosis::Defect;
use stribeck_diagnosis::quantities;

/// Steps of the angle that the envelope is averaged over, in a turn: a line at the last harmonic that is
/// looked for loses less than 2 %.
const STEPS_PER_TURN: usize = 1024;
/// Harmonics of the family that are looked for.
const HARMONICS: usize = 6;
/// The grid of the spectrum is finer than its resolution by at least this factor: a run has few turns, and a
/// line must have room beside its prediction.
const FINER: usize = 4;
/// Fewest steps for a spectrum.
const LEAST_STEPS: usize = 256;

/// Load on the housing along its direction, recorded where it changes.
pub const LOAD: &str = "adapter.load_n";

quantities! {
    /// Speed, load and orders of a run whose speed or load changes.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct DutyFinding {
        /// Least and largest speed on record, clockwise positive [1/min].
        pub speed_rpm: (f64, f64),
        /// The same of the outer ring.
        #[serde(default)]
        pub outer_speed_rpm: (f64, f64),
        /// The same of the shaft against the outer ring.
        #[serde(default)]
        pub relative_speed_rpm: (f64, f64),
        /// Least and largest load on record [N].
        pub load_n: (f64, f64),
        /// Turns of the shaft against the outer ring on record, both ways counted.
        pub turns: f64,
        /// Name and order of each family: periods in a turn of the shaft relative to the outer ring, without
        /// slip.
        pub orders: Vec<(String, f64)>,
        /// The defect's family over the angle; `None` with the reason in `notes`.
        pub envelope: Option<OrderEnvelope>,
    }
}

quantities! {
    /// Lines of the envelope spectrum at the defect's orders.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct OrderEnvelope {
        /// Name of the family.
        pub family: String,
        /// Band whose envelope was taken [Hz].
        pub band_hz: (f64, f64),
        /// Periods of the defect in the record.
        pub periods: f64,
        /// Resolution of the spectrum: one over the turns on record.
        pub resolution: f64,
        /// Each line of the family.
        pub lines: Vec<OrderLine>,
    }
}

quantities! {
    /// One line of a family.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct OrderLine {
        /// Multiple of the family's order.
        pub harmonic: usize,
        /// Predicted order without slip.
        pub predicted: f64,
        /// The same from the recorded motion.
        pub from_motion: Option<f64>,
        /// Measured order; `None` when nothing stands out.
        pub measured: Option<f64>,
        /// Height above the surroundings [dB].
        pub prominence_db: Option<f64>,
    }
}

impl DutyFinding {
    /// Of a scene and its record; `None` where nothing changes.
    pub fn of(scene: &ResolvedScene, record: &Record<'_>) -> Option<Self> {
        let duty = scene.varying_duty()?;
        let [from_s, until_s] = record.stretch_s();
        let recorded = record.channel(LOAD).filter(|load| !load.is_empty()).map(|load| {
            load.iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], n| [least.min(*n), most.max(*n)])
        });
        let k = Kinematics::new(&scene.written.bearing, 60.0);
        // In space the cage has the outer ring's motion on top, which keeps no proportion to the difference
        // of speeds.
        let cage = match scene.written.operation.outer_turns() {
            true => "FTF against the outer ring",
            false => order_name(Defect::Ftf),
        };
        let families = [
            (order_name(Defect::Bpfo), k.bpfo_hz),
            (order_name(Defect::Bpfi), k.bpfi_hz),
            (order_name(Defect::Bsf), 2.0 * k.bsf_hz),
            (cage, k.cage_hz),
        ];
        Some(Self {
            speed_rpm: duty.speed_range_rpm(from_s, until_s).into(),
            outer_speed_rpm: duty.outer_speed_range_rpm(from_s, until_s).into(),
            relative_speed_rpm: duty.relative_range_rpm(from_s, until_s).into(),
            load_n: recorded.unwrap_or_else(|| duty.load_range_n(until_s)).into(),
            turns: turns(record)
                .map_or(0.0, |turns| turns.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>()),
            orders: families.map(|(name, order)| (name.to_owned(), order)).to_vec(),
            envelope: None,
        })
    }

    /// Whether a speed changes on record, so that nothing has a frequency.
    pub fn is_unsteady(&self) -> bool {
        [self.speed_rpm, self.outer_speed_rpm].iter().any(|(least, most)| least != most)
    }

    /// Whether the outer ring turns.
    pub fn outer_turns(&self) -> bool {
        self.outer_speed_rpm != (0.0, 0.0)
    }

    /// The rotation whose turns orders count, in words.
    pub fn over(&self) -> &'static str {
        if self.outer_turns() { "shaft against the outer ring" } else { "shaft" }
    }
}

/// Mean force of all rollers along the load over the record [N]: the run's own number, with a changing load
/// averaged over the part the record lasts.
pub fn expected_support_n(run: &Run, record: &Record<'_>) -> f64 {
    let of_run = run.info.expected_support_n;
    let recorded = record.channel(LOAD).and_then(|load| mean(load.iter().copied()));
    recorded.map_or(of_run, |load_n| of_run - run.scene.duty.mean_load_n(run.scene.duration) + load_n)
}

/// Why orders are not those of the shaft; `None` where they are.
pub fn note(scene: &Scene) -> Option<String> {
    scene.operation.outer_turns().then(|| {
        "orders count turns of the shaft against the outer ring: BPFO, BPFI and BSF go with the difference \
         of both speeds, and in turns of the shaft alone they have no order while the ratio of the speeds \
         changes. What turns in space — the shaft, the outer ring, the cage, and the sidebands that they \
         make — has none over this angle, and is not given"
            .into()
    })
}

/// Shocks of the first defect of a scene in one turn of the shaft against the outer ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShockOrder {
    /// The damaged part.
    pub defect: Defect,
    /// Shocks a turn: twice the order of BSF for a rolling element.
    pub order: f64,
}

impl ShockOrder {
    /// Without slip; `None` for a scene without a defect.
    pub fn of(scene: &ResolvedScene) -> Option<Self> {
        // At one turn a second hertz are orders.
        let shocks =
            Shocks::of(*scene.written.faults().first()?, &Kinematics::new(&scene.written.bearing, 60.0));
        Some(Self { defect: shocks.defect, order: shocks.hz })
    }

    /// Name of the order.
    pub fn name(self) -> &'static str {
        order_name(self.defect)
    }
}

/// Name of the order of a family's shocks in files and tables.
fn order_name(defect: Defect) -> &'static str {
    if defect == Defect::Bsf { "2·BSF" } else { defect.name() }
}

/// Turns of the shaft against the outer ring at each sample, rising where it turns its main way; `None` when
/// they were not recorded.
pub fn turns(record: &Record<'_>) -> Option<Vec<f64>> {
    let angle = record.relative_angle()?;
    let back = angle.last()? < angle.first()?;
    let turn = if back { -1.0 / TAU } else { 1.0 / TAU };
    Some(angle.iter().map(|rad| turn * rad).collect())
}

/// Order of a family by the recorded motion: the rates of passing both raceways add up to the relative speed
/// of the rings times the number of rollers.
pub fn moved(defect: Defect, motion: &KinematicsFinding) -> Option<f64> {
    let outer = motion.bpfo_hz? / motion.relative_hz;
    let order = match defect {
        Defect::Bpfi => motion.pockets() - outer,
        Defect::Bsf => 2.0 * motion.roller_spin_hz? / motion.relative_hz,
        Defect::Bpfo | Defect::Ftf => outer,
    };
    Some(order).filter(|order| order.is_finite())
}

/// Order spectrum of the squared envelope of `signal_g` [g⁴], with orders as frequencies, and the lines at
/// the orders of `family`; the reason when there is none. `turns` is the angle of the shaft against the outer
/// ring at each sample.
pub fn over_angle(
    signal_g: &[f64],
    sample_rate_hz: f64,
    turns: &[f64],
    family: ShockOrder,
    moved: Option<f64>,
) -> Result<Result<(Spectrum, OrderEnvelope), String>, Error> {
    if turns.windows(2).any(|pair| pair[1] < pair[0]) {
        return Ok(Err("no order spectrum: the angle turns back on the way".into()));
    }
    let (name, order) = (family.name(), family.order);
    let made = turns.last().zip(turns.first()).map_or(0.0, |(last, first)| last - first);
    let Ok(count) = PeriodCount::new(made, order) else {
        return Ok(Err("no order spectrum: the rings stand still against each other".into()));
    };
    if count.verdict() == PeriodVerdict::TooFew || made * (STEPS_PER_TURN as f64) < LEAST_STEPS as f64 {
        return Ok(Err(format!(
            "no order spectrum: {made:.2} turns hold {:.1} periods of {name}, {} are the least",
            count.periods(),
            PeriodCount::ENOUGH
        )));
    }
    let band = band_hz(sample_rate_hz);
    let mut squared = vec![0.0; signal_g.len()];
    Envelope::in_band(sample_rate_hz, signal_g.len(), band.0, band.1)
        .and_then(|mut envelope| envelope.process(signal_g, &mut squared))
        .map_err(Error::Signal)?;
    squared.iter_mut().for_each(|a| *a *= *a);
    let means = means_over_angle(&squared, turns, STEPS_PER_TURN).map_err(Error::Signal)?;
    let options = WelchOptions {
        window: Window::Hann,
        detrend: Detrend::Constant,
        scaling: Scaling::Spectrum,
        nfft: (FINER * means.len()).next_power_of_two(),
        ..WelchOptions::new(means.len())
    };
    // A step is a sample and a turn a second, so the spectrum's hertz are orders.
    let spectrum = Welch::new(STEPS_PER_TURN as f64, means.len(), &options)
        .and_then(|mut welch| welch.estimate(&means))
        .map_err(Error::Signal)?;
    let mut lines = tones::harmonics(&[(name.to_owned(), order)], HARMONICS, 0.5 * STEPS_PER_TURN as f64);
    for line in &mut lines {
        line.from_motion_hz = moved.map(|order| order * line.harmonic as f64);
    }
    let measured = tones::measure("envelope", &lines, &spectrum)?;
    let finding = OrderEnvelope {
        family: name.to_owned(),
        band_hz: band,
        periods: count.periods(),
        resolution: spectrum.resolution().resolution_hz,
        lines: measured
            .iter()
            .map(|t| OrderLine {
                harmonic: t.harmonic,
                predicted: t.predicted_hz,
                from_motion: t.from_motion_hz,
                measured: t.measured_hz,
                prominence_db: t.prominence_db,
            })
            .collect(),
    };
    Ok(Ok((spectrum, finding)))
}
