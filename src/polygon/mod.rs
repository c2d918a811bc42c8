//! Regions of the plane with holes, their exact overlay and their triangulation.

mod combine;
pub mod exact;
mod region;
pub mod triangulate;

pub use combine::{FillRule, combine};
pub use region::{Region, RegionError};
