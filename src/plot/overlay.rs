//! Layers that explain curves.

use super::figure::{Content, Ink, Layer, Mark};
use crate::curve::{
    Bernstein, Bounds, Contact, Cubic, Curve, Path, Piece, Subpath, bounding_box, convex_hull, intersect,
    self_intersections,
};
use crate::math::Vec2;
use crate::par;

/// What to show of curves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Show {
    /// Ends of pieces and control points.
    pub points: bool,
    /// Control polygons.
    pub polygon: bool,
    /// De Casteljau's construction at a parameter of every piece.
    pub construction: Option<f64>,
    /// Unit tangents.
    pub tangents: bool,
    /// Unit normals, to the left.
    pub normals: bool,
    /// Combs as long as the curve is bent.
    pub curvature: bool,
    /// Convex hulls of control points.
    pub hull: bool,
    /// The box of every path.
    pub bounds: bool,
    /// Where cubics change the side that they bend to.
    pub inflections: bool,
    /// Where pieces meet others and themselves.
    pub intersections: bool,
    /// Where pieces join, told apart by corner, common tangent and common curvature.
    pub joints: bool,
}

/// Layers to draw above curves, and what could not be found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlay {
    /// In the order of drawing.
    pub layers: Vec<Layer>,
    /// Pairs of pieces that run so close to one another that where they meet cannot be told.
    pub unresolved: usize,
}

/// The layers that show this of these paths. Arcs have no control points; for hulls and intersections they are the
/// cubics that follow them to a millionth of the figure's size.
pub fn overlay(paths: &[&Path], show: &Show) -> Overlay {
    let boxes = paths.iter().filter_map(|path| path.bounding_box());
    let Some(bounds) = boxes.reduce(|a, b| Bounds { min: a.min.min(b.min), max: a.max.max(b.max) }) else {
        return Overlay::default();
    };
    let size = (bounds.max - bounds.min).length();
    let subject = Subject { size, subpaths: paths.iter().flat_map(|path| &path.subpaths).collect() };
    let mut overlay = Overlay::default();
    let layers = &mut overlay.layers;
    if show.hull {
        layers.push(subject.hulls());
    }
    if show.bounds {
        layers.push(boxes_of(paths));
    }
    if show.curvature {
        layers.extend(subject.combs());
    }
    if show.polygon {
        layers.push(subject.polygons());
    }
    if let Some(t) = show.construction {
        layers.extend(subject.constructions(t));
    }
    if show.tangents {
        layers.push(subject.needles(|tangent| tangent, Ink::Series(2), "tangents"));
    }
    if show.normals {
        layers.push(subject.needles(Vec2::perp, Ink::Series(3), "normals"));
    }
    if show.points {
        layers.extend(subject.points());
    }
    if show.joints {
        layers.extend(subject.joints());
    }
    if show.inflections {
        layers.push(subject.inflections());
    }
    if show.intersections {
        let (layer, unresolved) = subject.intersections();
        overlay.layers.push(layer);
        overlay.unresolved = unresolved;
    }
    overlay.layers.retain(|layer| layer.bounds().is_some());
    overlay
}

/// What is to be explained.
struct Subject<'a> {
    /// The diagonal of the box around everything.
    size: f64,
    subpaths: Vec<&'a Subpath>,
}

/// Control points of a piece; for an arc its ends.
fn control(piece: &Piece) -> Vec<Vec2> {
    match piece {
        Piece::Line(curve) => curve.points().to_vec(),
        Piece::Quadratic(curve) => curve.points().to_vec(),
        Piece::Cubic(curve) => curve.points().to_vec(),
        Piece::Arc(arc) => vec![arc.start(), arc.end()],
    }
}

fn boxes_of(paths: &[&Path]) -> Layer {
    let corners = |path: &&Path| {
        let Bounds { min, max } = path.bounding_box()?;
        let points = [min, Vec2::new(max.x, min.y), max, Vec2::new(min.x, max.y)];
        Subpath::polyline(&points, true).ok()
    };
    let path = Path { subpaths: paths.iter().filter_map(corners).collect() };
    dashed(Layer::curve(path, Ink::Muted).weighing(0.6).named("box"))
}

fn dashed(layer: Layer) -> Layer {
    Layer { dashed: true, ..layer }
}

/// Needles on a curve, evenly by parameter.
const NEEDLES: usize = 5;
/// Teeth of a comb, and of all combs together: more are one blot, and each is a line to draw.
const TEETH: usize = 40;
const MOST_TEETH: usize = 20_000;
/// Length of needles, and of the longest tooth, as a share of the figure.
const NEEDLE: f64 = 0.07;
const TOOTH: f64 = 0.1;

impl Subject<'_> {
    fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.subpaths.iter().flat_map(|subpath| subpath.pieces())
    }

    /// Cubics that are the piece, or follow it if it is an arc.
    fn cubics(&self, piece: &Piece) -> Vec<Cubic<Vec2>> {
        piece.cubics((1e-6 * self.size).max(f64::MIN_POSITIVE)).unwrap_or_default()
    }

    fn hulls(&self) -> Layer {
        let hull = |points: Vec<Vec2>| Subpath::polyline(&convex_hull(&points), true).ok();
        let points = |piece: &Piece| match piece {
            Piece::Arc(_) => self.cubics(piece).iter().flat_map(|cubic| cubic.to_array()).collect(),
            piece => control(piece),
        };
        let path = Path { subpaths: self.pieces().map(points).filter_map(hull).collect() };
        Layer::new(Content::Area(path), Ink::Muted).named("hull")
    }

    fn polygons(&self) -> Layer {
        let curved = self.pieces().map(control).filter(|points| points.len() > 2);
        let segments = curved.flat_map(|points| points.windows(2).map(|p| [p[0], p[1]]).collect::<Vec<_>>());
        Layer::new(Content::Segments(segments.collect()), Ink::Muted).weighing(0.6).named("control polygon")
    }

    fn points(&self) -> [Layer; 2] {
        let inner = |piece: &Piece| {
            let points = control(piece);
            points[1..points.len() - 1].to_vec()
        };
        let controls: Vec<Vec2> = self.pieces().flat_map(inner).collect();
        let ends = self.subpaths.iter().flat_map(|subpath| {
            let last = (!subpath.is_closed()).then(|| subpath.end());
            subpath.pieces().iter().map(Piece::start).chain(last)
        });
        [
            Layer::new(Content::Marks(Mark::Ring, controls), Ink::Muted)
                .weighing(0.9)
                .named("control points"),
            Layer::new(Content::Marks(Mark::Disc, ends.collect()), Ink::Text).weighing(0.9).named("ends"),
        ]
    }

    fn constructions(&self, t: f64) -> Vec<Layer> {
        let (mut segments, mut inner, mut reached) = (Vec::new(), Vec::new(), Vec::new());
        for piece in self.pieces() {
            let rows = match piece {
                Piece::Line(curve) => curve.construction(t),
                Piece::Quadratic(curve) => curve.construction(t),
                Piece::Cubic(curve) => curve.construction(t),
                Piece::Arc(_) => continue,
            };
            for row in &rows[1..] {
                segments.extend(row.windows(2).map(|pair| [pair[0], pair[1]]));
                let points = if row.len() == 1 { &mut reached } else { &mut inner };
                points.extend(row);
            }
        }
        let name = format!("de Casteljau at {t}");
        vec![
            Layer::new(Content::Segments(segments), Ink::Series(4)).weighing(0.6).named(name),
            Layer::new(Content::Marks(Mark::Disc, inner), Ink::Series(4)).weighing(0.6),
            Layer::new(Content::Marks(Mark::Disc, reached), Ink::Accent).weighing(1.1),
        ]
    }

    fn needles(&self, turn: impl Fn(Vec2) -> Vec2, ink: Ink, name: &str) -> Layer {
        let mut segments = Vec::new();
        for piece in self.pieces() {
            for k in 0..NEEDLES {
                let jet = piece.jet(k as f64 / (NEEDLES - 1) as f64);
                if let Some(tangent) = jet.first.try_normalize() {
                    segments.push([jet.point, jet.point + NEEDLE * self.size * turn(tangent)]);
                }
            }
        }
        Layer::new(Content::Segments(segments), ink).weighing(0.7).named(name)
    }

    /// Teeth on the outer side, the longest of all curves as long as is beautiful, and a line along their tips. Of very
    /// many pieces they have few teeth each, and then only some have any.
    fn combs(&self) -> [Layer; 2] {
        let bent: Vec<&Piece> = self.pieces().filter(|piece| !matches!(piece, Piece::Line(_))).collect();
        let count = (MOST_TEETH / bent.len().max(1)).clamp(2, TEETH);
        let stride = (bent.len() * count).div_ceil(MOST_TEETH).max(1);
        let at = |piece: &Piece, k: usize| {
            let jet = piece.jet(k as f64 / count as f64);
            let curvature = jet.curvature();
            curvature.is_finite().then(|| (jet.point, jet.first.normalize_or_zero().perp(), curvature))
        };
        let comb = |piece: &&Piece| (0..=count).filter_map(|k| at(piece, k)).collect::<Vec<_>>();
        let teeth = || bent.iter().step_by(stride).map(comb);
        let curvatures = teeth().flatten().map(|(_, _, curvature)| curvature.abs());
        // Near a cusp curvature has no bound: the comb shows what all but the sharpest twentieth have.
        let mut sorted: Vec<f64> = curvatures.collect();
        sorted.sort_by(f64::total_cmp);
        let most = sorted.get(sorted.len() * 19 / 20).copied().unwrap_or_default();
        let scale = if most > 0.0 { TOOTH * self.size / most } else { 0.0 };
        let reach = 1.5 * TOOTH * self.size;
        let tip = |(point, normal, curvature): (Vec2, Vec2, f64)| {
            point - normal * (curvature * scale).clamp(-reach, reach)
        };
        let mut segments = Vec::new();
        let mut tips = Vec::new();
        for comb in teeth() {
            segments.extend(comb.iter().map(|&tooth| [tooth.0, tip(tooth)]));
            let line: Vec<Vec2> = comb.into_iter().map(tip).collect();
            tips.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
        }
        [
            Layer::new(Content::Segments(segments), Ink::Series(5)).weighing(0.35),
            Layer::new(Content::Segments(tips), Ink::Series(5)).weighing(0.8).named("curvature"),
        ]
    }

    fn inflections(&self) -> Layer {
        let points = self.pieces().flat_map(|piece| match piece {
            Piece::Cubic(cubic) => cubic.inflections().iter().map(|&t| cubic.eval(t)).collect(),
            _ => Vec::new(),
        });
        Layer::new(Content::Marks(Mark::Diamond, points.collect()), Ink::Series(1)).named("inflections")
    }

    /// Joints by what the pieces have in common there.
    fn joints(&self) -> [Layer; 3] {
        let mut kinds: [Vec<Vec2>; 3] = Default::default();
        for subpath in &self.subpaths {
            let pieces = subpath.pieces();
            let around = subpath.is_closed().then(|| (&pieces[pieces.len() - 1], &pieces[0]));
            for (before, after) in pieces.windows(2).map(|pair| (&pair[0], &pair[1])).chain(around) {
                kinds[smoothness(before, after)].push(after.start());
            }
        }
        let [corners, tangent, curved] = kinds;
        let layer = |mark, points, ink, name| Layer::new(Content::Marks(mark, points), ink).named(name);
        [
            layer(Mark::Square, corners, Ink::Accent, "corners"),
            layer(Mark::Ring, tangent, Ink::Series(1), "joints, common tangent"),
            layer(Mark::Disc, curved, Ink::Series(2), "joints, common curvature"),
        ]
    }

    /// Meetings of pieces, but for the joints of neighbours; and how many pairs could not be decided.
    fn intersections(&self) -> (Layer, usize) {
        let mut parts = Vec::new();
        for (path, subpath) in self.subpaths.iter().enumerate() {
            let cubics = subpath.pieces().iter().flat_map(|piece| {
                let straight = matches!(piece, Piece::Line(_));
                self.cubics(piece).into_iter().map(move |cubic| (cubic, straight))
            });
            let cubics: Vec<(Cubic<Vec2>, bool)> = cubics.collect();
            let (count, closed) = (cubics.len(), subpath.is_closed());
            parts.extend(cubics.into_iter().enumerate().map(|(index, (cubic, straight))| {
                (Part { straight, path, index, count, closed }, cubic, bounding_box(&cubic))
            }));
        }
        parts.sort_by(|a, b| a.2.min.x.total_cmp(&b.2.min.x));
        let places: Vec<usize> = (0..parts.len()).collect();
        let found = par::map_above(PARALLEL_FROM, &places, |&k| meetings(&parts[k], &parts[k + 1..]));
        let unresolved = found.iter().map(|(_, unresolved)| unresolved).sum();
        let points = found.into_iter().flat_map(|(points, _)| points).collect();
        (Layer::new(Content::Marks(Mark::Cross, points), Ink::Accent).named("intersections"), unresolved)
    }
}

/// From so many pieces on their meetings are found on all threads: each is some microseconds of work.
const PARALLEL_FROM: usize = 64;

type Placed = (Part, Cubic<Vec2>, Bounds<Vec2>);

/// Where a piece meets itself and those after it, which are in order of their smallest x; and how many of those could
/// not be decided.
fn meetings((part, curve, bounds): &Placed, others: &[Placed]) -> (Vec<Vec2>, usize) {
    let own = if part.straight { Vec::new() } else { self_intersections(curve).unwrap_or_default() };
    let (mut points, mut unresolved) = (own.iter().map(|meeting| meeting.point).collect::<Vec<_>>(), 0);
    let near = others.iter().take_while(|(_, _, around)| around.min.x <= bounds.max.x);
    for (other, second, around) in near {
        let beside = around.min.y > bounds.max.y || around.max.y < bounds.min.y;
        if beside || part.meets_plainly((curve, bounds), other, (second, around)) {
            continue;
        }
        match intersect(curve, second, None) {
            Ok(meetings) => points.extend(meetings.iter().flat_map(|meeting| {
                let overlap = meeting.contact == Contact::Overlap;
                let ends = [(meeting.first[0], meeting.second[0]), (meeting.first[1], meeting.second[1])];
                let ends = if overlap { &ends[..] } else { &ends[..1] };
                let kept = ends.iter().filter(|(s, t)| overlap || !part.joins(other, *s, *t));
                kept.map(|(s, _)| curve.eval(*s)).collect::<Vec<_>>()
            })),
            Err(_) => unresolved += 1,
        }
    }
    (points, unresolved)
}

/// A piece and where it stands in its subpath.
struct Part {
    /// Whether it is a line.
    straight: bool,
    path: usize,
    index: usize,
    count: usize,
    closed: bool,
}

impl Part {
    /// Whether the other piece is the next one.
    fn precedes(&self, other: &Part) -> bool {
        let next = self.index + 1 == other.index;
        let around = self.closed && other.index == 0 && self.index + 1 == self.count;
        self.path == other.path && (next || around)
    }

    /// Whether these parameters are the joint of this piece with a neighbour.
    fn joins(&self, other: &Part, s: f64, t: f64) -> bool {
        // Parameters at a tangent joint are good to half of the digits.
        let follows = |end: f64, start: f64| end > 1.0 - 1e-6 && start < 1e-6;
        (self.precedes(other) && follows(s, t)) || (other.precedes(self) && follows(t, s))
    }

    /// Whether two pieces are neighbours that meet nowhere but at their joint, as their boxes show: they have but that
    /// point in common. So it is for most joints of smooth paths and of polygons.
    fn meets_plainly(
        &self,
        (curve, bounds): (&Cubic<Vec2>, &Bounds<Vec2>),
        other: &Part,
        (second, around): (&Cubic<Vec2>, &Bounds<Vec2>),
    ) -> bool {
        let joint = match (self.precedes(other), other.precedes(self)) {
            (true, false) => curve.end(),
            (false, true) => second.end(),
            _ => return false,
        };
        let (low, high) = (bounds.min.max(around.min), bounds.max.min(around.max));
        low == joint && high == joint
    }
}

/// 0 for a corner, 1 for a common tangent, 2 for a common curvature too; to a part in 10^6.
fn smoothness(before: &Piece, after: &Piece) -> usize {
    let (end, start) = (before.jet(1.0), after.jet(0.0));
    let tangents = end.first.try_normalize().zip(start.first.try_normalize());
    let smooth = tangents.is_some_and(|(a, b)| a.perp_dot(b).abs() < 1e-6 && a.dot(b) > 0.0);
    let (a, b) = (end.curvature(), start.curvature());
    match smooth {
        false => 0,
        true if (a - b).abs() <= 1e-6 * a.abs().max(b.abs()) => 2,
        true => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crosses(subpaths: Vec<Subpath>) -> Vec<Vec2> {
        let show = Show { intersections: true, ..Show::default() };
        let found = overlay(&[&Path { subpaths }], &show);
        assert_eq!(found.unresolved, 0);
        found.layers.into_iter().fold(Vec::new(), |points, layer| match layer.content {
            Content::Marks(_, marks) => [points, marks].concat(),
            _ => points,
        })
    }

    fn polyline(points: &[(f64, f64)], closed: bool) -> Subpath {
        Subpath::polyline(&points.iter().copied().map(Vec2::from).collect::<Vec<_>>(), closed)
            .expect("a polyline")
    }

    #[test]
    fn joints_of_neighbours_are_no_intersections() {
        let circle = crate::curve::Arc::ellipse(Vec2::ZERO, Vec2::ONE).expect("a circle");
        let loops = vec![
            Subpath::closed(vec![circle.into()]).expect("a loop"),
            polyline(&[(5.0, 0.0), (7.0, 0.0), (7.0, 2.0), (4.0, 3.0)], true),
            // Pieces that lean back over their joint, and a loop of two pieces.
            polyline(&[(10.0, 0.0), (12.0, 0.0), (11.0, 1.0), (13.0, 1.5)], false),
            polyline(&[(20.0, 0.0), (22.0, 1.0), (21.0, 3.0)], true),
        ];
        assert!(crosses(loops).is_empty());
        // Neighbours that overlap or cross apart from their joint are told.
        assert!(!crosses(vec![polyline(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.0)], false)]).is_empty());
        assert_eq!(crosses(vec![polyline(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)], true)]).len(), 1);
    }

    #[test]
    fn all_crossings_are_found_in_order_on_any_number_of_threads() {
        let line = |k: usize, across: bool| {
            let (at, end) = (k as f64 + 0.5, 10.0);
            let ends = if across { [(0.0, at), (end, at)] } else { [(at, 0.0), (at, end)] };
            polyline(&ends, false)
        };
        let few: Vec<Subpath> = (0..10).flat_map(|k| [line(k, true), line(k, false)]).collect();
        // More pieces, far away, that meet nothing: so many that threads share the work.
        let strangers =
            (0..PARALLEL_FROM).map(|k| polyline(&[(100.0 + k as f64, 0.0), (100.5 + k as f64, 0.0)], false));
        let many: Vec<Subpath> = few.iter().cloned().chain(strangers).collect();
        let alone = crosses(few);
        assert_eq!(alone.len(), 100);
        assert_eq!(crosses(many), alone);
    }
}
