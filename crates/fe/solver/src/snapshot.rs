//! The whole state in time, from which a model in motion continues to the same bits.

use serde::{Deserialize, Serialize};

use crate::{
    damping::PlacedFrame,
    dynamics::Dynamics,
    error::{Error, check_count},
    rigid::RigidState,
    state::{Accumulated, SpringState, State},
};

/// Everything about a model in motion that changes in time. The model, its time step and its damping are no
/// part of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    state: State,
    rigid: Vec<RigidState>,
    drive: Accumulated,
    heat: Accumulated,
    /// Step at which the damping frames were last placed, and where, one for each damped body.
    frames: Option<(u64, Vec<PlacedFrame>)>,
}

impl Snapshot {
    /// Steps taken until then.
    pub fn step(&self) -> u64 {
        self.state.step
    }
}

impl Dynamics {
    /// The present state.
    pub fn snapshot(&self) -> Snapshot {
        let placed = |&(tile, lane): &(usize, usize)| {
            let damping = self.tiles[tile].damping.as_ref();
            damping.map_or_else(PlacedFrame::default, |d| d.frames.placed(lane))
        };
        // The places of one body share its frame.
        let bodies = self.damped.iter().flatten();
        let frames =
            bodies.map(|body| body.places.first().map_or_else(PlacedFrame::default, placed)).collect();
        Snapshot {
            state: self.state.clone(),
            rigid: self.rigid.clone(),
            drive: self.drive,
            heat: self.heat,
            frames: self.frames_placed.map(|step| (step, frames)),
        }
    }

    /// Continues from a snapshot of the same model. Set the time step and the dampings before.
    ///
    /// # Errors
    /// When the snapshot has other numbers of slots, rigid bodies or damped bodies; nothing is changed then.
    pub fn restore(&mut self, from: Snapshot) -> Result<(), Error> {
        let (slots, s) = (self.state.x.len(), &from.state);
        for field in [&s.x, &s.y, &s.vx, &s.vy] {
            check_count("slots of the snapshot", field.len(), slots, "those of the model")?;
        }
        let SpringState { path, held: forces, spins, .. } = &s.springs;
        let (spins, springs) = (spins.len(), self.springs.as_ref());
        let [branches, own] = [path, &self.state.springs.path].map(|path| usize::from(path.is_some()));
        check_count("branches of the snapshot", branches, own, "those of the structural damping")?;
        let held = if own == 0 { 0 } else { slots };
        for len in path.iter().flatten().map(|path| path.len()).chain(forces.each_ref().map(|f| f.len())) {
            check_count("slots of the snapshot", len, held, "those of the model")?;
        }
        let bodies = if spins == 0 { 0 } else { springs.map_or(0, |springs| springs.bodies.len()) };
        check_count("spins of the snapshot", spins, bodies, "one for each body with structural damping")?;
        let (found, bodies) = (from.rigid.len(), self.rigid.len());
        check_count("rigid bodies of the snapshot", found, bodies, "those of the model")?;
        let damped = self.damped.as_deref().unwrap_or_default();
        if let Some((_, frames)) = &from.frames {
            let (found, bodies) = (frames.len(), damped.len());
            check_count("damping frames of the snapshot", found, bodies, "one for each damped body")?;
            for (body, frame) in damped.iter().zip(frames) {
                for &(tile, lane) in &body.places {
                    if let Some(d) = &mut self.tiles[tile].damping {
                        d.frames.put(lane, *frame);
                    }
                }
            }
        }
        self.frames_placed = from.frames.map(|(step, _)| step);
        self.state = from.state;
        self.hand_out_spins();
        self.rigid = from.rigid;
        self.drive = from.drive;
        self.heat = from.heat;
        Ok(())
    }
}
