//! Which steps an expression is evaluated in.

use super::arrange;
use super::body::Body;
use super::tree::Tree;
use super::world::World;

/// Evaluates an expression.
pub(super) fn evaluate<'a>(world: World<'a>, bodies: Vec<Body>, tree: &Tree) -> (World<'a>, Body) {
    arrange(world, bodies, tree)
}
