//! Curves that run together but for the rounding of their control points: one overlap, with its ends, and no crossings.
//!
//! `OGEE_CURVES_COUNT` cases a family, from `OGEE_CURVES_SEED` on; case `n` is the same in every run.

#![allow(clippy::print_stdout, reason = "tests say how much they did")]

use ogee::curve::{
    AnyBezier, Bernstein, Contact, Cubic, Meeting, intersect, intersect_line, self_intersections,
};
use ogee::math::{Vec2, sin_cos};

/// A generator of numbers (Steele, Lea, Flood, SplitMix64, 2014).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn curve(&mut self, degree: usize) -> AnyBezier<Vec2> {
        let points = (0..=degree).map(|_| Vec2::new(self.between(-50.0, 50.0), self.between(-50.0, 50.0)));
        AnyBezier::new(points.collect()).unwrap()
    }

    /// Two parts [0, q] and [p, 1] with p < q, and what they share.
    fn cuts(&mut self) -> (f64, f64) {
        let p = self.between(0.05, 0.8);
        (p, self.between(p + 0.05, 0.95))
    }
}

fn turned(points: &[(f64, f64)], angle: f64) -> AnyBezier<Vec2> {
    let (sine, cosine) = sin_cos(angle);
    let turn = |&(x, y): &(f64, f64)| Vec2::new(cosine * x - sine * y + 0.3, sine * x + cosine * y - 0.7);
    AnyBezier::new(points.iter().map(turn).collect()).unwrap()
}

/// Of a curve, the parameters where the speed is low are known to fewer digits: what they err in points counts.
fn agrees(curve: &AnyBezier<Vec2>, got: f64, want: f64) -> bool {
    (curve.eval(got) - curve.eval(want)).length() <= 1e-12 * 50.0 && (got - want).abs() < 1e-5
}

/// Whether there is one overlap, with these ends, and besides it only crossings at an angle.
fn overlap_is(
    found: &[Meeting],
    [a, b]: [&AnyBezier<Vec2>; 2],
    first: [f64; 2],
    second: [f64; 2],
) -> Result<(), String> {
    let (overlaps, others): (Vec<&Meeting>, Vec<&Meeting>) =
        found.iter().partition(|m| m.contact == Contact::Overlap);
    let [overlap] = overlaps[..] else { return Err(format!("{} overlaps: {found:?}", overlaps.len())) };
    let ends =
        (0..2).all(|k| agrees(a, overlap.first[k], first[k]) && agrees(b, overlap.second[k], second[k]));
    let slope = |c: &AnyBezier<Vec2>, t: f64| c.derivative(1).unwrap().eval(t).normalize();
    let crosses = |m: &&Meeting| slope(a, m.first[0]).perp_dot(slope(b, m.second[0])).abs() > 1e-6;
    if ends && others.iter().all(crosses) {
        Ok(())
    } else {
        Err(format!("{found:?} for {first:?}, {second:?}"))
    }
}

/// Runs a family and counts what is wrong.
fn campaign(name: &str, case: impl Fn(&mut Random) -> Result<(), String>) {
    let setting = |name: &str, otherwise: u64| {
        std::env::var(name).map_or(otherwise, |text| text.parse().expect("a number"))
    };
    let (count, first) = (setting("OGEE_CURVES_COUNT", 40), setting("OGEE_CURVES_SEED", 1));
    let mut wrong = 0;
    for seed in first..first + count {
        if let Err(error) = case(&mut Random(seed)) {
            wrong += 1;
            if wrong <= 3 {
                println!("{name}, OGEE_CURVES_SEED={seed}: {error}");
            }
        }
    }
    println!("{name}: {count} cases from seed {first}, {wrong} wrong");
    assert_eq!(wrong, 0, "{name}");
}

#[test]
fn parts_of_one_cubic() {
    campaign("parts of a cubic", |random| {
        let whole = random.curve(3);
        let (p, q) = random.cuts();
        let (a, b) = (whole.subcurve(0.0, q).unwrap(), whole.subcurve(p, 1.0).unwrap());
        let found = intersect(&a, &b, None).unwrap();
        overlap_is(&found, [&a, &b], [p / q, 1.0], [0.0, (q - p) / (1.0 - p)])
    });
}

#[test]
fn parts_far_from_the_origin() {
    campaign("parts of a cubic, far away", |random| {
        let whole = random.curve(3).map(|x| x + Vec2::new(3e5, -7e5)).unwrap();
        let (p, q) = random.cuts();
        let (a, b) = (whole.subcurve(0.0, q).unwrap(), whole.subcurve(p, 1.0).unwrap());
        let found = intersect(&a, &b, None).unwrap();
        let overlap = found.iter().find(|m| m.contact == Contact::Overlap).ok_or(format!("{found:?}"))?;
        let off = (overlap.first[0] - p / q).abs().max((overlap.second[1] - (q - p) / (1.0 - p)).abs());
        if off < 1e-6 { Ok(()) } else { Err(format!("{found:?} is off by {off}")) }
    });
}

#[test]
fn parts_that_run_against_one_another() {
    campaign("reversed parts", |random| {
        let whole = random.curve(3);
        let (p, q) = random.cuts();
        let (a, b) = (whole.subcurve(0.0, q).unwrap(), whole.subcurve(1.0, p).unwrap());
        let found = intersect(&a, &b, None).unwrap();
        overlap_is(&found, [&a, &b], [p / q, 1.0], [1.0, (1.0 - q) / (1.0 - p)])
    });
}

#[test]
fn a_part_within_the_whole() {
    campaign("a part within the whole", |random| {
        let whole = random.curve(3);
        let (p, q) = random.cuts();
        let part = whole.subcurve(p, q).unwrap();
        let found = intersect(&whole, &part, None).unwrap();
        overlap_is(&found, [&whole, &part], [p, q], [0.0, 1.0])?;
        let found = intersect(&part, &whole, None).unwrap();
        overlap_is(&found, [&part, &whole], [0.0, 1.0], [p, q])
    });
}

#[test]
fn parts_of_other_degrees() {
    campaign("parts of degrees 2 to 5, elevated", |random| {
        let degree = 2 + (random.unit() * 4.0) as usize;
        let whole = random.curve(degree);
        let (p, q) = random.cuts();
        let a = whole.subcurve(0.0, q).unwrap().elevated((random.unit() * 3.0) as usize);
        let b = whole.subcurve(p, 1.0).unwrap().elevated((random.unit() * 3.0) as usize);
        let found = intersect(&a, &b, None).unwrap();
        overlap_is(&found, [&a, &b], [p / q, 1.0], [0.0, (q - p) / (1.0 - p)])
    });
}

#[test]
fn parts_of_a_high_degree() {
    campaign("parts of degree 12", |random| {
        let whole = random.curve(12);
        let (p, q) = random.cuts();
        let (a, b) = (whole.subcurve(0.0, q).unwrap(), whole.subcurve(p, 1.0).unwrap());
        let found = intersect(&a, &b, None).map_err(|error| error.to_string())?;
        overlap_is(&found, [&a, &b], [p / q, 1.0], [0.0, (q - p) / (1.0 - p)])
    });
}

#[test]
fn one_unit_in_the_last_place() {
    let arch = [(0.0, 0.0), (30.0, 60.0), (70.0, 60.0), (100.0, 0.0)].map(Vec2::from);
    for k in 0..4 {
        let mut moved = arch;
        moved[k] = Vec2::new(moved[k].x.next_up(), moved[k].y.next_down());
        let (a, b) = (Cubic::new(arch).unwrap(), Cubic::new(moved).unwrap());
        let found = intersect(&a, &b, None).unwrap();
        assert!(found.len() == 1 && found[0].contact == Contact::Overlap, "{found:?}");
        assert_eq!((found[0].first, found[0].second), ([0.0, 1.0], [0.0, 1.0]));
    }
    // A millionth of a millionth of the size is no rounding.
    let (a, b) =
        (Cubic::new(arch).unwrap(), Cubic::new(arch).unwrap().map(|p| p + Vec2::new(0.0, 1e-10)).unwrap());
    let found = intersect(&a, &b, None).unwrap();
    assert!(found.iter().all(|m| m.contact != Contact::Overlap), "{found:?}");
}

#[test]
fn lines_in_straight_curves() {
    campaign("a line and a straight cubic", |random| {
        let angle = random.between(0.0, 6.0);
        let (x, y) = (random.between(0.0, 3.0), random.between(4.0, 8.0));
        // It runs on, at a changing speed.
        let cubic = turned(&[(0.0, 0.0), (x, 0.0), (y, 0.0), (10.0, 0.0)], angle);
        let line = turned(&[(-3.0, 0.0), (7.0, 0.0)], angle);
        let found = intersect(&cubic, &line, None).unwrap();
        let overlap = found.iter().find(|m| m.contact == Contact::Overlap).ok_or(format!("{found:?}"))?;
        let end = cubic.eval(overlap.first[1]);
        let right = found.len() == 1
            && overlap.first[0] == 0.0
            && (overlap.second[0] - 0.3).abs() < 1e-13
            && (overlap.second[1] - 1.0).abs() < 1e-13
            && (end - line.end()).length() < 1e-13;
        if right { Ok(()) } else { Err(format!("{found:?}")) }?;
        let (from, to) = (line.start(), line.eval(0.3));
        let on = intersect_line(&cubic, from, to, None).unwrap();
        if on.len() == 1 && on[0].contact == Contact::Overlap { Ok(()) } else { Err(format!("{on:?}")) }
    });
}

#[test]
fn lines_that_meet_at_ends_do_not_overlap() {
    campaign("lines end to end", |random| {
        let angle = random.between(0.0, 6.0);
        let [a, b] = [[(0.0, 0.0), (1.0, 0.0)], [(1.0, 0.0), (3.0, 0.0)]].map(|line| turned(&line, angle));
        let found = intersect(&a, &b, None).unwrap();
        let right = found.len() == 1 && found[0].contact != Contact::Overlap && found[0].first[0] == 1.0;
        if right { Ok(()) } else { Err(format!("{found:?}")) }
    });
}

#[test]
fn straight_curves_that_run_back() {
    campaign("a cubic back and forth", |random| {
        let angle = random.between(0.0, 6.0);
        let back = turned(&[(0.0, 0.0), (200.0, 0.0), (-100.0, 0.0), (100.0, 0.0)], angle);
        let found = self_intersections(&back).unwrap();
        // Three pieces between the ends and two turns, each over the next: the first over the last is behind the turns.
        let turns = [0.27639320225002106, 0.7236067977499789];
        let overlaps = found.iter().filter(|m| m.contact == Contact::Overlap).count();
        let at_turns = found.iter().all(|m| {
            let near = |x: f64| turns.iter().any(|turn| (x - turn).abs() < 1e-7);
            [m.first[0], m.first[1], m.second[0], m.second[1]].into_iter().any(near)
        });
        let same = |m: &Meeting, k: usize| (back.eval(m.first[k]) - back.eval(m.second[k])).length() < 1e-11;
        let right = overlaps == found.len() && overlaps == 3 && at_turns;
        if right && found.iter().all(|m| same(m, 0) && same(m, 1)) {
            Ok(())
        } else {
            Err(format!("{found:?}"))
        }
    });
}

#[test]
fn curves_that_retrace_themselves() {
    campaign("a bent curve back over itself", |random| {
        // C(t (1 - t)) at the fold 1/2, then a part of it around the fold.
        let degree = 2 + (random.unit() * 2.0) as usize;
        let proper = random.curve(degree);
        let inner = AnyBezier::new(vec![0.0, 0.5, 0.0]).unwrap();
        let count = 2 * degree;
        let doubled =
            through((0..=count).map(|k| proper.eval(inner.eval(k as f64 / count as f64))).collect());
        let found = self_intersections(&doubled).unwrap();
        let right = found.len() == 1
            && found[0].contact == Contact::Overlap
            && found[0].first[0] == 0.0
            && (found[0].first[1] - 0.5).abs() < 1e-6
            && found[0].second[0] == 1.0;
        if right { Ok(()) } else { Err(format!("{found:?}")) }?;
        let part = doubled.subcurve(0.0, 0.8).unwrap();
        let found = self_intersections(&part).unwrap();
        let (from, turn) = (0.25, 0.625);
        let right = found.len() == 1
            && found[0].contact == Contact::Overlap
            && (found[0].first[0] - from).abs() < 1e-9
            && (found[0].first[1] - turn).abs() < 1e-6
            && found[0].second[0] == 1.0;
        if right { Ok(()) } else { Err(format!("{found:?}")) }
    });
}

/// The curve of degree n through n + 1 points at even parameters, by divided differences and then Bernstein form.
fn through(mut values: Vec<Vec2>) -> AnyBezier<Vec2> {
    let n = values.len() - 1;
    for order in 1..=n {
        for i in (order..=n).rev() {
            values[i] = (values[i] - values[i - 1]) * (n as f64 / order as f64);
        }
    }
    // Newton's form from the inside: p <- c + (t - t_k) p, in Bernstein form.
    let mut row = vec![values[n]];
    for k in (0..n).rev() {
        let (knot, m) = (k as f64 / n as f64, row.len());
        row = (0..=m)
            .map(|i| {
                let (up, down) = (i as f64 / m as f64, 1.0 - i as f64 / m as f64);
                let before = if i > 0 { row[i - 1] * (up * (1.0 - knot)) } else { Vec2::ZERO };
                let same = if i < m { row[i] * (down * -knot) } else { Vec2::ZERO };
                values[k] + before + same
            })
            .collect();
    }
    AnyBezier::new(row).unwrap()
}
