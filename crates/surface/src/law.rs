//! Contact laws: penalty, damping, Coulomb friction (THEORY §4.2–4.3).

use stribeck_simd::lanes::Number;

use crate::error::Error;

/// Normal and tangential law of one pair of surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Penalty stiffness [Pa/m]: pressure a metre of penetration.
    pub stiffness: f64,
    /// Contact damping [Pa s/m]: pressure a metre a second of approach; zero for none.
    pub damping: f64,
    /// Coulomb coefficient [-]; zero for none.
    pub friction: f64,
    /// Gap at which contact sets in [m]: from there to as deep a penetration the pressure rises as a
    /// parabola, beyond it with the penalty stiffness. Zero for a sharp corner.
    pub onset: f64,
    /// Tangential stiffness while sticking, as a share of the normal one [-].
    pub tangential: f64,
}

/// Tangential stiffness of a contact between like elastic bodies relative to the normal one is 2(1−ν)/(2−ν) =
/// 0.82 (Mindlin); it must not exceed 1, or it would enter the critical time step.
const TANGENTIAL: f64 = 0.8;

impl Law {
    /// Penalty only. Stiffness in [Pa/m].
    ///
    /// # Errors
    /// When the stiffness is not positive.
    pub fn penalty(stiffness: f64) -> Result<Self, Error> {
        check("penalty stiffness [Pa/m]", stiffness, stiffness > 0.0, "positive")?;
        Ok(Self { stiffness, damping: 0.0, friction: 0.0, onset: 0.0, tangential: TANGENTIAL })
    }

    /// Adds damping as a fraction of critical, for surface layers of `mass` [kg/m²] on each side.
    ///
    /// # Errors
    /// When the ratio is negative or above 2.
    pub fn with_damping(mut self, ratio: f64, mass: f64) -> Result<Self, Error> {
        check("contact damping ratio", ratio, (0.0..=2.0).contains(&ratio), "between 0 and 2")?;
        check("surface mass [kg/m²]", mass, mass > 0.0, "positive")?;
        // Two equal masses on one spring: the reduced mass is half of one.
        self.damping = 2.0 * ratio * (self.stiffness * 0.5 * mass).sqrt();
        Ok(self)
    }

    /// Rounds the corner of the law over gaps of up to `onset` [m] to either side.
    ///
    /// # Errors
    /// When it is negative.
    pub fn with_onset(mut self, onset: f64) -> Result<Self, Error> {
        check("contact onset [m]", onset, onset >= 0.0, "zero or positive")?;
        self.onset = onset;
        Ok(self)
    }

    /// Adds Coulomb friction.
    ///
    /// # Errors
    /// When the coefficient is negative or above 10.
    pub fn with_friction(mut self, coefficient: f64) -> Result<Self, Error> {
        check("friction coefficient", coefficient, (0.0..=10.0).contains(&coefficient), "between 0 and 10")?;
        self.friction = coefficient;
        Ok(self)
    }
}

/// The parabola with which the pressure sets in, over any [`Number`] (THEORY §4.2).
#[derive(Debug, Clone, Copy)]
pub struct Onset<N> {
    gap: N,
    quarter: N,
    work: N,
}

impl<N: Number> Onset<N> {
    /// Of the kind of `like`; `None` for the sharp corner.
    #[inline(always)]
    pub fn new(like: N, gap: f64) -> Option<Self> {
        // No closure, see `plane.rs`.
        if gap > 0.0 {
            let [quarter, work] = [0.25 / gap, gap * gap / 6.0];
            Some(Self { gap: like.constant(gap), quarter: like.constant(quarter), work: like.constant(work) })
        } else {
            None
        }
    }

    /// Effective penetration [m], its fall with the gap [-] and its work, all per stiffness, at gaps below
    /// the onset.
    #[inline(always)]
    pub fn depth(&self, gap: N) -> [N; 3] {
        let Self { gap: e, quarter, work } = *self;
        let t = e - gap;
        let (rising, slope) = (quarter * t * t, (quarter + quarter) * t);
        let partial = quarter * t * t * t * e.constant(1.0 / 3.0);
        let whole = (e.constant(0.5) * gap).times_plus(gap, work);
        [
            gap.choose_below(-e, -gap, rising),
            gap.choose_below(-e, e.constant(1.0), slope),
            gap.choose_below(-e, whole, partial),
        ]
    }
}

fn check(field: &'static str, value: f64, ok: bool, allowed: &'static str) -> Result<(), Error> {
    if value.is_finite() && ok { Ok(()) } else { Err(Error::OutOfRange { field, value, allowed }) }
}
