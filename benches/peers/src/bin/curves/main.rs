//! Curves through ogee and its peers, in one run: evaluation, flattening, length, nearest point, intersection.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

mod evaluation;
mod finding;
mod measuring;
mod python;
#[allow(dead_code, reason = "shared with the tests")]
#[path = "../../../../../tests/roots/mod.rs"]
mod roots;

use clap::Parser;
use cpu_time::ProcessTime;
use ogee::curve::Cubic;
use ogee::math::Vec2;
use std::path::PathBuf;

#[derive(Parser)]
#[command(about = "The same curves through ogee and its peers, in one run")]
struct Options {
    /// Only cases whose name has this in it.
    #[arg(long, default_value = "")]
    case: String,
    /// Rounds for each side, in turn; the best one counts.
    #[arg(long, default_value_t = 15)]
    rounds: usize,
    /// A Python that has `bezier` (and numpy); without it there are no rows of it.
    #[arg(long)]
    python: Option<PathBuf>,
}

/// One side of a case: a name, the work whose time counts, and its error, measured apart.
struct Side<'a> {
    name: &'static str,
    work: Box<dyn FnMut() + 'a>,
    error: f64,
}

impl<'a> Side<'a> {
    fn new(name: &'static str, error: f64, work: impl FnMut() + 'a) -> Side<'a> {
        Side { name, work: Box::new(work), error }
    }
}

/// What cases are run and how often.
struct Runner {
    options: Options,
}

impl Runner {
    fn wants(&self, case: &str) -> bool {
        case.contains(&self.options.case)
    }

    /// Times the sides in turn, ours first, and prints a row a peer; each work does `count` things.
    fn compare(&self, case: &str, error_of: &str, count: usize, mut sides: Vec<Side<'_>>) {
        let mut best = vec![f64::INFINITY; sides.len()];
        for _ in 0..self.options.rounds {
            for (side, best) in sides.iter_mut().zip(&mut best) {
                let start = ProcessTime::now();
                (side.work)();
                *best = best.min(start.elapsed().as_secs_f64() * 1e9 / count as f64);
            }
        }
        let ours = (best[0], sides[0].error);
        for (side, peer) in sides.iter().zip(&best).skip(1) {
            row(case, side.name, error_of, ours, (*peer, side.error));
        }
    }
}

/// Nanoseconds and error of both sides as a row.
fn row(case: &str, peer: &str, error_of: &str, ours: (f64, f64), theirs: (f64, f64)) {
    let ratio = ours.0 / theirs.0;
    println!(
        "{case},{peer},{:.2},{:.2},{ratio:.3},{:.2e},{:.2e},{error_of}",
        ours.0, theirs.0, ours.1, theirs.1
    );
}

/// A generator of numbers (Steele, Lea, Flood, SplitMix64, 2014).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self) -> Vec2 {
        Vec2::new(100.0 * self.unit(), 100.0 * self.unit())
    }

    fn cubic(&mut self) -> Cubic<Vec2> {
        cubic([(); 4].map(|()| self.point()))
    }
}

fn cubic(points: [Vec2; 4]) -> Cubic<Vec2> {
    Cubic::new(points).expect("finite")
}

fn kurbo_cubic(curve: &Cubic<Vec2>) -> kurbo::CubicBez {
    let [a, b, c, d] = curve.to_array().map(|p| kurbo::Point::new(p.x, p.y));
    kurbo::CubicBez::new(a, b, c, d)
}

fn lyon_cubic(curve: &Cubic<Vec2>) -> lyon_geom::CubicBezierSegment<f64> {
    let [from, ctrl1, ctrl2, to] = curve.to_array().map(|p| lyon_geom::point(p.x, p.y));
    lyon_geom::CubicBezierSegment { from, ctrl1, ctrl2, to }
}

fn flo_cubic(curve: &Cubic<Vec2>) -> flo_curves::bezier::Curve<flo_curves::Coord2> {
    use flo_curves::BezierCurveFactory;
    let [a, b, c, d] = curve.to_array().map(|p| flo_curves::Coord2(p.x, p.y));
    flo_curves::bezier::Curve::from_points(a, (b, c), d)
}

fn main() {
    let runner = Runner { options: Options::parse() };
    println!("case,peer,ours ns,peer ns,ratio,ours error,peer error,error of");
    evaluation::cubics(&runner);
    evaluation::high_degrees(&runner);
    measuring::flattening(&runner);
    measuring::lengths(&runner);
    finding::nearest_points(&runner);
    finding::intersections(&runner);
}
