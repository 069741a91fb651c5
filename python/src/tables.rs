//! The tables of a scene: held against their lists of keys, described, and written as TOML.

use crate::errors::value_error;
use crate::values::{object_of, value_of};
use cloakroom::device;
use cloakroom::keys::{Value, Values, hint, unknown};
use cloakroom::scene::{PLACEMENT_KEYS, TABLES};
use cloakroom::scene_file;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt::Write;

/// The JSON Schema of scene files as text: every table and every device with its keys, their types, defaults, units and
/// what they are.
#[pyfunction]
pub fn schema() -> String {
    scene_file::schema().to_string()
}

/// Holds the entries of a table against its keys: those of a device of the kind `table`, or of the table of a scene of
/// that name. Gives back what a scene file would say.
///
/// Raises `TypeError` for a key that does not exist, `ValueError` for a value that does not fit.
#[pyfunction]
pub fn fit<'py>(
    py: Python<'py>,
    table: &str,
    entries: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyDict>> {
    let (mut lists, place) = lists(table)?;
    let fitted = PyDict::new(py);
    for (name, object) in entries {
        let name: String = name.extract()?;
        let Some(list) =
            lists.iter_mut().find(|list| list.keys().iter().any(|key| key.name == name))
        else {
            let known: Vec<&str> =
                lists.iter().flat_map(|list| list.keys()).map(|key| key.name).collect();
            return Err(PyTypeError::new_err(unknown("key", &name, &place, &known)));
        };
        list.set(&name, value_of(&name, &object)?).map_err(value_error)?;
        if let Some(value) = list.get(&name) {
            fitted.set_item(name, object_of(py, &value)?)?;
        }
    }
    Ok(fitted)
}

/// The lists of keys of a table or a kind of device, and how messages call it.
fn lists(table: &str) -> PyResult<(Vec<Values>, String)> {
    if let Some((name, keys)) = TABLES.iter().find(|(name, _)| *name == table) {
        return Ok((vec![Values::defaults(keys)], format!(" in [{name}]")));
    }
    match device::entry(table) {
        Some(entry) => {
            let lists = [entry.keys, PLACEMENT_KEYS].map(Values::defaults);
            Ok((lists.to_vec(), format!(" in a {}", entry.kind)))
        }
        None => {
            let known: Vec<&str> = device::CATALOGUE.iter().map(|entry| entry.kind).collect();
            let hint = hint(table, &known, "known kinds");
            Err(value_error(format!("there is no kind of device `{table}`{hint}")))
        }
    }
}

/// A scene as the text of a scene file: `tables` by their names, then `devices`, each with its `kind`.
#[pyfunction]
pub fn to_toml(tables: &Bound<'_, PyDict>, devices: Vec<Bound<'_, PyDict>>) -> PyResult<String> {
    let mut text = String::new();
    for (name, table) in tables {
        write_table(&mut text, &format!("[{name}]"), table.cast::<PyDict>()?)?;
    }
    for device in &devices {
        write_table(&mut text, "[[device]]", device)?;
    }
    Ok(text)
}

/// A value as an override writes it.
#[pyfunction]
pub fn toml_literal(name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(toml_value(value_of(name, value)?).to_string())
}

fn write_table(text: &mut String, header: &str, table: &Bound<'_, PyDict>) -> PyResult<()> {
    if !text.is_empty() {
        text.push('\n');
    }
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{header}");
    for (name, object) in table {
        let name: String = name.extract()?;
        let value = toml_value(value_of(&name, &object)?);
        let _ = writeln!(text, "{name} = {value}");
    }
    Ok(())
}

/// A value as TOML writes it.
fn toml_value(value: Value) -> toml::Value {
    match value {
        Value::Number(number) => number.into(),
        Value::Integer(integer) => integer.into(),
        Value::Flag(flag) => flag.into(),
        Value::Text(text) => text.into(),
        Value::List(items) => toml::Value::Array(items.into_iter().map(toml_value).collect()),
        Value::Table(entries) => toml::Value::Table(
            entries.into_iter().map(|(name, value)| (name, toml_value(value))).collect(),
        ),
    }
}
