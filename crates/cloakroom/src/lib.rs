//! What is looked at: scenes with invisibility cloaks and other transformation-optics devices, the
//! rays that run through them, and the pictures they make.
//!
//! The physics of light in matter is in the crate [`optics`]; this crate builds devices from it,
//! traces rays through scenes, and makes pictures and data of what they see. The way of a ray:
//!
//! scene file -> [`scene::Scene`] -> camera rays -> [`trace::Tracer`] -> leaves -> what each leaf
//! sees -> [`output::Picture`] -> files.
//!
//! Lengths are in cm, angles in degrees, times in ns, unless a name says otherwise; axes and signs
//! are those of [`optics::wave`].

pub mod animation;
pub mod device;
mod direction;
pub mod examples;
pub mod flux;
pub mod gallery;
pub mod illustration;
pub mod input;
pub mod interface_exchange;
pub mod keys;
pub mod material;
pub mod measure;
mod memory;
pub mod output;
pub mod paper;
pub mod photograph;
pub mod render;
pub mod scene;
pub mod scene_file;
mod split_mix;
pub mod threads;
pub mod trace;
