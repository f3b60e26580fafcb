//! The names that the page calls. Numbers come as they are; arrays are read from the memory of the module at
//! the address and of the length that a call gives.
#![allow(unsafe_code, reason = "a name that a module exports is an unsafe attribute; nothing else here is")]

use std::cell::RefCell;

use crate::{content::Content, engine::Engine, error::Error, readings};

/// The bearing of this module, and what was last handed over.
#[derive(Default)]
struct Lab {
    engine: Option<Engine>,
    input: Vec<u8>,
    numbers: Vec<f64>,
    text: String,
}

thread_local! {
    static LAB: RefCell<Lab> = RefCell::default();
}

/// Runs `task`; returns `u32::MAX` on error and stores the message.
fn with(task: impl FnOnce(&mut Lab) -> Result<u32, Error>) -> u32 {
    LAB.with_borrow_mut(|lab| match task(lab) {
        Ok(value) => value,
        Err(error) => {
            lab.text = error.to_string();
            u32::MAX
        }
    })
}

fn with_engine(task: impl FnOnce(&mut Engine) -> Result<u32, Error>) -> u32 {
    with(|lab| lab.engine.as_mut().map_or(Ok(u32::MAX), task))
}

/// Hands over numbers: their address; how many there are says `lab_length`.
fn hand_over(numbers: impl FnOnce(&mut Engine) -> Vec<f64>) -> *const f64 {
    LAB.with_borrow_mut(|lab| {
        lab.numbers = lab.engine.as_mut().map_or_else(Vec::new, numbers);
        lab.numbers.as_ptr()
    })
}

/// Allocates this number of bytes for a bearing.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_input(bytes: usize) -> *mut u8 {
    LAB.with_borrow_mut(|lab| {
        lab.input = vec![0; bytes];
        lab.input.as_mut_ptr()
    })
}

/// Opens the bearing whose bytes were written there.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_open() -> u32 {
    with(|lab| {
        let bytes = std::mem::take(&mut lab.input);
        lab.engine = Some(Engine::new(Content::from_bytes(&bytes)?)?);
        Ok(0)
    })
}

/// Goes on from the state whose bytes were written there.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_go_on_from() -> u32 {
    with(|lab| {
        let bytes = std::mem::take(&mut lab.input);
        lab.engine.as_mut().map_or(Ok(u32::MAX), |engine| engine.go_on_from(&bytes).map(|()| 0))
    })
}

#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_ask(handle: usize, value: f64) -> u32 {
    with_engine(|engine| engine.ask(handle, value).map(|()| 0))
}

/// Applies the requested handles: 1 where the run restarts.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_apply() -> u32 {
    with_engine(|engine| engine.apply().map(u32::from))
}

#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_restart() -> u32 {
    with_engine(|engine| engine.restart().map(|()| 0))
}

/// Steps until there are `samples` samples: 1 where the run restarted before, with the reason in the text.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_run(samples: usize) -> u32 {
    with(|lab| {
        let Some(engine) = &mut lab.engine else { return Ok(u32::MAX) };
        let began = engine.run(samples)?;
        let code = u32::from(began.is_some());
        lab.text = began.unwrap_or_default();
        Ok(code)
    })
}

#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_samples() -> *const f64 {
    hand_over(|engine| engine.samples().to_vec())
}

#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_picture() -> *const f64 {
    hand_over(|engine| engine.picture().to_vec())
}

/// Displacement of the outer raceway.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_displacement() -> *const f64 {
    hand_over(|engine| engine.displacement().to_vec())
}

/// Vertices of the outer raceway (0), of the inner raceway (1), of a roller (2), angles of the rollers'
/// vertices (3), handles (4), forces (5).
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_numbers(which: usize) -> *const f64 {
    hand_over(|engine| match which {
        0..3 => engine.outline(which),
        3 => engine.vertex_angles(),
        4 => engine.handles().to_vec(),
        _ => engine.forces(),
    })
}

/// How many numbers were handed over last.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_length() -> usize {
    LAB.with_borrow(|lab| lab.numbers.len())
}

/// Why the last call failed, in UTF-8.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_text() -> *const u8 {
    LAB.with_borrow(|lab| lab.text.as_ptr())
}

/// Bytes of that text.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_text_length() -> usize {
    LAB.with_borrow(|lab| lab.text.len())
}

/// Numbers of a sample (0), before the rollers of a picture (1), of a roller (2).
#[unsafe(no_mangle)]
pub(crate) extern "C" fn lab_layout(which: usize) -> usize {
    [readings::PER_SAMPLE, readings::BEFORE_ROLLERS, readings::PER_ROLLER][which.min(2)]
}
