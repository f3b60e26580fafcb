//! Where rollers are by both raceways, the outer one moved with the modes (THEORY §9.3).

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector};

use crate::{
    bearing::Bearing,
    block::Block,
    modes::{Modes, Moved},
    row::{lanes, load, of_one, store},
    seat::Hold,
    step::Turning,
};

impl Bearing {
    /// Finds the facets of the outer raceway, which may turn, that eight rollers are by.
    #[inline(always)]
    pub(crate) fn see_raceway<S: Simd>(&self, simd: S, block: &mut Block, outer: Option<Turning>) {
        let gone = self.see_facets(simd, block, outer);
        if gone != 0 {
            self.find_facets(block, gone);
            self.see_facets(simd, block, outer);
        }
    }

    /// Finds the places of eight rollers, whose facets are known, by raceways that may turn.
    #[inline(always)]
    pub(crate) fn place_rollers<S: Simd>(
        &self,
        simd: S,
        modes: &Modes,
        hold: Option<&Hold>,
        block: &mut Block,
        [outer, inner]: [Option<Turning>; 2],
    ) {
        for lane in lanes(block.bits) {
            let (facet, share) = (block.facet[lane] as usize, block.share[lane]);
            let Moved { mut by, velocity, mut tilt } = self.moved(simd, &self.place(facet, share), modes);
            if let (Some(seat), Some(hold)) = (&self.seat, hold) {
                let [first, second] = seat.under(simd, hold, facet);
                let outwards = first + share * (second - first);
                let slope = (second - first) * self.outer.angle[facet];
                // It points outwards at every place, so that it turns along the raceway.
                let [x, y] = of_one(&block.along, lane);
                by = [by[0] + x * outwards, by[1] + y * outwards];
                tilt = [tilt[0] + x * slope - y * outwards, tilt[1] + y * slope + x * outwards];
            }
            for c in 0..2 {
                block.by[c][lane] = by[c];
                block.moving[c][lane] = velocity[c];
                block.tilt[c][lane] = tilt[c];
            }
        }
        // Where a raceway turns, everything is turned back.
        let [on_outer, on_inner] = &mut block.contacts;
        let mut at = 0;
        while at < LANES {
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
            at += Vector::<S>::LEN;
        }
    }

    /// How the rays to eight rollers go through the facets of the outer raceway that they went through last. Returns those that have
    /// gone on to another one.
    #[inline(always)]
    fn see_facets<S: Simd>(&self, simd: S, block: &mut Block, outer: Option<Turning>) -> u64 {
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        let mut still = 0;
        let mut at = 0;
        while at < LANES {
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
            at += Vector::<S>::LEN;
        }
        block.bits & !(still & block.placed)
    }

    /// Finds the facets of the outer raceway that the rays to these rollers go through.
    fn find_facets(&self, block: &mut Block, gone: u64) {
        let outline = &self.outer.outline;
        for lane in lanes(gone) {
            let along = of_one(&block.along, lane);
            let facet = outline.facet_along([0.0; 2], along, block.facet[lane] as usize, 1.0);
            block.facet[lane] = facet as u32;
            block.contacts[0].bound[lane] = self.outer.bounds[facet];
            for (end, vertex) in block.ends.iter_mut().zip([facet, outline.next(facet)]) {
                (end[0][lane], end[1][lane]) = (outline.x[vertex], outline.y[vertex]);
            }
        }
        block.placed |= gone;
    }
}
