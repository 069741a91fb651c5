//! Whether an EXR file can be decoded within bounds.
//!
//! The size that counts for memory is not that of the picture (the display window) but that of the
//! stored layer and of its blocks, which a damaged header can make anything. The decoder takes this
//! memory unasked.

use std::io::Cursor;

use exr::meta::MetaData;
use exr::meta::header::Header;

use super::linear_image::{MAX_MEMORY, MAX_PIXELS};

/// Largest block, in bytes: as many blocks as there are threads are decoded at once.
const MAX_BLOCK: u64 = 512 << 20;

/// True if the layers of an EXR file and their blocks keep within the limits, or if the header
/// cannot be read, which the decoder will say better.
pub(super) fn are_kept(bytes: &[u8]) -> bool {
    MetaData::read_from_buffered(Cursor::new(bytes), false)
        .map_or(true, |file| file.headers.iter().all(header_keeps_limits))
}

fn header_keeps_limits(header: &Header) -> bool {
    let (layer, block) = (header.layer_size, header.max_block_pixel_size());
    let per_pixel = header.channels.bytes_per_pixel as u64;
    let area = |width: usize, height: usize| (width as u64).checked_mul(height as u64);
    let within = |pixels: Option<u64>, limit: u64| {
        pixels.and_then(|pixels| pixels.checked_mul(per_pixel)).is_some_and(|bytes| bytes <= limit)
    };
    let pixels = area(layer.width(), layer.height());
    // Blocks end where the layer does.
    let block = area(block.width().min(layer.width()), block.height().min(layer.height()));
    pixels.is_some_and(|pixels| pixels <= MAX_PIXELS)
        && within(pixels, MAX_MEMORY)
        && within(block, MAX_BLOCK)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(width: usize, height: usize) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let pixels = |_| (0.5_f32, 0.5_f32, 0.5_f32);
        let channels = exr::prelude::SpecificChannels::rgb(pixels);
        let image = exr::prelude::Image::from_channels((width, height), channels);
        exr::prelude::WritableImage::write(&image).to_buffered(&mut bytes).expect("a file");
        bytes.into_inner()
    }

    /// Changes the right and bottom edge in the header.
    fn stretch(bytes: &mut [u8], attribute: &[u8], right: i32, bottom: i32) {
        let name = bytes.windows(attribute.len()).position(|window| window == attribute);
        // Behind the name, the type `box2i`, the size, left and top.
        let at = name.expect("the attribute") + attribute.len() + 1 + 6 + 4 + 8;
        bytes[at..at + 4].copy_from_slice(&right.to_le_bytes());
        bytes[at + 4..at + 8].copy_from_slice(&bottom.to_le_bytes());
    }

    #[test]
    fn honest_files_pass() {
        assert!(are_kept(&file(30, 20)));
        assert!(are_kept(b"not an EXR file"));
    }

    #[test]
    fn a_huge_layer_behind_a_small_picture_does_not() {
        let mut bytes = file(30, 20);
        stretch(&mut bytes, b"dataWindow", 30_000, 30_000);
        assert!(!are_kept(&bytes));
        stretch(&mut bytes, b"dataWindow", 1 << 24, 1 << 8);
        assert!(!are_kept(&bytes));
        stretch(&mut bytes, b"dataWindow", 60, 40);
        assert!(are_kept(&bytes));
    }
}
