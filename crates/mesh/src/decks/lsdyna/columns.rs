//! How wide the columns of a card are: as the first line says, or the keyword's own last letter.

/// Widths of the columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Format {
    /// Eight characters for numbers of nodes and elements, ten for others.
    #[default]
    Standard,
    /// `I10=Y` or `%`: ten characters for numbers of nodes and elements.
    Ten,
    /// `LONG=Y` or `+`: twenty for everything.
    Long,
}

impl Format {
    /// Of the whole file, from the words behind `*KEYWORD`.
    pub(super) fn of_file(options: &str) -> Self {
        let options = options.to_ascii_uppercase();
        let says =
            |name: &str| options.split([' ', ',']).any(|option| option.split_once('=') == Some((name, "Y")));
        if says("LONG") {
            Self::Long
        } else if says("I10") {
            Self::Ten
        } else {
            Self::Standard
        }
    }

    /// A keyword without the sign at its end, and the format of its card.
    pub(super) fn of_card(self, keyword: &str) -> (String, Self) {
        let keyword = keyword.trim().to_ascii_uppercase();
        let format = match keyword.chars().last() {
            Some('+') => Self::Long,
            Some('%') => Self::Ten,
            Some('-') => Self::Standard,
            _ => return (keyword, self),
        };
        (keyword[..keyword.len() - 1].trim_end().to_owned(), format)
    }

    /// Widths of `*NODE`: the number, three coordinates.
    pub(super) fn node(self) -> [usize; 4] {
        match self {
            Self::Standard => [8, 16, 16, 16],
            Self::Ten => [10, 16, 16, 16],
            Self::Long => [20; 4],
        }
    }

    /// Width of the numbers of elements and their nodes.
    pub(super) fn element(self) -> usize {
        match self {
            Self::Standard => 8,
            Self::Ten => 10,
            Self::Long => 20,
        }
    }

    /// Width of what sets and parts hold.
    pub(super) fn others(self) -> usize {
        if self == Self::Long { 20 } else { 10 }
    }
}

/// The cells of a line, without blanks: between commas, or in columns of these widths.
pub(super) fn cells(line: &str, widths: impl IntoIterator<Item = usize>) -> Vec<&str> {
    if line.contains(',') {
        return line.split(',').map(str::trim).collect();
    }
    let mut rest = line;
    let mut cells = Vec::new();
    for width in widths {
        if rest.is_empty() {
            break;
        }
        let end = rest.char_indices().nth(width).map_or(rest.len(), |(at, _)| at);
        let (cell, after) = rest.split_at(end);
        cells.push(cell.trim());
        rest = after;
    }
    cells
}
