//! The plane that light is received on.

use super::{Receiver, direction};
use crate::keys::KeyError;
use cloakroom_trace::key;
use glam::{DVec2, DVec3};

impl Receiver {
    /// Gives its normal the length 1.
    ///
    /// # Errors
    ///
    /// If the normal is zero.
    pub fn normalize(&mut self) -> Result<(), KeyError> {
        self.normal = direction(key!(Self.normal), self.normal)?;
        Ok(())
    }

    /// The unit vectors along its width and its length; the second one is z if the rectangle is
    /// along z.
    #[must_use]
    pub fn axes(&self) -> [DVec3; 2] {
        let along = (DVec3::Z - self.normal * self.normal.z).try_normalize().unwrap_or(DVec3::Y);
        [along.cross(self.normal), along]
    }

    /// Where a ray from its front meets its plane: how far along width and length from the middle,
    /// cm.
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
