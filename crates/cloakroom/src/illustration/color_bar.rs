//! Colour bars: which colour stands for which number.

use super::color_scale::ColorScale;
use super::lettering::{Lettering, Weight};
use super::quantity::Quantity;
use super::ticks::{Axis, axis};
use super::{INK, fill, line_width};
use crate::output::RgbImage;
use image::Rgb;

/// The key to a map of colours: a vertical bar with ticks, and what they count written upwards beside
/// it. An end beyond which there are numbers ([`ColorScale::is_clipped`]) is drawn as a point.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorBar {
    /// The colours.
    pub scale: ColorScale,
    /// What the numbers are.
    pub quantity: Quantity,
}

/// Where the parts of a colour bar are, in pixels.
struct Layout {
    axis: Axis,
    letters: Lettering,
    /// The thickness of lines.
    line: u32,
    /// The width of the coloured bar with its frame.
    bar: u32,
    /// The length of a tick, and the space around labels.
    gap: u32,
    /// The width of the labels.
    labels: u32,
    /// The lines of the title.
    title: Vec<String>,
}

impl ColorBar {
    /// The width in pixels that it takes up beside a map of that height, with text of that height.
    pub(super) fn width(&self, height: u32, text: u32) -> u32 {
        let Layout { bar, gap, labels, title, letters, .. } = self.layout(height, text);
        bar + 2 * gap + labels + gap + title.len() as u32 * letters.height()
    }

    /// Draws it with the corner of the bar at `(left, top)`. Its colours are as high as told; labels,
    /// points and the frame reach beyond them by up to half the height of the text.
    pub(super) fn draw(&self, canvas: &mut RgbImage, left: u32, top: u32, height: u32, text: u32) {
        let layout = self.layout(height, text);
        let Layout { axis, letters, line, bar, gap, labels, title } = layout;
        let (left, top) = (i64::from(left), i64::from(top));
        self.draw_colors(canvas, left, top, height, (bar, line));
        let right = left + i64::from(bar);
        let label_right = right + i64::from(2 * gap + labels);
        for tick in &axis.ticks {
            let y = top + ((1.0 - tick.place) * f64::from(height.saturating_sub(1))).round() as i64;
            fill(canvas, right, y - i64::from(line / 2), gap, line, INK);
            // To the right, so that digits stand below each other.
            let x = label_right - i64::from(letters.width(&tick.label));
            letters.draw(canvas, x, y - i64::from(letters.height() / 2), INK, &tick.label);
        }
        for (i, words) in title.iter().enumerate() {
            let x = label_right + i64::from(gap + i as u32 * letters.height());
            let y = top + (i64::from(height) - i64::from(letters.width(words))) / 2;
            letters.draw_upwards(canvas, x, y, INK, words);
        }
    }

    fn layout(&self, height: u32, text: u32) -> Layout {
        let letters = Lettering::new(text, Weight::Regular);
        let text = letters.height();
        let most = height / text + 1;
        let axis = axis(&self.quantity, self.scale.range(), most as usize);
        let labels = axis.ticks.iter().map(|tick| letters.width(&tick.label)).max().unwrap_or(0);
        let title = letters.wrap(&axis.title, height);
        Layout { axis, letters, line: line_width(text), bar: text, gap: text / 3, labels, title }
    }

    /// The bar in its frame, with the points at its ends.
    fn draw_colors(
        &self,
        canvas: &mut RgbImage,
        left: i64,
        top: i64,
        height: u32,
        (width, line): (u32, u32),
    ) {
        let (below, above) = self.scale.is_clipped();
        // The frame lies around the colours, as that of the map does, and is open towards points.
        let (over, under) = (if above { 0 } else { line }, if below { 0 } else { line });
        fill(canvas, left, top - i64::from(over), width, height + over + under, INK);
        let inner = width.saturating_sub(2 * line);
        for row in 0..height {
            let place = 1.0 - (f64::from(row) + 0.5) / f64::from(height);
            let (x, y) = (left + i64::from(line), top + i64::from(row));
            fill(canvas, x, y, inner, 1, self.scale.color_at(place));
        }
        let point = width / 2;
        for row in 0..point {
            // The point gets narrower by two pixels a row.
            let across = f64::from(width) * (1.0 - (f64::from(row) + 0.5) / f64::from(point));
            // Along its slope of 45 degrees a line is wider across.
            let inside = across - 2.0 * 1.5 * f64::from(line);
            let middle = left as f64 + f64::from(width) / 2.0;
            for (wanted, y, place) in [
                (above, top - 1 - i64::from(row), 1.0),
                (below, top + i64::from(height + row), 0.0),
            ] {
                if wanted {
                    soft_row(canvas, y, middle, across, INK);
                    soft_row(canvas, y, middle, inside, self.scale.color_at(place));
                }
            }
        }
    }
}

/// Fills a piece of a row about its middle, pixels that it covers in part in part.
fn soft_row(canvas: &mut RgbImage, y: i64, middle: f64, width: f64, color: Rgb<u8>) {
    let (from, to) = (middle - width / 2.0, middle + width / 2.0);
    let Ok(y) = u32::try_from(y) else { return };
    for x in from.floor() as i64..to.ceil() as i64 {
        let covered = (to.min(x as f64 + 1.0) - from.max(x as f64)).clamp(0.0, 1.0);
        let Ok(x) = u32::try_from(x) else { continue };
        let Some(Rgb(under)) = canvas.get_pixel_mut_checked(x, y) else { continue };
        for (below, above) in under.iter_mut().zip(color.0) {
            let mixed = f64::from(*below) * (1.0 - covered) + f64::from(above) * covered;
            *below = mixed.round() as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::PAPER;
    use super::*;

    fn bar(numbers: &[f64]) -> ColorBar {
        ColorBar {
            scale: ColorScale::new(numbers.iter().copied(), 1e-15),
            quantity: Quantity::of_channel("time_of_flight_difference"),
        }
    }

    fn drawn(bar: &ColorBar, height: u32) -> RgbImage {
        let width = bar.width(height, 16);
        let mut canvas = RgbImage::from_pixel(width + 40, height + 40, PAPER);
        bar.draw(&mut canvas, 20, 20, height, 16);
        canvas
    }

    #[test]
    fn the_bar_shows_the_colours_from_low_to_high() {
        let bar = bar(&[0.0, 1e-15]);
        let image = drawn(&bar, 200);
        let at = |y| *image.get_pixel(28, y);
        assert_eq!([18, 19, 220, 221].map(at), [PAPER, INK, INK, PAPER]);
        assert_eq!(at(20), bar.scale.color_at(1.0 - 0.5 / 200.0));
        assert_eq!(at(219), bar.scale.color_at(0.5 / 200.0));
    }

    #[test]
    fn it_keeps_to_its_room() {
        for height in [1, 7, 60, 240, 1000] {
            for numbers in [vec![], vec![1.0], vec![-1.0, 1.0], vec![3.0, 3.000_000_1]] {
                let bar = bar(&numbers);
                let image = drawn(&bar, height);
                let right = 20 + bar.width(height, 16);
                for (x, y, pixel) in image.enumerate_pixels() {
                    // A title of one long word may be longer than a very short bar.
                    let outside =
                        x < 20 || x >= right || (height > 30 && (y < 8 || y >= height + 32));
                    assert!(!outside || *pixel == PAPER, "({x}, {y}) at {height}");
                }
            }
        }
    }

    #[test]
    fn clipped_ends_are_points() {
        let mut numbers: Vec<f64> = (0..10_000).map(f64::from).collect();
        numbers[5000] = 1e9;
        let bar = bar(&numbers);
        let image = drawn(&bar, 200);
        assert_eq!(*image.get_pixel(28, 18), bar.scale.color_at(1.0));
        assert_eq!(*image.get_pixel(20, 14), PAPER);
        assert_eq!(*image.get_pixel(28, 221), PAPER);
    }

    #[test]
    fn nothing_to_show_is_gray() {
        let bar = bar(&[f64::NAN]);
        let image = drawn(&bar, 100);
        assert_eq!(*image.get_pixel(28, 60), bar.scale.color(f64::NAN));
    }
}
