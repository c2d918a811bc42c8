use super::input::{Source, decode, mesh_endings, plainly, read_file};
use super::stop::Stop;
use super::terminal::Terminal;
use crate::io::{self as formats, Format};
use crate::mesh::Mesh;
use crate::script::{Host, Loaded, Message, Severity};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The files around a script.
///
/// A name is looked for in the folder of the file that names it, then in that of the main script, then in those of
/// OPENSCADPATH. A file may be read when it is, links followed, inside one of these or of the folders allowed.
pub(super) struct FileHost<'a> {
    main: PathBuf,
    search: Vec<PathBuf>,
    allowed: Vec<PathBuf>,
    /// The folder of each script by the name it has been given: a path that is not UTF-8 would not survive as text.
    folders: BTreeMap<String, PathBuf>,
    meshes: BTreeMap<PathBuf, Arc<Mesh>>,
    terminal: &'a Terminal,
}

impl<'a> FileHost<'a> {
    /// The host of the script `main`, which may read what is in the folders `allow` too.
    pub(super) fn new(
        main: &Source,
        allow: &[PathBuf],
        terminal: &'a Terminal,
    ) -> Result<FileHost<'a>, Stop> {
        let folder = match main {
            Source::Stdin => canonical(Path::new("."))?,
            Source::File(path) => {
                let path = canonical(path)?;
                path.parent().map_or_else(|| path.clone(), Path::to_owned)
            }
        };
        let path = std::env::var_os("OPENSCADPATH").unwrap_or_default();
        let named = std::env::split_paths(&path).filter(|folder| !folder.as_os_str().is_empty());
        // A folder of OPENSCADPATH that is not there holds nothing; that is not worth stopping for.
        let search: Vec<PathBuf> = named.filter_map(|folder| folder.canonicalize().ok()).collect();
        let mut allowed = vec![folder.clone()];
        allowed.extend(search.iter().cloned());
        for folder in allow {
            allowed.push(canonical(folder)?);
        }
        let (folders, meshes) = Default::default();
        Ok(FileHost { main: folder, search, allowed, folders, meshes, terminal })
    }

    /// The main script.
    pub(super) fn main(&mut self, source: &Source) -> Result<Loaded, Stop> {
        let loaded = match source {
            Source::Stdin => {
                let folder = self.main.clone();
                source.bytes().and_then(|bytes| self.load(bytes, "standard input".to_owned(), folder))
            }
            Source::File(path) => self.load_file(&canonical(path)?),
        };
        loaded.map_err(|reason| Stop::about(source, reason))
    }

    fn load_file(&mut self, path: &Path) -> Result<Loaded, String> {
        let folder = path.parent().unwrap_or(path).to_owned();
        self.load(read_file(path)?, path.display().to_string(), folder)
    }

    fn load(&mut self, bytes: Vec<u8>, name: String, folder: PathBuf) -> Result<Loaded, String> {
        let (text, latin) = decode(bytes)?;
        if latin {
            self.warn(format!("{name} is not UTF-8; it is read as Latin-1"));
        }
        self.folders.insert(name.clone(), folder);
        Ok(Loaded { name, text })
    }

    fn warn(&self, text: String) {
        let (at, also, hints, trace, files) = Default::default();
        self.terminal.say(&Message { severity: Severity::Warning, text, at, also, hints, trace, files });
    }

    /// The one path of the file `name` as the script `from` knows it.
    fn find(&self, name: &str, from: &str) -> Result<PathBuf, String> {
        let near = self.folders.get(from).unwrap_or(&self.main);
        let mut places: Vec<&PathBuf> = vec![near];
        for folder in std::iter::once(&self.main).chain(&self.search) {
            if !places.contains(&folder) {
                places.push(folder);
            }
        }
        let found = places.iter().find_map(|folder| folder.join(name).canonicalize().ok());
        let path = found.ok_or_else(|| {
            let places: Vec<String> = places.iter().map(|folder| folder.display().to_string()).collect();
            format!("there is no file `{name}` in {}", places.join(" or "))
        })?;
        if self.allowed.iter().any(|folder| path.starts_with(folder)) {
            return Ok(path);
        }
        let folder = path.parent().unwrap_or(&path).display();
        Err(format!("`{name}` is outside of the folders that the script may read; --allow {folder} lets it"))
    }
}

impl Host for FileHost<'_> {
    fn script(&mut self, name: &str, from: &str) -> Result<Loaded, String> {
        let path = self.find(name, from)?;
        self.load_file(&path).map_err(|reason| format!("`{name}`: {reason}"))
    }

    fn mesh(&mut self, name: &str, from: &str) -> Result<Arc<Mesh>, String> {
        let path = self.find(name, from)?;
        if let Some(mesh) = self.meshes.get(&path) {
            return Ok(Arc::clone(mesh));
        }
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let format = Format::from_ending(&ending)
            .ok_or_else(|| format!("`{name}` cannot be imported: only {} can", mesh_endings()))?;
        let bytes = read_file(&path).map_err(|reason| format!("`{name}`: {reason}"))?;
        let mesh = formats::read_mesh(format, &bytes).map_err(|error| format!("`{name}`: {error}"))?;
        let mesh = Arc::new(mesh);
        self.meshes.insert(path, Arc::clone(&mesh));
        Ok(mesh)
    }

    fn say(&mut self, message: Message) {
        self.terminal.say(&message);
    }
}

fn canonical(path: &Path) -> Result<PathBuf, Stop> {
    path.canonicalize().map_err(|error| Stop::about(path.display(), plainly(&error)))
}
