//! What is sampled: sensors, contact forces, places. Column names are a contract with the report.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use stribeck_contact::Resultant;

use crate::assembly::Machine;
use stribeck_scene::duty::Duty;
use stribeck_scene::geometry::Geometry;
use stribeck_scene::scene::Scene;

/// Channel of the shaft's angle.
const SHAFT: &str = "shaft.angle_rad";

/// Channel of the outer ring's angle.
const OUTER_RING: &str = "outer_ring.angle_rad";

/// Channel of the load.
const LOAD: &str = "adapter.load_n";

/// Sums between samples and the channels made of them.
#[derive(Debug)]
pub(crate) struct Recorder {
    memory: Memory,
    /// Velocity of each sensor before the last step.
    before_step: Vec<[f64; 2]>,
    /// Resultant of each pair, summed over the steps since the last sample.
    force: Vec<[f64; 2]>,
    /// The same of each film.
    film: Vec<[f64; 2]>,
    steps: usize,
    row: Vec<f64>,
    tacho: Tacho,
}

/// The channels of a duty that changes: the angle of the shaft, that of an outer ring that turns, and the load where it changes too.
#[derive(Debug, Clone)]
pub struct Tacho {
    /// `None` where nothing changes.
    duty: Option<Duty>,
    outer: bool,
    load: bool,
}

impl Tacho {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        let o = &scene.operation;
        Self { duty: scene.varying_duty(), outer: o.varies() && o.outer_turns(), load: o.load_varies() }
    }

    /// Names of its columns.
    fn names(&self) -> Vec<String> {
        let shaft = self.duty.as_ref().map(|_| SHAFT);
        let channels = [shaft, self.outer.then_some(OUTER_RING), self.load.then_some(LOAD)];
        channels.into_iter().flatten().map(str::to_owned).collect()
    }

    /// Its values at a time [s]: the angles by which the shaft and the outer ring have turned since the start [rad],
    /// counter-clockwise positive, and the load [N].
    pub fn sample(&self, time_s: f64) -> impl Iterator<Item = f64> {
        let angle = self.duty.as_ref().map(|duty| duty.shaft_rad(time_s));
        let outer = self.duty.as_ref().filter(|_| self.outer).map(|duty| duty.outer_rad(time_s));
        let load = self.duty.as_ref().filter(|_| self.load).map(|duty| duty.load_n(time_s));
        angle.into_iter().chain(outer).chain(load)
    }
}

/// What the recorder carries from sample to sample.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Memory {
    /// Node of each sensor, chosen at the start.
    sensors: Vec<u32>,
    /// Velocity of each sensor at the last sample.
    at_sample: Vec<[f64; 2]>,
    /// Angle of each roller's rim then, and by how much it has turned since the start [rad].
    rim_angle: Vec<f64>,
    spin: Vec<f64>,
}

impl Recorder {
    pub(crate) fn new(scene: &Scene, machine: &Machine) -> Self {
        let angle = |&n: &u32| {
            let [x, y] = machine.system.position(n);
            y.atan2(x)
        };
        let sensors: Vec<u32> = Geometry::of(scene)
            .sensor_angles
            .into_iter()
            .map(|wanted| {
                let off = |n: &u32| (angle(n) - wanted).sin().hypot(1.0 - (angle(n) - wanted).cos());
                *machine.back.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("a ring has nodes")
            })
            .collect();
        let rollers = machine.rollers.len();
        let memory = Memory {
            at_sample: sensors.iter().map(|&n| velocity(machine, n)).collect(),
            sensors,
            rim_angle: (0..rollers).map(|i| rim_angle(machine, i)).collect(),
            spin: vec![0.0; rollers],
        };
        Self::with(scene, memory, machine)
    }

    /// A recorder that goes on; `None` when the memory is that of another machine.
    pub(crate) fn resume(scene: &Scene, machine: &Machine, memory: Memory) -> Option<Self> {
        let nodes = machine.system.node_count();
        let fits = memory.sensors.iter().all(|&n| (n as usize) < nodes)
            && memory.at_sample.len() == memory.sensors.len()
            && [&memory.rim_angle, &memory.spin].iter().all(|v| v.len() == machine.rollers.len());
        fits.then(|| Self::with(scene, memory, machine))
    }

    fn with(scene: &Scene, memory: Memory, machine: &Machine) -> Self {
        Self {
            tacho: Tacho::of(scene),
            before_step: vec![[0.0; 2]; memory.sensors.len()],
            memory,
            force: vec![[0.0; 2]; machine.system.resultants().count()],
            film: vec![[0.0; 2]; machine.system.films().count()],
            steps: 0,
            row: Vec::new(),
        }
    }

    /// What it takes to go on after a sample.
    pub(crate) fn memory(&self) -> &Memory {
        &self.memory
    }
}

/// Names of the columns of a trace, whatever model made it.
pub fn names(scene: &Scene) -> Vec<String> {
    let mut names = vec!["time_s".to_owned()];
    for s in &scene.output.sensors {
        for channel in ["ax_m_s2", "ay_m_s2", "ax_instant_m_s2", "ay_instant_m_s2"] {
            names.push(format!("sensor.{}.{channel}", s.name));
        }
    }
    let (with_cage, oiled) = (scene.cage.is_some(), scene.film.is_some());
    for i in scene.rollers_in_place() {
        for channel in ["x_m", "y_m", "spin_rad", "outer_fx_n", "outer_fy_n", "inner_fx_n", "inner_fy_n"] {
            names.push(format!("roller.{i}.{channel}"));
        }
        if with_cage {
            names.push(format!("roller.{i}.cage_fx_n"));
            names.push(format!("roller.{i}.cage_fy_n"));
        }
        if oiled {
            names.extend(["outer", "inner"].map(|ring| format!("roller.{i}.{ring}_film_m")));
        }
    }
    if with_cage {
        names.extend(["cage.x_m", "cage.y_m", "cage.angle_rad"].map(str::to_owned));
    }
    if scene.housing.has_seat() {
        names.extend(["seat.fx_n", "seat.fy_n"].map(str::to_owned));
    }
    names.extend(Tacho::of(scene).names());
    names
}

impl Recorder {
    /// Before every step.
    pub(crate) fn before_step(&mut self, machine: &Machine) {
        for (before, &n) in self.before_step.iter_mut().zip(&self.memory.sensors) {
            *before = velocity(machine, n);
        }
    }

    /// After every step: adds up the contact forces that acted in it.
    pub(crate) fn after_step(&mut self, machine: &Machine) {
        for (sum, Resultant { force, .. }) in self.force.iter_mut().zip(machine.system.resultants()) {
            sum[0] += force[0];
            sum[1] += force[1];
        }
        for (sum, film) in self.film.iter_mut().zip(machine.system.films()) {
            sum[0] += film.force[0];
            sum[1] += film.force[1];
        }
        self.steps += 1;
    }

    /// The row of one sample; sums begin anew.
    pub(crate) fn sample(&mut self, machine: &Machine) -> &[f64] {
        let system = &machine.system;
        let dt = system.time_step();
        let interval = dt * self.steps as f64;
        self.row.clear();
        self.row.push(system.time());
        let Memory { sensors, at_sample, rim_angle: last_angle, spin } = &mut self.memory;
        for (i, &n) in sensors.iter().enumerate() {
            let now = velocity(machine, n);
            for (before, span) in [(at_sample[i], interval), (self.before_step[i], dt)] {
                self.row.push((now[0] - before[0]) / span);
                self.row.push((now[1] - before[1]) / span);
            }
            at_sample[i] = now;
        }
        let mean = |pairs: Range<usize>| -> [f64; 2] {
            let sum = |c: usize| self.force[pairs.clone()].iter().map(|f| f[c]).sum::<f64>();
            [sum(0) / self.steps as f64, sum(1) / self.steps as f64]
        };
        let film = |n: usize| self.film.get(n).map(|sum| sum.map(|f| f / self.steps as f64));
        let mut thicknesses = system.films().map(|film| film.thickness);
        for (i, roller) in machine.rollers.iter().enumerate() {
            let [x, y] = system.position(roller.centre);
            let angle = rim_angle(machine, i);
            let turned = angle - last_angle[i];
            // Less than half a turn lies between two samples.
            spin[i] += turned - std::f64::consts::TAU * (turned / std::f64::consts::TAU).round();
            last_angle[i] = angle;
            self.row.extend([x, y, spin[i]]);
            let pairs = &machine.pairs;
            // What a raceway does to a roller, it does through contact and oil.
            for (side, ring) in [pairs.outer(i), pairs.inner(i)].into_iter().enumerate() {
                let mut force = mean(ring..ring + 1);
                if let Some(film) = film(2 * i + side) {
                    force = [force[0] + film[0], force[1] + film[1]];
                }
                self.row.extend(force);
            }
            if machine.cage.is_some() {
                self.row.extend(mean(pairs.cage(i)));
            }
            self.row.extend(thicknesses.by_ref().take(2));
        }
        if let Some(at) = machine.cage.and_then(|cage| system.rigid(cage)) {
            self.row.extend([at.centre[0], at.centre[1], at.angle]);
        }
        if let Some(seat) = machine.pairs.seat() {
            self.row.extend(mean(seat..seat + 1));
        }
        self.row.extend(self.tacho.sample(system.time()));
        self.force.fill([0.0; 2]);
        self.film.fill([0.0; 2]);
        self.steps = 0;
        &self.row
    }
}

/// Velocity of a sensor [m/s]: that of its node, or of the centre of a ring that does not deform, on whose housing it stays
/// where it is when the ring turns.
fn velocity(machine: &Machine, node: u32) -> [f64; 2] {
    machine.system.rigid(machine.outer).map_or_else(|| machine.system.velocity(node), |ring| ring.velocity)
}

/// Angle of the line from a roller's centre to its first rim node [rad].
fn rim_angle(machine: &Machine, roller: usize) -> f64 {
    let [[cx, cy], [x, y]] =
        [machine.rollers[roller].centre, machine.rollers[roller].rim].map(|n| machine.system.position(n));
    (y - cy).atan2(x - cx)
}
