//! The catalogue of devices, and what devices are made of.
//!
//! A device is a set of cells filled with media and the skin of surfaces around them
//! ([`Structure`]). Each kind is one file here that turns the keys of its table in a scene into a
//! structure, and one line in [`CATALOGUE`]; nothing else in the program knows it.

mod bending_sphere;
mod body;
mod body_shape;
mod carpet;
mod cell;
mod cross_section;
mod cylinder_cloak;
mod double_gaussian_cloak;
mod gaussian_carpet;
mod graded;
mod grating_carpet;
mod imperfection;
mod invisible_sphere;
mod lenses;
mod mirror_detour;
mod occupant;
mod prisms;
mod quasi_conformal_carpet;
mod round;
mod skin;
mod sphere_cloak;
mod square_cloak;
mod structure;

pub use body_shape::{Body, BodyShape, Filling, Surface};
pub use cell::{Cell, ConformalCell, Entrance, Face, InnerRay, Passage, Prism, RadialCell};
pub use cross_section::{Contour, CrossSection, REACH, Region, Side};
pub use imperfection::{IMPERFECTION_KEYS, Imperfection};
pub use occupant::Occupant;
pub use skin::Skin;
pub use structure::{Beyond, Finish, Hull, SkinHit, Structure};

use crate::keys::{Key, KeyError, KeyKind, Values};
use glam::{DMat3, DVec2};
use optics::geometry::{Extent, Outline, Solid, Wall};
use optics::medium::Medium;

/// What of a device is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// The device.
    #[default]
    Cloak,
    /// The metal alone, without its cloak.
    Bare,
    /// What it should look like: the flat mirror it imitates, or nothing.
    Mirror,
}

/// What every device is asked for beside its own keys.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Request {
    /// What of it is looked at.
    pub show: Show,
    /// Whether the hidden region is to be air instead of metal.
    pub open_core: bool,
    /// Its whole length along z, cm; endless if absent.
    pub length: Option<f64>,
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
    /// Makes the device from the values of its keys.
    ///
    /// # Errors
    ///
    /// If values that are each allowed do not go together.
    pub build: fn(&Values, Request) -> Result<Structure, KeyError>,
    /// Computes what can be said about it in numbers. The values must be ones that `build` accepts.
    pub facts: fn(&Values) -> Vec<Fact>,
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

/// Every kind of device the program knows.
pub static CATALOGUE: &[&Entry] = &[
    &square_cloak::ENTRY,
    &double_gaussian_cloak::ENTRY,
    &cylinder_cloak::ENTRY,
    &sphere_cloak::ENTRY,
    &invisible_sphere::ENTRY,
    &bending_sphere::ENTRY,
    &lenses::EATON,
    &lenses::LUNEBURG,
    &lenses::FISHEYE,
    &mirror_detour::ENTRY,
    &prisms::ENTRY,
    &graded::ENTRY,
    &body::ENTRY,
    &gaussian_carpet::ENTRY,
    &grating_carpet::ENTRY,
    &quasi_conformal_carpet::ENTRY,
];

/// The entry of a kind, if there is one.
#[must_use]
pub fn entry(kind: &str) -> Option<&'static Entry> {
    CATALOGUE.iter().copied().find(|entry| entry.kind == kind)
}

/// The key `permittivity` of what is filled with a medium.
const PERMITTIVITY_KEY: Key = Key {
    name: "permittivity",
    doc: "Relative permittivity, in the device's frame; symmetric.",
    kind: KeyKind::Tensor,
};

/// The key `permeability` of what is filled with a medium.
const PERMEABILITY_KEY: Key = Key {
    name: "permeability",
    doc: "Relative permeability, in the device's frame; symmetric.",
    kind: KeyKind::Tensor,
};

/// The medium of the keys `permittivity` and `permeability`.
fn medium(values: &Values) -> Result<Medium, KeyError> {
    let [permittivity, permeability] =
        ["permittivity", "permeability"].map(|key| values.tensor(key));
    Medium::new(permittivity, permeability).map_err(|error| {
        let key =
            if error.quantity() == Some("permeability") { "permeability" } else { "permittivity" };
        KeyError::at(key, error.to_string())
    })
}

/// Refuses to show a device otherwise than as it is; `reason` says what it is: "a body is no cloak".
fn refuse_other_views(request: Request, reason: &str) -> Result<(), KeyError> {
    if request.show == Show::Cloak {
        return Ok(());
    }
    let message = format!("{reason}; it can be shown as it is, with show = \"cloak\", only");
    Err(KeyError::at("show", message))
}

/// A two-sided flat metal strip on the x axis, |x| <= `half_width` (cm): what a cloak that opens a
/// strip should look like.
fn flat_strip(half_width: f64, extent: Extent) -> Structure {
    let ends = [DVec2::new(half_width, 0.0), DVec2::new(-half_width, 0.0)];
    Structure {
        cells: Vec::new(),
        skin: vec![Skin::Strip(Wall::new(ends[0], ends[1], extent))],
        hull: Hull::new(Solid::Nothing).with_thin_mirror(Outline::new(ends.to_vec()), extent),
    }
}

/// A device of a kind with some of its keys, for tests.
#[cfg(test)]
fn built(kind: &str, keys: &[(&str, crate::keys::Value)], request: Request) -> Structure {
    let entry = entry(kind).expect("a kind");
    let mut values = Values::defaults(entry.keys);
    for (key, value) in keys {
        values.set(key, value.clone()).expect("a key");
    }
    (entry.build)(&values, request).expect("a device")
}
