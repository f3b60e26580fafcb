//! Event #2: a roller strikes the floor of a defect.
//!
//! **The rule.** Between the edges a roller is free of the load, and only its centrifugal force and its
//! weight, m (ω²r + g) at the most, press it on the floor, wherever the spall lies. A body released onto a
//! spring without speed presses on it with twice its weight at the most; a larger force requires a speed of
//! approach. So a force counts as an impact from twice m (ω²r + g) on: 7 N for the rollers of the paper's
//! bearing, which carry 12 kN before. No force needs to be larger because of noise: a dry contact without
//! penetration exerts exactly none, and a film that floats the roller exerts m (ω²r + g). The force is sought
//! where the edges cannot carry the roller, [`Edge::floor_m`](crate::spall_length::Edge::floor_m) away from
//! either. (Own.)
//!
//! The contact is metallic where the film is at its least, which the tips of the roughness or the stiffened
//! oil of a loaded contact hold (THEORY §4.6), at any time while the roller presses with more than that, and
//! in a dry bearing; otherwise the oil alone stops the roller. The paper's impact is the metallic one.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::events::span;
use stribeck_diagnosis::quantity::Part;

/// Factor of the force of a roller at rest on the floor above which it must have had a speed of approach [-].
const SUDDENLY_LAID: f64 = 2.0;

/// A film that is no more than this much thicker than its least carries through the surfaces [-].
const LEAST_FILM: f64 = 0.01;

impl Part for FloorContact {}

/// How a roller was stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FloorContact {
    /// The surfaces touched.
    Metal,
    /// Oil stopped it before they did.
    Film,
}

impl FloorContact {
    /// The name in `summary.json`: `metal` or `film`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Metal => "metal",
            Self::Film => "film",
        }
    }

    /// What the roller does, in a sentence.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Metal => "strikes the floor",
            Self::Film => "lands on the oil above the floor",
        }
    }
}

/// A touch of the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike {
    /// When the roller presses most [s].
    pub at_s: f64,
    /// Its force then [N], mean over the sampling interval.
    pub force_n: f64,
    /// Medium of the touch: metal or oil.
    pub by: FloorContact,
}

/// Oil over the floor.
#[derive(Debug, Clone, Copy)]
pub struct FloorFilm<'a> {
    /// Thickness at each sample [m].
    pub thickness_m: &'a [f64],
    /// Thickness that no film falls below [m].
    pub least_m: f64,
}

/// A roller over a defect, all slices of one length.
#[derive(Debug, Clone, Copy)]
pub struct OverFloor<'a> {
    /// Times [s].
    pub time_s: &'a [f64],
    /// Its angle around the bearing [rad], without jumps.
    pub orbit_rad: &'a [f64],
    /// Normal force of the spall's raceway on it [N], mean over each sampling interval, compression positive.
    pub force_n: &'a [f64],
    /// The film; `None` for a dry bearing.
    pub film: Option<FloorFilm<'a>>,
    /// Its mass [kg].
    pub mass_kg: f64,
    /// Radius of its path [m].
    pub path_radius_m: f64,
    /// Gravity [m/s²].
    pub gravity_m_s2: f64,
}

impl OverFloor<'_> {
    /// The touch of the floor between two times [s], in which the edges cannot carry the roller. `None` when
    /// it does not touch.
    pub fn strike(&self, [from_s, until_s]: [f64; 2]) -> Option<Strike> {
        let inside = span(self.time_s, from_s, until_s);
        let at = inside.clone().max_by(|&a, &b| self.force_n[a].total_cmp(&self.force_n[b]))?;
        let least_n = self.least_n(&inside);
        (self.force_n[at] > least_n).then(|| Strike {
            at_s: self.time_s[at],
            force_n: self.force_n[at],
            by: self.by(&inside, at, least_n),
        })
    }

    /// Force that counts as a touch [N], from the orbital speed of the roller meanwhile.
    fn least_n(&self, inside: &Range<usize>) -> f64 {
        let (first, last) = (inside.start, inside.end - 1);
        let taken_s = self.time_s[last] - self.time_s[first];
        let turned_rad = self.orbit_rad[last] - self.orbit_rad[first];
        let orbit_rad_s = if taken_s > 0.0 { turned_rad / taken_s } else { 0.0 };
        let outwards = orbit_rad_s * orbit_rad_s * self.path_radius_m;
        SUDDENLY_LAID * self.mass_kg * (outwards + self.gravity_m_s2)
    }

    /// Medium of the touch about the largest force, which is at sample `at`.
    fn by(&self, inside: &Range<usize>, at: usize, least_n: f64) -> FloorContact {
        let Some(film) = self.film else { return FloorContact::Metal };
        let pressed = |n: &usize| self.force_n[*n] > least_n;
        let from = (inside.start..at).rev().take_while(pressed).last().unwrap_or(at);
        let until = (at..inside.end).take_while(pressed).last().unwrap_or(at);
        // Forces are means over the interval before a sample, films those at its ends.
        let closed = film.thickness_m[from.saturating_sub(1)..=until]
            .iter()
            .any(|thickness| *thickness <= (1.0 + LEAST_FILM) * film.least_m);
        if closed { FloorContact::Metal } else { FloorContact::Film }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTERVAL: f64 = 1e-5;
    /// The paper's first passage, 0.84 to 5.08 ms, less √(2 · 9.890 mm · 0.2 mm) at 2.359 m/s on either side.
    const BETWEEN_S: [f64; 2] = [1.68e-3, 4.24e-3];

    /// 12 kN, unloaded from 0.9 to 4.9 ms, and half a sine of `peak_n` and 60 µs on the floor from 2.5 ms on.
    fn force(peak_n: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..800).map(|n| f64::from(n) * INTERVAL).collect();
        let orbit = time.iter().map(|t| 1.64 - 23.585 * t).collect();
        let at = |t: &f64| match t {
            t if !(0.9e-3..4.9e-3).contains(t) => 12e3,
            t if (2.5e-3..2.56e-3).contains(t) => peak_n * (std::f64::consts::PI * (t - 2.5e-3) / 6e-5).sin(),
            _ => 0.0,
        };
        let force = time.iter().map(at).collect();
        (time, orbit, force)
    }

    /// A roller of the paper's bearing, 30 mm long: 60 g, 3.0 N of centrifugal force and 0.6 N of weight.
    fn over<'a>(
        (time_s, orbit_rad, force_n): &'a (Vec<f64>, Vec<f64>, Vec<f64>),
        film: Option<FloorFilm<'a>>,
    ) -> OverFloor<'a> {
        let mass_kg = 7850.0 * std::f64::consts::PI * 9e-3 * 9e-3 * 0.03;
        let (path_radius_m, gravity_m_s2) = (0.091, 9.81);
        OverFloor { time_s, orbit_rad, force_n, film, mass_kg, path_radius_m, gravity_m_s2 }
    }

    /// The floor was struck with 190 to 386 N in the dry scene, and reported was nothing: a touch had to
    /// exceed a twentieth of the load before the defect, 603 N.
    #[test]
    fn issue_a_light_touch_of_the_floor_is_reported() {
        for peak_n in [386.0, 270.0, 190.0, 12.0] {
            let samples = force(peak_n);
            let found = over(&samples, None).strike(BETWEEN_S).expect("a touch");
            assert!((found.force_n / peak_n - 1.0).abs() < 0.01, "{found:?}");
            assert!((found.at_s - 2.53e-3).abs() < 1.5 * INTERVAL, "{found:?}");
            assert_eq!(found.by, FloorContact::Metal);
        }
    }

    #[test]
    fn analytic_a_roller_that_lies_on_the_floor_does_not_strike_it() {
        // By hand: 0.0599 kg · (23.585² · 0.091 + 9.81) m/s² = 3.62 N. A load that is applied suddenly has
        // twice the static effect (S. Timoshenko, Strength of Materials, part I, 1955).
        let samples = force(0.0);
        let least_n = over(&samples, None).least_n(&(200..400));
        assert!((least_n - 2.0 * 3.62).abs() < 0.02, "{least_n}");
        for (peak_n, strikes) in [(0.0, false), (7.0, false), (7.5, true)] {
            let samples = force(peak_n);
            assert_eq!(over(&samples, None).strike(BETWEEN_S).is_some(), strikes, "{peak_n} N");
        }
        let empty = (Vec::new(), Vec::new(), Vec::new());
        assert_eq!(over(&empty, None).strike(BETWEEN_S), None);
        // Edges that reach over the whole defect leave no floor to touch.
        assert_eq!(over(&force(400.0), None).strike([3.04e-3, 2.88e-3]), None);
    }

    #[test]
    fn planted_oil_stops_a_roller_or_metal_does() {
        let samples = force(390.0);
        // The film is thinnest where the force is largest, 4 µm or its least of 0.5 µm, and thick before.
        for (thinnest_m, by) in [(4e-6, FloorContact::Film), (0.5e-6, FloorContact::Metal)] {
            let thickness_m: Vec<f64> =
                samples.0.iter().map(|t| thinnest_m + 0.1 * (t - 2.53e-3).abs()).collect();
            let film = FloorFilm { thickness_m: &thickness_m, least_m: 0.5e-6 };
            assert_eq!(over(&samples, Some(film)).strike(BETWEEN_S).expect("a touch").by, by);
        }
        // A raceway's film that closes under load before and behind the defect is not the floor's.
        let thickness_m: Vec<f64> =
            samples.2.iter().map(|force| if *force > 1e3 { 0.5e-6 } else { 5e-6 }).collect();
        let film = FloorFilm { thickness_m: &thickness_m, least_m: 0.5e-6 };
        let found = over(&samples, Some(film)).strike(BETWEEN_S).expect("a touch");
        assert_eq!(found.by, FloorContact::Film);
    }
}
