//! What is wrong with a campaign's file, said as of scenes: with line, field, what is allowed and what to
//! try.

use ron::error::SpannedError;

use super::design::Rows;
use super::{MOST_RUNS, MOST_STARTS};
use crate::scene_file::outline::{Entry, Outline};
use crate::scene_file::problem::{Place, Problem, SceneError, offset, place_in_file};
use crate::scene_file::schema::{Kind, Schema};
use crate::scene_file::wording::{list, shown};
use crate::scene_file::{self, suggest};

/// The text of a campaign, and where its fields stand.
pub(super) struct File<'a> {
    name: &'a str,
    text: &'a str,
    outline: Outline,
}

/// A file that the system does not give.
pub(super) fn unreadable(name: &str, error: &std::io::Error) -> SceneError {
    let place = Place::Unwritten { file: name.to_owned() };
    let mut problem = Problem::new(format!("cannot read campaign `{name}`: {error}"), place);
    problem.suggestion = "name a campaign's file, such as fixtures/campaigns/quick64.ron".to_owned();
    problem.into()
}

impl<'a> File<'a> {
    pub(super) fn new(name: &'a str, text: &'a str) -> Self {
        Self { name, text, outline: Outline::of(text) }
    }

    /// The value at a path; the whole file where it is not written.
    fn place(&self, path: &str) -> Place {
        match self.outline.get(path) {
            Some(entry) => place_in_file(self.name, self.text, entry.value.clone()),
            None => Place::Unwritten { file: self.name.to_owned() },
        }
    }

    /// Refuses the value at a path.
    pub(super) fn refuse(&self, path: &str, why: String) -> SceneError {
        let mut problem = Problem::new(why, self.place(path));
        path.clone_into(&mut problem.field);
        problem.into()
    }

    /// What is wrong with a field that varies, where it is named.
    pub(super) fn field(&self, mut problem: Problem, rows: &Rows, column: usize) -> SceneError {
        problem.place = match &rows.table {
            Some(table) => place_in_file(&table.name, &table.text, table.head(column)),
            None => self.place(&rows.fields[column].1),
        };
        problem.into()
    }

    /// What is wrong with the scene of a variant, each value shown where it is written.
    pub(super) fn of_variant(&self, error: &SceneError, rows: &Rows, row: usize) -> SceneError {
        let placed = error.problems().iter().cloned().map(|problem| match varies(&problem, rows, row) {
            Some(column) => self.value(problem, rows, row, column),
            None => self.in_set(problem),
        });
        SceneError::new(placed.collect())
    }

    /// What is wrong with it in what all variants have in common, as far as somebody wrote that.
    pub(super) fn outside(&self, error: &SceneError, rows: &Rows, row: usize) -> Vec<Problem> {
        let written = |problem: &&Problem| !matches!(problem.place, Place::Unwritten { .. });
        let problems = error.problems().iter().filter(written);
        problems.filter(|problem| varies(problem, rows, row).is_none()).cloned().collect()
    }

    /// A value that its field cannot have, of a variant's row and a field's column: in the list or the range
    /// that it is from, or in the table's own file.
    pub(super) fn value(&self, problem: Problem, rows: &Rows, row: usize, column: usize) -> Problem {
        let place = match &rows.table {
            Some(table) => table.cell(row, column).map(|cell| place_in_file(&table.name, &table.text, cell)),
            None => {
                let axis = rows.fields[column].1.trim_end_matches(".field");
                let written = &rows.values[row][column];
                let listed = |i: usize| self.outline.get(&format!("{axis}.values[{i}]"));
                let item = (0..).map_while(listed).find(|entry| self.text[entry.value.clone()] == **written);
                match item {
                    Some(entry) => Some(place_in_file(self.name, self.text, entry.value.clone())),
                    None => return self.range(problem, axis),
                }
            }
        };
        problem.of_value_at(place.unwrap_or_else(|| self.place("variants")))
    }

    /// A value of a range that its field cannot have: one that it can have is no range.
    fn range(&self, problem: Problem, axis: &str) -> Problem {
        let counts = matches!(Schema::new().kind(&problem.field), Kind::Count | Kind::OptionalCount);
        let from = self.outline.get(&format!("{axis}.from")).filter(|_| counts);
        let first = from.and_then(|from| self.text[from.value.clone()].parse::<f64>().ok()).map(f64::ceil);
        let mut problem = problem.of_value_at(self.place(axis));
        if let Some(first) = first {
            problem.suggestion =
                format!("`values: [{first}, {}, …]` in place of `from` and `to`", first + 1.0);
        }
        problem
    }

    /// The scene that variants start from; what is wrong with an item of `set` is shown there.
    pub(super) fn of_base(&self, error: SceneError) -> SceneError {
        SceneError::new(error.problems().iter().cloned().map(|problem| self.in_set(problem)).collect())
    }

    /// The same problem in the item of `set` that is to blame.
    fn in_set(&self, mut problem: Problem) -> Problem {
        if let Place::CommandLine { argument, .. } = &problem.place {
            let items = self.outline.entries.iter().filter(|entry| entry.path.starts_with("set["));
            let item = items
                .map(|entry| &entry.value)
                .find(|at| self.text[(*at).clone()].trim_matches('"') == argument.as_str());
            problem.place = match item {
                Some(at) => place_in_file(self.name, self.text, at.clone()),
                None => self.place("set"),
            };
            problem.suggestion = problem.suggestion.replacen("--set ", "", 1);
        }
        problem
    }

    /// A text that is no campaign.
    pub(super) fn no_campaign(&self, error: &SpannedError) -> SceneError {
        use ron::Error as E;
        let start = offset(self.text, error.span.start.line, error.span.start.col);
        let end = offset(self.text, error.span.end.line, error.span.end.col).max(start);
        let mut range = start..end;
        let mut problem = Problem::new("", self.place(""));
        match &error.code {
            E::NoSuchStructField { expected, found, outer } => {
                let named = self.outline.entries.iter().map(|entry| &entry.key);
                let named = named.filter(|key| self.text[(*key).clone()] == **found && key.end <= end + 1);
                range = named.max_by_key(|key| key.start).cloned().unwrap_or(range);
                problem.field.clone_from(found);
                problem.message = format!("unknown field `{}` in {}", shown(found), part(outer.as_deref()));
                problem.allowed = list(expected);
                problem.suggestion = match suggest::nearest(found, expected) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None if scene_file::unknown_field(found).is_none() => {
                        format!(
                            "a field of the scene stands in `set: [\"{found}=…\"]`, or in `variants` where \
                             it varies"
                        )
                    }
                    None => String::new(),
                };
            }
            E::NoSuchEnumVariant { expected, found, .. } => {
                problem.field = self.outline.at(start).map_or_else(String::new, |entry| entry.path.clone());
                problem.message =
                    format!("`{}` is `{}`, which is not one of its words", problem.field, shown(found));
                problem.allowed = list(expected);
                if let Some(near) = suggest::nearest(found, expected) {
                    problem.suggestion = format!("did you mean `{near}`?");
                }
            }
            E::MissingStructField { field, outer } => {
                problem.field = (*field).to_owned();
                problem.message = format!("{} lacks `{field}`, which has no default", part(outer.as_deref()));
                problem.suggestion = match outer.as_deref() {
                    Some("split") => {
                        format!("`train`, `validation` and `test` sum to 1; `{field}: 0` for none")
                    }
                    Some("axis") => {
                        "`(field: \"operation.load_n\", values: [10000, 20000])` is one".to_owned()
                    }
                    _ => EXAMPLE.to_owned(),
                };
            }
            E::DuplicateStructField { field, .. } => {
                problem.field = (*field).to_owned();
                problem.message = format!("field `{field}` is given twice");
                problem.suggestion = "keep one of the two".to_owned();
            }
            code => match self.no_whole_number(start) {
                Some((entry, most)) => {
                    problem.field = entry.path.clone();
                    let value = shown(&self.text[entry.value.clone()]);
                    problem.message = format!("`{}` is `{value}`", entry.path);
                    problem.allowed = format!("a whole number, at most {most}");
                    range = entry.value.clone();
                }
                None => {
                    problem.message = format!("the campaign cannot be read: {code}");
                    problem.suggestion = EXAMPLE.to_owned();
                }
            },
        }
        problem.place = place_in_file(self.name, self.text, range);
        problem.into()
    }

    /// The number at a byte of the text that is to be a whole one and is not, and how large it may be.
    fn no_whole_number(&self, at: usize) -> Option<(&Entry, u64)> {
        let entry = self.outline.at(at)?;
        let most = match entry.path.rsplit('.').next()? {
            "seed" => u64::MAX,
            "starts" => MOST_STARTS as u64,
            "count" => MOST_RUNS as u64,
            _ => return None,
        };
        self.text[entry.value.clone()].parse::<u64>().is_err().then_some((entry, most))
    }
}

/// The column of the value that is to blame for what is wrong with the scene of a variant.
fn varies(problem: &Problem, rows: &Rows, row: usize) -> Option<usize> {
    let Place::CommandLine { argument, .. } = &problem.place else { return None };
    (0..rows.fields.len()).find(|column| rows.argument(row, *column) == *argument)
}

const EXAMPLE: &str = "a campaign has `name` and `variants`, and may have `scene`, `set`, `seed`, `starts`, \
    `split` and `keep`; \
                       fixtures/campaigns/quick64.ron is one";

/// The part of a campaign that has this name among its types.
fn part(outer: Option<&str>) -> &'static str {
    match outer {
        Some("split") => "`split`",
        Some("axis") => "a field that varies",
        Some("sobol" | "latin_hypercube" | "Sobol" | "LatinHypercube") => "`variants`",
        _ => "a campaign",
    }
}
