//! What sensors hear: the modes, and beyond them what rollers press and what the seat does (THEORY §9.1).

use stribeck_simd::lanes::LANES;

use crate::{heard::Heard, reduction::Reduction, row::Row, seat::Hold, state::State};

/// What moves sensors, each with the components of all of them side by side: x and y of the first, then of the next one.
#[derive(Debug, Clone)]
pub(crate) struct Sensors {
    components: usize,
    /// By a unit of each mode [1/√kg].
    by_mode: Vec<f64>,
    /// Beyond the modes by a unit force towards the outside at each vertex of the raceway [m/N].
    by_vertex: Vec<f64>,
    /// The same by a unit gap of each panel of the seat [1], whose tension is missing then, and by a unit tension along it [m/N].
    by_gap: Vec<f64>,
    by_tension: Vec<f64>,
}

/// What they hear at a time, all components.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sound {
    /// Velocity with the modes [m/s].
    pub(crate) velocity: Vec<f64>,
    /// Displacement beyond them [m].
    pub(crate) beyond: Vec<f64>,
}

impl Sensors {
    pub(crate) fn new(reduction: &Reduction) -> Self {
        let Reduction { sensors, springs, padded, .. } = reduction;
        let vertices = sensors.first().map_or(0, |sensor| sensor.residual.len());
        let by_mode = (0..*padded)
            .flat_map(|mode| sensors.iter().flat_map(move |s| [s.shape[mode], s.shape[padded + mode]]));
        let by_vertex = (0..vertices).flat_map(|vertex| sensors.iter().flat_map(move |s| s.residual[vertex]));
        let (mut by_gap, mut by_tension) = (Vec::new(), Vec::new());
        if let Some(seat) = springs {
            for panel in 0..seat.panels {
                let of = |spring: usize| seat.heard.iter().flat_map(move |heard| heard[spring]);
                by_gap.extend(of(panel).map(|heard| -seat.across[panel] * heard));
                by_tension.extend(of(seat.padded + panel));
            }
        }
        Self {
            components: 2 * sensors.len(),
            by_mode: by_mode.collect(),
            by_vertex: by_vertex.collect(),
            by_gap,
            by_tension,
        }
    }

    /// Velocities with the modes [m/s].
    pub(crate) fn velocities(&self, state: &State, velocity: &mut Vec<f64>) {
        velocity.clear();
        velocity.resize(self.components, 0.0);
        for (mode, v) in self.rows(&self.by_mode).zip(&state.v) {
            add(velocity, mode, *v);
        }
    }

    /// What they hear while rollers press as `heard` and the seat has these tensions [N].
    pub(crate) fn hear(&self, state: &State, heard: &[Heard], tension: &[Row], sound: &mut Sound) {
        self.velocities(state, &mut sound.velocity);
        let beyond = &mut sound.beyond;
        beyond.clear();
        beyond.resize(self.components, 0.0);
        let n = self.components;
        for roller in heard.iter().filter(|roller| roller.force != 0.0) {
            let first = n * roller.facet as usize;
            let second = if first + n == self.by_vertex.len() { 0 } else { first + n };
            let of_second = roller.share * roller.force;
            add(beyond, &self.by_vertex[first..first + n], roller.force - of_second);
            add(beyond, &self.by_vertex[second..second + n], of_second);
        }
        let Some(Hold { open, .. }) = &state.seat else { return };
        for (row, open) in self.rows(&self.by_gap).zip(open).filter(|(_, open)| **open != 0.0) {
            add(beyond, row, *open);
        }
        let along = tension[open.len() / (2 * LANES)..].iter().flat_map(|row| row.iter());
        for (row, tension) in self.rows(&self.by_tension).zip(along) {
            add(beyond, row, *tension);
        }
    }

    fn rows<'a>(&self, table: &'a [f64]) -> impl Iterator<Item = &'a [f64]> {
        table.chunks_exact(self.components.max(1))
    }
}

/// Adds a multiple of a row.
#[inline(always)]
fn add(sums: &mut [f64], row: &[f64], times: f64) {
    for (sum, number) in sums.iter_mut().zip(row) {
        *sum += number * times;
    }
}
