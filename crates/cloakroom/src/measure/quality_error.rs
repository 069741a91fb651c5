//! Why there is no table of figures.

use super::MeasureError;
use super::constraint::ConstraintError;
use super::sweep::SweepError;
use crate::render::{PreparedSceneError, RenderError};
use crate::scene_file::{Loaded, SceneFileError};

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum QualityError {
    /// The sweeps make no sense.
    #[error("{0}")]
    Sweep(#[from] SweepError),
    /// A scene cannot be read or built.
    #[error("{0}")]
    Scene(Box<SceneFileError>),
    /// A picture cannot be made, or the work was stopped.
    #[error("{0}")]
    Render(#[from] RenderError),
    /// A picture cannot be measured.
    #[error("{0}")]
    Measure(#[from] MeasureError),
    /// A fact of a device cannot be held.
    #[error("{0}")]
    Constraint(#[from] ConstraintError),
    /// There are so many draws of something that is not random.
    #[error(
        "--draws {0}: nothing in the scene is random; give a device an error, as in \
         --set device.0.imperfection.error=0.01"
    )]
    NothingRandom(u32),
}

pub(super) fn located(loaded: &Loaded, error: &PreparedSceneError) -> QualityError {
    QualityError::Scene(Box::new(loaded.locations.error_at(&error.key(), error.to_string())))
}
