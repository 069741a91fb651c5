//! From leaves to light: what each leaf sees, through a filter as wide as its share of the pixel.

use super::detection::Detection;
use super::flight::Arrival;
use super::interference::Interference;
use super::pixel::{Pixel, Pulses};
use super::prepared_scene::{PreparedScene, Surroundings};
use crate::scene::CameraRay;
use crate::trace::{FirstFace, Leaf, Outcome};
use glam::{DQuat, DVec3};
use optics::wave::{SPEED_OF_LIGHT, arriving_stokes, stokes_of_coherency};

/// One traced camera ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Traced<'t, const N: usize> {
    pub ray: CameraRay,
    pub leaves: &'t [Leaf<N>],
    pub outcome: &'t Outcome<N>,
    /// The first surface met, where it is asked for and there is one.
    pub first_face: Option<FirstFace<N>>,
}

/// Memory to work in, kept from ray to ray.
#[derive(Debug, Default)]
pub(super) struct Working {
    pulses: Pulses,
    /// The same, with what each takes as a pulse.
    group_pulses: Pulses,
    pub interference: Interference,
    /// What arrives, where that is looked at.
    pub arrivals: Vec<Arrival>,
    /// What a LIDAR gets back: paths (cm) and powers.
    returns: Vec<(f64, f64)>,
}

/// Adds to a pixel what one camera ray sees. `across` and `down` are its neighbours one pixel away
/// along the picture's axes; `spacing` is the spacing of samples in pixels. `COHERENT` is whether
/// leaves may interfere in the scene: what that takes costs nothing elsewhere.
pub(super) fn expose<const N: usize, const COHERENT: bool>(
    prepared: &PreparedScene<'_>,
    detection: &Detection<N>,
    [here, across, down]: [&Traced<'_, N>; 3],
    spacing: f64,
    pixel: &mut Pixel,
    Working { pulses, group_pulses, interference, arrivals, returns }: &mut Working,
) {
    pulses.clear();
    group_pulses.clear();
    returns.clear();
    let [pruned, absorbed] =
        [here.outcome.pruned, here.outcome.absorbed].map(|power| detection.detected(&power));
    if COHERENT {
        let gone = [pruned, absorbed];
        interference.find(prepared, detection, here.leaves, here.ray.origin, gone);
        pixel.absorbed -= interference.added;
    }
    pixel.absorbed += absorbed;
    pixel.pruned += pruned;
    for (number, leaf) in here.leaves.iter().enumerate() {
        let power = detection.detected(&leaf.power);
        let screen = leaf.distance_to(&prepared.screen);
        let arriving = if COHERENT { power * interference.gain(number) } else { power };
        match (leaf.body(), screen) {
            (Some(_), _) => pixel.absorbed += arriving,
            (None, Some(distance)) => {
                pixel.delivered += arriving;
                if detection.times {
                    pulses.push((time_of_flight(leaf, distance), arriving));
                }
                if detection.group_delays {
                    group_pulses.push((group_delay(leaf, distance), arriving));
                }
            }
            (None, None) => pixel.escaped += arriving,
        }
        if detection.depths && (leaf.body().is_some() || screen.is_some()) {
            let path = leaf.group_path.unwrap_or(f64::NAN) + screen.unwrap_or(0.0);
            returns.push((path, arriving));
        }
        let beside = |alone| {
            [across, down].map(|neighbour| Neighbour { here, number, leaf, neighbour, alone })
        };
        let among_all = beside(None);
        let light = light(prepared, leaf, screen, &among_all, spacing);
        if COHERENT {
            interference.remember(light);
        }
        add(&mut pixel.image, power, light);
        if let Some(looked) = &detection.arrivals {
            let light = light.map(|light| power * light);
            arrivals.push(Arrival::of(looked, leaf, (&prepared.screen, screen), power, light));
        }
        if detection.separate {
            for (i, sum) in [&mut pixel.horizontal, &mut pixel.vertical].into_iter().enumerate() {
                let is_in = |leaf: &Leaf<N>| leaf.survives_alone[i] || !detection.alone;
                if is_in(leaf) {
                    let same = among_all.iter().all(|n| n.twin().is_none_or(is_in));
                    let light = if same {
                        light
                    } else {
                        self::light(prepared, leaf, screen, &beside(Some(i)), spacing)
                    };
                    add(sum, leaf.power[i], light);
                }
            }
        }
        if detection.stokes {
            let stokes = arriving_stokes(leaf.electric[0], leaf.electric[1]);
            for (sum, stokes) in pixel.stokes.iter_mut().zip(stokes) {
                add(sum, stokes, light);
            }
        }
    }
    if COHERENT {
        interfere(detection, here.leaves, interference, pixel);
    }
    if let Some(face) = &here.first_face {
        pixel.surfaces_met += 1.0;
        pixel.reflected += detection.detected(&face.reflected);
        pixel.ordinary += detection.detected(&face.ordinary);
        pixel.extraordinary += detection.detected(&face.extraordinary);
    }
    if detection.times {
        let empty = empty_time_of_flight(prepared, &here.ray);
        pixel.times.add(pulses, empty);
        pixel.group_delays.add(group_pulses, empty);
    }
    if detection.depths {
        pixel.depths.add(returns, prepared.limits.tolerance);
    }
}

/// What a leaf sees something of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// The photograph.
    Photograph,
    /// The opaque body of that number among the devices.
    Body(u16),
    /// What is around.
    Surroundings,
}

/// What a leaf sees something of, and where: a place (u, v) on the photograph, a point of a body's surface, or a direction.
pub(super) fn place<const N: usize>(prepared: &PreparedScene<'_>, leaf: &Leaf<N>) -> (Look, DVec3) {
    match (leaf.body(), leaf.distance_to(&prepared.screen)) {
        (Some(body), _) => (Look::Body(body), leaf.position),
        (None, Some(distance)) => {
            let place = prepared.screen.image_position(leaf.direction);
            let [u, v] = place(leaf.position + leaf.direction * distance);
            (Look::Photograph, DVec3::new(u, v, 0.0))
        }
        (None, None) => (Look::Surroundings, leaf.direction),
    }
}

/// What the [`place`] where a leaf of a ray looks changes by from a pixel to the next, across the picture and down, given
/// the ray and those across and down.
pub(super) fn steps<const N: usize>(
    prepared: &PreparedScene<'_>,
    [here, across, down]: [&Traced<'_, N>; 3],
    number: usize,
    (look, at): (Look, DVec3),
) -> [DVec3; 2] {
    let leaf = &here.leaves[number];
    let beside =
        [across, down].map(|neighbour| Neighbour { here, number, leaf, neighbour, alone: None });
    let lines =
        || beside.each_ref().map(|beside| beside.twin_line().unwrap_or_else(|| beside.moved()));
    match look {
        Look::Body(body) => {
            let normal = prepared.body_surface(body).and_then(|body| body.normal(leaf.position));
            normal.map_or([DVec3::ZERO; 2], |normal| {
                lines().map(|line| step_on_plane(line, leaf.position, normal))
            })
        }
        Look::Photograph => {
            let screen = &prepared.screen;
            let place = screen.image_position(leaf.direction);
            let on_screen = |line: &Line| {
                let t = screen.distance_along(line.origin, line.direction);
                t.is_finite().then(|| place(line.origin + line.direction * t))
            };
            footprint(on_screen, [at.x, at.y], &beside).map(|[u, v]| DVec3::new(u, v, 0.0))
        }
        Look::Surroundings => match prepared.surroundings {
            Surroundings::Color(_) => [DVec3::ZERO; 2],
            Surroundings::Image(_) => lines().map(|line| line.direction - leaf.direction),
        },
    }
}

/// The light that is seen there, through a filter as wide as these steps, and drawn out further by a `spread`.
pub(super) fn seen(
    prepared: &PreparedScene<'_>,
    look: Look,
    at: DVec3,
    steps: [DVec3; 2],
    spread: DVec3,
) -> [f64; 3] {
    let both = || drawn_out(steps, spread);
    match look {
        Look::Photograph => {
            let steps = [steps[0], steps[1], spread].map(|step| [step.x, step.y]);
            prepared.photograph_light([at.x, at.y], steps)
        }
        Look::Body(body) => {
            let surface = prepared.body_surface(body);
            surface.map_or([0.0; 3], |surface| surface.light(at, |_| both()))
        }
        Look::Surroundings => prepared.surroundings.light(at, both),
    }
}

/// The two steps of an ellipse drawn out in a direction: its second moments are those of both.
fn drawn_out([across, down]: [DVec3; 2], spread: DVec3) -> [DVec3; 2] {
    let scale = across.length_squared().max(down.length_squared());
    if spread.length_squared() <= 1e-6 * scale {
        return [across, down];
    }
    // Axes of the plane in which all three are: along the spread, and across it.
    let along = spread.normalize_or_zero();
    let rest = [across, down].map(|step| step - along * along.dot(step));
    let longest =
        if rest[0].length_squared() > rest[1].length_squared() { rest[0] } else { rest[1] };
    let beside = longest.normalize_or_zero();
    let all = [across, down, spread].map(|step| [along.dot(step), beside.dot(step)]);
    let moment = |i: usize, j: usize| all.iter().map(|step| step[i] * step[j]).sum::<f64>();
    let (a, b, c) = (moment(0, 0), moment(0, 1), moment(1, 1));
    // The axes of the ellipse: (off + half, b) is along the longer one.
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let off = (half * half + b * b).sqrt();
    let (x, y) = if half >= 0.0 { (off + half, b) } else { (b, off - half) };
    let length = (x * x + y * y).sqrt();
    let (cos, sin) = if length > 0.0 { (x / length, y / length) } else { (1.0, 0.0) };
    let axis = along * cos + beside * sin;
    let other = beside * cos - along * sin;
    [axis * (mean + off).sqrt(), other * (mean - off).max(0.0).sqrt()]
}

/// Adds to the images of a pixel what a leaf of that power brings of some light.
pub(super) fn add_leaf<const N: usize>(
    detection: &Detection<N>,
    leaf: &Leaf<N>,
    power: f64,
    light: [f64; 3],
    pixel: &mut Pixel,
) {
    add(&mut pixel.image, power, light);
    if detection.separate {
        for (i, sum) in [&mut pixel.horizontal, &mut pixel.vertical].into_iter().enumerate() {
            if leaf.survives_alone[i] || !detection.alone {
                add(sum, leaf.power[i], light);
            }
        }
    }
    if detection.stokes {
        let stokes = arriving_stokes(leaf.electric[0], leaf.electric[1]);
        for (sum, stokes) in pixel.stokes.iter_mut().zip(stokes) {
            add(sum, stokes, light);
        }
    }
}

/// From a point to where a line comes to the plane through it; nothing where it does not, for a patch without size
/// does no harm.
fn step_on_plane(line: Line, point: DVec3, normal: DVec3) -> DVec3 {
    let Line { origin, direction } = line;
    let distance = normal.dot(point - origin) / normal.dot(direction);
    let step = origin + direction * distance - point;
    if step.is_finite() { step } else { DVec3::ZERO }
}

/// Adds to a pixel what leaves that interfere see more or less than each alone.
pub(super) fn interfere<const N: usize>(
    detection: &Detection<N>,
    leaves: &[Leaf<N>],
    interference: &Interference,
    pixel: &mut Pixel,
) {
    for pair in &interference.pairs {
        let [one, other] = pair.leaves.map(|leaf| interference.lights[leaf]);
        let light = std::array::from_fn(|color| (one[color] * other[color]).sqrt());
        let power = std::array::from_fn(|i| pair.power(leaves, i));
        add(&mut pixel.image, detection.detected(&power), light);
        if detection.separate {
            for (i, sum) in [&mut pixel.horizontal, &mut pixel.vertical].into_iter().enumerate() {
                let survives = |leaf: &usize| leaves[*leaf].survives_alone[i];
                if !detection.alone || pair.leaves.iter().all(survives) {
                    add(sum, power[i], light);
                }
            }
        }
        if detection.stokes {
            let stokes = stokes_of_coherency([power[0], power[1]], pair.coherency(leaves));
            for (sum, stokes) in pixel.stokes.iter_mut().zip(stokes) {
                add(sum, stokes, light);
            }
        }
    }
}

/// Adds to the pixels of a 2 x 2 block what they see past every device, where all its rays end on
/// the photograph or none does; whether that is so. The same as [`expose`] with those rays as leaves,
/// but for what is worked out once for the block. Where it is looked at when light arrives, `arrive` gets
/// that with the number of the pixel.
pub(super) fn expose_unhindered<const N: usize>(
    prepared: &PreparedScene<'_>,
    detection: &Detection<N>,
    rays: &[CameraRay; 4],
    spacing: f64,
    pixels: &mut [Pixel; 4],
    mut arrive: impl FnMut(usize, Arrival),
) -> bool {
    let screen = &prepared.screen;
    let (mut places, mut points) = ([[0.0; 2]; 4], [None; 4]);
    let mut on_screen = 0;
    for (i, ray) in rays.iter().enumerate() {
        if let Some(distance) = screen.hit(ray.origin, ray.direction, 0.0) {
            let point = ray.origin + ray.direction * distance;
            places[i] = screen.image_position(ray.direction)(point);
            points[i] = Some((point, distance));
            on_screen += 1;
        }
    }
    if on_screen % rays.len() != 0 {
        return false;
    }
    let power = detection.detected(&[1.0; N]);
    for (i, pixel) in pixels.iter_mut().enumerate() {
        let beside = [i ^ 1, i ^ 2];
        let light = if on_screen > 0 {
            let [u, v] = places[i];
            let steps =
                beside.map(|j| [(places[j][0] - u) * spacing, (places[j][1] - v) * spacing]);
            pixel.delivered += power;
            if detection.times {
                let time = points[i].map(|(_, distance)| distance / SPEED_OF_LIGHT);
                pixel.times.add(&[(time.unwrap_or(f64::NAN), power)], time);
            }
            prepared.photograph_light(places[i], steps)
        } else {
            pixel.escaped += power;
            let direction = rays[i].direction;
            let steps = || beside.map(|j| (rays[j].direction - direction) * spacing);
            prepared.surroundings.light(direction, steps)
        };
        add(&mut pixel.image, power, light);
        if let Some(arrivals) = &detection.arrivals {
            let light = light.map(|light| power * light);
            arrive(i, arrivals.unhindered(points[i], screen, power, light));
        }
        if detection.separate {
            add(&mut pixel.horizontal, 1.0, light);
            add(&mut pixel.vertical, 1.0, light);
        }
    }
    true
}

/// Time of flight of a leaf that ends on the photograph, `distance` (cm) on, in ns.
pub(super) fn time_of_flight<const N: usize>(leaf: &Leaf<N>, distance: f64) -> f64 {
    (leaf.delay_path + distance) / SPEED_OF_LIGHT
}

/// What a pulse takes on a leaf that ends on the photograph, `distance` (cm) on, in ns; NaN where
/// it is not known.
pub(super) fn group_delay<const N: usize>(leaf: &Leaf<N>, distance: f64) -> f64 {
    (leaf.group_path.unwrap_or(f64::NAN) + distance) / SPEED_OF_LIGHT
}

/// Time of flight (ns) of a camera ray in the empty scene, if it meets the photograph.
pub(super) fn empty_time_of_flight(prepared: &PreparedScene<'_>, ray: &CameraRay) -> Option<f64> {
    prepared.screen.hit(ray.origin, ray.direction, 0.0).map(|distance| distance / SPEED_OF_LIGHT)
}

fn add(sum: &mut [f64; 3], power: f64, light: [f64; 3]) {
    for (sum, light) in sum.iter_mut().zip(light) {
        *sum += power * light;
    }
}

/// A straight line in air: the end of a branch.
#[derive(Clone, Copy, Debug)]
struct Line {
    origin: DVec3,
    direction: DVec3,
}

/// A leaf and a neighbouring camera ray one pixel away.
#[derive(Clone, Copy, Debug)]
struct Neighbour<'a, const N: usize> {
    here: &'a Traced<'a, N>,
    /// The leaf's among those of its ray.
    number: usize,
    leaf: &'a Leaf<N>,
    neighbour: &'a Traced<'a, N>,
    /// The polarization in whose tree alone to look, else in that of all.
    alone: Option<usize>,
}

impl<const N: usize> Neighbour<'_, N> {
    /// The leaf moved as its camera ray is: as if it came straight from a camera that stands and
    /// looks where the leaf seems to come from.
    fn moved(&self) -> Line {
        let (here, leaf, there) = (&self.here.ray, self.leaf, &self.neighbour.ray);
        let turn = DQuat::from_rotation_arc(here.direction, leaf.direction);
        let eye = leaf.position - leaf.direction * leaf.position.distance(here.origin);
        Line {
            origin: eye + turn * (there.origin - here.origin),
            direction: turn * there.direction,
        }
    }

    /// The leaf of the neighbouring camera ray that has taken the same way, if there is one.
    fn twin(&self) -> Option<&Leaf<N>> {
        let is_in = |leaf: &&Leaf<N>| {
            self.alone.is_none_or(|polarization| leaf.survives_alone[polarization])
        };
        let is_twin = |leaf: &&Leaf<N>| leaf.path == self.leaf.path && is_in(leaf);
        let leaves = self.neighbour.leaves;
        // As a rule it is in the same place.
        let twin = leaves.get(self.number).filter(is_twin);
        twin.or_else(|| leaves.iter().find(is_twin)).or_else(|| {
            // Light that enters by another face of a cloak may leave as if nothing had happened.
            let moved = self.moved();
            let there =
                moved.origin + moved.direction * self.leaf.position.distance(self.here.ray.origin);
            let off = |other: &Leaf<N>| {
                (other.direction - moved.direction).length_squared() * AFAR * AFAR
                    + (other.position - there).length_squared()
            };
            leaves
                .iter()
                .filter(is_in)
                .filter(|other| is_close(&moved, self.leaf, other))
                .min_by(|one, other| off(one).total_cmp(&off(other)))
        })
    }

    /// The line of the twin, if there is one.
    fn twin_line(&self) -> Option<Line> {
        self.twin().map(|twin| Line { origin: twin.position, direction: twin.direction })
    }
}

/// How far on two lines are compared, cm.
const AFAR: f64 = 100.0;

/// Whether a neighbour's leaf goes on much like this one moved by a pixel.
fn is_close<const N: usize>(moved: &Line, leaf: &Leaf<N>, other: &Leaf<N>) -> bool {
    let step = (moved.direction - leaf.direction).length();
    (other.direction - moved.direction).length() <= 0.5 * step + 1e-12
}

/// The change of (u, v) on the photograph from here to one pixel away along either axis, from the
/// leaving rays alone: never from the path inside a device.
fn footprint<const N: usize>(
    place: impl Fn(&Line) -> Option<[f64; 2]>,
    here: [f64; 2],
    beside: &[Neighbour<'_, N>; 2],
) -> [[f64; 2]; 2] {
    let step = |line: Line| match place(&line) {
        Some(there) => [there[0] - here[0], there[1] - here[1]],
        // It meets the plane nowhere; a patch without size does no harm.
        None => [0.0; 2],
    };
    let size = |step: [f64; 2]| step[0].hypot(step[1]);
    let twins = [0, 1].map(|i| beside[i].twin_line().map(step));
    std::array::from_fn(|i| {
        twins[i].unwrap_or_else(|| {
            // At the edge of a device there is no twin: the other axis tells how much the picture
            // is stretched against the moved leaf.
            let stretch =
                twins[1 - i].map_or(1.0, |twin| size(twin) / size(step(beside[1 - i].moved())));
            let stretch = if stretch.is_finite() { stretch } else { 1.0 };
            step(beside[i].moved()).map(|change| change * stretch)
        })
    })
}

/// The light of a leaf, which meets the photograph at the distance `screen` (cm), if it does.
fn light<const N: usize>(
    prepared: &PreparedScene<'_>,
    leaf: &Leaf<N>,
    screen: Option<f64>,
    beside: &[Neighbour<'_, N>; 2],
    spacing: f64,
) -> [f64; 3] {
    let lines =
        || beside.each_ref().map(|beside| beside.twin_line().unwrap_or_else(|| beside.moved()));
    match (leaf.body(), screen) {
        (Some(body), _) => {
            let Some(surface) = prepared.body_surface(body) else { return [0.0; 3] };
            surface.light(leaf.position, |normal| {
                lines().map(|line| step_on_plane(line, leaf.position, normal) * spacing)
            })
        }
        (None, Some(distance)) => {
            let screen = &prepared.screen;
            let at = screen.image_position(leaf.direction);
            let here = at(leaf.position + leaf.direction * distance);
            let place = |line: &Line| {
                let t = screen.distance_along(line.origin, line.direction);
                t.is_finite().then(|| at(line.origin + line.direction * t))
            };
            let steps = footprint(place, here, beside);
            prepared.photograph_light(here, steps.map(|step| step.map(|change| change * spacing)))
        }
        (None, None) => prepared.surroundings.light(leaf.direction, || {
            lines().map(|line| (line.direction - leaf.direction) * spacing)
        }),
    }
}
