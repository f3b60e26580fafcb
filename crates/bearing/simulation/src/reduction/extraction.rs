//! A preloaded bearing taken apart: sets of nodes, their positions, and the forces on them.

use crate::bearing::assembly::{BearingSystem, unsupported};
use stribeck_mesh::Mesh;
use stribeck_scene::{housing::HousingScene, resolved::ResolvedScene};
use stribeck_solver::{
    Dynamics, Force,
    state::{Moment, NodeForces},
    statics::Spring,
};
use stribeck_system::Parts;

use crate::error::Error;

/// Node numbers, found by name while there is a system.
pub(crate) struct Nodes {
    /// Outer raceway, counter-clockwise.
    pub(crate) outer: Vec<u32>,
    /// Inner raceway, counter-clockwise.
    pub(crate) inner: Vec<u32>,
    /// Rim of roller 1.
    pub(crate) rim: Vec<u32>,
    /// Outer ring and housing.
    pub(crate) structure: Vec<u32>,
    pub(crate) outer_ring: Vec<u32>,
    pub(crate) inner_ring: Vec<u32>,
    /// Roller 1.
    pub(crate) roller: Vec<u32>,
    pub(crate) sensors: Vec<u32>,
    /// Outer surface of the outer ring.
    pub(crate) back: Vec<u32>,
}

/// Mass [kg] and moment of inertia [kg m²] of a rigid body, and its centre of mass [m].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inertia {
    pub(crate) mass_and_moment: [f64; 2],
    pub(crate) centre: [f64; 2],
}

/// Data of a bearing at its preload, read before it is taken apart.
pub(crate) struct Extraction {
    pub(crate) nodes: Nodes,
    /// Places of all nodes [m], and contact forces on them [N].
    pub(crate) places: Vec<[f64; 2]>,
    pub(crate) contact_forces: Vec<[f64; 2]>,
    /// Displacements of the nodes of rings and housing at the preload [m].
    pub(crate) moved: Vec<[f64; 2]>,
    /// Number of the pair of contact between the outer ring and its housing.
    pub(crate) seat_pair: Option<usize>,
    /// Force of the housing on the outer ring [N].
    pub(crate) seat: Option<[f64; 2]>,
    pub(crate) roller: Inertia,
    pub(crate) cage: Option<Inertia>,
    /// Centre of roller 1 [m].
    pub(crate) roller_centre: [f64; 2],
    /// Mass of outer ring and housing [kg].
    pub(crate) structure_mass: f64,
    /// Part of that mass whose weight the rollers carry [-].
    weighing: f64,
    /// Mass of the frame around springs [kg] and one of its nodes.
    pub(crate) frame: Option<(f64, u32)>,
    /// Slot of each node in the solver's order.
    slot_of: Vec<u32>,
}

/// Forces by slot at the preload [N], and the springs that hold it.
pub(crate) struct Preload {
    /// All forces, those of elements and contact included.
    pub(crate) all: NodeForces,
    pub(crate) load: NodeForces,
    pub(crate) outside: NodeForces,
    /// Springs of contact within the structure, one for each contact point that carries or may come to.
    pub(crate) seat: Vec<Spring>,
    /// How far the points of these springs are from touching [m].
    pub(crate) gaps: Vec<f64>,
    /// Springs of the housing.
    pub(crate) suspension: Vec<Spring>,
    /// Strain energy of all bodies and of the springs of the housing [J].
    pub(crate) strain: f64,
}

impl Extraction {
    /// Reads a preloaded bearing and takes it apart.
    pub(crate) fn of(
        scene: &ResolvedScene,
        mut bearing: BearingSystem,
        mesh: &Mesh,
    ) -> Result<(Self, Parts), Error> {
        let contact_forces = bearing.system.contact_forces();
        let resultants: Vec<[f64; 2]> = bearing.system.resultants().map(|r| r.force).collect();
        let nodes = Nodes::of(&bearing, scene)?;
        let system = &bearing.system;
        let places: Vec<[f64; 2]> = (0..system.node_count() as u32).map(|n| system.position(n)).collect();
        let of_rings = 0..mesh.bodies[bearing.rollers[0].body].nodes.start;
        let inertia = |body: usize| {
            let motion = system.motion_of(body);
            Inertia { mass_and_moment: [motion.mass, motion.inertia], centre: motion.centre }
        };
        let frame = match scene.written.housing {
            HousingScene::Springs(_) => bearing.housing.and_then(|body| {
                let mass = system.nodes_of(body).map(|n| system.mass(n)).sum::<f64>();
                Some((mass, system.nodes_of(body).next()?))
            }),
            _ => None,
        };
        let structure_mass = nodes.structure.iter().map(|&n| system.mass(n)).sum();
        let mut extraction = Self {
            moved: of_rings.map(|n| [places[n][0] - mesh.x[n], places[n][1] - mesh.y[n]]).collect(),
            seat_pair: bearing.pairs.seat(),
            seat: bearing.pairs.seat().map(|seat| resultants[seat]),
            roller: inertia(bearing.rollers[0].body),
            cage: bearing.cage.map(inertia),
            roller_centre: places[bearing.rollers[0].centre as usize],
            structure_mass,
            weighing: 1.0 - scene.on_foundation / structure_mass,
            frame,
            nodes,
            places,
            contact_forces,
            slot_of: Vec::new(),
        };
        // It is a part of the weight here: the load varies, and that does not.
        unsupported(&mut bearing.system, scene)?;
        let parts = bearing.system.into_parts();
        extraction.slot_of.clone_from(&parts.dynamics.layout().slot_of_node);
        Ok((extraction, parts))
    }

    /// Place of a node [m].
    pub(crate) fn place(&self, node: u32) -> [f64; 2] {
        self.places[node as usize]
    }

    /// Slot of a node in the solver's order.
    pub(crate) fn slot(&self, node: u32) -> u32 {
        self.slot_of[node as usize]
    }

    pub(crate) fn slots(&self, nodes: &[u32]) -> Vec<u32> {
        nodes.iter().map(|&n| self.slot(n)).collect()
    }
}

impl Preload {
    /// Forces and springs of a bearing taken apart, at its preload, with the springs of contact points nearer
    /// than `within` [m].
    pub(crate) fn of(extraction: &Extraction, parts: &mut Parts, mesh: &Mesh, within: f64) -> Self {
        let elastic = parts.dynamics.elastic_energy();
        let elastic = elastic.strain + elastic.hourglass;
        let count = parts.dynamics.state.x.len();
        // In the undeformed mesh springs of the housing are free of force: only the load remains.
        let mut load = NodeForces::zeros(count);
        let mut undeformed = parts.dynamics.state.clone();
        for (n, &slot) in extraction.slot_of.iter().enumerate() {
            (undeformed.x[slot as usize], undeformed.y[slot as usize]) = (mesh.x[n], mesh.y[n]);
        }
        let now = parts.dynamics.moment();
        parts.others.accumulate(Moment { x: &undeformed.x, y: &undeformed.y, ..now }, &mut load);
        let mut pushed = NodeForces::zeros(count);
        parts.others.accumulate(now, &mut pushed);
        let strain = elastic + parts.others.energy().stored;
        let mut outside = load.clone();
        let [gx, gy] = parts.dynamics.gravity();
        for (n, mass) in parts.dynamics.mass().iter().enumerate() {
            outside.fx[n] += mass * gx;
            outside.fy[n] += mass * gy;
        }
        for slot in extraction.slots(&extraction.nodes.structure) {
            outside.fy[slot as usize] -=
                (1.0 - extraction.weighing) * parts.dynamics.mass()[slot as usize] * gy;
        }
        let mut suspension = Vec::new();
        let (x, y) = (&parts.dynamics.state.x, &parts.dynamics.state.y);
        parts.others.tangent(x, y, &mut |piece| suspension.push(Spring::from(piece)));
        let mut all = NodeForces::zeros(count);
        let (seat, gaps) = Self::contact(extraction, parts, within, &mut all);
        let d: &Dynamics = &parts.dynamics;
        d.elastic_forces(&d.state.x, &d.state.y, &mut all.fx, &mut all.fy);
        for n in 0..count {
            all.fx[n] += outside.fx[n] + (pushed.fx[n] - load.fx[n]);
            all.fy[n] += outside.fy[n] + (pushed.fy[n] - load.fy[n]);
        }
        Self { all, load, outside, seat, gaps, suspension, strain }
    }

    /// Adds the forces of contact to `all`, and returns the springs of contact within the structure, with
    /// their gaps.
    fn contact(
        extraction: &Extraction,
        parts: &mut Parts,
        within: f64,
        all: &mut NodeForces,
    ) -> (Vec<Spring>, Vec<f64>) {
        let (mut springs, mut gaps) = (Vec::new(), Vec::new());
        let Some(contacts) = &mut parts.contacts else { return (springs, gaps) };
        contacts.accumulate(parts.dynamics.moment(), all);
        let Some(pair) = extraction.seat_pair else { return (springs, gaps) };
        let places = [&parts.dynamics.state.x[..], &parts.dynamics.state.y[..]];
        contacts.springs_within(pair, places, within, &mut |piece, gap| {
            springs.push(Spring::from(piece));
            gaps.push(gap.max(0.0));
        });
        (springs, gaps)
    }
}

impl Nodes {
    fn of(bearing: &BearingSystem, scene: &ResolvedScene) -> Result<Self, Error> {
        let system = &bearing.system;
        let named = |name: &str| system.nodes(name).map_err(Error::from);
        // The mesh walks the outer raceway clockwise, with the solid on the left.
        let mut outer = named("outer raceway")?;
        outer.reverse();
        Ok(Self {
            outer,
            inner: named("inner raceway")?,
            rim: named("rim of roller 1")?,
            structure: std::iter::once(bearing.outer)
                .chain(bearing.housing)
                .flat_map(|body| system.nodes_of(body))
                .collect(),
            outer_ring: system.nodes_of(bearing.outer).collect(),
            inner_ring: system.nodes_of(bearing.inner).collect(),
            roller: system.nodes_of(bearing.rollers[0].body).collect(),
            sensors: bearing.nodes_on_back(&scene.sensor_angles),
            back: bearing.back.clone(),
        })
    }
}
