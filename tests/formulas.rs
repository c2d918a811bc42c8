//! The program's door for formulas: the same bits on any number of threads, the report, and what is refused.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A ball of radius 0.8 without its half at negative x.
const HALF_BALL: &str = "x var-x\ny var-y\nz var-z\na square x\nb square y\nc square z\nd add a b\ne add d c\n\
    f sqrt e\nr const 0.8\ng sub f r\nh neg x\nout max g h\n";

fn ogee(folder: &Path, line: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ogee"));
    command.current_dir(folder).args(line.split(' ')).output().expect("the program runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn formulas_become_meshes() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("half.vm"), HALF_BALL).expect("written");
    for jobs in [1, 2] {
        let line = format!("build half.vm --tolerance 0.03 -o {jobs}.obj --jobs {jobs} --summary json");
        let done = ogee(folder.path(), &line);
        assert!(done.status.success(), "{}", text(&done.stderr));
        let summary: serde_json::Value = serde_json::from_slice(&done.stdout).expect("json");
        assert_eq!(summary["surface"]["certified"], 0.03);
        assert_eq!(summary["closed"], true);
        assert!(summary["seconds"]["certify"].is_number(), "{summary}");
        let volume = summary["volume"].as_f64().expect("a volume");
        assert!((volume - 2.0 / 3.0 * std::f64::consts::PI * 0.512).abs() < 0.06, "{volume}");
    }
    let [one, two] = [1, 2].map(|jobs| fs::read(folder.path().join(format!("{jobs}.obj"))).expect("a mesh"));
    assert!(one == two, "threads change nothing");
    let cut = ogee(folder.path(), "build half.vm --tolerance 0.05 --box 0.1,-1,-1,1,1,1 -o cut.stl");
    assert!(
        text(&cut.stderr).contains("the shape leaves the box and is cut off there"),
        "{}",
        text(&cut.stderr)
    );
}

#[test]
fn what_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("half.vm"), HALF_BALL).expect("written");
    fs::write(folder.path().join("plane.vm"), "x var-x\n").expect("written");
    fs::write(folder.path().join("cube.scad"), "cube(1);").expect("written");
    let cases = [
        ("build half.vm -o a.obj", 2, "a formula needs --tolerance"),
        ("build half.vm -o a.obj --tolerance -1", 1, "the tolerance must be positive and finite, it is -1"),
        ("build half.vm -o a.obj --tolerance 1 --box 0,0,0,1,1", 2, "six numbers are needed, there are 5"),
        ("build half.vm -o a.obj --tolerance 1 --box 0,0,0,1,1,0", 1, "is empty, flat or not finite"),
        ("build plane.vm -o a.obj --tolerance 1", 1, "is proven to hold the shape; give one"),
        ("build cube.scad -o a.obj --tolerance 0", 2, "--tolerance must be positive and finite, it is 0"),
        ("build half.vm -o a.obj --tolerance 1 --explain", 2, "--explain is for scripts"),
        ("info half.vm", 1, "this is a formula"),
    ];
    for (line, code, message) in cases {
        let done = ogee(folder.path(), line);
        assert_eq!(done.status.code(), Some(code), "{line}: {}", text(&done.stderr));
        assert!(text(&done.stderr).contains(message), "{line}: {}", text(&done.stderr));
        assert!(!folder.path().join("a.obj").exists(), "{line}");
    }
}
