//! Scenes of the paper, made and measured.

use super::{Result, VerificationError};
use cloakroom::assembly::Assembly;
use cloakroom::device::FactValue;
use cloakroom::measure::{PixelMask, Survey, View, correlation, survey};
use cloakroom::output::Picture;
use cloakroom::render::{ChannelSet, Images, PreparedScene, Supervision, assembly, render};
use cloakroom::scene::Scene;
use cloakroom::scene_file;
use cloakroom::trace::{Launch, Leaf, Limits, PathSegment, Tracer};
use glam::DVec3;
use optics::wave::transverse_basis;
use std::cell::RefCell;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Where the paper's camera stands.
pub(super) const CAMERA: DVec3 = DVec3::new(-100.0, 0.0, 0.0);

/// Half the horizontal field of view, degrees.
pub(super) const HALF_VIEW: f64 = 20.0;

/// The square cloak of a design.
pub(super) fn square(material: &str) -> String {
    format!("[[device]]\nkind = \"square-cloak\"\nmaterial = \"{material}\"\n")
}

/// Designs (i), (ii) and (iii).
pub(super) const DESIGNS: [&str; 3] =
    ["positive-uniaxial", "negative-uniaxial", "impedance-matched"];

/// Design (iv).
pub(super) const GAUSSIAN: &str = "[[device]]\nkind = \"double-gaussian-cloak\"\n";

/// Makes and measures; stops when it is asked to.
pub(super) struct Fixture<'s> {
    pub stop: &'s AtomicBool,
    /// Those of the scenes so far.
    pub images: RefCell<Images>,
}

/// A device as the paper's camera sees it.
pub(super) struct Shown {
    picture: Picture,
    pub view: View,
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

impl Fixture<'_> {
    /// The paper's scene with a device (or none), through a polarizer.
    fn scene(device: &str, polarizer: &str) -> Result<Scene> {
        let text = format!(
            "[camera]\nresolution = [160, 120]\nsamples = 1\npolarizer = \"{polarizer}\"\n\
             [picture]\nchannels = [\"first_face_reflectance\", \"extraordinary_share\"]\n{device}"
        );
        let loaded = scene_file::parse(&text, "verification", Path::new(""), &[]);
        Ok(loaded.map_err(Box::new)?.scene)
    }

    fn prepared<'a>(&self, scene: &'a Scene) -> Result<PreparedScene<'a>> {
        Ok(PreparedScene::with_images(scene, &mut self.images.borrow_mut())?)
    }

    /// The picture of a device.
    pub fn show(&self, device: &str, polarizer: &str) -> Result<Shown> {
        let scene = Self::scene(device, polarizer)?;
        let prepared = self.prepared(&scene)?;
        let supervision = Supervision { rows_done: &|_| {}, stop: self.stop };
        let picture = render(&prepared, ChannelSet::Everything, &supervision)?.picture;
        Ok(Shown { view: View::of(&picture)?, picture })
    }

    /// The mean and the largest share of the light that the first face of a device reflects.
    pub fn reflection(&self, device: &str, polarizer: &str) -> Result<[f64; 2]> {
        self.show(device, polarizer)?.statistics("first_face_reflectance")
    }

    /// Where the rays of a device's picture go, against those of the empty view.
    fn survey(&self, device: &str, polarizer: &str) -> Result<Survey> {
        let (scene, empty) = (Self::scene(device, polarizer)?, Self::scene("", polarizer)?);
        let (prepared, ideal) = (self.prepared(&scene)?, self.prepared(&empty)?);
        let supervision = Supervision { rows_done: &|_| {}, stop: self.stop };
        Ok(survey(&prepared, &ideal, &supervision)?)
    }

    /// The silhouette of a device.
    pub fn silhouette(&self, device: &str) -> Result<PixelMask> {
        Ok(PixelMask::new(160, self.survey(device, "horizontal")?.silhouette)?)
    }

    /// Root mean square displacement at the photograph, cm.
    pub fn displacement(&self, device: &str, polarizer: &str) -> Result<f64> {
        let rms = self.survey(device, polarizer)?.displacement_rms_cm;
        Ok(rms.ok_or("light from the photograph")?)
    }

    /// The devices of a scene.
    pub fn assembly(&self, device: &str) -> Result<Assembly> {
        Ok(assembly(&Self::scene(device, "none")?)?)
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

/// The mean over red, green and blue of the correlation over a region.
pub(super) fn likeness(a: &View, b: &View, region: &PixelMask) -> Result<f64> {
    let of_colors = a.light.iter().zip(&b.light).map(|(a, b)| correlation(a, b, region));
    Ok(of_colors.sum::<Option<f64>>().ok_or("contrast")? / 3.0)
}

/// The largest difference of linear light between two views.
pub(super) fn largest_difference(a: &View, b: &View) -> f64 {
    let pairs = a.light.iter().zip(&b.light).flat_map(|(a, b)| a.iter().zip(b));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The numbers of a fact of the device of a scene, by its name.
pub(super) fn facts<const N: usize>(device: &str, name: &str) -> Result<[f64; N]> {
    let scene = Fixture::scene(device, "none")?;
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

/// The shares of horizontal and vertical light that go on along the ray's own line, as if nothing were there, within
/// 1e-6 degrees and 1e-6 cm.
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

/// The strongest leaf of a ray's vertical light, and how often its way is reflected within a segment: where two segments on
/// end lie in one. The device must stand in the frame of the scene.
pub(super) fn reflected_inside(assembly: &Assembly, ray: &Launch<2>) -> Result<(Leaf<2>, usize)> {
    let mut tracer = tracer(assembly, 1e-6).watched(Vec::new());
    let (leaves, _) = tracer.trace(ray);
    let main = strongest(leaves, 1)?;
    let segments: &Vec<PathSegment<2>> = tracer.recorder();
    let (mut at, mut path) = (main.position, main.optical_path);
    let mut way = Vec::new();
    // Back from the leaf, along what ends where the next segment starts.
    let ends = |segment: &&PathSegment<2>, at: DVec3, path: f64| {
        let end =
            segment.path.last().map(|end| (end.position, segment.optical_path + end.optical_path));
        end.is_some_and(|(place, sum)| place.distance(at) < 1e-9 && (sum - path).abs() < 1e-9)
            && segment.optical_path < path - 1e-9
    };
    while let Some(segment) = segments.iter().find(|segment| ends(segment, at, path)) {
        way.push(segment.inside);
        (at, path) = (segment.path[0].position, segment.optical_path);
    }
    let reflected = way.windows(2).filter(|pair| pair[0].is_some() && pair[0] == pair[1]);
    Ok((main, reflected.count()))
}

/// A direction of view: degrees to the right and upwards.
pub(super) fn camera_direction(right: f64, up: f64) -> DVec3 {
    let (right, up) = (right.to_radians(), up.to_radians());
    DVec3::new(right.cos() * up.cos(), up.sin(), right.sin() * up.cos())
}
