//! Normalized cross-correlation, as cloaks were judged by before: Halimeh, Schmied & Wegener, Opt.
//! Express 19, 6078 (2011).

use super::{MeasureError, PixelMask, View};
use num_complex::Complex64;
use rayon::prelude::*;
use rustfft::algorithm::butterflies::Butterfly3;
use rustfft::algorithm::{MixedRadix, Radix4};
use rustfft::{Fft, FftDirection};
use serde::Serialize;
use std::sync::Arc;

/// A shift counts only if at least this share of the region's pixels stays in the picture.
const LEAST_OVERLAP: f64 = 0.5;

/// Where the contrast that is left after a shift is below this share of the whole, it is rounding.
const ROUNDING: f64 = 1e-10;

/// The largest correlation over all shifts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BestShift {
    /// The correlation, -1 to 1.
    pub correlation: f64,
    /// By how many pixels the second picture lies to the right of and below the first.
    pub shift_pixels: [i64; 2],
}

/// The zero-mean normalized cross-correlation of two planes over a region, -1 to 1; `None` where
/// either has no contrast there.
///
/// Planes and region must be of one size.
#[must_use]
pub fn correlation(a: &[f64], b: &[f64], region: &PixelMask) -> Option<f64> {
    pearson(region.indices().map(|i| (a[i], b[i])))
}

/// Pearson's coefficient of pairs of numbers.
fn pearson(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> Option<f64> {
    let (mut count, mut sums) = (0.0, [0.0; 2]);
    for (a, b) in pairs.clone() {
        count += 1.0;
        sums[0] += a;
        sums[1] += b;
    }
    let [mean_a, mean_b] = sums.map(|sum| sum / count);
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        let (a, b) = (a - mean_a, b - mean_b);
        aa += a * a;
        bb += b * b;
        ab += a * b;
    }
    // Less is what rounding leaves of an even plane.
    let contrast = |square: f64, mean: f64| square > 1e-24 * count * mean * mean && square > 0.0;
    (contrast(aa, mean_a) && contrast(bb, mean_b))
        .then(|| (ab / (aa.sqrt() * bb.sqrt())).clamp(-1.0, 1.0))
}

/// The largest correlation of what the region of the second view shows with the first view, over
/// all shifts of whole pixels that leave at least half of the region in the picture; for red, green
/// and blue. Means and contrasts are those of the overlap (Padfield, IEEE Trans. Image Process. 21,
/// 2706 (2012)).
///
/// # Errors
///
/// If there is not enough memory.
pub fn best_shift(
    a: &View,
    b: &View,
    region: &PixelMask,
) -> Result<[Option<BestShift>; 3], MeasureError> {
    let transform = Transform::new(a)?;
    let everywhere = transform.forward(|_| Complex64::ONE);
    let inside = transform.forward(|i| f64::from(u8::from(region.mask[i])).into());
    let count = transform.correlate(&everywhere, &inside);
    let best = |color: usize| {
        transform.best(&a.light[color], &b.light[color], region, &everywhere, &inside, &count)
    };
    Ok([0, 1, 2].map(best))
}

/// Refuses views for whose [`best_shift`] there is not enough memory.
///
/// # Errors
///
/// [`MeasureError::TooLarge`].
pub(super) fn check_memory(view: &View) -> Result<(), MeasureError> {
    Transform::field(view).map(drop)
}

/// Fourier transforms of planes laid into a field of zeros so large that no shift wraps around.
/// Spectra are kept column by column.
struct Transform {
    /// Size of the planes.
    width: usize,
    height: usize,
    /// Size of the field.
    field: [usize; 2],
    rows: [Arc<dyn Fft<f64>>; 2],
    columns: [Arc<dyn Fft<f64>>; 2],
}

impl Transform {
    fn new(view: &View) -> Result<Self, MeasureError> {
        let (width, height) = (view.width, view.height);
        let field = Self::field(view)?;
        let plan = |side| [FftDirection::Forward, FftDirection::Inverse].map(|way| fft(side, way));
        let (rows, columns) = (plan(field[0]), plan(field[1]));
        Ok(Self { width, height, field, rows, columns })
    }

    /// The size of the field for a view.
    fn field(view: &View) -> Result<[usize; 2], MeasureError> {
        let field = [view.width, view.height].map(|side| smooth(2 * side));
        // Two masks, four spectra and three correlations of a channel, and a copy.
        view.check_room(10 * 16 * field[0] as u64 * field[1] as u64)?;
        Ok(field)
    }

    /// The spectrum of a plane.
    fn forward(&self, value: impl Fn(usize) -> Complex64) -> Vec<Complex64> {
        let [across, down] = self.field;
        let mut field = vec![Complex64::ZERO; across * down];
        for y in 0..self.height {
            for x in 0..self.width {
                field[y * across + x] = value(y * self.width + x);
            }
        }
        transform_rows(&mut field[..self.height * across], &self.rows[0]);
        let mut field = transposed(&field, across);
        transform_rows(&mut field, &self.columns[0]);
        field
    }

    /// The cross-correlation sum_x a(x) b(x + s) at every shift s, modulo the field.
    fn correlate(&self, a: &[Complex64], b: &[Complex64]) -> Vec<Complex64> {
        let [across, down] = self.field;
        let mut field: Vec<Complex64> = a.iter().zip(b).map(|(a, b)| a.conj() * b).collect();
        transform_rows(&mut field, &self.columns[1]);
        let mut field = transposed(&field, down);
        transform_rows(&mut field, &self.rows[1]);
        let size = (across * down) as f64;
        field.iter_mut().for_each(|value| *value /= size);
        field
    }

    /// The best shift of one channel.
    fn best(
        &self,
        a: &[f64],
        b: &[f64],
        region: &PixelMask,
        everywhere: &[Complex64],
        inside: &[Complex64],
        count: &[Complex64],
    ) -> Option<BestShift> {
        let mean = |plane: &[f64]| plane.iter().sum::<f64>() / plane.len() as f64;
        let (mean_a, mean_b) = (mean(a), mean(b));
        let in_region = |i: usize| if region.mask[i] { b[i] - mean_b } else { 0.0 };
        let a_once = self.forward(|i| (a[i] - mean_a).into());
        let b_once = self.forward(|i| in_region(i).into());
        let cross = self.correlate(&a_once, &b_once);
        drop((a_once, b_once));
        // Sums and sums of squares in one: of real planes, they are the two parts. The conjugate of
        // the first factor turns the sign of its squares.
        let both = |value: f64| Complex64::new(value, value * value);
        let sums_a = self.correlate(&self.forward(|i| both(a[i] - mean_a)), inside);
        let sums_b = self.correlate(everywhere, &self.forward(|i| both(in_region(i))));
        let contrast = |n: f64, sum: f64, squares: f64| squares - sum * sum / n;
        let least = LEAST_OVERLAP * region.pixels() as f64;
        let all = |sums: &[Complex64]| sums.iter().map(|s| s.im.abs()).fold(0.0, f64::max);
        let (all_a, all_b) = (all(&sums_a), all(&sums_b));
        let at = |i: usize| {
            let n = count[i].re.round();
            if n < least {
                return None;
            }
            let aa = contrast(n, sums_a[i].re, -sums_a[i].im);
            let bb = contrast(n, sums_b[i].re, sums_b[i].im);
            let sound = aa > ROUNDING * all_a && bb > ROUNDING * all_b;
            let ab = cross[i].re - sums_a[i].re * sums_b[i].re / n;
            sound.then(|| (i, ab / (aa * bb).sqrt()))
        };
        // Where a pattern repeats itself, the nearest of the best.
        let far = |i: usize| self.shift(i).iter().map(|s| s * s).sum::<i64>();
        let found =
            (0..count.len()).filter_map(at).fold(None, |best: Option<(usize, f64)>, next| {
                let better = |best: &(usize, f64)| {
                    let gain = next.1 - best.1;
                    gain > ROUNDING || (gain.abs() <= ROUNDING && far(next.0) < far(best.0))
                };
                best.filter(|best| !better(best)).or(Some(next))
            });
        // The sums again, without the rounding of the transform.
        let still = correlation(a, b, region)
            .map(|correlation| BestShift { correlation, shift_pixels: [0; 2] });
        let moved = found.and_then(|(i, _)| self.shifted(a, b, region, self.shift(i)));
        let better = |moved: &BestShift| still.is_none_or(|s| moved.correlation > s.correlation);
        moved.filter(better).or(still)
    }

    /// The shift that an entry of a correlation stands for.
    fn shift(&self, index: usize) -> [i64; 2] {
        let [across, down] = self.field;
        let signed = |at: usize, side: usize| {
            let (at, side) = (at as i64, side as i64);
            if at > side / 2 { at - side } else { at }
        };
        [signed(index % across, across), signed(index / across, down)]
    }

    /// The correlation at a shift.
    fn shifted(
        &self,
        a: &[f64],
        b: &[f64],
        region: &PixelMask,
        shift: [i64; 2],
    ) -> Option<BestShift> {
        let pairs = region.indices().filter_map(|i| {
            let x = usize::try_from((i % self.width) as i64 - shift[0]).ok()?;
            let y = usize::try_from((i / self.width) as i64 - shift[1]).ok()?;
            (x < self.width && y < self.height).then(|| (a[y * self.width + x], b[i]))
        });
        pearson(pairs).map(|correlation| BestShift { correlation, shift_pixels: shift })
    }
}

/// Transforms each row of a field.
fn transform_rows(field: &mut [Complex64], fft: &Arc<dyn Fft<f64>>) {
    let scratch = || vec![Complex64::ZERO; fft.get_inplace_scratch_len()];
    field
        .par_chunks_mut(fft.len())
        .for_each_init(scratch, |scratch, row| fft.process_with_scratch(row, scratch));
}

/// A field with rows of a width, turned into columns.
fn transposed(field: &[Complex64], width: usize) -> Vec<Complex64> {
    /// Rows that are read side by side.
    const BLOCK: usize = 16;
    let height = field.len() / width;
    let mut turned = vec![Complex64::ZERO; field.len()];
    turned.par_chunks_mut(BLOCK * height).enumerate().for_each(|(block, columns)| {
        for y in 0..height {
            for (i, column) in columns.chunks_mut(height).enumerate() {
                column[y] = field[y * width + block * BLOCK + i];
            }
        }
    });
    turned
}

/// The least number from `n` on that is a power of two, or three times one: [`fft`] transforms such
/// sizes.
fn smooth(n: usize) -> usize {
    n.next_power_of_two().min(3 * n.div_ceil(3).next_power_of_two())
}

/// The transform of a size that [`smooth`] gives. (The library's planner knows all sizes; it would
/// be a quarter of what is compiled in this crate.)
fn fft(size: usize, way: FftDirection) -> Arc<dyn Fft<f64>> {
    if !size.is_multiple_of(3) {
        return Arc::new(Radix4::new(size, way));
    }
    Arc::new(MixedRadix::new(Arc::new(Radix4::new(size / 3, way)), Arc::new(Butterfly3::new(way))))
}

#[cfg(test)]
mod tests {
    use super::super::comparison::tests::{even, patterns};
    use super::*;

    /// A picture without order.
    fn noise(width: usize, height: usize) -> Vec<f64> {
        let mut state = 7u64;
        let next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        std::iter::repeat_with(next).take(width * height).collect()
    }

    fn gray(width: usize, plane: Vec<f64>) -> View {
        let height = plane.len() / width;
        View::new(width, height, [plane.clone(), plane.clone(), plane]).expect("a view")
    }

    #[test]
    fn contrast_and_brightness_do_not_count() {
        let [a, b] = patterns();
        let all = PixelMask::whole(&a);
        let plane = &a.light[0];
        let of = |f: &dyn Fn(f64) -> f64| {
            correlation(plane, &plane.iter().map(|v| f(*v)).collect::<Vec<_>>(), &all)
        };
        assert!((of(&|v| v).expect("contrast") - 1.0).abs() < 1e-14);
        assert!((of(&|v| 0.3 * v + 2.0).expect("contrast") - 1.0).abs() < 1e-14);
        assert!((of(&|v| 1.0 - v).expect("contrast") + 1.0).abs() < 1e-14);
        assert_eq!(of(&|_| 0.3), None);
        // By hand: (1, 2, 3) and (1, 3, 2) have 1/2.
        let small = PixelMask::new(3, vec![true; 3]).expect("pixels");
        let half = correlation(&[1.0, 2.0, 3.0], &[1.0, 3.0, 2.0], &small).expect("contrast");
        assert!((half - 0.5).abs() < 1e-15);
        assert!(correlation(&a.light[2], &b.light[2], &all).expect("contrast") < 0.7);
    }

    #[test]
    fn a_moved_picture_is_found_where_it_has_gone() {
        let (width, height) = (37, 29);
        let first = noise(width, height);
        // Moved right by 5 and up by 3, with something new at the edges.
        let other = noise(width + 1, height);
        let moved: Vec<f64> = (0..width * height)
            .map(|i| {
                let (x, y) = (i % width, i / width);
                if x >= 5 && y + 3 < height { first[(y + 3) * width + x - 5] } else { other[i] }
            })
            .collect();
        let (a, b) = (gray(width, first), gray(width, moved));
        let best = best_shift(&a, &b, &PixelMask::whole(&a)).expect("memory");
        for best in best {
            let best = best.expect("contrast");
            assert_eq!(best.shift_pixels, [5, -3]);
            assert!((best.correlation - 1.0).abs() < 1e-12);
        }
        // So is a part of it.
        let part = PixelMask::rectangle(&b, [10, 4, 9, 7]).expect("inside");
        let best = best_shift(&a, &b, &part).expect("memory")[0].expect("contrast");
        assert_eq!(best.shift_pixels, [5, -3]);
        assert!((best.correlation - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_transform_finds_what_plain_sums_find() {
        let (width, height) = (12, 9);
        let (a, b) = (
            gray(width, noise(width, height)),
            gray(width, noise(width + 1, height)[..width * height].to_vec()),
        );
        let mask = (0..width * height).map(|i| i % width > 3 && i % 5 != 0).collect();
        let region = PixelMask::new(width, mask).expect("pixels");
        let found = best_shift(&a, &b, &region).expect("memory")[0].expect("contrast");
        let transform = Transform::new(&a).expect("memory");
        let mut plain: Option<BestShift> = None;
        for dy in -(height as i64)..=height as i64 {
            for dx in -(width as i64)..=width as i64 {
                let stays = |i: usize| {
                    let (x, y) = ((i % width) as i64 - dx, (i / width) as i64 - dy);
                    (0..width as i64).contains(&x) && (0..height as i64).contains(&y)
                };
                let overlap = region.indices().filter(|i| stays(*i)).count();
                if 2 * overlap < region.pixels() {
                    continue;
                }
                let here = transform.shifted(&a.light[0], &b.light[0], &region, [dx, dy]);
                if here.zip(plain).is_none_or(|(h, p)| h.correlation > p.correlation) {
                    plain = here.or(plain);
                }
            }
        }
        assert_eq!(Some(found), plain);
    }

    #[test]
    fn without_contrast_there_is_no_best_shift() {
        let (a, b) = (even(0.5), even(0.25));
        assert_eq!(best_shift(&a, &b, &PixelMask::whole(&a)).expect("memory"), [None; 3]);
        let [pattern, _] = patterns();
        let best = best_shift(&pattern, &pattern, &PixelMask::whole(&pattern)).expect("memory");
        assert_eq!(best.map(|best| best.map(|best| best.shift_pixels)), [Some([0, 0]); 3]);
    }
}
