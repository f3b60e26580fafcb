//! Random damage to bytes and text.

use stribeck_scene::dice::Dice;

/// Words that belong somewhere in a scene, or nowhere.
#[rustfmt::skip]
const WORDS: [&str; 40] = [
    "(", ")", "[", "]", "{", "}", ",", ":", "\"", "'", "//", "/*", "*/", "Some(", "None", "true", "false", "NaN",
    "inf", "-inf", "1e309", "-1", "0", "1e-320", "99999999999999999999999", "0x10", "1_000", ".", "..", "-", "é",
    "\u{0}", "\u{feff}", "\t", "\r\n", "#![enable(implicit_some)]", "bearing: (", "mesh", "r#\"", "collocated",
];

/// Damages a text in some places; it stays text.
pub(crate) fn text(original: &str, dice: &mut Dice) -> String {
    let mut chars: Vec<char> = original.chars().collect();
    for _ in 0..=dice.below(4) {
        let at = dice.below(chars.len());
        let end = (at + dice.below(30)).min(chars.len());
        match dice.below(8) {
            0 => chars.truncate(at),
            1 => drop(chars.drain(at..end)),
            2 => {
                let copy = chars[at..end].to_vec();
                let to = dice.below(chars.len());
                chars.splice(to..to, copy);
            }
            3 => {
                let word = dice.pick(&WORDS);
                chars.splice(at..at, word.chars());
            }
            4 => {
                let depth = 1 + dice.below(2000);
                let open = dice.pick(&["(", "[", "{", "Some("]);
                chars.splice(at..at, open.repeat(depth).chars());
            }
            5 | 6 => number(&mut chars, dice),
            _ => {
                if let Some(c) = chars.get_mut(at) {
                    *c = char::from_u32(dice.below(0x300) as u32).unwrap_or('?');
                }
            }
        }
    }
    chars.into_iter().collect()
}

fn number(chars: &mut Vec<char>, dice: &mut Dice) {
    let starts: Vec<usize> = (1..chars.len())
        .filter(|&i| chars[i].is_ascii_digit() && matches!(chars[i - 1], ' ' | '(' | '-'))
        .collect();
    if starts.is_empty() {
        return;
    }
    let start = starts[dice.below(starts.len())];
    let length = chars[start..].iter().take_while(|c| c.is_ascii_alphanumeric() || **c == '.').count();
    let value = dice.number();
    let written = match dice.below(3) {
        0 => format!("{value:e}"),
        1 => format!("{value:?}"),
        _ => dice.pick(&WORDS).to_owned(),
    };
    chars.splice(start..start + length, written.chars());
}

pub(crate) fn bytes(original: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..=dice.below(3) {
        let at = dice.below(bytes.len());
        let end = (at + dice.below(40)).min(bytes.len());
        match dice.below(6) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            3 => {
                let value = dice.bits().to_le_bytes();
                bytes.splice(at..end.min(at + 8), value);
            }
            4 => {
                let value = [0xff, 0x7f, 0x80, 0x00][dice.below(4)];
                bytes[at..end].fill(value);
            }
            _ => {
                if let Some(b) = bytes.get_mut(at) {
                    *b ^= 1 << dice.below(8);
                }
            }
        }
    }
    bytes
}

/// Damages a binary file where its fields are likely; returns a description.
pub(crate) fn fields(original: &[u8], dice: &mut Dice) -> (&'static str, Vec<u8>) {
    /// Bytes at the beginning and at the end in which most fields are.
    const NEAR: usize = 600;
    let mut bytes = original.to_vec();
    let at = match dice.below(4) {
        0 => dice.below(bytes.len()),
        1 => bytes.len().saturating_sub(1 + dice.below(NEAR)),
        _ => dice.below(bytes.len().min(NEAR)),
    };
    let end = (at + 1 + dice.below(40)).min(bytes.len());
    let done = match dice.below(9) {
        0 | 1 => {
            bytes[at] ^= 1 << dice.below(8);
            "a bit is turned"
        }
        2..=4 => {
            count(&mut bytes, at, dice);
            "a number of a head is another"
        }
        5 => {
            let small = (0..bytes.len()).map(|n| (at + n) % bytes.len()).find(|n| bytes[*n] < 64);
            bytes[small.unwrap_or(at)] = dice.below(64) as u8;
            "a type or a flag is another"
        }
        6 => {
            bytes.truncate(at);
            "it is cut off"
        }
        7 => {
            let copy = bytes[at..end].to_vec();
            bytes.splice(at..at, copy);
            "a piece stands twice"
        }
        _ => {
            drop(bytes.drain(at..end));
            "a piece is missing"
        }
    };
    (done, bytes)
}

/// Changes the first number of 32 bits at or behind a place that looks like a count, a size or an address.
fn count(bytes: &mut [u8], at: usize, dice: &mut Dice) {
    let word = |n: usize| Some(u32::from_le_bytes(bytes.get(n..n + 4)?.try_into().ok()?));
    let Some((place, found)) =
        (at..bytes.len()).find_map(|n| Some((n, word(n).filter(|w| (1..1 << 20).contains(w))?)))
    else {
        return;
    };
    let changed = match dice.below(8) {
        0 => found + 1,
        1 => found - 1,
        2 => 2 * found,
        3 => found / 2,
        4 => 0,
        5 => u32::MAX,
        6 => found + dice.below(16) as u32,
        _ => dice.bits() as u32,
    };
    bytes[place..place + 4].copy_from_slice(&changed.to_le_bytes());
}
