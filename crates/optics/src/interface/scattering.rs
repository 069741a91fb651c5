//! The whole scattering matrix of an interface between modes.

use super::Side;
use super::matching::{amplitudes, fluxes, interference};
use crate::medium::{LocalMode, Medium, Mode, Tangential};
use crate::wave::Frame;
use glam::DVec3;
use num_complex::Complex64;

/// What an interface makes of either incident mode: the modes on both sides and the amplitudes and
/// powers between them. Slower than [`super::split`], and complete: evanescent modes are in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scattering {
    /// The two modes that run towards the interface.
    pub incident: [Mode; 2],
    /// The two modes that run back.
    pub reflected: [Mode; 2],
    /// The two modes beyond the interface; none in a conductor.
    pub transmitted: Option<[Mode; 2]>,
    /// Amplitudes: rows are the outgoing modes (reflected 1, 2, transmitted 1, 2), columns the
    /// incident ones. Zero for transmission into a conductor.
    pub amplitudes: [[Complex64; 2]; 4],
    /// Shares of the incident normal flux, by the same rows and columns; 0 for evanescent outgoing
    /// modes, `None` for evanescent incident ones. The shares of a column add up to 1 if the medium
    /// of incidence is lossless, with [`Self::interference`].
    pub power: [Option<[f64; 4]>; 2],
    /// What the two reflected modes, and the two transmitted ones, carry away from the interface
    /// together beyond what each carries alone, by the same columns: 0 in lossless media, of either
    /// sign in absorbing ones.
    pub interference: [Option<[f64; 2]>; 2],
    /// The same amplitudes as of fields of unit size; `None` unless the media on both sides are
    /// isotropic, or one is and the other is a conductor.
    pub jones: Option<JonesMatrices>,
}

/// What an interface of isotropic media makes of electric fields, by Fresnel's equations: rows are
/// s and p of the wave that leaves, columns those of the wave that comes.
///
/// The field of s lies along a unit vector s across the plane of incidence, the same for all waves;
/// that of p along s × k/√(k·k), k being each wave's own wave vector and the root that whose parts
/// have a positive sum: |k| of a wave that propagates, i|k·k|^½ in a metal without loss. So,
/// between dielectrics, r_s = (n₁ cos θ₁ - n₂ cos θ₂)/(n₁ cos θ₁ + n₂ cos θ₂) and
/// r_p = (n₂ cos θ₁ - n₁ cos θ₂)/(n₂ cos θ₁ + n₁ cos θ₂).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JonesMatrices {
    /// Of the wave that is reflected.
    pub reflected: [[Complex64; 2]; 2],
    /// Of the wave beyond; `None` in a conductor.
    pub transmitted: Option<[[Complex64; 2]; 2]>,
}

impl Scattering {
    /// The interface from `incident_medium` to `transmitted_medium`, a perfect conductor if `None`,
    /// for waves with the tangential wave vector `tangential`; the unit vector `normal` points from
    /// the first into the second.
    #[must_use]
    pub fn new(
        incident_medium: &Medium,
        transmitted_medium: Option<&Medium>,
        tangential: DVec3,
        normal: DVec3,
    ) -> Self {
        let across = tangential - normal * tangential.dot(normal);
        let frame = Frame::new(normal, across);
        let along = Tangential::Real(across.dot(frame.first));
        let [forward, backward] =
            incident_medium.both_ways(&frame, along, None).map(|modes| modes.complex());
        let onward = transmitted_medium.map(|medium| medium.onward(&frame, along).complex());
        let [a, b] = &forward;
        let amplitudes = amplitudes([a, b], &backward, onward.as_ref());
        let absorbs = |medium: &Medium| medium.absorbs();
        let lossless = !absorbs(incident_medium) && !transmitted_medium.is_some_and(absorbs);
        let power = std::array::from_fn(|column| {
            if !forward[column].propagating {
                return None;
            }
            let [r1, r2, t1, t2] = amplitudes.map(|row| row[column]);
            let [[r1], [r2]] = fluxes(&backward, [&[r1], &[r2]]);
            let [[t1], [t2]] =
                (onward.as_ref()).map_or([[0.0]; 2], |modes| fluxes(modes, [&[t1], &[t2]]));
            let flux = [r1, r2, t1, t2];
            // Over the sum where it must be 1: the same but for rounding near grazing incidence.
            let sum: f64 = flux.iter().sum();
            Some(if lossless && sum > 0.0 { flux.map(|flux| flux / sum) } else { flux })
        });
        let interference = std::array::from_fn(|column| {
            let [r1, r2, t1, t2] = amplitudes.map(|row| row[column]);
            let back = if absorbs(incident_medium) {
                interference(Side::Reflected, &backward, [r1, r2])
            } else {
                0.0
            };
            let on = (onward.as_ref())
                .filter(|_| transmitted_medium.is_some_and(absorbs))
                .map_or(0.0, |modes| interference(Side::Transmitted, modes, [t1, t2]));
            forward[column].propagating.then_some([back, on])
        });
        let in_world = |modes: [LocalMode<Complex64>; 2]| modes.map(|m| m.in_world(&frame, along));
        let (incident, reflected) = (in_world(forward), in_world(backward));
        let transmitted = onward.map(in_world);
        let isotropic =
            incident_medium.is_isotropic() && transmitted_medium.is_none_or(Medium::is_isotropic);
        let jones = isotropic.then(|| {
            let [r1, r2, t1, t2] = amplitudes;
            JonesMatrices {
                reflected: jones(&incident, &reflected, [r1, r2]),
                transmitted: transmitted.as_ref().map(|modes| jones(&incident, modes, [t1, t2])),
            }
        });
        Self { incident, reflected, transmitted, amplitudes, power, interference, jones }
    }
}

/// Amplitudes between modes s and p of isotropic media as those of fields of unit size.
fn jones(
    incident: &[Mode; 2],
    outgoing: &[Mode; 2],
    amplitudes: [[Complex64; 2]; 2],
) -> [[Complex64; 2]; 2] {
    // A multiple of the unit vector across the plane of incidence.
    let across = incident[0].electric;
    let sizes = |[s, p]: &[Mode; 2]| {
        let root = p.wave_vector.dot(p.wave_vector).sqrt();
        let root = if root.re + root.im < 0.0 { -root } else { root };
        let along = across.cross(p.wave_vector).scaled(root.inv());
        [s.electric.dot(across), p.electric.dot(along)]
    };
    let (from, to) = (sizes(incident), sizes(outgoing));
    std::array::from_fn(|row| {
        std::array::from_fn(|column| amplitudes[row][column] * to[row] / from[column])
    })
}
