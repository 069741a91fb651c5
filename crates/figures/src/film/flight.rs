//! Films of light in flight: a frame for each bin of time.

use super::{FilmError, FrameFolder};
use crate::{Drawing, Face, IllustrationError, Ink, Shape, Words, type_size};
use cloakroom::output::{FlightStore, OutputError, RgbImage, light_to_srgb, write_png};
use cloakroom::render::{RenderError, Supervision};
use cloakroom::trace::Stopped;
use glam::DVec2;
use std::sync::atomic::Ordering;

/// How a film shows light in flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightFilm {
    /// What the light of the flash is multiplied by.
    pub exposure: f64,
    /// Whether a frame has all light up to its time, and not what comes in it alone.
    pub accumulated: bool,
}

/// Why a frame of light in flight cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum FlightFilmError {
    /// What was kept cannot be read.
    #[error("cannot read what was kept of the light: {0}")]
    Kept(#[from] std::io::Error),
    /// The clock cannot be drawn.
    #[error(transparent)]
    Clock(#[from] IllustrationError),
    /// A frame cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The film cannot be made.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// The work was stopped.
    #[error(transparent)]
    Render(#[from] RenderError),
}

/// Makes the frames of a film of light in flight into their folder.
///
/// # Errors
///
/// If what was kept cannot be read, a frame not be written, or the work was stopped.
pub fn flight_frames(
    store: &FlightStore,
    film: &FlightFilm,
    frames: &FrameFolder,
    metadata: &[(String, String)],
    supervision: &Supervision<'_>,
) -> Result<(), FlightFilmError> {
    let [width, height] = store.size().map(|side| side as u32);
    let steady = store.steady();
    let mut seen = if film.accumulated { store.before() } else { Vec::new() };
    for bin in 0..store.gate().bins() {
        if supervision.stop.load(Ordering::Relaxed) {
            return Err(RenderError::from(Stopped).into());
        }
        let light = store.frame(bin)?;
        if film.accumulated {
            for (sum, light) in seen.iter_mut().zip(light) {
                sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
            }
        } else {
            seen = light;
        }
        let exposed = |(steady, light): (&[f32; 3], &[f32; 4])| {
            std::array::from_fn(|color| steady[color] + film.exposure as f32 * light[color])
        };
        let pixels: Vec<[f32; 3]> = steady.iter().zip(&seen).map(exposed).collect();
        if let Some(mut image) = light_to_srgb([width, height], &pixels) {
            let gate = store.gate();
            draw_clock(&mut image, &time_in_words(gate.middle(bin), gate.clock()))?;
            write_png(&image, metadata, &frames.file(bin))?;
        }
        (supervision.rows_done)(1);
    }
    Ok(())
}

/// A time in ns, as exact as the steps are.
pub(in super::super) fn time_in_words(time: f64, step: f64) -> String {
    let digits = (-step.log10()).ceil().clamp(0.0, 12.0) as usize;
    // Half of a thousandth needs one more.
    let exact = (step * 10_f64.powi(digits as i32)).fract();
    let digits = digits + usize::from(exact > 1e-6 && exact < 1.0 - 1e-6);
    format!("{time:.digits$} ns")
}

/// Writes the time into the lower left corner of a frame, white on what is there, darkened. A corner that is
/// too small for it stays as it is.
fn draw_clock(image: &mut RgbImage, time: &str) -> Result<(), IllustrationError> {
    let size = type_size(image.width(), image.height());
    let words = Words::of(Face::Regular, time, DVec2::ZERO, size);
    let plate = DVec2::new(words.width() + size, 1.8 * size).ceil();
    let mut drawing = Drawing::new(plate, size);
    let corners = [DVec2::ZERO, DVec2::new(plate.x, 0.0), plate, DVec2::new(0.0, plate.y)];
    drawing.add("plate", Shape::Area(vec![corners.to_vec()])).filled(Ink::new([0; 3]));
    let at = DVec2::new(size / 2.0, plate.y / 2.0);
    let words = Words { at, ..words }.anchored(0.0);
    drawing.add("clock", Shape::Words(words)).filled(Ink::new([255; 3]));
    let clock = drawing.to_image(drawing.pixels())?;
    let top = image.height().saturating_sub(clock.height());
    if clock.width() > image.width() || clock.height() > image.height() {
        return Ok(());
    }
    for (x, y, ink) in clock.enumerate_pixels() {
        let pixel = image.get_pixel_mut(x, top + y);
        for (color, ink) in pixel.0.iter_mut().zip(ink.0) {
            *color = (*color / 3).max(ink);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_is_as_exact_as_its_steps() {
        assert_eq!(time_in_words(5.0, 0.005), "5.000 ns");
        assert_eq!(time_in_words(5.0125, 0.0025), "5.0125 ns");
        assert_eq!(time_in_words(12.0, 2.0), "12 ns");
        assert_eq!(time_in_words(0.1 + 0.2, 0.1), "0.3 ns");
    }

    #[test]
    fn the_clock_stands_in_a_corner() {
        let gray = RgbImage::from_pixel(200, 100, image::Rgb([90; 3]));
        let mut shown = gray.clone();
        draw_clock(&mut shown, "5.000 ns").expect("drawn");
        assert_eq!(shown.get_pixel(150, 20), gray.get_pixel(150, 20));
        assert_eq!(shown.get_pixel(0, 99).0, [30; 3]);
        assert!(shown.pixels().any(|pixel| pixel.0 == [255; 3]));
        let mut small = RgbImage::new(9, 7);
        draw_clock(&mut small, "5.000 ns").expect("drawn");
        assert_eq!(small, RgbImage::new(9, 7));
    }
}
