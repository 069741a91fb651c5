//! Rays that share their neighbours' work: the leaves over a small patch of the picture.
//!
//! Where all rays of a patch take the same way, position, direction, path and power of its leaf are
//! smooth functions of the place in the picture. They are traced at the nodes of a grid and
//! interpolated between them; points between the nodes tell whether that is true. A way that only
//! some rays take, or on which the functions are not smooth, is traced for each sample; a patch
//! with much of that is divided, and of its parts only that is looked at again.

mod grid;
mod smooth_leaf;
#[cfg(test)]
mod tests;
mod ways;

use super::detection::Detection;
use super::prepared_scene::PreparedScene;
use crate::assembly::Placed;
use crate::scene::CameraRay;
use crate::trace::{FourTracers, Leaf, Limits, Outcome, TraceStats, Tracer};
use arrayvec::ArrayVec;
use glam::DVec3;
use grid::{Coefficients, Grid, LANES, MOST, Terms, bits};
use pulp::Arch;
use smooth_leaf::{Functions, MOST_LANES, SmoothLeaf};
use std::ops::Range;
use ways::{LeftOut, Trail, Ways};

/// Width and height of the largest patches, pixels.
pub(super) const SIDE: usize = 32;

/// The least width and height: patches hold whole blocks of 2 x 2 pixels.
const LEAST_SIDE: usize = 2;

/// Rays at the nodes are followed to this share of the least power, so that what is above it in one
/// place of a patch is known in all.
const DEEPER: f64 = 0.25;

/// They are traced so much more exactly, for errors of theirs are not smooth.
const CLOSER: f64 = 0.1;

/// What a ray at a node costs in terms of a sample's.
const COST: f64 = 4.0;

/// What it costs at least, as a share of that, for light has to come to where rays part.
const LEAST_COST: f64 = 0.1;

/// What a division leaves to be traced of what was.
const LEFT_AFTER_DIVISION: f64 = 0.5;

/// Where this share is to be traced, all is: to interpolate the rest takes as long.
const MOST_TRACED: f64 = 0.9;

/// A rectangle of the picture: its first column and row, and its width and height in pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Patch {
    pub corner: [usize; 2],
    pub size: [usize; 2],
}

impl Patch {
    /// Its halves, parted across (0) or down (1) the picture.
    pub fn halves(self, axis: usize) -> [Self; 2] {
        let mut first = self;
        first.size[axis] /= 2;
        let mut second = first;
        second.corner[axis] += first.size[axis];
        [first, second]
    }

    /// The columns and rows of its blocks that have pixels in a rectangle, given as a patch is.
    pub fn part_of(self, corner: [usize; 2], size: [usize; 2]) -> [Range<usize>; 2] {
        [0, 1].map(|i| {
            let (first, end) = (corner[i], corner[i] + size[i]);
            self.corner[i].max(first & !1)..(self.corner[i] + self.size[i]).min(end)
        })
    }

    /// The point of the picture at the coordinates -1 to 1 of the patch.
    fn point(self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| self.corner[i] as f64 + 0.5 * self.size[i] as f64 * (1.0 + place[i]))
    }

    /// The coordinates, -1 to 1, of a point of the picture.
    fn place(self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| (point[i] - self.corner[i] as f64) / (0.5 * self.size[i] as f64) - 1.0)
    }
}

/// What becomes of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    /// Leaves are interpolated, of all ways or of some, or will be in its parts.
    Shared,
    /// Nothing would be gained, however it is divided.
    Alone,
}

/// What is known of a patch.
#[derive(Clone, Debug, Default)]
struct Level<const N: usize> {
    patch: Patch,
    /// The surface that its rays meet first.
    surface: Option<(u16, u16)>,
    /// The leaves that are interpolated, those of larger patches that it is part of, too.
    smooth: Vec<SmoothLeaf<N>>,
    /// The share of all that is to be traced.
    traced: f64,
    /// How many borders a ray meets of which nothing is left out, if that is known.
    borders: Option<f64>,
    left_out: LeftOut,
    /// Where the coefficients of larger patches end.
    coefficients: usize,
}

/// Patches of at most this width and height need fewer nodes, and those of at most half of it still
/// fewer, to tell as much.
const SMALL: usize = 8;

/// Divisions of a patch by two, each way, and the patch itself.
const MOST_LEVELS: usize = 9;

/// Interpolates leaves over patches, one after the other.
pub(super) struct LeafPatches<'a, const N: usize> {
    prepared: &'a PreparedScene<'a>,
    detection: &'a Detection<N>,
    scouts: FourTracers<'a, N, Trail>,
    /// They trace what is not interpolated.
    tracers: FourTracers<'a, N, LeftOut>,
    /// Those of the smallest patches, of small ones and of others.
    grids: [Grid; 3],
    /// Those that the processor has; they change no number.
    instructions: Arch,
    functions: Functions<'a, N>,
    /// Whether rays go through graded media.
    graded: bool,
    /// Width and height of the largest patches, pixels.
    pub side: usize,
    /// The patch that was fitted last, and before it the larger ones that it is part of.
    levels: Vec<Level<N>>,
    /// The coefficients of what is interpolated.
    coefficients: Vec<[f64; LANES]>,
    /// How often neighbouring rays of the last patch part, across the picture and down.
    cuts: [usize; 2],
    // Memory to work in.
    ways: Ways,
    order: Vec<(u64, usize, usize)>,
    found: Vec<(usize, Leaf<N>)>,
    /// How many rays have been traced at nodes and between them.
    pub walks: f64,
    /// The leaves of the samples of a block, and what became of the rest.
    pub samples: [(Vec<Leaf<N>>, Outcome<N>); 4],
}

impl<'a, const N: usize> LeafPatches<'a, N> {
    /// For pictures of a scene; `None` if they are to be exact, or would gain nothing.
    pub fn new(
        prepared: &'a PreparedScene<'a>,
        detection: &'a Detection<N>,
        tracer: &Tracer<'a, N>,
    ) -> Option<Self> {
        let graded = prepared.assembly.is_graded();
        let exact = prepared.scene.trace.exact
            || prepared.coherence.is_some()
            || prepared.assembly.absorbs()
            || detection.first_face
            || detection.group_delays
            || detection.times && !graded;
        if exact {
            return None;
        }
        let side = largest_side(prepared)?;
        let Limits { min_power, tolerance } = prepared.limits;
        let limits = Limits { min_power: DEEPER * min_power, tolerance: CLOSER * tolerance };
        Some(Self {
            prepared,
            detection,
            scouts: FourTracers::new(&tracer.clone().within(limits).watched(Trail::default())),
            tracers: FourTracers::new(&tracer.clone().watched(LeftOut::default())),
            grids: [MOST - 2, MOST - 1, MOST].map(Grid::new),
            instructions: Arch::new(),
            functions: Functions::of(prepared, detection),
            graded,
            side,
            levels: Vec::new(),
            coefficients: Vec::new(),
            cuts: [0; 2],
            ways: Ways::default(),
            order: Vec::new(),
            found: Vec::new(),
            walks: 0.0,
            samples: std::array::from_fn(|_| (Vec::new(), Outcome::default())),
        })
    }

    /// Where rays of a patch are traced.
    fn grid(&self, patch: Patch) -> &Grid {
        let [width, height] = patch.size;
        let side = width.max(height);
        &self.grids[usize::from(side > SMALL / 2) + usize::from(side > SMALL)]
    }

    /// The share of the patch that was fitted last that is to be traced for each sample.
    pub fn traced(&self) -> f64 {
        let share = self.levels.last().map_or(1.0, |level| level.traced);
        if share > MOST_TRACED { 1.0 } else { share }
    }

    /// How the patch that was fitted last is to be divided, if it is.
    pub fn division(&self) -> Option<[Patch; 2]> {
        let Level { patch, traced, .. } = self.levels.last()?;
        let [across, down] = self.cuts;
        let [width, height] = patch.size;
        let axis = usize::from(if across == down { height > width } else { down > across });
        let divisible = |axis: &usize| patch.size[*axis] > LEAST_SIDE;
        let halves = patch.halves([axis, 1 - axis].into_iter().find(divisible)?);
        let samples = width * height * self.prepared.scene.camera.samples as usize;
        let gain = traced * (1.0 - LEFT_AFTER_DIVISION) * samples as f64;
        let rays = 2 * self.grid(halves[0]).points.len();
        (gain > COST * traced.max(LEAST_COST) * rays as f64).then_some(halves)
    }

    /// Traces the rays of a patch, of that level: 0, or one more than that of the patch of which it
    /// is a half.
    pub fn fit(&mut self, patch: Patch, level: usize) -> Fit {
        if let Some(first) = self.levels.get(level) {
            self.coefficients.truncate(first.coefficients);
        }
        self.levels.truncate(level);
        let coefficients = self.coefficients.len();
        let mut here = Level { patch, traced: 1.0, coefficients, ..Level::default() };
        let fit = self.look(&mut here);
        self.levels.push(here);
        fit
    }

    fn look(&mut self, here: &mut Level<N>) -> Fit {
        let camera = &self.prepared.scene.camera;
        let grid = self.grid(here.patch);
        let rays: Vec<CameraRay> = (grid.points.iter())
            .map(|place| {
                let [x, y] = here.patch.point(*place);
                camera.ray(x, y)
            })
            .collect();
        let any = &self.scouts.tracers[0];
        let surface = |ray: &CameraRay| any.first_surface(ray.origin, ray.direction);
        let met = surface(&rays[0]);
        let beside = |ray: &CameraRay| surface(ray) == met;
        let same = bits(rays.iter().enumerate().filter(|(_, ray)| beside(ray)).map(|(i, _)| i));
        self.cuts = grid.cuts(same);
        if same.count_ones() as usize != rays.len() {
            return Fit::Shared;
        }
        if met.is_none() {
            return Fit::Alone;
        }
        here.surface = met;
        self.found.clear();
        self.ways.clear();
        let above = self.levels.last();
        let left_out = above.map(|above| above.left_out.clone()).unwrap_or_default();
        for tracer in &mut self.scouts.tracers {
            tracer.recorder().left_out.clone_from(&left_out);
        }
        for (number, four) in rays.chunks(4).enumerate() {
            let launches = std::array::from_fn(|i| {
                self.detection.launch(camera, &four[i.min(four.len() - 1)])
            });
            self.scouts.trace(&launches);
            self.walks += four.len() as f64 * above.map_or(1.0, |above| above.traced);
            for (i, tracer) in self.scouts.tracers.iter_mut().enumerate() {
                if i < four.len() {
                    self.ways.add(4 * number + i, tracer.recorder());
                }
                tracer.recorder().clear();
                let (leaves, outcome) = tracer.traced();
                if outcome.stats != TraceStats::default() {
                    // Light without end is told of in the picture's account, and takes its time.
                    return Fit::Alone;
                }
                if i < four.len() {
                    self.found.extend(leaves.iter().map(|leaf| (4 * number + i, *leaf)));
                }
            }
            if number == 0 && !self.graded && above.is_none() && self.found.len() == 4 {
                // One branch in closed form is quicker than any polynomial.
                return Fit::Alone;
            }
        }
        self.ways.gather(rays.len(), self.prepared.limits.min_power);
        self.interpolate(here);
        for part in self.ways.some_have() {
            let cuts = self.grid(here.patch).cuts(part);
            self.cuts = [0, 1].map(|axis| self.cuts[axis] + cuts[axis]);
        }
        let above = self.levels.last();
        let borders = above.and_then(|above| above.borders).unwrap_or_else(|| self.ways.borders());
        here.borders = Some(borders);
        here.traced = (self.ways.borders_to_trace() / borders).min(1.0);
        let known = above.map_or(&[][..], |above| &above.smooth);
        here.smooth.extend(known.iter().filter(|leaf| !self.ways.parts(leaf.beginning)));
        if here.traced > 0.0 {
            here.left_out = LeftOut::new(self.ways.shared());
            for leaf in &mut here.smooth {
                leaf.beginning = self.ways.shared_beginning(leaf.beginning);
                leaf.place = here.left_out.place(leaf.beginning);
            }
            for tracer in &mut self.tracers.tracers {
                tracer.recorder().clone_from(&here.left_out);
            }
        }
        Fit::Shared
    }

    /// Makes functions of the leaves of the ways that all rays take.
    fn interpolate(&mut self, here: &mut Level<N>) {
        let (nodes, level) = (self.grid(here.patch).nodes(), self.levels.len());
        let least = self.prepared.limits.min_power;
        // Leaves are large, and stay where they are.
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        order.extend(self.found.iter().enumerate().map(|(i, (ray, leaf))| (leaf.path, *ray, i)));
        order.sort_unstable();
        for way in order.chunk_by(|(one, ..), (other, ..)| one == other) {
            let leaf_of = |&(.., i): &(u64, usize, usize)| &self.found[i].1;
            let power = way.iter().map(|one| leaf_of(one).largest_power()).fold(0.0, f64::max);
            if power < least {
                continue;
            }
            let first = *leaf_of(&way[0]);
            let is_whole = way.len() >= nodes
                && way[..nodes].iter().enumerate().all(|(node, one)| {
                    let leaf = leaf_of(one);
                    node == one.1 && (leaf.end, leaf.met_device) == (first.end, first.met_device)
                });
            if is_whole {
                let grid = self.grid(here.patch);
                let coefficients = (0..self.functions.lanes).map(|lane| {
                    let values = way[..nodes].iter();
                    let values: ArrayVec<_, { MOST * MOST }> =
                        values.map(|one| self.functions.values(leaf_of(one), lane)).collect();
                    grid.coefficients(&values)
                });
                let coefficients: ArrayVec<Coefficients, MOST_LANES> = coefficients.collect();
                let terms = self.functions.terms(&first, power, &coefficients);
                let start = self.coefficients.len();
                let leaf =
                    SmoothLeaf { first, level, start, terms, beginning: first.path, place: 0 };
                let rougher = grid.rougher(&coefficients);
                self.coefficients.extend(coefficients.iter().flat_map(|lane| &lane[..terms]));
                let mut between = way[nodes..].iter().peekable();
                let is_smooth = (nodes..).zip(&self.grid(here.patch).checks).all(|(number, at)| {
                    let mut here = first;
                    self.functions.move_leaf(&mut here, &leaf, at, &self.coefficients);
                    match between.next_if(|one| one.1 == number) {
                        Some(one) => self.functions.agree(&here, leaf_of(one)),
                        // It is too weak to be known there.
                        None => here.largest_power() < least,
                    }
                });
                if is_smooth && between.peek().is_none() && !self.ways.parts(first.path) {
                    here.smooth.push(leaf);
                    continue;
                }
                self.coefficients.truncate(start);
                self.cuts[rougher] += 1;
            }
            self.ways.part_at(first.path);
        }
        self.order = order;
        // A way may part from others after its leaf was found to be smooth.
        here.smooth.retain(|leaf| !self.ways.parts(leaf.first.path));
    }

    /// Finds the leaves of the rays of a block of the patch that was fitted last; whether its rays
    /// are like those of the patch. What was rare goes to `stats`.
    pub fn sample(
        &mut self,
        points: &[[f64; 2]; 4],
        rays: &[CameraRay; 4],
        stats: &mut TraceStats,
    ) -> bool {
        let Some(Level { surface, traced, .. }) = self.levels.last() else { return false };
        let is_traced = *traced > 0.0;
        let tracer = &self.tracers.tracers[0];
        let met = |ray: &CameraRay| tracer.first_surface(ray.origin, ray.direction) == *surface;
        if !rays.iter().all(met) {
            return false;
        }
        if is_traced {
            let camera = &self.prepared.scene.camera;
            self.tracers.tracers.iter_mut().for_each(|tracer| tracer.recorder().begin());
            self.tracers.trace(&rays.each_ref().map(|ray| self.detection.launch(camera, ray)));
        }
        let mut samples = std::mem::take(&mut self.samples);
        let mut as_traced = true;
        let mut rare = TraceStats::default();
        for (i, (leaves, outcome)) in samples.iter_mut().enumerate() {
            leaves.clear();
            *outcome = Outcome::default();
            let traced = is_traced.then_some(i);
            as_traced &=
                self.instructions.dispatch(|| self.interpolated(points[i], traced, leaves));
            if is_traced {
                let (others, outcome) = self.tracers.tracers[i].traced();
                leaves.extend_from_slice(others);
                rare += outcome.stats;
            }
        }
        if as_traced {
            *stats += rare;
        }
        for (leaves, outcome) in &mut samples {
            for (i, pruned) in outcome.pruned.iter_mut().enumerate() {
                *pruned = (1.0 - leaves.iter().map(|leaf| leaf.power[i]).sum::<f64>()).max(0.0);
            }
        }
        self.samples = samples;
        as_traced
    }

    /// The leaves at a point of the picture that are interpolated and strong enough; whether the
    /// ray of that number in its block, if it is traced, has met the branches of all of them.
    #[inline(always)]
    fn interpolated(
        &self,
        point: [f64; 2],
        traced: Option<usize>,
        leaves: &mut Vec<Leaf<N>>,
    ) -> bool {
        let Some(here) = self.levels.last() else { return false };
        let least = self.prepared.limits.min_power;
        let mut terms: [Option<Terms>; MOST_LEVELS] = [None; MOST_LEVELS];
        let mut as_traced = true;
        for smooth in &here.smooth {
            let terms = terms[smooth.level]
                .get_or_insert_with(|| Terms::at(self.levels[smooth.level].patch.place(point)));
            // Leaves are large, and made where they are to be.
            leaves.push(smooth.first);
            let Some(leaf) = leaves.last_mut() else { break };
            self.functions.move_leaf(leaf, smooth, terms, &self.coefficients);
            if leaf.largest_power() < least {
                leaves.pop();
                continue;
            }
            leaf.survives_alone = leaf.power.map(|power| power >= least);
            let met = |ray: usize| self.tracers.tracers[ray].watcher().has_met(smooth.place);
            as_traced &= traced.is_none_or(met);
        }
        as_traced
    }
}

/// How large patches may be, pixels: no larger than the smallest of several devices looks, so that
/// none is stepped over by the nodes; `None` if there may be no patches.
fn largest_side(prepared: &PreparedScene<'_>) -> Option<usize> {
    let devices = prepared.assembly.devices();
    let from = prepared.scene.camera.position;
    let pixels = |device: &Placed| {
        let distance = from.distance(device.pose.to_world(DVec3::ZERO));
        device.least_extent() / prepared.pixel.width_at(distance)
    };
    let smallest = devices.iter().map(pixels).fold(f64::INFINITY, f64::min);
    let smallest = if devices.len() > 1 { smallest } else { f64::INFINITY };
    let sides = std::iter::successors(Some(SIDE), |side| Some(side / 2));
    sides.take_while(|side| *side >= LEAST_SIDE).find(|side| *side as f64 <= smallest)
}
