//! MATLAB files of version 5 (what `save -v6` and `save -v7` write): vectors, tables, structs and cells of
//! real numbers, in either byte order, deflated or not, with elements of any length packed into their tags.
//!
//! Source: *MAT-File Format*, The MathWorks.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use flate2::read::ZlibDecoder;
use stribeck_dsp::channel::memory;

use crate::number::{Kind, Number};
use crate::recording::left_out;
use crate::strided::{Strided, held_from};
use crate::{Channel, Error, Recording, Result, axis_structs, shape, units};

const FORMAT: &str = "MATLAB 5";
const HEADER: u64 = 128;
/// Types of elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Classes of arrays.
const CELL: u32 = 1;
const STRUCT: u32 = 2;
const OBJECT: u32 = 3;
const CHAR: u32 = 4;
const SPARSE: u32 = 5;
const DOUBLE: u32 = 6;
const UINT64: u32 = 15;
/// A value of a class of MATLAB's own: a table, a timetable, a string, a date.
const OPAQUE: u32 = 17;
/// Flags of arrays.
const COMPLEX: u32 = 0x0800;
/// Bytes of a packed variable in which its head lies, unless that is longer than most.
const HEAD: u64 = 4096;
/// Structs in structs, at most.
const MAX_DEPTH: usize = 16;

/// Whether a file begins like one of version 5: byte order and version stand at the end of its header.
pub(crate) fn recognise(start: &[u8]) -> bool {
    matches!(start.get(124..128), Some([0, 1, b'I', b'M'] | [1, 0, b'M', b'I']))
}

/// Opens a file. Real vectors that are not deflated stay in the file. Members of structs are called
/// `name.member`, cells `name{1}`; texts and other values that are not real numbers are left out.
pub fn open(path: &Path) -> Result<Recording> {
    let io = |e| Error::read(path, e);
    let damaged = |what: String| Error::damaged(path, FORMAT, what);
    let mut file = BufReader::new(File::open(path).map_err(io)?);
    let size = file.get_ref().metadata().map_err(io)?.len();
    file.seek(SeekFrom::Start(126)).map_err(io)?;
    let mut order = [0; 2];
    file.read_exact(&mut order).map_err(io)?;
    let big_endian = order == *b"MI";
    let mut found = Found { big_endian, channels: Vec::new(), texts: Vec::new(), notes: Vec::new() };
    let (mut at, mut asked) = (HEADER, 0_u64);
    while at + 8 <= size {
        file.seek(SeekFrom::Start(at)).map_err(io)?;
        let mut tag = [0; 8];
        file.read_exact(&mut tag).map_err(io)?;
        let (kind, mut length) = (found.word(&tag, 0), u64::from(found.word(&tag, 4)));
        // libsndfile counts the tag of the numbers twice: all of them are there.
        let lacks = (at + 8 + length).saturating_sub(size);
        if kind == MATRIX && (1..=8).contains(&lacks) {
            length -= lacks;
        }
        let cut = || {
            damaged(format!("the variable at byte {at} takes {length} bytes, and {} follow", size - at - 8))
        };
        if at + 8 + length > size {
            return Err(cut());
        }
        let before = found.channels.len();
        match kind {
            COMPRESSED => {
                let mut bytes = Vec::new();
                let mut inflated = ZlibDecoder::new((&mut file).take(length));
                let begins = inflated.by_ref().take(HEAD).read_to_end(&mut bytes);
                let most = found.unpacked(&bytes);
                asked = asked.saturating_add(most.saturating_mul(2));
                memory::ask(path, &format!("the variable at byte {at}"), asked)?;
                let left = (most + 16).saturating_sub(bytes.len() as u64);
                let whole = begins.and_then(|_| inflated.take(left).read_to_end(&mut bytes));
                whole.map_err(|e| damaged(format!("the variable at byte {at} cannot be inflated: {e}")))?;
                let (element, _) = found
                    .element(&bytes)
                    .map_err(|what| damaged(format!("variable at byte {at}: {what}")))?;
                found
                    .matrix(element.data, "", 0)
                    .map_err(|what| damaged(format!("variable at byte {at}: {what}")))?;
            }
            MATRIX => {
                let mut bytes = Vec::new();
                (&mut file).take(length.min(4096)).read_to_end(&mut bytes).map_err(io)?;
                let of = |what: String| damaged(format!("variable at byte {at}: {what}"));
                match found.plain(&bytes, length).map_err(of)? {
                    Some(plain) => found.channels.extend(plain.channels(path, at + 8)),
                    None => {
                        asked = asked.saturating_add(length.saturating_mul(2));
                        memory::ask(path, &format!("the variable at byte {at}"), asked)?;
                        (&mut file).take(length - bytes.len() as u64).read_to_end(&mut bytes).map_err(io)?;
                        found.matrix(&bytes, "", 0).map_err(of)?;
                    }
                }
            }
            // MATLAB's internal data.
            _ => {}
        }
        // Behind objects stand their contents, without a name.
        let mut at_all = 0..;
        found.channels.retain(|channel| at_all.next() < Some(before) || !channel.name.is_empty());
        at += 8 + length;
    }
    let Found { mut channels, texts, mut notes, .. } = found;
    axis_structs::told(&mut channels, &texts)?;
    for (name, text) in &texts {
        let mut rates = units::Rates::default();
        rates.words(name.rsplit('.').next().unwrap_or(name), text);
        channels.extend(rates.agreed(&mut notes).map(|hz| Channel::held(name.clone(), vec![hz])));
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes })
}

/// Writes each channel as a column of doubles, uncompressed, its name made valid; `rate_hz` beside them when
/// the first has a rate, and the text `notes`.
///
/// # Errors
/// [`Error::DoesNotFit`] for a channel beyond 4 GiB, [`Error::Io`].
pub fn write(path: &Path, channels: &[Channel], notes: &[String]) -> Result<()> {
    let io = |e| Error::write(path, e);
    let mut file = BufWriter::new(File::create(path).map_err(io)?);
    let mut header = b"MATLAB 5.0 MAT-file, written by Stribeck".to_vec();
    header.resize(124, b' ');
    header.extend([0, 1, b'I', b'M']);
    file.write_all(&header).map_err(io)?;
    let mut names: Vec<String> = Vec::new();
    let rate = channels.first().and_then(|c| c.rate_hz).map(|hz| Channel::held("rate_hz", vec![hz]));
    for channel in channels.iter().chain(&rate) {
        let name = valid(&channel.name, &names);
        let samples = channel.read()?;
        let padded = name.len().next_multiple_of(8);
        let length = 16 + 16 + 8 + padded + 8 + 8 * samples.len();
        let Ok(length) = u32::try_from(length) else {
            let what = format!(
                "`{}` has {} samples, beyond the 4 GiB of a variable; use npz",
                channel.name,
                samples.len()
            );
            return Err(Error::DoesNotFit { path: path.to_owned(), format: FORMAT, what });
        };
        let words = |words: &[u32]| words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<u8>>();
        let mut bytes =
            words(&[MATRIX, length, 6, 8, DOUBLE, 0, 5, 8, samples.len() as u32, 1, 1, name.len() as u32]);
        bytes.extend(name.as_bytes());
        bytes.resize(bytes.len() + padded - name.len(), 0);
        bytes.extend(words(&[9, 8 * samples.len() as u32]));
        file.write_all(&bytes).map_err(io)?;
        for block in samples.chunks(1 << 13) {
            let bytes: Vec<u8> = block.iter().flat_map(|x| x.to_le_bytes()).collect();
            file.write_all(&bytes).map_err(io)?;
        }
        names.push(name);
    }
    file.write_all(&text("notes", &notes.join("\n"))).map_err(io)?;
    file.flush().map_err(io)
}

/// A row of characters as a variable.
fn text(name: &str, text: &str) -> Vec<u8> {
    let characters: Vec<u16> = text.encode_utf16().collect();
    let mut body: Vec<u8> = [6, 8, CHAR, 0, 5, 8, 1, characters.len() as u32, 1, name.len() as u32]
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .collect();
    body.extend(name.as_bytes());
    body.resize(body.len().next_multiple_of(8), 0);
    // Type 4: unsigned, 16 bits.
    body.extend(4_u32.to_le_bytes());
    body.extend((2 * characters.len() as u32).to_le_bytes());
    body.extend(characters.iter().flat_map(|c| c.to_le_bytes()));
    body.resize(body.len().next_multiple_of(8), 0);
    let mut bytes = MATRIX.to_le_bytes().to_vec();
    bytes.extend((body.len() as u32).to_le_bytes());
    bytes.extend(body);
    bytes
}

/// A name that MATLAB takes: letters, digits and underscores, a letter first, at most 63, none twice.
fn valid(name: &str, taken: &[String]) -> String {
    let mut valid: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).take(56).collect();
    if !valid.starts_with(|c: char| c.is_ascii_alphabetic()) {
        valid.insert(0, 'x');
    }
    let mut numbered = valid.clone();
    for n in 2.. {
        if !taken.contains(&numbered) {
            break;
        }
        numbered = format!("{valid}_{n}");
    }
    numbered
}

/// One element: its type and its bytes.
struct Element<'a> {
    kind: u32,
    data: &'a [u8],
}

struct Found {
    big_endian: bool,
    channels: Vec<Channel>,
    /// Texts, by their names.
    texts: Vec<(String, String)>,
    notes: Vec<String>,
}

struct Head<'a> {
    class: u32,
    complex: bool,
    shape: Vec<u64>,
    /// Numbers in it.
    count: u64,
    name: String,
    /// Elements behind the name.
    rest: &'a [u8],
}

/// A real array of numbers whose samples can stay in the file.
pub(crate) struct Plain {
    pub(crate) name: String,
    pub(crate) rows: u64,
    pub(crate) columns: u64,
    pub(crate) number: Number,
    /// Place of its first number behind the tag of the variable [bytes].
    pub(crate) start: u64,
}

type Parsed<T> = std::result::Result<T, String>;

impl Found {
    fn word(&self, bytes: &[u8], at: usize) -> u32 {
        let four = bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).unwrap_or_default();
        if self.big_endian { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) }
    }

    /// The element at the start of `bytes`, and the rest.
    fn element<'a>(&self, bytes: &'a [u8]) -> Parsed<(Element<'a>, &'a [u8])> {
        if bytes.len() < 8 {
            return Err(format!("an element begins in its last {} bytes", bytes.len()));
        }
        let first = self.word(bytes, 0);
        // A small element carries its length in the upper half of its type, and its data where the length
        // would be.
        let (kind, length, start): (u32, usize, usize) = match first >> 16 {
            0 => (first, self.word(bytes, 4) as usize, 8),
            small => (first & 0xffff, small as usize, 4),
        };
        let data = bytes.get(start..start.saturating_add(length));
        let data = data
            .ok_or_else(|| format!("an element takes {length} bytes, and {} follow", bytes.len() - start))?;
        // Deflated variables are not padded.
        let end = if start == 4 { 8 } else { (start + length).next_multiple_of(8) };
        Ok((Element { kind, data }, &bytes[end.min(bytes.len())..]))
    }

    /// Bytes that a packed variable unpacks to, by its beginning: its tag says it modulo 4 GiB, and the size of
    /// its array without end.
    fn unpacked(&self, start: &[u8]) -> u64 {
        let tag = 8 + u64::from(self.word(start, 4));
        let head = start.get(8..).and_then(|body| self.head(body).ok());
        let numbers = head.filter(|head| (DOUBLE..=UINT64).contains(&head.class)).map_or(0, |head| {
            let kind = self.word(head.rest, 0);
            let width = self.number(kind & 0xffff).map_or(8, |number| number.kind.bytes());
            head.count.saturating_mul(width as u64)
        });
        tag.max(numbers)
    }

    fn head<'a>(&self, bytes: &'a [u8]) -> Parsed<Head<'a>> {
        let (flags, rest) = self.element(bytes)?;
        let flags = self.word(flags.data, 0);
        let text = |of: &Element| String::from_utf8_lossy(of.data).trim_end_matches('\0').to_owned();
        if flags & 0xff == OPAQUE {
            // It has no dimensions; the kind of object and its class follow its name.
            let (name, rest) = self.element(rest)?;
            return Ok(Head {
                class: OPAQUE,
                complex: false,
                shape: vec![0],
                count: 0,
                name: text(&name),
                rest,
            });
        }
        let (dimensions, rest) = self.element(rest)?;
        let (name, rest) = self.element(rest)?;
        let sizes: Vec<u64> =
            (0..dimensions.data.len() / 4).map(|n| u64::from(self.word(dimensions.data, 4 * n))).collect();
        if sizes.is_empty() {
            return Err("an array has no dimensions".to_owned());
        }
        let count = sizes.iter().try_fold(1_u64, |n, size| n.checked_mul(*size));
        let count = count.ok_or("an array is too large")?;
        let (class, complex) = (flags & 0xff, flags & COMPLEX != 0);
        Ok(Head { class, complex, shape: sizes, count, name: text(&name), rest })
    }

    fn number(&self, kind: u32) -> Option<Number> {
        let kind = match kind {
            1 => Kind::I8,
            2 => Kind::U8,
            3 => Kind::I16,
            4 => Kind::U16,
            5 => Kind::I32,
            6 => Kind::U32,
            7 => Kind::F32,
            9 => Kind::F64,
            12 => Kind::I64,
            13 => Kind::U64,
            _ => return None,
        };
        Some(Number { kind, big_endian: self.big_endian })
    }

    /// A variable whose numbers can stay in the file; `None` for others. `start` is the beginning of its
    /// bytes, of which there are `length`.
    fn plain(&self, start: &[u8], length: u64) -> Parsed<Option<Plain>> {
        // Its head may be longer than the bytes read: then it is parsed whole.
        let Ok(head) = self.head(start) else { return Ok(None) };
        if !(DOUBLE..=UINT64).contains(&head.class) || head.complex || head.rest.len() < 8 {
            return Ok(None);
        }
        let first = self.word(head.rest, 0);
        let (Some(number), true) = (self.number(first), first >> 16 == 0) else { return Ok(None) };
        let at = (start.len() - head.rest.len() + 8) as u64;
        let bytes = u64::from(self.word(head.rest, 4));
        let needed = head.count.checked_mul(number.kind.bytes() as u64);
        if needed != Some(bytes) || at + bytes > length {
            return Err(format!("`{}` has {} numbers in {bytes} bytes", head.name, head.count));
        }
        let Ok((rows, columns)) = shape::table(&head.shape) else { return Ok(None) };
        let name = head.name;
        Ok(Some(Plain { name, rows, columns, number, start: at }))
    }

    /// A row of characters: in UTF-8, or a number of 16 bits each.
    fn characters(&self, data: &Element<'_>) -> Option<String> {
        if data.kind == 16 || data.kind == 1 || data.kind == 2 {
            return String::from_utf8(data.data.to_vec()).ok();
        }
        let of = |two: &[u8]| {
            let two = two.try_into().unwrap_or_default();
            if self.big_endian { u16::from_be_bytes(two) } else { u16::from_le_bytes(two) }
        };
        (data.kind == 4 || data.kind == 17)
            .then(|| String::from_utf16(&data.data.chunks_exact(2).map(of).collect::<Vec<u16>>()).ok())?
    }

    /// Adds the channels of an array in memory.
    fn matrix(&mut self, bytes: &[u8], parent: &str, depth: usize) -> Parsed<()> {
        if bytes.is_empty() {
            return Ok(());
        }
        let head = self.head(bytes)?;
        let name = if parent.is_empty() { head.name.clone() } else { parent.to_owned() };
        if depth > MAX_DEPTH {
            self.notes.push(left_out(&name, &format!("it lies more than {MAX_DEPTH} structs deep")));
            return Ok(());
        }
        let count = head.count;
        match head.class {
            STRUCT | OBJECT => {
                let (first, rest) = self.element(head.rest)?;
                // An object has the name of its class here.
                let (longest, rest) = if head.class == OBJECT { self.element(rest)? } else { (first, rest) };
                let width = self.word(longest.data, 0) as usize;
                let (names, mut rest) = self.element(rest)?;
                let names: Vec<String> = names
                    .data
                    .chunks(width.max(1))
                    .map(|n| String::from_utf8_lossy(n).split('\0').next().unwrap_or_default().to_owned())
                    .collect();
                for at in 0..count {
                    for member in &names {
                        if rest.is_empty() {
                            return Ok(());
                        }
                        let (element, behind) = self.element(rest)?;
                        let place = if count > 1 { format!("({})", at + 1) } else { String::new() };
                        self.matrix(element.data, &format!("{name}{place}.{member}"), depth + 1)?;
                        rest = behind;
                    }
                }
                Ok(())
            }
            CELL => {
                let mut rest = head.rest;
                for at in 0..count {
                    if rest.is_empty() {
                        return Ok(());
                    }
                    let (element, behind) = self.element(rest)?;
                    self.matrix(element.data, &format!("{name}{{{}}}", at + 1), depth + 1)?;
                    rest = behind;
                }
                Ok(())
            }
            CHAR => {
                let (data, _) = self.element(head.rest)?;
                self.texts.extend(self.characters(&data).map(|text| (name, text)));
                Ok(())
            }
            OPAQUE => {
                let (class, _) = self.element(head.rest).and_then(|(_, rest)| self.element(rest))?;
                let class = String::from_utf8_lossy(class.data);
                let class = class.trim_end_matches('\0');
                self.notes.push(left_out(&name, &format!(
                    "it is a MATLAB object ({class}), whose samples only MATLAB reads: save its columns as vectors"
                )));
                Ok(())
            }
            DOUBLE..=UINT64 if !head.complex => {
                let (data, _) = self.element(head.rest)?;
                let number = self
                    .number(data.kind)
                    .ok_or_else(|| format!("`{name}` is stored as type {}", data.kind))?;
                let held = (data.data.len() / number.kind.bytes()) as u64;
                if held < count {
                    return Err(format!("`{name}` has {count} numbers, and {held} follow"));
                }
                let (rows, columns) = match shape::table(&head.shape) {
                    Ok(table) => table,
                    Err(why) => {
                        self.notes.push(left_out(&name, &why));
                        return Ok(());
                    }
                };
                let plain = Plain { name, rows, columns, number, start: 0 };
                self.channels
                    .extend(plain.channels(Path::new(""), 0).iter().map(|c| held_from(c, data.data)));
                Ok(())
            }
            SPARSE | DOUBLE..=UINT64 => {
                self.notes.push(left_out(&name, "it is complex or sparse"));
                Ok(())
            }
            other => {
                self.notes.push(left_out(&name, &format!("it is of class {other}")));
                Ok(())
            }
        }
    }
}

impl Plain {
    /// Channels along the longer side; MATLAB stores column after column.
    pub(crate) fn channels(&self, path: &Path, variable: u64) -> Vec<Channel> {
        let bytes = self.number.kind.bytes() as u64;
        let (len, count) = (self.rows.max(self.columns), self.rows.min(self.columns));
        let tall = self.rows >= self.columns;
        (0..count)
            .map(|k| {
                let name = if count == 1 {
                    self.name.clone()
                } else if tall {
                    format!("{}(:,{})", self.name, k + 1)
                } else {
                    format!("{}({},:)", self.name, k + 1)
                };
                let (first, stride) =
                    if tall { (k * len * bytes, bytes) } else { (k * bytes, count * bytes) };
                let start = variable + self.start + first;
                let stride = stride as usize;
                let path = path.to_owned();
                Strided { path, start, stride, number: self.number, factor: 1.0 }.channel(name, len)
            })
            .collect()
    }
}
