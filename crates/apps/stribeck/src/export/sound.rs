//! WAV files of `stribeck export`: one channel scaled for listening, or all as a recorder or in floats.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use stribeck_dsp::Sound;
use stribeck_formats::wav::{Whole, pcm};
use stribeck_formats::{Channel, Recording, wav};
use stribeck_store::run_dir::{Run, RunDir, write_atomic};

use super::{Options, provenance, sensor};
use crate::out::tell;

/// Samples a second that a sound card plays [Hz].
const RATES_HZ: [u32; 2] = [44_100, 48_000];
/// Slowest sound: a shock of a microsecond is then one of a millisecond.
const SLOWEST: f64 = 1000.0;
/// A sound shorter than this is a click [s].
const CLICK_S: f64 = 0.5;

/// Parses the sample rate of a sound [Hz].
pub(super) fn rate(text: &str) -> Result<u32, String> {
    let rate = text.trim().parse().ok().filter(|rate| RATES_HZ.contains(rate));
    rate.ok_or_else(|| "a sound card plays 44100 or 48000 samples a second".to_owned())
}

/// Parses the factor by which a sound is slowed.
pub(super) fn slow(text: &str) -> Result<f64, String> {
    let slow = text.trim().parse::<f64>().ok().filter(|slow| (1.0..=SLOWEST).contains(slow));
    slow.ok_or_else(|| format!("a sound is played 1 to {SLOWEST} times slower, for example 10"))
}

/// Writes one channel as 16-bit sound at the rate of a sound card.
pub(super) fn write(dir: &RunDir, run: &Run, options: &Options, path: &Path) -> Result<PathBuf> {
    let recording = Recording::open(dir.trace())?;
    let channel = pick(&recording, &options.channels)?;
    let rate_hz = channel.rate_hz.context("the run has no sample rate")?;
    let slow = options.slow.unwrap_or(1.0);
    let samples: Vec<f64> = channel.read()?.into_iter().filter(|x| x.is_finite()).collect();
    let played_hz = options.rate_hz.unwrap_or(RATES_HZ[1]);
    let sound = Sound::of(&samples, rate_hz, played_hz, slow)
        .with_context(|| format!("channel `{}` makes no sound", channel.name))?;
    if sound.duration_s() < CLICK_S {
        tell!(
            "note: {:.3} s of sound are a click; `--slow {:.0}` makes a second of them, `solver.duration_ms` \
             a longer record",
            sound.duration_s(),
            (slow / sound.duration_s()).clamp(2.0, SLOWEST)
        );
    }
    let mut notes = provenance(run);
    notes.push(format!(
        "{}, slowed {slow} times; full scale is {:e} {}",
        channel.name,
        sound.full_scale,
        super::unit(&channel.name).unwrap_or_default()
    ));
    let samples = sound.samples.iter().map(|x| f64::from(*x) / 32_768.0).collect();
    let bytes =
        pcm(sound.rate_hz, Whole::Of16, &[samples], &notes).context("the sound is longer than 4 GiB")?;
    write_atomic(path, &bytes)?;
    Ok(path.to_owned())
}

/// The requested channel; otherwise the vertical acceleration of the first sensor.
fn pick<'a>(recording: &'a Recording, asked: &[String]) -> Result<&'a Channel> {
    let contains = |c: &Channel| asked.iter().any(|part| c.name.contains(part));
    let leading = |c: &Channel| c.name.starts_with("sensor.") && c.name.ends_with(".ay_m_s2");
    let signals = recording.channels.iter().filter(|c| !c.is_time && c.name != "time_s");
    let found: Vec<&Channel> =
        signals.filter(|c| if asked.is_empty() { leading(c) } else { contains(c) }).collect();
    match found[..] {
        [] if asked.is_empty() => {
            bail!("the run recorded no sensor: choose with `--channel` among {}", recording.names())
        }
        [] => bail!("no channel contains `{}`; the run has {}", asked.join("` or `"), recording.names()),
        [one] => Ok(one),
        [first, ..] => {
            if !asked.is_empty() {
                tell!("note: a sound is one channel: `{}` of {} that were named", first.name, found.len());
            }
            Ok(first)
        }
    }
}

/// Channels as a recorder writes them: in the bits of the `sensor`, whose range is full scale; without bits
/// as floats.
pub(super) fn recorded(
    path: &Path,
    channels: &[Channel],
    text: Option<&str>,
    mut notes: Vec<String>,
) -> Result<()> {
    let rate_hz = channels.first().and_then(|c| c.rate_hz).context("the run has no sample rate")?;
    let sensor = sensor(text.unwrap_or_default(), rate_hz)?;
    let Some(bits) = sensor.bits else { return Ok(wav::write(path, channels, &notes)?) };
    ensure!(
        sensor.rate_hz.fract() == 0.0 && sensor.rate_hz <= f64::from(u32::MAX),
        "`rate_hz={}` of the sensor: WAV holds whole numbers of hertz",
        sensor.rate_hz
    );
    let whole = Whole::holding(bits).context("a converter has 32 bits at most")?;
    let scaled = |channel: &Channel| -> Result<Vec<f64>> {
        Ok(channel.read()?.into_iter().map(|x| x / sensor.range).collect())
    };
    let columns = channels.iter().map(scaled).collect::<Result<Vec<_>>>()?;
    notes.push(format!("{bits} bits; full scale is {} m/s^2", sensor.range));
    let bytes = pcm(sensor.rate_hz as u32, whole, &columns, &notes)
        .context("more than 4 GiB of samples do not fit into a WAV file; use npz")?;
    Ok(write_atomic(path, &bytes)?)
}
