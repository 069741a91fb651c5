//! Colour bars: which colour stands for which number.

use super::axes::Frame;
use super::color_scale::{ColorScale, NOTHING};
use super::drawing::{Drawing, Face, INK, Ink, LINE, Shape, Words};
use super::quantity::{Dimension, Quantity};
use super::ticks::{Axis, axis};
use cloakroom::output::RgbImage;
use glam::{DAffine2, DVec2};

/// The key to a map of colours: a vertical bar with ticks, and what they count written upwards
/// beside it. An end beyond which there are numbers ([`ColorScale::is_clipped`]) is drawn as a
/// point; below it stands what is gray, if anything is.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorBar {
    /// The colours.
    pub scale: ColorScale,
    /// What the numbers are.
    pub quantity: Quantity,
}

/// In type of size 1: the width of the colours, and where labels begin to their right.
const COLORS: f64 = 0.8;
const LABELS: f64 = COLORS + 0.5;
/// The height of the sample of what has no number, and of the room between it and the colours.
const GAP: f64 = 0.9;
const ABOVE_GAP: f64 = 1.0;
/// The steps of colour.
const STEPS: u32 = 256;

impl ColorBar {
    /// What stands beside the sample of what has no number, if there is such.
    fn gap_label(&self) -> Option<&'static str> {
        let label = match self.quantity.dimension {
            Dimension::Time => "no light",
            Dimension::Share | Dimension::Number => "none",
        };
        (self.scale.has_gaps && self.scale.range.is_some()).then_some(label)
    }

    /// In type of a size: the height of the colours, the axis, the width of its widest label without
    /// and with that of what has no number, and the lines of its title.
    fn layout(&self, height: f64, text: f64) -> (f64, Axis, [f64; 2], Vec<String>) {
        let gap = self.gap_label();
        let height = if gap.is_some() { height - (ABOVE_GAP + GAP) * text } else { height };
        let axis = axis(&self.quantity, self.scale.range, (height / (1.6 * text)) as usize);
        let width = |label: &str| Face::Regular.width(label, text);
        let ticks = axis.ticks.iter().map(|tick| width(&tick.label)).fold(0.0, f64::max);
        let all = gap.map_or(ticks, |gap| ticks.max(width(gap)));
        let title = Face::Regular.wrap(&axis.title, text, height);
        (height, axis, [ticks, all], title)
    }

    /// The width that it takes up if it is so high, with type of that size.
    pub(super) fn width(&self, height: f64, text: f64) -> f64 {
        let (_, _, [_, widest], title) = self.layout(height, text);
        widest + (LABELS + 0.2 + LINE * title.len() as f64) * text
    }

    /// Draws it with the corner of the colours at a point. They are as high as told, with what is
    /// gray; labels, and the points, reach beyond them by up to half the height of the type.
    pub(super) fn draw(&self, drawing: &mut Drawing, at: DVec2, height: f64, text: f64) {
        let bottom = at.y + height;
        let (height, axis, [ticks, widest], title) = self.layout(height, text);
        let width = COLORS * text;
        let frame = Frame { corner: at, size: DVec2::new(width, height), text };
        let image = RgbImage::from_fn(1, STEPS, |_, row| {
            self.scale.color_at(1.0 - (f64::from(row) + 0.5) / f64::from(STEPS))
        });
        let place = DAffine2::from_cols(DVec2::X * width, DVec2::Y * height, at);
        drawing.add("color-bar", Shape::Image { image, cells: true, place });
        frame.draw(drawing);
        let (below, above) = self.scale.is_clipped;
        for (clipped, share, up) in [(above, 1.0, -0.5), (below, 0.0, 0.5)] {
            if clipped {
                // A point: there are numbers beyond.
                let end = frame.place(DVec2::Y * share);
                let tip = end + DVec2::new(0.5, up) * width;
                let point = drawing.add_area("color-bar-end", [end, tip, end + DVec2::X * width]);
                let ink = Ink::new(self.scale.color_at(share).0);
                point.filled(ink).stroked(INK, Frame::thin(text));
            }
        }
        // To the right, so that digits stand below each other.
        let right = at.x + LABELS * text + ticks;
        if let Some(label) = self.gap_label() {
            let size = DVec2::new(width, GAP * text);
            let sample = Frame { corner: DVec2::new(at.x, bottom - size.y), size, text };
            let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|at| sample.place(at));
            drawing.add_area("color-bar-gap", corners).filled(Ink::new(NOTHING.0));
            sample.draw(drawing);
            let beside = DVec2::new(at.x + LABELS * text, bottom - 0.5 * size.y);
            let words = Words::new(label.to_owned(), beside, text);
            drawing.add_words("gap-label", words.anchored(0.0));
        }
        for tick in &axis.ticks {
            let from = frame.place(DVec2::new(1.0, tick.place));
            frame.draw_tick(drawing, from, DVec2::X);
            let words = Words::new(tick.label.clone(), DVec2::new(right, from.y), text);
            drawing.add_words("tick-label", words.anchored(1.0));
        }
        for (line, outwards) in title.iter().zip(0..) {
            let x = at.x + LABELS * text + widest + (0.8 + LINE * f64::from(outwards)) * text;
            let words = Words::new(line.clone(), DVec2::new(x, at.y + height / 2.0), text);
            drawing.add_words("color-bar-title", words.turned(90.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar(numbers: &[f64]) -> ColorBar {
        ColorBar {
            scale: ColorScale::new(numbers.iter().copied(), 1e-15),
            quantity: Quantity::of_channel("time_of_flight_difference"),
        }
    }

    fn drawn(bar: &ColorBar, height: f64) -> Drawing {
        let size = DVec2::new(bar.width(height, 16.0), height) + 40.0;
        let mut drawing = Drawing::new(size, 16.0);
        bar.draw(&mut drawing, DVec2::splat(20.0), height, 16.0);
        drawing
    }

    #[test]
    fn the_bar_shows_the_colours_from_low_to_high() {
        let bar = bar(&[0.0, 1e-15]);
        let image = drawn(&bar, 256.0);
        let image = image.to_image(image.pixels()).expect("an image");
        for row in [3, 100, 250] {
            let place = 1.0 - (f64::from(row) + 0.5) / 256.0;
            assert_eq!(*image.get_pixel(26, 20 + row), bar.scale.color_at(place));
        }
        assert_eq!(image.get_pixel(26, 17).0, [255; 3]);
    }

    #[test]
    fn it_keeps_to_its_room() {
        for height in [60.0, 240.0, 1000.0] {
            for numbers in [
                vec![],
                vec![1.0],
                vec![-1.0, 1.0],
                vec![3.0, 3.000_000_1],
                vec![0.0, 1.0, f64::NAN],
            ] {
                let bar = bar(&numbers);
                let drawing = drawn(&bar, height);
                let words = drawing.elements.iter().filter_map(|element| match &element.shape {
                    Shape::Words(words) => Some(words),
                    _ => None,
                });
                for words in words {
                    for corner in words.corners() {
                        let inside = corner.cmpge(DVec2::new(20.0, 12.0)).all()
                            && corner.cmple(drawing.size - DVec2::new(20.0, 12.0)).all();
                        assert!(inside, "{words:?} at {height}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_gray_is_said() {
        let count = |numbers: &[f64]| drawn(&bar(numbers), 200.0).of_class("color-bar-gap").count();
        assert_eq!((count(&[0.0, 1.0]), count(&[0.0, f64::NAN, 1.0])), (0, 1));
        // Where nothing has a number, all of the bar is gray.
        assert_eq!(count(&[f64::NAN]), 0);
    }

    #[test]
    fn clipped_ends_are_points() {
        let mut numbers: Vec<f64> = (0..10_000).map(f64::from).collect();
        numbers[5000] = 1e9;
        let bar = bar(&numbers);
        let drawing = drawn(&bar, 200.0);
        let ends: Vec<_> = drawing.of_class("color-bar-end").collect();
        assert_eq!(ends.len(), 1);
        assert_eq!(ends[0].fill, Some(Ink::new(bar.scale.color_at(1.0).0)));
    }
}
