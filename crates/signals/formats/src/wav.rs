//! WAV and RF64: whole numbers of 8 to 32 bits, which are scaled to ±1, and floats, which are taken as they
//! are.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use stribeck_dsp::channel::Samples;
use stribeck_dsp::channel::wav::{FLOAT, Format, PCM};
pub use stribeck_dsp::channel::wav::{Whole, pcm};

use crate::curve::{Curve, along};
use crate::number::{Kind, Number};
use crate::recording::equal_lengths;
use crate::strided::Strided;
use crate::{Channel, Error, Recording, Result};

const FORMAT: &str = "WAV";
const EXTENSIBLE: u16 = 0xfffe;

/// Opens a file; channels are called `1`, `2`, … and their samples stay in the file.
///
/// # Errors
/// [`Error::Damaged`], [`Error::Unsupported`] for compressed sound, [`Error::Io`].
pub fn open(path: &Path) -> Result<Recording> {
    let io = |e| Error::read(path, e);
    let damaged = |what: &str| Error::damaged(path, FORMAT, what);
    let mut file = BufReader::new(File::open(path).map_err(io)?);
    let size = file.get_ref().metadata().map_err(io)?.len();
    let mut at = 12;
    let (mut format, mut frame, mut long_data) = (None::<Format>, 0, None);
    let mut pieces: Vec<Recording> = Vec::new();
    while at + 8 <= size {
        file.seek(SeekFrom::Start(at)).map_err(io)?;
        let mut tag = [0; 8];
        file.read_exact(&mut tag).map_err(io)?;
        let length = u64::from(u32::from_le_bytes([tag[4], tag[5], tag[6], tag[7]]));
        let mut bytes = Vec::new();
        match &tag[..4] {
            b"fmt " | b"ds64" => {
                (&mut file).take(length.min(64)).read_to_end(&mut bytes).map_err(io)?;
                let half = |n: usize| {
                    u16::from_le_bytes([
                        bytes.get(n).copied().unwrap_or(0),
                        bytes.get(n + 1).copied().unwrap_or(0),
                    ])
                };
                if &tag[..4] == b"ds64" {
                    long_data = bytes.get(8..16).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes);
                } else {
                    let code = if half(0) == EXTENSIBLE { half(24) } else { half(0) };
                    let rate_hz = u32::from(half(4)) | u32::from(half(6)) << 16;
                    let said = Format { code, channels: half(2), rate_hz, bits: half(14) };
                    if let Some(before) = format.filter(|before| *before != said) {
                        let spelt = |of: Format| {
                            format!("{} Hz, {} bits, {} channels", of.rate_hz, of.bits, of.channels)
                        };
                        let [first, second] = [before, said].map(spelt);
                        return Err(damaged(&format!("it says its format twice: {first}; then {second}")));
                    }
                    format = Some(said);
                    frame = usize::from(half(12));
                }
            }
            b"data" => {
                let format = format.ok_or_else(|| damaged("the samples come before their format"))?;
                let behind = at + 8 + length;
                let ends = behind >= size || is_piece(&mut file, behind, size).map_err(io)?;
                let data = Data { at: at + 8, there: size - at - 8, length, long_data, ends };
                pieces.push(samples(path, format, frame, data)?);
                if !ends || behind >= size {
                    break;
                }
            }
            _ => {}
        }
        // Pieces begin at even bytes; some writers forget to pad.
        let end = at + 8 + length;
        at = end.next_multiple_of(2);
        if at != end && at <= size {
            file.seek(SeekFrom::Start(end)).map_err(io)?;
            let mut name = Vec::new();
            (&mut file).take(4).read_to_end(&mut name).map_err(io)?;
            if name.len() == 4 && name[0] != 0 && name.iter().all(|b| b.is_ascii_graphic() || *b == b' ') {
                at = end;
            }
        }
    }
    joined(pieces).ok_or_else(|| damaged("it ends before its samples"))
}

/// The pieces of samples, one behind the other.
fn joined(pieces: Vec<Recording>) -> Option<Recording> {
    let count = pieces.len();
    let mut pieces = pieces.into_iter();
    let mut all = pieces.next()?;
    let rest: Vec<Recording> = pieces.collect();
    if !rest.is_empty() {
        for (n, channel) in all.channels.iter_mut().enumerate() {
            let parts: Vec<Channel> =
                rest.iter().filter_map(|piece| piece.channels.get(n).cloned()).collect();
            let (len, first) =
                (channel.len + parts.iter().map(|part| part.len).sum::<u64>(), channel.clone());
            let samples = Parts([vec![first], parts].concat());
            *channel = Channel::new(channel.name.clone(), len, samples).at_rate(channel.rate_hz);
        }
        all.notes.push(format!("its samples stand in {count} pieces, which are put one behind the other"));
    }
    Some(all)
}

/// Samples of channels, one behind the other.
#[derive(Debug)]
struct Parts(Vec<Channel>);

impl Samples for Parts {
    fn for_each_block(&self, _: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let mut goes_on = true;
        for part in &self.0 {
            part.for_each_block(|block| {
                goes_on = take(block);
                goes_on
            })?;
            if !goes_on {
                break;
            }
        }
        Ok(())
    }
}

/// Where the piece `data` begins, how many bytes are there, and how many its header and that of a long file
/// promise.
#[derive(Debug, Clone, Copy)]
struct Data {
    at: u64,
    there: u64,
    length: u64,
    long_data: Option<u64>,
    /// Whether another piece follows, or nothing.
    ends: bool,
}

/// Whether a piece with a name and a length that fits begins at `at` or at the next even byte.
fn is_piece(file: &mut BufReader<File>, at: u64, size: u64) -> std::io::Result<bool> {
    for at in [at, at.next_multiple_of(2)] {
        let mut head = Vec::new();
        file.seek(SeekFrom::Start(at))?;
        file.by_ref().take(8).read_to_end(&mut head)?;
        let length = head.get(4..8).and_then(|b| b.try_into().ok()).map_or(0, u32::from_le_bytes);
        let name = head.get(..4).is_some_and(|name| name.iter().all(|b| b.is_ascii_graphic() || *b == b' '));
        if name && at + 8 + u64::from(length) <= size {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The channels of the piece `data`, whose header gives `frame` bytes to a sample of all channels, or none.
fn samples(path: &Path, format: Format, frame: usize, data: Data) -> Result<Recording> {
    let Format { code, channels, rate_hz, bits } = format;
    let (kind, factor) = match (code, bits) {
        (PCM, 8) => (Kind::U8, 1.0 / 128.0),
        (PCM, 16) => (Kind::I16, 1.0 / 32_768.0),
        (PCM, 24) => (Kind::I24, 1.0 / 8_388_608.0),
        (PCM, 32) => (Kind::I32, 1.0 / 2_147_483_648.0),
        (FLOAT, 32) => (Kind::F32, 1.0),
        (FLOAT, 64) => (Kind::F64, 1.0),
        _ => {
            let what = format!("sound of format {code} with {bits} bits");
            let advice = "save it as PCM or floating point";
            return Err(Error::Unsupported { path: path.to_owned(), format: FORMAT, what, advice });
        }
    };
    if channels == 0 || rate_hz == 0 {
        return Err(Error::damaged(path, FORMAT, "it has no channels or no sample rate"));
    }
    let stride = usize::from(channels) * kind.bytes();
    if frame != 0 && frame != stride {
        // On which side of its bytes a number of 24 bits would lie is not said.
        let what = format!("{channels} numbers of {bits} bits in {frame} bytes");
        let advice = "save it as PCM whose samples fill their bytes, or as floating point";
        return Err(Error::Unsupported { path: path.to_owned(), format: FORMAT, what, advice });
    }
    let (held, notes) = data.held();
    // Eight bits have no sign: 128 is zero.
    let curve = (kind == Kind::U8).then(|| Curve::linear(-1.0, 1.0));
    let all = (0..usize::from(channels)).map(|n| {
        let start = data.at + (n * kind.bytes()) as u64;
        let strided = Strided { path: path.to_owned(), start, stride, number: Number::little(kind), factor };
        let channel = strided.channel((n + 1).to_string(), held / stride as u64);
        along(channel.at_rate(Some(f64::from(rate_hz))), curve.clone())
    });
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels: all.collect(), notes })
}

impl Data {
    /// Bytes of samples, with notes. A recorder that streams, or was cut off, leaves 0 or the largest number
    /// in place of the size.
    fn held(self) -> (u64, Vec<String>) {
        let Self { there, length, long_data, ends, .. } = self;
        let unsaid = length == 0 || length == u64::from(u32::MAX) && long_data.is_none_or(|n| n == 0);
        let promised = match long_data {
            _ if unsaid => there,
            Some(long) if length == u64::from(u32::MAX) => long,
            _ => length,
        };
        let mut held = promised.min(there);
        let mut notes = Vec::new();
        // A recorder that was stopped leaves the size of its last save; padding of a few bytes is none.
        if !unsaid && !ends && there - held > (promised / 100).max(1024) {
            notes.push(format!(
                "its header promises {promised} bytes of samples, and {there} are there, with nothing else \
                 behind them: all are taken"
            ));
            held = there;
        } else if unsaid && there > 0 {
            notes.push(format!(
                "its header does not say how many samples there are: all {there} bytes to its end are taken"
            ));
        } else if held < promised {
            notes.push(format!("its header promises {promised} bytes of samples, and {held} are there"));
        }
        (held, notes)
    }
}

/// Writes channels of one length and rate as 64-bit floats, in their own unit; `notes` goes into the comment.
///
/// # Errors
/// [`Error::DoesNotFit`] for channels of different lengths, a rate that is no whole number of hertz, or more
/// than 4 GiB; [`Error::Io`].
pub fn write(path: &Path, channels: &[Channel], notes: &[String]) -> Result<()> {
    let rows = equal_lengths(path, FORMAT, channels)?;
    let misfit = |what: String| Error::DoesNotFit { path: path.to_owned(), format: FORMAT, what };
    let rate = channels
        .first()
        .and_then(|c| c.rate_hz)
        .ok_or_else(|| misfit("the channels have no sample rate".to_owned()))?;
    if rate.fract() != 0.0 || !(1.0..=f64::from(u32::MAX)).contains(&rate) {
        return Err(misfit(format!("a sample rate of {rate} Hz; WAV holds whole numbers of hertz")));
    }
    let count = u16::try_from(channels.len()).map_err(|_| misfit(format!("{} channels", channels.len())))?;
    let format = Format { code: FLOAT, channels: count, rate_hz: rate as u32, bits: 64 };
    let head = format
        .head(rows, notes)
        .ok_or_else(|| misfit("more than a file of 4 GiB holds; use npz".to_owned()))?;
    let io = |e| Error::write(path, e);
    let mut file = BufWriter::new(File::create(path).map_err(io)?);
    file.write_all(&head).map_err(io)?;
    let columns: Vec<Vec<f64>> = channels.iter().map(Channel::read).collect::<Result<_>>()?;
    for row in 0..rows as usize {
        for column in &columns {
            file.write_all(&column[row].to_le_bytes()).map_err(io)?;
        }
    }
    file.flush().map_err(io)
}
