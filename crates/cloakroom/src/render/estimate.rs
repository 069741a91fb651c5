//! How long a picture will take.

use super::block_tracer::MOST_TRACERS;
use super::detection::Detection;
use super::patch::Patch;
use super::{BlockTracer, ChannelSet, Exposer, PreparedScene, Tile, bytes_of};
use std::time::{Duration, Instant};

/// What rendering an image will take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Seconds on the threads there are.
    pub seconds: f64,
    /// How many rays will be followed to their ends; one of which a part is interpolated counts by
    /// the rest.
    pub walks: f64,
    /// How many rays the camera sends out.
    pub samples: u64,
    /// Bytes of memory that the picture takes while it is rendered and written.
    pub bytes: u64,
}

/// How long the image of a scene is looked at.
const LONGEST: Duration = Duration::from_secs(2);

/// How long the samples of a part of a patch are looked at; one block is in any case.
const EACH: Duration = Duration::from_millis(40);

/// Patches that are looked at, if there is time.
const MOST_PATCHES: usize = 512;

/// Blocks of a part of a patch that are exposed, of one sample each.
const BLOCKS: usize = 24;

/// A prime above the number of patches: its multiples visit them all, here and there in the picture.
const STRIDE: usize = 1_000_003;

/// How many rays of samples tracers have followed.
fn walks_of<const N: usize>(tracers: &[BlockTracer<'_, N>]) -> f64 {
    tracers.iter().map(|tracer| tracer.walks).sum()
}

/// Estimates what rendering the image will take: patches here and there in the picture are rendered
/// in part and timed, as many as two seconds take.
#[must_use]
pub fn estimate(prepared: &PreparedScene<'_>) -> Estimate {
    match prepared.scene.camera.polarizer.amplitudes() {
        None => estimate_of(prepared, Detection::UNPOLARIZED),
        Some(amplitudes) => estimate_of(prepared, Detection::image(amplitudes)),
    }
}

fn estimate_of<const N: usize>(prepared: &PreparedScene<'_>, detection: Detection<N>) -> Estimate {
    let camera = &prepared.scene.camera;
    let size = camera.resolution.map(|side| side as usize);
    let detection = detection.with_options(ChannelSet::Image, &prepared.scene.picture);
    let colors = detection.of_colors();
    let (mut exposer, mut tracers) = Exposer::new(prepared, [&detection, &colors]);
    let side = BlockTracer::common_side(&tracers);
    let [columns, rows] = size.map(|pixels| pixels.div_ceil(side));
    let start = Instant::now();
    let (mut looked_at, mut seconds, mut walks) = (0.0, 0.0, 0.0);
    for number in 0..(columns * rows).min(MOST_PATCHES) {
        if number > 0 && start.elapsed() >= LONGEST {
            break;
        }
        let place = (number + 1) * STRIDE % (columns * rows);
        let corner = [place % columns * side, place / columns * side];
        let is_seen = |patch: Patch| (0..2).all(|i| patch.corner[i] < size[i]);
        let began = Instant::now();
        // What exposing the blocks took, and would take of all.
        let (mut exposing, mut all) = (0.0, 0.0);
        let mut expose = |tracers: &mut [BlockTracer<'_, N>], patch: Patch, traced: &[f64]| {
            let (began, walked) = (Instant::now(), walks_of(tracers));
            let [across, down] =
                patch.part_of([0; 2], size).map(|range| (range.start, range.len().div_ceil(2)));
            let blocks = across.1 * down.1;
            let step = blocks.div_ceil(BLOCKS);
            let mut count = 0.0;
            // From the middle of the first step on: columns and rows are met evenly.
            let numbers = (step / 2..blocks).step_by(step);
            let mut look = |block: usize| {
                let corner = [across.0 + block % across.1 * 2, down.0 + block / across.1 * 2];
                exposer.expose_block(tracers, corner, 0, traced, &mut Default::default());
            };
            for block in numbers.clone() {
                look(block);
                count += 1.0;
                // Where rays take long, those of other patches say more.
                if began.elapsed() >= EACH {
                    break;
                }
            }
            let took = began.elapsed();
            // What is made or fetched once, when it is first asked for, is not done for each block.
            let (looks, again) = if took < EACH {
                numbers.for_each(&mut look);
                (2.0, began.elapsed() - took)
            } else {
                (1.0, took)
            };
            let scale = blocks as f64 / count * f64::from(camera.samples);
            exposing += began.elapsed().as_secs_f64();
            all += took.as_secs_f64() + again.as_secs_f64() * (scale - 1.0);
            walks += (walks_of(tracers) - walked) * scale / looks;
            Ok(())
        };
        let patch = Patch { corner, size: [side; 2] };
        let unknown = &[None; MOST_TRACERS];
        let looked = BlockTracer::divide(&mut tracers, (patch, 0), unknown, &is_seen, &mut expose);
        debug_assert!(looked.is_ok(), "nothing stops it");
        seconds += began.elapsed().as_secs_f64() - exposing + all;
        looked_at += 1.0;
    }
    walks += tracers.iter().map(BlockTracer::walks_at_nodes).sum::<f64>();
    let scale = (columns * rows) as f64 / looked_at;
    let [width, height] = camera.resolution;
    Estimate {
        seconds: seconds * scale / rayon::current_num_threads() as f64,
        walks: walks * scale,
        samples: u64::from(width) * u64::from(height) * u64::from(camera.samples),
        bytes: bytes_of(prepared, ChannelSet::Image, Tile { left: 0, top: 0, width, height }),
    }
}
