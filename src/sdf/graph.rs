//! Formulas with all equal parts merged, ready to be put in order.

use super::expr::{Expr, Op};
use super::op::{Binary, Unary};
use crate::numeric::ContentHasher;
use std::collections::HashMap;
use std::sync::Arc;

/// An operation and the numbers of the steps it takes its arguments from, all earlier ones.
#[derive(Clone)]
pub(super) struct Step {
    pub(super) op: Op,
    pub(super) args: [u32; 3],
    pub(super) arity: u8,
}

impl Step {
    pub(super) fn new(op: Op, args: &[u32]) -> Step {
        let mut padded = [0; 3];
        padded[..args.len()].copy_from_slice(args);
        Step { op, args: padded, arity: args.len() as u8 }
    }

    pub(super) fn args(&self) -> &[u32] {
        &self.args[..usize::from(self.arity)]
    }
}

/// Steps in an order in which each can be computed from those before.
#[derive(Default)]
pub(super) struct Graph {
    pub(super) steps: Vec<Step>,
    /// Numbers of steps by a hash of what they are; only looked up in.
    known: HashMap<u128, u32>,
}

impl Graph {
    /// All of a formula, and the number of its last step.
    pub(super) fn of(root: &Expr) -> (Graph, u32) {
        let mut graph = Graph::default();
        let axes = [0, 1, 2].map(|axis| graph.add(Op::Axis(axis), &[]));
        let root = Walk::new(&mut graph, axes).build(root);
        (graph, root)
    }

    /// The number of an operation's step, which is a new one when there is none like it. Rewrites that keep all bits
    /// are made here.
    pub(super) fn add(&mut self, op: Op, args: &[u32]) -> u32 {
        match &op {
            Op::Binary(Binary::Mul) if args[0] == args[1] => {
                return self.add(Op::Unary(Unary::Square), &args[..1]);
            }
            Op::Unary(Unary::Sqrt) => {
                if let Some(parts) = self.as_sum_of_squares(args[0]) {
                    return self.add(Op::Norm, &parts);
                }
            }
            Op::Linear(row) => return self.add_linear(*row, args),
            _ => {}
        }
        self.merge(Step::new(op, args))
    }

    fn merge(&mut self, step: Step) -> u32 {
        let hash = content(&step);
        *self.known.entry(hash).or_insert_with(|| {
            self.steps.push(step);
            self.steps.len() as u32 - 1
        })
    }

    /// The arguments of two or three squares added up from the left.
    fn as_sum_of_squares(&self, sum: u32) -> Option<Vec<u32>> {
        let step = |id: u32| &self.steps[id as usize];
        let square = |id: u32| matches!(step(id).op, Op::Unary(Unary::Square)).then(|| step(id).args[0]);
        let parts = |id: u32| matches!(step(id).op, Op::Binary(Binary::Add)).then(|| step(id).args);
        let [left, right, _] = parts(sum)?;
        let last = square(right)?;
        if let Some(first) = square(left) {
            return Some(vec![first, last]);
        }
        let [first, second, _] = parts(left)?;
        Some(vec![square(first)?, square(second)?, last])
    }

    /// A linear map of linear maps of the same arguments is one of them.
    fn add_linear(&mut self, row: [f64; 4], args: &[u32]) -> u32 {
        let used: Vec<usize> = (0..3).filter(|&i| row[i] != 0.0).collect();
        match used[..] {
            [] => return self.merge(Step::new(Op::Constant(row[3]), &[])),
            [one] if row[one] == 1.0 && row[3] == 0.0 => return args[one],
            _ => {}
        }
        let inner: Vec<([f64; 4], [u32; 3])> = used.iter().filter_map(|&i| self.as_linear(args[i])).collect();
        let together = inner.len() == used.len() && inner.iter().all(|(_, base)| *base == inner[0].1);
        if !together {
            return self.merge(Step::new(Op::Linear(row), args));
        }
        let mut whole = [0.0, 0.0, 0.0, row[3]];
        for (&i, (part, _)) in used.iter().zip(&inner) {
            (0..4).for_each(|k| whole[k] += row[i] * part[k]);
        }
        self.add_linear_of_others(whole, inner[0].1)
    }

    fn add_linear_of_others(&mut self, row: [f64; 4], base: [u32; 3]) -> u32 {
        let single = (0..3).find(|&i| row[i] == 1.0 && (0..4).all(|k| k == i || row[k] == 0.0));
        match single {
            Some(i) => base[i],
            None => self.merge(Step::new(Op::Linear(row), &base)),
        }
    }

    fn as_linear(&self, id: u32) -> Option<([f64; 4], [u32; 3])> {
        match &self.steps[id as usize] {
            Step { op: Op::Linear(row), args, .. } => Some((*row, *args)),
            Step { op: Op::Axis(axis), .. } => {
                let mut row = [0.0; 4];
                row[usize::from(*axis)] = 1.0;
                // The axes are the first three steps.
                Some((row, [0, 1, 2]))
            }
            _ => None,
        }
    }
}

/// A hash of an operation and its arguments.
fn content(step: &Step) -> u128 {
    let mut hasher = ContentHasher::default();
    let mut kind = |kind: u64, of: u64| hasher.integers([kind, of]);
    match &step.op {
        Op::Axis(axis) => kind(0, u64::from(*axis)),
        Op::Constant(x) => kind(1, x.to_bits()),
        Op::Unary(op) => kind(2, *op as u64),
        Op::Binary(op) => kind(3, *op as u64),
        Op::Power(exponent) => kind(4, exponent.to_bits()),
        Op::Linear(row) => {
            kind(5, 0);
            hasher.integers(row.map(f64::to_bits));
        }
        Op::Norm => kind(6, 0),
        Op::Corner => kind(7, 0),
        Op::Blend(blend) => {
            kind(8, blend.kind());
            hasher.integers([blend.size().to_bits()]);
        }
        Op::Primitive(primitive) => {
            let (which, numbers) = primitive.parameters();
            kind(9, u64::from(which));
            hasher.integers(numbers.into_iter().map(f64::to_bits));
        }
        Op::Field(field) => kind(10, Arc::as_ptr(field).cast::<u8>() as u64),
        Op::Place => kind(11, 0),
    }
    hasher.integers(step.args().iter().map(|&arg| u64::from(arg)));
    hasher.integers([u64::from(step.arity)]);
    hasher.finish()
}

/// Goes through a formula, arguments first, without recursion: formulas may be deep.
struct Walk<'g, 'e> {
    graph: &'g mut Graph,
    /// What stands for x, y, z; formulas that are placed elsewhere have their own.
    frames: Vec<[u32; 3]>,
    frame_ids: HashMap<[u32; 3], usize>,
    done: HashMap<(usize, usize), u32>,
    tasks: Vec<(Task, &'e Expr, usize)>,
}

#[derive(Clone, Copy)]
enum Task {
    Visit,
    /// All arguments are there.
    Finish,
    /// The coordinates of a placed formula are there.
    Enter,
    /// The placed formula is there, in this frame.
    Leave(usize),
}

impl<'e> Walk<'_, 'e> {
    fn new(graph: &mut Graph, axes: [u32; 3]) -> Walk<'_, 'e> {
        Walk {
            graph,
            frames: vec![axes],
            frame_ids: HashMap::from([(axes, 0)]),
            done: HashMap::new(),
            tasks: Vec::new(),
        }
    }

    fn build(mut self, root: &'e Expr) -> u32 {
        self.tasks.push((Task::Visit, root, 0));
        while let Some((task, expr, frame)) = self.tasks.pop() {
            if self.done.contains_key(&(expr.address(), frame)) {
                continue;
            }
            match task {
                Task::Visit => self.visit(expr, frame),
                Task::Finish => self.finish(expr, frame),
                Task::Enter => self.enter(expr, frame),
                Task::Leave(inner) => {
                    let id = self.id(&expr.node().args[0], inner);
                    self.done.insert((expr.address(), frame), id);
                }
            }
        }
        self.id(root, 0)
    }

    fn id(&self, expr: &Expr, frame: usize) -> u32 {
        self.done[&(expr.address(), frame)]
    }

    fn visit(&mut self, expr: &'e Expr, frame: usize) {
        let node = expr.node();
        match &node.op {
            Op::Axis(axis) => {
                self.done.insert((expr.address(), frame), self.frames[frame][usize::from(*axis)]);
            }
            Op::Place => {
                self.tasks.push((Task::Enter, expr, frame));
                self.tasks.extend(node.args[1..].iter().map(|arg| (Task::Visit, arg, frame)));
            }
            _ => {
                self.tasks.push((Task::Finish, expr, frame));
                self.tasks.extend(node.args.iter().map(|arg| (Task::Visit, arg, frame)));
            }
        }
    }

    fn finish(&mut self, expr: &'e Expr, frame: usize) {
        let args: Vec<u32> = expr.node().args.iter().map(|arg| self.id(arg, frame)).collect();
        let id = self.graph.add(expr.node().op.clone(), &args);
        self.done.insert((expr.address(), frame), id);
    }

    fn enter(&mut self, expr: &'e Expr, frame: usize) {
        let args = &expr.node().args;
        let coordinates = [1, 2, 3].map(|i| self.id(&args[i], frame));
        let inner = *self.frame_ids.entry(coordinates).or_insert_with(|| {
            self.frames.push(coordinates);
            self.frames.len() - 1
        });
        self.tasks.push((Task::Leave(inner), expr, frame));
        self.tasks.push((Task::Visit, &args[0], inner));
    }
}
