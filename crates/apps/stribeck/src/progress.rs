//! The progress of a run: a bar on a terminal, one line now and then in a log file.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use stribeck_simulation::run::host::Progress;
use stribeck_store::run_info::{RunInfo, clock};

use crate::out::{is_quiet, tell};

/// Shows how far a run has come.
pub struct Meter {
    bar: ProgressBar,
    on_terminal: bool,
    duration_ms: f64,
    phase: &'static str,
    /// When the present phase began, and its step then.
    began: (Instant, u64),
    shown: Instant,
    shown_part: f64,
}

impl Meter {
    /// A meter for a run of `duration_ms` simulated time.
    pub fn new(duration_ms: f64) -> Self {
        let (bar, on_terminal) = bar(1);
        let now = Instant::now();
        Self { bar, on_terminal, duration_ms, phase: "", began: (now, 0), shown: now, shown_part: 0.0 }
    }

    /// Takes note of `progress`; draws only when it is time to.
    pub fn show(&mut self, progress: &Progress) {
        let now = Instant::now();
        let part = part(progress);
        let new_phase = self.phase != progress.phase;
        if new_phase {
            self.phase = progress.phase;
            self.began = (now, progress.step);
        }
        let since = now - self.shown;
        let complete = part >= 1.0 && self.shown_part < 1.0;
        if !(new_phase || complete && self.on_terminal || since >= pause(self.on_terminal)) {
            return;
        }
        (self.shown, self.shown_part) = (now, part);
        let line = self.line(progress, (now - self.began.0).as_secs_f64());
        if self.on_terminal {
            self.bar.set_length(progress.steps.max(1));
            self.bar.set_position(progress.step);
            self.bar.set_message(line);
            // One drawing a call, already rationed above.
            self.bar.tick();
        } else {
            tell!("{line}");
        }
    }

    /// Takes the bar away; its last state was only of passing interest.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// One line of progress, `elapsed` seconds after the phase began.
    fn line(&self, progress: &Progress, elapsed: f64) -> String {
        let done = progress.step.saturating_sub(self.began.1) as f64;
        let left = progress.steps.saturating_sub(progress.step) as f64;
        if done == 0.0 || elapsed <= 0.0 {
            return format!("{} …", progress.phase);
        }
        let pace = match progress.elements {
            // Those of a reduced model take no part in its steps.
            0 => format!("{:.0} ms/s", 1e3 * progress.time_s * (done / progress.step as f64) / elapsed),
            elements => format!("{:.1} M element-steps/s", 1e-6 * done * elements as f64 / elapsed),
        };
        format!(
            "{:5.1} %  {:.2} of {} ms  ETA {}  {pace}",
            100.0 * part(progress),
            progress.time_s * 1e3,
            self.duration_ms,
            clock(elapsed * left / done)
        )
    }
}

/// How often a bar is redrawn, or a log gets a line.
pub(crate) fn pause(on_terminal: bool) -> Duration {
    if on_terminal { Duration::from_millis(100) } else { Duration::from_secs(10) }
}

/// A bar of so many parts, and whether there is a terminal for it.
pub(crate) fn bar(parts: u64) -> (ProgressBar, bool) {
    let on_terminal = std::io::stderr().is_terminal();
    let target =
        if on_terminal && !is_quiet() { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(parts), target);
    if let Ok(style) = ProgressStyle::with_template("{bar:24} {wide_msg}") {
        bar.set_style(style);
    }
    (bar, on_terminal)
}

/// Largest energy imbalance of a run, in words.
pub(crate) fn energy_error(info: &RunInfo) -> String {
    format!("energy error {}", info.energy.in_words())
}

/// Part of the steps that is done, 0 to 1.
fn part(progress: &Progress) -> f64 {
    progress.step as f64 / progress.steps.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_line_holds_time_eta_and_pace() {
        let meter = Meter::new(30.0);
        let progress = Progress { step: 250, steps: 1000, time_s: 7.5e-3, elements: 100_000, phase: "run" };
        // 250 steps of 100 000 elements in 10 s: 2.5 million element-steps a second, 30 s left.
        let expected = " 25.0 %  7.50 of 30 ms  ETA 30.0 s  2.5 M element-steps/s";
        assert_eq!(meter.line(&progress, 10.0), expected);
        let reduced = " 25.0 %  7.50 of 30 ms  ETA 30.0 s  1 ms/s";
        assert_eq!(meter.line(&Progress { elements: 0, ..progress }, 10.0), reduced);
        assert_eq!(meter.line(&Progress { step: 0, phase: "preload", ..progress }, 0.0), "preload …");
    }
}
