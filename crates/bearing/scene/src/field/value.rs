//! Values that a scene is made of: what is written for them, and how they are read and written.

use super::tree::{Content, Node};
use super::{Shape, Word, Words};

/// A value of a scene.
pub trait Value: Sized {
    /// What is written for it.
    const SHAPE: Shape;
    /// The same for a shape around it.
    const INNER: &'static Shape = &Self::SHAPE;

    /// Reads it; `None` where something else is written.
    fn read(node: &Node) -> Option<Self>;

    /// Writes it, with all its fields.
    fn write(&self) -> Node;
}

/// A number or a text by the rules of RON.
fn parsed<T: serde::de::DeserializeOwned>(node: &Node) -> Option<T> {
    match &node.content {
        Content::Atom(text) => ron::from_str(text).ok(),
        _ => None,
    }
}

/// Values that are one word.
macro_rules! words {
    ($($type:ty, $shape:expr, $form:literal;)*) => {$(
        impl Value for $type {
            const SHAPE: Shape = $shape;

            fn read(node: &Node) -> Option<Self> {
                parsed(node)
            }

            fn write(&self) -> Node {
                Node::atom(format!($form, self))
            }
        }
    )*};
}

words! {
    f64, Shape::Number, "{:?}";
    usize, Shape::Count, "{}";
    u64, Shape::Count, "{}";
    bool, Shape::Words(&YES_OR_NO), "{}";
}

const YES_OR_NO: Words = Words {
    about: &["Yes or no."],
    words: &[
        Word { word: "false", about: &["No."], inside: None },
        Word { word: "true", about: &["Yes."], inside: None },
    ],
};

impl Value for String {
    const SHAPE: Shape = Shape::Text;

    fn read(node: &Node) -> Option<Self> {
        // RON reads a bare word as a text, too.
        parsed(node).filter(|_| node.is_quoted())
    }

    fn write(&self) -> Node {
        let escaped: String = self.chars().flat_map(char::escape_debug).collect();
        Node::atom(format!("\"{escaped}\""))
    }
}

impl Value for (f64, f64) {
    const SHAPE: Shape = Shape::Pair;

    fn read(node: &Node) -> Option<Self> {
        match &node.content {
            Content::Tuple(items) => match items.as_slice() {
                [a, b] => Some((f64::read(a)?, f64::read(b)?)),
                _ => None,
            },
            _ => None,
        }
    }

    fn write(&self) -> Node {
        Node::new(Content::Tuple(vec![self.0.write(), self.1.write()]))
    }
}

impl<T: Value> Value for Option<T> {
    const SHAPE: Shape = Shape::Optional(T::INNER);

    fn read(node: &Node) -> Option<Self> {
        if node.is_none() { Some(None) } else { T::read(node).map(Some) }
    }

    fn write(&self) -> Node {
        self.as_ref().map_or_else(|| Node::atom("None"), T::write)
    }
}

impl<T: Value> Value for Vec<T> {
    const SHAPE: Shape = Shape::List(T::INNER);

    fn read(node: &Node) -> Option<Self> {
        match &node.content {
            Content::List(items) => items.iter().map(T::read).collect(),
            _ => None,
        }
    }

    fn write(&self) -> Node {
        Node::new(Content::List(self.iter().map(T::write).collect()))
    }
}
