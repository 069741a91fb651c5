//! From a medium of two waves into an isotropic one, where H follows from E: two unknowns instead
//! of four.

use super::{Incident, Scattered, Shares, cancelling, fluxes};
use crate::interface::Side;
use crate::interface::isotropic::{Layer, flux};
use crate::medium::LocalMode;
use crate::wave::Number;
use num_complex::Complex64;

impl<const N: usize> Scattered<'_, N> {
    /// Matches the fields of lossless media, all modes of the medium of incidence carrying power.
    pub(super) fn match_isotropic(
        &mut self,
        incident: &[Incident<'_, f64, N>],
        backward: &[LocalMode<f64>; 2],
        layer: Layer,
    ) {
        let (onward, amplitudes) = if let Some(decay) = layer.decay() {
            let q = Complex64::new(0.0, decay);
            (None, self.reflected(incident, backward, layer, q))
        } else {
            let q = layer.forward();
            (Some(q), self.reflected(incident, backward, layer, q))
        };
        let back = fluxes(backward, [&amplitudes[0], &amplitudes[1]]);
        let fields: [[Complex64; 2]; N] = std::array::from_fn(|i| {
            [0, 1].map(|axis| {
                let arriving: Complex64 =
                    incident.iter().map(|(mode, parts)| parts[i] * mode.electric[axis]).sum();
                arriving
                    + amplitudes[0][i] * backward[0].electric[axis]
                    + amplitudes[1][i] * backward[1].electric[axis]
            })
        });
        let on = onward.map_or([0.0; N], |q| fields.map(|field| flux(layer.fluxes(q), field)));
        // Over the sum, not over the incident flux: the same, but for rounding near grazing
        // incidence.
        let total: [f64; N] = std::array::from_fn(|i| back[0][i] + back[1][i] + on[i]);
        let shares = Shares::of(self.splitting.wave.power, total, false);
        let amplitudes = [&amplitudes[0], &amplitudes[1]];
        self.one_side(Side::Reflected, backward, amplitudes, &back, &shares);
        let Some(q) = onward else { return };
        let power: [f64; N] = std::array::from_fn(|i| on[i] * shares.power[i]);
        if self.is_strong(power) {
            let wave = layer.wave(&self.splitting, Side::Transmitted, q, &fields, [on, total]);
            self.splitting.waves.push(wave);
        }
    }

    /// The amplitudes of both reflected modes. Beyond, H·first = -(q/µ) E·second and H·second =
    /// (ε/q) E·first, the latter times q to hold at grazing incidence: what both fail by must
    /// vanish in the sum.
    fn reflected<T: Number>(
        &self,
        incident: &[Incident<'_, f64, N>],
        [r1, r2]: &[LocalMode<f64>; 2],
        layer: Layer,
        q: T,
    ) -> [[Complex64; N]; 2] {
        let (ratio, permittivity) = (q * layer.permeability.recip(), layer.permittivity);
        let misfit = |mode: &LocalMode<f64>| {
            let ([e0, e1, _], [h0, h1, _]) = (mode.electric, mode.magnetic);
            [T::from(h0) + ratio * e1, q * h1 - T::from(permittivity * e0)]
        };
        let cancelling = cancelling(misfit(r1), misfit(r2));
        let mut amplitudes = [[Complex64::ZERO; N]; 2];
        for (mode, parts) in incident {
            let with = cancelling(misfit(mode));
            for (sum, with) in amplitudes.iter_mut().zip(with) {
                for (sum, part) in sum.iter_mut().zip(parts) {
                    *sum += with * *part;
                }
            }
        }
        amplitudes
    }
}
