//! Positions of rollers relative to both raceways, the outer one displaced by the modes (THEORY §9.3).

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{
    bearing::Bearing,
    drive::RingRotation,
    modes::Modes,
    rollers::block::Block,
    row::{Row, lanes, largest_sum, load, of_one, store},
    seat::SeatState,
};

impl Bearing {
    /// Finds the facets of the outer raceway, which may turn, that eight rollers are by.
    #[inline(always)]
    pub(crate) fn follow_facets<S: Simd>(&self, simd: S, block: &mut Block, outer: Option<RingRotation>) {
        let gone = self.test_facets(simd, block, outer);
        if gone != 0 {
            self.find_facets(block, gone);
            self.test_facets(simd, block, outer);
        }
    }

    /// How far a vertex of the outer raceway moves at most in a step [m].
    #[inline(always)]
    fn farthest<S: Simd>(&self, simd: S, modes: &Modes, hold: Option<&SeatState>) -> f64 {
        let with_modes = self.time_step * largest_sum(simd, &self.structure.farthest, &modes.v);
        match (&self.seat, hold) {
            (Some(seat), Some(hold)) => with_modes + seat.farthest(simd, hold),
            _ => with_modes,
        }
    }

    /// Finds the places of all rollers, whose facets are known, by raceways that may turn.
    #[inline(always)]
    pub(crate) fn locate_on_raceways<S: Simd>(
        &self,
        simd: S,
        modes: &Modes,
        hold: Option<&SeatState>,
        blocks: &mut [Block],
        turning: [Option<RingRotation>; 2],
    ) {
        let rigid = self.structure.rigidly_moved(simd, modes).filter(|_| hold.is_none());
        let farthest = self.farthest(simd, modes, hold);
        for block in blocks {
            match rigid {
                Some(moved) => {
                    for (row, moved) in block.moved.iter_mut().zip(moved) {
                        *row = Row([moved; LANES]);
                    }
                }
                None => self.look_under(simd, modes, hold, farthest, block, turning[0]),
            }
            self.raceway_motion(simd, block);
            Self::see(simd, block, turning);
        }
    }

    /// Looks up how the outer raceway, which may turn, moves under eight rollers. None of its vertices has
    /// moved by more than `farthest` [m] in this step.
    #[inline(always)]
    fn look_under<S: Simd>(
        &self,
        simd: S,
        modes: &Modes,
        hold: Option<&SeatState>,
        farthest: f64,
        block: &mut Block,
        outer: Option<RingRotation>,
    ) {
        let clear = self.clear_of_raceway(simd, farthest, block, outer);
        for lane in lanes(block.bits & !clear) {
            let (facet, share) = (block.facet[lane] as usize, block.share[lane]);
            let parts_of_motion = &mut block.parts_of_motion[lane];
            let moved = self.structure.moved(simd, &self.structure.raceway_point(facet, share), modes);
            for (parts, to) in moved.into_iter().zip(&mut parts_of_motion[..]) {
                parts.store(to, 0);
            }
            if let (Some(seat), Some(hold)) = (&self.seat, hold) {
                for (parts, to) in seat.under(simd, hold, facet).into_iter().zip(&mut parts_of_motion[6..]) {
                    parts.store(to, 0);
                }
            }
        }
        block.sum_motion(simd);
    }

    /// Eight rollers in the frames of the raceways: where one turns, everything is turned back.
    #[inline(always)]
    fn see<S: Simd>(simd: S, block: &mut Block, [outer, inner]: [Option<RingRotation>; 2]) {
        let [on_outer, on_inner] = &mut block.contacts;
        for at in vector_starts(simd) {
            let (centre, spin) = (load(simd, &block.centre, at), load(simd, &block.turned, at));
            let by = load(simd, &block.by, at);
            let moved = [centre[0] - by[0], centre[1] - by[1]];
            let turnings = [outer, inner];
            for ((contacts, turning), centre) in
                [&mut *on_outer, &mut *on_inner].into_iter().zip(turnings).zip([moved, centre])
            {
                let Some(turning) = turning else {
                    store(centre, &mut contacts.centre, at);
                    store(spin, &mut contacts.spin, at);
                    continue;
                };
                store(turning.back(simd, centre), &mut contacts.centre, at);
                store(turning.back(simd, spin), &mut contacts.spin, at);
            }
        }
    }

    /// Rollers that cannot touch the outer raceway, wherever it has moved since they were looked at: where it
    /// is under them need not be known (THEORY §9.3).
    #[inline(always)]
    fn clear_of_raceway<S: Simd>(
        &self,
        simd: S,
        farthest: f64,
        block: &mut Block,
        outer: Option<RingRotation>,
    ) -> u64 {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, one, dt) = (all(0.0), all(1.0), all(self.time_step));
        let race = all(outer.map_or(0.0, |outer| outer.rate.abs()));
        let mut clear = 0;
        for at in vector_starts(simd) {
            let [vx, vy] = load(simd, &block.velocity, at);
            let [tx, ty] = load(simd, &block.tilt, at);
            let speed = vx.times_plus(vx, vy * vy).sqrt();
            let steep = tx.times_plus(tx, ty * ty).sqrt();
            // Both vertices move, and by as much the slope between them may change while the roller goes
            // along.
            let along = dt * (speed / Vector::load(simd, &block.distance, at) + race);
            let further = steep.times_plus(along, all(3.0 * farthest));
            let drift = Vector::load(simd, &block.drift, at) + further;
            let most = Vector::load(simd, &block.contacts[0].most, at);
            let is_clear = (speed.times_plus(dt, drift) + most).choose_below(zero, one, zero);
            all(0.5).choose_below(is_clear, drift, zero).store(&mut block.drift, at);
            clear |= is_clear.bits() << at;
        }
        if self.oil.is_some() { 0 } else { clear }
    }

    /// Motion of the outer raceway under eight rollers, by modes and seat.
    #[inline(always)]
    fn raceway_motion<S: Simd>(&self, simd: S, block: &mut Block) {
        for at in vector_starts(simd) {
            let of = |row: &Row| Vector::load(simd, row, at);
            let [bx, by, vx, vy, dx, dy, first, second] = &block.moved;
            let (share, per_angle) = (of(&block.share), of(&block.per_angle));
            let further = of(second) - of(first);
            let outwards = share.times_plus(further, of(first));
            let slope = further * per_angle;
            // It points outwards at every place, so that it turns along the raceway.
            let [x, y] = load(simd, &block.along, at);
            let by = [x.times_plus(outwards, of(bx)), y.times_plus(outwards, of(by))];
            let tilt = [
                of(dx).times_plus(per_angle, x.times_plus(slope, -(y * outwards))),
                of(dy).times_plus(per_angle, y.times_plus(slope, x * outwards)),
            ];
            let moving = [of(vx), of(vy)];
            store(by, &mut block.by, at);
            store(tilt, &mut block.tilt, at);
            store(moving, &mut block.moving, at);
        }
    }

    /// Intersects the rays to eight rollers with the facets of the outer raceway that they crossed last.
    /// Returns those that have moved on to another facet.
    #[inline(always)]
    fn test_facets<S: Simd>(&self, simd: S, block: &mut Block, outer: Option<RingRotation>) -> u64 {
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        let mut still = 0;
        for at in vector_starts(simd) {
            let [x, y] = load(simd, &block.centre, at);
            let distance = x.times_plus(x, y * y).sqrt();
            let radial = [x / distance, y / distance];
            let along = match outer {
                Some(outer) => outer.back(simd, radial),
                None => radial,
            };
            distance.store(&mut block.distance, at);
            store(radial, &mut block.radial, at);
            store(along, &mut block.along, at);
            let [dx, dy] = along;
            let [[ax, ay], [bx, by]] = [load(simd, &block.ends[0], at), load(simd, &block.ends[1], at)];
            let (a, b) = (dx.times_plus(ay, -(dy * ax)), dx.times_plus(by, -(dy * bx)));
            let holds = zero.choose_below(a, zero, zero.choose_below(b, one, zero));
            let share = (a / (a - b)).max(zero).min(one);
            a.choose_below(b, share, zero).store(&mut block.share, at);
            still |= holds.bits() << at;
        }
        block.bits & !(still & block.placed)
    }

    /// Finds the facets of the outer raceway that the rays to these rollers go through.
    fn find_facets(&self, block: &mut Block, gone: u64) {
        let outer = &self.raceways[0];
        let outline = &outer.outline;
        for lane in lanes(gone) {
            let along = of_one(&block.along, lane);
            let facet = outline.facet_along([0.0; 2], along, block.facet[lane] as usize, 1.0);
            block.facet[lane] = facet as u32;
            block.per_angle[lane] = outer.angle[facet];
            block.drift[lane] = f64::INFINITY;
            block.contacts[0].bound[lane] = outer.bounds[facet];
            for (end, vertex) in block.ends.iter_mut().zip([facet, outline.next(facet)]) {
                (end[0][lane], end[1][lane]) = (outline.x[vertex], outline.y[vertex]);
            }
        }
        block.placed |= gone;
    }
}
