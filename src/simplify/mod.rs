//! Fewer triangles for the same surface.
//!
//! [`to_field`] collapses edges of the mesh of an implicit surface as long as mesh and surface are proven to stay within
//! the tolerance of each other, both ways, measured to the field and not to the mesh at hand.
//!
//! # The proof
//!
//! Each vertex has a post: two points at the tolerance from it, along the field's gradient and against it. The triangles
//! between the outer ends make a surface M+, those between the inner ends M-; the space between corresponding
//! triangles is the shell of the mesh, and all of it is within the tolerance of the mesh.
//!
//! From the mesh to the surface: the field is positive on the outer side of each triangle and negative on the inner
//! one, so that it has a zero between them over each point of the mesh.
//!
//! From the surface to the mesh: M+ winds around a zero once more than M- does, and a point for which they differ
//! lies in the shell. Where that holds for the mesh at hand is found first (see `anchor`). It stays so when the star of a
//! vertex is replaced by other triangles with the same border, if the field grows along some direction all over a
//! convex cell around both and has the right signs on both sides of both stars: from a zero go against that direction, until
//! the cell is left; on the way the field is negative, so neither the old nor the new part of M+ is met, which differ
//! by a closed surface that therefore does not wind around the zero. The same goes for M-. So no error adds up, and nothing
//! needs to be known of the mesh in between.

mod anchor;
mod collapse;
mod fields;

use crate::math::Aabb;
use crate::mesh::{Mesh, Solid, crossing_pairs};
use crate::par;
use crate::sdf::{Field, Post, Shell};
use anchor::Shelled;
use collapse::Collapse;
use fields::Fields;

/// A solid with edges collapsed.
#[derive(Clone, Debug)]
pub struct Simplified {
    /// Closed, two-manifold, of the same topology, free of self-crossings when the given one is.
    pub mesh: Solid,
    /// Number of vertices that are gone.
    pub collapsed: usize,
    /// The greatest distance from the surface measured at the middles of new triangles; no bound.
    pub measured: f64,
}

/// The mesh of a field's surface with fewer triangles, still within the tolerance of it, both ways.
///
/// All of the surface that is within `tolerance` (in model units) of the given mesh is so of the new one, and the
/// other way round. What is near creases, places without a value, other sheets or the border of a box that cuts the shape
/// off stays as it is.
///
/// Vertices stay where they are or go. Triangles keep facing the way of the field's gradient, none becomes a needle that was
/// not one, topology does not change, and crossings are excluded by exact signs. The same input gives the same bits.
/// A field without ranges proves nothing, so that the solid is handed back as it is.
///
/// ```
/// use ogee::isosurface::{self, Options};
/// use ogee::sdf::{Implicit, Primitive};
/// use ogee::simplify;
///
/// let ring = Implicit::primitive(Primitive::Torus { major: 0.8, minor: 0.25 })?.tape();
/// let meshed = isosurface::mesh(&ring, &Options::new(0.005))?;
/// let fewer = simplify::to_field(&ring, &meshed.mesh, 0.005).mesh;
/// assert!(2 * fewer.triangles().len() < meshed.mesh.triangles().len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn to_field(field: &dyn Field, solid: &Solid, tolerance: f64) -> Simplified {
    let mesh = solid.mesh();
    let as_it_is = || Simplified { mesh: solid.clone(), collapsed: 0, measured: 0.0 };
    if solid.is_empty() || field.slopes(mesh.bounds()).is_none() {
        return as_it_is();
    }
    let around = triangles_around(mesh);
    let boxes: Vec<Aabb> = around.iter().map(|star| Shelled::room(mesh, star, tolerance)).collect();
    let fields = Fields::over(field, &boxes);
    let vertices: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    let posts = par::map(&vertices, |&v| {
        let cell = boxes[v as usize];
        Post::at(mesh.positions[v as usize], fields.within(v, cell), tolerance)
    });
    let mut shelled =
        Shelled { mesh, around: &around, shell: Shell::new(mesh, posts), fields: &fields, tolerance };
    let mut free = shelled.anchored();
    let posts = shelled.shell.posts();
    let mut reach = 0.0;
    while free.contains(&true) {
        let mut collapse = Collapse::new(mesh, around.clone(), posts, &fields, tolerance, &free);
        collapse.run();
        let collapsed = collapse.collapsed;
        let (fewer, changed) = collapse.finish(&mesh.triangles);
        let crossings = crossing_pairs(&fewer, &changed);
        if crossings.is_empty() {
            let measured = measured(field, &fewer, &changed);
            let Ok(found) = Solid::new(fewer) else { break };
            let mesh = Solid::assume(found.into_mesh(), solid.is_embedded());
            return Simplified { mesh, collapsed, measured };
        }
        lock(mesh, &mut free, &fewer, &crossings, reach);
        // In the end this reaches everywhere.
        reach = 2.0 * reach + tolerance;
    }
    as_it_is()
}

/// The greatest distance from the surface, by value over slope, at the middles of some triangles.
fn measured(field: &dyn Field, mesh: &Mesh, triangles: &[u32]) -> f64 {
    let distances = par::map(triangles, |&t| {
        let [a, b, c] = mesh.corners(t as usize);
        let (value, gradient) = field.gradient((a + b + c) / 3.0);
        value.abs() / gradient.length()
    });
    distances.into_iter().filter(|distance| distance.is_finite()).fold(0.0, f64::max)
}

/// The triangles at each vertex.
fn triangles_around(mesh: &Mesh) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); mesh.positions.len()];
    for (index, triangle) in (0..).zip(&mesh.triangles) {
        triangle.iter().for_each(|&id| around[id as usize].push(index));
    }
    around
}

/// Keeps all vertices that are, or were, near triangles that cross.
fn lock(mesh: &Mesh, free: &mut [bool], fewer: &Mesh, crossings: &[[u32; 2]], reach: f64) {
    for &t in crossings.as_flattened() {
        let near = anchor::grown(Aabb::around(fewer.corners(t as usize)), reach);
        let is_near = |p: &crate::math::Vec3| near.touches(Aabb { min: *p, max: *p });
        free.iter_mut().zip(&mesh.positions).filter(|(_, p)| is_near(p)).for_each(|(free, _)| *free = false);
    }
}
