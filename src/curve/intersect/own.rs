//! Where a curve meets itself.

use super::exact::{self, Eliminated, IntegerCurve};
use super::part::{Part, Store};
use super::scene::Scene;
use super::search::Search;
use super::{BUDGET, Contact, Meeting, overlap, together, touch};
use crate::curve::{AnyBezier, Bernstein, Cubic, CubicShape, CurveError};
use crate::math::Vec2;

/// Where a curve meets itself: pairs of different parameters, the smaller one first, ascending.
///
/// A cubic that is not on a line has at most one such point, in closed form. Other curves are halved until their parts
/// turn less than a quarter, which cannot meet themselves, and parts are searched against one another as in
/// [`intersect`](super::intersect); what rounding leaves open is decided by elimination up to degree 11. Curves that run
/// back over themselves, also within the rounding of their control points, have overlaps. Cusps and turns are no
/// meetings.
///
/// # Errors
/// [`CurveError::TooClose`] as [`intersect`](super::intersect), never up to degree 11.
pub fn self_intersections<C: Bernstein<Vector = Vec2>>(curve: &C) -> Result<Vec<Meeting>, CurveError> {
    let points = curve.points();
    let scene = Scene::new(points.to_vec(), points.to_vec());
    let mut found = match together::own_on_line(&scene, points).or_else(|| of_cubic(points)) {
        Some(found) => found,
        None if points.len() <= 4 => decided(&scene, points),
        None => searched(&scene, points)?,
    };
    found.sort_by(|a, b| a.first[0].total_cmp(&b.first[0]).then(a.second[0].total_cmp(&b.second[0])));
    for meeting in &mut found {
        meeting.point = curve.eval(meeting.first[0]);
    }
    Ok(found)
}

/// The closed form of a curve up to degree 3, where it is clear whether the parameters are within [0, 1].
fn of_cubic(points: &[Vec2]) -> Option<Vec<Meeting>> {
    let raised = AnyBezier::assume(points.to_vec()).elevated(3_usize.checked_sub(points.len() - 1)?);
    let &[a, b, c, d] = raised.points() else { return None };
    if points.len() < 4 {
        return None;
    }
    match Cubic::assume([a, b, c, d]).shape() {
        CubicShape::Loop { parameters: [s, t] } => {
            // Parameters of a loop are right to a few units in the last place unless it is nearly a cusp.
            let clear = |x: f64| x.abs() > 1e-9 && (x - 1.0).abs() > 1e-9;
            if !(clear(s) && clear(t) && t - s > 1e-3) {
                return None;
            }
            let inside = 0.0 < s && t < 1.0;
            let meeting = Meeting { first: [s; 2], second: [t; 2], point: a, contact: Contact::Crossing };
            Some(if inside { vec![meeting] } else { Vec::new() })
        }
        CubicShape::Serpentine | CubicShape::Cusp { .. } => Some(Vec::new()),
        CubicShape::Quadratic | CubicShape::Straight => None,
    }
}

fn decided<S: Store>(scene: &Scene<S>, points: &[Vec2]) -> Vec<Meeting> {
    let [curve] = IntegerCurve::of([points]);
    match exact::own_meetings(&curve) {
        Eliminated::Pairs(pairs) => {
            let exact = pairs.into_iter().map(Meeting::from).collect();
            together::merged(together::own_overlap(scene).into_iter().collect(), exact)
        }
        Eliminated::SameCurve => overlap::own(&curve),
    }
}

fn searched<S: Store>(scene: &Scene<S>, points: &[Vec2]) -> Result<Vec<Meeting>, CurveError> {
    let decidable = (points.len() - 2).pow(2) <= exact::MAX_ELIMINATED;
    let mut search = Search::new(scene, BUDGET, decidable);
    let [whole, _] = scene.parts();
    alone(&whole, &mut search);
    if search.open.is_empty() {
        return Ok(search.crossings.into_iter().map(Meeting::from).collect());
    }
    if decidable {
        return Ok(decided(scene, points));
    }
    let overlaps = together::own_overlap(scene).into_iter().collect();
    touch::classified(scene, search, overlaps)
}

/// Searches a part against itself.
fn alone<S: Store>(part: &Part<S>, search: &mut Search<'_, S>) {
    if part.advances() || part.points.as_ref().iter().all(|&p| p == part.points.as_ref()[0]) {
        return;
    }
    let [left, right] = part.halves();
    if search.is_narrow(&left) {
        return search.leave_open(&left, &right);
    }
    alone(&left, search);
    alone(&right, search);
    neighbours(part, &left, &right, search);
}

/// Searches a part against the one that follows it; `both` are the two as one.
fn neighbours<S: Store>(both: &Part<S>, left: &Part<S>, right: &Part<S>, search: &mut Search<'_, S>) {
    if both.advances() {
        return;
    }
    if search.is_narrow(left) {
        return search.leave_open(left, right);
    }
    let ([far, near], [next, beyond]) = (left.halves(), right.halves());
    search.run(&far, &next);
    search.run(&far, &beyond);
    search.run(&near, &beyond);
    let middle = both.cut(0.25, 0.75);
    neighbours(&middle, &near, &next, search);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[(f64, f64)]) -> AnyBezier<Vec2> {
        AnyBezier::new(points.iter().map(|&p| Vec2::from(p)).collect()).unwrap()
    }

    fn pairs(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let found = self_intersections(&curve(points)).unwrap();
        found.iter().map(|m| (m.first[0], m.second[0])).collect()
    }

    #[test]
    fn a_loop_meets_itself_once() {
        let found = pairs(&[(0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0)]);
        assert_eq!(found.len(), 1);
        assert!((found[0].0 - 0.17267316464601143).abs() < 1e-15);
        assert!((found[0].1 - (1.0 - 0.17267316464601143)).abs() < 1e-15);
        assert_eq!(pairs(&[(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)]), []);
    }

    #[test]
    fn closed_curves_meet_at_their_ends() {
        assert_eq!(pairs(&[(0.0, 0.0), (3.0, 1.0), (1.0, 3.0), (0.0, 0.0)]), [(0.0, 1.0)]);
        let ends = pairs(&[(0.0, 0.0), (3.0, 0.1), (4.0, 4.0), (0.1, 3.0), (0.0, 0.0)]);
        assert_eq!(ends, [(0.0, 1.0)]);
    }

    #[test]
    fn higher_degrees_agree_with_cubics() {
        let looped = curve(&[(0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0)]);
        for by in [1, 3, 9] {
            let found = self_intersections(&looped.elevated(by)).unwrap();
            assert!(
                found.len() == 1 && (found[0].first[0] - 0.17267316464601143).abs() < 1e-12,
                "{by}: {found:?}"
            );
        }
    }

    #[test]
    fn what_runs_back_overlaps() {
        let back = self_intersections(&curve(&[(0.0, 0.0), (2.0, 2.0), (0.0, 0.0)])).unwrap();
        assert_eq!(back.len(), 1);
        assert_eq!(
            (back[0].contact, back[0].first, back[0].second),
            (Contact::Overlap, [0.0, 0.5], [1.0, 0.5])
        );
        assert_eq!(pairs(&[(1.0, 1.0); 4]), []);
        assert_eq!(pairs(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]), []);
    }
}
