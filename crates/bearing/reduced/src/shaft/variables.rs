//! What a program sets and reads of a bearing on a moving shaft, as an FMU names it.

/// A variable of an FMU: a number in SI.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variable {
    /// Its name, with the unit last.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// What it is.
    pub description: &'static str,
}

const fn variable(name: &'static str, unit: &'static str, description: &'static str) -> Variable {
    Variable { name, unit, description }
}

/// What a program sets, in the order of the value references from 1 on: where the shaft is at the end of the
/// communication step.
pub const INPUTS: [Variable; 4] = [
    variable("shaft.x_m", "m", "displacement of the shaft relative to the ground, to the right"),
    variable("shaft.y_m", "m", "displacement of the shaft relative to the ground, upwards"),
    variable("shaft.vx_m_s", "m/s", "velocity of the shaft, to the right"),
    variable("shaft.vy_m_s", "m/s", "velocity of the shaft, upwards"),
];

/// What it reads, with the value references that follow; two accelerations for each sensor come last.
pub const OUTPUTS: [Variable; 15] = [
    variable("shaft.fx_n", "N", "force of the bearing on the shaft at the end of the communication step"),
    variable("shaft.fy_n", "N", "force of the bearing on the shaft at the end of the communication step"),
    variable("shaft.mean_fx_n", "N", "force of the bearing on the shaft, mean over the communication step"),
    variable("shaft.mean_fy_n", "N", "force of the bearing on the shaft, mean over the communication step"),
    variable("roller.largest_n", "N", "largest force of the outer raceway on a roller"),
    variable("cage.angle_rad", "rad", "angle by which the cage has turned, counter-clockwise"),
    variable("shaft.angle_rad", "rad", "angle by which the inner ring has turned, counter-clockwise"),
    variable("sensor1.ax_m_s2", "m/s2", "acceleration of the sensor, mean over the communication step"),
    variable("sensor1.ay_m_s2", "m/s2", "acceleration of the sensor, mean over the communication step"),
    variable("sensor2.ax_m_s2", "m/s2", "acceleration of the sensor, mean over the communication step"),
    variable("sensor2.ay_m_s2", "m/s2", "acceleration of the sensor, mean over the communication step"),
    variable("sensor3.ax_m_s2", "m/s2", "acceleration of the sensor, mean over the communication step"),
    variable("sensor3.ay_m_s2", "m/s2", "acceleration of the sensor, mean over the communication step"),
    variable("sensor4.ax_m_s2", "m/s2", "acceleration of the sensor, mean over the communication step"),
    variable("sensor4.ay_m_s2", "m/s2", "acceleration of the sensor, mean over the communication step"),
];

/// Sensors that an FMU has variables for.
pub const SENSORS: usize = 4;

/// Outputs before those of the sensors.
pub const BEFORE_SENSORS: usize = OUTPUTS.len() - 2 * SENSORS;

/// Token by which an importer makes sure that library and description of an FMU belong together.
pub const TOKEN: &str = concat!("{stribeck-", env!("CARGO_PKG_VERSION"), "}");

/// Name of the file with the numbers of the bearing in the resources of an FMU.
pub const RESOURCE: &str = "bearing.postcard";
