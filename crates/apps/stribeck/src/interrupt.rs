//! Ctrl-C.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Context, Result};
use stribeck_store::run_dir::Reservation;

/// Exit code of a program ended by Ctrl-C.
pub const EXIT_CODE: u8 = 130;

/// A command was ended by Ctrl-C and would go on from where it was.
#[derive(Debug, Clone, Copy)]
pub struct Interrupted;

impl std::fmt::Display for Interrupted {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str("interrupted; the same command goes on from here")
    }
}

impl std::error::Error for Interrupted {}

/// Whether Ctrl-C was pressed. The first asks for an end in good order, the second ends the program.
#[derive(Debug, Clone)]
pub struct Interrupt(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    pressed: AtomicBool,
    /// The place of a run that need not be waited for before its first step.
    place: Mutex<Option<Reservation>>,
}

impl Interrupt {
    /// Listens from now on; once a process.
    pub fn listen() -> Result<Self> {
        let shared = Arc::new(Shared::default());
        let seen = Arc::clone(&shared);
        ctrlc::set_handler(move || {
            if seen.pressed.swap(true, Ordering::SeqCst) {
                exit();
            }
            seen.end_before_the_first_step();
            eprintln!("\ninterrupted: ending in good order; press Ctrl-C again to stop at once");
        })
        .context("cannot listen for Ctrl-C")?;
        Ok(Self(shared))
    }

    /// Makes Ctrl-C end the program at once until the run in `place` takes its first step; files made for it
    /// are removed.
    pub fn need_not_wait_for(&self, place: Reservation) {
        *self.0.place.lock().unwrap_or_else(PoisonError::into_inner) = Some(place);
        // It may have been pressed while the place was made.
        if self.is_pressed() {
            self.0.end_before_the_first_step();
        }
    }

    /// Whether it was pressed.
    pub fn is_pressed(&self) -> bool {
        self.0.pressed.load(Ordering::SeqCst)
    }

    /// Whether a watched run continues.
    pub fn flow(&self) -> ControlFlow<()> {
        if self.is_pressed() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Shared {
    fn end_before_the_first_step(&self) {
        if let Some(place) = &*self.place.lock().unwrap_or_else(PoisonError::into_inner) {
            place.unless_started(|| {
                eprintln!("\ninterrupted before the first step: nothing was changed");
                exit();
            });
        }
    }
}

/// Lets a file that may not grow further (`ulimit -f`) be an error of writing, with words, as a full disk is: by
/// default the signal that says so ends the program.
pub fn outlive_full_files() {
    // Where it cannot be caught, it ends the program as before.
    #[cfg(unix)]
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default()).ok();
}

fn exit() -> ! {
    std::process::exit(i32::from(EXIT_CODE))
}
