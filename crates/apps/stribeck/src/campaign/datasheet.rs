//! The data sheet of a data set, made from its runs and tables, beside them.

use std::collections::{BTreeMap, BTreeSet};

use stribeck_analysis::quantity::{Quantity, stem_and_unit};
use stribeck_analysis::summary::Summary;
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_store::campaign::Campaign;
use stribeck_store::run_dir::Keep;

use super::tables::{EVENTS, RUNS, Row, SIGNALS, Truth, Written, model, sampling_rate_hz};

/// The page in Markdown.
pub(super) fn text(campaign: &Campaign, rows: &[Row], written: &Written) -> String {
    let scenes: Vec<&Scene> = rows.iter().filter_map(|row| row.scene.as_ref()).collect();
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
         `{RUNS}` has a row for each run, also for those that failed: `status` and `reason` say why, and \
         `warnings` what the guards of a run have warned of, a line each. `{EVENTS}` has a row for each \
         passage of a roller over a spall of a raceway{}; `run` joins them. The split is drawn by the scene \
         of a variant, in each fault of each bearing, so no scene and no start of it stands in two parts; \
         further values may move a scene to another part.\n\n\
         Ground truth: `model`, `fault_*`, `deviation_type`, `shaft_speed_rpm` and `load_n`, which a profile \
         may vary. A fault strikes once a passage; waves, roughness and other diameters are deviations. \
         Size, depth and angle at the start are those of the first fault of the scene that has a length. \
         `bpfo_hz`, `bpfi_hz`, `bsf_hz` and `ftf_hz` are kinematic, without slip. `scene.*` are the fields \
         that vary, `summary.*` what the analysis of each run found (docs/THEORY.md, §7, says how). Of an \
         event, `expected_*` is when the roller's centre is over an edge without slip, `path_*` when the \
         recorded one is, and `entry_ms` and `exit_ms` are read from its force. What depends on machine or \
         interruptions is only in the folders of the runs.\n\n## Limits\n\n",
        if written.signals.is_empty() {
            String::new()
        } else {
            format!(
                ", `{SIGNALS}` one for each sample of the accelerations, a group of rows a run, of the runs \
                 that are complete: one that diverged has no signals there"
            )
        },
    );
    for limit in limits(&scenes) {
        page += &format!("- {limit}\n");
    }
    let quantities = Summary::quantities();
    for (table, columns) in [(RUNS, &written.runs), (EVENTS, &written.events), (SIGNALS, &written.signals)] {
        if !columns.is_empty() {
            page += &format!("\n## Columns of `{table}`\n\n| column | unit | what it is |\n|---|---|---|\n");
        }
        for column in columns {
            let unit = stem_and_unit(column).1;
            page += &format!("| `{column}` | {unit} | {} |\n", meaning(column, &quantities));
        }
    }
    page += &format!("\n## The campaign\n\n```ron\n{}\n```\n", campaign.text.trim_end());
    page
}

/// Columns that are neither numbers of a summary nor fields that vary.
const OWN_COLUMNS: [(&str, &str); 29] = [
    ("run", "Number of the run in the campaign"),
    ("variant", "Number of its scene"),
    ("start", "Number of its random start"),
    ("split", "Part of the data: `train`, `validation` or `test`"),
    ("status", "How the run ended"),
    ("reason", "Why it did not complete"),
    ("warnings", "What its guards have warned of, a line each"),
    ("scene_hash", "Name of its folder below `runs/`"),
    ("bearing", "Designation"),
    ("model", "`full` or `reduced`"),
    ("fault_location", "Damaged part, `healthy` without one"),
    ("fault_type", "Form of the damage"),
    ("fault_count", "Faults of the scene"),
    ("fault_size_mm", "Length along the raceway"),
    ("fault_depth_mm", "Depth"),
    ("fault_angle_deg", "Place at the start"),
    ("deviation_type", "Waves, roughness and other diameters"),
    ("claimed", "Family that the verdict claims on the record; `none`, or `undecided`"),
    ("shaft_speed_rpm", "Speed of the shaft at the start"),
    ("load_n", "Load at the start"),
    ("sampling_rate_hz", "Samples a second"),
    ("n_samples", "Samples of the record"),
    ("bpfo_hz", "Frequency of the outer raceway without slip"),
    ("bpfi_hz", "Frequency of the inner raceway without slip"),
    ("bsf_hz", "Spin of an element without slip; a spot strikes twice as often"),
    ("ftf_hz", "Turns of the cage without slip"),
    ("time_s", "Time since the start of the run"),
    ("ring", "Part that has the spall"),
    ("floor_by", "What stopped the roller at the floor of the spall: `film` or `metal`"),
];

fn meaning(column: &str, quantities: &[Quantity]) -> String {
    let of_event = format!("events.{column}");
    let path = column.strip_prefix("summary.").unwrap_or(&of_event);
    if let Some(quantity) = quantities.iter().find(|quantity| quantity.path == path) {
        return quantity.about_in_markdown();
    }
    let own = OWN_COLUMNS.iter().find(|(name, _)| *name == column).map(|(_, what)| *what);
    let what = own.unwrap_or(match column.split_once('.') {
        Some(("scene", _)) => "Value of this field of the scene",
        Some(("sensor", _)) => "Acceleration at a sensor",
        _ => "",
    });
    what.to_owned()
}

fn contents(campaign: &Campaign, rows: &[Row], scenes: &[&Scene]) -> Vec<(&'static str, String)> {
    let of_scenes = |of: &dyn Fn(&Scene) -> String| counted(scenes.iter().map(|scene| of(scene)));
    let range = |of: &dyn Fn(&Scene) -> f64, unit: &str| span(scenes.iter().map(|scene| of(scene)), unit);
    let complete = rows.iter().filter(|row| row.is_complete()).filter_map(|row| row.scene.as_ref());
    let fault = |scene: &Scene| {
        let truth = Truth::of(scene);
        truth.form.map_or(truth.location.clone(), |form| format!("{} ({form})", truth.location))
    };
    let sensors = scenes.iter().flat_map(|scene| {
        scene.output.sensors.iter().map(|sensor| format!("{} at {}°", sensor.name, sensor.angle_deg))
    });
    let sensors: BTreeSet<String> = sensors.collect();
    vec![
        ("runs", rows.len().to_string()),
        ("ended as", counted(rows.iter().map(|row| row.status.to_owned()))),
        ("runs with warnings", rows.iter().filter(|row| row.warnings.is_some()).count().to_string()),
        ("split", counted(rows.iter().map(|row| row.split.to_owned()))),
        ("seed", campaign.seed.to_string()),
        ("model", of_scenes(&|scene| model(scene).to_owned())),
        (
            "bearing",
            of_scenes(&|scene| match scene.bearing.designation.as_str() {
                "" => "without a designation".to_owned(),
                name => name.to_owned(),
            }),
        ),
        ("faults", of_scenes(&fault)),
        ("other deviations", of_scenes(&|scene| Truth::of(scene).deviations.unwrap_or("none".to_owned()))),
        ("raceways", of_scenes(&|scene| if scene.film.is_some() { "oiled" } else { "dry" }.to_owned())),
        (
            "material",
            of_scenes(&|scene| {
                let m = &scene.material;
                format!("{} GPa, {}, {} kg/m³", m.youngs_modulus_gpa, m.poissons_ratio, m.density_kg_m3)
            }),
        ),
        ("speed of the shaft", range(&|scene| scene.operation.speed_rpm, "rpm")),
        ("load", range(&|scene| scene.operation.load_n, "N")),
        ("length of a record", span(complete.map(|scene| scene.solver.duration_ms), "ms")),
        ("sampling rate", range(&sampling_rate_hz, "Hz")),
        ("sensors on the outer ring", sensors.into_iter().collect::<Vec<_>>().join(", ")),
    ]
}

fn limits(scenes: &[&Scene]) -> Vec<String> {
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
    let truths: Vec<Truth> = scenes.iter().map(|scene| Truth::of(scene)).collect();
    let has = |form: &str| {
        let mut forms = truths.iter().flat_map(|truth| [&truth.form, &truth.deviations]).flatten();
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
fn programs(rows: &[Row]) -> String {
    let programs: BTreeSet<&str> = rows.iter().filter_map(|row| row.program.as_deref()).collect();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_limits_are_those_of_what_is_there() {
        let scene = |set: &[&str]| Scene::default().with_overrides(set).expect("a scene");
        let full = scene(&["film=None"]);
        let dented = scene(&[
            "film=None",
            "defect=None",
            "model=reduced(modes_khz: 20.0)",
            "defects=[(on: outer, form: dent())]",
        ]);
        let [of_full, of_dented] = [limits(&[&full]).join("\n"), limits(&[&dented]).join("\n")];
        assert!(of_full.contains("Full model") && of_full.contains("Spalls") && !of_full.contains("Dents"));
        assert!(of_dented.contains("up to 20 kHz") && of_dented.contains("Dents"), "{of_dented}");
        assert!(!of_dented.contains("Full model") && !of_dented.contains("Spalls"), "{of_dented}");
    }
}
