//! From a scene to a model: bodies, constraints, contact pairs.

use std::{
    f64::consts::{PI, TAU},
    ops::Range,
};

use serde::{Deserialize, Serialize};
use stribeck_contact::{Law, Method, Oil, Sides, Smoothing};
use stribeck_mesh::{
    Annulus, ArcBlock, Circle, Disc, FormDeviation, Grading, Groove, Mesh, Part, Placed, Surface,
    characteristic_length,
};
use stribeck_solver::{
    Behaviour, Elastic, Model, Motion, critical::damped_time_step, structural_damping::StructuralDamping,
};
use stribeck_system::{Film, Pair, Plan, System};

use crate::{error::Error, grading, housing::housing, own_mesh, suspension::suspend};
use stribeck_scene::{
    deviation::Relief,
    duty::Duty,
    housing::HousingScene,
    kinematics::{FacetCounts, Kinematics},
    lubrication,
    resolved::{CageGeometry, DefectGeometry, ResolvedScene, pocket_half_width},
    run_info::MeshInfo,
    scene::{
        ContactInterpolation, ContactMethod, ContactPasses, ContactSurface, DampedBody, DefectRing,
        RollerCopies,
    },
};

/// A cage moves as one piece: its elements carry mass only and may be coarse [mm].
pub const CAGE_ELEMENT_MM: f64 = 2.0;

/// Integration points on a facet of the outer ring's seat: two conforming surfaces need fewer than a line
/// contact.
const SEAT_POINTS: usize = 2;

/// Names of the contact surfaces that every scene has.
const OUTER_RACEWAY: &str = "outer raceway";
const BACK: &str = "outer ring's back";
const INNER_RACEWAY: &str = "inner raceway";

/// Name of the surface that the outer ring sits in, where it sits in one.
const SEAT: &str = "seat";

/// Name of the surface that takes the load, and of the load.
pub(crate) const LOADED: &str = "loaded surface";

/// Name of the part of a load that turns with the shaft which acts across the other.
pub(crate) const ACROSS: &str = "load across";

/// Rings and a roller as they are meshed, which takes time: grooves are in them, deviations from round are
/// not yet, and the roller lies in the centre, not turned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshedParts {
    outer: Part,
    inner: Part,
    disc: Part,
}

/// A scene made into bodies, in mesh numbers.
#[derive(Debug)]
pub struct Assembly {
    /// The model.
    pub model: Model,
    /// Speeds.
    pub kinematics: Kinematics,
    /// Facets that pass the contacts.
    pub facets: FacetCounts,
    outer: Placed,
    inner: Placed,
    housing: Option<PlacedHousing>,
    /// With the pocket of each, from 0.
    rollers: Vec<(usize, Placed)>,
    cage: Option<Placed>,
}

/// What holds the outer ring, in mesh numbers.
#[derive(Debug)]
struct PlacedHousing {
    body: usize,
    /// What the ring sits in; none for springs.
    seat: Option<Surface>,
    loaded: Surface,
    /// Its name in messages.
    name: &'static str,
}

/// The same, ready to run; bodies by their numbers in the mesh.
#[derive(Debug)]
pub struct Machine {
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
    /// Contact pairs by what touches.
    pub pairs: Pairs,
    /// Whether there is oil: a film of each roller on the outer and on the inner raceway in turn.
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

/// Which contact pair is whose; the resultant of a roller's is the force on the roller.
///
/// They follow one another from the outside in, the seat first: see [`Plan::contact`].
#[derive(Debug, Clone, Copy)]
pub struct Pairs {
    /// One where the outer ring sits in something.
    seats: usize,
    rollers: usize,
    /// Walls of a roller's pocket: two, or none.
    walls: usize,
}

impl Pairs {
    /// Of outer ring and housing; the force on the ring. None where the ring touches nothing outside.
    pub fn seat(&self) -> Option<usize> {
        (self.seats > 0).then_some(0)
    }

    /// Of a roller, from 0, and the outer raceway.
    pub fn outer(&self, roller: usize) -> usize {
        self.seats + roller
    }

    /// Of a roller and the two walls of its pocket; none without a cage.
    pub fn cage(&self, roller: usize) -> Range<usize> {
        let first = self.outer(self.rollers) + self.walls * roller;
        first..first + self.walls
    }

    /// Of a roller and the inner raceway.
    pub fn inner(&self, roller: usize) -> usize {
        self.cage(self.rollers).start + roller
    }
}

impl Machine {
    /// The nodes on the outer surface of the outer ring that are nearest to these angles [rad]: where sensors
    /// sit.
    pub fn nodes_on_back(&self, angles: &[f64]) -> Vec<u32> {
        let off = |node: u32, wanted: f64| {
            let [x, y] = self.system.position(node);
            let angle = y.atan2(x) - wanted;
            angle.sin().hypot(1.0 - angle.cos())
        };
        let nearest = |wanted: f64| {
            let nodes = self.back.iter().copied();
            nodes.min_by(|a, b| off(*a, wanted).total_cmp(&off(*b, wanted))).expect("a ring has nodes")
        };
        angles.iter().map(|&wanted| nearest(wanted)).collect()
    }
}

impl MeshedParts {
    /// Meshes them. They are the same wherever rollers start.
    ///
    /// # Errors
    /// When a dimension or a count cannot be meshed.
    pub fn new(scene: &ResolvedScene) -> Result<Self, Error> {
        let b = &scene.written.bearing;
        let made = |ring: &Annulus, grading: &Option<Grading>| match grading {
            Some(grading) => ring.graded_part(grading),
            None => ring.part(),
        };

        let outer_grading = grading::ring(&scene.written.mesh, b.outer_ring_thickness_mm, Circle::Inner);
        let outer = Annulus {
            inner_radius: scene.outer_race_radius,
            outer_radius: scene.outer_race_radius + scene.outer_ring_thickness,
            facets: facets_around(scene, DefectRing::Outer),
            layers: grading::layers(&scene.written.mesh, b.outer_ring_thickness_mm),
            start_angle: 0.0,
            grooves: grooves_in(scene, DefectRing::Outer),
        };
        let outer = match &scene.written.outer_ring_mesh {
            Some(own) => own_mesh::ring(own, DefectRing::Outer, scene)?,
            None => made(&outer, &outer_grading)?,
        };

        let inner_grading = grading::ring(&scene.written.mesh, b.inner_ring_thickness_mm, Circle::Outer);
        let inner = Annulus {
            inner_radius: scene.inner_race_radius - scene.inner_ring_thickness,
            outer_radius: scene.inner_race_radius,
            facets: facets_around(scene, DefectRing::Inner),
            layers: grading::layers(&scene.written.mesh, b.inner_ring_thickness_mm),
            start_angle: 0.0,
            grooves: grooves_in(scene, DefectRing::Inner),
        };
        let inner = match &scene.written.inner_ring_mesh {
            Some(own) => own_mesh::ring(own, DefectRing::Inner, scene)?,
            None => made(&inner, &inner_grading)?,
        };

        let facets = scene.written.mesh.roller_facets;
        let facet_mm = PI * b.roller_diameter_mm / facets as f64;
        let core = 1e-3 * grading::roller_core_mm(&scene.written.mesh, facet_mm);
        let disc = Disc { radius: scene.roller_radius, facets, size: core, rotation: 0.0 };
        let disc = match &scene.written.mesh.grading {
            None => disc.part()?,
            Some(scene) => disc.part_with_layers(grading::roller_layers(scene).min(disc.most_layers()))?,
        };
        Ok(Self { outer, inner, disc })
    }
}

impl Assembly {
    /// Meshes every body of the scene.
    ///
    /// # Errors
    /// When a dimension or a count cannot be meshed.
    pub fn new(scene: &ResolvedScene) -> Result<Self, Error> {
        Self::of(scene, &MeshedParts::new(scene)?)
    }

    /// The same of rings and a roller that have been meshed already.
    ///
    /// # Errors
    /// When the rest cannot be meshed.
    pub fn of(scene: &ResolvedScene, parts: &MeshedParts) -> Result<Self, Error> {
        let mut mesh = Mesh::new();
        let outer = formed(parts.outer.clone(), "inner", Circle::Inner, scene.outer_relief.as_ref())?;
        let (outer_area, outer) = (outer.area(), mesh.add("outer ring", &outer));
        let inner = formed(parts.inner.clone(), "outer", Circle::Outer, scene.inner_relief.as_ref())?;
        let inner = mesh.add("inner ring", &inner);

        let made = housing(scene, &mesh, surface(&outer, "outer"))?;
        let held = made.map(|made| {
            let placed = mesh.add(made.name, &made.part);
            let named = |name: &str| surface(&placed, name).clone();
            let (body, seat, loaded) = (placed.body, made.seat.map(named), named(made.loaded));
            (PlacedHousing { body, seat, loaded, name: made.name }, made.density)
        });

        let disc = &parts.disc;
        // Rollers start where they ride on the outer raceway: that is where centrifugal force holds idle
        // ones.
        let path = scene.outer_race_radius - scene.roller_radius;
        let rollers: Result<Vec<(usize, Placed)>, Error> = scene
            .written
            .rollers_in_place()
            .map(|number| {
                let i = number - 1;
                let angle = scene.roller_angle(i);
                let turned = match scene.written.mesh.roller_copies {
                    RollerCopies::Translated if scene.roller_phase == 0.0 => disc.clone(),
                    RollerCopies::Translated => disc.rotated(scene.roller_phase),
                    RollerCopies::Rotated => disc.rotated(angle + scene.roller_phase),
                };
                let relief = scene.roller_reliefs.iter().find(|(roller, _)| *roller == i);
                let turned = formed(turned, "rim", Circle::Outer, relief.map(|(_, relief)| relief))?;
                let (s, c) = angle.sin_cos();
                Ok((i, mesh.add(format!("roller {number}"), &turned.translated(path * c, path * s))))
            })
            .collect();
        let rollers = rollers?;

        let cage_mesh = scene.cage.as_ref().map(|cage| {
            let part = cage_part(scene, cage, cage.walls(path, scene.roller_radius), path)?;
            // Walls that reach farther than the cage make it no heavier.
            let own = cage_part(scene, cage, cage.radii(), path)?;
            Ok::<_, Error>((mesh.add("cage", &part), own.area() / part.area()))
        });
        let cage_mesh = cage_mesh.transpose()?;

        let steel = Elastic::new(
            scene.material.youngs_modulus,
            scene.material.poissons_ratio,
            scene.material.density,
        )?;
        let mut model = Model::new(mesh, steel, scene.thickness)?;
        model.hourglass_scale = scene.written.solver.hourglass_scale;
        model.gravity = [0.0, -scene.written.operation.gravity_m_s2];
        let m = &scene.material;
        if let Some((cage, lighter)) = &cage_mesh {
            model.behaviour[cage.body] = Behaviour::Rigid;
            model.materials[cage.body] =
                Elastic::new(m.youngs_modulus, m.poissons_ratio, lighter * m.density)?;
        }
        let cage = cage_mesh.map(|(cage, _)| cage);
        let kinematics = Kinematics::of(&scene.written);
        match (&scene.written.housing, &held) {
            (HousingScene::Rigid(housing), _) => {
                model.behaviour[outer.body] = Behaviour::Turning { rate: kinematics.outer_rad_s };
                let heavier = 1.0 + housing.mass_kg / (outer_area * scene.thickness * m.density);
                model.materials[outer.body] =
                    Elastic::new(m.youngs_modulus, m.poissons_ratio, heavier * m.density)?;
            }
            (HousingScene::Springs(_), Some((frame, density))) => {
                model.behaviour[frame.body] = Behaviour::Turning { rate: 0.0 };
                model.materials[frame.body] =
                    Elastic::new(m.youngs_modulus, m.poissons_ratio, density * m.density)?;
            }
            (_, Some((held, _))) => {
                for &n in &held.loaded.nodes {
                    model.motion[n as usize] = Motion::HeldX;
                }
            }
            (_, None) => {}
        }
        let housing = held.map(|(held, _)| held);
        for &n in &surface(&inner, "inner").nodes {
            model.motion[n as usize] = Motion::Rotating { centre: [0.0; 2], rate: kinematics.shaft_rad_s };
        }
        let around = |ring: DefectRing, own: bool, raceway: &Surface| {
            if own { raceway.facets() as f64 } else { scene.facets_around(ring, facets_around(scene, ring)) }
        };
        let [own_outer, own_inner] =
            [&scene.written.outer_ring_mesh, &scene.written.inner_ring_mesh].map(Option::is_some);
        let facets = FacetCounts {
            roller: scene.written.mesh.roller_facets,
            outer: around(DefectRing::Outer, own_outer, surface(&outer, "inner")),
            inner: around(DefectRing::Inner, own_inner, surface(&inner, "outer")),
        };
        Ok(Self { model, kinematics, facets, outer, inner, housing, rollers, cage })
    }

    /// Nodes of the housing that take the load and are guided up and down; none where the load may come from
    /// anywhere.
    pub fn guided(&self) -> Vec<u32> {
        self.that_move(|motion| *motion == Motion::HeldX)
    }

    /// Nodes of the inner ring's bore.
    pub fn turned_by_the_shaft(&self) -> Vec<u32> {
        self.that_move(|motion| matches!(motion, Motion::Rotating { .. }))
    }

    fn that_move(&self, so: impl Fn(&Motion) -> bool) -> Vec<u32> {
        (0..).zip(&self.model.motion).filter(|(_, motion)| so(motion)).map(|(n, _)| n).collect()
    }

    /// Counts for `run.json`.
    pub fn mesh_info(&self) -> MeshInfo {
        let mesh = &self.model.mesh;
        MeshInfo {
            nodes: mesh.x.len(),
            quads: mesh.quads.len(),
            triangles: mesh.triangles.len(),
            roller_facets: self.facets.roller,
            outer_facets: surface(&self.outer, "inner").facets(),
            inner_facets: surface(&self.inner, "outer").facets(),
        }
    }

    /// Structural damping of the scene's bodies, if there is some.
    fn structural_damping(&self, scene: &ResolvedScene) -> Result<Option<StructuralDamping>, Error> {
        let (Some(chosen), Some(band)) = (&scene.written.solver.structural_damping, scene.structural_damping)
        else {
            return Ok(None);
        };
        let bodies = chosen.bodies.iter().flat_map(|body| match body {
            DampedBody::OuterRing => vec![self.outer.body],
            DampedBody::InnerRing => vec![self.inner.body],
            DampedBody::Adapter => self.housing.iter().map(|housing| housing.body).collect(),
            DampedBody::Rollers => self.rollers.iter().map(|(_, roller)| roller.body).collect(),
        });
        let bodies = bodies.filter(|body| self.model.behaviour[*body].is_elastic());
        let damping = StructuralDamping::over_band(band.ratio, band.band, chosen.branches, bodies.collect())?;
        Ok(Some(damping))
    }

    /// What elastic bodies are made of: the inner ring always is one.
    pub fn steel(&self) -> &Elastic {
        &self.model.materials[self.inner.body]
    }

    /// Critical time step of the stiffest element by itself [s], with stiffness and structural damping as if
    /// every body had them: an estimate before anything is laid out.
    pub fn element_time_step_s(&self, scene: &ResolvedScene) -> f64 {
        let mesh = &self.model.mesh;
        let nu = scene.written.material.poissons_ratio;
        let corner = |n: u32| [mesh.x[n as usize], mesh.y[n as usize]];
        let elastic = |n: u32| {
            let mut bodies = mesh.bodies.iter().zip(&self.model.behaviour);
            bodies.any(|(body, behaviour)| behaviour.is_elastic() && body.nodes.contains(&(n as usize)))
        };
        let quads = mesh.quads.iter().filter(|q| elastic(q[0]));
        let quads = quads.map(|q| characteristic_length(&q.map(corner), nu));
        let triangles = mesh.triangles.iter().map(|t| characteristic_length(&t.map(corner), nu));
        let shortest = quads.chain(triangles).fold(f64::INFINITY, f64::min);
        // What cannot be damped is refused when it is laid out.
        let damping = self.structural_damping(scene).ok().flatten();
        let stiffer = damping.map_or(1.0, |damping| damping.stiffening(f64::INFINITY));
        let undamped = shortest / (self.steel().dilatational_speed() * stiffer.sqrt());
        damped_time_step(undamped, scene.stiffness_damping)
    }

    /// Lays everything out for `threads` workers.
    ///
    /// # Errors
    /// When the solver or contact refuses the model.
    pub fn machine(&self, scene: &ResolvedScene, threads: usize) -> Result<Machine, Error> {
        let mut plan = Plan::from(self.model.clone());
        plan.stiffness_damping = scene.stiffness_damping;
        plan.structural_damping = self.structural_damping(scene)?;
        // What bodies roll over is a circle. Nothing travels over the seat, and the cage touches with its
        // corners.
        let spline = scene.written.contact.interpolation == ContactInterpolation::Spline;
        plan.surface(OUTER_RACEWAY, surface(&self.outer, "inner").clone())?;
        plan.smooth(
            OUTER_RACEWAY,
            smoothing(
                scene.written.contact.surface,
                [0.0; 2],
                scene.outer_relief.is_none() && scene.written.outer_ring_mesh.is_none(),
            ),
            spline,
        )?;
        plan.surface(INNER_RACEWAY, surface(&self.inner, "outer").clone())?;
        plan.smooth(
            INNER_RACEWAY,
            smoothing(
                scene.written.contact.surface,
                [0.0; 2],
                scene.inner_relief.is_none() && scene.written.inner_ring_mesh.is_none(),
            ),
            spline,
        )?;
        let back = surface(&self.outer, "outer");
        if let Some(seat) = self.seat() {
            plan.surface(BACK, back.clone())?;
            plan.surface(SEAT, seat.clone())?;
        }
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
        for ((i, placed), roller) in self.rollers.iter().zip(&rollers) {
            let centre = [mesh.x[roller.centre as usize], mesh.y[roller.centre as usize]];
            plan.surface(&rim(*i), surface(placed, "rim").clone())?;
            let round = scene.roller_reliefs.iter().all(|(roller, _)| roller != i);
            plan.smooth(&rim(*i), smoothing(scene.written.contact.surface, centre, round), spline)?;
        }
        for (i, (_, piece)) in self.cage.iter().flat_map(|c| &c.surfaces).enumerate() {
            plan.surface(&cage_piece(i), piece.clone())?;
        }
        plan.surface(LOADED, self.housing.as_ref().map_or(back, |housing| &housing.loaded).clone())?;
        let (load_n, [along_x, along_y]) = (scene.written.operation.load_n, scene.written.load_direction());
        plan.load(LOADED, [load_n * along_x, load_n * along_y])?;
        if scene.duty.load_across_n(0.0).is_some() {
            let nodes = plan.nodes(LOADED)?;
            let share = load_n / nodes.len() as f64;
            let across = nodes.iter().map(|&n| (n, [-share * along_y, share * along_x]));
            plan.load_nodes(ACROSS, across.collect())?;
        }
        if let (HousingScene::Springs(springs), Some(housing)) = (&scene.written.housing, &self.housing) {
            suspend(&mut plan, springs, back, mesh.bodies[housing.body].nodes.start as u32)?;
        }
        let pairs = self.touch(&mut plan, scene)?;
        oil(&mut plan, scene, &rollers)?;
        let mut system = plan.build(threads)?;
        if let Some(duty) = scene.varying_duty() {
            load(&mut system, duty, load_n, 0.0)?;
        }
        Ok(Machine {
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

    /// Lets surfaces touch, in the order of [`Pairs`].
    fn touch(&self, plan: &mut Plan, scene: &ResolvedScene) -> Result<Pairs, Error> {
        let c = &scene.written.contact;
        let base = Law::penalty(scene.penalty_stiffness)?;
        let base = base.with_damping(c.damping_ratio, scene.contact_layer_mass)?;
        let rolling = base.with_friction(c.friction)?.with_onset(scene.contact_onset)?;
        let seat = base.with_friction(c.seat_friction)?;
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

    /// What the outer ring sits in, if it sits in something.
    fn seat(&self) -> Option<&Surface> {
        self.housing.as_ref().and_then(|housing| housing.seat.as_ref())
    }
}

/// Sets what pushes on the housing at a time [s]; `load_n` is what a factor of one stands for.
///
/// # Errors
/// When there is no load of a name.
pub fn load(system: &mut System, duty: &Duty, load_n: f64, at_s: f64) -> Result<(), stribeck_system::Error> {
    system.scale_load(LOADED, duty.load_n(at_s) / load_n)?;
    if let Some(across) = duty.load_across_n(at_s) {
        system.scale_load(ACROSS, across / load_n)?;
    }
    Ok(())
}

/// Puts oil between every roller and both raceways, the outer one first.
fn oil(plan: &mut Plan, scene: &ResolvedScene, rollers: &[Roller]) -> Result<(), Error> {
    let (Some(film), Some(loaded)) = (scene.film, lubrication::loaded_films(scene)?) else { return Ok(()) };
    for roller in rollers {
        for (track, loaded) in [OUTER_RACEWAY, INNER_RACEWAY].into_iter().zip(&loaded) {
            plan.film(Film {
                round: rim(roller.pocket),
                centre: roller.centre,
                track: track.to_owned(),
                oil: Oil { viscosity: film.viscosity, least: loaded.least },
                stiffness: scene.penalty_stiffness,
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

/// The part with what deviates from round on its surface.
fn formed(part: Part, surface: &str, circle: Circle, relief: Option<&Relief>) -> Result<Part, Error> {
    let Some(relief) = relief else { return Ok(part) };
    let (depth, corners) = (|angle: f64| relief.depth(angle), relief.corners());
    Ok(FormDeviation { depth: &depth, corners: &corners, circle }.of_part(&part, surface)?)
}

/// What the polyline of a body about `centre` stands for; one that is not round has no circle.
fn smoothing(surface: ContactSurface, centre: [f64; 2], round: bool) -> Smoothing {
    match surface {
        ContactSurface::Facet => Smoothing::Facet,
        ContactSurface::Arc if round => Smoothing::Arc { centre },
        ContactSurface::Arc => Smoothing::Nagata,
        ContactSurface::Nagata => Smoothing::Nagata,
    }
}

fn surface<'a>(placed: &'a Placed, name: &str) -> &'a Surface {
    placed.surface(name).expect("the generator of this body names this surface")
}

/// Facets around the raceway of `ring`, before its grooves.
fn facets_around(scene: &ResolvedScene, ring: DefectRing) -> usize {
    let (chosen, radius) = match ring {
        DefectRing::Outer => (scene.written.mesh.outer_facets, scene.outer_race_radius),
        DefectRing::Inner => (scene.written.mesh.inner_facets, scene.inner_race_radius),
    };
    chosen.unwrap_or_else(|| ((TAU * radius / scene.element_size).round() as usize).max(8))
}

/// The grooves in the raceway of `ring`.
fn grooves_in(scene: &ResolvedScene, ring: DefectRing) -> Vec<Groove> {
    let circle = match ring {
        DefectRing::Outer => Circle::Inner,
        DefectRing::Inner => Circle::Outer,
    };
    let cut = |d: &DefectGeometry| Groove {
        centre_angle: d.angle,
        length: d.length,
        depth: d.depth,
        slope: d.edge_slope,
        circle,
    };
    scene.grooves_of(ring).map(cut).collect()
}

/// All pieces of the cage as one body whose walls reach between two radii. Surfaces in the order of the
/// rollers: piece i lies between roller i and the next one counter-clockwise.
fn cage_part(
    scene: &ResolvedScene,
    cage: &CageGeometry,
    [inner, outer]: [f64; 2],
    path: f64,
) -> Result<Part, Error> {
    let reach = scene.roller_radius + cage.pocket_clearance;
    let half_width = pocket_half_width(inner, outer, path, reach);
    let pieces = scene.rollers;
    let gap = 2.0 * (half_width / outer).asin();
    let arc = (TAU / pieces as f64 - gap) * outer;
    let mut joined = Part::default();
    for i in 0..pieces {
        let piece = ArcBlock {
            inner_radius: inner,
            outer_radius: outer,
            right_line_angle: scene.pocket_angle(i),
            left_line_angle: scene.pocket_angle(i) + TAU / pieces as f64,
            half_width,
            rows: ((1e3 * (outer - inner) / CAGE_ELEMENT_MM).round() as usize).max(1),
            columns: ((1e3 * arc / CAGE_ELEMENT_MM).round() as usize).max(1),
        };
        let piece = piece.part()?;
        let first = joined.x.len() as u32;
        joined.x.extend(&piece.x);
        joined.y.extend(&piece.y);
        joined.quads.extend(piece.quads.iter().map(|q| q.map(|n| n + first)));
        let mut boundary = piece.surface("boundary").expect("an arc block names its boundary").clone();
        boundary.nodes.iter_mut().for_each(|n| *n += first);
        joined.surfaces.push((format!("piece {}", i + 1), boundary));
    }
    Ok(joined)
}
