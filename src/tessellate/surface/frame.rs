//! Rows of inner vertices, strips between them, and the frame that joins them to the edges.

use super::table::Table;

/// A vertex of a piece, with its parameters there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Its number over all pieces, where it is on an edge; none for an inner one.
    pub(super) shared: Option<u32>,
    pub(super) at: [f64; 2],
    /// The axis along which its parameter is any, since it is a pole.
    pub(super) free: Option<usize>,
}

/// Parameters nearer than this, over their own size and that of the domain, are not told apart.
pub(super) const FINEST: f64 = 1e-10;

/// Ends of rows that stick out less than this are in line.
const STRAIGHT: f64 = 1e-6;

/// A vertex by its number in the piece.
pub(super) type Local = u32;

/// The four sides of a piece, each from its smaller parameter on, and what the surface asks of the rows between them.
pub(super) struct Frame<'a> {
    pub(super) table: &'a Table,
    pub(super) domain: [[f64; 2]; 2],
    /// The vertices of the sides, in no order.
    pub(super) nodes: Vec<Node>,
    /// Bottom, top, left, right.
    pub(super) sides: [Vec<Local>; 4],
    /// Whether opposite sides are one edge: left and right, bottom and top.
    pub(super) glued: [bool; 2],
    /// Length of the segments that rows are laid out for, over that of right triangles which just pass.
    pub(super) stretch: f64,
}

impl Frame<'_> {
    /// Triangles that fill the piece, counter-clockwise in the plane of u and v, and all its vertices.
    pub(super) fn fill(mut self) -> (Vec<[Local; 3]>, Vec<Node>) {
        // Rows along whichever axis takes fewer vertices.
        let along = if self.estimate(0) <= self.estimate(1) { 0 } else { 1 };
        let rows = self.rows(along);
        let [low, high, first, last] = self.sides_for(along);
        let mut triangles = Vec::new();
        if rows.is_empty() {
            self.strip(low, high, &mut triangles);
        } else {
            for pair in rows.windows(2) {
                self.strip(&pair[0], &pair[1], &mut triangles);
            }
            self.strip(low, &rows[0], &mut triangles);
            self.strip(&rows[rows.len() - 1], high, &mut triangles);
            let backward: Vec<Local> = first.iter().rev().copied().collect();
            let left: Vec<Local> = rows.iter().rev().map(|row| row[0]).collect();
            let right: Vec<Local> = rows.iter().map(|row| row[row.len() - 1]).collect();
            self.side_strip(&backward, &left, 1 - along, &mut triangles);
            self.side_strip(last, &right, 1 - along, &mut triangles);
        }
        if along == 1 {
            // Exchanging u and v has turned the triangles over.
            triangles.iter_mut().for_each(|triangle: &mut [Local; 3]| triangle.swap(1, 2));
        }
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        (triangles, self.nodes)
    }

    /// The sides as bottom, top, left and right of a plane in which rows run along the first axis.
    fn sides_for(&self, along: usize) -> [&[Local]; 4] {
        let [bottom, top, left, right] = &self.sides;
        if along == 0 { [bottom, top, left, right] } else { [left, right, bottom, top] }
    }

    /// About how many inner vertices rows along an axis need.
    pub(super) fn estimate(&self, along: usize) -> f64 {
        let across = 1 - along;
        let cells = self.table.cells[across];
        let step = self.extent(across) / cells as f64;
        (0..cells).map(|line| self.most_across(along, line) * step * self.total_along(along, line)).sum()
    }

    fn extent(&self, axis: usize) -> f64 {
        self.domain[axis][1] - self.domain[axis][0]
    }

    fn density(&self, along: usize, k: usize, line: usize, axis: usize) -> f64 {
        let [i, j] = if along == 0 { [k, line] } else { [line, k] };
        self.table.density(i, j, axis) / self.stretch
    }

    /// The largest density across the rows in a line of cells.
    fn most_across(&self, along: usize, line: usize) -> f64 {
        (0..self.table.cells[along]).map(|k| self.density(along, k, line, 1 - along)).fold(0.0, f64::max)
    }

    /// Segments along a line of cells.
    fn total_along(&self, along: usize, line: usize) -> f64 {
        let cells = self.table.cells[along];
        let step = self.extent(along) / cells as f64;
        (0..cells).map(|k| self.density(along, k, line, along) * step).sum()
    }

    /// Inner rows along an axis; none where a single strip between two opposite sides will do.
    fn rows(&mut self, along: usize) -> Vec<Vec<Local>> {
        let across = 1 - along;
        let lines = self.table.cells[across];
        let densities: Vec<f64> = (0..lines).map(|line| self.most_across(along, line)).collect();
        let step = self.extent(across) / lines as f64;
        let total: f64 = densities.iter().map(|density| density * step).sum();
        let [_, _, first, last] = self.sides_for(along);
        let single = first.len() <= 2 && last.len() <= 2;
        let least = match (single, self.glued[across]) {
            (_, true) => 3,
            (true, false) => 1,
            (false, false) => 2,
        };
        let strips = (total - 1e-9).ceil().max(f64::from(least)) as usize;
        let places = spread(&densities, self.domain[across], strips);
        let rows: Vec<(f64, Vec<f64>)> = places
            .iter()
            .enumerate()
            .map(|(index, &place)| (place, self.row(along, place, index % 2 == 0)))
            .collect();
        let mut node = |place: f64, t: f64| {
            let at = if along == 0 { [t, place] } else { [place, t] };
            self.nodes.push(Node { shared: None, at, free: None });
            self.nodes.len() as Local - 1
        };
        rows.into_iter().map(|(place, row)| row.into_iter().map(|t| node(place, t)).collect()).collect()
    }

    /// Parameters of the inner vertices of a row; every other row is moved by half a segment.
    fn row(&self, along: usize, place: f64, moved: bool) -> Vec<f64> {
        let across = 1 - along;
        let lines = self.table.cells[across];
        let [low, _] = self.domain[across];
        let line = (((place - low) / self.extent(across) * lines as f64) as usize).min(lines - 1);
        let densities: Vec<f64> =
            (0..self.table.cells[along]).map(|k| self.density(along, k, line, along)).collect();
        let total = self.total_along(along, line);
        let least = if self.glued[along] { 3 } else { 1 };
        let segments = (total - 1e-9).ceil().max(f64::from(least)) as usize;
        if moved || segments == 1 {
            // The middles of segments are every other of half segments.
            spread(&densities, self.domain[along], 2 * segments).into_iter().step_by(2).collect()
        } else {
            spread(&densities, self.domain[along], segments)
        }
    }

    /// The strip between two chains that run the same way, the second one on the left of the first.
    fn strip(&self, right: &[Local], left: &[Local], triangles: &mut Vec<[Local; 3]>) {
        let (mut i, mut j) = (0, 0);
        while i + 1 < right.len() || j + 1 < left.len() {
            let at = |local: Local| self.nodes[local as usize].at;
            let length = |a: Local, b: Local| self.table.length_squared(at(a), at(b));
            let advance_right = if i + 1 == right.len() {
                false
            } else if j + 1 == left.len() {
                true
            } else if let Some(first) = self.away_from_poles([right, left], [i, j]) {
                first
            } else {
                length(right[i + 1], left[j]) <= length(right[i], left[j + 1])
            };
            if advance_right {
                triangles.push([right[i], right[i + 1], left[j]]);
                i += 1;
            } else {
                triangles.push([right[i], left[j + 1], left[j]]);
                j += 1;
            }
        }
    }

    /// Whether the right chain must go on so that no pole at an end of one chain is over two vertices of the other, which
    /// are in line with it; `None` where either may.
    fn away_from_poles(&self, chains: [&[Local]; 2], at: [usize; 2]) -> Option<bool> {
        let is_pole = |local: Local| self.nodes[local as usize].free.is_some();
        let starts = [0, 1].map(|k: usize| is_pole(chains[k][at[k]]));
        let ends = [0, 1].map(|k: usize| at[k] + 2 == chains[k].len() && is_pole(chains[k][at[k] + 1]));
        match (starts, ends) {
            ([true, false], _) => Some(true),
            ([false, true], _) => Some(false),
            (_, [true, false]) => Some(false),
            (_, [false, true]) => Some(true),
            _ => None,
        }
    }

    /// Fills between a side and the ends of rows, which are not in line: both run along the axis, so what is between them is
    /// a monotone polygon, and every corner is cut off as soon as it sticks out (Garey, Johnson, Preparata, Tarjan,
    /// Triangulating a simple polygon, 1978).
    fn side_strip(&self, right: &[Local], left: &[Local], axis: usize, triangles: &mut Vec<[Local; 3]>) {
        if right.len() == 1 {
            // A pole: a fan, since it is over every end alike.
            return self.strip(right, left, triangles);
        }
        let at = |local: Local| self.nodes[local as usize].at;
        let upward = at(right[right.len() - 1])[axis] >= at(right[0])[axis];
        let before = |a: Local, b: Local| (at(a)[axis] <= at(b)[axis]) == upward;
        let (mut i, mut j) = (1, 0);
        // What is not yet filled, from below, each with whether it is of the right chain.
        let mut stack: Vec<(Local, bool)> = vec![(right[0], true)];
        while i < right.len() || j < left.len() {
            let ends = i + 1 == right.len() && j < left.len();
            let of_right = j == left.len() || (i < right.len() && !ends && before(right[i], left[j]));
            let new = if of_right { right[i] } else { left[j] };
            if of_right {
                i += 1;
            } else {
                j += 1;
            }
            let (top, top_of_right) = stack[stack.len() - 1];
            let closes = i == right.len() && of_right;
            if top_of_right != of_right || closes {
                // The whole other chain is in sight.
                for pair in stack.windows(2) {
                    let (a, b) = (pair[0].0, pair[1].0);
                    triangles.push(if top_of_right { [a, b, new] } else { [b, a, new] });
                }
                stack = vec![(top, top_of_right), (new, of_right)];
                continue;
            }
            while let [.., (a, _), (b, _)] = stack[..] {
                let triangle = if of_right { [a, b, new] } else { [b, a, new] };
                // Where rows run along v the plane is seen from behind.
                let [p, q, r] = settled(triangle.map(|local| self.nodes[local as usize]));
                let sticks_out = if axis == 1 {
                    turns_left([p, q, r], STRAIGHT, self.domain)
                } else {
                    turns_left([q, p, r], STRAIGHT, self.domain)
                };
                if !sticks_out {
                    break;
                }
                triangles.push(triangle);
                stack.pop();
            }
            stack.push((new, of_right));
        }
    }
}

/// The parameters of a triangle. A pole is put over or under the middle of the side opposite to it: it is the same point
/// for every parameter.
pub(super) fn settled(triangle: [Node; 3]) -> [[f64; 2]; 3] {
    let mut at = triangle.map(|node| node.at);
    for k in 0..3 {
        if let Some(axis) = triangle[k].free {
            let (a, b) = (triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
            at[k][axis] = match (a.free, b.free) {
                (Some(_), None) => b.at[axis],
                (None, Some(_)) => a.at[axis],
                _ => 0.5 * a.at[axis] + 0.5 * b.at[axis],
            };
        }
    }
    at
}

/// Whether a triangle runs counter-clockwise in the plane of parameters: by a share of what would cancel in its area, which
/// tells when it lies askew, and by more than the finest parameters over its sides, which tells when it lies along an axis.
pub(super) fn turns_left([p, q, r]: [[f64; 2]; 3], share: f64, domain: [[f64; 2]; 2]) -> bool {
    let (a, b) = ([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]]);
    let (left, right) = (a[0] * b[1], a[1] * b[0]);
    let extent = |axis: usize| a[axis].abs().max(b[axis].abs());
    let width = |axis: usize| (domain[axis][1] - domain[axis][0]).abs();
    let least = FINEST * (extent(0) * width(1) + extent(1) * width(0));
    left - right > (share * (left.abs() + right.abs())).max(least)
}

/// Inner ends of so many segments of a range, each of which holds as much of a density that is constant on equal cells.
fn spread(densities: &[f64], [low, high]: [f64; 2], segments: usize) -> Vec<f64> {
    let sum: f64 = densities.iter().sum();
    // A little everywhere, so that flat parts are divided by length.
    let floor = if sum > 0.0 { 0.02 * sum / densities.len() as f64 } else { 1.0 };
    let sum: f64 = densities.iter().map(|density| density.max(floor)).sum();
    let cell = (high - low) / densities.len() as f64;
    let mut places = Vec::with_capacity(segments.saturating_sub(1));
    let (mut before, mut k) = (0.0, 0);
    for step in 1..segments {
        let wanted = sum * step as f64 / segments as f64;
        while k + 1 < densities.len() && before + densities[k].max(floor) < wanted {
            before += densities[k].max(floor);
            k += 1;
        }
        let share = ((wanted - before) / densities[k].max(floor)).clamp(0.0, 1.0);
        places.push(low + cell * (k as f64 + share));
    }
    places
}
