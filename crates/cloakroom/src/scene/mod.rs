//! The model of a scene: camera, light, photograph, surroundings and devices.
//!
//! Plain data, free of files: [`scene_file`](crate::scene_file) fills it from TOML, other front
//! ends from a [`Table`].

mod camera;
mod polarizer;
mod receiver;
mod spectrum;
mod tables;

use glam::{DMat3, DVec2, DVec3, Vec3Swizzles};
use optics::geometry::Pose;
use optics::wave::unit;

pub use camera::{Camera, CameraRay};
pub use polarizer::Polarizer;
pub(crate) use spectrum::SPECTRUM;
pub use spectrum::{LampSpectrum, SpectralLine, Spectrum, SpectrumWord};
pub use tables::{
    Border, CameraSettings, Colormap, Light, MapChannel, OPTIONAL_CHANNELS, OptionalChannel,
    PhotographSettings, PictureSettings, Placement, Projection, Receiver, SCALAR_CHANNELS,
    SurroundingsSettings, TABLES, TraceSettings,
};

use crate::device::{
    self, AnyDevice, Dispersion, DispersionLaw, Entry, Fact, Metal, Request, Structure,
};
pub use crate::device::{Core, Show};
use crate::index_file::{self, IndexFile};
use crate::keys::{Field, Key, KeyError, KeyKind, NamedFile, Table, Value, VisitFile, vector_text};
use crate::material_file::MaterialFile;
use crate::photograph::ImageSource;
use cloakroom_trace::key;
use std::borrow::Cow;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Everything a picture depends on.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Who looks.
    pub camera: Camera,
    /// The light.
    pub light: Light,
    /// What hangs behind the devices.
    pub photograph: PhotographSettings,
    /// What rays see that hit nothing.
    pub surroundings: SurroundingsSettings,
    /// How rays are followed.
    pub trace: TraceSettings,
    /// What a picture shows and holds.
    pub picture: PictureSettings,
    /// The plane that `cloakroom flux` receives light on.
    pub receiver: Receiver,
    /// The devices, in the order of the scene file.
    pub devices: Vec<DeviceSettings>,
    /// The files of materials that have been read for it.
    pub material_files: Vec<Arc<MaterialFile>>,
    /// The scene as TOML, overrides applied: it goes into the metadata of pictures.
    pub source: String,
}

/// One device of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceSettings {
    /// What it is.
    pub device: AnyDevice,
    /// What of it is shown, and where it stands.
    pub placement: Placement,
    /// Which of many draws of its random imperfections it is: 0 in a scene.
    pub draw: u32,
    /// The files of its index, its ratio and its axes, where they have been read for it; others are
    /// read where the device is built.
    pub index_files: Vec<Arc<IndexFile>>,
    /// The wavelength of the scene's light in vacuum, nm.
    pub wavelength_nm: f64,
}

impl Scene {
    /// The images on opaque bodies.
    pub fn body_images(&self) -> impl Iterator<Item = ImageSource> {
        self.devices.iter().filter_map(|device| match device.appearance()? {
            Appearance::Image(source) => Some(source),
            Appearance::Color(_) => None,
        })
    }

    /// What messages call the device of that number.
    #[must_use]
    pub fn device_name(&self, number: usize) -> DeviceName {
        let name = self.devices.get(number).and_then(|device| device.placement.name.clone());
        DeviceName { number, name }
    }

    /// Every file that the scene names, with the path of the key that names it.
    #[must_use]
    pub fn files(&self) -> Vec<(String, PathBuf)> {
        let mut files = Vec::new();
        let mut visit =
            |path: &str, file: NamedFile<'_>| files.push((path.to_owned(), file.path.clone()));
        self.photograph.clone().visit_files("photograph", &mut visit);
        self.surroundings.clone().visit_files("surroundings", &mut visit);
        for (number, device) in self.devices.iter().enumerate() {
            let path = format!("device.{number}");
            device.device.clone().table_mut().visit_files(&path, &mut visit);
            device.placement.clone().visit_files(&path, &mut visit);
        }
        files
    }
}

/// A device of a scene as messages call it: `device 1`, or `device 1 ("left")` if it has a name.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceName {
    /// Which device, counted from 0.
    pub number: usize,
    /// The name that the scene gives to it.
    pub name: Option<String>,
}

impl fmt::Display for DeviceName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "device {}", self.number)?;
        self.name.as_ref().map_or(Ok(()), |name| write!(f, " (\"{name}\")"))
    }
}

/// There is no device of that number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "there is no device {device}: {}",
    match .count {
        0 => "the scene has no devices".to_owned(),
        1 => "the scene has one device, 0".to_owned(),
        _ => format!("the scene has {count} devices, 0 to {}", count - 1),
    }
)]
pub struct NoDevice {
    /// The number asked for.
    pub device: usize,
    /// How many there are.
    pub count: usize,
}

/// Whether a table or one within it names a material.
fn has_material(keys: &[Key], entries: &[(String, Value)]) -> bool {
    let of_key = |key: &Key, value: &Value| match (key.kind, value) {
        (KeyKind::Material | KeyKind::MaterialOrTable { .. }, _) => true,
        (kind, Value::Table(entries)) => {
            kind.inner_keys().is_some_and(|keys| has_material(keys, entries))
        }
        (kind, Value::List(items)) => kind.inner_keys().is_some_and(|keys| {
            let tables = items.iter().filter_map(Value::as_table);
            tables.into_iter().any(|entries| has_material(keys, entries))
        }),
        _ => false,
    };
    entries.iter().any(|(name, value)| {
        keys.iter().find(|key| key.name == name).is_some_and(|key| of_key(key, value))
    })
}

/// What an opaque body shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Appearance {
    /// Linear red, green and blue that it sends out everywhere.
    Color([f64; 3]),
    /// An image, laid on its shape.
    Image(ImageSource),
}

impl PhotographSettings {
    /// Where it hangs: its middle is the origin, x the way one looks straight at its front, y up,
    /// and z to the right.
    ///
    /// # Errors
    ///
    /// If both `x` and `position` are given, the normal or `up` is zero, or they are parallel.
    pub fn pose(&self) -> Result<Pose, KeyError> {
        let message = "x and position are both given; x is short for position = [x, 0, 0]";
        KeyError::refuse_if(self.position.given && self.x.given, key!(Self.position), message)?;
        let front = direction(key!(Self.normal), self.normal)?;
        let upward = direction(key!(Self.up), self.up)?;
        let key = key_of(self.up == Self::default().up, key!(Self.normal));
        let across = across(upward.cross(front), (front, "the normal"), (key, self.up))?;
        let rotation = DMat3::from_cols(-front, front.cross(across), across);
        Ok(Pose::from_rotation(self.middle(), rotation))
    }

    fn middle(&self) -> DVec3 {
        if self.position.given { self.position.value } else { DVec3::X * self.x.value }
    }

    /// Its middle, and the direction that it faces, in words; the plane alone where that is one of
    /// constant x with its middle on the x axis, which is all that most scenes say.
    fn words(&self) -> Result<String, [String; 2]> {
        let (middle, normal) = (self.middle(), unit(self.normal).unwrap_or_default());
        if middle.yz() == DVec2::ZERO && normal.yz() == DVec2::ZERO {
            return Ok(format!("x = {} cm", middle.x));
        }
        Err([middle, normal].map(vector_text))
    }

    /// Where it is, in words: "x = 50 cm".
    #[must_use]
    pub fn place(&self) -> String {
        self.words().unwrap_or_else(|[middle, normal]| format!("{middle} cm, facing {normal}"))
    }

    /// Its plane in words: "x = 50 cm".
    #[must_use]
    pub fn plane(&self) -> String {
        self.words()
            .unwrap_or_else(|[middle, normal]| format!("through {middle} cm across {normal}"))
    }
}

impl SurroundingsSettings {
    /// Refuses both a color and an image.
    ///
    /// # Errors
    ///
    /// If both are given.
    pub fn check_one(&self) -> Result<(), KeyError> {
        let message = "color and image are both given; the surroundings take one of them";
        KeyError::refuse_if(self.color.given && self.image.is_some(), key!(Self.image), message)
    }
}

impl PictureSettings {
    /// Refuses two ranges of a map.
    ///
    /// # Errors
    ///
    /// If both are given.
    pub fn check_one_range(&self) -> Result<(), KeyError> {
        let message = "map_range and map_percentile are both given; a map takes one of them";
        let both = self.map_range.is_some() && self.map_percentile.is_some();
        KeyError::refuse_if(both, key!(Self.map_percentile), message)
    }

    /// Whether one of [`OPTIONAL_CHANNELS`] is asked for, to be held or to be shown.
    #[must_use]
    pub fn asks_for(&self, channel: &str) -> bool {
        self.channels.iter().any(|held| held.word() == channel) || self.map.name() == Some(channel)
    }

    /// Whether it asks for a depth that a LIDAR would tell.
    #[must_use]
    pub fn asks_for_pulse_depth(&self) -> bool {
        ["pulse_depth", "first_pulse_depth", "strongest_pulse_depth"]
            .iter()
            .any(|channel| self.asks_for(channel))
    }

    /// Whether it asks for any channel of what pulses take.
    #[must_use]
    pub fn asks_for_group_delay(&self) -> bool {
        ["group_delay", "group_delay_spread", "group_delay_difference"]
            .iter()
            .any(|channel| self.asks_for(channel))
    }
}

impl DeviceSettings {
    /// The word for its kind.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.device.kind()
    }

    /// What an opaque body shows; `None` for other devices.
    #[must_use]
    pub fn appearance(&self) -> Option<Appearance> {
        let AnyDevice::SolidBody(body) = &self.device else { return None };
        let surface = body.surface.as_ref()?;
        Some(match &surface.image {
            Some(image) => Appearance::Image(ImageSource::named(image)),
            None => Appearance::Color(surface.color.value),
        })
    }

    /// Whether it is an opaque body that the surroundings light.
    #[must_use]
    pub fn is_lit(&self) -> bool {
        let AnyDevice::SolidBody(body) = &self.device else { return false };
        body.surface.as_ref().is_some_and(|surface| surface.lit)
    }

    /// Whether its hidden region is air instead of metal.
    #[must_use]
    pub fn has_open_core(&self) -> bool {
        self.placement.core == Core::Open
    }

    /// The structure that is shown, imperfections and coatings included; `number` is the device's
    /// in its scene.
    ///
    /// # Errors
    ///
    /// If keys do not go together, or a file of an index cannot be read.
    pub fn structure(&self, number: usize) -> Result<Structure, KeyError> {
        let Placement { show, imperfection, coating, .. } = &self.placement;
        let structure = self.built(*show)?;
        let message = format!("{} with these keys has no core that could be open", self.kind());
        let is_there = *show != Show::Empty;
        let closed = self.has_open_core() && is_there && structure.hull.filled.is_none();
        KeyError::refuse_if(closed, key!(Placement.core), message)?;
        let layers = device::layers(key!(Placement.coating), coating, self.wavelength_nm)?;
        if *show != Show::Cloak {
            return Ok(structure);
        }
        let structure = match imperfection {
            Some(imperfection) => imperfection.apply(structure, (number, self.draw))?,
            None => structure,
        };
        let structure = self.dispersion_law()?.apply(structure)?;
        structure.coated(key!(Placement.coating), layers)
    }

    /// Whether a medium of it is of a law, so that light of other wavelengths meets another medium.
    #[must_use]
    pub fn is_dispersive(&self) -> bool {
        let table = self.device.table();
        self.has_dispersion_law() || has_material(table.keys(), &table.written()) || {
            has_material(Placement::KEYS, &self.placement.written())
        }
    }

    /// Whether it is a design that a law takes to other wavelengths than its own.
    #[must_use]
    pub fn has_dispersion_law(&self) -> bool {
        matches!(self.placement.dispersion, Dispersion::Drude | Dispersion::Lorentz)
    }

    /// The law of its media, for the light of the scene.
    fn dispersion_law(&self) -> Result<DispersionLaw, KeyError> {
        let Placement { dispersion, design_wavelength_nm, resonance_nm, .. } = self.placement;
        let key = key!(Placement.resonance_nm);
        let word = dispersion.word();
        let stray = resonance_nm.is_some() && dispersion != Dispersion::Lorentz;
        let message =
            format!("resonance_nm is that of dispersion = \"lorentz\"; \"{word}\" has none");
        KeyError::refuse_if(stray, key, message)?;
        let resonance_nm = resonance_nm.unwrap_or(0.5 * design_wavelength_nm);
        let message = format!(
            "resonance_nm is {resonance_nm} nm; it must be below the wavelength of the design, \
             {design_wavelength_nm} nm"
        );
        KeyError::refuse_if(resonance_nm >= design_wavelength_nm, key, message)?;
        let wavelength_nm = self.wavelength_nm;
        let (kind, design_nm) = (dispersion, design_wavelength_nm);
        Ok(DispersionLaw { kind, design_nm, resonance_nm, wavelength_nm })
    }

    /// The structure of one view of the device as it is designed.
    ///
    /// # Errors
    ///
    /// As [`Self::structure`].
    pub fn built(&self, show: Show) -> Result<Structure, KeyError> {
        let structure = self.with_files_read()?.build(self.request(show))?;
        let (key, metal) = (key!(Placement.metal), self.placement.metal.as_ref());
        let message = "metal is false; leave it out: a body is then of no metal, and metal elsewhere a perfect \
                       conductor; a cloak without metal has core = \"open\"";
        KeyError::refuse_if(metal == Some(&Metal::None), key, message)?;
        let metal = metal.map(|metal| metal.medium(self.wavelength_nm)).transpose()?.flatten();
        let Some(metal) = metal else {
            return Ok(structure);
        };
        let (structure, found) = structure.of_metal(metal);
        let message = format!("{} with these keys has no metal of its own", self.kind());
        KeyError::refuse_if(!found && show == Show::Cloak, key, message)?;
        Ok(structure)
    }

    /// What can be said of the device in numbers: see
    /// [`Device::facts`](crate::device::Device::facts).
    #[must_use]
    pub fn facts(&self) -> Vec<Fact> {
        let request = self.request(Show::Cloak);
        self.with_files_read().map(|device| device.facts(request)).unwrap_or_default()
    }

    /// A device of a kind with everything at its default.
    pub fn new(entry: &Entry) -> Self {
        let (device, placement) = ((entry.device)(), Placement::default());
        let wavelength_nm = Request::DESIGN_WAVELENGTH_NM;
        Self { device, placement, draw: 0, index_files: Vec::new(), wavelength_nm }
    }

    /// Whether its metal is a medium that light would go on in.
    #[must_use]
    pub fn has_lossless_metal(&self) -> bool {
        let metal = self.placement.metal.as_ref();
        let medium = metal.and_then(|metal| metal.medium(self.wavelength_nm).ok().flatten());
        medium.is_some_and(|medium| !medium.absorbs())
    }

    fn request(&self, show: Show) -> Request {
        let Placement { core, length, ref metal, .. } = self.placement;
        let metal = metal.as_ref().is_some_and(|metal| *metal != Metal::None);
        Request { show, core, length, metal, wavelength_nm: self.wavelength_nm }
    }

    fn with_files_read(&self) -> Result<Cow<'_, AnyDevice>, KeyError> {
        index_file::with_files_read(&self.device, &self.index_files)
    }

    /// How it is turned, in words: "rotation 10 degrees".
    #[must_use]
    pub fn turn(&self) -> String {
        let rotation = format!("rotation {} degrees", self.placement.rotation);
        if unit(self.placement.axis) == Some(DVec3::Z) {
            rotation
        } else {
            format!("{rotation}, axis along {}", vector_text(self.placement.axis))
        }
    }

    /// Where it stands and how it is turned.
    ///
    /// # Errors
    ///
    /// If its axis is zero.
    pub fn pose(&self) -> Result<Pose, KeyError> {
        let Placement { position, rotation, axis, .. } = self.placement;
        direction(key!(Placement.axis), axis)?;
        // Whole turns are taken off in degrees, of which they are a whole number.
        Ok(Pose::with_axis(position, rotation.rem_euclid(360.0).to_radians(), axis))
    }
}

/// The unit vector along the one of a key.
fn direction(key: &'static str, vector: DVec3) -> Result<DVec3, KeyError> {
    unit(vector).ok_or_else(|| {
        KeyError::at(key, format!("{key} is {}; it must be a direction", vector_text(vector)))
    })
}

/// The key at fault where `up` does not point across another direction: `up`, unless it is what it
/// is by default, or else the one of that direction.
fn key_of(is_default: bool, other: &'static str) -> &'static str {
    if is_default { other } else { key!(CameraSettings.up) }
}

/// The unit vector along a product of the direction `up`, as it is written, with another one; `key` is
/// the one at fault where they are parallel.
fn across(
    product: DVec3,
    (along, words): (DVec3, &str),
    (key, up): (&'static str, DVec3),
) -> Result<DVec3, KeyError> {
    /// The sine of the angle between two directions below which they count as parallel.
    const PARALLEL: f64 = 1e-9;
    let message = format!("up is {}, along {words}; it must point across it", vector_text(up));
    KeyError::refuse_if(product.length() < PARALLEL, key, message)?;
    // Where the two are nearly parallel, the product is not yet perpendicular to the last digit.
    Ok(product.normalize().reject_from_normalized(along).normalize())
}

/// An image by its name.
impl Field for ImageSource {
    const KIND: KeyKind = KeyKind::Image;

    fn from_value(value: &Value) -> Option<Self> {
        value.as_text().map(|name| Self::named(Path::new(name)))
    }

    fn value(&self) -> Option<Value> {
        Some(self.to_string().into())
    }

    fn show_files(&mut self, path: &str, visit: &mut VisitFile<'_>) {
        if let Self::File(file) = self {
            visit(path, NamedFile::of(file));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::Given;
    use glam::DVec3;

    #[test]
    fn the_default_scene_is_that_of_the_paper() {
        let scene = Scene::default();
        assert_eq!(*scene.camera, CameraSettings::default());
        assert_eq!((scene.camera.position.x, scene.camera.forward()), (-100.0, DVec3::X));
        assert_eq!((scene.camera.resolution, scene.camera.samples), ([1024, 768], 4));
        assert_eq!((scene.receiver.position.x, scene.receiver.normal), (50.0, DVec3::NEG_X));
        assert_eq!((scene.receiver.width, scene.receiver.length), (60.0, 60.0));
        assert_eq!(scene.photograph.image, ImageSource::BuiltIn("bookshelf"));
        assert_eq!(scene.photograph.pose(), Ok(Pose::new(DVec3::X * 50.0, 0.0)));
        assert_eq!(scene.photograph.width, None);
        assert_eq!(scene.surroundings, SurroundingsSettings::default());
        assert_eq!(scene.trace.min_power, Given::by_default(1e-4));
        assert_eq!(scene.trace.tolerance, 1e-6);
        assert_eq!(scene.light.wavelength_nm, 550.0);
        assert_eq!((scene.picture.map.name(), scene.picture.color_bar), (None, true));
        assert!(scene.devices.is_empty());
    }

    #[test]
    fn the_view_is_sized_in_the_terms_of_its_projection() {
        use Projection::Orthographic;
        let refusal = |settings: CameraSettings| Camera::new(settings).map(drop).map_err(|e| e.key);
        let camera = CameraSettings::default;
        assert_eq!(refusal(CameraSettings { width: Some(50.0), ..camera() }), Err(Some("width")));
        let orthographic = || CameraSettings { projection: Orthographic, ..camera() };
        assert_eq!(refusal(orthographic()), Err(Some("projection")));
        let wide = || CameraSettings { width: Some(50.0), ..orthographic() };
        let both = CameraSettings { field_of_view: 40.0.into(), ..wide() };
        assert_eq!(refusal(both), Err(Some("field_of_view")));
        assert_eq!(refusal(wide()), Ok(()));
    }
}
