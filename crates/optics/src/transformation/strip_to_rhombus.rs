//! The map of the square cloak: it opens a flat strip into a rhombus.

use glam::{DMat3, DVec2, DVec3};

/// The piecewise linear map behind the square cloak (Landy & Smith, Nature Mater. 12, 25 (2013);
/// designs (i)-(iii) of Halimeh & Wegener).
///
/// It is the identity on a square standing on its corner, with half diagonal d, and opens the flat
/// strip |X| <= d, Y = 0 into a rhombus with half diagonals d and b = κ d. In the quadrant
/// x, y >= 0, capitals being virtual: x = X, y = Y (1 - κ) + b (1 - X/d), z = Z; mirrored in the
/// other quadrants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripToRhombus {
    /// Half the diagonal of the square, d (cm): the strip is 2d wide.
    pub half_diagonal: f64,
    kappa: f64,
}

impl StripToRhombus {
    /// The map of a square of half diagonal `half_diagonal` (cm) and a rhombus `kappa` times as
    /// high, 0 < κ < 1.
    #[must_use]
    pub fn new(half_diagonal: f64, kappa: f64) -> Self {
        debug_assert!(half_diagonal > 0.0 && kappa > 0.0 && kappa < 1.0);
        Self { half_diagonal, kappa }
    }

    /// Half the short diagonal of the rhombus, b.
    #[must_use]
    pub fn half_height(&self) -> f64 {
        self.kappa * self.half_diagonal
    }

    /// The Jacobian ∂(x, y, z)/∂(X, Y, Z) in the quadrant with the signs of `quadrant`.
    #[must_use]
    pub fn jacobian(&self, quadrant: DVec2) -> DMat3 {
        let shear = -self.kappa * quadrant.x.signum() * quadrant.y.signum();
        DMat3::from_cols(
            DVec3::new(1.0, shear, 0.0),
            DVec3::new(0.0, 1.0 - self.kappa, 0.0),
            DVec3::Z,
        )
    }

    /// The tensor M = J Jᵀ/det J that permittivity and permeability must equal.
    #[must_use]
    pub fn tensor(&self, quadrant: DVec2) -> DMat3 {
        // Written out: the product would leave rounding in entries that are exact.
        let k = self.kappa;
        let shear = -k * quadrant.x.signum() * quadrant.y.signum();
        let rest = 1.0 - k;
        DMat3::from_cols(
            DVec3::new(1.0, shear, 0.0),
            DVec3::new(shear, k * k + rest * rest, 0.0),
            DVec3::Z,
        ) * (1.0 / rest)
    }

    /// The principal values of the tensor: (along u, along v, along z), with the angle in degrees
    /// from x to u in the quadrant x, y > 0.
    #[must_use]
    pub fn principal_values(&self) -> (DVec3, f64) {
        let m = self.tensor(DVec2::ONE);
        let (xx, xy, yy) = (m.x_axis.x, m.x_axis.y, m.y_axis.y);
        let half_trace = f64::midpoint(xx, yy);
        let u = half_trace + (0.5 * (xx - yy)).hypot(xy);
        // The in-plane determinant is 1.
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        (DVec3::new(u, 1.0 / u, m.z_axis.z), angle.to_degrees())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> StripToRhombus {
        StripToRhombus::new(14.1 / 2f64.sqrt(), 1.0 / 3f64.sqrt())
    }

    #[test]
    fn the_papers_numbers_come_out() {
        let (values, angle) = paper().principal_values();
        assert!((values - DVec3::new(3.2717, 0.30565, 2.36603)).abs().max_element() < 5e-5);
        assert!((angle + 33.5443).abs() < 5e-5, "{angle}");
    }

    #[test]
    fn the_tensor_is_that_of_the_jacobian() {
        for quadrant in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(DVec2::from) {
            let j = paper().jacobian(quadrant);
            let m = j * j.transpose() * (1.0 / j.determinant());
            assert!(m.abs_diff_eq(paper().tensor(quadrant), 1e-15));
        }
    }

    #[test]
    fn the_jacobian_is_the_derivative_of_the_map() {
        let map = paper();
        let to_physical = |point: DVec2| {
            let height = point.y.abs() * (1.0 - map.kappa)
                + map.half_height() * (1.0 - point.x.abs() / map.half_diagonal);
            DVec2::new(point.x, height.copysign(point.y))
        };
        let h = 1e-6;
        for point in [(2.0, 3.0), (-2.0, 3.0), (-4.0, -1.0), (0.5, -7.0)].map(DVec2::from) {
            let j = map.jacobian(point);
            let dx = (to_physical(point + DVec2::X * h) - to_physical(point)) / h;
            let dy = (to_physical(point + DVec2::Y * h) - to_physical(point)) / h;
            assert!((dx - j.x_axis.truncate()).length() < 1e-8);
            assert!((dy - j.y_axis.truncate()).length() < 1e-8);
        }
    }
}
