//! What the program writes. A file is written beside its place and renamed, so that nobody ever sees half of it and
//! a failure leaves what was there.

use super::input;
use super::stop::Stop;
use crate::io::{Format, WriteError, obj, write_mesh};
use crate::math::Vec3;
use crate::mesh::Mesh;
use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Where a result goes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Place {
    /// Standard output, typed as `-`.
    Stdout,
    /// A file, links followed.
    File(PathBuf),
    /// Something else that can be written to, such as `/dev/null` or a pipe.
    Device(PathBuf),
}

/// Where a mesh goes, and how it is written there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Output {
    /// As typed.
    name: String,
    place: Place,
    format: Format,
}

/// [`plan`], where a summary may want standard output.
pub(super) fn plan_beside(
    prints: bool,
    typed: &[PathBuf],
    format: Option<Format>,
) -> Result<Vec<Output>, Stop> {
    let outputs = plan(typed, format)?;
    if prints && outputs.iter().any(|output| output.name().is_none()) {
        return Err(Stop::Usage("-o - and what is printed both want standard output".to_owned()));
    }
    Ok(outputs)
}

/// What is meant by the `-o` options. Refuses what cannot work before any work is done: an unknown ending, the same
/// place twice, and what [`Place::typed`] refuses.
pub(super) fn plan(typed: &[PathBuf], format: Option<Format>) -> Result<Vec<Output>, Stop> {
    let mut outputs: Vec<Output> = Vec::with_capacity(typed.len());
    for path in typed {
        let name = path.display().to_string();
        let output = Output { format: chosen_format(path, format)?, place: Place::typed(path)?, name };
        if outputs.iter().any(|other| other.place == output.place) {
            return Err(Stop::Usage(format!("{} is named twice by -o", output.name)));
        }
        outputs.push(output);
    }
    Ok(outputs)
}

/// Writes the mesh to all outputs, the files first: either all of them are replaced or none, but for a failure
/// in the renaming itself, which names the file.
pub(super) fn write(outputs: &[Output], mesh: &Mesh) -> Result<(), Stop> {
    write_with(outputs, mesh, None)
}

/// [`write`] with a normal for every corner, for the formats that have them.
pub(super) fn write_with(outputs: &[Output], mesh: &Mesh, normals: Option<&[[Vec3; 3]]>) -> Result<(), Stop> {
    let fill = |format: Format, out: &mut dyn Write| match (format, normals) {
        (Format::Obj, Some(normals)) => obj::write_with_normals(mesh, normals, out),
        (format, _) => write_mesh(format, mesh, out),
    };
    let mut pending = Vec::new();
    for Output { name, place, format } in outputs {
        if let Place::File(path) = place {
            let written = Pending::write(path, |out| fill(*format, out));
            pending.push(written.map_err(|error| Stop::about(name, error))?);
        }
    }
    for file in pending {
        file.put()?;
    }
    let streams = outputs.iter().filter(|output| !matches!(output.place, Place::File(_)));
    streams.into_iter().try_for_each(|output| output.place.write(|out| fill(output.format, out)))
}

impl Output {
    /// Its name as typed; none for standard output.
    pub(super) fn name(&self) -> Option<&str> {
        (self.place != Place::Stdout).then_some(&self.name)
    }
}

impl Place {
    /// What is meant by a path. Refuses a folder, a read-only file, and a place in a folder that is not there.
    pub(super) fn typed(path: &Path) -> Result<Place, Stop> {
        if path.as_os_str() == "-" {
            return Ok(Place::Stdout);
        }
        let refuse = |reason: &str| Err(Stop::about(path.display(), reason));
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => refuse("this is a folder"),
            Ok(found) if !found.is_file() => Ok(Place::Device(path.to_owned())),
            Ok(found) if found.permissions().readonly() => refuse("this file is read-only"),
            Ok(_) => match path.canonicalize() {
                Ok(path) => Ok(Place::File(path)),
                Err(error) => refuse(&error.to_string()),
            },
            Err(error) if error.kind() == io::ErrorKind::NotFound => new_file(path),
            Err(error) => refuse(&error.to_string()),
        }
    }

    /// Writes what `fill` gives; a file is replaced when all of it is there.
    pub(super) fn write(
        &self,
        fill: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
    ) -> Result<(), Stop> {
        match self {
            Place::Stdout => fill(&mut io::stdout().lock()).map_err(Stop::of_stdout),
            Place::File(path) => Pending::write(path, fill).map_err(|error| Stop::about(self, error))?.put(),
            Place::Device(path) => {
                let file = OpenOptions::new().write(true).open(path).map_err(WriteError::from);
                file.and_then(|mut file| fill(&mut file)).map_err(|error| Stop::about(self, error))
            }
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Stdout => f.write_str("standard output"),
            Place::File(path) | Place::Device(path) => path.display().fmt(f),
        }
    }
}

fn chosen_format(path: &Path, format: Option<Format>) -> Result<Format, Stop> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    format.or_else(|| Format::from_ending(&ending)).ok_or_else(|| {
        let name = path.display();
        Stop::Usage(match name.to_string().as_str() {
            "-" => "-o - needs --format, since it has no ending".to_owned(),
            name => format!("{name}: unknown ending; {}, or give --format", input::endings()),
        })
    })
}

/// A file that is not there yet, in a folder that must be.
fn new_file(path: &Path) -> Result<Place, Stop> {
    let Some(name) = path.file_name() else {
        return Err(Stop::about(path.display(), "this names no file"));
    };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let found = folder.canonicalize();
    let folder =
        found.map_err(|_| Stop::about(path.display(), format!("there is no folder {}", folder.display())))?;
    Ok(Place::File(folder.join(name)))
}

/// A whole file that waits beside its place. It is removed unless it is put there.
struct Pending {
    temporary: PathBuf,
    path: PathBuf,
    put: bool,
}

impl Pending {
    fn write(
        path: &Path,
        fill: impl FnOnce(&mut dyn Write) -> Result<(), WriteError>,
    ) -> Result<Pending, WriteError> {
        let (mut file, temporary) = create_beside(path)?;
        let pending = Pending { temporary, path: path.to_owned(), put: false };
        fill(&mut file)?;
        if let Ok(found) = fs::metadata(path) {
            file.set_permissions(found.permissions())?;
        }
        // The name must not reach the disk before the bytes do.
        file.sync_all()?;
        Ok(pending)
    }

    fn put(mut self) -> Result<(), Stop> {
        fs::rename(&self.temporary, &self.path).map_err(|error| Stop::about(self.path.display(), error))?;
        self.put = true;
        Ok(())
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        if !self.put {
            // It is of no use to anybody; that it stays is no reason to hide the first error.
            drop(fs::remove_file(&self.temporary));
        }
    }
}

/// A new file in the folder of `path`, named after it and this process.
fn create_beside(path: &Path) -> io::Result<(File, PathBuf)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut attempt = 0_u32;
    loop {
        let temporary = path.with_file_name(format!(".{name}.{}-{attempt}.tmp", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Ok(file) => return Ok((file, temporary)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && attempt < 100 => attempt += 1,
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::mesh::cuboid;
    use tempfile::TempDir;

    fn cube(size: f64) -> Mesh {
        cuboid(Vec3::ZERO, Vec3::splat(size)).into_mesh()
    }

    fn names(folder: &TempDir) -> Vec<String> {
        let entries = fs::read_dir(folder.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn all_files_or_none() {
        let folder = TempDir::new().unwrap();
        let [obj, stl] = ["a.obj", "b.stl"].map(|name| folder.path().join(name));
        fs::write(&obj, "old").unwrap();
        let outputs = plan(&[obj.clone(), stl.clone()], None).unwrap();
        // Too far for the f32 of STL, after the OBJ has been written.
        let error = write(&outputs, &cube(1e40)).unwrap_err();
        assert!(error.text().unwrap().contains("b.stl: vertex"), "{error:?}");
        assert_eq!((fs::read(&obj).unwrap(), names(&folder)), (b"old".to_vec(), vec!["a.obj".to_owned()]));
        write(&outputs, &cube(1e30)).unwrap();
        assert_eq!(names(&folder), ["a.obj", "b.stl"]);
        assert_eq!(crate::io::obj::read(&fs::read(&obj).unwrap()), Ok(cube(1e30)));
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = TempDir::new().unwrap();
        let [real, link] = ["real.obj", "link.obj"].map(|name| folder.path().join(name));
        fs::write(&real, "old").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&real, &link).unwrap();
        write(&plan(std::slice::from_ref(&link), None).unwrap(), &cube(1.0)).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
        assert_ne!(fs::read(&real).unwrap(), b"old");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_are_written_through() {
        let out = |path: &str| plan(&[path.into()], Some(Format::Obj)).unwrap();
        write(&out("/dev/null"), &cube(1.0)).unwrap();
        let error = write(&out("/dev/full"), &cube(1.0)).unwrap_err();
        assert!(error.text().unwrap().starts_with("/dev/full: "), "{error:?}");
    }
}
