//! Another spall on a raceway that is meshed already: vertices go to other places, and with them what the
//! reduction knows of each vertex, interpolated over the angle.
//!
//! What a spall of some millimetres takes from the stiffness of a ring is left as it was.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};
use stribeck_reduced::modal::{Reduction, outline::per_angle};

use crate::error::Error;

/// A spall: a floor between two walls.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spall {
    /// Whether it lies on the inner ring and turns with the shaft.
    pub inner: bool,
    /// Angle of its middle at the start [rad].
    pub angle: f64,
    /// Length along the raceway between the upper ends of its walls [m].
    pub length: f64,
    /// Depth [m].
    pub depth: f64,
    /// Angle between its walls and the raceway [rad]: a quarter of a turn for radial ones.
    pub slope: f64,
}

/// Facets on the floor and beside the spall at least.
const LEAST: usize = 2;

/// How far beyond the ends of a spall its walls may be displaced with the ring under load [m].
const ABOUT: f64 = 2e-4;

/// A raceway without its spall: what it deviates by from its circle, and where its vertices are.
struct Plain {
    /// Angles of the vertices, ascending from the first one [rad].
    angles: Vec<f64>,
    /// Radius there without the spall [m].
    radii: Vec<f64>,
}

impl Plain {
    fn of(vertices: &[[f64; 2]], spall: Option<&Spall>, outwards: f64) -> Self {
        let radii: Vec<f64> = vertices.iter().map(|[x, y]| x.hypot(*y)).collect();
        let mut sorted = radii.clone();
        sorted.sort_by(f64::total_cmp);
        let typical = sorted[sorted.len() / 2];
        let first = vertices[0][1].atan2(vertices[0][0]);
        let mut angles: Vec<f64> = Vec::with_capacity(vertices.len());
        for [x, y] in vertices {
            let before = angles.last().copied().unwrap_or(first);
            angles.push(before + turn(y.atan2(*x) - before));
        }
        let radii = match spall {
            Some(spall) => filled(&angles, &radii, typical, spall, outwards),
            None => radii,
        };
        Self { angles, radii }
    }

    /// The vertices between which an angle lies, and the share of the second.
    fn between(&self, angle: f64) -> (usize, usize, f64) {
        let n = self.angles.len();
        let first = self.angles[0];
        let seen = first + (angle - first).rem_euclid(TAU);
        let after = self.angles.partition_point(|a| *a <= seen).max(1);
        let (a, b) = (after - 1, after % n);
        let width = if b == 0 { first + TAU - self.angles[a] } else { self.angles[b] - self.angles[a] };
        (a, b, if width > 0.0 { ((seen - self.angles[a]) / width).clamp(0.0, 1.0) } else { 0.0 })
    }
}

/// Radii of a raceway with its spall filled up. A ring under load is out of round by as much as a spall is
/// deep, so that the floor is recognised by lying below the raceway on both sides of it.
fn filled(angles: &[f64], radii: &[f64], typical: f64, spall: &Spall, outwards: f64) -> Vec<f64> {
    let half = (0.5 * spall.length + ABOUT) / typical;
    let beside = |side: f64| {
        let away = angles.iter().map(|angle| side * turn(angle - spall.angle)).zip(radii);
        away.filter(|(away, _)| *away >= half).min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (Some((before, lower)), Some((behind, upper))) = (beside(-1.0), beside(1.0)) else {
        return radii.to_vec();
    };
    let level = |(angle, radius): (&f64, &f64)| {
        let at = turn(angle - spall.angle);
        let raceway = lower + (upper - lower) * (at + before) / (before + behind);
        let on_floor = at.abs() < half && outwards * (radius - raceway) > 0.5 * spall.depth;
        if on_floor { radius - outwards * spall.depth } else { *radius }
    };
    angles.iter().zip(radii).map(level).collect()
}

/// An angle between −π and π [rad].
fn turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// Angles of `n` vertices and how far each lies below its circle, counter-clockwise: even on the floor and
/// even on the rest, walls one facet each.
fn places(n: usize, first: f64, radius: f64, spall: Option<&Spall>) -> Result<Vec<[f64; 2]>, Error> {
    let Some(Spall { angle, length, depth, slope, .. }) = spall else {
        return Ok((0..n).map(|i| [first + TAU * i as f64 / n as f64, 0.0]).collect());
    };
    let half = 0.5 * length / radius;
    // A radial wall takes no angle, whatever the rounding of a tangent.
    let wall = if *slope >= 0.25 * TAU - 1e-12 { 0.0 } else { depth / (slope.tan() * radius) };
    let floor = 2.0 * (half - wall);
    if floor <= 0.0 {
        return Err(Error::Spall("its walls leave no floor. Make it longer, shallower or steeper"));
    }
    if half > 0.25 * PI {
        return Err(Error::Spall("it takes more than a quarter of the raceway. Make it shorter"));
    }
    let on_floor = ((floor / TAU * n as f64).round() as usize).max(LEAST);
    let beside = n - 2 - on_floor;
    let below = (0..=on_floor).map(|i| [angle - half + wall + floor * i as f64 / on_floor as f64, *depth]);
    let rest = TAU - 2.0 * half;
    let level = (0..=beside).map(|i| [angle + half + rest * i as f64 / beside as f64, 0.0]);
    Ok(level.chain(below).collect())
}

/// Vertices of a raceway with another spall, or none. `outwards` is 1 for the outer and −1 for the inner
/// raceway: where a spall leads.
///
/// # Errors
/// When the raceway has no room for the spall.
pub fn moved(
    vertices: &[[f64; 2]],
    was: Option<&Spall>,
    spall: Option<&Spall>,
    outwards: f64,
) -> Result<Vec<[f64; 2]>, Error> {
    Ok(Move::new(vertices, was, spall, outwards)?.vertices)
}

/// Where vertices go, and from which others each takes its numbers.
struct Move {
    vertices: Vec<[f64; 2]>,
    from: Vec<(usize, usize, f64)>,
}

impl Move {
    fn new(
        vertices: &[[f64; 2]],
        was: Option<&Spall>,
        spall: Option<&Spall>,
        outwards: f64,
    ) -> Result<Self, Error> {
        let plain = Plain::of(vertices, was, outwards);
        let mean = plain.radii.iter().sum::<f64>() / plain.radii.len() as f64;
        let places = places(vertices.len(), plain.angles[0], mean, spall)?;
        let from: Vec<_> = places.iter().map(|[angle, _]| plain.between(*angle)).collect();
        let vertices = places
            .iter()
            .zip(&from)
            .map(|([angle, depth], (a, b, share))| {
                let radius = (1.0 - share) * plain.radii[*a] + share * plain.radii[*b] + outwards * depth;
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        Ok(Self { vertices, from })
    }

    /// A table with this number of columns a vertex, at the new places.
    fn table(&self, old: &[f64]) -> Vec<f64> {
        let width = old.len() / self.from.len();
        let of = |(a, b, share): &(usize, usize, f64)| {
            let (a, b, share) = (*a * width, *b * width, *share);
            (0..width).map(move |k| (1.0 - share) * old[a + k] + share * old[b + k])
        };
        self.from.iter().flat_map(of).collect()
    }

    fn pairs(&self, old: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let of = |(a, b, share): &(usize, usize, f64)| {
            [0, 1].map(|k| (1.0 - share) * old[*a][k] + share * old[*b][k])
        };
        self.from.iter().map(of).collect()
    }
}

/// Moves the spall of the outer raceway, whose vertices as they are drawn are `outline`; gives the new ones.
///
/// # Errors
/// When the raceway has no room for the spall.
pub fn move_outer(
    reduction: &mut Reduction,
    outline: &[[f64; 2]],
    was: Option<&Spall>,
    spall: Option<&Spall>,
) -> Result<Vec<[f64; 2]>, Error> {
    let to = Move::new(outline, was, spall, 1.0)?;
    reduction.shapes = round(to.table(&reduction.shapes));
    for sensor in &mut reduction.sensors {
        sensor.residual = to.pairs(&sensor.residual);
    }
    if let Some(seat) = &mut reduction.springs {
        seat.by_rollers = round(to.table(&seat.by_rollers));
        seat.taken_back = to.table(&seat.taken_back);
        seat.flexibility = to.table(&seat.flexibility);
    }
    reduction.outer = moved(&reduction.outer, was, spall, 1.0)?;
    debug_assert_eq!(per_angle(&to.vertices).len(), outline.len());
    Ok(to.vertices)
}

/// To single precision, as the tables of a step are.
fn round(table: Vec<f64>) -> Vec<f64> {
    table.into_iter().map(|number| f64::from(number as f32)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 0.1;

    fn circle(n: usize) -> Vec<[f64; 2]> {
        (0..n)
            .map(|i| TAU * (0.3 + i as f64) / n as f64)
            .map(|a| [RADIUS * a.cos(), RADIUS * a.sin()])
            .collect()
    }

    fn spall(slope_deg: f64) -> Spall {
        Spall { inner: false, angle: 0.5 * PI, length: 0.01, depth: 2e-4, slope: slope_deg.to_radians() }
    }

    #[test]
    fn by_hand_a_spall_has_a_floor_between_two_walls() {
        let with = moved(&circle(1200), None, Some(&spall(90.0)), 1.0).expect("room");
        assert_eq!(with.len(), 1200);
        let below = |v: &&[f64; 2]| v[0].hypot(v[1]) > RADIUS + 1e-4;
        let floor: Vec<f64> = with.iter().filter(below).map(|v| v[1].atan2(v[0]) - 0.5 * PI).collect();
        let [least, most] = [f64::min, f64::max].map(|of| floor.iter().copied().fold(0.0, of));
        assert!((RADIUS * (most - least) - 0.01).abs() < 1e-12, "{least} {most}");
        assert_eq!(per_angle(&with).iter().filter(|per| **per == 0.0).count(), 2, "two walls");
    }

    #[test]
    fn roundtrip_a_spall_that_is_taken_away_leaves_the_circle() {
        let with = moved(&circle(1200), None, Some(&spall(45.0)), 1.0).expect("room");
        let without = moved(&with, Some(&spall(45.0)), None, 1.0).expect("room");
        // Chords of 0.5 mm sag by 0.3 µm; interpolated radii are those of vertices.
        assert!(without.iter().all(|v| (v[0].hypot(v[1]) - RADIUS).abs() < 1e-9));
        assert!(per_angle(&without).iter().all(|per| *per > 0.0));
    }

    /// On a ring that its load makes out of round by half the depth, half the floor was taken for raceway:
    /// where the spall had been, a pit of a tenth of a millimetre was left, and oil in it made the run
    /// diverge.
    #[test]
    fn issue_a_ring_out_of_round_keeps_no_floor_where_its_spall_was() {
        let oval = |vertices: Vec<[f64; 2]>| -> Vec<[f64; 2]> {
            let stretched = |[x, y]: [f64; 2]| {
                let share = 1.0 + 1.05e-4 / x.hypot(y) * (2.0 * y.atan2(x)).cos();
                [share * x, share * y]
            };
            vertices.into_iter().map(stretched).collect()
        };
        let with = oval(moved(&circle(1200), None, Some(&spall(90.0)), 1.0).expect("room"));
        let without = moved(&with, Some(&spall(90.0)), None, 1.0).expect("room");
        for [x, y] in without {
            let expected = RADIUS + 1.05e-4 * (2.0 * y.atan2(x)).cos();
            // Between vertices the radius is a straight line: the oval's second derivative leaves 1 nm.
            assert!((x.hypot(y) - expected).abs() < 1e-7, "{x} {y}");
        }
    }

    #[test]
    fn refuses_a_spall_without_a_floor() {
        let steep = Spall { length: 1e-4, depth: 1e-3, ..spall(20.0) };
        let refused = moved(&circle(1200), None, Some(&steep), 1.0).expect_err("no room for a floor");
        assert!(refused.to_string().contains("its walls leave no floor"), "{refused}");
    }
}
