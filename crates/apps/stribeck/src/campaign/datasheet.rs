//! The data sheet of a data set, made from its runs and tables, beside them.

use std::collections::{BTreeMap, BTreeSet};

use stribeck_analysis::quantity::{columns, in_markdown, stem_and_unit};
use stribeck_analysis::runs::{EventRow, OneOfMany, RunRow, SignalRow, Truth, level_column};
use stribeck_analysis::summary::Summary;
use stribeck_diagnosis::Defect;
use stribeck_diagnosis::quantity::Entry;
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_store::campaign::{Campaign, DataSet};
use stribeck_store::run_dir::Keep;

use super::checksums::CHECKSUMS;
use super::tables::{EVENTS, RECORDS, RUNS, SIGNALS, Written};
use super::{CAMPAIGN, DATASHEET};

/// The page in Markdown.
pub(super) fn text(campaign: &Campaign, rows: &[OneOfMany], written: &Written) -> String {
    let scenes: Vec<&Scene> = rows.iter().filter_map(|one| one.scene.as_ref()).collect();
    let mut page = format!(
        "# Data set `{}`\n\n\
         Simulated by Stribeck {}; nothing in it was measured. Each run is a folder below `runs/`, named by \
         the hash of its scene, with its complete scene, provenance{}.\n\n| | |\n|---|---|\n",
        campaign.name,
        programs(rows),
        match campaign.keep {
            Keep::All => ", sampled channels and energy ledger",
            Keep::Signals => ", numbers and the channels of its sensors",
            Keep::Numbers => " and numbers",
        },
    );
    for (what, value) in contents(campaign, rows, &scenes) {
        page += &format!("| {what} | {value} |\n");
    }
    page += &format!(
        "\n## Tables\n\n\
         `{RUNS}` has a row for each run, also for those that failed, `{EVENTS}` one for each passage of a \
         roller over a spall of a raceway{}; `run` joins them. The split is drawn by the scene of a variant, \
         in each fault of each bearing, so no scene and no start of it stands in two parts; further values \
         may move a scene to another part.\n\n\
         Ground truth: `model`, `fault_*`, `deviation_type`, `shaft_speed_rpm` and `load_n`. A fault strikes \
         once a passage; waves, roughness and other diameters are deviations. `scene.*` are the fields that \
         vary, `summary.*` what the analysis of each run found (docs/THEORY.md, §7, says how). What depends \
         on machine or interruptions is only in the folders of the runs.\n\n## Limits\n\n",
        if written.signals.is_empty() {
            String::new()
        } else {
            format!(
                ", `{SIGNALS}` one for each sample of the accelerations, a group of rows a run, of the runs \
                 that are complete: one that diverged has no signals there"
            )
        },
    );
    let refused = campaign.refused().into_iter().map(|refused| refused.to_string());
    for note in refused.chain(campaign.lost_labels()) {
        page += &format!("- {note}.\n");
    }
    for limit in limits(rows) {
        page += &format!("- {limit}\n");
    }
    let known = meanings();
    for (table, columns) in [(RUNS, &written.runs), (EVENTS, &written.events), (SIGNALS, &written.signals)] {
        if !columns.is_empty() {
            page += &format!("\n## Columns of `{table}`\n\n| column | unit | what it is |\n|---|---|---|\n");
        }
        for column in columns {
            let unit = stem_and_unit(column).1;
            page += &format!("| `{column}` | {unit} | {} |\n", meaning(column, &known));
        }
    }
    if let Some(DataSet { licence, citation, .. }) = &campaign.data_set {
        page += &format!(
            "\n## Questions of a data sheet\n\n\
             After Gebru et al., *Datasheets for datasets*, Communications of the ACM 64(12), 2021.\n\n\
             - **Motivation.** Records of known cause, size, load, speed and path, in equal numbers of each kind, to \
             train and to try diagnoses before they meet measured ones.\n\
             - **Composition.** An instance is a record of one machine's sensor; none is left out but those that \
             `status` names. No record is measured, and none is of persons.\n\
             - **Collection.** Drawn by the campaign below, from its seeds, and simulated.\n\
             - **Preprocessing.** The first 0.05 s of a run, in which its bearing settles, are left out. Nothing is \
             filtered or scaled but by the machine's sensor.\n\
             - **Uses.** Not as the only evidence that a diagnosis works: simulated impacts differ less from one \
             another than real ones. Records of one bearing, or of one machine, belong on one side of a split.\n\
             - **Distribution and maintenance.** {licence}. Cite as: {citation} A new version is made by a new commit, \
             whose name it has.\n"
        );
    }
    page += &format!("\n## The campaign\n\n```ron\n{}\n```\n", campaign.text.trim_end());
    page
}

/// The card of a data set, with the head that Hugging Face reads in a `README.md`.
pub(super) fn card(data_set: &DataSet, campaign: &Campaign, rows: &[OneOfMany], written: &Written) -> String {
    let DataSet { title, licence, citation, .. } = data_set;
    let complete = rows.iter().filter(|one| one.is_complete()).count();
    let first = rows.iter().filter(|one| one.is_complete()).find_map(|one| one.row.n_samples).unwrap_or(0);
    format!(
        "---\nlicense: {}\npretty_name: {title}\ntags: [bearings, vibration, fault-diagnosis, simulated]\n---\n\n\
         # {title}\n\n\
         {complete} records, all simulated by Stribeck {}, in {} files `{RECORDS}/part-*.parquet`: a row a record, with \
         `run`, `split`, `bearing`, `fault_location`, `rate_hz`, the acceleration `a_m_s2` [m/s²] and the pulses of a \
         tachometer, one a turn, `turns_s` [s]. `{RUNS}` has every label with its unit, joined by `run`; \
         [{DATASHEET}]({DATASHEET}) says what each is, how the records were made, and what they are not.\n\n\
         ```python\n\
         import polars as pl, torch\n\
         records = pl.read_parquet(\"{RECORDS}/*.parquet\").join(pl.read_parquet(\"{RUNS}\"), on=\"run\")\n\
         x = records[\"a_m_s2\"].list.to_array({first}).to_numpy()   # numpy, a row a record\n\
         y = records[\"fault_location\"].to_numpy()\n\
         tensor = torch.from_numpy(x)\n\
         ```\n\n\
         Licence: {licence}. Cite as: {citation} `sha256sum --check {CHECKSUMS}` finds damage. The same commit makes the \
         same bytes again, by `stribeck sweep {CAMPAIGN}` of the campaign `{}`.\n",
        licence.to_lowercase(),
        programs(rows),
        written.records.len(),
        campaign.name
    )
}

/// What each column is, by its name.
fn meanings() -> BTreeMap<String, String> {
    let declared = [columns::<RunRow>(), columns::<EventRow>(), columns::<SignalRow>()];
    let entry = |entry: &Entry| (entry.name.to_owned(), in_markdown(entry.about));
    let mut all: BTreeMap<String, String> = declared.iter().flatten().map(|e| entry(e)).collect();
    for quantity in Summary::quantities() {
        let about = quantity.about_in_markdown();
        if quantity.path == "diagnosis.families.level_db" {
            all.extend(Defect::ALL.map(|of| (format!("summary.{}", level_column(of)), about.clone())));
        }
        all.insert(format!("summary.{}", quantity.path), about);
    }
    all
}

fn meaning(column: &str, known: &BTreeMap<String, String>) -> String {
    let other = match column.split_once('.') {
        Some(("scene", _)) => "Value of this field of the scene",
        Some(("sensor", _)) => "Acceleration at a sensor",
        _ => "",
    };
    known.get(column).cloned().unwrap_or_else(|| other.to_owned())
}

fn contents(campaign: &Campaign, rows: &[OneOfMany], scenes: &[&Scene]) -> Vec<(&'static str, String)> {
    let truths = || rows.iter().filter_map(|one| one.row.truth.as_ref());
    let of_truths = |of: &dyn Fn(&Truth) -> String| counted(truths().map(of));
    let of_scenes = |of: &dyn Fn(&Scene) -> String| counted(scenes.iter().map(|scene| of(scene)));
    let range = |of: &dyn Fn(&Truth) -> f64, unit: &str| span(truths().map(of), unit);
    let complete = rows.iter().filter(|one| one.is_complete()).filter_map(|one| one.scene.as_ref());
    let or = |text: &str, other: &str| if text.is_empty() { other } else { text }.to_owned();
    let sensors = scenes.iter().flat_map(|scene| {
        scene.output.sensors.iter().map(|sensor| format!("{} at {}°", sensor.name, sensor.angle_deg))
    });
    let sensors: BTreeSet<String> = sensors.collect();
    vec![
        ("runs", rows.len().to_string()),
        ("ended as", counted(rows.iter().map(|one| one.row.status.clone()))),
        ("runs with warnings", rows.iter().filter(|one| one.row.warnings.is_some()).count().to_string()),
        ("split", counted(rows.iter().map(|one| one.row.split.clone()))),
        ("seed", campaign.seed.to_string()),
        ("model", of_truths(&|truth| truth.model.clone())),
        ("bearing", of_truths(&|truth| or(&truth.bearing, "without a designation"))),
        (
            "faults",
            of_truths(&|truth| {
                let form = truth.fault_type.as_ref().map_or_else(String::new, |form| format!(" ({form})"));
                format!("{}{form}", truth.fault_location)
            }),
        ),
        ("other deviations", of_truths(&|truth| or(truth.deviation_type.as_deref().unwrap_or(""), "none"))),
        ("raceways", of_scenes(&|scene| if scene.film.is_some() { "oiled" } else { "dry" }.to_owned())),
        (
            "material",
            of_scenes(&|scene| {
                let m = &scene.material;
                format!("{} GPa, {}, {} kg/m³", m.youngs_modulus_gpa, m.poissons_ratio, m.density_kg_m3)
            }),
        ),
        ("speed of the shaft", range(&|truth| truth.shaft_speed_rpm, "rpm")),
        ("load", range(&|truth| truth.load_n, "N")),
        ("length of a record", span(complete.map(|scene| scene.solver.duration_ms), "ms")),
        ("sampling rate", range(&|truth| truth.sampling_rate_hz, "Hz")),
        ("sensors on the outer ring", sensors.into_iter().collect::<Vec<_>>().join(", ")),
    ]
}

fn limits(rows: &[OneOfMany]) -> Vec<String> {
    let scenes: Vec<&Scene> = rows.iter().filter_map(|one| one.scene.as_ref()).collect();
    let mut limits = vec![
        "A plane model of the thickness that each scene gives: nothing tilts, and nothing moves along the \
         axis."
            .to_owned(),
    ];
    let reduced = scenes.iter().filter_map(|scene| match &scene.model {
        ModelScene::Full => None,
        ModelScene::Reduced(reduced) => Some(reduced.modes_khz),
    });
    let reduced: Vec<f64> = reduced.collect();
    if reduced.len() < scenes.len() {
        limits.push(
            "Full model: peaks above some kilohertz differ between starts of one scene by tens of per cent: \
             learn from distributions, not from single records."
                .to_owned(),
        );
    }
    if !reduced.is_empty() {
        limits.push(format!(
            "Reduced model: outer ring and housing have their modes up to {}, rollers and cage are rigid \
             bodies with local compliance; what lies above is not of the structure.",
            span(reduced.into_iter(), "kHz")
        ));
    }
    let has = |form: &str| {
        let truths = rows.iter().filter_map(|one| one.row.truth.as_ref());
        let mut forms = truths.flat_map(|truth| [&truth.fault_type, &truth.deviation_type]).flatten();
        forms.any(|forms| forms.split('+').any(|one| one == form))
    };
    for (form, limit) in [
        (
            "spall",
            "Spalls have a flat floor between two edges, as long as the bearing is thick; they do not grow, \
             and have no debris.",
        ),
        ("dent", "Dents are smooth hollows with a raised rim, as long as the bearing is thick."),
        ("profile", "Profiles are linear between their points, and the same along the axis."),
        ("waviness", "Waviness is one sine wave around the surface."),
        (
            "roughness",
            "Roughness is random waves of a band of lengths; what is finer than the mesh is not there.",
        ),
        ("missing", "A rolling element that is missing leaves its pocket empty."),
    ] {
        if has(form) {
            limits.push(limit.to_owned());
        }
    }
    limits
}

/// Versions and commits of the program that ran the runs.
fn programs(rows: &[OneOfMany]) -> String {
    let programs: BTreeSet<&str> = rows.iter().filter_map(|one| one.program.as_deref()).collect();
    if programs.is_empty() {
        return env!("CARGO_PKG_VERSION").to_owned();
    }
    programs.into_iter().collect::<Vec<_>>().join(" and ")
}

/// Each word with its number of occurrences.
fn counted(words: impl Iterator<Item = String>) -> String {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    words.for_each(|word| *counts.entry(word).or_default() += 1);
    counts.into_iter().map(|(name, count)| format!("{name}: {count}")).collect::<Vec<_>>().join("; ")
}

/// The least and the largest number.
fn span(numbers: impl Iterator<Item = f64>, unit: &str) -> String {
    let ends = numbers.fold(None, |ends: Option<[f64; 2]>, n| {
        Some(ends.map_or([n, n], |[least, most]| [least.min(n), most.max(n)]))
    });
    match ends {
        Some([least, most]) if least < most => format!("{least} to {most} {unit}"),
        Some([same, _]) => format!("{same} {unit}"),
        None => String::new(),
    }
}
