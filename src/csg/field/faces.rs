//! Which curved surfaces the triangles of a result lie on.

use crate::math::{Affine3, Vec3};
use crate::sdf::{Field, Tape, greatest_stretch};
use std::sync::Arc;

/// The surface of a field, somewhere.
#[derive(Clone)]
pub(in crate::csg) struct Surface {
    field: Arc<Tape>,
    /// From where the surface is now to the coordinates of the field.
    into: Affine3,
    /// How far triangles that stand for it may be away from it.
    pub(super) tolerance: f64,
}

impl Surface {
    /// The surface of a field where the field is.
    pub(super) fn new(field: Tape, tolerance: f64) -> Surface {
        Surface { field: Arc::new(field), into: Affine3::IDENTITY, tolerance }
    }

    fn moved(&self, map: &Affine3) -> Surface {
        Surface {
            field: self.field.clone(),
            into: self.into * map.inverse(),
            tolerance: self.tolerance * greatest_stretch(map.matrix3),
        }
    }

    /// The value of the field and its gradient.
    pub(super) fn gradient(&self, point: Vec3) -> (f64, Vec3) {
        let (value, gradient) = self.field.gradient(self.into.transform_point3(point));
        (value, self.into.matrix3.transpose() * gradient)
    }

    /// About how far a point is away, by value and slope.
    pub(super) fn distance(&self, point: Vec3) -> f64 {
        let (value, gradient) = self.gradient(point);
        (value / gradient.length()).abs()
    }
}

/// Marks triangles that are flat by themselves.
pub(super) const FLAT: u32 = u32::MAX;

/// For each triangle of a part, the surface that it stands for. Empty where all triangles are flat.
#[derive(Clone, Default)]
pub(in crate::csg) struct Faces {
    pub(super) surfaces: Vec<Surface>,
    /// Indices of surfaces, or [`FLAT`].
    pub(super) of_triangle: Vec<u32>,
}

impl Faces {
    /// All of some triangles on one surface.
    pub(in crate::csg) fn on(surface: &Surface, triangles: usize) -> Faces {
        Faces { surfaces: vec![surface.clone()], of_triangle: vec![0; triangles] }
    }

    /// Whether no triangle stands for a curved surface.
    pub(in crate::csg) fn is_flat(&self) -> bool {
        self.surfaces.is_empty()
    }

    /// The same under a map that can be undone.
    pub(in crate::csg) fn moved(&self, map: &Affine3) -> Faces {
        let surfaces = self.surfaces.iter().map(|surface| surface.moved(map)).collect();
        Faces { surfaces, of_triangle: self.of_triangle.clone() }
    }

    /// The faces of several parts in one list of surfaces, with the number of the first of each part in it.
    fn joined(parts: &[&Faces]) -> (Faces, Vec<u32>) {
        let (mut all, mut first) = (Faces::default(), Vec::with_capacity(parts.len()));
        for part in parts {
            first.push(all.surfaces.len() as u32);
            all.surfaces.extend(part.surfaces.iter().cloned());
        }
        (all, first)
    }

    /// The faces of a result, each triangle of which comes from one of a part.
    pub(in crate::csg) fn chosen(parts: &[&Faces], births: impl Iterator<Item = [usize; 2]>) -> Faces {
        let (mut all, first) = Faces::joined(parts);
        if !all.surfaces.is_empty() {
            let of = |[part, triangle]: [usize; 2]| match parts[part].of_triangle.get(triangle) {
                None | Some(&FLAT) => FLAT,
                Some(&surface) => first[part] + surface,
            };
            all.of_triangle = births.map(of).collect();
        }
        all
    }
}
