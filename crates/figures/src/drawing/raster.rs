//! Drawings as pixels.

use super::super::IllustrationError;
use super::markup::png;
use super::{Drawing, Shape};
use cloakroom::output::RgbImage;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{ImageHrefResolver, ImageKind, Options, Tree};
use std::sync::Arc;

impl Drawing {
    /// The drawing in pixels: its SVG rasterized.
    ///
    /// # Errors
    ///
    /// If that many pixels do not fit into the memory.
    pub fn to_image(&self, [width, height]: [u32; 2]) -> Result<RgbImage, IllustrationError> {
        let too_large = || IllustrationError::TooLarge { width, height };
        // Four bytes a pixel, and three for the copy without opacity; of images a PNG, and four
        // bytes a pixel.
        let images = self.elements.iter().map(|element| match &element.shape {
            Shape::Image { image, .. } => 7 * u64::from(image.width()) * u64::from(image.height()),
            _ => 0,
        });
        let needed = 7 * u64::from(width) * u64::from(height) + images.sum::<u64>();
        if cloakroom::memory::available().is_some_and(|available| needed > available) {
            return Err(too_large());
        }
        let mut pixels = Pixmap::new(width, height).ok_or_else(too_large)?;
        // Images are handed over by their place among the elements.
        let size = [width, height].map(|side| side.to_string());
        let svg = self.markup(size, "", &[], &|index, _| Some(index.to_string()));
        let image = |name: &str| match &self.elements.get(name.parse::<usize>().ok()?)?.shape {
            Shape::Image { image, .. } => Some(ImageKind::PNG(Arc::new(png(image)?))),
            _ => None,
        };
        let resolver = ImageHrefResolver {
            resolve_string: Box::new(move |name, _| image(name)),
            ..ImageHrefResolver::default()
        };
        let options = Options { image_href_resolver: resolver, ..Options::default() };
        // Our own SVG is sound; only a size beyond what it can say is not.
        let tree = Tree::from_str(&svg, &options).map_err(|_| too_large())?;
        resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
        // The paper is opaque, so the colours are not multiplied by anything.
        let colors = pixels.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        RgbImage::from_raw(width, height, colors).ok_or_else(too_large)
    }
}
