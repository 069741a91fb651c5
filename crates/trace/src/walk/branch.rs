//! A branch of a ray tree on its way.

use super::event::fingerprint;
use super::{Launch, Leaf, LeafEnd, PathTime};
use crate::assembly::DepartedSurface;
use crate::device::{InnerRay, Passage};
use glam::DVec3;
use num_complex::Complex64;
use optics::geometry::Pose;
use optics::interface::{IncidentWave, OutgoingWave};
use optics::medium::{ModeKind, RayWave};
use optics::propagation::{PathPoint, VirtualPoint};
use optics::wave::ComplexVector;
use std::hash::Hash;

/// The fingerprint of a launched ray that has met nothing.
pub const LAUNCHED: u64 = 0;

/// Where a branch runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// In air, in the world's frame.
    Air,
    /// In a region of a device, in the device's frame.
    Region { device: u16, region: u16 },
}

/// A branch of a ray tree on its way: a ray with the fields of `N` launched polarizations. It is in
/// the world's frame where it runs through air, else in that of the device.
#[derive(Clone, Copy, Debug)]
pub struct Branch<const N: usize> {
    pub(super) place: Place,
    /// Where it is, cm.
    pub position: DVec3,
    /// Its wave vector, in units of that in vacuum.
    pub wave_vector: DVec3,
    pub(super) attenuation: DVec3,
    /// Its unit vector, that of the Poynting vector.
    pub direction: DVec3,
    /// Its electric field for each launched polarization.
    pub electric: [ComplexVector; N],
    /// Its share of the power launched, for each launched polarization.
    pub power: [f64; N],
    /// Whether the tree of each launched polarization alone has this branch.
    pub(super) survives_alone: [bool; N],
    /// Optical path length from the ray's origin, cm.
    pub optical_path: f64,
    /// What ways on which the phase runs backwards add to the optical path in the time of flight,
    /// cm.
    pub backwards: f64,
    /// What dispersion adds to the optical path for a pulse, cm; NaN where it is not known, or
    /// nobody asks.
    pub dispersion: f64,
    /// What it has just left, if it runs outside of it now: in air or in the body around it.
    pub(super) departed: Option<DepartedSurface>,
    /// How many borders in a row it has crossed without getting anywhere.
    pub(super) standstills: u8,
    pub(super) met_device: bool,
    /// A fingerprint of the surfaces it has met and the branches it has taken.
    pub path: u64,
    /// Which of the waves of the medium it is in.
    pub(super) mode: ModeKind,
    /// Where it is in the virtual space of a conformal region.
    pub(super) virtual_point: Option<VirtualPoint>,
}

impl<const N: usize> Branch<N> {
    /// Its power in the strongest polarization.
    #[must_use]
    pub fn largest_power(&self) -> f64 {
        largest(&self.power)
    }

    /// Whether a branch may take its place, and be followed from there, with nothing changed but
    /// what is public: it runs on in a medium that is known without its point.
    #[must_use]
    pub fn is_movable(&self) -> bool {
        matches!(self.place, Place::Region { .. })
            && self.attenuation == DVec3::ZERO
            && self.departed.is_none()
            && self.standstills == 0
            && self.virtual_point.is_none()
    }

    /// Notes which launched polarizations alone would have brought it here, where branches below
    /// that power are not followed and power is never gained.
    pub fn survive(&mut self, least_power: f64) {
        self.survives_alone = self.power.map(|power| power >= least_power);
    }

    /// Whether it is the same wave in the same region as another.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        (self.place, self.mode, self.met_device) == (other.place, other.mode, other.met_device)
    }

    /// The root of the tree of a ray launched in air.
    pub(super) fn launched(launch: &Launch<N>) -> Self {
        Self {
            place: Place::Air,
            position: launch.origin,
            wave_vector: launch.direction,
            attenuation: DVec3::ZERO,
            direction: launch.direction,
            electric: launch.electric,
            power: launch.electric.map(ComplexVector::norm_squared),
            survives_alone: [true; N],
            optical_path: 0.0,
            backwards: 0.0,
            dispersion: f64::NAN,
            departed: None,
            standstills: 0,
            met_device: false,
            path: LAUNCHED,
            mode: ModeKind::Shared,
            virtual_point: None,
        }
    }

    /// The wave as an interface sees it.
    pub(super) fn incident(&self) -> IncidentWave<N> {
        IncidentWave {
            wave_vector: self.wave_vector,
            attenuation: self.attenuation,
            direction: self.direction,
            electric: self.electric,
            power: self.power,
        }
    }

    /// The ray as a region sees it.
    pub(super) fn inner_ray(&self) -> InnerRay {
        InnerRay {
            position: self.position,
            wave_vector: self.wave_vector,
            direction: self.direction,
            mode: self.mode,
            virtual_point: self.virtual_point,
        }
    }

    /// The part of the branch whose field lies along `field`, as a wave of its own; `across` is the
    /// field of the other part, perpendicular to it.
    pub(super) fn part(&self, mode: ModeKind, field: DVec3, across: DVec3) -> Self {
        let [along, beside] =
            [field, across].map(|field| self.electric.map(|e| e.dot_real(field.normalize())));
        let mut part = *self;
        for i in 0..N {
            let share = along[i].norm_sqr() / (along[i].norm_sqr() + beside[i].norm_sqr());
            let share = if share.is_nan() { 0.0 } else { share };
            part.power[i] = self.power[i] * share;
            part.electric[i] = ComplexVector::from(field.normalize()).scaled(along[i]);
        }
        part.mode = mode;
        part.path = fingerprint(self.path, mode);
        part
    }

    /// The branch as one of the waves in which it starts, with its amplitude for each launched
    /// polarization.
    pub(super) fn as_wave(&self, wave: &RayWave, amplitudes: [Complex64; N]) -> Self {
        let field = wave.electric.unwrap_or_default();
        Self {
            wave_vector: wave.wave_vector,
            attenuation: wave.attenuation,
            electric: amplitudes.map(|amplitude| field.scaled(amplitude)),
            power: amplitudes.map(|amplitude| amplitude.norm_sqr()),
            mode: wave.kind,
            path: fingerprint(self.path, wave.kind),
            ..*self
        }
    }

    /// Goes on from here as `wave`, the event telling how.
    pub(super) fn go_on_as(&mut self, wave: &OutgoingWave<N>, event: impl Hash) {
        self.wave_vector = wave.wave_vector;
        self.attenuation = wave.attenuation;
        self.direction = wave.direction;
        self.electric = wave.electric;
        self.power = wave.power;
        self.mode = wave.mode;
        self.path = fingerprint(self.path, event);
    }

    /// Its field for the launched polarization of which it has most.
    pub(super) fn strongest_field(&self) -> ComplexVector {
        let fields = self.electric.iter().zip(self.power);
        let strongest = fields.max_by(|(_, a), (_, b)| a.total_cmp(b));
        strongest.map_or(ComplexVector::ZERO, |(field, _)| *field)
    }

    /// When it is where it is.
    pub(super) fn time(&self) -> PathTime {
        PathTime {
            phase: self.optical_path + self.backwards,
            pulse: self.optical_path + self.dispersion,
        }
    }

    /// Notes what a pulse takes on a way before the branch takes it.
    #[cold]
    pub(super) fn delay(&mut self, passage: &Passage, group: f64) {
        let more = group - passage.optical_path;
        self.dispersion += more;
        self.backwards += self.backwards_on(passage, group);
    }

    /// What a way adds to the optical path in the time of flight, given what a pulse takes on it.
    fn backwards_on(&self, passage: &Passage, group: f64) -> f64 {
        let more = group - passage.optical_path;
        if passage.optical_path >= 0.0 {
            0.0
        } else if more.is_nan() {
            // Where a pulse has no velocity, in media that absorb, no slower than light.
            let straight = (passage.position - self.position).length();
            (straight - passage.optical_path).max(-2.0 * passage.optical_path)
        } else {
            more
        }
    }

    /// When it comes to the points of a way before it takes it. `pulse` is what a pulse takes up to each of
    /// them, if that has been worked out.
    pub(super) fn times(
        &self,
        path: &[PathPoint],
        passage: &Passage,
        pulse: Option<&[f64]>,
    ) -> Vec<PathTime> {
        let whole = pulse.and_then(|pulse| pulse.last()).copied();
        let backwards = whole.map_or(0.0, |whole| self.backwards_on(passage, whole));
        let start = self.time();
        let time = |(number, point): (usize, &PathPoint)| {
            // Evenly where it runs backwards: in homogeneous media.
            let share =
                if backwards == 0.0 { 0.0 } else { point.optical_path / passage.optical_path };
            PathTime {
                phase: start.phase + point.optical_path + backwards * share,
                pulse: start.pulse + pulse.map_or(f64::NAN, |pulse| pulse[number]),
            }
        };
        path.iter().enumerate().map(time).collect()
    }

    /// Comes out into air, `departed` being what it leaves: there all that decays across a beam is
    /// its profile: behind an absorbing wedge the wave of the match decays along the surface, by
    /// some 1e-5 of its wave vector; a ray is a plane wave along its direction, transverse, and of
    /// its power.
    pub(super) fn come_out(&mut self, departed: Option<DepartedSurface>) {
        (self.place, self.departed) = (Place::Air, departed);
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

    /// The branch as a leaf with its end.
    pub(super) fn leaf(&self, end: LeafEnd) -> Leaf<N> {
        Leaf {
            position: self.position,
            met_device: self.met_device,
            direction: self.direction,
            power: self.power,
            electric: self.electric,
            survives_alone: self.survives_alone,
            optical_path: self.optical_path,
            delay_path: self.optical_path + self.backwards,
            group_path: Some(self.optical_path + self.dispersion).filter(|path| !path.is_nan()),
            end,
            path: self.path,
        }
    }

    /// Takes the branch from the world's frame into that of a device.
    pub(super) fn enter_frame(&mut self, pose: &Pose) {
        self.position = pose.to_local(self.position);
        self.wave_vector = pose.vector_to_local(self.wave_vector);
        self.attenuation = pose.vector_to_local(self.attenuation);
        self.direction = pose.vector_to_local(self.direction);
        self.electric = self.electric.map(|field| pose.field_to_local(field));
    }

    /// Takes the branch from the frame of a device into the world's.
    pub(super) fn leave_frame(&mut self, pose: &Pose) {
        self.position = pose.to_world(self.position);
        self.wave_vector = pose.vector_to_world(self.wave_vector);
        self.attenuation = pose.vector_to_world(self.attenuation);
        self.direction = pose.vector_to_world(self.direction);
        self.electric = self.electric.map(|field| pose.field_to_world(field));
    }

    /// Enters a region of the device in whose frame it is.
    pub(super) fn enter_region(
        &mut self,
        device: u16,
        region: u16,
        virtual_point: Option<VirtualPoint>,
    ) {
        self.place = Place::Region { device, region };
        self.virtual_point = virtual_point;
        self.departed = None;
    }

    /// Notes that branches below that power are not followed.
    pub(super) fn update_survival(&mut self, least_power: f64) {
        for (survives, power) in self.survives_alone.iter_mut().zip(self.power) {
            *survives &= power >= least_power;
        }
    }
}

/// The power of the strongest polarization; of none that is not a number.
pub(super) fn largest<const N: usize>(power: &[f64; N]) -> f64 {
    power.iter().fold(0.0, |largest, &power| if power > largest { power } else { largest })
}
