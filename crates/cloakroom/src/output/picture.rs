//! A finished picture: named channels, and what goes into the metadata of its files.

use crate::color::BINS;

/// A picture of named channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// The channels, in the order of files.
    pub channels: Vec<Channel>,
    /// Pairs of key and text that every file carries: scene, version, seed.
    pub metadata: Vec<(String, String)>,
}

/// One channel of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name in files, as in `horizontal.R` or `time_of_flight`.
    pub name: String,
    /// One number a pixel, or one color, row by row from the top left.
    pub samples: Samples,
}

/// The numbers of a channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// In single precision: colours and shares of power.
    F32(Vec<f32>),
    /// Red, green and blue in single precision: the picture of one quantity in linear light.
    Rgb(Vec<[f32; 3]>),
    /// The light in each bin of wavelengths in single precision.
    Bins(Vec<[f32; BINS]>),
    /// In double precision: times, whose differences go down to yoctoseconds.
    F64(Vec<f64>),
}

impl Picture {
    /// The channel of that name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }

    /// The image of a polarizer by itself: the channels `horizontal.R` to `horizontal.B`, say, as
    /// `R` to `B`, and without metadata. With "" for the name, the image through the camera's own.
    /// `None` if the picture has not all three.
    #[must_use]
    pub fn image_through(&self, polarizer: &str) -> Option<Self> {
        let dot = if polarizer.is_empty() { "" } else { "." };
        let channel = |color: &str| {
            let samples = self.channel(&format!("{polarizer}{dot}{color}"))?.samples.clone();
            Some(Channel { name: color.to_owned(), samples })
        };
        let channels = ["R", "G", "B"].into_iter().map(channel).collect::<Option<_>>()?;
        Some(Self { width: self.width, height: self.height, channels, metadata: Vec::new() })
    }
}

impl Samples {
    /// How many numbers there are: three for a color, one for each bin of a spectrum.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::Rgb(values) => 3 * values.len(),
            Self::Bins(values) => BINS * values.len(),
            Self::F64(values) => values.len(),
        }
    }

    /// How many bytes they take.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::F32(_) | Self::Rgb(_) | Self::Bins(_) => 4 * self.len(),
            Self::F64(_) => 8 * self.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number at an index below [`len`](Self::len); red, green and blue of a color follow each
    /// other.
    #[must_use]
    pub fn get(&self, index: usize) -> f64 {
        match self {
            Self::F32(values) => f64::from(values[index]),
            Self::Rgb(values) => f64::from(values[index / 3][index % 3]),
            Self::Bins(values) => f64::from(values[index / BINS][index % BINS]),
            Self::F64(values) => values[index],
        }
    }
}
