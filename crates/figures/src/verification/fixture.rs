//! Scenes of the paper, made and measured.

use super::finding::{list, percent};
use super::{Result, VerificationError};
use cloakroom::assembly::{Assembly, Placed};
use cloakroom::device::FactValue;
use cloakroom::measure::{DEFAULT_PIXELS_PER_DEGREE, PixelMask, Survey, View, flip, survey};
use cloakroom::output::Picture;
use cloakroom::render::{
    ChannelSet, Images, PreparedScene, RenderError, Supervision, assembly, pulses, render,
};
use cloakroom::scene::Scene;
use cloakroom::scene_file;
use cloakroom::trace::{Launch, Leaf, Limits, PathSegment, Stopped, Tracer};
use glam::DVec3;
use optics::geometry::Pose;
use optics::wave::transverse_basis;
use rayon::prelude::*;
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Where the camera stands, cm: our assumption, for the paper does not say.
pub(super) const CAMERA: DVec3 = DVec3::new(-100.0, 0.0, 0.0);

/// Half the horizontal field of view, degrees: our assumption, too.
pub(super) const HALF_VIEW: f64 = 20.0;

/// A wider one, in which the paper's numbers about times come out.
pub(super) const WIDE_HALF_VIEW: f64 = 32.5;

/// Width of the photograph for the wider view, which it must fill, cm.
const WIDE_PHOTOGRAPH: f64 = 200.0;

/// Width and height of the pictures in pixels.
const RESOLUTION: [usize; 2] = [160, 120];

/// How near to each other segments of one path end and start, in place and in optical path, cm: a
/// graded way is known to the tolerance with which it is solved.
const JOINED: f64 = 1e-5;

/// Every how manieth pixel is asked for its pulses.
const PULSE_STEP: usize = 23;

/// By how much devices are turned in the figures, degrees.
pub(super) const TURNS: [i32; 4] = [0, 5, 10, 20];

/// The square cloak of a design.
pub(super) fn square(material: &str) -> String {
    format!("[[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}\"\n")
}

/// Designs (i), (ii) and (iii).
pub(super) const DESIGNS: [&str; 3] =
    ["positive-uniaxial", "negative-uniaxial", "impedance-matched"];

/// A device, turned by degrees about its axis.
pub(super) fn turned_by(device: &str, rotation: i32) -> String {
    format!("{device}rotation = {rotation}\n")
}

/// A number in our view in words, and that in the wider view in brackets.
pub(super) fn in_both_views([near, wide]: [f64; 2], word: impl Fn(f64) -> String) -> String {
    format!("{} (half view {WIDE_HALF_VIEW}: {})", word(near), word(wide))
}

/// Design (iv).
pub(super) const GAUSSIAN: &str = "[[device]]\nkind = \"double-gaussian-cloak\"\n";

/// A scene of the paper: a device (or none, empty) through a polarizer, seen at half an angle.
#[derive(Clone, Copy)]
struct Setting<'s> {
    device: &'s str,
    polarizer: &'s str,
    half_view: f64,
}

impl Setting<'_> {
    fn scene(self) -> Result<Scene> {
        let Self { device, polarizer, half_view } = self;
        let [width, height] = RESOLUTION;
        let mut text = format!(
            "[camera]\nresolution = [{width}, {height}]\nsamples = 1\npolarizer = \"{polarizer}\"\n\
             field_of_view = {}\n\
             [picture]\nchannels = [\"first_face_reflectance\", \"extraordinary_share\"]\n{device}",
            2.0 * half_view
        );
        if half_view > HALF_VIEW {
            text += &format!("[photograph]\nwidth = {WIDE_PHOTOGRAPH}\n");
        }
        let loaded = scene_file::parse(&text, "verification", Path::new(""), &[]);
        Ok(loaded.map_err(Box::new)?.scene)
    }
}

/// Makes and measures; stops when it is asked to.
pub(super) struct Fixture<'s> {
    stop: &'s AtomicBool,
    /// Those of the scenes so far.
    images: RefCell<Images>,
    /// The part of the view that the metal of every design hides.
    region: OnceCell<PixelMask>,
    /// What has been shown, by its setting.
    shown: RefCell<HashMap<String, Rc<Shown>>>,
}

/// A device as the camera sees it.
pub(super) struct Shown {
    picture: Picture,
    pub view: View,
}

/// How well a device does, over the region.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fidelity {
    /// The shares of the power that are in place, strictly and widely.
    pub in_place: [f64; 2],
    /// Mean FLIP against what should be seen.
    pub flip: f64,
}

impl Fidelity {
    /// In words.
    pub fn words(self) -> String {
        in_words(&[self])
    }
}

/// Fidelities in words.
pub(super) fn in_words(seen: &[Fidelity]) -> String {
    let [strictly, widely] =
        [0, 1].map(|within| list(seen, |seen| percent(seen.in_place[within], 1)));
    let flips = list(seen, |seen| format!("{:.2}", seen.flip));
    format!("{strictly} in place ({widely} widely), FLIP {flips}")
}

/// Whether at least a share is in place each time, and more than with the bare metal: strictly, and
/// widely.
pub(super) fn are(seen: &[Fidelity], least: f64, bare: &[Fidelity]) -> [bool; 2] {
    [0, 1].map(|within| {
        let is = |seen: &Fidelity, bare: &Fidelity| {
            seen.in_place[within] >= least && seen.in_place[within] > bare.in_place[within]
        };
        seen.iter().zip(bare).all(|(seen, bare)| is(seen, bare))
    })
}

/// The strongest way of a camera ray's unpolarized light.
#[derive(Clone, Copy, Debug)]
pub(super) struct MainPath {
    /// The share of the power that does not take it, of horizontal or vertical light, whichever is
    /// more.
    pub off: f64,
    /// The share of the power with which horizontal and vertical light part, over all paths.
    pub between_polarizations: f64,
    /// The share of the power that an outer face of the device has reflected, from inside, on its
    /// way; of horizontal or vertical light, whichever is more.
    pub reflected_at_a_face: f64,
}

impl Shown {
    /// The numbers of a channel that are there, one at least.
    pub fn numbers(&self, channel: &str) -> Result<Vec<f64>> {
        let found = self.picture.channel(channel);
        let missing = |what: &str| VerificationError::Missing(format!("{what} {channel}"));
        let samples = &found.ok_or_else(|| missing("the channel"))?.samples;
        let all = (0..samples.len()).map(|i| samples.get(i));
        let numbers: Vec<f64> = all.filter(|number| number.is_finite()).collect();
        if numbers.is_empty() {
            return Err(missing("a number in"));
        }
        Ok(numbers)
    }

    /// The mean and the largest size of the numbers of a channel that are there.
    pub fn statistics(&self, channel: &str) -> Result<[f64; 2]> {
        let numbers = self.numbers(channel)?;
        let largest = numbers.iter().copied().map(f64::abs).fold(0.0, f64::max);
        Ok([numbers.iter().sum::<f64>() / numbers.len() as f64, largest])
    }
}

impl<'s> Fixture<'s> {
    pub fn new(stop: &'s AtomicBool) -> Self {
        let (images, shown) = (RefCell::default(), RefCell::default());
        Self { stop, images, region: OnceCell::new(), shown }
    }

    fn prepared<'a>(&self, scene: &'a Scene) -> Result<PreparedScene<'a>> {
        Ok(PreparedScene::with_images(scene, &mut self.images.borrow_mut())?)
    }

    fn supervision(&self) -> Supervision<'_> {
        Supervision { rows_done: &|_| {}, stop: self.stop }
    }

    /// The picture of a device.
    pub fn show(&self, device: &str, polarizer: &str) -> Result<Rc<Shown>> {
        self.show_at(HALF_VIEW, device, polarizer)
    }

    /// The same, seen at half an angle.
    pub fn show_at(&self, half_view: f64, device: &str, polarizer: &str) -> Result<Rc<Shown>> {
        let key = format!("{half_view} {polarizer} {device}");
        if let Some(shown) = self.shown.borrow().get(&key) {
            return Ok(Rc::clone(shown));
        }
        let scene = Setting { device, polarizer, half_view }.scene()?;
        let prepared = self.prepared(&scene)?;
        let picture = render(&prepared, ChannelSet::Everything, &self.supervision())?.picture;
        let shown = Rc::new(Shown { view: View::of(&picture)?, picture });
        self.shown.borrow_mut().insert(key, Rc::clone(&shown));
        Ok(shown)
    }

    /// The mean and the largest share of the light that the first face of a device reflects, seen
    /// at half an angle.
    pub fn reflection(&self, half_view: f64, device: &str, polarizer: &str) -> Result<[f64; 2]> {
        self.show_at(half_view, device, polarizer)?.statistics("first_face_reflectance")
    }

    /// Where the rays of a device's picture go, against those of what should be seen.
    fn survey(&self, device: &str, ideal: &str, polarizer: &str) -> Result<Survey> {
        let setting = Setting { device, polarizer, half_view: HALF_VIEW };
        let (scene, ideal) = (setting.scene()?, Setting { device: ideal, ..setting }.scene()?);
        let (prepared, ideal) = (self.prepared(&scene)?, self.prepared(&ideal)?);
        Ok(survey(&prepared, &ideal, &self.supervision())?)
    }

    /// The one region over which devices are judged: the part of the view where the metal of every
    /// design, bare and along the axis, leaves no light in place.
    pub fn region(&self) -> Result<&PixelMask> {
        if self.region.get().is_none() {
            let metals = [square(DESIGNS[2]), GAUSSIAN.to_owned()];
            let mut hidden = vec![true; RESOLUTION[0] * RESOLUTION[1]];
            for metal in metals {
                let shares = self.in_place(&format!("{metal}show = \"bare\"\n"), "", "none")?;
                hidden.iter_mut().zip(shares).for_each(|(is, [_, widely])| *is &= widely == 0.0);
            }
            let mask = PixelMask::new(RESOLUTION[0], hidden)?;
            return Ok(self.region.get_or_init(|| mask));
        }
        Ok(self.region.get().ok_or("the region")?)
    }

    /// The pixels of the region that are seen at angles to the left or right, degrees.
    pub fn pixels_aside(&self, angles: Range<f64>) -> Result<Vec<usize>> {
        let half = RESOLUTION[0] as f64 / 2.0;
        let aside = |index: usize| {
            let right = (index % RESOLUTION[0]) as f64 + 0.5 - half;
            (right / half * HALF_VIEW.to_radians().tan()).atan().to_degrees().abs()
        };
        Ok(self.region()?.indices().filter(|index| angles.contains(&aside(*index))).collect())
    }

    /// The shares of each pixel's power that are in place, against what should be seen.
    pub fn in_place(&self, device: &str, ideal: &str, polarizer: &str) -> Result<Vec<[f64; 2]>> {
        Ok(self.survey(device, ideal, polarizer)?.in_place)
    }

    /// How well a device shows what should be seen.
    pub fn fidelity(&self, device: &str, ideal: &str, polarizer: &str) -> Result<Fidelity> {
        let region = self.region()?;
        let in_place = self.in_place(device, ideal, polarizer)?;
        let [shown, ideal] = [device, ideal].map(|device| self.show(device, polarizer));
        let differences = flip(&ideal?.view, &shown?.view, DEFAULT_PIXELS_PER_DEGREE);
        Ok(Fidelity {
            in_place: [0, 1].map(|within| region.mean(|i| in_place[i][within])),
            flip: region.mean(|i| differences[i]),
        })
    }

    /// Root mean square displacement at the photograph over the silhouette of a device, cm.
    pub fn displacement(&self, device: &str, polarizer: &str) -> Result<f64> {
        let rms = self.survey(device, "", polarizer)?.displacement_rms_cm;
        Ok(rms.ok_or("light from the photograph")?)
    }

    /// The main paths of camera rays, one for 2 x 2 pixels, through a device, a box, that is alone
    /// in its scene.
    pub fn main_paths(&self, half_view: f64, device: &str) -> Result<Vec<MainPath>> {
        let scene = Setting { device, polarizer: "none", half_view }.scene()?;
        let prepared = self.prepared(&scene)?;
        let assembly = &prepared.assembly;
        let [width, height] = RESOLUTION;
        let bounds = |placed: &Placed| placed.structure.hull.bounds(&Pose::IDENTITY);
        let [low, high] = assembly.devices().first().and_then(bounds).ok_or("a device")?;
        let is_on_the_box = |at: DVec3| {
            let nearest = (at - low).abs().min((at - high).abs());
            nearest.x < 1e-6 || nearest.y < 1e-6
        };
        let row = |row: usize| {
            if self.stop.load(Ordering::Relaxed) {
                return Err(RenderError::from(Stopped).into());
            }
            let mut tracer = Tracer::new(assembly, prepared.limits).watched(Vec::new());
            let paths = (0..width).step_by(2).map(|column| {
                let ray = scene.camera.ray(column as f64 + 1.0, row as f64 + 1.0);
                tracer.recorder().clear();
                let leaves = tracer.trace(&launch(ray.origin, ray.direction)).0.to_vec();
                let unpolarized = |leaf: &Leaf<2>| leaf.power[0] + leaf.power[1];
                let main = leaves.iter().max_by(|a, b| unpolarized(a).total_cmp(&unpolarized(b)));
                let main = main.ok_or("a leaf")?;
                let parted = leaves.iter().map(|leaf| (leaf.power[0] - leaf.power[1]).abs());
                let segments = tracer.recorder();
                let mut reflected = [0.0; 2];
                for leaf in &leaves {
                    let at = inner_reflections(assembly, segments, leaf);
                    if at.into_iter().any(is_on_the_box) {
                        reflected.iter_mut().zip(leaf.power).for_each(|(sum, power)| *sum += power);
                    }
                }
                Ok(MainPath {
                    between_polarizations: 0.5 * parted.sum::<f64>(),
                    off: main.power.iter().fold(0.0, |off, power| off.max(1.0 - power)),
                    reflected_at_a_face: reflected[0].max(reflected[1]),
                })
            });
            paths.collect::<Result<Vec<MainPath>>>()
        };
        let rows: Result<Vec<_>> = (0..height).into_par_iter().step_by(2).map(row).collect();
        Ok(rows?.concat())
    }

    /// How many distinct main pulses of a device come back along rays through the region: each has
    /// at least a share of the unpolarized power, and they are more than `apart` ns from one
    /// another.
    pub fn pulses(&self, device: &str, share: f64, apart: f64) -> Result<Vec<usize>> {
        let setting = Setting { device, polarizer: "none", half_view: HALF_VIEW };
        let scene = setting.scene()?;
        let prepared = self.prepared(&scene)?;
        let width = RESOLUTION[0];
        let pixels: Vec<usize> = self.region()?.indices().step_by(PULSE_STEP).collect();
        let counted = pixels.into_par_iter().map(|index| {
            let pixel = [index % width, index / width].map(|i| i as u32);
            let list =
                pulses(&prepared, pixel).map_err(|e| VerificationError::Missing(e.to_string()))?;
            let mut last = f64::NEG_INFINITY;
            let strong = list.pulses.iter().filter(|pulse| pulse.power >= share);
            Ok(strong
                .filter(|pulse| {
                    let is_apart = pulse.time_of_flight_ns - last > apart;
                    last = pulse.time_of_flight_ns;
                    is_apart
                })
                .count())
        });
        counted.collect()
    }

    /// The devices of a scene.
    pub fn assembly(&self, device: &str) -> Result<Assembly> {
        let setting = Setting { device, polarizer: "none", half_view: HALF_VIEW };
        Ok(assembly(&setting.scene()?)?)
    }
}

impl From<&str> for VerificationError {
    /// That something is not there.
    fn from(what: &str) -> Self {
        Self::Missing(what.to_owned())
    }
}

/// The strongest leaf of a ray's horizontal (0) or vertical (1) light.
pub(super) fn strongest(leaves: &[Leaf<2>], light: usize) -> Result<Leaf<2>> {
    let strongest = leaves.iter().max_by(|a, b| a.power[light].total_cmp(&b.power[light]));
    Ok(strongest.copied().ok_or("a leaf")?)
}

/// The largest difference of linear light between two views.
pub(super) fn largest_difference(a: &View, b: &View) -> f64 {
    let pairs = a.light.iter().zip(&b.light).flat_map(|(a, b)| a.iter().zip(b));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The numbers of a fact of the device of a scene, by its name.
pub(super) fn facts<const N: usize>(device: &str, name: &str) -> Result<[f64; N]> {
    let scene = Setting { device, polarizer: "none", half_view: HALF_VIEW }.scene()?;
    let mut facts = scene.devices.iter().flat_map(|device| device.facts());
    let numbers = facts.find(|fact| fact.name == name).map(|fact| match fact.value {
        FactValue::Number(number) => vec![number],
        FactValue::Numbers(numbers) => numbers,
    });
    Ok(numbers.and_then(|numbers| numbers.try_into().ok()).ok_or(name)?)
}

/// A fact that is one number.
pub(super) fn fact(device: &str, name: &str) -> Result<f64> {
    facts(device, name).map(|[number]| number)
}

/// Follows single rays through devices, down to a power.
pub(super) fn tracer(assembly: &Assembly, min_power: f64) -> Tracer<'_, 2> {
    Tracer::new(assembly, Limits { min_power, tolerance: 1e-8 })
}

/// The shares of horizontal and vertical light that go on along the ray's own line, as if nothing
/// were there, within 1e-6 degrees and 1e-6 cm.
pub(super) fn undisturbed(tracer: &mut Tracer<'_, 2>, origin: DVec3, direction: DVec3) -> [f64; 2] {
    let direction = direction.normalize();
    let (leaves, _) = tracer.trace(&launch(origin, direction));
    let on = leaves.iter().filter(|leaf| {
        let offset = leaf.position - origin;
        let beside = (offset - direction * offset.dot(direction)).length();
        leaf.direction.distance(direction) <= 1e-6_f64.to_radians() && beside <= 1e-6
    });
    on.fold([0.0; 2], |sum, leaf| [sum[0] + leaf.power[0], sum[1] + leaf.power[1]])
}

/// A ray, horizontal and vertical at once.
pub(super) fn launch(origin: DVec3, direction: DVec3) -> Launch<2> {
    let direction = direction.normalize();
    let (h, v) = transverse_basis(direction, DVec3::Z, DVec3::X);
    Launch { origin, direction, electric: [h.into(), v.into()] }
}

/// Where on the way of a leaf two segments on end lie in one region, which is where it is reflected
/// inside: in the frame of the device.
fn inner_reflections(
    assembly: &Assembly,
    segments: &[PathSegment<2>],
    leaf: &Leaf<2>,
) -> Vec<DVec3> {
    let place = |segment: &PathSegment<2>, at: DVec3| match segment.inside {
        Some((device, _)) => assembly.devices()[usize::from(device)].pose.to_world(at),
        None => at,
    };
    let (mut at, mut path) = (leaf.position, leaf.optical_path);
    let mut later: Option<&PathSegment<2>> = None;
    let mut reflections = Vec::new();
    // Back from the leaf, along what ends where the next segment starts.
    let leads = |segment: &&PathSegment<2>, at: DVec3, path: f64| {
        let end = segment
            .path
            .last()
            .map(|end| (place(segment, end.position), segment.optical_path + end.optical_path));
        end.is_some_and(|(place, sum)| place.distance(at) < JOINED && (sum - path).abs() < JOINED)
            && segment.optical_path < path - JOINED
    };
    while let Some(segment) = segments.iter().find(|segment| leads(segment, at, path)) {
        if segment.inside.is_some() && later.is_some_and(|later| later.inside == segment.inside) {
            reflections.extend(segment.path.last().map(|end| end.position));
        }
        later = Some(segment);
        (at, path) = (place(segment, segment.path[0].position), segment.optical_path);
    }
    reflections
}

/// The strongest leaf of a ray's vertical light, and how often its way is reflected within a
/// region.
pub(super) fn reflected_inside(assembly: &Assembly, ray: &Launch<2>) -> Result<(Leaf<2>, usize)> {
    let mut tracer = tracer(assembly, 1e-6).watched(Vec::new());
    let (leaves, _) = tracer.trace(ray);
    let main = strongest(leaves, 1)?;
    let reflections = inner_reflections(assembly, tracer.recorder(), &main);
    Ok((main, reflections.len()))
}

/// A direction of view: degrees to the right and upwards.
pub(super) fn camera_direction(right: f64, up: f64) -> DVec3 {
    let (right, up) = (right.to_radians(), up.to_radians());
    DVec3::new(right.cos() * up.cos(), up.sin(), right.sin() * up.cos())
}
