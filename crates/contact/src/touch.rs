//! What acts at one point in contact, and what it remembers (THEORY §4.2–4.3).

use serde::{Deserialize, Serialize};
use stribeck_simd::{field::Field, lanes::LANES};

use crate::law::Law;

/// What a point in contact remembers of the step before.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct History {
    /// Elastic part of the tangential displacement [m].
    slip: f64,
    /// Damping force [N].
    damping: f64,
}

/// Histories of points, one array a field.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Histories {
    pub(crate) slip: Field,
    pub(crate) damping: Field,
}

impl Histories {
    /// Whether there is one for each of `n` points, and room behind them.
    pub(crate) fn serve(&self, n: usize) -> bool {
        self.slip.len() == n + LANES && self.damping.len() == n + LANES
    }

    #[inline(always)]
    pub(crate) fn get(&self, i: usize) -> History {
        History { slip: self.slip[i], damping: self.damping[i] }
    }

    /// See [`Histories::get`].
    #[inline(always)]
    pub(crate) fn set(&mut self, i: usize, history: History) {
        (self.slip[i], self.damping[i]) = (history.slip, history.damping);
    }
}

/// Sums over one pass.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    /// Force on the secondary body [N].
    pub(crate) force: [f64; 2],
    /// Elastic energy [J].
    pub(crate) stored: f64,
    /// Heat of friction in the last step [J].
    pub(crate) friction: f64,
    /// Heat of damping in the last step [J].
    pub(crate) damping: f64,
    /// Deepest effective penetration [m]; zero where nothing acts.
    pub(crate) penetration: f64,
}

/// How a point moves against its foot.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Slide {
    /// Rate of the gap [m/s].
    pub(crate) opening: f64,
    /// Tangential velocity, to the left of the normal [m/s].
    pub(crate) along: f64,
}

/// Pressure force, damping included, and shear force of a point in contact [N]; updates its history.
#[inline(always)]
pub(crate) fn touch(
    gap: f64,
    area: f64,
    law: &Law,
    dt: f64,
    slide: Slide,
    history: &mut History,
    sum: &mut Sum,
) -> [f64; 2] {
    let stiffness = law.stiffness * area;
    let [depth, fall, work] = law.depth(gap);
    let elastic = stiffness * depth;
    sum.stored += stiffness * work;
    sum.penetration = sum.penetration.max(depth);
    // Damping sets in with the stiffness and never pulls: the sum of both stays a pressure.
    let damping = (-law.damping * fall * area * slide.opening).max(-elastic);
    // Work of a force over a step is the mean of its two ends times the displacement (THEORY §2.5).
    sum.damping -= 0.5 * (history.damping + damping) * slide.opening * dt;
    history.damping = damping;
    let normal = elastic + damping;
    if law.friction == 0.0 {
        return [normal, 0.0];
    }
    let moved = slide.along * dt;
    let tangential = law.tangential * stiffness;
    // µ · elastic / tangential, without the division.
    let limit = law.friction / law.tangential * depth;
    let before = history.slip;
    let after = (before + moved).clamp(-limit, limit);
    history.slip = after;
    let stored = 0.5 * tangential * after * after;
    sum.stored += stored;
    sum.friction +=
        0.5 * tangential * (before + after) * moved - (stored - 0.5 * tangential * before * before);
    [normal, -tangential * after]
}

impl History {
    /// Whether there is nothing to settle.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.slip == 0.0 && self.damping == 0.0
    }

    /// The point lost contact: settles the last half step and forgets it.
    pub(crate) fn release(&mut self, area: f64, law: &Law, dt: f64, slide: Slide, sum: &mut Sum) {
        let tangential = law.tangential * law.stiffness * area;
        sum.damping -= 0.5 * self.damping * slide.opening * dt;
        sum.friction += 0.5 * tangential * self.slip * (slide.along * dt + self.slip);
        *self = Self::default();
    }
}
