//! Lists of points, maps, lengths and views: the other attributes.

use super::scan::{Fault, Scanner};
use crate::math::{Affine2, Mat2, Vec2, sin_cos_degrees};

/// The points of a polyline.
pub(super) fn points(value: &str) -> Result<Vec<Vec2>, Fault> {
    let mut scanner = Scanner::new(value);
    let mut points = Vec::new();
    scanner.skip_spaces();
    while scanner.peek().is_some() {
        let x = scanner.listed("a coordinate")?;
        points.push(Vec2::new(x, scanner.listed("the second coordinate of a point")?));
    }
    Ok(points)
}

/// The product of a list of maps.
pub(super) fn transform(value: &str) -> Result<Affine2, Fault> {
    let mut scanner = Scanner::new(value);
    let mut product = Affine2::IDENTITY;
    scanner.skip_spaces();
    if scanner.rest().trim_end() == "none" {
        return Ok(product);
    }
    while scanner.peek().is_some() {
        product *= one_map(&mut scanner)?;
        scanner.separator();
    }
    Ok(product)
}

fn one_map(scanner: &mut Scanner<'_>) -> Result<Affine2, Fault> {
    let named = scanner.at;
    let name = scanner.word();
    let counts: &[usize] = match name {
        "matrix" => &[6],
        "translate" | "scale" => &[1, 2],
        "rotate" => &[1, 3],
        "skewX" | "skewY" => &[1],
        _ => {
            let expected = "one of matrix, translate, scale, rotate, skewX, skewY";
            return Err(Fault { at: named, expected });
        }
    };
    let given = arguments(scanner)?;
    if !counts.contains(&given.len()) {
        return Err(Fault { at: named, expected: "a map with its number of arguments" });
    }
    Ok(map_of(name, &given))
}

fn arguments(scanner: &mut Scanner<'_>) -> Result<Vec<f64>, Fault> {
    scanner.skip_spaces();
    if !scanner.take(b'(') {
        return Err(scanner.fault("("));
    }
    scanner.skip_spaces();
    let mut given = Vec::new();
    while !scanner.take(b')') {
        // No map takes more than six.
        if given.len() == 6 {
            return Err(scanner.fault(")"));
        }
        given.push(scanner.listed("a number")?);
    }
    Ok(given)
}

fn map_of(name: &str, given: &[f64]) -> Affine2 {
    let slope = |degrees: f64| {
        let (sine, cosine) = sin_cos_degrees(degrees);
        sine / cosine
    };
    match (name, given) {
        ("matrix", &[a, b, c, d, e, f]) => {
            Affine2::from_cols(Vec2::new(a, b), Vec2::new(c, d), Vec2::new(e, f))
        }
        ("translate", &[x]) => Affine2::from_translation(Vec2::new(x, 0.0)),
        ("translate", &[x, y]) => Affine2::from_translation(Vec2::new(x, y)),
        ("scale", &[factor]) => Affine2::from_scale(Vec2::splat(factor)),
        ("scale", &[x, y]) => Affine2::from_scale(Vec2::new(x, y)),
        ("rotate", &[degrees]) => rotation(degrees),
        ("rotate", &[degrees, x, y]) => {
            let center = Vec2::new(x, y);
            let turn = rotation(degrees);
            Affine2::from_translation(center - turn.transform_vector2(center)) * turn
        }
        ("skewX", &[degrees]) => Affine2::from_mat2(Mat2::from_cols(Vec2::X, Vec2::new(slope(degrees), 1.0))),
        ("skewY", &[degrees]) => Affine2::from_mat2(Mat2::from_cols(Vec2::new(1.0, slope(degrees)), Vec2::Y)),
        _ => Affine2::IDENTITY,
    }
}

fn rotation(degrees: f64) -> Affine2 {
    let (sine, cosine) = sin_cos_degrees(degrees);
    Affine2::from_mat2(Mat2::from_cols(Vec2::new(cosine, sine), Vec2::new(-sine, cosine)))
}

/// User units of an inch.
const INCH: f64 = 96.0;

/// A length in user units; percentages are of `whole`.
///
/// Sizes of type are not followed: `em` is 16 units and `ex` 8.
pub(super) fn length(value: &str, whole: f64) -> Result<f64, Fault> {
    let mut scanner = Scanner::new(value);
    scanner.skip_spaces();
    let number = scanner.number("a length")?;
    if scanner.take(b'%') {
        scanner.end()?;
        return Ok(number / 100.0 * whole);
    }
    let at = scanner.at;
    // Multiplied before divided: whole numbers of millimetres stay as exact as can be.
    let units = match scanner.word().to_ascii_lowercase().as_str() {
        "" | "px" => number,
        "in" => number * INCH,
        "cm" => number * INCH / 2.54,
        "mm" => number * INCH / 25.4,
        "q" => number * INCH / 101.6,
        "pt" => number * INCH / 72.0,
        "pc" => number * INCH / 6.0,
        "em" | "rem" => number * 16.0,
        "ex" | "ch" => number * 8.0,
        _ => return Err(Fault { at, expected: "a unit: px, in, cm, mm, Q, pt, pc, em, ex or %" }),
    };
    scanner.end()?;
    Ok(units)
}

/// A view box: its corner and its size.
pub(super) fn view_box(value: &str) -> Result<[Vec2; 2], Fault> {
    let mut scanner = Scanner::new(value);
    scanner.skip_spaces();
    let expected = "four numbers: x, y, width and height";
    let mut number = || scanner.listed(expected);
    let (corner, size) = (Vec2::new(number()?, number()?), Vec2::new(number()?, number()?));
    scanner.end()?;
    if size.cmplt(Vec2::ZERO).any() {
        return Err(Fault { at: 0, expected: "a view box whose width and height are not negative" });
    }
    Ok([corner, size])
}

/// The map that brings a view box into a viewport of this size, as `preserveAspectRatio` says.
pub(super) fn fit([corner, size]: [Vec2; 2], viewport: Vec2, aspect: &str) -> Affine2 {
    let mut scale = viewport / size;
    let words = || aspect.split_ascii_whitespace();
    let align = words().find(|word| *word != "defer").unwrap_or("xMidYMid");
    if align != "none" {
        let slice = words().any(|word| word == "slice");
        scale = Vec2::splat(if slice { scale.max_element() } else { scale.min_element() });
    }
    let share = |low: &str, high: &str| match () {
        () if align.contains(low) => 0.0,
        () if align.contains(high) => 1.0,
        () => 0.5,
    };
    let left = viewport - size * scale;
    let shift = left * Vec2::new(share("xMin", "xMax"), share("YMin", "YMax"));
    Affine2::from_translation(shift - corner * scale) * Affine2::from_scale(scale)
}
