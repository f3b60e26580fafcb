//! Numbers as text, to their significant digits.

/// To `digits` significant digits, without trailing zeros; all digits before the point are kept.
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value:.0}");
    }
    let leading = value.abs().log10().floor() as i32;
    if leading < -6 {
        return format!("{value:.*e}", (digits - 1).max(0) as usize);
    }
    let text = format!("{value:.*}", (digits - 1 - leading).max(0) as usize);
    match text.split_once('.') {
        Some((whole, part)) if part.bytes().all(|b| b == b'0') => whole.to_owned(),
        Some(_) => text.trim_end_matches('0').to_owned(),
        None => text,
    }
}

/// A level without its unit: whole numbers from 10 on, two digits below.
pub fn level(value: f64) -> String {
    significant(value, 2)
}

/// A level in multiples of gravity.
pub fn gravities(g: f64) -> String {
    format!("{} g", level(g))
}

/// A force in kilonewtons, to four digits.
pub fn kilonewtons(force_n: f64) -> String {
    format!("{} kN", significant(1e-3 * force_n, 4))
}

/// A stress in the unit that suits it.
pub fn pascals(stress_pa: f64) -> String {
    if stress_pa >= 1e8 {
        format!("{:.2} GPa", 1e-9 * stress_pa)
    } else {
        format!("{} MPa", significant(1e-6 * stress_pa, 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_numbers_have_as_many_digits_as_say_something() {
        let digits = |value: f64| significant(value, 4);
        assert_eq!([1499.97, 1.399_405, 0.5, 468_396.351_5].map(digits), ["1500", "1.399", "0.5", "468396"]);
        assert_eq!([0.0, -2.0, 1e-9].map(digits), ["0", "-2", "1.000e-9"]);
        assert_eq!([0.0, 0.0312, 9.96, 26.4, 435.4].map(level), ["0", "0.031", "10", "26", "435"]);
        assert_eq!((pascals(3e8), pascals(2.5e5)), ("0.30 GPa".into(), "0.25 MPa".into()));
    }
}
