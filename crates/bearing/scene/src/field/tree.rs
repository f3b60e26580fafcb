//! RON text → one tree of values, each with its place; and back to text.
//!
//! RON's own reader reports the place of a syntax error but forgets the place of a value, so an error of
//! meaning (a negative diameter) could not be underlined.

use std::ops::Range;

use super::{Field, Group, Shape};

/// Deeper nesting than this is no scene.
const MAX_DEPTH: usize = 64;

/// A value, and where it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// What it consists of.
    pub content: Content,
    /// Byte range in the text of its source, brackets included.
    pub span: Range<usize>,
    /// Where that text is.
    pub source: Source,
}

/// What a value consists of.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// A number, a word, or a text with its quotes, as it is written.
    Atom(String),
    /// `[ value, … ]`.
    List(Vec<Node>),
    /// `( value, … )`.
    Tuple(Vec<Node>),
    /// `( name: value, … )`.
    Group(Vec<(Key, Node)>),
    /// `word( … )`, where brackets with one value in them are that value.
    Behind(String, Box<Node>),
}

/// The name of a field, and where it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// The name.
    pub name: String,
    /// Its byte range.
    pub span: Range<usize>,
}

/// Where a value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Nobody wrote it: a default, or a scene in memory.
    Default,
    /// The text of a file.
    File,
    /// An argument `field=value`, by its number.
    Argument(usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Step<'a> {
    /// `.name`
    Field(&'a str),
    /// `[3]`
    Item(usize),
}

/// The steps of `output.sensors[1].name`. A number that is none leads nowhere.
pub(crate) fn steps(path: &str) -> impl Iterator<Item = Step<'_>> {
    path.split('.').flat_map(|part| {
        let (name, items) = part.find('[').map_or((part, ""), |at| part.split_at(at));
        let item =
            |item: &str| item.strip_prefix('[').and_then(|item| item.parse().ok()).unwrap_or(usize::MAX);
        let items = items.split_terminator(']').map(move |text| Step::Item(item(text)));
        std::iter::once(Step::Field(name)).chain(items)
    })
}

/// The path of a field in a group at `path`.
pub(crate) fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

impl Node {
    /// A value that nobody wrote.
    pub fn new(content: Content) -> Self {
        Self { content, span: 0..0, source: Source::Default }
    }

    /// A number, a word or a text that nobody wrote.
    pub fn atom(text: impl Into<String>) -> Self {
        Self::new(Content::Atom(text.into()))
    }

    /// Fields that nobody wrote.
    pub fn group<'a>(fields: impl IntoIterator<Item = (&'a str, Self)>) -> Self {
        let key = |name: &str| Key { name: name.to_owned(), span: 0..0 };
        Self::new(Content::Group(fields.into_iter().map(|(name, node)| (key(name), node)).collect()))
    }

    /// `word( … )`.
    pub fn behind(word: &str, inside: Self) -> Self {
        Self::new(Content::Behind(word.to_owned(), Box::new(inside)))
    }

    /// Whether it is `None`.
    pub fn is_none(&self) -> bool {
        matches!(&self.content, Content::Atom(text) if text == "None")
    }

    /// Whether it is a text in quotes.
    pub fn is_quoted(&self) -> bool {
        let begins = |text: &str| ["\"", "r\"", "r#\""].iter().any(|quote| text.starts_with(quote));
        matches!(&self.content, Content::Atom(text) if begins(text) || text.starts_with("r##"))
    }

    /// The word that it is, or that stands before its brackets.
    pub fn word(&self) -> Option<&str> {
        match &self.content {
            Content::Atom(word) | Content::Behind(word, _) => Some(word),
            _ => None,
        }
    }

    /// What stands in the brackets behind its word; otherwise the value itself.
    pub fn inside(&self) -> &Self {
        if let Content::Behind(_, inside) = &self.content { inside } else { self }
    }

    /// The field of this name of a group.
    pub fn field(&self, name: &str) -> Option<&Self> {
        match &self.inside().content {
            Content::Group(fields) => Some(&fields.iter().find(|(key, _)| key.name == name)?.1),
            _ => None,
        }
    }

    /// One step further.
    pub(crate) fn step(&self, step: Step<'_>) -> Option<&Self> {
        match (step, &self.inside().content) {
            (Step::Field(name), _) => self.field(name),
            (Step::Item(at), Content::List(items)) => items.get(at),
            _ => None,
        }
    }

    /// The value at a path; all of it for an empty one.
    pub fn get(&self, path: &str) -> Option<&Self> {
        if path.is_empty() { Some(self) } else { steps(path).try_fold(self, |node, step| node.step(step)) }
    }

    /// Every value in here with its path, `under` which this one is, inner ones first.
    pub fn entries(&self, under: &str) -> Vec<(String, Range<usize>, &Self)> {
        let mut all = Vec::new();
        match &self.inside().content {
            Content::Group(fields) => {
                for (key, node) in fields {
                    let path = join(under, &key.name);
                    all.extend(node.entries(&path));
                    all.push((path, key.span.clone(), node));
                }
            }
            Content::List(items) => {
                for (i, node) in items.iter().enumerate() {
                    let path = format!("{under}[{i}]");
                    all.extend(node.entries(&path));
                    all.push((path, node.span.clone(), node));
                }
            }
            Content::Atom(_) | Content::Tuple(_) | Content::Behind(..) => {}
        }
        all
    }

    /// The same value, where its parts are equal to those of `written` with their places.
    #[must_use]
    pub(crate) fn placed_as(self, written: &Self) -> Self {
        let content = match (self.content, &written.content) {
            (Content::Atom(text), Content::Atom(other)) if same(&text, other) => Content::Atom(text),
            (Content::List(items), Content::List(others)) if items.len() == others.len() => Content::List(
                items.into_iter().zip(others).map(|(item, other)| item.placed_as(other)).collect(),
            ),
            (Content::Tuple(items), Content::Tuple(others)) => Content::Tuple(
                items.into_iter().zip(others).map(|(item, other)| item.placed_as(other)).collect(),
            ),
            (Content::Group(fields), Content::Group(_)) => {
                let placed = |(key, node): (Key, Self)| match written.field(&key.name) {
                    Some(other) => (key, node.placed_as(other)),
                    None => (key, node),
                };
                Content::Group(fields.into_iter().map(placed).collect())
            }
            (Content::Behind(word, inside), Content::Behind(other, of_other)) if word == *other => {
                Content::Behind(word, Box::new(inside.placed_as(of_other)))
            }
            (content, _) => return Self { content, ..self },
        };
        Self { content, span: written.span.clone(), source: written.source }
    }

    /// The same value, all of it from one place.
    pub(crate) fn place_all(&mut self, source: Source, span: &Range<usize>) {
        (self.source, self.span) = (source, span.clone());
        match &mut self.content {
            Content::Atom(_) => {}
            Content::List(items) | Content::Tuple(items) => {
                items.iter_mut().for_each(|item| item.place_all(source, span));
            }
            Content::Group(fields) => fields.iter_mut().for_each(|(_, node)| node.place_all(source, span)),
            Content::Behind(_, inside) => inside.place_all(source, span),
        }
    }

    /// As a file has it, with all fields but those for which `left_out`.
    pub(crate) fn to_ron(&self, shape: Shape, left_out: &dyn Fn(&Group, &Field, &Self) -> bool) -> String {
        let mut text = String::new();
        self.write(shape, left_out, "\n", &mut text);
        text + "\n"
    }

    /// `line` is the beginning of a line with the indentation of this value.
    fn write(
        &self,
        shape: Shape,
        left_out: &dyn Fn(&Group, &Field, &Self) -> bool,
        line: &str,
        text: &mut String,
    ) {
        let deeper = format!("{line}    ");
        match (&self.content, shape.there()) {
            (Content::Atom(atom), _) => text.push_str(atom),
            (Content::List(items), Shape::List(item)) if !items.is_empty() => {
                text.push('[');
                for node in items {
                    text.push_str(&deeper);
                    node.write(*item, left_out, &deeper, text);
                    text.push(',');
                }
                *text += &format!("{line}]");
            }
            (Content::List(_), _) => text.push_str("[]"),
            (Content::Tuple(items), _) => {
                let inside: Vec<&str> = items.iter().filter_map(Self::word).collect();
                *text += &format!("({})", inside.join(", "));
            }
            (Content::Group(fields), Shape::Group(group)) => {
                text.push('(');
                for (key, node) in fields {
                    let Some(field) = group.get(&key.name).filter(|field| !left_out(group, field, node))
                    else {
                        continue;
                    };
                    *text += &format!("{deeper}{}: ", field.name);
                    node.write(field.shape, left_out, &deeper, text);
                    text.push(',');
                }
                *text += &format!("{line})");
            }
            (Content::Behind(word, inside), Shape::Words(words)) => {
                text.push_str(word);
                let shape = words.get(word).and_then(|word| word.inside);
                let is_group = matches!(shape, Some(Shape::Group(_)));
                text.push_str(if is_group { "" } else { "(" });
                inside.write(shape.unwrap_or(Shape::Text), left_out, line, text);
                text.push_str(if is_group { "" } else { ")" });
            }
            (Content::Group(_) | Content::Behind(..), _) => {}
        }
    }
}

/// Whether two atoms are the same number or text.
fn same(a: &str, b: &str) -> bool {
    let number = |text: &str| ron::from_str::<f64>(text).ok();
    let text = |text: &str| ron::from_str::<String>(text).ok();
    a == b || (number(a).is_some() && number(a) == number(b)) || (text(a).is_some() && text(a) == text(b))
}

/// A text that is no value, or more than one.
#[derive(Debug)]
pub struct Broken {
    /// Path of the field in which reading stopped.
    pub field: String,
    /// Byte range where it did.
    pub range: Range<usize>,
    /// Why.
    pub kind: Stop,
}

/// Why a text is no value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stop {
    /// There is nothing.
    Empty,
    /// It ends inside of brackets.
    Ends,
    /// Another beginning of a value is there.
    NoValue,
    /// It stops between values, where this is expected.
    Expected(&'static str),
    /// It is nested too deeply.
    Deep,
}

/// The value that a whole text is.
///
/// # Errors
/// Where and why it is no value.
pub fn parse(text: &str) -> Result<Node, Broken> {
    let mut parser = Parser { text, at: 0, source: Source::File };
    parser.attributes();
    parser.whole("")
}

/// The value behind byte `at` of an argument for the field at `path`.
pub(crate) fn parse_argument(text: &str, at: usize, number: usize, path: &str) -> Result<Node, Broken> {
    Parser { text, at, source: Source::Argument(number) }.whole(path)
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    source: Source,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Consumes `c` when it comes next.
    fn accept(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        if found {
            self.at += c.len_utf8();
        }
        found
    }

    /// A value, and nothing behind it.
    fn whole(&mut self, path: &str) -> Result<Node, Broken> {
        self.blank();
        if self.rest().is_empty() {
            return Err(self.broken(path, self.at, Stop::Empty));
        }
        let node = self.value(path, 0)?;
        self.blank();
        if self.rest().is_empty() {
            Ok(node)
        } else {
            Err(self.broken(path, self.at, Stop::Expected("the end of the text")))
        }
    }

    fn broken(&self, path: &str, at: usize, kind: Stop) -> Broken {
        let kind = if at >= self.text.len() && kind != Stop::Empty { Stop::Ends } else { kind };
        let end = self.text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
        Broken { field: path.to_owned(), range: at..end, kind }
    }

    /// Skips white space and comments.
    fn blank(&mut self) {
        loop {
            let rest = self.rest();
            let trimmed = rest.trim_start();
            self.at += rest.len() - trimmed.len();
            if trimmed.starts_with("//") {
                self.at += trimmed.find('\n').unwrap_or(trimmed.len());
            } else if trimmed.starts_with("/*") {
                self.block_comment();
            } else {
                return;
            }
        }
    }

    /// Skips a block comment; RON nests them.
    fn block_comment(&mut self) {
        let mut depth = 0_usize;
        loop {
            let rest = self.rest();
            let length = if rest.starts_with("/*") {
                depth += 1;
                2
            } else if rest.starts_with("*/") {
                depth -= 1;
                2
            } else {
                rest.chars().next().map_or(0, char::len_utf8)
            };
            self.at += length;
            if depth == 0 || length == 0 {
                return;
            }
        }
    }

    /// Skips `#![enable(…)]` lines.
    fn attributes(&mut self) {
        loop {
            self.blank();
            let end = self.rest().find(']').filter(|_| self.rest().starts_with("#!"));
            let Some(end) = end else { return };
            self.at += end + 1;
        }
    }

    fn value(&mut self, path: &str, depth: usize) -> Result<Node, Broken> {
        self.blank();
        let start = self.at;
        if depth > MAX_DEPTH {
            return Err(self.broken(path, start, Stop::Deep));
        }
        let content = match self.peek() {
            Some('[') => self.items(path, depth)?,
            Some('(') => self.brackets(path, depth)?,
            Some('"') => self.string(path)?,
            _ if self.rest().starts_with("r\"") || self.rest().starts_with("r#") => self.raw_string(path)?,
            _ => self.word(path, depth)?,
        };
        Ok(Node { content, span: start..self.at, source: self.source })
    }

    /// A number or a word, with what stands in brackets behind it.
    fn word(&mut self, path: &str, depth: usize) -> Result<Content, Broken> {
        let rest = self.rest();
        let end = rest.find(|c: char| !(c.is_alphanumeric() || "_+-.".contains(c))).unwrap_or(rest.len());
        if end == 0 {
            return Err(self.broken(path, self.at, Stop::NoValue));
        }
        let word = rest[..end].to_owned();
        self.at += end;
        let behind = self.at;
        self.blank();
        if self.peek() != Some('(') {
            self.at = behind;
            return Ok(Content::Atom(word));
        }
        let start = self.at;
        let content = self.brackets(path, depth)?;
        let mut inside = Node { content, span: start..self.at, source: self.source };
        if let Content::Tuple(items) = &mut inside.content
            && items.len() == 1
            && let Some(only) = items.pop()
        {
            inside = only;
        }
        // `Some( … )` is the value itself.
        Ok(if word == "Some" { inside.content } else { Content::Behind(word, Box::new(inside)) })
    }

    fn string(&mut self, path: &str) -> Result<Content, Broken> {
        let rest = self.rest();
        let mut chars = rest.char_indices().skip(1);
        while let Some((at, c)) = chars.next() {
            match c {
                '"' => {
                    self.at += at + 1;
                    return Ok(Content::Atom(rest[..=at].to_owned()));
                }
                '\\' => drop(chars.next()),
                _ => {}
            }
        }
        Err(self.broken(path, self.text.len(), Stop::Ends))
    }

    fn raw_string(&mut self, path: &str) -> Result<Content, Broken> {
        let rest = self.rest();
        let hashes = rest[1..].bytes().take_while(|b| *b == b'#').count();
        let body = 2 + hashes;
        if !rest[1 + hashes..].starts_with('"') {
            return Err(self.broken(path, self.at, Stop::NoValue));
        }
        let close = format!("\"{}", "#".repeat(hashes));
        let Some(end) = rest[body..].find(&close) else {
            return Err(self.broken(path, self.text.len(), Stop::Ends));
        };
        let length = body + end + close.len();
        self.at += length;
        Ok(Content::Atom(rest[..length].to_owned()))
    }

    fn items(&mut self, path: &str, depth: usize) -> Result<Content, Broken> {
        self.at += 1;
        let mut items = Vec::new();
        loop {
            self.blank();
            if self.accept(']') {
                return Ok(Content::List(items));
            }
            items.push(self.value(&format!("{path}[{}]", items.len()), depth + 1)?);
            self.separator(path, ']', "`,` or `]`")?;
        }
    }

    /// `( key: value, … )` or `( value, … )`.
    fn brackets(&mut self, path: &str, depth: usize) -> Result<Content, Broken> {
        self.at += 1;
        let (mut fields, mut values): (Vec<(Key, Node)>, Vec<Node>) = (Vec::new(), Vec::new());
        loop {
            self.blank();
            if self.accept(')') {
                let is_tuple = fields.is_empty() && !values.is_empty();
                return Ok(if is_tuple { Content::Tuple(values) } else { Content::Group(fields) });
            }
            let start = self.at;
            if let Some(key) = self.key() {
                if !values.is_empty() {
                    return Err(self.broken(path, start, Stop::Expected("a value without a name")));
                }
                let field = join(path, &key.name);
                let value = self.value(&field, depth + 1)?;
                fields.push((key, value));
            } else if !fields.is_empty() {
                return Err(self.broken(path, start, Stop::Expected("the name of a field")));
            } else {
                let value = self.value(path, depth + 1)?;
                self.blank();
                if self.peek() == Some(':') {
                    return Err(self.broken(path, start, Stop::Expected("the name of a field")));
                }
                let is_word = matches!(&value.content, Content::Atom(_)) && !value.is_quoted();
                if is_word && !matches!(self.peek(), None | Some(',' | ')')) {
                    return Err(self.broken(path, self.at, Stop::Expected("a colon")));
                }
                values.push(value);
            }
            self.separator(path, ')', "`,` or `)`")?;
        }
    }

    /// `name :`, consumed; nothing is consumed when something else comes.
    fn key(&mut self) -> Option<Key> {
        let start = self.at;
        let rest = self.rest();
        let end = start + rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        self.at = end;
        self.blank();
        if end > start && self.accept(':') {
            return Some(Key { name: self.text[start..end].to_owned(), span: start..end });
        }
        self.at = start;
        None
    }

    /// A comma, or the closing bracket left in place.
    fn separator(&mut self, path: &str, close: char, expected: &'static str) -> Result<(), Broken> {
        self.blank();
        if self.accept(',') || self.peek() == Some(close) {
            return Ok(());
        }
        Err(self.broken(path, self.at, Stop::Expected(expected)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str = r#"
        #![enable(implicit_some)]
        // a comment with a ( bracket
        (bearing: (rollers: 24, /* nested /* one */ */ thickness_mm: 2.5e1),
         cage: Some((thickness_mm: 4)),
         name: "a \" b",
         output: (sensors: [(name: r"x", angle_deg: -3), (name: "y", angle_deg: 4,),]),)
    "#;

    #[test]
    fn behaves_every_field_is_found_with_its_place() {
        let tree = parse(TEXT).expect("sound");
        let value = |path: &str| tree.get(path).map(|node| &TEXT[node.span.clone()]);
        assert_eq!(value("bearing.rollers"), Some("24"));
        assert_eq!(value("bearing.thickness_mm"), Some("2.5e1"));
        assert_eq!(value("cage.thickness_mm"), Some("4"));
        assert_eq!(value("cage"), Some("Some((thickness_mm: 4))"));
        assert_eq!(value("name"), Some(r#""a \" b""#));
        assert_eq!(value("output.sensors[0].angle_deg"), Some("-3"));
        assert_eq!(value("output.sensors[1].name"), Some("\"y\""));
        assert_eq!(value("output.sensors[2].name"), None);
        assert_eq!(value("output.sensors[x]"), None);
    }

    #[test]
    fn behaves_single_values_are_distinguished_from_fragments() {
        for good in ["1.0", "None", "(a: 1)", "[1, 2]", "\"x\"", "Some((a: (b: 2)))", " -3e4 "] {
            assert!(parse(good).is_ok(), "{good}");
        }
        for (bad, at, stop) in [
            ("", 0..0, Stop::Empty),
            ("1, 2", 1..2, Stop::Expected("the end of the text")),
            ("(a: 1", 5..5, Stop::Ends),
            ("1), b: (2", 1..2, Stop::Expected("the end of the text")),
            ("\"x", 2..2, Stop::Ends),
            ("[1 2]", 3..4, Stop::Expected("`,` or `]`")),
            (")", 0..1, Stop::NoValue),
            ("r#x", 0..1, Stop::NoValue),
            ("(a: 1, 2)", 7..8, Stop::Expected("the name of a field")),
        ] {
            let broken = parse(bad).expect_err(bad);
            assert_eq!((broken.range, broken.kind), (at, stop), "{bad}");
        }
    }

    proptest! {
        #[test]
        fn survives_any_text(text in "[ -~\\n(){}\\[\\]\"#r:,/*é]{0,80}") {
            match parse(&text) {
                Ok(tree) => for (_, key, node) in tree.entries("") {
                    prop_assert!(text.get(key).is_some() && text.get(node.span.clone()).is_some());
                },
                Err(broken) => prop_assert!(text.get(broken.range).is_some()),
            }
        }

        #[test]
        fn survives_a_truncated_text(cut in 0..TEXT.len()) {
            if let Some(part) = TEXT.get(..cut) {
                prop_assert!(parse(part).is_err() || part.trim_end() == TEXT.trim_end());
            }
        }
    }
}
