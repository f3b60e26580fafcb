//! Deviations of raceways and rolling elements from round: their fields in a scene, and the depth of the
//! surface at any angle.

use std::f64::consts::{PI, TAU};

use crate::dice::Dice;
use crate::{group, words};

/// Facets that a hollow needs at least.
pub const HOLLOW_FACETS: f64 = 4.0;

group! {
    /// A defect or another deviation from round of one surface. Depths of several on the same surface add up.
    pub struct DeviationScene {
        /// The surface.
        pub on: RollingSurface = RollingSurface::Outer, up_to(1.0, "bearing.rollers", |rollers| rollers);
        /// Angle of its middle at the start [°], counter-clockwise from the x axis, about the centre of the
        /// body.
        pub angle_deg: f64 = 90.0, within(-360.0, 360.0);
        /// Its form.
        pub form: FormScene = FormScene::Spall(SpallScene::default());
    }
}

words! {
    /// A surface that rolls or is rolled over.
    pub enum RollingSurface: Copy, Eq, PartialOrd, Ord {
        /// The raceway of the outer ring.
        Outer = "outer",
        /// The raceway of the inner ring; its deviations turn with the shaft.
        Inner = "inner",
        /// A rolling element, from 1.
        Roller(of: usize) = "roller",
    }
}

words! {
    /// Form of a deviation over the arc length along its surface.
    pub enum FormScene {
        /// A flat floor between two edges.
        Spall(of: SpallScene) = "spall",
        /// A dent with a raised rim.
        Dent(of: DentScene) = "dent",
        /// Any profile, as points.
        Profile(of: SurfaceProfileScene) = "profile",
        /// A sine wave around the whole surface; of order 2 an oval.
        Waviness(of: WavinessScene) = "waviness",
        /// Random waves over a band of wavelengths.
        Roughness(of: RoughnessScene) = "roughness",
        /// Another diameter of a rolling element.
        Diameter(of: DiameterScene) = "diameter",
        /// A rolling element that is not there; its pocket stays empty.
        Missing = "missing",
    }
}

group! {
    /// A flat floor between two edges.
    pub struct SpallScene {
        /// Circumferential length between the upper ends of its edges [mm].
        pub length_mm: f64 = 5.0, positive(20_000.0);
        /// Depth [mm].
        pub depth_mm: f64 = 0.1, positive(5_000.0);
        /// Length of each edge [mm]; 0 for one facet, and for rectangular ones.
        pub edge_mm: f64 = 0.0, within(0.0, 5_000.0);
        /// Form of its edges.
        pub edge: Edge = Edge::Sloped;
        /// Depth of rectangular edges of raceways that is gone at most where a rolling element meets them [µm], no
        /// more than that of the spall, drawn anew for each passage by `bearing.diameter_seed`: ragged edges, which
        /// elements cross at other places of their width. In the reduced model.
        pub ragged_um: f64 = 0.0, within(0.0, 1_000.0), omitted();
    }
}

words! {
    /// Form of an edge.
    pub enum Edge: Copy, Eq {
        /// A plane with corners at both ends.
        Sloped = "sloped",
        /// Half a cosine wave.
        Rounded = "rounded",
        /// Walls at right angles to the surface, as those of `defect`.
        Rectangular = "rectangular",
    }
}

group! {
    /// A dent with a raised rim.
    pub struct DentScene {
        /// Length of the hollow [mm]; the rim takes half as much again on either side.
        pub length_mm: f64 = 3.0, positive(20_000.0);
        /// Depth of its middle [mm].
        pub depth_mm: f64 = 0.05, positive(5_000.0);
        /// Height of the rim [µm].
        pub rim_um: f64 = 5.0, within(0.0, 10_000.0);
    }
}

group! {
    /// Any profile, linear between points.
    pub struct SurfaceProfileScene {
        /// Table with the columns `position_mm` and `depth_um`, beside the scene; read where there are no
        /// `points`.
        pub file: String = String::new();
        /// Its points, in the order of their places; the surface is not changed outside of them.
        pub points: Vec<PointScene> = Vec::new();
    }
}

group! {
    /// One point of a profile.
    pub struct PointScene: Copy {
        /// Place along the surface, counter-clockwise from the middle [mm].
        pub at_mm: f64 = 0.0, within(-20_000.0, 20_000.0), required();
        /// Depth [µm]; negative where the surface stands out.
        pub depth_um: f64 = 0.0, within(-10_000.0, 1e6), required();
    }
}

group! {
    /// A sine wave around the whole surface.
    pub struct WavinessScene {
        /// Waves around the surface.
        pub order: usize = 11, within(1.0, 10_000.0);
        /// Half the height from valley to crest [µm]; the surface is deepest at the angle of the deviation.
        pub amplitude_um: f64 = 1.0, within(0.0, 1_000.0);
    }
}

group! {
    /// Random waves over a band of wavelengths.
    pub struct RoughnessScene {
        /// Root mean square of the depth, Rq [µm].
        pub rq_um: f64 = 0.3, within(0.0, 100.0);
        /// Longest wave [mm].
        pub longest_mm: f64 = 10.0, positive(20_000.0);
        /// Shortest wave [mm].
        pub shortest_mm: f64 = 2.5, positive(20_000.0);
        /// Seed of the phases.
        pub seed: u64 = 1, within(0.0, 1e9);
        /// Spectral slope: the power spectral density falls as the wave number to this power. 2 is a random
        /// walk; a self-affine profile of the Hurst exponent H has 1 + 2H.
        pub slope: f64 = RANDOM_WALK, within(0.0, 6.0), omitted();
    }
}

/// The slope of a random walk.
const RANDOM_WALK: f64 = 2.0;

group! {
    /// Another diameter of a rolling element.
    pub struct DiameterScene {
        /// By how much the diameter is larger [µm].
        pub larger_um: f64 = -5.0, within(-1_000.0, 1_000.0);
    }
}

impl FormScene {
    /// Length along the surface that it changes [mm]; `None` for all of it.
    pub fn length_mm(&self) -> Option<f64> {
        match self {
            Self::Spall(spall) => Some(spall.length_mm),
            Self::Dent(dent) => Some(2.0 * dent.length_mm),
            Self::Profile(profile) => {
                let ends = profile.points.first().zip(profile.points.last());
                Some(ends.map_or(0.0, |(first, last)| last.at_mm - first.at_mm))
            }
            Self::Waviness(_) | Self::Roughness(_) | Self::Diameter(_) | Self::Missing => None,
        }
    }

    /// Largest depth below the nominal surface [mm].
    pub fn depth_mm(&self) -> f64 {
        match self {
            Self::Spall(spall) => spall.depth_mm,
            Self::Dent(dent) => dent.depth_mm,
            Self::Profile(profile) => 1e-3 * profile.points.iter().map(|p| p.depth_um).fold(0.0, f64::max),
            Self::Waviness(waviness) => 1e-3 * waviness.amplitude_um,
            // Three standard deviations.
            Self::Roughness(roughness) => 3e-3 * roughness.rq_um,
            Self::Diameter(diameter) => 0.5e-3 * (-diameter.larger_um).max(0.0),
            Self::Missing => 0.0,
        }
    }
}

impl RollingSurface {
    /// In words.
    pub fn spoken(self) -> String {
        match self {
            Self::Outer => "the outer raceway".to_owned(),
            Self::Inner => "the inner raceway".to_owned(),
            Self::Roller(roller) => format!("roller {roller}"),
        }
    }
}

impl DeviationScene {
    /// Whether it has steep walls, which a mesh is cut for; nodes move for all others.
    pub fn is_cut(&self) -> bool {
        matches!(&self.form, FormScene::Spall(spall) if spall.edge == Edge::Rectangular)
    }

    /// In words: `a spall of 4 × 0.1 mm on roller 1`.
    pub fn spoken(&self) -> String {
        let form = match &self.form {
            FormScene::Missing => return format!("{} missing", self.on.spoken()),
            FormScene::Spall(spall) => format!("a spall of {} × {} mm", spall.length_mm, spall.depth_mm),
            FormScene::Dent(dent) => format!("a dent of {} × {} mm", dent.length_mm, dent.depth_mm),
            FormScene::Profile(profile) => format!("a profile of {} points", profile.points.len()),
            FormScene::Waviness(waviness) => {
                format!("waviness of order {} and ±{} µm", waviness.order, waviness.amplitude_um)
            }
            FormScene::Roughness(roughness) => format!("roughness of {} µm", roughness.rq_um),
            FormScene::Diameter(diameter) => {
                let than = if diameter.larger_um < 0.0 { "smaller" } else { "larger" };
                format!("a diameter {} µm {than}", diameter.larger_um.abs())
            }
        };
        format!("{form} on {}", self.on.spoken())
    }
}

/// All deviations of one surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    /// Radius of the circle that they deviate from [m].
    pub radius: f64,
    waves: Vec<Wave>,
    pieces: Vec<Piece>,
    /// The same everywhere [m].
    level: f64,
}

/// A cosine wave around the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wave {
    order: f64,
    amplitude: f64,
    /// Angle of a deepest place [rad].
    at: f64,
}

/// How far a wall of a rolling element leans, over its height: a depth has one value at each angle.
const LEAN: f64 = 1e-3;

/// A deviation of a part of the surface.
#[derive(Debug, Clone, PartialEq)]
struct Piece {
    /// Angle of its middle [rad].
    at: f64,
    form: FormScene,
    /// Length of an edge [mm].
    edge: f64,
}

impl Relief {
    /// Relief of a surface of radius `radius` [m] whose facets are `facet_mm` long; `None` when no deviation
    /// is `on` it. Grooves of raceways are no part of it.
    pub fn of(deviations: &[DeviationScene], on: RollingSurface, radius: f64, facet_mm: f64) -> Option<Self> {
        let mut relief = Self::round(radius);
        let mut any = false;
        for deviation in deviations.iter().filter(|d| d.on == on && d.groove().is_none()) {
            any = true;
            let at = deviation.angle_deg.to_radians();
            match &deviation.form {
                FormScene::Waviness(w) => {
                    let (order, amplitude) = (w.order as f64, 1e-6 * w.amplitude_um);
                    relief.waves.push(Wave { order, amplitude, at });
                }
                FormScene::Roughness(roughness) => relief.waves.extend(random_waves(roughness, radius, at)),
                FormScene::Diameter(diameter) => relief.level -= 0.5e-6 * diameter.larger_um,
                form => {
                    let edge = match form {
                        FormScene::Spall(spall) if spall.edge == Edge::Rectangular => LEAN * spall.depth_mm,
                        FormScene::Spall(spall) if spall.edge_mm > 0.0 => spall.edge_mm,
                        _ => facet_mm,
                    };
                    relief.pieces.push(Piece { at, form: form.clone(), edge });
                }
            }
        }
        any.then_some(relief)
    }

    /// A surface without deviations.
    pub(crate) fn round(radius: f64) -> Self {
        Self { radius, waves: Vec::new(), pieces: Vec::new(), level: 0.0 }
    }

    /// The same, higher by `by` everywhere [m].
    pub(crate) fn raised(mut self, by: f64) -> Self {
        self.level -= by;
        self
    }

    /// By how much the radius exceeds the nominal one [m], where that is all of the deviation.
    pub fn larger_by(&self) -> Option<f64> {
        (self.waves.is_empty() && self.pieces.is_empty()).then_some(-self.level)
    }

    /// How far below its circle the surface lies at `angle` [rad] from the centre, into the body [m].
    pub fn depth(&self, angle: f64) -> f64 {
        let waves = self.waves.iter().map(|w| w.amplitude * libm::cos(w.order * (angle - w.at)));
        let pieces = self.pieces.iter().map(|piece| {
            let from_middle = (angle - piece.at + PI).rem_euclid(TAU) - PI;
            1e-3 * piece.depth_mm(1e3 * self.radius * from_middle)
        });
        self.level + waves.sum::<f64>() + pieces.sum::<f64>()
    }

    /// Angles of the corners of its spalls [rad], where a mesh has nodes.
    pub fn corners(&self) -> Vec<f64> {
        let angles = self
            .pieces
            .iter()
            .flat_map(|piece| piece.corners_mm().into_iter().map(|mm| piece.at + 1e-3 * mm / self.radius));
        angles.collect()
    }

    /// The same about a body that is turned by `angle` [rad].
    pub fn turned(&self, angle: f64) -> Self {
        let mut turned = self.clone();
        turned.waves.iter_mut().for_each(|wave| wave.at += angle);
        turned.pieces.iter_mut().for_each(|piece| piece.at += angle);
        turned
    }
}

impl Piece {
    /// Depth [mm] at a place along the surface from the middle [mm].
    fn depth_mm(&self, s: f64) -> f64 {
        match &self.form {
            FormScene::Spall(spall) => {
                let down = ((0.5 * spall.length_mm - s.abs()) / self.edge).clamp(0.0, 1.0);
                spall.depth_mm
                    * match spall.edge {
                        Edge::Sloped | Edge::Rectangular => down,
                        Edge::Rounded => 0.5 - 0.5 * libm::cos(PI * down),
                    }
            }
            FormScene::Dent(dent) => {
                let out = 2.0 * s.abs() / dent.length_mm;
                if out < 1.0 {
                    // 1 − out² has a corner at the rim, its square none.
                    dent.depth_mm * (1.0 - out * out).powi(2)
                } else if out < 2.0 {
                    let up = (out - 1.0) * (2.0 - out);
                    -16e-3 * dent.rim_um * up * up
                } else {
                    0.0
                }
            }
            FormScene::Profile(profile) => {
                let after = profile.points.partition_point(|point| point.at_mm <= s);
                let (Some(&a), Some(&b)) =
                    (after.checked_sub(1).and_then(|i| profile.points.get(i)), profile.points.get(after))
                else {
                    return 0.0;
                };
                let along = (s - a.at_mm) / (b.at_mm - a.at_mm);
                1e-3 * (a.depth_um + along * (b.depth_um - a.depth_um))
            }
            FormScene::Waviness(_)
            | FormScene::Roughness(_)
            | FormScene::Diameter(_)
            | FormScene::Missing => 0.0,
        }
    }

    /// Places of its corners along the surface [mm], ascending.
    fn corners_mm(&self) -> Vec<f64> {
        let FormScene::Spall(spall) = &self.form else { return Vec::new() };
        let (half, floor) = (0.5 * spall.length_mm, 0.5 * spall.length_mm - self.edge);
        if floor > 0.25 * self.edge { vec![-half, -floor, floor, half] } else { vec![-half, half] }
    }
}

/// Waves of every order within the band, their phases drawn.
fn random_waves(roughness: &RoughnessScene, radius: f64, at: f64) -> Vec<Wave> {
    let around = 1e3 * TAU * radius;
    let first = (around / roughness.longest_mm).ceil().max(1.0) as usize;
    let last = ((around / roughness.shortest_mm).floor() as usize).max(first);
    let mut dice = Dice::new(roughness.seed);
    // A power rounds otherwise than a quotient, and scenes without a slope keep their bits.
    let amplitude = |order: f64| {
        if roughness.slope == RANDOM_WALK { 1.0 / order } else { libm::pow(order, -0.5 * roughness.slope) }
    };
    let mut waves: Vec<Wave> = (first..=last)
        .map(|order| {
            let order = order as f64;
            Wave { order, amplitude: amplitude(order), at: at + TAU * dice.share() / order }
        })
        .collect();
    let square: f64 = waves.iter().map(|wave| 0.5 * wave.amplitude * wave.amplitude).sum();
    let scale = 1e-6 * roughness.rq_um / square.sqrt();
    waves.iter_mut().for_each(|wave| wave.amplitude *= scale);
    waves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn on_outer(form: FormScene) -> Relief {
        let deviation = DeviationScene { form, ..DeviationScene::default() };
        Relief::of(&[deviation], RollingSurface::Outer, 0.1, 0.5).expect("one is on it")
    }

    /// Depth [µm] at a place along the surface [mm] from the top of a raceway of 100 mm.
    fn depth_um(relief: &Relief, mm: f64) -> f64 {
        1e6 * relief.depth(0.5 * PI + mm / 100.0)
    }

    /// Source: THEORY §6.4.
    #[test]
    fn analytic_profiles_at_chosen_places() {
        let spall = SpallScene { length_mm: 6.0, edge_mm: 1.0, ..SpallScene::default() };
        let dent = FormScene::Dent(DentScene { length_mm: 2.0, depth_mm: 0.02, rim_um: 3.0 });
        let point = |(at_mm, depth_um)| PointScene { at_mm, depth_um };
        let points = [(-1.0, 0.0), (0.0, 8.0), (0.5, 2.0)].map(point).into();
        let profile = SurfaceProfileScene { points, ..Default::default() };
        let rounded = FormScene::Spall(SpallScene { edge: Edge::Rounded, ..spall.clone() });
        let oval = FormScene::Waviness(WavinessScene { order: 2, amplitude_um: 4.0 });
        for (form, places) in [
            (FormScene::Spall(spall), [(0.0, 100.0), (2.5, 50.0), (-2.25, 75.0), (3.1, 0.0)]),
            (
                rounded,
                [(0.0, 100.0), (2.5, 50.0), (-2.75, 100.0 * (0.5 - 0.5 * (PI * 0.25).cos())), (3.1, 0.0)],
            ),
            // (1 − ¼)² of the depth half way out; the crest of the rim half a length beyond.
            (dent, [(0.0, 20.0), (-0.5, 11.25), (1.5, -3.0), (2.1, 0.0)]),
            (FormScene::Profile(profile), [(-0.5, 4.0), (0.25, 5.0), (0.6, 0.0), (-1.1, 0.0)]),
            (oval, [(0.0, 4.0), (25.0 * PI, 0.0), (50.0 * PI, -4.0), (100.0 * PI, 4.0)]),
        ] {
            let relief = on_outer(form.clone());
            for (mm, um) in places {
                let ours = depth_um(&relief, mm);
                // A place is rounded to 1e-13 mm, where walls are steep.
                assert!((ours - um).abs() < 1e-9, "{form:?} at {mm} mm: {ours} instead of {um}");
            }
        }
    }

    /// Source: THEORY §6.4.
    #[test]
    fn analytic_a_roller_of_another_diameter_lies_half_as_deep() {
        let roller = |larger_um| DeviationScene {
            on: RollingSurface::Roller(3),
            form: FormScene::Diameter(DiameterScene { larger_um }),
            ..DeviationScene::default()
        };
        let relief = |on| Relief::of(&[roller(-6.0), roller(2.0)], on, 9e-3, 0.5);
        assert!((relief(RollingSurface::Roller(3)).expect("two").depth(1.0) - 2e-6).abs() < 1e-18);
        assert!(relief(RollingSurface::Roller(2)).is_none());
    }

    /// Source: THEORY §6.4; the mean square over the circumference is half the sum of the squares of the
    /// amplitudes (Parseval).
    #[test]
    fn analytic_roughness_has_its_root_mean_square_and_band() {
        let relief = on_outer(FormScene::Roughness(RoughnessScene { rq_um: 0.4, ..Default::default() }));
        let n = 4096;
        let depths: Vec<f64> = (0..n).map(|i| 1e6 * relief.depth(TAU * i as f64 / n as f64)).collect();
        let square = depths.iter().map(|d| d * d).sum::<f64>() / n as f64;
        assert!((square.sqrt() - 0.4).abs() < 1e-12, "{}", square.sqrt());
        // 628.3 mm hold 63 waves of 10 mm and 251 of 2.5 mm.
        let orders: Vec<f64> = relief.waves.iter().map(|wave| wave.order).collect();
        assert_eq!((orders[0], orders[orders.len() - 1]), (63.0, 251.0));
        let again = on_outer(FormScene::Roughness(RoughnessScene { rq_um: 0.4, ..Default::default() }));
        assert_eq!(relief, again);
    }

    /// The power in two bands of the profile, from its sine and cosine parts at each order, yields the slope.
    /// Source: Persson et al. 2005, §2: a self-affine profile of the Hurst exponent H has C(q) ∝ q^−(1 + 2H);
    /// THEORY §6.4.
    #[test]
    fn analytic_roughness_has_the_slope_of_its_spectrum() {
        const N: usize = 4096;
        for slope in [0.0, 1.0, 1.6, 2.0, 2.6, 4.0] {
            let form = RoughnessScene { rq_um: 0.4, longest_mm: 20.0, slope, ..Default::default() };
            let relief = on_outer(FormScene::Roughness(form));
            let depth: Vec<f64> = (0..N).map(|i| 1e6 * relief.depth(TAU * i as f64 / N as f64)).collect();
            let square = depth.iter().map(|d| d * d).sum::<f64>() / N as f64;
            assert!((square.sqrt() - 0.4).abs() < 1e-10, "slope {slope}: Rq {} µm", square.sqrt());
            // 628.3 mm hold 32 waves of 20 mm and 251 of 2.5 mm. A least-squares line through the logarithms.
            let points: Vec<[f64; 2]> = (32..=251)
                .map(|order| {
                    let part = |wave: fn(f64) -> f64| {
                        let angle = |i: usize| TAU * ((i * order) % N) as f64 / N as f64;
                        depth.iter().enumerate().map(|(i, d)| d * wave(angle(i))).sum::<f64>()
                    };
                    let power = part(f64::cos).powi(2) + part(f64::sin).powi(2);
                    [(order as f64).ln(), power.ln()]
                })
                .collect();
            let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
            let across: f64 = points.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1])).sum();
            let along: f64 = points.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
            assert!((across / along + slope).abs() < 1e-6, "slope {slope}: {}", -across / along);
        }
    }

    /// Scenes from before there was a slope keep their text, and so their hash, and their surface to the last
    /// bit.
    #[test]
    fn invariant_roughness_without_a_slope_is_a_random_walk() {
        let written = |form: RoughnessScene| {
            let deviation = DeviationScene { form: FormScene::Roughness(form), ..Default::default() };
            Scene { defects: vec![deviation], ..Default::default() }.to_ron()
        };
        let plain = written(RoughnessScene::default());
        assert!(!plain.contains("slope:"), "{plain}");
        let relief = on_outer(FormScene::Roughness(RoughnessScene::default()));
        let mut ratio =
            relief.waves.windows(2).map(|w| w[0].amplitude / w[1].amplitude * w[0].order / w[1].order);
        assert!(ratio.all(|ratio| (ratio - 1.0).abs() < 1e-15));
        let steeper = written(RoughnessScene { slope: 3.0, ..Default::default() });
        assert!(steeper.contains("slope: 3.0"), "{steeper}");
    }

    #[test]
    fn invariant_a_turned_relief_is_the_same_elsewhere() {
        let mut deviations: Vec<DeviationScene> = [
            FormScene::Spall(SpallScene::default()),
            FormScene::Waviness(WavinessScene::default()),
            FormScene::Roughness(RoughnessScene::default()),
        ]
        .map(|form| DeviationScene { form, ..DeviationScene::default() })
        .into();
        let of = |deviations: &[DeviationScene]| {
            Relief::of(deviations, RollingSurface::Outer, 0.1, 0.5).expect("three")
        };
        let turned = of(&deviations).turned(0.25 * TAU);
        deviations.iter_mut().for_each(|deviation| deviation.angle_deg = 180.0);
        let elsewhere = of(&deviations);
        for i in 0..1000 {
            let angle = TAU * i as f64 / 1000.0;
            assert!((turned.depth(angle) - elsewhere.depth(angle)).abs() < 1e-15);
        }
        for (a, b) in turned.corners().iter().zip(elsewhere.corners()) {
            assert!((a - b).abs() < 1e-15);
        }
    }
}
