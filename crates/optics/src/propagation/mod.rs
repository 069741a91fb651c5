//! How a ray runs through a graded medium.

mod conformal_flow;
pub mod nystrom;
pub mod reference;

pub use conformal_flow::{Boundary, ConformalFlow, FlowEnd, FlowError, Foothold, Half};
