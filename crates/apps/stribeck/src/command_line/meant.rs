//! The command line that was probably meant by one that cannot be parsed: words of other programs for commands
//! and flags, other units, a file in the place of a command. It is proposed only where it can be parsed.

use std::path::Path;

use clap::Command;
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use stribeck_scene::catalogue;
use stribeck_scene::scene_file::nearest;

/// Mistakes of one line that are mended, at most.
const MOST: usize = 8;

/// Words for commands, and ours, which may have a flag.
const COMMANDS: [(&[&str], &str); 16] = [
    (&["run", "start", "go", "sim"], "simulate"),
    (&["resume", "continue"], "simulate --resume"),
    (&["plot", "show", "view", "browse", "page"], "open"),
    (&["bearing", "catalogue", "catalog", "database"], "bearings"),
    (&["ls", "dir", "runs", "status"], "list"),
    (&["remove", "delete", "del", "clean"], "rm"),
    (&["diff", "cmp"], "compare"),
    (&["diagnose", "diagnosis", "read", "spectrum", "envelope"], "analyse"),
    (&["init", "create", "make", "scene", "generate"], "new"),
    (&["batch", "grid", "doe", "study", "parametric", "vary"], "sweep"),
    (&["convert", "save", "write"], "export"),
    (&["gui", "play", "animate", "interactive"], "lab"),
    (&["estimate", "predict", "check", "dry-run"], "plan"),
    (&["example", "examples", "tutorial", "quickstart"], "demo"),
    (&["version"], "--version"),
    (&["rotordynamics", "coefficients"], "stiffness"),
];

/// Commands that take fields of a scene by `--set`.
const OF_SCENES: &[&str] =
    &["simulate", "plan", "sweep", "campaign", "detect", "validate", "stiffness", "lab", "fmu"];
const OF_RECORDS: &[&str] = &["analyse", "analyze", "compare", "machine"];

/// Flags of these commands by the words and units of others, ours, and the factor between the units.
type Flags = (&'static [&'static str], &'static [&'static str], &'static str, f64);

const FLAGS: [Flags; 26] = [
    (OF_SCENES, &["speed-rpm", "rpm", "speed"], "--set=operation.speed_rpm", 1.0),
    (OF_SCENES, &["speed-hz", "hz"], "--set=operation.speed_rpm", 60.0),
    (OF_SCENES, &["load-n", "load", "force", "force-n"], "--set=operation.load_n", 1.0),
    (OF_SCENES, &["load-kn", "force-kn"], "--set=operation.load_n", 1e3),
    (OF_SCENES, &["duration-ms", "duration", "time-ms"], "--set=solver.duration_ms", 1.0),
    (OF_SCENES, &["duration-s", "time", "time-s"], "--set=solver.duration_ms", 1e3),
    (OF_SCENES, &["length-mm", "length", "defect-length-mm", "size-mm"], "--set=defect.length_mm", 1.0),
    (OF_SCENES, &["depth-mm", "depth"], "--set=defect.depth_mm", 1.0),
    (OF_SCENES, &["mesh", "mesh-size-mm", "mesh-size"], "--set=mesh.size_mm", 1.0),
    (OF_SCENES, &["bearing"], "--set=bearing", 1.0),
    (OF_SCENES, &["output", "output-dir", "o"], "--out", 1.0),
    (OF_SCENES, &["cores", "j", "cpus"], "--threads", 1.0),
    (&["simulate"], &["force", "f"], "--overwrite", 1.0),
    (&["new"], &["rpm", "speed"], "--speed-rpm", 1.0),
    (&["new"], &["speed-hz", "hz"], "--speed-rpm", 60.0),
    (&["new"], &["load", "force"], "--load-n", 1.0),
    (&["new"], &["load-kn", "force-kn"], "--load-n", 1e3),
    (&["new"], &["fault", "spall", "damage"], "--defect", 1.0),
    (&["new"], &["length", "size", "size-mm", "defect-length-mm"], "--length-mm", 1.0),
    (&["new"], &["duration", "time"], "--duration-s", 1.0),
    (&["new"], &["duration-ms", "time-ms"], "--duration-s", 1e-3),
    (OF_RECORDS, &["rpm", "speed"], "--speed-rpm", 1.0),
    (OF_RECORDS, &["speed-hz", "hz", "shaft-hz", "fr"], "--speed-rpm", 60.0),
    (OF_RECORDS, &["fs", "rate", "sample-rate", "sampling-rate", "sr", "fs-hz"], "--rate-hz", 1.0),
    (OF_RECORDS, &["rate-khz", "fs-khz"], "--rate-hz", 1e3),
    (&["rm"], &["force", "f", "r", "rf"], "--yes", 1.0),
];

/// Values that others write, and ours.
const VALUES: [(&[&str], &str); 4] = [
    (&["outer-race", "outer-ring", "or", "bpfo", "outer_race", "outer raceway"], "outer"),
    (&["inner-race", "inner-ring", "ir", "bpfi", "inner_race", "inner raceway"], "inner"),
    (&["ball", "element", "rolling-element", "re", "bsf", "b"], "roller"),
    (&["healthy", "normal", "sound", "no"], "none"),
];

/// Units behind a number, the end of the flag that takes them in another one, and the factor between them.
const UNITS: [(&str, &str, f64); 12] = [
    ("kn", "-n", 1e3),
    ("n", "-n", 1.0),
    ("hz", "-rpm", 60.0),
    ("rpm", "-rpm", 1.0),
    ("khz", "-hz", 1e3),
    ("hz", "-hz", 1.0),
    ("mm", "-mm", 1.0),
    ("um", "-mm", 1e-3),
    ("ms", "-s", 1e-3),
    ("s", "-s", 1.0),
    ("g", "-g", 1.0),
    ("mm", "-um", 1e3),
];

/// The line that `words` were meant for, by the rules of `program`; `None` where nothing that can be parsed is
/// near.
pub(super) fn meant(program: &Command, words: &[String]) -> Option<Vec<String>> {
    let mut words = words.to_vec();
    for _ in 0..MOST {
        let line = std::iter::once("stribeck".to_owned()).chain(words.iter().cloned());
        match program.clone().try_get_matches_from(line) {
            Ok(_) => return Some(words),
            Err(help) if !help.use_stderr() => return Some(words),
            Err(error) => words = mended(&error, &words)?,
        }
    }
    None
}

/// `words` without the mistake of `error`.
fn mended(error: &Error, words: &[String]) -> Option<Vec<String>> {
    let said = |kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(one)) => Some(one.clone()),
        Some(ContextValue::Strings(all)) => all.first().cloned(),
        _ => None,
    };
    match error.kind() {
        ErrorKind::InvalidSubcommand => {
            let wrong = said(ContextKind::InvalidSubcommand)?;
            let at = words.iter().position(|word| *word == wrong)?;
            let known = said(ContextKind::SuggestedSubcommand).into_iter().collect::<Vec<_>>();
            let mut by = command(&wrong, &known)?;
            // `help run` asks for a command, without its flags.
            by.truncate(if at > 0 { 1 } else { by.len() });
            Some(replaced(words, at..at + 1, by))
        }
        ErrorKind::UnknownArgument => {
            let wrong = said(ContextKind::InvalidArg)?;
            let at =
                words.iter().position(|word| *word == wrong || word.starts_with(&format!("{wrong}=")))?;
            let name = words.iter().find(|word| !word.starts_with('-'))?;
            if wrong.starts_with('-') {
                let near = said(ContextKind::SuggestedArg);
                flag(name, words, at).or_else(|| Some(replaced(words, at..at + 1, with(&near?, &words[at]))))
            } else {
                extra(name, words, at)
            }
        }
        ErrorKind::InvalidValue | ErrorKind::ValueValidation => {
            let [flag, wrong] = [said(ContextKind::InvalidArg)?, said(ContextKind::InvalidValue)?];
            let flag = flag.split([' ', '=']).next()?.to_owned();
            let at = words.iter().position(|word| *word == wrong || *word == format!("{flag}={wrong}"))?;
            let near = said(ContextKind::SuggestedValue);
            let value = value(&flag, &wrong, near)?;
            let word = if words[at] == wrong { value } else { format!("{flag}={value}") };
            Some(replaced(words, at..at + 1, vec![word]))
        }
        _ => None,
    }
}

fn replaced(words: &[String], range: std::ops::Range<usize>, by: Vec<String>) -> Vec<String> {
    let mut words = words.to_vec();
    words.splice(range, by);
    words
}

/// What stands for a word in the place of a command.
fn command(wrong: &str, near: &[String]) -> Option<Vec<String>> {
    let ending = Path::new(wrong).extension().map(|end| end.to_string_lossy().to_lowercase());
    let ours = |line: &str| line.split(' ').map(str::to_owned).collect::<Vec<_>>();
    if let Some((_, line)) = COMMANDS.iter().find(|(words, _)| words.contains(&wrong.to_lowercase().as_str()))
    {
        return Some(ours(line));
    }
    match ending.as_deref() {
        Some("ron") => return Some(vec!["simulate".to_owned(), wrong.to_owned()]),
        Some(_) if Path::new(wrong).is_file() => return Some(vec!["analyse".to_owned(), wrong.to_owned()]),
        _ => {}
    }
    if wrong.chars().any(|c| c.is_ascii_digit()) && catalogue::parse(wrong).is_ok() {
        return Some(vec!["bearings".to_owned(), wrong.to_owned()]);
    }
    nearest(wrong, near).map(|name| vec![name.to_owned()])
}

/// `flag` with the value of the word that it replaces.
fn with(flag: &str, word: &str) -> Vec<String> {
    vec![word.split_once('=').map_or_else(|| flag.to_owned(), |(_, value)| format!("{flag}={value}"))]
}

/// The words with our flag in the place of the one at `at`, of the command `name`.
fn flag(name: &str, words: &[String], at: usize) -> Option<Vec<String>> {
    let (typed, value) = match words[at].split_once('=') {
        Some((flag, value)) => (flag, Some(value)),
        None => (words[at].as_str(), None),
    };
    let typed = typed.trim_start_matches('-').replace('_', "-").to_lowercase();
    if name == "export" {
        return Some(replaced(words, at..at + 1, vec![format!("--to={typed}")]));
    }
    let known = |&&(commands, flags, ..): &&Flags| commands.contains(&name) && flags.contains(&&*typed);
    // `--overwrite` and `--yes` have no value.
    let is_bare = |ours: &str| ["--overwrite", "--yes"].contains(&ours);
    let next = words.get(at + 1).filter(|next| !next.starts_with("--"));
    let (_, _, ours, factor) = FLAGS
        .iter()
        .filter(known)
        .find(|(.., ours, _)| is_bare(ours) || value.is_some() || next.is_some())?;
    if is_bare(ours) {
        return Some(replaced(words, at..at + 1, vec![(*ours).to_owned()]));
    }
    let (value, end) = match value {
        Some(value) => (value.to_owned(), at + 1),
        None => (next?.clone(), at + 2),
    };
    let value = value.split(',').map(|part| scaled(part, *factor)).collect::<Vec<_>>().join(",");
    let by = match ours.strip_prefix("--set=") {
        Some(field) => vec!["--set".to_owned(), format!("{field}={value}")],
        None => vec![(*ours).to_owned(), value],
    };
    Some(replaced(words, at..end, by))
}

/// A number times a factor; any other text as it is.
fn scaled(text: &str, factor: f64) -> String {
    match text.trim().parse::<f64>() {
        Ok(number) if factor != 1.0 => shown(number * factor),
        _ => text.trim().to_owned(),
    }
}

/// A number to nine digits.
fn shown(number: f64) -> String {
    format!("{number:.9}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The words without one too many: a format or a file to export to, a speed.
fn extra(name: &str, words: &[String], at: usize) -> Option<Vec<String>> {
    if name != "export" {
        return None;
    }
    let path = Path::new(&words[at]);
    let by = match path.extension() {
        Some(end) => {
            vec!["--to".to_owned(), end.to_string_lossy().into_owned(), "--out".to_owned(), words[at].clone()]
        }
        None => vec!["--to".to_owned(), words[at].to_lowercase()],
    };
    Some(replaced(words, at..at + 1, by))
}

fn value(flag: &str, wrong: &str, near: Option<String>) -> Option<String> {
    let lower = wrong.trim().to_lowercase();
    if let Some((_, ours)) = VALUES.iter().find(|(words, _)| flag == "--defect" && words.contains(&&*lower)) {
        return Some((*ours).to_owned());
    }
    let with_unit = UNITS.iter().filter(|(_, end, _)| flag.ends_with(end)).find_map(|(unit, _, factor)| {
        let number: f64 = lower.strip_suffix(unit)?.trim().parse().ok()?;
        Some(shown(number * factor))
    });
    // A decimal comma.
    let comma = || lower.replace(',', ".").parse::<f64>().ok().filter(|_| lower.contains(',')).map(shown);
    with_unit.or_else(comma).or(near)
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;
    use crate::Cli;

    #[cfg(feature = "full")]
    #[test]
    fn behaves_words_of_others_lead_to_our_commands() {
        let program = Cli::command();
        for (typed, ours) in [
            ("run mine.ron", "simulate mine.ron"),
            ("plot mine", "open mine"),
            ("mine.ron", "simulate mine.ron"),
            ("help run", "help simulate"),
            ("resume mine", "simulate --resume mine"),
            ("6205", "bearings 6205"),
            ("simulat mine.ron --sett model=full", "simulate mine.ron --set model=full"),
            (
                "simulate mine.ron --rpm 1800 --load_kn=2",
                "simulate mine.ron --set operation.speed_rpm=1800 --set operation.load_n=2000",
            ),
            (
                "new --bearing 6205 --load-kn 2 --speed-hz 25 --fault inner-race",
                "new --bearing 6205 --load-n 2000 --speed-rpm 1500 --defect inner",
            ),
            ("new --load-n 2kN --speed-rpm=25Hz", "new --load-n 2000 --speed-rpm=1500"),
            ("new --length-mm 0,5", "new --length-mm 0.5"),
            ("analyse r.csv --rpm 1797 --fs 25600", "analyse r.csv --speed-rpm 1797 --rate-hz 25600"),
            ("sweep mine.ron --length 0.2,0.4", "sweep mine.ron --set defect.length_mm=0.2,0.4"),
            ("export mine csv", "export mine --to csv"),
            ("export mine --csv", "export mine --to=csv"),
            ("export mine own.csv", "export mine --to csv --out own.csv"),
            ("delete mine --force", "rm mine --yes"),
        ] {
            let words: Vec<String> = typed.split(' ').map(str::to_owned).collect();
            let found = meant(&program, &words).unwrap_or_default().join(" ");
            assert_eq!(found, ours, "{typed}");
        }
        for typed in ["simulate mine.ron --purple", "qqq", "simulate mine.ron other.ron"] {
            let words: Vec<String> = typed.split(' ').map(str::to_owned).collect();
            assert_eq!(meant(&program, &words), None, "{typed}");
        }
    }
}
