//! From leaves to light: what each leaf sees, through a filter as wide as its share of the pixel.

use super::pixel::{Pixel, Pulses};
use super::studio::{Studio, Surroundings};
use crate::scene::CameraRay;
use crate::trace::{Leaf, Outcome};
use glam::{DQuat, DVec3};

/// Speed of light, cm/ns.
const SPEED_OF_LIGHT: f64 = 29.979_245_8;

/// One traced camera ray.
#[derive(Clone, Debug)]
pub(super) struct Traced<const N: usize> {
    pub ray: CameraRay,
    pub leaves: Vec<Leaf<N>>,
    pub outcome: Outcome<N>,
}

impl<const N: usize> Default for Traced<N> {
    fn default() -> Self {
        let ray = CameraRay { origin: DVec3::ZERO, direction: DVec3::X };
        Self { ray, leaves: Vec::new(), outcome: Outcome::default() }
    }
}

/// What each launched polarization counts for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Detection<const N: usize> {
    /// Weights of the launched polarizations in what the camera with its polarizer sees.
    pub weights: [f64; N],
    /// Whether the first two launched polarizations are horizontal and vertical, with an image of
    /// their own each.
    pub separate: bool,
}

impl<const N: usize> Detection<N> {
    fn detected(&self, power: &[f64; N]) -> f64 {
        self.weights.iter().zip(power).map(|(weight, power)| weight * power).sum()
    }
}

/// Adds to a pixel what one camera ray sees. `across` and `down` are its neighbours one pixel away
/// along the picture's axes; `spacing` is the spacing of samples in pixels.
pub(super) fn expose<const N: usize>(
    studio: &Studio<'_>,
    detection: &Detection<N>,
    [here, across, down]: [&Traced<N>; 3],
    spacing: f64,
    pixel: &mut Pixel,
    pulses: &mut Pulses,
) {
    pulses.clear();
    pixel.absorbed += detection.detected(&here.outcome.absorbed);
    pixel.pruned += detection.detected(&here.outcome.pruned);
    for leaf in &here.leaves {
        let power = detection.detected(&leaf.power);
        let neighbours = [across, down].map(|neighbour| neighbouring_leaf(here, leaf, neighbour));
        let light = match studio.screen.hit(leaf.position, leaf.direction) {
            Some(distance) => {
                pixel.delivered += power;
                let time = (leaf.optical_path + distance) / SPEED_OF_LIGHT;
                pulses.push((time, power));
                photograph_light(studio, leaf, distance, neighbours, spacing)
            }
            None => {
                pixel.escaped += power;
                surroundings_light(studio, leaf, neighbours, spacing)
            }
        };
        for i in 0..3 {
            pixel.image[i] += power * light[i];
        }
        if detection.separate {
            for i in 0..3 {
                pixel.horizontal[i] += leaf.power[0] * light[i];
                pixel.vertical[i] += leaf.power[1] * light[i];
            }
        }
    }
    let empty = studio
        .screen
        .hit(here.ray.origin, here.ray.direction)
        .map(|distance| distance / SPEED_OF_LIGHT);
    pixel.add_pulses(pulses, empty);
}

/// A straight line in air: the end of a branch.
#[derive(Clone, Copy, Debug)]
struct Line {
    origin: DVec3,
    direction: DVec3,
}

/// The leaf of a neighbouring camera ray that has taken the same way. Where there is none (at the
/// edge of a device), the leaf is moved as its camera ray is: as if it came straight from a camera
/// that stands and looks where the leaf seems to come from. Both depend on the leaving ray alone,
/// never on the path inside a device.
fn neighbouring_leaf<const N: usize>(
    here: &Traced<N>,
    leaf: &Leaf<N>,
    neighbour: &Traced<N>,
) -> Line {
    if let Some(twin) = neighbour.leaves.iter().find(|twin| twin.path == leaf.path) {
        return Line { origin: twin.position, direction: twin.direction };
    }
    let turn = DQuat::from_rotation_arc(here.ray.direction, leaf.direction);
    let eye = leaf.position - leaf.direction * leaf.position.distance(here.ray.origin);
    Line {
        origin: eye + turn * (neighbour.ray.origin - here.ray.origin),
        direction: turn * neighbour.ray.direction,
    }
}

fn photograph_light<const N: usize>(
    studio: &Studio<'_>,
    leaf: &Leaf<N>,
    distance: f64,
    neighbours: [Line; 2],
    spacing: f64,
) -> [f64; 3] {
    let screen = &studio.screen;
    let place = |line: &Line, distance: f64| {
        let point = line.origin + line.direction * distance;
        screen.image_position(point, leaf.direction)
    };
    let here = place(&Line { origin: leaf.position, direction: leaf.direction }, distance);
    // A neighbour that runs along the plane or away from it meets it nowhere: a patch without size
    // does no harm.
    let steps = neighbours.map(|line| {
        let t = (screen.x - line.origin.x) / line.direction.x;
        let there = if t.is_finite() { place(&line, t) } else { here };
        [(there[0] - here[0]) * spacing, (there[1] - here[1]) * spacing]
    });
    studio.image.sample(here, steps[0], steps[1]).map(f64::from)
}

fn surroundings_light<const N: usize>(
    studio: &Studio<'_>,
    leaf: &Leaf<N>,
    neighbours: [Line; 2],
    spacing: f64,
) -> [f64; 3] {
    match &studio.surroundings {
        Surroundings::Color(color) => *color,
        Surroundings::Image(image) => {
            let steps = neighbours.map(|line| (line.direction - leaf.direction) * spacing);
            image.sample(leaf.direction, steps[0], steps[1]).map(f64::from)
        }
    }
}
