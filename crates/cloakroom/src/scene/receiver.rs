//! The plane that light is received on.

use super::RECEIVER_KEYS;
use crate::direction::unit;
use crate::keys::{KeyError, Values, vector_text};
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
    /// The settings in a table of [`RECEIVER_KEYS`].
    ///
    /// # Errors
    ///
    /// If the normal is zero.
    pub fn from_values(values: &Values) -> Result<Self, KeyError> {
        let normal = DVec3::from_array(values.vector("normal"));
        let Some(unit) = unit(normal) else {
            let message = format!("normal is {}; it must be a direction", vector_text(normal));
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
        Self::from_values(&Values::defaults(RECEIVER_KEYS)).expect("its normal is no zero")
    }
}
