//! Fresnel's equations: the interface of two isotropic media.

use super::{IncidentWave, OutgoingWave, OutgoingWaves, ROUNDING, Side};
use crate::medium::ModeKind;
use crate::wave::{ComplexVector, Frame};
use glam::DVec3;
use num_complex::Complex64;

/// Normal components that are this small coincide; they are set apart, which gives the limit.
const LEAST_SQUARE: f64 = 1e-30;

/// An isotropic medium, and the square of the wave vectors' normal component there.
#[derive(Clone, Copy)]
pub(super) struct Layer {
    pub permittivity: f64,
    pub permeability: f64,
    square: f64,
}

impl Layer {
    pub fn new((permittivity, permeability): (f64, f64), along: f64) -> Self {
        Self { permittivity, permeability, square: permittivity * permeability - along * along }
    }

    /// The magnitude of the normal component where waves decay.
    pub fn decay(&self) -> Option<f64> {
        (self.square < 0.0).then(|| self.square.min(-LEAST_SQUARE).abs().sqrt())
    }

    /// The normal component of the wave whose power flows along the normal.
    pub fn forward(&self) -> f64 {
        self.square.max(LEAST_SQUARE).sqrt().copysign(self.permeability)
    }

    /// The normal fluxes of waves with the normal component `q` and unit tangential fields: along the plane of
    /// incidence (p), across it (s).
    pub fn fluxes(&self, q: f64) -> [f64; 2] {
        [(self.permittivity / q).abs(), (q / self.permeability).abs()]
    }
}

/// Splits a wave at the interface of two lossless isotropic media, given by ε and µ, as
/// [`split_down_to`](super::split_down_to) does.
pub(super) fn split_isotropic<const N: usize>(
    [here, there]: [(f64, f64); 2],
    wave: &IncidentWave<N>,
    normal: DVec3,
    least_power: f64,
    waves: &mut OutgoingWaves<N>,
) -> [f64; N] {
    let tangential = wave.wave_vector - normal * wave.wave_vector.dot(normal);
    let frame = Frame::new(normal, tangential);
    let along = tangential.dot(frame.first);
    let [here, there] = [here, there].map(|medium| Layer::new(medium, along));
    // The incident wave is taken anew from its tangential part: near grazing incidence, where the
    // normal part is a small difference, all waves of the matching must agree on it.
    let q = here.forward();
    let fields: [[Complex64; 2]; N] =
        wave.electric.map(|field| [field.dot_real(frame.first), field.dot_real(frame.second)]);
    let outgoing = Outgoing { wave, frame, along };
    if let Some(decay) = there.decay() {
        let back = reflected(here, there, q, Complex64::new(0.0, decay));
        let fields = fields.map(|[p, s]| [p * back[0], s * back[1]]);
        let flux = fields.map(|field| flux(here.fluxes(q), field));
        waves.push(outgoing.wave(Side::Reflected, here, -q, &fields, &flux, &flux));
        return [0.0; N];
    }
    let onward = there.forward();
    let back = reflected(here, there, q, onward);
    let reflected_fields = fields.map(|[p, s]| [p * back[0], s * back[1]]);
    let transmitted_fields = fields.map(|[p, s]| [p * (1.0 + back[0]), s * (1.0 + back[1])]);
    let back_flux = reflected_fields.map(|field| flux(here.fluxes(q), field));
    let on_flux = transmitted_fields.map(|field| flux(there.fluxes(onward), field));
    // Shares of the sum, not of the incident flux: the same, but for rounding near grazing incidence, which
    // would show in the account of the power.
    let total: [f64; N] = std::array::from_fn(|i| back_flux[i] + on_flux[i]);
    let power: [f64; N] = std::array::from_fn(|i| {
        let share = if back_flux[i] > 0.0 { back_flux[i] / total[i] } else { 0.0 };
        if share > ROUNDING { wave.power[i] * share } else { 0.0 }
    });
    let strong = power.iter().any(|power| *power > 0.0 && *power >= least_power);
    if strong {
        waves.push(outgoing.wave(Side::Reflected, here, -q, &reflected_fields, &back_flux, &total));
    }
    waves.push(outgoing.wave(
        Side::Transmitted,
        there,
        onward,
        &transmitted_fields,
        &on_flux,
        &total,
    ));
    if strong { [0.0; N] } else { power }
}

/// Ratios of the reflected to the incident tangential electric fields, p and s, for the normal components of
/// the incident and the transmitted wave.
fn reflected<T>(here: Layer, there: Layer, q: f64, onward: T) -> [T; 2]
where
    T: Copy
        + std::ops::Mul<f64, Output = T>
        + std::ops::Add<f64, Output = T>
        + std::ops::Sub<f64, Output = T>
        + std::ops::Neg<Output = T>
        + std::ops::Div<Output = T>,
{
    let (p_here, p_there) = (there.permittivity * q, onward * here.permittivity);
    let (s_here, s_there) = (there.permeability * q, onward * here.permeability);
    [(p_there - p_here) / (p_there + p_here), -(s_there - s_here) / (s_there + s_here)]
}

/// The normal flux of tangential fields, given those of unit ones.
pub(super) fn flux(unit: [f64; 2], [p, s]: [Complex64; 2]) -> f64 {
    unit[0] * p.norm_sqr() + unit[1] * s.norm_sqr()
}

/// What the outgoing waves are made with.
pub(super) struct Outgoing<'a, const N: usize> {
    pub wave: &'a IncidentWave<N>,
    pub frame: Frame,
    pub along: f64,
}

impl<const N: usize> Outgoing<'_, N> {
    /// A wave with the normal component `q` from its tangential fields, its normal flux and that of all
    /// outgoing waves.
    pub fn wave(
        &self,
        side: Side,
        layer: Layer,
        q: f64,
        fields: &[[Complex64; 2]; N],
        flux: &[f64; N],
        total: &[f64; N],
    ) -> OutgoingWave<N> {
        let Frame { first, second, normal } = self.frame;
        let wave_vector = first * self.along + normal * q;
        let direction = (wave_vector * 1.0_f64.copysign(layer.permeability)).normalize();
        let cosine = direction.dot(normal).abs();
        // E is across p: so its normal part follows from the part in the plane of incidence.
        let polarized = first - normal * (self.along / q);
        let mut power = [0.0; N];
        let mut electric = [ComplexVector::ZERO; N];
        for i in 0..N {
            if flux[i] > 0.0 {
                power[i] = self.wave.power[i] * (flux[i] / total[i]);
                // |Re(E × H*)| of the matched fields is the normal flux over the cosine.
                let scale = (power[i] * cosine / flux[i]).sqrt();
                let [p, s] = fields[i].map(|field| field * scale);
                electric[i] = ComplexVector::new(
                    polarized * p.re + second * s.re,
                    polarized * p.im + second * s.im,
                );
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
