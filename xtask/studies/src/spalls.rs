//! `cargo xtask study spalls`: simulated spalls of known length through `stribeck analyse`: does it find
//! their lengths?

use anyhow::Result;
use stribeck_scene::scene::DefectRing;

use crate::analyse::{Found, analyse, median, passages, put_length};
use crate::{Finished, Plan, Rows, Runner};

/// Distances of events are the same within this part: what two bands must agree on is 5 %, and a load is
/// picked to as much.
const SAME: f64 = 0.1;

/// Findings on the record of a run.
struct Reading {
    found: Found,
    length_mm: f64,
    family: &'static str,
    /// Distance of two elements along the raceway [mm].
    apart_mm: f64,
    /// Recorded passages, those with both events in the force, and those in which the floor is touched.
    passages: [usize; 3],
    /// Median time from half of the load to half of it [s].
    by_load_s: Option<f64>,
}

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let plan = Plan::read(runner.study)?;
    let groups = plan.run(runner, &[], rows)?;
    // What the rules of `analyse` were chosen on, and what not.
    let (mut chosen, mut quoted) = (Vec::new(), Vec::new());
    for (group, run) in
        plan.groups.iter().zip(&groups).flat_map(|(g, runs)| runs.iter().map(move |run| (g, run)))
    {
        let Some(reading) = Reading::of(runner, run)? else { continue };
        let name = &run.variant.name;
        put_length(rows, name, reading.length_mm, reading.reading_mm());
        rows.value("lengths", name, "by load mm", reading.by_load_mm());
        for (n, what) in ["passages", "unloads", "floor"].into_iter().enumerate() {
            rows.value("lengths", name, what, reading.passages[n] as f64);
        }
        rows.word("lengths", name, "shows", &reading.why());
        if group.table == "quoted" { quoted.push(reading) } else { chosen.push(reading) }
    }
    counts(rows, "", &chosen);
    counts(rows, "quoted: ", &quoted);
    Ok(())
}

impl Reading {
    fn of(runner: &Runner<'_>, run: &Finished) -> Result<Option<Self>> {
        let Some((_, defect)) = run.numbers().zip(run.written.defect.as_ref()) else { return Ok(None) };
        let bearing = &run.written.bearing;
        let (family, diameter_mm) = match defect.ring {
            DefectRing::Outer => ("BPFO", bearing.outer_race_diameter_mm),
            DefectRing::Inner => ("BPFI", bearing.inner_race_diameter_mm),
        };
        let out = runner.folder.join(format!("{}-analysed", run.variant.name));
        let found = analyse(runner.host, &run.folder, &[], &out, family)?;
        let apart_mm = std::f64::consts::PI * diameter_mm / bearing.rollers as f64;
        let (passages, by_load_s) = passages(run);
        Ok(Some(Self { found, length_mm: defect.length_mm, family, apart_mm, passages, by_load_s }))
    }

    /// Path of the contact in a time [mm].
    fn run_mm(&self, lasts_s: f64) -> Option<f64> {
        Some(lasts_s * self.apart_mm * self.found.hz?)
    }

    /// Path of the contact between the times of half load [mm].
    fn by_load_mm(&self) -> Option<f64> {
        self.run_mm(self.by_load_s?)
    }

    fn is_claimed(&self) -> bool {
        self.found.claimed.iter().any(|name| name == self.family)
    }

    fn is_length(&self) -> bool {
        self.found.spall_mm.is_some()
    }

    fn is_bounded(&self) -> bool {
        self.found.below_mm.is_some()
    }

    /// Whether the spall is within the scope of THEORY §7.9: shorter than half of the distance of two
    /// elements.
    fn is_short(&self) -> bool {
        self.length_mm < 0.5 * self.apart_mm
    }

    /// Estimate, lower and upper end [mm] of the reading for spalls of this length, shorter or longer than
    /// half of the distance of two elements: the record gives both lengths, and does not decide between them.
    fn reading_mm(&self) -> Option<[f64; 3]> {
        if self.is_short() { self.found.spall_mm } else { self.found.otherwise_mm }
    }

    fn holds(&self) -> bool {
        self.reading_mm().is_some_and(|[_, low, high]| (low..=high).contains(&self.length_mm))
    }

    /// Findings of this record beside the forces.
    fn why(&self) -> String {
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < SAME;
        match (self.found.spacing_s.and_then(|s| self.run_mm(s)), self.by_load_mm()) {
            _ if !self.is_claimed() => "no defect is claimed".to_owned(),
            (Some(run), Some(by_load)) if near(run, by_load) => "the two edges".to_owned(),
            (Some(run), Some(by_load)) if near(run, self.apart_mm - by_load) => {
                "exit to the next element’s entry".to_owned()
            }
            (Some(run), Some(by_load)) => {
                let (part, next) = (100.0 * run / by_load, self.apart_mm - by_load);
                format!("{part:.0} % of by load; from exit to the next entry are {next:.2} mm")
            }
            (Some(_), None) => "a second event".to_owned(),
            (None, _) if self.is_bounded() && 2 * self.passages[1] < self.passages[0] => {
                "one impact: most elements stay loaded".to_owned()
            }
            (None, _) if self.is_bounded() => "one impact, though elements unload".to_owned(),
            (None, _) => "cannot tell".to_owned(),
        }
    }
}

/// How many of which sort hold the truth.
fn counts(rows: &mut Rows, prefix: &str, all: &[Reading]) {
    type Sort = (&'static str, fn(&&Reading) -> bool);
    let sorts: [Sort; 6] = [
        ("a second event; spall shorter than half of the distance of two elements", |r| {
            r.is_length() && r.is_short()
        }),
        ("a second event; longer spall", |r| r.is_length() && !r.is_short()),
        ("one impact, which bounds the length", |r| r.is_bounded()),
        ("neither length nor bound; the defect is claimed", |r| {
            !r.is_length() && !r.is_bounded() && r.is_claimed()
        }),
        ("no length given; no defect is claimed", |r| !r.is_length() && !r.is_claimed()),
        ("all", |_| true),
    ];
    for (what, of) in sorts {
        let of: Vec<&Reading> = all.iter().filter(of).collect();
        let off = of.iter().filter_map(|r| Some((r.reading_mm()?[0] / r.length_mm - 1.0).abs()));
        let values = [
            ("records", Some(of.len() as f64)),
            ("held", Some(of.iter().filter(|r| r.holds()).count() as f64)),
            ("median off", median(off.collect())),
        ];
        rows.values("counts", &format!("{prefix}{what}"), values);
    }
}
