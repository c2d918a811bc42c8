use super::{Mesh, Solid};
use crate::math::Vec3;

/// The box between the corners `min` and `max`, twelve triangles; empty unless `min < max` on every axis.
pub fn cuboid(min: Vec3, max: Vec3) -> Solid {
    if !min.cmplt(max).all() || !min.is_finite() || !max.is_finite() {
        return Solid::default();
    }
    let corner = |i: u32| {
        Vec3::new(
            if i & 1 == 0 { min.x } else { max.x },
            if i & 2 == 0 { min.y } else { max.y },
            if i & 4 == 0 { min.z } else { max.z },
        )
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Solid::assume(Mesh { positions: (0..8).map(corner).collect(), triangles }, true)
}
