//! What is sampled: the channels of the full model, from modes and rigid bodies.

use pulp::Scalar;
use serde::{Deserialize, Serialize};
use stribeck_simd::lanes::LANES;

use crate::{
    bearing::Bearing,
    rollers::row::{Row, Rows},
    sensors::SensorMotion,
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

impl Bearing {
    /// Memory before the first step.
    pub(crate) fn first_memory(&self, state: &State) -> Memory {
        let mut sound = SensorMotion::default();
        self.sensors.measure_modes(Scalar::new(), state, &mut sound);
        let of = |sensor: usize| [sound.velocity(2 * sensor), sound.velocity(2 * sensor + 1)];
        Memory { velocity: (0..self.reduction.sensors.len()).map(of).collect() }
    }

    /// The row of one sample.
    pub(crate) fn row(&self, state: &State, scratch: &Scratch, memory: &mut Memory, row: &mut Vec<f64>) {
        let dt = self.time_step;
        let interval = dt * scratch.summed as f64;
        row.clear();
        row.push(state.steps as f64 * dt);
        let (now, before) = (&scratch.now, &scratch.before);
        for (sensor, last) in memory.velocity.iter_mut().enumerate() {
            let components = [2 * sensor, 2 * sensor + 1];
            // The velocity beyond the modes is that of the last step.
            let velocity = components.map(|c| now.velocity(c) + (now.beyond(c) - before.beyond(c)) / dt);
            row.extend((0..2).map(|c| (velocity[c] - last[c]) / interval));
            row.extend(components.map(|c| (now.velocity(c) - before.velocity(c)) / dt));
            *last = velocity;
        }
        let steps = scratch.summed as f64;
        for i in 0..self.rollers {
            row.extend([state.x[i], state.y[i], state.angle[i]]);
            let (sums, lane) = (&scratch.blocks[i / LANES].sums, i % LANES);
            let mean = |sum: &Rows| [sum[0][lane] / steps, sum[1][lane] / steps];
            let [outer, inner, cage] = sums;
            row.extend(mean(outer));
            row.extend(mean(inner));
            if self.cage.is_some() {
                row.extend(mean(cage));
            }
            if let (Some(oil), Some(films)) = (&self.oil, &state.films) {
                row.extend(oil.raceways.iter().zip(&films.at).map(|(race, films)| race.thickness(films, i)));
            }
        }
        if self.cage.is_some() {
            let centre = self.reduction.cage.map_or([0.0; 2], |cage| cage.1);
            row.extend([centre[0] + state.cage[0], centre[1] + state.cage[1], state.cage[2]]);
        }
        row.extend(self.seat_force(&scratch.modes.tension).into_iter().flatten());
    }

    /// Force of the housing on the outer ring that sits in it [N].
    fn seat_force(&self, tension: &[Row]) -> Option<[f64; 2]> {
        let at_rest = self.reduction.seat?;
        let more = self.reduction.springs.as_ref().map_or([0.0; 2], |seat| weighed(tension, &seat.on_ring));
        Some([at_rest[0] + more[0], at_rest[1] + more[1]])
    }
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
