//! Refused plans, conserved quantities, and laws of the user.

use stribeck_contact::Law;
use stribeck_mesh::{Part, Rectangle};
use stribeck_solver::{
    Elastic, Force, NodeMotion,
    state::{Energy, Moment, NodeForces},
};
use stribeck_system::{Error, Pair, Plan, Preload, System, Watched, Workers};

fn steel() -> Elastic {
    Elastic::new(208e9, 0.3, 7800.0).expect("steel is a possible material")
}

fn block(x0: f64, y0: f64) -> Part {
    Rectangle { x0, y0, width: 0.02, height: 0.01, columns: 8, rows: 4 }.part().expect("a rectangle")
}

/// A block that falls on another, which stands on the ground, with a load on its top.
fn plan() -> Plan {
    let mut plan = Plan::new(0.007);
    plan.model.gravity = [0.0, -9.81];
    plan.add("lower", &block(0.0, 0.0), steel()).expect("a new name");
    plan.add("upper", &block(0.004, 0.01), steel()).expect("a new name");
    plan.constrain("lower.bottom", NodeMotion::Held).expect("a surface");
    let law = Law::penalty(5e13).and_then(|law| law.with_friction(0.2)).expect("a law");
    plan.contact(Pair::new("upper.bottom", "lower.top", law)).expect("two surfaces");
    plan.load("upper.top", [0.0, -1e3]).expect("a surface");
    plan
}

fn falling(time_step_factor: f64) -> System {
    let mut system = plan().build(1).expect("a valid plan");
    system.set_time_step_factor(time_step_factor).expect("elements are stiff");
    let upper = system.body("upper").expect("a body");
    system.launch(upper, [0.3, -0.5], 0.0);
    system
}

/// A spring between a node and its place at rest [N/m], along x.
struct Spring {
    slot: u32,
    place: f64,
    stiffness: f64,
    stored: f64,
}

impl Force for Spring {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        let n = self.slot as usize;
        let stretch = at.x[n] - self.place;
        force.fx[n] -= self.stiffness * stretch;
        self.stored = 0.5 * self.stiffness * stretch * stretch;
    }

    fn energy(&self) -> Energy {
        Energy { stored: self.stored, ..Energy::default() }
    }

    fn stiffness_bound(&self, _dt: f64, bound: &mut [f64]) {
        bound[self.slot as usize] += self.stiffness;
    }
}

/// A block on a spring, which pushes on the place with this number among those announced.
fn on_a_spring(at: usize, announced: usize) -> System {
    let mut plan = Plan::new(0.007);
    plan.add("block", &block(0.0, 0.0), steel()).expect("a new name");
    // More places are asked for than are announced, as a law with a mistake would.
    let nodes: Vec<u32> = (0..announced as u32).collect();
    let make = move |places: &[u32]| -> Box<dyn Force + Send> {
        let slot = places[0] + at as u32;
        Box::new(Spring { slot, place: 0.0, stiffness: 1e8, stored: 0.0 })
    };
    plan.force("spring", nodes, make).expect("nodes of the mesh");
    let mut system = plan.build(1).expect("a valid plan");
    system.set_time_step_factor(0.8).expect("elements are stiff");
    system.launch(0, [0.1, 0.0], 0.0);
    system
}

/// Through an impact with friction, under a load and gravity. A penalty law has a corner, which a step cuts:
/// the error falls with the step, to below the guards' warnings.
#[test]
fn conserves_energy_through_contact_friction_loads_and_gravity() {
    let errors = [0.8, 0.2].map(|factor| {
        let mut system = falling(factor);
        let (mut touched, mut looks) = (false, 0);
        let findings = system
            .run((1600.0 / factor) as u64, 10, |system, _| {
                looks += 1;
                touched |= system.resultant("upper.bottom and lower.top").expect("a pair").force[1] > 0.0;
            })
            .expect("a time step is set");
        assert!(touched && findings.iter().all(|finding| !finding.stops), "{findings:?}");
        assert_eq!(looks, (160.0 / factor) as u64);
        let ledger = system.last_ledger();
        assert!(ledger.friction > 0.0 && ledger.external > 0.0, "{ledger:?}");
        system.balance().largest_error
    });
    assert!(errors[1] < 0.01 && errors[1] < 0.5 * errors[0], "{errors:?}");
}

/// A load that is switched and reversed does the work that the bodies gain: the trapezoidal rule over each
/// step is what leapfrog conserves, for a linear model. At strains of σ/E = 3e-6 nonlinearity leaves as much;
/// the rectangle rule would be off by some per cent.
#[test]
fn conserves_energy_under_loads_that_change() {
    const TOLERANCE: f64 = 3e-6;
    let mut plan = Plan::new(0.007);
    plan.add("block", &block(0.0, 0.0), steel()).expect("a new name");
    plan.load("block.right", [50.0, 0.0]).expect("a surface");
    let mut system = plan.build(1).expect("a valid plan");
    system.set_time_step_factor(0.8).expect("elements are stiff");
    for factor in [1.0, 0.0, -2.0, 0.5] {
        system.scale_load("block.right", factor).expect("a load");
        let findings =
            system.run(50, 7, |_, ledger| assert!(ledger.relative_error < TOLERANCE, "{ledger:?}"));
        assert_eq!(findings.expect("a time step is set"), []);
    }
}

#[test]
fn invariant_a_system_goes_on_from_a_snapshot_to_the_same_bits() {
    let mut whole = falling(0.8);
    whole.run(300, 10, |_, _| ()).expect("a time step is set");
    let saved = whole.snapshot();
    whole.run(300, 10, |_, _| ()).expect("a time step is set");
    let mut other = plan().build(2).expect("a valid plan");
    other.set_time_step(whole.time_step(), None).expect("a positive one");
    other.restore(saved.clone()).expect("the same plan");
    assert_eq!(other.steps(), saved.step());
    Workers::new(2).expect("two threads").run(|| other.run(300, 10, |_, _| ())).expect("a time step is set");
    assert!(whole.snapshot() == other.snapshot(), "the states differ");
}

#[test]
fn invariant_a_snapshot_of_another_system_changes_nothing() {
    let mut system = falling(0.8);
    system.run_until(1e-6).expect("a time step is set");
    let before = system.snapshot();
    let mut without_contact = Plan::new(0.007);
    without_contact.add("lower", &block(0.0, 0.0), steel()).expect("a new name");
    let other = without_contact.build(1).expect("a valid plan");
    assert!(matches!(system.restore(other.snapshot()), Err(Error::OtherSystem { what: "loads" })));
    let mut without_load = plan();
    without_load.add("third", &block(0.1, 0.0), steel()).expect("a new name");
    let other = without_load.build(1).expect("a valid plan");
    assert!(matches!(system.restore(other.snapshot()), Err(Error::Solver(_))));
    assert!(system.snapshot() == before, "a refused snapshot changed the system");
}

#[test]
fn invariant_no_step_without_a_time_step() {
    let mut system = plan().build(1).expect("a valid plan");
    assert!(matches!(system.step(), Err(Error::NoTimeStep)));
    assert!(matches!(system.step_with_ledger(), Err(Error::NoTimeStep)));
    assert_eq!((system.steps(), system.time()), (0, 0.0));
    for step in [0.0, f64::NAN] {
        let why = system.set_time_step(step, None).expect_err("no step").to_string();
        assert!(why.contains("time step [s]"), "{why}");
    }
}

/// Strains are v/c = 2e-5 at most, and nonlinearity leaves no larger share of the energy out of balance.
#[test]
fn conserves_energy_with_a_law_of_the_user() {
    const TOLERANCE: f64 = 2e-5;
    let mut system = on_a_spring(0, 45);
    let mut stored = 0.0_f64;
    system
        .run(3000, 10, |_, ledger| {
            stored = stored.max(ledger.further);
            assert!(ledger.relative_error < TOLERANCE, "{ledger:?}");
        })
        .expect("its node is announced");
    assert!(stored > 0.1 * system.balance().peak_energy, "the spring has held {stored} J");
}

/// A force on a node that nobody announced would be lost in the solver, in silence.
#[test]
fn invariant_an_unannounced_force_is_an_error() {
    let mut system = on_a_spring(20, 1);
    // The spring stretches only as the block moves.
    let error = system.run(100, 1, |_, _| ()).expect_err("the node is not announced");
    assert!(matches!(&error, Error::UnannouncedForce { body, .. } if body == "block"), "{error}");
}

#[test]
fn invariant_names_are_found_or_named() {
    let mut plan = plan();
    let says = |error: Error, words: &[&str]| {
        let said = error.to_string();
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    says(plan.load("upper.topp", [0.0; 2]).expect_err("no such surface"), &["`upper.topp`", "`upper.top`"]);
    says(plan.load("upper.top", [0.0; 2]).expect_err("it has a load"), &["`upper.top`", "twice"]);
    says(plan.add("upper", &block(0.0, 0.0), steel()).expect_err("taken"), &["`upper`", "twice"]);
    says(plan.constrain("uper", NodeMotion::Held).expect_err("no such body"), &["`uper`", "`upper`"]);
    let law = Law::penalty(1e12).expect("a law");
    says(plan.contact(Pair::new("upper.top", "roof", law)).expect_err("no roof"), &["`roof`", "`lower.top`"]);
    says(plan.load_nodes("far", vec![(900, [0.0; 2])]).expect_err("no such node"), &["`far`", "900", "90"]);
    let mut system = plan.build(1).expect("a valid plan");
    says(system.scale_load("wind", 2.0).expect_err("no such load"), &["`wind`", "`upper.top`"]);
    says(
        system.resultant("a and b").expect_err("no such pair"),
        &["`a and b`", "`upper.bottom and lower.top`"],
    );
    says(system.body("lid").expect_err("no such body"), &["`lid`", "`lower`"]);
}

/// Far above the critical step the energy grows without bound, and the guard's message has a remedy.
#[test]
fn invariant_an_unstable_step_is_stopped() {
    let mut system = falling(0.8);
    let critical = system.critical_time_step();
    system.set_time_step(1.5 * critical, Some(critical)).expect("a positive one");
    let findings = system.run(2000, 10, |_, _| ()).expect("a time step is set");
    let first = findings.iter().find(|finding| finding.stops).expect("it diverges");
    assert_eq!(first.watched, Watched::Energy, "{first}");
    assert!(first.message.contains("smaller time step factor"), "{first}");
    assert!(system.steps() < 2000, "it went on");
}

/// Bodies that rest on each other stay at rest after the preload.
#[test]
fn invariant_a_settled_system_stays_at_rest() {
    // Contacts that change sides for ever, here at the edge of the lower block, may leave this share of the
    // load unbalanced.
    const TOLERANCE: f64 = 1e-4;
    let mut system = plan().build(1).expect("a valid plan");
    let settled = system.settle(&Preload::default()).expect("the load reaches the ground");
    assert!(settled.unbalanced.is_none_or(|force| force < TOLERANCE * 1e3), "{settled:?}");
    let mass: f64 = system.nodes("upper").expect("a body").iter().map(|&n| system.mass(n)).sum();
    system.set_time_step_factor(0.8).expect("elements are stiff");
    let (mut forces, mut looks) = (0.0, 0.0);
    system
        .run(500, 1, |system, ledger| {
            forces += system.resultant("upper.bottom and lower.top").expect("a pair").force[1];
            looks += 1.0;
            assert!(ledger.kinetic < TOLERANCE * ledger.strain, "{ledger:?}");
        })
        .expect("a time step is set");
    let (found, expected) = (forces / looks, 1e3 + 9.81 * mass);
    assert!((found / expected - 1.0).abs() < TOLERANCE, "{found} N instead of {expected} N");
}

/// Present contact forces cancel over both bodies and carry the preload, and a query changes nothing.
#[test]
fn conserves_momentum_of_present_contact_forces() {
    let mut system = plan().build(1).expect("a valid plan");
    system.settle(&Preload::default()).expect("the load reaches the ground");
    let (before, forces) = (system.snapshot(), system.contact_forces());
    assert!(system.snapshot() == before, "asking for forces changed the system");
    assert_eq!(system.contact_forces(), forces);
    let sum = |body: &str| {
        let nodes = system.nodes(body).expect("a body");
        nodes.iter().fold([0.0, 0.0], |[x, y], &n| [x + forces[n as usize][0], y + forces[n as usize][1]])
    };
    let (on_upper, on_lower) = (sum("upper"), sum("lower"));
    let resultant = system.resultant("upper.bottom and lower.top").expect("a pair").force;
    for axis in [0, 1] {
        let (upper, lower, pair) = (on_upper[axis], on_lower[axis], resultant[axis]);
        assert!(
            (upper - pair).abs().max((upper + lower).abs()) < 1e-9 * resultant[1],
            "{upper} {lower} {pair}"
        );
    }
    assert!(on_upper[1] > 999.0, "{on_upper:?}");
}

/// The largest kinetic energy [J] while pressed blocks, stirred a little, take 3000 steps of `factor` times
/// the critical step of their present positions; that at the beginning.
fn stirred(factor: f64) -> [f64; 2] {
    let mut plan = Plan::new(0.007);
    plan.add("lower", &block(0.0, 0.0), steel()).expect("a new name");
    plan.add("upper", &block(0.0, 0.01), steel()).expect("a new name");
    plan.constrain("lower.bottom", NodeMotion::Held).expect("a surface");
    plan.contact(Pair::new("upper.bottom", "lower.top", Law::penalty(5e13).expect("a law")))
        .expect("two surfaces");
    plan.load("upper.top", [0.0, -1e3]).expect("a surface");
    let mut system = plan.build(1).expect("a valid plan");
    system.settle(&Preload::default()).expect("the load reaches the ground");
    system.set_time_step(factor * system.present_critical_time_step(), None).expect("blocks are stiff");
    let upper = system.body("upper").expect("a body");
    system.launch(upper, [1e-5, 1e-5], 0.0);
    let mut kinetic = Vec::new();
    system.run(3000, 1, |_, ledger| kinetic.push(ledger.kinetic)).expect("a time step is set");
    [kinetic[0], kinetic.into_iter().fold(0.0, f64::max)]
}

/// Central differences are stable to 2/ω_max and no farther (Belytschko, Liu & Moran 2000, §6.6.5). Blocks
/// that do not part keep the stiffness that the step was found for.
#[test]
fn analytic_present_critical_time_step_is_sharp() {
    let [start, below] = stirred(0.998);
    assert!(below < 100.0 * start, "below the limit {start} J became {below} J");
    let [start, above] = stirred(1.01);
    assert!(above > 1e4 * start || above.is_nan(), "above the limit {start} J became only {above} J");
}
