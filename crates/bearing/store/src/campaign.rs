//! Campaigns: many scenes from one, by a grid, a design or a table over their fields.
//!
//! ```text
//! (
//!     name: "loads",
//!     scene: "../scenes/quick.ron",
//!     set: ["solver.duration_ms=0.3"],
//!     seed: 1,
//!     variants: sobol(count: 64, over: [
//!         (field: "operation.load_n", from: 5000, to: 50000, log: true),
//!         (field: "contact.surface", values: [facet, arc]),
//!     ]),
//!     keep: signals,
//! )
//! ```
//!
//! Equal files make equal scenes. A variant is defined by its scene alone, so a run is named by the scene's
//! content.

mod design;
mod document;
mod label;
mod refusal;
mod refused;
mod split;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use crate::run_dir::Keep;
use design::{Column, Rows, Times, Variants};
use document::unreadable;
pub use label::Label;
use refusal::{CAMPAIGN, File, varies};
pub use refused::{Refused, in_a_line};
use stribeck_scene::ensemble::start;
use stribeck_scene::fields::group;
use stribeck_scene::scene::Scene;
use stribeck_scene::scene_file::{self, Place, Problem, SceneError, replaced_by_bearing, without_mark};

/// Most runs of a campaign.
pub const MOST_RUNS: usize = 1_000_000;

/// Most starts of a variant.
const MOST_STARTS: usize = 10_000;

/// Values that no field takes are shown up to this many at once.
const MOST_PROBLEMS: usize = 10;

/// When there is such a value, others are looked for in this many variants: a range of a field that counts
/// has one in nearly all.
const MOST_LOOKED_AT: usize = 1000;

group! {
    /// Content of a campaign's file.
    struct Text {
        /// Its name.
        name: String = String::new(), required();
        /// The scene that all variants start from.
        scene: Option<String> = None;
        /// Overrides of that scene.
        set: Vec<String> = Vec::new();
        /// Seed of all draws.
        seed: u64 = 1;
        /// Starts of each variant.
        starts: usize = 1, within(1.0, MOST_STARTS as f64);
        /// How values are chosen.
        variants: Variants = Variants::Grid(Vec::new()), required();
        /// Shares of the variants.
        split: Split = Split::default();
        /// Files that are kept.
        keep: Keep = Keep::All;
        /// What makes its tables a data set to hand on.
        data_set: Option<DataSet> = None;
    }
}

group! {
    /// A data set to hand on: records in parts, a row a record, with a card and checksums.
    pub struct DataSet {
        /// Its title.
        pub title: String = String::new(), required();
        /// Licence, as SPDX names it.
        pub licence: String = String::new(), required();
        /// How to cite it.
        pub citation: String = String::new(), required();
        /// Files into which its records are parted.
        pub parts: usize = 16, within(1.0, 1000.0);
    }
}

group! {
    /// Shares of the variants that a model learns from, is tuned with and is tested with, in each fault of each
    /// bearing.
    pub struct Split: Copy {
        /// To learn from.
        pub train: f64 = 0.7, required();
        /// To tune with.
        pub validation: f64 = 0.15, required();
        /// To test with.
        pub test: f64 = 0.15, required();
    }
}

/// A campaign that can be run.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// Its name.
    pub name: String,
    /// The text of its file.
    pub text: String,
    /// Fields that vary, in the order of the file.
    pub fields: Vec<String>,
    /// Its runs, in order.
    pub runs: Vec<Variant>,
    /// Seed of the drawn points.
    pub seed: u64,
    /// Files that are kept of each run.
    pub keep: Keep,
    /// Fields of the scene's file in whose place each bearing brings its own.
    pub replaced: Vec<OfBearing>,
    /// What makes its tables a data set to hand on.
    pub data_set: Option<DataSet>,
}

/// A field of the scene's file that the bearings of a campaign replace.
#[derive(Debug, Clone, PartialEq)]
pub struct OfBearing {
    /// Dotted path.
    pub field: String,
    /// Its value in the file.
    pub written: String,
    /// Its values with the bearings, each once, in their order.
    pub now: Vec<String>,
}

/// One run of a campaign.
#[derive(Debug, Clone)]
pub struct Variant {
    /// Number of the run, from 1.
    pub number: usize,
    /// Number of its variant, from 1: the starts of one variant share it.
    pub variant: usize,
    /// Number of its start, from 1.
    pub start: usize,
    /// Values of the fields that vary, as they would be written.
    pub values: Vec<String>,
    /// `train`, `validation` or `test`; the same for all starts of a variant, and for variants of equal
    /// scenes.
    pub split: &'static str,
    /// What a model would learn of it; `None` of a scene that cannot be read.
    pub label: Option<Label>,
    /// The scene, or why there is none.
    pub scene: Result<Scene, String>,
}

impl Campaign {
    /// Reads a campaign's file and makes its scenes. Paths in it count from its folder.
    ///
    /// # Errors
    /// Mistakes in the file, with line and field: in its own fields, in fields of scenes that it names, in
    /// the scene that it starts from, and values of the wrong type. An impossible scene is no error here: its
    /// variant carries the reason.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::read_first(path, None, usize::MAX)
    }

    /// As [`Campaign::read`], of the file as if it had this `keep`; at `most` as many runs, the first ones.
    pub fn read_first(path: &Path, keep: Option<Keep>, most: usize) -> Result<Self, SceneError> {
        let shown = path.display().to_string();
        let text =
            std::fs::read_to_string(path).map_err(|e| unreadable(&shown, &CAMPAIGN, refusal::FILE, &e))?;
        let mut text = without_mark(&text).to_owned();
        if let Some(keep) = keep {
            let (file, File { tree, .. }) = File::read::<Text>(&shown, &text, &CAMPAIGN)?;
            let end_of = |field: &str| tree.get(field).map(|node| node.span.clone());
            match (end_of("keep"), end_of("name")) {
                _ if file.keep == keep => {}
                (Some(written), _) => text.replace_range(written, keep.word()),
                (None, Some(name)) => text.insert_str(name.end, &format!(", keep: {}", keep.word())),
                (None, None) => {}
            }
        }
        Self::of_text(&text, &shown, path.parent().unwrap_or(Path::new("")), most)
    }

    /// The campaign of a `text` that is to lie in `folder` as a file called `name`.
    pub fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, SceneError> {
        Self::of_text(text, name, folder, usize::MAX)
    }

    fn of_text(text: &str, name: &str, folder: &Path, most: usize) -> Result<Self, SceneError> {
        let (file, place): (Text, _) = File::read(name, text, &CAMPAIGN)?;
        let refuse = |field: &str, what: String| Err(place.refuse(field, format!("`{field}` {what}")));
        if file.name.is_empty() || !file.name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c)) {
            return refuse(
                "name",
                format!("is `{}`; letters, digits, `-` and `_` make a folder's name", file.name),
            );
        }
        let Split { train, validation, test } = file.split;
        let sum = train + validation + test;
        if !([train, validation, test].iter().all(|s| *s >= 0.0) && (sum - 1.0).abs() < 1e-9) {
            return refuse(
                "split",
                format!(
                    "is {train}, {validation} and {test}, and sums to {sum}; its three shares are from 0 to \
                     1 and sum to 1"
                ),
            );
        }
        let base = file.scene.as_ref().map(|scene| folder.join(scene));
        scene_file::readable(base.as_deref(), &file.set).map_err(|why| place.of_base(why))?;
        let mut rows = file
            .variants
            .rows(file.seed, folder, &place, &measures(&file, base.as_deref()))
            .map_err(|no| place.refuse(&no.at, no.why))?;
        check_fields(&rows, &place)?;
        let count = rows.values.len() * file.starts;
        if count == 0 || count > MOST_RUNS {
            return refuse("variants", format!("make {count} runs; 1 to {MOST_RUNS} are possible"));
        }
        rows.values.truncate(most.div_ceil(file.starts));
        let mut runs = variants(&file, base.as_deref(), &rows, &place)?;
        runs.truncate(most);
        let replaced = base.as_deref().map_or_else(Vec::new, |base| of_bearings(base, &file, &rows));
        let fields = rows.columns.into_iter().map(|column| column.name).collect();
        let text = text.to_owned();
        let Text { name, seed, keep, data_set, .. } = file;
        Ok(Self { name, text, fields, runs, seed, keep, replaced, data_set })
    }
}

/// Fields that no scene has, or that vary twice.
fn check_fields(rows: &Rows, place: &File<'_>) -> Result<(), SceneError> {
    for (column, Column { name: field, is_field, .. }) in rows.columns.iter().enumerate() {
        if let Some(problem) = scene_file::unknown_field(field).filter(|_| *is_field) {
            return Err(place.field(problem, rows, column));
        }
        if rows.columns[..column].iter().any(|before| before.name == *field) {
            let why = format!(
                "`{field}` is named twice: a field varies in one way, and is one column of the tables"
            );
            return Err(place.field(
                Problem::new(why, Place::Unwritten { file: String::new() }),
                rows,
                column,
            ));
        }
    }
    Ok(())
}

/// Numbers of bearings that ranges are multiples of, each found once.
fn measures<'a>(
    file: &'a Text,
    base: Option<&'a Path>,
) -> impl Fn(Option<&str>, Times) -> Result<f64, String> + 'a {
    let known: RefCell<BTreeMap<(Option<String>, Times), f64>> = RefCell::default();
    move |bearing, times| {
        let key = (bearing.map(str::to_owned), times);
        if let Some(number) = known.borrow().get(&key) {
            return Ok(*number);
        }
        let own = bearing.map(|bearing| format!("bearing={bearing}"));
        let set: Vec<String> = file.set.iter().cloned().chain(own).collect();
        let number = times.of(&scene_file::readable(base, &set).map_err(|why| why.to_string())?);
        known.borrow_mut().insert(key, number);
        Ok(number)
    }
}

/// Fields of the scene at `base` that its variants replace by naming another bearing.
fn of_bearings(base: &Path, file: &Text, rows: &Rows) -> Vec<OfBearing> {
    let column = rows.columns.iter().position(|column| column.name == "bearing");
    let mut seen: Vec<Option<&String>> = Vec::new();
    let mut all: Vec<OfBearing> = Vec::new();
    for (row, values) in rows.values.iter().enumerate() {
        let bearing = column.map(|column| &values[column]);
        if seen.contains(&bearing) {
            continue;
        }
        seen.push(bearing);
        let replaced = replaced_by_bearing(base, &file.overrides(rows, row));
        for found in replaced.into_iter().filter(|found| found.field != "name") {
            match all.iter_mut().find(|known| known.field == found.field) {
                Some(known) if known.now.contains(&found.now) => {}
                Some(known) => known.now.push(found.now),
                None => {
                    all.push(OfBearing { field: found.field, written: found.written, now: vec![found.now] });
                }
            }
        }
    }
    all
}

impl Text {
    /// All overrides of a variant.
    fn overrides(&self, rows: &Rows, row: usize) -> Vec<String> {
        self.set.iter().cloned().chain(rows.sets[row].iter().flatten().cloned()).collect()
    }
}

/// The runs of all variants. An impossible scene is no error: its run carries the reason.
fn variants(
    file: &Text,
    base: Option<&Path>,
    rows: &Rows,
    place: &File<'_>,
) -> Result<Vec<Variant>, SceneError> {
    let mut runs = Vec::with_capacity(rows.values.len() * file.starts);
    let mut numbers: Vec<split::Drawn> = Vec::with_capacity(runs.capacity());
    let mut unreadable: Vec<Problem> = Vec::new();
    let mut rows_to_look_at = MOST_LOOKED_AT;
    let paper = Scene::singh2014();
    // Findings that every variant so far has, in fields that do not vary.
    let mut common: Option<Vec<Problem>> = None;
    for (row, values) in rows.values.iter().enumerate() {
        let set = file.overrides(rows, row);
        let scene = match base {
            Some(path) => Scene::read_with(path, &set),
            None => paper.with_overrides(&set),
        };
        let problems = scene.as_ref().err().map_or(&[][..], SceneError::problems);
        for problem in problems.iter().filter(|problem| problem.is_unreadable) {
            let Some(column) = varies(problem, rows, row) else { continue };
            let problem = place.value(problem.clone(), rows, row, column);
            if unreadable.iter().all(|other| other.place != problem.place) {
                unreadable.push(problem);
            }
        }
        if !unreadable.is_empty() {
            rows_to_look_at -= 1;
            if unreadable.len() >= MOST_PROBLEMS || rows_to_look_at == 0 {
                break;
            }
            continue;
        }
        let outside = scene.as_ref().err().map_or_else(Vec::new, |why| place.outside(why, rows, row));
        match &mut common {
            None => common = Some(outside),
            Some(common) => common.retain(|problem| outside.contains(problem)),
        }
        // By the scene, however its values are written: equal scenes are in one part and have the same
        // starts, others have not.
        let drawn = scene.as_ref().map_or_else(|_| fold(values), nameless);
        let label = match &scene {
            Ok(scene) => Some(Label::of(scene)),
            Err(_) => scene_file::readable(base, &set).ok().map(|scene| Label::of(&scene)),
        };
        let scene = scene.map_err(|why| place.of_variant(&why, rows, row).to_string());
        for number in 1..=file.starts {
            let started = |scene: &Scene| {
                if file.starts == 1 { scene.clone() } else { start(scene, file.seed ^ drawn, number) }
            };
            numbers.push(drawn);
            runs.push(Variant {
                number: runs.len() + 1,
                variant: row + 1,
                start: number,
                values: values.clone(),
                split: "",
                label: label.clone(),
                scene: scene.as_ref().map(started).map_err(Clone::clone),
            });
        }
    }
    if !unreadable.is_empty() {
        unreadable.sort_by_key(Problem::line_and_column);
        return Err(SceneError::new(unreadable));
    }
    if let Some(common) = common.filter(|common| !common.is_empty()) {
        return Err(place.of_base(SceneError::new(common)));
    }
    split::assign(&mut runs, &numbers, &file.split, file.seed);
    Ok(runs)
}

/// The hash of a scene without its name, as a number.
fn nameless(scene: &Scene) -> u64 {
    let scene = Scene { name: String::new(), ..scene.clone() };
    u64::from_str_radix(&scene.hash(), 16).unwrap_or_default()
}

/// A number for the values of a variant that has no scene.
fn fold(values: &[String]) -> u64 {
    const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    let bytes = values.iter().flat_map(|value| value.bytes().chain([0]));
    bytes.fold(OFFSET_BASIS, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME))
}

#[cfg(test)]
mod tests;
