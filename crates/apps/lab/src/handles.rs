//! The handles: what can be turned while a bearing runs, in the units in which a page shows them.

use serde::Serialize;

use crate::error::Error;

/// Values of all handles, in the order of [`HANDLES`].
pub type Handles = [f64; HANDLES.len()];

/// One handle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Handle {
    /// Name in the page.
    pub key: &'static str,
    /// In words.
    pub name: &'static str,
    /// Unit, empty for a number without one.
    pub unit: &'static str,
    /// Least value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
    /// Whether the bearing runs on when it is changed; otherwise the run restarts from its equilibrium.
    pub live: bool,
}

const fn handle(
    key: &'static str,
    name: &'static str,
    unit: &'static str,
    [least, most]: [f64; 2],
    live: bool,
) -> Handle {
    Handle { key, name, unit, least, most, live }
}

/// All handles.
pub const HANDLES: [Handle; 18] = [
    handle("load", "Load", "N", [1.0, 1e6], true),
    handle("direction", "Direction of the load, turned by", "°", [-180.0, 180.0], true),
    handle("speed", "Speed", "rpm", [-30_000.0, 30_000.0], true),
    handle("friction", "Friction coefficient", "", [0.0, 0.5], true),
    handle("contactDamping", "Contact damping ratio", "", [0.0, 2.0], true),
    handle("massDamping", "Mass damping", "1/s", [0.0, 50_000.0], true),
    handle("clearance", "Change of the clearance", "µm", [-200.0, 500.0], false),
    handle("viscosity", "Viscosity of the oil (0: dry)", "Pa s", [0.0, 1.0], false),
    handle("arcs", "Rollers and raceways as arcs", "", [0.0, 1.0], false),
    handle("facets", "Facets of a roller", "", [8.0, 1000.0], false),
    handle("spallRing", "Ring with the spall (0: none, 1: outer, 2: inner)", "", [0.0, 2.0], false),
    handle("spallAngle", "Place of the spall", "°", [-360.0, 360.0], false),
    handle("spallLength", "Length of the spall", "mm", [0.1, 100.0], false),
    handle("spallDepth", "Depth of the spall", "mm", [0.001, 2.0], false),
    handle("spallSlope", "Slope of its edges", "°", [10.0, 90.0], false),
    handle("sensor", "Sensor", "", [0.0, 200.0], true),
    handle("roller", "Roller that is watched", "", [0.0, 500.0], true),
    handle("step", "Longest time step", "µs", [0.05, 100.0], false),
];

/// Places of the handles in [`HANDLES`].
#[expect(missing_docs, reason = "as the handles say")]
pub mod at {
    pub const LOAD: usize = 0;
    pub const DIRECTION: usize = 1;
    pub const SPEED: usize = 2;
    pub const FRICTION: usize = 3;
    pub const CONTACT_DAMPING: usize = 4;
    pub const MASS_DAMPING: usize = 5;
    pub const CLEARANCE: usize = 6;
    pub const VISCOSITY: usize = 7;
    pub const ARCS: usize = 8;
    pub const FACETS: usize = 9;
    pub const SPALL_RING: usize = 10;
    pub const SPALL_ANGLE: usize = 11;
    pub const SPALL_LENGTH: usize = 12;
    pub const SPALL_DEPTH: usize = 13;
    pub const SPALL_SLOPE: usize = 14;
    pub const SENSOR: usize = 15;
    pub const ROLLER: usize = 16;
    pub const STEP: usize = 17;
}

/// Whether a handle may have a value.
pub fn check(number: usize, value: f64) -> Result<(), Error> {
    let Some(handle) = HANDLES.get(number) else { return Err(Error::UnknownHandle(number)) };
    let Handle { name, unit, least, most, .. } = *handle;
    // Not a number is refused, too.
    if (least..=most).contains(&value) {
        Ok(())
    } else {
        Err(Error::Range { name, value, unit, least, most })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_no_number_and_what_is_beyond_a_range() {
        assert!(check(at::LOAD, 5e4).is_ok());
        let said = |number, value| check(number, value).map_err(|error| error.to_string());
        assert_eq!(said(at::LOAD, f64::NAN), Err("Load = NaN N: must be between 1 and 1000000".to_owned()));
        stribeck_testing::assert_refused(check(at::ARCS, 2.0), "must be between 0 and 1");
        stribeck_testing::assert_refused(check(HANDLES.len(), 0.0), "is unknown");
    }
}
