//! `cargo xtask study loop`: measured spalls, their lengths, and whether simulated spalls of these lengths
//! have the signature of the measured ones.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use serde_json::Value;
use stribeck_scene::scene::DefectRing;
use stribeck_theory::catalogue::CatalogueBearing;

use crate::table::number;
use crate::{Answer, Flags, Host, Runner, Sheet, Variant};

/// Flags of `study loop`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
    /// Folder of the records of HIT-SM (`OR5_900.mat` …), or one that holds it as `hit-sm`
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
}

/// Fields that all runs share.
const SCENE: &str = "fixtures/scenes/studies/loop.ron";
/// The bearing of the rig.
const BEARING: &str = "6205";
/// Sample rate of the records [Hz].
const RATE_HZ: f64 = 51_200.0;
/// Raceways: in file names, in scenes, the family of their defects, and their diameters [mm].
const RACEWAYS: [(&str, &str, &str, f64); 2] =
    [("OR", "outer", "BPFO", 46.98), ("IR", "inner", "BPFI", 31.10)];
/// Speeds of the shaft [1/min].
const SPEEDS: [u32; 3] = [600, 900, 1200];
/// Sizes of the spalls [° of arc].
const SIZES: [u32; 3] = [2, 5, 8];
/// Speed at which the loop is closed [1/min].
const LOOPED_RPM: u32 = 900;
/// Time simulated, in turns of the shaft: six hold 22 passages, too few for a second event to show for
/// certain.
const TURNS: f64 = 24.0;
/// How far the simulated spacing may be from the measured one.
const ALLOWED: f64 = 0.05;
/// Median error of the lengths that is allowed.
const MEDIAN: f64 = 0.2;
/// Records of eighteen whose interval must hold the length.
const COVERED: usize = 16;

/// A measured record.
struct Measured {
    name: String,
    raceway: usize,
    rpm: u32,
    size: u32,
    /// Length of the spall [mm].
    truth_mm: f64,
    found: Found,
}

/// Findings of `stribeck analyse` on a record.
pub(crate) struct Found {
    /// Families that are claimed.
    pub(crate) claimed: Vec<String>,
    /// Length of the spall from two events a passage: value, lower and upper end [mm].
    pub(crate) spall_mm: Option<[f64; 3]>,
    /// The same of a spall longer than half of the distance of two elements, in the same rhythm [mm].
    pub(crate) otherwise_mm: Option<[f64; 3]>,
    /// Time between these events [s].
    pub(crate) spacing_s: Option<f64>,
    /// Bound of the length from one event a passage [mm].
    pub(crate) below_mm: Option<f64>,
    /// Frequency of the family that is there [Hz].
    pub(crate) hz: Option<f64>,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let within = options.folder.join("hit-sm");
    let folder = if within.is_dir() { within } else { options.folder.clone() };
    let first = folder.join("OR2_600.mat");
    ensure!(
        first.exists(),
        "`{}` is not there: give the folder of the HIT-SM records, github.com/hitwzc/Bearing-datasets",
        first.display()
    );
    let out = host.root().join("runs/study/loop");
    let mut records = Vec::new();
    for (raceway, (letters, _, family, diameter_mm)) in RACEWAYS.into_iter().enumerate() {
        for (rpm, size) in SPEEDS.into_iter().flat_map(|rpm| SIZES.map(|size| (rpm, size))) {
            let name = format!("{letters}{size}_{rpm}");
            let file = folder.join(format!("{name}.mat"));
            let words = [
                format!("--rate-hz={RATE_HZ}"),
                format!("--bearing={BEARING}"),
                format!("--speed-rpm={rpm}"),
            ];
            let found = analyse(host, &file, &words, &out.join(format!("{name}-measured")), family)?;
            let truth_mm = f64::from(size) / 360.0 * std::f64::consts::PI * diameter_mm;
            records.push(Measured { name, raceway, rpm, size, truth_mm, found });
        }
    }
    let mut sheet = Sheet::new(host.root(), "loop", "Measured spalls, and simulated ones of their lengths");
    sheet.say(
        "Written with the folder of the records of HIT-SM as the study's argument: bearing 6205, spalls over \
         2, 5 and 8° of arc of \
         either raceway, 600, 900 and 1200 rpm, 5 s at 51.2 kHz. `stribeck analyse` is given the rate, the \
         bearing and the speed, and nothing of the spall.",
    );
    lengths(&mut sheet, &records);
    // Only lengths from a second event have a spacing.
    let spaced = records.iter().filter(|r| r.rpm == LOOPED_RPM && r.found.spall_mm.is_some());
    let runner = Runner::new("loop", &options.flags, host);
    let mut first = Vec::new();
    for record in spaced {
        first.extend(Pass::begin(record));
    }
    simulate(&runner, host, &out, &mut first, "first")?;
    let mut second: Vec<Pass<'_>> = first.iter().filter_map(Pass::again).collect();
    simulate(&runner, host, &out, &mut second, "second")?;
    loops(&mut sheet, &first, &second);
    Ok(Answer::on(sheet.write()?))
}

/// Runs `stribeck analyse` and reads its findings.
///
/// # Errors
/// When it does not start, refuses the file, or leaves no findings.
pub(crate) fn analyse(
    host: &dyn Host,
    file: &Path,
    words: &[String],
    out: &Path,
    family: &str,
) -> Result<Found> {
    let mut command = host.stribeck()?;
    let done = command.arg("analyse").arg(file).args(words).arg("--out").arg(out).output();
    let done = done.context("`stribeck analyse` does not start")?;
    ensure!(done.status.success(), "{}: {}", file.display(), String::from_utf8_lossy(&done.stderr).trim());
    let path = out.join("findings.json");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let findings: Value = serde_json::from_str(&text).context("findings.json")?;
    let families = findings["families"].as_array().cloned().unwrap_or_default();
    let name = |f: &Value| f["name"].as_str().unwrap_or_default().to_owned();
    let interval = |name: &str| {
        let [value, low, high] = ["value", "low", "high"].map(|key| findings[name][key].as_f64());
        Some([value?, low?, high?])
    };
    Ok(Found {
        claimed: families.iter().filter(|f| f["claimed"] == true).map(name).collect(),
        spall_mm: interval("spall_mm"),
        otherwise_mm: interval("spall_otherwise_mm"),
        spacing_s: findings["event_spacing_ms"].as_f64().map(|ms| 1e-3 * ms),
        below_mm: findings["spall_below_mm"].as_f64(),
        hz: families.iter().find(|f| name(f) == family).and_then(|f| f["measured_hz"].as_f64()),
    })
}

impl Found {
    /// Speed of the contact along the raceway [mm/s].
    fn speed_mm_s(&self, diameter_mm: f64) -> Option<f64> {
        let elements = CatalogueBearing::parse(BEARING).ok()?.elements?;
        Some(std::f64::consts::PI * diameter_mm * self.hz? / f64::from(elements))
    }
}

/// A simulated spall beside a measured record.
struct Pass<'a> {
    record: &'a Measured,
    length_mm: f64,
    /// Time between the events of the record [s].
    measured_s: f64,
    /// The same of the simulated sensor’s record [s], or why there is none.
    simulated_s: Result<f64, String>,
    /// Time from unloading to loading of simulated elements, the median [s].
    by_load_s: Option<f64>,
}

impl<'a> Pass<'a> {
    /// A spall of the estimated length.
    fn begin(record: &'a Measured) -> Option<Self> {
        Some(Self::of(record, record.found.spall_mm?[0], record.found.spacing_s?))
    }

    fn of(record: &'a Measured, length_mm: f64, measured_s: f64) -> Self {
        Self { record, length_mm, measured_s, simulated_s: Err("not run".to_owned()), by_load_s: None }
    }

    /// A spall longer by the path of the contact in the missing time.
    fn again(&self) -> Option<Self> {
        let missing_s = self.measured_s - self.simulated_s.as_ref().ok()?;
        let speed_mm_s = self.record.found.speed_mm_s(RACEWAYS[self.record.raceway].3)?;
        Some(Self::of(self.record, self.length_mm + speed_mm_s * missing_s, self.measured_s))
    }

    fn off(&self) -> Option<f64> {
        Some(self.simulated_s.as_ref().ok()? / self.measured_s - 1.0)
    }

    /// The bearing of the record with the spall.
    fn variant(&self, pass: &str) -> Variant {
        let ring = RACEWAYS[self.record.raceway].1;
        let ms = TURNS * 60_000.0 / f64::from(self.record.rpm);
        Variant::new(format!("{}-{pass}", self.record.name), SCENE, &[])
            .with(format!("operation.speed_rpm={}", self.record.rpm))
            .with(format!("solver.duration_ms={ms}"))
            .with(format!("defect.ring={ring}"))
            .with(format!("defect.length_mm={:.3}", self.length_mm))
    }
}

/// Runs the scenes of one pass and analyses what their sensors recorded.
fn simulate(
    runner: &Runner<'_>,
    host: &dyn Host,
    out: &Path,
    passes: &mut [Pass<'_>],
    name: &str,
) -> Result<()> {
    let variants: Vec<Variant> = passes.iter().map(|pass| pass.variant(name)).collect();
    let runs = runner.run(&variants)?;
    for (pass, variant) in passes.iter_mut().zip(&variants) {
        let Some(run) = runs.iter().find(|run| run.variant.name == variant.name) else { continue };
        let Some(summary) = run.numbers() else {
            pass.simulated_s = Err(run.summary.as_ref().err().cloned().unwrap_or_default());
            continue;
        };
        let on_outer = summary.events.iter().filter(|event| event.ring == DefectRing::Outer);
        let lasted = on_outer.filter_map(|e| Some(1e-3 * (e.exit_ms? - e.entry_ms?)));
        let mut lasted: Vec<f64> = lasted.collect();
        lasted.sort_by(f64::total_cmp);
        pass.by_load_s = lasted.get(lasted.len() / 2).copied();
        let family = RACEWAYS[pass.record.raceway].2;
        let found =
            analyse(host, &run.folder, &[], &out.join(format!("{}-simulated", variant.name)), family)?;
        pass.simulated_s = match found.spacing_s {
            Some(spacing_s) => Ok(spacing_s),
            None if found.claimed.is_empty() => Err("no defect is claimed".to_owned()),
            None => Err("no second event".to_owned()),
        };
    }
    Ok(())
}

fn mm(value: f64) -> String {
    number(value, 2)
}

/// Estimated lengths beside the true ones, and the criteria.
fn lengths(sheet: &mut Sheet, records: &[Measured]) {
    sheet.heading("Lengths");
    let rows: Vec<Vec<String>> = records
        .iter()
        .map(|r| {
            let claimed =
                if r.found.claimed.is_empty() { "none".to_owned() } else { r.found.claimed.join(" + ") };
            let mut row = vec![r.name.clone(), claimed, mm(r.truth_mm)];
            match r.found.spall_mm {
                Some([value, low, high]) => row.extend([
                    mm(value),
                    format!("{} to {}", mm(low), mm(high)),
                    number(100.0 * (value / r.truth_mm - 1.0), 0),
                    if holds(r) { "yes" } else { "**no**" }.to_owned(),
                ]),
                None => row.extend(["–", "–", "–", "**no**"].map(str::to_owned)),
            }
            row
        })
        .collect();
    sheet.table(
        &["record", "claimed", "true, mm", "estimate, mm", "interval, mm", "off, %", "in the interval"],
        &rows,
    );
    let mut errors: Vec<f64> =
        records.iter().filter_map(|r| Some((r.found.spall_mm?[0] / r.truth_mm - 1.0).abs())).collect();
    errors.sort_by(f64::total_cmp);
    let median = errors.get(errors.len() / 2).copied().unwrap_or(f64::INFINITY);
    let covered = records.iter().filter(|r| holds(r)).count();
    let unordered: Vec<String> = RACEWAYS
        .iter()
        .enumerate()
        .flat_map(|(raceway, of)| SPEEDS.map(|rpm| (raceway, of.0, rpm)))
        .filter(|(raceway, _, rpm)| !ordered(records, *raceway, *rpm))
        .map(|(_, letters, rpm)| format!("{letters} at {rpm} rpm"))
        .collect();
    for record in records {
        sheet.value("lengths", &record.name, "true mm", Some(record.truth_mm));
        for (n, what) in ["estimate mm", "low mm", "high mm"].into_iter().enumerate() {
            sheet.value("lengths", &record.name, what, record.found.spall_mm.map(|all| all[n]));
        }
    }
    sheet.value("lengths", "all", "median error", Some(median));
    sheet.value("lengths", "all", "covered", Some(covered as f64));
    let verdict = |held: bool| if held { "holds" } else { "**does not hold**" };
    sheet.say(&format!(
        "- Sizes in their order, 2 < 5 < 8°, at each speed: {}{}.\n- Median error of {} lengths {} % (at \
         most {} %): {}.\n- The interval holds \
         the length in {covered} of {} records (at least {COVERED}): {}.",
        verdict(unordered.is_empty()),
        if unordered.is_empty() { String::new() } else { format!(", {}", unordered.join(", ")) },
        errors.len(),
        number(100.0 * median, 0),
        100.0 * MEDIAN,
        verdict(median <= MEDIAN),
        records.len(),
        verdict(covered >= COVERED),
    ));
    sheet.say(
        "A record without an estimate has one event a passage, which bounds a length and does not tell \
         it. The \
         sizes are those of spalls shorter than half of the distance of two elements ([spalls](spalls.md)).",
    );
}

fn holds(record: &Measured) -> bool {
    record.found.spall_mm.is_some_and(|[_, low, high]| (low..=high).contains(&record.truth_mm))
}

/// Whether the estimates of one raceway and speed go up with the size.
fn ordered(records: &[Measured], raceway: usize, rpm: u32) -> bool {
    let of = |size: u32| {
        let record = records.iter().find(|r| (r.raceway, r.rpm, r.size) == (raceway, rpm, size))?;
        Some(record.found.spall_mm?[0])
    };
    let values = SIZES.map(of);
    values.iter().all(Option::is_some) && values.is_sorted_by(|a, b| a < b)
}

/// Spacings of simulated spalls beside the measured ones.
fn loops(sheet: &mut Sheet, first: &[Pass<'_>], second: &[Pass<'_>]) {
    sheet.heading("The loop");
    sheet.say(&format!(
        "A record with a second event gives a length. For those at {LOOPED_RPM} rpm a 6205 with a spall of \
         that length, 0.2 mm deep, under 100 N, is simulated for {TURNS} \
         turns (`fixtures/scenes/studies/loop.ron`, reduced model, 100 kHz), and its sensor\u{2019}s record \
         goes through `stribeck analyse`, too: is the time \
         between entry and exit the measured one, within {} %? The record does not say the load, which \
         matters: an element that rings press together \
         comes free some way behind the first edge, and is caught as far before the second one (THEORY \
         §7.5). The first pass takes the value of \
         `spall_mm`, in which that is counted for a rigid housing; in the second one the spall is longer by what the contact runs in the \
         time that was missing. *By load* is \
         the time from half of an element\u{2019}s load to half of it, on outer raceways.",
        100.0 * ALLOWED
    ));
    let (mut rows, mut closed) = (Vec::new(), 0);
    for (name, pass) in first.iter().map(|p| ("first", p)).chain(second.iter().map(|p| ("second", p))) {
        let within = pass.off().is_some_and(|off| off.abs() <= ALLOWED);
        closed += usize::from(within && name == "second");
        let [_, low, high] = pass.record.found.spall_mm.unwrap_or([f64::NAN; 3]);
        rows.push(vec![
            pass.record.name.clone(),
            name.to_owned(),
            mm(pass.length_mm),
            mm(pass.record.truth_mm),
            if (low..=high).contains(&pass.length_mm) { "yes" } else { "**no**" }.to_owned(),
            number(1e3 * pass.measured_s, 2),
            match &pass.simulated_s {
                Ok(s) => number(1e3 * s, 2),
                Err(why) => why.clone(),
            },
            pass.off().map_or("–".to_owned(), |off| number(100.0 * off, 1)),
            if within { "yes" } else { "**no**" }.to_owned(),
            pass.by_load_s.map_or("–".to_owned(), |s| number(1e3 * s, 2)),
        ]);
        let variant = format!("{}-{name}", pass.record.name);
        sheet.value("loop", &variant, "length mm", Some(pass.length_mm));
        sheet.value("loop", &variant, "measured spacing s", Some(pass.measured_s));
        sheet.value("loop", &variant, "simulated spacing s", pass.simulated_s.as_ref().ok().copied());
        sheet.value("loop", &variant, "by load s", pass.by_load_s);
    }
    sheet.table(
        &[
            "record",
            "pass",
            "length, mm",
            "true, mm",
            "in the interval",
            "measured, ms",
            "simulated, ms",
            "off, %",
            "within 5 %",
            "by load, ms",
        ],
        &rows,
    );
    sheet.value("loop", "all", "closed", Some(closed as f64));
    let once = first.iter().filter(|pass| pass.off().is_some_and(|off| off.abs() <= ALLOWED)).count();
    sheet.say(&format!(
        "Within {} % of the measured time: {once} of {} with the length as it is estimated, {closed} with \
         the length corrected once.",
        100.0 * ALLOWED,
        first.len()
    ));
}
