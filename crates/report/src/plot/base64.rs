//! Base64 (RFC 4648, section 4) of little-endian 32-bit floats: a third longer than binary, and text
//! that any page can hold.

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Encodes values as little-endian f32; a value that f32 cannot hold becomes not-a-number, a gap in the
/// chart.
pub(super) fn floats(values: &[f64]) -> String {
    let mut bytes = Vec::with_capacity(4 * values.len());
    for &v in values {
        let single = v as f32;
        let kept = if single.is_finite() { single } else { f32::NAN };
        bytes.extend_from_slice(&kept.to_le_bytes());
    }
    encode(&bytes)
}

/// Encodes bytes as they are.
pub(crate) fn bytes(bytes: &[u8]) -> String {
    encode(bytes)
}

fn encode(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|i| u32::from(chunk.get(i).copied().unwrap_or(0)));
        let word = a << 16 | b << 8 | c;
        for place in 0..4 {
            if place <= chunk.len() {
                text.push(char::from(ALPHABET[(word >> (18 - 6 * place) & 63) as usize]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// RFC 4648, section 10: the standard's own test vectors.
    #[test]
    fn analytic_rfc_4648_vectors() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
        ] {
            assert_eq!(encode(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn by_hand_one_is_3f800000() {
        assert_eq!(floats(&[1.0]), "AACAPw==");
    }
}
