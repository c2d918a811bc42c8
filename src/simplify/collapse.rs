//! Collapses of edges, the least harmful first.

use super::anchor::grown;
use super::fields::Fields;
use crate::math::{Aabb, Vec3};
use crate::mesh::Mesh;
use crate::sdf::{Local, Post, most_of_products};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Least height of a triangle over its longest side, unless those before were as flat.
const FLATTEST: f64 = 0.05;

/// Least cosine between a triangle's normal and the field's gradients at its corners.
const UPRIGHT: f64 = 0.6;

/// Most triangles at a vertex.
const MOST_AROUND: usize = 32;

/// Neighbours tried for one vertex.
const TARGETS: usize = 3;

/// What counts, beside the estimated error, for a triangle as long as the whole mesh: where the surface is flat short edges
/// go first.
const LENGTH: f64 = 1.0;

/// After a proof in vain the next is for an estimate smaller by this factor.
const PATIENCE: f64 = 0.9;

/// A mesh in which edges are being collapsed.
pub(super) struct Collapse<'a> {
    positions: &'a [Vec3],
    posts: &'a [Post],
    fields: &'a Fields<'a>,
    tolerance: f64,
    /// [`LENGTH`] over the square of the size of the mesh.
    length: f64,
    triangles: Vec<[u32; 3]>,
    alive: Vec<bool>,
    /// The triangles at each vertex.
    around: Vec<Vec<u32>>,
    vertices: Vec<Vertex>,
    /// By the bits of costs, which are not negative, and the vertices' numbers.
    queue: BinaryHeap<Reverse<(u64, u32)>>,
    pub(super) collapsed: usize,
}

/// What is known of a vertex.
#[derive(Clone, Copy)]
struct Vertex {
    /// May go.
    free: bool,
    /// Its cost in the queue; infinite when it is not there.
    cost: f64,
    /// Something around it has changed since.
    changed: bool,
    /// Proofs for estimates above this were in vain.
    provable: f64,
}

/// A neighbour that a vertex may be moved to.
struct Target {
    id: u32,
    cost: f64,
    error: f64,
}

impl<'a> Collapse<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        around: Vec<Vec<u32>>,
        posts: &'a [Post],
        fields: &'a Fields<'a>,
        tolerance: f64,
        free: &[bool],
    ) -> Collapse<'a> {
        let vertex = |&free: &bool| Vertex { free, cost: f64::INFINITY, changed: true, provable: 1.0 };
        let size = mesh.bounds().size();
        Collapse {
            positions: &mesh.positions,
            posts,
            fields,
            tolerance,
            length: LENGTH / size.length_squared(),
            triangles: mesh.triangles.clone(),
            alive: vec![true; mesh.triangles.len()],
            around,
            vertices: free.iter().map(vertex).collect(),
            queue: BinaryHeap::new(),
            collapsed: 0,
        }
    }

    /// Collapses until nothing more can go.
    pub(super) fn run(&mut self) {
        (0..self.positions.len() as u32).for_each(|vertex| self.enqueue(vertex, 0.0));
        while let Some(Reverse((bits, vertex))) = self.queue.pop() {
            let known = self.vertices[vertex as usize];
            if known.cost.to_bits() != bits {
                continue;
            }
            self.vertices[vertex as usize].cost = f64::INFINITY;
            let targets = self.targets(vertex);
            let Some(best) = targets.first() else { continue };
            if known.changed && best.cost > known.cost {
                self.vertices[vertex as usize].changed = false;
                self.enqueue(vertex, best.cost);
            } else {
                self.remove(vertex, &targets);
            }
        }
    }

    /// The mesh, and which of its triangles are new.
    pub(super) fn finish(self, before: &[[u32; 3]]) -> (Mesh, Vec<u32>) {
        let mut names = vec![u32::MAX; self.positions.len()];
        let (mut mesh, mut changed) = (Mesh::default(), Vec::new());
        for (index, triangle) in self.triangles.iter().enumerate().filter(|&(index, _)| self.alive[index]) {
            if *triangle != before[index] {
                changed.push(mesh.triangles.len() as u32);
            }
            mesh.triangles.push(triangle.map(|id| {
                let name = &mut names[id as usize];
                if *name == u32::MAX {
                    *name = mesh.positions.len() as u32;
                    mesh.positions.push(self.positions[id as usize]);
                }
                *name
            }));
        }
        (mesh, changed)
    }

    fn at(&self, id: u32) -> Vec3 {
        self.positions[id as usize]
    }

    fn enqueue(&mut self, vertex: u32, cost: f64) {
        let known = &mut self.vertices[vertex as usize];
        if known.free {
            known.cost = cost;
            self.queue.push(Reverse((cost.to_bits(), vertex)));
        }
    }

    /// Vertices that share an edge with one, in ascending order.
    fn neighbours(&self, vertex: u32) -> Vec<u32> {
        let triangles = self.around[vertex as usize].iter().flat_map(|&t| self.triangles[t as usize]);
        let mut all: Vec<u32> = triangles.filter(|&id| id != vertex).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The few neighbours to which a vertex is best moved, as far as estimates tell.
    fn targets(&self, vertex: u32) -> Vec<Target> {
        let around = &self.around[vertex as usize];
        if around.len() < 4 || around.len() > MOST_AROUND {
            return Vec::new();
        }
        let flattest = around.iter().fold(FLATTEST, |least: f64, &t| {
            least.min(flatness(self.triangles[t as usize].map(|id| self.at(id))))
        });
        let most = self.vertices[vertex as usize].provable;
        let ring = self.neighbours(vertex);
        let rate = |&id: &u32| self.rated(vertex, id, flattest, most);
        let mut targets: Vec<Target> = ring.iter().filter_map(rate).collect();
        targets.sort_by(|a, b| a.cost.total_cmp(&b.cost).then(a.id.cmp(&b.id)));
        targets.truncate(TARGETS);
        targets
    }

    /// The triangles of a vertex after it is moved to a neighbour.
    fn moved(&self, vertex: u32, target: u32) -> impl Iterator<Item = [u32; 3]> + '_ {
        let triangles = self.around[vertex as usize].iter().map(|&t| self.triangles[t as usize]);
        triangles
            .filter(move |triangle| !triangle.contains(&target))
            .map(move |triangle| triangle.map(|id| if id == vertex { target } else { id }))
    }

    /// What it costs to move a vertex to a neighbour; `None` where triangles would turn too far or become too flat, or the
    /// error is estimated to be above `most` tolerances.
    fn rated(&self, vertex: u32, target: u32, flattest: f64, most: f64) -> Option<Target> {
        if self.around[target as usize].len() + self.around[vertex as usize].len() > MOST_AROUND + 4 {
            return None;
        }
        let (mut error, mut longest) = (0.0_f64, 0.0_f64);
        for ids in self.moved(vertex, target) {
            let corners = ids.map(|id| self.at(id));
            let posts = ids.map(|id| self.posts[id as usize].direction);
            let [a, b, c] = corners;
            let normal = (b - a).cross(c - a);
            let least = UPRIGHT * normal.length();
            if posts.iter().any(|direction| direction.dot(normal) <= least) || flatness(corners) < flattest {
                return None;
            }
            error = error.max(self.estimate(corners, posts));
            if error > most {
                return None;
            }
            longest = longest.max(longest_squared(corners));
        }
        Some(Target { id: target, cost: error + self.length * longest, error })
    }

    /// The error of a triangle in tolerances, by how gradients turn along its edges.
    fn estimate(&self, corners: [Vec3; 3], directions: [Vec3; 3]) -> f64 {
        let along = |i: usize, j: usize| (corners[j] - corners[i]).dot(directions[j] - directions[i]);
        let bends = [along(0, 1), along(1, 2), along(2, 0)];
        let [above, below] = [1.0, -1.0].map(|sign| most_of_products(bends.map(|bend| sign * bend)));
        0.5 * above.max(below) / self.tolerance
    }

    /// Moves a vertex to the first of some neighbours for which that is proven.
    fn remove(&mut self, vertex: u32, targets: &[Target]) {
        let ring = self.neighbours(vertex);
        let corners = ring.iter().chain([&vertex]).map(|&id| self.at(id));
        let cell = grown(Aabb::of(corners), self.tolerance);
        let local = Local::of(self.fields.within(vertex, cell), cell);
        let proven = local.and_then(|local| {
            targets.iter().find(|target| {
                self.keeps_topology(vertex, target.id, &ring) && self.is_proven(vertex, target.id, &local)
            })
        });
        match proven {
            Some(target) => self.collapse(vertex, target, &ring),
            None => {
                let error = targets.iter().fold(f64::INFINITY, |least, target| least.min(target.error));
                self.vertices[vertex as usize].provable = PATIENCE * error;
            }
        }
    }

    /// The link condition: what both vertices touch is what their common triangles touch (Dey, Edelsbrunner, Guha,
    /// Nekhayev, Topology preserving edge contraction, 1999).
    fn keeps_topology(&self, vertex: u32, target: u32, ring: &[u32]) -> bool {
        let others = self.neighbours(target);
        let common = ring.iter().filter(|id| others.binary_search(id).is_ok()).count();
        common == 2
            && ring.len() + others.len() > 8
            && self.around[vertex as usize].len() == ring.len()
            && self.around[target as usize].len() == others.len()
    }

    /// Whether the new triangles face up, and both their sides have the signs that they should have.
    fn is_proven(&self, vertex: u32, target: u32, local: &Local<'_>) -> bool {
        self.moved(vertex, target).all(|ids| {
            let [a, b, c] = ids.map(|id| self.at(id));
            (b - a).cross(c - a).dot(local.direction) > 0.0
                && local.has_signs(&ids.map(|id| self.posts[id as usize]))
        })
    }

    fn collapse(&mut self, vertex: u32, target: &Target, ring: &[u32]) {
        for triangle in std::mem::take(&mut self.around[vertex as usize]) {
            let corners = &mut self.triangles[triangle as usize];
            if corners.contains(&target.id) {
                self.alive[triangle as usize] = false;
                for id in *corners {
                    self.around[id as usize].retain(|&t| t != triangle);
                }
            } else {
                corners.iter_mut().filter(|id| **id == vertex).for_each(|id| *id = target.id);
                self.around[target.id as usize].push(triangle);
            }
        }
        for &id in ring {
            self.vertices[id as usize].changed = true;
            if self.vertices[id as usize].cost.is_infinite() {
                self.enqueue(id, target.cost);
            }
        }
        self.collapsed += 1;
    }
}

fn longest_squared([a, b, c]: [Vec3; 3]) -> f64 {
    a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
}

/// The height of a triangle over its longest side.
fn flatness(corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners;
    (b - a).cross(c - a).length() / longest_squared(corners)
}
