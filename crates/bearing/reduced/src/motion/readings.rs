//! Readings of a bearing in motion at the end of a sampling interval. Forces are means over the interval.

use pulp::Scalar;
use serde::{Deserialize, Serialize};
use stribeck_simd::lanes::LANES;

use crate::{
    bearing::Bearing,
    motion::BearingInMotion,
    row::{Row, Rows},
    sensors::SensorMotion,
    state::State,
    step::Scratch,
};

/// Acceleration at a sensor [m/s²].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SensorReading {
    /// Mean over the interval: the change of velocity over its length.
    pub mean: [f64; 2],
    /// In the last step alone.
    pub instant: [f64; 2],
}

/// A roller: its position, and the forces on it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RollerReading {
    /// Centre [m].
    pub centre: [f64; 2],
    /// Angle by which it has turned since the start [rad].
    pub spin: f64,
    /// Force of the outer raceway on it [N], by contact and oil.
    pub outer: [f64; 2],
    /// Force of the inner raceway on it [N], by contact and oil.
    pub inner: [f64; 2],
    /// Force of the cage on it [N]; zero without a cage.
    pub cage: [f64; 2],
    /// Thickness of the oil on the outer and on the inner raceway [m], if there is oil.
    pub films: Option<[f64; 2]>,
}

/// Velocity of each sensor at the last sample [m/s].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Memory {
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
        let mut motion = SensorMotion::default();
        self.sensors.measure_modes(Scalar::new(), state, &mut motion);
        let of = |sensor: usize| [motion.velocity(2 * sensor), motion.velocity(2 * sensor + 1)];
        Memory { velocity: (0..self.reduction.sensors.len()).map(of).collect() }
    }

    /// Readings of the sensors at the end of an interval.
    pub(crate) fn read_sensors(
        &self,
        scratch: &Scratch,
        memory: &mut Memory,
        readings: &mut [SensorReading],
    ) {
        let dt = self.time_step;
        let interval = dt * scratch.summed as f64;
        let (now, before) = (&scratch.now, &scratch.before);
        for (sensor, (last, reading)) in memory.velocity.iter_mut().zip(readings).enumerate() {
            let components = [2 * sensor, 2 * sensor + 1];
            // The velocity beyond the modes is that of the last step.
            let velocity = components.map(|c| now.velocity(c) + (now.beyond(c) - before.beyond(c)) / dt);
            *reading = SensorReading {
                mean: [0, 1].map(|c: usize| (velocity[c] - last[c]) / interval),
                instant: components.map(|c| (now.velocity(c) - before.velocity(c)) / dt),
            };
            *last = velocity;
        }
    }
}

impl BearingInMotion {
    /// Readings of the sensors, in the order of the reduction's.
    pub fn sensors(&self) -> &[SensorReading] {
        &self.sensors
    }

    /// Centres of the rollers in their order [m].
    #[inline]
    pub fn centres(&self) -> impl Iterator<Item = [f64; 2]> {
        self.saved.state.x.iter().zip(&self.saved.state.y).map(|(x, y)| [*x, *y])
    }

    /// Rollers in their order.
    #[inline]
    pub fn rollers(&self) -> impl Iterator<Item = RollerReading> {
        let (state, scratch) = (&self.saved.state, &self.scratch);
        let steps = scratch.summed as f64;
        (0..self.bearing.rollers.count).map(move |i| {
            let (sums, lane) = (&scratch.blocks[i / LANES].sums, i % LANES);
            let mean = |sum: &Rows| [sum[0][lane] / steps, sum[1][lane] / steps];
            let [outer, inner, cage] = sums;
            let thickness = |side: usize| {
                let (oil, films) = (self.bearing.oil.as_ref()?, state.films.as_ref()?);
                Some(oil.raceways[side].thickness(&films.at[side], i))
            };
            RollerReading {
                centre: [state.x[i], state.y[i]],
                spin: state.angle[i],
                outer: mean(outer),
                inner: mean(inner),
                cage: mean(cage),
                films: thickness(0).zip(thickness(1)).map(<[f64; 2]>::from),
            }
        })
    }

    /// Centre of mass of the cage [m] and the angle by which it has turned [rad], if there is a cage.
    pub fn cage(&self) -> Option<([f64; 2], f64)> {
        self.bearing.cage.as_ref()?;
        let centre = self.bearing.reduction.cage.map_or([0.0; 2], |cage| cage.1);
        let [x, y, angle] = self.saved.state.cage;
        Some(([centre[0] + x, centre[1] + y], angle))
    }

    /// Displacement of the cage's centre since it lay in the middle [m].
    pub fn cage_offset(&self) -> Option<[f64; 2]> {
        let [x, y, _] = self.saved.state.cage;
        self.bearing.cage.as_ref().map(|_| [x, y])
    }

    /// Angular velocity of the cage in the last step [rad/s], counter-clockwise positive.
    pub fn cage_rad_s(&self) -> f64 {
        self.saved.state.cage_velocity[2]
    }

    /// Largest force of the cage on a roller [N], mean over the interval.
    pub fn largest_cage_force(&self) -> f64 {
        let square =
            |[x, y]: &Rows| (0..LANES).map(|lane| x[lane].powi(2) + y[lane].powi(2)).fold(0.0, f64::max);
        let most = self.scratch.blocks.iter().map(|block| square(&block.sums[2])).fold(0.0, f64::max);
        most.sqrt() / self.scratch.summed as f64
    }

    /// Force of the housing on the outer ring that sits in it [N].
    pub fn seat(&self) -> Option<[f64; 2]> {
        let at_rest = self.bearing.reduction.seat?;
        let tension = &self.scratch.modes.tension;
        let springs = self.bearing.reduction.springs.as_ref();
        let more = springs.map_or([0.0; 2], |seat| weighed(tension, &seat.on_ring));
        Some([at_rest[0] + more[0], at_rest[1] + more[1]])
    }

    /// Largest normal force of the outer raceway on a roller, by contact or by oil [N].
    pub fn largest_outer_force(&self) -> f64 {
        let state = &self.saved.state;
        let by_oil = state.films.as_ref().map_or(0.0, |films| films.most_at_outer());
        state.force[0].iter().copied().fold(by_oil, f64::max)
    }

    /// Deepest penetration in the interval [m].
    pub fn deepest(&self) -> f64 {
        self.scratch.deepest
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
