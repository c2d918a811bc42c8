//! Fits, simplified paths, offsets and strokes through kurbo and ogee, in one run. See README.md.

#[allow(dead_code, reason = "shared with the tests")]
#[path = "../../../../tests/measure/mod.rs"]
mod measure;

use kurbo::{CurveFitSample, ParamCurveFit, Shape};
use measure::{between, cusps, samples, two_sided};
use ogee::curve::{
    Bernstein, Cubic, Join, Path, Piece, Ray, Side, Source, Spline, Stroke, Subpath, fit, nearest, offset,
    simplify, stroke,
};
use ogee::math::{Vec2, cos, sin};
use std::hint::black_box;
use std::ops::Range;
use std::time::Instant;

fn main() {
    println!("what,side,tolerance,curves,pieces,median_error_share,worst_error_share,beyond,microseconds");
    for tolerance in [1e-2, 1e-4, 1e-6] {
        fits(tolerance);
        simplified(tolerance);
        offsets(tolerance, false);
        offsets(tolerance, true);
    }
    strokes(1e-2);
    strokes(1e-4);
}

/// What one side did with all curves.
#[derive(Default)]
struct Tally {
    pieces: usize,
    /// Measured errors over the tolerance.
    shares: Vec<f64>,
    microseconds: f64,
}

impl Tally {
    fn add(&mut self, pieces: usize, share: f64, microseconds: f64) {
        self.pieces += pieces;
        self.shares.push(share);
        self.microseconds += microseconds;
    }

    fn print(mut self, what: &str, side: &str, tolerance: f64) {
        self.shares.sort_by(f64::total_cmp);
        let (count, beyond) = (self.shares.len(), self.shares.iter().filter(|&&share| share > 1.0).count());
        println!(
            "{what},{side},{tolerance:e},{count},{:.1},{:.2},{:.3e},{beyond},{:.1}",
            self.pieces as f64 / count as f64,
            self.shares[count / 2],
            self.shares[count - 1],
            self.microseconds / count as f64
        );
    }
}

/// The result and the microseconds that a call takes: the least of five rounds of a few calls each.
fn timed<T>(call: impl Fn() -> T) -> (T, f64) {
    let once = Instant::now();
    let result = call();
    let calls = (2e-3 / once.elapsed().as_secs_f64()).clamp(1.0, 1000.0) as usize;
    let round = || {
        let start = Instant::now();
        (0..calls).for_each(|_| drop(black_box(call())));
        start.elapsed().as_secs_f64() * 1e6 / calls as f64
    };
    (result, (0..5).map(|_| round()).fold(f64::INFINITY, f64::min))
}

fn point(p: Vec2) -> kurbo::Point {
    kurbo::Point::new(p.x, p.y)
}

fn vector(p: kurbo::Point) -> Vec2 {
    Vec2::new(p.x, p.y)
}

fn cubics(path: &kurbo::BezPath) -> Vec<Piece> {
    let cubic = |segment: kurbo::PathSeg| {
        let c = segment.to_cubic();
        Cubic::new([c.p0, c.p1, c.p2, c.p3].map(vector)).map(Piece::from)
    };
    path.segments().filter_map(|segment| cubic(segment).ok()).collect()
}

fn pieces(path: &Path) -> Vec<Piece> {
    path.pieces().cloned().collect()
}

/// Some oscillations that grow faster.
struct Chirp;

impl Chirp {
    fn at(t: f64) -> [f64; 2] {
        let phase = 2.0 * t + t * t;
        [sin(phase), (2.0 + 2.0 * t) * cos(phase)]
    }

    const END: f64 = 4.0;
}

impl Source for Chirp {
    fn domain(&self) -> [f64; 2] {
        [0.0, Chirp::END]
    }

    fn ray(&self, t: f64, _: Side) -> Ray {
        let [y, slope] = Chirp::at(t);
        let speed = (1.0 + slope * slope).sqrt();
        Ray { point: Vec2::new(t, y), tangent: Vec2::new(1.0, slope) / speed, speed }
    }

    /// The fourth derivative of sin p, p' = 2 + 2 t, p'' = 2 is at most p'^4 + 6 p'^2 p'' + 3 p''^2.
    fn deviation(&self, from: f64, to: f64, cubic: &Cubic<Vec2>) -> f64 {
        let fast = 2.0 + 2.0 * to;
        let fourth = fast.powi(4) + 12.0 * fast * fast + 12.0;
        let [a, b, c, d] = cubic.to_array().map(|p| p.x);
        let third = (to - from) / 3.0;
        let off = [a - from, b - from - third, c - to + third, d - to];
        (to - from).powi(4) / 384.0 * fourth + 2.0 * off.iter().fold(0.0_f64, |m, x| m.max(x.abs())) + 1e-14
    }
}

impl ParamCurveFit for Chirp {
    fn sample_pt_tangent(&self, t: f64, _: f64) -> CurveFitSample {
        let (p, tangent) = self.sample_pt_deriv(t);
        CurveFitSample { p, tangent }
    }

    fn sample_pt_deriv(&self, t: f64) -> (kurbo::Point, kurbo::Vec2) {
        let [y, slope] = Chirp::at(Chirp::END * t);
        (kurbo::Point::new(Chirp::END * t, y), kurbo::Vec2::new(Chirp::END, Chirp::END * slope))
    }

    fn break_cusp(&self, _: Range<f64>) -> Option<f64> {
        None
    }
}

fn measure_chirp(drawn: &[Piece]) -> f64 {
    let meant = |t: f64| Vec2::new(Chirp::END * t, Chirp::at(Chirp::END * t)[0]);
    let truth = samples(&meant, &[1.0], |_, [a, b]| a.distance(b) > 0.01);
    between(&meant, &truth, drawn, 0.01, 1000)
}

fn spline_pieces(spline: &Spline<Vec2>) -> Vec<Piece> {
    spline.pieces().map(Piece::from).collect()
}

fn fits(tolerance: f64) {
    let ours = timed(|| fit(&Chirp, tolerance).unwrap());
    let theirs = timed(|| kurbo::fit_to_bezpath(&Chirp, tolerance));
    let best = timed(|| kurbo::fit_to_bezpath_opt(&Chirp, tolerance));
    let print = |side: &str, drawn: Vec<Piece>, time: f64| {
        let mut tally = Tally::default();
        tally.add(drawn.len(), measure_chirp(&drawn) / tolerance, time);
        tally.print("fit", side, tolerance);
    };
    print("ogee", spline_pieces(&ours.0.curve), ours.1);
    print("kurbo", cubics(&theirs.0), theirs.1);
    print("kurbo opt", cubics(&best.0), best.1);
}

fn simplified(tolerance: f64) {
    let fine = fit(&Chirp, 1e-9).unwrap().curve;
    let pieces_of_it = spline_pieces(&fine);
    let theirs_in = bez(&pieces_of_it);
    let path = Path { subpaths: vec![Subpath::open(pieces_of_it).unwrap()] };
    let options = kurbo::simplify::SimplifyOptions::default().angle_thresh(1e-3);
    let ours = timed(|| simplify(&path, tolerance, 1e-3).unwrap());
    let theirs = timed(|| kurbo::simplify::simplify_bezpath(theirs_in.iter(), tolerance, &options));
    for (side, drawn, time) in
        [("ogee", pieces(&ours.0.curve), ours.1), ("kurbo", cubics(&theirs.0), theirs.1)]
    {
        let mut tally = Tally::default();
        tally.add(drawn.len(), measure_chirp(&drawn) / tolerance, time);
        tally.print("simplify", side, tolerance);
    }
}

fn bez(pieces: &[Piece]) -> kurbo::BezPath {
    let mut path = kurbo::BezPath::new();
    for (index, piece) in pieces.iter().enumerate() {
        if index == 0 {
            path.move_to(point(piece.start()));
        }
        match piece {
            Piece::Cubic(cubic) => {
                let [_, b, c, d] = cubic.to_array().map(point);
                path.curve_to(b, c, d);
            }
            _ => path.line_to(point(piece.end())),
        }
    }
    path
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn cubic(&mut self) -> Cubic<Vec2> {
        Cubic::new([(); 4].map(|()| Vec2::new(self.unit(), self.unit()))).unwrap()
    }
}

fn as_kurbo(cubic: &Cubic<Vec2>) -> kurbo::CubicBez {
    let [a, b, c, d] = cubic.to_array().map(point);
    kurbo::CubicBez::new(a, b, c, d)
}

/// Random cubics whose parallels at 0.05 have cusps, or whose have none.
fn offsets(tolerance: f64, with_cusps: bool) {
    let distance = 0.05;
    let mut random = Random(3);
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    while ours.shares.len() < 100 {
        let cubic = random.cubic();
        let piece = Piece::from(cubic.clone());
        if cusps(&piece, distance).is_empty() == with_cusps {
            continue;
        }
        let path = Path { subpaths: vec![Subpath::open(vec![piece.clone()]).unwrap()] };
        let (mine, time) = timed(|| offset(&path, distance, Join::Round, tolerance).unwrap());
        let mine = pieces(&mine.curve);
        ours.add(mine.len(), two_sided(&piece, distance, &mine, 200) / tolerance, time);
        let base = as_kurbo(&cubic);
        let (other, time) = timed(|| {
            let mut path = kurbo::BezPath::new();
            kurbo::offset::offset_cubic(base, distance, tolerance, &mut path);
            path
        });
        let other = cubics(&other);
        theirs.add(other.len(), two_sided(&piece, distance, &other, 200) / tolerance, time);
    }
    let what = if with_cusps { "offset with cusps" } else { "offset" };
    ours.print(what, "ogee", tolerance);
    theirs.print(what, "kurbo", tolerance);
}

/// Random cubics with round joins and caps; the share of points, farther than the tolerance from the true outline, that
/// are on the wrong side by the nonzero rule stands in the columns of errors.
fn strokes(tolerance: f64) {
    let mut random = Random(4);
    let (mut ours, mut theirs) = (Tally::default(), Tally::default());
    for _ in 0..100 {
        let cubic = random.cubic();
        let width = 0.02 + 0.4 * random.unit();
        let path = Path { subpaths: vec![Subpath::open(vec![Piece::from(cubic.clone())]).unwrap()] };
        let base = bez(&[Piece::from(cubic.clone())]);
        let style = kurbo::Stroke::new(width).with_caps(kurbo::Cap::Round).with_join(kurbo::Join::Round);
        let options = kurbo::StrokeOpts::default();
        let (mine, time) = timed(|| stroke(&path, &Stroke::round(width), tolerance).unwrap());
        let outline: Vec<kurbo::BezPath> =
            mine.curve.subpaths.iter().map(|subpath| bez(subpath.pieces())).collect();
        let spots: Vec<(Vec2, f64)> = (0..2000)
            .map(|_| Vec2::new(2.0 * random.unit() - 0.5, 2.0 * random.unit() - 0.5))
            .map(|spot| (spot, nearest(&cubic, spot).unwrap().distance.value - 0.5 * width))
            .filter(|(_, beyond)| beyond.abs() > tolerance)
            .collect();
        let wrong = |winding: &dyn Fn(kurbo::Point) -> i32| {
            let is_wrong = |&&(spot, beyond): &&(Vec2, f64)| (winding(point(spot)) != 0) != (beyond < 0.0);
            spots.iter().filter(is_wrong).count() as f64 / spots.len() as f64
        };
        let count = mine.curve.pieces().count();
        ours.add(count, wrong(&|p| outline.iter().map(|path| path.winding(p)).sum()), time);
        let (other, time) = timed(|| kurbo::stroke(base.iter(), &style, &options, tolerance));
        theirs.add(other.segments().count(), wrong(&|p| other.winding(p)), time);
    }
    for (side, tally) in [("ogee", ours), ("kurbo", theirs)] {
        let wrong = tally.shares.iter().filter(|&&share| share > 0.0).count();
        tally.print("stroke", side, tolerance);
        println!("# {side}: {wrong} of 100 strokes cover a wrong point");
    }
}
