//! The law of a pair as one pass applies it: its share of the stiffness, the static preload's rounded corner,
//! and the speeds assumed for inactive points (THEORY §3.2, §4.1).

use stribeck_surface::{Law, law::Onset};

/// Speeds are allowed for with this margin until the next look.
pub(crate) const SPEED_MARGIN: f64 = 2.0;

/// Least speed assumed until then [m/s]: that of a surface at rest after an impact.
pub(crate) const LEAST_SPEED: f64 = 2.0;

/// A point allows for this part of the fastest approach too: bodies turn by less than a tenth while it is
/// inactive.
const FASTEST_OVER: f64 = 16.0;

/// Decay factor of a pass's pace from one evaluation to the next.
pub(crate) const PACE_KEPT: f64 = 0.99;

/// Longest time between two searches or looks at a point, in steps: speeds may change meanwhile.
pub(crate) const MOST_STEPS_APART: f64 = 400.0;

/// The law of a pass; the static preload takes the penalty alone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PassLaw {
    pub(crate) law: Law,
    /// Thickness times the share of this pass [m].
    pub(crate) thickness: f64,
    /// Fastest approach of two points [m/s], for leaving distant points alone.
    pub(crate) fastest: f64,
    /// Rounds the corner of the penalty law over about this gap [m]; zero for the law itself.
    pub(crate) softness: f64,
    /// Whether points may be done together.
    pub(crate) together: bool,
}

impl PassLaw {
    /// Larger gaps than this carry nothing [m].
    #[inline(always)]
    pub(crate) fn reach(&self) -> f64 {
        // Beyond 30 softnesses the rounded law is below 1e-13 of one softness of penetration.
        if self.softness > 0.0 { 30.0 * self.softness } else { self.law.onset }
    }

    /// Approach allowed for however slow a point is [m/s].
    pub(crate) fn least_speed(&self) -> f64 {
        LEAST_SPEED.max(self.fastest / FASTEST_OVER)
    }

    /// Effective penetration [m] and its slope [-] at a gap within reach (THEORY §3.2).
    pub(crate) fn rounded(&self, gap: f64) -> [f64; 2] {
        let e = self.softness;
        if e == 0.0 {
            let onset = Onset::new(gap, self.law.onset).map(|onset| onset.depth(gap));
            return onset.map_or([-gap, 1.0], |[depth, slope, _]| [depth, slope]);
        }
        let t = -gap / e;
        let depth = if t > 30.0 { -gap } else { e * libm::log1p(libm::exp(t)) };
        [depth, 1.0 / (1.0 + libm::exp(-t))]
    }
}
