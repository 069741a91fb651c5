//! What real media are made of: how their refractive index depends on the wavelength.
//!
//! ```
//! use optics::material::Material;
//!
//! // The sodium line in glass: n and the group index.
//! let glass = Material::named("bk7").expect("it comes with the program");
//! let refraction = glass.ordinary.at(0.5893)?;
//! assert!((refraction.index.re - 1.51673).abs() < 5e-6);
//! assert!(refraction.group_index.re > refraction.index.re);
//! # Ok::<(), optics::material::IndexLawError>(())
//! ```

mod catalog;
mod law;
mod slope;
#[cfg(test)]
mod tests;

pub use law::{Dispersion, IndexLaw, IndexLawError, Refraction, Table};

/// A medium that is not magnetic, by the laws of its index.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What it is, for people.
    pub title: String,
    /// Where its law is published.
    pub source: String,
    /// The law of its index; in a uniaxial crystal that of the ordinary wave.
    pub ordinary: IndexLaw,
    /// In a uniaxial crystal the law of the extraordinary wave whose field is along the optic axis.
    pub extraordinary: Option<IndexLaw>,
}
