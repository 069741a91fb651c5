//! Which leaves of a camera ray interfere: those that see the same thing, by ways of about the same
//! length.

use super::detection::Detection;
use super::prepared_scene::PreparedScene;
use crate::trace::{Coherence, Leaf, LeafEnd, Pair, Way};
use glam::DVec3;
use std::ops::Range;

/// Leaves that see places further apart than this, in widths of a pixel, do not interfere: w is
/// below 1e-12.
const FARTHEST: f64 = 7.5;

/// What rounding may make of all power.
const ROUNDING: f64 = 1e-9;

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
    /// The leaves that see the same place as others, cluster by cluster, each at all wavelengths in turn.
    ways: Vec<Way>,
    /// Where in these each cluster is.
    gathered: Vec<Range<usize>>,
    /// For each cluster and wavelength, how far apart places seen by one pixel may be.
    widths: Vec<f64>,
    /// The ways of a cluster between the wavelengths.
    between: Vec<Way>,
    /// For each leaf the power of the cluster of which it is the first.
    alone: Vec<f64>,
    /// For each leaf, one that it interferes with: they lead to the first of a cluster.
    clusters: Vec<usize>,
}

impl Interference {
    /// Finds the pairs among the leaves of a ray that starts at `camera` and of which shares have
    /// been pruned and absorbed, and the gains of the leaves.
    pub fn find<const N: usize>(
        &mut self,
        prepared: &PreparedScene<'_>,
        detection: &Detection<N>,
        leaves: &[Leaf<N>],
        camera: DVec3,
        [pruned, absorbed]: [f64; 2],
    ) {
        self.lights.clear();
        self.pair_up(prepared, detection, leaves, camera);
        self.share_out(detection, leaves);
        let left = detection.detected(&[1.0; N]) - pruned;
        self.close(detection, leaves, left, absorbed);
    }

    /// Has the shares of the power add up. What the photograph gets is that which the picture shows of
    /// it. The rest takes what is left: where nothing was absorbed all of it, whatever the pairs give
    /// it. They give it something else where parts of the beam come to an edge or to another place,
    /// which the ray alone does not tell, by the fields of branches that were pruned, or where some
    /// branches were joined on the way and others were not. `left` is what was not pruned.
    fn close<const N: usize>(
        &mut self,
        detection: &Detection<N>,
        leaves: &[Leaf<N>],
        left: f64,
        absorbed: f64,
    ) {
        if self.gain.is_empty() {
            let out = leaves.iter().map(|leaf| detection.detected(&leaf.power)).sum::<f64>();
            if absorbed != 0.0 || (out - left).abs() <= ROUNDING {
                return;
            }
            self.gain.resize(leaves.len(), 1.0);
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
        let together = if absorbed > 0.0 { (seen + rest).min(most) } else { left };
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
        self.added = if absorbed > 0.0 { together - alone } else { 0.0 };
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
        self.gather(prepared, detection, leaves, leaves.len(), camera);
        let Self { ways, gathered, widths, pairs, .. } = self;
        for (range, width) in gathered.iter().zip(widths) {
            coherence.add_pairs(&mut ways[range.clone()], *width, pairs);
        }
    }

    /// Gathers those of `count` leaves that see the same place. `leaves` has them in the light of one wavelength
    /// after the other; each sees the same thing in all.
    pub fn gather<const N: usize>(
        &mut self,
        prepared: &PreparedScene<'_>,
        detection: &Detection<N>,
        leaves: &[Leaf<N>],
        count: usize,
        camera: DVec3,
    ) {
        let Self { screens, clusters, ways, gathered, widths, .. } = self;
        screens.clear();
        screens.extend(leaves.iter().map(|leaf| leaf.distance_to(&prepared.screen)));
        ways.clear();
        gathered.clear();
        widths.clear();
        let nodes = leaves.len() / count;
        let middle = nodes / 2 * count;
        let sight = |number: usize| sight(&leaves[middle + number], screens[middle + number]);
        let seen = |number: usize| seen(&leaves[number], screens[number]);
        clusters.clear();
        clusters.extend((0..count).filter(|number| leaves[middle + number].is_in_air()));
        // Each of the strongest with those that see the same place as it.
        while clusters.len() > 1 {
            let power = |number: usize| detection.detected(&leaves[middle + number].power);
            let strongest = (clusters.iter().copied())
                .reduce(|best, number| if power(number) > power(best) { number } else { best });
            let Some(strongest) = strongest else { return };
            let what = sight(strongest);
            let (begin, first_width) = (ways.len(), widths.len());
            widths.extend((0..nodes).map(|node| match what {
                Sight::Surroundings => prepared.pixel.angle,
                _ => prepared.pixel.width_at(seen(node * count + strongest).distance(camera)),
            }));
            clusters.retain(|&number| {
                let begin = ways.len();
                let mut is_near = number == strongest;
                for (node, width) in widths[first_width..].iter().enumerate() {
                    let [far, leaf] = [strongest, number].map(|number| node * count + number);
                    let (point, place) = (seen(far), seen(leaf));
                    is_near |= place.distance(point) <= FARTHEST * width;
                    let phase_length = match what {
                        Sight::Surroundings => {
                            leaves[leaf].phase_length(leaves[far].direction, DVec3::ZERO)
                        }
                        _ => leaves[leaf].phase_length(leaves[leaf].direction, point),
                    };
                    ways.push(Way { leaf: number, seen: place, phase_length });
                }
                let is_in = is_near && sight(number) == what;
                if !is_in {
                    ways.truncate(begin);
                }
                !is_in
            });
            if ways.len() - begin > nodes {
                gathered.push(begin..ways.len());
            } else {
                ways.truncate(begin);
                widths.truncate(first_width);
            }
        }
    }

    /// Finds the pairs in light of a wavelength between those in which leaves have been gathered, which have
    /// these weights.
    pub fn pair_up_between(&mut self, coherence: &Coherence, weights: &[f64]) {
        let Self { ways, gathered, widths, between, pairs, .. } = self;
        pairs.clear();
        let nodes = weights.len();
        for (range, widths) in gathered.iter().zip(widths.chunks(nodes)) {
            between.clear();
            between.extend(ways[range.clone()].chunks(nodes).map(|ways| {
                let mut way = Way { leaf: ways[0].leaf, seen: DVec3::ZERO, phase_length: 0.0 };
                for (at, weight) in ways.iter().zip(weights) {
                    way.seen += at.seen * *weight;
                    way.phase_length += at.phase_length * weight;
                }
                way
            }));
            let width = widths.iter().zip(weights).map(|(width, weight)| width * weight).sum();
            coherence.add_pairs(between, width, pairs);
        }
    }

    /// The leaves that have been gathered, by their numbers.
    pub fn gathered(&self, nodes: usize) -> impl Iterator<Item = usize> {
        self.ways.iter().step_by(nodes).map(|way| way.leaf)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file;
    use crate::trace::Tracer;
    use std::path::Path;

    /// A slab of glass before the photograph, 20 micrometers thick and a little askew, in light of a wavelength.
    fn scene(wavelength_nm: f64) -> crate::scene::Scene {
        let text = format!(
            "[light]\nwavelength_nm = {wavelength_nm:?}\nbandwidth_nm = 2\n[[device]]\nkind = \"body\"\n\
             shape = \"slab\"\nthickness = 0.002\nindex = 1.5\nrotation = 2\n"
        );
        scene_file::parse(&text, "scene", Path::new(""), &[]).expect("a scene").scene
    }

    /// Places and lengths between wavelengths are weighted means: at a wavelength they are its own, and light that
    /// goes the same ways in all of them has the pairs that it has at its own wavelength.
    #[test]
    fn pairs_between_wavelengths_are_those_of_light_in_between() {
        const WAVELENGTHS: [f64; 3] = [500.0, 550.0, 600.0];
        let scenes = WAVELENGTHS.map(scene);
        let prepared = scenes.each_ref().map(|scene| PreparedScene::new(scene).expect("sound"));
        let detection = Detection::UNPOLARIZED;
        let camera = &scenes[0].camera;
        let ray = camera.ray(300.0, 500.0);
        let (mut all, mut own) = (Vec::new(), Vec::new());
        for prepared in &prepared {
            let mut tracer =
                Tracer::new(&prepared.assembly, prepared.limits).with_screen(prepared.screen);
            let (leaves, _) = tracer.trace(&detection.launch(camera, &ray));
            all.extend_from_slice(leaves);
            let mut alone = Interference::default();
            alone.pair_up(prepared, &detection, leaves, ray.origin);
            own.push(alone.pairs);
        }
        let count = all.len() / WAVELENGTHS.len();
        let mut interference = Interference::default();
        interference.gather(&prepared[0], &detection, &all, count, ray.origin);
        let ways: Vec<usize> = interference.gathered(WAVELENGTHS.len()).collect();
        assert!(ways.len() >= 3 && ways.iter().all(|way| *way < count), "{ways:?}");
        // At each wavelength, and at the middle one by those beside it.
        for (at, weights) in
            [(0, [1.0, 0.0, 0.0]), (1, [0.0, 1.0, 0.0]), (2, [0.0, 0.0, 1.0]), (1, [0.5, 0.0, 0.5])]
        {
            let coherence = prepared[at].coherence.expect("thin");
            interference.pair_up_between(&coherence, &weights);
            assert_eq!(interference.pairs.len(), own[at].len());
            assert!(!own[at].is_empty());
            for pair in &own[at] {
                let same = interference.pairs.iter().find(|other| other.leaves == pair.leaves);
                let off = (same.expect("the same pair").degree - pair.degree).norm();
                assert!(off < 1e-8, "{at} {weights:?}: {off}");
            }
        }
        // In light of another color the phases are others.
        let differ = own[0].iter().zip(&own[2]).any(|(a, b)| (a.degree - b.degree).norm() > 0.1);
        assert!(differ);
    }

    /// What is seen elsewhere, or is something else, interferes with nothing.
    #[test]
    fn leaves_that_see_different_things_are_not_gathered() {
        let scene = scene(550.0);
        let prepared = PreparedScene::new(&scene).expect("sound");
        let detection = Detection::UNPOLARIZED;
        let ray = scene.camera.ray(300.0, 500.0);
        let mut tracer = Tracer::new(&prepared.assembly, prepared.limits);
        let (leaves, _) = tracer.trace(&detection.launch(&scene.camera, &ray));
        // Of two leaves on the photograph one goes elsewhere, by many pixels, or past it.
        let seen = |leaf: &&Leaf<2>| leaf.distance_to(&prepared.screen).is_some();
        let one = leaves.iter().find(seen).expect("a leaf on the photograph");
        let mut interference = Interference::default();
        let mut gathered = |move_by: DVec3, turn: DVec3| {
            let mut other = *one;
            other.position += move_by;
            other.direction = (other.direction + turn).normalize();
            interference.gather(&prepared, &detection, &[*one, other], 2, ray.origin);
            interference.gathered(1).count()
        };
        assert_eq!(gathered(DVec3::ZERO, DVec3::ZERO), 2);
        assert_eq!(gathered(5.0 * DVec3::Y, DVec3::ZERO), 0);
        assert_eq!(gathered(DVec3::ZERO, -3.0 * DVec3::X), 0);
    }
}
