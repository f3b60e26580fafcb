//! Samples of the full model: forces summed over the steps of an interval, places and velocities at its end.

use std::f64::consts::TAU;

use crate::bearing::assembly::BearingSystem;
use crate::run::channels::{CageSample, RollerSample, Sample, SensorSample};
use serde::{Deserialize, Serialize};
use stribeck_scene::resolved::ResolvedScene;

/// Sums between samples, and the sample made of them.
#[derive(Debug)]
pub(super) struct Recorder {
    memory: Memory,
    /// Velocity of each sensor before the last step [m/s].
    before_step: Vec<[f64; 2]>,
    /// Resultant of each contact pair, summed over the steps since the last sample [N].
    contact: Vec<[f64; 2]>,
    /// Force of each oil film, summed likewise [N].
    film: Vec<[f64; 2]>,
    steps: usize,
    sample: Sample,
}

/// State between samples: the recorder's part of a checkpoint.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Memory {
    /// Node of each sensor, chosen at the start.
    sensors: Vec<u32>,
    /// Velocity of each sensor [m/s].
    at_sample: Vec<[f64; 2]>,
    /// Angle of each roller's rim, and by how much it has turned since the start [rad].
    rim_angle: Vec<f64>,
    spin: Vec<f64>,
}

impl Recorder {
    pub(super) fn new(scene: &ResolvedScene, bearing: &BearingSystem) -> Self {
        let sensors = bearing.nodes_on_back(&scene.sensor_angles);
        let rollers = bearing.rollers.len();
        let memory = Memory {
            at_sample: sensors.iter().map(|&n| velocity(bearing, n)).collect(),
            sensors,
            rim_angle: (0..rollers).map(|i| rim_angle(bearing, i)).collect(),
            spin: vec![0.0; rollers],
        };
        Self::with(scene, memory, bearing)
    }

    /// A recorder that continues; `None` when the memory is that of another bearing.
    pub(super) fn resume(scene: &ResolvedScene, bearing: &BearingSystem, memory: Memory) -> Option<Self> {
        let nodes = bearing.system.node_count();
        let fits = memory.sensors.iter().all(|&n| (n as usize) < nodes)
            && memory.at_sample.len() == memory.sensors.len()
            && [&memory.rim_angle, &memory.spin].iter().all(|v| v.len() == bearing.rollers.len());
        fits.then(|| Self::with(scene, memory, bearing))
    }

    fn with(scene: &ResolvedScene, memory: Memory, bearing: &BearingSystem) -> Self {
        Self {
            before_step: vec![[0.0; 2]; memory.sensors.len()],
            memory,
            contact: vec![[0.0; 2]; bearing.system.resultants().count()],
            film: vec![[0.0; 2]; bearing.system.films().count()],
            steps: 0,
            sample: Sample::of(scene),
        }
    }

    /// State to continue from after a sample.
    pub(super) fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Before the last step of an interval.
    pub(super) fn before_step(&mut self, bearing: &BearingSystem) {
        for (before, &n) in self.before_step.iter_mut().zip(&self.memory.sensors) {
            *before = velocity(bearing, n);
        }
    }

    /// After every step: adds up the forces that acted in it.
    pub(super) fn after_step(&mut self, bearing: &BearingSystem) {
        for (sum, pair) in self.contact.iter_mut().zip(bearing.system.resultants()) {
            *sum = add(*sum, pair.force);
        }
        for (sum, film) in self.film.iter_mut().zip(bearing.system.films()) {
            *sum = add(*sum, film.force);
        }
        self.steps += 1;
    }

    /// The sample at the end of an interval; resets the sums.
    pub(super) fn sample(&mut self, bearing: &BearingSystem) -> &Sample {
        self.sample.time = bearing.system.time();
        self.sensors(bearing);
        self.rollers(bearing);
        if let Some(cage) = &mut self.sample.cage
            && let Some(at) = bearing.cage.and_then(|body| bearing.system.rigid(body))
        {
            *cage = CageSample { centre: at.centre, angle: at.angle };
        }
        self.sample.seat = bearing.pairs.seat().map(|seat| self.mean_contact(seat));
        self.contact.fill([0.0; 2]);
        self.film.fill([0.0; 2]);
        self.steps = 0;
        &self.sample
    }

    fn sensors(&mut self, bearing: &BearingSystem) {
        let dt = bearing.system.time_step();
        let interval = dt * self.steps as f64;
        let Memory { sensors, at_sample, .. } = &mut self.memory;
        let of_each = sensors.iter().zip(at_sample).zip(&self.before_step).zip(&mut self.sample.sensors);
        for (((&node, at_sample), before_step), sensor) in of_each {
            let now = velocity(bearing, node);
            let over = |before: [f64; 2], span: f64| [0, 1].map(|c: usize| (now[c] - before[c]) / span);
            *sensor = SensorSample { mean: over(*at_sample, interval), instant: over(*before_step, dt) };
            *at_sample = now;
        }
    }

    fn rollers(&mut self, bearing: &BearingSystem) {
        let pairs = &bearing.pairs;
        let mut thicknesses = bearing.system.films().map(|film| film.thickness);
        for (i, roller) in bearing.rollers.iter().enumerate() {
            let angle = rim_angle(bearing, i);
            let turned = angle - self.memory.rim_angle[i];
            // Less than half a turn lies between two samples.
            self.memory.spin[i] += turned - TAU * (turned / TAU).round();
            self.memory.rim_angle[i] = angle;
            self.sample.rollers[i] = RollerSample {
                centre: bearing.system.position(roller.centre),
                spin: self.memory.spin[i],
                outer: self.mean_of_raceway(pairs.outer(i), 2 * i),
                inner: self.mean_of_raceway(pairs.inner(i), 2 * i + 1),
                cage: bearing.cage.map(|_| {
                    let sum = pairs.cage(i).fold([0.0; 2], |sum, wall| add(sum, self.contact[wall]));
                    self.over_steps(sum)
                }),
                films: thicknesses.next().zip(thicknesses.next()).map(<[f64; 2]>::from),
            };
        }
    }

    /// Mean force of a raceway on a roller, through contact and oil [N].
    fn mean_of_raceway(&self, pair: usize, film: usize) -> [f64; 2] {
        let contact = self.mean_contact(pair);
        self.film.get(film).map_or(contact, |&sum| add(contact, self.over_steps(sum)))
    }

    fn mean_contact(&self, pair: usize) -> [f64; 2] {
        self.over_steps(self.contact[pair])
    }

    fn over_steps(&self, sum: [f64; 2]) -> [f64; 2] {
        sum.map(|f| f / self.steps as f64)
    }
}

fn add(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// Velocity of a sensor [m/s]: that of its node; for a rigid ring, the ring centre's velocity, because the
/// sensor sits on the housing.
fn velocity(bearing: &BearingSystem, node: u32) -> [f64; 2] {
    bearing.system.rigid(bearing.outer).map_or_else(|| bearing.system.velocity(node), |ring| ring.velocity)
}

/// Angle of the line from a roller's centre to its first rim node [rad].
fn rim_angle(bearing: &BearingSystem, roller: usize) -> f64 {
    let [[cx, cy], [x, y]] =
        [bearing.rollers[roller].centre, bearing.rollers[roller].rim].map(|n| bearing.system.position(n));
    libm::atan2(y - cy, x - cx)
}
