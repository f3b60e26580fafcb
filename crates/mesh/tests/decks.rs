//! Meshes in files of other programs: what is written is read back, by us and by others; damaged ones get an answer.

use std::process::Command;

use stribeck_mesh::decks::Deck;
use stribeck_mesh::{Annulus, Disc, Groove, Mesh};
use stribeck_testing::{Noise, Scratch, said, says};

const ALL: [(Deck, &str); 3] = [(Deck::LsDyna, "k"), (Deck::Abaqus, "inp"), (Deck::Gmsh, "msh")];

/// A ring with a groove, of quadrilaterals, and a disc, which has triangles.
fn mesh() -> Mesh {
    let ring = Annulus {
        inner_radius: 0.02,
        outer_radius: 0.025,
        facets: 120,
        layers: 4,
        start_angle: 0.1,
        grooves: vec![Groove::rectangular(1.5, 4e-3, 0.5e-3)],
    };
    let mut mesh = Mesh::new();
    mesh.add("outer ring", &ring.part().expect("a ring"));
    mesh.add(
        "roller 1",
        &Disc { radius: 4e-3, facets: 40, size: 6e-4, rotation: 0.2 }.part().expect("a disc"),
    );
    mesh
}

#[test]
fn roundtrip_places_corners_bodies_and_sets() {
    let mesh = mesh();
    for (deck, extension) in ALL {
        assert_eq!(Deck::of_extension(extension), Some(deck));
        let read = deck.read(&deck.write(&mesh, "a bearing")).unwrap_or_else(|e| panic!("{extension}: {e}"));
        let back = &read.mesh;
        assert_eq!((back.x.len(), back.elements()), (mesh.x.len(), mesh.elements()), "{extension}");
        assert!(read.notes.is_empty(), "{extension}: {:?}", read.notes);
        for (ours, theirs) in mesh.bodies.iter().zip(&back.bodies) {
            let plain = |name: &str| name.to_uppercase().replace(' ', "_");
            assert_eq!(plain(&ours.name), plain(&theirs.name), "{extension}");
            assert_eq!(
                (ours.quads.clone(), ours.triangles.clone()),
                (theirs.quads.clone(), theirs.triangles.clone())
            );
        }
        // Numbers of nodes may differ, places may not: to the last bit, each corner where it was.
        let place = |m: &Mesh, n: u32| (m.x[n as usize].to_bits(), m.y[n as usize].to_bits());
        for (ours, theirs) in mesh.quads.iter().zip(&back.quads) {
            assert_eq!(ours.map(|n| place(&mesh, n)), theirs.map(|n| place(back, n)), "{extension}");
        }
        for (ours, theirs) in mesh.triangles.iter().zip(&back.triangles) {
            assert_eq!(ours.map(|n| place(&mesh, n)), theirs.map(|n| place(back, n)), "{extension}");
        }
        if deck != Deck::Gmsh {
            let sizes: Vec<usize> = read.node_sets.values().map(Vec::len).collect();
            assert_eq!(sizes, mesh.bodies.iter().map(|b| b.nodes.len()).collect::<Vec<_>>(), "{extension}");
        }
    }
}

#[test]
fn example_files_of_other_hands() {
    // Columns of fixed width, a triangle, comments, a card that is no mesh.
    let k = "*KEYWORD\n$ comment\n*NODE\n       1             0.0             0.0             0.0\n       2             1.0             0.0             0.0\n       3             1.0             1.0             0.0\n       4             0.0            1.d0             0.0\n*ELEMENT_SHELL\n       1       7       1       2       3       4\n       2       7       1       3       2       2\n*PART\nhousing\n         7         1\n*MAT_ELASTIC\n1\n*END\n";
    let read = Deck::LsDyna.read(k).expect("a mesh");
    assert_eq!(
        (read.mesh.quads.len(), read.mesh.triangles.len(), read.mesh.bodies[0].name.as_str()),
        (1, 1, "housing")
    );
    assert_eq!(read.notes, ["line 14: `*MAT_ELASTIC` is not read"]);
    // Clockwise, with nodes of an element on two lines.
    let inp = "*Node\n 10, 0, 0\n 20, 0, 1.\n 30, 1, 1\n 40, 1, 0\n** c\n*Element, type=CPS4, elset=Block\n 5, 10, 20,\n 30, 40\n*Nset, nset=Left\n 10, 20\n*Material, name=steel\n";
    let read = Deck::Abaqus.read(inp).expect("a mesh");
    let corners = read.mesh.quads[0].map(|n| (read.mesh.x[n as usize], read.mesh.y[n as usize]));
    assert_eq!(corners, [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]);
    assert_eq!(read.node_sets["Left"].len(), 2);
    assert_eq!(read.notes, ["line 12: `*MATERIAL` is not read"]);
}

#[test]
fn refuses_what_is_no_plane_mesh_with_its_line() {
    for (deck, text, line, says) in [
        (Deck::Abaqus, "*NODE\n1, 0, 0\n*ELEMENT, TYPE=C3D8\n", 3, "C3D8"),
        (Deck::Abaqus, "*NODE\n1, 0, x\n", 2, "`x` is no number"),
        (Deck::Abaqus, "*NODE\n1, 0, 0\n2, 1, 0\n*ELEMENT, TYPE=CPE3\n1, 1, 2, 9\n", 5, "no node 9"),
        (Deck::Abaqus, "", 1, "no plane element"),
        (Deck::LsDyna, "*ELEMENT_SOLID\n", 1, "ELEMENT_SHELL"),
        (Deck::LsDyna, "*NODE\n1,0,0,5\n", 2, "z = 5"),
        (Deck::Gmsh, "$MeshFormat\n2.2 0 8\n", 2, "msh41"),
        (Deck::Gmsh, "hello\n", 1, "Gmsh"),
        (Deck::Gmsh, "$Nodes\n1 1 1 1\n", 2, "ends in the middle"),
    ] {
        let why = deck.read(text).expect_err(text);
        assert_eq!(why.line, line, "{text}: {why}");
        assert!(why.to_string().contains(says), "{text}: {why}");
    }
}

#[test]
fn survives_damaged_files() {
    const EACH: usize = 1500;
    let mesh = mesh();
    let mut noise = Noise::new(5);
    for (deck, extension) in ALL {
        let whole = deck.write(&mesh, "a bearing").into_bytes();
        for n in 0..EACH {
            let mut bytes = whole.clone();
            let mut place = |of: usize| ((0.5 * (noise.uniform() + 1.0) * of as f64) as usize).min(of - 1);
            for k in 0..4 {
                let at = if k % 2 == 0 { place(300) } else { place(bytes.len()) };
                bytes[at] = b"0123456789-*$,. e\nx"[place(19)];
            }
            if n % 3 == 0 {
                bytes.truncate(place(whole.len()));
            }
            if let Err(why) = deck.read(&String::from_utf8_lossy(&bytes)) {
                assert!(why.line > 0 && !why.what.is_empty(), "{extension}: {why}");
            }
        }
    }
}

#[test]
fn peer_meshio_reads_the_same_mesh() {
    // meshio 5.3.5, where the interpreter in STRIBECK_PYTHON (or python3) has it. It does not read keyword files.
    let python = std::env::var("STRIBECK_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has = Command::new(&python).args(["-c", "import meshio"]).output();
    if !has.is_ok_and(|o| o.status.success()) {
        eprintln!("decks are not held against meshio: `{python}` does not have it");
        return;
    }
    let mesh = mesh();
    let folder = Scratch::create("decks");
    for (deck, extension) in &ALL[1..] {
        // It knows elements of plane stress, and none of plane strain.
        let text = deck.write(&mesh, "a bearing").replace("CPE", "CPS");
        std::fs::write(folder.join(format!("a.{extension}")), text).expect("it is written");
    }
    let sum = |m: &Mesh| m.x.iter().chain(&m.y).map(|v| v * v).sum::<f64>();
    let script = format!(
        "import meshio, numpy
for name in ['a.inp', 'a.msh']:
    m = meshio.read(name)
    assert len(m.points) == {} and abs((m.points ** 2).sum() - {:e}) < 1e-12, name
    cells = {{}}
    for block in m.cells:
        cells[block.type] = cells.get(block.type, 0) + len(block.data)
    assert cells == {{'quad': {}, 'triangle': {}}}, (name, cells)
print('agreed')",
        mesh.x.len(),
        sum(&mesh),
        mesh.quads.len(),
        mesh.triangles.len()
    );
    let output =
        Command::new(&python).current_dir(folder.path()).args(["-c", &script]).output().expect("it starts");
    says(&output, &["agreed"]);
    assert!(output.status.success(), "{}", said(&output));
}
