//! What a renderer of its own asks of devices: for each of many rays the leaves, or one of them, drawn by
//! its power.

use super::draw::Drawn;
use super::leaf_table::batches;
use super::neighbours::side_by_side;
use super::{FourTracers, Launch, Leaf, LeafEnd, Limits, Outcome, Stopped, Tracer};
use crate::assembly::Assembly;
use glam::DVec3;
use optics::geometry::Pose;
use optics::wave::ComplexVector;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

/// A leaf runs on along its ray's own line whose direction differs by less from that of the ray, in
/// terms of the tolerance per cm: graded media are traced to a tenth of it.
const SAME_DIRECTION: f64 = 1.0;

/// And that is not farther from the line, in terms of the tolerance.
const SAME_LINE: f64 = 10.0;

/// Where devices stand in the world of a renderer, whose lengths have a unit of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The frame of the assembly in that world; its origin in cm.
    pub pose: Pose,
    /// How many cm that world's unit of length is.
    pub unit: f64,
}

impl Default for Placement {
    fn default() -> Self {
        Self { pose: Pose::IDENTITY, unit: 1.0 }
    }
}

impl Placement {
    fn to_local(self, launch: &Launch<2>) -> Launch<2> {
        Launch {
            origin: self.pose.to_local(launch.origin * self.unit),
            direction: self.pose.vector_to_local(launch.direction),
            electric: launch.electric.map(|field| self.pose.field_to_local(field)),
        }
    }

    fn to_world(self, scattered: Scattered) -> Scattered {
        Scattered {
            position: self.pose.to_world(scattered.position) / self.unit,
            direction: self.pose.vector_to_world(scattered.direction),
            optical_path: scattered.optical_path / self.unit,
            electric: scattered.electric.map(|field| self.pose.field_to_world(field)),
            ..scattered
        }
    }
}

/// What became of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RayStatus {
    /// It has met no device and goes on as it came.
    #[default]
    Missed = 0,
    /// This leaf has left the devices.
    Left = 1,
    /// This leaf ends on an opaque body.
    Ended = 2,
    /// Nothing of it leaves a device.
    Absorbed = 3,
    /// It is no ray: a number of it is not finite, its direction is zero, the number to draw by is not
    /// from 0 to 1, or it starts in metal or in an opaque body.
    Refused = 4,
}

/// One leaf of a ray, in the frame and unit of its [`Placement`]; or what else became of the ray, at its
/// own place and in its own direction then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scattered {
    /// The number of the ray.
    pub ray: u32,
    /// What became of it.
    pub status: RayStatus,
    /// Whether the leaf runs on along the ray's own line.
    pub straight: bool,
    /// The opaque body on which the leaf ends, by its number among the devices.
    pub body: u16,
    /// Where the leaf has left the devices.
    pub position: DVec3,
    /// Its direction, a unit vector.
    pub direction: DVec3,
    /// What the leaf is to be weighed with in unpolarized light. One that was drawn stands for all of them
    /// and for what was pruned, whose way is not known: what has not been absorbed on its way, so 1 in
    /// devices that absorb nothing. Else its share of the power.
    pub weight: f64,
    /// With which probability the leaf was drawn, what is pruned being among what may be: times `weight` it
    /// is its share of the power.
    pub probability: f64,
    /// How much of the power of the ray, unpolarized, goes on along its own line in all leaves. Of a ray
    /// whose leaf is drawn what that leaf says, all or nothing of its weight: the mean of many draws.
    pub transmitted: f64,
    /// The share of the power in branches too weak to follow, unpolarized. Of a ray whose leaf is drawn what
    /// the first way that is drawn says, all or nothing of what it carries: the mean of many draws.
    pub pruned: f64,
    /// Optical path length from the ray's origin to `position`.
    pub optical_path: f64,
    /// A fingerprint of the way of the leaf, [`Leaf::path`].
    pub path: u64,
    /// The electric fields of the leaf for the two launched; the mean of their |E|² is its share of the
    /// power.
    pub electric: [ComplexVector; 2],
}

/// A ray for [`scatter`]: two fields across it, which are both polarizations of unpolarized light, and the
/// number from 0 to 1 that one of its leaves is drawn by; without it there will be all leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScatterRay {
    /// The ray, in the frame and unit of the placement.
    pub launch: Launch<2>,
    /// What one of its leaves is drawn by.
    pub draw: Option<f64>,
}

/// Traces the rays `ray(0)` to `ray(count - 1)`, which may be 2^32 at most, and gives what became of
/// them, in order: of a ray whose leaf is drawn, one; of others one for each leaf. No ray is an error, but
/// each has a status. `done` is told now and then, from any thread, of how many further rays it is known.
/// With the feature `rayon`, on all threads; what comes out is the same.
///
/// # Errors
///
/// If the work was stopped.
pub fn scatter(
    assembly: &Assembly,
    limits: Limits,
    placement: &Placement,
    count: usize,
    ray: &(impl Fn(usize) -> ScatterRay + Sync),
    done: &(dyn Fn(u64) + Sync),
    stop: &AtomicBool,
) -> Result<Vec<Scattered>, Stopped> {
    let keep = |batch: &mut Vec<Scattered>, rows| *batch = rows;
    let empty = batches(count).into_iter().map(|rays| (rays, Vec::new())).collect();
    let mut batches =
        scatter_batches(assembly, limits, placement, empty, ray, &keep, done, stop)?.into_iter();
    let mut all = batches.next().unwrap_or_default();
    for mut batch in batches {
        all.append(&mut batch);
    }
    Ok(all)
}

/// The same for callers that keep less of each row, or keep it otherwise: the rays come in batches, as
/// [`batches`] parts them, each with what `keep` fills from its rows, on the thread that has traced them;
/// that is given, in order of the batches.
///
/// # Errors
///
/// If the work was stopped.
#[expect(clippy::too_many_arguments, reason = "those of `scatter` and one more")]
pub fn scatter_batches<K: Send>(
    assembly: &Assembly,
    limits: Limits,
    placement: &Placement,
    batches: Vec<(Range<usize>, K)>,
    ray: &(impl Fn(usize) -> ScatterRay + Sync),
    keep: &(impl Fn(&mut K, Vec<Scattered>) + Sync),
    done: &(dyn Fn(u64) + Sync),
    stop: &AtomicBool,
) -> Result<Vec<K>, Stopped> {
    let four = assembly.is_graded();
    crate::parallel::map_each(batches, |(rays, mut kept)| {
        if stop.load(Ordering::Relaxed) {
            return Err(Stopped);
        }
        let length = rays.len() as u64;
        let batch = Batch { assembly, limits, placement, rays: &rays };
        let scattered = if four { batch.by_fours(ray) } else { batch.one_by_one(ray) };
        done(length);
        keep(&mut kept, scattered);
        Ok(kept)
    })
    .into_iter()
    .collect()
}

struct Batch<'a> {
    assembly: &'a Assembly,
    limits: Limits,
    placement: &'a Placement,
    rays: &'a Range<usize>,
}

impl Batch<'_> {
    fn one_by_one(&self, ray: &impl Fn(usize) -> ScatterRay) -> Vec<Scattered> {
        let mut tracer = Tracer::<2>::new(self.assembly, self.limits);
        let mut scattered = Vec::with_capacity(self.rays.len());
        for number in self.rays.clone() {
            let ray = ray(number);
            let launch = self.placement.to_local(&ray.launch);
            if is_ray(&ray) {
                tracer.draw_by(ray.draw);
                tracer.trace(&launch);
                let ((leaves, outcome), drawn) = (tracer.traced(), tracer.drawn());
                self.add(number, (&ray, drawn), &launch, leaves, outcome, &mut scattered);
            } else {
                scattered.push(unchanged(number, &ray.launch, RayStatus::Refused));
            }
        }
        scattered
    }

    /// The same where regions take four rays at once.
    fn by_fours(&self, ray: &impl Fn(usize) -> ScatterRay) -> Vec<Scattered> {
        let mut tracers = FourTracers::new(&Tracer::<2>::new(self.assembly, self.limits));
        let mut scattered = Vec::with_capacity(self.rays.len());
        let rays: Vec<ScatterRay> = self.rays.clone().map(ray).collect();
        let mut numbers = Vec::with_capacity(rays.len());
        let mut launches = Vec::with_capacity(rays.len());
        for (number, ray) in rays.iter().enumerate() {
            if is_ray(ray) {
                numbers.push(number);
                launches.push(self.placement.to_local(&ray.launch));
            } else {
                let refused = RayStatus::Refused;
                scattered.push(unchanged(self.rays.start + number, &ray.launch, refused));
            }
        }
        for four in side_by_side(&launches).chunks(4) {
            let places: [usize; 4] = std::array::from_fn(|i| four[i.min(four.len() - 1)]);
            for (place, tracer) in places.iter().zip(&mut tracers.tracers) {
                tracer.draw_by(rays[numbers[*place]].draw);
            }
            tracers.trace(&places.map(|place| launches[place]));
            for (place, tracer) in four.iter().zip(&tracers.tracers) {
                let (leaves, outcome) = tracer.traced();
                let (ray, number) = (&rays[numbers[*place]], self.rays.start + numbers[*place]);
                let ray = (ray, tracer.drawn());
                self.add(number, ray, &launches[*place], leaves, outcome, &mut scattered);
            }
        }
        // Stable: the leaves of a ray stay as they are.
        scattered.sort_by_key(|scattered| scattered.ray);
        scattered
    }

    /// Adds what became of a ray, `launch` being the same in the frame of the assembly.
    fn add(
        &self,
        number: usize,
        (ray, drawn): (&ScatterRay, Option<Drawn>),
        launch: &Launch<2>,
        leaves: &[Leaf<2>],
        outcome: &Outcome<2>,
        scattered: &mut Vec<Scattered>,
    ) {
        if let [leaf] = leaves
            && !leaf.met_device
            && leaf.total_power() > 0.0
        {
            let missed = unchanged(number, &ray.launch, RayStatus::Missed);
            scattered.push(Scattered { straight: true, weight: 1.0, transmitted: 1.0, ..missed });
            return;
        }
        let mean = |of: &[f64; 2]| 0.5 * (of[0] + of[1]);
        let pruned = drawn.map_or(mean(&outcome.pruned), |drawn| drawn.pruned);
        if leaves.iter().all(|leaf| mean(&leaf.power) <= 0.0) {
            let refused = outcome.stats.lost > 0
                && self.assembly.region_around(launch.origin, launch.direction).is_err();
            let status = if refused { RayStatus::Refused } else { RayStatus::Absorbed };
            scattered.push(Scattered { pruned, ..unchanged(number, &ray.launch, status) });
            return;
        }
        let weight =
            |leaf: &Leaf<2>| mean(&leaf.power) / drawn.map_or(1.0, |drawn| drawn.probability);
        let straight = |leaf: &Leaf<2>| self.is_straight(launch, leaf);
        // From nothing that is positive: a sum of none is -0.
        let transmitted =
            leaves.iter().filter(|leaf| straight(leaf)).map(weight).sum::<f64>() + 0.0;
        let of_leaf = |leaf: &Leaf<2>| {
            let body = leaf.body();
            self.placement.to_world(Scattered {
                // Rays are numbered in 32 bits.
                ray: number as u32,
                status: body.map_or(RayStatus::Left, |_| RayStatus::Ended),
                straight: straight(leaf),
                body: body.unwrap_or_default(),
                position: leaf.position,
                direction: leaf.direction,
                weight: weight(leaf),
                probability: drawn.map_or(1.0, |drawn| drawn.probability),
                transmitted,
                pruned,
                optical_path: leaf.optical_path,
                path: leaf.path,
                electric: leaf.electric,
            })
        };
        if let [leaf] = leaves {
            scattered.push(of_leaf(leaf));
            return;
        }
        let mut order: Vec<&Leaf<2>> = leaves.iter().collect();
        order.sort_by(|a, b| b.total_power().total_cmp(&a.total_power()));
        scattered.extend(order.into_iter().map(of_leaf));
    }

    fn is_straight(&self, launch: &Launch<2>, leaf: &Leaf<2>) -> bool {
        let tolerance = self.limits.tolerance;
        let way = leaf.position - launch.origin;
        let aside = way - launch.direction * way.dot(launch.direction);
        leaf.end == LeafEnd::Away
            && (leaf.direction - launch.direction).length() <= SAME_DIRECTION * tolerance
            && aside.length() <= SAME_LINE * tolerance
    }
}

fn is_ray(ray: &ScatterRay) -> bool {
    let ScatterRay { launch, draw } = ray;
    launch.origin.is_finite()
        && (launch.direction.length_squared() - 1.0).abs() < 1e-9
        && launch.electric.iter().all(|field| field.re.is_finite() && field.im.is_finite())
        && draw.is_none_or(|draw| (0.0..=1.0).contains(&draw))
}

/// A ray of which nothing is drawn.
fn unchanged(number: usize, launch: &Launch<2>, status: RayStatus) -> Scattered {
    Scattered {
        // Rays are numbered in 32 bits.
        ray: number as u32,
        status,
        position: launch.origin,
        direction: launch.direction,
        probability: 1.0,
        electric: launch.electric,
        ..Scattered::default()
    }
}
