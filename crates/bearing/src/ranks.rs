//! One run over several ranks: the first reads and writes files, all others follow it.

use serde::{Deserialize, Serialize};
use stribeck_scene::scene::Scene;
pub use stribeck_solver::ranks::Ranks;
use stribeck_solver::ranks::broadcast;

use crate::{
    checkpoint::Checkpoint,
    error::Error,
    full::{Full, Saved},
    host::Host,
    simulation::{Prepared, prepare, prepare_again},
    time_loop::Run,
};

/// What the first rank tells the others before the first step.
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

/// Whether the run ends here: what the first rank says.
pub(crate) fn agree(host: &Host<'_>, stop: bool) -> bool {
    host.ranks.as_ref().map_or(stop, |ranks| broadcast(&**ranks, &[u8::from(stop)]) == [1])
}

/// Takes part in the run that the first rank begins or continues ([`crate::simulation::simulate`]), to its end; nothing is
/// written here. For all ranks but the first.
///
/// # Errors
/// Where the first rank has an error too, but for those of its files.
pub fn follow(host: &Host<'_>) -> Result<(), Error> {
    let Some(ranks) = &host.ranks else { return Ok(()) };
    let bytes = broadcast(&**ranks, &[]);
    let Order { scene, checkpoint } =
        postcard::from_bytes(&bytes).map_err(|e| Error::Ranks(e.to_string()))?;
    let scene = Scene::parse(&scene, "the scene of the first rank")?;
    match checkpoint {
        None => {
            let Prepared { assembly, machine, setup, .. } = prepare(&scene, host, &mut |_| {})?;
            let full = Full::start(&scene, &assembly, machine, None, host);
            Run::follow(full, setup.info(&scene, host), host)
        }
        Some(Checkpoint { info, motion }) => {
            let (assembly, machine) = prepare_again(&scene, host, &info)?;
            let full = Full::resume(&scene, &assembly, machine, &info, motion, None, host)?;
            Run::follow(full, info, host)
        }
    }
}
