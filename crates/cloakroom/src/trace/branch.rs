//! A branch of a ray tree on its way.

use super::bodies::Around;
use super::{Launch, Leaf};
use crate::device::InnerRay;
use crate::split_mix::mix;
use glam::DVec3;
use optics::geometry::Pose;
use optics::interface::{IncidentWave, OutgoingWave};
use optics::medium::ModeKind;
use optics::propagation::Foothold;
use optics::wave::ComplexVector;

/// What a branch in air has just left, and does not meet next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Left {
    pub device: u16,
    /// Of the device's skin; the whole device if it is convex.
    pub surface: Option<u16>,
}

/// Where a branch runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// In air, in the world's frame, having just left a surface of a device's skin, if any.
    Air { left: Option<Left> },
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
    /// Whether the tree of each launched polarization alone has this branch.
    pub alone: [bool; N],
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
    /// The root of the tree of a ray launched in air.
    pub fn launched(launch: &Launch<N>) -> Self {
        Self {
            place: Place::Air { left: None },
            position: launch.origin,
            wave_vector: launch.direction,
            attenuation: DVec3::ZERO,
            direction: launch.direction,
            electric: launch.electric,
            power: launch.electric.map(ComplexVector::norm_squared),
            alone: [true; N],
            optical_path: 0.0,
            group_path: 0.0,
            around: Around::default(),
            standstills: 0,
            met_device: false,
            path: 0,
            mode: ModeKind::Shared,
            foothold: None,
        }
    }

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

    /// Goes on from here as `wave`, the event telling how.
    pub fn go_on_as(&mut self, wave: &OutgoingWave<N>, event: u64) {
        self.wave_vector = wave.wave_vector;
        self.attenuation = wave.attenuation;
        self.direction = wave.direction;
        self.electric = wave.electric;
        self.power = wave.power;
        self.mode = wave.mode;
        self.path = fingerprint(self.path, event);
    }

    /// Comes out into air, where all that decays across a beam is its profile: behind an absorbing wedge the
    /// wave of the match decays along the surface, by some 1e-5 of its wave vector; a ray is a plane
    /// wave along its direction, transverse, and of its power.
    pub fn come_out(&mut self) {
        if self.attenuation == DVec3::ZERO {
            return;
        }
        for (field, power) in self.electric.iter_mut().zip(self.power) {
            let along = field.dot_real(self.direction);
            let across =
                *field - ComplexVector::new(self.direction * along.re, self.direction * along.im);
            let size = across.norm_squared();
            *field = if size > 0.0 { across * (power / size).sqrt() } else { across };
        }
        self.wave_vector = self.direction;
        self.attenuation = DVec3::ZERO;
    }

    /// The branch as a leaf, away through air or on an opaque body.
    pub fn leaf(&self, body: Option<u16>) -> Leaf<N> {
        Leaf {
            position: self.position,
            met_device: self.met_device,
            direction: self.direction,
            power: self.power,
            electric: self.electric,
            alone: self.alone,
            optical_path: self.optical_path,
            group_path: self.group_path,
            body,
            path: self.path,
        }
    }

    /// Takes the branch from the world's frame into that of a device.
    pub fn enter_frame(&mut self, pose: &Pose) {
        self.position = pose.to_local(self.position);
        self.wave_vector = pose.vector_to_local(self.wave_vector);
        self.attenuation = pose.vector_to_local(self.attenuation);
        self.direction = pose.vector_to_local(self.direction);
        self.electric = self.electric.map(|field| pose.field_to_local(field));
    }

    /// Takes the branch from the frame of a device into air, in the world's frame, `left` being the surface
    /// of the device's skin that it runs away from.
    pub fn leave_frame(&mut self, pose: &Pose, left: Option<Left>) {
        self.place = Place::Air { left };
        self.position = pose.to_world(self.position);
        self.wave_vector = pose.vector_to_world(self.wave_vector);
        self.attenuation = pose.vector_to_world(self.attenuation);
        self.direction = pose.vector_to_world(self.direction);
        self.electric = self.electric.map(|field| pose.field_to_world(field));
    }

    /// Enters a cell of the device in whose frame it is.
    pub fn enter_cell(&mut self, device: u16, cell: u16, foothold: Option<Foothold>) {
        self.place = Place::Cell { device, cell };
        self.foothold = foothold;
    }

    /// Notes that branches below that power are not followed.
    pub fn weigh(&mut self, least_power: f64) {
        for (alone, power) in self.alone.iter_mut().zip(self.power) {
            *alone &= power >= least_power;
        }
    }

    /// The power of its strongest polarization.
    pub fn largest_power(&self) -> f64 {
        self.power.iter().copied().fold(0.0, f64::max)
    }
}

/// Adds an event to the fingerprint of a path.
fn fingerprint(path: u64, event: u64) -> u64 {
    mix(path ^ event)
}
