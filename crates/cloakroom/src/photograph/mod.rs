//! Pictures that rays look at: reading image files into linear light, and averaging them over the
//! patch that a ray bundle covers.
//!
//! - [`ImageSource`] names an image, built in or a file; [`load()`] reads it into a
//!   [`LinearImage`].
//! - [`Pyramid`] answers what a point of the image looks like through a patch of any shape.
//! - [`Equirectangular`] wraps a pyramid around the scene; [`Irradiance`] is the light that a
//!   matt surface gets from it.
//!
//! Everything is linear light in the sRGB primaries from here on; files are read by their usual
//! meaning (PNG and JPEG: sRGB, EXR: linear). Colour profiles are ignored.

mod downsample;
mod equirectangular;
mod exr_image;
mod footprint;
mod irradiance;
mod jpeg_markers;
mod linear_image;
mod load;
mod pyramid;
mod source;
mod srgb;

pub use equirectangular::Equirectangular;
pub use irradiance::Irradiance;
pub use linear_image::{LinearImage, Texels};
pub(crate) use load::load_with_digest;
pub use load::{dimensions, load, load_bytes, over_black};
pub use pyramid::{Averaging, Edges, Pyramid};
pub use source::{ImageSource, LoadError, LoadProblem};
pub use srgb::{decode, decode_table, encode};
