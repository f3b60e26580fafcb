//! Sound as bytes: the head of a WAV file, and files of whole numbers.

/// Whole numbers, in [`Format::sort`].
pub const PCM: u16 = 1;
/// Floats, in [`Format::sort`].
pub const FLOAT: u16 = 3;

/// Content of the chunk `fmt`.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// [`PCM`], [`FLOAT`], or a way to pack that is not written here.
    pub sort: u16,
    /// Number of channels.
    pub channels: u16,
    /// Sample rate [Hz].
    pub rate: u32,
    /// Bits of a sample.
    pub bits: u16,
}

impl Format {
    /// Everything before `rows` samples of each channel, with `notes` as the comment; `None` for more than 4
    /// GiB.
    pub fn head(self, rows: u64, notes: &[String]) -> Option<Vec<u8>> {
        let Self { sort, channels, rate, bits } = self;
        let frame = u32::from(bits / 8) * u32::from(channels);
        let data = rows.checked_mul(u64::from(frame)).and_then(|n| u32::try_from(n).ok())?;
        let data = Some(data).filter(|n| *n < u32::MAX - (1 << 20))?;
        let mut comment = notes.join("\n").into_bytes();
        comment.push(0);
        comment.resize(comment.len().next_multiple_of(2), 0);
        let word = |n: usize| (n as u32).to_le_bytes();
        let mut head = b"RIFF".to_vec();
        // Pieces end at even bytes.
        head.extend(word(4 + 8 + 16 + 8 + 4 + 8 + comment.len() + 8 + (data as usize).next_multiple_of(2)));
        head.extend(b"WAVEfmt ");
        head.extend(word(16));
        head.extend(sort.to_le_bytes());
        head.extend(channels.to_le_bytes());
        head.extend(rate.to_le_bytes());
        head.extend(rate.wrapping_mul(frame).to_le_bytes());
        head.extend((frame as u16).to_le_bytes());
        head.extend(bits.to_le_bytes());
        head.extend(b"LIST");
        head.extend(word(4 + 8 + comment.len()));
        head.extend(b"INFOICMT");
        head.extend(word(comment.len()));
        head.extend(&comment);
        head.extend(b"data");
        head.extend(data.to_le_bytes());
        Some(head)
    }
}

/// Whole numbers of a converter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whole {
    /// 16 bits.
    Of16,
    /// 24 bits.
    Of24,
    /// 32 bits.
    Of32,
}

impl Whole {
    /// The smallest that holds this number of bits; `None` for more than 32.
    pub fn holding(bits: u32) -> Option<Self> {
        match bits {
            0..=16 => Some(Self::Of16),
            17..=24 => Some(Self::Of24),
            25..=32 => Some(Self::Of32),
            _ => None,
        }
    }

    fn bits(self) -> u16 {
        match self {
            Self::Of16 => 16,
            Self::Of24 => 24,
            Self::Of32 => 32,
        }
    }
}

/// The bytes of a file of whole numbers: `channels` of one length, each from −1 to 1 of full scale, clipped
/// beyond; `notes` goes into the comment. `None` for channels of different lengths, none or too many, or more
/// than 4 GiB.
pub fn pcm(rate_hz: u32, whole: Whole, channels: &[Vec<f64>], notes: &[String]) -> Option<Vec<u8>> {
    let rows = channels.first()?.len();
    channels.iter().all(|channel| channel.len() == rows).then_some(())?;
    let bits = whole.bits();
    let format = Format { sort: PCM, channels: u16::try_from(channels.len()).ok()?, rate: rate_hz, bits };
    let mut bytes = format.head(rows as u64, notes)?;
    let (scale, kept) = (2_f64.powi(i32::from(bits) - 1), usize::from(bits / 8));
    for row in 0..rows {
        for channel in channels {
            let value = (channel[row] * scale).round().clamp(-scale, scale - 1.0) as i32;
            bytes.extend(&value.to_le_bytes()[..kept]);
        }
    }
    if bytes.len() % 2 == 1 {
        bytes.push(0);
    }
    Some(bytes)
}
