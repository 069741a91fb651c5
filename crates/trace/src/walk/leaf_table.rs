//! Many rays at once, their leaves side by side in arrays.

use super::neighbours::side_by_side;
use super::{
    Coherence, FourTracers, Launch, Leaf, Limits, Outcome, PathGatherer, PathTable, Tracer,
};
use crate::assembly::Assembly;
use crate::split_mix::{STEP, mix};
use num_complex::Complex64;
use std::error::Error;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// Fewest and most rays that one thread takes at a time.
const BATCH: [usize; 2] = [64, 4096];

/// Batches a thread, so that all end at about the same time.
const BATCHES: usize = 16;

/// Which of `count` rays one thread takes at a time.
pub fn batches(count: usize) -> Vec<Range<usize>> {
    let size = (count / (BATCHES * crate::parallel::threads())).clamp(BATCH[0], BATCH[1]);
    (0..count).step_by(size).map(|first| first..count.min(first + size)).collect()
}

/// Work was stopped from outside before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("stopped")]
pub struct Stopped;

impl Stopped {
    /// Whether an error says so, or one that has caused it.
    #[must_use]
    pub fn is_in(error: &(dyn Error + 'static)) -> bool {
        std::iter::successors(Some(error), |error| (**error).source()).any(<dyn Error>::is::<Self>)
    }
}

/// How rays are followed, and what becomes of their leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaySettings {
    /// How far branches are followed.
    pub limits: Limits,
    /// The light whose leaves of one direction are added as fields; absent: each leaf stays as it
    /// is.
    pub coherence: Option<Coherence>,
    /// Whether leaves are to know what a pulse takes.
    pub group_delays: bool,
    /// The seed by which one leaf of each ray is drawn, with a probability of its power (the mean
    /// over the launched polarizations), and none with that of what is absorbed or pruned; absent:
    /// all are kept.
    pub pick: Option<u64>,
    /// How far the paths of leaves are followed beyond the devices, cm, where the paths of rays are
    /// to be kept; they go with neither `coherence` nor `pick`, and are left out there.
    pub paths: Option<f64>,
}

impl From<Limits> for RaySettings {
    fn from(limits: Limits) -> Self {
        Self { limits, coherence: None, group_delays: false, pick: None, paths: None }
    }
}

/// What became of many rays, each with `N` polarizations: the leaves of all of them, ray by ray, the
/// strongest of each first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafTable<const N: usize = 1> {
    /// The number of the ray that each leaf is of, counted from 0.
    pub ray: Vec<u32>,
    /// The last point at which each leaf left a device, cm; NaN if it met none.
    pub position: Vec<[f64; 3]>,
    /// Its direction, a unit vector.
    pub direction: Vec<[f64; 3]>,
    /// Its share of the power of its ray, for each launched polarization.
    pub power: Vec<[f64; N]>,
    /// Optical path length from the ray's origin to `position`, cm; 0 if it met no device.
    pub optical_path: Vec<f64>,
    /// The speed of light times what a pulse takes from the ray's origin to `position`, cm; 0 if it
    /// met no device, NaN where it is not known or not asked for.
    pub group_path: Vec<f64>,
    /// Its electric field for each launched polarization; |E|² = power.
    pub electric_field: Vec<[[Complex64; 3]; N]>,
    /// For each ray: the share of its power absorbed, by media or on opaque bodies.
    pub absorbed: Vec<[f64; N]>,
    /// For each ray: the share of its power in branches too weak to follow.
    pub pruned: Vec<[f64; N]>,
    /// The paths of the rays, if they were to be kept.
    pub paths: Option<PathTable<N>>,
}

impl<const N: usize> LeafTable<N> {
    /// Bytes of a leaf.
    const LEAF: usize = 4 + 24 + 24 + 8 * N + 8 + 8 + 48 * N;

    /// Bytes that a ray with one leaf takes.
    pub const BYTES_PER_RAY: usize = Self::LEAF + 16 * N;

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let paths = self.paths.as_ref().map_or(0, PathTable::bytes);
        self.ray.len() * Self::LEAF + self.absorbed.len() * 16 * N + paths
    }

    /// Traces the rays `launch(0)` to `launch(count - 1)`, which may be 2^32 at most; `done` is
    /// told now and then, from any thread, what has become of further rays. With the feature
    /// `rayon`, on all threads; the table is the same. While it is put together it is in memory
    /// twice.
    ///
    /// # Errors
    ///
    /// The error of the first ray that `launch` refuses, or [`Stopped`].
    pub fn trace<E: From<Stopped> + Send>(
        assembly: &Assembly,
        settings: impl Into<RaySettings>,
        count: usize,
        launch: &(impl Fn(usize) -> Result<Launch<N>, E> + Sync),
        done: &(dyn Fn(&Self) + Sync),
        stop: &AtomicBool,
    ) -> Result<Self, E> {
        let settings = settings.into();
        let alone = settings.coherence.is_none() && settings.pick.is_none();
        let reach = settings.paths.filter(|_| alone);
        let batches = crate::parallel::map_each(batches(count), |rays| {
            if stop.load(Ordering::Relaxed) {
                return Err(E::from(Stopped));
            }
            let table = match reach {
                Some(reach) => Self::with_paths(assembly, &settings, reach, rays, launch)?,
                None => Self::of_batch(assembly, &settings, rays, launch)?,
            };
            done(&table);
            Ok(table)
        });
        // In order, so that the first bad ray is the one that is named.
        let batches = batches.into_iter().collect::<Result<Vec<Self>, E>>()?;
        let leaves = batches.iter().map(|batch| batch.ray.len()).sum();
        let mut all = Self::with_capacity(leaves, count);
        all.paths = reach.map(|_| PathTable::default());
        batches.into_iter().for_each(|batch| all.append(batch));
        Ok(all)
    }

    fn of_batch<E>(
        assembly: &Assembly,
        settings: &RaySettings,
        rays: Range<usize>,
        launch: &impl Fn(usize) -> Result<Launch<N>, E>,
    ) -> Result<Self, E> {
        let tracer = Tracer::<N>::new(assembly, settings.limits);
        let tracer = if settings.group_delays { tracer.with_group_delays() } else { tracer };
        let coherence = settings.coherence;
        let mut tracers = FourTracers::new(&match coherence {
            Some(coherence) => tracer.joining(coherence),
            None => tracer,
        });
        let mut table = Self::default();
        let launches = rays.clone().map(launch).collect::<Result<Vec<Launch<N>>, _>>()?;
        let mut all_leaves: Vec<Leaf<N>> = Vec::new();
        let mut ended = Vec::with_capacity(launches.len());
        for four in side_by_side(&launches).chunks(4) {
            tracers.trace(&std::array::from_fn(|i| launches[four[i.min(four.len() - 1)]]));
            for (ray, tracer) in four.iter().zip(&tracers.tracers) {
                let (leaves, outcome) = tracer.traced();
                let (first, mut outcome) = (all_leaves.len(), *outcome);
                match &coherence {
                    Some(coherence) => {
                        all_leaves.extend(coherence.gather(leaves));
                        if assembly.absorbs() {
                            for i in 0..N {
                                let out: f64 = all_leaves[first..].iter().map(|l| l.power[i]).sum();
                                outcome.absorbed[i] = 1.0 - out - outcome.pruned[i];
                            }
                        }
                    }
                    None => all_leaves.extend_from_slice(leaves),
                }
                ended.push((*ray, first..all_leaves.len(), outcome));
            }
        }
        ended.sort_by_key(|(ray, ..)| *ray);
        let mut order = Vec::new();
        for (ray, leaves, outcome) in ended {
            let (ray, leaves) = (rays.start + ray, &all_leaves[leaves]);
            table.push_picked(ray, leaves, &outcome, settings.pick, &mut order);
        }
        Ok(table)
    }

    /// The same with the paths of the rays.
    fn with_paths<E>(
        assembly: &Assembly,
        settings: &RaySettings,
        reach: f64,
        rays: Range<usize>,
        launch: &impl Fn(usize) -> Result<Launch<N>, E>,
    ) -> Result<Self, E> {
        let tracer = Tracer::<N>::new(assembly, settings.limits).watched(PathGatherer::new(reach));
        let mut tracer = if settings.group_delays { tracer.with_group_delays() } else { tracer };
        let (mut table, mut paths, mut order) = (Self::default(), PathTable::default(), Vec::new());
        for ray in rays {
            tracer.trace(&launch(ray)?);
            let (leaves, outcome) = (tracer.traced().0.to_vec(), *tracer.traced().1);
            let gathered = tracer.recorder().take(assembly, &leaves);
            let first = table.ray.len();
            table.push(ray, &leaves, &outcome, &mut order);
            let place = |leaf: usize| order.iter().position(|number| *number == leaf);
            paths.push(ray, &gathered, |leaf| Some(first + place(leaf)?));
        }
        table.paths = Some(paths);
        Ok(table)
    }

    /// Adds what became of one ray; `order` is memory to work in, which holds afterwards the numbers
    /// of the leaves that were added, in their order.
    pub fn push(
        &mut self,
        ray: usize,
        leaves: &[Leaf<N>],
        outcome: &Outcome<N>,
        order: &mut Vec<usize>,
    ) {
        self.push_picked(ray, leaves, outcome, None, order);
    }

    fn push_picked(
        &mut self,
        ray: usize,
        leaves: &[Leaf<N>],
        outcome: &Outcome<N>,
        pick: Option<u64>,
        order: &mut Vec<usize>,
    ) {
        order.clear();
        order.extend((0..leaves.len()).filter(|number| leaves[*number].body().is_none()));
        order.sort_by(|a, b| leaves[*b].total_power().total_cmp(&leaves[*a].total_power()));
        if let Some(seed) = pick {
            let picked = picked(seed, ray, order.iter().map(|number| &leaves[*number]));
            let picked = picked.map(|place| order[place]);
            order.clear();
            order.extend(picked);
        }
        for leaf in order.iter().map(|number| &leaves[*number]) {
            // The number of rays fits into 32 bits.
            self.ray.push(ray as u32);
            let position = if leaf.met_device { leaf.position.to_array() } else { [f64::NAN; 3] };
            self.position.push(position);
            self.direction.push(leaf.direction.to_array());
            self.power.push(leaf.power);
            self.optical_path.push(if leaf.met_device { leaf.optical_path } else { 0.0 });
            let group_path = leaf.group_path.map(|path| if leaf.met_device { path } else { 0.0 });
            self.group_path.push(group_path.unwrap_or(f64::NAN));
            self.electric_field.push(leaf.electric.map(|electric| electric.components()));
        }
        // What ends on opaque bodies is absorbed there.
        let ended = leaves.iter().filter(|leaf| leaf.body().is_some());
        let ended = |i: usize| ended.clone().map(|leaf| leaf.power[i]).sum::<f64>();
        self.absorbed.push(std::array::from_fn(|i| outcome.absorbed[i] + ended(i)));
        self.pruned.push(outcome.pruned);
    }

    fn with_capacity(leaves: usize, rays: usize) -> Self {
        Self {
            ray: Vec::with_capacity(leaves),
            position: Vec::with_capacity(leaves),
            direction: Vec::with_capacity(leaves),
            power: Vec::with_capacity(leaves),
            optical_path: Vec::with_capacity(leaves),
            group_path: Vec::with_capacity(leaves),
            electric_field: Vec::with_capacity(leaves),
            absorbed: Vec::with_capacity(rays),
            pruned: Vec::with_capacity(rays),
            paths: None,
        }
    }

    fn append(&mut self, mut other: Self) {
        if let (Some(paths), Some(further)) = (&mut self.paths, other.paths) {
            paths.append(further, self.ray.len());
        }
        self.ray.append(&mut other.ray);
        self.position.append(&mut other.position);
        self.direction.append(&mut other.direction);
        self.power.append(&mut other.power);
        self.optical_path.append(&mut other.optical_path);
        self.group_path.append(&mut other.group_path);
        self.electric_field.append(&mut other.electric_field);
        self.absorbed.append(&mut other.absorbed);
        self.pruned.append(&mut other.pruned);
    }
}

/// Which of the leaves of a ray is drawn.
fn picked<'l, const N: usize>(
    seed: u64,
    ray: usize,
    leaves: impl Iterator<Item = &'l Leaf<N>>,
) -> Option<usize> {
    const UNIT: f64 = 1.0 / (1_u64 << 53) as f64;
    let number = mix(mix(seed).wrapping_add((ray as u64).wrapping_mul(STEP)));
    let mut left = (number >> 11) as f64 * UNIT * N as f64;
    leaves.map(Leaf::total_power).enumerate().find_map(|(place, power)| {
        left -= power;
        (left < 0.0).then_some(place)
    })
}
