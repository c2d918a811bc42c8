//! `ogee plot` and `ogee info` of drawings, as their users meet them.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn ogee(folder: &Path, line: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_ogee"));
    command.args(line.split(' ')).current_dir(folder).output().expect("the program")
}

fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let files = [
        (
            "a.svg",
            "<svg xmlns='http://www.w3.org/2000/svg'><path id='arch' d='M0 0C30 60 70 60 100 0'/>\n<circle cx='50' cy='20' r='10'/>\n<rect width='3' height='4'/><path d='M0 0L3 4M0 0H1'/></svg>",
        ),
        ("bad.svg", "<svg xmlns='http://www.w3.org/2000/svg'>\n<path d='M0 0L1'/></svg>"),
        ("points.csv", "0,0\n1,2\n3,1\n"),
        ("chart.csv", "method,time,error\na,1e-6,1e-3\nb,1e-5,1e-4\na,1e-4,1e-9\nb,1e-3,1e-12\n"),
        ("bad.csv", "x,y\n1,2\n3,four\n"),
        ("lists.json", "{\"one\": [[0, 0], [1, 1]], \"two\": [[0, 1], [1, 0], [2, 5]]}"),
        ("flat.scad", "difference() { circle(10); square(5); }"),
        ("solid.scad", "cube(1);"),
    ];
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).expect("a file"));
    folder
}

fn error(ran: &Output) -> String {
    String::from_utf8_lossy(&ran.stderr).into_owned()
}

#[test]
fn measures_of_drawings() {
    let folder = folder();
    let ran = ogee(folder.path(), "info a.svg --json");
    assert!(ran.status.success(), "{}", error(&ran));
    let found: serde_json::Value = serde_json::from_slice(&ran.stdout).expect("JSON");
    let number = |k: usize, name: &str| found["paths"][k][name].as_f64().expect("a number");
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} {expected}");
    };
    assert_eq!(found["paths"].as_array().map(Vec::len), Some(4));
    near(number(0, "length"), 141.217_498_362_787_72);
    near(number(0, "area"), -3060.0);
    near(number(1, "length"), 20.0 * std::f64::consts::PI);
    near(number(1, "area"), 100.0 * std::f64::consts::PI);
    near(number(3, "length"), 6.0);
    let fixed = |k: usize, name: &str| found["paths"][k][name].to_string();
    let top = found["paths"][0]["box"][3].as_f64().expect("a number");
    assert!((45.0..45.0 + 1e-13).contains(&top), "{top}");
    assert_eq!(fixed(1, "box"), "[40.0,10.0,60.0,30.0]");
    assert_eq!(
        (fixed(2, "area"), fixed(2, "segments"), fixed(2, "closed")),
        ("12.0".into(), "4".into(), "true".into())
    );
    assert_eq!((fixed(3, "segments"), fixed(3, "closed")), ("2".into(), "false".into()));
    let text = ogee(folder.path(), "info a.svg");
    assert!(
        String::from_utf8_lossy(&text.stdout).contains("line 1 path #arch\nlength       141.2174983627877")
    );
}

#[test]
fn every_kind_of_input_is_drawn() {
    let folder = folder();
    for (k, line) in [
        "a.svg",
        "a.svg --show points,polygon,construction=0.3,tangents,normals,curvature,hull,box,inflections,intersections,joints",
        "points.csv --closed --dark",
        "points.csv --style points",
        "chart.csv --x time --y error --by method --log xy --title Chart",
        "lists.json --aspect free --background none",
        "flat.scad --show joints -D $fn=12",
    ]
    .into_iter()
    .enumerate()
    {
        for size in ["200x200", "640x480"] {
            for ending in ["svg", "png"] {
                let name = format!("{k}.{ending}");
                let ran = ogee(folder.path(), &format!("plot {line} -o {name} --size {size}"));
                assert!(ran.status.success(), "{line}: {}", error(&ran));
                let bytes = fs::read(folder.path().join(&name)).expect("a picture");
                if ending == "svg" {
                    let drawing = ogee::io::svg::read(&bytes).expect("an SVG that reads back");
                    assert!(drawing.shapes.len() > 3, "{line}");
                    assert!(drawing.ignored.iter().any(|(name, _)| name == "text"), "{line}");
                } else {
                    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n") && bytes.len() > 1000, "{line}");
                }
            }
        }
    }
    let same = |name: &str| fs::read(folder.path().join(name)).expect(name);
    let before = same("1.png");
    assert!(ogee(folder.path(), "plot a.svg -o 1.png --size 640x480 --jobs 3 --show points,polygon,construction=0.3,tangents,normals,curvature,hull,box,inflections,intersections,joints").status.success());
    assert_eq!(same("1.png"), before, "the same figure has the same bytes");
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let folder = folder();
    fs::write(folder.path().join("old.svg"), "old").expect("a file");
    for (line, code, part) in [
        (
            "plot bad.svg -o old.svg",
            1,
            "bad.svg: line 2, column 16: the value ends where a number should follow",
        ),
        ("info bad.svg", 1, "bad.svg: line 2, column 16"),
        ("plot bad.csv -o old.svg", 1, "bad.csv: line 3: expected a number, found `four`"),
        ("plot chart.csv -o old.svg --x tim", 1, "there is no column `tim`; there are method, time, error"),
        ("plot points.csv -o old.svg --log y", 1, "0 has no place on a logarithmic axis"),
        ("plot solid.scad -o old.svg", 1, "`ogee render` draws it"),
        ("plot none.svg -o old.svg", 1, "there is no such file"),
        ("plot a.svg -o old.jpg", 2, "figures are written as .svg or .png"),
        ("plot a.svg -o -", 2, "needs --format"),
        ("plot a.svg -o old.svg --show pionts", 2, "`pionts` is none of points, polygon"),
        ("plot a.svg -o old.svg --size 9x9", 2, "sides from 32"),
        ("plot a.svg -o no/where.svg", 1, "there is no folder"),
        ("render a.svg -o old.png", 1, "`ogee plot` draws it"),
        ("build a.svg -o old.obj", 1, "see `ogee info` and `ogee plot`"),
    ] {
        let ran = ogee(folder.path(), line);
        assert_eq!(ran.status.code(), Some(code), "{line}: {}", error(&ran));
        assert!(error(&ran).contains(part), "{line}: {}", error(&ran));
    }
    assert_eq!(fs::read(folder.path().join("old.svg")).expect("a file"), b"old");
}
