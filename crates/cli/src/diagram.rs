//! `cloakroom diagram`: ray diagrams and settings.

use crate::arguments::DiagramArguments;
use crate::report::Failure;
use crate::{interruption, scene};
use cloakroom::output;
use cloakroom::scene_file::Loaded;
use cloakroom_figures::{
    Diagram, DiagramError, DiagramSettings, DrawingFormat, Projected, Setting, Source,
};
use std::sync::atomic::AtomicBool;

/// Draws a scene and writes every file asked for.
pub fn run(arguments: &DiagramArguments, stop: &AtomicBool) -> Result<(), Failure> {
    let formats: Vec<DrawingFormat> = (arguments.outputs.iter())
        .map(|path| DrawingFormat::of(path))
        .collect::<Result<_, _>>()
        .map_err(Failure::from_error)?;
    for path in &arguments.outputs {
        output::check_writable(path).map_err(Failure::from_error)?;
    }
    let loaded = scene::load(&arguments.scene)?;
    let _busy = interruption::busy();
    let (drawing, metadata, title) = if arguments.setting {
        let [width, height] = arguments.size;
        let mut scene = loaded.scene.clone();
        let mut settings = scene.camera.settings().clone();
        // The sheet has the aspect of the picture.
        settings.resolution = [width, height];
        scene.camera = cloakroom::scene::Camera::new(settings).map_err(Failure::from_error)?;
        let Setting { drawing, metadata, .. } =
            cloakroom_figures::setting(&scene).map_err(|e| scene::located(&loaded, &e))?;
        (drawing, metadata, "Setting")
    } else {
        let Diagram { drawing, metadata } =
            cloakroom_figures::diagram(&loaded.scene, &settings(arguments), stop)
                .map_err(|error| failure(&loaded, error))?;
        (drawing, metadata, "Ray diagram")
    };
    for (path, format) in arguments.outputs.iter().zip(formats) {
        drawing
            .write(format, title, &metadata, arguments.size, path)
            .map_err(Failure::from_error)?;
    }
    Ok(())
}

fn settings(arguments: &DiagramArguments) -> DiagramSettings {
    let source = match (arguments.point, arguments.camera) {
        (Some(point), _) => Source::Point(point.into()),
        (None, true) => Source::Camera,
        (None, false) => Source::Parallel { degrees: arguments.parallel.unwrap_or(0.0) },
    };
    DiagramSettings {
        source,
        rays: arguments.rays,
        layers: arguments.layers,
        z: arguments.z,
        width: arguments.width,
        polarization: match arguments.polarization.as_str() {
            "horizontal" => [1.0, 0.0],
            "vertical" => [0.0, 1.0],
            _ => [0.5, 0.5],
        },
        wavefronts: arguments.wavefronts,
        min_power: arguments.min_power,
        projected: arguments.space.map_or(Projected::Section, |[azimuth, elevation]| {
            Projected::Space { azimuth, elevation }
        }),
        size: arguments.size,
    }
}

fn failure(loaded: &Loaded, error: DiagramError) -> Failure {
    match error {
        DiagramError::Scene(error) => scene::located(loaded, &error),
        DiagramError::Stopped => Failure::Interrupted,
        other => Failure::from_error(other),
    }
}
