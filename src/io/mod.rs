//! Values to bytes and back, one file a format. Readers take slices and writers take [`std::io::Write`]; nothing
//! here knows a path.

pub mod obj;
