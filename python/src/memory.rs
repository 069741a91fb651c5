//! Memory: what Python hands over may be a few bytes that stand for many, as numpy's broadcast
//! arrays are, and is looked at before it is copied.

use crate::errors::Failure;
use cloakroom::memory;
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;

/// Refuses what takes more bytes than are free; `name` is what messages call it.
///
/// # Errors
///
/// `MemoryError`.
#[pyfunction]
pub fn check_memory(name: &str, bytes: u64) -> Result<(), Failure> {
    let refused = |shortage| PyMemoryError::new_err(format!("{name} {shortage}"));
    Ok(memory::check(bytes, u64::MAX).map_err(refused)?)
}

/// The same for a copy of an array.
///
/// # Errors
///
/// As [`check_memory`].
pub fn check_copy(name: &str, array: &Bound<'_, PyAny>) -> Result<(), Failure> {
    let bytes = array.getattr("nbytes").and_then(|bytes| bytes.extract());
    check_memory(name, bytes.unwrap_or(0))
}
