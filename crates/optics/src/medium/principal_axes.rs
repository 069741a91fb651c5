//! The principal axes of a symmetric tensor.

use glam::{DMat3, DVec3};

/// Principal values of a real symmetric tensor and its axes, as columns: cyclic Jacobi rotations,
/// which find even small values to full precision (Golub & Van Loan, Matrix Computations, 8.5).
#[must_use]
pub fn principal_axes(tensor: &DMat3) -> (DVec3, DMat3) {
    let mut m = *tensor;
    let mut axes = DMat3::IDENTITY;
    // Convergence is quadratic; five sweeps do for any 3 x 3 matrix, the rest is a safeguard.
    for _ in 0..12 {
        let off = m.y_axis.x.abs() + m.z_axis.x.abs() + m.z_axis.y.abs();
        if off == 0.0 {
            break;
        }
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let between = m.col(j)[i];
            if between == 0.0 {
                continue;
            }
            let ratio = (m.col(j)[j] - m.col(i)[i]) / (2.0 * between);
            let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let sine = tangent * cosine;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(i)[i] = cosine;
            turn.col_mut(j)[j] = cosine;
            turn.col_mut(i)[j] = -sine;
            turn.col_mut(j)[i] = sine;
            m = turn.transpose() * m * turn;
            // Zero by construction; what rounding leaves would keep the loop busy.
            m.col_mut(i)[j] = 0.0;
            m.col_mut(j)[i] = 0.0;
            axes *= turn;
        }
    }
    (DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z), axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_tensor_is_found_again() {
        let values = DVec3::new(3.27, -0.31, 2.366);
        let turn = DMat3::from_axis_angle(DVec3::new(0.36, 0.48, 0.8), 1.1);
        let tensor = turn * DMat3::from_diagonal(values) * turn.transpose();
        let (found, axes) = principal_axes(&tensor);
        let back = axes * DMat3::from_diagonal(found) * axes.transpose();
        assert!(back.abs_diff_eq(tensor, 1e-14));
        assert!((axes * axes.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-15));
        let mut sorted = found.to_array();
        sorted.sort_by(f64::total_cmp);
        for (found, expected) in sorted.iter().zip([-0.31, 2.366, 3.27]) {
            assert!((found - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn a_diagonal_tensor_stays() {
        let (found, axes) = principal_axes(&DMat3::from_diagonal(DVec3::new(1.0, 2.0, 2.0)));
        assert_eq!((found, axes), (DVec3::new(1.0, 2.0, 2.0), DMat3::IDENTITY));
    }
}
