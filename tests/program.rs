//! The program `ogee` as its users meet it: good and bad input, exit codes, what is written and what is left alone.

use ogee::io::{Format, read_mesh, write_mesh};
use ogee::math::Vec3;
use ogee::mesh::{Mesh, cuboid, volume};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A folder to work in, removed at the end.
struct Bench {
    folder: TempDir,
}

/// What a run left.
#[derive(Debug)]
struct Ran {
    code: Option<i32>,
    out: Vec<u8>,
    err: String,
}

impl Bench {
    fn new() -> Bench {
        Bench { folder: TempDir::new().expect("a folder") }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn put(&self, name: &str, bytes: impl AsRef<[u8]>) -> &Bench {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, bytes).expect("a file");
        self
    }

    fn put_mesh(&self, name: &str, mesh: &Mesh) -> &Bench {
        let mut bytes = Vec::new();
        let ending = Path::new(name).extension().unwrap_or_default().to_string_lossy().into_owned();
        write_mesh(Format::from_ending(&ending).expect("a format"), mesh, &mut bytes).expect("a mesh");
        self.put(name, bytes)
    }

    fn get(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect(name)
    }

    fn mesh(&self, name: &str) -> Mesh {
        let ending = Path::new(name).extension().unwrap_or_default().to_string_lossy().into_owned();
        read_mesh(Format::from_ending(&ending).expect("a format"), &self.get(name)).expect(name)
    }

    /// The names of all files, to see what is left behind.
    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ogee"));
        command.args(line.split(' ')).current_dir(self.folder.path()).env_remove("OPENSCADPATH");
        command
    }

    /// Runs `ogee` with the words of `line`.
    fn run(&self, line: &str) -> Ran {
        Ran::from(self.command(line).stdin(Stdio::null()).output().expect("the program"))
    }

    /// Runs `ogee` with `input` on standard input.
    fn feed(&self, line: &str, input: &[u8]) -> Ran {
        let mut command = self.command(line);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program");
        child.stdin.take().expect("a pipe").write_all(input).expect("an open pipe");
        Ran::from(child.wait_with_output().expect("the program"))
    }

    /// Runs `ogee`, which must fail with this code, say all these things, and leave the folder as it was.
    fn fails(&self, line: &str, code: i32, parts: &[&str]) {
        let before = self.files();
        let ran = self.run(line);
        assert_eq!(ran.code, Some(code), "{line}: {}", ran.err);
        for part in parts {
            assert!(ran.err.contains(part), "{line}: `{part}` is missing in: {}", ran.err);
        }
        assert!(!ran.err.contains("panicked"), "{line}: {}", ran.err);
        assert_eq!(self.files(), before, "{line}");
    }
}

impl From<Output> for Ran {
    fn from(output: Output) -> Ran {
        let err = String::from_utf8_lossy(&output.stderr).into_owned();
        Ran { code: output.status.code(), out: output.stdout, err }
    }
}

impl Ran {
    fn json(&self) -> serde_json::Value {
        assert_eq!(self.code, Some(0), "{}", self.err);
        serde_json::from_slice(&self.out).expect("JSON")
    }
}

fn cube(min: f64, max: f64) -> Mesh {
    cuboid(Vec3::splat(min), Vec3::splat(max)).into_mesh()
}

#[test]
fn help_and_mistyped_commands() {
    let bench = Bench::new();
    for command in ["build", "check", "info", "boolean"] {
        let ran = bench.run(&format!("{command} --help"));
        assert_eq!(ran.code, Some(0));
        let text = String::from_utf8(ran.out).expect("text");
        assert!(text.contains("Examples:\n  ogee "), "{text}");
    }
    assert!(String::from_utf8(bench.run("--help").out).expect("text").contains("Exit codes:"));
    bench.fails("biuld a.scad", 2, &["biuld", "'build'"]);
    bench.fails("build a.scad", 2, &["--output"]);
    bench.fails("build a.scad -o a.obj --sumary json", 2, &["--summary"]);
    bench.fails("build a.scad -o a.obj -D width", 2, &["name=value"]);
    bench.fails("build a.scad -o a.obj --limit-seconds -1", 2, &["--limit-seconds"]);
    bench.fails("boolean onion a.stl b.stl -o c.stl", 2, &["'union'"]);
}

#[test]
fn bad_files() {
    let bench = Bench::new();
    let mut truncated = Vec::new();
    write_mesh(Format::StlBinary, &cube(0.0, 1.0), &mut truncated).expect("bytes");
    truncated.truncate(300);
    let mut lying = truncated.clone();
    lying[80..84].copy_from_slice(&4_000_000_000_u32.to_le_bytes());
    bench.put("cut.stl", truncated).put("lying.stl", lying).put("far.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
    bench.put("folder.stl/x", "").put("notes.txt", "words").put("binary.scad", b"cube(1);\0\0");
    bench.fails("info nothing.stl", 1, &["nothing.stl", "no such file"]);
    bench.fails("info folder.stl", 1, &["folder.stl", "folder"]);
    bench.fails("info cut.stl", 1, &["cut.stl: byte 300: the file is truncated"]);
    bench.fails("info lying.stl", 1, &["200000000084 bytes"]);
    bench.fails("info far.obj", 1, &["far.obj: line 3: a face names vertex 3, there are 2"]);
    bench.fails("info notes.txt", 1, &["notes.txt: unknown ending", ".stl"]);
    bench.fails("boolean union far.obj cut.stl -o x.obj", 1, &["far.obj"]);
    bench.fails("boolean union binary.scad -o x.obj", 1, &["this is a script"]);
    bench.fails("build cut.stl -o x.obj", 1, &["this is a mesh"]);
    bench.fails("build nothing.scad -o x.obj", 1, &["nothing.scad", "no such file"]);
    bench.fails("build folder.stl/ -o x.obj", 1, &["folder"]);
    bench.fails("build binary.scad -o x.obj", 1, &["binary.scad", "not a text"]);
    bench.fails("check binary.scad", 1, &["not a text"]);
}

#[test]
fn bad_outputs() {
    let bench = Bench::new();
    bench.put_mesh("a.stl", &cube(0.0, 1.0)).put("folder.obj/x", "").put("fixed.obj", "kept");
    let mut permissions = fs::metadata(bench.path("fixed.obj")).expect("a file").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(bench.path("fixed.obj"), permissions).expect("a file");
    bench.fails("boolean union a.stl -o nowhere/b.obj", 1, &["nowhere/b.obj", "there is no folder nowhere"]);
    bench.fails("boolean union a.stl -o folder.obj", 1, &["folder.obj", "folder"]);
    bench.fails("boolean union a.stl -o fixed.obj", 1, &["read-only"]);
    bench.fails("boolean union a.stl -o b.step", 2, &["b.step", "unknown ending", "--format"]);
    bench.fails("boolean union a.stl -o -", 2, &["--format"]);
    bench.fails("boolean union a.stl -o b.obj -o ./b.obj", 2, &["twice"]);
    bench.fails("boolean union a.stl -o b.obj --format step", 2, &["stl-ascii"]);
    assert_eq!(bench.get("fixed.obj"), b"kept");
}

#[test]
fn info_describes_closed_and_broken_meshes() {
    let bench = Bench::new();
    let mut open = cube(-1.0, 1.0);
    open.triangles.pop();
    bench.put_mesh("whole.ply", &cube(-1.0, 1.0)).put_mesh("open.off", &open);
    bench.put("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").put("empty.obj", "");
    let whole = bench.run("info --json whole.ply").json();
    assert_eq!((&whole["volume"], &whole["area"], &whole["genus"]), (&8.0.into(), &24.0.into(), &0.into()));
    assert_eq!((&whole["closed"], &whole["components"]), (&true.into(), &1.into()));
    assert_eq!(whole["box"]["max"], serde_json::json!([1.0, 1.0, 1.0]));
    assert!(whole["defects"].as_object().expect("counts").values().all(|count| count == 0));
    let open = bench.run("info --json open.off").json();
    assert_eq!((&open["closed"], &open["defects"]["open edges"]), (&false.into(), &3.into()));
    let nan = bench.run("info --json nan.obj").json();
    assert_eq!(nan["defects"]["non-finite positions"], 1);
    let empty = bench.run("info --json empty.obj").json();
    assert_eq!((&empty["triangles"], &empty["box"]), (&0.into(), &serde_json::Value::Null));
    let text = String::from_utf8(bench.run("info whole.ply").out).expect("text");
    assert!(text.contains("volume       8.0\n") && text.contains("defects      none\n"), "{text}");
    let fed = bench.feed("info - --format ply --json", &bench.get("whole.ply")).json();
    assert_eq!(fed["volume"], 8.0);
}

#[test]
fn booleans_of_files_in_any_format() {
    let bench = Bench::new();
    bench
        .put_mesh("a.stl", &cube(0.0, 2.0))
        .put_mesh("b.ply", &cube(1.0, 3.0))
        .put_mesh("c.off", &cube(5.0, 6.0));
    let cases =
        [("union", 8.0 + 7.0 + 1.0), ("difference", 7.0), ("intersection", 0.0), ("xor", 7.0 + 7.0 + 1.0)];
    for (operation, expected) in cases {
        let ran = bench.run(&format!("boolean {operation} a.stl b.ply c.off -o out.obj -o out.stl"));
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert_eq!(
            (volume(&bench.mesh("out.obj")), volume(&bench.mesh("out.stl"))),
            (expected, expected),
            "{operation}"
        );
    }
    let ran = bench.run("boolean intersection a.stl b.ply -o - --format off -q");
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
    assert_eq!(volume(&read_mesh(Format::Off, &ran.out).expect("a mesh")), 1.0);
}

#[test]
fn an_operand_that_is_open_leaves_the_old_result() {
    let bench = Bench::new();
    let mut open = cube(0.0, 1.0);
    open.triangles.pop();
    bench.put_mesh("a.obj", &cube(0.0, 1.0)).put_mesh("open.obj", &open).put("out.obj", "old");
    bench.fails("boolean union a.obj open.obj -o out.obj", 1, &["open.obj", "3 open edges"]);
    assert_eq!(bench.get("out.obj"), b"old");
}

#[test]
fn a_reader_that_leaves_is_no_error() {
    let bench = Bench::new();
    bench.put_mesh("a.stl", &cube(0.0, 1.0));
    for line in ["info a.stl", "boolean union a.stl -o - --format obj"] {
        let mut command = bench.command(line);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program");
        drop(child.stdout.take());
        let ran = Ran::from(child.wait_with_output().expect("the program"));
        assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""), "{line}");
    }
}
