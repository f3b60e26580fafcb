//! From a scene to a model: meshed bodies with materials and constraints.

mod parts;
mod system;

use stribeck_mesh::{Circle, Mesh, Part, Placed, Surface, characteristic_length};
use stribeck_scene::{
    housing::HousingScene,
    resolved::ResolvedScene,
    scene::{DampedBody, DefectRing, RollerCopies},
};
use stribeck_solver::{
    Behaviour, Elastic, Model, NodeMotion, critical::damped_time_step, structural_damping::StructuralDamping,
};
use stribeck_store::run_info::MeshInfo;
use stribeck_theory::kinematics::{FacetCounts, Kinematics};

use crate::bearing::housing::housing;
use crate::error::Error;
pub use parts::{CAGE_ELEMENT_MM, MeshedParts};
use parts::{cage_part, facets_around, formed};
pub use system::{BearingSystem, Pairs, Roller, load, unsupported};

/// The bodies of a scene, meshed, placed, and with their constraints; nothing touches yet.
#[derive(Debug)]
pub struct Assembly {
    /// Mesh, materials and constraints of all bodies.
    pub model: Model,
    /// Speeds of rings, cage and rollers in rolling without slip.
    pub kinematics: Kinematics,
    /// Facets that pass the contacts.
    pub facets: FacetCounts,
    outer: Placed,
    inner: Placed,
    housing: Option<PlacedHousing>,
    /// With the number of its pocket, from 0.
    rollers: Vec<(usize, Placed)>,
    cage: Option<Placed>,
}

/// The body that holds the outer ring, by its numbers in the mesh.
#[derive(Debug)]
struct PlacedHousing {
    body: usize,
    /// Surface that the ring sits in; none for springs.
    seat: Option<Surface>,
    loaded: Surface,
    /// Its name in messages.
    name: &'static str,
}

impl Assembly {
    /// Meshes every body of the scene.
    pub fn new(scene: &ResolvedScene) -> Result<Self, Error> {
        Self::of(scene, &MeshedParts::new(scene)?)
    }

    /// The same from rings and a roller that are already meshed.
    ///
    /// # Errors
    /// When housing, cage or a deviation from round cannot be meshed.
    pub fn of(scene: &ResolvedScene, parts: &MeshedParts) -> Result<Self, Error> {
        let mut mesh = Mesh::new();
        let outer = formed(parts.outer.clone(), "inner", Circle::Inner, scene.outer_relief.as_ref())?;
        let (outer_area, outer) = (outer.area(), mesh.add("outer ring", &outer));
        let inner = formed(parts.inner.clone(), "outer", Circle::Outer, scene.inner_relief.as_ref())?;
        let inner = mesh.add("inner ring", &inner);
        let made = housing(scene, &mesh, surface(&outer, "outer"))?;
        let housing_density = made.as_ref().map_or(1.0, |made| made.density);
        let housing = made.map(|made| {
            let placed = mesh.add(made.name, &made.part);
            let named = |name: &str| surface(&placed, name).clone();
            let (body, seat, loaded) = (placed.body, made.seat.map(named), named(made.loaded));
            PlacedHousing { body, seat, loaded, name: made.name }
        });
        // Rollers start where they ride on the outer raceway: that is where centrifugal force holds idle
        // ones.
        let path = scene.outer_race_radius - scene.roller_radius;
        let rollers = add_rollers(scene, &parts.disc, path, &mut mesh)?;
        let cage_mesh = scene.cage.as_ref().map(|cage| {
            let part = cage_part(scene, cage, cage.walls(path, scene.roller_radius), path)?;
            // Walls that extend beyond the cage's diameters add no mass.
            let own = cage_part(scene, cage, cage.radii(), path)?;
            Ok::<_, Error>((mesh.add("cage", &part), own.area() / part.area()))
        });
        let cage_mesh = cage_mesh.transpose()?;

        let kinematics = scene.written.kinematics();
        let mut bodies = Bodies::new(scene, mesh)?;
        let share = scene.element_share();
        if share != 1.0 {
            rollers.iter().try_for_each(|(_, roller)| bodies.shorter(roller.body, share))?;
        }
        let cage = match cage_mesh {
            Some((cage, density)) => {
                bodies.rigid(cage.body, Behaviour::Rigid, density)?;
                Some(cage)
            }
            None => None,
        };
        let mass = scene.written.housing.mass(&scene.written.bearing);
        match (mass, &scene.written.housing, &housing) {
            (Some(rigid), ..) => {
                let heavier = 1.0 + rigid.mass_kg / (outer_area * scene.thickness * scene.material.density);
                bodies.rigid(
                    outer.body,
                    Behaviour::Turning { rate: kinematics.outer_rad_s, braking: rigid.damping_per_s },
                    heavier,
                )?;
            }
            (None, HousingScene::Springs(_), Some(frame)) => {
                bodies.rigid(frame.body, Behaviour::Turning { rate: 0.0, braking: 0.0 }, housing_density)?;
            }
            (None, _, Some(housing)) => bodies.constrain(&housing.loaded, NodeMotion::HeldX),
            (None, _, None) => {}
        }
        let bore = surface(&inner, "inner");
        bodies.constrain(bore, NodeMotion::Rotating { centre: [0.0; 2], rate: kinematics.shaft_rad_s });
        let facets = facet_counts(scene, surface(&outer, "inner"), surface(&inner, "outer"));
        Ok(Self { model: bodies.model, kinematics, facets, outer, inner, housing, rollers, cage })
    }

    /// Nodes of the housing that take the load and are guided vertically; none for a housing that may be
    /// loaded in any direction.
    pub fn guided(&self) -> Vec<u32> {
        self.that_move(|motion| *motion == NodeMotion::HeldX)
    }

    /// Nodes of the inner ring's bore.
    pub fn turned_by_the_shaft(&self) -> Vec<u32> {
        self.that_move(|motion| matches!(motion, NodeMotion::Rotating { .. }))
    }

    fn that_move(&self, so: impl Fn(&NodeMotion) -> bool) -> Vec<u32> {
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
        let damping = StructuralDamping::over_band(band.ratio, band.band, bodies.collect())?;
        Ok(Some(damping))
    }

    /// Material of elastic bodies, read from the inner ring, which is always elastic.
    pub fn steel(&self) -> &Elastic {
        &self.model.materials[self.inner.body]
    }

    /// Critical time step of the stiffest element alone [s], with stiffness and structural damping as if
    /// every body had them: an estimate before the solver has laid out the model.
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
        // Damping that the solver refuses is refused when the model is built.
        let damping = self.structural_damping(scene).ok().flatten();
        let stiffer = damping.map_or(1.0, |damping| damping.stiffening(f64::INFINITY));
        let undamped = shortest / (self.steel().dilatational_speed() * stiffer.sqrt());
        damped_time_step(undamped, scene.stiffness_damping)
    }
}

/// The model while its bodies get their materials and constraints.
struct Bodies<'a> {
    model: Model,
    scene: &'a ResolvedScene,
}

impl<'a> Bodies<'a> {
    /// All bodies of `mesh` elastic and free, of the scene's material, under gravity.
    fn new(scene: &'a ResolvedScene, mesh: Mesh) -> Result<Self, Error> {
        let m = &scene.material;
        let steel = Elastic::new(m.youngs_modulus, m.poissons_ratio, m.density)?;
        let mut model = Model::new(mesh, steel, scene.thickness)?;
        model.hourglass_scale = scene.written.solver.hourglass_scale;
        model.gravity = [0.0, -scene.written.operation.gravity_m_s2];
        Ok(Self { model, scene })
    }

    /// Makes a body rigid, with `density` as a multiple of the material's [-].
    fn rigid(&mut self, body: usize, behaviour: Behaviour, density: f64) -> Result<(), Error> {
        let m = &self.scene.material;
        self.model.behaviour[body] = behaviour;
        self.model.materials[body] = Elastic::new(m.youngs_modulus, m.poissons_ratio, density * m.density)?;
        Ok(())
    }

    /// Makes a body this `share` of the thickness long, out of plane: as heavy and as stiff.
    fn shorter(&mut self, body: usize, share: f64) -> Result<(), Error> {
        let m = &self.scene.material;
        self.model.materials[body] =
            Elastic::new(share * m.youngs_modulus, m.poissons_ratio, share * m.density)?;
        Ok(())
    }

    fn constrain(&mut self, surface: &Surface, motion: NodeMotion) {
        for &n in &surface.nodes {
            self.model.motion[n as usize] = motion;
        }
    }
}

/// Copies `disc` to every pocket that has a roller, centres on a circle of radius `path` [m]; with the number
/// of the pocket, from 0.
fn add_rollers(
    scene: &ResolvedScene,
    disc: &Part,
    path: f64,
    mesh: &mut Mesh,
) -> Result<Vec<(usize, Placed)>, Error> {
    let add = |number: usize| {
        let i = number - 1;
        let angle = scene.roller_angle(i);
        let turned = match scene.written.mesh.roller_copies {
            RollerCopies::Translated if scene.roller_phase == 0.0 => disc.clone(),
            RollerCopies::Translated => disc.rotated(scene.roller_phase),
            RollerCopies::Rotated => disc.rotated(angle + scene.roller_phase),
        };
        let relief = scene.roller_reliefs.iter().find(|(roller, _)| *roller == i);
        let turned = formed(turned, "rim", Circle::Outer, relief.map(|(_, relief)| relief))?;
        let (s, c) = libm::sincos(angle);
        Ok((i, mesh.add(format!("roller {number}"), &turned.translated(path * c, path * s))))
    };
    scene.written.rollers_in_place().map(add).collect()
}

/// Facets that pass the contacts; those of a ring from a file are counted on its raceway.
fn facet_counts(scene: &ResolvedScene, outer: &Surface, inner: &Surface) -> FacetCounts {
    let around = |ring: DefectRing, from_file: bool, raceway: &Surface| {
        if from_file {
            raceway.facets() as f64
        } else {
            scene.facets_around(ring, facets_around(scene, ring))
        }
    };
    let [own_outer, own_inner] =
        [&scene.written.outer_ring_mesh, &scene.written.inner_ring_mesh].map(Option::is_some);
    FacetCounts {
        roller: scene.written.mesh.roller_facets,
        outer: around(DefectRing::Outer, own_outer, outer),
        inner: around(DefectRing::Inner, own_inner, inner),
    }
}

/// A surface that the generator of this body is known to name.
fn surface<'a>(placed: &'a Placed, name: &str) -> &'a Surface {
    placed.surface(name).expect("the generator of this body names this surface")
}
