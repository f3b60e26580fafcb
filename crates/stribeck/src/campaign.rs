//! `stribeck campaign`: many scenes made from one, each run in a folder of its own, and a data set of them
//! all.
//!
//! The truth lies in the folders of the runs, which are named by what is in their scenes. So the same command
//! starts and goes on, parts of it may run anywhere, in any order and at once, and the tables come out the
//! same.

mod datasheet;
mod emit;
mod memory;
mod tables;

use std::collections::HashSet;
use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_scene::Error;
use stribeck_scene::campaign::{Campaign, Variant};
use stribeck_scene::run_dir::{Keep, Run, RunDir, State, check_folder, write_atomic};
use stribeck_scene::scene::Scene;

use crate::interrupt::{self, Interrupt};
use crate::out::say;
use crate::place::{Place, shown};
use crate::side_by_side::{Due, Jobs, Shop};
use crate::simulate::{jobs, threads};

/// Flags of `campaign`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Campaign file, such as fixtures/campaigns/quick64.ron
    file: PathBuf,
    /// Folder of the campaign [default: runs/NAME, the name of the campaign]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Runs that go side by side [default: as many as cores]
    #[arg(long, value_name = "N", value_parser = jobs)]
    jobs: Option<usize>,
    /// Worker threads of all runs together [default: all cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    threads: Option<usize>,
    /// Most memory that runs side by side may take together [GB]; fewer go at a time where records are long
    /// [default: what the system has free]
    #[arg(long, value_name = "G", value_parser = gigabytes)]
    memory_gb: Option<f64>,
    /// Goes on with what is there, which the command does anyway: for scripts that say so
    #[arg(long)]
    resume: bool,
    /// Runs only part I of N, for several machines; whichever comes last makes the tables
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<Shard>,
    /// Runs nothing: prints the script that has an engine run the campaign in parts, to be sent to a file: `>
    /// job.sh`. Each part has the --jobs, --threads [default there: one] and --memory-gb of this command
    #[arg(long, value_name = "ENGINE", conflicts_with = "shard")]
    emit: Option<emit::Engine>,
    /// Parts of an emitted script [default: as many as runs, 16 at most]
    #[arg(long, value_name = "N", requires = "emit", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    shards: Option<u32>,
}

/// One part of the runs.
#[derive(Debug, Clone, Copy)]
struct Shard {
    part: usize,
    of: usize,
}

fn gigabytes(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|gb: &f64| gb.is_finite() && *gb > 0.0);
    number.ok_or_else(|| "not a positive number of gigabytes, such as 8".to_owned())
}

fn shard(text: &str) -> Result<Shard, String> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((part, of)) if part >= 1 && part <= of => Ok(Shard { part, of }),
        _ => Err("a part is written I/N with I from 1 to N: 3/16 is the third of sixteen".to_owned()),
    }
}

/// Held by the part that writes the files of the campaign itself.
const TURN: &str = ".turn";

const SCENES: &str = "scenes.txt";

/// The folder of a campaign is known by the former from the first moment of its first part on, and by the
/// latter when it is done.
const MARKS: [&str; 2] = [TURN, "runs.parquet"];

/// Where the things of a campaign are.
struct Folder(PathBuf);

impl Folder {
    /// The folder of a run: by its scene, so that equal scenes are run once.
    fn run(&self, scene: &Scene) -> PathBuf {
        self.0.join("runs").join(scene.hash())
    }

    /// Why a run cannot be made, if somebody has tried.
    fn failure(&self, scene: &Scene) -> PathBuf {
        self.0.join("failed").join(format!("{}.txt", scene.hash()))
    }

    /// Writes down why a run cannot be made.
    fn keep_failure(&self, scene: &Scene, why: &str) -> Result<()> {
        let path = self.failure(scene);
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        Ok(write_atomic(&path, why.as_bytes())?)
    }

    fn file(&self) -> PathBuf {
        self.0.join("campaign.ron")
    }

    /// Hashes of the scenes of all runs, by which a table or a scene file that was changed is known.
    fn scenes(&self) -> PathBuf {
        self.0.join(SCENES)
    }

    /// Waits until no other part writes the files of the campaign itself, for as long as what is returned
    /// lives, and removes what a part that was killed has left half written.
    fn take_turn(&self) -> Result<File> {
        let path = self.0.join(TURN);
        let lock = || {
            let file = File::options().write(true).create(true).truncate(false).open(&path)?;
            match file.lock() {
                Ok(()) => self.remove_left_overs(),
                // Some network file systems know no locks: there, parts do not meet by the names of what they
                // write.
                Err(error) if error.kind() == ErrorKind::Unsupported => {}
                Err(error) => return Err(error),
            }
            Ok(file)
        };
        lock().with_context(|| format!("cannot write `{}`", shown(&path)))
    }

    fn remove_left_overs(&self) {
        for entry in std::fs::read_dir(&self.0).into_iter().flatten().flatten() {
            if tables::is_half_written(&entry.file_name()) {
                std::fs::remove_file(entry.path()).ok();
            }
        }
    }
}

/// How far one run has come.
enum Stage {
    /// Its scene cannot be, or its run could not be made: the reason.
    Refused(String),
    Failed(String),
    /// At its end, but its numbers are not made, or more lies there than is to be kept.
    Ended,
    /// At its end; it may have diverged.
    Done,
    /// To be run or continued.
    Due,
}

fn stage(folder: &Folder, keep: Keep, variant: &Variant) -> Result<Stage> {
    let scene = match &variant.scene {
        Ok(scene) => scene,
        Err(why) => return Ok(Stage::Refused(why.clone())),
    };
    if let Ok(why) = std::fs::read_to_string(folder.failure(scene)) {
        return Ok(Stage::Failed(why));
    }
    let path = folder.run(scene);
    Ok(match State::of(&path, scene) {
        State::Done if is_settled(&path, keep)? => Stage::Done,
        State::Done => Stage::Ended,
        State::Other => bail!("`{}` holds a run of another scene: move it away", shown(&path)),
        State::New | State::Begun => Stage::Due,
    })
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let file = place.locate(&options.file);
    let campaign = Campaign::read(&file)?;
    let out = options.out.clone().unwrap_or_else(|| place.runs().join(&campaign.name));
    if let Some(engine) = options.emit {
        let part = emit::Part::of(options, campaign.runs.len());
        say!("{}", emit::script(engine, &file, &out, part)?.trim_end());
        return Ok(ExitCode::SUCCESS);
    }
    let folder = Folder(out);
    check_folder(&folder.0, &MARKS)?;
    enter(&folder, &campaign)?;
    let interrupt = Interrupt::listen()?;
    let mine = |variant: &&Variant| {
        options.shard.is_none_or(|Shard { part, of }| (variant.number - 1) % of == part - 1)
    };
    let mut due = Vec::new();
    // Equal scenes are run once.
    let mut seen = HashSet::new();
    for variant in campaign.runs.iter().filter(mine) {
        let Ok(scene) = &variant.scene else { continue };
        match stage(&folder, campaign.keep, variant)? {
            Stage::Due => {
                let (number, scene, folder) = (variant.number, scene.clone(), folder.run(scene));
                if seen.insert(folder.clone()) {
                    due.push(Due { number, scene, folder });
                }
            }
            // What a kill has left; it may free the space that others need.
            Stage::Ended if !interrupt.is_pressed() => {
                if let Err(why) = settle(&folder.run(scene), campaign.keep) {
                    eprintln!("warning: {why:#}");
                }
            }
            _ => {}
        }
    }
    let limit_gb = options.memory_gb.or_else(memory::free_gb).unwrap_or(f64::INFINITY);
    let need_gb = due.iter().map(|due| memory::need_gb(&due.scene)).fold(0.0, f64::max);
    if need_gb > limit_gb {
        eprintln!("warning: a run may take {need_gb:.1} GB, and there are {limit_gb:.1} GB for it");
    }
    let fitting = ((limit_gb / need_gb) as usize).max(1);
    let jobs = Jobs::of(options.jobs, options.threads, due.len().min(fitting));
    eprintln!(
        "{}: {} runs, {} of them to be run here, {} → {}",
        campaign.name,
        campaign.runs.len(),
        due.len(),
        jobs.shown(),
        shown(&folder.0)
    );
    let shop = Shop::new("run", &due, jobs, &interrupt);
    shop.run(&|due, error| {
        let kept = match error {
            Some(error) => folder.keep_failure(&due.scene, &error.to_string()),
            // By every job for its own run; the tables only gather.
            None if matches!(State::of(&due.folder, &due.scene), State::Done) => {
                settle(&due.folder, campaign.keep)
            }
            None => Ok(()),
        };
        if let Err(why) = kept {
            shop.say(&format!("warning: {why}"));
        }
    });
    conclude(&folder, &campaign, &interrupt, mine)
}

/// Writes a file that other parts may write at the same time.
fn replace(path: &Path, text: &str) -> Result<()> {
    tables::replace(path, |beside| Ok(std::fs::write(beside, text)?))
}

/// Makes the folder, or finds the same campaign in it.
fn enter(folder: &Folder, campaign: &Campaign) -> Result<()> {
    let (path, scenes) = (folder.file(), scenes(campaign));
    let there = std::fs::read_to_string(&path).ok();
    if let Some(there) = &there {
        ensure!(
            *there == campaign.text,
            "`{}` holds another campaign, or an earlier text of this one: give a folder with `--out`, or \
             compare `{}`",
            shown(&folder.0),
            shown(&path)
        );
        // Folders of earlier versions have no such list.
        if let Ok(before) = std::fs::read_to_string(folder.scenes()) {
            let same = before.lines().zip(scenes.lines()).take_while(|(before, now)| before == now).count();
            ensure!(
                before == scenes,
                "`{}` holds runs of other scenes, beginning with run {}: the table or the scene that this \
                 campaign names was changed \
                 since. Give a folder with `--out`, or put it back",
                shown(&folder.0),
                same + 1
            );
            return Ok(());
        }
    }
    std::fs::create_dir_all(&folder.0).with_context(|| format!("cannot make `{}`", shown(&folder.0)))?;
    let _turn = folder.take_turn()?;
    replace(&folder.scenes(), &scenes)?;
    if there.is_none() {
        replace(&path, &campaign.text)?;
    }
    Ok(())
}

/// A line for each run: its number and the hash of its scene.
fn scenes(campaign: &Campaign) -> String {
    let hash = |run: &Variant| run.scene.as_ref().map_or_else(|_| "refused".to_owned(), Scene::hash);
    campaign.runs.iter().map(|run| format!("{} {}\n", run.number, hash(run))).collect()
}

/// Makes the tables when every run has come to an end, and says how matters stand. A part of a campaign has
/// done what it was asked for when the runs that are its own, `mine`, have.
fn conclude(
    folder: &Folder,
    campaign: &Campaign,
    interrupt: &Interrupt,
    mine: impl Fn(&&Variant) -> bool,
) -> Result<ExitCode> {
    let mut stages = Vec::with_capacity(campaign.runs.len());
    let (mut left, mut left_here) = (0, 0);
    for variant in &campaign.runs {
        let stage = stage(folder, campaign.keep, variant)?;
        let due = matches!(stage, Stage::Due | Stage::Ended);
        left += usize::from(due);
        left_here += usize::from(due && mine(&variant));
        stages.push(stage);
    }
    if left > 0 {
        let all = campaign.runs.len();
        if left_here == 0 {
            eprintln!(
                "this part is done; {left} of {all} runs of others are not at their end. Whichever part ends \
                 last makes the tables"
            );
            return Ok(ExitCode::SUCCESS);
        }
        eprintln!(
            "{left} of {all} runs are not at their end or without their numbers; the same command goes on. \
             Tables are made when all are"
        );
        return Ok(ExitCode::from(if interrupt.is_pressed() { interrupt::EXIT_CODE } else { 1 }));
    }
    let rows = tables::rows(folder, campaign, &stages)?;
    let turn = folder.take_turn()?;
    let written = tables::write(folder, campaign, &rows)?;
    replace(&folder.0.join("DATASHEET.md"), &datasheet::text(campaign, &rows, &written))?;
    drop(turn);
    let complete = rows.iter().filter(|row| row.is_complete()).count();
    for row in rows.iter().filter(|row| !row.is_complete()).take(3) {
        let why = row.reason.as_deref().unwrap_or_default();
        let allowed = why.lines().find_map(|line| line.trim_start().strip_prefix("= allowed: "));
        let allowed = allowed.map_or_else(String::new, |allowed| format!("; allowed: {allowed}"));
        eprintln!("run {}: {}: {}{allowed}", row.number, row.status, why.lines().next().unwrap_or_default());
    }
    say!("{complete} of {} runs are complete: {}", rows.len(), shown(&folder.0.join(tables::RUNS)));
    Ok(if complete == 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Whether a run that has come to its end has its numbers and no more than is to be kept. Where all is kept,
/// numbers can be made at any time.
fn is_settled(path: &Path, keep: Keep) -> Result<bool> {
    let dir = RunDir::open(path)?;
    Ok(keep == Keep::All || dir.summary().exists() && dir.keeps_only(keep))
}

/// Makes the numbers of a run that has come to its end, and removes what is not to be kept.
fn settle(path: &Path, keep: Keep) -> Result<()> {
    // Nobody else reads what is being removed.
    let dir = match RunDir::reopen(path) {
        Err(Error::FolderInUse { .. }) => return Ok(()),
        dir => dir?,
    };
    if read_summary(&dir).is_none() {
        write_summary(&dir)?;
    }
    Ok(dir.keep_only(keep)?)
}

/// The summary of a run that has come to its end; it is made when it is not there.
fn summary_of(path: &Path) -> Result<serde_json::Value> {
    if let Some(there) = read_summary(&RunDir::open(path)?) {
        return Ok(there);
    }
    match RunDir::reopen(path) {
        // Another part makes the same one.
        Err(Error::FolderInUse { .. }) => Ok(serde_json::from_str(&summarise(path)?)?),
        dir => write_summary(&dir?),
    }
}

fn read_summary(dir: &RunDir) -> Option<serde_json::Value> {
    serde_json::from_slice(&std::fs::read(dir.summary()).ok()?).ok()
}

/// Makes the summary of a run whose folder is locked, so that nothing stays beside it when this one is
/// killed: the next one writes by the same name.
fn write_summary(dir: &RunDir) -> Result<serde_json::Value> {
    let text = summarise(dir.path())?;
    write_atomic(&dir.summary(), text.as_bytes())?;
    Ok(serde_json::from_str(&text)?)
}

fn summarise(path: &Path) -> Result<String> {
    let findings = Findings::of(&Record::new(&Run::read(path)?)?)?;
    Ok(serde_json::to_string_pretty(&findings.summary)? + "\n")
}
