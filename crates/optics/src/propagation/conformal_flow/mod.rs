//! The ray inside a cut conformal cloak, followed in virtual space.
//!
//! The index n = c/|f'| above the bumped floor comes from a conformal map x + iy = f(ζ), ζ = X +
//! iY. With the wave vector p, its constant part p_z, P = conj(f') (p_x + i p_y), and τ = (optical
//! path)/c²:
//!
//! dζ/dτ = P,  dP/dτ = -p_z² f' conj(f''),  dz/dτ = p_z |f'|²,  |P|² + p_z² |f'|² = c².
//!
//! These are Hamilton's equations of H = (|P|² + p_z² |f'|² - c²)/2, that is of p² = n². For p_z =
//! 0 the path in ζ is a straight line; else the force is small and smooth, and the method of order
//! 8 takes a handful of steps. Where the index is ρ(x, y) times that ([`IndexPerturbation`]), it is
//! c² ρ² that |P|² + p_z² |f'|² must be, and another force comes in: see the module `forces`.
//! Lengths are in cm, wave vectors in units of the vacuum wave number.

mod crossing;
mod forces;
mod frame;
mod index_perturbation;
mod lateness;
mod path;
mod points;
mod ray_packet;
mod step_control;
mod strides;

use std::sync::Arc;

use glam::{DMat3, DVec3};
use num_complex::Complex64;
use thiserror::Error;

use self::crossing::EventFunctions;
use self::frame::transport;
pub use self::index_perturbation::IndexPerturbation;
use self::points::Point;
use self::ray_packet::RayPacket;
use self::step_control::StepControl;
use super::PathEnd;
use crate::geometry::Extent;
use crate::lanes::LANES;
use crate::transformation::{ConformalMap, Truncation};

/// Which of the two mirror images of the half-space device is meant.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Half {
    /// Above the floor; a carpet has this one alone.
    Upper,
    /// The mirror image of the upper half under y -> -y.
    Lower,
}

impl Half {
    /// Takes a vector of this half to the upper one, and back.
    #[must_use]
    pub fn mirrored(self, v: DVec3) -> DVec3 {
        match self {
            Self::Upper => v,
            Self::Lower => DVec3::new(v.x, -v.y, v.z),
        }
    }
}

/// A part of the border of one half.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Boundary {
    /// The face at the least x.
    XMin,
    /// The face at the largest x.
    XMax,
    /// The face at the largest |y|.
    YMax,
    /// The face at the least z.
    ZMin,
    /// The face at the largest z.
    ZMax,
    /// The mirror, Y = 0.
    Floor,
    /// The round border about the z axis, if it has one.
    Rim,
    /// The round core about the z axis, if it has one.
    Core,
}

/// A point of one half of the device, known in physical and in virtual space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualPoint {
    /// The half it belongs to.
    pub half: Half,
    /// The virtual point ζ, in the upper half for either half, cm.
    pub virtual_position: Complex64,
    /// Its z, the same in both spaces, cm.
    pub z: f64,
    /// The index there.
    pub index: f64,
}

/// How a ray arrives at the border: the index of its virtual point is the one inside.
pub type ConformalEnd = PathEnd<Boundary, VirtualPoint>;

/// Why a ray could not be followed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum FlowError {
    /// A coordinate is not a finite number.
    #[error("position or wave vector is not finite")]
    NotFinite,
    /// The start is not inside the device or on its border.
    #[error("the start lies outside the medium")]
    Outside,
    /// The wave vector is not one of the medium.
    #[error("the wave vector has length {length}, the index is {index}")]
    WaveVector {
        /// |p|.
        length: f64,
        /// n at the start.
        index: f64,
    },
    /// The ray stayed inside for too many steps; it may be trapped.
    #[error("the ray did not leave within {MAX_STEPS} steps")]
    StepLimit,
    /// No step is short enough, or the border could not be found: lost in rounding at an edge.
    #[error("the ray cannot be followed")]
    Stalled,
}

/// Steps after which a ray counts as trapped; an ordinary one takes about ten, and in an uneven medium
/// some at every line of its grid.
const MAX_STEPS: u32 = 20_000;

/// Reflection at the mirror's bump, a curved surface, makes the error of position and direction
/// grow: a way that leads to the mirror is followed with this share of the tolerance.
const MIRROR_TOLERANCE: f64 = 0.1;

/// The way between the ends of steps must be so much better known than what a pulse takes on it.
const ALONG: f64 = 0.02;

/// How far (relative to the map's scale) a start may lie outside by rounding.
const BORDER_SLACK: f64 = 1e-9;

/// A ray at its end.
struct Arrival {
    control: StepControl,
    begin: Point,
    end: Point,
    boundary: Boundary,
    /// How much longer a pulse takes than its phase, cm, where that was asked for.
    lateness: Option<f64>,
}

/// One half of a conformal cloak cut to a box, and its mirror image under y -> -y.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct ConformalFlow {
    map: ConformalMap,
    cut: Truncation,
    extent: Extent,
    /// The radii of the round border and of the core, cm; infinite without them.
    rim: f64,
    core: f64,
    index_scale: f64,
    events: EventFunctions,
    slack: f64,
    index_perturbation: Option<Arc<IndexPerturbation>>,
}

impl ConformalFlow {
    /// The medium n = c/|f'| of `map` inside `cut` and between the z of `extent`; `index_scale` is
    /// c, 1 for the cloak that needs no reference medium.
    pub fn new(map: ConformalMap, cut: Truncation, extent: Extent, index_scale: f64) -> Self {
        let slack = BORDER_SLACK * map.scale();
        let (rim, core) = (f64::INFINITY, f64::INFINITY);
        let events = EventFunctions::new(&cut, extent, rim, core, map.scale());
        Self { map, cut, extent, rim, core, index_scale, events, slack, index_perturbation: None }
    }

    /// The same medium (all of it in the upper half) within the radius `rim` about the z axis and
    /// beyond the radius `core`, both in cm, the latter less than the former.
    pub fn between(self, core: Option<f64>, rim: Option<f64>) -> Self {
        let [rim, core] = [rim, core].map(|radius| radius.unwrap_or(f64::INFINITY));
        Self { rim, core, ..self }.with_events()
    }

    /// The radii of its round core and of its round border, if it has them.
    #[must_use]
    pub fn radii(&self) -> [Option<f64>; 2] {
        [self.core, self.rim].map(|radius| radius.is_finite().then_some(radius))
    }

    /// The same with the event functions that follow from the rest.
    fn with_events(self) -> Self {
        let events = EventFunctions::new(&self.cut, self.extent, self.rim, self.core, self.scale());
        Self { events, ..self }
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &ConformalMap {
        &self.map
    }

    /// The rectangle it is cut to (of the upper half).
    #[must_use]
    pub fn cut(&self) -> &Truncation {
        &self.cut
    }

    /// Least and largest index; bounds of them where the medium is uneven.
    #[must_use]
    pub fn index_range(&self) -> (f64, f64) {
        let (least, largest) = self.map.index_range(&self.cut);
        let [low, high] =
            self.index_perturbation.as_ref().map_or([1.0; 2], |uneven| uneven.bounds());
        (self.index_scale * least * low, self.index_scale * largest * high)
    }

    /// The index at a point of one half; None deep inside the metal, where the map has no inverse.
    #[must_use]
    pub fn index(&self, half: Half, position: DVec3) -> Option<f64> {
        let local = half.mirrored(position);
        let zeta = self.map.invert(Complex64::new(local.x, local.y))?;
        Some(self.index_at(&self.map.jet(zeta)))
    }

    /// Finds a point of one half, inside or on the border, in virtual space.
    ///
    /// # Errors
    ///
    /// If it is not finite, or outside.
    pub fn virtual_point(&self, half: Half, position: DVec3) -> Result<VirtualPoint, FlowError> {
        if !position.is_finite() {
            return Err(FlowError::NotFinite);
        }
        let local = half.mirrored(position);
        let z = Complex64::new(local.x, local.y);
        let (mut zeta, mut jet) = self.map.invert_with_jet(z).ok_or(FlowError::Outside)?;
        // On the mirror by rounding means on the mirror.
        if zeta.im.abs() <= self.slack && zeta.im != 0.0 {
            zeta.im = 0.0;
            jet = self.map.jet(zeta);
        }
        let index = self.index_at(&jet);
        let (cut, radius, slack) = (&self.cut, z.norm(), self.slack);
        let between =
            |value: f64, low: f64, high: f64| value >= low - slack && value <= high + slack;
        let inside = zeta.im >= 0.0
            && between(z.re, cut.x_min, cut.x_max)
            && z.im <= cut.y_max + slack
            && between(local.z, self.extent.min, self.extent.max)
            && (self.core.is_infinite() || radius >= self.core - slack)
            && radius <= self.rim + slack;
        if inside && index.is_finite() {
            Ok(VirtualPoint { half, virtual_position: zeta, z: local.z, index })
        } else {
            Err(FlowError::Outside)
        }
    }

    /// Follows a ray from a point inside or on the border to the next point of the border.
    ///
    /// `wave_vector` is the one inside the medium, |p| = n. `tolerance` (cm, at least 1e-12 is
    /// used) bounds the error of position and optical path at the end, a tenth of it per cm that of
    /// the direction, except for rays that leave at grazing incidence. A start on the border moving
    /// inwards, or along it, goes on; one moving outwards ends at once.
    ///
    /// # Errors
    ///
    /// If the wave vector does not belong to the medium, or the ray does not come out.
    pub fn advance_from(
        &self,
        start: &VirtualPoint,
        wave_vector: DVec3,
        tolerance: f64,
    ) -> Result<ConformalEnd, FlowError> {
        let [end, ..] =
            self.advance_four(&[Some((*start, wave_vector)), None, None, None], tolerance, None);
        end.unwrap_or(Err(FlowError::Outside))
    }

    /// As [`Self::advance_from`], up to four rays at once, which takes hardly longer than one. Each
    /// end is what it would be alone. The ends say what pulses take, too, to within `pulses` (cm, or 1e-7), if
    /// that is given: at the least dispersion that causality allows the group index is n or 1/n, whichever is larger.
    pub fn advance_four(
        &self,
        starts: &[Option<(VirtualPoint, DVec3)>; LANES],
        tolerance: f64,
        pulses: Option<f64>,
    ) -> [Option<Result<ConformalEnd, FlowError>>; LANES] {
        let arrived = |tolerance, pulses| RayPacket::arrived(self, starts, tolerance, pulses);
        let finer = pulses.map(|to| ALONG * to).filter(|finer| *finer < tolerance);
        // A ray runs the same way whether its pulses are asked for or not.
        let packet = arrived(tolerance, pulses.filter(|_| finer.is_none()));
        let late = finer.map(|finer| arrived(finer, pulses));
        std::array::from_fn(|i| {
            let (start, _) = starts[i].as_ref()?;
            Some(packet.arrival(i).map(|mut arrival| {
                if let Some(late) = &late {
                    let late = late.arrival(i).ok();
                    let late = late.filter(|late| late.boundary == arrival.boundary);
                    let own = || arrived(tolerance, pulses).arrival(i).ok();
                    arrival.lateness = late.or_else(own).and_then(|late| late.lateness);
                }
                self.end(start, &arrival)
            }))
        })
    }

    /// Whether a straight line in virtual space leads to the mirror.
    fn aims_at_floor(&self, zeta: Complex64, momentum: Complex64) -> bool {
        let x = zeta.re - momentum.re / momentum.im * zeta.im;
        momentum.im < 0.0 && x > self.cut.x_min && x < self.cut.x_max
    }

    fn end(&self, start: &VirtualPoint, arrival: &Arrival) -> ConformalEnd {
        let Arrival { control, begin, mut end, boundary, .. } = *arrival;
        let half = start.half;
        let mut position = DVec3::new(end.jet.f.re, end.jet.f.im, end.z);
        let inward = Complex64::i() * end.jet.f1 / end.jet.stretch();
        let radial = DVec3::new(position.x, position.y, 0.0).normalize_or(DVec3::X);
        let on_circle = |radius: f64| (radial * radius).with_z(end.z);
        let into_metal = DVec3::new(-inward.re, -inward.im, 0.0);
        let normal;
        // What is left of the distance to the border is rounding.
        match boundary {
            Boundary::XMin => (position.x, normal) = (self.cut.x_min, DVec3::NEG_X),
            Boundary::XMax => (position.x, normal) = (self.cut.x_max, DVec3::X),
            Boundary::YMax => (position.y, normal) = (self.cut.y_max, DVec3::Y),
            Boundary::ZMin => (position.z, normal) = (self.extent.min, DVec3::NEG_Z),
            Boundary::ZMax => (position.z, normal) = (self.extent.max, DVec3::Z),
            Boundary::Floor => (end.zeta.im, normal) = (0.0, into_metal),
            Boundary::Rim => (position, normal) = (on_circle(self.rim), radial),
            Boundary::Core => (position, normal) = (on_circle(self.core), -radial),
        }
        let index_scale = self.index_scale_at(end.jet.f);
        end.momentum = control.on_shell(index_scale, end.momentum, &end.jet);
        let p = end.momentum / end.jet.f1.conj();
        let turn = transport(control.p_z, &begin, &end);
        let transport = match half {
            Half::Upper => turn,
            Half::Lower => {
                let mirror = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
                mirror * turn * mirror
            }
        };
        let virtual_point = VirtualPoint {
            half,
            virtual_position: end.zeta,
            z: position.z,
            index: index_scale / end.jet.stretch(),
        };
        let wave_vector = half.mirrored(DVec3::new(p.re, p.im, control.p_z));
        let optical_path = self.index_scale * self.index_scale * end.tau;
        PathEnd {
            surface: boundary,
            position: half.mirrored(position),
            virtual_point,
            wave_vector,
            direction: wave_vector.normalize(),
            optical_path,
            group_path: arrival.lateness.map(|late| optical_path + late),
            // |Re(E × H*)| = n |E|².
            transport: transport * (start.index / virtual_point.index).sqrt(),
            outward: half.mirrored(normal),
        }
    }
}
