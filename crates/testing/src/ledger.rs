//! Rows of `docs/VALIDATION.md`: a test that compares a number with a closed form or with another program's says so here.
//!
//! Rows are written when `STRIBECK_LEDGER` names a folder, one file a row; `cargo xtask ci` sets it and makes the document.

/// Compares a number of ours with theirs and writes the row; fails beyond the relative `tolerance`.
///
/// `quantity` is unique, `source` has the page or section, `unit` is that of both numbers.
///
/// # Panics
/// Beyond the tolerance; if a row is asked for and the folder cannot be written or Cargo does not run the test.
#[track_caller]
pub fn compare(quantity: &str, source: &str, unit: &str, ours: f64, theirs: f64, tolerance: f64) {
    if let Some(folder) = std::env::var_os("STRIBECK_LEDGER") {
        // Cargo tells a test whose it is; at compile time this crate's own name would be all there is.
        let package = std::env::var("CARGO_PKG_NAME").expect("rows are written by tests that Cargo runs");
        let thread = std::thread::current();
        let test = thread.name().unwrap_or("").to_owned();
        let row = [&package, quantity, unit, source, &test].join("\t");
        let row = format!("{row}\t{ours:e}\t{theirs:e}\t{tolerance:e}\n");
        let name: String =
            quantity.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        let path = std::path::Path::new(&folder).join(format!("{package}-{name}.tsv"));
        std::fs::write(&path, row).expect("the folder of the ledger can be written");
    }
    let off = (ours - theirs).abs() / theirs.abs();
    assert!(
        off <= tolerance,
        "{quantity}: {ours:e} {unit}, {source} gives {theirs:e}, off by {off:.2e} > {tolerance:.1e}"
    );
}
