//! What oil takes from the motion of rollers: resistance of films to rolling and sliding, and churning
//! (THEORY §4.6).
//!
//! Speeds are those against a frame that goes with the roller about the bearing's centre. There both surfaces
//! move past the contact, `u₁` that of the roller and `u₂` that of the raceway, counter-clockwise positive.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{
    contact::raceway::Raceway,
    drive::RingRotation,
    modal::parameters as modal,
    oil::{Films, Lubrication},
    rollers::block::Block,
    row::{Row, load, store},
};

/// Rolling resistance of a film over η u L √(R/h): ∫ h dp from far upstream to where it ends.
const ROLLING: f64 = 9.2;

/// Shear of a film over η L √(2R/h) times the speed of sliding: π/2 + arctan of where it ends.
const SHEAR: f64 = 2.014;

/// Drag coefficient of a cylinder across a flow, Reynolds numbers 10³ to 10⁵ (Hoerner 1965).
const DRAG: f64 = 1.1;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Resistance {
    /// η L [N s/m].
    viscous: f64,
    /// Relative radii at the outer and the inner raceway [m].
    relative: [f64; 2],
    /// Radius of rollers [m].
    radius: f64,
    /// Force of churning over the square of a roller's speed [N s²/m²].
    churning: f64,
}

/// What resistance does besides the forces on rollers.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Resisted {
    /// Moments that the drives of outer and inner ring make good [N m].
    pub(crate) drive: [f64; 2],
    /// Power lost [W].
    pub(crate) power: f64,
}

impl Lubrication {
    /// Thicknesses of the thinnest films of eight rollers at both raceways [m], endless where there is none.
    pub(crate) fn thicknesses(&self, films: &Films, block: &Block) -> [Row; 2] {
        std::array::from_fn(|k| {
            let (race, mut rows) = (&self.raceways[k], Row([f64::INFINITY; LANES]));
            for lane in 0..block.count {
                let formed = race.lands() * (block.first + lane);
                let film = |land: usize| match (block.films.round() >> lane) & 1 {
                    1 => block.films.on[k][land].film(lane),
                    _ => films.at[k][formed + land],
                };
                rows[lane] = race.thinnest((0..race.lands()).map(film));
            }
            rows
        })
    }
}

impl Resistance {
    pub(crate) fn new(
        resistance: &modal::Resistance,
        viscosity: f64,
        raceways: &[Raceway; 2],
        radius: f64,
        length: f64,
    ) -> Self {
        Self {
            viscous: viscosity * length,
            relative: raceways.each_ref().map(|raceway| raceway.relative),
            radius,
            churning: 0.5 * resistance.density * DRAG * 2.0 * radius * length,
        }
    }

    /// Adds to the forces on eight rollers what films of these thicknesses [m], endless where there is none,
    /// and the oil that they push along take from their motion.
    #[inline(always)]
    pub(crate) fn act<S: Simd>(
        &self,
        simd: S,
        block: &mut Block,
        thickness: &[Row; 2],
        rings: [Option<RingRotation>; 2],
    ) -> Resisted {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, half) = (all(0.0), all(0.5));
        let size = |number: Vector<S>| number.max(-number);
        let (mut drive, mut power) = ([zero; 2], zero);
        for at in vector_starts(simd) {
            let present = Vector::load(simd, &block.present, at);
            let distance = Vector::load(simd, &block.distance, at);
            let ([rx, ry], [vx, vy]) = (load(simd, &block.radial, at), load(simd, &block.velocity, at));
            let spin = Vector::load(simd, &block.spin, at);
            let along = rx.times_plus(vy, -(ry * vx));
            let orbit = along / distance;
            let mut moment = zero;
            for (k, side) in [1.0, -1.0].into_iter().enumerate() {
                let arm = all(side * self.radius);
                let race = all(rings[k].map_or(0.0, |ring| ring.rate));
                let surface = distance + arm;
                let [u1, u2] = [(spin - orbit) * arm, (race - orbit) * surface];
                let root = present / Vector::load(simd, &thickness[k], at).sqrt();
                let rolling = all(ROLLING * self.viscous * self.relative[k].sqrt()) * half * (u1 + u2) * root;
                let shear = all(SHEAR * self.viscous * (2.0 * self.relative[k]).sqrt()) * (u1 - u2) * root;
                // Half of the resistance to rolling shears each surface; the pressure balances both.
                let force = rolling * (surface / distance - half) - shear;
                let about = -(arm * half.times_plus(rolling, shear));
                let [fx, fy] = load(simd, &block.force[k], at);
                store([fx - force * ry, force.times_plus(rx, fy)], &mut block.force[k], at);
                let on_ring = distance.times_plus(force, about);
                drive[k] = drive[k] + on_ring;
                power = power + race * on_ring - force.times_plus(along, about * spin);
                moment = moment + about;
            }
            (Vector::load(simd, &block.moment, at) + moment).store(&mut block.moment, at);
            let pushed = all(self.churning) * present * size(along) * along;
            power = pushed.times_plus(along, power);
            let [x, y] = load(simd, &block.downhill, at);
            store([pushed.times_plus(ry, x), y - pushed * rx], &mut block.downhill, at);
        }
        // One by one: the closure of a map over an array is not compiled for the vectors in it.
        Resisted { drive: [drive[0].sum(), drive[1].sum()], power: power.sum() }
    }
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;

    use super::*;

    /// An NU 205 in thin oil: radii of raceways and roller [m].
    const RACES: [f64; 2] = [23e-3, 15.5e-3];
    const RADIUS: f64 = 3.75e-3;
    const PATH: f64 = 19.25e-3;
    const RESISTANCE: Resistance =
        Resistance { viscous: 0.02 * 9e-3, relative: [4.48e-3, 3.02e-3], radius: RADIUS, churning: 1.5e-3 };
    const ROUNDING: f64 = 1e-12;

    /// One roller at the angle 0 with its orbit and its spin [rad/s], the inner ring at `race` [rad/s]; what
    /// films of these thicknesses do to it, its tangential forces at both raceways and its moment.
    fn resisted(orbit: f64, spin: f64, race: f64, thickness: [f64; 2]) -> (Resisted, [f64; 3]) {
        let mut block = Block::default();
        block.present[0] = 1.0;
        block.distance = Row([PATH; LANES]);
        block.radial[0] = Row([1.0; LANES]);
        block.velocity[1][0] = orbit * PATH;
        block.spin[0] = spin;
        let rings = [None, Some(RingRotation { rate: race, ..RingRotation::STILL })];
        let resisted = RESISTANCE.act(Scalar::new(), &mut block, &thickness.map(|h| Row([h; LANES])), rings);
        (resisted, [block.force[0][1][0], block.force[1][1][0], block.moment[0]])
    }

    /// Rolling without slip at both raceways takes 9.2 η u² L √(R/h) at each, and the drive supplies it: no moment
    /// is left over.
    /// Source: A. Cameron, The Principles of Lubrication, Longmans 1966, chapter 5: ∫ h dp of Martin's film.
    #[test]
    fn analytic_rolling_without_slip_costs_the_work_against_the_wedge() {
        let (orbit, race) = (100.0, 100.0 * 2.0 * PATH / RACES[1]);
        let spin = -orbit * (PATH / RADIUS);
        let film = 0.4e-6;
        for (k, thickness) in [[film, f64::INFINITY], [f64::INFINITY, film]].into_iter().enumerate() {
            let (resisted, forces) = resisted(orbit, spin, race, thickness);
            let speed = orbit * RACES[0];
            let wedge = 9.2 * 0.02 * 9e-3 * speed * (RESISTANCE.relative[k] / film).sqrt();
            let churned = 1.5e-3 * (orbit * PATH).powi(3);
            let power = wedge * speed + churned;
            assert!((resisted.power / power - 1.0).abs() < 0.01, "{} W, not {power} W", resisted.power);
            // The pressure goes through the centre of the raceway: its couple is that of shear alone.
            let shear = -0.5 * wedge * RACES[k] * [-1.0, 1.0][k];
            assert!(
                (resisted.drive[k] / -shear - 1.0).abs() < 0.01,
                "{} N m, not {shear}",
                resisted.drive[k]
            );
            assert!(forces[2] > 0.0, "against its spin: {forces:?}");
        }
    }

    /// A roller that stands still between turning rings is dragged along by shear, and a film that is not there
    /// does nothing.
    /// Source: Couette's flow, ηL√(2R/h) times the width of Martin's film (Cameron 1966, chapter 5).
    #[test]
    fn analytic_sliding_shears_the_film() {
        let film = 0.4e-6;
        let (resisted, [outer, inner, moment]) = resisted(0.0, 0.0, 1000.0, [f64::INFINITY, film]);
        let width = (2.0 * RESISTANCE.relative[1] / film).sqrt();
        let speed = 1000.0 * (PATH - RADIUS);
        let shear = SHEAR * 0.02 * 9e-3 * width * speed;
        let wedge = 9.2 * 0.02 * 9e-3 * 0.5 * speed * (RESISTANCE.relative[1] / film).sqrt();
        let pushed = shear + wedge * ((PATH - RADIUS) / PATH - 0.5);
        assert!((inner / pushed - 1.0).abs() < ROUNDING, "{inner} N, not {pushed} N");
        assert_eq!(outer, 0.0);
        assert!(moment < 0.0 && resisted.power > 0.0, "{moment} N m, {} W", resisted.power);
    }
}
