//! Maps of scalar channels in colour.

use super::axes::Frame;
use super::color_bar::ColorBar;
use super::color_scale::ColorScale;
use super::drawing::{Drawing, Shape};
use super::quantity::{Dimension, Quantity};
use super::{IllustrationError, type_size};
use cloakroom::output::{Picture, RgbImage, Samples};
use cloakroom::scene::{Colormap, PictureSettings};
use glam::{DAffine2, DVec2};

/// A channel of a picture in colour, with the key to its colours.
#[derive(Clone, Debug, PartialEq)]
pub struct ScalarMap {
    /// One pixel for each of the picture.
    pub image: RgbImage,
    /// Which colour stands for which number.
    pub bar: ColorBar,
}

/// Times (ns) and shares below this are what rounding leaves of nothing: light goes 0.3 nm in such a time.
const NOTHING: f64 = 1e-9;

impl ScalarMap {
    /// The map of a channel, in the range and the colours that the settings say, or in those that
    /// suit its numbers ([`ColorScale`] says which): differences of both signs in blue and red. Times and shares
    /// of which all are rounding get the one color of 0, unless the settings say a range.
    ///
    /// # Errors
    ///
    /// If the picture has no such channel, or the channel not one number a pixel.
    pub fn new(
        picture: &Picture,
        channel: &str,
        settings: &PictureSettings,
    ) -> Result<Self, IllustrationError> {
        let samples = &picture
            .channel(channel)
            .ok_or_else(|| IllustrationError::UnknownChannel {
                name: channel.to_owned(),
                known: picture.channels.iter().map(|channel| channel.name.clone()).collect(),
            })?
            .samples;
        let wrong_size = || IllustrationError::WrongSize {
            name: channel.to_owned(),
            samples: samples.len(),
            width: picture.width,
            height: picture.height,
        };
        if picture.width.checked_mul(picture.height) != Some(samples.len()) {
            return Err(wrong_size());
        }
        let width = u32::try_from(picture.width).map_err(|_| wrong_size())?;
        let height = u32::try_from(picture.height).map_err(|_| wrong_size())?;
        // A few units in the last place.
        let rounding = match samples {
            Samples::F32(_) | Samples::Rgb(_) | Samples::Bins(_) => 8.0 * f64::from(f32::EPSILON),
            Samples::F64(_) => 8.0 * f64::EPSILON,
        };
        let scale_of = |settings: &PictureSettings| {
            ColorScale::of((0..samples.len()).map(|i| samples.get(i)), rounding, settings)
        };
        let mut scale = scale_of(settings);
        let quantity = Quantity::of_channel(channel);
        let is_nothing = |(low, high): (f64, f64)| low.abs().max(high.abs()) < NOTHING;
        if settings.map_range.is_none()
            && quantity.dimension != Dimension::Number
            && scale.range.is_some_and(is_nothing)
        {
            (scale.range, scale.is_clipped) = (Some((0.0, 0.0)), (false, false));
        }
        let is_difference = channel.ends_with("_difference");
        if settings.colormap == Colormap::Auto && is_difference && scale.has_both_signs() {
            scale = scale_of(&PictureSettings { colormap: Colormap::BlueRed, ..settings.clone() });
        }
        let colors = (0..samples.len()).flat_map(|i| scale.color(samples.get(i)).0).collect();
        let image = RgbImage::from_raw(width, height, colors).ok_or_else(wrong_size)?;
        Ok(Self { image, bar: ColorBar { scale, quantity } })
    }

    /// The map in pixels: alone, exactly as large as the picture, or with its colour bar
    /// ([`draw`](Self::draw)).
    ///
    /// # Errors
    ///
    /// If there is not enough memory.
    pub fn into_image(self, color_bar: bool) -> Result<RgbImage, IllustrationError> {
        if !color_bar {
            return Ok(self.image);
        }
        let drawing = self.draw(true);
        drawing.to_image(drawing.pixels())
    }

    /// The map as a drawing, a unit a pixel: alone, or framed, with the colour bar to its right and
    /// a margin around both.
    #[must_use]
    pub fn draw(&self, color_bar: bool) -> Drawing {
        let [width, height] = [self.image.width(), self.image.height()].map(f64::from);
        let text = type_size(self.image.width(), self.image.height());
        if !color_bar {
            let mut drawing = Drawing::new(DVec2::new(width, height), text);
            let place = DAffine2::from_scale(drawing.size);
            let image = self.image.clone();
            drawing.add("picture", Shape::Image { image, cells: true, place });
            return drawing;
        }
        let margin = text.round();
        // A very low map gets a bar that has room for ticks and some title.
        let bar_height = height.max((10.0 * text).round());
        let bar_at = DVec2::new(2.0 * margin + width, margin);
        let right = bar_at.x + self.bar.width(bar_height, text) + margin / 2.0;
        let mut drawing = Drawing::new(DVec2::new(right, bar_height + 2.0 * margin).ceil(), text);
        let at = DVec2::new(margin, margin + ((bar_height - height) / 2.0).floor());
        drawing.add_framed(self.image.clone(), true, at, Frame::thin(text).round().max(1.0));
        self.bar.draw(&mut drawing, bar_at, bar_height, text);
        drawing
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloakroom::output::Channel;

    fn picture(width: usize, height: usize) -> Picture {
        let times = (0..width * height).map(|i| i as f64 * 1e-6).collect();
        let channel = |name: &str, samples| Channel { name: name.to_owned(), samples };
        Picture {
            width,
            height,
            channels: vec![
                channel("time_of_flight_difference", Samples::F64(times)),
                channel("delivered", Samples::F32(vec![1.0; width * height])),
                channel("broken", Samples::F32(vec![1.0; 3])),
            ],
            metadata: Vec::new(),
        }
    }

    fn scalar_map(
        picture: &Picture,
        channel: &str,
        color_bar: bool,
    ) -> Result<RgbImage, IllustrationError> {
        ScalarMap::new(picture, channel, &PictureSettings::default())?.into_image(color_bar)
    }

    #[test]
    fn a_map_has_a_pixel_for_each_of_the_picture() {
        let picture = picture(5, 3);
        let map = scalar_map(&picture, "time_of_flight_difference", false).expect("a map");
        assert_eq!(map.dimensions(), (5, 3));
        assert_ne!(map.get_pixel(0, 0), map.get_pixel(4, 2));
        let settings = PictureSettings::default();
        let range = ScalarMap::new(&picture, "time_of_flight_difference", &settings)
            .map(|map| map.bar.scale.range);
        assert_eq!(range, Ok(Some((0.0, 14.0 * 1e-6))));
    }

    #[test]
    fn a_color_bar_stands_beside_the_map() {
        for (width, height) in [(1, 1), (320, 240), (40, 2000), (2000, 40)] {
            let picture = picture(width, height);
            for channel in ["time_of_flight_difference", "delivered"] {
                let map = ScalarMap::new(&picture, channel, &PictureSettings::default());
                let map = map.expect("a map");
                let image = scalar_map(&picture, channel, true).expect("a map");
                let margin = type_size(width as u32, height as u32) as u32;
                let top = (image.height() - height as u32) / 2;
                // Every number has its pixel.
                for (x, y, pixel) in map.image.enumerate_pixels() {
                    assert_eq!(image.get_pixel(margin + x, top + y), pixel, "({x}, {y})");
                }
                assert_eq!(image.get_pixel(margin - 1, top).0, [24; 3]);
            }
        }
    }

    #[test]
    fn differences_of_both_signs_are_blue_and_red() {
        let colors = |numbers: [f64; 3], name: &str| {
            let samples = Samples::F64(numbers.to_vec());
            let channels = vec![Channel { name: name.to_owned(), samples }];
            let picture = Picture { width: 3, height: 1, channels, metadata: Vec::new() };
            let map = ScalarMap::new(&picture, name, &PictureSettings::default()).expect("a map");
            map.bar.scale.colors
        };
        assert_eq!(colors([-1.0, 0.0, 2.0], "group_delay_difference"), Colormap::BlueRed);
        assert_eq!(colors([-1e-6, 0.0, 2.0], "group_delay_difference"), Colormap::Viridis);
        assert_eq!(colors([-1.0, 0.0, 2.0], "group_delay"), Colormap::Viridis);
    }

    #[test]
    fn what_rounding_leaves_of_nothing_is_one_color() {
        let map = |name: &str, size: f64, settings: &PictureSettings| {
            let samples = Samples::F64(vec![-size, 0.0, 0.7 * size]);
            let channels = vec![Channel { name: name.to_owned(), samples }];
            let picture = Picture { width: 3, height: 1, channels, metadata: Vec::new() };
            let map = ScalarMap::new(&picture, name, settings).expect("a map");
            let pixels: Vec<_> = map.image.pixels().copied().collect();
            (pixels.iter().all(|pixel| *pixel == pixels[0]), map.bar.scale.range)
        };
        let auto = PictureSettings::default();
        for name in ["time_of_flight_difference", "group_delay", "absorbed"] {
            assert_eq!(map(name, 1e-15, &auto), (true, Some((0.0, 0.0))), "{name}");
            assert!(!map(name, 1e-8, &auto).0, "{name}");
            let asked = PictureSettings { map_range: Some([-1e-15, 1e-15]), ..auto.clone() };
            assert!(!map(name, 1e-15, &asked).0, "{name}");
        }
        // A depth has no such measure.
        assert!(!map("first_pulse_depth", 1e-15, &auto).0);
    }

    #[test]
    fn odd_pictures_do_no_harm() {
        let empty = picture(0, 0);
        assert!(scalar_map(&empty, "delivered", true).is_ok());
        let error = scalar_map(&picture(2, 2), "pruned", false).expect_err("no such channel");
        assert_eq!(
            error.to_string(),
            "the picture has no channel `pruned`; it has time_of_flight_difference, delivered, broken"
        );
        let error = scalar_map(&picture(2, 2), "broken", false).expect_err("too few numbers");
        assert!(error.to_string().contains("3 numbers"));
        let huge = Picture { width: usize::MAX, height: 2, ..picture(2, 2) };
        assert!(scalar_map(&huge, "delivered", false).is_err());
    }
}
