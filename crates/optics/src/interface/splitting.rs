//! What leaves an interface, in the frame of it.

use super::{IncidentWave, OutgoingWave, OutgoingWaves, ROUNDING, Side};
use crate::medium::ModeKind;
use crate::wave::{ComplexVector, Frame};
use glam::DVec3;
use num_complex::Complex64;

/// What becomes of a wave under a linear map, given what it does to wave vectors and fields, the
/// latter times `sign`, and where it takes the ray.
#[inline]
pub(super) fn mapped<const N: usize>(
    wave: &IncidentWave<N>,
    side: Side,
    covector: impl Fn(DVec3) -> DVec3,
    sign: f64,
    ray: DVec3,
) -> OutgoingWave<N> {
    // The normal flux is the same before and after; the beam's width need not be.
    let length = ray.length();
    let narrowing = sign * (1.0 / length).sqrt();
    let image = |v: ComplexVector| ComplexVector::new(covector(v.re), covector(v.im)) * narrowing;
    OutgoingWave {
        side,
        mode: ModeKind::Shared,
        wave_vector: covector(wave.wave_vector),
        attenuation: covector(wave.attenuation),
        direction: ray / length,
        electric: wave.electric.map(image),
        power: wave.power,
    }
}

/// A wave that is being split.
pub(super) struct Splitting<'a, const N: usize> {
    pub wave: &'a IncidentWave<N>,
    pub frame: Frame,
    /// The tangential part of the wave vector.
    pub tangential: DVec3,
    /// The same along the first tangent.
    pub along: f64,
    /// Waves of less power need not be worked out.
    pub least_power: f64,
    /// Those that go on.
    pub waves: &'a mut OutgoingWaves<N>,
}

impl<'a, const N: usize> Splitting<'a, N> {
    pub fn new(
        wave: &'a IncidentWave<N>,
        normal: DVec3,
        least_power: f64,
        waves: &'a mut OutgoingWaves<N>,
    ) -> Self {
        let tangential = wave.wave_vector - normal * wave.wave_vector.dot(normal);
        let frame = Frame::new(normal, tangential);
        let along = tangential.dot(frame.first);
        Self { wave, frame, tangential, along, least_power, waves }
    }

    /// The tangential electric fields (E·first, E·second) for each launched polarization.
    pub fn fields(&self) -> [[Complex64; 2]; N] {
        let Frame { first, second, .. } = self.frame;
        self.wave.electric.map(|field| [field.dot_real(first), field.dot_real(second)])
    }

    /// Adds the wave that is reflected, unless it is too weak, and the one that is transmitted,
    /// given their normal fluxes and how to make a wave from those of all; the power of a reflected
    /// wave that is too weak.
    pub fn part(
        &mut self,
        [back, on]: [[f64; N]; 2],
        outgoing: impl Fn(&Self, Side, [f64; N]) -> OutgoingWave<N>,
    ) -> [f64; N] {
        // Shares of the sum, not of the incident flux: the same, but for rounding near grazing
        // incidence, which would show in the account of the power.
        let total: [f64; N] = std::array::from_fn(|i| back[i] + on[i]);
        let power: [f64; N] = std::array::from_fn(|i| {
            let share = if back[i] > 0.0 { back[i] / total[i] } else { 0.0 };
            if share > ROUNDING { self.wave.power[i] * share } else { 0.0 }
        });
        let strong = power.iter().any(|power| *power > 0.0 && *power >= self.least_power);
        if strong {
            self.waves.push(outgoing(self, Side::Reflected, total));
        }
        self.waves.push(outgoing(self, Side::Transmitted, total));
        if strong { [0.0; N] } else { power }
    }

    /// A wave of both polarizations from its normal flux and that of all outgoing waves; `field` is
    /// its electric field for a launched polarization, scaled by a number.
    pub fn outgoing(
        &self,
        side: Side,
        [wave_vector, direction]: [DVec3; 2],
        [flux, total]: [[f64; N]; 2],
        field: impl Fn(usize, f64) -> ComplexVector,
    ) -> OutgoingWave<N> {
        let cosine = direction.dot(self.frame.normal).abs();
        let mut power = [0.0; N];
        let mut electric = [ComplexVector::ZERO; N];
        for i in 0..N {
            if flux[i] > 0.0 {
                power[i] = self.wave.power[i] * (flux[i] / total[i]);
                // |Re(E × H*)| of the matched fields is the normal flux over the cosine.
                electric[i] = field(i, (power[i] * cosine / flux[i]).sqrt());
            }
        }
        OutgoingWave {
            side,
            mode: ModeKind::Shared,
            wave_vector,
            attenuation: DVec3::ZERO,
            direction,
            electric,
            power,
        }
    }
}
