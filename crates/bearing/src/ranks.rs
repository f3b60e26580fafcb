//! What the first of several ranks tells the others before a run.

use serde::{Deserialize, Serialize};
use stribeck_scene::scene::Scene;
pub use stribeck_solver::ranks::Ranks;
use stribeck_solver::ranks::broadcast;

use crate::{checkpoint::Checkpoint, error::Error, full::Saved, host::Host};

/// A run for all ranks.
#[derive(Serialize, Deserialize)]
struct Order {
    /// Text of the scene.
    scene: String,
    /// Where to go on from.
    checkpoint: Option<Checkpoint<Saved>>,
}

/// Lets all other ranks take part in a run of the scene, from its start or from a checkpoint.
pub(crate) fn lead(
    host: &Host<'_>,
    scene: &Scene,
    checkpoint: Option<&Checkpoint<Saved>>,
) -> Result<(), Error> {
    let Some(ranks) = &host.ranks else { return Ok(()) };
    let order = Order { scene: scene.to_ron(), checkpoint: checkpoint.cloned() };
    let bytes = postcard::to_allocvec(&order).map_err(|e| Error::Ranks(e.to_string()))?;
    broadcast(&**ranks, &bytes);
    Ok(())
}

/// The run that the first rank has called to.
pub(crate) fn called_to(ranks: &dyn Ranks) -> Result<(Scene, Option<Checkpoint<Saved>>), Error> {
    let bytes = broadcast(ranks, &[]);
    let Order { scene, checkpoint } =
        postcard::from_bytes(&bytes).map_err(|e| Error::Ranks(e.to_string()))?;
    Ok((Scene::parse(&scene, "the scene of the first rank")?, checkpoint))
}
