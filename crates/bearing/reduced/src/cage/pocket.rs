//! A roller in a pocket of the cage (THEORY §9.4).

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector, vector_starts};

use crate::{
    cage::flat::{self, Shape},
    cage::{Cage, Wall, WallRows},
    law::ContactLaw,
    plane::{Rotation, cross, dot, perpendicular},
    rollers::{
        Rollers,
        block::{Block, Walls},
    },
    row::{Rows, lanes, load, of_one},
    state::State,
    tally::Tally,
};

#[derive(Debug, Clone, Copy)]
pub(crate) struct PlacedCage {
    pub(crate) at: [f64; 2],
    pub(crate) turn: Rotation,
    pub(crate) velocity: [f64; 3],
    /// Centre of mass at the start [m].
    middle: [f64; 2],
}

/// Force and moment of a wall on a roller.
pub(crate) struct WallForce {
    pub(crate) force: [f64; 2],
    /// About the roller's centre.
    pub(crate) moment: f64,
    /// Of the same force about the cage's centre of mass.
    pub(crate) on_cage: f64,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct RollerInPocket {
    pub(crate) velocity: [f64; 2],
    pub(crate) omega: f64,
    /// Direction of its vertex 0.
    pub(crate) turned: [f64; 2],
    /// Its centre from the cage's, in space and in the frame of the cage.
    from_cage: [f64; 2],
    own: [f64; 2],
}

impl PlacedCage {
    /// In a state, when its centre of mass was in the `middle` at the start [m].
    #[inline(always)]
    pub(crate) fn of(state: &State, middle: [f64; 2]) -> Self {
        let turn = Rotation::by(state.cage[2]);
        Self { at: [state.cage[0], state.cage[1]], turn, velocity: state.cage_velocity, middle }
    }

    /// A roller with its centre at `centre`.
    #[inline(always)]
    fn roller(&self, centre: [f64; 2], velocity: [f64; 2], omega: f64, turned: [f64; 2]) -> RollerInPocket {
        let rel = [centre[0] - self.at[0] - self.middle[0], centre[1] - self.at[1] - self.middle[1]];
        let own = self.turn.back(rel);
        RollerInPocket { velocity, omega, turned, from_cage: rel, own }
    }
}

/// The foot of a roller's centre on a wall: from the centre [m], and the share of the wall's outer end.
#[derive(Debug, Clone, Copy)]
struct Foot {
    from: [f64; 2],
    share: f64,
    distance: f64,
}

impl Wall {
    /// The foot of a place, if that is nearer than `reach` and on the side of the pocket.
    #[inline(always)]
    fn foot(&self, own: [f64; 2], reach: f64) -> Option<Foot> {
        let from = [own[0] - self.inner[0], own[1] - self.inner[1]];
        let share = dot(from, self.per_length).clamp(0.0, 1.0);
        let from_foot = [from[0] - share * self.edge[0], from[1] - share * self.edge[1]];
        let square = dot(from_foot, from_foot);
        if square >= reach * reach || dot(from, self.normal) < 0.0 {
            return None;
        }
        Some(Foot { from: [-from_foot[0], -from_foot[1]], share, distance: square.sqrt() })
    }
}

/// Normal contact of a roller with a wall or a corner of it.
struct NormalContact {
    /// From the roller towards it.
    n: [f64; 2],
    /// Force [N], stiffness of the penalty [N/m], and the part of an approach that it takes.
    force: f64,
    stiffness: f64,
    part: f64,
    /// Energy [J].
    stored: f64,
    /// About the foot, on the roller [N m].
    couple: f64,
}

/// A roller whose wall was nearer than this share of its radius in a step is evaluated in the next, too, when
/// half of the work of the last force is counted.
const STILL_SEEN: f64 = 1.01;

/// Rollers in the pockets of a cage, in one step.
pub(crate) struct InPockets<'a> {
    pub(crate) cage: &'a Cage,
    pub(crate) placed: PlacedCage,
    pub(crate) rollers: &'a Rollers,
    pub(crate) law: &'a ContactLaw,
    /// Whether facets of rollers stand for arcs.
    pub(crate) round: bool,
}

impl InPockets<'_> {
    /// Forces and moments on eight rollers by the walls of their pockets, added to theirs. Returns those on
    /// the cage: two components [N] and the moment about its centre of mass [N m].
    #[inline(always)]
    pub(crate) fn push<S: Simd>(
        &self,
        simd: S,
        group: usize,
        block: &mut Block,
        tally: &mut Tally,
    ) -> [f64; 3] {
        let rows = &self.cage.wall_rows[group];
        let mut on_cage = [0.0; 3];
        for side in 0..2 {
            let near = self.near_walls(simd, &rows[side], &block.centre, &mut block.walls[side]);
            for lane in lanes(near & block.bits) {
                let (velocity, turned) = (of_one(&block.velocity, lane), of_one(&block.turned, lane));
                let centre = of_one(&block.centre, lane);
                let roller = self.placed.roller(centre, velocity, block.spin[lane], turned);
                let walls = &mut block.walls[side];
                let (mut slip, mut passive) = (walls.slip[lane], of_one(&walls.passive, lane));
                let wall = &self.cage.walls[block.first + lane][side];
                let by_wall = self.wall_force(wall, &roller, &mut slip, &mut passive, tally);
                walls.slip[lane] = slip;
                [walls.passive[0][lane], walls.passive[1][lane]] = passive;
                let Some(by_wall) = by_wall else { continue };
                block.force[2][0][lane] += by_wall.force[0];
                block.force[2][1][lane] += by_wall.force[1];
                block.moment[lane] += by_wall.moment;
                for (sum, part) in
                    on_cage.iter_mut().zip([by_wall.force[0], by_wall.force[1], by_wall.on_cage])
                {
                    *sum -= part;
                }
            }
        }
        on_cage
    }

    /// Those of eight rollers that touch one wall of their pockets each, or did so in the last step. The
    /// others let go of it.
    #[inline(always)]
    fn near_walls<S: Simd>(&self, simd: S, rows: &WallRows, centre: &Rows, walls: &mut Walls) -> u64 {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, half) = (all(0.0), all(1.0), all(0.5));
        let (top, placed) = (self.rollers.rims[0].top, &self.placed);
        let turn = placed.turn.side_by_side(simd);
        let from_cage = [all(placed.at[0] + placed.middle[0]), all(placed.at[1] + placed.middle[1])];
        let mut touch = 0;
        for at in vector_starts(simd) {
            let [x, y] = load(simd, centre, at);
            let own = turn.back([x - from_cage[0], y - from_cage[1]]);
            let (inner, edge) = (load(simd, &rows.inner, at), load(simd, &rows.edge, at));
            let (per, normal) = (load(simd, &rows.per_length, at), load(simd, &rows.normal, at));
            let from = [own[0] - inner[0], own[1] - inner[1]];
            let share = from[0].times_plus(per[0], from[1] * per[1]).max(zero).min(one);
            let foot = [from[0] - share * edge[0], from[1] - share * edge[1]];
            let square = foot[0].times_plus(foot[0], foot[1] * foot[1]);
            let within = from[0].times_plus(normal[0], from[1] * normal[1]);
            let [drag, damping] = load(simd, &walls.passive, at);
            let moved = (drag * drag).max(damping * damping);
            let reach = STILL_SEEN * top;
            // A wall that was touched in the last step is evaluated a little beyond the circle around the
            // roller, too.
            let limit = zero.choose_below(moved, all(reach * reach), all(top * top));
            let touches = square.choose_below(limit, zero.choose_below(-within, zero, one), zero);
            touch |= touches.bits() << at;
            let keep = |number: Vector<S>| half.choose_below(touches, number, zero);
            let slip = Vector::load(simd, &walls.slip, at);
            keep(slip).store(&mut walls.slip, at);
            keep(drag).store(&mut walls.passive[0], at);
            keep(damping).store(&mut walls.passive[1], at);
        }
        touch
    }

    /// A roller and a wall of its pocket.
    #[inline(always)]
    fn wall_force(
        &self,
        wall: &Wall,
        roller: &RollerInPocket,
        slip: &mut f64,
        passive: &mut [f64; 2],
        tally: &mut Tally,
    ) -> Option<WallForce> {
        let Self { cage, placed, rollers, law, round } = self;
        let top = rollers.rims[0].top;
        let Some(foot) = wall.foot(roller.own, STILL_SEEN * top) else {
            (*slip, *passive) = (0.0, [0.0; 2]);
            return None;
        };
        let RollerInPocket { velocity, omega, turned, from_cage: rel, .. } = *roller;
        let Foot { from: foot, share: t, distance } = foot;
        // From the roller's centre to the foot, in space.
        let to = [foot[0] / distance, foot[1] / distance];
        let d = placed.turn.forth(to);
        let own_d = Rotation::to(turned).back(d);
        let pressed = if t > 0.0 && t < 1.0 {
            // The foot moves along the wall with the roller, so that the force is normal to the wall.
            let shape = if *round { Shape::Circle(top) } else { Shape::Polygon(&rollers.polygon, own_d) };
            flat::press(shape, distance, law.penalty, &cage.curve).map(|on| NormalContact {
                n: d,
                force: on.force,
                stiffness: law.penalty * on.length,
                part: on.part,
                stored: on.stored,
                couple: on.force * on.lever,
            })
        } else {
            let (depth, [level, tilt]) =
                if *round { (top - distance, [1.0, 0.0]) } else { rollers.polygon.depth(own_d, distance) };
            // The normal of the roller's facet.
            let n = Rotation::to([level, tilt]).forth(d);
            let [force, stiffness, stored] = cage.corners[usize::from(t > 0.5)].press(law.penalty, depth);
            (depth > 0.0).then_some(NormalContact { n, force, stiffness, part: 1.0, stored, couple: 0.0 })
        };
        if pressed.is_none() && *passive == [0.0; 2] {
            *slip = 0.0;
            return None;
        }
        let n = pressed.as_ref().map_or(d, |pressed| pressed.n);
        // The cage's velocity at the foot.
        let arm = [rel[0] + d[0] * distance, rel[1] + d[1] * distance];
        let at_foot = [
            placed.velocity[0] - placed.velocity[2] * arm[1],
            placed.velocity[1] + placed.velocity[2] * arm[0],
        ];
        let relative = [
            velocity[0] - omega * d[1] * distance - at_foot[0],
            velocity[1] + omega * d[0] * distance - at_foot[1],
        ];
        let t = perpendicular(n);
        let (closing, sliding) = (dot(relative, n), dot(relative, t));
        tally.spent.heat[0] -= passive[0] * sliding;
        tally.spent.heat[1] += passive[1] * closing;
        let Some(NormalContact { force, stiffness, part, stored, couple, .. }) = pressed else {
            (*slip, *passive) = (0.0, [0.0; 2]);
            return None;
        };
        let damping = (law.damping / law.penalty * part * stiffness * closing).max(-force);
        let sticking = law.sticking / law.penalty * stiffness;
        let most = law.friction * force / sticking;
        *slip = (*slip + law.time_step * sliding).clamp(-most, most);
        let drag = -sticking * *slip;
        tally.spent.heat[0] -= drag * sliding;
        tally.spent.heat[1] += damping * closing;
        *passive = [drag, damping];
        tally.stored.contact += stored + 0.5 * sticking * *slip * *slip;
        tally.stored.sticking += 0.5 * sticking * *slip * *slip;
        let normal = force + damping;
        let on_roller = [drag * t[0] - normal * n[0], drag * t[1] - normal * n[1]];
        Some(WallForce {
            force: on_roller,
            moment: couple + cross([d[0] * distance, d[1] * distance], on_roller),
            on_cage: couple + cross(arm, on_roller),
        })
    }
}
