//! Fields that stand for a whole one in parts of space: cheaper ones for smaller parts.

use crate::math::Aabb;
use crate::sdf::Field;
use std::sync::Arc;

/// Fields cheaper than this are not worth pruning.
const CHEAP: usize = 16;

/// Items of a part that is not divided again.
const FEW: usize = 64;

/// A binary tree of parts, each with its field.
pub(super) struct Fields<'f> {
    root: &'f dyn Field,
    parts: Vec<Part>,
    /// The smallest part that holds each item.
    of_item: Vec<u32>,
}

struct Part {
    bounds: Aabb,
    field: Arc<dyn Field>,
    parent: u32,
}

/// Where there is no part.
const WHOLE: u32 = u32::MAX;

impl<'f> Fields<'f> {
    /// The tree over items that have a box each.
    pub(super) fn over(root: &'f dyn Field, boxes: &[Aabb]) -> Fields<'f> {
        let mut fields = Fields { root, parts: Vec::new(), of_item: vec![WHOLE; boxes.len()] };
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        fields.divide(&mut order, boxes, WHOLE);
        fields
    }

    fn divide(&mut self, items: &mut [u32], boxes: &[Aabb], parent: u32) {
        let field = self.field(parent);
        if items.is_empty() || field.cost() <= CHEAP {
            return;
        }
        let bounds = items.iter().fold(Aabb::EMPTY, |all, &i| all.union(boxes[i as usize]));
        // A little less is not worth the memory.
        let pruned = field.within(bounds).filter(|pruned| 4 * pruned.cost() < 3 * field.cost());
        let part = match pruned {
            Some(field) => {
                self.parts.push(Part { bounds, field, parent });
                let part = self.parts.len() as u32 - 1;
                items.iter().for_each(|&i| self.of_item[i as usize] = part);
                part
            }
            None => parent,
        };
        if items.len() <= FEW {
            return;
        }
        let size = bounds.size();
        let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
        let key = |i: u32| boxes[i as usize].min[axis] + boxes[i as usize].max[axis];
        let middle = items.len() / 2;
        items.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        let (low, high) = items.split_at_mut(middle);
        self.divide(low, boxes, part);
        self.divide(high, boxes, part);
    }

    fn field(&self, part: u32) -> &dyn Field {
        if part == WHOLE { self.root } else { &*self.parts[part as usize].field }
    }

    /// The cheapest field that stands for the whole one in a cell around an item.
    pub(super) fn within(&self, item: u32, cell: Aabb) -> &dyn Field {
        let mut part = self.of_item[item as usize];
        while part != WHOLE {
            let Part { bounds, parent, .. } = &self.parts[part as usize];
            if bounds.min.cmple(cell.min).all() && cell.max.cmple(bounds.max).all() {
                break;
            }
            part = *parent;
        }
        self.field(part)
    }
}
