//! Curves as functions: they take points and give points.

use super::{Builtin, named_row};
use crate::curve::{AnyBezier, ArcLength, Bernstein, Boundary, Cubic, CurveError, Line, Spacing, Spline};
use crate::math::{Blend, Vec2, Vec3, atan2};
use crate::script::budget::{Budget, Fault, Outcome, undefined};
use crate::script::eval::{Fragmentation, Session};
use crate::script::value::{Items, List, Value};
use crate::tessellate::flatten;

pub(super) const TABLE: &[Builtin] = &[
    named_row(
        "bezier",
        &["points", "tolerance", "degree"],
        "Points on the Bezier curve with these control points; with a degree, on a chain of curves.",
        |session, values, fragmentation| {
            let [points, tolerance, degree] = values else { return Ok(Value::Undef) };
            let kind = Kind::Bezier(degree_of(degree)?);
            drawn(session, points, &kind, false, Precision::of(tolerance, fragmentation)?)
        },
    ),
    named_row(
        "spline",
        &["points", "tolerance", "closed", "kind"],
        "Points on a smooth curve through the points; natural, not-a-knot, catmull-rom, akima or b-spline.",
        |session, values, fragmentation| {
            let [points, tolerance, closed, kind] = values else { return Ok(Value::Undef) };
            let kind = if kind.is_undef() { Kind::Natural } else { Kind::named(kind)? };
            drawn(session, points, &kind, closed.is_true(), Precision::of(tolerance, fragmentation)?)
        },
    ),
    named_row(
        "arc_length",
        &["points", "kind", "closed", "degree"],
        "Length of the lines through the points, or of the bezier or spline with that kind.",
        |session, values, _| {
            let [points, kind, closed, degree] = values else { return Ok(Value::Undef) };
            length(session, points, &Kind::of(kind, degree)?, closed.is_true())
        },
    ),
    named_row(
        "curve_points",
        &["points", "count", "kind", "closed", "degree"],
        "So many points, the same length of curve apart, on lines, a bezier or a spline of that kind.",
        |session, values, _| {
            let [points, count, kind, closed, degree] = values else { return Ok(Value::Undef) };
            evenly(session, points, count, &Kind::of(kind, degree)?, closed.is_true())
        },
    ),
];

/// Most points of one curve.
const MOST_POINTS: usize = 10_000_000;
/// Highest degree of a single curve; each point of it costs the square of that.
const MOST_DEGREE: usize = 500;
/// Share of the length to which lengths are right.
const ACCURACY: f64 = 1e-13;

/// What the points of a list mean.
#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Line,
    /// One curve, or a chain of curves of a degree, neighbours of which share a point.
    Bezier(Option<usize>),
    Natural,
    NotAKnot,
    CatmullRom,
    Akima,
    BSpline,
}

impl Kind {
    const NAMES: &'static str =
        "\"line\", \"bezier\", \"natural\", \"not-a-knot\", \"catmull-rom\", \"akima\" or \"b-spline\"";

    fn named(value: &Value) -> Result<Kind, Fault> {
        Ok(match value.text() {
            Some("line") => Kind::Line,
            Some("bezier") => Kind::Bezier(None),
            Some("natural") => Kind::Natural,
            Some("not-a-knot") => Kind::NotAKnot,
            Some("catmull-rom") => Kind::CatmullRom,
            Some("akima") => Kind::Akima,
            Some("b-spline") => Kind::BSpline,
            Some(other) => return undefined(format!("there is no kind \"{other}\"; it is {}", Kind::NAMES)),
            None => return undefined(format!("the kind must be {}, not {}", Kind::NAMES, value.kind())),
        })
    }

    /// The kind that the arguments name, lines by default.
    fn of(kind: &Value, degree: &Value) -> Result<Kind, Fault> {
        let kind = if kind.is_undef() { Kind::Line } else { Kind::named(kind)? };
        match (kind, degree_of(degree)?) {
            (Kind::Bezier(_), degree) => Ok(Kind::Bezier(degree)),
            (kind, None) => Ok(kind),
            (_, Some(_)) => undefined("only the kind \"bezier\" takes a degree"),
        }
    }
}

fn degree_of(value: &Value) -> Result<Option<usize>, Fault> {
    if value.is_undef() {
        return Ok(None);
    }
    let degree =
        value.finite().filter(|degree| degree.fract() == 0.0 && (1.0..=MOST_DEGREE as f64).contains(degree));
    let wrong = || Fault::Undefined(format!("the degree must be a whole number from 1 to {MOST_DEGREE}"));
    degree.map(|degree| Some(degree as usize)).ok_or_else(wrong)
}

/// How closely lines must follow a curve.
#[derive(Clone, Copy)]
enum Precision {
    /// No point of the curve is farther from the lines than this.
    Tolerance(f64),
    /// So many lines a piece, by parameter.
    Count(usize),
    /// No line is longer than a size, or turns by more than an angle in radians, whichever gives fewer lines.
    Steps { angle: f64, size: f64 },
}

impl Precision {
    /// The tolerance where there is one, else what `$fn`, `$fe`, `$fa` and `$fs` say, in this order.
    fn of(tolerance: &Value, fragmentation: Fragmentation) -> Result<Precision, Fault> {
        if !tolerance.is_undef() {
            let tolerance = tolerance.finite().filter(|tolerance| *tolerance > 0.0);
            let wrong = || Fault::Undefined("the tolerance must be a positive number".to_owned());
            return tolerance.map(Precision::Tolerance).ok_or_else(wrong);
        }
        let Fragmentation { count, angle, size, error } = fragmentation;
        if count > 0.0 {
            let fits = count.is_finite() && count <= MOST_POINTS as f64;
            let too_many =
                || Fault::Limit(format!("$fn of {count} is more than the {MOST_POINTS} points of a curve"));
            return if fits {
                Ok(Precision::Count(count.trunc().max(1.0) as usize))
            } else {
                Err(too_many())
            };
        }
        if error > 0.0 && error.is_finite() {
            return Ok(Precision::Tolerance(error));
        }
        let [angle, size] = [angle, size].map(|x| x.max(Fragmentation::FINEST));
        Ok(Precision::Steps { angle: angle.to_radians(), size })
    }
}

/// Points in the plane or in space.
enum Points {
    Flat(Vec<Vec2>),
    Space(Vec<Vec3>),
}

impl Points {
    fn of(value: &Value, budget: &mut Budget) -> Result<Points, Fault> {
        let Some(list) = value.list() else {
            return undefined(format!(
                "the points must be a list such as [[0, 0], [1, 2]], not {}",
                value.kind()
            ));
        };
        budget.spend(list.len() as u64)?;
        match list.get(0).as_ref().and_then(Value::list).map(List::len) {
            Some(3) => Ok(Points::Space(coordinates::<3>(list)?.into_iter().map(Vec3::from_array).collect())),
            _ => Ok(Points::Flat(coordinates::<2>(list)?.into_iter().map(Vec2::from_array).collect())),
        }
    }
}

fn coordinates<const N: usize>(list: &List) -> Result<Vec<[f64; N]>, Fault> {
    let point = |(index, value): (usize, Value)| {
        let numbers = value.list().and_then(List::numbers);
        let point = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        point.filter(|point| point.iter().all(|x| x.is_finite())).ok_or_else(|| {
            Fault::Undefined(format!("point {index} must be a list of {N} finite numbers, like all others"))
        })
    };
    list.iter().enumerate().map(point).collect()
}

fn drawn(
    session: &mut Session<'_>,
    points: &Value,
    kind: &Kind,
    closed: bool,
    precision: Precision,
) -> Outcome {
    let budget = &mut session.budget;
    match Points::of(points, budget)? {
        Points::Flat(points) => list_of(&followed(&points, kind, closed, precision, budget)?, budget),
        Points::Space(points) => list_of(&followed(&points, kind, closed, precision, budget)?, budget),
    }
}

fn length(session: &mut Session<'_>, points: &Value, kind: &Kind, closed: bool) -> Outcome {
    let budget = &mut session.budget;
    let total = match Points::of(points, budget)? {
        Points::Flat(points) => total(&measured(&points, kind, closed, budget)?),
        Points::Space(points) => total(&measured(&points, kind, closed, budget)?),
    };
    Ok(Value::Number(total))
}

fn evenly(session: &mut Session<'_>, points: &Value, count: &Value, kind: &Kind, closed: bool) -> Outcome {
    let least = if closed { 1.0 } else { 2.0 };
    let whole = count.finite().filter(|count| count.fract() == 0.0 && *count >= least);
    let Some(count) = whole else {
        return undefined(format!("the count must be a whole number of at least {least}"));
    };
    if count > MOST_POINTS as f64 {
        return Err(Fault::Limit(format!("{count} points are more than the {MOST_POINTS} of a curve")));
    }
    let (budget, count) = (&mut session.budget, count as usize);
    budget.spend(count as u64)?;
    match Points::of(points, budget)? {
        Points::Flat(points) => {
            list_of(&spread(&measured(&points, kind, closed, budget)?, count, closed), budget)
        }
        Points::Space(points) => {
            list_of(&spread(&measured(&points, kind, closed, budget)?, count, closed), budget)
        }
    }
}

fn list_of<P: Blend>(points: &[P], budget: &Budget) -> Outcome {
    // A list of numbers has its own header beside the value that holds it.
    budget.reserve(points.len().saturating_mul(128))?;
    let point =
        |point: &P| Value::from_numbers((0..P::DIMENSION).map(|axis| point.component(axis)).collect());
    Ok(Value::List(List::new(Items::Values(points.iter().map(point).collect()))))
}

/// The curve as pieces from end to end.
fn pieces<P: Blend>(
    points: &[P],
    kind: &Kind,
    closed: bool,
    budget: &mut Budget,
) -> Result<Vec<AnyBezier<P>>, Fault> {
    let explained = |error: CurveError| Fault::Undefined(error.to_string());
    // Solving and splitting take a few steps a point.
    budget.spend(8 * points.len() as u64)?;
    let spline = match kind {
        Kind::Line => return lines(points, closed).map_err(explained),
        Kind::Bezier(degree) => return chain(points, *degree),
        Kind::CatmullRom => Spline::catmull_rom(points, Spacing::Centripetal, closed),
        Kind::BSpline => Spline::from_uniform_b_spline(points, closed),
        Kind::Akima if closed => return undefined("the kind \"akima\" has no closed form"),
        Kind::Akima => Spline::akima(&apart(points, false), &knots(points, false)),
        Kind::Natural | Kind::NotAKnot if closed => {
            Spline::periodic(&apart(points, true), &knots(points, true))
        }
        Kind::Natural | Kind::NotAKnot => {
            let end = if *kind == Kind::Natural { Boundary::Second(P::ZERO) } else { Boundary::NotAKnot };
            Spline::interpolate(&apart(points, false), &knots(points, false), end, end)
        }
    };
    Ok(spline.map_err(explained)?.pieces().map(AnyBezier::from).collect())
}

/// The spline of a kind through or near the points of a list, for solids that are made of curves.
pub(super) fn spline_of<P: Blend>(
    value: &Value,
    kind: &Value,
    degree: &Value,
    closed: bool,
    budget: &mut Budget,
) -> Result<Spline<P>, Fault> {
    let kind = Kind::of(kind, degree)?;
    let points = match Points::of(value, budget)? {
        Points::Flat(points) => components_of(&points),
        Points::Space(points) => components_of(&points),
    };
    let points: Vec<P> = points
        .ok_or_else(|| Fault::Undefined(format!("the points must have {} coordinates", P::DIMENSION)))?;
    let explained = |error: CurveError| Fault::Undefined(error.to_string());
    let points = if kind == Kind::Line { apart(&points, closed) } else { points };
    let mut cubics = Vec::new();
    for piece in pieces(&points, &kind, closed, budget)? {
        if piece.degree() > 3 {
            return undefined(
                "a solid is made of curves of degree 3 at most; degree = 3 makes a chain of cubics",
            );
        }
        let raised = piece.elevated(3 - piece.degree());
        let four = [0, 1, 2, 3].map(|k: usize| raised.points()[k]);
        cubics.push(Cubic::new(four).map_err(explained)?);
    }
    let spline = Spline::from_pieces(&cubics).map_err(explained)?;
    let meets = cubics.len() > 1 && cubics[0].start() == cubics[cubics.len() - 1].end();
    if meets { spline.into_closed().map_err(explained) } else { Ok(spline) }
}

/// The points in another space of as many dimensions.
fn components_of<Q: Blend, P: Blend>(points: &[Q]) -> Option<Vec<P>> {
    let same = Q::DIMENSION == P::DIMENSION;
    same.then(|| points.iter().map(|point| P::from_components(|axis| point.component(axis))).collect())
}

fn lines<P: Blend>(points: &[P], closed: bool) -> Result<Vec<AnyBezier<P>>, CurveError> {
    if points.len() < 2 {
        return Err(CurveError::TooFewPoints { actual: points.len(), least: 2 });
    }
    let back = closed.then(|| [points[points.len() - 1], points[0]]);
    let pairs = points.windows(2).map(|pair| [pair[0], pair[1]]).chain(back);
    pairs.map(|pair| Line::new(pair).map(AnyBezier::from)).collect()
}

fn chain<P: Blend>(points: &[P], degree: Option<usize>) -> Result<Vec<AnyBezier<P>>, Fault> {
    let count = points.len();
    let degree = degree.unwrap_or(count.saturating_sub(1));
    if count < 2 {
        return undefined(format!("{count} points where 2 are needed"));
    }
    if degree > MOST_DEGREE {
        return undefined(format!(
            "{count} control points of one curve are too many; degree = 3 makes a chain of cubics"
        ));
    }
    if !(count - 1).is_multiple_of(degree) {
        let (fewer, pieces) = (count - 1 - (count - 1) % degree + 1, (count - 1) / degree);
        return undefined(format!(
            "a chain of degree {degree} has {degree} points a curve and one more: {fewer} make {pieces}, not {count}"
        ));
    }
    let starts = (0..count - 1).step_by(degree);
    let curves = starts.map(|start| AnyBezier::new(points[start..=start + degree].to_vec()));
    curves.map(|curve| curve.map_err(|error| Fault::Undefined(error.to_string()))).collect()
}

/// The points without repeated neighbours, between which no curve can be asked for.
fn apart<P: Blend>(points: &[P], closed: bool) -> Vec<P> {
    let mut points = points.to_vec();
    points.dedup();
    if closed && points.len() > 1 && points[0] == points[points.len() - 1] {
        points.pop();
    }
    points
}

/// Knots apart by the roots of distances: curves through uneven points neither overshoot nor loop (Lee, Choosing nodes
/// in parametric curve interpolation, 1989).
fn knots<P: Blend>(points: &[P], closed: bool) -> Vec<f64> {
    let mut points = apart(points, closed);
    if closed {
        points.extend(points.first().copied());
    }
    let mut knots = vec![0.0];
    knots.extend(points.windows(2).scan(0.0, |at, pair| {
        *at += (pair[1] - pair[0]).norm().sqrt();
        Some(*at)
    }));
    knots
}

/// Points on the curve, one for each joint; those of a closed curve do not repeat the first.
fn followed<P: Blend>(
    points: &[P],
    kind: &Kind,
    closed: bool,
    precision: Precision,
    budget: &mut Budget,
) -> Result<Vec<P>, Fault> {
    let mut out: Vec<P> = Vec::new();
    for piece in pieces(points, kind, closed, budget)? {
        let start = out.len().saturating_sub(1);
        out.truncate(start);
        match precision {
            Precision::Tolerance(tolerance) => {
                let flat = flatten(&piece, tolerance).map_err(|error| Fault::Undefined(error.to_string()))?;
                out.extend(flat.points);
            }
            Precision::Count(count) => out.extend((0..=count).map(|k| piece.eval(k as f64 / count as f64))),
            Precision::Steps { angle, size } => {
                out.push(piece.start());
                stepped(&piece, angle, size, &mut out, budget)?;
            }
        }
        if out.len() > MOST_POINTS {
            return Err(Fault::Limit(format!("a curve takes more than {MOST_POINTS} points")));
        }
        budget.spend((out.len() - start) as u64)?;
        budget.reserve(size_of_val(&out[..]))?;
    }
    out.dedup();
    if closed && out.len() > 1 && out[0] == out[out.len() - 1] {
        out.pop();
    }
    Ok(out)
}

/// Adds the ends of halves of halves until each is short or turns little, as its control polygon shows.
fn stepped<P: Blend>(
    curve: &AnyBezier<P>,
    angle: f64,
    size: f64,
    out: &mut Vec<P>,
    budget: &mut Budget,
) -> Result<(), Fault> {
    let legs: Vec<P> = curve.points().windows(2).map(|pair| pair[1] - pair[0]).collect();
    let long: f64 = legs.iter().map(|leg| leg.norm()).sum();
    let halves = curve.split(0.5);
    let (Ok((first, second)), false) = (halves, long <= size || turned(&legs) <= angle) else {
        out.push(curve.end());
        return Ok(());
    };
    budget.spend(legs.len() as u64)?;
    if out.len() > MOST_POINTS {
        return Err(Fault::Limit(format!("a curve takes more than {MOST_POINTS} points")));
    }
    stepped(&first, angle, size, out, budget)?;
    stepped(&second, angle, size, out, budget)
}

/// The sum of angles between the legs of a control polygon, which the curve turns by at most.
fn turned<P: Blend>(legs: &[P]) -> f64 {
    let units = legs.iter().map(|leg| (leg, leg.norm())).filter(|(_, norm)| *norm > 0.0);
    let units: Vec<P> = units.map(|(leg, norm)| leg.map(|x| x / norm)).collect();
    // Half of the angle between unit vectors has a sine and a cosine from their difference and sum.
    units.windows(2).map(|pair| 2.0 * atan2((pair[1] - pair[0]).norm(), (pair[1] + pair[0]).norm())).sum()
}

/// A piece with its length, and the length of all before it.
struct Measured<P> {
    piece: AnyBezier<P>,
    arc: ArcLength<P>,
    before: f64,
}

fn measured<P: Blend>(
    points: &[P],
    kind: &Kind,
    closed: bool,
    budget: &mut Budget,
) -> Result<Vec<Measured<P>>, Fault> {
    let mut before = 0.0;
    let mut all = Vec::new();
    for piece in pieces(points, kind, closed, budget)? {
        budget.spend(16 * piece.points().len() as u64)?;
        let polygon: f64 = piece.points().windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        let accuracy = (ACCURACY * polygon).clamp(f64::MIN_POSITIVE, f64::MAX);
        let arc = ArcLength::new(&piece, accuracy).map_err(|error| Fault::Undefined(error.to_string()))?;
        let length = arc.total().value;
        all.push(Measured { piece, arc, before });
        before += length;
    }
    Ok(all)
}

fn total<P: Blend>(all: &[Measured<P>]) -> f64 {
    all.last().map_or(0.0, |last| last.before + last.arc.total().value)
}

/// `count` points the same length apart: from end to end, or around.
fn spread<P: Blend>(all: &[Measured<P>], count: usize, closed: bool) -> Vec<P> {
    let steps = if closed { count } else { count - 1 };
    let whole = total(all);
    let point = |k: usize| {
        let at = whole * (k as f64 / steps as f64);
        let index = all.partition_point(|measured| measured.before <= at).saturating_sub(1);
        let Measured { piece, arc, before } = &all[index];
        // The last point is the end itself.
        if k == count - 1 && !closed {
            all[all.len() - 1].piece.end()
        } else {
            piece.eval(arc.parameter(at - before))
        }
    };
    (0..count).map(point).collect()
}

#[cfg(test)]
mod tests {
    use crate::script::Severity;
    use crate::script::tests::{check_complaint, check_echo};

    #[test]
    fn curves_are_lists_of_points() {
        check_echo(
            "a = [[0, 0], [30, 60], [70, 60], [100, 0]];
             echo(bezier(a, $fn = 2));
             echo(bezier([[0, 0, 0], [1, 2, 4]], tolerance = 0.1));
             echo(len(bezier(a, 0.01)) > 10, bezier(a, 0.01)[0], len(bezier(a, tolerance = 100)));
             echo(bezier([each a, [130, -60], [170, -60], [200, 0]], degree = 3, $fn = 1));
             echo(spline([[0, 0], [1, 1], [2, 0]], $fn = 1));
             echo(spline([[0, 0], [1, 0], [1, 1], [0, 1]], closed = true, $fn = 1));
             echo(spline([[0, 0], [2, 0], [2, 2]], kind = \"b-spline\", closed = true, $fn = 1));
             echo(spline([[0, 0], [0, 0], [3, 1]], kind = \"akima\", $fn = 1));",
            &[
                "[[0, 0], [50, 45], [100, 0]]",
                "[[0, 0, 0], [1, 2, 4]]",
                "true, [0, 0], 2",
                "[[0, 0], [100, 0], [200, 0]]",
                "[[0, 0], [1, 1], [2, 0]]",
                "[[0, 0], [1, 0], [1, 1], [0, 1]]",
                "[[1.66667, 0.333333], [1.66667, 1.33333], [0.666667, 0.333333]]",
                "[[0, 0], [3, 1]]",
            ],
        );
    }

    #[test]
    fn lengths_and_even_points() {
        check_echo(
            "a = [[0, 0], [30, 60], [70, 60], [100, 0]];
             echo(arc_length([[0, 0], [3, 4]]), arc_length([[0, 0], [3, 0], [3, 4]], closed = true));
             echo(abs(arc_length(a, kind = \"bezier\") - 141.21749836278771522) < 1e-12);
             echo(arc_length([[0, 0, 0], [1, 2, 2]]));
             echo(curve_points([[0, 0], [4, 0], [4, 4]], 5));
             echo(curve_points([[0, 0], [4, 0], [4, 4], [0, 4]], 4, closed = true));
             p = curve_points(a, 6, kind = \"bezier\");
             echo(len(p), p[0], p[5], max([for (i = [1:4]) abs(norm(p[i] - p[i - 1]) - norm(p[5 - i] - p[6 - i]))]) < 1e-9);",
            &["5, 12", "true", "3", "[[0, 0], [2, 0], [4, 0], [4, 2], [4, 4]]", "[[0, 0], [4, 0], [4, 4], [0, 4]]", "6, [0, 0], [100, 0], true"],
        );
    }

    #[test]
    fn the_usual_variables_set_the_number_of_points() {
        check_echo(
            "a = [[0, 0], [0, 55.2285], [44.7715, 100], [100, 100]];
             n = len(bezier(a));
             echo(n >= 8 && n <= 20, len(bezier(a, $fa = 2, $fs = 0.1)) > 2 * n, len(bezier(a, $fs = 1000)));",
            &["true, true, 2"],
        );
        check_echo(
            "a = [[0, 0], [0, 55.2285], [44.7715, 100], [100, 100]];
             $fe = 0.001;
             echo(len(bezier(a)) == len(bezier(a, tolerance = 0.001)), len(bezier(a, $fn = 7)));",
            &["true, 8"],
        );
    }

    #[test]
    fn own_functions_come_first() {
        check_echo(
            "function spline(x) = x + 1; bezier = function(x) 2 * x; arc_length = 7;
             echo(spline(1), bezier(4), arc_length);",
            &["2, 8, 7"],
        );
    }

    #[test]
    fn wrong_arguments_say_what_is_needed() {
        for (text, part) in [
            ("echo(bezier())", "bezier(): the points must be a list such as [[0, 0], [1, 2]], not undef"),
            ("echo(bezier([[0, 0], [1]]))", "point 1 must be a list of 2 finite numbers"),
            ("echo(bezier([[0, 0, 0], [1, 2]]))", "point 1 must be a list of 3 finite numbers"),
            ("echo(bezier([[0, 0], [1, 1 / 0]]))", "point 1 must be a list of 2 finite numbers"),
            ("echo(bezier([[0, 0]]))", "1 points where 2 are needed"),
            ("echo(bezier([[0, 0], [1, 1]], tolerance = 0))", "the tolerance must be a positive number"),
            (
                "echo(bezier([[0, 0], [1, 1], [2, 2]], degree = 3))",
                "a chain of degree 3 has 3 points a curve and one more",
            ),
            (
                "echo(spline([[0, 0], [1, 1]], kind = \"loopy\"))",
                "there is no kind \"loopy\"; it is \"line\", \"bezier\"",
            ),
            ("echo(spline([[0, 0], [0, 0]]))", "1 points where 2 are needed"),
            ("echo(curve_points([[0, 0], [1, 1]], 1.5))", "the count must be a whole number of at least 2"),
            ("echo(arc_length([[0, 0], [1, 1]], degree = 3))", "only the kind \"bezier\" takes a degree"),
        ] {
            let call = text.strip_prefix("echo(").and_then(|rest| rest.strip_suffix(')')).expect("an echo");
            check_complaint(Severity::Warning, &format!("{text};"), part, call);
        }
        check_complaint(
            Severity::Warning,
            "echo(bezier([[0, 0], [1, 1]], tolerence = 1));",
            "no parameter tolerence",
            "tolerence = 1",
        );
        check_complaint(
            Severity::Warning,
            "echo(bezier([[0, 0], [1, 1]], 1, 1, 1));",
            "too many arguments",
            "1",
        );
    }

    #[test]
    fn too_much_is_a_limit() {
        for text in [
            "echo(len(bezier([[0, 0], [1e9, 1e9], [0, 1e9]], $fn = 1e9)));",
            "echo(len(curve_points([[0, 0], [1, 1]], 1e9)));",
            "echo(len(bezier([[0, 0], [1e13, 1e12], [0, 1e13]], $fa = 0.01, $fs = 0.01)) > 100000);
             echo(len([for (i = [1:1e6]) bezier([[0, 0], [1e13, 1e12], [0, 1e13]], $fa = 0.01, $fs = 0.01)]));",
        ] {
            let mut host = crate::script::tests::Memory::default();
            let options = crate::script::Options { max_steps: 3_000_000, ..Default::default() };
            assert!(host.run_with(text, &options).is_err(), "{text}");
        }
    }
}
