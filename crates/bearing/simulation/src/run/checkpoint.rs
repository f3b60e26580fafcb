//! The checkpoint of a run: the state from which it continues to the same bits, and its file.
//!
//! ```text
//! stribeck checkpoint\n   version u32   identity, 16 letters   length u64   CRC-32 of the content u32   content
//! ```
//!
//! The identity is that of the scene but for its duration ([`identity`]), so that a run can be made longer.
//! Numbers are little-endian; the content is in [postcard](https://postcard.jamesmunns.com) format. Mesh and
//! layout are no part of it: they follow from the scene.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::error::Error;
use stribeck_scene::scene::Scene;
use stribeck_store::run_info::RunInfo;

/// First bytes of every checkpoint.
const MAGIC: &[u8; 20] = b"stribeck checkpoint\n";

/// Version of the file. Other versions are refused, because a state that is read in part does not continue to
/// the same bits.
const VERSION: u32 = 22;

/// Length of a scene's hash.
const HASH: usize = 16;

const HEADER: usize = MAGIC.len() + 4 + HASH + 8 + 4;

/// A longer content is refused: a thousand times the paper's bearing.
const MAX_CONTENT: u64 = 1 << 32;

/// A run between two samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint<S> {
    /// Content of `run.json` at this sample.
    pub info: RunInfo,
    /// State of the model in motion.
    pub motion: S,
}

impl<S: Serialize + DeserializeOwned> Checkpoint<S> {
    /// The file's bytes, for a scene of this [`identity`]; `path` is for the message.
    pub(crate) fn encode(&self, path: &Path, identity: &str) -> Result<Vec<u8>, Error> {
        let mut bytes = Vec::with_capacity(HEADER);
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(identity.as_bytes());
        // Length and checksum follow when they are known.
        bytes.resize(HEADER, 0);
        let mut bytes = postcard::to_extend(self, bytes)
            .map_err(|e| refused(path, format!("its checkpoint cannot be written ({e})")))?;
        let content = &bytes[HEADER..];
        let (length, checksum) = (content.len() as u64, crc32fast::hash(content));
        bytes[HEADER - 12..HEADER - 4].copy_from_slice(&length.to_le_bytes());
        bytes[HEADER - 4..HEADER].copy_from_slice(&checksum.to_le_bytes());
        Ok(bytes)
    }

    /// Reads the checkpoint at `path` of the scene with the [`identity`] `scene`. Memory is bounded by the
    /// size of the file.
    pub(crate) fn read(path: &Path, scene: &str) -> Result<Self, Error> {
        let bad = |reason: String| refused(path, reason);
        let io = |source| stribeck_store::Error::Io {
            action: "read",
            path: path.to_owned(),
            kept: "Nothing was changed; the samples of the run stay readable".to_owned(),
            source,
        };
        let mut file = match File::open(path) {
            Ok(file) => file,
            Err(e) if e.kind() == ErrorKind::NotFound => {
                return Err(bad("it has no checkpoint: it ended before its first step".to_owned()));
            }
            Err(e) => return Err(io(e).into()),
        };
        let mut header = Vec::with_capacity(HEADER);
        file.by_ref().take(HEADER as u64).read_to_end(&mut header).map_err(io)?;
        let (length, checksum) = parse(&header, scene).map_err(bad)?;
        let mut content = Vec::new();
        file.take(length + 1).read_to_end(&mut content).map_err(io)?;
        if content.len() as u64 != length {
            let found =
                if content.len() as u64 > length { "more".to_owned() } else { content.len().to_string() };
            return Err(bad(format!(
                "its checkpoint should hold {length} bytes and holds {found}: it was cut off or glued"
            )));
        }
        if crc32fast::hash(&content) != checksum {
            return Err(bad("the checksum of its checkpoint is wrong: it was damaged".to_owned()));
        }
        match postcard::take_from_bytes(&content) {
            Ok((checkpoint, [])) => Ok(checkpoint),
            Ok(_) => Err(bad("its checkpoint holds more than this program expects".to_owned())),
            Err(e) => Err(bad(format!("its checkpoint is not what this program expects ({e})"))),
        }
    }
}

/// Identity that ties a checkpoint to its scene: the hash of the scene without its duration.
pub fn identity(scene: &Scene) -> String {
    let mut scene = scene.clone();
    scene.solver.duration_ms = 0.0;
    scene.hash()
}

/// The error for a checkpoint that cannot be used, after which a run can only begin again.
fn refused(path: &Path, reason: String) -> Error {
    let reason = format!(
        "{reason}. Otherwise start it anew from its `scene.ron`; its samples stay readable until then"
    );
    Error::Resume { path: path.parent().unwrap_or(path).to_owned(), reason }
}

/// Length and checksum of the content.
fn parse(header: &[u8], scene: &str) -> Result<(u64, u32), String> {
    let Some(rest) = header.strip_prefix(MAGIC) else {
        return Err("its checkpoint does not begin like one: it is another file".to_owned());
    };
    let cut = || "its checkpoint ends inside its header: it was cut off".to_owned();
    let (version, rest) = rest.split_first_chunk().ok_or_else(cut)?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(format!(
            "its checkpoint has the version {version}, and this program reads {VERSION}. Continue the run \
             with the program that began it, named in `run.json`"
        ));
    }
    let (hash, rest) = rest.split_at_checked(HASH).ok_or_else(cut)?;
    if hash != scene.as_bytes() {
        return Err(format!(
            "its checkpoint belongs to another scene than `scene.ron` ({} and {scene}, but for the \
             duration). Put the run's own `scene.ron` back; a changed scene needs a new run",
            String::from_utf8_lossy(hash).escape_debug()
        ));
    }
    let (length, rest) = rest.split_first_chunk().ok_or_else(cut)?;
    let checksum = rest.first_chunk().ok_or_else(cut)?;
    let length = u64::from_le_bytes(*length);
    if length > MAX_CONTENT {
        return Err(format!("its checkpoint claims {length} bytes; the limit is {MAX_CONTENT}"));
    }
    Ok((length, u32::from_le_bytes(*checksum)))
}
