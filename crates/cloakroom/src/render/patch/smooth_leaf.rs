//! Leaves as functions of the place in a patch.

use super::grid::{Coefficients, LANES, Terms};
use crate::render::detection::Detection;
use crate::render::prepared_scene::PreparedScene;
use crate::trace::Leaf;
use glam::DVec3;
use optics::wave::ComplexVector;

/// The largest error of a power, in terms of the least power.
const POWER_TOLERANCE: f64 = 0.01;

/// The largest error of the place on the photograph, and of the optical path, in terms of the
/// tolerance of paths, times the share of power that goes there.
const PLACE_TOLERANCE: f64 = 0.3;

/// The same whatever goes there.
const WEAK_PLACE_TOLERANCE: f64 = 100.0;

/// The share of each of them that terms which are left out may have.
const LEFT_OUT: f64 = 0.1;

/// How far leaves are looked at that end nowhere, cm.
const REACH: f64 = 100.0;

/// So many hold all functions: position, direction, two powers, two paths and two fields.
pub(super) const MOST_LANES: usize = 4;

/// The leaf of one way over a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct SmoothLeaf<const N: usize> {
    /// That at the first node.
    pub first: Leaf<N>,
    /// The number of the patch over which it was found to be smooth, from the largest on.
    pub level: usize,
    /// Where its coefficients begin.
    pub start: usize,
    /// How many terms it has.
    pub terms: usize,
    /// The longest beginning of its way that rays share, from which on it is left out, and where
    /// that is among those.
    pub beginning: u64,
    pub place: usize,
}

/// What is interpolated of leaves, and how exactly: position, direction, powers, and where they are
/// asked for paths and fields.
#[derive(Clone, Copy, Debug)]
pub(super) struct Functions<'a, const N: usize> {
    prepared: &'a PreparedScene<'a>,
    paths: bool,
    fields: bool,
    /// How many there are, in [`LANES`].
    pub lanes: usize,
}

impl<'a, const N: usize> Functions<'a, N> {
    pub fn of(prepared: &'a PreparedScene<'a>, detection: &Detection<N>) -> Self {
        let (paths, fields) = (detection.times, detection.stokes);
        let count = 6 + N + if paths { 2 } else { 0 } + if fields { 6 * N } else { 0 };
        Self { prepared, paths, fields, lanes: count.div_ceil(LANES) }
    }

    /// Their values for a leaf.
    pub fn values(&self, leaf: &Leaf<N>, lane: usize) -> [f64; LANES] {
        let fields = leaf.electric.iter().flat_map(|field| {
            field.components().into_iter().flat_map(|component| [component.re, component.im])
        });
        let places = leaf.position.to_array().into_iter().chain(leaf.direction.to_array());
        let paths = [leaf.optical_path, leaf.delay_path];
        self.lane(lane, places.chain(leaf.power), paths, fields)
    }

    /// How far each may be off for a leaf.
    fn tolerances(&self, leaf: &Leaf<N>, power: f64, lane: usize) -> [f64; LANES] {
        let place = self.place_tolerance(power);
        let direction = place / self.reach(leaf);
        let places = [place, place, place, direction, direction, direction].into_iter();
        let power = self.power_tolerance();
        self.lane(lane, places.chain([power; N]), [place; 2], std::iter::repeat(power))
    }

    /// Puts in order what there is to say of each function.
    fn lane(
        &self,
        lane: usize,
        places_and_powers: impl Iterator<Item = f64>,
        paths: [f64; 2],
        fields: impl Iterator<Item = f64>,
    ) -> [f64; LANES] {
        let mut all = places_and_powers
            .chain(paths.into_iter().take(if self.paths { 2 } else { 0 }))
            .chain(fields.take(if self.fields { 6 * N } else { 0 }))
            .skip(lane * LANES);
        std::array::from_fn(|_| all.next().unwrap_or(0.0))
    }

    /// How many of the terms are needed, given the coefficients, lane by lane, of a leaf of at most
    /// that power.
    pub fn terms(&self, leaf: &Leaf<N>, power: f64, coefficients: &[Coefficients]) -> usize {
        let mut needed = 1;
        for (lane, coefficients) in coefficients.iter().enumerate() {
            let mut left = self.tolerances(leaf, power, lane).map(|most| LEFT_OUT * most);
            for (term, values) in coefficients.iter().enumerate().skip(needed).rev() {
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

    /// How far a leaf goes on to where it is looked at.
    fn reach(&self, leaf: &Leaf<N>) -> f64 {
        leaf.distance_to(&self.prepared.screen).unwrap_or(REACH)
    }

    /// The largest error of places and paths of a leaf of that power, cm.
    fn place_tolerance(&self, power: f64) -> f64 {
        (PLACE_TOLERANCE / power).min(WEAK_PLACE_TOLERANCE) * self.prepared.limits.tolerance
    }

    fn power_tolerance(&self) -> f64 {
        POWER_TOLERANCE * self.prepared.limits.min_power
    }

    /// Whether an interpolated leaf is as a traced one.
    pub fn agree(&self, one: &Leaf<N>, other: &Leaf<N>) -> bool {
        let tolerance = self.place_tolerance(other.largest_power());
        let power_tolerance = self.power_tolerance();
        let distance = self.reach(other);
        let place = |leaf: &Leaf<N>| leaf.position + leaf.direction * distance;
        let is_near = |one: f64, other: f64, tolerance: f64| (one - other).abs() <= tolerance;
        let same_paths = !self.paths
            || is_near(one.optical_path, other.optical_path, tolerance)
                && is_near(one.delay_path, other.delay_path, tolerance);
        let same_fields = !self.fields
            || (one.electric.iter().zip(&other.electric))
                .all(|(one, other)| (*one - *other).norm_squared() <= power_tolerance.powi(2));
        let mut powers = one.power.iter().zip(&other.power);
        (one.end, one.met_device) == (other.end, other.met_device)
            && place(one).distance(place(other)) <= tolerance
            && powers.all(|(one, other)| is_near(*one, *other, power_tolerance))
            && same_paths
            && same_fields
    }

    /// Moves a leaf to a point of the patch over which it is smooth.
    #[inline(always)]
    pub fn move_leaf(
        &self,
        leaf: &mut Leaf<N>,
        smooth: &SmoothLeaf<N>,
        at: &Terms,
        coefficients: &[[f64; LANES]],
    ) {
        let lane = |lane: usize| {
            let start = smooth.start + lane * smooth.terms;
            at.sum(&coefficients[start..start + smooth.terms])
        };
        let first = lane(0);
        leaf.position = DVec3::from_slice(&first[..3]);
        leaf.direction = DVec3::from_slice(&first[3..6]).normalize();
        if self.lanes == 1 {
            for (power, value) in leaf.power.iter_mut().zip(&first[6..]) {
                *power = *value;
            }
            return;
        }
        let mut all = [first; MOST_LANES];
        for (number, values) in all[..self.lanes].iter_mut().enumerate().skip(1) {
            *values = lane(number);
        }
        let mut rest = all.as_flattened()[6..].iter().copied();
        let mut next = || rest.next().unwrap_or(0.0);
        leaf.power = std::array::from_fn(|_| next());
        if self.paths {
            leaf.optical_path = next();
            leaf.delay_path = next();
        }
        if self.fields {
            for field in &mut leaf.electric {
                let [x, y, z] = std::array::from_fn(|_| [next(), next()]);
                let [re, im] = [0, 1].map(|part| DVec3::new(x[part], y[part], z[part]));
                *field = ComplexVector::new(re, im);
            }
        }
    }
}
