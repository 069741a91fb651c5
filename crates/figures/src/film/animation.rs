//! The frames of a film, rendered one by one.

use super::FrameFolder;
use crate::{Dimension, IllustrationError, ScalarMap, shown};
use cloakroom::output::{OutputError, write_png};
use cloakroom::render::{ChannelSet, PreparedScene, RenderError, Supervision, render};
use cloakroom::scene::PictureSettings;
use cloakroom::split_mix::mix;
use cloakroom::trace::TraceStats;
use std::ffi::OsString;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What has come of rendering frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RenderedFrames {
    /// Rare events over all rays.
    pub stats: TraceStats,
    /// How many frames were there already.
    pub skipped: usize,
}

/// Renders the frames of some numbers that are not finished into their folder; `prepared` gives what
/// each of them shows, and `map_range` is the one scale that maps have in all of them, in ns for times
/// and as shares for powers, if not what their scenes say.
///
/// # Errors
///
/// That of `prepared`; if a frame would not fit into memory, a map cannot be drawn, a file not be
/// written, or the work was stopped.
pub fn render_frames<'s, E>(
    numbers: Range<usize>,
    mut prepared: impl FnMut(usize) -> Result<PreparedScene<'s>, E>,
    frames: &FrameFolder,
    map_range: Option<[f64; 2]>,
    supervision: &Supervision<'_>,
) -> Result<RenderedFrames, E>
where
    E: From<RenderError> + From<IllustrationError> + From<OutputError>,
{
    let mut done = RenderedFrames::default();
    let mut numbers: Vec<usize> = numbers.collect();
    // In no order, so that what is done says how long the rest will take.
    numbers.sort_by_cached_key(|number| mix(*number as u64));
    for number in numbers {
        let prepared = prepared(number)?;
        let metadata = frame_metadata(&prepared, map_range);
        if frames.is_finished(number, &metadata) {
            done.skipped += 1;
            (supervision.rows_done)(prepared.rows());
            continue;
        }
        let picture = &prepared.scene.picture;
        let rendered = render(&prepared, ChannelSet::for_image(picture), supervision)?;
        done.stats += rendered.stats;
        let image = match picture.map.name() {
            None => shown(&rendered.picture, picture)?,
            Some(channel) => {
                let map_range = map_range.or(picture.map_range);
                let settings = PictureSettings { map_range, ..picture.clone() };
                let mut map = ScalarMap::new(&rendered.picture, channel, &settings)?;
                // The same bar in every frame: there may be numbers beyond it, or none, in some.
                map.bar.scale.is_clipped = (true, true);
                map.bar.scale.has_gaps = map.bar.quantity.dimension == Dimension::Time;
                map.into_image(picture.color_bar)?
            }
        };
        write_png(&image, &metadata, &frames.file(number))?;
    }
    Ok(done)
}

/// What the frame of a scene carries: what its picture does, and the range of a map.
#[must_use]
pub fn frame_metadata(
    prepared: &PreparedScene<'_>,
    map_range: Option<[f64; 2]>,
) -> Vec<(String, String)> {
    let range = map_range.filter(|_| prepared.scene.picture.map.name().is_some());
    let range = range.map(|[low, high]| ("map_range".to_owned(), format!("{low} {high}")));
    prepared.metadata().into_iter().chain(range).collect()
}

/// The folder of the frames of a film: its name and `.frames`.
#[must_use]
pub(super) fn frames_beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".frames");
    name.into()
}
