//! Pressure between a cylinder and a plane that roll, close or part, in closed form (THEORY §4.6).
//!
//! Gaps are h + x²/2R, places X = x/√(2Rh). The film begins far in front, where both surfaces draw oil in,
//! and ends where pressure and its slope vanish together (Reynolds' condition). The place of that end, c = X,
//! determines the rest: the rate at which the film opens and its force are functions of c alone.

use std::f64::consts::FRAC_PI_2;

use stribeck_simd::lanes::Number;

/// A film that opens so fast that it ends before this place carries less than a two-hundredth of its load
/// at rest: the oil no longer fills the gap.
pub(crate) const EMPTY: f64 = -5.0;

/// The film that ends at a place c, or several of them side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FilmForce<N = f64> {
    /// Force over 4ηuRL/h [-]: 1.2237 when the film neither opens nor closes.
    pub(crate) force: N,
    /// Its derivative by c.
    pub(crate) force_slope: N,
    /// Rate at which the film opens, over u √(h/2R) [-].
    pub(crate) opening: N,
    /// Its derivative by c.
    pub(crate) opening_slope: N,
}

/// ∫ Xᵏ/(1 + X²)³ from −∞ to c, for k = 0 … 3, and the angle π/2 + arctan c.
#[inline(always)]
fn moments<N: Number>(c: N) -> ([N; 4], N) {
    let half = c.constant(0.5);
    let angle = c.constant(FRAC_PI_2) + c.arc_tangent();
    let one = c.constant(1.0);
    let inverse = one / (one + c * c);
    let quarter = c.constant(0.25) * inverse * inverse;
    let both = c * inverse + angle;
    let zeroth = c.times_plus(quarter, c.constant(0.375) * both);
    let second = half * both - zeroth;
    ([zeroth, -quarter, second, quarter - half * inverse], angle)
}

impl<N: Number> FilmForce<N> {
    /// The film that ends at `c`, from [`EMPTY`] on.
    ///
    /// The slope of the pressure is (X − c)(X + c + q)/(1 + X²)³ with the opening q. It must integrate to
    /// nothing.
    #[inline(always)]
    pub(crate) fn until(c: N) -> Self {
        let six = c.constant(-6.0);
        let ([i0, i1, i2, i3], _) = moments(c);
        let lever = c * i0 - i1;
        let rest = i2 - c * i1;
        // c + q, which is small beside c when the film closes fast.
        let sum = rest / lever;
        let opening = sum - c;
        let opening_slope = -(sum + c) * i0 / lever;
        let force = six * (i3 + opening * i2 - c * sum * i1);
        let force_slope = six * (opening_slope * rest - (sum + c) * i1);
        Self { force, force_slope, opening, opening_slope }
    }
}

/// Share of the force that remains at the very end of a land: see [`left_of_land`].
const AT_END: f64 = 0.229_810_2;

/// [`left_of_land`] with the closest approach on the land.
#[inline(always)]
pub(crate) fn left_on_land<N: Number>(edge: N) -> N {
    let (one, half, quarter) = (edge.constant(1.0), edge.constant(0.5), edge.constant(0.25));
    let ([i0, ..], angle) = moments(edge);
    let inverse = one / (one + edge * edge);
    let square = inverse * inverse;
    (half * (angle + edge * inverse) - edge * square - quarter * square * square / i0)
        / edge.constant(FRAC_PI_2)
}

/// [`left_of_land`] with the closest approach at the end, where the land has this slope over √(2h/R).
#[inline(always)]
pub(crate) fn left_at_end<N: Number>(slope: N) -> N {
    let of = |value: f64| slope.constant(value);
    let inner = of(1.12) + slope * of(0.138);
    of(AT_END) / (of(1.0) + slope * (of(2.07) + slope * inner))
}

/// Share of a film's force that remains where the land ends, at a place of the film thickness and radius
/// `2Rh` of its square: with the closest approach on the land, `edge` = X of the end beyond it; with the
/// closest approach at the end itself, minus the slope of the land there over √(2h/R).
///
/// Pure squeeze with no pressure at the end. Beyond the end a fit of the quadrature, good to 4 %.
#[inline]
pub(crate) fn left_of_land(edge: f64) -> f64 {
    if edge > 0.0 { left_on_land(edge) } else { left_at_end(-edge) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The part in front of the first place adds 3/|X| = 3e-5 to the resistance, and next to nothing to the
    /// force.
    const QUADRATURE: f64 = 1e-4;
    const FIRST: f64 = -1e5;

    /// Pressure, force and resistance of the film with the opening q by marching through Reynolds' equation
    /// from far in front, with the end sought by bisection: no closed form.
    fn marched(q: f64) -> [f64; 3] {
        let steps = 20_000;
        let slope = |x: f64, c: f64| (x - c) * (x + c + q) / (1.0 + x * x).powi(3);
        let sum = |c: f64| {
            // X = sinh t reaches far out.
            let (first, last) = (FIRST.asinh(), c.asinh());
            let step = (last - first) / f64::from(steps);
            let mut sums = [0.0; 3];
            for n in 0..steps {
                let t = first + (f64::from(n) + 0.5) * step;
                let x = t.sinh();
                let s = slope(x, c) * t.cosh() * step;
                sums[0] += s;
                sums[1] -= 6.0 * x * s;
                sums[2] += 3.0 * (1.0 + x * x) * s;
            }
            sums
        };
        // With an end too far in front the pressure there is above zero.
        let (mut low, mut high) = (-4.9, 200.0);
        for _ in 0..45 {
            let middle = 0.5 * (low + high);
            if sum(middle)[0] > 0.0 { low = middle } else { high = middle }
        }
        let [_, force, resistance] = sum(low);
        [low, force, resistance]
    }

    /// Resistance to rolling, ∫ h dp, over 4√2 ηuL √(R/h) [-].
    fn resistance(c: f64) -> f64 {
        let opening = FilmForce::until(c).opening;
        let inverse = 1.0 / (1.0 + c * c);
        let half = 0.5 * (FRAC_PI_2 + c.atan());
        3.0 * ((half - 0.5 * c * inverse)
            - 0.5 * opening * inverse
            - c * (c + opening) * (half + 0.5 * c * inverse))
    }

    /// Reynolds' equation for a parabolic gap: A. Cameron, The Principles of Lubrication, Longmans 1966,
    /// chapter 7; with normal motion D. Dowson, P. H. Markho, D. A. Jones, J. Lubr. Technol. 98 (1976)
    /// 509–516.
    #[test]
    fn analytic_films_agree_with_reynolds_equation() {
        for q in [-60.0, -20.0, -4.0, -1.0, 0.0, 1.0, 4.0] {
            let [c, force, rolling] = marched(q);
            let ours = FilmForce::until(c);
            for (ours, theirs) in [(ours.opening, q), (ours.force, force), (resistance(c), rolling)] {
                assert!(
                    (ours - theirs).abs() < QUADRATURE * (1.0 + theirs.abs()),
                    "{q}: {ours}, not {theirs}"
                );
            }
        }
    }

    /// H. M. Martin, Engineering 102 (1916) 119: W/L = 4.9 ηuR/h with the film's end at X = 0.475; pure
    /// squeeze 12π η V (R/2h)^{3/2}: Cameron 1966, chapter 7.
    #[test]
    fn analytic_rolling_alone_and_squeeze_alone() {
        let rest = FilmForce::until(0.475_130);
        assert!(rest.opening.abs() < 1e-5, "{}", rest.opening);
        assert!((4.0 * rest.force - 4.895).abs() < 1e-3, "{}", 4.0 * rest.force);
        // V = −q u √(h/2R): 4ηuR/h · G = 12π ηV (R/2h)^{3/2} is G = −(3π/4) q.
        let squeezed = FilmForce::until(1e4);
        let squeeze = -0.75 * std::f64::consts::PI * squeezed.opening;
        assert!((squeezed.force / squeeze - 1.0).abs() < 1e-6, "{squeezed:?}");
    }

    #[test]
    fn invariant_the_force_falls_as_the_film_opens_and_never_pulls() {
        let mut last = FilmForce::until(1e5);
        for n in 0..2000 {
            let c = EMPTY + 1e5 * (-f64::from(n) * 0.012).exp();
            let film = FilmForce::until(c);
            assert!(film.force > 0.0 && film.force < last.force, "{c}: {film:?}");
            assert!(film.opening > last.opening && resistance(c) > 0.0, "{c}: {film:?}");
            // The work of the surfaces is not below the work returned: u ∫h dp − W ḣ, here over 4√2 ηu²L
            // √(R/h).
            let heat = resistance(c) - 0.5 * film.force * film.opening;
            assert!(heat > 0.0, "{c}: {heat}");
            let h = 1e-6 * (1.0 + c.abs());
            let (low, high) = (FilmForce::until(c - h), FilmForce::until(c + h));
            for (slope, difference) in
                [(film.force_slope, high.force - low.force), (film.opening_slope, high.opening - low.opening)]
            {
                let found = difference / (2.0 * h);
                assert!((slope / found - 1.0).abs() < 1e-4, "{c}: {slope}, not {found}");
            }
            last = film;
        }
        assert!(last.force < 0.007, "{last:?}");
    }

    /// The quadrature that the fit was made from, at three slopes; and the two branches meet.
    #[test]
    fn analytic_a_land_that_ends() {
        assert!((left_of_land(1e-12) - left_of_land(-1e-12)).abs() < 1e-6);
        assert!((left_of_land(20.0) - 1.0).abs() < 2e-4);
        // Squeeze film over 1 + X² with no pressure at the end, by quadrature from far out on the other side.
        for edge in [0.02, 0.3, 1.0, 2.5, 6.0_f64] {
            let (first, steps) = (-12.0, 20_000);
            let step = (edge.asinh() - first) / f64::from(steps);
            let sum = |k: i32| -> f64 {
                (0..steps)
                    .map(|n| (first + (f64::from(n) + 0.5) * step).sinh())
                    .map(|x| x.powi(k) * (1.0 + x * x).powf(-2.5) * step)
                    .sum()
            };
            let [i0, i1, i2] = [0, 1, 2].map(sum);
            let force = (i2 - i1 * i1 / i0) * 8.0 / std::f64::consts::PI;
            assert!(
                (left_of_land(edge) / force - 1.0).abs() < 1e-4,
                "{edge}: {}, not {force}",
                left_of_land(edge)
            );
        }
        // And over half a gap 1 + 2bX + X² from its narrow end on. Both: Cameron 1966, chapter 7.
        for slope in [0.1, 0.5, 1.0, 3.0, 10.0_f64] {
            let step = 1e-3_f64;
            let places = (0..400_000).map(|n| ((f64::from(n) + 0.5) * step).sinh());
            // X = sinh t reaches far out.
            let places: Vec<f64> = places.take_while(|x| *x < 1e4).collect();
            let gap = |x: f64| 1.0 + 2.0 * slope * x + x * x;
            let sum = |k: i32| -> f64 {
                places.iter().map(|x| x.powi(k) / gap(*x).powi(3) * (1.0 + x * x).sqrt() * step).sum()
            };
            let [i0, i1, i2] = [0, 1, 2].map(sum);
            let force = (i2 - i1 * i1 / i0) * 8.0 / std::f64::consts::PI;
            assert!(
                (left_of_land(-slope) / force - 1.0).abs() < 0.04,
                "{slope}: {}",
                left_of_land(-slope) / force
            );
        }
    }
}
