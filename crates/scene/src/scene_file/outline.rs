//! Where each field of a RON text stands: `bearing.rollers` → byte range of its key and of its value.
//!
//! RON reports the place of a syntax error but forgets the place of a value that it accepted, so an error of
//! meaning (a negative diameter) could not be underlined. This scanner remembers. It is tolerant: on a broken
//! text it keeps the fields found so far, and it never fails.

use std::ops::Range;

/// Deeper nesting than this is no scene; the scanner stops there instead of exhausting the stack.
const MAX_DEPTH: usize = 64;

/// One field or list item.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Dotted path from the root, `output.sensors[1].name`.
    pub path: String,
    /// Byte range of the key; that of the value for list items.
    pub key: Range<usize>,
    /// Byte range of the value, brackets included.
    pub value: Range<usize>,
}

/// All fields of one RON text, inner ones before the ones that contain them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outline {
    /// The entries.
    pub entries: Vec<Entry>,
    /// Byte range of the whole value; `None` when it could not be scanned to its end.
    pub root: Option<Range<usize>>,
}

impl Outline {
    /// Scans `text`.
    pub fn of(text: &str) -> Self {
        let mut scanner = Scanner { text, at: 0, entries: Vec::new() };
        scanner.attributes();
        let root = scanner.value("", 0);
        Self { entries: scanner.entries, root }
    }

    /// The entry at `path`.
    pub fn get(&self, path: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.path == path)
    }

    /// The innermost entry whose value contains the byte `at`.
    pub fn at(&self, at: usize) -> Option<&Entry> {
        // Inner entries come first, so the first hit is the innermost.
        self.entries.iter().find(|entry| entry.value.start <= at && at <= entry.value.end)
    }
}

/// True when `text` is exactly one value: balanced brackets, closed strings, nothing behind it.
pub(crate) fn is_single_value(text: &str) -> bool {
    let mut scanner = Scanner { text, at: 0, entries: Vec::new() };
    let complete = scanner.value("", 0).is_some();
    scanner.blank();
    complete && scanner.at == text.len()
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    entries: Vec<Entry>,
}

impl<'a> Scanner<'a> {
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
            if rest.starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if rest.starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return;
                }
            } else if let Some(c) = rest.chars().next() {
                self.at += c.len_utf8();
            } else {
                return;
            }
        }
    }

    /// Skips `#![enable(…)]` lines.
    fn attributes(&mut self) {
        loop {
            self.blank();
            if !self.rest().starts_with("#!") {
                return;
            }
            let Some(end) = self.rest().find(']') else { return };
            self.at += end + 1;
        }
    }

    /// Scans one value and its content; its byte range, or `None` when the text is broken.
    fn value(&mut self, path: &str, depth: usize) -> Option<Range<usize>> {
        if depth > MAX_DEPTH {
            return None;
        }
        self.blank();
        let start = self.at;
        match self.peek()? {
            '"' => self.string()?,
            '[' => self.items(path, depth)?,
            '(' => self.group(path, depth)?,
            'r' if self.rest().starts_with("r\"") || self.rest().starts_with("r#") => self.raw_string()?,
            _ => {
                self.atom()?;
                let end = self.at;
                self.blank();
                if self.peek() == Some('(') {
                    self.group(path, depth)?;
                } else {
                    self.at = end;
                }
            }
        }
        Some(start..self.at)
    }

    /// A number or an identifier.
    fn atom(&mut self) -> Option<()> {
        let rest = self.rest();
        let end = rest.find(|c: char| !(c.is_alphanumeric() || "_+-.".contains(c))).unwrap_or(rest.len());
        self.at += end;
        (end > 0).then_some(())
    }

    fn string(&mut self) -> Option<()> {
        self.at += 1;
        loop {
            let c = self.peek()?;
            self.at += c.len_utf8();
            match c {
                '"' => return Some(()),
                '\\' => self.at += self.peek()?.len_utf8(),
                _ => {}
            }
        }
    }

    fn raw_string(&mut self) -> Option<()> {
        let hashes = self.rest()[1..].bytes().take_while(|b| *b == b'#').count();
        let body = self.at + 1 + hashes;
        if !self.text[body..].starts_with('"') {
            return None;
        }
        let close = format!("\"{}", "#".repeat(hashes));
        let end = self.text[body + 1..].find(&close)?;
        self.at = body + 1 + end + close.len();
        Some(())
    }

    fn items(&mut self, path: &str, depth: usize) -> Option<()> {
        self.at += 1;
        for index in 0.. {
            self.blank();
            if self.accept(']') {
                break;
            }
            let item = format!("{path}[{index}]");
            let value = self.value(&item, depth + 1)?;
            self.entries.push(Entry { path: item, key: value.clone(), value });
            self.separator(']')?;
        }
        Some(())
    }

    /// `( key: value, … )`, `Some( value )` or `Name( key: value, … )`.
    fn group(&mut self, path: &str, depth: usize) -> Option<()> {
        self.at += 1;
        loop {
            self.blank();
            if self.accept(')') {
                return Some(());
            }
            if let Some(key) = self.key() {
                let name = &self.text[key.clone()];
                let field = if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
                let value = self.value(&field, depth + 1)?;
                self.entries.push(Entry { path: field, key, value });
            } else {
                // The inside of `Some(…)` is the field itself, so it keeps the path and is not an entry of
                // its own.
                self.value(path, depth + 1)?;
            }
            self.separator(')')?;
        }
    }

    /// `name :`, consumed; nothing is consumed when something else comes.
    fn key(&mut self) -> Option<Range<usize>> {
        let start = self.at;
        let rest = self.rest();
        let end = start + rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        self.at = end;
        self.blank();
        if end > start && self.accept(':') {
            return Some(start..end);
        }
        self.at = start;
        None
    }

    /// A comma, or the closing bracket left in place.
    fn separator(&mut self, close: char) -> Option<()> {
        self.blank();
        (self.accept(',') || self.peek() == Some(close)).then_some(())
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
    fn behaves_every_field_is_found_with_its_value() {
        let outline = Outline::of(TEXT);
        let value = |path: &str| outline.get(path).map(|entry| &TEXT[entry.value.clone()]);
        assert_eq!(value("bearing.rollers"), Some("24"));
        assert_eq!(value("bearing.thickness_mm"), Some("2.5e1"));
        assert_eq!(value("cage.thickness_mm"), Some("4"));
        assert_eq!(value("cage"), Some("Some((thickness_mm: 4))"));
        assert_eq!(value("name"), Some(r#""a \" b""#));
        assert_eq!(value("output.sensors[0].angle_deg"), Some("-3"));
        assert_eq!(value("output.sensors[1].name"), Some("\"y\""));
        assert!(outline.root.is_some());
    }

    #[test]
    fn behaves_the_innermost_field_is_found_from_a_place() {
        let outline = Outline::of(TEXT);
        let at = TEXT.find("2.5e1").expect("the text contains it");
        assert_eq!(outline.at(at + 1).map(|entry| entry.path.as_str()), Some("bearing.thickness_mm"));
    }

    #[test]
    fn behaves_single_values_are_distinguished_from_fragments() {
        for good in ["1.0", "None", "(a: 1)", "[1, 2]", "\"x\"", "Some((a: (b: 2)))", " -3e4 "] {
            assert!(is_single_value(good), "{good}");
        }
        for bad in ["", "1, 2", "(a: 1", "1), b: (2", "\"x", "[1 2]", ")"] {
            assert!(!is_single_value(bad), "{bad}");
        }
    }

    proptest! {
        #[test]
        fn survives_any_text(text in "[ -~\\n(){}\\[\\]\"#r:,/*é]{0,80}") {
            let outline = Outline::of(&text);
            for entry in &outline.entries {
                prop_assert!(text.get(entry.value.clone()).is_some());
            }
        }

        #[test]
        fn survives_a_truncated_text(cut in 0..TEXT.len()) {
            if let Some(part) = TEXT.get(..cut) {
                let outline = Outline::of(part);
                prop_assert!(outline.entries.len() <= Outline::of(TEXT).entries.len());
            }
        }
    }
}
