//! Baseline methods: the squared envelope spectrum of one band, and the family with the highest first lines.

use stribeck_diagnosis::Defect;
use stribeck_dsp::{BandEnvelopes, Whitened, fast_kurtogram};

use super::records::Labelled;

/// Ends of the fixed band over half the sample rate.
const FIXED: (f64, f64) = (0.25, 0.75);
/// Levels of the kurtogram.
const LEVELS: u32 = 5;
/// Lines of a family that are looked at.
const LINES: usize = 3;
/// Slip that moves a family from its place, either way.
const SLIP: f64 = 0.02;
/// Frequencies tried within the slip.
const STEPS: usize = 80;
/// Narrowest band of a kurtogram that holds the lines of all families [Hz].
const NARROWEST_HZ: f64 = 600.0;

/// Scores of BPFO, BPFI, BSF and FTF [dB]: the mean height of the first three lines above their background.
pub(super) type Scores = [f64; 4];

/// By the envelope in a band that is the same for all records.
pub(super) fn fixed_band(record: &Labelled) -> Option<Scores> {
    let half = 0.5 * record.rate_hz;
    scores(record, (FIXED.0 * half, FIXED.1 * half))
}

/// By the envelope in the band of the highest kurtosis.
pub(super) fn kurtogram_band(record: &Labelled) -> Option<Scores> {
    let bands = fast_kurtogram(&record.samples, record.rate_hz, LEVELS).ok()?;
    let wide = bands.iter().filter(|b| b.high_hz - b.low_hz >= NARROWEST_HZ);
    let best = wide.max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis))?;
    scores(record, (best.low_hz, best.high_hz))
}

fn scores(record: &Labelled, (low_hz, high_hz): (f64, f64)) -> Option<Scores> {
    let segment = BandEnvelopes::segment_of(record.samples.len(), 1 << 20);
    let band = (low_hz.max(0.01 * record.rate_hz), high_hz.min(0.499 * record.rate_hz));
    let mut envelopes = BandEnvelopes::new(record.rate_hz, segment, &[band], 2_000.0).ok()?;
    envelopes.add(&record.samples[..segment]).ok()?;
    let bands = envelopes.bands();
    let band = bands.first()?;
    let spectrum = Whitened::new(&band.values, band.grid_hz, band.segments).ok()?;
    let orders = record.bearing.orders().ok()?;
    let shaft_hz = record.speed_rpm / 60.0;
    Some(
        [orders.bpfo, orders.bpfi, 2.0 * orders.bsf, orders.ftf]
            .map(|order| height(&spectrum, order * shaft_hz)),
    )
}

/// Mean height of the lines of a comb [dB], at its best within slip.
fn height(spectrum: &Whitened, hz: f64) -> f64 {
    let tried = (0..=STEPS).map(|n| hz * (1.0 - SLIP + 2.0 * SLIP * n as f64 / STEPS as f64));
    let of = |hz: f64| {
        let lines = (1..=LINES).map(|h| 10.0 * spectrum.at(h as f64 * hz).max(1e-3).log10());
        lines.sum::<f64>() / LINES as f64
    };
    tried.map(of).fold(f64::NEG_INFINITY, f64::max)
}

/// The family with the highest score.
pub(super) fn choice(scores: &Scores) -> (Defect, f64) {
    let best = (0..4).max_by(|a, b| scores[*a].total_cmp(&scores[*b])).unwrap_or(0);
    (Defect::ALL[best], scores[best])
}
