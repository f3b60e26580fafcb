//! The help of the program: its commands by what one wants to do.

use clap::{Command as Flags, Subcommand};

use crate::Command;

/// Groups of commands, in the order of the help.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Simulate a bearing", &["demo", "new", "plan", "simulate", "lab"]),
    ("Diagnose records", &["analyse", "compare", "machine", "detect"]),
    ("Many runs", &["sweep"]),
    ("For other programs", &["export", "fmu", "stiffness"]),
    (
        "Runs, names, checks",
        &["list", "open", "report", "rm", "bearings", "fields", "validate", "completions", "help"],
    ),
];

/// Where most begin.
const EXAMPLES: &str = "\
Examples:
  stribeck new mine.ron --bearing 6205 --defect outer            a scene of your own
  stribeck simulate mine.ron                                     its run, with a page
  stribeck analyse record.mat --bearing 6205 --speed-rpm 1797    the verdict on a record";

/// The form of `stribeck --help`, as clap takes it.
pub(crate) fn template() -> String {
    let all = Command::augment_subcommands(Flags::new("stribeck"))
        .subcommand(Flags::new("help").about("Prints the help of a command"));
    let about = |name: &str| {
        let about = all.find_subcommand(name).and_then(Flags::get_about);
        format!("  {name:<12} {}\n", about.map(ToString::to_string).unwrap_or_default())
    };
    let group = |(title, names): &(&str, &[&str])| {
        format!("{title}:\n{}\n", names.iter().map(|name| about(name)).collect::<String>())
    };
    let groups: String = GROUPS.iter().map(group).collect();
    format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{EXAMPLES}\n\n{groups}Options:\n{{options}}{{after-help}}"
    )
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;
    use crate::Cli;

    #[test]
    fn behaves_every_command_stands_in_one_group_and_on_one_line() {
        let program = Cli::command();
        for command in program.get_subcommands() {
            let name = command.get_name();
            let groups = GROUPS.iter().filter(|(_, names)| names.contains(&name)).count();
            assert_eq!(groups, 1, "{name}");
        }
        let help = template();
        for line in help.lines().filter(|line| line.starts_with("  ")) {
            assert!(line.chars().count() <= 100, "{line}");
            assert!(line.trim().contains("  ") || line.trim().contains(' '), "without words: {line}");
        }
    }
}
