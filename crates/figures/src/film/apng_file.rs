//! Animated PNG.

use super::{FilmError, FilmSettings, FrameFolder, checked, size, write_whole};
use cloakroom::output::png_encoder;
use std::path::Path;

/// Most pixels a side of a frame.
const MOST: u32 = 65_536;

/// Writes frames as an animated PNG that goes round for ever.
pub(super) fn write(
    frames: &FrameFolder,
    path: &Path,
    settings: &FilmSettings<'_>,
) -> Result<(), FilmError> {
    let [width, height] = size(frames, "PNG", MOST)?;
    write_whole(path, |out| {
        let mut encoder = png_encoder((width, height), settings.metadata, out)?;
        // A film has 100000 frames at most, 100 a second at most.
        encoder.set_animated(frames.count as u32, 0)?;
        encoder.set_frame_delay(1, settings.rate as u16)?;
        let mut writer = encoder.write_header()?;
        for frame in checked(frames, [width, height]) {
            writer.write_image_data(frame?.as_raw())?;
            settings.done()?;
        }
        Ok(writer.finish()?)
    })
}
