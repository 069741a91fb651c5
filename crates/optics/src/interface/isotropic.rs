//! Fresnel's equations: the interface of two isotropic media.

use super::splitting::Splitting;
use super::{OutgoingWave, Side};
use crate::medium::is_known_better;
use crate::wave::{ComplexVector, Frame, Number};
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

    /// That of a wave that arrives with the normal component `q`, which near grazing incidence has more
    /// digits than what follows from the tangential one.
    pub fn arriving(medium: (f64, f64), along: f64, q: f64) -> Self {
        let layer = Self::new(medium, along);
        let better = is_known_better(q, layer.square, layer.index_squared().abs() + along * along);
        if better { Self { square: q * q, ..layer } } else { layer }
    }

    /// The other side of an interface, where the tangential components are the same.
    fn beyond(&self, (permittivity, permeability): (f64, f64)) -> Self {
        let square = self.square + (permittivity * permeability - self.index_squared());
        Self { permittivity, permeability, square }
    }

    fn index_squared(&self) -> f64 {
        self.permittivity * self.permeability
    }

    /// The magnitude of the normal component where waves decay.
    pub fn decay(&self) -> Option<f64> {
        (self.square < 0.0).then(|| self.square.min(-LEAST_SQUARE).abs().sqrt())
    }

    /// The normal component of the wave whose power flows along the normal.
    pub fn forward(&self) -> f64 {
        self.square.max(LEAST_SQUARE).sqrt().copysign(self.permeability)
    }

    /// The normal fluxes of waves with the normal component `q` and unit tangential fields: along
    /// the plane of incidence (p), across it (s).
    pub fn fluxes(&self, q: f64) -> [f64; 2] {
        [(self.permittivity / q).abs(), (q / self.permeability).abs()]
    }

    /// A wave with the normal component `q` from its tangential fields, its normal flux and that of
    /// all outgoing waves.
    pub fn wave<const N: usize>(
        &self,
        splitting: &Splitting<'_, N>,
        side: Side,
        q: f64,
        fields: &[[Complex64; 2]; N],
        fluxes: [[f64; N]; 2],
    ) -> OutgoingWave<N> {
        let Frame { first, second, normal } = splitting.frame;
        let wave_vector = first * splitting.along + normal * q;
        let direction = (wave_vector * 1.0_f64.copysign(self.permeability)).normalize();
        // E is across p: so its normal part follows from the part in the plane of incidence.
        let polarized = first - normal * (splitting.along / q);
        splitting.outgoing(side, [wave_vector, direction], fluxes, |i, scale| {
            let [p, s] = fields[i].map(|field| field * scale);
            ComplexVector::new(polarized * p.re + second * s.re, polarized * p.im + second * s.im)
        })
    }
}

/// Splits a wave at the interface of two lossless isotropic media, given by ε and µ, as
/// [`split_down_to`](super::split_down_to) does.
pub(super) fn split_isotropic<const N: usize>(
    media: [(f64, f64); 2],
    mut splitting: Splitting<'_, N>,
) -> [f64; N] {
    // The incident wave is taken anew, for all waves of the matching must agree on its tangential part.
    let arriving = splitting.wave.wave_vector.dot(splitting.frame.normal);
    let here = Layer::arriving(media[0], splitting.along, arriving);
    let there = here.beyond(media[1]);
    let q = here.forward();
    let fields = splitting.fields();
    if let Some(decay) = there.decay() {
        let back = reflected(here, there, q, Complex64::new(0.0, decay));
        let fields = fields.map(|[p, s]| [p * back[0], s * back[1]]);
        let flux = fields.map(|field| flux(here.fluxes(q), field));
        let wave = here.wave(&splitting, Side::Reflected, -q, &fields, [flux, flux]);
        splitting.waves.push(wave);
        return [0.0; N];
    }
    let onward = there.forward();
    let back = reflected(here, there, q, onward);
    let reflected = fields.map(|[p, s]| [p * back[0], s * back[1]]);
    let transmitted = fields.map(|[p, s]| [p * (1.0 + back[0]), s * (1.0 + back[1])]);
    let back_flux = reflected.map(|field| flux(here.fluxes(q), field));
    let on_flux = transmitted.map(|field| flux(there.fluxes(onward), field));
    splitting.part([back_flux, on_flux], |splitting, side, total| match side {
        Side::Reflected => here.wave(splitting, side, -q, &reflected, [back_flux, total]),
        Side::Transmitted => there.wave(splitting, side, onward, &transmitted, [on_flux, total]),
    })
}

/// Ratios of the reflected to the incident tangential electric fields, p and s, for the normal
/// components of the incident and the transmitted wave.
fn reflected<T: Number>(here: Layer, there: Layer, q: f64, onward: T) -> [T; 2] {
    let (p_here, p_there) = (T::from(there.permittivity * q), onward * here.permittivity);
    let (s_here, s_there) = (T::from(there.permeability * q), onward * here.permeability);
    [(p_there - p_here) / (p_there + p_here), -(s_there - s_here) / (s_there + s_here)]
}

/// The normal flux of tangential fields, given those of unit ones.
pub(super) fn flux(unit: [f64; 2], [p, s]: [Complex64; 2]) -> f64 {
    unit[0] * p.norm_sqr() + unit[1] * s.norm_sqr()
}
