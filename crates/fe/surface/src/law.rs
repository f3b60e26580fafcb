//! Contact laws: penalty, damping, Coulomb friction (THEORY §4.2–4.3).

use stribeck_simd::lanes::Number;

use crate::error::Error;

/// Normal and tangential law of one pair of surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Penalty stiffness [Pa/m]: pressure a metre of penetration.
    pub stiffness: f64,
    /// Contact damping [Pa s/m]: pressure a metre a second of approach; zero for none. Its dashpot stands in
    /// series with a spring of the penalty stiffness.
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

    /// Part of its damping pressure that a point keeps over a step of `dt` [s] (THEORY §4.2).
    pub fn damping_kept(&self, dt: f64) -> f64 {
        if self.damping > 0.0 { self.damping / (self.damping + self.stiffness * dt) } else { 0.0 }
    }

    /// Stiffness of the damping beside the penalty at the highest frequency that steps of `dt` [s] resolve
    /// [Pa/m], at most the penalty's own (THEORY §4.2).
    pub fn damping_stiffness(&self, dt: f64) -> f64 {
        if self.damping > 0.0 {
            self.stiffness / (1.0 + 0.5 * self.stiffness * dt / self.damping)
        } else {
            0.0
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Growth of a vibration from step to step [-] of a mass [kg/m²] that stays in contact, in steps of `dt`
    /// [s].
    fn growth(law: &Law, mass: f64, dt: f64) -> f64 {
        let (mut x, mut v, mut damping) = (1.0_f64, 0.0_f64, 0.0_f64);
        let kept = law.damping_kept(dt);
        let (steps, mut logarithm) = (40_000, 0.0);
        for step in 0..steps {
            damping = kept * damping - (1.0 - kept) * law.damping * v;
            v += dt / mass * (damping - law.stiffness * x);
            x += dt * v;
            let energy = x * x + mass / law.stiffness * v * v;
            let size = (energy + (damping / law.stiffness).powi(2)).sqrt();
            (x, v, damping) = (x / size, v / size, damping / size);
            // The first half lets what decays faster die away.
            logarithm += if 2 * step >= steps { size.ln() } else { 0.0 };
        }
        2.0 * logarithm / f64::from(steps)
    }

    /// k = 8, layers of 4 and half of critical damping: 2 · ½ √(8 · ½ · 4) = 4. Over a step of ½ it keeps
    /// 4/(4 + 8 · ½) of its pressure and is as stiff as 8/(1 + ½ · 8 · ½/4) at most.
    #[test]
    fn by_hand_numbers_of_a_damped_contact() {
        let plain = Law::penalty(8.0).expect("a law");
        let law = plain.with_damping(0.5, 4.0).expect("a law");
        assert_eq!((law.damping, law.damping_kept(0.5)), (4.0, 0.5));
        assert!((law.damping_stiffness(0.5) - 8.0 / 1.5).abs() < 1e-14, "{}", law.damping_stiffness(0.5));
        assert_eq!([plain.damping, plain.friction, plain.onset, plain.damping_kept(0.5)], [0.0; 4]);
        assert_eq!(plain.damping_stiffness(0.5), 0.0);
    }

    #[test]
    fn refuses_numbers_that_no_contact_has() {
        let law = Law::penalty(8.0).expect("a law");
        let refused = [
            ("penalty stiffness [Pa/m]", Law::penalty(0.0)),
            ("contact damping ratio", law.with_damping(-0.01, 1.0)),
            ("contact damping ratio", law.with_damping(2.01, 1.0)),
            ("surface mass [kg/m²]", law.with_damping(1.0, 0.0)),
            ("contact onset [m]", law.with_onset(-1e-9)),
            ("friction coefficient", law.with_friction(-0.01)),
            ("friction coefficient", law.with_friction(10.01)),
            ("friction coefficient", law.with_friction(f64::NAN)),
        ];
        for (which, law) in refused {
            assert!(
                matches!(law, Err(Error::OutOfRange { field, .. }) if field == which),
                "{which}: {law:?}"
            );
        }
        assert!(law.with_damping(2.0, 1.0).is_ok() && law.with_damping(0.0, 1.0).is_ok());
        assert!(law.with_onset(0.0).is_ok() && law.with_friction(10.0).is_ok());
    }

    /// Pressure, its fall with the gap and its work over the stiffness.
    /// Source: THEORY §4.2, (4.10).
    #[test]
    fn analytic_pressure_sets_in_as_a_parabola() {
        let e = 2.0;
        let onset = Onset::new(0.0_f64, e).expect("a rounded corner");
        for gap in [2.0, 1.0, 0.0, -1.0, -1.9, -2.1, -5.0_f64] {
            let t = e - gap;
            let expected = if gap > -e {
                [t * t / (4.0 * e), t / (2.0 * e), t.powi(3) / (12.0 * e)]
            } else {
                [-gap, 1.0, 0.5 * gap * gap + e * e / 6.0]
            };
            let off = onset.depth(gap).iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-14, "{gap}: {:?}, not {expected:?}", onset.depth(gap));
        }
        assert!(Onset::new(0.0_f64, 0.0).is_none());
    }

    /// Whatever the damping, steps are stable up to the bound that the critical step takes, and no farther.
    #[test]
    fn analytic_damped_contacts_are_stable_to_their_bound() {
        for ratio in [0.01, 0.1, 0.8, 2.0] {
            for mass in [0.5, 2.0, 10.0] {
                let law = Law::penalty(2e13).and_then(|law| law.with_damping(ratio, 2.0)).expect("a law");
                // The bound depends on the step; some turns settle both.
                let mut dt = 2.0 * (mass / law.stiffness).sqrt();
                for _ in 0..60 {
                    dt = 2.0 * (mass / (law.stiffness + law.damping_stiffness(dt))).sqrt();
                }
                assert!(law.damping_stiffness(dt) <= law.stiffness);
                for (factor, grows) in [(0.5, false), (0.98, false), (0.999, false), (1.002, true)] {
                    let growth = growth(&law, mass, factor * dt);
                    assert_eq!(growth > 0.0, grows, "{ratio}, {mass}, {factor}: {growth:e} a step");
                }
            }
        }
    }

    /// Slow vibrations lose what a dashpot alone takes from them.
    #[test]
    fn analytic_slow_vibrations_lose_what_a_dashpot_takes() {
        let law = Law::penalty(2e13).and_then(|law| law.with_damping(0.8, 2.0)).expect("a law");
        let (mass, dt) = (2000.0, 70e-9);
        let expected = -0.5 * law.damping / mass * dt;
        let lost = (law.stiffness / mass).sqrt() * law.damping / law.stiffness;
        let found = growth(&law, mass, dt);
        assert!((found / expected - 1.0).abs() < 2.0 * lost * lost + 0.01, "{found:e}, not {expected:e}");
    }
}
