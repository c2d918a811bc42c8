use super::input::{Source, decode, mesh_endings, plainly, read_file};
use super::stop::Stop;
use super::terminal::Terminal;
use crate::io::{self as formats, Format};
use crate::mesh::Mesh;
use crate::script::{Host, Loaded, Message};
use crate::surface::Patch;
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
    /// The host of the script `main`, which looks in the folders of `search` and may read what is in those of `allow`
    /// too. A folder of `search` that is not there holds nothing; one of `allow` is a mistake.
    pub(super) fn new(
        main: &Source,
        search: &[PathBuf],
        allow: &[PathBuf],
        terminal: &'a Terminal,
    ) -> Result<FileHost<'a>, Stop> {
        let main = match main {
            Source::Stdin => canonical(Path::new("."))?,
            Source::File(path) => parent(&canonical(path)?),
        };
        let named = search.iter().filter(|folder| !folder.as_os_str().is_empty());
        let search: Vec<PathBuf> = named.filter_map(|folder| folder.canonicalize().ok()).collect();
        let mut allowed = vec![main.clone()];
        allowed.extend(search.iter().cloned());
        for folder in allow {
            allowed.push(canonical(folder)?);
        }
        let (folders, meshes) = Default::default();
        Ok(FileHost { main, search, allowed, folders, meshes, terminal })
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
        self.load(read_file(path)?, path.display().to_string(), parent(path))
    }

    fn load(&mut self, bytes: Vec<u8>, name: String, folder: PathBuf) -> Result<Loaded, String> {
        let (text, latin) = decode(bytes)?;
        if latin {
            self.terminal.warn(format!("{name} is not UTF-8; it is read as Latin-1"));
        }
        self.folders.insert(name.clone(), folder);
        Ok(Loaded { name, text })
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
            if Path::new(name).is_absolute() {
                return "there is no such file".to_owned();
            }
            let places: Vec<String> = places.iter().map(|folder| folder.display().to_string()).collect();
            format!("there is no such file in {}", places.join(" or "))
        })?;
        if self.allowed.iter().any(|folder| path.starts_with(folder)) {
            return Ok(path);
        }
        let folder = parent(&path);
        let hint = format!("--allow {} lets it", folder.display());
        Err(format!("it is outside of the folders that the script may read; {hint}"))
    }
}

impl Host for FileHost<'_> {
    fn script(&mut self, name: &str, from: &str) -> Result<Loaded, String> {
        let path = self.find(name, from)?;
        self.load_file(&path)
    }

    fn mesh(&mut self, name: &str, from: &str) -> Result<Arc<Mesh>, String> {
        let path = self.find(name, from)?;
        if let Some(mesh) = self.meshes.get(&path) {
            return Ok(Arc::clone(mesh));
        }
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let format = Format::from_ending(&ending)
            .ok_or_else(|| format!("only files that end in {} can be read", mesh_endings()))?;
        let mesh = formats::read_mesh(format, &read_file(&path)?).map_err(|error| error.to_string())?;
        let mesh = Arc::new(mesh);
        self.meshes.insert(path, Arc::clone(&mesh));
        Ok(mesh)
    }

    fn patches(&mut self, name: &str, from: &str) -> Result<Vec<Patch>, String> {
        let path = self.find(name, from)?;
        formats::bpt::read(&read_file(&path)?).map_err(|error| error.to_string())
    }

    fn say(&mut self, message: Message) {
        self.terminal.say(&message);
    }
}

/// The folder of a file.
fn parent(path: &Path) -> PathBuf {
    path.parent().unwrap_or(path).to_owned()
}

fn canonical(path: &Path) -> Result<PathBuf, Stop> {
    path.canonicalize().map_err(|error| Stop::about(path.display(), plainly(&error)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::terminal::Style;
    use std::fs;
    use tempfile::TempDir;

    struct World {
        folder: TempDir,
        terminal: Terminal,
    }

    impl World {
        fn new(files: &[(&str, &str)]) -> World {
            let folder = TempDir::new().unwrap();
            for (name, text) in files {
                let path = folder.path().join(name);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, text).unwrap();
            }
            let style = Style { colored: false, oneline: false };
            World { folder, terminal: Terminal::new(style, true, false) }
        }

        fn path(&self, name: &str) -> PathBuf {
            self.folder.path().join(name)
        }

        /// The host of `main/main.scad`, and the name it has been given.
        fn host(&self, search: &[&str], allow: &[&str]) -> (FileHost<'_>, String) {
            let folders = |names: &[&str]| names.iter().map(|name| self.path(name)).collect::<Vec<_>>();
            let source = Source::File(self.path("main/main.scad"));
            let host = FileHost::new(&source, &folders(search), &folders(allow), &self.terminal);
            let mut host = host.unwrap();
            let name = host.main(&source).unwrap().name;
            (host, name)
        }
    }

    #[test]
    fn the_nearest_file_is_taken() {
        let world = World::new(&[
            ("main/main.scad", ""),
            ("main/a.scad", "main"),
            ("main/part/part.scad", ""),
            ("main/part/a.scad", "part"),
            ("lib/a.scad", "lib"),
            ("lib/deep/b.scad", "lib"),
        ]);
        let (mut host, main) = world.host(&["gone", "lib"], &[]);
        let part = host.script("part/part.scad", &main).unwrap().name;
        assert_eq!(host.script("a.scad", &main).unwrap().text, "main");
        assert_eq!(host.script("a.scad", &part).unwrap().text, "part");
        assert_eq!(host.script("part.scad", &part).unwrap().name, part, "one name for one file");
        assert_eq!(host.script("../main/./part/part.scad", &main).unwrap().name, part);
        let deep = host.script("deep/b.scad", &part).unwrap().name;
        assert_eq!(host.script("a.scad", &deep).unwrap().text, "main", "main before OPENSCADPATH");
        let error = host.script("c.scad", &part).unwrap_err();
        assert!(error.contains("part or") && error.contains("lib"), "{error}");
    }

    #[test]
    fn files_outside_are_refused_unless_allowed() {
        let world = World::new(&[("main/main.scad", ""), ("main/x/y.scad", ""), ("secret/s.scad", "s")]);
        let outside = world.path("secret/s.scad").display().to_string();
        for name in ["../secret/s.scad", outside.as_str(), "x/../../secret/s.scad"] {
            let (mut host, main) = world.host(&[], &[]);
            let error = host.script(name, &main).unwrap_err();
            assert!(error.contains("--allow"), "{error}");
            let (mut host, main) = world.host(&[], &["secret"]);
            assert_eq!(host.script(name, &main).unwrap().text, "s");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_lead_nowhere_new() {
        let world = World::new(&[("main/main.scad", ""), ("secret/s.scad", "s")]);
        std::os::unix::fs::symlink(world.path("secret"), world.path("main/link")).unwrap();
        let (mut host, main) = world.host(&[], &[]);
        assert!(host.script("link/s.scad", &main).unwrap_err().contains("--allow"));
    }

    #[test]
    fn what_is_no_script_or_mesh() {
        let world = World::new(&[
            ("main/main.scad", ""),
            ("main/folder/x", ""),
            ("main/a.stl", "solid\nfacet"),
            ("main/tri.off", "OFF 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2"),
            ("main/a.svg", "<svg/>"),
        ]);
        let (mut host, main) = world.host(&[], &[]);
        for name in ["", "folder", "."] {
            assert!(host.script(name, &main).unwrap_err().contains("folder"), "{name}");
        }
        assert!(host.script("a\0b", &main).is_err());
        assert!(host.mesh("a.stl", &main).unwrap_err().contains("line 2"));
        assert!(
            host.mesh("a.svg", &main).unwrap_err().contains("only files that end in .obj, .stl, .off, .ply")
        );
        let first = host.mesh("tri.off", &main).unwrap();
        assert!(Arc::ptr_eq(&first, &host.mesh("./tri.off", &main).unwrap()), "read once");
    }
}
