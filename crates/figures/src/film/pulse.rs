//! Films of pulses on their way through a ray diagram.

use super::{FlightFilmError, FrameFolder};
use crate::{Pulse, RayDiagram};
use cloakroom::output::write_png;
use cloakroom::render::{Delay, Gate, RenderError, Supervision};
use cloakroom::trace::Stopped;
use rayon::prelude::*;
use std::sync::atomic::Ordering;

/// Makes the frames of a film of a pulse into their folder: one for the middle of each bin, all of a size in
/// pixels.
///
/// # Errors
///
/// If a frame cannot be drawn or written, or the work was stopped.
pub fn pulse_frames(
    diagram: &RayDiagram,
    (gate, delay): (&Gate, Delay),
    size: [u32; 2],
    frames: &FrameFolder,
    metadata: &[(String, String)],
    supervision: &Supervision<'_>,
) -> Result<(), FlightFilmError> {
    (0..gate.bins()).into_par_iter().try_for_each(|frame| {
        if supervision.stop.load(Ordering::Relaxed) {
            return Err(RenderError::from(Stopped).into());
        }
        let pulse = Pulse { time: gate.middle(frame), delay, step: gate.clock() };
        let image = diagram.draw(Some(&pulse)).to_image(size)?;
        write_png(&image, metadata, &frames.file(frame))?;
        (supervision.rows_done)(1);
        Ok(())
    })
}
