//! One pass over a tile: element forces, then each finished row of nodes moves while it is still in cache
//! (THEORY §2.3; cost in PERFORMANCE.md).

use pulp::{Arch, Simd, WithSimd};

use crate::{
    advance::{Ahead, Counted, Damped, Damping, Nodes, Step, Undamped, advance_row, gain, rotate},
    ahead::{LookAhead, Seen},
    damping::LaneFrames,
    field::Field,
    gather::{congruent_elements, single_elements},
    lanes::Vector,
    model::Motion,
    strip::strip,
    threads::Met,
    tile::Tile,
};

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
}

impl TileFields<'_> {
    /// The same fields once more.
    fn again(&mut self) -> TileFields<'_> {
        let Self { x, y, vx, vy, fx, fy } = self;
        TileFields { x, y, vx, vy, fx, fy }
    }
}

/// What a worker thread may scribble on.
#[derive(Debug, Clone)]
pub(crate) struct Scratch {
    /// Forces on the nodes of the tile at hand; all zero between tiles.
    fx: Field,
    fy: Field,
    /// Where elements see the nodes; empty without stiffness damping.
    pub(crate) seen: Seen,
    /// Where this thread, the first of two, met the other.
    pub(crate) met: Met,
}

impl Scratch {
    pub(crate) fn new(slots: usize) -> Self {
        Self { fx: Field::zeros(slots), fy: Field::zeros(slots), seen: Seen::default(), met: Met::default() }
    }
}

/// What moves nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) dt: f64,
    pub(crate) gravity: [f64; 2],
    /// β of the stiffness damping [s].
    pub(crate) beta: f64,
    /// Time since damping frames were placed [s].
    pub(crate) since_placed: f64,
    /// Whether the heat of damping is counted in this step.
    pub(crate) count_heat: bool,
    /// Whether strips fetch what they read next from far caches.
    pub(crate) fetch: bool,
    /// Whether tiles are swept in the opposite order, the last ones of the step before first.
    pub(crate) back: bool,
}

/// Energies of a step [J], each from half a step before to half a step after the positions' time.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Energies {
    /// Work of prescribed motion.
    pub(crate) work: f64,
    /// Heat of damping; zero where it is not counted.
    pub(crate) heat: f64,
}

impl std::ops::Add for Energies {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { work: self.work + other.work, heat: self.heat + other.heat }
    }
}

/// Computes the forces of one tile and takes its nodes one step on.
pub(crate) fn sweep(
    tile: &Tile,
    mut fields: TileFields<'_>,
    scratch: &mut Scratch,
    drive: Drive,
) -> Energies {
    let arch = Arch::new();
    if drive.beta == 0.0 || !tile.elastic {
        return arch.dispatch(Sweep { tile, fields, scratch, drive });
    }
    let seen = &mut scratch.seen;
    let before = arch.dispatch(LookAhead { tile, fields: fields.again(), seen, drive });
    let mut energies = arch.dispatch(Sweep { tile, fields: fields.again(), scratch, drive });
    if drive.count_heat {
        energies.heat += 0.5 * drive.dt * (before + scratch.seen.power(tile.own, fields.vx, fields.vy));
    }
    energies
}

/// A sweep to be compiled for each instruction set and kind of damping.
struct Sweep<'a> {
    tile: &'a Tile,
    fields: TileFields<'a>,
    scratch: &'a mut Scratch,
    drive: Drive,
}

impl WithSimd for Sweep<'_> {
    type Output = Energies;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Energies {
        let ahead = self.drive.beta > 0.0 && self.tile.elastic;
        match (&self.tile.damping, self.drive.count_heat) {
            (None, _) if ahead => self.run::<S, Ahead<Undamped>>(simd),
            (Some(_), true) if ahead => self.run::<S, Ahead<Counted>>(simd),
            (Some(_), false) if ahead => self.run::<S, Ahead<Damped>>(simd),
            (None, _) => self.run::<S, Undamped>(simd),
            (Some(_), true) => self.run::<S, Counted>(simd),
            (Some(_), false) => self.run::<S, Damped>(simd),
        }
    }
}

impl Sweep<'_> {
    #[inline(always)]
    fn run<S: Simd, D: Damping>(self, simd: S) -> Energies {
        let Self { tile, fields, scratch, drive } = self;
        let Drive { dt, gravity, .. } = drive;
        let (rate, frames) = tile.damping.as_ref().map_or((0.0, &LaneFrames::REST), |d| (d.rate, &d.frames));
        let step = &Step::new(simd, &drive, rate, frames);
        let stiffness = &tile.stiffness.of(Vector::all(simd, 0.0));
        let TileFields { x, y, vx, vy, fx: outer_x, fy: outer_y } = fields;
        let n = tile.slots.len();
        let (fx, fy) = (&mut scratch.fx[..n], &mut scratch.fy[..n]);
        for run in &tile.loaded {
            for (force, outer) in [(&mut *fx, &mut *outer_x), (&mut *fy, &mut *outer_y)] {
                // Runs are mostly too short for a call.
                for (force, outer) in force[run.clone()].iter_mut().zip(&mut outer[run.clone()]) {
                    *force = std::mem::take(outer);
                }
            }
        }
        let (x, y, own_x, own_y) = if D::AHEAD {
            (&mut scratch.seen.x[..n], &mut scratch.seen.y[..n], x, y)
        } else {
            (x, y, &mut [][..], &mut [][..])
        };
        if tile.congruent {
            congruent_elements(simd, tile, stiffness, x, y, fx, fy);
        } else {
            single_elements(simd, tile, stiffness, x, y, fx, fy);
        }
        let mass = tile.damping.as_ref().map_or(&[][..], |d| &d.mass);
        let step_over_mass = &tile.step_over_mass;
        let mut nodes = Nodes { x, y, own_x, own_y, vx, vy, fx, fy, step_over_mass, mass };
        let mut finish = tile.finish.iter().peekable();
        let (mut work, mut heat) = (0.0, Vector::all(simd, 0.0));
        for done in 0..=tile.strips.len() {
            while let Some(f) = finish.next_if(|f| f.after == done) {
                let free = match f.motion {
                    Motion::Free => [1.0, 1.0],
                    Motion::HeldX => [0.0, 1.0],
                    Motion::HeldY => [1.0, 0.0],
                    Motion::Held => [0.0, 0.0],
                    Motion::Rotating { centre, rate } => {
                        let gain = gain(tile.damping.as_ref().map_or(0.0, |d| d.rate), dt);
                        work += rotate::<D>(&mut nodes, f.nodes.clone(), centre, rate, dt, gain, gravity);
                        continue;
                    }
                };
                advance_row::<S, D>(simd, &mut nodes, f.nodes.clone(), tile.congruent, free, step, &mut heat);
            }
            if let Some(s) = tile.strips.get(done) {
                strip::<S, D>(simd, s, &tile.varying, stiffness, &mut nodes, step, &mut heat);
            }
        }
        fx[tile.own..].fill(0.0);
        fy[tile.own..].fill(0.0);
        Energies { work, heat: step.heat(heat) }
    }
}
