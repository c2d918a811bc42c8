use super::{Patch, Surface};
use crate::math::Vec3;

/// Parameters handled side by side, so that the loops below become vector instructions.
const LANES: usize = 8;
/// Up to this degree powers of the parameter are as good as Bernstein polynomials.
const MOST_POWERS: usize = 3;

/// See [`Patch::grid`].
pub(super) fn evaluate(patch: &Patch, us: &[f64], vs: &[f64]) -> (Vec<Vec3>, Vec<Vec3>) {
    let count = us.len() * vs.len();
    let (mut points, mut normals) = (vec![Vec3::ZERO; count], vec![Vec3::ZERO; count]);
    let Some(cubic) = as_cubic(patch) else {
        for (index, (point, normal)) in points.iter_mut().zip(&mut normals).enumerate() {
            let (u, v) = (us[index / vs.len()], vs[index % vs.len()]);
            *point = patch.eval(u, v);
            *normal = patch.normal(u, v).unwrap_or(Vec3::ZERO);
        }
        return (points, normals);
    };
    let rows = points.chunks_mut(vs.len().max(1)).zip(normals.chunks_mut(vs.len().max(1)));
    for (&u, (points, normals)) in us.iter().zip(rows) {
        let strip = Strip::new(&cubic, u);
        for ((vs, points), normals) in
            vs.chunks(LANES).zip(points.chunks_mut(LANES)).zip(normals.chunks_mut(LANES))
        {
            let unsure = strip.block(vs, points, normals);
            if unsure {
                mend(patch, u, vs, points, normals);
            }
        }
    }
    (points, normals)
}

/// The patch with both degrees 3, where powers of the parameters will do.
fn as_cubic(patch: &Patch) -> Option<Patch> {
    let [m, n] = patch.degrees();
    let size = super::net::size(patch.points());
    let fits = m <= MOST_POWERS && n <= MOST_POWERS && (1e-90..1e90).contains(&size);
    fits.then(|| patch.elevated([3 - m, 3 - n]).expect("degree 3 is allowed"))
}

/// Points at parameters in no order.
pub(super) fn scattered(patch: &Patch, parameters: &[[f64; 2]], out: &mut [Vec3]) {
    let Some(cubic) = as_cubic(patch).filter(|_| parameters.len() >= LANES) else {
        out.iter_mut().zip(parameters).for_each(|(place, &[u, v])| *place = patch.eval(u, v));
        return;
    };
    let coefficients = Powers::new(&cubic);
    for (parameters, out) in parameters.chunks(LANES).zip(out.chunks_mut(LANES)) {
        let [u, v] = lanes_of(parameters);
        let point = coefficients.points(&u, &v);
        for (lane, place) in out.iter_mut().enumerate() {
            *place = vector(&point, lane);
        }
    }
}

/// Points and derivatives by u and by v at parameters in no order.
pub(super) fn scattered_tangents(patch: &Patch, parameters: &[[f64; 2]], out: &mut [[Vec3; 3]]) {
    let Some(cubic) = as_cubic(patch).filter(|_| parameters.len() >= LANES) else {
        for (place, &[u, v]) in out.iter_mut().zip(parameters) {
            let jet = patch.jet(u, v);
            *place = [jet.point, jet.du, jet.dv];
        }
        return;
    };
    let coefficients = Powers::new(&cubic);
    for (parameters, out) in parameters.chunks(LANES).zip(out.chunks_mut(LANES)) {
        let [u, v] = lanes_of(parameters);
        let [point, du, dv] = coefficients.tangents(&u, &v);
        for (lane, place) in out.iter_mut().enumerate() {
            *place = [vector(&point, lane), vector(&du, lane), vector(&dv, lane)];
        }
    }
}

/// Parameters side by side, zeros after the last.
fn lanes_of(parameters: &[[f64; 2]]) -> [[f64; LANES]; 2] {
    let mut lanes = [[0.0; LANES]; 2];
    for (lane, at) in parameters.iter().enumerate() {
        (lanes[0][lane], lanes[1][lane]) = (at[0], at[1]);
    }
    lanes
}

fn vector(components: &[[f64; LANES]; 3], lane: usize) -> Vec3 {
    Vec3::new(components[0][lane], components[1][lane], components[2][lane])
}

/// A bicubic patch in powers of its parameters: `[axis][power of u][power of v]`.
struct Powers([[[f64; 4]; 4]; 3]);

impl Powers {
    fn new(cubic: &Patch) -> Powers {
        let row = |i: usize| powers(std::array::from_fn(|j| cubic.points()[4 * i + j]));
        let rows: [[[f64; 3]; 4]; 4] = std::array::from_fn(row);
        let mut all = [[[0.0; 4]; 4]; 3];
        for j in 0..4 {
            let column = powers(std::array::from_fn(|i| Vec3::from_array(rows[i][j])));
            for (i, coefficient) in column.into_iter().enumerate() {
                (0..3).for_each(|axis: usize| all[axis][i][j] = coefficient[axis]);
            }
        }
        Powers(all)
    }

    #[inline]
    fn points(&self, u: &[f64; LANES], v: &[f64; LANES]) -> [[f64; LANES]; 3] {
        let mut point = [[0.0; LANES]; 3];
        for (axis, point) in point.iter_mut().enumerate() {
            let c = &self.0[axis];
            for lane in 0..LANES {
                let (u, v) = (u[lane], v[lane]);
                let row = |i: usize| c[i][0] + v * (c[i][1] + v * (c[i][2] + v * c[i][3]));
                point[lane] = row(0) + u * (row(1) + u * (row(2) + u * row(3)));
            }
        }
        point
    }

    #[inline]
    fn tangents(&self, u: &[f64; LANES], v: &[f64; LANES]) -> [[[f64; LANES]; 3]; 3] {
        let [mut point, mut du, mut dv] = [[[0.0; LANES]; 3]; 3];
        for axis in 0..3 {
            let c = &self.0[axis];
            for lane in 0..LANES {
                let (u, v) = (u[lane], v[lane]);
                let row = |i: usize| c[i][0] + v * (c[i][1] + v * (c[i][2] + v * c[i][3]));
                let slope = |i: usize| c[i][1] + v * (2.0 * c[i][2] + v * (3.0 * c[i][3]));
                let rows = [row(0), row(1), row(2), row(3)];
                point[axis][lane] = rows[0] + u * (rows[1] + u * (rows[2] + u * rows[3]));
                du[axis][lane] = rows[1] + u * (2.0 * rows[2] + u * (3.0 * rows[3]));
                dv[axis][lane] = slope(0) + u * (slope(1) + u * (slope(2) + u * slope(3)));
            }
        }
        [point, du, dv]
    }
}

/// The curve of one u and its derivative by u, as polynomials in powers of v: `[power][axis]`.
struct Strip {
    point: [[f64; 3]; 4],
    du: [[f64; 3]; 4],
    /// Squares of cross products below this are mostly rounding.
    least: f64,
}

impl Strip {
    fn new(cubic: &Patch, u: f64) -> Strip {
        let columns: [[Vec3; 4]; 4] =
            std::array::from_fn(|j| std::array::from_fn(|i| cubic.points()[4 * i + j]));
        let s = 1.0 - u;
        // The cubic and its derivative from the same two quadratics.
        let along = columns.map(|[a, b, c, d]| {
            let quadratic = |p: Vec3, q: Vec3, r: Vec3| s * s * p + 2.0 * u * s * q + u * u * r;
            let (low, high) = (quadratic(a, b, c), quadratic(b, c, d));
            (s * low + u * high, 3.0 * (high - low))
        });
        let point = powers(along.map(|(point, _)| point));
        let du = powers(along.map(|(_, du)| du));
        let size = |rows: &[[f64; 3]; 4]| rows.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let rounding = 1e-10 * size(&du).max(f64::MIN_POSITIVE) * size(&point);
        Strip { point, du, least: rounding * rounding }
    }

    /// Up to [`LANES`] points and normals; returns whether some normal must be found another way.
    #[inline]
    fn block(&self, vs: &[f64], points: &mut [Vec3], normals: &mut [Vec3]) -> bool {
        let mut v = [0.0; LANES];
        v[..vs.len()].copy_from_slice(vs);
        let (mut point, mut du, mut dv) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        for axis in 0..3 {
            let [p, d] = [&self.point, &self.du].map(|rows| [0, 1, 2, 3].map(|power| rows[power][axis]));
            for lane in 0..LANES {
                let v = v[lane];
                point[axis][lane] = p[0] + v * (p[1] + v * (p[2] + v * p[3]));
                du[axis][lane] = d[0] + v * (d[1] + v * (d[2] + v * d[3]));
                dv[axis][lane] = p[1] + v * (2.0 * p[2] + v * (3.0 * p[3]));
            }
        }
        let mut cross = [[0.0; LANES]; 3];
        for (axis, cross) in cross.iter_mut().enumerate() {
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            for lane in 0..LANES {
                cross[lane] = du[b][lane] * dv[c][lane] - du[c][lane] * dv[b][lane];
            }
        }
        let mut square = [0.0; LANES];
        let mut scale = [0.0; LANES];
        for lane in 0..LANES {
            let [x, y, z] = [cross[0][lane], cross[1][lane], cross[2][lane]];
            square[lane] = x * x + y * y + z * z;
            scale[lane] = 1.0 / square[lane].sqrt();
        }
        for (lane, (place, normal)) in points.iter_mut().zip(normals).enumerate() {
            *place = Vec3::new(point[0][lane], point[1][lane], point[2][lane]);
            *normal = Vec3::new(cross[0][lane], cross[1][lane], cross[2][lane]) * scale[lane];
        }
        !square[..vs.len()].iter().all(|&square| square > self.least)
    }
}

/// Coefficients of the powers of the parameter.
fn powers([a, b, c, d]: [Vec3; 4]) -> [[f64; 3]; 4] {
    let second = (c - b) - (b - a);
    [a, 3.0 * (b - a), 3.0 * second, ((d - c) - (c - b)) - second].map(|v| v.to_array())
}

/// Normals one by one.
fn mend(patch: &Patch, u: f64, vs: &[f64], points: &mut [Vec3], normals: &mut [Vec3]) {
    for ((&v, point), normal) in vs.iter().zip(points).zip(normals) {
        *point = patch.eval(u, v);
        *normal = patch.normal(u, v).unwrap_or(Vec3::ZERO);
    }
}
