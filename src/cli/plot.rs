mod content;
mod show;

use super::input::{Kind, Source};
use super::model::Times;
use super::output::Place;
use super::render::color;
use super::settings::ScriptArgs;
use super::stop::Stop;
use super::terminal::Terminal;
use crate::io as formats;
use crate::plot::{Figure, Scale, Show, Theme, overlay};
use clap::{ValueEnum, ValueHint};
use content::Drawn;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  ogee plot drawing.svg -o drawing.png --show points,polygon,curvature
  ogee plot arch.svg -o arch.svg --show construction=0.3,points --dark
  ogee plot outline.scad -o outline.svg -D width=30
  ogee plot points.csv -o points.png --closed
  ogee plot timings.csv -o chart.svg --x time --y error --by method --log xy";

/// Draw a figure of curves, plane shapes or numbers
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// An SVG drawing, a table (.csv, .tsv), lists of points (.json), or a script of a plane shape; `-` is standard
    /// input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    input: PathBuf,
    /// Where to write the figure, as .svg or .png; `-` is standard output
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    output: PathBuf,
    /// Write this format, whatever the ending
    #[arg(long, value_enum)]
    format: Option<Picture>,
    /// Read the input as this, whatever the ending; standard input is a script unless told otherwise
    #[arg(long, value_enum, value_name = "KIND")]
    read: Option<Input>,
    /// Size of the figure, in pixels
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1200x900")]
    size: [u32; 2],
    /// What to show of curves, separated by commas: points, polygon, construction=T, tangents, normals, curvature, hull,
    /// box, inflections, intersections, joints
    #[arg(long, value_name = "LIST", value_parser = show::parse, default_value = "", hide_default_value = true)]
    show: Show,
    /// Light on dark
    #[arg(long)]
    dark: bool,
    /// Colour behind the figure, as #rrggbb, or none
    #[arg(long, value_name = "COLOR", value_parser = background)]
    background: Option<Background>,
    /// Title of the figure
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    title: String,
    #[command(flatten, next_help_heading = "Axes")]
    axes: Axes,
    #[command(flatten, next_help_heading = "Tables and lists of points")]
    data: Data,
    #[command(flatten)]
    script: ScriptArgs,
}

#[derive(clap::Args)]
struct Axes {
    /// What the x axis measures
    #[arg(long, value_name = "TEXT")]
    x_label: Option<String>,
    /// What the y axis measures
    #[arg(long, value_name = "TEXT")]
    y_label: Option<String>,
    /// Axes with equal steps for equal ratios
    #[arg(long, value_enum, value_name = "AXES")]
    log: Option<Log>,
    /// Whether a unit is as long on both axes: `equal` for shapes, `free` for charts; a table with a header is a chart
    #[arg(long, value_enum, value_name = "KIND")]
    aspect: Option<Aspect>,
}

/// What of a table is drawn, and how.
#[derive(clap::Args)]
struct Data {
    /// Column of x, by name or number from 1; the first by default
    #[arg(long, value_name = "COLUMN")]
    x: Option<String>,
    /// Columns of y, separated by commas; all others by default
    #[arg(long, value_name = "COLUMN,...", value_delimiter = ',')]
    y: Vec<String>,
    /// One curve for each value in this column
    #[arg(long, value_name = "COLUMN")]
    by: Option<String>,
    /// How points are drawn: `both` up to 60 points, else `lines`
    #[arg(long, value_enum, value_name = "KIND")]
    style: Option<Style>,
    /// Join the last point to the first
    #[arg(long)]
    closed: bool,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Picture {
    Svg,
    Png,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Input {
    Svg,
    Csv,
    Json,
    Scad,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Log {
    X,
    Y,
    Xy,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Aspect {
    Equal,
    Free,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Style {
    Lines,
    Points,
    Both,
}

/// What is behind the figure; `None` inside is nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Background(Option<[f32; 3]>);

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<(), Stop> {
    let format = format_of(args)?;
    let place = Place::typed(&args.output)?;
    let source = Source::typed(&args.input);
    let kind = match args.read {
        Some(Input::Svg) => Kind::Drawing,
        Some(Input::Csv) => Kind::Table,
        Some(Input::Json) => Kind::Points,
        Some(Input::Scad) => Kind::Script,
        None => source.kind()?,
    };
    let mut times = Times::default();
    let drawn = Drawn::load(args, kind, &source, &mut times, terminal)?;
    let figure = times.stage(terminal, "plot", "drawing", || figure(args, drawn, &source, terminal));
    let [width, height] = args.size;
    let scene = figure.scene(width, height).map_err(|error| Stop::about(&source, error))?;
    match format {
        Picture::Svg => place.write(|out| scene.svg(out))?,
        Picture::Png => {
            let pixels = times.stage(terminal, "pixels", "drawing", || scene.pixels());
            place.write(|out| Ok(formats::png::write(width, &pixels, out)?))?;
        }
    }
    if place != Place::Stdout {
        terminal.note(format_args!("{place}: {width} x {height} pixels, {:.2} s", times.total()));
    }
    Ok(())
}

/// What is seen, with the layers that explain it.
fn figure(args: &Args, drawn: Drawn, source: &Source, terminal: &Terminal) -> Figure {
    let Drawn { mut layers, paths, chart, y_down, labels } = drawn;
    let explained = overlay(&paths.iter().collect::<Vec<_>>(), &args.show);
    if explained.unresolved > 0 {
        let count = explained.unresolved;
        terminal.warn(format!(
            "{source}: {count} pairs of pieces run too close together to tell where they meet"
        ));
    }
    layers.extend(explained.layers);
    let mut theme = if args.dark { Theme::DARK } else { Theme::LIGHT };
    if let Some(Background(color)) = args.background {
        let byte = |c: f32| (c * 255.0).round() as u8;
        theme.background = color.map_or([0; 4], |[r, g, b]| [byte(r), byte(g), byte(b), 255]);
    }
    let mut figure = Figure { title: args.title.clone(), layers, theme, ..Figure::default() };
    let [x, y] = labels;
    figure.x.label = args.axes.x_label.clone().unwrap_or(x);
    figure.y.label = args.axes.y_label.clone().unwrap_or(y);
    figure.y.reversed = y_down;
    let log = |axis: Log| args.axes.log.is_some_and(|log| log == axis || log == Log::Xy);
    figure.x.scale = if log(Log::X) { Scale::Log } else { Scale::Linear };
    figure.y.scale = if log(Log::Y) { Scale::Log } else { Scale::Linear };
    let free = chart || args.axes.log.is_some();
    figure.equal = args.axes.aspect.map_or(!free, |aspect| aspect == Aspect::Equal);
    figure
}

fn format_of(args: &Args) -> Result<Picture, Stop> {
    let ending = args.output.extension().unwrap_or_default();
    let known = [("svg", Picture::Svg), ("png", Picture::Png)];
    let by_ending =
        known.into_iter().find(|(name, _)| ending.eq_ignore_ascii_case(name)).map(|(_, format)| format);
    args.format.or(by_ending).ok_or_else(|| {
        Stop::Usage(match args.output == Path::new("-") {
            true => "-o - needs --format svg or --format png, since it has no ending".to_owned(),
            false => format!("{}: figures are written as .svg or .png", args.output.display()),
        })
    })
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    let [width, height]: [u32; 2] = sides.ok_or("expected WxH, such as 1600x1200")?;
    Figure::default().scene(width, height).map_err(|error| error.to_string())?;
    Ok([width, height])
}

fn background(text: &str) -> Result<Background, String> {
    if text == "none" { Ok(Background(None)) } else { color(text).map(|color| Background(Some(color))) }
}
