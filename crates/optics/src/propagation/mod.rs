//! How a ray runs through a graded medium.

mod conformal_flow;
mod nystrom;
mod radial;
pub mod reference;
mod spline;

pub use conformal_flow::{
    Boundary, ConformalFlow, FlowEnd, FlowError, Half, IndexPerturbation, VirtualPoint,
};
pub use radial::{
    Border, CentralLens, OpticAxis, RadialEnd, RadialFlow, TransformedShell, TransmutedSphere,
    UniaxialCylinder,
};

pub use spline::{GridSpline, GridSplineError};

use glam::DVec3;

/// A point of a ray's path, for drawings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Where it is, cm.
    pub position: DVec3,
    /// The optical path from the start of the path, cm.
    pub optical_path: f64,
}
