//! Universal files, dataset 58 (function at nodal degree of freedom): ASCII, and binary as 58b.
//!
//! Source: *Universal File Datasets*, Structural Dynamics Research Laboratory, University of Cincinnati.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use crate::number::{Kind, Number};
use crate::units::seconds;
use crate::{Channel, Error, Recording, Result};

const FORMAT: &str = "UFF 58";
/// Lines of a dataset before its data: five of text, six of numbers.
const HEAD: usize = 11;

/// Whether a file begins with a delimiter, `-1` in columns 5 and 6.
pub(crate) fn recognise(start: &[u8]) -> bool {
    let mut lines = start.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty());
    lines.next() == Some(b"-1")
}

/// Opens a file: each evenly sampled real function is a channel, held in memory.
pub fn open(path: &Path) -> Result<Recording> {
    let (mut channels, mut notes): (Vec<Channel>, Vec<String>) = (Vec::new(), Vec::new());
    let mut broken = None;
    for (begins, found) in datasets(path)? {
        let dataset = match found {
            Found::Function(dataset) => dataset,
            Found::Other(kind) => {
                notes.push(format!("the dataset of line {begins} has the number {kind}, not 58"));
                continue;
            }
            // One dataset that is damaged does not spoil the others.
            Found::Damaged(what) => {
                notes.push(format!("the {what}: it is left out"));
                broken.get_or_insert(what);
                continue;
            }
        };
        match dataset.channel() {
            Ok(mut channel) => {
                notes.extend(dataset.odd.map(|odd| format!("`{}`: {odd}", channel.name)));
                let twins =
                    channels.iter().filter(|c| c.name.split(" #").next() == Some(&channel.name)).count();
                if twins > 0 {
                    channel.name += &format!(" #{}", twins + 1);
                }
                channels.push(channel);
            }
            Err(why) => notes.push(format!("the dataset of line {begins} is left out: {why}")),
        }
    }
    if let (Some(what), true) = (broken, channels.is_empty()) {
        return Err(Error::damaged(path, FORMAT, what));
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes })
}

enum Found {
    Function(Dataset),
    /// Another one than 58: its number.
    Other(String),
    /// Its fault, and where.
    Damaged(String),
}

/// All datasets of a file with the line in which each begins.
fn datasets(path: &Path) -> Result<Vec<(usize, Found)>> {
    let bytes = std::fs::read(path).map_err(|e| Error::read(path, e))?;
    let mut lines = Lines { bytes: &bytes, at: 0, line: 0 };
    let mut all = Vec::new();
    while let Some(line) = lines.next() {
        if line.trim() != "-1" {
            continue;
        }
        let Some(kind) = lines.next() else { break };
        let begins = lines.line;
        if kind.trim() == "58" || kind.trim_start().starts_with("58b") {
            let found = match lines.dataset(&kind) {
                Ok(dataset) => Found::Function(dataset),
                Err(what) => {
                    Found::Damaged(format!("dataset of line {begins}, near line {}: {what}", lines.line))
                }
            };
            all.push((begins, found));
        } else {
            all.push((begins, Found::Other(kind.trim().chars().take(20).collect())));
        }
        // To the delimiter that ends the dataset.
        while lines.next().is_some_and(|line| line.trim() != "-1") {}
    }
    Ok(all)
}

/// Writes each channel as an ASCII dataset of doubles, thirteen digits each; `notes` takes the first lines of
/// text.
///
/// # Errors
/// [`Error::DoesNotFit`] for a channel without a rate, [`Error::Io`].
pub fn write(path: &Path, channels: &[Channel], notes: &[String]) -> Result<()> {
    let io = |e| Error::write(path, e);
    let mut file = BufWriter::new(File::create(path).map_err(io)?);
    for channel in channels {
        let Some(rate_hz) = channel.rate_hz else {
            let what = format!("`{}` has no sample rate", channel.name);
            return Err(Error::DoesNotFit { path: path.to_owned(), format: FORMAT, what });
        };
        let cut = |text: &str, width: usize| {
            text.chars().map(|c| if c.is_ascii() { c } else { '?' }).take(width).collect::<String>()
        };
        let unit = channel.unit.as_deref().unwrap_or("NONE");
        // Specific data types of the format: 12 acceleration, 9 force, 8 displacement, 11 velocity, 0
        // unknown.
        let sort = match unit {
            "m/s^2" | "g" => 12,
            "N" => 9,
            "m" => 8,
            "m/s" => 11,
            _ => 0,
        };
        let mut text = format!("{:>6}\n{:>6}{:74}\n", -1, 58, "");
        text += &format!("{:<80}\n", cut(&channel.name, 80));
        for n in 0..4 {
            text += &format!("{:<80}\n", cut(notes.get(n).map_or("NONE", String::as_str), 80));
        }
        text += &format!(
            "{:5}{:10}{:5}{:10} {:<10}{:10}{:4} {:<10}{:10}{:4}\n",
            1, 0, 1, 0, "NONE", 0, 0, "NONE", 0, 0
        );
        text +=
            &format!("{:10}{:10}{:10}{}{}{}\n", 4, channel.len, 1, e13(0.0), e13(1.0 / rate_hz), e13(0.0));
        text += &format!("{:10}{:5}{:5}{:5} {:<20} {:<20}\n", 17, 0, 0, 0, "Time", "s");
        text += &format!(
            "{:10}{:5}{:5}{:5} {:<20} {:<20}\n",
            sort,
            0,
            0,
            0,
            cut(&channel.name, 20),
            cut(unit, 20)
        );
        for _ in 0..2 {
            text += &format!("{:10}{:5}{:5}{:5} {:<20} {:<20}\n", 0, 0, 0, 0, "NONE", "NONE");
        }
        file.write_all(text.as_bytes()).map_err(io)?;
        for row in channel.read()?.chunks(4) {
            let line: String = row.iter().map(|x| format!("{:>20}", exponent(*x, 12))).collect();
            writeln!(file, "{line}").map_err(io)?;
        }
        writeln!(file, "{:>6}", -1).map_err(io)?;
    }
    file.flush().map_err(io)
}

/// A number as FORTRAN's E13.5 has it.
fn e13(x: f64) -> String {
    format!("{:>13}", exponent(x, 5))
}

/// `1.25E+02`: FORTRAN requires a sign and two digits.
fn exponent(x: f64, digits: usize) -> String {
    if !x.is_finite() {
        return "NaN".to_owned();
    }
    let text = format!("{x:.digits$E}");
    let (mantissa, power) = text.split_once('E').unwrap_or((&text, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    format!("{mantissa}E{}{:02}", if power < 0 { '-' } else { '+' }, power.abs())
}

/// Numbers of a line of the head; NaN for other words.
fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().map(|w| w.parse::<f64>().unwrap_or(f64::NAN)).collect()
}

/// A dataset 58 as it stands in the file.
struct Dataset {
    head: Vec<String>,
    count: usize,
    complex: bool,
    even: bool,
    /// Abscissa of the first value, and the step, where they are even.
    first: f64,
    increment: f64,
    /// Abscissa where uneven, real part, imaginary part where complex; value by value.
    values: Vec<f64>,
    /// Notes on its irregularities.
    odd: Option<String>,
}

impl Dataset {
    fn name(&self) -> &str {
        let lines = [self.head[0].trim(), self.head[1].trim()];
        lines.into_iter().find(|n| !n.is_empty() && *n != "NONE").unwrap_or("function")
    }

    /// Unit of an axis whose line of the head this is.
    fn unit(&self, line: usize) -> Option<String> {
        let text = self.head[line].get(47..).map(|rest| rest.chars().take(20).collect::<String>());
        text.map(|unit| unit.trim().to_owned()).filter(|unit| !unit.is_empty() && *unit != "NONE")
    }

    /// As a signal in time, or why it is none.
    fn channel(&self) -> std::result::Result<Channel, String> {
        if self.complex {
            return Err("its values are complex: it is no signal in time".to_owned());
        }
        if !matches!(numbers(&self.head[7]).first(), Some(17.0 | 0.0)) {
            return Err(format!("its abscissa is `{}`, not the time", self.head[7].trim()));
        }
        let (values, count) = (&self.values, self.count);
        let (samples, rate_hz) = if self.even {
            (values[..count].to_vec(), 1.0 / self.increment)
        } else {
            let times: Vec<f64> = values.chunks(2).take(count).map(|pair| pair[0]).collect();
            let step =
                (times.last().unwrap_or(&0.0) - times.first().unwrap_or(&0.0)) / (count.max(2) - 1) as f64;
            let off = |(n, t): (usize, &f64)| (t - times[0] - n as f64 * step).abs() > 0.01 * step;
            if times.iter().enumerate().any(off) {
                return Err("its samples are not evenly spaced; resample it first".to_owned());
            }
            (values.chunks(2).take(count).map(|pair| pair[1]).collect(), 1.0 / step)
        };
        // Some writers count in milliseconds, and say so.
        let second = self.unit(7).and_then(|unit| seconds(&unit)).map_or(1.0, |(_, second)| second);
        let rate_hz = rate_hz / second;
        let first = if self.even { self.first } else { values.first().copied().unwrap_or(f64::NAN) };
        let start_s = Some(first * second).filter(|s| s.is_finite());
        // The increment has six digits: a rate is a round number more often than not.
        let round = (rate_hz * 10.0).round() / 10.0;
        let rate_hz = if (rate_hz / round - 1.0).abs() < 5e-6 { round } else { rate_hz };
        let rate_hz = Some(rate_hz).filter(|hz| hz.is_finite() && *hz > 0.0);
        Ok(Channel::held(self.name(), samples).at_rate(rate_hz).from_time(start_s).in_unit(self.unit(8)))
    }
}

struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl Lines<'_> {
    fn next(&mut self) -> Option<String> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
        self.at += end + 1;
        self.line += 1;
        Some(String::from_utf8_lossy(&rest[..end]).trim_end_matches('\r').to_owned())
    }

    /// The dataset behind its first line.
    fn dataset(&mut self, kind: &str) -> std::result::Result<Dataset, String> {
        let head: Vec<String> = (0..HEAD).filter_map(|_| self.next()).collect();
        if head.len() < HEAD {
            return Err("it ends inside its head".to_owned());
        }
        let form = numbers(&head[6]);
        let [ordinate, count, spacing, first, increment, ..] = form[..] else {
            return Err(format!("its data form `{}` is not six numbers", head[6].trim()));
        };
        let count = if (0.0..1e10).contains(&count) {
            count as usize
        } else {
            return Err("it has no number of values".to_owned());
        };
        let (double, complex) = (ordinate == 4.0 || ordinate == 6.0, ordinate > 4.5);
        let even = spacing == 1.0;
        let width = 1 + usize::from(complex) + usize::from(!even);
        let values = if kind.trim_start().starts_with("58b") {
            self.binary(kind, count, double, complex, even)?
        } else {
            self.text(count * width, double, complex, even)?
        };
        let there = (values.len() / width).min(count);
        if there == 0 && count > 0 {
            return Err(format!("it promises {count} values, and none follow"));
        }
        let more = self.rows_left();
        let odd = if there < count {
            Some(format!("it promises {count} values, and {there} are there: it was cut off"))
        } else {
            (more > 0).then(|| {
                format!("it promises {count} values, and {more} lines more follow: they are left out")
            })
        };
        Ok(Dataset { head, count: there, complex, even, first, increment, values, odd })
    }

    /// Lines up to the delimiter that ends the dataset, which stays.
    fn rows_left(&mut self) -> usize {
        let (at, line) = (self.at, self.line);
        let mut rows = 0;
        while let Some(line) = self.next().filter(|line| line.trim() != "-1") {
            rows += usize::from(!line.trim().is_empty());
        }
        (self.at, self.line) = (at, line);
        rows
    }

    /// Numbers in columns: 13 wide, 20 wide for doubles; uneven doubles have their abscissae 13 wide.
    fn text(
        &mut self,
        wanted: usize,
        double: bool,
        complex: bool,
        even: bool,
    ) -> std::result::Result<Vec<f64>, String> {
        let mut values = Vec::with_capacity(wanted.min(self.bytes.len() / 2));
        let parse = |word: &str| word.trim().replace(['D', 'd'], "E").parse::<f64>();
        while values.len() < wanted {
            let from = self.at;
            let Some(line) = self.next() else { break };
            if line.trim() == "-1" {
                (self.at, self.line) = (from, self.line - 1);
                break;
            }
            let widths: &[usize] = match (double, even, complex) {
                (false, ..) => &[13],
                (true, true, _) => &[20],
                (true, false, false) => &[13, 20],
                (true, false, true) => &[13, 20, 20],
            };
            let mut rest = line.as_str();
            let mut columns = Vec::new();
            for width in widths.iter().cycle() {
                if rest.trim().is_empty() {
                    break;
                }
                let (word, behind) =
                    rest.split_at_checked((*width).min(rest.len())).ok_or("its line is no text")?;
                columns.push(word);
                rest = behind;
            }
            // Many programs do not keep to the columns; in those of others, of 80 signs, numbers touch.
            let fixed = columns.into_iter().map(parse).collect::<std::result::Result<Vec<f64>, _>>();
            let free = line.split_whitespace().map(parse).collect::<std::result::Result<Vec<f64>, _>>();
            let fixed = fixed.ok().filter(|_| line.trim_end().len() <= 80);
            let row = free.ok().or(fixed).ok_or_else(|| format!("`{}` is no row of numbers", line.trim()))?;
            values.extend(row);
        }
        Ok(values)
    }

    /// Numbers as bytes, as many as in the first line of the dataset.
    fn binary(
        &mut self,
        kind: &str,
        count: usize,
        double: bool,
        complex: bool,
        even: bool,
    ) -> std::result::Result<Vec<f64>, String> {
        let fields: Vec<u64> = kind.split_whitespace().skip(1).map(|w| w.parse().unwrap_or(0)).collect();
        let [order, format, _, bytes, ..] = fields[..] else {
            return Err("its first line does not say the byte order and length".to_owned());
        };
        if format != 2 {
            return Err(format!("its floating point format is {format}; IEEE (2) is read"));
        }
        let width = if double { 8 } else { 4 };
        let parts = 1 + usize::from(complex);
        let needed = count.saturating_mul(parts * width + if even { 0 } else { 4 });
        // pyuff counts a complex value once, although its two parts follow.
        let there = self.bytes.len().saturating_sub(self.at);
        let halved = complex && bytes < needed as u64 && there >= needed;
        let bytes = if halved { needed as u64 } else { bytes };
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let data = &rest[..rest.len().min(usize::try_from(bytes).unwrap_or(usize::MAX))];
        self.at += data.len();
        // Bytes that are missing would take those of the delimiter for numbers.
        let behind = &rest[data.len()..];
        let ends = behind.trim_ascii_start().starts_with(b"-1");
        if data.len() as u64 == bytes && !ends && !behind.trim_ascii().is_empty() {
            return Err(format!("no delimiter stands behind its {bytes} bytes"));
        }
        if (data.len() as u64) < bytes && data.trim_ascii_end().ends_with(b"    -1") {
            return Err(format!("it promises {bytes} bytes, and a delimiter stands before their end"));
        }
        let number = |kind| Number { kind, big_endian: order == 2 };
        let (single, ordinate) = (number(Kind::F32), number(if double { Kind::F64 } else { Kind::F32 }));
        if even {
            return Ok(data.chunks_exact(width).map(|at| ordinate.decode(at)).collect());
        }
        let row = |at: &[u8]| -> Vec<f64> {
            let ordinates = at[4..].chunks_exact(width).map(|part| ordinate.decode(part));
            std::iter::once(single.decode(at)).chain(ordinates).collect()
        };
        Ok(data.chunks_exact(4 + parts * width).flat_map(row).collect())
    }
}
