//! The seat of the outer ring in its housing: where it holds, opens and slips (THEORY §9.1).
//!
//! The seat is divided into panels, each with a spring across it, which cannot pull, and one along it, which friction holds. Tensions of
//! all springs follow from the modes, and from how far panels have opened and slipped.

mod hold;

use faer::{Mat, Side, linalg::solvers::Solve};
use serde::{Deserialize, Serialize};
use stribeck_simd::lanes::LANES;
use stribeck_solver::{state::NodeForces, statics::Spring};

pub use self::hold::Hold;
pub(crate) use self::hold::{Answers, Springs};
use crate::{
    error::Error,
    structure::{Structure, product},
};

/// Panels to either side of the middle, at least and at most, and their width in thicknesses of the outer ring.
const PANELS: [f64; 2] = [8.0, 31.0];
const WIDTH: f64 = 0.7;

/// Tangential over normal stiffness of contact, as in the full model (THEORY §4.3).
pub(crate) const STICKING: f64 = 0.8;

/// The seat as a reduction has it. Springs are across all panels, then along them, each filled up with zeros to whole groups.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Seat {
    /// Panels.
    pub panels: usize,
    /// The same, filled up to whole groups.
    pub padded: usize,
    /// Force that presses each panel at the preload [N].
    pub pressed: Vec<f64>,
    /// Stiffness across each panel [N/m].
    pub across: Vec<f64>,
    /// Tension of each spring by a unit of every mode when nothing opens or slips [N/(√kg m)], mode by mode.
    pub tension: Vec<f64>,
    /// Tension of each spring beyond the modes by a unit force towards the outside at each vertex of the raceway, vertex by vertex.
    pub by_rollers: Vec<f64>,
    /// The same by the rollers of the preload [N].
    pub at_preload: Vec<f64>,
    /// Loss of tension of each spring by a unit that another opens or slips [N/m], spring by spring.
    pub stiffness: Vec<f64>,
    /// Force on the ring by a unit tension of each spring.
    pub on_ring: Vec<[f64; 2]>,
    /// What of each mode's displacement of the raceway to the outside the tensions along the seat take back [1/√kg], vertex by vertex.
    pub taken_back: Vec<f64>,
    /// Displacement of each sensor beyond the modes by a unit tension of each spring [m/N]; across the seat, of tension that is missing.
    pub heard: Vec<Vec<[f64; 2]>>,
}

/// What the seat is made of, while the mesh is still there.
pub(crate) struct Parts<'a> {
    /// Springs across the seat, one for each contact point that carries.
    pub(crate) springs: &'a [Spring],
    /// Whether there is friction along it.
    pub(crate) friction: bool,
    /// Places by slot [m].
    pub(crate) x: &'a [f64],
    pub(crate) y: &'a [f64],
    /// Slots of the ring's back, with the force of the seat on each at the preload [N].
    pub(crate) back: &'a [(u32, [f64; 2])],
    /// Slots of the raceway, the direction to the outside at each, and the force of the rollers on it at the preload along that [N].
    pub(crate) raceway: &'a [(u32, [f64; 2], f64)],
    /// Slots of the sensors.
    pub(crate) sensors: &'a [u32],
    /// Whether a slot is one of the ring.
    pub(crate) of_ring: &'a dyn Fn(u32) -> bool,
    /// Thickness of the outer ring [m].
    pub(crate) thickness: f64,
}

/// What bodies do whose seat slides: stretches of its springs, across, then along.
struct Responses {
    /// By a unit of each mode [1/√kg].
    by_modes: Mat<f64>,
    /// By a unit tension of each spring, beyond the modes [m/N].
    flexibility: Mat<f64>,
    /// By a unit force towards the outside at each vertex of the raceway, beyond the modes [m/N].
    by_rollers: Mat<f64>,
    /// Force on the ring by a unit tension of each spring.
    on_ring: Vec<[f64; 2]>,
    /// Displacement of each sensor by the same, beyond the modes [m/N].
    heard: Vec<Vec<[f64; 2]>>,
}

/// Springs of the panels and what they do, before friction holds any.
struct Panels {
    count: usize,
    padded: usize,
    /// Across, then along: the springs of a panel and their stiffness [N/m].
    members: Vec<Vec<Spring>>,
    stiffness: Vec<f64>,
    pressed: Vec<f64>,
}

impl Seat {
    /// Divides the seat into panels, and turns the modes of a structure whose seat slides into those of one whose seat holds. `None`
    /// where there is no seat.
    ///
    /// # Errors
    /// When the modes of the held seat are not found.
    pub(crate) fn of(structure: &mut Structure, parts: &Parts<'_>) -> Result<Option<Self>, Error> {
        let Some(panels) = Panels::of(parts) else { return Ok(None) };
        let (p, stiffness) = (panels.padded, &panels.stiffness);
        let Responses { by_modes, flexibility, by_rollers, on_ring, heard } =
            Responses::of(structure, parts, &panels);
        let (modes, vertices) = (by_modes.ncols(), parts.raceway.len());

        // Tensions along the seat hold it: A τ = stretch − slip, A their own flexibility and that of the bodies (9.1b).
        let along = |i: usize| p + i;
        let own = Mat::from_fn(p, p, |i, j| {
            let spring = match (i == j, stiffness[along(i)]) {
                (false, _) => 0.0,
                (true, 0.0) => 1.0,
                (true, stiffness) => 1.0 / stiffness,
            };
            spring + 0.5 * (flexibility[(along(i), along(j))] + flexibility[(along(j), along(i))])
        });
        let holds = |i: usize| f64::from(u8::from(stiffness[along(i)] > 0.0));
        let inverse = own.partial_piv_lu().solve(Mat::<f64>::identity(p, p));
        let inverse =
            Mat::from_fn(p, p, |i, j| holds(i) * holds(j) * 0.5 * (inverse[(i, j)] + inverse[(j, i)]));
        let slides = Mat::from_fn(p, modes, |i, mode| by_modes[(along(i), mode)]);
        let coupling = Mat::from_fn(p, p, |i, j| stiffness[i] * flexibility[(i, along(j))]);
        let held = product(inverse.as_ref(), slides.as_ref());
        let held_by_rollers = product(inverse.as_ref(), by_rollers.get(p.., ..));
        let lifted_by_rollers = product(coupling.as_ref(), held_by_rollers.as_ref());
        let taken_back = product(held_by_rollers.transpose(), slides.as_ref());
        let by_rollers = Mat::from_fn(2 * p, vertices, |i, vertex| {
            if i < p {
                stiffness[i] * by_rollers[(i, vertex)] - lifted_by_rollers[(i, vertex)]
            } else {
                held_by_rollers[(i - p, vertex)]
            }
        });
        let forces = Mat::from_fn(vertices, 1, |vertex, _| parts.raceway[vertex].2);
        let at_preload = product(by_rollers.as_ref(), forces.as_ref());
        let crossed = product(coupling.as_ref(), inverse.as_ref());
        let opened = product(crossed.as_ref(), coupling.transpose());
        let lifted = product(coupling.as_ref(), held.as_ref());
        let loss = Mat::from_fn(2 * p, 2 * p, |i, j| match (i < p, j < p) {
            (true, true) => {
                let spring = if i == j { stiffness[i] } else { 0.0 };
                spring - stiffness[i] * flexibility[(i, j)] * stiffness[j] + opened[(i, j)]
            }
            (true, false) => -crossed[(i, j - p)],
            (false, true) => -crossed[(j, i - p)],
            (false, false) => inverse[(i - p, j - p)],
        });

        // The modes of what holds, made of those of what slides.
        let squares = structure.squares();
        let stiffer = product(slides.transpose(), held.as_ref());
        let matrix =
            Mat::from_fn(modes, modes, |i, j| stiffer[(i, j)] + if i == j { squares[i] } else { 0.0 });
        let eigen = matrix.self_adjoint_eigen(Side::Lower).map_err(|_| Error::NoModes)?;
        let squares: Vec<f64> = (0..modes).map(|i| eigen.S()[i].max(0.0)).collect();
        structure.turn(eigen.U(), squares);
        let tension = Mat::from_fn(2 * p, modes, |i, mode| {
            if i < p { stiffness[i] * by_modes[(i, mode)] - lifted[(i, mode)] } else { held[(i - p, mode)] }
        });
        let tension = product(tension.as_ref(), eigen.U());
        let taken_back = product(eigen.U().transpose(), taken_back.transpose());
        let listed = |of: &Mat<f64>| -> Vec<f64> {
            (0..of.ncols()).flat_map(|j| (0..of.nrows()).map(move |i| of[(i, j)])).collect()
        };
        Ok(Some(Self {
            panels: panels.count,
            padded: p,
            pressed: panels.pressed,
            across: panels.stiffness[..p].to_vec(),
            tension: listed(&tension),
            by_rollers: listed(&by_rollers),
            at_preload: listed(&at_preload),
            stiffness: listed(&loss),
            on_ring,
            taken_back: listed(&taken_back),
            heard,
        }))
    }
}

impl Seat {
    /// Displacement of the raceway at each vertex under a unit force there [m/N], beyond the modes, if the springs from `first` on give
    /// way: all of them, or those along the seat.
    pub(crate) fn give(&self, first: usize) -> Vec<f64> {
        let n = 2 * self.padded;
        let gives: Vec<usize> = (first..n).filter(|at| self.stiffness[at * n + at] > 0.0).collect();
        let of = |i: usize, j: usize| self.stiffness[gives[i] * n + gives[j]];
        let vertices = self.by_rollers.len() / n;
        if gives.is_empty() {
            return vec![0.0; vertices];
        }
        let stiffness = Mat::from_fn(gives.len(), gives.len(), of);
        let pulled = Mat::from_fn(gives.len(), vertices, |i, vertex| self.by_rollers[vertex * n + gives[i]]);
        let given = stiffness.partial_piv_lu().solve(&pulled);
        let under = |at: usize| (0..gives.len()).map(|i| pulled[(i, at)] * given[(i, at)]).sum();
        (0..vertices).map(under).collect()
    }
}

impl Responses {
    fn of(structure: &mut Structure, parts: &Parts<'_>, panels: &Panels) -> Self {
        let Panels { padded: p, members, stiffness, .. } = panels;
        let p = *p;
        let modes = structure.squares().len();
        let mut slots: Vec<u32> = parts.springs.iter().flat_map(|s| s.slots.iter().copied()).collect();
        slots.sort_unstable();
        slots.dedup();
        let at_sensors = slots.len();
        let at_raceway = at_sensors + parts.sensors.len();
        let mut index = vec![usize::MAX; parts.x.len()];
        slots.iter().enumerate().for_each(|(i, slot)| index[*slot as usize] = i);
        slots.extend(parts.sensors);
        slots.extend(parts.raceway.iter().map(|(slot, ..)| slot));

        // Stretches by modes, and by unit tensions beyond them.
        let mut by_modes = Mat::<f64>::zeros(2 * p, modes);
        let mut flexibility = Mat::<f64>::zeros(2 * p, 2 * p);
        let vertices = parts.raceway.len();
        let mut by_rollers = Mat::<f64>::zeros(2 * p, vertices);
        let mut on_ring = vec![[0.0; 2]; 2 * p];
        let mut heard = vec![vec![[0.0; 2]; 2 * p]; parts.sensors.len()];
        let shares = |at: usize| {
            members[at].iter().flat_map(move |spring| {
                let share = spring.stiffness / stiffness[at];
                let along = spring.direction.chunks_exact(2);
                spring.slots.iter().zip(along).map(move |(slot, d)| (*slot, [share * d[0], share * d[1]]))
            })
        };
        let there: Vec<usize> = (0..2 * p).filter(|at| !members[*at].is_empty()).collect();
        let mut units = Vec::with_capacity(there.len());
        for &at in &there {
            let mut opening = NodeForces::zeros(parts.x.len());
            for (slot, [fx, fy]) in shares(at) {
                opening.fx[slot as usize] += fx;
                opening.fy[slot as usize] += fy;
                if (parts.of_ring)(slot) {
                    on_ring[at] = [on_ring[at][0] - fx, on_ring[at][1] - fy];
                }
            }
            units.push(opening);
        }
        let responses = structure.residuals(&units, &slots);
        for ((&at, opening), moved) in there.iter().zip(&units).zip(&responses) {
            for (mode, stretch) in structure.generalised(opening, modes).into_iter().enumerate() {
                by_modes[(at, mode)] = stretch;
            }
            for (heard, [x, y]) in heard.iter_mut().zip(&moved[at_sensors..]) {
                heard[at] = [-x, -y];
            }
            for (vertex, ((_, [nx, ny], _), [x, y])) in
                parts.raceway.iter().zip(&moved[at_raceway..]).enumerate()
            {
                by_rollers[(at, vertex)] = nx * x + ny * y;
            }
            for other in 0..2 * p {
                flexibility[(other, at)] = shares(other)
                    .map(|(slot, [dx, dy])| {
                        let [x, y] = moved[index[slot as usize]];
                        dx * x + dy * y
                    })
                    .sum();
            }
        }
        Self { by_modes, flexibility, by_rollers, on_ring, heard }
    }
}

impl Panels {
    fn of(parts: &Parts<'_>) -> Option<Self> {
        let place = |slot: u32| [parts.x[slot as usize], parts.y[slot as usize]];
        let angle_of = |spring: &Spring| {
            let sum = spring.slots.iter().map(|slot| place(*slot));
            let [x, y] = sum.fold([0.0; 2], |[x, y], [px, py]| [x + px, y + py]);
            y.atan2(x)
        };
        let springs: Vec<(&Spring, f64)> =
            parts.springs.iter().map(|spring| (spring, angle_of(spring))).collect();
        // Angles count from the middle of the seat, so that none lies behind a full turn.
        let [sx, sy] = springs.iter().fold([0.0; 2], |[x, y], (_, a)| [x + a.cos(), y + a.sin()]);
        let middle = sy.atan2(sx);
        let from_middle = |angle: f64| {
            let (s, c) = (angle - middle).sin_cos();
            s.atan2(c)
        };
        let all = springs.iter().map(|(_, angle)| from_middle(*angle));
        let [first, last] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], at| [a.min(at), b.max(at)]);
        let [x, y] = place(*parts.springs.first()?.slots.first()?);
        let width = WIDTH * parts.thickness / x.hypot(y);
        // An odd number of them, counted from the middle: the mirrored seat has mirrored panels.
        let half = (0.5 * (last - first) / width).ceil().clamp(PANELS[0], PANELS[1]);
        let count = 2 * half as usize + 1;
        let panel_of = |angle: f64| {
            let share = (from_middle(angle) - 0.5 * (first + last)) / (last - first).max(f64::MIN_POSITIVE);
            (half + (share * count as f64).round().clamp(-half, half)) as usize
        };
        let padded = count.next_multiple_of(LANES);
        let mut stiffness = vec![0.0; 2 * padded];
        let mut members: Vec<Vec<Spring>> = vec![Vec::new(); 2 * padded];
        for (spring, angle) in &springs {
            let panel = panel_of(*angle);
            let along = parts.friction.then(|| (padded + panel, sticking(spring)));
            for (at, own) in std::iter::once((panel, (*spring).clone())).chain(along) {
                stiffness[at] += own.stiffness;
                members[at].push(own);
            }
        }
        let mut pressed = vec![0.0; padded];
        for ((_, angle), force) in springs.iter().zip(pressing(parts)) {
            pressed[panel_of(*angle)] += force;
        }
        pressed.iter_mut().for_each(|force| *force = force.max(0.0));
        Some(Self { count, padded, members, stiffness, pressed })
    }
}

/// Force that presses each spring at the preload [N]: that on each node of the ring goes through the springs that reach the node, by their
/// parts of the stiffness there. A panel that held whole nodes instead would let go too early or too late where its edges lie between them.
fn pressing(parts: &Parts<'_>) -> Vec<f64> {
    let mut inwards = vec![0.0; parts.x.len()];
    for (slot, [fx, fy]) in parts.back {
        let [x, y] = [parts.x[*slot as usize], parts.y[*slot as usize]];
        inwards[*slot as usize] = -(fx * x + fy * y) / x.hypot(y);
    }
    let reach = |spring: &Spring| -> Vec<(usize, f64)> {
        let nodes = spring.slots.iter().zip(spring.direction.chunks_exact(2));
        let parts = nodes.map(|(slot, d)| (*slot as usize, spring.stiffness * d[0].hypot(d[1])));
        parts.filter(|(_, stiffness)| *stiffness > 0.0).collect()
    };
    let mut held = vec![0.0; parts.x.len()];
    for (slot, stiffness) in parts.springs.iter().flat_map(reach) {
        held[slot] += stiffness;
    }
    let of = |spring: &Spring| reach(spring).iter().map(|(slot, k)| inwards[*slot] * k / held[*slot]).sum();
    parts.springs.iter().map(of).collect()
}

/// The spring across a normal one: the same nodes, directions turned by a right angle.
fn sticking(normal: &Spring) -> Spring {
    let turned = normal.direction.chunks_exact(2).flat_map(|d| [-d[1], d[0]]).collect();
    Spring { slots: normal.slots.clone(), direction: turned, stiffness: STICKING * normal.stiffness }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// A ring's back on springs alike, three points a facet, that a pressure alike presses: wherever the edges of panels lie between
    /// nodes, all of them are pressed as hard for their stiffness, but for the two at the ends, whose last nodes have half a facet each.
    #[test]
    fn invariant_panels_of_a_uniform_seat_are_pressed_alike() {
        const NODES: usize = 101;
        let (radius, spacing) = (0.1, 0.0123);
        let angle = |node: f64| FRAC_PI_2 + spacing * (node - 0.5 * (NODES - 1) as f64);
        let place = |node: usize| angle(node as f64).sin_cos();
        let x: Vec<f64> = (0..NODES).map(|n| radius * place(n).1).collect();
        let y: Vec<f64> = (0..NODES).map(|n| radius * place(n).0).collect();
        let on_facet = |facet: usize, share: f64| {
            let (s, c) = angle(facet as f64 + share).sin_cos();
            let ends = [(facet, 1.0 - share), (facet + 1, share)];
            Spring {
                slots: ends.iter().map(|(node, _)| *node as u32).collect(),
                direction: ends.iter().flat_map(|(_, part)| [part * c, part * s]).collect(),
                stiffness: 1e8,
            }
        };
        let springs: Vec<Spring> = (0..NODES - 1)
            .flat_map(|n| [1.0 / 6.0, 0.5, 5.0 / 6.0].map(|share| on_facet(n, share)))
            .collect();
        let force = |n: usize| if n == 0 || n == NODES - 1 { 50.0 } else { 100.0 };
        let back: Vec<(u32, [f64; 2])> =
            (0..NODES).map(|n| (n as u32, [-force(n) * place(n).1, -force(n) * place(n).0])).collect();
        for thickness in [0.004, 0.0071, 0.01, 0.0137] {
            let parts = Parts {
                springs: &springs,
                friction: true,
                x: &x,
                y: &y,
                back: &back,
                raceway: &[],
                sensors: &[],
                of_ring: &|_| true,
                thickness,
            };
            let panels = Panels::of(&parts).expect("a seat");
            let all: f64 = panels.pressed.iter().sum();
            assert!((all - 100.0 * (NODES - 1) as f64).abs() < 1e-9, "{all} N");
            let alike = 100.0 / 3e8;
            for n in 1..panels.count - 1 {
                let given = panels.pressed[n] / panels.stiffness[n];
                assert!(
                    (given / alike - 1.0).abs() < 1e-9,
                    "{given} m, {alike} m at panel {n} of {}",
                    panels.count
                );
            }
        }
    }
}
