//! An image and its coarser copies, and averages over patches of it.
//!
//! A probe of the width w (in texels of the image) is the exact average of one level's bilinear
//! interpolant over a square of d x d texels of that level. With texels of size s = 2^level, such
//! an average has the variance s^2 (d^2 / 12 + 1/4) - 1/12 per axis, the first level's texels
//! counted as points; the average over a square of width w, counted the same way, (w^2 - 1) / 12 +
//! 1/6. Equating the two gives d: 0 to 3 texels within each level's octave. A picture shrunk in
//! this way is neither sharper nor softer than its exact area average. Towards the end of the
//! octave the result fades into the next level's.

use super::footprint::Footprint;
use super::{LinearImage, Texels, decode_table, downsample};

/// Texels per axis that a probe can touch.
const TAPS: usize = 6;

/// Largest ratio of the axes of a patch.
const MAX_RATIO: f64 = 16.0;

/// Largest averaging width d, in texels: as many as the taps can hold.
const MAX_WIDTH: f64 = TAPS as f64 - 2.0;

/// Variance of the widest average on a level, in texels of that level.
const MAX_VARIANCE: f64 = MAX_WIDTH * MAX_WIDTH / 12.0 + 0.25;

/// Part of this variance from which the next level fades in.
const FADE: f64 = 0.8;

/// Smallest averaging width d, in texels: keeps the weights smooth.
const MIN_WIDTH: f64 = 0.25;

/// What lies beyond the left and right edge of an image. Beyond top and bottom, the edge goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// The edge goes on.
    Clamp,
    /// The image begins again.
    WrapHorizontally,
}

/// An image with its coarser copies, ready to be looked at through patches of any size.
#[derive(Clone, Debug)]
pub struct Pyramid {
    levels: Vec<Level>,
    edges: Edges,
    max_ratio: f64,
    table: &'static [f32; 256],
}

#[derive(Clone, Debug)]
struct Level {
    width: usize,
    height: usize,
    texels: Texels,
}

/// How the levels answer one probe: `[level, width d, weight]`, the second only while fading.
struct Plan {
    level: usize,
    width: f64,
    next: f64,
    fade: f64,
}

impl Pyramid {
    /// Computes the coarser copies of an image, by exact area averages in linear light.
    pub fn new(image: LinearImage, edges: Edges) -> Self {
        let table = decode_table();
        let LinearImage { width, height, texels } = image;
        let mut levels = vec![Level { width, height, texels }];
        while let Some(last) = levels.last()
            && (last.width > 1 || last.height > 1)
        {
            let (width, height, texels) =
                downsample::halve(last.width, last.height, &last.texels, table);
            levels.push(Level { width, height, texels: Texels::Linear(texels) });
        }
        Self { levels, edges, max_ratio: MAX_RATIO, table }
    }

    /// The same pyramid with another limit for the ratio of a patch's axes (default 16); thinner
    /// patches are blurred across. Time grows with the ratio.
    pub fn with_max_ratio(mut self, max_ratio: f64) -> Self {
        self.max_ratio = max_ratio.max(1.0);
        self
    }

    /// Width of the image in texels.
    pub fn width(&self) -> usize {
        self.levels[0].width
    }

    /// Height of the image in texels.
    pub fn height(&self) -> usize {
        self.levels[0].height
    }

    /// Memory of all levels, in bytes.
    pub fn memory(&self) -> usize {
        self.levels
            .iter()
            .map(|level| match &level.texels {
                Texels::Srgb8(codes) => codes.len(),
                Texels::Linear(values) => values.len() * size_of::<f32>(),
            })
            .sum()
    }

    /// Linear RGB of the image around `position`, averaged over the patch that a sample covers.
    ///
    /// `position` is (u, v), from (0, 0) in the top left corner to (1, 1) in the bottom right one.
    /// `dx` and `dy` are the derivatives of (u, v) per sample spacing along the two axes of the
    /// camera's picture. Derivatives that are zero or not numbers make a patch of one texel; where
    /// the image is magnified, it is interpolated without overshoot. The result is continuous in
    /// all arguments.
    pub fn sample(&self, position: [f64; 2], dx: [f64; 2], dy: [f64; 2]) -> [f32; 3] {
        let size = [self.width() as f64, self.height() as f64];
        let texels = |[u, v]: [f64; 2]| [u * size[0], v * size[1]];
        let footprint = Footprint::new(texels(dx), texels(dy), self.max_ratio);
        let plan = self.plan(&footprint);
        // Far outside there is nothing but the edge.
        let [u, v] = position.map(|x| if x.is_nan() { 0.5 } else { x.clamp(-4.0, 5.0) });
        let mut sum = [0.0; 3];
        footprint.probes(|offset, weight| {
            let at = [u + offset[0] / size[0], v + offset[1] / size[1]];
            let mut add = |level: usize, width: f64, weight: f64| {
                let light = self.levels[level].average(at, width as f32, self.edges, self.table);
                for (total, value) in sum.iter_mut().zip(light) {
                    *total += weight as f32 * value;
                }
            };
            add(plan.level, plan.width, weight * (1.0 - plan.fade));
            if plan.fade > 0.0 {
                add(plan.level + 1, plan.next, weight * plan.fade);
            }
        });
        sum
    }

    fn plan(&self, footprint: &Footprint) -> Plan {
        let last = self.levels.len() - 1;
        // d^2 / 12 + 1/4 on the level at hand.
        let mut variance = (footprint.width * footprint.width + 2.0) / 12.0;
        let mut level = 0;
        while variance >= MAX_VARIANCE && level < last {
            variance *= 0.25;
            level += 1;
        }
        let width = (12.0 * variance.min(MAX_VARIANCE) - 3.0).max(0.0).sqrt();
        // Magnified, towards a quadratic spline.
        let width = width.max(1.0 - footprint.magnification).max(MIN_WIDTH);
        let next = (3.0 * variance - 3.0).max(0.0).sqrt().max(MIN_WIDTH);
        let share = variance / MAX_VARIANCE;
        let fade = if level < last { ((share - FADE) / (1.0 - FADE)).max(0.0) } else { 0.0 };
        Plan { level, width, next, fade }
    }
}

impl Level {
    /// The average of the bilinear interpolant over a square of `width` texels around `at` (0 to 1).
    #[inline]
    fn average(&self, at: [f64; 2], width: f32, edges: Edges, table: &[f32; 256]) -> [f32; 3] {
        let (left, across) = taps(at[0] * self.width as f64, width);
        let (top, down) = taps(at[1] * self.height as f64, width);
        let inside = |first: i64, length: usize| first >= 0 && first as usize + TAPS <= length;
        if inside(left, self.width) && inside(top, self.height) {
            let start = (top as usize * self.width + left as usize) * 3;
            let stride = self.width * 3;
            match &self.texels {
                Texels::Srgb8(codes) => {
                    weigh(&codes[start..], stride, &across, &down, |code| table[usize::from(code)])
                }
                Texels::Linear(values) => {
                    weigh(&values[start..], stride, &across, &down, |value| value)
                }
            }
        } else {
            self.average_at_edge(left, top, &across, &down, edges, table)
        }
    }

    #[cold]
    fn average_at_edge(
        &self,
        left: i64,
        top: i64,
        across: &[f32; TAPS],
        down: &[f32; TAPS],
        edges: Edges,
        table: &[f32; 256],
    ) -> [f32; 3] {
        let (columns, rows) = (self.width as i64, self.height as i64);
        let mut sum = [0.0; 3];
        for (j, &row_weight) in (0..).zip(down) {
            let y = (top + j).clamp(0, rows - 1) as usize;
            for (i, &weight) in (0..).zip(across) {
                let x = match edges {
                    Edges::Clamp => (left + i).clamp(0, columns - 1),
                    Edges::WrapHorizontally => (left + i).rem_euclid(columns),
                } as usize;
                let start = (y * self.width + x) * 3;
                for (channel, total) in sum.iter_mut().enumerate() {
                    let light = match &self.texels {
                        Texels::Srgb8(codes) => table[usize::from(codes[start + channel])],
                        Texels::Linear(values) => values[start + channel],
                    };
                    *total += row_weight * weight * light;
                }
            }
        }
        sum
    }
}

/// The first texel and the weights of an average of the linear interpolant over `width` texels
/// around `position` (in texels from the edge).
#[inline]
fn taps(position: f64, width: f32) -> (i64, [f32; TAPS]) {
    // Texel i has its middle at i + 1/2.
    let middle = position - 0.5;
    let half = 0.5 * width;
    let first = (middle - 1.0 - f64::from(half)).floor() + 1.0;
    let offset = (first - middle) as f32;
    let scale = 1.0 / width;
    let weights = std::array::from_fn(|tap| {
        let distance = offset + tap as f32;
        (tent_integral(distance + half) - tent_integral(distance - half)) * scale
    });
    (first as i64, weights)
}

/// Integral of the tent 1 - |x| from -1 to `x`.
#[inline]
fn tent_integral(x: f32) -> f32 {
    let x = x.clamp(-1.0, 1.0);
    0.5 + x - 0.5 * x * x.abs()
}

/// Weighted sum of `TAPS` x `TAPS` texels from the beginning of `texels`.
#[inline]
fn weigh<S: Copy>(
    texels: &[S],
    stride: usize,
    across: &[f32; TAPS],
    down: &[f32; TAPS],
    light: impl Fn(S) -> f32,
) -> [f32; 3] {
    let mut columns = [0.0; TAPS * 3];
    for (row, &weight) in down.iter().enumerate() {
        if weight != 0.0 {
            let start = row * stride;
            for (total, &value) in columns.iter_mut().zip(&texels[start..start + TAPS * 3]) {
                *total += weight * light(value);
            }
        }
    }
    let mut sum = [0.0; 3];
    for (texel, &weight) in columns.chunks_exact(3).zip(across) {
        for (total, value) in sum.iter_mut().zip(texel) {
            *total += weight * value;
        }
    }
    sum
}

#[cfg(test)]
mod tests;
