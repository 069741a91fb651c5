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

pub mod color;
pub mod flux;
pub mod index_file;
pub mod input;
pub mod interface_json;
pub mod json;
pub mod material;
pub mod material_file;
pub mod measure;
pub mod memory;
mod mesh_file;
pub mod outline_mesh;
pub mod output;
pub mod photograph;
pub mod ray_json;
pub mod render;
pub mod scene;
pub mod scene_file;
pub mod threads;
pub mod timeline;

pub use cloakroom_trace::{assembly, device, keys, split_mix, walk as trace};
