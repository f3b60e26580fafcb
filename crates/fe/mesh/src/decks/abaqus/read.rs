//! Abaqus input files, read.

use std::collections::BTreeMap;

use super::cards::{Card, cards, cells};
use super::elements::{self, Kind};
use super::scope::{Member, Of, Placed, Placement, Resolver, Scope, Sets};
use crate::decks::gathered::{Gathered, MOST_NUMBER};
use crate::decks::{DeckError, fault, real, whole};

/// Cards that make or move nodes and elements, and what to do instead.
const REFUSED: [(&str, &str); 9] = [
    ("SYSTEM", "it gives nodes in axes of their own; write them in those of the model"),
    ("NGEN", "it makes nodes; write all of them"),
    ("NFILL", "it makes nodes; write all of them"),
    ("NCOPY", "it makes nodes; write all of them"),
    ("NMAP", "it moves nodes; write them where they are"),
    ("ELGEN", "it makes elements; write all of them"),
    ("ELCOPY", "it makes elements; write all of them"),
    ("IMPORT", "it takes bodies from another analysis; write them out"),
    ("PARAMETER", "it has values computed; write the values"),
];

/// Cards whose data may lie in another file, `INPUT=`.
const WITH_INPUT: [&str; 5] = ["INCLUDE", "NODE", "ELEMENT", "NSET", "ELSET"];

/// Cards that are neither mesh nor worth a note.
const SAID_BY_OTHERS: [&str; 6] =
    ["HEADING", "PREPRINT", "END PART", "ASSEMBLY", "END ASSEMBLY", "END INSTANCE"];

pub(in crate::decks) fn read(text: &str) -> Result<Gathered, DeckError> {
    let mut file = File::default();
    for card in cards(text) {
        file.card(&card)?;
    }
    file.gather()
}

/// Where the cards of a file are at.
#[derive(Default)]
enum Place {
    #[default]
    Model,
    Part(String),
    Assembly,
    Instance(usize),
}

/// A part at a place.
struct Instance {
    name: String,
    part: String,
    /// What the instance itself defines: meshes of assemblies without parts.
    own: Scope,
    placement: Placement,
    line: usize,
}

#[derive(Default)]
struct File {
    place: Place,
    model: Scope,
    /// By name in capitals.
    parts: BTreeMap<String, Scope>,
    /// Names in capitals, as they come up.
    order: Vec<String>,
    instances: Vec<Instance>,
    /// Sets of the assembly, of nodes and of elements.
    assembly: [Sets; 2],
    found: Gathered,
}

impl File {
    /// Scope of the cards at this place. The sets of an assembly are its own.
    fn scope(&mut self) -> &mut Scope {
        match &self.place {
            Place::Part(name) => self.parts.entry(name.clone()).or_default(),
            Place::Instance(at) => &mut self.instances[*at].own,
            Place::Model | Place::Assembly => &mut self.model,
        }
    }

    fn sets(&mut self, of: Of) -> &mut Sets {
        if matches!(self.place, Place::Assembly) {
            return &mut self.assembly[usize::from(of == Of::Elements)];
        }
        let scope = self.scope();
        if of == Of::Nodes { &mut scope.node_sets } else { &mut scope.element_sets }
    }

    fn card(&mut self, card: &Card<'_>) -> Result<(), DeckError> {
        let line = card.line;
        let named = |key: &str| {
            let value = card.parameter(key).filter(|value| !value.is_empty());
            value.ok_or_else(|| fault(line, format!("`*{}` lacks `{key}=`", card.name)))
        };
        if WITH_INPUT.contains(&card.name.as_str())
            && (card.name == "INCLUDE" || card.parameter("INPUT").is_some())
        {
            let (name, input) = (&card.name, card.parameter("INPUT").unwrap_or_default());
            return Err(fault(
                line,
                format!(
                    "`*{name}, INPUT={input}` is not read: a mesh is one file; put what `{input}` holds here"
                ),
            ));
        }
        match card.name.as_str() {
            "NODE" => self.nodes(card)?,
            "ELEMENT" => self.elements(card)?,
            "NSET" => self.set(card, Of::Nodes, named("NSET")?)?,
            "ELSET" => self.set(card, Of::Elements, named("ELSET")?)?,
            "PART" => {
                let name = named("NAME")?.to_ascii_uppercase();
                if self.parts.insert(name.clone(), Scope::default()).is_none() {
                    self.order.push(name.clone());
                }
                self.place = Place::Part(name);
            }
            "INSTANCE" => self.instance(card, named("NAME")?)?,
            "END PART" | "END ASSEMBLY" => self.place = Place::Model,
            "ASSEMBLY" | "END INSTANCE" => self.place = Place::Assembly,
            name => {
                if let Some((_, instead)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
                    return Err(fault(line, format!("`*{name}` is not read: {instead}")));
                }
                if !SAID_BY_OTHERS.contains(&name) {
                    self.found.note(line, format!("`*{name}` is not read"));
                }
            }
        }
        Ok(())
    }

    fn nodes(&mut self, card: &Card<'_>) -> Result<(), DeckError> {
        let system = card.parameter("SYSTEM").unwrap_or("R");
        if !system.eq_ignore_ascii_case("R") {
            return Err(fault(
                card.line,
                format!("`*NODE, SYSTEM={system}` is not read: write the nodes in x and y"),
            ));
        }
        let mut members = Vec::new();
        for &(line, words) in &card.data {
            // An empty cell is a zero.
            let cells: Vec<&str> = words.split(',').collect();
            let coordinate = |n: usize| cells.get(n).map_or(Ok(0.0), |cell| real(cell, line));
            let number = whole(cells[0], line)?;
            self.scope().nodes.push((number, [coordinate(1)?, coordinate(2)?, coordinate(3)?], line));
            members.push((Member::Number(number), line));
        }
        if let Some(set) = card.parameter("NSET").filter(|set| !set.is_empty()) {
            self.scope().node_sets.of(set).extend(members);
        }
        Ok(())
    }

    fn elements(&mut self, card: &Card<'_>) -> Result<(), DeckError> {
        let name = card.parameter("TYPE").unwrap_or_default().to_ascii_uppercase();
        let refuse =
            |why: String| Err(fault(card.line, format!("elements of type `{name}` are not read{why}")));
        let mut numbers = Vec::new();
        match elements::kind(&name) {
            Kind::Plane(corners) => {
                // Nodes may go on in the next line.
                let mut pending: Vec<u64> = Vec::new();
                for &(line, words) in &card.data {
                    for cell in cells(words) {
                        pending.push(whole(cell, line)?);
                    }
                    if pending.len() > corners {
                        let all = std::mem::take(&mut pending);
                        if all.len() != corners + 1 {
                            let given = all.len();
                            return Err(fault(
                                line,
                                format!("an element of {corners} nodes has {given} numbers"),
                            ));
                        }
                        self.scope().elements.push((all[0], all[1..].to_vec(), line));
                        numbers.push((Member::Number(all[0]), line));
                    }
                }
                if !pending.is_empty() {
                    let line = card.data.last().map_or(card.line, |(line, _)| *line);
                    return Err(fault(line, "an element ends in the middle of its nodes"));
                }
            }
            Kind::Line(nodes) => {
                for &(line, words) in &card.data {
                    let all: Result<Vec<u64>, DeckError> =
                        cells(words).take(nodes + 1).map(|cell| whole(cell, line)).collect();
                    let all = all?;
                    let Some((number, nodes)) = all.split_first() else { continue };
                    self.scope().lines.push((*number, nodes.to_vec()));
                    numbers.push((Member::Number(*number), line));
                }
                self.found.note(
                    card.line,
                    format!("elements of type `{name}` are passed over, as they lie along lines"),
                );
            }
            Kind::Point => {
                self.found.note(
                    card.line,
                    format!("elements of type `{name}` are passed over, as they have no area"),
                );
            }
            Kind::Curved(nodes) => {
                return refuse(format!(
                    ", as they have {nodes} nodes: mesh with elements of first order; {}",
                    elements::READ
                ));
            }
            Kind::Other => return refuse(format!("; {}", elements::READ)),
        }
        if let Some(set) = card.parameter("ELSET").filter(|set| !set.is_empty()) {
            self.scope().element_sets.of(set).extend(numbers);
        }
        Ok(())
    }

    /// A set of nodes or elements; one of an instance is put down under its name there.
    fn set(&mut self, card: &Card<'_>, of: Of, name: &str) -> Result<(), DeckError> {
        let instance = card.parameter("INSTANCE").filter(|instance| !instance.is_empty());
        let mut members = Vec::new();
        if let (Of::Nodes, Some(elements)) = (of, card.parameter("ELSET")) {
            members.push((Member::NodesOf(elements.to_owned()), card.line));
        }
        for &(line, words) in &card.data {
            if card.parameter("GENERATE").is_some() {
                let limits: Result<Vec<u64>, DeckError> =
                    cells(words).map(|cell| whole(cell, line)).collect();
                let limits = limits?;
                let [from, to, step @ ..] = &limits[..] else {
                    return Err(fault(line, "`GENERATE` takes the first number, the last one and the step"));
                };
                let step = step.first().copied().unwrap_or(1).max(1);
                members.push((Member::Range(*from, *to, step), line));
                continue;
            }
            members.extend(cells(words).map(|cell| match cell.parse() {
                Ok(number) if number < MOST_NUMBER => (Member::Number(number), line),
                _ => (Member::Named(cell.to_owned()), line),
            }));
        }
        let members = members.into_iter().map(|(member, line)| match instance {
            Some(instance) => (Member::In(instance.to_owned(), member.into()), line),
            None => (member, line),
        });
        self.sets(of).of(name).extend(members);
        Ok(())
    }

    fn instance(&mut self, card: &Card<'_>, name: &str) -> Result<(), DeckError> {
        let mut rows = Vec::new();
        for &(line, words) in &card.data {
            let numbers: Result<Vec<f64>, DeckError> =
                words.split(',').map(|cell| real(cell, line)).collect();
            rows.push((line, numbers?));
        }
        let mut placement = Placement::default();
        if let Some((_, shift)) = rows.first() {
            placement.shift = [0, 1, 2].map(|axis| shift.get(axis).copied().unwrap_or_default());
        }
        if let Some((line, turn)) = rows.get(1) {
            let [ax, ay, az, bx, by, bz, degrees] = turn[..] else {
                return Err(fault(*line, "a rotation takes two points of its axis and an angle"));
            };
            // Along z, up or down.
            let along = (bx - ax).abs() + (by - ay).abs() <= 1e-9 * (bz - az).abs();
            if !along && degrees != 0.0 {
                return Err(fault(
                    *line,
                    "the instance is rotated about an axis that is not along z: write it flat",
                ));
            }
            placement.rotation = Some(([ax, ay], (degrees * (bz - az).signum()).to_radians()));
        }
        let part = card.parameter("PART").unwrap_or_default().to_ascii_uppercase();
        self.place = Place::Instance(self.instances.len());
        self.instances.push(Instance {
            name: name.to_owned(),
            part,
            own: Scope::default(),
            placement,
            line: card.line,
        });
        Ok(())
    }

    /// The mesh of all instances, or of the file where it has none.
    fn gather(self) -> Result<Gathered, DeckError> {
        let Self { model, mut parts, order, instances, assembly, mut found, .. } = self;
        let mut placed: Vec<Placed> = Vec::new();
        let mut put = |name: String, scope: Scope, placement: Placement| {
            let offset = placed.len() as u64 * MOST_NUMBER;
            placed.push(Placed { name, scope, placement, offset });
        };
        if !model.is_empty() {
            put(String::new(), model, Placement::default());
        }
        // Parts that nothing places stand where they are.
        if instances.is_empty() {
            for name in order {
                let scope = parts.remove(&name).unwrap_or_default();
                put(name, scope, Placement::default());
            }
        }
        for Instance { name, part, own, placement, line } in instances {
            let scope = match parts.get(&part) {
                Some(part) if own.is_empty() => {
                    let mut scope = part.clone();
                    for (to, from) in
                        [(&mut scope.node_sets, own.node_sets), (&mut scope.element_sets, own.element_sets)]
                    {
                        from.all.into_iter().for_each(|(name, members)| to.of(&name).extend(members));
                    }
                    scope
                }
                None if own.is_empty() => {
                    return Err(fault(
                        line,
                        format!("there is no part `{part}`, which the instance `{name}` is of"),
                    ));
                }
                _ => own,
            };
            put(name, scope, placement);
        }
        for one in &placed {
            one.gather(&mut found)?;
        }
        sets(&placed, &assembly, &mut found);
        Ok(found)
    }
}

/// Puts all sets into the mesh except those with missing members: meshio writes such, and asking for one is
/// an error. Sets of the assembly keep their names, as do those of an instance whose name is unique; others
/// are prefixed with the name of the instance.
fn sets(placed: &[Placed], assembly: &[Sets; 2], found: &mut Gathered) {
    let mut made = Vec::new();
    let resolver =
        Resolver { placed, assembly: [&assembly[0], &assembly[1]], found, known: Default::default() };
    for (of, own) in [(Of::Nodes, &assembly[0]), (Of::Elements, &assembly[1])] {
        let sets = |placed: &'_ Placed| -> Sets {
            if of == Of::Nodes { placed.scope.node_sets.clone() } else { placed.scope.element_sets.clone() }
        };
        let mut times: BTreeMap<String, usize> = BTreeMap::new();
        let of_instances: Vec<(&Placed, Sets)> = placed.iter().map(|placed| (placed, sets(placed))).collect();
        let names = of_instances.iter().flat_map(|(_, sets)| &sets.all).chain(&own.all).map(|(name, _)| name);
        names.for_each(|name| *times.entry(name.to_ascii_uppercase()).or_default() += 1);
        for (placed, sets) in &of_instances {
            for (name, members) in &sets.all {
                let numbers = resolver.numbers(members, of, Some(placed), 0);
                let only = placed.name.is_empty() || times.get(&name.to_ascii_uppercase()) == Some(&1);
                made.push((of, if only { name.clone() } else { format!("{}.{name}", placed.name) }, numbers));
            }
        }
        for (name, members) in &own.all {
            made.push((of, name.clone(), resolver.numbers(members, of, None, 0)));
        }
    }
    for (of, name, numbers) in made {
        match (of, numbers) {
            (Of::Nodes, Ok(numbers)) => found.node_set(&name).extend(numbers),
            (Of::Elements, Ok(numbers)) => found.set(&name).extend(numbers),
            (_, Err(why)) => found.note(why.line, format!("the set `{name}` is passed over: {}", why.what)),
        }
    }
}
