//! The distribution of an output about its prediction: Student's t, whose scale and degrees of freedom are
//! those of the cross-validated residuals.

use statrs::{
    distribution::{ContinuousCDF, StudentsT},
    function::gamma::ln_gamma,
};

use crate::random::{normal_quantile, normal_share};

/// Degrees of freedom that are tried. The last stands for a normal distribution.
const FREEDOMS: [f64; 7] = [3.0, 4.0, 5.0, 7.0, 10.0, 20.0, f64::INFINITY];

/// Scale and shape of standardised residuals.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Tails {
    /// Scale of the distribution in units of the predicted standard deviation.
    pub(crate) scale: f64,
    freedom: f64,
    /// Constant of the logarithm of the density.
    constant: f64,
}

impl Tails {
    /// Of residuals in units of their predicted standard deviations: most likely, with the prior that the
    /// prediction is right within a factor of about 1.3 and that tails are normal unless a likelihood ratio
    /// of e² says otherwise. Each counts by its weight.
    pub(super) fn fit(residuals: &[f64], weights: &[f64]) -> Self {
        let mut best = (f64::NEG_INFINITY, Self::of(1.0, f64::INFINITY));
        for freedom in FREEDOMS {
            let shape = Self::of(1.0, freedom);
            let score = |scale: f64| {
                let one = |(z, w): (&f64, &f64)| w * (shape.log_density(z / scale) - scale.ln());
                let sum: f64 = residuals.iter().zip(weights).map(one).sum();
                sum - 0.5 * (scale.ln() / 0.25).powi(2) - if freedom.is_finite() { 2.0 } else { 0.0 }
            };
            let logarithm = maximum(|x| score(x.exp()), -3.0, 3.0);
            let value = score(logarithm.exp());
            if value > best.0 {
                best = (value, Self::of(logarithm.exp(), freedom));
            }
        }
        best.1
    }

    fn of(scale: f64, freedom: f64) -> Self {
        let constant = if freedom.is_finite() {
            ln_gamma(0.5 * (freedom + 1.0))
                - ln_gamma(0.5 * freedom)
                - 0.5 * (freedom * std::f64::consts::PI).ln()
        } else {
            -0.5 * (2.0 * std::f64::consts::PI).ln()
        };
        Self { scale, freedom, constant }
    }

    /// Standard deviation in units of the scale.
    pub(crate) fn deviation(&self) -> f64 {
        if self.freedom.is_finite() { (self.freedom / (self.freedom - 2.0)).sqrt() } else { 1.0 }
    }

    /// Logarithm of the density of a residual in units of the scale.
    pub(crate) fn log_density(&self, t: f64) -> f64 {
        if self.freedom.is_finite() {
            self.constant - 0.5 * (self.freedom + 1.0) * (t * t / self.freedom).ln_1p()
        } else {
            self.constant - 0.5 * t * t
        }
    }

    /// Share of the distribution below a residual in units of the scale.
    pub(crate) fn share(&self, t: f64) -> f64 {
        match StudentsT::new(0.0, 1.0, self.freedom) {
            Ok(distribution) if self.freedom.is_finite() => distribution.cdf(t),
            _ => normal_share(t),
        }
    }

    /// The residual, in units of the scale, with a share of the distribution below it.
    pub(crate) fn quantile(&self, share: f64) -> f64 {
        match StudentsT::new(0.0, 1.0, self.freedom) {
            Ok(distribution) if self.freedom.is_finite() => distribution.inverse_cdf(share),
            _ => normal_quantile(share),
        }
    }

    /// The normal deviate with the same share below it as a residual in units of the scale.
    pub(crate) fn normal(&self, t: f64) -> f64 {
        if self.freedom.is_finite() {
            let below = self.share(-t.abs()).max(1e-300);
            normal_quantile(below).abs().copysign(t)
        } else {
            t
        }
    }
}

/// Where a function with one maximum between two numbers has it, by golden sections.
fn maximum(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..40 {
        if fa > fb {
            (high, b, fb) = (b, a, fa);
            a = high - GOLDEN * (high - low);
            fa = f(a);
        } else {
            (low, a, fa) = (a, b, fb);
            b = low + GOLDEN * (high - low);
            fb = f(b);
        }
    }
    0.5 * (low + high)
}
