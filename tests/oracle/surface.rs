//! The kept cells sewn together: each solid wedge has its own copy of an edge, each fan its own copy of a vertex.

use super::exact::{Int, Int3, Plane, Point, cross, dot, negate, sign};
use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};

/// A cell of the result, counter-clockwise seen from outside.
pub(crate) struct Face {
    pub(crate) plane: usize,
    /// Indices of points.
    pub(crate) corners: Vec<usize>,
    /// Whether the outward normal is the opposite of the plane's.
    pub(crate) turned: bool,
}

/// Faces, and which sides of them are sewn.
pub(crate) struct Surface {
    pub(crate) points: Vec<Point>,
    pub(crate) faces: Vec<Face>,
}

/// What sewing found.
pub(crate) struct Sewn {
    /// For each face the number of its component.
    pub(crate) component: Vec<usize>,
    /// For each corner of each face, in order, the vertex it is: points have one for each fan of faces.
    pub(crate) vertex: Vec<usize>,
    /// For each component vertices minus edges plus faces.
    pub(crate) euler: Vec<i64>,
    /// Whether some copy of the point turns between three planes or more: it is a corner, not only a place where
    /// cells meet.
    pub(crate) is_corner: Vec<bool>,
    pub(crate) seams: Vec<Seam>,
}

/// Two sides that belong together: one wedge of the solid lies between their faces.
#[derive(Clone, Copy)]
pub(crate) struct Seam {
    pub(crate) forward: Side,
    pub(crate) backward: Side,
    /// Whether other wedges touch the same edge.
    pub(crate) shared: bool,
}

/// A side of a face: from corner `index` to the next one.
#[derive(Clone, Copy)]
pub(crate) struct Side {
    pub(crate) face: usize,
    pub(crate) index: usize,
    /// Whether it runs from the lower point to the higher one.
    forward: bool,
}

impl Surface {
    pub(crate) fn new(cells: impl Iterator<Item = (usize, Vec<Point>, bool)>) -> Surface {
        let mut index_of = HashMap::new();
        let mut surface = Surface { points: Vec::new(), faces: Vec::new() };
        for (plane, mut polygon, turned) in cells {
            if turned {
                polygon.reverse();
            }
            let corners = polygon.into_iter().map(|point| {
                *index_of.entry(point).or_insert_with_key(|point| {
                    surface.points.push(point.clone());
                    surface.points.len() - 1
                })
            });
            surface.faces.push(Face { plane, corners: corners.collect(), turned });
        }
        surface
    }

    /// Sews all sides.
    ///
    /// # Panics
    /// When the faces do not close: the oracle itself is wrong then.
    pub(crate) fn sew(&self, planes: &[Plane]) -> Sewn {
        let first_corner: Vec<usize> = self.first_corners();
        let corner_count = first_corner[self.faces.len()];
        let (mut faces, mut corners) = (Union::new(self.faces.len()), Union::new(corner_count));
        let seams = self.seams(planes);
        for &Seam { forward, backward, .. } in &seams {
            faces.join(forward.face, backward.face);
            let [a, b] = self.ends(forward, &first_corner);
            let [c, d] = self.ends(backward, &first_corner);
            corners.join(a, d);
            corners.join(b, c);
        }
        let (component, count) = faces.numbers();
        let mut euler = vec![0; count];
        component.iter().for_each(|&c| euler[c] += 1);
        seams.iter().for_each(|seam| euler[component[seam.forward.face]] -= 1);
        let (vertex, vertex_count) = corners.numbers();
        let mut planes_at: Vec<Vec<usize>> = vec![Vec::new(); vertex_count];
        let mut is_corner = vec![false; self.points.len()];
        for (index, face) in self.faces.iter().enumerate() {
            for (k, &point) in face.corners.iter().enumerate() {
                let met = &mut planes_at[vertex[first_corner[index] + k]];
                if met.is_empty() {
                    euler[component[index]] += 1;
                }
                if !met.contains(&face.plane) {
                    met.push(face.plane);
                }
                is_corner[point] |= met.len() >= 3;
            }
        }
        Sewn { component, vertex, euler, is_corner, seams }
    }

    /// Where the corners of each face begin, and their number.
    pub(crate) fn first_corners(&self) -> Vec<usize> {
        let mut total = 0;
        let mut firsts = vec![0];
        firsts.extend(self.faces.iter().map(|face| {
            total += face.corners.len();
            total
        }));
        firsts
    }

    /// The two points that a side joins.
    pub(crate) fn joined(&self, side: Side) -> [usize; 2] {
        let corners = &self.faces[side.face].corners;
        [corners[side.index], corners[(side.index + 1) % corners.len()]]
    }

    /// The two corners at the ends of a side.
    fn ends(&self, side: Side, first_corner: &[usize]) -> [usize; 2] {
        let next = (side.index + 1) % self.faces[side.face].corners.len();
        [first_corner[side.face] + side.index, first_corner[side.face] + next]
    }

    /// Pairs up the sides around each edge.
    fn seams(&self, planes: &[Plane]) -> Vec<Seam> {
        let mut edges: BTreeMap<(usize, usize), Vec<Side>> = BTreeMap::new();
        for (face, Face { corners, .. }) in self.faces.iter().enumerate() {
            for index in 0..corners.len() {
                let (from, to) = (corners[index], corners[(index + 1) % corners.len()]);
                let side = Side { face, index, forward: from < to };
                edges.entry((from.min(to), from.max(to))).or_default().push(side);
            }
        }
        let mut seams = Vec::new();
        for ((low, high), mut sides) in edges {
            let along = self.points[low].toward(&self.points[high]);
            self.sort_around(&along, &mut sides, planes);
            // Turning counter-clockwise, the solid begins at a backward side and ends at a forward one.
            let start = sides.iter().position(|s| !s.forward).expect("an edge with sides both ways");
            sides.rotate_left(start);
            let shared = sides.len() > 2;
            for wedge in sides.chunks(2) {
                let &[backward, forward] = wedge else { panic!("an odd number of faces at an edge") };
                assert!(forward.forward && !backward.forward, "faces at an edge do not alternate");
                seams.push(Seam { forward, backward, shared });
            }
        }
        seams
    }

    /// Sorts the half-planes in which the faces of an edge lie by angle about it, counter-clockwise from the first.
    fn sort_around(&self, along: &Int3, sides: &mut [Side], planes: &[Plane]) {
        if sides.len() == 2 {
            return;
        }
        // The half-plane's direction turned on by a right angle: it sorts the same, and it is known.
        let direction = |side: &Side| {
            let face = &self.faces[side.face];
            let normal = &planes[face.plane].normal;
            if face.turned == side.forward { negate(normal) } else { normal.clone() }
        };
        let origin = direction(&sides[0]);
        sides.sort_by(|a, b| compare_angles(along, &origin, &direction(a), &direction(b)));
    }
}

/// Which of two directions across `along` comes first, turning counter-clockwise about it from `origin`.
fn compare_angles(along: &Int3, origin: &Int3, a: &Int3, b: &Int3) -> Ordering {
    let turn = |p: &Int3, q: &Int3| -> i32 { sign(&dot(&cross(p, q), along)) };
    let half = |p: &Int3| match turn(origin, p) {
        0 if sign(&dot(origin, p)) > 0 => 0,
        1 => 1,
        0 => 2,
        _ => 3,
    };
    half(a).cmp(&half(b)).then_with(|| 0.cmp(&turn(a, b)))
}

/// Disjoint sets.
pub(crate) struct Union {
    parent: Vec<usize>,
}

impl Union {
    pub(crate) fn new(count: usize) -> Union {
        Union { parent: (0..count).collect() }
    }

    pub(crate) fn root(&mut self, mut item: usize) -> usize {
        while self.parent[item] != item {
            self.parent[item] = self.parent[self.parent[item]];
            item = self.parent[item];
        }
        item
    }

    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }

    /// The number of the set of each item, in order of first items, and how many sets there are.
    pub(crate) fn numbers(&mut self) -> (Vec<usize>, usize) {
        let mut number_of_root = HashMap::new();
        let roots: Vec<usize> = (0..self.parent.len()).map(|item| self.root(item)).collect();
        let numbers = roots.into_iter().map(|root| {
            let next = number_of_root.len();
            *number_of_root.entry(root).or_insert(next)
        });
        let numbers = numbers.collect();
        (numbers, number_of_root.len())
    }
}

/// Six times the volume of the pyramid from the origin over a face, in pieces.
pub(crate) fn pyramids<'a>(points: &'a [Point], face: &'a Face) -> impl Iterator<Item = (Int, Int)> + 'a {
    face.corners[1..].windows(2).map(move |edge| {
        let [a, b, c] = [&points[face.corners[0]], &points[edge[0]], &points[edge[1]]];
        (dot(&a.x, &cross(&b.x, &c.x)), &a.w * &b.w * &c.w)
    })
}
