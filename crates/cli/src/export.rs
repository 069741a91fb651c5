//! `cloakroom export`: what a device is made of, or what devices look like as meshes.

use crate::arguments::ExportArguments;
use crate::files::check_writable;
use crate::progress::supervised;
use crate::report::{Failure, Result};
use crate::{interruption, scene};
use cloakroom::keys::{hint, quoted};
use cloakroom::material::{self, Frame, Resolution};
use cloakroom::outline_mesh::{MeshFormat, outlines, write_mesh};
use cloakroom::output;
use cloakroom::scene::Scene;

/// Writes the material of a device.
pub fn run(arguments: &ExportArguments) -> Result<()> {
    scene::use_threads(&arguments.threads)?;
    let loaded = scene::load(&arguments.scene, &[])?;
    let assembly = scene::assembly(&loaded)?;
    let (scene, path) = (&loaded.scene, &arguments.output);
    let device = arguments.device.as_deref().map(|word| numbered(scene, word)).transpose()?;
    let inputs = scene::inputs(&arguments.scene, &loaded);
    if arguments.table {
        check_writable([path], &inputs)?;
        let segments = material::segments(scene, &assembly, device)?;
        return Ok(material::write_segments(&segments, path)?);
    }
    let meshes = MeshFormat::ENDINGS.map(|(ending, _)| (ending, true));
    let grids = ["npz", "vti", "csv"].map(|ending| (ending, false));
    if output::format_of(path, &[&grids[..], &meshes].concat())? {
        let message = "--grid: a mesh has no cells; .npz, .vti and .csv have";
        if arguments.grid.is_some() {
            return Err(Failure::Failed(message.to_owned()));
        }
        check_writable([path], &inputs)?;
        return Ok(write_mesh(&outlines(scene, &assembly, device)?, path)?);
    }
    check_writable([path], &inputs)?;
    let frame = if arguments.frame == "world" { Frame::World } else { Frame::Device };
    let resolution = arguments.grid.unwrap_or(Resolution::Default);
    let _busy = interruption::busy();
    let sampled = supervised(0, "sampling", |bar, supervision| {
        let begun = |rows| bar.set_length(rows);
        material::sample(scene, &assembly, device, frame, resolution, &begun, supervision)
    })?;
    Ok(output::write_grid(&sampled, path)?)
}

/// The number of the device of a number or a name.
fn numbered(scene: &Scene, word: &str) -> Result<usize> {
    let name = |number: usize| scene.devices[number].placement.name.as_deref();
    let named = (0..scene.devices.len()).find(|number| name(*number) == Some(word));
    named.or_else(|| word.parse().ok()).ok_or_else(|| {
        let names: Vec<&str> = (0..scene.devices.len()).filter_map(name).collect();
        Failure::Failed(format!(
            "--device: no device of the scene is called {}, and devices are counted from 0{}",
            quoted(word, '`'),
            hint(word, &names, "there are")
        ))
    })
}
