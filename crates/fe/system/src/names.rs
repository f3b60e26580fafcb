//! Bodies, surfaces and marks by their names.

use std::ops::Range;

use stribeck_mesh::Body;

use crate::error::Error;

/// Names, and the nodes that they stand for.
#[derive(Debug, Default)]
pub(crate) struct Names {
    /// Of the mesh, in its order.
    pub(crate) bodies: Vec<Body>,
    /// Surfaces and marked nodes.
    pub(crate) groups: Vec<(String, Vec<u32>)>,
}

impl Names {
    pub(crate) fn body(&self, name: &str) -> Result<usize, Error> {
        let found = self.bodies.iter().position(|body| body.name == name);
        found.ok_or_else(|| unknown("body", name, self.bodies.iter().map(|body| &*body.name)))
    }

    /// Nodes of a body, a surface or a mark.
    pub(crate) fn nodes(&self, name: &str) -> Result<Vec<u32>, Error> {
        if let Some((_, nodes)) = self.groups.iter().find(|(n, _)| n == name) {
            return Ok(nodes.clone());
        }
        let known = || {
            let bodies = self.bodies.iter().map(|body| &*body.name);
            bodies.chain(self.groups.iter().map(|(name, _)| &**name))
        };
        let body = self.body(name).map_err(|_| unknown("body, surface or mark", name, known()))?;
        Ok(nodes_of(&self.bodies[body]).collect())
    }

    pub(crate) fn check_new(&self, name: &str) -> Result<(), Error> {
        let taken = self.body(name).is_ok() || self.groups.iter().any(|(n, _)| n == name);
        if taken { Err(Error::TwiceNamed { name: name.to_owned() }) } else { Ok(()) }
    }
}

pub(crate) fn nodes_of(body: &Body) -> Range<u32> {
    body.nodes.start as u32..body.nodes.end as u32
}

/// A name that is not among those known.
pub(crate) fn unknown<'a>(kind: &'static str, name: &str, known: impl Iterator<Item = &'a str>) -> Error {
    let known: Vec<String> = known.map(|name| format!("`{name}`")).collect();
    let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
    Error::UnknownName { kind, name: name.to_owned(), known }
}
