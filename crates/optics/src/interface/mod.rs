//! Interfaces: what a plane wave becomes where two media, or a medium and a metal, meet.
//!
//! The tangential part of the wave vector is kept; the outgoing waves are chosen by the sign of
//! their normal Poynting flux, or by decay; the tangential fields are matched. This serves every
//! pair of media at any angle, total internal reflection included. Where both media carry both
//! polarizations on one wave, a 2 x 2 matching does; elsewhere there are up to two waves on
//! either side, each with its own wave vector and ray.
//!
//! Waves carry their fields scaled such that |Re(E × H*)| is the power of the ray. A beam changes
//! its cross-section at an interface, so the outgoing fields are those of the matching problem
//! times (cos θ_out/cos θ_in)^½, θ being the angles of the Poynting vectors with the normal.

mod admittance;
mod coating;
mod conductor;
mod isotropic;
mod matching;
mod reflectionless;
mod scattering;
mod single_wave;
mod splitting;

pub use coating::transmit_antireflection;
pub use conductor::reflect_at_conductor;
pub use matching::{Backing, Film, FilmLayer, split_coated};
pub use reflectionless::Reflectionless;
pub use scattering::{JonesMatrices, Scattering};

use crate::medium::{Medium, ModeKind};
use crate::wave::ComplexVector;
use arrayvec::ArrayVec;
use glam::DVec3;
use isotropic::split_isotropic;
use matching::split_into_modes;
use single_wave::split_single_wave;
use splitting::Splitting;

/// The share of the power that rounding leaves in a wave that is not there: matched media reflect
/// nothing.
const ROUNDING: f64 = 1e-28;

/// On which side of an interface an outgoing wave runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// In the medium the light came from.
    Reflected,
    /// In the medium beyond.
    Transmitted,
}

/// A wave that arrives at an interface, with the electric fields of `N` independently launched
/// polarizations. In a birefringent medium it is one of the two modes, and all fields are multiples
/// of that mode's.
#[derive(Clone, Copy, Debug)]
pub struct IncidentWave<const N: usize> {
    /// Wave vector; its real part in an absorbing medium.
    pub wave_vector: DVec3,
    /// The imaginary part of the wave vector, zero in lossless media: a path dr dims the power by
    /// exp(-2 k0 attenuation·dr).
    pub attenuation: DVec3,
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
    /// Which of the medium's waves it is.
    pub mode: ModeKind,
    /// Wave vector; its real part in an absorbing medium.
    pub wave_vector: DVec3,
    /// The imaginary part of the wave vector, zero in lossless media: a path dr dims the power by
    /// exp(-2 k0 attenuation·dr).
    pub attenuation: DVec3,
    /// Unit vector of the Poynting vector.
    pub direction: DVec3,
    /// Electric fields, scaled such that |Re(E × H*)| is the power of the ray.
    pub electric: [ComplexVector; N],
    /// Power of the ray for each launched polarization.
    pub power: [f64; N],
}

/// The waves that leave an interface: up to two on each side.
pub type OutgoingWaves<const N: usize> = ArrayVec<OutgoingWave<N>, 4>;

/// Splits a wave at the interface between two media.
///
/// `normal` is the unit normal that points from the medium of incidence, `incident_medium`, into
/// `transmitted_medium`. Reflected waves come first; waves that carry no power (evanescent ones,
/// and the reflections of matched media) are left out. The powers add up to that of the incident
/// wave. (Exactly so for lossless incident media. In absorbing ones the interference of incident
/// and reflected light carries power, too; it is shared out in proportion.)
///
/// # Example
///
/// Glass reflects 4 % of light that falls on it straight.
///
/// ```
/// use glam::DVec3;
/// use optics::interface::{split, IncidentWave};
/// use optics::medium::Medium;
///
/// let wave = IncidentWave {
///     wave_vector: DVec3::X,
///     attenuation: DVec3::ZERO,
///     direction: DVec3::X,
///     electric: [DVec3::Y.into()],
///     power: [1.0],
/// };
/// let waves = split(&Medium::AIR, &Medium::dielectric(1.5), &wave, DVec3::X);
/// assert!((waves[0].power[0] - 0.04).abs() < 1e-15);
/// assert!((waves[1].power[0] - 0.96).abs() < 1e-15);
/// ```
#[must_use]
pub fn split<const N: usize>(
    incident_medium: &Medium,
    transmitted_medium: &Medium,
    wave: &IncidentWave<N>,
    normal: DVec3,
) -> OutgoingWaves<N> {
    let mut waves = OutgoingWaves::new();
    split_down_to(incident_medium, transmitted_medium, wave, normal, 0.0, &mut waves);
    waves
}

/// Splits a wave as [`split`] does, and adds to `waves` all that have `least_power` or more in one
/// of the polarizations: others need not be worked out, and may be left out. The power of those
/// that are.
pub fn split_down_to<const N: usize>(
    incident_medium: &Medium,
    transmitted_medium: &Medium,
    wave: &IncidentWave<N>,
    normal: DVec3,
    least_power: f64,
    waves: &mut OutgoingWaves<N>,
) -> [f64; N] {
    let splitting = Splitting::new(wave, normal, least_power, waves);
    if wave.attenuation == DVec3::ZERO {
        let scalars = (incident_medium.scalars(), transmitted_medium.scalars());
        if let (Some(here), Some(there)) = scalars {
            return split_isotropic([here, there], splitting);
        }
        let surfaces = (incident_medium.wave_surface(), transmitted_medium.wave_surface());
        if let (Some(from), Some(to)) = surfaces {
            return split_single_wave(
                [(incident_medium, from), (transmitted_medium, to)],
                splitting,
            );
        }
    }
    split_into_modes(incident_medium, Some(transmitted_medium), splitting)
}
