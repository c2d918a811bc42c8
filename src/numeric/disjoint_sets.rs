/// Items 0 to n - 1 in disjoint sets; each set is named by its smallest item, so names do not depend on the order of
/// joining (Galler and Fischer 1964, with path halving).
#[derive(Clone, Debug, Default)]
pub struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    /// Every item in a set of its own.
    pub fn new(count: usize) -> DisjointSets {
        DisjointSets { parent: (0..count as u32).collect() }
    }

    /// Adds an item in a set of its own and returns it.
    pub fn add(&mut self) -> u32 {
        self.parent.push(self.parent.len() as u32);
        self.parent.len() as u32 - 1
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.parent.len()
    }

    /// Whether there is no item.
    pub fn is_empty(&self) -> bool {
        self.parent.is_empty()
    }

    /// The smallest item of the set of `item`.
    #[inline]
    pub fn find(&mut self, mut item: u32) -> u32 {
        while self.parent[item as usize] != item {
            let up = self.parent[item as usize];
            self.parent[item as usize] = self.parent[up as usize];
            item = self.parent[item as usize];
        }
        item
    }

    /// Makes two sets one and returns its name.
    #[inline]
    pub fn join(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a.min(b)
    }

    /// Numbers the sets from 0 in the order of their smallest items: the number of each item's set, and how many there
    /// are.
    pub fn numbered(mut self) -> (Vec<u32>, u32) {
        let mut count = 0;
        for item in 0..self.parent.len() {
            // A parent is smaller than its items, so it holds its number when their turn comes.
            let parent = self.parent[item] as usize;
            self.parent[item] = if parent == item {
                count += 1;
                count - 1
            } else {
                self.parent[parent]
            };
        }
        (self.parent, count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_named_and_numbered_by_their_smallest_items() {
        let mut sets = DisjointSets::new(6);
        sets.join(5, 3);
        sets.join(4, 1);
        sets.join(3, 4);
        assert_eq!([0, 1, 2, 3, 4, 5].map(|i| sets.find(i)), [0, 1, 2, 1, 1, 1]);
        assert_eq!(sets.numbered(), (vec![0, 1, 2, 1, 1, 1], 3));
    }
}
