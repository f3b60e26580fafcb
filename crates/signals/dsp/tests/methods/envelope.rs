//! The envelope of a record.

use stribeck_dsp::EnvelopeSpectrum;

#[test]
fn invariant_processing_moves_no_buffer() {
    let mut plan = EnvelopeSpectrum::new(1000.0, 997, Some((100.0, 400.0))).unwrap();
    let mut out = plan.blank();
    let before = out.values().as_ptr();
    let signal: Vec<f64> = (0..997).map(|n| ((n * 7) % 31) as f64).collect();
    for _ in 0..3 {
        let taken = allocation_counter::measure(|| plan.process(&signal, &mut out).unwrap());
        assert_eq!((taken.count_total, out.values().as_ptr()), (0, before));
    }
}
