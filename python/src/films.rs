//! Many pictures at once: films, and the figures of the paper.

use crate::errors::{Failure, value_error};
use crate::scenes::Scene;
use crate::supervision::supervised;
use cloakroom::render::{self, ChannelSet, Images, PreparedScene};
use cloakroom_figures::film::{Film, FilmFormat, FrameFolder, frame_metadata, render_frames};
use cloakroom_figures::panels::{PanelMaker, PanelSettings};
use cloakroom_figures::{paper, paper_figures};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// Renders scenes, a frame each, and makes a film of them as the ending of the file asks for, or a
/// folder of frames. Gives how many frames were there already, and how many branches were cut and
/// lost.
#[pyfunction]
pub fn animate(
    py: Python<'_>,
    scenes: Vec<Py<Scene>>,
    path: PathBuf,
    rate: u32,
    map_range: Option<[f64; 2]>,
    keep_frames: bool,
    progress: Option<Py<PyAny>>,
) -> Result<(usize, u64, u64), Failure> {
    let format = FilmFormat::of(&path).map_err(value_error)?;
    format.check()?;
    let scenes: Vec<&Scene> = scenes.iter().map(Py::get).collect();
    let Some(first) = scenes.first() else {
        return Err(value_error("a film has a frame at least"));
    };
    let count = scenes.len();
    let is_film = format != FilmFormat::Frames;
    if is_film {
        cloakroom::output::check_writable(&path)?;
    }
    supervised(py, progress.as_ref(), |watch, supervision| {
        let rows = u64::from(first.scene().camera.resolution[1]) * count as u64;
        watch.begin(if is_film { rows + count as u64 } else { rows });
        let frames = FrameFolder::of_film(&path, format, count)?;
        let mut images = Images::default();
        let mut prepared = |frame: usize| scenes[frame].prepared_with(&mut images);
        let done = render_frames(0..count, &mut prepared, &frames, map_range, supervision)?;
        if is_film {
            let metadata = &frame_metadata(&prepared(0)?, map_range);
            let (frame_done, stop) = (&|| (supervision.rows_done)(1), supervision.stop);
            let film = Film { frames: &frames, path: &path, rate, metadata, frame_done, stop };
            film.write(format)?;
            if !keep_frames {
                frames.remove();
            }
        }
        Ok((done.skipped, done.stats.endless, done.stats.lost))
    })
}

/// Makes the figures and panels of the paper that are named, all for none, in a folder. Gives the
/// files that have been written.
#[pyfunction]
pub fn figures(
    py: Python<'_>,
    only: Vec<String>,
    folder: PathBuf,
    photo: Option<PathBuf>,
    size: [u32; 2],
    samples: u32,
    progress: Option<Py<PyAny>>,
) -> Result<Vec<PathBuf>, Failure> {
    let chosen = paper::select(&only).map_err(value_error)?;
    let settings = PanelSettings { size, samples, photo };
    supervised(py, progress.as_ref(), |watch, supervision| {
        let rows = u64::from(size[1]);
        watch.begin(rows * chosen.len() as u64);
        let mut files = Vec::new();
        let mut render = |_: &str, prepared: &PreparedScene<'_>, wanted: ChannelSet| {
            Ok(render::render(prepared, wanted, supervision)?.picture)
        };
        let mut wrote = |path: &Path| files.push(path.to_owned());
        let mut maker = PanelMaker::new(&settings, &folder, &mut render, &mut wrote)?;
        std::fs::create_dir_all(&folder).map_err(|error| {
            PyOSError::new_err(format!("cannot make the folder {}: {error}", folder.display()))
        })?;
        paper_figures::make::<Failure>(&chosen, &mut maker)?;
        // Settings are drawn, and some panels have the rays of others.
        (supervision.rows_done)(watch.left());
        Ok(files)
    })
}
