//! `cloakroom diagram`: ray diagrams and settings.

use crate::arguments::DiagramArguments;
use crate::files::{check_outputs, formats, write_each};
use crate::interruption::{self, STOP};
use crate::report::Result;
use crate::scene;
use cloakroom::render::metadata;
use cloakroom::scene::{Camera, CameraSettings};
use cloakroom_figures::{DiagramError, DiagramSettings, DrawingFormat, Source};

/// Draws a scene and writes every file asked for.
pub fn run(arguments: &DiagramArguments) -> Result<()> {
    let formats = formats(&arguments.outputs, DrawingFormat::of)?;
    let loaded = scene::load(&arguments.scene, &[])?;
    check_outputs(&arguments.outputs, &scene::inputs(&arguments.scene, &loaded))?;
    let _busy = interruption::busy();
    let (drawing, title) = if arguments.setting {
        let mut scene = loaded.scene.clone();
        let mut settings = CameraSettings::clone(&scene.camera);
        // The sheet has the aspect of the picture.
        settings.resolution = arguments.size;
        scene.camera = Camera::new(settings)?;
        let setting = cloakroom_figures::setting(&scene);
        (setting.map_err(|error| scene::located(&loaded, &error))?.drawing, "Setting")
    } else {
        let diagram = cloakroom_figures::diagram(&loaded.scene, &settings(arguments), &STOP);
        let drawing = diagram.map_err(|error| match error {
            DiagramError::Scene(error) => scene::located(&loaded, &error),
            error => error.into(),
        })?;
        (drawing, "Ray diagram")
    };
    let metadata = metadata(&loaded.scene);
    write_each(formats, |path, format| {
        Ok(drawing.write(format, title, &metadata, arguments.size, path)?)
    })
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
        window: arguments.window.map(|[x0, y0, x1, y1]| [[x0, y0].into(), [x1, y1].into()]),
        polarization: match arguments.polarization.as_str() {
            "horizontal" => [1.0, 0.0],
            "vertical" => [0.0, 1.0],
            _ => [0.5, 0.5],
        },
        wavefronts: arguments.wavefronts,
        min_power: arguments.min_power,
        space: arguments.space,
        size: arguments.size,
    }
}
