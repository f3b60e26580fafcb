//! A signal to be listened to, in the page.

use maud::{Markup, PreEscaped, html};
use stribeck_analysis::findings::Findings;
use stribeck_diagnosis::words::numbers::significant;
use stribeck_dsp::Sound;
use stribeck_dsp::channel::wav::{Whole, pcm};

use crate::plot::base64_bytes;

/// Sample rate of the played sound [Hz].
const RATE_HZ: u32 = 48_000;
/// Longest sound of a page [s]: 0.6 MB.
const LONGEST_S: f64 = 5.0;
/// A sound shorter than this is a click, and is slowed down [s].
const SHORTEST_S: f64 = 0.5;
/// How much slower short records are played, until one is long enough.
const SLOWER: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
/// Speeds offered beside.
const SPEEDS: [(f64, &str); 4] = [(1.0, "1×"), (0.5, "½×"), (0.25, "¼×"), (0.1, "⅒×")];

/// The leading sensor of a run; nothing where it has none, or one at rest.
pub(crate) fn of_run(findings: &Findings) -> Markup {
    match findings.sensors.first() {
        Some(sensor) => {
            player(&format!("a_y at sensor “{}”", sensor.name), &sensor.raw_g, 1.0 / findings.interval_s, "g")
        }
        None => html! {},
    }
}

/// A player for the beginning of a signal, called `name`; nothing for a constant one.
pub(crate) fn player(name: &str, signal: &[f64], rate_hz: f64, unit: &str) -> Markup {
    let length_s = signal.len() as f64 / rate_hz;
    let slow = SLOWER.into_iter().find(|slow| slow * length_s >= SHORTEST_S).unwrap_or(1000.0);
    let kept = ((LONGEST_S / slow * rate_hz) as usize).clamp(1, signal.len().max(1));
    let Ok(sound) = Sound::of(&signal[..kept.min(signal.len())], rate_hz, RATE_HZ, slow) else {
        return html! {};
    };
    let samples = sound.samples.iter().map(|x| f64::from(*x) / 32_768.0).collect();
    let note = format!("{name}, slowed {slow} times");
    let Some(bytes) = pcm(RATE_HZ, Whole::Of16, &[samples], &[note]) else { return html! {} };
    let of = if kept < signal.len() { "the beginning of " } else { "" };
    let part_s = kept.min(signal.len()) as f64 / rate_hz;
    html! {
        figure id="sound" class="sound" {
            h3 { "How it sounds" }
            p class="caption" {
                (of) (name) ": " (significant(part_s, 3)) " s"
                @if slow > 1.0 {
                    (format!(", played {slow} times slower, so that what sounds at 100 Hz is at {} Hz", 100.0 * slow))
                }
                "."
            }
            audio controls preload="metadata" src=(format!("data:audio/wav;base64,{}", base64_bytes(&bytes))) {}
            span class="speeds" role="group" aria-label="Speed" {
                @for (speed, words) in SPEEDS {
                    button type="button" data-speed=(speed) aria-pressed=(if speed == 1.0 { "true" } else { "false" }) { (words) }
                }
                a download="sound.wav" href="#sound" { "save as WAV" }
            }
            p class="note" {
                (format!(
                    "As loud as 16 bits hold: full scale is {}. Slower speeds lower the pitch with it.",
                    format!("{} {unit}", significant(sound.full_scale, 3)).trim_end()
                ))
            }
            script { (PreEscaped(include_str!("../assets/sound.js"))) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_short_record_is_slowed_and_a_constant_one_is_not_played() {
        let signal: Vec<f64> = (0..6_000).map(|n| f64::from(n % 50)).collect();
        let page = player("a signal", &signal, 100_000.0, "g").into_string();
        assert!(page.contains("played 10 times slower") && page.contains("data:audio/wav;base64,UklGR"));
        let page = player("a signal", &signal, 6_000.0, "").into_string();
        assert!(!page.contains("times slower") && page.contains("1 s"));
        assert!(player("a signal", &[1.0; 6_000], 6_000.0, "").into_string().is_empty());
        assert!(player("a signal", &[], 6_000.0, "").into_string().is_empty());
    }
}
