//! The pulses of one pixel: what a short flash of the photograph looks like there.

use super::detection::Detection;
use super::exposure::{empty_time_of_flight, group_delay, time_of_flight};
use super::interference::Interference;
use super::pixel::Pixel;
use super::{ChannelKind, PreparedScene};
use crate::trace::Tracer;
use glam::DVec3;
use optics::wave::SPEED_OF_LIGHT;
use serde::Serialize;

/// What the camera ray through the middle of a pixel brings back, pulse by pulse: where a short
/// flash of the whole photograph arrives along that ray, how late and how strong.
///
/// Powers are shares of the ray's, as the camera's polarizer weighs them: those of the pulses,
/// `escaped`, `absorbed` and `pruned` add up to 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PulseList {
    /// Column and row of the pixel, from 0 at the top left.
    pub pixel: [u32; 2],
    /// The pulses, the earliest first.
    pub pulses: Vec<Pulse>,
    /// Pulses closer together than this, in ns, are one: the time that light takes for
    /// `trace.tolerance`, to which paths are known.
    pub resolution_ns: f64,
    /// Time of flight of the same camera ray in the empty scene, ns; `None` where that misses the
    /// photograph.
    pub empty_time_of_flight_ns: Option<f64>,
    /// The mean time of flight, weighted by power, ns; `None` without pulses.
    pub mean_time_of_flight_ns: Option<f64>,
    /// Its standard deviation, ns; `None` without pulses.
    pub time_of_flight_spread_ns: Option<f64>,
    /// Share of the power that reaches the photograph: the sum over the pulses.
    pub delivered: f64,
    /// Share of the power that goes to the surroundings.
    pub escaped: f64,
    /// Share of the power absorbed, by media or on opaque bodies.
    pub absorbed: f64,
    /// Share of the power in branches too weak to follow.
    pub pruned: f64,
}

/// One pulse.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pulse {
    /// Time of flight from the photograph to the camera, ns.
    pub time_of_flight_ns: f64,
    /// The same less that of the empty view, ns; `None` where the empty view misses the photograph.
    pub delay_ns: Option<f64>,
    /// What it takes as a pulse, ns, where the time of flight is that of the phase; `None` behind
    /// media that absorb.
    pub group_delay_ns: Option<f64>,
    /// Its share of the power.
    pub power: f64,
    /// Where on the photograph it comes from, the strongest first.
    pub landings: Vec<Landing>,
}

/// A point of the photograph that a pulse comes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Landing {
    /// The point, cm.
    pub position_cm: [f64; 3],
    /// Its share of the power.
    pub power: f64,
}

/// Why a pixel has no list of pulses: the picture has no such pixel.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "there is no pixel {},{}; the picture has columns 0 to {} and rows 0 to {}",
    pixel[0], pixel[1], resolution[0] - 1, resolution[1] - 1
)]
pub struct PulseError {
    /// The column and row asked for.
    pub pixel: [u32; 2],
    /// Width and height of the picture in pixels.
    pub resolution: [u32; 2],
}

/// Lists the pulses of the pixel at a column and row, counted from 0 at the top left.
///
/// Mean and spread are those of the channels `time_of_flight` and `time_of_flight_spread` with one
/// sample a pixel.
///
/// # Errors
///
/// If the picture has no such pixel.
pub fn pulses(prepared: &PreparedScene<'_>, pixel: [u32; 2]) -> Result<PulseList, PulseError> {
    let camera = &prepared.scene.camera;
    let resolution = camera.resolution;
    if pixel[0] >= resolution[0] || pixel[1] >= resolution[1] {
        return Err(PulseError { pixel, resolution });
    }
    // The same trees as in a picture of every channel.
    Ok(match camera.polarizer.amplitudes() {
        None => list(prepared, pixel, &Detection::UNPOLARIZED),
        Some(amplitudes) => list(prepared, pixel, &Detection::through(amplitudes)),
    })
}

fn list<const N: usize>(
    prepared: &PreparedScene<'_>,
    pixel: [u32; 2],
    detection: &Detection<N>,
) -> PulseList {
    let camera = &prepared.scene.camera;
    let [x, y] = pixel.map(|i| f64::from(i) + 0.5);
    let ray = camera.ray(x, y);
    let mut tracer = Tracer::new(&prepared.assembly, prepared.limits)
        .with_screen(prepared.screen)
        .with_group_delays();
    let (leaves, outcome) = tracer.trace(&detection.launch(camera, &ray));
    let mut interference = Interference::default();
    let gone = [outcome.pruned, outcome.absorbed].map(|power| detection.detected(&power));
    let absorbed = gone[1];
    interference.find(prepared, detection, leaves, ray.origin, gone);
    let (mut arrivals, mut escaped, mut ended) = (Vec::new(), 0.0, 0.0);
    for (number, leaf) in leaves.iter().enumerate() {
        let power = detection.detected(&leaf.power) * interference.gain(number);
        match (leaf.body(), leaf.distance_to(&prepared.screen)) {
            (Some(_), _) => ended += power,
            (None, Some(distance)) if power > 0.0 => arrivals.push(Arrival {
                time: time_of_flight(leaf, distance),
                group_delay: group_delay(leaf, distance),
                power,
                // On the plane to the last digit.
                position: prepared.screen.foot(leaf.position + leaf.direction * distance),
            }),
            (None, Some(_)) => {}
            (None, None) => escaped += power,
        }
    }
    let empty = empty_time_of_flight(prepared, &ray);
    let mut sums = Pixel::default();
    sums.times.add(&arrivals.iter().map(|a| (a.time, a.power)).collect::<Vec<_>>(), empty);
    let number = |channel| Some(sums.value(channel, 0, 1.0)).filter(|value| value.is_finite());
    let tolerance = prepared.limits.tolerance;
    let resolution_ns = tolerance / SPEED_OF_LIGHT;
    arrivals.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut pulses: Vec<Pulse> = Vec::new();
    let mut rest = &arrivals[..];
    while let Some(first) = rest.first() {
        let together = rest.iter().take_while(|a| a.time - first.time <= resolution_ns).count();
        let (pulse, later) = rest.split_at(together);
        pulses.push(Pulse::of(pulse, empty, tolerance));
        rest = later;
    }
    PulseList {
        pixel,
        // The sum of none would be -0.
        delivered: pulses.iter().fold(0.0, |sum, pulse| sum + pulse.power),
        pulses,
        resolution_ns,
        empty_time_of_flight_ns: empty,
        mean_time_of_flight_ns: number(ChannelKind::TimeOfFlight),
        time_of_flight_spread_ns: number(ChannelKind::TimeOfFlightSpread),
        escaped,
        absorbed: absorbed - interference.added + ended,
        pruned: detection.detected(&outcome.pruned),
    }
}

/// A leaf on the photograph: time of flight (ns), power and place (cm).
#[derive(Clone, Copy, Debug)]
struct Arrival {
    time: f64,
    group_delay: f64,
    power: f64,
    position: DVec3,
}

impl Pulse {
    /// The pulse that arrivals at one time make; places closer than `tolerance` (cm) are one.
    fn of(arrivals: &[Arrival], empty: Option<f64>, tolerance: f64) -> Self {
        let power: f64 = arrivals.iter().map(|arrival| arrival.power).sum();
        // Relative to the first arrival: differences of yoctoseconds survive.
        let first = arrivals.first().map_or(0.0, |arrival| arrival.time);
        let later: f64 = arrivals.iter().map(|a| (a.time - first) * a.power).sum::<f64>() / power;
        let group = arrivals.iter().map(|a| a.group_delay * a.power).sum::<f64>() / power;
        let mut landings: Vec<Landing> = Vec::new();
        for arrival in arrivals {
            let near = |landing: &&mut Landing| {
                DVec3::from_array(landing.position_cm).distance(arrival.position) <= tolerance
            };
            match landings.iter_mut().find(near) {
                Some(landing) => landing.power += arrival.power,
                None => landings.push(Landing {
                    position_cm: arrival.position.to_array(),
                    power: arrival.power,
                }),
            }
        }
        landings.sort_by(|a, b| b.power.total_cmp(&a.power));
        Self {
            time_of_flight_ns: first + later,
            delay_ns: empty.map(|empty| first - empty + later),
            group_delay_ns: Some(group).filter(|group| group.is_finite()),
            power,
            landings,
        }
    }
}
