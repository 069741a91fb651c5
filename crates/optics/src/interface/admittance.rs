//! Tangential fields: the 2 x 2 admittance that ties H to E in the plane of an interface.

use crate::medium::Medium;
use crate::wave::{ComplexVector, Frame, Number};
use glam::DVec3;
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

impl<T: Number> TangentialWave<T> {
    /// The waves with tangential wave vector `along` times the first tangent and normal component `q`.
    pub fn new(medium: &Medium, frame: &Frame, along: f64, q: T) -> Self {
        let Frame { first, second, normal } = *frame;
        // p·εE = 0 gives the normal part of E from its tangential part.
        let eps_first = *medium.permittivity() * first;
        let eps_normal = *medium.permittivity() * normal;
        let displacement =
            |v: DVec3| -> T { T::from(along * eps_first.dot(v)) + q * T::from(eps_normal.dot(v)) };
        let scale = displacement(normal);
        let lift = [-displacement(first) / scale, -displacement(second) / scale];
        // H = µ⁻¹ (p × E), with p × first = q second, p × second = along normal - q first,
        // p × normal = -along second.
        let zero = T::from(0.0);
        let curl = |e: [T; 3]| -> [T; 3] {
            [-(q * e[1]), q * e[0] - T::from(along) * e[2], T::from(along) * e[1]]
        };
        let mu = |row: DVec3, c: [T; 3]| -> T {
            let v = medium.magnetic_row(row);
            T::from(v.dot(first)) * c[0]
                + T::from(v.dot(second)) * c[1]
                + T::from(v.dot(normal)) * c[2]
        };
        let a = curl([T::from(1.0), zero, lift[0]]);
        let b = curl([zero, T::from(1.0), lift[1]]);
        Self { lift, admittance: [[mu(first, a), mu(first, b)], [mu(second, a), mu(second, b)]] }
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
