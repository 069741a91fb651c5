//! The model of a scene: camera, light, photograph, surroundings and devices.
//!
//! Plain data, free of files: [`scene_file`](crate::scene_file) fills it from TOML, other front
//! ends from [`Values`].

mod camera;
mod polarizer;
mod receiver;
mod tables;

use glam::DVec3;

pub use camera::{Camera, CameraRay, CameraSettings, Projection};
pub use polarizer::Polarizer;
pub use receiver::Receiver;
pub use tables::{
    CAMERA_KEYS, LIGHT_KEYS, OPTIONAL_CHANNELS, PHOTOGRAPH_KEYS, PICTURE_KEYS, PLACEMENT_KEYS,
    RECEIVER_KEYS, SCALAR_CHANNELS, SURROUNDINGS_KEYS, TABLES, TRACE_KEYS,
};

pub use crate::device::Show;
use crate::device::{Entry, Imperfection};
use crate::keys::{KeyError, Values};
use crate::photograph::ImageSource;

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
    /// The scene as TOML, overrides applied: it goes into the metadata of pictures.
    pub source: String,
}

/// The light that fills the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Wavelength in vacuum, in nm.
    pub wavelength_nm: f64,
}

/// The photograph: a plane of constant x.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotographSettings {
    /// What hangs there.
    pub image: ImageSource,
    /// The plane it hangs in, in cm.
    pub x: f64,
    /// Its width in cm; `None`: 110 for the builtin one, for others as wide as the camera's view
    /// ([`Camera::covering_width`]).
    pub width: Option<f64>,
}

/// What rays see that hit nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum SurroundingsSettings {
    /// The same everywhere: linear red, green and blue.
    Color([f64; 3]),
    /// An equirectangular image.
    Image(ImageSource),
}

/// How rays are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceSettings {
    /// Branches weaker than this share of the camera ray are pruned.
    pub min_power: f64,
    /// Whether the scene says so, rather than leaving it at the default.
    pub min_power_given: bool,
    /// Largest error of position and optical path on leaving a device, in cm.
    pub tolerance: f64,
}

/// What a picture shows and holds.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureSettings {
    /// Those of [`OPTIONAL_CHANNELS`] that EXR and NPZ files hold.
    pub channels: Vec<&'static str>,
    /// What a PNG shows: one of [`SCALAR_CHANNELS`] in false colors; `None`: what the camera sees.
    pub map: Option<&'static str>,
    /// Whether the scale of a map is drawn beside it.
    pub color_bar: bool,
}

/// One device of a scene.
#[derive(Clone, Debug)]
pub struct DeviceSettings {
    /// Its kind.
    pub entry: &'static Entry,
    /// The values of its kind's own keys.
    pub values: Values,
    /// What of it is shown.
    pub show: Show,
    /// Whether its hidden region is air instead of metal.
    pub open_core: bool,
    /// Degrees about its own axis, counterclockwise seen from +z.
    pub rotation: f64,
    /// Where its origin lies, in cm.
    pub position: DVec3,
    /// Whole length along its z axis in cm; `None`: endless.
    pub length: Option<f64>,
    /// How what is made of it differs from its design.
    pub imperfection: Option<Imperfection>,
}

impl Light {
    /// The settings in a table of [`LIGHT_KEYS`].
    pub fn from_values(values: &Values) -> Self {
        Light { wavelength_nm: values.number("wavelength_nm") }
    }
}

impl PhotographSettings {
    /// The settings in a table of [`PHOTOGRAPH_KEYS`].
    pub fn from_values(values: &Values) -> Self {
        PhotographSettings {
            image: values.image("image").clone(),
            x: values.number("x"),
            width: values.optional_number("width"),
        }
    }
}

impl SurroundingsSettings {
    /// The settings in a table of [`SURROUNDINGS_KEYS`].
    ///
    /// # Errors
    ///
    /// If both a color and an image are given.
    pub fn from_values(values: &Values) -> Result<Self, KeyError> {
        match values.optional_image("image") {
            None => Ok(SurroundingsSettings::Color(values.vector("color"))),
            Some(_) if values.is_given("color") => {
                let message = "color and image are both given; the surroundings take one of them";
                Err(KeyError::at("image", message))
            }
            Some(image) => Ok(SurroundingsSettings::Image(image.clone())),
        }
    }
}

impl TraceSettings {
    /// The settings in a table of [`TRACE_KEYS`].
    pub fn from_values(values: &Values) -> Self {
        TraceSettings {
            min_power: values.number("min_power"),
            min_power_given: values.is_given("min_power"),
            tolerance: values.number("tolerance"),
        }
    }
}

impl PictureSettings {
    /// The settings in a table of [`PICTURE_KEYS`].
    pub fn from_values(values: &Values) -> Self {
        let map = values.choice("map");
        PictureSettings {
            channels: values.choices("channels").to_vec(),
            map: SCALAR_CHANNELS.iter().find(|&&channel| channel == map).copied(),
            color_bar: values.flag("color_bar"),
        }
    }

    /// Whether one of [`OPTIONAL_CHANNELS`] is asked for, to be held or to be shown.
    #[must_use]
    pub fn asks_for(&self, channel: &str) -> bool {
        self.channels.contains(&channel) || self.map == Some(channel)
    }
}

impl DeviceSettings {
    /// A device of a kind, with the values of the kind's own keys and of [`PLACEMENT_KEYS`].
    pub fn from_values(entry: &'static Entry, values: Values, placement: &Values) -> Self {
        DeviceSettings {
            entry,
            values,
            show: match placement.choice("show") {
                "bare" => Show::Bare,
                "mirror" => Show::Mirror,
                _ => Show::Cloak,
            },
            open_core: placement.choice("core") == "open",
            rotation: placement.number("rotation"),
            position: DVec3::from_array(placement.vector("position")),
            length: placement.optional_number("length"),
            imperfection: placement.table("imperfection").map(Imperfection::from_values),
        }
    }

    /// A device of a kind with everything at its default.
    pub fn new(entry: &'static Entry) -> Self {
        let placement = Values::defaults(PLACEMENT_KEYS);
        DeviceSettings::from_values(entry, Values::defaults(entry.keys), &placement)
    }
}

impl Default for Light {
    fn default() -> Self {
        Light::from_values(&Values::defaults(LIGHT_KEYS))
    }
}

impl Default for PhotographSettings {
    fn default() -> Self {
        PhotographSettings::from_values(&Values::defaults(PHOTOGRAPH_KEYS))
    }
}

impl Default for SurroundingsSettings {
    fn default() -> Self {
        Self::from_values(&Values::defaults(SURROUNDINGS_KEYS)).expect("a color alone")
    }
}

impl Default for TraceSettings {
    fn default() -> Self {
        TraceSettings::from_values(&Values::defaults(TRACE_KEYS))
    }
}

impl Default for PictureSettings {
    fn default() -> Self {
        PictureSettings::from_values(&Values::defaults(PICTURE_KEYS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_scene_is_that_of_the_paper() {
        let scene = Scene::default();
        let camera = CameraSettings {
            position: DVec3::new(-100.0, 0.0, 0.0),
            target: DVec3::new(50.0, 0.0, 0.0),
            up: DVec3::Y,
            projection: Projection::Perspective { field_of_view: 40.0 },
            resolution: [1024, 768],
            samples: 4,
            adaptive: 0.0,
            seed: 0,
            polarizer: Polarizer::None,
        };
        assert_eq!(scene.camera.settings(), &camera);
        assert_eq!((scene.receiver.position.x, scene.receiver.normal), (50.0, DVec3::NEG_X));
        assert_eq!((scene.receiver.width, scene.receiver.length), (60.0, 60.0));
        assert_eq!(scene.photograph.image, ImageSource::BuiltIn("bookshelf"));
        assert_eq!((scene.photograph.x, scene.photograph.width), (50.0, None));
        assert_eq!(scene.surroundings, SurroundingsSettings::Color([0.0; 3]));
        assert_eq!((scene.trace.min_power, scene.trace.min_power_given), (1e-4, false));
        assert_eq!(scene.trace.tolerance, 1e-6);
        assert_eq!(scene.light.wavelength_nm, 550.0);
        let picture = PictureSettings { channels: Vec::new(), map: None, color_bar: true };
        assert_eq!(scene.picture, picture);
        assert!(scene.devices.is_empty());
    }

    #[test]
    fn the_view_is_sized_in_the_terms_of_its_projection() {
        let key = |pairs: &[(&str, crate::keys::Value)]| {
            let mut values = Values::defaults(CAMERA_KEYS);
            for (name, value) in pairs {
                values.set(name, value.clone()).expect(name);
            }
            CameraSettings::from_values(&values).map(|s| s.projection).map_err(|e| e.key)
        };
        let orthographic = ("projection", "orthographic".into());
        assert_eq!(key(&[("width", 50.0.into())]), Err(Some("width")));
        assert_eq!(key(std::slice::from_ref(&orthographic)), Err(Some("projection")));
        let both = [orthographic.clone(), ("field_of_view", 40.0.into()), ("width", 50.0.into())];
        assert_eq!(key(&both), Err(Some("field_of_view")));
        let width = key(&[orthographic, ("width", 50.0.into())]);
        assert_eq!(width, Ok(Projection::Orthographic { width: 50.0 }));
    }
}
