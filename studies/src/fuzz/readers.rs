//! Files of signals and meshes, most of them damaged: what we read of each, and what other programs do.
//!
//! Where both read the numbers must be the same: as many samples, the same rms, the same rate. Otherwise one
//! of the two is wrong, and says nothing.

mod forms;
mod judge;
mod page;
mod peer;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use stribeck_formats::Recording;
use stribeck_mesh::decks::Deck;

use super::{Answer, damage};
use stribeck_scene::dice::Dice;

pub(super) use peer::{Wanted, against};

/// Formats with their shares of all inputs.
const SHARES: [(&str, usize); 13] = [
    ("csv", 16),
    ("npy", 6),
    ("npz", 3),
    ("mat", 8),
    ("h5", 8),
    ("tdms", 10),
    ("mf4", 8),
    ("parquet", 5),
    ("wav", 8),
    ("flac", 2),
    ("uff", 8),
    ("inp", 6),
    ("msh", 6),
];

/// Samples of a channel that are looked at: a forged file may promise any number.
const MOST: u64 = 1 << 20;

/// Good files, by format.
pub(super) struct Shelf {
    files: Vec<(String, String, Vec<u8>)>,
}

/// A file that was made of a good one.
pub(super) struct Made {
    pub(super) kind: &'static str,
    /// The good file, and its damage.
    pub(super) from: String,
    pub(super) done: &'static str,
    pub(super) bytes: Vec<u8>,
    /// Arguments of pandas for a text, and its sample rate [Hz].
    told: Option<Value>,
    rate_hz: Option<f64>,
}

/// A channel as one of two readers has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Held {
    name: String,
    /// Samples; `None` where the other program leaves out those that are invalid.
    len: Option<u64>,
    /// Those that are finite numbers, and their rms.
    numbers: u64,
    rms: f64,
    rate_hz: Option<f64>,
}

/// Result of a reader: channels, or the reason why there are none.
pub(super) type Reading = std::result::Result<Vec<Held>, String>;

impl Shelf {
    /// The files of `fixtures/signals/small`.
    pub(super) fn open() -> Result<Self> {
        let folder = stribeck_studies::root().join("fixtures/signals/small");
        let list = std::fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
        let mut files = Vec::new();
        for entry in list {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let kind = path.extension().unwrap_or_default().to_string_lossy().into_owned();
            files.push((kind, name, std::fs::read(&path)?));
        }
        files.sort();
        ensure!(files.len() > 20, "`{}` holds {} files", folder.display(), files.len());
        Ok(Self { files })
    }

    /// One file of any format.
    pub(super) fn make(&self, dice: &mut Dice) -> Made {
        let mut at = dice.below(SHARES.iter().map(|(_, share)| share).sum());
        let kind = SHARES.iter().find(|(_, share)| {
            let here = at < *share;
            at = at.saturating_sub(*share);
            here
        });
        let kind = kind.map_or("csv", |(kind, _)| *kind);
        if kind == "csv" {
            return forms::table(dice);
        }
        let of: Vec<_> = self.files.iter().filter(|(has, ..)| has == kind).collect();
        let (_, name, good) = of[dice.below(of.len())];
        let text = matches!(kind, "inp" | "msh" | "uff") && !name.starts_with("binary");
        let (done, bytes) =
            if text && !dice.one_in(4) { forms::lines(good, dice) } else { damage::fields(good, dice) };
        Made { kind, from: name.clone(), done, bytes, told: None, rate_hz: None }
    }
}

/// Our reading of a file.
pub(super) fn ours(path: &Path, kind: &str) -> Reading {
    match kind {
        "inp" | "msh" => mesh(path, kind),
        _ => signals(path),
    }
}

fn signals(path: &Path) -> Reading {
    let found = Recording::open(path).map_err(|why| why.to_string())?;
    let mut held = Vec::new();
    let mut refused = None;
    for channel in &found.channels {
        let (mut len, mut numbers, mut sum) = (0_u64, 0_u64, 0.0);
        let done = channel.for_each_block(|block| {
            len += block.len() as u64;
            let finite = block.iter().filter(|x| x.is_finite());
            finite.for_each(|x| {
                numbers += 1;
                sum += x * x;
            });
            len < MOST
        });
        match done {
            Ok(()) => held.push(Held {
                name: channel.name.clone(),
                len: Some(len),
                numbers,
                rms: if numbers > 0 { (sum / numbers as f64).sqrt() } else { 0.0 },
                rate_hz: channel.rate_hz,
            }),
            Err(why) => refused = Some(why.to_string()),
        }
    }
    match refused {
        Some(why) if held.is_empty() => Err(why),
        _ if held.is_empty() => Err(format!("no channel: {}", found.notes.join("; "))),
        _ => Ok(held),
    }
}

/// Areas and middles of the elements, in the place of samples.
fn mesh(path: &Path, kind: &str) -> Reading {
    let bytes = std::fs::read(path).map_err(|why| why.to_string())?;
    let deck = Deck::of_extension(kind).ok_or_else(|| format!("no format `{kind}`"))?;
    let mesh = deck.read_bytes(&bytes).map_err(|why| why.to_string())?.mesh;
    let squares = |corners: &[u32]| {
        let at: Vec<[f64; 2]> = corners.iter().map(|n| [mesh.x[*n as usize], mesh.y[*n as usize]]).collect();
        let next = at.iter().cycle().skip(1);
        let area = 0.5 * at.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>();
        let middle = [0, 1].map(|axis| at.iter().map(|p| p[axis]).sum::<f64>() / at.len() as f64);
        area * area + middle[0] * middle[0] + middle[1] * middle[1]
    };
    let quads: Vec<f64> = mesh.quads.iter().map(|q| squares(q)).collect();
    let triangles: Vec<f64> = mesh.triangles.iter().map(|t| squares(t)).collect();
    let sorts = [("quad", quads), ("triangle", triangles)];
    let held = sorts.into_iter().filter(|(_, all)| !all.is_empty()).map(|(name, all)| {
        let numbers = all.iter().filter(|x| x.is_finite()).count() as u64;
        let sum: f64 = all.iter().filter(|x| x.is_finite()).sum();
        let rms = if numbers > 0 { (sum / numbers as f64).sqrt() } else { 0.0 };
        Held { name: name.to_owned(), len: Some(all.len() as u64), numbers, rms, rate_hz: None }
    });
    let held: Vec<Held> = held.collect();
    if held.is_empty() { Err("no element of the plane".to_owned()) } else { Ok(held) }
}

/// One file without another reader: it must get an answer.
pub(super) fn attempt(shelf: &Shelf, folder: &Path, dice: &mut Dice) -> Result<Answer> {
    let made = shelf.make(dice);
    let path = folder.join(format!("generated.{}", made.kind));
    std::fs::write(&path, &made.bytes)?;
    match ours(&path, made.kind) {
        Ok(_) => Ok(Answer::Taken),
        Err(why) => {
            ensure!(why.len() > 10, "refused without words: {why}");
            Ok(Answer::Refused)
        }
    }
}

/// Where the files of a batch are.
fn place(folder: &Path, n: usize, kind: &str) -> PathBuf {
    folder.join(format!("{n:05}.{kind}"))
}

/// Success unless there are differences that nobody can explain.
fn code(unexplained: u64) -> ExitCode {
    if unexplained == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
