use super::formula::FormulaArgs;
use super::input::{Kind, Source};
use super::model::{self, Times};
use super::output::{self, Output};
use super::patches::{self, PatchArgs};
use super::settings::{ScriptArgs, format};
use super::stop::Stop;
use super::summary::{Form, Summary};
use super::terminal::Terminal;
use crate::csg::Shape;
use crate::io::Format;
use crate::mesh::{Measures, Solid};
use clap::ValueHint;
use std::io::Write;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  ogee build bracket.scad -o bracket.obj
  ogee build bracket.scad -o bracket.stl -o bracket.ply -D width=40 -D 'label=\"A\"'
  ogee build bracket.scad --summary json
  ogee build knob.scad --explain --tolerance 0.05 -o knob.stl
  ogee build teapot.bpt --tolerance 1e-3 -o teapot.obj
  ogee build teapot.bpt --close -o teapot.stl
  ogee build gyroid.vm --box -1,-1,-1,1,1,1 --tolerance 0.01 -o gyroid.stl --summary text
  ogee build - -o - --format off < bracket.scad > bracket.off";

/// Make a mesh from a script, a formula or a file of Bézier patches
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// The script, formula (.vm) or file of patches (.bpt); `-` reads a script from standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    input: PathBuf,
    /// Where to write the mesh, in the format of the ending; may be repeated; `-` is standard output
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath, required_unless_present_any = ["summary", "explain"])]
    output: Vec<PathBuf>,
    /// Write this format, whatever the ending
    #[arg(long, value_parser = format())]
    format: Option<Format>,
    /// Print measures and times to standard output
    #[arg(long, value_enum, value_name = "FORM")]
    summary: Option<Form>,
    /// Print to standard output how a script is built: what becomes a mesh, what a field, how finely. Without an output or
    /// a summary nothing is made
    #[arg(long)]
    explain: bool,
    /// Exit with 4 when a mesh that takes part, or the result, is not closed
    #[arg(long)]
    strict: bool,
    /// Largest distance between mesh and surface, in model units. Patches have a thousandth of their size by default;
    /// scripts decide by $fe, $fn, $fa and $fs, and this is the value that $fe starts with
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    tolerance: Option<f64>,
    #[command(flatten)]
    formula: FormulaArgs,
    #[command(flatten)]
    patches: PatchArgs,
    #[command(flatten, next_help_heading = "Scripts")]
    script: ScriptArgs,
}

/// What is meant by the arguments.
struct Job {
    source: Source,
    kind: Kind,
    outputs: Vec<Output>,
    summary: Option<Form>,
    strict: bool,
}

impl Job {
    fn new(args: &Args) -> Result<Job, Stop> {
        let source = Source::typed(&args.input);
        let kind = source.kind();
        let hint = match kind {
            Ok(Kind::Mesh(_)) => Some("this is a mesh, not a script; see `ogee info` and `ogee boolean`"),
            Ok(Kind::Drawing) => Some("this is a drawing, not a script; see `ogee info` and `ogee plot`"),
            Ok(Kind::Table | Kind::Points) => Some("these are data, not a script; see `ogee plot`"),
            Ok(_) | Err(_) => None,
        };
        if let Some(hint) = hint {
            return Err(Stop::about(source, hint));
        }
        let unusable = |tolerance: &f64| !(*tolerance > 0.0 && tolerance.is_finite());
        if matches!(kind, Ok(Kind::Script))
            && let Some(tolerance) = args.tolerance.filter(unusable)
        {
            return Err(Stop::Usage(format!("--tolerance must be positive and finite, it is {tolerance}")));
        }
        if let Some(hint) = kind.as_ref().ok().and_then(|&kind| misplaced(kind, args)) {
            return Err(Stop::Usage(hint.to_owned()));
        }
        let outputs = output::plan_beside(args.summary.is_some() || args.explain, &args.output, args.format)?;
        // A file that is not there is explained where it is read.
        let kind = kind.unwrap_or(Kind::Script);
        Ok(Job { source, kind, outputs, summary: args.summary, strict: args.strict })
    }
}

/// What to say of options that an input of this kind has no use for.
fn misplaced(kind: Kind, args: &Args) -> Option<&'static str> {
    match kind {
        Kind::Formula | Kind::Patches if args.explain => Some("--explain is for scripts"),
        Kind::Script | Kind::Patches if args.formula.is_given() => Some("--box is for formulas (.vm)"),
        Kind::Script | Kind::Formula if args.patches.is_given() => {
            Some("--angle, --measured, --close and --thickness are for files of patches (.bpt)")
        }
        _ => None,
    }
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<(), Stop> {
    let job = Job::new(args)?;
    let mut times = Times::default();
    let mut summary = Summary::default();
    summary.row("input", job.source.to_string());
    match job.kind {
        Kind::Patches => return build_patches(&job, args, times, summary, terminal),
        Kind::Formula => return build_formula(&job, args, times, summary, terminal),
        _ => {}
    }
    let watchdog = args.script.watchdog();
    let recipe = model::recipe(&job.source, &args.script, args.tolerance, &mut times, terminal)?;
    if args.explain {
        print(&model::explanation(&job.source, &recipe)?)?;
        if job.outputs.is_empty() && job.summary.is_none() {
            return Ok(());
        }
    }
    let built = model::build_recipe(&job.source, &recipe, &args.script, job.strict, &mut times, terminal)?;
    drop(watchdog);
    match built.shape {
        Shape::Solid(solid) => write_solid(&job, &solid, &mut times, &mut summary, terminal)?,
        Shape::Region(region) if job.outputs.is_empty() => drop(summary.region(&region)),
        Shape::Region(_) => {
            let reason = "the script makes a plane region, which mesh files cannot hold; linear_extrude makes it a solid";
            return Err(Stop::about(job.source, reason));
        }
    }
    let [warnings, echoes] = terminal.counts();
    summary.row("warnings", warnings).row("echoes", echoes);
    summary.report(&built.report).row("seconds", times.rows());
    match job.summary {
        Some(form) => print(&summary.print(form)),
        None => Ok(()),
    }
}

/// The surface of a formula made a solid.
fn build_formula(
    job: &Job,
    args: &Args,
    mut times: Times,
    mut summary: Summary,
    terminal: &Terminal,
) -> Result<(), Stop> {
    let solid = args.formula.build(
        &job.source,
        args.tolerance,
        args.script.build_options().coarsen,
        &mut times,
        &mut summary,
        terminal,
    )?;
    write_solid(job, &solid, &mut times, &mut summary, terminal)?;
    summary.row("seconds", times.rows());
    job.summary.map_or(Ok(()), |form| print(&summary.print(form)))
}

/// The patches of a file made a mesh, which is open unless it was asked to be closed.
fn build_patches(
    job: &Job,
    args: &Args,
    mut times: Times,
    mut summary: Summary,
    terminal: &Terminal,
) -> Result<(), Stop> {
    let read = times.stage(terminal, "read", "reading", || patches::read(&job.source))?;
    let made = times.stage(terminal, "build", "tessellating", || {
        args.patches.make(&job.source, read, args.tolerance, &args.script.build_options())
    })?;
    let measures = times.stage(terminal, "measure", "measuring", || Measures::of(made.mesh()));
    if job.strict && !measures.closed {
        return Err(Stop::NotClosed(format!("{}: the result is not closed", job.source)));
    }
    times.stage(terminal, "write", "writing", || made.write(&job.outputs))?;
    for name in job.outputs.iter().filter_map(Output::name) {
        terminal.note(format_args!("{name}: {}", in_short(&measures, &times)));
    }
    made.describe(&mut summary);
    summary.row("seconds", times.rows());
    match job.summary {
        Some(form) => print(&summary.print(form)),
        None => Ok(()),
    }
}

fn write_solid(
    job: &Job,
    solid: &Solid,
    times: &mut Times,
    summary: &mut Summary,
    terminal: &Terminal,
) -> Result<(), Stop> {
    let measures = times.stage(terminal, "measure", "measuring", || solid.measures());
    if job.strict && !measures.closed {
        return Err(Stop::NotClosed(format!("{}: the result is not closed", job.source)));
    }
    if solid.is_empty() {
        terminal.warn(format!("{}: the result is empty", job.source));
    }
    times.stage(terminal, "write", "writing", || output::write(&job.outputs, solid.mesh()))?;
    for name in job.outputs.iter().filter_map(Output::name) {
        terminal.note(format_args!("{name}: {}", in_short(&measures, times)));
    }
    summary.measures(&measures);
    Ok(())
}

fn in_short(measures: &Measures, times: &Times) -> String {
    let Measures { triangles, components, .. } = measures;
    let closed = if measures.closed { "closed" } else { "NOT closed" };
    let plural = if *components == 1 { "" } else { "s" };
    format!("{triangles} triangles, {components} component{plural}, {closed}, {:.2} s", times.total())
}

/// Prints a result to standard output.
pub(super) fn print(text: &str) -> Result<(), Stop> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| Stop::of_stdout(error.into()))
}
