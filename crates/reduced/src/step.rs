//! One step of the reduced bearing, and many of them in the instruction set of the processor (THEORY §9.4).
//!
//! Rollers are taken eight at a time: what is the same for all of them is done in vectors, what hangs on which facets they are at one
//! roller after the other.

use pulp::{Arch, Simd, WithSimd};
use stribeck_modal::parameters::DampingFrame;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{
    bearing::Bearing,
    rollers::block::Block,
    roller_force::RollerForce,
    modes::Modes,
    oil::FilmStep,
    contact::penetration::Penetration,
    cage::pocket::PlacedCage,
    contact::force::Rolling,
    rollers::row::{Row, load, of_one, store},
    sensors::SensorMotion,
    state::{Spent, State, Stored, count},
};

/// Room for what a step computes, and sums over the steps of a sample.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    /// The rollers during some steps.
    pub(crate) blocks: Vec<Block>,
    /// Overlaps of eight contacts, each by parts.
    pub(crate) parts: [Penetration<Row>; LANES],
    /// The modes during a step.
    pub(crate) modes: Modes,
    /// Steps in the sums of the blocks.
    pub(crate) summed: usize,
    /// Normal forces on the outer raceway [N], and where they are.
    pub(crate) roller_forces: Vec<RollerForce>,
    /// What sensors measure before the last step of a sample and after it.
    pub(crate) before: SensorMotion,
    pub(crate) now: SensorMotion,
    /// Energies at the positions of the last step, when it was asked for.
    pub(crate) energy: Stored,
    /// Deepest penetration since the start of the sample [m].
    pub(crate) deepest: f64,
}

impl Scratch {
    pub(crate) fn new(bearing: &Bearing) -> Self {
        let n = bearing.rollers;
        Self {
            blocks: (0..n).step_by(LANES).map(|first| Block::new(bearing, first)).collect(),
            modes: Modes::new(bearing),
            roller_forces: vec![RollerForce::default(); n],
            ..Self::default()
        }
    }

    /// Takes the rollers from a state, before the first step here.
    pub(crate) fn load(&mut self, state: &State) {
        self.blocks.iter_mut().for_each(|block| block.load(state));
        if let Some(hold) = &state.seat {
            self.roller_forces.clone_from(&hold.pressed);
        }
    }

    /// Begins a sample, the number of which is known.
    pub(crate) fn begin(&mut self, bearing: &Bearing, sample: u64) {
        let anew = (sample % bearing.rollers as u64) as usize;
        self.blocks.iter_mut().for_each(|block| block.begin(bearing, anew));
        (self.summed, self.deepest) = (0, 0.0);
    }

    /// Shows the state what is sampled and looked at.
    pub(crate) fn show(&self, state: &mut State) {
        self.blocks.iter().for_each(|block| block.show(state));
    }

    /// Leaves the rollers to a state.
    pub(crate) fn store(&self, state: &mut State) {
        self.blocks.iter().for_each(|block| block.store(state));
        if let Some(hold) = &mut state.seat {
            hold.pressed.clone_from(&self.roller_forces);
        }
    }
}

/// Some steps; `last` ones leave their energies.
struct Interval<'a> {
    bearing: &'a Bearing,
    state: &'a mut State,
    scratch: &'a mut Scratch,
    steps: usize,
    last: bool,
}

impl WithSimd for Interval<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for _ in 0..self.steps {
            self.bearing.step(simd, self.state, self.scratch, self.last);
        }
        if self.last {
            let Scratch { roller_forces, modes, now, .. } = self.scratch;
            self.bearing.sensors.measure(simd, self.state, roller_forces, &modes.tension, now);
        }
    }
}

impl Bearing {
    /// Takes `steps` steps; `last` ones leave their energies in `scratch`.
    pub(crate) fn advance(&self, state: &mut State, scratch: &mut Scratch, steps: usize, last: bool) {
        Arch::new().dispatch(Interval { bearing: self, state, scratch, steps, last });
    }

    /// One step: forces at the positions, then velocities, then positions (THEORY §2.3).
    #[inline(always)]
    fn step<S: Simd>(&self, simd: S, state: &mut State, scratch: &mut Scratch, last: bool) {
        let dt = self.time_step;
        let mut energy = Stored::default();
        scratch.modes.begin(state, &self.reduction.constant);
        let (mut rate, mut outer_rate) = (self.speeds.shaft, self.speeds.outer);
        let mut outer_angle = outer_rate * dt * state.steps as f64;
        let mut further = [0.0; 2];
        if let Some(duty) = &self.duty {
            let now = state.steps as f64 * dt;
            rate = duty.mean_shaft_rad_s(now, now + dt);
            if self.outer_turns {
                (outer_rate, outer_angle) = (duty.mean_outer_rad_s(now, now + dt), duty.outer_rad(now));
            }
            further = self.load_change(duty, now);
            for (share, load) in self.loads(further) {
                let push = scratch.modes.push.iter_mut().flat_map(|row| row.iter_mut());
                push.zip(load).for_each(|(push, load)| *push += share * load);
            }
        }
        if !self.dampers.is_empty() {
            self.resist(simd, &mut scratch.modes);
        }
        if last {
            self.sensors.measure(simd, state, &scratch.roller_forces, &scratch.modes.tension, &mut scratch.before);
        }
        let inner = RingRotation { rate, turned: turned(state.shaft) };
        let outer = self.outer_turns.then(|| RingRotation { rate: outer_rate, turned: turned(outer_angle) });
        for block in &mut scratch.blocks {
            self.follow_facets(simd, block, outer);
            // A roller presses where it is now: what the seat gives way by hangs on that, and work on both.
            let roller_forces = &mut scratch.roller_forces[block.first..block.first + block.count];
            for ((roller_forces, facet), share) in roller_forces.iter_mut().zip(&block.facet).zip(block.share.iter()) {
                (roller_forces.facet, roller_forces.share) = (*facet, *share);
            }
        }
        let mut spent = Spent::default();
        if let (Some(seat), Some(hold)) = (&self.seat, &mut state.seat) {
            let Modes { push, tension, responses, .. } = &mut scratch.modes;
            let [heat, stored] =
                seat.respond(simd, hold, &state.q, &scratch.roller_forces, responses, [push, tension], last);
            spent.heat[0] += 2.0 * heat / dt;
            energy.strain += stored;
        }
        let (cs, cc) = state.cage[2].sin_cos();
        let placed =
            PlacedCage { at: [state.cage[0], state.cage[1]], turn: [cc, cs], velocity: state.cage_velocity };
        let middle = self.reduction.cage.map_or([0.0; 2], |cage| cage.1);
        let mut on_cage = [0.0; 3];
        let mut sums = Sums::<S>::new(simd);
        let farthest = self.farthest(simd, &scratch.modes, state.seat.as_ref());

        for (b, block) in scratch.blocks.iter_mut().enumerate() {
            let hold = state.seat.as_ref();
            self.locate_on_raceways(simd, &scratch.modes, hold, farthest, block, [outer, Some(inner)]);
            let Block { first, top, bits, contacts, .. } = block;
            // One code for both raceways: the step's instructions fill the first cache anyway.
            for (raceway, contacts) in [&self.outer, &self.inner].into_iter().zip(contacts) {
                self.normal_forces(simd, raceway, *first, top, *bits, contacts, &mut scratch.parts);
            }
            self.push_rollers(simd, block, outer, inner, &mut sums);
            let mut by_film = [[0.0; LANES]; 2];
            if let (Some(oil), Some(films)) = (&self.oil, &mut state.films) {
                let now = FilmStep { step: state.steps, dt, last, felt: self.seat.is_some() };
                let by_oil = self.add_film_forces(oil, films, block, [outer, Some(inner)], now);
                by_film = [by_oil.normal, by_oil.stiffness];
                energy.contact += by_oil.stored;
                for (turning, moment) in [outer, Some(inner)].into_iter().zip(by_oil.drive) {
                    spent.drive += turning.map_or(0.0, |turning| dt * turning.rate * moment);
                }
            }
            for lane in 0..block.count {
                let (facet, share) = (block.facet[lane], block.share[lane]);
                let force = of_one(&block.force[0], lane);
                if force != [0.0; 2] {
                    self.press(simd, &self.raceway_point(facet as usize, share), force, &mut scratch.modes);
                }
                let force = block.contacts[0].normal[lane] + by_film[0][lane];
                let roller_forces = &mut scratch.roller_forces[block.first + lane];
                let stiffness = block.contacts[0].stiffness(self.penalty, lane) + by_film[1][lane];
                *roller_forces = RollerForce { growth: force - roller_forces.force, force, stiffness, ..*roller_forces };
            }
            for (raceway, contacts) in [&self.outer, &self.inner].into_iter().zip(&block.contacts) {
                scratch.deepest = scratch.deepest.max(Self::deepest(contacts));
                if last {
                    self.stored_in_contacts(raceway, contacts, &mut energy);
                }
            }
            block.force[2] = Default::default();
            if let Some(cage) = &self.cage {
                let rows = &cage.wall_rows[b];
                let by_walls =
                    self.in_pockets(simd, cage, rows, placed, middle, block, &mut spent.heat, &mut energy);
                for (sum, part) in on_cage.iter_mut().zip(by_walls) {
                    *sum += part;
                }
            }
            match self.frame {
                DampingFrame::Rolling => self.move_rollers::<S, ROLLING>(simd, block, last, &mut sums),
                DampingFrame::RigidMotion => self.move_rollers::<S, RIGID>(simd, block, last, &mut sums),
                DampingFrame::Absolute => self.move_rollers::<S, ABSOLUTE>(simd, block, last, &mut sums),
            }
        }
        scratch.summed += 1;
        spent.heat = [spent.heat[0] + sums.heat[0].sum(), spent.heat[1] + sums.heat[1].sum()];
        let [by_outer, by_inner] = sums.drive;
        spent.drive += dt * rate * by_inner.sum();
        if let Some(outer) = outer {
            spent.drive += dt * outer.rate * by_outer.sum();
        }
        spent.external += sums.external.sum();
        spent.damped += sums.damped.sum();
        energy.kinetic += 0.5 * sums.kinetic.sum();

        self.move_modes(simd, state, &scratch.modes, further, last, &mut energy, &mut spent);

        if let Some(cage) = &self.cage {
            let old = state.cage_velocity;
            let acceleration =
                [on_cage[0] / cage.mass, on_cage[1] / cage.mass - self.gravity, on_cage[2] / cage.inertia];
            let new: [f64; 3] = std::array::from_fn(|c| old[c] + dt * acceleration[c]);
            spent.external -= 0.5 * dt * self.gravity * cage.mass * (old[1] + new[1]);
            if last {
                energy.kinetic +=
                    0.5 * (cage.mass * (old[0] * new[0] + old[1] * new[1]) + cage.inertia * old[2] * new[2]);
            }
            state.cage_velocity = new;
            for (place, v) in state.cage.iter_mut().zip(new) {
                *place += dt * v;
            }
        }
        state.shaft += dt * rate;
        let work = &mut state.work;
        work.friction += 0.5 * dt * spent.heat[0];
        work.contact_damping += 0.5 * dt * spent.heat[1];
        count(&mut work.external, spent.external);
        count(&mut work.drive, spent.drive);
        count(&mut work.damping, spent.damped);
        state.steps += 1;
        if last {
            scratch.energy = energy;
        }
    }

    /// What both raceways do to rollers.
    #[inline(always)]
    fn push_rollers<S: Simd>(
        &self,
        simd: S,
        block: &mut Block,
        outer: Option<RingRotation>,
        inner: RingRotation,
        sums: &mut Sums<S>,
    ) {
        let all = |value: f64| Vector::all(simd, value);
        let (arm, rate) = (all(self.arm), all(inner.rate));
        let size = |number: Vector<S>| number.max(-number);
        let [on_outer, on_inner] = &mut block.contacts;
        for at in vector_starts(simd) {
            let distance = Vector::load(simd, &block.distance, at);
            let (centre, radial) = (load(simd, &block.centre, at), load(simd, &block.radial, at));
            let (velocity, spin) = (load(simd, &block.velocity, at), Vector::load(simd, &block.spin, at));
            let (moving, tilt) = (load(simd, &block.moving, at), load(simd, &block.tilt, at));
            // The raceway under the roller moves with the modes, and because the roller goes on to another place of it.
            let orbit = velocity[1].times_plus(radial[0], -(velocity[0] * radial[1])) / distance;
            let mut relative =
                [velocity[0] - moving[0] - orbit * tilt[0], velocity[1] - moving[1] - orbit * tilt[1]];
            let mut race = all(0.0);
            if let Some(outer) = outer {
                // It turns about its own centre, which the load has moved: drive and friction see the same velocity of it.
                race = all(outer.rate);
                let along = race * (Vector::load(simd, &on_outer.distance, at) + arm);
                let (d, [rx, ry]) = (load(simd, &on_outer.d, at), outer.back(simd, relative));
                relative = [along.times_plus(d[1], rx), ry - along * d[0]];
            }
            let pace = size(orbit - race) * (distance + arm);
            let rolling = Rolling { relative, spin, race, pace };
            let by_outer = self.push(simd, &self.outer, on_outer, at, &rolling, &mut sums.heat);
            let mut force = by_outer.force;
            if let Some(outer) = outer {
                force = outer.forth(simd, force);
                let by = load(simd, &block.by, at);
                let [x, y] = [centre[0] - by[0], centre[1] - by[1]];
                sums.drive[0] = sums.drive[0] + x * force[1] - y * force[0] + by_outer.moment;
            }
            let [fx, fy] = force;
            store(force, &mut block.force[0], at);
            // Along its path the roller meets the raceway displaced more or less: it goes downhill (THEORY §9.3).
            let downhill = -(fx.times_plus(tilt[0], fy * tilt[1]) / distance);
            let uphill = [-(downhill * radial[1]), downhill * radial[0]];
            store(uphill, &mut block.downhill, at);

            // Where the inner raceway is touched, it moves across the radius.
            let along = rate * (distance - arm);
            let [rx, ry] = [along.times_plus(radial[1], velocity[0]), velocity[1] - along * radial[0]];
            let relative = inner.back(simd, [rx, ry]);
            let pace = size((orbit - rate) * (distance - arm));
            let rolling = Rolling { relative, spin, race: rate, pace };
            let by_inner = self.push(simd, &self.inner, on_inner, at, &rolling, &mut sums.heat);
            let [fx, fy] = inner.forth(simd, by_inner.force);
            store([fx, fy], &mut block.force[1], at);
            // What the roller does to the ring, the drive makes good.
            sums.drive[1] = sums.drive[1] + centre[0] * fy - centre[1] * fx + by_inner.moment;
            (by_outer.moment + by_inner.moment).store(&mut block.moment, at);
        }
    }

    /// Rollers move under the forces on them.
    #[inline(always)]
    fn move_rollers<S: Simd, const FRAME: u8>(
        &self,
        simd: S,
        block: &mut Block,
        last: bool,
        sums: &mut Sums<S>,
    ) {
        let all = |value: f64| Vector::all(simd, value);
        let [mass, inertia] = self.reduction.roller_inertia;
        let (dt, half) = (all(self.time_step), all(0.5));
        let h = 0.5 * self.alpha * self.time_step;
        let (kept, gain) = (all((1.0 - h) / (1.0 + h)), all(self.time_step / (1.0 + h)));
        let resisted = all(self.alpha * self.time_step * mass);
        let weight = all(self.gravity * mass);
        for at in vector_starts(simd) {
            let present = Vector::load(simd, &block.present, at);
            let mut force = load(simd, &block.downhill, at);
            force[1] = force[1] - present * weight;
            for (by, sum) in block.force.iter().zip(&mut block.sums) {
                let by = load(simd, by, at);
                let [x, y] = load(simd, sum, at);
                store([x + by[0], y + by[1]], sum, at);
                force = [force[0] + by[0], force[1] + by[1]];
            }
            let per_mass = all(1.0 / mass);
            let a = [force[0] * per_mass, force[1] * per_mass];
            let turn = Vector::load(simd, &block.moment, at) * all(1.0 / inertia);
            let [vx, vy] = load(simd, &block.velocity, at);
            let spin = Vector::load(simd, &block.spin, at);
            let mut new = [dt.times_plus(a[0], vx), dt.times_plus(a[1], vy), dt.times_plus(turn, spin)];
            if FRAME == ROLLING {
                let [rx, ry] = load(simd, &block.radial, at);
                let (v, pull) = (vx.times_plus(rx, vy * ry), a[0].times_plus(rx, a[1] * ry));
                let slowed = kept.times_plus(v, gain * pull);
                let change = slowed - v - dt * pull;
                let mean = half * (slowed + v);
                sums.damped = (resisted * mean).times_plus(mean, sums.damped);
                new = [change.times_plus(rx, new[0]), change.times_plus(ry, new[1]), new[2]];
            }
            if FRAME == ABSOLUTE {
                new = [
                    kept.times_plus(vx, gain * a[0]),
                    kept.times_plus(vy, gain * a[1]),
                    kept.times_plus(spin, gain * turn),
                ];
                let [mx, my, turning] = [half * (vx + new[0]), half * (vy + new[1]), half * (spin + new[2])];
                let square = mx.times_plus(mx, my.times_plus(my, all(inertia / mass) * turning * turning));
                sums.damped = resisted.times_plus(square, sums.damped);
            }
            sums.external = sums.external - present * half * dt * weight * (vy + new[1]);
            if last {
                let along = vx.times_plus(new[0], vy * new[1]);
                sums.kinetic =
                    all(mass).times_plus(along, (all(inertia) * spin).times_plus(new[2], sums.kinetic));
            }
            let [x, y] = load(simd, &block.centre, at);
            store([dt.times_plus(new[0], x), dt.times_plus(new[1], y)], &mut block.centre, at);
            store([new[0], new[1]], &mut block.velocity, at);
            new[2].store(&mut block.spin, at);
            let by = dt * new[2];
            (Vector::load(simd, &block.angle, at) + by).store(&mut block.angle, at);
            store(turn_by(load(simd, &block.turned, at), by), &mut block.turned, at);
        }
    }
}

/// A ring that turns.
#[derive(Clone, Copy)]
pub(crate) struct RingRotation {
    /// How fast [rad/s].
    pub(crate) rate: f64,
    /// Cosine and sine of the angle by which it has turned.
    pub(crate) turned: [f64; 2],
}

impl RingRotation {
    /// Not at all.
    pub(crate) const STILL: Self = Self { rate: 0.0, turned: [1.0, 0.0] };

    /// A vector in the frame of the ring.
    #[inline(always)]
    pub(crate) fn back<S: Simd>(self, simd: S, [x, y]: [Vector<S>; 2]) -> [Vector<S>; 2] {
        let [c, s] = [Vector::all(simd, self.turned[0]), Vector::all(simd, self.turned[1])];
        [c.times_plus(x, s * y), c.times_plus(y, -(s * x))]
    }

    /// A vector that is given in the frame of the ring.
    #[inline(always)]
    fn forth<S: Simd>(self, simd: S, [x, y]: [Vector<S>; 2]) -> [Vector<S>; 2] {
        let [c, s] = [Vector::all(simd, self.turned[0]), Vector::all(simd, self.turned[1])];
        [c.times_plus(x, -(s * y)), s.times_plus(x, c * y)]
    }
}

/// Cosine and sine of an angle.
#[inline(always)]
fn turned(angle: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c, s]
}

/// The frames of mass damping, for code that is made for each of them.
const ROLLING: u8 = 0;
const RIGID: u8 = 1;
const ABSOLUTE: u8 = 2;

/// Sums over all rollers in one step, as [`Spent`] and [`Stored`] say.
struct Sums<S: Simd> {
    heat: [Vector<S>; 2],
    /// Moments on the drives of outer and inner ring [N m].
    drive: [Vector<S>; 2],
    external: Vector<S>,
    damped: Vector<S>,
    /// Twice the energy.
    kinetic: Vector<S>,
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let zero = Vector::all(simd, 0.0);
        Self { heat: [zero; 2], drive: [zero; 2], external: zero, damped: zero, kinetic: zero }
    }
}

/// Directions turned by small angles.
#[inline(always)]
fn turn_by<S: Simd>([x, y]: [Vector<S>; 2], angle: Vector<S>) -> [Vector<S>; 2] {
    let of = |value: f64| angle.constant(value);
    let square = angle * angle;
    let s = angle * (of(1.0) - square * of(1.0 / 6.0) * (of(1.0) - square * of(1.0 / 20.0)));
    let c = of(1.0) - of(0.5) * square * (of(1.0) - square * of(1.0 / 12.0));
    [c.times_plus(x, -(s * y)), s.times_plus(x, c * y)]
}
