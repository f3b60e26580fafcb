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

/// A probability as it is said: `100 %`, `40 %`, `1 in 300`, `1 in 2 million`.
pub fn chance(p: f64) -> String {
    if !p.is_finite() {
        return "unknown".to_owned();
    }
    if p >= 0.995 {
        return "100 %".to_owned();
    }
    if p >= 0.01 {
        return format!("{:.0} %", 100.0 * p);
    }
    // Far beyond any test of the noise only a bound is given.
    if p < 1e-9 {
        return "below 1 in a billion".to_owned();
    }
    let digits = 10_f64.powf((1.0 / p).log10().floor());
    let count = (1.0 / p / digits).round() * digits;
    if count >= 1e6 { format!("1 in {:.0} million", 1e-6 * count) } else { format!("1 in {count:.0}") }
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
    fn behaves_numbers_have_as_many_digits_as_say_something() {
        let digits = |value: f64| significant(value, 4);
        assert_eq!([1499.97, 1.399_405, 0.5, 468_396.351_5].map(digits), ["1500", "1.399", "0.5", "468396"]);
        assert_eq!([0.0, -2.0, 1e-9].map(digits), ["0", "-2", "1.000e-9"]);
        assert_eq!([0.0, 0.0312, 9.96, 26.4, 435.4].map(level), ["0", "0.031", "10", "26", "435"]);
        let chances = [1.0, 0.42, 0.031, 3.2e-3, 4.6e-5, 4.6e-7, 1e-12].map(chance);
        let said =
            ["100 %", "42 %", "3 %", "1 in 300", "1 in 20000", "1 in 2 million", "below 1 in a billion"];
        assert_eq!(chances, said);
        assert_eq!((pascals(3e8), pascals(2.5e5)), ("0.30 GPa".into(), "0.25 MPa".into()));
    }
}
