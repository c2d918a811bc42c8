//! The box around a shape, by ranges.

use super::{IsoError, Places, corners_of};
use crate::math::{Aabb, Vec3};
use crate::sdf::{Field, Range};
use std::sync::Arc;

/// Half sides of boxes that are tried, from 2^-20 to 2^60.
const EXPONENTS: std::ops::RangeInclusive<i32> = -20..=60;

/// Cells looked at in a shell between two cubes before it is taken for one that may hold a part of the inside.
const CELLS_IN_SHELL: usize = 4096;

/// Times that a cell of a shell is divided.
const SHELL_DEPTH: u32 = 8;

/// A box outside of which the field is proven not to be negative: the field's own, or found by ranges. Empty when there
/// is no inside at all.
///
/// Ranges over the six half-spaces around a cube prove it for all of space. Where they tell too little, since two large
/// numbers may cancel, the shells between cubes of twice the size each are divided, and it is proven for coordinates
/// up to 2^60.
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
    let free = EXPONENTS.step_by(2).map(size).find(|&half| half_spaces_are_free(field, half));
    let found = free.or_else(|| least_after_free_shells(field));
    found.map(cube).ok_or(IsoError::Unbounded { searched: size(*EXPONENTS.end()) })
}

fn size(exponent: i32) -> f64 {
    crate::math::pow(2.0, f64::from(exponent))
}

fn cube(half: f64) -> Aabb {
    Aabb { min: Vec3::splat(-half), max: Vec3::splat(half) }
}

/// Whether nothing is inside farther than `half` from the origin along an axis.
fn half_spaces_are_free(field: &dyn Field, half: f64) -> bool {
    (0..6).all(|side: usize| {
        let mut beyond = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
        if side < 3 {
            beyond.min[side] = half;
        } else {
            beyond.max[side - 3] = -half;
        }
        field.range(beyond).is_some_and(is_free)
    })
}

/// Half the side of the least cube with free shells around it, each twice as large as the one before.
fn least_after_free_shells(field: &dyn Field) -> Option<f64> {
    let halves = EXPONENTS.rev().skip(1).map(size);
    halves.take_while(|&half| shell_is_free(field, half)).last()
}

/// Whether nothing is inside between the cube of half a side `half` and the one twice as large.
fn shell_is_free(field: &dyn Field, half: f64) -> bool {
    let mut left = CELLS_IN_SHELL;
    let inner = [-half, half];
    (0..64).all(|i: usize| {
        let at = [i % 4, i / 4 % 4, i / 16];
        let min = Vec3::from_array(at.map(|k| (k as f64 - 2.0) * half));
        let cell = Aabb { min, max: min + half };
        let is_inner = (0..3).all(|axis| inner[0] <= cell.min[axis] && cell.max[axis] <= inner[1]);
        is_inner || cell_is_free(field, cell, SHELL_DEPTH, &mut left)
    })
}

fn cell_is_free(field: &dyn Field, cell: Aabb, depth: u32, left: &mut usize) -> bool {
    *left = left.saturating_sub(1);
    if field.range(cell).is_some_and(is_free) {
        return true;
    }
    let middle = cell.center();
    // What is inside in the middle will not become free.
    let may_be_free = depth > 0 && *left > 0 && field.value(middle) >= 0.0;
    let eighths = corners_of(cell).map(|corner| Aabb::of([middle, corner]));
    may_be_free && eighths.into_iter().all(|eighth| cell_is_free(field, eighth, depth - 1, left))
}

/// A box that can be divided.
pub(super) fn checked(bounds: Aabb) -> Result<Aabb, IsoError> {
    let sound = bounds.min.is_finite() && bounds.max.is_finite() && bounds.size().min_element() > 0.0;
    if sound && bounds.size().is_finite() { Ok(bounds) } else { Err(IsoError::BadBounds(bounds)) }
}

/// Nothing inside there: no value is negative, if there are values.
fn is_free(range: Range) -> bool {
    range.is_undefined() || range.interval.lo >= 0.0
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
    fn boxes_of_what_waves_and_leans() {
        let [x, y, z] = Expr::axes();
        let norm = || (x.square() + y.square() + z.square()).sqrt();
        let wave = || (&x * 3.0).sin() * (&y * 3.0).sin();
        let shapes = [
            norm() - 8.0 - (&x * 3.0).sin(),
            norm() - 8.0 - wave(),
            norm() - 8.0 - &x / 3.0,
            norm() - 8.0 - &x * 0.9,
            norm() - 8.0 - (&x * &y).min(1.0).max(-1.0),
            (norm() - 8.0).square() - wave().abs(),
        ];
        for shape in shapes {
            let tape = shape.compile();
            let bounds = find_bounds(&tape).unwrap();
            assert!(bounds.size().max_element() < 600.0, "{bounds:?}");
            for k in 0..1000 {
                let turn = f64::from(k);
                let to =
                    Vec3::new(crate::math::cos(turn), crate::math::sin(turn), crate::math::sin(7.3 * turn));
                let outside = to * (300.0 + turn * turn) / to.abs().max_element();
                assert!(tape.value(outside) >= 0.0);
            }
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
