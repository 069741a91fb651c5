//! Errors of the library as Python exceptions, with the same messages.

use cloakroom::output::OutputError;
use cloakroom::render::RenderError;
use cloakroom::scene_file::SceneFileError;
use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError, PyOSError, PyValueError};

/// A `ValueError` with the message of an error.
pub fn value_error(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// What work that was stopped from outside ends with, should nobody say more.
pub fn stopped() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}

/// An error of a scene. That of a file says where in the file; a scene made in Python has no lines, and an override is
/// no argument of a command line.
pub fn scene_error(error: &SceneFileError, is_file: bool) -> PyErr {
    match &error.override_text {
        Some(text) => value_error(format!("{text}: {}", error.message)),
        None if is_file => value_error(error),
        None => value_error(&error.message),
    }
}

/// An error of a rendering.
pub fn render_error(error: &RenderError) -> PyErr {
    match error {
        RenderError::Stopped => stopped(),
        RenderError::TooLarge { .. } => PyMemoryError::new_err(error.to_string()),
    }
}

/// An error of writing a file.
pub fn output_error(error: &OutputError) -> PyErr {
    match error {
        OutputError::Write { .. } => PyOSError::new_err(error.to_string()),
        _ => value_error(error),
    }
}
