//! The same experiments with the defect in: whether its impacts mask the line.

use super::SHORT;
use super::hypothesis::{above, experiments, line, rolling};
use crate::table::number;
use crate::{Finished, Sheet, Variant};

/// Variants without the defect only.
const SOUND_ONLY: [&str; 3] = ["facets-56-friction", "facets-112-35kN", "facets-112-70kN"];

pub(super) fn variants() -> Vec<Variant> {
    let mut all = experiments("facets", &SHORT);
    all.retain(|v| !SOUND_ONLY.contains(&v.name.as_str()));
    all
}

/// Table: how far the line stands above its background with the defect and without, and what that says.
pub(super) fn write(sheet: &mut Sheet, with: &[Finished], without: &[Finished]) {
    let pairs: Vec<(&str, &Finished, &Finished)> = with
        .iter()
        .filter_map(|knocking| {
            let name = knocking.variant.name.strip_prefix("facets-")?;
            let sound = without.iter().find(|r| r.variant.name.strip_prefix("sound-") == Some(name))?;
            Some((name, knocking, sound))
        })
        .collect();
    if pairs.is_empty() {
        return;
    }
    sheet.heading("With the defect");
    sheet.say(
        "The same bearings with the defect, 12 ms, beside those without: whether the line is there as soon \
         as nothing knocks, and \
         whether the rollers roll at all.",
    );
    let cell = |v: Option<f64>, decimals| v.map_or("–".to_owned(), |v| number(v, decimals));
    let mut rows = Vec::new();
    let (mut both, mut seen) = (0, 0);
    for (name, knocking, sound) in pairs {
        let line = |run: &Finished| line(run).map(|l| l.hz);
        seen += usize::from(line(sound).is_some());
        both += usize::from(line(sound).is_some() && line(knocking).is_some());
        for (quantity, value) in [
            ("above background dB with the defect", above(knocking)),
            ("above background dB without", above(sound)),
        ] {
            sheet.value("knocks", name, quantity, value);
        }
        rows.push(vec![
            name.to_owned(),
            cell(line(knocking), 0),
            cell(above(knocking), 0),
            cell(line(sound), 0),
            cell(above(sound), 0),
            cell(rolling(sound), 2),
        ]);
    }
    let names =
        ["variant", "line Hz, with defect", "above dB", "line Hz, without", "above dB", "rolling, without"];
    sheet.table(&names, &rows);
    sheet.say(&format!(
        "{seen} of {} bearings show a line without the defect, {both} of them with it too.",
        rows.len()
    ));
}
