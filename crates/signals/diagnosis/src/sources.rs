//! Several bearings and gears in one record: whose is a comb?
//!
//! Each bearing is judged at the speed of its own shaft. Lines of all other shafts and of the gears, with
//! their sidebands, are the machine's own and nobody's defect, and the places of other bearings explain what
//! stands there. Afterwards claims that share their lines are given to the one that they fit (THEORY §7.13).

use std::fmt;

use stribeck_dsp::channel::Channel;
use stribeck_theory::catalogue::CatalogueBearing;

use crate::Error;
use crate::families::unrelated::SLIP;
use crate::{Analysis, Defect, Family, Machine};

/// A part of a machine that makes lines, and how fast its shaft turns.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Its kind.
    pub source: Source,
    /// Speed of its shaft over the one that is given.
    pub ratio: f64,
}

/// A machine element that makes lines.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// A bearing.
    Bearing(CatalogueBearing),
    /// A gear with this number of teeth.
    Gear(u32),
}

/// Largest ratio of two shafts.
const LARGEST_RATIO: f64 = 1000.0;
/// Most teeth of a gear.
const MOST_TEETH: u32 = 2000;

impl Component {
    /// From text such as `bearing=NU 205, ratio=2.5` or `gear=23, ratio=1`; without a ratio it is 1. `bearing`
    /// finds a bearing by its name, such as [`CatalogueBearing::parse`].
    ///
    /// # Errors
    /// The problem, and the remedy.
    pub fn parse(
        text: &str,
        bearing: impl FnOnce(&str) -> Result<CatalogueBearing, String>,
    ) -> Result<Self, String> {
        const FORM: &str = "such as \"bearing=NU 205, ratio=2.5\" or \"gear=23, ratio=1\"";
        let (ratios, rest): (Vec<&str>, Vec<&str>) =
            text.split(',').map(str::trim).partition(|word| word.starts_with("ratio"));
        let ratio = match ratios[..] {
            [] => 1.0,
            [word] => {
                let number = word.split_once('=').and_then(|(_, number)| number.trim().parse::<f64>().ok());
                number.filter(|r| *r > 0.0 && *r <= LARGEST_RATIO).ok_or_else(|| {
                    format!(
                        "`{word}`: the speed of its shaft over that of `--speed-rpm`, above 0 and at most \
                         {LARGEST_RATIO}, {FORM}"
                    )
                })?
            }
            _ => return Err(format!("`{text}` has several ratios: one shaft has one, {FORM}")),
        };
        let rest = rest.join(", ");
        let (kind, what) = rest.split_once('=').ok_or_else(|| format!("`{text}` is no component, {FORM}"))?;
        let source = match kind.trim() {
            "bearing" => Source::Bearing(bearing(what.trim())?),
            "gear" => {
                let teeth = what.trim().parse::<u32>().ok().filter(|z| (2..=MOST_TEETH).contains(z));
                Source::Gear(teeth.ok_or_else(|| {
                    format!("`gear={}`: the number of its teeth, 2 to {MOST_TEETH}, {FORM}", what.trim())
                })?)
            }
            other => return Err(format!("`{other}` is neither `bearing` nor `gear`: {FORM}")),
        };
        Ok(Self { source, ratio })
    }

    /// The bearing, if it is one.
    pub fn bearing(&self) -> Option<&CatalogueBearing> {
        match &self.source {
            Source::Bearing(bearing) => Some(bearing),
            Source::Gear(_) => None,
        }
    }
}

impl fmt::Display for Component {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.source {
            Source::Bearing(bearing) => write!(out, "{} at {} times the shaft", bearing.name, self.ratio),
            Source::Gear(teeth) => write!(out, "gear with {teeth} teeth at {} times the shaft", self.ratio),
        }
    }
}

/// What else turns in the machine of a bearing, in multiples of the speed of its shaft.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surroundings {
    /// Other shafts.
    pub shafts: Vec<f64>,
    /// Meshes of gears.
    pub meshes: Vec<f64>,
    /// Combs that defects of other bearings would make, without slip.
    pub combs: Vec<f64>,
}

impl Surroundings {
    /// Of one component among all.
    fn of(at: usize, all: &[Component]) -> Self {
        let own = all[at].ratio;
        let mut around = Self::default();
        for (n, other) in all.iter().enumerate() {
            let ratio = other.ratio / own;
            if ratio != 1.0 && !around.shafts.contains(&ratio) {
                around.shafts.push(ratio);
            }
            match &other.source {
                Source::Gear(teeth) => around.meshes.push(f64::from(*teeth) * ratio),
                Source::Bearing(bearing) if n != at => {
                    let combs = bearing.orders().map(|o| [o.bpfo, o.bpfi, 2.0 * o.bsf]);
                    around.combs.extend(combs.into_iter().flatten().map(|order| order * ratio));
                }
                Source::Bearing(_) => (),
            }
        }
        around
    }
}

/// The bearings of a record, each with its analysis, in the order of the components.
#[derive(Debug, Clone)]
pub struct Sources {
    /// Bearing and analysis.
    pub bearings: Vec<(Component, Analysis)>,
    /// The conclusion, bearing by bearing.
    pub verdict: String,
}

/// Analyses a channel for several components; `machine` has the speed of the shaft whose ratio is 1.
///
/// # Errors
/// As [`Analysis::of`]; [`Error::NoSignal`] where no component is a bearing.
pub fn analyse(
    channel: &Channel,
    rate_hz: f64,
    machine: &Machine,
    components: &[Component],
) -> Result<Sources, Error> {
    let mut order: Vec<usize> =
        (0..components.len()).filter(|at| components[*at].bearing().is_some()).collect();
    if order.is_empty() {
        return Err(Error::NoSignal(
            "none of the components is a bearing: add one, such as \"bearing=6205, ratio=1\"".to_owned(),
        ));
    }
    // The shaft that is given comes first: its lines correct the speed of all.
    order.sort_by(|a, b| {
        let off = |at: &usize| components[*at].ratio.ln().abs();
        off(a).total_cmp(&off(b)).then(a.cmp(b))
    });
    let (mut speed_rpm, mut exact) = (machine.speed_rpm, machine.speed_is_exact);
    let mut found: Vec<(usize, Component, Analysis)> = Vec::new();
    for at in order {
        let component = &components[at];
        let own = Machine {
            speed_rpm: speed_rpm.map(|rpm| rpm * component.ratio),
            bearing: component.bearing().cloned(),
            speed_is_exact: exact,
            around: Surroundings::of(at, components),
            ..machine.clone()
        };
        let analysis = Analysis::of(channel, rate_hz, &own)?;
        if !exact && component.ratio == 1.0 {
            (speed_rpm, exact) = (analysis.findings.speed_rpm, true);
        }
        found.push((at, component.clone(), analysis));
    }
    found.sort_by_key(|(at, _, _)| *at);
    let mut bearings: Vec<(Component, Analysis)> = found.into_iter().map(|(_, c, a)| (c, a)).collect();
    share_out(&mut bearings);
    let mut all = Vec::new();
    for (component, analysis) in &mut bearings {
        let findings = &mut analysis.findings;
        findings.conclude_again();
        all.push(format!("{component}: {}", findings.verdict));
    }
    Ok(Sources { bearings, verdict: all.join(" ") })
}

#[derive(Debug, Clone, Copy)]
struct Claim {
    bearing: usize,
    family: usize,
    comb_hz: f64,
    /// Distance from its place, over that.
    off: f64,
    height_db: f64,
    shaft_hz: f64,
    cage_hz: f64,
}

/// Multiples and sidebands by which one comb may account for another.
const MULTIPLES: u32 = 5;
const SIDEBANDS: i32 = 4;
/// Lines nearer than this to one another are one, in resolutions.
const SAME_LINE: f64 = 1.5;

/// Withdraws claims whose lines are those of another bearing's claim.
fn share_out(bearings: &mut [(Component, Analysis)]) {
    let mut claims = claims(bearings);
    claims.sort_by(|a, b| b.height_db.total_cmp(&a.height_db));
    let mut standing: Vec<Claim> = Vec::new();
    let mut fallen: Vec<(Claim, Claim, &str)> = Vec::new();
    for claim in claims {
        let width_hz = SAME_LINE * bearings[claim.bearing].1.findings.resolution_hz;
        let others = standing.iter().enumerate().filter(|(_, other)| other.bearing != claim.bearing);
        let rival = others.into_iter().find_map(|(n, other)| Some((n, related(&claim, other, width_hz)?)));
        match rival {
            None => standing.push(claim),
            // The same lines are those of the place that is nearer.
            Some((n, SAME)) if claim.off < standing[n].off => {
                fallen.push((standing[n], claim, SAME));
                standing[n] = claim;
            }
            Some((n, how)) => fallen.push((claim, standing[n], how)),
        }
    }
    for (claim, other, how) in fallen {
        let (component, name) = (bearings[other.bearing].0.to_string(), name(bearings, &other));
        let family = &mut bearings[claim.bearing].1.findings.families[claim.family];
        family.claimed = false;
        family.not_told_apart_from = None;
        family.reason = format!("its lines are {how} {name} of {component}").into();
    }
}

const SAME: &str = "those, nearer to their place, of";

fn name(bearings: &[(Component, Analysis)], claim: &Claim) -> Defect {
    bearings[claim.bearing].1.findings.families[claim.family].name
}

fn claims(bearings: &[(Component, Analysis)]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for (bearing, (_, analysis)) in bearings.iter().enumerate() {
        let families = &analysis.findings.families;
        let cage_hz = families.iter().find(|f| f.name == Defect::Ftf).map_or(f64::NAN, |f| f.expected_hz);
        for (family, of) in families.iter().enumerate().filter(|(_, f)| f.claimed) {
            let Some(hz) = of.measured_hz else { continue };
            claims.push(Claim {
                bearing,
                family,
                comb_hz: of.name.shocks_per_period() * hz,
                off: (hz / of.expected_hz - 1.0).abs(),
                height_db: of.score_db(),
                shaft_hz: analysis.findings.speed_rpm.unwrap_or(f64::NAN) / 60.0,
                cage_hz,
            });
        }
    }
    claims
}

/// How `other`, which stands higher, accounts for the lines of a claim; `None` where it does not.
fn related(claim: &Claim, other: &Claim, width_hz: f64) -> Option<&'static str> {
    let (hz, of) = (claim.comb_hz, other.comb_hz);
    let is = |at: f64| (hz - at).abs() < width_hz;
    if is(of) {
        return Some(SAME);
    }
    if (2..=MULTIPLES).any(|m| is(f64::from(m) * of)) {
        return Some("multiples of those of");
    }
    let beside = |spacing: f64| {
        (1..=2).any(|m| (-SIDEBANDS..=SIDEBANDS).any(|k| is(f64::from(m) * of + f64::from(k) * spacing)))
    };
    (beside(other.shaft_hz) || beside(other.cage_hz)).then_some("sidebands of those of")
}

impl Surroundings {
    /// Whether a comb at `order` times the shaft may be that of another bearing, a multiple or a part of it,
    /// with slip.
    pub(crate) fn may_be(&self, order: f64) -> bool {
        let parts = [1.0, 2.0, 3.0, 0.5, 1.0 / 3.0];
        self.combs.iter().any(|comb| parts.iter().any(|part| (order / (part * comb) - 1.0).abs() <= SLIP))
    }
}

/// Whether a family of an analysis is claimed, for tests and tables.
pub fn claimed(analysis: &Analysis) -> Vec<Defect> {
    analysis.findings.families.iter().filter(|f: &&Family| f.claimed).map(|f| f.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_components_from_words() {
        let of = |text: &str| Component::parse(text, CatalogueBearing::parse);
        let bearing = of("bearing=NU 205, elements=13, ratio=2.5").expect("a bearing");
        assert_eq!((bearing.ratio, bearing.bearing().and_then(|b| b.elements)), (2.5, Some(13)));
        assert_eq!(of("gear=23").expect("a gear"), Component { source: Source::Gear(23), ratio: 1.0 });
        let around = Surroundings::of(0, &[of("bearing=6205").unwrap(), bearing, of("gear=23").unwrap()]);
        assert_eq!((around.shafts, around.meshes), (vec![2.5], vec![23.0]));
        assert_eq!(around.combs.len(), 3);
    }

    #[test]
    fn refuses_components_that_are_none() {
        for (text, told) in [
            ("6205", "no component"),
            ("bearing=6205, ratio=0", "above 0"),
            ("bearing=6205, ratio=fast", "above 0"),
            ("gear=1", "2 to 2000"),
            ("gear=twenty", "2 to 2000"),
            ("wheel=20", "neither"),
            ("bearing=9999999", "9999999"),
            ("gear=20, ratio=1, ratio=2", "several ratios"),
        ] {
            let why = Component::parse(text, CatalogueBearing::parse).expect_err(text);
            assert!(why.contains(told), "{text}: {why}");
        }
    }
}
