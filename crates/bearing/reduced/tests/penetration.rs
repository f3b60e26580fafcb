//! How deep rollers sink into raceways: closed forms for arcs, and forces as the gradient of the energy for
//! polygons.

use std::f64::consts::TAU;

use pulp::{Arch, Scalar, Simd, WithSimd};
use stribeck_reduced::contact::outline::{Outline, View};
use stribeck_reduced::contact::penetration::{Pair, Penetration, Sides};
use stribeck_testing::{Noise, ledger::compare};

const ROLLER: f64 = 0.009;
const RACEWAY: f64 = 0.1;

fn polygon(radius: f64, facets: usize) -> Outline {
    let vertex = |i: usize| (TAU * i as f64 / facets as f64).sin_cos();
    Outline::new(&(0..facets).map(vertex).map(|(s, c)| [radius * c, radius * s]).collect::<Vec<_>>())
}

/// A roller in an outer raceway, its centre at (x, y), turned by an angle.
fn pressed(
    roller: &Outline,
    raceway: &Outline,
    sides: Sides,
    [x, y]: [f64; 2],
    turn: f64,
    along: [f64; 2],
) -> Penetration {
    let d = along;
    let (s, c) = turn.sin_cos();
    let own = [c * d[0] + s * d[1], c * d[1] - s * d[0]];
    let nearest = |outline: &Outline, d: [f64; 2]| {
        let angle = d[1].atan2(d[0]).rem_euclid(TAU);
        (angle / TAU * outline.len() as f64) as usize
    };
    let facet = roller.facet_along([0.0; 2], own, nearest(roller, own), 1.0);
    let under = raceway.facet_along([x, y], d, nearest(raceway, d), 1.0);
    let roller = View { outline: roller, from: [0.0; 2], d: own, facet };
    let raceway = View { outline: raceway, from: [x, y], d, facet: under };
    let mut eights = Default::default();
    let mut pair = Pair::new(Scalar::new(), roller, raceway, sides, &mut eights);
    pair.in_eights = false;
    pair.penetration(0.0, 2e-3)
}

/// Two arcs that approach by δ overlap by (4/3) δ √(2Rδ), with the relative radius R (Johnson 1985, §4.2, of
/// the gap x²/2R).
#[test]
fn analytic_arcs_overlap_by_a_segment_of_a_parabola() {
    // The parabola leaves out terms of δ/R.
    const TOLERANCE: f64 = 2e-3;
    let relative = 1.0 / ROLLER - 1.0 / RACEWAY;
    let sides = Sides { along: true, bulge: 0.5 * relative, curvature: 1.0 / ROLLER };
    let depth = 1e-5;
    let (roller, raceway) = (polygon(ROLLER, 112), polygon(RACEWAY, 1257));
    let found = pressed(&roller, &raceway, sides, [0.0, RACEWAY - ROLLER + depth], 0.3, [0.0, 1.0]);
    let half = (2.0 * depth / relative).sqrt();
    compare(
        "overlap of two arcs",
        "Johnson 1985, §4.2",
        "m²",
        found.area,
        4.0 / 3.0 * depth * half,
        TOLERANCE,
    );
    compare(
        "length of the overlap of two arcs",
        "Johnson 1985, §4.2",
        "m",
        found.length,
        2.0 * half,
        TOLERANCE,
    );
    let energy = 16.0 / 15.0 * depth * depth * half;
    compare(
        "integral of the squared overlap of two arcs",
        "Johnson 1985, §4.2",
        "m³",
        found.square,
        energy,
        TOLERANCE,
    );
    // Nothing across in the middle, but for what parabolas of one curvature leave out between vertices on a
    // circle: of u⁴/8R³ the part between the ends of a facet of the width w, at most (3u²/2R³) w²/8. Its
    // first moment over the area:
    let width = TAU * ROLLER / 112.0;
    let left_out = 1.5 * half.powi(2) / ROLLER.powi(3) * width.powi(2) / 8.0;
    let bound = left_out * half.powi(2) / (ROLLER * found.area);
    let across = found.across / found.area;
    let moment = found.moment / (ROLLER * found.area);
    assert!(across.abs() < bound && moment.abs() < bound, "{across} and {moment} of {bound}");
    assert!(bound < 1e-4, "{bound}");
}

/// ½∫p² falls by the forces along the normal, the tangent and the turn, wherever vertices lie: of chords on a
/// round raceway, and of arcs where the edge of a spall is touched far beside the middle of a coarse roller.
#[test]
fn invariant_forces_are_the_gradient_of_the_energy() {
    const TOLERANCE: f64 = 1e-5;
    let relative = 1.0 / ROLLER - 1.0 / RACEWAY;
    let chords = Sides { along: true, bulge: 0.0, curvature: 0.0 };
    let arcs = Sides { along: true, bulge: 0.5 * relative, curvature: 1.0 / ROLLER };
    let round = (polygon(ROLLER, 112), polygon(RACEWAY, 1257));
    let spalled = (polygon(ROLLER, 56), with_spall(RACEWAY, 1257, 0.05, 1.0));
    let mut noise = Noise::new(7);
    for i in 0..400 {
        let on_chords = i % 2 == 0;
        let ((roller, raceway), sides) = if on_chords { (&round, chords) } else { (&spalled, arcs) };
        let [depth, angle] = if on_chords {
            [2e-5 * (1.2 + noise.uniform()), 3.0 * noise.uniform()]
        } else {
            [7e-5 + 1e-5 * noise.uniform(), 0.25 * TAU + 0.048 + 0.004 * noise.uniform()]
        };
        let (s, c) = angle.sin_cos();
        let turn = noise.uniform();
        let path = RACEWAY - ROLLER + depth;
        let energy = |h: f64, t: f64, turn: f64| {
            let at = [(path + h) * c - t * s, (path + h) * s + t * c];
            0.5 * pressed(roller, raceway, sides, at, turn, [c, s]).square
        };
        let found = pressed(roller, raceway, sides, [path * c, path * s], turn, [c, s]);
        let step = 1e-9;
        let slope = |a: f64, b: f64, step: f64| (a - b) / (2.0 * step);
        let normal = slope(energy(step, 0.0, turn), energy(-step, 0.0, turn), step);
        let tangential = -slope(energy(0.0, step, turn), energy(0.0, -step, turn), step);
        let torque = -slope(energy(0.0, 0.0, turn + 1e-7), energy(0.0, 0.0, turn - 1e-7), 1e-7);
        let area = found.area;
        assert!(area > 0.0, "nothing overlaps at {angle}");
        assert!((normal - area).abs() < TOLERANCE * area, "normal {normal} {area}");
        assert!(
            (tangential - found.across).abs() < TOLERANCE * area,
            "tangential {tangential} {}",
            found.across
        );
        assert!(
            (torque - found.moment).abs() < TOLERANCE * ROLLER * area,
            "torque {torque} {}",
            found.moment
        );
    }
}

/// The same at the edge of a groove, with d turning as the roller goes along: the energy of a path closes.
#[test]
fn conserves_energy_along_a_path_over_an_edge() {
    let chords = Sides { along: true, bulge: 0.0, curvature: 0.0 };
    let roller = polygon(ROLLER, 112);
    // About the y axis, 0.2 mm deep, with radial walls: seen from beyond an edge its wall leans over the
    // bottom.
    let half = 0.05;
    let vertex = |radius: f64, angle: f64| [radius * angle.cos(), radius * angle.sin()];
    let [first, last] = [0.25 * TAU - half, 0.25 * TAU + half];
    let mut vertices = Vec::new();
    for i in 0..1257 {
        let [angle, next] = [f64::from(i), f64::from(i + 1)].map(|i| TAU * i / 1257.0);
        let depth = |angle: f64| if first < angle && angle < last { 2e-4 } else { 0.0 };
        vertices.push(vertex(RACEWAY + depth(angle), angle));
        for edge in [first, last].into_iter().filter(|edge| (angle..next).contains(edge)) {
            vertices.extend([angle, next].map(|side| vertex(RACEWAY + depth(side), edge)));
        }
    }
    let raceway = Outline::new(&vertices);
    let path = RACEWAY - ROLLER + 2e-5;
    let seen = |angle: f64, turn: f64| {
        let (s, c) = angle.sin_cos();
        pressed(&roller, &raceway, chords, [path * c, path * s], turn, [c, s])
    };
    // From before the edge, where it is all there, until nothing overlaps: the error of the midpoint rule is
    // left, also where the wall leans over and cuts the overlap off along d, which turns.
    const TOLERANCE: f64 = 1e-7;
    let (from, to, steps) = (1.64, 1.605, 20_000);
    let by = (to - from) / f64::from(steps);
    let rolls = -by * RACEWAY / ROLLER;
    let first = 0.5 * seen(from, 0.3).square;
    let mut work = 0.0;
    for i in 0..steps {
        let at = f64::from(i) + 0.5;
        let o = seen(from + at * by, 0.3 + at * rolls);
        work += by * path * (o.across - 0.5 * o.skew / path) + rolls * o.moment;
    }
    assert_eq!(seen(to, 0.3).square, 0.0);
    assert!((work / first - 1.0).abs() < TOLERANCE, "{work} of {first}");
}

/// A polygon with a floor 0.1 mm deep about the y axis, half as long as `half` says [rad], its edges one
/// facet long.
fn with_spall(radius: f64, facets: usize, half: f64, outwards: f64) -> Outline {
    let facet = TAU / facets as f64;
    let vertex = |i: usize| {
        let angle = facet * i as f64;
        let from_middle = (angle - 0.25 * TAU).abs();
        let at = radius + outwards * 1e-4 * ((half - from_middle) / facet).clamp(0.0, 1.0);
        [at * angle.cos(), at * angle.sin()]
    };
    Outline::new(&(0..facets).map(vertex).collect::<Vec<_>>())
}

/// Arcs over the sloped edge of a spall, on the raceway and on the roller: the energy of a path closes.
#[test]
fn conserves_energy_along_a_path_of_arcs_over_a_slope() {
    const TOLERANCE: f64 = 2e-6;
    let relative = 1.0 / ROLLER - 1.0 / RACEWAY;
    let arcs = Sides { along: true, bulge: 0.5 * relative, curvature: 1.0 / ROLLER };
    let (round, spalled) = (polygon(ROLLER, 112), with_spall(ROLLER, 112, 0.2, -1.0));
    let (raceway, pitted) = (polygon(RACEWAY, 1257), with_spall(RACEWAY, 1257, 0.05, 1.0));
    // 60 µm below the raceway: free over the floor, and at its edge touched 1 mm beside the roller's middle.
    let path = RACEWAY - ROLLER + 6e-5;
    let steps = 20_000;
    for (roller, raceway, along, rolls) in [(&round, &pitted, 0.045, -0.5), (&spalled, &raceway, 0.0, -0.17)]
    {
        let seen = |share: f64| {
            let angle = 0.25 * TAU + share * along;
            let (s, c) = angle.sin_cos();
            pressed(roller, raceway, arcs, [path * c, path * s], share * rolls, [c, s])
        };
        let mut work = 0.0;
        for i in 0..steps {
            let o = seen((f64::from(i) + 0.5) / f64::from(steps));
            work -= (along * path * (o.across - 0.5 * o.skew / path) + rolls * o.moment) / f64::from(steps);
        }
        let [first, last] = [0.0, 1.0].map(|share| 0.5 * seen(share).square);
        assert!(first == 0.0 && last > 0.0, "{first} {last}");
        assert!((work / last - 1.0).abs() < TOLERANCE, "{work} of {last}");
    }
}

/// Steep walls of a spall on the roller, which lean over the floor or over the rim as they go by: the energy
/// of a path closes.
#[test]
fn conserves_energy_along_a_path_over_walls_of_a_roller() {
    // Chords: the error of the midpoint rule, 5e-8. Arcs: 1.3e-5 are left with half of the steps as well, the
    // cause of which is not known.
    const TOLERANCE: [f64; 2] = [1e-6, 2e-5];
    let relative = 1.0 / ROLLER - 1.0 / RACEWAY;
    let chords = Sides { along: true, bulge: 0.0, curvature: 0.0 };
    let arcs = Sides { along: true, bulge: 0.5 * relative, curvature: 1.0 / ROLLER };
    // About the y axis, 0.1 mm deep; walls lean by a thousandth of their height.
    let (half, depth) = (0.2, 1e-4);
    let wall = 1e-3 * depth / ROLLER;
    let vertex = |radius: f64, angle: f64| [radius * angle.cos(), radius * angle.sin()];
    let mut vertices = Vec::new();
    for i in 0..112 {
        let [angle, next] = [f64::from(i), f64::from(i + 1)].map(|i| TAU * i / 112.0);
        let inside = |angle: f64| (angle - 0.25 * TAU).abs() < half;
        vertices.push(vertex(ROLLER - if inside(angle) { depth } else { 0.0 }, angle));
        for (edge, inwards) in [(0.25 * TAU - half, 1.0), (0.25 * TAU + half, -1.0)] {
            if (angle..next).contains(&edge) {
                let corners = [vertex(ROLLER, edge), vertex(ROLLER - depth, edge + inwards * wall)];
                let [a, b] = corners;
                vertices.extend(if inwards > 0.0 { [a, b] } else { [b, a] });
            }
        }
    }
    let (roller, raceway) = (Outline::new(&vertices), polygon(RACEWAY, 1257));
    let path = RACEWAY - ROLLER + 3e-5;
    let steps = 40_000;
    for (sides, tolerance) in [chords, arcs].into_iter().zip(TOLERANCE) {
        for rolls in [-0.4, 0.4] {
            let along = -0.05 * f64::signum(rolls);
            let seen = |share: f64| {
                let (s, c) = (0.25 * TAU + share * along).sin_cos();
                pressed(&roller, &raceway, sides, [path * c, path * s], share * rolls, [c, s])
            };
            let mut work = 0.0;
            for i in 0..steps {
                let o = seen((f64::from(i) + 0.5) / f64::from(steps));
                work -=
                    (along * path * (o.across - 0.5 * o.skew / path) + rolls * o.moment) / f64::from(steps);
            }
            let [first, last] = [0.0, 1.0].map(|share| 0.5 * seen(share).square);
            assert!(first == 0.0 && last > 0.0, "{first} {last}");
            assert!((work / last - 1.0).abs() < tolerance, "{rolls}: {work} of {last}");
        }
    }
}

/// Looks at a contact in vectors and step by step.
struct Both<'a> {
    roller: View<'a>,
    raceway: View<'a>,
    sides: Sides,
    shift: f64,
}

impl WithSimd for Both<'_> {
    type Output = Option<[Penetration; 2]>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let mut eights = Default::default();
        let pair = Pair::new(simd, self.roller, self.raceway, self.sides, &mut eights);
        let mut stepwise = pair;
        stepwise.in_eights = false;
        pair.in_eights.then(|| [pair.penetration(self.shift, 1e-3), stepwise.penetration(self.shift, 1e-3)])
    }
}

/// Eight facets in vectors make the same overlap as one after the other, on either raceway, straight or
/// round; where walls are near there are no vectors.
#[test]
fn invariant_facets_in_vectors_overlap_as_one_by_one() {
    // Lines through facets are taken at the roller's middle, 9 mm away from what overlaps by 1e-5 m: some
    // 2e-18 m of it.
    const TOLERANCE: f64 = 1e-11;
    let roller = polygon(ROLLER, 112);
    let (outer, inner) = (polygon(RACEWAY, 1257), polygon(RACEWAY - 2.0 * ROLLER, 1030));
    let pitted = with_spall(RACEWAY, 1257, 0.05, 1.0);
    let mut noise = Noise::new(3);
    let (mut seen, mut touched) = (0, 0);
    for round in 0..600 {
        let (raceway, outwards) = [(&outer, 1.0), (&inner, -1.0), (&pitted, 1.0)][round % 3];
        let depth = 1e-5 * (1.0 + noise.uniform());
        let path = RACEWAY - ROLLER + outwards * depth;
        // At and beside the edge of the spall.
        let angle = 0.25 * TAU + 0.06 * noise.uniform();
        let turn = noise.uniform();
        let from = [path * angle.cos(), path * angle.sin()];
        let d = [outwards * angle.cos(), outwards * angle.sin()];
        let (s, c) = turn.sin_cos();
        let own = [c * d[0] + s * d[1], c * d[1] - s * d[0]];
        let nearest = |outline: &Outline, [x, y]: [f64; 2]| {
            (y.atan2(x).rem_euclid(TAU) / TAU * outline.len() as f64) as usize
        };
        let facet = roller.facet_along([0.0; 2], own, nearest(&roller, own), 1.0);
        let under = raceway.facet_along(from, d, nearest(raceway, from), outwards);
        let kr = 1.0 / ROLLER;
        let relative = kr - outwards / RACEWAY;
        let sides = match round % 2 {
            0 => Sides { along: outwards > 0.0, bulge: 0.0, curvature: 0.0 },
            _ => Sides { along: outwards > 0.0, bulge: 0.5 * relative, curvature: kr },
        };
        let both = Both {
            roller: View { outline: &roller, from: [0.0; 2], d: own, facet },
            raceway: View { outline: raceway, from, d, facet: under },
            sides,
            shift: 1e-6,
        };
        let Some([vectors, stepwise]) = Arch::new().dispatch(both) else { continue };
        seen += 1;
        touched += usize::from(stepwise.area > 0.0);
        let scale = (1e-3_f64).powi(2);
        for (ours, theirs, scale) in [
            (vectors.area, stepwise.area, 1e-5 * 1e-3),
            (vectors.length, stepwise.length, 1e-3),
            (vectors.across, stepwise.across, 1e-5 * 1e-3),
            (vectors.moment, stepwise.moment, 1e-5 * scale),
            (vectors.square, stepwise.square, 1e-10 * 1e-3),
            (vectors.first, stepwise.first, scale),
            (vectors.arm, stepwise.arm, scale),
            (vectors.skew, stepwise.skew, 1e-10 * 1e-3),
            (vectors.deepest, stepwise.deepest, 1e-5),
        ] {
            assert!((ours - theirs).abs() <= TOLERANCE * scale, "round {round}: {vectors:?}, {stepwise:?}");
        }
    }
    assert!(seen > 500 && touched > 300, "{seen} seen, {touched} touched");
    // A wall overhangs the facets before it: vectors do not cover that case.
    let mut vertices: Vec<[f64; 2]> = outer.x.iter().zip(&outer.y).map(|(x, y)| [*x, *y]).collect();
    let [x, y] = vertices[314];
    vertices.insert(314, [1.001 * x, 1.001 * y]);
    let walled = Outline::new(&vertices);
    let (angle, path) = (0.25 * TAU - 2e-3, RACEWAY - ROLLER);
    let (from, d) = ([path * angle.cos(), path * angle.sin()], [angle.cos(), angle.sin()]);
    let facet = roller.facet_along([0.0; 2], d, 28, 1.0);
    let under = walled.facet_along(from, d, 314, 1.0);
    let both = Both {
        roller: View { outline: &roller, from: [0.0; 2], d, facet },
        raceway: View { outline: &walled, from, d, facet: under },
        sides: Sides { along: true, bulge: 0.0, curvature: 0.0 },
        shift: 0.0,
    };
    assert!(Arch::new().dispatch(both).is_none());
}
