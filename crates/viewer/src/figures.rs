//! Numbers for what a page shows: power, times of flight, and likeness to what should be seen.

use cloakroom::measure::{
    FlightFigures, PixelMask, View, bare, empty, ideal, structural_similarity, survey,
};
use cloakroom::output::Picture;
use cloakroom::render::{ChannelSet, Images, PreparedScene, Supervision, render};
use cloakroom::scene::{Camera, CameraSettings, Scene};
use serde_json::{Value, json};
use std::error::Error;
use std::sync::atomic::AtomicBool;

/// Width of the pictures that numbers are taken from, pixels.
const WIDTH: u32 = 160;

/// The numbers of a scene, from small pictures of one sample a pixel: of the scene, of the empty
/// view, of what should be seen, and of the bare metal.
///
/// Means of power and time are over the silhouette, the pixels that meet a device.
pub(crate) fn figures(
    scene: &Scene,
    images: &mut Images,
    stop: &AtomicBool,
) -> Result<Value, Box<dyn Error + Send + Sync>> {
    let supervision = Supervision { rows_done: &|_| {}, stop };
    let scene = small(scene);
    let mut picture = |scene: &Scene| -> Result<Picture, Box<dyn Error + Send + Sync>> {
        let prepared = prepared(scene, images)?;
        Ok(render(&prepared, ChannelSet::Everything, &supervision)?.picture)
    };
    let wanted_scene = ideal(&scene);
    let shown = picture(&scene)?;
    let nothing = View::of(&picture(&empty(&scene))?)?;
    let wanted = View::of(&picture(&wanted_scene)?)?;
    let bare = bare(&scene).map(|bare| picture(&bare)).transpose()?;
    let bare = bare.as_ref().map(View::of).transpose()?;
    let view = View::of(&shown)?;
    let (prepared, ideal) = (prepared(&scene, images)?, prepared(&wanted_scene, images)?);
    let rays = survey(&prepared, &ideal, &supervision)?;
    let silhouette = PixelMask::new(view.width, rays.silhouette.clone()).ok();
    let everything = PixelMask::whole(&view);
    let likeness = |of: &View, to: &View| {
        let region = silhouette.as_ref().unwrap_or(&everything);
        json!({ "structural_similarity": structural_similarity(to, of, region) })
    };
    let mean = |name: &str| {
        let (region, samples) = (silhouette.as_ref()?, &shown.channel(name)?.samples);
        Some(region.mean(|i| samples.get(i)))
    };
    let flight = silhouette.as_ref().and_then(|region| FlightFigures::delays(&view, region));
    Ok(json!({
        "width_pixels": view.width,
        "height_pixels": view.height,
        "silhouette_share": silhouette.as_ref().map_or(0.0, PixelMask::share),
        "delivered": mean("delivered"),
        "escaped": mean("escaped"),
        "absorbed": mean("absorbed"),
        "pruned": mean("pruned"),
        "time_of_flight_difference_maximum_ns": flight.map(|flight| flight.maximum_ns),
        "time_of_flight_difference_mean_ns": flight.map(|flight| flight.mean_ns),
        "displacement_rms_cm": rays.displacement_rms_cm,
        "to_ideal": likeness(&view, &wanted),
        "to_empty": likeness(&view, &nothing),
        "bare_to_empty": bare.map(|bare| likeness(&bare, &nothing)),
    }))
}

/// A scene of those that are compared, built; its errors are about no key of the scene that is
/// shown.
fn prepared<'s>(scene: &'s Scene, images: &mut Images) -> Result<PreparedScene<'s>, String> {
    PreparedScene::with_images(scene, images).map_err(|error| error.to_string())
}

/// The same scene in few pixels.
fn small(scene: &Scene) -> Scene {
    let [width, height] = scene.camera.resolution;
    let share = f64::from(WIDTH) / f64::from(width.max(WIDTH));
    let resolution = [width, height].map(|side| ((f64::from(side) * share).round() as u32).max(1));
    resized(scene, resolution, 1)
}

/// The same scene with another resolution and number of samples.
pub(crate) fn resized(scene: &Scene, resolution: [u32; 2], samples: u32) -> Scene {
    let settings = CameraSettings { resolution, samples, ..CameraSettings::clone(&scene.camera) };
    let mut scene = scene.clone();
    // Both are within the limits of cameras, as the rest has been before.
    if let Ok(camera) = Camera::new(settings) {
        scene.camera = camera;
    }
    scene
}
