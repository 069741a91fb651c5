//! Normalized cross-correlation, as cloaks were judged by before: Halimeh, Schmied & Wegener, Opt.
//! Express 19, 6078 (2011).

use super::{MeasureError, PixelMask, View};
use num_complex::Complex64;
use rayon::prelude::*;
use rustfft::algorithm::butterflies::{Butterfly3, Butterfly5, Butterfly9};
use rustfft::algorithm::{MixedRadix, Radix4};
use rustfft::{Fft, FftDirection};
use serde::Serialize;
use std::ops::Range;
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
    let axes = axes(region);
    check_room(a, &axes)?;
    let search = Search::new(axes, region);
    let planes = [a, b].map(|view| view.light.each_ref().map(Vec::as_slice));
    let centered = planes.map(|planes| planes.map(centered));
    let crosses = search.crosses(&centered);
    let best = |color: usize| {
        let sums =
            [search.sums_of_first(&centered[0][color]), search.sums_of_second(&centered[1][color])];
        search.best(planes.map(|planes| planes[color]), &crosses[color], &sums)
    };
    Ok([0, 1, 2].map(best))
}

/// A plane less its mean.
fn centered(plane: &[f64]) -> Vec<f64> {
    let mean = plane.iter().sum::<f64>() / plane.len() as f64;
    plane.iter().map(|value| value - mean).collect()
}

/// Refuses views for whose [`best_shift`] there is not enough memory, whatever the region.
///
/// # Errors
///
/// [`MeasureError::TooLarge`].
pub(super) fn check_memory(view: &View) -> Result<(), MeasureError> {
    check_room(view, &axes(&PixelMask::whole(view)))
}

fn check_room(view: &View, [across, down]: &[Axis; 2]) -> Result<(), MeasureError> {
    // Six planes, four spectra, and three correlations and two sums of a channel.
    view.check_room(10 * 16 * across.field as u64 * down.field as u64)
}

/// The shifts of a region along one side of the picture.
#[derive(Debug)]
struct Axis {
    /// Length of the side, pixels.
    side: usize,
    /// The part of it over which the region reaches.
    region: Range<usize>,
    /// The shifts that may leave enough of the region in the picture.
    shifts: Range<i64>,
    /// Length of a field on which none of these wraps around.
    field: usize,
}

/// The axes across and down the picture.
fn axes(region: &PixelMask) -> [Axis; 2] {
    let [width, height] = region.size();
    let (mut columns, mut rows) = (vec![0; width], vec![0; height]);
    for i in region.indices() {
        columns[i % width] += 1;
        rows[i / width] += 1;
    }
    [columns, rows].map(|counts| Axis::new(&counts))
}

impl Axis {
    /// With the number of the region's pixels at each place.
    fn new(counts: &[usize]) -> Self {
        let side = counts.len();
        let is_met = |place: &usize| counts[*place] > 0;
        let first = (0..side).find(is_met).unwrap_or(0);
        let last = (0..side).rfind(is_met).unwrap_or(0);
        let least = LEAST_OVERLAP * counts.iter().sum::<usize>() as f64;
        let enough = |shift: i64| {
            let kept: usize = counts[covered(side, shift)].iter().sum();
            kept as f64 >= least
        };
        let furthest = |sign| (0..side as i64).rfind(|shift| enough(sign * shift)).unwrap_or(0);
        let [left, right] = [-1, 1].map(furthest);
        // Shifts at which anything overlaps must not come back as one that counts.
        let (start, end) = (first as i64 - right, last as i64 + left);
        let field = smooth(end.max(side as i64 - 1 - start) as usize + 1);
        Self { side, region: first..last + 1, shifts: -left..right + 1, field }
    }

    /// Where the correlation at a shift is in the field.
    fn place(&self, shift: i64) -> usize {
        (shift - self.region.start as i64).rem_euclid(self.field as i64) as usize
    }

    /// The part of the region's reach that a shift leaves in the picture, and where that is in the
    /// first picture.
    fn overlap(&self, shift: i64) -> [Range<usize>; 2] {
        let Range { start, end } = covered(self.side, shift);
        let (start, end) = (start.max(self.region.start), end.min(self.region.end));
        let moved = |place: usize| (place as i64 - shift) as usize;
        if start < end { [start..end, moved(start)..moved(end)] } else { [0..0, 0..0] }
    }
}

/// The part of a side that the same side covers, moved.
fn covered(side: usize, shift: i64) -> Range<usize> {
    let side = side as i64;
    shift.clamp(0, side) as usize..(side + shift).clamp(0, side) as usize
}

/// Sums of a plane and of its squares over rectangles.
struct BoxSums {
    width: usize,
    /// Those over all that is above and to the left of each corner of a pixel.
    sums: Vec<[f64; 2]>,
}

impl BoxSums {
    fn new([width, height]: [usize; 2], value: impl Fn(usize) -> f64) -> Self {
        let corners = width + 1;
        let mut sums = vec![[0.0; 2]; corners * (height + 1)];
        for y in 0..height {
            let mut row = [0.0; 2];
            for x in 0..width {
                let value = value(y * width + x);
                row = [row[0] + value, row[1] + value * value];
                let above = sums[y * corners + x + 1];
                sums[(y + 1) * corners + x + 1] = [above[0] + row[0], above[1] + row[1]];
            }
        }
        Self { width: corners, sums }
    }

    fn over(&self, [columns, rows]: [Range<usize>; 2]) -> [f64; 2] {
        let up_to = |x: usize, y: usize| self.sums[y * self.width + x];
        let between = |y: usize| {
            let [end, start] = [up_to(columns.end, y), up_to(columns.start, y)];
            [end[0] - start[0], end[1] - start[1]]
        };
        let [end, start] = [between(rows.end), between(rows.start)];
        [end[0] - start[0], end[1] - start[1]]
    }
}

/// The search for the best shift of what a region shows. Planes are correlated by Fourier
/// transforms, laid into the corner of a field of zeros; spectra are kept column by column. What is
/// found at the shifts is kept row by row of shifts.
struct Search<'a> {
    region: &'a PixelMask,
    axes: [Axis; 2],
    rows: [Arc<dyn Fft<f64>>; 2],
    columns: [Arc<dyn Fft<f64>>; 2],
    /// How many pixels of the region each shift leaves in the picture.
    counts: Vec<f64>,
    /// The spectrum of the region; `None` if it is a rectangle, over which sums need none.
    inside: Option<Vec<Complex64>>,
}

impl<'a> Search<'a> {
    fn new(axes: [Axis; 2], region: &'a PixelMask) -> Self {
        let plan = |side| [FftDirection::Forward, FftDirection::Inverse].map(|way| fft(side, way));
        let [rows, columns] = axes.each_ref().map(|axis| plan(axis.field));
        let is_rectangle =
            region.pixels() == axes.iter().map(|axis| axis.region.len()).product::<usize>();
        let mut search = Self { region, axes, rows, columns, counts: Vec::new(), inside: None };
        let counts = BoxSums::new(region.size(), |i| search.in_region(i, 1.0));
        search.counts =
            search.at_shifts(|[[kept, _], [kept_rows, _]]| counts.over([kept, kept_rows])[0]);
        search.inside =
            (!is_rectangle).then(|| search.spectrum_in_region(|i| search.in_region(i, 1.0).into()));
        search
    }

    /// A value in the region, and zero elsewhere.
    fn in_region(&self, i: usize, value: f64) -> f64 {
        if self.region.mask[i] { value } else { 0.0 }
    }

    /// What comes of the overlaps of each shift, across and down.
    fn at_shifts<T: Send>(&self, value: impl Fn([[Range<usize>; 2]; 2]) -> T + Sync) -> Vec<T> {
        let [across, down] = &self.axes;
        let row = |shift: i64| {
            let rows = down.overlap(shift);
            let value = &value;
            across.shifts.clone().map(move |shift| value([across.overlap(shift), rows.clone()]))
        };
        down.shifts.clone().into_par_iter().flat_map_iter(row).collect()
    }

    /// The sums of a plane of the first view, and of its squares, over the region at each shift.
    fn sums_of_first(&self, plane: &[f64]) -> Vec<[f64; 2]> {
        let Some(inside) = &self.inside else {
            let sums = BoxSums::new(self.region.size(), |i| plane[i]);
            return self.at_shifts(|[[_, columns], [_, rows]]| sums.over([columns, rows]));
        };
        // Both in one: of real planes, they are the two parts.
        let spectrum = self.spectrum(|i| Complex64::new(plane[i], plane[i] * plane[i]));
        let product = spectrum.into_par_iter().zip(inside).map(|(a, b)| a.conj() * b).collect();
        let sums = self.correlations(product);
        // The conjugate has turned the sign of the squares.
        sums.into_iter().map(|sum| [sum.re, -sum.im]).collect()
    }

    /// The same of the second view, of which the region does not move.
    fn sums_of_second(&self, plane: &[f64]) -> Vec<[f64; 2]> {
        let sums = BoxSums::new(self.region.size(), |i| self.in_region(i, plane[i]));
        self.at_shifts(|[[columns, _], [rows, _]]| sums.over([columns, rows]))
    }

    /// The sums of the products of both views over the region at each shift, for each color.
    fn crosses(&self, [a, b]: &[[Vec<f64>; 3]; 2]) -> [Vec<f64>; 3] {
        // Two real planes at a time, as the two parts of one.
        let pair = |first: usize, second: Option<usize>| {
            let of = |planes: &[Vec<f64>; 3], i: usize| {
                Complex64::new(planes[first][i], second.map_or(0.0, |second| planes[second][i]))
            };
            let a = self.spectrum(|i| of(a, i));
            let b = self.spectrum_in_region(|i| {
                let Complex64 { re, im } = of(b, i);
                Complex64::new(self.in_region(i, re), self.in_region(i, im))
            });
            self.correlations(self.product_of_pairs(&a, &b))
        };
        let both = pair(0, Some(1));
        let parts = |part: fn(&Complex64) -> f64, all: &[Complex64]| all.iter().map(part).collect();
        let blue = pair(2, None);
        [parts(|c| c.re, &both), parts(|c| c.im, &both), parts(|c| c.re, &blue)]
    }

    /// The product of spectra of pairs of real planes, of the first with the first and of the second
    /// with the second: again one of a pair.
    fn product_of_pairs(&self, a: &[Complex64], b: &[Complex64]) -> Vec<Complex64> {
        let [across, down] = self.axes.each_ref().map(|axis| axis.field);
        let mirrored = |i: usize, side: usize| if i == 0 { 0 } else { side - i };
        let columns = (0..across).into_par_iter().flat_map_iter(|x| {
            let (column, opposite) = (x * down, mirrored(x, across) * down);
            (0..down).map(move |y| {
                let (here, there) = (column + y, opposite + mirrored(y, down));
                // A real plane has the conjugate at the opposite frequency.
                let parts = |spectrum: &[Complex64]| {
                    let (one, other) = (spectrum[here], spectrum[there].conj());
                    [0.5 * (one + other), Complex64::new(0.0, -0.5) * (one - other)]
                };
                let ([a, a_other], [b, b_other]) = (parts(a), parts(b));
                a.conj() * b + Complex64::I * a_other.conj() * b_other
            })
        });
        columns.collect()
    }

    /// The spectrum of a plane.
    fn spectrum(&self, value: impl Fn(usize) -> Complex64 + Sync) -> Vec<Complex64> {
        self.forward(self.axes.each_ref().map(|axis| 0..axis.side), value)
    }

    /// The spectrum of the part over which the region reaches.
    fn spectrum_in_region(&self, value: impl Fn(usize) -> Complex64 + Sync) -> Vec<Complex64> {
        self.forward(self.axes.each_ref().map(|axis| axis.region.clone()), value)
    }

    fn forward(
        &self,
        [columns, rows]: [Range<usize>; 2],
        value: impl Fn(usize) -> Complex64 + Sync,
    ) -> Vec<Complex64> {
        let [across, down] = self.axes.each_ref().map(|axis| axis.field);
        let mut field = vec![Complex64::ZERO; across * down];
        let filled = &mut field[..rows.len() * across];
        filled.par_chunks_mut(across).zip(rows).for_each(|(row, y)| {
            for (to, x) in row.iter_mut().zip(columns.clone()) {
                *to = value(y * self.axes[0].side + x);
            }
        });
        transform_rows(filled, &self.rows[0]);
        let mut field = transposed(&field, across);
        transform_rows(&mut field, &self.columns[0]);
        field
    }

    /// The correlation sum_x a(x - s) b(x) at each shift s, of the product of the spectra, the first
    /// conjugated.
    fn correlations(&self, mut product: Vec<Complex64>) -> Vec<Complex64> {
        let [across, down] = &self.axes;
        transform_rows(&mut product, &self.columns[1]);
        let field = transposed(&product, down.field);
        drop(product);
        let scale = 1.0 / (across.field * down.field) as f64;
        let row = |shift: i64| {
            let mut row = field[down.place(shift) * across.field..][..across.field].to_vec();
            self.rows[1].process(&mut row);
            across.shifts.clone().map(move |shift| row[across.place(shift)] * scale)
        };
        down.shifts.clone().into_par_iter().flat_map_iter(row).collect()
    }

    /// The best shift of one color, of which the planes are given, with the sums at each shift.
    fn best(
        &self,
        [a, b]: [&[f64]; 2],
        crosses: &[f64],
        [sums_a, sums_b]: &[Vec<[f64; 2]>; 2],
    ) -> Option<BestShift> {
        let least = LEAST_OVERLAP * self.region.pixels() as f64;
        let all = |sums: &[[f64; 2]]| sums.iter().map(|sums| sums[1].abs()).fold(0.0, f64::max);
        let (all_a, all_b) = (all(sums_a), all(sums_b));
        let at = |i: usize| {
            let n = self.counts[i];
            let contrast = |[sum, squares]: [f64; 2]| squares - sum * sum / n;
            let (aa, bb) = (contrast(sums_a[i]), contrast(sums_b[i]));
            let sound = n >= least && aa > ROUNDING * all_a && bb > ROUNDING * all_b;
            let ab = crosses[i] - sums_a[i][0] * sums_b[i][0] / n;
            if sound { ab / (aa * bb).sqrt() } else { f64::NEG_INFINITY }
        };
        let found: Vec<f64> = (0..crosses.len()).into_par_iter().map(at).collect();
        let largest = found.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // Where a pattern repeats itself, the nearest of the best.
        let far = |i: &usize| self.shift(*i).iter().map(|s| s * s).sum::<i64>();
        let best = (0..found.len()).filter(|i| found[*i] >= largest - ROUNDING).min_by_key(far);
        // The sums again, without the rounding of the transform.
        let still = correlation(a, b, self.region)
            .map(|correlation| BestShift { correlation, shift_pixels: [0; 2] });
        let moved = best.and_then(|i| self.shifted([a, b], self.shift(i)));
        let better = |moved: &BestShift| still.is_none_or(|s| moved.correlation > s.correlation);
        moved.filter(better).or(still)
    }

    /// The shift of that number.
    fn shift(&self, number: usize) -> [i64; 2] {
        let [across, down] = self.axes.each_ref().map(|axis| &axis.shifts);
        let count = (across.end - across.start) as usize;
        [across.start + (number % count) as i64, down.start + (number / count) as i64]
    }

    /// The correlation at a shift.
    fn shifted(&self, [a, b]: [&[f64]; 2], shift: [i64; 2]) -> Option<BestShift> {
        let [width, height] = self.region.size();
        let pairs = self.region.indices().filter_map(|i| {
            let x = usize::try_from((i % width) as i64 - shift[0]).ok()?;
            let y = usize::try_from((i / width) as i64 - shift[1]).ok()?;
            (x < width && y < height).then(|| (a[y * width + x], b[i]))
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

/// The odd factors of the sizes that [`fft`] transforms; the others are powers of two.
const FACTORS: [usize; 4] = [1, 3, 5, 9];

/// The least number from `n` on that is a power of two, or one of [`FACTORS`] times one.
fn smooth(n: usize) -> usize {
    FACTORS.iter().map(|factor| factor * n.div_ceil(*factor).next_power_of_two()).min().unwrap_or(n)
}

/// The transform of a size that [`smooth`] gives. (The library's planner knows all sizes; it would
/// be a quarter of what is compiled in this crate.)
fn fft(size: usize, way: FftDirection) -> Arc<dyn Fft<f64>> {
    let odd: Arc<dyn Fft<f64>> = match size >> size.trailing_zeros() {
        3 => Arc::new(Butterfly3::new(way)),
        5 => Arc::new(Butterfly5::new(way)),
        9 => Arc::new(Butterfly9::new(way)),
        _ => return Arc::new(Radix4::new(size, way)),
    };
    Arc::new(MixedRadix::new(Arc::new(Radix4::new(size / odd.len(), way)), odd))
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

    /// The best shift by plain sums, shift after shift.
    fn plainly(a: &View, b: &View, region: &PixelMask) -> Option<BestShift> {
        let (width, height) = (a.width as i64, a.height as i64);
        let search = Search::new(axes(region), region);
        let mut best: Option<BestShift> = None;
        for shift in (1 - height..height).flat_map(|dy| (1 - width..width).map(move |dx| [dx, dy]))
        {
            let stays = |i: &usize| {
                let (x, y) = (*i as i64 % width - shift[0], *i as i64 / width - shift[1]);
                (0..width).contains(&x) && (0..height).contains(&y)
            };
            if 2 * region.indices().filter(stays).count() >= region.pixels() {
                let here = search.shifted([&a.light[0], &b.light[0]], shift);
                if here.zip(best).is_none_or(|(h, b)| h.correlation > b.correlation) {
                    best = here.or(best);
                }
            }
        }
        best
    }

    #[test]
    fn the_transform_finds_what_plain_sums_find() {
        let size = [12, 9];
        let [a, b] = [0, 1].map(|more| {
            gray(size[0], noise(size[0] + more, size[1])[..size[0] * size[1]].to_vec())
        });
        let mut regions =
            vec![[0, 0, 12, 9], [9, 0, 3, 2], [0, 4, 5, 5], [11, 8, 1, 1], [3, 0, 2, 9]];
        regions.extend([[1, 1, 9, 7], [0, 0, 4, 3], [8, 5, 4, 4], [2, 3, 6, 3]]);
        for (number, [left, top, width, height]) in regions.into_iter().enumerate() {
            for hole in [usize::MAX, 3, 5] {
                let holds = |i: usize| {
                    let (x, y) = (i % size[0], i / size[0]);
                    (left..left + width).contains(&x)
                        && (top..top + height).contains(&y)
                        && i % hole != number % 3
                };
                let mask = (0..size[0] * size[1]).map(holds).collect();
                let Ok(region) = PixelMask::new(size[0], mask) else { continue };
                if region.pixels() < 6 {
                    // Any two pixels are alike.
                    continue;
                }
                let found = best_shift(&a, &b, &region).expect("memory")[0];
                assert_eq!(found, plainly(&a, &b, &region), "{left} {top} {width} {height} {hole}");
            }
        }
    }

    #[test]
    fn planes_are_laid_into_fields_that_can_be_transformed() {
        for n in 1..3000 {
            let size = smooth(n);
            assert!(size >= n && size <= n + n.div_ceil(3).max(3), "{n} {size}");
            assert_eq!(fft(size, FftDirection::Forward).len(), size);
        }
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
