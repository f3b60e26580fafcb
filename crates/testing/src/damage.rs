//! Damage to good files, as strategies of proptest: a failure shrinks to the fewest edits.

use proptest::prelude::*;

/// Words that belong somewhere in a text that we read, or nowhere.
#[rustfmt::skip]
const WORDS: [&str; 34] = [
    "(", ")", "[", "]", "{", "}", ",", ":", "\"", "'", "//", "/*", "Some(", "None", "true", "NaN", "inf", "-inf",
    "1e309", "-1", "0", "1e-320", "99999999999999999999999", "0x10", "1_000", "..", "-", "é", "\u{0}",
    "\u{feff}", "\t", "\r\n", "#![enable(implicit_some)]", "r#\"",
];

/// One edit: its kind, its place and another one as shares of the file, a length and a value.
type Edit = (u8, f64, f64, usize, u64);

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    prop::collection::vec((0_u8..9, 0.0..1.0, 0.0..1.0, 1_usize..40, any::<u64>()), 1..5)
}

/// Numbers of cases: of the environment (`PROPTEST_CASES`), or else these.
pub fn cases(otherwise: u32) -> ProptestConfig {
    let given = std::env::var("PROPTEST_CASES").ok().and_then(|text| text.parse().ok());
    ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(given.unwrap_or(otherwise)) }
}

/// One of some good files with its name, and what damage makes of it: bits turned, numbers of its head changed,
/// pieces missing, doubled or set to the borders of their range, cut off.
///
/// # Panics
/// If there is no file.
pub fn damaged(good: Vec<(String, Vec<u8>)>) -> impl Strategy<Value = (String, Vec<u8>)> {
    (prop::sample::select(good), edits()).prop_map(|((name, mut bytes), edits)| {
        edits.iter().for_each(|edit| edit_bytes(&mut bytes, edit));
        (name, bytes)
    })
}

/// The same of texts: pieces and lines missing or doubled, words put in, numbers replaced, deep brackets.
///
/// # Panics
/// If there is no text.
pub fn damaged_text(good: &[&str]) -> impl Strategy<Value = String> + use<> {
    let good: Vec<Vec<char>> = good.iter().map(|text| text.chars().collect()).collect();
    (prop::sample::select(good), edits()).prop_map(|(mut chars, edits)| {
        edits.iter().for_each(|edit| edit_text(&mut chars, edit));
        chars.into_iter().collect()
    })
}

/// A number of any size and kind.
pub fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        prop::sample::select(vec![0.0, -1.0, 1e300, -1e-300, 5e-324, f64::MAX, 4_294_967_296.0]),
        prop::sample::select(vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY]),
        any::<u64>().prop_map(f64::from_bits),
        (-20.0..20.0_f64).prop_map(|power| 10_f64.powf(power)),
        -20.0..180.0_f64,
    ]
}

fn edit_bytes(bytes: &mut Vec<u8>, &(kind, share, to, length, value): &Edit) {
    // Heads and tails hold the structure: half of the damage is there.
    const NEAR: usize = 600;
    if bytes.is_empty() {
        return;
    }
    let (all, near) = (bytes.len(), bytes.len().min(NEAR));
    let at = match value % 4 {
        0 => all - near + (share * near as f64) as usize,
        1 => (share * near as f64) as usize,
        _ => (share * all as f64) as usize,
    };
    let end = (at + length).min(all);
    match kind {
        0 | 1 => bytes[at] ^= 1 << (value >> 8 & 7),
        2 | 3 => change_count(bytes, at, value >> 8),
        4 => bytes[at..end].fill([0, 0xff, 0x7f, 0x80][(value >> 8) as usize % 4]),
        5 => drop(bytes.drain(at..end)),
        6 => {
            let copy = bytes[at..end].to_vec();
            let to = (to * all as f64) as usize;
            bytes.splice(to..to, copy);
        }
        7 => bytes[at] = (value >> 8) as u8,
        _ => bytes.truncate(at),
    }
}

/// Changes the first number of 32 bits at or behind a place that looks like a count, a size or an address.
fn change_count(bytes: &mut [u8], at: usize, value: u64) {
    let word = |n: usize| bytes.get(n..n + 4).and_then(|four| four.try_into().ok()).map(u32::from_le_bytes);
    let Some(place) = (at..bytes.len()).find(|n| word(*n).is_some_and(|w| (1..1 << 20).contains(&w))) else {
        return;
    };
    let found = word(place).unwrap_or(0);
    let changed =
        [found + 1, found - 1, 2 * found, found / 2, 0, u32::MAX, (value >> 3) as u32][value as usize % 7];
    bytes[place..place + 4].copy_from_slice(&changed.to_le_bytes());
}

fn edit_text(chars: &mut Vec<char>, &(kind, share, to, length, value): &Edit) {
    let at = (share * chars.len() as f64) as usize;
    let to = (to * chars.len() as f64) as usize;
    let end = (at + length).min(chars.len());
    let word = WORDS[value as usize % WORDS.len()];
    match kind {
        0 => chars.truncate(at),
        1 => drop(chars.drain(at..end)),
        2 => {
            let copy = chars[at..end].to_vec();
            chars.splice(to..to, copy);
        }
        3 => drop(chars.splice(at..at, word.chars())),
        4 => {
            let open = ["(", "[", "{", "Some("][value as usize % 4];
            chars.splice(at..at, open.repeat(50 * length).chars());
        }
        5 => {
            let from = chars[..at].iter().rposition(|c| *c == '\n').map_or(0, |n| n + 1);
            let line = chars[from..].split_inclusive(|c| *c == '\n').next().unwrap_or_default().to_vec();
            chars.splice(from..from, line);
        }
        6 | 7 => {
            let from = (at..chars.len()).find(|n| chars[*n].is_ascii_digit()).unwrap_or(chars.len());
            let length = chars[from..].iter().take_while(|c| c.is_ascii_alphanumeric() || **c == '.').count();
            let number = match value % 3 {
                0 => format!("{:e}", f64::from_bits(value)),
                1 => (value >> 40).to_string(),
                _ => word.to_owned(),
            };
            chars.splice(from..from + length, number.chars());
        }
        _ => {
            if let Some(c) = chars.get_mut(at) {
                *c = char::from_u32((value % 0x300) as u32).unwrap_or('?');
            }
        }
    }
}
