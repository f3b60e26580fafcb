//! What the page reads: a row of numbers for each sample, and the whole bearing for each picture.

use stribeck_reduced::motion::{BearingInMotion, Energies};

/// Numbers of a sample, in this order: time [s]; acceleration at the sensor, x and y, mean over the interval
/// [m/s²]; normal force of the outer and of the inner raceway on the roller that is watched [N]; force of
/// all rollers on the outer ring, x and y [N]; displacement of the centre of the outer raceway from its
/// place at the preload, x and y [m]; largest normal force on the outer raceway [N].
pub const PER_SAMPLE: usize = 10;

/// Numbers before the rollers in a picture: time [s]; angle of the inner ring [rad]; cage, x and y [m] and
/// angle [rad]; force of the housing on the outer ring, x and y [N]; energies [J]: kinetic, strain, contact,
/// friction, damping, contact damping, films, work of the load, work of the drive, imbalance; time step [s].
pub const BEFORE_ROLLERS: usize = 18;

/// Numbers of a roller in a picture: centre, x and y [m]; angle by which it has turned [rad]; force of the
/// outer raceway, x and y [N]; of the inner one and of the cage likewise; films on both [m], zero without
/// oil.
pub const PER_ROLLER: usize = 11;

pub(crate) fn sample(motion: &BearingInMotion, watched: usize, mean: &[Vec<f64>; 2], to: &mut Vec<f64>) {
    let acceleration = motion.sensors().first().map_or([0.0; 2], |sensor| sensor.mean);
    let (mut outer, mut inner, mut largest, mut sum) = (0.0, 0.0, 0.0_f64, [0.0; 2]);
    for (n, roller) in motion.rollers().enumerate() {
        let size = roller.outer[0].hypot(roller.outer[1]);
        largest = largest.max(size);
        sum = [sum[0] - roller.outer[0], sum[1] - roller.outer[1]];
        if n == watched {
            (outer, inner) = (size, roller.inner[0].hypot(roller.inner[1]));
        }
    }
    let centre =
        mean.each_ref().map(|shape| shape.iter().zip(motion.modes()).map(|(a, q)| a * q).sum::<f64>());
    to.extend([motion.time(), acceleration[0], acceleration[1], outer, inner, sum[0], sum[1]]);
    to.extend([centre[0], centre[1], largest]);
}

pub(crate) fn picture(motion: &BearingInMotion, energies: &Energies, imbalance: f64, to: &mut Vec<f64>) {
    to.clear();
    let ([x, y], angle) = motion.cage().unwrap_or_default();
    let seat = motion.seat().unwrap_or_default();
    to.extend([motion.time(), motion.shaft(), x, y, angle, seat[0], seat[1]]);
    let Energies {
        kinetic, strain, contact, friction, damping, contact_damping, film, external, drive, ..
    } = *energies;
    to.extend([
        kinetic,
        strain,
        contact,
        friction,
        damping,
        contact_damping,
        film,
        external,
        drive,
        imbalance,
    ]);
    to.push(motion.bearing().time_step);
    // Forces are means over an interval, and there is none before the first step.
    let moved = energies.time > 0.0;
    let known = |force: [f64; 2]| if moved { force } else { [0.0; 2] };
    for roller in motion.rollers() {
        to.extend(roller.centre);
        to.push(roller.spin);
        to.extend(known(roller.outer));
        to.extend(known(roller.inner));
        to.extend(known(roller.cage));
        to.extend(roller.films.unwrap_or_default());
    }
}

/// Displacement of the vertices of the outer raceway with the modes, x and y of each [m].
pub(crate) fn displacement(motion: &BearingInMotion, to: &mut Vec<f64>) {
    to.clear();
    let (q, r) = (motion.modes(), motion.bearing().reduction.padded);
    let along = |shape: &[f64]| shape.iter().zip(q).map(|(a, q)| a * q).sum::<f64>();
    to.extend(motion.bearing().reduction.shapes.chunks_exact(r).map(along));
}
