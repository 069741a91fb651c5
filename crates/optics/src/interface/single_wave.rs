//! The interface of two media in which both polarizations share one wave vector.

use super::admittance::{FramedMedium, TangentialWave};
use super::{IncidentWave, OutgoingWave, OutgoingWaves, ROUNDING, Side};
use crate::medium::{Medium, ModeKind, NormalComponent, WaveSurface};
use crate::wave::{ComplexVector, Frame, Number};
use glam::DVec3;
use num_complex::Complex64;

/// Splits a wave at the interface of two lossless media in which both polarizations share one wave
/// vector, given with their wave surfaces, as [`split_down_to`](super::split_down_to) does.
pub(super) fn split_single_wave<const N: usize>(
    media: [(&Medium, &WaveSurface); 2],
    wave: &IncidentWave<N>,
    normal: DVec3,
    least_power: f64,
    waves: &mut OutgoingWaves<N>,
) -> [f64; N] {
    let [(incident_medium, incident_surface), (transmitted_medium, transmitted_surface)] = media;
    let tangential = wave.wave_vector - normal * wave.wave_vector.dot(normal);
    let frame = Frame::new(normal, tangential);
    let along = tangential.dot(frame.first);
    // The incident wave is taken anew from its tangential part: near grazing incidence, where the
    // normal part is a small difference, all waves of the matching must agree on it.
    let (forward, backward) = incident_surface.normal_component(tangential, normal).real_pair();
    let here = FramedMedium::new(incident_medium, &frame, along);
    let (incident, reflected) = (here.wave(forward), here.wave(backward));
    let there = FramedMedium::new(transmitted_medium, &frame, along);
    let matching = Matching { wave, frame: &frame, incident };
    let backward_wave = frame.first * along + normal * backward;
    match transmitted_surface.normal_component(tangential, normal) {
        NormalComponent::Propagating { forward: q, .. } => {
            let transmitted = there.wave(q);
            let [back, on] = matching.tangential_fields(reflected, transmitted);
            let onward_wave = frame.first * along + normal * q;
            let mut weak = [0.0; N];
            let back_flux = back.map(|fields| reflected.flux(fields).abs());
            let on_flux = on.map(|fields| transmitted.flux(fields).abs());
            // Shares of the sum, not of the incident flux: the same, but for rounding near grazing
            // incidence, which would show in the account of the power.
            let total = |i: usize| back_flux[i] + on_flux[i];
            let power: [f64; N] = std::array::from_fn(|i| {
                let share = if back_flux[i] > 0.0 { back_flux[i] / total(i) } else { 0.0 };
                if share > ROUNDING { wave.power[i] * share } else { 0.0 }
            });
            if power.iter().any(|power| *power > 0.0 && *power >= least_power) {
                waves.push(matching.outgoing(
                    incident_surface,
                    backward_wave,
                    |field| reflected.lifted(&frame, field),
                    &back,
                    |i| (back_flux[i], total(i)),
                ));
            } else {
                weak = power;
            }
            waves.push(OutgoingWave {
                side: Side::Transmitted,
                ..matching.outgoing(
                    transmitted_surface,
                    onward_wave,
                    |field| transmitted.lifted(&frame, field),
                    &on,
                    |i| (on_flux[i], total(i)),
                )
            });
            weak
        }
        NormalComponent::Evanescent { re, im } => {
            let q = Complex64::new(re, im);
            let transmitted = there.wave(q);
            let [back, _] = matching.tangential_fields(reflected.into(), transmitted);
            let flux = back.map(|fields| reflected.flux(fields).abs());
            let wave = matching.outgoing(
                incident_surface,
                backward_wave,
                |field| reflected.lifted(&frame, field),
                &back,
                |i| (flux[i], flux[i]),
            );
            waves.push(wave);
            [0.0; N]
        }
    }
}

/// Tangential electric fields (E·first, E·second) for each launched polarization.
type TangentialFields<const N: usize> = [[Complex64; 2]; N];

/// What the matching of one incident wave needs.
struct Matching<'a, const N: usize> {
    wave: &'a IncidentWave<N>,
    frame: &'a Frame,
    incident: TangentialWave<f64>,
}

impl<const N: usize> Matching<'_, N> {
    /// The tangential electric fields of the reflected and the transmitted wave. With the
    /// admittances Y, E_t = E_i + E_r and Y_t E_t = Y_i E_i + Y_r E_r give
    /// (Y_t - Y_r) E_r = (Y_i - Y_t) E_i.
    fn tangential_fields<T: Number>(
        &self,
        reflected: TangentialWave<T>,
        transmitted: TangentialWave<T>,
    ) -> [TangentialFields<N>; 2] {
        let [[t00, t01], [t10, t11]] = transmitted.admittance;
        let [[r00, r01], [r10, r11]] = reflected.admittance;
        let [[i00, i01], [i10, i11]] = self.incident.admittance.map(|row| row.map(T::from));
        let (a, b, c, d) = (t00 - r00, t01 - r01, t10 - r10, t11 - r11);
        let inverse = T::from(1.0) / (a * d - b * c);
        let mut back = [[Complex64::ZERO; 2]; N];
        let mut on = back;
        for (i, electric) in self.wave.electric.iter().enumerate() {
            let [e0, e1] = self.tangential(*electric);
            let x = (i00 - t00).times(e0) + (i01 - t01).times(e1);
            let y = (i10 - t10).times(e0) + (i11 - t11).times(e1);
            back[i] =
                [inverse.times(d.times(x) - b.times(y)), inverse.times(a.times(y) - c.times(x))];
            on[i] = [e0 + back[i][0], e1 + back[i][1]];
        }
        [back, on]
    }

    fn tangential(&self, field: ComplexVector) -> [Complex64; 2] {
        [field.dot_real(self.frame.first), field.dot_real(self.frame.second)]
    }

    /// A propagating outgoing wave from its tangential fields, which `lifted` completes, and from its
    /// normal flux and that of all outgoing waves.
    fn outgoing(
        &self,
        surface: &WaveSurface,
        wave_vector: DVec3,
        lifted: impl Fn([Complex64; 2]) -> ComplexVector,
        fields: &TangentialFields<N>,
        fluxes: impl Fn(usize) -> (f64, f64),
    ) -> OutgoingWave<N> {
        let direction = surface.ray_direction(wave_vector);
        let cosine = direction.dot(self.frame.normal).abs();
        let mut power = [0.0; N];
        let mut electric = [ComplexVector::ZERO; N];
        for i in 0..N {
            let (flux, total) = fluxes(i);
            if flux > 0.0 {
                power[i] = self.wave.power[i] * (flux / total);
                // |Re(E × H*)| of the matched fields is the normal flux over the cosine.
                electric[i] = lifted(fields[i]) * (power[i] * cosine / flux).sqrt();
            }
        }
        OutgoingWave {
            side: Side::Reflected,
            mode: ModeKind::Shared,
            wave_vector,
            attenuation: DVec3::ZERO,
            direction,
            electric,
            power,
        }
    }
}

impl From<TangentialWave<f64>> for TangentialWave<Complex64> {
    fn from(wave: TangentialWave<f64>) -> Self {
        Self {
            lift: wave.lift.map(Complex64::from),
            admittance: wave.admittance.map(|row| row.map(Complex64::from)),
        }
    }
}
