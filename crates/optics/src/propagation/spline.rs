//! Smooth functions in the plane through samples on a grid.

use glam::DVec2;

/// A spline through samples on a rectangular grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSpline {
    corner: DVec2,
    /// The distances between neighbouring samples, cm.
    pub(super) spacing: DVec2,
    degree: Degree,
    /// How many basis functions there are along x and y: one less than the degree more than samples.
    count: [usize; 2],
    /// Their coefficients, those along x side by side.
    coefficients: Vec<f64>,
}

/// The degree of a spline along x and along y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Degree {
    /// Two derivatives are continuous, and the third is over the lines next to the border ("not a
    /// knot", de Boor, A Practical Guide to Splines, chapter IV), so that cubic polynomials are kept
    /// as they are.
    Three,
    /// Six derivatives are continuous, so that methods of high order take long steps through it;
    /// towards the border the function is taken to go on as its mirror image does (Unser, IEEE
    /// Signal Process. Mag. 16, 22 (1999)).
    Seven,
}

/// Why there is no [`GridSpline`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GridSplineError {
    /// There are too few samples.
    #[error("a grid of {} x {} samples is too small; it must have {LEAST} along either side", count[0], count[1])]
    TooFew {
        /// How many along x and y.
        count: [usize; 2],
    },
    /// There are too few samples in space.
    #[error(
        "a grid of {} x {} x {} samples is too small; it must have {LEAST} along each side",
        count[0], count[1], count[2]
    )]
    TooFewInSpace {
        /// How many along x, y and z.
        count: [usize; 3],
    },
    /// Samples are missing, or too many.
    #[error("a grid of {} x {} has {samples} samples", count[0], count[1])]
    Count {
        /// How many along x and y.
        count: [usize; 2],
        /// How many samples there are.
        samples: usize,
    },
    /// The grid's spacing is no length, or a sample is no number.
    #[error(
        "a sample or the spacing of the grid is not a finite number, or the spacing is not above 0"
    )]
    NotFinite,
}

/// The least number of samples along a side.
pub(super) const LEAST: usize = 4;

impl GridSpline {
    /// The spline of a degree through `samples`, those along x side by side, `count` along x and y:
    /// the first at `corner`, the others at steps of `spacing` (cm).
    ///
    /// # Errors
    ///
    /// If there are fewer than four along a side, their number is another, or something is not
    /// finite.
    pub fn new(
        degree: Degree,
        corner: DVec2,
        spacing: DVec2,
        count: [usize; 2],
        samples: &[f64],
    ) -> Result<Self, GridSplineError> {
        let [nx, ny] = count;
        if nx < LEAST || ny < LEAST {
            return Err(GridSplineError::TooFew { count });
        }
        if nx.checked_mul(ny) != Some(samples.len()) {
            return Err(GridSplineError::Count { count, samples: samples.len() });
        }
        let sound = corner.is_finite() && spacing.is_finite() && spacing.min_element() > 0.0;
        if !sound || samples.iter().any(|sample| !sample.is_finite()) {
            return Err(GridSplineError::NotFinite);
        }
        let (mx, my) = (nx + degree.more_than_samples(), ny + degree.more_than_samples());
        let mut factors = vec![0.0; mx.max(my)];
        let mut coefficients = |samples: &mut dyn Iterator<Item = f64>, c: &mut [f64]| match degree
        {
            Degree::Three => coefficients(samples, c, &mut factors),
            Degree::Seven => coefficients_of_seven(samples, c),
        };
        let mut along_x = vec![0.0; mx * ny];
        for (row, samples) in along_x.chunks_exact_mut(mx).zip(samples.chunks_exact(nx)) {
            coefficients(&mut samples.iter().copied(), row);
        }
        let mut coefficients_xy = vec![0.0; mx * my];
        let mut column = vec![0.0; my];
        for i in 0..mx {
            coefficients(&mut (0..ny).map(|j| along_x[j * mx + i]), &mut column);
            for (j, value) in column.iter().enumerate() {
                coefficients_xy[j * mx + i] = *value;
            }
        }
        Ok(Self { corner, spacing, degree, count: [mx, my], coefficients: coefficients_xy })
    }

    /// Value and gradient (1/cm) at a point. Beyond the grid the outermost pieces go on.
    #[inline(always)]
    #[must_use]
    pub fn look(&self, point: DVec2) -> (f64, DVec2) {
        match self.degree {
            Degree::Three => self.look_at_three(point),
            Degree::Seven => self.look_at_seven(point),
        }
    }

    /// The first of the `functions` that are not zero about a place along a side, and where in its
    /// cell the place is.
    #[inline(always)]
    fn cell(place: f64, count: usize, functions: usize) -> (usize, f64) {
        let cell = (place as i64).clamp(0, (count - functions) as i64) as usize;
        (cell, place - cell as f64)
    }

    #[inline]
    fn look_at_three(&self, point: DVec2) -> (f64, DVec2) {
        let place = (point - self.corner) / self.spacing;
        let (i, x) = Self::cell(place.x, self.count[0], 4);
        let (j, y) = Self::cell(place.y, self.count[1], 4);
        let (x, y) = (basis(x), basis(y));
        let (mut value, mut gradient) = (0.0, DVec2::ZERO);
        for k in 0..4 {
            let start = (j + k) * self.count[0] + i;
            let row = &self.coefficients[start..start + 4];
            let (mut along, mut slope) = (0.0, 0.0);
            for (l, c) in row.iter().enumerate() {
                along += x.0[l] * c;
                slope += x.1[l] * c;
            }
            value += y.0[k] * along;
            gradient += DVec2::new(y.0[k] * slope, y.1[k] * along);
        }
        (value, gradient / self.spacing)
    }

    /// All that eight basis functions have along x side by side, for wide instructions.
    #[inline(always)]
    fn look_at_seven(&self, point: DVec2) -> (f64, DVec2) {
        let place = (point - self.corner) / self.spacing;
        let (i, x) = Self::cell(place.x, self.count[0], 8);
        let (j, y) = Self::cell(place.y, self.count[1], 8);
        let (x, y) = (basis_of_seven(x), basis_of_seven(y));
        let (mut values, mut slopes) = ([0.0; 8], [0.0; 8]);
        for k in 0..8 {
            let start = (j + k) * self.count[0] + i;
            let row = &self.coefficients[start..start + 8];
            for l in 0..8 {
                values[l] += y.0[k] * row[l];
                slopes[l] += y.1[k] * row[l];
            }
        }
        let sum = |one: &[f64; 8], other: &[f64; 8]| {
            let terms: [f64; 8] = std::array::from_fn(|l| one[l] * other[l]);
            let pairs: [f64; 4] = std::array::from_fn(|l| terms[l] + terms[l + 4]);
            (pairs[0] + pairs[2]) + (pairs[1] + pairs[3])
        };
        (sum(&x.0, &values), DVec2::new(sum(&x.1, &values), sum(&x.0, &slopes)) / self.spacing)
    }

    /// Whether methods of high order may count on it.
    pub(super) fn is_smooth(&self) -> bool {
        self.degree == Degree::Seven
    }

    /// Bounds of the values within the grid: those of the coefficients, which differ little from
    /// the values where the grid is fine.
    pub(super) fn bounds(&self) -> [f64; 2] {
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        self.coefficients.iter().fold(start, |[low, high], c| [low.min(*c), high.max(*c)])
    }

    /// Bounds of the values in those cells of the grid whose distances from the origin, the least
    /// and the largest (cm), `counts` accepts: those of the coefficients in Bernstein's form, which
    /// are near the values on coarse grids, too. Of a spline of degree seven, those of all.
    pub(super) fn bounds_within(&self, counts: impl Fn([f64; 2]) -> bool) -> [f64; 2] {
        if self.degree == Degree::Seven {
            return self.bounds();
        }
        let [mx, my] = self.count;
        let mut bounds = [f64::INFINITY, f64::NEG_INFINITY];
        for (i, j) in (0..my - 3).flat_map(|j| (0..mx - 3).map(move |i| (i, j))) {
            let low = self.corner + self.spacing * DVec2::new(i as f64, j as f64);
            let high = low + self.spacing;
            let nearest = DVec2::ZERO.clamp(low, high).length();
            if !counts([nearest, low.abs().max(high.abs()).length()]) {
                continue;
            }
            let row = |row: usize| {
                let start = (j + row) * mx + i;
                bernstein(std::array::from_fn(|k| self.coefficients[start + k]))
            };
            let rows = [row(0), row(1), row(2), row(3)];
            for k in 0..4 {
                for c in bernstein(rows.map(|row| row[k])) {
                    bounds = [bounds[0].min(c), bounds[1].max(c)];
                }
            }
        }
        bounds
    }
}

/// Bernstein's coefficients of a piece of a cubic spline from those of its basis functions.
pub(super) fn bernstein([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0, (b + 4.0 * c + d) / 6.0]
}

impl Degree {
    /// How many more basis functions there are than samples.
    fn more_than_samples(self) -> usize {
        match self {
            Self::Three => 2,
            Self::Seven => 6,
        }
    }
}

/// The powers of the place in a cell, from the constant on, in the eight basis functions of degree
/// seven.
const POWERS: [[f64; 8]; 8] = powers();

const fn powers() -> [[f64; 8]; 8] {
    // By Cox's and de Boor's recursion: d b_d[j] = (t + d - j) b_(d-1)[j-1] + (1 - t + j) b_(d-1)[j].
    let mut powers = [[0.0; 8]; 8];
    powers[0][0] = 1.0;
    let mut degree = 1;
    while degree < 8 {
        let d = degree as f64;
        let before = powers;
        let mut p = 0;
        while p < 8 {
            let mut j = 0;
            while j < 8 {
                let mut sum = (1.0 + j as f64) * before[p][j];
                if j > 0 {
                    sum += (d - j as f64) * before[p][j - 1];
                }
                if p > 0 {
                    sum -= before[p - 1][j];
                    if j > 0 {
                        sum += before[p - 1][j - 1];
                    }
                }
                powers[p][j] = sum / d;
                j += 1;
            }
            p += 1;
        }
        degree += 1;
    }
    powers
}

/// The eight basis functions of degree seven of a cell at a place in it, 0 to 1, and their
/// derivatives.
#[inline(always)]
fn basis_of_seven(t: f64) -> ([f64; 8], [f64; 8]) {
    let (mut values, mut slopes) = (POWERS[7], [0.0; 8]);
    for power in POWERS[..7].iter().rev() {
        for l in 0..8 {
            slopes[l] = slopes[l] * t + values[l];
            values[l] = values[l] * t + power[l];
        }
    }
    (values, slopes)
}

/// The poles of the filter whose response to samples the coefficients of a spline of degree seven
/// are: roots of z³ B(z), with B the samples of its basis function.
const POLES: [f64; 3] =
    [-0.535_280_430_796_438_2, -0.122_554_615_192_326_7, -0.009_148_694_809_608_277];

/// As [`coefficients`], of degree seven: samples go on beyond the ends as their mirror images.
fn coefficients_of_seven(samples: impl Iterator<Item = f64>, c: &mut [f64]) {
    let margin = Degree::Seven.more_than_samples() / 2;
    let count = c.len() - 2 * margin;
    let inner = &mut c[margin..margin + count];
    for (place, sample) in inner.iter_mut().zip(samples) {
        *place = POLES.iter().fold(sample, |value, z| value * (1.0 - z) * (1.0 - z.recip()));
    }
    let last = count - 1;
    for z in POLES {
        // The sum of all samples before the first, periodic with twice the length: the images come back.
        let (mut sum, mut power) = (inner[0], z);
        let back = z.powi(2 * last as i32);
        let mut mirrored = back / z;
        for value in &inner[1..last] {
            sum += (power + mirrored) * value;
            power *= z;
            mirrored /= z;
        }
        sum += power * inner[last];
        inner[0] = sum / (1.0 - back);
        for k in 1..count {
            inner[k] += z * inner[k - 1];
        }
        inner[last] = z / (z * z - 1.0) * (inner[last] + z * inner[last - 1]);
        for k in (0..last).rev() {
            inner[k] = z * (inner[k + 1] - inner[k]);
        }
    }
    for k in 1..=margin {
        c[margin - k] = c[margin + k];
        c[margin + last + k] = c[margin + last - k];
    }
}

/// The four basis functions of a cell at a place in it, 0 to 1, and their derivatives.
#[inline]
pub(super) fn basis(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    let (tt, ss) = (t * t, s * s);
    let values = [
        ss * s / 6.0,
        (4.0 - 3.0 * tt * (2.0 - t)) / 6.0,
        (4.0 - 3.0 * ss * (2.0 - s)) / 6.0,
        tt * t / 6.0,
    ];
    let slopes = [-0.5 * ss, 0.5 * t * (3.0 * t - 4.0), -0.5 * s * (3.0 * s - 4.0), 0.5 * tt];
    (values, slopes)
}

/// The coefficients of the spline in one dimension through samples, of which there are two fewer:
/// with f the samples, (c[i] + 4 c[i+1] + c[i+2])/6 = f[i], and the fourth differences at both ends
/// are zero, which gives the coefficients at the second samples from the ends at once.
pub(super) fn coefficients(samples: impl Iterator<Item = f64>, c: &mut [f64], factors: &mut [f64]) {
    let m = c.len();
    for (place, sample) in c[1..m - 1].iter_mut().zip(samples) {
        *place = sample;
    }
    // c[i] holds the sample i - 1 till it is done with; the ends' samples are needed last.
    let (first, last) = (c[1], c[m - 2]);
    let near = (8.0 * c[2] - c[1] - c[3]) / 6.0;
    let far = (8.0 * c[m - 3] - c[m - 2] - c[m - 4]) / 6.0;
    let (second, next_to_last) = (c[2], c[m - 3]);
    // Thomas's algorithm for what lies between.
    let (mut above, mut before) = (0.0, near);
    for i in 3..m - 3 {
        let pivot = 4.0 - above;
        let end = if i + 1 == m - 3 { far } else { 0.0 };
        c[i] = (6.0 * c[i] - end - before) / pivot;
        above = pivot.recip();
        factors[i] = above;
        before = c[i];
    }
    for i in (3..m - 4).rev() {
        c[i] -= factors[i] * c[i + 1];
    }
    (c[2], c[m - 3]) = (near, far);
    c[1] = 6.0 * second - 4.0 * c[2] - c[3];
    c[m - 2] = 6.0 * next_to_last - 4.0 * c[m - 3] - c[m - 4];
    c[0] = 6.0 * first - 4.0 * c[1] - c[2];
    c[m - 1] = 6.0 * last - 4.0 * c[m - 2] - c[m - 3];
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn spline(degree: Degree, count: [usize; 2], function: impl Fn(DVec2) -> f64) -> GridSpline {
        let (corner, spacing) = (DVec2::new(-1.0, 2.0), DVec2::new(3.0, 1.5));
        let spacing = spacing / DVec2::new(count[0] as f64 - 1.0, count[1] as f64 - 1.0);
        let place = |k: usize| DVec2::new((k % count[0]) as f64, (k / count[0]) as f64);
        let samples: Vec<f64> =
            (0..count[0] * count[1]).map(|k| function(corner + spacing * place(k))).collect();
        GridSpline::new(degree, corner, spacing, count, &samples).expect("a spline")
    }

    fn points() -> impl Iterator<Item = DVec2> {
        (0..200).map(|k| {
            let share = f64::from(k) / 200.0;
            DVec2::new(-1.0 + 3.0 * share, 2.0 + 1.5 * (17.3 * share).fract())
        })
    }

    #[test]
    fn cubic_polynomials_are_kept_up_to_the_border() {
        let function = |p: DVec2| {
            1.0 + p.x - 0.3 * p.x * p.x * p.y + 0.2 * p.y.powi(3) - 0.1 * (p.x * p.y).powi(3)
        };
        let slope = |p: DVec2| {
            DVec2::new(
                1.0 - 0.6 * p.x * p.y - 0.3 * p.x.powi(2) * p.y.powi(3),
                -0.3 * p.x * p.x + 0.6 * p.y * p.y - 0.3 * p.x.powi(3) * p.y.powi(2),
            )
        };
        for count in [[4, 4], [4, 5], [6, 7], [21, 5]] {
            let spline = spline(Degree::Three, count, function);
            for point in points() {
                let (value, gradient) = spline.look(point);
                assert!((value - function(point)).abs() < 1e-12, "{count:?} {point}");
                assert!((gradient - slope(point)).length() < 1e-11, "{count:?} {point}");
            }
        }
    }

    #[test]
    fn smooth_functions_are_met_to_the_order_of_the_spline() {
        // Even about all borders.
        let function =
            |p: DVec2| (2.0 * TAU / 3.0 * (p.x + 1.0)).cos() * (TAU / 1.5 * (p.y - 2.0)).cos();
        for (degree, counts, order) in
            [(Degree::Three, [24, 48], 4.0), (Degree::Seven, [16, 32], 8.0)]
        {
            let error = |n: usize| {
                let spline = spline(degree, [n + 1, n + 1], function);
                points().map(|p| (spline.look(p).0 - function(p)).abs()).fold(0.0, f64::max)
            };
            let found = (error(counts[0]) / error(counts[1])).log2();
            assert!((found - order).abs() < 0.6, "{degree:?}: {found}");
            // Interpolation: at a sample it is the sample, and gradients are those of the values.
            let spline = spline(degree, [13, 13], |p| p.x.sin() * (1.3 * p.y).cos());
            let sample = DVec2::new(-1.0 + 0.25 * 7.0, 2.0 + 0.125 * 4.0);
            let exact = sample.x.sin() * (1.3 * sample.y).cos();
            assert!((spline.look(sample).0 - exact).abs() < 1e-14);
            for point in points() {
                for axis in [DVec2::X, DVec2::Y] {
                    let [ahead, behind] =
                        [1e-5, -1e-5].map(|step| spline.look(point + step * axis).0);
                    let slope = spline.look(point).1.dot(axis);
                    assert!(((ahead - behind) / 2e-5 - slope).abs() < 1e-8, "{degree:?} {point}");
                }
            }
        }
    }

    #[test]
    fn bounds_hold_where_they_are_asked_for() {
        // Bilinear: Bernstein's coefficients are values.
        let samples: Vec<f64> =
            (0..63).map(|k| 0.2 + 0.1 * f64::from(k % 7) + 0.3 * f64::from(k / 7)).collect();
        let spline = GridSpline::new(Degree::Three, DVec2::ZERO, DVec2::ONE, [7, 9], &samples)
            .expect("a spline");
        let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs().max((b - d).abs()) < 1e-12;
        assert!(near(spline.bounds_within(|_| true), [0.2, 3.2]));
        assert!(near(spline.bounds_within(|[nearest, _]| nearest == 0.0), [0.2, 0.6]));
        assert!(near(spline.bounds_within(|[_, farthest]| farthest > 9.9), [2.8, 3.2]));
    }

    #[test]
    fn what_is_no_grid_is_refused() {
        let new = |count, samples: &[f64]| {
            GridSpline::new(Degree::Three, DVec2::ZERO, DVec2::ONE, count, samples)
        };
        assert!(matches!(new([3, 4], &[0.0; 12]), Err(GridSplineError::TooFew { .. })));
        assert!(matches!(new([4, 4], &[0.0; 12]), Err(GridSplineError::Count { .. })));
        assert_eq!(new([4, 4], &[f64::NAN; 16]), Err(GridSplineError::NotFinite));
        let flat = GridSpline::new(Degree::Three, DVec2::ZERO, DVec2::ZERO, [4, 4], &[0.0; 16]);
        assert_eq!(flat, Err(GridSplineError::NotFinite));
    }
}
