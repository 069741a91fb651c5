//! Those who watch a tracer.

use super::{Branch, FirstFace};
use optics::interface::OutgoingWave;
use optics::propagation::PathPoint;

/// One who watches a tracer. Nobody, `()`, costs nothing.
pub trait PathRecorder<const N: usize> {
    /// Whether rays end at the first surface that they meet.
    const STOPS_AT_SURFACE: bool = false;

    /// Whether branches may become one under way: where nobody watches.
    const JOINS: bool = false;

    /// Whether light that never gets out is cut where it starts: where nobody asks for its way.
    const CUTS_KEPT_LIGHT: bool = false;

    /// Called for each piece of a branch's way from surface to surface.
    fn record(&mut self, segment: impl FnOnce() -> PathSegment<N>);

    /// Called with the waves that leave the first surface, if rays end there.
    fn stopped(&mut self, _waves: &[OutgoingWave<N>]) {}

    /// Called for each branch that is to be followed from where it is in a homogeneous medium.
    #[inline(always)]
    fn begins(&mut self, _branch: &Branch<N>) {}

    /// Called where a branch of that fingerprint has come through a homogeneous medium to that one of
    /// the planes around it.
    #[inline(always)]
    fn arrives(&mut self, _path: u64, _face: u16) {}

    /// Called where a branch of that fingerprint has come through air to a surface of a device, given whether that lies
    /// in a plane.
    #[inline(always)]
    fn meets(&mut self, _path: u64, _is_plane: impl FnOnce() -> bool) {}

    /// To which of the planes around a homogeneous medium, as bits by their numbers, a branch of that
    /// fingerprint is taken as if there were no others; `None`: to the one that it meets, and through
    /// what else there is. Of the launched ray in air, 0: to which surfaces of devices, by the numbers
    /// of [`first_surface`](Self::first_surface).
    #[inline(always)]
    fn planes(&self, _path: u64) -> Option<u64> {
        None
    }

    /// The device and its plane surface of that number to which the launched ray is taken; `None`:
    /// past all devices.
    #[inline(always)]
    fn first_surface(&self, _number: u16) -> Option<(u16, u16)> {
        None
    }

    /// Called where a branch of the fingerprint `from` goes on from a border, or starts, as one of
    /// the fingerprint `to`, given the power of its strongest polarization. Whether that is to be
    /// followed: else it is left out with all that comes of it, and is in no account.
    #[inline(always)]
    fn went_on(&mut self, _from: u64, _to: u64, _power: f64) -> bool {
        true
    }
}

/// The first surface that a ray meets, as it is looked at on its own.
impl<const N: usize> PathRecorder<N> for Option<FirstFace<N>> {
    const STOPS_AT_SURFACE: bool = true;

    fn record(&mut self, _: impl FnOnce() -> PathSegment<N>) {}

    fn stopped(&mut self, waves: &[OutgoingWave<N>]) {
        self.get_or_insert_default().add(waves);
    }
}

/// A piece of a branch's way from surface to surface.
#[derive(Clone, Debug, PartialEq)]
pub struct PathSegment<const N: usize> {
    /// The fingerprint of the branch.
    pub branch: u64,
    /// The power of the branch where it starts, for each launched polarization.
    pub power: [f64; N],
    /// The optical path from the ray's origin to where it starts, cm.
    pub optical_path: f64,
    /// The device and its region that it is in; `None` in air.
    pub inside: Option<(u16, u16)>,
    /// The way, in the frame of the device that it is in, else in the world's.
    pub path: Vec<PathPoint>,
    /// When light that leaves the ray's origin at 0 comes to each of its points.
    pub times: Vec<PathTime>,
}

/// When light comes to a point, in cm: times the speed of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathTime {
    /// What the phase takes; a pulse, where the phase runs backwards: see
    /// [`Leaf::delay_path`](super::Leaf::delay_path).
    pub phase: f64,
    /// What a pulse takes, NaN unless it is known and [asked](super::Tracer::with_group_delays).
    pub pulse: f64,
}

impl PathTime {
    /// So much later, cm.
    #[must_use]
    pub fn after(self, way: f64) -> Self {
        Self { phase: self.phase + way, pulse: self.pulse + way }
    }
}

impl<const N: usize> PathRecorder<N> for () {
    const JOINS: bool = true;
    const CUTS_KEPT_LIGHT: bool = true;

    #[inline(always)]
    fn record(&mut self, _: impl FnOnce() -> PathSegment<N>) {}
}

impl<const N: usize> PathRecorder<N> for Vec<PathSegment<N>> {
    fn record(&mut self, segment: impl FnOnce() -> PathSegment<N>) {
        self.push(segment());
    }
}
