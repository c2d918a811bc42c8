//! Pairs of triangles that may touch.

use super::scene::Scene;
use crate::math::Aabb;
use crate::spatial::Bvh;

/// Pairs of triangles whose boxes touch: of different members and, in members not known to be embedded, of one.
pub(super) fn candidates(scene: &Scene<'_>) -> Vec<[u32; 2]> {
    let members = &scene.members;
    let boxes: Vec<Aabb> = members.iter().map(|member| member.bounds).collect();
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    Bvh::new(&boxes).self_pairs(&boxes, |i, j| pairs.push((i, j)));
    pairs.extend((0..members.len() as u32).filter(|&i| !members[i as usize].embedded).map(|i| (i, i)));
    pairs.sort_unstable();

    // Each member once, as much of it as any other comes near.
    let mut windows = vec![Aabb::EMPTY; members.len()];
    for &(i, j) in &pairs {
        let overlap = boxes[i as usize].intersection(boxes[j as usize]);
        for k in [i, j] {
            windows[k as usize] = windows[k as usize].union(overlap);
        }
    }
    let parts: Vec<Part> = (0..).zip(&windows).map(|(i, &window)| Part::of(scene, i, window)).collect();
    let mut found = Vec::new();
    for (i, j) in pairs {
        let (a, b) = (&parts[i as usize], &parts[j as usize]);
        let mut report = |x: u32, y: u32| found.push([a.triangles[x as usize], b.triangles[y as usize]]);
        if i == j {
            a.bvh.self_pairs(&a.boxes, report);
        } else {
            a.bvh.pairs(&a.boxes, &b.bvh, &b.boxes, &mut report);
        }
    }
    found.sort_unstable();
    found
}

/// The triangles of a member that touch a box.
struct Part {
    triangles: Vec<u32>,
    boxes: Vec<Aabb>,
    bvh: Bvh,
}

impl Part {
    fn of(scene: &Scene<'_>, member: u32, within: Aabb) -> Part {
        let (mut triangles, mut boxes) = (Vec::new(), Vec::new());
        if !within.is_empty() {
            for t in scene.members[member as usize].triangles.clone() {
                let bounds = scene.bounds_of(t);
                if bounds.touches(within) {
                    triangles.push(t);
                    boxes.push(bounds);
                }
            }
        }
        let bvh = Bvh::new(&boxes);
        Part { triangles, boxes, bvh }
    }
}
