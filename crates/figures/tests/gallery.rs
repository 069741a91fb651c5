//! The scenes of the gallery, as `cloakroom trace` sees them.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom::render::assembly;
use cloakroom::scene_file;
use cloakroom::trace::{Launch, Limits, Tracer};
use cloakroom_figures::gallery::EXHIBITS;
use std::path::Path;

#[test]
fn power_is_accounted_for_in_every_exhibit() {
    const RAYS: [u32; 2] = [16, 12];
    for exhibit in EXHIBITS {
        let scene =
            scene_file::parse(exhibit.scene, exhibit.name, Path::new(""), &[]).unwrap().scene;
        let assembly = assembly(&scene).unwrap();
        let mut tracer = Tracer::new(&assembly, Limits { min_power: 1e-6, tolerance: 1e-6 });
        let camera = &scene.camera;
        let size = camera.resolution.map(f64::from);
        let mut met = 0;
        for k in 0..RAYS[0] * RAYS[1] {
            let pixel = [k % RAYS[0], k / RAYS[0]];
            let at = [0, 1].map(|i| size[i] * (f64::from(pixel[i]) + 0.37) / f64::from(RAYS[i]));
            let ray = camera.ray(at[0], at[1]);
            let (h, v) = camera.polarization_basis(ray.direction);
            let launch = Launch {
                origin: ray.origin,
                direction: ray.direction,
                electric: [h.into(), v.into()],
            };
            let (leaves, outcome) = tracer.trace(&launch);
            outcome.assert_balanced(leaves, 1e-12, &(exhibit.name, launch));
            met += u32::from(leaves.len() != 1 || leaves[0].met_device);
        }
        assert!(met > 5, "{}: {met} rays meet something", exhibit.name);
    }
}
