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

/// How long the samples of a part of a patch are looked at, if its blocks take as long as others did: were
/// it ended by how long its own take, costly ones would count too often. One block is looked at in any
/// case.
const EACH: f64 = 0.04;

/// So many parts of patches are looked at, if there is time.
const MOST_PARTS: usize = 512;

/// Blocks of a part of a patch that are exposed, of one sample each.
const BLOCKS: usize = 24;

/// A prime above the number of patches: its multiples visit them all, here and there in the picture.
const STRIDE: usize = 1_000_003;

/// How many rays of samples tracers have followed.
fn walks_of<const N: usize>(tracers: &[BlockTracer<'_, N>]) -> f64 {
    tracers.iter().map(|tracer| tracer.walks).sum()
}

/// How many rays have been followed at nodes.
fn walks_at_nodes<const N: usize>(tracers: &[BlockTracer<'_, N>]) -> f64 {
    tracers.iter().map(BlockTracer::walks_at_nodes).sum()
}

/// Estimates what rendering the image will take: patches here and there in the picture are divided, as
/// for that, down to one part of each, which is rendered and timed in part; as many as two seconds take.
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
    let patches = columns * rows;
    let start = Instant::now();
    let (mut parts, mut seconds, mut walks) = (0.0, 0.0, 0.0);
    // How many blocks have been exposed, and what that took.
    let (mut exposed, mut exposing) = (0.0, 0.0);
    while parts < MOST_PARTS as f64 && (parts == 0.0 || start.elapsed() < LONGEST) {
        let number = parts as usize;
        let place = (number + 1) * STRIDE % patches;
        let corner = [place % columns * side, place / columns * side];
        let mut patch = Patch { corner, size: [side; 2] };
        // Of every two halves one is taken, the next time in this patch another, and counts twice.
        let mut turns = (number / patches) ^ (place.wrapping_mul(STRIDE) >> 7);
        let (mut level, mut weight, mut shares) = (0, 1.0, [None; MOST_TRACERS]);
        loop {
            let (began, walked) = (Instant::now(), walks_at_nodes(&tracers));
            let (found, division) = BlockTracer::fit(&mut tracers, (patch, level), &shares);
            seconds += weight * began.elapsed().as_secs_f64();
            walks += weight * (walks_at_nodes(&tracers) - walked);
            shares = found;
            let Some([first, second]) = division else { break };
            let is_seen = (0..2).all(|axis| second.corner[axis] < size[axis]);
            patch = if is_seen && turns & 1 == 1 { second } else { first };
            if is_seen {
                weight *= 2.0;
                turns >>= 1;
            }
            level += 1;
        }
        let traced = shares.map(|share| share.unwrap_or(1.0));
        let traced = &traced[..tracers.len()];
        let [across, down] =
            patch.part_of([0; 2], size).map(|range| (range.start, range.len().div_ceil(2)));
        let blocks = across.1 * down.1;
        let wanted = if exposed == 0.0 { 1.0 } else { EACH * exposed / exposing };
        let step = blocks.div_ceil((wanted as usize).clamp(1, BLOCKS));
        // From the middle of the first step on: columns and rows are met evenly.
        let numbers = (step / 2..blocks).step_by(step);
        let (began, walked) = (Instant::now(), walks_of(&tracers));
        let mut look = |block: usize| {
            let corner = [across.0 + block % across.1 * 2, down.0 + block / across.1 * 2];
            exposer.expose_block(&mut tracers, corner, 0, traced, &mut Default::default());
        };
        numbers.clone().for_each(&mut look);
        let took = began.elapsed().as_secs_f64();
        exposed += numbers.len() as f64;
        exposing += took;
        // What is made or fetched once, when it is first asked for, is not done for each block.
        let (looks, again) = if took < EACH {
            numbers.clone().for_each(&mut look);
            (2.0, began.elapsed().as_secs_f64() - took)
        } else {
            (1.0, took)
        };
        let scale = blocks as f64 / numbers.len() as f64 * f64::from(camera.samples);
        seconds += weight * again * scale;
        walks += weight * (walks_of(&tracers) - walked) * scale / looks;
        parts += 1.0;
    }
    let scale = patches as f64 / parts;
    let [width, height] = camera.resolution;
    Estimate {
        seconds: seconds * scale / rayon::current_num_threads() as f64,
        walks: walks * scale,
        samples: u64::from(width) * u64::from(height) * u64::from(camera.samples),
        bytes: bytes_of(prepared, ChannelSet::Image, Tile { left: 0, top: 0, width, height }),
    }
}
