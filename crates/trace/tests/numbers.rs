//! Numbers without a pattern, the same in every run.

use cloakroom_trace::split_mix::mix;
use glam::DVec3;
use optics::geometry::Pose;
use std::f64::consts::PI;

/// Numbers from -1 to 1.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 += 1;
        (mix(self.0.wrapping_mul(0x9e37_79b9_7f4a_7c15)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    pub fn pose(&mut self) -> Pose {
        let origin = 20.0 * self.vector();
        let rotation = PI * self.next();
        Pose::with_axis(origin, rotation, self.vector())
    }
}
