//! `mesh.vtu` of a bearing of few elements, as a run writes it: rings of quadrilaterals, rollers of
//! triangles.

use std::f64::consts::TAU;
use std::path::Path;

use stribeck_store::mesh_file::REFERENCE;
use stribeck_store::run_info::MeshInfo;

/// Elements around a ring, and around a roller.
const AROUND: usize = 120;
const SLICES: usize = 8;
const ROLLERS: usize = 24;

#[derive(Default)]
struct Mesh {
    names: Vec<String>,
    nodes: Vec<[f64; 3]>,
    quads: Vec<[u32; 4]>,
    triangles: Vec<[u32; 3]>,
    body_of_quads: Vec<u32>,
    body_of_triangles: Vec<u32>,
}

fn around(n: usize, of: usize, radius: f64) -> [f64; 2] {
    let angle = TAU * n as f64 / of as f64;
    [radius * angle.cos(), radius * angle.sin()]
}

impl Mesh {
    fn node(&mut self, [x, y]: [f64; 2]) -> u32 {
        self.nodes.push([x, y, 0.0]);
        self.nodes.len() as u32 - 1
    }

    fn quad(&mut self, corners: [[f64; 2]; 4]) {
        let quad = corners.map(|corner| self.node(corner));
        self.quads.push(quad);
        self.body_of_quads.push(self.names.len() as u32 - 1);
    }

    fn ring(&mut self, name: &str, inner: f64, outer: f64) {
        self.names.push(name.to_owned());
        for n in 0..AROUND {
            let corner = |n: usize, radius: f64| around(n % AROUND, AROUND, radius);
            self.quad([corner(n, inner), corner(n, outer), corner(n + 1, outer), corner(n + 1, inner)]);
        }
    }

    fn roller(&mut self, number: usize, radius: f64, path: f64) {
        self.names.push(format!("roller {}", number + 1));
        let [x, y] = around(number, ROLLERS, path);
        for n in 0..SLICES {
            let rim = |n: usize| around(n, SLICES, radius);
            let corners = [[x, y], [x + rim(n)[0], y + rim(n)[1]], [x + rim(n + 1)[0], y + rim(n + 1)[1]]];
            let triangle = corners.map(|corner| self.node(corner));
            self.triangles.push(triangle);
            self.body_of_triangles.push(self.names.len() as u32 - 1);
        }
    }
}

fn bearing() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.ring("outer ring", 0.100, 0.110);
    mesh.ring("inner ring", 0.072, 0.082);
    mesh.names.push("adapter".to_owned());
    mesh.quad([[-0.08, 0.11], [0.08, 0.11], [0.08, 0.15], [-0.08, 0.15]]);
    (0..ROLLERS).for_each(|number| mesh.roller(number, 0.009, 0.091));
    mesh
}

/// Its counts; those of the facets are the paper's.
pub(crate) fn counts() -> MeshInfo {
    let mesh = bearing();
    MeshInfo {
        nodes: mesh.nodes.len(),
        quads: mesh.quads.len(),
        triangles: mesh.triangles.len(),
        roller_facets: 112,
        outer_facets: 1257,
        inner_facets: 1030,
    }
}

/// Writes it.
pub(crate) fn write(path: &Path) {
    let mesh = bearing();
    let positions: Vec<u8> = mesh.nodes.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let numbers = |numbers: &[u32]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let (quads, triangles) = (mesh.quads.as_flattened(), mesh.triangles.as_flattened());
    let arrays = [
        ("String", "body_names", mesh.names.iter().flat_map(|name| name.bytes().chain([0])).collect()),
        ("Float64", REFERENCE, positions.clone()),
        ("Int32", "body", numbers(&[mesh.body_of_quads, mesh.body_of_triangles].concat())),
        ("Float64", "points", positions),
        ("Int32", "connectivity", numbers(&[quads, triangles].concat())),
        ("UInt8", "types", [vec![9; mesh.quads.len()], vec![5; mesh.triangles.len()]].concat()),
    ];
    let (points, cells) = (mesh.nodes.len(), mesh.quads.len() + mesh.triangles.len());
    let mut header = format!("<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n");
    let mut data = Vec::new();
    for (kind, name, bytes) in arrays {
        header += &format!("<DataArray type=\"{kind}\" Name=\"{name}\" offset=\"{}\"/>\n", data.len());
        data.extend((bytes.len() as u64).to_le_bytes());
        data.extend(bytes);
    }
    header += "<AppendedData encoding=\"raw\">\n_";
    std::fs::write(path, [header.into_bytes(), data].concat()).expect("writable");
}
