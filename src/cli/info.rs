use super::build::print;
use super::input::{Kind, Source};
use super::model::{self, Times};
use super::settings::{ScriptArgs, format};
use super::stop::Stop;
use super::summary::{Form, Summary};
use super::terminal::Terminal;
use crate::csg::Shape;
use crate::io::Format;
use crate::mesh::{Defects, Measures, Mesh};
use clap::ValueHint;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  ogee info bracket.stl
  ogee info --json bracket.obj
  ogee info bracket.scad
  ogee info - --format stl < bracket.stl";

/// Print the measures of a mesh and what is wrong with it
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// A mesh, or a script, which is built first; `-` is standard input
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
        Kind::Script => {
            match model::build(&source, &args.script, false, &mut Times::default(), terminal)?.shape {
                Shape::Solid(solid) => describe(solid.mesh(), &mut summary),
                Shape::Region(region) => drop(summary.region(&region)),
            }
        }
    }
    print(&summary.print(if args.json { Form::Json } else { Form::Text }))
}

fn describe(mesh: &Mesh, summary: &mut Summary) {
    summary.measures(&Measures::of(mesh)).defects(&Defects::of(mesh));
}
