//! `cloakroom export`: what a device is made of, or what devices look like as meshes.

use crate::arguments::ExportArguments;
use crate::files::check_writable;
use crate::progress::supervised;
use crate::report::Result;
use crate::{interruption, scene};
use cloakroom::material::{self, Frame, Resolution};
use cloakroom::outline_mesh::{MeshFormat, outlines, write_mesh};
use cloakroom::output;

/// Writes the material of a device.
pub fn run(arguments: &ExportArguments) -> Result<()> {
    scene::use_threads(&arguments.threads)?;
    let loaded = scene::load(&arguments.scene, &[])?;
    let assembly = scene::assembly(&loaded)?;
    let (scene, device, path) = (&loaded.scene, arguments.device, &arguments.output);
    let inputs = scene::inputs(&arguments.scene, &loaded);
    if arguments.table {
        check_writable([path], &inputs)?;
        let segments = material::segments(scene, &assembly, device)?;
        return Ok(material::write_segments(&segments, path)?);
    }
    let meshes = MeshFormat::ENDINGS.map(|(ending, _)| (ending, true));
    let grids = ["npz", "vti", "csv"].map(|ending| (ending, false));
    if output::format_of(path, &[&grids[..], &meshes].concat())? {
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
