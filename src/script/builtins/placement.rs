//! Modules that move their children.

use super::primitive::unusable;
use super::{Builtin, module_row};
use crate::csg::Csg;
use crate::math::{Affine3, Mat3, Vec3};
use crate::script::Failure;
use crate::script::degrees;
use crate::script::eval::{Invocation, Machine, Made};
use crate::script::value::Value;

pub(super) const TABLE: &[Builtin] = &[
    module_row("translate", &["v"], 1, "The children moved by a vector.", translate),
    module_row(
        "rotate",
        &["a", "v"],
        2,
        "The children turned by [x, y, z] degrees about the axes in this order, or by a about v.",
        rotate,
    ),
    module_row("scale", &["v"], 1, "The children scaled by a number or [x, y, z].", scale),
    module_row(
        "mirror",
        &["v"],
        1,
        "The children mirrored at the plane through the origin with normal v.",
        mirror,
    ),
    module_row(
        "multmatrix",
        &["m"],
        1,
        "The children moved by a matrix of up to 4 rows and columns.",
        multmatrix,
    ),
];

fn placed<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>, map: Affine3) -> Result<Made, Failure> {
    let children = machine.children_of(call)?;
    if map == Affine3::IDENTITY {
        return machine.joined(children, call.span);
    }
    machine.wrapped(children, call.span, |child| Csg::Transform { map, child })
}

/// Two or three finite numbers; what is missing is `usual`.
fn vector(value: &Value, usual: f64) -> Option<Vec3> {
    let vector = match *value.list()?.numbers()? {
        [x, y] => Vec3::new(x, y, usual),
        [x, y, z] => Vec3::new(x, y, z),
        _ => return None,
    };
    vector.is_finite().then_some(vector)
}

fn translate<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let value = call.arguments.get("v").cloned().unwrap_or_default();
    let Some(offset) = vector(&value, 0.0) else {
        unusable(machine, call, "v", &value, "two or three finite numbers")?;
        return placed(machine, call, Affine3::IDENTITY);
    };
    placed(machine, call, Affine3::from_translation(offset))
}

fn scale<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let value = call.arguments.get("v").cloned().unwrap_or_default();
    let factors = value.finite().map(Vec3::splat).or_else(|| vector(&value, 1.0));
    let Some(factors) = factors else {
        unusable(machine, call, "v", &value, "a finite number, or two or three")?;
        return placed(machine, call, Affine3::IDENTITY);
    };
    if factors.to_array().contains(&0.0) {
        machine.warn(call.span, "a scale by 0 leaves nothing on that axis");
    }
    placed(machine, call, Affine3::from_scale(factors))
}

fn mirror<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let value = call.arguments.get("v").cloned().unwrap_or_default();
    let normal = vector(&value, 0.0);
    if normal.is_none() {
        unusable(machine, call, "v", &value, "two or three finite numbers")?;
    }
    placed(machine, call, reflection(normal.unwrap_or(Vec3::X)))
}

/// The reflection at the plane through the origin with this normal; nothing moves for a normal of length 0.
fn reflection(normal: Vec3) -> Affine3 {
    // Scaled to its largest component first, so that squares neither vanish nor overflow.
    let largest = normal.abs().max_element();
    if largest == 0.0 {
        return Affine3::IDENTITY;
    }
    let n = normal / largest;
    let factor = 2.0 / n.length_squared();
    let column = |axis: Vec3| axis - n * (factor * n.dot(axis));
    Affine3::from_mat3(Mat3::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z)))
}

fn rotate<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let angle = call.arguments.get("a").cloned().unwrap_or_default();
    let axis = call.arguments.get("v").cloned();
    let matrix = match (&angle, &axis) {
        (Value::Number(a), _) if !a.is_finite() => None,
        (Value::Number(a), None) => Some(about_z(*a)),
        (Value::Number(a), Some(axis)) => match vector(axis, 0.0) {
            Some(axis) => Some(about(axis, *a)),
            None => {
                unusable(machine, call, "v", axis, "two or three finite numbers")?;
                Some(about_z(*a))
            }
        },
        (Value::List(list), _) => {
            if axis.is_some() {
                machine.warn(call.span, "v is ignored since a is a list");
            }
            let angles = list.numbers().filter(|angles| (1..=3).contains(&angles.len()));
            angles.map(|angles| [0, 1, 2].map(|i| angles.get(i).copied().unwrap_or(0.0))).map(about_axes)
        }
        _ => None,
    };
    let Some(matrix) = matrix.filter(Mat3::is_finite) else {
        unusable(machine, call, "a", &angle, "a finite number of degrees, or up to three")?;
        return placed(machine, call, Affine3::IDENTITY);
    };
    placed(machine, call, Affine3::from_mat3(matrix))
}

fn about_x(angle: f64) -> Mat3 {
    let (s, c) = (degrees::sin(angle), degrees::cos(angle));
    Mat3::from_cols(Vec3::X, Vec3::new(0.0, c, s), Vec3::new(0.0, -s, c))
}

fn about_y(angle: f64) -> Mat3 {
    let (s, c) = (degrees::sin(angle), degrees::cos(angle));
    Mat3::from_cols(Vec3::new(c, 0.0, -s), Vec3::Y, Vec3::new(s, 0.0, c))
}

fn about_z(angle: f64) -> Mat3 {
    let (s, c) = (degrees::sin(angle), degrees::cos(angle));
    Mat3::from_cols(Vec3::new(c, s, 0.0), Vec3::new(-s, c, 0.0), Vec3::Z)
}

/// About the x axis first, then y, then z.
fn about_axes([x, y, z]: [f64; 3]) -> Mat3 {
    about_z(z) * about_y(y) * about_x(x)
}

/// By `angle` degrees about an axis (Rodrigues); the axes of coordinates are met exactly. No turn for an axis of
/// length 0.
fn about(axis: Vec3, angle: f64) -> Mat3 {
    let largest = axis.abs().max_element();
    if largest == 0.0 {
        return Mat3::IDENTITY;
    }
    let scaled = axis / largest;
    match scaled.to_array() {
        [x, 0.0, 0.0] => return about_x(angle * x),
        [0.0, y, 0.0] => return about_y(angle * y),
        [0.0, 0.0, z] => return about_z(angle * z),
        _ => {}
    }
    let u = scaled / scaled.length();
    let (s, c) = (degrees::sin(angle), degrees::cos(angle));
    let turned = |v: Vec3| v * c + u.cross(v) * s + u * (u.dot(v) * (1.0 - c));
    Mat3::from_cols(turned(Vec3::X), turned(Vec3::Y), turned(Vec3::Z))
}

fn multmatrix<'p>(machine: &mut Machine<'p>, call: &Invocation<'_, 'p>) -> Result<Made, Failure> {
    let value = call.arguments.get("m").cloned().unwrap_or_default();
    let Some(map) = matrix(&value) else {
        unusable(machine, call, "m", &value, "a list of rows of up to four finite numbers")?;
        return placed(machine, call, Affine3::IDENTITY);
    };
    placed(machine, call, map)
}

/// The affine map of a matrix; what is missing is as in the identity. A last row [0, 0, 0, w] divides by w.
fn matrix(value: &Value) -> Option<Affine3> {
    let mut rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    for (row, given) in rows.iter_mut().zip(value.list()?.iter()) {
        let given = given.list()?.numbers()?.to_vec();
        row.iter_mut().zip(given).for_each(|(cell, number)| *cell = number);
    }
    let [x, y, z, [.., w]] = rows;
    let column = |i: usize| Vec3::new(x[i], y[i], z[i]) / w;
    let map = Affine3::from_cols(column(0), column(1), column(2), column(3));
    map.is_finite().then_some(map)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for quarters in -5..=5 {
            let angle = 90.0 * f64::from(quarters);
            for matrix in
                [about_x(angle), about_y(angle), about_z(angle), about(Vec3::new(0.0, -7.0, 0.0), angle)]
            {
                assert!(matrix.to_cols_array().iter().all(|x| [-1.0, 0.0, 1.0].contains(x)), "{matrix}");
            }
        }
        assert_eq!(about_z(90.0) * Vec3::X, Vec3::Y);
        assert_eq!(about_x(90.0) * Vec3::Y, Vec3::Z);
        assert_eq!(about_y(90.0) * Vec3::Z, Vec3::X);
    }

    #[test]
    fn an_axis_is_turned_about() {
        let turn = about(Vec3::ONE, 120.0);
        assert!((turn * Vec3::X - Vec3::Y).length() < 1e-15);
        assert!((turn * Vec3::Y - Vec3::Z).length() < 1e-15);
    }

    #[test]
    fn a_reflection_undoes_itself() {
        let map = reflection(Vec3::new(1.0, 1.0, 0.0));
        assert_eq!(map.transform_point3(Vec3::X), -Vec3::Y);
        let skew = reflection(Vec3::new(1e-200, 2e-200, -3e-200));
        let back = skew * skew;
        assert!((back.transform_point3(Vec3::ONE) - Vec3::ONE).length() < 1e-15);
    }
}
