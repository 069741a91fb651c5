//! Smaller copies of images.

use cloakroom::output::{Channel, Picture, RgbImage, Samples, to_srgb};
use cloakroom::photograph::decode_table;
use image::imageops::{self, FilterType};
use image::{Rgb, Rgb32FImage};

/// A copy of an image that fits into a width and a height, keeping its proportions; the image
/// itself if it fits.
///
/// Light is averaged, not its sRGB code, so that fine patterns keep their brightness.
pub(super) fn shrink(image: &RgbImage, max_width: u32, max_height: u32) -> RgbImage {
    let (width, height) = image.dimensions();
    let factor = (f64::from(max_width) / f64::from(width.max(1)))
        .min(f64::from(max_height) / f64::from(height.max(1)));
    if factor >= 1.0 {
        return image.clone();
    }
    let scaled = |length: u32| ((f64::from(length) * factor).round() as u32).max(1);
    let table = decode_table();
    let light = Rgb32FImage::from_fn(width, height, |x, y| {
        Rgb(image.get_pixel(x, y).0.map(|code| table[usize::from(code)]))
    });
    let light = imageops::resize(&light, scaled(width), scaled(height), FilterType::CatmullRom);
    let size = [light.width(), light.height()].map(|side| side as usize);
    srgb(size, &light.pixels().map(|pixel| pixel.0).collect::<Vec<_>>())
}

/// The image of linear light, red, green and blue, row by row.
pub(super) fn srgb([width, height]: [usize; 2], light: &[[f32; 3]]) -> RgbImage {
    let channel = |(i, name): (usize, &str)| {
        let samples = Samples::F32(light.iter().map(|pixel| pixel[i]).collect());
        Channel { name: name.to_owned(), samples }
    };
    let channels = ["R", "G", "B"].into_iter().enumerate().map(channel).collect();
    // It has the channels of an image, all that this can fail for.
    to_srgb(&Picture { width, height, channels, metadata: Vec::new() }).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_images_stay() {
        let image = RgbImage::from_fn(8, 6, |x, y| Rgb([x as u8, y as u8, 7]));
        assert_eq!(shrink(&image, 8, 6), image);
        assert_eq!(shrink(&RgbImage::new(0, 0), 8, 6).dimensions(), (0, 0));
    }

    #[test]
    fn large_images_keep_proportions_and_brightness() {
        let checker = RgbImage::from_fn(400, 300, |x, y| Rgb([255 * ((x + y) % 2) as u8; 3]));
        let small = shrink(&checker, 100, 100);
        assert_eq!(small.dimensions(), (100, 75));
        // Half the light is the code 188.
        assert!(small.pixels().all(|pixel| pixel.0[0].abs_diff(188) <= 1));
        assert_eq!(shrink(&checker, 1000, 30).dimensions(), (40, 30));
        assert_eq!(shrink(&RgbImage::new(9000, 2), 800, 800).dimensions(), (800, 1));
    }
}
