use super::Region;
use super::exact::{
    Boundary, Chart, Jump, Line, Plane, PointId, Points, Segment, Snapped, followers, overlay,
};
use crate::math::Vec2;

/// Which winding numbers count as inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FillRule {
    /// All but zero.
    NonZero,
    /// Odd ones.
    EvenOdd,
    /// Those above zero.
    Positive,
}

impl FillRule {
    /// Whether points with this winding number are inside.
    pub fn holds(self, winding: i32) -> bool {
        match self {
            FillRule::NonZero => winding != 0,
            FillRule::EvenOdd => winding % 2 != 0,
            FillRule::Positive => winding > 0,
        }
    }
}

/// The region where `inside` holds of the winding numbers of all operands, each a set of closed contours.
///
/// `inside` is given the operands that wind around a place, sorted, each with how often; it must not hold where none
/// does. Coordinates must be finite; they are first rounded to multiples of a power of two that is at most `resolution`
/// (0 for the finest lattice), so that edges which were meant to coincide do. From there on all is exact but for the
/// positions of new vertices, which are rounded to doubles; others keep theirs.
pub fn combine(operands: &[&[Vec<Vec2>]], resolution: f64, inside: impl Fn(&[(u32, i32)]) -> bool) -> Region {
    let coordinates = operands.iter().copied().flatten().flatten();
    let largest = coordinates.fold(0.0_f64, |m, p| m.max(p.x.abs()).max(p.y.abs()));
    let mut places = Snapped::new(largest, resolution);
    let chart = Chart::new(&Plane::through([0, 0, 0], [1, 0, 0], [0, 1, 0]).expect("the plane z = 0"));

    let mut lines = Vec::new();
    let mut segments = Vec::new();
    for (operand, contours) in (0..).zip(operands) {
        for contour in *contours {
            let ids: Vec<PointId> = contour.iter().map(|p| places.add(p.extend(0.0))).collect();
            add_contour(&chart, &places.points, &ids, operand, &mut lines, &mut segments);
        }
    }
    let cells = overlay(&chart, &mut places.points, &lines, &segments, &[]);
    let within: Vec<bool> =
        cells.coverage.iter().map(|winding| !winding.is_empty() && inside(winding)).collect();
    let boundary: Vec<Boundary> = cells
        .edges
        .iter()
        .filter(|edge| within[edge.below as usize] != within[edge.above as usize])
        .map(|edge| {
            let [left, right] = edge.ends;
            let ends = if within[edge.above as usize] { [left, right] } else { [right, left] };
            Boundary { ends, line: edge.line }
        })
        .collect();
    let contours = walk(&chart, &places.points, &lines, &boundary);
    let place = |p: PointId| places.position(p).truncate();
    Region::assume(contours.into_iter().map(|contour| contour.into_iter().map(place).collect()).collect())
}

fn add_contour(
    chart: &Chart,
    points: &Points,
    contour: &[PointId],
    operand: u32,
    lines: &mut Vec<Line>,
    segments: &mut Vec<Segment>,
) {
    let jump = Some(Jump { operand, amount: 1, face: 0 });
    for (&from, &to) in contour.iter().zip(contour.iter().cycle().skip(1)) {
        if let Some(line) = chart.line_through(points, from, to) {
            segments.push(Segment { ends: [from, to], line: lines.len() as u32, jump });
            lines.push(line);
        }
    }
}

/// The contours of a boundary, without vertices at which one runs straight on and no other passes.
fn walk(chart: &Chart, points: &Points, lines: &[Line], boundary: &[Boundary]) -> Vec<Vec<PointId>> {
    let next = followers(chart, points, lines, boundary);
    let crowded = passed_twice(boundary);
    let mut walked = vec![false; boundary.len()];
    let mut contours = Vec::new();
    for first in 0..boundary.len() {
        let (mut edge, mut contour) = (first, Vec::new());
        while !walked[edge] {
            walked[edge] = true;
            contour.push(boundary[edge].ends[0]);
            edge = next[edge] as usize;
        }
        let count = contour.len();
        let is_needed = |&i: &usize| {
            let (before, after) = (contour[(i + count - 1) % count], contour[(i + 1) % count]);
            crowded.binary_search(&contour[i]).is_ok()
                || chart.orientation(points, before, contour[i], after) != 0
        };
        if count > 0 {
            contours.push((0..count).filter(is_needed).map(|i| contour[i]).collect());
        }
    }
    contours
}

/// The points, sorted, from which more than one boundary edge starts.
fn passed_twice(boundary: &[Boundary]) -> Vec<PointId> {
    let mut starts: Vec<PointId> = boundary.iter().map(|edge| edge.ends[0]).collect();
    starts.sort_unstable();
    let crowded = starts.chunk_by(|a, b| a == b).filter(|group| group.len() > 1);
    crowded.map(|group| group[0]).collect()
}
