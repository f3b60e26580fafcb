//! Rollers: their rims and inertia, in groups of eight with one number of each side by side, and the raceway
//! under them.

pub(crate) mod block;
mod motion;
pub(crate) mod polygon;

use crate::modal::{
    Parameters,
    parameters::{DampingFrame, RollerStart},
};

use crate::contact::outline::Outline;
use polygon::Polygon;

/// All rollers, as they do not change.
#[derive(Debug, Clone)]
pub struct Rollers {
    /// How many there are.
    pub count: usize,
    /// Mass [kg] and moment of inertia [kg m²] of each.
    pub(crate) inertia: [f64; 2],
    /// Rims: the round one first, then those that are not round.
    pub(crate) rims: Vec<Rim>,
    /// Rim of each roller, as an index of `rims`.
    pub(crate) rim_of: Vec<u32>,
    /// By how much the radius of each exceeds that of its rim [m].
    pub(crate) larger: Vec<f64>,
    /// The round rim as the cage meets it.
    pub(crate) polygon: Polygon,
    /// Places at the start, and the radius of the circle that centres are on then [m].
    pub(crate) starts: Vec<RollerStart>,
    pub(crate) path: f64,
    /// Mass damping [1/s] and the motion that it acts on.
    pub(crate) damping: f64,
    pub(crate) frame: DampingFrame,
    /// Gravity, downwards [m/s²].
    pub(crate) gravity: f64,
}

#[derive(Debug, Clone)]
pub(crate) struct Rim {
    pub(crate) outline: Outline,
    /// Radius of the circle around it [m].
    pub(crate) top: f64,
    pub(crate) is_round: bool,
}

impl Rollers {
    pub(crate) fn new(parameters: &Parameters, inertia: [f64; 2]) -> Self {
        let Parameters { outlines, radii, damping, .. } = parameters;
        let rims: Vec<Rim> = outlines.rims.iter().enumerate().map(|(n, rim)| Rim::new(rim, n == 0)).collect();
        Self {
            count: parameters.rollers.len(),
            inertia,
            polygon: Polygon::new(rims[0].outline.len(), rims[0].top),
            rims,
            larger: of_each(&outlines.larger, parameters.rollers.len()),
            rim_of: outlines.rim_of.clone(),
            starts: parameters.rollers.clone(),
            path: radii.outer - radii.roller,
            damping: damping.mass,
            frame: damping.frame,
            gravity: parameters.gravity,
        }
    }

    /// The rim of a roller, from 0.
    #[inline(always)]
    pub(crate) fn rim(&self, roller: usize) -> &Rim {
        &self.rims[self.rim_of[roller] as usize]
    }
}

/// Numbers of all rollers, of which none may be given.
fn of_each(given: &[f64], rollers: usize) -> Vec<f64> {
    (0..rollers).map(|i| given.get(i).copied().unwrap_or_default()).collect()
}

impl Rim {
    /// Of vertices from its centre [m]; the first one of a round rim lies on the x axis.
    fn new(vertices: &[[f64; 2]], round: bool) -> Self {
        let outline = Outline::new(vertices);
        let top = if round { outline.x[0] } else { outline.radii().fold(0.0, f64::max) };
        Self { outline, top, is_round: round }
    }
}
