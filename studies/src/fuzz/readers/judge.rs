//! Two readings of a file side by side.

use super::{Held, Reading};

/// Largest difference of two rms, over the rms: whole numbers are scaled in single precision by some.
const SAME_RMS: f64 = 1e-6;
/// Largest difference of two rates, over the rate: times in texts have a few digits.
const SAME_RATE: f64 = 2e-3;

/// What two readings say of each other.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Verdict {
    Equal,
    BothRefuse,
    OursRefuses,
    TheirsRefuses,
    /// What both have is equal, and we leave out some channels; they may leave out others.
    OursHasFewer,
    /// What both have is equal, and they leave out some.
    TheirsHasFewer,
    /// Both have something that the other has otherwise: what, in which words.
    Differ(&'static str, String),
}

/// Compares readings. Channels are matched by their values, not by their names.
pub(super) fn judge(ours: &Reading, theirs: &Reading) -> Verdict {
    let (ours, theirs) = match (ours, theirs) {
        (Err(_), Err(_)) => return Verdict::BothRefuse,
        (Err(_), Ok(theirs)) if theirs.is_empty() => return Verdict::BothRefuse,
        (Err(_), Ok(_)) => return Verdict::OursRefuses,
        (Ok(_), Err(_)) => return Verdict::TheirsRefuses,
        (Ok(_), Ok(theirs)) if theirs.is_empty() => return Verdict::TheirsRefuses,
        (Ok(ours), Ok(theirs)) => (ours, theirs),
    };
    // The other programs leave out channels without numbers.
    let mut rest: Vec<&Held> = ours.iter().filter(|c| c.numbers > 0).collect();
    let mut only_theirs: Vec<&Held> = Vec::new();
    for of in theirs.iter().filter(|c| c.numbers > 0) {
        match rest.iter().position(|own| unlike(own, of).is_none()) {
            Some(n) => drop(rest.remove(n)),
            None => only_theirs.push(of),
        }
    }
    match (rest.first(), only_theirs.first()) {
        (None, None) => Verdict::Equal,
        (Some(_), None) => Verdict::TheirsHasFewer,
        (None, Some(_)) => Verdict::OursHasFewer,
        (Some(own), Some(first)) => {
            // Rather one of the same name.
            let last = |name: &str| name.rsplit(['/', '\'', '.']).find(|s| !s.is_empty()).map(str::to_owned);
            let is_same = |own: &Held, of: &Held| last(&own.name) == last(&of.name);
            let pairs = rest.iter().flat_map(|own| only_theirs.iter().map(move |of| (own, of)));
            let pair = pairs.into_iter().find(|(own, of)| is_same(own, of));
            // Where both take the names of the file, and these are others: each leaves out one.
            let named = ours.iter().any(|own| theirs.iter().any(|of| is_same(own, of)));
            if pair.is_none() && named {
                return Verdict::OursHasFewer;
            }
            let (own, of) = pair.unwrap_or((own, first));
            Verdict::Differ(
                unlike(own, of).unwrap_or("samples"),
                format!("{}; theirs {}", words(own), words(of)),
            )
        }
    }
}

/// In what two channels are not the same.
fn unlike(own: &Held, of: &Held) -> Option<&'static str> {
    let same = |a: f64, b: f64, part: f64| a.is_finite() && (a - b).abs() <= part * a.abs().max(b.abs());
    if of.len.is_some() && own.len != of.len {
        return Some("samples");
    }
    if own.numbers != of.numbers {
        return Some("numbers among the samples");
    }
    // Beyond what squares can hold, both overflow.
    if !(same(own.rms, of.rms, SAME_RMS) || own.rms > 1e150 && of.rms > 1e150) {
        return Some("rms");
    }
    match (own.rate_hz, of.rate_hz) {
        (Some(a), Some(b)) if !same(a, b, SAME_RATE) => Some("rate"),
        _ => None,
    }
}

fn words(of: &Held) -> String {
    let rate = of.rate_hz.map_or(String::new(), |hz| format!(", {hz:.6} Hz"));
    let len = of.len.map_or(String::new(), |len| format!(" of {len}"));
    format!("`{}` {}{len}, rms {:.6e}{rate}", of.name, of.numbers, of.rms)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held(name: &str, len: u64, rms: f64) -> Held {
        Held { name: name.to_owned(), len: Some(len), numbers: len, rms, rate_hz: None }
    }

    #[test]
    fn behaves_each_verdict() {
        let one = || Ok(vec![held("a", 9, 1.0)]);
        let two = || Ok(vec![held("x", 9, 1.0), held("b", 9, 2.0)]);
        let no = || Err("cut off".to_owned());
        assert_eq!(judge(&one(), &one()), Verdict::Equal);
        assert_eq!(judge(&no(), &no()), Verdict::BothRefuse);
        assert_eq!(judge(&no(), &one()), Verdict::OursRefuses);
        assert_eq!(judge(&one(), &no()), Verdict::TheirsRefuses);
        assert_eq!(judge(&one(), &two()), Verdict::OursHasFewer);
        assert_eq!(judge(&two(), &one()), Verdict::TheirsHasFewer);
        for (other, what) in [(held("a", 8, 1.0), "samples"), (held("a", 9, 1.1), "rms")] {
            assert!(
                matches!(judge(&one(), &Ok(vec![other])), Verdict::Differ(in_what, _) if in_what == what)
            );
        }
        // Each leaves out what the other has under another name.
        let named = |name: &str, rms: f64| Ok(vec![held("a", 9, 1.0), held(name, 9, rms)]);
        assert_eq!(judge(&named("b", 2.0), &named("c", 3.0)), Verdict::OursHasFewer);
        assert!(matches!(judge(&named("b", 2.0), &named("b", 3.0)), Verdict::Differ("rms", _)));
        let fast = Held { rate_hz: Some(9.0), ..held("a", 9, 1.0) };
        let slow = Held { rate_hz: Some(8.0), ..held("a", 9, 1.0) };
        assert!(matches!(judge(&Ok(vec![fast]), &Ok(vec![slow])), Verdict::Differ("rate", _)));
    }
}
