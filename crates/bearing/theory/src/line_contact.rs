//! Approach of two raceways with a roller pressed between them: plane-strain line contacts (THEORY §6.2).

use crate::bearing::Bearing;

/// By how much the contact of a mesh is wider than Hertz's: over the square of the penalty's own half-width, and
/// over the length of a facet.
const WIDTH_BY_PENALTY: f64 = 1.2;
const WIDTH_BY_FACET: f64 = 0.65;

/// The two contacts of one roller in series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineContacts {
    /// (1 − ν²)/(π E) [m²/N].
    softness: f64,
    /// E* = E/(2(1 − ν²)) [Pa].
    modulus: f64,
    /// Poisson's ratio [-].
    poisson: f64,
    /// Radius of the roller [m].
    roller: f64,
    /// Length of the roller over that of the contact [-].
    share: f64,
    /// Outer and inner contact: effective radius and ring thickness [m]; no thickness of a ring that does not
    /// deform.
    sides: [(f64, Option<f64>); 2],
}

impl LineContacts {
    /// Of a roller of this bearing.
    pub fn of(bearing: impl Into<Bearing>) -> Self {
        let bearing = bearing.into();
        let (m, nu) = (&bearing.material, bearing.material.poissons_ratio);
        Self {
            softness: (1.0 - nu * nu) / (std::f64::consts::PI * m.youngs_modulus),
            modulus: m.contact_modulus(),
            poisson: nu,
            roller: bearing.roller_radius,
            share: 1.0,
            sides: [
                (bearing.outer_contact_radius(), bearing.outer_ring_thickness),
                (bearing.inner_contact_radius(), Some(bearing.inner_ring_thickness)),
            ],
        }
    }

    /// The same where rollers are this share of the rings as long, and give way as much more.
    #[must_use]
    pub fn with_shorter_rollers(self, share: f64) -> Self {
        Self { share, ..self }
    }

    /// Approach of the two raceways [m] under the line load `w` [N/m], and its derivative [m²/N].
    ///
    /// ```text
    /// b² = 4 w R / (π E*)
    /// δ  = Σ w (1−ν²)/(π E) · [2 ln(4 r/b) − 1 + 2 ln(2 h/b) − ν/(1−ν)]     over both contacts
    /// ```
    pub fn approach(&self, w: f64) -> (f64, f64) {
        let mut sum = (0.0, 0.0);
        for side in 0..2 {
            let (approach, slope) = self.approach_at(side, w);
            sum.0 += approach;
            sum.1 += slope;
        }
        sum
    }

    /// The same of one contact: 0 the outer, 1 the inner one.
    pub fn approach_at(&self, side: usize, w: f64) -> (f64, f64) {
        let (_, depth) = self.sides[side];
        let flexibility = self.flexibility(side, self.half_width(side, w));
        // b grows with the root of w, so each logarithm loses 1/(2w).
        (w * flexibility, flexibility - self.softness * logarithms(depth))
    }

    /// Half-width b of a contact [m] under the line load `w` [N/m].
    fn half_width(&self, side: usize, w: f64) -> f64 {
        let (radius, depth) = self.sides[side];
        // Against a rigid ring the contact is half as soft.
        let modulus = if depth.is_some() { self.modulus } else { 2.0 * self.modulus };
        (4.0 * w * radius / (std::f64::consts::PI * modulus)).sqrt()
    }

    /// Approach over line load [m²/N] of bodies that are pressed over a half-width [m].
    fn flexibility(&self, side: usize, half_width: f64) -> f64 {
        let roller = 2.0 * libm::log(4.0 * self.roller / half_width) - 1.0;
        let of_ring =
            |depth: f64| 2.0 * libm::log(2.0 * depth / half_width) - self.poisson / (1.0 - self.poisson);
        self.softness * (roller / self.share + self.sides[side].1.map_or(0.0, of_ring))
    }

    /// Approach at one contact [m] under the line load `w` [N/m] where bodies are meshed with facets of `facet`
    /// [m] and pressed together through a penalty `stiffness` [Pa/m]:
    ///
    /// ```text
    /// d = (3w/(4k√(2R)))^⅔      b_m² = b² + 1.2 · 2Rd + (0.65 facet)²      δ_m = d + δ(w; b_m)
    /// ```
    ///
    /// Source: own; both numbers are fitted to the local problem of the reduced model, whose sums over both
    /// contacts this meets within 3 % (THEORY §6.2).
    pub fn approach_on_mesh(&self, side: usize, w: f64, facet: f64, stiffness: f64) -> f64 {
        let (radius, _) = self.sides[side];
        let depth = libm::pow(0.75 * w / (stiffness * (2.0 * radius).sqrt()), 2.0 / 3.0);
        let widened = WIDTH_BY_PENALTY * 2.0 * radius * depth + (WIDTH_BY_FACET * facet).powi(2);
        depth + w * self.flexibility(side, (self.half_width(side, w).powi(2) + widened).sqrt())
    }

    /// Line load [N/m] at the approach `delta` [m], and its derivative [N/m²]; `None` beyond the largest
    /// approach for which the law holds: its stiffness vanishes where contacts are as wide as the roller.
    pub fn load(&self, delta: f64) -> Option<(f64, f64)> {
        // δ(w) is concave, so Newton from below never overshoots; 80 is more than the logarithms of any real
        // load.
        let mut w = delta / (80.0 * self.softness);
        for _ in 0..100 {
            let (at, slope) = self.approach(w);
            let step = (delta - at) / slope;
            w = (w + step).max(0.1 * w);
            if step.abs() <= 1e-14 * w {
                break;
            }
        }
        let (at, slope) = self.approach(w);
        (slope > 0.0 && (at - delta).abs() <= 1e-9 * delta).then_some((w, 1.0 / slope))
    }

    /// Energy of the contacts under the line load `w` at the approach `delta` that it makes [J/m]: ∫ w dδ, by
    /// parts w δ less ∫ δ dw, in which each logarithm of w leaves w²/4.
    pub fn energy(&self, w: f64, delta: f64) -> f64 {
        let all: f64 = self.sides.iter().map(|(_, depth)| logarithms(*depth)).sum();
        0.5 * w * delta - 0.25 * all * self.softness * w * w
    }
}

/// Logarithms of the load in the approach of one contact, whose ring may be rigid.
fn logarithms(depth: Option<f64>) -> f64 {
    if depth.is_some() { 2.0 } else { 1.0 }
}
