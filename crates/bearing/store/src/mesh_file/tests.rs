//! A file that the mesher's own test makes byte for byte (`crates/fe/mesh/tests/vtu.rs`), and what can happen to
//! it.

use std::io::Cursor;

use proptest::prelude::*;

use super::{Body, DATA, RunMesh};
use crate::error::Error;

/// A square of four quadrilaterals beside a triangle, lifted by 0.1 m at the start.
const TWO_BODIES: &[u8] = include_bytes!("../../../../../fixtures/golden/two_bodies.vtu");

fn read(bytes: &[u8]) -> Result<RunMesh, String> {
    RunMesh::of(&mut Cursor::new(bytes))
}

/// The file with the first `old` replaced by `new`, of the same length.
fn with(old: &[u8], new: &[u8]) -> Vec<u8> {
    assert_eq!(old.len(), new.len());
    let at = TWO_BODIES.windows(old.len()).position(|window| window == old).expect("it is there");
    [&TWO_BODIES[..at], new, &TWO_BODIES[at + old.len()..]].concat()
}

#[test]
fn invariant_a_mesh_reads_back() {
    let mesh = read(TWO_BODIES).expect("a sound file");
    assert_eq!(mesh.bodies[0], Body { name: "square".into(), quads: 0..4, triangles: 0..0 });
    assert_eq!(mesh.bodies[1], Body { name: "tri < 1".into(), quads: 4..4, triangles: 0..1 });
    assert_eq!((mesh.reference.len(), mesh.elements()), (12, 5));
    // A third has no end in binary: exact means that all of its digits are there.
    assert_eq!(mesh.reference[8], [1.0 / 3.0, 1.0 / 3.0]);
    assert_eq!(mesh.start[8], [1.0 / 3.0, 1.0 / 3.0 + 0.1]);
    assert_eq!(mesh.triangles, [[9, 10, 11]]);
    let corners: Vec<&[u32]> = mesh.elements_of(&mesh.bodies[0]).collect();
    assert_eq!(corners, [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]]);
}

/// Names of bodies as versions before wrote them, as texts.
#[test]
fn roundtrip_names_in_texts() {
    let texts = include_bytes!("../../../../../fixtures/golden/two_bodies_texts.vtu");
    assert_eq!(read(texts), read(TWO_BODIES));
}

#[test]
fn invariant_damage_is_named() {
    for (bytes, words) in [
        (with(b"reference_m", b"reference_x"), "no `reference_m`: a version"),
        (with(b"Points=\"12\"", b"Points=\"13\""), "`points` has 288 bytes"),
        (with(b"Points=\"12\"", b"Points=\"-2\""), "`NumberOfPoints` of at most"),
        (with(b"Cells=\"5\"", b"Cells=\"6\""), "`types` has 5 bytes"),
        (with(b"Float64\" Name=\"points", b"Float32\" Name=\"points"), "describe `points`"),
        (with(&[9, 9, 9, 9, 5], &[9, 5, 9, 9, 5]), "quadrilaterals and then triangles"),
        (
            with(&[9, 0, 0, 0, 10, 0, 0, 0, 11], &[9, 0, 0, 0, 10, 0, 0, 0, 99]),
            "the node 99, and there are 12",
        ),
        (with(&(1.0_f64 / 3.0).to_le_bytes(), &f64::NAN.to_le_bytes()), "at NaN m"),
        (with(b"raw\">\n_", b"raw\">\n-"), "no appended data"),
        (with(b"<Piece", b"<piece"), "`NumberOfPoints`"),
        (with(&[8, 0, 0, 0, 0, 0, 0, 0, 0], &[8, 0, 0, 0, 0, 0, 0, 0, 7]), "is not number 0"),
        (with(b"</FieldData>", b"</fieldData>"), "names no bodies"),
        (TWO_BODIES[..TWO_BODIES.len() - 80].to_vec(), "ends before"),
        (Vec::new(), "no appended data"),
    ] {
        let message = read(&bytes).expect_err(words);
        assert!(message.contains(words), "{message} instead of {words}");
    }
}

#[test]
fn invariant_claims_beyond_the_file_take_no_memory() {
    // 50 million nodes are allowed; an array of as many bytes as they need is not in the file.
    let header = "<Piece NumberOfPoints=\"50000000\" NumberOfCells=\"1\">\n\
                  <DataArray type=\"String\" Name=\"body_names\" offset=\"0\"/>\n\
                  <DataArray type=\"Float64\" Name=\"points\" offset=\"10\"/>\n";
    let names = [&2_u64.to_le_bytes()[..], b"a\0"].concat();
    let bytes = [header.as_bytes(), DATA, &names, &1_200_000_000_u64.to_le_bytes()].concat();
    assert_eq!(read(&bytes), Err("it ends before `points` does".to_owned()));
}

#[test]
fn invariant_a_file_that_is_none_is_refused_with_its_path() {
    let folder = std::env::temp_dir();
    let error = RunMesh::read(&folder).expect_err("a folder").to_string();
    assert!(error.contains(&*folder.to_string_lossy()), "{error}");
    let missing = RunMesh::read(folder.join("stribeck-no-such-mesh.vtu")).expect_err("missing");
    assert!(matches!(missing, Error::Io { action: "read", .. }));
}

proptest! {
    /// Whatever bytes change, there is a mesh whose numbers fit together, or words.
    #[test]
    fn invariant_no_damage_is_a_panic(changes in prop::collection::vec((0..TWO_BODIES.len(), any::<u8>()), 1..20),
                                      keep in 0..=TWO_BODIES.len()) {
        let mut bytes = TWO_BODIES.to_vec();
        for (at, value) in changes {
            bytes[at] = value;
        }
        bytes.truncate(keep.max(TWO_BODIES.len() / 2));
        if let Ok(mesh) = read(&bytes) {
            for body in &mesh.bodies {
                for corner in mesh.elements_of(body).flatten() {
                    prop_assert!((*corner as usize) < mesh.reference.len());
                }
            }
        }
    }
}
