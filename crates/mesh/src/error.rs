//! Errors of requests for a mesh.

/// Why a mesh, a report or a file could not be made.
///
/// Lengths are in metres and angles in radians, as in the fields that the messages name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A dimension is zero, negative, infinite or not a number.
    #[error(
        "{shape}: `{field}` is {value}, but it must be a finite number above zero; check its sign and its \
         unit (metres)"
    )]
    NotPositive {
        /// The requested shape.
        shape: &'static str,
        /// The field that is wrong.
        field: &'static str,
        /// The field's value.
        value: f64,
    },
    /// A coordinate or an angle is infinite or not a number.
    #[error(
        "{shape}: `{field}` is {value}, but it must be a finite number; check the calculation that gave it"
    )]
    NotFinite {
        /// The requested shape.
        shape: &'static str,
        /// The field that is wrong.
        field: &'static str,
        /// The field's value.
        value: f64,
    },
    /// A count is too small or too large to make the shape.
    #[error("{shape}: `{field}` is {value}, but it must lie between {least} and {most}; {advice}")]
    Count {
        /// The requested shape.
        shape: &'static str,
        /// The field that is wrong.
        field: &'static str,
        /// The field's value.
        value: usize,
        /// Smallest count that works.
        least: usize,
        /// Largest count that works.
        most: usize,
        /// Remedy.
        advice: &'static str,
    },
    /// A dimension does not go together with the others.
    #[error("{shape}: `{field}` is {value:.9}, but it must be {relation} {limit:.9}; {advice}")]
    OutOfRange {
        /// The requested shape.
        shape: &'static str,
        /// The field that is wrong.
        field: &'static str,
        /// The field's value.
        value: f64,
        /// How the field must compare with the limit: `above`, `below`, `at most`.
        relation: &'static str,
        /// The limit.
        limit: f64,
        /// Remedy.
        advice: &'static str,
    },
    /// Two fields that exclude each other.
    #[error("{shape}: `{field}` does not go together with `{other}`; {advice}")]
    Conflict {
        /// The requested shape.
        shape: &'static str,
        /// One field.
        field: &'static str,
        /// The other field, with its value.
        other: &'static str,
        /// Remedy.
        advice: &'static str,
    },
    /// No arrangement of the nodes was found in which every element has a positive Jacobian.
    #[error(
        "{shape}: element {element} stays inside out (its smallest corner area is {area:e} m²); {advice}"
    )]
    Tangled {
        /// The requested shape.
        shape: &'static str,
        /// The element, quadrilaterals first.
        element: usize,
        /// Smallest signed corner area [m²].
        area: f64,
        /// Remedy.
        advice: &'static str,
    },
    /// An array of output data does not fit the mesh.
    #[error(
        "output array `{name}` has {found} entries, but the mesh has {expected} {of}; give one entry for each"
    )]
    ArrayLength {
        /// Name of the array.
        name: String,
        /// Entries given.
        found: usize,
        /// Entries needed.
        expected: usize,
        /// Owner of the entries: `nodes` or `elements`.
        of: &'static str,
    },
    /// The sink refused the file.
    #[error(
        "the mesh file could not be written: {0}; check the free space and the permissions of its folder"
    )]
    Write(#[from] std::io::Error),
}

pub(crate) fn positive(shape: &'static str, field: &'static str, value: f64) -> Result<(), Error> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(Error::NotPositive { shape, field, value }) }
}

pub(crate) fn finite(shape: &'static str, field: &'static str, value: f64) -> Result<(), Error> {
    if value.is_finite() { Ok(()) } else { Err(Error::NotFinite { shape, field, value }) }
}

/// Largest number of facets, rows or columns: beyond it a mesh would not fit the memory of any machine.
pub(crate) const MOST: usize = 1_000_000;

pub(crate) fn count(
    shape: &'static str,
    field: &'static str,
    value: usize,
    least: usize,
    advice: &'static str,
) -> Result<(), Error> {
    if (least..=MOST).contains(&value) {
        Ok(())
    } else {
        Err(Error::Count { shape, field, value, least, most: MOST, advice })
    }
}

/// Largest number of elements in a part, so that node numbers fit 32 bits with room to spare.
const MOST_ELEMENTS: usize = 500_000_000;

/// Refuses a structured part that has too many elements.
pub(crate) fn elements(
    shape: &'static str,
    field: &'static str,
    rows: usize,
    columns: usize,
) -> Result<(), Error> {
    let most = MOST_ELEMENTS / columns.max(1);
    if rows <= most {
        Ok(())
    } else {
        Err(Error::Count { shape, field, value: rows, least: 1, most, advice: "use a coarser mesh" })
    }
}
