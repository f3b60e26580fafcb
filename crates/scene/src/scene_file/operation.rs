//! Speeds and loads under which a scene cannot be run: directions that its housing does not take, a housing
//! that cannot turn, and courses over time out of range.

use super::{LOAD_PROFILE, OUTER_SPEED_PROFILE, SPEED_PROFILE};
use crate::field::wording::{number, round_down, shown};
use crate::housing::HousingScene;
use crate::reading::finding::{Finding, Remedy};
use crate::reading::ranges;
use crate::scene::{ProfileScene, Scene};

const HOUSING: &str = "housing";
const LOAD_ANGLE: &str = "operation.load_angle_deg";
const OUTER_SPEED: &str = "operation.outer_speed_rpm";

/// Everything that is wrong with speeds and loads, in a scene whose numbers are in range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let groups =
        [load, load_direction, outer_speed, speed_profile, outer_speed_profile, load_profile, rotating_load];
    groups.iter().filter_map(|group| group(scene)).collect()
}

/// A load of more than so many static ratings is no load of that bearing: at one of them steel yields.
const MOST_RATINGS: f64 = 10.0;

/// A load that steel can carry.
fn load(scene: &Scene) -> Option<Finding> {
    const LOAD: &str = "operation.load_n";
    let [_, most] = scene.duty().load_range_n(1e-3 * scene.solver.duration_ms);
    let rating_n = scene.static_rating_n();
    if most <= MOST_RATINGS * rating_n {
        return None;
    }
    let message = format!(
        "`{LOAD}` comes to {} N, {} times the static rating of this bearing by ISO 76, {} N, at which steel \
         yields: is the unit right?",
        number(most),
        number(round_down(most / rating_n, 2)),
        number(round_down(rating_n, 3))
    );
    let less = Remedy::new(LOAD, format!("at most {} N", number(round_down(MOST_RATINGS * rating_n, 2))));
    Some(Finding::new(message, vec![less]))
}

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
        HousingScene::Rigid(_) | HousingScene::Springs(_) | HousingScene::Machine(_) => return None,
    };
    let message =
        format!("`{LOAD_ANGLE}` is {}, and the housing does not take a load from there", number(angle));
    Some(Finding::new(
        message,
        vec![
            Remedy::new(LOAD_ANGLE, allowed.to_owned()).value("270", "downwards"),
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
        let still = Remedy::new(OUTER_SPEED, "0".to_owned()).value("0", "a ring that stands still");
        (format!("`{OUTER_SPEED}` is {}, and the housing cannot turn", number(o.outer_speed_rpm)), still)
    };
    Some(Finding::new(message, vec![still, rigid]))
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
            let remedies = vec![later, earlier.value("0", "from the start")];
            Some(Finding::new(message, remedies))
        }
        ProfileScene::Harmonic(sine) => {
            let ends = [mean - sine.amplitude, mean + sine.amplitude];
            let (end, allowed) = ends.into_iter().find_map(|end| Some((end, ranges::refuses(path, end)?)))?;
            let amplitude = format!("{path}.amplitude");
            let message = format!(
                "`{field}` = {} and `{amplitude}` = {} come to {}, outside the range of `{field}`",
                number(mean),
                number(sine.amplitude),
                number(end)
            );
            let less = Remedy::new(amplitude, format!("`{field}` may be {allowed}")).value("0", "none");
            let more = Remedy::new(field, allowed);
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
        let remedies = vec![less, more, housing];
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
        let along = Remedy::new(ANGLE, "an angle at which it acts with `load_n` at the start");
        Finding::new(message, vec![along])
    })
}
