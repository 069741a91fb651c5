//! How well the devices of a scene do what they are for, over a range of settings.

use super::column::{Column, UnknownColumn, find_column};
use super::measured::Measured;
use super::plan::{Combination, SweepPlan, drawn};
use super::quality_error::{QualityError, located};
use super::statistics::Statistics;
use super::sweep::Sweep;
use super::{View, empty, survey};
use crate::render::{ChannelSet, Images, PreparedScene, Supervision, render};
use crate::scene::Scene;
use crate::trace::TraceStats;
use rayon::prelude::*;

/// The figures of one combination of settings.
#[derive(Clone, Debug, PartialEq)]
pub struct QualityRow {
    /// The value of each swept key, as it is written.
    pub settings: Vec<String>,
    /// A number for each column, the mean over the draws that have one; NaN where none has, as
    /// without a silhouette.
    pub numbers: Vec<f64>,
    /// The standard error of each mean; 0 for one draw, NaN where only one of several has a number.
    pub standard_errors: Vec<f64>,
}

/// The figures of all combinations.
#[derive(Clone, Debug, PartialEq)]
pub struct QualityTable {
    /// What was swept.
    pub sweeps: Vec<Sweep>,
    /// What the numbers of each row are.
    pub columns: Vec<Column>,
    /// A row for each combination, the last sweep running fastest.
    pub rows: Vec<QualityRow>,
    /// How many draws of the devices' random errors the numbers are means of.
    pub draws: u32,
    /// Rare events over all rays of the pictures.
    pub stats: TraceStats,
    /// The metadata of the first picture, and as `reference` the text of the scene that all are held against,
    /// where it is not the ideal.
    pub metadata: Vec<(String, String)>,
}

impl QualityTable {
    /// The place of a column, by its name.
    ///
    /// # Errors
    ///
    /// If there is no such column.
    pub fn column(&self, name: &str) -> Result<usize, UnknownColumn> {
        find_column(&self.columns, name)
    }
}

/// Pixels of pictures that are measured at once, at most.
const PIXELS_AT_ONCE: u64 = 1 << 22;

/// How many draws of a scene are measured at once: what one does on a single thread, another fills
/// up.
fn draws_at_once(scene: &Scene) -> usize {
    let [width, height] = scene.camera.resolution.map(u64::from);
    (PIXELS_AT_ONCE / (width * height)).clamp(1, 4) as usize
}

/// Whether the empty views of two scenes are the same.
fn same_view(one: &Scene, other: &Scene) -> bool {
    one.camera == other.camera
        && one.light.spectrum == other.light.spectrum
        && one.photograph == other.photograph
        && one.surroundings == other.surroundings
}

/// Renders the scene of every combination, its ideal or the reference and its empty view, and measures them; where
/// the scene is random, every draw of it.
///
/// # Errors
///
/// If a picture cannot be made or measured, or the work was stopped.
pub fn quality(
    plan: &SweepPlan,
    supervision: &Supervision<'_>,
) -> Result<QualityTable, QualityError> {
    let mut stats = TraceStats::default();
    let mut rows = Vec::new();
    let mut metadata = Vec::new();
    let mut images = Images::default();
    let mut last_empty: Option<(Scene, View)> = None;
    for Combination { settings, held, loaded } in &plan.scenes {
        let scene = &loaded.scene;
        let failed = |error| located(loaded, &error);
        let mut picture = |prepared: &PreparedScene<'_>| {
            let rendered = render(prepared, ChannelSet::Measures, supervision)?;
            stats += rendered.stats;
            Ok::<_, QualityError>(rendered.picture)
        };
        let empty = match last_empty.take() {
            Some((known, view)) if same_view(&known, scene) => {
                (supervision.rows_done)(u64::from(scene.camera.resolution[1]));
                view
            }
            _ => View::of(&picture(
                &PreparedScene::with_images(&empty(scene), &mut images).map_err(failed)?,
            )?)?,
        };
        let wanted_scene = plan.wanted(scene);
        let wanted_prepared =
            PreparedScene::with_images(&wanted_scene, &mut images).map_err(failed)?;
        let wanted = if wanted_scene.devices.is_empty() {
            (supervision.rows_done)(u64::from(scene.camera.resolution[1]));
            empty.clone()
        } else {
            View::of(&picture(&wanted_prepared)?)?
        };
        let mut statistics = Statistics::default();
        let draws: Vec<Scene> = (0..plan.draws_of(scene)).map(|draw| drawn(scene, draw)).collect();
        for scenes in draws.chunks(draws_at_once(scene)) {
            let prepared =
                scenes.iter().map(|scene| PreparedScene::with_images(scene, &mut images));
            let prepared = prepared.collect::<Result<Vec<_>, _>>().map_err(failed)?;
            let measured = prepared.par_iter().map(|prepared| {
                let rendered = render(prepared, ChannelSet::Measures, supervision)?;
                let view = View::of(&rendered.picture)?;
                let rays = survey(prepared, &wanted_prepared, supervision)?;
                let measured = Measured::of(&rendered.picture, &view, [&wanted, &empty], rays)?;
                Ok((measured.numbers(), rendered.stats, rendered.picture.metadata))
            });
            let measured: Vec<Result<_, QualityError>> = measured.collect();
            for measured in measured {
                let (numbers, rare, of_first) = measured?;
                statistics.add(&numbers.numbers);
                stats += rare;
                if metadata.is_empty() {
                    metadata = of_first;
                }
            }
        }
        let of_held = |other: f64| std::iter::repeat_n(other, held.len());
        rows.push(QualityRow {
            settings: settings.clone(),
            numbers: held.iter().copied().chain(statistics.means()).collect(),
            standard_errors: of_held(0.0).chain(statistics.standard_errors()).collect(),
        });
        last_empty = Some((scene.clone(), empty));
    }
    let reference = plan.reference.as_ref();
    metadata.extend(reference.map(|scene| ("reference".to_owned(), scene.source.clone())));
    let (sweeps, columns) = (plan.sweeps.clone(), plan.columns());
    Ok(QualityTable { sweeps, columns, rows, draws: plan.draws, stats, metadata })
}
