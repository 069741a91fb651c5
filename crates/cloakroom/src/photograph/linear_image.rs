//! Images in linear light, and how large they may be.

/// Largest number of pixels of an image.
pub(super) const MAX_PIXELS: u64 = 400_000_000;

/// Largest memory an image may take while it is read, in bytes.
pub(super) const MAX_MEMORY: u64 = 4 << 30;

/// An image in linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearImage {
    /// Width in pixels, at least 1.
    pub width: usize,
    /// Height in pixels, at least 1.
    pub height: usize,
    /// The pixels, row by row from the top left.
    pub texels: Texels,
}

/// Red, green and blue of each pixel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// 8-bit sRGB values, which stand for the linear light of [`super::decode_table`]. A quarter
    /// of the memory of floats, and no less exact.
    Srgb8(Vec<u8>),
    /// Linear light.
    Linear(Vec<f32>),
}
