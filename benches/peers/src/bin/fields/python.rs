//! The Python peers: scikit-image's marching cubes and manifold3d's level sets.

use ogee::sdf::{Binary, Operation, Unary};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The Python that has the pinned packages; made on the first run, `None` and said so where that cannot be.
pub(crate) fn environment(python: &str) -> Option<PathBuf> {
    let home = Path::new(env!("CARGO_MANIFEST_DIR")).join(".fields");
    let inside = home.join("bin/python");
    let works = || {
        let imports = ["-c", "import manifold3d, numpy, skimage.measure"];
        Command::new(&inside).args(imports).status().is_ok_and(|status| status.success())
    };
    if inside.exists() && works() {
        return Some(inside);
    }
    eprintln!("making {}", home.display());
    let made = Command::new(python).args(["-m", "venv"]).arg(&home).status();
    let install = ["-m", "pip", "install", "--quiet", "-r"];
    let requirements = Path::new(env!("CARGO_MANIFEST_DIR")).join("requirements-fields.txt");
    let installed = Command::new(&inside).args(install).arg(requirements).status();
    let good = made.is_ok_and(|s| s.success()) && installed.is_ok_and(|s| s.success()) && works();
    if !good {
        eprintln!("manifold3d and scikit-image cannot be had: their rows are left out");
    }
    good.then_some(inside)
}

/// The formula as the body of a function of x, y and z.
pub(crate) fn source(plain: &[Operation]) -> String {
    let mut text = String::from("def f(x, y, z):\n");
    for (id, operation) in plain.iter().enumerate() {
        let value = match *operation {
            Operation::Axis(axis) => ["x", "y", "z"][usize::from(axis)].to_owned(),
            Operation::Constant(x) => format!("{x:?}"),
            Operation::Unary(op, a) => unary(op, a),
            Operation::Binary(op, a, b) => binary(op, a, b),
        };
        writeln!(text, "    v{id} = {value}").expect("a string");
    }
    writeln!(text, "    return v{}", plain.len() - 1).expect("a string");
    text
}

fn unary(op: Unary, a: u32) -> String {
    match op {
        Unary::Neg => format!("-v{a}"),
        Unary::Recip => format!("1.0 / v{a}"),
        Unary::Square => format!("v{a} * v{a}"),
        _ => format!("{}(v{a})", op.name()),
    }
}

fn binary(op: Binary, a: u32, b: u32) -> String {
    match op {
        Binary::Add => format!("v{a} + v{b}"),
        Binary::Sub => format!("v{a} - v{b}"),
        Binary::Mul => format!("v{a} * v{b}"),
        Binary::Div => format!("v{a} / v{b}"),
        // A call of min costs as much as ten of these.
        Binary::Min => format!("v{a} if v{a} < v{b} else v{b}"),
        Binary::Max => format!("v{a} if v{a} > v{b} else v{b}"),
        _ => format!("{}(v{a}, v{b})", op.name()),
    }
}
