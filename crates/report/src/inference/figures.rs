//! The pictures: distributions of unknowns, pairs of them, targets, pulls, ranks.

use super::{Answer, FieldCalibrated, FieldFound, TargetFound, short};
use crate::field_words::FieldWords;
use crate::plot::{Anchor, Colour, Picture, Sheet};

const TEXT: &str = "#333";
const GREY: &str = "#999";

/// Size of a panel of the distributions, and how many stand in a row.
const PANEL: [f64; 2] = [260.0, 150.0];
const IN_A_ROW: usize = 2;

/// The marginal posterior of every unknown: bars, with the prior as a grey line.
pub(super) fn marginals(answer: &Answer) -> Picture {
    let rows = answer.fields.len().div_ceil(IN_A_ROW);
    let mut sheet = Sheet::new(IN_A_ROW as f64 * PANEL[0], rows as f64 * PANEL[1]);
    for (n, field) in answer.fields.iter().enumerate() {
        let at = [(n % IN_A_ROW) as f64 * PANEL[0] + 12.0, (n / IN_A_ROW) as f64 * PANEL[1] + 26.0];
        panel(&mut sheet, field, at, [PANEL[0] - 24.0, PANEL[1] - 62.0]);
    }
    let mut picture = Picture::new("marginals", "What each unknown can have been", sheet);
    picture.caption =
        "Blue: probability after the targets. Grey line: before. Bar below: the interval.".to_owned();
    picture
}

fn panel(sheet: &mut Sheet, field: &FieldFound, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
    let FieldWords { words, unit } = FieldWords::of(&field.name);
    let title = if unit.is_empty() { words } else { format!("{words} [{unit}]") };
    sheet.text([x, y - 10.0], 12.0, Anchor::Start, TEXT, &cut(&title, 40));
    let count = field.bars.len();
    let top = field.bars.iter().copied().fold(1.0 / count as f64, f64::max);
    let bar = width / count as f64;
    for (n, share) in field.bars.iter().enumerate() {
        let tall = height * share / top;
        let left = x + n as f64 * bar;
        sheet.path(
            &[
                [left, y + height],
                [left, y + height - tall],
                [left + bar - 0.5, y + height - tall],
                [left + bar - 0.5, y + height],
            ],
            true,
            &format!("fill:{};fill-opacity:0.75;stroke:none", Colour::Blue.css()),
        );
    }
    let even = y + height - height / (count as f64 * top);
    sheet.path(&[[x, even], [x + width, even]], false, &format!("fill:none;stroke:{GREY};stroke-width:1"));
    sheet.path(
        &[[x, y + height], [x + width, y + height]],
        false,
        &format!("fill:none;stroke:{TEXT};stroke-width:1"),
    );
    match (field.ends, field.interval_90) {
        (Some([from, to]), Some([low, high])) => {
            sheet.text([x, y + height + 24.0], 11.0, Anchor::Start, GREY, &short(from));
            sheet.text([x + width, y + height + 24.0], 11.0, Anchor::End, GREY, &short(to));
            let place = |value: f64| x + width * share_of(field, value, from, to);
            let line = y + height + 6.0;
            sheet.path(
                &[[place(low), line], [place(high), line]],
                false,
                &format!("fill:none;stroke:{};stroke-width:4", Colour::Blue.css()),
            );
            if let Some(median) = field.median {
                sheet.circle([place(median), line], 3.5, &format!("fill:{TEXT}"));
                // Below its dot, and clear of the numbers of both ends.
                let below = place(median).clamp(x + 0.2 * width, x + 0.8 * width);
                sheet.text([below, y + height + 24.0], 11.0, Anchor::Middle, TEXT, &short(median));
            }
        }
        _ => {
            let labels = labels(&field.choices.iter().map(|choice| &choice.value[..]).collect::<Vec<_>>());
            for (n, label) in labels.iter().enumerate().filter(|_| count <= 8) {
                let middle = x + (n as f64 + 0.5) * bar;
                let most = ((bar / 6.0) as usize).max(3);
                sheet.text(
                    [middle, y + height + 14.0 + 10.0 * (n % 2) as f64],
                    10.0,
                    Anchor::Middle,
                    TEXT,
                    &cut(label, most * 2),
                );
            }
            if let (true, [first, .., last]) = (count > 8, &field.choices[..]) {
                sheet.text([x, y + height + 14.0], 10.0, Anchor::Start, TEXT, &first.value);
                sheet.text([x + width, y + height + 14.0], 10.0, Anchor::End, TEXT, &last.value);
            }
        }
    }
}

fn share_of(field: &FieldFound, value: f64, from: f64, to: f64) -> f64 {
    if field.logarithmic { (value / from).ln() / (to / from).ln() } else { (value - from) / (to - from) }
}

/// What tells choices apart: the values of those of their fields that are not alike in all that have several.
/// Where that leaves two of them alike, the choices as they are written.
fn labels(choices: &[&str]) -> Vec<String> {
    let parts = |choice: &str| -> Vec<String> {
        let inner = choice.trim_matches(|c| matches!(c, '(' | ')'));
        let fields = inner.split([',', ' ']).filter(|part| !part.is_empty());
        // "field: value" is one part, as "field=value" is.
        fields.fold(Vec::new(), |mut parts: Vec<String>, word| {
            match parts.last_mut().filter(|last| last.ends_with(':')) {
                Some(name) => name.push_str(word),
                None => parts.push(word.to_owned()),
            }
            parts
        })
    };
    let all: Vec<Vec<String>> = choices.iter().map(|choice| parts(choice)).collect();
    let several: Vec<_> = all.iter().filter(|parts| parts.len() > 1).collect();
    let alike = |part: &String| several.len() > 1 && several.iter().all(|other| other.contains(part));
    let value = |part: &String| part.rsplit([':', '=']).next().unwrap_or(part).to_owned();
    let told = |parts: &Vec<String>| {
        parts.iter().filter(|part| !alike(part)).map(value).collect::<Vec<_>>().join(" ")
    };
    let labels: Vec<String> = all.iter().map(told).collect();
    let distinct =
        labels.iter().enumerate().all(|(n, label)| !label.is_empty() && !labels[..n].contains(label));
    if distinct { labels } else { choices.iter().map(|choice| (*choice).to_owned()).collect() }
}

/// The beginning of a text.
fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        text.to_owned()
    } else {
        text.chars().take(most - 1).chain(['…']).collect()
    }
}

/// Draws over every pair of unknowns.
pub(super) fn pairs(answer: &Answer) -> Picture {
    let count = answer.fields.len();
    let (left, cell) = (130.0, (680.0 / count as f64).clamp(40.0, 150.0));
    let mut sheet = Sheet::new(left + cell * count as f64 + 10.0, cell * count as f64 + 120.0);
    for row in 0..count {
        let name = cut(last(&answer.fields[row].name), 20);
        sheet.text([left - 6.0, (row as f64 + 0.55) * cell], 11.0, Anchor::End, TEXT, &name);
        for column in 0..=row {
            let corner = [left + column as f64 * cell, row as f64 * cell];
            square(&mut sheet, corner, cell - 3.0, "fill:none;stroke:#ccc;stroke-width:1");
            if row == column {
                let bars = &answer.fields[row].bars;
                let top = bars.iter().copied().fold(0.0, f64::max).max(1e-12);
                for (n, share) in bars.iter().enumerate() {
                    let wide = (cell - 3.0) / bars.len() as f64;
                    let tall = (cell - 6.0) * share / top;
                    let x = corner[0] + n as f64 * wide;
                    let base = corner[1] + cell - 3.0;
                    sheet.path(
                        &[[x, base], [x, base - tall], [x + wide, base - tall], [x + wide, base]],
                        true,
                        &format!("fill:{};fill-opacity:0.6;stroke:none", Colour::Blue.css()),
                    );
                }
            } else {
                let r = answer.pairs[row][column];
                for (n, draw) in answer.shown.iter().enumerate() {
                    let place = |field: usize| spread(&answer.fields[field], draw[field], n);
                    let at = [
                        corner[0] + 2.0 + (cell - 7.0) * place(column),
                        corner[1] + cell - 5.0 - (cell - 7.0) * place(row),
                    ];
                    sheet.circle(at, 1.1, &format!("fill:{};fill-opacity:0.35", Colour::Blue.css()));
                }
                if r.abs() >= 0.3 {
                    sheet.text(
                        [corner[0] + cell - 7.0, corner[1] + 12.0],
                        10.0,
                        Anchor::End,
                        TEXT,
                        &format!("{r:+.1}"),
                    );
                }
            }
        }
        let x = left + (row as f64 + 0.5) * cell;
        let y = cell * count as f64 + 14.0 + 14.0 * (row % 6) as f64;
        sheet.text([x, y], 11.0, Anchor::Middle, TEXT, &name);
    }
    let mut picture = Picture::new("pairs", "Pairs of unknowns", sheet);
    picture.caption =
        "Draws of the posterior, each axis from one end of the prior to the other. A number is \
        the correlation where it is 0.3 or more: only together are the two known."
            .to_owned();
    picture.dense = true;
    picture
}

/// Choices are drawn as columns of points instead of one over the other.
fn spread(field: &FieldFound, share: f64, n: usize) -> f64 {
    let count = field.choices.len();
    if count == 0 { share } else { share + 0.6 / count as f64 * ((n as f64 * 0.618_034).fract() - 0.5) }
}

/// The last part of a field's path.
fn last(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

fn square(sheet: &mut Sheet, [x, y]: [f64; 2], size: f64, paint: &str) {
    sheet.path(&[[x, y], [x + size, y], [x + size, y + size], [x, y + size]], true, paint);
}

/// Every target beside its predictions: of the emulator, and of runs at draws of the posterior.
pub(super) fn targets(answer: &Answer) -> Picture {
    let (left, width, line) = (220.0, 500.0, 30.0);
    let mut sheet = Sheet::new(left + width + 90.0, 40.0 + line * answer.targets.len() as f64);
    for (n, target) in answer.targets.iter().enumerate() {
        let y = 28.0 + line * n as f64;
        sheet.text([left - 10.0, y + 4.0], 12.0, Anchor::End, TEXT, &cut(&target.name, 34));
        let Some((low, high)) = span(target) else {
            sheet.text([left, y + 4.0], 11.0, Anchor::Start, GREY, "no run has it");
            continue;
        };
        let scaled = |value: f64| if target.logarithmic { value.max(1e-300).ln() } else { value };
        let place = |value: f64| {
            left + width * ((scaled(value) - scaled(low)) / (scaled(high) - scaled(low))).clamp(-0.02, 1.02)
        };
        if let Some([a, b, c, d, e]) = target.predicted {
            let paint = |wide: f64| {
                format!("fill:none;stroke:{};stroke-opacity:0.55;stroke-width:{wide}", Colour::Blue.css())
            };
            sheet.path(&[[place(a), y], [place(e), y]], false, &paint(3.0));
            sheet.path(&[[place(b), y], [place(d), y]], false, &paint(9.0));
            sheet.path(
                &[[place(c), y - 6.0], [place(c), y + 6.0]],
                false,
                &format!("fill:none;stroke:{TEXT};stroke-width:1.5"),
            );
        }
        for value in &target.run_values {
            sheet.circle([place(*value), y + 9.0], 2.0, &format!("fill:{}", Colour::Orange.css()));
        }
        if let Some(value) = target.value {
            let x = place(value);
            sheet.path(
                &[[x, y - 10.0], [x, y + 13.0]],
                false,
                &format!("fill:none;stroke:{};stroke-width:2", Colour::Red.css()),
            );
            sheet.text([left + width + 16.0, y + 4.0], 11.0, Anchor::Start, Colour::Red.css(), &short(value));
        }
    }
    let mut picture = Picture::new("predictive", "Targets and what scenes of the posterior make", sheet);
    picture.caption = "Red: what was seen. Blue: 90 % and half of the emulated runs, and their median. \
        Orange: runs at draws of the posterior. Each line has its own scale, by factors where differences \
        count by their ratio."
        .to_owned();
    picture
}

/// Range that the line of a target covers.
fn span(target: &TargetFound) -> Option<(f64, f64)> {
    let all = target.run_values.iter().chain(target.value.iter()).chain(target.predicted.iter().flatten());
    let all: Vec<f64> = all.copied().filter(|value| value.is_finite()).collect();
    if target.predicted.is_none() && target.run_values.is_empty() {
        return None;
    }
    let (low, high) =
        (all.iter().copied().fold(f64::MAX, f64::min), all.iter().copied().fold(f64::MIN, f64::max));
    if target.logarithmic {
        Some((low / 1.1, high * 1.1))
    } else {
        let room = (0.05 * (high - low)).max(1e-9 * high.abs()).max(1e-12);
        Some((low - room, high + room))
    }
}

/// Targets by unknowns: how strongly each target constrains each unknown.
pub(super) fn pulls(answer: &Answer) -> Picture {
    let (left, top, wide, line) = (220.0, 110.0, 52.0, 24.0);
    let columns = answer.fields.len();
    let mut sheet =
        Sheet::new(left + wide * columns as f64 + 20.0, top + line * answer.targets.len() as f64 + 10.0);
    for (column, field) in answer.fields.iter().enumerate() {
        let y = top - 8.0 - 14.0 * (column % 6) as f64;
        sheet.text(
            [left + wide * (column as f64 + 0.5), y],
            11.0,
            Anchor::Middle,
            TEXT,
            &cut(last(&field.name), 22),
        );
    }
    for (row, target) in answer.targets.iter().enumerate() {
        let y = top + line * row as f64;
        sheet.text([left - 8.0, y + 15.0], 12.0, Anchor::End, TEXT, &cut(&target.name, 34));
        for (column, field) in answer.fields.iter().enumerate() {
            let Some(pull) =
                answer.pulls.iter().find(|pull| pull.target == target.name && pull.field == field.name)
            else {
                continue;
            };
            let x = left + wide * column as f64;
            let strength = (pull.divergence / 0.5).sqrt().min(1.0);
            let colour = if pull.shift >= 0.0 { Colour::Red.css() } else { Colour::Blue.css() };
            sheet.path(
                &[[x, y], [x + wide - 2.0, y], [x + wide - 2.0, y + line - 2.0], [x, y + line - 2.0]],
                true,
                &format!("fill:{colour};fill-opacity:{strength:.3};stroke:#ddd;stroke-width:0.5"),
            );
            if pull.shift.abs() >= 0.2 {
                sheet.text(
                    [x + 0.5 * wide, y + 15.0],
                    10.0,
                    Anchor::Middle,
                    TEXT,
                    &format!("{:+.1}", pull.shift).replace('-', "−"),
                );
            }
        }
    }
    let mut picture = Picture::new("pulls", "How each target moves each unknown", sheet);
    picture.caption = "Number: shift of the unknown's mean by that target, in standard deviations of the \
        posterior. Red: to larger values, blue: to smaller ones; the stronger, the more it contributes."
        .to_owned();
    picture
}

pub(super) fn ranks(fields: &[FieldCalibrated]) -> Picture {
    let rows = fields.len().div_ceil(IN_A_ROW);
    let (wide, tall) = (260.0, 120.0);
    let mut sheet = Sheet::new(IN_A_ROW as f64 * wide, rows as f64 * tall);
    for (n, field) in fields.iter().enumerate() {
        let [x, y] = [(n % IN_A_ROW) as f64 * wide + 12.0, (n / IN_A_ROW) as f64 * tall + 24.0];
        let (width, height) = (wide - 24.0, tall - 44.0);
        sheet.text([x, y - 8.0], 12.0, Anchor::Start, TEXT, &field.name);
        let even = field.truths as f64 / field.ranks.len() as f64;
        // Two standard deviations of a count about its mean.
        let room = 2.0 * (even * (1.0 - 1.0 / field.ranks.len() as f64)).sqrt();
        let top = field.ranks.iter().copied().max().unwrap_or(1).max((even + room).ceil() as usize) as f64;
        let level = |count: f64| y + height * (1.0 - count / top);
        sheet.path(
            &[
                [x, level((even - room).max(0.0))],
                [x + width, level((even - room).max(0.0))],
                [x + width, level(even + room)],
                [x, level(even + room)],
            ],
            true,
            "fill:#ddd;stroke:none",
        );
        let bar = width / field.ranks.len() as f64;
        for (m, &count) in field.ranks.iter().enumerate() {
            let left = x + m as f64 * bar;
            sheet.path(
                &[
                    [left, y + height],
                    [left, level(count as f64)],
                    [left + bar - 1.0, level(count as f64)],
                    [left + bar - 1.0, y + height],
                ],
                true,
                &format!("fill:{};fill-opacity:0.6;stroke:none", Colour::Blue.css()),
            );
        }
    }
    let mut picture = Picture::new("ranks", "Ranks of truths in their posteriors", sheet);
    picture.caption = "Even where intervals mean what they say: 95 % of bars end in the grey band. Heaps at \
        both ends: intervals are too narrow; in the middle: too wide."
        .to_owned();
    picture
}

#[cfg(test)]
mod tests {
    use super::labels;

    #[test]
    fn behaves_choices_are_told_apart_by_what_differs() {
        let films = [
            "None",
            "(viscosity_pa_s: 0.002, roughness_um: 0.3)",
            "(viscosity_pa_s: 0.05, roughness_um: 0.3)",
        ];
        assert_eq!(labels(&films), ["None", "0.002", "0.05"]);
        let damping = ["a.rate=0", "a.rate=9 b=None", "a.rate=50 b=None", "a.rate=50 b=None c=absolute"];
        assert_eq!(labels(&damping), ["0", "9", "50", "50 absolute"]);
        assert_eq!(labels(&["straight", "corners"]), ["straight", "corners"]);
        assert_eq!(labels(&["(a: 1, b: 2)", "(a: 1, b: 2)"]), ["(a: 1, b: 2)", "(a: 1, b: 2)"]);
    }
}
