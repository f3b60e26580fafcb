//! Points one by one and in vectors of every width, against contact in its plainest form.

use std::{cell::Cell, f64::consts::TAU};

use pulp::Scalar;
use stribeck_solver::{Force, state::NodeForces};

use super::*;
use crate::{Contacts, Law, Method, PairSpec, Sides, Surface};

thread_local! {
    /// Most lanes that evaluations on this thread use.
    static LANES_ASKED: Cell<usize> = const { Cell::new(LANES) };
}

/// In as many lanes as are asked for and the processor has. Kernels are compiled once for each instruction
/// set so, and not for [`pulp::Arch`] as well.
pub(super) fn dispatch(evaluation: Evaluation<'_>) -> Sum {
    #[cfg(target_arch = "x86_64")]
    match (LANES_ASKED.get(), pulp::x86::V3::try_new(), pulp::x86::V4::try_new()) {
        (8.., _, Some(avx512)) => return Simd::vectorize(avx512, evaluation),
        (4.., Some(avx2), _) => return Simd::vectorize(avx2, evaluation),
        _ => {}
    }
    evaluation.with_simd(Scalar)
}

/// A polygon that turns and bounces in an open trough of a slightly larger radius, in slots of either order.
struct Trough {
    wheel: Vec<u32>,
    trough: Vec<u32>,
}

impl Trough {
    fn new(corners: u32, vertices: u32, backwards: bool) -> Self {
        let last = corners + vertices - 1;
        let slot = |n: u32| if backwards { last - n } else { n };
        Self {
            wheel: (0..corners).map(slot).collect(),
            trough: (corners..corners + vertices).map(slot).collect(),
        }
    }

    /// Positions at a time [s].
    fn at(&self, t: f64) -> [Vec<f64>; 2] {
        let [mut x, mut y] = [(); 2].map(|()| vec![0.0; self.wheel.len() + self.trough.len()]);
        for (k, &slot) in self.wheel.iter().enumerate() {
            let (s, c) = (TAU * k as f64 / self.wheel.len() as f64 + 1.3 * t).sin_cos();
            x[slot as usize] = c + 0.02 * (5.0 * t).sin();
            y[slot as usize] = s - 0.055 + 0.02 * (31.0 * t).sin();
        }
        for (k, &slot) in self.trough.iter().enumerate() {
            // The solid lies on the left in the direction of the polyline.
            let (s, c) = (-0.2 - 2.7 * k as f64 / (self.trough.len() - 1) as f64).sin_cos();
            (x[slot as usize], y[slot as usize]) = (1.05 * c, 1.05 * s);
        }
        [x, y]
    }

    fn contacts(&self, points: usize) -> Contacts {
        let law = Law::penalty(STIFFNESS).and_then(|law| law.with_friction(FRICTION));
        let law = law.and_then(|law| law.with_damping(0.1, 1.0)).expect("a possible law");
        let [x, y] = self.at(0.0);
        let surface =
            |slots: &[u32], closed| Surface::new("", slots.to_vec(), closed, &x, &y).expect("a polyline");
        let surfaces = vec![surface(&self.wheel, true), surface(&self.trough, false)];
        let method = Method::Integrated { points };
        let pair = PairSpec { first: 0, second: 1, law, method, sides: Sides::Both };
        Contacts::new(surfaces, &[pair], THICKNESS, &x, &y).expect("a possible pair")
    }
}

/// Stiffness [Pa/m], friction, thickness [m] of the trough's law; its damping is that of `with_damping(0.1,
/// 1.0)`.
const STIFFNESS: f64 = 1e6;
const FRICTION: f64 = 0.2;
const THICKNESS: f64 = 0.02;

/// Contact in the plainest way (THEORY §4.1–4.3): at every step every point looks at every facet. It has no
/// code in common with the crate.
#[derive(Default)]
struct Plain {
    /// Slip [m] and damping force [N] of the step before, point by point.
    history: Vec<[f64; 2]>,
    stored: f64,
    friction: f64,
    damping: f64,
}

impl Plain {
    fn forces(&mut self, scene: &Trough, points: usize, at: &Moment<'_>) -> Vec<f64> {
        let n = at.x.len();
        let mut force = vec![0.0; 2 * n];
        let mut next = 0;
        self.stored = 0.0;
        let (wheel, trough) = ((&scene.wheel[..], true), (&scene.trough[..], false));
        for (own, other) in [(wheel, trough), (trough, wheel)] {
            let (slots, closed) = own;
            for f in 0..if closed { slots.len() } else { slots.len() - 1 } {
                let [a, b] = [slots[f], slots[(f + 1) % slots.len()]].map(|slot| slot as usize);
                let share = (at.x[b] - at.x[a]).hypot(at.y[b] - at.y[a]) / points as f64;
                let mut places: Vec<[f64; 2]> =
                    (0..points).map(|i| [(i as f64 + 0.5) / points as f64, share]).collect();
                // A vertex that turns by more than 0.35, and the end of an open surface, has a point of its
                // own.
                if (closed && TAU / slots.len() as f64 > 0.35) || (!closed && f == 0) {
                    places.push([0.0, 0.5 * share]);
                }
                if !closed && f + 2 == slots.len() {
                    places.push([1.0, 0.5 * share]);
                }
                for [place, weight] in places {
                    if self.history.len() == next {
                        self.history.push([0.0; 2]);
                    }
                    self.point(next, [a, b], place, weight, other, at, &mut force);
                    next += 1;
                }
            }
        }
        force
    }

    #[allow(clippy::too_many_arguments)] // a point's whole situation
    fn point(
        &mut self,
        number: usize,
        [a, b]: [usize; 2],
        place: f64,
        weight: f64,
        (slots, closed): (&[u32], bool),
        at: &Moment<'_>,
        force: &mut [f64],
    ) {
        let between = |field: &[f64], [a, b]: [usize; 2], s: f64| (1.0 - s) * field[a] + s * field[b];
        let p = [between(at.x, [a, b], place), between(at.y, [a, b], place)];
        let facets = if closed { slots.len() } else { slots.len() - 1 };
        let ends = |f: usize| [slots[f], slots[(f + 1) % slots.len()]].map(|slot| slot as usize);
        let tangent = |f: usize| {
            let [c, d] = ends(f);
            [at.x[d] - at.x[c], at.y[d] - at.y[c]]
        };
        let (mut closest, mut least) = ((0, 0.0), f64::INFINITY);
        for f in 0..facets {
            let (c, t) = (ends(f)[0], tangent(f));
            let r = [p[0] - at.x[c], p[1] - at.y[c]];
            let s = (r[0] * t[0] + r[1] * t[1]) / (t[0] * t[0] + t[1] * t[1]);
            let distance = (r[0] - s.clamp(0.0, 1.0) * t[0]).hypot(r[1] - s.clamp(0.0, 1.0) * t[1]);
            if distance < least {
                (closest, least) = ((f, s), distance);
            }
        }
        let (f, s) = closest;
        let beyond_end = !closed && ((f == 0 && s < 0.0) || (f + 1 == facets && s > 1.0));
        let foot = s.clamp(0.0, 1.0);
        let q = [between(at.x, ends(f), foot), between(at.y, ends(f), foot)];
        let normal_of = |f: usize| {
            let t = tangent(f);
            [t[1] / t[0].hypot(t[1]), -t[0] / t[0].hypot(t[1])]
        };
        // At a vertex both facets decide which side is outside.
        let mut outwards = normal_of(f);
        if foot != s && !beyond_end {
            let neighbour = normal_of(if s > 1.0 { (f + 1) % facets } else { (f + facets - 1) % facets });
            outwards = [outwards[0] + neighbour[0], outwards[1] + neighbour[1]];
        }
        let r = [p[0] - q[0], p[1] - q[1]];
        let gap = least * (r[0] * outwards[0] + r[1] * outwards[1]).signum();
        let mut normal = normal_of(f);
        if foot != s {
            normal = [r[0] / gap, r[1] / gap];
        }
        let relative = [at.vx, at.vy].map(|v| between(v, [a, b], place) - between(v, ends(f), foot));
        let mut opening = relative[0] * normal[0] + relative[1] * normal[1];
        let mut along = relative[1] * normal[0] - relative[0] * normal[1];
        let area = 0.5 * THICKNESS * weight;
        let (k, kt) = (STIFFNESS * area, 0.8 * STIFFNESS * area);
        let c = 2.0 * 0.1 * (STIFFNESS * 0.5).sqrt() * area;
        let [slip, damping] = self.history[number];
        if beyond_end || gap >= 0.0 {
            if beyond_end {
                (opening, along) = (0.0, 0.0);
            }
            self.damping -= 0.5 * damping * opening * at.dt;
            self.friction += 0.5 * kt * slip * (slip + along * at.dt);
            self.history[number] = [0.0; 2];
            return;
        }
        let kept = c / (c + k * at.dt);
        let pressure = (kept * damping - (1.0 - kept) * c * opening - k * gap).max(0.0);
        let limit = FRICTION * -gap * STIFFNESS / (0.8 * STIFFNESS);
        let new = (slip + along * at.dt).clamp(-limit, limit);
        let dashpot = pressure + k * gap;
        self.stored += 0.5 * k * gap * gap + 0.5 * kt * new * new;
        self.damping -= 0.5 * (damping + dashpot) * opening * at.dt;
        self.friction += 0.5 * kt * (slip + new) * along * at.dt - 0.5 * kt * (new * new - slip * slip);
        self.history[number] = [new, dashpot];
        let push = [pressure * normal[0] + kt * new * normal[1], pressure * normal[1] - kt * new * normal[0]];
        let [d, e] = ends(f);
        for (node, share) in [(a, 1.0 - place), (b, place), (d, foot - 1.0), (e, -foot)] {
            force[node] += share * push[0];
            force[at.x.len() + node] += share * push[1];
        }
    }
}

#[test]
fn invariant_points_act_as_in_the_plainest_contact_in_lanes_and_one_by_one() {
    let (dt, steps) = (2e-4, 600);
    for (corners, vertices, backwards) in [(40, 23, false), (37, 30, true), (12, 40, false)] {
        let scene = Trough::new(corners, vertices, backwards);
        for points in [1, 2, 3, 4, 7] {
            let mut plain = Plain::default();
            let mut singly = scene.contacts(points);
            singly.set_together(false);
            let mut found_by = vec![("one by one", LANES, singly)];
            for (name, lanes) in [("one lane", 1), ("4 lanes", 4), ("8 lanes", 8)] {
                found_by.push((name, lanes, scene.contacts(points)));
            }
            let (mut largest, mut touching) = (0.0_f64, 0);
            for step in 1..=steps {
                let time = step as f64 * dt;
                let ([x, y], [x0, y0]) = (scene.at(time), scene.at(time - dt));
                let rate = |now: &[f64], was: &[f64]| -> Vec<f64> {
                    now.iter().zip(was).map(|(a, b)| (a - b) / dt).collect()
                };
                let (vx, vy) = (rate(&x, &x0), rate(&y, &y0));
                let at = Moment { step, time, dt, x: &x, y: &y, vx: &vx, vy: &vy };
                let forces = |contacts: &mut Contacts| {
                    let mut forces = NodeForces::zeros(x.len());
                    contacts.accumulate(at, &mut forces);
                    forces.fx.iter().chain(&*forces.fy).copied().collect::<Vec<f64>>()
                };
                let expected = plain.forces(&scene, points, &at);
                let now = expected.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
                largest = largest.max(now);
                touching += usize::from(now > 0.0);
                for (name, lanes, contacts) in &mut found_by {
                    LANES_ASKED.set(*lanes);
                    let found = forces(contacts);
                    LANES_ASKED.set(LANES);
                    // Sums over hundreds of points, of gaps that are a thousandth of positions.
                    let off = found.iter().zip(&expected).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
                    assert!(
                        off <= 1e-9 * largest,
                        "{name}, {points} points, step {step}: off by {off} N of {largest} N"
                    );
                    let energy = contacts.energy();
                    for (found, expected) in [
                        (energy.stored, plain.stored),
                        (energy.friction, plain.friction),
                        (energy.damping, plain.damping),
                    ] {
                        let most = plain.stored.max(plain.friction).max(plain.damping);
                        assert!(
                            (found - expected).abs() <= 1e-9 * most,
                            "{name}, {points} points, step {step}: {found} J, not {expected} J"
                        );
                    }
                }
            }
            assert!(
                touching > steps as usize / 4 && touching < steps as usize,
                "{touching} steps in contact"
            );
        }
    }
}
