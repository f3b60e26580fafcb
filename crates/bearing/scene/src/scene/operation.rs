//! The operating point: load, speed, gravity, and the courses of load and speed over time.

use super::housing;
use super::solver::LONGEST_MS;
use crate::{group, words};

const MOST_SPEED_RPM: f64 = 100_000.0;
const MOST_LOAD_N: f64 = 1e9;

group! {
    /// Operating point.
    pub struct OperationScene {
        /// Load on the top edge of the adapter, downwards, or on another housing [N].
        pub load_n: f64 = 50_000.0, positive(MOST_LOAD_N);
        /// Direction in which the load pushes the housing [°], counter-clockwise from the x axis; 270 is
        /// downwards, with the load zone at the top. Pedestals and mesh housings also accept 90; rigid and
        /// spring housings any angle.
        pub load_angle_deg: f64 = housing::DOWN_DEG, within(-360.0, 360.0), omitted();
        /// Speed of the inner ring [rpm]; positive clockwise, negative counter-clockwise.
        pub speed_rpm: f64 = 500.0, within(-MOST_SPEED_RPM, MOST_SPEED_RPM);
        /// Speed of the outer ring with its housing, which must be rigid then [rpm], counted likewise.
        pub outer_speed_rpm: f64 = 0.0, within(-MOST_SPEED_RPM, MOST_SPEED_RPM), omitted();
        /// Gravity, downwards [m/s²].
        pub gravity_m_s2: f64 = 9.81, within(0.0, 1_000.0);
        /// Course of the speed over time [rpm]; `None` for a constant `speed_rpm`.
        pub speed_profile: Option<ProfileScene> = None, within(-MOST_SPEED_RPM, MOST_SPEED_RPM), omitted();
        /// Course of the outer ring's speed over time [rpm]; `None` likewise.
        pub outer_speed_profile: Option<ProfileScene> = None,
            within(-MOST_SPEED_RPM, MOST_SPEED_RPM), omitted();
        /// Course of the load over time [N]; `None` likewise.
        pub load_profile: Option<ProfileScene> = None, positive(MOST_LOAD_N), omitted();
        /// A force that turns with the inner ring, on top of the load.
        pub rotating_load: Option<RotatingLoadScene> = None, omitted();
    }
}

words! {
    /// Course of a speed or load over time ([`duty`](crate::duty)). Values have the unit and the range of
    /// the field that they vary.
    pub enum ProfileScene {
        /// From the field's value along a straight line to another one, which stays.
        Ramp(of: RampScene) = "ramp",
        /// The field's value with a sine about it.
        Harmonic(of: HarmonicScene) = "harmonic",
        /// Times [ms], ascending, and values: straight lines between them, the first and the last value
        /// before and behind them. The field itself has no part in it.
        Points(of: Vec<(f64, f64)>) = "points",
        /// The same from a CSV file, whose first line names its columns, `time_ms` and `value`. Its path
        /// counts from the folder of the scene.
        Table(of: String) = "table",
    }
}

group! {
    /// A change at a constant rate.
    pub struct RampScene {
        /// When it begins [ms].
        pub from_ms: f64 = 0.0, within(0.0, LONGEST_MS);
        /// When it is over [ms].
        pub to_ms: f64 = 100.0, within(0.0, LONGEST_MS);
        /// Value at its end and from then on.
        pub to: f64 = 1000.0, varied();
    }
}

group! {
    /// A sine about a mean.
    pub struct HarmonicScene {
        /// Amplitude.
        pub amplitude: f64 = 50.0, amplitude();
        /// Frequency [Hz].
        pub hz: f64 = 10.0, positive(1e5);
        /// Phase at the start [°]; 0 begins at the mean, upwards.
        pub phase_deg: f64 = 0.0, within(-360.0, 360.0);
    }
}

group! {
    /// A force on the housing that turns with the inner ring, as that of an unbalanced shaft. Where the
    /// housing is guided up and down it takes the vertical part; the horizontal one goes into the guide.
    pub struct RotatingLoadScene {
        /// Its magnitude [N].
        pub force_n: f64 = 1000.0, positive(MOST_LOAD_N);
        /// Its direction at the start [°], counter-clockwise from the x axis.
        pub angle_deg: f64 = 0.0, within(-360.0, 360.0);
    }
}
