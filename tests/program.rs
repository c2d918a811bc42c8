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
    for command in ["build", "check", "info", "boolean", "builtins"] {
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

const NOTCHED: &str = "size = 2;\ndifference() {\n  cube(size);\n  translate([1, 1, 1]) cube(size);\n}\n";

#[test]
fn a_script_becomes_files() {
    let bench = Bench::new();
    bench.put("a.scad", NOTCHED).put("out.obj", "old");
    let ran = bench.run("build a.scad -o out.obj -o out.stl -o out.off -o out.ply --strict --jobs 2");
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    for name in ["out.obj", "out.stl", "out.off", "out.ply"] {
        assert_eq!(volume(&bench.mesh(name)), 7.0, "{name}");
        assert!(ran.err.contains(&format!("{name}: ")), "{}", ran.err);
    }
    let summary = bench.run("build a.scad -D size=4 --summary json").json();
    assert_eq!((&summary["volume"], &summary["closed"]), (&37.0.into(), &true.into()));
    assert_eq!((&summary["genus"], &summary["components"]), (&0.into(), &1.into()));
    assert!(summary["seconds"]["build"].as_f64().expect("seconds") >= 0.0);
    let fed = bench.feed("build - -o - --format stl-ascii -q", NOTCHED.as_bytes());
    assert_eq!(volume(&read_mesh(Format::StlAscii, &fed.out).expect("a mesh")), 7.0);
    let region = bench.feed("build - --summary json", b"square(3);").json();
    assert_eq!((&region["dimension"], &region["area"]), (&2.into(), &9.0.into()));
}

#[test]
fn errors_point_and_leave_the_old_result() {
    let bench = Bench::new();
    bench.put("typo.scad", "cube(1);\nshpere(2);\n").put("syntax.scad", "cube(1;\n").put("a.obj", "old");
    bench
        .put("flat.scad", "square(1);\n")
        .put("open.scad", "import(\"open.off\");\n")
        .put("far.scad", "cube(1e300);\n");
    bench.put("main.scad", "include <gone.scad>\ncube(1);\n").put("import.scad", "import(\"cut.stl\");\n");
    bench.put("cut.stl", "solid\nfacet\n").put("ring.scad", "include <ring.scad>\ncube(1);\n");
    let mut open = cube(0.0, 1.0);
    open.triangles.pop();
    bench.put_mesh("open.off", &open);
    bench.fails("build syntax.scad -o a.obj", 1, &["syntax.scad:1:7", "cube(1;", "^"]);
    bench.fails("build flat.scad -o a.obj", 1, &["plane region", "linear_extrude"]);
    bench.fails("build open.scad -o a.obj", 1, &["open edges"]);
    bench.fails("build open.scad -o a.obj --strict", 4, &["open edges"]);
    bench.fails("build far.scad -o a.obj -o a.stl", 1, &["a.stl: vertex", "f32"]);
    assert_eq!(bench.get("a.obj"), b"old");
    let typo = bench.run("check typo.scad").err;
    for part in ["typo.scad:2:1", "2 | shpere(2);", "^^^^^^", "sphere"] {
        assert!(typo.contains(part), "{part}: {typo}");
    }
    let typo = bench.run("check typo.scad --oneline").err;
    assert!(typo.contains(" in file typo.scad, line 2\n"), "{typo}");
    for (script, part) in
        [("main", "gone.scad"), ("import", "cut.stl: line 3: the file ends"), ("ring", "ring.scad")]
    {
        let ran = bench.run(&format!("check {script}.scad"));
        assert!(ran.code == Some(0) || ran.code == Some(1), "{script}: {ran:?}");
        assert!(ran.err.contains(part), "{script}: {}", ran.err);
    }
}

#[test]
fn limits_have_their_own_exit_code() {
    let bench = Bench::new();
    bench.put("loop.scad", "for (i = [1 : 1e9]) { x = i; }\n").put("sphere.scad", "sphere(1, $fn = 1e7);\n");
    bench.put("deep.scad", "function f(n) = 1 + f(n + 1);\necho(f(0));\n");
    bench.put("forever.scad", "function f(n) = f(n + 1);\necho(f(0));\n");
    bench.fails("check loop.scad --limit-steps 10000", 3, &["loop.scad"]);
    bench.fails("check forever.scad --limit-steps 10000", 3, &["forever.scad"]);
    bench.fails("check forever.scad --limit-seconds 0.2", 3, &["0.2 s"]);
    bench.fails("check deep.scad --limit-depth 100", 3, &["deep.scad"]);
    bench.fails("check deep.scad", 3, &["deep.scad"]);
    bench.fails("build sphere.scad -o x.obj", 3, &["sphere.scad"]);
}

#[test]
fn scripts_say_things_on_standard_error() {
    let bench = Bench::new();
    bench.put("say.scad", "echo(\"hi\", 1);\nfor (i = [0 : 99]) cube(nothing);\n");
    let ran = bench.run("check say.scad");
    assert_eq!((ran.code, ran.out.as_slice()), (Some(0), &b""[..]), "{}", ran.err);
    assert!(ran.err.starts_with("ECHO: \"hi\", 1\n"), "{}", ran.err);
    assert!(ran.err.contains("more warnings about the same places"), "{}", ran.err);
    assert!(ran.err.len() < 4000, "{}", ran.err);
    assert_eq!(bench.run("check say.scad -q").err, "");
    let plain = bench.run("check say.scad").err;
    let colored = bench.run("check say.scad --color always").err;
    assert!(colored.contains('\u{1b}') && !plain.contains('\u{1b}'));
    bench.put("latin.scad", b"// caf\xe9\necho(\"\xfc\");\n");
    let latin = bench.run("check latin.scad").err;
    assert!(latin.contains("Latin-1") && latin.contains("ECHO: \"\u{fc}\""), "{latin}");
}

#[test]
fn scripts_read_only_what_they_may() {
    let bench = Bench::new();
    bench.put("a/main.scad", "use <lib.scad>\nimport(\"../b/part.off\");\npart();\n");
    bench.put("a/lib.scad", "module part() cube(2);\n").put_mesh("b/part.off", &cube(5.0, 6.0));
    let refused = bench.run("build a/main.scad --summary json");
    assert!(refused.err.contains("--allow"), "{}", refused.err);
    let allowed = bench.run("build a/main.scad --summary json --allow b").json();
    assert_eq!(allowed["volume"], 9.0);
    bench.put("far.scad", "use <lib.scad>\npart();\n");
    let mut command = bench.command("build far.scad --summary json");
    let ran = Ran::from(command.env("OPENSCADPATH", "a").output().expect("the program"));
    assert_eq!(ran.json()["volume"], 8.0);
}

#[test]
fn builtins_are_listed() {
    let bench = Bench::new();
    let all = String::from_utf8(bench.run("builtins").out).expect("text");
    for part in ["Modules\n", "Functions\n", "  cube(", "  lookup("] {
        assert!(all.contains(part), "{part}: {all}");
    }
    let one = String::from_utf8(bench.run("builtins cube").out).expect("text");
    assert!(one.lines().count() == 3 && one.contains("cube("), "{one}");
    bench.fails("builtins cubes", 1, &["cubes"]);
}

/// What the README shows works as it stands there.
#[test]
fn scripts_of_the_readme() {
    let readme = fs::read_to_string("README.md").expect("the README");
    let blocks: Vec<&str> = readme
        .split("```openscad\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap_or_default())
        .collect();
    assert_eq!(blocks.len(), 5);
    let bench = Bench::new();
    bench.put("fixtures/patches/teapot.bpt", fs::read("fixtures/patches/teapot.bpt").expect("the teapot"));
    for (i, block) in blocks.into_iter().enumerate() {
        let summary = bench.put("block.scad", block).run("build block.scad --summary json").json();
        assert_eq!(summary["closed"], true, "block {i}: {summary}");
        assert_eq!(summary["warnings"], 0, "block {i}: {summary}");
        assert!(summary["volume"].as_f64().is_some_and(|volume| volume > 1.0), "block {i}: {summary}");
    }
}
