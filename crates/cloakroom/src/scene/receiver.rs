//! The plane that light is received on.

use crate::keys::{KeyError, Values, number_text};
use glam::{DVec2, DVec3};

/// A rectangle on which light is received, from the side that its normal points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Its middle, cm.
    pub position: DVec3,
    /// The unit normal, towards the light.
    pub normal: DVec3,
    /// Its size across z, cm.
    pub width: f64,
    /// Its size along z, cm.
    pub length: f64,
}

impl Receiver {
    /// The settings in a table of [`RECEIVER_KEYS`](super::RECEIVER_KEYS).
    ///
    /// # Errors
    ///
    /// If the normal is zero.
    pub fn from_values(values: &Values) -> Result<Self, KeyError> {
        let normal = DVec3::from_array(values.vector("normal"));
        let largest = normal.abs().max_element();
        let Some(unit) = (normal / largest).try_normalize() else {
            let [x, y, z] = normal.to_array().map(number_text);
            let message = format!("normal is [{x}, {y}, {z}]; it must be a direction");
            return Err(KeyError::at("normal", message));
        };
        Ok(Self {
            position: DVec3::from_array(values.vector("position")),
            normal: unit,
            width: values.number("width"),
            length: values.number("length"),
        })
    }

    /// The unit vectors along its width and its length; the second one is z if the rectangle is along z.
    #[must_use]
    pub fn axes(&self) -> [DVec3; 2] {
        let along = (DVec3::Z - self.normal * self.normal.z).try_normalize().unwrap_or(DVec3::Y);
        [along.cross(self.normal), along]
    }

    /// Where a ray from its front meets its plane: how far along width and length from the middle, cm.
    #[must_use]
    pub fn meet(&self, origin: DVec3, direction: DVec3) -> Option<DVec2> {
        let toward = -direction.dot(self.normal);
        let above = (origin - self.position).dot(self.normal);
        if toward <= 0.0 || above < 0.0 {
            return None;
        }
        let at = origin + direction * (above / toward) - self.position;
        let [across, along] = self.axes();
        Some(DVec2::new(at.dot(across), at.dot(along)))
    }
}

impl Default for Receiver {
    fn default() -> Self {
        Self {
            position: DVec3::new(50.0, 0.0, 0.0),
            normal: DVec3::NEG_X,
            width: 60.0,
            length: 60.0,
        }
    }
}
