//! One step of the reduced bearing, and many of them in the instruction set of the processor (THEORY §9.4).

use pulp::{Arch, Simd, WithSimd};
use stribeck_scene::scene::DampingFrame;

use crate::{
    bearing::{Bearing, Track},
    modes::Moved,
    pocket::PlacedCage,
    state::{Spent, State, Stored, count},
    touch::{Begun, Near, Sought, Touch},
};

/// Room for what a step computes, and sums over the steps of a sample.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    /// Directions of vertex 0 of each roller.
    turned: Vec<[f64; 2]>,
    seats: Vec<Seat>,
    sought: Sought,
    /// Forces on the modes.
    push: Vec<f64>,
    /// Forces on each roller by outer raceway, inner raceway and cage, in this step [N].
    pub(crate) on_roller: Vec<[[f64; 2]; 3]>,
    /// The same, summed over the steps since the last sample.
    pub(crate) sums: Vec<[[f64; 2]; 3]>,
    /// Steps in the sums.
    pub(crate) summed: usize,
    /// Normal forces on the outer raceway in the step before [N], and where they were.
    pub(crate) before: Vec<Heard>,
    pub(crate) heard: Vec<Heard>,
    /// Energies at the positions of the last step, when it was asked for.
    pub(crate) energy: Stored,
    /// Deepest penetration since the start of the sample [m].
    pub(crate) deepest: f64,
}

/// Where a roller is in this step.
#[derive(Debug, Clone, Copy, Default)]
struct Seat {
    /// From the bearing's centre [m], and the direction there.
    distance: f64,
    radial: [f64; 2],
    /// The place on the outer raceway, and how that moves.
    facet: usize,
    share: f64,
    moved: Moved,
    outer: Begun,
    inner: Begun,
}

/// A force that sensors hear beyond the modes: its facet, the share of the facet's second vertex, and how large it is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Heard {
    pub(crate) facet: u32,
    pub(crate) share: f64,
    pub(crate) force: f64,
}

impl Scratch {
    pub(crate) fn new(bearing: &Bearing, state: &State) -> Self {
        let (n, r) = (bearing.rollers, bearing.reduction.padded);
        let mut scratch = Self {
            turned: vec![[1.0, 0.0]; n],
            seats: vec![Seat::default(); n],
            sought: Sought::new(2 * n),
            push: vec![0.0; r],
            on_roller: vec![[[0.0; 2]; 3]; n],
            sums: vec![[[0.0; 2]; 3]; n],
            before: vec![Heard::default(); n],
            heard: vec![Heard::default(); n],
            ..Self::default()
        };
        scratch.begin(bearing, state);
        scratch
    }

    /// Begins a sample: directions are taken from the angles again, because turning them step by step rounds.
    pub(crate) fn begin(&mut self, bearing: &Bearing, state: &State) {
        for ((turned, angle), first) in self.turned.iter_mut().zip(&state.angle).zip(&bearing.vertex_angle) {
            let (s, c) = (angle + first).sin_cos();
            *turned = [c, s];
        }
        self.sums.iter_mut().for_each(|sum| *sum = [[0.0; 2]; 3]);
        (self.summed, self.deepest) = (0, 0.0);
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
        let [roller_mass, roller_inertia] = self.reduction.roller_inertia;
        let mut energy = Stored::default();
        scratch.push.copy_from_slice(&self.reduction.constant);
        let mut rate = self.kinematics.shaft_rad_s;
        let mut further = 0.0;
        if let Some(duty) = &self.duty {
            let now = state.steps as f64 * dt;
            rate = duty.mean_shaft_rad_s(now, now + dt);
            further = self.beside_the_preload(duty.load_n(now));
            for (push, load) in scratch.push.iter_mut().zip(&self.reduction.load.0) {
                *push += further * load;
            }
        }
        if last {
            scratch.before.copy_from_slice(&scratch.heard);
        }
        let (cs, cc) = state.cage[2].sin_cos();
        let mut on_cage = [0.0; 3];
        let mut work = state.work;
        let shaft = state.shaft.sin_cos();
        let mut spent = Spent::default();
        let middle = self.reduction.cage.map_or([0.0; 2], |cage| cage.1);
        let placed =
            PlacedCage { at: [state.cage[0], state.cage[1]], turn: [cc, cs], velocity: state.cage_velocity };
        let (ss, sc) = shaft;
        // The inner raceway turns about the origin: everything is turned back.
        let back = |v: [f64; 2]| [sc * v[0] + ss * v[1], sc * v[1] - ss * v[0]];

        // Where rollers are, and what overlaps there.
        scratch.sought.clear();
        for i in 0..self.rollers {
            let centre = [state.x[i], state.y[i]];
            let distance = (centre[0] * centre[0] + centre[1] * centre[1]).sqrt();
            let radial = [centre[0] / distance, centre[1] / distance];
            // The outer raceway has moved with the modes.
            let place = self.place_along(radial, state.hints[0][i][1]);
            let moved = self.moved(simd, &place, state);
            state.hints[0][i][1] = place.facet as u32;
            let Seat { outer, inner, .. } = &mut scratch.seats[i];
            let near = self.at_outer(state, i, moved.by, scratch.turned[i]);
            *outer = self.begin(simd, near, &mut state.hints[0][i], &mut scratch.sought);
            let near = self.at_inner(state, i, back(centre), back(scratch.turned[i]));
            *inner = self.begin(simd, near, &mut state.hints[1][i], &mut scratch.sought);
            let seat = &mut scratch.seats[i];
            (seat.distance, seat.radial, seat.moved) = (distance, radial, moved);
            (seat.facet, seat.share) = (place.facet, place.share);
        }
        scratch.sought.solve(simd, self.penalty);

        // What presses on each of them, and how it moves.
        for i in 0..self.rollers {
            let centre = [state.x[i], state.y[i]];
            let velocity = [state.vx[i], state.vy[i]];
            let omega = state.spin[i];
            let turned = scratch.turned[i];
            let Seat { distance, radial, facet, share, moved, outer, inner } = scratch.seats[i];
            let Moved { velocity: moving, tilt, .. } = moved;
            let near = self.at_outer(state, i, moved.by, turned);
            let touch = self.end(simd, near, &outer, &mut state.hints[0][i], &scratch.sought);
            state.felt(0, i, touch.normal);
            let mut force = [0.0, -self.gravity * roller_mass];
            let mut moment = 0.0;
            // The raceway under the roller moves with the modes, and because the roller goes on to another place of it.
            let orbit = (velocity[1] * radial[0] - velocity[0] * radial[1]) / distance;
            let relative =
                [velocity[0] - moving[0] - orbit * tilt[0], velocity[1] - moving[1] - orbit * tilt[1]];
            let rolled = Rolled { omega, race: 0.0, pace: orbit.abs() * (distance + self.arm) };
            let pushed = self.push(
                &self.outer,
                &touch,
                relative,
                rolled,
                &mut state.slip[0][i],
                &mut state.passive[0][i],
                &mut spent.heat,
                last,
                &mut energy,
            );
            let [fx, fy] = pushed.force;
            if pushed.force != [0.0; 2] {
                self.press(simd, &self.place(facet, share), pushed.force, &mut scratch.push);
            }
            scratch.on_roller[i][0] = pushed.force;
            scratch.heard[i] = Heard { facet: facet as u32, share, force: touch.normal };
            scratch.deepest = scratch.deepest.max(touch.overlap.deepest);
            // Along its path the roller meets the raceway displaced more or less: it goes downhill (THEORY §9.3).
            let downhill = -(fx * tilt[0] + fy * tilt[1]) / distance;
            let [ex, ey] = [fx - downhill * radial[1], fy + downhill * radial[0]];
            force = [force[0] + ex, force[1] + ey];
            moment += pushed.moment;

            let near = self.at_inner(state, i, back(centre), back(turned));
            let touch = self.end(simd, near, &inner, &mut state.hints[1][i], &scratch.sought);
            state.felt(1, i, touch.normal);
            let mut on_inner = [0.0; 2];
            if touch.normal > 0.0 || state.passive[1][i] != [0.0; 3] {
                // Where the raceway is touched, it moves across the radius.
                let along = rate * (distance - self.arm);
                let race = [-along * radial[1], along * radial[0]];
                let relative = back([velocity[0] - race[0], velocity[1] - race[1]]);
                let rolled =
                    Rolled { omega, race: rate, pace: ((orbit - rate) * (distance - self.arm)).abs() };
                let pushed = self.push(
                    &self.inner,
                    &touch,
                    relative,
                    rolled,
                    &mut state.slip[1][i],
                    &mut state.passive[1][i],
                    &mut spent.heat,
                    last,
                    &mut energy,
                );
                let [fx, fy] = pushed.force;
                on_inner = [sc * fx - ss * fy, ss * fx + sc * fy];
                force = [force[0] + on_inner[0], force[1] + on_inner[1]];
                moment += pushed.moment;
                // What the roller does to the ring, the drive makes good.
                spent.drive +=
                    dt * rate * (centre[0] * on_inner[1] - centre[1] * on_inner[0] + pushed.moment);
                scratch.deepest = scratch.deepest.max(touch.overlap.deepest);
            } else {
                (state.slip[1][i], state.passive[1][i]) = (0.0, [0.0; 3]);
            }
            scratch.on_roller[i][1] = on_inner;

            // The walls of its pocket.
            let mut by_cage = [0.0; 2];
            if let Some(cage) = &self.cage {
                let guest = placed.guest(middle, centre, velocity, omega, turned);
                for side in 0..2 {
                    let (slip, passive) = (&mut state.wall_slip[i][side], &mut state.wall_passive[i][side]);
                    let wall = &cage.walls[i][side];
                    let hit =
                        self.hit(cage, wall, placed, &guest, slip, passive, &mut spent.heat, &mut energy);
                    let Some(hit) = hit else { continue };
                    by_cage = [by_cage[0] + hit.force[0], by_cage[1] + hit.force[1]];
                    moment += hit.moment;
                    on_cage[0] -= hit.force[0];
                    on_cage[1] -= hit.force[1];
                    on_cage[2] -= hit.on_cage;
                }
            }
            scratch.on_roller[i][2] = by_cage;
            force = [force[0] + by_cage[0], force[1] + by_cage[1]];
            for (sum, now) in scratch.sums[i].iter_mut().zip(&scratch.on_roller[i]) {
                *sum = [sum[0] + now[0], sum[1] + now[1]];
            }

            // The roller moves.
            let a = [force[0] / roller_mass, force[1] / roller_mass];
            let h = 0.5 * self.alpha * dt;
            let kept = (1.0 - h) / (1.0 + h);
            let gain = dt / (1.0 + h);
            let old = [velocity[0], velocity[1], omega];
            let turn = moment / roller_inertia;
            let new = match self.frame {
                DampingFrame::Rolling => {
                    let along = |v: [f64; 2]| v[0] * radial[0] + v[1] * radial[1];
                    let (v, a_along) = (along(velocity), along(a));
                    let change = kept * v + gain * a_along - v - dt * a_along;
                    let mean = v + 0.5 * (kept * v + gain * a_along - v);
                    spent.damped += self.alpha * dt * roller_mass * mean * mean;
                    [
                        velocity[0] + dt * a[0] + change * radial[0],
                        velocity[1] + dt * a[1] + change * radial[1],
                        omega + dt * turn,
                    ]
                }
                DampingFrame::RigidMotion => {
                    [velocity[0] + dt * a[0], velocity[1] + dt * a[1], omega + dt * turn]
                }
                DampingFrame::Absolute => {
                    let new = [
                        kept * velocity[0] + gain * a[0],
                        kept * velocity[1] + gain * a[1],
                        kept * omega + gain * turn,
                    ];
                    let mean: [f64; 3] = std::array::from_fn(|c| 0.5 * (old[c] + new[c]));
                    spent.damped += self.alpha
                        * dt
                        * (roller_mass * (mean[0] * mean[0] + mean[1] * mean[1])
                            + roller_inertia * mean[2] * mean[2]);
                    new
                }
            };
            spent.external -= 0.5 * dt * self.gravity * roller_mass * (old[1] + new[1]);
            if last {
                energy.kinetic += 0.5
                    * (roller_mass * (old[0] * new[0] + old[1] * new[1]) + roller_inertia * old[2] * new[2]);
            }
            (state.vx[i], state.vy[i], state.spin[i]) = (new[0], new[1], new[2]);
            state.x[i] += dt * new[0];
            state.y[i] += dt * new[1];
            let by = dt * new[2];
            state.angle[i] += by;
            scratch.turned[i] = turn_by(turned, by);
        }
        scratch.summed += 1;

        self.move_modes(simd, state, &scratch.push, further, last, &mut energy, &mut spent);

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
        work.friction += 0.5 * dt * spent.heat[0];
        work.contact_damping += 0.5 * dt * spent.heat[1];
        count(&mut work.external, spent.external);
        count(&mut work.drive, spent.drive);
        count(&mut work.damping, spent.damped);
        state.work = work;
        state.steps += 1;
        if last {
            scratch.energy = energy;
        }
    }

    /// A roller by the outer raceway, which has moved.
    #[inline(always)]
    fn at_outer(&self, state: &State, i: usize, [x, y]: [f64; 2], spin: [f64; 2]) -> Near<'_> {
        let centre = [state.x[i] - x, state.y[i] - y];
        Near { track: &self.outer, rim: self.rim(i), centre, spin, before: state.foreseen(0, i) }
    }

    /// A roller by the inner raceway, seen from there.
    #[inline(always)]
    fn at_inner(&self, state: &State, i: usize, centre: [f64; 2], spin: [f64; 2]) -> Near<'_> {
        Near { track: &self.inner, rim: self.rim(i), centre, spin, before: state.foreseen(1, i) }
    }

    /// What a raceway does to a roller, in the frame in which it was touched. `relative` is the velocity of the roller's
    /// centre less that of the raceway.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one contact, with all that it reads and adds to")]
    fn push(
        &self,
        track: &Track,
        touch: &Touch,
        relative: [f64; 2],
        rolled: Rolled,
        slip: &mut f64,
        passive: &mut [f64; 3],
        heat: &mut [f64; 2],
        last: bool,
        energy: &mut Stored,
    ) -> Pushed {
        let o = &touch.overlap;
        let d = touch.d;
        let t = [-d[1], d[0]];
        let closing = relative[0] * d[0] + relative[1] * d[1];
        let turning = rolled.omega - rolled.race;
        let sliding = relative[0] * t[0] + relative[1] * t[1] + rolled.omega * self.arm;
        let [old_drag, old_damping, old_about] = *passive;
        heat[0] -= old_drag * sliding;
        heat[1] += old_damping * closing + old_about * turning;
        if touch.normal <= 0.0 || o.area <= 0.0 {
            (*slip, *passive) = (0.0, [0.0; 3]);
            return Pushed::default();
        }
        // The compliance behind the penalty takes its part of the approach.
        let part = 1.0 / (1.0 + self.penalty * o.length * touch.give);
        let damping = (self.damping * (part * closing * o.length - turning * o.first)).max(-touch.normal);
        let normal = touch.normal + damping;
        let scale = touch.normal / o.area;
        let about = 0.5 * self.damping * turning * (o.second - o.first * o.first / o.length).max(0.0);
        // Friction: a spring that what leaves the contact takes along (THEORY §9.4).
        let half = 0.5 * o.length;
        let lost = (rolled.pace * self.time_step / half).min(1.0);
        let stiffness = self.sticking * o.length;
        let most = self.friction * touch.normal / stiffness;
        *slip = (*slip * (1.0 - lost) + self.time_step * sliding).clamp(-most, most);
        let drag = -stiffness * *slip;
        heat[0] -= drag * sliding;
        heat[1] += damping * closing + about * turning;
        *passive = [drag, damping, about];
        if last {
            let sunk = self.penalty * o.square * 0.5;
            let stuck = 0.5 * stiffness * *slip * *slip;
            energy.contact += sunk + track.compliance.energy(touch.normal) + stuck;
            energy.sticking += stuck;
        }
        let along = touch.across + drag;
        Pushed {
            force: [along * t[0] - normal * d[0], along * t[1] - normal * d[1]],
            moment: scale * o.moment + self.arm * drag - about,
        }
    }
}

/// How a roller rolls on a raceway.
#[derive(Debug, Clone, Copy)]
struct Rolled {
    /// Angular velocity of the roller [rad/s].
    omega: f64,
    /// Angular velocity of the raceway [rad/s].
    race: f64,
    /// Speed of the contact along the raceway [m/s].
    pace: f64,
}

/// What a raceway does to a roller.
#[derive(Debug, Clone, Copy, Default)]
struct Pushed {
    force: [f64; 2],
    moment: f64,
}

/// A direction turned by a small angle.
#[inline(always)]
fn turn_by([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let square = angle * angle;
    let s = angle * (1.0 - square / 6.0 * (1.0 - square / 20.0));
    let c = 1.0 - 0.5 * square * (1.0 - square / 12.0);
    [c * x - s * y, s * x + c * y]
}
