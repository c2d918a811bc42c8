use super::build::print;
use super::input::{Kind, Source, warn_of_styles};
use super::model::{self, Times};
use super::settings::{ScriptArgs, format};
use super::stop::Stop;
use super::summary::{Form, PathMeasures, Summary};
use super::terminal::Terminal;
use crate::csg::Shape;
use crate::io::Format;
use crate::io::svg::Shape as DrawnShape;
use crate::mesh::{Defects, Measures, Mesh};
use clap::ValueHint;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  ogee info bracket.stl
  ogee info --json bracket.obj
  ogee info bracket.scad
  ogee info --json drawing.svg
  ogee info --json teapot.bpt
  ogee info - --format stl < bracket.stl";

/// Print the measures of a mesh and what is wrong with it, or those of patches or of the paths of a drawing
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// A mesh, a file of patches, an SVG drawing, or a script, which is built first; `-` is standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    input: PathBuf,
    /// Read this format, whatever the ending
    #[arg(long, value_parser = format())]
    format: Option<Format>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    script: ScriptArgs,
}

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<(), Stop> {
    let source = Source::typed(&args.input);
    let kind = args.format.map_or_else(|| source.kind(), |format| Ok(Kind::Mesh(format)))?;
    let mut summary = Summary::default();
    summary.row("input", source.to_string());
    match kind {
        Kind::Mesh(format) => describe(&source.mesh(format)?, &mut summary),
        Kind::Drawing => return drawing(&source, summary, args.json, terminal),
        Kind::Table | Kind::Points => {
            return Err(Stop::about(source, "these are data; `ogee plot` draws them"));
        }
        Kind::Formula => {
            return Err(Stop::about(source, "this is a formula; see `ogee build` and `ogee eval`"));
        }
        Kind::Patches => super::patches::describe(&source, &super::patches::read(&source)?, &mut summary)?,
        Kind::Script => {
            match model::build(&source, &args.script, false, &mut Times::default(), terminal)?.shape {
                Shape::Solid(solid) => describe(solid.mesh(), &mut summary),
                Shape::Region(region) => drop(summary.region(&region)),
            }
        }
    }
    print(&summary.print(if args.json { Form::Json } else { Form::Text }))
}

/// The measures of the shapes of an SVG file, one entry each, in its user units.
fn drawing(source: &Source, mut summary: Summary, json: bool, terminal: &Terminal) -> Result<(), Stop> {
    let drawing = source.drawing()?;
    for (name, count) in &drawing.ignored {
        terminal.warn(format!("{source}: {count} {name} elements are not paths and have no measures here"));
    }
    warn_of_styles(source, &drawing, terminal);
    let measured = |shape: &DrawnShape| {
        let error =
            |error| Stop::about(source, format_args!("line {}, {}: {error}", shape.line, shape.element));
        PathMeasures::of(&shape.path).map_err(error)
    };
    let paths: Vec<PathMeasures> = drawing.shapes.iter().map(measured).collect::<Result<_, _>>()?;
    if json {
        summary.row("paths", paths.iter().map(PathMeasures::row).collect::<Vec<_>>());
        return print(&summary.print(Form::Json));
    }
    let [width, height] = drawing.size;
    let unit = drawing.millimetres();
    summary.row("paths", paths.len());
    if let (Some(width), Some(height)) = (width, height) {
        summary.row("size in mm", vec![width * 25.4 / 96.0, height * 25.4 / 96.0]);
    }
    summary.row("unit in mm", vec![unit.x, unit.y]);
    let mut text = summary.print(Form::Text);
    for (shape, measures) in drawing.shapes.iter().zip(&paths) {
        let name = shape.id.as_ref().map_or_else(String::new, |id| format!(" #{id}"));
        text += &format!("\nline {} {}{name}\n", shape.line, shape.element);
        for (name, value) in measures.row().as_object().into_iter().flatten() {
            let mut row = Summary::default();
            row.row(name, value.clone());
            text += &row.print(Form::Text);
        }
    }
    print(&text)
}

fn describe(mesh: &Mesh, summary: &mut Summary) {
    summary.measures(&Measures::of(mesh)).defects(&Defects::of(mesh));
}
