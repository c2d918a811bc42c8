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
        }
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
            Tree::Node(_, parts) => parts.iter().for_each(|part| part.visit(see)),
        }
    }

    /// The same expression with other names for the operands.
    pub(super) fn renamed(&self, name: &impl Fn(usize) -> usize) -> Tree {
        match self {
            Tree::Leaf(index) => Tree::Leaf(name(*index)),
            Tree::Node(op, parts) => Tree::Node(*op, parts.iter().map(|part| part.renamed(name)).collect()),
        }
    }

    /// The largest operand it names, if any.
    pub fn last_operand(&self) -> Option<usize> {
        match self {
            Tree::Leaf(index) => Some(*index),
            Tree::Node(_, parts) => parts.iter().filter_map(Tree::last_operand).max(),
        }
    }
}
