//! Housings, which hold the outer ring and take the load: the paper's adapter, and others.
//!
//! The inner ring turns about a fixed centre, and the load pushes the housing towards it, as on a wheel or
//! under the paper's adapter. A load on the shaft in a stationary housing is the same seen from the shaft.

use super::BearingScene;
use super::machine::MachineScene;
use crate::{group, words};

words! {
    /// The housing, which holds the outer ring and takes the load.
    pub enum HousingScene: Default {
        /// The block of `adapter` on top of the ring, loaded on its top edge.
        #[default]
        Adapter = "adapter",
        /// A block with a bore for the ring, loaded on its base.
        Pedestal(of: PedestalScene) = "pedestal",
        /// An elastic housing of any shape, whose mesh is read from a file.
        Mesh(of: MeshHousingScene) = "mesh",
        /// A housing that does not deform, nor does the ring in it; the only one that may turn.
        Rigid(of: RigidHousingScene) = "rigid",
        /// Springs and dampers all around the ring, to a frame that does not deform and takes the load.
        Springs(of: SpringHousingScene) = "springs",
        /// A heavy housing of a machine with a sensor: as `rigid`, and a path from the force on it to the sensor.
        Machine(of: MachineScene) = "machine",
    }
}

group! {
    /// A block with a bore for the ring. Its base is guided: it moves up and down, not sideways.
    pub struct PedestalScene {
        /// Width [mm].
        pub width_mm: f64 = 320.0, positive(50_000.0);
        /// From the centre of the bearing down to the base [mm].
        pub base_mm: f64 = 160.0, positive(50_000.0);
        /// From the centre of the bearing up to the top [mm].
        pub top_mm: f64 = 140.0, positive(50_000.0);
    }
}

group! {
    /// An elastic housing from a Gmsh or Abaqus file of plane quadrilaterals and triangles, with the
    /// centre of the bearing in the origin. Its material is that of the bearing.
    pub struct MeshHousingScene {
        /// The file, `.msh` or `.inp`; its path counts from the folder of the scene.
        pub file: String = String::new();
        /// Length unit of the file [mm]: 1 for files in millimetres, 1000 for metres.
        pub unit_mm: f64 = 1.0, positive(1e6);
        /// Content of the file, inserted when a scene is read, so that a run holds its complete scene.
        pub text: String = String::new(), internal(), omitted();
        /// Name of the set of nodes along the bore.
        pub bore: String = "bore".into();
        /// Name of the set of nodes along the edge that takes the load, and is guided up and down.
        pub loaded: String = "loaded".into();
    }
}

group! {
    /// A housing that does not deform, nor does the ring in it. It may move in any direction.
    pub struct RigidHousingScene {
        /// Mass that moves with the outer ring, on top of the ring's own [kg].
        pub mass_kg: f64 = 0.0, within(0.0, 1e6);
        /// Damping of its motion by what it stands on, over the mass [1/s]: 2ζω, 1000 for 5 % at 1.6 kHz.
        pub damping_per_s: f64 = 0.0, within(0.0, 1e5), omitted();
    }
}

group! {
    /// Springs and dampers all around the ring, evenly spread, to a frame that does not deform or turn and
    /// takes the load. Each spring holds its node of the ring in every direction.
    pub struct SpringHousingScene {
        /// Stiffness of all springs together against a shift of the ring [N/µm].
        pub stiffness_n_um: f64 = 1000.0, positive(1e6);
        /// Damping of all dampers together against a shift of the ring [N s/m].
        pub damping_n_s_m: f64 = 1000.0, within(0.0, 1e9);
        /// Mass of the frame [kg].
        pub mass_kg: f64 = 10.0, within(1e-3, 1e6);
    }
}

impl HousingScene {
    /// Whether it is the paper's.
    pub fn is_adapter(&self) -> bool {
        *self == Self::Adapter
    }

    /// Whether the outer ring does not deform.
    pub fn is_rigid(&self) -> bool {
        matches!(self, Self::Rigid(_) | Self::Machine(_))
    }

    /// The mass about a ring that does not deform; `None` where it does.
    pub fn mass(&self, bearing: &BearingScene) -> Option<RigidHousingScene> {
        match self {
            Self::Rigid(rigid) => Some(rigid.clone()),
            Self::Machine(machine) => Some(machine.mass(bearing)),
            _ => None,
        }
    }

    /// Mass whose weight a foundation carries, not the bearing [kg]: that of a machine.
    pub fn on_foundation_kg(&self, bearing: &BearingScene) -> f64 {
        self.machine().map_or(0.0, |machine| machine.mass(bearing).mass_kg)
    }

    /// The machine, where there is one.
    pub fn machine(&self) -> Option<&MachineScene> {
        match self {
            Self::Machine(machine) => Some(machine),
            _ => None,
        }
    }

    /// Whether the outer ring sits in it, and may slip.
    pub fn has_seat(&self) -> bool {
        matches!(self, Self::Adapter | Self::Pedestal(_) | Self::Mesh(_))
    }

    /// Whether the load may come from any direction. Edges of elastic housings are guided up and down.
    pub fn takes_any_direction(&self) -> bool {
        self.is_rigid() || matches!(self, Self::Springs(_))
    }
}

/// Direction of the load that the adapter takes [°]: downwards.
pub const DOWN_DEG: f64 = 270.0;
