//! Averaged spectra.

use stribeck_dsp::{Averaging, Welch, WelchOptions};

#[test]
fn invariant_processing_moves_no_buffer() {
    for averaging in [Averaging::Mean, Averaging::Median] {
        let options = WelchOptions { averaging, nfft: 333, ..WelchOptions::new(256) };
        let mut welch = Welch::new(1000.0, 2000, &options).unwrap();
        let mut out = welch.blank();
        let before = out.values().as_ptr();
        for run in 0..3 {
            let signal: Vec<f64> = (0..2000).map(|n| ((n * (7 + run)) % 31) as f64).collect();
            let taken = allocation_counter::measure(|| welch.process(&signal, &mut out).unwrap());
            assert_eq!((taken.count_total, out.values().as_ptr()), (0, before));
        }
    }
}
