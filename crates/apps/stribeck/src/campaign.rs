//! The campaign of a file, or of `stribeck sweep`: many scenes made from one, each run in a folder of its own, and
//! a data set of them all.
//!
//! The state is in the folders of the runs alone, which are named by the hashes of their scenes. So the same
//! command starts and continues, parts of it may run anywhere, in any order and at once, and the tables are
//! the same.

mod checksums;
mod datasheet;
mod names;
mod tables;

use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use stribeck_analysis::runs::OneOfMany;
use stribeck_report::{CampaignIndex, write_campaign};
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_store::campaign::{Campaign, OfBearing, Variant, in_a_line};
use stribeck_store::run_dir::{Keep, check_folder};

use crate::emit::{self, Part};
use crate::interrupt::{self, Interrupt};
use crate::many_runs::{ManyRuns, Share, Stage, Wanted};
use crate::out::{alert, caution, say, tell};
use crate::place::{Place, shown};
use crate::side_by_side::Left;
use checksums::CHECKSUMS;
use tables::Written;

/// Flags of `sweep` for the campaign of a file.
#[derive(Debug, clap::Args)]
pub(crate) struct OfFile {
    /// Continues, which the command does anyway: for scripts that state it
    #[arg(long)]
    resume: bool,
    /// Of a campaign file: runs only part I of N, for several machines; the last one makes the tables
    #[arg(long, value_name = "I/N", conflicts_with = "set", value_parser = shard)]
    shard: Option<Shard>,
    /// Of a campaign file: makes the first N runs and the tables of them; without it later the same folder goes on
    #[arg(long, value_name = "N", conflicts_with_all = ["set", "emit"], value_parser = clap::value_parser!(u32).range(1..))]
    max: Option<u32>,
    /// Of a campaign file: runs nothing, and prints the script that has an engine run it in parts, to be sent to a
    /// file: `> job.sh`. Each part has the --jobs, --threads [default there: one] and --memory-gb of this command
    #[arg(long, value_name = "ENGINE", conflicts_with_all = ["set", "shard"])]
    emit: Option<emit::Engine>,
    /// Parts of an emitted script [default: 16]; never more than runs, nor than the 1000 that an array of Slurm takes
    #[arg(long, value_name = "N", requires = "emit", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    shards: Option<u32>,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Shard {
    pub(crate) part: usize,
    pub(crate) of: usize,
}

pub(crate) fn shard(text: &str) -> Result<Shard, String> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((part, of)) if part >= 1 && part <= of => Ok(Shard { part, of }),
        _ => Err("a part is written I/N with I from 1 to N: 3/16 is the third of sixteen".to_owned()),
    }
}

/// Held by the part that writes the files of the campaign itself.
const TURN: &str = ".turn";

/// The text of the campaign in its folder.
pub(crate) const CAMPAIGN: &str = "campaign.ron";
pub(crate) const SCENES: &str = "scenes.txt";
const DATASHEET: &str = "DATASHEET.md";
const INDEX: &str = "index.html";
/// The card of a data set.
pub(crate) const CARD: &str = "CARD.md";

/// The first marks the folder of a campaign from the start of its first part on, the second when it is done.
pub(crate) const MARKS: [&str; 2] = [TURN, tables::RUNS];

/// Paths in the folder of a campaign.
struct Folder(ManyRuns);

impl Folder {
    fn file(&self) -> PathBuf {
        self.path().join(CAMPAIGN)
    }

    /// Hashes of the scenes of all runs, by which a changed table or scene file is detected.
    fn scenes(&self) -> PathBuf {
        self.path().join(SCENES)
    }

    fn path(&self) -> &Path {
        &self.0.0
    }

    /// Waits until no other part writes the files of the campaign itself, locks them until the returned value
    /// is dropped, and removes files that a killed part left half written.
    fn take_turn(&self) -> Result<File> {
        let path = self.path().join(TURN);
        let lock = || {
            let file = File::options().write(true).create(true).truncate(false).open(&path)?;
            match file.lock() {
                Ok(()) => self.remove_left_overs(),
                // Some network file systems have no locks: there, parts write under different names.
                Err(error) if error.kind() == ErrorKind::Unsupported => {}
                Err(error) => return Err(error),
            }
            Ok(file)
        };
        lock().with_context(|| format!("cannot write `{}`", shown(&path)))
    }

    fn remove_left_overs(&self) {
        for entry in std::fs::read_dir(self.path()).into_iter().flatten().flatten() {
            if tables::is_half_written(&entry.file_name()) {
                std::fs::remove_file(entry.path()).ok();
            }
        }
    }
}

impl<'a> From<&'a Variant> for Wanted<'a> {
    fn from(variant: &'a Variant) -> Self {
        Self { number: variant.number, scene: variant.scene.as_ref().map_err(String::as_str) }
    }
}

/// Runs the campaign of a file in `out`, or the part of it that the flags say; `keep` in the place of what the file
/// keeps.
pub(crate) fn run(
    file: &Path,
    keep: Option<Keep>,
    out: Option<PathBuf>,
    share: Share,
    options: &OfFile,
    place: &Place,
) -> Result<ExitCode> {
    let campaign = Campaign::read_first(file, keep, options.max.map_or(usize::MAX, |most| most as usize))?;
    let out = out.unwrap_or_else(|| place.runs().join(&campaign.name));
    if let Some(engine) = options.emit {
        announce(&campaign);
        let part = Part::new(options.shards, campaign.runs.len(), engine, share);
        say!("{}", emit::script(engine, "sweep", file, &out, part)?.trim_end());
        return Ok(ExitCode::SUCCESS);
    }
    carry_out(&campaign, out, share, options.shard)
}

/// Runs the outstanding runs of a campaign, or of one part of it, in `out`, and makes its tables when all are
/// done.
pub(crate) fn carry_out(
    campaign: &Campaign,
    out: PathBuf,
    share: Share,
    shard: Option<Shard>,
) -> Result<ExitCode> {
    let folder = Folder(ManyRuns(out));
    check_folder(folder.path(), &MARKS)?;
    announce(campaign);
    enter(&folder, campaign)?;
    let interrupt = Interrupt::listen()?;
    let mine =
        |variant: &&Variant| shard.is_none_or(|Shard { part, of }| (variant.number - 1) % of == part - 1);
    let due = folder.0.due(campaign.keep, campaign.runs.iter().filter(mine).map(Wanted::from), &interrupt)?;
    let left = folder.0.make(campaign.keep, &due, share, &interrupt, &|jobs| {
        tell!(
            "{}: {} runs, {} of them to be run here, {} → {}",
            campaign.name,
            campaign.runs.len(),
            due.len(),
            jobs.shown(),
            shown(folder.path())
        );
    });
    conclude(&folder, campaign, &interrupt, &left, mine)
}

/// Reasons for refused runs that are listed.
const MOST_REASONS: usize = 10;

/// Says before the first run what is not as the file has it: fields that a bearing replaces, and runs that cannot
/// be.
pub(crate) fn announce(campaign: &Campaign) {
    if !campaign.replaced.is_empty() {
        let of_field = |OfBearing { field, written, now }: &OfBearing| {
            let numbers: Vec<f64> = now.iter().filter_map(|value| value.parse().ok()).collect();
            let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
            let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let now = if least < most { format!("{least} to {most}") } else { now.join(", ") };
            format!("`{field}` {now} instead of {written}")
        };
        caution!(
            "with each bearing its surroundings change, in the place of those of the scene file: {}. Give with \
             --set (in a campaign file: `set`) what is to stay",
            campaign.replaced.iter().map(of_field).collect::<Vec<_>>().join(", ")
        );
    }
    let refused = campaign.refused();
    let count: usize = refused.iter().map(|refused| refused.runs.len()).sum();
    if count > 0 {
        caution!(
            "{count} of {} runs cannot be, and get a row with their reason in place of a run:",
            campaign.runs.len()
        );
    }
    refused.iter().take(MOST_REASONS).for_each(|refused| alert!("  {refused}"));
    if refused.len() > MOST_REASONS {
        alert!("  … and {} reasons more", refused.len() - MOST_REASONS);
    }
    for lost in campaign.lost_labels() {
        caution!("{lost}");
    }
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
            "`{}` holds another campaign, or an earlier text of this one, or one with another `--keep`: give a \
             folder with `--out`, or compare `{}`",
            shown(folder.path()),
            shown(&path)
        );
        // Folders of earlier versions have no such list.
        if let Ok(before) = std::fs::read_to_string(folder.scenes()) {
            let same = before.lines().zip(scenes.lines()).take_while(|(before, now)| before == now).count();
            // One of them may be the beginning of the other, by `--max`.
            ensure!(
                same == before.lines().count().min(scenes.lines().count()),
                "`{}` holds runs of other scenes, beginning with run {}: the table or the scene that this \
                 campaign names was changed since. Give a folder with `--out`, or put it back",
                shown(folder.path()),
                same + 1
            );
            if before.len() >= scenes.len() {
                return Ok(());
            }
        }
    }
    std::fs::create_dir_all(folder.path())
        .with_context(|| format!("cannot make `{}`", shown(folder.path())))?;
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

/// Makes the tables when every run has ended, and prints the state. A part of a campaign is complete when its
/// own runs, `mine`, are.
fn conclude(
    folder: &Folder,
    campaign: &Campaign,
    interrupt: &Interrupt,
    why: &Left,
    mine: impl Fn(&&Variant) -> bool,
) -> Result<ExitCode> {
    names::link(folder, campaign);
    let mut stages = Vec::with_capacity(campaign.runs.len());
    let (mut left, mut left_here) = (0, 0);
    for variant in &campaign.runs {
        let stage = folder.0.stage(campaign.keep, variant.into())?;
        let due = matches!(stage, Stage::Due | Stage::Ended);
        left += usize::from(due);
        left_here += usize::from(due && mine(&variant));
        stages.push(stage);
    }
    if left > 0 {
        let all = campaign.runs.len();
        if left_here == 0 {
            tell!(
                "this part is done; {left} of {all} runs of others are not at their end. Whichever part ends \
                 last makes the tables"
            );
            return Ok(ExitCode::SUCCESS);
        }
        why.say((left, all), "run", "The same command goes on. Tables are made when all are");
        return Ok(ExitCode::from(if interrupt.is_pressed() { interrupt::EXIT_CODE } else { 1 }));
    }
    let rows = tables::rows(folder, campaign, &stages)?;
    let turn = folder.take_turn()?;
    let written = tables::write(folder, campaign, &rows)?;
    replace(&folder.path().join(DATASHEET), &datasheet::text(campaign, &rows, &written))?;
    if let Some(data_set) = &campaign.data_set {
        let card = datasheet::card(data_set, campaign, &rows, &written);
        replace(&folder.path().join(CARD), &card)?;
        let tables = [CARD, DATASHEET, CAMPAIGN, tables::RUNS, tables::EVENTS].map(str::to_owned);
        let files: Vec<String> = tables.into_iter().chain(written.records.iter().cloned()).collect();
        replace(&folder.path().join(CHECKSUMS), &checksums::text(folder.path(), &files)?)?;
    }
    let index = index(campaign, rows, &written);
    write_campaign(folder.path(), &index)?;
    drop(turn);
    let rows = index.runs;
    let complete = rows.iter().filter(|one| one.is_complete()).count();
    let all = rows.len();
    // Refused ones are announced.
    for OneOfMany { row, .. } in
        rows.iter().filter(|one| !one.is_complete() && one.row.status != "refused").take(3)
    {
        alert!("run {}: {}: {}", row.run, row.status, in_a_line(row.reason.as_deref().unwrap_or_default()));
    }
    say!("{complete} of {all} runs are complete: {}", shown(&folder.path().join(tables::RUNS)));
    say!("page: {}", shown(&folder.path().join(INDEX)));
    Ok(if complete == 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// The bearing of a scene in words: its name, or its elements.
fn in_words(scene: &Scene) -> String {
    let b = &scene.bearing;
    let elements = format!(
        "{} rolling elements of {} mm on a pitch circle of {:.1} mm",
        b.rollers,
        b.roller_diameter_mm,
        0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm)
    );
    let model = if scene.model == ModelScene::Full { "in finite elements" } else { "by the reduced model" };
    match b.designation.as_str() {
        "" => format!("a bearing of {elements}, {model},"),
        name => format!("a {name} ({elements}), {model},"),
    }
}

/// Content of the campaign's page.
fn index(campaign: &Campaign, runs: Vec<OneOfMany>, written: &Written) -> CampaignIndex {
    let mut files = vec![
        (DATASHEET, "what the data set holds, its limits, and every column with its unit"),
        (tables::RUNS, "a row a run, with the truth and every number of its summary"),
        (tables::EVENTS, "a row for each passage of a roller over a spall of a raceway"),
    ];
    if !written.signals.is_empty() {
        files.push((tables::SIGNALS, "a row for each sample of the accelerations"));
    }
    if campaign.data_set.is_some() {
        files.push((CARD, "the card of the data set, with its licence and how to load it"));
        files.push((CHECKSUMS, "checksums of its files"));
    }
    files.push((CAMPAIGN, "the campaign, as it was run"));
    let varies = campaign.fields.iter().any(|field| field.starts_with("bearing"));
    let scene = campaign.runs.iter().find_map(|run| run.scene.as_ref().ok()).filter(|_| !varies);
    let refused = campaign.refused().into_iter().take(MOST_REASONS).map(|refused| refused.to_string());
    CampaignIndex {
        name: campaign.name.clone(),
        bearing: scene.map(in_words),
        fields: campaign.fields.clone(),
        runs,
        notes: refused.chain(campaign.lost_labels()).collect(),
        files: files.into_iter().map(|(file, what)| (file.to_owned(), what.to_owned())).collect(),
    }
}
