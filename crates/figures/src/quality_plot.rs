//! Tables of quality as plots, and files of any kind.

use crate::quantity::with_unit;
use crate::{Curve, CurvePoint, DrawingFormat, IllustrationError, Plot, PlotPanel};
use cloakroom::measure::{QualityRow, QualityTable, combinations, name_and_unit};
use cloakroom::output::{OutputError, format_of};
use std::path::Path;

/// What a plot shows unless it is told otherwise.
pub const STANDARD_PLOT: [&str; 3] =
    ["ideal_silhouette_correlation", "displacement_rms_cm", "delivered"];

/// What figures of a table know no better, in their units: correlations, shares, cm.
const ROUNDING: f64 = 1e-9;

/// A format of files of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// Comma-separated values: a line of names, then one line a row; empty where there is no
    /// number.
    Csv,
    /// An array for each column and for each sweep of numbers; NaN where there is no number.
    Npz,
    /// A plot, as pixels 600 an inch at the width of a column.
    Plot(DrawingFormat),
}

impl TableFormat {
    /// The format that the ending of a file's name asks for.
    ///
    /// # Errors
    ///
    /// [`OutputError::UnknownFormat`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        let [svg, pdf, png] =
            [DrawingFormat::Svg, DrawingFormat::Pdf, DrawingFormat::Png].map(Self::Plot);
        let data = [("csv", Self::Csv), ("npz", Self::Npz)];
        format_of(path, &[data[0], data[1], ("svg", svg), ("pdf", pdf), ("png", png)])
    }
}

/// Writes the table in a format; a plot shows the columns of these names.
///
/// # Errors
///
/// If the file cannot be written, or there is no such column.
pub fn write_table(
    table: &QualityTable,
    format: TableFormat,
    plotted: &[String],
    path: &Path,
) -> Result<(), IllustrationError> {
    match format {
        TableFormat::Csv => table.write_csv(path)?,
        TableFormat::Npz => table.write_npz(path)?,
        TableFormat::Plot(format) => {
            let drawing = quality_plot(table, plotted)?.draw();
            // On paper, 600 an inch.
            let pixels = drawing.size * drawing.mm * 600.0 / 25.4;
            let pixels = pixels.round().to_array().map(|side| side as u32);
            drawing.write(format, "Cloaking quality", &table.metadata, pixels, path)?;
        }
    }
    Ok(())
}

/// A plot of the columns of these names over the first sweep of several numbers, else over the
/// first of several values; a curve for each combination of the others, with standard errors as
/// error bars.
///
/// # Errors
///
/// If there is no such column.
pub fn quality_plot(table: &QualityTable, names: &[String]) -> Result<Plot, IllustrationError> {
    let several = |i: &usize| table.sweeps[*i].values.len() > 1;
    let all = || (0..table.sweeps.len()).filter(several);
    let axis = all().find(|i| table.sweeps[*i].numbers().is_some()).or_else(|| all().next());
    let numbers = axis.and_then(|i| table.sweeps[i].numbers());
    let categories = match axis {
        Some(i) if numbers.is_none() => table.sweeps[i].values.clone(),
        _ => Vec::new(),
    };
    let chosen = combinations(&table.sweeps).unwrap_or_default();
    let mut curves: Vec<(Vec<usize>, String)> = Vec::new();
    let others = |chosen: &[usize]| -> Vec<usize> {
        (0..chosen.len()).filter(|i| Some(*i) != axis).map(|i| chosen[i]).collect()
    };
    for (chosen, row) in chosen.iter().zip(&table.rows) {
        let other = others(chosen);
        if !curves.iter().any(|(known, _)| *known == other) {
            let words = all().filter(|i| Some(*i) != axis).map(|i| {
                let key = &table.sweeps[i].key;
                let short = key.rsplit('.').next().unwrap_or(key);
                format!("{short} {}", row.settings[i].trim_matches(['"', '\'']))
            });
            curves.push((other, words.collect::<Vec<_>>().join(", ")));
        }
    }
    let panel = |name: &String| {
        let index = table.column(name)?;
        let point = |(chosen, row): (&Vec<usize>, &QualityRow)| {
            let place = axis.map_or(0, |i| chosen[i]);
            let x = numbers.as_ref().map_or(place as f64, |numbers| numbers[place]);
            let error = Some(row.standard_errors[index]).filter(|error| error.is_finite());
            CurvePoint { x, y: row.numbers[index], error: error.unwrap_or(0.0) }
        };
        let curve = |(other, label): &(Vec<usize>, String)| {
            let rows = chosen.iter().zip(&table.rows);
            let mut points: Vec<CurvePoint> =
                rows.filter(|(chosen, _)| others(chosen) == *other).map(point).collect();
            points.sort_by(|a, b| a.x.total_cmp(&b.x));
            Curve { label: label.clone(), points }
        };
        let column = &table.columns[index];
        Ok(PlotPanel {
            title: with_unit(&column.title, column.unit),
            rounding: ROUNDING,
            curves: curves.iter().map(curve).collect(),
        })
    };
    // The name of the swept key in words, with the unit that keys of that name have.
    let axis_title = |i: usize| {
        let (title, unit) = name_and_unit(&table.sweeps[i].key);
        // Words are of no unit.
        with_unit(&title, if numbers.is_some() { unit } else { "" })
    };
    Ok(Plot {
        axis: axis.map_or_else(String::new, axis_title),
        categories,
        panels: names.iter().map(panel).collect::<Result<_, IllustrationError>>()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloakroom::measure::{Column, QualityRow, Sweep};
    use cloakroom::trace::TraceStats;

    fn table() -> QualityTable {
        let sweep = |text: &str| Sweep::parse(text).expect("a sweep");
        let sweeps =
            vec![sweep("camera.polarizer=horizontal,vertical"), sweep("device.0.rotation=0..10:5")];
        let rows = combinations(&sweeps).expect("few").into_iter().map(|chosen| QualityRow {
            settings: sweeps.iter().zip(&chosen).map(|(s, i)| s.values[*i].clone()).collect(),
            numbers: vec![chosen[1] as f64, if chosen == [1, 2] { f64::NAN } else { 0.5 }],
            standard_errors: vec![0.25; 2],
        });
        let column = |name: &str, title: &str, unit| Column {
            name: name.to_owned(),
            title: title.to_owned(),
            unit,
        };
        QualityTable {
            rows: rows.collect(),
            columns: vec![
                column("displacement_rms_cm", "RMS displacement", "cm"),
                column("delivered", "Power", ""),
            ],
            sweeps,
            draws: 1,
            stats: TraceStats::default(),
            metadata: vec![("scene".to_owned(), "# a scene".to_owned())],
        }
    }

    #[test]
    fn files_hold_the_table() {
        let folder = tempfile::tempdir().expect("a folder");
        let plotted = ["displacement_rms_cm".to_owned()];
        for name in ["a.csv", "a.npz", "a.svg", "a.pdf", "a.png"] {
            let path = folder.path().join(name);
            let format = TableFormat::of(&path).expect(name);
            write_table(&table(), format, &plotted, &path).expect(name);
            assert!(path.exists());
        }
        let svg = std::fs::read_to_string(folder.path().join("a.svg")).expect("a file");
        assert!(svg.contains("<svg") && svg.contains("# a scene"));
        let png = image::open(folder.path().join("a.png")).expect("an image").into_rgb8();
        assert_eq!(png.width(), 2031);
        let pdf = std::fs::read(folder.path().join("a.pdf")).expect("a file");
        assert!(pdf.starts_with(b"%PDF-"));
    }

    #[test]
    fn plots_run_over_the_numbers() {
        let plot = quality_plot(&table(), &["delivered".to_owned()]).expect("a plot");
        assert_eq!((plot.axis.as_str(), plot.categories.len()), ("Rotation (°)", 0));
        let labels: Vec<&str> = plot.panels[0].curves.iter().map(|c| c.label.as_str()).collect();
        assert_eq!(labels, ["polarizer horizontal", "polarizer vertical"]);
        let xs: Vec<f64> = plot.panels[0].curves[1].points.iter().map(|p| p.x).collect();
        assert_eq!(xs, [0.0, 5.0, 10.0]);
        let message =
            quality_plot(&table(), &["delivred".to_owned()]).expect_err("unknown").to_string();
        assert!(message.contains("did you mean `delivered`"), "{message}");
        let mut words = table();
        words.sweeps.pop();
        words.rows.truncate(2);
        let plot = quality_plot(&words, &["delivered".to_owned()]).expect("a plot");
        assert_eq!(plot.categories, ["horizontal", "vertical"]);
    }
}
