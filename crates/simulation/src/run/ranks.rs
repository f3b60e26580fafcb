//! Runs over several ranks: before a run the first rank broadcasts its scene and checkpoint, and the others
//! follow it.

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use stribeck_scene::scene::Scene;
pub use stribeck_solver::ranks::Ranks;
use stribeck_solver::ranks::broadcast;

use crate::run::{checkpoint::Checkpoint, error::Error, host::Host};

/// The order that the first rank broadcasts.
#[derive(Serialize, Deserialize)]
struct Order<S> {
    /// Text of the scene.
    scene: String,
    /// Where to continue from.
    checkpoint: Option<Checkpoint<S>>,
}

/// Sends all other ranks the order to take part in a run of the scene, from its start or from a checkpoint.
///
/// # Errors
/// When the order cannot be encoded.
pub fn lead<S: Serialize + Clone>(
    host: &Host<'_>,
    scene: &Scene,
    checkpoint: Option<&Checkpoint<S>>,
) -> Result<(), Error> {
    let Some(ranks) = &host.ranks else { return Ok(()) };
    let order = Order { scene: scene.to_ron(), checkpoint: checkpoint.cloned() };
    let bytes = postcard::to_allocvec(&order).map_err(|e| Error::Ranks(e.to_string()))?;
    broadcast(&**ranks, &bytes);
    Ok(())
}

/// The run that the first rank leads.
///
/// # Errors
/// When its order is not that of this program.
pub fn called_to<S: DeserializeOwned>(ranks: &dyn Ranks) -> Result<(Scene, Option<Checkpoint<S>>), Error> {
    let bytes = broadcast(ranks, &[]);
    let Order { scene, checkpoint } =
        postcard::from_bytes(&bytes).map_err(|e| Error::Ranks(e.to_string()))?;
    Ok((Scene::parse(&scene, "the scene of the first rank")?, checkpoint))
}
