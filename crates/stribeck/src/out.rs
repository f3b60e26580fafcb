//! Standard output: what the user reads, or another program that may close it before the end.

use std::fmt::Arguments;
use std::io::{Error, ErrorKind, Write, stdout};
use std::sync::{Mutex, PoisonError};

/// Why standard output took no more, once it did not.
static CLOSED: Mutex<Option<Error>> = Mutex::new(None);

/// Writes a line to standard output, as `println!` does. Where it takes no more, as that of `| head` after
/// some lines, what the command does besides goes on, and [`trouble`] knows of it at the end.
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

/// What kept lines from standard output, such as a full disk; nothing where a reader had enough of them.
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
