//! How well the devices of a scene do what they are for, over a range of settings.

use super::sweep::{Sweep, SweepError, combinations};
use super::{
    Comparison, Figures, FlightFigures, MeasureError, Region, Survey, View, compare, survey,
};
use crate::device::{Request, Show};
use crate::keys::hint;
use crate::output::Picture;
use crate::render::{RenderError, Studio, StudioError, Supervision, Wanted, bench, render};
use crate::scene::Scene;
use crate::scene_file::{Loaded, SceneFileError};
use crate::trace::Rarities;

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum QualityError {
    /// The sweeps make no sense.
    #[error("{0}")]
    Sweep(#[from] SweepError),
    /// A scene cannot be read or built.
    #[error("{}", in_sweep(.0))]
    Scene(Box<SceneFileError>),
    /// A picture cannot be made, or the work was stopped.
    #[error("{0}")]
    Render(#[from] RenderError),
    /// A picture cannot be measured.
    #[error("{0}")]
    Measure(#[from] MeasureError),
}

/// The message of an error in an override: here, those are the swept values.
fn in_sweep(error: &SceneFileError) -> String {
    error.to_string().replacen("--set ", "--set or --sweep ", 1)
}

/// There is no such figure.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no figure `{name}`{hint}")]
pub struct UnknownColumn {
    /// The name asked for.
    name: String,
    /// What may have been meant.
    hint: String,
}

/// One figure of a table: what it is called in files, and in words.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Column {
    /// Its name in files, with the unit.
    pub name: String,
    /// What it is, for the axis of a plot.
    pub title: String,
    /// Its unit, as plots write it; empty for a bare number.
    pub unit: &'static str,
}

/// The figures of one combination of settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The value of each swept key, as it is written.
    pub settings: Vec<String>,
    /// A number for each column; NaN where there is none, as without a silhouette.
    pub numbers: Vec<f64>,
}

/// The figures of all combinations.
#[derive(Clone, Debug, PartialEq)]
pub struct QualityTable {
    /// What was swept.
    pub sweeps: Vec<Sweep>,
    /// What the numbers of each row are.
    pub columns: Vec<Column>,
    /// A row for each combination, the last sweep running fastest.
    pub rows: Vec<Row>,
    /// Rare events over all rays of the pictures.
    pub rarities: Rarities,
    /// The metadata of the first picture.
    pub metadata: Vec<(String, String)>,
}

impl QualityTable {
    /// The place of a column, by its name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }
}

/// A sweep with all its scenes read.
#[derive(Debug)]
pub struct Plan {
    sweeps: Vec<Sweep>,
    scenes: Vec<(Vec<String>, Loaded)>,
}

impl Plan {
    /// Reads the scene of every combination; `load` reads the scene with further overrides, such as
    /// `device.0.rotation=5`. Every scene is built once, so that what cannot be is told before the work.
    ///
    /// # Errors
    ///
    /// If the sweeps make no sense, or a scene cannot be read or built.
    pub fn new(
        sweeps: Vec<Sweep>,
        load: impl Fn(&[String]) -> Result<Loaded, SceneFileError>,
    ) -> Result<Self, QualityError> {
        let scene = |chosen: Vec<usize>| {
            let settings: Vec<String> =
                sweeps.iter().zip(chosen).map(|(sweep, i)| sweep.values[i].clone()).collect();
            let assignment = |(sweep, value): (&Sweep, &String)| format!("{}={value}", sweep.key);
            let overrides: Vec<String> = sweeps.iter().zip(&settings).map(assignment).collect();
            let loaded = load(&overrides).map_err(|error| QualityError::Scene(Box::new(error)))?;
            bench(&loaded.scene).map_err(|error| located(&loaded, &error))?;
            Ok((settings, loaded))
        };
        let scenes = combinations(&sweeps)?.into_iter().map(scene);
        let scenes = scenes.collect::<Result<Vec<_>, QualityError>>()?;
        Ok(Self { sweeps, scenes })
    }

    /// The steps of its progress: the rows of all pictures.
    #[must_use]
    pub fn steps(&self) -> u64 {
        let rows = |(_, loaded): &(_, Loaded)| u64::from(loaded.scene.camera.resolution()[1]);
        PICTURES * self.scenes.iter().map(rows).sum::<u64>()
    }

    /// Checks before the work that a table will have columns of these names.
    ///
    /// # Errors
    ///
    /// If one has not.
    pub fn check_columns(&self, names: &[String]) -> Result<(), UnknownColumn> {
        let columns = columns();
        names.iter().try_for_each(|name| find_column(&columns, name).map(drop))
    }

    /// How many combinations there are.
    #[must_use]
    pub fn combinations(&self) -> usize {
        self.scenes.len()
    }
}

/// The place of a column by its name.
pub(super) fn find_column(columns: &[Column], name: &str) -> Result<usize, UnknownColumn> {
    columns.iter().position(|column| column.name == name).ok_or_else(|| {
        let known: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        UnknownColumn { name: name.to_owned(), hint: hint(name, &known, "known figures") }
    })
}

/// Rows of the scene, of the ideal and of the empty view, and of the survey of rays.
const PICTURES: u64 = 4;

fn located(loaded: &Loaded, error: &StudioError) -> QualityError {
    QualityError::Scene(Box::new(loaded.locations.error_at(&error.key(), error.to_string())))
}

/// What a scene should look like: its cloaks as the flat mirrors that they imitate, and nothing in the place of
/// other devices.
#[must_use]
pub fn ideal(scene: &Scene) -> Scene {
    let mut ideal = scene.clone();
    ideal.devices.retain_mut(|device| {
        let request = Request { show: Show::Mirror, open_core: false, length: device.length };
        device.show = Show::Mirror;
        device.open_core = false;
        (device.entry.build)(&device.values, request).is_ok_and(|built| !built.skin.is_empty())
    });
    ideal
}

/// A scene without its devices.
#[must_use]
pub fn empty(scene: &Scene) -> Scene {
    Scene { devices: Vec::new(), ..scene.clone() }
}

/// Whether the empty views of two scenes are the same.
fn same_view(one: &Scene, other: &Scene) -> bool {
    one.camera == other.camera
        && one.photograph == other.photograph
        && one.surroundings == other.surroundings
}

/// Renders the scene of every combination, its ideal and its empty view, and measures them.
///
/// # Errors
///
/// If a picture cannot be made or measured, or the work was stopped.
pub fn quality(plan: &Plan, supervision: &Supervision<'_>) -> Result<QualityTable, QualityError> {
    let mut rarities = Rarities::default();
    let mut rows = Vec::new();
    let mut metadata = Vec::new();
    let mut last_empty: Option<(Scene, View)> = None;
    for (settings, loaded) in &plan.scenes {
        let scene = &loaded.scene;
        let done = |rows| (supervision.rows_done)(rows);
        let picture = |scene: &Scene, rarities: &mut Rarities| {
            let studio = Studio::new(scene).map_err(|error| located(loaded, &error))?;
            let rendered = render(&studio, Wanted::Everything, supervision)?;
            *rarities += rendered.rarities;
            Ok::<_, QualityError>(rendered.picture)
        };
        let shown = picture(scene, &mut rarities)?;
        let view = View::of(&shown)?;
        let empty = match last_empty.take() {
            Some((known, view)) if same_view(&known, scene) => {
                done(u64::from(scene.camera.resolution()[1]));
                view
            }
            _ => View::of(&picture(&empty(scene), &mut rarities)?)?,
        };
        let wanted_scene = ideal(scene);
        let wanted = if wanted_scene.devices.is_empty() {
            done(u64::from(scene.camera.resolution()[1]));
            empty.clone()
        } else {
            View::of(&picture(&wanted_scene, &mut rarities)?)?
        };
        let rays = {
            let [studio, ideal] = [scene, &wanted_scene]
                .map(|scene| Studio::new(scene).map_err(|error| located(loaded, &error)));
            survey(&studio?, &ideal?, &scene.camera, supervision.rows_done, supervision.stop)
                .ok_or(RenderError::Stopped)?
        };
        let measured = Measured::of(&shown, &view, [&wanted, &empty], rays)?;
        rows.push(Row { settings: settings.clone(), numbers: measured.numbers().numbers });
        if metadata.is_empty() {
            metadata = shown.metadata;
        }
        last_empty = Some((scene.clone(), empty));
    }
    let columns = columns();
    Ok(QualityTable { sweeps: plan.sweeps.clone(), columns, rows, rarities, metadata })
}

/// All that is measured of one combination; nothing by default.
#[derive(Debug, Default)]
struct Measured {
    silhouette_share: Option<f64>,
    /// With the ideal and with the empty view.
    likeness: [Option<Comparison>; 2],
    /// From rays; `None` without a silhouette.
    rays: Option<Survey>,
    /// Means over the silhouette of the channels [`POWERS`].
    powers: [Option<f64>; 4],
    flight: Option<FlightFigures>,
}

/// The channels of powers, and what they are called.
const POWERS: [(&str, &str); 4] = [
    ("delivered", "Power from the photograph"),
    ("escaped", "Power from the surroundings"),
    ("absorbed", "Power absorbed"),
    ("pruned", "Power pruned"),
];

/// What the numbers of each row are.
#[must_use]
pub fn columns() -> Vec<Column> {
    Measured::default().numbers().columns
}

impl Measured {
    fn of(
        shown: &Picture,
        view: &View,
        [wanted, empty]: [&View; 2],
        rays: Survey,
    ) -> Result<Self, MeasureError> {
        let silhouette = Region::new(view.width, rays.silhouette.clone()).ok();
        let share = silhouette.as_ref().map_or(0.0, Region::share);
        let likeness = [
            Some(compare(wanted, view, silhouette.as_ref())?),
            Some(compare(empty, view, silhouette.as_ref())?),
        ];
        let Some(region) = silhouette else {
            return Ok(Self { silhouette_share: Some(share), likeness, ..Self::default() });
        };
        let power = |(name, _)| {
            let samples = &shown.channel(name)?.samples;
            let sum: f64 = region.indices().map(|i| samples.get(i)).sum();
            Some(sum / region.pixels() as f64)
        };
        let times = view.time_of_flight.as_ref().zip(view.time_of_flight_difference.as_ref());
        let flight = times.and_then(|(times, differences)| {
            let pair = |i: usize| (differences[i], times[i] - differences[i]);
            FlightFigures::of(region.indices().map(pair))
        });
        Ok(Self {
            silhouette_share: Some(share),
            likeness,
            rays: Some(rays),
            powers: POWERS.map(power),
            flight,
        })
    }

    /// The numbers in the order of the columns.
    fn numbers(&self) -> Numbers {
        let mut list = Numbers::default();
        list.add("silhouette_share", "Silhouette's share", "", self.silhouette_share);
        let words = [("ideal", "Ideal"), ("empty", "Empty view")];
        for ((name, word), likeness) in words.into_iter().zip(&self.likeness) {
            let whole = likeness.as_ref().map(|l| &l.picture);
            list.likeness(&format!("{name}_picture"), &format!("{word}, picture"), whole);
            let part = likeness.as_ref().and_then(|l| l.region.as_ref());
            list.likeness(&format!("{name}_silhouette"), word, part);
        }
        let rays = self.rays.as_ref();
        let off = rays.and_then(|rays| rays.displacement_rms_cm);
        list.add("displacement_rms_cm", "RMS displacement", "cm", off);
        let turned = rays.and_then(|rays| rays.direction_error_rms_deg);
        list.add("direction_error_rms_deg", "RMS direction error", "°", turned);
        let share = rays.and_then(|rays| rays.uncloaked_share);
        list.add("uncloaked_share", "Uncloaked share", "", share);
        let area = rays.map(|rays| rays.uncloaked_area_cm2);
        list.add("uncloaked_area_cm2", "Uncloaked area", "cm²", area);
        for ((name, title), power) in POWERS.into_iter().zip(self.powers) {
            list.add(name, title, "", power);
        }
        let time = |value: &dyn Fn(FlightFigures) -> f64| self.flight.map(value);
        let mut flight = |what: &str, title: &str, unit, number| {
            list.add(&format!("time_of_flight_difference_{what}"), title, unit, number);
        };
        flight("maximum_ns", "Largest delay", "ns", time(&|f| f.maximum_ns));
        flight("maximum_relative", "Largest delay / flight", "", time(&|f| f.maximum_relative));
        flight("mean_ns", "Mean delay", "ns", time(&|f| f.mean_ns));
        flight("rms_about_mean_ns", "RMS delay", "ns", time(&|f| f.rms_about_mean_ns));
        list
    }
}

/// Numbers with what they are.
#[derive(Debug, Default)]
struct Numbers {
    columns: Vec<Column>,
    numbers: Vec<f64>,
}

impl Numbers {
    fn add(&mut self, name: &str, title: &str, unit: &'static str, number: Option<f64>) {
        self.columns.push(Column { name: name.to_owned(), title: title.to_owned(), unit });
        self.numbers.push(number.unwrap_or(f64::NAN));
    }

    /// The likeness with a view; `with` says which, and over what if not over the silhouette.
    fn likeness(&mut self, prefix: &str, with: &str, figures: Option<&Figures>) {
        let name = |what: &str| format!("{prefix}_{what}");
        let mean = |values: [Option<f64>; 3]| match values {
            [Some(r), Some(g), Some(b)] => Some((r + g + b) / 3.0),
            _ => None,
        };
        let plain = figures.map_or([None; 3], |f| f.correlation);
        let best = figures.map_or([None; 3], |f| f.correlation_maximum);
        let best = best.map(|best| best.map(|best| best.correlation));
        for (what, word, values) in [
            ("correlation", "Correlation", plain),
            ("correlation_maximum", "Best correlation", best),
        ] {
            // A title must fit beside a panel; the ideal over the silhouette goes without saying.
            let title = if with == "Ideal" { word.to_owned() } else { format!("{word} ({with})") };
            self.add(&name(what), &title, "", mean(values));
            for (color, value) in ["red", "green", "blue"].into_iter().zip(values) {
                self.add(
                    &name(&format!("{what}_{color}")),
                    &format!("{title}, {color}"),
                    "",
                    value,
                );
            }
        }
        for (what, word, value) in [
            ("structural_similarity", "SSIM", figures.map(|f| f.structural_similarity)),
            ("flip", "FLIP", figures.map(|f| f.flip)),
        ] {
            let title = if with == "Ideal" { word.to_owned() } else { format!("{word} ({with})") };
            self.add(&name(what), &title, "", value);
        }
    }
}
