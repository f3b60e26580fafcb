//! Texts: tables in the dialects that programs write, and lines damaged one by one.

use serde_json::json;

use super::Made;
use crate::fuzz::damage;
use stribeck_scene::dice::Dice;

/// Rows of a table.
const ROWS: usize = 48;
const RATE_HZ: f64 = 12_800.0;

/// Heads of the time with its seconds, and of signals.
const TIMES: [(&str, f64); 8] = [
    ("time_s", 1.0),
    ("t [ms]", 1e-3),
    ("Time (ms)", 1e-3),
    ("Zeit/ms", 1e-3),
    ("t_us", 1e-6),
    ("Time [s]", 1.0),
    ("time (µs)", 1e-6),
    ("Timestamp_ms", 1e-3),
];
const SIGNALS: [&str; 8] =
    ["acc", "acc [g]", "Beschl. (m/s²)", "x", "Channel 1", "a/g", "Voltage_0 (V)", "vib;1"];
/// Units in a row of their own: that of the time with its seconds.
const UNITS: [(&str, f64); 4] = [("ms", 1e-3), ("s", 1.0), ("[ms]", 1e-3), ("(us)", 1e-6)];
/// Lines above a table.
const ABOVE: [&str; 6] = [
    "Messung vom Pruefstand 7",
    "# recorded by a logger",
    "Sample rate: see below",
    "Serial 4711 Rev B",
    "DATE 2024-05-01",
    "Data",
];

/// How a table is written.
struct Form {
    separator: char,
    comma: bool,
    quoted: bool,
    end: &'static str,
    /// A separator at the end of each row.
    trailing: bool,
    digits: usize,
    exponent: bool,
}

impl Form {
    fn of(dice: &mut Dice) -> Self {
        let separator = [',', ';', '\t', '|', ' ', ','][dice.below(6)];
        Self {
            separator,
            comma: separator != ',' && dice.one_in(2),
            quoted: separator != ' ' && dice.one_in(5),
            end: ["\n", "\r\n", "\n", "\r"][dice.below(4)],
            trailing: separator != ' ' && dice.one_in(8),
            digits: 4 + dice.below(9),
            exponent: dice.one_in(6),
        }
    }

    fn number(&self, x: f64) -> String {
        let digits = self.digits;
        let text = if self.exponent { format!("{x:.digits$e}") } else { format!("{x:.digits$}") };
        if self.comma { text.replace('.', ",") } else { text }
    }

    fn row(&self, fields: &[String]) -> String {
        let own = |field: &String| {
            let needs = field.contains(self.separator) || self.separator == ' ' && field.contains(' ');
            if self.quoted || needs { format!("\"{field}\"") } else { field.clone() }
        };
        let fields: Vec<String> = fields.iter().map(own).collect();
        let mut row = fields.join(&self.separator.to_string());
        if self.trailing {
            row.push(self.separator);
        }
        row + self.end
    }
}

/// A table in some dialect, damaged or not, with the arguments with which pandas reads it.
pub(super) fn table(dice: &mut Dice) -> Made {
    let form = Form::of(dice);
    let (timed, columns) = (!dice.one_in(4), 1 + dice.below(3));
    let above = dice.below(4).saturating_sub(1);
    // Above a table without separators any text is as good a row as another.
    let (named, with_units) = (dice.below(5) > 0, dice.one_in(4));
    let with_units = with_units && named && timed;
    let mut text: String = (0..above).map(|_| dice.pick(&ABOVE).to_owned() + form.end).collect();
    let mut second = TIMES[dice.below(TIMES.len())];
    let mut names: Vec<String> = (0..columns).map(|n| format!("{}{n}", dice.pick(&SIGNALS))).collect();
    if with_units {
        second = ("Time", 1.0);
        names = (0..columns).map(|n| format!("acc{n}")).collect();
    }
    if timed {
        names.insert(0, second.0.to_owned());
    }
    if form.separator == ' ' {
        names = names.iter().map(|name| name.replace(' ', "_")).collect();
    }
    if named {
        text += &form.row(&names);
    }
    let mut skipped: Vec<usize> = (0..above).collect();
    if with_units {
        let unit = UNITS[dice.below(UNITS.len())];
        second.1 = unit.1;
        let others = (0..columns).map(|_| dice.pick(&["g", "m/s²", "mm/s", "V", "EU"]).to_owned());
        text += &form.row(&std::iter::once(unit.0.to_owned()).chain(others).collect::<Vec<_>>());
        skipped.push(above + 1);
    }
    // What pandas is told of the head must stay true.
    let head = text.len();
    let missing = dice.one_in(6).then(|| dice.pick(&["", "NaN", "nan", "N/A"]).to_owned());
    for n in 0..ROWS {
        let signal = |k: usize| form.number(((n * (37 + 2 * k) % 101) as f64 - 50.0) / 50.0);
        let mut row: Vec<String> = (0..columns).map(signal).collect();
        if let (Some(word), 20, false) = (&missing, n, form.separator == ' ' || columns < 2) {
            row[columns - 1].clone_from(word);
        }
        if timed {
            row.insert(0, form.number(n as f64 / RATE_HZ / second.1));
        }
        text += &form.row(&row);
    }
    let (encoding, bytes, head) = encoded(&text, head, dice);
    // A rate follows from times that have the digits.
    let fine = timed && named && (form.exponent || second.1 < 1.0 || form.digits > 6);
    let separator = if form.separator == ' ' { r"\s+".to_owned() } else { form.separator.to_string() };
    let told = json!({
        "sep": separator,
        "decimal": if form.comma { "," } else { "." },
        "encoding": encoding,
        "skiprows": skipped,
        "header": if named { json!(0) } else { json!(null) },
        "skip_blank_lines": true,
    });
    let (done, bytes) = match dice.below(4) {
        0 | 1 => ("nothing: its dialect", bytes),
        2 => behind(&bytes, head, damage::fields, dice),
        _ => behind(&bytes, head, lines, dice),
    };
    let rate_hz = (fine && done.starts_with("nothing")).then_some(RATE_HZ);
    Made {
        kind: "csv",
        from: format!("a table split by {:?}", form.separator),
        done,
        bytes,
        told: Some(told),
        rate_hz,
    }
}

/// The text in one of the encodings that programs write, and the bytes of its first `head` ones.
fn encoded(text: &str, head: usize, dice: &mut Dice) -> (&'static str, Vec<u8>, usize) {
    let latin = |text: &str| text.chars().map(|c| c as u32 as u8).collect::<Vec<u8>>();
    let wide = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    match dice.below(8) {
        0 => ("utf-8-sig", ["\u{feff}".as_bytes(), text.as_bytes()].concat(), head + 3),
        1 => ("cp1252", latin(text), latin(&text[..head]).len()),
        2 => ("utf-16", [vec![0xff, 0xfe], wide(text)].concat(), wide(&text[..head]).len() + 2),
        _ => ("utf-8", text.as_bytes().to_vec(), head),
    }
}

/// Damages the bytes after the first `head`.
fn behind(
    bytes: &[u8],
    head: usize,
    damaged: impl Fn(&[u8], &mut Dice) -> (&'static str, Vec<u8>),
    dice: &mut Dice,
) -> (&'static str, Vec<u8>) {
    let (done, rest) = damaged(&bytes[head..], dice);
    (done, [&bytes[..head], &rest].concat())
}

/// Damages lines of a text as an editor, an export or an incomplete copy does.
pub(super) fn lines(good: &[u8], dice: &mut Dice) -> (&'static str, Vec<u8>) {
    let mut lines: Vec<Vec<u8>> = good.split_inclusive(|b| *b == b'\n').map(<[u8]>::to_vec).collect();
    let at = dice.below(lines.len());
    let digits: Vec<usize> = (0..lines[at].len()).filter(|n| lines[at][*n].is_ascii_digit()).collect();
    let done = match dice.below(9) {
        0 => {
            lines.remove(at);
            "a line is missing"
        }
        1 => {
            let line = lines[at].clone();
            lines.insert(at, line);
            "a line stands twice"
        }
        2 => {
            lines.truncate(at + 1);
            let half = lines[at].len() / 2;
            lines[at].truncate(half);
            "it is cut off"
        }
        3 | 4 if !digits.is_empty() => {
            lines[at][digits[dice.below(digits.len())]] = b'0' + dice.below(10) as u8;
            "a digit is another"
        }
        5 if !digits.is_empty() => {
            lines[at].insert(digits[dice.below(digits.len())], b"0123456789-.,"[dice.below(13)]);
            "a sign too many"
        }
        6 if !digits.is_empty() => {
            lines[at].remove(digits[dice.below(digits.len())]);
            "a digit too few"
        }
        7 => {
            lines.insert(at, b"\r\n".to_vec());
            "an empty line"
        }
        _ => {
            let word: &[u8] = [&b"error"[..], b"-", b"1e999", b"NaN", b"\"", b"#"][dice.below(6)];
            let place = dice.below(lines[at].len());
            lines[at].splice(place..place, word.iter().copied());
            "a word too many"
        }
    };
    (done, lines.concat())
}
