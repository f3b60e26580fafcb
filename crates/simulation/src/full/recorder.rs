//! Samples of the full model: forces summed over the steps of an interval, places and velocities at its end.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};
use stribeck_bearing::assembly::Machine;
use stribeck_run::channels::{CageSample, RollerSample, Sample, SensorSample};
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

/// What a sample needs of the one before: the recorder's part of a checkpoint.
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
    pub(super) fn new(scene: &ResolvedScene, machine: &Machine) -> Self {
        let sensors = machine.nodes_on_back(&scene.sensor_angles);
        let rollers = machine.rollers.len();
        let memory = Memory {
            at_sample: sensors.iter().map(|&n| velocity(machine, n)).collect(),
            sensors,
            rim_angle: (0..rollers).map(|i| rim_angle(machine, i)).collect(),
            spin: vec![0.0; rollers],
        };
        Self::with(scene, memory, machine)
    }

    /// A recorder that continues; `None` when the memory is that of another machine.
    pub(super) fn resume(scene: &ResolvedScene, machine: &Machine, memory: Memory) -> Option<Self> {
        let nodes = machine.system.node_count();
        let fits = memory.sensors.iter().all(|&n| (n as usize) < nodes)
            && memory.at_sample.len() == memory.sensors.len()
            && [&memory.rim_angle, &memory.spin].iter().all(|v| v.len() == machine.rollers.len());
        fits.then(|| Self::with(scene, memory, machine))
    }

    fn with(scene: &ResolvedScene, memory: Memory, machine: &Machine) -> Self {
        Self {
            before_step: vec![[0.0; 2]; memory.sensors.len()],
            memory,
            contact: vec![[0.0; 2]; machine.system.resultants().count()],
            film: vec![[0.0; 2]; machine.system.films().count()],
            steps: 0,
            sample: Sample::of(scene),
        }
    }

    /// What it takes to continue after a sample.
    pub(super) fn memory(&self) -> &Memory {
        &self.memory
    }

    /// Before the last step of an interval.
    pub(super) fn before_step(&mut self, machine: &Machine) {
        for (before, &n) in self.before_step.iter_mut().zip(&self.memory.sensors) {
            *before = velocity(machine, n);
        }
    }

    /// After every step: adds up the forces that acted in it.
    pub(super) fn after_step(&mut self, machine: &Machine) {
        for (sum, pair) in self.contact.iter_mut().zip(machine.system.resultants()) {
            *sum = add(*sum, pair.force);
        }
        for (sum, film) in self.film.iter_mut().zip(machine.system.films()) {
            *sum = add(*sum, film.force);
        }
        self.steps += 1;
    }

    /// The sample at the end of an interval; sums begin anew.
    pub(super) fn sample(&mut self, machine: &Machine) -> &Sample {
        self.sample.time = machine.system.time();
        self.sensors(machine);
        self.rollers(machine);
        if let Some(cage) = &mut self.sample.cage
            && let Some(at) = machine.cage.and_then(|body| machine.system.rigid(body))
        {
            *cage = CageSample { centre: at.centre, angle: at.angle };
        }
        self.sample.seat = machine.pairs.seat().map(|seat| self.mean_contact(seat));
        self.contact.fill([0.0; 2]);
        self.film.fill([0.0; 2]);
        self.steps = 0;
        &self.sample
    }

    fn sensors(&mut self, machine: &Machine) {
        let dt = machine.system.time_step();
        let interval = dt * self.steps as f64;
        let Memory { sensors, at_sample, .. } = &mut self.memory;
        let of_each = sensors.iter().zip(at_sample).zip(&self.before_step).zip(&mut self.sample.sensors);
        for (((&node, at_sample), before_step), sensor) in of_each {
            let now = velocity(machine, node);
            let over = |before: [f64; 2], span: f64| [0, 1].map(|c: usize| (now[c] - before[c]) / span);
            *sensor = SensorSample { mean: over(*at_sample, interval), instant: over(*before_step, dt) };
            *at_sample = now;
        }
    }

    fn rollers(&mut self, machine: &Machine) {
        let pairs = &machine.pairs;
        let mut thicknesses = machine.system.films().map(|film| film.thickness);
        for (i, roller) in machine.rollers.iter().enumerate() {
            let angle = rim_angle(machine, i);
            let turned = angle - self.memory.rim_angle[i];
            // Less than half a turn lies between two samples.
            self.memory.spin[i] += turned - TAU * (turned / TAU).round();
            self.memory.rim_angle[i] = angle;
            self.sample.rollers[i] = RollerSample {
                centre: machine.system.position(roller.centre),
                spin: self.memory.spin[i],
                outer: self.mean_of_raceway(pairs.outer(i), 2 * i),
                inner: self.mean_of_raceway(pairs.inner(i), 2 * i + 1),
                cage: machine.cage.map(|_| {
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
fn velocity(machine: &Machine, node: u32) -> [f64; 2] {
    machine.system.rigid(machine.outer).map_or_else(|| machine.system.velocity(node), |ring| ring.velocity)
}

/// Angle of the line from a roller's centre to its first rim node [rad].
fn rim_angle(machine: &Machine, roller: usize) -> f64 {
    let [[cx, cy], [x, y]] =
        [machine.rollers[roller].centre, machine.rollers[roller].rim].map(|n| machine.system.position(n));
    (y - cy).atan2(x - cx)
}
