//! Many summaries as one: the same tree, with the statistic of each number over the starts.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use crate::Error;
use crate::statistic::{Share, Statistic};

/// Fields that identify the items of a list; they stay as they are.
const NAMES: [&str; 10] =
    ["spall", "roller", "sensor", "component", "family", "name", "harmonic", "sideband", "part", "quantity"];

/// A part of many summaries.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Merged {
    /// A number over the starts.
    Number(Statistic),
    /// Starts in which it is true.
    Share(Share),
    /// A value that is the same in every start.
    Same(Value),
    /// By field.
    Group(BTreeMap<String, Merged>),
    /// Items in the order of the first start that has them.
    List(Vec<Merged>),
    /// In no start, or another text in each.
    Nothing,
}

impl Merged {
    /// Of the summaries of all complete starts.
    pub fn of<'a, T: Serialize + 'a>(summaries: impl Iterator<Item = &'a T>) -> Result<Self, Error> {
        let values: Vec<Value> =
            summaries.map(serde_json::to_value).collect::<Result<_, _>>().map_err(Error::Summary)?;
        let all: Vec<&Value> = values.iter().collect();
        Ok(merge(&all, all.len()))
    }

    /// The part at `path`, names with dots between them and places in lists: `levels.sensors[1].exit_g`.
    pub fn get(&self, path: &str) -> Option<&Self> {
        let mut here = self;
        for step in path.split(['.', '[']) {
            here = match (here, step.strip_suffix(']')) {
                (Self::Group(fields), None) => fields.get(step)?,
                (Self::List(items), Some(place)) => items.get(place.parse::<usize>().ok()?)?,
                _ => return None,
            };
        }
        Some(here)
    }

    /// The number at `path`; `None` where no start has one.
    pub fn number(&self, path: &str) -> Option<&Statistic> {
        match self.get(path)? {
            Self::Number(statistic) => Some(statistic),
            _ => None,
        }
    }

    /// Items of the list at `path`; none where there is no list.
    pub fn items(&self, path: &str) -> &[Self] {
        match self.get(path) {
            Some(Self::List(items)) => items,
            _ => &[],
        }
    }

    /// The text that all starts have at `path`.
    pub fn text(&self, path: &str) -> Option<&str> {
        match self.get(path)? {
            Self::Same(value) => value.as_str(),
            _ => None,
        }
    }
}

/// The values at one place of the summaries of `of` starts, merged.
fn merge(values: &[&Value], of: usize) -> Merged {
    let present: Vec<&Value> = values.iter().copied().filter(|value| !value.is_null()).collect();
    let Some(first) = present.first() else { return Merged::Nothing };
    match first {
        Value::Null => Merged::Nothing,
        Value::Number(_) => {
            let numbers: Vec<f64> = present.iter().filter_map(|value| value.as_f64()).collect();
            Statistic::of(&numbers, of).map_or(Merged::Nothing, Merged::Number)
        }
        Value::Bool(_) => {
            let yes = present.iter().filter(|value| value.as_bool() == Some(true)).count();
            Share::of(yes, present.len()).map_or(Merged::Nothing, Merged::Share)
        }
        Value::String(_) if present.iter().all(|value| value == first) => Merged::Same((*first).clone()),
        Value::String(_) => Merged::Nothing,
        Value::Object(_) => Merged::Group(group(&present, of)),
        Value::Array(_) => list(&present, of),
    }
}

fn group(values: &[&Value], of: usize) -> BTreeMap<String, Merged> {
    let mut fields: BTreeMap<String, Vec<&Value>> = BTreeMap::new();
    for (name, value) in values.iter().filter_map(|value| value.as_object()).flatten() {
        fields.entry(name.clone()).or_default().push(value);
    }
    let merged = |(name, values): (String, Vec<&Value>)| {
        let same = NAMES.contains(&name.as_str()) && values.iter().all(|value| *value == values[0]);
        let part = if same { Merged::Same(values[0].clone()) } else { merge(&values, of) };
        (name, part)
    };
    fields.into_iter().map(merged).collect()
}

/// Items go together by their names; those without one by their place.
fn list(values: &[&Value], of: usize) -> Merged {
    let mut order: Vec<(String, usize)> = Vec::new();
    let mut items: BTreeMap<(String, usize), Vec<&Value>> = BTreeMap::new();
    for list in values.iter().filter_map(|value| value.as_array()) {
        let mut seen: BTreeMap<String, usize> = BTreeMap::new();
        for item in list {
            let name = name(item);
            // A roller may come a second time.
            let time = seen.entry(name.clone()).and_modify(|time| *time += 1).or_insert(0);
            let key = (name, *time);
            if !items.contains_key(&key) {
                order.push(key.clone());
            }
            items.entry(key).or_default().push(item);
        }
    }
    Merged::List(order.iter().filter_map(|key| items.get(key)).map(|values| merge(values, of)).collect())
}

fn name(item: &Value) -> String {
    let words = NAMES.iter().filter_map(|field| item.get(field)).map(Value::to_string);
    words.collect::<Vec<_>>().join(" ")
}
