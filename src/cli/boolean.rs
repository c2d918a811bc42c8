use super::build::print;
use super::input::{Kind, Source, endings};
use super::model::Times;
use super::output::{self, Output};
use super::settings::format;
use super::stop::Stop;
use super::summary::{Form, Summary};
use super::terminal::Terminal;
use crate::boolean::{self, BooleanError, Combined, Op, Tree};
use crate::csg::Note;
use crate::io::Format;
use crate::mesh::Mesh;
use clap::{ValueEnum, ValueHint};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  ogee boolean union body.stl handle.obj -o mug.stl
  ogee boolean difference plate.ply hole1.ply hole2.ply -o part.ply
  ogee boolean intersection a.off b.off -o - --format off";

/// Combine closed meshes
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// What to take of the operands
    operation: Operation,
    /// The meshes, in order
    #[arg(value_name = "MESH", required = true, num_args = 1.., value_hint = ValueHint::FilePath)]
    operands: Vec<PathBuf>,
    /// Where to write the mesh, in the format of the ending; may be repeated; `-` is standard output
    #[arg(short, long, value_name = "OUT", required = true, value_hint = ValueHint::FilePath)]
    output: Vec<PathBuf>,
    /// Write this format, whatever the ending
    #[arg(long, value_parser = format())]
    format: Option<Format>,
    /// Print measures and times to standard output
    #[arg(long, value_enum, value_name = "FORM")]
    summary: Option<Form>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Operation {
    /// Where at least one of them is
    Union,
    /// Where the first is and none of the others
    Difference,
    /// Where all of them are
    Intersection,
    /// Where an odd number of them is
    Xor,
}

impl Operation {
    fn op(self) -> Op {
        match self {
            Operation::Union => Op::Union,
            Operation::Difference => Op::Difference,
            Operation::Intersection => Op::Intersection,
            Operation::Xor => Op::SymmetricDifference,
        }
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<(), Stop> {
    let outputs = output::plan_beside(args.summary.is_some(), &args.output, args.format)?;
    let sources: Vec<Source> = args.operands.iter().map(|path| Source::typed(path)).collect();
    let mut times = Times::default();
    let meshes = times
        .stage(terminal, "read", "reading", || sources.iter().map(read).collect::<Result<Vec<_>, _>>())?;
    let operands: Vec<&Mesh> = meshes.iter().collect();
    let tree = Tree::flat(args.operation.op(), operands.len());
    let combined = times.stage(terminal, "build", "combining", || boolean::evaluate(&tree, &operands));
    let Combined { solid, certificate, .. } = combined.map_err(|error| explain(&error, &sources))?;
    if certificate.crossings_left > 0 {
        terminal.warn(Note::CrossingsLeft.to_string());
    }
    times.stage(terminal, "write", "writing", || output::write(&outputs, solid.mesh()))?;
    for name in outputs.iter().filter_map(Output::name) {
        terminal.note(format_args!("{name}: {} triangles, {:.2} s", solid.triangles().len(), times.total()));
    }
    let Some(form) = args.summary else { return Ok(()) };
    let mut summary = Summary::default();
    summary.measures(&solid.measures()).certificate(&certificate).row("seconds", times.rows());
    print(&summary.print(form))
}

fn read(source: &Source) -> Result<Mesh, Stop> {
    match source.kind()? {
        Kind::Mesh(format) => source.mesh(format),
        Kind::Script => Err(Stop::about(source, format!("this is a script, build it first; {}", endings()))),
        Kind::Formula => Err(Stop::about(source, "this is a formula; `ogee build` makes a mesh of it")),
        Kind::Patches => {
            Err(Stop::about(source, "these are patches; `ogee build --close` makes a solid of them"))
        }
        Kind::Drawing | Kind::Table | Kind::Points => Err(Stop::about(source, "this is not a mesh")),
    }
}

/// The error with the name of the operand that it is about.
fn explain(error: &BooleanError, sources: &[Source]) -> Stop {
    match error {
        BooleanError::NotClosed { operand, .. } => Stop::about(&sources[*operand], error),
        BooleanError::NoSuchOperand { .. } => Stop::Error(error.to_string()),
    }
}
