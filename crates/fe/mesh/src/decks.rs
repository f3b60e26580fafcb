//! Meshes in the formats of other programs: Abaqus input files and Gmsh files.
//!
//! Written are nodes [m], elements, and for each body a part or element set of its name and a set of its
//! nodes. The reader takes the same from any such file: plane quadrilaterals and triangles of first order,
//! with their sets. What is not mesh (materials, steps, loads) and elements along lines or at points are
//! passed over and named with their lines; what would change the mesh if it were passed over is refused by
//! its name.
//!
//! | format | nodes | elements | sets |
//! |---|---|---|---|
//! | Abaqus `.inp` | `*NODE`, `*PART` and `*INSTANCE` | `*ELEMENT` of CPE4, CPE4R, CPS4, S4 …, CPE3 … | `ELSET=`, `*ELSET`, `NSET=`, `*NSET` |
//! | Gmsh `.msh` 2.2, 4.0, 4.1, text or binary | `$Nodes` | `$Elements` of types 2 and 3 | `$PhysicalNames` of surfaces, and of curves for sets of nodes |
//!
//! A set of line elements is a set of their nodes. A mesh is one file: `*INCLUDE` is refused.
//!
//! [`Deck::write_model`] adds what makes the mesh a model ([`Model`]): `*MATERIAL`, `*SOLID SECTION`, `*SURFACE`
//! and `*CONTACT PAIR`; and a step of explicit dynamics ([`Step`]): gravity, loads on nodes, guided and turning
//! nodes, and the velocities of all at the start.
//!
//! [`radioss`] writes a motion that has begun for Radioss, which reads none of these.
//!
//! Sources: *Abaqus Analysis User's Guide*, input syntax; *Gmsh Reference Manual*, MSH file formats 2.2, 4.0 and
//! 4.1.

mod abaqus;
mod gathered;
mod gmsh;
mod model;
pub mod radioss;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use self::gathered::MOST_NUMBER;
pub use self::model::{ContactPair, Model, Side, Step};
use crate::smoothing::sound;
use crate::{Error, Mesh, Part};

/// A format that meshes are exchanged in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deck {
    /// Abaqus input file, `.inp`.
    Abaqus,
    /// Gmsh, `.msh`; written in version 4.1 as text.
    Gmsh,
}

impl Deck {
    /// The format that files with this extension have.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "inp" => Some(Self::Abaqus),
            "msh" => Some(Self::Gmsh),
            _ => None,
        }
    }

    /// The mesh as a file of this format; `title` is its first comment.
    pub fn write(self, mesh: &Mesh, title: &str) -> String {
        let title = title.replace(['\n', '\r'], " ");
        match self {
            Self::Abaqus => abaqus::write(mesh, &title),
            Self::Gmsh => gmsh::write(mesh, &title),
        }
    }

    /// The mesh with material, sections, the surfaces of all bodies, their contacts and a step, if there is
    /// one; Gmsh's files have no place for more than the mesh. Surfaces in no [`ContactPair`] get no contact.
    pub fn write_model(self, model: &Model<'_>, title: &str) -> String {
        let title = title.replace(['\n', '\r'], " ");
        match self {
            Self::Abaqus => abaqus::write_model(model, &title),
            Self::Gmsh => gmsh::write(model.mesh, &title),
        }
    }

    /// Reads a file of this format.
    ///
    /// # Errors
    /// [`DeckError`] with the line, for what contradicts the format, elements of other kinds, and nodes that
    /// are not there.
    pub fn read(self, text: &str) -> Result<ReadDeck, DeckError> {
        self.read_bytes(text.as_bytes())
    }

    /// Reads a file of this format, which is binary or of any encoding: anything but UTF-8 is taken for
    /// Latin-1.
    pub fn read_bytes(self, bytes: &[u8]) -> Result<ReadDeck, DeckError> {
        let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
        if self == Self::Gmsh {
            return gmsh::read(bytes);
        }
        let text = text_of(bytes);
        abaqus::read(&text)?.finish(text.lines().count())
    }
}

/// Content of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadDeck {
    /// Bodies are the parts or element sets; elements in none are in a body `rest`. Nodes that no element
    /// uses are left out.
    pub mesh: Mesh,
    /// Node sets by name, in numbers of the mesh.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Ignored parts, with their lines.
    pub notes: Vec<String>,
}

impl ReadDeck {
    /// All bodies as one part, without surfaces.
    ///
    /// # Errors
    /// When an element is inside out or has no area.
    pub fn part(&self) -> Result<Part, Error> {
        let Mesh { x, y, quads, triangles, .. } = self.mesh.clone();
        sound("mesh from a file", Part { x, y, quads, triangles, ..Part::default() })
    }
}

/// Why a file is no mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeckError {
    /// Line of the file, from 1.
    pub line: usize,
    /// Problem and remedy.
    pub what: String,
}

impl fmt::Display for DeckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.what)
    }
}

impl std::error::Error for DeckError {}

fn fault(line: usize, what: impl Into<String>) -> DeckError {
    DeckError { line, what: what.into() }
}

/// A text of any encoding that has ASCII in it. Its lines may end as those of old Macintoshes do.
fn text_of(bytes: &[u8]) -> Cow<'_, str> {
    let text: Cow<'_, str> = match std::str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect::<String>().into(),
    };
    if text.contains('\r') && !text.contains('\n') { text.replace('\r', "\n").into() } else { text }
}

/// Letters and digits of a name, in capitals, others as `_`: a name that every program accepts.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' }).collect()
}

/// A whole number in a file.
fn whole(text: &str, line: usize) -> Result<u64, DeckError> {
    let number = text.trim().parse().ok().filter(|number| *number < MOST_NUMBER);
    number.ok_or_else(|| fault(line, format!("`{}` is no whole number from 0 to 10¹²", text.trim())))
}

/// A number in a file; Fortran's exponents are understood.
fn real(text: &str, line: usize) -> Result<f64, DeckError> {
    let text = text.trim();
    if text.is_empty() {
        return Ok(0.0);
    }
    text.replace(['d', 'D'], "e").parse().map_err(|_| fault(line, format!("`{text}` is no number")))
}
