//! A branch of a ray tree on its way.

use super::Leaf;
use super::bodies::Around;
use crate::device::InnerRay;
use glam::DVec3;
use optics::geometry::Pose;
use optics::interface::{IncidentWave, OutgoingWave};
use optics::medium::ModeKind;
use optics::propagation::Foothold;
use optics::wave::ComplexVector;

/// Where a branch runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// In air, in the world's frame, having just left a surface of a device's skin, if any.
    Air { left: Option<(u16, u16)> },
    /// In a cell of a device, in the device's frame.
    Cell { device: u16, cell: u16 },
}

/// A branch: a ray with the fields of `N` launched polarizations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch<const N: usize> {
    pub place: Place,
    pub position: DVec3,
    pub wave_vector: DVec3,
    pub attenuation: DVec3,
    pub direction: DVec3,
    pub electric: [ComplexVector; N],
    pub power: [f64; N],
    pub optical_path: f64,
    /// Speed of light times the time of flight, cm.
    pub group_path: f64,
    /// The bodies around it.
    pub around: Around,
    /// How many surfaces of bodies in a row it has crossed without getting anywhere.
    pub standstills: u8,
    pub met_device: bool,
    pub path: u64,
    /// Which of the waves of the medium it is in.
    pub mode: ModeKind,
    /// Where it is in the virtual space of a conformal cell.
    pub foothold: Option<Foothold>,
}

impl<const N: usize> Branch<N> {
    /// The wave as an interface sees it.
    pub fn incident(&self) -> IncidentWave<N> {
        IncidentWave {
            wave_vector: self.wave_vector,
            attenuation: self.attenuation,
            direction: self.direction,
            electric: self.electric,
            power: self.power,
        }
    }

    /// The ray as a cell sees it.
    pub fn inner_ray(&self) -> InnerRay {
        InnerRay {
            position: self.position,
            wave_vector: self.wave_vector,
            direction: self.direction,
            mode: self.mode,
            foothold: self.foothold,
        }
    }

    /// The part of the branch whose field lies along `field`, as a wave of its own; `across` is the
    /// field of the other part, perpendicular to it.
    pub fn part(&self, mode: ModeKind, field: DVec3, across: DVec3) -> Self {
        let [along, beside] =
            [field, across].map(|field| self.electric.map(|e| e.dot_real(field.normalize())));
        let mut part = *self;
        for i in 0..N {
            let share = along[i].norm_sqr() / (along[i].norm_sqr() + beside[i].norm_sqr());
            let share = if share.is_nan() { 0.0 } else { share };
            part.power[i] = self.power[i] * share;
            let unit = ComplexVector::from(field.normalize());
            part.electric[i] = unit.scaled(along[i]);
        }
        part.mode = mode;
        part.path = fingerprint(self.path, mode as u64);
        part
    }

    /// The branch that goes on from here as `wave`, at `place`.
    pub fn onward(&self, wave: &OutgoingWave<N>, place: Place, event: u64) -> Self {
        Self {
            place,
            wave_vector: wave.wave_vector,
            attenuation: wave.attenuation,
            direction: wave.direction,
            electric: wave.electric,
            power: wave.power,
            mode: wave.mode,
            path: fingerprint(self.path, event),
            ..*self
        }
    }

    /// The branch in air, where all that decays across a beam is its profile: behind an absorbing wedge the
    /// wave of the match decays along the surface, by some 1e-5 of its wave vector; a ray is a plane
    /// wave along its direction, transverse, and of its power.
    pub fn in_air(self) -> Self {
        if self.attenuation == DVec3::ZERO {
            return self;
        }
        let mut electric = self.electric;
        for (field, power) in electric.iter_mut().zip(self.power) {
            let along = field.dot_real(self.direction);
            let across =
                *field - ComplexVector::new(self.direction * along.re, self.direction * along.im);
            let size = across.norm_squared();
            *field = if size > 0.0 { across * (power / size).sqrt() } else { across };
        }
        Self { wave_vector: self.direction, attenuation: DVec3::ZERO, electric, ..self }
    }

    /// The branch as a leaf, away through air or on an opaque body.
    pub fn leaf(&self, body: Option<u16>) -> Leaf<N> {
        Leaf {
            position: self.position,
            met_device: self.met_device,
            direction: self.direction,
            power: self.power,
            electric: self.electric,
            optical_path: self.optical_path,
            group_path: self.group_path,
            body,
            path: self.path,
        }
    }

    /// The branch seen in the frame of a device.
    pub fn to_local(self, pose: &Pose) -> Self {
        Self {
            position: pose.to_local(self.position),
            wave_vector: pose.vector_to_local(self.wave_vector),
            attenuation: pose.vector_to_local(self.attenuation),
            direction: pose.vector_to_local(self.direction),
            electric: self.electric.map(|field| pose.field_to_local(field)),
            ..self
        }
    }

    /// The branch, in the frame of a device, seen in the world.
    pub fn to_world(self, pose: &Pose) -> Self {
        Self {
            position: pose.to_world(self.position),
            wave_vector: pose.vector_to_world(self.wave_vector),
            attenuation: pose.vector_to_world(self.attenuation),
            direction: pose.vector_to_world(self.direction),
            electric: self.electric.map(|field| pose.field_to_world(field)),
            ..self
        }
    }

    /// The power of its strongest polarization.
    pub fn largest_power(&self) -> f64 {
        self.power.iter().copied().fold(0.0, f64::max)
    }
}

/// Adds an event to the fingerprint of a path (the mixing step of `SplitMix64`).
fn fingerprint(path: u64, event: u64) -> u64 {
    let mut z = (path ^ event).wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}
