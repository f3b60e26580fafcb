//! Base64 of little-endian 32-bit floats: a third longer than binary, and text that any page can hold.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Encodes values as little-endian f32; a value that f32 cannot hold becomes not-a-number, a gap in the
/// chart.
pub(super) fn floats(values: &[f64]) -> String {
    let mut encoded = Vec::with_capacity(4 * values.len());
    for &v in values {
        let single = v as f32;
        let kept = if single.is_finite() { single } else { f32::NAN };
        encoded.extend_from_slice(&kept.to_le_bytes());
    }
    bytes(&encoded)
}

pub(crate) fn bytes(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_one_is_3f800000() {
        assert_eq!(floats(&[1.0]), "AACAPw==");
    }
}
