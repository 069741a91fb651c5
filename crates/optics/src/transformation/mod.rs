//! Coordinate maps and the material tensors that follow from them.

mod conformal;
mod faddeeva;
mod flat;
mod gaussian;
mod grating;
mod monotone_root;
mod quasi_conformal;
mod radial;
mod strip_to_rhombus;

pub use conformal::{ConformalMap, ConformalMapError, MapJet, Truncation};
pub(crate) use conformal::{JetLanes, LaneMap, of_each};
pub use flat::FlatMap;
pub use gaussian::GaussianMap;
pub use grating::GratingMap;
pub(crate) use monotone_root::root_in_bracket;
pub use quasi_conformal::QuasiConformalMap;
pub use radial::{RadialMap, Symmetry};
pub use strip_to_rhombus::StripToRhombus;
