//! Pairs of boxes that touch, by a tree of boxes.

use ogee::math::Aabb;

/// Calls `visit` once for each pair of boxes that touch, the lower index first.
pub(crate) fn for_each_pair(boxes: &[Aabb], visit: &mut impl FnMut(usize, usize)) {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    if let Some(root) = Node::over(boxes, &mut order) {
        root.pairs_within(boxes, visit);
    }
}

struct Node {
    bounds: Aabb,
    /// Boxes of a leaf.
    items: Vec<usize>,
    children: Option<Box<[Node; 2]>>,
}

impl Node {
    fn over(boxes: &[Aabb], order: &mut [usize]) -> Option<Node> {
        let bounds = order.iter().fold(Aabb::EMPTY, |all, &i| all.union(boxes[i]));
        if order.len() <= 6 {
            return (!order.is_empty()).then(|| Node { bounds, items: order.to_vec(), children: None });
        }
        let size = bounds.size();
        let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
        let middle = order.len() / 2;
        let key = |i: usize| boxes[i].min[axis] + boxes[i].max[axis];
        order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)));
        let (low, high) = order.split_at_mut(middle);
        let children = [Node::over(boxes, low)?, Node::over(boxes, high)?];
        Some(Node { bounds, items: Vec::new(), children: Some(Box::new(children)) })
    }

    fn pairs_within(&self, boxes: &[Aabb], visit: &mut impl FnMut(usize, usize)) {
        if let Some(children) = &self.children {
            children.iter().for_each(|child| child.pairs_within(boxes, visit));
            children[0].pairs_with(&children[1], boxes, visit);
            return;
        }
        for (k, &a) in self.items.iter().enumerate() {
            for &b in &self.items[k + 1..] {
                report(a, b, boxes, visit);
            }
        }
    }

    fn pairs_with(&self, other: &Node, boxes: &[Aabb], visit: &mut impl FnMut(usize, usize)) {
        if !self.bounds.touches(other.bounds) {
            return;
        }
        match (&self.children, &other.children) {
            (Some(children), _) => children.iter().for_each(|child| child.pairs_with(other, boxes, visit)),
            (None, Some(children)) => children.iter().for_each(|child| self.pairs_with(child, boxes, visit)),
            (None, None) => {
                for &a in &self.items {
                    other.items.iter().for_each(|&b| report(a, b, boxes, visit));
                }
            }
        }
    }
}

fn report(a: usize, b: usize, boxes: &[Aabb], visit: &mut impl FnMut(usize, usize)) {
    if boxes[a].touches(boxes[b]) {
        visit(a.min(b), a.max(b));
    }
}
