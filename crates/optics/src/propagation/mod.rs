//! How a ray runs through a graded medium.

mod closed_form;
mod conformal_flow;
mod nystrom;
mod radial;
pub mod reference;
mod spline;

pub use closed_form::{ClosedForm, CurvedRay, SquaredIndex, WayOut, first_way_out, follow};
pub use conformal_flow::{
    Boundary, ConformalFlow, FlowEnd, FlowError, Half, IndexPerturbation, VirtualPoint,
};
pub use radial::{
    Border, CentralLens, OpticAxis, RadialEnd, RadialFlow, TransformedShell, TransmutedSphere,
    UniaxialCylinder,
};

pub use spline::{GridSpline, GridSplineError};

use glam::{DMat3, DVec3};

/// A point of a ray's path, for drawings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Where it is, cm.
    pub position: DVec3,
    /// The optical path from the start of the path, cm.
    pub optical_path: f64,
}

/// The rotation that keeps `normal` and takes the unit vector `from`, across it, to `to`.
fn turn_in_plane(normal: DVec3, from: DVec3, to: DVec3) -> DMat3 {
    let column = |component: usize| {
        to * from[component]
            + normal.cross(to) * normal.cross(from)[component]
            + normal * normal[component]
    };
    DMat3::from_cols(column(0), column(1), column(2))
}
