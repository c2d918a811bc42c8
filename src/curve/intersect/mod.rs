//! Where curves meet: with a line, with another curve, with themselves, each meeting classified.
//!
//! First in `f64`: parts of the curves that are apart, or cross once, are proved so by their hulls with all rounding
//! allowed for, and crossings are found by Newton's iteration and proved by Kantorovich's theorem ([`search`]); places that
//! rounding leaves open are looked at again through a window of their own ([`zoom`]). A pair of curves of which even that
//! leaves anything open (they touch, share ends in the inner of one another, or overlap) is
//! decided by elimination in integers of any size ([`exact`], [`overlap`]): control points are fractions, so the answer
//! is that of the curves as given. Where the product of degrees is too high for that, it is that of curves whose control
//! points differ by rounding ([`touch`]). Parts of one curve, whose control points cutting has rounded, are never exactly
//! the same: what runs together within that rounding is an overlap all the same ([`together`]).

mod exact;
mod line;
mod near;
mod overlap;
mod own;
mod part;
mod scene;
mod search;
mod together;
mod touch;
mod zoom;

pub use line::intersect_line;
pub use own::self_intersections;

use super::{Bernstein, CurveError};
use crate::math::Vec2;
use exact::{Eliminated, IntegerCurve, Pair};
use part::Store;
use scene::Scene;
use search::{Crossing, Search};

/// How two curves meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contact {
    /// They pass from one side to the other at an angle, or one of them ends on the other.
    Crossing,
    /// They touch with a common tangent, or at a cusp; odd multiplicities pass to the other side.
    Tangency {
        /// The number of meetings that fall into one, 2 or more. Ends at which curves continue one another count 2.
        multiplicity: usize,
    },
    /// They run together.
    Overlap,
    /// They do not meet but come nearer than the tolerance that was asked for.
    NearMiss {
        /// How near.
        distance: f64,
    },
}

/// A place where two curves meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// First and last parameter on the first curve; the same but for overlaps.
    pub first: [f64; 2],
    /// The parameters on the second curve that belong to those of `first`, descending where it runs the other way.
    pub second: [f64; 2],
    /// The point of the first curve at `first[0]`.
    pub point: Vec2,
    /// How they meet.
    pub contact: Contact,
}

impl Contact {
    /// A crossing for 1, else a tangency.
    fn of_multiplicity(multiplicity: usize) -> Contact {
        if multiplicity <= 1 { Contact::Crossing } else { Contact::Tangency { multiplicity } }
    }
}

impl Meeting {
    /// A meeting at single parameters, its point still to be found.
    fn at(s: f64, t: f64, contact: Contact) -> Meeting {
        Meeting { first: [s; 2], second: [t; 2], point: Vec2::ZERO, contact }
    }

    /// Whether it is an overlap that has these parameters.
    fn covers(&self, s: f64, t: f64) -> bool {
        let [from, to] = [self.second[0].min(self.second[1]), self.second[0].max(self.second[1])];
        self.contact == Contact::Overlap && self.first[0] <= s && s <= self.first[1] && from <= t && t <= to
    }
}

impl From<Crossing> for Meeting {
    fn from(crossing: Crossing) -> Meeting {
        Meeting::at(crossing.s, crossing.t, Contact::Crossing)
    }
}

impl From<Pair> for Meeting {
    fn from(pair: Pair) -> Meeting {
        Meeting::at(pair.s, pair.t, Contact::of_multiplicity(pair.multiplicity))
    }
}

/// Pairs of parts that are looked at; a crossing takes about ten, a touch some hundred.
const BUDGET: usize = 20_000;
/// The same where what is left open can be decided by elimination, which takes about as long as so many pairs.
const SHORT_BUDGET: usize = 4_000;

/// Where two curves meet, ascending along the first.
///
/// Exact in number, order and kind for curves of degrees whose product is at most 100; parameters are right to a few
/// units in the last place of 1, and to the last one where the curves touch. One exception is made from exactness: where
/// the curves, between places at which one of them ends, are the same up to 16 n u of the largest coordinate (n the
/// higher degree, u = 2^-53; 5e-15 of it for cubics), which is what it costs to cut them out of one curve, they overlap.
/// A curve that is a point meets another at parameter 0. With a tolerance, in model units, places where the curves come that near without meeting, and nearer
/// than around, are reported as well.
///
/// # Errors
/// [`CurveError::Tolerance`] for one that is not a positive number, [`CurveError::TooClose`] when curves with a product
/// of degrees above 100 run together within rounding without being one.
pub fn intersect<A, B>(first: &A, second: &B, tolerance: Option<f64>) -> Result<Vec<Meeting>, CurveError>
where
    A: Bernstein<Vector = Vec2>,
    B: Bernstein<Vector = Vec2>,
{
    tolerance.map_or(Ok(()), super::check_tolerance)?;
    let (a, b) = (first.points(), second.points());
    if tolerance.is_none() && boxes_are_apart(a, b) {
        return Ok(Vec::new());
    }
    let mut found = match (as_cubic(a), as_cubic(b)) {
        (Some(cubic_a), Some(cubic_b)) => met(a, b, &Scene::new(cubic_a, cubic_b), tolerance)?,
        _ => met(a, b, &Scene::new(a.to_vec(), b.to_vec()), tolerance)?,
    };
    for meeting in &mut found {
        meeting.point = first.eval(meeting.first[0]);
    }
    Ok(sorted(found))
}

/// Whether the boxes of the control points are apart: exact.
#[inline]
fn boxes_are_apart(a: &[Vec2], b: &[Vec2]) -> bool {
    let extent = |points: &[Vec2]| {
        points.iter().fold((points[0], points[0]), |(low, high), &p| (low.min(p), high.max(p)))
    };
    let ((a_low, a_high), (b_low, b_high)) = (extent(a), extent(b));
    a_low.cmpgt(b_high).any() || b_low.cmpgt(a_high).any()
}

/// The control points as a cubic's, off by at most 2 u of the larger ones where the degree is raised.
#[inline]
fn as_cubic(points: &[Vec2]) -> Option<[Vec2; 4]> {
    let blend = |p: Vec2, q: Vec2, share: f64| p * (1.0 - share) + q * share;
    match *points {
        [a, b, c, d] => Some([a, b, c, d]),
        [a, b, c] => Some([a, blend(a, b, 2.0 / 3.0), blend(c, b, 2.0 / 3.0), c]),
        [a, b] => Some([a, blend(a, b, 1.0 / 3.0), blend(b, a, 1.0 / 3.0), b]),
        [a] => Some([a; 4]),
        _ => None,
    }
}

/// The meetings in any order, points not yet filled in.
fn met<S: Store>(
    a: &[Vec2],
    b: &[Vec2],
    scene: &Scene<S>,
    tolerance: Option<f64>,
) -> Result<Vec<Meeting>, CurveError> {
    let decidable = (a.len() - 1) * (b.len() - 1) <= exact::MAX_ELIMINATED;
    let mut search = Search::new(scene, if decidable { SHORT_BUDGET } else { BUDGET }, false);
    let [whole_a, whole_b] = scene.parts();
    search.run(&whole_a, &whole_b);
    let mut found = if search.open.is_empty() {
        search.crossings.into_iter().map(Meeting::from).collect()
    } else if let Some(found) = together::on_line(scene, a, b) {
        found
    } else if let Some(crossings) = zoom::settled(scene, &search) {
        crossings.into_iter().map(Meeting::from).collect()
    } else if decidable {
        decided(scene, a, b)
    } else {
        touch::classified(scene, search, together::overlaps(scene))?
    };
    if let Some(tolerance) = tolerance {
        let misses = near::misses(scene, scene.inward(tolerance), &found);
        found.extend(misses);
    }
    Ok(found)
}

/// The meetings by elimination, but for what runs together within rounding.
fn decided<S: Store>(scene: &Scene<S>, a: &[Vec2], b: &[Vec2]) -> Vec<Meeting> {
    let [a, b] = IntegerCurve::of([a, b]);
    if a.degree() == 0 || b.degree() == 0 {
        return exact::meetings_of_point(&a, &b).into_iter().map(Meeting::from).collect();
    }
    match exact::meetings(&a, &b) {
        Eliminated::Pairs(pairs) => {
            together::merged(together::overlaps(scene), pairs.into_iter().map(Meeting::from).collect())
        }
        Eliminated::SameCurve => overlap::common(&a, &b),
    }
}

/// Ascending along the first curve, then along the second.
fn sorted(mut meetings: Vec<Meeting>) -> Vec<Meeting> {
    meetings.sort_by(|a, b| a.first[0].total_cmp(&b.first[0]).then(a.second[0].total_cmp(&b.second[0])));
    meetings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{AnyBezier, Cubic};

    fn cubic(points: [(f64, f64); 4]) -> Cubic<Vec2> {
        Cubic::new(points.map(Vec2::from)).unwrap()
    }

    fn any(points: &[(f64, f64)]) -> AnyBezier<Vec2> {
        AnyBezier::new(points.iter().map(|&p| Vec2::from(p)).collect()).unwrap()
    }

    /// An arch and its mirror image, moved so that they are `gap` apart.
    fn arches(gap: f64) -> [Cubic<Vec2>; 2] {
        let arch = cubic([(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)]);
        [arch, arch.map(|p| Vec2::new(p.x, 90.0 + gap - p.y)).unwrap()]
    }

    #[test]
    fn touching_near_and_crossing_arches() {
        let [a, b] = arches(0.0);
        let found = intersect(&a, &b, None).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].contact, Contact::Tangency { multiplicity: 2 });
        assert_eq!((found[0].first[0], found[0].second[0]), (0.5, 0.5));
        let [a, b] = arches(1e-9);
        assert_eq!(intersect(&a, &b, None).unwrap(), []);
        let near = intersect(&a, &b, Some(1e-6)).unwrap();
        let [Meeting { contact: Contact::NearMiss { distance }, .. }] = near[..] else { panic!("{near:?}") };
        assert!((distance - 1e-9).abs() < 1e-13);
        let [a, b] = arches(-1e-9);
        let found = intersect(&a, &b, Some(1e-3)).unwrap();
        assert_eq!(found.len(), 2, "{found:?}");
        for (meeting, sign) in found.iter().zip([-1.0, 1.0]) {
            assert_eq!(meeting.contact, Contact::Crossing);
            assert!((meeting.first[0] - 0.5 - sign * 1.66667e-6).abs() < 1e-10, "{meeting:?}");
        }
    }

    #[test]
    fn overlaps_have_intervals() {
        let curve = cubic([(0.0, 0.0), (8.0, 24.0), (32.0, -16.0), (40.0, 8.0)]);
        let (a, b) = (curve.subcurve(0.0, 0.75).unwrap(), curve.subcurve(0.25, 1.0).unwrap());
        let check = |found: &[Meeting], first: [f64; 2], second: [f64; 2]| {
            assert!(found.len() == 1 && found[0].contact == Contact::Overlap, "{found:?}");
            assert_eq!((found[0].first, found[0].second), (first, second));
        };
        check(&intersect(&a, &b, None).unwrap(), [1.0 / 3.0, 1.0], [0.0, 2.0 / 3.0]);
        check(&intersect(&curve, &curve, None).unwrap(), [0.0, 1.0], [0.0, 1.0]);
        check(&intersect(&curve, &curve.reversed(), None).unwrap(), [0.0, 1.0], [1.0, 0.0]);
        let (left, right) = curve.split(0.5).unwrap();
        let joint = intersect(&left, &right, None).unwrap();
        assert!(joint.len() == 1 && (joint[0].first, joint[0].second) == ([1.0; 2], [0.0; 2]), "{joint:?}");
        let high = AnyBezier::from(curve).elevated(2);
        assert!(intersect(&high, &high, None).unwrap()[0].contact == Contact::Overlap);
    }

    #[test]
    fn lines_and_doubled_parabolas_overlap() {
        let (long, short) = (any(&[(0.0, 0.0), (4.0, 2.0)]), any(&[(1.0, 0.5), (6.0, 3.0)]));
        let found = intersect(&long, &short, None).unwrap();
        assert_eq!(
            (found[0].contact, found[0].first, found[0].second),
            (Contact::Overlap, [0.25, 1.0], [0.0, 0.6])
        );
        // x = t^2 - 1/4 over [-1/2, 1/2] and x = u: down to 0 and back.
        let back = any(&[(0.0, 0.0), (-0.5, 0.0), (0.0, 0.0)]);
        let found = intersect(&back, &any(&[(-1.0, 0.0), (1.0, 0.0)]), None).unwrap();
        let intervals: Vec<_> = found.iter().map(|m| (m.first, m.second)).collect();
        assert_eq!(intervals, [([0.0, 0.5], [0.5, 0.375]), ([0.5, 1.0], [0.375, 0.5])]);
        // (x, y) = (u, u^2) at u = s (1 - s), a parabola there and back, against u itself.
        let doubled = any(&[(0.0, 0.0), (0.25, 0.0), (1.0 / 3.0, 1.0 / 6.0), (0.25, 0.0), (0.0, 0.0)]);
        let exact = doubled.map(|p| p * 12.0).unwrap();
        let exact = exact.map(|p| Vec2::new(p.x.round(), p.y.round())).unwrap();
        let parabola = any(&[(0.0, 0.0), (6.0, 0.0), (12.0, 12.0)]);
        let found = intersect(&exact, &parabola, None).unwrap();
        let intervals: Vec<_> = found.iter().map(|m| (m.contact, m.first, m.second)).collect();
        assert_eq!(
            intervals,
            [(Contact::Overlap, [0.0, 0.5], [0.0, 0.25]), (Contact::Overlap, [0.5, 1.0], [0.25, 0.0])]
        );
    }

    #[test]
    fn points_and_ends_on_curves() {
        let arch = arches(0.0)[0];
        let top = any(&[(50.0, 45.0)]);
        let found = intersect(&arch, &top, None).unwrap();
        assert!(found.len() == 1 && (found[0].first[0], found[0].second[0]) == (0.5, 0.0), "{found:?}");
        assert_eq!(intersect(&top, &top, None).unwrap().len(), 1);
        assert_eq!(intersect(&top, &any(&[(50.0, 46.0)]), None).unwrap(), []);
        // A line that ends on the top, and one that ends a hair below.
        for (end, count) in [(45.0, 1), (45.0_f64.next_up(), 0), (45.0_f64.next_down(), 1)] {
            let line = any(&[(40.0, 90.0), (50.0, end)]);
            let found = intersect(&line, &arch, None).unwrap();
            assert_eq!(found.len(), count, "{end}: {found:?}");
        }
    }

    #[test]
    fn parallel_lines_are_near() {
        let (a, b) = (any(&[(0.0, 0.0), (4.0, 0.0)]), any(&[(1.0, 1e-3), (9.0, 1e-3)]));
        assert_eq!(intersect(&a, &b, None).unwrap(), []);
        let near = intersect(&a, &b, Some(1e-2)).unwrap();
        assert!(!near.is_empty() && near.len() < 20, "{near:?}");
        for miss in near {
            assert!(
                matches!(miss.contact, Contact::NearMiss { distance } if (distance - 1e-3).abs() < 1e-15)
            );
        }
    }

    #[test]
    fn high_degrees_meet() {
        let wave = |degree: usize, phase: usize| {
            let points =
                (0..=degree).map(|k| Vec2::new(k as f64, ((k * k * 7919 + phase) % 101) as f64 - 50.0));
            AnyBezier::new(points.collect()).unwrap()
        };
        let (a, b) = (wave(30, 0), wave(24, 40));
        let found = intersect(&a, &b, None).unwrap();
        let back = intersect(&b, &a, None).unwrap();
        assert_eq!(found.len(), back.len());
        for m in &found {
            assert!((a.eval(m.first[0]) - b.eval(m.second[0])).length() < 1e-11);
        }
        let same = intersect(&a, &a, None).unwrap();
        assert_eq!(
            (same[0].contact, same[0].first, same[0].second),
            (Contact::Overlap, [0.0, 1.0], [0.0, 1.0])
        );
        let line = any(&[(-1.0, 0.25), (2000.0, 0.5)]);
        assert!(!intersect(&wave(600, 0), &line, None).unwrap().is_empty());
    }

    #[test]
    fn scale_does_not_matter() {
        let a = cubic([(0.0, 0.0), (1.0, 3.0), (4.0, -2.0), (5.0, 1.0)]);
        let b = cubic([(0.0, 1.0), (2.0, -3.0), (3.0, 4.0), (5.0, 0.0)]);
        let want = intersect(&a, &b, None).unwrap();
        assert_eq!(want.len(), 3);
        for exponent in [-1000, -40, 900] {
            let scale = 2.0_f64.powi(exponent);
            let scaled = |c: &Cubic<Vec2>| c.map(|p| p * scale).unwrap();
            let got = intersect(&scaled(&a), &scaled(&b), None).unwrap();
            let parameters = |m: &[Meeting]| m.iter().map(|m| (m.first, m.second)).collect::<Vec<_>>();
            assert_eq!(parameters(&got), parameters(&want));
        }
    }
}
