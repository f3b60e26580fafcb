//! What the readings of many files are counted to: by format, each kind of difference with its reason, and
//! each of our reasons to refuse a file that the other program reads.

use std::collections::BTreeMap;
use std::time::Duration;

use stribeck_studies::Rows;

use super::judge::Verdict;
use super::{Made, Reading};

/// A file that both have read.
pub(super) struct Seen {
    pub(super) seed: u64,
    pub(super) made: Made,
    pub(super) ours: Reading,
    pub(super) verdict: Verdict,
}

/// What becomes of a file, in the order of the table.
const ENDS: [&str; 7] =
    ["equal", "we have fewer", "they have fewer", "both refuse", "we refuse", "they refuse", "differ"];

/// Files of one kind, with the smallest example.
#[derive(Debug, Clone, Default)]
struct Kind {
    count: u64,
    bytes: usize,
    seed: u64,
    example: String,
}

/// All that was seen.
#[derive(Debug, Default)]
pub(super) struct Tables {
    counts: BTreeMap<&'static str, [u64; 7]>,
    /// By format, in what and by what damage they differ.
    kinds: BTreeMap<(&'static str, &'static str, &'static str), Kind>,
    /// By format and our reason to refuse a file that they read.
    refusals: BTreeMap<(&'static str, String), Kind>,
    pub(super) panics: Vec<String>,
    slowest: Duration,
}

/// What reads each format beside us.
fn reader(kind: &str) -> &'static str {
    match kind {
        "npy" | "npz" => "NumPy",
        "mat" => "SciPy",
        "h5" => "h5py",
        "tdms" => "npTDMS",
        "mf4" => "asammdf",
        "parquet" => "pyarrow",
        "wav" | "flac" => "soundfile",
        "uff" => "pyuff",
        "csv" => "pandas",
        _ => "meshio",
    }
}

/// Differences of which examples were looked at and lie with the other program: format, in what (all where it
/// is empty), by what damage (all where it is empty), and why.
const EXPLAINED: [(&str, &str, &str, &str); 13] = [
    ("csv", "", "it is cut off", "pandas keeps the row that breaks off; we leave it out, with a note"),
    ("csv", "samples", "", LINES),
    ("csv", "numbers among the samples", "", LINES),
    ("csv", "rms", "", LINES),
    (
        "wav",
        "samples",
        "a piece stands twice",
        "two sizes in the head of an RF64 file: soundfile takes the 64-bit one, we take all to the end of \
         the file, with a note",
    ),
    (
        "h5",
        "rms",
        "a bit is turned",
        "a type of floats without the leading bit of their mantissa, which no processor has: h5py converts \
         them; we take the usual type of that size",
    ),
    (
        "mf4",
        "rms",
        "",
        "a conversion whose block is damaged beside its numbers: asammdf leaves the conversion out, we apply it",
    ),
    (
        "msh",
        "rms",
        "",
        "a total of nodes, or the number of a node without elements, is damaged: meshio takes numbers from \
         memory that it has not filled, we take the nodes of the blocks",
    ),
    ("inp", "samples", "", SAME_ELEMENT),
    ("msh", "samples", "", SAME_ELEMENT),
    (
        "tdms",
        "samples",
        "",
        "npTDMS shares an incomplete chunk among the channels in the midst of a file, too; we leave it \
         out, with a note",
    ),
    (
        "uff",
        "samples",
        "",
        "pyuff takes all numbers up to the delimiter; we take those that the head promises, with a note",
    ),
    ("uff", "rms", "", "pyuff cuts numbers that are wider than the format's columns; we read them whole"),
];

const LINES: &str = "a quote or the end of a line is damaged: pandas lets a quoted field run over lines and \
    ends rows at any of CR, LF and both; we keep to lines, and to the end that most of them have";

const SAME_ELEMENT: &str = "an element that stands twice, with one number and the same nodes, is one of ours \
    and two of meshio's; a quadrilateral with a corner twice is a triangle of ours";

impl Tables {
    pub(super) fn took(&mut self, time: Duration) {
        self.slowest = self.slowest.max(time);
    }

    pub(super) fn take(&mut self, seen: Seen) {
        let Seen { seed, made, ours, verdict } = seen;
        let end = match &verdict {
            Verdict::Equal => 0,
            Verdict::OursHasFewer => 1,
            Verdict::TheirsHasFewer => 2,
            Verdict::BothRefuse => 3,
            Verdict::OursRefuses => 4,
            Verdict::TheirsRefuses => 5,
            Verdict::Differ(..) => 6,
        };
        self.counts.entry(made.kind).or_default()[end] += 1;
        let (kind, example) = match (&verdict, &ours) {
            (Verdict::Differ(what, words), _) => {
                (self.kinds.entry((made.kind, what, made.done)).or_default(), words.clone())
            }
            (Verdict::OursRefuses, Err(why)) => {
                (self.refusals.entry((made.kind, gist(why))).or_default(), why.clone())
            }
            _ => return,
        };
        kind.count += 1;
        if kind.count == 1 || made.bytes.len() < kind.bytes {
            *kind = Kind { count: kind.count, bytes: made.bytes.len(), seed, example };
        }
    }

    pub(super) fn differing(&self) -> u64 {
        self.counts.values().map(|ends| ends[6]).sum()
    }

    /// Differences that no line of [`EXPLAINED`] covers.
    pub(super) fn unexplained(&self) -> u64 {
        let open = self.kinds.iter().filter(|((kind, what, done), _)| explained(kind, what, done).is_none());
        open.map(|(_, k)| k.count).sum()
    }

    /// Values of the page, of `files` that we have read and of `compared` that the others have, too.
    pub(super) fn rows(&self, [files, compared]: [u64; 2], first: u64, versions: &str) -> Rows {
        let mut rows = Rows::default();
        let values = [
            ("files", files as f64),
            ("compared", compared as f64),
            ("first seed", first as f64),
            ("panics", self.panics.len() as f64),
        ];
        rows.values("all", "all", values);
        rows.value("all", "all", "peak MiB", stribeck::host::peak_memory_mib().unwrap_or(f64::NAN));
        rows.value("all", "all", "slowest s", self.slowest.as_secs_f64());
        rows.word("all", "all", "versions", versions);
        for (kind, ends) in &self.counts {
            rows.word("formats", kind, "other reader", reader(kind));
            rows.value("formats", kind, "files", ends.iter().sum::<u64>() as f64);
            rows.values("formats", kind, ENDS.into_iter().zip(ends.map(|n| n as f64)));
        }
        let mut put = |table: &str, name: &str, k: &Kind| {
            let values = [("files", k.count as f64), ("bytes", k.bytes as f64), ("seed", k.seed as f64)];
            rows.values(table, name, values);
            rows.word(table, name, "example", &cell(&k.example));
        };
        for ((kind, what, done), k) in &self.kinds {
            put("differences", &format!("{kind}: {what}, {done}"), k);
        }
        for ((kind, why), k) in &self.refusals {
            put("refusals", &format!("{kind}: {why}"), k);
        }
        let mut reasons: BTreeMap<(&str, &str), u64> = BTreeMap::new();
        for ((kind, what, done), k) in &self.kinds {
            *reasons
                .entry((kind, explained(kind, what, done).unwrap_or("**not explained**")))
                .or_default() += k.count;
        }
        for ((kind, why), count) in reasons {
            rows.value("reasons", &format!("{kind}: {why}"), "files", count as f64);
        }
        rows
    }
}

fn explained(kind: &str, what: &str, done: &str) -> Option<&'static str> {
    let any = |own: &str, of: &str| own.is_empty() || own == of;
    let found = EXPLAINED.iter().find(|of| of.0 == kind && any(of.1, what) && any(of.2, done));
    found.map(|of| of.3)
}

/// A message without the path of its file, quoted text and words with digits: messages of one kind are
/// one.
fn gist(why: &str) -> String {
    let mut quoted = false;
    let plain = |c: &char| {
        quoted ^= *c == '`';
        !quoted && *c != '`'
    };
    let kept: String = why.chars().filter(plain).collect();
    let words = kept.split_whitespace().filter(|word| !word.contains(|c: char| c.is_ascii_digit()));
    words.take(12).collect::<Vec<_>>().join(" ")
}

/// The beginning of a text, without the folder of its file.
fn cell(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let text = match text.split_once("` ") {
        Some((path, rest)) if path.starts_with('`') && path.contains("stribeck-fuzz") => rest.to_owned(),
        _ => text,
    };
    text.chars().take(150).collect()
}
