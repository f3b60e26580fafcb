//! Files of meshes as other programs write them: each dialect says the same small mesh, and is read as the
//! same.
//!
//! ```text
//!  4 ─── 5 ─── 6      y = 1
//!  │  1  │  2  │
//!  1 ─── 2 ─── 3      y = 0
//! x=0   1     2
//! ```
//!
//! Two squares, `steel`; nodes 1, 2, 3 are the set `raceway`, nodes 4, 5, 6 the set `fit`.

mod abaqus;
mod gmsh;

use std::process::Command;

use stribeck_mesh::decks::{Deck, ReadDeck};
use stribeck_testing::{Scratch, peer::python_with, said};

const NODES: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]];

/// The nodes and elements of an Abaqus file.
const INP: &str = "*NODE\n1, 0., 0., 0.\n2, 1., 0.\n3, 2., 0.\n4, 0., 1.\n5, 1., 1.\n6, 2., 1.\n\
                   *ELEMENT, TYPE=CPE4, ELSET=steel\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n";
const INP_SETS: &str = "*NSET, NSET=raceway\n1, 2, 3\n*NSET, NSET=fit\n4, 5, 6\n";

/// Holds a mesh against the drawing above; elements may be in any body where `body` is empty.
fn check(name: &str, deck: Deck, bytes: &[u8], body: &str) -> ReadDeck {
    let read = deck.read_bytes(bytes).unwrap_or_else(|why| panic!("{name}: {why}"));
    let place = |n: u32| [read.mesh.x[n as usize], read.mesh.y[n as usize]];
    let quads: Vec<[[f64; 2]; 4]> = read.mesh.quads.iter().map(|quad| quad.map(place)).collect();
    let expected = [[0, 1, 4, 3], [1, 2, 5, 4]].map(|quad| quad.map(|n: usize| NODES[n]));
    assert_eq!(quads, expected, "{name}");
    assert_eq!((read.mesh.x.len(), read.mesh.triangles.len()), (6, 0), "{name}");
    for (set, expected) in [("raceway", &NODES[..3]), ("fit", &NODES[3..])] {
        let nodes =
            read.node_sets.get(set).unwrap_or_else(|| panic!("{name}: no {set} in {:?}", read.node_sets));
        let mut places: Vec<[f64; 2]> = nodes.iter().map(|&n| place(n)).collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(places, expected, "{name}: {set}");
    }
    let bodies: Vec<&str> = read.mesh.bodies.iter().map(|body| body.name.as_str()).collect();
    assert!(body.is_empty() || bodies == [body], "{name}: {bodies:?}");
    read
}

/// A set with members that are not there is passed over and named. meshio writes one such into every file
/// that it has from Gmsh.
#[test]
fn issue_sets_that_name_what_is_not_there() {
    let text = format!(
        "{INP}{INP_SETS}*ELSET, ELSET=gmsh:bounding_entities\n3, -2\n*NSET, NSET=a\nb\n*NSET, NSET=b\na\n"
    );
    let read = check("meshio", Deck::Abaqus, text.as_bytes(), "steel");
    assert_eq!(read.notes.len(), 3, "{:?}", read.notes);
    assert!(
        read.notes[2].contains("`gmsh:bounding_entities` is passed over: there is no set of elements `-2`"),
        "{:?}",
        read.notes
    );
    assert!(
        read.notes[0].contains("the set `a` is passed over: sets lie within each other more than"),
        "{:?}",
        read.notes
    );
}

/// The same mesh as meshio 5.3.5 writes it, where the interpreter in STRIBECK_PYTHON (or python3) has it.
#[test]
fn peer_meshio_writes_every_dialect() {
    let Some(python) = python_with(&["meshio"]) else { return };
    let folder = Scratch::create("dialects");
    let script = "import meshio, numpy as np
points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]], float)
cells = [('line', np.array([[0, 1], [1, 2]])), ('line', np.array([[3, 4], [4, 5]])), \
('quad', np.array([[0, 1, 4, 3], [1, 2, 5, 4]]))]
none = np.array([], int)
sets = dict(point_sets={'raceway': np.arange(3), 'fit': np.arange(3, 6)}, \
cell_sets={'steel': [none, none, np.arange(2)], 'curve': [np.arange(2), none, none]})
meshio.Mesh(points, cells, **sets).write('a.inp')
groups = dict(field_data={'raceway': np.array([4, 1]), 'fit': np.array([5, 1]), 'steel': np.array([1, 2])},
              cell_data={'gmsh:physical': [np.array([4, 4]), np.array([5, 5]), np.array([1, 1])], \
              'gmsh:geometrical': [np.array([1, 1]), np.array([2, 2]), np.array([1, 1])]},
              point_data={'gmsh:dim_tags': np.array([[1, 1]] * 3 + [[1, 2]] * 3)})
mesh = meshio.Mesh(points, cells, **groups)
for name in ['gmsh22', 'gmsh']:
    for binary in [False, True]:
        meshio.write(f'{name}_{binary}.msh', mesh, file_format=name, binary=binary)
print('written')";
    let output =
        Command::new(&python).current_dir(folder.path()).args(["-c", script]).output().expect("it starts");
    assert!(output.status.success(), "{}", said(&output));
    for (name, deck, body) in [
        ("a.inp", Deck::Abaqus, "steel"),
        ("gmsh22_False.msh", Deck::Gmsh, "steel"),
        ("gmsh22_True.msh", Deck::Gmsh, "steel"),
        // It writes the groups of curves into version 4.1, and none of surfaces that have no nodes of their
        // own.
        ("gmsh_False.msh", Deck::Gmsh, "surface 1"),
        ("gmsh_True.msh", Deck::Gmsh, "surface 1"),
    ] {
        check(name, deck, &std::fs::read(folder.join(name)).expect("it is there"), body);
    }
}
