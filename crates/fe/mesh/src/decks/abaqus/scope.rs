//! Numbers and sets of one part, instance or model: a file with parts numbers the nodes of each from one.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::decks::gathered::{Gathered, MOST_NUMBER};
use crate::decks::{DeckError, fault};

/// Sets within sets within sets.
const DEEPEST: usize = 50;

/// Members of a set.
#[derive(Debug, Clone)]
pub(super) enum Member {
    Number(u64),
    /// First, last and step.
    Range(u64, u64, u64),
    /// Another set, maybe of an instance: `plate-1.edge`, `plate-1.5`.
    Named(String),
    /// The nodes of a set of elements.
    NodesOf(String),
    In(String, Box<Member>),
}

/// Named members with the lines that they stand in.
#[derive(Debug, Clone, Default)]
pub(super) struct Sets {
    /// Names as they first stand in the file, in that order; Abaqus takes capitals and small letters for the
    /// same.
    pub(super) all: Vec<(String, Vec<(Member, usize)>)>,
    places: BTreeMap<String, usize>,
}

impl Sets {
    pub(super) fn of(&mut self, name: &str) -> &mut Vec<(Member, usize)> {
        let next = self.all.len();
        let at = *self.places.entry(name.to_ascii_uppercase()).or_insert(next);
        if at == next {
            self.all.push((name.to_owned(), Vec::new()));
        }
        &mut self.all[at].1
    }

    fn find(&self, name: &str) -> Option<&[(Member, usize)]> {
        self.places.get(&name.to_ascii_uppercase()).map(|at| self.all[*at].1.as_slice())
    }
}

/// Nodes, elements and sets that share their numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct Scope {
    pub(super) nodes: Vec<(u64, [f64; 3], usize)>,
    /// Plane elements.
    pub(super) elements: Vec<(u64, Vec<u64>, usize)>,
    /// Nodes of elements along lines.
    pub(super) lines: Vec<(u64, Vec<u64>)>,
    pub(super) node_sets: Sets,
    pub(super) element_sets: Sets,
}

impl Scope {
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty() && self.elements.is_empty()
    }
}

/// Where an instance of a part is.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Placement {
    pub(super) shift: [f64; 3],
    /// A point of the axis along z, and the angle [rad].
    pub(super) rotation: Option<([f64; 2], f64)>,
}

impl Placement {
    /// First shifted, then rotated, as Abaqus does.
    fn of(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = [x + self.shift[0], y + self.shift[1], z + self.shift[2]];
        let Some(([cx, cy], angle)) = self.rotation else { return [x, y, z] };
        let (sin, cos) = libm::sincos(angle);
        let (dx, dy) = (x - cx, y - cy);
        [cx + cos * dx - sin * dy, cy + sin * dx + cos * dy, z]
    }
}

/// A scope at its place; its numbers begin at `offset` in the mesh.
#[derive(Debug)]
pub(super) struct Placed {
    /// Empty for a file without parts.
    pub(super) name: String,
    pub(super) scope: Scope,
    pub(super) placement: Placement,
    pub(super) offset: u64,
}

impl Placed {
    /// Puts nodes and elements, but no sets, into the mesh.
    pub(super) fn gather(&self, found: &mut Gathered) -> Result<(), DeckError> {
        for (number, place, line) in &self.scope.nodes {
            found.node(self.offset + number, self.placement.of(*place), *line)?;
        }
        let shifted = |nodes: &[u64]| nodes.iter().map(|n| self.offset + n).collect::<Vec<u64>>();
        for (number, corners, line) in &self.scope.elements {
            found.element(self.offset + number, shifted(corners), *line)?;
        }
        for (number, nodes) in &self.scope.lines {
            found.line_element(self.offset + number, shifted(nodes));
        }
        Ok(())
    }
}

/// Which of the two kinds of sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    Nodes,
    Elements,
}

/// A set that is known: the offset of its scope, whether it is one of nodes, and its name in capitals.
type SetKey = (Option<u64>, bool, String);

/// Finds out what sets hold, in numbers of the mesh.
pub(super) struct Resolver<'a> {
    pub(super) placed: &'a [Placed],
    /// Sets of the assembly: of nodes, of elements.
    pub(super) assembly: [&'a Sets; 2],
    pub(super) found: &'a Gathered,
    /// Known sets, with their members.
    pub(super) known: RefCell<BTreeMap<SetKey, Vec<u64>>>,
}

impl Resolver<'_> {
    /// The numbers of some members within a scope, or within the assembly.
    pub(super) fn numbers(
        &self,
        members: &[(Member, usize)],
        of: Of,
        within: Option<&Placed>,
        depth: usize,
    ) -> Result<Vec<u64>, DeckError> {
        let mut numbers = Vec::new();
        for (member, line) in members {
            if depth > DEEPEST {
                return Err(fault(*line, format!("sets lie within each other more than {DEEPEST} deep")));
            }
            match member {
                Member::Number(number) => numbers.push(self.offset(within, *line)? + number),
                Member::Range(from, to, step) => {
                    let offset = self.offset(within, *line)?;
                    let (from, to) = (offset + from, offset + to);
                    let all = match of {
                        Of::Nodes => self.found.nodes_between(from, to),
                        Of::Elements => self.found.elements_between(from, to),
                    };
                    numbers.extend(all.into_iter().filter(|n| (n - from).is_multiple_of(*step)));
                }
                Member::In(instance, member) => {
                    let placed = self.instance(instance).ok_or_else(|| {
                        fault(*line, format!("there is no instance `{instance}`, which a set names here"))
                    })?;
                    let member = [((**member).clone(), *line)];
                    numbers.extend(self.numbers(&member, of, Some(placed), depth + 1)?);
                }
                Member::Named(name) => numbers.extend(self.named(name, of, within, *line, depth)?),
                Member::NodesOf(name) => {
                    let elements = self.named(name, Of::Elements, within, *line, depth)?;
                    numbers.extend(elements.iter().flat_map(|element| self.found.nodes_of(*element)));
                }
            }
        }
        Ok(numbers)
    }

    /// The numbers of the set `name`, or the number of an instance.
    fn named(
        &self,
        name: &str,
        of: Of,
        within: Option<&Placed>,
        line: usize,
        depth: usize,
    ) -> Result<Vec<u64>, DeckError> {
        let sets = |placed: &Placed| match of {
            Of::Nodes => placed.scope.node_sets.find(name).map(<[_]>::to_vec),
            Of::Elements => placed.scope.element_sets.find(name).map(<[_]>::to_vec),
        };
        if let Some(members) = within.and_then(sets) {
            return self.remembered(name, &members, of, within, depth);
        }
        let assembly = if of == Of::Nodes { self.assembly[0] } else { self.assembly[1] };
        if let Some(members) = assembly.find(name) {
            return self.remembered(name, members, of, None, depth);
        }
        let qualified = name
            .split_once('.')
            .and_then(|(instance, rest)| self.instance(instance).map(|placed| (placed, rest)));
        if let Some((placed, rest)) = qualified {
            return match rest.parse::<u64>() {
                Ok(number) if number < MOST_NUMBER => Ok(vec![placed.offset + number]),
                _ => self.named(rest, of, Some(placed), line, depth + 1),
            };
        }
        let what = if of == Of::Nodes { "nodes" } else { "elements" };
        Err(fault(line, format!("there is no set of {what} `{name}`, which a set names here")))
    }

    /// The numbers of a set, found out once: sets of sets may name it many times.
    fn remembered(
        &self,
        name: &str,
        members: &[(Member, usize)],
        of: Of,
        within: Option<&Placed>,
        depth: usize,
    ) -> Result<Vec<u64>, DeckError> {
        let key = (within.map(|placed| placed.offset), of == Of::Nodes, name.to_ascii_uppercase());
        if let Some(known) = self.known.borrow().get(&key) {
            return Ok(known.clone());
        }
        let mut numbers = self.numbers(members, of, within, depth + 1)?;
        numbers.sort_unstable();
        numbers.dedup();
        self.known.borrow_mut().insert(key, numbers.clone());
        Ok(numbers)
    }

    fn instance(&self, name: &str) -> Option<&Placed> {
        self.placed.iter().find(|placed| placed.name.eq_ignore_ascii_case(name))
    }

    /// Where the numbers of a scope begin; those of the assembly are of the only instance.
    fn offset(&self, within: Option<&Placed>, line: usize) -> Result<u64, DeckError> {
        match (within, self.placed) {
            (Some(placed), _) | (None, [placed]) => Ok(placed.offset),
            _ => Err(fault(line, "this number may be of any instance: name it, `INSTANCE=`")),
        }
    }
}
