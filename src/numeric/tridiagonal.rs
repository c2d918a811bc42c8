//! Systems with three diagonals, plain and closed in a ring.

use crate::math::Blend;
use std::fmt;

/// A system has no unique solution, as far as `f64` can tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// The row whose pivot vanished.
    pub row: usize,
}

impl fmt::Display for Singular {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the system of equations is singular at row {}", self.row)
    }
}

impl std::error::Error for Singular {}

/// A row of the matrix: the entries at columns `i - 1`, `i` and `i + 1`. In the first row the first entry, and in the
/// last row the last entry, stand outside of the matrix (or at the other end of a ring).
pub type Row = [f64; 3];

/// Solves the system in place of its right-hand side by Gaussian elimination with partial pivoting: linear time.
///
/// # Errors
/// [`Singular`] where a pivot is zero or not a number.
///
/// # Panics
/// When there are not as many rows as right-hand sides.
pub fn solve<P: Blend>(rows: &[Row], right: &mut [P]) -> Result<(), Singular> {
    let n = rows.len();
    assert_eq!(n, right.len(), "a right-hand side for each row");
    // After elimination a row holds its diagonal and two entries right of it.
    let mut upper: Vec<Row> = Vec::with_capacity(n);
    let Some(&first) = rows.first() else { return Ok(()) };
    let mut current = [first[1], if n > 1 { first[2] } else { 0.0 }, 0.0];
    for i in 0..n {
        if i + 1 < n {
            let mut next = [rows[i + 1][0], rows[i + 1][1], if i + 2 < n { rows[i + 1][2] } else { 0.0 }];
            if next[0].abs() > current[0].abs() {
                std::mem::swap(&mut current, &mut next);
                right.swap(i, i + 1);
            }
            check_pivot(current[0], i)?;
            let factor = next[0] / current[0];
            right[i + 1] = right[i + 1] - right[i] * factor;
            upper.push(current);
            current = [next[1] - factor * current[1], next[2] - factor * current[2], 0.0];
        } else {
            check_pivot(current[0], i)?;
            upper.push(current);
        }
    }
    for i in (0..n).rev() {
        let [diagonal, second, third] = upper[i];
        let mut value = right[i];
        if i + 1 < n {
            value = value - right[i + 1] * second;
        }
        if i + 2 < n {
            value = value - right[i + 2] * third;
        }
        right[i] = value.map(|x| x / diagonal);
    }
    Ok(())
}

/// Solves a system whose first and last row reach around the ends: Sherman, Morrison 1950.
///
/// # Errors
/// [`Singular`] as [`solve`].
///
/// # Panics
/// When there are fewer than three rows or not as many as right-hand sides.
pub fn solve_ring<P: Blend>(rows: &[Row], right: &mut [P]) -> Result<(), Singular> {
    let n = rows.len();
    assert!(n >= 3, "a ring of three rows or more");
    let (corner_low, corner_high) = (rows[n - 1][2], rows[0][0]);
    let gamma = -rows[0][1];
    let mut open = rows.to_vec();
    open[0][1] -= gamma;
    open[n - 1][1] -= corner_low * corner_high / gamma;
    let mut correction = vec![0.0; n];
    correction[0] = gamma;
    correction[n - 1] = corner_low;
    solve(&open, right)?;
    solve(&open, &mut correction)?;
    let along = corner_high / gamma;
    let denominator = 1.0 + correction[0] + along * correction[n - 1];
    check_pivot(denominator, n - 1)?;
    let share = (right[0] + right[n - 1] * along).map(|x| x / denominator);
    for (value, &weight) in right.iter_mut().zip(&correction) {
        *value = *value - share * weight;
    }
    Ok(())
}

fn check_pivot(pivot: f64, row: usize) -> Result<(), Singular> {
    if pivot == 0.0 || !pivot.is_finite() { Err(Singular { row }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn times(rows: &[Row], x: &[f64], ring: bool) -> Vec<f64> {
        let n = rows.len();
        let at = |i: usize, column: isize| -> f64 {
            let place = i as isize + column;
            if ring {
                x[place.rem_euclid(n as isize) as usize]
            } else {
                usize::try_from(place).ok().and_then(|place| x.get(place)).copied().unwrap_or(0.0)
            }
        };
        (0..n).map(|i| (0..3).map(|k| rows[i][k] * at(i, k as isize - 1)).sum()).collect()
    }

    proptest! {
        #[test]
        fn solutions_solve(
            rows in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 3..20),
            x in prop::collection::vec(-1.0..1.0_f64, 20),
            ring in any::<bool>(),
        ) {
            // Diagonally dominant, so that the answer is well defined.
            let rows: Vec<Row> = rows.iter().map(|r| [r[0], 2.5 + r[1], r[2]]).collect();
            let x = &x[..rows.len()];
            let mut right = times(&rows, x, ring);
            if ring { solve_ring(&rows, &mut right) } else { solve(&rows, &mut right) }.unwrap();
            for (got, want) in right.iter().zip(x) {
                prop_assert!((got - want).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn pivots_are_chosen_and_singular_systems_named() {
        let rows = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]];
        let x = [1.0, 2.0, 3.0];
        let mut right = times(&rows, &x, false);
        solve(&rows, &mut right).unwrap();
        assert_eq!(right, x);
        assert_eq!(solve(&[[0.0, 1.0, 1.0], [1.0, 1.0, 0.0]], &mut [1.0, 1.0]), Err(Singular { row: 1 }));
        assert_eq!(solve::<f64>(&[], &mut []), Ok(()));
    }
}
