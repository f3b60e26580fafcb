//! `cargo xtask study kills`: runs with their reports, and campaigns, are disturbed at random moments and continued;
//! their files must be those of undisturbed ones, and the report the one that the samples give.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use anyhow::{Context, Result, bail, ensure};

use crate::{Answer, Host};
use stribeck_scene::dice::Dice;

/// Flags of `study kills`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// How often a run is killed
    #[arg(long, default_value_t = 100)]
    kills: usize,
    /// Length of the run [ms of simulated time]
    #[arg(long, default_value_t = 1.5)]
    duration_ms: f64,
    /// Where the sequence of moments begins
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Instead of a number of kills: disturbs runs and campaigns by turns for this time
    #[arg(long, value_name = "H")]
    hours: Option<f64>,
    /// With --hours: a folder on a small file system of its own, which is filled up now and then
    #[arg(long, value_name = "FOLDER", requires = "hours")]
    disk: Option<PathBuf>,
    /// With --hours: the library libfaketimeMT.so.1, with which clocks jump by up to a year
    #[arg(long, value_name = "LIBRARY", requires = "hours")]
    clock: Option<PathBuf>,
}

/// A process that does not end within this time counts as hanging [s].
const PATIENCE_S: f64 = 600.0;

/// A file system that takes a file of this size is not filled up [bytes].
const LARGE_DISK: u64 = 1 << 30;

/// Largest distance of a clock from the right time [s].
const YEAR_S: f64 = 3.2e7;

/// What is disturbed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Job {
    /// One run, continued from its checkpoint, and its report.
    Run,
    /// 64 runs, of which those that are not complete are run again.
    Campaign,
}

impl Job {
    /// Files that must be equal, with their names: samples, energies and the scene of a run, the tables of a
    /// campaign.
    fn files(self, folder: &Path) -> Result<Vec<(&'static str, Vec<u8>)>> {
        let names: &[&'static str] = match self {
            Self::Run => &["trace.npy", "energy.npy", "scene.ron"],
            Self::Campaign => &["runs.parquet", "events.parquet", "signals.parquet", "DATASHEET.md"],
        };
        let read = |name: &&'static str| {
            let path = folder.join(name);
            Ok((*name, fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?))
        };
        names.iter().map(read).collect()
    }
}

#[derive(Debug, Clone, Copy)]
enum Disturbance {
    Kill,
    Terminate,
    FillDisk,
}

/// What was done, and what came of it.
#[derive(Debug, Default, Clone)]
struct Tally {
    kills: usize,
    terminated: usize,
    full_disks: usize,
    jumps: usize,
    /// While a run was being continued.
    again: usize,
    /// Between the last step and the end of the report.
    in_report: usize,
    /// Before there was a checkpoint: the run restarts.
    too_early: usize,
    /// Runs and campaigns that came to their end.
    finished: [usize; 2],
    /// Largest memory of the processes of each campaign [MiB].
    memory_mib: Vec<f64>,
}

impl Tally {
    fn disturbances(&self) -> usize {
        self.kills + self.terminated + self.full_disks
    }

    /// Largest memory in the first and the last quarter of the campaigns [MiB].
    fn memory(&self) -> [Option<f64>; 2] {
        let quarter = self.memory_mib.len().div_ceil(4);
        let (first, last) =
            (&self.memory_mib[..quarter], &self.memory_mib[self.memory_mib.len() - quarter..]);
        [first, last].map(|all| all.iter().copied().reduce(f64::max))
    }
}

pub(crate) fn measure(options: &Options, host: &Host) -> Result<Answer> {
    let place = options.disk.clone().unwrap_or_else(std::env::temp_dir);
    let folder = place.join(format!("stribeck-kills-{}", std::process::id()));
    fs::create_dir_all(&folder).context("cannot make a folder for the runs")?;
    let began = host.seconds();
    let done = Disturber { options, host, folder: &folder, began }.disturb_all();
    let tally = done?;
    fs::remove_dir_all(&folder).ok();
    let [runs, campaigns] = tally.finished;
    let [first, last] = tally.memory();
    let said = format!(
        "{} kills, {} requests to end, {} full disks and {} jumps of the clock within {:.2} hours, {} of them while a \
         run was being continued, {} during its report and {} before its first checkpoint: {runs} runs and {campaigns} campaigns with the \
         bytes of undisturbed ones; campaigns took {first:.0?} MiB in the first quarter and {last:.0?} in the last",
        tally.kills,
        tally.terminated,
        tally.full_disks,
        tally.jumps,
        (host.seconds() - began) / 3600.0,
        tally.again,
        tally.in_report,
        tally.too_early
    );
    Ok(Answer { said: Some(said), ..Answer::default() })
}

/// Starts runs and campaigns and disturbs them.
struct Disturber<'a> {
    options: &'a Options,
    host: &'a Host,
    folder: &'a Path,
    /// [s]
    began: f64,
}

impl Disturber<'_> {
    fn disturb_all(&self) -> Result<Tally> {
        let jobs = if self.options.hours.is_some() { &[Job::Run, Job::Campaign][..] } else { &[Job::Run] };
        let undisturbed = jobs.iter().map(|job| {
            let (folder, began) = (self.folder.join("whole"), self.host.seconds());
            self.accompany(self.start(*job, &folder, 1)?, None, &mut Dice::new(0), &mut Tally::default())?;
            let found = (self.host.seconds() - began, job.files(&folder)?);
            fs::remove_dir_all(&folder)?;
            Ok(found)
        });
        let undisturbed = undisturbed.collect::<Result<Vec<_>>>()?;

        let (mut tally, mut dice) = (Tally::default(), Dice::new(self.options.seed));
        for at in (0..jobs.len()).cycle() {
            if self.enough(&tally) {
                break;
            }
            let (job, (length, expected)) = (jobs[at], &undisturbed[at]);
            let folder = self.folder.join("disturbed");
            self.disturb(job, &folder, *length, &mut dice, &mut tally)?;
            for (found, expected) in job.files(&folder)?.iter().zip(expected) {
                ensure!(
                    found == expected,
                    "{tally:?}: {} in {} is not that of an undisturbed {job:?}",
                    found.0,
                    folder.display()
                );
            }
            if job == Job::Run {
                self.check_report(&folder)?;
            }
            fs::remove_dir_all(&folder).ok();
            tally.finished[at] += 1;
            if tally.finished.iter().sum::<usize>().is_multiple_of(10) {
                self.host.say(&format!(
                    "{} disturbances, {:?} finished",
                    tally.disturbances(),
                    tally.finished
                ));
            }
        }
        Ok(tally)
    }

    fn enough(&self, tally: &Tally) -> bool {
        match self.options.hours {
            Some(hours) => self.host.seconds() - self.began > 3600.0 * hours,
            None => tally.kills >= self.options.kills,
        }
    }

    /// Disturbs a job until it comes to its end.
    fn disturb(
        &self,
        job: Job,
        folder: &Path,
        length: f64,
        dice: &mut Dice,
        tally: &mut Tally,
    ) -> Result<()> {
        let mut continued = false;
        let mut complete = BTreeMap::new();
        let mut memory_mib = 0_f64;
        loop {
            ensure!(!self.host.is_interrupted(), "interrupted");
            let threads = 1 + dice.below(2);
            let child = match job {
                Job::Run if continued => self.resume(folder, threads)?,
                _ => self.start(job, folder, threads)?,
            };
            // Half of those that are continued are left alone, so that many come to their end.
            let spared = self.enough(tally) || (continued && dice.one_in(2));
            // Some moments lie after the end: that job is whole.
            let disturbance = (!spared).then(|| (1.1 * length * dice.share(), self.disturbance(dice)));
            let before = tally.disturbances();
            memory_mib = memory_mib.max(self.accompany(child, disturbance, dice, tally)?);
            if tally.disturbances() == before {
                break;
            }
            tally.again += usize::from(continued);
            match job {
                Job::Run => {
                    if is_complete(folder).is_some() {
                        if folder.join("summary.json").exists() {
                            break;
                        }
                        tally.in_report += 1;
                    }
                    // Before the first checkpoint there is nothing to continue; the program refuses, and a new
                    // run is begun.
                    continued = folder.join("checkpoint").exists();
                    tally.too_early += usize::from(!continued);
                    if !continued && folder.join("run.json").exists() {
                        let output = self.resume(folder, 1)?.wait_with_output()?;
                        ensure!(!output.status.success(), "a run without a checkpoint was continued");
                    }
                    // What ended in an orderly way is kept, even where it has no sample.
                    if !continued && self.options.hours.is_some() {
                        fs::remove_dir_all(folder).ok();
                    }
                }
                Job::Campaign => {
                    continued = true;
                    let runs = fs::read_dir(folder.join("runs")).into_iter().flatten().flatten();
                    let found: BTreeMap<PathBuf, Vec<u8>> =
                        runs.filter_map(|run| Some((run.path(), is_complete(&run.path())?))).collect();
                    let lost = complete.iter().find(|(run, info)| found.get(*run) != Some(info));
                    ensure!(lost.is_none(), "a complete run was lost or made again: {lost:?}");
                    complete = found;
                }
            }
        }
        if job == Job::Campaign {
            tally.memory_mib.push(memory_mib);
        }
        Ok(())
    }

    fn disturbance(&self, dice: &mut Dice) -> Disturbance {
        match dice.below(3) {
            1 if self.options.hours.is_some() => Disturbance::Terminate,
            2 if self.options.disk.is_some() => Disturbance::FillDisk,
            _ => Disturbance::Kill,
        }
    }

    /// The program with arguments; its clock can be set with [`Self::set_clock`].
    fn stribeck(&self, arguments: &[&str], threads: usize) -> Result<Command> {
        let mut command = self.host.stribeck()?;
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(File::create(self.words())?);
        command.args(arguments).arg("--threads").arg(threads.to_string());
        if let Some(library) = &self.options.clock {
            // The monotonic clock of a system does not jump.
            command.env("LD_PRELOAD", library).env("FAKETIME_DONT_FAKE_MONOTONIC", "1");
            command.env("FAKETIME_TIMESTAMP_FILE", self.clock()).env("FAKETIME_CACHE_DURATION", "1");
        }
        Ok(command)
    }

    /// What the last process said.
    fn words(&self) -> PathBuf {
        std::env::temp_dir().join(format!("stribeck-kills-{}.txt", std::process::id()))
    }

    /// File from which libfaketime takes how far a clock is off.
    fn clock(&self) -> PathBuf {
        self.words().with_extension("clock")
    }

    fn set_clock(&self, dice: &mut Dice) -> Result<()> {
        let off = YEAR_S * (2.0 * dice.share() - 1.0).powi(3);
        fs::write(self.clock(), format!("{off:+.0}\n")).context("cannot set the clock")
    }

    fn start(&self, job: Job, folder: &Path, threads: usize) -> Result<Child> {
        let fixtures = self.host.root().join("fixtures");
        let mut command = match job {
            Job::Run => {
                let mut command = self.stribeck(&["simulate"], threads)?;
                command.arg(fixtures.join("scenes/quick.ron"));
                command.arg(format!("--set=solver.duration_ms={}", self.options.duration_ms));
                command.arg("--set=solver.start=sudden");
                command
            }
            Job::Campaign => {
                let mut command = self.stribeck(&["campaign", "--jobs=2"], threads)?;
                command.arg(fixtures.join("campaigns/quick64.ron"));
                command
            }
        };
        command.arg("--out").arg(folder).spawn().context("cannot start the program")
    }

    /// The report that is there must be the one that the samples give, with nothing half written beside it.
    fn check_report(&self, run: &Path) -> Result<()> {
        let before = report_of(run)?;
        let again =
            self.host.stribeck()?.arg("report").arg(run).output().context("cannot start the program")?;
        ensure!(again.status.success(), "no report: {}", String::from_utf8_lossy(&again.stderr));
        let after = report_of(run)?;
        let other = before.iter().find(|(path, bytes)| after.get(*path) != Some(bytes));
        let other = other.map(|(path, _)| path);
        ensure!(other.is_none() && before.len() == after.len(), "a report that is not whole: {other:?}");
        let half = before.keys().find(|path| path.extension().is_some_and(|end| end == "part"));
        ensure!(half.is_none(), "what a kill has left stays: {half:?}");
        Ok(())
    }

    fn resume(&self, run: &Path, threads: usize) -> Result<Child> {
        let mut command = self.stribeck(&["simulate"], threads)?;
        command.arg("--resume").arg(run).spawn().context("cannot continue a run")
    }

    /// Waits for the end of a process, and disturbs it if it is still there after the given time [s]; its
    /// largest memory [MiB].
    fn accompany(
        &self,
        mut child: Child,
        mut disturbance: Option<(f64, Disturbance)>,
        dice: &mut Dice,
        tally: &mut Tally,
    ) -> Result<f64> {
        let began = self.host.seconds();
        let (mut memory_mib, mut disturbed, mut next_jump) = (0.0, false, 0.0);
        loop {
            if let Some(status) = child.try_wait()? {
                fs::remove_file(self.ballast()).ok();
                let words = || fs::read_to_string(self.words()).unwrap_or_default();
                ensure!(disturbed || status.success(), "a run failed, {status}: {}", words());
                ensure!(status.code() != Some(101), "a panic: {}", words());
                return Ok(memory_mib);
            }
            memory_mib = peak_mib(child.id()).unwrap_or(0.0).max(memory_mib);
            let now = self.host.seconds() - began;
            if self.options.clock.is_some() && now >= next_jump {
                self.set_clock(dice)?;
                tally.jumps += 1;
                next_jump = now + 2.0 * dice.share();
            }
            if let Some((_, how)) = disturbance.take_if(|(moment, _)| now >= *moment) {
                disturbed = true;
                match how {
                    Disturbance::Kill => {
                        child.kill().context("it was there")?;
                        tally.kills += 1;
                    }
                    Disturbance::Terminate => {
                        Command::new("kill").arg("-TERM").arg(child.id().to_string()).status()?;
                        tally.terminated += 1;
                    }
                    Disturbance::FillDisk => {
                        self.fill_disk(dice)?;
                        tally.full_disks += 1;
                    }
                }
            }
            if now > PATIENCE_S {
                child.kill().ok();
                bail!("a run does not end");
            }
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    fn ballast(&self) -> PathBuf {
        self.folder.join("ballast")
    }

    /// Leaves nothing to two mebibytes of the file system.
    fn fill_disk(&self, dice: &mut Dice) -> Result<()> {
        let (mut file, block) = (File::create(self.ballast())?, [0; 1 << 16]);
        let mut size = 0;
        while size < LARGE_DISK && file.write_all(&block).is_ok() {
            size += block.len() as u64;
        }
        if size >= LARGE_DISK {
            fs::remove_file(self.ballast())?;
            bail!("{} is not on a small file system of its own", self.folder.display());
        }
        let rest = if dice.one_in(2) { dice.below(1 << 21) as u64 } else { 0 };
        file.set_len(size.saturating_sub(rest)).context("cannot shorten the ballast")
    }
}

/// What is known of a run that is complete.
fn is_complete(run: &Path) -> Option<Vec<u8>> {
    let info = fs::read_to_string(run.join("run.json")).ok()?;
    info.contains("\"status\": \"complete\"").then(|| info.into_bytes())
}

/// All files of a run and its figures.
fn report_of(run: &Path) -> Result<BTreeMap<PathBuf, Vec<u8>>> {
    let entries = [run.to_owned(), run.join("figures")].into_iter().map(fs::read_dir);
    let entries = entries.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().flatten();
    let files = entries.map(|entry| entry.path()).filter(|path| path.is_file());
    files.map(|path| Ok((path.clone(), fs::read(path)?))).collect()
}

/// Largest resident memory of a process so far [MiB].
fn peak_mib(process: u32) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}
