//! Animated GIF: one palette of 255 colors for the whole film, so that what stands still does not
//! flicker.

use super::{Film, FilmError, stay, write_whole};
use cloakroom::output::RgbImage;
use color_quant::NeuQuant;
use gif::{AnyExtension, Encoder, Extension, Frame, Repeat};
use rayon::prelude::*;
use std::borrow::Cow;

/// Colors of the palette; one more index stands for a pixel that stays as it is.
const COLORS: usize = 255;

/// The index of a pixel that stays as it is.
const UNCHANGED: u8 = 255;

/// Pixels that the palette is made from.
const SAMPLES: usize = 1 << 19;

/// How much of the difference between two neighbouring colors of the palette the dither covers, in
/// codes.
const DITHER: f64 = 16.0;

/// Writes frames as an animated GIF that goes round for ever.
pub(super) fn write(film: &Film<'_>) -> Result<(), FilmError> {
    let size = film.size("GIF", u32::from(u16::MAX))?;
    let [width, height] = size.map(|side| side as u16);
    let palette = palette(film, size)?;
    write_whole(film.path, |out| {
        let colors = palette.color_map_rgb();
        let mut encoder = Encoder::new(out, width, height, &colors)?;
        encoder.set_repeat(Repeat::Infinite)?;
        for (key, text) in film.metadata {
            let text = format!("{key}: {text}");
            let comment = AnyExtension(Extension::Comment as u8);
            encoder.write_raw_extension(comment, &[text.as_bytes()])?;
        }
        let mut shown: Vec<u8> = Vec::new();
        for (number, frame) in film.checked(size).enumerate() {
            let indices = indices(&palette, &frame?);
            let changed = |(new, old): (&u8, &u8)| if new == old { UNCHANGED } else { *new };
            let buffer = match number {
                0 => indices.clone(),
                _ => indices.iter().zip(&shown).map(changed).collect(),
            };
            let frame = Frame {
                width,
                height,
                delay: stay(number, film.rate, 100.0) as u16,
                transparent: Some(UNCHANGED),
                buffer: Cow::Owned(buffer),
                ..Frame::default()
            };
            encoder.write_frame(&frame)?;
            shown = indices;
            film.done()?;
        }
        encoder.into_inner()?;
        Ok(())
    })
}

/// The palette of a film, from pixels spread over all its frames.
fn palette(film: &Film<'_>, size: [u32; 2]) -> Result<NeuQuant, FilmError> {
    let each = (SAMPLES / film.frames.count).max(64);
    let mut pixels = Vec::new();
    for frame in film.checked(size) {
        let frame = frame?;
        let step = (frame.as_raw().len() / 3 / each).max(1);
        let colors = frame.as_raw().chunks_exact(3).step_by(step);
        pixels.extend(colors.flat_map(|color| [color[0], color[1], color[2], 255]));
    }
    Ok(NeuQuant::new(3, COLORS, &pixels))
}

/// The palette's indices of a frame, with an ordered dither that stands still from frame to frame.
fn indices(palette: &NeuQuant, frame: &RgbImage) -> Vec<u8> {
    let width = frame.width() as usize;
    let pixels = frame.as_raw().par_chunks_exact(3).enumerate();
    pixels
        .map(|(i, color)| {
            let shift = (bayer(i % width, i / width) * DITHER).round() as i16;
            let [r, g, b] = [0, 1, 2].map(|c| (i16::from(color[c]) + shift).clamp(0, 255) as u8);
            palette.index_of(&[r, g, b, 255]).min(COLORS - 1) as u8
        })
        .collect()
}

/// The ordered dither of Bayer, 8 x 8: from -1/2 to 1/2.
fn bayer(x: usize, y: usize) -> f64 {
    let bits = (0..3).fold(0, |value, bit| {
        let (x, y) = (x >> bit & 1, y >> bit & 1);
        value << 2 | (x ^ y) << 1 | y
    });
    (bits as f64 + 0.5) / 64.0 - 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dither_has_every_level_once() {
        let mut levels: Vec<i32> =
            (0..64).map(|i| (bayer(i % 8, i / 8) * 128.0).round() as i32).collect();
        levels.sort_unstable();
        assert!(levels.iter().zip(0..).all(|(level, n)| *level == 2 * n - 63), "{levels:?}");
        // Neighbours differ by a quarter at least, on average.
        let apart = (0..64).map(|i| (bayer(i % 8, i / 8) - bayer(i % 8 + 1, i / 8)).abs());
        assert!(apart.sum::<f64>() / 64.0 > 0.25);
    }
}
