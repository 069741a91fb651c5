//! The interface of two media in which both polarizations share one wave vector.

use super::admittance::{FramedMedium, TangentialWave};
use super::splitting::Splitting;
use super::{OutgoingWave, Side};
use crate::medium::{Medium, Roots, WaveSurface};
use crate::wave::Number;
use num_complex::Complex64;

/// Splits a wave at the interface of two lossless media in which both polarizations share one wave
/// vector, given with their wave surfaces, as [`split_down_to`](super::split_down_to) does.
pub(super) fn split_single_wave<const N: usize>(
    [(here, surface), (there, surface_beyond)]: [(&Medium, &WaveSurface); 2],
    mut splitting: Splitting<'_, N>,
) -> [f64; N] {
    let Splitting { frame, tangential, along, .. } = splitting;
    // The incident wave is taken anew, for all waves of the matching must agree on its tangential part.
    let arriving = splitting.wave.wave_vector.dot(frame.normal);
    let roots = surface.roots_with(Some(arriving), tangential, frame.normal);
    let (forward, backward) = roots.real_pair();
    let [here, there] = [here, there].map(|medium| FramedMedium::new(medium, &frame, along));
    let incident = here.wave(forward);
    let reflected = Branch { surface, q: backward, wave: here.wave(backward) };
    let arriving = splitting.fields();
    match surface_beyond.roots(tangential, frame.normal) {
        Roots::Real { plus: q, .. } => {
            let transmitted = Branch { surface: surface_beyond, q, wave: there.wave(q) };
            let [back, on] =
                tangential_fields(&arriving, incident, reflected.wave, transmitted.wave);
            let back_flux = back.map(|fields| reflected.wave.flux(fields).abs());
            let on_flux = on.map(|fields| transmitted.wave.flux(fields).abs());
            splitting.part([back_flux, on_flux], |splitting, side, total| match side {
                Side::Reflected => reflected.outgoing(splitting, side, &back, [back_flux, total]),
                Side::Transmitted => transmitted.outgoing(splitting, side, &on, [on_flux, total]),
            })
        }
        Roots::Complex { re, im, .. } => {
            let transmitted = there.wave(Complex64::new(re, im));
            let [back, _] = tangential_fields(&arriving, incident, reflected.wave, transmitted);
            let flux = back.map(|fields| reflected.wave.flux(fields).abs());
            let wave = reflected.outgoing(&splitting, Side::Reflected, &back, [flux, flux]);
            splitting.waves.push(wave);
            [0.0; N]
        }
    }
}

/// A wave that carries power on one side.
struct Branch<'s> {
    surface: &'s WaveSurface,
    /// The normal component of its wave vector.
    q: f64,
    wave: TangentialWave<f64>,
}

impl Branch<'_> {
    /// The outgoing wave from its tangential fields, its normal flux and that of all outgoing
    /// waves.
    fn outgoing<const N: usize>(
        &self,
        splitting: &Splitting<'_, N>,
        side: Side,
        fields: &TangentialFields<N>,
        fluxes: [[f64; N]; 2],
    ) -> OutgoingWave<N> {
        let frame = &splitting.frame;
        let wave_vector = frame.first * splitting.along + frame.normal * self.q;
        let vectors = [wave_vector, self.surface.ray_direction(wave_vector)];
        let [flux, total] = fluxes;
        splitting.outgoing(side, vectors, fluxes, |i, _| {
            // The normal flux has few digits near grazing incidence: |S| has all.
            let field = self.wave.lifted(frame, fields[i]);
            let power = splitting.wave.power[i] * (flux[i] / total[i]);
            field * (power / self.surface.poynting(wave_vector, field)).sqrt()
        })
    }
}

/// Tangential electric fields (E·first, E·second) for each launched polarization.
type TangentialFields<const N: usize> = [[Complex64; 2]; N];

/// The tangential electric fields of the reflected and the transmitted wave, given those of the
/// incident one. With the admittances Y, E_t = E_i + E_r and Y_t E_t = Y_i E_i + Y_r E_r give
/// (Y_t - Y_r) E_r = (Y_i - Y_t) E_i.
fn tangential_fields<T: Number, const N: usize>(
    arriving: &TangentialFields<N>,
    incident: TangentialWave<f64>,
    reflected: TangentialWave<f64>,
    transmitted: TangentialWave<T>,
) -> [TangentialFields<N>; 2] {
    let [[t00, t01], [t10, t11]] = transmitted.admittance;
    let [[[i00, i01], [i10, i11]], [[r00, r01], [r10, r11]]] =
        [incident, reflected].map(|wave| wave.admittance.map(|row| row.map(T::from)));
    let (a, b, c, d) = (t00 - r00, t01 - r01, t10 - r10, t11 - r11);
    let inverse = T::from(1.0) / (a * d - b * c);
    let back = arriving.map(|[e0, e1]| {
        let x = (i00 - t00) * e0 + (i01 - t01) * e1;
        let y = (i10 - t10) * e0 + (i11 - t11) * e1;
        [inverse * (d * x - b * y), inverse * (a * y - c * x)]
    });
    let on = std::array::from_fn(|i| [0, 1].map(|axis| arriving[i][axis] + back[i][axis]));
    [back, on]
}
