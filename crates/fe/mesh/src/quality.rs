//! How good a mesh is, body by body.

use std::fmt;
use std::ops::Range;

use crate::{Mesh, characteristic_length};

/// Shape of the elements of a mesh and the critical time step that follows from it.
///
/// Its `Display` is a table with one line per body and one for all of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// One entry per body, in the order of [`Mesh::bodies`].
    pub bodies: Vec<BodyQuality>,
    /// The whole mesh, under the name `all`.
    pub overall: BodyQuality,
}

/// Shape of the elements of one body.
///
/// A body without elements has no angles and lengths; its smallest values are infinite, its largest are zero.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyQuality {
    /// Name of the body.
    pub name: String,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of quadrilaterals.
    pub quads: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Sharpest corner angle [rad]; negative when an element is inside out.
    pub smallest_angle: f64,
    /// Bluntest corner angle [rad].
    pub largest_angle: f64,
    /// Largest ratio of the longest to the shortest edge of an element.
    pub worst_aspect: f64,
    /// Smallest characteristic length [m], see [`characteristic_length`].
    pub smallest_length: f64,
    /// Mean characteristic length [m].
    pub mean_length: f64,
    /// Critical time step of central differences that the elements predict [s]: the smallest characteristic
    /// length over the wave speed. Contact and hourglass stiffness are not counted.
    pub critical_time_step: f64,
}

impl Quality {
    /// Measures a mesh for a given Poisson's ratio and speed of pressure waves √((λ + 2µ)/ρ) [m/s].
    pub fn of(mesh: &Mesh, poisson: f64, wave_speed: f64) -> Quality {
        let measure = |name: &str, nodes: usize, quads: Range<usize>, triangles: Range<usize>| {
            let mut tally = Tally::new(poisson);
            mesh.quads[quads.clone()].iter().for_each(|q| tally.add(&mesh.corners(q)));
            mesh.triangles[triangles.clone()].iter().for_each(|t| tally.add(&mesh.corners(t)));
            BodyQuality {
                name: name.to_owned(),
                nodes,
                quads: quads.len(),
                triangles: triangles.len(),
                smallest_angle: tally.smallest_angle,
                largest_angle: tally.largest_angle,
                worst_aspect: tally.worst_aspect,
                smallest_length: tally.smallest_length,
                mean_length: tally.sum_of_lengths / (quads.len() + triangles.len()).max(1) as f64,
                critical_time_step: tally.smallest_length / wave_speed,
            }
        };
        let bodies = mesh.bodies.iter();
        Quality {
            bodies: bodies
                .map(|b| measure(&b.name, b.nodes.len(), b.quads.clone(), b.triangles.clone()))
                .collect(),
            overall: measure("all", mesh.x.len(), 0..mesh.quads.len(), 0..mesh.triangles.len()),
        }
    }
}

/// Sums over elements.
struct Tally {
    poisson: f64,
    smallest_angle: f64,
    largest_angle: f64,
    worst_aspect: f64,
    smallest_length: f64,
    sum_of_lengths: f64,
}

impl Tally {
    fn new(poisson: f64) -> Tally {
        Tally {
            poisson,
            smallest_angle: f64::INFINITY,
            largest_angle: 0.0,
            worst_aspect: 0.0,
            smallest_length: f64::INFINITY,
            sum_of_lengths: 0.0,
        }
    }

    fn add(&mut self, corners: &[[f64; 2]]) {
        let n = corners.len();
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
        for i in 0..n {
            let ([x, y], [x1, y1], [x2, y2]) = (corners[i], corners[(i + 1) % n], corners[(i + n - 1) % n]);
            let (ax, ay, bx, by) = (x1 - x, y1 - y, x2 - x, y2 - y);
            let angle = libm::atan2(ax * by - ay * bx, ax * bx + ay * by);
            self.smallest_angle = self.smallest_angle.min(angle);
            self.largest_angle = self.largest_angle.max(angle);
            shortest = shortest.min(libm::hypot(ax, ay));
            longest = longest.max(libm::hypot(ax, ay));
        }
        self.worst_aspect = self.worst_aspect.max(longest / shortest);
        let length = characteristic_length(corners, self.poisson);
        self.smallest_length = self.smallest_length.min(length);
        self.sum_of_lengths += length;
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let widest = self.bodies.iter().map(|b| b.name.chars().count()).max().unwrap_or(0).max(4);
        writeln!(
            f,
            "{:widest$}  {:>8}  {:>8}  {:>9}  {:>13}  {:>6}  {:>15}  {:>7}",
            "body", "nodes", "quads", "triangles", "angles °", "aspect", "length min/mean", "Δt ns"
        )?;
        for body in self.bodies.iter().chain([&self.overall]) {
            writeln!(
                f,
                "{:widest$}  {:>8}  {:>8}  {:>9}  {:>5.1} … {:>5.1}  {:>6.2}  {:>6.4}/{:<6.4} mm  {:>7.2}",
                body.name,
                body.nodes,
                body.quads,
                body.triangles,
                body.smallest_angle.to_degrees(),
                body.largest_angle.to_degrees(),
                body.worst_aspect,
                1e3 * body.smallest_length,
                1e3 * body.mean_length,
                1e9 * body.critical_time_step,
            )?;
        }
        Ok(())
    }
}
