//! Priors of fields.

use stribeck_infer::{Prior, snapped};

const PRIORS: [Prior; 4] = [
    Prior::Uniform { from: -2.0, to: 5.0 },
    Prior::LogUniform { from: 0.01, to: 100.0 },
    Prior::Normal { mean: 1.0, sd: 2.0, from: -1.0, to: 10.0 },
    Prior::Choices(4),
];

#[test]
fn roundtrip_shares_and_values() {
    for prior in PRIORS {
        prior.check().unwrap();
        let mut last = f64::NEG_INFINITY;
        for i in 0..=100 {
            let share = f64::from(i) / 100.0;
            let value = prior.quantile(share);
            assert!(value >= last, "{prior:?} rises");
            last = value;
            // Cells of choices have one share each; the normal distribution's are exact to its inverse.
            let back = prior.share(value);
            assert!((back - prior.snap(share)).abs() < 1e-9, "{prior:?}: {share} becomes {back}");
        }
    }
}

/// Abramowitz and Stegun 1964, table 26.1. The middle of a logarithmic range is the geometric mean; half of a
/// normal distribution that is cut off at −1 standard deviations and at 4.5 lies below its mean plus 0.2
/// standard deviations (Φ(−1) = 0.158655, Φ(4.5) = 0.999997; their mean 0.579326 is Φ(0.200174)).
#[test]
fn analytic_medians() {
    assert!((PRIORS[1].quantile(0.5) - 1.0).abs() < 1e-12);
    assert!((PRIORS[2].quantile(0.5) - (1.0 + 2.0 * 0.200_174)).abs() < 1e-5);
    assert_eq!([0.0, 0.2, 0.26, 0.99, 1.0].map(|share| PRIORS[3].quantile(share)), [0.0, 0.0, 1.0, 3.0, 3.0]);
    assert_eq!(snapped(&PRIORS, &[0.1, 0.2, 0.3, 0.4]), [0.1, 0.2, 0.3, 0.375]);
}

#[test]
fn roundtrip_priors_as_text() {
    for prior in PRIORS {
        let text = serde_json::to_string(&prior).unwrap();
        assert_eq!(serde_json::from_str::<Prior>(&text).unwrap(), prior);
    }
}
