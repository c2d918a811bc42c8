//! Values of a union of 500 balls on a fine grid, in all blocks of it that ranges do not prove free of the surface, as a
//! meshing asks for them: ours pruned, fidget's compiler pruned, and the whole formula compiled once. All of the grid counts
//! as asked for: what is proven needs no value.

use crate::fidgets;
use crate::models::{self, DOMAIN, Model};
use cpu_time::ProcessTime;
use fidget::eval::Function;
use fidget::jit::{JitFunction, JitShape};
use fidget::render::{RenderHandle, RenderHints};
use fidget::shape::{ShapeBulkEval, ShapeTracingEval};
use fidget::types::Interval;
use ogee::math::{Aabb, Vec3};
use ogee::sdf::{Field, Points, Tape};
use std::hint::black_box;
use std::sync::Arc;

/// Points along a side of the grid.
const GRID: usize = 256;

/// Points along a side of the blocks that are evaluated at once; each side has the one that suits it best.
const BLOCKS: [usize; 3] = [8, 16, 32];

pub(crate) fn rows() {
    const POINTS: f64 = (GRID * GRID * GRID) as f64;
    let model = models::spheres(500);
    println!(
        "side,points along a block,seconds,points computed,million points asked for a second,ours over it"
    );
    let ours = best(|block| by_tape(&model, block));
    // Its mesher simplifies on some levels only: the better of both counts.
    let [always, sparing] = [false, true].map(|sparing| best(|block| by_fidget(&model, block, sparing)));
    let pruned = if sparing.seconds < always.seconds { sparing } else { always };
    let whole = whole(&model);
    for (name, side) in [("ogee pruned", &ours), ("fidget pruned", &pruned), ("fidget whole", &whole)] {
        let Side { block, seconds, computed } = side;
        let rate = POINTS / seconds / 1e6;
        println!("{name},{block},{seconds:.4},{computed},{rate:.2},{:.2}", seconds / ours.seconds);
    }
}

/// What the whole grid cost.
struct Side {
    block: usize,
    seconds: f64,
    computed: usize,
}

/// The fastest, by the size of block that suits it best.
fn best(run: impl Fn(usize) -> usize) -> Side {
    let timed = |block: usize| {
        let start = ProcessTime::now();
        let computed = run(block);
        Side { block, seconds: start.elapsed().as_secs_f64(), computed }
    };
    let rounds = [BLOCKS; 3].into_iter().flatten().map(timed);
    rounds.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).expect("some")
}

/// The distance of neighbouring points.
fn step() -> f64 {
    DOMAIN.size().x / GRID as f64
}

/// Coordinates of a block's points, in the middles of the grid's cells, x fastest.
fn block_points<T: Copy>(low: Vec3, block: usize, number: impl Fn(f64) -> T) -> [Vec<T>; 3] {
    let row = |axis: usize| -> Vec<T> {
        (0..block).map(|i| number(low[axis] + step() * (i as f64 + 0.5))).collect()
    };
    let rows = [row(0), row(1), row(2)];
    let mut points = [(); 3].map(|()| Vec::with_capacity(block * block * block));
    for &z in &rows[2] {
        for &y in &rows[1] {
            points[0].extend_from_slice(&rows[0]);
            points[1].resize(points[0].len(), y);
        }
        points[2].resize(points[0].len(), z);
    }
    points
}

fn eighth(cell: Aabb, index: usize) -> Aabb {
    let middle = cell.center();
    let corner =
        Vec3::from_array([0, 1, 2].map(|k| if index >> k & 1 == 0 { cell.min[k] } else { cell.max[k] }));
    Aabb::of([middle, corner])
}

fn by_tape(model: &Model, block: usize) -> usize {
    fn descend(field: &dyn Field, cell: Aabb, block: usize, values: &mut [f64]) -> usize {
        let range = field.range(cell).expect("a formula");
        if range.is_inside() || range.is_outside() {
            return 0;
        }
        let pruned: Option<Arc<dyn Field>> = field.within(cell);
        let field = pruned.as_deref().unwrap_or(field);
        if cell.size().x <= step() * block as f64 * 1.5 {
            let [x, y, z] = block_points(cell.min, block, |x| x);
            field.values(Points::new(&x, &y, &z), values);
            black_box(values);
            return x.len();
        }
        (0..8).map(|k| descend(field, eighth(cell, k), block, values)).sum()
    }
    let tape: Tape = model.field.expr().compile();
    descend(&tape, DOMAIN, block, &mut vec![0.0; block * block * block])
}

struct Fidget {
    interval: ShapeTracingEval<<JitFunction as Function>::IntervalEval>,
    slice: ShapeBulkEval<<JitFunction as Function>::FloatSliceEval>,
    tapes: Vec<<JitFunction as Function>::TapeStorage>,
    shapes: Vec<<JitFunction as Function>::Storage>,
    workspace: <JitFunction as Function>::Workspace,
    block: usize,
    /// Whether it simplifies where its own mesher does, instead of on every level.
    sparing: bool,
}

fn by_fidget(model: &Model, block: usize, sparing: bool) -> usize {
    let shape = JitShape::from(fidgets::tree(&model.plain));
    let mut fidget = Fidget {
        interval: JitShape::new_interval_eval(),
        slice: JitShape::new_float_slice_eval(),
        tapes: Vec::new(),
        shapes: Vec::new(),
        workspace: Default::default(),
        block,
        sparing,
    };
    fidget.descend(&mut RenderHandle::new(shape), DOMAIN, 0)
}

impl Fidget {
    fn descend(&mut self, handle: &mut RenderHandle<JitFunction>, cell: Aabb, depth: usize) -> usize {
        let [x, y, z] = [0, 1, 2].map(|k| Interval::new(cell.min[k] as f32, cell.max[k] as f32));
        let tape = handle.i_tape(&mut self.tapes);
        let (range, trace) = self.interval.eval(tape, x, y, z).expect("three coordinates");
        if range.upper() < 0.0 || range.lower() > 0.0 {
            return 0;
        }
        let simplify = !self.sparing || JitFunction::simplify_tree_during_meshing(depth);
        let handle = match trace.filter(|_| simplify) {
            Some(trace) => handle.simplify(trace, &mut self.workspace, &mut self.shapes, &mut self.tapes),
            None => handle,
        };
        if cell.size().x <= step() * self.block as f64 * 1.5 {
            let [x, y, z] = block_points(cell.min, self.block, |x| x as f32);
            let tape = handle.f_tape(&mut self.tapes);
            black_box(self.slice.eval(tape, &x, &y, &z).expect("three coordinates"));
            return x.len();
        }
        (0..8).map(|k| self.descend(handle, eighth(cell, k), depth + 1)).sum()
    }
}

/// The whole formula on a grid of half as many points a side, times eight.
fn whole(model: &Model) -> Side {
    let shape = JitShape::from(fidgets::tree(&model.plain));
    let start = ProcessTime::now();
    black_box(fidgets::grid(&shape, GRID / 2));
    let seconds = 8.0 * start.elapsed().as_secs_f64();
    Side { block: GRID, seconds, computed: GRID * GRID * GRID }
}
