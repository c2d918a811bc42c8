//! Tables of text: comma-separated values and their kin.

use super::text::Shortest;
use super::{Place, Problem, ReadError, WriteError};
use crate::math::Vec3;
use std::io::{BufWriter, Write};

/// Rows of cells under named columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Names of the columns; `1`, `2`, ... where the file names none.
    pub columns: Vec<String>,
    /// Whether the file names its columns.
    pub has_header: bool,
    /// The rows, without the header.
    pub rows: Vec<Row>,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The line of the file on which it starts.
    pub line: usize,
    /// Its cells, without the blanks around them; as many as there are columns.
    pub cells: Vec<String>,
}

impl Row {
    /// The number in a cell; `None` where the cell is empty.
    ///
    /// # Errors
    /// [`Problem::Expected`] for what is no finite number.
    ///
    /// # Panics
    /// When there is no such column.
    pub fn number(&self, column: usize) -> Result<Option<f64>, ReadError> {
        let cell = &self.cells[column];
        if cell.is_empty() {
            return Ok(None);
        }
        let number = cell.parse().ok().filter(|x: &f64| x.is_finite());
        let wrong = || ReadError::line(self.line, Problem::expected("a number", cell.as_bytes()));
        number.map(Some).ok_or_else(wrong)
    }
}

/// Reads a table. Cells are separated by what the first line is: commas, else semicolons, tabs or blanks; they may stand
/// in double quotes. Lines that start with `#` are comments. The first row names the columns when none of its cells
/// is a number.
///
/// # Errors
/// [`Problem::Unsupported`] for what is no text in UTF-8, and [`Problem::Expected`] with its line for a row that has
/// not as many cells as the first.
pub fn read(bytes: &[u8]) -> Result<Table, ReadError> {
    let unsupported = |what| ReadError { at: Place::Line(1), problem: Problem::Unsupported { what } };
    let text = std::str::from_utf8(bytes).map_err(|_| unsupported("a text that is not UTF-8"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let delimiter = delimiter(text);
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .has_headers(false)
        .flexible(true)
        .from_reader(text.as_bytes());
    let mut table = Table::default();
    for record in reader.records() {
        let record = record.map_err(|error| malformed(&error))?;
        let line = record.position().map_or(1, |position| line_of(text, position));
        let cells = record.iter().map(|cell| cell.trim().to_owned());
        // Blanks may stand in any number between cells.
        let cells: Vec<String> = cells.filter(|cell| delimiter != b' ' || !cell.is_empty()).collect();
        if cells.iter().all(String::is_empty) {
            continue;
        }
        push(&mut table, Row { line, cells })?;
    }
    Ok(table)
}

/// Reads points, one a row of a table: x, y and z.
///
/// # Errors
/// As [`read`], and [`Problem::Expected`] with its line for a row that is not three numbers.
pub fn read_points(bytes: &[u8]) -> Result<Vec<Vec3>, ReadError> {
    let table = read(bytes)?;
    let point = |row: &Row| {
        let wrong = |found| ReadError::line(row.line, Problem::Expected { expected: "three numbers", found });
        let mut coordinates = [0.0; 3];
        if row.cells.len() != 3 {
            return Err(wrong(format!("{} cells", row.cells.len())));
        }
        for (slot, column) in coordinates.iter_mut().zip(0..) {
            *slot = row.number(column)?.ok_or_else(|| wrong("an empty cell".to_owned()))?;
        }
        Ok(Vec3::from_array(coordinates))
    };
    table.rows.iter().map(point).collect()
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

fn push(table: &mut Table, row: Row) -> Result<(), ReadError> {
    if table.columns.is_empty() {
        table.has_header = row.cells.iter().all(|cell| cell.parse::<f64>().is_err());
        if table.has_header {
            table.columns = row.cells;
            return Ok(());
        }
        table.columns = (1..=row.cells.len()).map(|k| k.to_string()).collect();
    }
    if row.cells.len() != table.columns.len() {
        let found = format!("{} cells", row.cells.len());
        let problem = Problem::Expected { expected: "as many cells as in the first row", found };
        return Err(ReadError::line(row.line, problem));
    }
    table.rows.push(row);
    Ok(())
}

/// The line on which a record starts: its position is before the comments and blank lines above it.
fn line_of(text: &str, position: &csv::Position) -> usize {
    let rest = text.get(position.byte() as usize..).unwrap_or_default();
    let above = rest.lines().take_while(|line| line.is_empty() || line.starts_with('#'));
    position.line() as usize + above.count()
}

fn delimiter(text: &str) -> u8 {
    let first =
        text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    [b',', b';', b'\t'].into_iter().find(|&byte| first.as_bytes().contains(&byte)).unwrap_or(b' ')
}

fn malformed(error: &csv::Error) -> ReadError {
    let line = error.position().map_or(1, |position| position.line() as usize);
    ReadError::line(line, Problem::Malformed { reason: error.to_string() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str) -> Vec<Vec<Option<f64>>> {
        let table = read(text.as_bytes()).unwrap();
        let row = |row: &Row| (0..row.cells.len()).map(|k| row.number(k).unwrap()).collect();
        table.rows.iter().map(row).collect()
    }

    #[test]
    fn separators_and_headers() {
        let expected = vec![vec![Some(1.0), Some(-2.5)], vec![Some(3e5), None]];
        for text in [
            "1,-2.5\n3e5,\n",
            "x, y\n1 , -2.5\r\n\n3e5,",
            "# c\na;b\n1;-2.5\n3e5;\n",
            "a\tb\n1\t-2.5\n3e5\t\n",
        ] {
            assert_eq!(numbers(text), expected, "{text}");
        }
        assert_eq!(numbers("  1   2\n 3 4 \n"), [[Some(1.0), Some(2.0)], [Some(3.0), Some(4.0)]]);
        let named = read(b"\xef\xbb\xbf\"time, s\",error\n1,2\n").unwrap();
        assert_eq!((named.columns, named.has_header), (vec!["time, s".to_owned(), "error".to_owned()], true));
        assert_eq!(read(b"").unwrap(), Table::default());
    }

    #[test]
    fn errors_name_the_line() {
        assert_eq!(
            read(b"1,2\n3\n").unwrap_err().to_string(),
            "line 2: expected as many cells as in the first row, found `1 cells`"
        );
        let table = read(b"x,y\n1,2\n\n3,four\n").unwrap();
        assert_eq!(
            table.rows[1].number(1).unwrap_err().to_string(),
            "line 4: expected a number, found `four`"
        );
        let after = read(b"# one\n\n# two\nx,y\n# three\r\n\r\n1,2\n").unwrap();
        assert_eq!(after.rows[0].line, 7);
        assert!(read(b"1,nan\n").unwrap().rows[0].number(1).is_err());
        assert!(read(b"\xff").is_err());
    }

    #[test]
    fn points_as_others_write_them() {
        let expected = vec![Vec3::new(1.0, 2.0, 3.0), Vec3::new(-0.5, 1e3, 0.0)];
        for text in [
            "1,2,3\n-0.5,1e3,0\n",
            "x,y,z\r\n1, 2, 3\r\n-0.5, 1000, 0",
            "\u{feff}\"x\";y;z\n1;2;3\n\n# c\n-.5;1e3;0",
        ] {
            assert_eq!(read_points(text.as_bytes()), Ok(expected.clone()), "{text}");
        }
        assert_eq!(read_points(b""), Ok(Vec::new()));
    }

    #[test]
    fn what_is_no_point_is_named_with_its_line() {
        let cases = [
            ("1,2", "line 1: expected three numbers, found `2 cells`"),
            ("x,y,z\n1,2,three", "line 2: expected a number, found `three`"),
            ("1,2,3,4", "line 1: expected three numbers, found `4 cells`"),
            ("1,,3", "line 1: expected three numbers, found `an empty cell`"),
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
