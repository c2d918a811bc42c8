use crate::math::{Aabb, Vec3};
use crate::numeric::ContentHasher;
use crate::sdf::{Binary, Expr, Field, Operation, Unary};
use crate::surface::{Formula, Sides, SurfaceError};

/// A surface by formulas of two parameters, kept as plain operations so that equal ones are equal.
#[derive(Clone, Debug, PartialEq)]
pub struct Parametric {
    coordinates: [Vec<Operation>; 3],
    domain: [[f64; 2]; 2],
}

/// Sides nearer than this, over the size of the surface, lie together: sines of whole turns are that exact, and drawn
/// surfaces are that far apart where they are not meant to meet.
const TOGETHER: f64 = 1e-9;
/// Cells an axis whose boxes make up that of the surface.
const CELLS: usize = 16;

impl Parametric {
    /// The surface with these coordinates, in which x stands for u and y for v, over ranges of u and of v.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`] when a range is not finite and ascending, [`SurfaceError::NotPlain`] when a coordinate
    /// is no formula in plain operations, or jumps from one formula to another.
    pub fn new(coordinates: [Expr; 3], domain: [[f64; 2]; 2]) -> Result<Parametric, SurfaceError> {
        let plain = |axis: usize| {
            let operations = coordinates[axis].operations();
            operations.filter(|all| !all.iter().any(chooses)).ok_or(SurfaceError::NotPlain { axis })
        };
        let operations = [plain(0)?, plain(1)?, plain(2)?];
        Formula::new(coordinates, domain)?;
        Ok(Parametric { coordinates: operations, domain })
    }

    /// The operations of each coordinate, the result last.
    pub fn coordinates(&self) -> &[Vec<Operation>; 3] {
        &self.coordinates
    }

    /// First and last u, first and last v.
    pub fn domain(&self) -> [[f64; 2]; 2] {
        self.domain
    }

    /// The surface, its sides joined where they lie together.
    pub fn surface(&self) -> Formula {
        let plain = self.formula();
        let sides = Sides::found(&plain, TOGETHER * Sides::extent(&plain));
        plain.with_sides(sides)
    }

    fn formula(&self) -> Formula {
        let coordinates = [0, 1, 2].map(|axis: usize| Expr::of_operations(&self.coordinates[axis]));
        Formula::new(coordinates, self.domain).expect("checked when it was made")
    }

    /// The largest side of a box around some of its points.
    pub(crate) fn extent(&self) -> f64 {
        Sides::extent(&self.formula())
    }

    /// A box that holds it; of everything where the formulas have no bounds.
    pub(super) fn bounds(&self) -> Aabb {
        const EVERYTHING: f64 = 0.25 * f64::MAX;
        let tapes = [0, 1, 2].map(|axis: usize| Expr::of_operations(&self.coordinates[axis]).compile());
        let at = |axis: usize, k: usize| {
            let [low, high] = self.domain[axis];
            if k == CELLS { high } else { low + (high - low) * k as f64 / CELLS as f64 }
        };
        let mut bounds = Aabb::EMPTY;
        for cell in 0..CELLS * CELLS {
            let (i, j) = (cell / CELLS, cell % CELLS);
            let part = Aabb {
                min: Vec3::new(at(0, i), at(1, j), 0.0),
                max: Vec3::new(at(0, i + 1), at(1, j + 1), 0.0),
            };
            let ranges = [0, 1, 2].map(|axis: usize| tapes[axis].range(part).map(|range| range.interval));
            let low = |axis: usize| ranges[axis].map_or(-EVERYTHING, |range| range.lo.max(-EVERYTHING));
            let high = |axis: usize| ranges[axis].map_or(EVERYTHING, |range| range.hi.min(EVERYTHING));
            let held = Aabb {
                min: Vec3::from_array([0, 1, 2].map(low)),
                max: Vec3::from_array([0, 1, 2].map(high)),
            };
            bounds = bounds.union(held);
        }
        bounds
    }

    pub(super) fn hash(&self, hash: &mut ContentHasher) {
        hash.numbers(self.domain.into_iter().flatten());
        for operations in &self.coordinates {
            hash.integers([operations.len() as u64]);
            for &operation in operations {
                match operation {
                    Operation::Axis(axis) => hash.integers([0, u64::from(axis)]),
                    Operation::Constant(x) => {
                        hash.integers([1]);
                        hash.numbers([x]);
                    }
                    Operation::Unary(op, a) => hash.integers([2, op as u64, u64::from(a)]),
                    Operation::Binary(op, a, b) => hash.integers([3, op as u64, u64::from(a), u64::from(b)]),
                }
            }
        }
    }
}

/// Whether an operation is part of a choice between formulas: a surface may break there.
fn chooses(operation: &Operation) -> bool {
    matches!(operation, Operation::Unary(Unary::Not, _) | Operation::Binary(Binary::And | Binary::Or, ..))
}
