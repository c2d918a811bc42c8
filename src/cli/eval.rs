use super::input::Source;
use super::output::Place;
use super::stop::Stop;
use super::terminal::Terminal;
use crate::io::csv::{read_points, write as write_rows};
use crate::io::vm;
use crate::math::Vec3;
use crate::sdf::{Field, Points, Tape};
use clap::ValueHint;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  ogee eval model.vm --points places.csv
  ogee eval model.vm --points places.csv -o values.csv
  echo 0,0,1 | ogee eval model.vm --points -

A model has one operation a line, as fidget and libfive write it:
  x var-x
  r const 0.5
  out sub x r
The points are rows of three numbers; a header and lines with # are passed over.";

/// Print values and gradients of a formula at points, as CSV
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// The formula; `-` reads it from standard input
    #[arg(value_name = "MODEL.vm", value_hint = ValueHint::FilePath)]
    model: PathBuf,
    /// The points, a row each: x,y,z; `-` reads them from standard input
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    points: PathBuf,
    /// Where to write the rows value,dx,dy,dz, one a point
    #[arg(short, long, value_name = "OUT.csv", value_hint = ValueHint::FilePath, default_value = "-")]
    output: PathBuf,
}

/// Points that are evaluated together: enough for the lanes, few enough to stay in a cache.
const TOGETHER: usize = 4096;

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<(), Stop> {
    let (model, points) = (Source::typed(&args.model), Source::typed(&args.points));
    if model == Source::Stdin && points == Source::Stdin {
        return Err(Stop::Usage("the model and the points cannot both come from standard input".to_owned()));
    }
    let place = Place::typed(&args.output)?;
    let bytes = |source: &Source| source.bytes().map_err(|error| Stop::about(source, error));
    let formula = vm::read(&bytes(&model)?).map_err(|error| Stop::about(&model, error))?;
    let places = read_points(&bytes(&points)?).map_err(|error| Stop::about(&points, error))?;
    let tape = formula.compile();
    let rows = places.chunks(TOGETHER).flat_map(|part| evaluated(&tape, part));
    place.write(|out| write_rows(["value", "dx", "dy", "dz"], rows, out))?;
    if place != Place::Stdout {
        terminal.note(format_args!("{place}: {} points, {} operations", places.len(), tape.len()));
    }
    Ok(())
}

/// Values and gradients at points, in order.
fn evaluated(tape: &Tape, points: &[Vec3]) -> Vec<[f64; 4]> {
    let [x, y, z] = [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).collect::<Vec<f64>>());
    let (mut values, mut gradients) = (vec![0.0; points.len()], vec![Vec3::ZERO; points.len()]);
    tape.gradients(Points::new(&x, &y, &z), &mut values, &mut gradients);
    values.into_iter().zip(gradients).map(|(value, g)| [value, g.x, g.y, g.z]).collect()
}
