//! Where pieces of surfaces meet.

use super::faces::Faces;
use crate::math::Vec3;

/// One of the surfaces that meet at a point, straightened: the points p with normal . p = offset.
#[derive(Clone, Copy)]
pub(super) struct Sheet {
    pub(super) normal: Vec3,
    pub(super) offset: f64,
}

/// A smooth piece of a surface, or a flat face, near a point.
#[derive(Clone, Copy)]
pub(super) enum Piece {
    /// A surface on the side of a point, where its gradient is taken: at a kink that differs from the other side's.
    Curved {
        surface: u32,
        toward: Vec3,
    },
    Flat(Sheet),
}

/// Sine of the least angle at which surfaces are said to cut each other.
const LEAST_SINE: f64 = 0.02;

/// How far beside a point slopes are taken, as a part of the way to the middle of a triangle: first, and where the point
/// is known well. The error of the surface taken for flat is quadratic in it.
pub(super) const BESIDE: f64 = 1e-3;
const HARDLY_BESIDE: f64 = 1e-7;

/// The part of the tolerances up to which Newton's method goes on.
const NEARLY: f64 = 1e-9;

impl Faces {
    /// A piece near a point as a plane: that at a part of the way from there to the middle of a triangle on the piece.
    pub(super) fn sheet(&self, piece: &Piece, point: Vec3, part: f64) -> Option<Sheet> {
        match *piece {
            Piece::Flat(sheet) => Some(sheet),
            Piece::Curved { surface, toward } => {
                let beside = point + part * (toward - point);
                let (value, gradient) = self.surfaces[surface as usize].gradient(beside);
                let slope = gradient.length();
                let normal = gradient / slope;
                let offset = normal.dot(beside) - value / slope;
                (normal.is_finite() && offset.is_finite()).then_some(Sheet { normal, offset })
            }
        }
    }

    /// The point of all pieces nearest to a place, by Newton's method: the least step onto all sheets, again and again.
    pub(super) fn meeting(&self, pieces: &[Piece], place: Vec3) -> Option<Vec3> {
        const STEPS: usize = 16;
        let tolerance = |piece: &Piece| match *piece {
            Piece::Curved { surface, .. } => self.surfaces[surface as usize].tolerance,
            Piece::Flat(_) => 0.0,
        };
        let off: f64 = pieces.iter().map(tolerance).sum();
        let mut point = place;
        for step in 0..STEPS {
            // At first the point may be on the wrong side of a kink.
            let is_known_well = step >= 2;
            let part = if is_known_well { HARDLY_BESIDE } else { BESIDE };
            let sheets: Option<Vec<Sheet>> =
                pieces.iter().map(|piece| self.sheet(piece, point, part)).collect();
            let (step, sine) = least_step(&sheets?, point)?;
            point += step;
            if sine < LEAST_SINE || point.distance(place) > 2.0 * off / sine {
                return None;
            }
            if is_known_well && step.length() <= NEARLY * off {
                break;
            }
        }
        // What is flat along an axis stays so to the bit.
        let sheets: Option<Vec<Sheet>> =
            pieces.iter().map(|piece| self.sheet(piece, point, HARDLY_BESIDE)).collect();
        for Sheet { normal, offset } in sheets? {
            if (normal.dot(point) - offset).abs() > NEARLY * off {
                return None;
            }
            for axis in (0..3).filter(|&axis| normal[axis].abs() == 1.0) {
                if (point[axis] - place[axis]).abs() <= NEARLY * off {
                    point[axis] = place[axis];
                }
            }
        }
        Some(point)
    }
}

/// The least step from a point onto up to three planes, and the sine of the angle at which they cut each other (for three
/// the product of two such); `None` where they do not.
fn least_step(sheets: &[Sheet], point: Vec3) -> Option<(Vec3, f64)> {
    let away = |sheet: &Sheet| sheet.offset - sheet.normal.dot(point);
    match *sheets {
        [] => None,
        [a] => Some((away(&a) * a.normal, 1.0)),
        [a, b] => {
            let along = a.normal.cross(b.normal);
            let sine = along.length();
            let step = (away(&a) * b.normal.cross(along) + away(&b) * along.cross(a.normal)) / (sine * sine);
            step.is_finite().then_some((step, sine))
        }
        [a, b, c, ..] => {
            let volume = a.normal.dot(b.normal.cross(c.normal));
            let step = (away(&a) * b.normal.cross(c.normal)
                + away(&b) * c.normal.cross(a.normal)
                + away(&c) * a.normal.cross(b.normal))
                / volume;
            step.is_finite().then_some((step, volume.abs()))
        }
    }
}
