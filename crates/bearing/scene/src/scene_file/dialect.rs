//! The text of a complete scene, and its identity.

use crate::fields::tree::{Content, Node};
use crate::fields::value::Value;
use crate::fields::{Field, Group};
use crate::scene::Scene;

impl Scene {
    /// The complete scene, every default included, as a scene file that reads back to an equal scene.
    pub fn to_ron(&self) -> String {
        self.write().to_ron(Self::SHAPE, &Group::omits)
    }

    /// Name of the scene's values: FNV-1a, 64 bits, of all values that have an effect, 16 hexadecimal digits.
    ///
    /// Two files with the same values have the same hash, whatever their comments, spellings and omitted
    /// defaults. The table of fields marks those that came after the first scenes: where such a field has the
    /// value that leaves a scene as it was before, it does not count, so that runs and checkpoints stay.
    pub fn hash(&self) -> String {
        const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
        const PRIME: u64 = 0x0000_0100_0000_01b3;
        let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(PRIME);
        let without_effect = |group: &Group, field: &Field, node: &Node| {
            field.before.is_some_and(|before| is_written(node, before)) || group.omits(field, node)
        };
        let values = self.write().to_ron(Self::SHAPE, &without_effect);
        format!("{:016x}", values.bytes().fold(OFFSET_BASIS, fold))
    }
}

/// Whether a value is written so.
fn is_written(node: &Node, text: &str) -> bool {
    match &node.content {
        Content::Atom(atom) => atom == text,
        Content::List(items) => items.is_empty() && text == "[]",
        _ => false,
    }
}
