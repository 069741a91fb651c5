//! Numbers for what a page shows: power, times of flight, and likeness to what should be seen.

use crate::end::{self, End, Problem, Recipe, Subject, Wanted};
use crate::protocol::Look;
use cloakroom::measure::{FlightFigures, PixelMask, View, bare, structural_similarity};
use cloakroom::output::Picture;
use cloakroom::render::Supervision;
use cloakroom::scene::{Camera, CameraSettings, Scene};
use serde_json::{Value, json};
use std::sync::atomic::AtomicBool;

/// Width of the pictures that numbers are taken from, pixels.
const WIDTH: u32 = 160;

/// The numbers of a scene, from small pictures of one sample a pixel: of the scene, of the empty
/// view, of what should be seen, and of the bare metal.
///
/// Means of power and time are over the silhouette, the pixels that meet a device.
pub(crate) async fn figures(
    end: &impl End,
    look: &Look,
    scene: &Scene,
    stop: &AtomicBool,
) -> Result<Value, Problem> {
    let supervision = Supervision { rows_done: &|_| {}, stop };
    let subject = |view| {
        let recipe = Recipe { view, ..Recipe::plain(small(scene)) };
        Subject { look, scene, recipe }
    };
    let picture = async |view| {
        let picture = end.picture(&subject(view), Wanted::Everything, &supervision).await;
        picture.map_err(|problem| match problem {
            // Its errors are about no key of the scene that is shown.
            Problem::Scene { message, .. } => Problem::of(message),
            Problem::Stopped => problem,
        })
    };
    let of = |picture: &Picture| View::of(picture).map_err(Problem::of);
    let shown = picture(end::View::Scene).await?;
    let nothing = of(&picture(end::View::Empty).await?)?;
    let wanted = of(&picture(end::View::Mirror).await?)?;
    let view = of(&shown)?;
    let (bare, bare_in_place) = match bare(scene) {
        Some(_) => {
            let bare = of(&picture(end::View::Bare).await?)?;
            (Some(bare), end.survey(&subject(end::View::Bare), &supervision).await?.in_place_share)
        }
        None => (None, None),
    };
    let rays = end.survey(&subject(end::View::Scene), &supervision).await?;
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
        "in_place_share": rays.in_place_share,
        "bare_in_place_share": bare_in_place,
        "to_ideal": likeness(&view, &wanted),
        "to_empty": likeness(&view, &nothing),
        "bare_to_empty": bare.map(|bare| likeness(&bare, &nothing)),
    }))
}

/// Width and height of a scene's picture in few pixels.
fn small(scene: &Scene) -> [u32; 2] {
    let [width, height] = scene.camera.resolution;
    let share = f64::from(WIDTH) / f64::from(width.max(WIDTH));
    [width, height].map(|side| ((f64::from(side) * share).round() as u32).max(1))
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
