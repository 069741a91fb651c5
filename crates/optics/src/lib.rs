//! Light in transformation media: plane waves, the media that carry them, the interfaces where
//! media meet, and exact propagation through graded ones.
//!
//! The crate knows no scenes, files or images. Its conventions (axes, signs, units, polarization)
//! are stated once, in [`wave`].
//!
//! | module | holds |
//! | --- | --- |
//! | [`wave`] | wave vectors, fields, polarization, Poynting vectors |
//! | [`medium`] | permittivity and permeability tensors and the waves they carry |
//! | [`material`] | how real media depend on the wavelength |
//! | [`interface`] | reflection and refraction where two media, or a medium and a metal, meet |
//! | [`geometry`] | surfaces and where a ray meets them |
//! | [`transformation`] | coordinate maps, their inverses and tensors |
//! | [`propagation`] | how a ray runs through a graded medium |

pub mod geometry;
pub mod interface;
mod lanes;
pub mod material;
pub mod medium;
pub mod propagation;
pub mod transformation;
pub mod wave;
