//! What is sampled: sensors, contact forces, places. Column names are a contract with the report.

use stribeck_contact::Resultant;

use crate::{assembly::Machine, scene::Scene};

/// Sums between samples and the channels made of them.
#[derive(Debug)]
pub(crate) struct Recorder {
    sensors: Vec<u32>,
    /// Velocity of each sensor at the last sample, and before the last step.
    at_sample: Vec<[f64; 2]>,
    before_step: Vec<[f64; 2]>,
    /// Resultant of each pair, summed over the steps since the last sample.
    force: Vec<[f64; 2]>,
    steps: usize,
    rim_angle: Vec<f64>,
    spin: Vec<f64>,
    row: Vec<f64>,
}

impl Recorder {
    pub(crate) fn new(scene: &Scene, machine: &Machine) -> Self {
        let state = &machine.dynamics.state;
        let angle = |&n: &u32| state.y[n as usize].atan2(state.x[n as usize]);
        let sensors: Vec<u32> = scene
            .output
            .sensors
            .iter()
            .map(|s| {
                let wanted = s.angle_deg.to_radians();
                let off = |n: &u32| (angle(n) - wanted).sin().hypot(1.0 - (angle(n) - wanted).cos());
                *machine.housing.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("a ring has nodes")
            })
            .collect();
        let mut recorder = Self {
            at_sample: vec![[0.0; 2]; sensors.len()],
            before_step: vec![[0.0; 2]; sensors.len()],
            sensors,
            force: vec![[0.0; 2]; machine.contacts.resultants().count()],
            steps: 0,
            rim_angle: vec![0.0; machine.rollers.len()],
            spin: vec![0.0; machine.rollers.len()],
            row: Vec::new(),
        };
        recorder.at_sample = recorder.velocities(machine).collect();
        for i in 0..machine.rollers.len() {
            recorder.rim_angle[i] = rim_angle(machine, i);
        }
        recorder
    }

    /// Names of the columns.
    pub(crate) fn names(scene: &Scene) -> Vec<String> {
        let mut names = vec!["time_s".to_owned()];
        for s in &scene.output.sensors {
            for channel in ["ax_m_s2", "ay_m_s2", "ax_instant_m_s2", "ay_instant_m_s2"] {
                names.push(format!("sensor.{}.{channel}", s.name));
            }
        }
        let with_cage = scene.cage.is_some();
        for i in 1..=scene.bearing.rollers {
            for channel in ["x_m", "y_m", "spin_rad", "outer_fx_n", "outer_fy_n", "inner_fx_n", "inner_fy_n"]
            {
                names.push(format!("roller.{i}.{channel}"));
            }
            if with_cage {
                names.push(format!("roller.{i}.cage_fx_n"));
                names.push(format!("roller.{i}.cage_fy_n"));
            }
        }
        if with_cage {
            names.extend(["cage.x_m", "cage.y_m", "cage.angle_rad"].map(str::to_owned));
        }
        names.extend(["seat.fx_n", "seat.fy_n"].map(str::to_owned));
        names
    }

    fn velocities(&self, machine: &Machine) -> impl Iterator<Item = [f64; 2]> {
        let s = &machine.dynamics.state;
        self.sensors.iter().map(|&n| [s.vx[n as usize], s.vy[n as usize]])
    }

    /// Before every step.
    pub(crate) fn before_step(&mut self, machine: &Machine) {
        for (i, &n) in self.sensors.iter().enumerate() {
            let s = &machine.dynamics.state;
            self.before_step[i] = [s.vx[n as usize], s.vy[n as usize]];
        }
    }

    /// After every step: adds up the contact forces that acted in it.
    pub(crate) fn after_step(&mut self, machine: &Machine) {
        for (sum, Resultant { force, .. }) in self.force.iter_mut().zip(machine.contacts.resultants()) {
            sum[0] += force[0];
            sum[1] += force[1];
        }
        self.steps += 1;
    }

    /// The row of one sample; sums begin anew.
    pub(crate) fn sample(&mut self, machine: &Machine) -> &[f64] {
        let state = &machine.dynamics.state;
        let dt = machine.dynamics.time_step();
        let interval = dt * self.steps as f64;
        self.row.clear();
        self.row.push(state.time);
        for (i, &n) in self.sensors.iter().enumerate() {
            let now = [state.vx[n as usize], state.vy[n as usize]];
            for (before, span) in [(self.at_sample[i], interval), (self.before_step[i], dt)] {
                self.row.push((now[0] - before[0]) / span);
                self.row.push((now[1] - before[1]) / span);
            }
            self.at_sample[i] = now;
        }
        let mean = |pairs: &[usize]| -> [f64; 2] {
            let sum = |c: usize| pairs.iter().map(|&p| self.force[p][c]).sum::<f64>();
            [sum(0) / self.steps as f64, sum(1) / self.steps as f64]
        };
        for (i, roller) in machine.rollers.iter().enumerate() {
            let c = roller.centre as usize;
            let angle = rim_angle(machine, i);
            let turned = angle - self.rim_angle[i];
            // Less than half a turn lies between two samples.
            self.spin[i] += turned - std::f64::consts::TAU * (turned / std::f64::consts::TAU).round();
            self.rim_angle[i] = angle;
            self.row.extend([state.x[c], state.y[c], self.spin[i]]);
            let pairs = &machine.roller_pairs[i];
            self.row.extend(mean(&[pairs.outer]));
            self.row.extend(mean(&[pairs.inner]));
            if let Some(walls) = pairs.cage {
                self.row.extend(mean(&walls));
            }
        }
        if let Some(cage) = machine.cage {
            let at = &machine.dynamics.rigid[cage];
            self.row.extend([at.centre[0], at.centre[1], at.angle]);
        }
        let seat = mean(&[machine.seat_pair]);
        self.row.extend(seat);
        self.force.fill([0.0; 2]);
        self.steps = 0;
        &self.row
    }
}

/// Angle of the line from a roller's centre to its first rim node [rad].
fn rim_angle(machine: &Machine, roller: usize) -> f64 {
    let s = &machine.dynamics.state;
    let (c, r) = (machine.rollers[roller].centre as usize, machine.rollers[roller].rim as usize);
    (s.y[r] - s.y[c]).atan2(s.x[r] - s.x[c])
}
