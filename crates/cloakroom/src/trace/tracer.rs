//! The walk along the ray tree.

use super::branch::{Branch, Place};
use super::{Bench, Leaf, Outcome, Screen, Witness};
use crate::device::{InnerRay, Passage};
use glam::DVec3;
use optics::interface::OutgoingWaves;
use optics::wave::ComplexVector;

/// A ray to launch in air, with `N` polarizations at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Launch<const N: usize> {
    /// Where it starts, cm.
    pub origin: DVec3,
    /// Its direction, a unit vector.
    pub direction: DVec3,
    /// The electric fields, across the direction and of unit norm.
    pub electric: [ComplexVector; N],
}

/// When a branch is followed no further, and how exactly graded media are traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Branches below this share of the launched power, in every polarization, are pruned.
    pub min_power: f64,
    /// Largest error of position and optical path on leaving a device, cm.
    pub tolerance: f64,
}

/// Few trees meet this many surfaces. Those that do, by light that is trapped or runs almost along the
/// device, are followed on with a threshold ten times as high, so that the strong branches are not
/// lost; what that cuts counts as pruned.
const MANY_EVENTS: u32 = 100_000;

/// After as many surfaces again the threshold is raised once more.
const MORE_EVENTS: u32 = 10_000;

/// What rounding leaves of a wave that is not there.
const NO_POWER: f64 = 1e-24;

/// The share of the power that rounding may take at an interface.
const LEAK: f64 = 1e-10;

/// Traces rays. It keeps its memory from ray to ray: make one a thread. `W` is who watches it, nobody as a rule.
#[derive(Clone, Debug)]
pub struct Tracer<'a, const N: usize, W = ()> {
    pub(super) bench: &'a Bench,
    pub(super) limits: Limits,
    pub(super) screen: Option<Screen>,
    pub(super) waiting: Vec<Branch<N>>,
    pub(super) leaves: Vec<Leaf<N>>,
    pub(super) outcome: Outcome<N>,
    /// Surfaces met, and the power below which branches have become endless.
    events: u32,
    threshold: f64,
    pub(super) witness: W,
}

impl<'a, const N: usize> Tracer<'a, N> {
    /// A tracer for the devices of `bench`.
    #[must_use]
    pub fn new(bench: &'a Bench, limits: Limits) -> Self {
        let outcome = Outcome::default();
        let (waiting, leaves) = (Vec::new(), Vec::new());
        let (screen, events, threshold, witness) = (None, 0, 0.0, ());
        Self { bench, limits, screen, waiting, leaves, outcome, events, threshold, witness }
    }

    /// The same tracer, watched.
    #[must_use]
    pub fn watched<W: Witness<N>>(self, witness: W) -> Tracer<'a, N, W> {
        let Self { bench, limits, screen, waiting, leaves, outcome, events, threshold, .. } = self;
        Tracer { bench, limits, screen, waiting, leaves, outcome, events, threshold, witness }
    }
}

impl<'a, const N: usize, W: Witness<N>> Tracer<'a, N, W> {
    /// Who has watched it.
    pub fn witness(&mut self) -> &mut W {
        &mut self.witness
    }

    /// Ends branches that meet a screen.
    #[must_use]
    pub fn with_screen(self, screen: Screen) -> Self {
        Self { screen: Some(screen), ..self }
    }

    /// Follows one ray to the end of every branch: the leaves, in the order the tree was walked,
    /// and the account of the rest of the power. The ray must start in air.
    pub fn trace(&mut self, launch: &Launch<N>) -> (&[Leaf<N>], &Outcome<N>) {
        let mut branch = Branch::launched(launch);
        let mut cell = self.begin(&mut branch);
        while let Some(here) = cell {
            let passage = self.bench.cell(here).advance(&branch.inner_ray(), self.limits.tolerance);
            cell = self.resume(&mut branch, here, passage.as_ref());
        }
        self.traced()
    }

    /// What has come of the last ray: see [`Tracer::trace`].
    #[must_use]
    pub fn traced(&self) -> (&[Leaf<N>], &Outcome<N>) {
        (&self.leaves, &self.outcome)
    }

    /// Follows the tree of a launched ray to where a branch, which takes the place of the given one, is to be
    /// taken through a cell that takes four: the device and its cell. None if it is at the end.
    pub(super) fn begin(&mut self, branch: &mut Branch<N>) -> Option<(u16, u16)> {
        self.leaves.clear();
        self.outcome = Outcome::default();
        self.waiting.clear();
        (self.events, self.threshold) = (0, self.least_power());
        self.walk(branch)
    }

    /// As [`Self::begin`], from where the branch has been taken through a cell.
    pub(super) fn resume(
        &mut self,
        branch: &mut Branch<N>,
        cell: (u16, u16),
        passage: Option<&Passage>,
    ) -> Option<(u16, u16)> {
        if !self.pass(branch, cell, passage) {
            *branch = self.waiting.pop()?;
        }
        self.walk(branch)
    }

    /// Takes rays through a cell: see [`Cell::advance_four`](crate::device::Cell::advance_four).
    pub(super) fn advance_four(
        &self,
        cell: (u16, u16),
        rays: &[Option<InnerRay>; 4],
    ) -> [Option<Passage>; 4] {
        self.bench.cell(cell).advance_four(rays, self.limits.tolerance)
    }

    fn walk(&mut self, branch: &mut Branch<N>) -> Option<(u16, u16)> {
        loop {
            let goes_on = if branch.largest_power() < self.threshold {
                self.outcome.rarities.endless += 1;
                self.prune(branch.power);
                false
            } else {
                self.events += 1;
                if self.events > MANY_EVENTS {
                    self.events -= MORE_EVENTS;
                    self.threshold *= 10.0;
                }
                match branch.place {
                    Place::Air { left } => self.through_air(branch, left),
                    Place::Cell { device, cell: index } => {
                        let cell = self.bench.cell((device, index));
                        if cell.takes_four() {
                            return Some((device, index));
                        }
                        !self.parts(branch, cell) && {
                            let passage = cell.advance(&branch.inner_ray(), self.limits.tolerance);
                            self.pass(branch, (device, index), passage.as_ref())
                        }
                    }
                }
            };
            if !goes_on {
                *branch = *self.waiting.last()?;
                self.waiting.truncate(self.waiting.len() - 1);
            }
        }
    }

    /// Takes from a branch what an absorbing medium keeps of it on a straight way; whether what is left
    /// is to be followed, for else it is pruned.
    pub(super) fn absorb(&mut self, branch: &mut Branch<N>, way: DVec3) -> bool {
        self.extinguish(branch, branch.attenuation.dot(way))
    }

    /// As [`Self::absorb`], given ∫ Im n ds along the way, cm.
    pub(super) fn extinguish(&mut self, branch: &mut Branch<N>, extinction: f64) -> bool {
        // Power never grows along a ray: rounding must not have it so.
        let depth = (self.bench.vacuum_wave_number() * extinction).max(0.0);
        let (amplitude, kept) = ((-depth).exp(), (-2.0 * depth).exp());
        for (i, power) in branch.power.iter_mut().enumerate() {
            let left = *power * kept;
            self.outcome.absorbed[i] += *power - left;
            *power = left;
            branch.electric[i] = branch.electric[i] * amplitude;
        }
        branch.weigh(self.least_power());
        self.follows(branch.power)
    }

    /// Counts power as pruned that an interface has left in waves too weak to follow, and as lost what it could
    /// not hand on: the account must not leak, even where numbers fail.
    pub(super) fn check_account(
        &mut self,
        branch: &Branch<N>,
        waves: &mut OutgoingWaves<N>,
        weak: [f64; N],
    ) {
        let rest: [f64; N] = std::array::from_fn(|i| {
            branch.power[i] - waves.iter().map(|wave| wave.power[i]).sum::<f64>() - weak[i]
        });
        if rest.iter().any(|rest| !rest.is_finite()) {
            waves.clear();
            self.lose(branch.power);
            return;
        }
        let mut lost = false;
        for (i, power) in branch.power.iter().enumerate() {
            self.outcome.pruned[i] += weak[i];
            if rest[i].abs() > LEAK * power {
                self.outcome.pruned[i] += rest[i];
                lost = true;
            }
        }
        self.outcome.rarities.lost += u64::from(lost);
    }

    /// The least power of branches that are followed.
    pub(super) fn least_power(&self) -> f64 {
        self.limits.min_power.max(NO_POWER)
    }

    /// Whether a branch of that power is followed; else it is pruned, and need not be made.
    pub(super) fn follows(&mut self, power: [f64; N]) -> bool {
        let largest = power.iter().copied().fold(0.0, f64::max);
        let follows = largest >= self.least_power();
        if !follows {
            self.prune(power);
        }
        follows
    }

    /// Gives up a branch that cannot be followed: it does not go on.
    pub(super) fn lose(&mut self, power: [f64; N]) -> bool {
        self.outcome.rarities.lost += 1;
        self.prune(power);
        false
    }

    pub(super) fn prune(&mut self, power: [f64; N]) {
        for (sum, power) in self.outcome.pruned.iter_mut().zip(power) {
            *sum += power;
        }
    }
}
