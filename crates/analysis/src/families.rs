//! Combs of lines, fitted to the recorded motion of the rollers: which polygon makes the tone.
//!
//! Facets that pass the loaded contacts make no single line. What roller j does to a sensor goes with its load Q_j and its
//! place θ_j, and its phase Ψ_j is that of its own facets: N_v times its spin seen from the contact, N_o times its way along
//! the outer raceway, or N_i times that along the inner one. The sum over the rollers,
//!
//! ```text
//! Σ_j Q_j(t) [c₀ + Σ_q a_q cos 2qθ_j + b_q sin 2qθ_j] exp iΨ_j(t)          q = 1 … 3
//! ```
//!
//! repeats whenever a roller has taken the place of the next one: a comb of lines BPFO apart about the carrier, the mean
//! rate of Ψ under load. All of Q, θ and Ψ are recorded, so only the complex weights are fitted, for each sensor and
//! component and for the sums of the contact forces.
//!
//! **The test.** In a band about the carrier, the fit explains the share R² of a channel. The score is the mean of
//! −ln(1 − R² + 0.02) over the accelerations plus that over the forces. It is scanned over offsets of the carrier up to
//! [`SCAN`] BPFO, and over detuned carriers 5 to 20 BPFO away, where the same comb meets what else the record
//! holds: their median is the background and their scatter (1.4826 times the median deviation) the unit. A family is found when its score
//! stands [`LEAST_SIGNIFICANCE`] units above the background, at a maximum within one resolution of the prediction. The family with the highest score is taken first and subtracted; the others must
//! be found again in what is left, so that one line is not claimed twice (THEORY §7.7).

mod comb;
mod lines;

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use self::comb::{Comb, Complex, times, unit};
use crate::Error;

/// Offsets of a carrier that are tried, in BPFO on either side: a comb that stands one spacing off fits well there, too, and
/// must fit best where it belongs.
pub const SCAN: f64 = 1.5;
/// Steps of the scan in a resolution, within [`CLOSE`] resolutions and beyond.
const STEPS: [f64; 2] = [10.0, 2.0];
/// Half width of the part that is scanned in small steps, in resolutions.
const CLOSE: f64 = 1.5;
/// A family stands this many units above its background at least. Scores have longer tails than Gaussian ones: noise
/// has reached 5.3 in 30 ms, the tone of the default scene stands at 17.
pub const LEAST_SIGNIFICANCE: f64 = 8.0;
/// What is left of a channel counts as this share of it at least: a fit to 98 % is not bettered by one to 99 %, which follows
/// the channel's noise.
const LEAST_REST: f64 = 0.02;
/// Scores closer than this are a tie, which the offsets decide.
const TIE: f64 = 0.5;
/// A family that explains less of the accelerations than this, once others are taken out, is too weak to be named.
pub const LEAST_SHARE: f64 = 0.1;
/// Detuned carriers that make the background, in BPFO on either side of the carrier.
const DETUNED: std::ops::RangeInclusive<i32> = 10..=40;
/// Two of them in a BPFO.
const DETUNED_STEP: f64 = 0.5;
/// Periods of BPFO that a record must hold: fewer do not tell a comb from a single line.
pub const LEAST_PERIODS: f64 = 2.0;
/// Sidebands that are listed on either side of the carrier.
pub const SIDEBANDS: i32 = 3;

/// What passes the contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// Vertices of rollers with this many facets whose copies are turned with their place on the pitch circle.
    RotatedVertices(f64),
    /// The same for copies in one orientation.
    TranslatedVertices(f64),
    /// Nodes of the outer raceway, this many a turn.
    OuterNodes(f64),
    /// Nodes of the inner raceway, this many a turn.
    InnerNodes(f64),
}

/// Recorded motion and load of one roller, one value a sample.
#[derive(Debug, Clone)]
pub struct RollerTrack {
    /// Angle of its centre, counter-clockwise, without jumps [rad].
    pub orbit: Vec<f64>,
    /// Accumulated rotation in space, counter-clockwise [rad].
    pub spin: Vec<f64>,
    /// Normal force of the outer raceway [N].
    pub load_n: Vec<f64>,
}

/// What all families need of a record.
#[derive(Debug, Clone)]
pub struct Motion {
    /// Sampling interval [s].
    pub interval_s: f64,
    /// Angular velocity of the inner ring [rad/s], counter-clockwise: negative.
    pub shaft_rad_s: f64,
    /// Rate at which rollers pass a place on the outer raceway [Hz], positive.
    pub bpfo_hz: f64,
    /// Every roller.
    pub rollers: Vec<RollerTrack>,
}

/// One signal in which combs are sought.
#[derive(Debug, Clone)]
pub struct Channel {
    /// Sensor, or what carries the force.
    pub sensor: String,
    /// Component, `ax` or `ay`; `fx` or `fy` of a force.
    pub component: String,
    /// Samples [g or N].
    pub values: Vec<f64>,
}

/// A family that a record may hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Stable name.
    pub name: String,
    /// What makes it.
    pub source: Source,
}

/// One family beside what the record shows of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FamilyFinding {
    /// `roller_vertices`, `outer_race_nodes` or `inner_race_nodes`.
    pub name: String,
    /// Carrier by the fit [Hz]; `None` unless the family is found.
    pub carrier_hz: Option<f64>,
    /// Carrier by the recorded motion: the mean rate of the facets at the contacts, weighted by their load [Hz].
    pub predicted_hz: f64,
    /// Carrier by the fit less the predicted one, in resolutions of the record; that of the best fit when the family is not
    /// found, `None` when nothing was fitted.
    pub offset_resolutions: Option<f64>,
    /// How far the single channels scatter about that offset (standard deviation), in resolutions.
    pub offset_scatter_resolutions: Option<f64>,
    /// Verdict.
    pub found: bool,
    /// How far the score stands above that of detuned combs, in units of their scatter.
    pub significance: Option<f64>,
    /// Share of the accelerations in the band that the comb explains, mean over sensors and components.
    pub explained: Option<f64>,
    /// The same of the contact forces.
    pub explained_forces: Option<f64>,
    /// Largest peak amplitude of its lines [g]; `None` unless it is found.
    pub level_g: Option<f64>,
    /// The verdict in words.
    pub verdict: String,
    /// Carrier and sidebands at every sensor and component; empty unless it is found.
    pub lines: Vec<FamilyLine>,
}

/// One line of a family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FamilyLine {
    /// Its distance from the carrier in BPFO.
    pub sideband: i32,
    /// Fitted carrier and sideband [Hz].
    pub predicted_hz: f64,
    /// Highest peak within half a resolution [Hz]; `None` when none stands 10 dB above its surroundings.
    pub measured_hz: Option<f64>,
    /// Its peak amplitude [g].
    pub level_g: Option<f64>,
    /// Sensor.
    pub sensor: String,
    /// Component, `ax` or `ay`.
    pub component: String,
}

/// Judges every candidate by the accelerations and the contact forces of one record, all channels as long as the tracks.
///
/// # Errors
/// [`Error::Signal`] when the spectrum of a finite channel is refused.
pub fn identify(
    motion: &Motion,
    candidates: &[Candidate],
    accelerations: &[Channel],
    forces: &[Channel],
) -> Result<Vec<FamilyFinding>, Error> {
    let combs: Vec<Option<Comb>> = candidates.iter().map(|c| Comb::of(motion, c.source)).collect();
    let mut findings: Vec<FamilyFinding> =
        candidates.iter().zip(&combs).map(|(c, comb)| FamilyFinding::untested(c, comb.as_ref())).collect();
    if accelerations.is_empty() || motion.periods() < LEAST_PERIODS {
        for finding in &mut findings {
            finding.verdict = format!(
                "not judged: the record holds {:.1} periods of BPFO, a comb needs {LEAST_PERIODS}",
                motion.periods()
            );
        }
        return Ok(findings);
    }
    let mut left = Signals::of(accelerations, forces);
    let mut open: Vec<usize> = (0..candidates.len()).filter(|&n| combs[n].is_some()).collect();
    let mut taken: Option<String> = None;
    while !open.is_empty() {
        let trials: Vec<(usize, Trial)> =
            open.iter().filter_map(|&n| Some((n, left.try_comb(motion, combs[n].as_ref()?)))).collect();
        // Where a comb that stands off its place explains more, the lines are not those of one that happens to stand.
        let highest = trials.iter().map(|(_, trial)| trial.score).fold(0.0, f64::max);
        let best = trials
            .iter()
            .filter(|(_, trial)| trial.stands() && trial.score >= highest - TIE)
            .max_by(|a, b| a.1.merit().total_cmp(&b.1.merit()))
            .map(|(n, trial)| (*n, trial.offset_hz));
        for (n, trial) in &trials {
            findings[*n].judge(trial, motion, taken.as_deref());
        }
        let Some((n, offset_hz)) = best else { break };
        let Some(comb) = combs[n].as_ref() else { break };
        left.subtract(motion, comb, offset_hz);
        findings[n].accept(motion, accelerations)?;
        taken = Some(findings[n].name.clone());
        open.retain(|&other| other != n);
    }
    Ok(findings)
}

impl Motion {
    fn samples(&self) -> usize {
        self.rollers.first().map_or(0, |r| r.orbit.len())
    }

    /// Periods of BPFO on record.
    fn periods(&self) -> f64 {
        self.samples() as f64 * self.interval_s * self.bpfo_hz
    }

    /// One over the length of the record [Hz].
    fn resolution_hz(&self) -> f64 {
        1.0 / (self.samples().max(1) as f64 * self.interval_s)
    }
}

impl Source {
    /// Phase of a roller's facets at its contacts, rising with time for a shaft that turns clockwise [rad].
    fn phase(self, motion: &Motion, roller: &RollerTrack, n: usize) -> f64 {
        let (orbit, spin) = (roller.orbit[n], roller.spin[n]);
        match self {
            Self::RotatedVertices(count) => count * (spin - (orbit - roller.orbit[0])),
            Self::TranslatedVertices(count) => count * (spin - orbit),
            Self::OuterNodes(count) => -count * orbit,
            Self::InnerNodes(count) => count * (orbit - motion.shaft_rad_s * n as f64 * motion.interval_s),
        }
    }
}

/// A comb tried on what is left of the signals.
struct Trial {
    /// Offset of the best fit [Hz].
    offset_hz: f64,
    resolution_hz: f64,
    /// Standard deviation of the single channels' best offsets [Hz].
    scatter_hz: f64,
    score: f64,
    significance: f64,
    explained: f64,
    explained_forces: Option<f64>,
    /// Share of the accelerations in the band that earlier families have left, mean over the channels.
    left: f64,
}

impl Trial {
    /// A maximum within one resolution that stands above the background and is worth a name.
    fn stands(&self) -> bool {
        self.significance >= LEAST_SIGNIFICANCE
            && self.offset_hz.abs() <= self.resolution_hz
            && self.explained * self.left >= LEAST_SHARE
    }

    /// What decides between families that both stand: the score, less half the square of the offset in resolutions. The
    /// motion is recorded, so an offset needs an excuse.
    fn merit(&self) -> f64 {
        self.score - 0.5 * (self.offset_hz / self.resolution_hz).powi(2)
    }
}

/// Channels with their mean taken out; forces behind accelerations.
struct Signals {
    values: Vec<Vec<f64>>,
    /// As they were before anything was subtracted.
    whole: Vec<Vec<f64>>,
    accelerations: usize,
}

impl Signals {
    fn of(accelerations: &[Channel], forces: &[Channel]) -> Self {
        let centred = |channel: &Channel| {
            let mean = channel.values.iter().sum::<f64>() / channel.values.len().max(1) as f64;
            channel.values.iter().map(|v| v - mean).collect()
        };
        let values: Vec<Vec<f64>> = accelerations.iter().chain(forces).map(centred).collect();
        Self { whole: values.clone(), values, accelerations: accelerations.len() }
    }

    /// Power of the accelerations in a comb's band over what it was at first, mean over the channels.
    fn left(&self, motion: &Motion, comb: &Comb) -> f64 {
        let ratio = |(now, then): (&Vec<f64>, &Vec<f64>)| {
            let then = comb.power(then, motion.interval_s);
            if then > 0.0 { comb.power(now, motion.interval_s) / then } else { 0.0 }
        };
        let pairs = self.values.iter().zip(&self.whole).take(self.accelerations);
        pairs.map(ratio).sum::<f64>() / self.accelerations.max(1) as f64
    }

    fn try_comb(&self, motion: &Motion, comb: &Comb) -> Trial {
        let resolution_hz = motion.resolution_hz();
        let shares = |offset: f64| -> Vec<f64> {
            self.values.iter().map(|v| comb.explained(v, motion.interval_s, offset)).collect()
        };
        let near: Vec<(f64, Vec<f64>)> =
            scan(motion).into_iter().map(|offset| (offset, shares(offset))).collect();
        let limit_hz = 0.5 / motion.interval_s;
        let inside = |offset: &f64| {
            let carrier = comb.carrier_hz + offset;
            carrier > comb.half_band_hz && carrier < limit_hz - comb.half_band_hz
        };
        let mut far: Vec<f64> = DETUNED
            .flat_map(|n| [-n, n])
            .map(|n| f64::from(n) * DETUNED_STEP * motion.bpfo_hz)
            .filter(inside)
            .map(|offset| self.score(&shares(offset)))
            .collect();
        let background = median(&mut far);
        let mut deviations: Vec<f64> = far.iter().map(|s| (s - background).abs()).collect();
        let unit = (1.4826 * median(&mut deviations)).max(f64::EPSILON);
        let scored: Vec<f64> = near.iter().map(|(_, shares)| self.score(shares)).collect();
        let best = (0..near.len()).max_by(|&a, &b| scored[a].total_cmp(&scored[b])).unwrap_or(0);
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len().max(1) as f64;
        let (accelerations, forces) = near[best].1.split_at(self.accelerations);
        let single = (0..self.values.len()).map(|channel| {
            let highest = near.iter().max_by(|a, b| a.1[channel].total_cmp(&b.1[channel]));
            highest.map_or(0.0, |(offset, _)| offset - near[best].0)
        });
        let squares: f64 = single.map(|off| off * off).sum();
        Trial {
            offset_hz: near[best].0,
            resolution_hz,
            scatter_hz: (squares / self.values.len() as f64).sqrt(),
            score: scored[best],
            // Without a background there is nothing to stand above.
            significance: if far.is_empty() { 0.0 } else { (scored[best] - background) / unit },
            explained: mean(accelerations),
            left: self.left(motion, comb),
            explained_forces: (!forces.is_empty()).then(|| mean(forces)),
        }
    }

    /// Mean of −ln(1 − R² + [`LEAST_REST`]) over the accelerations plus that over the forces.
    fn score(&self, shares: &[f64]) -> f64 {
        let (accelerations, forces) = shares.split_at(self.accelerations);
        let mean = |part: &[f64]| {
            part.iter().map(|r2| -(1.0 - r2 + LEAST_REST).ln()).sum::<f64>() / part.len().max(1) as f64
        };
        mean(accelerations) + mean(forces)
    }

    /// Takes the fitted comb out of every channel.
    fn subtract(&mut self, motion: &Motion, comb: &Comb, offset_hz: f64) {
        for values in &mut self.values {
            let weights = comb.weights(values, motion.interval_s, offset_hz);
            let mut turn: Complex = (1.0, 0.0);
            let step = unit(TAU * (comb.carrier_hz + offset_hz) * motion.interval_s);
            for (n, value) in values.iter_mut().enumerate() {
                let sum = comb.sum(&weights, n);
                // A real signal is the comb and its mirror image.
                *value -= 2.0 * times(sum, turn).0;
                turn = times(turn, step);
            }
        }
    }
}

impl FamilyFinding {
    /// Whether a family that was found has a line within `reach_hz` of `hz`, its sidebands at `bpfo_hz` included.
    pub fn claims(&self, hz: f64, bpfo_hz: Option<f64>, reach_hz: f64) -> bool {
        let Some(carrier_hz) = self.carrier_hz else { return false };
        let off = hz - carrier_hz;
        (-SIDEBANDS..=SIDEBANDS).any(|m| (off - f64::from(m) * bpfo_hz.unwrap_or(0.0)).abs() <= reach_hz)
    }

    fn untested(candidate: &Candidate, comb: Option<&Comb>) -> Self {
        Self {
            name: candidate.name.clone(),
            carrier_hz: None,
            predicted_hz: comb.map_or(0.0, |c| c.carrier_hz),
            offset_resolutions: None,
            offset_scatter_resolutions: None,
            found: false,
            significance: None,
            explained: None,
            explained_forces: None,
            level_g: None,
            verdict: "not judged: no roller is loaded on record, or the sampling is too slow for its lines"
                .into(),
            lines: Vec::new(),
        }
    }

    /// Writes down what a trial says; `taken` has been subtracted before it.
    fn judge(&mut self, trial: &Trial, motion: &Motion, taken: Option<&str>) {
        let offset = trial.offset_hz / motion.resolution_hz();
        self.offset_resolutions = Some(offset);
        self.offset_scatter_resolutions = Some(trial.scatter_hz / motion.resolution_hz());
        self.significance = Some(trial.significance);
        self.explained = Some(trial.explained);
        self.explained_forces = trial.explained_forces;
        let after =
            taken.map_or(String::new(), |name| format!(" once {} are taken out", name.replace('_', " ")));
        self.verdict = if trial.significance < LEAST_SIGNIFICANCE {
            format!(
                "absent{after}: its comb explains the record {:.1} units better than a detuned one, {LEAST_SIGNIFICANCE:.0} count",
                trial.significance
            )
        } else if trial.stands() {
            "found".into()
        } else if trial.offset_hz.abs() <= trial.resolution_hz && trial.explained * trial.left >= LEAST_SHARE
        {
            format!("not told apart{after}: a comb off its place explains the lines better")
        } else if trial.offset_hz.abs() <= trial.resolution_hz {
            format!(
                "absent{after}: its comb explains {:.1} % of the accelerations, {:.0} % count",
                100.0 * trial.explained * trial.left,
                100.0 * LEAST_SHARE
            )
        } else {
            format!(
                "absent{after}: the lines near it fit best {offset:+.1} resolutions away, and one is allowed"
            )
            .replace('-', "−")
        };
    }

    fn accept(&mut self, motion: &Motion, accelerations: &[Channel]) -> Result<(), Error> {
        self.found = true;
        let carrier_hz = self.predicted_hz + self.offset_resolutions.unwrap_or(0.0) * motion.resolution_hz();
        self.carrier_hz = Some(carrier_hz);
        self.lines = lines::read(accelerations, 1.0 / motion.interval_s, carrier_hz, motion.bpfo_hz)?;
        self.level_g = self.lines.iter().filter_map(|l| l.level_g).max_by(f64::total_cmp);
        let percent = |share: f64| format!("{:.0} %", 100.0 * share);
        self.verdict = format!(
            "found: the comb explains {} of the accelerations{} about it",
            self.explained.map_or_else(String::new, percent),
            self.explained_forces
                .map_or_else(String::new, |f| format!(" and {} of the contact forces", percent(f)))
        );
        Ok(())
    }
}

/// Offsets of the scan [Hz], ascending.
fn scan(motion: &Motion) -> Vec<f64> {
    let resolution_hz = motion.resolution_hz();
    let [small, large] = STEPS.map(|steps| resolution_hz / steps);
    let close = (CLOSE * STEPS[0]).round() as i32;
    let wide = (SCAN * motion.bpfo_hz / large).ceil() as i32;
    let beyond = |n: &i32| f64::from(n.abs()) * large > CLOSE * resolution_hz + 0.5 * small;
    let far = (-wide..=wide).filter(beyond).map(|n| f64::from(n) * large);
    let mut offsets: Vec<f64> = (-close..=close).map(|n| f64::from(n) * small).chain(far).collect();
    offsets.sort_unstable_by(f64::total_cmp);
    offsets
}

fn median(values: &mut [f64]) -> f64 {
    crate::events::median(values)
}

#[cfg(test)]
mod tests;
