//! Numbers as files hold them: little-endian or big-endian, integers and floats of several widths.

/// How one number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 24 bits (WAV).
    I24,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 64 bits; beyond 2⁵³ the last digits are lost.
    I64,
    /// Unsigned, 64 bits; beyond 2⁵³ the last digits are lost.
    U64,
    /// IEEE half.
    F16,
    /// IEEE single.
    F32,
    /// IEEE double.
    F64,
}

/// A kind with its byte order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Number {
    /// Width and sort.
    pub kind: Kind,
    /// True when the most significant byte is first.
    pub big_endian: bool,
}

impl Kind {
    /// Bytes that one takes.
    pub fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 | Self::F16 => 2,
            Self::I24 => 3,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }
}

impl Number {
    /// A number with its least significant byte first.
    pub fn little(kind: Kind) -> Self {
        Self { kind, big_endian: false }
    }

    /// The value in the first bytes of `at`; zero stands for bytes that are missing.
    pub fn decode(self, at: &[u8]) -> f64 {
        let width = self.kind.bytes();
        let mut bytes = [0_u8; 8];
        for (n, byte) in bytes.iter_mut().enumerate().take(width) {
            let from = if self.big_endian { width - 1 - n } else { n };
            *byte = at.get(from).copied().unwrap_or(0);
        }
        let whole = u64::from_le_bytes(bytes);
        // Shifted up and down again, the sign fills the upper bits.
        let signed = (whole << (64 - 8 * width)) as i64 >> (64 - 8 * width);
        match self.kind {
            Kind::I8 | Kind::I16 | Kind::I24 | Kind::I32 | Kind::I64 => signed as f64,
            Kind::U8 | Kind::U16 | Kind::U32 | Kind::U64 => whole as f64,
            Kind::F16 => half(whole as u16),
            Kind::F32 => f64::from(f32::from_bits(whole as u32)),
            Kind::F64 => f64::from_bits(whole),
        }
    }
}

/// A number of 16 bits: a sign, five bits of exponent, ten of mantissa (IEEE 754-2008, binary16).
fn half(bits: u16) -> f64 {
    let (exponent, mantissa) = (i32::from(bits >> 10 & 0x1f), f64::from(bits & 0x3ff));
    let size = match exponent {
        0 => mantissa * 2_f64.powi(-24),
        31 if mantissa == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + mantissa) * 2_f64.powi(exponent - 25),
    };
    if bits >> 15 == 1 { -size } else { size }
}
