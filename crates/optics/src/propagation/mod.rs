//! How a ray runs through a graded medium.

mod closed_form;
mod conformal_flow;
mod group_path;
mod nystrom;
mod radial;
pub mod reference;
mod runge_kutta;
mod space_spline;
mod spatial_flow;
mod spline;

pub use closed_form::{ClosedForm, CurvedRay, SquaredIndex, first_way_out, follow};
pub use conformal_flow::{
    Boundary, ConformalEnd, ConformalFlow, FlowError, Half, IndexPerturbation, VirtualPoint,
};
pub use group_path::group_path_along;
pub use radial::{
    Border, CentralLens, OpticAxis, RadialFlow, TransformedShell, TransmutedSphere,
    UniaxialCylinder,
};
pub use space_spline::{Look, SpaceSpline};
pub use spatial_flow::{
    Anisotropy, AxisField, Extraordinary, SpatialBorder, SpatialFlow, SpatialMedium, SpatialRay,
};
pub use spline::{Degree, GridSpline, GridSplineError};

use glam::{DMat3, DVec3};

/// A point of a ray's path, for drawings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Where it is, cm.
    pub position: DVec3,
    /// The optical path from the start of the path, cm.
    pub optical_path: f64,
}

/// How a ray arrives at the end of its way through a medium, still inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathEnd<Surface, Virtual = ()> {
    /// The surface where it ends.
    pub surface: Surface,
    /// Where, on the surface, cm.
    pub position: DVec3,
    /// What is known of the point in virtual space, to go on from after a reflection.
    pub virtual_point: Virtual,
    /// The wave vector before refraction or reflection.
    pub wave_vector: DVec3,
    /// The unit vector of the ray there, that of the Poynting vector.
    pub direction: DVec3,
    /// The optical path from start to end, cm.
    pub optical_path: f64,
    /// The speed of light times the time that a pulse takes at the least dispersion that causality
    /// allows, cm, where it has been asked for and is known from the way itself.
    pub group_path: Option<f64>,
    /// What takes the electric field of the wave from start to end, |Re(E × H*)| being kept.
    pub transport: DMat3,
    /// The unit normal of the surface, out of the medium.
    pub outward: DVec3,
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
