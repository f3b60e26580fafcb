//! Power of the accelerations in third octaves: the waveform of one impact is chaotic, its spectrum over many
//! starts is not.

use serde::{Deserialize, Serialize};

use super::BAND_LIMIT_DB;
use super::row::{Row, Scale};
use super::side::Side;
use crate::statistic::Statistic;

/// Power of a sensor in third octaves, both components together, mean over the starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Octaves {
    /// Sensor.
    pub sensor: String,
    /// Middles of the bands [Hz].
    pub centres_hz: Vec<f64>,
    /// Level by the full model [dB re 1 g].
    pub full_db: Vec<f64>,
    /// Level by the reduced one [dB re 1 g].
    pub reduced_db: Vec<f64>,
    /// Standard error of their difference by the scatter of the starts [dB]; empty for a single start.
    pub error_db: Vec<f64>,
}

impl Octaves {
    /// The row of one sensor; `None` without a band.
    pub(super) fn row(&self) -> Option<Row> {
        let off: Vec<f64> = self.reduced_db.iter().zip(&self.full_db).map(|(r, f)| r - f).collect();
        let difference = Statistic::of(&off, off.len())?;
        // Twice the standard error of a band may be on either side.
        let sure = |sign: f64| {
            off.iter().zip(&self.error_db).map(move |(off, error)| off.abs() + sign * 2.0 * error)
        };
        let decided = !self.error_db.is_empty()
            && (sure(1.0).all(|most| most <= BAND_LIMIT_DB) || sure(-1.0).any(|least| least > BAND_LIMIT_DB));
        Some(Row {
            name: format!("octaves_{}_db", self.sensor),
            quantity: format!("third octaves at the sensor {}, 0.5 to 10 kHz", self.sensor),
            scale: Scale::ThirdOctaves,
            within: difference.most.max(-difference.least) <= BAND_LIMIT_DB,
            decided,
            difference,
            limit: BAND_LIMIT_DB,
        })
    }
}

/// Levels of every sensor by both models; none where records hold no band.
pub(super) fn of_sensors(sides: &[[Side; 2]]) -> Vec<Octaves> {
    let Some([first, _]) = sides.first().filter(|[full, _]| !full.centres_hz.is_empty()) else {
        return Vec::new();
    };
    let of_sensor = |(at, (sensor, powers)): (usize, &(String, Vec<f64>))| {
        let means = |model: usize| -> Vec<BandMean> {
            (0..powers.len()).map(|band| BandMean::of(sides, model, at, band)).collect()
        };
        let (full, reduced) = (means(0), means(1));
        let error = |(f, r): (&BandMean, &BandMean)| f.error_db.hypot(r.error_db);
        let error_db =
            if sides.len() > 1 { full.iter().zip(&reduced).map(error).collect() } else { Vec::new() };
        Octaves {
            sensor: sensor.clone(),
            centres_hz: first.centres_hz.clone(),
            full_db: full.iter().map(|mean| mean.level_db).collect(),
            reduced_db: reduced.iter().map(|mean| mean.level_db).collect(),
            error_db,
        }
    };
    first.powers.iter().enumerate().map(of_sensor).collect()
}

/// Mean power of one band over the starts.
struct BandMean {
    /// [dB re 1 g]
    level_db: f64,
    /// Relative standard error of the mean power [dB]; not a number for a single start.
    error_db: f64,
}

impl BandMean {
    fn of(sides: &[[Side; 2]], model: usize, sensor: usize, band: usize) -> Self {
        let n = sides.len() as f64;
        let powers: Vec<f64> =
            sides.iter().filter_map(|pair| Some(*pair[model].powers.get(sensor)?.1.get(band)?)).collect();
        let mean = powers.iter().sum::<f64>() / powers.len().max(1) as f64;
        let spread = powers.iter().map(|p| (p / mean - 1.0).powi(2)).sum::<f64>() / (n - 1.0);
        Self { level_db: 10.0 * mean.log10(), error_db: 10.0 / std::f64::consts::LN_10 * (spread / n).sqrt() }
    }
}
