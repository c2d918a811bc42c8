//! Maps between frames: which of them keep flush faces flush, and what they do to boxes.

use crate::math::{Aabb, Affine3, Mat3, Vec3};

/// Whether a map takes axes to axes: scale, mirror, turns by multiples of 90 degrees, and any translation. What is flush
/// along the axes stays so through such a map, so it can be pushed down to the leaves.
pub(super) fn keeps_axes(map: &Affine3) -> bool {
    let zeros = |v: Vec3| v.to_array().iter().filter(|&&c| c == 0.0).count();
    let linear = map.matrix3;
    let rows = linear.transpose();
    let lines = [linear.x_axis, linear.y_axis, linear.z_axis, rows.x_axis, rows.y_axis, rows.z_axis];
    lines.into_iter().all(|line| zeros(line) == 2)
}

/// The map that does to x and y what `map` does to points of the plane z = 0, and leaves z alone.
pub(super) fn plane_part(map: &Affine3) -> Affine3 {
    let Mat3 { x_axis, y_axis, .. } = map.matrix3;
    let flat = |v: Vec3| v.with_z(0.0);
    Affine3 {
        matrix3: Mat3::from_cols(flat(x_axis), flat(y_axis), Vec3::Z),
        translation: flat(map.translation),
    }
}

/// Whether `map` is finite in all its numbers.
pub(super) fn is_finite(map: &Affine3) -> bool {
    map.to_cols_array().iter().all(|c| c.is_finite())
}

/// Whether no point moves.
pub(super) fn is_identity(map: &Affine3) -> bool {
    *map == Affine3::IDENTITY
}

/// A box around the image of a box. Exact for maps that keep axes, since rounding is monotone; widened for others.
pub(super) fn mapped_box(map: &Affine3, bounds: Aabb) -> Aabb {
    if bounds.is_empty() {
        return Aabb::EMPTY;
    }
    let Aabb { min, max } = bounds;
    let pick = |bit: usize, low: f64, high: f64| if bit == 0 { low } else { high };
    let corner =
        |i: usize| Vec3::new(pick(i & 1, min.x, max.x), pick(i & 2, min.y, max.y), pick(i & 4, min.z, max.z));
    let image = Aabb::of((0..8).map(|i| map.transform_point3(corner(i))));
    if keeps_axes(map) { image } else { widened(image, map.translation.abs().max_element()) }
}

/// A box larger by more than the rounding of a few operations on numbers of its size and of `size`.
pub(super) fn widened(bounds: Aabb, size: f64) -> Aabb {
    if bounds.is_empty() {
        return bounds;
    }
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element().max(size);
    let margin = Vec3::splat(largest * 1e-14);
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}

/// Whether two boxes have more than a face in common.
pub(super) fn overlap(a: Aabb, b: Aabb) -> bool {
    let common = a.intersection(b);
    common.min.cmplt(common.max).all()
}

/// All of space.
pub(super) const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
