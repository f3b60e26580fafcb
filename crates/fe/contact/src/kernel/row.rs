//! The points of one facet of a pass, whole vectors of them: the common part of evaluations of chords and of
//! splines.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};
use stribeck_solver::state::Moment;

use crate::{
    memory::{Candidate, Histories},
    points::{Method, Points},
};
use stribeck_surface::Surface;

/// Room for the points of a facet: two of them may be corners.
const ROOM: usize = Method::MOST_POINTS + LANES;

/// The points of one facet of a pass.
pub(crate) struct Row<'a> {
    pub(crate) candidate: &'a Candidate,
    pub(crate) points: &'a Points,
    /// Of all points of the pass: last facet, time until which they are inactive, and history.
    pub(crate) nearest: &'a [u32],
    pub(crate) inactive_until: &'a mut [f64],
    pub(crate) history: &'a mut Histories,
    /// Surfaces whose points and facets meet, and when: the moment, and steps since the search.
    pub(crate) secondary: &'a Surface,
    pub(crate) primary: &'a Surface,
    pub(crate) at: &'a Moment<'a>,
    pub(crate) now: f64,
}

/// How far vectors of points came.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Outcome {
    pub(crate) touched: bool,
    /// Bits of the active points that are left to scalar code.
    pub(crate) left: u64,
    /// Force on the facet [N].
    pub(crate) force: [f64; 2],
}

/// One where a point is active and not done yet, for all points of a row.
pub(crate) type Active = [f64; ROOM];

impl Row<'_> {
    /// Points that are active, and their bits.
    #[inline(always)]
    pub(crate) fn active<V: Simd>(&self, simd: V) -> (Active, u64) {
        let (range, len) = (self.candidate.range(), Vector::<V>::LEN);
        let n = range.len();
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        let (mut active, mut bits) = ([0.0; ROOM], 0);
        for start in (0..n).step_by(len) {
            let until = Vector::load(simd, self.inactive_until, range.start + start);
            let now = until.choose_below(Vector::all(simd, self.now + 1.0), one, zero);
            let now = now.first(len.min(n - start));
            now.store(&mut active, start);
            bits |= now.bits() << start;
        }
        (active, bits)
    }
}
