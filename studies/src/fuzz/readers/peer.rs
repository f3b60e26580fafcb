//! The other programs: they read the same files, a batch at a time, in processes of their own.

use std::io::{BufRead, BufReader, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, ensure};
use serde_json::{Value, json};

use super::judge::{Verdict, judge};
use super::page::{Seen, Tables};
use super::{Held, Made, Reading, Shelf, code, ours, place};
use stribeck_scene::dice::Dice;

/// Files that are written, read by both and removed again.
const BATCH: u64 = 2000;

/// The script that reads with the other programs.
struct Peer {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    versions: String,
}

impl Peer {
    fn start(python: &str) -> Result<Self> {
        let script = stribeck_studies::root().join("fixtures/peers/read_damaged.py");
        let mut child = Command::new(python)
            .arg(&script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot start `{python}`"))?;
        let (to, from) = (child.stdin.take(), child.stdout.take());
        let (to, from) = to.zip(from).context("no way to talk to the other programs")?;
        let mut from = BufReader::new(from);
        let mut line = String::new();
        from.read_line(&mut line)?;
        let versions: serde_json::Map<String, Value> = serde_json::from_str(&line).with_context(|| {
            format!(
                "`{python}` lacks one of numpy, scipy, h5py, npTDMS, asammdf, pandas, pyarrow, pyuff, \
                 soundfile, meshio"
            )
        })?;
        let named = versions.iter().map(|(name, v)| format!("{name} {}", v.as_str().unwrap_or("?")));
        let versions = named.collect::<Vec<_>>().join(", ");
        Ok(Self { child, to, from, versions })
    }

    /// Their readings of the files of a list.
    fn read(&mut self, list: &Path) -> Result<Vec<Reading>> {
        writeln!(self.to, "{}", list.display())?;
        self.to.flush()?;
        let mut line = String::new();
        self.from.read_line(&mut line)?;
        ensure!(line.trim() == "done", "the other programs stopped: {line}");
        let out = std::fs::read_to_string(list.with_extension("jsonl.out"))?;
        out.lines().map(reading).collect()
    }
}

fn reading(line: &str) -> Result<Reading> {
    let said: Value = serde_json::from_str(line).with_context(|| format!("no answer: {line}"))?;
    if let Some(why) = said["refused"].as_str() {
        return Ok(Err(why.to_owned()));
    }
    let all = said["channels"].as_array().ok_or_else(|| anyhow!("no channels: {line}"))?;
    let held = all.iter().map(|of| Held {
        name: of[0].as_str().unwrap_or_default().to_owned(),
        len: of[1].as_u64(),
        numbers: of[2].as_u64().unwrap_or(0),
        rms: of[3].as_f64().unwrap_or(f64::NAN),
        rate_hz: of[4].as_f64(),
    });
    Ok(Ok(held.collect()))
}

/// What becomes of the files that differ.
pub(crate) struct Wanted<'a> {
    pub(crate) python: &'a str,
    pub(crate) keep: Option<&'a Path>,
    /// No more batches after this time.
    pub(crate) time: Duration,
    pub(crate) first: u64,
    pub(crate) cases: u64,
}

/// Reads `cases` files here, and there as long as there is time, and writes the page of how the readings compare.
pub(crate) fn against(wanted: &Wanted<'_>, folder: &Path) -> Result<ExitCode> {
    let shelf = Shelf::open()?;
    let mut peer = Peer::start(wanted.python)?;
    let mut tables = Tables::default();
    let words = crate::fuzz::listen_to_panics();
    let began = Instant::now();
    let end = wanted.first + wanted.cases;
    let (mut from, mut compared) = (wanted.first, 0);
    while from < end {
        let alone = began.elapsed() >= wanted.time;
        let until = end.min(from + BATCH);
        let mut batch: Vec<(u64, Made, PathBuf, Reading)> = Vec::new();
        let mut list = String::new();
        for seed in from..until {
            let made = shelf.make(&mut Dice::new(seed));
            let path = place(folder, (seed - from) as usize, made.kind);
            std::fs::write(&path, &made.bytes)?;
            let started = Instant::now();
            let found = catch_unwind(AssertUnwindSafe(|| ours(&path, made.kind)));
            tables.took(started.elapsed());
            let found = found.unwrap_or_else(|_| {
                let said = words.lock().unwrap_or_else(|e| e.into_inner()).clone();
                tables.panics.push(format!("seed {seed}, {}: {said}", made.kind));
                Err("a panic".to_owned())
            });
            if alone {
                std::fs::remove_file(path).ok();
                continue;
            }
            list += &json!({"path": path, "kind": made.kind, "told": made.told}).to_string();
            list.push('\n');
            batch.push((seed, made, path, found));
        }
        from = until;
        if alone {
            continue;
        }
        compared = until - wanted.first;
        let name = folder.join("list.jsonl");
        std::fs::write(&name, list)?;
        for ((seed, made, path, found), theirs) in batch.into_iter().zip(peer.read(&name)?) {
            // The rate of a text is known from how it was made.
            let theirs = with_rate(theirs, made.rate_hz);
            let verdict = judge(&found, &theirs);
            if let (Some(keep), Verdict::Differ(..) | Verdict::OursRefuses) = (wanted.keep, &verdict) {
                keep_file(keep, seed, &made, &path, &format!("{verdict:?}\n{found:?}\n{theirs:?}"))?;
            }
            tables.take(Seen { seed, made, ours: found, verdict });
            std::fs::remove_file(path).ok();
        }
        eprintln!("{compared} files, {} differ", tables.differing());
    }
    let _ = std::panic::take_hook();
    drop(peer.to);
    peer.child.wait()?;
    let rows = tables.rows([wanted.cases, compared], wanted.first, &peer.versions);
    let file = stribeck_studies::publish("readers", &rows)?;
    println!("{}", file.display());
    Ok(code(tables.unexplained() + tables.panics.len() as u64))
}

fn with_rate(theirs: Reading, rate_hz: Option<f64>) -> Reading {
    theirs.map(|all| all.into_iter().map(|held| Held { rate_hz: held.rate_hz.or(rate_hz), ..held }).collect())
}

/// Keeps a file with the readers' messages, for a closer look.
fn keep_file(keep: &Path, seed: u64, made: &Made, path: &Path, said: &str) -> Result<()> {
    std::fs::create_dir_all(keep)?;
    std::fs::copy(path, keep.join(format!("{seed}.{}", made.kind)))?;
    let told = made.told.as_ref().map_or(String::new(), Value::to_string);
    let text = format!("{} from {}, {}\n{told}\n{said}\n", made.kind, made.from, made.done);
    std::fs::write(keep.join(format!("{seed}.{}.txt", made.kind)), text)?;
    Ok(())
}
