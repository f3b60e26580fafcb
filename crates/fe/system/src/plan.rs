//! Input of a system: bodies, contact pairs of their surfaces, and loads.

use stribeck_contact::{Law, Method, Oil, Sides, Smoothing};
use stribeck_mesh::{Mesh, Part, Placed, Surface};
use stribeck_solver::{Elastic, Force, Model, NodeMotion, structural_damping::StructuralDamping};

use crate::{
    error::Error,
    names::{Names, unknown},
};

/// Bodies, contact pairs and loads, until they are set in motion by [`Plan::build`].
///
/// The surfaces and marks of a part are named after its body: the rim of the disc that was added as `wheel`
/// is `wheel.rim`, its centre `wheel.centre`.
pub struct Plan {
    /// Mesh, materials, rigid bodies, constraints, the thickness and gravity.
    pub model: Model,
    /// β of the stiffness-proportional damping of elastic bodies [s]: a mode of the angular frequency ω has
    /// the damping ratio βω/2.
    pub stiffness_damping: f64,
    /// Damping of some elastic bodies, by their numbers in the mesh, at nearly one ratio over a band of
    /// frequencies.
    pub structural_damping: Option<StructuralDamping>,
    pub(crate) names: Names,
    /// In the order in which they were named.
    pub(crate) surfaces: Vec<NamedSurface>,
    pub(crate) pairs: Vec<Pair>,
    pub(crate) films: Vec<Film>,
    pub(crate) loads: Vec<PlannedLoad>,
    pub(crate) further: Vec<PlannedForce>,
}

/// Two surfaces that may touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// Name of the pair, also in messages: "*name* penetrate each other". Several pairs may share one, and
    /// have one resultant then.
    pub name: String,
    /// Name of one surface; the resultant of the pair is the force on its body.
    pub first: String,
    /// Name of the other.
    pub second: String,
    /// Law between them.
    pub law: Law,
    /// Where it acts.
    pub method: Method,
    /// Whose points are evaluated.
    pub sides: Sides,
}

impl Pair {
    /// The points of either surface against the other, four on every facet. The pair is called "*first* and
    /// *second*".
    pub fn new(first: &str, second: &str, law: Law) -> Self {
        Self {
            name: format!("{first} and {second}"),
            first: first.to_owned(),
            second: second.to_owned(),
            law,
            method: Method::Integrated { points: 4 },
            sides: Sides::Both,
        }
    }
}

/// Oil between a round body and a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// Name of the round body's surface.
    pub round: String,
    /// The node in its centre.
    pub centre: u32,
    /// Name of the surface that it rolls on.
    pub track: String,
    /// The oil.
    pub oil: Oil,
    /// Penalty stiffness of the contact of the two [Pa/m].
    pub stiffness: f64,
    /// Length out of plane [m].
    pub length: f64,
    /// Entrainment speed before the first step [m/s]: half the sum of the speeds of both surfaces against the
    /// contact.
    pub speed: f64,
}

pub(crate) struct NamedSurface {
    pub(crate) name: String,
    pub(crate) surface: Surface,
    pub(crate) smoothing: Option<Smoothing>,
    pub(crate) spline: bool,
}

/// A load, before nodes have places.
pub(crate) struct PlannedLoad {
    pub(crate) name: String,
    pub(crate) on: LoadedNodes,
}

/// Where a load acts.
pub(crate) enum LoadedNodes {
    /// Spread over a surface: its number and the whole force [N].
    Surface(usize, [f64; 2]),
    /// On single nodes [N].
    Nodes(Vec<(u32, [f64; 2])>),
}

/// Makes a law of the user, given the places of its nodes.
type MakeForce = Box<dyn FnOnce(&[u32]) -> Box<dyn Force + Send>>;

/// A law of the user and the nodes on which it may push.
pub(crate) struct PlannedForce {
    pub(crate) name: String,
    pub(crate) nodes: Vec<u32>,
    pub(crate) make: MakeForce,
}

impl From<Model> for Plan {
    /// Bodies of a model; their surfaces are named by [`Plan::surface`].
    fn from(model: Model) -> Self {
        let names = Names { bodies: model.mesh.bodies.clone(), groups: Vec::new() };
        let (surfaces, pairs, films, loads, further) = Default::default();
        let structural_damping = None;
        Self {
            model,
            stiffness_damping: 0.0,
            structural_damping,
            names,
            surfaces,
            pairs,
            films,
            loads,
            further,
        }
    }
}

impl Plan {
    /// No bodies yet; all will have the same out-of-plane `thickness` [m].
    pub fn new(thickness: f64) -> Self {
        Self::from(Model {
            mesh: Mesh::new(),
            materials: Vec::new(),
            behaviour: Vec::new(),
            motion: Vec::new(),
            thickness,
            hourglass_scale: 1.0,
            gravity: [0.0; 2],
        })
    }

    /// Adds an elastic body whose nodes are free, where it stands; its surfaces and marks are called
    /// `name.surface` and `name.mark`.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn add(&mut self, name: &str, part: &Part, material: Elastic) -> Result<Placed, Error> {
        self.names.check_new(name)?;
        let Model { mesh, materials, behaviour, motion, .. } = &mut self.model;
        let placed = mesh.add(name, part);
        self.names.bodies.clone_from(&mesh.bodies);
        materials.push(material);
        behaviour.push(stribeck_solver::Behaviour::Elastic);
        motion.resize(mesh.x.len(), NodeMotion::Free);
        for (surface, nodes) in &placed.surfaces {
            self.surface(&format!("{name}.{surface}"), nodes.clone())?;
        }
        for (mark, node) in &placed.marks {
            let name = format!("{name}.{mark}");
            self.names.check_new(&name)?;
            self.names.groups.push((name, vec![*node]));
        }
        Ok(placed)
    }

    /// Names a surface, in node numbers of the mesh.
    ///
    /// # Errors
    /// When the name is taken or a node is not in the mesh.
    pub fn surface(&mut self, name: &str, surface: Surface) -> Result<(), Error> {
        self.names.check_new(name)?;
        self.check_nodes(&format!("surface `{name}`"), &surface.nodes)?;
        self.names.groups.push((name.to_owned(), surface.nodes.clone()));
        let name = name.to_owned();
        self.surfaces.push(NamedSurface { name, surface, smoothing: None, spline: false });
        Ok(())
    }

    /// Lets a surface stand for a smooth curve; with `spline` the curve moves as a spline of the nodes, else
    /// with each facet's two ends.
    ///
    /// # Errors
    /// When there is no surface of that name.
    pub fn smooth(&mut self, surface: &str, smoothing: Smoothing, spline: bool) -> Result<(), Error> {
        let at = self.find_surface(surface)?;
        (self.surfaces[at].smoothing, self.surfaces[at].spline) = (Some(smoothing), spline);
        Ok(())
    }

    /// Constrains the nodes of a body, a surface or a mark.
    ///
    /// # Errors
    /// When nothing has that name.
    pub fn constrain(&mut self, name: &str, motion: NodeMotion) -> Result<(), Error> {
        self.names.nodes(name)?.iter().for_each(|&n| self.model.motion[n as usize] = motion);
        Ok(())
    }

    /// Adds a contact pair of two surfaces.
    ///
    /// Two threads take pairs from either end of the list. The pair with by far the most work had better come
    /// first, and those of one body together.
    ///
    /// # Errors
    /// When there is no surface of one of the names.
    pub fn contact(&mut self, pair: Pair) -> Result<(), Error> {
        self.find_surface(&pair.first)?;
        self.find_surface(&pair.second)?;
        self.pairs.push(pair);
        Ok(())
    }

    /// Puts oil between a round body and a surface, with or without a contact of the two.
    ///
    /// # Errors
    /// When there is no surface of one of the names, or the centre is not in the mesh.
    pub fn film(&mut self, film: Film) -> Result<(), Error> {
        self.find_surface(&film.round)?;
        self.find_surface(&film.track)?;
        self.check_nodes(&format!("film of `{}`", film.round), &[film.centre])?;
        self.films.push(film);
        Ok(())
    }

    /// Pushes on a surface with `total` [N] in all, spread evenly over its length; the load has the name of
    /// the surface.
    ///
    /// # Errors
    /// When there is no surface of that name, or it has a load already.
    pub fn load(&mut self, surface: &str, total: [f64; 2]) -> Result<(), Error> {
        let at = self.find_surface(surface)?;
        self.add_load(surface, LoadedNodes::Surface(at, total))
    }

    /// Pushes on single nodes [N], as a load of its own name.
    ///
    /// # Errors
    /// When the name is that of another load, or a node is not in the mesh.
    pub fn load_nodes(&mut self, name: &str, forces: Vec<(u32, [f64; 2])>) -> Result<(), Error> {
        let nodes: Vec<u32> = forces.iter().map(|(node, _)| *node).collect();
        self.check_nodes(&format!("load `{name}`"), &nodes)?;
        self.add_load(name, LoadedNodes::Nodes(forces))
    }

    /// Adds a law of the user that may push on `nodes` and on no others. `make` is given their places in the
    /// arrays that forces see, in the same order.
    ///
    /// # Errors
    /// When a node is not in the mesh.
    pub fn force(
        &mut self,
        name: &str,
        nodes: Vec<u32>,
        make: impl FnOnce(&[u32]) -> Box<dyn Force + Send> + 'static,
    ) -> Result<(), Error> {
        self.check_nodes(&format!("force `{name}`"), &nodes)?;
        self.further.push(PlannedForce { name: name.to_owned(), nodes, make: Box::new(make) });
        Ok(())
    }

    /// Nodes of a body, a surface or a mark.
    ///
    /// # Errors
    /// When nothing has that name.
    pub fn nodes(&self, name: &str) -> Result<Vec<u32>, Error> {
        self.names.nodes(name)
    }

    /// Place of a surface among those named.
    pub(crate) fn find_surface(&self, name: &str) -> Result<usize, Error> {
        let found = self.surfaces.iter().position(|surface| surface.name == name);
        found.ok_or_else(|| unknown("surface", name, self.surfaces.iter().map(|surface| &*surface.name)))
    }

    fn add_load(&mut self, name: &str, on: LoadedNodes) -> Result<(), Error> {
        if self.loads.iter().any(|load| load.name == name) {
            return Err(Error::TwiceNamed { name: name.to_owned() });
        }
        self.loads.push(PlannedLoad { name: name.to_owned(), on });
        Ok(())
    }

    fn check_nodes(&self, what: &str, nodes: &[u32]) -> Result<(), Error> {
        let count = self.model.mesh.x.len();
        match nodes.iter().find(|&&n| n as usize >= count) {
            Some(&node) => Err(Error::UnknownNode { what: what.to_owned(), node, nodes: count }),
            None => Ok(()),
        }
    }
}
