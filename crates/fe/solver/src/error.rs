//! Errors of this crate.

/// Errors of the solver.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error(
        "only {found} natural modes below {hertz} Hz were found in {iterations} iterations: take a lower \
         limit"
    )]
    Modes {
        found: usize,
        iterations: usize,
        /// Upper end of the band [Hz].
        hertz: f64,
    },

    #[error("{field} = {value}: must be {allowed}")]
    OutOfRange { field: &'static str, value: f64, allowed: &'static str },
    #[error(
        "element {element} of body `{body}` has area {area:e} m², {:e} mm²: corners must run \
         counter-clockwise around a positive area", 1e6 * .area
    )]
    BadElement {
        body: String,
        element: usize,
        /// Signed area [m²].
        area: f64,
    },
    #[error(
        "body `{body}`: its nodes and elements must follow those of the body before it and lie in the mesh"
    )]
    BadBody { body: String },
    #[error("element {element} of body `{body}` uses a node that does not belong to that body")]
    BadNode { body: String, element: usize },
    #[error(
        "node {node} of body `{body}` belongs to no element and would have no mass; remove it or make its \
         body rigid (with at least one element)"
    )]
    MasslessNode { body: String, node: usize },
    #[error(
        "static preload did not converge: after {iterations} iterations the unbalanced force is \
         {residual_n:.3e} N, allowed {allowed_n:.3e} N, largest at x = {x_mm:.3} mm, y = {y_mm:.3} mm of \
         body `{body}`; {advice}"
    )]
    NoEquilibrium {
        iterations: usize,
        /// Unbalanced force [N].
        residual_n: f64,
        /// The tolerance [N].
        allowed_n: f64,
        body: String,
        /// Where [mm].
        x_mm: f64,
        /// Where [mm].
        y_mm: f64,
        advice: &'static str,
    },
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
