//! The table of speeds that are found in a record.

use super::records::{Labelled, Part, UESTC};
use super::trial::{self, Outcome, WITHOUT_SPEED};
use crate::Sheet;

/// How often the speed is found where none is given, and corrected where one is given that is off.
pub(super) fn table(
    sheet: &mut Sheet,
    records: &[Labelled],
    changed: &[(&'static str, Vec<Option<Outcome>>)],
) {
    sheet.heading("Speeds");
    sheet.say(
        "*Told* counts the records whose speed the verdict takes from the record: found without any that is \
         given, or corrected by more than 0.2 %. *Right* is within 1 % of the true speed. That of UESTC is \
         nominal, up to 6 % off by its own lines: there right is within 7 %.",
    );
    let mut rows = Vec::new();
    for (name, outcomes) in
        changed.iter().filter(|(name, _)| *name == WITHOUT_SPEED || name.starts_with("speed"))
    {
        for (part, what) in [(Part::Chosen, "chosen part"), (Part::Quoted, "quoted part")] {
            let (mut of, mut told, mut right) = (0, 0, 0);
            for (record, outcome) in records.iter().zip(outcomes).filter(|(record, _)| record.part == part) {
                of += 1;
                let given = trial::given_rpm(name, record.speed_rpm);
                let found = outcome.as_ref().and_then(|o| o.speed_rpm);
                let Some(rpm) =
                    found.filter(|rpm| given.is_none_or(|given| (rpm / given - 1.0).abs() > 2e-3))
                else {
                    continue;
                };
                let near = if record.set == UESTC { 0.07 } else { 0.01 };
                told += 1;
                right += usize::from((rpm / record.speed_rpm - 1.0).abs() < near);
            }
            rows.push(
                [*name, what]
                    .map(str::to_owned)
                    .into_iter()
                    .chain([of, told, right].map(|n| n.to_string()))
                    .collect(),
            );
            for (of_what, value) in [("n", of), ("told", told), ("right", right)] {
                sheet.value("speeds", &format!("{name}, {what}"), of_what, Some(value as f64));
            }
        }
    }
    sheet.table(&["what is given", "records", "n", "told", "right"], &rows);
}
