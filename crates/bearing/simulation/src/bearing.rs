//! Rolling element bearings of finite elements: from a scene to bodies in equilibrium under load, set
//! rolling.
//!
//! ```
//! use stribeck_scene::Scene;
//! use stribeck_simulation::bearing::assembly::Assembly;
//!
//! let scene = Scene::parse("(mesh: (size_mm: 3.0, roller_facets: 48))", "coarse.ron")?.resolve();
//! assert!(Assembly::new(&scene)?.mesh_info().nodes > 1000);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod assembly;
mod grading;
mod housing;
pub mod own_mesh;
pub mod start;
mod suspension;
