//! What the processes hand to each other.

use ogee::math::Vec3;
use ogee::mesh::Mesh;
use std::fs;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

/// Meshes as counts, positions and triangles, little-endian.
pub(crate) fn write_meshes(path: &Path, meshes: &[Mesh]) -> io::Result<()> {
    let mut file = BufWriter::new(fs::File::create(path)?);
    file.write_all(&(meshes.len() as u64).to_le_bytes())?;
    for mesh in meshes {
        file.write_all(&(mesh.positions.len() as u64).to_le_bytes())?;
        file.write_all(&(mesh.triangles.len() as u64).to_le_bytes())?;
        for x in mesh.positions.iter().flat_map(Vec3::to_array) {
            file.write_all(&x.to_le_bytes())?;
        }
        for v in mesh.triangles.iter().flatten() {
            file.write_all(&v.to_le_bytes())?;
        }
    }
    file.flush()
}

/// What [`write_meshes`] or `peer.py` wrote.
pub(crate) fn read_meshes(path: &Path) -> io::Result<Vec<Mesh>> {
    let mut file = io::BufReader::new(fs::File::open(path)?);
    let mut word = [0; 8];
    let mut count = |file: &mut dyn Read| -> io::Result<usize> {
        file.read_exact(&mut word)?;
        Ok(u64::from_le_bytes(word) as usize)
    };
    let meshes = count(&mut file)?;
    let mut all = Vec::new();
    for _ in 0..meshes {
        let (vertices, triangles) = (count(&mut file)?, count(&mut file)?);
        let mut bytes = vec![0; 24 * vertices];
        file.read_exact(&mut bytes)?;
        let numbers: Vec<f64> = bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
        let mut bytes = vec![0; 12 * triangles];
        file.read_exact(&mut bytes)?;
        let indices: Vec<u32> = bytes.as_chunks().0.iter().map(|b| u32::from_le_bytes(*b)).collect();
        let positions = numbers.as_chunks().0.iter().map(|p| Vec3::from_array(*p)).collect();
        all.push(Mesh::new(positions, indices.as_chunks().0.to_vec()));
    }
    Ok(all)
}
