//! Where images come from, and why they cannot be used.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::load::{LinearImage, MAX_MEMORY, MAX_PIXELS};

/// The images that come with the program, by name.
const BUILT_IN: [(&str, &[u8]); 1] = [("bookshelf", include_bytes!("../../assets/bookshelf.jpg"))];

/// What a built-in image's name begins with.
const BUILT_IN_PREFIX: &str = "builtin:";

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
    /// What a scene's `image = "..."` means: `builtin:NAME`, or a file, relative to `folder`.
    ///
    /// # Errors
    ///
    /// [`LoadError::UnknownBuiltIn`] for a built-in name that does not exist. Files are looked at
    /// only by [`super::load()`] and [`super::dimensions`].
    pub fn parse(text: &str, folder: &Path) -> Result<Self, LoadError> {
        let Some(name) = text.strip_prefix(BUILT_IN_PREFIX) else {
            return Ok(Self::File(folder.join(text)));
        };
        BUILT_IN
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(known, _)| Self::BuiltIn(known))
            .ok_or_else(|| LoadError::UnknownBuiltIn { name: name.to_owned() })
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

    /// The bytes of a built-in image.
    pub(super) fn built_in(name: &str) -> Option<&'static [u8]> {
        BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, bytes)| *bytes)
    }

    /// The images that come with the program, as written in a scene: `builtin:NAME`.
    pub fn built_in_names() -> impl Iterator<Item = String> {
        BUILT_IN.iter().map(|(name, _)| format!("{BUILT_IN_PREFIX}{name}"))
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
    /// No built-in image has this name.
    #[error(
        "there is no built-in image `{BUILT_IN_PREFIX}{name}`; there is {}",
        ImageSource::built_in_names().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
    )]
    UnknownBuiltIn {
        /// The name asked for, without `builtin:`.
        name: String,
    },
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
