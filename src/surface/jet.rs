use super::Surface;
use crate::math::Vec3;

/// A point of a surface with its first and second derivatives by the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// The point.
    pub point: Vec3,
    /// Derivative by u.
    pub du: Vec3,
    /// Derivative by v.
    pub dv: Vec3,
    /// Second derivative by u.
    pub duu: Vec3,
    /// Mixed second derivative.
    pub duv: Vec3,
    /// Second derivative by v.
    pub dvv: Vec3,
}

/// How a surface bends at a point, against its normal: a sphere of radius r with outward normal has the principal
/// curvatures -1/r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// The product of the principal curvatures.
    pub gauss: f64,
    /// Their mean.
    pub mean: f64,
    /// The principal curvatures, the larger one first.
    pub principal: [f64; 2],
    /// Unit directions of the principal curvatures, at right angles; at an umbilic any two.
    pub directions: [Vec3; 2],
}

impl Jet {
    /// The unit normal, `None` where the derivatives are parallel or vanish.
    pub fn normal(&self) -> Option<Vec3> {
        unit_cross(self.du, self.dv)
    }

    /// The first fundamental form: E, F, G.
    pub fn first_form(&self) -> [f64; 3] {
        [self.du.length_squared(), self.du.dot(self.dv), self.dv.length_squared()]
    }

    /// The second fundamental form: L, M, N; `None` where there is no normal.
    pub fn second_form(&self) -> Option<[f64; 3]> {
        let normal = self.normal()?;
        Some([self.duu, self.duv, self.dvv].map(|second| second.dot(normal)))
    }

    /// Gauss, mean and principal curvatures; `None` where there is no normal.
    pub fn curvature(&self) -> Option<Curvature> {
        let normal = self.normal()?;
        // In an orthonormal frame of the tangent plane the shape operator is symmetric.
        let first = self.du.try_normalize()?;
        let second = normal.cross(first);
        let [a, b, d] = [self.du.length(), self.dv.dot(first), self.dv.dot(second)];
        let [l, m, n] = [self.duu, self.duv, self.dvv].map(|derivative| derivative.dot(normal));
        // Derivatives along the frame: d_u / a, and (d_v - b d_u / a) / d.
        let ratio = b / a;
        let xx = l / a / a;
        let xy = (m - ratio * l) / a / d;
        let yy = (n - 2.0 * ratio * m + ratio * ratio * l) / d / d;
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let spread = crate::math::hypot(half, xy);
        let (cosine, sine) = principal_direction(half, xy, spread);
        let directions = [cosine * first + sine * second, cosine * second - sine * first];
        let principal = [mean + spread, mean - spread];
        Some(Curvature { gauss: xx * yy - xy * xy, mean, principal, directions })
    }
}

/// The eigenvector of [[half, xy], [xy, -half]] for `spread`, from the better conditioned of its rows.
fn principal_direction(half: f64, xy: f64, spread: f64) -> (f64, f64) {
    let (x, y) = if half >= 0.0 { (spread + half, xy) } else { (xy, spread - half) };
    let length = crate::math::hypot(x, y);
    if length > 0.0 { (x / length, y / length) } else { (1.0, 0.0) }
}

/// The unit vector along a cross product, of vectors of any size; `None` where they are parallel up to rounding.
pub(super) fn unit_cross(a: Vec3, b: Vec3) -> Option<Vec3> {
    let (a, b) = (scaled(a)?, scaled(b)?);
    let cross = a.cross(b);
    let length = cross.length();
    (length > 4.0 * f64::EPSILON).then(|| cross / length)
}

/// The vector brought to a largest component of 1.
fn scaled(v: Vec3) -> Option<Vec3> {
    let size = v.abs().max_element();
    (size > 0.0 && size.is_finite()).then(|| v / size)
}

/// The jet from points alone: central differences, moved inward at the borders of the domain.
pub(super) fn by_differences<S: Surface + ?Sized>(surface: &S, u: f64, v: f64) -> Jet {
    // The roots of the rounding unit that balance truncation and rounding of first and second differences.
    const FIRST: f64 = 6e-6;
    const SECOND: f64 = 3e-4;
    let domain = surface.domain();
    let point = surface.point(u, v);
    let stencil = |axis: usize, at: f64, share: f64| {
        let [low, high] = domain[axis];
        let step = share * (high - low);
        (at.clamp(low + step, high - step), step)
    };
    let first = |axis: usize| {
        let at = [u, v][axis];
        let (middle, h) = stencil(axis, at, FIRST);
        let along = |t: f64| if axis == 0 { surface.point(t, v) } else { surface.point(u, t) };
        let (before, between, after) = (along(middle - h), along(middle), along(middle + h));
        // The parabola through the three, differentiated where it is asked for.
        (after - before) / (2.0 * h) + (after - 2.0 * between + before) * ((at - middle) / (h * h))
    };
    let second = |axis: usize| {
        let (middle, h) = stencil(axis, [u, v][axis], SECOND);
        let along = |t: f64| if axis == 0 { surface.point(t, v) } else { surface.point(u, t) };
        (along(middle - h) - 2.0 * along(middle) + along(middle + h)) / (h * h)
    };
    let ((s, h), (t, k)) = (stencil(0, u, SECOND), stencil(1, v, SECOND));
    let twist = surface.point(s + h, t + k) - surface.point(s + h, t - k) - surface.point(s - h, t + k)
        + surface.point(s - h, t - k);
    Jet { point, du: first(0), dv: first(1), duu: second(0), duv: twist / (4.0 * h * k), dvv: second(1) }
}
