//! Illustrations: maps of scalar channels in colour, and labelled sheets of panels like the figures
//! of a paper.

mod color_bar;
mod color_scale;
mod diagram;
mod drawing;
mod heat_map;
mod lettering;
mod plot;
mod quantity;
mod scalar_map;
mod setting;
mod sheet;
mod shrink;
mod table;
mod ticks;

pub use color_bar::ColorBar;
pub use color_scale::ColorScale;
pub use diagram::{Diagram, DiagramError, DiagramSettings, Projected, Source, diagram};
pub use drawing::{Drawing, Element, Face, Ink, Shape, Stroke, Words};
pub use heat_map::{HeatMap, HeatMapPanel};
pub use plot::{Curve, CurvePoint, Plot, PlotPanel};
pub use quantity::{Dimension, Quantity, Unit};
pub use scalar_map::{ScalarMap, scalar_map};
pub use setting::{Setting, View, setting};
pub use sheet::{SheetPanel, sheet};
pub use table::{TablePicture, TableRow, table};

use crate::output::RgbImage;
use image::Rgb;

/// Why an illustration cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IllustrationError {
    /// The picture has no channel of that name.
    #[error("the picture has no channel `{name}`; it has {}", known.join(", "))]
    UnknownChannel {
        /// The name asked for.
        name: String,
        /// The channels there are.
        known: Vec<String>,
    },
    /// The channel does not hold one number for each pixel.
    #[error(
        "channel `{name}` holds {samples} numbers, not one for each of {width} x {height} pixels"
    )]
    WrongSize {
        /// The channel.
        name: String,
        /// How many numbers it holds.
        samples: usize,
        /// The picture's width in pixels.
        width: usize,
        /// The picture's height in pixels.
        height: usize,
    },
    /// A drawing with so many pixels does not fit into the memory.
    #[error("a drawing of {width} x {height} pixels does not fit into the memory; take fewer")]
    TooLarge {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
}

/// The colour of lettering, ticks and frames.
const INK: Rgb<u8> = Rgb([24, 24, 24]);

/// The background of everything.
const PAPER: Rgb<u8> = Rgb([255, 255, 255]);

/// The height in pixels of a line of text that suits a picture of that size: 16 for 640 x 480, 26 for
/// 1024 x 768, growing in proportion.
fn text_height(width: u32, height: u32) -> u32 {
    let side = (f64::from(width) * f64::from(height)).sqrt();
    // A strip much longer than wide is lettered for its short side.
    let side = side.min(2.0 * f64::from(width.min(height)));
    ((side / 34.0).round() as u32).max(16)
}

/// The thickness in pixels of lines that go with text of that height.
fn line_width(text_height: u32) -> u32 {
    (text_height / 16).max(1)
}

/// Fills a rectangle as far as it lies on the canvas.
fn fill(canvas: &mut RgbImage, left: i64, top: i64, width: u32, height: u32, color: Rgb<u8>) {
    let across = on_canvas(left, width, canvas.width());
    for y in on_canvas(top, height, canvas.height()) {
        for x in across.clone() {
            canvas.put_pixel(x, y, color);
        }
    }
}

/// The part of `start .. start + length` that lies in `0 .. limit`.
fn on_canvas(start: i64, length: u32, limit: u32) -> std::ops::Range<u32> {
    let clamp = |edge: i64| edge.clamp(0, i64::from(limit)) as u32;
    clamp(start)..clamp(start + i64::from(length))
}

/// Puts an image on the canvas in a thin frame that lies around it.
fn frame(canvas: &mut RgbImage, image: &RgbImage, left: u32, top: u32, thickness: u32) {
    let (x, y, t) = (i64::from(left), i64::from(top), i64::from(thickness));
    let (width, height) = (image.width() + 2 * thickness, image.height() + 2 * thickness);
    fill(canvas, x - t, y - t, width, height, INK);
    image::imageops::replace(canvas, image, x, y);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_grows_with_the_picture() {
        assert_eq!(text_height(1, 1), 16);
        assert_eq!(text_height(640, 480), 16);
        assert_eq!(text_height(1024, 768), 26);
        assert_eq!(text_height(4096, 3072), 104);
        assert!(text_height(65_536, 4) == 16);
    }

    #[test]
    fn what_lies_beside_the_canvas_is_not_drawn() {
        let mut canvas = RgbImage::from_pixel(4, 4, PAPER);
        fill(&mut canvas, -2, 3, 3, 9, INK);
        let inked: Vec<_> =
            canvas.enumerate_pixels().filter(|p| *p.2 == INK).map(|p| (p.0, p.1)).collect();
        assert_eq!(inked, [(0, 3)]);
        fill(&mut canvas, 100, 100, 5, 5, INK);
    }
}
