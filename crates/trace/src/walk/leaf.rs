//! Where a ray tree ends: leaves, and the account of the power.

use super::PathTime;
use super::branch::largest;
use crate::assembly::Screen;
use glam::DVec3;
use optics::wave::ComplexVector;
use std::fmt::Debug;

/// A branch that has left every device and runs on through air, or has ended on an opaque body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaf<const N: usize> {
    /// The last point at which it left a device; the ray's origin if it met none.
    pub position: DVec3,
    /// Whether it met a device at all.
    pub met_device: bool,
    /// Its direction, a unit vector.
    pub direction: DVec3,
    /// Its share of the power launched, for each launched polarization.
    pub power: [f64; N],
    /// Its electric field for each launched polarization, |E|² = power; it has the phases of the
    /// interfaces but not of the propagation.
    pub electric: [ComplexVector; N],
    /// Whether the tree of each launched polarization alone has this leaf: elsewhere it is too weak
    /// for that one, and here because of the others.
    pub survives_alone: [bool; N],
    /// Optical path length from the ray's origin to `position`, cm.
    pub optical_path: f64,
    /// The speed of light times the time of flight from the ray's origin to `position`, cm: the
    /// delay of the phase, which is the optical path, but where the phase runs backwards that of a
    /// pulse.
    pub delay_path: f64,
    /// The speed of light times what a pulse takes, cm; `None` where that is not known, behind
    /// media that absorb, and where the tracer has not been
    /// [asked](super::Tracer::with_group_delays).
    pub group_path: Option<f64>,
    /// Where it ends.
    pub end: LeafEnd,
    /// A fingerprint of the surfaces it met and the branches it took: leaves of neighbouring rays
    /// with the same one have taken the same way.
    pub path: u64,
}

/// Where a leaf ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeafEnd {
    /// Nowhere before the screen: it runs on through air from its position.
    Away,
    /// On an opaque body, by its number among the devices: at its position.
    Body(u16),
    /// On the screen, from within a body or what touches the screen: at its position.
    Screen,
}

impl<const N: usize> Leaf<N> {
    /// The opaque body on which it ends, by its number among the devices.
    #[must_use]
    pub fn body(&self) -> Option<u16> {
        match self.end {
            LeafEnd::Body(body) => Some(body),
            LeafEnd::Away | LeafEnd::Screen => None,
        }
    }

    /// When light that leaves the ray's origin at 0 comes to `position`.
    #[must_use]
    pub fn time(&self) -> PathTime {
        PathTime { phase: self.delay_path, pulse: self.group_path.unwrap_or(f64::NAN) }
    }

    /// Its share of the power launched in the strongest polarization.
    #[must_use]
    pub fn largest_power(&self) -> f64 {
        largest(&self.power)
    }

    /// Its power in all the polarizations launched, together.
    #[must_use]
    pub fn total_power(&self) -> f64 {
        self.power.iter().sum()
    }

    /// How far it goes on from its position to a screen, cm; `None` where it does not meet it.
    #[must_use]
    pub fn distance_to(&self, screen: &Screen) -> Option<f64> {
        match self.end {
            LeafEnd::Away => screen.hit(self.position, self.direction, 0.0),
            LeafEnd::Screen => Some(0.0),
            LeafEnd::Body(_) => None,
        }
    }
}

/// What became of the power that did not reach a leaf, and what was rare on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome<const N: usize> {
    /// Share absorbed by media, for each launched polarization.
    pub absorbed: [f64; N],
    /// Share of branches too weak to follow, for each launched polarization.
    pub pruned: [f64; N],
    /// Rare events.
    pub stats: TraceStats,
}

impl<const N: usize> Default for Outcome<N> {
    fn default() -> Self {
        Self { absorbed: [0.0; N], pruned: [0.0; N], stats: TraceStats::default() }
    }
}

impl<const N: usize> Outcome<N> {
    /// By how much what leaves, is absorbed and is pruned differs from what was launched, as a
    /// share of it: the largest of the polarizations, infinite if one of the powers is no number.
    #[must_use]
    pub fn imbalance(&self, leaves: &[Leaf<N>]) -> f64 {
        let off = |i: usize| {
            let left: f64 = leaves.iter().map(|leaf| leaf.power[i]).sum();
            let off = (left + self.absorbed[i] + self.pruned[i] - 1.0).abs();
            if off.is_nan() { f64::INFINITY } else { off }
        };
        (0..N).map(off).fold(0.0, f64::max)
    }

    /// The one check of the account of a ray's power, for tests: it adds up, and nothing was lost
    /// on the way. At each interface it adds up by construction, for the outgoing waves share what
    /// came in: that alone shows only that no branch was forgotten. What could not be followed or
    /// did not carry its share is counted in [`TraceStats::lost`]. `what` is printed if it does not
    /// hold.
    ///
    /// # Panics
    ///
    /// If the account is off by more than `tolerance` of what was launched, or a branch was lost.
    #[track_caller]
    pub fn assert_balanced(&self, leaves: &[Leaf<N>], tolerance: f64, what: &dyn Debug) {
        let (off, lost) = (self.imbalance(leaves), self.stats.lost);
        assert!(off <= tolerance && lost == 0, "off by {off:e}, {lost} lost: {what:?}");
    }
}

/// Rare events, counted so that they do not pass unseen. Their power counts as pruned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraceStats {
    /// Branches cut because a tree met more surfaces than can be followed, the weakest first; those
    /// that a graded medium keeps; and those that run into an edge and never get there.
    pub endless: u64,
    /// Branches that could not be followed through a region.
    pub lost: u64,
}

impl std::ops::AddAssign for TraceStats {
    fn add_assign(&mut self, other: Self) {
        self.endless += other.endless;
        self.lost += other.lost;
    }
}
