//! How the values of a campaign are chosen: a grid, a design over ranges, or the rows of a table.

use std::ops::Range;
use std::path::Path;

use super::MOST_RUNS;
use super::document::{File, Written};
use stribeck_scene::dice::Dice;
use stribeck_scene::fields::{self, group, words};
use stribeck_scene::scene_file::without_mark;

/// Most runs of a Sobol sequence.
const MOST_OF_SOBOL: usize = 1 << 16;

words! {
    /// How values are chosen.
    pub(super) enum Variants {
        /// Every value with every other.
        Grid(of: Vec<Axis>) = "grid",
        /// Each of `count` equal parts of every range once.
        LatinHypercube(of: Design) = "latin_hypercube",
        /// A scrambled Sobol sequence.
        Sobol(of: Design) = "sobol",
        /// The rows of a CSV file, whose first row names the fields.
        Table(of: String) = "table",
    }
}

group! {
    /// Points over ranges.
    pub(super) struct Design {
        /// How many.
        count: usize = 1, within(1.0, MOST_RUNS as f64), required();
        /// Over which fields.
        over: Vec<Axis> = Vec::new(), required();
    }
}

group! {
    /// A field and its values, or its range.
    pub(super) struct Axis {
        /// Path of the field.
        field: String = String::new(), required();
        /// Its values.
        values: Vec<Written> = Vec::new();
        /// Least value; of a field that counts, the whole numbers from here on.
        from: Option<f64> = None;
        /// Greatest value.
        to: Option<f64> = None;
        /// Evenly over the logarithm.
        log: bool = false;
    }
}

/// Fields, each with the place in the campaign's file that names it, and the values of each variant.
pub(super) struct Rows {
    pub(super) fields: Vec<(String, String)>,
    pub(super) values: Vec<Vec<String>>,
    /// Where they stand when that is not in the campaign's file.
    pub(super) table: Option<Table>,
}

/// A table's file.
pub(super) struct Table {
    pub(super) name: String,
    pub(super) text: String,
}

impl Rows {
    /// Overrides that set the value of a field in a variant, both from 0.
    pub(super) fn argument(&self, row: usize, column: usize) -> String {
        format!("{}={}", self.fields[column].0, self.values[row][column])
    }
}

impl Table {
    /// Lines that are not empty, each with its number from 0 and with where it begins.
    fn lines(&self) -> impl Iterator<Item = (usize, usize, &str)> {
        let begin = |line: &str| line.as_ptr() as usize - self.text.as_ptr() as usize;
        let lines = self.text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        lines.map(move |(number, line)| (number, begin(line), line))
    }

    /// Byte range of the cell of a variant and a field, both from 0.
    pub(super) fn cell(&self, row: usize, column: usize) -> Option<Range<usize>> {
        self.written(row + 1, column)
    }

    /// The same of the name of a field.
    pub(super) fn head(&self, column: usize) -> Range<usize> {
        self.written(0, column).unwrap_or(0..0)
    }

    fn written(&self, line: usize, column: usize) -> Option<Range<usize>> {
        let (_, begin, line) = self.lines().nth(line)?;
        let (within, _) = cells(line).into_iter().nth(column)?;
        Some(begin + within.start..begin + within.end)
    }
}

/// Cells of a line: the place and the content of each. One in quotes may hold commas, and quotes written
/// twice.
fn cells(line: &str) -> Vec<(Range<usize>, String)> {
    let mut cells = Vec::new();
    let mut begin = 0;
    loop {
        let rest = &line[begin..];
        let start = begin + (rest.len() - rest.trim_start().len());
        let quoted = line[start..].starts_with('"').then(|| closed(&line[start..])).flatten();
        let behind = start + quoted.unwrap_or(0);
        let end = line[behind..].find(',').map_or(line.len(), |comma| behind + comma);
        let written = line[start.min(end)..end].trim();
        let within = start.min(end)..start.min(end) + written.len();
        let text = match quoted {
            Some(length) if length == written.len() => written[1..length - 1].replace("\"\"", "\""),
            _ => written.to_owned(),
        };
        cells.push((within, text.trim().to_owned()));
        if end == line.len() {
            return cells;
        }
        begin = end + 1;
    }
}

/// How long a text in quotes is that stands at the beginning.
fn closed(text: &str) -> Option<usize> {
    let mut at = 1;
    loop {
        at += text[at..].find('"')? + 1;
        if !text[at..].starts_with('"') {
            return Some(at);
        }
        at += 1;
    }
}

/// A mistake: its place in the campaign's file, as a path, and the reason.
pub(super) struct Refused {
    pub(super) at: String,
    pub(super) why: String,
}

impl Refused {
    fn new(at: impl Into<String>, why: String) -> Self {
        Self { at: at.into(), why }
    }
}

impl Variants {
    /// The values of each variant. Tables are looked for from `folder`.
    pub(super) fn rows(&self, seed: u64, folder: &Path, file: &File<'_>) -> Result<Rows, Refused> {
        match self {
            Self::Grid(axes) => grid(axes, file),
            Self::LatinHypercube(Design { count, over }) => {
                possible(*count, MOST_RUNS, over)?;
                let places = latin_hypercube(seed, *count, over.len());
                drawn(over, *count, file, &|row, axis| places[axis][row])
            }
            Self::Sobol(Design { count, over }) => {
                possible(*count, MOST_OF_SOBOL, over)?;
                let seed = (seed ^ (seed >> 32)) as u32;
                let place =
                    |row: usize, axis: usize| f64::from(sobol_burley::sample(row as u32, axis as u32, seed));
                drawn(over, *count, file, &place)
            }
            Self::Table(path) => table(&folder.join(path)).map_err(|why| Refused::new("variants", why)),
        }
    }
}

impl Axis {
    fn listed(&self, file: &File<'_>) -> Vec<String> {
        self.values.iter().map(|value| file.written(value)).collect()
    }

    /// The value at `share` of the way, 0 to 1.
    fn at(&self, share: f64, file: &File<'_>) -> Result<String, String> {
        let values = self.listed(file);
        let field = &self.field;
        match (self.from, self.to) {
            (None, None) if !values.is_empty() => {
                let which = ((share * values.len() as f64) as usize).min(values.len() - 1);
                Ok(values[which].clone())
            }
            (Some(from), Some(to)) if values.is_empty() => {
                if !(from.is_finite() && to.is_finite() && from < to && (!self.log || from > 0.0)) {
                    return Err(format!(
                        "`{field}` goes from {from} to {to}; `from` is below `to`, and above 0 with `log: \
                         true`"
                    ));
                }
                let counts = fields::counts(field);
                // Whole numbers are equally often, each over a range of its own.
                let (from, to) = if counts { (from.ceil(), to.floor() + 1.0) } else { (from, to) };
                let value =
                    if self.log { from * (to / from).powf(share) } else { from + share * (to - from) };
                if counts {
                    return match value.floor().min(to - 1.0) {
                        whole if from < to => Ok(format!("{whole}")),
                        _ => Err(format!("`{field}` is a whole number, and none lies in its range")),
                    };
                }
                // Seven digits: short to read in a scene, and finer than anything that is measured.
                Ok(format!("{}", format!("{value:.6e}").parse::<f64>().unwrap_or(value)))
            }
            _ => Err(format!("`{field}` takes either `values: […]`, one at least, or both `from` and `to`")),
        }
    }
}

fn grid(axes: &[Axis], file: &File<'_>) -> Result<Rows, Refused> {
    if axes.is_empty() {
        let why = "the grid names no field; `(field: \"operation.load_n\", values: [10000, 20000])` is one";
        return Err(Refused::new("variants", why.to_owned()));
    }
    let mut rows = vec![Vec::new()];
    for (n, axis) in axes.iter().enumerate() {
        let values = axis.listed(file);
        if values.is_empty() || axis.from.is_some() || axis.to.is_some() {
            let why = "a grid takes `values: […]`, one at least; `latin_hypercube` and `sobol` take ranges";
            return Err(Refused::new(format!("variants[{n}]"), format!("`{}`: {why}", axis.field)));
        }
        if rows.len().saturating_mul(values.len()) > MOST_RUNS {
            return Err(Refused::new("variants", format!("the grid has more than {MOST_RUNS} variants")));
        }
        rows = rows
            .iter()
            .flat_map(|row: &Vec<String>| {
                values.iter().map(|value| [&row[..], std::slice::from_ref(value)].concat())
            })
            .collect();
    }
    let place = |(n, axis): (usize, &Axis)| (axis.field.clone(), format!("variants[{n}].field"));
    Ok(Rows { fields: axes.iter().enumerate().map(place).collect(), values: rows, table: None })
}

/// Whether the design can have this number of points over these fields.
fn possible(count: usize, most: usize, axes: &[Axis]) -> Result<(), Refused> {
    if count == 0 || count > most || axes.is_empty() || axes.len() > 256 {
        let why =
            format!("`variants` draws {count} points over {} fields; 1 to {most} over 1 to 256", axes.len());
        return Err(Refused::new("variants", why));
    }
    Ok(())
}

fn drawn(
    axes: &[Axis],
    count: usize,
    file: &File<'_>,
    place: &dyn Fn(usize, usize) -> f64,
) -> Result<Rows, Refused> {
    let value = |row, (n, axis): (usize, &Axis)| {
        axis.at(place(row, n), file).map_err(|why| Refused::new(format!("variants.over[{n}]"), why))
    };
    let row = |row: usize| axes.iter().enumerate().map(|axis| value(row, axis)).collect();
    let values: Result<Vec<Vec<String>>, Refused> = (0..count).map(row).collect();
    let place = |(n, axis): (usize, &Axis)| (axis.field.clone(), format!("variants.over[{n}].field"));
    Ok(Rows { fields: axes.iter().enumerate().map(place).collect(), values: values?, table: None })
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
    let table = Table { name: path.display().to_string(), text: without_mark(&text).to_owned() };
    let texts = |line: &str| cells(line).into_iter().map(|(_, text)| text).collect::<Vec<_>>();
    let mut lines = table.lines();
    let Some((_, _, head)) = lines.next() else { return Err(format!("table `{}` is empty", table.name)) };
    let fields = texts(head);
    if fields.len() == 1 && head.contains(';') {
        return Err(format!(
            "table `{}`, line 1: cells are parted by semicolons; save it with commas, and numbers with \
             points",
            table.name
        ));
    }
    if let Some(empty) = fields.iter().position(String::is_empty) {
        return Err(format!(
            "table `{}`, line 1: column {} has no name; it is that of a field, and R leaves row numbers out \
             with `row.names = FALSE`",
            table.name,
            empty + 1
        ));
    }
    let mut rows = Vec::new();
    for (number, _, line) in lines {
        let row = texts(line);
        if row.len() != fields.len() {
            return Err(format!(
                "table `{}`, line {}: {} cells where the first line names {} fields; a value with a comma in \
                 it stands in quotes",
                table.name,
                number + 1,
                row.len(),
                fields.len()
            ));
        }
        rows.push(row);
    }
    let fields = fields.into_iter().map(|field| (field, "variants".to_owned())).collect();
    Ok(Rows { fields, values: rows, table: Some(table) })
}
