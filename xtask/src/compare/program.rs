//! A program under comparison: ours in this process, the others as children that answer line by line.

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::environment::Environment;

/// The report of a program on its run.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct About {
    pub(super) program: String,
    pub(super) version: String,
    pub(super) element: String,
}

/// Time that some steps took [s].
#[derive(Debug, Clone, Copy, Deserialize)]
pub(super) struct Time {
    pub(super) wall_s: f64,
    pub(super) cpu_s: f64,
}

/// Anything that can take steps of the problem.
pub(super) trait Program {
    /// Its report.
    fn about(&self) -> &About;
    /// Takes steps, in the thread or process that nothing else uses.
    fn run(&mut self, steps: usize) -> Result<Time>;
    /// Displacements of all nodes [m]: x and y in turn, row by row from the lower left corner.
    fn displacements(&mut self) -> Result<Vec<f64>>;
}

/// Times work of ours, in this thread.
pub(super) fn timed(work: impl FnOnce()) -> Time {
    let (wall, cpu) = (Instant::now(), thread_cpu_s());
    work();
    let wall_s = wall.elapsed().as_secs_f64();
    let cpu_s = cpu.zip(thread_cpu_s()).map_or(wall_s, |(from, to)| to - from);
    Time { wall_s, cpu_s }
}

/// Processor time of this thread [s], where the system has it.
fn thread_cpu_s() -> Option<f64> {
    // The system brings this number up to date when a thread offers its processor, and else every few
    // milliseconds.
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * text.split_whitespace().next()?.parse::<f64>().ok()?)
}

/// Writes a problem where scripts can read it.
pub(super) fn write_json(file: &Path, problem: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string(problem).context("cannot write the problem as JSON")?;
    std::fs::write(file, text).with_context(|| format!("cannot write `{}`", file.display()))
}

/// Lines of ours begin with this; whatever else a program prints does not.
const MARK: char = '@';

/// Most libraries read one of these.
const THREADS: [&str; 5] = [
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "NUMEXPR_NUM_THREADS",
];

/// A script in a process of its own, with one thread.
#[derive(Debug)]
pub(super) struct Script {
    about: About,
    child: Child,
    ask: ChildStdin,
    answers: BufReader<ChildStdout>,
    log: PathBuf,
    answer_file: PathBuf,
}

impl Script {
    /// Starts a script on a problem file and waits until it is ready to run.
    pub(super) fn start(
        environment: &Environment,
        script: &str,
        problem: &Path,
        variant: &str,
    ) -> Result<Self> {
        let log = environment.folder.join(format!("{script}-{variant}.log"));
        let errors = File::create(&log).with_context(|| format!("cannot write `{}`", log.display()))?;
        let mut command = Command::new(environment.python());
        command.arg(environment.scripts.join(script)).arg(problem).arg(variant);
        // No compiled scripts beside the sources.
        command.env("PYTHONDONTWRITEBYTECODE", "1").current_dir(&environment.folder);
        command.envs(THREADS.map(|name| (name, "1")));
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(errors)
            .spawn()
            .with_context(|| format!("cannot start {script}"))?;
        let (Some(ask), Some(out)) = (child.stdin.take(), child.stdout.take()) else {
            bail!("cannot talk to {script}");
        };
        let mut answers = BufReader::new(out);
        let about = match answer(&mut answers, &log) {
            Ok(about) => about,
            Err(error) => {
                end(&mut child);
                return Err(error);
            }
        };
        let answer_file = environment.folder.join(format!("{script}-{variant}.bin"));
        Ok(Self { about, child, ask, answers, log, answer_file })
    }

    fn tell<T: DeserializeOwned>(&mut self, line: &str) -> Result<T> {
        writeln!(self.ask, "{line}").and_then(|()| self.ask.flush()).with_context(|| self.last_words())?;
        answer(&mut self.answers, &self.log)
    }

    fn last_words(&self) -> String {
        last_words(&self.log)
    }
}

impl Program for Script {
    fn about(&self) -> &About {
        &self.about
    }

    fn run(&mut self, steps: usize) -> Result<Time> {
        self.tell(&format!("run {steps}"))
    }

    fn displacements(&mut self) -> Result<Vec<f64>> {
        let file = self.answer_file.clone();
        let _: serde_json::Value = self.tell(&format!("write {}", file.display()))?;
        let bytes = std::fs::read(&file).with_context(|| format!("cannot read `{}`", file.display()))?;
        let (numbers, rest) = bytes.as_chunks::<8>();
        ensure!(rest.is_empty(), "`{}` is no list of doubles", file.display());
        Ok(numbers.iter().map(|eight| f64::from_le_bytes(*eight)).collect())
    }
}

impl Drop for Script {
    fn drop(&mut self) {
        end(&mut self.child);
    }
}

/// Ends a child that has nothing to save.
fn end(child: &mut Child) {
    // It may have ended by itself: both calls then fail without harm.
    let _ = child.kill();
    let _ = child.wait();
}

fn answer<T: DeserializeOwned>(answers: &mut impl BufRead, log: &Path) -> Result<T> {
    let mut line = String::new();
    loop {
        line.clear();
        if answers.read_line(&mut line).context("cannot read an answer")? == 0 {
            bail!("{}", last_words(log));
        }
        if let Some(json) = line.strip_prefix(MARK) {
            return serde_json::from_str(json).context("cannot understand an answer");
        }
    }
}

/// The error that ended a script: the last line on its error stream that says something.
fn last_words(log: &Path) -> String {
    let text = std::fs::read_to_string(log).unwrap_or_default();
    // Python chains errors; the first one is the cause.
    let error = text.lines().find(|line| line.contains("Error: "));
    let line = error.or_else(|| text.lines().rfind(|line| !line.trim().is_empty()));
    format!("cannot run: {}", line.unwrap_or("it ended without a word").trim())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Time, answer};

    #[test]
    fn behaves_what_a_program_prints_by_itself_is_no_answer() {
        let mut lines = "Welcome\n@{\"wall_s\": 2.0, \"cpu_s\": 1.5}\n".as_bytes();
        let time: Time = answer(&mut lines, Path::new("none")).expect("one marked line");
        assert_eq!((time.wall_s, time.cpu_s), (2.0, 1.5));
        let ended = answer::<Time>(&mut lines, Path::new("none")).unwrap_err().to_string();
        assert!(ended.contains("it ended without a word"), "{ended}");
    }
}
