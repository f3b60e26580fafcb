//! The command line: a mistake in it is answered with the line that was probably meant, or else with an example
//! of its command.

mod meant;

use std::borrow::Cow;
use std::io::Write;

use clap::error::{ContextKind, Error, ErrorKind};
use clap::{Command, Parser};

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
        let program = C::command();
        let meant = meant::meant(&program, &words).map(|line| format!("try: {}", shown(&line)));
        let meant_one = meant.is_some();
        let example = meant.or_else(|| example(&program, &words));
        let mistake = error.use_stderr();
        let mut error = without_trailing(error);
        if meant_one {
            error.remove(ContextKind::SuggestedSubcommand);
        }
        let plain = error.render().to_string();
        match harmless(&plain) {
            Cow::Borrowed(_) => drop(error.print()),
            // What was typed is repeated, and may be the name of a file of others.
            Cow::Owned(words) => drop(write!(std::io::stderr(), "{words}")),
        }
        if let (true, Some(example)) = (mistake, example) {
            eprintln!("{example}");
        }
        std::process::exit(if mistake { 2 } else { 0 })
    })
}

/// A command line as a shell takes it.
fn shown(words: &[String]) -> String {
    let program = if std::env::var_os(REPOSITORY).is_some() { "cargo xtask" } else { "stribeck" };
    let plain = |c: char| c.is_alphanumeric() || "-_.,:/=+%@~".contains(c);
    let quoted = |word: &String| match word.chars().all(plain) && !word.is_empty() {
        true => harmless(word).into_owned(),
        false => format!("'{}'", harmless(word).replace('\'', "'\\''")),
    };
    std::iter::once(program.to_owned()).chain(words.iter().map(quoted)).collect::<Vec<_>>().join(" ")
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
