//! The mesh of a run, read back from its `mesh.vtu`: bodies by name, positions of their nodes free of stress
//! and at the start of the run, and their elements. So a run is drawn without meshing again.
//!
//! `mesh.vtu` is a file for ParaView as well (VTK's unstructured grid, appended raw data). It is read as this
//! program writes it: an XML header of one tag a line, then the arrays, little-endian, each after its length
//! in 64 bits.
//!
//! | array | type | what |
//! |---|---|---|
//! | in `FieldData`, one for each body, called as it | i32, i32 | number of the body, and its dimension, 2 |
//! | `points` | f64 × 3 a node | positions when the run starts, under preload [m] |
//! | [`reference_m`](REFERENCE) | f64 × 3 a node | positions free of stress [m] |
//! | `types`, `connectivity` | u8, i32 | cells: quadrilaterals (9) first, then triangles (5), and their nodes |
//! | `body` | i32 a cell | the body that it belongs to |
//!
//! Files with the names in one array `body_names` of zero-terminated texts are read, too.
//!
//! A reduced run has rings and housing in their modes only: the file has them at the preload of the
//! reduction, with rollers symmetrical about the defect, which serves all starts. Rollers and cage are at
//! their positions at the start.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use crate::error::Error;

/// Name of the array that holds the positions free of stress: displacements of [`frames`](crate::frames)
/// count from these, and positions under preload less a displacement would have other last digits.
pub const REFERENCE: &str = "reference_m";

/// Longest header that is read.
const MAX_HEADER: u64 = 1 << 16;
/// End of the header.
const DATA: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
/// More nodes or cells than any run can have; a scene of 20 million elements is refused.
const MAX_COUNT: usize = 50_000_000;
/// Longest list of names that is read [bytes].
const MAX_NAMES: usize = 1 << 20;
/// Cell types of the format.
const QUAD: u8 = 9;
const TRIANGLE: u8 = 5;

/// The mesh of a run. Nodes have the numbers that frames use; elements are counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct RunMesh {
    /// The bodies, in the order of the file.
    pub bodies: Vec<Body>,
    /// Positions of the nodes free of stress [m].
    pub reference: Vec<[f64; 2]>,
    /// Their positions when the run starts, under preload [m].
    pub start: Vec<[f64; 2]>,
    /// Corners of the quadrilaterals.
    pub quads: Vec<[u32; 4]>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
}

/// Where the elements of one body lie in a [`RunMesh`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Body {
    /// Its name: `outer ring`, `inner ring`, `adapter`, `roller 1` …, `cage`.
    pub name: String,
    /// Its quadrilaterals.
    pub quads: Range<usize>,
    /// Its triangles.
    pub triangles: Range<usize>,
}

impl RunMesh {
    /// Reads the mesh at `path`. Memory is bounded by the size of the file, and by a largest mesh.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the file cannot be read; [`Error::Mesh`] when it is damaged, or was written by a
    /// version that did not keep the positions free of stress.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let mut file = open(path).map_err(|source| Error::Io {
            action: "read",
            path: path.to_owned(),
            kept: "A run writes its mesh as it starts; what else it holds can be read without".to_owned(),
            source,
        })?;
        Self::of(&mut file).map_err(|message| Error::Mesh { path: path.to_owned(), message })
    }

    fn of(file: &mut (impl Read + Seek)) -> Result<Self, String> {
        let mut arrays = Arrays::of(file)?;
        let (nodes, cells) = (arrays.count("NumberOfPoints")?, arrays.count("NumberOfCells")?);
        let names = arrays.body_names()?;
        let start = positions(&arrays.bytes("points", "Float64", Size::Exactly(24 * nodes))?)?;
        let reference = positions(&arrays.bytes(REFERENCE, "Float64", Size::Exactly(24 * nodes))?)?;

        let types = arrays.bytes("types", "UInt8", Size::Exactly(cells))?;
        let split = types.iter().position(|kind| *kind != QUAD).unwrap_or(cells);
        if types[split..].iter().any(|kind| *kind != TRIANGLE) {
            return Err("its cells are not quadrilaterals and then triangles".to_owned());
        }
        let corners = 4 * split + 3 * (cells - split);
        let connectivity = numbers(&arrays.bytes("connectivity", "Int32", Size::Exactly(4 * corners))?);
        if let Some(node) = connectivity.iter().find(|node| **node as usize >= nodes) {
            return Err(format!("an element has the node {node}, and there are {nodes}"));
        }
        let (quads, triangles) = connectivity.split_at(4 * split);
        let bodies = numbers(&arrays.bytes("body", "Int32", Size::Exactly(4 * cells))?);
        Ok(Self {
            bodies: split_by_body(names, &bodies[..split], &bodies[split..])?,
            reference,
            start,
            quads: quads.as_chunks().0.to_vec(),
            triangles: triangles.as_chunks().0.to_vec(),
        })
    }

    /// Number of elements of both kinds.
    pub fn elements(&self) -> usize {
        self.quads.len() + self.triangles.len()
    }

    /// Corners of the elements of one body, quadrilaterals first.
    pub fn elements_of(&self, body: &Body) -> impl Iterator<Item = &[u32]> {
        let quads = self.quads[body.quads.clone()].iter().map(|quad| quad.as_slice());
        quads.chain(self.triangles[body.triangles.clone()].iter().map(|triangle| triangle.as_slice()))
    }
}

/// A regular file: reading a pipe or device may never end.
fn open(path: &Path) -> std::io::Result<BufReader<File>> {
    let file = File::open(path)?;
    if !file.metadata()?.is_file() {
        return Err(std::io::Error::other("it is not a regular file"));
    }
    Ok(BufReader::new(file))
}

/// How long an array must be [bytes].
#[derive(Clone, Copy)]
enum Size {
    Exactly(usize),
    AtMost(usize),
}

struct Arrays<'a, F> {
    file: &'a mut F,
    header: String,
    /// Length of the file, and where the arrays begin in it [bytes].
    length: u64,
    data: u64,
}

impl<'a, F: Read + Seek> Arrays<'a, F> {
    fn of(file: &'a mut F) -> Result<Self, String> {
        let length = file.seek(SeekFrom::End(0)).map_err(refused)?;
        file.rewind().map_err(refused)?;
        let mut start = Vec::new();
        file.take(MAX_HEADER).read_to_end(&mut start).map_err(refused)?;
        let end = start.windows(DATA.len()).position(|window| window == DATA);
        let end = end.ok_or("it has no appended data as a run writes them")?;
        start.truncate(end);
        let header = String::from_utf8(start).map_err(|_| "its header is not text")?;
        Ok(Self { file, header, length, data: (end + DATA.len()) as u64 })
    }

    /// One of the counts of the only piece.
    fn count(&self, name: &str) -> Result<usize, String> {
        let piece = self.header.lines().find(|line| line.starts_with("<Piece"));
        let count = piece.and_then(|line| attribute(line, name)).and_then(|value| value.parse().ok());
        count
            .filter(|count| *count <= MAX_COUNT)
            .ok_or(format!("its header has no `{name}` of at most {MAX_COUNT}"))
    }

    fn body_names(&mut self) -> Result<Vec<String>, String> {
        if self.header.contains(" Name=\"body_names\"") {
            return names(&self.bytes("body_names", "String", Size::AtMost(MAX_NAMES))?);
        }
        let fields =
            self.header.split_once("<FieldData>").and_then(|(_, rest)| rest.split_once("</FieldData>"));
        let (fields, _) = fields.ok_or("it names no bodies")?;
        let escaped: Vec<String> =
            fields.lines().filter_map(|line| attribute(line, "Name")).map(str::to_owned).collect();
        let mut names = Vec::new();
        for (number, name) in escaped.iter().enumerate() {
            let held = numbers(&self.bytes(name, "Int32", Size::Exactly(8))?);
            if held.first().copied() != u32::try_from(number).ok() {
                return Err(format!("its body `{name}` is not number {number}, and is the next one"));
            }
            names.push(unescaped(name));
        }
        if names.is_empty() { Err("it names no bodies".to_owned()) } else { Ok(names) }
    }

    fn bytes(&mut self, name: &str, kind: &str, size: Size) -> Result<Vec<u8>, String> {
        let line = self.header.lines().find(|line| attribute(line, "Name") == Some(name)).ok_or(format!(
            "it has no `{name}`: a version of the program that did not keep it has written it. Repeat the run"
        ))?;
        let offset = attribute(line, "offset").and_then(|value| value.parse::<u64>().ok());
        let at = offset.and_then(|offset| self.data.checked_add(offset));
        let (Some(at), true) = (at, attribute(line, "type") == Some(kind)) else {
            return Err(format!("its header does not describe `{name}` as a run does"));
        };
        let cut = || format!("it ends before `{name}` does");
        let mut length = [0; 8];
        self.file.seek(SeekFrom::Start(at)).map_err(refused)?;
        self.file.read_exact(&mut length).map_err(|_| cut())?;
        let length = u64::from_le_bytes(length);
        let fits = match size {
            Size::Exactly(bytes) => length == bytes as u64,
            Size::AtMost(bytes) => length <= bytes as u64,
        };
        if !fits {
            return Err(format!("`{name}` has {length} bytes, which does not fit its counts"));
        }
        if length > self.length.saturating_sub(at) {
            return Err(cut());
        }
        let mut bytes = vec![0; length as usize];
        self.file.read_exact(&mut bytes).map_err(|_| cut())?;
        Ok(bytes)
    }
}

fn refused(why: std::io::Error) -> String {
    format!("it cannot be read: {why}")
}

/// The value of an attribute of the tag in a line.
fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = line.split_once(&format!(" {name}=\""))?;
    Some(rest.split_once('"')?.0)
}

/// A name without the escapes of an XML attribute.
fn unescaped(name: &str) -> String {
    name.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}

fn names(bytes: &[u8]) -> Result<Vec<String>, String> {
    let Some((0, texts)) = bytes.split_last() else {
        return Err("it names no bodies".to_owned());
    };
    let name =
        |text: &[u8]| String::from_utf8(text.to_vec()).map_err(|_| "a body's name is no text".to_owned());
    texts.split(|byte| *byte == 0).map(name).collect()
}

/// The plane positions of triples of doubles.
fn positions(bytes: &[u8]) -> Result<Vec<[f64; 2]>, String> {
    let values: Vec<f64> = bytes.as_chunks().0.iter().map(|value| f64::from_le_bytes(*value)).collect();
    if let Some(bad) = values.iter().find(|value| !value.is_finite()) {
        return Err(format!("a node is at {bad} m"));
    }
    Ok(values.as_chunks::<3>().0.iter().map(|[x, y, _]| [*x, *y]).collect())
}

fn numbers(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|value| u32::from_le_bytes(*value)).collect()
}

/// Where each body lies, from the number of the body of each quadrilateral and of each triangle.
fn split_by_body(names: Vec<String>, quads: &[u32], triangles: &[u32]) -> Result<Vec<Body>, String> {
    for cells in [quads, triangles] {
        if !cells.is_sorted() || cells.last().is_some_and(|last| *last as usize >= names.len()) {
            return Err(format!("its cells are not those of {} bodies, one after another", names.len()));
        }
    }
    let range = |cells: &[u32], body: usize| {
        let end = |below: usize| cells.partition_point(|number| (*number as usize) < below);
        end(body)..end(body + 1)
    };
    let body = |(n, name)| Body { name, quads: range(quads, n), triangles: range(triangles, n) };
    Ok(names.into_iter().enumerate().map(body).collect())
}

#[cfg(test)]
mod tests;
