//! Bodies whose meshes come from files: housings and rings.

use std::path::Path;

use stribeck_mesh::{
    Part, Surface,
    decks::{Deck, ReadDeck},
};
use stribeck_scene::{
    housing::{HousingScene, MeshHousingScene},
    mesh_text,
    resolved::ResolvedScene,
    scene::{DefectRing, RingMeshScene, Scene},
};

use crate::error::Error;

/// Nodes along a fit lie within this part of its radius from the surface they fit.
const LOOSE: f64 = 0.01;

/// Half of the nodes of a raceway, and all that rollers may meet, lie within this part of its radius on its
/// circle.
const ROUND: f64 = 1e-3;

/// Bodies that a message names.
const MOST_NAMED: usize = 4;

/// The mesh of a file, and the field that named it.
struct OwnMesh<'a> {
    /// Group of the scene.
    group: &'static str,
    file: &'a str,
    part: Part,
    deck: ReadDeck,
    /// Metres of a unit of length of the file.
    unit: f64,
}

impl<'a> OwnMesh<'a> {
    fn read(group: &'static str, file: &'a str, text: &str, unit_mm: f64) -> Result<Self, Error> {
        let refuse = |what: String| refused(group, file, what);
        let extension = Path::new(file).extension().and_then(|e| e.to_str()).unwrap_or_default();
        let deck = Deck::of_extension(extension)
            .ok_or_else(|| refuse("its name ends in neither `.msh` nor `.inp`".to_owned()))?;
        let bytes = mesh_text::bytes(text).map_err(refuse)?;
        let deck = deck.read_bytes(&bytes).map_err(|fault| refuse(fault.to_string()))?;
        let mut part = deck.part().map_err(|error| refuse(error.to_string()))?;
        let unit = 1e-3 * unit_mm;
        part.x.iter_mut().chain(&mut part.y).for_each(|place| *place *= unit);
        Ok(Self { group, file, part, deck, unit })
    }

    fn refuse<T>(&self, what: String) -> Result<T, Error> {
        Err(refused(self.group, self.file, what))
    }

    /// The set of that name; Abaqus takes capitals and small letters for the same.
    fn set(&self, name: &str) -> Option<&[u32]> {
        let sets = &self.deck.node_sets;
        let mut alike =
            sets.iter().filter(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, nodes)| nodes);
        let nodes = sets.get(name).or_else(|| alike.next().filter(|_| alike.next().is_none()));
        nodes.map(Vec::as_slice)
    }

    /// The boundary along the set `name`, which the field `field` asks for: its pieces, the longest first.
    fn pieces(&self, field: &str, name: &str) -> Result<Vec<Surface>, Error> {
        let Some(nodes) = self.set(name) else {
            let sets =
                self.deck.node_sets.keys().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let there = if sets.is_empty() { "none" } else { &sets };
            let about = format!("the set `{name}` ").to_lowercase();
            let why = self.deck.notes.iter().find(|note| note.to_lowercase().contains(&about));
            let why = why.map_or(String::new(), |note| format!("; {note}"));
            return self.refuse(format!(
                "it has no set of nodes `{name}`, which `{}.{field}` names; sets: {there}{why}",
                self.group
            ));
        };
        let mut pieces = self.part.boundary_along(nodes);
        pieces.sort_by_key(|piece| std::cmp::Reverse(piece.facets()));
        if pieces.is_empty() {
            return self.refuse(format!("no edge of an element lies along the set `{name}`"));
        }
        Ok(pieces)
    }

    /// The same of a boundary that goes all around; `what` says of what.
    fn closed(&self, field: &str, name: &str, what: &str) -> Result<Surface, Error> {
        let mut pieces = self.pieces(field, name)?;
        if !(pieces[0].closed && pieces.len() == 1) {
            let places = pieces.len();
            return self
                .refuse(format!("the set `{name}` is no closed {what}, but {places} pieces of boundary"));
        }
        Ok(pieces.swap_remove(0))
    }

    /// Refuses bodies that do not hang together with the one that has `surface`: nothing would hold them.
    fn in_one_piece(&self, surface: &Surface, what: &str) -> Result<(), Error> {
        let mesh = &self.deck.mesh;
        // Of nodes that elements join, the lowest number stands for all.
        let mut of: Vec<usize> = (0..mesh.x.len()).collect();
        fn lowest(of: &mut [usize], mut n: usize) -> usize {
            while of[n] != n {
                of[n] = of[of[n]];
                n = of[n];
            }
            n
        }
        let corners =
            mesh.quads.iter().map(|q| q.as_slice()).chain(mesh.triangles.iter().map(|t| t.as_slice()));
        for pair in corners.flat_map(|corners| corners.windows(2)) {
            let [a, b] = [pair[0], pair[1]].map(|n| lowest(&mut of, n as usize));
            of[a.max(b)] = a.min(b);
        }
        let held = lowest(&mut of, surface.nodes[0] as usize);
        let mut loose = Vec::new();
        for body in &mesh.bodies {
            let quads = mesh.quads[body.quads.clone()].iter().map(|q| q[0]);
            let mut first = quads.chain(mesh.triangles[body.triangles.clone()].iter().map(|t| t[0]));
            if first.any(|n| lowest(&mut of, n as usize) != held) {
                loose.push(format!("`{}`", body.name));
            }
        }
        if loose.is_empty() {
            return Ok(());
        }
        let more = loose.len().saturating_sub(MOST_NAMED);
        let further = if more > 0 { format!(" and {more} more") } else { String::new() };
        loose.truncate(MOST_NAMED);
        self.refuse(format!(
            "{}{further} hang on nothing: all their elements, or some of them, share no nodes with the body \
             of its {what}. Leave them out of the file, or join their nodes",
            loose.join(", ")
        ))
    }

    /// Distances of the nodes of a surface from the bearing's centre [m].
    fn radii(&self, surface: &Surface) -> Vec<f64> {
        surface.nodes.iter().map(|&n| libm::hypot(self.part.x[n as usize], self.part.y[n as usize])).collect()
    }

    /// The median of them, and the least; the largest where `sign` is below zero.
    fn median_and_least(&self, surface: &Surface, sign: f64) -> [f64; 2] {
        let mut radii = self.radii(surface);
        radii.sort_by(|a, b| (sign * a).total_cmp(&(sign * b)));
        [radii[radii.len() / 2], radii[0]]
    }

    fn misses<T>(&self, what: &str, fits: &str, [is, wanted]: [f64; 2]) -> Result<T, Error> {
        self.refuse(format!(
            "its {what} does not fit {fits}: a node lies {:.4} mm from the centre, {:.6} in the file, and the \
             radius there is {:.4} mm. Look at `{}.unit_mm`; the bearing's centre is the origin of the mesh",
            1e3 * is,
            is / self.unit,
            1e3 * wanted,
            self.group
        ))
    }
}

/// Whether the files of a scene's housing and rings are ones that the bearing fits; nothing else is meshed.
///
/// # Errors
/// [`Error::MeshFile`] for the first that is not.
pub fn check(scene: &ResolvedScene) -> Result<(), Error> {
    if let HousingScene::Mesh(mesh) = &scene.written.housing {
        housing(mesh, scene)?;
    }
    for (mesh, of) in [
        (&scene.written.outer_ring_mesh, DefectRing::Outer),
        (&scene.written.inner_ring_mesh, DefectRing::Inner),
    ] {
        if let Some(mesh) = mesh {
            ring(mesh, of, scene)?;
        }
    }
    Ok(())
}

/// Parts of a scene's mesh files that were ignored, in sentences that name field, file and line.
pub fn notes(scene: &Scene) -> Vec<String> {
    let housing = match &scene.housing {
        HousingScene::Mesh(mesh) => Some(("housing", &mesh.file, &mesh.text)),
        _ => None,
    };
    let rings = [("outer_ring_mesh", &scene.outer_ring_mesh), ("inner_ring_mesh", &scene.inner_ring_mesh)];
    let rings = rings.into_iter().filter_map(|(group, mesh)| Some((group, mesh.as_ref()?)));
    let files = housing.into_iter().chain(rings.map(|(group, mesh)| (group, &mesh.file, &mesh.text)));
    let notes = files.filter_map(|(group, file, text)| {
        let own = OwnMesh::read(group, file, text, 1.0).ok()?;
        Some(own.deck.notes.into_iter().map(move |note| format!("of `{group}.file` `{file}`, {note}")))
    });
    notes.flatten().collect()
}

/// A housing, with its surfaces `bore` and `loaded`.
pub(crate) fn housing(housing: &MeshHousingScene, scene: &ResolvedScene) -> Result<Part, Error> {
    let mut own = OwnMesh::read("housing", &housing.file, &housing.text, housing.unit_mm)?;
    let bore = own.closed("bore", &housing.bore, "bore")?;
    let ring = scene.outer_race_radius + scene.outer_ring_thickness;
    if let Some(&off) = own.radii(&bore).iter().find(|radius| (*radius / ring - 1.0).abs() > LOOSE) {
        return own.misses("bore", "the outer ring", [off, ring]);
    }
    let loaded = own.pieces("loaded", &housing.loaded)?.swap_remove(0);
    own.in_one_piece(&bore, "bore")?;
    own.part.surfaces.extend([("bore".to_owned(), bore), ("loaded".to_owned(), loaded)]);
    Ok(own.part)
}

/// A ring, with its surfaces `inner` and `outer`, of which one is its raceway.
pub(crate) fn ring(ring: &RingMeshScene, of: DefectRing, scene: &ResolvedScene) -> Result<Part, Error> {
    // Outwards, seen from the rollers: where the ring's material is.
    let (group, outwards, race, thickness) = match of {
        DefectRing::Outer => ("outer_ring_mesh", 1.0, scene.outer_race_radius, scene.outer_ring_thickness),
        DefectRing::Inner => ("inner_ring_mesh", -1.0, scene.inner_race_radius, scene.inner_ring_thickness),
    };
    let mut own = OwnMesh::read(group, &ring.file, &ring.text, ring.unit_mm)?;
    let raceway = own.closed("raceway", &ring.raceway, "raceway")?;
    // How much deeper in the material than its circle, as a part of its radius: half of the nodes, and those
    // nearest to the rollers.
    let [half, nearest] = own.median_and_least(&raceway, outwards);
    let deeper = |radius: f64| outwards * (radius / race - 1.0);
    if let Some(off) = [half, nearest].into_iter().find(|radius| deeper(*radius) < -ROUND) {
        return own.misses("raceway", "the one of `bearing`", [off, race]);
    }
    if deeper(half) > ROUND {
        return own.misses("raceway", "the one of `bearing`", [half, race]);
    }
    let side = if outwards > 0.0 { "back" } else { "bore" };
    let fit = own.closed("fit", &ring.fit, side)?;
    let wanted = race + outwards * thickness;
    let [half, farthest] = own.median_and_least(&fit, -outwards);
    let beyond = |radius: f64| outwards * (radius / wanted - 1.0);
    if let Some(off) = [half, farthest].into_iter().find(|radius| beyond(*radius) > LOOSE) {
        return own.misses(side, "the thickness of the ring", [off, wanted]);
    }
    if beyond(half) < -LOOSE {
        return own.misses(side, "the thickness of the ring", [half, wanted]);
    }
    own.in_one_piece(&raceway, "raceway")?;
    let names = match of {
        DefectRing::Outer => ["inner", "outer"],
        DefectRing::Inner => ["outer", "inner"],
    };
    own.part.surfaces.extend(names.map(str::to_owned).into_iter().zip([raceway, fit]));
    Ok(own.part)
}

fn refused(group: &'static str, file: &str, what: String) -> Error {
    Error::MeshFile { field: format!("{group}.file"), file: file.to_owned(), what }
}
