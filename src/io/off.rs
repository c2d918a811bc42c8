//! OFF, the Object File Format of Geomview: vertices, then polygons.

use super::facets::Facets;
use super::text::{Shortest, Words, parse};
use super::{Place, Problem, ReadError, WriteError};
use crate::math::Vec3;
use crate::mesh::Mesh;
use std::io::{BufWriter, Write};

/// Fewest bytes of a vertex or face and its line end; no count in a file can ask for more room than its bytes give.
const SHORTEST_LINE: usize = 6;

/// Reads OFF with any of the prefixes `ST`, `C` and `N`: what follows the coordinates or the corners on their line
/// (colours, normals, textures) is passed over. Each vertex and each face begins a line; `#` begins a comment.
///
/// # Errors
/// Where the text breaks this form or a face names a vertex that is not there; and for the binary, the homogeneous
/// and the many-dimensional kinds.
pub fn read(bytes: &[u8]) -> Result<Mesh, ReadError> {
    let mut words = Words::new(bytes).with_comments(b'#');
    let [vertices, faces] = header(&mut words)?;
    let room = |count: usize| count.min(bytes.len() / SHORTEST_LINE);
    let mut positions = Vec::with_capacity(room(vertices));
    for _ in 0..vertices {
        let mut coordinate = || words.number("three coordinates");
        positions.push(Vec3::new(coordinate()?, coordinate()?, coordinate()?));
        words.next_line();
    }
    let mut facets = Facets::with_capacity(room(faces));
    for _ in 0..faces {
        face(&mut words, &mut facets)?;
        words.next_line();
    }
    facets.mesh(positions, 0)
}

/// The numbers of vertices and faces.
fn header(words: &mut Words<'_>) -> Result<[usize; 2], ReadError> {
    let keyword = words.expect("OFF")?;
    let unsupported = |words: &Words<'_>, what| ReadError::line(words.line(), Problem::Unsupported { what });
    match keyword.strip_suffix(b"OFF") {
        Some(b"" | b"C" | b"N" | b"CN" | b"ST" | b"STC" | b"STN" | b"STCN") => {}
        Some(_) => return Err(unsupported(words, "OFF in other than three dimensions")),
        None => return Err(words.error("OFF", keyword)),
    }
    let mut first = words.expect("the number of vertices")?;
    if first == b"BINARY" {
        return Err(unsupported(words, "binary OFF"));
    }
    let mut counts = [0; 2];
    for (slot, name) in counts.iter_mut().zip(["the number of vertices", "the number of faces"]) {
        *slot = parse(first).ok_or_else(|| words.error(name, first))?;
        // The number of edges comes last and means nothing; some writers leave it out.
        first = words.on_line().unwrap_or_default();
    }
    words.next_line();
    Ok(counts)
}

fn face(words: &mut Words<'_>, facets: &mut Facets) -> Result<(), ReadError> {
    const COUNT: &str = "the number of corners";
    let word = words.expect(COUNT)?;
    let at = Place::Line(words.line());
    let corners: usize = parse(word).ok_or_else(|| words.error(COUNT, word))?;
    for _ in 0..corners {
        let word = words.expect("the index of a vertex")?;
        facets.corner(parse(word).ok_or_else(|| words.error("the index of a vertex", word))?);
    }
    facets.end_face(at)
}

/// Writes positions and triangles. Coordinates are printed with the fewest digits that read back to the same bits.
///
/// # Errors
/// What `out` reports, and a triangle with an index out of range.
pub fn write(mesh: &Mesh, out: &mut dyn Write) -> Result<(), WriteError> {
    WriteError::check_indices(mesh)?;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    writeln!(out, "OFF\n{} {} 0", mesh.positions.len(), mesh.triangles.len())?;
    for p in &mesh.positions {
        writeln!(out, "{} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "3 {a} {b} {c}")?;
    }
    Ok(out.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Mesh, String> {
        read(text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn texts_as_others_write_them() {
        let texts = [
            "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n",
            "OFF 4 2 5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3",
            "OFF 4 1\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3\r\n",
            "# made by hand\nOFF # kind\n\n# counts\n4 1 4\n0 0 0 # a\n1 0 0\n\n1 1 0\n0 1 0\n4 0 1 2 3 0.5 0.5 0.5\n",
            "COFF\n4 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1\n1 1 0 0\n0 1 0 9 9 9 9\n4 0 1 2 3 255 0 0\n",
            "OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 1\n4 0 1\n 2 3\n1 3\n",
        ];
        for text in texts {
            let mesh = read_text(text).unwrap();
            assert_eq!((mesh.positions.len(), mesh.triangles), (4, vec![[0, 1, 2], [0, 2, 3]]), "{text}");
        }
    }

    #[test]
    fn errors_name_the_line() {
        let cases = [
            ("", "line 1: the file ends where OFF should follow"),
            ("OBJ", "line 1: expected OFF, found `OBJ`"),
            ("4OFF 1 1 1", "line 1: OFF in other than three dimensions cannot be read"),
            ("OFF BINARY\n", "line 1: binary OFF cannot be read"),
            ("OFF\n3\n", "line 2: expected the number of faces, found ``"),
            ("OFF\n-1 2 3", "line 2: expected the number of vertices, found `-1`"),
            (
                "OFF 18446744073709551615 1 0\n0 0 0\n",
                "line 3: the file ends where three coordinates should follow",
            ),
            (
                "OFF 1 18446744073709551615 0\n0 0 0\n",
                "line 3: the file ends where the number of corners should follow",
            ),
            (
                "OFF 1 1 0\n0 0 0\n18446744073709551615 0",
                "line 3: the file ends where the index of a vertex should follow",
            ),
            ("OFF 1 1 0\n0 0 0\n3 0 0 1", "line 3: a face names vertex 1, there are 1"),
            ("OFF 1 1 0\n0 0 0\n3 0 0 -1", "line 3: expected the index of a vertex, found `-1`"),
            ("OFF 1 1 0\n0 0\n0x1", "line 3: expected three coordinates, found `0x1`"),
        ];
        for (text, expected) in cases {
            assert_eq!(read_text(text).unwrap_err(), expected, "{text}");
        }
    }
}
