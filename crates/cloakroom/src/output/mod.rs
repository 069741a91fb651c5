//! stub
mod picture;
pub use picture::{Channel, Picture, Samples};
