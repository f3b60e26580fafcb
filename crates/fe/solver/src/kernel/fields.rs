//! The node fields of tiles, borrowed for a step.

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
    pub(crate) branches: BranchFields<'a>,
}

/// Those of structural damping; empty where there is none.
#[derive(Default)]
pub(crate) struct BranchFields<'a> {
    /// Positions through the low-pass of the branch [m].
    pub(crate) path: [&'a mut [f64]; 2],
    /// Forces that nodes are pushed with until the next evaluation [N].
    pub(crate) held: [&'a mut [f32]; 2],
}

impl TileFields<'_> {
    /// The same fields, borrowed once more.
    pub(crate) fn again(&mut self) -> TileFields<'_> {
        let Self { x, y, vx, vy, fx, fy, branches } = self;
        TileFields { x, y, vx, vy, fx, fy, branches: branches.again() }
    }

    /// Those of the first `at` slots, and the others.
    pub(crate) fn split_at(self, at: usize) -> (Self, Self) {
        let (x, x2) = self.x.split_at_mut(at);
        let (y, y2) = self.y.split_at_mut(at);
        let (vx, vx2) = self.vx.split_at_mut(at);
        let (vy, vy2) = self.vy.split_at_mut(at);
        let (fx, fx2) = self.fx.split_at_mut(at);
        let (fy, fy2) = self.fy.split_at_mut(at);
        let (branches, others) = self.branches.split_at(at);
        let second = Self { x: x2, y: y2, vx: vx2, vy: vy2, fx: fx2, fy: fy2, branches: others };
        (Self { x, y, vx, vy, fx, fy, branches }, second)
    }
}

impl BranchFields<'_> {
    fn again(&mut self) -> BranchFields<'_> {
        fn both<'b, T>(of: &'b mut [&mut [T]; 2]) -> [&'b mut [T]; 2] {
            of.each_mut().map(|v| &mut **v)
        }
        BranchFields { path: both(&mut self.path), held: both(&mut self.held) }
    }

    fn split_at(mut self, at: usize) -> (Self, Self) {
        fn split<'b, T>(whole: &mut &'b mut [T], rest: &mut &'b mut [T], at: usize) {
            let all = std::mem::take(whole);
            (*whole, *rest) = all.split_at_mut(at.min(all.len()));
        }
        let mut rest = Self::default();
        self.path.iter_mut().zip(&mut rest.path).for_each(|(path, rest)| split(path, rest, at));
        self.held.iter_mut().zip(&mut rest.held).for_each(|(held, rest)| split(held, rest, at));
        (self, rest)
    }
}
