//! Interfaces with a perfect antireflection coating.

use super::{IncidentWave, OutgoingWave, OutgoingWaves, Side, split};
use crate::medium::{Medium, ModeKind, Roots};
use crate::wave::turn_transverse;
use glam::DVec3;

/// A wave through an interface between isotropic media whose reflection is suppressed by a perfect
/// antireflection coating: refracted, all of its power transmitted, each polarization on its own.
/// Beyond the critical angle, and into media in which the polarizations part, it behaves as at the
/// bare interface.
#[must_use]
pub fn transmit_antireflection<const N: usize>(
    incident_medium: &Medium,
    transmitted_medium: &Medium,
    wave: &IncidentWave<N>,
    normal: DVec3,
) -> OutgoingWaves<N> {
    let tangential = wave.wave_vector - normal * wave.wave_vector.dot(normal);
    let surface = transmitted_medium.wave_surface();
    let waves = surface.map(|surface| (surface, surface.roots(tangential, normal)));
    let Some((surface, Roots::Real { plus, .. })) = waves else {
        return split(incident_medium, transmitted_medium, wave, normal);
    };
    let wave_vector = tangential + normal * plus;
    let direction = surface.ray_direction(wave_vector);
    let mut electric = wave.electric;
    for (field, power) in electric.iter_mut().zip(wave.power) {
        let turned = turn_transverse(*field, wave.direction, direction);
        let carried = transmitted_medium.poynting(wave_vector, turned).length();
        *field = if carried > 0.0 { turned * (power / carried).sqrt() } else { turned };
    }
    std::iter::once(OutgoingWave {
        side: Side::Transmitted,
        mode: ModeKind::Shared,
        wave_vector,
        attenuation: DVec3::ZERO,
        direction,
        electric,
        power: wave.power,
    })
    .collect()
}
