//! Drawings as files.

use super::super::IllustrationError;
use super::Drawing;
use cloakroom::output::{OutputError, format_of, write_png, write_whole};
use std::path::Path;

/// A format of files of drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingFormat {
    /// Lines, for pages and for further work.
    Svg,
    /// Lines, for print.
    Pdf,
    /// Pixels.
    Png,
}

impl DrawingFormat {
    /// The format that the ending of a file's name asks for.
    ///
    /// # Errors
    ///
    /// [`OutputError::UnknownFormat`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        format_of(path, &[("svg", Self::Svg), ("pdf", Self::Pdf), ("png", Self::Png)])
    }
}

impl Drawing {
    /// Writes the drawing as a file that is there whole or not at all, with a title and metadata; a
    /// PNG has so many pixels, the others are as large as on paper.
    ///
    /// # Errors
    ///
    /// If the pixels do not fit into the memory, or the file cannot be written.
    pub fn write(
        &self,
        format: DrawingFormat,
        title: &str,
        metadata: &[(String, String)],
        pixels: [u32; 2],
        path: &Path,
    ) -> Result<(), IllustrationError> {
        let bytes = match format {
            DrawingFormat::Svg => self.to_svg(title, metadata).into_bytes(),
            DrawingFormat::Pdf => self.to_pdf(title, metadata),
            DrawingFormat::Png => return Ok(write_png(&self.to_image(pixels)?, metadata, path)?),
        };
        Ok(write_whole(path, |out| out.write_all(&bytes))?)
    }
}
