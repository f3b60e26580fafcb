//! Limits of a run's size: number of elements, of samples and of channels; and bands and lists that must not
//! be empty.

use std::f64::consts::PI;

use super::finding::{Finding, Remedy};
use super::limits::{self, LOAD_PROFILE, OUTER_SPEED_PROFILE, SPEED_PROFILE};
use super::wording::{number, round_down, round_up, shown};
use crate::deviation::RollingSurface;
use crate::faults::rolling_circle;
use crate::housing::HousingScene;
use crate::scene::{DefectRing, ModelScene, ProfileScene, Scene, Start};

/// A run of this many elements needs some 10 GB and days; more is taken for a slip of the pen.
const MAX_ELEMENTS: f64 = 2e7;
/// Rows of a trace: an hour at 100 kHz, and some more. With 24 rollers ten million are 19 GB; `stribeck plan`
/// gives the size beforehand.
const MAX_SAMPLES: f64 = 4e8;

/// Upper over lower end of the narrowest band of structural damping.
const NARROWEST_BAND: f64 = 2.0;

/// A vertex is a corner when it turns by this angle [°] …
const CORNER_DEG: f64 = 20.1;

/// … and an edge of a defect turns by its slope less half of the raceway's turn from facet to facet, up
/// to a few degrees. None slopes less under oil [°].
const LEAST_EDGE_DEG: f64 = 22.0;

const OUTER_RACE: &str = "bearing.outer_race_diameter_mm";
const OUTER_RING: &str = "bearing.outer_ring_thickness_mm";
const INNER_RACE: &str = "bearing.inner_race_diameter_mm";
const INNER_RING: &str = "bearing.inner_ring_thickness_mm";
const SIZE: &str = "mesh.size_mm";
const COARSE: &str = "mesh.grading.coarse_mm";

/// Every demand that no mesh or no computer can meet, in a scene whose numbers are in range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let groups = [
        layers,
        grading,
        too_many_elements,
        too_few_samples,
        too_many_samples,
        damped_band,
        damped_bodies,
        damped_twice,
        oiled_edges,
        reduced_starts,
        load_direction,
        outer_speed,
        speed_profile,
        outer_speed_profile,
        load_profile,
        rotating_load,
        frames,
    ];
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
            Remedy::new(SIZE, format!("at most {} mm, one layer", number(thickness)))
                .number(round_down(thickness / 4.0, 2), "four layers of elements"),
            Remedy::new(body, format!("at least {} mm, one layer", number(size)))
                .number(4.0 * size, "four layers of elements"),
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
            Remedy::new(COARSE, format!("at least {} mm", number(size)))
                .number(3.0 * size, "three facets become one"),
            Remedy::new(SIZE, format!("at most {} mm", number(coarse)))
                .number(round_down(coarse / 3.0, 2), "three facets become one"),
        ],
    ))
}

/// A mesh beyond any computer, with the field that asks for most of it.
fn too_many_elements(scene: &Scene) -> Option<Finding> {
    let parts = elements(scene);
    let total: f64 = parts.iter().map(|part| part.1).sum();
    let (field, most) = parts.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    if total <= MAX_ELEMENTS {
        return None;
    }
    // Four parts share the elements. Those of a disc grow with the square of its facets, those of a ring with
    // the facets.
    let excess = most / (MAX_ELEMENTS / 4.0);
    let b = &scene.bearing;
    let allowed = format!("at most {} elements in all bodies", number(MAX_ELEMENTS));
    let remedy = |field: &str| Remedy::new(field, allowed.clone());
    let fewer = |field: &str, value: f64| remedy(field).number((value / excess).floor(), "");
    let smaller = |field: &str, value: f64| remedy(field).number(round_down(value / excess, 2), "");
    let larger = |field: &str, value: f64| remedy(field).number(round_up(value * excess.sqrt(), 1), "");
    let sizes = [(OUTER_RACE, b.outer_race_diameter_mm), (OUTER_RING, b.outer_ring_thickness_mm)]
        .into_iter()
        .chain([(INNER_RACE, b.inner_race_diameter_mm), (INNER_RING, b.inner_ring_thickness_mm)])
        .chain([("adapter.width_mm", scene.adapter.width_mm), ("adapter.height_mm", scene.adapter.height_mm)])
        .map(|(field, value)| smaller(field, value));
    let size = larger(SIZE, scene.mesh.size_mm);
    let remedies = match field {
        "mesh.outer_facets" | "mesh.inner_facets" => {
            vec![remedy(field).value("None", "as many as `size_mm` makes"), size]
        }
        "mesh.roller_facets" => {
            let facets = (scene.mesh.roller_facets as f64 / excess.sqrt()).floor();
            vec![remedy(field).number(facets, ""), fewer("bearing.rollers", b.rollers as f64)]
        }
        COARSE => {
            let coarse = scene.mesh.grading.as_ref().map_or(0.0, |g| g.coarse_mm);
            std::iter::once(larger(COARSE, coarse)).chain(sizes).collect()
        }
        _ => std::iter::once(size).chain(sizes).collect(),
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
        HousingScene::Mesh(_) | HousingScene::Rigid(_) | HousingScene::Springs(_) => [0.0; 2],
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
    let note = "a hundred samples";
    let message =
        format!("{} ms sampled every {} µs are fewer than two samples", number(duration), number(interval));
    Some(Finding::new(
        message,
        vec![
            Remedy::new(
                "output.interval_us",
                format!("at most {} µs, two samples", number(duration * 500.0)),
            )
            .number(duration * 10.0, note)
            .number(duration * 500.0, "two samples"),
            Remedy::new(
                "solver.duration_ms",
                format!("at least {} ms, two samples", number(interval / 500.0)),
            )
            .number(interval / 10.0, note)
            .number(interval / 500.0, "two samples"),
        ],
    ))
}

/// Oil ends at the edges of a defect: walls that a surface turns into more gently are no end, and a film
/// would lie across them.
fn oiled_edges(scene: &Scene) -> Option<Finding> {
    scene.film.as_ref()?;
    let defect = scene.defect.as_ref()?;
    let ring = match defect.ring {
        DefectRing::Outer => RollingSurface::Outer,
        DefectRing::Inner => RollingSurface::Inner,
    };
    let [diameter, facet] = rolling_circle(scene, ring);
    let least = LEAST_EDGE_DEG.max((CORNER_DEG + (facet / diameter).to_degrees()).ceil());
    if defect.edge_slope_deg >= least {
        return None;
    }
    let message = format!(
        "`film` is there, and the edges of `defect` slope by {}°: oil knows edges of {least}° or more on \
         facets of {} mm",
        number(defect.edge_slope_deg),
        number(facet)
    );
    let slope = Remedy::new("defect.edge_slope_deg", format!("{least}° or more"));
    let dry = Remedy::new("film", "`None`").value("None", "dry");
    Some(Finding::new(message, vec![slope.number(30.0, ""), dry]))
}

const HOUSING: &str = "housing";
const LOAD_ANGLE: &str = "operation.load_angle_deg";
const OUTER_SPEED: &str = "operation.outer_speed_rpm";

/// A load that the guide of its housing lets through.
fn load_direction(scene: &Scene) -> Option<Finding> {
    let angle = scene.operation.load_angle_deg;
    let [across, up] = scene.load_direction();
    let allowed = match scene.housing {
        HousingScene::Adapter if up < 0.0 && across == 0.0 => return None,
        HousingScene::Adapter => "270, downwards, as the adapter lies on top of the ring",
        HousingScene::Pedestal(_) | HousingScene::Mesh(_) if across == 0.0 => return None,
        HousingScene::Pedestal(_) | HousingScene::Mesh(_) => {
            "270 or 90: what takes the load is guided up and down"
        }
        HousingScene::Rigid(_) | HousingScene::Springs(_) => return None,
    };
    let message =
        format!("`{LOAD_ANGLE}` is {}, and the housing does not take a load from there", number(angle));
    Some(Finding::new(
        message,
        vec![
            Remedy::new(LOAD_ANGLE, allowed.to_owned()).number(270.0, "downwards"),
            Remedy::new(HOUSING, "`rigid(…)` or `springs(…)`, which take it from any side".to_owned())
                .value("rigid()", ""),
        ],
    ))
}

/// A housing that turns does not deform.
fn outer_speed(scene: &Scene) -> Option<Finding> {
    let o = &scene.operation;
    if !o.outer_turns() || scene.housing.is_rigid() {
        return None;
    }
    let rigid = Remedy::new(HOUSING, "`rigid(…)`".to_owned()).value("rigid()", "");
    let (message, still) = if o.outer_speed_profile.is_some() {
        let still = Remedy::new(OUTER_SPEED_PROFILE, "left out".to_owned());
        (format!("`{OUTER_SPEED_PROFILE}` is there, and the housing cannot turn"), still)
    } else {
        let still = Remedy::new(OUTER_SPEED, "0".to_owned()).number(0.0, "a ring that stands still");
        (format!("`{OUTER_SPEED}` is {}, and the housing cannot turn", number(o.outer_speed_rpm)), still)
    };
    Some(Finding::new(message, vec![still, rigid]))
}

/// The reduced model is made about the preload.
fn reduced_starts(scene: &Scene) -> Option<Finding> {
    if scene.model == ModelScene::Full || scene.solver.start == Start::Preloaded {
        return None;
    }
    let message =
        "`solver.start` is `sudden`, and the reduced model knows small motions about the preload alone"
            .to_owned();
    Some(Finding::new(
        message,
        vec![
            Remedy::new("solver.start", "`preloaded`".to_owned()).value("preloaded", ""),
            Remedy::new("model", "`full`".to_owned()).value("full", ""),
        ],
    ))
}

/// A speed over time that can be followed.
fn speed_profile(scene: &Scene) -> Option<Finding> {
    let o = &scene.operation;
    profile(SPEED_PROFILE, o.speed_profile.as_ref()?, ("operation.speed_rpm", o.speed_rpm))
}

/// A speed of the outer ring over time that can be followed.
fn outer_speed_profile(scene: &Scene) -> Option<Finding> {
    let o = &scene.operation;
    profile(OUTER_SPEED_PROFILE, o.outer_speed_profile.as_ref()?, (OUTER_SPEED, o.outer_speed_rpm))
}

/// A load over time that can be followed.
fn load_profile(scene: &Scene) -> Option<Finding> {
    let o = &scene.operation;
    profile(LOAD_PROFILE, o.load_profile.as_ref()?, ("operation.load_n", o.load_n))
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
    let remedies =
        vec![later.number(frames.from_ms + 10.0, "pictures of 10 ms"), earlier.number(0.0, "from the start")];
    Some(Finding::new(message, remedies))
}

/// A profile with a beginning, an end and values that its field may have; `field` has the name and the value
/// of the latter.
fn profile(path: &str, profile: &ProfileScene, (field, mean): (&str, f64)) -> Option<Finding> {
    match profile {
        ProfileScene::Ramp(ramp) if ramp.to_ms <= ramp.from_ms => {
            let (from, to) = (format!("{path}.from_ms"), format!("{path}.to_ms"));
            let message = format!(
                "the ramp ends at {} ms, not after it begins ({} ms)",
                number(ramp.to_ms),
                number(ramp.from_ms)
            );
            let later = Remedy::new(to, format!("more than {} ms", number(ramp.from_ms)));
            let earlier = Remedy::new(from, format!("less than {} ms", number(ramp.to_ms)));
            let remedies =
                vec![later.number(ramp.from_ms + 100.0, "0.1 s"), earlier.number(0.0, "from the start")];
            Some(Finding::new(message, remedies))
        }
        ProfileScene::Harmonic(sine) => {
            let ends = [mean - sine.amplitude, mean + sine.amplitude];
            let (end, allowed) =
                ends.into_iter().find_map(|end| Some((end, limits::refuses_in_profile(path, end)?)))?;
            let amplitude = format!("{path}.amplitude");
            let message = format!(
                "`{field}` = {} and `{amplitude}` = {} come to {}, outside the range of `{field}`",
                number(mean),
                number(sine.amplitude),
                number(end)
            );
            let less = Remedy::new(amplitude, format!("`{field}` may be {allowed}"))
                .number(round_down(0.5 * mean.abs(), 2), "half of the mean")
                .number(0.0, "none");
            let more = Remedy::new(field, allowed).number(2.0 * sine.amplitude, "twice the amplitude");
            Some(Finding::new(message, vec![less, more]))
        }
        ProfileScene::Points(points) => {
            let falls = |i: &usize| {
                let (at, before) = (points[*i].0, if *i > 0 { points[*i - 1].0 } else { f64::NEG_INFINITY });
                !(at > before && at.is_finite())
            };
            let message = match (0..points.len()).find(falls) {
                None if points.is_empty() => format!("`{path}` has no points"),
                None => return None,
                Some(i) => format!("`{path}[{i}]` is at {} ms: times must ascend", number(points[i].0)),
            };
            let allowed = "points with ascending times, `[(0.0, 500.0), (100.0, 1000.0)]`";
            Some(Finding::new(message, vec![Remedy::new(path, allowed)]))
        }
        ProfileScene::Table(file) => {
            let message = format!("`{path}` is the table `{}`, which was not read", shown(file));
            let allowed = "`points([ … ])` for a scene that is made in memory";
            Some(Finding::new(message, vec![Remedy::new(path, allowed)]))
        }
        ProfileScene::Ramp(_) => None,
    }
}

/// A rotating load that does not lift an adapter, which lies on its ring. Any other housing surrounds the
/// ring and pulls it along; the run then only needs a load that presses at its start.
fn rotating_load(scene: &Scene) -> Option<Finding> {
    const FORCE: &str = "operation.rotating_load.force_n";
    let rotating = scene.operation.rotating_load.as_ref()?;
    let duty = scene.duty();
    let [least, _] = duty.load_range_n(1e-3 * scene.solver.duration_ms);
    if least > 0.0 {
        return None;
    }
    if scene.housing == HousingScene::Adapter {
        let load = least + rotating.force_n;
        let message = format!(
            "`{FORCE}` is {}, not less than the least load ({} N): it would lift the adapter",
            number(rotating.force_n),
            number(load)
        );
        let less = Remedy::new(FORCE, format!("less than {} N", number(load)));
        let more = Remedy::new("operation.load_n", format!("more than {} N", number(rotating.force_n)));
        let housing =
            Remedy::new("housing", "`rigid()`, `springs()` or `pedestal()`, which surround the ring");
        let remedies = vec![
            less.number(round_down(0.2 * load, 2), "a fifth"),
            more.number(5.0 * rotating.force_n, ""),
            housing,
        ];
        return Some(Finding::new(message, remedies));
    }
    let start = duty.load_n(0.0);
    (start <= 0.0).then(|| {
        const ANGLE: &str = "operation.rotating_load.angle_deg";
        let message = format!(
            "`{ANGLE}` is {}: with {FORCE} = {} the load at the start comes to {} N, and a run starts under \
             a load that presses",
            number(rotating.angle_deg),
            number(rotating.force_n),
            number(start)
        );
        let along = Remedy::new(ANGLE, "an angle at which it acts with `load_n` at the start")
            .number(scene.operation.load_angle_deg.rem_euclid(360.0), "with the load");
        Finding::new(message, vec![along])
    })
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
            Remedy::new("output.interval_us", format!("at least {} µs, {most} samples", number(shortest)))
                .number(round_up(10.0 * shortest, 1), ""),
            Remedy::new("solver.duration_ms", format!("at most {} ms, {most} samples", number(longest)))
                .number(round_down(longest / 10.0, 1), ""),
        ],
    ))
}

/// A band of structural damping wide enough for its branches.
fn damped_band(scene: &Scene) -> Option<Finding> {
    const FROM: &str = "solver.structural_damping.from_khz";
    const TO: &str = "solver.structural_damping.to_khz";
    let damping = scene.solver.structural_damping.as_ref()?;
    let (from, to) = (damping.from_khz, damping.to_khz);
    if to >= NARROWEST_BAND * from {
        return None;
    }
    let message = format!(
        "`{TO}` is {}, less than {NARROWEST_BAND} times `{FROM}` ({} kHz): the damped band is too narrow",
        number(to),
        number(from)
    );
    let (least, most) = (NARROWEST_BAND * from, to / NARROWEST_BAND);
    Some(Finding::new(
        message,
        vec![
            Remedy::new(TO, format!("at least {} kHz", number(least))).number(20.0 * from, "a usual band"),
            Remedy::new(FROM, format!("at most {} kHz", number(most))).number(to / 20.0, "a usual band"),
        ],
    ))
}

/// Structural damping of at least one body, and of none twice.
fn damped_bodies(scene: &Scene) -> Option<Finding> {
    const BODIES: &str = "solver.structural_damping.bodies";
    let bodies = &scene.solver.structural_damping.as_ref()?.bodies;
    let twice = (1..bodies.len()).any(|i| bodies[..i].contains(&bodies[i]));
    let message = match (bodies.is_empty(), twice) {
        (true, _) => format!("`{BODIES}` is empty: nothing would be damped"),
        (_, true) => format!("`{BODIES}` names a body twice"),
        _ => return None,
    };
    let allowed = "`outer_ring`, `inner_ring`, `adapter`, `rollers`, each once";
    let remedy =
        Remedy::new(BODIES, allowed.to_owned()).value("[outer_ring, inner_ring, adapter]", "the default");
    Some(Finding::new(message, vec![remedy]))
}

/// Structural or stiffness damping: both let elements see other positions than those of the nodes.
fn damped_twice(scene: &Scene) -> Option<Finding> {
    const STRUCTURAL: &str = "solver.structural_damping";
    const STIFFNESS: &str = "solver.stiffness_damping_ns";
    let solver = &scene.solver;
    if solver.structural_damping.is_none() || solver.stiffness_damping_ns == 0.0 {
        return None;
    }
    let message = format!(
        "`{STRUCTURAL}` and `{STIFFNESS}` = {} exclude each other",
        number(solver.stiffness_damping_ns)
    );
    Some(Finding::new(
        message,
        vec![
            Remedy::new(STIFFNESS, "0 ns".to_owned()).value("0.0", "structural damping alone"),
            Remedy::new(STRUCTURAL, "`None`".to_owned()).value("None", "stiffness damping alone"),
        ],
    ))
}
