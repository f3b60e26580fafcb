//! A system takes memory when it is built, at searches and at looks, but not for its steps.

use stribeck_contact::Law;
use stribeck_mesh::Rectangle;
use stribeck_solver::Elastic;
use stribeck_system::{Pair, Plan};

#[test]
fn invariant_steps_allocate_nothing() {
    let block = Rectangle { x0: 0.0, y0: 0.0, width: 0.02, height: 0.01, columns: 16, rows: 8 };
    let block = block.part().expect("a rectangle");
    let steel = Elastic::new(208e9, 0.3, 7800.0).expect("steel is a possible material");
    let mut plan = Plan::new(0.007);
    plan.add("lower", &block, steel).expect("a new name");
    plan.add("upper", &block.translated(0.0, 0.01), steel).expect("a new name");
    plan.contact(Pair::new("upper.bottom", "lower.top", Law::penalty(1e13).expect("a law")))
        .expect("surfaces");
    plan.load("upper.top", [0.0, -10.0]).expect("a surface");
    let mut system = plan.build(1).expect("a sound plan");
    system.set_time_step_factor(0.8).expect("elements are stiff");
    // The first step is accounted for and searches.
    system.step().expect("a time step is set");
    let taken = allocation_counter::measure(|| {
        (0..50).for_each(|_| system.step().expect("a time step is set"));
    });
    assert_eq!(taken.count_total, 0);
}
