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
//! Equal files make equal scenes. What a variant is lies in its scene alone, so a run is named by the scene's content.

use std::path::{Path, PathBuf};

use ron::value::RawValue;
use serde::Deserialize;

use crate::dice::Dice;
use crate::ensemble::start;
use crate::run_dir::Keep;
use crate::scene::Scene;
use crate::scene_file::dialect;

/// Most runs of a campaign.
pub const MOST_RUNS: usize = 1_000_000;

/// Most runs of a Sobol sequence.
const MOST_OF_SOBOL: usize = 1 << 16;

/// What lies in a campaign's file.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename = "campaign")]
struct Text {
    name: String,
    #[serde(default)]
    scene: Option<PathBuf>,
    #[serde(default)]
    set: Vec<String>,
    #[serde(default = "one")]
    seed: u64,
    #[serde(default = "one_start")]
    starts: usize,
    variants: Variants,
    #[serde(default)]
    split: Split,
    #[serde(default)]
    keep: Keep,
}

fn one() -> u64 {
    1
}

fn one_start() -> usize {
    1
}

/// How values are chosen.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Variants {
    /// Every value with every other.
    Grid(Vec<Axis>),
    /// Each of `count` equal parts of every range once.
    LatinHypercube { count: usize, over: Vec<Axis> },
    /// A scrambled Sobol sequence.
    Sobol { count: usize, over: Vec<Axis> },
    /// The rows of a CSV file, whose first row names the fields.
    Table(PathBuf),
}

/// A field and its values, or its range.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Axis {
    field: String,
    #[serde(default)]
    values: Vec<Box<RawValue>>,
    #[serde(default)]
    from: Option<f64>,
    #[serde(default)]
    to: Option<f64>,
    /// Evenly over the logarithm.
    #[serde(default)]
    log: bool,
}

/// Shares of the variants that a model learns from, is tuned with and is tested with.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Split {
    /// To learn from.
    pub train: f64,
    /// To tune with.
    pub validation: f64,
    /// To test with.
    pub test: f64,
}

impl Default for Split {
    fn default() -> Self {
        Self { train: 0.7, validation: 0.15, test: 0.15 }
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
    /// What was drawn follows from it.
    pub seed: u64,
    /// What stays of each run.
    pub keep: Keep,
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
    /// `train`, `validation` or `test`; the same for all starts of a variant, and for equal values.
    pub split: &'static str,
    /// The scene, or why there is none.
    pub scene: Result<Scene, String>,
}

impl Campaign {
    /// Reads a campaign's file and makes its scenes. Paths in it count from its folder.
    ///
    /// # Errors
    /// What is wrong with the file, with its line. A scene that cannot be is no error here: its variant says why.
    pub fn read(path: &Path) -> Result<Self, String> {
        let shown = path.display();
        let text =
            std::fs::read_to_string(path).map_err(|e| format!("cannot read campaign `{shown}`: {e}"))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&text, folder).map_err(|why| format!("{shown}:{why}"))
    }

    fn parse(text: &str, folder: &Path) -> Result<Self, String> {
        let file: Text = dialect::dialect().from_str(text).map_err(|e| {
            format!(
                "{}:{}: {}. A campaign has `name`, `variants`, and may have `scene`, `set`, `seed`, `starts`, `split` and `keep`; \
                 fixtures/campaigns/quick64.ron is one",
                e.span.start.line, e.span.start.col, e.code
            )
        })?;
        let refuse = |field: &str, what: String| Err(format!(" `{field}` {what}"));
        if file.name.is_empty() || !file.name.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c)) {
            return refuse(
                "name",
                format!("is `{}`; letters, digits, `-` and `_` make a folder's name", file.name),
            );
        }
        if file.starts == 0 || file.starts > 10_000 {
            return refuse("starts", format!("is {}; it is 1 to 10000", file.starts));
        }
        let Split { train, validation, test } = file.split;
        let sum = train + validation + test;
        if !([train, validation, test].iter().all(|s| *s >= 0.0) && (sum - 1.0).abs() < 1e-9) {
            return refuse("split", format!("sums to {sum}; its three shares are not negative and sum to 1"));
        }
        let (fields, rows) = file.rows(folder).map_err(|why| format!(" {why}"))?;
        let count = rows.len() * file.starts;
        if count == 0 || count > MOST_RUNS {
            return refuse("variants", format!("make {count} runs; 1 to {MOST_RUNS} are possible"));
        }
        let base = file.scene.as_ref().map(|scene| folder.join(scene));
        let mut runs = Vec::with_capacity(count);
        for (row, values) in rows.iter().enumerate() {
            let assigned = fields.iter().zip(values).map(|(field, value)| format!("{field}={value}"));
            let set: Vec<String> = file.set.iter().cloned().chain(assigned).collect();
            let scene = match &base {
                Some(path) => Scene::read_with(path, &set),
                None => Scene::default().with_overrides(&set),
            };
            let scene = scene.map_err(|why| why.to_string());
            let split = split_of(&file.split, file.seed, values);
            for number in 1..=file.starts {
                let started = |scene: &Scene| {
                    if file.starts == 1 { scene.clone() } else { start(scene, file.seed, number) }
                };
                runs.push(Variant {
                    number: runs.len() + 1,
                    variant: row + 1,
                    start: number,
                    values: values.clone(),
                    split,
                    scene: scene.as_ref().map(started).map_err(Clone::clone),
                });
            }
        }
        Ok(Self { name: file.name, text: text.to_owned(), fields, runs, seed: file.seed, keep: file.keep })
    }
}

/// Fields, and the values of each variant.
type Rows = (Vec<String>, Vec<Vec<String>>);

impl Text {
    fn rows(&self, folder: &Path) -> Result<Rows, String> {
        match &self.variants {
            Variants::Grid(axes) => grid(axes),
            Variants::LatinHypercube { count, over } => {
                let places = latin_hypercube(self.seed, *count, over.len());
                drawn(over, *count, MOST_RUNS, &|row, axis| places[axis][row])
            }
            Variants::Sobol { count, over } => {
                let seed = (self.seed ^ (self.seed >> 32)) as u32;
                let place =
                    |row: usize, axis: usize| f64::from(sobol_burley::sample(row as u32, axis as u32, seed));
                drawn(over, *count, MOST_OF_SOBOL, &place)
            }
            Variants::Table(path) => table(&folder.join(path)),
        }
    }
}

impl Axis {
    fn listed(&self) -> Vec<String> {
        self.values.iter().map(|value| value.get_ron().trim().to_owned()).collect()
    }

    /// The value at `share` of the way, 0 to 1.
    fn at(&self, share: f64) -> Result<String, String> {
        let values = self.listed();
        let field = &self.field;
        match (self.from, self.to) {
            (None, None) if !values.is_empty() => {
                let which = ((share * values.len() as f64) as usize).min(values.len() - 1);
                Ok(values[which].clone())
            }
            (Some(from), Some(to)) if values.is_empty() => {
                if !(from.is_finite() && to.is_finite() && from < to && (!self.log || from > 0.0)) {
                    return Err(format!(
                        "`{field}` goes from {from} to {to}; `from` is below `to`, and above 0 with `log: true`"
                    ));
                }
                let value =
                    if self.log { from * (to / from).powf(share) } else { from + share * (to - from) };
                // Seven digits: short to read in a scene, and finer than anything that is measured.
                Ok(format!("{}", format!("{value:.6e}").parse::<f64>().unwrap_or(value)))
            }
            _ => Err(format!("`{field}` takes either `values: […]` or both `from` and `to`")),
        }
    }
}

fn grid(axes: &[Axis]) -> Result<Rows, String> {
    let mut rows = vec![Vec::new()];
    for axis in axes {
        let values = axis.listed();
        if values.is_empty() || axis.from.is_some() || axis.to.is_some() {
            return Err(format!(
                "`{}`: a grid takes `values: […]`; `latin_hypercube` and `sobol` take ranges",
                axis.field
            ));
        }
        if rows.len().saturating_mul(values.len()) > MOST_RUNS {
            return Err(format!("the grid has more than {MOST_RUNS} variants"));
        }
        rows = rows
            .iter()
            .flat_map(|row: &Vec<String>| {
                values.iter().map(|value| [&row[..], std::slice::from_ref(value)].concat())
            })
            .collect();
    }
    Ok((axes.iter().map(|axis| axis.field.clone()).collect(), rows))
}

fn drawn(
    axes: &[Axis],
    count: usize,
    most: usize,
    place: &dyn Fn(usize, usize) -> f64,
) -> Result<Rows, String> {
    if count == 0 || count > most || axes.is_empty() || axes.len() > 256 {
        return Err(format!(
            "`variants` draws {count} points over {} fields; 1 to {most} over 1 to 256",
            axes.len()
        ));
    }
    let row = |row: usize| axes.iter().enumerate().map(|(n, axis)| axis.at(place(row, n))).collect();
    let rows: Result<Vec<Vec<String>>, String> = (0..count).map(row).collect();
    Ok((axes.iter().map(|axis| axis.field.clone()).collect(), rows?))
}

/// Places 0 to 1 by axis and row: each row in a part of its own.
fn latin_hypercube(seed: u64, count: usize, axes: usize) -> Vec<Vec<f64>> {
    let mut dice = Dice::new(seed);
    let axis = |_| {
        let mut parts: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            parts.swap(i, dice.below(i + 1));
        }
        parts.into_iter().map(|part| (part as f64 + dice.share()) / count as f64).collect()
    };
    (0..axes).map(axis).collect()
}

fn table(path: &Path) -> Result<Rows, String> {
    let text =
        std::fs::read_to_string(path).map_err(|e| format!("cannot read table `{}`: {e}", path.display()))?;
    let cells = |line: &str| line.split(',').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let Some((_, head)) = lines.next() else { return Err(format!("table `{}` is empty", path.display())) };
    let fields = cells(head);
    let mut rows = Vec::new();
    for (number, line) in lines {
        let row = cells(line);
        if row.len() != fields.len() {
            return Err(format!(
                "table `{}`, line {}: {} cells where the first line names {} fields",
                path.display(),
                number + 1,
                row.len(),
                fields.len()
            ));
        }
        rows.push(row);
    }
    Ok((fields, rows))
}

/// Which part of the data a variant belongs to: by its values, so that equal scenes are never on both sides.
fn split_of(split: &Split, seed: u64, values: &[String]) -> &'static str {
    const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0000_0100_0000_01b3;
    let bytes = values.iter().flat_map(|value| value.bytes().chain([0]));
    let number = bytes.fold(OFFSET_BASIS, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME));
    let share = Dice::stream(seed, number).share();
    if share < split.train {
        "train"
    } else if share < split.train + split.validation {
        "validation"
    } else {
        "test"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Campaign, String> {
        Campaign::parse(text, Path::new(""))
    }

    #[test]
    fn example_a_grid_has_every_value_with_every_other() {
        let text = "(name: \"g\", starts: 2, variants: grid([
            (field: \"operation.load_n\", values: [10000, 20000]),
            (field: \"bearing\", values: [\"NU 205\", \"NU 206\", \"6205\"]),
        ]))";
        let campaign = parse(text).unwrap();
        assert_eq!(campaign.runs.len(), 12);
        let last = &campaign.runs[11];
        assert_eq!(
            (last.variant, last.start, &last.values[..]),
            (6, 2, &["20000".to_owned(), "\"6205\"".to_owned()][..])
        );
        let scene = last.scene.as_ref().unwrap();
        assert_eq!((scene.bearing.designation.as_str(), scene.operation.load_n), ("6205", 20_000.0));
        assert_ne!(scene.hash(), campaign.runs[10].scene.as_ref().unwrap().hash());
        assert_eq!(campaign.runs[10].split, last.split);
    }

    #[test]
    fn invariant_designs_fill_their_ranges_and_repeat() {
        for design in ["latin_hypercube", "sobol"] {
            let text = format!(
                "(name: \"d\", seed: 7, variants: {design}(count: 64, over: [
                (field: \"operation.load_n\", from: 1000, to: 100000, log: true),
                (field: \"operation.speed_rpm\", from: 100, to: 900),
                (field: \"contact.surface\", values: [facet, arc])]))"
            );
            let (a, b) = (parse(&text).unwrap(), parse(&text).unwrap());
            assert!(a.runs.iter().zip(&b.runs).all(|(a, b)| a.values == b.values && a.split == b.split));
            // Each eighth of the range holds eight of the 64, by construction of both.
            let mut eighths = [0; 8];
            for run in &a.runs {
                let rpm: f64 = run.values[1].parse().unwrap();
                eighths[(((rpm - 100.0) / 100.0) as usize).min(7)] += 1;
                assert!(run.scene.is_ok(), "{:?}", run.scene);
            }
            assert_eq!(eighths, [8; 8], "{design}");
            let arcs = a.runs.iter().filter(|run| run.values[2] == "arc").count();
            assert_eq!(arcs, 32, "{design}");
        }
    }

    #[test]
    fn example_a_scene_that_cannot_be_is_a_row_with_its_reason() {
        let text = "(name: \"x\", variants: grid([(field: \"defect.depth_mm\", values: [0.2, 9])]))";
        let campaign = parse(text).unwrap();
        assert!(campaign.runs[0].scene.is_ok());
        assert!(campaign.runs[1].scene.as_ref().unwrap_err().contains("defect.depth_mm"));
    }

    #[test]
    fn refuses_campaigns_that_cannot_be() {
        for (text, says) in [
            ("(name: \"x\")", "variants"),
            ("(name: \"x y\", variants: grid([]))", "folder's name"),
            ("(name: \"x\", variants: grid([(field: \"a\", from: 1, to: 2)]))", "a grid takes"),
            ("(name: \"x\", variants: sobol(count: 0, over: []))", "0 points"),
            (
                "(name: \"x\", variants: sobol(count: 2, over: [(field: \"a\", from: 2, to: 1)]))",
                "below `to`",
            ),
            ("(name: \"x\", variants: table(\"none.csv\"))", "none.csv"),
            ("(name: \"x\", starts: 0, variants: grid([]))", "starts"),
            ("(name: \"x\", split: (train: 1, validation: 1, test: 1), variants: grid([]))", "sums to 3"),
            ("(nam: \"x\")", "1:2"),
        ] {
            let why = parse(text).unwrap_err();
            assert!(why.contains(says), "{text}: {why}");
        }
    }
}
