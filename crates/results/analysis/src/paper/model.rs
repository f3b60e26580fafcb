//! Input of the paper: dimensions, material, mesh, load (its section 2).

use super::{RowInputs, number, words};
use stribeck_scene::scene::SolverScene;

use crate::ring;
use crate::summary::PaperRow;

const PART: &str = "Model";
const GIVEN: &str = "given";

pub(super) fn rows(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let mut rows = table_1(source);
    rows.extend(discretisation(source));
    rows.extend(operation(source));
    rows
}

fn table_1(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let (b, m) = (&source.scene.written.bearing, &source.scene.written.material);
    let given = |quantity: &str, paper: f64, ours: f64, unit: &str| {
        number(PART, quantity, paper, Some(ours), unit, GIVEN)
    };
    let mut rows = vec![
        given("Outer race diameter D_o", 200.0, b.outer_race_diameter_mm, "mm"),
        given("Outer ring thickness h_o", 10.0, b.outer_ring_thickness_mm, "mm"),
        given("Inner race diameter D_i", 163.96, b.inner_race_diameter_mm, "mm"),
        given("Inner ring thickness h_i", 10.0, b.inner_ring_thickness_mm, "mm"),
    ];
    let cage = source.scene.written.cage.as_ref();
    let why = "given; it lies outside the pitch circle of 181.98 mm, so the pockets cut it into as many \
        pieces as rollers: one rigid body here";
    rows.push(number(PART, "Cage outer diameter D_c", 196.0, cage.map(|c| c.outer_diameter_mm), "mm", why));
    rows.push(number(PART, "Cage thickness h_c", 4.0, cage.map(|c| c.thickness_mm), "mm", GIVEN));
    rows.push(given("Roller diameter D_r", 18.0, b.roller_diameter_mm, "mm"));
    rows.push(given("Number of rollers N_r", 24.0, b.rollers as f64, ""));
    let a = &source.scene.written.adapter;
    rows.push(given("Adapter width w_a", 160.0, a.width_mm, "mm"));
    rows.push(given("Adapter height H_a, central", 40.0, a.height_mm, "mm"));
    let defect = source.scene.written.defect.as_ref();
    let estimated = source.summary.events.iter().find_map(|e| Some((e.spall_mm?, e.spall_scatter_mm)));
    let why = estimated.map_or("given".to_owned(), |(mm, scatter)| {
        let scatter = scatter.map_or(String::new(), |scatter| format!(" ± {scatter:.2}"));
        format!("given; estimated back from the event times: {mm:.2}{scatter} mm")
    });
    rows.push(number(PART, "Defect length L_d", 10.0, defect.map(|d| d.length_mm), "mm", &why));
    let why = "given; nodes of the raceway are moved outwards instead of removing a layer of elements";
    rows.push(number(PART, "Defect depth H_d (one element)", 0.2, defect.map(|d| d.depth_mm), "mm", why));
    rows.push(given("Density ρ", 7850.0, m.density_kg_m3, "kg/m³"));
    rows.push(given("Young's modulus E", 200.0, m.youngs_modulus_gpa, "GPa"));
    rows.push(given("Poisson's ratio ν", 0.3, m.poissons_ratio, ""));
    rows
}

fn discretisation(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let (scene, mesh) = (source.scene, source.mesh);
    let waves = ring::elements_per_wavelength(scene, 40_000.0);
    let graded = if scene.written.mesh.grading.is_some() {
        "given, along the raceways; larger elements elsewhere"
    } else {
        GIVEN
    };
    let facet_mm =
        std::f64::consts::PI * scene.written.bearing.roller_diameter_mm / mesh.roller_facets as f64;
    vec![
        number(PART, "Element size", 0.5, Some(scene.written.mesh.size_mm), "mm", graded),
        number(
            PART,
            "Elements per bending wavelength at 40 kHz",
            97.0,
            Some(waves),
            "",
            "c_B = √(1.8 c_L h f) with the plate's wave speed; the paper truncates",
        ),
        number(
            PART,
            "The same over the recommended 20",
            5.0,
            Some(waves / 20.0),
            "",
            "\"nearly 5 times\"; a criterion for waves in the ring, blind to facets, which are the source of \
             the noise",
        ),
        number(
            PART,
            "Edges of a roller, π D_r / 0.5 mm",
            113.0,
            Some(mesh.roller_facets as f64),
            "",
            &format!(
                "the paper rounds a circumference; a mesh of quadrilaterals needs an even count, best a \
                 multiple of 4. {} edges of {facet_mm:.4} mm give {:.0} Hz without slip",
                mesh.roller_facets,
                source.prediction.facet_lines.first().map_or(0.0, |l| l.1)
            ),
        ),
        words(
            PART,
            "Edges drawn in the schematic, Fig. 4",
            "15",
            format!("{}, to scale", mesh.roller_facets),
            "–",
            "the paper's figure is a schematic; ours is the mesh",
        ),
    ]
}

fn operation(source: &RowInputs<'_>) -> Vec<PaperRow> {
    let scene = source.scene;
    let (o, c, s) = (&scene.written.operation, &scene.written.contact, &scene.written.solver);
    let top = scene.written.defect.as_ref().map_or(90.0, |d| d.angle_deg);
    let given = |quantity: &str, paper: f64, ours: f64, unit: &str| {
        number(PART, quantity, paper, Some(ours), unit, GIVEN)
    };
    let samples_khz = 1e3 / scene.written.output.interval_us;
    vec![
        given(
            "Offset of the roller left of the defect",
            4.0,
            scene.written.bearing.first_roller_deg - top,
            "°",
        ),
        given("Distance of neighbouring rollers", 15.0, 360.0 / scene.written.bearing.rollers as f64, "°"),
        number(
            PART,
            "Radial load W",
            50.0,
            Some(1e-3 * o.load_n),
            "kN",
            &format!(
                "given, but per nothing: a plane model needs a thickness, {} mm here. Below some \
                 millimetres no roller unloads in the defect; nothing bounds it from above",
                scene.written.bearing.thickness_mm
            ),
        ),
        given("Speed of the inner ring", 500.0, o.speed_rpm, "rpm"),
        given("Friction, adapter on outer ring", 0.1, c.seat_friction, ""),
        given("Friction, rollers on rings and cage", 0.005, c.friction, ""),
        words(
            PART,
            "Global mass-weighted damping",
            "2 %",
            damping(s),
            "–",
            "2 % of critical, at frequencies that the paper does not name (THEORY §2.6, §2.8)",
        ),
        given("Termination time", 30.0, s.duration_ms, "ms"),
        given("Output interval", 0.01, 1e-3 * scene.written.output.interval_us, "ms"),
        given("Sampling rate", 100.0, samples_khz, "kHz"),
    ]
}

/// The damping of the scene, all kinds of it.
fn damping(solver: &SolverScene) -> String {
    let mut kinds = Vec::new();
    if let Some(d) = &solver.structural_damping {
        kinds.push(format!("{} % from {} to {} kHz, structural", d.ratio_percent, d.from_khz, d.to_khz));
    }
    if solver.mass_damping_per_s > 0.0 {
        kinds.push(format!("{} 1/s", solver.mass_damping_per_s));
    }
    if kinds.is_empty() { "none".into() } else { kinds.join(" and ") }
}
