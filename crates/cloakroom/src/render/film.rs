//! The film: the channels of a picture while it is being exposed, band by band.

use super::{ChannelKind, Tile};
use crate::color::BINS;
use crate::output::{Channel, Samples};

/// The planes of a picture, row by row.
pub(super) struct Film {
    tile: Tile,
    planes: Vec<(ChannelKind, Samples)>,
}

/// A band of rows of every plane, to be exposed by one thread.
pub(super) struct Band<'f> {
    /// Column and row of its first pixel in the whole picture.
    pub corner: [usize; 2],
    /// Pixels in a row.
    pub width: usize,
    /// How many rows it has.
    pub rows: usize,
    planes: Vec<(ChannelKind, BandPlane<'f>)>,
}

enum BandPlane<'f> {
    F32(&'f mut [f32]),
    Rgb(&'f mut [[f32; 3]]),
    Bins(&'f mut [[f32; BINS]]),
    F64(&'f mut [f64]),
}

impl Film {
    /// For a tile of a picture.
    pub fn new(tile: Tile, channels: &[ChannelKind]) -> Self {
        let pixels = tile.width as usize * tile.height as usize;
        let planes = channels.iter().map(|channel| (*channel, channel.blank(pixels))).collect();
        Self { tile, planes }
    }

    /// The film in bands of `rows` rows.
    pub fn bands(&mut self, rows: usize) -> Vec<Band<'_>> {
        let Tile { left, top, width, height } = self.tile;
        let [left, top, width, height] = [left, top, width, height].map(|side| side as usize);
        let band = |first: usize| Band {
            corner: [left, top + first],
            width,
            rows: rows.min(height - first),
            planes: Vec::new(),
        };
        let mut bands: Vec<Band<'_>> = (0..height).step_by(rows).map(band).collect();
        for (channel, plane) in &mut self.planes {
            let size = width * rows;
            let pieces: Vec<BandPlane<'_>> = match plane {
                Samples::F32(values) => values.chunks_mut(size).map(BandPlane::F32).collect(),
                Samples::Rgb(values) => values.chunks_mut(size).map(BandPlane::Rgb).collect(),
                Samples::Bins(values) => values.chunks_mut(size).map(BandPlane::Bins).collect(),
                Samples::F64(values) => values.chunks_mut(size).map(BandPlane::F64).collect(),
            };
            for (band, piece) in bands.iter_mut().zip(pieces) {
                band.planes.push((*channel, piece));
            }
        }
        bands
    }

    /// The channels as they go into a file.
    pub fn into_channels(self) -> Vec<Channel> {
        self.planes
            .into_iter()
            .map(|(channel, samples)| Channel { name: channel.name().to_owned(), samples })
            .collect()
    }
}

impl Band<'_> {
    /// Sets the pixel at `index`, counted row by row from the start of the band, from a function
    /// that gives the value of each channel; red 0, green 1 and blue 2 of it where it holds colors, the
    /// bins of a spectrum by their numbers.
    pub fn set(&mut self, index: usize, value: impl Fn(ChannelKind, usize) -> f64) {
        for (channel, plane) in &mut self.planes {
            match plane {
                BandPlane::F32(values) => values[index] = value(*channel, 0) as f32,
                BandPlane::F64(values) => values[index] = value(*channel, 0),
                BandPlane::Rgb(values) => {
                    values[index] = std::array::from_fn(|color| value(*channel, color) as f32);
                }
                BandPlane::Bins(values) => {
                    values[index] = std::array::from_fn(|bin| value(*channel, bin) as f32);
                }
            }
        }
    }
}
