//! The reduced bearing: what stays the same during a run, and the forces that follow from a state (THEORY §9.2–9.4).

use stribeck_bearing::recorder::Tacho;
use stribeck_mesh::{Circle, FormDeviation};
use stribeck_scene::{
    deviation::Relief,
    duty::Duty,
    geometry::Geometry,
    kinematics::Kinematics,
    scene::{ContactSurface, DampingFrame, RollerCopies, Scene},
};
use stribeck_simd::lanes::{LANES, Number};
use stribeck_solver::structural_damping::{Branch, StructuralDamping};
use stribeck_surface::Law;

use crate::{
    cage::Cage,
    compliance::{Compliance, Curve, contact_length},
    error::Error,
    oil::Lubrication,
    outline::Outline,
    overlap::Sides,
    polygon::Polygon,
    reduction::{OVERLOAD, Reduction},
    row::{Row, Single, in_single, largest_of},
    seat::{STICKING, Springs},
    sensors::Sensors,
    state::State,
};

/// What does not change during a run.
#[derive(Debug, Clone)]
pub struct Bearing {
    /// Time step [s].
    pub time_step: f64,
    /// Rollers.
    pub rollers: usize,
    /// The pocket of each of them, from 0.
    pub(crate) pockets: Vec<usize>,
    /// The reduced rings.
    pub reduction: Reduction,
    /// Their shapes at the vertices of the outer raceway again, in rows.
    pub(crate) shapes: Vec<Single>,
    /// Largest displacement of any of these vertices by a unit of each mode [1/√kg].
    pub(crate) farthest: Vec<Row>,
    /// What sensors hear.
    pub(crate) sensors: Sensors,
    /// Dampers of the housing, in rows: what a unit velocity of each mode makes of every mode; empty without dampers.
    pub(crate) dampers: Vec<Row>,
    /// Contact with the outer raceway.
    pub(crate) outer: Track,
    /// Contact with the inner raceway.
    pub(crate) inner: Track,
    /// Rims of rollers: the round one first, then those that are not round.
    pub(crate) rims: Vec<Rim>,
    /// The round one as the cage meets it.
    pub(crate) polygon: Polygon,
    /// Which of them each roller has.
    pub(crate) rim_of: Vec<u32>,
    /// Angle of vertex 0 of each roller at the start [rad].
    pub(crate) vertex_angle: Vec<f64>,
    /// Normal and tangential stiffness and damping a metre of contact: [N/m²], [N/m²], [N s/m²].
    pub(crate) penalty: f64,
    pub(crate) sticking: f64,
    pub(crate) damping: f64,
    pub(crate) friction: f64,
    /// Radius at which friction acts [m].
    pub(crate) arm: f64,
    /// Mass damping of rollers and of the modes [1/s], and its frame.
    pub(crate) alpha: f64,
    pub(crate) mode_alpha: f64,
    pub(crate) frame: DampingFrame,
    /// Stiffness damping β [s].
    pub(crate) beta: f64,
    /// Branches of the structural damping of outer ring and adapter.
    pub(crate) branches: Vec<Branch>,
    pub(crate) gravity: f64,
    pub(crate) kinematics: Kinematics,
    /// Whether the outer ring turns.
    pub(crate) outer_turns: bool,
    pub(crate) cage: Option<Cage>,
    /// Seat of the outer ring, where it may open and slip.
    pub(crate) seat: Option<Springs>,
    /// Oil between rollers and raceways.
    pub(crate) oil: Option<Lubrication>,
    /// Speeds and load, where they change.
    pub(crate) duty: Option<Duty>,
    pub(crate) tacho: Tacho,
}

/// The rim of a roller.
#[derive(Debug, Clone)]
pub(crate) struct Rim {
    pub(crate) outline: Outline,
    /// Radius of the circle around it [m].
    pub(crate) top: f64,
}

/// One raceway.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    pub(crate) outline: Outline,
    /// One over the angle that each facet takes [1/rad]; 0 for walls.
    pub(crate) angle: Vec<f64>,
    pub(crate) sides: Sides,
    pub(crate) compliance: Compliance,
    pub(crate) curve: Curve,
    /// Circle that nothing of the raceway stands out from towards the rollers [m]; for the outer one within, for the inner
    /// one around.
    pub(crate) bound: f64,
    /// The same of what is near each facet [m]; of the outer one, which is bent by its load. Empty for the inner one.
    pub(crate) bounds: Vec<f64>,
    /// Largest relative radius [m].
    pub(crate) relative: f64,
}

impl Track {
    /// +1 where the raceway lies beyond the roller, seen from the bearing's centre, −1 where it lies before it.
    #[inline(always)]
    pub(crate) fn outwards(&self) -> f64 {
        if self.sides.along { 1.0 } else { -1.0 }
    }

    /// How far from its middle a contact may reach that is `depth` deep between the circles around both [m].
    #[inline(always)]
    pub(crate) fn reach<N: Number>(&self, depth: N) -> N {
        (depth.constant(2.0 * self.relative) * depth).sqrt() * depth.constant(1.001)
    }
}

impl Bearing {
    /// The bearing of a scene whose rings have been reduced.
    ///
    /// # Errors
    /// When the structural damping cannot be fitted.
    pub fn new(scene: &Scene, reduction: Reduction, time_step: f64) -> Result<Self, Error> {
        let g = Geometry::of(scene);
        let [outer, inner, roller] = reduction.outlines();
        let outer = formed(&outer, g.outer_relief.as_ref(), Circle::Inner);
        let inner = formed(&inner, g.inner_relief.as_ref(), Circle::Outer);
        let arcs = scene.contact.surface != ContactSurface::Facet;
        let law = Law::penalty(g.penalty_stiffness)
            .and_then(|law| law.with_damping(scene.contact.damping_ratio, g.contact_layer_mass));
        let law = law?;
        let radius = g.roller_radius;
        let n = roller.len() as f64;
        let sag = |radius: f64, facets: f64| {
            if arcs { 0.0 } else { radius * (1.0 - (std::f64::consts::PI / facets).cos()) }
        };
        let [kr, ko, ki] = [1.0 / radius, 1.0 / g.outer_race_radius, 1.0 / g.inner_race_radius];
        let sides = |along: bool, relative: f64| Sides {
            along,
            bulge: if arcs { 0.5 * relative } else { 0.0 },
            curvature: if arcs { kr } else { 0.0 },
        };
        let radii = |outline: &Outline| {
            outline.x.iter().zip(&outline.y).map(|(x, y)| x.hypot(*y)).collect::<Vec<f64>>()
        };
        let sag_of_outer = sag(g.outer_race_radius, outer.len() as f64);
        let nearest = radii(&outer).into_iter().fold(f64::INFINITY, f64::min) - sag_of_outer;
        let farthest = radii(&inner).into_iter().fold(0.0, f64::max);
        let track =
            |outline: Outline, along: bool, compliance: &Compliance, bound: f64, relative: f64| Track {
                sides: sides(along, relative),
                angle: per_angle(&outline),
                outline,
                curve: compliance.curve(),
                compliance: compliance.clone(),
                bound,
                bounds: Vec::new(),
                relative: 1.0 / relative,
            };
        let pockets: Vec<usize> = scene.rollers_in_place().map(|number| number - 1).collect();
        let vertex_angle: Vec<f64> = pockets
            .iter()
            .map(|&pocket| match scene.mesh.roller_copies {
                RollerCopies::Translated => g.roller_phase,
                RollerCopies::Rotated => g.roller_angle(pocket) + g.roller_phase,
            })
            .collect();
        // Vertex 0 of the outline lies on the x axis.
        let round = Rim { top: roller.x[0], outline: roller.clone() };
        let (mut rims, mut rim_of) = (vec![round], vec![0; pockets.len()]);
        for (of, relief) in &g.roller_reliefs {
            let Some(i) = pockets.iter().position(|pocket| pocket == of) else { continue };
            // A rim is seen from its vertex 0.
            let own = formed(&roller, Some(&relief.turned(-vertex_angle[i])), Circle::Outer);
            rim_of[i] = rims.len() as u32;
            rims.push(Rim { top: radii(&own).into_iter().fold(0.0, f64::max), outline: own });
        }
        let branches = match (&scene.solver.structural_damping, g.structural_damping) {
            (Some(chosen), Some(band)) => {
                StructuralDamping::over_band(band.ratio, band.band, chosen.branches, Vec::new())?
                    .branches()
                    .to_vec()
            }
            _ => Vec::new(),
        };
        let cage = reduction.cage.map(|(inertia, centre)| {
            Cage::new(&g, &pockets, inertia, centre, &reduction.wall_compliance, scene)
        });
        let kinematics = Kinematics::of(scene);
        let mut reduction = reduction;
        let angles = per_angle(&outer);
        level_walls(&mut reduction.shapes, &angles);
        reduction.springs.iter_mut().for_each(|seat| level_walls(&mut seat.by_rollers, &angles));
        let frame = scene.solver.damping_frame;
        let alpha = scene.solver.mass_damping_per_s;
        // As in the full model, what moves as one piece is not damped by its mass.
        let undamped = frame == DampingFrame::RigidMotion || scene.housing.is_rigid();
        let mode_alpha = if undamped { 0.0 } else { alpha };
        if let Some(frame) = &reduction.frame {
            for shape in frame.shape.chunks_exact(reduction.padded) {
                for (row, a) in reduction.dampers.chunks_exact_mut(reduction.padded).zip(shape) {
                    row.iter_mut().zip(shape).for_each(|(sum, b)| *sum -= mode_alpha * frame.mass * a * b);
                }
            }
        }
        let dampers = reduction.dampers.as_chunks::<LANES>().0.iter().copied().map(Row).collect();
        let shapes = in_single(&mut reduction.shapes);
        let bounds = nearest_about(&outer, BESIDE * radius, 1.0 / (kr - ko));
        let bounds = bounds.into_iter().map(|near| near - sag_of_outer).collect();
        let mut outer = track(outer, true, &reduction.outer_compliance, nearest, kr - ko);
        outer.bounds = bounds;
        let inner = track(inner, false, &reduction.inner_compliance, farthest, kr + ki);
        let penalty = law.stiffness * g.thickness;
        let rounded: Vec<&Outline> = rims.iter().map(|rim| &rim.outline).collect();
        let raceways = [&outer, &inner].map(|track| (&track.outline, &track.compliance));
        let oil = Lubrication::new(scene, raceways, &rounded, penalty)?;
        let seat = reduction.springs.as_mut();
        let friction = scene.contact.seat_friction;
        let seat = seat.map(|seat| Springs::new(seat, reduction.padded, friction, time_step));
        Ok(Self {
            time_step,
            seat,
            rollers: pockets.len(),
            pockets,
            oil,
            outer,
            inner,
            vertex_angle,
            penalty,
            sticking: STICKING * law.stiffness * g.thickness,
            damping: law.damping * g.thickness,
            friction: scene.contact.friction,
            arm: radius - 2.0 / 3.0 * sag(radius, n),
            alpha,
            mode_alpha,
            frame,
            beta: g.stiffness_damping,
            branches,
            gravity: g.gravity,
            outer_turns: scene.operation.outer_turns(),
            kinematics,
            duty: scene.varying_duty(),
            tacho: Tacho::of(scene),
            cage: cage.flatten(),
            polygon: Polygon::new(rims[0].outline.len(), rims[0].top),
            rims,
            rim_of,
            shapes,
            farthest: largest_of::<2>(&reduction.shapes, reduction.padded),
            sensors: Sensors::new(&reduction),
            dampers,
            reduction,
        })
    }

    /// Critical time step [s] of modes, contacts and springs of friction (own; THEORY §9.4): contacts with raceways as stiff as at the
    /// largest load that the local problem was solved for, friction over those of the fullest roller, and the cage on corners
    /// of all pockets, or on straight walls that lie flush with a facet of each roller.
    pub fn critical_time_step(&self) -> f64 {
        let highest = self.reduction.squares.iter().copied().fold(0.0, f64::max);
        let [mass, inertia] = self.reduction.roller_inertia;
        let r = self.reduction.padded;
        let both = [&self.outer, &self.inner];
        let [outer, inner] = both.map(|track| track.compliance.stiffest(self.penalty, track.relative));
        let along = |track: &Track| {
            let fullest = track.compliance.largest_load() / OVERLOAD;
            let stiffness = self.sticking * contact_length(fullest, self.penalty, track.relative);
            if self.friction > 0.0 { stiffness } else { 0.0 }
        };
        let [along_outer, along_inner] = both.map(along);
        // A contact pulls on the roller and on the modes under it; (a − b)² ≤ (1 + c) a² + (1 + 1/c) b².
        let under = |vertex: usize| {
            let shape = &self.reduction.shapes[2 * r * vertex..2 * r * (vertex + 1)];
            (0..r).map(|k| shape[k] * shape[k] + shape[r + k] * shape[r + k]).sum::<f64>()
        };
        let modes = (0..self.outer.outline.len()).map(under).fold(0.0, f64::max);
        let c = (modes * mass).sqrt();
        let of_roller = ((1.0 + c) * outer + inner) / mass;
        // Both raceways hold a roller along the track: one way if it spins, the other if it moves on.
        let of_friction = 2.0
            * ((1.0 + c) * along_outer).max(along_inner)
            * (1.0 / mass).max(self.arm * self.arm / inertia);
        // Few rollers share the modes of highest participation; each adds its own part.
        let of_modes = highest + (1.0 + 1.0 / c) * outer.max(along_outer) * modes;
        // All rollers may press on the cage at once.
        let of_cage = self.cage.as_ref().map_or(0.0, |cage| {
            let arm = cage
                .walls
                .iter()
                .flatten()
                .map(|wall| wall.inner[0].hypot(wall.inner[1]))
                .fold(0.0, f64::max);
            let of_all = self.rollers as f64 * (1.0 / cage.mass).max(arm * arm / cage.inertia);
            let corner = 0.5 * self.penalty * cage.corners[0].end;
            let facet = if cage.has_flats { self.penalty * self.polygon.facet() } else { 0.0 };
            let facet = facet / (1.0 + facet * cage.curve.approach(0.0).0[1]);
            corner.max(facet) * (1.0 / mass + of_all)
        });
        let square = of_roller.max(of_friction).max(of_modes).max(of_cage);
        // Dampers act half a step late: ω² Δt²/4 + d Δt/2 < 1, where d is the sum over all modes at most.
        let d = self.reduction.dampers.iter().step_by(r + 1).sum::<f64>().max(0.0);
        2.0 * ((0.25 * d * d + square).sqrt() - 0.5 * d) / square
    }

    /// The rim of a roller, from 0.
    #[inline(always)]
    pub(crate) fn rim(&self, roller: usize) -> &Rim {
        &self.rims[self.rim_of[roller] as usize]
    }

    /// A state before its first step, not in equilibrium yet.
    pub fn rest(&self, scene: &Scene) -> State {
        let g = Geometry::of(scene);
        let path = g.outer_race_radius - g.roller_radius;
        let k = &self.kinematics;
        let r = self.reduction.padded;
        let n = self.rollers;
        let mut state = State {
            q: vec![0.0; r],
            v: vec![0.0; r],
            branches: vec![vec![0.0; r]; self.branches.len()],
            x: vec![0.0; n],
            y: vec![0.0; n],
            vx: vec![0.0; n],
            vy: vec![0.0; n],
            angle: vec![0.0; n],
            turned: self.vertex_angle.iter().map(|angle| [angle.cos(), angle.sin()]).collect(),
            spin: vec![k.roller_rad_s; n],
            slip: [vec![0.0; n], vec![0.0; n]],
            wall_slip: vec![[0.0; 2]; n],
            passive: [vec![[0.0; 3]; n], vec![[0.0; 3]; n]],
            wall_passive: vec![[[0.0; 2]; 2]; n],
            force: [vec![0.0; n], vec![0.0; n]],
            growth: [vec![0.0; n], vec![0.0; n]],
            hints: [vec![[0; 2]; n], vec![[0; 2]; n]],
            cage: [0.0; 3],
            cage_velocity: [0.0, 0.0, k.cage_rad_s],
            shaft: 0.0,
            work: Default::default(),
            seat: None,
            films: None,
            steps: 0,
        };
        for (i, &pocket) in self.pockets.iter().enumerate() {
            let (s, c) = g.roller_angle(pocket).sin_cos();
            (state.x[i], state.y[i]) = (path * c, path * s);
        }
        state.seat = self.seat.as_ref().map(|seat| seat.at_rest(r, n));
        state.hints = self.first_hints(&state);
        state.films = self.first_films(&state);
        state
    }

    /// Facets that rays hit, found from nothing.
    pub(crate) fn first_hints(&self, state: &State) -> [Vec<[u32; 2]>; 2] {
        let nearest = |outline: &Outline, d: [f64; 2]| {
            let along = |i: &usize| {
                (outline.x[*i] * d[0] + outline.y[*i] * d[1]) / outline.x[*i].hypot(outline.y[*i])
            };
            (0..outline.len()).max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0) as u32
        };
        let hints = |track: &Track, turned: f64, outwards: f64| {
            (0..state.x.len())
                .map(|i| {
                    let at = state.y[i].atan2(state.x[i]);
                    let own = at - state.angle[i] - self.vertex_angle[i]
                        + if outwards < 0.0 { std::f64::consts::PI } else { 0.0 };
                    let on_race = at - turned;
                    let of = |angle: f64| [angle.cos(), angle.sin()];
                    [nearest(&self.rim(i).outline, of(own)), nearest(&track.outline, of(on_race))]
                })
                .collect()
        };
        [hints(&self.outer, 0.0, 1.0), hints(&self.inner, state.shaft, -1.0)]
    }
}

/// A boundary with what deviates from round.
fn formed(outline: &Outline, relief: Option<&Relief>, circle: Circle) -> Outline {
    let Some(relief) = relief else { return outline.clone() };
    let mut vertices: Vec<[f64; 2]> = outline.x.iter().zip(&outline.y).map(|(x, y)| [*x, *y]).collect();
    let (depth, corners) = (|angle: f64| relief.depth(angle), relief.corners());
    FormDeviation { depth: &depth, corners: &corners, circle }.of_polygon(&mut vertices);
    Outline::new(&vertices)
}

/// Gives both ends of a wall the mean of what belongs to them, vertex by vertex: a roller that passes over it has no height to tell them
/// apart by.
fn level_walls(of_vertices: &mut [f64], per_angle: &[f64]) {
    let n = per_angle.len();
    let width = of_vertices.len() / n;
    for (a, _) in per_angle.iter().enumerate().filter(|(_, angle)| **angle == 0.0) {
        let b = (a + 1) % n;
        for k in 0..width {
            let mean = 0.5 * (of_vertices[a * width + k] + of_vertices[b * width + k]);
            (of_vertices[a * width + k], of_vertices[b * width + k]) = (mean, mean);
        }
    }
}

/// A facet that takes less than this share of the mean angle is a wall.
const WALL: f64 = 0.05;

/// On even ground no contact reaches farther to either side than this share of the roller's radius: it would be a fortieth of it deep.
const BESIDE: f64 = 0.25;

/// For every facet, how near to the origin an outline comes where a roller over that facet may touch it [m]: as far to either side as a
/// contact on even ground, and beyond that at what stands out so far that the roller, which falls away by u² / 2R over u, meets it, such
/// as the edge of a deep spall. `relative` is R [m].
fn nearest_about(outline: &Outline, beside: f64, relative: f64) -> Vec<f64> {
    let place = |i: usize| [outline.x[i], outline.y[i]];
    let apart = |[ax, ay]: [f64; 2], [bx, by]: [f64; 2]| (bx - ax).hypot(by - ay);
    let out = |i: usize| apart([0.0; 2], place(i));
    let reach = |stands_out: f64| (beside * beside + 2.0 * relative * stands_out.max(0.0)).sqrt();
    let nearest_of_all = (0..outline.len()).map(out).fold(f64::INFINITY, f64::min);
    let about = |facet: usize| {
        let mut nearest = f64::INFINITY;
        let ends = [facet, outline.next(facet)];
        let here = out(ends[0]).max(out(ends[1]));
        for (end, ahead) in ends.into_iter().zip([false, true]) {
            let mut vertex = end;
            let mut within = true;
            for _ in 0..outline.len() {
                let away = apart(place(end), place(vertex));
                // The first vertex beyond is taken, too: the facet before it is within.
                if within || away <= reach(here - out(vertex)) {
                    nearest = nearest.min(out(vertex));
                }
                within = away <= beside;
                if away > reach(here - nearest_of_all) {
                    break;
                }
                vertex = if ahead { outline.next(vertex) } else { outline.before(vertex) };
            }
        }
        nearest
    };
    (0..outline.len()).map(about).collect()
}

/// One over the angle that each facet takes, seen from the origin [1/rad]; 0 for walls.
fn per_angle(outline: &Outline) -> Vec<f64> {
    let n = outline.len();
    (0..n)
        .map(|i| {
            let j = (i + 1) % n;
            let sine = outline.x[i] * outline.y[j] - outline.y[i] * outline.x[j];
            let cosine = outline.x[i] * outline.x[j] + outline.y[i] * outline.y[j];
            let angle = sine.atan2(cosine);
            if angle > WALL * std::f64::consts::TAU / n as f64 { 1.0 / angle } else { 0.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use stribeck_testing::ledger::compare;

    use super::*;

    /// A ring of the mass m in a frame of M on soft springs, which bounce against each other: α brakes the ring alone and takes α M/(m + M)
    /// of such a motion's momentum a second. In a rigid housing it takes nothing. With the housing's mass braked, too, the paper's ring in
    /// one of 10 kg had 25 dB too little where it bounces on its rollers.
    /// Source: two masses on a spring, Meirovitch 2001, §5.1.
    #[test]
    fn analytic_mass_damping_brakes_no_frame() {
        const TOLERANCE: f64 = 0.01;
        let of = |housing: &str| {
            let text = format!(
                "(bearing: \"NU 205\", model: reduced(modes_khz: 30), film: None, defect: None, operation: (load_n: 100), housing: {housing},
                  mesh: (size_mm: 0.7, roller_facets: 64), solver: (mass_damping_per_s: 2000, structural_damping: None))"
            );
            let scene = Scene::parse(&text, "here").expect("a sound scene");
            let reduction = Reduction::new(&scene).expect("modes");
            Bearing::new(&scene, reduction, 1e-6).expect("a bearing")
        };
        let frame = 1.5;
        let bearing = of("springs(stiffness_n_um: 1, damping_n_s_m: 0, mass_kg: 1.5)");
        let reduction = &bearing.reduction;
        let ring = reduction.structure_mass - frame;
        let hz = (1e6 * (1.0 / ring + 1.0 / frame)).sqrt() / std::f64::consts::TAU;
        let bounces = |n: &usize| {
            (reduction.squares[*n].max(0.0).sqrt() / std::f64::consts::TAU / hz - 1.0).abs() < 0.05
        };
        // The third turns them against each other.
        for n in (0..reduction.modes).filter(bounces).take(2) {
            let braked = bearing.mode_alpha + reduction.dampers[n * reduction.padded + n];
            let expected = 2000.0 * frame / (ring + frame);
            compare(
                "mass damping of a ring in its frame",
                "two masses on a spring, Meirovitch 2001, §5.1",
                "1/s",
                braked,
                expected,
                TOLERANCE,
            );
        }
        assert_eq!(of("rigid(mass_kg: 10)").mode_alpha, 0.0);
    }
}
