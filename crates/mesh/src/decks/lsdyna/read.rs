//! LS-DYNA keyword files, read.

use std::collections::BTreeMap;

use super::columns::{Format, cells};
use super::sets::{Head, NodeSets};
use crate::decks::gathered::Gathered;
use crate::decks::origin::{self, Mark};
use crate::decks::{DeckError, fault, real, whole};

/// Numbers in the line of an element: its own, that of its part, eight nodes.
const OF_ELEMENT: usize = 10;

/// Elements that connect points or lie along lines: no part of the plane is theirs.
const WITHOUT_AREA: [&str; 9] = [
    "ELEMENT_MASS",
    "ELEMENT_BEAM",
    "ELEMENT_DISCRETE",
    "ELEMENT_SEATBELT",
    "ELEMENT_INERTIA",
    "ELEMENT_PLOTEL",
    "ELEMENT_GENERALIZED",
    "ELEMENT_BEARING",
    "ELEMENT_LANCING",
];

/// Cards that bring in or move nodes and elements, and what to do instead.
const REFUSED: [(&str, &str); 5] = [
    (
        "INCLUDE",
        "the file that it names is not at hand, or is to be moved or renumbered; put what it holds here",
    ),
    ("NODE_TRANSFORM", "it moves nodes; write them where they are"),
    ("PARAMETER", "it has values computed; write the values"),
    ("ELEMENT_SHELL_COMPOSITE", "write the shells as `*ELEMENT_SHELL`"),
    ("ELEMENT_SHELL_SOURCE_SINK", "write the shells as `*ELEMENT_SHELL`"),
];

/// Subject of the card whose lines follow.
#[derive(Debug, Clone, Copy)]
enum Card {
    Nodes,
    /// With how many lines an element has.
    Shells(usize),
    /// With the lines of one part, as far as more than one may follow.
    Part(Option<usize>),
    Set(Head),
    Other,
}

pub(in crate::decks) fn read(text: &str) -> Result<Gathered, DeckError> {
    let mut file = File::default();
    let mut at = (Card::Other, Format::Standard, 0);
    for (line, raw) in (1..).zip(text.lines()) {
        if raw.starts_with('$') {
            file.comment(raw);
            if let (Card::Set(_), 0) = (at.0, at.2) {
                file.name_of_set(raw);
            }
            continue;
        }
        if let Some(keyword) = raw.strip_prefix('*') {
            let (name, format) = file.format.of_card(keyword);
            if name == "END" {
                break;
            }
            at = (file.card(&name, line)?, format, 0);
            continue;
        }
        // A title may be empty; other empty lines are none.
        let titles = match at.0 {
            Card::Part(Some(lines)) => at.2 % lines == 0,
            Card::Part(None) => at.2 == 0,
            Card::Set(head) => at.2 == 0 && head.begins_with_a_title(),
            _ => false,
        };
        if raw.trim().is_empty() && !titles {
            continue;
        }
        at.2 += 1;
        file.line(at, raw.trim_end(), line)?;
    }
    Ok(file.gather())
}

#[derive(Default)]
struct File {
    format: Format,
    /// Whether Gmsh wrote it.
    by_gmsh: bool,
    /// Formats of the files that include the one whose lines come.
    outer: Vec<Format>,
    /// Titles by the number of the part.
    parts: BTreeMap<u64, String>,
    title: String,
    of_part: BTreeMap<u64, Vec<u64>>,
    sets: NodeSets,
    found: Gathered,
}

impl File {
    /// An included file may have a format of its own; behind it that of the file before goes on.
    fn comment(&mut self, raw: &str) {
        match origin::mark(raw) {
            Some(Mark::Begins(_)) => self.outer.push(self.format),
            Some(Mark::Ends) => self.format = self.outer.pop().unwrap_or(self.format),
            None => self.by_gmsh |= raw.to_ascii_lowercase().contains("created by gmsh"),
        }
    }

    /// Gmsh writes the name of a set into a comment before its number.
    fn name_of_set(&mut self, raw: &str) {
        if let (true, Some(name)) = (self.by_gmsh, raw.strip_prefix("$# ")) {
            self.sets.call(name);
        }
    }

    /// Subject of a card, by its keyword in capitals.
    fn card(&mut self, name: &str, line: usize) -> Result<Card, DeckError> {
        if let Some(options) = name.strip_prefix("KEYWORD") {
            self.format = Format::of_file(options);
            return Ok(Card::Other);
        }
        if let Some((_, instead)) = REFUSED.iter().find(|(refused, _)| name.starts_with(refused)) {
            return Err(fault(line, format!("`*{name}` is not read: {instead}")));
        }
        if let Some(head) = Head::of(name) {
            return Ok(Card::Set(head));
        }
        Ok(match name {
            "TITLE" => Card::Other,
            "NODE" => Card::Nodes,
            "PART" => Card::Part(Some(2)),
            // Further lines of inertia, contact and the like.
            _ if name.starts_with("PART_") && !name.starts_with("PART_COMPOSITE") && name != "PART_MOVE" => {
                self.found.note(line, format!("of `*{name}` only title and number are read"));
                Card::Part(None)
            }
            _ if name == "ELEMENT_SHELL" || name.starts_with("ELEMENT_SHELL_") => self.shells(name, line)?,
            _ if WITHOUT_AREA.iter().any(|known| name.starts_with(known)) => {
                self.found.note(line, format!("`*{name}` is passed over, as its elements have no area"));
                Card::Other
            }
            _ if name.starts_with("ELEMENT_") => {
                return Err(fault(line, format!("`*{name}` is not read; `*ELEMENT_SHELL` is")));
            }
            _ => {
                self.found.note(line, format!("`*{name}` is not read"));
                Card::Other
            }
        })
    }

    /// The lines of one shell follow from the words behind the keyword.
    fn shells(&mut self, name: &str, line: usize) -> Result<Card, DeckError> {
        let mut lines = 1;
        let options: Vec<&str> = name["ELEMENT_SHELL".len()..].split('_').filter(|w| !w.is_empty()).collect();
        // Thicknesses and an angle of the material share a line.
        lines += usize::from(options.iter().any(|word| ["THICKNESS", "BETA", "MCID"].contains(word)));
        for word in &options {
            match *word {
                "THICKNESS" | "BETA" | "MCID" => {}
                "OFFSET" | "DOF" => lines += 1,
                _ => return Err(fault(line, format!("`*{name}` is not read; `*ELEMENT_SHELL` is"))),
            }
        }
        if lines > 1 {
            self.found.note(line, format!("of `*{name}` only the nodes are read"));
        }
        Ok(Card::Shells(lines))
    }

    /// The line `row`, from 1, of a card.
    fn line(
        &mut self,
        (card, format, row): (Card, Format, usize),
        raw: &str,
        line: usize,
    ) -> Result<(), DeckError> {
        match card {
            Card::Nodes => {
                let cells = cells(raw, format.node());
                let number = |n: usize| cells.get(n).map_or(Ok(0.0), |cell| real(cell, line));
                let node = whole(cells.first().copied().unwrap_or_default(), line)?;
                self.found.node(node, [number(1)?, number(2)?, number(3)?], line)?;
            }
            Card::Shells(lines) if row % lines == 1 % lines => self.shell(raw, line, format)?,
            Card::Part(lines) => match lines.map_or(row, |lines| (row - 1) % lines + 1) {
                1 => raw.trim().clone_into(&mut self.title),
                2 => {
                    let cells = cells(raw, [format.others()]);
                    let number = whole(cells.first().copied().unwrap_or_default(), line)?;
                    let title = std::mem::take(&mut self.title);
                    if !title.is_empty() {
                        self.parts.insert(number, title);
                    }
                }
                _ => {}
            },
            Card::Set(head) => self.sets.line(head, row, raw, line, format)?,
            Card::Shells(_) | Card::Other => {}
        }
        Ok(())
    }

    fn shell(&mut self, raw: &str, line: usize, format: Format) -> Result<(), DeckError> {
        let cells = cells(raw, [format.element(); OF_ELEMENT]);
        let numbers: Result<Vec<u64>, DeckError> =
            cells.iter().map(|cell| if cell.is_empty() { Ok(0) } else { whole(cell, line) }).collect();
        let numbers = numbers?;
        let [element, part, nodes @ ..] = &numbers[..] else {
            return Err(fault(line, "an element lacks its part or its nodes"));
        };
        let (corners, between) = nodes.split_at(nodes.len().min(4));
        if between.iter().any(|node| *node != 0) {
            return Err(fault(
                line,
                format!("element {element} has nodes between its corners: mesh with elements of first order"),
            ));
        }
        let corners: Vec<u64> = corners.iter().copied().filter(|n| *n != 0).collect();
        self.found.element(*element, corners, line)?;
        self.of_part.entry(*part).or_default().push(*element);
        Ok(())
    }

    fn gather(self) -> Gathered {
        let Self { parts, of_part, sets, mut found, .. } = self;
        for (part, elements) in &of_part {
            let name = parts.get(part).cloned().unwrap_or_else(|| format!("part {part}"));
            found.set(&name).extend(elements);
        }
        sets.gather(&of_part, &mut found);
        found
    }
}
