//! The progress of many runs: one bar for all of them on a terminal, lines in a log.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use indicatif::ProgressBar;
use stribeck_simulation::run::host::Progress;
use stribeck_store::run_info::clock;

use crate::out::{caution, tell};
use crate::progress::{bar, pause};

/// Parts of the bar.
const PARTS: u64 = 1000;

/// Shows how far all have come.
pub(crate) struct Board {
    bar: ProgressBar,
    on_terminal: bool,
    began: Instant,
    state: Mutex<State>,
}

struct State {
    /// Noun for one: `start`.
    noun: &'static str,
    /// How many are to be run.
    all: usize,
    done: usize,
    /// Those that are in their time loop: the part of each that is done.
    going: BTreeMap<usize, f64>,
    /// Work that continued ones had done before.
    earlier: f64,
    shown: Instant,
}

impl Board {
    /// A board for a number of runs, each called a `noun`.
    pub(crate) fn new(noun: &'static str, all: usize) -> Self {
        let (bar, on_terminal) = bar(PARTS);
        let now = Instant::now();
        let state = State { noun, all, done: 0, going: BTreeMap::new(), earlier: 0.0, shown: now };
        Self { bar, on_terminal, began: now, state: Mutex::new(state) }
    }

    /// Takes note of how far `number` is; draws only when it is time to.
    pub(crate) fn show(&self, number: usize, progress: &Progress) {
        if progress.phase != "run" {
            return;
        }
        let part = progress.step as f64 / progress.steps.max(1) as f64;
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.going.insert(number, part).is_none() {
            state.earlier += part;
        }
        let now = Instant::now();
        if now - state.shown < pause(self.on_terminal) {
            return;
        }
        state.shown = now;
        let line = state.line((now - self.began).as_secs_f64());
        if self.on_terminal {
            self.bar.set_position((PARTS as f64 * state.work() / state.all as f64) as u64);
            self.bar.set_message(line);
            self.bar.tick();
        } else {
            tell!("{line}");
        }
    }

    /// Marks run `number` as ended, with `words`.
    pub(crate) fn done(&self, number: usize, words: &str) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.going.remove(&number);
        state.done += 1;
        let line = format!("{} {number} ({} of {}): {words}", state.noun, state.done, state.all);
        drop(state);
        self.say(&line);
    }

    /// Prints a line above the bar.
    pub(crate) fn say(&self, line: &str) {
        self.bar.suspend(|| tell!("{line}"));
    }

    pub(crate) fn warn(&self, line: &str) {
        self.bar.suspend(|| caution!("{line}"));
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl State {
    /// How many are done, with the parts of those that are going.
    fn work(&self) -> f64 {
        self.done as f64 + self.going.values().sum::<f64>()
    }

    /// One line, `elapsed` seconds after the first was taken up.
    fn line(&self, elapsed: f64) -> String {
        let left = self.all as f64 - self.work();
        let pace = (self.work() - self.earlier) / elapsed;
        let going: Vec<String> = self
            .going
            .iter()
            .map(|(number, part)| format!("{} {number} at {:.0} %", self.noun, 100.0 * part))
            .collect();
        format!(
            "{} of {} {}s done, {}, ETA {}",
            self.done,
            self.all,
            self.noun,
            going.join(", "),
            clock(left / pace)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_line_holds_starts_parts_and_eta() {
        let going = BTreeMap::from([(5, 0.5), (6, 0.25)]);
        let state = State { noun: "start", all: 12, done: 4, going, earlier: 0.75, shown: Instant::now() };
        // Four starts of work in 40 s; 7.25 are left.
        assert_eq!(state.line(40.0), "4 of 12 starts done, start 5 at 50 %, start 6 at 25 %, ETA 1:13");
    }
}
