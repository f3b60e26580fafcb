//! Decks for Radioss, of a motion that has begun: where all nodes are, what stress that is, and how they move.
//!
//! A starter deck has mesh, material, contacts and loads; the first engine deck brings the nodes from rest to
//! where they are at the start, the second sets the bodies rolling and runs. Radioss has plane strain in its
//! plane of y and z, for a unit of thickness: our x is its y, our y its z, forces are those of a millimetre,
//! and units are kg, mm and ms. Contacts are `/INTER/TYPE3`, the one of its plane contacts with a penalty,
//! whose stiffness is matched through `Stfac` ([`Touching::stiffness`]); it has neither damping nor a friction
//! that slides. Its two passes are alike where facets of both surfaces are as long; otherwise that of the
//! shorter ones is the stiffer.
//!
//! Elements are `/QUAD` in a frame that turns with them, without viscosity. Those that are parallelograms or
//! isosceles trapezia, as along the surfaces, have four points with one pressure: these resist hourglassing as
//! ours with [`HOURGLASS_SCALE`]. The one-point element of the program does so by viscosity alone, which
//! brakes turning, and lets go of the sixth part of a node's contact force that ours carries by stiffness.
//! All others have one point, because with four points they resist turning: a free body swings. With four
//! pressures vibrations grow where elements are trapezia. Triangles have their last node twice, as which their
//! mass is shared ¼, ¼, ½. Stress cannot be written in place of a way from rest: `/INIQUA/STRESS` has one for
//! all four points, and without a density beside it loses its pressure.
//!
//! Source: *Altair Radioss Reference Guide*, starter and engine input.

use std::collections::HashMap;
use std::fmt::Write;
use std::ops::Range;

use crate::{Mesh, Surface};

/// Millimetres in a metre, milliseconds in a second.
const MILLI: f64 = 1e3;
/// Pascals to gigapascals, kilograms in a cubic metre to those in a cubic millimetre.
const GIGA: f64 = 1e-9;
/// Node numbers in a line of a group.
const A_LINE: usize = 10;
/// Zero stands for a default of the program; this for none.
const NONE: f64 = 1e-20;
/// Shares of a load that differ by less are one.
const ALIKE: f64 = 1e-9;
/// Steps from rest to the start. Stress follows strain a step late, so that a thousandth of its deviator lacks.
const WAY_STEPS: f64 = 1e3;
/// Length of each [s], in which no force moves a node.
const WAY_STEP: f64 = 1e-12;
/// The program's own estimate of the critical step, times this, must not undercut ours.
const STEP_SCALE: f64 = 4.0;

/// `solver.hourglass_scale` with which our elements, if they are square, resist hourglassing as those of the
/// deck, for ν = 0.3: µ/E'. Measured; a rectangle a × b bent along a has µ b/12a there.
pub const HOURGLASS_SCALE: f64 = 0.35;

/// Numbers of the properties.
const FOUR_POINTS: usize = 1;
const ONE_POINT: usize = 2;
/// Sides that differ in length or direction by less are equal or parallel [-].
const REGULAR: f64 = 0.01;

/// Two surfaces that may touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Touching<'a> {
    /// Name in the deck.
    pub name: String,
    /// The surfaces; histories hold the force on the body of the first.
    pub surfaces: [&'a Surface; 2],
    /// Pressure a metre of penetration, of both passes together [Pa/m].
    pub stiffness: f64,
}

/// Bodies in motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion<'a> {
    /// Nodes without stress, elements and bodies.
    pub mesh: &'a Mesh,
    /// Bodies that are left out, by their numbers.
    pub absent: Vec<usize>,
    /// Young's modulus [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio [-].
    pub poissons_ratio: f64,
    /// Density [kg/m³].
    pub density: f64,
    /// Thickness across the plane [m].
    pub thickness: f64,
    /// What may touch.
    pub contacts: Vec<Touching<'a>>,
    /// Acceleration of gravity [m/s²].
    pub gravity: [f64; 2],
    /// A load spread evenly over the length of a surface, and the whole of it [N].
    pub load: (&'a Surface, [f64; 2]),
    /// Nodes that do not move along x.
    pub guided: Vec<u32>,
    /// Nodes that turn about the origin, and how fast [rad/s], counter-clockwise.
    pub turning: (Vec<u32>, f64),
    /// Bodies damped in proportion to their mass, relative to rest, and the rate [1/s].
    pub damping: (Vec<usize>, f64),
    /// Where each node is at the start [m].
    pub position: Vec<[f64; 2]>,
    /// How each body moves then, as a rigid one: the velocity of its point at the origin [m/s] and its rate
    /// [rad/s], counter-clockwise.
    pub rolling: Vec<([f64; 2], f64)>,
    /// How long it lasts [s].
    pub duration: f64,
    /// Time step [s].
    pub time_step: f64,
    /// Interval of histories [s].
    pub interval: f64,
    /// Nodes whose displacement and velocity are kept, with their names.
    pub kept: Vec<(String, u32)>,
    /// Remarks for the head of the deck.
    pub remarks: Vec<String>,
}

impl Motion<'_> {
    /// The starter deck; `name` is that of the run, `title` its first comment.
    pub fn starter(&self, name: &str, title: &str) -> String {
        let mut out = format!("#RADIOSS STARTER\n# {}\n", title.replace(['\n', '\r'], " "));
        for remark in &self.remarks {
            let _ = writeln!(out, "# {remark}");
        }
        let elements = || self.present().flat_map(|(_, body)| self.elements(body));
        let of_one_point = elements().filter(|(_, e)| self.property(*e) == ONE_POINT).count();
        let all = elements().count();
        let _ =
            writeln!(out, "# {of_one_point} of {all} elements have one point: hourglassing is free there");
        let units = format!("{:>20}{:>20}{:>20}\n", "kg", "mm", "ms");
        let _ = write!(out, "/BEGIN\n{name}\n{:10}{:10}\n{units}{units}/TITLE\n{name}\n", 2022, 0);
        // Plane strain.
        let _ = writeln!(out, "/ANALY\n{:10}{:10}{:10}{:10}", 2, "", 0, 0);
        self.material(&mut out);
        self.mesh_cards(&mut out);
        self.way(&mut out);
        self.driven(&mut out);
        for (n, touching) in self.contacts.iter().enumerate() {
            self.contact(&mut out, n + 1, touching);
        }
        self.histories(&mut out);
        out + "/END\n"
    }

    /// The two engine decks of the same run.
    pub fn engines(&self, name: &str) -> [String; 2] {
        let deck = |run: usize, until: f64, step: f64, interval: f64| {
            let [until, step, interval] = [until, step, interval].map(|s| shortest(MILLI * s));
            format!(
                "/RUN/{name}/{run}\n{until}\n/VERS/2022\n/TFILE/3\n{interval}\n/PRINT/-10000\n/DT/ALL\n\
                 {STEP_SCALE} 0\n/DTIX\n{step} {step}\n/MON/ON\n/RFILE\n100000000\n"
            )
        };
        let way = WAY_STEPS * WAY_STEP;
        let mut run = deck(2, self.duration, self.time_step, self.interval);
        for (n, body) in self.present() {
            let ([y, z], rate) = self.rolling[n];
            let [y, z, rate] = [y, z, rate / MILLI].map(shortest);
            let (first, last) = (body.nodes.start + 1, body.nodes.end);
            let _ = writeln!(run, "/INIV/AXIS/X/1\n0\n0 {y} {z} {rate}\n{first} {last}");
        }
        // It ends with the step that passes its end.
        [deck(1, way - 0.5 * WAY_STEP, WAY_STEP, self.duration), run]
    }

    fn present(&self) -> impl Iterator<Item = (usize, &crate::Body)> {
        self.mesh.bodies.iter().enumerate().filter(|(n, _)| !self.absent.contains(n))
    }

    fn material(&self, out: &mut String) {
        let [density, modulus] = [self.density, self.youngs_modulus].map(|v| real(GIGA * v));
        let _ = writeln!(out, "/MAT/LAW1/1\nelastic\n{density}\n{modulus}{}", real(self.poissons_ratio));
        let zero = real(0.0);
        let none = real(NONE);
        // Finite strain, a frame that turns with the element.
        for (property, [points, pressure]) in [(FOUR_POINTS, [17, 1]), (ONE_POINT, [2, 0])] {
            let _ = write!(out, "/PROP/TYPE14/{property}\nplane strain\n");
            let _ = writeln!(
                out,
                "{points:10}{:10}{:10}{pressure:10}{:10}{:10}{:10}{:10}{zero}",
                4, "", 0, 222, 0, 2
            );
            let _ = writeln!(out, "{none}{none}{none}{zero}{zero}\n{zero}{:10}{:10}", 0, 0);
            let _ = writeln!(out, "{:10}{:10}", 0, 0);
        }
    }

    /// Numbers of the parts of a body, by the property of their elements, as far as it has them.
    fn parts(&self, n: usize) -> impl Iterator<Item = (usize, usize)> {
        let bodies = self.mesh.bodies.len();
        let has =
            move |property| self.elements(&self.mesh.bodies[n]).any(|(_, e)| self.property(e) == property);
        let parts = [(n + 1, FOUR_POINTS), (n + 1 + bodies, ONE_POINT)];
        parts.into_iter().filter(move |&(_, property)| has(property))
    }

    fn property(&self, corners: [u32; 4]) -> usize {
        let at = corners.map(|n| [self.mesh.x[n as usize], self.mesh.y[n as usize]]);
        if corners[2] != corners[3] && regular(&at) { FOUR_POINTS } else { ONE_POINT }
    }

    fn mesh_cards(&self, out: &mut String) {
        for (n, body) in self.present() {
            for (part, property) in self.parts(n) {
                let _ = writeln!(out, "/PART/{part}\n{}\n{property:10}{:10}{:10}", body.name, 1, 0);
            }
        }
        *out += "/NODE\n";
        for (_, body) in self.present() {
            for n in body.nodes.clone() {
                let [y, z] = [self.mesh.x[n], self.mesh.y[n]].map(|v| real(MILLI * v));
                let _ = writeln!(out, "{:10}{}{y}{z}", n + 1, real(0.0));
            }
        }
        let zero = real(0.0);
        let _ = writeln!(out, "{:10}{zero}{zero}{zero}", self.main());
        for (n, body) in self.present() {
            for (part, property) in self.parts(n) {
                let _ = writeln!(out, "/QUAD/{part}");
                for (number, [a, b, c, d]) in
                    self.elements(body).filter(|(_, corners)| self.property(*corners) == property)
                {
                    let _ = writeln!(out, "{number:10}{:10}{:10}{:10}{:10}", a + 1, b + 1, c + 1, d + 1);
                }
            }
        }
    }

    /// Number of the node that turns the others, beyond those of the mesh.
    fn main(&self) -> usize {
        self.mesh.x.len() + 1
    }

    /// Elements of a body, each with its number in the deck; triangles have their last corner twice.
    fn elements(&self, body: &crate::Body) -> impl Iterator<Item = (usize, [u32; 4])> {
        let Mesh { quads, triangles, .. } = self.mesh;
        let all = quads.len();
        let numbered = |range: Range<usize>, first: usize| range.map(move |n| (n, first + n + 1));
        let quads = numbered(body.quads.clone(), 0).map(|(n, number)| (number, quads[n]));
        let triangles = numbered(body.triangles.clone(), all).map(|(n, number)| {
            let [a, b, c] = triangles[n];
            (number, [a, b, c, c])
        });
        quads.chain(triangles)
    }

    /// Velocities that bring the nodes to where they are at the start.
    fn way(&self, out: &mut String) {
        *out += "/INIVEL/NODE/1\nway\n";
        let zero = real(0.0);
        for (_, body) in self.present() {
            for n in body.nodes.clone() {
                let [x, y] = self.position[n];
                let way = [x - self.mesh.x[n], y - self.mesh.y[n]];
                if way != [0.0; 2] {
                    let [y, z] = way.map(|v| real(v / (WAY_STEPS * WAY_STEP)));
                    let number = n + 1;
                    let _ = writeln!(out, "{number:10}{:10}{zero}{y}{z}\n{:20}{zero}{zero}{zero}", 0, "");
                }
            }
        }
    }

    /// Supports, drive, loads and damping.
    fn driven(&self, out: &mut String) {
        let (turning, rate) = &self.turning;
        let main = self.main();
        nodes(out, 1, "turning", turning);
        let _ = writeln!(out, "/GRNOD/NODE/2\nturns them\n{main:10}");
        // About the place of the main node, which has no mass of its own to speak of.
        let zero = real(0.0);
        let _ = writeln!(
            out,
            "/RBODY/1\nturning\n{main:10}{:10}{:10}{:10}{}{:10}{:10}{:10}{:10}",
            0,
            0,
            0,
            real(NONE),
            1,
            0,
            3,
            0
        );
        let _ = writeln!(out, "{zero}{zero}{zero}\n{zero}{zero}{zero}\n{:10}{:10}{:10}", 0, 0, 0);
        let _ = writeln!(out, "/BCS/1\ncentre\n   011 000{:10}{:10}", 0, 2);
        let end = real(1e3 * MILLI * self.duration);
        let one = real(1.0);
        let _ = writeln!(out, "/FUNCT/1\none\n{zero}{one}\n{end}{one}");
        let rate = real(rate / MILLI);
        let _ =
            writeln!(out, "/IMPVEL/1\nspin\n{:10}{:>10}{:10}{:10}{:10}{:10}{:10}", 1, "XX", "", 0, 2, "", 0);
        let _ = writeln!(out, "{one}{rate}{zero}{end}");
        let present =
            |out: &mut String, group: usize, name: &str, bodies: &mut dyn Iterator<Item = usize>| {
                let _ = writeln!(out, "/GRNOD/PART/{group}\n{name}");
                lines(out, bodies.flat_map(|n| self.parts(n)).map(|(part, _)| part));
            };
        for (axis, (letter, g)) in ["Y", "Z"].into_iter().zip(self.gravity).enumerate() {
            if g != 0.0 {
                present(out, 3, "all", &mut self.present().map(|(n, _)| n));
                let g = real(g / MILLI);
                let _ = writeln!(
                    out,
                    "/GRAV/{}\ngravity\n{:10}{letter:>10}{:10}{:10}{:10}{:10}{one}{g}",
                    axis + 1,
                    1,
                    0,
                    0,
                    3,
                    ""
                );
            }
        }
        let (bodies, rate) = &self.damping;
        if *rate > 0.0 && !bodies.is_empty() {
            present(out, 4, "damped", &mut bodies.iter().copied());
            let rate = real(rate / MILLI);
            let _ = writeln!(out, "/DAMP/1\nmass damping\n{rate}{zero}{:10}{:10}{zero}{end}", 4, 0);
        }
        if !self.guided.is_empty() {
            nodes(out, 5, "guided", &self.guided);
            let _ = writeln!(out, "/BCS/2\nguided\n   010 000{:10}{:10}", 0, 5);
        }
        self.loads(out, 100);
    }

    /// Loads on nodes, by groups of equal shares; their numbers are free from `first` on.
    fn loads(&self, out: &mut String, first: usize) {
        let (surface, total) = self.load;
        let [lengths, _] = self.facets(surface, &HashMap::new());
        let whole: f64 = lengths.iter().sum();
        let mut shares: Vec<(f64, Vec<u32>)> = Vec::new();
        let n = lengths.len();
        for (i, &node) in surface.nodes.iter().enumerate() {
            let before = if i > 0 {
                lengths[i - 1]
            } else if surface.closed {
                lengths[n - 1]
            } else {
                0.0
            };
            let share = 0.5 * (before + lengths.get(i).copied().unwrap_or(0.0)) / whole;
            match shares.iter_mut().find(|(known, _)| (known - share).abs() < ALIKE * share) {
                Some((_, nodes)) => nodes.push(node),
                None => shares.push((share, vec![node])),
            }
        }
        for (number, (share, group)) in (first..).zip(shares) {
            nodes(out, number, "loaded", &group);
            for (axis, (letter, total)) in ["Y", "Z"].into_iter().zip(total).enumerate() {
                if total != 0.0 {
                    // A newton a metre of thickness is 1e-6 kN a millimetre.
                    let force = real(1e-6 * share * total / self.thickness);
                    let _ = writeln!(
                        out,
                        "/CLOAD/{}\nload\n{:10}{letter:>10}{:10}{:10}{number:10}{:10}{}{force}",
                        2 * number + axis,
                        1,
                        0,
                        0,
                        "",
                        real(1.0)
                    );
                }
            }
        }
    }

    /// One interface and its two surfaces.
    fn contact(&self, out: &mut String, number: usize, touching: &Touching<'_>) {
        let first = 2 * number - 1;
        for (n, surface) in touching.surfaces.iter().enumerate() {
            let _ = writeln!(out, "/SURF/SEG/{}\n{}", first + n, touching.name);
            for facet in 0..surface.facets() {
                let [a, b] = surface.facet(facet);
                let _ = writeln!(out, "{:10}{:10}{:10}", facet + 1, a + 1, b + 1);
            }
        }
        let zero = real(0.0);
        let scale = real(self.stiffness_factor(touching));
        let _ = writeln!(
            out,
            "/INTER/TYPE3/{number}\n{}\n{first:10}{:10}{:50}{:10}",
            touching.name,
            first + 1,
            "",
            0
        );
        let _ =
            writeln!(out, "{scale}{zero}{zero}{zero}{zero}\n{:7}000{:10}{:10}\n{:60}{zero}", "", 0, 0, "");
    }

    /// `Stfac` with which both passes of a contact are as stiff as ours.
    ///
    /// A segment of length L at an element of area A has f K L²/A with the bulk modulus K, a node the mean of
    /// its two; both stand in series, in each of the two passes.
    fn stiffness_factor(&self, touching: &Touching<'_>) -> f64 {
        let areas = self.areas();
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len().max(1) as f64;
        let [one, other] = touching.surfaces.map(|surface| {
            let [lengths, areas] = self.facets(surface, &areas);
            let shapes: Vec<f64> = lengths.iter().zip(&areas).map(|(l, a)| l * l / a).collect();
            [mean(&lengths), mean(&shapes)]
        });
        let bulk = self.youngs_modulus / (3.0 * (1.0 - 2.0 * self.poissons_ratio));
        let series = one[1] * other[1] / (one[1] + other[1]);
        touching.stiffness / (bulk * series * (1.0 / one[0] + 1.0 / other[0]))
    }

    /// Lengths of the facets of a surface, and areas of the elements at them, as far as they are known.
    fn facets(&self, surface: &Surface, areas: &HashMap<[u32; 2], f64>) -> [Vec<f64>; 2] {
        let facets = || (0..surface.facets()).map(|n| surface.facet(n));
        let length = |[a, b]: [u32; 2]| {
            let [[ax, ay], [bx, by]] = [a, b].map(|n| self.position[n as usize]);
            libm::hypot(bx - ax, by - ay)
        };
        let area = |[a, b]: [u32; 2]| areas.get(&[a, b]).or_else(|| areas.get(&[b, a])).copied();
        [facets().map(length).collect(), facets().filter_map(area).collect()]
    }

    /// Area of the element at each edge [m²]; of one between two elements, that which has it in its direction.
    fn areas(&self) -> HashMap<[u32; 2], f64> {
        let mut areas = HashMap::new();
        for (_, body) in self.present() {
            for (_, corners) in self.elements(body) {
                let [p, q, r, s] = corners.map(|n| self.position[n as usize]);
                let area = 0.5 * ((r[0] - p[0]) * (s[1] - q[1]) - (s[0] - q[0]) * (r[1] - p[1]));
                for i in 0..4 {
                    areas.insert([corners[i], corners[(i + 1) % 4]], area);
                }
            }
        }
        areas
    }

    fn histories(&self, out: &mut String) {
        let _ = writeln!(out, "/TH/INTER/1\ncontacts\nDEF       ");
        lines(out, 1..=self.contacts.len());
        for (name, node) in &self.kept {
            let _ = writeln!(out, "# node {}: {name}", node + 1);
        }
        let _ = writeln!(out, "/TH/NODE/2\nkept\nDEF       ");
        for (_, node) in &self.kept {
            let _ = writeln!(out, "{:10}{:10}", node + 1, 0);
        }
    }
}

/// Whether corners are those of a parallelogram or of an isosceles trapezium.
fn regular(corners: &[[f64; 2]; 4]) -> bool {
    let side: [[f64; 2]; 4] =
        std::array::from_fn(|i| [0, 1].map(|k| corners[(i + 1) % 4][k] - corners[i][k]));
    let length = side.map(|[x, y]| libm::hypot(x, y));
    let near = REGULAR * length.into_iter().fold(0.0, f64::max);
    // Opposite sides: they have opposite directions.
    let parallel = |i: usize| {
        let ([ax, ay], [bx, by]) = (side[i], side[i + 2]);
        (ax * by - ay * bx).abs() < REGULAR * length[i] * length[i + 2]
    };
    let equal = |i: usize| (length[i] - length[i + 2]).abs() < near;
    (parallel(0) && equal(1)) || (parallel(1) && equal(0))
}

fn nodes(out: &mut String, number: usize, name: &str, nodes: &[u32]) {
    let _ = writeln!(out, "/GRNOD/NODE/{number}\n{name}");
    lines(out, nodes.iter().map(|n| *n as usize + 1));
}

fn lines(out: &mut String, numbers: impl Iterator<Item = usize>) {
    for line in numbers.collect::<Vec<_>>().chunks(A_LINE) {
        let words: String = line.iter().map(|n| format!("{n:10}")).collect();
        let _ = writeln!(out, "{words}");
    }
}

/// A number in its twenty columns.
fn real(value: f64) -> String {
    // There is no minus zero.
    format!("{:>20}", format!("{:.12E}", value + 0.0))
}

/// A number as short as it can be without loss.
fn shortest(value: f64) -> String {
    format!("{value:E}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_regular_quadrilaterals() {
        for (corners, expected) in [
            ([[0.0, 0.0], [2.0, 0.0], [2.3, 1.0], [0.3, 1.0]], true),
            ([[0.0, 0.0], [0.5, -1.0], [0.5, 2.0], [0.0, 1.0]], true),
            // A trapezium with a right angle, a kite.
            ([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 2.0]], false),
            ([[0.0, 0.0], [1.0, -1.0], [3.0, 0.0], [1.0, 1.0]], false),
        ] {
            assert_eq!(regular(&corners), expected, "{corners:?}");
        }
    }
}
