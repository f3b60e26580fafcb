//! Zones of the velocity level by ISO 20816-3.

use std::fmt;

use crate::quantities;
use serde::Serialize;

/// Group of a machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// Group 1: above 300 kW and up to 50 MW; electrical machines of a shaft height of 315 mm and more.
    Large,
    /// Group 2: above 15 kW and up to 300 kW; electrical machines of a shaft height of 160 to 315 mm.
    Medium,
}

/// The support of a machine, in the direction of the measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Foundation {
    /// The lowest natural frequency of machine and foundation lies 25 % above the main excitation or more.
    Rigid,
    /// Everything else.
    Flexible,
}

/// A zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Zone {
    /// Newly commissioned machines.
    A,
    /// Unrestricted long-term operation.
    B,
    /// Not for long-term continuous operation.
    C,
    /// Severe enough to damage the machine.
    D,
}

quantities! {
    /// The zone of a level.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize)]
    pub struct Zoned {
        /// Group of the machine.
        pub group: Group,
        /// Its support.
        pub foundation: Foundation,
        /// Limits between the zones [mm/s RMS].
        pub limits_mm_s: [f64; 3],
        /// Root mean square of the velocity [mm/s].
        pub velocity_mm_s: f64,
        /// The zone.
        pub zone: Zone,
    }
}

/// Limits A/B, B/C and C/D of the velocity [mm/s RMS]. Source: ISO 20816-3:2022, annex A, tables A.1 and A.2,
/// on non-rotating parts at operating speeds of 120 to 30 000 1/min.
pub fn limits_mm_s(group: Group, foundation: Foundation) -> [f64; 3] {
    match (group, foundation) {
        (Group::Large, Foundation::Rigid) => [2.3, 4.5, 7.1],
        (Group::Large, Foundation::Flexible) => [3.5, 7.1, 11.0],
        (Group::Medium, Foundation::Rigid) => [1.4, 2.8, 4.5],
        (Group::Medium, Foundation::Flexible) => [2.3, 4.5, 7.1],
    }
}

impl Zoned {
    /// Of a velocity level [mm/s]; a level at a limit lies in the better zone.
    pub fn of(velocity_mm_s: f64, group: Group, foundation: Foundation) -> Self {
        let limits = limits_mm_s(group, foundation);
        let passed = limits.iter().filter(|limit| velocity_mm_s > **limit).count();
        let zone = [Zone::A, Zone::B, Zone::C, Zone::D][passed];
        Self { group, foundation, limits_mm_s: limits, velocity_mm_s, zone }
    }
}

impl fmt::Display for Zoned {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let meaning = match self.zone {
            Zone::A => "as newly commissioned machines",
            Zone::B => "acceptable for unrestricted long-term operation",
            Zone::C => "unsatisfactory for long-term continuous operation",
            Zone::D => "severe enough to damage the machine",
        };
        let group = match self.group {
            Group::Large => 1,
            Group::Medium => 2,
        };
        let foundation = match self.foundation {
            Foundation::Rigid => "rigid",
            Foundation::Flexible => "flexible",
        };
        let [ab, bc, cd] = self.limits_mm_s;
        write!(
            out,
            "zone {:?} of ISO 20816-3:2022, {meaning}: {:.2} mm/s, limits {ab}, {bc} and {cd} mm/s for group \
             {group} on a {foundation} foundation",
            self.zone, self.velocity_mm_s
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_zones_of_a_level() {
        let of = |v: f64, group, foundation| Zoned::of(v, group, foundation).zone;
        assert_eq!(of(2.3, Group::Large, Foundation::Rigid), Zone::A);
        assert_eq!(of(2.31, Group::Large, Foundation::Rigid), Zone::B);
        assert_eq!(of(2.31, Group::Medium, Foundation::Rigid), Zone::B);
        assert_eq!(of(4.6, Group::Medium, Foundation::Rigid), Zone::D);
        assert_eq!(of(4.6, Group::Medium, Foundation::Flexible), Zone::C);
        assert_eq!(of(11.0, Group::Large, Foundation::Flexible), Zone::C);
        let words = Zoned::of(3.0, Group::Medium, Foundation::Rigid).to_string();
        assert!(words.contains("zone C") && words.contains("1.4, 2.8 and 4.5"), "{words}");
    }
}
