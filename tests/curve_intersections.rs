//! Intersections of cubics against exact elimination, on random pairs of families drawn to be nasty.
//!
//! `OGEE_CURVES_COUNT` pairs a family, from `OGEE_CURVES_SEED` on; pair `n` is the same in every run.

#![allow(clippy::print_stdout, reason = "tests say how much they did")]

#[allow(dead_code, reason = "each test program uses its part")]
mod roots;

use num_bigint::BigInt;
use num_traits::Signed;
use ogee::curve::{AnyBezier, Bernstein, Contact, Cubic, Meeting, intersect, self_intersections};
use ogee::math::{Vec2, sin_cos};
use roots::{BITS, Curve, eliminated, integers, monomials, own_eliminated};

/// A generator of numbers (Steele, Lea, Flood, SplitMix64, 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: u64) -> u64 {
        self.next() % count
    }
}

type Points = [Vec2; 4];
type Family = fn(&mut Random) -> [Points; 2];

fn anywhere(random: &mut Random) -> Points {
    [(); 4].map(|()| Vec2::new(random.unit(), random.unit()))
}

fn generic(random: &mut Random) -> [Points; 2] {
    [anywhere(random), anywhere(random)]
}

/// Points of a coarse grid: shared points, touches, lines, cusps and equal curves abound.
fn coarse(random: &mut Random) -> [Points; 2] {
    let side = 2 + random.below(4);
    let mut curve = || [(); 4].map(|()| Vec2::new(random.below(side) as f64, random.below(side) as f64));
    [curve(), curve()]
}

/// Two curves turned and moved to touch, then moved apart or together by a random little.
fn near_tangent(random: &mut Random) -> [Points; 2] {
    let [a, b] = generic(random).map(|points| Cubic::new(points).unwrap());
    let (s, t) = (random.unit(), random.unit());
    let of = |c: &Cubic<Vec2>, t: f64| (c.eval(t), c.derivative(1).unwrap().eval(t).normalize());
    let ((p, v), (q, w)) = (of(&a, s), of(&b, t));
    let turn = Vec2::new(v.dot(w), w.perp_dot(v));
    let gap = (random.unit() - 0.5) * 0.1_f64.powi(random.below(16) as i32);
    let across = Vec2::new(-v.y, v.x) * gap;
    let moved = b.map(|x| p + turn.rotate(x - q) + across).unwrap();
    [a.to_array(), moved.to_array()]
}

/// Parts of one curve, exactly or all but.
fn overlapping(random: &mut Random) -> [Points; 2] {
    let whole =
        Cubic::new([(); 4].map(|()| Vec2::new(random.below(64) as f64, random.below(64) as f64))).unwrap();
    let mut part = || {
        let (from, to) = (random.below(9) as f64 / 8.0, random.below(9) as f64 / 8.0);
        if from == to { whole } else { whole.subcurve(from, to).unwrap() }
    };
    let (a, mut b) = (part().to_array(), part().to_array());
    if random.below(4) == 0 {
        b[1].x = b[1].x.next_up();
    }
    [a, b]
}

/// Curves that share one or both ends, at an angle or smoothly.
fn sharing_ends(random: &mut Random) -> [Points; 2] {
    let [a, mut b] = generic(random);
    b[0] = a[3];
    match random.below(4) {
        0 => b[1] = a[3] + (a[3] - a[2]),
        1 => b[3] = a[0],
        2 => b[1] = a[2],
        _ => {}
    }
    [a, b]
}

/// A curve that ends on the inside of another at a dyadic parameter, turned by a random angle or not.
fn ending_on(random: &mut Random) -> [Points; 2] {
    let [a, mut b] = coarse(random);
    let a = Cubic::new(a).unwrap();
    b[0] = a.eval(random.below(9) as f64 / 8.0);
    let (sine, cosine) = sin_cos(random.unit());
    let turn = Vec2::new(cosine, sine);
    if random.below(2) == 0 {
        [a.to_array(), b]
    } else {
        [a.to_array().map(|p| turn.rotate(p)), b.map(|p| turn.rotate(p))]
    }
}

/// What the oracle knows of a pair.
enum Truth {
    /// Parameters and the multiplicity, 1 also where it may be 1.
    Meetings(Vec<(f64, f64, usize)>),
    SameCurve,
    /// One of them is a point.
    Point,
}

fn truth([a, b]: &[Points; 2]) -> Truth {
    let numbers: Vec<f64> = a.iter().chain(b).flat_map(|p| [p.x, p.y]).collect();
    let whole = integers(&numbers).0;
    let curve = |from: usize| -> Curve {
        [0, 1].map(|axis| monomials(&(0..4).map(|k| whole[from + 2 * k + axis].clone()).collect::<Vec<_>>()))
    };
    let (a_exact, b_exact) = (curve(0), curve(8));
    if a.iter().all(|&p| p == a[0]) || b.iter().all(|&p| p == b[0]) {
        return Truth::Point;
    }
    let (on_a, on_b) = (eliminated(&a_exact, &b_exact), eliminated(&b_exact, &a_exact));
    if on_a.is_empty() {
        return Truth::SameCurve;
    }
    let (roots_a, roots_b) = (roots::roots(&on_a), roots::roots(&on_b));
    // Points that are the same to 120 bits.
    let limit = (whole.iter().map(Signed::abs).max().unwrap() + 1) << (BITS - 120);
    let mut meetings = Vec::new();
    for s in &roots_a {
        for t in &roots_b {
            let near = |axis: usize| {
                let off: BigInt = roots::value(&a_exact[axis], &s.low) - roots::value(&b_exact[axis], &t.low);
                off.abs() < limit
            };
            if near(0) && near(1) {
                meetings.push((s.to_f64(), t.to_f64(), s.multiplicity.min(t.multiplicity)));
            }
        }
    }
    Truth::Meetings(meetings)
}

/// What is wrong with the answer for a pair, and the largest error of a parameter.
fn judge(pair: &[Points; 2]) -> (Option<String>, f64) {
    let [a, b] = pair.map(|points| Cubic::new(points).unwrap());
    let found = match intersect(&a, &b, None) {
        Ok(found) => found,
        Err(error) => return (Some(error.to_string()), 0.0),
    };
    match truth(pair) {
        Truth::Meetings(mut expected) => {
            // What runs together within rounding is one overlap, whatever crosses in the last digits.
            if let Some(wrong) = places_are_apart(&a, &b, &found) {
                return (Some(wrong), 0.0);
            }
            expected.retain(|(s, t, _)| !found.iter().any(|m| is_in_overlap(m, *s, *t)));
            let mut worst: f64 = 0.0;
            for m in found.iter().filter(|m| m.contact != Contact::Overlap) {
                let off = |(s, t, _): &(f64, f64, usize)| (s - m.first[0]).abs().max((t - m.second[0]).abs());
                // Of meetings that round to the same numbers the one of the same kind is meant.
                let other_kind = |place: &usize| !kind_is_right(&a, &b, m, expected[*place].2);
                let order = |i: &usize, j: &usize| off(&expected[*i]).total_cmp(&off(&expected[*j]));
                let nearest =
                    (0..expected.len()).min_by(|i, j| order(i, j).then(other_kind(i).cmp(&other_kind(j))));
                let Some(place) = nearest.filter(|&i| off(&expected[i]) < 1e-10) else {
                    return (Some(format!("{m:?} is none of {expected:?}")), worst);
                };
                let meant = expected.swap_remove(place);
                worst = worst.max(off(&meant));
                if !kind_is_right(&a, &b, m, meant.2) {
                    return (Some(format!("{m:?} has multiplicity {}", meant.2)), worst);
                }
            }
            let missed = (!expected.is_empty()).then(|| format!("missed {expected:?}, found {found:?}"));
            (missed.or_else(|| overlaps_are_wrong(&a, &b, &found, reaches_an_end)), worst)
        }
        Truth::SameCurve => {
            let apart = places_are_apart(&a, &b, &found);
            (apart.or_else(|| overlaps_are_wrong(&a, &b, &found, |_, _| true)), 0.0)
        }
        Truth::Point => (None, 0.0),
    }
}

/// Whether parameters are a pair of an overlap.
fn is_in_overlap(m: &Meeting, s: f64, t: f64) -> bool {
    let share = (s - m.first[0]) / (m.first[1] - m.first[0]);
    let paired = m.second[0] + share * (m.second[1] - m.second[0]);
    m.contact == Contact::Overlap && (-1e-6..=1.0 + 1e-6).contains(&share) && (t - paired).abs() < 1e-4
}

/// Crossings are simple or of curves at an angle; the others have their multiplicity.
fn kind_is_right(a: &Cubic<Vec2>, b: &Cubic<Vec2>, m: &Meeting, multiplicity: usize) -> bool {
    let slope = |c: &Cubic<Vec2>, t: f64| c.derivative(1).unwrap().eval(t);
    let (v, w) = (slope(a, m.first[0]), slope(b, m.second[0]));
    match m.contact {
        Contact::Crossing => multiplicity == 1 || v.perp_dot(w).abs() > 1e-9 * v.length() * w.length(),
        Contact::Tangency { multiplicity: found } => found == multiplicity && multiplicity > 1,
        _ => false,
    }
}

/// The two places of a meeting are one point.
fn places_are_apart(a: &Cubic<Vec2>, b: &Cubic<Vec2>, found: &[Meeting]) -> Option<String> {
    let apart = |m: &Meeting, k: usize| (a.eval(m.first[k]) - b.eval(m.second[k])).length();
    let mut places = found.iter().flat_map(|m| [(m, apart(m, 0)), (m, apart(m, 1))]);
    places.find(|(_, off)| *off > TOGETHER * 64.0).map(|(m, off)| format!("{m:?} is off by {off}"))
}

/// Distances below it are those of curves that run together within rounding, or near a touch.
const TOGETHER: f64 = 1e-12;

/// A sample of the first curve: its parameter, its distance from the second, and the parameter of the nearest.
struct Sample {
    s: f64,
    distance: f64,
    t: f64,
}

/// Samples of the first curve are on the second one just where overlaps say so, of those that `counts` lets count.
fn overlaps_are_wrong(
    a: &Cubic<Vec2>,
    b: &Cubic<Vec2>,
    found: &[Meeting],
    counts: fn(&[Sample], usize) -> bool,
) -> Option<String> {
    let sample = |k: u32| {
        let s = (f64::from(k) + 0.37) / 65.0;
        let nearest = ogee::curve::nearest(b, a.eval(s)).unwrap();
        Sample { s, distance: nearest.distance.value, t: nearest.t }
    };
    let samples: Vec<Sample> = (0..=64).map(sample).collect();
    samples.iter().enumerate().find_map(|(k, &Sample { s, distance, .. })| {
        let inside = found.iter().any(|m| m.contact == Contact::Overlap && m.first[0] < s && s < m.first[1]);
        let near_end = found.iter().any(|m| m.first.iter().any(|end| (end - s).abs() < 1e-3));
        let wrong = if inside {
            distance > TOGETHER * 64.0
        } else {
            distance < TOGETHER && !near_end && counts(&samples, k)
        };
        wrong.then(|| format!("at {s}: {distance} from the other, found {found:?}"))
    })
}

/// Whether the curves stay together from a sample on, both ways, to an end of one of them.
///
/// All overlaps do: curves that are one in an interval are one wherever both go on. Around a touch they part again,
/// which elimination knows, so that samples there say nothing.
fn reaches_an_end(samples: &[Sample], from: usize) -> bool {
    let at_end = |x: &Sample| x.t == 0.0 || x.t == 1.0;
    let stops = |x: &&Sample| x.distance >= TOGETHER || at_end(x);
    let onward = samples[from..].iter().find(stops).is_none_or(at_end);
    let backward = samples[..=from].iter().rev().find(stops).is_none_or(at_end);
    onward && backward
}

/// What is wrong with the meetings of a curve with itself, by elimination.
fn own_meetings_are_wrong(points: &[Vec2]) -> Option<String> {
    let numbers: Vec<f64> = points.iter().flat_map(|p| [p.x, p.y]).collect();
    let whole = integers(&numbers).0;
    let axis = |axis: usize| -> Vec<BigInt> { whole.iter().skip(axis).step_by(2).cloned().collect() };
    let exact: Curve = [0, 1].map(|k| monomials(&axis(k)));
    let polynomial = own_eliminated(&exact);
    if polynomial.is_empty() {
        return None;
    }
    let places = roots::roots(&polynomial);
    let limit = (whole.iter().map(Signed::abs).max().unwrap() + 1) << (BITS - 120);
    let mut expected = Vec::new();
    for (i, s) in places.iter().enumerate() {
        for t in &places[i + 1..] {
            let off = |k: usize| roots::value(&exact[k], &s.low) - roots::value(&exact[k], &t.low);
            if (0..2).all(|k| off(k).abs() < limit) {
                expected.push((s.to_f64(), t.to_f64()));
            }
        }
    }
    let found = self_intersections(&AnyBezier::new(points.to_vec()).unwrap()).unwrap();
    let mut got: Vec<(f64, f64)> = found.iter().map(|m| (m.first[0], m.second[0])).collect();
    for &(s, t) in &expected {
        // Parameters of loops that are all but cusps are known to fewer digits.
        let place = got.iter().position(|g| (g.0 - s).abs().max((g.1 - t).abs()) < 1e-10);
        let Some(place) = place else { return Some(format!("missed {s}, {t} among {found:?}")) };
        got.swap_remove(place);
    }
    (!got.is_empty()).then(|| format!("{got:?} are none of {expected:?}"))
}

#[test]
fn curves_meet_themselves_as_elimination_says() {
    let (count, seed) = (setting("OGEE_CURVES_COUNT", 40), setting("OGEE_CURVES_SEED", 1));
    let mut failed = 0;
    for seed in seed..seed + count {
        let mut random = Random(seed);
        let (degree, coarse) = (3 + random.below(3), random.below(2) == 0);
        let mut coordinate = || if coarse { random.below(5) as f64 } else { random.unit() };
        let points: Vec<Vec2> = (0..=degree).map(|_| Vec2::new(coordinate(), coordinate())).collect();
        if let Some(wrong) = own_meetings_are_wrong(&points) {
            failed += 1;
            println!("self, OGEE_CURVES_SEED={seed}: {wrong}\n  {points:?}");
        }
    }
    println!("self: {count} curves from seed {seed}, {failed} wrong");
    assert_eq!(failed, 0);
}

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().expect("a number"))
}

#[test]
fn cubics_meet_as_elimination_says() {
    let (count, seed) = (setting("OGEE_CURVES_COUNT", 40), setting("OGEE_CURVES_SEED", 1));
    let families: [(&str, Family); 6] = [
        ("generic", generic),
        ("coarse", coarse),
        ("near tangent", near_tangent),
        ("overlapping", overlapping),
        ("sharing ends", sharing_ends),
        ("ending on", ending_on),
    ];
    let mut failures = 0;
    for (name, family) in families {
        let (mut failed, mut worst) = (0, 0.0_f64);
        for seed in seed..seed + count {
            let pair = family(&mut Random(seed));
            let (wrong, off) = judge(&pair);
            worst = worst.max(off);
            if let Some(wrong) = wrong {
                failed += 1;
                if failed <= 3 {
                    println!("{name}, OGEE_CURVES_SEED={seed}: {wrong}\n  {pair:?}");
                }
            }
        }
        println!(
            "{name}: {count} pairs from seed {seed}, {failed} wrong, parameters off by at most {worst:.1e}"
        );
        failures += failed;
    }
    assert_eq!(failures, 0);
}

/// The oracle on a pair with a known answer: a loop and the line through its double point and its ends.
#[test]
fn the_oracle_counts_by_hand() {
    let looped = [(0.0, 0.0), (3.0, 2.0), (-1.0, 2.0), (2.0, 0.0)].map(Vec2::from);
    let level = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)].map(Vec2::from);
    let Truth::Meetings(found) = truth(&[looped, level]) else { panic!() };
    assert_eq!(found.len(), 2);
    let touch = [(0.0, 1.5), (1.0, 1.5), (2.0, 1.5), (3.0, 1.5)].map(Vec2::from);
    let Truth::Meetings(found) = truth(&[looped, touch]) else { panic!() };
    assert_eq!(found.iter().map(|m| (m.0, m.2)).collect::<Vec<_>>(), [(0.5, 2)]);
    assert!(matches!(truth(&[looped, looped]), Truth::SameCurve));
}
