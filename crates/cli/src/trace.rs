//! `cloakroom trace`: rays in, leaves out; `cloakroom interface`: two media in, modes and powers out.

use crate::arguments::TraceArguments;
use crate::input;
use crate::interruption::{self, STOP};
use crate::report::{self, Failure};
use crate::scene;
use cloakroom::interface_json::solve_interfaces;
use cloakroom::ray_json::{RayError, RayRequest, trace_rays};
use cloakroom::render;
use std::path::Path;

/// Traces the rays of a file through a scene.
pub fn run(arguments: &TraceArguments) -> Result<(), Failure> {
    scene::use_threads(&arguments.threads)?;
    let loaded = scene::load(&arguments.scene, &[])?;
    let assembly = scene::assembly(&loaded)?;
    if let Some(p) = arguments.min_power.filter(|p| !(0.0..=1.0).contains(p)) {
        return Err(Failure::Usage(format!("--min-power is {p}; it must be from 0 to 1")));
    }
    let limits = render::ray_limits(&loaded.scene, arguments.min_power);
    let (text, name) = input::read(&arguments.rays)?;
    let rays = parse_rays(&text, &name)?;
    let busy = interruption::busy();
    let reports = trace_rays(&assembly, limits, &rays, &STOP).map_err(|error| match error {
        RayError::Stopped(_) => Failure::Interrupted,
        error => Failure::Failed(format!("{name}: {error}")),
    })?;
    drop(busy);
    report::print(&format!("{}\n", serde_json::to_string(&reports)?))
}

/// The rays of a JSON text; `name` says where it comes from.
fn parse_rays(text: &str, name: &str) -> Result<Vec<RayRequest>, Failure> {
    serde_json::from_str(text).map_err(|error| {
        Failure::Failed(format!(
            "{name}: {error}; expected an array of \
             {{\"origin\": [x,y,z], \"direction\": [x,y,z], \"polarization\": P}}, P being \
             \"horizontal\", \"vertical\" or {{\"electric_field\": [[re,im],[re,im],[re,im]]}}"
        ))
    })
}

/// Solves the interfaces of a file.
pub fn interfaces(path: &Path) -> Result<(), Failure> {
    let (text, name) = input::read(path)?;
    let solved =
        solve_interfaces(&text).map_err(|error| Failure::Failed(format!("{name}: {error}")))?;
    report::print_json(&solved)
}
