//! Leaves and branches as functions of the place in a patch.

use super::grid::{Coefficients, Grid, LANES, MOST_NODES, Terms};
use super::ways::Choice;
use crate::render::detection::Detection;
use crate::render::prepared_scene::PreparedScene;
use crate::trace::{Branch, Leaf};
use arrayvec::ArrayVec;
use glam::DVec3;
use optics::wave::ComplexVector;

/// The largest error of a power, in terms of the least power.
const POWER_TOLERANCE: f64 = 0.01;

/// The largest error of the place on the photograph, and of the optical path, in terms of the
/// tolerance of paths, times the share of power that goes there.
const PLACE_TOLERANCE: f64 = 0.3;

/// The same whatever goes there.
const WEAK_PLACE_TOLERANCE: f64 = 100.0;

/// The largest error of the direction and wave vector of a branch, in terms of that of a leaf's direction:
/// interfaces of media that are anisotropic by far make more of it.
const BRANCH: f64 = 0.03;

/// The share of each of them that terms which are left out may have.
const LEFT_OUT: f64 = 0.2;

/// Where the square of a length differs from 1 by less, its third power does not count.
const NEARLY: f64 = 1e-6;

/// How far leaves are looked at that end nowhere, and branches, cm.
const REACH: f64 = 100.0;

/// So many hold all functions: position, direction, two powers, wave vector, two paths and two
/// fields.
const MOST_LANES: usize = 4;

/// What is interpolated of a leaf or branch, all its functions in order.
type Lanes = [[f64; LANES]; MOST_LANES];

/// A leaf or branch as a function of the place in a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Smooth<T> {
    /// That at the first node.
    pub first: T,
    /// The number of the patch over which it was found to be smooth, from the largest on.
    pub level: usize,
    /// Where its coefficients begin.
    start: usize,
    /// How many terms it has.
    terms: usize,
    /// The last branch on the way to it that is met where rays are traced.
    pub met: Option<u64>,
    /// Where that is among those that are left out.
    pub place: usize,
    /// The last branch on the way to it at whose end rays choose between faces, and the face that
    /// leads on.
    pub given: Option<(u64, u16)>,
    /// The number of that branch.
    pub chooser: usize,
    /// The faces between which rays choose at its own end.
    pub choice: Choice,
}

impl<T: Interpolated> Smooth<T> {
    /// Whether a ray comes there that has chosen these faces.
    #[inline(always)]
    pub fn is_reached(&self, chosen: &[Option<u16>]) -> bool {
        self.given.is_none_or(|(_, face)| chosen.get(self.chooser) == Some(&Some(face)))
    }

    /// Moves that at the first node to a place of the patch.
    #[inline(always)]
    pub fn move_to(
        &self,
        thing: &mut T,
        at: &Terms,
        kept: Functions<'_>,
        coefficients: &[[f64; LANES]],
    ) {
        let lane = |lane: usize| {
            let start = self.start + lane * self.terms;
            at.sum(&coefficients[start..start + self.terms])
        };
        let count = T::lanes(kept);
        let mut lanes = [lane(0), [0.0; LANES], [0.0; LANES], [0.0; LANES]];
        for (number, values) in lanes[..count].iter_mut().enumerate().skip(1) {
            *values = lane(number);
        }
        thing.put(kept, &lanes);
    }
}

impl<const N: usize> Smooth<Branch<N>> {
    /// As [`Self::move_to`], but for its place and direction alone.
    #[inline(always)]
    pub fn point_from(&self, branch: &mut Branch<N>, at: &Terms, coefficients: &[[f64; LANES]]) {
        let numbers = at.sum(&coefficients[self.start..self.start + self.terms]);
        [branch.position, branch.direction] = place_of(&numbers);
    }
}

/// What is interpolated, and how exactly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Functions<'a> {
    prepared: &'a PreparedScene<'a>,
    /// Whether paths of leaves are asked for, those of pulses, and fields.
    paths: bool,
    group_paths: bool,
    /// The largest error of those of pulses, cm, if that is more than for other paths.
    pulse_tolerance: f64,
    fields: bool,
}

impl<'a> Functions<'a> {
    pub fn of<const N: usize>(prepared: &'a PreparedScene<'a>, detection: &Detection<N>) -> Self {
        Self {
            prepared,
            paths: detection.times || detection.arrivals.is_some(),
            group_paths: detection.wants_group_paths(),
            pulse_tolerance: detection.pulse_tolerance,
            fields: detection.stokes,
        }
    }

    /// How many paths of a leaf are kept.
    fn paths(&self) -> usize {
        if self.paths { 2 + usize::from(self.group_paths) } else { 0 }
    }

    /// The largest error of places and paths of what has that power, cm.
    pub fn place_tolerance(&self, power: f64) -> f64 {
        (PLACE_TOLERANCE / power).min(WEAK_PLACE_TOLERANCE) * self.prepared.limits.tolerance
    }

    fn power_tolerance(&self) -> f64 {
        POWER_TOLERANCE * self.prepared.limits.min_power
    }
}

/// What is a function of the place in a patch.
pub(super) trait Interpolated: Copy {
    /// How many numbers it has, in [`LANES`].
    fn lanes(kept: Functions<'_>) -> usize;

    /// Its numbers: position, direction and powers, and then others.
    fn values(&self, kept: Functions<'_>) -> Lanes;

    /// How far each may be off, for something of that power.
    fn tolerances(&self, kept: Functions<'_>, power: f64) -> Lanes;

    /// Takes over its numbers.
    fn put(&mut self, kept: Functions<'_>, lanes: &Lanes);

    /// Whether it is as another, which has been traced.
    fn agrees(&self, other: &Self, kept: Functions<'_>) -> bool;

    /// Whether both are the same but for their numbers.
    fn is_like(&self, other: &Self) -> bool;

    fn largest_power(&self) -> f64;
}

/// Position and direction with the powers, from which these and what follows are read again: so that four
/// numbers that lie side by side hold either.
fn first_numbers<const N: usize>(
    [position, direction]: [[f64; 3]; 2],
    power: [f64; N],
) -> impl Iterator<Item = f64> {
    let mut power = power.into_iter();
    position.into_iter().chain(power.next()).chain(direction).chain(power)
}

/// Position and direction.
#[inline(always)]
fn place_of(numbers: &[f64]) -> [DVec3; 2] {
    [DVec3::from_slice(&numbers[..3]), unit(DVec3::from_slice(&numbers[4..7]))]
}

/// The unit vector along one of nearly that length.
#[inline(always)]
fn unit(nearly: DVec3) -> DVec3 {
    let missing = 1.0 - nearly.length_squared();
    if missing.abs() < NEARLY {
        // The root's series, to the last bit: nothing has to wait for the root itself.
        nearly * (1.0 + missing * (0.5 + 0.375 * missing))
    } else {
        nearly.normalize()
    }
}

/// The powers, and the numbers after them.
#[inline(always)]
fn powers_and_rest<const N: usize>(numbers: &[f64]) -> ([f64; N], &[f64]) {
    (std::array::from_fn(|i| numbers[if i == 0 { 3 } else { 6 + i }]), &numbers[6 + N..])
}

/// Puts numbers in order.
fn in_order(numbers: impl IntoIterator<Item = f64>) -> Lanes {
    let mut lanes = [[0.0; LANES]; MOST_LANES];
    for (place, number) in lanes.as_flattened_mut().iter_mut().zip(numbers) {
        *place = number;
    }
    lanes
}

fn numbers_of<const N: usize>(fields: &[ComplexVector; N]) -> impl Iterator<Item = f64> {
    fields.iter().flat_map(|field| [field.re.to_array(), field.im.to_array()]).flatten()
}

fn put_fields<const N: usize>(fields: &mut [ComplexVector; N], numbers: &[f64]) {
    for (field, numbers) in fields.iter_mut().zip(numbers.chunks_exact(6)) {
        let [re, im] = [&numbers[..3], &numbers[3..]].map(DVec3::from_slice);
        *field = ComplexVector::new(re, im);
    }
}

fn are_near<const N: usize>(
    one: &[ComplexVector; N],
    other: &[ComplexVector; N],
    tolerance: f64,
) -> bool {
    let mut pairs = one.iter().zip(other);
    pairs.all(|(one, other)| (*one - *other).norm_squared() <= tolerance * tolerance)
}

fn all_near(one: &[f64], other: &[f64], tolerance: f64) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() <= tolerance)
}

/// The optical path of a leaf, and what light and a pulse take.
fn paths_of<const N: usize>(leaf: &Leaf<N>) -> [f64; 3] {
    [leaf.optical_path, leaf.delay_path, leaf.group_path.unwrap_or(f64::NAN)]
}

impl<const N: usize> Interpolated for Leaf<N> {
    fn lanes(kept: Functions<'_>) -> usize {
        let count = 6 + N + kept.paths() + if kept.fields { 6 * N } else { 0 };
        count.div_ceil(LANES)
    }

    fn values(&self, kept: Functions<'_>) -> Lanes {
        let place = [self.position, self.direction].map(|vector| vector.to_array());
        let paths = paths_of(self).into_iter();
        let fields = numbers_of(&self.electric).take(if kept.fields { 6 * N } else { 0 });
        let paths = paths.take(kept.paths());
        in_order(first_numbers(place, self.power).chain(paths).chain(fields))
    }

    fn tolerances(&self, kept: Functions<'_>, power: f64) -> Lanes {
        let [place, power] = [kept.place_tolerance(power), kept.power_tolerance()];
        let reach = self.distance_to(&kept.prepared.screen).unwrap_or(REACH);
        let first = first_numbers([[place; 3], [place / reach; 3]], [power; N]);
        let paths = [place, place, place.max(kept.pulse_tolerance)].into_iter().take(kept.paths());
        in_order(first.chain(paths).chain(std::iter::repeat(power)))
    }

    #[inline(always)]
    fn put(&mut self, kept: Functions<'_>, lanes: &Lanes) {
        let numbers = lanes.as_flattened();
        [self.position, self.direction] = place_of(numbers);
        let mut rest;
        (self.power, rest) = powers_and_rest(numbers);
        if kept.paths {
            [self.optical_path, self.delay_path] = [rest[0], rest[1]];
            if kept.group_paths {
                self.group_path = Some(rest[2]);
            }
            rest = &rest[kept.paths()..];
        }
        if kept.fields {
            put_fields(&mut self.electric, rest);
        }
    }

    fn agrees(&self, other: &Self, kept: Functions<'_>) -> bool {
        let tolerance = kept.place_tolerance(other.largest_power());
        let power_tolerance = kept.power_tolerance();
        let distance = other.distance_to(&kept.prepared.screen).unwrap_or(REACH);
        let place = |leaf: &Self| leaf.position + leaf.direction * distance;
        let (paths, own, others) = (kept.paths(), paths_of(self), paths_of(other));
        self.is_like(other)
            && place(self).distance(place(other)) <= tolerance
            && all_near(&self.power, &other.power, power_tolerance)
            && all_near(&own[..paths.min(2)], &others[..paths.min(2)], tolerance)
            && (paths < 3 || (own[2] - others[2]).abs() <= tolerance.max(kept.pulse_tolerance))
            && (!kept.fields || are_near(&self.electric, &other.electric, power_tolerance))
    }

    fn is_like(&self, other: &Self) -> bool {
        (self.end, self.met_device) == (other.end, other.met_device)
    }

    fn largest_power(&self) -> f64 {
        self.largest_power()
    }
}

impl<const N: usize> Interpolated for Branch<N> {
    fn lanes(kept: Functions<'_>) -> usize {
        (6 + N + 5 + 6 * N + usize::from(kept.group_paths)).div_ceil(LANES)
    }

    fn values(&self, kept: Functions<'_>) -> Lanes {
        let place = [self.position, self.direction].map(|vector| vector.to_array());
        let rest =
            self.wave_vector.to_array().into_iter().chain([self.optical_path, self.backwards]);
        let dispersion = kept.group_paths.then_some(self.dispersion);
        let rest = rest.chain(dispersion);
        in_order(first_numbers(place, self.power).chain(rest).chain(numbers_of(&self.electric)))
    }

    fn tolerances(&self, kept: Functions<'_>, power: f64) -> Lanes {
        let [place, power] = [kept.place_tolerance(power), kept.power_tolerance()];
        let direction = BRANCH * place / REACH;
        let first = first_numbers([[place; 3], [direction; 3]], [power; N]);
        let rest = [direction, direction, direction, place, place].into_iter();
        let pulse = place.max(kept.pulse_tolerance);
        let rest = rest.chain(kept.group_paths.then_some(pulse));
        in_order(first.chain(rest).chain(std::iter::repeat(power)))
    }

    #[inline(always)]
    fn put(&mut self, kept: Functions<'_>, lanes: &Lanes) {
        let numbers = lanes.as_flattened();
        [self.position, self.direction] = place_of(numbers);
        let rest;
        (self.power, rest) = powers_and_rest(numbers);
        self.wave_vector = DVec3::from_slice(&rest[..3]);
        [self.optical_path, self.backwards] = [rest[3], rest[4]];
        let mut rest = &rest[5..];
        if kept.group_paths {
            self.dispersion = rest[0];
            rest = &rest[1..];
        }
        put_fields(&mut self.electric, rest);
    }

    fn agrees(&self, other: &Self, kept: Functions<'_>) -> bool {
        let tolerance = kept.place_tolerance(other.largest_power());
        let power_tolerance = kept.power_tolerance();
        let paths = |branch: &Self| [branch.optical_path, branch.backwards];
        let late = self.dispersion - other.dispersion;
        self.is_like(other)
            && self.position.distance(other.position) <= tolerance
            && self.direction.distance(other.direction) * REACH <= BRANCH * tolerance
            && self.wave_vector.distance(other.wave_vector) * REACH <= BRANCH * tolerance
            && all_near(&self.power, &other.power, power_tolerance)
            && all_near(&paths(self), &paths(other), tolerance)
            && (!kept.group_paths || late.abs() <= tolerance.max(kept.pulse_tolerance))
            && are_near(&self.electric, &other.electric, power_tolerance)
    }

    fn is_like(&self, other: &Self) -> bool {
        self.is_like(other)
    }

    fn largest_power(&self) -> f64 {
        self.largest_power()
    }
}

/// Why something is no function over a patch.
pub(super) enum Rough {
    /// Some rays do not have it.
    Parted,
    /// It varies too fast.
    Steep {
        /// Along this axis faster than along the other.
        axis: usize,
        /// Whether by far.
        far: bool,
    },
}

/// Makes a function of what the rays of a patch have, which are given by their numbers: all at the
/// nodes, and those between that have at least the least power.
pub(super) fn smooth<T: Interpolated>(
    found: &[(usize, &T)],
    grid: &Grid,
    kept: Functions<'_>,
    level: usize,
    coefficients: &mut Vec<[f64; LANES]>,
) -> Result<Smooth<T>, Rough> {
    let nodes = grid.nodes();
    let at_nodes = found.get(..nodes).ok_or(Rough::Parted)?;
    let first = at_nodes[0].1;
    let is_there = |(node, one): (usize, &(usize, &T))| node == one.0 && one.1.is_like(first);
    if !at_nodes.iter().enumerate().all(is_there) {
        return Err(Rough::Parted);
    }
    let values: ArrayVec<Lanes, MOST_NODES> =
        at_nodes.iter().map(|(_, one)| one.values(kept)).collect();
    let lanes: ArrayVec<Coefficients, MOST_LANES> = (0..T::lanes(kept))
        .map(|lane| {
            let values: ArrayVec<[f64; LANES], MOST_NODES> =
                values.iter().map(|lanes| lanes[lane]).collect();
            grid.coefficients(&values)
        })
        .collect();
    let power = found.iter().map(|(_, one)| one.largest_power()).fold(0.0, f64::max);
    let terms = terms(&lanes, &first.tolerances(kept, power));
    let start = coefficients.len();
    coefficients.extend(lanes.iter().flat_map(|lane| &lane[..terms]));
    let smooth = Smooth {
        first: *first,
        level,
        start,
        terms,
        met: None,
        place: 0,
        given: None,
        chooser: 0,
        choice: Choice::default(),
    };
    let mut between = found[nodes..].iter().peekable();
    let is_smooth = (nodes..).zip(&grid.checks).all(|(number, at)| {
        let mut here = *first;
        smooth.move_to(&mut here, at, kept, coefficients);
        match between.next_if(|one| one.0 == number) {
            Some((_, one)) => here.agrees(one, kept),
            // It is too weak to be known there.
            None => here.largest_power() < kept.prepared.limits.min_power,
        }
    });
    if is_smooth && between.peek().is_none() {
        Ok(smooth)
    } else {
        coefficients.truncate(start);
        let (axis, far) = grid.rougher(&lanes);
        Err(Rough::Steep { axis, far })
    }
}

/// How many of the terms are needed.
fn terms(lanes: &[Coefficients], tolerances: &Lanes) -> usize {
    let mut needed = 1;
    for (lane, tolerances) in lanes.iter().zip(tolerances) {
        let mut left = tolerances.map(|most| LEFT_OUT * most);
        for (term, values) in lane.iter().enumerate().skip(needed).rev() {
            for (left, value) in left.iter_mut().zip(values) {
                *left -= value.abs();
            }
            if left.iter().any(|left| *left < 0.0) {
                needed = term + 1;
                break;
            }
        }
    }
    needed
}
