//! Tangential fields: the 2 x 2 admittance that ties H to E in the plane of an interface.

use crate::medium::Medium;
use crate::wave::{ComplexVector, Frame, Number};
use num_complex::Complex64;

/// Waves of one wave vector p = tangential + q normal in one medium: how the normal electric field
/// and the tangential magnetic field follow from the tangential electric field.
#[derive(Clone, Copy, Debug)]
pub(super) struct TangentialWave<T> {
    /// E·n = lift · (E·first, E·second).
    pub lift: [T; 2],
    /// (H·first, H·second) = admittance (E·first, E·second), by rows.
    pub admittance: [[T; 2]; 2],
}

/// A medium seen in the frame of an interface, and the tangential part of the wave vectors there,
/// `along` times the first tangent.
#[derive(Clone, Copy, Debug)]
pub(super) struct FramedMedium {
    along: f64,
    /// The entries of ε at (first, first), (first, second), (first, normal), (second, normal) and
    /// (normal, normal).
    permittivity: [f64; 5],
    /// The entries of µ⁻¹ at (first, first), (first, second), (first, normal), (second, second) and
    /// (second, normal).
    inverse_permeability: [f64; 5],
}

impl FramedMedium {
    pub fn new(medium: &Medium, frame: &Frame, along: f64) -> Self {
        if let Some((permittivity, permeability)) = medium.scalars() {
            let inverse = 1.0 / permeability;
            return Self {
                along,
                permittivity: [permittivity, 0.0, 0.0, 0.0, permittivity],
                inverse_permeability: [inverse, 0.0, 0.0, inverse, 0.0],
            };
        }
        let [[e_ff, e_fs, e_fn], _, [_, e_sn, e_nn]] = frame.tensor(medium.permittivity());
        let [[m_ff, m_fs, m_fn], [_, m_ss, m_sn], _] = frame.tensor(medium.inverse_permeability());
        Self {
            along,
            permittivity: [e_ff, e_fs, e_fn, e_sn, e_nn],
            inverse_permeability: [m_ff, m_fs, m_fn, m_ss, m_sn],
        }
    }

    /// The waves whose wave vector has the normal component `q`.
    pub fn wave<T: Number>(&self, q: T) -> TangentialWave<T> {
        let along = self.along;
        let [e_ff, e_fs, e_fn, e_sn, e_nn] = self.permittivity;
        // p·εE = 0 gives the normal part of E from its tangential part.
        let displacement =
            |by_first: f64, by_normal: f64| T::from(along * by_first) + q * by_normal;
        let scale = displacement(e_fn, e_nn);
        let lift = [-displacement(e_ff, e_fn) / scale, -displacement(e_fs, e_sn) / scale];
        // H = µ⁻¹ (p × E), with p × first = q second, p × second = along normal - q first,
        // p × normal = -along second.
        let [m_ff, m_fs, m_fn, m_ss, m_sn] = self.inverse_permeability;
        let by_first = q - lift[0] * along;
        let by_second = -(lift[1] * along);
        let row = |by_e: f64, by_q: f64, rest: f64| {
            [by_first * by_e, by_second * by_e - q * by_q + T::from(along * rest)]
        };
        TangentialWave { lift, admittance: [row(m_fs, m_ff, m_fn), row(m_ss, m_fs, m_sn)] }
    }
}

impl TangentialWave<f64> {
    /// The normal component of the Poynting vector Re(E × H*) for a tangential electric field.
    pub fn flux(&self, [e0, e1]: [Complex64; 2]) -> f64 {
        let [[y00, y01], [y10, y11]] = self.admittance;
        let h0 = e0 * y00 + e1 * y01;
        let h1 = e0 * y10 + e1 * y11;
        (e0 * h1.conj() - e1 * h0.conj()).re
    }

    /// The whole electric field that has a given tangential part.
    pub fn lifted(&self, frame: &Frame, [e0, e1]: [Complex64; 2]) -> ComplexVector {
        let n = e0 * self.lift[0] + e1 * self.lift[1];
        let part = |e0, e1, n| frame.first * e0 + frame.second * e1 + frame.normal * n;
        ComplexVector::new(part(e0.re, e1.re, n.re), part(e0.im, e1.im, n.im))
    }
}
