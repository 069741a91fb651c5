//! The wavelengths at which rays are traced, and the color that what they bring has.

use super::{Lamp, SEEN_NM, Sample};
use glam::{DMat3, DVec3};

/// In how many bins of wavelengths light of all wavelengths is looked at.
pub const BINS: usize = 16;

/// Their edges, nm: narrow where people see colors well.
pub const BIN_EDGES_NM: [f64; BINS + 1] = [
    380.0, 430.0, 450.0, 470.0, 490.0, 510.0, 530.0, 550.0, 570.0, 590.0, 610.0, 630.0, 650.0,
    670.0, 690.0, 720.0, 780.0,
];

/// Into how many groups, of as many bins each, light of all wavelengths is parted.
const GROUPS: [usize; 8] = [1, 2, 3, 4, 6, 8, 12, BINS];

/// The widths of bins within which light interferes, nm: for ways of nearly one length, and for others.
const FRINGE_BINS_NM: [f64; 2] = [20.0, 10.0];

/// At how many wavelengths rays are traced, and how what they bring is interpolated between them.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Interpolation {
    /// By the polynomial of the wave number through Chebyshev's nodes.
    Polynomial(usize),
    /// Linearly between neighbours of evenly spaced wavelengths, both ends of the range among them.
    Linear(usize),
}

/// A lamp's light in groups of wavelengths, and the wavelengths at which rays are traced.
#[derive(Clone, Debug)]
pub(crate) struct Bands {
    /// The wavelengths, nm: the nodes.
    pub nodes_nm: Vec<f64>,
    /// That next to the middle of the light.
    pub middle_node: usize,
    /// From coarse to fine, all wavelengths together, in two groups, and so on to the bins; lines each by itself.
    pub levels: Vec<Vec<Group>>,
    /// The bins within which light interferes, wide and narrow ones.
    pub fringes: [Vec<Fringe>; 2],
    /// All of it between neighbouring nodes, and beyond the last ones.
    pub stretches: Vec<Stretch>,
    /// How bright a white thing is in all of it.
    white: f64,
}

/// The light between two neighbouring nodes, as far as it goes with each of them, in proportion to how near it is; or beyond
/// the last one.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// The nodes, one or two.
    pub lights: Vec<(usize, Light)>,
}

/// The light of some wavelengths: how things of linear red, green and blue look, and what share of the lamp's
/// power each of them sends back in each of the bins.
#[derive(Clone, Debug)]
pub(crate) struct Light {
    /// The color of a thing.
    pub color: DMat3,
    /// The shares in each bin, where the light is in any.
    pub bins: Vec<(usize, [f64; 3])>,
}

/// The light of a range of wavelengths.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    /// Its wavelength, nm.
    pub nm: f64,
    /// From where to where it is, nm; a line is at both.
    pub edges_nm: [f64; 2],
    /// The weights of the nodes at its wavelength.
    pub middle: Vec<f64>,
    /// Those of the difference from its one end to the other.
    pub spread: Vec<f64>,
    /// Its light, weighted as what the nodes bring is.
    pub lights: Vec<Light>,
}

/// A bin within which light interferes.
#[derive(Clone, Debug)]
pub(crate) struct Fringe {
    /// Its light.
    pub group: Group,
    /// Its color, where things are of red, green and blue.
    pub color: DMat3,
    /// The number of the group of each level in which it is.
    pub groups: Vec<usize>,
}

impl Bands {
    /// Of a lamp, by rays of some wavelengths within a range (nm): what is beyond it goes as light of its ends does. Of
    /// a lamp with no more lines than that, each line is traced.
    pub fn new(lamp: &Lamp, interpolation: Interpolation, range_nm: [f64; 2]) -> Self {
        let samples = lamp.samples();
        let lines = matches!(lamp, Lamp::Lines(_));
        let (Interpolation::Polynomial(count) | Interpolation::Linear(count)) = interpolation;
        let each_line = lines && samples.len() <= count;
        let nodes_nm = if each_line {
            samples.iter().map(|sample| sample.nm).collect()
        } else if let Interpolation::Linear(_) = interpolation {
            even_nodes(count, range_nm)
        } else {
            chebyshev_nodes(count, range_nm)
        };
        let weights = |nm: f64| {
            let nm = nm.clamp(range_nm[0], range_nm[1]);
            match interpolation {
                Interpolation::Linear(_) if !each_line => linear_weights(&nodes_nm, nm),
                _ => weights(&nodes_nm, nm),
            }
        };
        let group = |[low, high]: [f64; 2], held: &[(f64, Sample)]| {
            let total: f64 = held.iter().map(|(share, sample)| share * loudness(sample)).sum();
            let nm = if total > 0.0 {
                let sum = held.iter().map(|(share, sample)| share * loudness(sample) * sample.nm);
                sum.sum::<f64>() / total
            } else {
                0.5 * (low + high)
            };
            let ends = [weights(low), weights(high)];
            let lights = (0..nodes_nm.len()).map(|node| {
                let held =
                    held.iter().map(|(share, sample)| (share * weights(sample.nm)[node], *sample));
                light(held)
            });
            Group {
                nm,
                edges_nm: [low, high],
                middle: weights(nm),
                spread: ends[1].iter().zip(&ends[0]).map(|(high, low)| high - low).collect(),
                lights: lights.collect(),
            }
        };
        let of_edges = |edges: &[f64]| -> Vec<Group> {
            let groups = edges.windows(2).map(|edges| {
                let [low, high] = [edges[0], edges[1]];
                let held: Vec<_> =
                    samples.iter().filter_map(|sample| within(sample, [low, high])).collect();
                group([low, high], &held)
            });
            groups.collect()
        };
        let of_lines = || -> Vec<Group> {
            samples.iter().map(|line| group([line.nm; 2], &[(1.0, *line)])).collect()
        };
        let levels = if lines {
            vec![of_lines()]
        } else {
            let edge = |bins: f64| {
                let bin = (bins as usize).min(BINS - 1);
                let [low, high] = [BIN_EDGES_NM[bin], BIN_EDGES_NM[bin + 1]];
                low + (bins - bin as f64) * (high - low)
            };
            let edges = |count: usize| -> Vec<f64> {
                (0..=count).map(|i| edge((i * BINS) as f64 / count as f64)).collect()
            };
            GROUPS.into_iter().map(|count| of_edges(&edges(count))).collect()
        };
        let fringe = |group: Group| Fringe {
            color: group.lights.iter().map(|light| light.color).sum(),
            groups: levels.iter().map(|groups| group_at(groups, group.nm)).collect(),
            group,
        };
        let fringes = FRINGE_BINS_NM.map(|width| {
            let groups = if lines {
                of_lines()
            } else {
                let count = ((SEEN_NM[1] - SEEN_NM[0]) / width) as usize;
                let edges: Vec<f64> = (0..=count).map(|i| SEEN_NM[0] + width * i as f64).collect();
                of_edges(&edges)
            };
            groups.into_iter().map(fringe).collect()
        });
        let nearest = |nm: f64| {
            let off = |node: usize| (1.0 / nodes_nm[node] - 1.0 / nm).abs();
            (0..nodes_nm.len()).min_by(|one, other| off(*one).total_cmp(&off(*other)))
        };
        let middle = levels[0].last().and_then(|group| nearest(group.nm)).unwrap_or(0);
        let stretches = if each_line {
            let line = |(node, line)| Stretch { lights: vec![(node, light([(1.0, line)]))] };
            samples.iter().copied().enumerate().map(line).collect()
        } else {
            stretches(&nodes_nm, &samples)
        };
        let white = levels[0].iter().flat_map(|group| &group.lights).map(brightness).sum();
        Self { levels, fringes, stretches, white, middle_node: middle, nodes_nm }
    }

    /// How bright a white thing is in some of the light, as a share of all.
    pub fn brightness(&self, light: &Light) -> f64 {
        brightness(light) / self.white
    }
}

fn brightness(light: &Light) -> f64 {
    /// Of red, green and blue (ITU-R BT.709).
    const BRIGHTNESS: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);
    BRIGHTNESS.dot(light.color * DVec3::ONE)
}

/// The stretches between nodes, the longest first, and beyond the last ones.
fn stretches(nodes_nm: &[f64], samples: &[Sample]) -> Vec<Stretch> {
    let last = nodes_nm.len() - 1;
    let stretch = |before: usize| {
        let held = samples.iter().filter(|sample| {
            nodes_nm.iter().take_while(|node| **node >= sample.nm).count() == before
        });
        let first = before.saturating_sub(1);
        let nodes = &nodes_nm[first..=before.min(last)];
        let of_node = |i: usize| {
            let share = |sample: &Sample| (linear_weights(nodes, sample.nm)[i], *sample);
            (first + i, light(held.clone().map(share)))
        };
        Stretch { lights: (0..nodes.len()).map(of_node).collect() }
    };
    (0..=nodes_nm.len()).map(stretch).collect()
}

/// The group in which a wavelength (nm) is.
fn group_at(groups: &[Group], nm: f64) -> usize {
    let holds = |group: &Group| group.edges_nm[0] <= nm && nm <= group.edges_nm[1];
    groups.iter().position(holds).unwrap_or(0)
}

/// How much a part of the light counts for what is seen.
fn loudness(sample: &Sample) -> f64 {
    sample.color.abs().element_sum()
}

/// A sample in a range of wavelengths, half of it if it is at an edge that others share.
fn within(sample: &Sample, [low, high]: [f64; 2]) -> Option<(f64, Sample)> {
    let is_edge = |nm: f64| sample.nm == nm && nm != SEEN_NM[0] && nm != SEEN_NM[1];
    let share = if is_edge(low) || is_edge(high) { 0.5 } else { 1.0 };
    (low <= sample.nm && sample.nm <= high).then_some((share, *sample))
}

/// The sum of samples, each with a weight.
fn light(held: impl IntoIterator<Item = (f64, Sample)>) -> Light {
    let (mut color, mut bins) = (DMat3::ZERO, Vec::<(usize, [f64; 3])>::new());
    for (weight, sample) in held {
        color += sample.color_of_things() * weight;
        let edges = BIN_EDGES_NM.windows(2).map(|edges| [edges[0], edges[1]]);
        for (bin, edges) in edges.enumerate() {
            let Some((share, sample)) = within(&sample, edges) else { continue };
            let shares = (sample.shares * (weight * share * sample.power)).to_array();
            match bins.iter_mut().find(|(known, _)| *known == bin) {
                Some((_, sum)) => sum.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share),
                None => bins.push((bin, shares)),
            }
        }
    }
    Light { color, bins }
}

/// Chebyshev's nodes in the wave number over a range of wavelengths (nm), the longest first.
pub(crate) fn chebyshev_nodes(count: usize, [shortest, longest]: [f64; 2]) -> Vec<f64> {
    let [low, high] = [1.0 / longest, 1.0 / shortest];
    let node = |i: usize| {
        let angle = std::f64::consts::PI * (i as f64 + 0.5) / count as f64;
        1.0 / (0.5 * (low + high) - 0.5 * (high - low) * angle.cos())
    };
    (0..count).map(node).collect()
}

/// Evenly spaced wavelengths (nm), the longest first, both ends of the range among them.
fn even_nodes(count: usize, [shortest, longest]: [f64; 2]) -> Vec<f64> {
    let step = (longest - shortest) / (count - 1) as f64;
    (0..count).map(|i| longest - step * i as f64).collect()
}

/// The weights of nodes (wavelengths, nm; the longest first) at a wavelength, linear between neighbours; beyond the last
/// ones, as there.
fn linear_weights(nodes_nm: &[f64], nm: f64) -> Vec<f64> {
    let mut weights = vec![0.0; nodes_nm.len()];
    let after = nodes_nm.partition_point(|node| *node >= nm);
    if after == 0 || after == nodes_nm.len() {
        weights[after.saturating_sub(1)] = 1.0;
    } else {
        let [long, short] = [nodes_nm[after - 1], nodes_nm[after]];
        weights[after] = (long - nm) / (long - short);
        weights[after - 1] = 1.0 - weights[after];
    }
    weights
}

/// The weights of nodes (wavelengths, nm) in the polynomial of the wave number through them, at a
/// wavelength.
pub(crate) fn weights(nodes_nm: &[f64], nm: f64) -> Vec<f64> {
    let x = 1.0 / nm;
    let at = |i: usize| 1.0 / nodes_nm[i];
    let others = |i: usize| (0..nodes_nm.len()).filter(move |j| *j != i);
    let weight = |i: usize| others(i).map(|j| (x - at(j)) / (at(i) - at(j))).product();
    (0..nodes_nm.len()).map(weight).collect()
}
