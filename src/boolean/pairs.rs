//! Pairs of triangles that may touch.

use super::scene::Scene;
use super::slope::are_parted;
use crate::math::Aabb;
use crate::spatial::{Bvh, Grid};

/// Pairs of triangles that may have a contact: of different members and, in members not known to be embedded, of one.
pub(super) fn candidates(scene: &Scene<'_>) -> Vec<[u32; 2]> {
    let members = &scene.members;
    let boxes: Vec<Aabb> = members.iter().map(|member| member.bounds).collect();
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    Bvh::new(&boxes).self_pairs(&boxes, |i, j| pairs.push((i, j)));
    pairs.extend((0..members.len() as u32).filter(|&i| !members[i as usize].embedded).map(|i| (i, i)));
    pairs.sort_unstable();

    let parts = parts(scene, &pairs, &boxes);
    let mut found = Vec::new();
    for (i, j) in pairs {
        let (a, b) = (&parts[i as usize], &parts[j as usize]);
        let mut report = |x: u32, y: u32| {
            let (t, s) = (a.triangles[x as usize], b.triangles[y as usize]);
            if !are_parted(scene, t, s) {
                found.push([t, s]);
            }
        };
        if i == j {
            a.bvh.self_pairs(&a.boxes, report);
        } else {
            a.bvh.pairs(&a.boxes, &b.bvh, &b.boxes, &mut report);
        }
    }
    found.sort_unstable();
    found
}

/// The triangles of a member that another one comes near, by place.
#[derive(Default)]
struct Part {
    triangles: Vec<u32>,
    boxes: Vec<Aabb>,
    bvh: Bvh,
}

/// The parts of all members, given the pairs of them whose boxes touch.
fn parts(scene: &Scene<'_>, pairs: &[(u32, u32)], boxes: &[Aabb]) -> Vec<Part> {
    let mut windows = vec![Aabb::EMPTY; boxes.len()];
    for &(i, j) in pairs {
        let overlap = boxes[i as usize].intersection(boxes[j as usize]);
        for k in [i, j] {
            windows[k as usize] = windows[k as usize].union(overlap);
        }
    }
    let mut parts: Vec<Part> =
        windows.iter().enumerate().map(|(member, &window)| Part::in_window(scene, member, window)).collect();
    if let Some(crowd) = Crowd::new(&parts, &windows) {
        for (member, part) in parts.iter_mut().enumerate().filter(|(k, _)| scene.members[*k].embedded) {
            part.retain(|bounds| crowd.is_near_another(member, bounds));
        }
    }
    for part in &mut parts {
        part.bvh = Bvh::new(&part.boxes);
    }
    parts
}

impl Part {
    /// The triangles of a member that touch a box.
    fn in_window(scene: &Scene<'_>, member: usize, window: Aabb) -> Part {
        let mut part = Part::default();
        if !window.is_empty() {
            for t in scene.members[member].triangles.clone() {
                let bounds = scene.bounds_of(t);
                if bounds.touches(window) {
                    part.triangles.push(t);
                    part.boxes.push(bounds);
                }
            }
        }
        part
    }

    /// Keeps the triangles with boxes that pass a test.
    fn retain(&mut self, mut is_kept: impl FnMut(Aabb) -> bool) {
        let kept: Vec<usize> = (0..self.boxes.len()).filter(|&i| is_kept(self.boxes[i])).collect();
        self.triangles = kept.iter().map(|&i| self.triangles[i]).collect();
        self.boxes = kept.iter().map(|&i| self.boxes[i]).collect();
    }
}

/// Scenes with fewer triangles are gone through pair by pair without ado.
const WORTH_A_GRID: usize = 2000;

/// A triangle that spans more cells is kept apart.
const LARGE: usize = 64;

/// Which cells of a coarse grid triangles of several members reach: away from those, nothing meets.
struct Crowd {
    grid: Grid,
    /// For each cell, the one member that reaches it, [`NOBODY`] or [`SEVERAL`].
    reached_by: Vec<u32>,
    /// Triangles that span many cells, with their members.
    large: Vec<(u32, Aabb)>,
    large_boxes: Vec<Aabb>,
    large_bvh: Bvh,
}

const NOBODY: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

impl Crowd {
    fn new(parts: &[Part], windows: &[Aabb]) -> Option<Crowd> {
        let count: usize = parts.iter().map(|part| part.boxes.len()).sum();
        if count < WORTH_A_GRID {
            return None;
        }
        let all = windows.iter().fold(Aabb::EMPTY, |all, &window| all.union(window));
        let grid = Grid::new(all, count);
        let mut crowd = Crowd {
            reached_by: vec![NOBODY; grid.len()],
            grid,
            large: Vec::new(),
            large_boxes: Vec::new(),
            large_bvh: Bvh::default(),
        };
        for (member, part) in (0..).zip(parts) {
            part.boxes.iter().for_each(|&bounds| crowd.enter(member, bounds));
        }
        crowd.large_boxes = crowd.large.iter().map(|&(_, bounds)| bounds).collect();
        crowd.large_bvh = Bvh::new(&crowd.large_boxes);
        Some(crowd)
    }

    fn enter(&mut self, member: u32, bounds: Aabb) {
        let span = self.grid.span(bounds);
        if span.len() > LARGE {
            self.large.push((member, bounds));
            return;
        }
        self.grid.any_cell(span, |cell| {
            let reached_by = &mut self.reached_by[cell];
            *reached_by = match *reached_by {
                NOBODY => member,
                known if known == member => member,
                _ => SEVERAL,
            };
            false
        });
    }

    /// Whether something of another member may touch a triangle with this box.
    fn is_near_another(&self, member: usize, bounds: Aabb) -> bool {
        let span = self.grid.span(bounds);
        if span.len() > LARGE {
            return true;
        }
        if self.grid.any_cell(span, |cell| self.reached_by[cell] == SEVERAL) {
            return true;
        }
        let mut near = false;
        self.large_bvh.touching(&self.large_boxes, bounds, |i| {
            near |= self.large[i as usize].0 != member as u32;
        });
        near
    }
}
