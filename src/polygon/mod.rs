//! Regions of the plane with holes, their exact overlay and their triangulation.

mod combine;
pub mod exact;
mod hull;
mod region;
pub mod triangulate;

pub use combine::{FillRule, combine};
pub use hull::convex_hull;
pub use region::{Region, RegionError};
