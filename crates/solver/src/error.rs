//! Errors of this crate.

/// Errors of the solver.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The iteration for natural modes did not come to its end.
    #[error(
        "only {found} natural modes below {hertz} Hz were found in {iterations} iterations: take a lower \
         limit"
    )]
    Modes {
        /// How many were found.
        found: usize,
        /// Iterations taken.
        iterations: usize,
        /// Upper end of the band [Hz].
        hertz: f64,
    },

    /// A number is outside its range.
    #[error("{field} = {value}: must be {allowed}")]
    OutOfRange {
        /// Name of the quantity.
        field: &'static str,
        /// The value given.
        value: f64,
        /// The values allowed, in words.
        allowed: &'static str,
    },
    /// An element has no or negative area.
    #[error(
        "element {element} of body `{body}` has area {area:e} m², {:e} mm²: corners must run \
         counter-clockwise around a positive area", 1e6 * .area
    )]
    BadElement {
        /// Body name.
        body: String,
        /// Element number within the mesh.
        element: usize,
        /// Signed area [m²].
        area: f64,
    },
    /// The ranges of a body do not follow those of the one before it, or leave the mesh.
    #[error(
        "body `{body}`: its nodes and elements must follow those of the body before it and lie in the mesh"
    )]
    BadBody {
        /// Body name.
        body: String,
    },
    /// An element uses a node of another body, or one that is not there.
    #[error("element {element} of body `{body}` uses a node that does not belong to that body")]
    BadNode {
        /// Body name.
        body: String,
        /// Element number within the mesh.
        element: usize,
    },
    /// A node carries no mass although it may move.
    #[error(
        "node {node} of body `{body}` belongs to no element and would have no mass; remove it or make its \
         body rigid (with at least one element)"
    )]
    MasslessNode {
        /// Body name.
        body: String,
        /// Node number within the mesh.
        node: usize,
    },
    /// The static preload did not find equilibrium.
    #[error(
        "static preload did not converge: after {iterations} iterations the unbalanced force is \
         {residual_n:.3e} N, allowed {allowed_n:.3e} N, largest at x = {x_mm:.3} mm, y = {y_mm:.3} mm of \
         body `{body}`; {advice}"
    )]
    NoEquilibrium {
        /// Newton iterations done.
        iterations: usize,
        /// Unbalanced force [N].
        residual_n: f64,
        /// The tolerance [N].
        allowed_n: f64,
        /// Body with the largest unbalanced force.
        body: String,
        /// Where [mm].
        x_mm: f64,
        /// Where [mm].
        y_mm: f64,
        /// Remedy.
        advice: &'static str,
    },
    /// The static stiffness matrix could not be factorised.
    #[error(
        "static preload: the stiffness matrix could not be factorised ({0}); a body is probably held by \
         nothing: check constraints and contacts"
    )]
    Factorisation(String),
}

/// Checks that `value` is finite and `ok`.
pub(crate) fn check(field: &'static str, value: f64, ok: bool, allowed: &'static str) -> Result<(), Error> {
    if value.is_finite() && ok { Ok(()) } else { Err(Error::OutOfRange { field, value, allowed }) }
}

/// Checks that a list of the user has one entry for each of `wanted` things.
pub(crate) fn check_count(
    field: &'static str,
    found: usize,
    wanted: usize,
    allowed: &'static str,
) -> Result<(), Error> {
    check(field, found as f64, found == wanted, allowed)
}
