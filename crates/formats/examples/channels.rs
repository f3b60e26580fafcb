//! Lists the channels of files: name, unit, rate, samples and rms, and the notes.

fn main() {
    for path in std::env::args().skip(1) {
        println!("{path}");
        match stribeck_formats::Recording::open(&path) {
            Err(why) => println!("  refused: {why}"),
            Ok(found) => {
                for c in &found.channels {
                    let all: Vec<f64> =
                        c.read().unwrap_or_default().into_iter().filter(|x| x.is_finite()).collect();
                    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
                    let rms = (all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / all.len().max(1) as f64)
                        .sqrt();
                    println!(
                        "  `{}` unit {:?} rate {:?} len {} time {} numbers {} rms {rms:.4} mean {mean:.4}",
                        c.name,
                        c.unit,
                        c.rate_hz,
                        c.len,
                        c.is_time,
                        all.len()
                    );
                }
                found.notes.iter().for_each(|note| println!("  note: {note}"));
            }
        }
    }
}
