//! The unit of a channel, where it is one of an acceleration or of a velocity.

/// Standard acceleration of gravity [m/s²] (CGPM 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;
/// International inch [m].
const INCH_M: f64 = 0.0254;

/// A unit of vibration from which a velocity level follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionUnit {
    /// Of acceleration.
    Acceleration(AccelerationUnit),
    /// Of velocity: one of it [m/s].
    Velocity(f64),
}

/// A unit of acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AccelerationUnit {
    /// m/s².
    MetrePerSecondSquared,
    /// cm/s².
    CentimetrePerSecondSquared,
    /// mm/s².
    MillimetrePerSecondSquared,
    /// in/s².
    InchPerSecondSquared,
    /// ft/s².
    FootPerSecondSquared,
    /// Standard gravity, g.
    Gravity,
    /// A thousandth of it, mg.
    MilliGravity,
    /// A millionth of it, µg.
    MicroGravity,
}

impl MotionUnit {
    /// From its symbol as files spell it; `None` where that is neither.
    pub fn parse(symbol: &str) -> Option<Self> {
        let velocity = || velocity_m_s(symbol).map(Self::Velocity);
        AccelerationUnit::parse(symbol).map(Self::Acceleration).or_else(velocity)
    }
}

/// A symbol with one spelling of seconds and powers, without what says how it was averaged: `m/s2`, `g`.
fn spelled(symbol: &str) -> String {
    // `Acceleration (g)`, and `M/S2` of programs without small letters.
    let symbol = symbol.trim();
    let within = symbol.strip_suffix([')', ']']).and_then(|text| text.rsplit_once(['(', '[']));
    let within = within.filter(|(name, _)| name.chars().filter(|c| c.is_alphabetic()).count() > 3);
    let symbol = within.map_or(symbol, |(_, unit)| unit);
    let is_capital = symbol.contains("/S") && !symbol.contains(char::is_lowercase);
    let symbol = if is_capital { symbol.to_lowercase() } else { symbol.to_owned() };
    let plain = symbol.replace(['[', ']', '(', ')', '·', '.', '^', '*', ' ', '_'], "");
    let plain = plain.replace("sec", "s").replace("⁻²", "-2").replace("⁻¹", "-1").replace('²', "2");
    let plain = plain.replace('\u{2212}', "-");
    let averaged = ["rms", "RMS", "peak", "Peak", "pk-pk", "pkpk", "pk", "0-p", "p-p"];
    let bare = averaged.into_iter().find_map(|word| plain.strip_suffix(word)).filter(|bare| !bare.is_empty());
    bare.unwrap_or(&plain).trim_end_matches(['-', ',']).to_owned()
}

/// One of a unit of velocity [m/s].
fn velocity_m_s(symbol: &str) -> Option<f64> {
    let plain = spelled(symbol);
    let length = plain.strip_suffix("/s").or_else(|| plain.strip_suffix("s-1"));
    Some(match length.unwrap_or(&plain) {
        "ips" | "IPS" => INCH_M,
        _ if length.is_none() => return None,
        "m" => 1.0,
        "cm" => 1e-2,
        "mm" => 1e-3,
        // The micro sign, and the Greek letter.
        "um" | "µm" | "μm" => 1e-6,
        "nm" => 1e-9,
        "in" | "inch" => INCH_M,
        "ft" => 12.0 * INCH_M,
        _ => return None,
    })
}

impl AccelerationUnit {
    /// From its symbol as files spell it; `None` where that is no acceleration.
    pub fn parse(symbol: &str) -> Option<Self> {
        let plain = spelled(symbol);
        let length = ["/s2", "/s/s", "s-2"].into_iter().find_map(|end| plain.strip_suffix(end));
        match (length, plain.as_str()) {
            (Some("m"), _) => Some(Self::MetrePerSecondSquared),
            (Some("cm"), _) | (_, "Gal" | "gal") => Some(Self::CentimetrePerSecondSquared),
            (Some("mm"), _) => Some(Self::MillimetrePerSecondSquared),
            (Some("in" | "inch"), _) => Some(Self::InchPerSecondSquared),
            (Some("ft"), _) => Some(Self::FootPerSecondSquared),
            (_, "g" | "G" | "gn" | "g0" | "g's" | "gs" | "G's" | "Gs" | "gee" | "gees" | "gravity") => {
                Some(Self::Gravity)
            }
            (_, "mg" | "mG" | "mgn" | "millig" | "milli-g") => Some(Self::MilliGravity),
            (_, "ug" | "µg" | "μg" | "microg" | "micro-g") => Some(Self::MicroGravity),
            _ => None,
        }
    }

    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::MetrePerSecondSquared => "m/s²",
            Self::CentimetrePerSecondSquared => "cm/s²",
            Self::MillimetrePerSecondSquared => "mm/s²",
            Self::InchPerSecondSquared => "in/s²",
            Self::FootPerSecondSquared => "ft/s²",
            Self::Gravity => "g",
            Self::MilliGravity => "mg",
            Self::MicroGravity => "µg",
        }
    }

    /// One of it [m/s²].
    pub fn in_m_s2(self) -> f64 {
        match self {
            Self::MetrePerSecondSquared => 1.0,
            Self::CentimetrePerSecondSquared => 1e-2,
            Self::MillimetrePerSecondSquared => 1e-3,
            Self::InchPerSecondSquared => INCH_M,
            Self::FootPerSecondSquared => 12.0 * INCH_M,
            Self::Gravity => STANDARD_GRAVITY,
            Self::MilliGravity => 1e-3 * STANDARD_GRAVITY,
            Self::MicroGravity => 1e-6 * STANDARD_GRAVITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roundtrip_symbols_and_units() {
        for (unit, in_m_s2) in [
            (AccelerationUnit::MetrePerSecondSquared, 1.0),
            (AccelerationUnit::CentimetrePerSecondSquared, 0.01),
            (AccelerationUnit::MillimetrePerSecondSquared, 0.001),
            (AccelerationUnit::Gravity, 9.80665),
            (AccelerationUnit::MilliGravity, 0.00980665),
            (AccelerationUnit::InchPerSecondSquared, 0.0254),
            (AccelerationUnit::FootPerSecondSquared, 0.3048),
        ] {
            assert_eq!(AccelerationUnit::parse(unit.symbol()), Some(unit));
            assert!((unit.in_m_s2() / in_m_s2 - 1.0).abs() < 1e-12, "{unit:?}");
        }
        for spelled in [" m/s^2 ", "m/s2", "m/s**2", "m/s/s", "m/sec^2"] {
            assert_eq!(AccelerationUnit::parse(spelled), Some(AccelerationUnit::MetrePerSecondSquared));
        }
        for (spelled, unit) in [
            ("ms-2", AccelerationUnit::MetrePerSecondSquared),
            ("m·s⁻²", AccelerationUnit::MetrePerSecondSquared),
            ("m s-2", AccelerationUnit::MetrePerSecondSquared),
            ("g's", AccelerationUnit::Gravity),
            ("g_rms", AccelerationUnit::Gravity),
            ("g peak", AccelerationUnit::Gravity),
            ("Gal", AccelerationUnit::CentimetrePerSecondSquared),
            ("in/s2", AccelerationUnit::InchPerSecondSquared),
            ("m/(s^2)", AccelerationUnit::MetrePerSecondSquared),
            ("m.s-2", AccelerationUnit::MetrePerSecondSquared),
            ("M/S2", AccelerationUnit::MetrePerSecondSquared),
            ("Acceleration (g)", AccelerationUnit::Gravity),
            ("Acceleration [m/s²]", AccelerationUnit::MetrePerSecondSquared),
            ("gravity", AccelerationUnit::Gravity),
            ("milli-g", AccelerationUnit::MilliGravity),
            ("micro g", AccelerationUnit::MicroGravity),
        ] {
            assert_eq!(AccelerationUnit::parse(spelled), Some(unit), "{spelled}");
        }
        for (spelled, m_s) in [
            ("mm/s", 1e-3),
            ("mm/sec", 1e-3),
            ("ips", 0.0254),
            ("in/s", 0.0254),
            ("um/s", 1e-6),
            ("mm s-1", 1e-3),
        ] {
            assert_eq!(MotionUnit::parse(spelled), Some(MotionUnit::Velocity(m_s)), "{spelled}");
        }
        for other in
            ["V", "mV", "um", "mil", "counts", "dB", "s", "rms", "mm", "N/s", "V/S", "dB (g)", "mV/g"]
        {
            assert_eq!(MotionUnit::parse(other), None, "{other}");
        }
        for other in ["mm/s", "m/s", "V", "s2", ""] {
            assert_eq!(AccelerationUnit::parse(other), None, "{other}");
        }
    }
}
