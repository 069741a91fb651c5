//! The eigenvectors of an eigenvalue, which may be double.

use crate::wave::{Number, solve};

/// An eigenvector of `matrix` to the eigenvalue `q`, or to a double one the vector orthogonal to
/// `other`; `None` if there is none, as at grazing incidence.
///
/// This is inverse iteration: a shift by a few roundings brings out the eigenvector, a larger one
/// the plane of a double eigenvalue, against all else.
pub(super) fn eigenvector<T: Number>(
    matrix: &[[T; 4]; 4],
    q: T,
    other: Option<[T; 4]>,
) -> Option<[T; 4]> {
    let size = norm(matrix.as_flattened()).max(1e-300);
    let shift = size * if other.is_some() { 1e-13 } else { 2e-16 };
    let mut shifted = *matrix;
    for (i, row) in shifted.iter_mut().enumerate() {
        row[i] -= q + T::from(shift);
    }
    let unit = other.map(normalized);
    let free = |vector: [T; 4]| match unit {
        Some(unit) => {
            let along = (0..4).fold(T::from(0.0), |sum, i| sum + unit[i].conjugate() * vector[i]);
            normalized(std::array::from_fn(|i| vector[i] - along * unit[i]))
        }
        None => normalized(vector),
    };
    // Off all axes and eigenvectors that symmetry might favour.
    let mut vector = free([0.53, -0.37, 0.61, 0.46].map(T::from));
    for _ in 0..3 {
        vector = free(solve(shifted, vector.map(|c| [c])).map(|[c]| c));
    }
    is_eigenvector(matrix, q, &vector).then_some(vector)
}

/// Whether a vector solves the eigenvalue equation well enough to go on with.
fn is_eigenvector<T: Number>(matrix: &[[T; 4]; 4], q: T, vector: &[T; 4]) -> bool {
    let residual: [T; 4] = std::array::from_fn(|i| {
        let image = (0..4).fold(T::from(0.0), |sum, j| sum + matrix[i][j] * vector[j]);
        image - q * vector[i]
    });
    let size = norm(matrix.as_flattened()) * norm(vector);
    size > 0.0 && norm(&residual) < 1e-9 * size
}

fn norm<T: Number>(vector: &[T]) -> f64 {
    vector.iter().map(|c| c.magnitude_squared()).sum::<f64>().sqrt()
}

fn normalized<T: Number>(vector: [T; 4]) -> [T; 4] {
    let scale = 1.0 / norm(&vector).max(1e-300);
    vector.map(|c| c * scale)
}
