//! Kinds of input, and the program that is tested with each.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use stribeck_mesh::{Annulus, ArcBlock, Body, Circle, Disc, Grading, Groove, Mesh, Rectangle, SeatedBlock};
use stribeck_scene::scene::Scene;
use stribeck_simulation as simulation;
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_simulation::run::host::Progress;
use stribeck_solver::{Dynamics, Elastic, Model};
use stribeck_store::campaign::Campaign;
use stribeck_store::run_dir::RunDir;
use stribeck_store::trace::Trace;

use super::Answer;
use super::damage::{bytes, text};
use super::readers::{self, Shelf};
use stribeck::host;
use stribeck_scene::dice::Dice;

pub(crate) struct Kind {
    pub(crate) name: &'static str,
    pub(crate) weight: u64,
    pub(crate) attempt: fn(&Inputs, &mut Dice) -> Result<Answer>,
}

pub(crate) const KINDS: [Kind; 10] = [
    Kind { name: "scene", weight: 50, attempt: scene },
    Kind { name: "override", weight: 15, attempt: set },
    Kind { name: "table", weight: 10, attempt: table },
    Kind { name: "campaign", weight: 2, attempt: campaign },
    Kind { name: "trace", weight: 10, attempt: trace },
    Kind { name: "checkpoint", weight: 10, attempt: checkpoint },
    Kind { name: "run-info", weight: 5, attempt: run_info },
    Kind { name: "mesh", weight: 40, attempt: mesh },
    Kind { name: "shape", weight: 4, attempt: shape },
    Kind { name: "reader", weight: 60, attempt: reader },
];

/// A scene of everything that goes over time.
const DUTY: &str = "(operation: (speed_rpm: -300, \
    speed_profile: points([(0.0, 500.0), (20.5, -1e2), (30, 0)]), \
    load_profile: harmonic(amplitude: 5000.0, hz: 25.0, phase_deg: 90.0), \
    rotating_load: (force_n: 1000.0, angle_deg: 30.0)))";

/// A table of a profile.
const TABLE: &str = "time_ms, value # by hand\n0.0, 500.0\n10, 600\n20.25, 1e2\n30,-50.5\n";

/// A campaign of everything, with the table above as that of its other kind.
const CAMPAIGN: &str = "(name: \"x\", scene: \"table.ron\", set: [\"cage=None\", \"mesh.size_mm=4.0\"], \
    seed: 3, starts: 2, split: (train: 0.5, validation: 0.25, test: 0.25), keep: numbers, \
    variants: sobol(count: 4, over: [\
    (field: \"operation.load_n\", from: 5e3, to: 5e4, log: true), \
    (field: \"defects\", values: [[], [(on: roller(1), form: dent())]])]))";

/// Bytes before the content of a checkpoint; length and checksum are the last twelve.
const HEADER: usize = 52;

/// A scene that parses is meshed, too, when it is about this small.
const ELEMENTS: f64 = 3e4;

/// Good files, to be damaged.
pub(crate) struct Inputs {
    pub(crate) folder: PathBuf,
    scenes: Vec<String>,
    trace: Vec<u8>,
    checkpoint: Vec<u8>,
    info: String,
    shelf: Shelf,
}

impl Inputs {
    /// Takes scenes from the repository and makes a run to damage, broken off after two samples.
    pub(crate) fn new(folder: &Path) -> Result<Self> {
        let scenes = ["singh2014", "oiled_steel", "lean", "quick", "ramp", "pitted"].map(|name| {
            let path = stribeck_studies::root().join(format!("fixtures/scenes/{name}.ron"));
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
        });
        let run = folder.join("run");
        let set =
            ["solver.start=sudden", "solver.duration_ms=0.1", "mesh.size_mm=4.0", "mesh.roller_facets=40"];
        let file = stribeck_studies::root().join("fixtures/scenes/quick.ron");
        let scene = Scene::read_with(&file, &set.map(String::from))?;
        let mut samples = 0;
        let dir = RunDir::create(&run)?;
        let mut watch = |progress: &Progress| {
            samples += usize::from(progress.phase == "run");
            if samples == 2 { std::ops::ControlFlow::Break(()) } else { std::ops::ControlFlow::Continue(()) }
        };
        host::with(1, |host| simulation::simulate(&scene, &dir, host, &mut watch))?;
        let read =
            |path: PathBuf| std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()));
        Ok(Self {
            scenes: scenes.into_iter().chain([Ok(DUTY.to_owned())]).collect::<Result<_>>()?,
            trace: read(dir.trace())?,
            checkpoint: read(dir.checkpoint())?,
            info: String::from_utf8(read(dir.info())?)?,
            shelf: Shelf::open()?,
            folder: folder.to_owned(),
        })
    }

    fn run(&self) -> PathBuf {
        self.folder.join("run")
    }
}

/// An error with words is an answer.
fn answered<T, E: std::fmt::Display>(result: Result<T, E>) -> Result<(Answer, Option<T>)> {
    match result {
        Ok(value) => Ok((Answer::Taken, Some(value))),
        Err(error) => {
            ensure!(error.to_string().len() > 10, "refused without words: {error}");
            Ok((Answer::Refused, None))
        }
    }
}

fn scene(inputs: &Inputs, dice: &mut Dice) -> Result<Answer> {
    let base = &inputs.scenes[dice.below(inputs.scenes.len())];
    let (answer, scene) = answered(Scene::parse(&text(base, dice), "generated.ron"))?;
    // Now and then the bodies are made of the accepted values, too.
    if let Some(scene) = scene.filter(|scene| small(scene) && dice.one_in(20)).map(|scene| scene.resolve())
        && let (_, Some(assembly)) = answered(Assembly::new(&scene))?
    {
        answered(assembly.build(&scene, 1))?;
    }
    Ok(answer)
}

/// Whether a scene's mesh is small enough to be made thousands of times.
fn small(scene: &Scene) -> bool {
    let (b, size) = (&scene.bearing, scene.mesh.size_mm);
    let rings = 8.0 * b.outer_race_diameter_mm * (b.outer_ring_thickness_mm + b.inner_ring_thickness_mm)
        / (size * size);
    let facets = scene.mesh.roller_facets as f64;
    let adapter =
        scene.adapter.width_mm * (scene.adapter.height_mm + b.outer_race_diameter_mm) / (size * size);
    let pieces = scene.cage.as_ref().map_or(0.0, |c| 10.0 * c.outer_diameter_mm * c.thickness_mm);
    let given = scene.mesh.outer_facets.unwrap_or(0).max(scene.mesh.inner_facets.unwrap_or(0)) as f64;
    let given = given * (b.outer_ring_thickness_mm.max(b.inner_ring_thickness_mm) / size).max(1.0);
    rings + b.rollers as f64 * facets * facets / 8.0 + adapter + pieces + given < ELEMENTS
}

fn set(inputs: &Inputs, dice: &mut Dice) -> Result<Answer> {
    const FIELDS: [&str; 19] = [
        "mesh.size_mm",
        "bearing.rollers",
        "cage",
        "cage.thickness_mm",
        "defect",
        "defect.length_mm",
        "solver.start",
        "output.sensors",
        "output.sensors[0].angle_deg",
        "mesh.grading",
        "mesh.outer_facets",
        "name",
        "operation",
        "operation.speed_profile",
        "operation.speed_profile.hz",
        "operation.outer_speed_profile.to_ms",
        "operation.load_profile",
        "operation.rotating_load.force_n",
        "",
    ];
    let field = dice.pick(&FIELDS);
    let value = match dice.below(4) {
        3 => text("ramp(from_ms: 0.0, to_ms: 20.0, to: 900.0)", dice),
        0 => format!("{:?}", dice.number()),
        1 => text("Some((coarse_mm: 2.0, fine_layers: 2))", dice),
        _ => text("[(name: \"side\", angle_deg: 0.0)]", dice),
    };
    let set =
        if dice.one_in(10) { text(&format!("{field}={value}"), dice) } else { format!("{field}={value}") };
    let file = stribeck_studies::root().join("fixtures/scenes/quick.ron");
    let _ = inputs;
    Ok(answered(Scene::read_with(&file, &[set]))?.0)
}

fn table(inputs: &Inputs, dice: &mut Dice) -> Result<Answer> {
    let path = inputs.folder.join("damaged.csv");
    let content = if dice.one_in(4) { bytes(TABLE.as_bytes(), dice) } else { text(TABLE, dice).into_bytes() };
    std::fs::write(&path, content)?;
    let file = inputs.folder.join("table.ron");
    let scene = dice.pick(&[
        "(operation: (speed_profile: table(\"damaged.csv\")))",
        "(operation: (load_profile: table(\"damaged.csv\")))",
        "(film: None, defect: None, defects: [(form: profile(file: \"damaged.csv\"))])",
    ]);
    if scene.contains("profile(") {
        let text = String::from_utf8_lossy(&std::fs::read(&path)?).replace("time_ms", "position_mm");
        std::fs::write(&path, text.replace("value", "depth_um"))?;
    }
    std::fs::write(&file, scene)?;
    let (answer, scene) = answered(Scene::read(&file))?;
    if let Some(scene) = scene {
        let duty = scene.duty();
        let angle = duty.shaft_rad(0.02);
        ensure!(
            angle.is_finite() && duty.load_n(0.02) > 0.0,
            "a scene that was taken has no angle or no load"
        );
    }
    Ok(answer)
}

/// The file of a campaign, or the table that it names.
fn campaign(inputs: &Inputs, dice: &mut Dice) -> Result<Answer> {
    let (file, table) = (inputs.folder.join("campaign.ron"), inputs.folder.join("points.csv"));
    std::fs::write(inputs.folder.join("table.ron"), "()")?;
    let good = "operation.load_n, defect.ring\n5e3, outer\n20000.0, inner\n";
    let content = if dice.one_in(3) {
        std::fs::write(&table, text(good, dice))?;
        "(name: \"x\", variants: table(\"points.csv\"))".to_owned()
    } else {
        text(CAMPAIGN, dice)
    };
    // Counts that are large and allowed make large campaigns, as they should; they are left out.
    let number =
        |rest: &str| rest.trim_start().chars().take_while(|c| c.is_ascii_digit() || *c == '_').count();
    if ["count:", "starts:"].into_iter().any(|key| content.split(key).skip(1).any(|rest| number(rest) > 3)) {
        return Ok(Answer::Refused);
    }
    std::fs::write(&file, content)?;
    Ok(answered(Campaign::read(&file))?.0)
}

fn trace(inputs: &Inputs, dice: &mut Dice) -> Result<Answer> {
    let path = inputs.folder.join("damaged.npy");
    // A header of many channels, or damage to a good file.
    let content = if dice.one_in(20) {
        let fields: Vec<String> = (0..dice.below(30_000)).map(|i| format!("('c{i}', '<f8')")).collect();
        let head = format!("{{'descr': [{}], 'fortran_order': False, 'shape': (2,), }}\n", fields.join(", "));
        let mut content = b"\x93NUMPY\x02\x00".to_vec();
        content.extend((head.len() as u32).to_le_bytes());
        content.extend(head.as_bytes());
        content.extend(vec![7; dice.below(500_000)]);
        content
    } else {
        // Mostly the header: what follows are numbers, of which none is wrong.
        let cut = inputs.trace.len().min(if dice.one_in(4) { usize::MAX } else { 4000 });
        bytes(&inputs.trace[..cut], dice)
    };
    std::fs::write(&path, content)?;
    Ok(answered(Trace::read(&path))?.0)
}

fn checkpoint(inputs: &Inputs, dice: &mut Dice) -> Result<Answer> {
    let mut damaged = bytes(&inputs.checkpoint, dice);
    // Mostly with a length and a checksum that fit, so that the damage is deeper.
    let fits = damaged.len() > HEADER && !dice.one_in(4);
    if fits {
        let length = (damaged.len() - HEADER) as u64;
        let checksum = crc32fast::hash(&damaged[HEADER..]);
        damaged[..HEADER - 12].copy_from_slice(&inputs.checkpoint[..HEADER - 12]);
        damaged[HEADER - 12..HEADER - 4].copy_from_slice(&length.to_le_bytes());
        damaged[HEADER - 4..HEADER].copy_from_slice(&checksum.to_le_bytes());
    }
    let dir = RunDir::open(inputs.run())?;
    std::fs::write(dir.info(), &inputs.info)?;
    std::fs::write(dir.checkpoint(), damaged)?;
    let (answer, saved) = answered(simulation::saved_until(&dir))?;
    // Some that can be read are continued: numbers that are none must stop the run, not the program.
    if saved.is_some() && dice.one_in(40) {
        std::fs::write(dir.trace(), &inputs.trace)?;
        drop(dir);
        let dir = RunDir::reopen(inputs.run())?;
        let began = std::time::Instant::now();
        let mut watch = |_: &Progress| {
            // A checkpoint may claim any number of samples to come.
            if began.elapsed().as_secs() > 1 {
                std::ops::ControlFlow::Break(())
            } else {
                std::ops::ControlFlow::Continue(())
            }
        };
        answered(host::with(1, |host| simulation::resume(&dir, host, &mut watch)))?;
    }
    Ok(answer)
}

fn run_info(inputs: &Inputs, dice: &mut Dice) -> Result<Answer> {
    let dir = RunDir::open(inputs.run())?;
    std::fs::write(dir.info(), text(&inputs.info, dice))?;
    Ok(answered(dir.read_info())?.0)
}

/// Lists of nodes and elements that no generator would make.
fn mesh(_: &Inputs, dice: &mut Dice) -> Result<Answer> {
    let nodes = 1 + dice.below(20);
    let odd = dice.one_in(2);
    let coordinate = |dice: &mut Dice| if odd && dice.one_in(8) { dice.number() } else { dice.share() };
    let index = |dice: &mut Dice| {
        let strangers = usize::from(odd && dice.one_in(10));
        dice.below(nodes + strangers) as u32
    };
    let mut mesh = Mesh {
        x: (0..nodes).map(|_| coordinate(dice)).collect(),
        y: (0..nodes + usize::from(dice.one_in(30))).map(|_| coordinate(dice)).collect(),
        quads: (0..dice.below(6)).map(|_| [0; 4].map(|_: u32| index(dice))).collect(),
        triangles: (0..dice.below(12)).map(|_| [0; 3].map(|_: u32| index(dice))).collect(),
        bodies: Vec::new(),
    };
    if !odd {
        // Counter-clockwise where they are not: more of these can be laid out.
        for t in &mut mesh.triangles {
            let [a, b, c] = t.map(|n| (mesh.x[n as usize], mesh.y[n as usize]));
            if (b.0 - a.0) * (c.1 - a.1) < (c.0 - a.0) * (b.1 - a.1) {
                t.swap(1, 2);
            }
        }
    }
    let end = |dice: &mut Dice, n: usize| if dice.one_in(20) { dice.below(n + 3) } else { n };
    mesh.bodies.push(Body {
        name: "body".into(),
        nodes: 0..end(dice, nodes),
        quads: 0..end(dice, mesh.quads.len()),
        triangles: 0..end(dice, mesh.triangles.len()),
    });
    let steel = Elastic::new(208e9, 0.3, 7800.0)?;
    let (_, model) = answered(Model::new(mesh, steel, 0.01))?;
    let Some(model) = model else { return Ok(Answer::Refused) };
    let (answer, dynamics) = answered(Dynamics::new(&model, &vec![true; nodes], 1))?;
    if let Some(mut d) = dynamics {
        let critical = d.critical_time_step(&[], 0.0).time_step;
        if answered(d.set_time_step(0.9 * critical))?.1.is_some() {
            d.step(&mut []);
        }
        d.distortion();
    }
    Ok(answer)
}

/// A file of signals, or a mesh of another program.
fn reader(inputs: &Inputs, dice: &mut Dice) -> Result<Answer> {
    readers::attempt(&inputs.shelf, &inputs.folder, dice)
}

/// Dimensions and counts for the generators.
fn shape(_: &Inputs, dice: &mut Dice) -> Result<Answer> {
    let length = |dice: &mut Dice| match dice.below(6) {
        0 => dice.number(),
        1 => 1e-6 * dice.share(),
        _ => 0.2 * dice.share(),
    };
    // Counts that are large and allowed make large meshes, as they should; they are left out.
    let count = |dice: &mut Dice| match dice.below(12) {
        0 => dice.bits() as usize | 1 << 40,
        1 => dice.below(3),
        2 => 1_usize << (20 + dice.below(43)),
        _ => dice.below(150),
    };
    let mut asked = String::new();
    let began = std::time::Instant::now();
    let part = match dice.below(5) {
        0 => {
            let [x0, y0, width, height] = [0; 4].map(|_| length(dice));
            let shape = Rectangle { x0, y0, width, height, columns: count(dice), rows: count(dice) };
            asked += &format!("{shape:?}");
            shape.part()
        }
        1 => {
            let (radius, size) = (length(dice), length(dice));
            // Fine squares that are allowed make a large core.
            let size = if size < 0.02 * radius && size > 1e-4 * radius { 0.02 * radius } else { size };
            let disc = Disc { radius, facets: count(dice), size, rotation: dice.number() };
            asked += &format!("{disc:?}");
            if dice.one_in(2) { disc.part() } else { disc.part_with_layers(count(dice)) }
        }
        2 => {
            let inner_radius = length(dice);
            let outer_radius = if dice.one_in(4) { length(dice) } else { inner_radius + 0.05 * dice.share() };
            let groove = |dice: &mut Dice| Groove {
                centre_angle: 7.0 * dice.share(),
                length: length(dice),
                depth: 0.02 * dice.share(),
                slope: 1.6 * dice.share(),
                circle: if dice.one_in(2) { Circle::Inner } else { Circle::Outer },
            };
            let grooves: Vec<Groove> = (0..dice.below(4)).map(|_| groove(dice)).collect();
            let ring = Annulus {
                inner_radius,
                outer_radius,
                facets: count(dice),
                // Relaxing the cells around a deep groove takes seconds for a hundred layers.
                layers: if grooves.is_empty() { count(dice) } else { count(dice) % 30 },
                start_angle: dice.share(),
                grooves,
            };
            asked += &format!("{ring:?}");
            if dice.one_in(3) {
                let side = if dice.one_in(2) { Circle::Inner } else { Circle::Outer };
                let grading = Grading { fine: side, fine_layers: count(dice), transitions: dice.below(14) };
                asked += &format!(" {grading:?}");
                ring.graded_part(&grading)
            } else {
                ring.part()
            }
        }
        3 => {
            let shape = ArcBlock {
                inner_radius: length(dice),
                outer_radius: length(dice),
                right_line_angle: dice.share(),
                left_line_angle: 2.0 * dice.share(),
                half_width: 0.1 * length(dice),
                rows: count(dice),
                columns: count(dice),
            };
            asked += &format!("{shape:?}");
            shape.part()
        }
        _ => {
            let shape = SeatedBlock {
                width: length(dice),
                height: length(dice),
                seat_radius: length(dice),
                columns: count(dice),
                rows: count(dice),
            };
            asked += &format!("{shape:?}");
            shape.part()
        }
    };
    ensure!(began.elapsed().as_secs() < 20, "{asked} took {:.1} s", began.elapsed().as_secs_f64());
    let (answer, part) = answered(part)?;
    if let Some(part) = part {
        // The solver accepts every mesh of a generator.
        ensure!(part.x.iter().chain(&part.y).all(|v| v.is_finite()), "{asked} has a node that is no number");
        if part.x.len() < 3000 {
            let mut mesh = Mesh::new();
            mesh.add("body", &part);
            let nodes = mesh.x.len();
            let model = Model::new(mesh, Elastic::new(208e9, 0.3, 7800.0)?, 0.01)?;
            Dynamics::new(&model, &vec![false; nodes], 1).with_context(|| asked)?;
        }
    }
    Ok(answer)
}
