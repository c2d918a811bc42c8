//! Wavefront OBJ.
//!
//! Read by hand: the `tobj` crate renumbers the vertices of each group on its own, which opens a solid that spans
//! groups, and its errors have no line. The tests compare with it.

use super::facets::Facets;
use super::text::{Shortest, Words, parse};
use super::{Place, Problem, ReadError, WriteError};
use crate::math::Vec3;
use crate::mesh::Mesh;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io::{BufWriter, Write};

/// Reads positions (`v`) and faces (`f`); every other kind of line is passed over. Vertices keep their order, all
/// groups share them, and a weight after a position is ignored. Faces may name vertices that come later.
///
/// # Errors
/// Where a position is not three numbers, or a face names a vertex that is not there.
pub fn read(bytes: &[u8]) -> Result<Mesh, ReadError> {
    let mut words = Words::new(bytes).with_comments(b'#').with_continuation();
    let mut positions = Vec::new();
    let mut facets = Facets::default();
    loop {
        match words.on_line() {
            Some(b"v") => positions.push(position(&mut words)?),
            Some(b"f") => face(&mut words, positions.len(), &mut facets)?,
            _ => {}
        }
        if !words.next_line() {
            return facets.mesh(positions, 1);
        }
    }
}

fn position(words: &mut Words<'_>) -> Result<Vec3, ReadError> {
    let mut coordinate = || {
        let word = words.on_line().unwrap_or_default();
        parse(word).ok_or_else(|| words.error("three coordinates", word))
    };
    Ok(Vec3::new(coordinate()?, coordinate()?, coordinate()?))
}

fn face(words: &mut Words<'_>, vertices: usize, facets: &mut Facets) -> Result<(), ReadError> {
    let at = Place::Line(words.line());
    while let Some(word) = words.on_line() {
        let name = word.split(|&b| b == b'/').next().unwrap_or_default();
        let index: i64 = parse(name).ok_or_else(|| words.error("the number of a vertex", word))?;
        // Positive ones count from 1, negative ones back from the last vertex so far.
        let vertex =
            if index < 0 { index.checked_add_unsigned(vertices as u64) } else { index.checked_sub(1) };
        let vertex = vertex.and_then(|v| u32::try_from(v).ok());
        facets.corner(
            vertex.ok_or(ReadError { at, problem: Problem::NoSuchVertex { index, count: vertices } })?,
        );
    }
    facets.end_face(at)
}

/// [`write()`] with a unit normal for every corner; equal ones are written once.
///
/// # Errors
/// As [`write()`].
///
/// # Panics
/// When there are not as many normals as triangles.
pub fn write_with_normals(mesh: &Mesh, normals: &[[Vec3; 3]], out: &mut dyn Write) -> Result<(), WriteError> {
    assert_eq!(normals.len(), mesh.triangles.len(), "three normals a triangle");
    WriteError::check_indices(mesh)?;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    for p in &mesh.positions {
        writeln!(out, "v {} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
    }
    let mut known: BTreeMap<[u64; 3], u64> = BTreeMap::new();
    for normal in normals.iter().flatten() {
        // Zero has two bit patterns that mean the same.
        let key = normal.to_array().map(|x| (x + 0.0).to_bits());
        let next = known.len() as u64 + 1;
        if let Entry::Vacant(entry) = known.entry(key) {
            entry.insert(next);
            let [x, y, z] = key.map(f64::from_bits);
            writeln!(out, "vn {} {} {}", Shortest(x), Shortest(y), Shortest(z))?;
        }
    }
    for (triangle, normals) in mesh.triangles.iter().zip(normals) {
        let [a, b, c] = triangle.map(|v| u64::from(v) + 1);
        let [p, q, r] = normals.map(|normal| known[&normal.to_array().map(|x| (x + 0.0).to_bits())]);
        writeln!(out, "f {a}//{p} {b}//{q} {c}//{r}")?;
    }
    Ok(out.flush()?)
}

/// Writes positions and triangles. Coordinates are printed with the fewest digits that read back to the same bits.
///
/// # Errors
/// What `out` reports, and a triangle with an index out of range.
pub fn write(mesh: &Mesh, out: &mut dyn Write) -> Result<(), WriteError> {
    WriteError::check_indices(mesh)?;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    for p in &mesh.positions {
        writeln!(out, "v {} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| u64::from(v) + 1);
        writeln!(out, "f {a} {b} {c}")?;
    }
    Ok(out.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Mesh, String> {
        read(text.as_bytes()).map_err(|error| error.to_string())
    }

    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn faces_in_all_their_forms() {
        let forms = [
            "f 1 2 3\n",
            "f 1/1 2/2 3/3\n",
            "f 1//1 2//2 3//3\n",
            "f 1/9/9 2/9/9 3/9/9 # nine\n",
            "f -4 -3 -2",
            "f 1 \\\n2 \\\r\n 3",
            "f 1 2\\\n 3",
            "  f\t1 2 3  \r\n",
            "o caf\u{e9}\nusemtl x\ng a b\ns off\nl 1 2\np 1\nf 1 2\nf 1 2 3",
        ];
        for form in forms {
            let mesh = read_text(&format!("{CORNERS}{form}")).unwrap();
            assert_eq!((mesh.positions.len(), mesh.triangles), (4, vec![[0, 1, 2]]), "{form}");
        }
        let late = read_text(&format!("f 1 2 3\n{CORNERS}")).unwrap();
        assert_eq!(late.triangles, [[0, 1, 2]]);
        let quad = read_text(&format!("{CORNERS}f -1 -2 -3 -4")).unwrap();
        assert_eq!(quad.triangles, [[3, 2, 1], [3, 1, 0]]);
    }

    #[test]
    fn groups_share_their_vertices() {
        let mesh = read_text(&format!("{CORNERS}g a\nf 1 2 3\ng b\nf 1 3 4\n")).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn errors_name_the_line() {
        let cases = [
            ("f 1 2 5\n", "line 5: a face names vertex 5, there are 4"),
            ("f 1 2 0\n", "line 5: a face names vertex 0, there are 4"),
            ("\nf 1 2 -5\n", "line 6: a face names vertex -5, there are 4"),
            ("f 1 2 9223372036854775807\n", "line 5: a face names vertex 9223372036854775807, there are 4"),
            ("f 1 2 -9223372036854775808\n", "line 5: a face names vertex -9223372036854775808, there are 4"),
            ("f 1 2 x/3\n", "line 5: expected the number of a vertex, found `x/3`"),
            ("v 1 2\n", "line 5: expected three coordinates, found ``"),
            ("v 1 2 3,5\n", "line 5: expected three coordinates, found `3,5`"),
        ];
        for (line, expected) in cases {
            assert_eq!(read_text(&format!("{CORNERS}{line}")).unwrap_err(), expected);
        }
    }

    /// Without groups, `tobj` sees the same corners in the same order.
    #[test]
    fn agrees_with_tobj() {
        let text = "v 0.1 -2e-7 3e22\nv 1 0 0\nv 1 1 .5\nv -0 1. 0\nvn 0 0 1\nvt 0 0\n\
                    f 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1\nf -4 -2 -1\n";
        let (models, _) = tobj::load_obj_buf(
            &mut text.as_bytes(),
            &tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() },
            |_| Err(tobj::LoadError::OpenFileFailed),
        )
        .unwrap();
        let theirs: Vec<[u64; 3]> = models[0]
            .mesh
            .indices
            .iter()
            .map(|&i| std::array::from_fn(|axis| models[0].mesh.positions[3 * i as usize + axis].to_bits()))
            .collect();
        let ours = read_text(text).unwrap();
        let ours: Vec<[u64; 3]> = ours
            .triangles
            .iter()
            .flatten()
            .map(|&v| ours.positions[v as usize].to_array().map(f64::to_bits))
            .collect();
        assert_eq!(ours, theirs);
    }
}
