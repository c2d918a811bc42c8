//! Makes a failing case small.

use super::Case;
use crate::oracle::surface::Union;
use ogee::boolean::Tree;
use ogee::math::Vec3;
use ogee::mesh::Mesh;

/// The smallest case that still fails, as far as one step at a time finds it within `attempts` tries.
pub(crate) fn shrunk(case: &Case, attempts: usize, fails: &dyn Fn(&Case) -> bool) -> Case {
    let mut best = case.clone();
    let mut left = attempts;
    loop {
        let smaller = candidates(&best).into_iter().take(left).enumerate().find(|(_, next)| fails(next));
        match smaller {
            Some((tried, next)) => {
                left -= tried + 1;
                best = next;
            }
            None => return best,
        }
    }
}

/// Smaller cases, the boldest first.
fn candidates(case: &Case) -> Vec<Case> {
    let trees =
        smaller_trees(&case.tree).into_iter().map(|tree| without_idle_operands(&tree, &case.operands));
    let mut all: Vec<Case> = trees.collect();
    for (index, mesh) in case.operands.iter().enumerate() {
        let smaller = components(mesh).into_iter().chain(collapses(mesh)).chain(nearer(mesh));
        all.extend(smaller.map(|mesh| {
            let mut next = case.clone();
            next.operands[index] = mesh;
            next
        }));
    }
    all
}

/// A child in place of the tree, a node without one of its children, and the same below.
fn smaller_trees(tree: &Tree) -> Vec<Tree> {
    let Tree::Node(op, children) = tree else { return Vec::new() };
    let mut all = children.clone();
    for index in 0..children.len() {
        let mut fewer = children.clone();
        fewer.remove(index);
        all.push(Tree::Node(*op, fewer));
    }
    for (index, child) in children.iter().enumerate() {
        all.extend(smaller_trees(child).into_iter().map(|smaller| {
            let mut changed = children.clone();
            changed[index] = smaller;
            Tree::Node(*op, changed)
        }));
    }
    all
}

fn without_idle_operands(tree: &Tree, operands: &[Mesh]) -> Case {
    let mut used = Vec::new();
    let tree = renumbered(tree, &mut used);
    Case { tree, operands: used.into_iter().map(|index| operands[index].clone()).collect() }
}

fn renumbered(tree: &Tree, used: &mut Vec<usize>) -> Tree {
    match tree {
        Tree::Leaf(index) => Tree::Leaf(used.iter().position(|u| u == index).unwrap_or_else(|| {
            used.push(*index);
            used.len() - 1
        })),
        Tree::Node(op, children) => {
            Tree::Node(*op, children.iter().map(|child| renumbered(child, used)).collect())
        }
        Tree::AtLeast(least, children) => {
            Tree::AtLeast(*least, children.iter().map(|child| renumbered(child, used)).collect())
        }
    }
}

/// The pieces of a mesh, if there are several.
fn components(mesh: &Mesh) -> Vec<Mesh> {
    let mut sets = Union::new(mesh.positions.len());
    for &[a, b, c] in &mesh.triangles {
        sets.join(a as usize, b as usize);
        sets.join(b as usize, c as usize);
    }
    let (number, _) = sets.numbers();
    let mut pieces = Vec::new();
    let mut seen = Vec::new();
    for triangle in &mesh.triangles {
        let piece = number[triangle[0] as usize];
        if !seen.contains(&piece) {
            seen.push(piece);
            let triangles =
                mesh.triangles.iter().copied().filter(|t| number[t[0] as usize] == piece).collect();
            pieces.push(compact(&Mesh::new(mesh.positions.clone(), triangles)));
        }
    }
    if pieces.len() > 1 { pieces } else { Vec::new() }
}

/// One vertex merged into another along a side: closed chains stay closed.
fn collapses(mesh: &Mesh) -> Vec<Mesh> {
    let sides = mesh.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let merge = |(from, to): (u32, u32)| {
        let merged = mesh.triangles.iter().map(|t| t.map(|v| if v == from { to } else { v }));
        let triangles = merged.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        compact(&Mesh::new(mesh.positions.clone(), without_opposites(triangles)))
    };
    sides.map(merge).collect()
}

/// Drops pairs of triangles that cancel.
fn without_opposites(mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let mut index = 0;
    while index < triangles.len() {
        let [a, b, c] = triangles[index];
        let opposite = |t: &[u32; 3]| [[a, c, b], [c, b, a], [b, a, c]].contains(t);
        if let Some(other) = triangles[index + 1..].iter().position(opposite) {
            triangles.remove(index + 1 + other);
            triangles.remove(index);
        } else {
            index += 1;
        }
    }
    triangles
}

/// Without positions that no triangle uses.
fn compact(mesh: &Mesh) -> Mesh {
    let mut place = vec![u32::MAX; mesh.positions.len()];
    let mut positions = Vec::new();
    let triangles = mesh.triangles.iter().map(|t| {
        t.map(|v| {
            if place[v as usize] == u32::MAX {
                place[v as usize] = positions.len() as u32;
                positions.push(mesh.positions[v as usize]);
            }
            place[v as usize]
        })
    });
    let triangles = triangles.collect();
    Mesh::new(positions, triangles)
}

/// All coordinates above a value lowered by one: gaps close.
fn nearer(mesh: &Mesh) -> Vec<Mesh> {
    let lower = |axis: usize, height: f64| {
        let mut positions: Vec<Vec3> = mesh.positions.clone();
        positions.iter_mut().filter(|p| p[axis] >= height).for_each(|p| p[axis] -= 1.0);
        Mesh::new(positions, mesh.triangles.clone())
    };
    let steps = (0..3).flat_map(|axis| (1..=4).map(move |height| (axis, f64::from(height))));
    steps.map(|(axis, height)| lower(axis, height)).filter(|m| m.positions != mesh.positions).collect()
}
