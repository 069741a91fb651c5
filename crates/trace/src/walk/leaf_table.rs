//! Many rays at once, their leaves side by side in arrays.

use super::neighbours::side_by_side;
use super::{Coherence, FourTracers, Launch, Leaf, Limits, Outcome, Tracer};
use crate::assembly::Assembly;
use num_complex::Complex64;
use std::error::Error;
use std::sync::atomic::{AtomicBool, Ordering};

/// Fewest and most rays that one thread takes at a time.
const BATCH: [usize; 2] = [64, 4096];

/// Batches a thread, so that all end at about the same time.
const BATCHES: usize = 16;

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
}

impl From<Limits> for RaySettings {
    fn from(limits: Limits) -> Self {
        Self { limits, coherence: None, group_delays: false }
    }
}

/// What became of many rays: the leaves of all of them, ray by ray, the strongest of each first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafTable {
    /// The number of the ray that each leaf is of, counted from 0.
    pub ray: Vec<u32>,
    /// The last point at which each leaf left a device, cm; NaN if it met none.
    pub position: Vec<[f64; 3]>,
    /// Its direction, a unit vector.
    pub direction: Vec<[f64; 3]>,
    /// Its share of the power of its ray.
    pub power: Vec<f64>,
    /// Optical path length from the ray's origin to `position`, cm; 0 if it met no device.
    pub optical_path: Vec<f64>,
    /// The speed of light times what a pulse takes from the ray's origin to `position`, cm; 0 if it
    /// met no device, NaN where it is not known or not asked for.
    pub group_path: Vec<f64>,
    /// Its electric field; |E|² = power.
    pub electric_field: Vec<[Complex64; 3]>,
    /// For each ray: the share of its power absorbed, by media or on opaque bodies.
    pub absorbed: Vec<f64>,
    /// For each ray: the share of its power in branches too weak to follow.
    pub pruned: Vec<f64>,
}

impl LeafTable {
    /// Bytes of a leaf.
    const LEAF: usize = 4 + 24 + 24 + 8 + 8 + 8 + 48;

    /// Bytes that a ray with one leaf takes.
    pub const BYTES_PER_RAY: usize = Self::LEAF + 16;

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.ray.len() * Self::LEAF + self.absorbed.len() * 16
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
        launch: &(impl Fn(usize) -> Result<Launch<1>, E> + Sync),
        done: &(dyn Fn(&Self) + Sync),
        stop: &AtomicBool,
    ) -> Result<Self, E> {
        let settings = settings.into();
        let size = (count / (BATCHES * crate::parallel::threads())).clamp(BATCH[0], BATCH[1]);
        let batches = crate::parallel::map(count.div_ceil(size), |batch| {
            if stop.load(Ordering::Relaxed) {
                return Err(E::from(Stopped));
            }
            let tracer = Tracer::<1>::new(assembly, settings.limits);
            let tracer = if settings.group_delays { tracer.with_group_delays() } else { tracer };
            let mut tracers = FourTracers::new(&match settings.coherence {
                Some(coherence) => tracer.joining(coherence),
                None => tracer,
            });
            let rays = batch * size..count.min((batch + 1) * size);
            let table = Self::of_batch(&mut tracers, settings.coherence, rays, launch)?;
            done(&table);
            Ok(table)
        });
        // In order, so that the first bad ray is the one that is named.
        let batches = batches.into_iter().collect::<Result<Vec<Self>, E>>()?;
        let leaves = batches.iter().map(|batch| batch.ray.len()).sum();
        let mut all = Self::with_capacity(leaves, count);
        batches.into_iter().for_each(|batch| all.append(batch));
        Ok(all)
    }

    fn of_batch<E>(
        tracers: &mut FourTracers<'_, 1>,
        coherence: Option<Coherence>,
        rays: std::ops::Range<usize>,
        launch: &impl Fn(usize) -> Result<Launch<1>, E>,
    ) -> Result<Self, E> {
        let mut table = Self::default();
        let launches = rays.clone().map(launch).collect::<Result<Vec<Launch<1>>, _>>()?;
        let mut all_leaves: Vec<Leaf<1>> = Vec::new();
        let mut ended = Vec::with_capacity(launches.len());
        for four in side_by_side(&launches).chunks(4) {
            tracers.trace(&std::array::from_fn(|i| launches[four[i.min(four.len() - 1)]]));
            for (ray, tracer) in four.iter().zip(&tracers.tracers) {
                let (leaves, outcome) = tracer.traced();
                let (first, mut outcome) = (all_leaves.len(), *outcome);
                match &coherence {
                    Some(coherence) => {
                        all_leaves.extend(coherence.gather(leaves));
                        if tracer.assembly.absorbs() {
                            let out: f64 = all_leaves[first..].iter().map(|l| l.power[0]).sum();
                            outcome.absorbed[0] = 1.0 - out - outcome.pruned[0];
                        }
                    }
                    None => all_leaves.extend_from_slice(leaves),
                }
                ended.push((*ray, first..all_leaves.len(), outcome));
            }
        }
        ended.sort_by_key(|(ray, ..)| *ray);
        let mut sorted: Vec<Leaf<1>> = Vec::new();
        for (ray, leaves, outcome) in ended {
            table.push(rays.start + ray, &all_leaves[leaves], &outcome, &mut sorted);
        }
        Ok(table)
    }

    /// Adds what became of one ray; `sorted` is memory to work in.
    pub fn push(
        &mut self,
        ray: usize,
        leaves: &[Leaf<1>],
        outcome: &Outcome<1>,
        sorted: &mut Vec<Leaf<1>>,
    ) {
        sorted.clear();
        sorted.extend(leaves.iter().filter(|leaf| leaf.body().is_none()));
        sorted.sort_by(|a, b| b.power[0].total_cmp(&a.power[0]));
        for leaf in sorted.iter() {
            // The number of rays fits into 32 bits.
            self.ray.push(ray as u32);
            let position = if leaf.met_device { leaf.position.to_array() } else { [f64::NAN; 3] };
            self.position.push(position);
            self.direction.push(leaf.direction.to_array());
            self.power.push(leaf.power[0]);
            self.optical_path.push(if leaf.met_device { leaf.optical_path } else { 0.0 });
            let group_path = leaf.group_path.map(|path| if leaf.met_device { path } else { 0.0 });
            self.group_path.push(group_path.unwrap_or(f64::NAN));
            self.electric_field.push(leaf.electric[0].components());
        }
        // What ends on opaque bodies is absorbed there.
        let ended: f64 = leaves.iter().filter(|l| l.body().is_some()).map(|l| l.power[0]).sum();
        self.absorbed.push(outcome.absorbed[0] + ended);
        self.pruned.push(outcome.pruned[0]);
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
        }
    }

    fn append(&mut self, mut other: Self) {
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
