//! A recipe laid out flat, children before parents, so that nothing that walks it needs the stack.

use super::bounds::local_bounds;
use super::field::reach::swell;
use super::{Body, Csg, Dimension, Flat, Offset};
use crate::boolean::Op;
use crate::math::{Aabb, Vec2, Vec3};
use crate::numeric::ContentHasher;
use crate::sdf::greatest_stretch;
use std::collections::HashMap;
use std::sync::Arc;

/// All nodes of a recipe. Subtrees that are shared by pointer are there once.
pub(super) struct Arena<'a> {
    nodes: Vec<Node<'a>>,
}

/// Index of a node.
pub(super) type NodeId = u32;

pub(super) struct Node<'a> {
    pub(super) recipe: &'a Csg,
    pub(super) children: Vec<NodeId>,
    /// Hash of all that the shape depends on.
    pub(super) key: u128,
    pub(super) dimension: Option<Dimension>,
    /// A box around the shape, in its own coordinates. Plane regions reach from 0 to 1 in z, so that boxes that overlap
    /// do so in their interiors.
    pub(super) bounds: Aabb,
    /// The places where the field of the shape is below k > 0 are within `swell` times k of the box; 1 for exact distances.
    pub(super) swell: f64,
    /// Number of leaves below, each as often as it occurs.
    pub(super) leaves: u64,
}

impl<'a> Arena<'a> {
    pub(super) fn new(recipe: &'a Csg) -> Arena<'a> {
        let mut arena = Arena { nodes: Vec::new() };
        let mut known: HashMap<*const Csg, NodeId> = HashMap::new();
        // Each node is met twice: first to put its children before it, then to number it.
        let mut stack = vec![(recipe, false)];
        while let Some((recipe, children_are_in)) = stack.pop() {
            if known.contains_key(&std::ptr::from_ref(recipe)) {
                continue;
            }
            if children_are_in {
                let number = |child: &Arc<Csg>| known[&Arc::as_ptr(child)];
                let children = recipe.children().iter().map(number).collect();
                known.insert(recipe, arena.nodes.len() as NodeId);
                arena.push(recipe, children);
            } else {
                stack.push((recipe, true));
                stack.extend(recipe.children().iter().rev().map(|child| (&**child, false)));
            }
        }
        arena
    }

    pub(super) fn get(&self, id: NodeId) -> &Node<'a> {
        &self.nodes[id as usize]
    }

    pub(super) fn root_id(&self) -> NodeId {
        self.nodes.len() as NodeId - 1
    }

    pub(super) fn root(&self) -> &Node<'a> {
        self.get(self.root_id())
    }

    pub(super) fn nodes(&self) -> &[Node<'a>] {
        &self.nodes
    }

    /// How much the maps above it stretch each field at most, by content.
    pub(super) fn stretches(&self) -> HashMap<u128, f64> {
        let mut largest = vec![0.0_f64; self.nodes.len()];
        largest[self.root_id() as usize] = 1.0;
        let mut by_content = HashMap::new();
        for (id, node) in self.nodes.iter().enumerate().rev() {
            let own = match node.recipe {
                Csg::Transform { map, .. } => greatest_stretch(map.matrix3),
                _ => 1.0,
            };
            let here = largest[id];
            for &child in &node.children {
                let below = &mut largest[child as usize];
                *below = below.max(here * own);
            }
            if matches!(node.recipe, Csg::Blend { .. } | Csg::Offset { .. } | Csg::Body(Body::Field(_))) {
                let known: &mut f64 = by_content.entry(node.key).or_default();
                *known = known.max(here);
            }
        }
        by_content
    }

    fn push(&mut self, recipe: &'a Csg, children: Vec<NodeId>) {
        let of = |&id: &NodeId| self.get(id);
        let dimension = match recipe {
            Csg::Flat(_) => Some(Dimension::Two),
            Csg::Body(_) | Csg::LinearExtrude { .. } | Csg::RotateExtrude { .. } => Some(Dimension::Three),
            // Only solids take part.
            Csg::Blend { .. } | Csg::Offset { .. } => {
                children.iter().any(|child| of(child).dimension.is_some()).then_some(Dimension::Three)
            }
            _ => children.iter().find_map(|child| of(child).dimension),
        };
        let below = children.iter().map(of).collect::<Vec<_>>();
        let (bounds, swell) = (local_bounds(recipe, dimension, &below), swell(recipe, &below));
        let key = key(recipe, children.iter().map(|child| of(child).key));
        let leaves = match recipe {
            Csg::Flat(_) | Csg::Body(_) => 1,
            _ => children.iter().fold(0, |sum: u64, child| sum.saturating_add(of(child).leaves)),
        };
        self.nodes.push(Node { recipe, children, key, dimension, bounds, swell, leaves });
    }
}

/// Hash of a node from its own numbers and the hashes of its children.
fn key(recipe: &Csg, children: impl Iterator<Item = u128>) -> u128 {
    let mut hasher = ContentHasher::default();
    let hash = &mut hasher;
    match recipe {
        Csg::Nothing => hash.integers([0]),
        Csg::Flat(flat) => hash_flat(hash, flat),
        Csg::Body(body) => hash_body(hash, body),
        Csg::Transform { map, .. } => {
            hash.integers([20]);
            hash.numbers(map.to_cols_array());
        }
        Csg::Color { color, .. } => {
            hash.integers([21]);
            hash.numbers(color.map(f64::from));
        }
        Csg::Combine { op, .. } => hash.integers([22, number(*op)]),
        Csg::Hull { .. } => hash.integers([23]),
        Csg::LinearExtrude { sweep, .. } => {
            hash.integers([24, u64::from(sweep.center), u64::from(sweep.slices)]);
            hash.numbers(
                sweep.vector.to_array().into_iter().chain([sweep.twist]).chain(sweep.scale.to_array()),
            );
        }
        Csg::RotateExtrude { sweep, .. } => {
            hash.integers([25, u64::from(sweep.fragments)]);
            hash.numbers([sweep.angle, sweep.start]);
        }
        Csg::Blend { op, blend, tolerance, .. } => {
            hash.integers([26, number(*op), blend.kind()]);
            hash.numbers([blend.size(), *tolerance]);
        }
        Csg::Offset { how, tolerance, .. } => {
            let kind = match how {
                Offset::By(_) => 0,
                Offset::Shell(_) => 1,
                Offset::Round(_) => 2,
            };
            hash.integers([27, kind]);
            hash.numbers([how.size(), *tolerance]);
        }
    }
    for child in children {
        hash.content(child);
    }
    hasher.finish()
}

fn number(op: Op) -> u64 {
    match op {
        Op::Union => 0,
        Op::Intersection => 1,
        Op::Difference => 2,
        Op::SymmetricDifference => 3,
    }
}

fn hash_flat(hash: &mut ContentHasher, flat: &Flat) {
    match flat {
        Flat::Rectangle { min, max } => {
            hash.integers([1]);
            hash.numbers([min.x, min.y, max.x, max.y]);
        }
        Flat::Circle { radius, fragments } => {
            hash.integers([2, u64::from(*fragments)]);
            hash.numbers([*radius]);
        }
        Flat::Polygon { contours } => {
            hash.integers([3, contours.len() as u64]);
            for contour in contours.iter() {
                hash.integers([contour.len() as u64]);
                hash.numbers(contour.iter().flat_map(Vec2::to_array));
            }
        }
    }
}

fn hash_body(hash: &mut ContentHasher, body: &Body) {
    match body {
        Body::Cuboid { min, max } => {
            hash.integers([10]);
            hash.numbers(min.to_array().into_iter().chain(max.to_array()));
        }
        Body::Sphere { radius, fragments } => {
            hash.integers([11, u64::from(*fragments)]);
            hash.numbers([*radius]);
        }
        Body::Frustum { heights, radii, fragments } => {
            hash.integers([12, u64::from(*fragments)]);
            hash.numbers(heights.iter().chain(radii).copied());
        }
        Body::Mesh(mesh) => {
            hash.integers([13, mesh.positions.len() as u64, mesh.triangles.len() as u64]);
            hash.numbers(mesh.positions.iter().flat_map(Vec3::to_array));
            hash.integers(mesh.triangles.iter().flatten().map(|&v| u64::from(v)));
        }
        Body::Surface(surface) => {
            hash.integers([14]);
            surface.hash(hash);
        }
        Body::Field(field) => {
            hash.integers([15]);
            field.hash(hash);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(min: Vec3) -> Csg {
        Csg::Body(Body::Cuboid { min, max: Vec3::ONE })
    }

    #[test]
    fn keys_tell_contents_apart_and_stay_the_same() {
        let key = |recipe: &Csg| Arena::new(recipe).root().key;
        assert_eq!(key(&cube(Vec3::ZERO)), key(&cube(-Vec3::ZERO)));
        assert_eq!(key(&cube(Vec3::ZERO)), GOLDEN);
        let pair = |a: &Csg, b: &Csg| Csg::Hull { children: vec![Arc::new(a.clone()), Arc::new(b.clone())] };
        let (a, b) = (cube(Vec3::ZERO), cube(-Vec3::ONE));
        let all = [
            &a,
            &b,
            &pair(&a, &b),
            &pair(&b, &a),
            &pair(&pair(&a, &b), &a),
            &pair(&a, &pair(&b, &a)),
            &Csg::Nothing,
        ];
        let keys: std::collections::BTreeSet<u128> = all.into_iter().map(key).collect();
        assert_eq!(keys.len(), all.len());
    }

    /// Changes only where the meaning of contents changes.
    const GOLDEN: u128 = 0x634a8af268552cf6a679738b995939e9;

    #[test]
    fn shared_subtrees_are_there_once() {
        let mut recipe = Arc::new(cube(Vec3::ZERO));
        for _ in 0..100 {
            recipe = Arc::new(Csg::Hull { children: vec![recipe.clone(), recipe] });
        }
        assert_eq!(Arena::new(&recipe).nodes().len(), 101);
    }
}
