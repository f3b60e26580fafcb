//! Limits on what a command takes of the machine's memory.

/// Flags of commands that read records.
#[derive(Debug, Clone, Default, clap::Args)]
pub(crate) struct Limits {
    /// Memory that the samples of a record may take, such as 500MB or 8GB: a small file may unpack to more than
    /// the machine has [default: a quarter of the machine's]
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    max_memory: Option<u64>,
}

impl Limits {
    /// Holds from now on.
    pub(crate) fn apply(&self) {
        if let Some(most) = self.max_memory.or_else(|| crate::memory::whole_bytes().map(|all| all / PART)) {
            stribeck_dsp::channel::memory::set_most_bytes(most);
        }
    }
}

/// Part of the machine's memory that the samples of a record may take.
const PART: u64 = 4;

/// A number of bytes, with a unit or without.
fn bytes(text: &str) -> Result<u64, String> {
    let wrong = || format!("`{text}` is no size of memory, such as 500MB or 8GB");
    let text_only = text.trim();
    let at = text_only.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text_only.len());
    let (number, unit) = text_only.split_at(at);
    let unit = match unit.to_ascii_lowercase().as_str() {
        "" | "b" => 1.0,
        "k" | "kb" => 1e3,
        "m" | "mb" => 1e6,
        "g" | "gb" => 1e9,
        "t" | "tb" => 1e12,
        "kib" => 1024.0,
        "mib" => 1024.0 * 1024.0,
        "gib" => 1024.0 * 1024.0 * 1024.0,
        _ => return Err(wrong()),
    };
    let number: f64 = number.trim().parse().map_err(|_| wrong())?;
    let bytes = number * unit;
    if bytes >= LEAST { Ok(bytes as u64) } else { Err(format!("`{text}`: 1 MB is the least")) }
}

/// Least memory with which records are read [bytes].
const LEAST: f64 = 1e6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_sizes_of_memory() {
        for (text, size) in
            [("500MB", 500_000_000), ("2 GiB", 1 << 31), ("1.5g", 1_500_000_000), ("4000000", 4_000_000)]
        {
            assert_eq!(bytes(text), Ok(size), "{text}");
        }
        for text in ["", "GB", "-1GB", "0", "12 apples", "nan", "1e3"] {
            stribeck_testing::assert_refused(bytes(text), &format!("`{text}`"));
        }
    }
}
