//! Where in a pixel its samples lie.
//!
//! Samples depend on the pixel and the seed alone, hence not on tiles or threads. The four pixels
//! of an aligned 2 x 2 block share their offsets, so that differences between neighbours in a
//! block are those of one pixel spacing: the filter's footprint.

use crate::split_mix::mix;

/// Offsets of a pixel's samples, each in [0, 1)²: the centre for a single sample, else the R2
/// low-discrepancy sequence (powers of the inverse of the plastic number), shifted block by block.
pub(super) fn offset(sample: u32, samples: u32, block: [u32; 2], seed: u64) -> [f64; 2] {
    if samples == 1 {
        return [0.5, 0.5];
    }
    const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
    let bits = mix(seed ^ mix(u64::from(block[0]) << 32 | u64::from(block[1])));
    let shift = [unit(bits >> 32), unit(bits & 0xFFFF_FFFF)];
    let n = f64::from(sample);
    // Much faster than `f64::fract` on processors without an instruction for it.
    [0, 1].map(|i| n * STEPS[i] + shift[i]).map(|place| place - (place as i64) as f64)
}

/// 32 random bits as a number in [0, 1).
fn unit(bits: u64) -> f64 {
    bits as f64 / 4_294_967_296.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_fill_the_pixel_evenly() {
        // Every quarter of the pixel gets a fair share of 64 samples, whatever the block.
        for block in [[0, 0], [5, 9], [511, 383]] {
            let mut counts = [0; 4];
            for sample in 0..64 {
                let [x, y] = offset(sample, 64, block, 7);
                assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                counts[usize::from(x >= 0.5) + 2 * usize::from(y >= 0.5)] += 1;
            }
            assert!(counts.iter().all(|count| (13..=19).contains(count)), "{counts:?}");
        }
    }

    #[test]
    fn the_seed_moves_them() {
        assert_ne!(offset(0, 4, [3, 4], 0), offset(0, 4, [3, 4], 1));
        assert_eq!(offset(0, 1, [3, 4], 0), [0.5, 0.5]);
    }
}
