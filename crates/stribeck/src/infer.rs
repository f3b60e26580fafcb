//! `stribeck infer`: which scenes are consistent with observed numbers.
//!
//! Rounds of runs of a scene whose unknowns are drawn, first evenly over their priors, then where the
//! posterior is; then runs at draws of the posterior, and the answer. All runs are in the folder, so the same
//! command starts and continues, parts of it may run anywhere, and the answer is the same.

mod answer;
mod outputs;
mod record;
mod rounds;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, Result, bail, ensure};
use stribeck_infer::{Emulator, Levels, NextOptions, Posterior, PosteriorOptions, next, snapped, sobol};
use stribeck_plans::inference::Inference;
use stribeck_report::inference::write_inference;
use stribeck_store::run_dir::{Keep, check_folder, write_atomic};

use crate::analyse::Reading;
use crate::campaign::{Shard, shard};
use crate::interrupt::{self, Interrupt};
use crate::many_runs::{Share, Stage};
use crate::out::{say, tell};
use crate::place::{Place, shown};
use answer::Known;
use outputs::{Row, Table};
use rounds::{Point, Round, Rounds};

/// Flags of `infer`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// File with unknowns and targets, such as fixtures/infer/quick.ron
    #[arg(required_unless_present = "record")]
    file: Option<PathBuf>,
    /// Infers the cause of a measured record: the spall on the raceway that `analyse` finds damaged, its load
    /// and clearance. Needs `--bearing`, and `--speed-rpm` where the record does not yield the speed
    #[arg(long, value_name = "FILE", conflicts_with_all = ["file", "emit"])]
    record: Option<PathBuf>,
    /// The record's machine, by `stribeck machine` on other records of it: simulated records have its path and
    /// background, and the level counts. Takes the unit of the record, `--unit`, if the file does not say it
    #[arg(long, value_name = "FILE", requires = "record")]
    machine: Option<PathBuf>,
    /// Runs for a record
    #[arg(long, value_name = "N", requires = "record", default_value_t = 240, value_parser = runs)]
    runs: usize,
    #[command(flatten)]
    reading: Reading,
    /// Folder of the inference [default: runs/NAME, the name of the inference]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    share: Share,
    /// Runs only part I of N of each round, for several machines that share the folder; each waits until the
    /// others have done theirs
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<Shard>,
    /// Runs nothing: prints the script that has an engine run the inference in parts: `> job.sh`
    #[arg(long, value_name = "ENGINE", conflicts_with = "shard")]
    emit: Option<crate::emit::Engine>,
    /// Parts of an emitted script [default: 16]
    #[arg(long, value_name = "N", requires = "emit", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    shards: Option<u32>,
    /// Draws N scenes from the prior, runs each, infers it from its own numbers, and says how often the
    /// intervals hold the truth
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(20..=10_000))]
    calibrate: Option<u32>,
}

/// Draws of the posterior that are reported.
const DRAWS: usize = 4000;

/// Draws of a posterior from which the next round is chosen.
const DRAWS_OF_ROUND: usize = 1000;

/// Share of a round's scenes that fill the prior, against regions without runs.
const FILLING: f64 = 0.25;

/// Interval at which the progress of other parts is read.
const LOOK: Duration = Duration::from_secs(2);

/// File that marks the folder of an inference.
const FILE: &str = "inference.ron";

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let (file, measured) = match (&options.record, &options.file) {
        (Some(record), _) => {
            let out = options.out.clone().unwrap_or_else(|| place.runs().join(folder_of(record)));
            let measured = record::prepare(record, options, &out, place)?;
            (measured.file.clone(), Some((measured, out)))
        }
        (None, Some(file)) => {
            ensure!(
                !options.reading.is_given() && options.machine.is_none(),
                "options of a record were given, and no record: `--record {}` names it",
                file.display()
            );
            ensure!(
                file.extension().is_some_and(|end| end == "ron") || !file.is_file(),
                "`{0}` is no file of an inference: for the cause of a measured record, `{1} infer --record {0} \
                 --bearing … --speed-rpm …`",
                file.display(),
                place.program
            );
            (place.locate(file), None)
        }
        (None, None) => bail!("give the file of an inference, or `--record FILE`"),
    };
    let inference = Inference::read(&file)?;
    let of_record = measured.as_ref().map(|(_, out)| out.clone());
    let out = of_record.or_else(|| options.out.clone()).unwrap_or_else(|| place.runs().join(&inference.name));
    if let Some(engine) = options.emit {
        let part = crate::emit::Part::new(options.shards, usize::MAX, engine, options.share);
        say!("{}", crate::emit::script(engine, "infer", &file, &out, part)?.trim_end());
        return Ok(ExitCode::SUCCESS);
    }
    check_folder(&out, &[FILE])?;
    enter(&out, &inference)?;
    let interrupt = Interrupt::listen()?;
    let study = Study {
        options,
        inference: &inference,
        rounds: Rounds::new(&inference, out.clone()),
        interrupt: &interrupt,
    };
    let Some(known) = study.carry_out()? else {
        tell!("the same command goes on");
        return Ok(ExitCode::from(interrupt::EXIT_CODE));
    };
    let answer = answer::of(&known)?;
    // Beside it first: parts that end at the same time write the same bytes.
    let (draws, beside) =
        (out.join("posterior.parquet"), out.join(format!("posterior.{}.new", std::process::id())));
    answer::write_draws(&beside, &known)?;
    std::fs::rename(&beside, &draws).with_context(|| format!("cannot write `{}`", shown(&draws)))?;
    write_inference(&out, &answer)?;
    answer::tell(&answer);
    if let Some((measured, out)) = &measured {
        if let Some(page) = measured.beside(&known, options, out, place, &interrupt)? {
            say!("the record beside one of the likeliest scene: {}", shown(&page));
        }
        if let Some(words) = record::in_words(&inference, &answer) {
            say!("{words}");
        }
    }
    say!("report: {}", shown(&out.join("report.html")));
    Ok(ExitCode::SUCCESS)
}

/// Runs of the inference of a record.
fn runs(text: &str) -> Result<usize, String> {
    let runs = text.trim().parse().ok().filter(|runs| (60..=10_000).contains(runs));
    runs.ok_or_else(|| "six unknowns take 60 to 10000 runs".to_owned())
}

/// Name of the folder of a record's inference.
fn folder_of(record: &std::path::Path) -> String {
    let stem = record.file_stem().map_or_else(|| "record".into(), |name| name.to_string_lossy());
    format!("{stem}-inferred")
}

/// Makes the folder, or finds the same inference in it.
fn enter(out: &std::path::Path, inference: &Inference) -> Result<()> {
    let path = out.join(FILE);
    match std::fs::read_to_string(&path) {
        Ok(there) => ensure!(
            there == inference.text,
            "`{}` holds another inference, or an earlier text of this one: give a folder with `--out`, or \
             compare `{}`",
            shown(out),
            shown(&path)
        ),
        Err(_) => {
            std::fs::create_dir_all(out).with_context(|| format!("cannot make `{}`", shown(out)))?;
            write_atomic(&path, inference.text.as_bytes())?;
        }
    }
    Ok(())
}

struct Study<'a> {
    options: &'a Options,
    inference: &'a Inference,
    rounds: Rounds<'a>,
    interrupt: &'a Interrupt,
}

impl Study<'_> {
    /// Runs the outstanding runs; `None` when Ctrl-C was pressed.
    fn carry_out(&self) -> Result<Option<Known<'_>>> {
        let Self { inference, rounds, .. } = self;
        outputs::check(inference)?;
        let budget = inference.budget;
        let scenes = budget.runs / inference.starts;
        let (mut points, mut rows) = (Vec::<Point>::new(), Vec::<Row>::new());
        let (mut number, mut drawn) = (1, 0);
        while points.len() < scenes {
            let round = Round::Number(number);
            let planned = match rounds.read(round)? {
                Some(planned) => planned,
                None if number == 1 => rounds.plan(round, &self.first(budget.first, 0)?)?,
                None => {
                    let count = budget.round.min(scenes - points.len());
                    rounds.plan(round, &self.following(&rows, number, count)?)?
                }
            };
            if !self.make(round, &planned)? {
                return Ok(None);
            }
            if number == 1 && !self.has_run(&planned)? {
                bail!("no scene of the first round could be run. The first: {}", self.why_not(&planned));
            }
            rows.extend(outputs::rows(inference, rounds, &planned)?);
            points.extend(planned);
            if number == 1 {
                drawn = rows.len();
            }
            number += 1;
        }
        let table = Table::of(inference, &rows)?;
        let columns = table.columns();
        let levels =
            Levels::of(&table.runs, &table.outputs, rounds.priors(), &columns, drawn, inference.seed)?;
        let emulator = Emulator::fit(&table.runs, &table.outputs, inference.seed)?;
        let posterior = self.posterior(&emulator, &table, DRAWS)?;
        let Some(check) = self.check(&posterior)? else { return Ok(None) };
        let truths = match self.options.calibrate {
            Some(count) => match self.truths(count as usize)? {
                Some(truths) => Some(truths),
                None => return Ok(None),
            },
            None => None,
        };
        let priors = rounds.priors().to_vec();
        Ok(Some(Known {
            inference,
            priors,
            scenes: points.len(),
            rounds: number - 1,
            table,
            emulator,
            levels,
            posterior,
            check,
            truths,
        }))
    }

    /// Points that fill the prior evenly.
    fn first(&self, count: usize, from: usize) -> Result<Vec<Vec<f64>>> {
        let points = sobol(self.inference.seed, self.inference.unknowns.len(), from, count)?;
        Ok(points.iter().map(|point| snapped(self.rounds.priors(), point)).collect())
    }

    /// Points of a later round, from the runs so far.
    fn following(&self, rows: &[Row], number: usize, count: usize) -> Result<Vec<Vec<f64>>> {
        let table = Table::of(self.inference, rows)?;
        let emulator = Emulator::fit(&table.runs, &table.outputs, self.inference.seed)?;
        let posterior = self.posterior(&emulator, &table, DRAWS_OF_ROUND)?;
        let filled = (number - 2) * (FILLING * self.inference.budget.round as f64).round() as usize;
        let options = NextOptions { count, filling: FILLING, filled, seed: self.inference.seed };
        Ok(next(&emulator, self.rounds.priors(), &table.targets, &posterior, options)?)
    }

    fn posterior(&self, emulator: &Emulator, table: &Table, draws: usize) -> Result<Posterior> {
        let options = PosteriorOptions { draws, seed: self.inference.seed };
        Ok(Posterior::of(emulator, self.rounds.priors(), &table.targets, options)?)
    }

    /// Runs a round to its end; false when Ctrl-C was pressed.
    fn make(&self, round: Round, points: &[Point]) -> Result<bool> {
        let Self { options, inference, rounds, interrupt } = self;
        let mine =
            |number: usize| options.shard.is_none_or(|Shard { part, of }| (number - 1) % of == part - 1);
        let wanted = || Rounds::wanted(points).filter(|wanted| mine(wanted.number));
        let due = rounds.runs().due(Keep::Numbers, wanted(), interrupt)?;
        if !due.is_empty() {
            rounds.runs().make(Keep::Numbers, &due, options.share, interrupt, &|jobs| {
                let (name, round, all) = (&inference.name, round.shown(), inference.budget.runs);
                let (now, shown) = (due.len(), jobs.shown());
                tell!("{name}, {round}: {now} runs to be made, of {all} in all rounds, {shown}; ETA is that of the round");
            });
        }
        let mut told = false;
        loop {
            let left = rounds.left(points)?;
            if left == 0 {
                break;
            }
            if interrupt.is_pressed() {
                tell!("{}: {left} runs are not at their end", round.shown());
                return Ok(false);
            }
            ensure!(options.shard.is_some(), "{left} runs of {} cannot be made: see above", round.shown());
            if !told {
                tell!("{}: waits for {left} runs of other parts", round.shown());
                told = true;
            }
            std::thread::sleep(LOOK);
        }
        // Each reduction serves the starts of one scene only.
        if options.shard.is_none() {
            std::fs::remove_dir_all(rounds.runs().0.join("runs").join(".reduced")).ok();
        }
        Ok(true)
    }

    fn has_run(&self, points: &[Point]) -> Result<bool> {
        for wanted in Rounds::wanted(points) {
            if let Stage::Done = self.rounds.runs().stage(Keep::Numbers, wanted)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Why the first of these scenes that could not be run has no run.
    fn why_not(&self, points: &[Point]) -> String {
        let stage = |wanted| self.rounds.runs().stage(Keep::Numbers, wanted);
        let why = Rounds::wanted(points).find_map(|wanted| match stage(wanted) {
            Ok(Stage::Refused(why) | Stage::Failed(why)) => Some(why),
            _ => None,
        });
        why.unwrap_or_default()
    }

    /// Runs draws of the posterior.
    fn check(&self, posterior: &Posterior) -> Result<Option<Vec<Row>>> {
        let count = self.inference.budget.check;
        if count == 0 {
            return Ok(Some(Vec::new()));
        }
        let points = match self.rounds.read(Round::Check)? {
            Some(points) => points,
            None => {
                let step = (posterior.draws.len() / count).max(1);
                let draws: Vec<Vec<f64>> =
                    posterior.draws.iter().step_by(step).take(count).cloned().collect();
                self.rounds.plan(Round::Check, &draws)?
            }
        };
        if !self.make(Round::Check, &points)? {
            return Ok(None);
        }
        outputs::rows_of_readings(self.inference, &self.rounds, &points, 1).map(Some)
    }

    /// Runs scenes drawn from the prior, beyond the points that the first round has used.
    fn truths(&self, count: usize) -> Result<Option<Vec<Row>>> {
        let points = match self.rounds.read(Round::Truths)? {
            Some(points) if points.len() >= count => points,
            _ => self.rounds.plan(Round::Truths, &self.first(count, 1 << 14)?)?,
        };
        if !self.make(Round::Truths, &points)? {
            return Ok(None);
        }
        outputs::rows_of_readings(self.inference, &self.rounds, &points, 1).map(Some)
    }
}
