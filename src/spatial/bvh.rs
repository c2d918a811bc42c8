use crate::math::{Aabb, Vec3};

/// A binary tree of boxes over items that have a box each.
///
/// Items are ordered along a space-filling curve (Morton) and the tree is implicit in that order, so it is the same on
/// every run. All comparisons are closed: boxes that touch are found.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    /// Item of each leaf slot.
    order: Vec<u32>,
    /// Boxes level by level, leaves' groups first.
    levels: Vec<Vec<Aabb>>,
}

/// A node by its level, counted from the leaves' groups up, and its place there.
type Node = (usize, usize);

/// Items a leaf group.
const GROUP: usize = 4;

/// Bits an axis of the space-filling curve.
const CURVE_BITS: u32 = 20;

impl Bvh {
    /// The tree over `boxes`.
    pub fn new(boxes: &[Aabb]) -> Bvh {
        if boxes.is_empty() {
            return Bvh::default();
        }
        let order = along_curve(boxes);
        let around = |items: &[u32]| items.iter().fold(Aabb::EMPTY, |b, &i| b.union(boxes[i as usize]));
        let mut levels = vec![order.chunks(GROUP).map(around).collect::<Vec<_>>()];
        while levels[levels.len() - 1].len() > 1 {
            let below = &levels[levels.len() - 1];
            let above =
                below.chunks(2).map(|pair| pair.iter().fold(Aabb::EMPTY, |b, &c| b.union(c))).collect();
            levels.push(above);
        }
        Bvh { order, levels }
    }

    /// Calls `found` for every item whose box touches `target`.
    pub fn touching(&self, boxes: &[Aabb], target: Aabb, mut found: impl FnMut(u32)) {
        if let Some(root) = self.root() {
            self.touching_below(root, boxes, target, &mut found);
        }
    }

    fn touching_below(&self, (level, node): Node, boxes: &[Aabb], target: Aabb, found: &mut impl FnMut(u32)) {
        if !self.levels[level][node].touches(target) {
            return;
        }
        if level > 0 {
            self.children(level, node).for_each(|child| self.touching_below(child, boxes, target, found));
            return;
        }
        for &item in self.group(node) {
            if boxes[item as usize].touches(target) {
                found(item);
            }
        }
    }

    /// Calls `found` for every pair of items, one of each tree, whose boxes touch.
    pub fn pairs(&self, boxes: &[Aabb], other: &Bvh, other_boxes: &[Aabb], mut found: impl FnMut(u32, u32)) {
        let (Some(a), Some(b)) = (self.root(), other.root()) else { return };
        self.pairs_below(&mut vec![(a, b)], boxes, other, other_boxes, &mut found);
    }

    /// Calls `found` once for every pair of different items whose boxes touch, the smaller index first.
    pub fn self_pairs(&self, boxes: &[Aabb], mut found: impl FnMut(u32, u32)) {
        let mut in_order = |i: u32, j: u32| found(i.min(j), i.max(j));
        let mut nodes = Vec::from_iter(self.root());
        let mut stack = Vec::new();
        while let Some(node) = nodes.pop() {
            if node.0 > 0 {
                let [left, right] = [0, 1].map(|i| self.children(node.0, node.1).nth(i));
                nodes.extend([left, right].into_iter().flatten());
                stack.extend(left.zip(right));
                self.pairs_below(&mut stack, boxes, self, boxes, &mut in_order);
                continue;
            }
            let group = self.group(node.1);
            for (place, &i) in group.iter().enumerate() {
                for &j in &group[place + 1..] {
                    if boxes[i as usize].touches(boxes[j as usize]) {
                        in_order(i, j);
                    }
                }
            }
        }
    }

    /// Calls `found` for the pairs of items below pairs of nodes, one of each tree, whose boxes touch.
    fn pairs_below(
        &self,
        stack: &mut Vec<(Node, Node)>,
        boxes: &[Aabb],
        other: &Bvh,
        other_boxes: &[Aabb],
        found: &mut impl FnMut(u32, u32),
    ) {
        while let Some((a, b)) = stack.pop() {
            if !self.levels[a.0][a.1].touches(other.levels[b.0][b.1]) {
                continue;
            }
            if a.0 == 0 && b.0 == 0 {
                for &i in self.group(a.1) {
                    for &j in other.group(b.1) {
                        if boxes[i as usize].touches(other_boxes[j as usize]) {
                            found(i, j);
                        }
                    }
                }
            } else if a.0 >= b.0 {
                stack.extend(self.children(a.0, a.1).map(|child| (child, b)));
            } else {
                stack.extend(other.children(b.0, b.1).map(|child| (a, child)));
            }
        }
    }

    /// The item nearest to a point, given the square of the distance of each; of equal ones the first that is met. `None`
    /// when there are no items, or no distance is a number.
    pub fn nearest(
        &self,
        boxes: &[Aabb],
        point: Vec3,
        mut distance_squared: impl FnMut(u32) -> f64,
    ) -> Option<u32> {
        let away = |b: &Aabb| (point - point.clamp(b.min, b.max)).length_squared();
        let (mut best, mut least) = (None, f64::INFINITY);
        let mut stack: Vec<(f64, usize, usize)> =
            self.root().into_iter().map(|(level, node)| (0.0, level, node)).collect();
        while let Some((bound, level, node)) = stack.pop() {
            if bound > least {
                continue;
            }
            if level > 0 {
                let mut below: Vec<(f64, usize, usize)> =
                    self.children(level, node).map(|(l, n)| (away(&self.levels[l][n]), l, n)).collect();
                // The nearer one last, to be looked at first.
                below.sort_by(|a, b| b.0.total_cmp(&a.0));
                stack.extend(below);
                continue;
            }
            for &item in self.group(node) {
                if away(&boxes[item as usize]) <= least {
                    let distance = distance_squared(item);
                    if distance < least || (best.is_none() && distance == least) {
                        (best, least) = (Some(item), distance);
                    }
                }
            }
        }
        best
    }

    /// A value for each node, level by level from the leaves' groups up: of a group's items, then of the values of
    /// the nodes below.
    pub fn summed<T: Copy>(&self, group: impl Fn(&[u32]) -> T, join: impl Fn(&[T]) -> T) -> Vec<Vec<T>> {
        let mut sums: Vec<Vec<T>> = Vec::with_capacity(self.levels.len());
        for level in 0..self.levels.len() {
            let nodes = 0..self.levels[level].len();
            let here = match sums.last() {
                None => nodes.map(|node| group(self.group(node))).collect(),
                Some(below) => below.chunks(2).map(&join).collect(),
            };
            sums.push(here);
        }
        sums
    }

    /// Goes down from the root into every node for which `enter(level, node)` holds, numbered as in [`Bvh::summed`], and
    /// calls `found` for the items of the groups it enters.
    pub fn descend(&self, mut enter: impl FnMut(usize, usize) -> bool, mut found: impl FnMut(u32)) {
        let mut stack = Vec::from_iter(self.root());
        while let Some((level, node)) = stack.pop() {
            if !enter(level, node) {
                continue;
            }
            if level > 0 {
                stack.extend(self.children(level, node));
            } else {
                self.group(node).iter().for_each(|&item| found(item));
            }
        }
    }

    fn root(&self) -> Option<Node> {
        self.levels.len().checked_sub(1).map(|top| (top, 0))
    }

    fn children(&self, level: usize, node: usize) -> impl Iterator<Item = Node> + use<> {
        let count = self.levels[level - 1].len();
        [2 * node, 2 * node + 1]
            .into_iter()
            .filter(move |&child| child < count)
            .map(move |child| (level - 1, child))
    }

    fn group(&self, node: usize) -> &[u32] {
        &self.order[GROUP * node..self.order.len().min(GROUP * node + GROUP)]
    }
}

/// Items in the order of a Morton curve through the centres of their boxes.
fn along_curve(boxes: &[Aabb]) -> Vec<u32> {
    let centers = Aabb::of(boxes.iter().map(|b| b.center()));
    let size = centers.size();
    let cells = f64::from(1_u32 << CURVE_BITS) - 1.0;
    let scale = Vec3::from_array(size.to_array().map(|s| if s > 0.0 { cells / s } else { 0.0 }));
    let mut keys: Vec<(u64, u32)> = (0..)
        .zip(boxes)
        .map(|(i, b)| {
            let cell = ((b.center() - centers.min) * scale).to_array();
            let [x, y, z] = cell.map(|c| spread(c as u64));
            (x | y << 1 | z << 2, i)
        })
        .collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, i)| i).collect()
}

/// The bits of a number below 2^21 with two zeros between neighbours.
fn spread(value: u64) -> u64 {
    let mut v = value & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        v = (v | v << shift) & mask;
    }
    v
}
