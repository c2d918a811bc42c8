//! What the program reads: scripts and meshes, from files or standard input.

use super::stop::Stop;
use super::terminal::Terminal;
use crate::io as formats;
use crate::io::Format;
use crate::io::svg::Drawing;
use crate::mesh::Mesh;
use std::fmt;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Where input comes from.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Source {
    /// Standard input, typed as `-`.
    Stdin,
    /// A file.
    File(PathBuf),
}

/// What kind of input it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// The text of a script.
    Script,
    /// A mesh.
    Mesh(Format),
    /// An SVG drawing.
    Drawing,
    /// A table of numbers.
    Table,
    /// Lists of points in JSON.
    Points,
    /// A formula, one operation a line.
    Formula,
    /// Bézier patches.
    Patches,
}

/// Endings of files that hold neither scripts nor meshes.
const OTHERS: [(&str, Kind); 6] = [
    ("svg", Kind::Drawing),
    ("csv", Kind::Table),
    ("tsv", Kind::Table),
    ("json", Kind::Points),
    ("vm", Kind::Formula),
    ("bpt", Kind::Patches),
];

impl Source {
    /// What was typed, meant.
    pub(super) fn typed(path: &Path) -> Source {
        if path.as_os_str() == "-" { Source::Stdin } else { Source::File(path.to_owned()) }
    }

    /// The kind of input, from its ending; standard input is a script.
    pub(super) fn kind(&self) -> Result<Kind, Stop> {
        let Source::File(path) = self else { return Ok(Kind::Script) };
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        if ending.eq_ignore_ascii_case("scad") || ending.eq_ignore_ascii_case("csg") {
            return Ok(Kind::Script);
        }
        if let Some(format) = Format::from_ending(&ending) {
            return Ok(Kind::Mesh(format));
        }
        let other = OTHERS.iter().find(|(known, _)| ending.eq_ignore_ascii_case(known));
        if let Some(&(_, kind)) = other {
            return Ok(kind);
        }
        let reason = check_file(path).err().unwrap_or_else(|| format!("unknown ending; {}", endings()));
        Err(Stop::about(self, reason))
    }

    /// The mesh in it.
    pub(super) fn mesh(&self, format: Format) -> Result<Mesh, Stop> {
        let bytes = self.bytes().map_err(|error| Stop::about(self, error))?;
        formats::read_mesh(format, &bytes).map_err(|error| Stop::about(self, error))
    }

    /// The drawing in it.
    pub(super) fn drawing(&self) -> Result<Drawing, Stop> {
        let bytes = self.bytes().map_err(|error| Stop::about(self, error))?;
        formats::svg::read(&bytes).map_err(|error| Stop::about(self, error))
    }

    /// All bytes of it.
    pub(super) fn bytes(&self) -> Result<Vec<u8>, String> {
        match self {
            Source::Stdin => {
                let mut bytes = Vec::new();
                io::stdin().lock().read_to_end(&mut bytes).map_err(|error| error.to_string())?;
                Ok(bytes)
            }
            Source::File(path) => read_file(path),
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Source::Stdin => f.write_str("standard input"),
            Source::File(path) => path.display().fmt(f),
        }
    }
}

/// Says which declarations of style sheets are not obeyed.
pub(super) fn warn_of_styles(source: &Source, drawing: &Drawing, terminal: &Terminal) {
    for (name, count) in &drawing.disobeyed {
        terminal.warn(format!("{source}: `{name}` in styles is not obeyed (declared {count}×)"));
    }
}

/// The endings that are understood, as a sentence.
pub(super) fn endings() -> String {
    format!("scripts end in .scad, meshes in {}, drawings in .svg, patches in .bpt", mesh_endings())
}

/// The endings of mesh files, as a list.
pub(super) fn mesh_endings() -> String {
    let mut endings: Vec<String> = Format::ALL.iter().map(|format| format!(".{}", format.ending())).collect();
    endings.dedup();
    endings.join(", ")
}

/// All bytes of a file.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, String> {
    check_file(path)?;
    fs::read(path).map_err(|error| plainly(&error))
}

/// Refuses folders, and devices, which may never end.
fn check_file(path: &Path) -> Result<(), String> {
    let metadata = fs::metadata(path).map_err(|error| plainly(&error))?;
    if metadata.is_dir() {
        return Err("this is a folder, not a file".to_owned());
    }
    if metadata.is_file() { Ok(()) } else { Err("this is not a regular file".to_owned()) }
}

/// What went wrong with a file, in plain words.
pub(super) fn plainly(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => error.to_string(),
    }
}

/// The text of a script, and whether it had to be taken for Latin-1.
pub(super) fn decode(bytes: Vec<u8>) -> Result<(String, bool), String> {
    // Spans count bytes in 32 bits; Latin-1 grows by at most as much again.
    if bytes.len() > (u32::MAX / 2) as usize {
        return Err(format!("{} bytes are too many for a script", bytes.len()));
    }
    if bytes.contains(&0) {
        let wide = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
        let hint = if wide { ": it is UTF-16, save it as UTF-8" } else { "" };
        return Err(format!("this is not a text{hint}"));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok((text, false)),
        Err(error) => {
            let bytes = error.into_bytes();
            let control = |b: &&u8| b.is_ascii_control() && !b.is_ascii_whitespace() && **b != 0x0b;
            if bytes.iter().any(|b| control(&b)) {
                return Err("this is not a text".to_owned());
            }
            Ok((bytes.into_iter().map(char::from).collect(), true))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds() {
        let kind = |name: &str| Source::typed(Path::new(name)).kind();
        assert_eq!(kind("a.SCAD").unwrap(), Kind::Script);
        assert_eq!(kind("-").unwrap(), Kind::Script);
        assert_eq!(kind("dir.scad/a.Stl").unwrap(), Kind::Mesh(Format::StlBinary));
        let unknown = "Cargo.toml: unknown ending; scripts end in .scad, meshes in .obj, .stl, .off, .ply, drawings in .svg, patches in .bpt";
        assert_eq!(kind("Cargo.toml").unwrap_err().text(), Some(unknown));
        assert_eq!(kind("src").unwrap_err().text(), Some("src: this is a folder, not a file"));
        assert_eq!(kind("a.step").unwrap_err().text(), Some("a.step: there is no such file"));
    }

    #[test]
    fn texts() {
        assert_eq!(decode(b"caf\xc3\xa9".to_vec()), Ok(("café".to_owned(), false)));
        assert_eq!(decode(b"caf\xe9\r\n\tx".to_vec()), Ok(("café\r\n\tx".to_owned(), true)));
        assert!(decode(b"\xff\xfec\0u\0b\0e\0".to_vec()).unwrap_err().contains("UTF-16"));
        assert!(decode(b"\x7fELF\x02\x01\x01\0".to_vec()).is_err());
        assert!(decode(b"\x89PNG\r\n\x1a\n".to_vec()).is_err());
    }
}
