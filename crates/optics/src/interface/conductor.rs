//! Reflection at a perfect conductor.

use super::admittance::FramedMedium;
use super::matching::split_into_modes;
use super::{IncidentWave, OutgoingWave, OutgoingWaves, Side};
use crate::medium::{Medium, ModeKind, WaveSurface};
use crate::wave::Frame;
use glam::DVec3;

/// Reflects a wave at a perfect conductor, on which the tangential electric field vanishes.
///
/// `normal` is the unit normal that points from the medium into the metal. In a birefringent medium
/// there are two reflected waves.
#[must_use]
pub fn reflect_at_conductor<const N: usize>(
    medium: &Medium,
    wave: &IncidentWave<N>,
    normal: DVec3,
) -> OutgoingWaves<N> {
    match medium.wave_surface() {
        Some(surface) if wave.attenuation == DVec3::ZERO => {
            std::iter::once(single_wave(medium, surface, wave, normal)).collect()
        }
        _ => split_into_modes(medium, None, wave, normal),
    }
}

fn single_wave<const N: usize>(
    medium: &Medium,
    surface: &WaveSurface,
    wave: &IncidentWave<N>,
    normal: DVec3,
) -> OutgoingWave<N> {
    let tangential = wave.wave_vector - normal * wave.wave_vector.dot(normal);
    let frame = Frame::new(normal, tangential);
    let along = tangential.dot(frame.first);
    let (_, q) = surface.normal_component(tangential, normal).real_pair();
    let reflected = FramedMedium::new(medium, &frame, along).wave(q);
    let wave_vector = tangential + normal * q;
    let direction = surface.ray_direction(wave_vector);
    // |S·n| is the same before and after; the beam's width need not be.
    let narrowing = (direction.dot(normal) / wave.direction.dot(normal)).abs().sqrt();
    let electric = wave.electric.map(|incident| {
        let tangential = [-incident.dot_real(frame.first), -incident.dot_real(frame.second)];
        reflected.lifted(&frame, tangential) * narrowing
    });
    OutgoingWave {
        side: Side::Reflected,
        mode: ModeKind::Shared,
        wave_vector,
        attenuation: DVec3::ZERO,
        direction,
        electric,
        power: wave.power,
    }
}
