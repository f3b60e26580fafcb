//! The summary at the head of a page: was the defect detected, which lines come from the mesh and which from
//! the bearing, how reliable is that.

use maud::{Markup, PreEscaped, html};
use stribeck_dsp::PeriodCount;
use stribeck_scene::deviation::{DeviationScene, RollingSurface};
use stribeck_scene::scene::{ContactInterpolation, ContactSurface, DefectRing, DefectScene};
use stribeck_store::run_dir::Run;
use stribeck_store::run_info::{Topic, imbalance};

use stribeck_analysis::artefacts::{Artefact, Origin};
use stribeck_analysis::diagnosis::DiagnosedFamily;
use stribeck_analysis::duty::DutyFinding;
use stribeck_analysis::families::FamilyFinding;
use stribeck_analysis::rolling;
use stribeck_analysis::summary::{EnergyFinding, Event, PhaseLevels, Summary};
use stribeck_diagnosis::words::numbers::{gravities, significant};

use super::Subject;
use super::spectrum::{families, loudest_sentences};
use crate::Error;
use crate::page::{Section, sentence, with_code};

/// Rollers that are named one by one, at most.
const NAMED: usize = 6;

/// The first screen: the answer in one sentence, a picture beside it, and the limits of both below.
pub(super) fn first_screen(of: &Subject<'_>, sections: &[Section]) -> Result<Markup, Error> {
    let (run, summary) = (of.run, &of.findings.summary);
    // The paper's page says so by itself.
    let of_mesh = if of.paper.is_none() { above_the_bearing(run, summary) } else { None };
    let warnings: Vec<String> = of_mesh.into_iter().chain(warnings(run, summary)).collect();
    Ok(html! {
        div #summary class="top" {
            p class="headline" { (with_code(&headline(of))) }
            (picture(sections)?)
            div class="answer" {
                @if let Some(paper) = &of.paper {
                    p { (with_code(paper.of_tone())) }
                    (paper.main_numbers())
                }
                // The paper's table has the peaks.
                p { strong { "The defect. " } (defect(run, summary, of.paper.is_none())) }
                p {
                    strong { "The signal. " }
                    (physics(summary))
                    @if let Some(words) = loudest_sentences(of.findings) { " " (words[0]) }
                }
                @if run.scene.written.contact.surface == ContactSurface::Facet || has_facet_lines(summary) {
                    p { strong { "The mesh. " } (mesh_in_short(summary)) }
                }
            }
        }
        @if !warnings.is_empty() {
            aside class="caveat" aria-label="Warnings" {
                ul { @for warning in &warnings { li { (with_code(warning)) } } }
            }
        }
        aside class="limits" aria-label="How far to trust it" {
            p { strong { "How far to trust it. " } @for words in trust(summary) { (words) " " } }
        }
    })
}

/// Figures that answer, the best first.
const ANSWERS: [&str; 3] = ["paper-2", "envelope", "acceleration"];

/// The figure of the page that answers, which leads to it.
fn picture(sections: &[Section]) -> Result<Markup, Error> {
    let figures = || sections.iter().flat_map(|section| &section.figures);
    let found = ANSWERS.iter().find_map(|id| figures().find(|figure| figure.id() == *id));
    let Some(figure) = found else { return Ok(html! {}) };
    Ok(html! { a class="picture" href={ "#" (figure.id()) } { (PreEscaped(figure.to_narrow_svg()?)) } })
}

/// What the run shows, in one sentence.
fn headline(of: &Subject<'_>) -> String {
    if let Some(paper) = &of.paper {
        return paper.headline();
    }
    let summary = &of.findings.summary;
    let faults = of.run.scene.written.faults();
    let Some(diagnosis) = &summary.diagnosis else {
        let state = if faults.is_empty() { "A healthy bearing" } else { "A damaged bearing" };
        let level = summary.levels.record.as_ref().map_or(String::new(), |level| {
            format!("; {} RMS at sensor “{}”", gravities(level.rms_g), sensor(summary))
        });
        return format!("{state}{level}. The record is too short for a verdict on the signal alone.");
    };
    let at = diagnosis.channel.split('.').nth(1).unwrap_or_default();
    let level = format!("; {} RMS at sensor “{at}”", gravities(diagnosis.level_g));
    let named = |wanted: fn(&DiagnosedFamily) -> bool| {
        let families: Vec<String> = diagnosis
            .families
            .iter()
            .filter(|family| wanted(family))
            .map(|family| match family.measured_hz {
                Some(hz) => format!("impacts of {} at {hz:.1} Hz ({})", family.name.part(), family.name),
                None => format!("impacts of {} ({})", family.name.part(), family.name),
            })
            .collect();
        (!families.is_empty()).then(|| families.join(" and "))
    };
    let found = named(|family| family.claimed && family.present);
    let wrong = named(|family| family.claimed && !family.present);
    match (faults.is_empty(), found, wrong) {
        (true, _, None) => format!("A healthy bearing, and its signal shows no defect{level}."),
        (true, _, Some(wrong)) => format!(
            "A healthy bearing whose signal alone would be called damaged, by {wrong}: {}{level}.",
            likely_cause(summary, of.run.scene.written.housing.machine().is_some())
        ),
        (false, Some(found), _) => format!("The signal alone shows the defect: {found}{level}."),
        (false, None, Some(wrong)) => {
            format!("The signal alone does not show the defect, but {wrong}{level}.")
        }
        (false, None, None) => format!("The signal alone does not show the defect{level}."),
    }
}

/// Whether lines of the mesh stand.
fn has_facet_lines(summary: &Summary) -> bool {
    summary.families.iter().any(|family| family.found)
}

/// What makes the lines of a healthy bearing look like those of a defect.
fn likely_cause(summary: &Summary, in_machine: bool) -> &'static str {
    if has_facet_lines(summary) {
        "its surfaces are chords, whose corners strike; `contact.surface: arc` has none"
    } else if in_machine {
        "rolling elements come under the load and leave it at that rate, and the noise of the machine does not \
         cover them"
    } else {
        "rolling elements come under the load and leave it at that rate, and the run has no other noise of a \
         machine that would cover them"
    }
}

/// That a line of the mesh is louder than the bearing, and which field takes it away.
fn above_the_bearing(run: &Run, summary: &Summary) -> Option<String> {
    let over_db = summary.levels.mesh_over_rest_db.filter(|db| *db > 0.0)?;
    let lines = summary.families.iter().filter(|family| family.found).flat_map(|family| &family.lines);
    let here =
        lines.filter(|line| Some(&line.sensor) == summary.levels.sensor.as_ref() && line.component == "ay");
    let loudest = here.max_by(|a, b| a.level_g.unwrap_or(0.0).total_cmp(&b.level_g.unwrap_or(0.0)))?;
    let contact = &run.scene.written.contact;
    let remedy = match (contact.surface, contact.interpolation) {
        (ContactSurface::Facet, _) => "`contact: (surface: arc, interpolation: spline)`",
        (_, ContactInterpolation::Linear) => "`contact.interpolation: spline`",
        _ => "a soft `contact.onset_um` or more `contact.points_per_facet`",
    };
    Some(format!(
        "A line of the mesh at {:.0} Hz stands {over_db:.0} dB above all else at sensor “{}”: levels and spectra there \
         are the mesh’s, not the bearing’s. It goes with {remedy}.",
        loudest.measured_hz.unwrap_or(loudest.predicted_hz),
        loudest.sensor
    ))
}

/// Warnings of the run and of its load, those of the contact first; that pictures are missing is a note.
fn warnings(run: &Run, summary: &Summary) -> Vec<String> {
    let of_run = run.info.warned().filter(|(topic, _)| *topic != Some(Topic::Pictures));
    let of_run = of_run.map(|(topic, words)| (topic, words.clone()));
    let motion = &summary.kinematics;
    let of_load = rolling::warnings(summary.load.expected_n, summary.load.least_rolling_n, motion);
    let of_load = of_load.into_iter().map(|words| (Some(Topic::Motion), words));
    let mut all: Vec<_> = of_run.chain(of_load).collect();
    all.sort_by_key(|(topic, _)| *topic != Some(Topic::Contact));
    all.iter().map(|(_, words)| sentence(words)).collect()
}

/// Which families of facet lines are there, in one sentence; where exactly stands at the spectrum.
fn mesh_in_short(summary: &Summary) -> String {
    let found: Vec<&FamilyFinding> = summary.families.iter().filter(|f| f.found).collect();
    if summary.unsteady().is_some() || found.is_empty() {
        return families::in_words(summary);
    }
    let each: Vec<String> = found
        .iter()
        .map(|f| {
            let level = f.level_g.map_or(String::new(), |g| format!(", up to {}", gravities(g)));
            format!("{} about {:.0} Hz{level}", f.spoken(), f.carrier_hz.unwrap_or(f64::NAN))
        })
        .collect();
    format!(
        "Lines of the {} are artefacts of the mesh: a real bearing has none, and another mesh moves them.",
        each.join(", and of the ")
    )
}

fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// Was the defect detected?
fn defect(run: &Run, summary: &Summary, with_levels: bool) -> String {
    let faults = run.scene.written.faults();
    if faults.is_empty() {
        return sound(run, summary);
    }
    let (events, spalls) = (&summary.events, run.scene.written.spalls());
    if spalls.is_empty() {
        let families: Vec<String> = faults.iter().map(|on| family_of(*on)).collect();
        return format!(
            "Entries and exits are picked for spalls of raceways, and there is none. Look for the families \
             in the spectra: {}.",
            families.join("; ")
        );
    }
    if events.is_empty()
        && summary.unsteady().is_some_and(|duty| duty.relative_speed_rpm.0 * duty.relative_speed_rpm.1 < 0.0)
    {
        return "The rings turn back on the way, and passages are predicted for one direction of rotation \
            only."
            .into();
    }
    let it = if spalls.len() == 1 { "it" } else { "them" };
    let others = other_faults(&faults, &spalls);
    if events.is_empty() {
        return format!("No roller reaches {it} under load on this record.{others}");
    }
    let entries = events.iter().filter(|e| e.entry_ms.is_some()).count();
    let exits = events.iter().filter(|e| e.exit_ms.is_some()).count();
    let rollers = run.scene.written.rollers_in_place().count();
    let crossed = match events.len() {
        1 => format!("1 roller crosses {it}"),
        times if times > rollers || spalls.len() > 1 => format!("Rollers cross {it} {times} times"),
        few => format!("{few} rollers cross {it}"),
    };
    format!(
        "{crossed}; the contact forces show {} and {}, and {}.{}{others}",
        if entries == 1 { "1 entry".to_owned() } else { format!("{entries} entries") },
        count(exits, "exit"),
        floor(events, entries + exits),
        if with_levels { levels(run, summary) } else { String::new() }
    )
}

/// The answer where raceways and rollers have no spall or dent.
fn sound(run: &Run, summary: &Summary) -> String {
    let level = summary.levels.phases.gap_g.map_or(String::new(), |g| {
        let along = across_the_load(run).then(|| radial(summary)?.gap_g).flatten();
        let along = along.map_or(String::new(), |g| format!(", and {} along the radius there", gravities(g)));
        format!(
            " The acceleration a_y at sensor “{}” reaches {} after the start-up{along}.",
            sensor(summary),
            gravities(g)
        )
    });
    let deviations: Vec<String> = run.scene.written.defects.iter().map(DeviationScene::spoken).collect();
    match deviations.len() {
        0 => format!("Raceways and rollers are sound, so there is none to see.{level}"),
        _ => format!("There is no spall or dent to see, but {}.{level}", deviations.join(", ")),
    }
}

/// The family of a defect, in words.
fn family_of(on: RollingSurface) -> String {
    match on {
        RollingSurface::Outer => "that of the outer raceway, BPFO".to_owned(),
        RollingSurface::Inner => "that of the inner raceway, which turns with the shaft, BPFI".to_owned(),
        RollingSurface::Roller(roller) => {
            format!("that of roller {roller}, which strikes both raceways, twice BSF")
        }
    }
}

/// A sentence on the defects that are no spalls of raceways; empty where there are none.
fn other_faults(faults: &[RollingSurface], spalls: &[DefectScene]) -> String {
    let picked = |on: &RollingSurface| match on {
        RollingSurface::Outer => spalls.iter().any(|spall| spall.ring == DefectRing::Outer),
        RollingSurface::Inner => spalls.iter().any(|spall| spall.ring == DefectRing::Inner),
        RollingSurface::Roller(_) => false,
    };
    let others: Vec<String> = faults.iter().filter(|on| !picked(on)).map(|on| family_of(*on)).collect();
    if others.is_empty() {
        return String::new();
    }
    format!(" The scene has others, whose families are in the spectra: {}.", others.join("; "))
}

/// Which rollers strike the floor of a spall, and which land on the oil above it. Where no `edges` show in the
/// record nevertheless, the floor carries the rollers.
fn floor(events: &[Event], edges: usize) -> String {
    let named = |at: fn(&Event) -> Option<f64>, [one, several]: [&str; 2]| {
        let rollers: Vec<String> =
            events.iter().filter(|e| at(e).is_some()).map(|e| e.roller.to_string()).collect();
        match rollers.len() {
            0 => None,
            1 => Some(format!("roller {} {one}", rollers[0])),
            many if many > NAMED => Some(format!("{many} times one {one}")),
            _ => Some(format!("rollers {} {several}", rollers.join(", "))),
        }
    };
    let struck = named(Event::impact_ms, ["strikes the floor", "strike the floor"]);
    let landed =
        named(Event::landing_ms, ["lands on the oil above the floor", "land on the oil above the floor"]);
    match (&struck, landed) {
        (None, None) => "none touches the floor".to_owned(),
        (None, Some(landed)) => format!("none strikes the floor, {landed}"),
        (Some(struck), _) if edges == 0 => {
            format!("{struck}: it carries them, and none comes free of half its load")
        }
        (Some(struck), landed) => landed.map_or(struck.clone(), |landed| format!("{struck}, {landed}")),
    }
}

/// A sentence on the peaks of the leading sensor.
fn levels(run: &Run, summary: &Summary) -> String {
    let Some(all) = reads(&summary.levels.phases) else {
        return " The record is too short to set exits beside gaps.".into();
    };
    let along = across_the_load(run).then(|| radial(summary).and_then(reads)).flatten();
    let along = along.map_or(String::new(), |reads| format!(" Along the radius there it reads {reads}."));
    format!(" Sensor “{}” reads {all} (a_y, peak).{along}", sensor(summary))
}

/// Peaks at exits, entries and in the gaps, in words; `None` without the first or the last of them.
fn reads(levels: &PhaseLevels) -> Option<String> {
    let (exit, gap) = levels.exit_g.zip(levels.gap_g)?;
    let entry = levels.entry_g.map_or(String::new(), |g| format!(", {} at entries", gravities(g)));
    Some(format!("{} at exits{entry} and {} between passages", gravities(exit), gravities(gap)))
}

/// Whether the load acts more along x than along y, so that a_y has little of it.
fn across_the_load(run: &Run) -> bool {
    let [x, y] = run.scene.written.load_direction();
    x.abs() > y.abs()
}

/// Levels along the radius at the leading sensor.
fn radial(summary: &Summary) -> Option<&PhaseLevels> {
    let sensor = summary.levels.sensors.first()?;
    sensor.components.iter().find(|c| c.component == "radial").map(|c| &c.phases)
}

/// The envelope's order spectrum, in words.
fn orders(duty: &DutyFinding) -> String {
    let Some(envelope) = &duty.envelope else {
        return format!("No family was sought over the angle of the {}.", duty.over());
    };
    let seen: Vec<String> =
        envelope.lines.iter().filter(|l| l.measured.is_some()).map(|l| format!("×{}", l.harmonic)).collect();
    let order = envelope.lines.first().map_or(0.0, |line| line.predicted);
    if seen.is_empty() {
        return format!(
            "Over the angle of the {} nothing stands at {} ({order:.3} a turn) or its multiples.",
            duty.over(),
            envelope.family
        );
    }
    let (family, at) = (&envelope.family, envelope.lines.first().and_then(|line| line.measured));
    let at = at.map_or(String::new(), |at| format!(" at {at:.3}"));
    format!(
        "Over the angle of the {} {family} ({order:.3} a turn) stands{at}, of its multiples {}.",
        duty.over(),
        seen.join(", ")
    )
}

fn physics(summary: &Summary) -> String {
    if let Some(duty) = summary.unsteady() {
        return orders(duty);
    }
    let of_defect: Vec<&Artefact> = summary.artefacts.iter().filter(|a| a.family == Origin::Defect).collect();
    let seen: Vec<String> =
        of_defect.iter().filter(|a| a.measured_hz.is_some()).map(|a| format!("×{}", a.harmonic)).collect();
    let lines = of_defect.iter().find(|a| a.harmonic == 1).map(|first| {
        let (name, moved_hz) = (&first.name, first.from_motion_hz.unwrap_or(first.predicted_hz));
        // As the sentence above has it, which reads the envelope.
        let families = summary.diagnosis.iter().flat_map(|diagnosis| &diagnosis.families);
        let mut told = families.filter(|f| f.claimed && f.present && f.name.name() == *name);
        let hz = told.find_map(|f| f.measured_hz).unwrap_or(moved_hz);
        let periods = 1e-3 * summary.run.simulated_ms * hz;
        if hz == 0.0 {
            String::new()
        } else if !seen.is_empty() {
            format!(" {name} ({hz:.1} Hz) stands in the spectrum with its multiples {}.", seen.join(", "))
        } else if periods < PeriodCount::ENOUGH {
            format!(
                " {name} ({hz:.1} Hz) cannot stand as a line of the spectrum: the record holds {periods:.1} \
                 of its periods, {:.0} are needed.",
                PeriodCount::ENOUGH
            )
        } else {
            format!(
                " {name} ({hz:.1} Hz) does not stand as a line of the spectrum, though the record holds \
                 {periods:.1} of its periods: look at the envelope."
            )
        }
    });
    lines.unwrap_or_default().trim_start().to_owned()
}

/// Limits of the numbers, one paragraph a topic.
fn trust(summary: &Summary) -> Vec<String> {
    let EnergyFinding { max_relative_error, share_of_contacts, missing_a_passage_j, .. } = summary.energy;
    let load = summary
        .load
        .relative_error
        .map_or(String::new(), |e| format!(", and the mean load to {:.2} %", 100.0 * e.abs()));
    let mut said = vec![
        "Peaks are those of one start: another start angle moves them by tens of per cent. They also \
         depend on contact stiffness, damping and pocket clearance, which are choices of the scene."
            .to_owned(),
        format!(
            "Energy is conserved to {}{load}.",
            imbalance(missing_a_passage_j, share_of_contacts, max_relative_error)
        ),
    ];
    said.extend(summary.spectrum.as_ref().map(|s| {
        let good = format!("Frequencies are good to {} Hz, one over", significant(s.resolution_hz, 2));
        let defect = s.fine_resolution_hz.map_or(String::new(), |hz| {
            format!("; those of the defect\u{2019}s family to {} Hz, one over the record", significant(hz, 2))
        });
        match s.segments {
            1 => format!("{good} the record{defect}."),
            n => format!(
                "{good} each of the {n} segments of {} s that the spectra average{defect}.",
                significant(s.segment_s, 3)
            ),
        }
    }));
    said
}

fn sensor(summary: &Summary) -> &str {
    summary.levels.sensor.as_deref().unwrap_or("none")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(roller: usize, by: Option<&str>) -> Event {
        let n = by.map(|_| 75.0);
        let event = serde_json::json!({
            "roller": roller, "ring": "outer", "expected_entry_ms": 0.8, "expected_exit_ms": 5.1,
            "floor_ms": by.map(|_| 2.5), "floor_n": n, "floor_by": by,
        });
        serde_json::from_value(event).expect("an event")
    }

    /// A roller that landed on 14.7 µm of oil with 75 N was said to touch the floor, as in the paper.
    #[test]
    fn issue_a_landing_on_oil_is_no_strike_of_the_floor() {
        let events = [over(1, Some("film")), over(24, None), over(23, Some("metal"))];
        assert_eq!(floor(&events[1..2], 2), "none touches the floor");
        assert_eq!(
            floor(&events[..2], 2),
            "none strikes the floor, roller 1 lands on the oil above the floor"
        );
        let both = "roller 23 strikes the floor, roller 1 lands on the oil above the floor";
        assert_eq!(floor(&events, 2), both);
        let carried = "roller 23 strikes the floor: it carries them, and none comes free of half its load";
        assert_eq!(floor(&events, 0), carried);
        assert_eq!(events.map(|event| event.impact_ms()), [None, None, Some(2.5)]);
    }
}
