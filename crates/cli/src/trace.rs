//! `cloakroom trace`: rays in, leaves out.

use crate::arguments::TraceArguments;
use crate::report::{self, Failure};
use crate::scene;
use cloakroom::render;
use cloakroom::trace::{Limits, RayError, RayRequest, trace_rays};
use std::io::Read;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The threshold where neither the command line nor the scene gives one.
const DEFAULT_MIN_POWER: f64 = 1e-9;

/// Traces the rays of a file through a scene.
pub fn run(arguments: &TraceArguments, stop: &AtomicBool) -> Result<(), Failure> {
    scene::use_threads(arguments.threads)?;
    let loaded = scene::load(&arguments.scene)?;
    let bench = render::bench(&loaded.scene).map_err(|e| scene::located(&loaded, &e))?;
    let settings = &loaded.scene.trace;
    let min_power = match arguments.min_power {
        Some(p) if (0.0..=1.0).contains(&p) => p,
        Some(p) => {
            return Err(Failure::Usage(format!("--min-power is {p}; it must be from 0 to 1")));
        }
        None if settings.min_power_given => settings.min_power,
        None => DEFAULT_MIN_POWER,
    };
    let rays = read_rays(&arguments.rays)?;
    let limits = Limits { min_power, tolerance: settings.tolerance };
    let reports = trace_rays(&bench, limits, &rays, stop).map_err(|error| match error {
        RayError::Stopped => Failure::Interrupted,
        RayError::Ray { .. } => Failure::Failed(format!("{}: {error}", name(&arguments.rays))),
    })?;
    let text = serde_json::to_string(&reports).map_err(Failure::from_error)?;
    report::print(&format!("{text}\n"))
}

fn read_rays(path: &Path) -> Result<Vec<RayRequest>, Failure> {
    let mut text = String::new();
    let read = if path == Path::new("-") {
        std::io::stdin().read_to_string(&mut text)
    } else {
        std::fs::File::open(path).and_then(|mut file| file.read_to_string(&mut text))
    };
    let name = name(path);
    read.map_err(|error| Failure::Failed(format!("cannot read {name}: {error}")))?;
    serde_json::from_str(&text).map_err(|error| {
        Failure::Failed(format!(
            "{name}: {error}; expected an array of \
             {{\"origin\": [x,y,z], \"direction\": [x,y,z], \"polarization\": ...}}"
        ))
    })
}

fn name(path: &Path) -> String {
    if path == Path::new("-") { "standard input".to_owned() } else { path.display().to_string() }
}
