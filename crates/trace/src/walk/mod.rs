//! The ray tree: how a ray launched in air runs through the devices of a scene.
//!
//! The tracer knows only this: advance to the next surface; at a surface, split by the interface
//! solver; at a conductor, reflect. Power is accounted for: what the leaves carry, what is
//! absorbed and what is pruned add up to what was launched.

mod borders;
mod branch;
mod coherence;
mod draw;
mod event;
mod first_face;
mod four;
mod leaf;
mod leaf_table;
mod neighbours;
mod paths;
mod recorder;
mod scatter;
mod start;
mod surfaces;
mod tracer;

pub use branch::{Branch, LAUNCHED};
pub use coherence::{Coherence, Pair, Way};
pub use first_face::FirstFace;
pub use four::FourTracers;
pub use leaf::{Leaf, LeafEnd, Outcome, TraceStats};
pub use leaf_table::{LeafTable, RaySettings, Stopped, batches};
pub use paths::{Line, PathGatherer, PathTable, TreePath, lines};
pub use recorder::{PathRecorder, PathSegment, PathTime};
pub use scatter::{Placement, RayStatus, ScatterRay, Scattered, scatter, scatter_batches};
pub use tracer::{Launch, Limits, Tracer};
