//! One step of a reduced bearing in WebAssembly, beside the same step on another machine.
//!
//! Compiled for `wasm32-unknown-unknown`, the program holds a bearing, a state and the state after a step, as
//! `one_step` of `stribeck-simulation` writes them into the file that `STRIBECK_STEP` names. It takes the
//! step, and ends with 0 where both agree to rounding, with 1 where they do not, and with 2 where the file is
//! another one's. `.ci/wasm` builds and runs it.

use std::process::ExitCode;

/// Differences that are rounding, over the largest number of a list. Sums over lanes are taken in another
/// order, and products are rounded before they are added, where other machines fuse both; a force follows
/// from a penetration that is a difference of places, a ten-thousandth of them.
#[cfg(target_arch = "wasm32")]
const ROUNDING: f64 = 1e-9;
/// The same of the modes' velocities: after one step from an equilibrium they are what large forces in balance leave.
#[cfg(target_arch = "wasm32")]
const BALANCED: f64 = 1e-7;

#[cfg(target_arch = "wasm32")]
fn main() -> ExitCode {
    use stribeck_reduced::modal::ModalBearing;
    use stribeck_reduced::{bearing::Bearing, motion::BearingInMotion, motion::Saved};

    let file = include_bytes!(env!("STRIBECK_STEP"));
    let content = postcard::from_bytes::<(ModalBearing, f64, Saved, Saved)>(file);
    let Ok((modal, time_step, before, after)) = content else { return ExitCode::from(2) };
    let Ok(bearing) = Bearing::new(modal, time_step) else { return ExitCode::from(2) };
    let mut motion = BearingInMotion::new(bearing, before);
    motion.interval(1);
    let (here, there) = (motion.saved().state, after.state);
    let lists = |state: &stribeck_reduced::state::State| {
        [
            &state.q,
            &state.v,
            &state.x,
            &state.y,
            &state.vx,
            &state.vy,
            &state.spin,
            &state.force[0],
            &state.force[1],
        ]
        .map(Vec::clone)
    };
    let differs = |(at, (here, there)): (usize, (Vec<f64>, Vec<f64>))| {
        let rounding = if at == 1 { BALANCED } else { ROUNDING };
        let largest = there.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
        let off = here.iter().zip(&there).fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
        here.len() != there.len() || !(off <= rounding * largest)
    };
    let moved = here.steps == 1 && here.force[0].iter().any(|force| *force > 0.0);
    ExitCode::from(u8::from(!moved || lists(&here).into_iter().zip(lists(&there)).enumerate().any(differs)))
}

#[cfg(not(target_arch = "wasm32"))]
fn main() -> ExitCode {
    eprintln!("compile this example for wasm32-unknown-unknown, as .ci/wasm does");
    ExitCode::from(2)
}
