//! Animated PNG.

use super::{FilmError, FilmSettings, FrameFolder, Halt, Size, write_whole};
use cloakroom::output::png_encoder;
use std::io;
use std::path::Path;

/// Most pixels a side of a frame.
const MOST: u32 = 65_536;

/// Writes frames as an animated PNG that goes round for ever.
pub(super) fn write(
    frames: &FrameFolder,
    path: &Path,
    settings: &FilmSettings<'_>,
) -> Result<(), FilmError> {
    let size = Size::of(frames, "PNG", MOST)?;
    write_whole(path, |out| {
        let broken = |error: png::EncodingError| Halt::File(io::Error::from(error));
        let mut encoder =
            png_encoder((size.0[0], size.0[1]), settings.metadata, out).map_err(broken)?;
        // A film has 100000 frames at most, 100 a second at most.
        encoder.set_animated(frames.count() as u32, 0).map_err(broken)?;
        encoder.set_frame_delay(1, settings.rate as u16).map_err(broken)?;
        let mut writer = encoder.write_header().map_err(broken)?;
        for frame in size.checked(frames) {
            writer.write_image_data(frame?.as_raw()).map_err(broken)?;
            settings.done()?;
        }
        writer.finish().map_err(broken)
    })
}
