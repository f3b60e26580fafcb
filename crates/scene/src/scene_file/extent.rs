//! Limits of a run's size: at least one layer of elements and two samples, and no more of either than a
//! computer holds.

use std::f64::consts::PI;

use crate::field::wording::number;
use crate::housing::HousingScene;
use crate::reading::finding::{Finding, Remedy};
use crate::scene::{ModelScene, Scene};

/// A run of this many elements needs some 10 GB and days; more is taken for a slip of the pen.
const MAX_ELEMENTS: f64 = 2e7;
/// Rows of a trace: an hour at 100 kHz, and some more. With 24 rollers ten million are 19 GB; `stribeck plan`
/// gives the size beforehand.
const MAX_SAMPLES: f64 = 4e8;

const OUTER_RACE: &str = "bearing.outer_race_diameter_mm";
const OUTER_RING: &str = "bearing.outer_ring_thickness_mm";
const INNER_RACE: &str = "bearing.inner_race_diameter_mm";
const INNER_RING: &str = "bearing.inner_ring_thickness_mm";
const SIZE: &str = "mesh.size_mm";
const COARSE: &str = "mesh.grading.coarse_mm";

/// Sizes that no mesh or no computer can meet, in a scene whose numbers are in range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let groups = [layers, grading, too_many_elements, too_few_samples, too_many_samples, frames];
    groups.iter().filter_map(|group| group(scene)).collect()
}

/// One layer of elements at least in every body.
fn layers(scene: &Scene) -> Option<Finding> {
    let b = &scene.bearing;
    let size = scene.mesh.size_mm;
    let bodies = [
        ("bearing.outer_ring_thickness_mm", b.outer_ring_thickness_mm),
        ("bearing.inner_ring_thickness_mm", b.inner_ring_thickness_mm),
    ];
    let adapter = Some(("adapter.height_mm", scene.adapter.height_mm)).filter(|_| scene.housing.is_adapter());
    let (body, thickness) = bodies.into_iter().chain(adapter).min_by(|a, b| a.1.total_cmp(&b.1))?;
    if size <= thickness {
        return None;
    }
    let message = format!(
        "`{SIZE}` is {}, more than `{body}` ({} mm): not one layer fits",
        number(size),
        number(thickness)
    );
    Some(Finding::new(
        message,
        vec![
            Remedy::new(SIZE, format!("at most {} mm, one layer", number(thickness))),
            Remedy::new(body, format!("at least {} mm, one layer", number(size))),
        ],
    ))
}

/// Grading makes elements larger, not smaller.
fn grading(scene: &Scene) -> Option<Finding> {
    let size = scene.mesh.size_mm;
    let coarse = scene.mesh.grading.as_ref()?.coarse_mm;
    if coarse >= size {
        return None;
    }
    let message = format!("`{COARSE}` is {}, finer than `{SIZE}` ({} mm)", number(coarse), number(size));
    Some(Finding::new(
        message,
        vec![
            Remedy::new(COARSE, format!("at least {} mm", number(size))),
            Remedy::new(SIZE, format!("at most {} mm", number(coarse))),
        ],
    ))
}

/// A mesh beyond any computer, with the field that asks for most of it.
fn too_many_elements(scene: &Scene) -> Option<Finding> {
    let parts = elements(scene);
    let total: f64 = parts.iter().map(|part| part.1).sum();
    let (field, _) = parts.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    if total <= MAX_ELEMENTS {
        return None;
    }
    let allowed = format!("at most {} elements in all bodies", number(MAX_ELEMENTS));
    let remedy = |field: &str| Remedy::new(field, allowed.clone());
    let sizes = [OUTER_RACE, OUTER_RING, INNER_RACE, INNER_RING, "adapter.width_mm", "adapter.height_mm"];
    let with_sizes = |field: &str| std::iter::once(field).chain(sizes).map(remedy).collect();
    let remedies = match field {
        "mesh.outer_facets" | "mesh.inner_facets" => {
            vec![remedy(field).value("None", "as many as `size_mm` makes"), remedy(SIZE)]
        }
        "mesh.roller_facets" => vec![remedy(field), remedy("bearing.rollers")],
        COARSE => with_sizes(COARSE),
        _ => with_sizes(SIZE),
    };
    let message = format!("the mesh would have about {total:.1e} elements, most of them by `{field}`");
    Some(Finding::new(message, remedies))
}

/// Roughly how many elements each field asks for. In floating point: a slip may ask for more than any
/// integer.
fn elements(scene: &Scene) -> [(&'static str, f64); 4] {
    let (b, mesh) = (&scene.bearing, &scene.mesh);
    let layers = |thickness: f64| (thickness / mesh.size_mm).max(1.0);
    let [width, height] = match &scene.housing {
        HousingScene::Adapter => [scene.adapter.width_mm, scene.adapter.height_mm],
        HousingScene::Pedestal(pedestal) => [pedestal.width_mm, pedestal.base_mm + pedestal.top_mm],
        HousingScene::Mesh(_)
        | HousingScene::Rigid(_)
        | HousingScene::Springs(_)
        | HousingScene::Machine(_) => [0.0; 2],
    };
    let held = match &mesh.grading {
        None => layers(width) * layers(height),
        Some(g) => width * height / (g.coarse_mm * g.coarse_mm),
    };
    // The transition and the coarse rows of a graded ring cost as much as three fine layers.
    let layers_of_ring = |thickness: f64| {
        let graded = mesh.grading.as_ref().map_or(f64::INFINITY, |g| g.fine_layers as f64 + 3.0);
        layers(thickness).min(graded)
    };
    let ring = |field, facets: Option<usize>, diameter: f64, thickness: f64| match facets {
        Some(facets) => (field, facets as f64 * layers_of_ring(thickness)),
        None => (SIZE, PI * diameter / mesh.size_mm * layers_of_ring(thickness)),
    };
    // A disc of N facets on its rim, filled with squares of the facets' length or of that of the core.
    let facets = mesh.roller_facets as f64;
    let facet_mm = PI * b.roller_diameter_mm / facets;
    let core = match &mesh.grading {
        None => 1.0,
        Some(grading) => grading.roller_core_mm(facet_mm) / facet_mm,
    };
    let rollers = b.rollers as f64 * facets * facets / (4.0 * PI * core * core);
    [
        ring("mesh.outer_facets", mesh.outer_facets, b.outer_race_diameter_mm, b.outer_ring_thickness_mm),
        ring("mesh.inner_facets", mesh.inner_facets, b.inner_race_diameter_mm, b.inner_ring_thickness_mm),
        ("mesh.roller_facets", rollers),
        (if mesh.grading.is_some() { COARSE } else { SIZE }, held),
    ]
}

/// Enough samples to see something.
fn too_few_samples(scene: &Scene) -> Option<Finding> {
    let (interval, duration) = (scene.output.interval_us, scene.solver.duration_ms);
    if duration * 1e3 / interval >= 2.0 {
        return None;
    }
    let message =
        format!("{} ms sampled every {} µs are fewer than two samples", number(duration), number(interval));
    Some(Finding::new(
        message,
        vec![
            Remedy::new(
                "output.interval_us",
                format!("at most {} µs, two samples", number(duration * 500.0)),
            ),
            Remedy::new(
                "solver.duration_ms",
                format!("at least {} ms, two samples", number(interval / 500.0)),
            ),
        ],
    ))
}

/// Pictures that begin before they end. Those of a bearing by its name end with the run, however early, and
/// the reduced model has none.
fn frames(scene: &Scene) -> Option<Finding> {
    let frames = scene.output.frames.as_ref().filter(|_| scene.model == ModelScene::Full)?;
    if frames.from_ms <= frames.to_ms || frames.to_ms == scene.solver.duration_ms {
        return None;
    }
    let [from, to] = ["output.frames.from_ms", "output.frames.to_ms"];
    let message = format!(
        "pictures end at {} ms, before they begin ({} ms)",
        number(frames.to_ms),
        number(frames.from_ms)
    );
    let later = Remedy::new(to, format!("{} ms or more", number(frames.from_ms)));
    let earlier = Remedy::new(from, format!("at most {} ms", number(frames.to_ms)));
    let remedies = vec![later, earlier.value("0", "from the start")];
    Some(Finding::new(message, remedies))
}

/// A file that fits a disk.
fn too_many_samples(scene: &Scene) -> Option<Finding> {
    let (interval, duration) = (scene.output.interval_us, scene.solver.duration_ms);
    let samples = duration * 1e3 / interval;
    if samples <= MAX_SAMPLES {
        return None;
    }
    let message =
        format!("{} ms sampled every {} µs are {samples:.1e} samples", number(duration), number(interval));
    let most = number(MAX_SAMPLES);
    let shortest = duration * 1e3 / MAX_SAMPLES;
    let longest = interval * 1e-3 * MAX_SAMPLES;
    Some(Finding::new(
        message,
        vec![
            Remedy::new("output.interval_us", format!("at least {} µs, {most} samples", number(shortest))),
            Remedy::new("solver.duration_ms", format!("at most {} ms, {most} samples", number(longest))),
        ],
    ))
}
