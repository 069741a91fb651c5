//! The prepared: a scene made ready to be looked at, images read and devices built.

use super::body_surface::BodySurface;
use super::spectral::Spectral;
use super::{Images, metadata};
use crate::assembly::{Assembly, MOST_DEVICES, Placed, Screen};
use crate::input::Digest;
use crate::keys::KeyError;
use crate::photograph::{self, Averaging, Equirectangular, Irradiance, LoadError, Pyramid};
use crate::scene::{Border, Camera, DeviceName, DeviceSettings, Projection, Scene};
use crate::trace::{Coherence, Limits, RaySettings};
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// The key of metadata that says what was in the files a scene names.
pub const INPUTS: &str = "inputs";

/// Width of the builtin photograph, cm.
const BUILTIN_WIDTH: f64 = 110.0;

/// Why a scene cannot be looked at.
#[derive(Debug, thiserror::Error)]
pub enum PreparedSceneError {
    /// The light is that of no lamp.
    #[error("{0}")]
    Light(#[source] KeyError),
    /// A device cannot be built.
    #[error("{error}")]
    Device {
        /// Which device, counted from 0.
        device: usize,
        /// What is wrong, where, and what would be right.
        error: KeyError,
    },
    /// Two devices are in each other's way.
    #[error("{second} overlaps {first}; move one of them (devices are counted from 0)")]
    Overlap {
        /// One of them.
        first: DeviceName,
        /// The other.
        second: DeviceName,
    },
    /// Two bodies are in the same place with the same right.
    #[error(
        "{second} overlaps {first}, and both bodies have the same priority; give the one \
         that is to be there the larger one (devices are counted from 0)"
    )]
    EqualPriority {
        /// One of them.
        first: DeviceName,
        /// The other.
        second: DeviceName,
    },
    /// There are too many devices.
    #[error("there are {count} devices; a scene may have {MOST_DEVICES}")]
    TooManyDevices {
        /// How many there are.
        count: usize,
    },
    /// The camera is where there is no light.
    #[error(
        "the camera stands inside {device} (counted from 0), in metal or an opaque body; \
         it must stand in air or in another medium"
    )]
    CameraInside {
        /// Which device.
        device: DeviceName,
    },
    /// A device cuts through the photograph.
    #[error(
        "{device} (counted from 0) cuts through the photograph in the plane {plane}; \
         move one of them"
    )]
    PhotographInside {
        /// Which device.
        device: DeviceName,
        /// The plane of the photograph in words.
        plane: String,
    },
    /// The photograph needs a width.
    #[error(
        "the camera's view does not end on the photograph's plane {plane}, so the photograph \
         cannot be made to cover it; give its `width`"
    )]
    NoCoveringWidth {
        /// The plane of the photograph in words.
        plane: String,
    },
    /// The photograph cannot hang like that.
    #[error("{0}")]
    PhotographPlace(#[source] KeyError),
    /// An image cannot be read: the photograph, that of the surroundings, or one on a body.
    #[error("{error}")]
    Image {
        /// The key that names it.
        key: String,
        /// Why not.
        error: LoadError,
    },
}

impl PreparedSceneError {
    /// The key of the scene file that the error is about, such as `device.0.side`.
    #[must_use]
    pub fn key(&self) -> String {
        match self {
            Self::Light(error) => error.path_in("light"),
            Self::Device { device, error } => error.path_in(&format!("device.{device}")),
            Self::PhotographInside { device, .. } => format!("device.{}", device.number),
            Self::Overlap { second, .. } => format!("device.{}", second.number),
            Self::EqualPriority { second, .. } => format!("device.{}.priority", second.number),
            Self::TooManyDevices { .. } => format!("device.{MOST_DEVICES}"),
            Self::CameraInside { .. } => "camera.position".to_owned(),
            Self::NoCoveringWidth { .. } => "photograph.x".to_owned(),
            Self::PhotographPlace(error) => error.path_in("photograph"),
            Self::Image { key, .. } => key.clone(),
        }
    }
}

/// Builds the devices of a scene and puts them in their places. Neither the camera nor any image is
/// looked at: this is all that tracing given rays needs.
///
/// # Errors
///
/// If a device is impossible or two overlap.
pub fn assembly(scene: &Scene) -> Result<Assembly, PreparedSceneError> {
    assembly_at(scene, scene.light.wavelength_nm())
}

/// The same in light of a wavelength in vacuum (nm).
pub(super) fn assembly_at(
    scene: &Scene,
    wavelength_nm: f64,
) -> Result<Assembly, PreparedSceneError> {
    let count = scene.devices.len();
    if count > MOST_DEVICES {
        return Err(PreparedSceneError::TooManyDevices { count });
    }
    let mut placed = Vec::new();
    for (index, device) in scene.devices.iter().enumerate() {
        let wrong = |error| PreparedSceneError::Device { device: index, error };
        let device = DeviceSettings { wavelength_nm, ..device.clone() };
        let pose = device.pose().map_err(wrong)?;
        let structure = device.structure(index).map_err(wrong)?;
        let dispersion = device.placement.dispersion;
        placed.push(Placed { pose, structure, dispersion });
    }
    let assembly = Assembly::new(placed).with_wavelength(wavelength_nm);
    let is_body = |index: usize| assembly.devices()[index].structure.hull.body.is_some();
    let Some((one, other)) = assembly.overlap() else { return Ok(assembly) };
    let (first, second) = (scene.device_name(one), scene.device_name(other));
    Err(if is_body(one) && is_body(other) {
        PreparedSceneError::EqualPriority { first, second }
    } else {
        PreparedSceneError::Overlap { first, second }
    })
}

/// The limits that a scene's `[trace]` table sets.
#[must_use]
pub fn limits(scene: &Scene) -> Limits {
    Limits { min_power: scene.trace.min_power.value, tolerance: scene.trace.tolerance }
}

/// The threshold where leaves can interfere: 1e-4 of the power is 1e-2 of the field.
const INTERFERENCE_MIN_POWER: f64 = 1e-8;

/// How exactly paths are known where leaves can interfere, as a share of the wavelength.
const INTERFERENCE_TOLERANCE: f64 = 1e-3;

/// The width of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelWidth {
    /// The angle between the rays of two neighbours.
    pub angle: f64,
    /// How far apart they start, cm.
    start: f64,
}

impl PixelWidth {
    fn of(camera: &Camera) -> Self {
        let [x, y] = camera.resolution.map(|pixels| 0.5 * f64::from(pixels));
        let (one, other) = (camera.ray(x, y), camera.ray(x + 1.0, y));
        let angle = (other.direction - one.direction).length();
        Self { angle, start: (other.origin - one.origin).length() }
    }

    /// At a distance from the camera, cm.
    pub fn width_at(self, distance: f64) -> f64 {
        self.start + self.angle * distance
    }
}

/// Whether the leaves of a picture are added as fields: where the scene writes a bandwidth, has a
/// polarizer, or a device so thin that light within it interferes. Elsewhere paths coincide here
/// and there by chance, and branches are pruned that would have to be followed for their fields.
#[must_use]
fn interferes(scene: &Scene, assembly: &Assembly) -> bool {
    scene.light.bandwidth_nm.given || is_coherent(scene, assembly).any(|is_coherent| is_coherent)
}

/// Whether light that a device parts is still coherent where it meets again, of each device.
fn is_coherent(scene: &Scene, assembly: &Assembly) -> impl Iterator<Item = bool> {
    let reach = coherence(scene).reach();
    assembly.devices().iter().map(move |device| device.least_path_difference() <= reach)
}

/// The limits of a picture whose leaves are added as fields, closer than those of the scene.
fn interference_limits(scene: &Scene) -> Limits {
    const CM_PER_NM: f64 = 1e-7;
    let limits = limits(scene);
    let given = scene.trace.min_power.given;
    let min_power = if given { limits.min_power } else { INTERFERENCE_MIN_POWER };
    let paths = INTERFERENCE_TOLERANCE * scene.light.wavelength_nm() * CM_PER_NM;
    Limits { min_power, tolerance: limits.tolerance.min(paths) }
}

/// The threshold of given rays where nothing else is said.
const RAY_MIN_POWER: f64 = 1e-9;

/// The same where fields are added: 1e-10 in the field.
const COHERENT_MIN_POWER: f64 = 1e-24;

/// The light of a scene.
#[must_use]
pub fn coherence(scene: &Scene) -> Coherence {
    Coherence::new(scene.light.wavelength_nm(), scene.light.bandwidth_nm.value)
}

/// How given rays are traced: the threshold is the given one, else that which the scene writes,
/// else 1e-9, or 1e-24 if leaves are to be added as fields (`coherent`); with what pulses take if
/// `group_delays`.
#[must_use]
pub fn ray_settings(
    scene: &Scene,
    min_power: Option<f64>,
    coherent: bool,
    group_delays: bool,
) -> RaySettings {
    let settings = &scene.trace;
    let written = Some(settings.min_power.value).filter(|_| settings.min_power.given);
    let least = if coherent { COHERENT_MIN_POWER } else { RAY_MIN_POWER };
    let min_power = min_power.or(written).unwrap_or(least);
    let limits = Limits { min_power, tolerance: settings.tolerance };
    let coherence = coherent.then(|| coherence(scene));
    RaySettings { coherence, group_delays, ..limits.into() }
}

/// What rays see that hit nothing.
#[derive(Clone, Debug)]
pub(super) enum Surroundings {
    Color([f64; 3]),
    Image(Arc<Equirectangular>),
}

/// What matt surfaces get from the surroundings.
#[derive(Clone, Debug)]
pub(super) enum LightAround {
    Even([f64; 3]),
    Directed(Arc<Irradiance>),
}

impl LightAround {
    /// Linear RGB that a white matt surface with this unit normal sends out.
    pub fn at(&self, normal: DVec3) -> [f64; 3] {
        match self {
            Self::Even(color) => *color,
            Self::Directed(irradiance) => irradiance.at(normal),
        }
    }
}

impl Surroundings {
    fn light_around(&self) -> LightAround {
        match self {
            Self::Color(color) => LightAround::Even(*color),
            Self::Image(image) => LightAround::Directed(Arc::new(Irradiance::new(image))),
        }
    }

    /// The light that comes against a direction, given what that changes by from sample to sample.
    pub fn light(&self, direction: DVec3, steps: impl FnOnce() -> [DVec3; 2]) -> [f64; 3] {
        match self {
            Self::Color(color) => *color,
            Self::Image(image) => {
                let [dx, dy] = steps();
                image.sample(direction, dx, dy).map(f64::from)
            }
        }
    }
}

/// A scene ready to be rendered.
#[derive(Clone, Debug)]
pub struct PreparedScene<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// The devices at their places.
    pub assembly: Assembly,
    /// The limits within which rays are followed.
    pub limits: Limits,
    /// How light interferes, where it is looked at: a scene that says so, with a polarizer or thin
    /// devices.
    pub coherence: Option<Coherence>,
    /// How wide a pixel is in the middle of the picture.
    pub(super) pixel: PixelWidth,
    /// Whether all camera rays start in air, and none in a medium.
    pub(super) starts_in_air: bool,
    /// The rectangle in space on which the photograph is.
    pub screen: Screen,
    /// The photograph.
    pub image: Arc<Pyramid>,
    /// How patches of it are averaged.
    averaging: Averaging,
    pub(super) surroundings: Surroundings,
    /// Those of the opaque bodies, by their numbers among the devices.
    body_surfaces: Vec<Option<BodySurface>>,
    /// The files it was made from: the keys that name them, and their contents.
    files: Vec<(String, Digest)>,
    /// The wavelengths of its colors, where they are traced each by itself.
    pub(super) spectral: Option<Arc<Spectral<'s>>>,
}

impl<'s> PreparedScene<'s> {
    /// Reads the images and builds the devices of a scene.
    ///
    /// # Errors
    ///
    /// If an image cannot be read, a device is impossible, or something stands in something else.
    pub fn new(scene: &'s Scene) -> Result<Self, PreparedSceneError> {
        Self::with_images(scene, &mut Images::default())
    }

    /// The same with images that have been read before, where the scene shows them; what is read
    /// goes among them.
    ///
    /// # Errors
    ///
    /// As [`PreparedScene::new`].
    pub fn with_images(scene: &'s Scene, images: &mut Images) -> Result<Self, PreparedSceneError> {
        let assembly = assembly(scene)?;
        let starts_in_air = rays_start_in_air(scene, &assembly).map_err(|device| {
            PreparedSceneError::CameraInside { device: scene.device_name(device) }
        })?;
        let unreadable = |key: &str| {
            let key = key.to_owned();
            move |error| PreparedSceneError::Image { key, error }
        };
        let image = images.photograph(&scene.photograph.image);
        let image = image.map_err(unreadable("photograph.image"))?;
        let aspect = image.width() as f64 / image.height() as f64;
        let screen = screen(scene, aspect)?;
        if let Some(device) = screen.cut_by(&assembly) {
            return Err(PreparedSceneError::PhotographInside {
                device: scene.device_name(device),
                plane: scene.photograph.plane(),
            });
        }
        let surroundings = match &scene.surroundings.image {
            None => Surroundings::Color(scene.surroundings.color.value),
            Some(source) => {
                let image = images.around(source).map_err(unreadable("surroundings.image"))?;
                Surroundings::Image(image)
            }
        };
        let lit = scene.devices.iter().any(DeviceSettings::is_lit);
        let light_around = lit.then(|| surroundings.light_around());
        let surface = |(device, placed): (usize, &Placed)| {
            BodySurface::of(&scene.devices[device], placed, images, light_around.as_ref())
                .map_err(unreadable(&format!("device.{device}.surface.image")))
        };
        let body_surfaces =
            assembly.devices().iter().enumerate().map(surface).collect::<Result<_, _>>()?;
        let coherence = interferes(scene, &assembly).then(|| coherence(scene));
        let limits = if coherence.is_some() { interference_limits(scene) } else { limits(scene) };
        let digest = |(key, path): (String, PathBuf)| {
            let index_files = || scene.devices.iter().flat_map(|device| &device.index_files);
            let of_index = || index_files().find_map(|file| file.digest_of(&path));
            let material = scene.material_files.iter().find(|file| file.is_at(&path));
            let of_material = || material.map(|file| file.digest);
            Some((key, images.digest_of(&path).or_else(of_index).or_else(of_material)?))
        };
        let files = scene.files().into_iter().filter_map(digest).collect();
        images.keep(&scene.body_images().collect::<Vec<_>>());
        let pixel = PixelWidth::of(&scene.camera);
        let mut prepared = Self {
            scene,
            assembly,
            limits,
            coherence,
            pixel,
            starts_in_air,
            screen,
            image,
            averaging: Averaging::Sharp,
            surroundings,
            body_surfaces,
            files,
            spectral: None,
        };
        prepared.spectral = Spectral::of(&prepared)?.map(Arc::new);
        Ok(prepared)
    }

    /// Because of which devices the leaves of the picture are added as fields, by their numbers: polarizers
    /// and devices that part light by less than it is coherent.
    pub fn interfering(&self) -> impl Iterator<Item = usize> {
        is_coherent(self.scene, &self.assembly)
            .enumerate()
            .filter_map(|(number, is_coherent)| is_coherent.then_some(number))
    }

    /// The same scene with the photograph averaged in another way.
    #[must_use]
    pub fn averaged(self, averaging: Averaging) -> Self {
        Self { averaging, ..self }
    }

    /// The same scene in light of another wavelength (nm).
    pub(super) fn at(&self, wavelength_nm: f64) -> Result<Self, PreparedSceneError> {
        let assembly = assembly_at(self.scene, wavelength_nm)?;
        let bandwidth_nm = self.scene.light.bandwidth_nm.value;
        let coherence = self.coherence.map(|_| Coherence::new(wavelength_nm, bandwidth_nm));
        Ok(Self { assembly, coherence, spectral: None, ..self.clone() })
    }

    /// The same scene with leaves that interfere as that light does.
    pub(super) fn with_coherence(&self, coherence: Option<Coherence>) -> Self {
        Self { coherence, spectral: None, ..self.clone() }
    }

    /// The same scene with leaves that never interfere.
    pub(super) fn added_by_power(&self) -> Self {
        let spectral = self.spectral.as_deref().map(|spectral| Arc::new(spectral.added_by_power()));
        Self { coherence: None, limits: limits(self.scene), spectral, ..self.clone() }
    }

    /// What every file carries: program, scene, version and seed, and where the scene names files,
    /// `inputs`, the digest of each.
    #[must_use]
    pub fn metadata(&self) -> Vec<(String, String)> {
        let mut metadata = metadata(self.scene);
        if !self.files.is_empty() {
            let files = self.files.iter().map(|(key, digest)| format!("{key} {digest}"));
            metadata.push((INPUTS.to_owned(), files.collect::<Vec<_>>().join("\n")));
        }
        metadata
    }

    /// The light of the photograph at (u, v), on it or beyond its edge, through a filter as wide as
    /// these steps.
    #[inline]
    pub(super) fn photograph_light<const N: usize>(
        &self,
        at: [f64; 2],
        steps: [[f64; 2]; N],
    ) -> [f64; 3] {
        let edges = self.scene.photograph.border.edges();
        self.image.sample_with((edges, self.averaging), at, steps).map(f64::from)
    }

    /// The surface of an opaque body.
    pub(super) fn body_surface(&self, device: u16) -> Option<&BodySurface> {
        self.body_surfaces[usize::from(device)].as_ref()
    }

    /// Rows of the picture: the steps of its progress.
    #[must_use]
    pub fn rows(&self) -> u64 {
        u64::from(self.scene.camera.resolution[1])
    }
}

/// Whether all camera rays start in air, and none in a medium. Those of an orthographic camera start side
/// by side: every pixel is looked at.
///
/// # Errors
///
/// The device in whose metal, or opaque inside, a ray would start.
fn rays_start_in_air(scene: &Scene, assembly: &Assembly) -> Result<bool, usize> {
    let camera = &scene.camera;
    let forward = camera.forward();
    let in_air =
        |origin: DVec3| assembly.region_around(origin, forward).map(|region| region.is_none());
    match camera.projection {
        Projection::Perspective => in_air(camera.position),
        Projection::Orthographic => {
            let [width, height] = camera.resolution;
            let mut pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            pixels.try_fold(true, |all, (x, y)| {
                Ok(in_air(camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).origin)? && all)
            })
        }
    }
}

/// The photograph's rectangle, for an image of the given aspect (width over height).
fn screen(scene: &Scene, aspect: f64) -> Result<Screen, PreparedSceneError> {
    let settings = &scene.photograph;
    let pose = settings.pose().map_err(PreparedSceneError::PhotographPlace)?;
    let width = match settings.width {
        Some(width) => width,
        None if matches!(settings.image, photograph::ImageSource::BuiltIn(_)) => BUILTIN_WIDTH,
        None => scene
            .camera
            .covering_width(&pose, aspect)
            .ok_or_else(|| PreparedSceneError::NoCoveringWidth { plane: settings.plane() })?,
    };
    let screen = Screen::new(&pose, width / 2.0, width / aspect / 2.0);
    Ok(if settings.border == Border::None { screen } else { screen.endless() })
}
