//! Rays that share their neighbours' work: the leaves over a small patch of the picture.
//!
//! Where all rays of a patch take the same way, position, direction, path and power of its leaf are
//! smooth functions of the place in the picture. They are traced at the nodes of a grid and
//! interpolated between them; points between the nodes tell whether that is true. A way that only
//! some rays take, or on which the functions are not smooth, is traced for each sample; a patch
//! with much of that is divided, and of its parts only that is looked at again.

mod grid;
mod instructions;
mod smooth;
#[cfg(test)]
mod tests;
mod ways;

use super::detection::Detection;
use super::prepared_scene::PreparedScene;
use crate::assembly::Placed;
use crate::scene::CameraRay;
use crate::trace::{Branch, FourTracers, LAUNCHED, Leaf, Limits, Outcome, TraceStats, Tracer};
use arrayvec::ArrayVec;
use glam::DVec3;
use grid::{FEWEST, Grid, LANES, MOST, Shape, Terms, bits};
use instructions::Instructions;
use smooth::{Functions, Rough, Smooth, smooth};
use std::ops::Range;
use std::sync::Arc;
use ways::{Choice, Faces, LeftOut, Origin, Start, Surfaces, Trail, Ways};

/// Width and height of the largest patches, pixels.
pub(super) const SIDE: usize = 32;

/// The least width and height: patches hold whole blocks of 2 x 2 pixels.
const LEAST_SIDE: usize = 2;

/// Rays at the nodes are followed to this share of the least power, so that what is above it in one
/// place of a patch is known in all.
const DEEPER: f64 = 0.25;

/// The same where rays are taken to faces that they do not meet: no other ways than known ones are
/// followed there.
const DEEPEST: f64 = 1e-3;

/// So close to an edge it is not sure to which face a ray comes, in terms of how far the branch before
/// may be off that is interpolated.
const EDGE: f64 = 3.0;

/// What comes of a face is known to this share of the least power in a ray that meets it, for those that
/// are taken there may have more.
const KNOWN: f64 = 0.8;

/// Rays at the nodes are traced so much more exactly than samples, for errors of theirs are not smooth.
const CLOSER: f64 = 0.2;

/// What a ray at a node costs at least in terms of a sample's (measured: more divisions would save rays, and
/// cost each sample the terms of more patches).
const COST: f64 = 4.0;

/// What it costs at least, as a share of that, for light has to come to where rays part.
const LEAST_COST: f64 = 0.03;

/// What a division leaves to be traced of what was.
const LEFT_AFTER_DIVISION: f64 = 0.5;

/// What a branch costs that is looked at for rays at nodes, in terms of a sample's (measured).
const COST_OF_BRANCH: f64 = 2.0;

/// Rays at nodes, and those that are taken to faces that they do not meet, may have these shares of as many
/// branches as all samples would have, traced.
const MOST_AT_NODES: f64 = 0.25;
const MOST_BESIDE: f64 = 0.2;

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

    /// How rays lie in it that are traced, given which leaves of the larger patch are too steep.
    fn shape(self, steep: Steep) -> Shape {
        let [width, height] = self.size;
        let is_steep = |axis: usize| steep.by_far[axis] > steep.by_far[1 - axis];
        match width.max(height) > SMALL / 2 {
            true if width >= LONG * height || is_steep(1) && width >= height => Shape::Low,
            true if height >= LONG * width || is_steep(0) && height >= width => Shape::Narrow,
            _ => self.square(steep),
        }
    }

    /// The same with as many across as down: few where little is to be told.
    fn square(self, steep: Steep) -> Shape {
        let side = self.size[0].max(self.size[1]);
        let more = usize::from(side > SMALL / 2) + usize::from(side > SMALL);
        Shape::Square(if steep.along == [0; 2] { FEWEST + more } else { MOST })
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

/// What rays share is not worth finding out.
#[derive(Clone, Copy, Debug)]
struct TooMuch;

/// How many leaves of a patch vary too fast to be functions.
#[derive(Clone, Copy, Debug, Default)]
struct Steep {
    /// Those that vary faster across, and those that do so down.
    along: [usize; 2],
    /// Those of them that vary far faster that way.
    by_far: [usize; 2],
}

/// What is known of a patch.
#[derive(Clone, Debug)]
struct Level<const N: usize> {
    patch: Patch,
    /// How the rays lie that are traced in it.
    shape: Shape,
    /// Which of its leaves are no functions because they are too steep.
    steep: Steep,
    /// The surfaces that its rays meet first.
    surfaces: Surfaces,
    /// The leaves that are interpolated, those of larger patches that it is part of, too.
    leaves: Vec<Smooth<Leaf<N>>>,
    /// Whether rays are to be traced from their start on.
    launched: bool,
    /// The surfaces between which they choose, by their places.
    choice: Choice,
    /// The branches from which on they are, interpolated up to there.
    branches: Vec<Smooth<Branch<N>>>,
    /// What all rays have of what is met there.
    left_out: LeftOut,
    /// The share of all that is to be traced.
    traced: f64,
    /// How many borders a ray meets of which nothing is left out, if that is known.
    borders: Option<f64>,
    /// What a ray at a node has cost in terms of a sample's.
    cost: f64,
    /// Where the coefficients of larger patches end.
    coefficients: usize,
}

/// Patches of at most this width and height need fewer nodes, and those of at most half of it still
/// fewer, to tell as much.
const SMALL: usize = 8;

/// Patches that are so many times as wide as high are taken as low: what has made them so, an edge, makes
/// leaves vary fast down the picture; and the other way round.
const LONG: usize = 8;

/// Rays of a patch at most: they are bits of a number.
const MOST_RAYS: usize = 64;

/// Interpolates leaves over patches, one after the other.
pub(super) struct LeafPatches<'a, const N: usize> {
    prepared: &'a PreparedScene<'a>,
    detection: &'a Detection<N>,
    scouts: FourTracers<'a, N, Trail<N>>,
    /// They take rays to faces that others meet.
    beside: FourTracers<'a, N, Trail<N>>,
    /// They trace what is not interpolated.
    tracers: FourTracers<'a, N, LeftOut>,
    /// Those that the processor has; they change no number.
    instructions: Instructions,
    functions: Functions<'a>,
    /// Whether rays go through graded media.
    graded: bool,
    /// Whether all media are homogeneous and between planes.
    faceted: bool,
    rays_per_pixel: u32,
    /// Width and height of the largest patches, pixels.
    pub side: usize,
    /// The patch that was fitted last, and before it the larger ones that it is part of.
    levels: Vec<Level<N>>,
    /// The coefficients of what is interpolated.
    coefficients: Vec<[f64; LANES]>,
    /// How often neighbouring rays of the last patch part, across the picture and down.
    cuts: [usize; 2],
    // Memory to work in.
    ways: Ways<N>,
    found: Vec<(usize, Leaf<N>)>,
    further_on: [Vec<Branch<N>>; 4],
    /// Where those are among what is left out that stand for branches further on.
    met: [Vec<usize>; 4],
    /// Of each branch of the patch above the rays that are followed from there, as bits.
    followed: Vec<u64>,
    /// The faces that rays choose at the ends of branches.
    chosen: [Vec<Option<u16>>; 4],
    /// How many rays have been traced at nodes and between them.
    pub walks: f64,
    /// The leaves of the samples of a block, and what became of the rest.
    pub samples: [(Vec<Leaf<N>>, Outcome<N>); 4],
}

impl<const N: usize> Level<N> {
    /// Where rays are traced in it.
    fn grid(&self) -> &'static Grid {
        self.shape.grid()
    }

    /// The place among the surfaces of what is past all devices.
    fn past_all(&self) -> Option<u16> {
        Some(self.surfaces.iter().position(Option::is_none)? as u16)
    }

    /// Whether a ray that meets that surface first is to be traced from its start on.
    fn is_launched(&self, surface: Option<(u16, u16)>) -> bool {
        let place = || self.surfaces.iter().position(|known| *known == surface);
        self.launched
            && (!self.choice.is_made()
                || place().is_some_and(|place| self.choice.parts_at(place as u16)))
    }
}

impl<'a, const N: usize> LeafPatches<'a, N> {
    /// For pictures of a scene with so many rays of each pixel; `None` if they are to be exact, or would gain nothing.
    pub fn new(
        prepared: &'a PreparedScene<'a>,
        detection: &'a Detection<N>,
        tracer: &Tracer<'a, N>,
        rays_per_pixel: u32,
    ) -> Option<Self> {
        let graded = prepared.assembly.is_graded();
        let exact = prepared.scene.trace.exact
            || prepared.coherence.is_some()
            || prepared.assembly.absorbs()
            || detection.first_face
            || detection.group_delays // More than two polarizations, of all channels.
            || detection.exact_times && !graded;
        if exact {
            return None;
        }
        let side = largest_side(prepared)?;
        let largest = Patch { corner: [0; 2], size: [side; 2] };
        let nodes = largest.square(Steep::default()).grid().points.len();
        if side * side * rays_per_pixel as usize <= (COST * nodes as f64) as usize {
            return None;
        }
        let devices = prepared.assembly.devices();
        let mut regions = devices.iter().flat_map(|device| &device.structure.regions);
        let Limits { min_power, tolerance } = prepared.limits;
        let limits = Limits { min_power: DEEPER * min_power, tolerance: CLOSER * tolerance };
        let beside = Limits { min_power: DEEPEST * min_power, ..limits };
        Some(Self {
            prepared,
            detection,
            scouts: FourTracers::new(&tracer.clone().within(limits).watched(Trail::default())),
            beside: FourTracers::new(&tracer.clone().within(beside).watched(Trail::default())),
            tracers: FourTracers::new(&tracer.clone().watched(LeftOut::default())),
            instructions: Instructions::new(),
            functions: Functions::of(prepared, detection),
            graded,
            faceted: regions.all(|region| !region.faces().is_empty()),
            rays_per_pixel,
            side,
            levels: Vec::new(),
            coefficients: Vec::new(),
            cuts: [0; 2],
            ways: Ways::default(),
            found: Vec::new(),
            further_on: std::array::from_fn(|_| Vec::new()),
            met: std::array::from_fn(|_| Vec::new()),
            followed: Vec::new(),
            chosen: std::array::from_fn(|_| Vec::new()),
            walks: 0.0,
            samples: std::array::from_fn(|_| (Vec::new(), Outcome::default())),
        })
    }

    /// How rays lie in a patch of that level that are traced. Beside the edge of what is graded or curved leaves
    /// vary like a root; elsewhere square grids need fewer rays.
    fn shape(&self, patch: Patch, level: usize) -> Shape {
        let above = level.checked_sub(1).and_then(|above| self.levels.get(above));
        let steep = above.map_or(Steep::default(), |above| above.steep);
        if self.faceted { patch.square(steep) } else { patch.shape(steep) }
    }

    /// The share of the patch that was fitted last that is to be traced for each sample.
    pub fn traced(&self) -> f64 {
        let share = self.levels.last().map_or(1.0, |level| level.traced);
        if share > MOST_TRACED { 1.0 } else { share }
    }

    /// How the patch that was fitted last is to be divided, if it is.
    pub fn division(&self) -> Option<[Patch; 2]> {
        let Level { patch, traced, cost, .. } = self.levels.last()?;
        let [across, down] = self.cuts;
        let [width, height] = patch.size;
        let axis = usize::from(if across == down { height > width } else { down > across });
        let divisible = |axis: &usize| patch.size[*axis] > LEAST_SIDE;
        let halves = patch.halves([axis, 1 - axis].into_iter().find(divisible)?);
        let gain = traced * (1.0 - LEFT_AFTER_DIVISION) * self.samples_in(*patch);
        let shape = self.shape(halves[0], self.levels.len());
        let rays = 2 * shape.grid().points.len();
        let cost = cost * traced.max(LEAST_COST);
        (gain > cost * rays as f64).then_some(halves)
    }

    /// Traces the rays of a patch, of that level: 0, or one more than that of the patch of which it
    /// is a half.
    pub fn fit(&mut self, patch: Patch, level: usize) -> Fit {
        if let Some(first) = self.levels.get(level) {
            self.coefficients.truncate(first.coefficients);
        }
        self.levels.truncate(level);
        self.samples.iter_mut().for_each(|(leaves, _)| leaves.clear());
        let mut here = Level {
            patch,
            shape: self.shape(patch, level),
            steep: Steep::default(),
            surfaces: Surfaces::new(),
            leaves: Vec::new(),
            launched: true,
            choice: Choice::default(),
            branches: Vec::new(),
            left_out: LeftOut::default(),
            traced: 1.0,
            borders: None,
            cost: COST,
            coefficients: self.coefficients.len(),
        };
        let fit = self.look(&mut here);
        self.levels.push(here);
        fit
    }

    fn look(&mut self, here: &mut Level<N>) -> Fit {
        let camera = &self.prepared.scene.camera;
        let grid = here.grid();
        let rays: Vec<CameraRay> = (grid.points.iter())
            .map(|place| {
                let [x, y] = here.patch.point(*place);
                camera.ray(x, y)
            })
            .collect();
        let any = &self.scouts.tracers[0];
        let first: Vec<_> =
            rays.iter().map(|ray| any.first_surface(ray.origin, ray.direction)).collect();
        // What larger patches know holds on where their surfaces are met.
        let above = self.levels.len().checked_sub(1).filter(|above| {
            first.iter().all(|surface| self.levels[*above].surfaces.contains(surface))
        });
        let known = above.map(|above| &self.levels[above].surfaces);
        let chooses = |above: usize| {
            let above = &self.levels[above];
            !above.launched || above.choice.is_made()
        };
        match known.filter(|_| above.is_some_and(chooses)) {
            Some(known) => here.surfaces = known.clone(),
            None => {
                for surface in &first {
                    let is_new = !here.surfaces.contains(surface);
                    if is_new && here.surfaces.try_push(*surface).is_err() {
                        return Fit::Shared;
                    }
                }
            }
        }
        let is_one = here.surfaces.len() == 1;
        if is_one && here.surfaces[0].is_none() {
            return Fit::Alone;
        }
        let as_first = |ray: &usize| first[*ray] == first[0];
        self.cuts = grid.cuts(bits((0..rays.len()).filter(as_first)));
        let are_planes = || here.surfaces.iter().flatten().all(|surface| any.is_plane(*surface));
        if !(is_one || self.prepared.starts_in_air && are_planes()) {
            here.surfaces.clear();
            return Fit::Shared;
        }
        self.found.clear();
        self.ways.clear();
        self.followed.clear();
        self.followed.resize(above.map_or(0, |above| self.levels[above].branches.len()), 0);
        let is_launched = |surface: &Option<(u16, u16)>| {
            above.is_none_or(|above| self.levels[above].is_launched(*surface))
        };
        let launched: Vec<bool> = first.iter().map(is_launched).collect();
        for tracer in &mut self.scouts.tracers {
            let left_out = above.map(|above| self.levels[above].left_out.clone());
            let trail = tracer.recorder();
            // Of a patch that was given up halfway something may be left.
            trail.clear();
            trail.left_out = left_out.unwrap_or_default();
        }
        let share = above.map_or(1.0, |above| self.levels[above].traced);
        for (number, four) in rays.chunks(4).enumerate() {
            let at = 4 * number;
            let ray = |i: usize| i.min(four.len() - 1);
            let launches = std::array::from_fn(|i| self.detection.launch(camera, &four[ray(i)]));
            let points = std::array::from_fn(|i| here.patch.point(grid.points[at + ray(i)]));
            let surfaces = std::array::from_fn(|i| first[at + ray(i)]);
            let least = DEEPER * self.prepared.limits.min_power;
            // Here the edges are those of the branches: of each ray something must be known.
            self.go_further_on(above, &points, &surfaces, [least, 0.0]);
            let launched_here = std::array::from_fn(|i| launched[at + ray(i)]);
            self.scouts.trace_further_on(&launches, launched_here, &self.further_on);
            self.walks += four.len() as f64 * share;
            for (i, tracer) in self.scouts.tracers.iter_mut().enumerate() {
                if i < four.len() {
                    self.ways.add(at + i, tracer.recorder(), self.prepared.limits.min_power);
                    // They are in the order of the branches that they are of.
                    let branches = above.map_or(&[][..], |above| &self.levels[above].branches);
                    let mut known = branches.iter().enumerate();
                    for branch in &self.further_on[i] {
                        let is_it = |known: &Smooth<Branch<N>>| known.first.path == branch.path;
                        if let Some((number, _)) = known.find(|(_, known)| is_it(known)) {
                            self.followed[number] |= 1 << (at + i);
                        }
                    }
                }
                tracer.recorder().clear();
                let (leaves, outcome) = tracer.traced();
                if outcome.stats != TraceStats::default() {
                    let Some(above) = above else {
                        // Light without end is told of in the picture's account, and takes its time.
                        return Fit::Alone;
                    };
                    self.keep_to_larger_patch(here, above);
                    return Fit::Shared;
                }
                if i < four.len() {
                    self.found.extend(leaves.iter().map(|leaf| (at + i, *leaf)));
                }
            }
            let comes_far = !self.faceted
                && self.ways.leave_planes
                && self.further_on.iter().any(|branches| !branches.is_empty());
            if comes_far {
                return Fit::Alone;
            }
            if self.ways.looked_at() as f64
                > MOST_AT_NODES * self.branches_to_trace(here.patch, at + four.len())
            {
                let Some(above) = above else { return Fit::Alone };
                self.divide_no_more(here, above);
                return Fit::Shared;
            }
            let looked_at = if is_one { 4 } else { rays.len() };
            if at + four.len() == looked_at
                && !self.graded
                && above.is_none()
                && self.found.len() == looked_at
            {
                // One branch in closed form is quicker than any polynomial.
                return Fit::Alone;
            }
        }
        if !is_one {
            for (ray, surface) in first.iter().enumerate().filter(|(ray, _)| launched[*ray]) {
                let number = here.surfaces.iter().position(|known| known == surface);
                self.ways.launch(ray, number.map_or(u16::MAX, |number| number as u16));
            }
        }
        let beside = self.look_beside(here, above, &rays);
        let of_samples = self.ways.of_samples().max(rays.len());
        let branches = self.ways.looked_at() as f64 / of_samples as f64;
        here.cost = COST.max(COST_OF_BRANCH * branches);
        let faces = match (beside, above) {
            (Ok(faces), _) => faces,
            (Err(TooMuch), None) => None,
            (Err(TooMuch), Some(above)) => {
                self.divide_no_more(here, above);
                return Fit::Shared;
            }
        };
        let launched = bits((0..rays.len()).filter(|ray| launched[*ray]));
        self.gather(here, above, (rays.len(), launched), faces.as_deref());
        Fit::Shared
    }

    /// How many branches all samples of a patch would have, traced, by what so many rays at nodes have.
    fn branches_to_trace(&self, patch: Patch, rays: usize) -> f64 {
        let of_each = self.ways.of_samples() as f64 / rays as f64;
        of_each.max(1.0) * self.samples_in(patch)
    }

    /// How many samples a patch has.
    fn samples_in(&self, patch: Patch) -> f64 {
        let [width, height] = patch.size;
        (width * height) as f64 * f64::from(self.rays_per_pixel)
    }

    /// Leaves it at what is known of the larger patch: that holds for its parts.
    fn keep_to_larger_patch(&mut self, here: &mut Level<N>, above: usize) {
        let Level { patch, coefficients, .. } = *here;
        *here = Level { patch, coefficients, ..self.levels[above].clone() };
        for tracer in &mut self.tracers.tracers {
            tracer.recorder().clone_from(&here.left_out);
        }
    }

    /// The same, and its parts are not looked at.
    fn divide_no_more(&mut self, here: &mut Level<N>, above: usize) {
        self.keep_to_larger_patch(here, above);
        here.cost = f64::INFINITY;
    }

    /// Where rays part because they meet different faces, takes each of them to those that others
    /// meet, so that what comes of each face is known for all: the faces.
    fn look_beside(
        &mut self,
        here: &Level<N>,
        above: Option<usize>,
        rays: &[CameraRay],
    ) -> Result<Option<Arc<Faces>>, TooMuch> {
        let least = KNOWN * self.prepared.limits.min_power;
        let Some(faces) = self.ways.faces(&here.surfaces, least) else { return Ok(None) };
        let faces = Arc::new(faces);
        let branches = above.map_or(&[][..], |above| &self.levels[above].branches);
        let is_followed = |number: usize, ray: usize| self.followed[number] >> ray & 1 == 1;
        let some_follow = |(number, branch): (usize, &Smooth<Branch<N>>)| {
            faces.of(branch.first.path) != 0 && (0..rays.len()).any(|ray| !is_followed(number, ray))
        };
        if !faces.are_several() && !branches.iter().enumerate().any(some_follow) {
            return Ok(Some(faces));
        }
        let known = self.ways.known();
        let (before, found) = (self.ways.steps(), self.found.len());
        let looked_at = self.ways.looked_at();
        let own = before as f64 / rays.len() as f64;
        let borders = above.and_then(|above| self.levels[above].borders).unwrap_or(own).max(1.0);
        let most = (MOST_BESIDE * self.branches_to_trace(here.patch, rays.len())) as usize;
        let camera = &self.prepared.scene.camera;
        for (number, four) in rays.chunks(4).enumerate() {
            let at = 4 * number;
            let ray = |i: usize| i.min(four.len() - 1);
            let launches = std::array::from_fn(|i| self.detection.launch(camera, &four[ray(i)]));
            let left = most.saturating_sub(self.ways.looked_at() - looked_at);
            for i in 0..4 {
                let ray = at + ray(i);
                let further_on = &mut self.further_on[i];
                further_on.clear();
                self.ways.with_others_beside(&faces, known, ray, further_on);
                let point = here.patch.point(here.grid().points[ray]);
                let mut terms = TermsOfLevels::at(point);
                for (number, smooth) in branches.iter().enumerate() {
                    if !is_followed(number, ray) && faces.beside(smooth.first.path, ray) != 0 {
                        let mut branch = smooth.first;
                        let terms = terms.of(&self.levels, smooth.level);
                        smooth.move_to(&mut branch, terms, self.functions, &self.coefficients);
                        further_on.push(branch);
                    }
                }
                let trail = self.beside.tracers[i].recorder();
                trail.beside = Some((Arc::clone(&faces), ray));
                trail.most_looked_at = left;
            }
            let launched = std::array::from_fn(|i| faces.beside(LAUNCHED, at + ray(i)) != 0);
            self.beside.trace_further_on(&launches, launched, &self.further_on);
            for (i, tracer) in self.beside.tracers.iter_mut().enumerate() {
                if i < four.len() {
                    self.ways.add(at + i, tracer.recorder(), self.prepared.limits.min_power);
                    let (leaves, _) = tracer.traced();
                    self.found.extend(leaves.iter().map(|leaf| (at + i, *leaf)));
                }
                tracer.recorder().clear();
            }
            if self.ways.looked_at() - looked_at >= most {
                break;
            }
        }
        self.walks += (self.ways.steps() - before) as f64 / borders;
        if self.ways.looked_at() - looked_at >= most {
            self.ways.forget_since(known);
            self.found.truncate(found);
            return Err(TooMuch);
        }
        Ok(Some(faces))
    }

    /// Puts the branches in place from which on four rays of a patch, of that level or a part of
    /// it, are followed, if they are strong enough: none without a level. Whether it is sure to which
    /// faces they come where they choose between them: no closer to edges than `edge` times what they
    /// may be off.
    fn go_further_on(
        &mut self,
        level: Option<usize>,
        points: &[[f64; 2]; 4],
        first_surfaces: &[Option<(u16, u16)>; 4],
        [least, edge]: [f64; 2],
    ) -> bool {
        let mut are_sure = true;
        let branches = level.map_or(&[][..], |level| &self.levels[level].branches);
        let known = level.map(|level| &self.levels[level].surfaces);
        for (i, point) in points.iter().enumerate() {
            let (further_on, met) = (&mut self.further_on[i], &mut self.met[i]);
            let chosen = &mut self.chosen[i];
            further_on.clear();
            met.clear();
            chosen.clear();
            // The launched ray comes before all others.
            let is_met = |surface: &Option<(u16, u16)>| *surface == first_surfaces[i];
            let first = known.and_then(|known| known.iter().position(is_met));
            chosen.push(first.map(|first| first as u16));
            let mut terms = TermsOfLevels::at(*point);
            for smooth in branches {
                chosen.push(None);
                if !smooth.is_reached(chosen) {
                    continue;
                }
                further_on.push(smooth.first);
                let Some(branch) = further_on.last_mut() else { break };
                let terms = terms.of(&self.levels, smooth.level);
                let mut is_sure = true;
                if smooth.choice.is_made() {
                    let power = branch.largest_power();
                    smooth.point_from(branch, terms, &self.coefficients);
                    let slack = edge * self.functions.place_tolerance(power);
                    let face = self.tracers.tracers[0].plane_met(branch, slack);
                    if let Some(last) = chosen.last_mut() {
                        *last = face;
                    }
                    if face.is_some_and(|face| smooth.choice.knows(face)) {
                        further_on.pop();
                        continue;
                    }
                    is_sure = face.is_some();
                }
                smooth.move_to(branch, terms, self.functions, &self.coefficients);
                if branch.largest_power() < least {
                    further_on.pop();
                    continue;
                }
                are_sure &= is_sure;
                branch.survive(least);
                met.extend(smooth.met.map(|_| smooth.place));
            }
        }
        are_sure
    }

    /// Finds out what rays of a patch share, of what so many of them have been found to meet.
    fn gather(
        &mut self,
        here: &mut Level<N>,
        above: Option<usize>,
        (rays, launched): (usize, u64),
        faces: Option<&Faces>,
    ) {
        let least = self.prepared.limits.min_power;
        let level = self.levels.len();
        let above = above.map(|above| &self.levels[above]);
        let (mut leaves, mut branches) = match above {
            Some(above) => (above.leaves.clone(), above.branches.clone()),
            None => (Vec::new(), Vec::new()),
        };
        let is_launched = above.is_none_or(|above| above.launched);
        let known_borders = above.and_then(|above| above.borders);
        here.choice = above.map_or(Choice::default(), |above| above.choice);
        let root = Start { path: LAUNCHED, rays: launched, faces: here.choice.faces };
        let starts = is_launched.then_some(root).into_iter();
        let starts = starts.chain(branches.iter().zip(&self.followed).map(|(branch, rays)| {
            Start { path: branch.first.path, rays: *rays, faces: branch.choice.faces }
        }));
        self.ways.gather(rays, starts, faces, least);
        self.ways.drop_lost(&mut leaves, &mut branches);
        here.steep = self.fit_leaves(here.grid(), level, &mut leaves);
        self.fit_branches(here.grid(), level, &mut branches);
        // Rays may part where they were thought to choose.
        self.ways.drop_lost(&mut leaves, &mut branches);
        if is_launched {
            here.choice = self.ways.choice_in_part(LAUNCHED, here.choice, faces);
        }
        for branch in &mut branches {
            branch.choice = self.ways.choice_in_part(branch.first.path, branch.choice, faces);
        }
        let mut starts: Vec<Origin> = branches.iter().map(Origin::of).collect();
        starts.sort_unstable_by_key(|start| start.path);
        self.keep_what_is_needed(here, &mut leaves, &mut branches);
        self.find_choices_before(here, &starts, &mut leaves, &mut branches);
        for part in self.ways.some_have() {
            let cuts = here.grid().cuts(part);
            self.cuts = [0, 1].map(|axis| self.cuts[axis] + cuts[axis]);
        }
        self.cuts = [0, 1].map(|axis| self.cuts[axis] + here.steep.along[axis]);
        let borders = known_borders.unwrap_or_else(|| self.ways.borders());
        here.borders = Some(borders);
        here.traced = (self.ways.borders_to_trace() / borders).min(1.0);
        here.launched = match here.choice.is_made() {
            true => here.choice.parting != 0,
            false => self.ways.parts(LAUNCHED),
        };
        here.left_out = LeftOut::new(self.ways.met());
        let find = |path: u64, level_of: usize, known: Option<u64>| {
            let met = if level_of == level { Some(path) } else { known };
            let met = met.and_then(|path| self.ways.met_before(path, &starts));
            (met, met.map_or(0, |path| here.left_out.place(path)))
        };
        for leaf in &mut leaves {
            (leaf.met, leaf.place) = find(leaf.first.path, leaf.level, leaf.met);
        }
        for branch in &mut branches {
            (branch.met, branch.place) = find(branch.first.path, branch.level, branch.met);
        }
        (here.leaves, here.branches) = (leaves, branches);
        for tracer in &mut self.tracers.tracers {
            tracer.recorder().clone_from(&here.left_out);
        }
    }

    /// Drops the branches at whose ends rays neither part nor choose, and what is traced; puts the
    /// branches in an order in which each comes after those before it.
    fn keep_what_is_needed(
        &self,
        here: &Level<N>,
        leaves: &mut Vec<Smooth<Leaf<N>>>,
        branches: &mut Vec<Smooth<Branch<N>>>,
    ) {
        let (ways, level) = (&self.ways, self.levels.len());
        let is_known = |path: u64, known_at: usize| known_at < level || ways.has(path);
        branches.retain(|branch| {
            let path = branch.first.path;
            branch.choice.is_made() || ways.parts(path) && is_known(path, branch.level)
        });
        branches.sort_by_key(|branch| {
            let depth = || ways.depth(branch.first.path);
            (branch.level, if branch.level == level { depth() } else { 0 })
        });
        leaves.retain(|leaf| match leaf.first.path {
            // Of a launched ray that is traced, so is the leaf without a device.
            LAUNCHED => here
                .past_all()
                .is_some_and(|place| here.choice.is_made() && !here.choice.parts_at(place)),
            path => is_known(path, leaf.level),
        });
    }

    /// Finds the last choices of rays before leaves and branches.
    fn find_choices_before(
        &self,
        here: &Level<N>,
        starts: &[Origin],
        leaves: &mut [Smooth<Leaf<N>>],
        branches: &mut [Smooth<Branch<N>>],
    ) {
        let level = self.levels.len();
        let paths = branches.iter().map(|branch| branch.first.path);
        let mut numbers: Vec<(u64, usize)> = paths.zip(1..).collect();
        numbers.sort_unstable();
        let given = |path: u64| match self.ways.chosen_on_the_way(path) {
            Ok(chosen) => Some(chosen),
            Err(LAUNCHED) if path == LAUNCHED => Some((LAUNCHED, here.past_all()?)),
            Err(start) => ways::origin(starts, start)?.given,
        };
        // The launched ray comes before all branches.
        let number_of = |(chooser, _): (u64, u16)| match chooser {
            LAUNCHED => Some(0),
            _ => {
                let found = numbers.binary_search_by_key(&chooser, |(path, _)| *path).ok()?;
                Some(numbers[found].1)
            }
        };
        let chooser = |given: Option<(u64, u16)>| given.and_then(number_of).unwrap_or(usize::MAX);
        for branch in branches {
            if branch.level == level {
                branch.given = given(branch.first.path);
            }
            branch.chooser = chooser(branch.given);
        }
        for leaf in leaves {
            if leaf.level == level {
                leaf.given = given(leaf.first.path);
            }
            leaf.chooser = chooser(leaf.given);
        }
    }

    /// Makes functions of the leaves that all rays have; where they are none, rays part. Which are none
    /// because they are too steep.
    fn fit_leaves(
        &mut self,
        grid: &Grid,
        level: usize,
        smooth_leaves: &mut Vec<Smooth<Leaf<N>>>,
    ) -> Steep {
        let mut steep = Steep::default();
        let mut found: Vec<_> =
            (self.found.iter()).map(|(ray, leaf)| (leaf.path, *ray, leaf)).collect();
        found.sort_unstable_by_key(|(path, ray, _)| (*path, *ray));
        for way in found.chunk_by(|(one, ..), (other, ..)| one == other) {
            let path = way[0].0;
            let power = way.iter().map(|(.., leaf)| leaf.largest_power()).fold(0.0, f64::max);
            if power < self.prepared.limits.min_power || !self.ways.has(path) {
                continue;
            }
            if path != LAUNCHED && self.ways.choice(path).is_made() {
                // At some face it ends.
                self.ways.part_at(path);
                continue;
            }
            // Were there two of a ray, they would be no function.
            let of_rays = way.iter().map(|(_, ray, leaf)| (*ray, *leaf)).take(MOST_RAYS);
            let of_rays: ArrayVec<(usize, &Leaf<N>), MOST_RAYS> = of_rays.collect();
            match smooth(&of_rays, grid, self.functions, level, &mut self.coefficients) {
                Ok(leaf) => smooth_leaves.push(leaf),
                Err(rough) => {
                    if let Rough::Steep { axis, far } = rough {
                        steep.along[axis] += 1;
                        steep.by_far[axis] += usize::from(far);
                    }
                    self.ways.part_at(path);
                }
            }
        }
        steep
    }

    /// Makes functions of the branches at whose ends rays part; those that are none are followed
    /// from the branch before.
    fn fit_branches(
        &mut self,
        grid: &Grid,
        level: usize,
        smooth_branches: &mut Vec<Smooth<Branch<N>>>,
    ) {
        let mut known: Vec<u64> = smooth_branches.iter().map(|branch| branch.first.path).collect();
        known.push(LAUNCHED);
        loop {
            let parting = self.ways.parting().filter(|path| !known.contains(path));
            let parting: Vec<u64> = parting.collect();
            if parting.is_empty() {
                return;
            }
            if !self.faceted && self.ways.leave_planes {
                parting.into_iter().for_each(|path| self.ways.part_before(path));
                continue;
            }
            let mut rough: Vec<u64> = Vec::new();
            let movable = self.ways.movable(&parting);
            let mut ways = movable.chunk_by(|(one, ..), (other, ..)| one == other).peekable();
            for path in parting {
                let way = ways.next_if(|way| way[0].0 == path).unwrap_or_default();
                let of_rays = way.iter().map(|(_, ray, branch)| (*ray, *branch)).take(MOST_RAYS);
                let of_rays: ArrayVec<(usize, &Branch<N>), MOST_RAYS> = of_rays.collect();
                match smooth(&of_rays, grid, self.functions, level, &mut self.coefficients) {
                    Ok(branch) => {
                        known.push(path);
                        smooth_branches.push(branch);
                    }
                    Err(_) => rough.push(path),
                }
            }
            for path in rough {
                self.ways.part_before(path);
            }
        }
    }

    /// Finds the leaves of the rays of a block of the patch that was fitted last; whether its rays
    /// are like those of the patch, and nothing rare has come of them.
    pub fn sample(&mut self, points: &[[f64; 2]; 4], rays: &[CameraRay; 4]) -> bool {
        let Some(here) = self.levels.last() else { return false };
        let is_traced = here.launched || !here.branches.is_empty() || here.choice.is_made();
        let tracer = &self.tracers.tracers[0];
        let met = rays.each_ref().map(|ray| tracer.first_surface(ray.origin, ray.direction));
        if !met.iter().all(|surface| here.surfaces.contains(surface)) {
            return false;
        }
        let launched = met.map(|surface| here.is_launched(surface));
        if is_traced {
            let level = self.levels.len().checked_sub(1);
            let least = self.prepared.limits.min_power;
            let instructions = self.instructions;
            let limits = [least, EDGE];
            if !instructions.with(
                #[inline(always)]
                || self.go_further_on(level, points, &met, limits),
            ) {
                return false;
            }
            let camera = &self.prepared.scene.camera;
            self.tracers.tracers.iter_mut().for_each(|tracer| tracer.recorder().begin());
            let launches = rays.each_ref().map(|ray| self.detection.launch(camera, ray));
            self.tracers.trace_further_on(&launches, launched, &self.further_on);
        }
        let mut as_traced = true;
        for (i, point) in points.iter().enumerate() {
            let mut leaves = std::mem::take(&mut self.samples[i].0);
            as_traced &= self.instructions.with(
                #[inline(always)]
                || self.interpolated(*point, i, &mut leaves),
            );
            if is_traced {
                let (others, outcome) = self.tracers.tracers[i].traced();
                leaves.extend_from_slice(others);
                // What is rare is looked at more closely.
                as_traced &= outcome.stats == TraceStats::default();
                let left_out = self.tracers.tracers[i].watcher();
                as_traced &=
                    self.faceted || self.further_on[i].is_empty() || !left_out.has_left_planes();
                as_traced &= self.met[i].iter().all(|place| left_out.has_met(*place));
            }
            let mut outcome = Outcome::default();
            // What has met nothing keeps its power to the last bit.
            if !goes_past_all(&leaves) {
                for (i, pruned) in outcome.pruned.iter_mut().enumerate() {
                    *pruned = (1.0 - leaves.iter().map(|leaf| leaf.power[i]).sum::<f64>()).max(0.0);
                }
            }
            self.samples[i] = (leaves, outcome);
        }
        as_traced
    }

    /// The leaves at a point of the picture that are interpolated and strong enough; whether the
    /// ray of that number in its block, if it is traced, has met what is left out of it for them.
    #[inline(always)]
    fn interpolated(&self, point: [f64; 2], ray: usize, leaves: &mut Vec<Leaf<N>>) -> bool {
        let Some(here) = self.levels.last() else { return false };
        let least = self.prepared.limits.min_power;
        let mut terms = TermsOfLevels::at(point);
        let (mut as_traced, mut count) = (true, 0);
        for smooth in &here.leaves {
            if !smooth.is_reached(&self.chosen[ray]) {
                continue;
            }
            let terms = terms.of(&self.levels, smooth.level);
            // Leaves are large: those of the last sample stay where they are, and are moved.
            if leaves.get(count).is_none_or(|leaf| leaf.path != smooth.first.path) {
                leaves.truncate(count);
                leaves.push(smooth.first);
            }
            let leaf = &mut leaves[count];
            smooth.move_to(leaf, terms, self.functions, &self.coefficients);
            if leaf.largest_power() < least {
                continue;
            }
            count += 1;
            leaf.survives_alone = leaf.power.map(|power| power >= least);
            if smooth.met.is_some() {
                as_traced &= self.tracers.tracers[ray].watcher().has_met(smooth.place);
            }
        }
        leaves.truncate(count);
        as_traced
    }
}

/// The terms at one point of the picture in a patch or a larger one that it is part of, one after the other.
struct TermsOfLevels {
    point: [f64; 2],
    level: Option<usize>,
    terms: Terms,
}

impl TermsOfLevels {
    #[inline(always)]
    fn at(point: [f64; 2]) -> Self {
        Self { point, level: None, terms: Terms::default() }
    }

    #[inline(always)]
    fn of<const N: usize>(&mut self, levels: &[Level<N>], level: usize) -> &Terms {
        if self.level != Some(level) {
            self.level = Some(level);
            let Level { patch, shape, .. } = &levels[level];
            self.terms = Terms::at(patch.place(self.point), *shape);
        }
        &self.terms
    }
}

/// Whether a ray with these leaves has met nothing.
pub(super) fn goes_past_all<const N: usize>(leaves: &[Leaf<N>]) -> bool {
    matches!(leaves, [leaf] if leaf.path == LAUNCHED)
}

/// How large patches may be, pixels: no larger than the smallest of several devices or parts looks,
/// straight or by way of another device, so that none is stepped over by the nodes; `None` if there
/// may be no patches. A single device of one part is seen by all rays themselves.
fn largest_side(prepared: &PreparedScene<'_>) -> Option<usize> {
    let devices = prepared.assembly.devices();
    let from = prepared.scene.camera.position;
    let middle = |device: &Placed| device.pose.to_world(DVec3::ZERO);
    let pixels = |device: &Placed| {
        let at = middle(device);
        let by_way_of = |other: &Placed| from.distance(middle(other)) + middle(other).distance(at);
        // Itself among the others: the straight way.
        let distance = devices.iter().map(by_way_of).fold(0.0, f64::max);
        device.least_extent() / prepared.pixel.width_at(distance)
    };
    let smallest = match devices {
        [single] if !single.has_parts() => f64::INFINITY,
        _ => devices.iter().map(pixels).fold(f64::INFINITY, f64::min),
    };
    let sides = std::iter::successors(Some(SIDE), |side| Some(side / 2));
    sides.take_while(|side| *side >= LEAST_SIDE).find(|side| *side as f64 <= smallest)
}
