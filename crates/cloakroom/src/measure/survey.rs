//! What the rays themselves tell of a cloak: where they land on the photograph, against where they
//! should.

use crate::assembly::Screen;
use crate::render::{
    BAND_ROWS, BlockTracer, ChannelSet, Detection, PreparedScene, RenderError, Supervision, Traced,
};
use crate::scene::{Camera, CameraRay};
use crate::trace::{Leaf, Outcome, Stopped, Tracer};
use rayon::prelude::*;

/// How near to where it should a ray must land to count as cloaked, cm on the photograph.
pub const CLOAKED_WITHIN_CM: f64 = 1.0;

/// How near to where it should a ray must land to be in place, cm on the photograph, and how near
/// to the direction that it should have it must go, degrees: strictly, and widely.
pub const IN_PLACE_WITHIN: [[f64; 2]; 2] = [[CLOAKED_WITHIN_CM, 1.0], [5.0, 5.0]];

/// What the ray through the middle of each pixel has met, and how well.
///
/// A ray's leaves count by their power. Errors are those of the leaves on the photograph against
/// the strongest leaf of the same camera ray in the ideal scene, if that is on the photograph, too.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Whether the ray meets a device, row by row from the top left.
    pub silhouette: Vec<bool>,
    /// Root mean square of the distance at the photograph from where light should land, over the
    /// silhouette, cm; `None` if none of it can be compared.
    pub displacement_rms_cm: Option<f64>,
    /// Root mean square of the angle to the direction that light should have there, over the
    /// silhouette, degrees.
    pub direction_error_rms_deg: Option<f64>,
    /// Share of the silhouette's pixels that are not cloaked: less than half of their power goes
    /// within [`CLOAKED_WITHIN_CM`] of where it should, or, where it should miss the photograph,
    /// misses it. `None` without a silhouette.
    pub uncloaked_share: Option<f64>,
    /// What these pixels cover of the plane of the photograph in the empty view, cm².
    pub uncloaked_area_cm2: f64,
    /// The shares of each pixel's power that are in place, row by row from the top left: strictly,
    /// and widely, as [`IN_PLACE_WITHIN`] says. Light that should miss the photograph must miss it,
    /// wherever.
    pub in_place: Vec<[f64; 2]>,
}

impl Survey {
    /// The mean over the silhouette of the share that is strictly [in place](Self::in_place);
    /// `None` without a silhouette.
    #[must_use]
    pub fn in_place_share(&self) -> Option<f64> {
        let met = || self.silhouette.iter().zip(&self.in_place).filter(|(met, _)| **met);
        let pixels = met().count();
        (pixels > 0).then(|| met().map(|(_, share)| share[0]).sum::<f64>() / pixels as f64)
    }
}

/// One pixel's share in a survey.
#[derive(Clone, Copy, Debug, Default)]
struct Sight {
    met: bool,
    /// Power that can be compared, and the sums over it.
    compared: f64,
    square_cm: f64,
    square_rad: f64,
    /// Power that goes where it should.
    faithful: f64,
    /// Power that does so in the direction that it should have, too.
    in_place: [f64; 2],
}

/// Sends a ray through the middle of each pixel of a scene, and the same ray through the ideal
/// scene, which must have the same camera and photograph.
///
/// # Errors
///
/// If the work was stopped.
pub fn survey(
    prepared: &PreparedScene<'_>,
    ideal: &PreparedScene<'_>,
    supervision: &Supervision<'_>,
) -> Result<Survey, RenderError> {
    match prepared.scene.camera.polarizer.amplitudes() {
        Some(amplitudes) => surveyed(prepared, ideal, Detection::image(amplitudes), supervision),
        None => surveyed(prepared, ideal, Detection::UNPOLARIZED, supervision),
    }
}

fn surveyed<const N: usize>(
    prepared: &PreparedScene<'_>,
    ideal: &PreparedScene<'_>,
    detection: Detection<N>,
    supervision: &Supervision<'_>,
) -> Result<Survey, RenderError> {
    let camera = &prepared.scene.camera;
    let [width, height] = camera.resolution.map(|side| side as usize);
    let detection = detection.with_options(ChannelSet::Image, &prepared.scene.picture);
    let mut sights = vec![Sight::default(); width * height];
    let bands: Result<(), Stopped> = sights
        .par_chunks_mut(width * BAND_ROWS as usize)
        .enumerate()
        .map_init(
            || {
                let limits = ideal.limits;
                let ideal = Tracer::new(&ideal.assembly, limits).with_screen(ideal.screen);
                ([BlockTracer::new(prepared, &detection, 1)], ideal)
            },
            |(tracers, ideal), (band, sights)| {
                let first = band * BAND_ROWS as usize;
                let size = [width, sights.len() / width];
                let stop = supervision.stop;
                let corner = [0, first];
                BlockTracer::for_blocks(tracers, corner, size, stop, |tracers, corner, traced| {
                    let [left, top] = corner;
                    let tracer = &mut tracers[0];
                    let block = sights_of_block(tracer, ideal, &detection, corner, traced[0]);
                    for (sight, [x, y]) in block.into_iter().zip(PIXELS) {
                        let (column, row) = (left + x, top + y - first);
                        if column < width && row < size[1] {
                            sights[row * width + column] = sight;
                        }
                    }
                    Ok(())
                })?;
                (supervision.rows_done)(size[1] as u64);
                Ok(())
            },
        )
        .collect();
    bands?;
    Ok(summary(&sights, camera, &prepared.screen))
}

/// The columns and rows of the pixels of a block.
const PIXELS: [[usize; 2]; 4] = [[0, 0], [1, 0], [0, 1], [1, 1]];

/// The shares of the pixels of a block, of which so much is traced.
fn sights_of_block<const N: usize>(
    tracer: &mut BlockTracer<'_, N>,
    ideal: &mut Tracer<'_, N>,
    detection: &Detection<N>,
    [left, top]: [usize; 2],
    traced: f64,
) -> [Sight; 4] {
    let PreparedScene { scene, screen, .. } = tracer.prepared;
    let points = PIXELS.map(|[x, y]| [(left + x) as f64 + 0.5, (top + y) as f64 + 0.5]);
    let rays = points.map(|[x, y]| scene.camera.ray(x, y));
    let meets_nothing = |ray: &CameraRay| ideal.meets_nothing(ray.origin, ray.direction);
    if tracer.meet_nothing(&rays) && rays.iter().all(meets_nothing) {
        return [Sight { faithful: 1.0, in_place: [1.0; 2], ..Sight::default() }; 4];
    }
    if !tracer.interpolate(&points, &rays, traced) {
        tracer.trace(&rays);
    }
    tracer.traced(&rays).map(|Traced { ray, leaves, outcome, .. }| {
        let (wanted, _) = ideal.trace(&detection.launch(&scene.camera, &ray));
        sight(screen, leaves, outcome, strongest(wanted))
    })
}

fn power<const N: usize>(leaf: &Leaf<N>) -> f64 {
    leaf.power.iter().sum::<f64>() / N as f64
}

fn strongest<const N: usize>(leaves: &[Leaf<N>]) -> Option<&Leaf<N>> {
    leaves.iter().max_by(|a, b| power(a).total_cmp(&power(b)))
}

fn landing<const N: usize>(screen: &Screen, leaf: &Leaf<N>) -> Option<glam::DVec3> {
    let distance = leaf.distance_to(screen)?;
    Some(leaf.position + leaf.direction * distance)
}

fn sight<const N: usize>(
    screen: &Screen,
    leaves: &[Leaf<N>],
    outcome: &Outcome<N>,
    wanted: Option<&Leaf<N>>,
) -> Sight {
    let lost = outcome.absorbed.iter().chain(&outcome.pruned).any(|power| *power > 0.0);
    let mut sight = Sight {
        met: lost || leaves.len() != 1 || leaves.iter().any(|leaf| leaf.met_device),
        ..Sight::default()
    };
    let wanted = wanted.map(|leaf| (leaf.direction, landing(screen, leaf)));
    let Some((direction, wanted)) = wanted else { return sight };
    for leaf in leaves {
        // By the chord: exact to rounding for small angles.
        let angle = 2.0 * (0.5 * leaf.direction.distance(direction)).min(1.0).asin();
        let away = match (landing(screen, leaf), wanted) {
            (Some(place), Some(wanted)) => {
                let away = place.distance(wanted);
                sight.compared += power(leaf);
                sight.square_cm += power(leaf) * away * away;
                sight.square_rad += power(leaf) * angle * angle;
                away
            }
            (None, None) => 0.0,
            _ => f64::INFINITY,
        };
        if away <= CLOAKED_WITHIN_CM {
            sight.faithful += power(leaf);
        }
        for (share, [cm, degrees]) in sight.in_place.iter_mut().zip(IN_PLACE_WITHIN) {
            if away <= cm && angle <= degrees.to_radians() {
                *share += power(leaf);
            }
        }
    }
    sight
}

fn summary(sights: &[Sight], camera: &Camera, screen: &Screen) -> Survey {
    let width = camera.resolution[0] as usize;
    let met = || sights.iter().enumerate().filter(|(_, sight)| sight.met);
    let sum = |value: &dyn Fn(&Sight) -> f64| met().map(|(_, sight)| value(sight)).sum::<f64>();
    let compared = sum(&|sight| sight.compared);
    let rms = |squares: f64| (compared > 0.0).then(|| (squares / compared).sqrt());
    let uncloaked = || met().filter(|(_, sight)| sight.faithful < 0.5);
    let area = |index: usize| {
        let corner = |right: f64, down: f64| {
            let (column, row) = ((index % width) as f64 + right, (index / width) as f64 + down);
            let ray = camera.ray(column, row);
            let distance = screen.plane_distance(ray.origin, ray.direction, 0.0)?;
            Some(ray.origin + ray.direction * distance)
        };
        let sides = corner(0.0, 0.0).zip(corner(1.0, 0.0)).zip(corner(0.0, 1.0));
        sides.map_or(0.0, |((at, right), below)| (right - at).cross(below - at).length())
    };
    let silhouette = met().count();
    Survey {
        silhouette: sights.iter().map(|sight| sight.met).collect(),
        displacement_rms_cm: rms(sum(&|sight| sight.square_cm)),
        direction_error_rms_deg: rms(sum(&|sight| sight.square_rad)).map(f64::to_degrees),
        uncloaked_share: (silhouette > 0).then(|| uncloaked().count() as f64 / silhouette as f64),
        uncloaked_area_cm2: uncloaked().fold(0.0, |sum, (index, _)| sum + area(index)),
        in_place: sights.iter().map(|sight| sight.in_place).collect(),
    }
}
