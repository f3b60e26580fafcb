//! Grooves in the inner or the outer surface of an annulus.

use std::f64::consts::TAU;

use crate::error::{MOST, finite, positive};
use crate::polar_grid::{Circle, Place, PolarGrid};
use crate::smoothing::inside_out;
use crate::walls::{REACH, shape_by_walls};
use crate::{Error, Part};

/// A groove: a floor between two walls, cut into the inner or the outer surface of an annulus.
///
/// No element is removed, so the rows stay strips: of two neighbouring nodes of the surface one stands on its
/// circle and one on the floor, at the same angle where walls are radial, and the facet between them is the
/// wall. The `facets` of the annulus count the walls too. Away from the walls, facets are equally long on the
/// floor, and equally long on the rest of the surface. Columns at some distance from the groove are radial
/// and equally wide, so that the cells of a row are alike there, and the facets of the other surface are some
/// per cent shorter behind the groove than elsewhere; in rings that have no room for that the other surface
/// stays as it is. The rows below follow smoothly, so that the assembled elements keep nine tenths of the
/// critical time step of squares, short grooves four fifths and deep ones two thirds (THEORY §2.4).
///
/// Several grooves of a surface lie [`Groove::APART`] facets apart, and those of an annulus all in one
/// surface. Between two of them facets are equally long.
///
/// Errors: a length or depth that is not positive, a depth of more than 60 % of the thickness, a length that
/// leaves less than a quarter of the surface or more floor than facets, walls that leave no floor or are
/// wider than [`Groove::WIDEST_WALL`] facets, grooves too near to each other or in both surfaces, and a
/// groove so deep or a layer so thick that some element stays inside out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// Angle of the middle of the groove [rad].
    pub centre_angle: f64,
    /// Arc length between the upper ends of the walls, measured on the circle [m].
    pub length: f64,
    /// Height of the walls [m].
    pub depth: f64,
    /// Angle between walls and circle [rad]: a quarter of a turn for radial ones.
    pub slope: f64,
    /// The circle that it is cut into.
    pub circle: Circle,
}

impl Groove {
    /// Widest wall, in facets: each is one facet.
    pub const WIDEST_WALL: f64 = 2.0;

    /// Facets between two grooves of a surface, at least.
    pub const APART: usize = 10;

    /// With radial walls, in the inner surface.
    pub const fn rectangular(centre_angle: f64, length: f64, depth: f64) -> Self {
        Self { centre_angle, length, depth, slope: 0.25 * TAU, circle: Circle::Inner }
    }

    /// Angle that a wall takes on a circle of the radius `radius` [rad].
    fn wall(&self, radius: f64) -> f64 {
        // A radial wall takes none, whatever the rounding of a tangent.
        if self.slope == 0.25 * TAU { 0.0 } else { self.depth / (libm::tan(self.slope) * radius) }
    }
}

const SHAPE: &str = "groove";

/// Passes of Gauss–Seidel that spread the displacement of the inner row.
const SPREAD: usize = 100;

/// Columns beside the groove that are not radial, in thicknesses of the annulus: what the groove displaces
/// has faded by a factor of 500 there.
const FADES: usize = 2;

/// Fewer radial columns are not worth moving the outer surface for.
const LEAST_RADIAL: usize = 32;

/// The circle that grooves are cut into; `None` without any.
pub(crate) fn circle_of(grooves: &[Groove]) -> Result<Option<Circle>, Error> {
    let Some(first) = grooves.first() else { return Ok(None) };
    if grooves.iter().any(|groove| groove.circle != first.circle) {
        let advice = "cut all of them into one surface";
        return Err(Error::Conflict { shape: SHAPE, field: "circle", other: "circle of the first", advice });
    }
    Ok(Some(first.circle))
}

/// Cuts grooves into an annulus by moving its nodes. The first of them are those of the grooves' surface,
/// `places` has one entry per node, and where cells are put into order one by one, those of the length
/// `enough` [m] need not become larger; `None` leaves all cells as they fall.
pub(crate) fn cut(
    grid: &PolarGrid,
    grooves: &[Groove],
    places: &[Place],
    enough: Option<f64>,
    part: &mut Part,
) -> Result<(), Error> {
    let Some(circle) = circle_of(grooves)? else { return Ok(()) };
    let layers = grid.layers;
    let (grid, places) = match circle {
        Circle::Inner => (grid, places.to_vec()),
        Circle::Outer => {
            let from_outside = |p: &Place| Place { row: layers as f64 - p.row, ..*p };
            (&grid.seen_from_outside(), places.iter().map(from_outside).collect())
        }
    };
    let places = &places[..];
    let plan = Plan::new(grid, grooves)?;
    let n = grid.facets;
    let plain = part.clone();
    let (angle, radius) = spread(&plan, n, layers);
    for (at, place) in places.iter().enumerate() {
        let (sin, cos) = libm::sincos(grid.column_angle(place.column) + between_rows(&angle, n, *place));
        let r = grid.row_radius(place.row) + between_rows(&radius, n, *place);
        (part.x[at], part.y[at]) = (r * cos, r * sin);
    }
    plan.place_walls(grid, part);
    let Some(enough) = enough else { return Ok(()) };
    for cut in &plan.cuts {
        shape(grid, cut, places, enough, &plain, part);
    }
    match inside_out(part) {
        None => Ok(()),
        Some((element, area)) => {
            let advice = "make the groove shallower, or use more `facets` or other `layers`";
            Err(Error::Tangled { shape: "groove", element, area, advice })
        }
    }
}

/// Moves nodes near the walls of a groove for the critical step of the assembled cells there.
fn shape(grid: &PolarGrid, cut: &Cut, places: &[Place], enough: f64, plain: &Part, part: &mut Part) {
    let movable = cut.movable(grid, places);
    let side = grid.layer().min(grid.inner_facet());
    shape_by_walls(part, plain, &movable, side, enough, (cut.groove.depth / grid.layer()) as usize);
}

/// Where the nodes of the inner row go.
struct Plan {
    /// The grooves, counter-clockwise.
    cuts: Vec<Cut>,
    /// Angular displacement of each inner node [rad], and its rise onto the floor [m].
    angle: Vec<f64>,
    rise: Vec<f64>,
    /// Angular displacement of each outer node [rad].
    back: Vec<f64>,
    /// Columns that are not radial.
    bent: Vec<usize>,
}

/// A groove with the columns that it takes.
struct Cut {
    groove: Groove,
    /// Angle between the walls [rad].
    sector: f64,
    /// Columns before the upper node of the first (clockwise) wall from the start of the grid, which may lie
    /// before it.
    from: f64,
    /// The same column within the grid.
    first: usize,
    /// Facets of the floor.
    floor: usize,
    /// Columns on each side of a wall whose nodes the search may move.
    columns: usize,
}

impl Cut {
    fn new(grid: &PolarGrid, groove: &Groove) -> Result<Self, Error> {
        let n = grid.facets;
        let sector = check(grid, groove)?;
        let flat = sector - 2.0 * groove.wall(grid.inner_radius);
        let floor = ((n as f64 * flat / TAU).round() as usize).max(2);
        // The columns are chosen so that the middle of the groove moves by less than half a facet.
        let from = (Self::middle(grid, groove) - 0.5 * (floor + 2) as f64).round();
        let first = from.rem_euclid(n as f64) as usize % n;
        // A groove of several layers disturbs as many columns as it is deep.
        let columns = REACH + (groove.depth / grid.inner_facet()).ceil() as usize;
        Ok(Self { groove: *groove, sector, from, first, floor, columns })
    }

    /// Place of the middle in columns.
    fn middle(grid: &PolarGrid, groove: &Groove) -> f64 {
        (groove.centre_angle - grid.start_angle) * grid.facets as f64 / TAU
    }

    /// Columns of the upper node of the first wall, its lower node, and those of the second wall.
    fn walls(&self) -> [usize; 4] {
        [self.first, self.first + 1, self.first + 1 + self.floor, self.first + 2 + self.floor]
    }

    /// Facets and angle [rad] between its end and the next one of the `n` facets around.
    fn gap(&self, next: &Self, n: usize) -> (usize, f64) {
        let facets = (next.first + 2 * n - self.walls()[3]) % n;
        let apart = (next.groove.centre_angle - self.groove.centre_angle).rem_euclid(TAU);
        // A single groove is its own neighbour.
        let apart = if apart == 0.0 { TAU } else { apart };
        (facets, apart - 0.5 * (self.sector + next.sector))
    }

    /// Interior nodes near the walls.
    fn movable(&self, grid: &PolarGrid, places: &[Place]) -> Vec<bool> {
        let (n, layers) = (grid.facets, grid.layers);
        let rows = REACH + (self.groove.depth / grid.layer()).ceil() as usize;
        let [first, _, second, _] = self.walls();
        let near_wall = |column: usize, wall: usize| {
            let right = (column + 2 * n - wall % n) % n;
            right < self.columns + 2 || n - right <= self.columns
        };
        let movable = |p: &Place| {
            let inside = p.row > 0.0 && p.row < layers as f64 && p.row <= rows as f64;
            inside && [first, second].iter().any(|wall| near_wall(p.column, *wall))
        };
        places.iter().map(movable).collect()
    }
}

impl Plan {
    fn new(grid: &PolarGrid, grooves: &[Groove]) -> Result<Plan, Error> {
        let n = grid.facets;
        let mut cuts = grooves.iter().map(|groove| Cut::new(grid, groove)).collect::<Result<Vec<_>, _>>()?;
        cuts.sort_by_key(|cut| cut.first);
        let inwards = if grid.inner_radius < grid.outer_radius { 1.0 } else { -1.0 };
        // Walls, floors and at least a few facets elsewhere share the inner surface.
        let taken: usize = cuts.iter().map(|cut| cut.floor + 2).sum();
        if taken + 4 > n {
            let advice = "use more facets or a shorter groove";
            let (shape, field) = ("annulus with a groove", "facets");
            return Err(Error::Count { shape, field, value: n, least: taken + 4, most: MOST, advice });
        }
        let (mut angle, mut rise) = (vec![0.0; n], vec![0.0; n]);
        let nexts = cuts.iter().cycle().skip(1);
        let gaps: Vec<(usize, f64)> = cuts.iter().zip(nexts).map(|(cut, next)| cut.gap(next, n)).collect();
        let around = taken + gaps.iter().map(|(rest, _)| rest).sum::<usize>();
        if cuts.len() > 1 && (around != n || gaps.iter().any(|(rest, _)| *rest < Groove::APART)) {
            let (field, other) = ("centre_angle", "centre_angle of another one");
            let advice = "ten facets lie between two grooves";
            return Err(Error::Conflict { shape: SHAPE, field, other, advice });
        }
        for (cut, &(rest, free)) in cuts.iter().zip(&gaps) {
            let (sector, floor) = (cut.sector, cut.floor);
            let flat = sector - 2.0 * cut.groove.wall(grid.inner_radius);
            let middle = Cut::middle(grid, &cut.groove);
            for m in 0..floor + 2 + rest {
                let target = if m == 0 {
                    -0.5 * sector
                } else if m <= floor + 1 {
                    -0.5 * flat + flat * (m - 1) as f64 / floor as f64
                } else {
                    0.5 * sector + free * (m - 2 - floor) as f64 / rest as f64
                };
                let uniform = TAU * (cut.from + m as f64 - middle) / n as f64;
                angle[(cut.first + m) % n] = target - uniform;
                let deep = (1..=floor + 1).contains(&m);
                rise[(cut.first + m) % n] = if deep { inwards * cut.groove.depth } else { 0.0 };
            }
        }
        let thickness = ((grid.outer_radius - grid.inner_radius).abs() / grid.inner_facet()).ceil() as usize;
        let beside = |cut: &Cut| (FADES * thickness).max(cut.columns + 3);
        // Where two grooves leave enough room for radial columns between them.
        let room: Vec<bool> = (0..cuts.len())
            .map(|k| gaps[k].0 > beside(&cuts[k]) + beside(&cuts[(k + 1) % cuts.len()]) + 2 + LEAST_RADIAL)
            .collect();
        let Some(last) = room.iter().position(|room| *room) else {
            let (back, bent) = (vec![0.0; n], (0..n).collect());
            return Ok(Plan { cuts, angle, rise, back, bent });
        };
        let (mut back, mut bent) = (angle.clone(), Vec::new());
        // Bent columns of the grooves since the last gap with radial columns: where they begin, and how many.
        let mut begun = None;
        for k in (1..=cuts.len()).map(|k| (last + k) % cuts.len()) {
            let cut = &cuts[k];
            let (from, count) = begun.unwrap_or((cut.first + n - beside(cut), beside(cut)));
            let count = count + cut.floor + 2;
            if !room[k] {
                begun = Some((from, count + gaps[k].0));
                continue;
            }
            begun = None;
            let count = count + beside(cut);
            let column = |m: usize| (from + m) % n;
            let (a, b) = (angle[column(0)], angle[column(count)]);
            for m in 1..count {
                back[column(m)] = a + (b - a) * m as f64 / count as f64;
            }
            bent.extend((1..count).map(column));
        }
        Ok(Plan { cuts, angle, rise, back, bent })
    }

    /// Writes the wall nodes out, so that no rounding tilts a wall.
    fn place_walls(&self, grid: &PolarGrid, part: &mut Part) {
        let inwards = if grid.inner_radius < grid.outer_radius { 1.0 } else { -1.0 };
        for cut in &self.cuts {
            let groove = &cut.groove;
            let half = 0.5 * groove.length / grid.inner_radius;
            let (top, bottom) = (grid.inner_radius, grid.inner_radius + inwards * groove.depth);
            let (a, b) = (groove.centre_angle - half, groove.centre_angle + half);
            let wall = groove.wall(grid.inner_radius);
            let places = [(a, top), (a + wall, bottom), (b - wall, bottom), (b, top)];
            for (column, (angle, radius)) in cut.walls().into_iter().zip(places) {
                let (sin, cos) = libm::sincos(angle);
                let at = column % grid.facets;
                (part.x[at], part.y[at]) = (radius * cos, radius * sin);
            }
        }
    }
}

/// A field of whole rows at a place that may lie between two of them.
fn between_rows(field: &[f64], n: usize, place: Place) -> f64 {
    let row = place.row as usize;
    let (part, here) = (place.row - row as f64, row * n + place.column);
    if part == 0.0 { field[here] } else { (1.0 - part) * field[here] + part * field[here + n] }
}

/// Displacement of all nodes (angle [rad], radius [m]): given on the inner and the outer row, the same along
/// radial columns, and harmonic where they are bent, which keeps it smooth and between its extremes.
fn spread(plan: &Plan, n: usize, layers: usize) -> (Vec<f64>, Vec<f64>) {
    let start = |inner: &[f64], outer: &[f64]| -> Vec<f64> {
        let between = |i: usize| {
            let (a, b) = (inner[i % n], outer[i % n]);
            a + (b - a) * ((i / n) as f64 / layers as f64)
        };
        (0..n * (layers + 1)).map(between).collect()
    };
    let (mut angle, mut radius) = (start(&plan.angle, &plan.back), start(&plan.rise, &vec![0.0; n]));
    for _ in 0..SPREAD {
        for row in 1..layers {
            for &column in &plan.bent {
                let (here, left, right) =
                    (row * n + column, row * n + (column + n - 1) % n, row * n + (column + 1) % n);
                for field in [&mut angle, &mut radius] {
                    field[here] = 0.25 * (field[left] + field[right] + field[here - n] + field[here + n]);
                }
            }
        }
    }
    (angle, radius)
}

/// Refuses what cannot be cut; gives the angle between the walls [rad].
fn check(grid: &PolarGrid, groove: &Groove) -> Result<f64, Error> {
    finite(SHAPE, "centre_angle", groove.centre_angle)?;
    positive(SHAPE, "length", groove.length)?;
    positive(SHAPE, "depth", groove.depth)?;
    let refuse = |field, value, limit, advice| {
        Err(Error::OutOfRange { shape: SHAPE, field, value, relation: "at most", limit, advice })
    };
    let limit = 0.75 * TAU * grid.inner_radius;
    if groove.length > limit {
        return refuse("length", groove.length, limit, "a quarter of the surface must remain");
    }
    // A little more, because 60 % of a difference of radii is rounded.
    let limit = 0.6 * (1.0 + 1e-9) * (grid.outer_radius - grid.inner_radius).abs();
    if groove.depth > limit {
        return refuse("depth", groove.depth, limit, "keep it below 60 % of the thickness");
    }
    let sector = groove.length / grid.inner_radius;
    if !(groove.slope > 0.0 && groove.slope <= 0.25 * TAU) {
        let (field, value, limit) = ("slope", groove.slope, 0.25 * TAU);
        let (relation, advice) = ("above 0, at most", "walls stand on the floor at 90° or less");
        return Err(Error::OutOfRange { shape: SHAPE, field, value, relation, limit, advice });
    }
    let wall = groove.wall(grid.inner_radius);
    let widest = (Groove::WIDEST_WALL * TAU / grid.facets as f64).min(0.4 * sector);
    if wall > widest {
        let least = libm::atan(groove.depth / (widest * grid.inner_radius));
        let (field, value, relation) = ("slope", groove.slope, "at least");
        let advice = "make the walls steeper, the groove shallower or longer";
        return Err(Error::OutOfRange { shape: SHAPE, field, value, relation, limit: least, advice });
    }
    Ok(sector)
}
