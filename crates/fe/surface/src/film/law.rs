//! The law of one film: thickness, force and heat from the gap between the surfaces and the entrainment speed
//! (THEORY §4.6), whatever the geometry behind the gap.

use serde::{Deserialize, Serialize};

use crate::film::{
    reynolds::{EMPTY, FilmForce, left_of_land},
    spring::Spring,
};

/// Wider gaps hold no film [m].
pub const WIDEST: f64 = 1e-3;

/// Least entrainment speed [m/s], used below it, too: large enough to divide by, and far below that of
/// surfaces that roll.
pub(crate) const SLOWEST: f64 = 1e-3;

/// Where a film ends that neither opens nor closes.
pub(crate) const STEADY: f64 = 0.475_131;

/// A land that ends this many film widths away has no end.
pub(crate) const FAR: f64 = 20.0;

/// A contact whose force is this many times the film's stays solid for some steps.
pub(crate) const FIXED: f64 = 4.0;

/// Relative accuracy of the end of a film; the next step removes the remainder.
const ACCURACY: f64 = 1e-6;

/// Most corrections of the place where a film ends.
const MOST_CORRECTIONS: usize = 30;

/// The lubricant between two surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oil {
    /// Dynamic viscosity η [Pa s].
    pub viscosity: f64,
    /// Least film thickness [m]: that of a loaded contact, where the oil acts as a solid and only contact
    /// changes the force.
    pub least: f64,
}

/// The law of a film between two surfaces with the compliance `S`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmLaw<S> {
    /// Relative radius R [m].
    pub(crate) radius: f64,
    /// 4ηRL [N s]: times u/h a force.
    pub(crate) wedge: f64,
    /// 1/√(2R) [1/√m].
    pub(crate) slope: f64,
    pub(crate) least: f64,
    /// Force of a film that neither opens nor closes, over 4ηuRL/h [-].
    pub(crate) steady: f64,
    /// Compliance of the surfaces under the film.
    pub spring: S,
}

/// State of a film from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Thickness above the least [m].
    pub above: f64,
    /// Where it ends, in √(2Rh) behind the closest approach.
    pub(crate) end: f64,
    /// Force through it [N].
    pub force: f64,
}

/// Result of a step of one film.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pushed {
    /// Force that drives the surfaces apart, beside that of dry contact [N].
    pub force: f64,
    /// How far springs are pressed in with the film, and without it [m].
    pub pressed: [f64; 2],
    /// Heat [J].
    pub heat: f64,
    /// Whether it is so thin and so pressed that nothing can change for some steps.
    pub fixed: bool,
}

impl Layer {
    /// A film that fills a gap [m] and carries nothing yet.
    pub fn at(gap: f64) -> Self {
        Self { above: gap.max(0.0), end: STEADY, force: 0.0 }
    }
}

impl<S: Spring> FilmLaw<S> {
    /// A film of oil between surfaces of the relative radius R, over a `length` out of plane [m].
    pub fn new(oil: Oil, radius: f64, length: f64, spring: S) -> Self {
        let wedge = 4.0 * oil.viscosity * radius * length;
        let (slope, steady) = (1.0 / (2.0 * radius).sqrt(), FilmForce::until(STEADY).force);
        Self { radius, wedge, slope, least: oil.least, steady, spring }
    }

    /// Film thickness [m].
    pub fn thickness(&self, layer: &Layer) -> f64 {
        layer.above + self.least
    }

    /// Share of the force that remains on a land whose ends lie at these distances on both sides [m]; `tilt`
    /// is the sine of the angle between the film's normal and that of the land.
    pub fn share(&self, ends: [f64; 2], tilt: f64, layer: &Layer) -> f64 {
        let per_metre = self.slope / self.thickness(layer).sqrt();
        ends.map(|end| {
            // At the very end the closest approach may lie beyond it.
            let edge = if end > 0.0 { end } else { -tilt.abs() * self.radius };
            let edge = edge * per_metre;
            if edge < FAR { left_of_land(edge) } else { 1.0 }
        })
        .iter()
        .product()
    }

    /// The film of steady rolling at a gap [m] and an entrainment speed [m/s], where the land leaves a share
    /// of the force.
    pub fn settled(&self, gap: f64, speed: f64, share: f64) -> (Layer, Pushed) {
        let carried = self.wedge * speed.abs().max(SLOWEST) * share * self.steady;
        let dry = (-gap).max(0.0);
        let mut above = gap.max(0.0);
        if self.spring.force(dry) < carried / self.least {
            // Spring force less film force rises with the thickness.
            let (mut low, mut high) = (above, above + carried / self.least / self.spring.stiffest() + WIDEST);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if self.spring.force(middle - gap) < carried / (middle + self.least) {
                    low = middle
                } else {
                    high = middle
                }
            }
            above = low;
        }
        let depth = above - gap;
        let layer = Layer { above, end: STEADY, force: self.spring.force(depth) };
        let force = layer.force - self.spring.force(dry);
        (layer, Pushed { force, pressed: [depth, dry], ..Pushed::default() })
    }

    /// Advances a film by a time step `dt` [s] at a gap [m] and an entrainment speed [m/s]; `share` [-] of
    /// the force remains on its land.
    pub fn flow(&self, layer: &mut Layer, gap: f64, speed: f64, share: f64, dt: f64) -> Pushed {
        let above = layer.above;
        let dry = (-gap).max(0.0);
        let thickness = above + self.least;
        let speed = libm::hypot(speed, SLOWEST);
        let lift = self.wedge * speed * share / thickness;
        let rate = speed * thickness.sqrt() * self.slope;
        let before = layer.force;
        if above == 0.0 && dry > 0.0 {
            let (carried, loose) = (self.spring.force_near(dry, before), lift * self.steady);
            if carried >= loose {
                // Solid: contact alone acts.
                (layer.force, layer.end) = (carried, STEADY);
                return Pushed { pressed: [dry; 2], fixed: carried > FIXED * loose, ..Pushed::default() };
            }
        }
        let room = above - gap;
        let carried = match end_of(lift, rate * dt, room, layer.end, &self.spring) {
            Some((end, film)) => {
                (layer.above, layer.end) = ((above + rate * dt * film.opening).max(0.0), end);
                lift * film.force
            }
            None => {
                (layer.above, layer.end) = (gap.max(0.0), EMPTY);
                before
            }
        };
        let depth = (layer.above - gap).max(0.0);
        layer.force = self.spring.force_near(depth, carried);
        let force = layer.force - self.spring.force(dry);
        let heat = 0.5 * (before + layer.force) * (above - layer.above);
        Pushed { force, pressed: [depth, dry], heat, fixed: false }
    }

    /// Energy in its springs beyond that of dry contact [J].
    pub fn stored(&self, pushed: &Pushed) -> f64 {
        let [depth, dry] = pushed.pressed.map(|depth| self.spring.energy(depth));
        depth - dry
    }
}

/// Thickness at the end of the step of a film whose force `lift` · G [N] compresses the springs by `room`
/// less its opening `opened` · q [m]. `None` when no film can follow.
fn end_of(lift: f64, opened: f64, room: f64, from: f64, spring: &impl Spring) -> Option<(f64, FilmForce)> {
    let need = |c: f64| {
        let film: FilmForce = FilmForce::until(c);
        let (depth, by_force) = spring.depth(lift * film.force);
        let value = depth - opened * film.opening - room;
        (value, by_force * lift * film.force_slope - opened * film.opening_slope, film)
    };
    let mut c = from.max(EMPTY);
    let (mut low, mut high) = (EMPTY, f64::INFINITY);
    for _ in 0..MOST_CORRECTIONS {
        let (value, slope, film) = need(c);
        if value >= 0.0 && c == EMPTY {
            return None;
        }
        if value.abs() <= ACCURACY * (room.abs() + opened) {
            return Some((c, film));
        }
        if value > 0.0 {
            high = c
        } else {
            low = c
        }
        let next = c - value / slope;
        c = if next > low && next < high {
            next
        } else if value > 0.0 {
            if low == EMPTY { EMPTY } else { 0.5 * (low + high) }
        } else if high.is_finite() {
            0.5 * (low + high)
        } else {
            2.0 * c.abs() + 1.0
        };
    }
    Some((c, FilmForce::until(c)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Bed;

    const LENGTH: f64 = 30e-3;
    const SPEED: f64 = 2.4;
    /// Bisection to 80 halvings; the rest is rounding.
    const ROUNDING: f64 = 1e-9;

    fn law() -> FilmLaw<Bed> {
        let oil = Oil { viscosity: 0.05, least: 0.5e-6 };
        FilmLaw::new(oil, 9e-3, LENGTH, Bed::new(2e13 * LENGTH, 9e-3))
    }

    fn close(ours: f64, theirs: f64) {
        assert!((ours / theirs - 1.0).abs() < ROUNDING, "{ours}, not {theirs}");
    }

    /// Film and springs carry the same force in series; what the film adds is beyond that of dry contact, and
    /// nothing where the surfaces press through it.
    /// Source: THEORY §4.6, equilibrium of film and springs.
    #[test]
    fn analytic_a_settled_film_adds_what_dry_contact_lacks() {
        let law = law();
        for gap in [5e-6, 0.0, -0.05e-6] {
            let (layer, pushed) = law.settled(gap, SPEED, 1.0);
            let dry = law.spring.force((-gap).max(0.0));
            close(pushed.force + dry, layer.force);
            close(layer.force, law.wedge * SPEED * law.steady / law.thickness(&layer));
            close(layer.force, law.spring.force(law.thickness(&layer) - law.least - gap));
            assert!(pushed.force > 0.0, "{pushed:?}");
        }
        // At this depth the springs carry more than the thinnest film.
        let (layer, pushed) = law.settled(-4e-6, SPEED, 1.0);
        assert_eq!((layer.above, pushed.force), (0.0, 0.0));
        close(layer.force, law.spring.force(4e-6));
    }

    /// The same while it flows: nodes get what film and springs carry beyond dry contact, and its heat is the mean
    /// force times the way that it has closed.
    /// Source: THEORY §4.6, (4.24) and below it.
    #[test]
    fn analytic_a_flowing_film_adds_what_dry_contact_lacks() {
        let law = law();
        for gap in [5e-6, -0.05e-6] {
            let (settled, _) = law.settled(gap, SPEED, 1.0);
            let (mut layer, closer) = (settled, gap - 1e-8);
            let pushed = law.flow(&mut layer, closer, SPEED, 1.0, 1e-7);
            close(pushed.force + law.spring.force((-closer).max(0.0)), layer.force);
            close(layer.force, law.spring.force(layer.above - closer));
            close(pushed.heat, 0.5 * (settled.force + layer.force) * (settled.above - layer.above));
            assert!(pushed.force > 0.0 && pushed.heat > 0.0, "{pushed:?}");
        }
    }

    /// Rolling alone carries 4.895 η u R L/h.
    /// Source: THEORY §4.6, (4.19); Martin 1916.
    #[test]
    fn analytic_rolling_alone_carries_the_load_of_martin() {
        let law = law();
        for gap in [20e-6, 100e-6] {
            let (layer, _) = law.settled(gap, SPEED, 1.0);
            let martin = 4.895 * 0.05 * SPEED * 9e-3 * LENGTH / law.thickness(&layer);
            assert!((layer.force / martin - 1.0).abs() < 2e-4, "{} N, not {martin} N", layer.force);
        }
    }

    /// What is left of a film beside the end of its land: nearly all at five widths √(2Rh), three quarters at
    /// one, half at a half, 23 % at the end, and less where the land slopes away.
    /// Source: THEORY §4.6, (4.25) and the fit below it.
    #[test]
    fn analytic_a_film_ends_with_its_land() {
        let law = law();
        let layer = Layer::at(10e-6);
        let h = law.thickness(&layer);
        let width = (2.0 * 9e-3 * h).sqrt();
        for (widths, left) in [(5.0, 0.99), (2.45, 0.96), (1.0, 0.74), (0.5, 0.51), (0.0, 0.23)] {
            let share = law.share([widths * width, 1.0], 0.0, &layer);
            assert!((share - left).abs() < 0.006, "{share} at {widths} widths");
            assert_eq!(law.share([1.0, widths * width], 0.0, &layer), share);
        }
        assert_eq!(law.share([1.0; 2], 0.3, &layer), 1.0);
        let slope = 0.02 * (9e-3 / (2.0 * h)).sqrt();
        let fit = 0.23 / (1.0 + 2.07 * slope + 1.12 * slope.powi(2) + 0.138 * slope.powi(3));
        for tilt in [0.02, -0.02] {
            let share = law.share([-1e-3, 1.0], tilt, &layer);
            assert!((share / fit - 1.0).abs() < 2e-3, "{share}, not {fit}");
        }
    }

    /// Oil resists: a film that is closed carries more than in steady rolling, one that is opened less.
    #[test]
    fn invariant_a_film_acts_against_its_closing_and_its_opening() {
        let law = law();
        let (settled, steady) = law.settled(5e-6, SPEED, 1.0);
        let after = |gap: f64| {
            let mut layer = settled;
            law.flow(&mut layer, gap, SPEED, 1.0, 1e-7)
        };
        let (closed, opened) = (after(4.99e-6), after(5.01e-6));
        assert!(closed.force > steady.force && opened.force < steady.force, "{closed:?} {opened:?}");
        assert!(opened.force > 0.0, "{opened:?}");
    }
}
