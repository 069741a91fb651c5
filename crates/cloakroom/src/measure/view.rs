//! A picture to be measured.

use super::MeasureError;
use crate::memory;
use crate::output::{Format, Picture, ReadError, read_channels};
use crate::photograph::{ImageSource, LinearImage, Texels, decode_table, load};
use exr::meta::MetaData;
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// The channels of times and power that a view may have.
const FLIGHT: &str = "time_of_flight";
const FLIGHT_DIFFERENCE: &str = "time_of_flight_difference";
const DELIVERED: &str = "delivered";

/// All channels that make a view.
const CHANNELS: [&str; 6] = ["R", "G", "B", FLIGHT, FLIGHT_DIFFERENCE, DELIVERED];

/// A picture in linear light, with the times and powers that came with it. All planes run row by
/// row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Width in pixels, at least 1.
    pub width: usize,
    /// Height in pixels, at least 1.
    pub height: usize,
    /// Red, green and blue, linear and finite.
    pub light: [Vec<f64>; 3],
    /// Time of flight, ns; NaN where no light comes from the photograph.
    pub time_of_flight: Option<Vec<f64>>,
    /// Time of flight less that of the same camera ray in empty space, ns.
    pub time_of_flight_difference: Option<Vec<f64>>,
    /// Share of the power that reaches the photograph.
    pub delivered: Option<Vec<f64>>,
}

impl View {
    /// A view of light alone.
    ///
    /// # Errors
    ///
    /// If the planes are not of that size, or hold a number that is not finite.
    pub fn new(width: usize, height: usize, light: [Vec<f64>; 3]) -> Result<Self, MeasureError> {
        Self::named("the picture", [width, height], light)
    }

    /// A rendered picture as a view.
    ///
    /// # Errors
    ///
    /// If it has no image, or one with a number that is not finite.
    pub fn of(picture: &Picture) -> Result<Self, MeasureError> {
        Self::of_named(picture, "the picture")
    }

    /// Reads a view from a file, as its ending says: NPZ and EXR hold linear light in `R`, `G` and
    /// `B`, times of flight and powers; PNG is decoded from sRGB.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or holds no image or one with a number that is not finite.
    pub fn read(path: &Path) -> Result<Self, MeasureError> {
        match Format::of(path) {
            Err(_) => Err(ReadError::new(path, "its ending is not .png, .exr or .npz").into()),
            Ok(Format::Png) => Self::of_image(path),
            Ok(Format::Exr) => {
                let view = Self::of_image(path)?;
                let planes = read_exr(path).map_err(|reason| ReadError::new(path, reason))?;
                let plane = |wanted: &str| planes.iter().find(|(name, _)| name == wanted);
                Ok(view.with_flight(|name| Some(plane(name)?.1.clone())))
            }
            Ok(Format::Npz) => {
                let picture = read_channels(path, |name| CHANNELS.contains(&name))?;
                Self::of_named(&picture, &path.display().to_string())
            }
        }
    }

    /// Bytes of all planes that a pixel may have.
    const BYTES_PER_PIXEL: u64 = 8 * CHANNELS.len() as u64;

    /// Refuses work on pictures of its size that takes more memory than there is.
    pub(super) fn check_room(&self, needed: u64) -> Result<(), MeasureError> {
        check_room([self.width, self.height], needed)
    }

    /// How many pixels it has.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    fn of_image(path: &Path) -> Result<Self, MeasureError> {
        Self::of_linear(&load(&ImageSource::File(path.to_owned()))?)
    }

    /// An image as a view.
    ///
    /// # Errors
    ///
    /// If it has no pixels, or one that is not finite.
    pub fn of_linear(image: &LinearImage) -> Result<Self, MeasureError> {
        let LinearImage { width, height, texels } = image;
        check_room([*width, *height], Self::BYTES_PER_PIXEL * (width * height) as u64)?;
        let table = decode_table();
        let plane = |color: usize| -> Vec<f64> {
            match texels {
                Texels::Srgb8(codes) => {
                    codes.chunks_exact(3).map(|c| f64::from(table[usize::from(c[color])])).collect()
                }
                Texels::Linear(values) => {
                    values.chunks_exact(3).map(|c| f64::from(c[color])).collect()
                }
            }
        };
        Self::new(*width, *height, [plane(0), plane(1), plane(2)])
    }

    fn of_named(picture: &Picture, name: &str) -> Result<Self, MeasureError> {
        let size = [picture.width, picture.height];
        check_room(size, Self::BYTES_PER_PIXEL * (picture.width * picture.height) as u64)?;
        let plane = |channel: &str| {
            let samples = &picture.channel(channel)?.samples;
            Some((0..samples.len()).map(|i| samples.get(i)).collect::<Vec<f64>>())
        };
        let color = |channel: &str| {
            plane(channel).ok_or_else(|| MeasureError::Channel {
                name: name.to_owned(),
                problem: format!("has no channel `{channel}`"),
            })
        };
        let light = [color("R")?, color("G")?, color("B")?];
        Ok(Self::named(name, size, light)?.with_flight(plane))
    }

    /// A view of light alone, if that is finite and there is any.
    fn named(
        name: &str,
        [width, height]: [usize; 2],
        light: [Vec<f64>; 3],
    ) -> Result<Self, MeasureError> {
        let size = width * height;
        if size == 0 {
            return Err(MeasureError::EmptyRegion);
        }
        for (channel, plane) in CHANNELS.into_iter().zip(&light) {
            if plane.len() != size {
                let (first, second) = ([width, height], [plane.len(), 1]);
                return Err(MeasureError::SizesDiffer { first, second });
            }
            if let Some(at) = plane.iter().position(|value| !value.is_finite()) {
                let (column, row) = (at % width, at / width);
                let problem = format!(
                    "has a pixel in channel `{channel}` that is not a finite number, in column {column} and row {row}"
                );
                return Err(MeasureError::Channel { name: name.to_owned(), problem });
            }
        }
        let (time_of_flight, time_of_flight_difference, delivered) = (None, None, None);
        Ok(Self { width, height, light, time_of_flight, time_of_flight_difference, delivered })
    }

    /// The same view with the times and powers that there are, where they are of its size.
    fn with_flight(self, plane: impl Fn(&str) -> Option<Vec<f64>>) -> Self {
        let size = self.pixels();
        let [time_of_flight, time_of_flight_difference, delivered] =
            [FLIGHT, FLIGHT_DIFFERENCE, DELIVERED]
                .map(|name| plane(name).filter(|values| values.len() == size));
        Self { time_of_flight, time_of_flight_difference, delivered, ..self }
    }
}

/// Refuses work on pictures that takes more memory than there is.
fn check_room([width, height]: [usize; 2], needed: u64) -> Result<(), MeasureError> {
    memory::check(needed, u64::MAX).map_err(|shortage| MeasureError::TooLarge {
        width,
        height,
        shortage,
    })
}

/// The channels of an EXR file that has been found sound.
fn read_exr(path: &Path) -> Result<Vec<(String, Vec<f64>)>, String> {
    let read = || -> Result<_, Box<dyn Error>> {
        for header in &MetaData::read_from_file(path, false)?.headers {
            let bytes = header.channels.bytes_per_pixel as u64;
            memory::check(
                (bytes + View::BYTES_PER_PIXEL) * header.layer_size.area() as u64,
                u64::MAX,
            )?;
        }
        let image = exr::prelude::read_first_flat_layer_from_file(path)?;
        let channels = &image.layer_data.channel_data.list;
        let wanted = channels.iter().filter_map(|channel| {
            let name = channel.name.to_string();
            CHANNELS.contains(&&*name).then_some((name, &channel.sample_data))
        });
        Ok(wanted
            .map(|(name, data)| (name, data.values_as_f32().map(f64::from).collect()))
            .collect())
    };
    // A panic inside the decoder (a bug set off by a damaged file) becomes an error.
    catch_unwind(AssertUnwindSafe(read))
        .map_err(|_| "the decoder gave up".to_owned())?
        .map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{self, Channel, Samples};

    fn picture() -> Picture {
        let plane = |name: &str, samples| Channel { name: name.to_owned(), samples };
        Picture {
            width: 2,
            height: 3,
            channels: vec![
                plane("R", Samples::F32(vec![0.0, 0.25, 0.5, 0.75, 1.0, 2.0])),
                plane("G", Samples::F32(vec![0.5; 6])),
                plane("B", Samples::F32(vec![0.125; 6])),
                plane(FLIGHT, Samples::F64(vec![5.0, f64::NAN, 5.5, 5.0, 5.0, 5.0])),
                plane(DELIVERED, Samples::F32(vec![1.0; 6])),
            ],
            metadata: Vec::new(),
        }
    }

    #[test]
    fn files_hold_what_was_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let expected = View::of(&picture()).expect("a view");
        for name in ["a.npz", "a.exr"] {
            let path = folder.path().join(name);
            output::write(&picture(), &path).expect("written");
            let view = View::read(&path).expect(name);
            assert_eq!(view.light, expected.light, "{name}");
            assert_eq!(view.delivered, expected.delivered, "{name}");
            let times = view.time_of_flight.expect(name);
            assert!(times[1].is_nan() && times[2] == 5.5, "{name}");
            assert_eq!(view.time_of_flight_difference, None);
        }
        let path = folder.path().join("a.png");
        output::write(&picture(), &path).expect("written");
        let view = View::read(&path).expect("a PNG");
        // Eight bits, and nothing above 1.
        assert!((view.light[0][1] - 0.25).abs() < 0.004 && view.light[0][5] == 1.0);
        assert_eq!(view.time_of_flight, None);
    }

    #[test]
    fn bad_pictures_are_refused_by_name_and_place() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("bad.npz");
        let mut bad = picture();
        bad.channels[1].samples = Samples::F32(vec![0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0]);
        output::write(&bad, &path).expect("written");
        let message = View::read(&path).expect_err("must fail").to_string();
        assert!(message.contains("`G`") && message.contains("bad.npz"), "{message}");
        assert!(message.contains("column 1 and row 1"), "{message}");
        bad.channels.remove(2);
        bad.channels.remove(1);
        output::write(&bad, &path).expect("written");
        let message = View::read(&path).expect_err("must fail").to_string();
        assert!(message.contains("no channel `G`"), "{message}");
        std::fs::write(&path, b"no archive").expect("written");
        assert!(View::read(&path).expect_err("must fail").to_string().contains("cannot read"));
        assert!(View::read(Path::new("a.gif")).is_err());
    }
}
