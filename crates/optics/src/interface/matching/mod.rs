//! The interface of any two media: two modes out on either side, four tangential fields to match.

mod coated;
mod isotropic_before;
mod isotropic_beyond;

pub use coated::{Backing, Film, FilmLayer, split_coated};

use super::isotropic::Layer;
use super::splitting::Splitting;
use super::{OutgoingWave, Side};
use crate::medium::{BOTH_MODES, LocalMode, LocalModes, Medium, ModeKind, Tangential, mutual_flux};
use crate::wave::{ComplexVector, Number, solve};
use arrayvec::ArrayVec;
use glam::DVec3;
use num_complex::Complex64;

/// Normal components closer than this are those of one wave, that both modes are.
const ONE_WAVE: f64 = 1e-12;

/// On the axis of a biaxial medium one wave vector has a cone of rays; rays closer than this are
/// one.
const ONE_RAY: f64 = 1e-9;

/// Splits a wave at the interface of any two media, or at a conductor: adds the outgoing waves that
/// are strong enough; the power of the others.
pub(super) fn split_into_modes<const N: usize>(
    incident_medium: &Medium,
    transmitted_medium: Option<&Medium>,
    splitting: Splitting<'_, N>,
) -> [f64; N] {
    let Splitting { wave, frame, .. } = splitting;
    let normal_component = wave.wave_vector.dot(frame.normal);
    let tangential = tangential(&splitting);
    let mut scattered = Scattered { splitting, tangential, weak: [0.0; N] };
    // Modes are large, and stay where they are made.
    if let (Some(medium), Some(beyond), Tangential::Real(along)) =
        (incident_medium.scalars(), transmitted_medium, tangential)
        && !beyond.absorbs()
    {
        let layer = Layer::arriving(medium, along, normal_component);
        match &beyond.onward(&frame, tangential) {
            LocalModes::Real(modes) => scattered.match_from_isotropic(layer, modes),
            LocalModes::Complex(modes) => scattered.match_from_isotropic(layer, modes),
        }
        return scattered.weak;
    }
    let (arriving, backward) =
        &incident_medium.arriving_and_back(&frame, tangential, normal_component);
    let arriving_real = arriving.real().zip(backward.real());
    if let (Some(medium), Tangential::Real(along)) =
        (transmitted_medium.and_then(Medium::scalars), tangential)
        && let Some((arriving, backward)) = arriving_real
        && !incident_medium.absorbs()
    {
        let incident = scattered.incident(arriving, normal_component);
        scattered.match_isotropic(&incident, backward, Layer::new(medium, along));
        return scattered.weak;
    }
    let onward = &transmitted_medium.map(|medium| medium.onward(&frame, tangential));
    let absorbing = incident_medium.absorbs() || transmitted_medium.is_some_and(Medium::absorbs);
    let onward_real = onward.as_ref().map(LocalModes::real);
    match (arriving_real, onward_real) {
        (Some((arriving, backward)), None | Some(Some(_))) => {
            let onward = onward_real.flatten();
            scattered.scatter(arriving, backward, onward, normal_component, absorbing);
        }
        _ => {
            let (arriving, backward) = (arriving.complex(), backward.complex());
            let onward = onward.as_ref().map(LocalModes::complex);
            let onward = onward.as_ref();
            scattered.scatter(&arriving, &backward, onward, normal_component, absorbing);
        }
    }
    scattered.weak
}

/// The tangential part of the wave vector, which all waves of the interface share.
fn tangential<const N: usize>(splitting: &Splitting<'_, N>) -> Tangential {
    let Splitting { wave, frame, along, .. } = splitting;
    if wave.attenuation == DVec3::ZERO {
        return Tangential::Real(*along);
    }
    let decay = [wave.attenuation.dot(frame.first), wave.attenuation.dot(frame.second)];
    Tangential::Complex([Complex64::new(*along, decay[0]), Complex64::new(0.0, decay[1])])
}

/// The outgoing amplitudes, reflected 1, 2, transmitted 1, 2, of `R` incident modes. At a
/// conductor, where nothing is transmitted, the tangential electric field vanishes.
pub(super) fn amplitudes<T: Number, const R: usize>(
    incident: [&LocalMode<T>; R],
    reflected: &[LocalMode<T>; 2],
    transmitted: Option<&[LocalMode<T>; 2]>,
) -> [[T; R]; 4] {
    let fields = |mode: &LocalMode<T>| {
        let ([e0, e1, _], [h0, h1, _]) = (mode.electric, mode.magnetic);
        [e0, e1, h0, h1]
    };
    let incident = incident.map(fields);
    let [r1, r2] = reflected.each_ref().map(fields);
    let Some([t1, t2]) = transmitted.map(|modes| modes.each_ref().map(fields)) else {
        let cancelling = cancelling([r1[0], r1[1]], [r2[0], r2[1]]);
        let pairs = incident.map(|[e0, e1, ..]| cancelling([e0, e1]));
        let zero = [T::from(0.0); R];
        return [pairs.map(|[one, _]| one), pairs.map(|[_, two]| two), zero, zero];
    };
    let matrix = std::array::from_fn(|i| [r1[i], r2[i], -t1[i], -t2[i]]);
    solve(matrix, std::array::from_fn(|i| incident.map(|fields| -fields[i])))
}

/// The amplitudes of two pairs [a, c] and [b, d] that make a third one vanish in the sum.
fn cancelling<T: Number>([a, c]: [T; 2], [b, d]: [T; 2]) -> impl Fn([T; 2]) -> [T; 2] {
    let determinant = a * d - b * c;
    let least = determinant.magnitude_squared() < 1e-60;
    let inverse = T::from(1.0) / if least { T::from(1e-30) } else { determinant };
    move |[x, y]| [inverse * (b * y - d * x), inverse * (c * x - a * y)]
}

/// A wave being scattered.
struct Scattered<'a, const N: usize> {
    splitting: Splitting<'a, N>,
    tangential: Tangential,
    /// The power of the waves that are too weak.
    weak: [f64; N],
}

/// A mode of the wave that arrives, and its amplitudes in the launched fields.
type Incident<'m, T, const N: usize> = (&'m LocalMode<T>, [Complex64; N]);

/// The normal fluxes of both modes on one side, for each launched polarization.
type Fluxes<const N: usize> = [[f64; N]; 2];

/// What turns outgoing fluxes into powers, and matched fields into those of rays but for the length
/// of the Poynting vector.
struct Shares<const N: usize> {
    power: [f64; N],
    /// Their square roots.
    field: [f64; N],
    /// Whether a medium absorbs: what modes carry together then is in no mode's power.
    absorbing: bool,
}

impl<const N: usize> Shares<N> {
    /// Of the incident powers, given the incident fluxes or, the same without absorption, the sums
    /// of all outgoing ones.
    fn of(power: [f64; N], total: [f64; N], absorbing: bool) -> Self {
        let power = std::array::from_fn(|i| if total[i] > 0.0 { power[i] / total[i] } else { 0.0 });
        Self { power, field: power.map(f64::sqrt), absorbing }
    }
}

impl<const N: usize> Scattered<'_, N> {
    /// The incident mode or, where two are nearly one, both.
    fn incident<'m, T: Number>(
        &self,
        arriving: &'m [LocalMode<T>],
        normal_component: f64,
    ) -> ArrayVec<Incident<'m, T, N>, 2> {
        let distance = |mode: &LocalMode<T>| {
            if mode.propagating { (mode.q.real() - normal_component).abs() } else { f64::MAX }
        };
        let near = BOTH_MODES * (1.0 + normal_component.abs());
        let mode = match arriving {
            [a, b] => {
                let (to_a, to_b) = (distance(a), distance(b));
                // At grazing incidence the wave is both as far from either.
                if to_a.max(to_b) < f64::MAX && (to_a - to_b).abs() < near {
                    let parts = self.parts(a, b);
                    return [(a, parts.map(|[in_a, _]| in_a)), (b, parts.map(|[_, in_b]| in_b))]
                        .into();
                }
                if to_a <= to_b { a } else { b }
            }
            [mode] => mode,
            _ => return ArrayVec::new(),
        };
        let field = self.splitting.frame.complex_vector(mode.electric);
        let conjugate = field.conj();
        let scale = 1.0 / field.norm_squared();
        let parts = self.splitting.wave.electric.map(|electric| conjugate.dot(electric) * scale);
        std::iter::once((mode, parts)).collect()
    }

    /// Matches the fields.
    fn scatter<T: Number>(
        &mut self,
        arriving: &[LocalMode<T>],
        backward: &[LocalMode<T>; 2],
        onward: Option<&[LocalMode<T>; 2]>,
        normal_component: f64,
        absorbing: bool,
    ) {
        let incident = self.incident(arriving, normal_component);
        if let Some(outgoing) = matched(&incident, backward, onward) {
            self.share_out(&incident, backward, onward, &outgoing, absorbing);
        }
    }

    /// Adds the waves of the given amplitudes, reflected 1, 2, transmitted 1, 2.
    #[inline(always)]
    fn share_out<T: Number>(
        &mut self,
        incident: &[Incident<'_, T, N>],
        backward: &[LocalMode<T>; 2],
        onward: Option<&[LocalMode<T>; 2]>,
        [r1, r2, t1, t2]: &[[Complex64; N]; 4],
        absorbing: bool,
    ) {
        let back = fluxes(backward, [r1, r2]);
        let on = onward.map_or([[0.0; N]; 2], |onward| fluxes(onward, [t1, t2]));
        let total = if absorbing {
            // Modes carry what they carry alone; what they carry together belongs to none.
            std::array::from_fn(|i| {
                let alone =
                    |(mode, parts): &Incident<'_, T, N>| mode.flux().abs() * parts[i].norm_sqr();
                let alone: f64 = incident.iter().map(alone).sum();
                match incident {
                    [(a, in_a), (b, in_b)] => {
                        let mutual: Complex64 = mutual_flux(*a, *b).into();
                        alone + 2.0 * (in_a[i] * in_b[i].conj() * mutual).re
                    }
                    _ => alone,
                }
            })
        } else {
            // Over the sum, not over the incident flux: the same, but for rounding near grazing
            // incidence, which would show in the account of the power.
            std::array::from_fn(|i| back[0][i] + back[1][i] + on[0][i] + on[1][i])
        };
        let shares = Shares::of(self.splitting.wave.power, total, absorbing);
        self.one_side(Side::Reflected, backward, [r1, r2], &back, &shares);
        if let Some(onward) = onward {
            self.one_side(Side::Transmitted, onward, [t1, t2], &on, &shares);
        }
    }

    /// The amplitudes of two modes in the launched fields, by least squares.
    fn parts<T: Number>(&self, a: &LocalMode<T>, b: &LocalMode<T>) -> [[Complex64; 2]; N] {
        let [a, b] = [a, b].map(|mode| self.splitting.frame.complex_vector(mode.electric));
        let (aa, bb, ab) = (a.norm_squared(), b.norm_squared(), a.conj().dot(b));
        let inverse = 1.0 / (aa * bb - ab.norm_sqr());
        self.splitting.wave.electric.map(|electric| {
            let (on_a, on_b) = (a.conj().dot(electric), b.conj().dot(electric));
            [(on_a * bb - ab * on_b) * inverse, (on_b * aa - ab.conj() * on_a) * inverse]
        })
    }

    fn one_side<T: Number>(
        &mut self,
        side: Side,
        modes: &[LocalMode<T>; 2],
        amplitudes: [&[Complex64; N]; 2],
        fluxes: &Fluxes<N>,
        shares: &Shares<N>,
    ) {
        let ([a, b], frame) = (modes, self.splitting.frame);
        let apart: Complex64 = a.q.into() - b.q.into();
        let one_wave = a.propagating
            && b.propagating
            && apart.norm_sqr() <= (ONE_WAVE * ONE_WAVE) * (1.0 + a.q.magnitude_squared());
        if one_wave && share_ray(modes) {
            let power: [f64; N] = std::array::from_fn(|i| {
                // In the sum of all outgoing fluxes there is nothing of it.
                let together = if shares.absorbing {
                    interference(side, modes, amplitudes.map(|of| of[i]))
                } else {
                    0.0
                };
                (fluxes[0][i] + fluxes[1][i] + together).max(0.0) * shares.power[i]
            });
            if self.is_strong(power) {
                let [ea, eb] = [a, b].map(|mode| frame.complex_vector(mode.electric));
                // The same ray, but in absorbing media, where p's and s's part a little: their
                // mean.
                let ray = (frame.vector(a.poynting()) + frame.vector(b.poynting())) * 0.5;
                let wave = (side, ModeKind::Shared, a.q.into());
                self.push(wave, ray, power, shares, |i, scale| {
                    (ea.scaled(amplitudes[0][i]) + eb.scaled(amplitudes[1][i])) * scale
                });
            }
            return;
        }
        for ((mode, amplitude), flux) in modes.iter().zip(amplitudes).zip(fluxes) {
            let power: [f64; N] = std::array::from_fn(|i| flux[i] * shares.power[i]);
            if mode.propagating && self.is_strong(power) {
                let field = T::vector(&frame, mode.electric);
                let ray = frame.vector(mode.poynting());
                let wave = (side, mode.kind, mode.q.into());
                self.push(wave, ray, power, shares, |i, scale| {
                    T::wave(field, amplitude[i] * scale)
                });
            }
        }
    }

    /// Whether a wave of that power goes on; else its power is counted.
    fn is_strong(&mut self, power: [f64; N]) -> bool {
        let largest = power.iter().copied().fold(0.0, f64::max);
        let strong = largest > 0.0 && largest >= self.splitting.least_power;
        if !strong {
            self.count_as_weak(power);
        }
        strong
    }

    fn count_as_weak(&mut self, power: [f64; N]) {
        for (sum, power) in self.weak.iter_mut().zip(power) {
            *sum += power;
        }
    }

    /// Adds a wave, given the Poynting vector of a unit of normal flux, and its matched fields
    /// times a number.
    fn push(
        &mut self,
        (side, mode, q): (Side, ModeKind, Complex64),
        ray: DVec3,
        power: [f64; N],
        shares: &Shares<N>,
        field: impl Fn(usize, f64) -> ComplexVector,
    ) {
        let length = ray.length();
        let [first, second] = self.tangential.components();
        let wave_vector = self.splitting.frame.vector([first.re, second.re, q.re]);
        if is_evanescent(wave_vector, q, 1.0 / length) {
            // In a medium that absorbs it counts as absorbed, as what no wave carries does.
            if !shares.absorbing {
                self.count_as_weak(power);
            }
            return;
        }
        // The fields of a ray are scaled to its power.
        let narrowing = length.sqrt().recip();
        let attenuation = match self.tangential {
            Tangential::Real(_) if q.im == 0.0 => DVec3::ZERO,
            _ => self.splitting.frame.vector([first.im, second.im, q.im]),
        };
        self.splitting.waves.push(OutgoingWave {
            side,
            mode,
            wave_vector,
            attenuation,
            direction: ray / length,
            electric: std::array::from_fn(|i| field(i, shares.field[i] * narrowing)),
            power,
        });
    }
}

/// Above this cosine between ray and normal a wave that decays is followed as others are: in metal
/// it is gone within a wavelength.
const ALONG_THE_SURFACE: f64 = 0.01;

/// Whether a wave that decays from a surface, or along it, is evanescent but for what the medium
/// absorbs, or the wave that has made it lost: it decays faster than its power comes away from the
/// surface. No ray is; followed along its Poynting vector, it would leave the light that feeds it.
fn is_evanescent(wave_vector: DVec3, q: Complex64, cosine: f64) -> bool {
    q.im != 0.0 && cosine < ALONG_THE_SURFACE && q.im.abs() > cosine * wave_vector.length()
}

/// Whether two modes of one wave vector have one ray. s and p do; in absorbing media theirs part a
/// little. Where the modes have no such names they are two of the plane of fields, each with its
/// own ray on the cone.
fn share_ray<T: Number>([a, b]: &[LocalMode<T>; 2]) -> bool {
    let ray = |mode: &LocalMode<T>| DVec3::from(mode.poynting()).normalize_or_zero();
    matches!(a.kind, ModeKind::S | ModeKind::P) || ray(a).distance(ray(b)) <= ONE_RAY
}

/// The outgoing amplitudes of an incident wave, for each launched polarization; none without a
/// wave.
#[inline(always)]
fn matched<T: Number, const N: usize>(
    incident: &[Incident<'_, T, N>],
    backward: &[LocalMode<T>; 2],
    onward: Option<&[LocalMode<T>; 2]>,
) -> Option<[[Complex64; N]; 4]> {
    Some(match incident {
        [(a, in_a), (b, in_b)] => {
            let with = amplitudes([*a, *b], backward, onward);
            with.map(|[with_a, with_b]| {
                std::array::from_fn(|i| with_a * in_a[i] + with_b * in_b[i])
            })
        }
        [(mode, parts)] => {
            amplitudes([*mode], backward, onward).map(|[with]| parts.map(|part| with * part))
        }
        _ => return None,
    })
}

/// The outgoing normal fluxes of modes of the given amplitudes; those that do not propagate have
/// none.
pub(super) fn fluxes<T: Number, const N: usize>(
    modes: &[LocalMode<T>; 2],
    amplitudes: [&[Complex64; N]; 2],
) -> Fluxes<N> {
    std::array::from_fn(|mode| {
        if modes[mode].propagating {
            amplitudes[mode].map(|amplitude| amplitude.norm_sqr())
        } else {
            [0.0; N]
        }
    })
}

/// What two modes on one side carry out of the interface together beyond what each carries alone:
/// nothing in a lossless medium, where they are orthogonal in flux.
pub(super) fn interference<T: Number>(
    side: Side,
    [a, b]: &[LocalMode<T>; 2],
    [in_a, in_b]: [Complex64; 2],
) -> f64 {
    if !a.propagating || !b.propagating {
        return 0.0;
    }
    let mutual: Complex64 = mutual_flux(a, b).into();
    let orientation = if side == Side::Reflected { -1.0 } else { 1.0 };
    2.0 * orientation * (in_a * in_b.conj() * mutual).re
}
