//! Drawings as pixels.

use super::super::IllustrationError;
use super::Drawing;
use crate::output::RgbImage;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

impl Drawing {
    /// The drawing in pixels: its SVG rasterized.
    ///
    /// # Errors
    ///
    /// If that many pixels do not fit into the memory.
    pub fn to_image(&self, [width, height]: [u32; 2]) -> Result<RgbImage, IllustrationError> {
        let too_large = || IllustrationError::TooLarge { width, height };
        // Four bytes a pixel, and three for the copy without opacity.
        let needed = 7 * u64::from(width) * u64::from(height);
        if crate::memory::available().is_some_and(|available| needed > available) {
            return Err(too_large());
        }
        let mut pixels = Pixmap::new(width, height).ok_or_else(too_large)?;
        // Our own SVG is sound; only a size beyond what it can say is not.
        let svg = self.to_svg([width, height], "", &[]);
        let tree = Tree::from_str(&svg, &Options::default()).map_err(|_| too_large())?;
        resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
        // The paper is opaque, so the colours are not multiplied by anything.
        let colors = pixels.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        RgbImage::from_raw(width, height, colors).ok_or_else(too_large)
    }
}
