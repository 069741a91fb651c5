//! `cloakroom check`: is the scene sound, what does it hold, how long will it take.

use crate::arguments::CheckArguments;
use crate::devices::{fact_lines, media_line};
use crate::report::{self, Result, decimals};
use crate::scene;
use cloakroom::assembly::Placed;
use cloakroom::render::{
    Estimate, Images, Origins, PreparedScene, behind_photograph, estimate, origins, pixels_across,
};
use cloakroom::scene::{Border, DeviceSettings, Projection, Scene, Show, SurroundingsSettings};
use cloakroom::threads;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Bodies of fewer wavelengths than this are films.
const THIN: f64 = 10.0;

const CM_PER_NM: f64 = 1e-7;

/// Devices of fewer pixels each way are dots.
const DOT: f64 = 4.0;

/// Validates a scene and prints facts about it.
pub fn run(arguments: &CheckArguments) -> Result<()> {
    let text = scene::text(&arguments.scene.scene)?;
    let overrides = scene::overrides(&text, &arguments.scene, &arguments.picture)?;
    let loaded = scene::load_with(&arguments.scene, &text, &overrides)?;
    let prepared = scene::prepared(&loaded, &mut Images::default())?;
    report::print(&described(&prepared, &loaded.scene)?)
}

/// A share in words.
fn percent(share: f64) -> String {
    if share < 0.001 { "less than 0.1 %".to_owned() } else { format!("{:.1} %", 100.0 * share) }
}

/// A time for people.
fn duration(seconds: f64) -> String {
    const UNITS: [(f64, &str); 3] = [(86_400.0, "days"), (3600.0, "hours"), (60.0, "minutes")];
    // Of fewer than two of them it is a smaller unit.
    let unit = UNITS.into_iter().find(|(unit, _)| seconds >= 2.0 * unit);
    unit.map_or_else(
        || format!("{seconds:.1} s"),
        |(unit, name)| format!("{:.1} {name}", seconds / unit),
    )
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
    if scene.photograph.border != Border::None {
        writeln!(text, "             beyond its edge: {}", scene.photograph.border.word())?;
    }
    for (index, device) in scene.devices.iter().enumerate() {
        let shown = match device.placement.show {
            Show::Cloak => String::new(),
            show => format!("shown as {}, ", show.word()),
        };
        let name = scene.device_name(index).to_string();
        writeln!(text, "{name:<12} {}, {shown}{}", device.kind(), device.turn())?;
        let structure = &prepared.assembly.devices()[index].structure;
        if device.has_lossless_metal() {
            writeln!(
                text,
                "warning      the metal of {name} does not absorb (k = 0): what it does not reflect is \
                 taken to be lost in it"
            )?;
        }
        let imperfect = device.placement.imperfection.is_some();
        let design = imperfect.then(|| "without its imperfections".to_owned());
        let lines = media_line(structure).into_iter().chain(design);
        for line in lines.chain(fact_lines(device.facts())) {
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
    for number in behind_photograph(prepared) {
        writeln!(
            text,
            "warning      the photograph stands between the camera and device {number}, which it hides; move one of \
             them (photograph.x or photograph.position)"
        )?;
    }
    let shown = &scene.picture;
    if shown.map.name().is_none() && (shown.map_range.is_some() || shown.map_percentile.is_some()) {
        writeln!(
            text,
            "hint         map_range and map_percentile are of a map; picture.map says of which channel, as in \
             picture.map = \"time_of_flight\""
        )?;
    }
    for number in 0..scene.devices.len() {
        let name = scene.device_name(number);
        if scene.devices[number].placement.show == Show::Empty {
            continue;
        }
        match pixels_across(prepared, number) {
            None => writeln!(
                text,
                "hint         {name} is out of the camera's view; camera.target and camera.field_of_view say where \
                 it looks"
            )?,
            Some(across) if across.iter().all(|pixels| *pixels < DOT) => writeln!(
                text,
                "hint         {name} is less than {DOT} pixels large in the picture; lengths are in cm"
            )?,
            Some(_) => {}
        }
    }
    for (key, degrees) in angles(scene) {
        if is_radians(degrees) {
            writeln!(
                text,
                "hint         {key} is {degrees}, which looks like radians; angles are in degrees: {}",
                decimals(degrees.to_degrees(), 0)
            )?;
        }
    }
    let Origins { photograph, past_edge: past } = origins(prepared);
    if photograph == 0.0 {
        writeln!(
            text,
            "warning      of the rays that were tried none comes from the photograph, which is at {}: it is hidden, out \
             of view or small; photograph.x or photograph.position moves it, camera.target turns the camera",
            scene.photograph.place()
        )?;
    }
    if past > 0.0 && scene.surroundings == SurroundingsSettings::default() {
        writeln!(
            text,
            "hint         {} of the light comes from past the photograph's edge, where nothing is; \
             photograph.border = \"mirror\" shows something there, and so does a larger photograph.width",
            percent(past)
        )?;
    }
    if prepared.coherence.is_some() {
        let names: Vec<String> =
            prepared.interfering().map(|number| scene.device_name(number).to_string()).collect();
        let because = match &names[..] {
            [] => "light.bandwidth_nm is written".to_owned(),
            names => format!("of {} (a polarizer, thin, or hardly birefringent)", names.join(", ")),
        };
        writeln!(
            text,
            "light        interferes, because {because}: each ray is followed down to {:e} of its power, and none is \
             interpolated, which takes far longer; trace.min_power says how far",
            prepared.limits.min_power
        )?;
    }
    let Estimate { seconds, walks, samples, .. } = estimate(prepared);
    let (walks, samples) = (1e-6 * walks, 1e-6 * samples as f64);
    let (of, rest) = if walks > samples {
        ("for", "those between which others are interpolated among them")
    } else {
        ("of", "the others seen past every device or interpolated")
    };
    writeln!(
        text,
        "estimate     {} to render on {} threads; {walks:.2} million {of} {samples:.2} million rays traced, {rest}",
        duration(seconds),
        threads::count(),
    )?;
    Ok(text)
}

/// The angles of a scene that people write, degrees, with their keys.
fn angles(scene: &Scene) -> Vec<(String, f64)> {
    let turned = |(number, device): (usize, &DeviceSettings)| {
        (format!("device.{number}.rotation"), device.placement.rotation)
    };
    let mut angles: Vec<_> = scene.devices.iter().enumerate().map(turned).collect();
    if scene.camera.projection == Projection::Perspective {
        angles.push(("camera.field_of_view".to_owned(), scene.camera.field_of_view.value));
    }
    angles
}

/// Whether a number of degrees looks like a multiple of 5 degrees in radians, to the digits that people type.
fn is_radians(degrees: f64) -> bool {
    let steps = degrees.to_degrees() / 5.0;
    let is_step = (steps - steps.round()).abs() * 5f64.to_radians() < 5e-4;
    let is_round = (degrees * 20.0).fract() == 0.0;
    is_step && !is_round && degrees.abs() < TAU
}

#[cfg(test)]
mod tests {
    use super::{duration, is_radians};

    #[test]
    fn radians_are_told_from_degrees() {
        for degrees in [5.0, 10.0, 20.0, -30.0, 45.0, 90.0, 355.0f64] {
            let radians = degrees.to_radians();
            assert!(is_radians(radians) && is_radians((radians * 1e4).round() / 1e4), "{radians}");
        }
        for degrees in [0.0, 0.1, 0.35, 1.0, -1.05, 5.0, 0.03, 22.51, 30.5432] {
            assert!(!is_radians(degrees), "{degrees}");
        }
    }

    #[test]
    fn times_are_in_the_largest_unit_of_which_there_are_two() {
        assert_eq!(
            [0.26, 119.0, 300.0, 9000.0, 1e8].map(duration),
            ["0.3 s", "119.0 s", "5.0 minutes", "2.5 hours", "1157.4 days"]
        );
    }
}
