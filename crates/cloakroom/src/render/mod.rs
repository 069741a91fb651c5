//! Rendering: from a scene to a picture.
//!
//! The picture is exposed in bands of rows, each by one thread; what a pixel shows depends on the
//! scene and the pixel alone, so the result does not depend on the number of threads.

mod block_tracer;
mod body_surface;
mod channels;
mod contrast;
mod detection;
mod estimate;
mod exposure;
mod film;
mod flight;
mod images;
mod interference;
mod patch;
mod pixel;
mod prepared_scene;
mod pulses;
mod sampling;
mod spectral;
mod tile;
mod warnings;

pub use channels::{ChannelKind, ChannelSet};
pub use estimate::{Estimate, estimate};
pub use flight::{
    Arrivals, Delay, Flash, FlashError, Flashed, FlightCube, FlightSettings, FlightTile, Gate,
    GateError, MOST_BINS, PixelBins, arrival_times, flight, flight_part, flight_steps,
};
pub use images::Images;
pub use prepared_scene::{
    INPUTS, PreparedScene, PreparedSceneError, assembly, coherence, limits, ray_settings,
};
pub use pulses::{Landing, Pulse, PulseError, PulseList, pulses};
pub use tile::{MergeError, Tile, TileError, merge, merge_images};
pub use warnings::{Origins, behind_photograph, origins, pixels_across};

use crate::color::BINS;
use crate::output::Picture;
use crate::scene::{CameraRay, Scene};
use crate::split_mix::mix;
use crate::trace::{Stopped, TraceStats};
use arrayvec::ArrayVec;
pub use block_tracer::BAND_ROWS;
pub(crate) use block_tracer::BlockTracer;
use block_tracer::MOST_TRACERS;
use contrast::{Contrast, first_look};
pub(crate) use detection::Detection;
pub(crate) use exposure::Traced;
use exposure::{Working, expose, expose_unhindered};
use film::{Band, Film};
use flight::{Arrival, FlightPixel};
use glam::DVec3;
use pixel::Pixel;
use rayon::prelude::*;
use spectral::{Colors, Nodes, Spectral};
use std::sync::atomic::{AtomicBool, Ordering};

/// How a long work is watched and stopped.
#[derive(Clone, Copy)]
pub struct Supervision<'a> {
    /// Called now and then, from any thread, with how many rows have been finished since the last
    /// call.
    pub rows_done: &'a (dyn Fn(u64) + Sync),
    /// Set from outside to stop the work.
    pub stop: &'a AtomicBool,
}

/// Why no picture was made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The work was stopped from outside.
    #[error("stopped")]
    Stopped(#[from] Stopped),
    /// The picture would not fit into memory.
    #[error("a picture of {width} x {height} pixels {shortage}; make `camera.resolution` smaller")]
    TooLarge {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// The memory needed and there.
        shortage: crate::memory::Shortage,
    },
}

/// A picture and what was rare in the making of it.
#[derive(Debug)]
pub struct Rendered {
    /// The picture.
    pub picture: Picture,
    /// Rare events over all rays.
    pub stats: TraceStats,
    /// The largest share of the light of a pixel that is in branches too weak to follow.
    pub most_pruned: f64,
}

/// Renders a scene.
///
/// # Errors
///
/// If the picture would not fit into memory, or the work was stopped.
pub fn render(
    prepared: &PreparedScene<'_>,
    wanted: ChannelSet,
    supervision: &Supervision<'_>,
) -> Result<Rendered, RenderError> {
    let [width, height] = prepared.scene.camera.resolution;
    render_part(prepared, wanted, Tile { left: 0, top: 0, width, height }, supervision)
}

/// Pixels in a strip: enough for all threads to be busy nearly all the time.
const STRIP_PIXELS: u32 = 1 << 22;

/// How many small strips a picture of few pixels has.
const MOST_SMALL_STRIPS: u64 = 32;

/// A picture in strips of equal height, from top to bottom: what is rendered strip by strip needs
/// no more memory than one of them.
pub fn strips(prepared: &PreparedScene<'_>) -> impl Iterator<Item = Tile> + use<> {
    strips_of(prepared, STRIP_PIXELS)
}

/// The same in as small strips as are worth a file of their own.
pub fn small_strips(prepared: &PreparedScene<'_>) -> impl Iterator<Item = Tile> + use<> {
    let [width, height] = prepared.scene.camera.resolution;
    let share = u64::from(width) * u64::from(height) / MOST_SMALL_STRIPS;
    strips_of(prepared, u32::try_from(share).unwrap_or(u32::MAX).min(STRIP_PIXELS))
}

fn strips_of(prepared: &PreparedScene<'_>, pixels: u32) -> impl Iterator<Item = Tile> + use<> {
    let [width, height] = prepared.scene.camera.resolution;
    let rows = (pixels / width / BAND_ROWS).max(1) * BAND_ROWS;
    (0..height).step_by(rows as usize).map(move |top| Tile {
        left: 0,
        top,
        width,
        height: rows.min(height - top),
    })
}

/// Renders a tile of a picture: the picture has these pixels alone, and its metadata say which they
/// are. They are the same as in the whole picture; even edges save work, for pixels are exposed in
/// aligned blocks of 2 x 2.
///
/// # Errors
///
/// If it would not fit into memory, or the work was stopped.
///
/// # Panics
///
/// If the tile is not [checked](Tile::check) against the picture's resolution.
pub fn render_tile(
    prepared: &PreparedScene<'_>,
    wanted: ChannelSet,
    tile: Tile,
    supervision: &Supervision<'_>,
) -> Result<Rendered, RenderError> {
    let resolution = prepared.scene.camera.resolution;
    assert!(tile.check(resolution).is_ok(), "the tile is not of this picture");
    let mut rendered = render_part(prepared, wanted, tile, supervision)?;
    rendered.picture.metadata = tile_metadata(prepared, tile);
    Ok(rendered)
}

/// The metadata of a tile: those of the picture, and which part of it the tile is.
#[must_use]
pub fn tile_metadata(prepared: &PreparedScene<'_>, tile: Tile) -> Vec<(String, String)> {
    let of_tile = tile.metadata(prepared.scene.camera.resolution);
    prepared.metadata().into_iter().chain(of_tile).collect()
}

/// Renders a part of a picture, one of its [`strips`] or all of it: the picture has these pixels
/// alone, and the metadata of the whole.
///
/// # Errors
///
/// If it would not fit into memory, or the work was stopped.
pub fn render_part(
    prepared: &PreparedScene<'_>,
    wanted: ChannelSet,
    tile: Tile,
    supervision: &Supervision<'_>,
) -> Result<Rendered, RenderError> {
    match (wanted, prepared.scene.camera.polarizer.amplitudes()) {
        (_, None) => expose_film(prepared, wanted, tile, supervision, Detection::UNPOLARIZED),
        (ChannelSet::Image, Some(amplitudes)) => {
            expose_film(prepared, wanted, tile, supervision, Detection::image(amplitudes))
        }
        (_, Some(amplitudes)) => {
            expose_film(prepared, wanted, tile, supervision, Detection::through(amplitudes))
        }
    }
}

fn expose_film<const N: usize>(
    prepared: &PreparedScene<'_>,
    wanted: ChannelSet,
    tile: Tile,
    supervision: &Supervision<'_>,
    detection: Detection<N>,
) -> Result<Rendered, RenderError> {
    let Tile { width, height, .. } = tile;
    check_memory(prepared, wanted, tile)?;
    let settings = &prepared.scene.picture;
    let detection = detection.with_options(wanted, settings);
    let colors = detection.of_colors();
    let channels = ChannelKind::of(wanted, settings);
    let mut film = Film::new(tile, &channels);
    let mut bands = film.bands(BAND_ROWS as usize);
    // In no order, so that what is done says how long the rest will take.
    bands.sort_by_cached_key(|band| mix(band.corner[1] as u64));
    let (stats, most_pruned) = bands
        .into_par_iter()
        .map_init(
            || Exposer::new(prepared, [&detection, &colors]),
            |(exposer, tracers), mut band| {
                let stats = exposer.expose_band(tracers, &mut band, supervision.stop)?;
                (supervision.rows_done)(band.rows as u64);
                Ok::<_, Stopped>(stats)
            },
        )
        .try_reduce(Default::default, |(mut stats, most), (of_band, most_there)| {
            stats += of_band;
            Ok((stats, f64::max(most, most_there)))
        })?;
    let [width, height] = [width, height].map(|side| side as usize);
    let (channels, metadata) = (film.into_channels(), prepared.metadata());
    Ok(Rendered { picture: Picture { width, height, channels, metadata }, stats, most_pruned })
}

/// Bytes of memory that a part of a picture takes.
fn bytes_of(prepared: &PreparedScene<'_>, wanted: ChannelSet, tile: Tile) -> u64 {
    let channels = ChannelKind::of(wanted, &prepared.scene.picture);
    let bytes: usize = channels.iter().map(|channel| channel.blank(1).bytes()).sum();
    // Files are made from copies of the finished planes.
    u64::from(tile.width) * u64::from(tile.height) * 2 * bytes as u64
}

/// Refuses a part of a picture that would not fit into memory.
///
/// # Errors
///
/// [`RenderError::TooLarge`].
pub fn check_memory(
    prepared: &PreparedScene<'_>,
    wanted: ChannelSet,
    tile: Tile,
) -> Result<(), RenderError> {
    let Tile { width, height, .. } = tile;
    let needed = bytes_of(prepared, wanted, tile);
    crate::memory::check(needed, u64::MAX).map_err(|shortage| RenderError::TooLarge {
        width,
        height,
        shortage,
    })
}

/// What every file that is made of a scene carries: program, scene, version and seed.
#[must_use]
pub fn metadata(scene: &Scene) -> Vec<(String, String)> {
    [
        ("software", concat!("cloakroom ", env!("CARGO_PKG_VERSION")).to_owned()),
        ("scene", scene.source.clone()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("seed", scene.camera.seed.to_string()),
    ]
    .map(|(key, value)| (key.to_owned(), value))
    .to_vec()
}

/// The pixels of a block of 2 x 2.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    pixels: [Pixel; 4],
    /// All that is no color, where colors are traced each by itself.
    numbers: Option<[Pixel; 4]>,
}

/// One thread's tracers and memory.
struct Exposer<'a, const N: usize> {
    prepared: &'a PreparedScene<'a>,
    detection: &'a Detection<N>,
    /// What is wanted of colors that are traced each by itself.
    colors: &'a Detection<N>,
    working: Working,
    spectral: spectral::Working<N>,
    /// The light of the pixels of a block in each bin, where it is wanted.
    spectra: Option<[[f64; BINS]; 4]>,
    /// How light in flight is looked at, and what has arrived at the pixels of a block.
    flight: Option<(FlightSettings, Vec<FlightPixel>)>,
}

impl<'a, const N: usize> Exposer<'a, N> {
    /// With a tracer for each wavelength at which colors are traced, and one more for the rest; else with
    /// one for all.
    fn new(
        prepared: &'a PreparedScene<'a>,
        [detection, colors]: [&'a Detection<N>; 2],
    ) -> (Self, Vec<BlockTracer<'a, N>>) {
        let samples = prepared.scene.camera.samples;
        let tracers = match prepared.spectral.as_deref() {
            None => vec![BlockTracer::new(prepared, detection, samples)],
            Some(spectral) => {
                let nodes = spectral.nodes.iter().map(|node| (node, colors));
                let rest = detection.has_numbers().then_some((prepared, detection));
                let all = nodes.chain(rest);
                all.map(|(scene, wanted)| BlockTracer::new(scene, wanted, samples)).collect()
            }
        };
        let spectral = spectral::Working::default();
        let spectra = detection.spectrum.then(Default::default);
        let working = Working::default();
        (Self { prepared, detection, colors, working, spectral, spectra, flight: None }, tracers)
    }

    /// Exposes a band, patch by patch: what was rare, and the most of a pixel that was pruned.
    fn expose_band(
        &mut self,
        tracers: &mut [BlockTracer<'_, N>],
        band: &mut Band<'_>,
        stop: &AtomicBool,
    ) -> Result<(TraceStats, f64), Stopped> {
        let (mut stats, mut most) = (TraceStats::default(), 0.0);
        let (corner, size) = (band.corner, [band.width, band.rows]);
        BlockTracer::for_blocks(tracers, corner, size, stop, |tracers, corner, traced| {
            let (of_block, there) = self.expose_pixels(tracers, corner, traced, band, stop)?;
            stats += of_block;
            most = f64::max(most, there);
            Ok(())
        })?;
        Ok((stats, most))
    }

    /// Takes the samples of the pixels of a block, in a patch of which so much is traced by each
    /// tracer, and adds what they see to it: how many there were.
    fn expose_samples(
        &mut self,
        tracers: &mut [BlockTracer<'_, N>],
        [left, top]: [usize; 2],
        traced: &[f64],
        stop: &AtomicBool,
        block: &mut Block,
    ) -> Result<(f64, TraceStats), Stopped> {
        let camera = &self.prepared.scene.camera;
        let samples = camera.samples;
        let look = if camera.adaptive > 0.0 { first_look(samples) } else { 0 };
        let mut stats = TraceStats::default();
        self.spectra = self.detection.spectrum.then(Default::default);
        let mut contrast = Contrast::new();
        let mut taken = 0;
        while taken < samples {
            if stop.load(Ordering::Relaxed) {
                return Err(Stopped);
            }
            let before = (taken < look).then_some(block.pixels);
            stats += self.expose_block(tracers, [left, top], taken, traced, block);
            taken += 1;
            if let Some(before) = before {
                contrast.add(&before, &block.pixels);
            }
            if taken == look && contrast.is_within(camera.adaptive) {
                break;
            }
        }
        Ok((f64::from(taken), stats))
    }

    /// Exposes the pixels of a block.
    fn expose_pixels(
        &mut self,
        tracers: &mut [BlockTracer<'_, N>],
        [left, top]: [usize; 2],
        traced: &[f64],
        band: &mut Band<'_>,
        stop: &AtomicBool,
    ) -> Result<(TraceStats, f64), Stopped> {
        let mut block = Block::default();
        let (samples, stats) =
            self.expose_samples(tracers, [left, top], traced, stop, &mut block)?;
        let mut most = 0.0;
        let Band { width, rows, corner: [first_column, first_row], .. } = *band;
        for (i, pixel) in block.pixels.iter().enumerate() {
            let column = (left + i % 2).checked_sub(first_column);
            let row = (top + i / 2).checked_sub(first_row);
            if let (Some(x), Some(y)) = (column, row)
                && x < width
                && y < rows
            {
                let numbers = block.numbers.as_ref().map_or(pixel, |numbers| &numbers[i]);
                most = f64::max(most, numbers.pruned / samples);
                band.set(y * width + x, |channel, part| match (channel, &self.spectra) {
                    (ChannelKind::Spectrum, Some(spectra)) => spectra[i][part] / samples,
                    _ if channel.is_color() => pixel.value(channel, part, samples),
                    _ => numbers.value(channel, part, samples),
                });
            }
        }
        Ok((stats, most))
    }

    /// Traces one sample of each pixel of a block and adds what they see.
    fn expose_block(
        &mut self,
        tracers: &mut [BlockTracer<'_, N>],
        [column, row]: [usize; 2],
        sample: u32,
        traced: &[f64],
        block: &mut Block,
    ) -> TraceStats {
        let (prepared, detection) = (self.prepared, self.detection);
        let camera = &prepared.scene.camera;
        let samples = camera.samples;
        let place = [column as u32 / 2, row as u32 / 2];
        let offset = sampling::offset(sample, samples, place, camera.seed);
        let points = std::array::from_fn(|i| {
            [(column + i % 2) as f64 + offset[0], (row + i / 2) as f64 + offset[1]]
        });
        let rays = points.map(|[x, y]| camera.ray(x, y));
        let spacing = 1.0 / f64::from(samples).sqrt();
        if let Some(spectral) = prepared.spectral.as_deref() {
            return self.expose_colors(spectral, tracers, (&points, &rays), spacing, traced, block);
        }
        let tracer = &mut tracers[0];
        if !tracer.interpolate(&points, &rays, traced[0]) {
            if !(detection.group_delays || detection.stokes || detection.first_face)
                && tracer.meet_nothing(&rays)
                && expose_unhindered(
                    prepared,
                    detection,
                    &rays,
                    spacing,
                    &mut block.pixels,
                    |pixel, arrival| arrive(&mut self.flight, pixel, &[arrival]),
                )
            {
                return TraceStats::default();
            }
            tracer.trace(&rays);
        }
        self.expose_rays(tracer, &rays, spacing, &mut block.pixels);
        tracer.stats()
    }

    /// Adds what the rays of a block see that have been traced.
    fn expose_rays(
        &mut self,
        tracer: &BlockTracer<'_, N>,
        rays: &[CameraRay; 4],
        spacing: f64,
        pixels: &mut [Pixel; 4],
    ) {
        let (prepared, detection) = (self.prepared, self.detection);
        let block = tracer.traced(rays);
        let coherent = prepared.coherence.is_some();
        let expose = if coherent { expose::<N, true> } else { expose::<N, false> };
        for (i, pixel) in pixels.iter_mut().enumerate() {
            let rays = [&block[i], &block[i ^ 1], &block[i ^ 2]];
            expose(prepared, detection, rays, spacing, pixel, &mut self.working);
            arrive(&mut self.flight, i, &self.working.arrivals);
            self.working.arrivals.clear();
        }
    }

    /// The same for colors that are traced each by itself.
    fn expose_colors(
        &mut self,
        spectral: &Spectral<'_>,
        tracers: &mut [BlockTracer<'_, N>],
        (points, rays): (&[[f64; 2]; 4], &[CameraRay; 4]),
        spacing: f64,
        traced: &[f64],
        block: &mut Block,
    ) -> TraceStats {
        // What light of all colors goes past.
        if tracers.len() == spectral.nodes.len()
            && !(self.colors.stokes || self.colors.spectrum)
            && tracers[0].meet_nothing(rays)
        {
            let mut seen = [Pixel::default(); 4];
            let color = spectral.color();
            let of_light = |pixel, arrival: Arrival| {
                let light = (color * DVec3::from_array(arrival.light)).to_array();
                arrive(&mut self.flight, pixel, &[Arrival { light, ..arrival }]);
            };
            if expose_unhindered(self.prepared, self.colors, rays, spacing, &mut seen, of_light) {
                for (pixel, seen) in block.pixels.iter_mut().zip(&seen) {
                    pixel.add_colors(seen, color, self.colors);
                }
                return TraceStats::default();
            }
        }
        let mut stats = TraceStats::default();
        for (tracer, traced) in tracers.iter_mut().zip(traced) {
            if !tracer.interpolate(points, rays, *traced) {
                tracer.trace(rays);
            }
            stats += tracer.stats();
        }
        let (nodes, rest) = tracers.split_at(spectral.nodes.len());
        if let [rest] = rest {
            self.expose_rays(rest, rays, spacing, block.numbers.get_or_insert_default());
        }
        let blocks: ArrayVec<_, MOST_TRACERS> =
            nodes.iter().map(|tracer| tracer.traced(rays)).collect();
        for (i, pixel) in block.pixels.iter_mut().enumerate() {
            let nodes = Nodes { blocks: &blocks, pixel: i };
            let spectrum = self.spectra.as_mut().map(|spectra| &mut spectra[i]);
            let arrivals = &mut self.working.arrivals;
            let mut colors = Colors { pixel, spectrum, arrivals };
            spectral::expose(
                spectral,
                self.colors,
                nodes,
                spacing,
                &mut colors,
                &mut self.spectral,
            );
            arrive(&mut self.flight, i, &self.working.arrivals);
            self.working.arrivals.clear();
        }
        stats
    }
}

/// Puts into its bins what arrives at a pixel of a block, where that is looked at.
fn arrive(
    flight: &mut Option<(FlightSettings, Vec<FlightPixel>)>,
    pixel: usize,
    arrivals: &[Arrival],
) {
    if let Some((settings, pixels)) = flight {
        arrivals.iter().for_each(|arrival| pixels[pixel].add(settings, arrival));
    }
}
