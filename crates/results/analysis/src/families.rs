//! Combs of lines, fitted to the recorded motion of the rollers: which polygon makes the tone.
//!
//! Facets that pass the loaded contacts do not make a single line. The contribution of roller j to a sensor
//! is proportional to its load Q_j, depends on its place θ_j, and its phase Ψ_j is that of its own facets:
//! N_v times its spin seen from the contact, N_o times its way along the outer raceway, or N_i times that
//! along the inner one. The sum over the rollers,
//!
//! ```text
//! Σ_j Q_j(t) [c₀ + Σ_q a_q cos 2qθ_j + b_q sin 2qθ_j] exp iΨ_j(t)          q = 1 … 3
//! ```
//!
//! repeats whenever a roller has taken the place of the next one: a comb of lines BPFO apart. All of Q, θ and
//! Ψ are recorded, so only the seven complex weights are fitted: to each acceleration separately, and to the
//! forces on the most loaded rollers together. A roller's force has its own term of the sum alone, and all
//! rollers have one set of weights, because the effect of facets at a place does not depend on the roller
//! that is there.
//!
//! **The test.** A fit explains the share R² of a channel, in a band about the mean rate of Ψ. Its *score* is
//! the mean of −ln(1 − R² + 0.02) over the accelerations plus that over the forces, its best within half a
//! resolution (one over the length of the record) of the recorded motion. Other explanations of the same
//! channels are *rivals*: the same comb where it does not belong, 5 to 20 BPFO away, and the combs of the
//! other families. A family is **found** when its score leads every rival by [`LEAST_LEAD`], and is highest
//! where it belongs. Families that lead all detuned combs but not each other are **not resolved**. One that
//! was found stays in the fit while the others are tried on the residual; there a comb must also lead its own
//! copies at neighbouring frequencies, because the residual of a fit concentrates about the fitted lines.
//! A family that was not found is absent only if no line stands [`STANDING_DB`] above its surroundings where
//! the recorded motion puts its carrier; otherwise the record leaves it open.
//! Source of the limit, and how often noise reaches it: THEORY §7.7.

mod comb;
mod kernels;
mod lines;
mod products;
mod scan;
mod shares;
mod trial;

use serde::{Deserialize, Serialize};

use self::comb::BasebandComb;
use self::lines::Spectra;
use self::trial::{Channels, Trial};
use crate::Error;
use stribeck_diagnosis::quantities;

/// The least lead of a score that counts: its residual is then 26 % smaller than that of any rival. On
/// records that were not used to choose it, one false comb in some hundreds leads by it
/// (THEORY §7.7).
pub const LEAST_LEAD: f64 = 0.3;
/// A peak that stands this far above its surroundings [dB] at the place of a carrier is not said to be absent.
/// At places where no family has lines, one of ten accelerations holds one in 4 % of the records.
pub const STANDING_DB: f64 = 9.0;
/// Periods of BPFO that a record must hold: with fewer, a comb cannot be distinguished from a single line.
pub const LEAST_PERIODS: f64 = 2.0;
/// Periods of BPFO in which families are sought, at the end of a longer record: the fit takes a time that
/// grows faster than them.
pub const MOST_PERIODS: f64 = 32.0;
/// Sidebands that are listed on either side of the carrier.
pub const SIDEBANDS: i32 = 3;

/// Facets that pass the contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// Vertices of rollers with this many facets whose copies are turned with their place on the pitch
    /// circle.
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
    /// Angle of its centre at the start of the run [rad].
    pub place: f64,
    /// Angle of its centre, counter-clockwise, without jumps [rad].
    pub orbit: Vec<f64>,
    /// Accumulated rotation in space, counter-clockwise [rad].
    pub spin: Vec<f64>,
    /// Normal force of the outer raceway [N].
    pub load_n: Vec<f64>,
}

/// Recorded motion, as all families need it.
#[derive(Debug, Clone)]
pub struct RecordedMotion {
    /// Sampling interval [s].
    pub interval_s: f64,
    /// Angular velocity of the inner ring [rad/s], counter-clockwise: negative.
    pub shaft_rad_s: f64,
    /// The same of the outer ring; zero where it stands still.
    pub outer_rad_s: f64,
    /// Rate at which rollers pass a place on the outer raceway [Hz], positive.
    pub bpfo_hz: f64,
    /// Every roller.
    pub rollers: Vec<RollerTrack>,
}

/// An acceleration in which combs are sought.
#[derive(Debug, Clone)]
pub struct Channel {
    /// Sensor.
    pub sensor: String,
    /// Component, `ax` or `ay`.
    pub component: String,
    /// Samples [g].
    pub values: Vec<f64>,
}

/// A family that a record may hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Stable name.
    pub name: String,
    /// The facets that make it.
    pub source: Source,
}

quantities! {
    /// One family, predicted and measured.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct FamilyFinding {
        /// `roller_vertices`, `outer_race_nodes` or `inner_race_nodes`.
        pub name: String,
        /// Carrier by the fit [Hz]; `None` when the family is not found or not judged.
        pub carrier_hz: Option<f64>,
        /// Carrier by the recorded motion [Hz]: the line of the comb next to the mean rate of the facets at
        /// loaded contacts; `None` when no comb was made of it.
        pub predicted_hz: Option<f64>,
        /// Carrier by the fit less the predicted one, in resolutions of the record; when the family is not
        /// found, that of the best fit within 1.5 BPFO.
        pub offset_resolutions: Option<f64>,
        /// How far the single channels scatter about that offset (standard deviation), in resolutions.
        pub offset_scatter_resolutions: Option<f64>,
        /// True when the record holds this family and no other explains its lines as well.
        pub found: bool,
        /// Families that explain the same lines as well: at least one of them and this one is present, and
        /// the record does not resolve which.
        pub not_told_apart_from: Vec<String>,
        /// How far the score leads that of the best rival; negative when a rival explains more.
        pub lead: Option<f64>,
        /// Share of the accelerations in the band that the comb explains, mean over sensors and components.
        pub explained: Option<f64>,
        /// The same of the forces on the loaded rollers.
        pub explained_forces: Option<f64>,
        /// Largest peak amplitude of its lines [g]; `None` when there is no carrier or no line stands out.
        pub level_g: Option<f64>,
        /// How far the highest peak within half a resolution of the predicted carrier stands above its
        /// surroundings [dB], over all sensors and components, of a family that was not found.
        #[serde(default)]
        pub standing_db: Option<f64>,
        /// The verdict in words.
        pub verdict: String,
        /// Carrier and sidebands at every sensor and component; empty without a carrier.
        pub lines: Vec<FamilyLine>,
    }
}

quantities! {
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
}

/// The sample before which a record holds more than [`MOST_PERIODS`].
pub(crate) fn too_early(samples: usize, interval_s: f64, bpfo_hz: f64) -> Option<usize> {
    let most = (MOST_PERIODS / (bpfo_hz * interval_s)).floor().max(1.0);
    // A bearing that hardly turns has no such number.
    let most = most.is_finite().then_some(most as usize)?;
    samples.checked_sub(most).filter(|from| *from > 0)
}

/// Judges every candidate by the accelerations, all as long as the tracks, and by the forces on the rollers,
/// over the last [`MOST_PERIODS`] of the record.
pub fn identify(
    motion: &RecordedMotion,
    candidates: &[Candidate],
    accelerations: &[Channel],
) -> Result<Vec<FamilyFinding>, Error> {
    if let Some(from) = motion.too_early() {
        let late = |channel: &Channel| Channel { values: channel.values[from..].to_vec(), ..channel.clone() };
        let accelerations: Vec<Channel> = accelerations.iter().map(late).collect();
        return identify(&motion.from(from), candidates, &accelerations);
    }
    let observed = trial::observed(motion);
    let case = |candidate| Case::of(motion, candidate, &observed);
    let mut cases: Vec<Case> = candidates.iter().map(case).collect();
    let slowest_hz = cases.iter().filter_map(|c| Some(c.comb.as_ref()?.rate_hz)).reduce(f64::min);
    if let Some(slowest_hz) = slowest_hz
        && !accelerations.is_empty()
        && motion.periods() >= LEAST_PERIODS
    {
        judge(motion, &Channels::of(motion, accelerations, &observed, slowest_hz), &mut cases);
    }
    // A record that is too short to be judged may be too short for a spectrum.
    let heard = if cases.iter().any(|case| case.trial.is_some()) { accelerations } else { &[] };
    let spectra = Spectra::of(heard, 1.0 / motion.interval_s, motion.bpfo_hz)?;
    Ok((0..cases.len()).map(|n| finding(motion, &spectra, &cases, n)).collect())
}

/// A candidate on trial.
struct Case<'a> {
    name: &'a str,
    /// `None` where the record cannot contain it.
    comb: Option<BasebandComb>,
    /// The last trial and how far it leads.
    trial: Option<(Trial, f64)>,
    verdict: Verdict,
}

#[derive(Debug, Clone, PartialEq)]
enum Verdict {
    Open,
    Found,
    /// Another case explains the same lines.
    Confused(Vec<usize>),
}

impl<'a> Case<'a> {
    fn of(motion: &RecordedMotion, candidate: &'a Candidate, observed: &[usize]) -> Self {
        let comb = BasebandComb::of(motion, candidate.source, observed);
        Self { name: &candidate.name, comb, trial: None, verdict: Verdict::Open }
    }

    /// Its name in running text.
    fn spoken(&self) -> String {
        self.name.replace('_', " ")
    }

    /// Whether it is there and has its carrier or a sideband within `reach_hz` of a frequency.
    fn has_line(&self, hz: f64, bpfo_hz: f64, reach_hz: f64) -> bool {
        let (Some(comb), Some((trial, _))) = (&self.comb, &self.trial) else { return false };
        let carrier_hz = comb.line_hz + trial.offset_hz;
        self.verdict != Verdict::Open && is_line_of(carrier_hz, bpfo_hz, hz, reach_hz)
    }
}

/// Whether a carrier or one of its sidebands lies within `reach_hz` of `hz`.
fn is_line_of(carrier_hz: f64, bpfo_hz: f64, hz: f64, reach_hz: f64) -> bool {
    (-SIDEBANDS..=SIDEBANDS).any(|m| (hz - carrier_hz - f64::from(m) * bpfo_hz).abs() <= reach_hz)
}

/// Tries all cases, accepts the best one that leads its rivals, and repeats on the residual until none does.
fn judge(motion: &RecordedMotion, channels: &Channels, cases: &mut [Case<'_>]) {
    // The case that was accepted last, and those that explained as much before it was.
    let mut last: Option<(usize, Vec<(usize, Trial)>)> = None;
    loop {
        let in_fit: Vec<(&BasebandComb, f64)> = cases
            .iter()
            .filter(|c| c.verdict != Verdict::Open)
            .filter_map(|c| Some((c.comb.as_ref()?, c.trial.as_ref()?.0.offset_hz)))
            .collect();
        let mut trials: Vec<(usize, Trial)> = Vec::new();
        for (n, case) in cases.iter().enumerate().filter(|(_, c)| c.verdict == Verdict::Open) {
            trials.extend(case.comb.as_ref().map(|comb| (n, channels.try_comb(motion, comb, &in_fit))));
        }
        if let Some((accepted, ties)) = last.take() {
            for (n, alone) in ties {
                // A case that adds nothing to the accepted comb and explains as much alone may be the true
                // one.
                if trials.iter().any(|(other, trial)| *other == n && !trial.stands()) {
                    trials.retain(|(other, _)| *other != n);
                    confuse(cases, accepted, n, alone);
                }
            }
        }
        for (n, trial) in &trials {
            cases[*n].trial = Some((trial.clone(), trial.lead()));
        }
        let standing = trials.iter().filter(|(_, trial)| trial.stands());
        let Some((n, best)) = standing.max_by(|a, b| a.1.score.total_cmp(&b.1.score)).cloned() else { break };
        let others: Vec<(usize, Trial)> = trials.into_iter().filter(|(other, _)| *other != n).collect();
        let lead = others.iter().map(|(_, trial)| best.score - trial.score).fold(best.lead(), f64::min);
        let ties = others.into_iter().filter(|(_, trial)| best.score - trial.score < LEAST_LEAD).collect();
        cases[n].verdict = Verdict::Found;
        cases[n].trial = Some((best, lead));
        last = Some((n, ties));
    }
}

/// Marks case `n`, which `alone` explains as much as the accepted one, as not distinguishable from it.
fn confuse(cases: &mut [Case<'_>], accepted: usize, n: usize, alone: Trial) {
    let lead = alone.score - cases[accepted].trial.as_ref().map_or(0.0, |(trial, _)| trial.score);
    cases[n].trial = Some((alone, lead));
    for (one, other) in [(accepted, n), (n, accepted)] {
        match &mut cases[one].verdict {
            Verdict::Confused(others) => others.push(other),
            verdict => *verdict = Verdict::Confused(vec![other]),
        }
    }
}

/// The finding of case `n`.
fn finding(motion: &RecordedMotion, spectra: &Spectra<'_>, cases: &[Case<'_>], n: usize) -> FamilyFinding {
    let case = &cases[n];
    let predicted_hz = case.comb.as_ref().map(|comb| comb.line_hz);
    let mut finding = FamilyFinding {
        name: case.name.to_owned(),
        carrier_hz: None,
        predicted_hz,
        offset_resolutions: None,
        offset_scatter_resolutions: None,
        found: case.verdict == Verdict::Found,
        not_told_apart_from: Vec::new(),
        lead: None,
        explained: None,
        explained_forces: None,
        level_g: None,
        standing_db: None,
        verdict: not_judged(motion, case),
        lines: Vec::new(),
    };
    let Some((trial, lead)) = &case.trial else { return finding };
    let resolution_hz = motion.resolution_hz();
    let there = case.verdict != Verdict::Open;
    let offset_hz = if there { trial.offset_hz } else { trial.highest_hz };
    finding.offset_resolutions = Some(offset_hz / resolution_hz);
    finding.offset_scatter_resolutions = Some(trial.scatter_hz / resolution_hz);
    finding.lead = Some(*lead);
    finding.explained = Some(trial.explained);
    finding.explained_forces = Some(trial.explained_forces);
    if let Some(predicted_hz) = predicted_hz.filter(|_| there) {
        let carrier_hz = predicted_hz + offset_hz;
        finding.carrier_hz = Some(carrier_hz);
        finding.lines = spectra.lines(carrier_hz);
        finding.level_g = finding.lines.iter().filter_map(|l| l.level_g).max_by(f64::total_cmp);
    } else {
        finding.standing_db = predicted_hz.and_then(|hz| spectra.prominence_db(hz));
    }
    finding.verdict = match &case.verdict {
        Verdict::Found => format!(
            "found: its comb explains {:.0} % of the accelerations and {:.0} % of the roller forces about it",
            100.0 * trial.explained,
            100.0 * trial.explained_forces
        ),
        Verdict::Confused(others) => {
            let names: Vec<String> = others.iter().map(|&other| cases[other].spoken()).collect();
            finding.not_told_apart_from = others.iter().map(|&other| cases[other].name.to_owned()).collect();
            format!(
                "not distinguishable from {}: a comb is there, and this record does not show whose",
                names.join(" and ")
            )
        }
        Verdict::Open => {
            let found: Vec<String> =
                cases.iter().filter(|c| c.verdict != Verdict::Open).map(Case::spoken).collect();
            let beside =
                if found.is_empty() { String::new() } else { format!(" beside {}", found.join(" and ")) };
            let why = if *lead >= LEAST_LEAD {
                let off = finding.offset_resolutions.unwrap_or(f64::NAN).abs();
                format!(
                    ". It leads combs of any other place, but fits best {off:.2} resolutions from where the \
                     recorded motion puts it; half a resolution counts"
                )
            } else {
                ", no more than a comb of any other place".to_owned()
            };
            let verdict = if finding.is_open() {
                let db = finding.standing_db.unwrap_or(f64::NAN);
                let hz = predicted_hz.unwrap_or(f64::NAN);
                let also: Vec<String> = cases
                    .iter()
                    .filter(|other| other.has_line(hz, motion.bpfo_hz, 0.5 * resolution_hz))
                    .map(|other| format!(", where {} have one, too", other.spoken()))
                    .collect();
                format!(
                    "open: a line stands {db:.0} dB above its surroundings at {hz:.0} Hz, its place{}; its comb",
                    also.concat()
                )
            } else {
                "absent: it".to_owned()
            };
            format!(
                "{verdict} explains {:.0} % of the accelerations and {:.0} % of the roller \
                 forces{beside}{why}",
                100.0 * trial.explained,
                100.0 * trial.explained_forces
            )
        }
    };
    finding
}

/// Why a case has no verdict.
fn not_judged(motion: &RecordedMotion, case: &Case<'_>) -> String {
    if motion.periods() < LEAST_PERIODS {
        return format!(
            "not judged: the record holds {:.1} periods of BPFO, a comb needs {LEAST_PERIODS}",
            motion.periods()
        );
    }
    let why = match case.comb {
        None => "no roller is loaded on record, or the sampling is too slow for its lines",
        Some(_) => "no sensor is on record",
    };
    format!("not judged: {why}")
}

impl RecordedMotion {
    fn samples(&self) -> usize {
        self.rollers.first().map_or(0, |r| r.orbit.len())
    }

    /// Periods of BPFO on record.
    fn periods(&self) -> f64 {
        self.samples() as f64 * self.interval_s * self.bpfo_hz
    }

    /// The sample before which there are more than [`MOST_PERIODS`] on record.
    fn too_early(&self) -> Option<usize> {
        too_early(self.samples(), self.interval_s, self.bpfo_hz)
    }

    /// The motion from sample `from` on.
    fn from(&self, from: usize) -> Self {
        let late = |roller: &RollerTrack| RollerTrack {
            place: roller.place,
            orbit: roller.orbit[from..].to_vec(),
            spin: roller.spin[from..].to_vec(),
            load_n: roller.load_n[from..].to_vec(),
        };
        Self { rollers: self.rollers.iter().map(late).collect(), ..self.clone() }
    }

    /// One over the length of the record [Hz].
    fn resolution_hz(&self) -> f64 {
        1.0 / (self.samples().max(1) as f64 * self.interval_s)
    }
}

impl Source {
    /// Phase of a roller's facets at its contacts, rising with time for a shaft that turns clockwise [rad].
    fn phase(self, motion: &RecordedMotion, roller: &RollerTrack, n: usize) -> f64 {
        let (orbit, spin) = (roller.orbit[n], roller.spin[n]);
        match self {
            Self::RotatedVertices(count) => count * (spin - (orbit - roller.place)),
            Self::TranslatedVertices(count) => count * (spin - orbit),
            Self::OuterNodes(count) => -count * (orbit - motion.outer_rad_s * n as f64 * motion.interval_s),
            Self::InnerNodes(count) => count * (orbit - motion.shaft_rad_s * n as f64 * motion.interval_s),
        }
    }
}

impl FamilyFinding {
    /// Whether a line stands where a family that was not found would have its carrier.
    pub fn is_open(&self) -> bool {
        self.carrier_hz.is_none() && self.standing_db.is_some_and(|db| db >= STANDING_DB)
    }

    /// Whether a family that is there has a line within `reach_hz` of `hz`, its sidebands at `bpfo_hz`
    /// included.
    pub fn claims(&self, hz: f64, bpfo_hz: Option<f64>, reach_hz: f64) -> bool {
        self.carrier_hz.is_some_and(|carrier_hz| is_line_of(carrier_hz, bpfo_hz.unwrap_or(0.0), hz, reach_hz))
    }

    /// Its name in running text, with those that cannot be distinguished from it.
    pub fn spoken(&self) -> String {
        let names: Vec<String> =
            [&self.name].into_iter().chain(&self.not_told_apart_from).map(|n| n.replace('_', " ")).collect();
        names.join(" or ")
    }
}
