use super::dual::Dual;
use super::expr::{Expr, Op, linear};
use super::field::{Curvature, Field, Points, Slopes};
use super::graph::{Graph, Step};
use super::number::{Number, Second};
use super::op::{Binary, Unary};
use super::primitive::Primitive;
use super::prune;
use super::real::{LANES, Lanes, Real};
use super::{Range, registers};
use crate::math::{Aabb, Interval, Vec3};
use std::array::from_fn;
use std::cell::Cell;
use std::sync::Arc;

/// A formula put in order for evaluation: equal parts merged, a register reused as soon as nobody needs it.
///
/// All ways to evaluate it (one point, many, with gradients, over boxes) do the same operations in the same order.
/// Many points at a time are five to twenty times as fast as one by one.
#[derive(Clone)]
pub struct Tape {
    /// In an order in which each can be computed from those before; the last is the result.
    pub(super) steps: Vec<Step>,
    program: registers::Program,
    lipschitz: Option<f64>,
    bounds: Option<Aabb>,
}

/// Groups of lanes that a batch computes before it goes on to the next operation. Enough to make choosing the
/// operation cheap, few enough for the registers to stay in the nearest cache.
const GROUPS: usize = 8;

/// Points in a batch.
const BATCH: usize = GROUPS * LANES;

impl Tape {
    /// A formula's tape. Nothing is known of its slope or its bounds.
    pub fn new(expr: &Expr) -> Tape {
        let (graph, root) = Graph::of(expr);
        Tape::of_steps(graph.steps, root)
    }

    /// The tape of those steps that `root` needs.
    pub(super) fn of_steps(steps: Vec<Step>, root: u32) -> Tape {
        let steps = needed(steps, root);
        let program = registers::Program::new(&steps);
        Tape { steps, program, lipschitz: None, bounds: None }
    }

    /// With what is known of it: a proven bound of its slope, and a box that holds all that is inside.
    pub fn with_knowledge(self, lipschitz: Option<f64>, bounds: Option<Aabb>) -> Tape {
        Tape { lipschitz, bounds, ..self }
    }

    /// Number of operations, constants and coordinates included.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether it is a mere constant.
    pub fn is_empty(&self) -> bool {
        matches!(self.steps[..], [Step { op: Op::Constant(_), .. }])
    }

    /// The number it is everywhere, when it is a mere constant.
    pub fn as_constant(&self) -> Option<f64> {
        match self.steps[..] {
            [Step { op: Op::Constant(x), .. }] => Some(x),
            _ => None,
        }
    }

    /// The result with this kind of number, without reuse of registers for plain code: few points and boxes.
    fn run<T: Number>(&self, axes: [T; 3], registers: &mut Vec<T>) -> T {
        registers.clear();
        registers.resize(self.program.registers, T::of(0.0));
        for step in &self.program.steps {
            let args = from_fn(|i| registers[step.args[i] as usize]);
            let source = &self.steps[step.source as usize];
            registers[step.out as usize] = one(source, axes, args);
        }
        registers[self.program.result as usize]
    }

    /// The values of all steps, in order.
    pub(super) fn trace<T: Number>(&self, axes: [T; 3], values: &mut Vec<T>) {
        values.clear();
        for step in &self.steps {
            let args =
                from_fn(
                    |i| if i < usize::from(step.arity) { values[step.args[i] as usize] } else { axes[i] },
                );
            values.push(one(step, axes, args));
        }
    }

    fn run_ranges<T: Number>(&self, cell: Aabb, lift: impl Fn(Range, usize) -> T) -> T {
        let mut registers = Vec::new();
        self.run(axes_of(cell, lift), &mut registers)
    }

    /// Up to [`BATCH`] points.
    fn batch(&self, points: Points<'_>, registers: &mut [[Lanes; GROUPS]], out: &mut [f64]) {
        let count = out.len();
        let groups = count.div_ceil(LANES);
        let axes = [points.x, points.y, points.z].map(|x| padded(x, count));
        for step in &self.program.steps[self.program.constants..] {
            let source = &self.steps[step.source as usize];
            let sweep = Sweep { registers: &mut *registers, out: step.out, args: step.args, groups };
            sweep.step(source, &axes);
        }
        let result = &registers[self.program.result as usize];
        for (value, i) in out.iter_mut().zip(0..) {
            *value = result[i / LANES].0[i % LANES];
        }
    }

    fn constants(&self, registers: &mut [[Lanes; GROUPS]]) {
        for step in &self.program.steps[..self.program.constants] {
            if let Op::Constant(x) = self.steps[step.source as usize].op {
                registers[step.out as usize] = [Lanes::of(x); GROUPS];
            }
        }
    }
}

/// The steps that a result needs, renumbered; the result comes last.
fn needed(steps: Vec<Step>, root: u32) -> Vec<Step> {
    let mut used = vec![false; steps.len()];
    used[root as usize] = true;
    for (id, step) in steps.iter().enumerate().rev() {
        if used[id] {
            step.args().iter().for_each(|&arg| used[arg as usize] = true);
        }
    }
    let mut names = vec![0; steps.len()];
    let mut kept = Vec::new();
    for (id, mut step) in steps.into_iter().enumerate().take(root as usize + 1) {
        if used[id] {
            step.args = step.args.map(|arg| names.get(arg as usize).copied().unwrap_or(0));
            names[id] = kept.len() as u32;
            kept.push(step);
        }
    }
    kept
}

/// One step with any kind of number.
#[inline]
fn one<T: Number>(step: &Step, axes: [T; 3], args: [T; 3]) -> T {
    match &step.op {
        Op::Axis(axis) => axes[usize::from(*axis)],
        Op::Field(field) => T::of_field(&**field, args),
        Op::Primitive(primitive) => T::of_primitive(*primitive, args),
        op => op.apply(args, usize::from(step.arity)),
    }
}

/// The coordinates over a cell.
pub(super) fn axes_of<T>(cell: Aabb, lift: impl Fn(Range, usize) -> T) -> [T; 3] {
    from_fn(|axis| lift(Range::of(Interval::new(cell.min[axis], cell.max[axis])), axis))
}

/// The first `count` numbers, and zeros.
fn padded(numbers: &[f64], count: usize) -> [Lanes; GROUPS] {
    let mut lanes = [Lanes([0.0; LANES]); GROUPS];
    for (i, &x) in numbers[..count].iter().enumerate() {
        lanes[i / LANES].0[i % LANES] = x;
    }
    lanes
}

/// One operation over all groups of a batch.
struct Sweep<'a> {
    registers: &'a mut [[Lanes; GROUPS]],
    out: u32,
    args: [u32; 3],
    groups: usize,
}

impl Sweep<'_> {
    #[inline(always)]
    fn each(self, f: impl Fn([Lanes; 3]) -> Lanes) {
        let [a, b, c] = self.args.map(|arg| arg as usize);
        for group in 0..self.groups {
            let args = [self.registers[a][group], self.registers[b][group], self.registers[c][group]];
            self.registers[self.out as usize][group] = f(args);
        }
    }

    #[inline(always)]
    fn each1(self, f: impl Fn(Lanes) -> Lanes) {
        let a = self.args[0] as usize;
        for group in 0..self.groups {
            self.registers[self.out as usize][group] = f(self.registers[a][group]);
        }
    }

    #[inline(always)]
    fn each2(self, f: impl Fn(Lanes, Lanes) -> Lanes) {
        let [a, b, _] = self.args.map(|arg| arg as usize);
        for group in 0..self.groups {
            self.registers[self.out as usize][group] = f(self.registers[a][group], self.registers[b][group]);
        }
    }

    /// Rows of one factor, as those of shapes that are moved, without asking in the loop which.
    fn linear(mut self, row: &[f64; 4]) {
        let mut used = (0..3).filter(|&axis| row[axis] != 0.0);
        let (Some(axis), None) = (used.next(), used.next()) else {
            return self.each(|args| linear(row, args));
        };
        self.args[0] = self.args[axis];
        let (factor, shift) = (Lanes::of(row[axis]), Lanes::of(row[3]));
        match (row[axis] == 1.0, row[3] == 0.0) {
            (true, true) => self.each1(|x| x),
            (true, false) => self.each1(|x| x + shift),
            (false, true) => self.each1(|x| factor * x),
            (false, false) => self.each1(|x| factor * x + shift),
        }
    }

    /// The frequent operations have loops of their own, which become vector instructions.
    fn step(self, step: &Step, axes: &[[Lanes; GROUPS]; 3]) {
        match &step.op {
            Op::Axis(axis) => self.registers[self.out as usize] = axes[usize::from(*axis)],
            Op::Unary(Unary::Neg) => self.each1(|a| -a),
            Op::Unary(Unary::Abs) => self.each1(Real::abs),
            Op::Unary(Unary::Square) => self.each1(Real::square),
            Op::Unary(Unary::Sqrt) => self.each1(Real::sqrt),
            Op::Unary(op) => self.each1(|a| op.apply(a)),
            Op::Binary(Binary::Add) => self.each2(|a, b| a + b),
            Op::Binary(Binary::Sub) => self.each2(|a, b| a - b),
            Op::Binary(Binary::Mul) => self.each2(|a, b| a * b),
            Op::Binary(Binary::Div) => self.each2(|a, b| a / b),
            Op::Binary(Binary::Min) => self.each2(Real::min),
            Op::Binary(Binary::Max) => self.each2(Real::max),
            Op::Binary(op) => self.each2(|a, b| op.apply(a, b)),
            Op::Linear(row) => self.linear(row),
            &Op::Primitive(Primitive::Sphere { radius }) => {
                self.each(|args| Primitive::Sphere { radius }.apply(args));
            }
            &Op::Primitive(Primitive::Cuboid { half }) => {
                self.each(|args| Primitive::Cuboid { half }.apply(args));
            }
            Op::Primitive(primitive) => self.each(|args| primitive.apply(args)),
            Op::Field(field) => self.each(|args| Lanes::of_field(&**field, args)),
            op => self.each(|args| op.apply(args, usize::from(step.arity))),
        }
    }
}

thread_local! {
    /// Registers of single points; whoever needs them takes them and puts them back.
    static SINGLE: Cell<Vec<f64>> = const { Cell::new(Vec::new()) };
    static DUAL: Cell<Vec<Dual<f64>>> = const { Cell::new(Vec::new()) };
    static BATCHES: Cell<Vec<[Lanes; GROUPS]>> = const { Cell::new(Vec::new()) };
}

impl Field for Tape {
    fn value(&self, point: Vec3) -> f64 {
        let mut registers = SINGLE.take();
        let value = self.run(point.to_array(), &mut registers);
        SINGLE.set(registers);
        value
    }

    fn values(&self, points: Points<'_>, out: &mut [f64]) {
        points.check(out.len());
        let mut registers = BATCHES.take();
        registers.clear();
        registers.resize(self.program.registers, [Lanes([0.0; LANES]); GROUPS]);
        self.constants(&mut registers);
        for (start, out) in (0..).step_by(BATCH).zip(out.chunks_mut(BATCH)) {
            let part = start..start + out.len();
            let part = Points { x: &points.x[part.clone()], y: &points.y[part.clone()], z: &points.z[part] };
            self.batch(part, &mut registers, out);
        }
        BATCHES.set(registers);
    }

    fn gradient(&self, point: Vec3) -> (f64, Vec3) {
        let mut registers = DUAL.take();
        let axes = from_fn(|axis| Dual::variable(point[axis], axis));
        let dual = self.run(axes, &mut registers);
        DUAL.set(registers);
        (dual.value, Vec3::from_array(dual.slope))
    }

    fn gradients(&self, points: Points<'_>, values: &mut [f64], gradients: &mut [Vec3]) {
        points.check(values.len());
        points.check(gradients.len());
        let mut registers = Vec::new();
        for start in (0..points.len()).step_by(LANES) {
            let count = LANES.min(points.len() - start);
            let lanes = |x: &[f64]| Lanes(from_fn(|i| x[start + i.min(count - 1)]));
            let axes = [points.x, points.y, points.z].map(lanes);
            let dual = self.run(from_fn(|axis| Dual::variable(axes[axis], axis)), &mut registers);
            for i in 0..count {
                values[start + i] = dual.value.0[i];
                gradients[start + i] = Vec3::from_array(dual.slope.map(|s| s.0[i]));
            }
        }
    }

    fn range(&self, cell: Aabb) -> Option<Range> {
        Some(if cell.is_empty() { Range::of(Interval::EMPTY) } else { self.run_ranges(cell, |x, _| x) })
    }

    fn slopes(&self, cell: Aabb) -> Option<Slopes> {
        Some(slopes_of(self.run_ranges(cell, Dual::variable)))
    }

    fn curvature(&self, cell: Aabb) -> Option<Curvature> {
        let second: Second = self.run_ranges(cell, |x, axis| Dual::variable(Dual::variable(x, axis), axis));
        let first = Dual { value: second.value.value, slope: second.slope.map(|s| s.value) };
        let slopes = slopes_of(first);
        let row = |i: usize| second.slope[i];
        // Where a slope may jump there is a kink.
        let smooth = slopes.range.defined
            && slopes.range.continuous
            && second.slope.iter().all(|s| s.value.continuous && s.value.defined);
        let entry = |i: usize, j: usize| if smooth { bounded(row(i).slope[j]) } else { Interval::ENTIRE };
        let mixed = |i: usize, j: usize| match entry(i, j).intersection(entry(j, i)) {
            none if none.is_empty() => entry(i, j),
            both => both,
        };
        let hessian = [entry(0, 0), entry(1, 1), entry(2, 2), mixed(1, 2), mixed(2, 0), mixed(0, 1)];
        Some(Curvature { slopes, hessian })
    }

    fn lipschitz(&self) -> Option<f64> {
        self.lipschitz
    }

    fn within(&self, cell: Aabb) -> Option<Arc<dyn Field>> {
        self.pruned(cell).map(|tape| Arc::new(tape) as Arc<dyn Field>)
    }

    fn bounds(&self) -> Option<Aabb> {
        self.bounds
    }

    fn cost(&self) -> usize {
        self.steps.len()
    }
}

impl Tape {
    /// A tape that gives the same bits for every point of the cell and has fewer steps; `None` where none can be left
    /// out. What has been proven of the slope still holds.
    pub fn pruned(&self, cell: Aabb) -> Option<Tape> {
        prune::within(self, cell).map(|tape| tape.with_knowledge(self.lipschitz, self.bounds))
    }
}

/// Slopes are known only where the values are defined and do not jump.
fn slopes_of(dual: Dual<Range>) -> Slopes {
    let known = dual.value.defined && dual.value.continuous;
    let gradient = dual.slope.map(|s| if known { bounded(s) } else { Interval::ENTIRE });
    Slopes { range: dual.value, gradient }
}

/// The interval of a slope; a slope that has no value may be anything.
fn bounded(slope: Range) -> Interval {
    if slope.interval.is_empty() { Interval::ENTIRE } else { slope.interval }
}
