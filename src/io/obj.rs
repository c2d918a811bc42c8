//! Wavefront OBJ.

use crate::mesh::Mesh;
use std::io::{Result, Write};

/// Writes positions and triangles. Coordinates are printed with the fewest digits that read back to the same bits.
///
/// # Errors
/// What `out` reports.
pub fn write(mesh: &Mesh, out: &mut dyn Write) -> Result<()> {
    for p in &mesh.positions {
        writeln!(out, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    Ok(())
}
