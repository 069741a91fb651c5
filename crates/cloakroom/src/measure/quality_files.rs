//! Tables of quality as data: CSV, NPZ and JSON.

use super::quality::{QualityTable, Row};
use crate::device::{CATALOGUE, Imperfection};
use crate::keys::Key;
use crate::output::{OutputError, write_npz, write_whole};
use crate::scene::{Placement, TABLES};
use serde_json::{Map, Value, json};
use std::path::Path;

impl QualityTable {
    /// Writes the table as CSV: a line of names, then one line a row; empty where there is no number.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), OutputError> {
        let figures = self.figures();
        write_whole(path, |out| {
            let mut table = csv::Writer::from_writer(out);
            let keys = self.sweeps.iter().map(|sweep| &sweep.key);
            table.write_record(keys.chain(figures.iter().map(|(name, _)| name)))?;
            for (i, row) in self.rows.iter().enumerate() {
                let number = |n: f64| if n.is_finite() { n.to_string() } else { String::new() };
                let numbers = figures.iter().map(|(_, values)| number(values[i]));
                table.write_record(row.settings.iter().cloned().chain(numbers))?;
            }
            table.flush()
        })
    }

    /// Writes the table as NPZ: an array for each column and for each sweep of numbers; NaN where there is no number.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_npz(&self, path: &Path) -> Result<(), OutputError> {
        write_npz(path, &self.metadata, |npz| {
            for (i, sweep) in self.sweeps.iter().enumerate() {
                if sweep.numbers().is_some() {
                    let value = |row: &Row| row.settings[i].parse().unwrap_or(f64::NAN);
                    let values: Vec<f64> = self.rows.iter().map(value).collect();
                    npz.add(&sweep.key, values.len(), &values)?;
                }
            }
            for (name, values) in self.figures() {
                npz.add(&name, values.len(), &values)?;
            }
            npz.metadata.insert("sweeps".to_owned(), serde_json::to_value(&self.sweeps)?);
            npz.metadata.insert("draws".to_owned(), self.draws.into());
            Ok(())
        })
    }

    /// Name and values of every column, and of its standard errors where there are several draws.
    fn figures(&self) -> Vec<(String, Vec<f64>)> {
        let mut figures = Vec::new();
        for (i, column) in self.columns.iter().enumerate() {
            let values =
                |of: fn(&Row) -> &Vec<f64>| self.rows.iter().map(|row| of(row)[i]).collect();
            figures.push((column.name.clone(), values(|row| &row.numbers)));
            if self.has_errors() {
                let name = format!("{}_standard_error", column.name);
                figures.push((name, values(|row| &row.standard_errors)));
            }
        }
        figures
    }

    /// Whether its numbers are means with standard errors.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.draws > 1
    }

    /// The table as a JSON object: `sweeps`, `columns`, `draws`, and `rows` of `settings` and `figures` by name, and of
    /// their `standard_errors` where there are several draws; null where there is no number.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let keys = || self.sweeps.iter().map(|sweep| sweep.key.clone());
        let names = || self.columns.iter().map(|column| column.name.clone());
        let named = |numbers: &[f64]| -> Map<String, Value> {
            names().zip(numbers.iter().map(|number| (*number).into())).collect()
        };
        let row = |row: &Row| {
            let settings = keys().zip(row.settings.iter().map(|text| text.clone().into()));
            let settings: Map<String, Value> = settings.collect();
            let mut entry = json!({ "settings": settings, "figures": named(&row.numbers) });
            if self.has_errors() {
                entry["standard_errors"] = named(&row.standard_errors).into();
            }
            entry
        };
        let rows: Vec<Value> = self.rows.iter().map(row).collect();
        json!({
            "sweeps": self.sweeps, "columns": self.columns, "draws": self.draws, "rows": rows,
        })
    }
}

/// The name of a key in words, and the unit that keys of that name have.
#[must_use]
pub fn name_and_unit(key: &str) -> (String, &'static str) {
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
    let devices = CATALOGUE.iter().map(|entry| entry.keys);
    let tables = TABLES.iter().map(|(_, keys)| *keys);
    let keys = devices.chain(tables).chain([Placement::KEYS, Imperfection::KEYS]).flatten();
    let has_unit = |key: &&Key| key.name == name && !key.unit.is_empty();
    let mut found = keys.filter(has_unit).map(|key| key.unit);
    match found.next() {
        Some("degrees") => "°",
        Some(unit) => unit,
        None => "",
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Column, Row, Sweep, combinations};
    use super::*;
    use crate::trace::TraceStats;

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
            stats: TraceStats::default(),
            metadata: vec![("scene".to_owned(), "# a scene".to_owned())],
        }
    }

    #[test]
    fn files_hold_the_table() {
        let folder = tempfile::tempdir().expect("a folder");
        let [csv, npz] = ["a.csv", "a.npz"].map(|name| folder.path().join(name));
        table().write_csv(&csv).expect("a file");
        table().write_npz(&npz).expect("a file");
        let text = std::fs::read_to_string(csv).expect("a file");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 7);
        assert_eq!(lines[0], "camera.polarizer,device.0.rotation,displacement_rms_cm,delivered");
        assert_eq!((lines[3], lines[6]), ("horizontal,10,2,0.5", "vertical,10,2,"));
        let file = std::fs::File::open(npz).expect("a file");
        let mut npz = ndarray_npy::NpzReader::new(file).expect("an archive");
        let rotation: ndarray::Array1<f64> = npz.by_name("device.0.rotation").expect("an array");
        assert_eq!(rotation.to_vec(), [0.0, 5.0, 10.0, 0.0, 5.0, 10.0]);
    }

    #[test]
    fn json_says_null_where_there_is_no_number() {
        let json = table().to_json();
        assert_eq!(json["rows"][5]["settings"]["device.0.rotation"], "10");
        assert!(json["rows"][5]["figures"]["delivered"].is_null());
        assert_eq!(json["rows"][1]["figures"]["displacement_rms_cm"], 1.0);
    }
}
