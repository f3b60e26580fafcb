//! Two channels of one file on one axis of time: each begins when its own clock says.

use anyhow::{Result, ensure};
use stribeck_formats::Channel;

/// Lengths that differ by this part and less are those of two clocks, and not of two recordings; by less than
/// the second they are one.
const DRIFT: f64 = 0.02;
const SAME: f64 = 5e-4;

/// How much later a tachometer begins than the signal [s], both with their rates [Hz].
pub(super) fn later_s(
    signal: &Channel,
    tacho: &Channel,
    (signal_hz, tacho_hz): (f64, f64),
    notes: &mut Vec<String>,
) -> Result<f64> {
    let (lasts_s, tacho_s) = (signal.len as f64 / signal_hz, tacho.len as f64 / tacho_hz);
    let later_s = match (signal.start_s, tacho.start_s) {
        (Some(of_signal), Some(of_tacho)) => of_tacho - of_signal,
        (None, None) => 0.0,
        (of_signal, _) => {
            let (said, other) = if of_signal.is_some() { (signal, tacho) } else { (tacho, signal) };
            notes.push(format!(
                "the file says when `{}` begins, and not when `{}` does: both are taken to begin together",
                said.name, other.name
            ));
            0.0
        }
    };
    ensure!(
        later_s < lasts_s && -later_s < tacho_s,
        "`{}` and `{}` have no time in common: by their clocks the former begins {later_s:.3} s after the \
         latter, which lasts {lasts_s:.3} s, and lasts {tacho_s:.3} s. Take a tachometer of the same time, or \
         give `--speed-rpm`",
        tacho.name,
        signal.name
    );
    if later_s.abs() * signal_hz >= 0.5 {
        notes.push(format!(
            "`{}` begins {:.4} s {} `{}`, by the clocks of the file, and is laid there",
            tacho.name,
            later_s.abs(),
            if later_s > 0.0 { "after" } else { "before" },
            signal.name
        ));
    } else if let off @ SAME..=DRIFT = (tacho_s / lasts_s - 1.0).abs() {
        notes.push(format!(
            "`{}` lasts {tacho_s:.4} s and `{}` {lasts_s:.4} s by their rates: if both were begun and stopped \
             together, their clocks differ by {:.2} %, and speed and angle are wrong by as much. Check the \
             rates, or give `--speed-rpm`",
            tacho.name,
            signal.name,
            100.0 * off
        ));
    }
    Ok(later_s)
}
