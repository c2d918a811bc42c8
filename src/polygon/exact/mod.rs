//! Exact geometry of points on planes: the ground of booleans in the plane and in space.
//!
//! Input coordinates are integers of at most 60 bits on a [`Lattice`]. Every plane passes through lattice points, every
//! line is where two planes cross, and every point is a lattice point or a fraction of integers of bounded width, so all
//! signs below are exact at a fixed cost, and nothing is ever computed from a rounded value:
//!
//! | number | bits |
//! |---|---|
//! | coordinate, normal, offset | 60, 126, 188 |
//! | numerator and denominator of a point where three planes meet | 443, 381 |
//! | plane at such a point | 571 |
//! | comparison of two coordinates | 824 |
//! | orientation of three points in a plane | 1269 |
//!
//! Normals of planes through lattice points have 123 bits; the other three are for surfaces that come from a finer
//! lattice ([`Origin`]).
//!
//! A double with a bound on its error decides first wherever it can. Points know their position rounded correctly to
//! doubles; rounding is monotone, so differing rounded coordinates order the exact ones.
//!
//! The work is done one plane at a time, in a [`Chart`] that drops the axis along which the plane's normal is longest:
//! [`overlay`] cuts segments where they meet and finds the cells between them, [`triangulate`] fills cells.

mod chart;
mod contours;
mod lattice;
mod origin;
mod overlay;
mod plane;
mod points;
mod snapped;
mod sweep;
mod triangulate;

pub use chart::{Chart, Line};
pub use contours::followers;
pub use lattice::Lattice;
pub use origin::Origin;
pub(crate) use origin::Place;
pub use overlay::{Jump, Overlay, Segment, SubEdge, overlay};
pub use plane::Plane;
pub use points::{PointId, Points};
pub use snapped::Snapped;
pub use sweep::{Planar, PlanarEdge};
pub use triangulate::{Boundary, triangulate};

/// Integer coordinates of a lattice point; at most 2^60 in magnitude.
pub type Site = [i64; 3];

/// Widths of the numbers in the table above, in limbs of 64 bits.
pub(crate) mod width {
    use crate::numeric::Wide;

    pub(crate) type Offset = Wide<3>;
    pub(crate) type Cross = Wide<4>;
    pub(crate) type Numerator = Wide<7>;
    pub(crate) type Denominator = Wide<6>;
    pub(crate) type PlaneAtPoint = Wide<9>;
    pub(crate) type Comparison = Wide<13>;
    pub(crate) type Orientation = Wide<20>;
}
