//! How a ray runs through a graded medium.

mod conformal_flow;
mod nystrom;
mod radial;
pub mod reference;

pub use conformal_flow::{Boundary, ConformalFlow, FlowEnd, FlowError, Foothold, Half};
pub use radial::{
    Border, CentralLens, OpticAxis, RadialEnd, RadialFlow, TransformedShell, TransmutedSphere,
    UniaxialCylinder,
};
