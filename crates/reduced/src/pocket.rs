//! A roller in a pocket of the cage (THEORY §9.4).

use crate::{
    bearing::{Bearing, Cage, Wall},
    state::Stored,
};

/// Where the cage is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlacedCage {
    pub(crate) at: [f64; 2],
    pub(crate) turn: [f64; 2],
    pub(crate) velocity: [f64; 3],
}

/// What a wall does to a roller.
pub(crate) struct Hit {
    pub(crate) force: [f64; 2],
    /// About the roller's centre.
    pub(crate) moment: f64,
    /// Of the same force about the cage's centre of mass.
    pub(crate) on_cage: f64,
}

/// A roller at its pocket.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Guest {
    pub(crate) velocity: [f64; 2],
    pub(crate) omega: f64,
    /// Direction of its vertex 0.
    pub(crate) turned: [f64; 2],
    /// Its centre from the cage's, in space and in the frame of the cage.
    from_cage: [f64; 2],
    own: [f64; 2],
}

impl PlacedCage {
    /// A roller with its centre at `centre`; `middle` is where the cage's centre of mass was at the start.
    #[inline(always)]
    pub(crate) fn guest(
        &self,
        middle: [f64; 2],
        centre: [f64; 2],
        velocity: [f64; 2],
        omega: f64,
        turned: [f64; 2],
    ) -> Guest {
        let [c, s] = self.turn;
        let rel = [centre[0] - self.at[0] - middle[0], centre[1] - self.at[1] - middle[1]];
        let own = [c * rel[0] + s * rel[1], c * rel[1] - s * rel[0]];
        Guest { velocity, omega, turned, from_cage: rel, own }
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
        let share = from[0] * self.per_length[0] + from[1] * self.per_length[1];
        let share = share.clamp(0.0, 1.0);
        let from_foot = [from[0] - share * self.edge[0], from[1] - share * self.edge[1]];
        let square = from_foot[0] * from_foot[0] + from_foot[1] * from_foot[1];
        if square >= reach * reach || from[0] * self.normal[0] + from[1] * self.normal[1] < 0.0 {
            return None;
        }
        Some(Foot { from: [-from_foot[0], -from_foot[1]], share, distance: square.sqrt() })
    }
}

/// A roller whose wall was nearer than this share of its radius in a step is still seen in the next, when half of the work of the last
/// force is counted.
const STILL_SEEN: f64 = 1.01;

impl Bearing {
    /// A roller and a wall of its pocket.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one contact, with all that it reads and adds to")]
    pub(crate) fn hit(
        &self,
        cage: &Cage,
        wall: &Wall,
        placed: PlacedCage,
        guest: &Guest,
        slip: &mut f64,
        passive: &mut [f64; 2],
        heat: &mut [f64; 2],
        energy: &mut Stored,
    ) -> Option<Hit> {
        let Some(foot) = wall.foot(guest.own, STILL_SEEN * self.rims[0].top) else {
            (*slip, *passive) = (0.0, [0.0; 2]);
            return None;
        };
        let [c, s] = placed.turn;
        let Guest { velocity, omega, turned, from_cage: rel, .. } = *guest;
        let Foot { from: foot, share: t, distance } = foot;
        // From the roller's centre to the foot, in space.
        let to = [foot[0] / distance, foot[1] / distance];
        let d = [c * to[0] - s * to[1], s * to[0] + c * to[1]];
        let own_d = [turned[0] * d[0] + turned[1] * d[1], turned[0] * d[1] - turned[1] * d[0]];
        let (depth, tilt) = self.rims[0].outline.depth(own_d, distance);
        let parted = depth <= 0.0;
        if parted && *passive == [0.0; 2] {
            *slip = 0.0;
            return None;
        }
        let depth = depth.max(0.0);
        let level = (1.0 - tilt * tilt).sqrt();
        let (n, [force, stiffness, stored], couple) = if t > 0.0 && t < 1.0 {
            // Flat against round: the parabola on the penalty. The foot goes along the wall with the roller, so that the force stands on
            // the wall, and that the facet leans from it by an angle of sine `tilt` turns roller and cage against each other.
            let reach = (2.0 * self.arm * depth).sqrt();
            let force = self.penalty * depth * reach * (4.0 / 3.0);
            (d, [level * force, self.penalty * 2.0 * reach, 0.4 * force * depth], -force * distance * tilt)
        } else {
            // The normal of the roller's facet.
            let n = [level * d[0] - tilt * d[1], level * d[1] + tilt * d[0]];
            (n, self.corner(cage, cage.wedges[usize::from(t > 0.5)], depth), 0.0)
        };
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
        let closing = relative[0] * n[0] + relative[1] * n[1];
        let t = [-n[1], n[0]];
        let sliding = relative[0] * t[0] + relative[1] * t[1];
        heat[0] -= passive[0] * sliding;
        heat[1] += passive[1] * closing;
        if parted {
            (*slip, *passive) = (0.0, [0.0; 2]);
            return None;
        }
        let damping = (self.damping / self.penalty * stiffness * closing).max(-force);
        let sticking = self.sticking / self.penalty * stiffness;
        let most = self.friction * force / sticking;
        *slip = (*slip + self.time_step * sliding).clamp(-most, most);
        let drag = -sticking * *slip;
        heat[0] -= drag * sliding;
        heat[1] += damping * closing;
        *passive = [drag, damping];
        energy.contact += stored + 0.5 * sticking * *slip * *slip;
        energy.sticking += 0.5 * sticking * *slip * *slip;
        let normal = force + damping;
        let on_roller = [drag * t[0] - normal * n[0], drag * t[1] - normal * n[1]];
        let cross = |r: [f64; 2]| r[0] * on_roller[1] - r[1] * on_roller[0];
        Some(Hit {
            force: on_roller,
            moment: couple + cross([d[0] * distance, d[1] * distance]),
            on_cage: couple + cross(arm),
        })
    }

    /// Force, stiffness and stored energy of a corner of the cage that is `depth` deep in a facet: its own points, and those of the
    /// roller in the `wedge` that it cuts from the facet. They hang on the depth alone, whose gradient is the facet's normal.
    #[inline(always)]
    fn corner(&self, cage: &Cage, wedge: f64, depth: f64) -> [f64; 3] {
        let own = 0.5 * self.penalty * cage.corner;
        let others = 0.25 * self.penalty * wedge * depth * depth;
        [
            own * depth + others,
            own + 0.5 * self.penalty * wedge * depth,
            depth * (0.5 * own * depth + others / 3.0),
        ]
    }
}
