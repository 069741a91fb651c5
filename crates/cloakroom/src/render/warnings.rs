//! What a scene is warned of before it is rendered.

use super::PreparedScene;
use super::detection::Detection;
use crate::assembly::Placed;
use crate::device::REACH;
use crate::scene::{Border, Projection};
use crate::trace::Tracer;
use glam::{BVec3, DVec3};

/// The rays across and down that are looked at.
const RAYS: [u32; 2] = [48, 36];

/// As far as endless devices are looked at, cm.
const FAR: f64 = 1e9;

/// Where the light of a picture comes from, as shares of all of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Origins {
    /// From the photograph, or what its border shows.
    pub photograph: f64,
    /// Through the photograph's plane past its edge, where nothing is.
    pub past_edge: f64,
}

/// Where the light of the picture comes from, of rays spread over the whole of it.
#[must_use]
pub fn origins(prepared: &PreparedScene<'_>) -> Origins {
    let (camera, screen) = (&prepared.scene.camera, &prepared.screen);
    let detection = Detection::UNPOLARIZED;
    let mut tracer = Tracer::new(&prepared.assembly, prepared.limits).with_screen(*screen);
    // The first and the last pixel of each side are among them.
    let places = [0, 1].map(|side| {
        let (count, pixels) = (RAYS[side], f64::from(camera.resolution[side]));
        let place = move |i: u32| 0.5 + (pixels - 1.0) * f64::from(i) / f64::from(count - 1);
        (0..count).map(place)
    });
    let [columns, rows] = places;
    let mut origins = Origins::default();
    for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
        let (leaves, _) = tracer.trace(&detection.launch(camera, &camera.ray(x, y)));
        for leaf in leaves.iter().filter(|leaf| leaf.body().is_none()) {
            let share = detection.detected(&leaf.power) / f64::from(RAYS[0]) / f64::from(RAYS[1]);
            if leaf.distance_to(screen).is_some() {
                origins.photograph += share;
            } else if screen.plane_distance(leaf.position, leaf.direction, 0.0).is_some()
                && prepared.scene.photograph.border == Border::None
            {
                origins.past_edge += share;
            }
        }
    }
    origins
}

/// How many pixels a device takes of the picture, across and down, as far as it is known: those of a
/// box around it.
///
/// `None` if all of the box lies behind the camera or beyond one side of the picture; infinite where
/// part of it lies behind the camera.
#[must_use]
pub fn pixels_across(prepared: &PreparedScene<'_>, device: usize) -> Option<[f64; 2]> {
    let camera = &prepared.scene.camera;
    let [low, high] = prepared.assembly.devices()[device].bounds()?;
    let [low, high] = [low, high].map(|end| end.clamp(DVec3::splat(-FAR), DVec3::splat(FAR)));
    let corner = |i: u32| DVec3::select(BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), low, high);
    let seen: Vec<[f64; 3]> = (0..8).map(|i| camera.seen(corner(i))).collect();
    let beyond = |side: usize| {
        let far = f64::from(camera.resolution[side]);
        seen.iter().all(|at| at[side] < 0.0) || seen.iter().all(|at| at[side] > far * at[2])
    };
    if seen.iter().all(|at| at[2] <= 0.0) || beyond(0) || beyond(1) {
        return None;
    }
    Some([0, 1].map(|side| {
        if seen.iter().any(|at| at[2] <= 0.0) {
            return f64::INFINITY;
        }
        let places = seen.iter().map(|at| at[side] / at[2]);
        places.clone().fold(f64::MIN, f64::max) - places.fold(f64::MAX, f64::min)
    }))
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
