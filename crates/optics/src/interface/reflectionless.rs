//! Interfaces that reflect nothing, at any angle and in any polarization.

use super::splitting::mapped;
use super::{IncidentWave, OutgoingWave, Side};
use crate::medium::{Medium, largest};
use glam::{DMat3, DVec3};

/// An interface beyond which the medium is that of incidence behind a coordinate map that leaves
/// the interface itself where it is: it reflects nothing (Yan, Yan, Ruan & Qiu, New J. Phys. 10,
/// 043040 (2008)).
///
/// Such a map has the Jacobian J = 1 + v nᵀ, n being the normal, and takes tensors to J ε Jᵀ/det J
/// and J µ Jᵀ/det J. Maxwell's equations keep their form: wave vectors and fields go over by J⁻ᵀ =
/// 1 - n vᵀ/det J, which keeps their tangential parts, and Poynting vectors by J/det J, which keeps
/// their normal part. The field is narrowed or widened with the beam. Whether two given media meet
/// in this way follows from their tensors alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflectionless {
    normal: DVec3,
    /// v: where a point at unit height above the interface goes.
    shift: DVec3,
    /// det J = 1 + v·n.
    determinant: f64,
}

/// How far apart, relative to the terms they are made of, tensors are that differ by rounding
/// alone.
const ROUNDING: f64 = 1e-14;

impl Reflectionless {
    /// The interface from one medium into another, the unit vector `normal` pointing into the
    /// latter, if both are lossless, in each both polarizations share their wave vectors, and it
    /// reflects nothing.
    #[must_use]
    pub fn between(incident: &Medium, transmitted: &Medium, normal: DVec3) -> Option<Self> {
        incident.wave_surface().and(transmitted.wave_surface())?;
        // With Jᵀn = n det J the map takes µn to µn + v (n·µn).
        let [here, there] = [incident, transmitted].map(|medium| *medium.permeability() * normal);
        let height = normal.dot(here);
        let shift = (there - here) / height;
        let determinant = normal.dot(there) / height;
        let [x, y, z] = normal.to_array();
        let jacobian = DMat3::IDENTITY + DMat3::from_cols(shift * x, shift * y, shift * z);
        // What the rounding of the tensors makes in the map.
        let rounding = ROUNDING * (there.length() / normal.dot(there)).abs().max(1.0);
        let becomes = |from: &DMat3, to: &DMat3| {
            let image = jacobian * *from * jacobian.transpose() * (1.0 / determinant);
            let terms = largest(&jacobian).powi(2) * largest(from) / determinant.abs();
            image.abs_diff_eq(*to, rounding * terms.max(largest(to)))
        };
        (becomes(incident.permeability(), transmitted.permeability())
            && becomes(incident.permittivity(), transmitted.permittivity()))
        .then_some(Self { normal, shift, determinant })
    }

    /// The wave beyond the interface.
    #[must_use]
    #[inline]
    pub fn transmit<const N: usize>(&self, wave: &IncidentWave<N>) -> OutgoingWave<N> {
        let Self { normal, shift, determinant } = *self;
        let inverse = 1.0 / determinant;
        let bent = |vector: DVec3| vector - normal * (shift.dot(vector) * inverse);
        // The Poynting vector of a unit one.
        let ray = (wave.direction + shift * normal.dot(wave.direction)) * inverse;
        mapped(wave, Side::Transmitted, bent, 1.0, ray)
    }
}
