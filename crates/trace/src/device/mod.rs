//! The catalogue of devices, and what devices are made of.
//!
//! A device is a set of regions filled with media and the surfaces around them ([`Structure`]).
//! Each kind is one file here, a struct whose fields are the keys of its table in a scene and which
//! becomes a structure, and one line in [`CATALOGUE`]; nothing else in the program knows it.
//!
//! ```
//! use cloakroom_trace::device::{Device, Request, SquareCloak};
//!
//! let cloak = SquareCloak { side: 10.0, ..SquareCloak::default() };
//! let structure = cloak.build(Request::default())?;
//! assert_eq!(structure.regions.len(), 4);
//! # Ok::<(), cloakroom_trace::keys::KeyError>(())
//! ```

mod bending_sphere;
mod body;
mod carpet;
mod closed_form;
mod coating;
mod convex;
mod cross_section;
mod cylinder_cloak;
mod dispersion;
mod double_gaussian_cloak;
mod fisheye_hemisphere;
mod floor;
mod gaussian_carpet;
mod graded;
mod graded_box;
mod grating_carpet;
mod imperfection;
mod invisible_sphere;
mod lens;
mod lenses;
mod material_at;
mod medium_words;
mod mirror;
mod mirror_detour;
mod polarizer;
mod polygons;
mod polyhedron;
mod prisms;
mod quasi_conformal_carpet;
mod region;
mod round;
mod spatial;
mod sphere_cloak;
mod square_cloak;
mod structure;
mod surface;

pub use body::{BodyShape, BodySurface};
pub use closed_form::{ClosedFormBorder, ClosedFormRegion};
pub use coating::{CoatingLayer, Metal, MetalOfIndex, layers};
pub use convex::Convex;
pub use cross_section::{Contour, CrossSection, Section};
pub use cylinder_cloak::ShellMaterial;
pub use dispersion::{Dispersion, DispersionLaw};
pub use graded::GradedShape;
pub use imperfection::Imperfection;
pub use invisible_sphere::SphereMaterial;
pub use material_at::MaterialAt;
pub use medium_words::{
    BiaxialWords, DispersiveMedium, DispersiveTensors, DrudeTerm, LorentzTerm, MaterialLaw,
    MaterialWord, MediumWords, SellmeierTerm, UniaxialWords,
};
pub use optics::geometry::REACH;
pub use prisms::PrismOfMedium;
pub use region::{
    ConformalRegion, Face, HomogeneousRegion, InnerRay, NoPassage, Passage, RadialRegion, Region,
    RegionBorder,
};
pub use spatial::SpatialRegion;
pub use square_cloak::SegmentMaterial;
pub use structure::{Body, Coating, FarSide, Hull, Structure, SurfaceHit};
pub use surface::{Part, Shape, Surface};

use crate::key;
use crate::keys::{Given, Key, KeyError, Table};
use glam::{DMat3, DVec2};
use optics::geometry::{Extent, Outline, Solid, Wall};
use optics::medium::{Medium, Tensor};

crate::choice! {
    /// What of a device is looked at.
    pub enum Show {
        /// The device.
        Cloak = "cloak",
        /// The metal alone, without its cloak.
        Bare = "bare",
        /// What it should look like: the flat mirror it imitates, or nothing.
        Mirror = "mirror",
        /// Nothing: the place that it would take.
        Empty = "empty",
    }
}

crate::choice! {
    /// What fills the hidden region of a cloak.
    pub enum Core {
        /// Metal, which reflects.
        Metal = "metal",
        /// Air, in which bodies may stand.
        Open = "open",
    }
}

/// What every device is asked for beside its own keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// What of it is looked at.
    pub show: Show,
    /// What fills its hidden region.
    pub core: Core,
    /// Its whole length along z, cm; endless if absent.
    pub length: Option<f64>,
    /// Whether it is asked to be of metal, as bodies may be: a perfect conductor, until
    /// [`Structure::of_metal`] says of which.
    pub metal: bool,
    /// The wavelength of the light in vacuum, nm: media of materials depend on it.
    pub wavelength_nm: f64,
}

impl Default for Request {
    fn default() -> Self {
        let (show, core) = (Show::default(), Core::default());
        let wavelength_nm = Self::DESIGN_WAVELENGTH_NM;
        Self { show, core, length: None, metal: false, wavelength_nm }
    }
}

impl Request {
    /// The middle of what eyes see.
    pub const DESIGN_WAVELENGTH_NM: f64 = 550.0;

    /// Whether the hidden region is to be air.
    #[must_use]
    pub fn has_open_core(&self) -> bool {
        self.core == Core::Open
    }
}

/// A device: a table of a scene that becomes a structure.
pub trait Device: Table {
    /// The `kind` in a scene file.
    const KIND: &'static str;

    /// A title for people.
    const TITLE: &'static str;

    /// Makes it of fields that are each within their limits.
    ///
    /// # Errors
    ///
    /// If values that are each allowed do not go together.
    fn structure(&self, request: Request) -> Result<Structure, KeyError>;

    /// Computes what can be said about it in numbers; nothing if it cannot be built.
    fn facts(&self, request: Request) -> Vec<Fact>;

    /// Makes the device.
    ///
    /// # Errors
    ///
    /// If a field is outside its limits, or values that are each allowed do not go together.
    fn build(&self, request: Request) -> Result<Structure, KeyError> {
        self.check()?;
        if request.show == Show::Empty { Ok(Structure::empty()) } else { self.structure(request) }
    }
}

/// One kind of device.
#[derive(Debug)]
pub struct Entry {
    /// The `kind` in a scene file.
    pub kind: &'static str,
    /// A title for people.
    pub title: &'static str,
    /// What it is, in a sentence or two, with its source.
    pub summary: &'static str,
    /// Its own keys, beside those every device has.
    pub keys: &'static [Key],
    /// Makes a device with every key at its default.
    pub device: fn() -> AnyDevice,
}

/// A computed property of a device.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// Its name in snake case, with the unit, as in `cloaked_area_cm2`.
    pub name: &'static str,
    /// Its value.
    pub value: FactValue,
}

/// The value of a [`Fact`].
#[derive(Clone, Debug, PartialEq)]
pub enum FactValue {
    /// A number.
    Number(f64),
    /// A few numbers: a vector, or the principal values of a tensor.
    Numbers(Vec<f64>),
}

impl Fact {
    fn number(name: &'static str, value: f64) -> Self {
        Self { name, value: FactValue::Number(value) }
    }

    fn numbers(name: &'static str, values: impl Into<Vec<f64>>) -> Self {
        Self { name, value: FactValue::Numbers(values.into()) }
    }

    /// The diagonal of a tensor in its principal axes.
    fn principal_values(name: &'static str, tensor: &DMat3) -> Self {
        Self::numbers(name, [tensor.x_axis.x, tensor.y_axis.y, tensor.z_axis.z])
    }
}

/// Makes the catalogue of the kinds of devices, each in its module.
macro_rules! catalogue {
    ($($module:ident::$kind:ident),+ $(,)?) => {
        $(pub use $module::$kind;)+

        /// A device of the catalogue.
        #[derive(Clone, Debug, PartialEq)]
        #[allow(missing_docs, reason = "each variant is the struct of its name")]
        #[allow(clippy::large_enum_variant, reason = "a scene has few devices")]
        pub enum AnyDevice {
            $($kind($kind)),+
        }

        /// Every kind of device the program knows.
        pub static CATALOGUE: &[&Entry] = &[$(&Entry {
            kind: <$kind as Device>::KIND,
            title: <$kind as Device>::TITLE,
            summary: $kind::SUMMARY,
            keys: $kind::KEYS,
            device: || AnyDevice::$kind($kind::default()),
        }),+];

        impl AnyDevice {
            /// The word for its kind in a scene file.
            #[must_use]
            pub fn kind(&self) -> &'static str {
                match self { $(Self::$kind(_) => <$kind as Device>::KIND),+ }
            }

            /// Its table.
            #[must_use]
            pub fn table(&self) -> &dyn Table {
                match self { $(Self::$kind(device) => device),+ }
            }

            /// Its table, to be changed.
            pub fn table_mut(&mut self) -> &mut dyn Table {
                match self { $(Self::$kind(device) => device),+ }
            }

            /// Makes the device.
            ///
            /// # Errors
            ///
            /// As [`Device::build`].
            pub fn build(&self, request: Request) -> Result<Structure, KeyError> {
                match self { $(Self::$kind(device) => device.build(request)),+ }
            }

            /// What can be said about it in numbers: see [`Device::facts`].
            #[must_use]
            pub fn facts(&self, request: Request) -> Vec<Fact> {
                match self { $(Self::$kind(device) => device.facts(request)),+ }
            }
        }
    };
}

catalogue! {
    square_cloak::SquareCloak,
    double_gaussian_cloak::DoubleGaussianCloak,
    cylinder_cloak::CylinderCloak,
    sphere_cloak::SphereCloak,
    invisible_sphere::InvisibleSphere,
    bending_sphere::BendingSphere,
    lenses::EatonLens,
    lenses::LuneburgLens,
    lenses::FisheyeLens,
    fisheye_hemisphere::FisheyeHemisphere,
    mirror_detour::MirrorDetour,
    prisms::Prisms,
    graded::Graded,
    graded_box::GradedBox,
    body::SolidBody,
    polyhedron::FacetedSolid,
    lens::GlassLens,
    polarizer::Polarizer,
    mirror::PlaneMirror,
    gaussian_carpet::GaussianCarpet,
    grating_carpet::GratingCarpet,
    quasi_conformal_carpet::QuasiConformalCarpet,
}

/// The entry of a kind, if there is one.
#[must_use]
pub fn entry(kind: &str) -> Option<&'static Entry> {
    CATALOGUE.iter().copied().find(|entry| entry.kind == kind)
}

/// The medium of words, or of the keys `permittivity` and `permeability`, at a wavelength in vacuum,
/// nm.
fn medium(
    words: &MediumWords,
    tensors: [(&'static str, Given<Tensor>); 2],
    wavelength_nm: f64,
) -> Result<DispersiveMedium, KeyError> {
    let given = tensors.iter().filter_map(|(key, tensor)| tensor.given.then_some(*key));
    if let Some(medium) = words.medium(&given.collect::<Vec<_>>(), wavelength_nm)? {
        return Ok(medium);
    }
    let [permittivity, permeability] = tensors.map(|(_, tensor)| tensor.value);
    Medium::new(permittivity, permeability).map(DispersiveMedium::from).map_err(|error| {
        let magnetic = error.quantity() == Some("permeability");
        let key =
            if magnetic { key!(SolidBody.permeability) } else { key!(SolidBody.permittivity) };
        KeyError::at(key, error.to_string())
    })
}

/// Refuses to show a device otherwise than as it is; `reason` says what it is: "a body is no
/// cloak".
fn refuse_other_views(request: Request, reason: &str) -> Result<(), KeyError> {
    let message = format!("{reason}; it can be shown as it is, with show = \"cloak\", only");
    KeyError::refuse_if(request.show != Show::Cloak, key!(Request.show), message)
}

/// A two-sided flat metal strip on the x axis, |x| <= `half_width` (cm): what a cloak that opens a
/// strip should look like.
fn flat_strip(half_width: f64, extent: Extent) -> Structure {
    let ends = [DVec2::new(half_width, 0.0), DVec2::new(-half_width, 0.0)];
    let surfaces = vec![Surface::mirror(Wall::new(ends[0], ends[1], extent))];
    let hull =
        Hull::new(Solid::Nothing).with_thin_mirror(Outline { corners: ends.to_vec() }, extent);
    Structure::new(Vec::new(), surfaces, hull)
}

/// A device of a kind with some of its keys, for tests.
#[cfg(test)]
fn built(kind: &str, keys: &[(&str, crate::keys::Value)], request: Request) -> Structure {
    let mut device = (entry(kind).expect("a kind").device)();
    for (key, value) in keys {
        device.table_mut().set(key, value.clone()).expect("a key");
    }
    device.build(request).expect("a device")
}

#[cfg(test)]
mod tests;
