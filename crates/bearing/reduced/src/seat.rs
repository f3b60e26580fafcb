//! The seat of the outer ring during a run: its springs hold, open and slip (THEORY §9.1).

mod panels;
mod responses;
mod state;
mod sums;

use crate::modal::Seat;
use pulp::{Scalar, Simd};
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{
    roller_force::RollerForce,
    row::{Numbers, Row, Single, closed_in_single, in_single, largest_of},
};
pub(crate) use responses::RollerResponses;
pub use state::SeatState;
use sums::dot;

/// When the iteration over the panels ends.
#[derive(Debug, Clone, Copy)]
struct Passes {
    /// Most passes.
    most: usize,
    /// Largest change of a tension at which it has converged [N].
    still: f64,
}

/// The iteration has converged when no tension changes by more than this share of the mean force on a panel …
const STILL: f64 = 1e-4;

/// … or in a step, where that is more, than this times the square of the time step [1/s²]: roller forces are
/// extrapolated with an error of that order.
const STILL_IN_STEP: f64 = 2.5e8;

/// The seat's tables for a step, in rows.
#[derive(Debug, Clone)]
pub(crate) struct Springs {
    padded: usize,
    /// Tension by a unit of each mode, mode by mode, and the same spring by spring.
    by_mode: Vec<Single>,
    by_spring: Vec<Single>,
    /// Tension by a unit force of a roller at each vertex of the raceway, vertex by vertex, the first one
    /// again after the last, and by those of the preload.
    by_rollers: Vec<Single>,
    at_preload: Vec<Row>,
    /// Loss of tension of all springs by a unit that one opens or slips.
    stiffness: Vec<Single>,
    /// The same of each by its own [N/m], and one over it, zero where there is no spring.
    own: Vec<Row>,
    per_own: Vec<Row>,
    /// Displacement of the raceway at the softer vertex of each facet, under a unit force there with all
    /// panels open [m/N].
    flexibility: Vec<f64>,
    /// Force that presses each panel at the preload [N].
    pressed: Vec<Row>,
    /// Least opening of each panel: it touches where it has closed by its gap at the preload [m].
    closed: Vec<Row>,
    /// Largest displacement of any vertex of the raceway by a unit that each opens or slips [1].
    farthest: Vec<Row>,
    friction: f64,
    /// Whether films make rollers press that hardly do.
    with_oil: bool,
    at_rest: Passes,
    in_step: Passes,
}

impl Springs {
    /// Of a seat whose tables have been rounded to single precision.
    pub(crate) fn new(seat: &Seat, modes: usize, friction: f64, with_oil: bool, time_step: f64) -> Self {
        let n = 2 * seat.padded;
        let rows =
            |values: &[f64]| -> Vec<Row> { values.as_chunks::<LANES>().0.iter().copied().map(Row).collect() };
        let by_mode = in_single(&seat.tension);
        let by_rollers = closed_in_single(&seat.by_rollers, n / LANES);
        let stiffness = in_single(&seat.stiffness);
        let found = seat.tension.len() / n;
        let of =
            |spring: usize, mode: usize| if mode < found { seat.tension[mode * n + spring] } else { 0.0 };
        let by_spring: Vec<f64> =
            (0..n).flat_map(|spring| (0..modes).map(move |mode| of(spring, mode))).collect();
        let own: Vec<f64> = seat.stiffness.iter().step_by(n + 1).copied().collect();
        let per_own: Vec<f64> =
            own.iter().map(|stiffness| if *stiffness > 0.0 { 1.0 / stiffness } else { 0.0 }).collect();
        let flexibility = &seat.flexibility;
        let mean = seat.pressed.iter().sum::<f64>() / seat.panels as f64;
        Self {
            padded: seat.padded,
            by_mode,
            by_spring: in_single(&by_spring),
            by_rollers,
            at_preload: rows(&seat.at_preload),
            per_own: rows(&per_own),
            flexibility: flexibility
                .iter()
                .zip(flexibility.iter().cycle().skip(1))
                .map(|(a, b)| a.max(*b))
                .collect(),
            own: rows(&own),
            stiffness,
            pressed: rows(&seat.pressed),
            closed: rows(&seat.gaps.iter().map(|gap| 0.0 - gap).collect::<Vec<_>>()),
            farthest: largest_of::<1>(&seat.by_rollers, n),
            friction,
            with_oil,
            at_rest: Passes { most: 1000, still: STILL * mean },
            in_step: Passes { most: 200, still: STILL.max(STILL_IN_STEP * time_step * time_step) * mean },
        }
    }

    /// Rows of tensions.
    pub(crate) fn rows(&self) -> usize {
        2 * self.padded / LANES
    }

    /// Nothing has opened or slipped yet.
    pub(crate) fn at_rest(&self, modes: usize, rollers: usize) -> SeatState {
        let zeros = vec![0.0; 2 * self.padded];
        SeatState {
            open: zeros.clone(),
            before: zeros.clone(),
            lost: zeros,
            push: vec![0.0; modes],
            pressed: vec![RollerForce::default(); rollers],
        }
    }

    /// Whether it may belong to this seat.
    pub(crate) fn fits(&self, panels: &SeatState, modes: usize, rollers: usize) -> bool {
        [&panels.open, &panels.before, &panels.lost].iter().all(|v| v.len() == 2 * self.padded)
            && panels.push.len() == modes
            && panels.pressed.len() == rollers
            && panels
                .pressed
                .iter()
                .all(|roller| (roller.facet as usize + 1) < self.by_rollers.len() / self.rows())
    }

    /// Opens and slips the seat to its equilibrium at rest, with the modes at `q`.
    pub(crate) fn slip(&self, panels: &mut SeatState, q: &[f64]) {
        let simd = Scalar::new();
        let (mut tension, mut responses) = (vec![Row::default(); self.rows()], RollerResponses::default());
        self.answer(simd, panels, &panels.pressed, &mut responses);
        self.tensions(simd, panels, 0, q, &mut responses, &mut tension);
        self.settle(simd, panels, 0, &mut tension, &mut responses, self.at_rest);
        panels.before.copy_from_slice(&panels.open);
    }

    /// Finds opening and slip at the present modes, and adds their modal forces to `push`. Returns the heat
    /// of this step [J] and, when it is the `last` of a sample, the energy that is stored by it [J].
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one seat, with all that it reads and adds to")]
    pub(crate) fn respond<S: Simd>(
        &self,
        simd: S,
        panels: &mut SeatState,
        q: &[f64],
        rollers: &[RollerForce],
        responses: &mut RollerResponses,
        [push, tension]: [&mut [Row]; 2],
        last: bool,
    ) -> [f64; 2] {
        let moved = self.extrapolate(simd, panels);
        self.answer(simd, panels, rollers, responses);
        self.tensions(simd, panels, moved, q, responses, tension);
        let heat = self.settle(simd, panels, moved, tension, responses, self.in_step);
        for (push, more) in push.iter_mut().zip(panels.push.as_chunks::<LANES>().0) {
            for (push, more) in push.iter_mut().zip(more) {
                *push += more;
            }
        }
        if !last {
            return [heat, 0.0];
        }
        // The roller forces are part of the tensions, and their work part of the rollers' own energy.
        let mut by_rollers = 0.0;
        for (roller, by) in responses.rollers.iter().zip(responses.by.chunks_exact(self.rows())) {
            by_rollers += roller.force * dot(simd, by, panels.open.as_chunks().0);
        }
        for &(vertex, force) in &responses.fixed {
            by_rollers += force * dot(simd, self.at_vertex(vertex), panels.open.as_chunks().0);
        }
        [heat, self.stored(simd, panels, tension) + by_rollers]
    }

    /// Outward displacement of the raceway by opening and slip, at both vertices of a facet [m], in parts to
    /// be summed.
    #[inline(always)]
    pub(crate) fn under<S: Simd>(&self, simd: S, panels: &SeatState, facet: usize) -> [Vector<S>; 2] {
        let [first, second] = self.ends(facet);
        let mut sums = [Vector::all(simd, 0.0); 2];
        for ((first, second), open) in first.iter().zip(second).zip(panels.open.as_chunks::<LANES>().0) {
            for at in vector_starts(simd) {
                let open = Vector::load(simd, open, at);
                sums[0] = first.load(simd, at).times_plus(open, sums[0]);
                sums[1] = second.load(simd, at).times_plus(open, sums[1]);
            }
        }
        sums
    }

    /// Bound of the motion of a vertex of the raceway by opening and slip of this step [m].
    #[inline(always)]
    pub(crate) fn farthest<S: Simd>(&self, simd: S, panels: &SeatState) -> f64 {
        let mut sum = Vector::all(simd, 0.0);
        let gaps = panels.open.as_chunks::<LANES>().0.iter().zip(panels.before.as_chunks::<LANES>().0);
        for (farthest, (open, before)) in self.farthest.iter().zip(gaps) {
            for at in vector_starts(simd) {
                let by = Vector::load(simd, open, at) - Vector::load(simd, before, at);
                sum = by.max(-by).times_plus(Vector::load(simd, farthest, at), sum);
            }
        }
        sum.sum()
    }

    /// Tensions by a unit force at a vertex.
    #[inline(always)]
    fn at_vertex(&self, vertex: usize) -> &[Single] {
        let rows = self.rows();
        &self.by_rollers[rows * vertex..][..rows]
    }

    /// Tensions by a unit force at both vertices of a facet.
    #[inline(always)]
    fn ends(&self, facet: usize) -> [&[Single]; 2] {
        let groups = self.rows();
        self.by_rollers[groups * facet..][..2 * groups].split_at(groups).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A seat of one panel and two modes, the first of which opens it and the second shifts it: 1 N/µm each,
    /// pressed by a force [N] or so far from touching [m].
    fn one_panel(friction: f64, pressed_by: f64, gap: f64) -> (Springs, SeatState) {
        let padded = LANES;
        let n = 2 * padded;
        let (mut tension, mut stiffness) = (vec![0.0; n * LANES], vec![0.0; n * n]);
        (tension[0], tension[n + padded]) = (1e6, 1e6);
        (stiffness[0], stiffness[padded * n + padded]) = (1e6, 1e6);
        let (mut pressed, mut gaps) = (vec![0.0; padded], vec![0.0; padded]);
        (pressed[0], gaps[0]) = (pressed_by, gap);
        let seat = Seat {
            panels: 1,
            padded,
            pressed,
            gaps,
            across: vec![1e6; padded],
            tension,
            by_rollers: vec![0.0; n],
            at_preload: vec![0.0; n],
            stiffness,
            on_ring: vec![[0.0; 2]; n],
            taken_back: Vec::new(),
            at_sensors: Vec::new(),
            flexibility: vec![1e-6],
        };
        let springs = Springs::new(&seat, LANES, friction, false, 1e-6);
        let panels = springs.at_rest(LANES, 0);
        (springs, panels)
    }

    /// Heat of a step, energy and tensions across and along at the coordinates of both modes [m].
    fn at(springs: &Springs, panels: &mut SeatState, q: [f64; 2]) -> [f64; 4] {
        let mut all = vec![0.0; LANES];
        all[..2].copy_from_slice(&q);
        let mut tension = vec![Row::default(); springs.rows()];
        let mut responses = RollerResponses::default();
        let moved = springs.extrapolate(Scalar::new(), panels);
        springs.tensions(Scalar::new(), panels, moved, &all, &mut responses, &mut tension);
        let heat =
            springs.settle(Scalar::new(), panels, moved, &mut tension, &mut responses, springs.in_step);
        [
            heat,
            springs.stored(Scalar::new(), panels, &tension),
            tension[0][0] - springs.pressed[0][0],
            tension[1][0],
        ]
    }

    /// A spring and a slider in series: 4 µN (A − µN/k) of heat in a cycle of the amplitude A.
    /// Source: own, the area of the loop; a Jenkins element.
    #[test]
    fn analytic_a_panel_that_slips_back_and_forth_turns_the_area_of_its_loop_into_heat() {
        let (springs, mut panels) = one_panel(0.2, 100.0, 0.0);
        let (amplitude, limit, stiffness) = (100e-6, 20.0, 1e6);
        let mut heat = 0.0;
        let cycle = |panels: &mut SeatState, heat: &mut f64| {
            for n in 0..4000 {
                let shift = amplitude * (std::f64::consts::TAU * n as f64 / 4000.0).sin();
                let [of_step, _, _, along] = at(&springs, panels, [0.0, shift]);
                *heat += of_step;
                assert!(along.abs() <= limit * (1.0 + 1e-12), "{along} N");
            }
        };
        cycle(&mut panels, &mut heat);
        let first = heat;
        cycle(&mut panels, &mut heat);
        let expected = 4.0 * limit * (amplitude - limit / stiffness);
        let found = heat - first;
        assert!((found / expected - 1.0).abs() < 2e-3, "{found} J, {expected} J");
    }

    /// A panel that opens loses all tension and its energy; both return when it closes.
    #[test]
    fn analytic_a_panel_opens_where_it_would_pull() {
        let (springs, mut panels) = one_panel(0.2, 100.0, 0.0);
        // 100 N over 1 N/µm: it opens 100 µm off.
        let [heat, stored, across, _] = at(&springs, &mut panels, [150e-6, 0.0]);
        assert!(across.abs() < 1e-9 && heat == 0.0, "{across} N, {heat} J");
        assert!((panels.open[0] - 50e-6).abs() < 1e-15, "{}", panels.open[0]);
        // A spring that holds would have ½k (50 µm)² more than one that lets go.
        assert!((stored + 0.5 * 1e6 * 50e-6_f64.powi(2)).abs() < 1e-12, "{stored} J");
        let [_, stored, across, _] = at(&springs, &mut panels, [50e-6, 0.0]);
        assert!(stored == 0.0 && panels.open[0] == 0.0, "{stored} J");
        assert!((across + 50.0).abs() < 1e-9, "{across} N");
    }

    /// A panel with a gap is free until the gap is closed, carries from there on, and takes no energy with it
    /// as it opens again.
    #[test]
    fn analytic_a_panel_that_nothing_presses_carries_once_its_gap_is_closed() {
        let (springs, mut panels) = one_panel(0.2, 0.0, 10e-6);
        for free in [5e-6, -9e-6] {
            let [heat, _, across, _] = at(&springs, &mut panels, [free, 0.0]);
            assert!(across.abs() < 1e-9 && heat == 0.0, "{across} N, {heat} J");
            assert!((panels.open[0] - free).abs() < 1e-15, "{} m", panels.open[0]);
        }
        // 30 µm beyond touching, at 1 N/µm.
        let [_, pressed_j, across, _] = at(&springs, &mut panels, [-40e-6, 0.0]);
        assert!((across + 30.0).abs() < 1e-9 && (panels.open[0] + 10e-6).abs() < 1e-15, "{across} N");
        // Beside ½k (40 µm)² of the modes, which hold its spring: ½k (30 µm)² are in it.
        let expected = 0.5 * 1e6 * (30e-6_f64.powi(2) - 40e-6_f64.powi(2));
        assert!((pressed_j - expected).abs() < 1e-12, "{pressed_j} J, {expected} J");
        let [_, free_j, across, _] = at(&springs, &mut panels, [0.0, 0.0]);
        assert!(across.abs() < 1e-9 && free_j.abs() < 1e-15, "{across} N, {free_j} J");
    }
}
