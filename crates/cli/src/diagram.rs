//! `cloakroom diagram`: ray diagrams and settings.

use crate::arguments::DiagramArguments;
use crate::files::{check_writable, formats};
use crate::interruption::{self, STOP};
use crate::report::Failure;
use crate::scene;
use cloakroom::scene::{Camera, CameraSettings};
use cloakroom_figures::{
    Diagram, DiagramError, DiagramSettings, DrawingFormat, Projected, Setting, Source,
};

/// Draws a scene and writes every file asked for.
pub fn run(arguments: &DiagramArguments) -> Result<(), Failure> {
    let formats = formats(&arguments.outputs, DrawingFormat::of)?;
    check_writable(&arguments.outputs)?;
    let loaded = scene::load(&arguments.scene, &[])?;
    let _busy = interruption::busy();
    let (drawing, metadata, title) = if arguments.setting {
        let mut scene = loaded.scene.clone();
        let mut settings = CameraSettings::clone(&scene.camera);
        // The sheet has the aspect of the picture.
        settings.resolution = arguments.size;
        scene.camera = Camera::new(settings)?;
        let Setting { drawing, metadata, .. } =
            cloakroom_figures::setting(&scene).map_err(|e| scene::located(&loaded, &e))?;
        (drawing, metadata, "Setting")
    } else {
        let Diagram { drawing, metadata } =
            cloakroom_figures::diagram(&loaded.scene, &settings(arguments), &STOP).map_err(
                |error| match error {
                    DiagramError::Scene(error) => scene::located(&loaded, &error),
                    error => error.into(),
                },
            )?;
        (drawing, metadata, "Ray diagram")
    };
    for (path, format) in formats {
        drawing.write(format, title, &metadata, arguments.size, path)?;
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
