//! `cloakroom animate`: a film of a scene while keys of it change.

use crate::arguments::AnimateArguments;
use crate::files::check_writable;
use crate::interruption::{self, STOP};
use crate::progress::supervised;
use crate::render::warn_of_cut_branches;
use crate::report::{Failure, Result, say};
use crate::scene;
use cloakroom::output;
use cloakroom::render::Images;
use cloakroom::scene_file::{self, Loaded, Override};
use cloakroom::timeline::{Changes, Keyframes, Timeline};
use cloakroom_figures::film::{self, Film, FilmFormat, FrameFolder, frame_metadata};
use std::ops::Range;
use std::path::Path;

/// Renders the frames that are not there yet, and makes the film of them.
pub fn run(arguments: &AnimateArguments) -> Result<()> {
    let path = &arguments.output;
    let format = FilmFormat::of(path).map_err(Failure::Failed)?;
    let keyframes = arguments.keyframes.as_deref().map(keyframes).transpose()?;
    let timeline = Timeline::new(Changes {
        sweeps: &arguments.sweeps,
        keyframes: keyframes.as_ref(),
        orbit: arguments.orbit.as_deref(),
        frames: arguments.frames,
    })?;
    let count = timeline.frames();
    let range = range(arguments.frames_only, count)?;
    let makes_film = arguments.frames_only.is_none() && format != FilmFormat::Frames;
    if makes_film {
        format.check()?;
        output::check_writable(path)?;
    }
    scene::use_threads(&arguments.threads)?;
    let mut images = Images::default();
    let scenes = scenes(arguments, &timeline, range.clone(), &mut images)?;
    let inputs = scenes.iter().flat_map(|loaded| scene::inputs(&arguments.scene, loaded));
    let inputs: Vec<_> = inputs.collect();
    if makes_film {
        check_writable([path], &inputs)?;
    }
    let frames = FrameFolder::of_film(path, format, count)?;
    let folder = frames.path();
    check_writable(
        (0..count).map(|frame| frames.file(frame)).filter(|file| file.exists()),
        &inputs,
    )?;
    let _busy = interruption::busy();
    let rendered = render(arguments, &scenes, range, &frames, &mut images);
    if let Err(Failure::Interrupted) = rendered {
        say(&format!("the finished frames are kept in {}", folder.display()));
    }
    rendered?;
    if format == FilmFormat::Frames {
        return Ok(());
    }
    if arguments.frames_only.is_some() {
        say(&format!(
            "the frames are in {}; the same command without --frames-only makes the film",
            folder.display()
        ));
        return Ok(());
    }
    let first = scenes.first().map(|loaded| scene::prepared(loaded, &mut images)).transpose()?;
    let metadata = first.map(|first| frame_metadata(&first, arguments.map_range));
    let (rate, metadata) = (arguments.fps, &metadata.unwrap_or_default());
    let film = Written { path, format, rate, metadata, keep_frames: arguments.keep_frames };
    film.write(&frames)
}

/// A film that is to be made of frames.
#[derive(Clone, Copy, Debug)]
pub struct Written<'a> {
    pub path: &'a Path,
    pub format: FilmFormat,
    /// Frames a second.
    pub rate: u32,
    pub metadata: &'a [(String, String)],
    /// Whether the frames stay when it is made.
    pub keep_frames: bool,
}

impl Written<'_> {
    /// Makes it, and removes the frames unless they stay.
    pub fn write(&self, frames: &FrameFolder) -> Result<()> {
        let Self { path, format, rate, metadata, keep_frames } = *self;
        supervised(frames.count() as u64, "writing", |bar, _| {
            let frame_done = &|| bar.inc(1);
            Film { frames, path, rate, metadata, frame_done, stop: &STOP }.write(format)
        })?;
        if !keep_frames {
            frames.remove();
        }
        Ok(())
    }
}

/// Where the camera stands.
const POSITION: &str = "camera.position";

/// The keyframes of a file.
fn keyframes(path: &Path) -> Result<Keyframes> {
    let text = scene_file::read_text(path)?;
    Ok(Keyframes::parse(&text, &path.display().to_string())?)
}

/// The scenes of a range of frames, each of which can be built.
fn scenes(
    arguments: &AnimateArguments,
    timeline: &Timeline,
    range: Range<usize>,
    images: &mut Images,
) -> Result<Vec<Loaded>> {
    let (text, mut scenes) = (scene::text(&arguments.scene.scene)?, Vec::<Loaded>::new());
    let still = scene::overrides(&text, &arguments.scene, &arguments.picture)?;
    for frame in range {
        let mut overrides = [&still[..], &timeline.overrides(frame)].concat();
        let mut loaded = text.scene(&overrides)?;
        if let Some(degrees) = timeline.azimuth(frame) {
            let position = loaded.scene.camera.orbited(degrees).to_array();
            let words = format!("--orbit, {degrees} degrees from where the camera stands");
            overrides.push(Override::value(POSITION, position).by(words));
            loaded = text.scene(&overrides)?;
        }
        scene::check_pipes(&arguments.scene, &loaded, None)?;
        scene::prepared(&loaded, images)?;
        let shown = &loaded.scene.picture;
        if shown.map.name().is_some() && arguments.map_range.or(shown.map_range).is_none() {
            return Err(Failure::Failed(
                "a film of a map needs one scale for all frames; give picture.map_range or --map-range \
                 LOW,HIGH, in ns for times and as shares for powers"
                    .to_owned(),
            ));
        }
        let size = |loaded: &Loaded| loaded.scene.camera.resolution;
        if scenes.first().is_some_and(|first| size(first) != size(&loaded)) {
            return Err(Failure::Failed(
                "camera.resolution changes from frame to frame; a film has one size".to_owned(),
            ));
        }
        scenes.push(loaded);
    }
    Ok(scenes)
}

/// Renders the frames of a range that are not finished.
fn render(
    arguments: &AnimateArguments,
    scenes: &[Loaded],
    range: Range<usize>,
    frames: &FrameFolder,
    images: &mut Images,
) -> Result<()> {
    let rows = scenes.first().map_or(0, |first| u64::from(first.scene.camera.resolution[1]));
    let first = range.start;
    let done = supervised(rows * scenes.len() as u64, "rendering", |_, supervision| {
        let prepared = |frame: usize| scene::prepared(&scenes[frame - first], images);
        film::render_frames(range, prepared, frames, arguments.map_range, supervision)
    })?;
    warn_of_cut_branches(&done.stats);
    if done.skipped > 0 {
        say(&format!("{} of {} frames were there already", done.skipped, scenes.len()));
    }
    Ok(())
}

/// Which frames are to be rendered.
fn range(only: Option<[usize; 2]>, count: usize) -> Result<Range<usize>> {
    match only {
        None => Ok(0..count),
        Some([first, last]) if last < count => Ok(first..last + 1),
        Some([first, last]) => Err(Failure::Failed(format!(
            "--frames-only {first}..{last}: the frames are 0 to {}",
            count - 1
        ))),
    }
}
