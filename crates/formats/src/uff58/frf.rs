//! Frequency response functions: functions of type 4, complex over frequency.

use std::f64::consts::TAU;
use std::path::Path;

use super::{Dataset, FORMAT, Found, datasets, numbers};
use crate::{Error, Result};

/// A frequency response function: acceleration at a sensor over what excites it.
#[derive(Debug, Clone, PartialEq)]
pub struct Frf {
    /// Its name.
    pub name: String,
    /// Where its dataset begins: a line of the file, from 1.
    pub line: usize,
    /// The reference of the response.
    pub per: Per,
    /// Frequencies [Hz], as the file has them.
    pub hz: Vec<f64>,
    /// Real and imaginary part, in m/s² per N or in m/s² per m/s², whatever the file has: responses in
    /// velocity and displacement are differentiated, other units converted.
    pub response: Vec<[f64; 2]>,
    /// Notes on assumptions and conversions.
    pub notes: Vec<String>,
}

/// What excites.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Per {
    /// A force [N].
    Force,
    /// An acceleration [m/s²].
    Acceleration,
}

/// Type of a frequency response function.
const FRF: f64 = 4.0;
const STANDARD_GRAVITY: f64 = 9.806_65;

/// The frequency response functions of a file, and why each other dataset 58 is none.
///
/// # Errors
/// [`Error::Damaged`], [`Error::Io`], [`Error::Unknown`] for a file of another format.
pub fn responses(path: &Path) -> Result<(Vec<Frf>, Vec<String>)> {
    let (mut found, mut others) = (Vec::new(), Vec::new());
    let mut sets = 0;
    for (line, dataset) in datasets(path)? {
        sets += 1;
        let dataset = match dataset {
            Found::Function(dataset) => dataset,
            Found::Damaged(what) => {
                others.push(format!("the {what}"));
                continue;
            }
            Found::Other(_) => continue,
        };
        match dataset.frf(line) {
            Ok(frf) => found.push(frf),
            Err(why) => others.push(format!("`{}` of line {line}: {why}", dataset.name())),
        }
    }
    if sets == 0 {
        let seen = format!("it has no dataset of {FORMAT}, which begins with a line `    -1`");
        return Err(Error::Unknown { path: path.to_owned(), seen });
    }
    Ok((found, others))
}

/// Names of the types of function, for the message on another one.
fn type_in_words(of: f64) -> String {
    let name = match of as i64 {
        0 => "of no stated kind",
        1 => "a response in time",
        2 => "an auto spectrum",
        3 => "a cross spectrum",
        4 => "a frequency response",
        5 => "a transmissibility",
        6 => "a coherence",
        7 => "an auto correlation",
        8 => "a cross correlation",
        9 => "a power spectral density",
        _ => "another function",
    };
    format!("{of} ({name})")
}

impl Dataset {
    /// As a frequency response function, or why it is none.
    fn frf(&self, line: usize) -> std::result::Result<Frf, String> {
        let kind = numbers(&self.head[5]).first().copied().unwrap_or(f64::NAN);
        // Some writers call a transmissibility by its own number.
        if kind != FRF && kind != 5.0 {
            return Err(format!("function type {}, where 4 is a frequency response", type_in_words(kind)));
        }
        if !self.complex {
            return Err("its values are real: without its phase a response cannot be applied; export it as \
                        complex"
                .to_owned());
        }
        let abscissa = numbers(&self.head[7]).first().copied().unwrap_or(f64::NAN);
        if !matches!(abscissa as i64, 18 | 0) {
            return Err(format!("its abscissa has type {abscissa}, where 18 is the frequency"));
        }
        let mut notes: Vec<String> = self.odd.iter().cloned().collect();
        let (order, top) = response(numbers(&self.head[8]).first().copied(), self.unit(8), &mut notes)?;
        let (per, bottom) = reference(numbers(&self.head[9]).first().copied(), self.unit(9), &mut notes)?;
        let stride = 2 + usize::from(!self.even);
        let (mut hz, mut values) = (Vec::with_capacity(self.count), Vec::with_capacity(self.count));
        for (n, row) in self.values.chunks_exact(stride).take(self.count).enumerate() {
            let f = if self.even { self.first + n as f64 * self.increment } else { row[0] };
            let [re, im] = [row[stride - 2] * top / bottom, row[stride - 1] * top / bottom];
            let omega = TAU * f;
            // Each derivative multiplies by iω.
            values.push(match order {
                0 => [re, im],
                1 => [-omega * im, omega * re],
                _ => [-omega * omega * re, -omega * omega * im],
            });
            hz.push(f);
        }
        Ok(Frf { name: self.name().to_owned(), line, per, hz, response: values, notes })
    }
}

/// How often a response must be differentiated to be an acceleration, and its factor to SI.
fn response(
    kind: Option<f64>,
    unit: Option<String>,
    notes: &mut Vec<String>,
) -> std::result::Result<(u32, f64), String> {
    const KNOWN: [(&str, u32, f64); 11] = [
        ("m/s^2", 0, 1.0),
        ("m/s2", 0, 1.0),
        ("m/s**2", 0, 1.0),
        ("mm/s^2", 0, 1e-3),
        ("g", 0, STANDARD_GRAVITY),
        ("m/s", 1, 1.0),
        ("mm/s", 1, 1e-3),
        ("m", 2, 1.0),
        ("mm", 2, 1e-3),
        ("um", 2, 1e-6),
        ("µm", 2, 1e-6),
    ];
    let by_kind = match kind.map(|kind| kind as i64) {
        Some(12) => Some((0, "m/s^2")),
        Some(11) => Some((1, "m/s")),
        Some(8) => Some((2, "m")),
        _ => None,
    };
    let Some(unit) = unit else {
        let (order, unit) = by_kind.ok_or(
            "its response has neither a type (8 displacement, 11 velocity, 12 acceleration) nor a unit",
        )?;
        notes.push(format!("the response has no unit: {unit} is taken"));
        return Ok((order, 1.0));
    };
    let known = KNOWN.iter().find(|(name, ..)| name.eq_ignore_ascii_case(&unit));
    let Some((_, order, factor)) = known else {
        return Err(format!(
            "its response is in `{unit}`; known are m/s^2, mm/s^2, g, m/s, mm/s, m, mm and um"
        ));
    };
    match by_kind {
        Some((of_kind, _)) if of_kind != *order => Err(format!(
            "its response is in `{unit}`, which its type {} contradicts (8 displacement, 11 velocity, 12 \
             acceleration)",
            kind.unwrap_or(f64::NAN)
        )),
        _ => Ok((*order, *factor)),
    }
}

/// Reference of a response, and the factor to SI.
fn reference(
    kind: Option<f64>,
    unit: Option<String>,
    notes: &mut Vec<String>,
) -> std::result::Result<(Per, f64), String> {
    const KNOWN: [(&str, Per, f64); 7] = [
        ("N", Per::Force, 1.0),
        ("kN", Per::Force, 1e3),
        ("mN", Per::Force, 1e-3),
        ("lbf", Per::Force, 4.448_221_615_260_5),
        ("m/s^2", Per::Acceleration, 1.0),
        ("m/s2", Per::Acceleration, 1.0),
        ("g", Per::Acceleration, STANDARD_GRAVITY),
    ];
    let by_kind = match kind.map(|kind| kind as i64) {
        Some(9 | 13) => Some((Per::Force, "N")),
        Some(12) => Some((Per::Acceleration, "m/s^2")),
        _ => None,
    };
    let Some(unit) = unit else {
        let (per, unit) = by_kind.ok_or(
            "its reference has neither a type (9 or 13 force, 12 acceleration) nor a unit: what excited it?",
        )?;
        notes.push(format!("the reference has no unit: {unit} is taken"));
        return Ok((per, 1.0));
    };
    let known = KNOWN.iter().find(|(name, ..)| *name == unit);
    known.map(|(_, per, factor)| (*per, *factor)).ok_or_else(|| {
        format!(
            "its reference is in `{unit}`; known are N, kN, mN, lbf, and m/s^2 and g of a transmissibility"
        )
    })
}
