//! The page of how the readings compare: counts by format, and each kind of difference with its reason.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::time::Duration;

use super::judge::Verdict;
use super::{Made, Reading};

/// A file that both have read.
pub(super) struct Seen {
    pub(super) seed: u64,
    pub(super) made: Made,
    pub(super) ours: Reading,
    pub(super) verdict: Verdict,
}

/// Counts of one format.
#[derive(Debug, Default, Clone, Copy)]
struct Counts {
    files: u64,
    equal: u64,
    ours_fewer: u64,
    theirs_fewer: u64,
    both_refuse: u64,
    ours_refuses: u64,
    theirs_refuses: u64,
    differ: u64,
}

/// A kind of difference, with its smallest example.
#[derive(Debug, Clone)]
struct Kind {
    count: u64,
    bytes: usize,
    seed: u64,
    example: String,
}

/// All that was seen.
#[derive(Debug, Default)]
pub(super) struct Tables {
    counts: BTreeMap<&'static str, Counts>,
    /// By format and kind of difference.
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
const EXPLAINED: [(&str, &str, &str, &str); 10] = [
    (
        "csv",
        "",
        "it is cut off",
        "pandas keeps the row that breaks off, with what is left of its last number; we leave it out, \
         with a note",
    ),
    ("csv", "samples", "", LINES),
    ("csv", "numbers among the samples", "", LINES),
    ("csv", "rms", "a bit is turned", LINES),
    (
        "wav",
        "samples",
        "a piece stands twice",
        "in the head of an RF64 file the size of the data is another than the mark that sends to the 64-bit \
         one: soundfile takes the latter, we take all to the end of the file, with a note",
    ),
    ("inp", "samples", "", SAME_ELEMENT),
    ("msh", "samples", "", SAME_ELEMENT),
    (
        "tdms",
        "samples",
        "",
        "npTDMS shares a chunk that is not whole among the channels in the midst of a file, too, where no \
         recorder writes one; we leave it out, with a note",
    ),
    (
        "uff",
        "samples",
        "",
        "pyuff takes all numbers up to the delimiter, whatever the head promises; we take those that are \
         promised, with a note",
    ),
    (
        "uff",
        "rms",
        "",
        "pyuff cuts numbers at the columns of the format where they are wider; we read them whole",
    ),
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
        let Seen { seed, made, ours, verdict, .. } = seen;
        let of = self.counts.entry(made.kind).or_default();
        of.files += 1;
        match &verdict {
            Verdict::Equal => of.equal += 1,
            Verdict::BothRefuse => of.both_refuse += 1,
            Verdict::OursRefuses => of.ours_refuses += 1,
            Verdict::TheirsRefuses => of.theirs_refuses += 1,
            Verdict::OursHasFewer => of.ours_fewer += 1,
            Verdict::TheirsHasFewer => of.theirs_fewer += 1,
            Verdict::Differ(..) => of.differ += 1,
        }
        let new = |example: String| Kind { count: 0, bytes: usize::MAX, seed, example };
        let (kind, example) = match (&verdict, &ours) {
            (Verdict::Differ(what, words), _) => {
                (self.kinds.entry((made.kind, what, made.done)).or_insert(new(String::new())), words.clone())
            }
            (Verdict::OursRefuses, Err(why)) => {
                let key = (made.kind, gist(why));
                (self.refusals.entry(key).or_insert(new(String::new())), why.clone())
            }
            _ => return,
        };
        kind.count += 1;
        if made.bytes.len() < kind.bytes {
            *kind = Kind { bytes: made.bytes.len(), seed, example, ..*kind };
        }
    }

    pub(super) fn differing(&self) -> u64 {
        self.counts.values().map(|of| of.differ).sum()
    }

    /// Differences that no line of [`EXPLAINED`] covers.
    pub(super) fn unexplained(&self) -> u64 {
        self.kinds
            .iter()
            .filter(|((kind, what, done), _)| explained(kind, what, done).is_none())
            .map(|(_, k)| k.count)
            .sum()
    }

    pub(super) fn page(&self, files: u64, first: u64, versions: &str) -> String {
        let mut page = format!(
            "# Readers\n\nWritten by `cargo xtask fuzz --peers python3`: {files} files of signals and meshes \
             (seeds from {first}), made of the small ones in `fixtures/signals/small` and of tables in the \
             dialects that programs write, most of them damaged: bits turned, numbers of heads changed, \
             pieces missing or twice, cut off. Each is read here and by the program that its format belongs \
             to ({versions}). Panics: {}. The slowest file took {:.2} s here.\n\n\
             Equal is as many samples, as many of them numbers, the same rms to a part in a million and the \
             same rate.\n\n\
             | format | other reader | files | equal | equal, we have fewer channels | equal, they have fewer \
             | both refuse | we refuse | they refuse | differ |\n|---|---|---|---|---|---|---|---|---|---|\n",
            self.panics.len(),
            self.slowest.as_secs_f64(),
        );
        for (kind, of) in &self.counts {
            let _ = writeln!(
                page,
                "| {kind} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
                reader(kind),
                of.files,
                of.equal,
                of.ours_fewer,
                of.theirs_fewer,
                of.both_refuse,
                of.ours_refuses,
                of.theirs_refuses,
                of.differ
            );
        }
        page += "\n## Where both read and differ\n\n";
        if self.kinds.is_empty() {
            page += "Nowhere.\n";
        } else {
            page += "| format | in what | what was done | files | smallest: bytes, seed | ours; theirs | \
             why |\n\
                     |---|---|---|---|---|---|---|\n";
        }
        for ((kind, what, done), k) in &self.kinds {
            let why = explained(kind, what, done).unwrap_or("**not explained**");
            let _ = writeln!(
                page,
                "| {kind} | {what} | {done} | {} | {}, {} | {} | {why} |",
                k.count,
                k.bytes,
                k.seed,
                cell(&k.example)
            );
        }
        page += "\n## What we refuse and they read\n\n| format | files | why, with an example (bytes, \
         seed) |\n\
                 |---|---|---|\n";
        let mut all: Vec<_> = self.refusals.iter().collect();
        all.sort_by_key(|((kind, _), k)| (*kind, std::cmp::Reverse(k.count)));
        for ((kind, _), k) in all {
            let _ =
                writeln!(page, "| {kind} | {} | {} ({}, {}) |", k.count, cell(&k.example), k.bytes, k.seed);
        }
        page
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

/// A text in a cell of a table, without the folder of its file.
fn cell(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let text = match text.split_once("` ") {
        Some((path, rest)) if path.starts_with('`') && path.contains("stribeck-fuzz") => rest.to_owned(),
        _ => text,
    };
    text.replace('|', "\\|").chars().take(150).collect()
}
