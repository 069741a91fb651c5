//! Modes in the frame of an interface, as the matching of fields wants them.

use super::{Mode, ModeKind};
use crate::wave::{Frame, Number, cross};
use arrayvec::ArrayVec;
use num_complex::Complex64;
use std::{iter, slice};

/// The tangential part of a wave vector in the frame of an interface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Tangential {
    /// Along the first tangent.
    Real(f64),
    /// Of a wave that decays along the surface, too.
    Complex([Complex64; 2]),
}

impl Tangential {
    /// The components along both tangents.
    pub fn components(self) -> [Complex64; 2] {
        match self {
            Self::Real(along) => [along.into(), Complex64::ZERO],
            Self::Complex(components) => components,
        }
    }
}

/// A mode in the frame of an interface, see [`Mode`]. With real numbers it carries power.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalMode<T> {
    pub kind: ModeKind,
    pub propagating: bool,
    /// Normal component of the wave vector.
    pub q: T,
    pub electric: [T; 3],
    pub magnetic: [T; 3],
}

/// Two modes with one heading.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LocalModes {
    /// Both propagate in a lossless medium.
    Real([LocalMode<f64>; 2]),
    /// Any others.
    Complex([LocalMode<Complex64>; 2]),
}

/// The modes of a wave that arrives at an interface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Arriving {
    /// The wave is this mode; its flux is any.
    One(LocalMode<f64>),
    /// It is one of these, or in absorbing media and where both are nearly one a mixture.
    Both(LocalModes),
}

/// The four modes of a medium: those that head forward and those that head back.
pub(crate) type BothWays = [LocalModes; 2];

/// The mean of E_a × H_b* and E_b* × H_a along the normal: the flux of one field, or how far from
/// orthogonal two are.
pub(crate) fn mutual_flux<T: Number>(a: &LocalMode<T>, b: &LocalMode<T>) -> T {
    let [ea, ha] = [a.electric, a.magnetic];
    let [eb, hb] = [b.electric, b.magnetic].map(|field| field.map(T::conjugate));
    (ea[0] * hb[1] - ea[1] * hb[0] + eb[0] * ha[1] - eb[1] * ha[0]) * 0.5
}

impl LocalMode<Complex64> {
    /// How decidedly it heads forward. In a passive medium flux and decay agree, so that their sum
    /// decides where one of them is weak.
    pub fn forwardness(&self) -> f64 {
        let flux = self.flux() / self.norm_squared();
        flux + self.q.im / (1.0 + self.q.norm())
    }
}

impl<T: Number> LocalMode<T> {
    /// The normal component of Re(E × H*).
    pub fn flux(&self) -> f64 {
        mutual_flux(self, self).real()
    }

    /// Re(E × H*) in the frame.
    pub fn poynting(&self) -> [f64; 3] {
        cross(self.electric, self.magnetic.map(T::conjugate)).map(T::real)
    }

    /// |E|² + |H|².
    pub fn norm_squared(&self) -> f64 {
        let sum = |field: [T; 3]| field.into_iter().map(T::magnitude_squared).sum::<f64>();
        sum(self.electric) + sum(self.magnetic)
    }

    pub fn scaled(mut self, factor: f64) -> Self {
        self.electric = self.electric.map(|component| component * factor);
        self.magnetic = self.magnetic.map(|component| component * factor);
        self
    }

    /// With |E|² + |H|² = 1.
    pub fn normalized(self) -> Self {
        self.scaled(self.norm_squared().sqrt().recip())
    }

    pub fn complex(&self) -> LocalMode<Complex64> {
        LocalMode {
            kind: self.kind,
            propagating: self.propagating,
            q: self.q.into(),
            electric: self.electric.map(Into::into),
            magnetic: self.magnetic.map(Into::into),
        }
    }

    pub fn in_world(&self, frame: &Frame, tangential: Tangential) -> Mode {
        let [first, second] = tangential.components();
        let ray = frame.vector(self.poynting());
        Mode {
            kind: self.kind,
            wave_vector: frame.complex_vector([first, second, self.q.into()]),
            electric: frame.complex_vector(self.electric),
            magnetic: frame.complex_vector(self.magnetic),
            ray: if self.propagating { ray.try_normalize() } else { None },
        }
    }
}

/// A wave whose normal component is closer than this to those of both modes is taken for a mixture
/// of them.
pub(crate) const BOTH_MODES: f64 = 1e-7;

impl Arriving {
    /// The modes, if they carry power in a lossless medium.
    pub fn real(&self) -> Option<&[LocalMode<f64>]> {
        match self {
            Self::One(mode) => Some(slice::from_ref(mode)),
            Self::Both(LocalModes::Real(modes)) => Some(modes),
            Self::Both(LocalModes::Complex(_)) => None,
        }
    }

    pub fn complex(&self) -> ArrayVec<LocalMode<Complex64>, 2> {
        match self {
            Self::One(mode) => iter::once(mode.complex()).collect(),
            Self::Both(modes) => modes.complex().into(),
        }
    }
}

impl LocalModes {
    /// The modes, if both propagate in a lossless medium.
    pub fn real(&self) -> Option<&[LocalMode<f64>; 2]> {
        match self {
            Self::Real(modes) => Some(modes),
            Self::Complex(_) => None,
        }
    }

    pub fn complex(&self) -> [LocalMode<Complex64>; 2] {
        match self {
            Self::Real(modes) => [modes[0].complex(), modes[1].complex()],
            Self::Complex(modes) => *modes,
        }
    }
}
