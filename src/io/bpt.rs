//! The classic text format of Bézier patches: the number of patches, then for each its degrees in u and in v and its
//! control points, those along v running fastest.

use super::text::{Shortest, Words, parse};
use super::{Problem, ReadError, WriteError};
use crate::math::Vec3;
use crate::surface::{Patch, SurfaceError};
use std::io::{BufWriter, Write};

/// Fewest bytes of a patch: degrees and one point with their spaces. No count can ask for more room than its bytes give.
const SHORTEST_PATCH: usize = 10;

/// Reads patches of any degrees; words may be parted by any space, and `#` begins a comment.
///
/// ```
/// let text = b"1\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 1\n";
/// let patches = ogee::io::bpt::read(text)?;
/// assert_eq!(patches[0].degrees(), [1, 1]);
/// # Ok::<(), ogee::io::ReadError>(())
/// ```
///
/// # Errors
/// Where the text breaks this form, a coordinate is not finite, a degree is above what [`Patch::new`] takes, or more
/// follows the last patch.
pub fn read(bytes: &[u8]) -> Result<Vec<Patch>, ReadError> {
    const COUNT: &str = "the number of patches";
    let mut words = Words::new(bytes).with_comments(b'#');
    let word = words.expect(COUNT)?;
    let count: usize = parse(word).ok_or_else(|| words.error(COUNT, word))?;
    let mut patches = Vec::with_capacity(count.min(bytes.len() / SHORTEST_PATCH));
    for _ in 0..count {
        patches.push(patch(&mut words, bytes.len())?);
    }
    match words.word() {
        Some(word) => Err(words.error("the end of the file after the last patch", word)),
        None => Ok(patches),
    }
}

fn patch(words: &mut Words<'_>, size: usize) -> Result<Patch, ReadError> {
    const DEGREE: &str = "a degree";
    let mut degree = || {
        let word = words.expect(DEGREE)?;
        parse::<usize>(word).ok_or_else(|| words.error(DEGREE, word))
    };
    let degrees = [degree()?, degree()?];
    let line = words.line();
    let refuse =
        |error: SurfaceError| ReadError::line(line, Problem::Malformed { reason: error.to_string() });
    crate::surface::check_degrees(degrees).map_err(refuse)?;
    let count = (degrees[0] + 1) * (degrees[1] + 1);
    let mut points = Vec::with_capacity(count.min(size));
    for _ in 0..count {
        let mut coordinate = || {
            let (line, number) = (words.line(), words.number("three coordinates")?);
            let infinite = ReadError::line(line, Problem::OutOfRange);
            if number.is_finite() { Ok(number) } else { Err(infinite) }
        };
        points.push(Vec3::new(coordinate()?, coordinate()?, coordinate()?));
    }
    Patch::new(degrees, points).map_err(refuse)
}

/// Writes patches; coordinates are printed with the fewest digits that read back to the same bits.
///
/// # Errors
/// What `out` reports.
pub fn write(patches: &[Patch], out: &mut dyn Write) -> Result<(), WriteError> {
    let mut out = BufWriter::with_capacity(1 << 16, out);
    writeln!(out, "{}", patches.len())?;
    for patch in patches {
        let [m, n] = patch.degrees();
        writeln!(out, "{m} {n}")?;
        for p in patch.points() {
            writeln!(out, "{} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
        }
    }
    Ok(out.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn number() -> impl Strategy<Value = f64> {
        let any_bits = any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite());
        prop_oneof![prop::sample::select(vec![0.0, -0.0, 0.1, 5e-324, f64::MAX]), any_bits, -1e3..1e3_f64]
    }

    proptest! {
        #[test]
        fn reading_back_gives_the_same_bits(
            degrees in prop::array::uniform2(0_usize..4),
            numbers in prop::collection::vec(prop::array::uniform3(number()), 16),
            damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
        ) {
            let count = (degrees[0] + 1) * (degrees[1] + 1);
            let patch = Patch::new(degrees, numbers[..count].iter().copied().map(Vec3::from).collect()).unwrap();
            let mut bytes = Vec::new();
            write(&[patch.clone(), patch.transposed()], &mut bytes).unwrap();
            let back = read(&bytes).unwrap();
            let bits = |patch: &Patch| patch.points().iter().map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
            prop_assert_eq!(bits(&back[0]), bits(&patch));
            prop_assert_eq!(back[1].degrees(), [degrees[1], degrees[0]]);
            // No bytes make it panic, or hold more than they pay for.
            for (place, byte) in damage {
                let place = place.index(bytes.len());
                bytes[place] = byte;
            }
            if let Ok(back) = read(&bytes) {
                prop_assert!(back.iter().map(|patch| patch.points().len()).sum::<usize>() <= bytes.len());
            }
        }
    }

    #[test]
    fn errors_name_the_line() {
        let cases = [
            ("", "line 1: the file ends where the number of patches should follow"),
            ("x", "line 1: expected the number of patches, found `x`"),
            ("2\n0 0\n1 2 3\n", "line 4: the file ends where a degree should follow"),
            ("1\n0 -1\n", "line 2: expected a degree, found `-1`"),
            ("1\n0 201\n", "line 2: degree 201 where 200 is the highest"),
            ("1\n1 0\n1 2 3\n1 2 z\n", "line 4: expected three coordinates, found `z`"),
            ("1\n0 0\n1 2 nan\n", "line 3: coordinates leave the range of numbers"),
            ("1\n0 0\n1 2 3\n4", "line 4: expected the end of the file after the last patch, found `4`"),
            (
                "18446744073709551615\n18446744073709551615 0\n",
                "line 2: degree 18446744073709551615 where 200 is the highest",
            ),
        ];
        for (text, expected) in cases {
            assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), expected, "{text}");
        }
        assert_eq!(read(b"0").unwrap(), []);
    }
}
