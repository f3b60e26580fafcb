//! Sound as bytes: the head of a WAV file, and files of whole numbers.

/// The code of whole numbers.
pub const PCM: u16 = 1;
/// The code of floats.
pub const FLOAT: u16 = 3;

/// Content of the chunk `fmt`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Format {
    /// [`PCM`], [`FLOAT`], or another code, which is not written here.
    pub code: u16,
    /// Number of channels.
    pub channels: u16,
    /// Sample rate [Hz].
    pub rate_hz: u32,
    /// Bits of a sample.
    pub bits: u16,
}

impl Format {
    /// Everything before `rows` samples of each channel, with `notes` as the comment; `None` for more than 4
    /// GiB of samples, 64 KiB a sample of all channels, or a comment of 512 KiB.
    pub fn head(self, rows: u64, notes: &[String]) -> Option<Vec<u8>> {
        let Self { code, channels, rate_hz, bits } = self;
        let frame = u32::from(bits / 8) * u32::from(channels);
        let data = rows.checked_mul(u64::from(frame)).and_then(|n| u32::try_from(n).ok())?;
        let data = Some(data).filter(|n| *n < u32::MAX - (1 << 20))?;
        let together = u16::try_from(frame).ok()?;
        let mut comment = Some(notes.join("\n").into_bytes()).filter(|comment| comment.len() < 1 << 19)?;
        comment.push(0);
        comment.resize(comment.len().next_multiple_of(2), 0);
        let word = |n: usize| (n as u32).to_le_bytes();
        let mut head = b"RIFF".to_vec();
        // Pieces end at even bytes.
        head.extend(word(4 + 8 + 16 + 8 + 4 + 8 + comment.len() + 8 + (data as usize).next_multiple_of(2)));
        head.extend(b"WAVEfmt ");
        head.extend(word(16));
        head.extend(code.to_le_bytes());
        head.extend(channels.to_le_bytes());
        head.extend(rate_hz.to_le_bytes());
        head.extend(rate_hz.wrapping_mul(frame).to_le_bytes());
        head.extend(together.to_le_bytes());
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
    let format = Format { code: PCM, channels: u16::try_from(channels.len()).ok()?, rate_hz, bits };
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: Multimedia Programming Interface and Data Specifications 1.0, IBM and Microsoft 1991, chapter
    /// 3: the pieces `fmt`, `LIST` and `data` of a file.
    #[test]
    fn peer_a_sound_has_the_bytes_of_its_specification() {
        let bytes = pcm(8000, Whole::Of16, &[vec![0.0, 0.5, -2.0]], &["hm".to_owned()]).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!(
            (&bytes[..4], &bytes[8..16], &bytes[36..40]),
            (&b"RIFF"[..], &b"WAVEfmt "[..], &b"LIST"[..])
        );
        assert_eq!(word(4) as usize, bytes.len() - 8);
        // One channel of whole numbers, 8000 and 16 000 bytes a second, two bytes of 16 bits.
        assert_eq!((word(20), word(24), word(28), word(32)), (0x0001_0001, 8000, 16_000, 0x0010_0002));
        assert_eq!((&bytes[48..52], word(52), &bytes[56..60]), (&b"ICMT"[..], 4, &b"hm\0\0"[..]));
        assert_eq!((&bytes[60..64], word(64)), (&b"data"[..], 6));
        assert_eq!(bytes[68..], [0, 0, 0, 0x40, 0, 0x80]);
        assert_eq!(pcm(8000, Whole::Of16, &[vec![0.0], vec![]], &[]), None);
        assert_eq!(pcm(8000, Whole::Of16, &[vec![0.0]], &["x".repeat(1 << 19)]), None);
    }
}
