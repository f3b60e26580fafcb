//! The unit of a channel, where it is one of an acceleration.

/// Standard acceleration of gravity [m/s²] (CGPM 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// A unit of acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AccelerationUnit {
    /// m/s².
    MetrePerSecondSquared,
    /// cm/s².
    CentimetrePerSecondSquared,
    /// mm/s².
    MillimetrePerSecondSquared,
    /// Standard gravity, g.
    Gravity,
    /// A thousandth of it, mg.
    MilliGravity,
}

impl AccelerationUnit {
    /// From its symbol as files spell it; `None` where that is no acceleration.
    pub fn parse(symbol: &str) -> Option<Self> {
        let plain = symbol.trim().replace("sec", "s").replace(['^', '*'], "");
        match plain.replace("/s/s", "/s²").replace("/s2", "/s²").as_str() {
            "m/s²" => Some(Self::MetrePerSecondSquared),
            "cm/s²" => Some(Self::CentimetrePerSecondSquared),
            "mm/s²" => Some(Self::MillimetrePerSecondSquared),
            "g" | "G" | "gn" => Some(Self::Gravity),
            "mg" => Some(Self::MilliGravity),
            _ => None,
        }
    }

    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::MetrePerSecondSquared => "m/s²",
            Self::CentimetrePerSecondSquared => "cm/s²",
            Self::MillimetrePerSecondSquared => "mm/s²",
            Self::Gravity => "g",
            Self::MilliGravity => "mg",
        }
    }

    /// One of it [m/s²].
    pub fn in_m_s2(self) -> f64 {
        match self {
            Self::MetrePerSecondSquared => 1.0,
            Self::CentimetrePerSecondSquared => 1e-2,
            Self::MillimetrePerSecondSquared => 1e-3,
            Self::Gravity => STANDARD_GRAVITY,
            Self::MilliGravity => 1e-3 * STANDARD_GRAVITY,
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
        ] {
            assert_eq!(AccelerationUnit::parse(unit.symbol()), Some(unit));
            assert!((unit.in_m_s2() / in_m_s2 - 1.0).abs() < 1e-12, "{unit:?}");
        }
        for spelled in [" m/s^2 ", "m/s2", "m/s**2", "m/s/s", "m/sec^2"] {
            assert_eq!(AccelerationUnit::parse(spelled), Some(AccelerationUnit::MetrePerSecondSquared));
        }
        for other in ["mm/s", "m/s", "V", "s2", ""] {
            assert_eq!(AccelerationUnit::parse(other), None, "{other}");
        }
    }
}
