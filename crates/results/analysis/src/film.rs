//! Oil between rollers and raceways: thickness, load and friction.

use serde::{Deserialize, Serialize};
use stribeck_store::run_dir::Run;

use crate::Error;
use crate::record::Record;
use stribeck_diagnosis::quantities;

/// A film that is no more than this much thicker than its least is that of a loaded contact [-].
const LOADED: f64 = 0.01;

/// Rollers whose films and forces are in memory at once.
const ROLLERS_AT_ONCE: usize = 4;

const RINGS: [&str; 2] = ["outer", "inner"];

quantities! {
    /// Oil on the outer and on the inner raceway.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct FilmFinding {
        /// Film thickness under the most loaded roller at rest by Dowson and Higginson [µm].
        pub loaded_um: [f64; 2],
        /// The same over the composite roughness [-].
        pub lambda: [f64; 2],
        /// Median thickness over all samples of all rollers that the raceway does not load [µm].
        pub floating_um: [Option<f64>; 2],
        /// Largest force through the film of a roller, mean over a sampling interval at whose ends the
        /// raceway does not load it [N].
        pub largest_n: [Option<f64>; 2],
        /// Heat of all films over the record [J].
        pub heat_j: Option<f64>,
    }
}

impl FilmFinding {
    /// `None` for a scene without oil, or one whose loaded films are not to be had.
    pub fn measure(run: &Run, record: &Record<'_>) -> Result<Option<Self>, Error> {
        let Ok(Some(loaded)) = run.scene.loaded_films() else { return Ok(None) };
        let rollers: Vec<usize> = run.scene.written.rollers_in_place().collect();
        let mut floating = [Vec::new(), Vec::new()];
        let mut largest = [None; 2];
        for few in rollers.chunks(ROLLERS_AT_ONCE) {
            let wanted = |name: &str| {
                let of =
                    |r: &usize| RINGS.iter().any(|ring| name.starts_with(&format!("roller.{r}.{ring}_")));
                few.iter().any(of)
            };
            let part = record.part(0..record.len(), wanted)?;
            for (roller, side) in few.iter().flat_map(|&roller| [(roller, 0), (roller, 1)]) {
                let channel = |what: &str| part.channel(&format!("roller.{roller}.{}_{what}", RINGS[side]));
                let Some(thick) = channel("film_m") else { continue };
                let floats = |thickness: f64| thickness > (1.0 + LOADED) * loaded[side].least;
                floating[side].extend(thick.iter().copied().filter(|h| floats(*h)));
                let (Some(x), Some(y)) = (channel("fx_n"), channel("fy_n")) else { continue };
                let between = (1..thick.len()).filter(|&n| floats(thick[n - 1]) && floats(thick[n]));
                let most = between.map(|n| x[n].hypot(y[n])).reduce(f64::max);
                largest[side] = largest[side].into_iter().chain(most).reduce(f64::max);
            }
        }
        let median = |mut thick: Vec<f64>| {
            let middle = thick.len() / 2;
            (!thick.is_empty()).then(|| 1e6 * *thick.select_nth_unstable_by(middle, f64::total_cmp).1)
        };
        Ok(Some(Self {
            loaded_um: [0, 1].map(|side: usize| 1e6 * loaded[side].thickness),
            lambda: [0, 1].map(|side: usize| loaded[side].lambda),
            floating_um: floating.map(median),
            largest_n: largest,
            heat_j: run.energy.last("film_j")?,
        }))
    }
}
