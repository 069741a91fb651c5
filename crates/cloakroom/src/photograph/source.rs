//! Where images come from, and why they cannot be used.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::keys::BUILT_IN_PREFIX;
use crate::memory::Shortage;

use super::linear_image::{LinearImage, MAX_MEMORY, MAX_PIXELS, Texels};

/// The images that come with the program, by name: those of
/// [`BUILT_IN_IMAGES`](crate::keys::BUILT_IN_IMAGES).
#[cfg(not(target_arch = "wasm32"))]
const BUILT_IN: [(&str, &[u8]); 2] = [
    ("bookshelf", include_bytes!("../../assets/bookshelf.jpg")),
    ("room", include_bytes!("../../assets/room.jpg")),
];

/// In a browser they are loaded each time: the same, averaged over two by two pixels.
#[cfg(target_arch = "wasm32")]
const BUILT_IN: [(&str, &[u8]); 2] = [
    ("bookshelf", include_bytes!("../../assets/reduced/bookshelf.jpg")),
    ("room", include_bytes!("../../assets/reduced/room.jpg")),
];

/// Light beyond this would be infinite in a picture that adds it up in single precision.
const BRIGHTEST: f32 = 1e30;

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
    /// [`LoadError`] where it has no pixels or too many, its texels are not as many, or one of them
    /// is not finite.
    pub fn memory(image: LinearImage) -> Result<Self, LoadError> {
        let checked = check(&image);
        let image = Self::Memory(Arc::new(image));
        checked.map_err(|problem| LoadError { image: image.clone(), problem })?;
        Ok(image)
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

/// Refuses an image that cannot be looked at.
pub(super) fn check(image: &LinearImage) -> Result<(), LoadProblem> {
    let (width, height) = (image.width, image.height);
    let pixels = width.saturating_mul(height);
    if pixels as u64 > MAX_PIXELS {
        return Err(LoadProblem::TooLarge);
    }
    if pixels == 0 {
        // Below the largest number of pixels, and thus of 32 bits.
        return Err(LoadProblem::NoPixels([width as u32, height as u32]));
    }
    let (count, no_light) = match &image.texels {
        Texels::Srgb8(codes) => (codes.len(), None),
        Texels::Linear(values) => {
            let within = |value: &f32| value.abs() <= BRIGHTEST;
            (values.len(), values.iter().enumerate().find(|(_, value)| !within(value)))
        }
    };
    match no_light {
        _ if count != 3 * pixels => Err(LoadProblem::WrongCount(count)),
        Some((at, value)) => {
            let place = [at / 3 % width, at / 3 / width];
            let finite = value.is_finite();
            Err(if finite { LoadProblem::TooBright(place) } else { LoadProblem::NotFinite(place) })
        }
        None => Ok(()),
    }
}

/// Why an image cannot be used. The message names the image.
#[derive(Debug, thiserror::Error)]
#[error("{}", problem.of(image))]
pub struct LoadError {
    /// The image.
    pub image: ImageSource,
    /// What is wrong with it.
    pub problem: LoadProblem,
}

/// What is wrong with an image: what can be said of it.
#[derive(Debug, thiserror::Error)]
pub enum LoadProblem {
    /// There is no such file.
    #[error("there is no image file")]
    Missing,
    /// The path is a folder.
    #[error("is a folder, not an image file")]
    Folder,
    /// The operating system refuses to read the file, and says why.
    #[error("cannot be read: {0}")]
    Unreadable(io::Error),
    /// The file has no bytes.
    #[error("is empty")]
    Empty,
    /// The file is no image, or of a kind that is not known.
    #[error("is not an image that can be read (PNG, JPEG or EXR)")]
    NotAnImage,
    /// An image of this kind, which is known but not read.
    #[error("is a {0} image; only PNG, JPEG and EXR can be read")]
    OtherFormat(String),
    /// An EXR image, in a page that computes by itself.
    #[error(
        "is an EXR image, which this page cannot read; save it as PNG or JPEG, or open it with `cloakroom view`"
    )]
    NotInBrowser,
    /// The file ends early or is damaged: what the decoder says.
    #[error("is damaged or cut short: {0}")]
    Damaged(String),
    /// The image uses a feature of its format that is not read: what the decoder says.
    #[error("uses a feature that is not supported: {0}")]
    Unsupported(String),
    /// The image has no pixels: its width and height.
    #[error("has no pixels ({} x {})", .0[0], .0[1])]
    NoPixels([u32; 2]),
    /// The image has too many pixels, or would take too much memory.
    #[error(
        "is too large: at most {} million pixels and {} GiB of memory are allowed",
        MAX_PIXELS / 1_000_000, MAX_MEMORY >> 30
    )]
    TooLarge,
    /// An image in memory has not as many texels as its size says, but so many.
    #[error("has {0} texels")]
    WrongCount(usize),
    /// A pixel of an EXR image or of one in memory is infinite or not a number: the column and row
    /// of the first such one, from 0.
    #[error("has a pixel that is not a finite number, in column {} and row {}", .0[0], .0[1])]
    NotFinite([usize; 2]),
    /// A pixel is brighter than light that can be added up: its column and row, from 0.
    #[error("has a pixel beyond {BRIGHTEST:e}, in column {} and row {}", .0[0], .0[1])]
    TooBright([usize; 2]),
    /// An EXR image has several layers of colors, which are called so.
    #[error("has several layers ({0}); write one of them into a file of its own")]
    Layers(String),
    /// An EXR image has no colors but these channels.
    #[error("has the channels {0}; an image has R, G and B, or Y alone")]
    Channels(String),
    /// There is not enough memory for the image.
    #[error(transparent)]
    NoMemory(#[from] Shortage),
}

impl LoadProblem {
    /// The message for an image.
    fn of(&self, image: &ImageSource) -> String {
        match self {
            Self::Missing => format!("{self} {image}"),
            Self::Unreadable(reason) => format!("cannot read {image}: {reason}"),
            _ => format!("{image} {self}"),
        }
    }
}
