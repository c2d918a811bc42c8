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
//! | SVG | paths and basic shapes; see [`svg`] | path data, same bits |
//!
//! Bézier patches are read and written in the classic text format ([`bpt`]). Tables of numbers are read from [`csv`] and lists of points from JSON; pictures are written as PNG; formulas
//! ([`crate::sdf::Expr`]) are read and written in the text format of fidget and libfive ([`vm`]).
//!
//! Polygons become triangles in their own plane, also where they are not convex.

pub mod bpt;
pub mod csv;
mod error;
mod facets;
pub mod json;
pub mod obj;
pub mod off;
pub mod ply;
pub mod png;
pub mod stl;
pub mod svg;
mod text;
pub mod vm;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use proptest::prelude::*;

    const LOSSLESS: [Format; 5] =
        [Format::Obj, Format::Off, Format::PlyBinary, Format::PlyBigEndian, Format::PlyAscii];

    fn written(format: Format, mesh: &Mesh) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_mesh(format, mesh, &mut bytes).unwrap();
        bytes
    }

    fn bits(positions: &[Vec3]) -> Vec<[u64; 3]> {
        positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
    }

    /// Any number that is not NaN, often one at an edge of what prints well.
    fn number() -> impl Strategy<Value = f64> {
        let edges = [0.0, -0.0, 0.1, 1e-5, 9.9e-6, 1e16, 9.99e15, 5e-324, f64::MAX, f64::INFINITY, 1.0 / 3.0];
        let any_bits = any::<u64>().prop_map(f64::from_bits).prop_filter("a number", |x| !x.is_nan());
        prop_oneof![prop::sample::select(edges.to_vec()), any_bits, -1e3..1e3_f64]
    }

    fn position() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(number()).prop_map(Vec3::from_array)
    }

    fn mesh() -> impl Strategy<Value = Mesh> {
        prop::collection::vec(position(), 1..20).prop_flat_map(|positions| {
            let corner = 0..positions.len() as u32;
            prop::collection::vec(prop::array::uniform3(corner), 0..30)
                .prop_map(move |triangles| Mesh::new(positions.clone(), triangles))
        })
    }

    proptest! {
        #[test]
        fn reading_back_gives_the_same_bits(mesh in mesh()) {
            for format in LOSSLESS {
                let back = read_mesh(format, &written(format, &mesh)).unwrap();
                prop_assert_eq!(bits(&back.positions), bits(&mesh.positions), "{:?}", format);
                prop_assert_eq!(&back.triangles, &mesh.triangles, "{:?}", format);
            }
        }

        /// ASCII STL keeps the corners of every triangle, but neither the names of vertices nor the sign of zero.
        #[test]
        fn ascii_stl_keeps_corners(mesh in mesh()) {
            let back = read_mesh(Format::StlAscii, &written(Format::StlAscii, &mesh)).unwrap();
            let corners = |m: &Mesh| (0..m.triangles.len()).map(|t| m.corners(t)).collect::<Vec<_>>();
            prop_assert_eq!(corners(&back), corners(&mesh));
            let mut distinct = bits(&back.positions);
            distinct.sort_unstable();
            distinct.dedup();
            prop_assert_eq!(distinct.len(), back.positions.len());
        }

        #[test]
        fn binary_stl_rounds_to_f32(mesh in mesh()) {
            let mut bytes = Vec::new();
            let rounded = |p: Vec3| p.to_array().map(|x| x as f32);
            let corners = |m: &Mesh| (0..m.triangles.len()).map(|t| m.corners(t).map(rounded)).collect::<Vec<_>>();
            let expected: Vec<_> =
                corners(&mesh).into_iter().filter(|[a, b, c]| a != b && b != c && c != a).collect();
            let fits = corners(&mesh).iter().flatten().flatten().all(|x| x.is_finite());
            match write_mesh(Format::StlBinary, &mesh, &mut bytes) {
                Ok(()) => prop_assert_eq!(corners(&read_mesh(Format::StlBinary, &bytes).unwrap()), expected),
                Err(error) => prop_assert!(!fits, "{}", error),
            }
        }

        /// No bytes make a reader panic, and a small file never makes a large mesh.
        #[test]
        fn damaged_files(mesh in mesh(), damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
            for format in Format::ALL {
                let mut bytes = Vec::new();
                if write_mesh(format, &mesh, &mut bytes).is_err() {
                    continue;
                }
                for (place, byte) in &damage {
                    let place = place.index(bytes.len());
                    bytes[place] = *byte;
                }
                if let Ok(back) = read_mesh(format, &bytes) {
                    prop_assert!(back.positions.len() + back.triangles.len() <= bytes.len());
                }
            }
        }

        #[test]
        fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            for format in Format::ALL {
                let _ = read_mesh(format, &bytes);
            }
        }
    }

    #[test]
    fn names_and_endings_lead_back() {
        for format in Format::ALL {
            assert_eq!(Format::from_name(format.name()), Some(format));
            assert_eq!(Format::from_ending(format.ending()).map(Format::ending), Some(format.ending()));
        }
        assert_eq!(Format::from_ending("STL"), Some(Format::StlBinary));
        assert_eq!(Format::from_ending("scad"), None);
    }
}
