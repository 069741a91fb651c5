//! Many rays at once, their leaves side by side in arrays.

use super::neighbours::side_by_side;
use super::{Bench, FourTracers, Launch, Leaf, Limits, Outcome, RayError, RayRequest, Tracer};
use num_complex::Complex64;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Fewest and most rays that one thread takes at a time.
const BATCH: [usize; 2] = [64, 4096];

/// Batches a thread, so that all end at about the same time.
const BATCHES: usize = 16;

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
    /// Its electric field; |E|² = power.
    pub electric_field: Vec<[Complex64; 3]>,
    /// For each ray: the share of its power absorbed, by media or on opaque bodies.
    pub absorbed: Vec<f64>,
    /// For each ray: the share of its power in branches too weak to follow.
    pub pruned: Vec<f64>,
}

/// Bytes that a ray with one leaf takes while the table is put together: twice its row.
const BYTES_PER_RAY: u64 = 2 * (4 + 24 + 24 + 8 + 8 + 48 + 16);

impl LeafTable {
    /// Traces the rays `ray(0)` to `ray(count - 1)`; `done` is told now and then, from any thread, how many more
    /// have been traced.
    ///
    /// # Errors
    ///
    /// If a ray makes no sense or starts inside a device (the first such one is named), there is not enough memory
    /// for the leaves, or the work was stopped.
    pub fn trace(
        bench: &Bench,
        limits: Limits,
        count: usize,
        ray: &(impl Fn(usize) -> RayRequest + Sync),
        done: &(dyn Fn(u64) + Sync),
        stop: &AtomicBool,
    ) -> Result<Self, RayError> {
        let needed = count as u64 * BYTES_PER_RAY;
        // Rays are numbered in 32 bits.
        let available = crate::memory::available().unwrap_or(u64::from(u32::MAX) * BYTES_PER_RAY);
        if needed > available || u32::try_from(count).is_err() {
            let [needed_mb, available_mb] = [needed, available].map(|bytes| bytes / 1_000_000);
            return Err(RayError::TooMany { count, needed_mb, available_mb });
        }
        let size = count / (BATCHES * crate::threads::count());
        let size = size.clamp(BATCH[0], BATCH[1]);
        let batches: Vec<Result<Self, RayError>> = (0..count.div_ceil(size))
            .into_par_iter()
            .map_init(
                || FourTracers::new(&Tracer::<1>::new(bench, limits)),
                |tracers, batch| {
                    if stop.load(Ordering::Relaxed) {
                        return Err(RayError::Stopped);
                    }
                    let rays = batch * size..count.min((batch + 1) * size);
                    let traced = (rays.len()) as u64;
                    let table = Self::of_batch(bench, tracers, rays, ray)?;
                    done(traced);
                    Ok(table)
                },
            )
            .collect();
        let mut all = Self::default();
        // In order, so that the first bad ray is the one that is named.
        for batch in batches {
            all.append(batch?);
        }
        Ok(all)
    }

    fn of_batch(
        bench: &Bench,
        tracers: &mut FourTracers<'_, 1>,
        rays: std::ops::Range<usize>,
        ray: &impl Fn(usize) -> RayRequest,
    ) -> Result<Self, RayError> {
        let mut table = Self::default();
        let launches = rays
            .clone()
            .map(|index| launch(bench, index, &ray(index)))
            .collect::<Result<Vec<Launch<1>>, _>>()?;
        let mut all_leaves: Vec<Leaf<1>> = Vec::new();
        let mut ended = Vec::with_capacity(launches.len());
        for four in side_by_side(&launches).chunks(4) {
            tracers.trace(&std::array::from_fn(|i| launches[four[i.min(four.len() - 1)]]));
            for (ray, tracer) in four.iter().zip(tracers.each()) {
                let (leaves, outcome) = tracer.traced();
                let first = all_leaves.len();
                all_leaves.extend_from_slice(leaves);
                ended.push((*ray, first..all_leaves.len(), *outcome));
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
    fn push(
        &mut self,
        ray: usize,
        leaves: &[Leaf<1>],
        outcome: &Outcome<1>,
        sorted: &mut Vec<Leaf<1>>,
    ) {
        sorted.clear();
        sorted.extend(leaves.iter().filter(|leaf| leaf.body.is_none()));
        sorted.sort_by(|a, b| b.power[0].total_cmp(&a.power[0]));
        for leaf in sorted.iter() {
            // The number of rays fits into 32 bits.
            self.ray.push(ray as u32);
            let position = if leaf.met_device { leaf.position.to_array() } else { [f64::NAN; 3] };
            self.position.push(position);
            self.direction.push(leaf.direction.to_array());
            self.power.push(leaf.power[0]);
            self.optical_path.push(if leaf.met_device { leaf.optical_path } else { 0.0 });
            self.electric_field.push(leaf.electric[0].components());
        }
        // What ends on opaque bodies is absorbed there.
        let ended: f64 = leaves.iter().filter(|l| l.body.is_some()).map(|l| l.power[0]).sum();
        self.absorbed.push(outcome.absorbed[0] + ended);
        self.pruned.push(outcome.pruned[0]);
    }

    fn append(&mut self, mut other: Self) {
        self.ray.append(&mut other.ray);
        self.position.append(&mut other.position);
        self.direction.append(&mut other.direction);
        self.power.append(&mut other.power);
        self.optical_path.append(&mut other.optical_path);
        self.electric_field.append(&mut other.electric_field);
        self.absorbed.append(&mut other.absorbed);
        self.pruned.append(&mut other.pruned);
    }
}

/// The ray to launch, if it makes sense and starts in air.
fn launch(bench: &Bench, index: usize, ray: &RayRequest) -> Result<Launch<1>, RayError> {
    let launch = ray.launch().map_err(|problem| RayError::Ray { index, problem })?;
    match bench.holder(launch.origin) {
        None => Ok(launch),
        Some(device) => {
            let problem =
                format!("it starts inside device {device} (counted from 0); rays start in air");
            Err(RayError::Ray { index, problem })
        }
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a test may panic")]

    use super::*;
    use crate::trace::Polarization;
    use crate::{render, scene_file};
    use std::path::Path;

    #[test]
    fn rays_are_those_that_are_traced_alone() {
        // Deep trees and flat ones, rays that miss, two devices with cells of their own.
        let text = "[[device]]\nkind = \"double-gaussian-cloak\"\n\
                    [[device]]\nkind = \"gaussian-carpet\"\nposition = [0, -60, 0]\n\
                    [[device]]\nkind = \"square-cloak\"\nmaterial = \"negative-uniaxial\"\nposition = [0, 60, 0]\n";
        let scene = scene_file::parse(text, "a test", Path::new(""), &[]).unwrap().scene;
        let bench = render::bench(&scene).unwrap();
        let limits = Limits { min_power: 1e-6, tolerance: 1e-5 };
        let count = 2 * BATCH[0] + 37;
        let ray = |index: usize| RayRequest {
            origin: [-100.0, 0.0, 0.0],
            direction: [100.0, (index * 17 % 181) as f64 - 90.0, (index * 5 % 31) as f64 - 15.0],
            polarization: Polarization::Horizontal,
        };
        let stop = AtomicBool::new(false);
        let together = LeafTable::trace(&bench, limits, count, &ray, &|_| {}, &stop).unwrap();
        let mut alone = LeafTable::default();
        let mut tracer = Tracer::<1>::new(&bench, limits);
        for index in 0..count {
            let (leaves, outcome) = tracer.trace(&ray(index).launch().unwrap());
            alone.push(index, leaves, outcome, &mut Vec::new());
        }
        // NaN stands for what met nothing.
        assert_eq!(format!("{together:?}"), format!("{alone:?}"));
        assert!(together.position.iter().any(|position| position[0].is_nan()));
        assert!(together.ray.len() > 2 * count);
    }
}
