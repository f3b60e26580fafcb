//! Spectra of the leading sensor over time, over speed and over the angle of the shaft.

use stribeck_analysis::duty::turns;
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::Record;
use stribeck_diagnosis::{Course, Varying};

use crate::plot::Picture;
use crate::{Error, course};

/// Shortest record with a spectrogram [s].
const SPECTROGRAM_S: f64 = 0.1;

/// Spectra of the leading sensor over time, of a record that is long enough to have a course; where the speed
/// changes over speed and angle, too.
pub(super) fn pictures(record: &Record<'_>, findings: &Findings) -> Result<Vec<Picture>, Error> {
    const TABS: &str = "course";
    let Some(leading) = findings.sensors.first() else { return Ok(Vec::new()) };
    let rate_hz = 1.0 / findings.interval_s;
    if findings.interval_s * (leading.raw_g.len() as f64) < SPECTROGRAM_S {
        return Ok(Vec::new());
    }
    let varying = varying(record, findings, &leading.raw_g, rate_hz)?;
    let course = match &varying {
        Some(varying) => varying.course.clone(),
        None => Course::of(&leading.raw_g, rate_hz)?,
    };
    let mut picture = course::picture(&course, "g").tabbed(TABS, "spectrogram");
    picture.title = format!("Spectrogram of a_y at sensor “{}”", leading.name);
    // The picture begins at zero, where a stretch of a record does not.
    if findings.start_s > findings.interval_s {
        picture.note += &format!(" Time counts from {:.3} s of the run.", findings.start_s);
    }
    let mut pictures = vec![picture];
    let speeds = varying.as_ref().map(|varying| varying.speeds_rpm.as_slice());
    pictures.extend(course::waterfall(&course, "g", speeds).map(|picture| picture.tabbed(TABS, "waterfall")));
    let orders = findings.summary.duty.as_ref().map_or(&[][..], |duty| &duty.orders);
    pictures.extend(varying.as_ref().and_then(|varying| {
        let map = course::order_map(varying.orders.as_ref()?, varying.band_hz, orders);
        Some(map.tabbed(TABS, "order map"))
    }));
    Ok(pictures)
}

/// Spectra over speed and angle, of a shaft that changes its speed and does not turn back.
fn varying(
    record: &Record<'_>,
    findings: &Findings,
    signal: &[f64],
    rate_hz: f64,
) -> Result<Option<Varying>, Error> {
    let Some(duty) = findings.summary.unsteady() else { return Ok(None) };
    let Some(turns) = turns(record).filter(|turns| turns.len() == signal.len()) else { return Ok(None) };
    if turns.windows(2).any(|pair| pair[1] < pair[0]) {
        return Ok(None);
    }
    let band_hz = duty.envelope.as_ref().map(|envelope| envelope.band_hz);
    Ok(Some(Varying::of(signal, rate_hz, &turns, band_hz.unwrap_or((0.05 * rate_hz, 0.45 * rate_hz)))?))
}
