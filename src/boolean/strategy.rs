//! Which steps an expression is evaluated in.
//!
//! One arrangement of everything is best where few bodies meet at any one place: each contact is found once, and faces
//! are cut once. Where many overlap, most of what it would cut is buried inside others; then the bodies are combined two
//! groups at a time, neighbours first, and what is buried is dropped early. Both give the same points, as all steps are
//! exact.

use super::body::Body;
use super::tree::{Op, Tree};
use super::world::World;
use super::{Steps, arrange};
use crate::math::Aabb;
use crate::spatial::Bvh;

/// Evaluates an expression of bodies.
pub(super) fn evaluate<'a>(
    world: World<'a>,
    bodies: Vec<Body>,
    tree: &Tree,
    steps: Steps,
) -> (World<'a>, Body) {
    let tree = &tree.flattened();
    let mut uses = vec![0_u32; bodies.len()];
    tree.leaves().into_iter().for_each(|(leaf, times)| uses[leaf] = times);
    let bodies = bodies.into_iter().map(Some).collect();
    let mut kitchen = Kitchen { world: Some(world), bodies, uses, steps };
    let body = kitchen.evaluate(tree);
    (kitchen.world.expect("it is put back after each step"), body)
}

/// How many others may overlap a triangle, on average, before bodies are combined group by group.
const SHALLOW: f64 = 3.0;

/// Triangles of a body that are looked at to find how many others overlap it.
const SAMPLES: usize = 64;

struct Kitchen<'a> {
    world: Option<World<'a>>,
    bodies: Vec<Option<Body>>,
    /// How often each body is still needed.
    uses: Vec<u32>,
    steps: Steps,
}

impl Kitchen<'_> {
    fn evaluate(&mut self, tree: &Tree) -> Body {
        let leaves = tree.leaves();
        let at_once = match self.steps {
            Steps::Once => true,
            Steps::Pairs => leaves.len() <= 2,
            Steps::Measured => {
                let body = |&(leaf, _): &(usize, u32)| self.bodies[leaf].as_ref();
                self.is_shallow(&leaves.iter().filter_map(body).collect::<Vec<_>>())
            }
        };
        match tree {
            Tree::Node(op, parts) if !at_once => {
                let parts: Vec<Body> = parts.iter().map(|part| self.part(part)).collect();
                self.combine(*op, parts)
            }
            _ => {
                let named: Vec<Body> = leaves.iter().map(|&(leaf, times)| self.take(leaf, times)).collect();
                let place = |leaf: usize| leaves.binary_search_by_key(&leaf, |&(leaf, _)| leaf);
                self.arrange(named, &tree.renamed(&|leaf| place(leaf).expect("a leaf of the tree")))
            }
        }
    }

    /// A part of an expression; operands as they are.
    fn part(&mut self, tree: &Tree) -> Body {
        match tree {
            Tree::Leaf(index) => self.take(*index, 1),
            Tree::Node(..) | Tree::AtLeast(..) => self.evaluate(tree),
        }
    }

    /// A body for some of its uses.
    fn take(&mut self, index: usize, times: u32) -> Body {
        self.uses[index] -= times;
        let body = &mut self.bodies[index];
        let body = if self.uses[index] == 0 { body.take() } else { body.clone() };
        body.expect("uses were counted")
    }

    fn combine(&mut self, op: Op, mut parts: Vec<Body>) -> Body {
        if op == Op::Difference && parts.len() > 2 {
            let rest = parts.split_off(1);
            let rest = self.combine(Op::Union, rest);
            parts.push(rest);
            return self.arrange(parts, &Tree::flat(op, 2));
        }
        if parts.len() <= 2
            || (self.steps == Steps::Measured && self.is_shallow(&parts.iter().collect::<Vec<_>>()))
        {
            let tree = Tree::flat(op, parts.len());
            return self.arrange(parts, &tree);
        }
        let far = split_by_place(&mut parts);
        let halves = [parts, far].map(|half| self.combine(op, half));
        self.arrange(halves.into(), &Tree::flat(op, 2))
    }

    fn arrange(&mut self, bodies: Vec<Body>, tree: &Tree) -> Body {
        let world = self.world.take().expect("it is put back after each step");
        let (world, body) = arrange(world, bodies, tree);
        self.world = Some(world);
        body
    }

    /// Whether few other bodies' boxes meet that of a triangle, on average.
    fn is_shallow(&self, bodies: &[&Body]) -> bool {
        let points = self.world.as_ref().expect("it is put back after each step").points();
        let boxes: Vec<Aabb> = bodies.iter().map(|body| body.bounds).collect();
        let bvh = Bvh::new(&boxes);
        let (mut met, mut all) = (0.0, 0.0);
        for (own, body) in (0_u32..).zip(bodies).filter(|(_, body)| !body.is_empty()) {
            let step = body.len().div_ceil(SAMPLES);
            let weight = body.len() as f64 / body.len().div_ceil(step) as f64;
            for corners in body.corners.iter().step_by(step) {
                let triangle = Aabb::of(corners.map(|p| points.rounded(p)));
                bvh.touching(&boxes, triangle, |other| {
                    // Bodies that are just flush bury nothing.
                    if other != own && overlap(triangle, boxes[other as usize]) {
                        met += weight;
                    }
                });
            }
            all += body.len() as f64;
        }
        met <= SHALLOW * all
    }
}

/// Whether boxes that may be flat have more in common than their borders.
fn overlap(a: Aabb, b: Aabb) -> bool {
    a.min.cmplt(b.max).all() && b.min.cmplt(a.max).all()
}

/// Takes out the half of the bodies that lies further along the axis on which they are most spread.
fn split_by_place(bodies: &mut Vec<Body>) -> Vec<Body> {
    let size =
        Aabb::of(bodies.iter().filter(|body| !body.is_empty()).map(|body| body.bounds.center())).size();
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let place = |body: &Body| body.bounds.center()[axis];
    bodies.sort_by(|a, b| place(a).total_cmp(&place(b)));
    bodies.split_off(bodies.len() / 2)
}
