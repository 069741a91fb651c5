//! From an isotropic medium into one of two waves: H follows from E on the near side, and two
//! unknowns are left of four.

use super::{Scattered, Shares, cancelling, fluxes};
use crate::interface::Side;
use crate::interface::isotropic::{Layer, flux};
use crate::medium::LocalMode;
use crate::wave::Number;
use num_complex::Complex64;

impl<const N: usize> Scattered<'_, N> {
    /// Matches the fields of lossless media. With E_r = E_t - E_i, H_t = Y (E_i - E_r) gives
    /// H_t + Y E_t = 2 Y E_i, where Y takes E to H: H·first = -(q/µ) E·second and H·second =
    /// (ε/q) E·first, the latter times q to hold at grazing incidence.
    pub(super) fn match_from_isotropic<T: Number>(
        &mut self,
        layer: Layer,
        onward: &[LocalMode<T>; 2],
    ) {
        let q = layer.forward();
        let (ratio, permittivity) = (q / layer.permeability, layer.permittivity);
        let [first, second] = onward.each_ref().map(|mode| {
            let ([e0, e1, _], [h0, h1, _]) = (mode.electric, mode.magnetic);
            [h0 - e1 * ratio, h1 * q + e0 * permittivity]
        });
        let cancelling = cancelling(first, second);
        let (zero, one) = (T::from(0.0), T::from(1.0));
        let [by_s, by_p] = [cancelling([one, zero]), cancelling([zero, one])];
        let arriving = self.splitting.fields();
        let sums = arriving.map(|[e0, e1]| [e1 * (2.0 * ratio), e0 * (-2.0 * permittivity)]);
        let amplitudes = [0, 1].map(|mode| sums.map(|[s, p]| by_s[mode] * s + by_p[mode] * p));
        let reflected: [[Complex64; 2]; N] = std::array::from_fn(|i| {
            [0, 1].map(|axis| {
                onward[0].electric[axis] * amplitudes[0][i]
                    + onward[1].electric[axis] * amplitudes[1][i]
                    - arriving[i][axis]
            })
        });
        let amplitudes = [&amplitudes[0], &amplitudes[1]];
        let back = reflected.map(|field| flux(layer.fluxes(q), field));
        let on = fluxes(onward, amplitudes);
        // Over the sum, not over the incident flux: the same, but for rounding near grazing
        // incidence.
        let total: [f64; N] = std::array::from_fn(|i| back[i] + on[0][i] + on[1][i]);
        let shares = Shares::of(self.splitting.wave.power, total, false);
        let power: [f64; N] = std::array::from_fn(|i| back[i] * shares.power[i]);
        if self.is_strong(power) {
            let fluxes = [back, total];
            let wave = layer.wave(&self.splitting, Side::Reflected, -q, &reflected, fluxes);
            self.splitting.waves.push(wave);
        }
        self.one_side(Side::Transmitted, onward, amplitudes, &on, &shares);
    }
}
