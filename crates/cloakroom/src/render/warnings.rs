//! What a scene is warned of before it is rendered.

use super::PreparedScene;
use super::detection::Detection;
use crate::assembly::Placed;
use crate::device::REACH;
use crate::scene::{Border, Projection};
use crate::trace::Tracer;
use glam::DVec3;

/// The rays across and down that are looked at.
const RAYS: [u32; 2] = [48, 36];

/// The share of the light that goes past the edge of the photograph, through its plane: of rays
/// spread over the whole picture.
#[must_use]
pub fn share_past_edge(prepared: &PreparedScene<'_>) -> f64 {
    let (camera, screen) = (&prepared.scene.camera, &prepared.screen);
    if prepared.scene.photograph.border != Border::None {
        return 0.0;
    }
    let detection = Detection::UNPOLARIZED;
    let mut tracer = Tracer::new(&prepared.assembly, prepared.limits).with_screen(*screen);
    // The first and the last pixel of each side are among them.
    let places = [0, 1].map(|side| {
        let (count, pixels) = (RAYS[side], f64::from(camera.resolution[side]));
        let place = move |i: u32| 0.5 + (pixels - 1.0) * f64::from(i) / f64::from(count - 1);
        (0..count).map(place)
    });
    let [columns, rows] = places;
    let mut past = 0.0;
    for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
        let (leaves, _) = tracer.trace(&detection.launch(camera, &camera.ray(x, y)));
        let passes = leaves.iter().filter(|leaf| {
            leaf.body().is_none()
                && leaf.distance_to(screen).is_none()
                && screen.plane_distance(leaf.position, leaf.direction, 0.0).is_some()
        });
        past += passes.map(|leaf| detection.detected(&leaf.power)).sum::<f64>();
    }
    past / f64::from(RAYS[0] * RAYS[1])
}

/// The devices, by their numbers, that the photograph hides from the camera: their middles lie behind
/// it.
#[must_use]
pub fn behind_photograph(prepared: &PreparedScene<'_>) -> Vec<usize> {
    let camera = &prepared.scene.camera;
    let is_hidden = |placed: &Placed| {
        let Some(middle) = middle(placed) else { return false };
        let forward = camera.forward();
        let eye = match camera.projection {
            Projection::Perspective => camera.position,
            Projection::Orthographic => middle - forward * (middle - camera.position).dot(forward),
        };
        let way = middle - eye;
        let hit = prepared.screen.hit(eye, way.normalize_or_zero(), 0.0);
        way.dot(forward) > 0.0 && hit.is_some_and(|distance| distance < way.length())
    };
    let devices = prepared.assembly.devices().iter().enumerate();
    devices.filter(|(_, placed)| is_hidden(placed)).map(|(number, _)| number).collect()
}

/// The middle of a device, at its origin where it is endless.
fn middle(placed: &Placed) -> Option<DVec3> {
    let [low, high] = placed.bounds()?;
    let ends = (low.cmple(DVec3::splat(-0.5 * REACH))) | (high.cmpge(DVec3::splat(0.5 * REACH)));
    Some(DVec3::select(ends, placed.pose.origin, (low + high) / 2.0))
}
