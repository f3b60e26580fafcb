//! The cards of an Abaqus file: a keyword line with its parameters, however many lines it takes, and the data
//! lines below it.

/// A keyword line and what follows it.
#[derive(Debug, Default)]
pub(super) struct Card<'a> {
    /// Line of the keyword, from 1.
    pub(super) line: usize,
    /// In capitals, with single blanks.
    pub(super) name: String,
    /// Parameters in capitals, and their values as they stand, without quotes.
    parameters: Vec<(String, String)>,
    /// Data lines with their numbers, without comments and empty lines.
    pub(super) data: Vec<(usize, &'a str)>,
}

impl Card<'_> {
    /// The value of a parameter; empty for one without a value.
    pub(super) fn parameter(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }
}

/// The cells of a data line that hold something, without blanks and quotes.
pub(super) fn cells(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|cell| cell.trim().trim_matches('"')).filter(|cell| !cell.is_empty())
}

/// All cards of a text, without the lines before the first one.
pub(super) fn cards(text: &str) -> Vec<Card<'_>> {
    let mut cards: Vec<Card<'_>> = Vec::new();
    let mut lines = text.lines().enumerate().map(|(at, line)| (at + 1, line.trim())).peekable();
    while let Some((line, words)) = lines.next() {
        if is_comment(words) {
            continue;
        }
        let Some(keyword) = words.strip_prefix('*') else {
            if let Some(card) = cards.last_mut() {
                card.data.push((line, words));
            }
            continue;
        };
        let mut whole = keyword.to_owned();
        // A comma at the end goes on below, but for data under a keyword that has one comma too many.
        while whole.trim_end().ends_with(',')
            && let Some((_, next)) = lines.next_if(|(_, next)| is_comment(next) || goes_on(next))
        {
            if !is_comment(next) {
                whole.push_str(next);
            }
        }
        cards.push(card(line, &whole));
    }
    cards
}

fn is_comment(line: &str) -> bool {
    line.is_empty() || line.starts_with("**")
}

fn goes_on(line: &str) -> bool {
    line.starts_with(|c: char| c.is_ascii_alphabetic())
}

fn card<'a>(line: usize, keyword: &str) -> Card<'a> {
    let mut parts = between_commas(keyword).into_iter();
    let name = parts.next().unwrap_or_default();
    let plain = |words: &str| words.split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
    let parameters = parts
        .map(|part| part.split_once('=').unwrap_or((part, "")))
        .map(|(name, value)| (plain(name), value.trim().trim_matches('"').to_owned()))
        .filter(|(name, _)| !name.is_empty())
        .collect();
    Card { line, name: plain(name), parameters, data: Vec::new() }
}

/// Commas within quotes do not separate.
fn between_commas(line: &str) -> Vec<&str> {
    let mut quoted = false;
    line.split(|c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    })
    .collect()
}
