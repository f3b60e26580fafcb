//! The walk of the guide, `docs/guide/src/walk.md`: commands as a reader would type them, with what they say.
//!
//! The page is written by this test alone: `STRIBECK_BLESS=1 cargo test --release --workspace walk`. A later program
//! must still use the same words; numbers may scatter, and times are of the machine on which the page was written.

use std::fmt::Write as _;
use std::fs::{self, File};

use crate::common::{Desk, command};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../docs/guide/src/walk.md");

const HEAD: &str = "# A recorded walk

From an empty folder to a verdict, in six commands with what they print: a ball bearing with a spall, and the same \
one without. A test runs them and compares their words with this page, which was never typed by hand.
";

/// What a command is for, and its words.
const STEPS: [(&str, &str); 6] = [
    (
        "A scene of one's own; `stribeck new` alone asks for each of these:",
        "new spall.ron --bearing 6205 --load-n 1000 --speed-rpm 1500 --defect outer --length-mm 2 --duration-s 1.2",
    ),
    ("What to expect, before anything runs:", "plan spall.ron --no-trial"),
    ("The run, with its page and a verdict at the machine's sensor:", "simulate spall.ron"),
    ("The same bearing when it was sound:", "simulate spall.ron --set defect=None --out runs/sound"),
    ("The verdict in full, as on a measured record:", "analyse spall"),
    ("Both beside each other:", "compare sound spall"),
];

/// Largest change of a number [-]: other processors add in another order, which knocks make larger.
const SCATTER: f64 = 0.1;

/// The number of a word, without the brackets and signs around it.
fn number(word: &str) -> Option<f64> {
    word.trim_matches(|c: char| "(),:;|".contains(c)).parse().ok()
}

/// Whether two words say the same: letters are equal, numbers within their scatter, but for those of differences
/// and of times, whose unit is the next word. Levels are within 6 dB.
fn are_alike(a: &str, b: &str, unit: &str) -> bool {
    let is_free = a.starts_with(['+', '−']) || a.starts_with("(+") || a.starts_with("(−");
    let unit = unit.trim_matches(['(', ')', ',']);
    let is_time = ["s", "threads", "thread"].contains(&unit);
    match (number(a), number(b)) {
        (Some(x), Some(y)) if unit == "dB" => (x - y).abs() <= 6.0,
        (Some(x), Some(y)) => is_free || is_time || (x - y).abs() <= SCATTER * x.abs().max(y.abs()),
        _ => a == b,
    }
}

/// A text without the odds of false alarms, which change by orders of magnitude where heights do by a decibel.
fn without_odds(text: &str) -> String {
    let mut parts = text.split("false alarm ");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |all, part| all + part.split_once(':').map_or(part, |(_, rest)| rest))
}

/// What a command prints, results and progress in the order in which a terminal shows them.
fn in_their_order(desk: &Desk, words: &str) -> String {
    let path = desk.join("printed");
    let open = || File::options().append(true).create(true).open(&path).expect("a file");
    let words: Vec<&str> = words.split(' ').collect();
    let ended = command(desk, &words).stdout(open()).stderr(open()).status().expect("it starts");
    let printed = fs::read_to_string(&path).expect("a text");
    assert!(ended.success(), "{words:?}: {printed}");
    fs::remove_file(&path).expect("it is ours");
    printed
}

#[test]
fn golden_the_walk_of_the_guide() {
    let desk = Desk::new("walk");
    let mut page = HEAD.to_owned();
    for (purpose, words) in STEPS {
        let said = in_their_order(&desk, words);
        write!(page, "\n{purpose}\n\n```text\n$ stribeck {words}\n{}\n```\n", said.trim_end())
            .expect("a text");
    }
    if std::env::var_os("STRIBECK_BLESS").is_some() {
        fs::write(PAGE, &page).expect("the page can be written");
    }
    let kept = fs::read_to_string(PAGE).expect("the page of the guide");
    let [page, kept] = [page, kept].map(|text| without_odds(&text));
    let [now, then] = [&page, &kept].map(|text| text.split_whitespace().collect::<Vec<_>>());
    for (n, (a, b)) in now.iter().zip(&then).enumerate() {
        let unit = now.get(n + 1).copied().unwrap_or_default();
        let near = now[n.saturating_sub(12)..(n + 6).min(now.len())].join(" ");
        assert!(are_alike(a, b, unit), "`{a}` was `{b}`, in: … {near} …");
    }
    assert_eq!(now.len(), then.len(), "the page says more or less than the commands");
}
