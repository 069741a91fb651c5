//! Drawings into files: SVG and PNG.

use crate::report::Failure;
use cloakroom::illustration::Drawing;
use cloakroom::output;
use std::path::Path;

/// A format of drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingFormat {
    /// Lines.
    Svg,
    /// Pixels.
    Png,
}

/// The format that the ending of a file's name asks for.
pub fn format(path: &Path) -> Result<DrawingFormat, Failure> {
    match output::ending(path).as_deref() {
        Some("svg") => Ok(DrawingFormat::Svg),
        Some("png") => Ok(DrawingFormat::Png),
        _ => Err(Failure::Failed(format!(
            "cannot tell the format of {} by its ending; a drawing is a .svg or a .png",
            path.display()
        ))),
    }
}

/// Writes a drawing as its file's name asks for.
pub fn write(
    drawing: &Drawing,
    title: &str,
    metadata: &[(String, String)],
    size: [u32; 2],
    path: &Path,
) -> Result<(), Failure> {
    match format(path)? {
        DrawingFormat::Png => {
            let image = drawing.to_image(size).map_err(Failure::from_error)?;
            output::write_png(&image, metadata, path)
        }
        DrawingFormat::Svg => {
            let svg = drawing.to_svg(size, title, metadata);
            output::write_whole(path, |out| out.write_all(svg.as_bytes()))
        }
    }
    .map_err(Failure::from_error)
}
