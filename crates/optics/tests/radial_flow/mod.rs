//! Closed forms of radially symmetric media against slow integrations with their tensors.

mod hamiltonian;
mod lenses;
mod shells;
mod within;

use glam::DVec3;

/// Pseudo-random numbers in [0, 1), the same at each run.
pub struct Numbers(pub u64);

impl Numbers {
    /// One of them.
    pub fn number(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// One from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.number()
    }

    /// A direction, evenly on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let angle = self.between(0.0, std::f64::consts::TAU);
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z)
    }
}
