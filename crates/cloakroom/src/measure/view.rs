//! A picture to be measured.

use super::MeasureError;
use crate::output::{Format, Picture};
use crate::photograph::{ImageSource, LinearImage, Texels, decode_table, load};
use ndarray::Array2;
use ndarray_npy::{NpzReader, ReadNpzError};
use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// The channels of times and power that a view may have.
const FLIGHT: &str = "time_of_flight";
const FLIGHT_DIFFERENCE: &str = "time_of_flight_difference";
const DELIVERED: &str = "delivered";

/// A picture in linear light, with the times and powers that came with it. All planes run row by row from
/// the top left.
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
        Self {
            width,
            height,
            light,
            time_of_flight: None,
            time_of_flight_difference: None,
            delivered: None,
        }
        .checked("the picture")
    }

    /// A rendered picture as a view.
    ///
    /// # Errors
    ///
    /// If it has no image, or one with a number that is not finite.
    pub fn of(picture: &Picture) -> Result<Self, MeasureError> {
        let plane = |name: &str| {
            let samples = &picture.channel(name)?.samples;
            Some((0..samples.len()).map(|i| samples.get(i)).collect::<Vec<f64>>())
        };
        Self::from_planes("the picture", [picture.width, picture.height], plane)
    }

    /// Reads a view from a file, as its ending says: NPZ and EXR hold linear light in `R`, `G` and `B`, times
    /// of flight and powers; PNG is decoded from sRGB.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, or holds no image or one with a number that is not finite.
    pub fn read(path: &Path) -> Result<Self, MeasureError> {
        let unreadable =
            |reason: String| MeasureError::Unreadable { path: path.to_owned(), reason };
        match Format::of(path) {
            Err(_) => Err(unreadable("its ending is not .png, .exr or .npz".to_owned())),
            Ok(Format::Png) => Self::of_image(path),
            Ok(Format::Exr) => {
                let mut view = Self::of_image(path)?;
                let planes = read_exr(path).map_err(unreadable)?;
                let size = view.width * view.height;
                let find = |name: &str| {
                    planes.iter().find(|(known, values)| known == name && values.len() == size)
                };
                let plane = |name: &str| find(name).map(|(_, values)| values.clone());
                view.time_of_flight = plane(FLIGHT);
                view.time_of_flight_difference = plane(FLIGHT_DIFFERENCE);
                view.delivered = plane(DELIVERED);
                Ok(view)
            }
            Ok(Format::Npz) => {
                let file = File::open(path).map_err(|error| unreadable(error.to_string()))?;
                let mut npz =
                    NpzReader::new(file).map_err(|error| unreadable(error.to_string()))?;
                let name = path.display().to_string();
                let red = npz_plane(&mut npz, "R").map_err(unreadable)?;
                let Some(red) = red else {
                    return Err(MeasureError::MissingChannel { name, channel: "R".to_owned() });
                };
                let (height, width) = red.dim();
                let mut planes = vec![("R", red)];
                for channel in ["G", "B", FLIGHT, FLIGHT_DIFFERENCE, DELIVERED] {
                    let Some(plane) = npz_plane(&mut npz, channel).map_err(unreadable)? else {
                        continue;
                    };
                    if plane.dim() != (height, width) {
                        let (other_height, other_width) = plane.dim();
                        return Err(unreadable(format!(
                            "`R` has {width} x {height} pixels, but `{channel}` {other_width} x \
                             {other_height}"
                        )));
                    }
                    planes.push((channel, plane));
                }
                Self::from_planes(&name, [width, height], |wanted| {
                    let plane = planes.iter().find(|(channel, _)| *channel == wanted);
                    plane.map(|(_, plane)| plane.iter().copied().collect())
                })
            }
        }
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

    fn from_planes(
        name: &str,
        [width, height]: [usize; 2],
        plane: impl Fn(&str) -> Option<Vec<f64>>,
    ) -> Result<Self, MeasureError> {
        let color = |channel: &str| {
            plane(channel).ok_or_else(|| MeasureError::MissingChannel {
                name: name.to_owned(),
                channel: channel.to_owned(),
            })
        };
        Self {
            width,
            height,
            light: [color("R")?, color("G")?, color("B")?],
            time_of_flight: plane(FLIGHT),
            time_of_flight_difference: plane(FLIGHT_DIFFERENCE),
            delivered: plane(DELIVERED),
        }
        .checked(name)
    }

    /// The view, if its light is finite and there is any.
    fn checked(self, name: &str) -> Result<Self, MeasureError> {
        let size = self.pixels();
        if size == 0 {
            return Err(MeasureError::EmptyRegion);
        }
        for (channel, plane) in ["R", "G", "B"].iter().zip(&self.light) {
            if plane.len() != size {
                return Err(MeasureError::SizesDiffer {
                    first: [self.width, self.height],
                    second: [plane.len(), 1],
                });
            }
            if let Some(at) = plane.iter().position(|value| !value.is_finite()) {
                return Err(MeasureError::NotFinite {
                    name: name.to_owned(),
                    channel: (*channel).to_owned(),
                    column: at % self.width,
                    row: at / self.width,
                });
            }
        }
        Ok(self)
    }
}

/// An array of an archive, in either precision; `None` if there is none of that name.
fn npz_plane(npz: &mut NpzReader<File>, name: &str) -> Result<Option<Array2<f64>>, String> {
    let names = npz.names().map_err(|error| error.to_string())?;
    if !names.iter().any(|known| known.trim_end_matches(".npy") == name) {
        return Ok(None);
    }
    let single: Result<Array2<f32>, ReadNpzError> = npz.by_name(name);
    if let Ok(single) = single {
        return Ok(Some(single.mapv(f64::from)));
    }
    npz.by_name(name).map(Some).map_err(|error| format!("`{name}`: {error}"))
}

/// The channels of an EXR file that has been found sound.
fn read_exr(path: &Path) -> Result<Vec<(String, Vec<f64>)>, String> {
    let read = || {
        let image = exr::prelude::read_first_flat_layer_from_file(path)?;
        let channels = image.layer_data.channel_data.list.iter().map(|channel| {
            let samples = channel.sample_data.values_as_f32().map(f64::from).collect();
            (channel.name.to_string(), samples)
        });
        Ok::<_, exr::error::Error>(channels.collect())
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
