//! Static load distribution over the rollers between two rigid rings, THEORY §6.
//!
//! After Stribeck and Sjövall, with a radial clearance and the bearing's law of contact. An elastic outer ring
//! spreads the load differently by 10–20 %.

use crate::bearing::Bearing;
use crate::contact_law::{ContactLaw, ContactLawKind};
use crate::error::Error;

/// Unbalanced force, as a part of the load, at which the search ends.
const TOLERANCE: f64 = 1e-10;
/// The search is a damped Newton iteration on a convex energy; it needs about ten.
const MAX_ITERATIONS: usize = 200;
/// Longest step of the search, over the sum of clearance and the approach of a roller that carries
/// everything: where few rollers touch, or none, a direction has no stiffness to limit it.
const REACH: f64 = 10.0;
/// Shortest part of a step that is tried.
const SHORTEST: f64 = 1e-9;

/// Load and approach of each roller in static equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticLoad {
    /// Displacement of the outer ring towards the inner one [m], (x, y).
    pub shift_m: [f64; 2],
    /// Radial force through each roller [N], zero where there is a gap; in the order of the angles.
    pub roller_n: Vec<f64>,
    /// Elastic approach of the two raceways at each roller [m]; negative where there is a gap.
    pub approach_m: Vec<f64>,
}

impl StaticLoad {
    /// Largest roller load [N].
    pub fn max_roller_n(&self) -> f64 {
        self.roller_n.iter().copied().fold(0.0, f64::max)
    }

    /// Largest approach [m].
    pub fn max_approach_m(&self) -> f64 {
        self.approach_m.iter().copied().fold(0.0, f64::max)
    }

    /// Rollers that carry load.
    pub fn loaded_rollers(&self) -> usize {
        self.roller_n.iter().filter(|load| **load > 0.0).count()
    }
}

/// Two rigid rings with elastic contacts between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidRings {
    /// Radial clearance at each roller when the rings are concentric [m]: half the diametral one.
    clearance_m: f64,
    law: ContactLaw,
}

impl RigidRings {
    /// Rings, rolling elements and material of a bearing, with a law of contact.
    pub fn new(bearing: impl Into<Bearing>, law: ContactLawKind) -> Self {
        let b = bearing.into();
        Self {
            clearance_m: b.outer_race_radius - b.inner_race_radius - 2.0 * b.roller_radius,
            law: ContactLaw::of(b, law),
        }
    }

    /// Approach of the two raceways at a roller [m] under the force `load_n` [N] through it: both its
    /// contacts.
    pub fn approach_m(&self, load_n: f64) -> f64 {
        self.law.both(load_n)
    }

    /// Equilibrium of the outer ring under `load_n`, downwards, over rollers at `angles_deg` (90° is the
    /// top).
    ///
    /// A roller without load because it lies in a defect is not listed. Horizontal forces balance too, so the
    /// angles need not be symmetric.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for a load that is not positive, or for rollers between which the ring would fall;
    /// [`Error::NoEquilibrium`] when the load is beyond the law of a line contact.
    pub fn distribute(&self, load_n: f64, angles_deg: &[f64]) -> Result<StaticLoad, Error> {
        if !(load_n > 0.0 && load_n.is_finite()) {
            return Err(Error::Input {
                field: "load_n",
                value: load_n,
                allowed: "above 0 N".to_owned(),
                suggestion: "A bearing without load has no load distribution",
            });
        }
        // From the load to the nearest roller on either side, one under the load counting as both.
        let nearest = |side: f64| {
            angles_deg.iter().map(|angle| (side * (angle - 90.0)).rem_euclid(360.0)).fold(360.0, f64::min)
        };
        if nearest(1.0) + nearest(-1.0) > 180.0 - 1e-6 {
            return Err(Error::Input {
                field: "bearing.rollers",
                value: angles_deg.len() as f64,
                allowed: "more, until two loaded ones are less than half a turn apart about the load"
                    .to_owned(),
                suggestion: "The ring would fall past the rollers: take more of them, or fewer that are \
                    missing or over a defect",
            });
        }
        let directions: Vec<[f64; 2]> = angles_deg
            .iter()
            .map(|angle| [libm::cos(angle.to_radians()), libm::sin(angle.to_radians())])
            .collect();
        self.newton(load_n, &directions)
    }

    /// Damped Newton iteration on the ring's displacement; the energy is convex, so the residual's energy
    /// norm falls.
    fn newton(&self, load_n: f64, directions: &[[f64; 2]]) -> Result<StaticLoad, Error> {
        // Start where every upper roller is pressed a little: the stiffness is then regular.
        let mut shift = [0.0, -2.0 * self.clearance_m - 1e-6];
        let mut residual = self.residual(shift, load_n, directions);
        let reach = REACH * (self.clearance_m.abs() + 1e-6 + self.approach_m(load_n));
        for _ in 0..MAX_ITERATIONS {
            if residual.force() <= TOLERANCE * load_n || residual.force() <= self.rounding(shift, &residual) {
                return Ok(self.solution(shift, directions));
            }
            let step = residual.newton_step(reach);
            let mut scale = 1.0;
            (shift, residual) = loop {
                let next = [shift[0] + scale * step[0], shift[1] + scale * step[1]];
                let tried = self.residual(next, load_n, directions);
                // Armijo on the energy; at the end rounding hides the decrease, so a smaller force is enough.
                let slope = step[0] * residual.unbalanced[0] + step[1] * residual.unbalanced[1];
                let enough = tried.energy <= residual.energy - 1e-4 * scale * slope;
                let hidden = tried.energy <= residual.energy + 1e-12 * residual.energy.abs();
                if enough || hidden && tried.force() < residual.force() || scale < SHORTEST {
                    break (next, tried);
                }
                scale *= 0.5;
            };
        }
        Err(Error::NoEquilibrium { iterations: MAX_ITERATIONS, residual_n: residual.force(), load_n })
    }

    /// Force [N] that rounding of the displacement leaves: a light load cannot be balanced better.
    fn rounding(&self, shift: [f64; 2], residual: &Residual) -> f64 {
        let [xx, _, yy] = residual.stiffness;
        2.0 * f64::EPSILON * (xx + yy) * (libm::hypot(shift[0], shift[1]) + self.clearance_m.abs())
    }

    /// Approach at a roller [m]: the outer ring moves against the roller's direction, less the clearance.
    fn approach(&self, shift: [f64; 2], direction: [f64; 2]) -> f64 {
        -(shift[0] * direction[0] + shift[1] * direction[1]) - self.clearance_m
    }

    fn residual(&self, shift: [f64; 2], load_n: f64, directions: &[[f64; 2]]) -> Residual {
        let mut out = Residual { unbalanced: [0.0, -load_n], energy: load_n * shift[1], stiffness: [0.0; 3] };
        for n in directions {
            let approach = self.approach(shift, *n);
            if approach <= 0.0 {
                continue;
            }
            let Some((force, k, energy)) = self.law.between(approach) else {
                return Residual { energy: f64::INFINITY, ..out };
            };
            out.unbalanced[0] += force * n[0];
            out.unbalanced[1] += force * n[1];
            out.stiffness[0] += k * n[0] * n[0];
            out.stiffness[1] += k * n[0] * n[1];
            out.stiffness[2] += k * n[1] * n[1];
            out.energy += energy;
        }
        out
    }

    fn solution(&self, shift_m: [f64; 2], directions: &[[f64; 2]]) -> StaticLoad {
        let approach_m: Vec<f64> = directions.iter().map(|n| self.approach(shift_m, *n)).collect();
        let load = |delta: &f64| {
            if *delta > 0.0 { self.law.between(*delta).map_or(0.0, |(force, ..)| force) } else { 0.0 }
        };
        StaticLoad { shift_m, roller_n: approach_m.iter().map(load).collect(), approach_m }
    }
}

/// Forces on the outer ring at one trial displacement.
struct Residual {
    /// Contact forces and load [N].
    unbalanced: [f64; 2],
    /// Energy [J], up to a constant.
    energy: f64,
    /// Stiffness xx, xy, yy [N/m].
    stiffness: [f64; 3],
}

impl Residual {
    fn force(&self) -> f64 {
        libm::hypot(self.unbalanced[0], self.unbalanced[1])
    }

    /// Displacement that balances the linearised forces [m], no longer than `reach` [m].
    fn newton_step(&self, reach: f64) -> [f64; 2] {
        // A single loaded roller leaves one direction without stiffness; a trace of it keeps the step finite.
        let trace = 1e-9 * (self.stiffness[0] + self.stiffness[2]) + f64::MIN_POSITIVE;
        let step = self.balanced_with(trace);
        // Springs of this stiffness alone would let it go as far as that.
        if libm::hypot(step[0], step[1]) <= reach {
            step
        } else {
            self.balanced_with(trace + self.force() / reach)
        }
    }

    /// The same with springs `more` [N/m] in all directions.
    fn balanced_with(&self, more: f64) -> [f64; 2] {
        let [xx, xy, yy] = self.stiffness;
        let (xx, yy) = (xx + more, yy + more);
        let determinant = xx * yy - xy * xy;
        let [fx, fy] = self.unbalanced;
        [(yy * fx - xy * fy) / determinant, (xx * fy - xy * fx) / determinant]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bearing::singh2014::BEARING;

    /// The reference table prints three digits.
    const PRINTED: f64 = 0.01;

    /// Angles of rollers, the first of them at `first` [°].
    fn angles_deg(rollers: usize, first: f64) -> Vec<f64> {
        (0..rollers).map(|n| first - 360.0 * n as f64 / rollers as f64).collect()
    }

    fn centred(thickness_mm: f64, without: &[usize]) -> StaticLoad {
        let mut angles = angles_deg(24, 90.0);
        for at in without {
            angles.remove(*at);
        }
        let rings =
            RigidRings::new(Bearing { thickness: 1e-3 * thickness_mm, ..BEARING }, ContactLawKind::Line);
        rings.distribute(50_000.0, &angles).expect("equilibrium")
    }

    /// A roller stands under the load; thickness [mm], loaded rollers, largest load [kN], approach [µm], gain
    /// of the neighbours when that roller unloads.
    #[test]
    fn analytic_load_distribution_of_the_paper_bearing() {
        for (thickness, loaded, max_kn, approach_um, gain) in [
            (5.0, 11, 9.20, 80.0, 1.21),
            (10.0, 9, 9.65, 45.7, 1.22),
            (20.0, 9, 10.40, 26.5, 1.22),
            (50.0, 7, 11.98, 13.3, 1.26),
        ] {
            let load = centred(thickness, &[]);
            assert_eq!(load.loaded_rollers(), loaded, "t = {thickness} mm");
            let close = |ours: f64, theirs: f64| (ours / theirs - 1.0).abs() < PRINTED;
            assert!(close(load.max_roller_n() / 1e3, max_kn), "{} kN", load.max_roller_n() / 1e3);
            assert!(close(load.max_approach_m() * 1e6, approach_um), "{} µm", load.max_approach_m() * 1e6);
            let unloaded = centred(thickness, &[0]);
            let ratio = unloaded.max_roller_n() / load.roller_n[1];
            assert!(close(ratio, gain), "gain {ratio} at t = {thickness} mm");
        }
    }

    #[test]
    fn analytic_stribeck_number_without_clearance() {
        // Without clearance and with Q ∝ δ, Q_max = 4 W/Z; line contact stiffens a little: Stribeck's 4.08.
        let rings = RigidRings::new(Bearing { inner_race_radius: 82e-3, ..BEARING }, ContactLawKind::Line);
        let load = rings.distribute(50_000.0, &angles_deg(24, 90.0)).expect("equilibrium");
        let stribeck = load.max_roller_n() * 24.0 / 50_000.0;
        assert!((stribeck - 4.08).abs() < 0.06, "{stribeck}");
    }

    #[test]
    fn conserves_the_load_in_both_directions() {
        let angles = angles_deg(24, 94.0);
        let load = RigidRings::new(BEARING, ContactLawKind::Line)
            .distribute(50_000.0, &angles)
            .expect("equilibrium");
        let mut sum = [0.0, 0.0];
        for (force, angle) in load.roller_n.iter().zip(angles) {
            sum[0] += force * angle.to_radians().cos();
            sum[1] += force * angle.to_radians().sin();
        }
        assert!((sum[1] / 50_000.0 - 1.0).abs() < 1e-9 && sum[0].abs() < 1e-4, "{sum:?}");
    }

    #[test]
    fn survives_any_load_that_a_bearing_may_carry() {
        // Under light loads the search passes positions without contact, from which it must not leave the
        // bearing. With few rollers one of them may carry alone. Between rigid rings the law of the contact
        // has fewer logarithms.
        for rollers in [3, 4, 5, 24] {
            for turned in 0..8 {
                let first = 90.0 + 45.0 * turned as f64 / rollers as f64;
                let angles = angles_deg(rollers, first);
                for inner_race_radius in [81.9e-3, 81.95e-3, 81.975e-3, 82e-3] {
                    let outer_ring_thickness = BEARING.outer_ring_thickness.filter(|_| turned % 2 == 0);
                    let rings = RigidRings::new(
                        Bearing { inner_race_radius, outer_ring_thickness, ..BEARING },
                        ContactLawKind::Line,
                    );
                    for load_n in (-6..12).map(|power| 10.0_f64.powf(0.5 * f64::from(power))) {
                        let load = rings
                            .distribute(load_n, &angles)
                            .unwrap_or_else(|why| panic!("{rollers}: {why}"));
                        let up = |(force, angle): (&f64, &f64)| force * angle.to_radians().sin();
                        let carried: f64 = load.roller_n.iter().zip(&angles).map(up).sum();
                        assert!(
                            (carried / load_n - 1.0).abs() < 1e-6,
                            "{carried} of {load_n} N on {rollers} at {first}°"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn refuses_bad_loads_and_positions() {
        let rings = RigidRings::new(BEARING, ContactLawKind::Line);
        for load_n in [0.0, f64::NAN] {
            stribeck_testing::assert_refused(rings.distribute(load_n, &[60.0, 90.0, 120.0]), "above 0 N");
        }
        for fallen in [&[270.0][..], &[30.0, 60.0], &[80.0, 260.1], &[]] {
            let why = rings.distribute(1.0, fallen).unwrap_err().to_string();
            assert!(why.contains("`bearing.rollers` is") && why.contains("about the load"), "{why}");
        }
        // 10^15 N squeeze the bearing flat: an error, never a hang.
        stribeck_testing::assert_refused(
            rings.distribute(1e15, &[60.0, 90.0, 120.0]),
            "no static load distribution found",
        );
    }
}
