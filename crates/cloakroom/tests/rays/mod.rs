//! Benches from scene text and rays to send through them, for all tests.

use cloakroom::assembly::Assembly;
use cloakroom::render::PreparedSceneError;
use cloakroom::scene_file;
use cloakroom::trace::{Launch, Leaf};
use glam::{DMat3, DVec3};
use optics::geometry::Pose;
use optics::wave::transverse_basis;
use std::f64::consts::TAU;
use std::path::Path;

/// The devices of a scene, or why there are none.
pub fn try_bench(scene: &str) -> Result<Assembly, PreparedSceneError> {
    let loaded = scene_file::parse(scene, "test", Path::new(""), &[]).unwrap();
    cloakroom::render::assembly(&loaded.scene)
}

/// The devices of a scene.
pub fn assembly(scene: &str) -> Assembly {
    try_bench(scene).unwrap_or_else(|error| panic!("{scene}\n{error}"))
}

/// What is wrong with a scene, with its place.
pub fn refusal(scene: &str) -> String {
    let loaded = match scene_file::parse(scene, "test", Path::new(""), &[]) {
        Ok(loaded) => loaded,
        Err(error) => return error.to_string(),
    };
    let error = cloakroom::render::assembly(&loaded.scene).unwrap_err();
    loaded.locations.error_at(&error.key(), error.to_string()).to_string()
}

/// The keys of a device's pose that put its origin and its axes to where they are given.
pub fn placed(origin: DVec3, rotation: &DMat3) -> String {
    // The axis is turned along; what is left is a rotation about it.
    let axis = rotation.z_axis;
    let upright = Pose::with_axis(DVec3::ZERO, 0.0, axis).rotation().transpose() * *rotation;
    let turn = upright.x_axis.y.atan2(upright.x_axis.x).to_degrees();
    let (origin, axis) = (origin.to_array(), axis.to_array());
    format!("position = {origin:?}\nrotation = {turn:?}\naxis = {axis:?}\n")
}

/// A ray of horizontal and vertical polarization.
pub fn launch(origin: DVec3, direction: DVec3) -> Launch<2> {
    let direction = direction.normalize();
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

/// A pseudo-random number in [0, 1) for every n and k, evenly spread over up to 5 k: an additive
/// recurrence with the powers of a root of x^6 = x + 1.
pub fn spread(n: u32, k: i32) -> f64 {
    (f64::from(n) * 1.134_724_138_401_519_4_f64.powi(-k - 1)).fract()
}

/// Rays that start all around the z axis, `radius` (cm) away and within `height` along z, towards a
/// box of a given size about the origin.
pub fn launches_around(
    count: u32,
    [radius, height]: [f64; 2],
    size: DVec3,
) -> impl Iterator<Item = Launch<2>> {
    (1..=count).map(move |n| {
        let angle = TAU * spread(n, 0);
        let z = height * (spread(n, 1) - 0.5);
        let origin = DVec3::new(radius * angle.cos(), radius * angle.sin(), z);
        let target = DVec3::new(spread(n, 2), spread(n, 3), spread(n, 4)) - DVec3::splat(0.5);
        launch(origin, target * size - origin)
    })
}

/// The leaf of the largest power, both polarizations together.
pub fn strongest(leaves: &[Leaf<2>]) -> Leaf<2> {
    let power = |leaf: &Leaf<2>| leaf.power[0] + leaf.power[1];
    *leaves.iter().max_by(|a, b| power(a).total_cmp(&power(b))).unwrap()
}

/// Pseudo-random numbers in [0, 1), the same at each run.
pub struct Numbers(pub u64);

impl Numbers {
    /// The next one.
    pub fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// The next one, in another interval.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A pose about any axis, its origin within 30 cm of the world's.
    pub fn pose(&mut self) -> Pose {
        let origin = self.direction() * self.between(0.0, 30.0);
        Pose::with_axis(origin, self.between(0.0, TAU), self.direction())
    }

    /// A direction, evenly on the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let z = self.between(-1.0, 1.0);
        let angle = self.between(0.0, TAU);
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z)
    }
}
