//! From a plan to a system: mesh numbers become places in memory, here and nowhere else.

use stribeck_contact::{Contacts, FilmSpec, Films, PairSpec, Surface};
use stribeck_solver::{Dynamics, force::NodalLoad};

use crate::{
    error::Error,
    forces::Forces,
    load::Load,
    names::unknown,
    plan::{Film, LoadedNodes, NamedSurface, Pair, Plan, PlannedForce, PlannedLoad},
    system::System,
};

impl Plan {
    /// Lays everything out for `threads` workers. With more than one, take steps within
    /// [`Workers`](crate::Workers) of as many.
    ///
    /// # Errors
    /// When the solver or contact refuses something.
    pub fn build(self, threads: usize) -> Result<System, Error> {
        let announced = self.announced();
        let Self {
            model,
            stiffness_damping,
            structural_damping,
            names,
            surfaces,
            pairs,
            films,
            loads,
            further,
        } = self;
        let mut dynamics = Dynamics::new(&model, &announced, threads)?;
        dynamics.set_stiffness_damping(stiffness_damping)?;
        dynamics.set_structural_damping(structural_damping.as_ref())?;
        let slots = |nodes: &[u32]| -> Vec<u32> {
            nodes.iter().map(|&n| dynamics.layout().slot_of_node[n as usize]).collect()
        };
        let (x, y) = (&dynamics.state.x, &dynamics.state.y);
        let loads = loads.into_iter().map(|PlannedLoad { name, on }| {
            let pushes = match on {
                LoadedNodes::Surface(at, total) => {
                    let surface = &surfaces[at].surface;
                    let mut along = slots(&surface.nodes);
                    along.extend_from_within(..usize::from(surface.closed));
                    NodalLoad::on_edge(&along, x, y, total).loads().to_vec()
                }
                LoadedNodes::Nodes(forces) => {
                    let slot = |node: u32| dynamics.layout().slot_of_node[node as usize];
                    forces.iter().map(|&(node, [fx, fy])| (slot(node), fx, fy)).collect()
                }
            };
            Load::new(name, pushes)
        });
        let loads = loads.collect();
        let further = further
            .into_iter()
            .map(|PlannedForce { name, nodes, make }| (name, make(&slots(&nodes))))
            .collect();
        // Surfaces that no pair names are no work for contact.
        let touching: Vec<&NamedSurface> = surfaces
            .iter()
            .filter(|s| pairs.iter().any(|pair| pair.first == s.name || pair.second == s.name))
            .collect();
        let facets = touching.iter().flat_map(|s| (0..s.surface.facets()).map(|f| s.surface.facet(f)));
        let shortest_facet = facets
            .map(|ends| ends.map(|n| n as usize))
            .map(|[a, b]| libm::hypot(model.mesh.x[a] - model.mesh.x[b], model.mesh.y[a] - model.mesh.y[b]))
            .fold(f64::INFINITY, f64::min);
        let specs = pairs.iter().map(|pair| spec(pair, &touching)).collect::<Result<Vec<_>, _>>()?;
        let mut contacts = None;
        if !specs.is_empty() {
            let curves = touching.iter().map(|s| {
                let surface = Surface::new(s.name.clone(), slots(&s.surface.nodes), s.surface.closed, x, y)?;
                let surface = match s.smoothing {
                    Some(smoothing) => surface.smoothed(smoothing, x, y)?,
                    None => surface,
                };
                Ok(if s.spline { surface.splined(x, y) } else { surface })
            });
            let curves = curves.collect::<Result<Vec<_>, Error>>()?;
            let mut all = Contacts::new(curves, &specs, model.thickness, x, y)?;
            all.set_parallel(threads > 1);
            contacts = Some(all);
        }
        let mut oil = None;
        if !films.is_empty() {
            let oiled = films.iter().flat_map(|film| [&film.round, &film.track]);
            let oiled: Vec<&NamedSurface> =
                surfaces.iter().filter(|s| oiled.clone().any(|name| *name == s.name)).collect();
            let find =
                |name: &str| oiled.iter().position(|s| s.name == name).expect("a film names its surfaces");
            let specs =
                films.iter().map(|Film { round, centre, track, oil, stiffness, length, speed }| FilmSpec {
                    round: find(round),
                    centre: dynamics.layout().slot_of_node[*centre as usize],
                    track: find(track),
                    oil: *oil,
                    stiffness: *stiffness,
                    length: *length,
                    speed: *speed,
                });
            let curves = oiled
                .iter()
                .map(|s| Surface::new(s.name.clone(), slots(&s.surface.nodes), s.surface.closed, x, y));
            let curves = curves.collect::<Result<Vec<_>, _>>()?;
            oil = Some(Films::new(curves, &specs.collect::<Vec<_>>(), model.thickness, x, y)?);
        }
        let forces = Forces { loads, contacts, films: oil, further };
        let pairs = pairs.into_iter().map(|pair| pair.name).collect();
        Ok(System::new(dynamics, forces, names, model.behaviour, pairs, shortest_facet))
    }

    /// Which nodes forces may push: those of contact surfaces, of films, of loads and of the user's laws.
    fn announced(&self) -> Vec<bool> {
        let mut announced = vec![false; self.model.mesh.x.len()];
        let oiled = self.films.iter().flat_map(|film| [&film.round, &film.track]);
        let touching = self.pairs.iter().flat_map(|pair| [&pair.first, &pair.second]).chain(oiled);
        let touching = self.surfaces.iter().filter(|s| touching.clone().any(|name| *name == s.name));
        let touching = touching.flat_map(|s| s.surface.nodes.iter().copied());
        let loaded = self.loads.iter().flat_map(|load| match &load.on {
            LoadedNodes::Surface(at, _) => self.surfaces[*at].surface.nodes.clone(),
            LoadedNodes::Nodes(forces) => forces.iter().map(|(node, _)| *node).collect(),
        });
        let further = self.further.iter().flat_map(|force| force.nodes.iter().copied());
        touching.chain(loaded).chain(further).for_each(|n| announced[n as usize] = true);
        announced
    }
}

/// A pair with the places of its surfaces in the list of those that touch.
fn spec(pair: &Pair, touching: &[&NamedSurface]) -> Result<PairSpec, Error> {
    let find = |name: &str| {
        let found = touching.iter().position(|s| s.name == name);
        found.ok_or_else(|| unknown("surface", name, touching.iter().map(|s| &*s.name)))
    };
    let Pair { law, method, sides, .. } = *pair;
    Ok(PairSpec { first: find(&pair.first)?, second: find(&pair.second)?, law, method, sides })
}
