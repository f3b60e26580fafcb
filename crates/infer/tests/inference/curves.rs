//! Curves by principal components.

use stribeck_infer::Curves;

const SAMPLES: usize = 40;

/// Rounding of sums over 40 samples.
const CLOSE: f64 = 1e-12;

fn curve(a: f64, b: f64) -> Vec<f64> {
    let at = |k: usize| std::f64::consts::TAU * k as f64 / SAMPLES as f64;
    (0..SAMPLES).map(|k| 2.0 + a * at(k).sin() + b * (2.0 * at(k)).cos()).collect()
}

/// A sine of unit amplitude has the norm √(n/2) over whole periods, and sine and cosine are orthogonal: with
/// amplitudes ±2 and ±1 the variances of the scores are 4 n/2 and n/2 (Jolliffe, *Principal Component
/// Analysis*, 2002, §1.1).
#[test]
fn analytic_two_shapes_and_their_variances() {
    let curves = [(2.0, 1.0), (2.0, -1.0), (-2.0, 1.0), (-2.0, -1.0)].map(|(a, b)| curve(a, b));
    let both = Curves::fit(&curves, 0.999, 10).unwrap();
    assert_eq!(both.shapes.len(), 2);
    assert!((both.variances[0] - 80.0).abs() < 1e-9 && (both.variances[1] - 20.0).abs() < 1e-9);
    assert!((both.kept - 1.0).abs() < CLOSE && both.left_out < 1e-7);
    for curve in &curves {
        let back = both.curve(&both.scores(curve).unwrap()).unwrap();
        assert!(back.iter().zip(curve).all(|(p, q)| (p - q).abs() < CLOSE * 100.0));
    }
    let one = Curves::fit(&curves, 0.7, 10).unwrap();
    assert_eq!(one.shapes.len(), 1);
    assert!((one.kept - 0.8).abs() < CLOSE);
    // The cosine of amplitude 1 that is left out has the root mean square 1/√2.
    assert!((one.left_out - 0.5_f64.sqrt()).abs() < 1e-9, "{}", one.left_out);
    assert!((one.misfit(&curves[0]).unwrap() - 0.5_f64.sqrt()).abs() < 1e-9);
}

#[test]
fn invariant_equal_curves_have_no_shapes() {
    let curves = vec![curve(1.0, 0.0); 3];
    let fitted = Curves::fit(&curves, 0.9, 10).unwrap();
    assert!(fitted.shapes.is_empty() && fitted.misfit(&curves[0]).unwrap() < 1e-12);
}
