//! An image and its coarser copies, and averages over patches of it.
//!
//! A probe of the width w (in texels of the image) is the exact average of one level's bilinear
//! interpolant over a square of d x d texels of that level. With texels of size s = 2^level, such
//! an average has the variance s^2 (d^2 / 12 + 1/4) - 1/12 per axis, the image's own texels counted
//! as points; the average over a square of width w, counted the same way, w^2 / 12 + 1/12. Equating
//! the two gives d. A picture shrunk in this way is neither sharper nor softer than its exact area
//! average. The finest level whose d is at most 4 texels is taken, or 2 where it is to be quick; before d
//! gets there, the result fades into the next level's.

use super::footprint::Footprint;
use super::{LinearImage, Texels, decode_table, downsample};
use std::sync::OnceLock;

/// Texels per axis that a probe can touch.
const MAX_TAPS: usize = 6;

/// Largest ratio of the axes of a patch.
const MAX_RATIO: f32 = 16.0;

/// Largest averaging width d, in texels: as many as the taps can hold.
const MAX_WIDTH: f32 = MAX_TAPS as f32 - 2.0;

/// How patches are averaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Averaging {
    /// As sharply as an exact average over the patch.
    Sharp,
    /// Over fewer texels of coarser copies: up to a third more blurred, in half the time.
    Quick,
}

impl Averaging {
    /// Variance of the widest average on a level, in texels of that level.
    fn max_variance(self) -> f32 {
        let width = match self {
            Self::Sharp => MAX_WIDTH,
            Self::Quick => 2.0,
        };
        width * width / 12.0 + 0.25
    }
}

/// Part of the largest variance from which the next level fades in.
const FADE: f32 = 0.8;

/// Smallest averaging width d, in texels: keeps the weights smooth.
const MIN_WIDTH: f32 = 0.25;

/// What lies beyond the edges of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// The edge goes on.
    Clamp,
    /// The image begins again beyond left and right; beyond top and bottom, the edge goes on.
    WrapHorizontally,
    /// The image begins again on all sides.
    Repeat,
    /// The image is mirrored at each edge, and so on.
    Mirror,
}

impl Edges {
    /// Which of so many texels is seen at a place before, among or beyond them, across or `down`.
    fn texel(self, place: i64, count: i64, down: bool) -> usize {
        let texel = match self {
            Self::Repeat => place.rem_euclid(count),
            Self::WrapHorizontally if !down => place.rem_euclid(count),
            Self::Clamp | Self::WrapHorizontally => place.clamp(0, count - 1),
            Self::Mirror => {
                let place = place.rem_euclid(2 * count);
                place.min(2 * count - 1 - place)
            }
        };
        texel as usize
    }

    /// The place within the image, from 0 to 1, at which the same is seen, and -1 where what changes
    /// with the place is seen the other way round there, else 1.
    fn within(self, place: f64) -> [f64; 2] {
        match self {
            // Far outside there is nothing but the edge.
            Self::Clamp | Self::WrapHorizontally => [place.clamp(-4.0, 5.0), 1.0],
            Self::Repeat => [place.rem_euclid(1.0), 1.0],
            Self::Mirror => match place.rem_euclid(2.0) {
                back if back > 1.0 => [2.0 - back, -1.0],
                forth => [forth, 1.0],
            },
        }
    }
}

/// An image with its coarser copies, ready to be looked at through patches of any size.
#[derive(Clone, Debug)]
pub struct Pyramid {
    finest: Level,
    /// Its coarser copies, each made when it is first looked at: most pictures never need one.
    coarser: Vec<OnceLock<Level>>,
    edges: Edges,
    max_ratio: f32,
    table: &'static [f32; 256],
}

#[derive(Clone, Debug)]
struct Level {
    image: LinearImage,
    /// Texels of this level per texel of the image.
    scale: [f64; 2],
}

/// How the levels answer each probe of a patch.
struct LevelMix {
    level: usize,
    /// Averaging width d on this level, in its texels.
    width: f32,
    /// Averaging width on the next level, if that has a share.
    next: f32,
    /// Share of the next level, 0 to 1.
    fade: f32,
}

impl Pyramid {
    /// An image and its coarser copies, which are exact area averages in linear light.
    pub fn new(image: LinearImage, edges: Edges) -> Self {
        let count = image.width.max(image.height).ilog2() as usize;
        Self {
            finest: Level { image, scale: [1.0; 2] },
            coarser: vec![OnceLock::new(); count],
            edges,
            max_ratio: MAX_RATIO,
            table: decode_table(),
        }
    }

    /// The image itself, or a coarser copy.
    #[inline]
    fn level(&self, level: usize) -> &Level {
        match level.checked_sub(1) {
            None => &self.finest,
            // One thread makes it, on its own: work shared out while others wait could wait for
            // them.
            Some(index) => self.coarser[index].get_or_init(|| self.halved(index)),
        }
    }

    #[cold]
    fn halved(&self, level: usize) -> Level {
        let image = downsample::halve(&self.level(level).image, self.table);
        let across = image.width as f64 / self.width() as f64;
        Level { scale: [across, image.height as f64 / self.height() as f64], image }
    }

    /// The same pyramid with another limit for the ratio of a patch's axes (default 16); thinner
    /// patches are blurred across. Time grows with the ratio.
    pub fn with_max_ratio(mut self, max_ratio: f32) -> Self {
        self.max_ratio = max_ratio.max(1.0);
        self
    }

    /// Width of the image in texels.
    pub fn width(&self) -> usize {
        self.finest.image.width
    }

    /// Height of the image in texels.
    pub fn height(&self) -> usize {
        self.finest.image.height
    }

    /// Memory of the image and the coarser copies made so far, in bytes.
    pub fn memory(&self) -> usize {
        std::iter::once(&self.finest)
            .chain(self.coarser.iter().filter_map(OnceLock::get))
            .map(|level| match &level.image.texels {
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
        self.sample_with((self.edges, Averaging::Sharp), position, [dx, dy])
    }

    /// The same with something else beyond the edges, averaged in another way, or over a patch that is drawn out further by
    /// more steps than the two derivatives.
    pub fn sample_with<const N: usize>(
        &self,
        (edges, averaging): (Edges, Averaging),
        position: [f64; 2],
        steps: [[f64; 2]; N],
    ) -> [f32; 3] {
        let size = [self.width() as f64, self.height() as f64];
        let texels = |[u, v]: [f64; 2]| [u * size[0], v * size[1]];
        let within = position.map(|x| edges.within(x));
        let [u, v] = texels(within.map(|[place, _]| if place.is_nan() { 0.5 } else { place }));
        let turned = |[du, dv]: [f64; 2]| texels([du * within[0][1], dv * within[1][1]]);
        let footprint = Footprint::new(steps.map(turned), self.max_ratio);
        let plan = self.plan(&footprint, averaging);
        let mut sum = [0.0; 3];
        if footprint.row.is_none() {
            self.add_probe(&mut sum, [u, v], 1.0, &plan, edges);
        } else {
            footprint.probes(|offset, weight| {
                let at = [u + f64::from(offset[0]), v + f64::from(offset[1])];
                self.add_probe(&mut sum, at, weight, &plan, edges);
            });
        }
        sum
    }

    /// Adds what a probe in the middle of `at`, in texels of the image, sees.
    #[inline]
    fn add_probe(
        &self,
        sum: &mut [f32; 3],
        at: [f64; 2],
        weight: f32,
        plan: &LevelMix,
        edges: Edges,
    ) {
        let mut add = |level: usize, width: f32, weight: f32| {
            let level = self.level(level);
            let at = [at[0] * level.scale[0], at[1] * level.scale[1]];
            let light = level.average(at, width, edges, self.table);
            for (total, value) in sum.iter_mut().zip(light) {
                *total += weight * value;
            }
        };
        add(plan.level, plan.width, weight * (1.0 - plan.fade));
        if plan.fade > 0.0 {
            add(plan.level + 1, plan.next, weight * plan.fade);
        }
    }

    fn plan(&self, footprint: &Footprint, averaging: Averaging) -> LevelMix {
        if footprint.major_squared < 1.0 {
            // Magnified, towards a quadratic spline.
            let width = (1.0 - footprint.major_squared.sqrt()).max(MIN_WIDTH);
            return LevelMix { level: 0, width, next: MIN_WIDTH, fade: 0.0 };
        }
        let (last, max_variance) = (self.coarser.len(), averaging.max_variance());
        // d^2 / 12 + 1/4 on the level at hand.
        let mut variance = (footprint.width_squared + 2.0) * (1.0 / 12.0);
        let mut level = 0;
        while variance >= max_variance && level < last {
            variance *= 0.25;
            level += 1;
        }
        let width = (12.0 * variance.min(max_variance) - 3.0).max(0.0).sqrt().max(MIN_WIDTH);
        let share = variance * (1.0 / max_variance);
        let (mut next, mut fade) = (MIN_WIDTH, 0.0);
        if share > FADE && level < last {
            next = (3.0 * variance - 3.0).max(0.0).sqrt().max(MIN_WIDTH);
            fade = (share - FADE) / (1.0 - FADE);
        }
        LevelMix { level, width, next, fade }
    }
}

impl Level {
    /// The average of the bilinear interpolant over a square of `width` texels around `at`, in
    /// texels from the top left corner.
    #[inline]
    fn average(&self, at: [f64; 2], width: f32, edges: Edges, table: &[f32; 256]) -> [f32; 3] {
        // The square touches fewer than `width + 2` texels per axis, rounded up.
        if width <= 1.0 {
            self.average_of::<3, 4>(at, width, edges, table)
        } else if width <= 2.0 {
            self.average_of::<4, 4>(at, width, edges, table)
        } else if width <= 3.0 {
            self.average_of::<5, 8>(at, width, edges, table)
        } else {
            self.average_of::<MAX_TAPS, 8>(at, width, edges, table)
        }
    }

    #[inline]
    fn average_of<const TAPS: usize, const LANES: usize>(
        &self,
        at: [f64; 2],
        width: f32,
        edges: Edges,
        table: &[f32; 256],
    ) -> [f32; 3] {
        let across = Taps::<TAPS, LANES>::new(at[0], width);
        let down = Taps::<TAPS, LANES>::new(at[1], width);
        let LinearImage { width, height, texels } = &self.image;
        if let Some(left) = across.inside(*width)
            && let Some(top) = down.inside(*height)
        {
            let start = (top * width + left) * 3;
            let stride = width * 3;
            let weights = (across.weights(), down.weights());
            match texels {
                Texels::Srgb8(codes) => {
                    weigh(&codes[start..], stride, weights, |code| table[usize::from(code)])
                }
                Texels::Linear(values) => weigh(&values[start..], stride, weights, |value| value),
            }
        } else {
            self.average_at_edge(&across, &down, edges, table)
        }
    }

    #[cold]
    fn average_at_edge<const TAPS: usize, const LANES: usize>(
        &self,
        across: &Taps<TAPS, LANES>,
        down: &Taps<TAPS, LANES>,
        edges: Edges,
        table: &[f32; 256],
    ) -> [f32; 3] {
        let LinearImage { width, height, texels } = &self.image;
        let (columns, rows) = (*width as i64, *height as i64);
        let mut sum = [0.0; 3];
        for (y, row_weight) in (down.first..).zip(down.weights()) {
            let y = edges.texel(y, rows, true);
            for (x, weight) in (across.first..).zip(across.weights()) {
                let x = edges.texel(x, columns, false);
                let start = (y * width + x) * 3;
                for (channel, total) in sum.iter_mut().enumerate() {
                    let light = match texels {
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

/// Neighbouring texels along one axis and their weights in an average of the linear interpolant; in
/// `LANES` numbers, as many as the processor takes at once.
struct Taps<const TAPS: usize, const LANES: usize> {
    first: i64,
    lanes: [f32; LANES],
}

impl<const TAPS: usize, const LANES: usize> Taps<TAPS, LANES> {
    /// The average over `width` texels around `position`, both in texels from the edge.
    #[inline(always)]
    fn new(position: f64, width: f32) -> Self {
        // Texel i has its middle at i + 1/2 and reaches one texel further on both sides.
        let middle = position - 0.5;
        let half = 0.5 * width;
        let first = floor(middle - f64::from(half));
        let offset = (first as f64 - middle) as f32;
        let scale = 1.0 / width;
        let mut lanes = [0.0; LANES];
        for (tap, lane) in lanes.iter_mut().enumerate() {
            let distance = offset + tap as f32;
            *lane = (tent_integral(distance + half) - tent_integral(distance - half)) * scale;
        }
        Self { first, lanes }
    }

    #[inline]
    fn weights(&self) -> [f32; TAPS] {
        let mut weights = [0.0; TAPS];
        weights.copy_from_slice(&self.lanes[..TAPS]);
        weights
    }

    /// The first texel's index if all lie within `length` texels.
    #[inline]
    fn inside(&self, length: usize) -> Option<usize> {
        usize::try_from(self.first).ok().filter(|first| first + TAPS <= length)
    }
}

/// Rounds down; whole numbers may become the number below. For numbers below 2^31; much faster than
/// `f64::floor` on processors without an instruction for it.
#[inline]
fn floor(x: f64) -> i64 {
    // Adding this leaves no bits for fractions, and the whole number in the lowest ones.
    const SHIFT: f64 = (3_i64 << 51) as f64;
    i64::from((x - 0.5 + SHIFT).to_bits() as i32)
}

/// Integral of the tent 1 - |x| from 0 to `x`.
#[inline]
fn tent_integral(x: f32) -> f32 {
    let x = x.clamp(-1.0, 1.0);
    x - 0.5 * x * x.abs()
}

/// Weighted sum of a square of texels from the beginning of `texels`; weights across and down.
#[inline]
fn weigh<S: Copy, const TAPS: usize>(
    texels: &[S],
    stride: usize,
    (across, down): ([f32; TAPS], [f32; TAPS]),
    light: impl Fn(S) -> f32,
) -> [f32; 3] {
    let mut columns = [[0.0; 3]; TAPS];
    for (row, weight) in down.into_iter().enumerate() {
        let start = row * stride;
        let row = &texels[start..start + TAPS * 3];
        for (total, &value) in columns.as_flattened_mut().iter_mut().zip(row) {
            *total += weight * light(value);
        }
    }
    let mut sum = [0.0; 3];
    for (texel, weight) in columns.iter().zip(across) {
        for (total, value) in sum.iter_mut().zip(texel) {
            *total += weight * value;
        }
    }
    sum
}

#[cfg(test)]
mod tests;
