//! Text tables: one row a sample, one column a channel.
//!
//! Columns are split by semicolons, tabs, bars, commas or spaces, whichever the first rows of numbers agree
//! with; beside all but commas a comma is a decimal point. Lines before the first row of numbers are a
//! preamble; the last of them that has as many columns gives the names, or the units when it looks like them
//! and there are names above. Time stamps become seconds since the first. A field that is no number costs its
//! sample, a column of texts is left out.

mod dialect;
mod head;
mod lines;
mod stamp;

use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use dialect::{Dialect, Field, Groups, digest, groups};
pub(crate) use lines::is_wide;
use lines::{Coding, Lines};
pub(crate) use stamp::stamp;
use stribeck_dsp::channel::{Samples, memory};

use crate::recording::{equal_lengths, left_out};
use crate::time::says_time;
use crate::units;
use crate::{Channel, Error, Recording, Result, clock_columns};

/// The sample rate [Hz] that a text under a name says.
pub(crate) fn rate_hz(name: &str, text: &str) -> Option<f64> {
    head::rate_of(&format!("{name}: {text}"), Dialect::new(',', false), false)
}

/// Lines before the first row of numbers, at most.
const PREAMBLE: usize = 1000;
/// Lines that show how the table is written.
const SAMPLE: usize = 60;
/// Samples handed on at a time.
const BLOCK: usize = 1 << 14;
/// What may stand between thousands, or before a fraction.
const SIGNS: [char; 2] = [',', '.'];
/// Fewest numbers below 1000 that show that a sign above parts thousands.
const FEWEST_PLAIN: u64 = 4;
/// One in this many fields of a column may be something other than a number.
const FEW: u64 = 100;
/// One in this many may be missing by chance.
const RARELY: u64 = 1000;

#[derive(Debug, Clone)]
pub(crate) struct Column {
    path: PathBuf,
    /// From 0.
    at: usize,
    /// Lines before the first row of numbers.
    preamble: u64,
    dialect: Dialect,
    coding: Coding,
    /// The second that time stamps are counted from.
    origin_s: i64,
    /// What stands between its thousands.
    thousands: Option<char>,
}

/// Content of a column.
#[derive(Debug, Default)]
struct Census {
    numbers: u64,
    stamps: u64,
    origin_s: Option<i64>,
    missing: u64,
    /// Texts, and the first of them with its line.
    texts: u64,
    first: Option<(u64, String)>,
    /// What commas and points may be in it.
    signs: [Sign; 2],
    /// Numbers without a comma or a point in them, and the largest.
    plain: u64,
    largest: f64,
}

/// How a column has a comma, or a point.
#[derive(Debug, Default)]
struct Sign {
    /// Fields of which it may part the thousands, and how many of them are no numbers otherwise.
    thousands: u64,
    texts: u64,
    first: Option<(u64, String)>,
    fractions: u64,
}

/// Opens a table: its columns, their names and units.
///
/// # Errors
/// [`Error::Unknown`] for a text without a row of numbers, [`Error::Io`].
pub fn open(path: &Path) -> Result<Recording> {
    let coding = Coding::of(path)?;
    let mut lines = Lines::open(path, coding)?;
    let mut start: Vec<String> = Vec::new();
    while start.len() < PREAMBLE + SAMPLE {
        let Some(line) = lines.next(path)? else { break };
        start.push(line);
    }
    let Some((mut dialect, mut first)) = Dialect::of(&start) else {
        let shown: String = start
            .iter()
            .rev()
            .find(|l| !l.trim().is_empty())
            .into_iter()
            .flat_map(|l| l.chars())
            .take(60)
            .collect();
        let seen = format!("it is text without a row of numbers, such as `{shown}`");
        return Err(Error::Unknown { path: path.to_owned(), seen });
    };
    if counts_columns(&start[first..], dialect) {
        first += 1;
    }
    let columns = columns(&start[first..], dialect);
    let rows: Vec<&String> = start[first..].iter().filter(|line| !dialect.is_empty(line)).collect();
    let is_whole = start.len() < PREAMBLE + SAMPLE;
    if first == 0 && is_whole && lie_across(&rows, columns) {
        return across(path, &rows, dialect);
    }
    dialect.day_first = day_comes_first(path, coding, dialect, &start[first..])?;
    let commas = dialect.decimal_comma && start[first..].iter().any(|line| line.contains(','));
    let mut notes = Vec::new();
    let rate_hz = head::rate_hz(&start[..first], dialect, commas, &mut notes);
    let numbers = columns_of_numbers(rows.first().map_or("", |row| row.as_str()), dialect);
    while first > 0
        && (is_damaged_row(&start[first - 1], dialect, columns)
            || is_row_beside_words(&start[first - 1], dialect, columns, &numbers))
    {
        first -= 1;
    }
    let mut heading = start[..first].iter().rev().filter(|line| line.contains(char::is_alphabetic));
    dialect.heading = std::array::from_fn(|_| heading.next().map(|line| digest(line)));
    let first_rows = FirstRows::of(&rows, dialect);
    let (names, units) = head::names(&start[..first], dialect, columns, &first_rows);
    let names_rows = match &names[..] {
        [first, rest @ ..] => {
            first == "column 1"
                && rest.iter().all(|name| !name.starts_with("column "))
                && first_rows.leave_the_first(rest)
        }
        [] => false,
    };
    let mut counted = census(path, coding, dialect, first as u64, columns)?;
    if states_size(&start[first..], dialect, columns, counted.1) {
        first += 1;
        counted = census(path, coding, dialect, first as u64, columns)?;
        let size = start[first - 1].trim();
        counted.2.push(format!("line {first}, `{size}`, says how many samples there are: it is none itself"));
    }
    let (census, rows, more) = counted;
    notes.extend(more);
    let mut channels = Vec::new();
    let sparse = census.iter().filter(|of| of.missing > rows / RARELY && of.missing < rows).count();
    let origin_s = census.iter().find_map(|census| census.origin_s).unwrap_or(0);
    for (at, (name, mut census)) in names.into_iter().zip(census).enumerate() {
        let thousands = census.thousands();
        if let Some(why) = census.refusal() {
            // A separator at the end of all rows makes no column.
            if census.texts > 0 || !name.starts_with("column ") {
                notes.push(left_out(&name, &why));
            }
            continue;
        }
        if let Some((sign, (line, text))) = &thousands {
            notes.push(format!(
                "`{name}`: `{text}` in line {line} has `{sign}` between its thousands, as no other number of \
                 the column reaches 1000"
            ));
        }
        if let Some((line, text)) = &census.first {
            let more = if census.texts > 1 {
                format!(", and {} more are none", census.texts - 1)
            } else {
                String::new()
            };
            notes.push(format!(
                "`{name}`: `{text}` in line {line} is no number{more}: such samples are left out"
            ));
        }
        let thousands = thousands.map(|(sign, _)| sign);
        let column = Column {
            path: path.to_owned(),
            at,
            preamble: first as u64,
            dialect,
            coding,
            origin_s,
            thousands,
        };
        let unit = units.get(at).map(|unit| unit.trim_matches(['[', ']', '(', ')', ' ']).to_owned());
        let unit = if census.stamps > 0 { Some("s".to_owned()) } else { unit };
        let unit = unit.filter(|unit| !unit.is_empty()).or_else(|| units::in_brackets(&name));
        let mut channel = Channel::new(name, rows, column).at_rate(rate_hz).in_unit(unit);
        channel.column = Some(at + 1);
        channel.is_time = at == 0 && names_rows && census.stamps == 0;
        channels.push(channel);
    }
    // Each column by itself would read the whole file: that of a wide table is read once.
    let channels = if channels.len() > NARROW { held(path, &channels, rows)? } else { channels };
    let recording = Recording { path: path.to_owned(), format: "CSV", channels, notes };
    if sparse > 1 { clock_columns::parted(recording) } else { Ok(recording) }
}

/// Most columns that stay in the file.
const NARROW: usize = 64;

/// Columns of `rows` samples, read at once.
fn held(path: &Path, channels: &[Channel], rows: u64) -> Result<Vec<Channel>> {
    let Some(first) = channels.first().and_then(|c| c.samples_as::<Column>()) else { return Ok(Vec::new()) };
    memory::ask(path, "its columns", rows.saturating_mul(8 * channels.len() as u64))?;
    let mut columns = vec![Vec::with_capacity(rows as usize); channels.len()];
    let places: Vec<&Column> = channels.iter().filter_map(|c| c.samples_as()).collect();
    let mut lines = Lines::open(path, first.coding)?;
    while let Some(line) = lines.next(path)? {
        if lines.read <= first.preamble || first.dialect.is_aside(&line) || columns[0].len() as u64 == rows {
            continue;
        }
        let fields = first.dialect.split(&line);
        columns.iter_mut().zip(&places).for_each(|(column, of)| column.push(of.value(&fields)));
    }
    Ok(channels.iter().zip(columns).map(|(channel, samples)| channel.clone().through(|_| samples)).collect())
}

/// Whether the first row counts the columns from 0, as pandas heads a table without names, and the next holds
/// fractions; or from 1, and the next holds nothing else.
fn counts_columns(rows: &[String], dialect: Dialect) -> bool {
    let [first, second, ..] = rows else { return false };
    let fields = dialect.split(first);
    let named = if fields.first() == Some(&"") { &fields[1..] } else { &fields[..] };
    let fraction =
        |field: &str| field.contains(['.', 'e', 'E']) || dialect.decimal_comma && field.contains(',');
    let counts = |from: usize| named.iter().zip(from..).all(|(field, n)| *field == n.to_string());
    let mut below = dialect.split(second).into_iter();
    match named.len() {
        0 => false,
        2.. if counts(1) => below.all(fraction),
        _ => counts(0) && below.any(fraction),
    }
}

/// Whether a line above the table is a row of it with a few fields that are no numbers: names of columns are
/// no fractions.
fn is_damaged_row(line: &str, dialect: Dialect, columns: usize) -> bool {
    let fields = dialect.split(line);
    let fractions = fields.iter().filter(|field| {
        field.contains(if dialect.decimal_comma { ',' } else { '.' })
            && matches!(dialect.field(field), Field::Number(_))
    });
    let fractions = fractions.count();
    let alone = || {
        // A single column has no neighbours to compare with: characters of numbers alone, and no date.
        let signs = fields[0].chars().all(|c| c.is_ascii_digit() || ".,+-eE".contains(c));
        signs && fields[0].len() > 4 && dialect.field(fields[0]) == Field::Text
    };
    fields.len() == columns
        && match columns {
            0 => false,
            1 => alone(),
            2 => fractions > 0,
            _ => 2 * fractions > columns,
        }
}

/// What the first rows say about a head that has a name less than they have columns.
struct FirstRows {
    /// The first column counts the rows, or holds texts alone.
    names_rows: bool,
    /// Columns that rise from row to row.
    rising: Vec<bool>,
}

impl FirstRows {
    fn of(rows: &[&String], dialect: Dialect) -> Self {
        let fields: Vec<Vec<&str>> = rows.iter().take(SAMPLE).map(|row| dialect.split(row)).collect();
        // A separator at the end of a row makes no column.
        if fields.len() < 2
            || fields.iter().any(|row| row.len() < 2 || row.last().is_none_or(|f| f.is_empty()))
        {
            return Self { names_rows: false, rising: Vec::new() };
        }
        let column = |at: usize| {
            fields.iter().map(move |row| row.get(at).map_or(Field::Missing, |field| dialect.field(field)))
        };
        let steps = |at: usize, is_step: &dyn Fn(f64, f64) -> bool| {
            column(at).zip(column(at).skip(1)).all(|pair| match pair {
                (Field::Number(a), Field::Number(b)) => is_step(a, b),
                (Field::Stamp(a, more), Field::Stamp(b, rest)) => (a, more) < (b, rest),
                _ => false,
            })
        };
        let counts = steps(0, &|a, b| a.fract() == 0.0 && b - a == 1.0)
            && column(0).all(|kind| matches!(kind, Field::Number(_)));
        Self {
            names_rows: counts || column(0).all(|kind| kind == Field::Text),
            rising: (0..fields[0].len()).map(|at| steps(at, &|a, b| a < b)).collect(),
        }
    }

    /// Whether names belong to the columns from the second on, as R writes them: the first names the rows, or the
    /// column behind that of a time rises.
    fn leave_the_first(&self, names: &[String]) -> bool {
        let time = names.iter().position(|name| says_time(name));
        self.names_rows || time.is_some_and(|at| self.rising.get(at + 1) == Some(&true))
    }
}

/// Whether the first of `count` rows says the size of the table, `2,16384` or `16384`: one of its whole numbers
/// is that of the rows below, and the others that of the columns, or the rows below have fractions.
fn states_size(rows: &[String], dialect: Dialect, columns: usize, count: u64) -> bool {
    let mut rows = rows.iter().filter(|line| !dialect.is_empty(line));
    let (Some(first), true) = (rows.next(), count > 2) else { return false };
    let whole =
        |field: &&str| dialect.number(field).filter(|x| x.fract() == 0.0 && *x >= 0.0).map(|x| x as u64);
    let sizes: Option<Vec<u64>> = dialect.split(first).iter().map(whole).collect();
    // Some count the row that says it, too.
    let is_count = |n: &u64| *n == count || *n == count - 1;
    let Some(sizes) = sizes.filter(|sizes| sizes.iter().any(is_count)) else { return false };
    let fraction =
        |field: &str| field.contains(['.', 'e', 'E']) || dialect.decimal_comma && field.contains(',');
    let mut below = rows.take(8).map(|row| dialect.split(row).into_iter().any(fraction));
    below.all(|has| has) || sizes.iter().all(|n| is_count(n) || *n == columns as u64)
}

/// Places of the numbers of a row.
fn columns_of_numbers(row: &str, dialect: Dialect) -> Vec<usize> {
    let fields = dialect.split(row).into_iter().enumerate();
    fields.filter(|(_, field)| matches!(dialect.field(field), Field::Number(_))).map(|(at, _)| at).collect()
}

/// Whether a line above the table is a row of it with words beside: it has numbers, one with a fraction at
/// least, where the rows below have theirs. Oscilloscopes write their settings beside the first samples of
/// a record.
fn is_row_beside_words(line: &str, dialect: Dialect, columns: usize, numbers: &[usize]) -> bool {
    let fields = dialect.split(line);
    let of = |at: &usize| fields.get(*at).copied().unwrap_or_default();
    fields.len() == columns
        && numbers.len() > 1
        && numbers.iter().all(|at| matches!(dialect.field(of(at)), Field::Number(_)))
        && numbers.iter().any(|at| of(at).contains(if dialect.decimal_comma { ',' } else { '.' }))
}

/// Fewest samples of rows that are channels.
pub(super) const WIDE: usize = 256;

/// Whether rows are the channels: they are all of the file, few and long, as a vector that was written as a
/// row.
fn lie_across(rows: &[&String], columns: usize) -> bool {
    columns >= WIDE && columns > 16 * rows.len()
}

/// Channels of a table whose rows they are.
fn across(path: &Path, rows: &[&String], dialect: Dialect) -> Result<Recording> {
    let value = |field: &str| match dialect.field(field) {
        Field::Number(x) => x,
        _ => f64::NAN,
    };
    let row = |(n, row): (usize, &&String)| {
        let (mut samples, mut name) = (Vec::new(), None);
        dialect.each(row, |field| {
            if samples.is_empty() && name.is_none() && dialect.field(field) == Field::Text {
                name = Some(field.to_owned());
            } else {
                samples.push(value(field));
            }
        });
        // A separator at the end of a row makes no sample.
        if row.trim_end().ends_with(dialect.separator) {
            samples.pop();
        }
        Channel::held(name.unwrap_or_else(|| format!("row {}", n + 1)), samples)
    };
    let channels = rows.iter().enumerate().map(row).collect();
    let notes = vec!["each row is a channel, as the table has fewer rows than columns".to_owned()];
    Ok(Recording { path: path.to_owned(), format: "CSV", channels, notes })
}

/// Columns of the first rows.
fn columns(rows: &[String], dialect: Dialect) -> usize {
    let counts =
        rows.iter().filter(|line| !dialect.is_empty(line)).take(8).map(|line| dialect.split(line).len());
    counts.max().unwrap_or(0)
}

/// Content of the columns, the number of rows, and irregularities.
fn census(
    path: &Path,
    coding: Coding,
    dialect: Dialect,
    preamble: u64,
    columns: usize,
) -> Result<(Vec<Census>, u64, Vec<String>)> {
    let mut all: Vec<Census> = (0..columns).map(|_| Census::default()).collect();
    let (mut rows, mut notes, mut short) = (0, Vec::new(), None);
    let mut asides = Vec::new();
    // Rows that hold more than there are columns, and the first of them.
    let mut longer: (u64, u64) = (0, 0);
    // The last rows, and in which of the first columns they hold a word.
    let mut tail: VecDeque<(u64, u64)> = VecDeque::new();
    let mut lines = Lines::open(path, coding)?;
    while let Some(line) = lines.next(path)? {
        if lines.read <= preamble || dialect.is_aside(&line) {
            if lines.read > preamble && !dialect.is_empty(&line) {
                asides.push((lines.read, line));
                asides.truncate(ASIDES);
            }
            continue;
        }
        rows += 1;
        let fields = dialect.split(&line);
        short = (fields.len() < columns).then_some(lines.read);
        if fields.iter().skip(columns).any(|field| !field.is_empty()) {
            longer = (longer.0 + 1, if longer.0 == 0 { lines.read } else { longer.1 });
        }
        let mut words = 0;
        for (at, census) in all.iter_mut().enumerate() {
            let field = fields.get(at).copied().unwrap_or_default();
            let kind = dialect.field(field);
            // A damaged number has digits.
            let word = kind == Field::Text && !field.contains(|c: char| c.is_ascii_digit());
            words |= u64::from(word).checked_shl(at as u32).unwrap_or(0);
            census.take(kind, field, lines.read);
        }
        tail.push_back((lines.read, words));
        if tail.len() > SUMMARY {
            tail.pop_front();
        }
    }
    if let (count @ 1.., line) = longer {
        notes.push(format!(
            "rows with more than {columns} fields: {count}, the first in line {line}; what is too many is \
             left out"
        ));
    }
    if let Some((line, text)) = asides.first() {
        let more = if asides.len() < 2 { "" } else { ", and so are others" };
        let text: String = text.chars().take(40).collect();
        notes.push(format!("line {line}, `{text}`, is a comment or the names once more, and no row{more}"));
    }
    if let Some(line) = short {
        notes.push(format!("line {line}, the last, is cut off and left out"));
        rows -= 1;
        tail.pop_back();
    }
    rows -= summary(&mut all, &tail, &mut notes);
    Ok((all, rows, notes))
}

/// Lines that are no rows which are kept.
const ASIDES: usize = 2;

/// Whether the day comes first in dates with slashes, which one for the file decides: a number above 12 is no month,
/// and of two dates the number that changes is the day.
fn day_comes_first(path: &Path, coding: Coding, dialect: Dialect, rows: &[String]) -> Result<bool> {
    let of = |line: &str| dialect.split(line).into_iter().find_map(stamp::slashed);
    let Some(first) = rows.first().and_then(|line| of(line)) else { return Ok(false) };
    let mut lines = Lines::open(path, coding)?;
    while let Some(line) = lines.next(path)? {
        match of(&line) {
            Some((a, _)) if a > 12 => return Ok(true),
            Some((_, b)) if b > 12 => return Ok(false),
            Some((a, b)) if (a == first.0) != (b == first.1) => return Ok(a != first.0),
            _ => {}
        }
    }
    Ok(false)
}

/// Rows at the end of a table that are no samples, at most.
const SUMMARY: usize = 12;

/// How many rows at the end begin with a word where all others have a number: sums and means, which are no
/// samples. With a note.
fn summary(all: &mut [Census], tail: &VecDeque<(u64, u64)>, notes: &mut Vec<String>) -> u64 {
    let Some(at) = all.iter().position(|census| census.refusal().is_none()).filter(|at| *at < 64) else {
        return 0;
    };
    let is_word = |(_, words): &&(u64, u64)| words >> at & 1 == 1;
    let words: Vec<u64> = tail.iter().rev().take_while(is_word).map(|(line, _)| *line).collect();
    let Some(&first) = words.last().filter(|_| words.len() < SUMMARY) else { return 0 };
    // In a table of one column it may be one sample that is no number.
    if all.len() < 2 {
        return 0;
    }
    let census = &mut all[at];
    census.texts -= words.len() as u64;
    let word = census.first.take_if(|(line, _)| *line >= first);
    let word = word.map_or(String::new(), |(_, word)| format!(", which begins with `{word}`"));
    notes.push(format!("the rows from line {first} on{word}, are no samples and are left out"));
    words.len() as u64
}

impl Census {
    fn take(&mut self, kind: Field, field: &str, line: u64) {
        let mut is_plain = true;
        for (sign, of) in SIGNS.into_iter().zip(&mut self.signs).filter(|(sign, _)| field.contains(*sign)) {
            is_plain = false;
            // One fraction decides.
            match if of.fractions > 0 { None } else { groups(field, sign) } {
                Some(Groups::Thousands) => {
                    of.thousands += 1;
                    of.texts += u64::from(kind == Field::Text);
                    of.first.get_or_insert_with(|| (line, field.to_owned()));
                }
                Some(Groups::Fraction) => of.fractions += 1,
                None => {}
            }
        }
        if let (true, Field::Number(x)) = (is_plain, kind) {
            self.plain += 1;
            self.largest = self.largest.max(x.abs());
        }
        match kind {
            Field::Number(_) => self.numbers += 1,
            Field::Stamp(s, _) => {
                self.stamps += 1;
                self.origin_s.get_or_insert(s);
            }
            Field::Missing => self.missing += 1,
            Field::Text => {
                self.texts += 1;
                self.first.get_or_insert_with(|| (line, field.chars().take(40).collect()));
            }
        }
    }

    /// What stands between the thousands of a column, and the first field that has it: behind it are always
    /// three digits, and numbers without it end below 1000, most of their range filled. Such fields are
    /// numbers then.
    fn thousands(&mut self) -> Option<(char, (u64, String))> {
        let filled = self.plain >= FEWEST_PLAIN && (100.0..1000.0).contains(&self.largest);
        let at = self.signs.iter().position(|of| filled && of.thousands > 0 && of.fractions == 0)?;
        let of = &self.signs[at];
        self.texts -= of.texts;
        self.numbers += of.texts;
        self.first.take_if(|(_, text)| groups(text, SIGNS[at]) == Some(Groups::Thousands));
        Some((SIGNS[at], of.first.clone()?))
    }

    /// Why a column is no channel.
    fn refusal(&self) -> Option<String> {
        let held = self.numbers.max(self.stamps);
        if let Some((line, text)) = self.first.as_ref().filter(|_| self.texts > 2 && self.texts > held / FEW)
        {
            return Some(format!("it holds texts, such as `{text}` in line {line}"));
        }
        if self.numbers > 0 && self.stamps > 0 {
            return Some("it holds numbers and time stamps".to_owned());
        }
        (held == 0).then(|| "it is empty".to_owned())
    }
}

/// Writes channels of one length as columns, after a comment line for each of `notes` and a time column when
/// the first channel has a rate. Numbers have all their digits; times fifteen, which leave no rounding in them.
///
/// # Errors
/// [`Error::DoesNotFit`] for channels of different lengths, [`Error::Io`].
pub fn write(path: &Path, channels: &[Channel], notes: &[String]) -> Result<()> {
    let rows = equal_lengths(path, "CSV", channels)?;
    let columns: Vec<Vec<f64>> = channels.iter().map(Channel::read).collect::<Result<_>>()?;
    let io = |e| Error::write(path, e);
    let mut file = BufWriter::new(File::create(path).map_err(io)?);
    let rate = channels
        .first()
        .and_then(|c| c.rate_hz)
        .filter(|_| channels.iter().all(|c| !c.name.starts_with("time")));
    let mut text = String::new();
    notes.iter().for_each(|note| text += &format!("# {}\n", note.replace('\n', " ")));
    let time = rate.map(|_| "time_s".to_owned());
    let names: Vec<String> =
        time.into_iter().chain(channels.iter().map(|c| c.name.replace(',', ";"))).collect();
    text += &(names.join(",") + "\n");
    let is_time: Vec<bool> = channels.iter().map(|c| c.is_time || c.name.starts_with("time")).collect();
    let value = |x: f64, is_time| if is_time { in_fifteen_digits(x) } else { format!("{x:?}") };
    for row in 0..rows as usize {
        let time = rate.map(|hz| in_fifteen_digits(row as f64 / hz));
        let columns = columns.iter().zip(&is_time).map(|(c, is_time)| value(c[row], *is_time));
        let values = time.into_iter().chain(columns);
        text += &values.collect::<Vec<_>>().join(",");
        text.push('\n');
        if text.len() > 1 << 16 {
            file.write_all(text.as_bytes()).map_err(io)?;
            text.clear();
        }
    }
    file.write_all(text.as_bytes()).map_err(io)?;
    file.flush().map_err(io)
}

/// `1e-5` where a product of steps is 9.999999999999999e-6.
fn in_fifteen_digits(x: f64) -> String {
    format!("{x:.14e}").parse::<f64>().map_or_else(|_| format!("{x:?}"), |x| format!("{x:?}"))
}

impl Column {
    /// The number in a row of fields.
    fn value(&self, fields: &[&str]) -> f64 {
        let field = fields.get(self.at).copied().unwrap_or_default();
        let ungrouped =
            self.thousands.filter(|sign| field.contains(*sign)).map(|sign| field.replace(sign, ""));
        match self.dialect.field(ungrouped.as_deref().unwrap_or(field)) {
            Field::Number(x) => x,
            Field::Stamp(s, ns) => s.saturating_sub(self.origin_s) as f64 + 1e-9 * f64::from(ns),
            Field::Missing | Field::Text => f64::NAN,
        }
    }
}

impl Samples for Column {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let mut lines = Lines::open(&self.path, self.coding)?;
        let mut block = Vec::with_capacity(BLOCK);
        let mut left = len;
        while left > 0 {
            let Some(line) = lines.next(&self.path)? else { break };
            if lines.read <= self.preamble || self.dialect.is_aside(&line) {
                continue;
            }
            let fields = self.dialect.split(&line);
            block.push(self.value(&fields));
            left -= 1;
            if block.len() == BLOCK {
                if !take(&block) {
                    return Ok(());
                }
                block.clear();
            }
        }
        if !block.is_empty() {
            take(&block);
        }
        Ok(())
    }
}
