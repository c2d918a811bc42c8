//! How a piece bends, cell by cell: what its density of vertices and the check of its triangles come from.

use super::slide::{Free, Slides, Turned};
use super::{Guarantee, Precision, SurfaceOptions, TessellationError, check};
use crate::surface::{Bends, Gluing, Jet, Side, Surface};

/// Cells an axis for Bézier patches, and for surfaces that may be of any shape.
const CELLS: [usize; 2] = [12, 32];
/// Cells an axis for bounds that only say where to measure.
const COARSE: usize = 4;
/// Most parts of a side of a triangle that is measured closely.
pub(super) const MOST_STEPS: usize = 24;
/// The parts where no bounds tell how many it takes.
pub(super) const PARTS_UNKNOWN: usize = 4;
/// Share of the mixed derivative that counts as bending along an axis that has none of its own.
const LEAST_SHARE: f64 = 0.1;

pub(super) struct Table {
    domain: [[f64; 2]; 2],
    /// Whether the surface comes back to where it began along u, and along v.
    closed: [bool; 2],
    pub(super) cells: [usize; 2],
    /// Second derivatives over tolerance, by uu, uv, vv.
    bends: Vec<[f64; 3]>,
    tolerances: Vec<f64>,
    /// Bounds that say where to measure, where nothing is proven by them.
    lengths: Option<Lengths>,
    /// Where distances may be measured to other parameters than those of the triangle.
    slides: Slides,
    /// Segments that a length of 1 along u, and along v, needs.
    densities: Vec<[f64; 2]>,
    /// Whether distances are bounds.
    pub(super) proven: bool,
    /// Whether these come from the corners of triangles alone.
    pub(super) closed_form: bool,
}

impl Table {
    pub(super) fn new(
        index: usize,
        surface: &dyn Surface,
        domain: [[f64; 2]; 2],
        options: &SurfaceOptions,
    ) -> Result<Table, TessellationError> {
        let cells = [if surface.border_net(Side::Bottom).is_some() { CELLS[0] } else { CELLS[1] }; 2];
        let at = |axis: usize, k: usize| {
            let [low, high] = domain[axis];
            if k == cells[axis] { high } else { low + (high - low) * k as f64 / cells[axis] as f64 }
        };
        let part = |k: usize| {
            let (i, j) = (k / cells[1], k % cells[1]);
            surface.bends([[at(0, i), at(0, i + 1)], [at(1, j), at(1, j + 1)]])
        };
        let closed_form = options.guarantee == Guarantee::Proven
            && surface.triangle_bound([surface.point(at(0, 0), at(1, 0)); 3]).is_some();
        let bounds: Option<Vec<Bends>> = match options.guarantee {
            Guarantee::Proven if closed_form => None,
            Guarantee::Proven if domain == surface.domain() => surface.bends_table(cells),
            Guarantee::Proven => (0..cells[0] * cells[1]).map(part).collect(),
            Guarantee::Measured => None,
        };
        let needed = bounds.is_none() || options.angle.is_some();
        let mut table = Table {
            domain,
            closed: [surface.sides().u, surface.sides().v].map(|gluing| gluing != Gluing::Open),
            cells,
            bends: Vec::new(),
            tolerances: Vec::new(),
            lengths: match options.guarantee {
                Guarantee::Proven => None,
                Guarantee::Measured => Lengths::bounds(surface, domain),
            },
            slides: Slides::default(),
            densities: Vec::new(),
            proven: bounds.is_some() || closed_form,
            closed_form,
        };
        let (mut turned, mut turns): (Vec<Option<Turned>>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
        for cell in 0..cells[0] * cells[1] {
            let (i, j) = (cell / cells[1], cell % cells[1]);
            let middle = [0.5 * at(0, i) + 0.5 * at(0, i + 1), 0.5 * at(1, j) + 0.5 * at(1, j + 1)];
            let jet = needed.then(|| surface.jet(middle[0], middle[1]));
            if jet.is_some_and(|jet| !jet.point.is_finite()) {
                return Err(TessellationError::NotFinite { surface: index, parameters: middle });
            }
            let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
            let tolerance = least_tolerance(surface, options, corners.map(|(i, j)| [at(0, i), at(1, j)]));
            let bend = match &bounds {
                Some(bounds) => bounds[cell].lengths,
                None => jet.as_ref().map_or([0.0; 3], measured_bend),
            };
            if !bend.iter().all(|b| b.is_finite()) {
                return Err(TessellationError::NotReached { surface: index, parameters: middle });
            }
            let bend = bend.map(|b| b / tolerance);
            let turn = match (options.angle, &jet) {
                (Some(angle), Some(jet)) => turning(jet).map(|rate| rate / angle),
                _ => [0.0; 2],
            };
            let across = bounds.as_ref().and_then(|bounds| bounds[cell].across);
            turned.push(across.map(|across| Turned::new(&across, tolerance)));
            table.bends.push(bend);
            table.tolerances.push(tolerance);
            turns.push(turn);
        }
        table.slides = Slides::new(domain, cells, turned, &table.bends, &table.tolerances);
        let density = |(cell, turn): (usize, [f64; 2])| {
            let plain = table.density_of(table.slides.bends_of(cell, table.bends[cell]));
            [0, 1].map(|axis: usize| plain[axis].max(turn[axis]))
        };
        table.densities = turns.into_iter().enumerate().map(density).collect();
        Ok(table)
    }

    /// Right triangles with legs of one segment then err by one tolerance: the mixed derivative is shared between the
    /// axes so that their product is least.
    fn density_of(&self, [uu, uv, vv]: [f64; 3]) -> [f64; 2] {
        let [du, dv] = self.domain.map(|[low, high]| high - low);
        let (a, c) = (uu + LEAST_SHARE * uv * dv / du, vv + LEAST_SHARE * uv * du / dv);
        let ratio = if c > 0.0 { (a / c).sqrt() } else { 1.0 };
        let (along_u, along_v) = if ratio > 0.0 { (uu + ratio * uv, vv + uv / ratio) } else { (uu, vv) };
        [0.5 * along_u.sqrt(), 0.5 * along_v.sqrt()]
    }

    /// How far a triangle is at most off the surface at the same parameters, over the tolerance; `None` where no bounds are
    /// known, or distances are proven otherwise.
    pub(super) fn whole(&self, parameters: &[[f64; 2]; 3]) -> Option<f64> {
        let bends = self.lengths.as_ref()?.around(self.met_of([COARSE; 2], parameters));
        Some(check::bound_by(bends, parameters) / self.tolerance(parameters))
    }

    /// Into how many parts each side of a triangle must be cut for distances at the corners of the parts to tell those between
    /// them up to a share of the tolerance; `None` where no bend makes them more than the tolerance.
    pub(super) fn parts(&self, parameters: &[[f64; 2]; 3], share: f64) -> Option<Parts> {
        let Some(whole) = self.whole(parameters) else {
            return Some(Parts { count: PARTS_UNKNOWN, rest: 0.0 });
        };
        if whole <= 1.0 {
            return None;
        }
        // What lies between shrinks with the square of the parts; NaN asks for the most.
        let count = (whole / share).sqrt().ceil().min(MOST_STEPS as f64) as usize;
        Some(Parts { count, rest: whole / (count * count) as f64 })
    }

    /// Cells that the box of some parameters meets, as ranges of indices.
    pub(super) fn met(&self, parameters: &[[f64; 2]; 3]) -> [[usize; 2]; 2] {
        self.met_of(self.cells, parameters)
    }

    fn met_of(&self, cells: [usize; 2], parameters: &[[f64; 2]; 3]) -> [[usize; 2]; 2] {
        [0, 1].map(|axis: usize| {
            let [low, high] = self.domain[axis];
            let count = cells[axis];
            let index = |t: f64| (((t - low) / (high - low) * count as f64) as usize).min(count - 1);
            let all = parameters.map(|p| p[axis]);
            let least = all.into_iter().fold(f64::INFINITY, f64::min);
            let most = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
            [index(least), index(most)]
        })
    }

    /// Whether a triangle goes half around a closed axis or farther: its corners do not tell which way.
    pub(super) fn goes_around(&self, parameters: &[[f64; 2]; 3]) -> bool {
        [0, 1].into_iter().filter(|&axis| self.closed[axis]).any(|axis| {
            let all = || parameters.iter().map(|p| p[axis]);
            let extent = all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min);
            2.0 * extent >= self.domain[axis][1] - self.domain[axis][0]
        })
    }

    /// Whether a part is narrower than a quarter of a cell along an axis.
    pub(super) fn is_far_smaller(&self, part: [[f64; 2]; 2]) -> bool {
        [0, 1].into_iter().any(|axis: usize| {
            let [low, high] = self.domain[axis];
            (part[axis][1] - part[axis][0]) * self.cells[axis] as f64 <= 0.25 * (high - low)
        })
    }

    fn met_cells(&self, parameters: &[[f64; 2]; 3]) -> impl Iterator<Item = usize> + Clone + use<> {
        let [[i0, i1], [j0, j1]] = self.met(parameters);
        let width = self.cells[1];
        (i0..=i1).flat_map(move |i| (j0..=j1).map(move |j| i * width + j))
    }

    /// The largest bends around a triangle.
    pub(super) fn bend(&self, parameters: &[[f64; 2]; 3]) -> [f64; 3] {
        self.met_cells(parameters).fold([0.0; 3], |most: [f64; 3], cell| {
            let bend = self.bends[cell];
            [most[0].max(bend[0]), most[1].max(bend[1]), most[2].max(bend[2])]
        })
    }

    /// The largest bends around a triangle that steps do not make up for, and which steps these are.
    pub(super) fn bend_left(
        &self,
        parameters: &[[f64; 2]; 3],
        part: [[f64; 2]; 2],
    ) -> (Free, Option<[f64; 3]>) {
        let free = self.slides.free(part, self.met(parameters));
        (free, self.slides.bends(free, self.met_cells(parameters), &self.bends))
    }

    /// What steps cost, over the tolerance.
    pub(super) fn cost(&self, parameters: &[[f64; 2]; 3], ratio: f64) -> f64 {
        self.slides.cost(self.met_cells(parameters), ratio)
    }

    /// The least tolerance around a triangle.
    pub(super) fn tolerance(&self, parameters: &[[f64; 2]; 3]) -> f64 {
        self.met_cells(parameters).map(|cell| self.tolerances[cell]).fold(f64::INFINITY, f64::min)
    }

    /// Segments that a length of 1 along an axis needs in a cell.
    pub(super) fn density(&self, i: usize, j: usize, axis: usize) -> f64 {
        let cell = i * self.cells[1] + j;
        self.densities[cell][axis]
    }

    /// The square of the length of a step, in segments.
    pub(super) fn length_squared(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let middle = [0, 1].map(|axis: usize| 0.5 * from[axis] + 0.5 * to[axis]);
        let [[i, _], [j, _]] = self.met(&[middle; 3]);
        let along = [0, 1].map(|axis: usize| (to[axis] - from[axis]) * self.density(i, j, axis));
        along[0] * along[0] + along[1] * along[1]
    }
}

/// Where a triangle is looked at, at the corners of equal parts.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    /// Along each side.
    pub(super) count: usize,
    /// What may lie between, over the tolerance.
    pub(super) rest: f64,
}

/// Bounds of the lengths of second derivatives by uu, uv and vv, on a coarse grid of cells.
struct Lengths(Vec<[f64; 3]>);

impl Lengths {
    fn bounds(surface: &dyn Surface, domain: [[f64; 2]; 2]) -> Option<Lengths> {
        let at = |axis: usize, k: usize| {
            let [low, high] = domain[axis];
            if k == COARSE { high } else { low + (high - low) * k as f64 / COARSE as f64 }
        };
        let cell = |k: usize| {
            let (i, j) = (k / COARSE, k % COARSE);
            surface.second_bounds([[at(0, i), at(0, i + 1)], [at(1, j), at(1, j + 1)]])
        };
        (0..COARSE * COARSE).map(cell).collect::<Option<Vec<_>>>().map(Lengths)
    }

    /// The largest in a range of cells.
    fn around(&self, [[i0, i1], [j0, j1]]: [[usize; 2]; 2]) -> [f64; 3] {
        let cells = (i0..=i1).flat_map(|i| (j0..=j1).map(move |j| i * COARSE + j));
        cells.fold([0.0; 3], |most, cell| [0, 1, 2].map(|k: usize| most[k].max(self.0[cell][k])))
    }
}

/// What is allowed at the nearest of some places to a camera, or everywhere.
fn least_tolerance(surface: &dyn Surface, options: &SurfaceOptions, places: [[f64; 2]; 4]) -> f64 {
    match options.precision {
        Precision::Distance(tolerance) => tolerance,
        precision @ Precision::View(_) => {
            let at = places.map(|[u, v]| precision.at(surface.point(u, v)));
            at.into_iter().fold(f64::INFINITY, f64::min)
        }
    }
}

/// The second fundamental form, each entry without its sign; zero where there is no normal.
fn measured_bend(jet: &Jet) -> [f64; 3] {
    jet.second_form().unwrap_or([0.0; 3]).map(f64::abs)
}

/// How fast the normal turns along u and along v, from the shape operator.
fn turning(jet: &Jet) -> [f64; 2] {
    let (Some([l, m, n]), [e, f, g]) = (jet.second_form(), jet.first_form()) else { return [0.0; 2] };
    let determinant = e * g - f * f;
    if determinant <= 0.0 {
        return [0.0; 2];
    }
    // N_u = -(a S_u + b S_v) with the first form times (a, b) equal to (L, M), and so for v.
    let rate = |p: f64, q: f64| {
        let (a, b) = ((g * p - f * q) / determinant, (e * q - f * p) / determinant);
        (a * jet.du + b * jet.dv).length()
    };
    [rate(l, m), rate(m, n)]
}
