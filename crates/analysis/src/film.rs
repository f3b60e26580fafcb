//! Oil between rollers and raceways: how thick it is, what it carries, what it takes.

use serde::{Deserialize, Serialize};
use stribeck_scene::{lubrication, run_dir::Run};

use crate::Error;
use crate::record::Record;

/// A film that is no more than this much thicker than its least is that of a loaded contact [-].
const LOADED: f64 = 0.01;

/// Oil on the outer and on the inner raceway.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FilmFinding {
    /// Film thickness under the most loaded roller at rest by Dowson and Higginson [µm].
    pub loaded_um: [f64; 2],
    /// The same over the composite roughness [-].
    pub lambda: [f64; 2],
    /// Median thickness over all samples of all rollers that the raceway does not load [µm].
    pub floating_um: [Option<f64>; 2],
    /// Largest force through the film of a roller, mean over a sampling interval at whose ends the raceway does not load it [N].
    pub largest_n: [Option<f64>; 2],
    /// Heat of all films over the record [J].
    pub heat_j: Option<f64>,
}

impl FilmFinding {
    /// `None` for a scene without oil, or one whose loaded films are not to be had.
    ///
    /// # Errors
    /// [`Error::Run`] when the trace cannot be read.
    pub fn measure(run: &Run, record: &Record<'_>) -> Result<Option<Self>, Error> {
        let Ok(Some(loaded)) = lubrication::loaded_films(&run.scene) else { return Ok(None) };
        let films = |name: &str| {
            name.starts_with("roller.") && (name.contains(".outer_") || name.contains(".inner_"))
        };
        let record = record.part(0..record.len(), films)?;
        let rollers: Vec<usize> = run.scene.rollers_in_place().collect();
        let channel = |roller: usize, side: usize, what: &str| {
            let ring = ["outer", "inner"][side];
            record.channel(&format!("roller.{roller}.{ring}_{what}"))
        };
        let floats = |side: usize, thickness: f64| thickness > (1.0 + LOADED) * loaded[side].least;
        let floating = |side: usize| {
            let thick = rollers.iter().filter_map(|r| channel(*r, side, "film_m")).flatten();
            let mut thick: Vec<f64> = thick.copied().filter(|h| floats(side, *h)).collect();
            let middle = thick.len() / 2;
            (!thick.is_empty()).then(|| 1e6 * *thick.select_nth_unstable_by(middle, f64::total_cmp).1)
        };
        let largest = |side: usize| {
            let of = |r: &usize| {
                let r = *r;
                Some((channel(r, side, "film_m")?, channel(r, side, "fx_n")?, channel(r, side, "fy_n")?))
            };
            let forces = rollers.iter().filter_map(of).flat_map(|(thick, x, y)| {
                let floats = move |n: usize| floats(side, thick[n - 1]) && floats(side, thick[n]);
                (1..thick.len()).filter(move |n| floats(*n)).map(|n| x[n].hypot(y[n]))
            });
            forces.reduce(f64::max)
        };
        Ok(Some(Self {
            loaded_um: [0, 1].map(|side: usize| 1e6 * loaded[side].thickness),
            lambda: [0, 1].map(|side: usize| loaded[side].lambda),
            floating_um: [0, 1].map(floating),
            largest_n: [0, 1].map(largest),
            heat_j: run.energy.channel("film_j")?.and_then(|heat| heat.last().copied()),
        }))
    }
}
