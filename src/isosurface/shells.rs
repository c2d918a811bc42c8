//! Proofs of leaves by the shell of the mesh: the space between its triangles moved to both sides by the tolerance.
//!
//! Let M be the mesh, M+ and M- the outer and the inner side of the shell, and w how often a closed surface winds
//! around a point. A point that M+ winds around once more than M- lies in the shell, and so within the tolerance of M.
//! Suppose that in a box the field grows along n at rates between `least` and `most`, and that it is positive on M+ and
//! negative on M- there, so that on M its magnitude is at most `most` times the tolerance. From a zero z in the leaf go down
//! along -n to the depth s, to x: on the way the field is negative, so M+ is not met, and at x it is too negative for M to
//! be within the tolerance; M on its way to M+ does not pass x, so w(M+, z) = w(M, x). Likewise w(M-, z) = w(M, y) for
//! the point y above, and the difference is how often M is passed upward, in all, between x and y. Moving the line on
//! the straight way to a point of a triangle does not change that, as long as the bend of the field on this way does not
//! make up for the depth; and if the line there passes the triangle upward and nothing downward, it is not zero.

use super::certify::grown;
use super::extract::Extracted;
use super::refine::{Leaf, Refinement};
use crate::math::{Aabb, Vec3};
use crate::par;
use crate::sdf::{Local, Post, Shell};
use std::ops::Range;

/// Depths that are tried, in tolerances.
const DEPTHS: [f64; 2] = [4.0, 8.0];

/// How far beyond a leaf its field must stand for the whole one, in tolerances: at the greatest depth the mesh may be
/// one away, and the sides of its shell one from there.
pub(super) const KNOWN: f64 = DEPTHS[1] + 2.0;

/// Below this many leaves threads are not worth waking.
const FEW: usize = 64;

/// The shell around an extracted mesh.
pub(super) fn shell<'m>(refinement: &Refinement<'_>, extracted: &'m Extracted) -> Shell<'m> {
    let tolerance = refinement.sizes.tolerance;
    let mesh = &extracted.mesh;
    let leaves: Vec<([u32; 3], Range<usize>)> = extracted.of_leaves().collect();
    let mut fields = vec![0; mesh.positions.len()];
    for ([generation, index, _], range) in &leaves {
        let leaf = &refinement.leaves[*generation as usize][*index as usize];
        for &id in mesh.triangles[range.clone()].iter().flatten() {
            fields[id as usize] = leaf.tetrahedron.field;
        }
    }
    let vertices: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    let posts = par::map_above(FEW, &vertices, |&v| {
        let field = refinement.field(fields[v as usize]);
        Post::at(mesh.positions[v as usize], field, tolerance)
    });
    let mut shell = Shell::new(mesh, posts);
    let signed = par::map_above(FEW, &leaves, |([generation, index, _], range)| {
        let leaf = &refinement.leaves[*generation as usize][*index as usize];
        let cell = grown(leaf.tetrahedron.bounds(&refinement.nodes), tolerance);
        let own = range.start as u32..range.end as u32;
        let local = Local::of(refinement.field(leaf.tetrahedron.field), cell);
        local.map_or(Vec::new(), |local| own.filter(|&t| shell.has_signs(t, &local)).collect())
    });
    shell.sign(signed.into_iter().flatten());
    shell
}

/// Whether all zeros in a leaf are proven to lie in the shell. The line is taken through one of its own triangles, or, where
/// it has none, through the nearest of those around it.
pub(super) fn holds_zeros(
    shell: &Shell<'_>,
    refinement: &Refinement<'_>,
    extracted: &Extracted,
    leaf: &Leaf,
    [own, around]: [&[u32]; 2],
) -> bool {
    let tetrahedron = &leaf.tetrahedron;
    let leaf_cell = tetrahedron.bounds(&refinement.nodes);
    let (mut cell, mut way) = (leaf_cell, tetrahedron.size(&refinement.nodes));
    let mut marks = own;
    if own.is_empty() {
        let distance = |t: &u32| center(extracted.mesh.corners(*t as usize)).distance(leaf_cell.center());
        let nearer = |a: &&u32, b: &&u32| distance(a).total_cmp(&distance(b)).then(a.cmp(b));
        let Some(nearest) = around.iter().min_by(nearer) else { return false };
        cell = cell.union(Aabb::around(extracted.mesh.corners(*nearest as usize)));
        way = cell.size().length();
        marks = std::slice::from_ref(nearest);
    }
    let tolerance = refinement.sizes.tolerance;
    // What stands for the field in a leaf need not do so beyond it.
    let is_own = cell == leaf_cell;
    let field = if is_own { refinement.field(tetrahedron.field) } else { refinement.root() };
    DEPTHS.into_iter().any(|depth| {
        let known = Local::of(field, grown(cell, (depth + 2.0) * tolerance));
        let Some((local, bend)) = known.and_then(|local| local.bend().map(|bend| (local, bend))) else {
            return false;
        };
        let needed = 2.0 * tolerance * local.most + 0.125 * bend * way * way;
        let near = grown(cell, (depth + 1.0) * tolerance);
        depth * tolerance * local.least > needed * (1.0 + 1e-9)
            && shell.is_passed_upward(near, local.direction, marks.iter().copied())
    })
}

fn center([a, b, c]: [Vec3; 3]) -> Vec3 {
    (a + b + c) / 3.0
}
