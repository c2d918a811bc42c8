//! Registers for the steps of a tape: a linear scan over their lives (Poletto and Sarkar 1999, where all lives begin in
//! order).

use super::expr::Op;
use super::graph::Step;

/// The steps of a tape with registers in place of numbers of steps.
#[derive(Clone)]
pub(super) struct Program {
    /// Constants first, then all others in order.
    pub(super) steps: Vec<Instruction>,
    /// How many of the steps are constants; nothing else is ever written to their registers.
    pub(super) constants: usize,
    /// How many registers there are.
    pub(super) registers: usize,
    /// Where the result is.
    pub(super) result: u32,
}

/// A step and where its numbers are.
#[derive(Clone, Copy)]
pub(super) struct Instruction {
    /// Number of the step in the tape.
    pub(super) source: u32,
    pub(super) out: u32,
    /// Those not used repeat the first.
    pub(super) args: [u32; 3],
}

impl Program {
    pub(super) fn new(steps: &[Step]) -> Program {
        let last_use = last_uses(steps);
        let is_constant = |step: &Step| matches!(step.op, Op::Constant(_));
        let constants = steps.iter().filter(|step| is_constant(step)).count();
        let mut places = vec![0; steps.len()];
        let mut program = Vec::with_capacity(steps.len());
        for (id, _) in steps.iter().enumerate().filter(|(_, step)| is_constant(step)) {
            places[id] = program.len() as u32;
            let out = program.len() as u32;
            program.push(Instruction { source: id as u32, out, args: [out; 3] });
        }
        let (mut free, mut registers) = (Vec::new(), constants as u32);
        for (id, step) in steps.iter().enumerate().filter(|(_, step)| !is_constant(step)) {
            let args = step.args().iter().map(|&arg| places[arg as usize]).collect::<Vec<_>>();
            // What ends its life here gives its register to the result: arguments are read before it is written.
            for (i, &arg) in step.args().iter().enumerate() {
                let repeated = step.args()[..i].contains(&arg);
                if last_use[arg as usize] == id as u32 && !repeated && !is_constant(&steps[arg as usize]) {
                    free.push(places[arg as usize]);
                }
            }
            let out = free.pop().unwrap_or_else(|| {
                registers += 1;
                registers - 1
            });
            places[id] = out;
            let at = |i: usize| args.get(i).or(args.first()).copied().unwrap_or(out);
            program.push(Instruction { source: id as u32, out, args: [at(0), at(1), at(2)] });
        }
        let result = places.last().copied().unwrap_or(0);
        Program { steps: program, constants, registers: registers as usize, result }
    }
}

/// For each step the number of the last one that needs it; the result is needed to the end.
fn last_uses(steps: &[Step]) -> Vec<u32> {
    let mut last = vec![u32::MAX; steps.len()];
    for (id, step) in steps.iter().enumerate() {
        step.args().iter().for_each(|&arg| last[arg as usize] = id as u32);
    }
    last
}
