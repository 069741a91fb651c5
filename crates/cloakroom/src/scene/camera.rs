//! The camera: which ray belongs to which point of the picture.

use glam::DVec3;
use optics::wave::transverse_basis;

use super::{CAMERA_KEYS, Polarizer};
use crate::direction::unit;
use crate::keys::{KeyError, Values, number_text, vector_text};

#[cfg(test)]
mod tests;

/// Most pixels a side, and most samples a pixel.
pub(super) const MOST: u32 = 65_536;

/// The sine of the angle between `up` and the line of sight below which they count as parallel.
const PARALLEL: f64 = 1e-9;

/// How rays leave the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// From one point.
    Perspective {
        /// Horizontal field of view in degrees, above 0 and below 180.
        field_of_view: f64,
    },
    /// Side by side, all in the direction of the line of sight.
    Orthographic {
        /// Width of the view in cm, above 0.
        width: f64,
    },
}

/// What a camera is made from, not validated yet.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraSettings {
    /// Where it stands, in cm.
    pub position: DVec3,
    /// The point in the middle of the picture, in cm.
    pub target: DVec3,
    /// The direction that is up in the picture; any length, not along the line of sight.
    pub up: DVec3,
    /// How rays leave it.
    pub projection: Projection,
    /// Width and height of the picture in pixels, 1 to 65536 each.
    pub resolution: [u32; 2],
    /// Rays per pixel, 1 to 65536.
    pub samples: u32,
    /// Blocks of 2 x 2 pixels whose first samples (a quarter, at least 4) differ by no more than so many 8-bit
    /// steps get no others; 0 for none.
    pub adaptive: f64,
    /// Chooses where in its pixel each sample lies.
    pub seed: u64,
    /// The polarizer before the lens.
    pub polarizer: Polarizer,
}

/// A ray as it leaves the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Where it starts, in cm.
    pub origin: DVec3,
    /// Where it goes, a unit vector.
    pub direction: DVec3,
}

/// A camera that can take a picture: every way into it validates.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    settings: CameraSettings,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// The middle of the picture, in pixels.
    middle: [f64; 2],
    /// Size of a pixel: cm for an orthographic camera, else at distance 1 along the line of sight.
    pixel: f64,
}

impl CameraSettings {
    /// The settings in a table of [`CAMERA_KEYS`].
    ///
    /// # Errors
    ///
    /// If the size of the view is given in the terms of the other projection, or an orthographic
    /// camera has no width.
    pub fn from_values(values: &Values) -> Result<Self, KeyError> {
        let refuse = |key, belongs, instead| {
            let message = format!("{key} belongs to {belongs} cameras; give {instead} instead");
            Err(KeyError::at(key, message))
        };
        let projection = match values.choice("projection") {
            "orthographic" if values.is_given("field_of_view") => {
                return refuse("field_of_view", "perspective", "width");
            }
            "orthographic" => match values.optional_number("width") {
                Some(width) => Projection::Orthographic { width },
                None => {
                    let message = "an orthographic camera needs width, the width of its view (cm)";
                    return Err(KeyError::at("projection", message));
                }
            },
            _ if values.is_given("width") => {
                return refuse("width", "orthographic", "field_of_view");
            }
            _ => Projection::Perspective { field_of_view: values.number("field_of_view") },
        };
        // The keys' limits lie inside the targets' ranges; the clamps only say so.
        let within = |integer: i64| integer.clamp(0, i64::from(u32::MAX)) as u32;
        Ok(CameraSettings {
            position: DVec3::from_array(values.vector("position")),
            target: DVec3::from_array(values.vector("target")),
            up: DVec3::from_array(values.vector("up")),
            projection,
            resolution: values.integer_pair("resolution").map(within),
            samples: within(values.integer("samples")),
            adaptive: values.number("adaptive"),
            seed: values.integer("seed").unsigned_abs(),
            polarizer: Polarizer::from_value(values.choice_or_number("polarizer"))?,
        })
    }
}

/// The camera of the paper: at x = -100 cm, looking along +x, 40 degrees wide.
impl Default for CameraSettings {
    fn default() -> Self {
        Self::from_values(&Values::defaults(CAMERA_KEYS)).expect("defaults go together")
    }
}

impl Camera {
    /// Sets the camera up.
    ///
    /// # Errors
    ///
    /// If the camera looks at its own position, `up` lies along the line of sight, or a setting is
    /// not finite or outside its range; the error names the key of `[camera]`.
    pub fn new(settings: CameraSettings) -> Result<Self, KeyError> {
        for (key, vector) in
            [("position", settings.position), ("target", settings.target), ("up", settings.up)]
        {
            if !vector.is_finite() {
                let message = format!("{key} is {}; numbers must be finite", vector_text(vector));
                return Err(KeyError::at(key, message));
            }
        }
        let view = settings.target - settings.position;
        if !view.is_finite() {
            let message = "position and target are too far apart";
            return Err(KeyError::at("target", message));
        }
        let Some(forward) = unit(view) else {
            let message = format!(
                "position and target are both {} cm; the camera has no line of sight",
                vector_text(settings.position)
            );
            return Err(KeyError::at("target", message));
        };
        let Some(up) = unit(settings.up) else {
            let message = "up is [0, 0, 0]; it must be a direction";
            return Err(KeyError::at("up", message));
        };
        let right = forward.cross(up);
        if right.length() < PARALLEL {
            let message = format!(
                "up is {}, along the line of sight; it must point across it",
                vector_text(settings.up)
            );
            return Err(KeyError::at("up", message));
        }
        // Where up is nearly parallel, the product is not yet perpendicular to the last digit.
        let right = right.normalize().reject_from_normalized(forward).normalize();

        let [width, height] = settings.resolution;
        if [width, height].iter().any(|side| !(1..=MOST).contains(side)) {
            let message =
                format!("resolution is [{width}, {height}]; each must be from 1 to {MOST}");
            return Err(KeyError::at("resolution", message));
        }
        if !(1..=MOST).contains(&settings.samples) {
            let message = format!("samples is {}; it must be from 1 to {MOST}", settings.samples);
            return Err(KeyError::at("samples", message));
        }
        if !(0.0..=255.0).contains(&settings.adaptive) {
            let message = format!(
                "adaptive is {} 8-bit steps; it must be from 0 to 255",
                number_text(settings.adaptive)
            );
            return Err(KeyError::at("adaptive", message));
        }
        if let Polarizer::Angle(degrees) = settings.polarizer {
            Polarizer::at_angle(degrees)?;
        }
        let view_width = match settings.projection {
            Projection::Perspective { field_of_view } => {
                if !(field_of_view > 0.0 && field_of_view < 180.0) {
                    let message = format!(
                        "field_of_view is {} degrees; it must be above 0 and below 180",
                        number_text(field_of_view)
                    );
                    return Err(KeyError::at("field_of_view", message));
                }
                2.0 * (0.5 * field_of_view.to_radians()).tan()
            }
            Projection::Orthographic { width } => {
                if !(width > 0.0 && width.is_finite()) {
                    let message = format!("width is {} cm; it must be above 0", number_text(width));
                    return Err(KeyError::at("width", message));
                }
                width
            }
        };
        Ok(Camera {
            forward,
            right,
            up: right.cross(forward),
            middle: [0.5 * f64::from(width), 0.5 * f64::from(height)],
            pixel: view_width / f64::from(width),
            settings,
        })
    }

    /// What the camera was made from.
    pub fn settings(&self) -> &CameraSettings {
        &self.settings
    }

    /// Where it stands, in cm.
    pub fn position(&self) -> DVec3 {
        self.settings.position
    }

    /// Width and height of the picture in pixels.
    pub fn resolution(&self) -> [u32; 2] {
        self.settings.resolution
    }

    /// Rays per pixel.
    pub fn samples(&self) -> u32 {
        self.settings.samples
    }

    /// By how many 8-bit steps the first samples of a 2 x 2 block may differ for it to get no others.
    pub fn adaptive(&self) -> f64 {
        self.settings.adaptive
    }

    /// Chooses where in its pixel each sample lies.
    pub fn seed(&self) -> u64 {
        self.settings.seed
    }

    /// The polarizer before the lens.
    pub fn polarizer(&self) -> Polarizer {
        self.settings.polarizer
    }

    /// The line of sight, a unit vector.
    pub fn forward(&self) -> DVec3 {
        self.forward
    }

    /// To the right in the picture, a unit vector: forward x up, +z for the paper's camera.
    pub fn right(&self) -> DVec3 {
        self.right
    }

    /// Up in the picture, a unit vector perpendicular to the line of sight.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// The ray through a point of the picture, in pixels from the left and from the top; the
    /// middle of the first pixel is (0.5, 0.5).
    pub fn ray(&self, px: f64, py: f64) -> CameraRay {
        let offset = self.offset(px, py);
        match self.settings.projection {
            Projection::Perspective { .. } => CameraRay {
                origin: self.settings.position,
                direction: (self.forward + offset).normalize(),
            },
            Projection::Orthographic { .. } => {
                CameraRay { origin: self.settings.position + offset, direction: self.forward }
            }
        }
    }

    /// The horizontal and the vertical electric field of a ray, unit vectors across it: those of
    /// [`transverse_basis`] with the camera's right-hand axis. For a ray along that axis the horizontal one is
    /// the line of sight, as it is x for a ray along z in the paper's scene.
    pub fn polarization_basis(&self, direction: DVec3) -> (DVec3, DVec3) {
        transverse_basis(direction.normalize(), self.right, self.forward)
    }

    /// The smallest width, in cm, of a photograph centred on (`plane_x`, 0, 0) in the plane of
    /// constant x that covers the whole view; `None` if a corner ray misses the plane.
    ///
    /// `image_aspect` is the photograph's width over its height.
    pub fn covering_width(&self, plane_x: f64, image_aspect: f64) -> Option<f64> {
        let [width, height] = self.settings.resolution.map(f64::from);
        let mut half = 0.0_f64;
        // Where the corners hit, all the view does: what a camera sees of a plane is convex.
        for (px, py) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)] {
            let ray = self.ray(px, py);
            let distance = (plane_x - ray.origin.x) / ray.direction.x;
            if !(distance > 0.0 && distance.is_finite()) {
                return None;
            }
            let hit = ray.origin + distance * ray.direction;
            half = half.max(hit.z.abs()).max(hit.y.abs() * image_aspect);
        }
        let width = 2.0 * half;
        (width > 0.0 && width.is_finite()).then_some(width)
    }

    /// A point of the picture relative to its middle, along the camera's axes.
    fn offset(&self, px: f64, py: f64) -> DVec3 {
        // Distances from the middle are exact for pixel centres, so mirrored points of the
        // picture get offsets equal to the last bit but for their sign.
        let across = (px - self.middle[0]) * self.pixel;
        let upward = (self.middle[1] - py) * self.pixel;
        across * self.right + upward * self.up
    }
}

/// The paper's camera, see [`CameraSettings`].
impl Default for Camera {
    fn default() -> Self {
        Camera::new(CameraSettings::default()).expect("the default camera is valid")
    }
}
