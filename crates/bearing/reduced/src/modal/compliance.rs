//! Local compliance of bodies beside a contact, beyond penalty and modes, as a curve over the force (THEORY
//! §9.3).

use serde::{Deserialize, Serialize};

/// Approach C(F) = F g(√F) of two bodies at the load F [m], beyond the approach in modes and penalty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Compliance {
    /// Distance of the knots over y = √F [√N].
    spacing: f64,
    /// g at the knots [m/N].
    flexibility: Vec<f64>,
    /// ∫ C dF up to the knots [J].
    integral: Vec<f64>,
}

impl Compliance {
    /// Through approaches C at ascending loads above zero.
    pub fn through(loads: &[f64], approaches: &[f64], knots: usize) -> Self {
        let most = loads.last().copied().unwrap_or(1.0).sqrt();
        let spacing = most / knots as f64;
        let g: Vec<[f64; 2]> = loads.iter().zip(approaches).map(|(f, c)| [f.sqrt(), c / f]).collect();
        let at = |y: f64| {
            let i = g.partition_point(|p| p[0] < y).clamp(1, g.len().max(2) - 1);
            match (g.get(i - 1), g.get(i)) {
                (Some(a), Some(b)) => {
                    let t = ((y - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0);
                    a[1] + t * (b[1] - a[1])
                }
                (Some(a), None) => a[1],
                _ => 0.0,
            }
        };
        let flexibility: Vec<f64> = (0..=knots + 1).map(|i| at(spacing * i as f64)).collect();
        let mut compliance = Self { spacing, flexibility, integral: vec![0.0] };
        let mut sum = 0.0;
        for i in 0..=knots {
            sum += compliance.between(i, spacing);
            compliance.integral.push(sum);
        }
        compliance
    }

    /// ∫ C dF = ∫ 2 y³ g dy from knot `i` over `dy`.
    fn between(&self, i: usize, dy: f64) -> f64 {
        let (y, g) = (self.spacing * i as f64, self.flexibility[i]);
        let slope = (self.flexibility[i + 1] - g) / self.spacing;
        // Gauss' rule with three points is exact: the integrand is of the fourth degree.
        [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)]
            .into_iter()
            .map(|(at, weight)| {
                let z = 0.5 * dy * (1.0 + at);
                weight / 18.0 * dy * 2.0 * (y + z).powi(3) * (g + slope * z)
            })
            .sum()
    }

    /// The curve as a step evaluates it.
    pub fn curve(&self) -> Curve {
        let slope = |i: usize| (self.flexibility[i + 1] - self.flexibility[i]) / self.spacing;
        let pieces: Vec<[f64; 2]> =
            (0..self.flexibility.len() - 1).map(|i| [self.flexibility[i], slope(i)]).collect();
        let more = pieces.iter().enumerate().zip(&self.integral).map(|((i, [first, slope]), integral)| {
            let y = self.spacing * i as f64;
            integral - y.powi(4) * (0.5 * (first - slope * y) + 0.4 * slope * y)
        });
        let spans = pieces.iter().enumerate().map(|(i, [first, slope])| {
            let next = if i + 1 < pieces.len() { (i + 1) as f64 } else { f64::INFINITY };
            [self.spacing * i as f64, *first, *slope, self.spacing * next]
        });
        let (spans, more) = (spans.collect(), more.collect());
        Curve { spacing: self.spacing, per_spacing: 1.0 / self.spacing, spans, more, pieces }
    }

    /// The largest load that the curve holds [N].
    pub fn largest_load(&self) -> f64 {
        (self.spacing * (self.flexibility.len() - 2) as f64).powi(2)
    }

    /// Stiffness of penalty and compliance in series at the largest load that the curve holds [N/m].
    pub fn stiffest(&self, penalty: f64, radius: f64) -> f64 {
        let most = self.largest_load();
        1.0 / (1.0 / (penalty * contact_length(most, penalty, radius))
            + self.curve().approach(most).0[1].max(0.0))
    }
}

/// Length 2a [m] of a round contact with the relative radius R [m] under a load F [N] on a penalty k t
/// [N/m²]: F = ⅔ k t a³/R.
pub fn contact_length(load: f64, penalty: f64, radius: f64) -> f64 {
    2.0 * libm::cbrt(1.5 * load * radius / penalty)
}

/// The curve C(F), piece by piece.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Distance of the knots over y = √F [√N], and one over it.
    spacing: f64,
    per_spacing: f64,
    /// g at the beginning of each piece [m/N], and by how much it grows with y.
    pieces: Vec<[f64; 2]>,
    /// Of each piece: where it begins over y, g there, by how much it grows with y, and where it ends.
    spans: Vec<[f64; 4]>,
    /// Excess of ∫ C dF at each piece over that of a curve all of which lies on this piece [J].
    more: Vec<f64>,
}

impl Curve {
    /// Energy stored at a force [J]: ∫ F dC.
    pub fn energy(&self, force: f64) -> f64 {
        let y = force.sqrt();
        let piece = ((y * self.per_spacing) as usize).min(self.pieces.len() - 1);
        let [first, slope] = self.pieces[piece];
        let intercept = first - self.spacing * piece as f64 * slope;
        // F C less ∫ C dF = ∫ 2 y³ g dy.
        force * force * (0.5 * intercept + 0.6 * slope * y) - self.more[piece]
    }

    /// Where the first piece ends over y = √F [√N].
    #[inline(always)]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Approach [m] and its derivative [m/N] at a force that is not negative [N], and the piece that it lies
    /// on.
    #[inline(always)]
    pub fn approach(&self, force: f64) -> ([f64; 2], usize) {
        let y = force.sqrt();
        let piece = ((y * self.per_spacing) as usize).min(self.pieces.len() - 1);
        (self.on(piece, force, y), piece)
    }

    /// Of the piece at y = √F: where it begins over y, g there, by how much it grows with y, and where it
    /// ends.
    #[inline(always)]
    pub fn piece_at(&self, y: f64) -> [f64; 4] {
        self.spans[((y * self.per_spacing) as usize).min(self.spans.len() - 1)]
    }

    /// Approach and derivative, with a guess of the piece.
    #[inline(always)]
    pub fn approach_near(&self, force: f64, piece: usize) -> [f64; 2] {
        let y = force.sqrt();
        let beyond = y * self.per_spacing - piece as f64;
        if (0.0..1.0).contains(&beyond) { self.on(piece, force, y) } else { self.approach(force).0 }
    }

    #[inline(always)]
    fn on(&self, piece: usize, force: f64, y: f64) -> [f64; 2] {
        let [first, slope] = self.pieces[piece];
        let g = first + slope * (y - self.spacing * piece as f64);
        [force * g, g + 0.5 * y * slope]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stored energy grows with the force as the approach times the force, on every piece and from one to
    /// the next.
    /// Source: own, d(F C − ∫ C dF)/dF = F dC/dF.
    #[test]
    fn analytic_the_energy_of_a_compliance_is_the_work_of_its_force() {
        let loads = [100.0, 1e3, 5e3, 2e4];
        let approaches = [0.2e-6, 1.4e-6, 5e-6, 17e-6];
        let curve = Compliance::through(&loads, &approaches, 48).curve();
        let mut work = 0.0;
        let steps = 200_000;
        for n in 0..steps {
            let [before, after] = [n, n + 1].map(|n| 2e4 * f64::from(n) / f64::from(steps));
            let [from, to] = [before, after].map(|force| curve.approach(force).0[0]);
            work += 0.5 * (before + after) * (to - from);
            if n % 1000 == 999 {
                let off = curve.energy(after) - work;
                assert!(off.abs() < 1e-9 * work.max(1e-3), "{off} J of {work} J at {after} N");
            }
        }
    }
}
