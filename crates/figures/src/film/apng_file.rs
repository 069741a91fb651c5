//! Animated PNG.

use super::{Film, FilmError, write_whole};
use cloakroom::output::png_encoder;

/// Writes frames as an animated PNG that goes round for ever.
pub(super) fn write(film: &Film<'_>) -> Result<(), FilmError> {
    let [width, height] = film.size("PNG", 65_536)?;
    write_whole(film.path, |out| {
        let mut encoder = png_encoder((width, height), film.metadata, out)?;
        // A film has 100000 frames at most, 100 a second at most.
        encoder.set_animated(film.frames.count as u32, 0)?;
        encoder.set_frame_delay(1, film.rate as u16)?;
        let mut writer = encoder.write_header()?;
        for frame in film.checked([width, height]) {
            writer.write_image_data(frame?.as_raw())?;
            film.done()?;
        }
        Ok(writer.finish()?)
    })
}
