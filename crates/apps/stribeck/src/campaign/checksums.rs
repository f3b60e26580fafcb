//! `SHA256SUMS` of a data set, which `sha256sum --check` reads.

use std::fmt::Write;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use anyhow::Result;

pub(super) const CHECKSUMS: &str = "SHA256SUMS";

/// A line for each of these files in a folder.
pub(super) fn text(folder: &Path, files: &[String]) -> Result<String> {
    let mut lines = String::new();
    for name in files {
        writeln!(lines, "{}  {name}", of_file(&folder.join(name))?)?;
    }
    Ok(lines)
}

fn of_file(path: &Path) -> Result<String> {
    let mut file = File::open(path)?;
    let mut hash = Sha256::default();
    let mut buffer = vec![0; 1 << 20];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hash.finish()),
            count => hash.update(&buffer[..count]),
        }
    }
}

/// SHA-256, FIPS 180-4 (2015), §6.2.
struct Sha256 {
    state: [u32; 8],
    /// Bytes that do not fill a block yet.
    rest: Vec<u8>,
    bytes: u64,
}

/// Fractional bits of a root of the first primes (FIPS 180-4, §4.2.2 and §5.3.3).
fn constants<const N: usize>(root: impl Fn(f64) -> f64) -> [u32; N] {
    let mut primes = (2_u32..).filter(|n| (2..*n).take_while(|d| d * d <= *n).all(|d| n % d != 0));
    std::array::from_fn(|_| {
        let root = root(f64::from(primes.next().unwrap_or(2)));
        // A double holds the whole part and 32 bits more.
        (root.fract() * 4_294_967_296.0) as u32
    })
}

impl Default for Sha256 {
    fn default() -> Self {
        Self { state: constants(f64::sqrt), rest: Vec::new(), bytes: 0 }
    }
}

impl Sha256 {
    fn update(&mut self, bytes: &[u8]) {
        self.bytes += bytes.len() as u64;
        self.rest.extend_from_slice(bytes);
        let whole = self.rest.len() / 64 * 64;
        let blocks: Vec<u8> = self.rest.drain(..whole).collect();
        let keys: [u32; 64] = constants(f64::cbrt);
        blocks.chunks_exact(64).for_each(|block| self.block(block, &keys));
    }

    fn block(&mut self, block: &[u8], keys: &[u32; 64]) {
        let mut w = [0_u32; 64];
        for (word, bytes) in w.iter_mut().zip(block.chunks_exact(4)) {
            *word = u32::from_be_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        }
        for t in 16..64 {
            let (x, y) = (w[t - 15], w[t - 2]);
            let small = x.rotate_right(7) ^ x.rotate_right(18) ^ (x >> 3);
            let large = y.rotate_right(17) ^ y.rotate_right(19) ^ (y >> 10);
            w[t] = w[t - 16].wrapping_add(small).wrapping_add(w[t - 7]).wrapping_add(large);
        }
        let [mut a, mut b, mut c, mut d, mut e, mut f, mut g, mut h] = self.state;
        for (key, word) in keys.iter().zip(w) {
            let of_e = e.rotate_right(6) ^ e.rotate_right(11) ^ e.rotate_right(25);
            let first =
                h.wrapping_add(of_e).wrapping_add(e & f ^ !e & g).wrapping_add(*key).wrapping_add(word);
            let of_a = a.rotate_right(2) ^ a.rotate_right(13) ^ a.rotate_right(22);
            let second = of_a.wrapping_add(a & b ^ a & c ^ b & c);
            (h, g, f, e) = (g, f, e, d.wrapping_add(first));
            (d, c, b, a) = (c, b, a, first.wrapping_add(second));
        }
        for (sum, word) in self.state.iter_mut().zip([a, b, c, d, e, f, g, h]) {
            *sum = sum.wrapping_add(word);
        }
    }

    fn finish(mut self) -> String {
        let bits = 8 * self.bytes;
        let zeros = (119 - self.bytes % 64) % 64;
        let mut end = vec![0x80];
        end.resize(1 + zeros as usize, 0);
        end.extend(bits.to_be_bytes());
        self.update(&end);
        self.state.iter().map(|word| format!("{word:08x}")).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: FIPS 180-4 examples (NIST, SHA256.pdf), and the digest of nothing.
    #[test]
    fn peer_digests_of_known_messages() {
        let of = |parts: &[&[u8]]| {
            let mut hash = Sha256::default();
            parts.iter().for_each(|part| hash.update(part));
            hash.finish()
        };
        assert_eq!(of(&[]), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        assert_eq!(of(&[b"a", b"bc"]), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        let long: &[u8] = b"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
        assert_eq!(of(&[long]), "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
        let million = vec![b'a'; 1_000_000];
        assert_eq!(of(&[&million]), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    }
}
