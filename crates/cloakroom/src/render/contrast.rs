//! Samples where the picture has edges: whether the first ones of a block say all there is to say.

use super::pixel::Pixel;
use crate::photograph::encode;

/// At least so many samples are looked at, and a quarter of those asked for.
const LEAST: u32 = 4;

/// The lowest and the highest of the samples of a 2 x 2 block so far, per colour, as sRGB codes
/// from 0 to 255.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contrast {
    lowest: [f64; 3],
    highest: [f64; 3],
}

impl Contrast {
    pub fn new() -> Self {
        Self { lowest: [f64::INFINITY; 3], highest: [f64::NEG_INFINITY; 3] }
    }

    /// Takes in what one more sample has added to the pixels of the block.
    pub fn add(&mut self, before: &[Pixel; 4], after: &[Pixel; 4]) {
        for (before, after) in before.iter().zip(after) {
            for color in 0..3 {
                let code = srgb_code(after.image[color] - before.image[color]);
                self.lowest[color] = self.lowest[color].min(code);
                self.highest[color] = self.highest[color].max(code);
            }
        }
    }

    /// Whether no two samples differ by more than so many codes.
    pub fn is_within(&self, codes: f64) -> bool {
        (0..3).all(|color| self.highest[color] - self.lowest[color] <= codes)
    }
}

/// After how many of the samples to look whether that is enough.
pub(super) fn first_look(samples: u32) -> u32 {
    LEAST.max(samples.div_ceil(4))
}

/// The sRGB code of linear light, 0 to 255, not rounded.
fn srgb_code(light: f64) -> f64 {
    255.0 * encode(light.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(light: [f64; 4]) -> [Pixel; 4] {
        light.map(|light| Pixel { image: [light; 3], ..Pixel::default() })
    }

    #[test]
    fn any_two_samples_of_the_block_count() {
        let mut contrast = Contrast::new();
        let dark = [Pixel::default(); 4];
        contrast.add(&dark, &block([0.5; 4]));
        assert!(contrast.is_within(0.0));
        // The same light again: sums grow, samples stay.
        contrast.add(&block([0.5; 4]), &block([1.0; 4]));
        assert!(contrast.is_within(1e-9));
        contrast.add(&dark, &block([0.5, 0.5, 0.5, 0.51]));
        assert!(!contrast.is_within(1.0) && contrast.is_within(2.0));
    }

    #[test]
    fn codes_are_those_of_the_standard() {
        assert_eq!(srgb_code(0.0), 0.0);
        assert!((srgb_code(1.0) - 255.0).abs() < 1e-12);
        assert!((srgb_code(0.214_041_14) - 127.5).abs() < 1e-4);
        assert_eq!(srgb_code(f64::MAX), srgb_code(1.0));
    }
}
