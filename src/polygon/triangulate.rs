//! Triangulation of polygons and regions, by the constrained Delaunay triangulation of the `spade` crate.
//!
//! Whether a triangle belongs to the inside is decided by counting how often the contours wind around it, so the order
//! and the nesting of contours do not matter; all signs are exact.

use super::Region;
use crate::math::Vec2;
use crate::numeric::{Unfit, fitted};
use spade::handles::{FixedDirectedEdgeHandle, FixedVertexHandle};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::fmt;

/// Why a polygon has no triangulation. Vertices count from 0 through all contours, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriangulationError {
    /// A contour with fewer than three vertices.
    TooFew {
        /// How many there are.
        vertices: usize,
    },
    /// A coordinate that is NaN or infinite.
    NonFinite {
        /// Its vertex.
        vertex: usize,
    },
    /// A coordinate so much smaller than the largest one (1e-100 times) that exact signs would underflow.
    Range {
        /// Its vertex.
        vertex: usize,
    },
    /// An edge of no length.
    RepeatedVertex {
        /// Where it starts.
        vertex: usize,
    },
    /// An edge that crosses another one, runs along it the same way, or passes through a vertex.
    Crossing {
        /// Where the edge starts.
        vertex: usize,
    },
    /// The contours wind around some place twice, or around different places in different directions; or they
    /// enclose nothing.
    Winding,
}

impl fmt::Display for TriangulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TriangulationError::TooFew { vertices } => write!(f, "a contour has {vertices} vertices"),
            TriangulationError::NonFinite { vertex } => write!(f, "vertex {vertex} is not finite"),
            TriangulationError::Range { vertex } => {
                write!(f, "vertex {vertex} has a coordinate too small beside the others")
            }
            TriangulationError::RepeatedVertex { vertex } => {
                write!(f, "vertex {vertex} is at the same place as the next one")
            }
            TriangulationError::Crossing { vertex } => {
                write!(f, "the edge from vertex {vertex} meets another edge or vertex")
            }
            TriangulationError::Winding => f.write_str("the contours overlap, disagree or enclose nothing"),
        }
    }
}

impl std::error::Error for TriangulationError {}

/// Triangulates one polygon, convex or not, in either direction; triangles index `points` and run the way it does.
///
/// The polygon may touch itself at vertices and along edges that it follows once each way: a bridge to a hole, or a
/// spike, which has no triangles where it lies outside. Where several vertices are at one place, each part of the inside
/// there uses one of them.
///
/// # Errors
/// [`TriangulationError`] when the polygon is not simple, apart from such contacts.
pub fn simple(points: &[Vec2]) -> Result<Vec<[u32; 3]>, TriangulationError> {
    let mut edges = Vec::with_capacity(points.len());
    push_contour(&mut edges, 0, points.len())?;
    let rounded_area: f64 = edges.iter().map(|e| points[e[0] as usize].perp_dot(points[e[1] as usize])).sum();
    // The rounded area only says which direction to try first.
    let mut reversed = rounded_area < 0.0;
    loop {
        let edges: Vec<[u32; 2]> =
            edges.iter().map(|&[a, b]| if reversed { [b, a] } else { [a, b] }).collect();
        let arrangement = Arrangement::new(points, &edges)?;
        let inside = arrangement.inside()?;
        if inside.sign == 1 {
            let mut triangles = arrangement.triangles(&edges, &inside.faces);
            if reversed {
                triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
            }
            return Ok(triangles);
        }
        reversed = !reversed;
    }
}

/// Triangulates a region: the vertices of its contours in order, and counter-clockwise triangles over them. Every edge
/// of a contour is an edge of the result, between the same two places.
///
/// Where contours touch, each part of the inside around that place has a vertex of its own, so the result is a
/// manifold with border: at every vertex there is one fan of triangles between two border edges.
///
/// # Errors
/// [`TriangulationError::Range`] for coordinates too far apart in size; other errors tell of a region that does not
/// keep its promises.
pub fn region(region: &Region) -> Result<(Vec<Vec2>, Vec<[u32; 3]>), TriangulationError> {
    let points: Vec<Vec2> = region.contours().iter().flatten().copied().collect();
    let mut edges = Vec::with_capacity(points.len());
    for contour in region.contours() {
        let first = edges.len();
        push_contour(&mut edges, first, contour.len())?;
    }
    if points.is_empty() {
        return Ok(Default::default());
    }
    let arrangement = Arrangement::new(&points, &edges)?;
    let inside = arrangement.inside()?;
    if inside.sign != 1 {
        return Err(TriangulationError::Winding);
    }
    let triangles = arrangement.triangles(&edges, &inside.faces);
    Ok((points, triangles))
}

/// Triangulates a strictly convex polygon by cutting off every other corner, round after round, so that no corner
/// collects many triangles.
pub fn convex(mut corners: Vec<u32>) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(corners.len());
    while corners.len() >= 3 {
        let corner = |i: usize| corners[i % corners.len()];
        let ears = (0..corners.len() - 1).step_by(2);
        triangles.extend(ears.map(|i| [corner(i), corner(i + 1), corner(i + 2)]));
        corners = corners.iter().copied().step_by(2).collect();
    }
    triangles
}

/// Appends the edges of a closed contour of `count` vertices that start at `first`.
fn push_contour(edges: &mut Vec<[u32; 2]>, first: usize, count: usize) -> Result<(), TriangulationError> {
    if count < 3 {
        return Err(TriangulationError::TooFew { vertices: count });
    }
    let vertex = |i: usize| (first + i % count) as u32;
    edges.extend((0..count).map(|i| [vertex(i), vertex(i + 1)]));
    Ok(())
}

type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// A triangulation of the convex hull of all places, with the edges of the contours in it.
struct Arrangement {
    delaunay: Delaunay,
    /// For each directed edge of `delaunay`, the contour edge that runs along it the same way.
    contour_edge: Vec<u32>,
}

const NONE: u32 = u32::MAX;

/// The faces enclosed, by index, and whether the contours run around them counter-clockwise (1) or clockwise (-1).
struct Inside {
    sign: i32,
    faces: Vec<bool>,
}

impl Arrangement {
    /// `edges` in the order of the contours' vertices, all turned round or none.
    fn new(points: &[Vec2], edges: &[[u32; 2]]) -> Result<Arrangement, TriangulationError> {
        let (places, place_of) = places(&scaled(points)?);
        let mut delaunay = Delaunay::try_bulk_load_cdt(places, Vec::new(), |_| ())
            .expect("fitted coordinates are in the range of spade");
        let mut handles: Vec<(FixedDirectedEdgeHandle, u32)> = Vec::with_capacity(edges.len());
        for (vertex, edge) in edges.iter().enumerate() {
            let [from, to] = edge.map(|v| FixedVertexHandle::from_index(place_of[v as usize] as usize));
            if from == to {
                return Err(TriangulationError::RepeatedVertex { vertex });
            }
            match delaunay.try_add_constraint(from, to)[..] {
                [handle] => handles.push((handle, vertex as u32)),
                _ => return Err(TriangulationError::Crossing { vertex }),
            }
        }
        let mut contour_edge = vec![NONE; delaunay.num_directed_edges()];
        for (handle, vertex) in handles {
            let slot = &mut contour_edge[handle.index()];
            if *slot != NONE {
                return Err(TriangulationError::Crossing { vertex: vertex as usize });
            }
            *slot = vertex;
        }
        Ok(Arrangement { delaunay, contour_edge })
    }

    fn inside(&self) -> Result<Inside, TriangulationError> {
        let windings = self.windings();
        let sign = windings.iter().copied().find(|&w| w != 0).ok_or(TriangulationError::Winding)?;
        if sign.abs() != 1 || windings.iter().any(|&w| w != 0 && w != sign) {
            return Err(TriangulationError::Winding);
        }
        Ok(Inside { sign, faces: windings.iter().map(|&w| w != 0).collect() })
    }

    /// How often the contours run around each face counter-clockwise, found by walking from face to face.
    fn windings(&self) -> Vec<i32> {
        let outer = self.delaunay.outer_face().index();
        let mut windings = vec![0; self.delaunay.num_all_faces()];
        let mut seen = vec![false; windings.len()];
        seen[outer] = true;
        // Each edge on the stack has its right side known.
        let mut stack: Vec<FixedDirectedEdgeHandle> =
            self.delaunay.convex_hull().map(|edge| edge.rev().fix()).collect();
        while let Some(handle) = stack.pop() {
            let edge = self.delaunay.directed_edge(handle);
            let (face, beyond) = (edge.face(), edge.rev().face().index());
            if std::mem::replace(&mut seen[face.index()], true) {
                continue;
            }
            windings[face.index()] =
                windings[beyond] + self.runs_along(handle) - self.runs_along(handle.rev());
            stack.extend([edge.next().fix().rev(), edge.prev().fix().rev()]);
        }
        windings
    }

    fn runs_along(&self, edge: FixedDirectedEdgeHandle) -> i32 {
        i32::from(self.contour_edge[edge.index()] != NONE)
    }

    /// The inside faces over the vertices of the contours, each part of the inside around a place with one vertex:
    /// the start of the contour edge that bounds it on the right.
    fn triangles(&self, edges: &[[u32; 2]], inside: &[bool]) -> Vec<[u32; 3]> {
        let mut origin = vec![NONE; self.contour_edge.len()];
        for edge in self.delaunay.directed_edges() {
            let contour_edge = self.contour_edge[edge.fix().index()];
            if contour_edge == NONE {
                continue;
            }
            let mut spoke = edge;
            loop {
                origin[spoke.fix().index()] = edges[contour_edge as usize][0];
                spoke = spoke.ccw();
                if self.contour_edge[spoke.rev().fix().index()] != NONE {
                    break;
                }
            }
        }
        let faces = self.delaunay.inner_faces().filter(|face| inside[face.index()]);
        faces.map(|face| face.adjacent_edges().map(|edge| origin[edge.fix().index()])).collect()
    }
}

/// The points at the scale at which spade's predicates are exact; its range is the same as theirs.
fn scaled(points: &[Vec2]) -> Result<Vec<Vec2>, TriangulationError> {
    let coordinates: Vec<[f64; 2]> = points.iter().map(Vec2::to_array).collect();
    match fitted(&coordinates) {
        Ok(fitted) => Ok(fitted.into_iter().map(Vec2::from).collect()),
        Err(Unfit::NonFinite { point }) => Err(TriangulationError::NonFinite { vertex: point }),
        Err(Unfit::Range { point }) => Err(TriangulationError::Range { vertex: point }),
    }
}

/// The different places among `points`, in order of first appearance, and the place of each point.
fn places(points: &[Vec2]) -> (Vec<Point2<f64>>, Vec<u32>) {
    // Adding zero turns -0 into 0, so that equal coordinates compare equal.
    let key = |i: u32| points[i as usize] + Vec2::ZERO;
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by(|&a, &b| {
        let (p, q) = (key(a), key(b));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(a.cmp(&b))
    });
    let mut first_at = vec![0_u32; points.len()];
    for group in order.chunk_by(|&a, &b| key(a) == key(b)) {
        for &point in group {
            first_at[point as usize] = group[0];
        }
    }
    let mut places = Vec::with_capacity(points.len());
    let mut place_of = vec![0_u32; points.len()];
    for (i, &first) in first_at.iter().enumerate() {
        if first as usize == i {
            place_of[i] = places.len() as u32;
            places.push(Point2::new(key(i as u32).x, key(i as u32).y));
        } else {
            place_of[i] = place_of[first as usize];
        }
    }
    (places, place_of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Affine2, sin_cos};
    use proptest::prelude::*;

    fn points(list: &[(f64, f64)]) -> Vec<Vec2> {
        list.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    fn twice_area(points: &[Vec2], triangles: &[[u32; 3]]) -> f64 {
        let corner = |t: &[u32; 3], i: usize| points[t[i] as usize];
        triangles.iter().map(|t| (corner(t, 1) - corner(t, 0)).perp_dot(corner(t, 2) - corner(t, 0))).sum()
    }

    /// Border edges of the triangles, sorted: those without an opposite.
    fn border(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        let mut edges: Vec<[u32; 2]> =
            triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        edges.sort_unstable();
        let opposite = |e: &[u32; 2]| edges.binary_search(&[e[1], e[0]]).is_ok();
        edges.iter().filter(|e| !opposite(e)).copied().collect()
    }

    fn contour_edges(first: u32, count: u32) -> Vec<[u32; 2]> {
        (0..count).map(|i| [first + i, first + (i + 1) % count]).collect()
    }

    #[test]
    fn a_concave_polygon_in_both_directions() {
        let mut l = points(&[(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)]);
        let triangles = simple(&l).unwrap();
        assert_eq!(triangles.len(), 4);
        assert_eq!(twice_area(&l, &triangles), 6.0);
        assert_eq!(border(&triangles).len(), 6);
        l.reverse();
        let triangles = simple(&l).unwrap();
        assert_eq!(twice_area(&l, &triangles), -6.0);
        assert_eq!(border(&triangles), {
            let mut e = contour_edges(0, 6);
            e.sort_unstable();
            e
        });
    }

    #[test]
    fn a_bridge_to_a_hole() {
        let keyhole = points(&[
            (0., 0.),
            (4., 0.),
            (4., 4.),
            (0., 4.),
            (0., 0.),
            (1., 1.),
            (1., 3.),
            (3., 3.),
            (3., 1.),
            (1., 1.),
        ]);
        let triangles = simple(&keyhole).unwrap();
        assert_eq!(twice_area(&keyhole, &triangles), 24.0);
        assert_eq!(triangles.len(), 8);
        assert_eq!(border(&triangles).len(), 10);
    }

    #[test]
    fn what_is_not_simple_is_an_error() {
        let cases = [
            (points(&[(0., 0.), (1., 0.)]), TriangulationError::TooFew { vertices: 2 }),
            (points(&[(0., 0.), (1., 1.), (1., 0.), (0., 1.)]), TriangulationError::Crossing { vertex: 2 }),
            (
                points(&[(0., 0.), (1., 0.), (1., 0.), (0., 1.)]),
                TriangulationError::RepeatedVertex { vertex: 1 },
            ),
            (points(&[(0., 0.), (2., 0.), (1., 0.)]), TriangulationError::Crossing { vertex: 0 }),
            (points(&[(0., 0.), (1., 0.), (f64::NAN, 1.)]), TriangulationError::NonFinite { vertex: 2 }),
            (
                points(&[(0., 0.), (2., 0.), (2., 2.), (1., 0.), (0., 2.)]),
                TriangulationError::Crossing { vertex: 0 },
            ),
            (points(&[(0., 0.), (1e-200, 0.), (1., 1.)]), TriangulationError::Range { vertex: 1 }),
            // Two lobes that touch at a vertex and turn different ways.
            (
                points(&[(0., 0.), (2., -1.), (2., 1.), (0., 0.), (-2., -1.), (-2., 1.)]),
                TriangulationError::Winding,
            ),
            // The same triangle twice.
            (
                points(&[(0., 0.), (1., 0.), (0., 1.), (0., 0.), (1., 0.), (0., 1.)]),
                TriangulationError::Crossing { vertex: 3 },
            ),
        ];
        for (polygon, expected) in cases {
            assert_eq!(simple(&polygon), Err(expected), "{polygon:?}");
        }
    }

    #[test]
    fn sizes_at_the_ends_of_the_range() {
        for size in [1e-300, 1e-150, 1.0, 1e150, 1e308] {
            let square = points(&[(0., 0.), (size, 0.), (size, size), (0., size)]);
            assert_eq!(simple(&square).unwrap().len(), 2, "{size}");
        }
    }

    #[test]
    fn touching_contours_have_vertices_of_their_own() {
        // Two squares that share a corner, and a hole in one of them that touches the border at a vertex.
        let contours = vec![
            points(&[(0., 0.), (4., 0.), (4., 4.), (2., 4.), (0., 4.)]),
            points(&[(4., 4.), (6., 4.), (6., 6.), (4., 6.)]),
            points(&[(2., 4.), (3., 2.), (1., 2.)]),
        ];
        let touching = Region::assume(contours);
        let (points, triangles) = region(&touching).unwrap();
        assert_eq!(points.len(), 12);
        assert_eq!(0.5 * twice_area(&points, &triangles), touching.area());
        let border = border(&triangles);
        assert_eq!(border.len(), 12);
        let mut starts: Vec<u32> = border.iter().map(|e| e[0]).collect();
        starts.dedup();
        assert_eq!(starts.len(), 12, "every vertex is on the border once");
    }

    #[test]
    fn a_region_that_breaks_its_promise_is_an_error() {
        let clockwise = Region::assume(vec![points(&[(0., 0.), (0., 1.), (1., 0.)])]);
        assert_eq!(region(&clockwise), Err(TriangulationError::Winding));
        assert_eq!(region(&Region::default()).unwrap(), Default::default());
    }

    proptest! {
        /// Stars about the origin are simple whatever their radii.
        #[test]
        fn stars(radii in prop::collection::vec(0.01..10.0_f64, 3..60), turn in 0.0..7.0_f64, flip: bool) {
            let step = std::f64::consts::TAU / radii.len() as f64;
            let map = Affine2::from_angle(turn);
            let mut star: Vec<Vec2> = radii.iter().enumerate().map(|(i, r)| {
                let (sin, cos) = sin_cos(i as f64 * step);
                map.transform_point2(Vec2::new(r * cos, r * sin))
            }).collect();
            if flip { star.reverse(); }
            let triangles = simple(&star).unwrap();
            prop_assert_eq!(triangles.len(), star.len() - 2);
            let mut expected = contour_edges(0, star.len() as u32);
            expected.sort_unstable();
            prop_assert_eq!(border(&triangles), expected);
        }

        /// Anything at all gives triangles that cover it or an error.
        #[test]
        fn anything(raw in prop::collection::vec((-3..4_i32, -3..4_i32), 0..12)) {
            let polygon: Vec<Vec2> = raw.iter().map(|&(x, y)| Vec2::new(x.into(), y.into())).collect();
            if let Ok(triangles) = simple(&polygon) {
                let area: f64 = (0..polygon.len()).map(|i| polygon[i].perp_dot(polygon[(i + 1) % polygon.len()])).sum();
                prop_assert_eq!(twice_area(&polygon, &triangles), area);
                prop_assert!(triangles.len() <= polygon.len() - 2);
            }
        }
    }
}
