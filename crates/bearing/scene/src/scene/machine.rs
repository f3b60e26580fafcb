//! A machine about the bearing: the path from the force on its housing to a sensor, the sensor, and what else
//! the sensor records.
//!
//! The outer ring does not deform and sits in a mass. Path, background and sensor are linear and act one way:
//! what they add does not act back on the bearing, so that the record of the sensor follows from the force on
//! the housing after the run (`analysis::machine`).

use super::BearingScene;
use super::housing::RigidHousingScene;
use crate::dice::Dice;
use crate::field::value::Value;
use crate::group;

group! {
    /// A machine about the bearing: a heavy housing that holds a ring that does not deform, a linear path from
    /// the force on it to a sensor, and a background. Everything that is left out has a value that is usual for
    /// the size of the bearing, not that of any machine.
    pub struct MachineScene {
        /// File that the command `machine` wrote, beside the scene. What the scene says itself stands before it.
        pub file: String = String::new(), omitted();
        /// Mass that moves with the outer ring [kg]; 10 (outside diameter/52 mm)² where it is left out.
        pub mass_kg: Option<f64> = None, within(0.0, 1e6), omitted();
        /// Damping of its motion by what it stands on, over the mass [1/s].
        pub damping_per_s: f64 = 1000.0, within(0.0, 1e5), omitted();
        /// Direction in which the sensor measures [°], counter-clockwise from the x axis.
        pub direction_deg: f64 = 90.0, within(-360.0, 360.0), omitted();
        /// Path as the gain from force to acceleration at some frequencies, straight between them in
        /// logarithms, with the least delay that such gains can have.
        pub gains: Vec<GainScene> = Vec::new(), omitted();
        /// How long a path by `gains` rings behind an impact, until it has died away to 1/e [ms]. The gains stay.
        pub ring_ms: f64 = 0.0, within(0.0, 1000.0), omitted();
        /// Path as the sum of some modes, beside `gains`; four usual ones where there are neither `gains` nor a `plate`.
        pub modes: Vec<PathModeScene> = Vec::new(), omitted();
        /// Path with the modes of a plate, beside `gains` and `modes`.
        pub plate: Option<PlateScene> = None, omitted();
        /// Noise of the rest of the machine, by third octaves; a usual one where it is left out.
        pub background: Vec<BackgroundScene> = Vec::new(), omitted();
        /// Steady tones of the rest of the machine.
        pub lines: Vec<MachineLineScene> = Vec::new(), omitted();
        /// Sensor and recorder.
        pub sensor: MachineSensorScene = MachineSensorScene::default(), omitted();
        /// Seed of background and noise.
        pub seed: u64 = 1, within(0.0, 1e9), omitted();
    }
}

group! {
    /// Gain of a path at one frequency.
    pub struct GainScene: Copy {
        /// Frequency [Hz].
        pub hz: f64 = 1000.0, within(1.0, 1e6), required();
        /// Acceleration over force [m/s²/N].
        pub gain: f64 = 0.1, within(1e-9, 1e6), required();
    }
}

group! {
    /// A mode of the path: −gain f² / (hz² − f² + 2i damping hz f).
    pub struct PathModeScene: Copy {
        /// Natural frequency [Hz].
        pub hz: f64 = 1000.0, within(1.0, 1e6), required();
        /// Damping ratio [-].
        pub damping: f64 = 0.03, within(1e-4, 0.99);
        /// Acceleration over force far above it [1/kg]: the inverse of its mass, negative where the sensor moves against
        /// the place of the force.
        pub gain: f64 = 0.1, within(-1e6, 1e6), required();
    }
}

group! {
    /// Modes as plates and shells have them: as many in each band of equal width, of one loss factor, moved at the
    /// place of the force and at the sensor by shapes that are drawn.
    pub struct PlateScene: Copy {
        /// Its mass over that which moves with the ring [-].
        pub mass_ratio: f64 = 3.0, positive(1e6);
        /// Frequency below which it has no mode, and yields as a spring does [Hz].
        pub from_hz: f64 = 800.0, within(1.0, 1e6);
        /// Mean distance of two natural frequencies [Hz].
        pub spacing_hz: f64 = 400.0, within(10.0, 1e5);
        /// Highest natural frequency [Hz].
        pub to_hz: f64 = 12_000.0, within(100.0, 1e6);
        /// Loss factor, twice the damping ratio [-].
        pub loss_factor: f64 = 0.06, within(1e-4, 1.0);
        /// Seed of frequencies and shapes.
        pub seed: u64 = 1, within(0.0, 1e9);
    }
}

group! {
    /// Background in one third octave.
    pub struct BackgroundScene: Copy {
        /// Its middle [Hz].
        pub hz: f64 = 1000.0, within(1.0, 1e6), required();
        /// Root mean square of the acceleration in it [m/s²].
        pub rms_m_s2: f64 = 0.03, within(0.0, 1e6), required();
    }
}

group! {
    /// A steady tone.
    pub struct MachineLineScene: Copy {
        /// Frequency [Hz].
        pub hz: f64 = 100.0, within(0.1, 1e6), required();
        /// Amplitude [m/s²].
        pub amplitude_m_s2: f64 = 0.1, within(0.0, 1e6), required();
        /// With all its multiples, of the same amplitude: pulses, as those of converters.
        pub comb: bool = false, omitted();
    }
}

group! {
    /// A mounted accelerometer and its recorder. By default one of 100 mV/g on a stud at 24 bits.
    pub struct MachineSensorScene {
        /// Samples a second of the record [Hz]; at most those of the run.
        pub rate_hz: f64 = 25_600.0, up_to(100.0, "output.interval_us", |us| 1e6 / us);
        /// Resonance of the mounted sensor [Hz].
        pub resonance_hz: f64 = 25_000.0, within(100.0, 1e6);
        /// Quality factor of the resonance [-].
        pub quality: f64 = 30.0, within(0.5, 1000.0);
        /// Density of its noise [m/s²/√Hz].
        pub noise_density: f64 = 5e-4, within(0.0, 1e3);
        /// Largest acceleration that is recorded [m/s²].
        pub range_m_s2: f64 = 490.0, positive(1e7);
        /// Bits of the converter.
        pub bits: usize = 24, within(2.0, 32.0);
    }
}

/// Outside diameter [mm] and mass [kg] of the housing to which the usual values belong.
const USUAL: (f64, f64) = (52.0, 10.0);

/// Modes of a usual path for an outside diameter of 52 mm: frequency [Hz], damping ratio, part of the inverse
/// of the mass. They are round numbers about a path that was fitted on a motor's end shield, not measured ones.
const USUAL_MODES: [(f64, f64, f64); 4] =
    [(600.0, 0.08, 0.3), (1500.0, 0.06, 0.8), (3400.0, 0.04, 1.5), (7000.0, 0.04, 0.7)];

/// Background of a usual machine [m/s²] in the third octave at 1 kHz, and its growth with the frequency: 0.5
/// m/s² in all below 10 kHz.
const USUAL_BACKGROUND: f64 = 0.1;
const USUAL_GROWTH: f64 = 0.3;

/// Mass [kg] that usually moves with the outer ring of a bearing of this size: 10 kg about a 6205, growing with
/// the square of the outside diameter.
pub fn usual_mass_kg(bearing: &BearingScene) -> f64 {
    let kg = USUAL.1 * (outside_mm(bearing) / USUAL.0).powi(2);
    let digits = 10_f64.powf(kg.log10().floor() - 1.0);
    (kg / digits).round() * digits
}

fn outside_mm(bearing: &BearingScene) -> f64 {
    bearing.outer_race_diameter_mm + 2.0 * bearing.outer_ring_thickness_mm
}

impl MachineScene {
    /// Its text, without what has its default.
    pub fn to_ron(&self) -> String {
        self.write().to_ron(Self::SHAPE, &crate::field::Group::omits)
    }

    /// What this machine says, before what `other` says.
    #[must_use]
    pub fn before(self, other: Self) -> Self {
        let usual = Self::default();
        macro_rules! first {
            ($($field:ident),*) => {
                Self {
                    $($field: if self.$field == usual.$field { other.$field } else { self.$field },)*
                    file: String::new(),
                }
            };
        }
        first!(
            mass_kg,
            damping_per_s,
            direction_deg,
            gains,
            ring_ms,
            modes,
            plate,
            background,
            lines,
            sensor,
            seed
        )
    }

    /// The mass about the ring, as the run takes it.
    pub fn mass(&self, bearing: &BearingScene) -> RigidHousingScene {
        RigidHousingScene {
            mass_kg: self.mass_kg.unwrap_or_else(|| usual_mass_kg(bearing)),
            damping_per_s: self.damping_per_s,
        }
    }

    /// Modes of the path: its own, or usual ones for the size of a bearing where it has no other path either.
    pub fn path_modes(&self, bearing: &BearingScene) -> Vec<PathModeScene> {
        let mass_kg = self.mass(bearing).mass_kg.max(f64::MIN_POSITIVE);
        if self.has_path() {
            let of_plate = self.plate.map(|plate| plate.modes(mass_kg)).unwrap_or_default();
            return [&self.modes[..], &of_plate].concat();
        }
        let slower = USUAL.0 / outside_mm(bearing);
        USUAL_MODES
            .map(|(hz, damping, part)| PathModeScene { hz: slower * hz, damping, gain: part / mass_kg })
            .into()
    }

    fn has_path(&self) -> bool {
        !self.gains.is_empty() || !self.modes.is_empty() || self.plate.is_some()
    }

    /// The background below `highest_hz`: its own, or a usual one.
    pub fn background(&self, highest_hz: f64) -> Vec<BackgroundScene> {
        if !self.background.is_empty() {
            return self.background.clone();
        }
        third_octaves(50.0, highest_hz)
            .into_iter()
            .map(|hz| BackgroundScene { hz, rms_m_s2: USUAL_BACKGROUND * (hz / 1000.0).powf(USUAL_GROWTH) })
            .collect()
    }

    /// Whether it has a background, and that is none: as it is fitted without a record of the healthy machine.
    pub fn is_silent(&self) -> bool {
        !self.background.is_empty() && self.background.iter().all(|band| band.rms_m_s2 == 0.0)
    }

    /// What of it is usual and not given, in words; `None` where nothing is.
    pub fn assumed(&self) -> Option<String> {
        let path = (!self.has_path()).then_some("path to the sensor");
        let background = self.background.is_empty().then_some("background");
        let what: Vec<&str> = path.into_iter().chain(background).collect();
        (!what.is_empty()).then(|| {
            format!(
                "the {} of the machine {} usual for the size of the bearing, not measured: `stribeck machine` \
                 fits a machine to records",
                what.join(" and the "),
                if what.len() == 1 { "is" } else { "are" }
            )
        })
    }
}

impl PlateScene {
    /// Its modes: one natural frequency drawn in each spacing; gains are products of normal shapes at two places, whose
    /// mean squares are 1 (L. Cremer, M. Heckl and B. Petersson, Structure-Borne Sound, Springer 2005).
    fn modes(&self, housing_kg: f64) -> Vec<PathModeScene> {
        let mut dice = Dice::new(self.seed);
        let mode = |n: i32| {
            let hz = self.from_hz + self.spacing_hz * (f64::from(n) + dice.share());
            let gain = dice.normal() * dice.normal() / (self.mass_ratio * housing_kg);
            PathModeScene { hz, damping: 0.5 * self.loss_factor, gain }
        };
        (0..).map(mode).take_while(|mode| mode.hz < self.to_hz).collect()
    }
}

/// Middles of the third octaves [Hz] whose upper ends lie below `highest_hz`, from `lowest_hz` on: 1 kHz is one.
pub fn third_octaves(lowest_hz: f64, highest_hz: f64) -> Vec<f64> {
    let middle = |step: i32| 1000.0 * (f64::from(step) / 3.0).exp2();
    let fits = |hz: &f64| *hz >= lowest_hz && *hz * (1.0_f64 / 6.0).exp2() <= highest_hz;
    (-24..=24).map(middle).filter(fits).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{HousingScene, Scene};
    use stribeck_testing::{Scratch, assert_refused};

    const BASE: &str = "bearing: \"6205\", model: reduced(), film: None, defect: None";

    fn machine(scene: &Scene) -> &MachineScene {
        scene.housing.machine().expect("a machine")
    }

    #[test]
    fn roundtrip_a_machine_in_a_file_becomes_a_part_of_the_scene() {
        let folder = Scratch::create("machine-file");
        let gains = vec![GainScene { hz: 500.0, gain: 0.01 }, GainScene { hz: 2000.0, gain: 0.2 }];
        let fitted = MachineScene { gains, mass_kg: Some(7.0), seed: 3, ..MachineScene::default() };
        std::fs::write(folder.join("motor.ron"), fitted.to_ron()).expect("room");
        std::fs::write(
            folder.join("x.ron"),
            format!("({BASE}, housing: machine(file: \"motor.ron\", seed: 9))"),
        )
        .expect("room");
        let scene = Scene::read(folder.join("x.ron")).expect("a scene");
        // What the scene says stands before the file, which a run does not need any more.
        assert_eq!(*machine(&scene), MachineScene { seed: 9, ..fitted });
        assert_eq!(Scene::parse(&scene.to_ron(), "again").expect("a scene"), scene);
        assert_eq!(scene.housing.mass(&scene.bearing).expect("rigid").mass_kg, 7.0);
    }

    /// A machine fitted on records of 51.2 kHz was refused by what `new` writes: "rate_hz is 51200, outside its range".
    #[test]
    fn issue_a_run_samples_as_fast_as_the_machine_of_a_file() {
        let folder = Scratch::create("fast-machine");
        for rate_hz in [51_200.0, 65_536.0, 44_100.0] {
            let sensor = MachineSensorScene { rate_hz, ..MachineSensorScene::default() };
            let fitted = MachineScene { sensor, ..MachineScene::default() };
            std::fs::write(folder.join("motor.ron"), fitted.to_ron()).expect("room");
            let text = format!("({BASE}, output: (interval_us: 20), housing: machine(file: \"motor.ron\"))");
            std::fs::write(folder.join("x.ron"), text).expect("room");
            let scene = Scene::read(folder.join("x.ron")).expect("a scene");
            assert_eq!(machine(&scene).sensor.rate_hz, rate_hz);
            let expected = rate_hz.max(50_000.0);
            assert!((1e6 / scene.output.interval_us / expected - 1.0).abs() < 1e-12, "{rate_hz}");
        }
    }

    #[test]
    fn refuses_files_that_are_no_machine() {
        let folder = Scratch::create("no-machine");
        let said = |text: Option<&str>| {
            if let Some(text) = text {
                std::fs::write(folder.join("motor.ron"), text).expect("room");
            }
            std::fs::write(folder.join("x.ron"), format!("({BASE}, housing: machine(file: \"motor.ron\"))"))
                .expect("room");
            Scene::read(folder.join("x.ron")).expect_err("no machine").to_string()
        };
        let none = said(None);
        assert!(none.contains("no such file") && none.contains("x.ron:1"), "{none}");
        let misspelt = said(Some("(\n mas_kg: 3)"));
        assert!(misspelt.contains("mas_kg") && misspelt.contains("motor.ron:2"), "{misspelt}");
        let outside = said(Some("(gains: [(hz: -3, gain: 1)])"));
        assert!(outside.contains("hz"), "{outside}");
    }

    /// As many modes as its band has spacings, one in each; twice the mass has half the gains.
    #[test]
    fn by_hand_a_plate_has_a_mode_in_each_spacing() {
        let plate =
            PlateScene { from_hz: 1000.0, to_hz: 11_000.0, spacing_hz: 500.0, ..PlateScene::default() };
        let machine = |plate| MachineScene { plate: Some(plate), ..MachineScene::default() };
        let modes = |plate| machine(plate).path_modes(&BearingScene::default());
        let of = modes(plate);
        assert_eq!(of.len(), 20);
        assert!(
            (1000..)
                .step_by(500)
                .zip(&of)
                .all(|(hz, mode)| (0.0..500.0).contains(&(mode.hz - f64::from(hz))))
        );
        let heavy = modes(PlateScene { mass_ratio: 2.0 * plate.mass_ratio, ..plate });
        assert!(of.iter().zip(&heavy).all(|(a, b)| a.hz == b.hz && (a.gain / b.gain - 2.0).abs() < 1e-12));
        assert_ne!(of, modes(PlateScene { seed: 2, ..plate }));
        assert_eq!(
            machine(plate).assumed(),
            MachineScene { gains: vec![GainScene { hz: 1.0, gain: 1.0 }], ..machine(plate) }.assumed()
        );
    }

    /// A run of 20 kHz was refused for the 25.6 kHz of a sensor of which its scene said nothing.
    #[test]
    fn issue_a_record_is_sampled_no_faster_than_its_run() {
        let rate_hz = |text: &str, overrides: &[&str]| {
            let scene = Scene::parse(&format!("({BASE}, {text})"), "mine").expect("a scene");
            machine(&scene.with_overrides(overrides).expect("a scene")).sensor.rate_hz
        };
        assert_eq!(rate_hz("housing: machine(), output: (interval_us: 50)", &[]), 20_000.0);
        assert_eq!(rate_hz("housing: machine()", &["output.interval_us=50"]), 20_000.0);
        assert_eq!(rate_hz("output: (interval_us: 50)", &["housing=machine()"]), 20_000.0);
        assert_eq!(rate_hz("housing: machine()", &[]), 25_600.0);
        let given =
            format!("({BASE}, housing: machine(sensor: (rate_hz: 25600)), output: (interval_us: 50))");
        assert_refused(Scene::parse(&given, "mine"), "housing.sensor.rate_hz");
    }

    /// A scene without a machine has not a word of it, and one with a machine runs as a rigid housing of its mass.
    #[test]
    fn behaves_a_machine_is_a_rigid_housing_and_others_have_none() {
        let scene =
            |housing: &str| Scene::parse(&format!("({BASE}, housing: {housing})"), "mine").expect("a scene");
        let (usual, rigid) = (scene("machine()"), scene("rigid(mass_kg: 10, damping_per_s: 1000)"));
        assert_eq!(usual.housing.mass(&usual.bearing), rigid.housing.mass(&rigid.bearing));
        assert!(usual.housing.is_rigid() && rigid.housing.machine().is_none());
        assert!(!rigid.to_ron().contains("machine") && matches!(rigid.housing, HousingScene::Rigid(_)));
        assert!(machine(&usual).assumed().expect("usual").contains("not measured"));
    }
}
