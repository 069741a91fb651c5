//! The statements of the paper, one by one: Halimeh & Wegener, "Photorealistic rendering of
//! unidirectional free-space invisibility cloaks", Opt. Express 21, 9457 (2013).
//!
//! Each statement that can be checked is computed afresh from the program's own scenes and rays,
//! and the verdict follows from the numbers by a rule that is written down here, once. No number is
//! adjusted to agree.

mod birefringent;
mod finding;
mod fixture;
mod geometry;
mod graded;
mod matched;
mod motion;
mod time;

pub use finding::{Finding, Verdict, markdown};

use cloakroom::measure::MeasureError;
use cloakroom::render::{PreparedSceneError, RenderError};
use cloakroom::scene_file::SceneFileError;
use cloakroom::trace::Stopped;
use finding::Page;
use fixture::Fixture;
use std::sync::atomic::{AtomicBool, Ordering};

/// Why the paper could not be gone through.
#[derive(Debug, thiserror::Error)]
pub enum VerificationError {
    /// A picture could not be made, or the work was stopped from outside.
    #[error("{0}")]
    Render(#[from] RenderError),
    /// A picture could not be measured.
    #[error("{0}")]
    Measure(#[from] MeasureError),
    /// A scene could not be read.
    #[error("{0}")]
    Scene(#[from] Box<SceneFileError>),
    /// A scene could not be built.
    #[error("{0}")]
    PreparedScene(#[from] PreparedSceneError),
    /// A number that should be there is not.
    #[error("{0} is missing")]
    Missing(String),
}

/// A check adds what it finds to the page.
type Check = fn(&Fixture<'_>, &mut Page) -> Result<()>;
type Result<T, E = VerificationError> = std::result::Result<T, E>;

/// All checks, in the order of the paper.
const CHECKS: &[Check] = &[
    geometry::introduction,
    motion::equation,
    geometry::materials,
    geometry::setting,
    birefringent::centre_plane,
    birefringent::along_the_axis,
    birefringent::views,
    birefringent::waves_and_pulses,
    birefringent::turned,
    birefringent::reflections,
    birefringent::trapped_light,
    matched::along_the_axis,
    matched::turned,
    graded::index,
    graded::thinner_bump,
    graded::polarization,
    graded::views,
    graded::times,
    graded::reflections,
    graded::turned,
    time::pulses,
];

/// How many steps [`verify`] takes.
#[must_use]
pub fn steps() -> u64 {
    CHECKS.len() as u64
}

/// Goes through the paper; `step_done` is called after each of [`steps`].
///
/// # Errors
///
/// If the work was stopped, or a picture could not be made.
pub fn verify(step_done: &dyn Fn(), stop: &AtomicBool) -> Result<Vec<Finding>> {
    let fixture = Fixture::new(stop);
    let mut page = Page::default();
    for check in CHECKS {
        if stop.load(Ordering::Relaxed) {
            return Err(RenderError::from(Stopped).into());
        }
        check(&fixture, &mut page)?;
        step_done();
    }
    Ok(page.0)
}
