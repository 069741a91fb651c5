//! Which leaves of a camera ray interfere: those that see the same thing, by ways of about the same
//! length.

use super::detection::Detection;
use super::prepared_scene::PreparedScene;
use crate::trace::{Leaf, LeafEnd, Pair, Way};
use glam::DVec3;

/// Leaves that see places further apart than this, in widths of a pixel, do not interfere: w is
/// below 1e-12.
const FARTHEST: f64 = 7.5;

/// What a leaf sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sight {
    Photograph,
    Body(u16),
    Surroundings,
}

/// The pairs of leaves of a camera ray that interfere. It keeps its memory from ray to ray.
#[derive(Clone, Debug, Default)]
pub(super) struct Interference {
    /// The pairs.
    pub pairs: Vec<Pair>,
    /// The power that the pairs add to that of all leaves: it is missing in what was absorbed.
    pub added: f64,
    /// What each leaf's power is multiplied by, as one of those that it interferes with; none
    /// without pairs.
    gain: Vec<f64>,
    /// The distance of each leaf to the photograph, cm.
    screens: Vec<Option<f64>>,
    /// The light of each leaf, as far as it is known.
    pub lights: Vec<[f64; 3]>,
    ways: Vec<Way>,
    /// For each leaf the power of the cluster of which it is the first.
    alone: Vec<f64>,
    /// For each leaf, one that it interferes with: they lead to the first of a cluster.
    clusters: Vec<usize>,
}

impl Interference {
    /// Finds the pairs among the leaves of a ray that starts at `camera` and of which a share has
    /// been `absorbed`, and the gains of the leaves.
    pub fn find<const N: usize>(
        &mut self,
        prepared: &PreparedScene<'_>,
        detection: &Detection<N>,
        leaves: &[Leaf<N>],
        camera: DVec3,
        absorbed: f64,
    ) {
        self.lights.clear();
        self.pair_up(prepared, detection, leaves, camera);
        self.share_out(detection, leaves);
        self.close(detection, leaves, absorbed);
    }

    /// Has the shares of the power add up. What the photograph gets is that which the picture shows of
    /// it. The rest takes what is left: where nothing was absorbed all of it, whatever the pairs give
    /// it. They give it something else where parts of the beam come to an edge or to another place,
    /// which the ray alone does not tell, or by the fields of branches that were pruned.
    fn close<const N: usize>(
        &mut self,
        detection: &Detection<N>,
        leaves: &[Leaf<N>],
        absorbed: f64,
    ) {
        if self.gain.is_empty() {
            return;
        }
        // Of the photograph, and of the rest: the power without pairs, and with them.
        let mut sums = [[0.0; 2]; 2];
        for (number, leaf) in leaves.iter().enumerate() {
            let power = detection.detected(&leaf.power);
            let [alone, together] = &mut sums[usize::from(!self.sees_photograph(number, leaf))];
            *alone += power;
            *together += power * self.gain[number];
        }
        let [[alone_seen, seen], [alone_rest, rest]] = sums;
        let alone = alone_seen + alone_rest;
        let most = alone + absorbed;
        let together = if absorbed > 0.0 { (seen + rest).min(most) } else { alone };
        let rest_share = if alone_rest > 0.0 { (together - seen).max(0.0) } else { 0.0 };
        let seen_share = together - rest_share;
        for (number, leaf) in leaves.iter().enumerate() {
            let [share, with, without] = if self.sees_photograph(number, leaf) {
                [seen_share, seen, alone_seen]
            } else {
                [rest_share, rest, alone_rest]
            };
            let gain = &mut self.gain[number];
            if with > 0.0 {
                *gain *= share / with;
            } else if without > 0.0 {
                *gain = share / without;
            }
        }
        self.added = together - alone;
    }

    fn sees_photograph<const N: usize>(&self, number: usize, leaf: &Leaf<N>) -> bool {
        leaf.body().is_none() && self.screens[number].is_some()
    }

    /// Finds the pairs alone.
    pub fn pair_up<const N: usize>(
        &mut self,
        prepared: &PreparedScene<'_>,
        detection: &Detection<N>,
        leaves: &[Leaf<N>],
        camera: DVec3,
    ) {
        self.pairs.clear();
        let Some(coherence) = prepared.coherence.filter(|_| leaves.len() > 1) else { return };
        self.screens.clear();
        self.screens.extend(leaves.iter().map(|leaf| leaf.distance_to(&prepared.screen)));
        self.clusters.clear();
        self.clusters.extend((0..leaves.len()).filter(|number| leaves[*number].is_in_air()));
        // Each of the strongest with those that see the same place as it.
        while self.clusters.len() > 1 {
            let power = |number: usize| detection.detected(&leaves[number].power);
            let strongest = (self.clusters.iter().copied())
                .reduce(|best, number| if power(number) > power(best) { number } else { best });
            let Some(strongest) = strongest else { return };
            let far = &leaves[strongest];
            let distance = |number: usize| self.screens[number];
            let sight = sight(far, distance(strongest));
            let point = seen(far, distance(strongest));
            let width = match sight {
                Sight::Surroundings => prepared.pixel.angle,
                _ => prepared.pixel.width_at(point.distance(camera)),
            };
            self.ways.clear();
            for &number in &self.clusters {
                let leaf = &leaves[number];
                let seen = seen(leaf, distance(number));
                let same = self::sight(leaf, distance(number)) == sight;
                if same && seen.distance(point) <= FARTHEST * width {
                    let phase_length = match sight {
                        Sight::Surroundings => leaf.phase_length(far.direction, DVec3::ZERO),
                        _ => leaf.phase_length(leaf.direction, point),
                    };
                    self.ways.push(Way { leaf: number, seen, phase_length });
                }
            }
            let gathered = &self.ways;
            self.clusters.retain(|number| gathered.iter().all(|way| way.leaf != *number));
            coherence.add_pairs(&mut self.ways, width, &mut self.pairs);
        }
    }

    /// Remembers the light of the next leaf.
    pub fn remember(&mut self, light: [f64; 3]) {
        self.lights.push(light);
    }

    /// What the power of a leaf is multiplied by.
    pub fn gain(&self, leaf: usize) -> f64 {
        self.gain.get(leaf).copied().unwrap_or(1.0)
    }

    /// Works out the gains. Parallel pairs alone count: of the
    /// fringes of others it is the mean.
    fn share_out<const N: usize>(&mut self, detection: &Detection<N>, leaves: &[Leaf<N>]) {
        self.gain.clear();
        self.added = 0.0;
        if !self.pairs.iter().any(|pair| pair.is_parallel(leaves)) {
            return;
        }
        self.clusters.clear();
        self.clusters.extend(0..leaves.len());
        for pair in self.pairs.iter().filter(|pair| pair.is_parallel(leaves)) {
            let [one, other] = pair.leaves.map(|leaf| first(&self.clusters, leaf));
            self.clusters[one.max(other)] = one.min(other);
        }
        self.gain.resize(leaves.len(), 0.0);
        // The sum over each cluster stands with its first leaf.
        for (number, leaf) in leaves.iter().enumerate() {
            self.gain[first(&self.clusters, number)] += detection.detected(&leaf.power);
        }
        self.alone.clone_from(&self.gain);
        for pair in self.pairs.iter().filter(|pair| pair.is_parallel(leaves)) {
            let more = detection.detected(&std::array::from_fn(|i| pair.power(leaves, i)));
            self.gain[first(&self.clusters, pair.leaves[0])] += more;
        }
        for number in (0..leaves.len()).rev() {
            let first = first(&self.clusters, number);
            // Rounding may leave less than nothing of light that goes out.
            self.gain[number] = (self.gain[first] / self.alone[first]).max(0.0);
        }
    }
}

/// The first leaf of a cluster.
fn first(clusters: &[usize], mut leaf: usize) -> usize {
    while clusters[leaf] != leaf {
        leaf = clusters[leaf];
    }
    leaf
}

fn sight<const N: usize>(leaf: &Leaf<N>, screen: Option<f64>) -> Sight {
    match (leaf.end, screen) {
        (LeafEnd::Body(body), _) => Sight::Body(body),
        (_, Some(_)) => Sight::Photograph,
        (_, None) => Sight::Surroundings,
    }
}

/// The point that a leaf sees, or its direction where it goes away.
fn seen<const N: usize>(leaf: &Leaf<N>, screen: Option<f64>) -> DVec3 {
    match (leaf.end, screen) {
        (LeafEnd::Body(_), _) => leaf.position,
        (_, Some(distance)) => leaf.position + leaf.direction * distance,
        (_, None) => leaf.direction,
    }
}
