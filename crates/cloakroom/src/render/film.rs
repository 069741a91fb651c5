//! The film: the channels of a picture while it is being exposed, band by band.

use super::Channel;
use crate::output::{Channel as FileChannel, Samples};

/// The planes of a picture, row by row.
pub(super) struct Film {
    width: usize,
    planes: Vec<(Channel, Plane)>,
}

enum Plane {
    Single(Vec<f32>),
    Double(Vec<f64>),
}

/// A band of rows of every plane, to be exposed by one thread.
pub(super) struct Band<'f> {
    pub first_row: usize,
    planes: Vec<(Channel, BandPlane<'f>)>,
}

enum BandPlane<'f> {
    Single(&'f mut [f32]),
    Double(&'f mut [f64]),
}

impl Film {
    pub fn new(width: usize, height: usize, channels: &[Channel]) -> Self {
        let planes = channels
            .iter()
            .map(|channel| {
                let plane = if channel.is_time() {
                    Plane::Double(vec![0.0; width * height])
                } else {
                    Plane::Single(vec![0.0; width * height])
                };
                (*channel, plane)
            })
            .collect();
        Self { width, planes }
    }

    /// The film in bands of `rows` rows.
    pub fn bands(&mut self, rows: usize) -> Vec<Band<'_>> {
        let mut bands: Vec<Band<'_>> = Vec::new();
        for (channel, plane) in &mut self.planes {
            let size = self.width * rows;
            let pieces: Vec<BandPlane<'_>> = match plane {
                Plane::Single(values) => values.chunks_mut(size).map(BandPlane::Single).collect(),
                Plane::Double(values) => values.chunks_mut(size).map(BandPlane::Double).collect(),
            };
            for (index, piece) in pieces.into_iter().enumerate() {
                if index == bands.len() {
                    bands.push(Band { first_row: index * rows, planes: Vec::new() });
                }
                bands[index].planes.push((*channel, piece));
            }
        }
        bands
    }

    /// The channels as they go into a file.
    pub fn into_channels(self) -> Vec<FileChannel> {
        self.planes
            .into_iter()
            .map(|(channel, plane)| FileChannel {
                name: channel.name().to_owned(),
                samples: match plane {
                    Plane::Single(values) => Samples::F32(values),
                    Plane::Double(values) => Samples::F64(values),
                },
            })
            .collect()
    }
}

impl Band<'_> {
    /// Sets the pixel at `index`, counted row by row from the start of the band, from a function
    /// that gives the value of each channel.
    pub fn set(&mut self, index: usize, value: impl Fn(Channel) -> f64) {
        for (channel, plane) in &mut self.planes {
            match plane {
                BandPlane::Single(values) => values[index] = value(*channel) as f32,
                BandPlane::Double(values) => values[index] = value(*channel),
            }
        }
    }

    /// How many pixels the band holds.
    pub fn len(&self) -> usize {
        self.planes.first().map_or(0, |(_, plane)| match plane {
            BandPlane::Single(values) => values.len(),
            BandPlane::Double(values) => values.len(),
        })
    }
}
