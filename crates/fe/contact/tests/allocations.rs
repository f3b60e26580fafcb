//! Contact takes no memory from step to step: only a search may.

mod common;

use common::*;
use stribeck_contact::{Law, Method, Smoothing};
use stribeck_solver::Force;
use stribeck_solver::state::NodeForces;

/// Searches are at most this many steps apart, and no closer at the speed of this scene.
const BETWEEN_SEARCHES: usize = 400;

#[test]
fn invariant_steps_between_searches_allocate_nothing() {
    // A disc rolls over a block at 0.2 m/s, pressed in by 2 µm, with damping and friction: on chords in two
    // passes, on splines in one.
    for splines in [false, true] {
        let (radius, size) = (5e-3, 0.5e-3);
        let mut scene = Scene::default();
        let at = [0.0, radius - 2e-6];
        let wheel = scene.add("wheel", &disc(radius, 64, size).translated(at[0], at[1]), "rim");
        let block = scene.add("block", &rectangle([-0.01, -5e-3], 0.02, 5e-3, 40, 10), "top");
        let law = Law::penalty(2e14)
            .and_then(|l| l.with_damping(0.1, 2.0))
            .and_then(|l| l.with_friction(0.01))
            .expect("a possible law");
        scene.pair(wheel, block, law, Method::Integrated { points: 8 });
        let model = scene.model();
        let (mut d, mut contacts) = if splines {
            scene.lay_out_smooth(&model, &[(Smoothing::Arc { centre: at }, true), (Smoothing::Nagata, true)])
        } else {
            scene.lay_out(&model)
        };
        set_step(&mut d, &contacts, 0.5);
        let wheel = of_body(&d, &model, wheel);
        launch(&mut d, &wheel, [0.2, 0.0]);
        let mut allocating = 0;
        let n = d.state.x.len();
        let mut force = NodeForces { fx: vec![0.0; n].into(), fy: vec![0.0; n].into() };
        for _ in 0..2 * BETWEEN_SEARCHES {
            let at = d.moment();
            let taken = allocation_counter::measure(|| contacts.accumulate(at, &mut force));
            allocating += usize::from(taken.count_total > 0);
            d.step(&mut []);
            assert!(contacts.resultants().any(|r| r.penetration > 0.0), "in contact all the time");
        }
        assert!((1..=3).contains(&allocating), "{allocating} of {} steps took memory", 2 * BETWEEN_SEARCHES);
    }
}
