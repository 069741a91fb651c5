//! A flat end of a body that extends along z.

use super::Outline;
use glam::DVec3;

/// The flat end of a prism: an outline in a plane of constant z.
#[derive(Clone, Debug, PartialEq)]
pub struct Cap {
    /// The shape of the end.
    pub outline: Outline,
    /// Where it lies, cm.
    pub z: f64,
    /// Outward unit normal, z or -z.
    pub normal: DVec3,
}

impl Cap {
    /// The two ends of a prism.
    #[must_use]
    pub fn both(outline: &Outline, ends: [f64; 2]) -> [Self; 2] {
        [(ends[0], -DVec3::Z), (ends[1], DVec3::Z)].map(|(z, normal)| Self {
            outline: outline.clone(),
            z,
            normal,
        })
    }

    /// The distance at which a ray that comes from outside meets the cap, from zero on.
    #[must_use]
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        if direction.dot(self.normal) >= 0.0 {
            return None;
        }
        let t = (self.z - origin.z) / direction.z;
        (t >= 0.0 && self.outline.contains((origin + direction * t).truncate())).then_some(t)
    }
}
