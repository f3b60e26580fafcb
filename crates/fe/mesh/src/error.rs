//! Errors of requests for a mesh.

/// Why a mesh, a report or a file could not be made.
///
/// Lengths are in metres and angles in radians, as in the fields that the messages name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error(
        "{shape}: `{field}` is {value}, but it must be a finite number above zero; check its sign and its \
         unit (metres)"
    )]
    NotPositive { shape: &'static str, field: &'static str, value: f64 },
    #[error(
        "{shape}: `{field}` is {value}, but it must be a finite number; check the calculation that gave it"
    )]
    NotFinite { shape: &'static str, field: &'static str, value: f64 },
    #[error("{shape}: `{field}` is {value}, but it must lie between {least} and {most}; {advice}")]
    Count {
        shape: &'static str,
        field: &'static str,
        value: usize,
        least: usize,
        most: usize,
        advice: &'static str,
    },
    #[error("{shape}: `{field}` is {value:.9}, but it must be {relation} {limit:.9}; {advice}")]
    OutOfRange {
        shape: &'static str,
        field: &'static str,
        value: f64,
        /// How the field must compare with the limit: `above`, `below`, `at most`.
        relation: &'static str,
        limit: f64,
        advice: &'static str,
    },
    #[error("{shape}: `{field}` does not go together with `{other}`; {advice}")]
    Conflict { shape: &'static str, field: &'static str, other: &'static str, advice: &'static str },
    #[error(
        "{shape}: element {element} stays inside out (its smallest corner area is {area:e} m²); {advice}"
    )]
    Tangled {
        shape: &'static str,
        element: usize,
        /// Smallest signed corner area [m²].
        area: f64,
        advice: &'static str,
    },
    #[error(
        "output array `{name}` has {found} entries, but the mesh has {expected} {of}; give one entry for each"
    )]
    ArrayLength {
        name: String,
        found: usize,
        expected: usize,
        /// Owner of the entries: `nodes` or `elements`.
        of: &'static str,
    },
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
