//! Where a ray tree ends: leaves, and the account of the power.

use glam::DVec3;
use optics::wave::ComplexVector;

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
    /// Whether the tree of each launched polarization alone has this leaf: elsewhere it is too weak for that one, and
    /// here because of the others.
    pub alone: [bool; N],
    /// Optical path length from the ray's origin to `position`, cm.
    pub optical_path: f64,
    /// The speed of light times the time of flight from the ray's origin to `position`, cm: the optical
    /// path length, but in media of negative index and those with a group index of their own.
    pub group_path: f64,
    /// The opaque body on which it ends, by its number among the devices; `position` is the place. `None`
    /// for a leaf that runs on through air.
    pub body: Option<u16>,
    /// A fingerprint of the surfaces it met and the branches it took: leaves of neighbouring rays with
    /// the same one have taken the same way.
    pub path: u64,
}

/// What became of the power that did not reach a leaf, and what was rare on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome<const N: usize> {
    /// Share absorbed by media, for each launched polarization.
    pub absorbed: [f64; N],
    /// Share of branches too weak to follow, for each launched polarization.
    pub pruned: [f64; N],
    /// Rare events.
    pub rarities: Rarities,
}

impl<const N: usize> Default for Outcome<N> {
    fn default() -> Self {
        Self { absorbed: [0.0; N], pruned: [0.0; N], rarities: Rarities::default() }
    }
}

/// Rare events, counted so that they do not pass unseen. Their power counts as pruned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rarities {
    /// Branches cut because a tree met more surfaces than can be followed, the weakest first; and those that run
    /// into an edge and never get there.
    pub endless: u64,
    /// Branches that could not be followed through a cell.
    pub lost: u64,
}

impl std::ops::AddAssign for Rarities {
    fn add_assign(&mut self, other: Self) {
        self.endless += other.endless;
        self.lost += other.lost;
    }
}
