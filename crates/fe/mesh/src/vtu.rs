//! Unstructured grid files (`.vtu`) that ParaView opens.
//!
//! An XML header names the arrays and gives their offsets; the values follow in one appended section, raw and
//! little-endian, each array preceded by its length in bytes (64 bits). Coordinates and exact fields keep all
//! their digits (64-bit floats); other fields are written as 32-bit floats. The body of each cell is always
//! written, as the cell array `body`, and so are the names of the bodies: each is that of a field array of
//! two numbers, the body's and its dimension, 2. That is how meshio names groups of cells; texts, which the
//! format has, too, it refuses.
//!
//! Cells are all quadrilaterals of the mesh, then all triangles; cell fields follow that order.
//!
//! Source: *VTK File Formats*, VTK User's Guide.

use std::io::Write;

use crate::{Error, Mesh};

/// A named array with one entry per node or per cell.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    name: &'a str,
    values: Values<'a>,
}

#[derive(Clone, Copy, Debug)]
enum Values<'a> {
    Scalars(&'a [f64]),
    Vectors(&'a [[f64; 3]]),
    ExactVectors(&'a [[f64; 3]]),
}

impl<'a> Field<'a> {
    /// One number per node or cell, in whatever unit.
    pub fn scalar(name: &'a str, values: &'a [f64]) -> Field<'a> {
        Field { name, values: Values::Scalars(values) }
    }

    /// Three components per node or cell; plane vectors have zero in the third.
    pub fn vector(name: &'a str, values: &'a [[f64; 3]]) -> Field<'a> {
        Field { name, values: Values::Vectors(values) }
    }

    /// As [`Field::vector`], but with all digits: for values that are read again to compute with.
    pub fn exact_vector(name: &'a str, values: &'a [[f64; 3]]) -> Field<'a> {
        Field { name, values: Values::ExactVectors(values) }
    }

    fn entries(&self) -> usize {
        match self.values {
            Values::Scalars(v) => v.len(),
            Values::Vectors(v) | Values::ExactVectors(v) => v.len(),
        }
    }

    fn check(&self, expected: usize, of: &'static str) -> Result<(), Error> {
        let found = self.entries();
        if found == expected {
            return Ok(());
        }
        Err(Error::ArrayLength { name: self.name.to_owned(), found, expected, of })
    }
}

/// Cell types of the format.
const TRIANGLE: u8 = 5;
const QUAD: u8 = 9;

/// Writes the mesh with fields of nodes and of cells.
///
/// # Errors
/// A field with another number of entries than the mesh has nodes or cells, and whatever the sink reports.
pub fn write(sink: &mut impl Write, mesh: &Mesh, nodes: &[Field], cells: &[Field]) -> Result<(), Error> {
    nodes.iter().try_for_each(|f| f.check(mesh.x.len(), "nodes"))?;
    cells.iter().try_for_each(|f| f.check(mesh.elements(), "elements"))?;
    let mut file = Appended::default();
    file.open("FieldData");
    for (number, body) in (0..).zip(&mesh.bodies) {
        file.group(&body.name, number);
    }
    file.close("FieldData");
    file.open_piece(mesh.x.len(), mesh.elements());
    file.open("PointData");
    nodes.iter().for_each(|f| file.field(f));
    file.close("PointData");
    file.open("CellData");
    file.array("body", "Int32", 1, bytes(body_of_cells(mesh), i32::to_le_bytes));
    cells.iter().for_each(|f| file.field(f));
    file.close("CellData");
    file.open("Points");
    let points = mesh.x.iter().zip(&mesh.y).flat_map(|(x, y)| [*x, *y, 0.0]);
    file.array("points", "Float64", 3, bytes(points, f64::to_le_bytes));
    file.close("Points");
    file.open("Cells");
    file.array("connectivity", "Int32", 1, bytes(connectivity(mesh), i32::to_le_bytes));
    file.array("offsets", "Int64", 1, bytes(offsets(mesh), i64::to_le_bytes));
    file.array("types", "UInt8", 1, types(mesh));
    file.close("Cells");
    file.close("Piece");
    file.write(sink)
}

/// The header, and the arrays that follow it.
#[derive(Default)]
struct Appended {
    header: String,
    arrays: Vec<Vec<u8>>,
    offset: usize,
}

impl Appended {
    fn open(&mut self, tag: &str) {
        self.header += &format!("<{tag}>\n");
    }

    fn open_piece(&mut self, nodes: usize, cells: usize) {
        self.header += &format!("<Piece NumberOfPoints=\"{nodes}\" NumberOfCells=\"{cells}\">\n");
    }

    fn close(&mut self, tag: &str) {
        self.header += &format!("</{tag}>\n");
    }

    fn field(&mut self, field: &Field) {
        match field.values {
            Values::Scalars(v) => {
                let values = v.iter().map(|x| *x as f32);
                self.array(field.name, "Float32", 1, bytes(values, f32::to_le_bytes));
            }
            Values::Vectors(v) => {
                let values = v.iter().flatten().map(|x| *x as f32);
                self.array(field.name, "Float32", 3, bytes(values, f32::to_le_bytes));
            }
            Values::ExactVectors(v) => {
                let values = v.iter().flatten().copied();
                self.array(field.name, "Float64", 3, bytes(values, f64::to_le_bytes));
            }
        }
    }

    /// The name of a body, with its number and dimension.
    fn group(&mut self, name: &str, number: i32) {
        let (name, offset) = (escaped(name), self.offset);
        self.header += &format!(
            "<DataArray type=\"Int32\" Name=\"{name}\" NumberOfTuples=\"2\" format=\"appended\" \
             offset=\"{offset}\"/>\n"
        );
        self.append(bytes([number, 2], i32::to_le_bytes));
    }

    fn array(&mut self, name: &str, kind: &str, components: usize, data: Vec<u8>) {
        let (name, offset) = (escaped(name), self.offset);
        self.header += &format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{offset}\"/>\n"
        );
        self.append(data);
    }

    fn append(&mut self, data: Vec<u8>) {
        self.offset += size_of::<u64>() + data.len();
        self.arrays.push(data);
    }

    fn write(&self, sink: &mut impl Write) -> Result<(), Error> {
        sink.write_all(
            b"<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
              byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n",
        )?;
        sink.write_all(self.header.as_bytes())?;
        sink.write_all(b"</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_")?;
        for array in &self.arrays {
            sink.write_all(&(array.len() as u64).to_le_bytes())?;
            sink.write_all(array)?;
        }
        sink.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
        Ok(())
    }
}

fn bytes<T, const N: usize>(values: impl IntoIterator<Item = T>, encode: fn(T) -> [u8; N]) -> Vec<u8> {
    values.into_iter().flat_map(encode).collect()
}

fn connectivity(mesh: &Mesh) -> impl Iterator<Item = i32> + '_ {
    let quads = mesh.quads.iter().flatten();
    quads.chain(mesh.triangles.iter().flatten()).map(|n| *n as i32)
}

/// End of each cell in the connectivity.
fn offsets(mesh: &Mesh) -> impl Iterator<Item = i64> {
    let quads = 4 * mesh.quads.len() as i64;
    let triangles = 3 * mesh.triangles.len() as i64;
    (4..=quads).step_by(4).chain((quads + 3..=quads + triangles).step_by(3))
}

fn types(mesh: &Mesh) -> Vec<u8> {
    let mut types = vec![QUAD; mesh.quads.len()];
    types.resize(mesh.elements(), TRIANGLE);
    types
}

/// Index of the body of each cell; −1 for a cell that belongs to none.
fn body_of_cells(mesh: &Mesh) -> Vec<i32> {
    let mut bodies = vec![-1; mesh.elements()];
    for (index, body) in mesh.bodies.iter().enumerate() {
        bodies[body.quads.clone()].fill(index as i32);
        let shift = mesh.quads.len();
        bodies[shift + body.triangles.start..shift + body.triangles.end].fill(index as i32);
    }
    bodies
}

/// Replaces the characters that an XML attribute cannot hold.
fn escaped(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
