//! One second of a 100 kHz signal: a planned Welch estimate with segments of 10 000 samples, as
//! `scipy.signal.welch(x, 1e5, nperseg=10000)`.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use stribeck_dsp::{Welch, WelchOptions};

fn welch(criterion: &mut Criterion) {
    let signal: Vec<f64> =
        (0..100_000).map(|n| (0.29 * f64::from(n)).sin() + f64::from(n % 97) * 0.01).collect();
    let mut plan =
        Welch::new(1e5, signal.len(), &WelchOptions::new(10_000)).expect("the options fit the record");
    let mut spectrum = plan.blank();
    criterion.bench_function("welch 100k samples, segments of 10k", |bench| {
        bench.iter(|| plan.process(black_box(&signal), &mut spectrum).expect("the signal is finite"));
    });
}

criterion_group!(benches, welch);
criterion_main!(benches);
