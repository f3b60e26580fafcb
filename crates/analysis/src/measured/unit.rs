//! The unit of a channel, where it is one of an acceleration.

use crate::levels::STANDARD_GRAVITY;

/// A unit of acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AccelerationUnit {
    /// m/s².
    MetrePerSecondSquared,
    /// Standard gravity, g.
    Gravity,
}

impl AccelerationUnit {
    /// From its symbol as files spell it; `None` where that is no acceleration.
    pub fn parse(symbol: &str) -> Option<Self> {
        match symbol.trim() {
            "m/s²" | "m/s^2" | "m/s2" | "m/s**2" => Some(Self::MetrePerSecondSquared),
            "g" | "G" | "gn" => Some(Self::Gravity),
            _ => None,
        }
    }

    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::MetrePerSecondSquared => "m/s²",
            Self::Gravity => "g",
        }
    }

    /// One of it [m/s²].
    pub fn in_m_s2(self) -> f64 {
        match self {
            Self::MetrePerSecondSquared => 1.0,
            Self::Gravity => STANDARD_GRAVITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roundtrip_symbols_and_units() {
        for unit in [AccelerationUnit::MetrePerSecondSquared, AccelerationUnit::Gravity] {
            assert_eq!(AccelerationUnit::parse(unit.symbol()), Some(unit));
        }
        assert_eq!(AccelerationUnit::parse(" m/s^2 "), Some(AccelerationUnit::MetrePerSecondSquared));
        assert_eq!([AccelerationUnit::parse("mm/s"), AccelerationUnit::parse("V")], [None, None]);
    }
}
