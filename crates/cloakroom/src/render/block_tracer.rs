//! The rays of a picture, in blocks of 2 x 2 pixels: interpolated where neighbours share their work,
//! else traced.

use super::detection::Detection;
use super::exposure::Traced;
use super::patch::{self, Fit, LeafPatches, Patch};
use super::prepared_scene::PreparedScene;
use crate::scene::CameraRay;
use crate::trace::{FourTracers, Stopped, TraceStats, Tracer};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Rows of a band of a picture: those of a row of patches.
pub const BAND_ROWS: u32 = patch::SIDE as u32;

/// The most wavelengths at which a picture is traced, and once more for what is not a color.
pub(super) const MOST_TRACERS: usize = 36;

/// Of each tracer the share of a patch that it is to trace, if that is known.
type Shares = [Option<f64>; MOST_TRACERS];

/// One thread's tracers.
pub(crate) struct BlockTracer<'a, const N: usize> {
    pub prepared: &'a PreparedScene<'a>,
    detection: &'a Detection<N>,
    tracers: FourTracers<'a, N>,
    patches: Option<LeafPatches<'a, N>>,
    /// Whether the leaves of the last block are interpolated.
    interpolated: bool,
    /// How many rays of samples have been followed to their ends, and met something there.
    pub(super) walks: f64,
}

impl<'a, const N: usize> BlockTracer<'a, N> {
    /// For so many rays of each pixel.
    pub fn new(prepared: &'a PreparedScene<'a>, detection: &'a Detection<N>, samples: u32) -> Self {
        let tracer = Tracer::new(&prepared.assembly, prepared.limits).with_screen(prepared.screen);
        let tracer = match detection.wants_group_paths() {
            true => tracer.with_group_delays_to(detection.pulse_tolerance),
            false => tracer,
        };
        let tracer = match prepared.coherence {
            // In media that absorb, the power that fields exchange is booked with what they absorb.
            Some(coherence)
                if prepared.assembly.is_hardly_birefringent(coherence.reach())
                    && !prepared.assembly.absorbs() =>
            {
                tracer.joining_similar(coherence)
            }
            _ => tracer,
        };
        Self {
            prepared,
            detection,
            tracers: FourTracers::new(&tracer),
            patches: LeafPatches::new(prepared, detection, &tracer, samples),
            interpolated: false,
            walks: 0.0,
        }
    }

    /// Width and height of the largest patches.
    pub(super) fn side(&self) -> usize {
        self.patches.as_ref().map_or(patch::SIDE, |patches| patches.side)
    }

    /// How many rays have been followed at the nodes of patches.
    pub(super) fn walks_at_nodes(&self) -> f64 {
        self.patches.as_ref().map_or(0.0, |patches| patches.walks)
    }

    /// Goes through the blocks of a rectangle of the picture, patch by patch, with the share of each
    /// block that each of the tracers is to trace. A block may reach beyond the rectangle.
    ///
    /// # Errors
    ///
    /// If the work was stopped.
    pub fn for_blocks(
        tracers: &mut [Self],
        corner: [usize; 2],
        size: [usize; 2],
        stop: &AtomicBool,
        mut take: impl FnMut(&mut [Self], [usize; 2], &[f64]) -> Result<(), Stopped>,
    ) -> Result<(), Stopped> {
        // Patches are those of the whole picture, and may reach beyond the rectangle.
        let side = Self::common_side(tracers);
        let [left, top] = corner.map(|corner| corner / side * side);
        let is_seen = |patch: Patch| !patch.part_of(corner, size).iter().any(Range::is_empty);
        let is_stopped = || stop.load(Ordering::Relaxed);
        let mut take = |tracers: &mut [Self], patch: Patch, traced: &[f64]| {
            let [columns, rows] = patch.part_of(corner, size);
            rows.step_by(2).try_for_each(|top| {
                columns.clone().step_by(2).try_for_each(|left| take(tracers, [left, top], traced))
            })
        };
        for top in (top..corner[1] + size[1]).step_by(side) {
            for left in (left..corner[0] + size[0]).step_by(side) {
                let patch = Patch { corner: [left, top], size: [side; 2] };
                let is_wanted = |patch| is_seen(patch) && !is_stopped();
                Self::divide(tracers, (patch, 0), &[None; MOST_TRACERS], &is_wanted, &mut take)?;
            }
        }
        if is_stopped() { Err(Stopped) } else { Ok(()) }
    }

    /// Width and height of the largest patches of all the tracers.
    pub(super) fn common_side(tracers: &[Self]) -> usize {
        tracers.iter().map(Self::side).min().unwrap_or(patch::SIDE)
    }

    /// Divides a patch as far as is worthwhile, and does to each part, of which the tracers are to trace
    /// some share each, what is to be done; parts that are not wanted are left out. `known` is as
    /// [`fit`](Self::fit) has it.
    fn divide(
        tracers: &mut [Self],
        (patch, level): (Patch, usize),
        known: &Shares,
        is_wanted: &impl Fn(Patch) -> bool,
        take: &mut impl FnMut(&mut [Self], Patch, &[f64]) -> Result<(), Stopped>,
    ) -> Result<(), Stopped> {
        if !is_wanted(patch) {
            return Ok(());
        }
        let (shares, division) = Self::fit(tracers, (patch, level), known);
        match division {
            Some(halves) => halves.into_iter().try_for_each(|half| {
                Self::divide(tracers, (half, level + 1), &shares, is_wanted, take)
            }),
            None => {
                let count = tracers.len();
                take(tracers, patch, &shares.map(|share| share.unwrap_or(1.0))[..count])
            }
        }
    }

    /// Finds out what rays of a patch share: how much of it each of the tracers is to trace, and its
    /// halves if it is to be divided; `known` are the shares of the tracers for which no part of the patch
    /// is to be looked at again.
    pub(super) fn fit(
        tracers: &mut [Self],
        (patch, level): (Patch, usize),
        known: &Shares,
    ) -> (Shares, Option<[Patch; 2]>) {
        let (mut shares, mut division) = (*known, None);
        for (tracer, share) in tracers.iter_mut().zip(&mut shares) {
            if share.is_some() {
                continue;
            }
            *share = Some(1.0);
            if let Some(patches) = &mut tracer.patches
                && patches.fit(patch, level) == Fit::Shared
            {
                let halves = patches.division();
                division = division.or(halves);
                *share = halves.is_none().then(|| patches.traced());
            }
        }
        (shares, division)
    }

    /// Interpolates the leaves of the rays through four points of the picture, a block of a patch of
    /// which so much is traced; whether that can be done.
    pub fn interpolate(
        &mut self,
        points: &[[f64; 2]; 4],
        rays: &[CameraRay; 4],
        traced: f64,
    ) -> bool {
        let patches = self.patches.as_mut().filter(|_| traced < 1.0);
        self.interpolated = patches.is_some_and(|patches| patches.sample(points, rays));
        if self.interpolated {
            self.walks += 4.0 * traced;
        }
        self.interpolated
    }

    /// Whether rays go past all there is, but for the photograph.
    pub fn meet_nothing(&self, rays: &[CameraRay; 4]) -> bool {
        let any = &self.tracers.tracers[0];
        self.prepared.starts_in_air
            && rays.iter().all(|ray| any.meets_nothing(ray.origin, ray.direction))
    }

    /// Traces the rays of a block.
    pub fn trace(&mut self, rays: &[CameraRay; 4]) {
        self.interpolated = false;
        let camera = &self.prepared.scene.camera;
        self.tracers.trace(&rays.each_ref().map(|ray| self.detection.launch(camera, ray)));
        let traced = self.tracers.tracers.iter().map(|tracer| tracer.traced().0);
        self.walks += traced.filter(|leaves| !patch::goes_past_all(leaves)).count() as f64;
    }

    /// What has become of the rays of the last block.
    pub fn traced(&self, rays: &[CameraRay; 4]) -> [Traced<'_, N>; 4] {
        let patches = self.patches.as_ref().filter(|_| self.interpolated);
        std::array::from_fn(|i| {
            let ray = rays[i];
            if let Some(patches) = patches {
                let (leaves, outcome) = &patches.samples[i];
                return Traced { ray, leaves, outcome, first_face: None };
            }
            let tracer = &self.tracers.tracers[i];
            let (leaves, outcome) = tracer.traced();
            let launch = || self.detection.launch(&self.prepared.scene.camera, &ray);
            let first_face =
                self.detection.first_face.then(|| tracer.first_face(&launch())).flatten();
            Traced { ray, leaves, outcome, first_face }
        })
    }

    /// What was rare in the last block.
    pub fn stats(&self) -> TraceStats {
        let mut stats = TraceStats::default();
        if !self.interpolated {
            self.tracers.tracers.iter().for_each(|tracer| stats += tracer.traced().1.stats);
        }
        stats
    }
}
