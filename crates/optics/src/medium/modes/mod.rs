//! The plane-wave modes of a medium for a given tangential wave vector.
//!
//! Every medium has four; two carry their power, or decay, along +n and two along -n. They are told
//! apart by the normal Poynting flux and by decay, never by the sign of the wave vector, which is
//! misleading in hyperbolic and negative-index media.

mod absorbing;
mod eigenvalues;
mod eigenvector;
mod fresnel;
mod general;
mod local;
mod refinement;
mod single_wave;
mod uniaxial;

pub(crate) use local::{
    Arriving, BOTH_MODES, BothWays, LocalMode, LocalModes, Tangential, mutual_flux,
};

use super::class::Class;
use super::{Medium, Tensor};
use crate::wave::{ComplexVector, Frame, poynting};
use glam::DVec3;

/// Which way along a surface's normal a mode carries its power, or decays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// Along the normal.
    Forward,
    /// Against the normal.
    Backward,
}

/// Which of the waves of a medium a mode is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ModeKind {
    /// Both polarizations at once, where they share one wave vector.
    Shared,
    /// Where both share one wave vector: E lies in the surface, perpendicular to the ray.
    S,
    /// The partner of [`Self::S`], with H so instead.
    P,
    /// The ordinary wave of a uniaxial medium.
    Ordinary,
    /// The extraordinary wave of a uniaxial medium.
    Extraordinary,
    /// Of two modes without a name the one with the smaller |p|.
    First,
    /// Of two modes without a name the one with the larger |p|.
    Second,
}

/// A plane-wave mode.
///
/// Modes that carry power have a normal flux |Re(E × H*)·n| of 1, and the two of one heading are
/// orthogonal in flux where the medium is lossless or they share one wave vector. Evanescent ones
/// have |E|² + |H|² = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Which one it is.
    pub kind: ModeKind,
    /// Wave vector.
    pub wave_vector: ComplexVector,
    /// Electric field.
    pub electric: ComplexVector,
    /// Magnetic field.
    pub magnetic: ComplexVector,
    /// The unit vector of the Poynting vector, unless the mode is evanescent.
    pub ray: Option<DVec3>,
}

impl Mode {
    /// Whether the mode carries power across the surface.
    #[must_use]
    pub fn is_propagating(&self) -> bool {
        self.ray.is_some()
    }

    /// The Poynting vector Re(E × H*).
    #[must_use]
    pub fn poynting(&self) -> DVec3 {
        poynting(self.electric, self.magnetic)
    }
}

impl Medium {
    /// The two modes with the given tangential wave vector (perpendicular to the unit vector
    /// `normal`) that carry power, or decay, one way along the normal.
    ///
    /// Where both polarizations share one wave vector: s, then p; in other uniaxial media the
    /// ordinary mode, then the extraordinary one; elsewhere the one with the smaller |p| first.
    ///
    /// # Example
    ///
    /// Calcite cut across its axis: light that arrives straight sees one index.
    ///
    /// ```
    /// use glam::DVec3;
    /// use optics::medium::{Heading, Medium, ModeKind};
    ///
    /// let calcite = Medium::uniaxial_electric(1.0, 2.75, 2.21, DVec3::X)?;
    /// let [slow, fast] = calcite.modes(DVec3::new(0.0, 0.5, 0.0), DVec3::X, Heading::Forward);
    /// assert_eq!((slow.kind, fast.kind), (ModeKind::Ordinary, ModeKind::Extraordinary));
    /// assert!((slow.wave_vector.re.length() - 2.75f64.sqrt()).abs() < 1e-15);
    /// let [s, p] = calcite.modes(DVec3::ZERO, DVec3::X, Heading::Forward);
    /// assert_eq!((s.kind, p.kind), (ModeKind::S, ModeKind::P));
    /// # Ok::<(), optics::medium::MediumError>(())
    /// ```
    #[must_use]
    pub fn modes(&self, tangential: DVec3, normal: DVec3, heading: Heading) -> [Mode; 2] {
        let tangential = tangential - normal * tangential.dot(normal);
        let frame = Frame::new(normal, tangential);
        let along = Tangential::Real(tangential.dot(frame.first));
        let [forward, backward] = self.both_ways(&frame, along, None);
        let modes = if heading == Heading::Forward { forward } else { backward };
        modes.complex().map(|mode| mode.in_world(&frame, along))
    }

    /// How far a mode is from solving Maxwell's equations p × E = µH and p × H = -εE in this
    /// medium, relative to their terms: 1e-15 as a rule, more where double precision does not
    /// reach, as in media whose principal values differ by many powers of ten.
    #[must_use]
    pub fn residual(&self, mode: &Mode) -> f64 {
        let Mode { wave_vector, electric, magnetic, .. } = *mode;
        let (permittivity, permeability) = self.tensors();
        let size = |vector: ComplexVector| vector.norm_squared().sqrt();
        let times = |tensor: &Tensor, field: ComplexVector| {
            let (re, im) = (field.transformed(&tensor.re), field.transformed(&tensor.im));
            re + ComplexVector::new(-im.im, im.re)
        };
        let (p, e, h) = (size(wave_vector), size(electric), size(magnetic));
        let ampere = size(wave_vector.cross(magnetic) + times(&permittivity, electric));
        let faraday = size(wave_vector.cross(electric) - times(&permeability, magnetic));
        ampere / (p * h + permittivity.size() * e) + faraday / (p * e + permeability.size() * h)
    }

    /// All four modes. `known` is the normal component of a wave that is known to propagate, which at
    /// grazing incidence has more digits than what follows from the tangential one: where that by rounding
    /// seems evanescent it is given the limit's real one.
    pub(crate) fn both_ways(
        &self,
        frame: &Frame,
        tangential: Tangential,
        known: Option<f64>,
    ) -> BothWays {
        match (&self.class, tangential) {
            (Class::Isotropic(surface) | Class::Matched(surface), Tangential::Real(along)) => {
                let waves = self.single_wave_modes(surface, frame, along, known);
                [true, false].map(|forward| waves.modes(forward))
            }
            (Class::Uniaxial(medium), Tangential::Real(along)) => {
                let waves = medium.waves(frame, along, known);
                [true, false].map(|forward| waves.modes(forward))
            }
            (Class::General, Tangential::Real(along)) if !self.absorbs() => {
                self.general_modes(frame, along, known)
            }
            _ => self.absorbing_modes(frame, tangential.components()),
        }
    }

    /// The modes of a wave that arrives with the normal component `q`, and those that head back.
    pub(crate) fn arriving_and_back(
        &self,
        frame: &Frame,
        tangential: Tangential,
        q: f64,
    ) -> (Arriving, LocalModes) {
        if let (Class::Uniaxial(medium), Tangential::Real(along)) = (&self.class, tangential) {
            let waves = medium.waves(frame, along, Some(q));
            return (waves.arriving(q), waves.modes(false));
        }
        if let (Class::General, Tangential::Real(along), false) =
            (&self.class, tangential, self.absorbs())
        {
            return self.general_arriving(frame, along, q);
        }
        let [forward, backward] = self.both_ways(frame, tangential, Some(q));
        (Arriving::Both(forward), backward)
    }

    /// The modes that head forward.
    pub(crate) fn onward(&self, frame: &Frame, tangential: Tangential) -> LocalModes {
        match (&self.class, tangential) {
            (Class::Isotropic(surface) | Class::Matched(surface), Tangential::Real(along)) => {
                self.single_wave_modes(surface, frame, along, None).modes(true)
            }
            (Class::Uniaxial(medium), Tangential::Real(along)) => {
                medium.waves(frame, along, None).modes(true)
            }
            (Class::General, Tangential::Real(along)) if !self.absorbs() => {
                self.general_onward(frame, along)
            }
            _ => self.both_ways(frame, tangential, None)[0],
        }
    }
}
