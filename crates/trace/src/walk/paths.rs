//! The ways that rays take, to be drawn: the pieces of ray trees, each with the one it comes from.

use super::{Launch, Leaf, LeafEnd, Limits, PathRecorder, PathSegment, PathTime, Tracer};
use crate::assembly::Assembly;
use glam::DVec3;
use optics::propagation::PathPoint;
use std::collections::HashMap;

/// A piece of a ray tree in the world, from surface to surface, or from the last one on.
#[derive(Clone, Debug, PartialEq)]
pub struct TreePath<const N: usize> {
    /// Its share of the power launched where it starts, for each launched polarization.
    pub power: [f64; N],
    /// The way, with the optical path from the ray's origin.
    pub points: Vec<PathPoint>,
    /// When light that leaves the ray's origin at 0 comes to each of its points.
    pub times: Vec<PathTime>,
    /// The fingerprint of the branch: rays beside each other that take the same turns have the same.
    pub branch: u64,
    /// The place, among the leaves that the tracer gives, of the one that runs along it for ever.
    pub leaf: Option<usize>,
    /// The place among the paths of the one from whose end it goes on; `None` from the ray's origin.
    pub parent: Option<usize>,
}

/// Gathers the pieces of ray trees: one who watches a tracer.
#[derive(Clone, Debug, Default)]
pub struct PathGatherer<const N: usize> {
    segments: Vec<(PathSegment<N>, Option<usize>)>,
    /// The segment in which the branch of a fingerprint, or what it comes from, has run last.
    last: HashMap<u64, usize>,
    /// Segments are kept that begin at less optical path and are longer than this, cm: light that
    /// is caught in a device goes to and fro in it for ever, or through the same point.
    until: f64,
    shortest: f64,
    reach: f64,
}

impl<const N: usize> PathRecorder<N> for PathGatherer<N> {
    fn record(&mut self, segment: impl FnOnce() -> PathSegment<N>) {
        let segment = segment();
        let moves =
            |ends: &[PathPoint]| ends[0].position.distance(ends[1].position) > self.shortest;
        if segment.optical_path < self.until && segment.path.windows(2).any(moves) {
            let parent = self.last.insert(segment.branch, self.segments.len());
            self.segments.push((segment, parent));
        }
    }

    fn went_on(&mut self, from: u64, to: u64, _power: f64) -> bool {
        if let Some(segment) = self.last.get(&from) {
            self.last.insert(to, *segment);
        }
        true
    }
}

impl<const N: usize> PathGatherer<N> {
    /// One that follows leaves for `reach` (cm), and light that does not leave for 100 times that.
    #[must_use]
    pub fn new(reach: f64) -> Self {
        Self { until: 100.0 * reach, shortest: 1e-9 * reach, reach, ..Self::default() }
    }

    /// The paths of the ray that has been traced last, given its leaves: those on the way, each after
    /// the one it comes from, then those of the leaves that run on. The next ray may be traced then.
    pub fn take(&mut self, assembly: &Assembly, leaves: &[Leaf<N>]) -> Vec<TreePath<N>> {
        let reach = self.reach;
        let away = leaves.iter().enumerate().filter(|(_, leaf)| leaf.end == LeafEnd::Away);
        let away: Vec<TreePath<N>> = away
            .map(|(number, leaf)| TreePath {
                power: leaf.power,
                points: [0.0, reach]
                    .map(|way| PathPoint {
                        position: leaf.position + leaf.direction * way,
                        optical_path: leaf.optical_path + way,
                    })
                    .to_vec(),
                times: [0.0, reach].map(|way| leaf.time().after(way)).to_vec(),
                branch: leaf.path,
                leaf: Some(number),
                parent: self.last.get(&leaf.path).copied(),
            })
            .collect();
        self.last.clear();
        let segments = self.segments.drain(..).map(|(segment, parent)| {
            let device = segment.inside.map(|(device, _)| usize::from(device));
            let pose = device.map(|device| assembly.devices()[device].pose);
            let point = |at: PathPoint| PathPoint {
                position: pose.map_or(at.position, |pose| pose.to_world(at.position)),
                optical_path: segment.optical_path + at.optical_path,
            };
            let points = segment.path.iter().map(|at| point(*at)).collect();
            let PathSegment { power, times, branch, .. } = segment;
            TreePath { power, points, times, branch, leaf: None, parent }
        });
        segments.chain(away).collect()
    }
}

/// A piece of a ray tree in the world, to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its share of the power launched.
    pub power: f64,
    /// The way, with the optical path from the ray's origin.
    pub points: Vec<PathPoint>,
    /// When light that leaves the ray's origin at 0 comes to each of its points; of pulses, too.
    pub times: Vec<PathTime>,
    /// The fingerprint of the branch: rays beside each other that take the same turns have the same.
    pub branch: u64,
    /// Whether it goes on for ever.
    pub leaves: bool,
}

/// The pieces of the tree of a ray, the leaves first. `weights` are the shares of the launched
/// polarizations; a leaf is followed for `reach` (cm), light that does not leave for 100 times that.
#[must_use]
pub fn lines<const N: usize>(
    assembly: &Assembly,
    limits: Limits,
    launch: &Launch<N>,
    weights: [f64; N],
    reach: f64,
) -> Vec<Line> {
    let tracer = Tracer::new(assembly, limits).with_group_delays();
    let mut tracer = tracer.watched(PathGatherer::new(reach));
    let leaves = tracer.trace(launch).0.to_vec();
    let paths = tracer.recorder().take(assembly, &leaves);
    let line = |path: TreePath<N>| Line {
        power: path.power.iter().zip(weights).map(|(p, w)| p * w).sum(),
        points: path.points,
        times: path.times,
        branch: path.branch,
        leaves: path.leaf.is_some(),
    };
    let (away, inner): (Vec<_>, Vec<_>) = paths.into_iter().partition(|path| path.leaf.is_some());
    away.into_iter().chain(inner).map(line).collect()
}

/// The paths of many rays side by side in arrays.
#[derive(Clone, Debug, PartialEq)]
pub struct PathTable<const N: usize = 1> {
    /// The number of the ray that each path is of, counted from 0.
    pub ray: Vec<u32>,
    /// Its share of the power of its ray where it starts, for each launched polarization.
    pub power: Vec<[f64; N]>,
    /// The place in the table of leaves of the one that runs along it for ever; -1 where others go
    /// on from its end, or none.
    pub leaf: Vec<i64>,
    /// The place among the paths of the one from whose end it goes on; -1 from the ray's origin.
    pub parent: Vec<i64>,
    /// Where its vertices begin, and at last where those of the last end: one more than there are
    /// paths.
    pub start: Vec<u64>,
    /// The vertices of all paths, cm.
    pub vertex: Vec<[f64; 3]>,
    /// The optical path from the ray's origin to each vertex, cm.
    pub optical_path: Vec<f64>,
}

impl<const N: usize> Default for PathTable<N> {
    fn default() -> Self {
        Self {
            ray: Vec::new(),
            power: Vec::new(),
            leaf: Vec::new(),
            parent: Vec::new(),
            start: vec![0],
            vertex: Vec::new(),
            optical_path: Vec::new(),
        }
    }
}

impl<const N: usize> PathTable<N> {
    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.ray.len() * (4 + 8 * N + 24) + self.vertex.len() * 32
    }

    /// Adds the paths of a ray; `place` says where in the table of leaves a leaf of it is.
    pub fn push(
        &mut self,
        ray: usize,
        paths: &[TreePath<N>],
        place: impl Fn(usize) -> Option<usize>,
    ) {
        let first = self.ray.len();
        for path in paths {
            // The number of rays fits into 32 bits.
            self.ray.push(ray as u32);
            self.power.push(path.power);
            self.leaf.push(path.leaf.and_then(&place).map_or(-1, |leaf| leaf as i64));
            self.parent.push(path.parent.map_or(-1, |parent| (first + parent) as i64));
            self.vertex.extend(path.points.iter().map(|point| DVec3::to_array(&point.position)));
            self.optical_path.extend(path.points.iter().map(|point| point.optical_path));
            self.start.push(self.vertex.len() as u64);
        }
    }

    /// Adds the paths of further rays, whose leaves come after so many.
    pub(super) fn append(&mut self, mut other: Self, leaves: usize) {
        let (paths, vertices) = (self.ray.len() as i64, self.vertex.len() as u64);
        let moved = |number: i64, by: i64| if number < 0 { number } else { number + by };
        self.ray.append(&mut other.ray);
        self.power.append(&mut other.power);
        self.leaf.extend(other.leaf.iter().map(|leaf| moved(*leaf, leaves as i64)));
        self.parent.extend(other.parent.iter().map(|parent| moved(*parent, paths)));
        self.start.extend(other.start[1..].iter().map(|start| start + vertices));
        self.vertex.append(&mut other.vertex);
        self.optical_path.append(&mut other.optical_path);
    }
}
