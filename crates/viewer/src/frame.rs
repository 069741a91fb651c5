//! Pictures on their way to a page: four bytes of length, JSON of that length, then RGBA.

use cloakroom::output::RgbImage;
use serde_json::Value;

/// The bytes of a picture.
pub(crate) fn encode(caption: &Value, image: &RgbImage) -> Vec<u8> {
    let caption = caption.to_string().into_bytes();
    let pixels = image.as_raw();
    let mut bytes = Vec::with_capacity(4 + caption.len() + pixels.len() / 3 * 4);
    bytes.extend((caption.len() as u32).to_le_bytes());
    bytes.extend(caption);
    for pixel in pixels.chunks_exact(3) {
        bytes.extend([pixel[0], pixel[1], pixel[2], 255]);
    }
    bytes
}
