//! From a designation as users write it to a bearing of the catalogue.

use super::{CatalogueBearing, tables};

/// Makers whose names may stand glued to a designation.
const MAKERS: [&str; 14] = [
    "SKF", "FAG", "INA", "NSK", "NTN", "SNR", "KOYO", "TIMKEN", "NACHI", "REXNORD", "ZKL", "ZWZ", "HRB",
    "LDK",
];

/// Needle roller bearings, which are not here: `HK 1210` is no 1210 of a maker HK.
const NEEDLES: [&str; 9] = ["HK", "BK", "NK", "NKI", "NKIS", "NA", "RNA", "K", "AXK"];

/// Letters and digits alone, in capitals.
pub fn plain(text: &str) -> String {
    text.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_uppercase()
}

/// The bearing among `known` whose name, letters and digits alone, is that of `name` or begins it. Of several
/// it is the one with the longest name, and of these the first.
pub(super) fn find(name: &str, known: &[CatalogueBearing], advice: &str) -> Result<CatalogueBearing, String> {
    // A maker may stand before: `Rexnord ZA-2115`, `SKF6205`.
    let behind_maker = name.split_once(' ').filter(|(maker, _)| {
        maker.chars().all(char::is_alphabetic) && !NEEDLES.contains(&maker.to_uppercase().as_str())
    });
    let mut asked: Vec<String> =
        [Some(name), behind_maker.map(|(_, rest)| rest)].into_iter().flatten().map(plain).collect();
    let whole = plain(name);
    asked.extend(MAKERS.iter().filter_map(|maker| whole.strip_prefix(maker)).map(str::to_owned));
    for asked in &asked {
        let fitting = known.iter().filter(|bearing| fits(asked, bearing));
        let longest = |best: Option<&CatalogueBearing>| best.map_or(0, |bearing| bearing.name.len());
        let found =
            fitting.fold(None, |best, next| if next.name.len() > longest(best) { Some(next) } else { best });
        if let Some(found) = found {
            let angle_deg = angle_of(asked, found).unwrap_or(found.angle_deg);
            return Ok(CatalogueBearing { angle_deg, ..found.clone() });
        }
    }
    if let Some(why) = asked.iter().find_map(|asked| beyond_a_plane(asked)) {
        return Err(format!("`{name}` is {why}"));
    }
    let meant = match nearest(&whole, known)[..] {
        [] => String::new(),
        ref near => format!(", did you mean {}?", near.join(" or ")),
    };
    Err(format!("no bearing `{name}` is known{meant}; {advice}, or one of {}", tables::names()))
}

/// Contact angle [°] by the letter behind an angular contact bearing's number. A digit behind it makes it a
/// clearance.
fn angle_of(asked: &str, found: &CatalogueBearing) -> Option<f64> {
    let rest = asked.strip_prefix(&plain(&found.name)).filter(|_| found.name.starts_with('7'))?;
    let angles = [("AC", 25.0), ("A", 30.0), ("B", 40.0), ("C", 15.0)];
    let (letters, angle) = angles.into_iter().find(|(letters, _)| rest.starts_with(letters))?;
    let behind = rest[letters.len()..].chars().next();
    behind.is_none_or(|c| !c.is_ascii_digit()).then_some(angle)
}

/// Names that are one letter or digit away from what was asked, at most four.
fn nearest(asked: &str, known: &[CatalogueBearing]) -> Vec<String> {
    const MOST: usize = 4;
    let near = known.iter().filter(|bearing| strsim::levenshtein(&plain(&bearing.name), asked) == 1);
    near.map(|bearing| format!("`{}`", bearing.name)).take(MOST).collect()
}

fn fits(asked: &str, bearing: &CatalogueBearing) -> bool {
    let own = plain(&bearing.name);
    // `6205-2RS1` and `6205-2Z` are a 6205, with two seals or shields, and 62055 is not. Inserts have bores
    // that do not follow from their balls: `UER204-12`.
    asked.strip_prefix(&own).is_some_and(|rest| {
        let mut letters = rest.chars();
        match letters.next() {
            _ if own.is_empty() => false,
            Some('2') if !own.starts_with('N') => letters.next().is_some_and(|c| c.is_ascii_alphabetic()),
            Some('0'..='9') => own.starts_with('U') && rest.len() == 2,
            _ => true,
        }
    })
}

/// Why a plane model cannot have a bearing of this kind, where the name, letters and digits alone, shows the kind.
pub fn beyond_a_plane(whole: &str) -> Option<&'static str> {
    // Seals and shields begin with a digit of their own.
    let asked = ["2RS", "2Z"].iter().filter_map(|seal| whole.split_once(seal)).map(|(own, _)| own).next();
    let asked = asked.unwrap_or(whole);
    let digits: String = asked.chars().take_while(char::is_ascii_digit).collect();
    let behind = asked[digits.len()..].chars().next();
    if behind.is_some_and(|c| !c.is_ascii_alphabetic()) {
        return None;
    }
    match (digits.len(), digits.get(..2)?) {
        (4, "12" | "13" | "22" | "23") => Some(
            "a self-aligning ball bearing: two rows of balls on one sphere in the outer ring, which a model \
             of one row in a plane does not have",
        ),
        (4, "72" | "73" | "70" | "32" | "33") => Some(
            "an angular contact ball bearing, and a plane model has no contact angle: its rows share the \
             load along the shaft, too",
        ),
        (5, "21" | "22" | "23" | "24") => Some(
            "a spherical roller bearing: two rows of barrels on one sphere in the outer ring, which a model \
             of one row in a plane does not have",
        ),
        (5, "30" | "31" | "32" | "33") => Some(
            "a tapered roller bearing, and a plane model has no contact angle: its rollers share the load \
             along the shaft, too",
        ),
        (5, "51" | "52" | "81") => Some("a thrust bearing: it takes no radial load"),
        _ => None,
    }
}

/// The bearings among `known` whose names begin as `text` does.
pub(super) fn beginning_with(text: &str, known: &[CatalogueBearing]) -> Vec<CatalogueBearing> {
    let asked = plain(text);
    let begins = |name: &str| match name.strip_prefix(asked.as_str()) {
        // `N` are the bearings of that kind, not those that begin with NU.
        Some(rest) => {
            let whole =
                |c: char| !c.is_ascii_alphabetic() || !asked.ends_with(|c: char| c.is_ascii_alphabetic());
            rest.chars().next().is_none_or(whole)
        }
        None => false,
    };
    known.iter().filter(|bearing| !asked.is_empty() && begins(&plain(&bearing.name))).cloned().collect()
}
