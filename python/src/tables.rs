//! The tables of a scene: held against their lists of keys, and described.

use crate::errors::{Failure, value_error};
use crate::values::{object_of, value_of};
use cloakroom::device;
use cloakroom::keys::{Key, hint, unknown};
use cloakroom::scene::{Placement, TABLES};
use cloakroom::scene_file;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The JSON Schema of scene files as text: every table and every device with its keys, their types,
/// defaults, units and what they are.
#[pyfunction]
pub fn schema() -> String {
    scene_file::schema().to_string()
}

/// Holds the entries of a table against its keys: those of a device of the kind `table`, or of the
/// table of a scene of that name. Gives back what a scene file would say.
///
/// Raises `TypeError` for a key that does not exist, `ValueError` for a value that does not fit.
#[pyfunction]
pub fn fit<'py>(
    py: Python<'py>,
    table: &str,
    entries: &Bound<'py, PyDict>,
) -> Result<Bound<'py, PyDict>, Failure> {
    let (lists, place) = lists(table)?;
    let keys = || lists.iter().copied().flatten();
    let values = PyDict::new(py);
    for (name, object) in entries {
        let name: String = name.extract()?;
        let Some(key) = keys().find(|key| key.name == name) else {
            let known: Vec<&str> = keys().map(|key| key.name).collect();
            return Err(PyTypeError::new_err(unknown("key", &name, &place, &known)).into());
        };
        let value = key.check(&value_of(&name, &object)?).map_err(value_error)?;
        values.set_item(name, object_of(py, &value)?)?;
    }
    Ok(values)
}

/// The names of the keys of a table or a kind of device, in the order in which they matter.
#[pyfunction]
pub fn key_names(table: &str) -> Result<Vec<&'static str>, Failure> {
    Ok(lists(table)?.0.into_iter().flatten().map(|key| key.name).collect())
}

/// The lists of keys of a table or a kind of device, and how messages call it.
fn lists(table: &str) -> Result<(Vec<&'static [Key]>, String), Failure> {
    if let Some((name, keys)) = TABLES.iter().find(|(name, _)| *name == table) {
        return Ok((vec![keys], format!(" in [{name}]")));
    }
    match device::entry(table) {
        Some(entry) => Ok((vec![entry.keys, Placement::KEYS], format!(" in a {}", entry.kind))),
        None => {
            let known: Vec<&str> = device::CATALOGUE.iter().map(|entry| entry.kind).collect();
            let hint = hint(table, &known, "known kinds");
            Err(value_error(format!("there is no kind of device `{table}`{hint}")))
        }
    }
}
