//! Distances to other parameters than a triangle's own.
//!
//! A flat triangle L is off the surface S at the same parameters p by D = L(p) - S(p). The part of D along the tangent
//! plane is no distance: S(p + d) with S_u d_u + S_v d_v equal to that part is nearer to L(p), off by no more than the part
//! of D along the normal and half the second derivative by d twice. That is a bound from the mesh to the surface. It is one
//! from the surface to the mesh as well if p -> p + d covers the whole domain, which it does when it is continuous and takes
//! every side of the domain to itself (by Brouwer's theorem on the degree of maps). So d_u is scaled by a number that falls
//! from 1 to 0 within the length of a step of the sides of smallest and largest u, d_v by one for the other sides, and both
//! near cells where the tangent plane may be any. What comes near the first two sides is bounded by the part of D that steps
//! along v do not make up for, and so on; what comes near a corner or such a cell, by the whole of D.

use crate::surface::{Across, Cone};

/// The ratio of D to the tolerance up to which steps are provided for; triangles beyond it fail.
pub(super) const MOST: f64 = 4.0;
/// Longest steps, over the width of a cell: they lead no farther than to the next one.
const LONGEST: f64 = 0.25;

/// Which steps are made without being scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Free {
    Both,
    /// Those along an axis.
    Along(usize),
    None,
}

/// What of a cell's bends is across the surface, over the tolerance.
#[derive(Clone, Copy)]
pub(super) struct Turned {
    /// The normal and the tangents.
    cones: [Cone; 3],
    /// One over the least sine of the angle between the tangents.
    skew: f64,
    /// How far a step leads that makes up for one tolerance along the surface.
    steps: [f64; 2],
}

impl Turned {
    pub(super) fn new(across: &Across, tolerance: f64) -> Turned {
        let Across { normal, tangents: [along_u, along_v], sine, speeds } = *across;
        let over = |cone: Cone| Cone { bounds: cone.bounds.map(|bound| bound / tolerance), ..cone };
        let steps = speeds.map(|speed| tolerance / speed);
        Turned { cones: [normal, along_u, along_v].map(over), skew: 1.0 / sine, steps }
    }

    /// Bounds of what steps do not make up for, from those of lengths.
    pub(super) fn bends(&self, free: Free, lengths: [f64; 3]) -> [f64; 3] {
        combined(std::iter::once((self, lengths)), free).unwrap_or(lengths)
    }
}

/// Bounds of what steps do not make up for, from some cells with their lengths: along any normal of them, or at a right angle
/// to any of their tangents. The part of D that steps along v leave is the one at right angles to S_v over the sine of the
/// angle between the tangents, or less.
fn combined<'a>(cells: impl Iterator<Item = (&'a Turned, [f64; 3])> + Clone, free: Free) -> Option<[f64; 3]> {
    let which = match free {
        Free::Both => 0,
        Free::Along(axis) => 1 + axis,
        Free::None => return None,
    };
    let first = cells.clone().next()?.0.cones[which].direction;
    let (mut most, mut longest, mut spread, mut skew) = ([0.0_f64; 3], [0.0_f64; 3], 0.0_f64, 1.0_f64);
    for (turned, lengths) in cells {
        let cone = &turned.cones[which];
        let apart = (cone.direction - first).length();
        spread = spread.max(cone.spread + apart);
        skew = if which == 0 { 1.0 } else { skew.max(turned.skew) };
        for k in 0..3 {
            most[k] = most[k].max(cone.bounds[k] + apart * lengths[k]);
            longest[k] = longest[k].max(lengths[k]);
        }
    }
    Some([0, 1, 2].map(|k: usize| ((most[k] + spread * longest[k]) * skew).min(longest[k])))
}

/// Where steps may be made, and what they cost.
#[derive(Default)]
pub(super) struct Slides {
    domain: [[f64; 2]; 2],
    cells: [usize; 2],
    turned: Vec<Option<Turned>>,
    /// The longest step along u and along v.
    border: [f64; 2],
    /// Whether a triangle in the cell is far from the border whatever its place.
    inner: Vec<bool>,
    /// What steps for a ratio of 1 cost, from the cell itself or one beside it.
    costs: Vec<f64>,
}

impl Slides {
    pub(super) fn new(
        domain: [[f64; 2]; 2],
        cells: [usize; 2],
        mut turned: Vec<Option<Turned>>,
        lengths: &[[f64; 3]],
        tolerances: &[f64],
    ) -> Slides {
        let widths = [0, 1].map(|axis: usize| (domain[axis][1] - domain[axis][0]) / cells[axis] as f64);
        for cell in &mut turned {
            *cell = cell.filter(|t| (0..2).all(|axis| MOST * t.steps[axis] <= LONGEST * widths[axis]));
        }
        let longest = |axis: usize| turned.iter().flatten().map(|t| MOST * t.steps[axis]).fold(0.0, f64::max);
        let border = [longest(0), longest(1)];
        let mut slides = Slides { domain, cells, turned, border, inner: Vec::new(), costs: Vec::new() };
        for cell in 0..cells[0] * cells[1] {
            let (i, j) = (cell / cells[1], cell % cells[1]);
            let is_within = 0 < i && i + 1 < cells[0] && 0 < j && j + 1 < cells[1];
            let around = || slides.around(i, j);
            let is_inner = is_within && around().all(|near| slides.turned[near].is_some());
            // Tolerances may differ from cell to cell: a step is as long as the largest asks, a bend as strong as the least.
            let tolerance = |pick: fn(f64, f64) -> f64| around().map(|near| tolerances[near]).reduce(pick);
            let ratio = tolerance(f64::max).unwrap_or(1.0) / tolerance(f64::min).unwrap_or(1.0);
            let most = |f: &dyn Fn(usize) -> f64| around().map(f).fold(0.0, f64::max);
            let step = [0, 1].map(|axis: usize| {
                ratio * most(&|near| slides.turned[near].map_or(0.0, |turned| turned.steps[axis]))
            });
            let [uu, uv, vv] =
                [0, 1, 2].map(|k: usize| most(&|near| slides.turned[near].map_or(0.0, |_| lengths[near][k])));
            slides.inner.push(is_inner);
            slides
                .costs
                .push(0.5 * (uu * step[0] * step[0] + 2.0 * uv * step[0] * step[1] + vv * step[1] * step[1]));
        }
        slides
    }

    /// A cell and those around it.
    fn around(&self, i: usize, j: usize) -> impl Iterator<Item = usize> + use<> {
        let [height, width] = self.cells;
        let range = |k: usize, count: usize| k.saturating_sub(1)..(k + 2).min(count);
        let columns = range(j, width);
        range(i, height).flat_map(move |i| columns.clone().map(move |j| i * width + j))
    }

    /// Bounds of what steps of triangles in a cell do not make up for, whose lengths these are: on the sides of the domain
    /// those of uu count in whole beside the first two, those of vv beside the others.
    pub(super) fn bends_of(&self, cell: usize, lengths: [f64; 3]) -> [f64; 3] {
        let Some(turned) = self.turned[cell] else { return lengths };
        let at = [cell / self.cells[1], cell % self.cells[1]];
        let mut bends = turned.bends(Free::Both, lengths);
        for axis in [0, 1] {
            if at[axis] == 0 || at[axis] + 1 == self.cells[axis] {
                let beside = turned.bends(Free::Along(1 - axis), lengths);
                bends[2 * axis] = beside[2 * axis];
            }
        }
        bends
    }

    /// What steps cost around some cells, for a ratio of D to the tolerance.
    pub(super) fn cost(&self, cells: impl Iterator<Item = usize>, ratio: f64) -> f64 {
        ratio * ratio * cells.map(|cell| self.costs[cell]).fold(0.0, f64::max)
    }

    /// Which steps are free where the box of a triangle is, which meets these cells.
    pub(super) fn free(&self, part: [[f64; 2]; 2], met: [[usize; 2]; 2]) -> Free {
        let [[i0, i1], [j0, j1]] = met;
        let width = self.cells[1];
        if (i0..=i1).all(|i| (j0..=j1).all(|j| self.inner[i * width + j])) {
            return Free::Both;
        }
        let wide = [0, 1].map(|axis: usize| {
            let [low, high] = self.domain[axis];
            let (cell, count) = ((high - low) / self.cells[axis] as f64, self.cells[axis]);
            let [from, to] = [part[axis][0] - self.border[axis], part[axis][1] + self.border[axis]];
            let index = |t: f64| (((t - low) / cell).max(0.0) as usize).min(count - 1);
            (from >= low && to <= high, [index(from), index(to)])
        });
        let [(far_u, [i0, i1]), (far_v, [j0, j1])] = wide;
        if !(i0..=i1).all(|i| (j0..=j1).all(|j| self.turned[i * width + j].is_some())) {
            return Free::None;
        }
        match (far_u, far_v) {
            (true, true) => Free::Both,
            (false, true) => Free::Along(1),
            (true, false) => Free::Along(0),
            (false, false) => Free::None,
        }
    }

    /// Bounds of what free steps do not make up for in some cells.
    pub(super) fn bends(
        &self,
        free: Free,
        cells: impl Iterator<Item = usize> + Clone,
        lengths: &[[f64; 3]],
    ) -> Option<[f64; 3]> {
        if !cells.clone().all(|cell| self.turned[cell].is_some()) {
            return None;
        }
        combined(cells.filter_map(|cell| Some((self.turned[cell].as_ref()?, lengths[cell]))), free)
    }
}
