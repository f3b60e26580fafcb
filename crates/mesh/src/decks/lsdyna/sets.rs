//! Sets of nodes: lists, ranges, and sets of sets.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::columns::{Format, cells};
use crate::decks::gathered::Gathered;
use crate::decks::{DeckError, fault, whole};

/// Cells in a line of a set.
const A_LINE: usize = 8;
/// Sets within sets within sets.
const DEEPEST: usize = 50;

/// How the lines of a set are to be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Nodes, eight a line.
    List,
    /// Nodes, one a line, and attributes.
    Column,
    /// First and last node, four pairs a line.
    Ranges,
    /// First node, last node and step.
    Steps,
    /// Sets, eight a line.
    Sets,
    /// An option in words, and its subject.
    General,
}

/// A part of a set.
#[derive(Debug, Clone, PartialEq)]
enum Member {
    Node(u64),
    /// First, last and step.
    Nodes(u64, u64, u64),
    Set(u64),
    /// Nodes of all elements of a part.
    Part(u64),
    All,
}

/// The kind of set that a keyword begins: where its title and its number stand, and how to read the rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Head {
    kind: Kind,
    titled: bool,
}

impl Head {
    /// Of a keyword in capitals; none where it begins no set of nodes that is read.
    pub(super) fn of(keyword: &str) -> Option<Self> {
        let mut words: Vec<&str> =
            keyword.strip_prefix("SET_NODE")?.split('_').filter(|w| !w.is_empty()).collect();
        let titled = words.contains(&"TITLE");
        words.retain(|word| !["TITLE", "COLLECT", "LIST", "SMOOTH"].contains(word));
        let kind = match words[..] {
            [] => Kind::List,
            ["COLUMN"] => Kind::Column,
            ["GENERATE"] => Kind::Ranges,
            ["GENERATE", "INCREMENT"] => Kind::Steps,
            ["ADD"] => Kind::Sets,
            ["GENERAL"] => Kind::General,
            _ => return None,
        };
        Some(Self { kind, titled })
    }

    /// Whether the first line is a title, which may be empty.
    pub(super) fn begins_with_a_title(self) -> bool {
        self.titled
    }

    /// Lines before the first member.
    fn lines(self) -> usize {
        1 + usize::from(self.titled)
    }
}

#[derive(Default)]
pub(super) struct NodeSets {
    /// Members with their lines, by the number of the set.
    members: BTreeMap<u64, Vec<(Member, usize)>>,
    titles: BTreeMap<u64, String>,
    /// Sets that another one names, found out once.
    known: RefCell<BTreeMap<u64, Vec<u64>>>,
    /// Title and number of the set that is being read.
    title: String,
    number: u64,
}

impl NodeSets {
    /// The title of the set that is about to be read.
    pub(super) fn call(&mut self, title: &str) {
        title.trim().clone_into(&mut self.title);
    }

    /// Reads the line `row`, from 1, of a set.
    pub(super) fn line(
        &mut self,
        head: Head,
        row: usize,
        words: &str,
        line: usize,
        format: Format,
    ) -> Result<(), DeckError> {
        if head.titled && row == 1 {
            words.trim().clone_into(&mut self.title);
            return Ok(());
        }
        let cells = cells(words, [format.others(); A_LINE]);
        if row == head.lines() {
            self.number = whole(cells.first().copied().unwrap_or_default(), line)?;
            self.members.entry(self.number).or_default();
            let title = std::mem::take(&mut self.title);
            if !title.is_empty() {
                self.titles.insert(self.number, title);
            }
            return Ok(());
        }
        let members = self.members.entry(self.number).or_default();
        if head.kind == Kind::General {
            members.extend(general(&cells, line)?.into_iter().map(|member| (member, line)));
            return Ok(());
        }
        // Attributes may stand behind the node of a column.
        let many = if head.kind == Kind::Column { 1 } else { cells.len() };
        let numbers: Result<Vec<u64>, DeckError> = cells
            .iter()
            .take(many)
            .map(|cell| if cell.is_empty() { Ok(0) } else { whole(cell, line) })
            .collect();
        let numbers = numbers?;
        match head.kind {
            Kind::Column => members.extend(numbers.first().map(|n| (Member::Node(*n), line))),
            Kind::Ranges => members.extend(
                numbers
                    .chunks(2)
                    .filter(|pair| pair[0] != 0)
                    .map(|pair| (Member::Nodes(pair[0], pair[pair.len() - 1], 1), line)),
            ),
            Kind::Steps => members.extend(numbers.first().filter(|first| **first != 0).map(|first| {
                let [last, step] = [1, 2].map(|at| numbers.get(at).copied().unwrap_or_default());
                (Member::Nodes(*first, last, step.max(1)), line)
            })),
            Kind::Sets => {
                members.extend(numbers.iter().filter(|n| **n != 0).map(|n| (Member::Set(*n), line)));
            }
            Kind::List | Kind::General => {
                members.extend(numbers.iter().filter(|n| **n != 0).map(|n| (Member::Node(*n), line)));
            }
        }
        Ok(())
    }

    /// Puts all sets into the mesh, by their titles; those that have none, or one that another has, as `set
    /// 7`.
    pub(super) fn gather(self, of_part: &BTreeMap<u64, Vec<u64>>, found: &mut Gathered) {
        let mut taken = BTreeSet::new();
        let mut made = Vec::new();
        for (number, members) in &self.members {
            let title = self.titles.get(number).filter(|title| taken.insert((*title).clone()));
            let name = title.cloned().unwrap_or_else(|| format!("set {number}"));
            if let (None, Some(title)) = (title, self.titles.get(number)) {
                let line = members.first().map_or(1, |(_, line)| *line);
                found.note(line, format!("a second set of nodes `{title}` is called `set {number}`"));
            }
            made.push((name, self.nodes(members, of_part, found, 0)));
        }
        for (name, nodes) in made {
            match nodes {
                Ok(nodes) => found.node_set(&name).extend(nodes),
                Err(why) => found.note(why.line, format!("the set `{name}` is passed over: {}", why.what)),
            }
        }
    }

    fn nodes(
        &self,
        members: &[(Member, usize)],
        of_part: &BTreeMap<u64, Vec<u64>>,
        found: &Gathered,
        depth: usize,
    ) -> Result<Vec<u64>, DeckError> {
        let mut nodes = Vec::new();
        for (member, line) in members {
            match member {
                Member::Node(number) => nodes.push(*number),
                Member::Nodes(from, to, step) => {
                    nodes.extend(
                        found
                            .nodes_between(*from, *to)
                            .into_iter()
                            .filter(|n| (n - from).is_multiple_of(*step)),
                    );
                }
                Member::Set(_) if depth > DEEPEST => {
                    return Err(fault(*line, format!("sets lie within each other more than {DEEPEST} deep")));
                }
                Member::Set(number) => {
                    let Some(inner) = self.members.get(number) else {
                        return Err(fault(
                            *line,
                            format!("there is no set of nodes {number}, which a set names here"),
                        ));
                    };
                    if let Some(known) = self.known.borrow().get(number) {
                        nodes.extend(known);
                        continue;
                    }
                    let mut inside = self.nodes(inner, of_part, found, depth + 1)?;
                    inside.sort_unstable();
                    inside.dedup();
                    nodes.extend(&inside);
                    self.known.borrow_mut().insert(*number, inside);
                }
                Member::Part(part) => {
                    let elements = of_part.get(part).into_iter().flatten();
                    nodes.extend(elements.flat_map(|element| found.nodes_of(*element)));
                }
                Member::All => nodes.extend(found.nodes_between(0, u64::MAX)),
            }
        }
        Ok(nodes)
    }
}

/// A line of `*SET_NODE_GENERAL`.
fn general(cells: &[&str], line: usize) -> Result<Vec<Member>, DeckError> {
    let option = cells.first().copied().unwrap_or_default().to_ascii_uppercase();
    let numbers = || -> Result<Vec<u64>, DeckError> {
        let cells = cells.iter().skip(1).filter(|cell| !cell.is_empty());
        let numbers: Result<Vec<u64>, DeckError> = cells.map(|cell| whole(cell, line)).collect();
        Ok(numbers?.into_iter().filter(|number| *number != 0).collect())
    };
    match option.as_str() {
        "ALL" => Ok(vec![Member::All]),
        "NODE" => Ok(numbers()?.into_iter().map(Member::Node).collect()),
        "PART" => Ok(numbers()?.into_iter().map(Member::Part).collect()),
        "SET_NODE" => Ok(numbers()?.into_iter().map(Member::Set).collect()),
        _ => Err(fault(
            line,
            format!(
                "`{option}` of `*SET_NODE_GENERAL` is not read; `ALL`, `NODE`, `PART` and `SET_NODE` are"
            ),
        )),
    }
}
