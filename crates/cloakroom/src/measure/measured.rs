//! What is measured of one scene, as named numbers.

use super::{
    Column, Comparison, Figures, FlightFigures, MeasureError, PixelMask, Survey, View, compare,
};
use crate::output::Picture;

/// All that is measured of one combination; nothing by default.
#[derive(Debug, Default)]
pub(super) struct Measured {
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
    pub fn of(
        shown: &Picture,
        view: &View,
        [wanted, empty]: [&View; 2],
        rays: Survey,
    ) -> Result<Self, MeasureError> {
        let silhouette = PixelMask::new(view.width, rays.silhouette.clone()).ok();
        let share = silhouette.as_ref().map_or(0.0, PixelMask::share);
        let with_wanted = compare(wanted, view, silhouette.as_ref())?;
        // What stands edge-on is often not to be seen.
        let with_empty = if wanted.light == empty.light {
            with_wanted.clone()
        } else {
            compare(empty, view, silhouette.as_ref())?
        };
        let likeness = [with_wanted, with_empty].map(Some);
        let Some(region) = silhouette else {
            return Ok(Self { silhouette_share: Some(share), likeness, ..Self::default() });
        };
        let power = |(name, _)| {
            let samples = &shown.channel(name)?.samples;
            Some(region.mean(|i| samples.get(i)))
        };
        Ok(Self {
            silhouette_share: Some(share),
            likeness,
            rays: Some(rays),
            powers: POWERS.map(power),
            flight: FlightFigures::delays(view, &region),
        })
    }

    /// The numbers in the order of the columns.
    pub fn numbers(&self) -> Numbers {
        let mut list = Numbers::default();
        let rays = |value: fn(&Survey) -> Option<f64>| self.rays.as_ref().and_then(value);
        list.add("in_place_share", "Share in place", "", rays(Survey::in_place_share));
        list.add("silhouette_share", "Silhouette's share", "", self.silhouette_share);
        let words = [("ideal", "Ideal"), ("empty", "Empty view")];
        for ((name, word), likeness) in words.into_iter().zip(&self.likeness) {
            let whole = likeness.as_ref().map(|l| &l.picture);
            list.likeness(&format!("{name}_picture"), &format!("{word}, picture"), whole);
            let part = likeness.as_ref().and_then(|l| l.region.as_ref());
            list.likeness(&format!("{name}_silhouette"), word, part);
        }
        let turned = rays(|rays| rays.direction_error_rms_deg);
        list.add("displacement_rms_cm", "RMS displacement", "cm", rays(|r| r.displacement_rms_cm));
        list.add("direction_error_rms_deg", "RMS direction error", "°", turned);
        list.add("uncloaked_share", "Uncloaked share", "", rays(|rays| rays.uncloaked_share));
        let area = rays(|rays| Some(rays.uncloaked_area_cm2));
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
pub(super) struct Numbers {
    pub columns: Vec<Column>,
    pub numbers: Vec<f64>,
}

impl Numbers {
    fn add(&mut self, name: &str, title: &str, unit: &'static str, number: Option<f64>) {
        self.columns.push(Column { name: name.to_owned(), title: title.to_owned(), unit });
        self.numbers.push(number.unwrap_or(f64::NAN));
    }

    /// The likeness with a view; `with` says which, and over what if not over the silhouette.
    fn likeness(&mut self, prefix: &str, with: &str, figures: Option<&Figures>) {
        // A title must fit beside a panel; the ideal over the silhouette goes without saying.
        let title = |word: &str| match with {
            "Ideal" => word.to_owned(),
            _ => format!("{word} ({with})"),
        };
        let mut add = |what: &str, title: &str, number| {
            self.add(&format!("{prefix}_{what}"), title, "", number);
        };
        let plain = figures.map_or([None; 3], |f| f.correlation);
        let best = figures.map_or([None; 3], |f| f.correlation_maximum);
        let best = best.map(|best| best.map(|best| best.correlation));
        for (what, word, values) in [
            ("correlation", "Correlation", plain),
            ("correlation_maximum", "Best correlation", best),
        ] {
            let mean = match values {
                [Some(r), Some(g), Some(b)] => Some((r + g + b) / 3.0),
                _ => None,
            };
            let title = title(word);
            add(what, &title, mean);
            for (color, value) in ["red", "green", "blue"].into_iter().zip(values) {
                add(&format!("{what}_{color}"), &format!("{title}, {color}"), value);
            }
        }
        let similarity = figures.map(|f| f.structural_similarity);
        add("structural_similarity", &title("SSIM"), similarity);
        add("flip", &title("FLIP"), figures.map(|f| f.flip));
    }
}
