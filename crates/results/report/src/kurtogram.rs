//! The bands that a verdict examines and how impulsive each is: a kurtogram over a dyadic tree.

use stribeck_dsp::BandEnvelope;

use crate::page::HALF_PAGE_PX;
use crate::plot::{Anchor, Picture, Scale, Sheet, shade_rgb, ticks};

/// Where it stands on the sheet [px].
const AT: [f64; 2] = [104.0, 14.0];
const SIZE: [f64; 2] = [416.0, 176.0];
const INK: &str = "#14181c";

/// A band that is pointed out: its ends [Hz] and why.
pub(super) struct Chosen {
    pub(super) band_hz: (f64, f64),
    pub(super) why: String,
}

/// The kurtogram of `bands`, with those that were chosen outlined; `None` without bands.
pub(super) fn picture(bands: &[BandEnvelope], chosen: &[Chosen]) -> Option<Picture> {
    let half_hz = bands.iter().map(|b| b.high_hz).fold(0.0, f64::max);
    let most = bands.iter().filter(|b| b.kurtosis.is_finite());
    let most = most.max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis))?;
    let levels = levels(bands, half_hz);
    let high = SIZE[1] / levels.len() as f64;
    let mut sheet = Sheet::new(f64::from(HALF_PAGE_PX), 250.0);
    let x = |hz: f64| AT[0] + SIZE[0] * hz / half_hz;
    for (row, (count, of_level)) in levels.iter().enumerate() {
        let y = AT[1] + high * row as f64;
        let words = if *count == 1 { "whole".to_owned() } else { format!("{count} bands") };
        sheet.text([AT[0] - 10.0, y + 0.5 * high + 4.0], 12.0, Anchor::End, INK, &words);
        for band in of_level {
            // Noise has 0; shades go with the root, or one band would leave all others dark.
            let part = (band.kurtosis.max(0.0) / most.kurtosis.max(1e-9)).sqrt();
            let [r, g, b] = shade_rgb(part);
            let (left, right) = (x(band.low_hz), x(band.high_hz));
            sheet.path(
                &[[left, y], [right, y], [right, y + high], [left, y + high]],
                true,
                &format!("fill:#{r:02x}{g:02x}{b:02x};stroke:#fff;stroke-width:1"),
            );
            let bright = 0.3 * f64::from(r) + 0.6 * f64::from(g) + 0.1 * f64::from(b) > 140.0;
            let ink = if bright { INK } else { "#ffffff" };
            let at = [0.5 * (left + right), y + 0.5 * high + 4.0];
            sheet.text(at, 12.0, Anchor::Middle, ink, &number(band.kurtosis));
        }
    }
    for Chosen { band_hz: (low, top), .. } in chosen {
        let is_it = |b: &&BandEnvelope| b.low_hz == *low && b.high_hz == *top;
        let Some(row) = levels.iter().position(|(_, level)| level.iter().any(&is_it)) else { continue };
        let (y, left, right) = (AT[1] + high * row as f64, x(*low), x(*top));
        let frame = [[left, y], [right, y], [right, y + high], [left, y + high]];
        sheet.path(&frame, true, "fill:none;stroke:#b3202c;stroke-width:3");
    }
    let (values, step) = ticks(0.0, half_hz, 5);
    let foot = AT[1] + SIZE[1];
    for hz in values {
        sheet.path(&[[x(hz), foot], [x(hz), foot + 5.0]], false, "stroke:#14181c");
        sheet.text([x(hz), foot + 19.0], 12.0, Anchor::Middle, INK, &Scale::of(half_hz).text(hz, step, "Hz"));
    }
    sheet.text([AT[0] + 0.5 * SIZE[0], foot + 40.0], 13.0, Anchor::Middle, INK, "Frequency");
    let mut picture = Picture::new("kurtogram", "Kurtogram: bands with impacts", sheet);
    let whys: Vec<&str> = chosen.iter().map(|c| c.why.as_str()).collect();
    picture.caption = format!(
        "The envelope has the strongest impacts from {:.0} to {:.0} Hz, with a kurtosis of {}.{}",
        most.low_hz,
        most.high_hz,
        number(most.kurtosis),
        if whys.is_empty() { String::new() } else { format!(" Outlined: {}.", whys.join("; ")) }
    );
    picture.note = "Kurtosis of the complex envelope of each band less that of noise, which has 0. The \
                    verdict takes the band in which a family's comb stands highest, which need not be the \
                    one that has the strongest impacts."
        .into();
    Some(picture)
}

/// The bands of each level of the tree, widest first, with how many of them fill the whole.
fn levels(bands: &[BandEnvelope], half_hz: f64) -> Vec<(usize, Vec<&BandEnvelope>)> {
    let mut levels: Vec<(usize, Vec<&BandEnvelope>)> = Vec::new();
    for band in bands {
        // Halves of halves; the lowest band begins above zero and is a little narrower.
        let count = 1_usize << (half_hz / (band.high_hz - band.low_hz)).log2().round().max(0.0) as u32;
        match levels.iter_mut().find(|(of, _)| *of == count) {
            Some((_, level)) => level.push(band),
            None => levels.push((count, vec![band])),
        }
    }
    levels.sort_by_key(|(count, _)| *count);
    levels
}

fn number(kurtosis: f64) -> String {
    let text = if kurtosis.abs() < 9.95 { format!("{kurtosis:.1}") } else { format!("{kurtosis:.0}") };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(low_hz: f64, high_hz: f64, kurtosis: f64) -> BandEnvelope {
        BandEnvelope { low_hz, high_hz, rms: 1.0, kurtosis, grid_hz: 1.0, values: Vec::new(), segments: 1 }
    }

    #[test]
    fn behaves_the_chosen_band_is_outlined_in_its_level() {
        let bands = [
            band(20.0, 1000.0, 0.5),
            band(20.0, 500.0, 0.1),
            band(500.0, 1000.0, 4.0),
            // As much narrower as the lowest eighth of a record.
            band(40.0, 250.0, 0.0),
            band(250.0, 500.0, 0.2),
            band(500.0, 750.0, 12.0),
            band(750.0, 1000.0, -0.3),
        ];
        let counts: Vec<usize> = levels(&bands, 1000.0).iter().map(|(count, _)| *count).collect();
        assert_eq!(counts, [1, 2, 4]);
        let chosen = Chosen { band_hz: (500.0, 1000.0), why: "the verdict's".to_owned() };
        let drawn = picture(&bands, &[chosen]).expect("bands");
        assert!(drawn.caption.contains("from 500 to 750 Hz, with a kurtosis of 12"), "{}", drawn.caption);
        assert_eq!(drawn.sheet.to_svg().matches("stroke-width:3").count(), 1);
        assert!(picture(&[], &[]).is_none());
    }
}
