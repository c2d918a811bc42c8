//! The text format of fidget and libfive for formulas: one operation a line.
//!
//! ```text
//! # a circle
//! _0 var-x
//! _1 square _0
//! _2 var-y
//! _3 square _2
//! _4 add _1 _3
//! _5 sqrt _4
//! _6 const 1
//! _7 sub _5 _6
//! ```
//!
//! A line is a name of its own, an operation ([`Unary::name`], [`Binary::name`], `var-x`, `var-y`, `var-z`, `const`), and
//! the names of earlier lines or, after `const`, a number. A name that comes again is from then on the later line's.
//! `#` begins a comment. The last line is the formula.

use super::text::{Shortest, Words, parse};
use super::{Problem, ReadError, WriteError};
use crate::sdf::{Binary, Expr, Operation, Unary};
use std::collections::HashMap;
use std::io::{BufWriter, Write};

/// Reads a formula. Time and memory are bounded by the length of `bytes`.
///
/// # Errors
/// Where a line is not of this form, names an operation or another line that is not there, and where there is no line.
///
/// ```
/// use ogee::math::Vec3;
///
/// let formula = ogee::io::vm::read(b"x var-x\ny var-y\nsum add x y")?;
/// assert_eq!(formula.eval(Vec3::new(1.0, 2.0, 0.0)), 3.0);
/// # Ok::<(), ogee::io::ReadError>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<Expr, ReadError> {
    let mut words = Words::new(bytes).with_comments(b'#');
    let mut named: HashMap<&[u8], Expr> = HashMap::new();
    let mut last = None;
    while let Some(name) = words.word() {
        let expr = operation(&mut words, &named)?;
        if let Some(more) = words.on_line() {
            return Err(words.error("the end of the line", more));
        }
        named.insert(name, expr.clone());
        last = Some(expr);
    }
    last.ok_or(ReadError::line(words.line(), Problem::Ended { expected: "a line such as `a var-x`" }))
}

/// What follows the name.
fn operation(words: &mut Words<'_>, named: &HashMap<&[u8], Expr>) -> Result<Expr, ReadError> {
    const OPERATION: &str = "an operation";
    let word = on_line(words, OPERATION)?;
    match word {
        b"var-x" => return Ok(Expr::x()),
        b"var-y" => return Ok(Expr::y()),
        b"var-z" => return Ok(Expr::z()),
        b"const" => {
            let number = on_line(words, "a number")?;
            return parse(number).map(Expr::constant).ok_or_else(|| words.error("a number", number));
        }
        _ => {}
    }
    let name = std::str::from_utf8(word).unwrap_or_default();
    // libfive's name for it.
    let name = if name == "log" { "ln" } else { name };
    let mut argument = || {
        let word = on_line(words, "the name of an earlier line")?;
        named.get(word).cloned().ok_or_else(|| words.error("the name of an earlier line", word))
    };
    if let Some(op) = Unary::from_name(name) {
        return Ok(Expr::unary(op, &argument()?));
    }
    if let Some(op) = Binary::from_name(name) {
        let (a, b) = (argument()?, argument()?);
        return Ok(Expr::binary(op, &a, &b));
    }
    Err(words.error(OPERATION, word))
}

/// The next word, which must be on the same line.
fn on_line<'a>(words: &mut Words<'a>, expected: &'static str) -> Result<&'a [u8], ReadError> {
    let line = words.line();
    words.on_line().ok_or(ReadError::line(line, Problem::Ended { expected }))
}

/// Writes a formula in operations that fidget reads, but for `cbrt` and `pow`; primitives and blends are taken apart.
/// Numbers are printed with the fewest digits that read back to the same bits.
///
/// # Errors
/// What `out` reports, and a formula of which a mesh, a polygon or another field is part.
pub fn write(formula: &Expr, out: &mut dyn Write) -> Result<(), WriteError> {
    let operations = formula.operations().ok_or(WriteError::NotAFormula)?;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    let mut name = 0_u32;
    let mut names = Vec::with_capacity(operations.len());
    for operation in operations {
        match operation {
            Operation::Axis(axis) => writeln!(out, "_{name} var-{}", ["x", "y", "z"][usize::from(axis)])?,
            Operation::Constant(x) => writeln!(out, "_{name} const {}", Shortest(x))?,
            Operation::Unary(Unary::Recip, a) => {
                writeln!(out, "_{name} const 1")?;
                name += 1;
                writeln!(out, "_{name} div _{} _{}", name - 1, names[a as usize])?;
            }
            Operation::Unary(op, a) => writeln!(out, "_{name} {} _{}", op.name(), names[a as usize])?,
            Operation::Binary(op, a, b) => {
                writeln!(out, "_{name} {} _{} _{}", op.name(), names[a as usize], names[b as usize])?;
            }
        }
        names.push(name);
        name += 1;
    }
    Ok(out.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::sdf::Implicit;

    fn value(text: &str, at: [f64; 3]) -> Result<f64, String> {
        read(text.as_bytes()).map(|f| f.eval(at.into())).map_err(|error| error.to_string())
    }

    #[test]
    fn texts_as_others_write_them() {
        let circle = "# comment\n0x60 var-x\n0xa0 square 0x60\r\n\n0x50 var-y # y\n  0xf0 square 0x50\n0x14 add 0xa0 0xf0\n\
                      0x19 sqrt 0x14\n0x1e const 1e0\n0x1f sub 0x19 0x1e";
        assert_eq!(value(circle, [3.0, 4.0, 9.0]), Ok(4.0));
        assert_eq!(value("a var-z\na neg a\na neg a\na log a", [0.0, 0.0, 1.0]), Ok(0.0));
        assert_eq!(value("x var-x\ny var-y\nz mod x y", [-1.0, 3.0, 0.0]), Ok(2.0));
    }

    #[test]
    fn errors_name_the_line() {
        let cases = [
            ("", "line 1: the file ends where a line such as `a var-x` should follow"),
            ("# nothing\n\n", "line 3: the file ends where a line such as `a var-x` should follow"),
            ("a\nb var-x", "line 1: the file ends where an operation should follow"),
            ("a var-w", "line 1: expected an operation, found `var-w`"),
            ("a var-x\nb nanfill a a", "line 2: expected an operation, found `nanfill`"),
            ("a var-x\nb add a c", "line 2: expected the name of an earlier line, found `c`"),
            ("a add a a", "line 1: expected the name of an earlier line, found `a`"),
            ("a var-x\nb add a", "line 2: the file ends where the name of an earlier line should follow"),
            ("a const 1,5", "line 1: expected a number, found `1,5`"),
            ("a var-x 2", "line 1: expected the end of the line, found `2`"),
        ];
        for (text, expected) in cases {
            assert_eq!(value(text, [0.0; 3]).unwrap_err(), expected, "{text}");
        }
    }

    #[test]
    fn what_is_no_formula_is_refused() {
        let cube = crate::mesh::cuboid(Vec3::ZERO, Vec3::ONE);
        let mesh = Implicit::mesh(&cube).expect("triangles");
        assert!(matches!(write(mesh.expr(), &mut Vec::new()), Err(WriteError::NotAFormula)));
    }

    #[test]
    fn long_chains_are_no_danger() {
        let mut text = String::from("_0 var-x\n");
        for i in 0..200_000 {
            text += &format!("_{} sin _{i}\n", i + 1);
        }
        let formula = read(text.as_bytes()).expect("a formula");
        assert!(formula.eval(Vec3::X) < 0.1);
        let mut bytes = Vec::new();
        write(&formula, &mut bytes).expect("memory");
        assert_eq!(bytes.len(), text.len());
    }
}
