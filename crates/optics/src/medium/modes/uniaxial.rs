//! Modes of uniaxial media.
//!
//! Worked out for the magnetic case, scalar ε and µ = µ_o (1 - a aᵀ) + µ_e a aᵀ. Ordinary wave:
//! p·p = ε µ_o, H along p × a. Extraordinary wave: p·µp = ε µ_o µ_e, E along p × a. The electric
//! case is its dual: ε and µ, E and H exchanged, one of the fields reversed.

use super::{Arriving, BOTH_MODES, LocalMode, LocalModes, ModeKind};
use crate::medium::class::Uniaxial;
use crate::medium::quadratic::{Quadratic, Roots};
use crate::wave::{Frame, Number, cross, dot};
use num_complex::Complex64;

/// A uniaxial medium before an interface: the axis in its frame and the normal components q of both
/// waves.
pub(super) struct UniaxialWaves<'a> {
    medium: &'a Uniaxial<f64>,
    along: f64,
    axis: [f64; 3],
    ordinary: Roots,
    extraordinary: Roots,
}

/// sin² of the angle of p to the axis below which both waves are one.
const ONE_WAVE: f64 = 1e-28;

impl<T: Number> Uniaxial<T> {
    /// The equations for q of the ordinary and the extraordinary wave.
    pub(super) fn equations(&self, [k1, k2]: [T; 2], axis: [f64; 3]) -> [Quadratic<T>; 2] {
        let Self { scalar, ordinary, extraordinary, .. } = *self;
        let squared = k1 * k1 + k2 * k2;
        let excess = extraordinary - ordinary;
        let on_axis = k1 * axis[0] + k2 * axis[1];
        let index = scalar * ordinary;
        [
            Quadratic { a: T::from(1.0), b: T::from(0.0), c: squared - index },
            Quadratic {
                a: ordinary + excess * (axis[2] * axis[2]),
                b: excess * axis[2] * on_axis,
                c: ordinary * squared + excess * on_axis * on_axis - index * extraordinary,
            },
        ]
    }

    /// The ordinary wave with H along `u`.
    pub(super) fn ordinary_mode(&self, p: [T; 3], u: [T; 3]) -> LocalMode<T> {
        let scale = T::from(-1.0) / self.scalar;
        let electric = cross(p, u).map(|component| component * scale);
        self.dual(ModeKind::Ordinary, p[2], electric, u)
    }

    /// The extraordinary wave with E along `u`, which is p × a but for p along a: H = µ⁻¹ (p × u), part by part
    /// across the axis and along it.
    ///
    /// The latter is (a · p × u)/µ_e = (p·a)²/µ_o - ε, by the wave's equation: the one whose terms are smaller loses
    /// less of its digits.
    pub(super) fn extraordinary_mode(&self, axis: [f64; 3], p: [T; 3], u: [T; 3]) -> LocalMode<T> {
        let a = axis.map(T::from);
        let (on_axis, across) = (dot(p, a), cross(a, u));
        let squared = on_axis * on_axis / self.ordinary;
        let size = |v: [T; 3]| v.into_iter().map(T::magnitude_squared).sum::<f64>();
        let by_equation = squared.magnitude_squared() + self.scalar.magnitude_squared();
        let terms = size(p) * size(across);
        let along = if terms <= by_equation * self.extraordinary.magnitude_squared() {
            T::from(-1.0) * dot(p, across) / self.extraordinary
        } else {
            squared - self.scalar
        };
        let onward = on_axis / self.ordinary;
        let magnetic = std::array::from_fn(|i| onward * across[i] + along * a[i]);
        self.dual(ModeKind::Extraordinary, p[2], u, magnetic)
    }

    /// The wave of the medium itself from that of the magnetic case.
    fn dual(&self, kind: ModeKind, q: T, electric: [T; 3], magnetic: [T; 3]) -> LocalMode<T> {
        let (electric, magnetic) = if self.electric {
            (magnetic.map(|component| -component), electric)
        } else {
            (electric, magnetic)
        };
        LocalMode { kind, propagating: true, q, electric, magnetic }
    }

    /// Orders and names a pair of waves along the optic axis, where both are one: s, p.
    pub(super) fn named_along_axis(
        &self,
        ordinary: LocalMode<T>,
        extraordinary: LocalMode<T>,
    ) -> [LocalMode<T>; 2] {
        // The wave with E across the plane of incidence: H is there for the other one.
        let (s, p) =
            if self.electric { (ordinary, extraordinary) } else { (extraordinary, ordinary) };
        [LocalMode { kind: ModeKind::S, ..s }, LocalMode { kind: ModeKind::P, ..p }]
    }
}

/// The direction of one field of both waves, p × a, and its square relative to |p|².
#[inline]
fn across_axis<T: Number>(p: [T; 3], axis: [f64; 3]) -> ([T; 3], f64) {
    let u = cross(p, axis.map(T::from));
    let square = |v: [T; 3]| v.into_iter().map(T::magnitude_squared).sum::<f64>();
    (u, square(u) / square(p))
}

/// The direction of one field of a wave; any that is across the plane of incidence where p is along
/// the axis, and whether it is.
#[inline]
pub(super) fn field_direction<T: Number>(p: [T; 3], axis: [f64; 3]) -> ([T; 3], bool) {
    let (u, angle) = across_axis(p, axis);
    if angle < ONE_WAVE { (out_of_plane(), true) } else { (u, false) }
}

/// Any vector across the plane of incidence.
pub(super) fn out_of_plane<T: Number>() -> [T; 3] {
    [T::from(0.0), T::from(1.0), T::from(0.0)]
}

impl Uniaxial<f64> {
    pub(super) fn waves(&self, frame: &Frame, along: f64, known: Option<f64>) -> UniaxialWaves<'_> {
        let axis = frame.components(self.axis);
        let equations = self.equations([along, 0.0], axis);
        let [ordinary, extraordinary] = equations;
        let (ordinary, extraordinary) = (Roots::of_square(-ordinary.c), extraordinary.roots());
        let mut waves = UniaxialWaves { medium: self, along, axis, ordinary, extraordinary };
        if let Some(q) = known {
            waves.keep_real(q, equations);
        }
        waves
    }
}

impl UniaxialWaves<'_> {
    /// Makes the roots of the wave with normal component `q` real, and as exact as that is.
    fn keep_real(&mut self, q: f64, [ordinary, extraordinary]: [Quadratic<f64>; 2]) {
        let distance = |roots: Roots| match roots {
            Roots::Real { plus, minus, .. } => (plus - q).abs().min((minus - q).abs()),
            Roots::Complex { re, im, .. } => (re - q).hypot(im),
        };
        let index = self.medium.scalar * self.medium.ordinary;
        let terms = self.along * self.along + index.abs();
        if distance(self.ordinary) <= distance(self.extraordinary) {
            self.ordinary = ordinary.refined(self.ordinary, q, terms).propagating();
        } else {
            let terms = terms * self.medium.extraordinary.abs().max(self.medium.ordinary.abs());
            self.extraordinary = extraordinary.refined(self.extraordinary, q, terms).propagating();
        }
    }

    /// The modes of one heading.
    pub fn modes(&self, forward: bool) -> LocalModes {
        match self.running(forward) {
            Some(waves) => LocalModes::Real(self.propagating(waves)),
            None => LocalModes::Complex(self.evanescent(forward)),
        }
    }

    /// The modes of the wave that arrives with the normal component `q`.
    pub fn arriving(&self, q: f64) -> Arriving {
        let Some([(qo, _), (qe, e_root)]) = self.running(true) else {
            return Arriving::Both(self.modes(true));
        };
        let (to_o, to_e) = ((qo - q).abs(), (qe - q).abs());
        if to_o.max(to_e) < BOTH_MODES * (1.0 + q.abs()) {
            return Arriving::Both(self.modes(true));
        }
        let po = [self.along, 0.0, qo];
        let (u, angle) = across_axis(po, self.axis);
        Arriving::One(if to_o <= to_e {
            let u = if angle < ONE_WAVE { out_of_plane() } else { u };
            self.medium.ordinary_mode(po, u)
        } else {
            let (qe, ue) = self.extraordinary(qo, qe, e_root, u, angle);
            self.medium.extraordinary_mode(self.axis, [self.along, 0.0, qe], ue)
        })
    }

    /// The normal component of the ordinary and of the extraordinary wave that run the given way,
    /// and the square roots in them with their signs, if both run.
    #[inline]
    fn running(&self, forward: bool) -> Option<[(f64, f64); 2]> {
        let [o_sign, e_sign] = self.signs(forward);
        let wave = |roots: Roots, sign: f64| match roots {
            Roots::Real { plus, minus, root } => Some((pick(sign, plus, minus), sign * root)),
            Roots::Complex { .. } => None,
        };
        Some([wave(self.ordinary, o_sign)?, wave(self.extraordinary, e_sign)?])
    }

    /// The sign of the root of each wave's equation that carries power the given way:
    /// S = p u²/ε and S = µp u²/(µ_o µ_e).
    fn signs(&self, forward: bool) -> [f64; 2] {
        let Uniaxial { scalar, ordinary, extraordinary, .. } = *self.medium;
        let heading = if forward { 1.0 } else { -1.0 };
        [heading * scalar.signum(), heading * (ordinary * extraordinary).signum()]
    }

    fn propagating(&self, [(qo, o_root), (qe, e_root)]: [(f64, f64); 2]) -> [LocalMode<f64>; 2] {
        let Self { medium, along, axis, .. } = *self;
        let Uniaxial { scalar, ordinary, extraordinary, .. } = *medium;
        let po = [along, 0.0, qo];
        let (mut u, angle) = across_axis(po, axis);
        if angle < ONE_WAVE {
            u = out_of_plane();
        }
        let (qe, ue) = self.extraordinary(qo, qe, e_root, u, angle);
        // Normal fluxes from the roots themselves, which keeps them exact down to grazing.
        let flux = (o_root * dot(u, u) / scalar).abs();
        let o = medium.ordinary_mode(po, u).scaled(flux.sqrt().recip());
        let flux = (e_root * dot(ue, ue) / (ordinary * extraordinary)).abs();
        let e = medium.extraordinary_mode(axis, [along, 0.0, qe], ue).scaled(flux.sqrt().recip());
        if angle < ONE_WAVE && qo == qe { medium.named_along_axis(o, e) } else { [o, e] }
    }

    /// q and p × a of the extraordinary wave, from its own q and from those of the ordinary one,
    /// whose angle to the axis has the sin² `angle`.
    ///
    /// Close to the axis the two directions p × a must agree better than each is known. With q_e =
    /// q_o + d and G = µp_o·n, a d² + 2 G d = (µ_e - µ_o) (p_o × a)² and µp_e·n = a d + G.
    fn extraordinary(
        &self,
        qo: f64,
        qe: f64,
        e_root: f64,
        u: [f64; 3],
        angle: f64,
    ) -> (f64, [f64; 3]) {
        let Self { medium, along, axis, .. } = *self;
        let near = angle < 1e-3;
        if !near {
            return (qe, across_axis([along, 0.0, qe], axis).0);
        }
        let excess = medium.extraordinary - medium.ordinary;
        let g = medium.ordinary * qo + excess * (along * axis[0] + qo * axis[2]) * axis[2];
        if g * e_root <= 0.0 {
            // The extraordinary wave of the other heading, near grazing.
            return (qe, field_direction([along, 0.0, qe], axis).0);
        }
        if angle < ONE_WAVE {
            return (qo, u);
        }
        let d = excess * dot(u, u) / (g + e_root);
        (qo + d, [u[0] - d * axis[1], u[1] + d * axis[0], u[2]])
    }

    fn evanescent(&self, forward: bool) -> [LocalMode<Complex64>; 2] {
        let Self { medium, along, axis, .. } = *self;
        let medium = medium.map(Complex64::from);
        let q = |roots: Roots, sign: f64| match roots {
            Roots::Real { plus, minus, .. } => (Complex64::from(pick(sign, plus, minus)), true),
            Roots::Complex { re, im, .. } => {
                (Complex64::new(re, if forward { im } else { -im }), false)
            }
        };
        let [o_sign, e_sign] = self.signs(forward);
        let (qo, o_runs) = q(self.ordinary, o_sign);
        let (qe, e_runs) = q(self.extraordinary, e_sign);
        let po = [along.into(), Complex64::ZERO, qo];
        let pe = [along.into(), Complex64::ZERO, qe];
        let [(uo, o_on_axis), (ue, e_on_axis)] = [po, pe].map(|p| field_direction(p, axis));
        let normalized = |mode: LocalMode<Complex64>, runs: bool| {
            let size = if runs { mode.flux().abs() } else { mode.norm_squared() };
            LocalMode { propagating: runs, ..mode.scaled(size.sqrt().recip()) }
        };
        let o = normalized(medium.ordinary_mode(po, uo), o_runs);
        let e = normalized(medium.extraordinary_mode(axis, pe, ue), e_runs);
        if o_on_axis && e_on_axis { medium.named_along_axis(o, e) } else { [o, e] }
    }
}

fn pick(sign: f64, plus: f64, minus: f64) -> f64 {
    if sign > 0.0 { plus } else { minus }
}
