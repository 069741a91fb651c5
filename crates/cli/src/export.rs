//! `cloakroom export`: what a device is made of.

use crate::arguments::ExportArguments;
use crate::report::Failure;
use crate::{interruption, progress, scene};
use cloakroom::assembly::Assembly;
use cloakroom::material::{self, Frame, MaterialError, Resolution};
use cloakroom::output::{self, GridFormat};
use cloakroom::render::{self, Supervision};
use cloakroom::scene_file::Loaded;
use std::sync::atomic::AtomicBool;

/// Writes the material of a device.
pub fn run(arguments: &ExportArguments, stop: &AtomicBool) -> Result<(), Failure> {
    scene::use_threads(&arguments.threads)?;
    let loaded = scene::load(&arguments.scene)?;
    let assembly = render::assembly(&loaded.scene).map_err(|e| scene::located(&loaded, &e))?;
    if arguments.table {
        table(arguments, &loaded, &assembly)
    } else {
        grid(arguments, &loaded, &assembly, stop)
    }
}

fn grid(
    arguments: &ExportArguments,
    loaded: &Loaded,
    assembly: &Assembly,
    stop: &AtomicBool,
) -> Result<(), Failure> {
    GridFormat::of(&arguments.output).map_err(Failure::from_error)?;
    output::check_writable(&arguments.output).map_err(Failure::from_error)?;
    let frame = if arguments.frame == "world" { Frame::World } else { Frame::Device };
    let resolution = arguments.grid.unwrap_or(Resolution::Default);
    let _busy = interruption::busy();
    let bar = progress::bar(0, "sampling");
    let supervision = Supervision { rows_done: &|rows| bar.inc(rows), stop };
    let begun = |rows| bar.set_length(rows);
    let sampled = material::sample(
        &loaded.scene,
        assembly,
        arguments.device,
        frame,
        resolution,
        &begun,
        &supervision,
    );
    bar.finish_and_clear();
    let sampled = sampled.map_err(failure)?;
    output::write_grid(&sampled, &arguments.output).map_err(Failure::from_error)
}

fn table(arguments: &ExportArguments, loaded: &Loaded, assembly: &Assembly) -> Result<(), Failure> {
    let segments =
        material::segments(&loaded.scene, assembly, arguments.device).map_err(failure)?;
    material::write_segments(&segments, &arguments.output).map_err(Failure::from_error)
}

fn failure(error: MaterialError) -> Failure {
    match error {
        MaterialError::Stopped => Failure::Interrupted,
        other => Failure::from_error(other),
    }
}
