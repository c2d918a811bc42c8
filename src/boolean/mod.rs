//! Solid with solid, exactly: union, intersection, difference, symmetric difference and any tree of them.
//!
//! One arrangement for the whole expression, in named passes:
//!
//! 1. `scene`: operands onto a common lattice, vertices at one place become one point;
//! 2. `contacts`: pairs of triangles that touch, and where; triangles that touch nothing stay whole ever after;
//! 3. `carriers`: the others gathered by plane, each plane cut along its contacts into cells (coplanar faces of all
//!    operands fall into one plane, so flush, identical and opposed faces are sums of coverage and no special case);
//! 4. `regions`: the space between the cells: around each edge the cells are sorted by angle, and what lies between two
//!    neighbours is one region; winding numbers follow from one exact ray a component;
//! 5. `assemble`: cells between inside and outside, merged into faces, triangulated afresh and joined along edges, each
//!    solid wedge with its own copy of an edge where several meet.
//!
//! Every sign is exact on the lattice. By construction the result is closed and two-manifold whatever the input, because
//! faces are kept by comparing the regions on their sides, and regions are the same seen from all faces around an edge.
//!
//! The arrangement follows Attene (2020) and Cherchi et al. (2022) in its indirect points, EMBER (Trettner,
//! Nehring-Wirxel, Kobbelt 2022) in its winding vectors, and differs from them in working plane by plane.

mod arrive;
mod assemble;
mod body;
mod carriers;
mod certificate;
mod contacts;
mod leave;
mod operand;
mod pairs;
mod ray;
mod regions;
mod repair;
mod scene;
mod slope;
mod strategy;
mod tree;
mod world;

pub use certificate::Certificate;
pub use operand::Operand;
pub use tree::{Op, Tree};

use crate::mesh::{Defects, Solid};
use body::Body;
use std::fmt;
use world::World;

/// What a boolean hands back.
#[derive(Clone, Debug, Default)]
pub struct Combined {
    /// The result.
    pub solid: Solid,
    /// For each triangle of `solid`, where it came from.
    pub birth: Vec<Birth>,
    /// What is known of `solid`.
    pub certificate: Certificate,
}

/// Where a triangle of a result came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Birth {
    /// Index of the operand.
    pub operand: u32,
    /// Index of a triangle of that operand that lies on the same face. Where several do, one of them.
    pub triangle: u32,
}

/// Why a boolean could not be taken.
#[derive(Clone, Debug, PartialEq)]
pub enum BooleanError {
    /// An operand is not a closed chain of triangles.
    NotClosed {
        /// Index of the operand.
        operand: usize,
        /// What is wrong with it.
        defects: Box<Defects>,
    },
    /// The expression names an operand that was not given.
    NoSuchOperand {
        /// The index it names.
        index: usize,
        /// How many operands there are.
        count: usize,
    },
}

impl fmt::Display for BooleanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BooleanError::NotClosed { operand, defects } => {
                write!(f, "operand {operand} bounds no volume:")?;
                let wrong = defects.rows().into_iter().filter(|&(_, count)| count > 0);
                wrong.enumerate().try_for_each(|(i, (name, count))| {
                    write!(f, "{} {count} {name}", if i > 0 { "," } else { "" })
                })
            }
            BooleanError::NoSuchOperand { index, count } => {
                write!(f, "the expression names operand {index} of {count}")
            }
        }
    }
}

impl std::error::Error for BooleanError {}

/// Evaluates any boolean expression in one arrangement.
///
/// Operands are meshes or solids. They need only be closed as chains ([`Defects::is_closed`]): they may cross themselves,
/// overlap themselves and have more than two triangles at an edge. A point is inside an operand where its winding number
/// is at least one.
///
/// Coordinates are taken on a lattice of 2^-59 of the largest one or finer; new vertices are exact points rounded to
/// doubles, vertices of the input keep their bits. The order of operands changes the order of the triangles at most.
///
/// # Errors
/// [`BooleanError::NotClosed`] for an operand that bounds no volume, [`BooleanError::NoSuchOperand`].
///
/// ```
/// use ogee::boolean::{evaluate, Op, Tree};
/// use ogee::math::Vec3;
/// use ogee::mesh::cuboid;
///
/// let bricks: Vec<_> = (0..3).map(|i| cuboid(Vec3::X * f64::from(i), Vec3::new(f64::from(i) + 1.0, 1.0, 1.0))).collect();
/// let operands: Vec<_> = bricks.iter().collect();
/// let wall = evaluate(&Tree::flat(Op::Union, 3), &operands)?.solid;
/// assert_eq!(wall.triangles().len(), 12);
/// # Ok::<(), ogee::boolean::BooleanError>(())
/// ```
pub fn evaluate<'a, T>(tree: &Tree, operands: &[T]) -> Result<Combined, BooleanError>
where
    T: Copy + Into<Operand<'a>>,
{
    evaluate_with(tree, operands, &Options::default())
}

/// How a boolean is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// All coordinates are first rounded to multiples of a power of two that is at most this, in model units, so that
    /// parts which were meant to be flush, and miss each other by rounding errors, are. 0 or less, NaN, and what is finer
    /// than the lattice of [`evaluate`] change nothing. Vertices that do not meet another operand keep their positions
    /// all the same.
    pub resolution: f64,
    /// In which steps. They change time and memory; of the result no more than how flat faces are triangulated.
    pub steps: Steps,
}

/// In which steps an expression is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Steps {
    /// One arrangement where few operands meet at any one place, group by group where many overlap.
    #[default]
    Measured,
    /// One arrangement of all operands.
    Once,
    /// One arrangement for each operation on two operands.
    Pairs,
}

/// [`evaluate`] with options.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_with<'a, T>(tree: &Tree, operands: &[T], options: &Options) -> Result<Combined, BooleanError>
where
    T: Copy + Into<Operand<'a>>,
{
    let operands: Vec<Operand<'a>> = operands.iter().map(|&operand| operand.into()).collect();
    if let Some(index) = tree.last_operand().filter(|&last| last >= operands.len()) {
        return Err(BooleanError::NoSuchOperand { index, count: operands.len() });
    }
    let (world, bodies) = arrive::enter(&operands, options.resolution)?;
    let (world, body) = strategy::evaluate(world, bodies, tree, options.steps);
    Ok(certificate::certify(world.round(body), &operands))
}

/// Evaluates an expression of bodies in one arrangement.
fn arrange<'a>(world: World<'a>, bodies: Vec<Body>, tree: &Tree) -> (World<'a>, Body) {
    let mut scene = scene::Scene::new(world, bodies);
    let contacts = contacts::find(&mut scene);
    let carriers = carriers::cut(&mut scene, contacts);
    let regions = regions::classify(&scene, &carriers, tree);
    assemble::assemble(scene, carriers, &regions)
}

/// Where `a` or `b` is.
pub fn union(a: &Solid, b: &Solid) -> Combined {
    pair(Op::Union, a, b)
}

/// Where `a` and `b` both are.
pub fn intersection(a: &Solid, b: &Solid) -> Combined {
    pair(Op::Intersection, a, b)
}

/// Where `a` is and `b` is not.
pub fn difference(a: &Solid, b: &Solid) -> Combined {
    pair(Op::Difference, a, b)
}

/// Where exactly one of `a` and `b` is.
pub fn symmetric_difference(a: &Solid, b: &Solid) -> Combined {
    pair(Op::SymmetricDifference, a, b)
}

fn pair(op: Op, a: &Solid, b: &Solid) -> Combined {
    evaluate(&Tree::flat(op, 2), &[a, b]).expect("solids are closed")
}
