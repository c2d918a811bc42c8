//! Triangle meshes: the open record [`Mesh`], the checked promise [`Solid`], connectivity without positions
//! ([`Topology`]), and what can be asked of them.

mod crossing;
mod defects;
mod exact;
mod measure;
mod primitive;
mod solid;
mod topology;

pub use crossing::crossing_pairs;
pub use defects::Defects;
pub(crate) use defects::fans;
pub(crate) use exact::{Exact, Unmended};
pub use measure::{Measures, area, components, volume};
pub use primitive::{TooLarge, cuboid, frustum, frustum_triangles, sphere, sphere_triangles};
pub use solid::Solid;
pub use topology::Topology;

use crate::math::{Aabb, Vec3};

/// Any triangles at all: what files hold and what comes before a check.
///
/// Triangles index `positions` from 0 and run counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions, in model units.
    pub positions: Vec<Vec3>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A mesh from its parts; nothing is checked.
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
        Mesh { positions, triangles }
    }

    /// The three corners of triangle `index`.
    #[inline]
    pub fn corners(&self, index: usize) -> [Vec3; 3] {
        let [a, b, c] = self.triangles[index];
        [self.positions[a as usize], self.positions[b as usize], self.positions[c as usize]]
    }

    /// The smallest box around all positions.
    pub fn bounds(&self) -> Aabb {
        Aabb::of(self.positions.iter().copied())
    }

    /// Whether there is no triangle.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Appends the vertices and triangles of `other`, unconnected to what is there.
    pub fn append(&mut self, other: &Mesh) {
        let base = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + base)));
    }

    /// The same surface with inside and outside swapped.
    pub fn flipped(mut self) -> Mesh {
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
        self
    }
}
