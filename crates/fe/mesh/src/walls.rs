//! Cells beside the walls of grooves, in rings and in discs: their nodes move for the critical time step.

use crate::Part;
use crate::shape_optimisation::{SHARPNESS, raise_assembled_step};
use crate::smoothing::raise_critical_step_to;

/// Cells on each side of a wall, and rows below it, whose nodes may move.
pub(crate) const REACH: usize = 12;

/// Poisson's ratio for which the cells are shaped; the best shape hardly depends on it.
const POISSON: f64 = 0.3;

/// Passes of the pattern search for each layer that a groove is deep.
const SWEEPS: usize = 60;

/// Side of the squares whose time step the cells near a wall are to reach, over that of fine cells. The
/// shorter rows of thin rings and of discs have 0.9 to 0.95, and a groove need do no better.
const LENGTH: f64 = 0.95;

/// Moves the `movable` nodes of a part that was `plain` before its groove was made, for the critical step of
/// the assembled cells: fine ones have sides of `side` [m], and where cells are put into order one by one,
/// those of the length `enough` [m] need not become larger. The groove is `layers` layers deep.
pub(crate) fn shape_by_walls(
    part: &mut Part,
    plain: &Part,
    movable: &[bool],
    side: f64,
    enough: f64,
    layers: usize,
) {
    let mut ordered = part.clone();
    let optimise = |part: &mut Part, sharpness| {
        raise_assembled_step(part, plain, movable, POISSON, LENGTH * side, sharpness)
    };
    let (gentle, harsh) = SHARPNESS.split_at(1);
    if optimise(part, gentle).is_none() {
        // Rows that a deep groove or the search itself has tangled: turned back, or put into order cell by
        // cell before another search, whichever comes out better.
        let turned_back = optimise(part, harsh);
        raise_critical_step_to(enough, &mut ordered, movable, POISSON, SWEEPS * (1 + layers));
        let searched = ordered.clone();
        let again = optimise(&mut ordered, gentle);
        if turned_back.is_none() || again.is_some_and(|cost| turned_back.is_none_or(|other| cost < other)) {
            *part = if again.is_some() { ordered } else { searched };
        }
    }
}
