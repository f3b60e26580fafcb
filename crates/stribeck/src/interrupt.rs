//! Ctrl-C.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use stribeck_scene::run_dir::Reservation;

/// What a shell reports for a program ended by Ctrl-C.
pub const EXIT_CODE: u8 = 130;

/// Whether Ctrl-C was pressed.
#[derive(Debug, Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens from now on; once a process. The first Ctrl-C asks for an end in good order, or ends the program at once
    /// when the run in `place` has not taken a step; the second ends it in any case.
    ///
    /// # Errors
    /// When the system does not allow it.
    pub fn listen(place: Option<Reservation>) -> Result<Self> {
        let flag = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&flag);
        let exit = || std::process::exit(i32::from(EXIT_CODE));
        ctrlc::set_handler(move || {
            if seen.swap(true, Ordering::Relaxed) {
                exit();
            }
            if let Some(place) = &place {
                place.unless_started(|| {
                    eprintln!("\ninterrupted before the first step: nothing was changed");
                    exit();
                });
            }
            eprintln!("\ninterrupted: finishing the step; press Ctrl-C again to stop at once");
        })
        .context("cannot listen for Ctrl-C")?;
        Ok(Self(flag))
    }

    /// Whether it was pressed.
    pub fn is_pressed(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// What a watched run is to do.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.is_pressed() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
