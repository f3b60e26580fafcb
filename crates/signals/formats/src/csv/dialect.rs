//! How a table is written: separator of columns, decimal sign, first row of numbers.

use std::hash::{Hash, Hasher};

use super::WIDE;
use super::stamp::stamp;

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dialect {
    /// Separator of columns; a space stands for any run of white space.
    pub(crate) separator: char,
    pub(crate) decimal_comma: bool,
    /// In dates with slashes the day comes first.
    pub(crate) day_first: bool,
    /// Digests of the lines of names and units, which may stand again further below.
    pub(crate) heading: [Option<u64>; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Field {
    Number(f64),
    Stamp(i64, i32),
    /// Empty, or a word for a missing value.
    Missing,
    Text,
}

/// Rows that must agree in how many columns there are.
const AGREE: usize = 8;

impl Dialect {
    pub(crate) fn new(separator: char, decimal_comma: bool) -> Self {
        Self { separator, decimal_comma, day_first: false, heading: [None; 2] }
    }

    /// The dialect of some lines, and the first of them that is a row of numbers.
    pub(crate) fn of(lines: &[String]) -> Option<(Self, usize)> {
        const ALL: [(char, bool); 10] = [
            (';', true),
            ('\t', false),
            ('\t', true),
            ('|', false),
            ('|', true),
            (',', false),
            (' ', false),
            (' ', true),
            (';', false),
            (',', true),
        ];
        // Strictly: numbers, times and gaps alone. Otherwise some columns may be texts.
        let found = [true, false].into_iter().find_map(|strict| {
            let all = ALL.into_iter().map(|(separator, decimal_comma)| Self::new(separator, decimal_comma));
            let mut all = all.filter_map(|dialect| Some((dialect, dialect.begins(lines, strict)?)));
            let first = all.next()?;
            if first.0.separator != ',' || first.1 < 2 * AGREE {
                return Some(first);
            }
            // Thousands far below the first row are no columns.
            let above = |of: &(Self, usize)| of.0.separator == ' ' && of.1 + 2 * AGREE < first.1;
            Some(all.find(|of| above(of) && of.0.is_single(&lines[of.1..])).unwrap_or(first))
        });
        let (dialect, first) = found?;
        let single = Self::new(' ', true);
        let one_column = dialect.separator == ',' && is_one_column(&lines[..first], &lines[first..]);
        if one_column { Some((single, single.begins(lines, true)?)) } else { Some((dialect, first)) }
    }

    /// The first row of numbers: the rows behind it have as many columns.
    fn begins(&self, lines: &[String], strict: bool) -> Option<usize> {
        let row = |line: &str| -> Option<usize> {
            if self.separator != ' ' && !line.contains(self.separator) {
                return None;
            }
            let (mut fields, mut numbers, mut texts, mut is_named) = (0, 0, 0, false);
            self.each(line, |field| {
                let kind = self.field(field);
                is_named |= fields == 0 && kind == Field::Text;
                fields += 1;
                numbers += usize::from(matches!(kind, Field::Number(_)));
                texts += usize::from(kind == Field::Text);
            });
            // Words between spaces are a sentence, but for the name of a row.
            let most = if self.separator == ' ' { usize::from(is_named && fields > 2) } else { fields / 2 };
            (numbers > 0 && (texts == 0 || !strict && texts <= most)).then_some(fields)
        };
        let rows: Vec<Option<usize>> = lines.iter().map(|line| row(line)).collect();
        (0..lines.len()).find(|n| {
            let Some(columns) = rows[*n] else { return false };
            let behind = rows[n + 1..].iter().zip(&lines[n + 1..]);
            let mut behind = behind.filter(|(_, line)| !self.is_empty(line)).take(AGREE).map(|(row, _)| *row);
            if strict {
                // The row behind may be cut, or hold one field that is no number.
                let next = behind.next();
                next.is_none_or(|row| row.is_none_or(|other| other.abs_diff(columns) < 2))
                    && behind.filter(|row| *row != Some(columns)).count() < AGREE / 2
            } else {
                let agree = behind.by_ref().filter(|row| *row == Some(columns)).count();
                agree >= 2 || columns >= WIDE
            }
        })
    }

    /// Whether nearly all rows are one number, with its thousands in groups or not.
    fn is_single(self, rows: &[String]) -> bool {
        let number = |row: &&String| {
            let field = row.trim().trim_matches('"');
            self.number(field).is_some() || groups(field, ',') == Some(Groups::Thousands)
        };
        10 * rows.iter().filter(number).count() > 9 * rows.len()
    }

    /// The fields of a line, quotes taken off.
    pub(crate) fn split<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let mut fields = Vec::new();
        self.each(line, |field| fields.push(field));
        fields
    }

    /// Passes the fields of a line to `take`, one after the other: a line may hold millions.
    pub(crate) fn each<'a>(&self, line: &'a str, mut take: impl FnMut(&'a str)) {
        let clean = |field: &'a str| field.trim().trim_matches('"').trim();
        if self.separator == ' ' {
            return line.split_whitespace().for_each(|field| take(clean(field)));
        }
        // A quote without its other half takes no separator along.
        if !line.contains('"') || line.matches('"').count() % 2 == 1 {
            return line.split(self.separator).for_each(|field| take(clean(field)));
        }
        let (mut from, mut quoted) = (0, false);
        for (at, c) in line.char_indices() {
            if c == '"' {
                quoted = !quoted;
            } else if c == self.separator && !quoted {
                take(clean(&line[from..at]));
                from = at + c.len_utf8();
            }
        }
        take(clean(&line[from..]));
    }

    /// Whether a line holds nothing, or nothing between its separators.
    pub(crate) fn is_empty(&self, line: &str) -> bool {
        line.chars().all(|c| c.is_whitespace() || c == self.separator || c == '"')
    }

    /// Whether a line is no row: empty, a comment, or the names of the columns once more.
    pub(crate) fn is_aside(&self, line: &str) -> bool {
        /// What Excel writes in place of a number.
        const NONE: [&str; 7] = ["#n/a", "#div/0!", "#ref!", "#value!", "#num!", "#name?", "#null!"];
        let text = line.trim_start().trim_start_matches('"');
        let is_comment = || {
            let marked = ["#", "%", "//"].iter().any(|sign| text.starts_with(sign));
            marked && !NONE.iter().any(|none| text.to_lowercase().starts_with(none))
        };
        let is_heading =
            || text.starts_with(|c: char| !c.is_numeric()) && self.heading.contains(&Some(digest(line)));
        self.is_empty(line) || is_comment() || is_heading()
    }

    pub(crate) fn field(&self, field: &str) -> Field {
        const MISSING: [&str; 10] = ["", "nan", "na", "n/a", "null", "none", "-", "--", "#n/a", "nil"];
        if let Some(number) = self.number(field) {
            return Field::Number(number);
        }
        if MISSING.contains(&field.to_lowercase().as_str()) {
            return Field::Missing;
        }
        stamp(field, self.day_first).map_or(Field::Text, |(s, ns)| Field::Stamp(s, ns))
    }

    /// A number with the decimal sign of the table, and with its thousands in groups.
    pub(super) fn number(&self, field: &str) -> Option<f64> {
        // Rust takes words for numbers that are none here.
        if !field.contains(|c: char| c.is_ascii_digit()) {
            return None;
        }
        // Nearly all are plain.
        if field.bytes().all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b))
            && let Ok(number) = field.parse()
        {
            return Some(number);
        }
        // Some write a minus that is no hyphen.
        let field = field.replace('\u{2212}', "-");
        let plain = |text: &str| text.parse::<f64>().ok();
        let number = |text: &str| {
            // FORTRAN writes D for the exponent of a double.
            plain(text).or_else(|| plain(&text.replace(['d', 'D'], "e")))
        };
        let (point, group) = if self.decimal_comma { (',', '.') } else { ('.', ',') };
        let grouped = |sign: char| ungrouped(&field, point, sign).and_then(|text| plain(&text));
        if self.decimal_comma && field.contains(',') {
            number(&field.replace(',', ".")).or_else(|| grouped(group))
        } else {
            number(&field).or_else(|| grouped(group))
        }
        .or_else(|| {
            // Of both signs in one number the last is the decimal one, whatever the table has elsewhere.
            if field.contains(group) && field.contains(point) {
                return plain(&ungrouped(&field, group, point)?);
            }
            let signs = ['\'', '\u{2019}', '\u{a0}', '\u{202f}', ' '];
            let point = if field.contains(point) { point } else { '.' };
            signs.into_iter().find_map(|sign| plain(&ungrouped(&field, point, sign)?))
        })
    }
}

/// A number that another line than this one hardly has.
pub(super) fn digest(line: &str) -> u64 {
    let mut hasher = std::hash::DefaultHasher::new();
    line.trim().hash(&mut hasher);
    hasher.finish()
}

/// `1.234.567,5` without the signs between its thousands, and with a decimal point. Without a fraction a
/// single sign may be the decimal one: then it is none.
fn ungrouped(field: &str, point: char, group: char) -> Option<String> {
    let (whole, fraction) = match field.split_once(point) {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (field, None),
    };
    let mut groups = whole.trim_start_matches(['-', '+']).split(group);
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let first = groups.next().filter(|text| digits(text) && text.len() <= 3)?;
    let rest: Vec<&str> = groups.collect();
    let is_grouped = rest.iter().all(|text| text.len() == 3 && digits(text))
        && fraction.is_none_or(digits)
        && rest.len() >= if fraction.is_some() { 1 } else { 2 };
    let sign = if whole.starts_with('-') { "-" } else { "" };
    is_grouped.then(|| format!("{sign}{first}{}.{}", rest.concat(), fraction.unwrap_or("0")))
}

/// What a point or a comma in a field may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Groups {
    /// Groups of three digits stand behind it, and nothing else: `-12,345`.
    Thousands,
    /// It is the sign of a fraction: `0,125`, `1,5`.
    Fraction,
}

/// What `sign` may be in a field that has it; nothing where the field has the other sign, too.
pub(super) fn groups(field: &str, sign: char) -> Option<Groups> {
    if !field.contains(sign) || field.contains(if sign == ',' { '.' } else { ',' }) {
        return None;
    }
    let mut parts = field.trim_start_matches(['-', '+']).split(sign);
    let digits = |text: &str, most: usize| {
        (1..=most).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit())
    };
    let first = parts.next().is_some_and(|text| digits(text, 3) && !text.starts_with('0'));
    let grouped = first && parts.all(|text| text.len() == 3 && digits(text, 3));
    Some(if grouped { Groups::Thousands } else { Groups::Fraction })
}

/// Whether lines of two whole numbers with a comma between them are one column with decimal commas: the line
/// above has no comma, or the first part is `-0`, or the part behind the comma always has the same digits,
/// zeros at its beginning, too. One line in ten may be damaged.
fn is_one_column(head: &[String], rows: &[String]) -> bool {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    // `1,25e-3` is a number, too.
    let mantissa = |text: &str| text.split_once(['e', 'E', 'd', 'D']).map(|(before, _)| before.len());
    let lines = rows.iter().map(|line| line.trim().trim_matches('"')).filter(|line| !line.is_empty());
    let (mut count, mut pairs): (usize, Vec<(&str, &str)>) = (0, Vec::new());
    for line in lines {
        count += 1;
        let pair = line.split_once(',').map(|(a, b)| (a, &b[..mantissa(b).unwrap_or(b.len())]));
        let whole = |a: &str| digits(a) || ungrouped(&format!("{a},0"), ',', '.').is_some();
        pairs.extend(pair.filter(|(a, b)| whole(a.trim_start_matches(['-', '+'])) && digits(b)));
    }
    if pairs.is_empty() || 10 * (count - pairs.len()) > count {
        return false;
    }
    if let Some(name) = head.iter().rev().find(|line| !line.trim().is_empty()) {
        return !name.contains(',');
    }
    let width = pairs[0].1.len();
    let padded = width > 1
        && 10 * pairs.iter().filter(|(_, b)| b.len() == width).count() >= 9 * pairs.len()
        && pairs.iter().any(|(_, b)| b.starts_with('0'));
    padded || pairs.iter().any(|(a, _)| *a == "-0")
}
