//! The file format, read back byte by byte from the offsets in its header.

use std::process::Command;

use stribeck_mesh::{Disc, Error, Mesh, Part, Rectangle, vtu};
use stribeck_testing::{Scratch, peer::python_with, said};

fn mesh() -> Mesh {
    let disc = Disc { radius: 1.0, facets: 24, size: 0.25, rotation: 0.1 };
    let plate = Rectangle { x0: -2.0, y0: -2.0, width: 4.0, height: 1.0, columns: 8, rows: 2 };
    let mut mesh = Mesh::new();
    mesh.add("disc", &disc.part().expect("a disc"));
    mesh.add("plate", &plate.part().expect("a plate"));
    mesh
}

/// The value of an XML attribute in a line.
fn attribute<'a>(line: &'a str, name: &str) -> &'a str {
    let from = line.find(&format!("{name}=\"")).expect("the attribute") + name.len() + 2;
    &line[from..from + line[from..].find('"').expect("a closing quote")]
}

/// Type, components and bytes of a named array.
fn array(file: &[u8], name: &str) -> (String, usize, Vec<u8>) {
    let marker = b"<AppendedData encoding=\"raw\">\n_";
    let start = file.windows(marker.len()).position(|w| w == marker).expect("appended data");
    let header = std::str::from_utf8(&file[..start]).expect("a text header");
    let named = format!("Name=\"{name}\"");
    let line = header.lines().find(|l| l.contains(&named)).unwrap_or_else(|| panic!("no array {name}"));
    let offset: usize = attribute(line, "offset").parse().expect("a number");
    let at = start + marker.len() + offset;
    let len = u64::from_le_bytes(file[at..at + 8].try_into().expect("8 bytes")) as usize;
    let has_components = line.contains("NumberOfComponents");
    let components =
        if has_components { attribute(line, "NumberOfComponents").parse().expect("a number") } else { 1 };
    (attribute(line, "type").to_owned(), components, file[at + 8..at + 8 + len].to_vec())
}

fn decoded<T, const N: usize>(bytes: &[u8], decode: fn([u8; N]) -> T) -> Vec<T> {
    assert_eq!(bytes.len() % N, 0, "whole values");
    bytes.chunks_exact(N).map(|c| decode(c.try_into().expect("a whole value"))).collect()
}

#[test]
fn roundtrip_file_gives_back_the_mesh() {
    let mesh = mesh();
    let height: Vec<f64> = mesh.y.iter().map(|y| y + 0.1).collect();
    let velocity: Vec<[f64; 3]> = mesh.x.iter().zip(&mesh.y).map(|(x, y)| [-*y, *x, 0.0]).collect();
    let number: Vec<f64> = (0..mesh.elements()).map(|e| e as f64).collect();
    let exact: Vec<[f64; 3]> = velocity.iter().map(|v| v.map(|c| c / 3.0)).collect();
    let nodes = [
        vtu::Field::scalar("height <m>", &height),
        vtu::Field::vector("velocity", &velocity),
        vtu::Field::exact_vector("exact", &exact),
    ];
    let mut file = Vec::new();
    vtu::write(&mut file, &mesh, &nodes, &[vtu::Field::scalar("number", &number)]).expect("a file");

    let (kind, components, data) = array(&file, "points");
    assert_eq!((kind.as_str(), components), ("Float64", 3));
    let expected: Vec<f64> = mesh.x.iter().zip(&mesh.y).flat_map(|(x, y)| [*x, *y, 0.0]).collect();
    assert_eq!(decoded(&data, f64::from_le_bytes), expected, "coordinates keep all their digits");

    let connectivity = decoded(&array(&file, "connectivity").2, i32::from_le_bytes);
    let offsets = decoded(&array(&file, "offsets").2, i64::from_le_bytes);
    let types = array(&file, "types").2;
    assert_eq!((offsets.len(), types.len()), (mesh.elements(), mesh.elements()));
    let mut from = 0;
    for (cell, (end, kind)) in offsets.iter().zip(&types).enumerate() {
        let found: Vec<u32> = connectivity[from..*end as usize].iter().map(|n| *n as u32).collect();
        let (corners, code) = match mesh.quads.get(cell) {
            Some(quad) => (quad.to_vec(), 9),
            None => (mesh.triangles[cell - mesh.quads.len()].to_vec(), 5),
        };
        assert_eq!((found, *kind), (corners, code), "cell {cell}");
        from = *end as usize;
    }
    assert_eq!(from, connectivity.len());

    let (kind, components, data) = array(&file, "height &lt;m&gt;");
    assert_eq!((kind.as_str(), components), ("Float32", 1));
    let expected: Vec<f32> = height.iter().map(|h| *h as f32).collect();
    assert_eq!(decoded(&data, f32::from_le_bytes), expected);
    let (_, components, data) = array(&file, "velocity");
    assert_eq!(components, 3);
    let expected: Vec<f32> = velocity.iter().flatten().map(|v| *v as f32).collect();
    assert_eq!(decoded(&data, f32::from_le_bytes), expected);
    let (kind, components, data) = array(&file, "exact");
    assert_eq!((kind.as_str(), components), ("Float64", 3));
    let expected: Vec<f64> = exact.iter().flatten().copied().collect();
    assert_eq!(decoded(&data, f64::from_le_bytes), expected);
    let numbers = decoded(&array(&file, "number").2, f32::from_le_bytes);
    assert_eq!(numbers.last(), Some(&(mesh.elements() as f32 - 1.0)));

    for (name, number) in [("disc", 0), ("plate", 1)] {
        let (kind, _, data) = array(&file, name);
        assert_eq!((kind.as_str(), decoded(&data, i32::from_le_bytes)), ("Int32", vec![number, 2]), "{name}");
    }
    let bodies = decoded(&array(&file, "body").2, i32::from_le_bytes);
    for (index, body) in mesh.bodies.iter().enumerate() {
        assert!(body.quads.clone().all(|q| bodies[q] == index as i32));
        assert!(body.triangles.clone().all(|t| bodies[mesh.quads.len() + t] == index as i32));
    }
}

#[test]
fn behaves_header_counts_points_and_cells() {
    let mesh = mesh();
    let mut file = Vec::new();
    vtu::write(&mut file, &mesh, &[], &[]).expect("a file");
    let text = String::from_utf8_lossy(&file);
    let piece = text.lines().find(|l| l.starts_with("<Piece")).expect("a piece");
    assert_eq!(attribute(piece, "NumberOfPoints"), mesh.x.len().to_string());
    assert_eq!(attribute(piece, "NumberOfCells"), mesh.elements().to_string());
    assert!(file.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));
}

#[test]
fn by_hand_meshes_of_one_kind_or_none() {
    let mut triangle = Mesh::new();
    let (x, y) = (vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0]);
    triangle.add("triangle", &Part { x, y, triangles: vec![[0, 1, 2]], ..Part::default() });
    for (mesh, expected) in [(triangle, vec![3]), (Mesh::new(), vec![])] {
        let mut file = Vec::new();
        vtu::write(&mut file, &mesh, &[], &[]).expect("a file");
        assert_eq!(decoded(&array(&file, "offsets").2, i64::from_le_bytes), expected);
    }
}

#[test]
fn refuses_arrays_of_another_length_by_name() {
    let mesh = mesh();
    let short = [1.0, 2.0];
    let fields = [vtu::Field::scalar("pressure", &short)];
    let message = vtu::write(&mut Vec::new(), &mesh, &fields, &[]).expect_err("too short").to_string();
    assert!(message.contains("`pressure`") && message.contains("2 entries"), "{message}");
    let result = vtu::write(&mut Vec::new(), &mesh, &[], &fields);
    assert!(matches!(result, Err(Error::ArrayLength { of: "elements", .. })));

    let mut full: &mut [u8] = &mut [0; 10];
    assert!(matches!(vtu::write(&mut full, &mesh, &[], &[]), Err(Error::Write(_))));
}

/// `stribeck-scene` reads this very file back in its own tests: reader and writer agree on the format.
#[test]
fn golden_a_file_that_others_read() {
    let square = Rectangle { x0: 0.0, y0: 0.0, width: 1.0 / 3.0, height: 1.0 / 3.0, columns: 2, rows: 2 };
    let (x, y) = (vec![1.0, 2.0, 1.0], vec![0.0, 0.0, 1.0]);
    let triangle = Part { x, y, triangles: vec![[0, 1, 2]], ..Part::default() };
    let mut mesh = Mesh::new();
    mesh.add("square", &square.part().expect("a square"));
    mesh.add("tri < 1", &triangle);
    let reference: Vec<[f64; 3]> = mesh.x.iter().zip(&mesh.y).map(|(x, y)| [*x, *y, 0.0]).collect();
    mesh.y.iter_mut().for_each(|y| *y += 0.1);
    let mut file = Vec::new();
    let field = vtu::Field::exact_vector("reference_m", &reference);
    vtu::write(&mut file, &mesh, &[field], &[]).expect("a file");
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/golden/two_bodies.vtu");
    if std::env::var_os("STRIBECK_BLESS").is_some() {
        std::fs::write(golden, &file).expect("writable");
    }
    assert!(std::fs::read(golden).expect("readable") == file, "the format has changed");
}

/// Places, cells, bodies and their names as meshio 5.3.5 reads them, where the interpreter in STRIBECK_PYTHON
/// (or python3) has it.
#[test]
fn peer_meshio_opens_the_file() {
    let Some(python) = python_with(&["meshio"]) else { return };
    let mesh = mesh();
    let folder = Scratch::create("vtu");
    let mut file = Vec::new();
    let reference: Vec<[f64; 3]> = mesh.x.iter().zip(&mesh.y).map(|(x, y)| [*x, *y, 0.0]).collect();
    vtu::write(&mut file, &mesh, &[vtu::Field::exact_vector("reference_m", &reference)], &[])
        .expect("a file");
    std::fs::write(folder.join("a.vtu"), file).expect("it is written");
    let script = format!(
        "import meshio, numpy as np
m = meshio.read('a.vtu')
assert m.points.shape == ({}, 3) and (m.points == m.point_data['reference_m']).all()
assert abs((m.points ** 2).sum() / {:e} - 1) < 1e-14
assert [(c.type, len(c.data)) for c in m.cells] == [('quad', {}), ('triangle', {})], m
assert {{name: list(held) for name, held in m.field_data.items()}} == {{'disc': [0, 2], 'plate': [1, 2]}}, \
m.field_data
assert sorted(set(np.concatenate([b.ravel() for b in m.cell_data['body']]))) == [0, 1]
print('agreed')",
        mesh.x.len(),
        mesh.x.iter().chain(&mesh.y).map(|v| v * v).sum::<f64>(),
        mesh.quads.len(),
        mesh.triangles.len()
    );
    let output =
        Command::new(&python).current_dir(folder.path()).args(["-c", &script]).output().expect("it starts");
    assert!(output.status.success(), "{}", said(&output));
}
