//! `cloakroom trace`: rays in, leaves out; `cloakroom interface`: two media in, modes and powers
//! out.

use crate::arguments::TraceArguments;
use crate::interruption::{self, STOP};
use crate::report::{self, Failure, Result};
use crate::scene;
use cloakroom::input::{read_up_to, reason};
use cloakroom::interface_json::solve_interfaces;
use cloakroom::ray_json::{RayError, read_rays, trace_rays};
use cloakroom::render;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::Path;

/// Longer texts are refused before they fill the memory, in bytes.
const LONGEST: u64 = 1 << 30;

/// Traces the rays of a file through a scene.
pub fn run(arguments: &TraceArguments) -> Result<()> {
    if [&arguments.scene.scene, &arguments.rays].iter().all(|path| path.as_path() == Path::new("-"))
    {
        return Err(Failure::Usage(
            "the scene and --rays cannot both be standard input; give one of them as a file"
                .to_owned(),
        ));
    }
    scene::use_threads(&arguments.threads)?;
    let loaded = scene::load(&arguments.scene, &[])?;
    scene::check_pipes(&arguments.scene, &loaded, Some(&arguments.rays))?;
    let assembly = scene::assembly(&loaded)?;
    if let Some(p) = arguments.min_power.filter(|p| !(0.0..=1.0).contains(p)) {
        return Err(Failure::Usage(format!("--min-power is {p}; it must be from 0 to 1")));
    }
    let TraceArguments { min_power, coherent, group_delay, .. } = *arguments;
    let settings = render::ray_settings(&loaded.scene, min_power, coherent, group_delay);
    let (text, name) = read(&arguments.rays)?;
    let rays = read_rays(&text).map_err(|error| {
        Failure::Failed(format!(
            "{name}: {error}; expected an array of \
             {{\"origin\": [x,y,z], \"direction\": [x,y,z], \"polarization\": P}}, P being \
             \"horizontal\", \"vertical\" or {{\"electric_field\": [[re,im],[re,im],[re,im]]}}"
        ))
    })?;
    drop(text);
    let busy = interruption::busy();
    let reports = trace_rays(&assembly, settings, &rays, &STOP).map_err(|error| match error {
        RayError::Stopped(_) => Failure::Interrupted,
        error => Failure::Failed(format!("{name}: {error}")),
    })?;
    drop(busy);
    report::print_with(|out| {
        serde_json::to_writer(&mut *out, &reports)?;
        out.write_all(b"\n")
    })
}

/// Solves the interfaces of a file.
pub fn interfaces(path: &Path) -> Result<()> {
    let (text, name) = read(path)?;
    let solved =
        solve_interfaces(&text).map_err(|error| Failure::Failed(format!("{name}: {error}")))?;
    report::print_json(&solved)
}

/// The text of a file, or of standard input for `-`, and what to call it in messages.
fn read(path: &Path) -> Result<(String, String)> {
    let mut bytes = Vec::new();
    let (name, read) = if path == Path::new("-") {
        ("standard input".to_owned(), read_up_to(LONGEST, io::stdin(), &mut bytes))
    } else {
        let read = File::open(path).and_then(|file| read_up_to(LONGEST, file, &mut bytes));
        (path.display().to_string(), read)
    };
    let failed = |reason: String| Failure::Failed(format!("cannot read {name}: {reason}"));
    read.map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => failed(format!("{error}; give it in parts")),
        _ => failed(reason(&error)),
    })?;
    let text = String::from_utf8(bytes).map_err(|_| failed("it is not UTF-8 text".to_owned()))?;
    Ok((text, name))
}
