//! The ways that rays take, for drawings.

use super::branch::Branch;
use super::{Bench, Launch, Limits, Tracer};
use glam::DVec3;
use optics::propagation::PathPoint;

/// One who watches a tracer. Nobody, `()`, costs nothing.
pub trait Witness<const N: usize> {
    /// Called for each piece of a branch's way from surface to surface.
    fn saw(&mut self, leg: impl FnOnce() -> Leg<N>);
}

/// A piece of a branch's way from surface to surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg<const N: usize> {
    /// The power of the branch where it starts, for each launched polarization.
    pub power: [f64; N],
    /// The optical path from the ray's origin to where it starts, cm.
    pub optical_path: f64,
    /// The device and its cell that it is in; `None` in air and bodies.
    pub inside: Option<(u16, u16)>,
    /// The way, in the frame of the device that it is in, else in the world's.
    pub path: Vec<PathPoint>,
}

impl<const N: usize> Leg<N> {
    /// The straight piece that a branch has just gone from a point to where it is.
    pub(super) fn straight(branch: &Branch<N>, from: DVec3, optical_path: f64) -> Self {
        Self {
            power: branch.power,
            optical_path: branch.optical_path,
            inside: None,
            path: vec![
                PathPoint { position: from, optical_path: 0.0 },
                PathPoint { position: branch.position, optical_path },
            ],
        }
    }
}

impl<const N: usize> Witness<N> for () {
    #[inline(always)]
    fn saw(&mut self, _: impl FnOnce() -> Leg<N>) {}
}

impl<const N: usize> Witness<N> for Vec<Leg<N>> {
    fn saw(&mut self, leg: impl FnOnce() -> Leg<N>) {
        self.push(leg());
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

/// All pieces of the tree of a ray. `weights` are the shares of the launched polarizations; a leaf is followed for
/// `reach` (cm).
#[must_use]
pub fn lines<const N: usize>(
    bench: &Bench,
    limits: Limits,
    launch: &Launch<N>,
    weights: [f64; N],
    reach: f64,
) -> Vec<Line> {
    let weighed = |power: [f64; N]| power.iter().zip(weights).map(|(p, w)| p * w).sum();
    let mut tracer = Tracer::new(bench, limits).watched(Vec::new());
    let (leaves, _) = tracer.trace(launch);
    let mut lines: Vec<Line> = leaves
        .iter()
        .filter(|leaf| leaf.body.is_none())
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
    lines.extend(tracer.witness().drain(..).map(|leg| {
        let pose = leg.inside.map(|(device, _)| bench.devices()[usize::from(device)].pose);
        let point = |at: PathPoint| PathPoint {
            position: pose.map_or(at.position, |pose| pose.to_world(at.position)),
            optical_path: leg.optical_path + at.optical_path,
        };
        let points = leg.path.iter().map(|at| point(*at)).collect();
        Line { power: weighed(leg.power), points, leaves: false }
    }));
    lines
}
