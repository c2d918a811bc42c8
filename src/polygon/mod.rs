//! Regions of the plane with holes, their exact overlay and their triangulation.

mod region;
pub mod triangulate;

pub use region::Region;
