//! The box around a shape, by ranges.

use super::{IsoError, Places, corners_of};
use crate::math::{Aabb, Vec3};
use crate::sdf::{Field, Range};
use std::sync::Arc;

/// Half sides of boxes that are tried, from 2^-20 to 2^60.
const EXPONENTS: std::ops::RangeInclusive<i32> = -20..=60;

/// A box outside of which the field is proven not to be negative: the field's own, or found by ranges over the six
/// half-spaces around growing cubes. Empty when there is no inside at all.
///
/// # Errors
/// [`IsoError::Unbounded`] when neither tells.
pub fn find_bounds(field: &dyn Field) -> Result<Aabb, IsoError> {
    if let Some(bounds) = field.bounds() {
        return Ok(bounds);
    }
    let everywhere = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
    let Some(range) = field.range(everywhere) else {
        return Err(IsoError::Unbounded { searched: 0.0 });
    };
    if is_free(range) {
        return Ok(Aabb::EMPTY);
    }
    let half_spaces_free = |half: f64| {
        (0..6).all(|side: usize| {
            let mut beyond = everywhere;
            if side < 3 {
                beyond.min[side] = half;
            } else {
                beyond.max[side - 3] = -half;
            }
            field.range(beyond).is_some_and(is_free)
        })
    };
    for exponent in EXPONENTS.step_by(2) {
        let half = crate::math::pow(2.0, f64::from(exponent));
        if half_spaces_free(half) {
            return Ok(Aabb { min: Vec3::splat(-half), max: Vec3::splat(half) });
        }
    }
    Err(IsoError::Unbounded { searched: crate::math::pow(2.0, f64::from(*EXPONENTS.end())) })
}

/// A box that can be divided.
pub(super) fn checked(bounds: Aabb) -> Result<Aabb, IsoError> {
    let sound = bounds.min.is_finite() && bounds.max.is_finite() && bounds.size().min_element() > 0.0;
    if sound && bounds.size().is_finite() { Ok(bounds) } else { Err(IsoError::BadBounds(bounds)) }
}

/// Nothing inside there.
fn is_free(range: Range) -> bool {
    range.is_outside() || range.is_undefined()
}

/// What is left of a box, and what was seen on the way.
pub(super) struct Found {
    pub(super) bounds: Aabb,
    pub(super) undefined: Places,
    pub(super) unsigned: Places,
}

/// Levels of cells in a pass.
const DEPTH: u32 = 4;

/// Passes at most; each can shrink a side sixteen times.
const PASSES: usize = 12;

/// The part of the box that may hold the inside, a little larger; the box's own sides are kept where it reaches
/// them, unless they are proven to be outside (`loose`).
pub(super) fn tightened(field: &dyn Field, bounds: Aabb, loose: bool) -> Found {
    let mut found = Found { bounds, undefined: Places::default(), unsigned: Places::default() };
    if bounds.is_empty() || field.range(bounds).is_none() {
        return found;
    }
    for _ in 0..PASSES {
        let mut pass =
            Found { bounds: Aabb::EMPTY, undefined: Places::default(), unsigned: Places::default() };
        search(field, found.bounds, DEPTH, &mut pass);
        let (before, after) = (found.bounds.size(), pass.bounds.size());
        found = Found { bounds: pass.bounds, ..pass };
        if after.cmpge(0.8 * before).all() || found.bounds.is_empty() {
            break;
        }
    }
    if !found.bounds.is_empty() {
        let grown = with_margin(found.bounds);
        found.bounds = if loose { grown } else { grown.intersection(bounds) };
    }
    found
}

/// A fiftieth more on each side: the surface then passes no border.
fn with_margin(bounds: Aabb) -> Aabb {
    let size = bounds.size();
    // A side of no length still needs cells.
    let margin = (0.02 * size).max(Vec3::splat(1e-3 * size.max_element()));
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}

fn search(field: &dyn Field, cell: Aabb, depth: u32, found: &mut Found) {
    let range = field.range(cell).unwrap_or(Range::UNKNOWN);
    if range.is_undefined() {
        found.undefined.add(cell);
        return;
    }
    if range.is_outside() {
        if range.interval.lo == 0.0 {
            found.unsigned.add(cell);
        }
        return;
    }
    let known = cell.min.cmpge(found.bounds.min).all() && cell.max.cmple(found.bounds.max).all();
    if known {
        return;
    }
    if depth == 0 || range.is_inside() {
        found.bounds = found.bounds.union(cell);
        return;
    }
    let pruned: Option<Arc<dyn Field>> = if field.cost() > 16 { field.within(cell) } else { None };
    let field = pruned.as_deref().unwrap_or(field);
    let middle = cell.center();
    for corner in corners_of(cell) {
        search(field, Aabb::of([middle, corner]), depth - 1, found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sdf::Expr;

    #[test]
    fn boxes_are_found_and_tightened() {
        let [x, y, z] = Expr::axes();
        for (middle, radius) in [(0.0, 1.0), (100.0, 0.25), (-3e4, 1e3)] {
            let ball = ((&x - middle).square() + y.square() + z.square()).sqrt() - radius;
            let tape = ball.compile();
            let bounds = tightened(&tape, find_bounds(&tape).unwrap(), true).bounds;
            assert!(bounds.min.x < middle - radius && bounds.max.x > middle + radius, "{bounds:?}");
            assert!(bounds.size().max_element() < 2.6 * radius, "{bounds:?}");
        }
    }

    #[test]
    fn what_has_no_bounds() {
        let half_space = Expr::z().compile();
        assert!(matches!(find_bounds(&half_space), Err(IsoError::Unbounded { searched }) if searched > 1e18));
        let nothing = (Expr::x().square() + 1.0).compile();
        assert!(find_bounds(&nothing).unwrap().is_empty());
    }
}
