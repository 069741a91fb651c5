//! Reflection at a perfect conductor.

use super::matching::split_into_modes;
use super::splitting::{Splitting, mapped};
use super::{IncidentWave, OutgoingWave, OutgoingWaves, Side};
use crate::medium::Medium;
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
    let mut waves = OutgoingWaves::new();
    if let Some(image) = mirror_image(medium, wave, normal) {
        waves.push(image);
    } else {
        split_into_modes(medium, None, Splitting::new(wave, normal, 0.0, &mut waves));
    }
    waves
}

/// The mirror image at a plane in a medium with the wave surface p·Ap = c, ε and µ being multiples
/// of A. `None` if the medium is not of that kind, or nearly has no wave along the normal: the
/// asymptotic cone of a hyperbolic one.
///
/// The map J = 1 - 2 (An) nᵀ/(n·An) leaves the plane where it is and A as it is, but its
/// determinant is -1: it takes ε and µ to -ε and -µ, where J⁻ᵀE and J⁻ᵀH solve Maxwell's equations.
/// So do -J⁻ᵀE and J⁻ᵀH in the medium itself, with the wave vector J⁻ᵀp: the reflected wave.
fn mirror_image<const N: usize>(
    medium: &Medium,
    wave: &IncidentWave<N>,
    normal: DVec3,
) -> Option<OutgoingWave<N>> {
    let conjugate = medium.wave_surface()?.ray(normal);
    let height = normal.dot(conjugate);
    let sound = height * height > 1e-20 * conjugate.length_squared();
    // 2 An/(n·An).
    let through = conjugate * (2.0 / height);
    let image = |vector: DVec3| vector - normal * through.dot(vector);
    let ray = wave.direction - through * normal.dot(wave.direction);
    sound.then(|| mapped(wave, Side::Reflected, image, -1.0, ray))
}
