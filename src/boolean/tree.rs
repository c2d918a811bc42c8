/// A boolean operation on any number of operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// Where at least one operand is; empty for no operand.
    Union,
    /// Where all operands are; empty for no operand.
    Intersection,
    /// Where the first operand is and no other.
    Difference,
    /// Where an odd number of operands is.
    SymmetricDifference,
}

/// A boolean expression over operands, which it names by index.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// The operand with this index.
    Leaf(usize),
    /// An operation on subtrees.
    Node(Op, Vec<Tree>),
    /// Where at least so many of the subtrees are. No place is in at least 0 of them: what is everywhere is no solid.
    AtLeast(u32, Vec<Tree>),
}

impl Tree {
    /// An operation on the first `count` operands.
    pub fn flat(op: Op, count: usize) -> Tree {
        Tree::Node(op, (0..count).map(Tree::Leaf).collect())
    }

    /// Whether a place is inside, given the sorted operands that wind around it and how often each does. An operand is
    /// inside itself where it winds at least once.
    pub fn holds(&self, winding: &[(u32, i32)]) -> bool {
        let is_in = |tree: &Tree| tree.holds(winding);
        match self {
            Tree::Leaf(index) => {
                let found = winding.binary_search_by_key(index, |&(operand, _)| operand as usize);
                found.is_ok_and(|at| winding[at].1 >= 1)
            }
            Tree::Node(Op::Union, parts) => parts.iter().any(is_in),
            Tree::Node(Op::Intersection, parts) => !parts.is_empty() && parts.iter().all(is_in),
            Tree::Node(Op::Difference, parts) => match parts.split_first() {
                Some((first, rest)) => is_in(first) && !rest.iter().any(is_in),
                None => false,
            },
            Tree::Node(Op::SymmetricDifference, parts) => {
                parts.iter().filter(|part| is_in(part)).count() % 2 == 1
            }
            Tree::AtLeast(least, parts) => {
                *least > 0 && parts.iter().filter(|part| is_in(part)).count() >= *least as usize
            }
        }
    }

    /// The same expression with operations of operations of one kind made one: `(a + b) + c` is `a + b + c`, and
    /// `(a - b) - c` is `a - b - c`.
    pub(super) fn flattened(&self) -> Tree {
        let (op, parts) = match self {
            Tree::Leaf(_) => return self.clone(),
            Tree::AtLeast(least, parts) => {
                return Tree::AtLeast(*least, parts.iter().map(Tree::flattened).collect());
            }
            Tree::Node(op, parts) => (op, parts),
        };
        let mut flat = Vec::with_capacity(parts.len());
        for (place, part) in parts.iter().enumerate() {
            let merges = match op {
                Op::Union | Op::SymmetricDifference => true,
                // Without parts an intersection is empty, and so is all that it is a part of.
                Op::Intersection => !part.is_empty_node(),
                Op::Difference => place == 0 && !part.is_empty_node(),
            };
            match part.flattened() {
                Tree::Node(inner, inner_parts) if merges && inner == *op => flat.extend(inner_parts),
                Tree::Node(Op::Union, inner_parts) if *op == Op::Difference && place > 0 => {
                    flat.extend(inner_parts);
                }
                other => flat.push(other),
            }
        }
        Tree::Node(*op, flat)
    }

    fn is_empty_node(&self) -> bool {
        matches!(self, Tree::Node(_, parts) | Tree::AtLeast(_, parts) if parts.is_empty())
    }

    /// The operands it names, in order, and how often it names each.
    pub(super) fn leaves(&self) -> Vec<(usize, u32)> {
        let mut named = Vec::new();
        self.visit(&mut |leaf| named.push(leaf));
        named.sort_unstable();
        named.chunk_by(|a, b| a == b).map(|group| (group[0], group.len() as u32)).collect()
    }

    fn visit(&self, see: &mut impl FnMut(usize)) {
        match self {
            Tree::Leaf(index) => see(*index),
            Tree::Node(_, parts) | Tree::AtLeast(_, parts) => parts.iter().for_each(|part| part.visit(see)),
        }
    }

    /// The same expression with other names for the operands.
    pub(super) fn renamed(&self, name: &impl Fn(usize) -> usize) -> Tree {
        let all = |parts: &[Tree]| parts.iter().map(|part| part.renamed(name)).collect();
        match self {
            Tree::Leaf(index) => Tree::Leaf(name(*index)),
            Tree::Node(op, parts) => Tree::Node(*op, all(parts)),
            Tree::AtLeast(least, parts) => Tree::AtLeast(*least, all(parts)),
        }
    }

    /// The largest operand it names, if any.
    pub fn last_operand(&self) -> Option<usize> {
        match self {
            Tree::Leaf(index) => Some(*index),
            Tree::Node(_, parts) | Tree::AtLeast(_, parts) => {
                parts.iter().filter_map(Tree::last_operand).max()
            }
        }
    }
}

/// A tree prepared for many places: only what lies above the operands that wind around a place is looked at.
#[derive(Debug)]
pub(super) struct Judge {
    /// For each operand, the nodes it is a part of, and whether as the first part.
    homes: Vec<Vec<(u32, bool)>>,
    nodes: Vec<Node>,
    /// For each node, how many of its parts hold, the first one counted apart.
    holding: Vec<(bool, u32)>,
}

/// An operation; parts come before the nodes they are parts of.
#[derive(Clone, Copy, Debug)]
struct Node {
    rule: Rule,
    parts: u32,
    /// The node it is a part of, and whether as the first part.
    home: Option<(u32, bool)>,
}

/// When an operation holds.
#[derive(Clone, Copy, Debug)]
enum Rule {
    Op(Op),
    AtLeast(u32),
}

impl Judge {
    pub(super) fn new(tree: &Tree, operands: usize) -> Judge {
        let mut judge = Judge { homes: vec![Vec::new(); operands], nodes: Vec::new(), holding: Vec::new() };
        // A union of one stands for an operand alone.
        match tree {
            Tree::Leaf(_) => judge.add(Rule::Op(Op::Union), std::slice::from_ref(tree)),
            Tree::Node(op, parts) => judge.add(Rule::Op(*op), parts),
            Tree::AtLeast(least, parts) => judge.add(Rule::AtLeast(*least), parts),
        };
        judge.holding = vec![(false, 0); judge.nodes.len()];
        judge
    }

    fn add(&mut self, rule: Rule, parts: &[Tree]) -> u32 {
        let inner: Vec<Option<u32>> = parts
            .iter()
            .map(|part| match part {
                Tree::Leaf(_) => None,
                Tree::Node(op, parts) => Some(self.add(Rule::Op(*op), parts)),
                Tree::AtLeast(least, parts) => Some(self.add(Rule::AtLeast(*least), parts)),
            })
            .collect();
        let node = self.nodes.len() as u32;
        self.nodes.push(Node { rule, parts: parts.len() as u32, home: None });
        for (place, (part, inner)) in parts.iter().zip(inner).enumerate() {
            match (part, inner) {
                (Tree::Leaf(leaf), _) => self.homes[*leaf].push((node, place == 0)),
                (_, Some(inner)) => self.nodes[inner as usize].home = Some((node, place == 0)),
                _ => {}
            }
        }
        node
    }

    /// [`Tree::holds`].
    pub(super) fn holds(&mut self, winding: &[(u32, i32)]) -> bool {
        let mut above: Vec<u32> = Vec::new();
        for &(operand, _) in winding.iter().filter(|&&(_, times)| times >= 1) {
            for &home in &self.homes[operand as usize] {
                count(&mut self.holding, home);
                above.push(home.0);
            }
        }
        // Where no part holds, no operation does. Parts come first.
        let mut waiting = std::collections::BinaryHeap::new();
        waiting.extend(above.into_iter().map(std::cmp::Reverse));
        let root = self.nodes.len() as u32 - 1;
        let mut result = false;
        while let Some(std::cmp::Reverse(node)) = waiting.pop() {
            while waiting.peek() == Some(&std::cmp::Reverse(node)) {
                waiting.pop();
            }
            let Node { rule, parts, home } = self.nodes[node as usize];
            let (first, rest) = std::mem::take(&mut self.holding[node as usize]);
            let all = rest + u32::from(first);
            let holds = match rule {
                Rule::Op(Op::Union) => all > 0,
                Rule::Op(Op::Intersection) => all == parts,
                Rule::Op(Op::Difference) => first && rest == 0,
                Rule::Op(Op::SymmetricDifference) => all % 2 == 1,
                Rule::AtLeast(least) => least > 0 && all >= least,
            };
            if holds {
                if let Some(home) = home {
                    count(&mut self.holding, home);
                    waiting.push(std::cmp::Reverse(home.0));
                }
                result |= node == root;
            }
        }
        result
    }
}

fn count(holding: &mut [(bool, u32)], (node, first): (u32, bool)) {
    let (is_first, rest) = &mut holding[node as usize];
    if first { *is_first = true } else { *rest += 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All ways for four operands to wind around a place.
    fn windings() -> impl Iterator<Item = Vec<(u32, i32)>> {
        (0..81_u32).map(|code| {
            let times = |k: u32| (code / 3_u32.pow(k) % 3) as i32 - 1;
            (0..4).map(|k| (k, times(k))).filter(|&(_, times)| times != 0).collect()
        })
    }

    fn trees() -> Vec<Tree> {
        use Op::{Difference, Intersection, SymmetricDifference, Union};
        let leaf = Tree::Leaf;
        let node = Tree::Node;
        vec![
            leaf(2),
            node(Union, vec![]),
            node(Difference, vec![leaf(0), node(Union, vec![leaf(1), leaf(2)]), leaf(3)]),
            node(Difference, vec![node(Difference, vec![leaf(0), leaf(1)]), leaf(2), leaf(0)]),
            node(Difference, vec![node(Difference, vec![]), leaf(1)]),
            node(Intersection, vec![leaf(0), node(Intersection, vec![leaf(1), leaf(3)])]),
            node(Intersection, vec![leaf(0), node(Intersection, vec![])]),
            node(
                SymmetricDifference,
                vec![leaf(0), node(SymmetricDifference, vec![leaf(1), leaf(1), leaf(2)])],
            ),
            node(
                Union,
                vec![node(Difference, vec![leaf(3), node(Difference, vec![leaf(0), leaf(1)])]), leaf(2)],
            ),
            node(Difference, vec![leaf(0), node(Intersection, vec![leaf(1), leaf(2)]), leaf(0)]),
            Tree::AtLeast(0, vec![leaf(0), leaf(1)]),
            Tree::AtLeast(2, vec![leaf(0), leaf(1), node(Union, vec![leaf(2), leaf(3)])]),
            Tree::AtLeast(2, vec![leaf(0), leaf(0), leaf(1)]),
            Tree::AtLeast(5, vec![leaf(0), leaf(1)]),
            node(Difference, vec![Tree::AtLeast(2, vec![leaf(0), leaf(1), leaf(2)]), leaf(3)]),
            node(Intersection, vec![leaf(0), Tree::AtLeast(1, vec![])]),
        ]
    }

    #[test]
    fn flattened_trees_say_the_same() {
        for tree in trees() {
            for winding in windings() {
                assert_eq!(tree.flattened().holds(&winding), tree.holds(&winding), "{tree:?} at {winding:?}");
            }
        }
    }

    #[test]
    fn a_judge_says_the_same() {
        for tree in trees() {
            let mut judge = Judge::new(&tree, 4);
            for winding in windings() {
                assert_eq!(judge.holds(&winding), tree.holds(&winding), "{tree:?} at {winding:?}");
            }
        }
    }
}
