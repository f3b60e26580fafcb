//! The assembled bodies in motion: contact pairs, oil, load and springs around them.

use std::ops::Range;

use stribeck_contact::{Law, Method, Oil, Sides, Smoothing};
use stribeck_mesh::Surface;
use stribeck_scene::{
    housing::HousingScene,
    resolved::ResolvedScene,
    scene::{ContactInterpolation, ContactMethod, ContactPasses, ContactSurface},
};
use stribeck_system::{Film, Pair, Plan, System};
use stribeck_theory::duty::Duty;

use super::{Assembly, surface};
use crate::bearing::{housing::seat_is_round, suspension::suspend};
use crate::error::Error;

/// Integration points on a facet of the outer ring's seat: two conforming surfaces need fewer than a line
/// contact.
const SEAT_POINTS: usize = 2;

/// Names of the contact surfaces that every scene has.
const OUTER_RACEWAY: &str = "outer raceway";
const BACK: &str = "outer ring's back";
const INNER_RACEWAY: &str = "inner raceway";

/// Name of the seat of the outer ring in its housing.
const SEAT: &str = "seat";

/// Name of the surface that takes the load, and of that load.
const LOADED: &str = "loaded surface";

/// Name of the component of a rotating load that acts across the static one.
const ACROSS: &str = "load across";
/// What a machine's foundation carries of its housing.
const FOUNDATION: &str = "foundation";

/// A bearing in motion: the system, and which body and contact pair of it is which. Bodies are numbered as in
/// the mesh.
#[derive(Debug)]
pub struct BearingSystem {
    /// Bodies in motion, contact and the load.
    pub system: System,
    /// The outer ring.
    pub outer: usize,
    /// The inner ring.
    pub inner: usize,
    /// The body that holds the outer ring, if there is one: the adapter or another housing. A ring that does
    /// not deform needs none.
    pub housing: Option<usize>,
    /// Each roller that is not missing.
    pub rollers: Vec<Roller>,
    /// The cage, which moves as one piece.
    pub cage: Option<usize>,
    /// Nodes on the outer surface of the outer ring.
    pub back: Vec<u32>,
    /// Numbers of the contact pairs.
    pub pairs: Pairs,
    /// Whether there is oil: two films a roller, on the outer and on the inner raceway in turn.
    pub oiled: bool,
}

/// One roller.
#[derive(Debug, Clone)]
pub struct Roller {
    /// Its pocket, from 0: it is roller `pocket + 1` of the scene.
    pub pocket: usize,
    /// Number of the body in the mesh.
    pub body: usize,
    /// The node in the centre.
    pub centre: u32,
    /// A node on the rim, for the angle.
    pub rim: u32,
}

/// Numbers of the contact pairs, from the outside in: the seat, then each roller on the outer raceway, in its
/// pocket, and on the inner raceway (the order of [`Plan::contact`]). The resultant of a pair with a roller
/// is the force on the roller.
#[derive(Debug, Clone, Copy)]
pub struct Pairs {
    /// 1 where the outer ring sits in a seat, else 0.
    seats: usize,
    rollers: usize,
    /// Walls of a roller's pocket: two, or none.
    walls: usize,
}

impl Pairs {
    /// Pair of outer ring and housing, whose resultant is the force on the ring; none without a seat.
    pub fn seat(&self) -> Option<usize> {
        (self.seats > 0).then_some(0)
    }

    /// Pair of a roller, from 0, and the outer raceway.
    pub fn outer(&self, roller: usize) -> usize {
        self.seats + roller
    }

    /// Pairs of a roller and the two walls of its pocket; empty without a cage.
    pub fn cage(&self, roller: usize) -> Range<usize> {
        let first = self.outer(self.rollers) + self.walls * roller;
        first..first + self.walls
    }

    /// Pair of a roller and the inner raceway.
    pub fn inner(&self, roller: usize) -> usize {
        self.cage(self.rollers).start + roller
    }
}

impl BearingSystem {
    /// Nodes on the outer surface of the outer ring nearest to these angles [rad], at which sensors sit.
    pub fn nodes_on_back(&self, angles: &[f64]) -> Vec<u32> {
        let off = |node: u32, wanted: f64| {
            let [x, y] = self.system.position(node);
            let angle = libm::atan2(y, x) - wanted;
            libm::hypot(libm::sin(angle), 1.0 - libm::cos(angle))
        };
        let nearest = |wanted: f64| {
            let nodes = self.back.iter().copied();
            nodes.min_by(|a, b| off(*a, wanted).total_cmp(&off(*b, wanted))).expect("a ring has nodes")
        };
        angles.iter().map(|&wanted| nearest(wanted)).collect()
    }
}

impl Assembly {
    /// Builds the system in motion, for `threads` workers.
    ///
    /// # Errors
    /// When the solver or contact refuses the model.
    pub fn build(&self, scene: &ResolvedScene, threads: usize) -> Result<BearingSystem, Error> {
        let mut plan = Plan::from(self.model.clone());
        plan.stiffness_damping = scene.stiffness_damping;
        plan.structural_damping = self.structural_damping(scene)?;
        let mesh = &self.model.mesh;
        let rollers: Vec<Roller> = self
            .rollers
            .iter()
            .map(|(pocket, r)| Roller {
                pocket: *pocket,
                body: r.body,
                centre: r.mark("centre").expect("a disc marks its centre"),
                rim: surface(r, "rim").nodes[0],
            })
            .collect();
        self.name_surfaces(&mut plan, scene, &rollers)?;
        let load_n = scene.written.operation.load_n;
        self.apply_load(&mut plan, scene)?;
        let back = surface(&self.outer, "outer");
        if let (HousingScene::Springs(springs), Some(housing)) = (&scene.written.housing, &self.housing) {
            suspend(&mut plan, springs, back, mesh.bodies[housing.body].nodes.start as u32)?;
        }
        let pairs = self.touch(&mut plan, scene)?;
        oil(&mut plan, scene, &rollers)?;
        let mut system = plan.build(threads)?;
        if let Some(duty) = scene.varying_duty() {
            load(&mut system, duty, load_n, 0.0)?;
        }
        Ok(BearingSystem {
            system,
            outer: self.outer.body,
            inner: self.inner.body,
            housing: self.housing.as_ref().map(|housing| housing.body),
            rollers,
            cage: self.cage.as_ref().map(|cage| cage.body),
            back: back.nodes.clone(),
            pairs,
            oiled: scene.written.film.is_some(),
        })
    }

    /// Names the surfaces that touch and the curves that they stand for: raceways and rollers are circles
    /// where they are round. So are the seat and what sits in it, or a facet of one that spans two of the other
    /// would press on the vertex between them. The cage touches with its corners, and keeps its polygons.
    fn name_surfaces(&self, plan: &mut Plan, scene: &ResolvedScene, rollers: &[Roller]) -> Result<(), Error> {
        let contact = &scene.written.contact;
        let spline = contact.interpolation == ContactInterpolation::Spline;
        let outer_is_round = scene.outer_relief.is_none() && scene.written.outer_ring_mesh.is_none();
        plan.surface(OUTER_RACEWAY, surface(&self.outer, "inner").clone())?;
        plan.smooth(OUTER_RACEWAY, smoothing(contact.surface, [0.0; 2], outer_is_round), spline)?;
        let inner_is_round = scene.inner_relief.is_none() && scene.written.inner_ring_mesh.is_none();
        plan.surface(INNER_RACEWAY, surface(&self.inner, "outer").clone())?;
        plan.smooth(INNER_RACEWAY, smoothing(contact.surface, [0.0; 2], inner_is_round), spline)?;
        if let Some(seat) = self.seat() {
            plan.surface(BACK, surface(&self.outer, "outer").clone())?;
            plan.surface(SEAT, seat.clone())?;
            if seat_is_round(scene) {
                // Nothing travels over it, so that splines would be of no use; notches of a ring from a file, which
                // are no arcs about the centre, stay chords.
                let circle = Smoothing::Arc { centre: [0.0; 2] };
                [BACK, SEAT].into_iter().try_for_each(|surface| plan.smooth(surface, circle, false))?;
            }
        }
        let mesh = &self.model.mesh;
        for ((i, placed), roller) in self.rollers.iter().zip(rollers) {
            let centre = [mesh.x[roller.centre as usize], mesh.y[roller.centre as usize]];
            plan.surface(&rim(*i), surface(placed, "rim").clone())?;
            let round = scene.roller_reliefs.iter().all(|(roller, _)| roller != i);
            plan.smooth(&rim(*i), smoothing(contact.surface, centre, round), spline)?;
        }
        for (i, (_, piece)) in self.cage.iter().flat_map(|c| &c.surfaces).enumerate() {
            plan.surface(&cage_piece(i), piece.clone())?;
        }
        Ok(())
    }

    /// The load of the scene on the housing, or on the outer ring's back where there is none, the load across it
    /// where one turns with the shaft, and what a foundation carries.
    fn apply_load(&self, plan: &mut Plan, scene: &ResolvedScene) -> Result<(), Error> {
        plan.surface(LOADED, self.loaded().clone())?;
        let (load_n, [along_x, along_y]) = (scene.written.operation.load_n, scene.written.load_direction());
        plan.load(LOADED, [load_n * along_x, load_n * along_y])?;
        if scene.duty.load_across_n(0.0).is_some() {
            let nodes = plan.nodes(LOADED)?;
            let share = load_n / nodes.len() as f64;
            let across = nodes.iter().map(|&n| (n, [-share * along_y, share * along_x]));
            plan.load_nodes(ACROSS, across.collect())?;
        }
        let weight_n = scene.on_foundation * scene.gravity;
        if weight_n > 0.0 {
            let nodes = plan.nodes(LOADED)?;
            let share = weight_n / nodes.len() as f64;
            plan.load_nodes(FOUNDATION, nodes.into_iter().map(|n| (n, [0.0, share])).collect())?;
        }
        Ok(())
    }

    /// Adds the contact pairs, in the order of [`Pairs`].
    fn touch(&self, plan: &mut Plan, scene: &ResolvedScene) -> Result<Pairs, Error> {
        let c = &scene.written.contact;
        let base = Law::penalty(scene.penalty_stiffness)?;
        let base = base.with_damping(c.damping_ratio, scene.contact_layer_mass)?;
        let rolling = base.with_friction(c.friction)?.with_onset(scene.contact_onset)?;
        let seat =
            Law::penalty(scene.seat_stiffness)?.with_damping(c.damping_ratio, scene.contact_layer_mass)?;
        let seat = seat.with_friction(c.seat_friction)?;
        let method = match c.method {
            ContactMethod::Collocated => Method::Collocated,
            ContactMethod::Integrated => Method::Integrated { points: c.points_per_facet },
        };
        let sides = match c.passes {
            ContactPasses::Two => Sides::Both,
            ContactPasses::One => Sides::First,
        };
        let pockets: Vec<usize> = self.rollers.iter().map(|(pocket, _)| *pocket).collect();
        let of_roller = |i: usize, second: &str, with: &str| Pair {
            name: format!("roller {} and the {with}", i + 1),
            method,
            sides,
            ..Pair::new(&rim(i), second, rolling)
        };
        let seats = usize::from(self.seat().is_some());
        if let Some(housing) = self.housing.as_ref().filter(|_| seats > 0) {
            plan.contact(Pair {
                name: format!("the {} and the outer ring", housing.name),
                // Node-to-segment contact on nearly conforming surfaces chatters: the seat is always
                // integrated.
                method: Method::Integrated { points: SEAT_POINTS },
                ..Pair::new(BACK, SEAT, seat)
            })?;
        }
        for &i in &pockets {
            plan.contact(of_roller(i, OUTER_RACEWAY, "outer raceway"))?;
        }
        if self.cage.is_some() {
            let pieces = scene.rollers;
            for &i in &pockets {
                for piece in [(i + pieces - 1) % pieces, i] {
                    plan.contact(of_roller(i, &cage_piece(piece), "cage"))?;
                }
            }
        }
        for &i in &pockets {
            plan.contact(of_roller(i, INNER_RACEWAY, "inner raceway"))?;
        }
        Ok(Pairs { seats, rollers: pockets.len(), walls: if self.cage.is_some() { 2 } else { 0 } })
    }

    /// The surface that takes the load: of the housing, or the outer ring's back where there is none.
    pub fn loaded(&self) -> &Surface {
        self.housing.as_ref().map_or_else(|| surface(&self.outer, "outer"), |housing| &housing.loaded)
    }

    /// Names and surfaces of the contact pairs, in the order of [`Pairs`], without those of the cage. The
    /// resultant of a pair is the force on the body of the first surface.
    pub fn touching(&self) -> Vec<(String, [&Surface; 2])> {
        let seat = self.seat().map(|seat| ("seat".to_owned(), [surface(&self.outer, "outer"), seat]));
        let on = |raceway: &'static str, track| {
            let rollers = self.rollers.iter();
            rollers.map(move |(i, roller)| {
                (format!("roller {} {raceway}", i + 1), [surface(roller, "rim"), track])
            })
        };
        let (outer, inner) = (surface(&self.outer, "inner"), surface(&self.inner, "outer"));
        seat.into_iter().chain(on("outer raceway", outer)).chain(on("inner raceway", inner)).collect()
    }

    /// Surface of the housing that the outer ring sits in, if there is one.
    fn seat(&self) -> Option<&Surface> {
        self.housing.as_ref().and_then(|housing| housing.seat.as_ref())
    }
}

/// Sets the load on the housing at a time [s]; `load_n` is the load [N] that a scale factor of one stands
/// for.
///
/// # Errors
/// When the system has no load of that name.
pub fn load(system: &mut System, duty: &Duty, load_n: f64, at_s: f64) -> Result<(), stribeck_system::Error> {
    system.scale_load(LOADED, duty.load_n(at_s) / load_n)?;
    if let Some(across) = duty.load_across_n(at_s) {
        system.scale_load(ACROSS, across / load_n)?;
    }
    Ok(())
}

/// Takes away what a foundation carries of the housing.
///
/// # Errors
/// When the system has no load of that name.
pub fn unsupported(system: &mut System, scene: &ResolvedScene) -> Result<(), stribeck_system::Error> {
    if scene.on_foundation * scene.gravity > 0.0 { system.scale_load(FOUNDATION, 0.0) } else { Ok(()) }
}

/// Puts oil between every roller and both raceways, the outer one first.
fn oil(plan: &mut Plan, scene: &ResolvedScene, rollers: &[Roller]) -> Result<(), Error> {
    let (Some(film), Some(loaded)) = (scene.film, scene.loaded_films()?) else { return Ok(()) };
    for roller in rollers {
        for (track, loaded) in [OUTER_RACEWAY, INNER_RACEWAY].into_iter().zip(&loaded) {
            plan.film(Film {
                round: rim(roller.pocket),
                centre: roller.centre,
                track: track.to_owned(),
                oil: Oil { viscosity: film.viscosity, least: loaded.least },
                stiffness: scene.penalty_stiffness,
                length: scene.contact_length,
                speed: loaded.speed,
            })?;
        }
    }
    Ok(())
}

/// Name of the contact surface of the roller in a pocket, from 0.
fn rim(roller: usize) -> String {
    format!("rim of roller {}", roller + 1)
}

/// Name of the contact surface of a piece of the cage, from 0.
fn cage_piece(piece: usize) -> String {
    format!("piece {} of the cage", piece + 1)
}

/// Curve that the polyline of a body about `centre` [m] stands for; one that is not round has no arc.
fn smoothing(surface: ContactSurface, centre: [f64; 2], round: bool) -> Smoothing {
    match surface {
        ContactSurface::Facet => Smoothing::Facet,
        ContactSurface::Arc if round => Smoothing::Arc { centre },
        ContactSurface::Arc => Smoothing::Nagata,
        ContactSurface::Nagata => Smoothing::Nagata,
    }
}
