//! A file of signals and its channels.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use crate::{Channel, Error, Result};

/// Channels of one file.
#[derive(Debug, Clone)]
pub struct Recording {
    /// The file.
    pub path: PathBuf,
    /// Its format, in words.
    pub format: &'static str,
    /// Its channels, in the order of the file. Numbers that stand alone (a speed, a sensitivity) are channels
    /// of one sample.
    pub channels: Vec<Channel>,
    /// Irregularities of the file.
    pub notes: Vec<String>,
}

impl Recording {
    /// The channel called `name`, that of the n-th column of a text for `column n`, or the only one whose
    /// name contains it.
    ///
    /// # Errors
    /// [`Error::NoChannel`] with the names that there are.
    pub fn channel(&self, name: &str) -> Result<&Channel> {
        if let Some(channel) = self.channels.iter().find(|c| c.name == name) {
            return Ok(channel);
        }
        // The headings of a table may be counts from 0, or names that are hard to type.
        let number = name.strip_prefix("column ").and_then(|n| n.trim().parse::<usize>().ok());
        let column = self.channels.iter().find(|c| c.column.is_some() && c.column == number);
        if let Some(channel) = column {
            return Ok(channel);
        }
        let mut like = self.channels.iter().filter(|c| c.name.contains(name));
        match (like.next(), like.next()) {
            (Some(channel), None) => Ok(channel),
            _ => Err(Error::NoChannel { path: self.path.clone(), asked: name.to_owned(), has: self.names() }),
        }
    }

    /// Gives channels whose name another one has before them a number behind it, with a note.
    pub(crate) fn told_apart(mut self) -> Self {
        let mut taken: HashSet<String> = self.channels.iter().map(|c| c.name.clone()).collect();
        let (mut seen, mut renamed) = (HashMap::<String, usize>::new(), Vec::new());
        for channel in &mut self.channels {
            let count = seen.entry(channel.name.clone()).or_insert(0);
            *count += 1;
            if *count == 1 {
                continue;
            }
            let mut name = format!("{} ({count})", channel.name);
            while !taken.insert(name.clone()) {
                *count += 1;
                name = format!("{} ({count})", channel.name);
            }
            if !channel.is_time {
                renamed.push(format!("`{name}`"));
            }
            channel.name = name;
        }
        if let Some(first) = renamed.first() {
            let more =
                if renamed.len() > 1 { format!(" to {}", renamed[renamed.len() - 1]) } else { String::new() };
            self.notes.push(format!("names occur twice: those behind the first are {first}{more}"));
        }
        self
    }

    /// Names and lengths of the channels, for messages.
    pub fn names(&self) -> String {
        const SHOWN: usize = 10;
        let mut all: Vec<String> =
            self.channels.iter().take(SHOWN).map(|c| format!("`{}` ({} samples)", c.name, c.len)).collect();
        if self.channels.len() > SHOWN {
            all.push(format!("{} more", self.channels.len() - SHOWN));
        }
        if all.is_empty() { "none".to_owned() } else { all.join(", ") }
    }
}

/// Why a channel is none, in the words that all formats use.
pub(crate) fn left_out(name: &str, why: &str) -> String {
    format!("`{name}`{LEFT_OUT}{why}")
}

/// By which such a note is known.
pub(crate) const LEFT_OUT: &str = " is left out: ";

/// Refuses channels of different lengths, which a table cannot hold; returns that length.
pub(crate) fn equal_lengths(path: &Path, format: &'static str, channels: &[Channel]) -> Result<u64> {
    let len = channels.first().map_or(0, |c| c.len);
    match channels.iter().find(|c| c.len != len) {
        None => Ok(len),
        Some(other) => Err(Error::DoesNotFit {
            path: path.to_owned(),
            format,
            what: format!(
                "`{}` has {len} samples and `{}` has {}; write them to a file each",
                channels[0].name, other.name, other.len
            ),
        }),
    }
}
