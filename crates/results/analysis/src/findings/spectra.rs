//! Spectra of a record and their evaluation: lines of facets and the notch at them, the defect's family and
//! its envelope.

use stribeck_dsp::{PeriodCount, Spectrum, Welch, WelchOptions};
use stribeck_scene::scene::ContactSurface;
use stribeck_store::run_dir::Run;

use super::{GRID_HZ, SHORTEST_SPECTRUM, SensorSignal};
use crate::Error;
use crate::artefacts;
use crate::duty::{self, DutyFinding, ShockOrder};
use crate::enveloping;
use crate::families::FamilyFinding;
use crate::filtering::{Filter, PAPER_CENTRE_HZ};
use crate::kinematics;
use crate::prediction::Prediction;
use crate::record::Record;
use crate::tones::{self, Tone};
use stribeck_diagnosis::STANDARD_GRAVITY;

/// The spectrum of all of a signal, in which a family of `fundamental_hz` is looked for where the segments of
/// its `density` do not show it and the whole does.
pub(super) fn fine_density(
    signal: &[f64],
    density: &Spectrum,
    fundamental_hz: f64,
) -> Result<Option<Spectrum>, Error> {
    let periods = density.resolution().record_s * fundamental_hz;
    if artefacts::shows_family(density, fundamental_hz) || periods < PeriodCount::ENOUGH {
        return Ok(None);
    }
    let samples = signal.len();
    // A line has room beside its prediction.
    let options = WelchOptions { nfft: (2 * samples).next_power_of_two(), ..WelchOptions::new(samples) };
    let mut welch = Welch::new(density.sample_rate_hz(), samples, &options).map_err(Error::Signal)?;
    welch.estimate(signal).map(Some).map_err(Error::Signal)
}

/// Every line at every sensor.
pub(super) fn measured_tones(
    sensors: &[SensorSignal],
    lines: &[tones::PredictedLine],
    notes: &mut Vec<String>,
) -> Result<Vec<Tone>, Error> {
    let mut all = Vec::new();
    for sensor in sensors {
        if let Some(density) = &sensor.raw_density {
            all.extend(tones::measure(&sensor.name, lines, density)?);
        }
    }
    if let Some(merged) = all.first().filter(|t| !t.unresolved_from.is_empty()) {
        notes.push(format!(
            "the spectra cannot tell {} ×1 from {}: they are searched as one line",
            merged.name,
            merged.unresolved_from.join(" and ")
        ));
    }
    Ok(all)
}

/// A notch at the dominant facet tone of the leading sensor; failing that at the clearest of any sensor, or
/// at the predicted one. Where contact is with the round surface that facets stand for, none is predicted,
/// and a tone there counts only where the rollers' motion makes it, too: a peak that stands at its place may
/// be anything.
pub(super) fn filter(
    run: &Run,
    record: &Record<'_>,
    prediction: &Prediction,
    sensors: &[SensorSignal],
    (measured, families): (&[Tone], &[FamilyFinding]),
    notes: &mut Vec<String>,
) -> Result<Option<Filter>, Error> {
    if record.is_empty() {
        return Ok(None);
    }
    let predicted = prediction.facet_lines.first().map(|l| l.1).filter(|&hz| hz > 0.0);
    let leading = sensors.first().and_then(|s| tones::dominant(measured, &s.name));
    let tone = leading.or_else(|| tones::clearest(measured));
    let faceted = run.scene.written.contact.surface == ContactSurface::Facet;
    let by_motion = families.iter().any(|f| f.found || !f.not_told_apart_from.is_empty());
    let centre_hz = match (tone.filter(|_| faceted || by_motion), predicted) {
        (Some(tone), _) => {
            if leading.is_none() {
                notes.push(format!(
                    "no tone of the rollers’ facets stands {} dB above its surroundings at the leading sensor: the notch is \
                     at that of sensor {}",
                    tones::LEAST_PROMINENCE_DB,
                    tone.sensor
                ));
            }
            tone.measured_hz.or(predicted).unwrap_or(PAPER_CENTRE_HZ)
        }
        (None, _) if !faceted => {
            let seen = match tone.and_then(|tone| tone.measured_hz) {
                Some(hz) => {
                    format!("the peak at {hz:.0} Hz does not follow the rollers\u{2019} recorded motion")
                }
                None => format!(
                    "no tone of the rollers’ facets stands {} dB above its surroundings at any sensor",
                    tones::LEAST_PROMINENCE_DB
                ),
            };
            notes.push(format!(
                "no notch: with `contact.surface: {}` no roller goes over edges of facets, and {seen}, so \
                 that a filter there would take nothing of them away; its figures and numbers are left out",
                if run.scene.written.contact.surface == ContactSurface::Arc { "arc" } else { "nagata" },
            ));
            return Ok(None);
        }
        (None, predicted) => {
            notes.push(format!(
                "no tone of the rollers’ facets stands {} dB above its surroundings at any sensor: the notch is at the \
                 predicted one",
                tones::LEAST_PROMINENCE_DB
            ));
            predicted.unwrap_or(PAPER_CENTRE_HZ)
        }
    };
    if centre_hz >= 0.5 * record.sample_rate_hz() {
        notes.push(format!(
            "no notch: {centre_hz:.0} Hz is not below half the sampling rate, {:.0} Hz",
            0.5 * record.sample_rate_hz()
        ));
        return Ok(None);
    }
    Filter::new(record.sample_rate_hz(), centre_hz).map(Some)
}

/// Puts every sensor behind a notch at its own dominant facet tone, as if it were the only one; where it has
/// none, behind that of the record.
pub(super) fn filter_sensors(
    common: &Filter,
    measured: &[Tone],
    record: &Record<'_>,
    sensors: &mut [SensorSignal],
) -> Result<(), Error> {
    let rate_hz = record.sample_rate_hz();
    let mut welch = None;
    if record.len() >= SHORTEST_SPECTRUM {
        welch = Some(Welch::for_grid(rate_hz, record.len(), GRID_HZ).map_err(Error::Signal)?);
    }
    for sensor in sensors {
        let own_hz = tones::dominant(measured, &sensor.name).and_then(|tone| tone.measured_hz);
        let filter = own_hz.map_or(Ok(*common), |hz| Filter::new(rate_hz, hz))?;
        sensor.filtered_g = filter.acceleration(&sensor.raw_g)?;
        sensor.notch = Some(filter);
        let density = welch.as_mut().map(|welch| welch.estimate(&sensor.filtered_g));
        sensor.filtered_density = density.transpose().map_err(Error::Signal)?;
    }
    Ok(())
}

/// The defect's family over the angle of the shaft against the outer ring, stored in `duty`, with the
/// spectrum; a note where there is none.
pub(super) fn order_spectrum(
    run: &Run,
    record: &Record<'_>,
    motion: &kinematics::KinematicsFinding,
    sensors: &[SensorSignal],
    duty: Option<&mut DutyFinding>,
    notes: &mut Vec<String>,
) -> Result<Option<Spectrum>, Error> {
    let Some(family) = ShockOrder::of(&run.scene) else { return Ok(None) };
    let leading = sensors.first().filter(|s| s.raw_g.len() >= SHORTEST_SPECTRUM);
    let (Some(leading), Some(turns)) = (leading, duty::turns(record)) else { return Ok(None) };
    let moved = duty::moved(family.defect, motion);
    match duty::over_angle(&leading.raw_g, record.sample_rate_hz(), &turns, family, moved)? {
        Ok((spectrum, finding)) => {
            if let Some(duty) = duty {
                duty.envelope = Some(finding);
            }
            Ok(Some(spectrum))
        }
        Err(why) => {
            notes.push(why);
            Ok(None)
        }
    }
}

/// The envelope spectrum of a channel and its lines; the reason why there is none when the record is not long
/// enough, instead of a spectrum that means nothing.
pub(super) type Enveloped = Result<(Spectrum, enveloping::EnvelopeFinding), String>;

/// Of channel `name`; `None` for an empty record.
pub(super) fn envelope(
    record: &Record<'_>,
    prediction: &Prediction,
    motion: &kinematics::KinematicsFinding,
    name: &str,
) -> Result<Option<Enveloped>, Error> {
    let signal = record.part(0..record.len(), |n| n == name)?.take(name);
    let Some(mut signal_g) = signal.filter(|s| !s.is_empty()) else { return Ok(None) };
    signal_g.iter_mut().for_each(|a| *a /= STANDARD_GRAVITY);
    let lines = artefacts::defect_lines(prediction, motion);
    enveloping::analyse(&signal_g, record.sample_rate_hz(), &lines).map(Some)
}

#[cfg(test)]
mod tests {
    use super::super::HARMONICS;
    use super::*;

    /// Impacts 19.8 times a second in 5 s, each of a few milliseconds: segments of a third of a second hold
    /// 6.6 of them.
    #[test]
    fn issue_lines_of_a_slow_bearing_stand_in_the_spectrum_of_the_whole_record() {
        const RATE_HZ: f64 = 2000.0;
        let impact = |t: f64| (-(t.rem_euclid(1.0 / 19.8)) / 4e-3).exp();
        let signal: Vec<f64> = (0..10_000).map(|n| impact(f64::from(n) / RATE_HZ)).collect();
        let density = Welch::for_grid(RATE_HZ, signal.len(), GRID_HZ).unwrap().estimate(&signal).unwrap();
        assert!(!artefacts::shows_family(&density, 19.8));
        let fine = fine_density(&signal, &density, 19.8).unwrap().expect("99 periods");
        assert!((fine.resolution().resolution_hz - 0.2).abs() < 1e-9);
        let lines = tones::harmonics(&[("BPFO".into(), 19.8)], HARMONICS, 0.5 * RATE_HZ);
        for tone in tones::measure("side", &lines, &fine).unwrap() {
            assert!((tone.measured_hz.expect("a line") - tone.predicted_hz).abs() < 0.1, "{tone:?}");
        }
        // Segments suffice for a fast family, and the whole record is too short for a slow one.
        assert!(fine_density(&signal, &density, 40.0).unwrap().is_none());
        assert!(fine_density(&signal, &density, 1.0).unwrap().is_none());
    }
}
