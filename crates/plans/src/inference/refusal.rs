//! Errors of an inference's file, as those of scenes.

use stribeck_scene::scene_file::Kind;

/// The file of an inference.
pub(super) const INFERENCE: Kind = Kind {
    noun: "an inference",
    example: "an inference has `name`, `unknowns` and `targets`, and may have `scene`, `set`, `seed`, \
        `starts` and `budget`; fixtures/infer/quick.ron is one",
    for_fields_of_scenes: Some(
        "a field of the scene stands in `set: [\"{}=…\"]`, or in `unknowns` where it is not known",
    ),
};

/// A file to look at.
pub(super) const FILE: &str = "fixtures/infer/quick.ron";
