//! fidget's formulas, and its compiler as the evaluator of those peers that take values on a grid.

use crate::models::DOMAIN;
use fidget::context::Tree;
use fidget::jit::JitShape;
use fidget::shape::EzShape;
use ogee::sdf::{Binary, Operation, Unary};

/// The formula as fidget's.
pub(crate) fn tree(plain: &[Operation]) -> Tree {
    let mut made: Vec<Tree> = Vec::with_capacity(plain.len());
    for operation in plain {
        let of = |id: u32| made[id as usize].clone();
        let tree = match *operation {
            Operation::Axis(0) => Tree::x(),
            Operation::Axis(1) => Tree::y(),
            Operation::Axis(_) => Tree::z(),
            Operation::Constant(x) => Tree::constant(x as f32),
            Operation::Unary(op, a) => unary(op, &of(a)),
            Operation::Binary(op, a, b) => binary(op, of(a), of(b)),
        };
        made.push(tree);
    }
    made.pop().expect("a result")
}

fn unary(op: Unary, a: &Tree) -> Tree {
    match op {
        Unary::Neg => a.neg(),
        Unary::Abs => a.abs(),
        Unary::Recip => a.recip(),
        Unary::Sqrt => a.sqrt(),
        Unary::Square => a.square(),
        Unary::Sin => a.sin(),
        Unary::Cos => a.cos(),
        _ => unreachable!("no model has {}", op.name()),
    }
}

fn binary(op: Binary, a: Tree, b: Tree) -> Tree {
    match op {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Min => a.min(b),
        Binary::Max => a.max(b),
        _ => unreachable!("no model has {}", op.name()),
    }
}

/// The values at the corners of the domain's cells, x fastest.
pub(crate) fn grid(shape: &JitShape, cells: usize) -> Vec<f32> {
    let tape = shape.ez_float_slice_tape();
    let mut evaluator = JitShape::new_float_slice_eval();
    let count = cells + 1;
    let at = |i: usize| (DOMAIN.min.x + DOMAIN.size().x * i as f64 / cells as f64) as f32;
    let row: Vec<f32> = (0..count).map(at).collect();
    let (mut x, mut y, mut z) = (Vec::new(), Vec::new(), Vec::new());
    let mut values = Vec::with_capacity(count * count * count);
    for &height in &row {
        for &side in &row {
            x.extend_from_slice(&row);
            y.resize(x.len(), side);
        }
        z.resize(x.len(), height);
        values.extend_from_slice(evaluator.eval(&tape, &x, &y, &z).expect("three coordinates"));
        x.clear();
        y.clear();
        z.clear();
    }
    values
}
