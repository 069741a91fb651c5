//! A few linear equations.

use super::Number;

/// Solves matrix x = right for `R` right-hand sides by elimination with row pivoting. Of a singular
/// matrix the vanishing pivots are taken as tiny, so that the answer is finite.
#[inline]
#[expect(clippy::needless_range_loop, reason = "elimination reads best by row and column")]
pub(crate) fn solve<T: Number, const D: usize, const R: usize>(
    mut matrix: [[T; D]; D],
    mut right: [[T; R]; D],
) -> [[T; R]; D] {
    for column in 0..D {
        let mut pivot = column;
        let mut largest = matrix[column][column].magnitude_squared();
        for row in column + 1..D {
            let size = matrix[row][column].magnitude_squared();
            if size > largest {
                (pivot, largest) = (row, size);
            }
        }
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        if largest < 1e-60 {
            matrix[column][column] = T::from(1e-30);
        }
        let inverse = T::from(1.0) / matrix[column][column];
        for row in column + 1..D {
            let factor = matrix[row][column] * inverse;
            for i in column + 1..D {
                let term = factor * matrix[column][i];
                matrix[row][i] -= term;
            }
            for i in 0..R {
                let term = factor * right[column][i];
                right[row][i] -= term;
            }
        }
        // The diagonal keeps its reciprocals for the way back.
        matrix[column][column] = inverse;
    }
    for row in (0..D).rev() {
        for i in 0..R {
            let mut sum = right[row][i];
            for column in row + 1..D {
                sum -= matrix[row][column] * right[column][i];
            }
            right[row][i] = sum * matrix[row][row];
        }
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_needs_pivoting() {
        let matrix = [
            [0.0, 2.0, 0.0, 1.0],
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -4.0],
            [0.0, 1.0, 3.0, 0.0],
        ];
        let x: [[f64; 1]; 4] = solve(matrix, [[8.0], [1.0], [-16.0], [11.0]]);
        assert_eq!(x, [[1.0], [2.0], [3.0], [4.0]]);
    }
}
