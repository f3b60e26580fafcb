//! A signal that was cut into windows, one a row: read as a table, its columns are taken for channels whose samples lie
//! a window apart.

use anyhow::{Result, ensure};
use stribeck_formats::{Channel, Recording};

/// Fewest channels, and samples of each, that may be windows.
const LEAST: usize = 16;
/// Samples and pairs of channels that are compared.
const SAMPLES: usize = 4096;
const PAIRS: usize = 64;
/// Neighbours whose correlation counts: a ring of a quarter of the rate correlates with every second one only.
const NEIGHBOURS: usize = 4;
/// Least correlation across channels, and over that along them.
const ACROSS: f64 = 0.1;
const OVER: f64 = 4.0;

/// Refuses a table of which neighbours in a row are correlated and neighbours in a column are not.
pub(super) fn refuse(recording: &Recording, channels: &[&Channel]) -> Result<()> {
    let Some(first) = channels.first().filter(|first| channels.len() >= LEAST && first.len >= LEAST as u64)
    else {
        return Ok(());
    };
    let kept = channels.iter().take(PAIRS + NEIGHBOURS).map(|channel| beginning(channel));
    let kept = kept.collect::<Result<Vec<_>>>()?;
    let (along, across) = correlations(&kept);
    let far = kept.len() / 2;
    let beyond = correlation(kept.iter().zip(&kept[far..]).flat_map(|(a, b)| a.iter().zip(b)));
    // What all sensors share stays the same however far apart they are.
    let is_cut = across >= ACROSS && across >= OVER * along && beyond.abs() < 0.5 * across;
    ensure!(
        !is_cut,
        "`{}` has {} channels of {} samples, which are {} windows of {} samples: from one channel to the next the \
         signal goes on (correlation {across:.2}), from one sample of a channel to the next it does not ({along:.2}). \
         Save the rows end to end, `numpy.save(\"signal.npy\", table.reshape(-1))`, if the windows do not overlap; \
         `--channel` takes one of the {} all the same",
        recording.path.display(),
        channels.len(),
        first.len,
        first.len,
        channels.len(),
        channels.len()
    );
    Ok(())
}

/// The first samples of a channel, less their mean.
fn beginning(channel: &Channel) -> Result<Vec<f64>> {
    let mut samples = Vec::with_capacity(SAMPLES);
    channel.for_each_block(|block| {
        samples.extend(block.iter().take(SAMPLES - samples.len()));
        samples.len() < SAMPLES
    })?;
    let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
    samples.iter_mut().for_each(|x| *x -= mean);
    Ok(samples)
}

/// The largest correlations of near samples of one channel, and of one sample of near channels.
fn correlations(channels: &[Vec<f64>]) -> (f64, f64) {
    let along =
        |by: usize| correlation(channels.iter().flat_map(|x| x.iter().zip(x.get(by..).unwrap_or_default())));
    let across =
        |by: usize| correlation(channels.iter().zip(&channels[by..]).flat_map(|(a, b)| a.iter().zip(b)));
    let largest = |of: &dyn Fn(usize) -> f64| (1..=NEIGHBOURS).map(|by| of(by).abs()).fold(0.0, f64::max);
    (largest(&along), largest(&across))
}

/// The correlation of pairs of samples; 0 of silent ones.
fn correlation<'a>(pairs: impl Iterator<Item = (&'a f64, &'a f64)>) -> f64 {
    let sums = pairs.filter(|(a, b)| a.is_finite() && b.is_finite());
    let (ab, aa, bb) =
        sums.fold((0.0, 0.0, 0.0), |(ab, aa, bb), (a, b)| (ab + a * b, aa + a * a, bb + b * b));
    if aa > 0.0 && bb > 0.0 { ab / f64::sqrt(aa * bb) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use stribeck_testing::Noise;

    use super::*;

    /// A ring of noise cut into windows of 64 is refused in columns; a table of sensors that hear the same is not.
    #[test]
    fn planted_windows_are_refused_and_sensors_are_not() {
        let mut noise = Noise::new(7);
        let mut before = [0.0; 2];
        let signal: Vec<f64> = (0..64 * 1000)
            .map(|_| {
                let next = 1.2 * before[0] - 0.8 * before[1] + noise.uniform();
                before = [next, before[0]];
                next
            })
            .collect();
        let recording = |channels: Vec<Channel>| Recording {
            path: "a.npy".into(),
            format: "npy",
            channels,
            notes: vec![],
        };
        let refused = |recording: &Recording| {
            refuse(recording, &recording.channels.iter().collect::<Vec<_>>()).is_err()
        };
        let column =
            |k: usize| Channel::held(format!("a[{k}]"), signal.iter().skip(k).step_by(64).copied().collect());
        assert!(refused(&recording((0..64).map(column).collect())));
        let sensor = |k: usize| Channel::held(format!("a[{k}]"), signal[k..k + 1000].to_vec());
        assert!(!refused(&recording((0..64).map(sensor).collect())));
        // White noise that all sensors share.
        let white: Vec<f64> = (0..1000).map(|_| noise.uniform()).collect();
        let shared = |k: usize| Channel::held(format!("a[{k}]"), white.clone());
        assert!(!refused(&recording((0..64).map(shared).collect())));
    }
}
