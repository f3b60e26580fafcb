//! How the values of a campaign are chosen: a grid, a design over ranges, or the rows of a table.

use std::f64::consts::PI;
use std::ops::Range;
use std::path::Path;

use super::MOST_RUNS;
use super::document::{File, Written};
use stribeck_scene::dice::Dice;
use stribeck_scene::fields::{self, group, words};
use stribeck_scene::scene::Scene;
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
        /// How many; with `each`, of every combination.
        count: usize = 1, within(1.0, MOST_RUNS as f64), required();
        /// Axes whose values all combine: each combination has as many points.
        each: Vec<Axis> = Vec::new();
        /// Members of which a point draws one each.
        members: Vec<Members> = Vec::new();
        /// Over which fields.
        over: Vec<Axis> = Vec::new();
    }
}

group! {
    /// A field and its values, or its range; or a name for what is no field.
    pub(super) struct Axis {
        /// Path of the field.
        field: String = String::new();
        /// In the place of `field`: a name for `cases`, or, in capital letters, one that stands for the number in
        /// other values and in `set`.
        name: String = String::new();
        /// Its values.
        values: Vec<Written> = Vec::new();
        /// Named lists of fields that are set together.
        cases: Vec<Case> = Vec::new();
        /// Least value; of a field that counts, the whole numbers from here on.
        from: Option<f64> = None;
        /// Greatest value.
        to: Option<f64> = None;
        /// Evenly over the logarithm.
        log: bool = false;
        /// What `from` and `to` are multiples of, for the bearing of the run.
        times: Times = Times::One;
        /// The range begins no lower than here, whatever it is a multiple of.
        least: Option<f64> = None;
    }
}

group! {
    /// Fields that are set together.
    pub(super) struct Case {
        /// Its name in the tables.
        name: String = String::new(), required();
        /// The fields, as `--set` takes them.
        set: Vec<String> = Vec::new();
    }
}

group! {
    /// Some cases that are drawn, such as machines: each point has one of them.
    pub(super) struct Members {
        /// Their name in the tables, where they are numbered from 1.
        name: String = String::new(), required();
        /// How many there are.
        count: usize = 1, within(1.0, MOST_RUNS as f64), required();
        /// What is drawn for each.
        over: Vec<Axis> = Vec::new();
        /// The fields that it sets, with the names of `over`.
        set: Vec<String> = Vec::new();
    }
}

words! {
    /// What a range is a multiple of.
    pub(super) enum Times: Copy, Eq, PartialOrd, Ord {
        /// Nothing: it has the unit of its field.
        One = "one",
        /// Basic static load rating [N].
        StaticRatingN = "static_rating_n",
        /// Distance of rolling elements along the inner raceway [mm].
        SpacingMm = "spacing_mm",
        /// Diameter of a rolling element [mm].
        DiameterMm = "diameter_mm",
        /// One over the pitch diameter [1/mm]: a speed times the pitch is much the same for bearings of all sizes.
        PerPitchMm = "per_pitch_mm",
    }
}

impl Times {
    /// Its value for the bearing of a scene.
    pub(super) fn of(self, scene: &Scene) -> f64 {
        let b = &scene.bearing;
        match self {
            Self::One => 1.0,
            Self::StaticRatingN => scene.static_rating_n(),
            Self::SpacingMm => PI * b.inner_race_diameter_mm / b.rollers as f64,
            Self::DiameterMm => b.roller_diameter_mm,
            Self::PerPitchMm => 2.0 / (b.outer_race_diameter_mm + b.inner_race_diameter_mm),
        }
    }
}

/// What varies, each a column of the tables.
pub(super) struct Column {
    /// The field, or the name.
    pub(super) name: String,
    /// The place in the campaign's file that names it.
    pub(super) at: String,
    pub(super) is_field: bool,
}

/// Columns, and the values of each variant.
pub(super) struct Rows {
    pub(super) columns: Vec<Column>,
    pub(super) values: Vec<Vec<String>>,
    /// What each value of each variant sets, as overrides.
    pub(super) sets: Vec<Vec<Vec<String>>>,
    /// Where they stand when that is not in the campaign's file.
    pub(super) table: Option<Table>,
}

/// A table's file.
pub(super) struct Table {
    pub(super) name: String,
    pub(super) text: String,
}

impl Rows {
    /// Rows of which every value sets the field of its column.
    fn of_fields(fields: Vec<(String, String)>, values: Vec<Vec<String>>, table: Option<Table>) -> Self {
        let set = |row: &Vec<String>| {
            row.iter().zip(&fields).map(|(value, (field, _))| vec![format!("{field}={value}")]).collect()
        };
        let sets = values.iter().map(set).collect();
        let columns = fields.into_iter().map(|(name, at)| Column { name, at, is_field: true }).collect();
        Self { columns, values, sets, table }
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

/// A number that a range is a multiple of, for the bearing that a run is to have; `None` for that of the scene.
pub(super) type Measure<'a> = &'a dyn Fn(Option<&str>, Times) -> Result<f64, String>;

impl Variants {
    /// The values of each variant. Tables are looked for from `folder`.
    pub(super) fn rows(
        &self,
        seed: u64,
        folder: &Path,
        file: &File<'_>,
        measure: Measure<'_>,
    ) -> Result<Rows, Refused> {
        match self {
            Self::Grid(axes) => grid(axes, file),
            Self::LatinHypercube(design) => design.rows((seed, MOST_RUNS), file, measure, &|combination| {
                let axes = design.members.len() + design.over.len();
                let places = latin_hypercube(seed ^ combination, design.count, axes);
                Box::new(move |point, axis| places[axis][point])
            }),
            Self::Sobol(design) => design.rows((seed, MOST_OF_SOBOL), file, measure, &|combination| {
                let seed = seed ^ combination;
                let seed = (seed ^ (seed >> 32)) as u32;
                let at =
                    move |point: usize, axis: usize| sobol_burley::sample(point as u32, axis as u32, seed);
                Box::new(move |point, axis| f64::from(at(point, axis)))
            }),
            Self::Table(path) => table(&folder.join(path)).map_err(|why| Refused::new("variants", why)),
        }
    }
}

/// Shares of the way, 0 to 1, by point and axis.
type Places = Box<dyn Fn(usize, usize) -> f64>;

/// One of the values of an axis: its name in the tables, and what it sets.
#[derive(Clone)]
struct Choice {
    shown: String,
    set: Vec<String>,
}

impl Axis {
    fn listed(&self, file: &File<'_>) -> Vec<String> {
        self.values.iter().map(|value| file.written(value)).collect()
    }

    /// Its values or cases; none where it has a range.
    fn choices(&self, file: &File<'_>) -> Vec<Choice> {
        let value = |shown: String| Choice { set: vec![format!("{}={shown}", self.field)], shown };
        let case = |case: &Case| Choice { shown: case.name.clone(), set: case.set.clone() };
        self.listed(file).into_iter().map(value).chain(self.cases.iter().map(case)).collect()
    }

    /// Refuses what is neither a list, cases nor a range.
    fn check(&self) -> Result<(), String> {
        let lists =
            [!self.values.is_empty(), !self.cases.is_empty(), self.from.is_some() || self.to.is_some()];
        let is_one =
            lists.iter().filter(|there| **there).count() == 1 && self.from.is_some() == self.to.is_some();
        let is_capital = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
        match (self.field.as_str(), self.name.as_str()) {
            ("", "") => {
                Err("an axis has a `field`, or a `name` for cases and numbers that are no field".to_owned())
            }
            (_, "") if is_one && self.cases.is_empty() => Ok(()),
            (field, "") => {
                Err(format!("`{field}` takes either `values: […]`, one at least, or both `from` and `to`"))
            }
            ("", _) if is_one && !self.cases.is_empty() => Ok(()),
            ("", name) if is_one && self.values.is_empty() && name.chars().all(is_capital) => Ok(()),
            ("", name) => Err(format!(
                "`{name}` takes either `cases: […]`, or both `from` and `to`, and then is in capital letters, which \
                 no field is"
            )),
            (field, name) => Err(format!("an axis has either a field, `{field}`, or a name, `{name}`")),
        }
    }

    /// The number at `share` of the way, as it is written.
    fn at(&self, share: f64, times: f64) -> Result<String, String> {
        let (Some(from), Some(to)) = (self.from, self.to) else { return Ok(String::new()) };
        let shown = if self.field.is_empty() { &self.name } else { &self.field };
        let (from, to) = ((times * from).max(self.least.unwrap_or(f64::NEG_INFINITY)), times * to);
        if !(from.is_finite() && to.is_finite() && from < to && (!self.log || from > 0.0)) {
            return Err(format!(
                "`{shown}` goes from {from} to {to}; `from` is below `to`, and above 0 with `log: true`"
            ));
        }
        let counts = fields::counts(&self.field);
        // Whole numbers are equally often, each over a range of its own.
        let (from, to) = if counts { (from.ceil(), to.floor() + 1.0) } else { (from, to) };
        let value = if self.log { from * (to / from).powf(share) } else { from + share * (to - from) };
        if counts {
            return match value.floor().min(to - 1.0) {
                whole if from < to => Ok(format!("{whole}")),
                _ => Err(format!("`{shown}` is a whole number, and none lies in its range")),
            };
        }
        // Seven digits: short to read in a scene, and finer than anything that is measured.
        Ok(format!("{}", format!("{value:.6e}").parse::<f64>().unwrap_or(value)))
    }
}

/// A text with the numbers in the place of their names.
fn filled(text: &str, numbers: &[(&str, String)]) -> String {
    let mut filled = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(begin) = rest.find(|c: char| c.is_ascii_alphanumeric() || c == '_') {
        let (before, word) = rest.split_at(begin);
        let end = word.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(word.len());
        let (word, behind) = word.split_at(end);
        let number = numbers.iter().find(|(name, _)| *name == word);
        filled += before;
        filled += number.map_or(word, |(_, number)| number);
        rest = behind;
    }
    filled + rest
}

/// The choice at `share` of the way through a list.
fn chosen<T>(all: &[T], share: f64) -> &T {
    &all[((share * all.len() as f64) as usize).min(all.len() - 1)]
}

impl Members {
    /// The members, drawn by a seed of their own.
    fn choices(&self, seed: u64) -> Result<Vec<Choice>, String> {
        let places = latin_hypercube(seed, self.count, self.over.len());
        let member = |number: usize| {
            let numbers = self.over.iter().enumerate().map(|(axis, of)| {
                of.check()?;
                Ok((of.name.as_str(), of.at(places[axis][number], 1.0)?))
            });
            let numbers = numbers.collect::<Result<Vec<_>, String>>()?;
            let set = self.set.iter().map(|text| filled(text, &numbers)).collect();
            Ok(Choice { shown: (number + 1).to_string(), set })
        };
        (0..self.count).map(member).collect()
    }
}

impl Design {
    /// Points of every combination, `at` with the places of each; combinations follow one another point by point, so
    /// that the first rows have some of each.
    fn rows(
        &self,
        (seed, most): (u64, usize),
        file: &File<'_>,
        measure: Measure<'_>,
        at: &dyn Fn(u64) -> Places,
    ) -> Result<Rows, Refused> {
        let axes = self.members.len() + self.over.len();
        if self.count == 0 || self.count > most || axes + self.each.len() == 0 || axes > 256 {
            return Err(Refused::new(
                "variants",
                format!(
                    "`variants` draws {} points over {axes} fields; 1 to {most} over 1 to 256",
                    self.count
                ),
            ));
        }
        let listed = [("each", &self.each), ("over", &self.over)];
        for (list, axes) in listed {
            for (n, axis) in axes.iter().enumerate() {
                let refused = |why| Refused::new(format!("variants.{list}[{n}]"), why);
                axis.check().map_err(refused)?;
                if list == "each" && axis.from.is_some() {
                    return Err(refused(
                        "a range has no values that combine: it belongs to `over`".to_owned(),
                    ));
                }
            }
        }
        let members = self.members.iter().enumerate().map(|(n, members)| {
            // Others with the same count are others.
            members
                .choices(seed.wrapping_add(1 + n as u64))
                .map_err(|why| Refused::new(format!("variants.members[{n}]"), why))
        });
        let members = members.collect::<Result<Vec<_>, _>>()?;
        let each: Vec<Vec<Choice>> = self.each.iter().map(|axis| axis.choices(file)).collect();
        let over: Vec<Vec<Choice>> = self.over.iter().map(|axis| axis.choices(file)).collect();
        let combinations = each.iter().fold(vec![Vec::new()], |rows: Vec<Vec<&Choice>>, choices| {
            rows.iter()
                .flat_map(|row| choices.iter().map(move |choice| [&row[..], &[choice]].concat()))
                .collect()
        });
        if combinations.len().saturating_mul(self.count) > MOST_RUNS {
            return Err(Refused::new("variants", format!("the design has more than {MOST_RUNS} variants")));
        }
        let columns = self.columns();
        let bearing = columns.iter().position(|column| column.name == "bearing");
        let places: Vec<Places> = (0..combinations.len()).map(|n| at(n as u64)).collect();
        let (mut values, mut sets) = (Vec::new(), Vec::new());
        for point in 0..self.count {
            for (combination, places) in combinations.iter().zip(&places) {
                let of_members =
                    members.iter().enumerate().map(|(n, all)| Some(chosen(all, places(point, n))));
                let of_over = over.iter().enumerate().map(|(n, all)| {
                    (!all.is_empty()).then(|| chosen(all, places(point, self.members.len() + n)))
                });
                let choices: Vec<Option<&Choice>> =
                    combination.iter().map(|choice| Some(*choice)).chain(of_members).chain(of_over).collect();
                let bearing = bearing.and_then(|column| choices[column]).map(|choice| choice.shown.as_str());
                let number = |(n, axis): (usize, &Axis)| {
                    let refused = |why| Refused::new(format!("variants.over[{n}]"), why);
                    let times = match axis.times {
                        Times::One => 1.0,
                        times => measure(bearing, times).map_err(refused)?,
                    };
                    axis.at(places(point, self.members.len() + n), times).map_err(refused)
                };
                let numbers = self.over.iter().enumerate().map(number).collect::<Result<Vec<String>, _>>()?;
                let named: Vec<(&str, String)> =
                    self.over.iter().zip(&numbers).map(|(axis, n)| (axis.name.as_str(), n.clone())).collect();
                let first = choices.len() - self.over.len();
                let (mut row, mut set) = (Vec::new(), Vec::new());
                for (n, choice) in choices.iter().enumerate() {
                    let (shown, of) = match choice {
                        Some(Choice { shown, set }) => {
                            (filled(shown, &named), set.iter().map(|text| filled(text, &named)).collect())
                        }
                        None => {
                            let (axis, number) = (&self.over[n - first], numbers[n - first].clone());
                            let of = match axis.field.as_str() {
                                "" => Vec::new(),
                                field => vec![format!("{field}={number}")],
                            };
                            (number, of)
                        }
                    };
                    row.push(shown);
                    set.push(of);
                }
                values.push(row);
                sets.push(set);
            }
        }
        Ok(Rows { columns, values, sets, table: None })
    }

    fn columns(&self) -> Vec<Column> {
        let of = |list: &str, n: usize, axis: &Axis| match axis.field.as_str() {
            "" => {
                Column { name: axis.name.clone(), at: format!("variants.{list}[{n}].name"), is_field: false }
            }
            field => {
                Column { name: field.to_owned(), at: format!("variants.{list}[{n}].field"), is_field: true }
            }
        };
        let each = self.each.iter().enumerate().map(|(n, axis)| of("each", n, axis));
        let members = self.members.iter().enumerate().map(|(n, members)| Column {
            name: members.name.clone(),
            at: format!("variants.members[{n}].name"),
            is_field: false,
        });
        let over = self.over.iter().enumerate().map(|(n, axis)| of("over", n, axis));
        each.chain(members).chain(over).collect()
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
        if values.is_empty() || axis.field.is_empty() || axis.from.is_some() || axis.to.is_some() {
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
    Ok(Rows::of_fields(axes.iter().enumerate().map(place).collect(), rows, None))
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
    Ok(Rows::of_fields(fields, rows, Some(table)))
}
