//! Basic shapes as the paths that SVG 2 says they are: where they start, which way they run, and of which pieces.

use crate::curve::{Arc, CurveError, Path, Piece, Subpath};
use crate::math::Vec2;
use std::f64::consts::FRAC_PI_2;

/// Four quarter arcs from the largest x towards larger y; nothing for a radius of zero.
pub(super) fn ellipse(center: Vec2, radii: Vec2) -> Result<Path, CurveError> {
    if radii.x == 0.0 || radii.y == 0.0 {
        return Ok(Path::default());
    }
    let (u, v) = (Vec2::new(radii.x, 0.0), Vec2::new(0.0, radii.y));
    let quarter = |axes| Arc::new(center, axes, 0.0, FRAC_PI_2).map(Piece::Arc);
    let pieces = [[u, v], [v, -u], [-u, -v], [-v, u]].map(quarter);
    closed(pieces.into_iter().collect::<Result<_, _>>()?)
}

/// Sides and corner arcs from the left end of the top side, x first; nothing for a size of zero.
pub(super) fn rectangle(corner: Vec2, size: Vec2, radii: Vec2) -> Result<Path, CurveError> {
    if size.x == 0.0 || size.y == 0.0 {
        return Ok(Path::default());
    }
    let radii = radii.min(0.5 * size);
    let radii = if radii.x == 0.0 || radii.y == 0.0 { Vec2::ZERO } else { radii };
    let far = corner + size;
    // A side that its corners use up has no length, whatever the rounding.
    let near_in = corner + radii;
    let used_up = radii.cmpge(0.5 * size);
    let far_in = Vec2::select(used_up, near_in, (far - radii).max(near_in));
    // Where arcs and sides meet, in order.
    let stops = [
        Vec2::new(near_in.x, corner.y),
        Vec2::new(far_in.x, corner.y),
        Vec2::new(far.x, near_in.y),
        Vec2::new(far.x, far_in.y),
        Vec2::new(far_in.x, far.y),
        Vec2::new(near_in.x, far.y),
        Vec2::new(corner.x, far_in.y),
        Vec2::new(corner.x, near_in.y),
    ];
    let mut pieces = Vec::new();
    for k in 0..8 {
        let (from, to) = (stops[k], stops[(k + 1) % 8]);
        if k % 2 == 0 && from != to {
            pieces.push(Piece::line(from, to)?);
        } else if k % 2 == 1 {
            pieces.extend(Arc::from_ends(from, to, radii, 0.0, false, true)?.map(Piece::Arc));
        }
    }
    closed(pieces)
}

/// The lines through points.
pub(super) fn lines(points: &[Vec2], close: bool) -> Result<Path, CurveError> {
    if points.len() < 2 {
        return Ok(Path::default());
    }
    Ok(Path { subpaths: vec![Subpath::polyline(points, close)?] })
}

fn closed(pieces: Vec<Piece>) -> Result<Path, CurveError> {
    Ok(Path { subpaths: vec![Subpath::closed(pieces)?] })
}
