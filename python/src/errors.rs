//! Errors of the library as Python exceptions, with the same messages.

use cloakroom::material::MaterialError;
use cloakroom::measure::MeasureError;
use cloakroom::output::OutputError;
use cloakroom::ray_json::RayError;
use cloakroom::render::{MergeError, RenderError};
use cloakroom::scene_file::SceneFileError;
use cloakroom::trace::Stopped;
use cloakroom_figures::IllustrationError;
use cloakroom_figures::film::FilmError;
use pyo3::PyErr;
use pyo3::exceptions::{
    PyFileNotFoundError, PyKeyboardInterrupt, PyMemoryError, PyOSError, PyValueError,
};
use std::error::Error;
use std::path::Path;

/// What a function of the package raises.
#[derive(Debug)]
pub struct Failure(PyErr);

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        failure.0
    }
}

impl<E: Error + 'static> From<E> for Failure {
    /// The exception for an error of the library, or an exception as it is. Work that was stopped
    /// from outside ends with `KeyboardInterrupt`, should nobody say more.
    fn from(error: E) -> Self {
        let error: Box<dyn Error> = Box::new(error);
        let error = match error.downcast::<PyErr>() {
            Ok(raised) => return Self(*raised),
            Err(error) => error,
        };
        let too_large = matches!(error.downcast_ref(), Some(RenderError::TooLarge { .. }))
            || matches!(
                error.downcast_ref(),
                Some(MaterialError::TooLarge { .. } | MaterialError::TooFine)
            )
            || matches!(error.downcast_ref(), Some(RayError::TooMany { .. }))
            || matches!(error.downcast_ref(), Some(MergeError::TooLarge(_)))
            || matches!(error.downcast_ref(), Some(MeasureError::TooLarge { .. }));
        let unwritten = match error.downcast_ref() {
            Some(IllustrationError::Output(error)) => Some(error),
            _ => match error.downcast_ref() {
                Some(FilmError::Output(error)) => Some(error),
                _ => error.downcast_ref(),
            },
        };
        let message = error.to_string();
        Self(if Stopped::is_in(error.as_ref()) {
            PyKeyboardInterrupt::new_err(())
        } else if too_large {
            PyMemoryError::new_err(message)
        } else if matches!(unwritten, Some(OutputError::Write { .. }))
            || matches!(error.downcast_ref(), Some(FilmError::Failed { .. }))
        {
            PyOSError::new_err(message)
        } else {
            PyValueError::new_err(message)
        })
    }
}

/// A `ValueError` with a message.
pub fn value_error(message: impl std::fmt::Display) -> Failure {
    Failure(PyValueError::new_err(message.to_string()))
}

/// An error of reading a file, which may not be there.
pub fn unreadable(path: &Path, error: impl Error + 'static) -> Failure {
    if path.exists() {
        error.into()
    } else {
        PyFileNotFoundError::new_err(error.to_string()).into()
    }
}

/// An error of a scene. That of a file says where in the file; a scene made in Python has no lines,
/// and an override is no argument of a command line.
pub fn scene_error(error: &SceneFileError, is_file: bool) -> Failure {
    match &error.at_fault {
        Some(at_fault) => value_error(format!("{}: {}", at_fault.text, error.message)),
        None if is_file => value_error(error),
        None => value_error(&error.message),
    }
}
