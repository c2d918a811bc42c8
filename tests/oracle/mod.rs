//! A slow judge of booleans: exact rational arithmetic and the simplest method that is certain.
//!
//! 1. All planes on which triangles lie are found; each is cut by all others into convex cells.
//! 2. For each cell, the winding number of each operand on either side of it is found by an exact ray.
//! 3. The cells at which the expression changes are the surface of the result. As every plane cuts everywhere,
//!    cells meet side to side.
//! 4. Around each edge, cells that bound one wedge of the solid are sewn together; union-find then gives the
//!    components and the copies of the vertices.
//!
//! It costs the cube of the number of planes. It shares no code and no method with the kernel.

mod arrange;
pub(crate) mod exact;
pub(crate) mod random;
pub(crate) mod surface;
mod triangles;
mod winding;

use arrange::Scene;
use dashu_int::ops::UnsignedAbs;
use dashu_ratio::RBig;
use exact::{Int, Lattice, sum};
use ogee::boolean::{Op, Tree};
use ogee::math::Vec3;
use ogee::mesh::Mesh;
use surface::{Face, Surface, pyramids};

/// What is true of a result.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Truth {
    pub(crate) volume: RBig,
    /// Surface area; square roots make it inexact.
    pub(crate) area: f64,
    /// The components of the surface, wedges separated, in no order that means anything.
    pub(crate) components: Vec<Component>,
    /// The points of the arrangement on the surface, with whether they are corners of it.
    pub(crate) points: Vec<([RBig; 3], bool)>,
    /// The sides of cells at which the surface bends or wedges touch.
    pub(crate) edges: Vec<[Vec3; 2]>,
}

/// A connected piece of a surface. A cavity is one, with negative volume.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Component {
    pub(crate) euler: i64,
    pub(crate) volume: RBig,
}

impl Truth {
    /// Handles and tunnels, summed over the components.
    pub(crate) fn genus(&self) -> i64 {
        self.components.iter().map(|c| 1 - c.euler / 2).sum()
    }

    pub(crate) fn volume_f64(&self) -> f64 {
        self.volume.to_f64().value()
    }

    /// Whether `f64` holds every point of the arrangement on the surface.
    pub(crate) fn is_representable(&self) -> bool {
        let holds = |x: &RBig| RBig::try_from(x.to_f64().value()).as_ref() == Ok(x);
        self.points.iter().all(|(point, _)| point.iter().all(holds))
    }
}

/// Evaluates `tree` over closed meshes with finite coordinates. A point is inside an operand where its winding
/// number is at least one.
pub(crate) fn evaluate(tree: &Tree, operands: &[&Mesh]) -> Truth {
    let (lattice, scene) = scene_of(operands);
    measure(lattice, &scene, &surface(tree, &scene))
}

/// The result itself, finely cut, with rounded positions: a kernel that is slow but right.
pub(crate) fn mesh(tree: &Tree, operands: &[&Mesh]) -> Mesh {
    let (lattice, scene) = scene_of(operands);
    let surface = surface(tree, &scene);
    let positions: Vec<Vec3> = points(lattice, &surface).iter().map(rounded).collect();
    triangles::triangulated(&surface, &scene.planes, &positions)
}

fn scene_of(operands: &[&Mesh]) -> (Lattice, Scene) {
    let lattice = Lattice::holding(operands.iter().flat_map(|mesh| &mesh.positions));
    (lattice, Scene::new(lattice, operands))
}

/// The cells at which the expression changes.
fn surface(tree: &Tree, scene: &Scene) -> Surface {
    let mut caster = winding::Caster::new(scene);
    Surface::new(scene.cells().into_iter().filter_map(|cell| {
        let front = caster.in_front(&cell);
        let inside_front = holds(tree, &|i| front[i] >= 1);
        let inside_back = holds(tree, &|i| front[i] + cell.step[i] >= 1);
        (inside_front != inside_back).then_some((cell.plane, cell.polygon, inside_front))
    }))
}

/// Whether the expression holds where `inside` says which operands a point is in.
pub(crate) fn holds(tree: &Tree, inside: &impl Fn(usize) -> bool) -> bool {
    match tree {
        Tree::Leaf(index) => inside(*index),
        Tree::Node(op, children) => {
            let mut held = children.iter().map(|child| holds(child, inside));
            match op {
                Op::Union => held.any(|h| h),
                Op::Intersection => !children.is_empty() && held.all(|h| h),
                Op::Difference => held.next().unwrap_or(false) && !held.any(|h| h),
                Op::SymmetricDifference => held.filter(|&h| h).count() % 2 == 1,
            }
        }
        Tree::AtLeast(least, children) => {
            *least > 0 && children.iter().filter(|child| holds(child, inside)).count() >= *least as usize
        }
    }
}

fn measure(lattice: Lattice, scene: &Scene, surface: &Surface) -> Truth {
    let sewn = surface.sew(&scene.planes);
    let mut terms: Vec<Vec<RBig>> = vec![Vec::new(); sewn.euler.len()];
    for (face, &component) in surface.faces.iter().zip(&sewn.component) {
        let pieces = pyramids(&surface.points, face);
        terms[component]
            .extend(pieces.map(|(six, w)| RBig::from_parts(six, (w * Int::from(6)).unsigned_abs())));
    }
    let volumes = terms.into_iter().map(|terms| lattice.value(sum(terms), 3));
    let components: Vec<Component> =
        sewn.euler.iter().zip(volumes).map(|(&euler, volume)| Component { euler, volume }).collect();
    let points = points(lattice, surface);
    let positions: Vec<Vec3> = points.iter().map(rounded).collect();
    let plane = |side: surface::Side| surface.faces[side.face].plane;
    let edges = sewn.seams.iter().filter(|seam| seam.shared || plane(seam.forward) != plane(seam.backward));
    Truth {
        volume: sum(components.iter().map(|c| c.volume.clone()).collect()),
        area: surface.faces.iter().map(|face| area(&positions, face)).sum(),
        components,
        edges: edges.map(|seam| surface.joined(seam.forward).map(|p| positions[p])).collect(),
        points: points.into_iter().zip(sewn.is_corner).collect(),
    }
}

fn points(lattice: Lattice, surface: &Surface) -> Vec<[RBig; 3]> {
    surface.points.iter().map(|p| p.coordinates().map(|x| lattice.value(x, 1))).collect()
}

/// The nearest `f64` point.
pub(crate) fn rounded(point: &[RBig; 3]) -> Vec3 {
    let [x, y, z] = point;
    Vec3::new(x.to_f64().value(), y.to_f64().value(), z.to_f64().value())
}

fn area(positions: &[Vec3], face: &Face) -> f64 {
    let origin = positions[face.corners[0]];
    let spans = face.corners[1..].windows(2);
    0.5 * spans
        .map(|e| (positions[e[0]] - origin).cross(positions[e[1]] - origin))
        .fold(Vec3::ZERO, |total, part| total + part)
        .length()
}
