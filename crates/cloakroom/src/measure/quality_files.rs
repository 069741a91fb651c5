//! Tables of quality as data: CSV, NPZ and JSON.

use super::quality::{QualityRow, QualityTable};
use crate::output::{OutputError, write_npz, write_whole};
use serde_json::{Map, Value, json};
use std::path::Path;

impl QualityTable {
    /// Writes the table as CSV: a line of names, then one line a row; empty where there is no
    /// number.
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

    /// Writes the table as NPZ: an array for each column and for each sweep of numbers; NaN where
    /// there is no number.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write_npz(&self, path: &Path) -> Result<(), OutputError> {
        write_npz(path, &self.metadata, |npz| {
            for (i, sweep) in self.sweeps.iter().enumerate() {
                if sweep.numbers().is_some() {
                    let value = |row: &QualityRow| row.settings[i].parse().unwrap_or(f64::NAN);
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
                |of: fn(&QualityRow) -> &Vec<f64>| self.rows.iter().map(|row| of(row)[i]).collect();
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

    /// The table as a JSON object: `sweeps`, `columns`, `draws`, and `rows` of `settings` and
    /// `figures` by name, and of their `standard_errors` where there are several draws; null where
    /// there is no number.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let keys = || self.sweeps.iter().map(|sweep| sweep.key.clone());
        let names = || self.columns.iter().map(|column| column.name.clone());
        let named = |numbers: &[f64]| -> Map<String, Value> {
            names().zip(numbers.iter().map(|number| (*number).into())).collect()
        };
        let row = |row: &QualityRow| {
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
