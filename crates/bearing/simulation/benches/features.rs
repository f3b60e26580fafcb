//! What each feature of a scene costs a step: the scene, the scene without it, and features that are there
//! but zero.
//!
//! Prints a table in Markdown.
//! `cargo bench -p stribeck-simulation --bench features -- fixtures/scenes/lean.ron` measures another scene
//! than the paper's. One thread; rounds of all variants alternate, and the median round counts.

mod motion;

use std::path::Path;
use std::time::Instant;

use motion::{CLOSING, bearing};
use stribeck_contact::Contacts;
use stribeck_scene::deviation::{DeviationScene, FormScene, RollingSurface, SpallScene, WavinessScene};
use stribeck_scene::scene::Scene;
use stribeck_solver::{
    Dynamics, Force, Velocities,
    damping::{Frame, MassDamping},
};
use stribeck_system::Parts;

/// Steps of a round, and rounds.
const STEPS: usize = 40;
const ROUNDS: usize = 21;

/// Steps between two samples of the paper's scene, at which energies are added up.
const SAMPLE: usize = 134;

/// Parts of a step besides the elements.
struct Variant {
    name: &'static str,
    scene: Scene,
    contact: bool,
    /// Rate of the mass damping [1/s]; `None` sets none.
    mass_damping: Option<f64>,
    /// Energies at every sample.
    energies: bool,
}

/// A variant in motion.
struct Moving {
    variant: Variant,
    dynamics: Dynamics,
    contacts: Option<Contacts>,
    load: Box<dyn Force + Send>,
    elements: usize,
    before: Velocities,
    /// Processor time of each round [ns per element-step].
    rounds: Vec<f64>,
}

/// A deviation from round, where deviations are by default.
fn on(on: RollingSurface, form: FormScene) -> DeviationScene {
    DeviationScene { on, form, ..DeviationScene::default() }
}

fn variants(scene: &Scene) -> Vec<Variant> {
    let full = |name, change: fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        Variant { name, scene, contact: true, mass_damping: None, energies: false }
    };
    let bare = |name, change: fn(&mut Scene)| Variant { contact: false, ..full(name, change) };
    let light = |s: &mut Scene| {
        (s.cage, s.film, s.solver.structural_damping) = (None, None, None);
        s.operation.gravity_m_s2 = 0.0;
    };
    vec![
        full("everything", |_| ()),
        Variant { energies: true, ..full("everything, and energies at every sample", |_| ()) },
        Variant { mass_damping: Some(5000.0), ..full("and mass damping", |_| ()) },
        full("and waviness of the outer raceway", |s| {
            s.defects.push(on(RollingSurface::Outer, FormScene::Waviness(WavinessScene::default())))
        }),
        full("dry, with spalls of the inner raceway and a roller", |s| {
            s.film = None;
            s.defects.push(on(RollingSurface::Inner, FormScene::Spall(SpallScene::default())));
            s.defects.push(on(RollingSurface::Roller(1), FormScene::Spall(SpallScene::default())));
        }),
        full("and another load angle", |s| s.operation.load_angle_deg = -80.0),
        full("without oil", |s| s.film = None),
        full("without structural damping", |s| s.solver.structural_damping = None),
        full("without contact damping", |s| s.contact.damping_ratio = 0.0),
        full("without friction", |s| (s.contact.friction, s.contact.seat_friction) = (0.0, 0.0)),
        full("without gravity", |s| s.operation.gravity_m_s2 = 0.0),
        full("without cage", |s| s.cage = None),
        bare("without contact", |_| ()),
        bare("elements and load alone", light),
        Variant { mass_damping: Some(0.0), ..bare("the same with mass damping of rate 0", light) },
    ]
}

impl Moving {
    fn new(variant: Variant) -> Self {
        let (mut bearing, elements) = bearing(&variant.scene, 1);
        if let Some(rate) = variant.mass_damping {
            let held = std::iter::once(bearing.outer).chain(bearing.housing);
            let mut frames: Vec<_> = held.map(|body| (body, Frame::Rest)).collect();
            frames.extend(bearing.rollers.iter().map(|r| (r.body, Frame::Tangential { centre: [0.0; 2] })));
            bearing.system.set_mass_damping(&MassDamping::new(rate, frames).expect("a possible rate"));
        }
        let Parts { dynamics, mut contacts, others, .. } = bearing.system.into_parts();
        contacts = contacts.filter(|_| variant.contact);
        let before = Velocities::default();
        let mut moving =
            Self { variant, dynamics, contacts, load: others, elements, before, rounds: Vec::new() };
        (0..CLOSING).for_each(|_| moving.step());
        moving
    }

    fn step(&mut self) {
        let Self { dynamics, contacts, load, .. } = self;
        match contacts {
            Some(contacts) => dynamics.step(&mut [&mut **load, contacts]),
            None => dynamics.step(&mut [&mut **load]),
        }
        if self.variant.energies && dynamics.state.step.is_multiple_of(SAMPLE as u64) {
            dynamics.velocities_into(&mut self.before);
            std::hint::black_box((
                dynamics.elastic_energy(),
                dynamics.gravity_work(),
                dynamics.kinetic_energy(&self.before),
            ));
        }
    }

    fn round(&mut self) {
        let steps = if self.variant.energies { SAMPLE } else { STEPS };
        let began = now_ns();
        (0..steps).for_each(|_| self.step());
        self.rounds.push((now_ns() - began) / (steps * self.elements) as f64);
    }

    fn median(&mut self) -> f64 {
        self.rounds.sort_unstable_by(f64::total_cmp);
        self.rounds[self.rounds.len() / 2]
    }
}

/// Time that this thread has had on a processor [ns]; where the system has no such clock, wall-clock time.
fn now_ns() -> f64 {
    // The system brings this number up to date when a thread offers its processor, and else every few
    // milliseconds.
    std::thread::yield_now();
    thread_local!(static BEGAN: Instant = Instant::now());
    let spent = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let spent = spent.and_then(|s| s.split(' ').next()?.parse().ok());
    spent.unwrap_or_else(|| BEGAN.with(|b| b.elapsed().as_nanos() as f64))
}

fn main() {
    let given = std::env::args().skip(1).find(|a| a.ends_with(".ron"));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let file = given.map_or_else(|| root.join("fixtures/scenes/oiled_steel.ron"), |file| root.join(file));
    let scene = Scene::read(&file).expect("a scene");
    let mut all: Vec<Moving> = variants(&scene).into_iter().map(Moving::new).collect();
    for _ in 0..ROUNDS {
        all.iter_mut().for_each(Moving::round);
    }
    let whole = all[0].median();
    println!("# What each feature costs: {}\n", scene.name);
    println!(
        "Written by `cargo bench -p stribeck-simulation --bench features`: one thread, processor time, \
         medians of"
    );
    println!("{ROUNDS} rounds in turn, quartiles in brackets.\n");
    println!("| step | elements | ns per element-step | of everything |\n|---|---|---|---|");
    for moving in &mut all {
        let median = moving.median();
        let [low, high] = [1, 3].map(|q| moving.rounds[q * moving.rounds.len() / 4]);
        let name = moving.variant.name;
        let share = 100.0 * median / whole;
        println!("| {name} | {} | {median:.2} ({low:.2} to {high:.2}) | {share:.0} % |", moving.elements);
    }
}
