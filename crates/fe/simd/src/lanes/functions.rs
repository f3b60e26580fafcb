//! Functions of vectors that processors have no instruction for.

use pulp::Simd;

use super::{LANES, Number, Vector};

/// Above this a number is turned by a quarter of a turn, and above [`NEAR`] by an eighth, before its arcus
/// tangent is taken: tan 3π/8, and about tan π/5.
const FAR: f64 = 2.414_213_562_373_095;
const NEAR: f64 = 0.66;

/// Polynomials in the square, highest power first, whose ratio times the cube the arcus tangent has beyond
/// its argument up to [`NEAR`]. Source: S. L. Moshier, Methods and Programs for Mathematical Functions, Ellis
/// Horwood 1989 (Cephes, `atan.c`); peak error 1.8·10⁻¹⁶.
const ABOVE: [f64; 5] = [
    -0.875_060_860_003_190_4,
    -16.157_537_187_333_653,
    -75.008_557_923_147_05,
    -122.886_668_449_013_61,
    -64.850_219_049_420_25,
];
const BELOW: [f64; 6] = [
    1.0,
    24.858_464_901_423_063,
    165.027_009_831_698_85,
    432.881_060_491_290_27,
    485.390_399_635_913_7,
    194.550_657_148_261_4,
];

/// Bits of the first guess of a cube root, beyond a third of those of the number: within 3.5 %. Source: W.
/// Kahan and K. C. Ng, FreeBSD's `s_cbrt.c`.
const THIRD: u64 = 715_094_163 << 32;

/// Smaller numbers have no cube root but zero.
const SMALLEST: f64 = 1e-200;

/// A polynomial, its highest power first.
#[inline(always)]
fn polynomial<S: Simd, const N: usize>(coefficients: &[f64; N], at: Vector<S>) -> Vector<S> {
    let mut sum = at.constant(coefficients[0]);
    for &coefficient in &coefficients[1..] {
        sum = sum.times_plus(at, at.constant(coefficient));
    }
    sum
}

/// Arcus tangent, to the last digit or two.
#[inline(always)]
pub(super) fn arc_tangent<S: Simd>(of: Vector<S>) -> Vector<S> {
    let (zero, one) = (of.constant(0.0), of.constant(1.0));
    let size = of.max(-of);
    let (near, far) = (of.constant(NEAR), of.constant(FAR));
    let over = far.choose_below(size, -one, near.choose_below(size, size - one, size));
    let under = far.choose_below(size, size, near.choose_below(size, size + one, one));
    let turned = far.choose_below(
        size,
        of.constant(std::f64::consts::FRAC_PI_2),
        near.choose_below(size, of.constant(std::f64::consts::FRAC_PI_4), zero),
    );
    let left = over / under;
    let square = left * left;
    let beyond = square * polynomial(&ABOVE, square) / polynomial(&BELOW, square);
    let angle = turned + beyond.times_plus(left, left);
    of.choose_below(zero, -angle, angle)
}

/// Cube root of numbers that are not negative, within 3·10⁻¹⁴ of it.
#[inline(always)]
pub(super) fn cube_root<S: Simd>(of: Vector<S>) -> Vector<S> {
    let zero = of.constant(0.0);
    let smallest = of.constant(SMALLEST);
    let number = of.max(smallest);
    let mut guesses = [0.0; LANES];
    number.store(&mut guesses, 0);
    for guess in &mut guesses[..Vector::<S>::LEN] {
        *guess = f64::from_bits(guess.to_bits() / 3 + THIRD);
    }
    let mut root = Vector::load(number.simd(), &guesses, 0);
    // Halley's method: two thirds of the cube of the error are left.
    let twice = number + number;
    for _ in 0..2 {
        let cube = root * root * root;
        root = root * (cube + twice) / (cube + cube + number);
    }
    smallest.choose_below(of, root, zero)
}
