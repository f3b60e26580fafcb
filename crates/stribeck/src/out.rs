//! Standard output: results for the user, or for another program that may close it before the end. Standard
//! error: progress, by `-q` and `-v`.

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
    on_error(words);
}

pub(crate) fn progress(words: Arguments<'_>) {
    if !is_quiet() {
        on_error(words);
    }
}

pub(crate) fn aside(words: Arguments<'_>) {
    if LOUDNESS.load(Ordering::Relaxed) == VERBOSE {
        on_error(words);
    }
}

pub(crate) fn warning(words: Arguments<'_>) {
    on_error(format_args!("{} {words}", marked("warning:", AnsiColor::Yellow)));
}

/// Prints an error with its causes.
pub(crate) fn error(error: &anyhow::Error, causes: &[String]) {
    on_error(format_args!("{} {error}", marked("error:", AnsiColor::Red)));
    causes.iter().for_each(|cause| on_error(format_args!("  because: {cause}")));
}

fn on_error(words: Arguments<'_>) {
    let since = BEGAN.get().filter(|_| LOUDNESS.load(Ordering::Relaxed) == VERBOSE);
    // A closed standard error cannot be reported.
    match since {
        Some(began) => drop(writeln!(stderr(), "[{:8.3} s] {words}", began.elapsed().as_secs_f64())),
        None => drop(writeln!(stderr(), "{words}")),
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
        *closed = writeln!(out, "{words}").and_then(|()| out.flush()).err();
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
