//! Stiffness of a bearing between rigid rings at one angle of its cage, THEORY §6.6.
//!
//! One ring is shifted against the other until the rolling elements carry the load; the stiffness is the
//! derivative of their force by the shift. Speed enters by the centrifugal force, which presses elements to
//! the outer raceway. Defects, friction and oil do not enter.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::bearing::Bearing;
use crate::contact_law::{ContactLaw, ContactLawKind, element_mass};
use crate::error::Error;
use crate::kinematics::Kinematics;

/// Unbalanced force, as a part of the load, at which the search ends.
const TOLERANCE: f64 = 1e-10;
/// Damped Newton iterations; about ten are needed.
const MAX_ITERATIONS: usize = 300;

/// A symmetric tensor in the plane: xx, xy, yy.
pub type Symmetric = [f64; 3];

/// Equilibrium at one angle of the cage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingState {
    /// Shift of the shaft against the housing [m], (x, y), in fixed axes.
    pub shift_m: [f64; 2],
    /// Stiffness xx, xy, yy [N/m] in these axes.
    pub stiffness_n_m: Symmetric,
    /// Elements that touch both raceways.
    pub loaded: usize,
    /// Largest force at an inner contact [N].
    pub largest_n: f64,
}

/// A bearing between rigid rings, at one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct TurningRings {
    law: ContactLaw,
    /// Elements, all of them round and none missing.
    elements: usize,
    /// Half the diametral clearance [m].
    clearance_m: f64,
    /// Centrifugal force of each element [N].
    outwards_n: f64,
    /// Angle of the middle of the load zone [rad].
    load_zone: f64,
    /// −1 where the cage turns clockwise as seen from the outer ring, else 1.
    sense: f64,
}

impl TurningRings {
    /// A bearing without defects that moves as `kinematics` says, with the middle of its load zone at the
    /// angle `load_zone` [rad], counter-clockwise from the x axis.
    pub fn new(
        bearing: impl Into<Bearing>,
        kind: ContactLawKind,
        kinematics: &Kinematics,
        load_zone: f64,
    ) -> Self {
        let bearing = bearing.into();
        let path = 0.5 * (bearing.outer_race_radius + bearing.inner_race_radius);
        Self {
            law: ContactLaw::of(bearing, kind),
            elements: bearing.rollers,
            clearance_m: 0.5 * bearing.clearance,
            outwards_n: element_mass(&bearing, kind) * kinematics.cage_rad_s.powi(2) * path,
            load_zone,
            sense: -kinematics.sense(),
        }
    }

    /// The same without the centrifugal force of its elements.
    #[must_use]
    pub fn at_rest(self) -> Self {
        Self { outwards_n: 0.0, ..self }
    }

    /// The same with another diametral clearance [m].
    #[must_use]
    pub fn with_clearance(self, clearance_m: f64) -> Self {
        Self { clearance_m: 0.5 * clearance_m, ..self }
    }

    /// Equilibrium under `load_n` while the cage stands `cage` [rad] past the angle at which an element is in
    /// the middle of the load zone, in the sense in which it turns against the outer ring.
    ///
    /// # Errors
    /// [`Error::Input`] for a load that is not positive; [`Error::NoEquilibrium`] where the law of contact
    /// ends before the load is carried.
    pub fn equilibrium(&self, load_n: f64, cage: f64) -> Result<RingState, Error> {
        if !(load_n > 0.0 && load_n.is_finite()) {
            return Err(Error::Input {
                field: "load_n",
                value: load_n,
                allowed: "above 0 N".to_owned(),
                suggestion: "A bearing without load has play, and no stiffness",
            });
        }
        // In a frame whose y axis points to the middle of the load zone.
        let directions: Vec<[f64; 2]> = (0..self.elements)
            .map(|i| FRAC_PI_2 + TAU * i as f64 / self.elements as f64 + self.sense * cage)
            .map(|angle| [libm::cos(angle), libm::sin(angle)])
            .collect();
        let (alone, _) = self.law.approach(0, load_n + self.outwards_n);
        let reach = self.clearance_m.abs() + alone + self.law.approach(1, load_n).0;
        let mut shift = [0.0, self.clearance_m.max(0.0) + 0.5 * alone];
        let mut now = self.carried(shift, load_n, &directions);
        // Forces of interference and centrifugal ones may be larger than the load, and so is their rounding
        // error; that of a light load comes from the shift.
        let enough = |at: &Carried| {
            let rounding = 4.0 * f64::EPSILON * reach * (at.stiffness[0] + at.stiffness[2]);
            let least = TOLERANCE * load_n.max(at.largest_n).max(self.outwards_n);
            at.loaded > 0 && at.unbalanced() <= least + rounding
        };
        for _ in 0..MAX_ITERATIONS {
            if enough(&now) {
                return Ok(self.state(shift, &now));
            }
            let step = now.newton_step(reach);
            let mut scale = 1.0;
            (shift, now) = loop {
                let next = [shift[0] + scale * step[0], shift[1] + scale * step[1]];
                let tried = self.carried(next, load_n, &directions);
                // The potential is convex: it has fallen all the way to a point where force still pushes on.
                if tried.unbalanced() < now.unbalanced() || tried.pushes(step) || scale < 1e-9 {
                    break (next, tried);
                }
                scale *= 0.5;
            };
        }
        Err(Error::NoEquilibrium { iterations: MAX_ITERATIONS, residual_n: now.unbalanced(), load_n })
    }

    /// Force of the elements on a shifted shaft [N].
    fn carried(&self, shift: [f64; 2], load_n: f64, directions: &[[f64; 2]]) -> Carried {
        let mut out = Carried { left: [0.0, load_n], stiffness: [0.0; 3], loaded: 0, largest_n: 0.0 };
        for n in directions {
            let approach = shift[0] * n[0] + shift[1] * n[1] - self.clearance_m;
            let Some((force, k)) = self.law.force(approach, self.outwards_n) else {
                return Carried { left: [f64::INFINITY; 2], ..out };
            };
            if force > 0.0 {
                out.left = [out.left[0] - force * n[0], out.left[1] - force * n[1]];
                out.stiffness[0] += k * n[0] * n[0];
                out.stiffness[1] += k * n[0] * n[1];
                out.stiffness[2] += k * n[1] * n[1];
                out.loaded += 1;
                out.largest_n = out.largest_n.max(force);
            }
        }
        out
    }

    /// A state in fixed axes.
    fn state(&self, shift: [f64; 2], carried: &Carried) -> RingState {
        let (s, c) = libm::sincos(self.load_zone - FRAC_PI_2);
        let [xx, xy, yy] = carried.stiffness;
        RingState {
            shift_m: [c * shift[0] - s * shift[1], s * shift[0] + c * shift[1]],
            stiffness_n_m: [
                c * c * xx - 2.0 * s * c * xy + s * s * yy,
                s * c * (xx - yy) + (c * c - s * s) * xy,
                s * s * xx + 2.0 * s * c * xy + c * c * yy,
            ],
            loaded: carried.loaded,
            largest_n: carried.largest_n,
        }
    }
}

struct Carried {
    /// Load less the forces of the elements [N].
    left: [f64; 2],
    stiffness: Symmetric,
    loaded: usize,
    largest_n: f64,
}

impl Carried {
    fn unbalanced(&self) -> f64 {
        libm::hypot(self.left[0], self.left[1])
    }

    /// Whether the force that is left pushes on along a step; not where the law of contact ends.
    fn pushes(&self, step: [f64; 2]) -> bool {
        self.left[0].is_finite() && self.left[0] * step[0] + self.left[1] * step[1] > 0.0
    }

    /// Shift that balances the linearised forces [m], no longer than `reach` [m].
    fn newton_step(&self, reach: f64) -> [f64; 2] {
        let [xx, xy, yy] = self.stiffness;
        // One loaded element alone leaves a direction without stiffness, none leaves two.
        let trace = 1e-9 * (xx + yy) + self.unbalanced() * 1e-3 / reach;
        let solved = |more: f64| {
            let (xx, yy) = (xx + more, yy + more);
            let determinant = xx * yy - xy * xy;
            let [fx, fy] = self.left;
            [(yy * fx - xy * fy) / determinant, (xx * fy - xy * fx) / determinant]
        };
        let step = solved(trace);
        if libm::hypot(step[0], step[1]) <= reach { step } else { solved(trace + self.unbalanced() / reach) }
    }
}
