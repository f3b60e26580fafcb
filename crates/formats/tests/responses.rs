//! Frequency response functions in universal files: what pyuff 2.5.8 wrote of one mode
//! (`fixtures/signals/responses.py`), and what is refused.

use std::f64::consts::TAU;
use std::path::PathBuf;

use stribeck_formats::uff58::{Per, responses};
use stribeck_testing::Scratch;

fn fixture() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/signals/responses.uff"))
}

/// Acceleration over force of a mode of 12 kg on 2e8 N/m with a damping ratio of 0.02: real and imaginary
/// part.
fn exact(hz: f64) -> [f64; 2] {
    let (m, k, zeta, w) = (12.0, 2e8_f64, 0.02, TAU * hz);
    let (re, im) = (k - w * w * m, 2.0 * zeta * w * (k * m).sqrt());
    let scale = -w * w / (re * re + im * im);
    [scale * re, -scale * im]
}

#[test]
fn roundtrip_one_mode_in_five_ways_as_pyuff_writes_them() {
    let (found, others) = responses(&fixture()).expect("it is read");
    let names: Vec<&str> = found.iter().map(|frf| frf.name.as_str()).collect();
    assert_eq!(names, ["even", "in g per kN", "displacement", "binary", "uneven"]);
    assert!(others[0].contains("function type 9 (a power spectral density)"), "{others:?}");
    for frf in &found {
        assert_eq!(frf.per, Per::Force);
        let top = frf.hz.iter().map(|hz| exact(*hz)).map(|[a, b]| a.hypot(b)).fold(0.0, f64::max);
        // Uneven frequencies have six digits, which beside a resonance are worth more than that.
        let tolerance = if frf.name == "uneven" { 1e-4 } else { 1e-10 };
        for (hz, [re, im]) in frf.hz.iter().zip(&frf.response) {
            let [a, b] = exact(*hz);
            assert!((re - a).hypot(im - b) < tolerance * top, "{} at {hz}: {re} {im}, {a} {b}", frf.name);
        }
    }
    assert_eq!(found[0].hz.len(), 81);
    assert_eq!((found[4].hz[0], found[4].hz[59]), (50.0, 4000.0));
}

#[test]
fn refuses_functions_that_are_no_responses() {
    let desk = Scratch::create("responses-refused");
    // The binary dataset is no text.
    let whole = std::fs::read(fixture()).expect("the fixture");
    let end = whole.windows(11).position(|w| w == b"in g per kN").expect("a second set");
    let text = String::from_utf8_lossy(&whole[..end]).into_owned();
    let text = text.rsplit_once("    -1\n    58").expect("its head").0.to_owned();
    for (from, to, told) in [
        (
            "    4         0    0         0    HOUSING",
            "    6         0    0         0    HOUSING",
            "coherence",
        ),
        (
            "        13    0    0    0 NONE                 N   ",
            "        13    0    0    0 NONE                 bar ",
            "`bar`",
        ),
        (
            "        12    0    0    0 NONE                 m/s^2",
            "        12    0    0    0 NONE                 m/s  ",
            "contradicts",
        ),
        (
            "        12    0    0    0 NONE                 m/s^2",
            "        12    0    0    0 NONE                 V    ",
            "`V`",
        ),
        ("        18    0    0    0", "        17    0    0    0", "18 is the frequency"),
        ("         6        81", "         4        81", "without its phase"),
    ] {
        assert!(text.contains(from), "{from}");
        let path = desk.join("one.uff");
        std::fs::write(&path, text.replacen(from, to, 1)).expect("written");
        let (found, others) = responses(&path).expect("it is read");
        assert!(found.is_empty(), "{told}");
        assert!(others[0].contains(told), "{others:?}");
    }
    let path = desk.join("none.uff");
    std::fs::write(&path, "time,acc\n0,1\n").expect("written");
    assert!(responses(&path).expect_err("a table").to_string().contains("no dataset"));
}
