//! Points and numbers in rows of text, separated by commas.

use super::text::{Shortest, parse};
use super::{Problem, ReadError, WriteError};
use crate::math::Vec3;
use std::io::{BufWriter, Write};

/// Reads points, one a row: x, y and z, separated by commas, semicolons, tabs or spaces. A first row whose first entry
/// is no number is a header. Empty rows, and those that begin with `#`, are passed over.
///
/// # Errors
/// A row that does not have three numbers.
pub fn read_points(bytes: &[u8]) -> Result<Vec<Vec3>, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut points = Vec::new();
    let mut first = true;
    for (line, row) in (1..).zip(bytes.split(|&b| b == b'\n')) {
        let row = row.trim_ascii();
        if row.is_empty() || row.starts_with(b"#") {
            continue;
        }
        let entries = entries(row);
        let header = first && entries.first().is_some_and(|entry| parse::<f64>(entry).is_none());
        first = false;
        if !header {
            points.push(point(&entries, line)?);
        }
    }
    Ok(points)
}

/// What stands between separators; blanks around a comma or semicolon mean nothing.
fn entries(row: &[u8]) -> Vec<&[u8]> {
    if row.iter().any(|b| matches!(b, b',' | b';')) {
        row.split(|b| matches!(b, b',' | b';')).map(<[u8]>::trim_ascii).collect()
    } else {
        row.split(u8::is_ascii_whitespace).filter(|entry| !entry.is_empty()).collect()
    }
}

fn point(entries: &[&[u8]], line: usize) -> Result<Vec3, ReadError> {
    const EXPECTED: &str = "three numbers";
    let mut coordinates = [0.0; 3];
    for (slot, index) in coordinates.iter_mut().zip(0..) {
        let entry = entries.get(index).ok_or(ReadError::line(line, Problem::Ended { expected: EXPECTED }))?;
        *slot = parse(entry).ok_or_else(|| ReadError::line(line, Problem::expected(EXPECTED, entry)))?;
    }
    match entries.get(3) {
        None => Ok(coordinates.into()),
        Some(more) => Err(ReadError::line(line, Problem::expected("the end of the row", more))),
    }
}

/// Writes rows of numbers under a header, with the fewest digits that read back to the same bits.
///
/// # Errors
/// What `out` reports.
pub fn write<const N: usize>(
    header: [&str; N],
    rows: impl Iterator<Item = [f64; N]>,
    out: &mut dyn Write,
) -> Result<(), WriteError> {
    let mut out = BufWriter::with_capacity(1 << 16, out);
    writeln!(out, "{}", header.join(","))?;
    for row in rows {
        for (i, &number) in row.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(out, "{comma}{}", Shortest(number))?;
        }
        writeln!(out)?;
    }
    Ok(out.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_as_others_write_them() {
        let expected = vec![Vec3::new(1.0, 2.0, 3.0), Vec3::new(-0.5, 1e3, 0.0)];
        for text in [
            "1,2,3\n-0.5,1e3,0\n",
            "x,y,z\r\n1, 2, 3\r\n-0.5, 1000, 0",
            "\u{feff}\"x\";y;z\n1;2;3\n\n# c\n-.5;1e3;0",
            "1 2\t3\n -0.5  1000 0 \n",
        ] {
            assert_eq!(read_points(text.as_bytes()), Ok(expected.clone()), "{text}");
        }
        assert_eq!(read_points(b""), Ok(Vec::new()));
    }

    #[test]
    fn errors_name_the_line() {
        let cases = [
            ("1,2", "line 1: the file ends where three numbers should follow"),
            ("x,y,z\n1,2,three", "line 2: expected three numbers, found `three`"),
            ("1,2,3\nx,y,z", "line 2: expected three numbers, found `x`"),
            ("1,2,3,4", "line 1: expected the end of the row, found `4`"),
            ("1,,3", "line 1: expected three numbers, found ``"),
        ];
        for (text, expected) in cases {
            assert_eq!(read_points(text.as_bytes()).unwrap_err().to_string(), expected, "{text}");
        }
    }

    #[test]
    fn numbers_keep_their_bits() {
        let mut bytes = Vec::new();
        write(["a", "b"], [[0.1, f64::NAN], [-0.0, f64::INFINITY]].into_iter(), &mut bytes).expect("memory");
        assert_eq!(String::from_utf8(bytes).expect("text"), "a,b\n0.1,NaN\n-0,inf\n");
    }
}
