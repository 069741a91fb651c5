//! `cloakroom compare`: how alike two pictures are.

use crate::arguments::CompareArguments;
use crate::report::{self, Failure, Result, decimals};
use crate::scene;
use cloakroom::measure::{Comparison, Figures, MeasureError, PixelMask, View, compare};
use std::fmt::Write;

/// Compares two pictures.
pub fn run(arguments: &CompareArguments) -> Result<()> {
    scene::use_threads(&arguments.threads)?;
    let (first, second) = (View::read(&arguments.first)?, View::read(&arguments.second)?);
    let region = match (&arguments.mask, arguments.region) {
        (Some(mask), _) => {
            Some(PixelMask::bright(&View::read(mask)?).map_err(|error| match error {
                MeasureError::EmptyRegion => {
                    Failure::Failed(format!("{}: nothing in this mask is white", mask.display()))
                }
                error => error.into(),
            })?)
        }
        (None, Some(rectangle)) => Some(PixelMask::rectangle(&first, rectangle)?),
        (None, None) => None,
    };
    let comparison = compare(&first, &second, region.as_ref()).map_err(|error| match error {
        MeasureError::SizesDiffer { .. } => Failure::Failed(format!(
            "pictures to be compared, and a mask, must be of one size; {error}"
        )),
        error => error.into(),
    })?;
    if arguments.json {
        return report::print_json(&comparison);
    }
    report::print(&table(&comparison)?)
}

/// The figures for people: a column for the picture, and one for the region.
fn table(comparison: &Comparison) -> Result<String, std::fmt::Error> {
    let columns: Vec<&Figures> =
        [Some(&comparison.picture), comparison.region.as_ref()].into_iter().flatten().collect();
    let mut text = String::new();
    let mut row = |name: &str, value: &dyn Fn(&Figures) -> String| {
        write!(text, "{name:<36}")?;
        for figures in &columns {
            write!(text, " {:>26}", value(figures))?;
        }
        writeln!(text)
    };
    row("", &|f| if std::ptr::eq(f, columns[0]) { "picture" } else { "region" }.to_owned())?;
    row("pixels", &|f| f.pixels.to_string())?;
    row("correlation (R G B)", &|f| triple(f.correlation.map(|c| number(c, 5))))?;
    row("  at the best shift", &|f| {
        triple(f.correlation_maximum.map(|best| number(best.map(|b| b.correlation), 5)))
    })?;
    row("  best shift (right,down; pixels)", &|f| {
        triple(f.correlation_maximum.map(|best| {
            best.map_or("-".to_owned(), |b| format!("{},{}", b.shift_pixels[0], b.shift_pixels[1]))
        }))
    })?;
    row("rms difference, linear light", &|f| triple(f.rms_difference.map(|d| number(Some(d), 5))))?;
    row("structural similarity (SSIM)", &|f| number(Some(f.structural_similarity), 5))?;
    row("FLIP", &|f| number(Some(f.flip), 5))?;
    if columns.iter().any(|f| f.time_of_flight_difference.is_some()) {
        let time = |f: &Figures, value: &dyn Fn(cloakroom::measure::FlightFigures) -> f64| {
            f.time_of_flight_difference.map_or("-".to_owned(), |t| format!("{:.4e}", value(t)))
        };
        row("time of flight: largest (ns)", &|f| time(f, &|t| t.maximum_ns))?;
        row("  largest share of the flight", &|f| time(f, &|t| t.maximum_relative))?;
        row("  mean (ns)", &|f| time(f, &|t| t.mean_ns))?;
        row("  rms about the mean (ns)", &|f| time(f, &|t| t.rms_about_mean_ns))?;
    }
    if columns.iter().any(|f| f.delivered.iter().any(Option::is_some)) {
        row("power from the photograph", &|f| f.delivered.map(|p| number(p, 5)).join("  "))?;
    }
    Ok(text)
}

fn triple(words: [String; 3]) -> String {
    words.join("  ")
}

fn number(value: Option<f64>, places: usize) -> String {
    value.map_or("-".to_owned(), |value| decimals(value, places))
}
