//! STL, binary and ASCII: triangles without vertices in common, welded on reading.

use super::text::{Shortest, Words};
use super::weld::Welder;
use super::{Place, Problem, ReadError, WriteError};
use crate::math::Vec3;
use crate::mesh::Mesh;
use std::io::{BufWriter, Write};

/// Bytes before the first triangle of a binary file: free text and a count.
const HEADER: usize = 84;
/// Bytes of a triangle: a normal and three corners in `f32`, and two bytes of attributes.
const TRIANGLE: usize = 50;

/// Reads either kind. Corners with equal coordinates become one vertex, -0 being equal to 0; the normals in the file
/// are passed over, the order of the corners says what is outside.
///
/// # Errors
/// Where a text breaks the form of a facet, and a binary file whose count does not fit its length.
pub fn read(bytes: &[u8]) -> Result<Mesh, ReadError> {
    if is_ascii(bytes) { read_ascii(bytes) } else { read_binary(bytes) }
}

/// A binary file may begin with `solid` as well, so its length decides first. A file of another length is a text
/// when its first line and what comes after it begin like one.
fn is_ascii(bytes: &[u8]) -> bool {
    let mut words = Words::new(bytes);
    let begins = words.on_line().is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let fits = declared_size(bytes) == Some(bytes.len() as u64);
    words.next_line();
    let next = words.word().unwrap_or_default();
    let goes_on = [b"".as_slice(), b"facet", b"endsolid"].iter().any(|w| next.eq_ignore_ascii_case(w));
    begins && !fits && goes_on
}

/// The length that the count in a binary header asks for; `None` when there is no whole header.
fn declared_size(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    Some(HEADER as u64 + TRIANGLE as u64 * u64::from(u32::from_le_bytes(count)))
}

fn read_binary(bytes: &[u8]) -> Result<Mesh, ReadError> {
    let size = bytes.len() as u64;
    let needed = declared_size(bytes).unwrap_or(HEADER as u64);
    if needed > size {
        return Err(ReadError::byte(bytes.len(), Problem::TooShort { needed, size }));
    }
    // Some writers pad the file; a whole triangle more means that the count is wrong.
    if size - needed >= TRIANGLE as u64 {
        return Err(ReadError::byte(needed as usize, Problem::TooLong { left: size - needed }));
    }
    let (triangles, _) = bytes[HEADER..needed as usize].as_chunks::<TRIANGLE>();
    super::check_count(triangles.len(), Place::Byte(HEADER - 4))?;
    let mut welder = Welder::with_capacity(triangles.len());
    for triangle in triangles {
        let (numbers, _) = triangle.as_chunks::<4>();
        let number = |i: usize| f64::from(f32::from_le_bytes(numbers[i]));
        let corner = |i: usize| Vec3::new(number(i), number(i + 1), number(i + 2));
        welder.push([corner(3), corner(6), corner(9)]);
    }
    Ok(welder.finish())
}

fn read_ascii(bytes: &[u8]) -> Result<Mesh, ReadError> {
    let mut words = Words::new(bytes);
    let mut welder = Welder::default();
    let mut count = 0;
    while let Some(word) = words.word() {
        if !word.eq_ignore_ascii_case(b"solid") {
            return Err(words.error("solid", word));
        }
        words.next_line();
        while facet_follows(&mut words)? {
            welder.push(facet(&mut words)?);
            count += 1;
            super::check_count(count, Place::Line(words.line()))?;
        }
        // The name after `endsolid` is free text.
        words.next_line();
    }
    Ok(welder.finish())
}

/// Whether `facet` comes next, and not `endsolid`.
fn facet_follows(words: &mut Words<'_>) -> Result<bool, ReadError> {
    let word = words.expect("facet or endsolid")?;
    if word.eq_ignore_ascii_case(b"facet") {
        Ok(true)
    } else if word.eq_ignore_ascii_case(b"endsolid") {
        Ok(false)
    } else {
        Err(words.error("facet or endsolid", word))
    }
}

/// What follows `facet`: its normal and its corners.
fn facet(words: &mut Words<'_>) -> Result<[Vec3; 3], ReadError> {
    keyword(words, "normal")?;
    // Writers put anything there for a triangle without area, such as `-nan(ind)`.
    for _ in 0..3 {
        words.expect("a normal")?;
    }
    keyword(words, "outer")?;
    keyword(words, "loop")?;
    let corners = [corner(words)?, corner(words)?, corner(words)?];
    keyword(words, "endloop")?;
    keyword(words, "endfacet")?;
    Ok(corners)
}

fn corner(words: &mut Words<'_>) -> Result<Vec3, ReadError> {
    keyword(words, "vertex")?;
    let mut coordinate = || words.number("three coordinates");
    Ok(Vec3::new(coordinate()?, coordinate()?, coordinate()?))
}

fn keyword(words: &mut Words<'_>, keyword: &'static str) -> Result<(), ReadError> {
    let word = words.expect(keyword)?;
    if word.eq_ignore_ascii_case(keyword.as_bytes()) { Ok(()) } else { Err(words.error(keyword, word)) }
}

/// Writes binary STL. Coordinates are rounded to `f32`; triangles of which two corners become equal by that are left
/// out, which keeps a closed mesh closed.
///
/// # Errors
/// What `out` reports, a triangle with an index out of range, and a position that is not finite in `f32`.
pub fn write_binary(mesh: &Mesh, out: &mut dyn Write) -> Result<(), WriteError> {
    WriteError::check_indices(mesh)?;
    let rounded = rounded(mesh)?;
    let corners = |t: &[u32; 3]| t.map(|v| rounded[v as usize]);
    let kept = |[a, b, c]: &[[f32; 3]; 3]| a != b && b != c && c != a;
    let count = mesh.triangles.iter().map(corners).filter(kept).count() as u32;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    write!(out, "{:<1$}", "binary STL from ogee", HEADER - 4)?;
    out.write_all(&count.to_le_bytes())?;
    for corners in mesh.triangles.iter().map(corners).filter(kept) {
        let normal = normal(corners.map(|p| Vec3::from_array(p.map(f64::from))));
        let numbers = normal.to_array().map(|x| x as f32).into_iter().chain(corners.into_iter().flatten());
        let mut record = [0; TRIANGLE];
        for (slot, number) in record.chunks_exact_mut(4).zip(numbers) {
            slot.copy_from_slice(&number.to_le_bytes());
        }
        out.write_all(&record)?;
    }
    Ok(out.flush()?)
}

/// All positions in `f32`; those of vertices that are used must be finite there.
fn rounded(mesh: &Mesh) -> Result<Vec<[f32; 3]>, WriteError> {
    let rounded: Vec<[f32; 3]> = mesh.positions.iter().map(|p| p.to_array().map(|x| x as f32)).collect();
    let broken = |&&vertex: &&u32| !rounded[vertex as usize].iter().all(|x| x.is_finite());
    match mesh.triangles.iter().flatten().find(broken) {
        Some(&vertex) => Err(WriteError::NotInFormat { vertex, position: mesh.positions[vertex as usize] }),
        None => Ok(rounded),
    }
}

/// Writes ASCII STL, with the digits that read back to the same `f64`.
///
/// # Errors
/// What `out` reports, and a triangle with an index out of range.
pub fn write_ascii(mesh: &Mesh, out: &mut dyn Write) -> Result<(), WriteError> {
    WriteError::check_indices(mesh)?;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    writeln!(out, "solid ogee")?;
    for triangle in 0..mesh.triangles.len() {
        let corners = mesh.corners(triangle);
        let [x, y, z] = normal(corners).to_array().map(|x| x as f32);
        writeln!(out, "facet normal {x} {y} {z}\n outer loop")?;
        for p in corners {
            writeln!(out, "  vertex {} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
        }
        writeln!(out, " endloop\nendfacet")?;
    }
    writeln!(out, "endsolid ogee")?;
    Ok(out.flush()?)
}

/// The unit normal, zero for a triangle without one.
fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    let unit = |v: Vec3| v / v.abs().max_element();
    unit(b - a).cross(unit(c - a)).try_normalize().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Solid, cuboid};

    fn cube() -> Mesh {
        cuboid(Vec3::splat(-0.5), Vec3::splat(1.5)).into_mesh()
    }

    fn binary(mesh: &Mesh) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_binary(mesh, &mut bytes).unwrap();
        bytes
    }

    fn ascii(mesh: &Mesh) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_ascii(mesh, &mut bytes).unwrap();
        bytes
    }

    #[test]
    fn both_kinds_come_back_closed() {
        for bytes in [binary(&cube()), ascii(&cube())] {
            let mesh = read(&bytes).unwrap();
            assert_eq!((mesh.positions.len(), mesh.triangles.len()), (8, 12));
            assert!(Solid::new(mesh).is_ok());
        }
    }

    #[test]
    fn a_binary_file_may_begin_with_solid() {
        let mut bytes = binary(&cube());
        bytes[..12].copy_from_slice(b"solid facet\n");
        assert_eq!(read(&bytes), read(&binary(&cube())));
        // Cut short as well: it is still no text.
        bytes[12..80].fill(0);
        bytes.truncate(500);
        assert_eq!(read(&bytes).unwrap_err().problem, Problem::TooShort { needed: 684, size: 500 });
    }

    #[test]
    fn counts_that_lie() {
        let mut bytes = binary(&cube());
        bytes[80..84].copy_from_slice(&4_000_000_000_u32.to_le_bytes());
        let problem = Problem::TooShort { needed: 200_000_000_084, size: 684 };
        assert_eq!(read(&bytes), Err(ReadError::byte(684, problem)));
        bytes[80..84].copy_from_slice(&11_u32.to_le_bytes());
        assert_eq!(read(&bytes), Err(ReadError::byte(634, Problem::TooLong { left: 50 })));
        for length in 0..84 {
            let problem = Problem::TooShort { needed: 84, size: length as u64 };
            assert_eq!(read(&bytes[..length]), Err(ReadError::byte(length, problem)));
        }
    }

    #[test]
    fn every_cut_of_a_text_is_an_error_but_the_last() {
        let text = ascii(&cube());
        let end = text.len() - "endsolid ogee\n".len();
        for length in 0..=end {
            assert!(read(&text[..length]).is_err(), "{}", String::from_utf8_lossy(&text[..length]));
        }
        assert!(read(&text).is_ok());
    }

    #[test]
    fn texts_as_others_write_them() {
        let text = b"SOLID Caf\xe9 facet vertex\r\n  FACET NORMAL -nan(ind) 1.#QNAN 0\r\n OUTER LOOP\r\n\
            VERTEX 0 0 0\r\nVERTEX 1 0 -0\r\nVERTEX 0 1e-3 +0.0\r\nENDLOOP\r\nENDFACET\r\n\
            facet normal 0 0 0 outer loop vertex 1 0 0 vertex 1 1 0 vertex 0 .001 0 endloop endfacet\n\
            ENDSOLID\r\nsolid\nendsolid\n";
        let mesh = read(text).unwrap();
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(mesh.positions[1].z.to_bits(), 0);
    }

    #[test]
    fn text_errors_name_the_line() {
        let cases = [
            (
                "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 q",
                "line 4: expected three coordinates, found `q`",
            ),
            ("solid\nfacet normal 0 0 1\n outer lop", "line 3: expected loop, found `lop`"),
            ("solid x\nfacet normal 0 0", "line 2: the file ends where a normal should follow"),
        ];
        for (text, expected) in cases {
            assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), expected);
        }
    }

    #[test]
    fn what_rounding_collapses_is_left_out() {
        let thin = cuboid(Vec3::ZERO, Vec3::new(1.0, 1.0, 1.0 + 1e-10));
        let mut mesh = thin.into_mesh();
        mesh.positions.iter_mut().filter(|p| p.z == 0.0).for_each(|p| p.z = 1.0);
        let mesh = read(&binary(&mesh)).unwrap();
        assert_eq!(mesh.triangles.len(), 4);
        assert!(crate::mesh::Defects::of(&mesh).is_closed());
    }

    #[test]
    fn what_f32_cannot_hold_is_an_error() {
        let mut mesh = cube();
        mesh.positions[3].y = 1e39;
        let error = write_binary(&mesh, &mut Vec::new()).unwrap_err();
        assert!(matches!(error, WriteError::NotInFormat { vertex: 3, .. }), "{error}");
        assert_eq!(read(&ascii(&mesh)).unwrap().bounds(), mesh.bounds());
        mesh.triangles[5][1] = 8;
        let error = write_binary(&mesh, &mut Vec::new()).unwrap_err();
        assert!(matches!(error, WriteError::NoSuchVertex { triangle: 5, vertex: 8, count: 8 }), "{error}");
    }
}
