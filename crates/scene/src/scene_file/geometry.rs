//! Bodies that cannot exist: rollers that overlap the rings or each other, a cage outside its gap, a defect deeper than
//! the ring, a mesh too coarse for its bodies or too fine for any computer.

use std::f64::consts::PI;

use super::limits::number;
use super::origin::Finding;
use crate::scene::Scene;

/// A wider gap than this part of a roller is a mistake in a diameter, not a clearance.
const MAX_CLEARANCE_RATIO: f64 = 0.1;
/// Below the floor of a defect this part of the ring must be left to carry the load.
const MAX_DEFECT_DEPTH_RATIO: f64 = 0.6;
/// A run of this many elements needs some 10 GB and days; more is taken for a slip of the pen.
const MAX_ELEMENTS: f64 = 2e7;
/// Rows of a trace: 10 million of 150 channels are 12 GB.
const MAX_SAMPLES: f64 = 1e7;

/// Every impossibility of a scene whose numbers are in range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let groups = [rings, pitch_circle, cage, adapter, defect, mesh, sampling];
    groups.iter().flat_map(|group| group(scene)).collect()
}

fn finding(fields: &[&str], message: String, allowed: String, suggestion: String) -> Finding {
    Finding { fields: fields.iter().map(|field| (*field).to_owned()).collect(), message, allowed, suggestion }
}

/// Rollers between raceways, and a bore inside the inner ring.
fn rings(scene: &Scene) -> Vec<Finding> {
    let b = &scene.bearing;
    let mut found = Vec::new();
    let fields =
        ["bearing.roller_diameter_mm", "bearing.inner_race_diameter_mm", "bearing.outer_race_diameter_mm"];
    let clearance = b.outer_race_diameter_mm - b.inner_race_diameter_mm - 2.0 * b.roller_diameter_mm;
    let sum = format!(
        "outer raceway {} − inner raceway {} − 2 × roller {} = {} mm",
        number(b.outer_race_diameter_mm),
        number(b.inner_race_diameter_mm),
        number(b.roller_diameter_mm),
        number(clearance)
    );
    let largest = (b.outer_race_diameter_mm - b.inner_race_diameter_mm) / 2.0;
    // Sums of decimal fractions leave rounding dust; a nanometre is none of the user's business.
    if clearance < -1e-6 {
        let suggestion = if largest > 0.0 {
            format!("`roller_diameter_mm` of at most {}", number(largest))
        } else {
            "the outer raceway must be larger than the inner one; are they exchanged?".to_owned()
        };
        let message = format!("bodies overlap, the rollers do not fit between the rings: {sum}");
        found.push(finding(&fields, message, "a clearance of 0 or more".to_owned(), suggestion));
    } else if clearance > MAX_CLEARANCE_RATIO * b.roller_diameter_mm {
        let limit = MAX_CLEARANCE_RATIO * b.roller_diameter_mm;
        let message = format!("the rollers rattle between the rings: {sum}");
        let suggestion = format!("`roller_diameter_mm: {}` leaves no clearance", number(largest));
        found.push(finding(
            &fields,
            message,
            format!("a clearance of at most {} mm", number(limit)),
            suggestion,
        ));
    }
    if 2.0 * b.inner_ring_thickness_mm >= b.inner_race_diameter_mm {
        let message = format!(
            "`bearing.inner_ring_thickness_mm` is {}, which leaves no bore in a ring of diameter {} mm",
            b.inner_ring_thickness_mm, b.inner_race_diameter_mm
        );
        let limit = format!("below half the inner raceway's diameter, {} mm", b.inner_race_diameter_mm / 2.0);
        let fields = ["bearing.inner_ring_thickness_mm", "bearing.inner_race_diameter_mm"];
        found.push(finding(&fields, message, limit, "the default is 10.0".to_owned()));
    }
    found
}

/// Rollers beside each other on the pitch circle, with the pocket clearance between them.
fn pitch_circle(scene: &Scene) -> Vec<Finding> {
    let b = &scene.bearing;
    let pitch_radius = (b.outer_race_diameter_mm + b.inner_race_diameter_mm) / 4.0;
    let needed = b.roller_diameter_mm;
    let most = if needed < 2.0 * pitch_radius {
        (PI / (needed / (2.0 * pitch_radius)).asin() + 1e-9).floor()
    } else {
        1.0
    };
    if b.rollers as f64 <= most {
        return Vec::new();
    }
    let message = format!(
        "{} rollers of {} mm do not fit on the pitch circle of diameter {} mm",
        b.rollers,
        number(b.roller_diameter_mm),
        number(2.0 * pitch_radius)
    );
    let fields = ["bearing.rollers", "bearing.roller_diameter_mm"];
    let suggestion = format!("`rollers: {most}`, or thinner rollers");
    vec![finding(&fields, message, format!("at most {most} rollers"), suggestion)]
}

/// The cage inside the gap between the rings, and something left of it between two pockets.
fn cage(scene: &Scene) -> Vec<Finding> {
    let b = &scene.bearing;
    let Some(cage) = &scene.cage else { return Vec::new() };
    let mut found = Vec::new();
    let (outer, inner) = (cage.outer_diameter_mm / 2.0, cage.outer_diameter_mm / 2.0 - cage.thickness_mm);
    let (outer_race, inner_race) = (b.outer_race_diameter_mm / 2.0, b.inner_race_diameter_mm / 2.0);
    if outer >= outer_race || inner <= inner_race {
        let message = format!(
            "the cage, from radius {} to {} mm, does not lie between the raceways",
            number(inner),
            number(outer)
        );
        let allowed = format!("between radius {} and {} mm", number(inner_race), number(outer_race));
        let fields = ["cage.outer_diameter_mm", "cage.thickness_mm", "bearing.outer_race_diameter_mm"];
        let suggestion =
            format!("`outer_diameter_mm` below {} and a thinner cage, or `cage: None`", 2.0 * outer_race);
        found.push(finding(&fields, message, allowed, suggestion));
        return found;
    }
    let pitch_radius = (outer_race + inner_race) / 2.0;
    let pocket = b.roller_diameter_mm / 2.0 + cage.pocket_clearance_um * 1e-3;
    let half_spacing = PI / b.rollers as f64;
    match widest_pocket(inner, outer, pitch_radius, pocket) {
        None => {
            let message = format!(
                "the pockets, of radius {} mm on the pitch circle, do not reach the cage (radius {} to {} mm)",
                number(pocket),
                number(inner),
                number(outer)
            );
            let fields = ["cage.outer_diameter_mm", "cage.thickness_mm"];
            let suggestion = format!("a cage nearer to the pitch circle, of diameter {}", 2.0 * pitch_radius);
            found.push(finding(
                &fields,
                message,
                "a cage that the rollers pass through".to_owned(),
                suggestion,
            ));
        }
        // Rollers that touch each other have had their error; the pockets' would only repeat it.
        Some(half) if half >= half_spacing && pitch_circle(scene).is_empty() => {
            let message = format!(
                "{} pockets leave nothing of the cage: each takes ±{:.3}°, half the spacing is {:.3}°",
                b.rollers,
                half.to_degrees(),
                half_spacing.to_degrees()
            );
            let most = (PI / half).ceil() - 1.0;
            let fields = ["bearing.rollers", "cage.pocket_clearance_um"];
            let suggestion = format!("`rollers: {most}`, a smaller `pocket_clearance_um`, or `cage: None`");
            found.push(finding(&fields, message, format!("at most {most} rollers"), suggestion));
        }
        Some(_) => {}
    }
    found
}

/// Largest half angle [rad] that a pocket cuts out of the ring between two radii; `None` when it misses a surface.
fn widest_pocket(inner: f64, outer: f64, pitch_radius: f64, pocket: f64) -> Option<f64> {
    let half_angle = |r: f64| {
        let cosine = (r * r + pitch_radius * pitch_radius - pocket * pocket) / (2.0 * r * pitch_radius);
        (cosine < 1.0).then(|| cosine.max(-1.0).acos())
    };
    // Seen from the bearing's centre a pocket is widest where the ray touches it.
    let tangent = (pitch_radius * pitch_radius - pocket * pocket).max(0.0).sqrt();
    let at_edges = half_angle(inner)?.max(half_angle(outer)?);
    let touched = if (inner..=outer).contains(&tangent) { half_angle(tangent).unwrap_or(0.0) } else { 0.0 };
    Some(at_edges.max(touched))
}

/// The seat wraps part of the outer ring, never all of its width.
fn adapter(scene: &Scene) -> Vec<Finding> {
    let b = &scene.bearing;
    let outside = b.outer_race_diameter_mm + 2.0 * b.outer_ring_thickness_mm;
    let width = scene.adapter.width_mm;
    if width < outside {
        return Vec::new();
    }
    let message = format!(
        "`adapter.width_mm` is {width}, as wide as the outer ring ({} mm): the seat would have no sides",
        number(outside)
    );
    let allowed = format!("below the outer ring's outside diameter, {} mm", number(outside));
    let suggestion = format!("{}, as in the paper's proportions", number((0.727 * outside).round()));
    vec![finding(&["adapter.width_mm", "bearing.outer_race_diameter_mm"], message, allowed, suggestion)]
}

/// The spall inside the load zone and inside the ring.
fn defect(scene: &Scene) -> Vec<Finding> {
    let Some(defect) = &scene.defect else { return Vec::new() };
    let b = &scene.bearing;
    let mut found = Vec::new();
    let around = PI * b.outer_race_diameter_mm;
    if defect.length_mm > around / 2.0 {
        let what = if defect.length_mm >= around { "the whole raceway" } else { "any load zone" };
        let message = format!(
            "`defect.length_mm` is {}, longer than {what}: the raceway measures {:.1} mm, its loaded half {:.1} mm",
            defect.length_mm,
            around,
            around / 2.0
        );
        let allowed = format!("at most {:.1} mm, half of the outer raceway", around / 2.0);
        let spacing = around / b.rollers as f64;
        let suggestion = format!("below {spacing:.1} mm, the distance of two rollers, to see single impacts");
        found.push(finding(&["defect.length_mm"], message, allowed, suggestion));
    }
    let deepest = MAX_DEFECT_DEPTH_RATIO * b.outer_ring_thickness_mm;
    if defect.depth_mm > deepest {
        let message = format!(
            "`defect.depth_mm` is {}, too deep for an outer ring of {} mm",
            defect.depth_mm, b.outer_ring_thickness_mm
        );
        let allowed = format!("at most {} mm, 60 % of the ring's thickness", number(deepest));
        let fields = ["defect.depth_mm", "bearing.outer_ring_thickness_mm"];
        found.push(finding(&fields, message, allowed, "the default is 0.2".to_owned()));
    }
    found
}

/// Elements that fit the bodies, in a number that fits a computer.
fn mesh(scene: &Scene) -> Vec<Finding> {
    let b = &scene.bearing;
    let size = scene.mesh.size_mm;
    let mut found = Vec::new();
    let bodies = [
        ("bearing.outer_ring_thickness_mm", b.outer_ring_thickness_mm),
        ("bearing.inner_ring_thickness_mm", b.inner_ring_thickness_mm),
        ("adapter.height_mm", scene.adapter.height_mm),
    ];
    let thinnest = bodies.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((body, thickness)) = thinnest.filter(|(_, thickness)| size > *thickness) {
        let message = format!("`mesh.size_mm` is {size}, more than `{body}` ({thickness} mm)");
        let suggestion = format!("{} for four layers of elements", number(thickness / 4.0));
        let allowed = format!("at most {thickness} mm, one layer");
        found.push(finding(&["mesh.size_mm", body], message, allowed, suggestion));
    }
    if let Some(coarse) = scene.mesh.grading.as_ref().map(|g| g.coarse_mm).filter(|coarse| *coarse < size) {
        let message = format!("`mesh.grading.coarse_mm` is {coarse}, finer than `mesh.size_mm` ({size} mm)");
        let suggestion = format!("{} makes one facet of three", number(3.0 * size));
        let fields = ["mesh.grading.coarse_mm", "mesh.size_mm"];
        found.push(finding(&fields, message, format!("{size} mm or more"), suggestion));
    }
    found.extend(too_many_elements(scene));
    found
}

/// A mesh beyond any computer, with the field that asks for most of it.
fn too_many_elements(scene: &Scene) -> Option<Finding> {
    let parts = elements(scene);
    let total: f64 = parts.iter().map(|part| part.1).sum();
    let (field, most) = parts.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    if total <= MAX_ELEMENTS {
        return None;
    }
    // Elements of a disc grow with the square of its facets, those of a ring with the facets alone.
    let excess = most / (MAX_ELEMENTS / 4.0);
    let suggestion = match field {
        "mesh.size_mm" => {
            format!("`mesh.size_mm: {}`", number(round_up(scene.mesh.size_mm * excess.sqrt())))
        }
        "mesh.roller_facets" => {
            format!("`mesh.roller_facets: {:.0}`", scene.mesh.roller_facets as f64 / excess.sqrt())
        }
        _ => format!("`{field}: None`, or a larger `mesh.size_mm`"),
    };
    let message = format!("the mesh would have about {total:.1e} elements, most of them by `{field}`");
    Some(finding(&[field], message, format!("at most {MAX_ELEMENTS:.0e} elements"), suggestion))
}

/// Roughly how many elements each field asks for. In floating point: a slip may ask for more than any integer.
fn elements(scene: &Scene) -> [(&'static str, f64); 4] {
    let (b, mesh) = (&scene.bearing, &scene.mesh);
    let layers = |thickness: f64| (thickness / mesh.size_mm).max(1.0);
    let adapter = match &mesh.grading {
        None => layers(scene.adapter.width_mm) * layers(scene.adapter.height_mm),
        Some(g) => scene.adapter.width_mm * scene.adapter.height_mm / (g.coarse_mm * g.coarse_mm),
    };
    // The transition and the coarse rows of a graded ring cost as much as three fine layers.
    let layers_of_ring = |thickness: f64| {
        let graded = mesh.grading.as_ref().map_or(f64::INFINITY, |g| g.fine_layers as f64 + 3.0);
        layers(thickness).min(graded)
    };
    let ring = |field, facets: Option<usize>, diameter: f64, thickness: f64| match facets {
        Some(facets) => (field, facets as f64 * layers_of_ring(thickness)),
        None => ("mesh.size_mm", PI * diameter / mesh.size_mm * layers_of_ring(thickness)),
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
        ("mesh.size_mm", adapter),
    ]
}

/// Enough samples to see something, and a file that fits a disk.
fn sampling(scene: &Scene) -> Vec<Finding> {
    let interval = scene.output.interval_us;
    let duration = scene.solver.duration_ms;
    let samples = duration * 1e3 / interval;
    let fields = ["output.interval_us", "solver.duration_ms"];
    if samples < 2.0 {
        let message =
            format!("`output.interval_us` is {interval}, more than half of the {duration} ms simulated");
        let allowed = format!("at most {} µs, two samples", number(duration * 500.0));
        return vec![finding(&fields, message, allowed, "10.0 is 100 kHz".to_owned())];
    }
    if samples > MAX_SAMPLES {
        let message = format!("{duration} ms every {interval} µs are {samples:.3e} samples");
        let allowed = format!("at most {MAX_SAMPLES:.0e} samples");
        let suggestion = format!("`interval_us: {}`", number(round_up(duration * 1e3 / 1e6)));
        return vec![finding(&fields, message, allowed, suggestion)];
    }
    Vec::new()
}

/// Rounds up to one significant digit.
fn round_up(value: f64) -> f64 {
    let step = 10_f64.powf(value.log10().floor());
    (value / step).ceil() * step
}
