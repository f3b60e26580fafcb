//! What is sampled: the channels of the full model, from modes and rigid bodies.

use serde::{Deserialize, Serialize};
use stribeck_simd::lanes::LANES;

use crate::{
    bearing::Bearing,
    heard::Heard,
    row::Row,
    seat::{Hold, Seat},
    state::State,
    step::Scratch,
};

/// What the recorder carries from sample to sample.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Memory {
    /// Velocity of each sensor at the last sample [m/s].
    velocity: Vec<[f64; 2]>,
}

impl Memory {
    /// Whether it may belong to this bearing.
    pub(crate) fn fits(&self, bearing: &Bearing) -> bool {
        self.velocity.len() == bearing.reduction.sensors.len()
    }
}

/// Velocity of each sensor before the last step.
#[derive(Debug, Clone, Default)]
pub(crate) struct Before {
    velocity: Vec<[f64; 2]>,
}

impl Bearing {
    /// Memory before the first step.
    pub(crate) fn first_memory(&self, state: &State) -> Memory {
        Memory { velocity: self.modal_velocity(state) }
    }

    /// Velocities of the sensors with the modes alone.
    fn modal_velocity(&self, state: &State) -> Vec<[f64; 2]> {
        let r = self.reduction.padded;
        let of = |shape: &[f64]| product(shape, &state.v);
        self.reduction.sensors.iter().map(|s| [of(&s.shape[..r]), of(&s.shape[r..])]).collect()
    }

    /// Displacement of a sensor beyond the modes by what the rollers press.
    fn residual(&self, sensor: usize, heard: &[Heard]) -> [f64; 2] {
        let residual = &self.reduction.sensors[sensor].residual;
        let mut sum = [0.0; 2];
        for h in heard.iter().filter(|h| h.force != 0.0) {
            let a = h.facet as usize;
            let b = if a + 1 == residual.len() { 0 } else { a + 1 };
            for (c, sum) in sum.iter_mut().enumerate() {
                *sum += h.force * (residual[a][c] + h.share * (residual[b][c] - residual[a][c]));
            }
        }
        sum
    }

    /// Displacement of the sensors beyond the modes by the seat [m].
    pub(crate) fn heard_from_the_seat<'a>(
        &'a self,
        hold: &'a Hold,
        tension: &'a [Row],
    ) -> impl Iterator<Item = [f64; 2]> + 'a {
        let of_sensor = move |seat: &'a Seat, heard: &'a Vec<[f64; 2]>| {
            // Across the seat by what is missing where it is open, along it by what holds.
            let (across, along) = heard.split_at(seat.padded);
            let [mut x, mut y] = weighed(&tension[seat.padded / LANES..], along);
            let open = seat.across.iter().zip(&hold.open).zip(across);
            for ((stiffness, open), [hx, hy]) in open.filter(|((_, open), _)| **open != 0.0) {
                [x, y] = [x - stiffness * open * hx, y - stiffness * open * hy];
            }
            [x, y]
        };
        let seat = self.reduction.springs.iter();
        seat.flat_map(move |seat| seat.heard.iter().map(move |heard| of_sensor(seat, heard)))
    }

    /// Where the sensors are before the last step of a sample.
    pub(crate) fn before_last_step(&self, state: &State) -> Before {
        Before { velocity: self.modal_velocity(state) }
    }

    /// The row of one sample.
    pub(crate) fn row(
        &self,
        state: &State,
        scratch: &Scratch,
        before: &Before,
        memory: &mut Memory,
        row: &mut Vec<f64>,
    ) {
        let dt = self.time_step;
        let interval = dt * scratch.summed as f64;
        row.clear();
        row.push(state.steps as f64 * dt);
        let modal = self.modal_velocity(state);
        let seated: Vec<[f64; 2]> = state
            .seat
            .iter()
            .flat_map(|hold| self.heard_from_the_seat(hold, &scratch.modes.tension))
            .collect();
        for (i, now) in modal.iter().enumerate() {
            // The velocity beyond the modes is that of the last step.
            let [new, old] = [&scratch.heard, &scratch.before].map(|heard| self.residual(i, heard));
            let [seat_now, seat_before] =
                [&seated, &scratch.seated].map(|of| of.get(i).copied().unwrap_or_default());
            let now: [f64; 2] =
                std::array::from_fn(|c| now[c] + (new[c] - old[c] + seat_now[c] - seat_before[c]) / dt);
            row.extend((0..2).map(|c| (now[c] - memory.velocity[i][c]) / interval));
            row.extend((0..2).map(|c| (modal[i][c] - before.velocity[i][c]) / dt));
            memory.velocity[i] = now;
        }
        let steps = scratch.summed as f64;
        for i in 0..self.rollers {
            row.extend([state.x[i], state.y[i], state.angle[i]]);
            let (sums, lane) = (&scratch.blocks[i / LANES].sums, i % LANES);
            let kinds = if self.cage.is_some() { 3 } else { 2 };
            row.extend(sums[..kinds].iter().flatten().map(|sum| sum[lane] / steps));
            if let (Some(oil), Some(films)) = (&self.oil, &state.films) {
                row.extend(oil.raceways.iter().zip(&films.at).map(|(race, films)| race.thickness(films, i)));
            }
        }
        if self.cage.is_some() {
            let centre = self.reduction.cage.map_or([0.0; 2], |cage| cage.1);
            row.extend([centre[0] + state.cage[0], centre[1] + state.cage[1], state.cage[2]]);
        }
        row.extend(self.seat_force(&scratch.modes.tension).into_iter().flatten());
        row.extend(self.tacho.sample(state.steps as f64 * dt));
    }

    /// Force of the housing on the outer ring that sits in it [N].
    fn seat_force(&self, tension: &[Row]) -> Option<[f64; 2]> {
        let at_rest = self.reduction.seat?;
        let more = self.reduction.springs.as_ref().map_or([0.0; 2], |seat| weighed(tension, &seat.on_ring));
        Some([at_rest[0] + more[0], at_rest[1] + more[1]])
    }
}

/// Sum of all products of two numbers, in eight sums that need not wait for each other.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum()
}

/// Sum of vectors, each times its number.
fn weighed(rows: &[Row], vectors: &[[f64; 2]]) -> [f64; 2] {
    let mut sums = [[0.0; 2]; LANES];
    for (row, vectors) in rows.iter().zip(vectors.as_chunks::<LANES>().0) {
        for lane in 0..LANES {
            sums[lane][0] += vectors[lane][0] * row[lane];
            sums[lane][1] += vectors[lane][1] * row[lane];
        }
    }
    sums.iter().fold([0.0; 2], |[x, y], [sx, sy]| [x + sx, y + sy])
}
