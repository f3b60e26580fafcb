//! The seat during a run: which of its springs hold, open and slip (THEORY §9.1).

use pulp::{Scalar, Simd};
use serde::{Deserialize, Serialize};
use stribeck_modal::Seat;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{
    roller_force::RollerForce,
    rollers::row::{Numbers, Row, Single, bits, in_single, largest_of},
};

/// When passes over the panels end.
#[derive(Debug, Clone, Copy)]
struct Passes {
    /// After so many at most …
    most: usize,
    /// … or when no tension would change by more [N].
    still: f64,
}

/// A tension that changes by less than this share of the mean force on a panel takes no further pass …
const STILL: f64 = 1e-4;

/// … nor in a step one that changes by less than this times the square of the step [1/s²], as the error of the step goes: what rollers will
/// press is not known better.
const STILL_IN_STEP: f64 = 2.5e8;

/// Every other panel, beginning with the first and with the second. Their number is odd, so that the mirrored seat has mirrored ones.
const EVERY_OTHER: [Row; 2] =
    [Row([1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]), Row([0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0])];

/// A roller responses to the seat where that takes more than this part of its force if all panels let go. Where less, its force of the
/// step before serves, taken on as it grew, which is stable up to a third.
const RESPONSIVE: f64 = 0.2;

/// What is looked up of the seat in every step, in rows.
#[derive(Debug, Clone)]
pub(crate) struct Springs {
    padded: usize,
    /// Tension by a unit of each mode, mode by mode, and the same spring by spring.
    by_mode: Vec<Single>,
    by_spring: Vec<Single>,
    /// Tension by a unit force of a roller at each vertex of the raceway, vertex by vertex, and by those of the preload.
    by_rollers: Vec<Single>,
    at_preload: Vec<Row>,
    /// Loss of tension of all springs by a unit that one opens or slips.
    stiffness: Vec<Single>,
    /// The same of each by its own [N/m], and one over it, zero where there is no spring.
    own: Vec<Row>,
    per_own: Vec<Row>,
    /// What the raceway gives way by on each facet, at the vertex where that is more, under a unit force there if the whole seat lets go
    /// [m/N].
    give: Vec<f64>,
    /// Force that presses each panel at the preload [N].
    pressed: Vec<Row>,
    /// Largest displacement of any vertex of the raceway by a unit that each opens or slips [1].
    farthest: Vec<Row>,
    friction: f64,
    at_rest: Passes,
    in_step: Passes,
}

/// By how much the seat has opened and slipped, and what comes of it: part of the checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeatState {
    /// Gap of each panel, then its slip [m].
    pub(crate) open: Vec<f64>,
    /// The same before the last step.
    before: Vec<f64>,
    /// Tension that each spring has lost by it [N].
    lost: Vec<f64>,
    /// What that does to each mode [N/√kg].
    pub(crate) push: Vec<f64>,
    /// What rollers press in the last step.
    pub(crate) pressed: Vec<RollerForce>,
}

/// What rollers press in a step, and how they answer to a seat that gives way.
#[derive(Debug, Clone, Default)]
pub(crate) struct RollerResponses {
    rollers: Vec<RollerResponse>,
    /// Tensions by a unit force of each, roller by roller.
    by: Vec<Row>,
    /// Springs that move, and by how much: room for a list.
    moves: Vec<(usize, f64)>,
}

/// What one of them does.
#[derive(Debug, Clone, Copy)]
struct RollerResponse {
    /// Force on the raceway [N].
    force: f64,
    /// What it is expected to be, which may be below zero, if the seat has given way under it by `given` [m].
    expected: f64,
    given: f64,
    /// By how much it falls where the seat gives way further [N/m]; zero where that is not felt.
    stiffness: f64,
    /// The part of each change that a pass takes.
    part: f64,
}

/// Adds a multiple of some rows to others.
#[inline(always)]
fn add<S: Simd>(simd: S, to: &mut [Row], rows: &[Row], times: f64) {
    let times = Vector::all(simd, times);
    for (row, to) in rows.iter().zip(to) {
        for at in vector_starts(simd) {
            let had = Vector::load(simd, to, at);
            Vector::load(simd, row, at).times_plus(times, had).store(to, at);
        }
    }
}

/// Adds multiples of columns of `rows` to sums, four rows at a time, which stay in registers meanwhile.
#[inline(always)]
fn add_all<S: Simd, R: AsMut<[f64]>, N: Numbers>(
    simd: S,
    sums: &mut [R],
    rows: &[N],
    times: impl Iterator<Item = (usize, f64)> + Clone,
) {
    let count = sums.len();
    let (fours, rest) = sums.as_chunks_mut::<4>();
    let mut first = 0;
    for [a, b, c, d] in fours {
        let [a, b, c, d] = [a.as_mut(), b.as_mut(), c.as_mut(), d.as_mut()];
        for at in vector_starts(simd) {
            let (mut in_a, mut in_b) = (Vector::load(simd, a, at), Vector::load(simd, b, at));
            let (mut in_c, mut in_d) = (Vector::load(simd, c, at), Vector::load(simd, d, at));
            for (column, times) in times.clone() {
                let [of_a, of_b, of_c, of_d] = &rows[count * column + first..].as_chunks::<4>().0[0];
                let times = Vector::all(simd, times);
                in_a = of_a.load(simd, at).times_plus(times, in_a);
                in_b = of_b.load(simd, at).times_plus(times, in_b);
                in_c = of_c.load(simd, at).times_plus(times, in_c);
                in_d = of_d.load(simd, at).times_plus(times, in_d);
            }
            in_a.store(a, at);
            in_b.store(b, at);
            in_c.store(c, at);
            in_d.store(d, at);
        }
        first += 4;
    }
    for sum in rest {
        let sum = sum.as_mut();
        for at in vector_starts(simd) {
            let mut in_sum = Vector::load(simd, sum, at);
            for (column, times) in times.clone() {
                let row = &rows[count * column + first];
                in_sum = row.load(simd, at).times_plus(Vector::all(simd, times), in_sum);
            }
            in_sum.store(sum, at);
        }
        first += 1;
    }
}

/// Lists springs, a bit for each, with how far each of them moves, so that they can be gone through several times.
#[inline(always)]
fn listed(
    list: &mut Vec<(usize, f64)>,
    moved: u128,
    by: impl Fn(usize) -> f64,
) -> impl Iterator<Item = (usize, f64)> + Clone {
    list.clear();
    list.extend(bits(moved).map(|spring| (spring, by(spring))));
    list.iter().copied()
}

/// Sum of the products of some rows with others.
#[inline(always)]
fn dot<S: Simd>(simd: S, rows: &[Row], others: &[[f64; LANES]]) -> f64 {
    let mut sum = Vector::all(simd, 0.0);
    for (row, other) in rows.iter().zip(others) {
        for at in vector_starts(simd) {
            sum = Vector::load(simd, row, at).times_plus(Vector::load(simd, other, at), sum);
        }
    }
    sum.sum()
}

impl Springs {
    /// Of a seat whose tables have been rounded to single precision.
    pub(crate) fn new(seat: &Seat, modes: usize, friction: f64, time_step: f64) -> Self {
        let n = 2 * seat.padded;
        let rows =
            |values: &[f64]| -> Vec<Row> { values.as_chunks::<LANES>().0.iter().copied().map(Row).collect() };
        let by_mode = in_single(&seat.tension);
        let by_rollers = in_single(&seat.by_rollers);
        let stiffness = in_single(&seat.stiffness);
        let found = seat.tension.len() / n;
        let of =
            |spring: usize, mode: usize| if mode < found { seat.tension[mode * n + spring] } else { 0.0 };
        let by_spring: Vec<f64> =
            (0..n).flat_map(|spring| (0..modes).map(move |mode| of(spring, mode))).collect();
        let own: Vec<f64> = seat.stiffness.iter().step_by(n + 1).copied().collect();
        let per_own: Vec<f64> =
            own.iter().map(|stiffness| if *stiffness > 0.0 { 1.0 / stiffness } else { 0.0 }).collect();
        let give = &seat.flexibility;
        let mean = seat.pressed.iter().sum::<f64>() / seat.panels as f64;
        Self {
            padded: seat.padded,
            by_mode,
            by_spring: in_single(&by_spring),
            by_rollers,
            at_preload: rows(&seat.at_preload),
            per_own: rows(&per_own),
            give: give.iter().zip(give.iter().cycle().skip(1)).map(|(a, b)| a.max(*b)).collect(),
            own: rows(&own),
            stiffness,
            pressed: rows(&seat.pressed),
            farthest: largest_of::<1>(&seat.by_rollers, n),
            friction,
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
    pub(crate) fn fits(&self, hold: &SeatState, modes: usize, rollers: usize) -> bool {
        [&hold.open, &hold.before, &hold.lost].iter().all(|v| v.len() == 2 * self.padded)
            && hold.push.len() == modes
            && hold.pressed.len() == rollers
            && hold.pressed.iter().all(|roller| (roller.facet as usize) < self.by_rollers.len() / self.rows())
    }

    /// Lets the seat open and slip where it does at rest, the modes being at `q`.
    pub(crate) fn slip(&self, hold: &mut SeatState, q: &[f64]) {
        let simd = Scalar::new();
        let (mut tension, mut responses) = (vec![Row::default(); self.rows()], RollerResponses::default());
        self.answer(simd, hold, &hold.pressed, &mut responses);
        self.tensions(simd, hold, 0, q, &mut responses, &mut tension);
        self.settle(simd, hold, 0, &mut tension, &mut responses, self.at_rest);
        hold.before.copy_from_slice(&hold.open);
    }

    /// Finds out what opens and slips where the modes are now, and adds what that does to the modes to `push`. Returns the heat of this
    /// step [J] and, when it is the `last` of a sample, the energy that is stored by it [J].
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one seat, with all that it reads and adds to")]
    pub(crate) fn respond<S: Simd>(
        &self,
        simd: S,
        hold: &mut SeatState,
        q: &[f64],
        rollers: &[RollerForce],
        responses: &mut RollerResponses,
        [push, tension]: [&mut [Row]; 2],
        last: bool,
    ) -> [f64; 2] {
        let moved = self.extrapolate(simd, hold);
        self.answer(simd, hold, rollers, responses);
        self.tensions(simd, hold, moved, q, responses, tension);
        let heat = self.settle(simd, hold, moved, tension, responses, self.in_step);
        for (push, more) in push.iter_mut().zip(hold.push.as_chunks::<LANES>().0) {
            for (push, more) in push.iter_mut().zip(more) {
                *push += more;
            }
        }
        if !last {
            return [heat, 0.0];
        }
        // What rollers press is part of the tensions, and its work part of their own energy.
        let mut by_rollers = 0.0;
        for (roller, by) in responses.rollers.iter().zip(responses.by.chunks_exact(self.rows())) {
            by_rollers += roller.force * dot(simd, by, hold.open.as_chunks().0);
        }
        [heat, self.stored(simd, hold, tension) + by_rollers]
    }

    /// Displacement of the raceway to the outside by what has opened and slipped, at both vertices of a facet [m], in parts to be summed.
    #[inline(always)]
    pub(crate) fn under<S: Simd>(&self, simd: S, hold: &SeatState, facet: usize) -> [Vector<S>; 2] {
        let [first, second] = self.ends(facet);
        let mut sums = [Vector::all(simd, 0.0); 2];
        for ((first, second), open) in first.iter().zip(second).zip(hold.open.as_chunks::<LANES>().0) {
            for at in vector_starts(simd) {
                let open = Vector::load(simd, open, at);
                sums[0] = first.load(simd, at).times_plus(open, sums[0]);
                sums[1] = second.load(simd, at).times_plus(open, sums[1]);
            }
        }
        sums
    }

    /// How far a vertex of the raceway moves at most by what has opened and slipped in this step [m].
    #[inline(always)]
    pub(crate) fn farthest<S: Simd>(&self, simd: S, hold: &SeatState) -> f64 {
        let mut sum = Vector::all(simd, 0.0);
        let gaps = hold.open.as_chunks::<LANES>().0.iter().zip(hold.before.as_chunks::<LANES>().0);
        for (farthest, (open, before)) in self.farthest.iter().zip(gaps) {
            for at in vector_starts(simd) {
                let by = Vector::load(simd, open, at) - Vector::load(simd, before, at);
                sum = by.max(-by).times_plus(Vector::load(simd, farthest, at), sum);
            }
        }
        sum.sum()
    }

    /// Tensions by a unit force at both vertices of a facet.
    #[inline(always)]
    fn ends(&self, facet: usize) -> [&[Single]; 2] {
        let groups = self.rows();
        let second = if (facet + 1) * groups == self.by_rollers.len() { 0 } else { facet + 1 };
        [&self.by_rollers[groups * facet..][..groups], &self.by_rollers[groups * second..][..groups]]
    }

    /// Begins a step: what opened and slipped in the last one is taken to go on alike, which leaves few passes to take. Returns the springs
    /// that have moved by that, a bit for each.
    #[inline(always)]
    fn extrapolate<S: Simd>(&self, simd: S, hold: &mut SeatState) -> u128 {
        let zero = Vector::all(simd, 0.0);
        let mut moved = 0;
        for at in (0..2 * self.padded).step_by(Vector::<S>::LEN) {
            let (now, before) = (Vector::load(simd, &hold.open, at), Vector::load(simd, &hold.before, at));
            let mut next = now + (now - before);
            if at < self.padded {
                next = next.max(zero);
            }
            let by = next - now;
            now.store(&mut hold.before, at);
            next.store(&mut hold.open, at);
            moved |= u128::from(zero.bits_below(by.max(-by))) << at;
        }
        moved
    }

    /// What rollers do to the tensions, each by itself: a unit force at its place, the force that is expected if the seat goes on as in the
    /// step before, and how much less it presses where the seat gives way by more.
    #[inline(always)]
    fn answer<S: Simd>(&self, simd: S, hold: &SeatState, rollers: &[RollerForce], responses: &mut RollerResponses) {
        let groups = self.rows();
        responses.rollers.clear();
        responses.by.clear();
        for roller in rollers.iter().filter(|roller| roller.force != 0.0) {
            let ends = self.ends(roller.facet as usize);
            let (a, b) = (Vector::all(simd, 1.0 - roller.share), Vector::all(simd, roller.share));
            let mut given = Vector::all(simd, 0.0);
            let first = responses.by.len();
            responses.by.resize(first + groups, Row::default());
            let gaps = hold.open.as_chunks::<LANES>().0;
            let both = ends[0].iter().zip(ends[1]);
            for ((by, gap), (ahead, behind)) in responses.by[first..].iter_mut().zip(gaps).zip(both) {
                for at in vector_starts(simd) {
                    let (ahead, behind) = (ahead.load(simd, at), behind.load(simd, at));
                    let between = ahead.times_plus(a, behind * b);
                    given = Vector::load(simd, gap, at).times_plus(between, given);
                    between.store(by, at);
                }
            }
            let expected = roller.next();
            let mut answer = RollerResponse { force: expected, expected, given: 0.0, stiffness: 0.0, part: 0.0 };
            let gain = roller.stiffness * self.give[roller.facet as usize];
            if gain > RESPONSIVE {
                // Where panels let go a change comes back times −gain, where they hold not at all: halfway between the two.
                let part = 1.0 / (1.0 + 0.5 * gain);
                answer = RollerResponse { given: given.sum(), stiffness: roller.stiffness, part, ..answer };
            }
            responses.rollers.push(answer);
        }
    }

    /// Lets rollers answer to how far the seat has given way by now.
    #[inline(always)]
    fn update_forces<S: Simd>(&self, simd: S, hold: &SeatState, tension: &mut [Row], responses: &mut RollerResponses) {
        let RollerResponses { rollers, by, .. } = responses;
        let felt =
            rollers.iter_mut().zip(by.chunks_exact(self.rows())).filter(|(roller, _)| roller.stiffness > 0.0);
        for (roller, by) in felt {
            let further = dot(simd, by, hold.open.as_chunks().0) - roller.given;
            let target = (roller.expected - roller.stiffness * further).max(0.0);
            let force = roller.force + roller.part * (target - roller.force);
            add(simd, tension, by, force - roller.force);
            roller.force = force;
        }
    }

    /// Tensions at the coordinates `q` of the modes, while rollers press, less what has been lost before this step and by the springs that
    /// have `moved` since, a bit for each; across the seat beyond the preload.
    #[inline(always)]
    fn tensions<S: Simd>(
        &self,
        simd: S,
        hold: &SeatState,
        moved: u128,
        q: &[f64],
        responses: &mut RollerResponses,
        tension: &mut [Row],
    ) {
        let lost = hold.lost.as_chunks::<LANES>().0;
        for ((tension, at_preload), lost) in tension.iter_mut().zip(&self.at_preload).zip(lost) {
            for at in vector_starts(simd) {
                let less = Vector::load(simd, at_preload, at) + Vector::load(simd, lost, at);
                (-less).store(tension, at);
            }
        }
        let modes = q.iter().copied().enumerate().take(self.by_mode.len() / tension.len());
        add_all(simd, tension, &self.by_mode, modes);
        let rollers = responses.rollers.iter().map(|roller| roller.force).enumerate();
        add_all(simd, tension, &responses.by, rollers);
        let moves = listed(&mut responses.moves, moved, |spring| hold.before[spring] - hold.open[spring]);
        add_all(simd, tension, &self.stiffness, moves);
    }

    /// Passes over the panels until no tension would change any more, some springs having `moved` already, a bit for each; returns the heat
    /// [J].
    #[inline(always)]
    fn settle<S: Simd>(
        &self,
        simd: S,
        hold: &mut SeatState,
        mut moved: u128,
        tension: &mut [Row],
        responses: &mut RollerResponses,
        passes: Passes,
    ) -> f64 {
        // Every other panel at once: neighbours see what those between them have done.
        let mut quiet = 0;
        for half in 0..2 * passes.most {
            let (these, far) =
                self.release(simd, hold, tension, &mut responses.moves, &EVERY_OTHER[half % 2], passes.still);
            moved |= these;
            quiet = if far { 0 } else { quiet + 1 };
            if half % 2 == 1 {
                self.update_forces(simd, hold, tension, responses);
            }
            if quiet == 2 {
                break;
            }
        }
        self.accumulate(simd, hold, &mut responses.moves, moved);
        let mut heat = Vector::all(simd, 0.0);
        let slips = hold.open.as_chunks::<LANES>().0.iter().zip(hold.before.as_chunks::<LANES>().0);
        for (tension, (open, before)) in tension.iter().zip(slips).skip(self.padded / LANES) {
            for at in vector_starts(simd) {
                let slip = Vector::load(simd, open, at) - Vector::load(simd, before, at);
                heat = slip.times_plus(Vector::load(simd, tension, at), heat);
            }
        }
        heat.sum()
    }

    /// Lets those of some panels that pull open, and those slip that friction does not hold, all at once. Returns which springs have moved,
    /// a bit for each, and whether that changed a tension by more than `still` [N].
    #[inline(always)]
    fn release<S: Simd>(
        &self,
        simd: S,
        hold: &mut SeatState,
        tension: &mut [Row],
        moves: &mut Vec<(usize, f64)>,
        these: &Row,
        still: f64,
    ) -> (u128, bool) {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, friction) = (all(0.0), all(self.friction));
        let groups = self.padded / LANES;
        let (mut moved, mut far) = (0_u128, 0);
        let mut changes = [0.0; u128::BITS as usize];
        for across in 0..groups {
            let along = groups + across;
            for at in vector_starts(simd) {
                let of = |rows: &[Row], n: usize| Vector::load(simd, &rows[n], at);
                let gap = |of: &[f64], n: usize| Vector::load(simd, of, LANES * n + at);
                let these = Vector::load(simd, these, at);
                let pulls = of(tension, across) - of(&self.pressed, across);
                let had = gap(&hold.open, across);
                let opens = pulls.times_plus(of(&self.per_own, across), had).max(zero) - had;
                let loses = opens * of(&self.own, across);
                // Held where it was before, and let go by what friction cannot hold: what slips first must not slip too far.
                let limit = friction * (loses - pulls).max(zero);
                let was = gap(&hold.open, along);
                let held = (was - gap(&hold.before, along)) * of(&self.own, along);
                let holding = of(tension, along) + held;
                let gives = holding - holding.min(limit).max(-limit) - held;
                let slips = these * (gives * of(&self.per_own, along));
                let opens = these * opens;
                let most = these * loses.max(-loses).max(gives.max(-gives));
                (had + opens).store(&mut hold.open, LANES * across + at);
                (was + slips).store(&mut hold.open, LANES * along + at);
                (-opens).store(&mut changes, LANES * across + at);
                (-slips).store(&mut changes, LANES * along + at);
                let opening = zero.bits_below(opens.max(-opens));
                let slipping = zero.bits_below(slips.max(-slips));
                moved |= u128::from(opening) << (LANES * across + at);
                moved |= u128::from(slipping) << (LANES * along + at);
                far |= all(still).bits_below(most);
            }
        }
        let moves = listed(moves, moved, |spring| changes[spring]);
        add_all(simd, tension, &self.stiffness, moves);
        (moved, far != 0)
    }

    /// What follows from the springs that have opened and slipped in this step, a bit for each: what all tensions have lost, and what is done
    /// to the modes.
    #[inline(always)]
    fn accumulate<S: Simd>(&self, simd: S, hold: &mut SeatState, moves: &mut Vec<(usize, f64)>, moved: u128) {
        let SeatState { open, before, lost, push, .. } = hold;
        let moves = listed(moves, moved, |spring| open[spring] - before[spring]);
        add_all(simd, lost.as_chunks_mut::<LANES>().0, &self.stiffness, moves.clone());
        add_all(simd, push.as_chunks_mut::<LANES>().0, &self.by_spring, moves);
    }

    /// Energy of the seat beyond that of one that holds, less the work of rollers [J].
    #[inline(always)]
    fn stored<S: Simd>(&self, simd: S, hold: &SeatState, tension: &[Row]) -> f64 {
        let (zero, half) = (Vector::all(simd, 0.0), Vector::all(simd, 0.5));
        let (open, lost) = (hold.open.as_chunks::<LANES>().0, hold.lost.as_chunks::<LANES>().0);
        let mut sum = zero;
        for (n, (open, lost)) in open.iter().zip(lost).enumerate() {
            for at in vector_starts(simd) {
                let pressed = match self.pressed.get(n) {
                    Some(pressed) => Vector::load(simd, pressed, at),
                    None => zero,
                };
                let held = half.times_plus(Vector::load(simd, lost, at), Vector::load(simd, &tension[n], at));
                sum = Vector::load(simd, open, at).times_plus(pressed - held, sum);
            }
        }
        sum.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A seat of one panel and two modes, the first of which opens it and the second shifts it: 1 N/µm each, pressed by 100 N.
    fn one_panel(friction: f64) -> (Springs, SeatState) {
        let padded = LANES;
        let n = 2 * padded;
        let (mut tension, mut stiffness) = (vec![0.0; n * LANES], vec![0.0; n * n]);
        (tension[0], tension[n + padded]) = (1e6, 1e6);
        (stiffness[0], stiffness[padded * n + padded]) = (1e6, 1e6);
        let mut pressed = vec![0.0; padded];
        pressed[0] = 100.0;
        let seat = Seat {
            panels: 1,
            padded,
            pressed,
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
        let springs = Springs::new(&seat, LANES, friction, 1e-6);
        let hold = springs.at_rest(LANES, 0);
        (springs, hold)
    }

    /// Heat of a step, energy and tensions across and along at the coordinates of both modes [m].
    fn at(springs: &Springs, hold: &mut SeatState, q: [f64; 2]) -> [f64; 4] {
        let mut all = vec![0.0; LANES];
        all[..2].copy_from_slice(&q);
        let mut tension = vec![Row::default(); springs.rows()];
        let mut responses = RollerResponses::default();
        let moved = springs.extrapolate(Scalar::new(), hold);
        springs.tensions(Scalar::new(), hold, moved, &all, &mut responses, &mut tension);
        let heat = springs.settle(Scalar::new(), hold, moved, &mut tension, &mut responses, springs.in_step);
        [
            heat,
            springs.stored(Scalar::new(), hold, &tension),
            tension[0][0] - springs.pressed[0][0],
            tension[1][0],
        ]
    }

    /// A spring and a slider in series: 4 µN (A − µN/k) of heat in a cycle of the amplitude A.
    /// Source: own, the area of the loop; a Jenkins element.
    #[test]
    fn analytic_a_panel_that_slips_back_and_forth_turns_the_area_of_its_loop_into_heat() {
        let (springs, mut hold) = one_panel(0.2);
        let (amplitude, limit, stiffness) = (100e-6, 20.0, 1e6);
        let mut heat = 0.0;
        let cycle = |hold: &mut SeatState, heat: &mut f64| {
            for n in 0..4000 {
                let shift = amplitude * (std::f64::consts::TAU * n as f64 / 4000.0).sin();
                let [of_step, _, _, along] = at(&springs, hold, [0.0, shift]);
                *heat += of_step;
                assert!(along.abs() <= limit * (1.0 + 1e-12), "{along} N");
            }
        };
        cycle(&mut hold, &mut heat);
        let first = heat;
        cycle(&mut hold, &mut heat);
        let expected = 4.0 * limit * (amplitude - limit / stiffness);
        let found = heat - first;
        assert!((found / expected - 1.0).abs() < 2e-3, "{found} J, {expected} J");
    }

    /// What opens lets go of all tension, and takes the energy of the springs along: nothing is lost on the way there and back.
    #[test]
    fn analytic_a_panel_opens_where_it_would_pull() {
        let (springs, mut hold) = one_panel(0.2);
        // 100 N over 1 N/µm: it opens 100 µm off.
        let [heat, stored, across, _] = at(&springs, &mut hold, [150e-6, 0.0]);
        assert!(across.abs() < 1e-9 && heat == 0.0, "{across} N, {heat} J");
        assert!((hold.open[0] - 50e-6).abs() < 1e-15, "{}", hold.open[0]);
        // A spring that holds would have ½k (50 µm)² more than one that lets go.
        assert!((stored + 0.5 * 1e6 * 50e-6_f64.powi(2)).abs() < 1e-12, "{stored} J");
        let [_, stored, across, _] = at(&springs, &mut hold, [50e-6, 0.0]);
        assert!(stored == 0.0 && hold.open[0] == 0.0, "{stored} J");
        assert!((across + 50.0).abs() < 1e-9, "{across} N");
    }
}
