//! The camera: which ray belongs to which point of the picture.

use glam::{DQuat, DVec3};
use optics::wave::transverse_basis;

use super::{CameraSettings, Projection, across, direction, key_of};
use crate::keys::{KeyError, Table, vector_text};
use cloakroom_trace::key;
use optics::geometry::Pose;
use optics::wave::unit;

#[cfg(test)]
mod tests;

/// A ray as it leaves the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Where it starts, in cm.
    pub origin: DVec3,
    /// Where it goes, a unit vector.
    pub direction: DVec3,
}

/// A camera that can take a picture: every way into it validates. Its settings can be read from it.
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

impl std::ops::Deref for Camera {
    type Target = CameraSettings;

    fn deref(&self) -> &CameraSettings {
        &self.settings
    }
}

impl CameraSettings {
    /// Width of the view: cm for an orthographic camera, else at distance 1 along the line of
    /// sight.
    ///
    /// # Errors
    ///
    /// If the size of the view is given in the terms of the other projection, or an orthographic
    /// camera has no width.
    fn view_width(&self) -> Result<f64, KeyError> {
        let refuse = |key, belongs, instead| {
            let message = format!("{key} belongs to {belongs} cameras; give {instead} instead");
            Err(KeyError::at(key, message))
        };
        match (self.projection, self.width) {
            (Projection::Orthographic, _) if self.field_of_view.given => {
                refuse(key!(Self.field_of_view), "perspective", key!(Self.width))
            }
            (Projection::Orthographic, Some(width)) => Ok(width),
            (Projection::Orthographic, None) => {
                let message = "an orthographic camera needs width, the width of its view (cm)";
                Err(KeyError::at(key!(Self.projection), message))
            }
            (Projection::Perspective, Some(_)) => {
                refuse(key!(Self.width), "orthographic", key!(Self.field_of_view))
            }
            (Projection::Perspective, None) => {
                Ok(2.0 * (0.5 * self.field_of_view.value.to_radians()).tan())
            }
        }
    }
}

impl Camera {
    /// Sets the camera up.
    ///
    /// # Errors
    ///
    /// If a setting is outside its limits, the size of the view is given in the terms of the other
    /// projection, the camera looks at its own position, or `up` lies along the line of sight; the
    /// error names the key of `[camera]`.
    pub fn new(settings: CameraSettings) -> Result<Self, KeyError> {
        settings.check()?;
        let view_width = settings.view_width()?;
        let view = settings.target - settings.position;
        let Some(forward) = unit(view) else {
            let message = format!(
                "position and target are both {} cm; the camera has no line of sight",
                vector_text(settings.position)
            );
            return Err(KeyError::at(key!(CameraSettings.target), message));
        };
        let up = direction(key!(CameraSettings.up), settings.up)?;
        let is_default = settings.up == CameraSettings::default().up;
        let key = key_of(is_default, key!(CameraSettings.target));
        let line = (forward, "the line of sight");
        let right = across(forward.cross(up), line, (key, settings.up))?;
        let [width, height] = settings.resolution;
        Ok(Camera {
            forward,
            right,
            up: right.cross(forward),
            middle: [0.5 * f64::from(width), 0.5 * f64::from(height)],
            pixel: view_width / f64::from(width),
            settings,
        })
    }

    /// Where it stands once it has gone round its target, about the axis through it along `up`:
    /// counterclockwise as seen from above.
    #[must_use]
    pub fn orbited(&self, degrees: f64) -> DVec3 {
        let CameraSettings { position, target, up, .. } = self.settings;
        let degrees = degrees.rem_euclid(360.0);
        let Some(axis) = unit(up).filter(|_| degrees != 0.0) else { return position };
        let there =
            target + DQuat::from_axis_angle(axis, degrees.to_radians()) * (position - target);
        // Without the digits of rounding, which a written scene need not carry; 0 has no sign.
        (there * 1e10).round() / 1e10 + 0.0
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
            Projection::Perspective => CameraRay {
                origin: self.settings.position,
                direction: (self.forward + offset).normalize(),
            },
            Projection::Orthographic => {
                CameraRay { origin: self.settings.position + offset, direction: self.forward }
            }
        }
    }

    /// Where a point is seen, in homogeneous coordinates [x, y, w]: at x/w, y/w in pixels as in
    /// [`Camera::ray`] if w > 0; behind the camera, w <= 0.
    #[must_use]
    pub fn seen(&self, point: DVec3) -> [f64; 3] {
        let from = point - self.settings.position;
        let ahead = from.dot(self.forward);
        let w = match self.settings.projection {
            Projection::Perspective => ahead,
            Projection::Orthographic => {
                if ahead > 0.0 {
                    1.0
                } else {
                    0.0
                }
            }
        };
        let [across, upward] = [self.right, self.up].map(|axis| from.dot(axis) / self.pixel);
        [self.middle[0] * w + across, self.middle[1] * w - upward, w]
    }

    /// The horizontal and the vertical electric field of a ray, unit vectors across it: those of
    /// [`transverse_basis`] with the camera's right-hand axis. For a ray along that axis the
    /// horizontal one is the line of sight, as it is x for a ray along z in the paper's scene.
    pub fn polarization_basis(&self, direction: DVec3) -> (DVec3, DVec3) {
        transverse_basis(direction.normalize(), self.right, self.forward)
    }

    /// The smallest width, in cm, of a photograph that covers the whole view; `None` if a corner
    /// ray misses its plane.
    ///
    /// The photograph is centred on the origin of `place`, whose y is up and whose z is across;
    /// `image_aspect` is its width over its height.
    pub fn covering_width(&self, place: &Pose, image_aspect: f64) -> Option<f64> {
        let [width, height] = self.settings.resolution.map(f64::from);
        let mut half = 0.0_f64;
        // Where the corners hit, all the view does: what a camera sees of a plane is convex.
        for (px, py) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)] {
            let ray = self.ray(px, py);
            let (origin, direction) =
                (place.to_local(ray.origin), place.vector_to_local(ray.direction));
            let distance = -origin.x / direction.x;
            if !(distance > 0.0 && distance.is_finite()) {
                return None;
            }
            let hit = origin + distance * direction;
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
