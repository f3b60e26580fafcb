//! An inconsistency of a scene, before its fields are traced to file or command line.

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
    /// The one value that always helps, where the rule has one, and why; the reason may be empty.
    pub fixed: Option<[&'static str; 2]>,
}

impl Finding {
    pub(crate) fn new(message: String, remedies: Vec<Remedy>) -> Self {
        Self { message, remedies }
    }
}

impl Remedy {
    pub(crate) fn new(field: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self { field: field.into(), allowed: allowed.into(), fixed: None }
    }

    /// With the value that always helps.
    pub(crate) fn value(self, value: &'static str, note: &'static str) -> Self {
        Self { fixed: Some([value, note]), ..self }
    }
}
