//! The ways that the rays of a patch take, and which of them all rays of it have.

use super::grid::bits;
use crate::trace::{PathRecorder, PathSegment};

/// A branch that goes on from a border, of one ray.
#[derive(Clone, Copy, Debug)]
struct Step {
    to: u64,
    from: u64,
    power: f64,
    ray: usize,
}

/// Notes where the branches of a ray go on.
#[derive(Clone, Debug, Default)]
pub(super) struct Trail {
    steps: Vec<Step>,
    /// What is not looked at.
    pub left_out: LeftOut,
}

impl Trail {
    pub fn clear(&mut self) {
        self.steps.clear();
    }
}

impl<const N: usize> PathRecorder<N> for Trail {
    #[inline(always)]
    fn record(&mut self, _: impl FnOnce() -> PathSegment<N>) {}

    fn went_on(&mut self, from: u64, to: u64, power: f64) {
        self.steps.push(Step { to, from, power, ray: 0 });
    }

    #[inline]
    fn leaves_out(&mut self, path: u64) -> bool {
        PathRecorder::<N>::leaves_out(&mut self.left_out, path)
    }
}

/// A beginning of a way, over a patch.
#[derive(Clone, Copy, Debug)]
struct Beginning {
    path: u64,
    /// The way up to the border before.
    from: u64,
    /// The rays that have it, as bits.
    rays: u64,
    /// Whether rays of the patch part here, or further on.
    parts: bool,
}

/// The tree of all ways that the rays of a patch take.
#[derive(Debug, Default)]
pub(super) struct Ways {
    steps: Vec<Step>,
    beginnings: Vec<Beginning>,
    /// Whether rays part anywhere.
    part: bool,
    /// How many rays there are.
    rays: usize,
}

/// Of the launched ray.
const ROOT: u64 = 0;

impl Ways {
    pub fn clear(&mut self) {
        self.steps.clear();
        self.beginnings.clear();
        self.part = false;
    }

    /// Takes in what a ray has noted.
    pub fn add(&mut self, ray: usize, trail: &mut Trail) {
        self.steps.extend(trail.steps.drain(..).map(|step| Step { ray, ..step }));
    }

    /// Puts the tree together, of so many rays. Where it is not the same for all of them, rays part,
    /// but for branches below `least_power` in all.
    pub fn gather(&mut self, rays: usize, least_power: f64) {
        self.rays = rays;
        self.steps.sort_unstable_by_key(|step| step.to);
        for same in self.steps.chunk_by(|one, other| one.to == other.to) {
            let power = same.iter().map(|step| step.power).fold(0.0, f64::max);
            if power >= least_power {
                let Step { to: path, from, .. } = same[0];
                let rays = bits(same.iter().map(|step| step.ray));
                self.beginnings.push(Beginning { path, from, rays, parts: false });
            }
        }
        for number in 0..self.beginnings.len() {
            if self.beginnings[number].rays.count_ones() as usize != rays {
                self.part_at(self.beginnings[number].path);
            }
        }
    }

    /// Notes that rays part where a way ends that only some of them have.
    pub fn part_at(&mut self, mut path: u64) {
        self.part = true;
        while let Some(number) = self.find(path) {
            let beginning = &mut self.beginnings[number];
            if std::mem::replace(&mut beginning.parts, true) {
                return;
            }
            path = beginning.from;
        }
    }

    fn find(&self, path: u64) -> Option<usize> {
        self.beginnings.binary_search_by_key(&path, |beginning| beginning.path).ok()
    }

    /// Whether rays part on a way.
    pub fn parts(&self, path: u64) -> bool {
        self.find(path).is_none_or(|number| self.beginnings[number].parts)
    }

    /// How many borders a ray meets in the mean, where it starts among them.
    pub fn borders(&self) -> f64 {
        self.borders_of(|_| true)
    }

    /// The same on ways on which rays part.
    pub fn borders_to_trace(&self) -> f64 {
        if self.part { self.borders_of(|beginning| beginning.parts) } else { 0.0 }
    }

    fn borders_of(&self, is_wanted: impl Fn(&Beginning) -> bool) -> f64 {
        let wanted = self.beginnings.iter().filter(|beginning| is_wanted(beginning));
        let met: u32 = wanted.map(|beginning| beginning.rays.count_ones()).sum();
        1.0 + f64::from(met) / self.rays as f64
    }

    /// For each beginning of a way that some rays have and others have not, those that have it.
    pub fn some_have(&self) -> impl Iterator<Item = u64> {
        let some = self.beginnings.iter().map(|beginning| beginning.rays);
        some.filter(|rays| rays.count_ones() as usize != self.rays)
    }

    /// The first beginning of a way that does not part any more, after which the others do not
    /// either: the longest that may be left out.
    pub fn shared_beginning(&self, mut path: u64) -> u64 {
        while let Some(number) = self.find(path) {
            let from = self.beginnings[number].from;
            if from == ROOT || self.parts(from) {
                break;
            }
            path = from;
        }
        path
    }

    /// The first ones of the beginnings after which rays do not part any more.
    pub fn shared(&self) -> impl Iterator<Item = u64> {
        let parts_before = |beginning: &&Beginning| {
            !beginning.parts && (beginning.from == ROOT || self.parts(beginning.from))
        };
        self.beginnings.iter().filter(parts_before).map(|beginning| beginning.path)
    }
}

/// Leaves out the branches that all rays of a patch have.
#[derive(Clone, Debug)]
pub(super) struct LeftOut {
    /// Their fingerprints, each at the place that its bits say or after it, and whether the ray has
    /// met it; a power of two of places.
    table: Vec<(u64, bool)>,
}

/// A place in the table without fingerprint.
const FREE: u64 = 0;

impl Default for LeftOut {
    fn default() -> Self {
        Self::new(std::iter::empty())
    }
}

impl LeftOut {
    pub fn new(paths: impl Iterator<Item = u64>) -> Self {
        let paths: Vec<u64> = paths.filter(|path| *path != FREE).collect();
        let mut left_out =
            Self { table: vec![(FREE, false); (2 * paths.len() + 1).next_power_of_two()] };
        for path in paths {
            let place = left_out.place(path);
            left_out.table[place].0 = path;
        }
        left_out
    }

    /// Where a fingerprint is in the table, or would be.
    #[inline]
    pub fn place(&self, path: u64) -> usize {
        let last = self.table.len() - 1;
        let mut place = (path ^ path >> 32) as usize & last;
        while self.table[place].0 != FREE && self.table[place].0 != path {
            place = (place + 1) & last;
        }
        place
    }

    /// Whether the ray has met the branch at a place of the table.
    #[inline]
    pub fn has_met(&self, place: usize) -> bool {
        self.table[place].1
    }

    /// Begins with another ray.
    #[inline]
    pub fn begin(&mut self) {
        self.table.iter_mut().for_each(|(_, met)| *met = false);
    }
}

impl<const N: usize> PathRecorder<N> for LeftOut {
    #[inline(always)]
    fn record(&mut self, _: impl FnOnce() -> PathSegment<N>) {}

    #[inline]
    fn leaves_out(&mut self, path: u64) -> bool {
        let place = self.place(path);
        let (found, met) = &mut self.table[place];
        let is_there = *found != FREE;
        *met |= is_there;
        is_there
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn went_on(ways: &mut Ways, ray: usize, steps: &[(u64, u64, f64)]) {
        let mut trail = Trail::default();
        for &(from, to, power) in steps {
            PathRecorder::<1>::went_on(&mut trail, from, to, power);
        }
        ways.add(ray, &mut trail);
    }

    #[test]
    fn rays_part_on_the_way_to_where_they_do() {
        // Both go 1, then 2 or 3; and 1, 4 and 5; 9 is weak.
        let mut ways = Ways::default();
        let same = [(ROOT, 1, 1.0), (1, 4, 0.2), (4, 5, 0.1)];
        for (ray, other) in [(2, 2), (3, 3)] {
            went_on(&mut ways, ray, &same);
            went_on(&mut ways, ray, &[(1, other, 0.5), (other, 10 + other, 1e-5)]);
        }
        ways.gather(2, 1e-4);
        assert_eq!(ways.some_have().collect::<Vec<_>>(), [1 << 2, 1 << 3]);
        assert!(ways.parts(ROOT) && ways.parts(1) && ways.parts(2) && ways.parts(3));
        assert!(!ways.parts(4) && !ways.parts(5));
        assert_eq!(ways.shared().collect::<Vec<_>>(), [4]);
        assert_eq!([4, 5].map(|path| ways.shared_beginning(path)), [4, 4]);
        // The start and 1, and 2 or 3; and 4 and 5.
        assert_eq!((ways.borders(), ways.borders_to_trace()), (5.0, 3.0));
        ways.part_at(5);
        assert_eq!(ways.shared().count(), 0);
        assert_eq!(ways.borders_to_trace(), ways.borders());
    }

    #[test]
    fn what_is_left_out_is_that_alone() {
        let paths = [1, 5, 1 << 32, 1 << 33, u64::MAX];
        let mut left_out = LeftOut::new(paths.into_iter());
        let leaves_out =
            |left_out: &mut LeftOut, path| PathRecorder::<1>::leaves_out(left_out, path);
        assert!(paths[1..].iter().all(|path| leaves_out(&mut left_out, *path)));
        assert!((2..5).chain([0, 6, 1 << 34]).all(|path| !leaves_out(&mut left_out, path)));
        let met = paths.map(|path| left_out.has_met(left_out.place(path)));
        assert_eq!(met, [false, true, true, true, true]);
        left_out.begin();
        assert!(paths.iter().all(|path| !left_out.has_met(left_out.place(*path))));
        assert!(!leaves_out(&mut LeftOut::default(), 1));
    }
}
