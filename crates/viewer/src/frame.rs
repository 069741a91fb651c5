//! Pictures on their way to a page: four bytes of length, JSON of that length, then RGBA.

use cloakroom::output::RgbImage;
use serde::Serialize;

/// What is said of a picture.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Caption {
    /// The look that it answers.
    pub id: u64,
    /// `scene`, or what is shown beside it.
    pub view: &'static str,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Samples a pixel.
    pub samples: u32,
    /// Branches weaker than this were not followed.
    pub min_power: f64,
    /// Whether this is the best that was asked for.
    pub finished: bool,
    /// Whether this is the last of the views that are shown beside each other.
    pub last: bool,
    /// The scale of a map.
    pub scale: Option<Scale>,
}

/// Which colors stand for which numbers.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Scale {
    /// What the numbers are.
    pub title: String,
    /// Their unit.
    pub unit: String,
    /// The number at the lower end, in that unit; `None` if no number is finite.
    pub low: Option<f64>,
    /// That at the upper end.
    pub high: Option<f64>,
}

/// The bytes of a picture.
pub(crate) fn encode(caption: &Caption, image: &RgbImage) -> Vec<u8> {
    let caption = serde_json::to_vec(caption).unwrap_or_default();
    let pixels = image.as_raw();
    let mut bytes = Vec::with_capacity(4 + caption.len() + pixels.len() / 3 * 4);
    bytes.extend((caption.len() as u32).to_le_bytes());
    bytes.extend(caption);
    for pixel in pixels.chunks_exact(3) {
        bytes.extend([pixel[0], pixel[1], pixel[2], 255]);
    }
    bytes
}
