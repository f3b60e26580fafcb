//! Gmsh files, read: formats 2.2, 4.0 and 4.1, as text and binary.
//!
//! Formats 4 list the points, curves and surfaces of the geometry with the groups that they are in, and
//! elements by these; format 2.2 has the group beside each element, and an element in two groups twice. A
//! group's number is negative where the mesh goes through a curve backwards.

use std::collections::BTreeMap;

use super::elements::dimension_and_nodes;
use super::source::Source;
use super::{QUADRILATERAL, TRIANGLE};
use crate::decks::gathered::Gathered;
use crate::decks::{DeckError, ReadDeck, fault};

/// Longest list of groups of one curve or surface.
const MOST_GROUPS: i64 = 1 << 20;

/// How a section is to be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    /// 2.0 to 2.2.
    Two,
    /// 4.0.
    FourZero,
    /// 4.1.
    FourOne,
}

pub(in crate::decks) fn read(bytes: &[u8]) -> Result<ReadDeck, DeckError> {
    let mut file = File {
        source: Source::of(bytes),
        version: Version::FourOne,
        names: BTreeMap::new(),
        groups: BTreeMap::new(),
        corners: BTreeMap::new(),
        found: Gathered::default(),
    };
    while let Some((line, head)) = file.source.next_line() {
        let Some(section) = head.strip_prefix('$') else {
            return Err(fault(line, format!("`{head}` stands outside of a section; is this a Gmsh file?")));
        };
        match section {
            "MeshFormat" => file.format()?,
            "PhysicalNames" => file.physical_names()?,
            "Entities" => file.entities(false)?,
            "PartitionedEntities" => file.partitions()?,
            "Nodes" => file.nodes()?,
            "ParametricNodes" => file.parametric_nodes()?,
            "Elements" => file.elements()?,
            "Comments" => {}
            "NOD" | "ELM" => {
                return Err(fault(line, format!("`${section}` is of format 1: {SAVE_AS}")));
            }
            other => file.found.note(line, format!("section `${other}` is not read")),
        }
        file.source.skip_section(section)?;
    }
    let last = file.source.line();
    file.found.finish(last)
}

/// What to do about formats that are not read.
const SAVE_AS: &str = "save it as version 4.1 (`gmsh in.msh -save -format msh41`)";

struct File<'a> {
    source: Source<'a>,
    version: Version,
    /// Names of groups, by dimension and number.
    names: BTreeMap<(i64, i64), String>,
    /// Names of the groups of curves and surfaces, by dimension and tag.
    groups: BTreeMap<(i64, i64), Vec<String>>,
    /// Plane elements of format 2.2, by their surface and corners.
    corners: BTreeMap<(i64, Vec<u64>), u64>,
    found: Gathered,
}

impl File<'_> {
    fn format(&mut self) -> Result<(), DeckError> {
        let (line, text) = self.source.must_line()?;
        let mut cells = text.split_whitespace();
        let mut cell = || cells.next().unwrap_or_default();
        let (version, kind, size) = (cell(), cell(), cell());
        self.version = match version {
            "2" | "2.0" | "2.1" | "2.2" => Version::Two,
            "4" | "4.0" => Version::FourZero,
            "4.1" => Version::FourOne,
            _ => return Err(fault(line, format!("format {version} is not read: {SAVE_AS}"))),
        };
        // Some programs write the size as a decimal number.
        let size = match size.parse::<f64>() {
            Ok(4.0) => Some(4),
            Ok(8.0) => Some(8),
            _ => None,
        };
        let Some(size) = size.filter(|_| ["0", "1"].contains(&kind)) else {
            return Err(fault(
                line,
                format!("`{text}` is no head of a Gmsh file: version, 0 or 1, and 8 belong here"),
            ));
        };
        self.source.size = size;
        if kind == "1" {
            self.source.binary = true;
            match self.source.int()? {
                1 => {}
                // The number one of a machine with the other order of bytes.
                0x0100_0000 => self.source.big_endian = true,
                _ => return Err(fault(line, "the head of a binary file ends in the number 1")),
            }
        }
        Ok(())
    }

    fn physical_names(&mut self) -> Result<(), DeckError> {
        let (line, count) = self.source.must_line()?;
        let count: usize = count.parse().map_err(|_| fault(line, format!("`{count}` is no whole number")))?;
        for _ in 0..count {
            let (line, text) = self.source.must_line()?;
            let bad = || fault(line, format!("`{text}` is no dimension, number and name of a group"));
            let (dimension, rest) = text.split_once(char::is_whitespace).ok_or_else(bad)?;
            let (number, name) = rest.trim_start().split_once(char::is_whitespace).ok_or_else(bad)?;
            let key =
                (dimension.parse().map_err(|_| bad())?, number.parse::<i64>().map_err(|_| bad())?.abs());
            self.names.insert(key, name.trim().trim_matches('"').to_owned());
        }
        Ok(())
    }

    /// The name of a group. A negative number is the same group with its curve reversed.
    fn name(&self, dimension: i64, number: i64) -> String {
        let number = number.abs();
        self.names.get(&(dimension, number)).cloned().unwrap_or_else(|| format!("physical {number}"))
    }

    /// Counts of the partitions, and of the copies of elements that they have of each other, with the tags of
    /// these; then their points, curves and surfaces.
    fn partitions(&mut self) -> Result<(), DeckError> {
        self.source.count()?;
        for _ in 0..self.source.count()? {
            self.source.int()?;
            self.source.int()?;
        }
        self.entities(true)
    }

    /// Groups of points, curves and surfaces; those of partitions name the one that they are part of, and
    /// their partitions.
    fn entities(&mut self, partitioned: bool) -> Result<(), DeckError> {
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = self.source.count()?;
        }
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                let tag = self.source.int()?;
                if partitioned {
                    self.source.int()?;
                    self.source.int()?;
                    self.tags()?;
                }
                // A box, or for points of 4.1 the place.
                let numbers = if dimension == 0 && self.version == Version::FourOne { 3 } else { 6 };
                for _ in 0..numbers {
                    self.source.real()?;
                }
                let groups = self.tags()?;
                if dimension > 0 {
                    self.tags()?;
                }
                let names: Vec<String> =
                    groups.into_iter().map(|group| self.name(dimension, group)).collect();
                if !names.is_empty() {
                    self.groups.insert((dimension, tag), names);
                }
            }
        }
        Ok(())
    }

    /// A count, and as many tags.
    fn tags(&mut self) -> Result<Vec<i64>, DeckError> {
        let count = self.source.count()?;
        if count > MOST_GROUPS {
            return Err(self.source.fault(format!("{count} groups or boundaries of one curve or surface")));
        }
        (0..count).map(|_| self.source.int()).collect()
    }

    fn nodes(&mut self) -> Result<(), DeckError> {
        if self.version == Version::Two {
            for _ in 0..self.leading_count()? {
                let line = self.source.line_ahead();
                let tag = self.tag()?;
                self.node(tag, 0, line)?;
            }
            return Ok(());
        }
        let blocks = self.source.count()?;
        for _ in 0..if self.version == Version::FourOne { 3 } else { 1 } {
            self.source.count()?;
        }
        for _ in 0..blocks {
            let [first, second, parametric] = [self.source.int()?, self.source.int()?, self.source.int()?];
            let dimension = if self.version == Version::FourOne { first } else { second };
            let count = self.source.count()?;
            let more = if parametric == 0 { 0 } else { dimension };
            if self.version == Version::FourZero {
                for _ in 0..count {
                    let line = self.source.line_ahead();
                    let tag = self.tag()?;
                    self.node(tag, more, line)?;
                }
            } else {
                for tag in self.source.counts(count)? {
                    let line = self.source.line_ahead();
                    self.node(tag, more, line)?;
                }
            }
        }
        Ok(())
    }

    /// Nodes of format 2.2 with dimension and tag of the curve or surface that they are on, and their places
    /// along it.
    fn parametric_nodes(&mut self) -> Result<(), DeckError> {
        for _ in 0..self.leading_count()? {
            let line = self.source.line_ahead();
            let tag = self.tag()?;
            self.node(tag, 0, line)?;
            let (dimension, _) = (self.source.int()?, self.source.int()?);
            // Nodes within a body have no place along it.
            for _ in 0..if (1..=2).contains(&dimension) { dimension } else { 0 } {
                self.source.real()?;
            }
        }
        Ok(())
    }

    /// The number of a node or element of formats 2.2 and 4.0, which is of four bytes.
    fn tag(&mut self) -> Result<u64, DeckError> {
        let tag = self.source.int()?;
        u64::try_from(tag).map_err(|_| self.source.fault(format!("{tag} is no number of a node or element")))
    }

    /// The coordinates of a node, and `more` parameters along its curve or surface.
    fn node(&mut self, tag: u64, more: i64, line: usize) -> Result<(), DeckError> {
        let place = [self.source.real()?, self.source.real()?, self.source.real()?];
        for _ in 0..more {
            self.source.real()?;
        }
        self.found.node(tag, place, line)
    }

    /// How many nodes or elements follow: a line of text in binary files of format 2.2, too.
    fn leading_count(&mut self) -> Result<i64, DeckError> {
        let (line, text) = self.source.must_line()?;
        text.parse()
            .ok()
            .filter(|count| *count >= 0)
            .ok_or_else(|| fault(line, format!("`{text}` is no count")))
    }

    fn elements(&mut self) -> Result<(), DeckError> {
        if self.version == Version::Two {
            return if self.source.binary {
                self.elements_in_groups_binary()
            } else {
                self.elements_in_groups()
            };
        }
        let blocks = self.source.count()?;
        for _ in 0..if self.version == Version::FourOne { 3 } else { 1 } {
            self.source.count()?;
        }
        for _ in 0..blocks {
            let [first, second, kind] = [self.source.int()?, self.source.int()?, self.source.int()?];
            let (dimension, tag) =
                if self.version == Version::FourOne { (first, second) } else { (second, first) };
            let count = self.source.count()?;
            let nodes = self.nodes_of(kind)?;
            let names = self.groups.get(&(dimension, tag)).cloned().unwrap_or_default();
            for _ in 0..count {
                let line = self.source.line_ahead();
                let mut numbers = Vec::new();
                for _ in 0..=nodes {
                    let number = if self.version == Version::FourOne {
                        self.source.count()? as u64
                    } else {
                        self.tag()?
                    };
                    numbers.push(number);
                }
                self.element((kind, tag), &names, &numbers, line)?;
            }
        }
        Ok(())
    }

    /// Elements of format 2.2: number, type, count of tags, group, entity and further tags, nodes.
    fn elements_in_groups(&mut self) -> Result<(), DeckError> {
        for _ in 0..self.leading_count()? {
            let line = self.source.line_ahead();
            let number = self.tag()?;
            let (kind, tags) = (self.source.int()?, self.source.int()?);
            self.element_in_group(number, kind, tags, line)?;
        }
        Ok(())
    }

    /// The same, binary: type, how many follow, count of tags; and of each number, tags, nodes.
    fn elements_in_groups_binary(&mut self) -> Result<(), DeckError> {
        let mut left = self.leading_count()?;
        while left > 0 {
            let [kind, follow, tags] = [self.source.int()?, self.source.int()?, self.source.int()?];
            if !(1..=left).contains(&follow) {
                return Err(self.source.fault(format!("{follow} elements of {left} that are left")));
            }
            left -= follow;
            for _ in 0..follow {
                let line = self.source.line_ahead();
                let number = self.tag()?;
                self.element_in_group(number, kind, tags, line)?;
            }
        }
        Ok(())
    }

    fn element_in_group(&mut self, number: u64, kind: i64, tags: i64, line: usize) -> Result<(), DeckError> {
        let nodes = self.nodes_of(kind)?;
        if !(0..=MOST_GROUPS).contains(&tags) {
            return Err(self.source.fault(format!("{tags} tags of an element")));
        }
        let mut of = [0, 0];
        for at in 0..tags {
            let tag = self.source.int()?;
            if let Some(place) = of.get_mut(at as usize) {
                *place = tag;
            }
        }
        let [group, entity] = of;
        let mut numbers = vec![number];
        for _ in 0..nodes {
            numbers.push(self.tag()?);
        }
        let dimension = dimension_and_nodes(kind).map_or(0, |(dimension, _)| dimension);
        let names = if group == 0 { Vec::new() } else { vec![self.name(dimension, group)] };
        if dimension == 2 {
            // One that is in two groups stands twice, with two numbers.
            let mut corners = numbers[1..].to_vec();
            corners.sort_unstable();
            numbers[0] = *self.corners.entry((entity.abs(), corners)).or_insert(number);
            if numbers[0] != number {
                for name in &names {
                    self.found.set(name).push(numbers[0]);
                }
                return Ok(());
            }
        }
        self.element((kind, entity.abs()), &names, &numbers, line)
    }

    /// How many nodes elements of that type have, where they are not refused.
    fn nodes_of(&self, kind: i64) -> Result<i64, DeckError> {
        match dimension_and_nodes(kind) {
            Some((0 | 1, nodes)) => Ok(nodes),
            Some((2, nodes)) if kind == TRIANGLE || kind == QUADRILATERAL => Ok(nodes),
            Some((2, nodes)) => Err(self.source.fault(format!(
                "elements of type {kind} are not read, as they have {nodes} nodes: mesh with elements of \
                 first order; triangles (2) and quadrilaterals (3) are read"
            ))),
            _ => Err(self.source.fault(format!(
                "elements of type {kind} are not read; triangles (2) and quadrilaterals (3) are"
            ))),
        }
    }

    /// An element of a type on a curve or surface, its number before its nodes, in these groups.
    fn element(
        &mut self,
        (kind, tag): (i64, i64),
        names: &[String],
        numbers: &[u64],
        line: usize,
    ) -> Result<(), DeckError> {
        let plane = kind == TRIANGLE || kind == QUADRILATERAL;
        if plane {
            self.found.element(numbers[0], numbers[1..].to_vec(), line)?;
            for name in names {
                self.found.set(name).push(numbers[0]);
            }
            if names.is_empty() {
                self.found.set(&format!("surface {tag}")).push(numbers[0]);
            }
        } else if dimension_and_nodes(kind).is_some_and(|(dimension, _)| dimension == 1) {
            // Lines bound the surfaces; those of a named curve make a set of nodes.
            for name in names {
                self.found.node_set(name).extend(&numbers[1..]);
            }
        }
        Ok(())
    }
}
