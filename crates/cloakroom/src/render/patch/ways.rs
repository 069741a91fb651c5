//! The ways that the rays of a patch take, and where they part.

use super::grid::bits;
use crate::trace::{Branch, PathRecorder, PathSegment};

/// A branch that goes on from a border, of one ray.
#[derive(Clone, Copy, Debug)]
struct Step {
    to: u64,
    from: u64,
    power: f64,
    ray: usize,
}

/// Notes where the branches of a ray go on, and those that may be followed from further on.
#[derive(Clone, Debug)]
pub(super) struct Trail<const N: usize> {
    steps: Vec<Step>,
    branches: Vec<Branch<N>>,
    /// What is not looked at.
    pub left_out: LeftOut,
}

impl<const N: usize> Default for Trail<N> {
    fn default() -> Self {
        Self { steps: Vec::new(), branches: Vec::new(), left_out: LeftOut::default() }
    }
}

impl<const N: usize> Trail<N> {
    pub fn clear(&mut self) {
        self.steps.clear();
        self.branches.clear();
    }
}

impl<const N: usize> PathRecorder<N> for Trail<N> {
    #[inline(always)]
    fn record(&mut self, _: impl FnOnce() -> PathSegment<N>) {}

    #[inline]
    fn begins(&mut self, branch: &Branch<N>) {
        if branch.is_movable() {
            self.branches.push(*branch);
        }
    }

    fn went_on(&mut self, from: u64, to: u64, power: f64) -> bool {
        self.steps.push(Step { to, from, power, ray: 0 });
        !self.left_out.has(to)
    }
}

/// A beginning of a way: a branch, from where it starts to the border where it ends.
#[derive(Clone, Copy, Debug)]
struct Beginning {
    path: u64,
    /// That of the branch before; for one with which the rays start, itself.
    from: u64,
    /// The rays that have it, as bits.
    rays: u64,
    /// Whether all rays of the patch have it.
    shared: bool,
    /// Whether rays part at its end.
    parts: bool,
}

/// The tree of all ways that the rays of a patch take.
#[derive(Debug)]
pub(super) struct Ways<const N: usize> {
    steps: Vec<Step>,
    beginnings: Vec<Beginning>,
    /// The branches that may be followed from further on, each of one ray.
    branches: Vec<(usize, Branch<N>)>,
    /// How many rays there are.
    rays: usize,
}

impl<const N: usize> Default for Ways<N> {
    fn default() -> Self {
        Self { steps: Vec::new(), beginnings: Vec::new(), branches: Vec::new(), rays: 0 }
    }
}

/// Of the launched ray.
pub(super) const ROOT: u64 = 0;

impl<const N: usize> Ways<N> {
    pub fn clear(&mut self) {
        self.steps.clear();
        self.beginnings.clear();
        self.branches.clear();
    }

    /// Takes in what a ray has noted.
    pub fn add(&mut self, ray: usize, trail: &mut Trail<N>) {
        self.steps.extend(trail.steps.drain(..).map(|step| Step { ray, ..step }));
        self.branches.extend(trail.branches.drain(..).map(|branch| (ray, branch)));
    }

    /// Puts the tree together, of so many rays, which have been followed from the starts on. Where
    /// it is not the same for all of them, rays part, but for branches below `least_power` in all.
    pub fn gather(&mut self, rays: usize, starts: impl Iterator<Item = u64>, least_power: f64) {
        self.rays = rays;
        let all = bits(0..rays);
        self.steps.sort_unstable_by_key(|step| step.to);
        for same in self.steps.chunk_by(|one, other| one.to == other.to) {
            let power = same.iter().map(|step| step.power).fold(0.0, f64::max);
            if power >= least_power {
                let Step { to: path, from, .. } = same[0];
                let rays = bits(same.iter().map(|step| step.ray));
                let shared = rays == all;
                self.beginnings.push(Beginning { path, from, rays, shared, parts: false });
            }
        }
        // Rays may come to what they also start with.
        let start = |path| Beginning { path, from: path, rays: all, shared: true, parts: false };
        let others: Vec<_> = starts.filter(|path| self.find(*path).is_none()).map(start).collect();
        self.beginnings.extend(others);
        self.beginnings.sort_unstable_by_key(|beginning| beginning.path);
        for number in 0..self.beginnings.len() {
            let Beginning { from, shared, .. } = self.beginnings[number];
            if !shared {
                self.part_at(from);
            }
        }
    }

    /// Notes that rays part at the end of a branch.
    pub fn part_at(&mut self, path: u64) {
        if let Some(number) = self.find(path) {
            self.beginnings[number].parts = true;
        }
    }

    /// Notes that a branch is not shared: it is to be followed from the end of the one before.
    pub fn part_before(&mut self, path: u64) {
        if let Some(number) = self.find(path) {
            let from = self.beginnings[number].from;
            self.beginnings[number].shared = false;
            self.part_at(from);
        }
    }

    /// Forgets a start that not all rays come to, with all that comes of it.
    pub fn forget(&mut self, start: u64) {
        let comes_of = |mut path: u64| {
            while path != start {
                match self.find(path).map(|number| self.beginnings[number].from) {
                    Some(from) if from != path => path = from,
                    _ => return false,
                }
            }
            true
        };
        let kept = self.beginnings.iter().filter(|beginning| !comes_of(beginning.path));
        self.beginnings = kept.copied().collect();
    }

    fn find(&self, path: u64) -> Option<usize> {
        self.beginnings.binary_search_by_key(&path, |beginning| beginning.path).ok()
    }

    /// Whether all rays of the patch have a branch.
    pub fn has(&self, path: u64) -> bool {
        self.find(path).is_some_and(|number| self.beginnings[number].shared)
    }

    /// Whether rays part at the end of a branch.
    pub fn parts(&self, path: u64) -> bool {
        self.find(path).is_some_and(|number| self.beginnings[number].parts)
    }

    /// The branches at whose ends rays part, that all rays have.
    pub fn parting(&self) -> impl Iterator<Item = u64> {
        let parting =
            self.beginnings.iter().filter(|beginning| beginning.shared && beginning.parts);
        parting.map(|beginning| beginning.path)
    }

    /// Those branches that may be followed from further on, of all rays, way by way: of each as
    /// many as there are.
    pub fn movable(&self, paths: &[u64]) -> Vec<(u64, usize, &Branch<N>)> {
        let is_wanted =
            |(_, branch): &&(usize, Branch<N>)| paths.binary_search(&branch.path).is_ok();
        let wanted = self.branches.iter().filter(is_wanted);
        let mut found: Vec<_> = wanted.map(|(ray, branch)| (branch.path, *ray, branch)).collect();
        // Of a branch that crosses seams, the first.
        found.sort_by_key(|(path, ray, _)| (*path, *ray));
        found.dedup_by_key(|(path, ray, _)| (*path, *ray));
        found
    }

    /// How many borders a ray meets in the mean.
    pub fn borders(&self) -> f64 {
        self.borders_of(|_| true)
    }

    /// The same where it is to be traced.
    pub fn borders_to_trace(&self) -> f64 {
        self.borders_of(|beginning| beginning.parts || !beginning.shared)
    }

    fn borders_of(&self, is_wanted: impl Fn(&Beginning) -> bool) -> f64 {
        let wanted = self.beginnings.iter().filter(|beginning| is_wanted(beginning));
        let met: u32 = wanted.map(|beginning| beginning.rays.count_ones()).sum();
        f64::from(met) / self.rays as f64
    }

    /// For each branch that some rays have and others have not, those that have it.
    pub fn some_have(&self) -> impl Iterator<Item = u64> {
        let some = self.beginnings.iter().map(|beginning| beginning.rays);
        some.filter(|rays| rays.count_ones() as usize != self.rays)
    }

    /// Whether a branch is met where rays are traced, and left out there.
    fn is_met(&self, beginning: &Beginning) -> bool {
        let is_traced = |before: &Beginning| before.parts || !before.shared;
        beginning.shared
            && beginning.from != beginning.path
            && self.find(beginning.from).is_some_and(|number| is_traced(&self.beginnings[number]))
    }

    /// The last branch on the way to another, or that itself, that is met where rays are traced;
    /// else the one with which they start.
    pub fn met_on_the_way(&self, mut path: u64) -> Result<u64, u64> {
        while let Some(number) = self.find(path) {
            let beginning = self.beginnings[number];
            if self.is_met(&beginning) {
                return Ok(path);
            }
            if beginning.from == path {
                break;
            }
            path = beginning.from;
        }
        Err(path)
    }

    /// All that are.
    pub fn met(&self) -> impl Iterator<Item = u64> {
        let met = self.beginnings.iter().filter(|beginning| self.is_met(beginning));
        met.map(|beginning| beginning.path)
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

    /// Whether a fingerprint is in the table.
    #[inline]
    pub fn has(&self, path: u64) -> bool {
        self.table[self.place(path)].0 != FREE
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
    fn went_on(&mut self, _: u64, to: u64, _: f64) -> bool {
        let place = self.place(to);
        let (found, met) = &mut self.table[place];
        let is_there = *found != FREE;
        *met |= is_there;
        !is_there
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn went_on(ways: &mut Ways<1>, ray: usize, steps: &[(u64, u64, f64)]) {
        let mut trail = Trail::default();
        for &(from, to, power) in steps {
            trail.went_on(from, to, power);
        }
        ways.add(ray, &mut trail);
    }

    /// Two rays that go 1, then 2 or 3, and 1, 4, 5 and 6; 12 and 13 are weak.
    fn two_rays() -> Ways<1> {
        let mut ways = Ways::default();
        let same = [(ROOT, 1, 1.0), (1, 4, 0.2), (4, 5, 0.1), (5, 6, 0.1)];
        for (ray, other) in [(0, 2), (1, 3)] {
            went_on(&mut ways, ray, &same);
            went_on(&mut ways, ray, &[(1, other, 0.5), (other, 10 + other, 1e-5)]);
        }
        ways.gather(2, [ROOT].into_iter(), 1e-4);
        ways
    }

    #[test]
    fn rays_part_at_the_end_of_the_branch_before() {
        let mut ways = two_rays();
        assert_eq!(ways.some_have().collect::<Vec<_>>(), [1 << 0, 1 << 1]);
        assert_eq!(ways.parting().collect::<Vec<_>>(), [1]);
        assert!([ROOT, 1, 4, 5, 6].iter().all(|path| ways.has(*path)));
        assert!([2, 3, 12, 13].iter().all(|path| !ways.has(*path)));
        // Traced from 1 on, rays meet 4, and 2 or 3, which are traced, too.
        assert_eq!(ways.met().collect::<Vec<_>>(), [4]);
        assert_eq!([1, 4, 6].map(|path| ways.met_on_the_way(path)), [Err(ROOT), Ok(4), Ok(4)]);
        assert_eq!((ways.borders(), ways.borders_to_trace()), (6.0, 2.0));
        // If 5 is to be traced from 4 on, so is all but the root and 6.
        ways.part_before(5);
        assert_eq!(ways.parting().collect::<Vec<_>>(), [1, 4]);
        assert_eq!(ways.met().collect::<Vec<_>>(), [4, 6]);
        assert_eq!(ways.borders_to_trace(), 4.0);
    }

    #[test]
    fn what_comes_of_a_start_is_forgotten_with_it() {
        let mut ways = Ways::<1>::default();
        went_on(&mut ways, 0, &[(7, 8, 0.1), (8, 9, 0.1), (ROOT, 1, 1.0)]);
        ways.gather(1, [ROOT, 7].into_iter(), 1e-4);
        assert_eq!(ways.met_on_the_way(9), Err(7));
        ways.forget(7);
        assert!([7, 8, 9].iter().all(|path| !ways.has(*path)) && ways.has(1) && ways.has(ROOT));
    }

    #[test]
    fn what_is_left_out_is_that_alone() {
        let paths = [1, 5, 1 << 32, 1 << 33, u64::MAX];
        let mut left_out = LeftOut::new(paths.into_iter());
        let leaves_out =
            |left_out: &mut LeftOut, path| !PathRecorder::<1>::went_on(left_out, 0, path, 1.0);
        assert!(paths[1..].iter().all(|path| leaves_out(&mut left_out, *path)));
        assert!((2..5).chain([0, 6, 1 << 34]).all(|path| !leaves_out(&mut left_out, path)));
        let met = paths.map(|path| left_out.has_met(left_out.place(path)));
        assert_eq!(met, [false, true, true, true, true]);
        left_out.begin();
        assert!(paths.iter().all(|path| !left_out.has_met(left_out.place(*path))));
        assert!(!leaves_out(&mut LeftOut::default(), 1));
    }
}
