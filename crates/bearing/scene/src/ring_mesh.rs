//! Rings whose mesh comes from a file.

use crate::fields::group;

group! {
    /// A ring from a Gmsh or Abaqus file of plane quadrilaterals and triangles, with the centre of
    /// the bearing in the origin. Its material is that of the bearing, its raceway the circle of `bearing`,
    /// with the cut-outs of the file.
    pub struct RingMeshScene {
        /// The file, `.msh` or `.inp`; its path counts from the folder of the scene.
        pub file: String = String::new();
        /// Length unit of the file [mm]: 1 for files in millimetres, 1000 for metres.
        pub unit_mm: f64 = 1.0, positive(1e6);
        /// Content of the file, inserted when a scene is read, so that a run holds its complete scene.
        pub text: String = String::new(), internal(), omitted();
        /// Name of the set of nodes all along the raceway.
        pub raceway: String = "raceway".into();
        /// Name of the set of nodes all along the other side: the outer ring's back, which sits in the
        /// housing, or the inner ring's bore, which turns with the shaft.
        pub fit: String = "fit".into();
    }
}
