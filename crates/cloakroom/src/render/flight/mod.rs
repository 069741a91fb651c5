//! Light in flight: what a camera with a time gate sees when the photograph flashes.
//!
//! Each leaf of each sample arrives at its own time, and goes into the bins of that pixel with its
//! light and its power. Leaves are added by power: light that interferes in a picture does not here.
//! The photograph alone is timed; bodies and surroundings stand before it as a steady picture.

mod cube;
mod flash;
mod gate;

pub use cube::FlightCube;
pub use flash::{Flash, FlashError};
pub use gate::{Gate, GateError, MOST_BINS};

use super::block_tracer::BlockTracer;
use super::detection::Detection;
use super::exposure::{group_delay, time_of_flight};
use super::patch::SIDE;
use super::pixel::sort_by_arrival;
use super::{Block, Exposer, PreparedScene, RenderError, Supervision, Tile};
use crate::assembly::Screen;
use crate::split_mix::mix;
use crate::trace::{Leaf, Stopped, TraceStats, Tracer};
use glam::DVec3;
use optics::wave::SPEED_OF_LIGHT;
use rayon::prelude::*;

/// Which of the two times of light counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Delay {
    /// What a pulse takes, as the channel `group_delay` has it.
    #[default]
    Group,
    /// What the phase takes, as the paper and the channel `time_of_flight` have it.
    Phase,
}

impl Delay {
    /// What it is called: `group` or `phase`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Group => "group",
            Self::Phase => "phase",
        }
    }

    /// That of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        [Self::Group, Self::Phase].into_iter().find(|delay| delay.name() == name)
    }
}

/// How light in flight is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightSettings {
    /// When the camera's gate is open.
    pub gate: Gate,
    /// How long the flash is at half its height, ns: of the shape cos². 0 for no time at all.
    pub width: f64,
    /// When light arrives, and what flashes.
    pub arrivals: Arrivals,
}

/// When light arrives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arrivals {
    /// Which time counts.
    pub delay: Delay,
    /// What flashes.
    pub flash: Flash,
}

impl Arrivals {
    /// When a leaf arrives that meets the photograph `distance` (cm) on, ns, NaN where that is not
    /// known; and how bright the flash is where it comes from.
    pub(super) fn of<const N: usize>(
        &self,
        leaf: &Leaf<N>,
        distance: f64,
        screen: &Screen,
    ) -> (f64, f64) {
        let flight = match self.delay {
            Delay::Group => group_delay(leaf, distance),
            Delay::Phase => time_of_flight(leaf, distance),
        };
        let (later, brightness) = self.flash.at(leaf.position + leaf.direction * distance, screen);
        (flight + later, brightness)
    }

    /// What a camera ray that meets nothing but the photograph, or not even that, sees of a point so
    /// far away (cm).
    pub(super) fn unhindered(
        &self,
        seen: Option<(DVec3, f64)>,
        screen: &Screen,
        power: f64,
        light: [f64; 3],
    ) -> Arrival {
        let Some((point, distance)) = seen else { return Arrival { time: None, power, light } };
        let (later, brightness) = self.flash.at(point, screen);
        Arrival::flashed(distance / SPEED_OF_LIGHT + later, brightness, power, light)
    }
}

/// Something that one camera ray sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// When it arrives, ns, NaN where that is not known; `None` if it is steady.
    pub time: Option<f64>,
    pub power: f64,
    pub light: [f64; 3],
}

impl Arrival {
    /// What a leaf of a ray sees, of which it has that power and light.
    pub fn of<const N: usize>(
        arrivals: &Arrivals,
        leaf: &Leaf<N>,
        screen: (&Screen, Option<f64>),
        power: f64,
        light: [f64; 3],
    ) -> Self {
        let (Some(distance), None) = (screen.1, leaf.body()) else {
            return Self { time: None, power, light };
        };
        let (time, brightness) = arrivals.of(leaf, distance, screen.0);
        Self::flashed(time, brightness, power, light)
    }

    /// Of the photograph, which flashes so bright there.
    pub fn flashed(time: f64, brightness: f64, power: f64, light: [f64; 3]) -> Self {
        let light = light.map(|light| light * brightness);
        Self { time: Some(time), power: power * brightness, light }
    }
}

/// What a pulse takes need be no more exact than this, cm, or than this share of a bin: neither is seen.
const TOLERANCE: f64 = 1e-4;
const SHARE_OF_BIN: f64 = 1e-3;

/// Light of the flash: red, green and blue, and the share of the power.
pub type Flashed = [f64; 4];

/// A part of a picture of light in flight. All arrays go pixel by pixel, row by row from the top
/// left.
#[derive(Clone, Debug)]
pub struct FlightTile {
    /// Which part it is.
    pub tile: Tile,
    /// What is in the bins of each pixel.
    pub bins: Vec<PixelBins>,
    /// What comes before all bins, and after them.
    pub outside: [Vec<Flashed>; 2],
    /// What comes nobody knows when: as pulses, behind media that absorb.
    pub untimed: Vec<Flashed>,
    /// What does not flash: bodies and surroundings.
    pub steady: Vec<[f64; 3]>,
    /// The picture without any gate in the light of the flash, its leaves added by power.
    pub picture: Vec<[f64; 3]>,
}

/// What is in the bins of a pixel from the first that has anything to the last; all others are dark.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelBins {
    /// The number of the first of them.
    pub first: usize,
    /// What is in them, one after the other.
    pub light: Vec<Flashed>,
}

impl FlightTile {
    /// What comes to a pixel at any time, and what does not flash.
    fn in_all(&self, index: usize) -> [f64; 3] {
        let beside = self.outside.iter().map(|outside| outside[index]);
        let flashed = self.bins[index].light.iter().copied().chain(beside);
        let flashed = flashed.chain([self.untimed[index]]);
        flashed.fold(self.steady[index], |sum, light| std::array::from_fn(|i| sum[i] + light[i]))
    }

    fn new(tile: Tile) -> Self {
        let pixels = tile.width as usize * tile.height as usize;
        let flashed = || vec![[0.0; 4]; pixels];
        Self {
            tile,
            bins: vec![PixelBins::default(); pixels],
            outside: [flashed(), flashed()],
            untimed: flashed(),
            steady: vec![[0.0; 3]; pixels],
            picture: vec![[0.0; 3]; pixels],
        }
    }
}

/// What a pixel gathers from its samples.
#[derive(Clone, Debug)]
pub(super) struct FlightPixel {
    bins: Vec<Flashed>,
    /// Of the bins, the first that has got something and the one after the last.
    used: [usize; 2],
    outside: [Flashed; 2],
    untimed: Flashed,
    steady: [f64; 3],
}

impl FlightPixel {
    fn new(bins: usize) -> Self {
        Self {
            bins: vec![[0.0; 4]; bins],
            used: [bins, 0],
            outside: [[0.0; 4]; 2],
            untimed: [0.0; 4],
            steady: [0.0; 3],
        }
    }

    fn clear(&mut self) {
        let [first, end] = self.used;
        self.bins[first.min(end)..end].fill([0.0; 4]);
        self.used = [self.bins.len(), 0];
        self.outside = [[0.0; 4]; 2];
        (self.untimed, self.steady) = ([0.0; 4], [0.0; 3]);
    }

    /// Adds what arrives.
    pub fn add(&mut self, settings: &FlightSettings, arrival: &Arrival) {
        let Arrival { time, power, light: [red, green, blue] } = *arrival;
        let flashed = [red, green, blue, power];
        let Some(time) = time else {
            self.steady.iter_mut().zip(flashed).for_each(|(sum, light)| *sum += light);
            return;
        };
        if time.is_nan() {
            add(&mut self.untimed, flashed, 1.0);
            return;
        }
        let Self { bins, used: [first, end], .. } = self;
        let [before, after] = settings.gate.shares(time, settings.width, |bin, share| {
            (*first, *end) = ((*first).min(bin), (*end).max(bin + 1));
            add(&mut bins[bin], flashed, share);
        });
        for (sum, share) in self.outside.iter_mut().zip([before, after]) {
            add(sum, flashed, share);
        }
    }
}

fn add(sum: &mut Flashed, flashed: Flashed, share: f64) {
    sum.iter_mut().zip(flashed).for_each(|(sum, light)| *sum += share * light);
}

/// The parts of a picture of light in flight, which need little memory each.
fn tiles(part: Tile) -> Vec<Tile> {
    let side = SIDE as u32;
    let [right, bottom] = [part.left + part.width, part.top + part.height];
    let rows = (part.top..bottom).step_by(SIDE);
    let tile = |left: u32, top: u32| Tile {
        left,
        top,
        width: side.min(right - left),
        height: side.min(bottom - top),
    };
    let tiles =
        rows.flat_map(|top| (part.left..right).step_by(SIDE).map(move |left| tile(left, top)));
    tiles.collect()
}

fn whole(prepared: &PreparedScene<'_>) -> Tile {
    let [width, height] = prepared.scene.camera.resolution;
    Tile { left: 0, top: 0, width, height }
}

/// How many steps of progress a picture of light in flight has.
#[must_use]
pub fn flight_steps(prepared: &PreparedScene<'_>) -> u64 {
    tiles(whole(prepared)).iter().map(|tile| u64::from(tile.height)).sum()
}

/// Looks at light in flight, and gives `take` part by part of the picture, each once and in no order,
/// from any thread.
///
/// # Errors
///
/// That of `take`; if the bins of the parts at work would not fit into memory, or the work was
/// stopped.
pub fn flight<E: From<RenderError> + Send>(
    prepared: &PreparedScene<'_>,
    settings: &FlightSettings,
    supervision: &Supervision<'_>,
    take: impl Fn(FlightTile) -> Result<(), E> + Sync,
) -> Result<TraceStats, E> {
    flight_part(prepared, settings, whole(prepared), supervision, take)
}

/// The same for a part of the picture. Its first column and row are multiples of [`BAND_ROWS`](super::BAND_ROWS), for what
/// is in it to be as in the whole picture.
///
/// # Errors
///
/// As [`flight`].
pub fn flight_part<E: From<RenderError> + Send>(
    prepared: &PreparedScene<'_>,
    settings: &FlightSettings,
    part: Tile,
    supervision: &Supervision<'_>,
    take: impl Fn(FlightTile) -> Result<(), E> + Sync,
) -> Result<TraceStats, E> {
    let prepared = &prepared.added_by_power();
    let arrivals = settings.arrivals;
    let tolerance = TOLERANCE.min(SHARE_OF_BIN * settings.gate.step() * SPEED_OF_LIGHT);
    match prepared.scene.camera.polarizer.amplitudes() {
        None => {
            let detection = Detection::UNPOLARIZED.in_flight(arrivals, tolerance);
            expose_tiles(prepared, (settings, part), supervision, detection, take)
        }
        Some(amplitudes) => {
            let detection = Detection::image(amplitudes).in_flight(arrivals, tolerance);
            expose_tiles(prepared, (settings, part), supervision, detection, take)
        }
    }
}

fn expose_tiles<const N: usize, E: From<RenderError> + Send>(
    prepared: &PreparedScene<'_>,
    (settings, part): (&FlightSettings, Tile),
    supervision: &Supervision<'_>,
    detection: Detection<N>,
    take: impl Fn(FlightTile) -> Result<(), E> + Sync,
) -> Result<TraceStats, E> {
    let Tile { width, height, .. } = part;
    let bins = settings.gate.bins();
    let pixels = SIDE.min(width as usize) * SIDE.min(height as usize);
    let needed = rayon::current_num_threads() * pixels * bins * size_of::<Flashed>();
    crate::memory::check(needed as u64, u64::MAX).map_err(|shortage| RenderError::TooLarge {
        width,
        height,
        shortage,
    })?;
    let mut tiles = tiles(part);
    // In no order, so that what is done says how long the rest will take.
    tiles.sort_by_cached_key(|tile| mix(u64::from(tile.top) << 32 | u64::from(tile.left)));
    tiles
        .into_par_iter()
        .map_init(
            || {
                let (mut exposer, tracers) = Exposer::new(prepared, [&detection, &detection]);
                exposer.flight = Some((*settings, vec![FlightPixel::new(bins); 4]));
                (exposer, tracers)
            },
            |(exposer, tracers), tile| {
                let exposed = exposer.expose_tile(tracers, FlightTile::new(tile), supervision);
                let (tile, stats) = exposed.map_err(RenderError::from)?;
                let rows = u64::from(tile.tile.height);
                take(tile)?;
                (supervision.rows_done)(rows);
                Ok(stats)
            },
        )
        .try_reduce(TraceStats::default, |mut a, b| {
            a += b;
            Ok(a)
        })
}

impl<const N: usize> Exposer<'_, N> {
    /// Exposes a tile, patch by patch.
    fn expose_tile(
        &mut self,
        tracers: &mut [BlockTracer<'_, N>],
        mut flown: FlightTile,
        supervision: &Supervision<'_>,
    ) -> Result<(FlightTile, TraceStats), Stopped> {
        let Tile { left, top, width, height } = flown.tile;
        let [left, top, width, height] = [left, top, width, height].map(|side| side as usize);
        let mut stats = TraceStats::default();
        let stop = supervision.stop;
        BlockTracer::for_blocks(
            tracers,
            [left, top],
            [width, height],
            stop,
            |tracers, at, traced| {
                let mut block = Block::default();
                let (samples, of_block) =
                    self.expose_samples(tracers, at, traced, stop, &mut block)?;
                stats += of_block;
                let Some((settings, pixels)) = &mut self.flight else { return Ok(()) };
                for (i, pixel) in pixels.iter_mut().enumerate() {
                    let column = (at[0] + i % 2).checked_sub(left);
                    let row = (at[1] + i / 2).checked_sub(top);
                    if let (Some(x), Some(y)) = (column, row)
                        && x < width
                        && y < height
                    {
                        let index = y * width + x;
                        let mean = |sum: Flashed| sum.map(|sum| sum / samples);
                        let [first, end] = pixel.used;
                        let used = pixel.bins.get(first..end).unwrap_or_default();
                        let light = used.iter().copied().map(mean).collect();
                        flown.bins[index] = PixelBins { first, light };
                        for (outside, sum) in flown.outside.iter_mut().zip(pixel.outside) {
                            outside[index] = mean(sum);
                        }
                        flown.untimed[index] = mean(pixel.untimed);
                        flown.steady[index] = pixel.steady.map(|sum| sum / samples);
                        flown.picture[index] = if settings.arrivals.flash.is_even() {
                            block.pixels[i].image.map(|sum| sum / samples)
                        } else {
                            flown.in_all(index)
                        };
                    }
                    pixel.clear();
                }
                Ok(())
            },
        )?;
        Ok((flown, stats))
    }
}

/// The first and the last time (ns) at which light arrives, as some rays all over the picture tell: what is as strong as a
/// twentieth of its ray, and all but a thousandth of all light; `None` where none of them sees the photograph.
#[must_use]
pub fn arrival_times(prepared: &PreparedScene<'_>, arrivals: &Arrivals) -> Option<[f64; 2]> {
    /// Rays across and down.
    const RAYS: [u32; 2] = [64, 48];
    const STRONG: f64 = 0.05;
    /// What may come before, as a share of all light, and what after.
    const BESIDE: f64 = 5e-4;
    let camera = &prepared.scene.camera;
    let detection = Detection::UNPOLARIZED;
    let tracer = Tracer::new(&prepared.assembly, prepared.limits).with_screen(prepared.screen);
    let mut tracer = match arrivals.delay {
        Delay::Group => tracer.with_group_delays_to(TOLERANCE),
        Delay::Phase => tracer,
    };
    let place = |number: u32, axis: usize| {
        (f64::from(number) + 0.5) / f64::from(RAYS[axis]) * f64::from(camera.resolution[axis])
    };
    let mut all = Vec::new();
    for number in 0..RAYS[0] * RAYS[1] {
        let ray = camera.ray(place(number % RAYS[0], 0), place(number / RAYS[0], 1));
        let (leaves, _) = tracer.trace(&detection.launch(camera, &ray));
        for leaf in leaves.iter().filter(|leaf| leaf.body().is_none()) {
            let Some(distance) = leaf.distance_to(&prepared.screen) else { continue };
            let (time, brightness) = arrivals.of(leaf, distance, &prepared.screen);
            let power = detection.detected(&leaf.power) * brightness;
            if power > 0.0 && !time.is_nan() {
                all.push((time, power));
            }
        }
    }
    sort_by_arrival(&mut all);
    let least = BESIDE * all.iter().map(|(_, power)| power).sum::<f64>();
    // Where what is strong begins, or more than may be left out.
    let begin = |all: &[(f64, f64)]| {
        let mut passed = 0.0;
        let counts = |(_, power): &&(f64, f64)| {
            passed += power;
            *power >= STRONG || passed > least
        };
        all.iter().find(counts).map(|(time, _)| *time)
    };
    let first = begin(&all)?;
    all.reverse();
    Some([first, begin(&all)?])
}
