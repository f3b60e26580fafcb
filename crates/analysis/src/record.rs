//! The channels of a run under their names, cut where they stop being numbers.

use std::ops::Range;

use stribeck_scene::run_dir::Run;
use stribeck_scene::scene::DefectRing;

use crate::levels::STANDARD_GRAVITY;

/// A run's samples, from the first to the last one before any channel stops being finite.
#[derive(Clone, Copy)]
pub struct Record<'a> {
    run: &'a Run,
    len: usize,
}

/// Recorded motion and forces of one roller, all slices of one length.
///
/// Forces act on the roller. The outer raceway pushes it inwards, the inner raceway outwards.
#[derive(Debug, Clone, Copy)]
pub struct Roller<'a> {
    /// Number, from 1.
    pub number: usize,
    /// Centre [m].
    pub x: &'a [f64],
    /// Centre [m].
    pub y: &'a [f64],
    /// Accumulated rotation [rad], counter-clockwise.
    pub spin: &'a [f64],
    /// Force of the outer raceway, x [N].
    pub outer_fx: &'a [f64],
    /// Force of the outer raceway, y [N].
    pub outer_fy: &'a [f64],
    /// Force of the inner raceway, x [N].
    pub inner_fx: &'a [f64],
    /// Force of the inner raceway, y [N].
    pub inner_fy: &'a [f64],
}

impl<'a> Record<'a> {
    /// All samples up to the first that is not finite in any channel.
    pub fn new(run: &'a Run) -> Self {
        let finite = |column: &Vec<f64>| column.iter().position(|v| !v.is_finite()).unwrap_or(column.len());
        let len = run.trace.columns.iter().map(finite).min().unwrap_or(0);
        Self { run, len }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.len
    }

    /// True when there is no usable sample.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Samples that were written but are not numbers, or follow one that is not.
    pub fn discarded(&self) -> usize {
        self.run.trace.len().saturating_sub(self.len)
    }

    /// Sampling interval [s], the recorded one, or that of `run.json` when there are fewer than two samples.
    pub fn interval_s(&self) -> f64 {
        match self.time_s() {
            [first, .., last] if last > first => (last - first) / (self.len - 1) as f64,
            _ => self.run.info.interval_s,
        }
    }

    /// Sampling rate [Hz].
    pub fn sample_rate_hz(&self) -> f64 {
        // A tenth of a hertz is far below what the file's rounding of times can move.
        (10.0 / self.interval_s()).round() / 10.0
    }

    /// Times [s].
    pub fn time_s(&self) -> &'a [f64] {
        self.channel("time_s").unwrap_or(&[])
    }

    /// Values of a channel.
    pub fn channel(&self, name: &str) -> Option<&'a [f64]> {
        self.run.trace.get(name).map(|values| &values[..self.len.min(values.len())])
    }

    /// Acceleration `ax` or `ay` of a sensor [g], mean over each interval.
    pub fn acceleration_g(&self, sensor: &str, component: &str) -> Option<Vec<f64>> {
        let values = self.channel(&format!("sensor.{sensor}.{component}_m_s2"))?;
        Some(values.iter().map(|a| a / STANDARD_GRAVITY).collect())
    }

    /// Roller `number`, from 1; `None` when one of its channels is missing.
    pub fn roller(&self, number: usize) -> Option<Roller<'a>> {
        let of = |what: &str| self.channel(&format!("roller.{number}.{what}"));
        Some(Roller {
            number,
            x: of("x_m")?,
            y: of("y_m")?,
            spin: of("spin_rad")?,
            outer_fx: of("outer_fx_n")?,
            outer_fy: of("outer_fy_n")?,
            inner_fx: of("inner_fx_n")?,
            inner_fy: of("inner_fy_n")?,
        })
    }

    /// Places for rollers in the cage, with those where one is missing.
    pub fn pockets(&self) -> usize {
        self.run.scene.bearing.rollers
    }

    /// All rollers whose channels are there.
    pub fn rollers(&self) -> Vec<Roller<'a>> {
        self.run.scene.rollers_in_place().filter_map(|number| self.roller(number)).collect()
    }
}

impl<'a> Roller<'a> {
    /// The same over some of the samples.
    pub fn within(&self, samples: Range<usize>) -> Self {
        let part = |all: &'a [f64]| &all[samples.clone()];
        Self {
            number: self.number,
            x: part(self.x),
            y: part(self.y),
            spin: part(self.spin),
            outer_fx: part(self.outer_fx),
            outer_fy: part(self.outer_fy),
            inner_fx: part(self.inner_fx),
            inner_fy: part(self.inner_fy),
        }
    }

    /// Orbital angle about the bearing's centre [rad], counter-clockwise from the x axis, without jumps.
    pub fn orbit(&self) -> Vec<f64> {
        let mut turns = 0.0;
        let mut last: Option<f64> = None;
        self.x
            .iter()
            .zip(self.y)
            .map(|(x, y)| {
                let angle = y.atan2(*x);
                let jump = last.map_or(0.0, |before| angle - before);
                if jump > std::f64::consts::PI {
                    turns -= 1.0;
                } else if jump < -std::f64::consts::PI {
                    turns += 1.0;
                }
                last = Some(angle);
                angle + turns * std::f64::consts::TAU
            })
            .collect()
    }

    /// Normal force between roller and the raceway of a ring [N], compression positive.
    pub fn normal(&self, ring: DefectRing) -> Vec<f64> {
        match ring {
            DefectRing::Outer => self.outer_normal(),
            DefectRing::Inner => self.inner_normal(),
        }
    }

    /// Normal force between roller and outer raceway [N], compression positive.
    pub fn outer_normal(&self) -> Vec<f64> {
        radial(self.x, self.y, self.outer_fx, self.outer_fy, -1.0)
    }

    /// Normal force between roller and inner raceway [N], compression positive.
    pub fn inner_normal(&self) -> Vec<f64> {
        radial(self.x, self.y, self.inner_fx, self.inner_fy, 1.0)
    }
}

/// Component of a force along the outward radius through (x, y), times `sign`.
fn radial(x: &[f64], y: &[f64], fx: &[f64], fy: &[f64], sign: f64) -> Vec<f64> {
    (0..x.len())
        .map(|n| {
            let radius = x[n].hypot(y[n]);
            if radius > 0.0 { sign * (fx[n] * x[n] + fy[n] * y[n]) / radius } else { 0.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_a_turning_roller() {
        let angle: Vec<f64> = (0..1000).map(|n| 1.6 - 0.02 * n as f64).collect();
        let (x, y): (Vec<f64>, Vec<f64>) = angle.iter().map(|a| (0.09 * a.cos(), 0.09 * a.sin())).unzip();
        let (fx, fy): (Vec<f64>, Vec<f64>) = angle.iter().map(|a| (-5.0 * a.cos(), -5.0 * a.sin())).unzip();
        let none = vec![0.0; 1000];
        let roller = Roller {
            number: 1,
            x: &x,
            y: &y,
            spin: &none,
            outer_fx: &fx,
            outer_fy: &fy,
            inner_fx: &fx,
            inner_fy: &fy,
        };
        // More than three turns without a jump.
        assert!(roller.orbit().iter().zip(&angle).all(|(found, a)| (found - a).abs() < 1e-12));
        assert!(roller.outer_normal().iter().all(|f| (f - 5.0).abs() < 1e-12));
        assert!(roller.inner_normal().iter().all(|f| (f + 5.0).abs() < 1e-12));
    }
}
