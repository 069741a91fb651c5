//! The ways that rays take, for drawings.

use super::{Branch, FirstFace, Launch, LeafEnd, Limits, Tracer};
use crate::assembly::Assembly;
use optics::interface::OutgoingWave;
use optics::propagation::PathPoint;

/// One who watches a tracer. Nobody, `()`, costs nothing.
pub trait PathRecorder<const N: usize> {
    /// Whether rays end at the first surface that they meet.
    const STOPS_AT_SURFACE: bool = false;

    /// Called for each piece of a branch's way from surface to surface.
    fn record(&mut self, segment: impl FnOnce() -> PathSegment<N>);

    /// Called with the waves that leave the first surface, if rays end there.
    fn stopped(&mut self, _waves: &[OutgoingWave<N>]) {}

    /// Called for each branch that is to be followed from where it is in a homogeneous medium.
    #[inline(always)]
    fn begins(&mut self, _branch: &Branch<N>) {}

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
    /// The power of the branch where it starts, for each launched polarization.
    pub power: [f64; N],
    /// The optical path from the ray's origin to where it starts, cm.
    pub optical_path: f64,
    /// The device and its region that it is in; `None` in air.
    pub inside: Option<(u16, u16)>,
    /// The way, in the frame of the device that it is in, else in the world's.
    pub path: Vec<PathPoint>,
}

impl<const N: usize> PathRecorder<N> for () {
    #[inline(always)]
    fn record(&mut self, _: impl FnOnce() -> PathSegment<N>) {}
}

impl<const N: usize> PathRecorder<N> for Vec<PathSegment<N>> {
    fn record(&mut self, segment: impl FnOnce() -> PathSegment<N>) {
        self.push(segment());
    }
}

/// A piece of a ray tree in the world, to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its share of the power launched.
    pub power: f64,
    /// The way, with the optical path from the ray's origin.
    pub points: Vec<PathPoint>,
    /// Whether it goes on for ever.
    pub leaves: bool,
}

/// What is drawn of a tree: light that is caught in a device goes to and fro in it for ever, or
/// through the same point.
struct Drawn<const N: usize> {
    segments: Vec<PathSegment<N>>,
    /// Segments are drawn that begin at less optical path and are longer than this, cm.
    until: f64,
    shortest: f64,
}

impl<const N: usize> PathRecorder<N> for Drawn<N> {
    fn record(&mut self, segment: impl FnOnce() -> PathSegment<N>) {
        let segment = segment();
        let moves =
            |ends: &[PathPoint]| ends[0].position.distance(ends[1].position) > self.shortest;
        if segment.optical_path < self.until && segment.path.windows(2).any(moves) {
            self.segments.push(segment);
        }
    }
}

/// The pieces of the tree of a ray. `weights` are the shares of the launched polarizations; a leaf
/// is followed for `reach` (cm), light that does not leave for 100 times that.
#[must_use]
pub fn lines<const N: usize>(
    assembly: &Assembly,
    limits: Limits,
    launch: &Launch<N>,
    weights: [f64; N],
    reach: f64,
) -> Vec<Line> {
    let weighed = |power: [f64; N]| power.iter().zip(weights).map(|(p, w)| p * w).sum();
    let drawn = Drawn { segments: Vec::new(), until: 100.0 * reach, shortest: 1e-9 * reach };
    let mut tracer = Tracer::new(assembly, limits).watched(drawn);
    let (leaves, _) = tracer.trace(launch);
    let mut lines: Vec<Line> = leaves
        .iter()
        .filter(|leaf| leaf.end == LeafEnd::Away)
        .map(|leaf| Line {
            power: weighed(leaf.power),
            points: [0.0, reach]
                .map(|way| PathPoint {
                    position: leaf.position + leaf.direction * way,
                    optical_path: leaf.optical_path + way,
                })
                .to_vec(),
            leaves: true,
        })
        .collect();
    lines.extend(tracer.recorder().segments.drain(..).map(|segment| {
        let pose = segment.inside.map(|(device, _)| assembly.devices()[usize::from(device)].pose);
        let point = |at: PathPoint| PathPoint {
            position: pose.map_or(at.position, |pose| pose.to_world(at.position)),
            optical_path: segment.optical_path + at.optical_path,
        };
        let points = segment.path.iter().map(|at| point(*at)).collect();
        Line { power: weighed(segment.power), points, leaves: false }
    }));
    lines
}
