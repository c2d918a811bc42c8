//! Values to bytes and back, one file a format. Readers take slices and writers take [`std::io::Write`]; nothing
//! here knows a path.
//!
//! | format | read | written |
//! |---|---|---|
//! | OBJ | positions and faces; normals, textures, groups and materials are passed over | text, same bits on reading back |
//! | STL | binary and ASCII, told apart by content; equal corners become one vertex | binary (`f32`) or ASCII (same bits) |
//! | OFF | any of the ASCII kinds in three dimensions; normals and colours are passed over | text, same bits |
//! | PLY | ASCII, binary in both byte orders; what is not a position or a face is passed over | `f64`, same bits |
//!
//! Polygons become triangles in their own plane, also where they are not convex.

mod error;
mod facets;
pub mod obj;
pub mod off;
pub mod ply;
pub mod stl;
mod text;
mod weld;

pub use error::{Place, Problem, ReadError, WriteError};

use crate::mesh::Mesh;
use std::io::Write;

/// A format of mesh files, with its encoding where it has several.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Binary STL: triangles of `f32`.
    StlBinary,
    /// ASCII STL.
    StlAscii,
    /// Object File Format.
    Off,
    /// Binary PLY, least byte first.
    PlyBinary,
    /// Binary PLY, greatest byte first.
    PlyBigEndian,
    /// ASCII PLY.
    PlyAscii,
}

impl Format {
    /// All formats.
    pub const ALL: [Format; 7] = [
        Format::Obj,
        Format::StlBinary,
        Format::StlAscii,
        Format::Off,
        Format::PlyBinary,
        Format::PlyBigEndian,
        Format::PlyAscii,
    ];

    /// The format that files with this ending (`obj` as in `part.obj`, in any case) are written in; `None` for an
    /// ending that belongs to no format.
    pub fn from_ending(ending: &str) -> Option<Format> {
        let first = |format: &&Format| format.ending().eq_ignore_ascii_case(ending);
        Format::ALL.iter().find(first).copied()
    }

    /// The format with this name, see [`Format::name`].
    pub fn from_name(name: &str) -> Option<Format> {
        Format::ALL.into_iter().find(|format| format.name() == name)
    }

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Format::Obj => "obj",
            Format::StlBinary | Format::StlAscii => "stl",
            Format::Off => "off",
            Format::PlyBinary | Format::PlyBigEndian | Format::PlyAscii => "ply",
        }
    }

    /// Its name, which tells encodings apart.
    pub fn name(self) -> &'static str {
        match self {
            Format::Obj => "obj",
            Format::StlBinary => "stl",
            Format::StlAscii => "stl-ascii",
            Format::Off => "off",
            Format::PlyBinary => "ply",
            Format::PlyBigEndian => "ply-big-endian",
            Format::PlyAscii => "ply-ascii",
        }
    }
}

/// Reads a mesh. Which encoding of STL or PLY it is, the bytes say themselves.
///
/// The mesh is what the file holds, defects included: it may be open, and its positions may be NaN.
///
/// # Errors
/// Where the bytes stop making sense, and why. Time and memory are bounded by the length of `bytes`, whatever the
/// counts in them claim.
pub fn read_mesh(format: Format, bytes: &[u8]) -> Result<Mesh, ReadError> {
    match format {
        Format::Obj => obj::read(bytes),
        Format::StlBinary | Format::StlAscii => stl::read(bytes),
        Format::Off => off::read(bytes),
        Format::PlyBinary | Format::PlyBigEndian | Format::PlyAscii => ply::read(bytes),
    }
}

/// Writes a mesh, buffered.
///
/// # Errors
/// What `out` reports, a triangle with an index out of range, and a position that the format cannot hold.
pub fn write_mesh(format: Format, mesh: &Mesh, out: &mut dyn Write) -> Result<(), WriteError> {
    match format {
        Format::Obj => obj::write(mesh, out),
        Format::StlBinary => stl::write_binary(mesh, out),
        Format::StlAscii => stl::write_ascii(mesh, out),
        Format::Off => off::write(mesh, out),
        Format::PlyBinary => ply::write(mesh, ply::Encoding::LittleEndian, out),
        Format::PlyBigEndian => ply::write(mesh, ply::Encoding::BigEndian, out),
        Format::PlyAscii => ply::write(mesh, ply::Encoding::Ascii, out),
    }
}

/// Checks that a mesh may have this many triangles: their half-edges are counted in 32 bits.
fn check_count(triangles: usize, at: Place) -> Result<(), ReadError> {
    let limit = (u32::MAX / 3) as usize;
    if triangles < limit { Ok(()) } else { Err(ReadError { at, problem: Problem::TooLarge }) }
}
