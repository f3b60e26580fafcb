//! The panels of the seat of the outer ring in its housing (THEORY §9.1).
//!
//! Each panel has a normal spring, which cannot pull, and a tangential one, which friction holds. Tensions of
//! all springs follow from the modes and from how far panels have opened and slipped.

use faer::{Mat, Side, linalg::solvers::Solve};
use stribeck_reduced::modal::{GROUP, STICKING, Seat};
use stribeck_solver::{state::NodeForces, statics::Spring};

use crate::error::Error;
use crate::reduction::{
    raceway::RacewayNode,
    structure::{Structure, product},
};

/// Panels to either side of the middle, at least and at most, and their width in thicknesses of the outer
/// ring.
const PANELS: [f64; 2] = [8.0, 31.0];
const WIDTH: f64 = 0.7;

/// The seat in the mesh.
pub(crate) struct Parts<'a> {
    /// Normal springs, one for each contact point that carries or may come to, and how far each is from that
    /// [m].
    pub(crate) springs: &'a [Spring],
    pub(crate) gaps: &'a [f64],
    pub(crate) friction: bool,
    /// Places by slot [m].
    pub(crate) x: &'a [f64],
    pub(crate) y: &'a [f64],
    /// Slots of the ring's back, with the force of the seat on each at the preload [N].
    pub(crate) back: &'a [(u32, [f64; 2])],
    pub(crate) raceway: &'a [RacewayNode],
    pub(crate) sensors: &'a [u32],
    /// Whether a slot is one of the ring.
    pub(crate) of_ring: &'a dyn Fn(u32) -> bool,
    /// Thickness of the outer ring [m].
    pub(crate) thickness: f64,
}

/// Stretches of the springs of a seat that slides freely: normal springs, then tangential ones.
struct Responses {
    /// By a unit of each mode [1/√kg].
    by_modes: Mat<f64>,
    /// Residual, by a unit tension of each spring [m/N].
    flexibility: Mat<f64>,
    /// Residual, by a unit force towards the outside at each vertex of the raceway [m/N].
    by_rollers: Mat<f64>,
    /// Force on the ring by a unit tension of each spring.
    on_ring: Vec<[f64; 2]>,
    /// Residual displacement of each sensor by the same [m/N].
    at_sensors: Vec<Vec<[f64; 2]>>,
}

/// Springs of the panels.
struct Panels {
    count: usize,
    padded: usize,
    /// Normal, then tangential: the springs of a panel and their stiffness [N/m].
    members: Vec<Vec<Spring>>,
    stiffness: Vec<f64>,
    pressed: Vec<f64>,
    /// How far the panels that nothing presses are from touching [m].
    gaps: Vec<f64>,
}

/// What tangential springs hold: A τ = stretch − slip, with A their own flexibility and that of the bodies
/// (9.1b).
struct Tangential {
    /// A⁻¹ [N/m].
    inverse: Mat<f64>,
    /// Stretches by a unit of each mode [1/√kg].
    slides: Mat<f64>,
    /// Change of each normal tension by a unit of each tangential one.
    coupling: Mat<f64>,
    /// Tensions by a unit of each mode, and by a unit force at each vertex of the raceway.
    held: Mat<f64>,
    held_by_rollers: Mat<f64>,
}

/// Divides the seat into panels, and turns the modes of a structure whose seat slides into those of one whose
/// seat holds. `None` where there is no seat.
pub(crate) fn of(structure: &mut Structure, parts: &Parts<'_>) -> Result<Option<Seat>, Error> {
    let Some(panels) = Panels::of(parts) else { return Ok(None) };
    let responses = Responses::of(structure, parts, &panels);
    let tangential = Tangential::of(&panels, &responses);
    let by_rollers = tangential.by_rollers(&panels, &responses);
    let forces = Mat::from_fn(parts.raceway.len(), 1, |vertex, _| parts.raceway[vertex].force);
    let at_preload = product(by_rollers.as_ref(), forces.as_ref());
    let taken_back = product(tangential.held_by_rollers.transpose(), tangential.slides.as_ref());
    let loss = tangential.loss(&panels, &responses);
    let turned = tangential.modes(structure)?;
    let tension = product(tangential.tension(&panels, &responses).as_ref(), turned.as_ref());
    let taken_back = product(turned.transpose(), taken_back.transpose());
    Ok(Some(Seat {
        panels: panels.count,
        padded: panels.padded,
        pressed: panels.pressed,
        gaps: panels.gaps,
        across: panels.stiffness[..panels.padded].to_vec(),
        tension: listed(&tension),
        by_rollers: listed(&by_rollers),
        at_preload: listed(&at_preload),
        stiffness: listed(&loss),
        on_ring: responses.on_ring,
        taken_back: listed(&taken_back),
        at_sensors: responses.at_sensors,
        flexibility: Vec::new(),
    }))
}

/// Displacement of the raceway at each vertex under a unit force there [m/N], beyond the modes, if all
/// springs let go.
pub(crate) fn flexibility(seat: &Seat) -> Vec<f64> {
    let n = 2 * seat.padded;
    let gives: Vec<usize> = (0..n).filter(|at| seat.stiffness[at * n + at] > 0.0).collect();
    let of = |i: usize, j: usize| seat.stiffness[gives[i] * n + gives[j]];
    let vertices = seat.by_rollers.len() / n;
    if gives.is_empty() {
        return vec![0.0; vertices];
    }
    let stiffness = Mat::from_fn(gives.len(), gives.len(), of);
    let pulled = Mat::from_fn(gives.len(), vertices, |i, vertex| seat.by_rollers[vertex * n + gives[i]]);
    let given = stiffness.partial_piv_lu().solve(&pulled);
    let under = |at: usize| (0..gives.len()).map(|i| pulled[(i, at)] * given[(i, at)]).sum();
    (0..vertices).map(under).collect()
}

/// Columns one after the other.
fn listed(of: &Mat<f64>) -> Vec<f64> {
    (0..of.ncols()).flat_map(|j| (0..of.nrows()).map(move |i| of[(i, j)])).collect()
}

impl Tangential {
    fn of(panels: &Panels, responses: &Responses) -> Self {
        let Panels { padded: p, stiffness, .. } = panels;
        let Responses { by_modes, flexibility, by_rollers, .. } = responses;
        let (p, along) = (*p, |i: usize| p + i);
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
        let slides = Mat::from_fn(p, by_modes.ncols(), |i, mode| by_modes[(along(i), mode)]);
        Self {
            coupling: Mat::from_fn(p, p, |i, j| stiffness[i] * flexibility[(i, along(j))]),
            held: product(inverse.as_ref(), slides.as_ref()),
            held_by_rollers: product(inverse.as_ref(), by_rollers.get(p.., ..)),
            inverse,
            slides,
        }
    }

    /// Tension of each spring by a unit force at each vertex of the raceway.
    fn by_rollers(&self, panels: &Panels, responses: &Responses) -> Mat<f64> {
        let Panels { padded: p, stiffness, .. } = panels;
        let by_rollers = &responses.by_rollers;
        let lifted = product(self.coupling.as_ref(), self.held_by_rollers.as_ref());
        Mat::from_fn(2 * p, by_rollers.ncols(), |i, vertex| {
            if i < *p {
                stiffness[i] * by_rollers[(i, vertex)] - lifted[(i, vertex)]
            } else {
                self.held_by_rollers[(i - p, vertex)]
            }
        })
    }

    /// Tension of each spring by a unit of each mode of the sliding seat.
    fn tension(&self, panels: &Panels, responses: &Responses) -> Mat<f64> {
        let Panels { padded: p, stiffness, .. } = panels;
        let by_modes = &responses.by_modes;
        let lifted = product(self.coupling.as_ref(), self.held.as_ref());
        Mat::from_fn(2 * p, by_modes.ncols(), |i, mode| {
            if i < *p {
                stiffness[i] * by_modes[(i, mode)] - lifted[(i, mode)]
            } else {
                self.held[(i - p, mode)]
            }
        })
    }

    /// Loss of tension of each spring by a unit opening or slip of another [N/m].
    fn loss(&self, panels: &Panels, responses: &Responses) -> Mat<f64> {
        let Panels { padded: p, stiffness, .. } = panels;
        let (p, flexibility) = (*p, &responses.flexibility);
        let crossed = product(self.coupling.as_ref(), self.inverse.as_ref());
        let opened = product(crossed.as_ref(), self.coupling.transpose());
        Mat::from_fn(2 * p, 2 * p, |i, j| match (i < p, j < p) {
            (true, true) => {
                let spring = if i == j { stiffness[i] } else { 0.0 };
                spring - stiffness[i] * flexibility[(i, j)] * stiffness[j] + opened[(i, j)]
            }
            (true, false) => -crossed[(i, j - p)],
            (false, true) => -crossed[(j, i - p)],
            (false, false) => self.inverse[(i - p, j - p)],
        })
    }

    /// Turns the modes of the structure into those of a seat that holds; returns them as combinations of the
    /// old ones, in columns.
    fn modes(&self, structure: &mut Structure) -> Result<Mat<f64>, Error> {
        let squares = structure.squares();
        let modes = squares.len();
        let stiffer = product(self.slides.transpose(), self.held.as_ref());
        let matrix =
            Mat::from_fn(modes, modes, |i, j| stiffer[(i, j)] + if i == j { squares[i] } else { 0.0 });
        let eigen = matrix.self_adjoint_eigen(Side::Lower).map_err(|_| Error::NoModes)?;
        let squares: Vec<f64> = (0..modes).map(|i| eigen.S()[i].max(0.0)).collect();
        structure.turn(eigen.U(), squares);
        Ok(eigen.U().to_owned())
    }
}

impl Responses {
    fn of(structure: &mut Structure, parts: &Parts<'_>, panels: &Panels) -> Self {
        let p = panels.padded;
        let modes = structure.squares().len();
        let mut slots: Vec<u32> = parts.springs.iter().flat_map(|s| s.slots.iter().copied()).collect();
        slots.sort_unstable();
        slots.dedup();
        let at_sensors = slots.len();
        let at_raceway = at_sensors + parts.sensors.len();
        let mut index = vec![usize::MAX; parts.x.len()];
        slots.iter().enumerate().for_each(|(i, slot)| index[*slot as usize] = i);
        slots.extend(parts.sensors);
        slots.extend(parts.raceway.iter().map(|node| node.slot));

        let mut all = Self {
            by_modes: Mat::zeros(2 * p, modes),
            flexibility: Mat::zeros(2 * p, 2 * p),
            by_rollers: Mat::zeros(2 * p, parts.raceway.len()),
            on_ring: panels.on_ring(parts),
            at_sensors: vec![vec![[0.0; 2]; 2 * p]; parts.sensors.len()],
        };
        let there: Vec<usize> = (0..2 * p).filter(|at| !panels.members[*at].is_empty()).collect();
        let units: Vec<NodeForces> = there.iter().map(|&at| panels.unit(at, parts.x.len())).collect();
        let responses = structure.residuals(&units, &slots);
        for ((&at, unit), moved) in there.iter().zip(&units).zip(&responses) {
            for (mode, stretch) in structure.generalised(unit, modes).into_iter().enumerate() {
                all.by_modes[(at, mode)] = stretch;
            }
            for (sensor, [x, y]) in all.at_sensors.iter_mut().zip(&moved[at_sensors..]) {
                sensor[at] = [-x, -y];
            }
            for (vertex, (node, [x, y])) in parts.raceway.iter().zip(&moved[at_raceway..]).enumerate() {
                let [nx, ny] = node.normal;
                all.by_rollers[(at, vertex)] = nx * x + ny * y;
            }
            for other in 0..2 * p {
                let stretch = |(slot, [dx, dy]): (u32, [f64; 2])| {
                    let [x, y] = moved[index[slot as usize]];
                    dx * x + dy * y
                };
                all.flexibility[(other, at)] = panels.shares(other).map(stretch).sum();
            }
        }
        all
    }
}

impl Panels {
    fn of(parts: &Parts<'_>) -> Option<Self> {
        let place = |slot: u32| [parts.x[slot as usize], parts.y[slot as usize]];
        let angle_of = |spring: &Spring| {
            let sum = spring.slots.iter().map(|slot| place(*slot));
            let [x, y] = sum.fold([0.0; 2], |[x, y], [px, py]| [x + px, y + py]);
            libm::atan2(y, x)
        };
        let springs: Vec<(&Spring, f64)> =
            parts.springs.iter().map(|spring| (spring, angle_of(spring))).collect();
        // Angles count from the middle of the seat, so that none lies behind a full turn.
        let [sx, sy] = springs.iter().fold([0.0; 2], |[x, y], (_, a)| [x + libm::cos(*a), y + libm::sin(*a)]);
        let middle = libm::atan2(sy, sx);
        let from_middle = |angle: f64| {
            let (s, c) = libm::sincos(angle - middle);
            libm::atan2(s, c)
        };
        let all = springs.iter().map(|(_, angle)| from_middle(*angle));
        let [first, last] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], at| [a.min(at), b.max(at)]);
        let [x, y] = place(*parts.springs.first()?.slots.first()?);
        let width = WIDTH * parts.thickness / libm::hypot(x, y);
        // An odd number of them, counted from the middle: the mirrored seat has mirrored panels.
        let half = (0.5 * (last - first) / width).ceil().clamp(PANELS[0], PANELS[1]);
        let count = 2 * half as usize + 1;
        let panel_of = |angle: f64| {
            let share = (from_middle(angle) - 0.5 * (first + last)) / (last - first).max(f64::MIN_POSITIVE);
            (half + (share * count as f64).round().clamp(-half, half)) as usize
        };
        let padded = count.next_multiple_of(GROUP);
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
        let mut gaps = vec![0.0; padded];
        for ((spring, angle), gap) in springs.iter().zip(parts.gaps) {
            let panel = panel_of(*angle);
            if pressed[panel] == 0.0 {
                gaps[panel] += gap * spring.stiffness / stiffness[panel];
            }
        }
        Some(Self { count, padded, members, stiffness, pressed, gaps })
    }

    /// Slots that a spring reaches, with the forces of a unit stretch's share of the panel.
    fn shares(&self, at: usize) -> impl Iterator<Item = (u32, [f64; 2])> {
        self.members[at].iter().flat_map(move |spring| {
            let share = spring.stiffness / self.stiffness[at];
            let along = spring.direction.chunks_exact(2);
            spring.slots.iter().zip(along).map(move |(slot, d)| (*slot, [share * d[0], share * d[1]]))
        })
    }

    /// Forces that stretch a spring with a unit tension.
    fn unit(&self, at: usize, count: usize) -> NodeForces {
        let mut unit = NodeForces::zeros(count);
        for (slot, [fx, fy]) in self.shares(at) {
            unit.fx[slot as usize] += fx;
            unit.fy[slot as usize] += fy;
        }
        unit
    }

    /// Force on the ring by a unit tension of each spring.
    fn on_ring(&self, parts: &Parts<'_>) -> Vec<[f64; 2]> {
        let of = |at: usize| {
            let of_ring = self.shares(at).filter(|(slot, _)| (parts.of_ring)(*slot));
            of_ring.fold([0.0; 2], |[x, y], (_, [fx, fy])| [x - fx, y - fy])
        };
        (0..2 * self.padded).map(of).collect()
    }
}

/// Force that presses each spring at the preload [N]: that on each node of the ring goes through the springs
/// that reach the node, by their parts of the stiffness there. A panel of whole nodes instead would open too
/// early or too late where its edges lie between them.
fn pressing(parts: &Parts<'_>) -> Vec<f64> {
    let mut inwards = vec![0.0; parts.x.len()];
    for (slot, [fx, fy]) in parts.back {
        let [x, y] = [parts.x[*slot as usize], parts.y[*slot as usize]];
        inwards[*slot as usize] = -(fx * x + fy * y) / libm::hypot(x, y);
    }
    let reach = |spring: &Spring| -> Vec<(usize, f64)> {
        let nodes = spring.slots.iter().zip(spring.direction.chunks_exact(2));
        let parts = nodes.map(|(slot, d)| (*slot as usize, spring.stiffness * libm::hypot(d[0], d[1])));
        parts.filter(|(_, stiffness)| *stiffness > 0.0).collect()
    };
    let mut held = vec![0.0; parts.x.len()];
    let touching = |(spring, gap): (&'_ Spring, &f64)| (*gap == 0.0).then(|| reach(spring));
    for (slot, stiffness) in parts.springs.iter().zip(parts.gaps).filter_map(touching).flatten() {
        held[slot] += stiffness;
    }
    let of = |(spring, gap): (&Spring, &f64)| match *gap {
        0.0 => reach(spring).iter().map(|(slot, k)| inwards[*slot] * k / held[*slot]).sum(),
        _ => 0.0,
    };
    parts.springs.iter().zip(parts.gaps).map(of).collect()
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

    /// A ring's back on springs alike, three points a facet, that a pressure alike presses: wherever the
    /// edges of panels lie between nodes, all of them are pressed as hard for their stiffness, but for the
    /// two at the ends, whose last nodes have half a facet each.
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
                gaps: &vec![0.0; springs.len()],
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
