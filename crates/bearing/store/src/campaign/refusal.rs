//! Errors of a campaign's file, as those of scenes: with line, field, allowed values and remedy.

use super::design::Rows;
pub(super) use super::document::File;
use stribeck_scene::scene_file::{Kind, Place, Problem, SceneError, place_in_file};

/// The file of a campaign.
pub(super) const CAMPAIGN: Kind = Kind {
    noun: "a campaign",
    example: EXAMPLE,
    for_fields_of_scenes: Some(
        "a field of the scene stands in `set: [\"{}=…\"]`, or in `variants` where it varies",
    ),
};

/// A file to look at.
pub(super) const FILE: &str = "fixtures/campaigns/quick64.ron";

impl File<'_> {
    /// The error on a field that varies, shown where it is named.
    pub(super) fn field(&self, mut problem: Problem, rows: &Rows, column: usize) -> SceneError {
        problem.place = match &rows.table {
            Some(table) => place_in_file(&table.name, &table.text, table.head(column)),
            None => self.place(&rows.columns[column].at),
        };
        problem.into()
    }

    /// Errors of a variant's scene, each value shown where it is written.
    pub(super) fn of_variant(&self, error: &SceneError, rows: &Rows, row: usize) -> SceneError {
        let placed = error.problems().iter().cloned().map(|problem| match varies(&problem, rows, row) {
            Some(column) => self.value(problem, rows, row, column),
            None => self.in_set(problem),
        });
        SceneError::new(placed.collect())
    }

    /// Its errors in fields that all variants share, as far as they were written.
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
                let at = &rows.columns[column].at;
                let axis = at.trim_end_matches(".field").trim_end_matches(".name");
                let written = &rows.values[row][column];
                let listed = |i: usize| self.tree.get(&format!("{axis}.values[{i}]"));
                let item = (0..).map_while(listed).find(|node| self.text[node.span.clone()] == **written);
                match item {
                    Some(node) => Some(place_in_file(self.name, self.text, node.span.clone())),
                    None => return problem.of_value_at(self.place(axis)),
                }
            }
        };
        problem.of_value_at(place.unwrap_or_else(|| self.place("variants")))
    }
}

/// Column of the value that causes the error of a variant's scene.
pub(super) fn varies(problem: &Problem, rows: &Rows, row: usize) -> Option<usize> {
    let Place::CommandLine { argument, .. } = &problem.place else { return None };
    rows.sets[row].iter().position(|set| set.contains(argument))
}

const EXAMPLE: &str = "a campaign has `name` and `variants`, and may have `scene`, `set`, `seed`, `starts`, \
    `split` and `keep`; fixtures/campaigns/quick64.ron is one";
