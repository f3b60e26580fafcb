//! Which number of `summary.json` a target is.
//!
//! ```text
//! levels.impulse_g
//! tones[name=roller_vertices,harmonic=5].prominence_db
//! levels.sensors[2].gap_g
//! count(events.floor_n)
//! levels.sensors[sensor={sensor}].gap_g
//! count(events.floor_n > 100)
//! ```
//!
//! A list is entered at one item, by number from 0 or by a value in it; or at all items, which are combined
//! by `count`, `share` (of items that have the number), `mean`, `median`, `min`, `max` or `first`. A number
//! that is `null`, and an item that is not there, is missing. Behind a bound, `> 100` or `< 60`, a number
//! beyond it counts as missing in `count` and `share`; alone, the bound yields 1 or 0.

use std::fmt;

use serde_json::Value;

/// Which number of `summary.json`, by its path.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    text: String,
    take: Take,
    steps: Vec<Step>,
    bound: Option<Bound>,
}

/// On which side of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Bound {
    Above(f64),
    Below(f64),
}

/// How the numbers of several items become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Take {
    /// The path names one number, or one list of numbers.
    One,
    /// How many items have the number.
    Count,
    /// Which share of the items has it.
    Share,
    /// Mean of those that have it.
    Mean,
    /// Their median.
    Median,
    /// The least.
    Min,
    /// The greatest.
    Max,
    /// That of the first item.
    First,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Step {
    name: String,
    item: Item,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Item {
    /// The value itself, or all items of a list.
    All,
    Number(usize),
    Where(Vec<(String, String)>),
}

const TAKES: [(&str, Take); 7] = [
    ("count", Take::Count),
    ("share", Take::Share),
    ("mean", Take::Mean),
    ("median", Take::Median),
    ("min", Take::Min),
    ("max", Take::Max),
    ("first", Take::First),
];

impl Quantity {
    /// Parses the path in the file.
    ///
    /// # Errors
    /// In words, when it is not a path.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let (take, path) = match text.split_once('(') {
            None => (Take::One, text),
            Some((word, rest)) => {
                let words = TAKES.map(|(word, _)| word).join(", ");
                let known = TAKES.iter().find(|(known, _)| *known == word.trim());
                let (_, take) =
                    known.ok_or_else(|| format!("`{text}` begins with `{word}(`; it is one of {words}"))?;
                let path = rest.strip_suffix(')').ok_or_else(|| format!("`{text}` lacks its `)`"))?;
                (*take, path.trim())
            }
        };
        let (path, bound) = bound(path)?;
        if bound.is_some() && !matches!(take, Take::One | Take::Count | Take::Share) {
            return Err(format!(
                "`{text}` has a bound, which `count` and `share` know, or a number by itself"
            ));
        }
        let steps = steps(path).ok_or_else(|| {
            format!(
                "`{text}` is no path of summary.json, such as `levels.impulse_g`, \
                 `tones[name=roller_vertices,harmonic=5].level_g` or `count(events.floor_n)`"
            )
        })?;
        Ok(Self { text: text.to_owned(), take, steps, bound })
    }

    /// The path without items and bounds, as in `events.floor_n`.
    pub fn path(&self) -> String {
        self.steps.iter().map(|step| step.name.as_str()).collect::<Vec<_>>().join(".")
    }

    /// Names in braces, which the readings of an unknown replace.
    pub fn placeholders(&self) -> Vec<&str> {
        let conditions = self.steps.iter().flat_map(|step| match &step.item {
            Item::Where(conditions) => conditions.as_slice(),
            _ => &[],
        });
        conditions.filter_map(|(_, value)| placeholder(value)).collect()
    }

    /// The same with the reading of an unknown in the place of its name.
    #[must_use]
    pub fn with(&self, name: &str, reading: &str) -> Self {
        let mut with = self.clone();
        for step in &mut with.steps {
            if let Item::Where(conditions) = &mut step.item {
                for (_, value) in conditions.iter_mut().filter(|(_, value)| placeholder(value) == Some(name))
                {
                    reading.clone_into(value);
                }
            }
        }
        with
    }

    /// The number of this summary; `None` where there is none.
    pub fn number(&self, summary: &Value) -> Option<f64> {
        let found = follow(summary, &self.steps);
        let mut numbers: Vec<f64> = found.iter().filter_map(|value| number(value)).collect();
        if let (Take::One, Some(bound), [number]) = (self.take, self.bound, &numbers[..]) {
            return Some(f64::from(bound.holds(*number)));
        }
        numbers.retain(|number| self.bound.is_none_or(|bound| bound.holds(*number)));
        let all = || numbers.iter().copied();
        match self.take {
            Take::One => (numbers.len() == 1).then(|| numbers[0]),
            // Of a list that is not there nothing is known; of an empty one there are none.
            Take::Count => summary.get(&self.steps[0].name).map(|_| numbers.len() as f64),
            Take::Share => (!found.is_empty()).then(|| numbers.len() as f64 / found.len() as f64),
            Take::Mean => (!numbers.is_empty()).then(|| all().sum::<f64>() / numbers.len() as f64),
            Take::Median => median(numbers),
            Take::Min => all().reduce(f64::min),
            Take::Max => all().reduce(f64::max),
            Take::First => found.first().and_then(|value| number(value)),
        }
    }

    /// The list of numbers at this path; `None` where there is none, or one of its items is no number.
    pub fn curve(&self, summary: &Value) -> Option<Vec<f64>> {
        let found = follow(summary, &self.steps);
        (!found.is_empty()).then(|| found.iter().map(|value| number(value)).collect::<Option<_>>()).flatten()
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Bound {
    fn holds(self, number: f64) -> bool {
        match self {
            Self::Above(limit) => number > limit,
            Self::Below(limit) => number < limit,
        }
    }
}

/// A path, and the bound behind it.
fn bound(text: &str) -> Result<(&str, Option<Bound>), String> {
    let Some(at) = text.find(['>', '<']) else { return Ok((text, None)) };
    let (path, limit) = (text[..at].trim(), text[at + 1..].trim());
    let limit = limit.parse().map_err(|_| format!("`{text}` has the bound `{limit}`, which is no number"))?;
    Ok((path, Some(if text[at..].starts_with('>') { Bound::Above(limit) } else { Bound::Below(limit) })))
}

fn steps(path: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    let mut rest = path;
    while !rest.is_empty() {
        let end = rest.find(['.', '[']).unwrap_or(rest.len());
        let name = rest[..end].to_owned();
        if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
            return None;
        }
        rest = &rest[end..];
        let mut item = Item::All;
        if let Some(inner) = rest.strip_prefix('[') {
            let (within, behind) = inner.split_once(']')?;
            item = match within.parse() {
                Ok(number) => Item::Number(number),
                Err(_) => Item::Where(conditions(within)?),
            };
            rest = behind;
        }
        steps.push(Step { name, item });
        match rest.strip_prefix('.') {
            Some(behind) if !behind.is_empty() => rest = behind,
            None if rest.is_empty() => {}
            _ => return None,
        }
    }
    (!steps.is_empty()).then_some(steps)
}

fn conditions(text: &str) -> Option<Vec<(String, String)>> {
    let one = |part: &str| {
        let (name, value) = part.split_once('=')?;
        Some((name.trim().to_owned(), value.trim().trim_matches('"').to_owned()))
    };
    text.split(',').map(one).collect()
}

fn placeholder(value: &str) -> Option<&str> {
    value.strip_prefix('{')?.strip_suffix('}')
}

/// All values at the end of a path; those of lists that are not entered at one item in turn.
fn follow<'a>(summary: &'a Value, steps: &[Step]) -> Vec<&'a Value> {
    let mut here = vec![summary];
    for step in steps {
        let named = here.into_iter().filter_map(|value| value.get(&step.name));
        here = named.flat_map(|value| items(value, &step.item)).collect();
    }
    here
}

fn items<'a>(value: &'a Value, item: &Item) -> Vec<&'a Value> {
    match (value, item) {
        (Value::Array(list), Item::All) => list.iter().collect(),
        (Value::Array(list), Item::Number(number)) => list.get(*number).into_iter().collect(),
        (Value::Array(list), Item::Where(conditions)) => {
            let fits = |item: &&Value| {
                conditions.iter().all(|(name, wanted)| item.get(name).is_some_and(|value| is(value, wanted)))
            };
            list.iter().filter(fits).collect()
        }
        (_, Item::All) => vec![value],
        _ => Vec::new(),
    }
}

fn is(value: &Value, wanted: &str) -> bool {
    match value {
        Value::String(text) => text == wanted,
        other => number(other).is_some_and(|number| wanted.parse() == Ok(number)),
    }
}

/// A number, yes and no as 1 and 0.
fn number(value: &Value) -> Option<f64> {
    value.as_f64().or_else(|| value.as_bool().map(f64::from)).filter(|number| number.is_finite())
}

fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    let middle = numbers.len() / 2;
    match numbers.len() {
        0 => None,
        n if n % 2 == 1 => Some(numbers[middle]),
        _ => Some(0.5 * (numbers[middle - 1] + numbers[middle])),
    }
}
