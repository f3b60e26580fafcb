//! `cargo xtask study kills`: a run is killed at random moments, and continued; its files must be those of an unbroken run.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};

use super::Sheet;
use crate::fuzz::Dice;
use crate::workspace;

/// Flags of `study kills`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// How often a run is killed
    #[arg(long, default_value_t = 100)]
    kills: usize,
    /// Length of the run [ms of simulated time]
    #[arg(long, default_value_t = 1.5)]
    duration_ms: f64,
    /// Where the sequence of moments begins
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Writes no page
    #[arg(long)]
    no_page: bool,
}

/// A process that does not end by itself within this time hangs.
const PATIENCE: Duration = Duration::from_secs(600);

/// Of the moments at which runs were killed.
#[derive(Debug, Default, Clone, Copy)]
struct Tally {
    kills: usize,
    /// Before there was a checkpoint: the run begins anew.
    too_early: usize,
    /// While it was being continued from an earlier kill.
    again: usize,
    /// Runs that came to their end after a kill.
    finished: usize,
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let folder = std::env::temp_dir().join(format!("stribeck-kills-{}", std::process::id()));
    std::fs::create_dir_all(&folder).context("cannot make a folder for the runs")?;
    let done = kill_all(options, &folder);
    std::fs::remove_dir_all(&folder).ok();
    let tally = done?;
    let said = format!(
        "{} kills (`kill -9`) at random moments of a run of {} ms: {} of them while it was being continued from an earlier one, {} before \
         its first checkpoint, so that it began anew. All {} runs came to their end with the bytes of an unbroken run, on one thread and \
         on two by turns.",
        tally.kills, options.duration_ms, tally.again, tally.too_early, tally.finished
    );
    println!("{said}");
    if !options.no_page {
        let mut sheet = Sheet::new("kills", "Killed runs");
        sheet.say(&said);
        for (what, n) in [
            ("kills", tally.kills),
            ("while continued", tally.again),
            ("before the first checkpoint", tally.too_early),
            ("runs with equal bytes", tally.finished),
        ] {
            sheet.value("kills", "all", what, Some(n as f64));
        }
        println!("{}", workspace::shown(&sheet.write()?));
    }
    Ok(ExitCode::SUCCESS)
}

fn kill_all(options: &Options, folder: &Path) -> Result<Tally> {
    let whole = folder.join("whole");
    let began = Instant::now();
    wait(start(options, &whole, 1)?)?;
    let length = began.elapsed().as_secs_f64();
    let expected = files(&whole)?;

    let (mut tally, mut dice) = (Tally::default(), Dice::new(options.seed));
    while tally.kills < options.kills {
        let run = folder.join(format!("run-{}", tally.finished));
        let mut continued = false;
        loop {
            let threads = 1 + dice.below(2);
            let mut child = if continued { resume(&run, threads)? } else { start(options, &run, threads)? };
            // Some moments lie after the end: that run is whole.
            let moment = Duration::from_secs_f64(1.1 * length * dice.share());
            // Half of the runs that are continued are left alone, so that many come to their end.
            let spared = tally.kills >= options.kills || (continued && dice.one_in(2));
            let killed = !spared && kill_after(&mut child, moment)?;
            if !killed {
                wait(child)?;
                break;
            }
            tally.kills += 1;
            tally.again += usize::from(continued);
            // Before the first checkpoint there is nothing to continue; the program says so, and a new run is taken.
            continued = run.join("checkpoint").exists();
            tally.too_early += usize::from(!continued);
            if !continued && run.join("run.json").exists() {
                let output = resume(&run, 1)?.wait_with_output()?;
                ensure!(!output.status.success(), "a run without a checkpoint was continued");
            }
        }
        let found = files(&run)?;
        if found != expected {
            bail!(
                "after {} kills: the files of {} differ from those of an unbroken run",
                tally.kills,
                run.display()
            );
        }
        std::fs::remove_dir_all(&run).ok();
        tally.finished += 1;
        if tally.finished.is_multiple_of(10) {
            eprintln!("{} kills, {} runs finished", tally.kills, tally.finished);
        }
    }
    Ok(tally)
}

fn command() -> Result<Command> {
    let mut command = Command::new(std::env::current_exe().context("where is this program?")?);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    Ok(command)
}

fn start(options: &Options, run: &Path, threads: usize) -> Result<Child> {
    let mut command = command()?;
    command.arg("simulate").arg(workspace::locate("fixtures/scenes/quick.ron".as_ref()));
    command.arg(format!("--set=solver.duration_ms={}", options.duration_ms));
    command.args(["--set=solver.start=sudden", "--no-report", "--threads"]).arg(threads.to_string());
    command.arg("--out").arg(run).spawn().context("cannot start a run")
}

fn resume(run: &Path, threads: usize) -> Result<Child> {
    let mut command = command()?;
    command.args(["simulate", "--no-report", "--threads"]).arg(threads.to_string()).arg("--resume").arg(run);
    command.spawn().context("cannot continue a run")
}

/// True when the process was still there to be killed.
fn kill_after(child: &mut Child, moment: Duration) -> Result<bool> {
    let began = Instant::now();
    while began.elapsed() < moment {
        if child.try_wait()?.is_some() {
            return Ok(false);
        }
        std::thread::sleep(Duration::from_millis(1).min(moment.saturating_sub(began.elapsed())));
    }
    let alive = child.try_wait()?.is_none();
    if alive {
        child.kill().context("it was there")?;
        child.wait()?;
    }
    Ok(alive)
}

fn wait(mut child: Child) -> Result<()> {
    let began = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            ensure!(status.success(), "a run failed: {status}");
            return Ok(());
        }
        if began.elapsed() > PATIENCE {
            child.kill().ok();
            bail!("a run does not end");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// What must be the same: samples, energies and the scene.
fn files(run: &Path) -> Result<Vec<Vec<u8>>> {
    let read = |name: &str| {
        let path: PathBuf = run.join(name);
        std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))
    };
    ["trace.npy", "energy.npy", "scene.ron"].into_iter().map(read).collect()
}
