//! The waves of a medium whose rays run along a given direction.

use super::class::Class;
use super::{Heading, Medium, Mode, ModeKind};
use crate::wave::{ComplexVector, poynting};
use arrayvec::ArrayVec;
use glam::{DMat3, DVec2, DVec3};
use num_complex::Complex64;

/// A wave with a given ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayWave {
    /// Which of the medium's waves it is.
    pub kind: ModeKind,
    /// Wave vector; its real part in an absorbing medium.
    pub wave_vector: DVec3,
    /// The imaginary part of the wave vector.
    pub attenuation: DVec3,
    /// The electric field with |Re(E × H*)| = 1; `None` where any field across the ray is one, but
    /// for its size.
    pub electric: Option<ComplexVector>,
}

/// Rays closer than this to the direction asked for run along it.
const ALONG: f64 = 1e-13;

/// A ray that is not found closer than this is not there.
const FOUND: f64 = 1e-9;

/// Newton's steps at most.
const MOST_STEPS: usize = 60;

impl Medium {
    /// The waves whose Poynting vector points along the unit vector `direction`: one where both
    /// polarizations share it, else up to two; none where no ray runs so, as beside the cone of a
    /// hyperbolic medium.
    #[must_use]
    pub fn waves_along_ray(&self, direction: DVec3) -> ArrayVec<RayWave, 2> {
        let shared = |wave_vector: DVec3, attenuation: DVec3| RayWave {
            kind: ModeKind::Shared,
            wave_vector,
            attenuation,
            electric: None,
        };
        if let Some(surface) = self.wave_surface() {
            let wave = surface.wave_of_ray(direction);
            return wave.map(|wave| shared(wave, DVec3::ZERO)).into_iter().collect();
        }
        if let Class::AbsorbingIsotropic(e, m) = self.class {
            // The product of the roots with positive imaginary parts is that of the wave that
            // decays.
            let root = |value: Complex64| {
                let root = value.sqrt();
                if root.im < 0.0 { -root } else { root }
            };
            let index = root(e) * root(m);
            return std::iter::once(shared(direction * index.re, direction * index.im)).collect();
        }
        if !self.absorbs() {
            return self.lossless_waves_along_ray(direction);
        }
        let wave = |number: usize| self.wave_with_ray(number, direction);
        let mut waves: ArrayVec<RayWave, 2> = (0..2).filter_map(wave).collect();
        if let [a, b] = waves.as_slice()
            && let (Some(one), Some(other)) = (a.electric, b.electric)
            && one.cross(other).norm_squared() < 1e-12 * one.norm_squared() * other.norm_squared()
        {
            // Both searches have found the same wave.
            waves.pop();
        }
        waves
    }

    /// The same of lossless anisotropic media. With the vector t along the ray, t·p = 1, Maxwell's
    /// equations are t × D = µ⁻¹B and t × B = -ε⁻¹D: those of the modes of a medium with these
    /// tensors (Born & Wolf, Principles of Optics, 15.2), of which p = D × B/(t·D × B). On an axis
    /// of equal ray velocities any two of these serve.
    fn lossless_waves_along_ray(&self, direction: DVec3) -> ArrayVec<RayWave, 2> {
        let inverse = |tensor: &DMat3| {
            let inverse = tensor.inverse();
            (inverse + inverse.transpose()) * 0.5
        };
        let tensors = [inverse(&self.real.permittivity), inverse(&self.real.permeability)];
        let Ok(dual) = Self::new(tensors[0], tensors[1]) else { return ArrayVec::new() };
        let headings = [Heading::Forward, Heading::Backward];
        let modes = headings.into_iter().flat_map(|to| dual.modes(DVec3::ZERO, direction, to));
        let mut waves: ArrayVec<RayWave, 2> = modes
            .filter(Mode::is_propagating)
            .filter_map(|Mode { kind, wave_vector: ray, electric: d, magnetic: b, .. }| {
                let (electric, magnetic) = (d.transformed(&tensors[0]), b.transformed(&tensors[1]));
                let power = poynting(electric, magnetic).dot(direction);
                let wave_vector = poynting(d, b);
                (power > 0.0).then(|| RayWave {
                    kind,
                    wave_vector: wave_vector / wave_vector.dot(ray.re),
                    attenuation: DVec3::ZERO,
                    electric: Some(electric * power.sqrt().recip()),
                })
            })
            .take(2)
            .collect();
        if let [a, b] = waves.as_mut_slice()
            && a.kind == ModeKind::First
        {
            let swap = b.wave_vector.length() < a.wave_vector.length();
            [a.kind, b.kind] = [ModeKind::First, ModeKind::Second];
            if swap {
                std::mem::swap(&mut a.kind, &mut b.kind);
            }
        }
        waves
    }

    /// Of the two modes along `direction` the one of that number, its wave normal turned until its
    /// ray runs along `direction`.
    fn wave_with_ray(&self, number: usize, direction: DVec3) -> Option<RayWave> {
        let (first, second) = direction.any_orthonormal_pair();
        let mode = |normal: DVec3| -> Option<(Mode, DVec2)> {
            // Where the phase runs against the power, the normal does, too.
            [normal, -normal].into_iter().find_map(|normal| {
                let mode = self.modes(DVec3::ZERO, normal, Heading::Forward)[number];
                let ray = mode.ray.filter(|ray| ray.dot(direction) > 0.0)?;
                Some((mode, DVec2::new(ray.dot(first), ray.dot(second))))
            })
        };
        let mut normal = direction;
        let (mut found, mut off) = mode(normal)?;
        for _ in 0..MOST_STEPS {
            if off.length() <= ALONG {
                break;
            }
            // The derivative of the ray by the normal, from two neighbours.
            const STEP: f64 = 1e-6;
            let beside =
                |across: DVec3| Some((mode((normal + across * STEP).normalize())?.1 - off) / STEP);
            let (a, b) = (beside(first)?, beside(second)?);
            let turn = DVec2::new(b.perp_dot(off), off.perp_dot(a)) / a.perp_dot(b);
            if !turn.is_finite() {
                break;
            }
            // Shorter steps where a whole one leads away.
            let shares =
                std::iter::successors(Some(1.0_f64.min(0.3 / turn.length())), |s| Some(s / 2.0));
            let better = shares.take(12).find_map(|share| {
                let next = (normal + (first * turn.x + second * turn.y) * share).normalize();
                let (mode, next_off) = mode(next)?;
                (next_off.length() < off.length()).then_some((next, mode, next_off))
            });
            let Some(better) = better else { break };
            (normal, found, off) = better;
        }
        let flux = found.poynting().length();
        (off.length() <= FOUND).then(|| RayWave {
            kind: found.kind,
            wave_vector: found.wave_vector.re,
            attenuation: found.wave_vector.im,
            electric: Some(found.electric * flux.sqrt().recip()),
        })
    }
}

impl super::WaveSurface {
    /// The wave vector p of the wave whose ray runs along a unit vector: Ap along it, p·Ap = c.
    fn wave_of_ray(&self, direction: DVec3) -> Option<DVec3> {
        let wave = self.form.inverse() * direction;
        let square = self.constant / direction.dot(wave);
        (square > 0.0 && square.is_finite()).then(|| wave * square.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(medium: &Medium, direction: DVec3, count: usize) {
        let waves = medium.waves_along_ray(direction);
        assert_eq!(waves.len(), count, "{medium:?}");
        for wave in waves {
            let across = direction.any_orthonormal_vector().into();
            let electric = wave.electric.unwrap_or(across);
            let ray = medium.poynting(wave.wave_vector, electric);
            assert!(ray.normalize().distance(direction) < 1e-9, "{wave:?} {ray}");
            assert!(wave.electric.is_none() || (ray.length() - 1.0).abs() < 1e-9, "{wave:?}");
        }
    }

    #[test]
    fn rays_on_the_axes_of_a_biaxial_medium_have_two_waves() {
        let [a, b, c] = [1.0 / 2.25, 1.0 / 2.56, 1.0 / 3.24];
        let crystal = Medium::new(DMat3::from_diagonal(DVec3::new(a, b, c)).inverse(), 1.0);
        let crystal = crystal.expect("a medium");
        // Of equal wave vectors, and of equal ray velocities.
        let optic = ((a - b) / (b - c)).sqrt();
        let ray = (c / a).sqrt() * optic;
        for tan in [optic, ray] {
            check(&crystal, DVec3::new(tan, 0.0, 1.0).normalize(), 2);
            check(&crystal, DVec3::new(-tan, 0.0, 1.0).normalize(), 2);
        }
    }

    #[test]
    fn rays_run_along_their_direction() {
        let crystal = DMat3::from_diagonal(DVec3::new(2.609, 2.613, 2.641));
        let matched = DMat3::from_diagonal(DVec3::new(3.27, 0.31, 2.366));
        for direction in [[0.3, -0.5, 0.8], [-0.9, 0.1, 0.2], [0.5, 0.7, 0.1]] {
            let direction = DVec3::from_array(direction).normalize();
            check(&Medium::dielectric(1.5), direction, 1);
            check(&Medium::isotropic(-2.0, -1.5).expect("a medium"), direction, 1);
            check(&Medium::impedance_matched(matched).expect("a medium"), direction, 1);
            check(&Medium::new(crystal, 1.0).expect("a medium"), direction, 2);
            let axis = DVec3::new(1.0, 2.0, 0.5);
            for [ordinary, extraordinary] in [[2.75, 2.21], [3.27, 0.31], [0.31, 3.27]] {
                let magnetic = Medium::uniaxial_magnetic(2.366, ordinary, extraordinary, axis);
                check(&magnetic.expect("a medium"), direction, 2);
                let electric = Medium::uniaxial_electric(1.0, ordinary, extraordinary, axis);
                check(&electric.expect("a medium"), direction, 2);
            }
        }
    }
}
