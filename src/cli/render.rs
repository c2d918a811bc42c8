use super::input::{Kind, Source};
use super::model::{self, Times};
use super::output::Place;
use super::settings::{ScriptArgs, format};
use super::stop::Stop;
use super::terminal::Terminal;
use crate::csg::{Color, Shape};
use crate::io::{self as formats, Format};
use crate::math::Vec3;
use crate::mesh::Mesh;
use crate::render::{self, Camera, Edges, Fit, Style};
use clap::{ValueEnum, ValueHint};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  ogee render bracket.scad -o bracket.png
  ogee render bracket.stl -o bracket.png --size 1600x1200 --edges
  ogee render bracket.obj -o top.png --camera 0,0,0,0,0,0,200 --projection orthographic
  ogee render bracket.scad -o bracket.png --background none --material '#c85a3c'";

/// Draw a picture
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Args {
    /// A script, which is built first, or a mesh; `-` reads a script from standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    input: PathBuf,
    /// Where to write the picture, a PNG; `-` is standard output
    #[arg(short, long, value_name = "OUT.png", value_hint = ValueHint::FilePath)]
    output: PathBuf,
    /// Read the input as a mesh of this format, whatever the ending
    #[arg(long, value_parser = format())]
    format: Option<Format>,
    /// Size of the picture, in pixels
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1200x900")]
    size: [u32; 2],
    /// Where to look from: the eye and the target (6 numbers), with what is up (9), or as OpenSCAD's camera the target,
    /// the angles about x, y and z in degrees and the distance (7). Without it the whole model is shown
    #[arg(long, value_name = "X,Y,Z,...", value_parser = camera, allow_hyphen_values = true)]
    camera: Option<Camera>,
    /// How depth becomes size
    #[arg(long, value_enum, default_value_t = Lens::Perspective, value_name = "KIND")]
    projection: Lens,
    /// Edges bent by more than this many degrees are sharp; with 0 all triangles are flat
    #[arg(long, default_value_t = 30.0, value_parser = crease, value_name = "DEGREES")]
    crease: f64,
    /// Draw sharp edges as lines
    #[arg(long)]
    edges: bool,
    /// Colour of what has none of its own, as #rrggbb
    #[arg(long, value_parser = color, value_name = "COLOR")]
    material: Option<[f32; 3]>,
    /// Colour behind the model, as #rrggbb, or none
    #[arg(long, value_parser = background, value_name = "COLOR")]
    background: Option<Background>,
    /// Leave out the shadow on the ground
    #[arg(long)]
    no_shadow: bool,
    #[command(flatten)]
    script: ScriptArgs,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Lens {
    Perspective,
    Orthographic,
}

/// What is behind the model; `None` inside is nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Background(Option<[f32; 3]>);

pub(super) fn run(args: &Args, terminal: &Terminal) -> Result<(), Stop> {
    check_ending(&args.output)?;
    let place = Place::typed(&args.output)?;
    let source = Source::typed(&args.input);
    let mut times = Times::default();
    let (mesh, colors) = load(args, &source, &mut times, terminal)?;
    let camera = args.camera(&mesh);
    let style = args.style(colors);
    let image = times.stage(terminal, "render", "drawing", || render::draw(&mesh, &camera, &style));
    let image = image.map_err(|error| Stop::about(&source, error))?;
    place.write(|out| Ok(formats::png::write(image.width, &image.pixels, out)?))?;
    if place != Place::Stdout {
        let [width, height] = args.size;
        terminal.note(format_args!("{place}: {width} x {height} pixels, {:.2} s", times.total()));
    }
    Ok(())
}

/// What is to be drawn, and the colours of its triangles where it has any.
fn load(
    args: &Args,
    source: &Source,
    times: &mut Times,
    terminal: &Terminal,
) -> Result<(Mesh, Vec<Option<Color>>), Stop> {
    match args.format.map_or_else(|| source.kind(), |format| Ok(Kind::Mesh(format)))? {
        Kind::Mesh(format) => Ok((source.mesh(format)?, Vec::new())),
        Kind::Patches => {
            let read = times.stage(terminal, "read", "reading", || super::patches::read(source))?;
            let mesh = times.stage(terminal, "build", "tessellating", || {
                super::patches::shown(source, &read, &args.script.build_options())
            })?;
            Ok((mesh, Vec::new()))
        }
        Kind::Drawing | Kind::Table | Kind::Points => {
            Err(Stop::about(source, "this is flat; `ogee plot` draws it"))
        }
        Kind::Formula => Err(Stop::about(source, "this is a formula; `ogee build` makes a mesh of it")),
        Kind::Script => {
            let built = model::build(source, &args.script, false, times, terminal)?;
            match built.shape {
                Shape::Solid(solid) => Ok((solid.into_mesh(), built.colors)),
                Shape::Region(_) => {
                    let reason = "the script makes a plane region; `ogee plot` draws it, and linear_extrude makes it a solid";
                    Err(Stop::about(source, reason))
                }
            }
        }
    }
}

impl Args {
    fn style(&self, colors: Vec<Option<Color>>) -> Style {
        let plain = Style::default();
        let [r, g, b] = self.material.unwrap_or([plain.material[0], plain.material[1], plain.material[2]]);
        Style {
            width: self.size[0],
            height: self.size[1],
            crease: self.crease.to_radians(),
            // Lines keep their weight in large pictures.
            edges: self.edges.then(|| Edges {
                width: Edges::default().width.max(f64::from(self.size[1]) / 700.0),
                ..Edges::default()
            }),
            background: self.background.map_or(plain.background, |Background(color)| color),
            material: [r, g, b, 1.0],
            colors,
            shadow: !self.no_shadow,
            ..plain
        }
    }

    fn camera(&self, mesh: &Mesh) -> Camera {
        let orthographic = self.projection == Lens::Orthographic;
        match self.camera {
            Some(camera) if orthographic => camera.to_orthographic(),
            Some(camera) => camera,
            None => {
                let aspect = f64::from(self.size[0]) / f64::from(self.size[1]);
                Camera::fitted(mesh, &Fit { aspect, orthographic, ..Fit::default() })
            }
        }
    }
}

fn check_ending(path: &Path) -> Result<(), Stop> {
    let ending = path.extension().unwrap_or_default();
    if ending.eq_ignore_ascii_case("png") || path.as_os_str() == "-" {
        return Ok(());
    }
    Err(Stop::Usage(format!("{}: pictures are written as .png", path.display())))
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    let [width, height]: [u32; 2] = sides.ok_or("expected WxH, such as 1600x1200")?;
    let too_large = u64::from(width) * u64::from(height) > Style::MOST_PIXELS;
    if width == 0 || height == 0 || width.max(height) > Style::LARGEST || too_large {
        let (largest, most) = (Style::LARGEST, Style::MOST_PIXELS >> 20);
        return Err(format!("sides go from 1 to {largest} pixels, and pictures up to {most} megapixels"));
    }
    Ok([width, height])
}

fn camera(text: &str) -> Result<Camera, String> {
    let number = |part: &str| part.trim().parse().ok().filter(|x: &f64| x.is_finite());
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    let numbers = numbers.ok_or("expected numbers separated by commas")?;
    let point = |at: usize| Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]);
    let looking = |up: Vec3| Camera { eye: point(0), target: point(3), up, ..Camera::default() };
    match numbers.len() {
        6 => Ok(looking(Vec3::Z)),
        7 => Ok(Camera::gimbal(point(0), point(3).map(f64::to_radians), numbers[6])),
        9 => Ok(looking(point(6))),
        count => Err(format!("expected 6, 7 or 9 numbers, found {count}")),
    }
}

fn crease(text: &str) -> Result<f64, String> {
    let degrees = text.parse().ok().filter(|degrees| (0.0..=180.0).contains(degrees));
    degrees.ok_or_else(|| "expected an angle from 0 to 180".to_owned())
}

/// A colour as `#rrggbb`.
pub(super) fn color(text: &str) -> Result<[f32; 3], String> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let code = u32::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6 && !digits.starts_with('+'));
    let code = code.ok_or("expected a colour as #rrggbb")?;
    Ok([16, 8, 0].map(|shift| (code >> shift & 0xff) as f32 / 255.0))
}

fn background(text: &str) -> Result<Background, String> {
    if text == "none" { Ok(Background(None)) } else { color(text).map(|color| Background(Some(color))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("800x600"), Ok([800, 600]));
        for wrong in ["800", "800x", "0x5", "5x-5", "99999x1", "16384x16384", "4294967296x1"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn colors() {
        assert_eq!(color("#ff0080"), Ok([1.0, 0.0, 128.0 / 255.0]));
        assert_eq!(background("none"), Ok(Background(None)));
        for wrong in ["", "#fff", "red", "#+12345", "#gggggg", "#1234567"] {
            assert!(color(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn cameras() {
        let eye_and_target = camera("1,2,3,-4,5e1,6").expect("a camera");
        assert_eq!(
            (eye_and_target.eye, eye_and_target.target),
            (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-4.0, 50.0, 6.0))
        );
        assert_eq!(camera("1,2,3,4,5,6,0,1,0").expect("a camera").up, Vec3::Y);
        // OpenSCAD's view from above: up is y.
        let above = camera("1,2,3,0,0,0,10").expect("a camera");
        assert_eq!((above.eye, above.up), (Vec3::new(1.0, 2.0, 13.0), Vec3::Y));
        for wrong in ["", "1,2,3", "1,2,3,4,5,x", "1,2,3,4,5,inf", "1,2,3,4,5,6,7,8"] {
            assert!(camera(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn endings() {
        assert!(check_ending(Path::new("a.PNG")).is_ok() && check_ending(Path::new("-")).is_ok());
        assert!(check_ending(Path::new("a.jpg")).is_err() && check_ending(Path::new("png")).is_err());
    }
}
