//! Compliances beside the contacts: flexibilities of patches of each surface, and the local problems through
//! them (THEORY §9.3).

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};
use stribeck_reduced::modal::{OVERLOAD, compliance::Compliance};
use stribeck_scene::resolved::{DefectGeometry, ResolvedScene};
use stribeck_solver::{Dynamics, statics::Modes, statics::SmallMotions};
use stribeck_theory::contact_law::{ContactLaw, ContactLawKind};

use crate::error::Error;
use crate::reduction::{
    direction,
    extraction::Extraction,
    local_contact::LocalContact,
    structure::{SHIFT, Structure, flexibility},
};

/// Loads at which the local contact problem is solved, and knots of the curve through them.
const LOADS: usize = 14;
const KNOTS: usize = 48;

/// Compliances of a roller on the outer raceway, on the inner one, and on a wall of the cage.
pub(crate) struct Compliances {
    pub(crate) outer: Compliance,
    pub(crate) inner: Compliance,
    pub(crate) wall: Compliance,
}

/// The size of the local problems.
struct Size<'a> {
    scene: &'a ResolvedScene,
    /// Largest load [N].
    most: f64,
}

impl Size<'_> {
    /// Nodes to either side of the middle that a contact may reach, on nodes so far apart [m], at a relative
    /// radius [m].
    fn half_count(&self, radius: f64, spacing: f64) -> usize {
        let scene = self.scene;
        let e_star = scene.material.youngs_modulus / (2.0 * (1.0 - scene.material.poissons_ratio.powi(2)));
        let q = self.most / scene.thickness;
        let hertz = 4.0 * q * radius / (PI * e_star);
        let winkler = libm::pow(1.5 * q * radius / scene.penalty_stiffness, 2.0 / 3.0);
        (1.3 * (hertz + winkler).sqrt() / spacing).ceil() as usize + 2
    }
}

/// A surface's own flexibility [m/N] about a place, and how far apart its nodes are there [m].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Patch {
    flexibility: Vec<Vec<f64>>,
    spacing: f64,
}

impl Patch {
    /// The part of it that a contact with this relative radius [m] may reach.
    fn within(&self, size: &Size<'_>, radius: f64) -> Vec<Vec<f64>> {
        let middle = self.flexibility.len() / 2;
        let half = size.half_count(radius, self.spacing).min(middle);
        let reached = middle - half..=middle + half;
        self.flexibility[reached.clone()].iter().map(|row| row[reached.clone()].to_vec()).collect()
    }
}

/// Patches of both raceways and of a roller: they depend on no load, up to the one that they are wide enough for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Patches {
    outer: Patch,
    inner: Patch,
    roller: Patch,
    /// Deflection of a roller by an equal force on its other side [m/N].
    across: f64,
}

impl<'a> Size<'a> {
    fn of(scene: &'a ResolvedScene) -> Self {
        let load = scene.written.operation.load_n;
        let most = OVERLOAD * scene.static_load().map_or(load, |load| load.max_roller_n());
        Self { scene, most: most.clamp(1.0, OVERLOAD * load.max(1.0)) }
    }

    /// Relative radius of the widest contact of a roller [m].
    fn widest(&self) -> f64 {
        self.scene.outer_contact_radius().max(self.scene.inner_contact_radius())
    }
}

impl Patches {
    /// Of a bearing taken apart, beside the vertices of its outer raceway [m].
    pub(crate) fn of(
        scene: &ResolvedScene,
        extraction: &Extraction,
        dynamics: &Dynamics,
        structure: &mut Structure,
        raceway: &[[f64; 2]],
    ) -> Result<Self, Error> {
        let size = Size::of(scene);
        let beside = beside_grooves(scene);
        let outer = outer_patch(&size, extraction, structure, raceway, beside);
        let inner = inner_patch(&size, extraction, dynamics, beside)?;
        let (roller, across) = roller_patch(&size, extraction, dynamics)?;
        Ok(Self { outer, inner, roller, across })
    }

    /// The compliances of a scene with these bodies, up to its own loads.
    pub(crate) fn compliances(&self, scene: &ResolvedScene) -> Compliances {
        let size = Size::of(scene);
        let [ro, ri] = [scene.outer_contact_radius(), scene.inner_contact_radius()];
        let penalty = scene.penalty_stiffness * scene.thickness;
        // The penalty of balls takes nearly all of the approach, others about half of it.
        let beyond_rigid = if scene.contact_law == ContactLawKind::Ball { 1.25 } else { 2.0 };
        let roller = self.roller.within(&size, size.widest());
        let compliance =
            |on: &[Vec<f64>], spacing: f64, radius: f64, across: f64, more: &dyn Fn(f64) -> f64| {
                let flexibility = [on, &roller[..]];
                let pressed =
                    LocalContact { spacing: [spacing, self.roller.spacing], flexibility, radius, penalty };
                curve(&pressed, (size.most, beyond_rigid), across, more)
            };
        let beyond = beyond_lines(scene);
        let raceway = |patch: &Patch, radius: f64, side: usize| {
            let reached = patch.within(&size, radius);
            compliance(&reached, patch.spacing, radius, self.across, &|force| beyond(side, force))
        };
        let rigid = vec![vec![0.0; roller.len()]; roller.len()];
        Compliances {
            outer: raceway(&self.outer, ro, 0),
            inner: raceway(&self.inner, ri, 1),
            // Only its inertia holds the roller on its other side.
            wall: compliance(&rigid, self.roller.spacing, scene.roller_radius, 0.0, &|_| 0.0),
        }
    }
}

/// Approach by which balls, touching in points, and relieved rollers give way more than the lines that are meshed
/// [m], at the outer and the inner contact, over the force [N]; nothing for straight rollers.
fn beyond_lines(scene: &ResolvedScene) -> impl Fn(usize, f64) -> f64 {
    let is_line = scene.contact_law == ContactLawKind::Line;
    let law = (!is_line).then(|| ContactLaw::of(scene, scene.contact_law));
    let (meshed, facet, stiffness) = (scene.meshed_contacts(), scene.element_size, scene.penalty_stiffness);
    let thickness = scene.thickness;
    move |side, force| {
        let on_mesh = || meshed.approach_on_mesh(side, force / thickness, facet, stiffness);
        law.map_or(0.0, |law| law.approach(side, force).0 - on_mesh())
    }
}

/// Angle of a place beside a groove, or between two, that is far from all of them; without grooves that of
/// the load [rad].
fn beside_grooves(scene: &ResolvedScene) -> f64 {
    let beside_of = |d: &DefectGeometry| {
        d.angle + (0.5 * d.length + 2.0 * scene.outer_ring_thickness) / scene.outer_race_radius
    };
    let room = |at: f64| {
        let apart = |d: &DefectGeometry| (at - d.angle + PI).rem_euclid(TAU) - PI;
        scene
            .grooves
            .iter()
            .map(|d| apart(d).abs() - 0.5 * d.length / scene.outer_race_radius)
            .fold(PI, f64::min)
    };
    let between = scene.grooves.windows(2).map(|d| 0.5 * (d[0].angle + d[1].angle));
    let places = scene.grooves.iter().map(beside_of).chain(between);
    let beside = places.max_by(|a, b| room(*a).total_cmp(&room(*b)));
    beside.unwrap_or(scene.written.load_zone_deg().to_radians())
}

/// The vertex that lies nearest to an angle.
fn vertex_at(outline: &[[f64; 2]], angle: f64) -> usize {
    let (s, c) = libm::sincos(angle);
    let along = |p: &[f64; 2]| direction(*p)[0] * c + direction(*p)[1] * s;
    (0..outline.len()).max_by(|&a, &b| along(&outline[a]).total_cmp(&along(&outline[b]))).unwrap_or(0)
}

/// Length of the facet behind a vertex [m].
fn facet(outline: &[[f64; 2]], at: usize) -> f64 {
    let [a, b] = [outline[at], outline[(at + 1) % outline.len()]];
    libm::hypot(b[0] - a[0], b[1] - a[1])
}

/// Nodes from `half` before to `half` behind one of a closed surface.
fn patch(surface: &[u32], at: usize, half: usize) -> Vec<u32> {
    let n = surface.len();
    (0..=2 * half).map(|i| surface[(at + n + i - half % n) % n]).collect()
}

fn outer_patch(
    size: &Size<'_>,
    extraction: &Extraction,
    structure: &mut Structure,
    raceway: &[[f64; 2]],
    angle: f64,
) -> Patch {
    let at = vertex_at(raceway, angle);
    let spacing = facet(raceway, at);
    let half = size.half_count(size.scene.outer_contact_radius(), spacing);
    let nodes = patch(&extraction.nodes.outer, at, half);
    let outwards = |n| direction(extraction.place(n));
    Patch { flexibility: structure.flexibility(&nodes, &|n| extraction.slot(n), &outwards), spacing }
}

fn inner_patch(
    size: &Size<'_>,
    extraction: &Extraction,
    dynamics: &Dynamics,
    angle: f64,
) -> Result<Patch, Error> {
    let nodes = &extraction.nodes;
    let place = |slot: u32| [dynamics.state.x[slot as usize], dynamics.state.y[slot as usize]];
    let inner: Vec<[f64; 2]> = nodes.inner.iter().map(|&n| place(extraction.slot(n))).collect();
    let mut motions = SmallMotions::new(dynamics, &extraction.slots(&nodes.inner_ring), &[], SHIFT)?;
    let at = vertex_at(&inner, angle);
    let spacing = facet(&inner, at);
    let inwards = |n: u32| {
        let [x, y] = direction(extraction.place(n));
        [-x, -y]
    };
    let half = size.half_count(size.scene.inner_contact_radius(), spacing);
    let nodes = patch(&nodes.inner, at, half);
    let flexibility = flexibility(&mut motions, None, &nodes, &|n| extraction.slot(n), &inwards);
    Ok(Patch { flexibility, spacing })
}

/// The rim of a roller, and its deflection by an equal force on its other side [m/N].
fn roller_patch(
    size: &Size<'_>,
    extraction: &Extraction,
    dynamics: &Dynamics,
) -> Result<(Patch, f64), Error> {
    let nodes = &extraction.nodes;
    let slots = extraction.slots(&nodes.roller);
    let mut motions = SmallMotions::new(dynamics, &slots, &[], SHIFT)?;
    let rigid = rigid_modes(dynamics, &motions, &slots);
    let centre = extraction.roller_centre;
    let to_centre = |n: u32| {
        let [x, y] = extraction.place(n);
        direction([centre[0] - x, centre[1] - y])
    };
    let spacing = TAU * size.scene.roller_radius / nodes.rim.len() as f64;
    let mut own = patch(&nodes.rim, 0, size.half_count(size.widest(), spacing));
    let middle = own.len();
    // The node on the other side comes last.
    own.push(nodes.rim[nodes.rim.len() / 2]);
    let all = flexibility(&mut motions, Some(&rigid), &own, &|n| extraction.slot(n), &to_centre);
    let across = all[middle / 2][middle];
    let flexibility = all[..middle].iter().map(|row| row[..middle].to_vec()).collect();
    Ok((Patch { flexibility, spacing }, across))
}

/// Translations and rotation of a free body, with φᵀMφ = 1.
fn rigid_modes(d: &Dynamics, motions: &SmallMotions, slots: &[u32]) -> Modes {
    let motion = d.rigid_motion(slots);
    let shape = |of: &dyn Fn([f64; 2]) -> [f64; 2], inertia: f64| {
        let mut shape = vec![0.0; motions.equations()];
        for &slot in slots {
            let n = slot as usize;
            let [x, y] = of([d.state.x[n] - motion.centre[0], d.state.y[n] - motion.centre[1]]);
            if let Some(at) = motions.equation(slot) {
                (shape[at], shape[at + 1]) = (x / inertia.sqrt(), y / inertia.sqrt());
            }
        }
        shape
    };
    let shapes = vec![
        shape(&|_| [1.0, 0.0], motion.mass),
        shape(&|_| [0.0, 1.0], motion.mass),
        shape(&|[x, y]| [-y, x], motion.inertia),
    ];
    Modes { squares: vec![0.0; 3], shapes }
}

/// Solves the local contact problem at several loads up to `most` [N], which takes `beyond_rigid` times the approach
/// of rigid surfaces or more; `across` is the deflection of a roller by an equal force on its other side [m/N],
/// `more` what the contact gives way beside [m].
fn curve(
    pressed: &LocalContact<'_>,
    (most, beyond_rigid): (f64, f64),
    across: f64,
    more: &dyn Fn(f64) -> f64,
) -> Compliance {
    // Nodes of both surfaces lie anyhow to each other under a contact; a few cases stand for all.
    let phases = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5]];
    let mean = |delta: f64| {
        phases.iter().map(|&phase| pressed.force(delta, phase)).sum::<f64>() / phases.len() as f64
    };
    let mut deepest = beyond_rigid * pressed.rigid(most);
    for _ in 0..20 {
        if mean(deepest) >= most {
            break;
        }
        deepest *= 1.4;
    }
    let (mut loads, mut approaches) = (Vec::new(), Vec::new());
    for i in 1..=LOADS {
        // Denser at light loads.
        let delta = deepest * (i as f64 / LOADS as f64).powi(2);
        let force = mean(delta);
        loads.push(force);
        approaches.push(delta - pressed.rigid(force) + across * force + more(force));
    }
    Compliance::through(&loads, &approaches, KNOTS)
}
