//! An inconsistency of a scene, before its fields are traced to file or command line.

use super::wording::number;

/// Values that do not go together, or one that is outside its range.
#[derive(Debug, Clone)]
pub(crate) struct Finding {
    /// Message, with the values.
    pub message: String,
    /// The fields involved, of which one must change; the likeliest culprit first.
    pub remedies: Vec<Remedy>,
}

/// A remedy by one field, while the others stay.
#[derive(Debug, Clone)]
pub(crate) struct Remedy {
    /// Dotted path of the field.
    pub field: String,
    /// Allowed values.
    pub allowed: String,
    /// Values to propose, the best first. They are tried before they are shown, so they may be guesses.
    pub values: Vec<Proposal>,
}

/// A value that a field may take.
#[derive(Debug, Clone)]
pub(crate) struct Proposal {
    /// The value as RON.
    pub value: String,
    /// Why this one; may be empty.
    pub note: String,
}

impl Proposal {
    pub(crate) fn new(value: impl Into<String>, note: &str) -> Self {
        Self { value: value.into(), note: note.to_owned() }
    }
}

impl Finding {
    pub(crate) fn new(message: String, remedies: Vec<Remedy>) -> Self {
        Self { message, remedies }
    }

    /// Whether two findings are about the same fields.
    pub(crate) fn is_about_the_same_as(&self, other: &Self) -> bool {
        let fields = |finding: &Self| finding.remedies.iter().map(|r| r.field.clone()).collect::<Vec<_>>();
        fields(self) == fields(other)
    }
}

impl Remedy {
    pub(crate) fn new(field: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { field: field.into(), allowed: allowed.into(), values: Vec::new() }
    }

    /// Adds a number to propose, unless there is none.
    pub(crate) fn number(self, value: f64, note: &str) -> Self {
        if value.is_finite() { self.value(number(value), note) } else { self }
    }

    /// Adds a value to propose.
    pub(crate) fn value(mut self, value: impl Into<String>, note: &str) -> Self {
        self.values.push(Proposal::new(value, note));
        self
    }
}
