//! The recipe of a shape, and its cooking.
//!
//! A [`Csg`] says how a shape is made; it holds no mesh it has cooked. Recipes are shared freely (`Arc`), compare by
//! value, and know whether they describe a plane region or a solid.

mod arena;
mod bounds;
mod build;
mod explain;
mod field;
mod flat;
mod frame;
mod leaf;
mod parametric;
mod plan;
mod print;
mod solve;
mod surface;

pub use bounds::bounds;
pub use build::{
    BuildError, BuildOptions, Built, Color, Note, Progress, Report, Shape, Stage, build, build_with_progress,
};
pub use explain::explain;
pub use field::{FieldBody, FieldShape, Formula, Meshing, Offset, Seams};
pub use parametric::Parametric;
pub use print::print;
pub use surface::{Explicit, SurfaceBody};

use crate::boolean::Op;
use crate::math::{Affine3, Vec2, Vec3};
use crate::mesh::Mesh;
use crate::sdf::Blend;
use std::sync::Arc;

pub use crate::tessellate::{LinearSweep, RotateSweep};

/// How a shape is made.
#[derive(Clone, Debug, PartialEq)]
pub enum Csg {
    /// Nothing at all, of no dimension: what an empty `union()` is.
    Nothing,
    /// A leaf in the plane.
    Flat(Flat),
    /// A leaf in space.
    Body(Body),
    /// The child moved by an affine map. Of a plane region, the map's part in x and y is taken.
    Transform {
        /// Result from child.
        map: Affine3,
        /// What is moved.
        child: Arc<Csg>,
    },
    /// The child with a colour, for pictures and formats that have it.
    Color {
        /// Red, green, blue and opacity, each from 0 to 1.
        color: [f32; 4],
        /// What is coloured.
        child: Arc<Csg>,
    },
    /// A boolean of children of one dimension.
    Combine {
        /// The operation.
        op: Op,
        /// Its operands, in order.
        children: Vec<Arc<Csg>>,
    },
    /// The convex hull of all children together.
    Hull {
        /// What is wrapped.
        children: Vec<Arc<Csg>>,
    },
    /// A plane region swept along a straight line.
    LinearExtrude {
        /// How.
        sweep: LinearSweep,
        /// The region.
        child: Arc<Csg>,
    },
    /// A plane region turned about the y axis, which then becomes the z axis.
    RotateExtrude {
        /// How.
        sweep: RotateSweep,
        /// The region; it must not cross x = 0.
        child: Arc<Csg>,
    },
    /// A boolean of solids with the edges between them filled or rounded.
    Blend {
        /// The operation.
        op: Op,
        /// How edges are filled; its size is not negative.
        blend: Blend,
        /// Greatest distance between the mesh and the surface, either way.
        tolerance: f64,
        /// Its operands, in order.
        children: Vec<Arc<Csg>>,
    },
    /// A solid with its surface moved, made a wall, or rounded.
    Offset {
        /// What is done to it.
        how: Offset,
        /// Greatest distance between the mesh and the surface, either way.
        tolerance: f64,
        /// The solid.
        child: Arc<Csg>,
    },
}

/// A leaf in the plane.
#[derive(Clone, Debug, PartialEq)]
pub enum Flat {
    /// The rectangle between two corners.
    Rectangle {
        /// Smallest coordinates.
        min: Vec2,
        /// Largest coordinates.
        max: Vec2,
    },
    /// A regular polygon about the origin with its first vertex on the x axis.
    Circle {
        /// Distance of the vertices from the origin.
        radius: f64,
        /// Number of vertices, at least 3.
        fragments: u32,
    },
    /// Contours filled by the even-odd rule.
    Polygon {
        /// Closed contours in any direction.
        contours: Arc<Vec<Vec<Vec2>>>,
    },
}

/// A leaf in space.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// The box between two corners.
    Cuboid {
        /// Smallest coordinates.
        min: Vec3,
        /// Largest coordinates.
        max: Vec3,
    },
    /// Rings of latitude about the z axis at half-step angles, as OpenSCAD's `sphere` makes them: no pole vertices.
    Sphere {
        /// Distance of the vertices from the origin.
        radius: f64,
        /// Number of vertices a ring, at least 3; there are (n + 1) / 2 rings.
        fragments: u32,
    },
    /// A cylinder or cone about the z axis between two heights.
    Frustum {
        /// Heights of the two ends, the lower one first.
        heights: [f64; 2],
        /// Radii of the two ends; one of them may be 0.
        radii: [f64; 2],
        /// Number of vertices a ring, at least 3.
        fragments: u32,
    },
    /// Triangles from a polyhedron or a file, closed as a chain.
    Mesh(Arc<Mesh>),
    /// A surface with its boundary closed, or a thickness.
    Surface(Arc<SurfaceBody>),
    /// The inside of a field.
    Field(Arc<FieldBody>),
}

/// Whether a recipe describes a region of the plane or a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// A plane region.
    Two,
    /// A solid.
    Three,
}

impl Csg {
    /// The dimension of the shape; `None` where there is no leaf. Of mixed children the first one decides.
    pub fn dimension(&self) -> Option<Dimension> {
        arena::Arena::new(self).root().dimension
    }

    /// The recipes this one is made of.
    pub fn children(&self) -> &[Arc<Csg>] {
        match self {
            Csg::Nothing | Csg::Flat(_) | Csg::Body(_) => &[],
            Csg::Transform { child, .. }
            | Csg::Color { child, .. }
            | Csg::LinearExtrude { child, .. }
            | Csg::RotateExtrude { child, .. }
            | Csg::Offset { child, .. } => std::slice::from_ref(child),
            Csg::Combine { children, .. } | Csg::Hull { children } | Csg::Blend { children, .. } => children,
        }
    }

    /// Takes out the children whose own children might be theirs alone.
    fn take_children(&mut self) -> Vec<Arc<Csg>> {
        match self {
            Csg::Nothing | Csg::Flat(_) | Csg::Body(_) => Vec::new(),
            Csg::Transform { child, .. }
            | Csg::Color { child, .. }
            | Csg::LinearExtrude { child, .. }
            | Csg::RotateExtrude { child, .. }
            | Csg::Offset { child, .. } => {
                let is_chain = Arc::get_mut(child).is_some_and(|child| !child.children().is_empty());
                if is_chain { vec![std::mem::replace(child, Arc::new(Csg::Nothing))] } else { Vec::new() }
            }
            Csg::Combine { children, .. } | Csg::Hull { children } | Csg::Blend { children, .. } => {
                std::mem::take(children)
            }
        }
    }
}

/// Recipes may be nested deeper than the stack allows a drop to be.
impl Drop for Csg {
    fn drop(&mut self) {
        let mut pending = self.take_children();
        while let Some(child) = pending.pop() {
            if let Some(mut child) = Arc::into_inner(child) {
                pending.append(&mut child.take_children());
            }
        }
    }
}
