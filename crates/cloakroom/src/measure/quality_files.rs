//! Tables of quality as files: CSV, NPZ, and plots.

use super::quality::{QualityTable, UnknownColumn, find_column};
use super::sweep::combinations;
use crate::illustration::{Curve, CurvePoint, Drawing, IllustrationError, Plot, PlotPanel};
use crate::output::{OutputError, ending, write_png, write_whole};
use ndarray::ArrayView1;
use ndarray_npy::NpzWriter;
use std::io;
use std::path::Path;

/// What a plot shows unless it is told otherwise.
pub const STANDARD_PLOT: [&str; 3] =
    ["ideal_silhouette_correlation", "displacement_rms_cm", "delivered"];

/// Pixels of a plot's raster in one unit of its drawing: 600 an inch.
const PIXELS_PER_UNIT: f64 = 600.0 / 508.0;

/// A format of files of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// Comma-separated values: a line of names, then one line a row; empty where there is no number.
    Csv,
    /// An array for each column and for each sweep of numbers; NaN where there is no number.
    Npz,
    /// A plot as lines.
    Svg,
    /// A plot as pixels, 600 an inch at the width of a column.
    Png,
}

/// Why a table cannot be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// There is no such column.
    #[error("{0}")]
    UnknownColumn(#[from] UnknownColumn),
    /// The plot does not fit into the memory.
    #[error("{0}")]
    Drawing(#[from] IllustrationError),
    /// The file cannot be written.
    #[error("{0}")]
    Output(#[from] OutputError),
}

impl TableFormat {
    /// The format that the ending of a file's name asks for.
    ///
    /// # Errors
    ///
    /// [`OutputError::UnknownFormat`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        match ending(path).as_deref() {
            Some("csv") => Ok(Self::Csv),
            Some("npz") => Ok(Self::Npz),
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(OutputError::unknown_format(path, ".csv, .npz, .svg or .png")),
        }
    }
}

impl QualityTable {
    /// Writes the table in a format; a plot shows the columns of these names.
    ///
    /// # Errors
    ///
    /// If the file cannot be written, or there is no such column.
    pub fn write(
        &self,
        format: TableFormat,
        plotted: &[String],
        path: &Path,
    ) -> Result<(), TableError> {
        match format {
            TableFormat::Csv => self.write_csv(path)?,
            TableFormat::Npz => self.write_npz(path)?,
            TableFormat::Svg | TableFormat::Png => {
                let drawing: Drawing = self.plot(plotted)?.draw();
                let pixels = (drawing.size * PIXELS_PER_UNIT).round();
                let size = [pixels.x as u32, pixels.y as u32];
                if format == TableFormat::Png {
                    write_png(&drawing.to_image(size)?, &self.metadata, path)?;
                } else {
                    let svg = drawing.to_svg(size, "Cloaking quality", &self.metadata);
                    write_whole(path, |out| out.write_all(svg.as_bytes()))?;
                }
            }
        }
        Ok(())
    }

    fn write_csv(&self, path: &Path) -> Result<(), OutputError> {
        write_whole(path, |out| {
            let mut table = csv::Writer::from_writer(out);
            let keys = self.sweeps.iter().map(|sweep| sweep.key.clone());
            let names = self.columns.iter().flat_map(|column| {
                let error = self.has_errors().then(|| error_name(&column.name));
                [Some(column.name.clone()), error].into_iter().flatten()
            });
            table.write_record(keys.chain(names))?;
            for row in &self.rows {
                let number = |n: &f64| if n.is_finite() { n.to_string() } else { String::new() };
                let numbers =
                    row.numbers.iter().zip(&row.standard_errors).flat_map(|(mean, error)| {
                        let error = self.has_errors().then(|| number(error));
                        [Some(number(mean)), error].into_iter().flatten()
                    });
                table.write_record(row.settings.iter().cloned().chain(numbers))?;
            }
            table.flush()
        })
    }

    fn write_npz(&self, path: &Path) -> Result<(), OutputError> {
        write_whole(path, |out| {
            let mut npz = NpzWriter::new(out);
            let mut add = |name: &str, values: &[f64]| {
                npz.add_array(name, &ArrayView1::from(values)).map_err(io::Error::other)
            };
            for (i, sweep) in self.sweeps.iter().enumerate() {
                if sweep.numbers().is_some() {
                    let value = |text: &String| text.parse().unwrap_or(f64::NAN);
                    let values: Vec<f64> =
                        self.rows.iter().map(|row| value(&row.settings[i])).collect();
                    add(&sweep.key, &values)?;
                }
            }
            for (i, column) in self.columns.iter().enumerate() {
                let values: Vec<f64> = self.rows.iter().map(|row| row.numbers[i]).collect();
                add(&column.name, &values)?;
                if self.has_errors() {
                    let errors: Vec<f64> =
                        self.rows.iter().map(|row| row.standard_errors[i]).collect();
                    add(&error_name(&column.name), &errors)?;
                }
            }
            let mut metadata: serde_json::Map<String, serde_json::Value> =
                self.metadata.iter().map(|(k, text)| (k.clone(), text.clone().into())).collect();
            let sweeps = serde_json::to_value(&self.sweeps).map_err(io::Error::other)?;
            metadata.insert("sweeps".to_owned(), sweeps);
            metadata.insert("draws".to_owned(), self.draws.into());
            let bytes = serde_json::to_vec(&metadata).map_err(io::Error::other)?;
            npz.add_array("metadata", &ArrayView1::from(&bytes[..])).map_err(io::Error::other)?;
            npz.finish().map_err(io::Error::other)?;
            Ok(())
        })
    }

    /// Whether its numbers are means with standard errors.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.draws > 1
    }

    /// The table as a JSON object: `sweeps`, `columns`, `draws`, and `rows` of `settings` and `figures` by name, and of
    /// their `standard_errors` where there are several draws; null where there is no number.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        let rows: Vec<serde_json::Value> = self
            .rows
            .iter()
            .map(|row| {
                let keys = self.sweeps.iter().map(|sweep| sweep.key.clone());
                let settings: serde_json::Map<String, serde_json::Value> =
                    keys.zip(row.settings.iter().map(|text| text.clone().into())).collect();
                let names = self.columns.iter().map(|column| column.name.clone());
                let named = |numbers: &[f64]| -> serde_json::Map<String, serde_json::Value> {
                    names.clone().zip(numbers.iter().map(|number| (*number).into())).collect()
                };
                let figures = named(&row.numbers);
                let mut row_object =
                    serde_json::json!({ "settings": settings, "figures": figures });
                if self.has_errors() {
                    row_object["standard_errors"] = named(&row.standard_errors).into();
                }
                row_object
            })
            .collect();
        serde_json::json!({
            "sweeps": self.sweeps, "columns": self.columns, "draws": self.draws, "rows": rows,
        })
    }

    /// A plot of the columns of these names over the first sweep of several numbers, else over the first of
    /// several values; a curve for each combination of the others, with standard errors as error bars.
    ///
    /// # Errors
    ///
    /// If there is no such column.
    pub fn plot(&self, names: &[String]) -> Result<Plot, TableError> {
        let several = |i: &usize| self.sweeps[*i].values.len() > 1;
        let all = || (0..self.sweeps.len()).filter(several);
        let axis = all().find(|i| self.sweeps[*i].numbers().is_some()).or_else(|| all().next());
        let numbers = axis.and_then(|i| self.sweeps[i].numbers());
        let categories = match axis {
            Some(i) if numbers.is_none() => self.sweeps[i].values.clone(),
            _ => Vec::new(),
        };
        let chosen = combinations(&self.sweeps).unwrap_or_default();
        let mut curves: Vec<(Vec<usize>, String)> = Vec::new();
        let others = |chosen: &[usize]| -> Vec<usize> {
            (0..chosen.len()).filter(|i| Some(*i) != axis).map(|i| chosen[i]).collect()
        };
        for (chosen, row) in chosen.iter().zip(&self.rows) {
            let other = others(chosen);
            if !curves.iter().any(|(known, _)| *known == other) {
                let words = all().filter(|i| Some(*i) != axis).map(|i| {
                    let key = &self.sweeps[i].key;
                    let short = key.rsplit('.').next().unwrap_or(key);
                    format!("{short} {}", row.settings[i].trim_matches(['"', '\'']))
                });
                curves.push((other, words.collect::<Vec<_>>().join(", ")));
            }
        }
        let panel = |name: &String| {
            let index = find_column(&self.columns, name)?;
            let point = |(chosen, row): (&Vec<usize>, &super::Row)| {
                let place = axis.map_or(0, |i| chosen[i]);
                let x = numbers.as_ref().map_or(place as f64, |numbers| numbers[place]);
                let error = Some(row.standard_errors[index]).filter(|error| error.is_finite());
                CurvePoint { x, y: row.numbers[index], error: error.unwrap_or(0.0) }
            };
            let curve = |(other, label): &(Vec<usize>, String)| {
                let rows = chosen.iter().zip(&self.rows);
                let mut points: Vec<CurvePoint> =
                    rows.filter(|(chosen, _)| others(chosen) == *other).map(point).collect();
                points.sort_by(|a, b| a.x.total_cmp(&b.x));
                Curve { label: label.clone(), points }
            };
            let column = &self.columns[index];
            Ok(PlotPanel {
                title: with_unit(&column.title, column.unit),
                curves: curves.iter().map(curve).collect(),
            })
        };
        Ok(Plot {
            axis: axis.map_or_else(String::new, |i| axis_title(&self.sweeps[i].key)),
            categories,
            panels: names.iter().map(panel).collect::<Result<_, TableError>>()?,
        })
    }
}

fn with_unit(title: &str, unit: &str) -> String {
    if unit.is_empty() { title.to_owned() } else { format!("{title} ({unit})") }
}

/// What the column of standard errors of a column is called.
fn error_name(name: &str) -> String {
    format!("{name}_standard_error")
}

/// What an axis says of a swept key: its name in words, with the unit that keys of that name have.
fn axis_title(key: &str) -> String {
    let (title, unit) = name_and_unit(key);
    with_unit(&title, unit)
}

/// The name of a key in words, and the unit that keys of that name have.
pub(super) fn name_and_unit(key: &str) -> (String, &'static str) {
    let name = key.rsplit('.').find(|part| part.parse::<usize>().is_err()).unwrap_or(key);
    let words = name.replace('_', " ");
    let mut letters = words.chars();
    let title = match letters.next() {
        // The symbols w and h of a map stay small.
        Some(first) if words.len() > 1 => first.to_uppercase().chain(letters).collect(),
        _ => words,
    };
    (title, unit_of(name))
}

/// The unit of a key, from the lists of keys.
fn unit_of(name: &str) -> &'static str {
    use crate::keys::KeyKind;
    let devices = crate::device::CATALOGUE.iter().map(|entry| entry.keys);
    let tables = [
        crate::scene::CAMERA_KEYS,
        crate::scene::PHOTOGRAPH_KEYS,
        crate::scene::PLACEMENT_KEYS,
        crate::device::IMPERFECTION_KEYS,
        crate::scene::LIGHT_KEYS,
        crate::scene::TRACE_KEYS,
    ];
    let keys = devices.chain(tables).flatten();
    let mut found = keys.filter(|key| key.name == name).filter_map(|key| match key.kind {
        KeyKind::Number { unit, .. } | KeyKind::ChoiceOrNumber { unit, .. } => Some(unit),
        _ => None,
    });
    match found.next() {
        Some("degrees") => "°",
        Some(unit) => unit,
        None => "",
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Column, Row, Sweep};
    use super::*;
    use crate::trace::Rarities;

    fn table() -> QualityTable {
        let sweep = |text: &str| Sweep::parse(text).expect("a sweep");
        let sweeps =
            vec![sweep("camera.polarizer=horizontal,vertical"), sweep("device.0.rotation=0..10:5")];
        let rows = combinations(&sweeps).expect("few").into_iter().map(|chosen| Row {
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
            rarities: Rarities::default(),
            metadata: vec![("scene".to_owned(), "# a scene".to_owned())],
        }
    }

    #[test]
    fn files_hold_the_table() {
        let folder = tempfile::tempdir().expect("a folder");
        let plotted = ["displacement_rms_cm".to_owned()];
        for name in ["a.csv", "a.npz", "a.svg", "a.png"] {
            let path = folder.path().join(name);
            let format = TableFormat::of(&path).expect(name);
            table().write(format, &plotted, &path).expect(name);
        }
        let text = std::fs::read_to_string(folder.path().join("a.csv")).expect("a file");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 7);
        assert_eq!(lines[0], "camera.polarizer,device.0.rotation,displacement_rms_cm,delivered");
        assert_eq!((lines[3], lines[6]), ("horizontal,10,2,0.5", "vertical,10,2,"));
        let file = std::fs::File::open(folder.path().join("a.npz")).expect("a file");
        let mut npz = ndarray_npy::NpzReader::new(file).expect("an archive");
        let rotation: ndarray::Array1<f64> = npz.by_name("device.0.rotation").expect("an array");
        assert_eq!(rotation.to_vec(), [0.0, 5.0, 10.0, 0.0, 5.0, 10.0]);
        let svg = std::fs::read_to_string(folder.path().join("a.svg")).expect("a file");
        assert!(svg.contains("<svg") && svg.contains("# a scene"));
        let png = image::open(folder.path().join("a.png")).expect("an image").into_rgb8();
        assert_eq!(png.width(), 2031);
    }

    #[test]
    fn plots_run_over_the_numbers() {
        let plot = table().plot(&["delivered".to_owned()]).expect("a plot");
        assert_eq!((plot.axis.as_str(), plot.categories.len()), ("Rotation (°)", 0));
        let labels: Vec<&str> = plot.panels[0].curves.iter().map(|c| c.label.as_str()).collect();
        assert_eq!(labels, ["polarizer horizontal", "polarizer vertical"]);
        let xs: Vec<f64> = plot.panels[0].curves[1].points.iter().map(|p| p.x).collect();
        assert_eq!(xs, [0.0, 5.0, 10.0]);
        let message = table().plot(&["delivred".to_owned()]).expect_err("unknown").to_string();
        assert!(message.contains("did you mean `delivered`"), "{message}");
        let mut words = table();
        words.sweeps.pop();
        words.rows.truncate(2);
        let plot = words.plot(&["delivered".to_owned()]).expect("a plot");
        assert_eq!(plot.categories, ["horizontal", "vertical"]);
    }

    #[test]
    fn json_says_null_where_there_is_no_number() {
        let json = table().to_json();
        assert_eq!(json["rows"][5]["settings"]["device.0.rotation"], "10");
        assert!(json["rows"][5]["figures"]["delivered"].is_null());
        assert_eq!(json["rows"][1]["figures"]["displacement_rms_cm"], 1.0);
    }
}
