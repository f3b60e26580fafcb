//! From the finite elements of a preloaded bearing to what a reduced run needs of them (THEORY §9.1–9.3).

use std::{
    collections::BTreeSet,
    f64::consts::{PI, TAU},
};

use serde::{Deserialize, Serialize};
use stribeck_bearing::{
    assembly::{Assembly, Machine, MeshedParts},
    start::preload,
};
use stribeck_mesh::Mesh;
use stribeck_scene::{
    geometry::{DefectGeometry, Geometry},
    housing::HousingScene,
    scene::{ModelScene, ReducedScene, Scene},
    static_load,
};
use stribeck_simd::lanes::LANES;
use stribeck_solver::{
    Dynamics, Force,
    state::{Moment, NodeForces},
    statics::{Modes, SmallMotions, Spring, modes_below},
};

use crate::{
    compliance::{Compliance, Pressed},
    error::Error,
    outline::Outline,
    seat::{self, Seat},
    structure::{Structure, flexibility},
};

/// Shift of the factorised matrix K + σM [rad²/s²]: (2π · 200 Hz)², far above rounding and far below the lowest mode that bends.
const SHIFT: f64 = 1.6e6;

/// Loads of the local contact problem, up to this multiple of the largest roller load between rigid rings.
pub(crate) const OVERLOAD: f64 = 4.0;

/// Loads at which the local contact problem is solved, and knots of the curve through them.
const LOADS: usize = 14;
const KNOTS: usize = 48;

/// What the elastic bodies of one mesh under one load become.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reduction {
    /// Modes of outer ring and housing that are kept.
    pub modes: usize,
    /// The same, filled up with zeros to whole groups.
    pub padded: usize,
    /// ω² of each mode [rad²/s²].
    pub squares: Vec<f64>,
    /// Vertices of the outer raceway, counter-clockwise, at the preload but for what the rollers press in locally [m].
    pub outer: Vec<[f64; 2]>,
    /// Shapes at these vertices [1/√kg]: x of all modes, then y, vertex by vertex.
    pub shapes: Vec<f64>,
    /// Vertices of the inner raceway, counter-clockwise, at the start [m].
    pub inner: Vec<[f64; 2]>,
    /// Vertices of a roller that is not turned, from its centre [m].
    pub roller: Vec<[f64; 2]>,
    /// Sensors in the order of the scene.
    pub sensors: Vec<Sensor>,
    /// Forces of load, weight and prestress on each mode at the preload [N/√kg].
    pub constant: Vec<f64>,
    /// Those of the load and of weight alone [N/√kg].
    pub external: Vec<f64>,
    /// What the load does.
    pub load: Load,
    /// Forces of dampers on each mode by a unit velocity of every mode [1/s], row by row; empty without dampers.
    pub dampers: Vec<f64>,
    /// The frame around springs, which moves as one piece.
    pub frame: Option<Frame>,
    /// Strain energy of all bodies at the preload [J].
    pub strain: f64,
    /// Of roller and outer raceway.
    pub outer_compliance: Compliance,
    /// Of roller and inner raceway.
    pub inner_compliance: Compliance,
    /// Of a roller on a wall of the cage, which is rigid and flat.
    pub wall_compliance: Compliance,
    /// Mass [kg] and moment of inertia [kg m²] of a roller.
    pub roller_inertia: [f64; 2],
    /// The same of the cage, if there is one, with its centre of mass [m].
    pub cage: Option<([f64; 2], [f64; 2])>,
    /// Mass of outer ring and adapter [kg].
    pub structure_mass: f64,
    /// Force of the housing on the outer ring that sits in it, at the preload [N].
    pub seat: Option<[f64; 2]>,
    /// Its springs, which may open and slip.
    pub springs: Option<Seat>,
    /// What was meshed: the same for every start.
    pub parts: MeshedParts,
    /// Displacements of the nodes of rings and housing at the preload [m].
    pub moved: Vec<[f64; 2]>,
    /// What the preload left open.
    pub warning: Option<String>,
}

/// What a sensor hears.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Shapes at its node [1/√kg]: x of all modes, then y.
    pub shape: Vec<f64>,
    /// Displacement (x, y) by a unit force towards the outside at each vertex of the raceway, beyond the modes [m/N].
    pub residual: Vec<[f64; 2]>,
}

/// What moves as one piece beside an elastic ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Its mass [kg].
    pub mass: f64,
    /// Shapes at its nodes [1/√kg]: x of all modes, then y.
    pub shape: Vec<f64>,
}

/// The load of the preload, and what it does to the modes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Load {
    /// How large it is [N].
    pub force: f64,
    /// What it does to each mode [N/√kg].
    pub along: Vec<f64>,
    /// The same of an equal load a quarter of a turn ahead of it.
    pub across: Vec<f64>,
}

/// Node numbers, while the system still knows them by name.
struct Nodes {
    outer: Vec<u32>,
    inner: Vec<u32>,
    rim: Vec<u32>,
    structure: Vec<u32>,
    inner_ring: Vec<u32>,
    roller: Vec<u32>,
    sensors: Vec<u32>,
}

impl Reduction {
    /// Makes the full model of the scene, preloads it and reduces it.
    ///
    /// # Errors
    /// When the scene cannot be meshed or preloaded, or modes are not found.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let parts = MeshedParts::new(scene)?;
        let assembly = Assembly::of(scene, &parts)?;
        let mut machine = assembly.machine(scene, 1)?;
        let warning = preload(&mut machine, scene, &assembly.kinematics)?;
        let reduced = Self::of(scene, machine, parts, &assembly.model.mesh)?;
        Ok(Self { warning, ..reduced })
    }

    fn of(scene: &Scene, mut machine: Machine, meshed: MeshedParts, mesh: &Mesh) -> Result<Self, Error> {
        let g = Geometry::of(scene);
        let forces = machine.system.contact_forces();
        let resultants: Vec<[f64; 2]> = machine.system.resultants().map(|r| r.force).collect();
        let seat = machine.pairs.seat().map(|seat| resultants[seat]);
        let nodes = Nodes::of(&machine, &g)?;
        let on_ring: Vec<u32> = machine.system.nodes_of(machine.outer).collect();
        let of_roller = machine.system.motion_of(machine.rollers[0].body);
        let cage = machine.cage.map(|body| machine.system.motion_of(body));
        let places: Vec<[f64; 2]> =
            (0..machine.system.node_count() as u32).map(|n| machine.system.position(n)).collect();
        let place = |n: &u32| places[*n as usize];
        let of_rings = 0..mesh.bodies[machine.rollers[0].body].nodes.start;
        let moved = of_rings.map(|n| [places[n][0] - mesh.x[n], places[n][1] - mesh.y[n]]).collect();
        let centre = place(&machine.rollers[0].centre);
        let structure_mass: f64 = nodes.structure.iter().map(|&n| machine.system.mass(n)).sum();

        let frame = match scene.housing {
            HousingScene::Springs(_) => machine.housing.and_then(|body| {
                let mass = machine.system.nodes_of(body).map(|n| machine.system.mass(n)).sum::<f64>();
                Some((mass, machine.system.nodes_of(body).next()?))
            }),
            _ => None,
        };
        let mut parts = machine.system.into_parts();
        let strain = parts.dynamics.elastic_energy();
        let strain = strain.strain + strain.hourglass;
        let slot_of = parts.dynamics.layout().slot_of_node.clone();
        let slots = |nodes: &[u32]| -> Vec<u32> { nodes.iter().map(|&n| slot_of[n as usize]).collect() };

        // All forces at the preload: on the structure, and those of contact and elements alone.
        let count = parts.dynamics.state.x.len();
        let mut all = NodeForces::zeros(count);
        // In the undeformed mesh springs of the housing do not push: what is left is the load.
        let mut loaded = NodeForces::zeros(count);
        let mut undeformed = parts.dynamics.state.clone();
        for (n, &slot) in slot_of.iter().enumerate() {
            (undeformed.x[slot as usize], undeformed.y[slot as usize]) = (mesh.x[n], mesh.y[n]);
        }
        let now = parts.dynamics.moment();
        parts.others.accumulate(Moment { x: &undeformed.x, y: &undeformed.y, ..now }, &mut loaded);
        let mut pushed = NodeForces::zeros(count);
        parts.others.accumulate(now, &mut pushed);
        let strain = strain + parts.others.energy().stored;
        let mut outside = loaded.clone();
        let [gx, gy] = parts.dynamics.gravity();
        for (n, mass) in parts.dynamics.mass().iter().enumerate() {
            outside.fx[n] += mass * gx;
            outside.fy[n] += mass * gy;
        }
        let (x, y) = (&parts.dynamics.state.x, &parts.dynamics.state.y);
        let mut suspension = Vec::new();
        parts.others.tangent(x, y, &mut |piece| suspension.push(Spring::from(piece)));
        let mut springs = Vec::new();
        if let Some(contacts) = &mut parts.contacts {
            contacts.accumulate(parts.dynamics.moment(), &mut all);
            let of_structure: BTreeSet<u32> = slots(&nodes.structure).into_iter().collect();
            contacts.tangent(x, y, &mut |piece| {
                if piece.nodes.iter().all(|slot| of_structure.contains(slot)) {
                    springs.push(Spring::from(piece));
                }
            });
        }
        {
            let d: &Dynamics = &parts.dynamics;
            d.elastic_forces(&d.state.x, &d.state.y, &mut all.fx, &mut all.fy);
        }
        for n in 0..count {
            all.fx[n] += outside.fx[n] + (pushed.fx[n] - loaded.fx[n]);
            all.fy[n] += outside.fy[n] + (pushed.fy[n] - loaded.fy[n]);
        }

        let of_structure = slots(&nodes.structure);
        let mut structure = if scene.housing.is_rigid() {
            Structure::Rigid { root_mass: structure_mass.sqrt(), slots: of_structure }
        } else {
            let all = [&springs[..], &suspension].concat();
            let mut motions = SmallMotions::new(&parts.dynamics, &of_structure, &all, SHIFT)?;
            let modes = modes_below(&mut motions, 1e3 * Self::khz(scene))?;
            Structure::Elastic { motions: Box::new(motions), modes, slots: of_structure }
        };
        let on_ring: BTreeSet<u32> = slots(&on_ring).into_iter().collect();
        let back: Vec<(u32, [f64; 2])> =
            machine.back.iter().map(|&n| (slot_of[n as usize], forces[n as usize])).collect();
        let raceway: Vec<(u32, [f64; 2], f64)> = nodes
            .outer
            .iter()
            .map(|&n| {
                let [x, y] = place(&n);
                let [nx, ny] = [x / x.hypot(y), y / x.hypot(y)];
                let [fx, fy] = forces[n as usize];
                (slot_of[n as usize], [nx, ny], nx * fx + ny * fy)
            })
            .collect();
        let seat_parts = seat::Parts {
            raceway: &raceway,
            springs: &springs,
            friction: scene.contact.seat_friction > 0.0,
            x,
            y,
            back: &back,
            sensors: &slots(&nodes.sensors),
            of_ring: &|slot| on_ring.contains(&slot),
            thickness: g.outer_ring_thickness,
        };
        let seat_springs = Seat::of(&mut structure, &seat_parts)?;
        let kept = structure.squares().len();
        let padded = kept.next_multiple_of(LANES);
        // What the rollers do to the outer raceway at the preload.
        let mut pressed = NodeForces::zeros(count);
        for &n in &nodes.outer {
            let slot = slot_of[n as usize] as usize;
            [pressed.fx[slot], pressed.fy[slot]] = forces[n as usize];
        }
        let mut by_rollers = structure.generalised(&pressed, padded);
        let taken_back = |vertex: usize| {
            let all = seat_springs.as_ref().map_or(&[][..], |seat| &seat.taken_back);
            all.iter().skip(vertex * kept).take(kept)
        };
        for (vertex, (_, _, force)) in raceway.iter().enumerate() {
            by_rollers.iter_mut().zip(taken_back(vertex)).for_each(|(sum, back)| *sum -= force * back);
        }
        let unbalanced = structure.generalised(&all, padded);
        let constant = unbalanced.iter().zip(&by_rollers).map(|(all, rollers)| all - rollers).collect();
        let external = structure.generalised(&outside, padded);
        let turned = NodeForces { fx: loaded.fy.iter().map(|fy| -fy).collect(), fy: loaded.fx.clone() };
        let load = Load {
            force: g.load,
            along: structure.generalised(&loaded, padded),
            across: structure.generalised(&turned, padded),
        };
        let dampers = match &scene.housing {
            HousingScene::Springs(springs) => {
                // Each spring has its damper, in the same proportion.
                let ratio = 1e-6 * springs.damping_n_s_m / springs.stiffness_n_um;
                dampers(&structure, &suspension, ratio, padded)
            }
            _ => Vec::new(),
        };
        let frame = frame
            .map(|(mass, node)| Frame { mass, shape: structure.shape_at(slot_of[node as usize], padded) });

        // The raceway without the dents of the rollers, which the local compliance makes anew.
        let on_raceway = slots(&nodes.outer);
        let dents = structure.residuals(&[pressed], &on_raceway).remove(0);
        let without_dent = |(n, [dx, dy]): (&u32, &[f64; 2])| {
            let [x, y] = place(n);
            [x - dx, y - dy]
        };
        let outer: Vec<[f64; 2]> = nodes.outer.iter().zip(&dents).map(without_dent).collect();
        let mut shapes: Vec<f64> =
            on_raceway.iter().flat_map(|&slot| structure.shape_at(slot, padded)).collect();
        for (vertex, (shape, (_, [nx, ny], _))) in
            shapes.chunks_exact_mut(2 * padded).zip(&raceway).enumerate()
        {
            let (x, y) = shape.split_at_mut(padded);
            for ((x, y), back) in x.iter_mut().zip(y).zip(taken_back(vertex)) {
                (*x, *y) = (*x - nx * back, *y - ny * back);
            }
        }

        let direction = |[x, y]: [f64; 2]| [x / x.hypot(y), y / x.hypot(y)];
        // By reciprocity: a unit force at a sensor moves the raceway as one there moves the sensor.
        let units: Vec<NodeForces> = nodes
            .sensors
            .iter()
            .flat_map(|&n| [[1.0, 0.0], [0.0, 1.0]].map(|along| (slot_of[n as usize] as usize, along)))
            .map(|(slot, along)| {
                let mut unit = NodeForces::zeros(count);
                [unit.fx[slot], unit.fy[slot]] = along;
                unit
            })
            .collect();
        let heard = structure.residuals(&units, &on_raceway);
        let sensors = nodes.sensors.iter().zip(heard.chunks_exact(2)).map(|(&n, moved)| {
            let heard = outer.iter().enumerate().map(|(vertex, place)| {
                let [nx, ny] = direction(*place);
                [0, 1].map(|component: usize| {
                    let [x, y] = moved[component][vertex];
                    nx * x + ny * y
                })
            });
            Sensor { shape: structure.shape_at(slot_of[n as usize], padded), residual: heard.collect() }
        });
        let sensors = sensors.collect();

        // Local compliances: one flexibility of each surface.
        let most = OVERLOAD * static_load::at_start(scene).map_or(g.load, |load| load.max_roller_n());
        let most = most.clamp(1.0, OVERLOAD * g.load.max(1.0));
        let [ro, ri] = [g.outer_contact_radius(), g.inner_contact_radius()];
        let facet = |outline: &[[f64; 2]], at: usize| {
            let [a, b] = [outline[at], outline[(at + 1) % outline.len()]];
            (b[0] - a[0]).hypot(b[1] - a[1])
        };
        let e_star = g.material.youngs_modulus / (2.0 * (1.0 - g.material.poissons_ratio.powi(2)));
        let penalty = g.penalty_stiffness * g.thickness;
        let half_count = |radius: f64, spacing: f64| {
            let q = most / g.thickness;
            let hertz = 4.0 * q * radius / (PI * e_star);
            let winkler = (1.5 * q * radius / g.penalty_stiffness).powf(2.0 / 3.0);
            (1.3 * (hertz + winkler).sqrt() / spacing).ceil() as usize + 2
        };
        // Beside a groove, or between two, where none is near; without any where the load is.
        let beside_of = |d: &DefectGeometry| {
            d.angle + (0.5 * d.length + 2.0 * g.outer_ring_thickness) / g.outer_race_radius
        };
        let room = |at: f64| {
            let apart = |d: &DefectGeometry| (at - d.angle + PI).rem_euclid(TAU) - PI;
            g.grooves.iter().map(|d| apart(d).abs() - 0.5 * d.length / g.outer_race_radius).fold(PI, f64::min)
        };
        let between = g.grooves.windows(2).map(|d| 0.5 * (d[0].angle + d[1].angle));
        let places = g.grooves.iter().map(beside_of).chain(between);
        let beside = places.max_by(|a, b| room(*a).total_cmp(&room(*b)));
        let beside = beside.unwrap_or(scene.load_zone_deg().to_radians());
        let node_at = |outline: &[[f64; 2]], angle: f64| {
            let (s, c) = angle.sin_cos();
            let along = |p: &[f64; 2]| direction(*p)[0] * c + direction(*p)[1] * s;
            (0..outline.len()).max_by(|&a, &b| along(&outline[a]).total_cmp(&along(&outline[b]))).unwrap_or(0)
        };
        let at = node_at(&outer, beside);
        let outer_spacing = facet(&outer, at);
        let flexible_outer = structure.flexibility(
            &patch(&nodes.outer, at, half_count(ro, outer_spacing)),
            &|n| slot_of[n as usize],
            &|n| direction(place(&n)),
        );

        let inner: Vec<[f64; 2]> = nodes
            .inner
            .iter()
            .map(|&n| {
                let mesh = &parts.dynamics.state;
                let slot = slot_of[n as usize] as usize;
                [mesh.x[slot], mesh.y[slot]]
            })
            .collect();
        let mut motions = SmallMotions::new(&parts.dynamics, &slots(&nodes.inner_ring), &[], SHIFT)?;
        let at = node_at(&inner, beside);
        let inner_spacing = facet(&inner, at);
        let inwards = |n: u32| {
            let [x, y] = direction(place(&n));
            [-x, -y]
        };
        let flexible_inner = flexibility(
            &mut motions,
            None,
            &patch(&nodes.inner, at, half_count(ri, inner_spacing)),
            &|n| slot_of[n as usize],
            &inwards,
        );

        let mut motions = SmallMotions::new(&parts.dynamics, &slots(&nodes.roller), &[], SHIFT)?;
        let rigid = rigid_modes(&parts.dynamics, &motions, &slots(&nodes.roller));
        let to_centre = |n: u32| {
            let [x, y] = place(&n);
            direction([centre[0] - x, centre[1] - y])
        };
        let rim_facet = TAU * g.roller_radius / nodes.rim.len() as f64;
        let mut own = patch(&nodes.rim, 0, half_count(ro.max(ri), rim_facet));
        let middle = own.len();
        // The node on the other side comes last.
        own.push(nodes.rim[nodes.rim.len() / 2]);
        let flexible = flexibility(&mut motions, Some(&rigid), &own, &|n| slot_of[n as usize], &to_centre);
        let across = flexible[middle / 2][middle];
        let flexible_roller: Vec<Vec<f64>> =
            flexible[..middle].iter().map(|row| row[..middle].to_vec()).collect();

        let compliance = |flexible: &[Vec<f64>], spacing: f64, radius: f64, across: f64| {
            let pressed = Pressed {
                spacing: [spacing, rim_facet],
                flexibility: [flexible, &flexible_roller],
                radius,
                penalty,
            };
            curve(&pressed, most, across)
        };
        let outer_compliance = compliance(&flexible_outer, outer_spacing, ro, across);
        let inner_compliance = compliance(&flexible_inner, inner_spacing, ri, across);
        // Nothing holds the roller on its other side but its mass.
        let rigid = vec![vec![0.0; middle]; middle];
        let wall_compliance = compliance(&rigid, rim_facet, g.roller_radius, 0.0);
        let roller = (0..nodes.rim.len())
            .map(|i| (TAU * i as f64 / nodes.rim.len() as f64).sin_cos())
            .map(|(s, c)| [g.roller_radius * c, g.roller_radius * s])
            .collect();
        let mut squares = vec![0.0; padded];
        squares[..kept].copy_from_slice(structure.squares());
        Ok(Self {
            modes: kept,
            padded,
            squares,
            outer,
            shapes,
            // As it was meshed: it turns on as a rigid body.
            inner: nodes.inner.iter().map(|&n| [mesh.x[n as usize], mesh.y[n as usize]]).collect(),
            roller,
            sensors,
            constant,
            external,
            load,
            dampers,
            frame,
            strain,
            outer_compliance,
            inner_compliance,
            wall_compliance,
            roller_inertia: [of_roller.mass, of_roller.inertia],
            cage: cage.map(|cage| ([cage.mass, cage.inertia], cage.centre)),
            structure_mass,
            seat,
            springs: seat_springs,
            parts: meshed,
            moved,
            warning: None,
        })
    }
}

/// Forces on each mode by a unit velocity of every mode [1/s], row by row, of dampers beside springs: `ratio` is damping over stiffness
/// [s].
fn dampers(structure: &Structure, springs: &[Spring], ratio: f64, padded: usize) -> Vec<f64> {
    let mut sums = vec![0.0; padded * padded];
    for spring in springs {
        let stretch = structure.stretch(spring, padded);
        for (row, a) in sums.chunks_exact_mut(padded).zip(&stretch) {
            row.iter_mut().zip(&stretch).for_each(|(sum, b)| *sum += ratio * spring.stiffness * a * b);
        }
    }
    sums
}

impl Nodes {
    fn of(machine: &Machine, g: &Geometry) -> Result<Self, Error> {
        let system = &machine.system;
        let named = |name: &str| system.nodes(name).map_err(stribeck_bearing::error::Error::from);
        // The outer raceway is walked clockwise, with the solid on the left.
        let mut outer = named("outer raceway")?;
        outer.reverse();
        Ok(Self {
            outer,
            inner: named("inner raceway")?,
            rim: named("rim of roller 1")?,
            structure: std::iter::once(machine.outer)
                .chain(machine.housing)
                .flat_map(|body| system.nodes_of(body))
                .collect(),
            inner_ring: system.nodes_of(machine.inner).collect(),
            roller: system.nodes_of(machine.rollers[0].body).collect(),
            sensors: machine.nodes_on_back(&g.sensor_angles),
        })
    }
}

/// Nodes from `half` before to `half` behind one of a closed surface.
fn patch(surface: &[u32], at: usize, half: usize) -> Vec<u32> {
    let n = surface.len();
    (0..=2 * half).map(|i| surface[(at + n + i - half % n) % n]).collect()
}

/// Translations and rotation of a free body, with φᵀMφ = 1.
fn rigid_modes(d: &Dynamics, motions: &SmallMotions, slots: &[u32]) -> Modes {
    let motion = d.rigid_motion(slots);
    let shape = |of: &dyn Fn([f64; 2]) -> [f64; 2], inertia: f64| {
        let mut shape = vec![0.0; motions.equations()];
        for &slot in slots {
            let n = slot as usize;
            let [x, y] = of([d.state.x[n] - motion.centre[0], d.state.y[n] - motion.centre[1]]);
            if let Some(at) = motions.equation(slot) {
                (shape[at], shape[at + 1]) = (x / inertia.sqrt(), y / inertia.sqrt());
            }
        }
        shape
    };
    let shapes = vec![
        shape(&|_| [1.0, 0.0], motion.mass),
        shape(&|_| [0.0, 1.0], motion.mass),
        shape(&|[x, y]| [-y, x], motion.inertia),
    ];
    Modes { squares: vec![0.0; 3], shapes }
}

/// Solves the local contact problem at several loads; `across` is what a roller gives way by an equal force on its other side
/// [m/N].
fn curve(pressed: &Pressed<'_>, most: f64, across: f64) -> Compliance {
    // Where nodes lie to each other under a contact, there is every case; a few stand for all.
    let phases = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5]];
    let mean = |delta: f64| {
        phases.iter().map(|&phase| pressed.force(delta, phase)).sum::<f64>() / phases.len() as f64
    };
    let mut deepest = 2.0 * pressed.rigid(most);
    for _ in 0..20 {
        if mean(deepest) >= most {
            break;
        }
        deepest *= 1.4;
    }
    let (mut loads, mut approaches) = (Vec::new(), Vec::new());
    for i in 1..=LOADS {
        // Denser at light loads.
        let delta = deepest * (i as f64 / LOADS as f64).powi(2);
        let force = mean(delta);
        loads.push(force);
        approaches.push(delta - pressed.rigid(force) + across * force);
    }
    Compliance::through(&loads, &approaches, KNOTS)
}

impl Reduction {
    /// The boundaries of outer raceway, inner raceway and roller.
    pub fn outlines(&self) -> [Outline; 3] {
        [&self.outer, &self.inner, &self.roller].map(|vertices| Outline::new(vertices))
    }
}

impl Reduction {
    /// The modes that a scene asks for [kHz].
    pub(crate) fn khz(scene: &Scene) -> f64 {
        match &scene.model {
            ModelScene::Reduced(reduced) => reduced.modes_khz,
            ModelScene::Full => ReducedScene::default().modes_khz,
        }
    }
}
