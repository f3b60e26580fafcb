//! `cargo xtask study kills`: a run is killed at random moments, and continued; its files must be those of an
//! unbroken run.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use anyhow::{Context, Result, bail, ensure};

use crate::{Answer, Host, Rows};
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
    /// Writes no page
    #[arg(long)]
    pub(crate) no_page: bool,
}

/// A process that does not end within this time counts as hanging [s].
const PATIENCE_S: f64 = 600.0;

/// Of the moments at which runs were killed.
#[derive(Debug, Default, Clone, Copy)]
struct Tally {
    kills: usize,
    /// Before there was a checkpoint: the run restarts.
    too_early: usize,
    /// While it was being continued from an earlier kill.
    again: usize,
    /// Runs that came to their end after a kill.
    finished: usize,
}

pub(crate) fn measure(options: &Options, host: &Host, rows: &mut Rows) -> Result<Answer> {
    let folder = std::env::temp_dir().join(format!("stribeck-kills-{}", std::process::id()));
    std::fs::create_dir_all(&folder).context("cannot make a folder for the runs")?;
    let done = Killer { options, host, folder: &folder }.kill_all();
    std::fs::remove_dir_all(&folder).ok();
    let tally = done?;
    let values = [
        ("kills", tally.kills),
        ("while continued", tally.again),
        ("before the first checkpoint", tally.too_early),
        ("runs with equal bytes", tally.finished),
    ];
    rows.values("kills", "all", values.map(|(what, n)| (what, n as f64)));
    rows.value("kills", "all", "ms of a run", options.duration_ms);
    let said = format!("{} kills, {} runs with the bytes of an unbroken run", tally.kills, tally.finished);
    Ok(Answer { said: Some(said), ..Answer::default() })
}

/// Starts runs and kills them.
struct Killer<'a> {
    options: &'a Options,
    host: &'a Host,
    folder: &'a Path,
}

impl Killer<'_> {
    fn kill_all(&self) -> Result<Tally> {
        let whole = self.folder.join("whole");
        let began = self.host.seconds();
        self.wait(self.start(&whole, 1)?)?;
        let length = self.host.seconds() - began;
        let expected = files(&whole)?;

        let (mut tally, mut dice) = (Tally::default(), Dice::new(self.options.seed));
        while tally.kills < self.options.kills {
            let run = self.folder.join(format!("run-{}", tally.finished));
            let mut continued = false;
            loop {
                ensure!(!self.host.is_interrupted(), "interrupted");
                let threads = 1 + dice.below(2);
                let mut child =
                    if continued { self.resume(&run, threads)? } else { self.start(&run, threads)? };
                // Some moments lie after the end: that run is whole.
                let moment = 1.1 * length * dice.share();
                // Half of the runs that are continued are left alone, so that many come to their end.
                let spared = tally.kills >= self.options.kills || (continued && dice.one_in(2));
                let killed = !spared && self.kill_after(&mut child, moment)?;
                if !killed {
                    self.wait(child)?;
                    break;
                }
                tally.kills += 1;
                tally.again += usize::from(continued);
                // Before the first checkpoint there is nothing to continue; the program refuses, and a new
                // run is begun.
                continued = run.join("checkpoint").exists();
                tally.too_early += usize::from(!continued);
                if !continued && run.join("run.json").exists() {
                    let output = self.resume(&run, 1)?.wait_with_output()?;
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
                self.host.say(&format!("{} kills, {} runs finished", tally.kills, tally.finished));
            }
        }
        Ok(tally)
    }

    fn simulate(&self, threads: usize) -> Result<Command> {
        let mut command = self.host.stribeck()?;
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command.args(["simulate", "--no-report", "--threads"]).arg(threads.to_string());
        Ok(command)
    }

    fn start(&self, run: &Path, threads: usize) -> Result<Child> {
        let mut command = self.simulate(threads)?;
        command.arg(self.host.root().join("fixtures/scenes/quick.ron"));
        command.arg(format!("--set=solver.duration_ms={}", self.options.duration_ms));
        command.arg("--set=solver.start=sudden").arg("--out").arg(run);
        command.spawn().context("cannot start a run")
    }

    fn resume(&self, run: &Path, threads: usize) -> Result<Child> {
        self.simulate(threads)?.arg("--resume").arg(run).spawn().context("cannot continue a run")
    }

    /// True when the process was still there to be killed `moment` seconds from now.
    fn kill_after(&self, child: &mut Child, moment: f64) -> Result<bool> {
        let began = self.host.seconds();
        while self.host.seconds() - began < moment {
            if child.try_wait()?.is_some() {
                return Ok(false);
            }
            let left = (moment - (self.host.seconds() - began)).max(0.0);
            std::thread::sleep(Duration::from_millis(1).min(Duration::from_secs_f64(left)));
        }
        let alive = child.try_wait()?.is_none();
        if alive {
            child.kill().context("it was there")?;
            child.wait()?;
        }
        Ok(alive)
    }

    fn wait(&self, mut child: Child) -> Result<()> {
        let began = self.host.seconds();
        loop {
            if let Some(status) = child.try_wait()? {
                ensure!(status.success(), "a run failed: {status}");
                return Ok(());
            }
            if self.host.seconds() - began > PATIENCE_S {
                child.kill().ok();
                bail!("a run does not end");
            }
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

/// Files that must be equal: samples, energies and the scene.
fn files(run: &Path) -> Result<Vec<Vec<u8>>> {
    let read = |name: &str| {
        let path: PathBuf = run.join(name);
        std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))
    };
    ["trace.npy", "energy.npy", "scene.ron"].into_iter().map(read).collect()
}
