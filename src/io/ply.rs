//! PLY, the Stanford polygon format: a text header that declares elements and their properties, then their values.

mod body;
mod header;

use super::facets::Facets;
use super::text::Shortest;
use super::{Problem, ReadError, WriteError};
use crate::math::Vec3;
use crate::mesh::Mesh;
use body::Body;
use header::{Element, Header, Kind, Property};
use std::io::{self, BufWriter, Write};

/// How the values after the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// As words.
    Ascii,
    /// Least byte first.
    LittleEndian,
    /// Greatest byte first.
    BigEndian,
}

/// Reads the properties `x`, `y` and `z` (of any number type) of the elements `vertex` and the list `vertex_indices` or
/// `vertex_index` (of any integer types) of the elements `face`. Other properties and elements are passed over.
///
/// # Errors
/// Where the header or a value makes no sense, a face names a vertex that is not there, the file ends early; and for
/// triangle strips.
pub fn read(bytes: &[u8]) -> Result<Mesh, ReadError> {
    let (header, mut body) = Header::read(bytes)?;
    let mut positions = Vec::new();
    let mut facets = Facets::default();
    for element in &header.elements {
        match element.name {
            b"vertex" => read_vertices(element, &mut body, &mut positions)?,
            b"face" => read_faces(element, &mut body, &mut facets)?,
            b"tristrips" => {
                return Err(element.error(Problem::Unsupported { what: "a PLY of triangle strips" }));
            }
            _ => body.skip(element)?,
        }
    }
    facets.mesh(positions, 0)
}

fn read_vertices(
    element: &Element<'_>,
    body: &mut Body<'_>,
    positions: &mut Vec<Vec3>,
) -> Result<(), ReadError> {
    let mut slots = [0; 3];
    for (slot, name) in slots.iter_mut().zip([b"x", b"y", b"z"]) {
        let named = |p: &Property<'_>| p.name == name && matches!(p.kind, Kind::Scalar(_));
        let missing =
            || element.error(Problem::expected("properties x, y and z of each vertex", b"other ones"));
        *slot = element.properties.iter().position(named).ok_or_else(missing)?;
    }
    positions.reserve(body.room(element));
    for _ in 0..element.count {
        let mut position = Vec3::ZERO;
        for (index, property) in element.properties.iter().enumerate() {
            match (property.kind, slots.iter().position(|&slot| slot == index)) {
                (Kind::Scalar(number), Some(axis)) => position[axis] = body.number(number)?,
                _ => body.skip_property(property)?,
            }
        }
        positions.push(position);
    }
    Ok(())
}

fn read_faces(element: &Element<'_>, body: &mut Body<'_>, facets: &mut Facets) -> Result<(), ReadError> {
    let corners = |p: &Property<'_>| match p.kind {
        Kind::List { count, item } if p.name == b"vertex_indices" || p.name == b"vertex_index" => {
            Some((count, item))
        }
        _ => None,
    };
    if !element.properties.iter().any(|p| corners(p).is_some()) {
        return Err(element.error(Problem::expected("a list of vertex_indices in each face", b"none")));
    }
    for _ in 0..element.count {
        let mut at = body.place();
        for property in &element.properties {
            let Some((count, item)) = corners(property) else {
                body.skip_property(property)?;
                continue;
            };
            let length = body.count(count)?;
            at = body.place();
            for _ in 0..length {
                facets.corner(body.integer(item, "the index of a vertex")?);
            }
        }
        facets.end_face(at)?;
    }
    Ok(())
}

/// Writes positions as `double` and triangles as lists of `int` (`uint` beyond its range). In every encoding, reading
/// gives back the same bits.
///
/// # Errors
/// What `out` reports, and a triangle with an index out of range.
pub fn write(mesh: &Mesh, encoding: Encoding, out: &mut dyn Write) -> Result<(), WriteError> {
    WriteError::check_indices(mesh)?;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    write_header(mesh, encoding, &mut out)?;
    match encoding {
        Encoding::Ascii => write_words(mesh, &mut out)?,
        Encoding::LittleEndian => write_bytes(mesh, f64::to_le_bytes, u32::to_le_bytes, &mut out)?,
        Encoding::BigEndian => write_bytes(mesh, f64::to_be_bytes, u32::to_be_bytes, &mut out)?,
    }
    Ok(out.flush()?)
}

fn write_header(mesh: &Mesh, encoding: Encoding, out: &mut impl Write) -> io::Result<()> {
    let format = match encoding {
        Encoding::Ascii => "ascii",
        Encoding::LittleEndian => "binary_little_endian",
        Encoding::BigEndian => "binary_big_endian",
    };
    let index = if i32::try_from(mesh.positions.len()).is_ok() { "int" } else { "uint" };
    writeln!(out, "ply\nformat {format} 1.0\nelement vertex {}", mesh.positions.len())?;
    writeln!(out, "property double x\nproperty double y\nproperty double z")?;
    writeln!(out, "element face {}", mesh.triangles.len())?;
    writeln!(out, "property list uchar {index} vertex_indices\nend_header")
}

fn write_words(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    for p in &mesh.positions {
        writeln!(out, "{} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
    }
    mesh.triangles.iter().try_for_each(|[a, b, c]| writeln!(out, "3 {a} {b} {c}"))
}

fn write_bytes(
    mesh: &Mesh,
    number: fn(f64) -> [u8; 8],
    index: fn(u32) -> [u8; 4],
    out: &mut impl Write,
) -> io::Result<()> {
    for coordinate in mesh.positions.iter().flat_map(Vec3::to_array) {
        out.write_all(&number(coordinate))?;
    }
    for triangle in &mesh.triangles {
        out.write_all(&[3])?;
        triangle.iter().try_for_each(|&v| out.write_all(&index(v)))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(bytes: &[u8]) -> String {
        read(bytes).unwrap_err().to_string()
    }

    const SQUARE: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\n\
        property float y\nproperty uchar red\nproperty float z\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n0 0 255 7\n1 0 0 7\n1 1 0 7\n0 1 9 7\n4 0 1 2 3\n";

    #[test]
    fn properties_are_found_by_name() {
        let mesh = read(SQUARE.as_bytes()).unwrap();
        assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, 7.0));
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        let dos = SQUARE.replace('\n', "\r\n");
        assert_eq!(read(dos.as_bytes()).as_ref(), Ok(&mesh));
    }

    /// A square with every type of number, faces before vertices, and unknown elements all around.
    fn mixed(encoding: Encoding, count: (&str, usize), item: (&str, usize)) -> Vec<u8> {
        let name = if encoding == Encoding::BigEndian { "big" } else { "little" };
        let mut bytes = format!(
            "ply\nformat binary_{name}_endian 1.0\nelement nothing 18446744073709551615\nelement camera 2\n\
             property double f\nproperty list {} {} l\nelement face 1\nproperty short s\n\
             property list {} {} vertex_index\nelement vertex 4\nproperty char x\nproperty float y\n\
             property ushort z\nelement tail 1\nproperty list uint double d\nend_header\n",
            count.0, item.0, count.0, item.0
        )
        .into_bytes();
        let mut put = |size: usize, value: u64| {
            let all = value.to_le_bytes();
            match encoding {
                Encoding::BigEndian => bytes.extend(all[..size].iter().rev()),
                _ => bytes.extend(&all[..size]),
            }
        };
        for list in [&[] as &[u64], &[1, 2]] {
            put(8, 1.5_f64.to_bits());
            put(count.1, list.len() as u64);
            list.iter().for_each(|&i| put(item.1, i));
        }
        put(2, 77);
        put(count.1, 4);
        [3, 2, 1, 0].iter().for_each(|&i| put(item.1, i));
        for (x, y) in [(-1_i8, 0.5_f32), (1, 0.5), (1, 2.5), (-1, 2.5)] {
            put(1, u64::from(x as u8));
            put(4, u64::from(y.to_bits()));
            put(2, 65535);
        }
        put(4, 1);
        put(8, 0);
        bytes
    }

    #[test]
    fn lists_of_any_integer_type_and_unknown_elements() {
        let types = [("char", 1), ("uint8", 1), ("short", 2), ("ushort", 2), ("int32", 4), ("uint", 4)];
        for encoding in [Encoding::LittleEndian, Encoding::BigEndian] {
            for count in types {
                for item in types {
                    let bytes = mixed(encoding, count, item);
                    let mesh = read(&bytes).unwrap();
                    assert_eq!(mesh.triangles, [[3, 2, 1], [3, 1, 0]]);
                    assert_eq!(mesh.positions[0], Vec3::new(-1.0, 0.5, 65535.0));
                    let cut = &bytes[..bytes.len() - 1];
                    let problem = Problem::TooShort { needed: bytes.len() as u64, size: cut.len() as u64 };
                    assert_eq!(read(cut).unwrap_err().problem, problem);
                }
            }
        }
    }

    #[test]
    fn every_cut_is_an_error() {
        let bytes = mixed(Encoding::LittleEndian, ("uchar", 1), ("int", 4));
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length]).is_err(), "{length}");
        }
        let text = SQUARE.trim_end();
        for length in 0..text.len() {
            assert!(read(&text.as_bytes()[..length]).is_err(), "{length}");
        }
    }

    #[test]
    fn errors_name_the_place() {
        let cases = [
            ("ply", "plx", "line 1: expected ply, found `plx`"),
            (
                "ascii",
                "binary",
                "line 2: expected ascii, binary_little_endian or binary_big_endian, found `binary`",
            ),
            ("element vertex 4", "element vertex -4", "line 4: expected the number of elements, found `-4`"),
            (
                "float x",
                "float w",
                "line 4: expected properties x, y and z of each vertex, found `other ones`",
            ),
            (
                "list uchar",
                "list float",
                "line 10: expected an integer type for the count of a list, found `a float`",
            ),
            (
                "uchar red",
                "half red",
                "line 7: expected a type such as float, double, uchar or int, found `half`",
            ),
            (
                "vertex_indices",
                "corners",
                "line 9: expected a list of vertex_indices in each face, found `none`",
            ),
            ("4 0 1 2 3", "4 0 1 2 4", "line 16: a face names vertex 4, there are 4"),
            ("4 0 1 2 3", "4 0 1 2 -1", "line 16: expected the index of a vertex, found `-1`"),
            ("4 0 1 2 3", "-1", "line 16: expected the length of a list, found `-1`"),
            ("face 1", "face 2", "line 17: the file ends where the length of a list should follow"),
            ("element face", "element tristrips", "line 9: a PLY of triangle strips cannot be read"),
            (
                "vertex 4",
                "vertex 18446744073709551615",
                "line 17: the file ends where a number should follow",
            ),
        ];
        for (from, to, expected) in cases {
            assert_eq!(message(SQUARE.replace(from, to).as_bytes()), expected);
        }
        let huge = "ply\nformat binary_little_endian 1.0\nelement x 18446744073709551615\nproperty int i\nend_header\n1234";
        assert_eq!(
            message(huge.as_bytes()),
            "byte 93: the file is truncated: its counts ask for 18446744073709551615 bytes, it has 97"
        );
    }
}
