//! Modes of media in which both polarizations share one wave vector.

use super::{LocalMode, LocalModes, ModeKind};
use crate::medium::class::Class;
use crate::medium::quadratic::Roots;
use crate::medium::{Medium, WaveSurface};
use crate::wave::{Frame, Number, cross, dot};
use num_complex::Complex64;

/// The tensors µ = M and ε = z M in the frame of an interface, and the roots for q.
pub(crate) struct SingleWave {
    along: f64,
    form: [[f64; 3]; 3],
    determinant: f64,
    ratio: f64,
    roots: Roots,
}

impl Medium {
    pub(super) fn single_wave_modes(
        &self,
        surface: &WaveSurface,
        frame: &Frame,
        along: f64,
        known: Option<f64>,
    ) -> SingleWave {
        let roots = surface.roots_with(known, frame.first * along, frame.normal);
        let mu = self.real.permeability.x_axis;
        let (form, determinant) = if let Class::Isotropic(_) = self.class {
            ([[mu.x, 0.0, 0.0], [0.0, mu.x, 0.0], [0.0, 0.0, mu.x]], mu.x * mu.x * mu.x)
        } else {
            (frame.tensor(&self.real.permeability), self.real.permeability.determinant())
        };
        SingleWave {
            along,
            form,
            determinant,
            ratio: self.real.permittivity.x_axis.dot(mu) / mu.length_squared(),
            roots: if known.is_some() { roots.propagating() } else { roots },
        }
    }
}

impl SingleWave {
    /// The modes s and p of one heading.
    pub fn modes(&self, forward: bool) -> LocalModes {
        match self.roots {
            Roots::Real { plus, minus, .. } => {
                let q = if forward { plus } else { minus };
                let modes = self.pair(q);
                // Where the surface has no normal-normal entry, the flux may be lost in rounding.
                LocalModes::Real(modes.map(|mode| {
                    let flux = mode.flux().abs().max(1e-18 * mode.norm_squared());
                    mode.scaled(flux.sqrt().recip())
                }))
            }
            Roots::Complex { re, im, .. } => {
                let q = Complex64::new(re, if forward { im } else { -im });
                LocalModes::Complex(
                    self.pair(q).map(|mode| LocalMode { propagating: false, ..mode.normalized() }),
                )
            }
        }
    }

    /// Fields of any size. With v across the normal and M p, E = v and H = M⁻¹ (p × v) =
    /// (M p × M v)/det M are a wave; its dual, H = v and E = -ε⁻¹ (p × v), is the other one.
    fn pair<T: Number>(&self, q: T) -> [LocalMode<T>; 2] {
        let p = [T::from(self.along), T::from(0.0), q];
        let apply = |v: [T; 3]| self.form.map(|row| dot(row.map(T::from), v));
        let ray = apply(p);
        let mut v = [-ray[1], ray[0], T::from(0.0)];
        let across = v[0].magnitude_squared() + v[1].magnitude_squared();
        if across <= 1e-28 * ray[2].magnitude_squared() {
            v = [T::from(0.0), T::from(1.0), T::from(0.0)];
        }
        let curl = cross(ray, apply(v)).map(|c| c * (1.0 / self.determinant));
        let s = LocalMode { kind: ModeKind::S, propagating: true, q, electric: v, magnetic: curl };
        let p = LocalMode {
            kind: ModeKind::P,
            electric: curl.map(|c| c * (-1.0 / self.ratio)),
            magnetic: v,
            ..s
        };
        [s, p]
    }
}
