//! Literals of Python as NumPy writes them into its headers: texts, whole numbers, words, tuples, lists and
//! dictionaries.

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Literal {
    Text(String),
    /// A number or a name, as it is written.
    Word(String),
    /// Items of a tuple or a list; keys and values of a dictionary in turn.
    Items(Vec<Literal>),
}

/// Lists in lists, at most.
const DEEPEST: usize = 16;

pub(crate) fn parse(text: &str) -> Option<Literal> {
    Literal::next(&mut text.chars().peekable(), 0)
}

type Chars<'a> = std::iter::Peekable<std::str::Chars<'a>>;

impl Literal {
    fn next(text: &mut Chars<'_>, depth: usize) -> Option<Self> {
        if depth > DEEPEST {
            return None;
        }
        skip(text, char::is_whitespace);
        match *text.peek()? {
            '(' | '[' | '{' => {
                text.next();
                let mut items = Vec::new();
                loop {
                    skip(text, |c| c.is_whitespace() || matches!(c, ',' | ':'));
                    if matches!(*text.peek()?, ')' | ']' | '}') {
                        text.next();
                        return Some(Self::Items(items));
                    }
                    items.push(Self::next(text, depth + 1)?);
                }
            }
            quote @ ('\'' | '"') => {
                text.next();
                let mut words = String::new();
                loop {
                    match text.next()? {
                        c if c == quote => return Some(Self::Text(words)),
                        '\\' => words.push(escaped(text)?),
                        c => words.push(c),
                    }
                }
            }
            _ => {
                let mut word = String::new();
                while let Some(c) = text.next_if(|c| !c.is_whitespace() && !",:()[]{}'\"".contains(*c)) {
                    word.push(c);
                }
                (!word.is_empty()).then_some(Self::Word(word))
            }
        }
    }

    /// The value of a key of a dictionary.
    pub(crate) fn get(&self, key: &str) -> Option<&Self> {
        let mut pairs = self.items().chunks_exact(2);
        pairs.find(|pair| pair[0].text() == Some(key)).map(|pair| &pair[1])
    }

    /// Items of a tuple, a list or a dictionary; empty for others.
    pub(crate) fn items(&self) -> &[Self] {
        if let Self::Items(items) = self { items } else { &[] }
    }

    pub(crate) fn text(&self) -> Option<&str> {
        if let Self::Text(text) = self { Some(text) } else { None }
    }

    /// A whole number; Python 2 wrote an `L` behind long ones.
    pub(crate) fn count(&self) -> Option<u64> {
        if let Self::Word(word) = self { word.trim_end_matches('L').parse().ok() } else { None }
    }
}

fn skip(text: &mut Chars<'_>, what: impl Fn(char) -> bool) {
    while text.next_if(|c| what(*c)).is_some() {}
}

/// The character behind a backslash.
fn escaped(text: &mut Chars<'_>) -> Option<char> {
    match text.next()? {
        'x' => code_of(text, 2),
        'u' => code_of(text, 4),
        'U' => code_of(text, 8),
        'n' => Some('\n'),
        't' => Some('\t'),
        'r' => Some('\r'),
        c => Some(c),
    }
}

/// The character of a code in as many hexadecimal digits.
fn code_of(text: &mut Chars<'_>, digits: usize) -> Option<char> {
    let digits: String = text.by_ref().take(digits).collect();
    char::from_u32(u32::from_str_radix(&digits, 16).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_names_with_brackets_quotes_and_escapes() {
        let text = "{'descr': [('t (s)', '<f8'), (\"it's\", '|V6'), ('a\\'b\\xb2', '<f4', (2, 3))], 'shape': \
            (9,), }";
        let header = parse(text).unwrap();
        let fields = header.get("descr").unwrap().items();
        let names: Vec<_> = fields.iter().map(|f| f.items()[0].text().unwrap()).collect();
        assert_eq!(names, ["t (s)", "it's", "a'b²"]);
        assert_eq!(fields[2].items()[2].items()[1].count(), Some(3));
        assert_eq!(header.get("shape").unwrap().items().len(), 1);
        assert_eq!(parse("{'a': (1, "), None);
    }
}
