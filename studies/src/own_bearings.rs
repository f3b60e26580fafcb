//! `cargo xtask study own`: whether bearings by their own fields run at the first try, by both models.

use stribeck_analysis::plan::Loads;
use stribeck_scene::scene::Assumed;
use stribeck_store::run_info::{RunInfo, Status, clock};

use anyhow::Result;

use crate::table::{figures, number};
use crate::{Answer, Finished, Flags, Host, Runner, Sheet, Variant};

/// Flags of `study own`.
#[derive(Debug, clap::Args)]
pub struct Options {
    #[command(flatten)]
    flags: Flags,
}

/// The bearings, in the order of their bores.
const SCENES: [(&str, &str); 10] = [
    ("nki5", "fixtures/scenes/own/nki5.ron"),
    ("four", "fixtures/scenes/own/four.ron"),
    ("nu1005", "fixtures/scenes/own/nu1005.ron"),
    ("nu406", "fixtures/scenes/own/nu406.ron"),
    ("n1010", "fixtures/scenes/own/n1010.ron"),
    ("nu410", "fixtures/scenes/own/nu410.ron"),
    ("nu1016", "fixtures/scenes/own/nu1016.ron"),
    ("n1020", "fixtures/scenes/own/n1020.ron"),
    ("nu1030", "fixtures/scenes/own/nu1030.ron"),
    ("nu1060", "fixtures/scenes/own/nu1060.ron"),
];

/// One second in its modes.
const REDUCED: [&str; 4] =
    ["model=reduced()", "solver.duration_ms=1000", "output.interval_us=50", "output.frames=None"];
/// Three milliseconds of finite elements, larger away from the contacts.
const FULL: [&str; 3] = ["solver.duration_ms=3", "mesh.grading=()", "output.frames=None"];

pub(crate) fn run(options: &Options, host: &dyn Host) -> Result<Answer> {
    let variants: Vec<Variant> = SCENES
        .iter()
        .flat_map(|(name, scene)| {
            [
                Variant::new(format!("{name}-reduced"), scene, &REDUCED),
                Variant::new(format!("{name}-full"), scene, &FULL),
            ]
        })
        .collect();
    let runs = Runner::new("own", &options.flags, host).run(&variants)?;
    let mut sheet = Sheet::new(host.root(), "own", "Bearings by their own fields, at the first try");
    sheet.say(
        "Ten bearings of `fixtures/scenes/own`, none of the catalogue, with dimensions as makers print \
         them. Each \
         file has fields of `bearing` alone; cage, adapter, defect, elements, load, stiffness of the contact and \
         what is missing of the bearing follow from them. Each was run for one second by the reduced model \
         (`--set model=reduced()`) and for 3 ms by the full one (`--set mesh.grading=()`), in oil, as the defaults \
         have it. Forces between rigid rings are within 5 % of theory in all of them \
         (`analytic_own_bearings_between_rigid_rings`).",
    );
    bearings(&mut sheet, &runs);
    sheet.heading("One second by the reduced model");
    table(&mut sheet, &runs, "reduced");
    sheet.heading("3 ms by the full model");
    table(&mut sheet, &runs, "full");
    let failed = |run: &Finished| run.info.as_ref().is_none_or(|info| info.status != Status::Complete);
    let names: Vec<&str> =
        runs.iter().filter(|run| failed(run)).map(|run| run.variant.name.as_str()).collect();
    let failure = (!names.is_empty()).then(|| format!("not complete: {}", names.join(", ")));
    Ok(Answer { failure, ..Answer::on(sheet.write()?) })
}

/// Dimensions to which each was completed.
fn bearings(sheet: &mut Sheet, runs: &[Finished]) {
    let rows = runs.iter().filter(|run| run.variant.name.ends_with("-reduced")).map(|run| {
        let (scene, b) = (&run.scene, &run.scene.written.bearing);
        let bore = b.inner_race_diameter_mm - 2.0 * b.inner_ring_thickness_mm;
        let words = |what: &Assumed| match what {
            Assumed::Clearance => "clearance".to_owned(),
            Assumed::Pitch => "pitch".to_owned(),
            Assumed::OuterRing => "outer ring".to_owned(),
            Assumed::InnerRing => "inner ring".to_owned(),
            Assumed::Rollers => "number".to_owned(),
            Assumed::Length => "length".to_owned(),
        };
        let assumed: Vec<String> = b.assumed.iter().map(words).collect();
        let (carried, pressure, safety) =
            Loads::of(scene).map_or(("–".into(), "–".into(), "–".into()), |loads| {
                (
                    number(1e-3 * loads.largest_n, 2),
                    number(1e-6 * loads.pressure_pa[1], 0),
                    number(loads.static_safety(), 1),
                )
            });
        vec![
            run.variant.name.replace("-reduced", ""),
            number(bore, 1),
            b.rollers.to_string(),
            number(b.roller_diameter_mm, 2),
            number(1e6 * scene.clearance, 0),
            number(1e-3 * scene.load, 2),
            carried,
            pressure,
            safety,
            assumed.join(", "),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    sheet.table(
        &[
            "bearing",
            "bore [mm]",
            "rollers",
            "diameter [mm]",
            "clearance [µm]",
            "load [kN]",
            "largest force [kN]",
            "Hertz pressure [MPa]",
            "s₀",
            "assumed",
        ],
        &rows,
    );
}

/// How the runs of one model ended.
fn table(sheet: &mut Sheet, runs: &[Finished], model: &str) {
    let of_model = runs.iter().filter(|run| run.variant.name.ends_with(model));
    let rows: Vec<Vec<String>> = of_model.map(|run| row(run, model)).collect();
    for run in runs.iter().filter(|run| run.variant.name.ends_with(model)) {
        let info = run.info.as_ref();
        sheet.value(model, &run.variant.name, "energy", info.map(|info| info.energy.of_larger()));
        sheet.value(model, &run.variant.name, "penetration", info.map(|info| info.guards.penetration_share));
    }
    let size = if model == "reduced" { "modes" } else { "elements" };
    sheet.table(
        &[
            "bearing",
            size,
            "step [µs]",
            "ended",
            "energy off by",
            "cage off [mm]",
            "its room [mm]",
            "sunk in [% of an element]",
            "warnings",
            "run",
        ],
        &rows,
    );
}

fn row(run: &Finished, model: &str) -> Vec<String> {
    let name = run.variant.name.replace(&format!("-{model}"), "");
    let Some(info) = &run.info else {
        let why = run.summary.as_ref().err().map_or("not run", String::as_str);
        return std::iter::once(name).chain([why.to_owned()]).chain((0..8).map(|_| "–".to_owned())).collect();
    };
    let scene = &run.scene;
    let room = scene.cage.as_ref().map(|cage| {
        let [inner, outer] = cage.radii();
        (scene.outer_race_radius - outer).min(inner - scene.inner_race_radius)
    });
    let size = info.reduced.as_ref().map_or(info.mesh.quads + info.mesh.triangles, |reduced| reduced.modes);
    vec![
        name,
        size.to_string(),
        figures(1e6 * info.time_step_s, 3),
        ended(info),
        info.energy.in_words(),
        figures(1e3 * info.guards.cage_offset_m, 2),
        room.map_or("–".to_owned(), |room| figures(1e3 * room, 2)),
        number(100.0 * info.guards.penetration_share, 1),
        info.warnings.len().to_string(),
        clock(info.setup_s + info.wall_s),
    ]
}

fn ended(info: &RunInfo) -> String {
    match info.status {
        Status::Complete => "complete".to_owned(),
        _ => format!("**{}**", info.stop_reason.as_deref().unwrap_or("not complete")),
    }
}
