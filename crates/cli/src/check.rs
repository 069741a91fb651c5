//! `cloakroom check`: is the scene sound, what does it hold, how long will it take.

use crate::arguments::SceneArguments;
use crate::devices::{fact_lines, media_line};
use crate::report::{self, Result};
use crate::scene;
use cloakroom::assembly::Placed;
use cloakroom::render::{Estimate, Images, PreparedScene, estimate};
use cloakroom::scene::Scene;
use cloakroom::threads;
use std::fmt::Write;

/// Bodies of fewer wavelengths than this are films.
const THIN: f64 = 10.0;

const CM_PER_NM: f64 = 1e-7;

/// Validates a scene and prints facts about it.
pub fn run(arguments: &SceneArguments) -> Result<()> {
    let loaded = scene::load(arguments, &[])?;
    let prepared = scene::prepared(&loaded, &mut Images::default())?;
    report::print(&described(&prepared, &loaded.scene)?)
}

fn described(prepared: &PreparedScene<'_>, scene: &Scene) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let camera = &scene.camera;
    let [width, height] = camera.resolution;
    let [photo_width, photo_height] = prepared.screen.size();
    writeln!(text, "The scene is sound.")?;
    writeln!(
        text,
        "picture      {width} x {height} pixels, {} samples each, polarizer {}",
        camera.samples, camera.polarizer
    )?;
    writeln!(
        text,
        "photograph   {}, {photo_width:.2} x {photo_height:.2} cm at {}",
        scene.photograph.image,
        scene.photograph.place()
    )?;
    for (index, device) in scene.devices.iter().enumerate() {
        let show = device.placement.show.word();
        let name = scene.device_name(index).to_string();
        writeln!(text, "{name:<12} {}, shown as {show}, {}", device.kind(), device.turn())?;
        let structure = &prepared.assembly.devices()[index].structure;
        for line in media_line(structure).into_iter().chain(fact_lines(device.facts())) {
            writeln!(text, "             {line}")?;
        }
    }
    for (index, thickness) in prepared.assembly.devices().iter().map(Placed::thickness).enumerate()
    {
        let waves =
            thickness.map(|thickness| thickness / (scene.light.wavelength_nm() * CM_PER_NM));
        if let Some(waves) = waves.filter(|waves| *waves < THIN) {
            writeln!(
                text,
                "warning      {} is {waves:.2} wavelengths thick, under {THIN}: rays in it know no waves that \
                 decay; make it a `coating` of the surface that it lies on",
                scene.device_name(index)
            )?;
        }
    }
    let Estimate { seconds, walks } = estimate(prepared);
    let samples = f64::from(width) * f64::from(height) * f64::from(camera.samples);
    writeln!(
        text,
        "estimate     {seconds:.1} s to render on {} threads; {:.2} million of {:.2} million rays traced, \
         the others seen past every device or interpolated",
        threads::count(),
        1e-6 * walks,
        1e-6 * samples,
    )?;
    Ok(text)
}
