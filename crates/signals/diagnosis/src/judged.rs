//! What the stages from the speed to the families make of a record, for a bearing whose number of rolling elements
//! may be unknown.
//!
//! Makers fit different numbers into bearings of one designation, and frequencies of raceways go with the number.
//! Where it is unknown, every one that makers may fit is judged by itself, and the verdict says with which numbers a
//! raceway would be damaged. It claims none: on the records of results/verdicts 14 of 98 healthy bearings would be.

use stribeck_dsp::BandEnvelope;
use stribeck_dsp::channel::Channel;
use stribeck_theory::catalogue::CatalogueBearing;

use crate::conclusion::Doubt;
use crate::families::verdict::{Candidates, Decided, FirstDefect};
use crate::families::{halves, rules, second};
use crate::record::bands::over_period;
use crate::record::pass::Record;
use crate::speed::half_speed::{self, decide_at_half, detect_half_speed};
use crate::speed::settled::Settled;
use crate::speed::{by_verdict, estimate};
use crate::words::sentence::{Told, conclude};
use crate::{Answer, Conclusion, Defect, Error, Family, Machine};

/// Families whose places go with the number of rolling elements.
const RACEWAYS: [Defect; 2] = [Defect::Bpfo, Defect::Bpfi];

/// Families of a record, and the machine that they were found for.
pub(crate) struct Judged {
    /// The machine at the speed, and with the number of rolling elements, that was taken.
    pub(crate) machine: Machine,
    pub(crate) speed: Settled,
    /// The record, not the user, gives the speed.
    pub(crate) is_corrected: bool,
    /// What the rules said, but for the families.
    pub(crate) decided: Decided,
    /// The families after the last rules.
    pub(crate) families: Vec<Family>,
    /// Envelope spectra over the period of the defect that stands highest; none without a defect.
    pub(crate) over: Vec<BandEnvelope>,
    pub(crate) conclusion: Conclusion,
    pub(crate) verdict: String,
}

impl Judged {
    /// Judges the families of a record of this channel.
    pub(crate) fn of(
        channel: &Channel,
        record: &Record,
        machine: &Machine,
        is_spoilt: bool,
    ) -> Result<Self, Error> {
        let Some(bearing) = machine.bearing.as_ref().filter(|bearing| bearing.elements.is_none()) else {
            return Self::of_known(channel, record, machine, is_spoilt);
        };
        let speed = Settled::of(record, machine);
        if speed.machine.speed_rpm.is_none() {
            return Self::of_known(channel, record, machine, is_spoilt);
        }
        let with = |elements: u32| {
            let bearing = Some(CatalogueBearing { elements: Some(elements), ..bearing.clone() });
            let speed_is_exact = speed.machine.speed_is_exact;
            let machine = Machine { bearing, speed_rpm: speed.given_rpm, speed_is_exact, ..machine.clone() };
            Ok((elements, Self::of_known(channel, record, &machine, is_spoilt)?))
        };
        let numbers = bearing.possible_elements();
        let judged = numbers.iter().copied().map(with).collect::<Result<Vec<_>, Error>>()?;
        let Some(mut found) = Self::among(judged, bearing) else {
            return Self::of_known(channel, record, machine, is_spoilt);
        };
        if machine.speed_rpm.is_none() {
            found.speed.uncertainty_rpm = speed.uncertainty_rpm;
            found.speed.notes.splice(..0, speed.notes);
        }
        Ok(found)
    }

    /// The same of samples that are no record of a signal, as `headline` says: nothing is claimed, and nothing excluded.
    pub(crate) fn without_claims(mut self, headline: &str) -> Self {
        for family in &mut self.families {
            (family.claimed, family.p_value) = (false, 1.0);
            family.reason = "the samples are no record of a signal".to_owned().into();
        }
        (self.decided.unexplained, self.decided.score_db, self.decided.sound) = (None, None, None);
        self.conclusion = Conclusion::of(&self.families, None, Some(Doubt::Samples));
        self.verdict = headline.to_owned();
        self
    }

    /// Of the judgements for each possible number of rolling elements the one to report; `None` without any.
    fn among(judged: Vec<(u32, Self)>, bearing: &CatalogueBearing) -> Option<Self> {
        let numbers: Vec<u32> = judged.iter().map(|(elements, _)| *elements).collect();
        let (least, most) = (*numbers.first()?, *numbers.last()?);
        let usual = u32::try_from(bearing.usual_elements()).unwrap_or(least).clamp(least, most);
        let name = &bearing.name;
        let claims: Vec<(u32, Defect, f64)> = judged.iter().filter_map(|(n, it)| it.raceway(*n)).collect();
        let taken = claims.first().map_or(usual, |(elements, ..)| *elements);
        let mut found = judged.into_iter().find(|(elements, _)| *elements == taken)?.1;
        if claims.is_empty() {
            found.verdict += &format!(
                " So it is with each number of rolling elements from {least} to {most} that makers may fit into \
                 `{name}`; places are those of {taken}."
            );
            return Some(found);
        }
        let would = |(elements, name, hz): &(u32, Defect, f64)| {
            format!("a defect of {} would with {elements} ({name} at {hz:.2} Hz)", name.part())
        };
        found.verdict = format!(
            "The impacts are those of {}, of {least} to {most} rolling elements that makers may fit into `{name}`: count \
             them, and give `--bearing \"{name}, elements=…\"`.",
            claims.iter().map(would).collect::<Vec<_>>().join(" and ")
        );
        for family in found.families.iter_mut().filter(|f| f.claimed && RACEWAYS.contains(&f.name)) {
            family.claimed = false;
            found.conclusion.raceways.answer = Answer::CannotTell;
            family.reason =
                format!("it is there with {taken} rolling elements, whose number is not known").into();
        }
        Some(found)
    }

    /// The raceway that is called defect with so many rolling elements, and its frequency [Hz].
    fn raceway(&self, elements: u32) -> Option<(u32, Defect, f64)> {
        let raceways = [Defect::Bpfo, Defect::Bpfi];
        let claimed =
            self.families.iter().find(|family| family.claimed && raceways.contains(&family.name))?;
        Some((elements, claimed.name, claimed.measured_hz.unwrap_or(claimed.expected_hz)))
    }

    /// The same for a bearing whose number of rolling elements is known, or none.
    fn of_known(
        channel: &Channel,
        record: &Record,
        machine: &Machine,
        is_spoilt: bool,
    ) -> Result<Self, Error> {
        let speed = Settled::of(record, machine);
        let candidates = Candidates::of(record, &speed.machine, speed.lines_hz, speed.by_shaft);
        let half = candidates.as_ref().ok().and_then(|candidates| {
            let half = detect_half_speed(candidates, record, &speed.machine)?;
            let (slower, decided) = decide_at_half(half, record, &speed.machine)?;
            Some((half_speed::sentence(half, speed.given_rpm?), slower, decided))
        });
        let (said_of_half, machine, mut decided) = match half {
            Some((said, slower, decided)) => (Some(said), slower, decided),
            None => (
                None,
                speed.machine.clone(),
                candidates.map_or_else(Decided::without_families, Candidates::decide),
            ),
        };
        let sought =
            decided.asks_for_a_speed(estimate::REACH).then(|| near_speed(record, &machine)).flatten();
        let is_corrected = speed.is_corrected || said_of_half.is_some() || sought.is_some();
        let machine = match sought {
            Some((at_speed, of_speed, note)) => {
                decided = of_speed;
                decided.notes.push(note);
                at_speed
            }
            None => machine,
        };
        if is_spoilt {
            // Gaps, marks and rails may come as evenly as another part strikes.
            decided.unexplained = None;
        }
        let over = match &decided.first {
            Some(first) => over_period(channel, record.rate_hz, record.segment, first.comb_hz)?,
            None => Vec::new(),
        };
        let families = std::mem::take(&mut decided.families);
        let families = concluded(families, decided.first.as_ref(), record, &over)?;
        let families = decided.with_power(families, record);
        let turns = record.duration_s() * machine.speed_rpm.unwrap_or(0.0) / 60.0;
        let doubt = Doubt::of(is_spoilt, speed.uncertainty_rpm.is_some(), turns);
        let conclusion = Conclusion::of(&families, decided.unexplained.as_ref(), doubt);
        let said = if families.is_empty() {
            format!("No verdict: {}.", decided.notes.join("; "))
        } else {
            let (unit, rate_hz) = (channel.unit.as_deref(), record.rate_hz);
            let speed_rpm = machine.speed_rpm.unwrap_or(f64::NAN);
            let told = Told { doubt, conclusion: &conclusion, unit, speed_rpm, rate_hz };
            conclude(&families, decided.unexplained.as_ref(), told)
        };
        let claims = families.iter().any(|f| f.claimed);
        let in_hertz = if claims { None } else { speed_in_hertz(record, &machine) };
        let verdict = std::iter::once(said).chain(said_of_half).chain(in_hertz).collect::<Vec<_>>().join(" ");
        Ok(Self { machine, speed, is_corrected, decided, families, over, conclusion, verdict })
    }
}

/// The machine at the speed near the given one at which a raceway is claimed and nothing stands higher, of all that
/// the lines of the record support, what the rules say there, and a note; `None` for an exact speed.
fn near_speed(record: &Record, machine: &Machine) -> Option<(Machine, Decided, String)> {
    let asked = !machine.speed_is_exact && machine.outer_speed_rpm == 0.0;
    let (rpm, bearing) = (machine.speed_rpm?, machine.bearing.as_ref().filter(|_| asked)?);
    let Record { kept, rate_hz, bands, .. } = record;
    kept.iter().all(|x| x.is_finite()).then_some(())?;
    let (_, mut supported) = estimate::search(kept, *rate_hz, bands, bearing)?;
    supported.retain(|speed| (60.0 * speed.hz / rpm - 1.0).abs() < estimate::REACH);
    let found = by_verdict::find(record, machine, &supported)?;
    let at_speed = Machine { speed_rpm: Some(60.0 * found.speed.hz), ..machine.clone() };
    let decided = Candidates::of(record, &at_speed, Some(found.speed.hz), true).ok()?.decide();
    Some((at_speed, decided, found.note_beside(rpm)))
}

/// Speeds below this may be meant in hertz [1/min].
const MEANT_IN_HERTZ: f64 = 100.0;

/// What to say where a raceway would be claimed if the number of the speed were one in hertz.
fn speed_in_hertz(record: &Record, machine: &Machine) -> Option<String> {
    let hz = machine.speed_rpm.filter(|rpm| *rpm < MEANT_IN_HERTZ)?;
    let faster = Machine { speed_rpm: Some(60.0 * hz), ..machine.clone() };
    let decided = Candidates::of(record, &faster, None, false).ok()?.decide();
    let claimed = decided.families.iter().find(|f| f.claimed && RACEWAYS.contains(&f.name))?;
    Some(format!(
        "Is the speed {hz} Hz, not {hz} rpm? At {:.0} rpm it shows a defect of {} ({} at {:.2} Hz).",
        60.0 * hz,
        claimed.name.part(),
        claimed.name,
        claimed.measured_hz.unwrap_or(claimed.expected_hz)
    ))
}

/// The families after the last rules: a second defect beside the first, claims that stand in one half of the
/// record alone, and the element that strikes once a turn of the cage.
fn concluded(
    decided: Vec<Family>,
    first: Option<&FirstDefect>,
    record: &Record,
    over: &[BandEnvelope],
) -> Result<Vec<Family>, Error> {
    let with_second = match first {
        Some(first) => second::with_second(decided, first, record.bands.first(), over),
        None => decided,
    };
    let lasting = halves::without_passing(with_second, &record.kept, record.rate_hz)?;
    Ok(rules::with_element(lasting, &record.bands))
}
