//! Energies at one time: sums over all elements and nodes, shared out over threads and taken in vectors. A
//! run asks for them at every sample.
//!
//! Sums have as many columns as [`LANES`] whatever the instruction set, and parts are added in one order, so
//! that threads and vectors change no bit.

use std::ops::{AddAssign, Range};

use pulp::{Arch, Simd, WithSimd};

use crate::{
    dynamics::{Dynamics, ElasticBody},
    element::{QuadReference, Stiffness, quad_energy, triangle_energy},
    kernel::{
        batch::{BATCH, QuadBatch, Quads},
        tile::Tile,
    },
    rigid::RigidState,
};
use stribeck_simd::{
    field::Field,
    lanes::{LANES, Number, Vector},
};

/// Elastic energy [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ElasticEnergy {
    /// Strain energy.
    pub strain: f64,
    /// Energy in the hourglass stiffness.
    pub hourglass: f64,
}

impl AddAssign for ElasticEnergy {
    fn add_assign(&mut self, other: Self) {
        self.strain += other.strain;
        self.hourglass += other.hourglass;
    }
}

/// Velocities at one time.
#[derive(Debug, Clone, Default)]
pub struct Velocities {
    vx: Field,
    vy: Field,
    rigid: Vec<RigidState>,
}

impl Dynamics {
    /// Strain and hourglass energy of the present positions [J]. As [`Dynamics::step`], to be called from
    /// within the pool.
    pub fn elastic_energy(&self) -> ElasticEnergy {
        self.elastic_energies(|_| false)[0]
    }

    /// The same, and that of some bodies, chosen by their numbers in the mesh [J].
    pub(crate) fn elastic_energies(&self, chosen: impl Fn(usize) -> bool) -> [ElasticEnergy; 2] {
        let mut parts: Vec<Part> = self.elements().bodies.iter().flat_map(Part::of).collect();
        let len = |part: &Part| part.quads.len() + part.triangles.len();
        self.share_out(&mut parts, &len, &|part| part.energy = self.energy_of(part));
        let [mut all, mut of_chosen] = [ElasticEnergy::default(); 2];
        for Part { body, energy, .. } in parts {
            all += energy;
            if chosen(body) {
                of_chosen += energy;
            }
        }
        [all, of_chosen]
    }

    fn energy_of(&self, part: &Part) -> ElasticEnergy {
        let (elements, x, y) = (self.elements(), &self.state.x[..], &self.state.y[..]);
        let quads = &elements.quads[part.quads.clone()];
        let mut energy = Arch::new().dispatch(QuadSum { quads, stiffness: &part.stiffness, x, y });
        for (c, reference) in &elements.triangles[part.triangles.clone()] {
            let c = c.map(|n| n as usize);
            energy.strain += triangle_energy(c.map(|n| x[n]), c.map(|n| y[n]), reference, &part.stiffness);
        }
        energy
    }

    /// Copies the present velocities, for [`Dynamics::kinetic_energy`].
    pub fn velocities_into(&self, to: &mut Velocities) {
        to.vx.resize(self.state.vx.len());
        to.vy.resize(self.state.vy.len());
        to.rigid.clone_from(&self.rigid);
        let fields = [(&mut to.vx, &self.state.vx), (&mut to.vy, &self.state.vy)];
        let parts = fields.into_iter().flat_map(|(to, from)| to.chunks_mut(PART).zip(from.chunks(PART)));
        let mut parts: Vec<_> = parts.collect();
        self.share_out(&mut parts, &|(_, from)| from.len(), &|(to, from)| to.copy_from_slice(from));
    }

    /// The present velocities.
    pub fn velocities(&self) -> Velocities {
        let mut velocities = Velocities::default();
        self.velocities_into(&mut velocities);
        velocities
    }

    /// Kinetic energy [J] at the positions before the last step, given the velocities before it: ½ m v⁻·v⁺,
    /// the form that a linear model conserves exactly (THEORY §2.5).
    pub fn kinetic_energy(&self, before: &Velocities) -> f64 {
        let s = &self.state;
        let elastic = 0.5
            * self.sum(
                |tile| tile.elastic,
                |slots| {
                    let [ux, uy] = [&before.vx, &before.vy].map(|v| Term::Each(&v[slots.clone()]));
                    let [vx, vy] = [&s.vx, &s.vy].map(|v| Term::Each(&v[slots.clone()]));
                    [[ux, vx], [uy, vy]]
                },
            );
        let bodies = self.rigid_bodies().iter().zip(&before.rigid).zip(&self.rigid);
        bodies.fold(elastic, |sum, ((body, before), after)| sum + body.kinetic(before, after))
    }

    /// Work of gravity [J] if every node had come from the origin: −(potential energy).
    pub fn gravity_work(&self) -> f64 {
        let [gx, gy] = self.gravity();
        if gx == 0.0 && gy == 0.0 {
            return 0.0;
        }
        let s = &self.state;
        self.sum(
            |_| true,
            |slots| {
                [[Term::Same(gx), Term::Each(&s.x[slots.clone()])], [Term::Same(gy), Term::Each(&s.y[slots])]]
            },
        )
    }

    /// Σ m (a·b) over the slots of chosen tiles; `products` gives the factors of both products.
    fn sum<'a>(
        &'a self,
        chosen: impl Fn(&Tile) -> bool,
        products: impl Fn(Range<usize>) -> [[Term<'a>; 2]; 2] + Sync,
    ) -> f64 {
        let tiles = self.tiles.iter().filter(|tile| chosen(tile));
        let mut parts: Vec<(Range<usize>, f64)> = tiles.map(|tile| (tile.slots.clone(), 0.0)).collect();
        self.share_out(&mut parts, &|(slots, _)| slots.len(), &|(slots, sum)| {
            let (mass, products) = (&self.mass()[slots.clone()], products(slots.clone()));
            *sum = Arch::new().dispatch(MassSum { mass, products });
        });
        parts.iter().map(|(_, sum)| sum).sum()
    }
}

/// Elements or slots of a part: enough that parts are few, few enough that threads end together.
const PART: usize = 4096;

/// Some elements of one body, and their energy.
struct Part {
    body: usize,
    quads: Range<usize>,
    triangles: Range<usize>,
    stiffness: Stiffness,
    energy: ElasticEnergy,
}

impl Part {
    /// All of a body: its quadrilaterals in parts, its triangles with the first.
    fn of(body: &ElasticBody) -> impl Iterator<Item = Self> {
        let ElasticBody { body, quads, triangles, stiffness } = body;
        let parts = quads.len().div_ceil(PART).max(1);
        (0..parts).map(move |i| {
            let first = (quads.start + i * PART).min(quads.end);
            Self {
                body: *body,
                quads: first..(first + PART).min(quads.end),
                triangles: if i == 0 { triangles.clone() } else { 0..0 },
                stiffness: *stiffness,
                energy: ElasticEnergy::default(),
            }
        })
    }
}

struct QuadSum<'a> {
    quads: &'a [([u32; 4], QuadReference)],
    stiffness: &'a Stiffness,
    x: &'a [f64],
    y: &'a [f64],
}

impl WithSimd for QuadSum<'_> {
    type Output = ElasticEnergy;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> ElasticEnergy {
        let Self { quads, stiffness, x, y } = self;
        let k = &stiffness.of(Vector::all(simd, 0.0));
        let mut batch = QuadBatch::EMPTY;
        let (mut strain, mut hourglass) = ([0.0; LANES], [0.0; LANES]);
        for elements in quads.chunks(BATCH) {
            batch.gather(elements, x, y);
            for at in (0..BATCH).step_by(Vector::<S>::LEN) {
                let Quads { x, y, b, s, volume } = batch.at(simd, at);
                let [of_strain, of_hourglass] = quad_energy(x, y, b, s, volume, k);
                let column = at % LANES;
                (Vector::load(simd, &strain, column) + of_strain).store(&mut strain, column);
                (Vector::load(simd, &hourglass, column) + of_hourglass).store(&mut hourglass, column);
            }
        }
        ElasticEnergy { strain: strain.iter().sum(), hourglass: hourglass.iter().sum() }
    }
}

/// A factor at each slot.
#[derive(Clone, Copy)]
enum Term<'a> {
    Each(&'a [f64]),
    Same(f64),
}

impl Term<'_> {
    #[inline(always)]
    fn one(&self, slot: usize) -> f64 {
        match self {
            Self::Each(values) => values[slot],
            Self::Same(value) => *value,
        }
    }

    #[inline(always)]
    fn vector<S: Simd>(&self, simd: S, slot: usize) -> Vector<S> {
        match self {
            Self::Each(values) => Vector::load(simd, values, slot),
            Self::Same(value) => Vector::all(simd, *value),
        }
    }
}

/// Σ m (a b + c d) over slots.
struct MassSum<'a> {
    mass: &'a [f64],
    products: [[Term<'a>; 2]; 2],
}

impl WithSimd for MassSum<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { mass, products: [[a, b], [c, d]] } = self;
        let mut columns = [0.0; LANES];
        let whole = mass.len() / LANES * LANES;
        for first in (0..LANES).step_by(Vector::<S>::LEN) {
            let mut sum = Vector::all(simd, 0.0);
            for i in (first..whole).step_by(LANES) {
                let product =
                    a.vector(simd, i).times_plus(b.vector(simd, i), c.vector(simd, i) * d.vector(simd, i));
                sum = Vector::load(simd, mass, i).times_plus(product, sum);
            }
            sum.store(&mut columns, first);
        }
        // Rigid bodies have no whole lines of slots.
        let rest = (whole..mass.len()).map(|i| mass[i] * (a.one(i) * b.one(i) + c.one(i) * d.one(i)));
        columns.into_iter().chain(rest).sum()
    }
}
