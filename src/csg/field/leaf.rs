//! Fields as leaves.

use crate::isosurface::{self, IsoError};
use crate::math::{Aabb, Vec3};
use crate::numeric::ContentHasher;
use crate::sdf::{BadNumber, Binary, Expr, Field, Implicit, Operation, Periodic, Primitive, Range, Unary};

/// A solid as the inside of a field.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldBody {
    /// The field.
    pub shape: FieldShape,
    /// Greatest distance between the mesh and the surface, either way.
    pub tolerance: f64,
}

/// A field by what makes it; all but formulas and periodic ones lie around the origin.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldShape {
    /// A primitive of bounded size.
    Primitive(Primitive),
    /// A cone around the z axis, or a frustum of one, see [`Implicit::frustum`].
    Frustum {
        /// Radii at the lower and the upper end.
        radii: [f64; 2],
        /// Half of the height.
        half_height: f64,
    },
    /// A prism over a regular polygon, see [`Implicit::prism`].
    Prism {
        /// Number of sides, at least 3.
        sides: u32,
        /// Distance of the corners from the z axis.
        radius: f64,
        /// Half of the height.
        half_height: f64,
    },
    /// The part of a triply periodic shape within a box.
    Periodic {
        /// Which one.
        kind: Periodic,
        /// Length after which it repeats along each axis.
        period: f64,
        /// Of a wall around the surface; `None` for all that is on its negative side.
        thickness: Option<f64>,
        /// Where it is cut off.
        bounds: Aabb,
    },
    /// Soft balls that flow into each other, see [`Implicit::metaballs`].
    Metaballs {
        /// Centre, radius and weight of each.
        balls: Vec<(Vec3, f64, f64)>,
        /// The sum at the surface.
        threshold: f64,
    },
    /// A formula, negative inside, within a box.
    Formula {
        /// The formula.
        formula: Formula,
        /// Where it is cut off.
        bounds: Aabb,
    },
}

/// A formula over x, y and z as a value: compared and hashed by its operations.
#[derive(Clone, Debug)]
pub struct Formula {
    expr: Expr,
    operations: Vec<Operation>,
}

impl Formula {
    /// The formula; `None` when a field that is no formula (a mesh, a polygon, a tube) is part of it.
    pub fn new(expr: Expr) -> Option<Formula> {
        let operations = expr.operations()?;
        Some(Formula { expr, operations })
    }

    /// The formula itself.
    pub fn expr(&self) -> &Expr {
        &self.expr
    }

    /// Its plain operations, the result last.
    pub fn operations(&self) -> &[Operation] {
        &self.operations
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Formula) -> bool {
        self.operations == other.operations
    }
}

impl FieldShape {
    /// A box outside of which a formula is proven not to be negative; empty where there is no inside.
    ///
    /// # Errors
    /// [`IsoError::Unbounded`] where there is no such box, or no proof.
    pub fn bounds_of(formula: &Formula) -> Result<Aabb, IsoError> {
        let field = formula.expr.compile();
        let found = isosurface::find_bounds(&field)?;
        Ok(if found.is_empty() { found } else { (0..6).fold(found, |found, side| cut(&field, found, side)) })
    }
}

/// The box without the slabs at one of its sides that are proven to be outside; a 64th of it is the thinnest tried.
fn cut(field: &dyn Field, mut bounds: Aabb, side: usize) -> Aabb {
    let (axis, upper) = (side % 3, side >= 3);
    let mut step = 0.5 * bounds.size()[axis];
    for _ in 0..6 {
        let mut slab = bounds;
        if upper {
            slab.min[axis] = slab.max[axis] - step;
        } else {
            slab.max[axis] = slab.min[axis] + step;
        }
        if field.range(slab).is_some_and(Range::is_outside) {
            if upper {
                bounds.max[axis] = slab.min[axis];
            } else {
                bounds.min[axis] = slab.max[axis];
            }
        }
        step *= 0.5;
    }
    bounds
}

impl FieldBody {
    /// Whether its numbers make a field.
    ///
    /// # Errors
    /// Which of them does not.
    pub fn check(&self) -> Result<(), BadNumber> {
        self.implicit()?;
        let Aabb { min, max } = self.bounds();
        let size = (max - min).max_element();
        let known = min.is_finite() && max.is_finite() || self.bounds().is_empty();
        BadNumber::check("size of the box", "finite", size, known)?;
        BadNumber::positive("tolerance", self.tolerance).map(drop)
    }

    /// The field, and what is known of it.
    pub(in crate::csg) fn implicit(&self) -> Result<Implicit, BadNumber> {
        match &self.shape {
            FieldShape::Primitive(primitive) => Implicit::primitive(*primitive),
            FieldShape::Frustum { radii, half_height } => Implicit::frustum(*radii, *half_height),
            FieldShape::Prism { sides, radius, half_height } => {
                Implicit::prism(*sides, *radius, *half_height)
            }
            FieldShape::Periodic { kind, period, thickness, .. } => {
                let whole = Implicit::primitive(Primitive::Periodic { kind: *kind, period: *period })?;
                thickness.map_or(Ok(whole.clone()), |thickness| whole.shell(thickness))
            }
            FieldShape::Metaballs { balls, threshold } => Implicit::metaballs(balls, *threshold),
            FieldShape::Formula { formula, bounds } => {
                Ok(Implicit::formula(formula.expr.clone(), None, *bounds))
            }
        }
    }

    /// The box at which it is cut off, if there is one.
    pub(in crate::csg) fn cut(&self) -> Option<Aabb> {
        match &self.shape {
            FieldShape::Periodic { bounds, .. } | FieldShape::Formula { bounds, .. } => Some(*bounds),
            _ => None,
        }
    }

    /// The field as a part of others: what is cut off at a box, or not known to end, is cut by the distance from it.
    pub(in crate::csg) fn confined(&self) -> Result<Implicit, BadNumber> {
        let whole = self.implicit()?;
        match self.shape {
            FieldShape::Periodic { .. } | FieldShape::Formula { .. } | FieldShape::Metaballs { .. } => {
                let bounds = self.bounds();
                let half = 0.5 * bounds.size();
                let around = Implicit::primitive(Primitive::Cuboid { half })?.translate(bounds.center())?;
                Ok(whole.intersection(&around))
            }
            _ => Ok(whole),
        }
    }

    /// A box around it, or at which it is cut off.
    pub fn bounds(&self) -> Aabb {
        let symmetric = |half: Vec3| Aabb { min: -half, max: half };
        match &self.shape {
            FieldShape::Primitive(primitive) => symmetric(primitive.half_size()),
            FieldShape::Frustum { radii: [low, high], half_height } => {
                let radius = low.max(*high);
                symmetric(Vec3::new(radius, radius, *half_height))
            }
            FieldShape::Prism { radius, half_height, .. } => {
                symmetric(Vec3::new(*radius, *radius, *half_height))
            }
            FieldShape::Metaballs { balls, .. } => {
                let attracting = balls.iter().filter(|(_, _, weight)| *weight > 0.0);
                let around = |&(center, radius, _): &(Vec3, f64, f64)| Aabb {
                    min: center - Vec3::splat(radius),
                    max: center + Vec3::splat(radius),
                };
                attracting.map(around).fold(Aabb::EMPTY, Aabb::union)
            }
            FieldShape::Periodic { bounds, .. } | FieldShape::Formula { bounds, .. } => *bounds,
        }
    }

    /// How much further out than by `k` the places may lie where the field is below `k`, as a factor.
    pub(in crate::csg) fn swell(&self) -> f64 {
        match self.shape {
            FieldShape::Primitive(Primitive::Ellipsoid { radii }) => {
                radii.max_element() / radii.min_element()
            }
            // Exact distances, and those cut by the distance from a box.
            _ => 1.0,
        }
    }

    /// Hashes all that the shape depends on.
    pub(in crate::csg) fn hash(&self, hash: &mut ContentHasher) {
        hash.numbers([self.tolerance]);
        match &self.shape {
            FieldShape::Primitive(primitive) => {
                let (which, numbers) = primitive.parameters();
                hash.integers([0, u64::from(which)]);
                hash.numbers(numbers);
            }
            FieldShape::Frustum { radii, half_height } => {
                hash.integers([1]);
                hash.numbers([radii[0], radii[1], *half_height]);
            }
            FieldShape::Prism { sides, radius, half_height } => {
                hash.integers([2, u64::from(*sides)]);
                hash.numbers([*radius, *half_height]);
            }
            FieldShape::Periodic { kind, period, thickness, bounds } => {
                hash.integers([3, *kind as u64, u64::from(thickness.is_some())]);
                hash.numbers([*period, thickness.unwrap_or(0.0)]);
                hash_box(hash, bounds);
            }
            FieldShape::Metaballs { balls, threshold } => {
                hash.integers([4, balls.len() as u64]);
                hash.numbers([*threshold]);
                for (center, radius, weight) in balls {
                    hash.numbers(center.to_array().into_iter().chain([*radius, *weight]));
                }
            }
            FieldShape::Formula { formula, bounds } => {
                hash.integers([5, formula.operations.len() as u64]);
                formula.operations.iter().for_each(|operation| hash_operation(hash, *operation));
                hash_box(hash, bounds);
            }
        }
    }
}

fn hash_box(hash: &mut ContentHasher, bounds: &Aabb) {
    hash.numbers(bounds.min.to_array().into_iter().chain(bounds.max.to_array()));
}

fn hash_operation(hash: &mut ContentHasher, operation: Operation) {
    match operation {
        Operation::Axis(axis) => hash.integers([0, u64::from(axis)]),
        Operation::Constant(x) => hash.integers([1, x.to_bits()]),
        Operation::Unary(op, a) => {
            let which = Unary::ALL.iter().position(|other| *other == op);
            hash.integers([2, which.unwrap_or(0) as u64, u64::from(a)]);
        }
        Operation::Binary(op, a, b) => {
            let which = Binary::ALL.iter().position(|other| *other == op);
            hash.integers([3, which.unwrap_or(0) as u64, u64::from(a), u64::from(b)]);
        }
    }
}
