//! The Stokes parameters of light that arrives where rays are launched.

use super::ComplexVector;
use num_complex::Complex64;

/// The Stokes parameters S0 to S3 of the light that arrives along one path from an unpolarized
/// source of unit radiance at its far end. `horizontal` and `vertical` are the fields that leave
/// the far end when horizontal and vertical light of unit power is launched at the near one.
///
/// A polarizer at angle ψ sees S0 + S1 cos 2ψ + S2 sin 2ψ, a right- or left-handed circular one
/// S0 ± S3; so S0 is the mean of horizontal and vertical. The signs are those of the
/// [conventions](crate::wave).
///
/// # Derivation
///
/// Let A be the 2 x 2 matrix whose columns are the two fields. By reciprocity the far end's field
/// **s** arrives as Aᵀ**s**, so unpolarized light arrives with the coherency matrix
/// J_ik = ⟨E_i E_k*⟩ = (AᵀA*)_ik/2 = **a**_i·**a**_k*/2, **a**_i the columns of A; its trace is the
/// sum of the powers over two, S0. A polarizer that passes **e** sees **e**†J**e**: the power that
/// leaves when **e*** is launched. S1 = J_HH - J_VV, S2 = 2 Re J_HV, S3 = 2 Im J_HV.
///
/// # Example
///
/// A path that carries horizontal light only.
///
/// ```
/// use glam::DVec3;
/// use optics::wave::{ComplexVector, arriving_stokes};
/// let stokes = arriving_stokes(DVec3::Z.into(), ComplexVector::ZERO);
/// assert_eq!(stokes, [0.5, 0.5, 0.0, 0.0]);
/// ```
#[must_use]
pub fn arriving_stokes(horizontal: ComplexVector, vertical: ComplexVector) -> [f64; 4] {
    let powers = [horizontal.norm_squared(), vertical.norm_squared()];
    stokes_of_coherency(powers, horizontal.dot(vertical.conj()))
}

/// The same of a coherency matrix: its diagonal, the powers of what was launched horizontally and
/// vertically, and the element ⟨`E_H` · `E_V`*⟩ between them.
#[must_use]
pub fn stokes_of_coherency([h, v]: [f64; 2], coherency: Complex64) -> [f64; 4] {
    [(h + v) / 2.0, (h - v) / 2.0, coherency.re, coherency.im]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// What leaves when cos ψ e_H + exp(iδ) sin ψ e_V is launched.
    fn power(h: ComplexVector, v: ComplexVector, psi: f64, delta: f64) -> f64 {
        (h * psi.cos() + v.scaled(Complex64::from_polar(psi.sin(), delta))).norm_squared()
    }

    #[test]
    fn every_polarizer_follows_from_the_four() {
        let h = ComplexVector::new(DVec3::new(0.1, -0.7, 0.2), DVec3::new(0.3, 0.1, -0.4));
        let v = ComplexVector::new(DVec3::new(0.2, 0.3, -0.5), DVec3::new(-0.1, 0.6, 0.2));
        let [s0, s1, s2, s3] = arriving_stokes(h, v);
        for degrees in [0.0, 17.0, 45.0, 90.0, 133.0, -45.0] {
            let psi = f64::to_radians(degrees);
            let expected = s0 + s1 * (2.0 * psi).cos() + s2 * (2.0 * psi).sin();
            assert!((power(h, v, psi, 0.0) - expected).abs() < 1e-15);
        }
        // Right-handed light is E_V = -i E_H; to detect it is to launch its conjugate.
        let eighth = std::f64::consts::FRAC_PI_4;
        let quarter = std::f64::consts::FRAC_PI_2;
        assert!((power(h, v, eighth, quarter) - (s0 + s3)).abs() < 1e-15);
        assert!((power(h, v, eighth, -quarter) - (s0 - s3)).abs() < 1e-15);
        assert!(s1.hypot(s2).hypot(s3) <= s0);
    }
}
