//! Where images come from, and why they cannot be used.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::keys::BUILT_IN_PREFIX;

use super::load::{LinearImage, MAX_MEMORY, MAX_PIXELS};

/// The images that come with the program, by name: those of [`BUILT_IN_IMAGES`](crate::keys::BUILT_IN_IMAGES).
const BUILT_IN: [(&str, &[u8]); 1] = [("bookshelf", include_bytes!("../../assets/bookshelf.jpg"))];

/// Where an image comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum ImageSource {
    /// One of the images that come with the program, by its name without `builtin:`.
    BuiltIn(&'static str),
    /// An image file.
    File(PathBuf),
    /// An image that is in memory already: see [`ImageSource::memory`].
    Memory(Arc<LinearImage>),
}

impl ImageSource {
    /// The bytes of a built-in image.
    pub(super) fn built_in(name: &str) -> Option<&'static [u8]> {
        BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, bytes)| *bytes)
    }

    /// An image that is in memory already.
    ///
    /// # Errors
    ///
    /// [`LoadError`] where it has no pixels or too many, its texels are not as many, or one of them is not
    /// finite.
    pub fn memory(image: LinearImage) -> Result<Self, LoadError> {
        let source = Self::Memory(Arc::new(image));
        if let Self::Memory(image) = &source {
            image.check(&source)?;
        }
        Ok(source)
    }

    /// The image that a key of a scene names.
    #[must_use]
    pub fn named(name: &Path) -> Self {
        let text = name.to_string_lossy();
        let built_in = text.strip_prefix(BUILT_IN_PREFIX);
        let built_in = built_in.and_then(|name| BUILT_IN.iter().find(|(known, _)| *known == name));
        built_in.map_or_else(|| Self::File(name.to_owned()), |(known, _)| Self::BuiltIn(known))
    }
}

impl std::fmt::Display for ImageSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BuiltIn(name) => write!(f, "{BUILT_IN_PREFIX}{name}"),
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Memory(image) => write!(f, "array:{}x{}", image.width, image.height),
        }
    }
}

/// Why an image cannot be used. Each message names the image.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// There is no such file.
    #[error("there is no image file {image}")]
    Missing {
        /// The image.
        image: ImageSource,
    },
    /// The path is a folder.
    #[error("{image} is a folder, not an image file")]
    Folder {
        /// The image.
        image: ImageSource,
    },
    /// The operating system refuses to read the file.
    #[error("cannot read {image}: {reason}")]
    Unreadable {
        /// The image.
        image: ImageSource,
        /// What the operating system says.
        reason: io::Error,
    },
    /// The file has no bytes.
    #[error("{image} is empty")]
    Empty {
        /// The image.
        image: ImageSource,
    },
    /// The file is no image, or of a kind that is not known.
    #[error("{image} is not an image that can be read (PNG, JPEG or EXR)")]
    NotAnImage {
        /// The image.
        image: ImageSource,
    },
    /// An image of a kind that is known but not read.
    #[error("{image} is a {format} image; only PNG, JPEG and EXR can be read")]
    OtherFormat {
        /// The image.
        image: ImageSource,
        /// The kind.
        format: String,
    },
    /// The file ends early or is damaged.
    #[error("{image} is damaged or cut short: {reason}")]
    Damaged {
        /// The image.
        image: ImageSource,
        /// What the decoder says.
        reason: String,
    },
    /// The image uses a feature of its format that is not read.
    #[error("{image} uses a feature that is not supported: {reason}")]
    Unsupported {
        /// The image.
        image: ImageSource,
        /// What the decoder says.
        reason: String,
    },
    /// The image has no pixels.
    #[error("{image} has no pixels ({width} x {height})")]
    NoPixels {
        /// The image.
        image: ImageSource,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The image has too many pixels, or would take too much memory.
    #[error(
        "{image} is too large: at most {} million pixels and {} GiB of memory are allowed",
        MAX_PIXELS / 1_000_000,
        MAX_MEMORY >> 30
    )]
    TooLarge {
        /// The image.
        image: ImageSource,
    },
    /// An image in memory has not as many texels as its size says.
    #[error("{image} has {count} texels")]
    WrongCount {
        /// The image.
        image: ImageSource,
        /// How many there are.
        count: usize,
    },
    /// A pixel of an EXR image or of one in memory is infinite or not a number.
    #[error("{image} has a pixel that is not a finite number, in column {column} and row {row}")]
    NotFinite {
        /// The image.
        image: ImageSource,
        /// Column of the first such pixel, from 0.
        column: usize,
        /// Row of the first such pixel, from 0.
        row: usize,
    },
}
