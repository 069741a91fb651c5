//! Balls and round cylinders, whole, against what is known of them from elsewhere.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod cloaks;
mod lenses;
mod places;
mod uniaxial_cylinder;

use cloakroom::render::StudioError;
use cloakroom::scene_file;
use cloakroom::trace::{Bench, Launch, Leaf, Limits, Rarities, Tracer};
use glam::DVec3;
use optics::wave::transverse_basis;
use std::path::Path;

const LIMITS: Limits = Limits { min_power: 1e-9, tolerance: 1e-9 };

fn try_bench(device: &str) -> Result<Bench, StudioError> {
    let text = format!("[[device]]\nkind = {device}\n");
    let loaded = scene_file::parse(&text, "test", Path::new(""), &[]).unwrap();
    cloakroom::render::bench(&loaded.scene)
}

fn bench(device: &str) -> Bench {
    try_bench(device).unwrap()
}

/// Horizontal and vertical polarization.
fn launch(origin: DVec3, direction: DVec3) -> Launch<2> {
    let direction = direction.normalize();
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

/// The leaves of a ray of which nothing was lost.
fn leaves(bench: &Bench, launch: &Launch<2>) -> Vec<Leaf<2>> {
    let mut tracer = Tracer::new(bench, LIMITS);
    let (leaves, outcome) = tracer.trace(launch);
    assert_eq!(outcome.rarities, Rarities::default(), "{launch:?}");
    leaves.to_vec()
}

/// The one leaf of a ray that is not divided.
fn leaf(bench: &Bench, launch: &Launch<2>) -> Leaf<2> {
    let leaves = leaves(bench, launch);
    assert_eq!(leaves.len(), 1, "{launch:?} {leaves:?}");
    for power in leaves[0].power {
        assert!((power - 1.0).abs() < 1e-12, "{launch:?} {power}");
    }
    leaves[0]
}

/// Pseudo-random numbers in [0, 1), the same at each run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A direction, evenly on the sphere.
    fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let angle = self.between(0.0, std::f64::consts::TAU);
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z)
    }

    /// A ray from 50 cm away that passes the origin at a distance of up to 10 cm, and that distance.
    fn launch(&mut self) -> (Launch<2>, f64) {
        let direction = self.direction();
        let across = direction.cross(self.direction()).normalize();
        let impact = 10.0 * self.next().sqrt();
        (launch(across * impact - direction * 50.0, direction), impact)
    }
}
