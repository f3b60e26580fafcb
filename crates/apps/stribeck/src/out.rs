//! Standard output: results for the user, or for another program that may close it before the end. Standard
//! error: progress, by `-q` and `-v`. All that is printed goes through [`harmless`]: names in files are of
//! others, and must not steer a terminal.

use std::borrow::Cow;
use std::fmt::Arguments;
use std::io::{Error, ErrorKind, IsTerminal, Write, stderr, stdout};
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::Instant;

use clap::builder::styling::{AnsiColor, Style};

/// How much is printed during a command.
#[derive(Debug, Clone, Copy, Default, clap::Args)]
pub struct Loudness {
    /// Prints results, warnings and errors only
    #[arg(short, long, global = true, conflicts_with = "verbose", display_order = 1000)]
    quiet: bool,
    /// Prints more: files read and written, each line with the seconds since the start
    #[arg(short, long, global = true, display_order = 1001)]
    verbose: bool,
}

const QUIET: u8 = 0;
const USUAL: u8 = 1;
const VERBOSE: u8 = 2;
static LOUDNESS: AtomicU8 = AtomicU8::new(USUAL);
static BEGAN: OnceLock<Instant> = OnceLock::new();

impl Loudness {
    /// The flag that asks another program for the same.
    pub fn flag(self) -> Option<&'static str> {
        match (self.quiet, self.verbose) {
            (true, _) => Some("--quiet"),
            (_, true) => Some("--verbose"),
            _ => None,
        }
    }

    /// Holds from now on.
    pub fn apply(self) {
        BEGAN.get_or_init(Instant::now);
        let level = match (self.quiet, self.verbose) {
            (true, _) => QUIET,
            (_, true) => VERBOSE,
            _ => USUAL,
        };
        LOUDNESS.store(level, Ordering::Relaxed);
    }
}

/// Whether progress is not printed.
pub(crate) fn is_quiet() -> bool {
    LOUDNESS.load(Ordering::Relaxed) == QUIET
}

/// Writes a line of progress to standard error, except with `--quiet`.
macro_rules! tell {
    ($($words:tt)*) => { $crate::out::progress(format_args!($($words)*)) };
}
pub(crate) use tell;

/// Writes a line to standard error for `--verbose` alone.
macro_rules! detail {
    ($($words:tt)*) => { $crate::out::aside(format_args!($($words)*)) };
}
pub(crate) use detail;

/// Writes a warning to standard error, always.
macro_rules! caution {
    ($($words:tt)*) => { $crate::out::warning(format_args!($($words)*)) };
}
pub(crate) use caution;

/// Writes a line to standard error, always: how something ended that did not end well.
macro_rules! alert {
    ($($words:tt)*) => { $crate::out::always(format_args!($($words)*)) };
}
pub(crate) use alert;

pub(crate) fn always(words: Arguments<'_>) {
    on_error("", words);
}

/// A text without characters that steer a terminal or turn the direction of writing round: they are written
/// as numbers, as JSON has them. Ends of lines and tabs stay.
pub(crate) fn harmless(text: &str) -> Cow<'_, str> {
    let steers = |c: char| c.is_control() && !matches!(c, '\n' | '\t') || turns(c);
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let shown = text.chars().map(|c| match c {
        c if !steers(c) => c.to_string(),
        '\0'..='\x1f' => format!("\\x{:02x}", u32::from(c)),
        c => format!("\\u{:04x}", u32::from(c)),
    });
    Cow::Owned(shown.collect())
}

/// Characters that change the direction or the order in which others are shown, or are not shown at all
/// (Unicode 15, Bidi_Control, and those of no width).
fn turns(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

pub(crate) fn progress(words: Arguments<'_>) {
    if !is_quiet() {
        on_error("", words);
    }
}

pub(crate) fn aside(words: Arguments<'_>) {
    if LOUDNESS.load(Ordering::Relaxed) == VERBOSE {
        on_error("", words);
    }
}

pub(crate) fn warning(words: Arguments<'_>) {
    on_error(&marked("warning: ", AnsiColor::Yellow), words);
}

pub(crate) fn error(error: &anyhow::Error, causes: &[String]) {
    on_error(&marked("error: ", AnsiColor::Red), format_args!("{error}"));
    causes.iter().for_each(|cause| on_error("", format_args!("  because: {cause}")));
}

/// Writes a line, with a mark before it that may be in colour.
fn on_error(mark: &str, words: Arguments<'_>) {
    let words = words.to_string();
    let words = harmless(&words);
    let since = BEGAN.get().filter(|_| LOUDNESS.load(Ordering::Relaxed) == VERBOSE);
    // A closed standard error cannot be reported.
    match since {
        Some(began) => drop(writeln!(stderr(), "[{:8.3} s] {mark}{words}", began.elapsed().as_secs_f64())),
        None => drop(writeln!(stderr(), "{mark}{words}")),
    }
}

/// A word in colour where a person reads it on a terminal.
fn marked(word: &str, colour: AnsiColor) -> String {
    let plain = std::env::var_os("NO_COLOR").is_some_and(|set| !set.is_empty())
        || std::env::var_os("TERM").is_some_and(|term| term == "dumb")
        || !stderr().is_terminal();
    if plain {
        return word.to_owned();
    }
    let style = Style::new().bold().fg_color(Some(colour.into()));
    format!("{style}{word}{style:#}")
}

/// The error that closed standard output, once it is closed.
static CLOSED: Mutex<Option<Error>> = Mutex::new(None);

/// Writes a line to standard output, as `println!` does. Where it is closed, as by `| head` after some lines,
/// the command continues, and [`trouble`] reports it at the end.
macro_rules! say {
    ($($words:tt)*) => { $crate::out::line(format_args!($($words)*)) };
}
pub(crate) use say;

pub(crate) fn line(words: Arguments<'_>) {
    write_line(&mut stdout(), &mut CLOSED.lock().unwrap_or_else(PoisonError::into_inner), words);
}

fn write_line(out: &mut dyn Write, closed: &mut Option<Error>, words: Arguments<'_>) {
    if closed.is_none() {
        let words = words.to_string();
        *closed = writeln!(out, "{}", harmless(&words)).and_then(|()| out.flush()).err();
    }
}

/// The error that kept lines from standard output, such as a full disk; none where the reader closed it.
pub(crate) fn trouble() -> Option<String> {
    told(CLOSED.lock().unwrap_or_else(PoisonError::into_inner).take())
}

fn told(closed: Option<Error>) -> Option<String> {
    let error = closed.filter(|error| error.kind() != ErrorKind::BrokenPipe)?;
    Some(format!("what the command says could not be written to standard output: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Takes some lines, and refuses the next with an error of a kind.
    struct Takes(usize, ErrorKind);

    impl Write for Takes {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            if self.0 == 0 {
                return Err(self.1.into());
            }
            self.0 -= usize::from(bytes.contains(&b'\n'));
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn issue_names_do_not_steer_a_terminal() {
        let said = harmless("a\u{1b}[31m\r\u{7}\u{9b}2J \u{202e}gpj.\u{2066}\n\tµ²–é");
        assert_eq!(said, "a\\x1b[31m\\x0d\\x07\\u009b2J \\u202egpj.\\u2066\n\tµ²–é");
        assert!(matches!(harmless("plain, µm/s²\n"), Cow::Borrowed(_)));
    }

    #[test]
    fn survives_an_output_that_closes_and_tells_of_a_full_disk() {
        for (kind, tells) in [(ErrorKind::BrokenPipe, false), (ErrorKind::StorageFull, true)] {
            let (mut out, mut closed) = (Takes(2, kind), None);
            for n in 0..4 {
                write_line(&mut out, &mut closed, format_args!("line {n}"));
                assert_eq!(closed.is_some(), n >= 2, "{kind:?}");
            }
            assert_eq!(told(closed).is_some(), tells, "{kind:?}");
        }
    }
}
