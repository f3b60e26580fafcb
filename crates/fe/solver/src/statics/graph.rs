//! Which nodes pull on each other, and in which order to eliminate them.

/// Neighbours of each node, ascending, without itself.
pub(super) struct Graph {
    start: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    /// Joins the nodes of every pair; pairs may repeat, and may join a node to itself.
    pub(super) fn new(nodes: usize, pairs: impl Iterator<Item = [u32; 2]> + Clone) -> Self {
        let mut end = vec![0; nodes + 1];
        let both = || pairs.clone().filter(|[a, b]| a != b).flat_map(|[a, b]| [[a, b], [b, a]]);
        for [a, _] in both() {
            end[a as usize + 1] += 1;
        }
        for i in 0..nodes {
            end[i + 1] += end[i];
        }
        let mut fill = end.clone();
        let mut all = vec![0; end[nodes]];
        for [a, b] in both() {
            all[fill[a as usize]] = b;
            fill[a as usize] += 1;
        }
        let (mut start, mut neighbours) = (vec![0], Vec::with_capacity(all.len() / 2));
        for row in end.windows(2) {
            let row = &mut all[row[0]..row[1]];
            row.sort_unstable();
            let first = neighbours.len();
            for &b in &*row {
                if neighbours.len() == first || neighbours.last() != Some(&b) {
                    neighbours.push(b);
                }
            }
            start.push(neighbours.len());
        }
        Self { start, neighbours }
    }

    pub(super) fn len(&self) -> usize {
        self.start.len() - 1
    }

    pub(super) fn of(&self, node: u32) -> &[u32] {
        &self.neighbours[self.start[node as usize]..self.start[node as usize + 1]]
    }

    /// An order of elimination with little fill: nested dissection (George 1973).
    ///
    /// A straight cut halves the nodes; those along it come last, because they alone join the halves, and
    /// each half is cut again. Of the cuts across the longest way of a part and along x and y, in the middle
    /// of it, the shortest is taken.
    pub(super) fn dissect(&self, places: &[[f64; 2]]) -> Vec<u32> {
        let n = self.len();
        let mut nodes: Vec<u32> = (0..n as u32).collect();
        let mut cutter = Cutter { graph: self, places, side: vec![Side::Elsewhere; n], right: vec![0; n] };
        cutter.order(&mut nodes);
        nodes
    }
}

/// Parts of so few nodes are not cut any more.
const SMALL: usize = 8;

/// A cut leaves at least this share on each side.
const LEAST_SHARE: f64 = 0.35;

/// Where a node is while a part is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// In no part, or in another one.
    Elsewhere,
    Left,
    Right,
}

struct Cutter<'a> {
    graph: &'a Graph,
    places: &'a [[f64; 2]],
    side: Vec<Side>,
    /// Neighbours on the right of each node on the left.
    right: Vec<u32>,
}

impl Cutter<'_> {
    /// Brings a part into order: left, right, the nodes between.
    fn order(&mut self, part: &mut [u32]) {
        if part.len() <= SMALL {
            return;
        }
        let cuts = self.directions(part).map(|d| self.shortest_cut(part, d));
        let [a, b, c] = &cuts;
        let best = [b, c].into_iter().fold(a, |best, cut| if cut.length < best.length { cut } else { best });
        part.copy_from_slice(&best.sorted);
        let (left, right) = part.split_at_mut(best.left);
        // Nodes on the left with a neighbour on the right go to the end.
        for &n in &*right {
            self.side[n as usize] = Side::Right;
        }
        let (mut inner, mut between): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        for &n in &*left {
            let touches = self.graph.of(n).iter().any(|&m| self.side[m as usize] == Side::Right);
            if touches { between.push(n) } else { inner.push(n) }
        }
        for &n in &*right {
            self.side[n as usize] = Side::Elsewhere;
        }
        let right: Vec<u32> = right.to_vec();
        part[..inner.len()].copy_from_slice(&inner);
        part[inner.len()..inner.len() + right.len()].copy_from_slice(&right);
        part[inner.len() + right.len()..].copy_from_slice(&between);
        let (left, rest) = part.split_at_mut(inner.len());
        self.order(left);
        self.order(&mut rest[..right.len()]);
    }

    /// Normals of the cuts to try: the longest principal axis, x and y.
    fn directions(&self, part: &[u32]) -> [[f64; 2]; 3] {
        let places = || part.iter().map(|&n| self.places[n as usize]);
        let share = 1.0 / part.len() as f64;
        let centre = places().fold([0.0; 2], |c, p| [c[0] + share * p[0], c[1] + share * p[1]]);
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        for p in places() {
            let (x, y) = (p[0] - centre[0], p[1] - centre[1]);
            (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        }
        let (sin, cos) = libm::sincos(0.5 * libm::atan2(2.0 * xy, xx - yy));
        [[cos, sin], [1.0, 0.0], [0.0, 1.0]]
    }

    /// Moves nodes from right to left, one by one, and remembers when the fewest of the left touch the right.
    fn shortest_cut(&mut self, part: &[u32], normal: [f64; 2]) -> Cut {
        let along = |n: u32| {
            let [x, y] = self.places[n as usize];
            normal[0] * x + normal[1] * y
        };
        let mut sorted: Vec<(f64, u32)> = part.iter().map(|&n| (along(n), n)).collect();
        sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let sorted: Vec<u32> = sorted.into_iter().map(|(_, n)| n).collect();
        for &n in &sorted {
            self.side[n as usize] = Side::Right;
        }
        let middle = sorted.len() / 2;
        let least = (LEAST_SHARE * sorted.len() as f64) as usize;
        let (mut length, mut best) = (0, (usize::MAX, usize::MAX, middle));
        for (i, &n) in sorted.iter().enumerate() {
            self.side[n as usize] = Side::Left;
            self.right[n as usize] = 0;
            for &m in self.graph.of(n) {
                match self.side[m as usize] {
                    Side::Elsewhere => {}
                    Side::Right => self.right[n as usize] += 1,
                    Side::Left => {
                        self.right[m as usize] -= 1;
                        length -= usize::from(self.right[m as usize] == 0);
                    }
                }
            }
            length += usize::from(self.right[n as usize] > 0);
            let left = i + 1;
            if (least..=sorted.len() - least).contains(&left) {
                best = best.min((length, left.abs_diff(middle), left));
            }
        }
        for &n in &sorted {
            self.side[n as usize] = Side::Elsewhere;
        }
        Cut { sorted, left: best.2, length: best.0 }
    }
}

/// A part along one direction, and where to cut it.
struct Cut {
    sorted: Vec<u32>,
    /// Nodes before the cut, those along it included.
    left: usize,
    /// Nodes along the cut.
    length: usize,
}
