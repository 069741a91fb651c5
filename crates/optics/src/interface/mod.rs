//! Interfaces: what a plane wave becomes where two media, or a medium and a metal, meet.
//!
//! The tangential part of the wave vector is kept; the outgoing waves are chosen by the sign of
//! their normal Poynting flux, or by decay; the tangential fields are matched. One routine serves
//! every pair of media in which both polarizations share one wave vector, at any angle, total
//! internal reflection included.
//!
//! Waves carry their fields scaled such that |Re(E × H*)| is the power of the ray. A beam changes
//! its cross-section at an interface, so the outgoing fields are those of the matching problem
//! times (cos θ_out/cos θ_in)^½, θ being the angles of the Poynting vectors with the normal.

mod admittance;
mod conductor;
mod single_wave;

pub use conductor::reflect_at_conductor;
pub use single_wave::{split, transmit_antireflection};

use crate::wave::ComplexVector;
use arrayvec::ArrayVec;
use glam::DVec3;

/// On which side of an interface an outgoing wave runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// In the medium the light came from.
    Reflected,
    /// In the medium beyond.
    Transmitted,
}

/// A wave that arrives at an interface, with the electric fields of `N` independently launched
/// polarizations.
#[derive(Clone, Copy, Debug)]
pub struct IncidentWave<const N: usize> {
    /// Wave vector.
    pub wave_vector: DVec3,
    /// Unit vector of the Poynting vector.
    pub direction: DVec3,
    /// Electric fields, scaled such that |Re(E × H*)| is the power of the ray.
    pub electric: [ComplexVector; N],
    /// Power of the ray for each launched polarization.
    pub power: [f64; N],
}

/// A propagating wave that leaves an interface.
#[derive(Clone, Copy, Debug)]
pub struct OutgoingWave<const N: usize> {
    /// Where it runs.
    pub side: Side,
    /// Wave vector.
    pub wave_vector: DVec3,
    /// Unit vector of the Poynting vector.
    pub direction: DVec3,
    /// Electric fields, scaled such that |Re(E × H*)| is the power of the ray.
    pub electric: [ComplexVector; N],
    /// Power of the ray for each launched polarization.
    pub power: [f64; N],
}

/// The waves that leave an interface: up to two on each side.
pub type OutgoingWaves<const N: usize> = ArrayVec<OutgoingWave<N>, 4>;
