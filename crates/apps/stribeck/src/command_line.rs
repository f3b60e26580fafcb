//! The command line: a mistake in it is answered with what other programs' words are called here, or with an example
//! of its command.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::io::Write;
use std::path::Path;

use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use clap::{Command, Parser};
use stribeck_scene::catalogue;

use crate::out::harmless;
use crate::place::REPOSITORY;

/// The parsed command line. Help, the version and mistakes end the program.
pub fn parse<C: Parser>() -> C {
    let mut command = C::command();
    if std::env::var_os(REPOSITORY).is_some() {
        // Usage is that of the program which handed the command on.
        command = command.bin_name("cargo xtask");
    }
    let parsed = command.try_get_matches().and_then(|matches| C::from_arg_matches(&matches));
    parsed.unwrap_or_else(|error| {
        let words: Vec<String> = std::env::args().skip(1).collect();
        let mistake = error.use_stderr();
        let tip = ours(&error).or_else(|| example(&C::command(), &words));
        let mut plain = without_trailing(error);
        if tip.as_ref().is_some_and(|tip| tip.starts_with("try: ")) {
            plain.remove(ContextKind::SuggestedArg);
            plain.remove(ContextKind::SuggestedSubcommand);
        }
        match harmless(&plain.render().to_string()) {
            Cow::Borrowed(_) => drop(plain.print()),
            // What was typed is repeated, and may be the name of a file of others.
            Cow::Owned(words) => drop(write!(std::io::stderr(), "{words}")),
        }
        if let (true, Some(tip)) = (mistake, tip) {
            eprintln!("{tip}");
        }
        std::process::exit(if mistake { 2 } else { 0 })
    })
}

/// Words of other programs, and ours: what clap's aliases and nearest names do not reach.
const OURS: [(&[&str], &str); 15] = [
    (&["resume", "continue"], "stribeck simulate --resume RUN"),
    (&["version"], "stribeck --version"),
    (&["--dry-run", "check"], "stribeck plan SCENE.ron"),
    (&["--seconds", "--duration", "--duration-s", "--duration-ms"], "--set solver.duration_ms=…, in ms"),
    (
        &["--rpm", "--speed", "--speed-rpm", "--speed-hz"],
        "--set operation.speed_rpm=…, or --speed-rpm, in rpm",
    ),
    (&["--load", "--load-kn", "--load-n"], "--set operation.load_n=…, or --load-n, in N"),
    (&["--length", "--length-mm"], "--set defect.length_mm=…, or --length-mm, in mm"),
    (&["--bearing"], "--set bearing=NAME"),
    (&["--search", "--find"], "stribeck bearings 62, with the beginning of names; without one, all"),
    (&["--list-channels", "--channels"], "--channel ?, which lists them"),
    (
        &["mv", "rename", "copy", "cp"],
        "stribeck simulate SCENE.ron --name NAME, or move the folder runs/NAME",
    ),
    (&["--fs", "--rate", "--sample-rate"], "--rate-hz HZ"),
    (&["--force", "-f"], "--overwrite of simulate, --yes of rm"),
    (&["csv", "--csv", "wav", "--wav", "mat", "--mat", "npz", "--npz"], "stribeck export RUN --to FORMAT"),
    (&["inner-race", "inner-ring", "outer-race", "outer-ring", "ball"], "outer, inner, roller or none"),
];

/// What the word that was not understood is called here; for a file in the place of a command the one that reads it.
fn ours(error: &Error) -> Option<String> {
    let said = |kind| match error.get(kind) {
        Some(ContextValue::String(one)) => Some(one.clone()),
        _ => None,
    };
    let wrong = match error.kind() {
        ErrorKind::InvalidSubcommand => said(ContextKind::InvalidSubcommand)?,
        ErrorKind::UnknownArgument => said(ContextKind::InvalidArg)?,
        ErrorKind::InvalidValue => said(ContextKind::InvalidValue)?,
        _ => return None,
    };
    let dashed = wrong.replace('_', "-");
    // The flag of this command, but for its dashes.
    if said(ContextKind::SuggestedArg).is_some_and(|flag| flag == dashed) {
        return None;
    }
    let found = OURS.iter().find(|(typed, _)| typed.contains(&dashed.as_str()));
    let command = || match Path::new(&wrong).extension().and_then(OsStr::to_str) {
        _ if error.kind() != ErrorKind::InvalidSubcommand => None,
        Some("ron") => Some("stribeck simulate SCENE.ron"),
        Some(_) if Path::new(&wrong).is_file() => Some("stribeck analyse FILE"),
        _ if wrong.contains(|c: char| c.is_ascii_digit()) && catalogue::parse(&wrong).is_ok() => {
            Some("stribeck bearings NAME")
        }
        _ => None,
    };
    found.map(|(_, ours)| *ours).or_else(command).map(|ours| format!("try: {ours}"))
}

/// The example in the help of the command that `words` begin with.
fn example(program: &Command, words: &[String]) -> Option<String> {
    let command = words.iter().find_map(|word| program.find_subcommand(word))?;
    command.get_after_help().map(ToString::to_string)
}

/// Without the advice to pass an unknown flag as a value, as `-- --flag`: nobody means that here.
fn without_trailing(mut error: Error) -> Error {
    if error.kind() == ErrorKind::UnknownArgument && error.get(ContextKind::SuggestedArg).is_none() {
        error.remove(ContextKind::Suggested);
    }
    error
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;
    use crate::Cli;

    /// Words of a line as a shell has them: between blanks outside of quotes, up to a redirection.
    fn words(line: &str) -> Vec<String> {
        let mut words = vec![String::new()];
        let mut quoted = false;
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ' ' if !quoted => words.push(String::new()),
                _ => words.last_mut().expect("one at least").push(c),
            }
        }
        words.into_iter().take_while(|word| word != ">").collect()
    }

    #[test]
    fn behaves_every_command_has_an_example_that_is_right() {
        let program = Cli::command();
        for command in program.get_subcommands() {
            let example = example(&program, &[command.get_name().to_owned()]).expect("an example");
            let line = example.strip_prefix("Example: ").expect("how it begins");
            assert!(line.starts_with(&format!("stribeck {}", command.get_name())), "{line}");
            assert!(Cli::try_parse_from(words(line)).is_ok(), "{line}");
        }
    }

    #[test]
    fn refuses_an_unknown_flag_without_absurd_advice() {
        let said = |line: &str| {
            let error = Cli::try_parse_from(words(line)).expect_err(line);
            without_trailing(error).to_string()
        };
        let all = said("stribeck rm --all");
        assert!(all.contains("unexpected argument '--all'") && !all.contains("as a value"), "{all}");
        assert!(said("stribeck list --jsn").contains("'--json'"));
    }
}
