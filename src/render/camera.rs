use super::RenderError;
use crate::math::{Mat3, Vec3, power_of_two_below, tan};
use crate::mesh::Mesh;
use std::f64::consts::PI;

/// Where a picture is taken from. Right is right and up is up: z up in the model is up in the picture unless `up` says
/// otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the camera stands, in model units.
    pub eye: Vec3,
    /// What it looks at: the middle of the picture.
    pub target: Vec3,
    /// What is up in the picture, of any length. One that is within a millionth of the direction of sight is replaced
    /// by the y axis, or where that is too, by the z axis.
    pub up: Vec3,
    /// How depth becomes size.
    pub projection: Projection,
}

/// How depth becomes size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// What is twice as far is half as large. What is nearer to the eye than a thousandth of the distance to the
    /// target is cut off.
    Perspective {
        /// Angle of sight from the bottom to the top of the picture, in radians, between 0 and π.
        field_of_view: f64,
    },
    /// Depth does not matter, and nothing is behind the camera.
    Orthographic {
        /// Height of what the picture shows, in model units.
        height: f64,
    },
}

/// How [`Camera::fitted`] frames a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Direction from the mesh to the camera, of any length but zero.
    pub from: Vec3,
    /// Width of the picture divided by its height.
    pub aspect: f64,
    /// Share of the picture left free at each side that binds, below one half.
    pub margin: f64,
    /// Whether the projection is orthographic instead of perspective.
    pub orthographic: bool,
}

impl Default for Fit {
    fn default() -> Fit {
        Fit { from: Vec3::new(0.56, -1.0, 0.70), aspect: 4.0 / 3.0, margin: 0.08, orthographic: false }
    }
}

/// At the origin, looking along the y axis.
impl Default for Camera {
    fn default() -> Camera {
        let projection = Projection::Perspective { field_of_view: Camera::FIELD_OF_VIEW };
        Camera { eye: Vec3::ZERO, target: Vec3::Y, up: Vec3::Z, projection }
    }
}

impl Camera {
    /// Field of view where nothing else is said, in radians: that of a long lens, 22.5 degrees.
    pub const FIELD_OF_VIEW: f64 = PI / 8.0;

    /// The camera in direction `fit.from` that shows all triangles of `mesh` as large as the margin allows, with the z
    /// axis up. The mesh reaches the margin on two opposite sides of the picture; from the planes of sight through the
    /// other two it keeps equal distances.
    pub fn fitted(mesh: &Mesh, fit: &Fit) -> Camera {
        let corners = || mesh.triangles.iter().flatten().filter_map(|&v| mesh.positions.get(v as usize));
        let bounds = crate::math::Aabb::of(corners().copied());
        let center = if bounds.is_empty() { Vec3::ZERO } else { bounds.center() };
        let unit = power_of_two_below((bounds.size() * 0.5).max_element());
        let unit = if unit > 0.0 { unit } else { 1.0 };
        let axes = axes(-fit.from / fit.from.abs().max_element(), Vec3::Z);
        let points = || corners().map(|&p| axes * ((p - center) / unit));
        let slope = tan(0.5 * Self::FIELD_OF_VIEW) * (1.0 - 2.0 * fit.margin);
        // Least of depth times slope plus or minus the coordinate: how far the eye may go before a side cuts.
        let room = |slope: f64, axis: Vec3| {
            points().map(|p| p.z * slope - p.dot(axis)).fold(f64::INFINITY, f64::min)
        };
        let along = |slope: f64, axis: Vec3| {
            let (a, b) = (room(slope, axis), room(slope, -axis));
            if a.is_finite() && b.is_finite() { (0.5 * (b - a), 0.5 * (a + b)) } else { (0.0, -1.0) }
        };
        let place = |x: f64, y: f64, z: f64| center + axes.transpose() * Vec3::new(x, y, z) * unit;
        if fit.orthographic {
            let ((x, wide), (y, high)) = (along(0.0, Vec3::X), along(0.0, Vec3::Y));
            let half = (-wide / fit.aspect).max(-high).max(f64::MIN_POSITIVE) / (1.0 - 2.0 * fit.margin);
            let back = half / slope;
            let projection = Projection::Orthographic { height: 2.0 * half * unit };
            return Camera { eye: place(x, y, -back), target: place(x, y, 0.0), up: Vec3::Z, projection };
        }
        let ((x, wide), (y, high)) = (along(slope * fit.aspect, Vec3::X), along(slope, Vec3::Y));
        let back = (wide / (slope * fit.aspect)).min(high / slope).min(-1e-3);
        Camera { eye: place(x, y, back), target: place(x, y, 0.0), ..Camera::default() }
    }

    /// A perspective camera that stands `distance` away from `target`: above it looking down with y up, then turned
    /// about the x, the y and the z axis by the angles of `rotation`, in radians.
    pub fn gimbal(target: Vec3, rotation: Vec3, distance: f64) -> Camera {
        let turn = about_z(rotation.z) * about_y(rotation.y) * about_x(rotation.x);
        let eye = target + turn * Vec3::new(0.0, 0.0, distance);
        Camera { eye, target, up: turn * Vec3::Y, ..Camera::default() }
    }

    /// The orthographic camera that shows what is as far as the target in the same size; itself where it is one.
    pub fn to_orthographic(self) -> Camera {
        let Projection::Perspective { field_of_view } = self.projection else { return self };
        let height = 2.0 * tan(0.5 * field_of_view) * (self.target - self.eye).length();
        Camera { projection: Projection::Orthographic { height }, ..self }
    }
}

fn about_x(angle: f64) -> Mat3 {
    let (s, c) = crate::math::sin_cos(angle);
    Mat3::from_cols(Vec3::X, Vec3::new(0.0, c, s), Vec3::new(0.0, -s, c))
}

fn about_y(angle: f64) -> Mat3 {
    let (s, c) = crate::math::sin_cos(angle);
    Mat3::from_cols(Vec3::new(c, 0.0, -s), Vec3::Y, Vec3::new(s, 0.0, c))
}

fn about_z(angle: f64) -> Mat3 {
    let (s, c) = crate::math::sin_cos(angle);
    Mat3::from_cols(Vec3::new(c, s, 0.0), Vec3::new(-s, c, 0.0), Vec3::Z)
}

/// The rotation from the model's axes to right, up and forward.
fn axes(forward: Vec3, up: Vec3) -> Mat3 {
    let forward = forward.normalize();
    let right = [up / up.abs().max_element(), Vec3::Y, Vec3::Z]
        .into_iter()
        .map(|up| forward.cross(up))
        .find(|right| right.length() > 1e-6)
        .unwrap_or(Vec3::X)
        .normalize();
    Mat3::from_cols(right, right.cross(forward), forward).transpose()
}

/// A point of the picture in fixed point, with the depth that rasterisation compares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScreenPoint {
    /// To the right, in units of 1 / [`SUBPIXELS`] pixels from the left border.
    pub(super) x: i32,
    /// Downward, likewise, from the upper border.
    pub(super) y: i32,
    /// Larger is nearer, and linear over the picture on every plane: 1 / depth in perspective, else -depth.
    pub(super) nearness: f64,
}

/// Steps of a pixel that corners of triangles are rounded to.
pub(super) const SUBPIXELS: i32 = 4096;

/// Pixels from the middle of the picture that corners may lie away; triangles beyond are clipped. Edge functions of
/// such corners fit in 64 bits: (2¹⁶ 2¹²)² times 2.
const GUARD: f64 = 32768.0;

/// A camera made ready: model to view to screen.
///
/// View coordinates are right, up and forward from the eye, in units in which the target is 1 to 4 away. They are
/// left-handed: cross products of outward facets point inward.
#[derive(Clone, Debug)]
pub(super) struct View {
    axes: Mat3,
    eye: Vec3,
    /// A power of two; view lengths are model lengths over twice this.
    unit: f64,
    /// Pixels per unit of slope (perspective) or of view length (orthographic).
    pub(super) zoom: f64,
    center: [f64; 2],
    /// The least depth that is seen, where there is one.
    near: Option<f64>,
}

impl View {
    pub(super) fn new(camera: &Camera, width: u32, height: u32) -> Result<View, RenderError> {
        let half = camera.target * 0.5 - camera.eye * 0.5;
        let unit = power_of_two_below(half.abs().max_element());
        let up_is_sound = camera.up.is_finite() && camera.up != Vec3::ZERO;
        if !camera.eye.is_finite() || !camera.target.is_finite() || unit == 0.0 || !up_is_sound {
            return Err(RenderError::BadCamera { camera: *camera });
        }
        let (zoom, near) = match camera.projection {
            Projection::Perspective { field_of_view } if field_of_view > 0.0 && field_of_view < PI => {
                let near = 1e-3 * (half / unit).length();
                (0.5 * f64::from(height) / tan(0.5 * field_of_view), Some(near))
            }
            Projection::Orthographic { height: shown } if shown > 0.0 => {
                (f64::from(height) / (0.5 * shown / unit), None)
            }
            _ => return Err(RenderError::BadCamera { camera: *camera }),
        };
        if !zoom.is_finite() || zoom == 0.0 {
            return Err(RenderError::BadCamera { camera: *camera });
        }
        let center = [0.5 * f64::from(width), 0.5 * f64::from(height)];
        Ok(View { axes: axes(half / unit, camera.up), eye: camera.eye, unit, zoom, center, near })
    }

    /// A view of this view's coordinates, straight up from below in a square picture of `size` pixels: the model's x
    /// runs to the right, its y upward. In the middle is `middle`, in the model's axes from the eye; the picture shows
    /// `width`.
    pub(super) fn beneath(&self, middle: Vec3, width: f64, size: u32) -> View {
        let center = [0.5 * f64::from(size); 2];
        let zoom = f64::from(size) / width;
        View { axes: self.axes.transpose(), eye: self.axes * middle, unit: 0.5, zoom, center, near: None }
    }

    /// A point or direction in view coordinates, in the model's axes.
    pub(super) fn upright(&self, p: Vec3) -> Vec3 {
        self.axes.transpose() * p
    }

    /// The point in view coordinates; not finite when it is too far away for an `f64`.
    pub(super) fn place(&self, p: Vec3) -> Vec3 {
        self.axes * ((p * 0.5 - self.eye * 0.5) / self.unit)
    }

    /// A direction of the model in view coordinates, of the same length.
    pub(super) fn turn(&self, direction: Vec3) -> Vec3 {
        self.axes * direction
    }

    /// Whether things grow smaller with distance.
    pub(super) fn is_perspective(&self) -> bool {
        self.near.is_some()
    }

    /// Where a point in view coordinates is in the picture; none when it has to be clipped first.
    pub(super) fn project(&self, p: Vec3) -> Option<ScreenPoint> {
        let seen = self.planes().into_iter().flatten().all(|plane| plane.distance(p) >= 0.0);
        seen.then(|| self.project_clipped(p))
    }

    /// Where a point that clipping has moved onto the border is; rounding is kept inside.
    pub(super) fn project_clipped(&self, p: Vec3) -> ScreenPoint {
        let (scale, nearness) =
            if self.is_perspective() { (self.zoom / p.z, 1.0 / p.z) } else { (self.zoom, -p.z) };
        let fixed = |middle: f64, offset: f64| {
            ((middle + offset.clamp(-GUARD, GUARD)) * f64::from(SUBPIXELS)).round() as i32
        };
        ScreenPoint {
            x: fixed(self.center[0], p.x * scale),
            y: fixed(self.center[1], -p.y * scale),
            nearness,
        }
    }

    /// What a point must be on the positive side of to be projected.
    pub(super) fn planes(&self) -> [Option<ClipPlane>; 5] {
        let reach = GUARD / self.zoom;
        let (slope, offset) = if self.is_perspective() { (reach, 0.0) } else { (0.0, reach) };
        let side = |x: f64, y: f64| Some(ClipPlane { normal: Vec3::new(x, y, slope), offset });
        let near = self.near.map(|near| ClipPlane { normal: Vec3::Z, offset: -near });
        [near, side(1.0, 0.0), side(-1.0, 0.0), side(0.0, 1.0), side(0.0, -1.0)]
    }

    /// The ray through a place of the picture, in pixels from the upper left corner: its origin and a direction that
    /// advances depth by one.
    pub(super) fn ray(&self, x: f64, y: f64) -> (Vec3, Vec3) {
        let (x, y) = ((x - self.center[0]) / self.zoom, (self.center[1] - y) / self.zoom);
        if self.is_perspective() {
            (Vec3::ZERO, Vec3::new(x, y, 1.0))
        } else {
            (Vec3::new(x, y, 0.0), Vec3::Z)
        }
    }

    /// Pixels a length across the line of sight takes at `depth`.
    pub(super) fn pixels(&self, length: f64, depth: f64) -> f64 {
        if self.is_perspective() { length * self.zoom / depth } else { length * self.zoom }
    }
}

/// A half-space.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipPlane {
    normal: Vec3,
    offset: f64,
}

impl ClipPlane {
    /// Positive inside.
    pub(super) fn distance(&self, p: Vec3) -> f64 {
        self.normal.dot(p) + self.offset
    }
}
