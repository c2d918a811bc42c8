use crate::math::{Aabb, Vec3, cbrt};

/// A grid of cells over a box. The cell of a coordinate grows with it, so boxes that touch have a cell in common.
#[derive(Clone, Debug)]
pub struct Grid {
    min: Vec3,
    /// Cells a unit along each axis.
    scale: Vec3,
    counts: [usize; 3],
}

/// The cells of a [`Grid`] that a box reaches: from one to another, both included, along each axis.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    from: [usize; 3],
    to: [usize; 3],
}

/// Cells along the longest axis at most.
const MOST: f64 = 128.0;

impl Grid {
    /// A grid of about as many cells as there are items when the box is a cube, and fewer when it is not: then most
    /// triangles of an even surface reach few cells, and most cells are free.
    pub fn new(bounds: Aabb, items: usize) -> Grid {
        let size = bounds.size();
        let longest = size.max_element();
        let cells = cbrt(items as f64).ceil().min(MOST);
        let count = |extent: f64| {
            if longest > 0.0 { (cells * extent / longest).ceil().clamp(1.0, MOST) } else { 1.0 }
        };
        let counts = Vec3::from_array(size.to_array().map(count));
        let scale = counts / size;
        let scale = Vec3::from_array(scale.to_array().map(|s| if s.is_finite() { s } else { 0.0 }));
        Grid { min: bounds.min, scale, counts: counts.to_array().map(|c| c as usize) }
    }

    /// Number of cells.
    #[allow(clippy::len_without_is_empty, reason = "a grid has a cell at least")]
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// The cells that a box reaches; what is beyond the grid counts to the cells at its border.
    pub fn span(&self, bounds: Aabb) -> Span {
        Span { from: self.cell(bounds.min), to: self.cell(bounds.max) }
    }

    fn cell(&self, p: Vec3) -> [usize; 3] {
        let place = (p - self.min) * self.scale;
        let along = |axis: usize| (place[axis].max(0.0) as usize).min(self.counts[axis] - 1);
        [along(0), along(1), along(2)]
    }

    /// Whether any cell of a span passes a test; those after it are not looked at.
    #[inline]
    pub fn any_cell(&self, span: Span, mut test: impl FnMut(usize) -> bool) -> bool {
        let [nx, ny, _] = self.counts;
        let Span { from, to } = span;
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                let row = (z * ny + y) * nx;
                if (row + from[0]..=row + to[0]).any(&mut test) {
                    return true;
                }
            }
        }
        false
    }
}

impl Span {
    /// Number of cells.
    #[allow(clippy::len_without_is_empty, reason = "a box reaches a cell at least")]
    pub fn len(self) -> usize {
        (0..3).map(|axis| self.to[axis] - self.from[axis] + 1).product()
    }
}
