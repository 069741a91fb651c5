//! The ray tree: how a ray launched in air runs through the devices of a scene.
//!
//! The tracer knows only this: advance to the next surface; at a surface, split by the interface
//! solver; at a conductor, reflect. Power is accounted for: what the leaves carry, what is
//! absorbed and what is pruned add up to what was launched.

mod bench;
mod bodies;
mod branch;
mod crossing;
mod exchange;
mod first_face;
mod four;
mod interfaces;
mod leaf;
mod leaf_table;
mod neighbours;
mod screen;
mod surfaces;
mod tracer;
mod witness;

pub use bench::{Bench, MOST_DEVICES, Placed};
pub use bodies::MOST_BODIES;
pub use exchange::{LeafReport, Polarization, RayError, RayReport, RayRequest, trace_rays};
pub use first_face::FirstFace;
pub use four::FourTracers;
pub use leaf::{Leaf, Outcome, Rarities};
pub use leaf_table::LeafTable;
pub use screen::Screen;
pub use tracer::{Launch, Limits, Tracer};
pub use witness::{Leg, Line, Witness, lines};
