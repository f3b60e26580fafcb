//! NumPy archives (`.npz`): a zip file of arrays.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, Write};
use std::path::Path;

use stribeck_dsp::channel::memory;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::recording::left_out;
use crate::strided::held_from;
use crate::{Channel, Error, Recording, Result, npy};

const FORMAT: &str = "NumPy .npz";

/// Names what a zip archive without arrays is, and the way on: spreadsheets and documents are zip archives, too.
fn foreign<R: Read + Seek>(archive: &ZipArchive<R>) -> String {
    let holds = |part: &str| archive.file_names().any(|name| name == part);
    if holds("xl/workbook.xml") || holds("xl/workbook.bin") {
        return "it is a workbook of Excel (.xlsx): save the sheet with the samples as CSV (File, Save As, \"CSV UTF-8\"; \
             or `libreoffice --convert-to csv FILE`), and open that"
            .to_owned();
    }
    if holds("content.xml") && holds("mimetype") {
        return "it is a spreadsheet or document of LibreOffice: save the sheet with the samples as CSV \
             (`libreoffice --convert-to csv FILE`), and open that"
            .to_owned();
    }
    let other = archive.file_names().next().unwrap_or_default();
    format!("it is a zip archive without arrays of NumPy: unpack it first; it holds `{other}`")
}

/// Opens an archive. Arrays that are stored without compression stay in the file; texts and other values that
/// are not real numbers are left out with a note.
pub fn open(path: &Path) -> Result<Recording> {
    let file = File::open(path).map_err(|e| Error::read(path, e))?;
    let damaged = |what: String| Error::damaged(path, FORMAT, what);
    let mut archive = ZipArchive::new(BufReader::new(file)).map_err(|e| damaged(e.to_string()))?;
    let (mut channels, mut notes) = (Vec::new(), Vec::new());
    let mut asked = 0_u64;
    if !archive.file_names().any(|name| name.ends_with(".npy")) && !archive.is_empty() {
        return Err(Error::Unknown { path: path.to_owned(), seen: foreign(&archive) });
    }
    for at in 0..archive.len() {
        let mut entry = archive.by_index(at).map_err(|e| damaged(e.to_string()))?;
        let Some(name) = entry.name().strip_suffix(".npy").map(str::to_owned) else { continue };
        let of = |what: String| damaged(format!("array `{name}`: {what}"));
        let stored = (entry.compression() == CompressionMethod::Stored).then(|| entry.data_start()).flatten();
        let size = entry.size();
        let mut bytes = Vec::new();
        if stored.is_none() {
            // Its bytes, and numbers of eight for each: what it is is known only when it is unpacked.
            asked = asked.saturating_add(size.saturating_mul(2));
            memory::ask(path, &format!("array `{name}`"), asked)?;
        }
        let wanted = if stored.is_some() { 1 << 20 } else { size };
        entry.by_ref().take(wanted).read_to_end(&mut bytes).map_err(|e| of(e.to_string()))?;
        let layout = match npy::Layout::of(&bytes) {
            Ok(layout) => layout,
            Err(why) => {
                notes.push(left_out(&name, &why.to_string()));
                continue;
            }
        };
        let start = stored.unwrap_or(0) + layout.start as u64;
        let held =
            if stored.is_some() { size } else { bytes.len() as u64 }.saturating_sub(layout.start as u64);
        let found = match layout.channels(&name, path, start, held) {
            Ok(found) => found,
            Err(npy::Refusal::Damaged(what)) => return Err(of(what)),
            Err(why @ npy::Refusal::Foreign(_)) => {
                notes.push(left_out(&name, &why.to_string()));
                continue;
            }
        };
        notes.extend(layout.notes);
        if stored.is_some() {
            channels.extend(found);
        } else {
            channels.extend(found.iter().map(|c| held_from(c, &bytes)));
        }
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes })
}

/// Writes each channel as an array under its name, stored without compression so that it can be mapped;
/// `rate_hz` when the first has a rate; `notes` as one text.
pub fn write(path: &Path, channels: &[Channel], notes: &[String]) -> Result<()> {
    let io = |e| Error::write(path, e);
    let zipped = |e: zip::result::ZipError| Error::write(path, e.into());
    let mut archive = ZipWriter::new(BufWriter::new(File::create(path).map_err(io)?));
    // A fixed time makes equal signals equal bytes.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(zip::DateTime::default())
        .large_file(true);
    let mut add = |name: &str, bytes: &[u8]| -> Result<()> {
        archive.start_file(format!("{name}.npy"), options).map_err(zipped)?;
        archive.write_all(bytes).map_err(io)
    };
    for channel in channels {
        add(&channel.name.replace('/', "_"), &npy::encode(&channel.read()?))?;
    }
    if let Some(rate_hz) = channels.first().and_then(|c| c.rate_hz) {
        add("rate_hz", &npy::encode(&[rate_hz]))?;
    }
    add("notes", &npy_text(&notes.join("\n")))?;
    archive.finish().map_err(zipped)?.into_inner().map_err(|e| io(e.into_error()))?;
    Ok(())
}

/// A text as a `.npy` file: one string of 32-bit characters.
fn npy_text(text: &str) -> Vec<u8> {
    let characters: Vec<u32> = text.chars().map(u32::from).collect();
    let head = format!("{{'descr': '<U{}', 'fortran_order': False, 'shape': (), }}", characters.len().max(1));
    let mut bytes = npy::MAGIC.to_vec();
    bytes.extend([1, 0]);
    let total = (10 + head.len() + 1).next_multiple_of(64);
    bytes.extend(((total - 10) as u16).to_le_bytes());
    bytes.extend(head.as_bytes());
    bytes.resize(total - 1, b' ');
    bytes.push(b'\n');
    bytes.extend(characters.iter().flat_map(|c| c.to_le_bytes()));
    bytes.resize(total + 4 * characters.len().max(1), 0);
    bytes
}
