//! Distances to other parameters than a triangle's own.
//!
//! A flat triangle L is off the surface S at the same parameters p by D = L(p) - S(p). The part of D along the tangent
//! plane is no distance: S(p + d) with S_u d_u + S_v d_v equal to that part is nearer to L(p), off by no more than the part
//! of D along the normal and half the second derivative by d twice. That is a bound from the mesh to the surface. It is one
//! from the surface to the mesh as well if p -> p + d covers the whole domain, which it does when it is continuous and keeps
//! the border (by Brouwer's theorem on the degree of maps). So d is scaled by a number that falls from 1 to 0 within the
//! length of a step of the border, and of cells where the tangent plane may be any; triangles that come so near are bounded
//! by the whole of D and the second derivative.

use crate::math::Vec3;
use crate::surface::Across;

/// The ratio of D to the tolerance up to which steps are provided for; triangles beyond it fail.
pub(super) const MOST: f64 = 4.0;
/// Longest steps, over the width of a cell: they lead no farther than to the next one.
const LONGEST: f64 = 0.25;

/// What of a cell's bends is across the surface, over the tolerance.
#[derive(Clone, Copy)]
pub(super) struct Turned {
    normal: Vec3,
    spread: f64,
    along: [f64; 3],
    /// How far a step leads that makes up for one tolerance along the surface.
    steps: [f64; 2],
}

impl Turned {
    pub(super) fn new(across: &Across, lengths: [f64; 3], tolerance: f64) -> Turned {
        let Across { normal, spread, along, speeds } = *across;
        let along = [0, 1, 2].map(|k: usize| (along[k] / tolerance).min(lengths[k]));
        Turned { normal, spread, along, steps: speeds.map(|speed| tolerance / speed) }
    }

    /// Bounds along any normal of the cell, from those of lengths.
    pub(super) fn bends(&self, lengths: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k: usize| (self.along[k] + self.spread * lengths[k]).min(lengths[k]))
    }
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
            let [uu, uv, vv] = [0, 1, 2].map(|k: usize| {
                most(&|near| slides.turned[near].map_or(0.0, |_| lengths[near][k]))
            });
            slides.inner.push(is_inner);
            slides.costs.push(
                0.5 * (uu * step[0] * step[0] + 2.0 * uv * step[0] * step[1] + vv * step[1] * step[1]),
            );
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

    /// Bounds across the surface of a cell whose lengths these are.
    pub(super) fn bends_of(&self, cell: usize, lengths: [f64; 3]) -> [f64; 3] {
        self.turned[cell].map_or(lengths, |turned| turned.bends(lengths))
    }

    /// What steps cost around some cells, for a ratio of D to the tolerance.
    pub(super) fn cost(&self, cells: impl Iterator<Item = usize>, ratio: f64) -> f64 {
        ratio * ratio * cells.map(|cell| self.costs[cell]).fold(0.0, f64::max)
    }

    /// Whether the box of a triangle, which meets these cells, is a border's width from where steps are scaled.
    pub(super) fn is_inside(&self, part: [[f64; 2]; 2], met: [[usize; 2]; 2]) -> bool {
        let [[i0, i1], [j0, j1]] = met;
        let width = self.cells[1];
        if (i0..=i1).all(|i| (j0..=j1).all(|j| self.inner[i * width + j])) {
            return true;
        }
        let wide = [0, 1].map(|axis: usize| {
            let [low, high] = self.domain[axis];
            let (cell, count) = ((high - low) / self.cells[axis] as f64, self.cells[axis]);
            let [from, to] = [part[axis][0] - self.border[axis], part[axis][1] + self.border[axis]];
            let index = |t: f64| (((t - low) / cell).max(0.0) as usize).min(count - 1);
            (from >= low && to <= high).then(|| [index(from), index(to)])
        });
        let [Some([i0, i1]), Some([j0, j1])] = wide else { return false };
        (i0..=i1).all(|i| (j0..=j1).all(|j| self.turned[i * width + j].is_some()))
    }

    /// Bounds along any normal of some cells, of which steps may be made in all.
    pub(super) fn bends(
        &self,
        cells: impl Iterator<Item = usize> + Clone,
        lengths: &[[f64; 3]],
    ) -> Option<[f64; 3]> {
        let first = self.turned[cells.clone().next()?]?;
        let (mut most, mut spread) = ([0.0; 3], 0.0_f64);
        for cell in cells.clone() {
            let own = self.turned[cell]?;
            let apart = (own.normal - first.normal).length();
            spread = spread.max(own.spread + apart);
            for k in 0..3 {
                most[k] = f64::max(most[k], own.along[k] + apart * lengths[cell][k]);
            }
        }
        let longest = cells.fold([0.0; 3], |longest: [f64; 3], cell| {
            [0, 1, 2].map(|k: usize| longest[k].max(lengths[cell][k]))
        });
        Some([0, 1, 2].map(|k: usize| (most[k] + spread * longest[k]).min(longest[k])))
    }
}
