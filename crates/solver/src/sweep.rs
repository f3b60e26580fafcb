//! One pass over a tile: element forces, then each finished row of nodes moves while it is still in cache
//! (THEORY §2.3; cost in PERFORMANCE.md).

use multiversion::multiversion;

use crate::{
    advance::{Damping, Step, Summed, advance, rotate},
    gather::{congruent_quads, congruent_triangles, single_elements},
    model::Motion,
    strip::{Corners, Nodes, strip},
    tile::Tile,
};

/// The node fields of one tile.
pub(crate) struct TileFields<'a> {
    pub(crate) x: &'a mut [f64],
    pub(crate) y: &'a mut [f64],
    pub(crate) vx: &'a mut [f64],
    pub(crate) vy: &'a mut [f64],
    /// Forces from outside the elements; read and reset at loaded nodes.
    pub(crate) fx: &'a mut [f64],
    pub(crate) fy: &'a mut [f64],
}

/// What a worker thread may scribble on.
#[derive(Debug, Clone)]
pub(crate) struct Scratch {
    /// Forces on the nodes of the tile at hand; all zero between tiles.
    fx: Vec<f64>,
    fy: Vec<f64>,
    corners: Box<Corners>,
}

impl Scratch {
    pub(crate) fn new(slots: usize) -> Self {
        Self { fx: vec![0.0; slots], fy: vec![0.0; slots], corners: Box::new([[[[0.0; _]; 2]; 2]; 2]) }
    }
}

/// What moves nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) dt: f64,
    pub(crate) gravity: [f64; 2],
}

/// What a sweep counts [J], each from half a step before to half a step after the positions' time.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counted {
    /// Work of prescribed motion.
    pub(crate) work: f64,
    /// Heat of mass damping.
    pub(crate) heat: f64,
}

impl std::ops::Add for Counted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { work: self.work + other.work, heat: self.heat + other.heat }
    }
}

/// Computes the forces of one tile and takes its nodes one step on.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw+avx512cd+avx2+bmi2", "x86_64+avx2+bmi2"))]
pub(crate) fn sweep(tile: &Tile, fields: TileFields<'_>, scratch: &mut Scratch, drive: Drive) -> Counted {
    let TileFields { x, y, vx, vy, fx: outer_x, fy: outer_y } = fields;
    let n = tile.slots.len();
    let (fx, fy) = (&mut scratch.fx[..n], &mut scratch.fy[..n]);
    for &node in &tile.loaded {
        let node = node as usize;
        fx[node] = outer_x[node];
        fy[node] = outer_y[node];
        outer_x[node] = 0.0;
        outer_y[node] = 0.0;
    }
    if tile.congruent {
        congruent_quads(tile, x, y, fx, fy);
        congruent_triangles(tile, x, y, fx, fy);
    } else {
        single_elements(tile, x, y, fx, fy);
    }
    let Drive { dt, gravity } = drive;
    let damping = tile.damping.as_ref();
    let step = Step {
        dt,
        fall: [dt * gravity[0], dt * gravity[1]],
        free: [1.0, 1.0],
        damping: damping.map(|d| Damping::new(d.rate, &d.frames, dt)),
    };
    let mass = damping.map_or(&[][..], |d| &d.mass);
    let mut nodes = Nodes { x, y, vx, vy, fx, fy, step_over_mass: &tile.step_over_mass, mass };
    let mut finish = tile.finish.iter().peekable();
    let mut counted = Counted::default();
    for done in 0..=tile.strips.len() {
        while let Some(f) = finish.next_if(|f| f.after == done) {
            let (row, [fx, fy]) = nodes.split(f.nodes.start, f.nodes.len());
            let forces = Summed { fx, fy };
            let free = match f.motion {
                Motion::Free => [1.0, 1.0],
                Motion::HeldX => [0.0, 1.0],
                Motion::HeldY => [1.0, 0.0],
                Motion::Held => [0.0, 0.0],
                Motion::Rotating { centre, rate } => {
                    counted.work += rotate(row, forces, centre, rate, dt, gravity);
                    continue;
                }
            };
            counted.heat += advance(row, forces, &Step { free, ..step });
        }
        if let Some(s) = tile.strips.get(done) {
            counted.heat += strip(s, &tile.varying, &tile.stiffness, &mut nodes, &mut scratch.corners, &step);
        }
    }
    fx[tile.own..].fill(0.0);
    fy[tile.own..].fill(0.0);
    counted
}
