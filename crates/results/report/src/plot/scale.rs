//! Tick positions and their texts with SI prefixes.

/// A power of ten and its prefix, chosen once for all ticks of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Stored value of one displayed unit.
    pub factor: f64,
    /// SI prefix, empty for one.
    pub prefix: &'static str,
}

const PREFIXES: [Scale; 9] = [
    Scale { factor: 1e-12, prefix: "p" },
    Scale { factor: 1e-9, prefix: "n" },
    Scale { factor: 1e-6, prefix: "µ" },
    Scale { factor: 1e-3, prefix: "m" },
    Scale { factor: 1.0, prefix: "" },
    Scale { factor: 1e3, prefix: "k" },
    Scale { factor: 1e6, prefix: "M" },
    Scale { factor: 1e9, prefix: "G" },
    Scale { factor: 1e12, prefix: "T" },
];

impl Scale {
    /// No prefix.
    pub const ONE: Self = PREFIXES[4];

    /// The prefix under which `largest` reads as 1 to 1000.
    pub fn of(largest: f64) -> Self {
        // The small factor keeps 0.999 999 999 9e3, a rounded 1 k, from reading "1000".
        let size = largest.abs() * (1.0 + 1e-9);
        if size == 0.0 || !size.is_finite() {
            return Self::ONE;
        }
        PREFIXES.iter().rev().find(|p| size >= p.factor).copied().unwrap_or(PREFIXES[0])
    }

    /// Text of `value` with enough decimals to tell neighbours `step` apart, prefix and unit appended.
    pub fn text(&self, value: f64, step: f64, unit: &str) -> String {
        let decimals = (-(step / self.factor).log10() - 1e-9).ceil().clamp(0.0, 9.0);
        let places = if decimals.is_finite() { decimals as usize } else { 0 };
        let number = format!("{:.places$}", value / self.factor).replace('-', "−");
        let zero = number.trim_start_matches('−');
        let shown = if zero.chars().all(|c| c == '0' || c == '.') { zero } else { &number };
        match (self.prefix, unit) {
            ("", "") => shown.to_owned(),
            (prefix, unit) => format!("{shown} {prefix}{unit}"),
        }
    }
}

/// Round positions (1, 2 or 5 times a power of ten) inside `[low, high]`, about `wanted` of them, and their
/// step.
pub fn ticks(low: f64, high: f64, wanted: usize) -> (Vec<f64>, f64) {
    let span = high - low;
    if !span.is_finite() || span <= 0.0 {
        return (vec![low], 1.0);
    }
    let rough = span / wanted.max(1) as f64;
    let power = 10f64.powf(rough.log10().floor());
    let step = power * [1.0, 2.0, 5.0].into_iter().find(|m| m * power >= 0.7 * rough).unwrap_or(10.0);
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    ((first..=last).map(|n| n as f64 * step).collect(), step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_prefixes_of_units() {
        assert_eq!(Scale::of(0.03).text(0.005, 0.005, "s"), "5 ms");
        assert_eq!(Scale::of(0.03).text(0.016_18, 0.000_01, "s"), "16.18 ms");
        assert_eq!(Scale::of(50_000.0).text(-10_000.0, 10_000.0, "Hz"), "−10 kHz");
        assert_eq!(Scale::ONE.text(-0.0, 20.0, ""), "0");
        assert_eq!(Scale::of(1e3).prefix, "k");
    }

    #[test]
    fn by_hand_ticks_are_round() {
        let (at, step) = ticks(-183.0, 176.0, 7);
        assert_eq!((at, step), (vec![-150.0, -100.0, -50.0, 0.0, 50.0, 100.0, 150.0], 50.0));
        let (at, step) = ticks(4000.0, 6000.0, 8);
        assert_eq!((at.len(), step), (11, 200.0));
    }
}
