//! Equilibrium at the start: modes, and positions of the rollers between the raceways (THEORY §9.5).

use pulp::Scalar;
use stribeck_simd::lanes::Vector;

use crate::{
    bearing::Bearing, error::Error, law::normal_force::RollerOnRaceway, oil::Films, plane::Rotation,
    roller_force::RollerForce, state::State,
};

/// Solves a dense system of equations from its matrix, row by row, and its right-hand side. The caller brings
/// the solver, so that this crate needs none.
pub type Solve<'a> = &'a dyn Fn(&[f64], &[f64]) -> Vec<f64>;

/// Newton iterations for modes and rollers.
const ITERATIONS: usize = 200;

/// Largest motion of the raceway under a roller in an iteration [m], halved whenever it would reverse: under
/// a light load few rollers touch or none, and the stiffness that supports the ring is unknown until they do.
const FARTHEST: f64 = 10e-6;

/// From this iteration on steps that go back and forth are halved, however short they are: a film or an edge
/// that makes the force jump has its equilibrium at the jump, about which Newton's steps would cycle.
const CYCLES: usize = 20;

/// A step so short is at such a jump [m].
const AT_A_JUMP: f64 = 1e-12;

/// Remaining unbalanced force on a roller or a mode, over the load.
const TOLERANCE: f64 = 1e-9;

/// Holds motions of modes that nothing resists while the iteration runs [rad²/s²].
const REGULARISATION: f64 = 1e4;

/// Number of alternations between slip of the seat and equilibrium.
const SEATINGS: usize = 8;

impl Bearing {
    /// The state of equilibrium under load, gravity and the inertia of rolling, with rolling velocities half
    /// a step earlier.
    ///
    /// # Errors
    /// When the iteration does not converge.
    pub fn at_start(&self, solve: Solve<'_>) -> Result<State, Error> {
        self.in_equilibrium(self.rest(), solve)
    }

    /// As [`at_start`](Self::at_start), from a state at rest.
    pub(crate) fn in_equilibrium(&self, rest: State, solve: Solve<'_>) -> Result<State, Error> {
        let mut state = rest;
        self.equilibrium(solve, &mut state)?;
        if let Some(seat) = &self.seat {
            // Rollers stand elsewhere than at the preload of the reduction: the seat slips until friction
            // holds it.
            for _ in 0..SEATINGS {
                let State { seat: hold, q, .. } = &mut state;
                hold.iter_mut().for_each(|hold| seat.slip(hold, q));
                self.equilibrium(solve, &mut state)?;
            }
        }
        let half = 0.5 * self.time_step;
        for i in 0..self.rollers.count {
            let [x, y] = [state.x[i], state.y[i]];
            let (orbit, square) = (self.operation.speeds.cage, self.operation.speeds.cage.powi(2));
            (state.vx[i], state.vy[i]) = (-orbit * y + half * square * x, orbit * x + half * square * y);
        }
        state.hints = self.first_hints(&state);
        // They begin at the first step, with the thickness of steady rolling.
        state.films.iter_mut().for_each(Films::forget);
        Ok(state)
    }

    /// Brings modes and rollers into equilibrium while the seat stays as it is.
    fn equilibrium(&self, solve: Solve<'_>, state: &mut State) -> Result<(), Error> {
        let r = self.reduction.padded;
        let load = self.operation.load_at_start.max(1.0);
        let mut shapes = vec![0.0; 2 * r * self.rollers.count];
        let (mut farthest, mut last) = (FARTHEST, vec![0.0; r]);
        for iteration in 0..ITERATIONS {
            let (mut matrix, mut force) = self.balance_of_modes(state);
            for i in 0..self.rollers.count {
                let under = &mut shapes[2 * r * i..2 * r * (i + 1)];
                self.add_roller(state, i, under, &mut matrix, &mut force);
            }
            if let Some(housing) = &self.housing {
                housing.hold(&mut matrix, &mut force);
            }
            // A motion without stiffness, the rotation of ring and adapter, is left to inertia.
            let step = solve(&matrix, &force);
            let residual = (0..r).map(|n| (force[n] * step[n]).abs()).sum::<f64>();
            let along =
                |shapes: &[f64]| shapes.iter().zip(&step).map(|(shape, step)| shape * step).sum::<f64>();
            let moves =
                shapes.chunks_exact(2 * r).map(|both| libm::hypot(along(&both[..r]), along(&both[r..])));
            let most = moves.fold(0.0, f64::max);
            let back = along(&last) < 0.0;
            if most > farthest && back {
                farthest *= 0.5;
            } else if iteration >= CYCLES {
                farthest = if back { 0.5 * farthest.min(most) } else { (2.0 * farthest).min(FARTHEST) };
            }
            let share = (farthest / most).min(1.0);
            state.q.iter_mut().zip(&step).for_each(|(q, step)| *q += share * step);
            last = step;
            // Work of the unbalanced forces, against that of the load over a nanometre.
            if iteration > 0 && residual <= TOLERANCE * load * 1e-9 {
                break;
            }
            if iteration >= CYCLES && share * most < AT_A_JUMP {
                break;
            }
            if iteration + 1 == ITERATIONS {
                return Err(Error::NoEquilibrium { residual_n: residual, iterations: ITERATIONS });
            }
        }
        Ok(())
    }

    /// Stiffness of the modes, row by row, and the unbalanced forces on them [N] without those of rollers.
    fn balance_of_modes(&self, state: &State) -> (Vec<f64>, Vec<f64>) {
        let r = self.reduction.padded;
        let further = self.operation.load_change(0.0);
        let mut force = self.reduction.constant.clone();
        let mut matrix = vec![0.0; r * r];
        if let Some(seat) = &state.seat {
            force.iter_mut().zip(&seat.push).for_each(|(force, push)| *force += push);
        }
        for n in 0..r {
            force[n] += further[0] * self.reduction.load.along[n]
                + further[1] * self.reduction.load.across[n]
                - self.reduction.squares[n] * state.q[n];
            matrix[n * r + n] = self.reduction.squares[n] + REGULARISATION;
        }
        (matrix, force)
    }

    /// Brings roller `i` into its own balance between the raceways, and adds its force on the modes and the
    /// stiffness of its two contacts in series. `under` receives the modes' shapes under it.
    fn add_roller(
        &self,
        state: &mut State,
        i: usize,
        under: &mut [f64],
        matrix: &mut [f64],
        force: &mut [f64],
    ) {
        let r = self.reduction.padded;
        let angle = libm::atan2(state.y[i], state.x[i]);
        let (s, c) = libm::sincos(angle);
        let moved = self.shapes_under(state, i, [c, s], under);
        let radial: Vec<f64> = (0..r).map(|n| c * under[n] + s * under[r + n]).collect();
        let (at, outer) = self.roller_in_balance(state, i, [c, s], moved);
        // How the force grows with the raceway's displacement, the roller following.
        let step = 1e-9;
        let [a0, b0] = self.pressed(state, i, moved);
        let [a1, _] = self.pressed(state, i, [moved[0] - step * c, moved[1] - step * s]);
        let outer_stiffness = (a1 - a0) / step;
        (state.x[i], state.y[i]) = ((at - step) * c, (at - step) * s);
        let [_, b1] = self.pressed(state, i, moved);
        let inner_stiffness = (b1 - b0) / step;
        (state.x[i], state.y[i]) = (at * c, at * s);
        if let Some(seat) = &mut state.seat {
            seat.pressed[i] = self.roller_force_at(state.hints[0][i][1], [c, s], outer);
        }
        let both = outer_stiffness + inner_stiffness;
        let together = if both > 0.0 { outer_stiffness * inner_stiffness / both } else { 0.0 };
        for n in 0..r {
            force[n] += outer * radial[n];
            for m in 0..r {
                matrix[n * r + m] += together * radial[n] * radial[m];
            }
        }
    }

    /// Moves roller `i` along the direction `[c, s]` of its centre to where the inner raceway and its orbit
    /// press it outwards as much as the outer raceway, displaced by `moved`, presses it back: its distance
    /// from the bearing's centre [m], and the force of the outer raceway [N].
    fn roller_in_balance(
        &self,
        state: &mut State,
        i: usize,
        [c, s]: [f64; 2],
        moved: [f64; 2],
    ) -> (f64, f64) {
        let [mass, _] = self.reduction.roller_inertia;
        let inertia = |rho: f64| {
            mass * (self.operation.speeds.cage * self.operation.speeds.cage * rho - self.rollers.gravity * s)
        };
        let mut at = libm::hypot(state.x[i], state.y[i]);
        let balance = |state: &mut State, rho: f64| {
            (state.x[i], state.y[i]) = (rho * c, rho * s);
            let [outer, inner] = self.pressed(state, i, moved);
            (inner + inertia(rho) - outer, outer)
        };
        // The balance falls with the radius: a bracket, then bisection. Films keep a roller with clearance
        // between the circles; beyond them polygons that do not touch yet would leave it a second balance.
        let floats = self.oil.as_ref().and_then(|oil| oil.floating(&self.rollers, state, i, moved));
        let [mut low, mut high] = floats.unwrap_or([at; 2]);
        let mut width = 1e-7;
        while balance(state, low).0 < 0.0 && width < 1e-2 {
            low -= width;
            width *= 2.0;
        }
        width = 1e-7;
        while balance(state, high).0 > 0.0 && width < 1e-2 {
            high += width;
            width *= 2.0;
        }
        for _ in 0..200 {
            at = 0.5 * (low + high);
            if balance(state, at).0 > 0.0 {
                low = at
            } else {
                high = at
            }
            if high - low <= 1e-16 {
                break;
            }
        }
        (at, balance(state, at).1)
    }

    /// Contact of a roller in this direction under `force`, near the facet `hint`.
    fn roller_force_at(&self, hint: u32, radial: [f64; 2], force: f64) -> RollerForce {
        let outline = &self.raceways[0].outline;
        let facet = outline.facet_along([0.0; 2], radial, hint as usize, 1.0);
        RollerForce {
            facet: facet as u32,
            share: outline.share(facet, radial),
            force,
            ..RollerForce::default()
        }
    }

    /// Shapes under roller `i` in the direction of its centre, and the displacement there.
    fn shapes_under(&self, state: &State, i: usize, radial: [f64; 2], under: &mut [f64]) -> [f64; 2] {
        let r = self.reduction.padded;
        let outline = &self.raceways[0].outline;
        let facet = outline.facet_along([0.0; 2], radial, state.hints[0][i][1] as usize, 1.0);
        let second = if facet + 1 == outline.len() { 0 } else { facet + 1 };
        let share = outline.share(facet, radial);
        let shapes = &self.reduction.shapes;
        for n in 0..2 * r {
            let [a, b] = [shapes[2 * r * facet + n], shapes[2 * r * second + n]];
            under[n] = a + share * (b - a);
        }
        let sum = |from: usize| (0..r).map(|n| under[from + n] * state.q[n]).sum();
        let mut moved = [sum(0), sum(r)];
        if let (Some(seat), Some(hold)) = (&self.seat, &state.seat) {
            let [a, b] = seat.under(Scalar::new(), hold, facet).map(Vector::sum);
            let further = a + share * (b - a);
            moved = [moved[0] + further * radial[0], moved[1] + further * radial[1]];
        }
        moved
    }

    /// Normal forces on a roller by outer and inner raceway, the former displaced, and by the oil between
    /// them.
    fn pressed(&self, state: &mut State, i: usize, moved: [f64; 2]) -> [f64; 2] {
        let (s, c) = libm::sincos(state.angle[i] + self.rollers.starts[i].vertex_angle);
        let shaft = Rotation::by(state.shaft);
        let centre = [state.x[i], state.y[i]];
        let seen = [centre[0] - moved[0], centre[1] - moved[1]];
        let mut hints = [state.hints[0][i], state.hints[1][i]];
        let (simd, [on_outer, on_inner]) = (Scalar::new(), &self.raceways);
        // A force found with steps of Newton's method: from the one before until it stands.
        let mut forces = [state.force[0][i], state.force[1][i]];
        for _ in 0..40 {
            let [before, other] = forces;
            let (rim, larger) = (self.rollers.rim(i), self.rollers.larger[i]);
            let near = RollerOnRaceway {
                raceway: on_outer,
                rim,
                centre: seen,
                spin: [c, s],
                bound: on_outer.bound,
                larger,
                before,
            };
            let outer = self.law.normal_force(simd, near, &mut hints[0]);
            let (centre, spin) = (shaft.back(centre), shaft.back([c, s]));
            let inner = self.law.normal_force(
                simd,
                RollerOnRaceway {
                    raceway: on_inner,
                    rim,
                    centre,
                    spin,
                    bound: on_inner.bound,
                    larger,
                    before: other,
                },
                &mut hints[1],
            );
            let next = [outer.normal, inner.normal];
            let still = (0..2).all(|k| (next[k] - forces[k]).abs() <= 1e-12 * next[k].abs());
            forces = next;
            if still {
                break;
            }
        }
        state.hints[0][i] = hints[0];
        state.hints[1][i] = hints[1];
        (state.force[0][i], state.force[1][i]) = (forces[0], forces[1]);
        let by_oil = self.oil.as_ref().map_or([0.0; 2], |oil| oil.carried(&self.rollers, state, i, moved));
        [forces[0] + by_oil[0], forces[1] + by_oil[1]]
    }
}
