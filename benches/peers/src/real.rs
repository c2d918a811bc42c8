//! Meshes that somebody modelled, and that were not made to be measured.

use ogee::boolean::{self, Tree};
use ogee::io::{bpt, ply};
use ogee::mesh::Mesh;
use ogee::tessellate::{SurfaceOptions, capped, patches};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The package that brings meshes of others: pyvista, under the MIT licence.
const PACKAGE: &str = "pyvista==0.49.1";

/// Its closed ones: a nut of 1046 triangles, an ant of 15 parts that overlap.
const FETCHED: [&str; 2] = ["nut", "ant"];

/// The names of the meshes that are there.
pub(crate) fn names() -> Vec<&'static str> {
    let fetched = FETCHED.into_iter().filter(|name| file(name).exists());
    std::iter::once("teapot").chain(fetched).collect()
}

/// A mesh without overlaps, so that both sides take it for the same solid.
pub(crate) fn mesh(name: &str) -> Mesh {
    let raw = match name {
        "teapot" => teapot(),
        other => ply::read(&fs::read(file(other)).expect("it was fetched")).expect("a PLY file"),
    };
    boolean::evaluate(&Tree::Leaf(0), &[&raw]).expect("closed").solid.into_mesh()
}

/// The teapot of the fixtures, its parts capped.
fn teapot() -> Mesh {
    let all = bpt::read(include_bytes!("../../../fixtures/patches/teapot.bpt")).expect("patches");
    let drawn = patches(&all, &SurfaceOptions::within(2e-3)).expect("within the tolerance");
    capped(&drawn.mesh, 0.0).expect("loops that can be capped")
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(".venv/real")
}

fn file(name: &str) -> PathBuf {
    folder().join(format!("pyvista/examples/{name}.ply"))
}

/// Fetches what is not there; without it, its cases are left out, which is said.
pub(crate) fn fetch(python: &Path) {
    if FETCHED.iter().all(|name| file(name).exists()) {
        return;
    }
    let run = |arguments: &[&str]| {
        Command::new(python).current_dir(folder()).args(arguments).status().is_ok_and(|done| done.success())
    };
    let fetched = fs::create_dir_all(folder()).is_ok()
        && run(&["-m", "pip", "download", "--quiet", "--no-deps", "--dest", ".", PACKAGE])
        && run(&[
            "-c",
            "import glob, zipfile\nfor name in glob.glob('pyvista-*.whl'): zipfile.ZipFile(name).extractall()",
        ]);
    if !fetched || !FETCHED.iter().all(|name| file(name).exists()) {
        eprintln!(
            "SKIPPED: {PACKAGE} could not be fetched, so there are no cases with {}",
            FETCHED.join(", ")
        );
    }
}
