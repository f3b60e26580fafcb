//! One step of the reduced bearing, and many of them in the instruction set of the processor (THEORY §9.4).

use pulp::{Arch, Simd, WithSimd};
use stribeck_scene::scene::DampingFrame;

use crate::{
    bearing::{Bearing, Cage, Touch, Track, Wall},
    reduction::LANES,
    state::{State, count},
};

/// Room for what a step computes, and sums over the steps of a sample.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    /// Directions of vertex 0 of each roller.
    turned: Vec<[f64; 2]>,
    /// Shapes under each roller: x of all modes, then y.
    under: Vec<f64>,
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

/// A force that sensors hear beyond the modes: its facet, the share of the facet's second vertex, and how large it is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Heard {
    pub(crate) facet: u32,
    pub(crate) share: f64,
    pub(crate) force: f64,
}

/// Energies at the positions before a step [J].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Stored {
    pub(crate) kinetic: f64,
    pub(crate) strain: f64,
    pub(crate) contact: f64,
    /// The part of `contact` in springs of friction: no heat yet.
    pub(crate) sticking: f64,
}

impl Scratch {
    pub(crate) fn new(bearing: &Bearing, state: &State) -> Self {
        let (n, r) = (bearing.rollers, bearing.reduction.padded);
        let mut scratch = Self {
            turned: vec![[1.0, 0.0]; n],
            under: vec![0.0; 2 * n * r],
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
    fn with_simd<S: Simd>(self, _: S) {
        for _ in 0..self.steps {
            self.bearing.step(self.state, self.scratch, self.last);
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
    fn step(&self, state: &mut State, scratch: &mut Scratch, last: bool) {
        let dt = self.time_step;
        let r = self.reduction.padded;
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
        // Twice the work against friction and contact damping per time (2.24).
        let mut heat = [0.0; 2];
        let mut external = 0.0;
        let mut drive = 0.0;
        let mut damped = 0.0;
        for i in 0..self.rollers {
            let centre = [state.x[i], state.y[i]];
            let velocity = [state.vx[i], state.vy[i]];
            let omega = state.spin[i];
            let distance = (centre[0] * centre[0] + centre[1] * centre[1]).sqrt();
            let radial = [centre[0] / distance, centre[1] / distance];

            // The outer raceway has moved with the modes.
            let facet = self.outer.outline.facet_along([0.0; 2], radial, state.hints[0][i][1] as usize, 1.0);
            let share = self.outer.outline.share(facet, radial);
            let second = if facet + 1 == self.outer.outline.len() { 0 } else { facet + 1 };
            let under = &mut scratch.under[2 * r * i..2 * r * (i + 1)];
            let [moved, moving, tilt] = self.raceway_motion(state, [facet, second], share, under);
            state.hints[0][i][1] = facet as u32;
            let turned = scratch.turned[i];
            let mut hints = state.hints[0][i];
            let seen = [centre[0] - moved[0], centre[1] - moved[1]];
            let touch = self.touch(&self.outer, self.rim(i), seen, turned, &mut hints, state.force[0][i]);
            state.hints[0][i] = hints;
            state.force[0][i] = touch.normal;
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
                &mut heat,
                last,
                &mut energy,
            );
            let [fx, fy] = pushed.force;
            for (push, shapes) in scratch.push.chunks_exact_mut(LANES).zip(0..) {
                let at = LANES * shapes;
                for k in 0..LANES {
                    push[k] -= under[at + k] * fx + under[r + at + k] * fy;
                }
            }
            scratch.on_roller[i][0] = pushed.force;
            scratch.heard[i] = Heard { facet: facet as u32, share, force: touch.normal };
            scratch.deepest = scratch.deepest.max(touch.overlap.deepest);
            // Along its path the roller meets the raceway displaced more or less: it goes downhill (THEORY §9.3).
            let downhill = -(fx * tilt[0] + fy * tilt[1]) / distance;
            let [ex, ey] = [fx - downhill * radial[1], fy + downhill * radial[0]];
            force = [force[0] + ex, force[1] + ey];
            moment += pushed.moment;

            // The inner raceway turns about the origin: everything is turned back.
            let (ss, sc) = shaft;
            let back = |v: [f64; 2]| [sc * v[0] + ss * v[1], sc * v[1] - ss * v[0]];
            let mut hints = state.hints[1][i];
            let touch = self.touch(
                &self.inner,
                self.rim(i),
                back(centre),
                back(turned),
                &mut hints,
                state.force[1][i],
            );
            state.hints[1][i] = hints;
            state.force[1][i] = touch.normal;
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
                    &mut heat,
                    last,
                    &mut energy,
                );
                let [fx, fy] = pushed.force;
                on_inner = [sc * fx - ss * fy, ss * fx + sc * fy];
                force = [force[0] + on_inner[0], force[1] + on_inner[1]];
                moment += pushed.moment;
                // What the roller does to the ring, the drive makes good.
                drive += dt * rate * (centre[0] * on_inner[1] - centre[1] * on_inner[0] + pushed.moment);
                scratch.deepest = scratch.deepest.max(touch.overlap.deepest);
            } else {
                (state.slip[1][i], state.passive[1][i]) = (0.0, [0.0; 3]);
            }
            scratch.on_roller[i][1] = on_inner;

            // The walls of its pocket.
            let mut by_cage = [0.0; 2];
            if let Some(cage) = &self.cage {
                for side in 0..2 {
                    let (slip, passive) = (&mut state.wall_slip[i][side], &mut state.wall_passive[i][side]);
                    let wall = &cage.walls[i][side];
                    let placed = PlacedCage {
                        at: [state.cage[0], state.cage[1]],
                        turn: [cc, cs],
                        velocity: state.cage_velocity,
                    };
                    let hit = self.hit(
                        cage,
                        wall,
                        placed,
                        [centre, velocity],
                        omega,
                        turned,
                        slip,
                        passive,
                        &mut heat,
                        &mut energy,
                    );
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
                    damped += self.alpha * dt * roller_mass * mean * mean;
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
                    damped += self.alpha
                        * dt
                        * (roller_mass * (mean[0] * mean[0] + mean[1] * mean[1])
                            + roller_inertia * mean[2] * mean[2]);
                    new
                }
            };
            external -= 0.5 * dt * self.gravity * roller_mass * (old[1] + new[1]);
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

        self.move_modes(state, scratch, further, last, &mut energy, &mut external, &mut damped);

        if let Some(cage) = &self.cage {
            let old = state.cage_velocity;
            let acceleration =
                [on_cage[0] / cage.mass, on_cage[1] / cage.mass - self.gravity, on_cage[2] / cage.inertia];
            let new: [f64; 3] = std::array::from_fn(|c| old[c] + dt * acceleration[c]);
            external -= 0.5 * dt * self.gravity * cage.mass * (old[1] + new[1]);
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
        work.friction += 0.5 * dt * heat[0];
        work.contact_damping += 0.5 * dt * heat[1];
        count(&mut work.external, external);
        count(&mut work.drive, drive);
        count(&mut work.damping, damped);
        state.work = work;
        state.steps += 1;
        if last {
            scratch.energy = energy;
        }
    }

    /// Displacement and velocity of the outer raceway under a roller, and the change of the displacement with the angle; leaves the
    /// shapes there in `under`.
    #[inline(always)]
    fn raceway_motion(
        &self,
        state: &State,
        [a, b]: [usize; 2],
        share: f64,
        under: &mut [f64],
    ) -> [[f64; 2]; 3] {
        let r = self.reduction.padded;
        let shapes = &self.reduction.shapes;
        let angle = self.outer.angle[a];
        let (a, b) = (&shapes[2 * r * a..2 * r * (a + 1)], &shapes[2 * r * b..2 * r * (b + 1)]);
        let (ux, uy) = under.split_at_mut(r);
        let mut sums = [[0.0; LANES]; 6];
        for at in (0..r).step_by(LANES) {
            let (ax, ay) = (&a[at..at + LANES], &a[r + at..r + at + LANES]);
            let (bx, by) = (&b[at..at + LANES], &b[r + at..r + at + LANES]);
            let (ux, uy) = (&mut ux[at..at + LANES], &mut uy[at..at + LANES]);
            let (q, v) = (&state.q[at..at + LANES], &state.v[at..at + LANES]);
            for k in 0..LANES {
                let (dx, dy) = (bx[k] - ax[k], by[k] - ay[k]);
                ux[k] = ax[k] + share * dx;
                uy[k] = ay[k] + share * dy;
                sums[0][k] += ux[k] * q[k];
                sums[1][k] += uy[k] * q[k];
                sums[2][k] += ux[k] * v[k];
                sums[3][k] += uy[k] * v[k];
                sums[4][k] += dx * q[k];
                sums[5][k] += dy * q[k];
            }
        }
        let total = |s: [f64; LANES]| ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
        let [dx, dy] = [total(sums[4]) * angle, total(sums[5]) * angle];
        [[total(sums[0]), total(sums[1])], [total(sums[2]), total(sums[3])], [dx, dy]]
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

    /// Modes move (THEORY §9.4); `further` is what the load exceeds that of the preload by, in shares of it.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one motion, with all that it reads and adds to")]
    fn move_modes(
        &self,
        state: &mut State,
        scratch: &Scratch,
        further: f64,
        last: bool,
        energy: &mut Stored,
        external: &mut f64,
        damped: &mut f64,
    ) {
        let dt = self.time_step;
        let r = self.reduction.padded;
        let h = match self.frame {
            DampingFrame::RigidMotion => 0.0,
            _ => 0.5 * self.alpha * dt,
        };
        let (kept, gain) = ((1.0 - h) / (1.0 + h), dt / (1.0 + h));
        let alpha = 2.0 * h / dt;
        let mut sums = [[0.0; LANES]; 4];
        let along_load =
            |state: &State| state.v.iter().zip(&self.reduction.load.0).map(|(v, load)| v * load).sum::<f64>();
        let before = if further != 0.0 { along_load(state) } else { 0.0 };
        for (branch, stretch) in self.branches.iter().zip(&mut state.branches) {
            let e = (-dt / branch.relaxation_time).exp();
            for (u, v) in stretch.iter_mut().zip(&state.v) {
                *u = e * *u + branch.relaxation_time * (1.0 - e) * v;
            }
        }
        for at in (0..r).step_by(LANES) {
            for k in 0..LANES {
                let n = at + k;
                let (q, v) = (state.q[n], state.v[n]);
                let square = self.reduction.squares[n];
                let mut ahead = self.beta * v;
                for (branch, stretch) in self.branches.iter().zip(&state.branches) {
                    ahead += branch.stiffness * stretch[n];
                }
                let a = scratch.push[n] - square * (q + ahead);
                let new = kept * v + gain * a;
                let mean = 0.5 * (v + new);
                sums[0][k] += mean * self.reduction.external[n];
                sums[1][k] += (alpha * mean + square * ahead) * mean;
                sums[2][k] += v * new;
                sums[3][k] +=
                    q * (0.5 * square * q + self.reduction.external[n] - self.reduction.constant[n]);
                state.v[n] = new;
                state.q[n] = q + dt * new;
            }
        }
        let total = |s: [f64; LANES]| ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
        *external += dt * total(sums[0]);
        if further != 0.0 {
            *external += 0.5 * dt * further * (before + along_load(state));
        }
        *damped += dt * total(sums[1]);
        if last {
            energy.kinetic += 0.5 * total(sums[2]);
            energy.strain += self.reduction.strain + total(sums[3]);
        }
    }

    /// A roller and a wall of its pocket.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one contact, with all that it reads and adds to")]
    fn hit(
        &self,
        cage: &Cage,
        wall: &Wall,
        placed: PlacedCage,
        [centre, velocity]: [[f64; 2]; 2],
        omega: f64,
        turned: [f64; 2],
        slip: &mut f64,
        passive: &mut [f64; 2],
        heat: &mut [f64; 2],
        energy: &mut Stored,
    ) -> Option<Hit> {
        let [c, s] = placed.turn;
        let cage_centre = self.reduction.cage.map(|cage| cage.1)?;
        let rel = [centre[0] - placed.at[0] - cage_centre[0], centre[1] - placed.at[1] - cage_centre[1]];
        let own = [c * rel[0] + s * rel[1], c * rel[1] - s * rel[0]];
        let [a, b] = wall.ends;
        let edge = [b[0] - a[0], b[1] - a[1]];
        let length2 = edge[0] * edge[0] + edge[1] * edge[1];
        let t = ((own[0] - a[0]) * edge[0] + (own[1] - a[1]) * edge[1]) / length2;
        let t = t.clamp(0.0, 1.0);
        let foot = [a[0] + t * edge[0] - own[0], a[1] + t * edge[1] - own[1]];
        let distance = (foot[0] * foot[0] + foot[1] * foot[1]).sqrt();
        if distance >= self.rims[0].top
            || (own[0] - a[0]) * wall.normal[0] + (own[1] - a[1]) * wall.normal[1] < 0.0
        {
            (*slip, *passive) = (0.0, [0.0; 2]);
            return None;
        }
        // From the roller's centre to the foot, in space.
        let to = [foot[0] / distance, foot[1] / distance];
        let d = [c * to[0] - s * to[1], s * to[0] + c * to[1]];
        let own_d = [turned[0] * d[0] + turned[1] * d[1], turned[0] * d[1] - turned[1] * d[0]];
        let (depth, tilt) = self.rims[0].outline.depth(own_d, distance);
        if depth <= 0.0 {
            (*slip, *passive) = (0.0, [0.0; 2]);
            return None;
        }
        let (n, [force, stiffness, stored], couple) = if t > 0.0 && t < 1.0 {
            // Flat against round: the parabola on the penalty. The foot goes along the wall with the roller, so that the force stands on
            // the wall, and that the facet leans from it by an angle of sine `tilt` turns roller and cage against each other.
            let reach = (2.0 * self.arm * depth).sqrt();
            let force = self.penalty * depth * reach * (4.0 / 3.0);
            let across = (1.0 - tilt * tilt).sqrt() * force;
            (d, [across, self.penalty * 2.0 * reach, 0.4 * force * depth], -force * distance * tilt)
        } else {
            // The normal of the roller's facet.
            let n = [d[0] - tilt * d[1], d[1] + tilt * d[0]];
            (n, self.corner(cage, wall, d, [c, s], depth), 0.0)
        };
        // The cage's velocity at the foot.
        let arm = [rel[0] + d[0] * distance, rel[1] + d[1] * distance];
        let at_foot = [
            placed.velocity[0] - placed.velocity[2] * arm[1],
            placed.velocity[1] + placed.velocity[2] * arm[0],
        ];
        let relative = [
            velocity[0] - omega * d[1] * distance - at_foot[0],
            velocity[1] + omega * d[0] * distance - at_foot[1],
        ];
        let closing = relative[0] * n[0] + relative[1] * n[1];
        let damping = (self.damping / self.penalty * stiffness * closing).max(-force);
        let t = [-n[1], n[0]];
        let sliding = relative[0] * t[0] + relative[1] * t[1];
        let sticking = self.sticking / self.penalty * stiffness;
        let most = self.friction * force / sticking;
        *slip = (*slip + self.time_step * sliding).clamp(-most, most);
        let drag = -sticking * *slip;
        heat[0] -= (passive[0] + drag) * sliding;
        heat[1] += (passive[1] + damping) * closing;
        *passive = [drag, damping];
        energy.contact += stored + 0.5 * sticking * *slip * *slip;
        energy.sticking += 0.5 * sticking * *slip * *slip;
        let normal = force + damping;
        let on_roller = [drag * t[0] - normal * n[0], drag * t[1] - normal * n[1]];
        let cross = |r: [f64; 2]| r[0] * on_roller[1] - r[1] * on_roller[0];
        Some(Hit {
            force: on_roller,
            moment: couple + cross([d[0] * distance, d[1] * distance]),
            on_cage: couple + cross(arm),
        })
    }

    /// Force, stiffness and stored energy of a corner of the cage that is `depth` deep in a facet: its own points, and those of the
    /// roller in the wedge. The wedge stands to the direction d from the roller's centre: the normal of the facet jumps where facets
    /// meet, and the energy would jump with it.
    #[inline(always)]
    fn corner(&self, cage: &Cage, wall: &Wall, d: [f64; 2], [c, s]: [f64; 2], depth: f64) -> [f64; 3] {
        let normal = [c * wall.normal[0] - s * wall.normal[1], s * wall.normal[0] + c * wall.normal[1]];
        // Sine of the angle between d and the wall's normal; the other side of the corner stands at a right angle to the wall.
        let cosine = -(d[0] * normal[0] + d[1] * normal[1]);
        let sine = (1.0 - cosine * cosine).max(1e-6).sqrt();
        let cosine = cosine.abs().max(1e-3);
        let own = 0.5 * self.penalty * cage.corner;
        // The wedge cuts the length depth (cot a + tan a) from the facet; the nearest side of it is at most `peak` away.
        let base = depth * (cosine / sine + sine / cosine);
        let peak = base * sine * cosine / (sine + cosine);
        let others = 0.25 * self.penalty * base * peak;
        [own * depth + others, own + 2.0 * others / depth, depth * (0.5 * own * depth + others / 3.0)]
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

/// Where the cage is.
#[derive(Debug, Clone, Copy)]
struct PlacedCage {
    at: [f64; 2],
    turn: [f64; 2],
    velocity: [f64; 3],
}

/// What a wall does to a roller.
struct Hit {
    force: [f64; 2],
    /// About the roller's centre.
    moment: f64,
    /// Of the same force about the cage's centre of mass.
    on_cage: f64,
}

/// A direction turned by a small angle.
#[inline(always)]
fn turn_by([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let square = angle * angle;
    let s = angle * (1.0 - square / 6.0 * (1.0 - square / 20.0));
    let c = 1.0 - 0.5 * square * (1.0 - square / 12.0);
    [c * x - s * y, s * x + c * y]
}
