//! Reflection at a perfect conductor.

use super::admittance::{Frame, TangentialWave};
use super::{IncidentWave, OutgoingWave, Side};
use crate::medium::Medium;
use glam::DVec3;

/// Reflects a wave at a perfect conductor, on which the tangential electric field vanishes.
///
/// `normal` is the unit normal that points from the medium into the metal.
#[must_use]
pub fn reflect_at_conductor<const N: usize>(
    medium: &Medium,
    wave: &IncidentWave<N>,
    normal: DVec3,
) -> OutgoingWave<N> {
    let tangential = wave.wave_vector - normal * wave.wave_vector.dot(normal);
    let frame = Frame::new(normal, tangential);
    let along = tangential.dot(frame.first);
    let (_, q) = medium.wave_surface().normal_component(tangential, normal).real_pair();
    let reflected = TangentialWave::new(medium, &frame, along, q);
    let wave_vector = tangential + normal * q;
    let direction = medium.wave_surface().ray_direction(wave_vector);
    // |S·n| is the same before and after; the beam's width need not be.
    let narrowing = (direction.dot(normal) / wave.direction.dot(normal)).abs().sqrt();
    let electric = wave.electric.map(|incident| {
        let tangential = [-incident.dot_real(frame.first), -incident.dot_real(frame.second)];
        reflected.lifted(&frame, tangential) * narrowing
    });
    OutgoingWave { side: Side::Reflected, wave_vector, direction, electric, power: wave.power }
}
