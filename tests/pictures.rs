//! `ogee render` as its users meet it.

use ogee::math::Vec3;
use ogee::mesh::cuboid;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn ogee(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ogee"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program")
}

/// Width, height and whether there is an opacity channel, from the header of a PNG.
fn header(png: &[u8]) -> (u32, u32, bool) {
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    let number = |at: usize| u32::from_be_bytes([png[at], png[at + 1], png[at + 2], png[at + 3]]);
    (number(16), number(20), png[25] == 6)
}

fn folder() -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let mut obj = Vec::new();
    ogee::io::obj::write(cuboid(Vec3::ZERO, Vec3::ONE).mesh(), &mut obj).expect("an OBJ");
    fs::write(folder.path().join("cube.obj"), obj).expect("a file");
    fs::write(folder.path().join("cube.scad"), "color(\"red\") cube(1);").expect("a file");
    folder
}

#[test]
fn scripts_and_meshes_are_drawn() {
    let folder = folder();
    let draw = |arguments: &[&str], name: &str| {
        let ran = ogee(folder.path(), arguments);
        assert!(ran.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&ran.stderr));
        fs::read(folder.path().join(name)).expect(name)
    };
    let gray = draw(&["render", "cube.obj", "-o", "a.png", "--size", "90x60"], "a.png");
    assert_eq!(header(&gray), (90, 60, false));
    let red = draw(&["render", "cube.scad", "-o", "b.png", "--size", "90x60"], "b.png");
    assert_ne!(gray, red, "the script's colour shows");
    let material =
        draw(&["render", "cube.obj", "-o", "c.png", "--size", "90x60", "--material", "ff0000"], "c.png");
    assert_eq!(red, material);
    let clear =
        draw(&["render", "cube.obj", "-o", "d.png", "--size", "30x20", "--background", "none"], "d.png");
    assert_eq!(header(&clear), (30, 20, true));
}

#[test]
fn threads_change_no_byte() {
    let folder = folder();
    for (name, jobs) in [("1.png", "1"), ("4.png", "4")] {
        let ran = ogee(
            folder.path(),
            &["render", "cube.obj", "-o", name, "--jobs", jobs, "--edges", "--size", "200x150"],
        );
        assert!(ran.status.success());
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).expect(name);
    assert_eq!(bytes("1.png"), bytes("4.png"));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = folder();
    fs::write(folder.path().join("old.png"), "old").expect("a file");
    for (code, arguments) in [
        (2, vec!["render", "cube.obj", "-o", "old.jpg"]),
        (2, vec!["render", "cube.obj", "-o", "old.png", "--size", "0x10"]),
        (2, vec!["render", "cube.obj", "-o", "old.png", "--camera", "1,2,3"]),
        (1, vec!["render", "cube.obj", "-o", "old.png", "--camera", "1,2,3,1,2,3"]),
        (1, vec!["render", "none.obj", "-o", "old.png"]),
        (1, vec!["render", "cube.obj", "-o", "no/where.png"]),
    ] {
        let ran = ogee(folder.path(), &arguments);
        assert_eq!(ran.status.code(), Some(code), "{arguments:?}: {}", String::from_utf8_lossy(&ran.stderr));
        assert!(!ran.stderr.is_empty());
    }
    assert_eq!(fs::read(folder.path().join("old.png")).expect("a file"), b"old");
}
