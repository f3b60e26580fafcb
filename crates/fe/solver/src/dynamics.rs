//! One step of the time loop, and the properties of the running model.

use crate::{
    damping::{Frame, MassDamping, PLACE_EVERY},
    element::{QuadReference, Stiffness, TriangleReference},
    error::{Error, check, check_count},
    force::Force,
    kernel::{
        advance::{StepParameters, gain},
        fields::{BranchFields, TileFields},
        frames::LaneFrames,
        layout::{Layout, lay_out},
        mass_sums::{LaneSums, MassSums, lane_sums},
        parallel::{TileRuns, sweep_all},
        stiffness_damping::Extrapolated,
        structural_damping::Evaluation,
        sweep::{Scratch, StepEnergies},
        tile::{Tile, TileDamping},
    },
    model::{Model, NodeMotion, check_rate},
    rigid::{RigidBody, RigidMotion, RigidState},
    state::{Accumulated, Moment, NodeForces, State},
    structural_damping::StructuralDamping,
};
use stribeck_simd::{field::Field, lanes::LANES, threads::share_out};

/// Steps from one count of the heat of damping to the next: counting costs as much as damping itself.
const HEAT_EVERY: u64 = 4;

/// Bytes that a thread's second-level cache is taken to hold. Where its part of a step reads less,
/// prefetching gains nothing and costs some per cent.
const SECOND_LEVEL_CACHE: usize = 2 << 20;

/// Nodes or elements that are worth another thread, for sums that are taken now and then.
const LEAST_WORK: usize = 4000;

/// A model in motion.
#[derive(Debug)]
pub struct Dynamics {
    /// State in time.
    pub state: State,
    /// Place and motion of each rigid body, in the order of the mesh.
    pub rigid: Vec<RigidState>,
    /// Work of prescribed motions since the start [J].
    pub drive: Accumulated,
    /// Heat of mass and stiffness damping since the start [J].
    pub heat: Accumulated,
    pub(crate) layout: Layout,
    pub(crate) tiles: Vec<Tile>,
    /// Whether a step reads more than second-level caches hold, so that strips prefetch.
    fetch: bool,
    pub(crate) rigid_bodies: Vec<RigidBody>,
    /// Work of the drive of each rigid body in the last step [J].
    pub(crate) driven: Vec<f64>,
    mass: Field,
    motion: Vec<NodeMotion>,
    elements: Elements,
    pub(crate) forces: NodeForces,
    scratch: Vec<Scratch>,
    /// Energies of each tile in the last step.
    counted: Vec<StepEnergies>,
    pub(crate) time_step: f64,
    pub(crate) gravity: [f64; 2],
    parallel: bool,
    /// β of the stiffness damping [s].
    beta: f64,
    /// Structural damping.
    pub(crate) springs: Option<Springs>,
    pub(crate) damped: Option<Vec<DampedBody>>,
    /// Step at which the damping frames were last placed.
    pub(crate) frames_placed: Option<u64>,
}

/// One damped body: the tiles and lanes that it lies in.
#[derive(Debug, Clone)]
pub(crate) struct DampedBody {
    pub(crate) places: Vec<(usize, usize)>,
}

/// Structural damping of a model in motion.
#[derive(Debug)]
pub(crate) struct Springs {
    pub(crate) damping: StructuralDamping,
    pub(crate) bodies: Vec<DampedBody>,
}

/// All elements in slot numbers, for energies and statics.
#[derive(Debug, Clone)]
pub(crate) struct Elements {
    pub(crate) quads: Vec<([u32; 4], QuadReference)>,
    pub(crate) triangles: Vec<([u32; 3], TriangleReference)>,
    /// Ranges of one body's elastic elements.
    pub(crate) bodies: Vec<ElasticBody>,
}

#[derive(Debug, Clone)]
pub(crate) struct ElasticBody {
    pub(crate) body: usize,
    pub(crate) quads: std::ops::Range<usize>,
    pub(crate) triangles: std::ops::Range<usize>,
    pub(crate) stiffness: Stiffness,
}

impl Dynamics {
    /// Lays the model out for `threads` workers. `loaded` are the nodes that other forces may push.
    ///
    /// # Errors
    /// When the model holds impossible numbers, elements or nodes.
    pub fn new(model: &Model, loaded: &[bool], threads: usize) -> Result<Self, Error> {
        model.check()?;
        let (found, nodes) = (loaded.len(), model.mesh.x.len());
        check_count("number of entries in `loaded`", found, nodes, "one for each node of the mesh")?;
        let (quads, triangles) = model.references()?;
        let masses = model.masses(&quads, &triangles)?;
        let layout = lay_out(model, &quads, &triangles);
        let at_slot = |f: &dyn Fn(usize) -> f64, ghost: f64| -> Field {
            let mut v: Field =
                layout.node_of_slot.iter().map(|n| n.map_or(ghost, |n| f(n as usize))).collect();
            if ghost == 0.0 {
                layout.ghosts.iter().for_each(|(ghosts, _)| v[ghosts.clone()].fill(0.0));
            }
            v
        };
        let mass = at_slot(&|n| masses[n], 0.0);
        let mut state = State {
            x: at_slot(&|n| model.mesh.x[n], f64::NAN),
            y: at_slot(&|n| model.mesh.y[n], f64::NAN),
            vx: Field::zeros(layout.len()),
            vy: Field::zeros(layout.len()),
            ..State::default()
        };
        pad(&layout, &mut state);

        let motion: Vec<NodeMotion> = layout
            .node_of_slot
            .iter()
            .map(|n| n.map_or(NodeMotion::Free, |n| model.motion[n as usize]))
            .collect();
        let is_loaded: Vec<bool> =
            layout.node_of_slot.iter().map(|n| n.is_some_and(|n| loaded[n as usize])).collect();
        let mut tiles = Vec::new();
        let mut rigid = Vec::new();
        for t in &layout.tiles {
            let behaviour = model.behaviour[t.body];
            if !behaviour.is_elastic() {
                rigid.push(RigidBody::new(t.body, behaviour, t.slots.clone(), &state.x, &state.y, &mass));
            }
            let stiffness = model.stiffness(t.body);
            let (moves, pushed) = (&motion[t.slots.clone()], &is_loaded[t.slots.clone()]);
            let mut tile = Tile::new(t, &quads, &triangles, stiffness, moves, pushed);
            if !behaviour.is_elastic() {
                tile.elastic = false;
                tile.finish.clear();
                tile.loaded.clear();
            }
            tiles.push(tile);
        }
        // Tiles lie as it suits the threads.
        rigid.sort_by_key(|(body, _)| body.body);
        let (rigid_bodies, rigid): (Vec<_>, Vec<_>) = rigid.into_iter().unzip();
        let largest = tiles.iter().map(|t| t.slots.len()).max().unwrap_or(0);
        let elements = Elements::new(model, &layout, &quads, &triangles);
        let n = layout.len();
        Ok(Self {
            state,
            driven: vec![0.0; rigid.len()],
            rigid,
            drive: Accumulated::default(),
            heat: Accumulated::default(),
            damped: None,
            frames_placed: None,
            rigid_bodies,
            mass,
            motion,
            elements,
            forces: NodeForces::zeros(n),
            scratch: (0..threads.max(1)).map(|_| Scratch::new(largest)).collect(),
            counted: vec![StepEnergies::default(); tiles.len()],
            fetch: tiles.iter().map(Tile::bytes).sum::<usize>() > SECOND_LEVEL_CACHE * threads.max(1),
            tiles,
            time_step: 0.0,
            gravity: model.gravity,
            parallel: threads > 1,
            beta: 0.0,
            springs: None,
            layout,
        })
    }

    /// Where every node lives.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Mass of each slot [kg]; zero for ghosts and padding.
    pub fn mass(&self) -> &[f64] {
        &self.mass
    }

    /// All elements, in slot numbers.
    pub(crate) fn elements(&self) -> &Elements {
        &self.elements
    }

    pub(crate) fn rigid_bodies(&self) -> &[RigidBody] {
        &self.rigid_bodies
    }

    /// Own slots of elastic bodies, which move by mass and force.
    pub(crate) fn elastic_slots(&self) -> Vec<usize> {
        let tiles = self.tiles.iter().filter(|t| t.elastic);
        tiles.flat_map(|t| t.slots.start..t.slots.start + t.own).filter(|&n| self.mass[n] > 0.0).collect()
    }

    /// Whether (x, y) of a slot answer to forces.
    pub(crate) fn free_components(&self, slot: usize) -> [bool; 2] {
        match self.motion[slot] {
            NodeMotion::Free => [true, true],
            NodeMotion::HeldX => [false, true],
            NodeMotion::HeldY => [true, false],
            NodeMotion::Held | NodeMotion::Rotating { .. } => [false, false],
        }
    }

    /// Upper bound of ω² [rad²/s²] of all rigid bodies whose nodes have at most the stiffness `bound` [N/m].
    pub(crate) fn rigid_frequency_bound(&self, bound: &[f64]) -> f64 {
        let bodies = self.rigid_bodies.iter().zip(&self.rigid);
        bodies.map(|(body, at)| body.frequency_bound(at, &self.state, bound)).fold(0.0, f64::max)
    }

    /// Acceleration of gravity [m/s²].
    pub fn gravity(&self) -> [f64; 2] {
        self.gravity
    }

    /// The time step [s].
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Sets the time step [s].
    pub fn set_time_step(&mut self, dt: f64) -> Result<(), Error> {
        check("time step [s]", dt, dt > 0.0, "positive")?;
        self.time_step = dt;
        self.set_step_over_mass();
        Ok(())
    }

    /// Lets every rotating node turn at `rate` [rad/s], counter-clockwise positive, from the next step on:
    /// the model's rate holds until then. A step turns it by the exact angle `rate` · Δt; to follow an angle
    /// over time, give the mean rate of each step. Restoring a snapshot leaves it as it
    /// is.
    pub fn set_rotation_rate(&mut self, rate: f64) -> Result<(), Error> {
        check_rate(rate)?;
        for finish in self.tiles.iter_mut().flat_map(|tile| &mut tile.finish) {
            if let NodeMotion::Rotating { rate: old, .. } = &mut finish.motion {
                *old = rate;
            }
        }
        Ok(())
    }

    /// Lets every body that turns at a prescribed rate turn at this one, as [`Self::set_rotation_rate`] does
    /// nodes.
    pub fn set_turning_rate(&mut self, rate: f64) -> Result<(), Error> {
        check_rate(rate)?;
        self.rigid_bodies.iter_mut().for_each(|body| body.set_turning_rate(rate));
        Ok(())
    }

    fn set_step_over_mass(&mut self) {
        for tile in &mut self.tiles {
            let push = self.time_step * tile.damping.as_ref().map_or(1.0, |d| gain(d.rate, self.time_step));
            let mass = &self.mass[tile.slots.clone()];
            tile.step_over_mass = mass.iter().map(|&m| if m > 0.0 { push / m } else { 0.0 }).collect();
        }
    }

    /// The moment that forces see.
    pub fn moment(&self) -> Moment<'_> {
        let s = &self.state;
        Moment { step: s.step, time: s.time, dt: self.time_step, x: &s.x, y: &s.y, vx: &s.vx, vy: &s.vy }
    }

    /// One step: everything pushes, every tile sums its elements and moves its nodes (THEORY §2.3).
    ///
    /// With more than one thread, call it from within a pool of that size (`micropool`, whose caller is one
    /// of the threads).
    pub fn step(&mut self, forces: &mut [&mut dyn Force]) {
        let mut pushed = std::mem::take(&mut self.forces);
        for force in forces {
            force.accumulate(self.moment(), &mut pushed);
        }
        self.forces = pushed;
        let since_placed = self.place_damping_frames();
        self.measure_spins();
        self.fill_ghosts();
        self.move_bodies(since_placed);
        self.state.step += 1;
        self.state.time = self.state.step as f64 * self.time_step;
    }

    /// A slot on which a force has acted since the start although nobody announced its node: nothing has read
    /// that force.
    pub fn unread_force(&self) -> Option<usize> {
        let NodeForces { fx, fy } = &self.forces;
        (0..fx.len()).find(|&slot| fx[slot] != 0.0 || fy[slot] != 0.0)
    }

    /// Sets the mass-proportional damping of elastic bodies; replaces an earlier one.
    ///
    /// Frames are placed at the next step and then at every 64th step, counted from the first of the run; a
    /// [`Snapshot`](crate::snapshot::Snapshot) holds them.
    pub fn set_mass_damping(&mut self, damping: &MassDamping) {
        let mut bodies: Vec<(usize, DampedBody)> = Vec::new();
        for (t, (tile, layout)) in self.tiles.iter_mut().zip(&self.layout.tiles).enumerate() {
            let frame = |lane: usize| {
                let body = layout.bodies.get(lane).or(layout.bodies.first());
                body.and_then(|b| damping.frame(*b))
            };
            tile.damping = None;
            // Bodies of one tile are damped together or not at all.
            if !tile.elastic || layout.bodies.iter().any(|b| damping.frame(*b).is_none()) {
                continue;
            }
            let mass = self.mass[tile.slots.clone()].iter().copied().collect();
            let frames = LaneFrames::new(std::array::from_fn(|l| frame(l).unwrap_or(Frame::Rest)));
            tile.damping =
                Some(TileDamping { rate: damping.rate(), frames, mass, sums: LaneSums::default() });
            for lane in 0..LANES {
                let Some(&b) = layout.bodies.get(if layout.congruent { lane } else { 0 }) else { continue };
                let at = bodies.iter().position(|(body, _)| *body == b).unwrap_or_else(|| {
                    bodies.push((b, DampedBody { places: Vec::new() }));
                    bodies.len() - 1
                });
                bodies[at].1.places.push((t, lane));
            }
        }
        self.set_step_over_mass();
        self.frames_placed = None;
        self.damped = (!bodies.is_empty()).then(|| bodies.into_iter().map(|(_, body)| body).collect());
    }

    /// Sets the stiffness-proportional damping of elastic bodies, forces β K v; a mode of the angular
    /// frequency ω has the damping ratio βω/2. It shortens the critical time step (THEORY §2.7).
    ///
    /// # Errors
    /// When `beta` [s] is negative or not finite, or positive beside structural damping.
    pub fn set_stiffness_damping(&mut self, beta: f64) -> Result<(), Error> {
        check("stiffness damping [s]", beta, beta >= 0.0, "zero or positive")?;
        let alone = beta == 0.0 || self.springs.is_none();
        check("stiffness damping [s]", beta, alone, "zero beside structural damping")?;
        self.beta = beta;
        self.make_room_to_see_ahead();
        Ok(())
    }

    /// Memory for where elements see the nodes, if they see them elsewhere.
    pub(crate) fn make_room_to_see_ahead(&mut self) {
        let largest = self.tiles.iter().map(|t| t.slots.len()).max().unwrap_or(0);
        let slots = if self.beta > 0.0 || self.springs.is_some() { largest } else { 0 };
        self.scratch.iter_mut().for_each(|s| s.extrapolated = Extrapolated::new(slots));
    }

    /// Whether elements see nodes elsewhere than where they are, by their velocities.
    pub(crate) fn sees_ahead(&self) -> bool {
        self.beta > 0.0
    }

    /// β of the stiffness damping [s].
    pub fn stiffness_damping(&self) -> f64 {
        self.beta
    }

    /// Places the damping frames now and then; in between the tiles move them on by the time since then [s],
    /// the result.
    fn place_damping_frames(&mut self) -> f64 {
        let Some(damped) = self.damped.take() else { return 0.0 };
        let step = self.state.step;
        let due = |placed: u64| step < placed || step - placed >= PLACE_EVERY;
        let place = step.is_multiple_of(PLACE_EVERY) || self.frames_placed.is_none_or(due);
        let placed = if place { step } else { self.frames_placed.unwrap_or(step) };
        self.frames_placed = Some(placed);
        let mut tiles = std::mem::take(&mut self.tiles);
        if place {
            let add_up = |tile: &mut Tile| {
                if let Some(d) = tile.damping.as_mut().filter(|d| d.frames.follow()) {
                    d.sums = lane_sums(&d.mass, &self.state, tile.slots.clone());
                }
            };
            self.share_out(&mut tiles, &|tile| tile.slots.len(), &add_up);
            for body in &damped {
                let mut sums = MassSums::default();
                for &(tile, lane) in &body.places {
                    tiles[tile].damping.iter().for_each(|d| sums += d.sums[lane]);
                }
                let own = sums.motion();
                for &(tile, lane) in &body.places {
                    if let Some(d) = &mut tiles[tile].damping {
                        d.frames.place(lane, own);
                    }
                }
            }
        }
        (self.tiles, self.damped) = (tiles, Some(damped));
        (step - placed) as f64 * self.time_step
    }

    /// Moves elastic and rigid bodies, and counts what that takes.
    fn move_bodies(&mut self, since_placed: f64) {
        let evaluation = self.evaluation();
        let count_heat = self.state.step.is_multiple_of(HEAT_EVERY);
        let (dt, gravity, beta) = (self.time_step, self.gravity, self.beta);
        let fetch = self.fetch;
        let back = !self.state.step.is_multiple_of(2);
        let parameters = StepParameters { dt, gravity, beta, since_placed, count_heat, fetch, back };
        self.sweep_tiles(parameters, evaluation.as_ref());
        for ((body, at), driven) in self.rigid_bodies.iter().zip(&mut self.rigid).zip(&mut self.driven) {
            *driven = body.advance(at, &mut self.state, &mut self.forces, dt, gravity);
        }
        // In the order of the tiles, whatever thread each was on.
        let StepEnergies { work, heat, held } =
            self.counted.iter().fold(StepEnergies::default(), |sum, &e| sum + e);
        self.drive.add(work);
        self.driven.iter().for_each(|&driven| self.drive.add_to_step(driven));
        if evaluation.is_some() {
            self.state.springs.count(held);
        }
        let before = self.heat.last;
        self.heat.add(if count_heat { heat } else { before });
        if count_heat && before > 0.0 {
            // In between the heat of the last count stood for all; it ran straight from there to here.
            self.heat.total += 0.5 * (HEAT_EVERY - 1) as f64 * (heat - before);
        }
    }

    /// Copies nodes to the ghosts of tiles.
    fn fill_ghosts(&mut self) {
        let ahead = self.sees_ahead();
        let State { x, y, vx, vy, .. } = &mut self.state;
        for field in [x, y].into_iter().chain(ahead.then_some([vx, vy]).into_iter().flatten()) {
            self.layout.copy_to_ghosts(field);
        }
    }

    /// Sums the elements of every tile and moves its nodes.
    fn sweep_tiles(&mut self, parameters: StepParameters, evaluation: Option<&Evaluation>) {
        let State { x, y, vx, vy, springs, .. } = &mut self.state;
        let path = springs.path.as_mut();
        let branches = BranchFields {
            path: path.map(|path| path.each_mut().map(|field| &mut field[..])).unwrap_or_default(),
            held: springs.held.each_mut().map(|field| &mut field[..]),
        };
        let NodeForces { fx, fy } = &mut self.forces;
        let fields = TileFields { x, y, vx, vy, fx, fy, branches };
        let scratch = if self.parallel { self.scratch.as_mut_slice() } else { &mut self.scratch[..1] };
        let runs = TileRuns { tiles: &self.tiles, fields, counted: &mut self.counted, evaluation };
        sweep_all(runs, scratch, parameters);
    }

    /// Shares parts out over the threads that take part, where they are worth it.
    pub(crate) fn share_out<T: Send>(
        &self,
        parts: &mut [T],
        work: &(impl Fn(&T) -> usize + Sync),
        each: &(impl Fn(&mut T) + Sync),
    ) {
        let threads = if self.parallel { self.scratch.len() } else { 1 };
        share_out(parts, threads, LEAST_WORK, work, each);
    }

    /// The rigid part of a body's motion, from the nodes of the given slots.
    pub fn rigid_motion(&self, slots: &[u32]) -> RigidMotion {
        let s = &self.state;
        RigidMotion::of(slots.iter().map(|&n| {
            let n = n as usize;
            (self.mass[n], [s.x[n], s.y[n]], [s.vx[n], s.vy[n]])
        }))
    }

    /// Gives rigid body `at` (in mesh order of rigid bodies) a velocity [m/s] and spin [rad/s] about its
    /// centre; one that turns at a prescribed rate keeps that.
    pub fn launch_rigid(&mut self, at: usize, velocity: [f64; 2], spin: f64) {
        self.rigid[at].velocity = velocity;
        if !self.rigid_bodies[at].turns() {
            self.rigid[at].spin = spin;
        }
    }

    /// Puts every body that turns at a prescribed rate where its nodes have been moved to.
    #[cfg(feature = "statics")]
    pub(crate) fn follow_nodes(&mut self) {
        for (body, at) in self.rigid_bodies.iter().zip(&mut self.rigid).filter(|(body, _)| body.turns()) {
            body.follow_nodes(at, &self.state);
        }
    }

    /// Mesh body number of each rigid body.
    pub fn rigid_body_numbers(&self) -> impl Iterator<Item = usize> {
        self.rigid_bodies.iter().map(|r| r.body)
    }
}

/// Padding copies its neighbour's place, so that elements of padding lanes rest.
fn pad(layout: &Layout, state: &mut State) {
    for slot in 1..layout.len() {
        if layout.node_of_slot[slot].is_none() {
            state.x[slot] = state.x[slot - 1];
            state.y[slot] = state.y[slot - 1];
        }
    }
}

impl Elements {
    fn new(model: &Model, layout: &Layout, quads: &[QuadReference], triangles: &[TriangleReference]) -> Self {
        let slot = |n: u32| layout.slot_of_node[n as usize];
        let elastic = |b: &usize| model.behaviour[*b].is_elastic();
        Self {
            quads: model.mesh.quads.iter().zip(quads).map(|(c, r)| (c.map(slot), *r)).collect(),
            triangles: model.mesh.triangles.iter().zip(triangles).map(|(c, r)| (c.map(slot), *r)).collect(),
            bodies: (0..model.mesh.bodies.len())
                .filter(elastic)
                .map(|b| ElasticBody {
                    body: b,
                    quads: model.mesh.bodies[b].quads.clone(),
                    triangles: model.mesh.bodies[b].triangles.clone(),
                    stiffness: model.stiffness(b),
                })
                .collect(),
        }
    }
}
