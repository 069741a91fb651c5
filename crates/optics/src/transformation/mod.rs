//! Coordinate maps and the material tensors that follow from them.

mod strip_to_rhombus;

pub use strip_to_rhombus::StripToRhombus;
