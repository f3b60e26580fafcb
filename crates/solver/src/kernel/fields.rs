//! The node fields of tiles, borrowed for a step.

use crate::structural_damping::MAX_BRANCHES;

/// The node fields of one tile, or of several that follow each other.
#[derive(Default)]
pub(crate) struct TileFields<'a> {
    pub(crate) x: &'a mut [f64],
    pub(crate) y: &'a mut [f64],
    pub(crate) vx: &'a mut [f64],
    pub(crate) vy: &'a mut [f64],
    /// Forces from outside the elements; read and reset at loaded nodes.
    pub(crate) fx: &'a mut [f64],
    pub(crate) fy: &'a mut [f64],
    /// How far the springs of structural damping are stretched [m]; empty where there are none.
    pub(crate) stretch: [[&'a mut [f64]; 2]; MAX_BRANCHES],
}

impl TileFields<'_> {
    /// The same fields, borrowed once more.
    pub(crate) fn again(&mut self) -> TileFields<'_> {
        let Self { x, y, vx, vy, fx, fy, stretch } = self;
        let stretch = stretch.each_mut().map(|branch| branch.each_mut().map(|v| &mut **v));
        TileFields { x, y, vx, vy, fx, fy, stretch }
    }

    /// Those of the first `at` slots, and the others.
    pub(crate) fn split_at(self, at: usize) -> (Self, Self) {
        let (x, x2) = self.x.split_at_mut(at);
        let (y, y2) = self.y.split_at_mut(at);
        let (vx, vx2) = self.vx.split_at_mut(at);
        let (vy, vy2) = self.vy.split_at_mut(at);
        let (fx, fx2) = self.fx.split_at_mut(at);
        let (fy, fy2) = self.fy.split_at_mut(at);
        let mut rest: [[&mut [f64]; 2]; MAX_BRANCHES] = Default::default();
        let mut stretch = self.stretch;
        for (v, rest) in stretch.iter_mut().flatten().zip(rest.iter_mut().flatten()) {
            let all = std::mem::take(v);
            (*v, *rest) = all.split_at_mut(at.min(all.len()));
        }
        let second = Self { x: x2, y: y2, vx: vx2, vy: vy2, fx: fx2, fy: fy2, stretch: rest };
        (Self { x, y, vx, vy, fx, fy, stretch }, second)
    }
}
