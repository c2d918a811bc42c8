//! From the tree of elements to shapes.

use super::scan::Fault;
use super::{Drawing, MOST_ELEMENTS, MOST_PIECES, Shape, data, problem, shapes, styles, values};
use crate::curve::{CurveError, Path};
use crate::io::{Place, Problem, ReadError};
use crate::math::{Affine2, Vec2};
use roxmltree::{Attribute, Document, Node, ParsingOptions};
use std::collections::{BTreeMap, HashMap};

const NAMESPACE: &str = "http://www.w3.org/2000/svg";
/// Levels of `use` within `use`; drawings have one or two, a cycle has no end.
const MOST_USES: usize = 32;
/// The viewport that percentages refer to where nothing says its size: that of a replaced element in CSS.
const DEFAULT_VIEWPORT: Vec2 = Vec2::new(300.0, 150.0);

pub(super) fn read(text: &str) -> Result<Drawing, ReadError> {
    let options = ParsingOptions { allow_dtd: true, nodes_limit: u32::MAX / 4, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| ReadError {
        at: character(error.pos()),
        problem: Problem::Malformed { reason: without_place(&error.to_string()) },
    })?;
    let root = document.root_element();
    if !is_svg(root) || root.tag_name().name() != "svg" {
        let problem = Problem::expected("an svg element", root.tag_name().name().as_bytes());
        return Err(ReadError { at: place(root), problem });
    }
    let mut reader = Reader::new(&document);
    let view = reader.outermost(root)?;
    reader.walk(root, view)?;
    let Reader { mut drawing, ignored, .. } = reader;
    drawing.ignored = ignored.into_iter().map(|(name, count)| (name.to_owned(), count)).collect();
    drawing.disobeyed = disobeyed(&document);
    Ok(drawing)
}

/// Geometry properties that styles set, by name, and how many declarations of each there are.
fn disobeyed(document: &Document<'_>) -> Vec<(String, usize)> {
    let mut counts = BTreeMap::<&str, usize>::new();
    for node in document.descendants().filter(|node| is_svg(*node)) {
        let own = styles::declarations(node.attribute("style").unwrap_or_default());
        let own = own.filter_map(|(name, _)| styles::geometry(name));
        let sheets =
            node.children().filter(|_| node.tag_name().name() == "style").filter_map(|child| child.text());
        for name in own.chain(sheets.flat_map(styles::in_sheet)) {
            *counts.entry(name).or_default() += 1;
        }
    }
    counts.into_iter().map(|(name, count)| (name.to_owned(), count)).collect()
}

/// The parser's messages end with their place, which we give in our own way.
fn without_place(message: &str) -> String {
    message.rsplit_once(" at ").map_or(message, |(reason, _)| reason).to_owned()
}

fn character(position: roxmltree::TextPos) -> Place {
    Place::Character { line: position.row as usize, column: position.col as usize }
}

fn place(node: Node<'_, '_>) -> Place {
    character(node.document().text_pos_at(node.range().start))
}

fn is_svg(node: Node<'_, '_>) -> bool {
    node.is_element() && node.tag_name().namespace().is_none_or(|namespace| namespace == NAMESPACE)
}

/// An element that is still to be drawn, and what is around it.
#[derive(Clone, Copy)]
struct Task<'a, 'input> {
    node: Node<'a, 'input>,
    around: Around,
}

/// What the elements around one say about it.
#[derive(Clone, Copy)]
struct Around {
    map: Affine2,
    /// The size that percentages refer to.
    viewport: Vec2,
    /// Levels of `use`.
    uses: usize,
    /// Width and height that a `use` gives to the `svg` or `symbol` that it names.
    size: [Option<f64>; 2],
    /// Whether it was named by a `use`, which draws symbols.
    named: bool,
}

struct Reader<'a, 'input> {
    document: &'a Document<'input>,
    drawing: Drawing,
    ignored: BTreeMap<&'a str, usize>,
    /// Elements by their `id`, once a `use` asks for one; the first of equal ones counts.
    by_id: Option<HashMap<&'a str, Node<'a, 'input>>>,
    elements: usize,
    pieces: usize,
}

impl<'a, 'input> Reader<'a, 'input> {
    fn new(document: &'a Document<'input>) -> Reader<'a, 'input> {
        let (drawing, ignored) = (Drawing::default(), BTreeMap::new());
        Reader { document, drawing, ignored, by_id: None, elements: 0, pieces: 0 }
    }

    /// Size and view of the outermost element.
    fn outermost(&mut self, root: Node<'a, 'input>) -> Result<Around, ReadError> {
        for (axis, name) in ["width", "height"].into_iter().enumerate() {
            let absolute = |value: &str| !value.contains('%') && value.trim() != "auto";
            if root.attribute(name).is_some_and(absolute) {
                let size = self.length(root, name, f64::NAN)?;
                self.drawing.size[axis] = size.filter(|size| *size > 0.0);
            }
        }
        let size = self.drawing.size;
        let view = self.attribute(root, "viewBox", values::view_box)?;
        self.drawing.view = view.or_else(|| Some([Vec2::ZERO, Vec2::new(size[0]?, size[1]?)]));
        let viewport = self.drawing.view.map_or(DEFAULT_VIEWPORT, |[_, size]| size);
        Ok(Around { map: Affine2::IDENTITY, viewport, uses: 0, size: [None; 2], named: false })
    }

    /// Draws everything below an element. The tasks stand on a stack of our own: files nest as deep as they like.
    fn walk(&mut self, root: Node<'a, 'input>, around: Around) -> Result<(), ReadError> {
        let map = around.map * self.transform(root)?;
        let mut tasks = Vec::new();
        push_children(root, Around { map, ..around }, &mut tasks);
        while let Some(task) = tasks.pop() {
            self.elements += 1;
            if self.elements > MOST_ELEMENTS {
                return Err(too_many(task.node, "elements", MOST_ELEMENTS));
            }
            self.visit(task, &mut tasks)?;
        }
        Ok(())
    }

    fn visit(&mut self, task: Task<'a, 'input>, tasks: &mut Vec<Task<'a, 'input>>) -> Result<(), ReadError> {
        let Task { node, around } = task;
        if is_hidden(node) {
            return Ok(());
        }
        let name = node.tag_name().name();
        match name {
            "g" | "a" | "switch" => {
                let map = around.map * self.transform(node)?;
                push_children(node, Around { map, named: false, ..around }, tasks);
            }
            "svg" => push_children(node, self.nested(node, around)?, tasks),
            "symbol" if around.named => push_children(node, self.nested(node, around)?, tasks),
            "use" => tasks.extend(self.follow(node, around)?),
            "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" => {
                self.draw(node, around)?;
            }
            "text" | "image" | "foreignObject" => *self.ignored.entry(name).or_default() += 1,
            _ => {}
        }
        Ok(())
    }

    fn draw(&mut self, node: Node<'a, 'input>, around: Around) -> Result<(), ReadError> {
        let map = around.map * self.transform(node)?;
        let path = self.path(node, around.viewport)?;
        self.pieces += path.pieces().count();
        if self.pieces > MOST_PIECES {
            return Err(too_many(node, "pieces of paths", MOST_PIECES));
        }
        let path = if map == Affine2::IDENTITY { Ok(path) } else { path.map(&map) };
        self.drawing.shapes.push(Shape {
            element: node.tag_name().name().to_owned(),
            line: self.document.text_pos_at(node.range().start).row as usize,
            id: node.attribute("id").map(str::to_owned),
            path: path.map_err(|error| out_of_range(node, error))?,
        });
        Ok(())
    }

    /// The path of a shape in its own coordinates.
    fn path(&self, node: Node<'a, 'input>, viewport: Vec2) -> Result<Path, ReadError> {
        let path = match node.tag_name().name() {
            "path" => return Ok(self.attribute(node, "d", data::path)?.unwrap_or_default()),
            "rect" => {
                let size = self.sizes(node, ["width", "height"], viewport)?;
                let size = size.map(Option::unwrap_or_default);
                let radii = match self.sizes(node, ["rx", "ry"], viewport)? {
                    [None, None] => Vec2::ZERO,
                    [rx, ry] => Vec2::new(rx.or(ry).unwrap_or_default(), ry.or(rx).unwrap_or_default()),
                };
                shapes::rectangle(self.point(node, ["x", "y"], viewport)?, Vec2::from(size), radii)
            }
            "circle" => {
                // Percentages of neither side refer to the diagonal over the root of 2.
                let mean = (viewport.length_squared() / 2.0).sqrt();
                let [radius, _] = self.sizes(node, ["r", ""], Vec2::splat(mean))?;
                let center = self.point(node, ["cx", "cy"], viewport)?;
                shapes::ellipse(center, Vec2::splat(radius.unwrap_or_default()))
            }
            "ellipse" => {
                let [rx, ry] = self.sizes(node, ["rx", "ry"], viewport)?;
                let radii = Vec2::new(rx.or(ry).unwrap_or_default(), ry.or(rx).unwrap_or_default());
                shapes::ellipse(self.point(node, ["cx", "cy"], viewport)?, radii)
            }
            "line" => {
                let ends =
                    [self.point(node, ["x1", "y1"], viewport)?, self.point(node, ["x2", "y2"], viewport)?];
                shapes::lines(&ends, false)
            }
            kind => {
                let points = self.attribute(node, "points", values::points)?.unwrap_or_default();
                shapes::lines(&points, kind == "polygon")
            }
        };
        path.map_err(|error| out_of_range(node, error))
    }

    /// What is below a `svg` or `symbol`, whose viewport clips nothing here but sets the scale.
    fn nested(&self, node: Node<'a, 'input>, around: Around) -> Result<Around, ReadError> {
        let corner = match node.tag_name().name() {
            "svg" => self.point(node, ["x", "y"], around.viewport)?,
            _ => Vec2::ZERO,
        };
        let [width, height] = self.sizes(node, ["width", "height"], around.viewport)?;
        let whole = around.viewport;
        let [width, height] = [around.size[0].or(width), around.size[1].or(height)];
        let viewport = Vec2::new(width.unwrap_or(whole.x), height.unwrap_or(whole.y));
        let aspect = node.attribute("preserveAspectRatio").unwrap_or_default();
        let map = around.map * self.transform(node)? * Affine2::from_translation(corner);
        let inside = Around { map, viewport, size: [None; 2], named: false, ..around };
        match self.attribute(node, "viewBox", values::view_box)? {
            Some(view @ [_, size]) if size.cmpgt(Vec2::ZERO).all() => {
                Ok(Around { map: map * values::fit(view, viewport, aspect), viewport: size, ..inside })
            }
            _ => Ok(inside),
        }
    }

    /// What a `use` names; nothing where that is not in this file.
    fn follow(
        &mut self,
        node: Node<'a, 'input>,
        around: Around,
    ) -> Result<Option<Task<'a, 'input>>, ReadError> {
        if around.uses == MOST_USES {
            return Err(too_many(node, "levels of use", MOST_USES));
        }
        let href = node.attribute("href").or(node.attribute(("http://www.w3.org/1999/xlink", "href")));
        let Some(id) = href.and_then(|href| href.trim().strip_prefix('#')) else { return Ok(None) };
        let document = self.document;
        let by_id = self.by_id.get_or_insert_with(|| {
            let mut by_id = HashMap::new();
            for node in document.descendants() {
                if let Some(id) = node.attribute("id") {
                    by_id.entry(id).or_insert(node);
                }
            }
            by_id
        });
        let Some(&named) = by_id.get(id) else { return Ok(None) };
        let shift = self.point(node, ["x", "y"], around.viewport)?;
        let map = around.map * self.transform(node)? * Affine2::from_translation(shift);
        let size = self.sizes(node, ["width", "height"], around.viewport)?;
        Ok(Some(Task {
            node: named,
            around: Around { map, uses: around.uses + 1, size, named: true, ..around },
        }))
    }

    fn transform(&self, node: Node<'a, 'input>) -> Result<Affine2, ReadError> {
        Ok(self.attribute(node, "transform", values::transform)?.unwrap_or(Affine2::IDENTITY))
    }

    fn point(&self, node: Node<'a, 'input>, names: [&str; 2], viewport: Vec2) -> Result<Vec2, ReadError> {
        let x = self.length(node, names[0], viewport.x)?.unwrap_or_default();
        Ok(Vec2::new(x, self.length(node, names[1], viewport.y)?.unwrap_or_default()))
    }

    /// Two lengths that may not be negative.
    fn sizes(
        &self,
        node: Node<'a, 'input>,
        names: [&str; 2],
        viewport: Vec2,
    ) -> Result<[Option<f64>; 2], ReadError> {
        let mut sizes = [None; 2];
        for (axis, name) in names.into_iter().enumerate() {
            if node.attribute(name).is_none_or(|value| value.trim() == "auto") {
                continue;
            }
            sizes[axis] = self.length(node, name, viewport[axis])?;
            if sizes[axis].is_some_and(|size| size < 0.0) {
                let negative =
                    |_: &str| Err::<(), Fault>(Fault { at: 0, expected: "a length that is not negative" });
                self.attribute(node, name, negative)?;
            }
        }
        Ok(sizes)
    }

    fn length(&self, node: Node<'a, 'input>, name: &str, whole: f64) -> Result<Option<f64>, ReadError> {
        self.attribute(node, name, |value| values::length(value, whole))
    }

    /// The value of an attribute; its faults get their place in the file.
    fn attribute<T>(
        &self,
        node: Node<'a, 'input>,
        name: &str,
        parse: impl FnOnce(&str) -> Result<T, Fault>,
    ) -> Result<Option<T>, ReadError> {
        let Some(attribute) = node.attribute_node(name) else { return Ok(None) };
        let value = attribute.value();
        parse(value).map(Some).map_err(|fault| ReadError {
            at: character(self.document.text_pos_at(offset(&attribute, value, fault.at))),
            problem: problem(&fault, value),
        })
    }
}

/// The byte of the file that a byte of an attribute's value comes from; the start of the value where references stand
/// in it.
fn offset(attribute: &Attribute<'_, '_>, value: &str, at: usize) -> usize {
    let range = attribute.range_value();
    if range.len() == value.len() { range.start + super::floor(value, at) } else { range.start }
}

/// Children go on the stack last first, so that the first is drawn first.
fn push_children<'a, 'input>(node: Node<'a, 'input>, around: Around, tasks: &mut Vec<Task<'a, 'input>>) {
    let first = tasks.len();
    tasks.extend(node.children().filter(|child| is_svg(*child)).map(|node| Task { node, around }));
    tasks[first..].reverse();
}

fn is_hidden(node: Node<'_, '_>) -> bool {
    // The style goes before the attribute, the last declaration before others.
    let styled = styles::declarations(node.attribute("style").unwrap_or_default());
    let display =
        styled.filter(|(name, _)| name.eq_ignore_ascii_case("display")).last().map(|(_, value)| value);
    display
        .or(node.attribute("display").map(str::trim))
        .is_some_and(|value| value.eq_ignore_ascii_case("none"))
}

fn too_many(node: Node<'_, '_>, what: &'static str, most: usize) -> ReadError {
    ReadError { at: place(node), problem: Problem::TooMany { what, most } }
}

fn out_of_range(node: Node<'_, '_>, _: CurveError) -> ReadError {
    ReadError { at: place(node), problem: Problem::OutOfRange }
}
