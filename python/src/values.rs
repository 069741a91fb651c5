//! Python objects as the values of keys, and back.

use crate::materials::Material;
use cloakroom::keys::Value;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyComplex, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

/// No key takes lists in lists deeper than tables of tensors.
const DEEPEST: usize = 8;

/// No key takes more numbers than this.
const MOST_ENTRIES: usize = 1_000_000;

/// The value that a Python object is; `name` is the key that it is meant for.
///
/// Complex numbers become `[re, im]`, paths texts, materials what was said of them, and numpy's arrays and numbers what their
/// `tolist` gives.
///
/// # Errors
///
/// `TypeError` if it is nothing that a key takes, `ValueError` if it is too large.
pub fn value_of(name: &str, object: &Bound<'_, PyAny>) -> PyResult<Value> {
    convert(name, object, 0, &mut MOST_ENTRIES.clone())
}

/// The value of an object within others, and how many entries of lists there may still be: a list
/// may hold another many times.
fn convert(
    name: &str,
    object: &Bound<'_, PyAny>,
    depth: usize,
    left: &mut usize,
) -> PyResult<Value> {
    if depth > DEEPEST {
        return Err(PyTypeError::new_err(format!("{name} holds lists in lists without end")));
    }
    if let Ok(flag) = object.cast::<PyBool>() {
        return Ok(Value::Flag(flag.is_true()));
    }
    if object.is_instance_of::<PyInt>() {
        return object.extract().map(Value::Integer).map_err(|_| {
            PyValueError::new_err(format!("{name}: whole numbers must fit into 64 bits"))
        });
    }
    if let Ok(number) = object.cast::<PyFloat>() {
        return Ok(Value::Number(number.extract()?));
    }
    if let Ok(number) = object.cast::<PyComplex>() {
        return Ok(Value::from([number.real(), number.imag()]));
    }
    if let Ok(text) = object.cast::<PyString>() {
        let text = text.to_str().map_err(|_| {
            PyValueError::new_err(format!("{name} is a text that is not valid Unicode"))
        })?;
        return Ok(Value::from(text));
    }
    if let Ok(table) = object.cast::<PyDict>() {
        let entry = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let key: String = key.extract().map_err(|_| {
                PyTypeError::new_err(format!("{name} has a key that is not a text: {key}"))
            })?;
            let value = convert(&key, &value, depth + 1, left)?;
            Ok((key, value))
        };
        return table.iter().map(entry).collect::<PyResult<_>>().map(Value::Table);
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        return list(name, object, depth, left);
    }
    if let Ok(native) = object.getattr("_native")
        && let Ok(material) = native.cast::<Material>()
    {
        return Ok(material.get().value.clone());
    }
    if let Ok(path) = object.call_method0("__fspath__") {
        return convert(name, &path, depth + 1, left);
    }
    if let Ok(size) = object.getattr("size").and_then(|size| size.extract::<usize>())
        && size > MOST_ENTRIES
    {
        return Err(too_many(name, size));
    }
    if let Ok(plain) = object.call_method0("tolist") {
        return convert(name, &plain, depth + 1, left);
    }
    Err(PyTypeError::new_err(format!(
        "{name} is a {}; it must be a number, a text, a list or a table",
        object.get_type().name()?
    )))
}

fn list(name: &str, object: &Bound<'_, PyAny>, depth: usize, left: &mut usize) -> PyResult<Value> {
    let length = object.len()?;
    *left = left.checked_sub(length).ok_or_else(|| too_many(name, length))?;
    let items = object.try_iter()?.map(|item| convert(name, &item?, depth + 1, left));
    items.collect::<PyResult<_>>().map(Value::List)
}

fn too_many(name: &str, entries: usize) -> PyErr {
    PyValueError::new_err(format!("{name} has {entries} entries; no key takes that many"))
}

/// A value as a Python object.
pub fn object_of<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Number(number) => number.into_pyobject(py)?.into_any(),
        Value::Integer(integer) => integer.into_pyobject(py)?.into_any(),
        Value::Flag(flag) => PyBool::new(py, *flag).to_owned().into_any(),
        Value::Text(text) | Value::Date(text) => PyString::new(py, text).into_any(),
        Value::List(items) => {
            let items =
                items.iter().map(|item| object_of(py, item)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, items)?.into_any()
        }
        Value::Table(entries) => {
            let table = PyDict::new(py);
            for (name, value) in entries {
                table.set_item(name, object_of(py, value)?)?;
            }
            table.into_any()
        }
    })
}
