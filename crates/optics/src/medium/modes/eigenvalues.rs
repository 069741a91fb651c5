//! The eigenvalues of a 4 x 4 matrix.

use crate::wave::Number;
use num_complex::Complex64;

/// Steps at most; it takes about eight.
const MOST_STEPS: usize = 200;

/// After so many steps without a root the shifts may run in a circle.
const STRAY: usize = 10;

/// The eigenvalues by QR steps with two shifts (Francis 1961; Golub & Van Loan, Matrix Computations,
/// 7.5). Those of a real matrix are real or exactly conjugate. `None` if they are not found.
pub(super) fn eigenvalues<T: Number>(matrix: &[[T; 4]; 4]) -> Option<[Complex64; 4]> {
    let mut h = *matrix;
    for k in 0..2 {
        clear_below(&mut h, k, 3);
    }
    let mut values = [Complex64::ZERO; 4];
    // The part that is left is that up to `end`.
    let (mut end, mut steps) = (4, 0);
    for _ in 0..MOST_STEPS {
        if end == 0 {
            return Some(values);
        }
        let last = end - 1;
        let start = (1..end).rev().find(|i| is_small(&mut h, *i)).unwrap_or(0);
        if last - start < 2 {
            if start == last {
                values[last] = h[last][last].into();
            } else {
                [values[start], values[last]] = pair(&h, start);
            }
            (end, steps) = (start, 0);
            continue;
        }
        steps += 1;
        step(&mut h, start, last, steps % STRAY == 0);
    }
    None
}

/// Whether an entry below the diagonal is rounding; it is 0 then.
fn is_small<T: Number>(h: &mut [[T; 4]; 4], i: usize) -> bool {
    let size = |value: T| value.magnitude_squared().sqrt();
    let beside = size(h[i - 1][i - 1]) + size(h[i][i]);
    let small = size(h[i][i - 1]) <= f64::EPSILON * beside;
    if small {
        h[i][i - 1] = T::default();
    }
    small
}

/// The eigenvalues of a block of two on the diagonal.
fn pair<T: Number>(h: &[[T; 4]; 4], i: usize) -> [Complex64; 2] {
    let (a, b, c, d) = (h[i][i], h[i][i + 1], h[i + 1][i], h[i + 1][i + 1]);
    let (middle, half) = ((a + d) * 0.5, (a - d) * 0.5);
    let root = Into::<Complex64>::into(half * half + b * c).sqrt();
    let middle: Complex64 = middle.into();
    [middle + root, middle - root]
}

/// A step of the block from `start` to `last`, whose shifts are the eigenvalues of its last two rows
/// or, to leave a circle, any.
fn step<T: Number>(h: &mut [[T; 4]; 4], start: usize, last: usize, stray: bool) {
    let (a, b, c, d) = (h[last - 1][last - 1], h[last - 1][last], h[last][last - 1], h[last][last]);
    let (sum, product) = if stray {
        let size = (c.magnitude_squared() + h[last - 1][last - 2].magnitude_squared()).sqrt();
        (T::from(1.5 * size), T::from(size * size))
    } else {
        (a + d, a * d - b * c)
    };
    let (i, j) = (start, start + 1);
    let first = [
        h[i][i] * h[i][i] + h[i][j] * h[j][i] - sum * h[i][i] + product,
        h[j][i] * (h[i][i] + h[j][j] - sum),
        h[j][i] * h[j + 1][j],
    ];
    reflect(h, i, last, first);
    for k in start..last - 1 {
        clear_below(h, k, last);
    }
}

/// Makes the entries of a column zero from two below the diagonal on.
fn clear_below<T: Number>(h: &mut [[T; 4]; 4], column: usize, last: usize) {
    let at = column + 1;
    let entries =
        std::array::from_fn(|i| if at + i <= last { h[at + i][column] } else { T::default() });
    reflect(h, at, last, entries);
    for row in h.iter_mut().take(last + 1).skip(at + 1) {
        row[column] = T::default();
    }
}

/// Turns the rows and columns from `at` to `last`, three at most, by the mirror that takes `vector`
/// to the first of them.
#[expect(clippy::needless_range_loop, reason = "rows and columns read best alike")]
fn reflect<T: Number>(h: &mut [[T; 4]; 4], at: usize, last: usize, vector: [T; 3]) {
    let mut v = vector;
    let count = (last + 1 - at).min(3);
    let norm = |v: &[T]| v.iter().map(|c| c.magnitude_squared()).sum::<f64>();
    let length = norm(&v).sqrt();
    let rest = norm(&v[1..]);
    if rest == 0.0 {
        return;
    }
    let first = v[0].magnitude_squared().sqrt();
    let phase = if first > 0.0 { v[0] * (1.0 / first) } else { T::from(1.0) };
    v[0] += phase * length;
    let scale = 2.0 / norm(&v);
    for column in 0..4 {
        let sum =
            (0..count).fold(T::default(), |sum, i| sum + v[i].conjugate() * h[at + i][column]);
        for i in 0..count {
            h[at + i][column] -= v[i] * sum * scale;
        }
    }
    for row in h.iter_mut() {
        let sum = (0..count).fold(T::default(), |sum, i| sum + row[at + i] * v[i]);
        for i in 0..count {
            row[at + i] -= sum * v[i].conjugate() * scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix4, Schur};

    /// Numbers from -1 to 1.
    fn random(state: &mut u64) -> f64 {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let bits = (*state >> 11) as f64;
        bits / 4_503_599_627_370_496.0 - 1.0
    }

    fn assert_same(mut found: [Complex64; 4], mut expected: Vec<Complex64>) {
        for value in &mut found {
            let nearest = (0..expected.len())
                .min_by(|&a, &b| {
                    (expected[a] - *value).norm().total_cmp(&(expected[b] - *value).norm())
                })
                .expect("as many as are found");
            let other = expected.swap_remove(nearest);
            assert!((other - *value).norm() < 1e-12, "{other} {value}");
        }
    }

    #[test]
    fn they_are_those_of_a_library() {
        let mut state = 5;
        for _ in 0..2_000 {
            let real: [[f64; 4]; 4] = [[(); 4]; 4].map(|row| row.map(|()| random(&mut state)));
            let other = Matrix4::from_fn(|i, j| real[i][j]);
            let found = eigenvalues(&real).expect("eigenvalues");
            // Conjugates are exact.
            let imaginary: f64 = found.iter().map(|value| value.im).sum();
            assert_eq!(imaginary, 0.0);
            if well_conditioned(&found) {
                assert_same(found, other.complex_eigenvalues().iter().copied().collect());
            }
            let complex: [[Complex64; 4]; 4] = [[(); 4]; 4]
                .map(|row| row.map(|()| Complex64::new(random(&mut state), random(&mut state))));
            let other = Schur::new(Matrix4::from_fn(|i, j| complex[i][j]));
            let found = eigenvalues(&complex).expect("eigenvalues");
            if well_conditioned(&found) {
                let expected = other.eigenvalues().expect("a complex matrix has them");
                assert_same(found, expected.iter().copied().collect());
            }
        }
    }

    fn well_conditioned(values: &[Complex64; 4]) -> bool {
        (0..4).all(|i| (0..i).all(|j| (values[i] - values[j]).norm() > 0.05))
    }

    #[test]
    fn matrices_on_which_shifts_run_in_a_circle() {
        // A cyclic permutation: all eigenvalues have one size.
        let mut cycle = [[0.0; 4]; 4];
        for i in 0..4 {
            cycle[(i + 1) % 4][i] = 1.0;
        }
        let [one, i] = [Complex64::ONE, Complex64::I];
        assert_same(eigenvalues(&cycle).expect("eigenvalues"), vec![one, -one, i, -i]);
        let mut exchange = [[0.0; 4]; 4];
        for (i, row) in exchange.iter_mut().enumerate() {
            row[3 - i] = 1.0;
        }
        assert_same(eigenvalues(&exchange).expect("eigenvalues"), vec![one, one, -one, -one]);
        assert_eq!(eigenvalues(&[[0.0; 4]; 4]), Some([Complex64::ZERO; 4]));
        assert_eq!(eigenvalues(&[[f64::NAN; 4]; 4]), None);
    }
}
