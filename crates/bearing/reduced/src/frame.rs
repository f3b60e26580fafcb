//! Where the shaft is between two communication points, and the frame that moves along with it.

use serde::{Deserialize, Serialize};

use crate::{
    cage::Cage,
    rollers::{Rollers, block::Block},
};

/// Displacement of a shaft from the centre of its housing [m] and its velocity relative to the ground [m/s],
/// x and y.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ShaftPoint {
    /// Displacement.
    pub displacement: [f64; 2],
    /// Velocity.
    pub velocity: [f64; 2],
}

/// Path between two communication points: the cubic with their displacements and velocities (Hermite).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Segment {
    from: ShaftPoint,
    to: ShaftPoint,
    /// Time between them [s].
    length: f64,
}

impl Segment {
    /// Displacement after a time [s] since the first point [m].
    fn at(&self, time: f64) -> [f64; 2] {
        let Self { from, to, length } = self;
        let s = (time / length).clamp(0.0, 1.0);
        [0, 1].map(|c: usize| {
            let (a, b) = (from.displacement[c], to.displacement[c]);
            let [along, ahead] = [length * from.velocity[c], length * to.velocity[c]];
            let way = b - a;
            a + s * (along + s * (3.0 * way - 2.0 * along - ahead + s * (along + ahead - 2.0 * way)))
        })
    }
}

/// The frame that moves along with the shaft, as leapfrog has it: its velocity is that between two positions,
/// so that rollers do in it exactly what they do in space.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Frame {
    segment: Segment,
    /// Time of the bearing since the first point of the segment [s]; not positive before its first step.
    elapsed: f64,
    /// Displacement of the shaft [m], and its velocity half a step earlier [m/s].
    displacement: [f64; 2],
    rate: [f64; 2],
    /// Velocity when the communication step began [m/s].
    rate_before: [f64; 2],
    /// Acceleration in this step [m/s²].
    pub(crate) acceleration: [f64; 2],
    /// Force of the inner raceway on all rollers in the last two steps [N], the last one first.
    forces: Option<[[f64; 2]; 2]>,
}

impl Frame {
    /// Along with a shaft that is there.
    pub(crate) fn at(shaft: ShaftPoint) -> Self {
        Self {
            segment: Segment { from: shaft, to: shaft, length: 0.0 },
            displacement: shaft.displacement,
            rate: shaft.velocity,
            rate_before: shaft.velocity,
            ..Self::default()
        }
    }

    /// Begins a communication step of `length` [s] towards a point: how many steps of `dt` [s] end in it.
    pub(crate) fn begin(&mut self, length: f64, to: ShaftPoint, dt: f64) -> usize {
        // The time that the bearing is behind: less than a step of it.
        self.elapsed -= self.segment.length;
        self.segment = Segment { from: self.segment.to, to, length };
        self.rate_before = self.rate;
        // A quotient of 24.999…9 is 25 steps.
        (((length - self.elapsed) / dt + 1e-6).floor() as usize).max(1)
    }

    /// Moves on by a step of `dt` [s]: the displacement of the shaft after it [m].
    pub(crate) fn advance(&mut self, dt: f64) -> [f64; 2] {
        self.elapsed += dt;
        let next = self.segment.at(self.elapsed);
        let rate = [0, 1].map(|c: usize| (next[c] - self.displacement[c]) / dt);
        self.acceleration = [0, 1].map(|c: usize| (rate[c] - self.rate[c]) / dt);
        (self.displacement, self.rate) = (next, rate);
        next
    }

    /// Keeps the force of the inner raceway on all rollers in this step.
    #[inline(always)]
    pub(crate) fn keep(&mut self, blocks: &[Block]) {
        let now = [0, 1].map(|c: usize| {
            blocks.iter().map(|block| block.force[1][c][..block.count].iter().sum::<f64>()).sum()
        });
        let before = self.forces.map_or(now, |[last, _]| last);
        self.forces = Some([now, before]);
    }

    /// Force on the shaft at the communication point [N]: a step of `dt` [s] has the forces of the positions
    /// before it, which are extrapolated from its last two, because a force that is late drives a rotor.
    pub(crate) fn force(&self, dt: f64) -> [f64; 2] {
        let Some([last, before]) = self.forces else { return [0.0; 2] };
        let late = 1.0 + (self.segment.length - self.elapsed) / dt;
        [0, 1].map(|c: usize| -last[c] - late * (last[c] - before[c]))
    }

    /// Change of its velocity in the communication step [m/s].
    pub(crate) fn gained(&self) -> [f64; 2] {
        [self.rate[0] - self.rate_before[0], self.rate[1] - self.rate_before[1]]
    }

    /// Adds the inertia in this frame to the forces on a group of rollers. Returns the sum of their
    /// velocities.
    #[inline(always)]
    pub(crate) fn pull(&self, rollers: &Rollers, block: &mut Block) -> [f64; 2] {
        let [mass, _] = rollers.inertia;
        [0, 1].map(|c: usize| {
            let force = -mass * self.acceleration[c];
            block.downhill[c][..block.count].iter_mut().for_each(|sum| *sum += force);
            block.velocity[c][..block.count].iter().sum::<f64>()
        })
    }

    /// Work of that force in a step of `dt` [s] on rollers with these sums of velocities before it [J].
    #[inline(always)]
    pub(crate) fn work(&self, rollers: &Rollers, block: &Block, before: [f64; 2], dt: f64) -> f64 {
        let [mass, _] = rollers.inertia;
        let along = |c: usize| {
            self.acceleration[c] * (before[c] + block.velocity[c][..block.count].iter().sum::<f64>())
        };
        -0.5 * dt * mass * (along(0) + along(1))
    }

    /// Adds the inertia to the forces on a cage.
    #[inline(always)]
    pub(crate) fn pull_cage(&self, cage: &Cage, on_cage: &mut [f64; 3]) {
        on_cage.iter_mut().zip(self.acceleration).for_each(|(force, a)| *force -= cage.mass * a);
    }

    /// Work of that force on a cage with the velocities `before` and now [J].
    #[inline(always)]
    pub(crate) fn work_on_cage(&self, cage: &Cage, before: [f64; 3], now: [f64; 3], dt: f64) -> f64 {
        let along = |c: usize| self.acceleration[c] * (before[c] + now[c]);
        -0.5 * dt * cage.mass * (along(0) + along(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, vx: f64) -> ShaftPoint {
        ShaftPoint { displacement: [x, -x], velocity: [vx, -vx] }
    }

    /// x = t³ − 2t² + 3 between t = 1 and 3, which is a cubic itself (THEORY §9.7).
    #[test]
    fn analytic_a_cubic_is_its_own_path() {
        let x = |t: f64| t * t * t - 2.0 * t * t + 3.0;
        let v = |t: f64| 3.0 * t * t - 4.0 * t;
        let segment = Segment { from: point(x(1.0), v(1.0)), to: point(x(3.0), v(3.0)), length: 2.0 };
        for n in 0..=8 {
            let t = 0.25 * f64::from(n);
            let [got, opposite] = segment.at(t);
            assert!((got - x(1.0 + t)).abs() < 1e-13 && got == -opposite, "{t}: {got}");
        }
    }

    /// Communication steps of 2.5 steps: 2, 3, 2, 3 … of them, all on the path, none lost.
    #[test]
    fn by_hand_what_is_left_of_a_communication_step_is_carried_over() {
        let (dt, length, speed) = (1.0, 2.5, 3.0);
        let mut frame = Frame::at(point(0.0, speed));
        let mut taken = Vec::new();
        for n in 1..=4 {
            let steps = frame.begin(length, point(speed * length * f64::from(n), speed), dt);
            for _ in 0..steps {
                frame.advance(dt);
                assert!(frame.acceleration.iter().all(|a| a.abs() < 1e-12), "{:?}", frame.acceleration);
            }
            taken.push(steps);
        }
        assert_eq!(taken, [2, 3, 2, 3]);
        assert!((frame.displacement[0] - 10.0 * speed).abs() < 1e-12, "{:?}", frame.displacement);
    }
}
