//! From files to layers.

use super::{Args, Style};
use crate::cli::input::{Kind, Source, warn_of_styles};
use crate::cli::model::{self, Times};
use crate::cli::stop::Stop;
use crate::cli::terminal::Terminal;
use crate::csg::Shape;
use crate::curve::{Path, Subpath};
use crate::io::csv::{Row, Table, read as read_table};
use crate::io::json;
use crate::io::svg::Shape as DrawnShape;
use crate::math::Vec2;
use crate::plot::{Content, Ink, Layer, Mark};

/// What a file holds, ready to be seen.
#[derive(Default)]
pub(super) struct Drawn {
    pub(super) layers: Vec<Layer>,
    /// The curves that may be explained.
    pub(super) paths: Vec<Path>,
    /// Whether it is a chart and not a shape.
    pub(super) chart: bool,
    /// Whether y points down.
    pub(super) y_down: bool,
    /// What the axes measure.
    pub(super) labels: [String; 2],
}

/// Points of one curve.
struct Series {
    name: Option<String>,
    points: Vec<Vec2>,
}

/// Series with more points than this are drawn as lines unless told otherwise.
const MARKED: usize = 60;
/// Paths up to this many get colours of their own.
const COLORED: usize = 6;

impl Drawn {
    pub(super) fn load(
        args: &Args,
        kind: Kind,
        source: &Source,
        times: &mut Times,
        terminal: &Terminal,
    ) -> Result<Drawn, Stop> {
        let drawn = match kind {
            Kind::Script => script(args, source, times, terminal)?,
            Kind::Drawing => times.stage(terminal, "read", "reading", || drawing(source, terminal))?,
            Kind::Table => times.stage(terminal, "read", "reading", || table(args, source))?,
            Kind::Points => times.stage(terminal, "read", "reading", || points(args, source))?,
            Kind::Formula => {
                return Err(Stop::about(source, "this is a formula; `ogee build` makes a mesh of it"));
            }
            Kind::Mesh(_) => return Err(Stop::about(source, "this is a mesh; `ogee render` draws it")),
            Kind::Patches => return Err(Stop::about(source, "these are patches; `ogee render` draws them")),
        };
        if drawn.layers.is_empty() {
            return Err(Stop::about(source, "there is nothing to draw in it"));
        }
        Ok(drawn)
    }
}

fn script(args: &Args, source: &Source, times: &mut Times, terminal: &Terminal) -> Result<Drawn, Stop> {
    let region = match model::build(source, &args.script, false, times, terminal)?.shape {
        Shape::Region(region) => region,
        Shape::Solid(_) => {
            return Err(Stop::about(source, "the script makes a solid; `ogee render` draws it"));
        }
    };
    let contours = region.contours().iter().filter_map(|contour| Subpath::polyline(contour, true).ok());
    let path = Path { subpaths: contours.collect() };
    if path.subpaths.is_empty() {
        return Ok(Drawn::default());
    }
    let layers = vec![
        Layer::new(Content::Area(path.clone()), Ink::Series(0)),
        Layer::curve(path.clone(), Ink::Series(0)),
    ];
    Ok(Drawn { layers, paths: vec![path], ..Drawn::default() })
}

fn drawing(source: &Source, terminal: &Terminal) -> Result<Drawn, Stop> {
    let drawing = source.drawing()?;
    for (name, count) in &drawing.ignored {
        terminal.warn(format!("{source}: {count} {name} elements are not paths and are not drawn"));
    }
    warn_of_styles(source, &drawing, terminal);
    let shapes: Vec<_> = drawing.shapes.into_iter().filter(|shape| !shape.path.subpaths.is_empty()).collect();
    let few = shapes.len() <= COLORED;
    let layer = |(index, shape): (usize, &DrawnShape)| {
        let layer = Layer::curve(shape.path.clone(), Ink::Series(if few { index } else { 0 }));
        Layer { name: shape.id.clone().filter(|_| few), ..layer }
    };
    let layers = shapes.iter().enumerate().map(layer).collect();
    let paths = shapes.iter().map(|shape| shape.path.clone()).collect();
    Ok(Drawn { layers, paths, y_down: true, ..Drawn::default() })
}

fn points(args: &Args, source: &Source) -> Result<Drawn, Stop> {
    let bytes = source.bytes().map_err(|error| Stop::about(source, error))?;
    let lists = json::read_points(&bytes).map_err(|error| Stop::about(source, error))?;
    let series = lists.into_iter().map(|list| Series { name: list.name, points: list.points });
    Ok(series_drawn(args, series.collect(), Drawn::default()))
}

fn table(args: &Args, source: &Source) -> Result<Drawn, Stop> {
    let bytes = source.bytes().map_err(|error| Stop::about(source, error))?;
    let table = read_table(&bytes).map_err(|error| Stop::about(source, error))?;
    let columns = Columns::chosen(args, &table).map_err(|error| Stop::about(source, error))?;
    let series = columns.series(&table).map_err(|error| Stop::about(source, error))?;
    let chart = table.has_header || columns.y.len() > 1 || columns.by.is_some();
    let mut labels = <[String; 2]>::default();
    if let ([y], true) = (&columns.y[..], table.has_header) {
        labels = [table.columns[columns.x].clone(), table.columns[*y].clone()];
    } else if table.has_header {
        labels[0] = table.columns[columns.x].clone();
    }
    Ok(series_drawn(args, series, Drawn { chart, labels, ..Drawn::default() }))
}

/// Which columns are drawn.
struct Columns {
    x: usize,
    y: Vec<usize>,
    by: Option<usize>,
}

impl Columns {
    fn chosen(args: &Args, table: &Table) -> Result<Columns, String> {
        let find = |name: &String| {
            let by_name = || table.columns.iter().position(|column| column == name);
            let by_number =
                || name.parse().ok().filter(|k| (1..=table.columns.len()).contains(k)).map(|k| k - 1);
            let unknown = || format!("there is no column `{name}`; there are {}", table.columns.join(", "));
            by_name().or_else(by_number).ok_or_else(unknown)
        };
        let by = args.data.by.as_ref().map(find).transpose()?;
        let x = match &args.data.x {
            Some(name) => find(name)?,
            None => usize::from(by == Some(0)),
        };
        let y = match &args.data.y[..] {
            [] => (0..table.columns.len()).filter(|&k| k != x && Some(k) != by).collect(),
            names => names.iter().map(find).collect::<Result<Vec<_>, _>>()?,
        };
        if table.rows.is_empty() || y.is_empty() {
            return Err("it takes a table of at least two columns and a row of numbers".to_owned());
        }
        Ok(Columns { x, y, by })
    }

    /// The curves in the order in which they come up; empty cells are left out.
    fn series(&self, table: &Table) -> Result<Vec<Series>, crate::io::ReadError> {
        let mut series: Vec<Series> = Vec::new();
        for row in &table.rows {
            let Some(x) = row.number(self.x)? else { continue };
            for &column in &self.y {
                let Some(y) = row.number(column)? else { continue };
                let name = self.name(table, row, column);
                let index = series.iter().position(|known| known.name == name).unwrap_or(series.len());
                if index == series.len() {
                    series.push(Series { name, points: Vec::new() });
                }
                series[index].points.push(Vec2::new(x, y));
            }
        }
        Ok(series)
    }

    fn name(&self, table: &Table, row: &Row, column: usize) -> Option<String> {
        let header = || table.columns[column].clone();
        match self.by {
            Some(by) if self.y.len() > 1 => Some(format!("{}, {}", row.cells[by], header())),
            Some(by) => Some(row.cells[by].clone()),
            None => (self.y.len() > 1).then(header),
        }
    }
}

/// The layers of series: lines, marks or both.
fn series_drawn(args: &Args, series: Vec<Series>, mut drawn: Drawn) -> Drawn {
    for (index, Series { name, points }) in series.into_iter().filter(|s| !s.points.is_empty()).enumerate() {
        let ink = Ink::Series(index);
        let style =
            args.data.style.unwrap_or(if points.len() <= MARKED { Style::Both } else { Style::Lines });
        // One point is no line.
        let line = Subpath::polyline(&points, args.data.closed).ok().filter(|_| style != Style::Points);
        let mut name = name;
        if let Some(line) = line {
            let path = Path { subpaths: vec![line] };
            // Colours repeat after six; dashes tell the next six apart.
            let layer = Layer { dashed: index / COLORED % 2 == 1, ..Layer::curve(path.clone(), ink) };
            drawn.layers.push(Layer { name: name.take(), ..layer });
            drawn.paths.push(path);
        }
        if style != Style::Lines || points.len() == 1 {
            let weight = if style == Style::Points { 1.0 } else { 0.8 };
            let marks = Layer::new(Content::Marks(Mark::Disc, points), ink).weighing(weight);
            drawn.layers.push(Layer { name, ..marks });
        }
    }
    drawn
}
