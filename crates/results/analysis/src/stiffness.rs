//! Stiffness and damping of a bearing over load, speed and the angle of its cage, for rotor dynamics
//! (THEORY §6.6).

use std::f64::consts::TAU;

use serde::Serialize;
use serde_json::{Map, Value, json};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_theory::contact_law::ContactLawKind;
use stribeck_theory::kinematics::Kinematics;
use stribeck_theory::ring_stiffness::RingState;

use crate::Error;

/// Harmonics of the ball pass frequency that are kept.
pub const HARMONICS: usize = 6;

/// At which points stiffness is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Loads [N].
    pub loads_n: Vec<f64>,
    /// Speeds of the inner ring [rpm], clockwise positive.
    pub speeds_rpm: Vec<f64>,
    /// Angles of the cage over one pitch of its elements.
    pub angles: usize,
    /// Law of contact.
    pub law: ContactLawKind,
    /// Damping over stiffness [s].
    pub damping_s: f64,
}

/// Stiffness of a bearing over load and speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BearingStiffness {
    /// Name of the scene.
    pub scene: String,
    /// Designation of the bearing; empty where it has none.
    pub bearing: String,
    /// The model behind it, in words.
    pub model: String,
    /// Law of contact, in words.
    pub contact: String,
    /// Rolling elements.
    pub elements: usize,
    /// Diametral clearance [µm].
    pub clearance_um: f64,
    /// Direction in which the load pushes the shaft [°], counter-clockwise from the x axis.
    pub load_on_shaft_deg: f64,
    /// Damping over stiffness [s]: stated, not computed.
    pub damping_over_stiffness_s: f64,
    /// Points, speed by speed within each load.
    pub points: Vec<Point>,
}

/// Stiffness at one load and speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Point {
    /// Load [N].
    pub load_n: f64,
    /// Speed of the inner ring [rpm].
    pub speed_rpm: f64,
    /// How often elements pass a place of the outer raceway [Hz]: the frequency of harmonic 1.
    pub bpfo_hz: f64,
    /// Least and most elements that touch both raceways.
    pub loaded: [usize; 2],
    /// Largest force at an inner contact [N].
    pub largest_n: f64,
    /// Stiffness [N/m].
    pub stiffness_n_m: TensorSeries,
    /// Damping [N s/m].
    pub damping_n_s_m: TensorSeries,
    /// Shift of the shaft against the housing under the load [m].
    pub shift_m: ShiftSeries,
    /// Angles of the cage [°] past an element in the middle of the load zone.
    pub cage_deg: Vec<f64>,
}

/// The components of a symmetric tensor over the angle of the cage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TensorSeries {
    /// Along x.
    pub xx: Series,
    /// Across; xy and yx are equal.
    pub xy: Series,
    /// Along y.
    pub yy: Series,
}

/// The components of a shift over the angle of the cage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ShiftSeries {
    /// Along x.
    pub x: Series,
    /// Along y.
    pub y: Series,
}

/// A number over the angle of the cage, which repeats every pitch of its elements:
/// mean + Σ cos[m] cos(m ψ) + sin[m] sin(m ψ), m from 1, with ψ = 2π BPFO t from an element in the middle of
/// the load zone on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Series {
    /// Mean.
    pub mean: f64,
    /// Least value.
    pub least: f64,
    /// Largest value.
    pub most: f64,
    /// Cosines of harmonics 1, 2, ….
    pub cos: Vec<f64>,
    /// Sines of the same.
    pub sin: Vec<f64>,
    /// The values themselves.
    pub values: Vec<f64>,
}

impl Series {
    /// Of values at equal distances over one period.
    pub fn of(values: Vec<f64>) -> Self {
        let n = values.len() as f64;
        let part = |m: usize, f: fn(f64) -> f64| {
            let of = |(i, v): (usize, &f64)| v * f(TAU * (m * i) as f64 / n);
            2.0 / n * values.iter().enumerate().map(of).sum::<f64>()
        };
        let all = 1..=HARMONICS.min((values.len() - 1) / 2);
        Self {
            mean: values.iter().sum::<f64>() / n,
            least: values.iter().copied().fold(f64::INFINITY, f64::min),
            most: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            cos: all.clone().map(|m| part(m, f64::cos)).collect(),
            sin: all.map(|m| part(m, f64::sin)).collect(),
            values,
        }
    }

    /// Largest less least over the mean [-]; zero where the mean is.
    pub fn variation(&self) -> f64 {
        if self.mean == 0.0 { 0.0 } else { (self.most - self.least) / self.mean.abs() }
    }

    /// Amplitude of harmonic `m`, from 1.
    pub fn amplitude(&self, m: usize) -> f64 {
        self.cos[m - 1].hypot(self.sin[m - 1])
    }
}

impl TensorSeries {
    fn of(tensors: impl Iterator<Item = [f64; 3]>) -> Self {
        let all: Vec<[f64; 3]> = tensors.collect();
        let [xx, xy, yy] = [0, 1, 2].map(|at| Series::of(all.iter().map(|t| t[at]).collect()));
        Self { xx, xy, yy }
    }
}

impl BearingStiffness {
    /// Of the bearing of a scene, as if it were sound.
    ///
    /// # Errors
    /// [`Error::Run`] where a load finds no equilibrium.
    pub fn of(scene: &ResolvedScene, grid: &Grid) -> Result<Self, Error> {
        let mut points = Vec::new();
        for &load_n in &grid.loads_n {
            for &speed_rpm in &grid.speeds_rpm {
                points.push(Point::of(scene, grid, load_n, speed_rpm)?);
            }
        }
        let written = &scene.written;
        Ok(Self {
            scene: written.name.clone(),
            bearing: written.bearing.designation.clone(),
            model:
                "quasi-static equilibrium between rigid rings with elastic contacts and centrifugal force, \
                    without defects, friction, oil and the elasticity of rings and housing"
                    .to_owned(),
            contact: grid.law.spoken().to_owned(),
            elements: scene.rollers,
            clearance_um: 1e6 * scene.clearance,
            load_on_shaft_deg: written.load_zone_deg(),
            damping_over_stiffness_s: grid.damping_s,
            points,
        })
    }

    /// All points as a table: one row an angle.
    pub fn csv(&self) -> String {
        let mut text = "load_n,speed_rpm,cage_deg,kxx_n_m,kxy_n_m,kyy_n_m,cxx_n_s_m,cxy_n_s_m,cyy_n_s_m,\
                        shift_x_m,shift_y_m\n"
            .to_owned();
        for point in &self.points {
            let (k, c, u) = (&point.stiffness_n_m, &point.damping_n_s_m, &point.shift_m);
            for (i, cage) in point.cage_deg.iter().enumerate() {
                let columns = [&k.xx, &k.xy, &k.yy, &c.xx, &c.xy, &c.yy, &u.x, &u.y];
                let values: String = columns.iter().map(|s| format!(",{:.9e}", s.values[i])).collect();
                text += &format!("{},{},{cage}{values}\n", point.load_n, point.speed_rpm);
            }
        }
        text
    }

    /// A file that ROSS loads, `BearingElement.load(FILE)`, at node 0: the means of one load over the speed
    /// of the shaft [rad/s].
    pub fn ross(&self, load_n: f64) -> Value {
        // ROSS interpolates over ascending frequencies.
        let mut points: Vec<&Point> = self.points.iter().filter(|p| p.load_n == load_n).collect();
        points.sort_by(|a, b| a.speed_rpm.abs().total_cmp(&b.speed_rpm.abs()));
        points.dedup_by(|a, b| a.speed_rpm.abs() == b.speed_rpm.abs());
        let column = |of: &dyn Fn(&Point) -> f64| points.iter().map(|p| of(p)).collect::<Vec<f64>>();
        let tag = format!(
            "stribeck {} {load_n} N",
            if self.bearing.is_empty() { &self.scene } else { &self.bearing }
        );
        let element = json!({
            "n": 0,
            "tag": tag,
            "frequency": column(&|p| p.speed_rpm.abs() * TAU / 60.0),
            "kxx": column(&|p| p.stiffness_n_m.xx.mean),
            "kxy": column(&|p| p.stiffness_n_m.xy.mean),
            "kyx": column(&|p| p.stiffness_n_m.xy.mean),
            "kyy": column(&|p| p.stiffness_n_m.yy.mean),
            "cxx": column(&|p| p.damping_n_s_m.xx.mean),
            "cxy": column(&|p| p.damping_n_s_m.xy.mean),
            "cyx": column(&|p| p.damping_n_s_m.xy.mean),
            "cyy": column(&|p| p.damping_n_s_m.yy.mean),
        });
        Value::Object(Map::from_iter([(format!("BearingElement_{tag}"), element)]))
    }
}

impl Point {
    fn of(scene: &ResolvedScene, grid: &Grid, load_n: f64, speed_rpm: f64) -> Result<Self, Error> {
        let rings = scene.turning_rings(grid.law, speed_rpm);
        let pitch = TAU / scene.rollers as f64;
        let cages: Vec<f64> = (0..grid.angles).map(|i| pitch * i as f64 / grid.angles as f64).collect();
        let states: Vec<RingState> =
            cages.iter().map(|cage| rings.equilibrium(load_n, *cage)).collect::<Result<_, _>>()?;
        let outer_rpm = scene.written.operation.outer_speed_rpm;
        let k = Kinematics::between(&scene.written.bearing, speed_rpm, outer_rpm);
        let loaded = states.iter().map(|s| s.loaded);
        let stiffness = || states.iter().map(|s| s.stiffness_n_m);
        let shift = |at: usize| Series::of(states.iter().map(|s| s.shift_m[at]).collect());
        Ok(Self {
            load_n,
            speed_rpm,
            bpfo_hz: k.bpfo_hz,
            loaded: [loaded.clone().min().unwrap_or(0), loaded.max().unwrap_or(0)],
            largest_n: states.iter().map(|s| s.largest_n).fold(0.0, f64::max),
            stiffness_n_m: TensorSeries::of(stiffness()),
            damping_n_s_m: TensorSeries::of(stiffness().map(|k| k.map(|k| grid.damping_s * k))),
            shift_m: ShiftSeries { x: shift(0), y: shift(1) },
            cage_deg: cages.iter().map(|cage| cage.to_degrees()).collect(),
        })
    }
}
