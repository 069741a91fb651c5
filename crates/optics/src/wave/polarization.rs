//! Linear polarization: the basis horizontal, vertical.

use super::ComplexVector;
use glam::DVec3;

/// Unit vectors (horizontal, vertical) across a ray of unit direction `direction`: vertical is
/// perpendicular to the ray and to the unit vector `right`, e_V = right × d/|right × d|;
/// horizontal is e_H = d × e_V, the transverse part of `right`.
///
/// A polarizer at angle ψ passes cos ψ e_H + sin ψ e_V. For a ray along `right` there is no such
/// vertical; `fallback`, a unit vector across `right`, is then the horizontal. The crate's world
/// frame uses right = z and fallback = x.
///
/// # Example
///
/// ```
/// use glam::DVec3;
/// let (horizontal, vertical) = optics::wave::transverse_basis(DVec3::X, DVec3::Z, DVec3::X);
/// assert_eq!((horizontal, vertical), (DVec3::Z, DVec3::Y));
/// ```
#[must_use]
pub fn transverse_basis(direction: DVec3, right: DVec3, fallback: DVec3) -> (DVec3, DVec3) {
    let across = right.cross(direction);
    let length = across.length();
    if length < 1e-12 {
        return (fallback, fallback.cross(direction));
    }
    let vertical = across / length;
    (direction.cross(vertical), vertical)
}

/// A field across the unit vector `from`, turned with the least rotation that takes `from` to the
/// unit vector `to`: what refraction does to the parts along and across the plane of incidence.
pub(crate) fn turn_transverse(field: ComplexVector, from: DVec3, to: DVec3) -> ComplexVector {
    let cosine = from.dot(to);
    if cosine < -1.0 + 1e-12 {
        // By 180 degrees about the field itself, as good an axis across the ray as any.
        return field;
    }
    // Rodrigues' formula with axis × angle = from × to.
    let axis = from.cross(to);
    let turn = |v: DVec3| v * cosine + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cosine));
    ComplexVector::new(turn(field.re), turn(field.im))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    #[test]
    fn a_turned_field_stays_across_the_ray() {
        let from = DVec3::new(0.6, 0.0, 0.8);
        let to = DVec3::new(0.0, -0.28, 0.96);
        let field = ComplexVector::new(DVec3::Y, DVec3::new(0.8, 0.0, -0.6));
        let turned = turn_transverse(field, from, to);
        assert!(turned.dot_real(to).norm() < 1e-15);
        assert!((turned.norm_squared() - field.norm_squared()).abs() < 1e-15);
    }

    #[test]
    fn the_basis_is_right_handed_and_transverse() {
        for direction in [DVec3::X, -DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.36, 0.48, -0.8)] {
            let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
            let frame = DMat3::from_cols(h, v, direction);
            // e_H × e_V points against the ray: the observer faces it.
            assert!((frame.determinant() + 1.0).abs() < 1e-14, "{direction}: {frame}");
        }
    }
}
