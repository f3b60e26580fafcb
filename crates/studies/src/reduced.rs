//! `cargo xtask study reduced`: the reduced bearing beside the full one, scene by scene, with the effects
//! that it leaves out.

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::agreement::{Agreement, BAND_LIMIT_DB, Octaves, Row, Scale};
use stribeck_scene::scene::Scene;

use crate::table::{figures, number};
use crate::{Answer, Finished, Flags, Host, Runner, Sheet, Variant};

/// Flags of `study reduced`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
}

/// A scene by both models.
struct Case {
    /// Name of its folder.
    name: &'static str,
    /// In words.
    what: &'static str,
    scene: &'static str,
    set: &'static [&'static str],
    starts: usize,
    /// Reduced models of it: in words, with overrides of the scene.
    models: &'static [Model],
}

/// A name and overrides.
type Model = (&'static str, &'static [&'static str]);

const AT_2_US: Model = ("2 µs", &["model.step_us=2"]);
const AT_5_US: Model = ("5 µs", &["model.step_us=5"]);

const SCENE: &str = "fixtures/scenes/reduced_30ms.ron";
const GRADED: &str = "mesh.grading=(coarse_mm: 2.0, fine_layers: 2)";

const CASES: &[Case] = &[
    Case {
        name: "paper",
        what: "the paper\u{2019}s",
        scene: SCENE,
        set: &[GRADED],
        starts: 32,
        models: &[AT_2_US, AT_5_US],
    },
    Case {
        name: "load",
        what: "30 kN, 700 rpm",
        scene: SCENE,
        set: &["mesh.size_mm=1.0", "operation.load_n=30000", "operation.speed_rpm=700"],
        starts: 32,
        models: &[AT_2_US, AT_5_US],
    },
    Case {
        name: "rollers",
        what: "20 rollers",
        scene: SCENE,
        set: &[GRADED, "bearing.rollers=20"],
        starts: 32,
        models: &[AT_2_US, AT_5_US],
    },
    Case {
        name: "rigid",
        what: "20 rollers, rigid housing",
        scene: SCENE,
        set: &[GRADED, "bearing.rollers=20", "housing=rigid(mass_kg: 10)"],
        starts: 12,
        models: &[AT_2_US],
    },
    Case {
        name: "arcs",
        what: "contact on arcs",
        scene: SCENE,
        set: &[GRADED, "contact.surface=arc"],
        starts: 8,
        models: &[AT_2_US],
    },
    Case {
        name: "spall",
        what: "20 mm thick, spall of 6 × 0.1 mm",
        scene: SCENE,
        set: &[GRADED, "bearing.thickness_mm=20", "defect.length_mm=6", "defect.depth_mm=0.1"],
        starts: 8,
        models: &[AT_2_US],
    },
    Case {
        name: "inner",
        what: "spall on the inner raceway",
        scene: SCENE,
        set: &["mesh.size_mm=1.0", "defect.ring=inner", "solver.duration_ms=10"],
        starts: 8,
        models: &[AT_2_US],
    },
    Case {
        name: "oil",
        what: "oil, 2 % of structural damping",
        scene: "fixtures/scenes/oiled_steel.ron",
        set: &[GRADED, "model=reduced(modes_khz: 30.0)"],
        starts: 16,
        models: &[AT_2_US],
    },
    Case {
        name: "physical",
        what: "contacts as stiff as Hertz\u{2019}s, with oil",
        scene: "fixtures/scenes/physical.ron",
        set: &["solver.duration_ms=2.1"],
        starts: 2,
        models: &[("0.9 µs", &["model.step_us=2"])],
    },
    Case {
        name: "small",
        what: "NU 205, 1500 rpm",
        scene: "fixtures/scenes/atlas.ron",
        set: &[
            "bearing=NU 205",
            "mesh.size_mm=0.5",
            "mesh.roller_facets=112",
            "defects=[(on: outer, form: spall(length_mm: 2, depth_mm: 0.05))]",
            "solver.duration_ms=10",
        ],
        starts: 8,
        models: &[
            ("30 kHz", &["model.modes_khz=30", "model.step_us=0.5"]),
            ("60 kHz", &["model.modes_khz=60", "model.step_us=0.5"]),
        ],
    },
    Case {
        name: "paper-long",
        what: "the paper\u{2019}s, ten passages",
        scene: SCENE,
        set: &[GRADED, "solver.duration_ms=120"],
        starts: 12,
        models: &[AT_2_US],
    },
    Case {
        name: "load-long",
        what: "30 kN, 700 rpm, ten passages",
        scene: SCENE,
        set: &[
            "mesh.size_mm=1.0",
            "operation.load_n=30000",
            "operation.speed_rpm=700",
            "solver.duration_ms=85",
        ],
        starts: 12,
        models: &[AT_2_US],
    },
    Case {
        name: "rollers-long",
        what: "20 rollers, ten passages",
        scene: SCENE,
        set: &[GRADED, "bearing.rollers=20", "solver.duration_ms=140"],
        starts: 6,
        models: &[AT_2_US],
    },
];

/// A scene of which ledgers are kept for long, and steps of that [µs].
const LONG: &str = "fixtures/scenes/reduced.ron";
const LEDGER_US: [&str; 3] = ["5", "2", "0.5"];
const LEDGER_MS: [&str; 2] = ["1000", "10000"];

/// Result of a case with one reduced model.
struct Compared {
    case: &'static Case,
    /// In words, and the name of its folder.
    words: String,
    name: String,
    agreement: Agreement,
}

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let flags = &options.flags;
    let folder = host.root().join("runs/study/reduced");
    let mut all = Vec::new();
    for case in CASES {
        for model in case.models {
            let name = case.folder(model);
            let out = folder.join(&name);
            if flags.wants(&name) && !flags.runs_nothing() {
                host.say(&format!("{name}: {} starts", case.starts));
                if let Err(error) = validate(case, model, &out, &folder, flags, host) {
                    host.say(&format!("{name}: {error:#}"));
                }
                ensure!(!host.is_interrupted(), "interrupted; the same command goes on from here");
            }
            let Some(agreement) = read(&out)? else { continue };
            if agreement.scene_hash == case.scene(host.root(), model)?.hash()
                && agreement.starts == case.starts
            {
                all.push(Compared { case, words: format!("{}, {}", case.what, model.0), name, agreement });
            } else {
                host.say(&format!(
                    "{name}: what is there is of another scene or number of starts, and is left out"
                ));
            }
        }
    }
    let ledgers: Vec<Variant> = LEDGER_MS
        .iter()
        .flat_map(|ms| LEDGER_US.map(|us| (ms, us)))
        .map(|(ms, us)| {
            Variant::new(format!("ledger-{}us-{ms}ms", us.replace('.', "_")), LONG, &[])
                .with(format!("model.step_us={us}"))
                .with(format!("solver.duration_ms={ms}"))
                .with("output.interval_us=100")
        })
        .collect();
    let ledgers = Runner::new("reduced", flags, host).run(&ledgers)?;

    let mut sheet = Sheet::new(host.root(), "reduced", "The reduced bearing beside the full one");
    sheet.say(
        "How far is the reduced model from the full one, and what does it not keep? Each scene runs by both \
         from the same starts \
         (`stribeck validate`). Differences are reduced less full: means over the starts with half their 95 \
         % intervals, or, of \
         accelerations, one standard error. No number was fitted to any of them, but faults were found on \
         the first scene, with 20 rollers \
         and with oil: these are not unseen. **Bold** is outside its limit by more than chance may be; a \
         limit that so few starts cannot \
         tell is listed below.",
    );
    scenes(&mut sheet, &all);
    forces(&mut sheet, &all);
    accelerations(&mut sheet, &all);
    lines(&mut sheet, &all);
    peaks(&mut sheet, &all);
    outside(&mut sheet, &all);
    balance(&mut sheet, &ledgers);
    values(&mut sheet, &all);
    Ok(Answer::on(sheet.write()?))
}

impl Case {
    /// Its folder with one of the reduced models.
    fn folder(&self, (words, _): &Model) -> String {
        format!("{}-{}", self.name, words.replace(' ', "").replace('µ', "u").replace('.', "_").to_lowercase())
    }

    /// Overrides of its scene.
    fn set(&self, (_, own): &Model) -> Vec<String> {
        self.set.iter().chain(*own).map(|set| (*set).to_owned()).collect()
    }

    fn scene(&self, root: &Path, model: &Model) -> Result<Scene> {
        let scene = Scene::read_with(root.join(self.scene), &self.set(model));
        scene.with_context(|| format!("case `{}` is not a scene", self.name))
    }
}

/// Runs both models from all starts, those that are missing. Models of one scene share the runs of the full
/// model.
///
/// # Errors
/// When a run does not come to its end.
fn validate(
    case: &Case,
    model: &Model,
    out: &Path,
    folder: &Path,
    flags: &Flags,
    host: &dyn Host,
) -> Result<()> {
    let mut command = host.stribeck()?;
    command.arg("validate").arg(host.root().join(case.scene));
    command.args(case.set(model).iter().map(|set| format!("--set={set}")));
    command.arg(format!("--starts={}", case.starts));
    command.arg("--out").arg(out).arg("--full").arg(folder.join(format!("{}-full", case.name)));
    command.args(flags.of_a_command()).stdout(std::process::Stdio::null());
    let status = command.status().context("`stribeck validate` does not start")?;
    ensure!(status.success(), "`{}` did not come to its end", out.display());
    Ok(())
}

/// Result of a validation, if it has been made.
fn read(out: &Path) -> Result<Option<Agreement>> {
    let path = out.join("validation.json");
    let text = match std::fs::read(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        text => text.with_context(|| format!("cannot read {}", path.display()))?,
    };
    match serde_json::from_slice(&text) {
        Ok(agreement) => Ok(Some(agreement)),
        Err(error) => bail!("{}: {error}", path.display()),
    }
}

/// The scenes, and the computing time of both models.
fn scenes(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("The scenes");
    let rows: Vec<Vec<String>> = all
        .iter()
        .map(|Compared { case, words, agreement, .. }| {
            let [full_s, reduced_s] = agreement.cpu_s_per_ms;
            let changed: Vec<String> = case.set.iter().map(|set| format!("`{set}`")).collect();
            vec![
                words.clone(),
                format!("`{}`", case.scene.rsplit('/').next().unwrap_or(case.scene)),
                changed.join(", "),
                number(agreement.simulated_ms, 1),
                agreement.starts.to_string(),
                figures(full_s, 3),
                figures(reduced_s, 2),
            ]
        })
        .collect();
    let names = ["scene", "file", "changed", "ms", "starts", "full, s/ms", "reduced, s/ms"];
    sheet.table(&names, &rows);
    sheet.say(
        "The last two columns are processor time of a simulated millisecond, of as many runs side by \
        side as there were cores.",
    );
}

/// Forces on rollers, times of events, and the speed of the cage.
fn forces(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("Forces, events, cage");
    let of = |Compared { words, agreement, .. }: &Compared| {
        let by_name = |name: &str| agreement.rows.iter().find(|row| row.name == name);
        let events = agreement.rows.iter().filter(|row| row.scale == Scale::EventTime);
        let size = |row: &Row| row.difference.mean.abs();
        let worst = events.max_by(|a, b| size(a).total_cmp(&size(b)));
        let alike = |below_hz: f64| {
            let found = agreement.correlations.iter().find(|c| c.below_hz == below_hz);
            found.map_or(NONE.to_owned(), |c| number(c.value.mean, 3))
        };
        vec![
            words.clone(),
            by_name("forces_percent").map_or(NONE.to_owned(), |row| cell(row, 2)),
            by_name("load_percent").map_or(NONE.to_owned(), |row| cell(row, 4)),
            worst.map_or(NONE.to_owned(), |row| cell(row, 3)),
            by_name("cage_percent").map_or(NONE.to_owned(), |row| cell(row, 2)),
            alike(500.0),
            alike(2000.0),
        ]
    };
    let names = [
        "scene",
        "forces, rms, % of the largest",
        "mean load, %",
        "worst mean of unloading and reloading, ms",
        "cage, %",
        "correlation below 0.5 kHz",
        "below 2 kHz",
    ];
    sheet.table(&names, &all.iter().map(of).collect::<Vec<_>>());
    sheet.say(
        "Limits: 1 %, 0.1 %, 0.05 ms, 0.2 %. Forces are means over 0.25 ms, of every roller; correlations \
         those of the vertical acceleration \
         at the first sensor, start by start.",
    );
}

const NONE: &str = "–";

/// A mean over the starts with half its interval.
fn cell(row: &Row, decimals: usize) -> String {
    let d = &row.difference;
    let half = d.high.map_or(String::new(), |high| format!(" ± {}", number(high - d.mean, decimals)));
    marked(format!("{}{half}", number(d.mean, decimals)), row.told && !row.within)
}

fn marked(text: String, outside: bool) -> String {
    if outside { format!("**{text}**") } else { text }
}

/// A third octave: how far it is off, with its standard error [dB].
struct Band<'a> {
    sensor: &'a str,
    hz: f64,
    off_db: f64,
    error_db: Option<f64>,
}

impl Band<'_> {
    fn all_of(octaves: &Octaves) -> impl Iterator<Item = Band<'_>> {
        octaves.centres_hz.iter().enumerate().map(|(band, &hz)| Band {
            sensor: &octaves.sensor,
            hz,
            off_db: octaves.reduced_db[band] - octaves.full_db[band],
            error_db: octaves.error_db.get(band).copied(),
        })
    }

    fn is_outside(&self) -> bool {
        self.off_db.abs() > BAND_LIMIT_DB
    }

    /// Whether that is more than chance.
    fn is_told(&self) -> bool {
        self.error_db.is_some_and(|error| self.off_db.abs() - 2.0 * error > BAND_LIMIT_DB)
    }

    fn off(&self) -> String {
        let error = self.error_db.map_or(String::new(), |error| format!(" ± {}", number(error, 1)));
        marked(format!("{}{error}", number(self.off_db, 1)), self.is_told())
    }

    fn place(&self) -> String {
        format!("{}, {} kHz", self.sensor, figures(1e-3 * self.hz, 2))
    }
}

/// Third octaves of all sensors.
fn accelerations(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("Accelerations in third octaves, 0.5 to 10 kHz");
    let mut rows = Vec::new();
    for Compared { words, agreement, .. } in all.iter().filter(|c| !c.agreement.sensors.is_empty()) {
        let bands = || agreement.sensors.iter().flat_map(Band::all_of);
        let within = bands().filter(|band| !band.is_outside()).count();
        let mut errors: Vec<f64> = bands().filter_map(|band| band.error_db).collect();
        errors.sort_by(f64::total_cmp);
        let mut row = vec![words.clone(), format!("{within} of {}", bands().count())];
        row.extend(agreement.sensors.iter().map(|sensor| {
            let farthest = Band::all_of(sensor).max_by(|a, b| a.off_db.abs().total_cmp(&b.off_db.abs()));
            farthest.map_or(NONE.to_owned(), |band| {
                format!("{} at {} kHz", band.off(), figures(1e-3 * band.hz, 2))
            })
        }));
        row.push(errors.get(errors.len() / 2).map_or(NONE.to_owned(), |error| number(*error, 2)));
        rows.push(row);
    }
    let names = [
        "scene",
        "within 1.5 dB",
        "farthest at side, dB",
        "shoulder, dB",
        "seat, dB",
        "bottom, dB",
        "median standard error, dB",
    ];
    sheet.table(&names, &rows);
    sheet.say(
        "Levels of the mean power over the starts, both components together. One band in twenty is off by \
         two standard errors by chance. \
         In a rigid housing all sensors move as one.",
    );
}

/// Lines of BPFO.
fn lines(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("Lines of BPFO at the first sensor");
    let row_of = |Compared { words, agreement, .. }: &Compared| {
        let of = |n: usize| agreement.rows.iter().find(|row| row.name == format!("bpfo_{n}_percent"));
        of(1)?;
        let cells = (1..=5).map(|n| of(n).map_or(NONE.to_owned(), |row| cell(row, 1)));
        Some([words.clone()].into_iter().chain(cells).collect())
    };
    let rows: Vec<Vec<String>> = all.iter().filter_map(row_of).collect();
    sheet.table(&["scene", "line 1, %", "2, %", "3, %", "4, %", "5, %"], &rows);
    sheet.say("Of records of ten passages or more. Limit: 10 %.");
}

/// Largest accelerations, which have no limit.
fn peaks(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("Largest accelerations below 10 kHz");
    let row_of = |Compared { words, agreement, .. }: &Compared| {
        let cells = agreement.peaks.iter().map(|peak| peak.difference().replace('-', "−"));
        [words.clone()].into_iter().chain(cells).collect()
    };
    let rows: Vec<Vec<String>> = all.iter().filter(|c| !c.agreement.peaks.is_empty()).map(row_of).collect();
    sheet.table(&["scene", "side", "shoulder", "seat", "bottom"], &rows);
    sheet.say(
        "Means of the largest of each start, with one standard error. They have no limit: each is that \
        of a single impact.",
    );
}

/// Effects that are left out, and differences that are not resolved.
fn outside(sheet: &mut Sheet, all: &[Compared]) {
    sheet.heading("What is not kept, and what cannot be told");
    let mut rows = Vec::new();
    for Compared { words, agreement, .. } in all {
        let kept = agreement.rows.iter().filter(|row| row.told && row.within).count();
        let failed = agreement.rows.iter().filter(|row| !row.over_bands() && row.told && !row.within);
        let mut outside: Vec<String> =
            failed.map(|row| format!("{}: {} {}", row.quantity, cell(row, 3), row.scale.unit())).collect();
        let bands = || agreement.sensors.iter().flat_map(Band::all_of).filter(Band::is_outside);
        let of_band = |band: Band<'_>| format!("{}: {} dB", band.place(), band.off());
        outside.extend(bands().filter(Band::is_told).map(of_band));
        let mut open: Vec<String> = agreement
            .open()
            .filter(|row| !row.over_bands() && !row.within)
            .map(|row| format!("{}: {} {}", row.quantity, cell(row, 3), row.scale.unit()))
            .collect();
        open.extend(bands().filter(|band| !band.is_told()).map(of_band));
        let said = |list: Vec<String>| if list.is_empty() { NONE.to_owned() } else { list.join("; ") };
        rows.push(vec![
            words.clone(),
            format!("{kept} of {}", agreement.rows.len()),
            said(outside),
            said(open),
        ]);
    }
    let names = [
        "scene",
        "kept for certain, of all quantities",
        "outside its limit",
        "beyond it, by no more than chance may do",
    ];
    sheet.table(&names, &rows);
    sheet.say(
        "Third octaves of a sensor are one quantity, and kept when each of their bands is. Over ten passages \
         the difference of the cages has \
         its time: rollers come the later, the farther they are behind. What the reduced model leaves out is \
         in \
         THEORY §9.6; of the NU 205 the band at 3.2 kHz holds the tone of the full model\u{2019}s mesh, \
         which it has not.",
    );
}

/// Energy imbalance of long runs.
fn balance(sheet: &mut Sheet, ledgers: &[Finished]) {
    sheet.heading("Energy over seconds");
    let row_of = |run: &Finished| {
        let (summary, info) = run.numbers().zip(run.info.as_ref())?;
        let energy = &summary.energy;
        Some(vec![
            number(info.simulated_s, 0),
            figures(1e6 * info.time_step_s, 1),
            figures(100.0 * energy.max_relative_error, 2),
            energy.share_of_heat.map_or(NONE.to_owned(), |share| figures(100.0 * share, 2)),
            figures(info.loop_cpu_s / info.simulated_s, 2),
        ])
    };
    let rows: Vec<Vec<String>> = ledgers.iter().filter_map(row_of).collect();
    let names = [
        "simulated, s",
        "step, µs",
        "missing, % of the peak strain energy",
        "missing, % of the heat",
        "processor time, s a simulated second",
    ];
    sheet.table(&names, &rows);
    sheet.say(
        "`reduced.ron` with samples every 100 µs. The error of the step adds up with the heat, and \
        goes as the square of the step.",
    );
    for run in ledgers {
        let energy = run.numbers().map(|summary| &summary.energy);
        sheet.value("energy", &run.variant.name, "of strain energy", energy.map(|e| e.max_relative_error));
        sheet.value("energy", &run.variant.name, "of heat", energy.and_then(|e| e.share_of_heat));
    }
}

/// Every number.
fn values(sheet: &mut Sheet, all: &[Compared]) {
    for Compared { name, agreement, .. } in all {
        for row in &agreement.rows {
            let d = &row.difference;
            sheet.value("difference", name, &row.name, Some(d.mean));
            sheet.value("low", name, &row.name, d.low);
            sheet.value("high", name, &row.name, d.high);
        }
        for band in agreement.sensors.iter().flat_map(Band::all_of) {
            let what = format!("octave_{}_{:.0}_hz_db", band.sensor, band.hz);
            sheet.value("difference", name, &what, Some(band.off_db));
            sheet.value("error", name, &what, band.error_db);
        }
        for peak in &agreement.peaks {
            let (off, error) = peak.difference_percent();
            let what = format!("peak_{}_percent", peak.sensor);
            sheet.value("difference", name, &what, Some(off));
            sheet.value("error", name, &what, error);
        }
        for (which, seconds) in ["full", "reduced"].into_iter().zip(agreement.cpu_s_per_ms) {
            sheet.value("processor_s_per_ms", name, which, Some(seconds));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field that is misspelt here would come to light after hours.
    #[test]
    fn example_every_case_is_a_scene_of_both_models() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for case in CASES {
            for model in case.models {
                let scene = case.scene(&root, model).expect("a scene");
                assert!(scene.with_overrides(&["model=full".to_owned()]).is_ok(), "{}", case.name);
            }
        }
    }

    #[test]
    fn example_a_band_is_outside_where_two_standard_errors_leave_no_other_answer() {
        let band = |off_db, error_db| Band { sensor: "seat", hz: 6349.6, off_db, error_db };
        let sure = band(-2.9, Some(0.6));
        assert!(sure.is_outside() && sure.is_told());
        assert_eq!((sure.off(), sure.place()), ("**−2.9 ± 0.6**".to_owned(), "seat, 6.3 kHz".to_owned()));
        let chance = band(-1.9, Some(0.7));
        assert!(chance.is_outside() && !chance.is_told());
        assert_eq!(chance.off(), "−1.9 ± 0.7");
        // One start has no scatter, and decides nothing.
        assert!(!band(9.0, None).is_told());
    }
}
