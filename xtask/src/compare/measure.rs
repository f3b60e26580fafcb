//! One problem in all programs: first the answers, then the times in turn.

use std::path::PathBuf;

use anyhow::Result;

use super::environment::Environment;
use super::peers::Peer;
use super::program::{About, Program, Script};

/// A run of ours before each of another program takes about this long [s].
const OUR_RUN_S: f64 = 0.25;

const THEIR_RUN_S: f64 = 0.5;

/// A problem, and our own solutions of it.
pub(super) struct Problem {
    pub(super) title: String,
    /// Its name for the reader.
    pub(super) text: String,
    pub(super) elements: usize,
    /// Input of the scripts.
    pub(super) file: PathBuf,
    /// Steps after which displacements are compared: slow programs reach the first only.
    pub(super) checks: [usize; 2],
    pub(super) ours: Box<dyn Program>,
    /// Other ways of ours, compared like any other program, and the largest difference allowed.
    pub(super) also: Vec<(Box<dyn Program>, f64)>,
}

/// How far one program's displacements are from another's.
#[derive(Debug, Clone)]
pub(super) struct Difference {
    /// The other program.
    pub(super) from: String,
    /// Norm of the difference over the norm.
    pub(super) found: f64,
    pub(super) limit: f64,
    pub(super) reason: &'static str,
}

/// Times of one round: ours just before, then theirs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Round {
    pub(super) ours: Pace,
    pub(super) theirs: Pace,
}

/// Time per element and step [ns], of the processor and of the clock.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    pub(super) cpu: f64,
    pub(super) wall: f64,
}

/// One program on one problem.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) about: About,
    pub(super) differences: Vec<Difference>,
    pub(super) rounds: Vec<Round>,
}

/// All programs on one problem.
#[derive(Debug)]
pub(super) struct Measured {
    pub(super) title: String,
    pub(super) text: String,
    pub(super) elements: usize,
    pub(super) ours: About,
    pub(super) entries: Vec<Entry>,
}

/// A program that could not take part, and why.
#[derive(Debug)]
pub(super) struct Absent {
    pub(super) label: String,
    pub(super) reason: String,
}

/// A running program, with its measurements so far.
struct Runner {
    program: Box<dyn Program>,
    entry: Entry,
    /// Steps in one timed run.
    steps: usize,
}

/// Number of steps, and displacements [m] after them.
type Solution = (usize, Vec<f64>);

/// What one program found, at its checks.
struct Solved {
    label: String,
    solutions: Vec<Solution>,
}

/// Name under which our solution is referred to.
pub(super) const OURS: &str = "ours";

/// Solves the problem in all programs, compares answers and takes times.
pub(super) fn measure(
    problem: Problem,
    peers: &[&Peer],
    environment: &Environment,
    rounds: usize,
    absent: &mut Vec<Absent>,
) -> Result<Measured> {
    let Problem { title, text, elements, file, checks, mut ours, also } = problem;
    let (found, pace) = solutions(&mut *ours, &checks, elements)?;
    let our_steps = steps_for(OUR_RUN_S, pace, elements);
    let mut solved = vec![Solved { label: OURS.to_owned(), solutions: found }];
    let mut runners = Vec::new();

    for (mut program, limit) in also {
        let (found, pace) = solutions(&mut *program, &checks, elements)?;
        let references = [(OURS.to_owned(), limit, "same element: rounding")];
        let entry = entry(&*program, &found, &solved, &references);
        runners.push(Runner { program, entry, steps: steps_for(THEIR_RUN_S, pace, elements) });
    }
    for peer in peers {
        eprintln!("{title}: {} …", peer.label());
        let checks = if peer.fast { &checks[..] } else { &checks[..1] };
        let ready = environment.install(peer.packages).and_then(|()| {
            let mut script = Script::start(environment, peer.script, &file, peer.variant)?;
            let (found, pace) = solutions(&mut script, checks, elements)?;
            Ok((script, found, pace))
        });
        match ready {
            Ok((script, found, pace)) => {
                let twin = peer.twin.map(|(label, limit)| (label.to_owned(), limit, "same element"));
                let references = [(OURS.to_owned(), peer.tolerance, peer.reason)].into_iter().chain(twin);
                let entry = entry(&script, &found, &solved, &references.collect::<Vec<_>>());
                solved.push(Solved { label: peer.label(), solutions: found });
                let steps = steps_for(THEIR_RUN_S, pace, elements);
                runners.push(Runner { program: Box::new(script), entry, steps });
            }
            Err(error) => {
                eprintln!("  left out: {error:#}");
                if !absent.iter().any(|a| a.label == peer.label()) {
                    absent.push(Absent { label: peer.label(), reason: format!("{error:#}") });
                }
            }
        }
    }
    for round in 1..=rounds {
        eprintln!("{title}: round {round} of {rounds}");
        for runner in &mut runners {
            let before = timed(&mut *ours, our_steps, elements)?;
            let theirs = timed(&mut *runner.program, runner.steps, elements)?;
            runner.entry.rounds.push(Round { ours: before, theirs });
        }
    }
    let entries = runners.into_iter().map(|r| r.entry).collect();
    Ok(Measured { title, text, elements, ours: ours.about().clone(), entries })
}

/// Displacements after each check, and the pace on the way to the last.
fn solutions(program: &mut dyn Program, checks: &[usize], elements: usize) -> Result<(Vec<Solution>, Pace)> {
    let mut found = Vec::new();
    let (mut done, mut pace) = (0, Pace { cpu: f64::NAN, wall: f64::NAN });
    for &steps in checks {
        pace = timed(program, steps - done, elements)?;
        done = steps;
        found.push((steps, program.displacements()?));
    }
    Ok((found, pace))
}

fn timed(program: &mut dyn Program, steps: usize, elements: usize) -> Result<Pace> {
    let time = program.run(steps)?;
    let ns = 1e9 / (steps * elements) as f64;
    Ok(Pace { cpu: time.cpu_s * ns, wall: time.wall_s * ns })
}

fn steps_for(seconds: f64, pace: Pace, elements: usize) -> usize {
    ((seconds * 1e9 / (pace.cpu * elements as f64)) as usize).clamp(1, 1_000_000)
}

/// Differences at the last check from each of the references (label, limit, reason) that is there.
fn entry(
    program: &dyn Program,
    found: &[Solution],
    solved: &[Solved],
    references: &[(String, f64, &'static str)],
) -> Entry {
    let mut differences = Vec::new();
    for (label, limit, reason) in references {
        let Some(reference) = solved.iter().find(|s| s.label == *label) else { continue };
        let Some((steps, u)) = found.last() else { continue };
        let Some((_, v)) = reference.solutions.iter().find(|(n, _)| n == steps) else { continue };
        differences.push(Difference { from: label.clone(), found: distance(u, v), limit: *limit, reason });
    }
    Entry { about: program.about().clone(), differences, rounds: Vec::new() }
}

/// Norm of the difference over the norm of the second; infinite when they do not compare.
fn distance(u: &[f64], v: &[f64]) -> f64 {
    if u.len() != v.len() {
        return f64::INFINITY;
    }
    let apart: f64 = u.iter().zip(v).map(|(a, b)| (a - b) * (a - b)).sum();
    let size: f64 = v.iter().map(|b| b * b).sum();
    (apart / size).sqrt()
}

impl Measured {
    /// Programs whose answers are outside their limits.
    pub(super) fn disagreeing(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().filter(|e| !e.agrees()).map(|e| e.about.program.as_str())
    }
}

impl Entry {
    /// True when every difference is within its limit; a program without any has not been checked.
    fn agrees(&self) -> bool {
        !self.differences.is_empty() && self.differences.iter().all(|d| d.found <= d.limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_distance_is_relative_and_refuses_other_lengths() {
        assert_eq!(distance(&[3.0, 0.0], &[0.0, 4.0]), 1.25);
        assert_eq!(distance(&[1.0], &[1.0, 2.0]), f64::INFINITY);
        assert!(distance(&[f64::NAN], &[1.0]).is_nan());
    }

    #[test]
    fn behaves_an_answer_that_is_no_number_does_not_agree() {
        let word = String::new;
        let about = About { program: word(), version: word(), element: word() };
        let difference = |found| Difference { from: OURS.into(), found, limit: 1.0, reason: "" };
        let with = |differences| Entry { about: about.clone(), differences, rounds: Vec::new() };
        assert!(with(vec![difference(0.5)]).agrees());
        assert!(!with(vec![difference(0.5), difference(f64::NAN)]).agrees());
        assert!(!with(Vec::new()).agrees());
    }
}
