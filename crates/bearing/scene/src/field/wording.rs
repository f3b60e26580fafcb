//! How numbers, values and lists are written in messages: short, whatever the user wrote.

/// Longer values are cut.
const SHOWN: usize = 40;

/// A number with at most nine significant digits, as RON reads it; very large and very small ones with an
/// exponent.
pub(crate) fn number(value: f64) -> String {
    let rounded = format!("{value:.8e}").parse::<f64>().unwrap_or(value);
    let plain = rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) || !rounded.is_finite();
    if plain { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// Rounds away from zero to `digits` significant digits.
pub(crate) fn round_up(value: f64, digits: i32) -> f64 {
    to_digits(value, digits, f64::ceil)
}

/// Rounds towards zero to `digits` significant digits.
pub(crate) fn round_down(value: f64, digits: i32) -> f64 {
    to_digits(value, digits, f64::floor)
}

/// Rounds a positive number to `digits` significant digits; one that is too small for that is not changed.
fn to_digits(value: f64, digits: i32, round: fn(f64) -> f64) -> f64 {
    if !value.is_normal() {
        return value;
    }
    let power = digits - 1 - value.log10().floor() as i32;
    // A negative power of ten is no binary fraction; dividing by its inverse leaves less dust.
    if power >= 0 {
        let scale = 10_f64.powi(power);
        round(value * scale) / scale
    } else {
        let scale = 10_f64.powi(-power);
        round(value / scale) * scale
    }
}

/// The user's text on one line, shortened.
pub fn shown(text: &str) -> String {
    let line: String = text.chars().take(SHOWN).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(SHOWN).is_some() { line + "…" } else { line }
}

/// `` `a`, `b`, `c` ``.
pub fn list(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_numbers_are_short_and_read_back() {
        for (value, text) in [
            (1e308, "1e308"),
            (-f64::MAX, "-1.79769313e308"),
            (5e-324, "5e-324"),
            (1e-320, "1e-320"),
            (0.1 + 0.2, "0.3"),
            (24.0, "24"),
            (50_000.0, "50000"),
            (1e7, "1e7"),
            (-0.0001, "-0.0001"),
            (0.000_05, "5e-5"),
            (18_446_744_073_709_551_615.0, "1.84467441e19"),
            (0.0, "0"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn by_hand_rounding_keeps_its_direction() {
        assert_eq!((round_up(17.51, 2), round_down(17.51, 2)), (18.0, 17.0));
        assert_eq!((round_up(0.001_21, 2), round_down(0.001_29, 2)), (0.0013, 0.0012));
        assert_eq!((round_up(123_456.0, 1), round_down(123_456.0, 1)), (200_000.0, 100_000.0));
    }
}
