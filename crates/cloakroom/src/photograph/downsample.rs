//! Halving an image by exact area averages, whatever its size.

use super::{LinearImage, Texels};

/// The next coarser image: half as wide and high, rounded down, at least 1.
///
/// Each new texel is the average over the part of the image that it covers. Where a side is odd,
/// this part is a little more than two texels, and the average weighs the outer of three texels
/// accordingly, so that the image does not shift.
pub(super) fn halve(image: &LinearImage, table: &[f32; 256]) -> LinearImage {
    let (width, height) = ((image.width / 2).max(1), (image.height / 2).max(1));
    let mut halved = vec![0.0; width * height * 3];
    let size = [image.width, image.height];
    match &image.texels {
        Texels::Srgb8(codes) => {
            halve_into(&mut halved, size, codes, |code| table[usize::from(code)]);
        }
        Texels::Linear(values) => halve_into(&mut halved, size, values, |value| value),
    }
    LinearImage { width, height, texels: Texels::Linear(halved) }
}

fn halve_into<S: Copy>(
    halved: &mut [f32],
    [width, height]: [usize; 2],
    texels: &[S],
    light: impl Fn(S) -> f32,
) {
    let new_width = (width / 2).max(1);
    let rows = halved.chunks_exact_mut(new_width * 3).enumerate();
    if width.is_multiple_of(2) && height.is_multiple_of(2) {
        for ((_, row), pair) in rows.zip(texels.chunks_exact(width * 6)) {
            let (above, below) = pair.split_at(width * 3);
            average_squares(above, below, row, &light);
        }
        return;
    }
    let columns: Vec<Part> = (0..new_width).map(|i| Part::new(i, width)).collect();
    let mut sum = vec![0.0; width * 3];
    for (y, row) in rows {
        let part = Part::new(y, height);
        add_rows(&mut sum, &texels[part.first * width * 3..], part.weights, &light);
        shrink_row(&sum, &columns, row);
    }
}

/// Averages of two by two texels each.
fn average_squares<S: Copy>(above: &[S], below: &[S], row: &mut [f32], light: impl Fn(S) -> f32) {
    // By indices: where code is to be small, iterators are called one by one.
    let (above, below) = (above.as_chunks::<6>().0, below.as_chunks::<6>().0);
    for (i, texel) in row.as_chunks_mut::<3>().0.iter_mut().enumerate() {
        let (a, b) = (&above[i], &below[i]);
        for channel in 0..3 {
            let left = light(a[channel]) + light(b[channel]);
            let right = light(a[channel + 3]) + light(b[channel + 3]);
            texel[channel] = 0.25 * (left + right);
        }
    }
}

/// Weighted sum of two or three rows.
fn add_rows<S: Copy>(sum: &mut [f32], rows: &[S], weights: [f32; 3], light: impl Fn(S) -> f32) {
    let length = sum.len();
    let [first, second, third] = weights;
    if second == 0.0 {
        for (total, &value) in sum.iter_mut().zip(rows) {
            *total = first * light(value);
        }
        return;
    }
    for ((total, &a), &b) in sum.iter_mut().zip(rows).zip(&rows[length..]) {
        *total = first * light(a) + second * light(b);
    }
    if third != 0.0 {
        for (total, &value) in sum.iter_mut().zip(&rows[2 * length..]) {
            *total += third * light(value);
        }
    }
}

/// Weighted sums of up to three texels each.
fn shrink_row(texels: &[f32], columns: &[Part], row: &mut [f32]) {
    for (texel, part) in row.chunks_exact_mut(3).zip(columns) {
        // A row of one texel has but one part.
        for (source, &weight) in texels[part.first * 3..].chunks_exact(3).zip(&part.weights) {
            for (value, light) in texel.iter_mut().zip(source) {
                *value += weight * light;
            }
        }
    }
}

/// The two or three texels under a texel of the next level, and their weights.
struct Part {
    first: usize,
    weights: [f32; 3],
}

impl Part {
    /// Part number `index` of a side of `length` texels.
    fn new(index: usize, length: usize) -> Self {
        let weights = match (length, length % 2) {
            (1, _) => [1.0, 0.0, 0.0],
            (_, 0) => [0.5, 0.5, 0.0],
            _ => {
                let half = length / 2;
                [half - index, half, index + 1].map(|share| share as f32 / length as f32)
            }
        };
        Self { first: index * 2, weights }
    }
}

#[cfg(test)]
mod tests {
    use super::super::decode_table;
    use super::*;

    fn halved(width: usize, height: usize, texels: Texels) -> (usize, usize, Vec<f32>) {
        let LinearImage { width, height, texels } =
            halve(&LinearImage { width, height, texels }, decode_table());
        let Texels::Linear(texels) = texels else { panic!("linear light") };
        (width, height, texels)
    }

    #[test]
    fn keeps_the_mean_for_every_size() {
        for width in 1..=9 {
            for height in 1..=9 {
                let texels: Vec<f32> =
                    (0..width * height * 3).map(|i| ((i * 37) % 101) as f32).collect();
                let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
                let expected = mean(&texels);
                let (new_width, new_height, halved) = halved(width, height, Texels::Linear(texels));
                assert_eq!((new_width, new_height), ((width / 2).max(1), (height / 2).max(1)));
                assert!((mean(&halved) - expected).abs() < 1e-3, "{width} x {height}");
            }
        }
    }

    #[test]
    fn does_not_shift_a_ramp() {
        // The value of a texel is the position of its middle, 0 to 1.
        for width in [7, 8, 33] {
            let ramp: Vec<f32> =
                (0..width).flat_map(|x| [(x as f32 + 0.5) / width as f32; 3]).collect();
            let (new_width, _, halved) = halved(width, 1, Texels::Linear(ramp));
            for x in 0..new_width {
                let middle = (x as f32 + 0.5) / new_width as f32;
                // An odd side's texels are steps, not a ramp: a twentieth of one.
                assert!((halved[x * 3] - middle).abs() < 0.05 / width as f32, "{width}: {x}");
            }
        }
    }

    #[test]
    fn averages_light_not_codes() {
        let codes = Texels::Srgb8(vec![0, 0, 0, 255, 255, 255]);
        let (_, _, halved) = halved(2, 1, codes);
        assert_eq!(halved, vec![0.5; 3]);
    }
}
