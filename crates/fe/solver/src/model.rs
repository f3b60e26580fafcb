//! Input of the solver: a mesh, materials, elastic or rigid bodies, and the motion of nodes.

use std::f64::consts::PI;

use stribeck_mesh::Mesh;

use crate::{
    element::{QuadReference, Stiffness, TriangleReference, bad},
    error::{Error, check, check_count},
    material::Elastic,
};

/// How a body behaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Behaviour {
    /// Deforms elastically.
    Elastic,
    /// Moves as one piece; its elements give mass only.
    Rigid,
    /// The same, but it turns at `rate` whatever pushes on it: a ring that is fixed to its housing, or driven
    /// with it.
    Turning {
        /// Angular velocity [rad/s], counter-clockwise positive.
        rate: f64,
        /// Rate at which its centre is braked [1/s]: a damper to the ground, over the mass.
        braking: f64,
    },
}

impl Behaviour {
    /// Whether the body deforms.
    pub fn is_elastic(self) -> bool {
        self == Self::Elastic
    }
}

/// How a node may move.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum NodeMotion {
    /// By its forces.
    #[default]
    Free,
    /// By its forces, x held.
    HeldX,
    /// By its forces, y held.
    HeldY,
    /// Not at all.
    Held,
    /// On a circle about `centre` [m] at `rate` [rad/s], counter-clockwise positive.
    Rotating {
        /// Centre of rotation [m].
        centre: [f64; 2],
        /// Angular velocity [rad/s].
        rate: f64,
    },
}

/// A mesh with materials, behaviour and constraints.
#[derive(Debug, Clone)]
pub struct Model {
    /// The mesh; positions are the stress-free reference.
    pub mesh: Mesh,
    /// Material of each body.
    pub materials: Vec<Elastic>,
    /// Behaviour of each body.
    pub behaviour: Vec<Behaviour>,
    /// Motion of each node.
    pub motion: Vec<NodeMotion>,
    /// Out-of-plane thickness [m].
    pub thickness: f64,
    /// Hourglass stiffness, 1 = exact bending of a square.
    pub hourglass_scale: f64,
    /// Acceleration of gravity [m/s²].
    pub gravity: [f64; 2],
}

impl Model {
    /// All bodies elastic, of one material, all nodes free, no gravity.
    ///
    /// # Errors
    /// When the thickness is not positive.
    pub fn new(mesh: Mesh, material: Elastic, thickness: f64) -> Result<Self, Error> {
        check("thickness [m]", thickness, thickness > 0.0, "positive")?;
        let (bodies, nodes) = (mesh.bodies.len(), mesh.x.len());
        Ok(Self {
            mesh,
            materials: vec![material; bodies],
            behaviour: vec![Behaviour::Elastic; bodies],
            motion: vec![NodeMotion::Free; nodes],
            thickness,
            hourglass_scale: 1.0,
            gravity: [0.0; 2],
        })
    }

    /// Element constants of a body.
    pub fn stiffness(&self, body: usize) -> Stiffness {
        Stiffness::new(&self.materials[body], self.thickness, self.hourglass_scale)
    }

    /// Corner positions of element `e` [m].
    pub(crate) fn corners<const N: usize>(&self, e: &[u32; N]) -> [[f64; 2]; N] {
        e.map(|n| [self.mesh.x[n as usize], self.mesh.y[n as usize]])
    }

    /// References of all quadrilaterals and triangles, in mesh order. Quadrilaterals that follow one another
    /// with the same shape but for rounding share one reference: an element then has the same forces whether
    /// it is computed in a strip or alone, and their sum over the body is zero.
    pub(crate) fn references(&self) -> Result<(Vec<QuadReference>, Vec<TriangleReference>), Error> {
        let mut quads = Vec::with_capacity(self.mesh.quads.len());
        let mut triangles = Vec::with_capacity(self.mesh.triangles.len());
        for body in &self.mesh.bodies {
            for e in body.quads.clone() {
                let corners = self.corners(&self.mesh.quads[e]);
                let new = QuadReference::new(&corners, self.thickness).map_err(bad(&body.name, e))?;
                let before = quads.last().copied().filter(|before: &QuadReference| before.is_congruent(&new));
                quads.push(before.unwrap_or(new));
            }
            for e in body.triangles.clone() {
                let corners = self.corners(&self.mesh.triangles[e]);
                triangles.push(TriangleReference::new(&corners, self.thickness).map_err(bad(&body.name, e))?);
            }
        }
        Ok((quads, triangles))
    }

    /// Lumped mass of every node [kg]: a quarter of each quadrilateral, a third of each triangle.
    pub(crate) fn masses(
        &self,
        quads: &[QuadReference],
        triangles: &[TriangleReference],
    ) -> Result<Vec<f64>, Error> {
        let mut mass = vec![0.0; self.mesh.x.len()];
        for (b, body) in self.mesh.bodies.iter().enumerate() {
            let density = self.materials[b].density();
            for e in body.quads.clone() {
                for n in self.mesh.quads[e] {
                    mass[n as usize] += 0.25 * density * quads[e].volume;
                }
            }
            for e in body.triangles.clone() {
                for n in self.mesh.triangles[e] {
                    mass[n as usize] += density * triangles[e].volume / 3.0;
                }
            }
            let massless = |&n: &usize| mass[n] <= 0.0;
            let node = match self.behaviour[b] {
                Behaviour::Elastic => body.nodes.clone().find(massless),
                // A rigid body may have nodes that only carry contact, but needs some mass.
                Behaviour::Rigid | Behaviour::Turning { .. } => {
                    body.nodes.clone().all(|n| massless(&n)).then_some(body.nodes.start)
                }
            };
            if let Some(node) = node {
                return Err(Error::MasslessNode { body: body.name.clone(), node });
            }
        }
        Ok(mass)
    }

    /// Checks that bodies follow each other and elements use nodes of their own body.
    fn check_mesh(&self) -> Result<(), Error> {
        let mesh = &self.mesh;
        check_count("ordinates of the mesh", mesh.y.len(), mesh.x.len(), "as many as abscissae")?;
        let (mut nodes, mut quads, mut triangles) = (0, 0, 0);
        for body in &mesh.bodies {
            let starts =
                [(body.nodes.start, nodes), (body.quads.start, quads), (body.triangles.start, triangles)];
            let ends = [body.nodes.end, body.quads.end, body.triangles.end];
            let follows =
                starts.iter().zip(ends).all(|((start, before), end)| start == before && end >= *start);
            [nodes, quads, triangles] = ends;
            let lengths = [mesh.x.len(), mesh.quads.len(), mesh.triangles.len()];
            if !follows || ends.iter().zip(lengths).any(|(end, length)| *end > length) {
                return Err(Error::BadBody { body: body.name.clone() });
            }
            let owns = |corners: &[u32]| corners.iter().all(|&n| body.nodes.contains(&(n as usize)));
            let quad = body.quads.clone().find(|&e| !owns(&mesh.quads[e]));
            let element = quad.or_else(|| body.triangles.clone().find(|&e| !owns(&mesh.triangles[e])));
            if let Some(element) = element {
                return Err(Error::BadNode { body: body.name.clone(), element });
            }
        }
        check_count("nodes of all bodies", nodes, mesh.x.len(), "all nodes of the mesh")?;
        check_count("quadrilaterals of all bodies", quads, mesh.quads.len(), "all of the mesh")?;
        check_count("triangles of all bodies", triangles, mesh.triangles.len(), "all of the mesh")
    }

    /// Checks numbers that the fields allow but the solver does not.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let (bodies, nodes) = (self.mesh.bodies.len(), self.mesh.x.len());
        check_count("number of materials", self.materials.len(), bodies, "one for each body of the mesh")?;
        check_count("number of behaviours", self.behaviour.len(), bodies, "one for each body of the mesh")?;
        check_count("number of motions", self.motion.len(), nodes, "one for each node of the mesh")?;
        self.check_mesh()?;
        check("thickness [m]", self.thickness, self.thickness > 0.0, "positive")?;
        check("hourglass scale", self.hourglass_scale, self.hourglass_scale >= 0.0, "zero or positive")?;
        check("gravity x [m/s²]", self.gravity[0], true, "finite")?;
        check("gravity y [m/s²]", self.gravity[1], true, "finite")?;
        for motion in &self.motion {
            if let NodeMotion::Rotating { rate, .. } = motion {
                check_rate(*rate)?;
            }
        }
        for behaviour in &self.behaviour {
            if let Behaviour::Turning { rate, braking } = behaviour {
                check_rate(*rate)?;
                check("braking of a body [1/s]", *braking, *braking >= 0.0, "zero or positive")?;
            }
        }
        Ok(())
    }
}

/// Checks the rate of rotating nodes [rad/s].
pub(crate) fn check_rate(rate: f64) -> Result<(), Error> {
    // Half a turn a microsecond is far beyond any machine and still harmless.
    check("rotation rate [rad/s]", rate, rate.abs() < 1e6 * PI, "below π·10⁶")
}
