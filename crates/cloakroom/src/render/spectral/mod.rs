//! Pictures whose colors are traced each by itself: rays of a few wavelengths, and what they bring
//! interpolated between them.
//!
//! Leaves of one ray at all wavelengths belong together where they have taken the same way. What such a leaf brings
//! is a polynomial of the wave number, and the place that it sees as well: where the places of two
//! neighbouring groups of wavelengths are more than a pixel apart, the photograph is looked at for smaller
//! groups, each through a filter as long as the group's light is drawn out. So there is no noise of
//! colors, and no edge where a group ends. A way that light of some wavelengths does not take counts
//! between those that do and those that do not in proportion to how near they are. Where a design is what it is at one
//! wavelength alone, ways change all over the spectrum: more wavelengths are traced, and what they bring is interpolated
//! between neighbours.

use super::block_tracer::MOST_TRACERS;
use super::detection::Detection;
use super::exposure::{self, Look, Traced};
use super::flight::{Arrival, Arrivals};
use super::pixel::Pixel;
use super::prepared_scene::{PreparedScene, PreparedSceneError};
use crate::color::{
    BINS, Bands, Fringe, Group, Interpolation, Lamp, Light, Stretch, chebyshev_nodes, weights,
};
use crate::keys::KeyError;
use crate::scene::{DeviceSettings, SPECTRUM, Scene};
use crate::trace::{Coherence, Leaf};
use glam::{DMat3, DVec3};
use optics::interface::FilmLayer;
use optics::medium::Medium;
use optics::wave::ComplexVector;

/// The wavelengths that are traced at all: beyond, less than a thousandth of daylight is seen.
const TRACED_NM: [f64; 2] = [390.0, 730.0];

/// Where a law holds in less than the range that is traced, an end within these from it is tried every so many nm: what is
/// seen beyond it goes as there.
const WITHIN_NM: f64 = 60.0;
const EVERY_NM: f64 = 10.0;

/// The fewest and the most wavelengths at which rays through media of laws are traced.
const FEWEST: usize = 3;
const MOST_OF_MEDIA: usize = 10;

/// How far apart (nm) wavelengths are at most at which rays are traced through a design with a law, and how many there are at
/// least.
const OF_DESIGN_NM: f64 = 10.0;
const FEWEST_OF_DESIGN: usize = 9;

/// How exactly media are to be known between these wavelengths, of the largest entry of their tensors:
/// over a meter that is 0.1 mm.
const MEDIA_TOLERANCE: f64 = 1e-4;

/// Lamps of so many lines have each of them traced.
const MOST_LINES: usize = 8;

/// How far the light of a group of wavelengths may be drawn out, in pixels.
const MOST_DRAWN_OUT: f64 = 1.25;

/// A box of light has the coherence of a Gaussian line of this share of its width.
const BOX_TO_GAUSSIAN: f64 = 0.68;

/// The two widths of the bins of fringes.
const WIDE: usize = 0;
const NARROW: usize = 1;

/// The wavelengths of a picture whose colors are traced each by itself.
#[derive(Clone, Debug)]
pub(super) struct Spectral<'s> {
    pub bands: Bands,
    /// The scene in the light of each node.
    pub nodes: Vec<PreparedScene<'s>>,
    /// Where leaves interfere, the scene in the light of each wide and each narrow bin of fringes.
    fringes: [Vec<PreparedScene<'s>>; 2],
}

impl<'s> Spectral<'s> {
    /// The colors of red, green and blue things in all of the light.
    pub fn color(&self) -> DMat3 {
        let all = self.bands.levels.first().into_iter().flatten();
        all.flat_map(|group| &group.lights).map(|light| light.color).sum()
    }

    /// The same with leaves that never interfere.
    pub fn added_by_power(&self) -> Self {
        let nodes = self.nodes.iter().map(PreparedScene::added_by_power).collect();
        Self { bands: self.bands.clone(), nodes, fringes: [Vec::new(), Vec::new()] }
    }

    /// Of a scene, if its light is that of a lamp.
    ///
    /// # Errors
    ///
    /// If it is that of no lamp, or a device cannot be built for one of its wavelengths.
    pub fn of(prepared: &PreparedScene<'s>) -> Result<Option<Self>, PreparedSceneError> {
        let scene = prepared.scene;
        let is_dispersive = scene.devices.iter().any(DeviceSettings::is_dispersive);
        let lamp = scene.light.spectrum.lamp(is_dispersive).map_err(PreparedSceneError::Light)?;
        let Some(lamp) = lamp else {
            let message = "light of red, green and blue has no spectrum, for which picture.channels asks; write \
                           spectrum = \"D65\", or leave that channel out";
            let refused =
                KeyError::refuse_if(scene.picture.asks_for("spectrum"), SPECTRUM, message);
            return refused.map_err(PreparedSceneError::Light).map(|()| None);
        };
        let assembly = &prepared.assembly;
        let films =
            || assembly.devices().iter().flat_map(|device| &device.structure.films).flatten();
        let changes = is_dispersive || assembly.absorbs() || films().next().is_some();
        let range = range_of(scene, &lamp)?;
        let interpolation = match &lamp {
            Lamp::Lines(lines) if lines.len() <= MOST_LINES => {
                Interpolation::Polynomial(lines.len())
            }
            _ if scene.devices.iter().any(DeviceSettings::has_dispersion_law) => {
                let count = ((range[1] - range[0]) / OF_DESIGN_NM).ceil() as usize + 1;
                Interpolation::Linear(count.max(FEWEST_OF_DESIGN))
            }
            _ if changes => Interpolation::Polynomial(nodes_for(prepared, range)?),
            _ => Interpolation::Polynomial(1),
        };
        let bands = Bands::new(&lamp, interpolation, range);
        let nodes = if changes {
            bands.nodes_nm.iter().map(|nm| prepared.at(*nm)).collect::<Result<_, _>>()?
        } else {
            vec![prepared.clone(); bands.nodes_nm.len()]
        };
        let fringe = |bin: &Fringe| {
            let bandwidth_nm = match bin.group.edges_nm {
                [low, high] if low == high => scene.light.bandwidth_nm.value,
                [low, high] => BOX_TO_GAUSSIAN * (high - low),
            };
            let coherence = Some(Coherence::new(bin.group.nm, bandwidth_nm));
            prepared.with_coherence(coherence)
        };
        let is_coherent = prepared.coherence.is_some();
        let fringes = bands.fringes.each_ref().map(|bins| {
            let bins = bins.iter().filter(|_| is_coherent);
            bins.map(fringe).collect()
        });
        Ok(Some(Self { bands, nodes, fringes }))
    }
}

/// The wavelengths (nm) that are traced: all that are seen, but for the ends where a law does not hold.
fn range_of(scene: &Scene, lamp: &Lamp) -> Result<[f64; 2], PreparedSceneError> {
    if let Lamp::Lines(lines) = lamp {
        let all = lines.iter().map(|[nm, _]| *nm);
        return Ok([all.clone().fold(f64::INFINITY, f64::min), all.fold(0.0, f64::max)]);
    }
    let lit = lamp.samples().into_iter().filter(|sample| sample.color != DVec3::ZERO);
    let [first, last] = lit.fold([f64::INFINITY, 0.0], |[first, last], sample| {
        [f64::min(first, sample.nm - EVERY_NM), f64::max(last, sample.nm + EVERY_NM)]
    });
    let [first, last] = [first, last].map(|end| end.clamp(TRACED_NM[0], TRACED_NM[1]));
    // Of what lies beyond, the last light that is traced is as good as any.
    let first = first.min(TRACED_NM[1] - EVERY_NM);
    let last = last.max(TRACED_NM[0] + EVERY_NM);
    let end = |from: f64, inward: f64| {
        let ends = std::iter::successors(Some(0.0), |within| Some(within + EVERY_NM))
            .take_while(|within| *within <= WITHIN_NM)
            .map(|within| from + inward * within);
        // What is wrong is told of the end.
        let found = ends.into_iter().find(|nm| media_at(scene, *nm).is_ok());
        found.map_or_else(|| media_at(scene, from).map(|_| from), Ok)
    };
    Ok([end(first, 1.0)?, end(last, -1.0)?])
}

/// The entries of both tensors of a medium, real and imaginary.
type Entries = [f64; 36];

/// All entries of the tensors of media that are of a law, in light of a wavelength (nm).
fn media_at(scene: &Scene, nm: f64) -> Result<Vec<Entries>, PreparedSceneError> {
    let devices = scene.devices.iter().filter(|device| device.is_dispersive());
    let devices = devices.cloned().collect();
    let scene = Scene { devices, ..Scene::default() };
    let entries = |medium: &Medium| -> Entries {
        let (permittivity, permeability) = medium.tensors();
        let parts = [permittivity.re, permittivity.im, permeability.re, permeability.im];
        std::array::from_fn(|i| parts[i / 9].to_cols_array()[i % 9])
    };
    let mut media = Vec::new();
    for (device, settings) in scene.devices.iter().enumerate() {
        let settings = DeviceSettings { wavelength_nm: nm, ..settings.clone() };
        let structure = settings.structure(device);
        let structure = structure.map_err(|error| PreparedSceneError::Device { device, error })?;
        media.extend(structure.homogeneous_media().map(entries));
    }
    Ok(media)
}

/// At how many wavelengths a film is to be known: what it lets through is a sum of harmonics of the phase over
/// its thickness, each weaker than the last by the reflection at both its sides.
fn nodes_for_film(film: &[FilmLayer], range: [f64; 2]) -> usize {
    const NM_PER_CM: f64 = 1e7;
    /// Harmonics that are weaker do not count.
    const WEAKEST: f64 = 1e-3;
    let phase = |layer: &FilmLayer| {
        let path = 2.0 * layer.medium.mean_index() * layer.thickness * NM_PER_CM;
        std::f64::consts::PI * path * (1.0 / range[0] - 1.0 / range[1])
    };
    let phase: f64 = film.iter().map(phase).sum();
    let highest = film.iter().map(|layer| layer.medium.mean_index()).fold(1.0, f64::max);
    let both_sides = 0.5 * ((highest - 1.0) / (highest + 1.0)).powi(2);
    let harmonics = (WEAKEST.ln() / both_sides.max(WEAKEST).ln()).clamp(1.0, 4.0);
    FEWEST + (phase * harmonics).ceil() as usize
}

/// At how many wavelengths rays are traced, so that what they meet is known between them.
fn nodes_for(prepared: &PreparedScene<'_>, range: [f64; 2]) -> Result<usize, PreparedSceneError> {
    let scene = prepared.scene;
    let films = prepared.assembly.devices().iter().flat_map(|device| &device.structure.films);
    let of_films = films.map(|film| nodes_for_film(film, range)).max().unwrap_or(FEWEST);
    let between: Vec<f64> = chebyshev_nodes(2 * MOST_OF_MEDIA, range);
    let wanted: Vec<_> = between.iter().map(|nm| media_at(scene, *nm)).collect::<Result<_, _>>()?;
    let mut of_media = FEWEST;
    while of_media < MOST_OF_MEDIA {
        let nodes = chebyshev_nodes(of_media, range);
        let known: Vec<_> =
            nodes.iter().map(|nm| media_at(scene, *nm)).collect::<Result<_, _>>()?;
        let error = |(nm, wanted): (&f64, &Vec<Entries>)| {
            let weights = weights(&nodes, *nm);
            let of_medium = |(medium, wanted): (usize, &Entries)| {
                let largest = wanted.iter().map(|entry| entry.abs()).fold(0.0, f64::max);
                let off = |i: usize| {
                    let terms = weights
                        .iter()
                        .zip(&known)
                        .map(|(weight, media)| media[medium][i] * *weight);
                    (terms.sum::<f64>() - wanted[i]).abs()
                };
                (0..wanted.len()).map(off).fold(0.0, f64::max) / largest
            };
            wanted.iter().enumerate().map(of_medium).fold(0.0, f64::max)
        };
        if between.iter().zip(&wanted).map(error).fold(0.0, f64::max) <= MEDIA_TOLERANCE {
            break;
        }
        of_media += 1;
    }
    Ok(of_media.max(of_films).min(MOST_TRACERS - 1))
}

/// Memory to work in, kept from ray to ray.
#[derive(Debug)]
pub(super) struct Working<const N: usize> {
    /// The ways of the ray, and of its neighbours where they are looked for: the number of a way's leaf
    /// at each node; those of the next way follow.
    ways: [Vec<Option<usize>>; 3],
    lights: Vec<DVec3>,
    /// For each way, the level at which it looks, and where its lights begin.
    views: Vec<(usize, usize)>,
    /// Where a way looks at each node.
    places: Vec<DVec3>,
    /// The same of a way that is not taken at all nodes, with the number of the leaf.
    looks: Vec<Option<View>>,
    /// The leaves of three rays in the light of a bin.
    leaves: [Vec<Leaf<N>>; 3],
    exposure: exposure::Working,
}

impl<const N: usize> Default for Working<N> {
    fn default() -> Self {
        Self {
            ways: std::array::from_fn(|_| Vec::new()),
            lights: Vec::new(),
            views: Vec::new(),
            places: Vec::new(),
            looks: Vec::new(),
            leaves: std::array::from_fn(|_| Vec::new()),
            exposure: exposure::Working::default(),
        }
    }
}

/// What a way sees at a node.
#[derive(Clone, Copy, Debug)]
struct View {
    /// The number of its leaf.
    leaf: usize,
    look: Look,
    /// The [place](exposure::place), and what that changes by to the pixels across and down.
    at: DVec3,
    steps: [DVec3; 2],
}

/// The rays of a block in the light of each node, of which one pixel is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nodes<'a, const N: usize> {
    pub blocks: &'a [[Traced<'a, N>; 4]],
    /// Which pixel of the block.
    pub pixel: usize,
}

impl<'a, const N: usize> Nodes<'a, N> {
    /// How many nodes there are.
    fn count(&self) -> usize {
        self.blocks.len()
    }

    /// The ray of the pixel (0) or its neighbour across (1) or down (2) at a node.
    fn ray(&self, node: usize, ray: usize) -> &'a Traced<'a, N> {
        &self.blocks[node][self.pixel ^ ray]
    }
}

/// What a pixel sees in colors.
#[derive(Debug)]
pub(super) struct Colors<'a> {
    pub pixel: &'a mut Pixel,
    /// The light in each bin, where it is wanted.
    pub spectrum: Option<&'a mut [f64; BINS]>,
    /// What arrives, where that is looked at.
    pub arrivals: &'a mut Vec<Arrival>,
}

/// Adds to a pixel the colors of one camera ray, as [`exposure::expose`] does what it sees: `nodes` are the
/// ray and its neighbours in the light of each node.
pub(super) fn expose<const N: usize>(
    spectral: &Spectral<'_>,
    detection: &Detection<N>,
    nodes: Nodes<'_, N>,
    spacing: f64,
    colors: &mut Colors<'_>,
    working: &mut Working<N>,
) {
    let is_coherent = spectral.fringes.iter().any(|bins| !bins.is_empty());
    let Working { ways: [ways, ..], places, .. } = working;
    find_ways(nodes, 0, ways);
    let count = nodes.count();
    let mut is_whole = |way: &[Option<usize>]| see(spectral, nodes, way, places).is_some();
    if is_coherent && !ways.chunks(count).all(&mut is_whole) {
        expose_fringes(spectral, detection, nodes, spacing, colors, working);
        return;
    }
    let Working { ways: [ways, ..], lights, views, places, looks, .. } = &mut *working;
    views.clear();
    lights.clear();
    for way in 0..ways.len() / count {
        let numbers = way * count..(way + 1) * count;
        let leaves = |node: usize| nodes.ray(node, 0).leaves;
        let steps = |node: usize, leaf: usize, place: (Look, DVec3)| {
            let rays = [0, 1, 2].map(|ray| nodes.ray(node, ray));
            exposure::steps(&spectral.nodes[node], rays, leaf, place)
        };
        if let Some(look) = see(spectral, nodes, &ways[numbers.clone()], places) {
            let prepared = &spectral.nodes[0];
            let power = ways[way * count].map_or(0.0, |number| leaves(0)[number].largest_power());
            let middle = spectral.bands.middle_node;
            let Some(number) = ways[way * count + middle] else { continue };
            let steps = steps(middle, number, (look, places[middle]));
            let Some(level) = level(&spectral.bands, places, steps, power) else { continue };
            let steps = steps.map(|step| step * spacing);
            let groups = &spectral.bands.levels[level];
            let begin = lights.len();
            views.push((level, begin));
            for group in groups {
                let light = light_of(prepared, group, (look, places), steps);
                lights.push(DVec3::from_array(light));
            }
            for (node, number) in numbers.enumerate() {
                let Some(number) = ways[number] else { continue };
                let leaf = &leaves(node)[number];
                let lights = groups.iter().zip(&lights[begin..]);
                add(
                    detection,
                    leaf,
                    lights.map(|(group, light)| (&group.lights[node], *light)),
                    colors,
                );
            }
            if let Some(looked) = &detection.arrivals {
                let of_way = &ways[way * count..(way + 1) * count];
                let leaves = || {
                    let numbers = of_way.iter().enumerate();
                    numbers.filter_map(|(node, number)| Some(&leaves(node)[(*number)?]))
                };
                let all = groups.iter().zip(&lights[begin..]);
                colors.arrivals.extend(all.map(|(group, light)| {
                    arrival_of_group(spectral, detection, looked, group, leaves(), *light)
                }));
            }
        } else {
            looks.clear();
            looks.extend(ways[numbers].iter().enumerate().map(|(node, leaf)| {
                let leaf = (*leaf)?;
                let (look, at) = exposure::place(&spectral.nodes[node], &leaves(node)[leaf]);
                Some(View { leaf, look, at, steps: steps(node, leaf, (look, at)) })
            }));
            for stretch in &spectral.bands.stretches {
                for (node, light) in &stretch.lights {
                    let node = *node;
                    let Some(View { leaf, look, at, steps }) = looks[node] else { continue };
                    let across = drift(looks, stretch, node);
                    let spread = across * SPREAD_BY_NEARNESS;
                    let at = place_of(look, at + across * MIDDLE_BY_NEARNESS);
                    let steps = steps.map(|step| step * spacing);
                    let prepared = &spectral.nodes[node];
                    let seen = exposure::seen(prepared, look, at, steps, spread);
                    let leaf = &leaves(node)[leaf];
                    if let Some(looked) = &detection.arrivals {
                        let screen = (&prepared.screen, leaf.distance_to(&prepared.screen));
                        let power = detection.detected(&leaf.power);
                        let color = light.color * DVec3::from_array(seen) * power;
                        let power = power * spectral.bands.brightness(light);
                        colors.arrivals.push(Arrival::of(
                            looked,
                            leaf,
                            screen,
                            power,
                            color.to_array(),
                        ));
                    }
                    add(detection, leaf, std::iter::once((light, DVec3::from_array(seen))), colors);
                }
            }
        }
    }
    if is_coherent && views.len() > 1 {
        interfere(spectral, detection, nodes, colors, working);
    }
}

/// Light that goes with a node in proportion to how near it is, from the node itself to the next one, has its middle at this
/// share of the way between them, and is spread out as a box is of that one, √(2/3).
const MIDDLE_BY_NEARNESS: f64 = 1.0 / 3.0;
const SPREAD_BY_NEARNESS: f64 = 0.816_496_580_927_726;

/// By how much the place that a way sees changes from a node to the other end of a stretch; by nothing if the way sees
/// something else there, or is not taken.
fn drift(looks: &[Option<View>], stretch: &Stretch, node: usize) -> DVec3 {
    let there = stretch.lights.iter().find(|(other, _)| *other != node);
    match (looks[node], there.and_then(|(other, _)| looks[*other])) {
        (Some(here), Some(there)) if here.look == there.look => there.at - here.at,
        _ => DVec3::ZERO,
    }
}

/// What arrives in the light of a group of wavelengths by a way, whose leaves at all nodes see the same thing.
fn arrival_of_group<'l, const N: usize>(
    spectral: &Spectral<'_>,
    detection: &Detection<N>,
    looked: &Arrivals,
    group: &Group,
    leaves: impl Iterator<Item = &'l Leaf<N>>,
    seen: DVec3,
) -> Arrival {
    let screen = &spectral.nodes[0].screen;
    let (mut power, mut light) = (0.0, DVec3::ZERO);
    let (mut time, mut flash) = (Some(0.0), 0.0);
    for ((leaf, of_node), weight) in leaves.zip(&group.lights).zip(&group.middle) {
        let of_leaf = detection.detected(&leaf.power);
        power += of_leaf * spectral.bands.brightness(of_node);
        light += of_node.color * seen * of_leaf;
        let arrives = match (leaf.body(), leaf.distance_to(screen)) {
            (None, Some(distance)) => Some(looked.of(leaf, distance, screen)),
            _ => None,
        };
        time = time.zip(arrives).map(|(sum, (time, bright))| {
            flash += weight * bright;
            sum + weight * time
        });
    }
    match time {
        Some(time) => Arrival::flashed(time, flash, power, light.to_array()),
        None => Arrival { time, power, light: light.to_array() },
    }
}

/// What a way sees, and the places of it at every node, if it is taken at all of them and sees the same there.
fn see<const N: usize>(
    spectral: &Spectral<'_>,
    nodes: Nodes<'_, N>,
    way: &[Option<usize>],
    places: &mut Vec<DVec3>,
) -> Option<Look> {
    places.clear();
    let mut first = None;
    for (node, number) in way.iter().enumerate() {
        let leaf = &nodes.ray(node, 0).leaves[(*number)?];
        let (look, place) = exposure::place(&spectral.nodes[node], leaf);
        places.push(place);
        let seen = (leaf.end, look);
        if *first.get_or_insert(seen) != seen {
            return None;
        }
    }
    first.map(|(_, look)| look)
}

/// Adds to a pixel what leaves that interfere see more or less than each alone, bin by bin of fringes. All
/// ways are whole, and what they see is known.
fn interfere<const N: usize>(
    spectral: &Spectral<'_>,
    detection: &Detection<N>,
    nodes: Nodes<'_, N>,
    colors: &mut Colors<'_>,
    working: &mut Working<N>,
) {
    let (ways, count) = (&working.ways[0], nodes.count());
    let leaf = |way: usize, node: usize| {
        ways[way * count + node].map(|number| &nodes.ray(node, 0).leaves[number])
    };
    let first_leaves = (0..working.views.len()).filter_map(|way| leaf(way, 0));
    let width = if have_nearly_one_length(first_leaves) { WIDE } else { NARROW };
    let bins = spectral.bands.fringes[width].iter().zip(&spectral.fringes[width]);
    let camera = nodes.ray(0, 0).ray.origin;
    let count_of_ways = working.views.len();
    let [leaves, between, ..] = &mut working.leaves;
    leaves.clear();
    leaves.extend(
        (0..count).flat_map(|node| (0..count_of_ways).filter_map(move |way| leaf(way, node))),
    );
    let interference = &mut working.exposure.interference;
    interference.gather(&spectral.nodes[0], detection, leaves, count_of_ways, camera);
    between.clear();
    between.extend_from_slice(&leaves[..count_of_ways]);
    for (bin, prepared) in bins {
        let (Some(coherence), weights) = (prepared.coherence, &bin.group.middle) else { continue };
        interference.pair_up_between(&coherence, weights);
        if interference.pairs.is_empty() {
            continue;
        }
        for way in interference.gathered(count) {
            let leaves = leaves[way..].iter().step_by(count_of_ways);
            (between[way].power, between[way].electric) = brought(leaves, weights);
        }
        interference.lights.clear();
        for (level, begin) in &working.views {
            let light = working.lights[begin + bin.groups[*level]];
            interference.remember(light.to_array());
        }
        let mut seen = Pixel::default();
        exposure::interfere(detection, between, interference, &mut seen);
        add_fringe(bin, detection, &seen, colors);
    }
}

/// Adds to a pixel what is seen in a bin of fringes.
fn add_fringe<const N: usize>(
    bin: &Fringe,
    detection: &Detection<N>,
    seen: &Pixel,
    colors: &mut Colors<'_>,
) {
    colors.pixel.add_colors(seen, bin.color, detection);
    if let Some(spectrum) = &mut colors.spectrum {
        for (number, shares) in bin.group.lights.iter().flat_map(|light| &light.bins) {
            spectrum[*number] += DVec3::from_array(*shares).dot(DVec3::from_array(seen.image));
        }
    }
}

/// Whether those of the leaves that interfere in narrow bins differ by so little that wide ones tell as
/// much.
fn have_nearly_one_length<'l, const N: usize>(
    leaves: impl Iterator<Item = &'l Leaf<N>> + Clone,
) -> bool {
    /// Longer differences are seen in no bin, cm.
    const INTERFERING: f64 = 1e-2;
    /// Over a wide bin of green light, half a radian.
    const NEARLY_ONE: f64 = 1.2e-4;
    let length = |leaf: &Leaf<N>| leaf.phase_length(leaf.direction, DVec3::ZERO);
    let mut others = leaves.clone();
    leaves.clone().all(|one| {
        others.next();
        others.clone().all(|other| {
            let difference = (length(one) - length(other)).abs();
            !(NEARLY_ONE..INTERFERING).contains(&difference)
        })
    })
}

/// Finds the ways of a ray, one of three: for each the number of its leaf at every node.
fn find_ways<const N: usize>(nodes: Nodes<'_, N>, ray: usize, ways: &mut Vec<Option<usize>>) {
    ways.clear();
    let count = nodes.count();
    for node in 0..count {
        for (number, leaf) in nodes.ray(node, ray).leaves.iter().enumerate() {
            let path = |way: usize| {
                let first = ways[way * count..(way + 1) * count].iter().enumerate();
                let known = first.filter_map(|(node, number)| Some((node, (*number)?))).next();
                known.map(|(node, number)| nodes.ray(node, ray).leaves[number].path)
            };
            let is_this =
                |way: &usize| path(*way) == Some(leaf.path) && ways[way * count + node].is_none();
            let all = ways.len() / count;
            // As a rule it is in the same place.
            let way = Some(number).filter(|way| *way < all && is_this(way));
            let way = way.or_else(|| (0..all).find(is_this)).unwrap_or(all);
            if way == all {
                ways.extend(std::iter::repeat_n(None, count));
            }
            ways[way * count + node] = Some(number);
        }
    }
}

/// The level of the groups of wavelengths in which a way with so much power looks at things, whose place changes by these
/// steps from a pixel to the next: so small that none of a strong one is drawn out by more than [`MOST_DRAWN_OUT`], if
/// there are such.
fn level(bands: &Bands, places: &[DVec3], steps: [DVec3; 2], power: f64) -> Option<usize> {
    let spread = sum(&bands.levels.first()?.first()?.spread, places);
    // As wide as a pixel is in the direction in which light is drawn out.
    let length = spread.length_squared();
    let pixel = steps.iter().map(|step| step.dot(spread).powi(2)).sum::<f64>().sqrt();
    let count = if length == 0.0 { 1.0 } else { length / (MOST_DRAWN_OUT * pixel) };
    let count = count * power.min(1.0).sqrt();
    let level = bands.levels.iter().position(|level| level.len() as f64 >= count);
    Some(level.unwrap_or(bands.levels.len() - 1))
}

fn sum(weights: &[f64], places: &[DVec3]) -> DVec3 {
    weights.iter().zip(places).map(|(weight, place)| *place * *weight).sum()
}

/// A place between others: of the surroundings, it is a direction.
fn place_of(look: Look, between: DVec3) -> DVec3 {
    if look == Look::Surroundings { between.normalize_or_zero() } else { between }
}

/// What a way sees in the light of a group.
fn light_of(
    prepared: &PreparedScene<'_>,
    group: &Group,
    (look, places): (Look, &[DVec3]),
    steps: [DVec3; 2],
) -> [f64; 3] {
    let at = place_of(look, sum(&group.middle, places));
    let spread = sum(&group.spread, places);
    exposure::seen(prepared, look, at, steps, spread)
}

/// Adds to a pixel what a leaf brings, which counts for some light each with what is seen in it.
fn add<'b, const N: usize>(
    detection: &Detection<N>,
    leaf: &Leaf<N>,
    lights: impl Iterator<Item = (&'b Light, DVec3)>,
    colors: &mut Colors<'_>,
) {
    let power = detection.detected(&leaf.power);
    let mut color = DVec3::ZERO;
    for (light, seen) in lights {
        color += light.color * seen;
        if let Some(spectrum) = &mut colors.spectrum {
            for (bin, shares) in &light.bins {
                spectrum[*bin] += power * DVec3::from_array(*shares).dot(seen);
            }
        }
    }
    exposure::add_leaf(detection, leaf, power, color.to_array(), colors.pixel);
}

/// The same where leaves interfere: bin by bin of fringes, each as light of one wavelength and the width of the bin.
fn expose_fringes<const N: usize>(
    spectral: &Spectral<'_>,
    detection: &Detection<N>,
    nodes: Nodes<'_, N>,
    spacing: f64,
    colors: &mut Colors<'_>,
    working: &mut Working<N>,
) {
    for (ray, ways) in working.ways.iter_mut().enumerate().skip(1) {
        find_ways(nodes, ray, ways);
    }
    for (bin, prepared) in spectral.bands.fringes[NARROW].iter().zip(&spectral.fringes[NARROW]) {
        let weights = &bin.group.middle;
        let nearest =
            (0..weights.len()).max_by(|a, b| weights[*a].total_cmp(&weights[*b])).unwrap_or(0);
        for (ray, (leaves, ways)) in working.leaves.iter_mut().zip(&working.ways).enumerate() {
            leaves.clear();
            for way in ways.chunks(nodes.count()) {
                let all = || {
                    let numbers = way.iter().enumerate();
                    numbers
                        .filter_map(|(node, number)| Some(&nodes.ray(node, ray).leaves[(*number)?]))
                };
                let Some(number) = way[nearest] else { continue };
                let leaf = &nodes.ray(nearest, ray).leaves[number];
                let is_whole =
                    all().count() == nodes.count() && all().all(|other| other.end == leaf.end);
                leaves.push(if is_whole { interpolated(leaf, all(), weights) } else { *leaf });
            }
        }
        let traced = [0, 1, 2].map(|ray| {
            let Traced { ray: line, outcome, .. } = *nodes.ray(nearest, ray);
            Traced { ray: line, leaves: &working.leaves[ray], outcome, first_face: None }
        });
        let mut seen = Pixel::default();
        let traced = traced.each_ref();
        exposure::expose::<N, true>(
            prepared,
            detection,
            traced,
            spacing,
            &mut seen,
            &mut working.exposure,
        );
        add_fringe(bin, detection, &seen, colors);
    }
}

/// A leaf between the nodes: `leaf` is that of the nearest.
fn interpolated<'l, const N: usize>(
    leaf: &Leaf<N>,
    all: impl Iterator<Item = &'l Leaf<N>> + Clone,
    weights: &[f64],
) -> Leaf<N> {
    let mut found = *leaf;
    (found.position, found.direction, found.optical_path) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for (leaf, weight) in all.clone().zip(weights) {
        found.position += leaf.position * *weight;
        found.direction += leaf.direction * *weight;
        found.optical_path += leaf.optical_path * weight;
    }
    found.direction = found.direction.normalize_or_zero();
    (found.power, found.electric) = brought(all, weights);
    found
}

/// The powers and fields of a leaf between the nodes.
fn brought<'l, const N: usize>(
    all: impl Iterator<Item = &'l Leaf<N>>,
    weights: &[f64],
) -> ([f64; N], [ComplexVector; N]) {
    let (mut power, mut electric) = ([0.0; N], [ComplexVector::ZERO; N]);
    for (leaf, &weight) in all.zip(weights) {
        for i in 0..N {
            power[i] += leaf.power[i] * weight;
            electric[i].re += leaf.electric[i].re * weight;
            electric[i].im += leaf.electric[i].im * weight;
        }
    }
    for (power, electric) in power.iter_mut().zip(&mut electric) {
        *power = power.max(0.0);
        let norm = electric.norm_squared();
        // As strong as its power says.
        let scale = if norm > 0.0 { (*power / norm).sqrt() } else { 0.0 };
        (electric.re, electric.im) = (electric.re * scale, electric.im * scale);
    }
    (power, electric)
}

#[cfg(test)]
mod tests;
