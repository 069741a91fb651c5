//! Drawings: settings and ray diagrams.

use crate::errors::{Failure, value_error};
use crate::flights;
use crate::scenes::Scene;
use crate::supervision::supervised;
use cloakroom::render::metadata;
use cloakroom_figures::{
    self as figures, DiagramError, DiagramSettings, DrawingFormat, Pulse, RayDiagram, Source,
};
use pyo3::prelude::*;
use std::path::PathBuf;

/// A drawing with what is written into its files.
#[pyclass(frozen, module = "cloakroom._cloakroom")]
#[derive(Debug)]
pub struct Drawing {
    drawing: figures::Drawing,
    title: &'static str,
    metadata: Vec<(String, String)>,
    /// Width and height of a PNG.
    pixels: [u32; 2],
}

#[pymethods]
impl Drawing {
    /// As SVG.
    #[getter]
    fn svg(&self) -> String {
        self.drawing.to_svg(self.title, &self.metadata)
    }

    /// Writes it as the ending of the file asks for: `.svg`, `.pdf` or `.png`.
    fn save(&self, py: Python<'_>, path: PathBuf) -> Result<(), Failure> {
        let Self { drawing, title, metadata, pixels } = self;
        let format = DrawingFormat::of(&path)?;
        supervised(py, None, |_, _| Ok(drawing.write(format, title, metadata, *pixels, &path)?))
    }
}

/// Draws camera, photograph and devices of a scene to scale.
#[pyfunction]
pub fn setting(py: Python<'_>, scene: &Scene) -> Result<Drawing, Failure> {
    let drawn = supervised(py, None, |_, _| {
        figures::setting(scene.scene(), scene.scene().camera.resolution)
            .map_err(|error| scene.located(&error))
    })?;
    let pixels = scene.scene().camera.resolution;
    Ok(Drawing { drawing: drawn.drawing, title: "Setting", metadata: drawn.metadata, pixels })
}

/// Draws rays through the devices of a scene: parallel ones in a direction (degrees), else those
/// from a point, else those of the camera; `counts` are rays and layers.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "Python gives them by name")]
pub fn diagram(
    py: Python<'_>,
    scene: &Scene,
    parallel: Option<f64>,
    point: Option<[f64; 3]>,
    counts: [u32; 2],
    z: Option<f64>,
    width: Option<f64>,
    window: Option<[f64; 4]>,
    polarization: [f64; 2],
    wavefronts: Option<f64>,
    min_power: f64,
    space: Option<[f64; 2]>,
    size: [u32; 2],
    pulse: Option<f64>,
    delay: &str,
) -> Result<Drawing, Failure> {
    let source = match (parallel, point) {
        (Some(degrees), _) => Source::Parallel { degrees },
        (None, Some(point)) => Source::Point(point.into()),
        (None, None) => Source::Camera,
    };
    let [rays, layers] = counts;
    let settings = DiagramSettings {
        source,
        rays,
        layers,
        z,
        width,
        window: window.map(|[x0, y0, x1, y1]| [[x0, y0].into(), [x1, y1].into()]),
        polarization,
        wavefronts,
        min_power,
        space,
        size,
    };
    if size.contains(&0) {
        return Err(value_error("size must be one pixel at least each way"));
    }
    let delay = flights::delay(delay)?;
    let pulse = pulse.map(|time| Pulse { time, delay, step: 1e-3 });
    let drawing = supervised(py, None, |_, supervision| {
        let diagram = RayDiagram::new(scene.scene(), &settings, supervision.stop);
        let diagram = diagram.map_err(|error| match error {
            DiagramError::Scene(error) => scene.located(&error),
            error => error.into(),
        });
        Ok(diagram?.draw(pulse.as_ref()))
    })?;
    let mut metadata = metadata(scene.scene());
    if let Some(Pulse { time, delay, .. }) = pulse {
        let words = [("pulse", time.to_string()), ("delay", delay.name().to_owned())];
        metadata.extend(words.map(|(key, word)| (key.to_owned(), word)));
    }
    Ok(Drawing { drawing, title: "Ray diagram", metadata, pixels: size })
}
