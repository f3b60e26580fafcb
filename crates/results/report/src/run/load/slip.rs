//! Slip: speeds of the rollers about their axes and about the bearing, and of the cage, over those of rolling
//! without slip.

use std::f64::consts::TAU;

use stribeck_dsp::running_mean;

use super::super::Subject;
use crate::Error;
use crate::page::minus;
use crate::plot::{Axis, Colour, Figure, Level, Series};

/// Rates are means over this time [s]; at most a tenth of the record.
const SMOOTHING_S: f64 = 0.5e-3;

/// Speed over the mean speed below which slip is not drawn.
const LEAST_PACE: f64 = 0.05;

/// Spin of the rollers that cross the defect, and orbit of rollers and cage.
pub(super) fn figures(of: &Subject<'_>) -> Result<Vec<Figure>, Error> {
    let (record, findings) = (of.record, of.findings);
    if record.len() < 20 {
        return Ok(Vec::new());
    }
    let width = ((SMOOTHING_S / record.interval_s()) as usize).clamp(1, record.len() / 10).max(1);
    let k = &findings.prediction.kinematics;
    let start = record.time_s()[0] + 0.5 * (width + 1) as f64 * record.interval_s();
    let colours = [Colour::Blue, Colour::Orange, Colour::Green, Colour::Purple];
    let cage_rad_s = k.outer_rad_s - k.sense() * TAU * k.cage_on_outer_hz;
    let crossing: Vec<usize> = findings.summary.events.iter().map(|e| e.roller).take(3).collect();
    // Relative speed of the rings over its mean; slip cannot be judged where it is nearly zero.
    let against = record.relative_angle().map(|angle| rates(&angle, record.interval_s(), width));
    let mean = k.shaft_rad_s - k.outer_rad_s;
    let pace = |n: usize| against.as_ref().map_or(1.0, |rate| (rate[n] / mean).abs());
    let percent = |name: &str, colour: Colour, angle: &[f64], without_slip_rad_s: f64| {
        let mut rate = rates(angle, record.interval_s(), width);
        // Where the angle of the outer ring is recorded, motion is taken relative to that ring.
        let mut without_slip_rad_s = without_slip_rad_s;
        if let Some(outer) = record.channel("outer_ring.angle_rad") {
            let outer = rates(outer, record.interval_s(), width);
            rate.iter_mut().zip(outer).for_each(|(rate, outer)| *rate -= outer);
            without_slip_rad_s -= k.outer_rad_s;
        }
        let off = |(n, r): (usize, &f64)| {
            let rolling = pace(n) * without_slip_rad_s.abs();
            if pace(n) < LEAST_PACE { 0.0 } else { 100.0 * (r.abs() / rolling - 1.0) }
        };
        let off = rate.iter().enumerate().map(off).collect();
        Series::sampled(name, colour, start, record.interval_s(), off)
    };
    let mut spin =
        chart("spin", "Spin of the rollers that cross the defect", "Spin against rolling without slip");
    let of_orbit =
        if crossing.is_empty() { "Speed of the cage" } else { "Speed of the cage and of these rollers" };
    let mut orbit = chart("orbit", of_orbit, "Orbit against rolling without slip");
    let rollers = record.with_rollers(&crossing, 0..record.len())?;
    for (&number, colour) in crossing.iter().zip(colours) {
        let Some(roller) = rollers.roller(number) else { continue };
        let name = format!("roller {number}");
        spin = spin.with(percent(&name, colour, roller.spin, k.roller_rad_s));
        orbit = orbit.with(percent(&name, colour, &roller.orbit(), cage_rad_s));
    }
    if let Some(angle) = record.channel("cage.angle_rad") {
        orbit = orbit.with(percent("cage", Colour::Black, angle, cage_rad_s));
    }
    let motion = &findings.summary.kinematics;
    let slip = motion
        .cage_hz
        .filter(|_| motion.expected_cage_hz > 0.0)
        .map_or("–".into(), |hz| format!("{:+.2} %", 100.0 * (hz / motion.expected_cage_hz - 1.0)));
    let note = format!(
        "Mean over {:.2} ms. Measured rates of every roller stand in the table of kinematics.",
        1e3 * width as f64 * record.interval_s()
    );
    let figures = [
        spin.caption(
            "A loaded roller rolls; in the defect and outside the load zone nothing drives it at the outer \
             raceway, and where its speed then differs from rolling it slips until the contact has it again.",
        )
        .note(note.clone()),
        orbit
            .caption(minus(format!(
                "The cage turns {slip} of its speed without slip, over the whole record."
            )))
            .note(note),
    ];
    Ok(figures.into_iter().filter(|figure| !figure.series.is_empty()).collect())
}

fn chart(id: &str, title: &str, quantity: &str) -> Figure {
    let mut figure = Figure::new(id, title, Axis::si("Time", "s"), Axis::plain(quantity, "%")).synced("time");
    figure.levels = vec![Level { y: 0.0, label: "no slip".into(), colour: Colour::Grey }];
    figure
}

/// Rate of an angle [rad/s], each a mean over `width` samples.
fn rates(angle: &[f64], interval_s: f64, width: usize) -> Vec<f64> {
    let differences: Vec<f64> = angle.windows(2).map(|w| (w[1] - w[0]) / interval_s).collect();
    running_mean(&differences, width)
}
