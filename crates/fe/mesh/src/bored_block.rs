//! A block with a bore.

use crate::error::{count, elements, positive};
use crate::rows::{self, NextRow};
use crate::smoothing::sound;
use crate::{Error, Part};

/// A rectangular block about a bore around the origin, whose polygon is given: that of the ring that sits in
/// it, so that the two surfaces fit facet to facet.
///
/// The block lies between x = ±`width`/2 and y from −`base` to `top`. Rays through the nodes of the bore are
/// divided equally between bore and outline; the ray nearest to each corner ends in it. Nodes are numbered in
/// circumferential rows from the bore outwards, each row counter-clockwise. Surfaces: `bore`, closed; `base`,
/// open, from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct BoredBlock<'a> {
    /// Nodes of the bore [m], counter-clockwise.
    pub bore: &'a [[f64; 2]],
    /// Extent along x [m].
    pub width: f64,
    /// From the origin down to the base [m].
    pub base: f64,
    /// From the origin up to the top [m].
    pub top: f64,
    /// Elements between bore and outline.
    pub rows: usize,
}

const SHAPE: &str = "bored block";

/// Least material around the bore, as a part of its radius: less would be needles.
const LEAST_WALL: f64 = 0.02;

impl BoredBlock<'_> {
    /// Makes the mesh.
    ///
    /// # Errors
    /// A dimension that is not positive, fewer than 16 nodes along the bore, no rows, and an outline that
    /// comes nearer to the bore than 2 % of its radius.
    pub fn part(&self) -> Result<Part, Error> {
        positive(SHAPE, "width", self.width)?;
        positive(SHAPE, "base", self.base)?;
        positive(SHAPE, "top", self.top)?;
        let n = self.bore.len();
        count(SHAPE, "bore", n, 16, "a bore is a polygon of many nodes")?;
        count(SHAPE, "rows", self.rows, 1, "divide the wall by the element size")?;
        elements(SHAPE, "rows", self.rows, n)?;
        let radius = self.bore.iter().map(|[x, y]| libm::hypot(*x, *y)).fold(0.0, f64::max);
        let least = (1.0 + LEAST_WALL) * radius;
        for (field, value) in [("width", 0.5 * self.width), ("base", self.base), ("top", self.top)] {
            // Written so that NaN is refused too.
            let outside = value > least;
            if !outside {
                let (relation, limit) = ("more than", if field == "width" { 2.0 * least } else { least });
                let value = if field == "width" { self.width } else { value };
                let advice = "leave material around the bore";
                return Err(Error::OutOfRange { shape: SHAPE, field, value, relation, limit, advice });
            }
        }
        let outline = self.outline();
        let mut part = Part::default();
        for row in 0..=self.rows {
            let out = row as f64 / self.rows as f64;
            for ([x, y], [to_x, to_y]) in self.bore.iter().zip(&outline) {
                part.push_node(x + (to_x - x) * out, y + (to_y - y) * out);
            }
        }
        part.quads = rows::quads(0, self.rows, n, true, NextRow::Outwards);
        part.push_surface("bore", (0..n as u32).rev().collect(), true);
        let first = rows::node(self.rows, 0, n);
        // Counter-clockwise along the outline the base runs from left to right.
        let [left, right] = [[-0.5 * self.width, -self.base], [0.5 * self.width, -self.base]]
            .map(|corner| outline.iter().position(|p| *p == corner).unwrap_or(0));
        let along = (right + n - left) % n;
        let base = (0..=along).map(|i| first + ((left + i) % n) as u32).collect();
        part.push_surface("base", base, false);
        sound(SHAPE, part)
    }

    /// Where the rays through the nodes of the bore end.
    fn outline(&self) -> Vec<[f64; 2]> {
        let half = 0.5 * self.width;
        let end = |[x, y]: &[f64; 2]| {
            let across = half / x.abs();
            let along =
                if *y == 0.0 { f64::INFINITY } else { (if *y > 0.0 { self.top } else { -self.base }) / y };
            let far = across.min(along);
            // Exactly on the side that is hit.
            if across < along { [half.copysign(*x), far * y] } else { [far * x, along * y] }
        };
        let mut outline: Vec<[f64; 2]> = self.bore.iter().map(end).collect();
        for corner in [[half, self.top], [-half, self.top], [-half, -self.base], [half, -self.base]] {
            let along = |[x, y]: &[f64; 2]| (x * corner[0] + y * corner[1]) / libm::hypot(*x, *y);
            let nearest =
                (0..self.bore.len()).max_by(|&a, &b| along(&self.bore[a]).total_cmp(&along(&self.bore[b])));
            if let Some(nearest) = nearest {
                outline[nearest] = corner;
            }
        }
        outline
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stribeck_testing::assert_refused;

    fn circle(n: usize, radius: f64) -> Vec<[f64; 2]> {
        // The first node lies on the x axis, as those of rings do.
        let at = |i: usize| libm::sincos(std::f64::consts::TAU * i as f64 / n as f64);
        (0..n).map(at).map(|(s, c)| [radius * c, radius * s]).collect()
    }

    /// Source: Bronshtein and Semendyayev 2015, §3.1.4: a regular polygon has the area n/2 r² sin(2π/n).
    #[test]
    fn analytic_area_and_surfaces_of_a_bored_block() {
        let bore = circle(90, 0.1);
        let block = BoredBlock { bore: &bore, width: 0.3, base: 0.14, top: 0.12, rows: 5 };
        let part = block.part().expect("a block");
        let polygon = 0.5 * 90.0 * 0.01 * libm::sin(std::f64::consts::TAU / 90.0);
        assert!((part.area() / (0.3 * 0.26 - polygon) - 1.0).abs() < 1e-12, "{}", part.area());
        let surface = |name: &str| part.surface(name).expect("named");
        assert!(surface("bore").closed && surface("bore").facets() == 90);
        let base = &surface("base").nodes;
        assert!(base.iter().all(|&n| part.y[n as usize] == -0.14) && base.len() > 10);
        let x = |n: &u32| part.x[*n as usize];
        assert_eq!([base.first().map(x), base.last().map(x)], [Some(-0.15), Some(0.15)]);
        assert!(base.windows(2).all(|pair| x(&pair[0]) < x(&pair[1])));
    }

    #[test]
    fn refuses_an_outline_inside_the_bore() {
        let bore = circle(90, 0.1);
        for (width, base, top, field) in
            [(0.2, 0.14, 0.12, "width"), (0.3, 0.1, 0.12, "base"), (0.3, 0.14, f64::NAN, "top")]
        {
            assert_refused(BoredBlock { bore: &bore, width, base, top, rows: 5 }.part(), field);
        }
    }
}
