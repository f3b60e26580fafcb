//! Motion of the sensors: with the modes, and quasi-statically beyond them under rollers and seat (THEORY
//! §9.1).

use crate::modal::Reduction;
use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{roller_force::RollerForce, row::Row, seat::SeatState, state::State};

/// Responses of the sensors, each with the components of all of them side by side: x and y of the first, then
/// of the next one, filled up with zeros to whole rows.
#[derive(Debug, Clone)]
pub(crate) struct Sensors {
    /// Rows of components.
    rows: usize,
    /// By a unit of each mode [1/√kg].
    by_mode: Vec<Row>,
    /// Beyond the modes by a unit force towards the outside at each vertex of the raceway [m/N].
    by_vertex: Vec<Row>,
    /// The same by a unit gap of each panel of the seat [1], whose tension is missing then, and by a unit
    /// tension along it [m/N].
    by_gap: Vec<Row>,
    by_tension: Vec<Row>,
}

/// Readings at a time, all components.
#[derive(Debug, Clone, Default)]
pub(crate) struct SensorMotion {
    /// Velocity with the modes [m/s].
    velocity: Vec<Row>,
    /// Displacement beyond them [m].
    beyond: Vec<Row>,
}

impl SensorMotion {
    /// Of a component, velocity with the modes [m/s].
    #[inline(always)]
    pub(crate) fn velocity(&self, component: usize) -> f64 {
        self.velocity[component / LANES][component % LANES]
    }

    /// Of a component, displacement beyond them [m].
    #[inline(always)]
    pub(crate) fn beyond(&self, component: usize) -> f64 {
        self.beyond[component / LANES][component % LANES]
    }
}

impl Sensors {
    pub(crate) fn new(reduction: &Reduction) -> Self {
        let Reduction { sensors, springs, padded, .. } = reduction;
        let rows = (2 * sensors.len()).div_ceil(LANES);
        let row_of = |components: &mut dyn Iterator<Item = f64>| {
            let mut filled = vec![Row::default(); rows];
            for (at, component) in components.enumerate() {
                filled[at / LANES][at % LANES] = component;
            }
            filled
        };
        let vertices = sensors.first().map_or(0, |sensor| sensor.residual.len());
        let by_mode = (0..*padded).flat_map(|mode| {
            row_of(&mut sensors.iter().flat_map(|s| [s.shape[mode], s.shape[padded + mode]]))
        });
        let by_vertex =
            (0..vertices).flat_map(|vertex| row_of(&mut sensors.iter().flat_map(|s| s.residual[vertex])));
        let (mut by_gap, mut by_tension) = (Vec::new(), Vec::new());
        if let Some(seat) = springs {
            for panel in 0..seat.panels {
                let of = |spring: usize| seat.at_sensors.iter().flat_map(move |sensor| sensor[spring]);
                by_gap
                    .extend(row_of(&mut of(panel).map(|roller_forces| -seat.across[panel] * roller_forces)));
                by_tension.extend(row_of(&mut of(seat.padded + panel)));
            }
            for table in [&mut by_gap, &mut by_tension] {
                table.resize(rows * seat.padded, Row::default());
            }
        }
        Self { rows, by_mode: by_mode.collect(), by_vertex: by_vertex.collect(), by_gap, by_tension }
    }

    /// Readings at the velocities of a state, under `roller_forces` and these tensions of the seat [N].
    #[inline(always)]
    pub(crate) fn measure<S: Simd>(
        &self,
        simd: S,
        state: &State,
        roller_forces: &[RollerForce],
        tension: &[Row],
        sound: &mut SensorMotion,
    ) {
        let all = |value: f64| Vector::all(simd, value);
        self.measure_modes(simd, state, sound);
        sound.beyond.resize(self.rows, Row::default());
        for (row, beyond) in sound.beyond.iter_mut().enumerate() {
            for at in vector_starts(simd) {
                let of = |table: &[Row], n: usize| Vector::load(simd, &table[self.rows * n + row], at);
                // Four sums, none of which waits for another.
                let (mut ahead, mut behind, mut by_gaps, mut by_tensions) =
                    (all(0.0), all(0.0), all(0.0), all(0.0));
                for roller in roller_forces.iter().filter(|roller| roller.force != 0.0) {
                    let first = roller.facet as usize;
                    let second = if self.rows * (first + 1) == self.by_vertex.len() { 0 } else { first + 1 };
                    let of_second = roller.share * roller.force;
                    ahead = of(&self.by_vertex, first).times_plus(all(roller.force - of_second), ahead);
                    behind = of(&self.by_vertex, second).times_plus(all(of_second), behind);
                }
                if let Some(SeatState { open, .. }) = &state.seat {
                    let across = open.as_chunks::<LANES>().0;
                    let along = &tension[across.len() / 2..];
                    for (eight, (across, along)) in across.iter().zip(along).enumerate() {
                        for (lane, (open, along)) in across.iter().zip(along.iter()).enumerate() {
                            let panel = LANES * eight + lane;
                            by_gaps = of(&self.by_gap, panel).times_plus(all(*open), by_gaps);
                            by_tensions = of(&self.by_tension, panel).times_plus(all(*along), by_tensions);
                        }
                    }
                }
                ((ahead + behind) + (by_gaps + by_tensions)).store(beyond, at);
            }
        }
    }

    /// Velocities with the modes.
    #[inline(always)]
    pub(crate) fn measure_modes<S: Simd>(&self, simd: S, state: &State, sound: &mut SensorMotion) {
        sound.velocity.resize(self.rows, Row::default());
        for (row, velocity) in sound.velocity.iter_mut().enumerate() {
            for at in vector_starts(simd) {
                let of = |mode: usize| Vector::load(simd, &self.by_mode[self.rows * mode + row], at);
                let (mut even, mut odd) = (Vector::all(simd, 0.0), Vector::all(simd, 0.0));
                for (pair, [v, w]) in state.v.as_chunks().0.iter().enumerate() {
                    even = of(2 * pair).times_plus(Vector::all(simd, *v), even);
                    odd = of(2 * pair + 1).times_plus(Vector::all(simd, *w), odd);
                }
                (even + odd).store(velocity, at);
            }
        }
    }
}
