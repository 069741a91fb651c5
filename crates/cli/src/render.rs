//! `cloakroom render`: a scene to pictures and data.

use crate::arguments::RenderArguments;
use crate::interruption;
use crate::progress;
use crate::report::{Failure, say};
use crate::scene;
use cloakroom::output::{self, Format, Picture};
use cloakroom::render::{
    self, ChannelSet, PreparedScene, RenderError, Rendered, Supervision, Tile,
};
use cloakroom::scene::Scene;
use cloakroom::trace::TraceStats;
use cloakroom_figures::{IllustrationError, PictureFormat, ScalarMap, write_picture};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Renders a scene and writes every file asked for.
pub fn run(arguments: &RenderArguments, stop: &AtomicBool) -> Result<(), Failure> {
    let formats = formats(&arguments.outputs)?;
    scene::use_threads(&arguments.threads)?;
    let data = formats.iter().any(|(_, format)| !format.is_shown());
    let loaded =
        scene::load_with(&arguments.scene, channels(&arguments.channels, data)?.as_slice())?;
    let studio = PreparedScene::new(&loaded.scene).map_err(|e| scene::located(&loaded, &e))?;
    let wanted =
        if data { ChannelSet::Everything } else { ChannelSet::for_image(&loaded.scene.picture) };
    for (path, format) in &formats {
        if matches!(format, PictureFormat::Map(_)) && loaded.scene.picture.map.name().is_none() {
            let path = (*path).clone();
            return Err(Failure::from_error(IllustrationError::NoMap { path }));
        }
        output::check_writable(path).map_err(Failure::from_error)?;
    }
    let _busy = interruption::busy();
    if let Some(tile) = arguments.tile {
        let tile = check_tile(tile, &loaded.scene, &formats)?;
        return in_tile(&studio, wanted, tile, &formats, stop);
    }
    if let [(path, PictureFormat::Pixels(Format::Png))] = formats[..]
        && loaded.scene.picture.map.name().is_none()
        && render::strips(&studio).nth(1).is_some()
    {
        return in_strips(&studio, &loaded.scene, path, stop);
    }
    let Rendered { picture, stats } = picture(&studio, wanted, "rendering", stop)?;
    tell_rarities(&stats);
    let shown = &loaded.scene.picture;
    for (path, format) in formats {
        write_picture(&picture, (shown.map.name(), shown.color_bar), format, path)
            .map_err(Failure::from_error)?;
    }
    Ok(())
}

/// The tile, if the picture has one there and its files can be tiles.
fn check_tile(
    tile: Tile,
    scene: &Scene,
    formats: &[(&PathBuf, PictureFormat)],
) -> Result<Tile, Failure> {
    for (path, format) in formats {
        if matches!(format, PictureFormat::Pixels(Format::Exr) | PictureFormat::Map(_)) {
            let path = path.display();
            return Err(Failure::Failed(format!("{path}: a tile is a .npz or a .png")));
        }
        if format.is_shown() && scene.picture.map.name().is_some() {
            return Err(Failure::Failed(format!(
                "{}: the scale of a map is that of the whole picture; write tiles of it as .npz",
                path.display()
            )));
        }
    }
    tile.check(scene.camera.resolution()).map_err(Failure::from_error)
}

/// Renders a tile and writes its files.
fn in_tile(
    studio: &PreparedScene<'_>,
    wanted: ChannelSet,
    tile: Tile,
    formats: &[(&PathBuf, PictureFormat)],
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let bar = progress::bar(tile.height.into(), "rendering");
    let supervision = Supervision { rows_done: &|rows| bar.inc(rows), stop };
    let rendered = render::render_tile(studio, wanted, tile, &supervision);
    bar.finish_and_clear();
    let Rendered { picture, stats } = rendered.map_err(failed)?;
    tell_rarities(&stats);
    for (path, _) in formats {
        output::write(&picture, path).map_err(Failure::from_error)?;
    }
    Ok(())
}

/// Renders a large image strip by strip into its file.
fn in_strips(
    studio: &PreparedScene<'_>,
    scene: &Scene,
    path: &Path,
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let bar = progress::bar(studio.rows(), "rendering");
    let supervision = Supervision { rows_done: &|rows| bar.inc(rows), stop };
    let (mut stats, mut failure) = (TraceStats::default(), None);
    let images = render::strips(studio).map(|rows| {
        let strip = render::render_rows(studio, ChannelSet::Image, rows, &supervision)
            .map_err(failed)
            .and_then(|strip| {
                stats += strip.stats;
                output::to_srgb(&strip.picture).map_err(Failure::from_error)
            });
        strip.map_err(|error| {
            failure = Some(error);
            io::Error::other("no strip")
        })
    });
    let written = output::write_png_in_strips(
        scene.camera.resolution(),
        &render::metadata(scene),
        path,
        images,
    );
    bar.finish_and_clear();
    if let Some(failure) = failure {
        return Err(failure);
    }
    written.map_err(Failure::from_error)?;
    tell_rarities(&stats);
    Ok(())
}

/// The override that asks for more channels; only files of data hold them.
fn channels(names: &[String], data: bool) -> Result<Option<String>, Failure> {
    match names {
        [] => Ok(None),
        _ if !data => Err(Failure::Usage(
            "--channels is for .exr and .npz files; a .png shows one with \
             --set picture.map=CHANNEL"
                .to_owned(),
        )),
        // Written as the scene writes it.
        _ => Ok(Some(format!("picture.channels={names:?}"))),
    }
}

/// The files to write with their formats.
fn formats(outputs: &[PathBuf]) -> Result<Vec<(&PathBuf, PictureFormat)>, Failure> {
    let format = |path| PictureFormat::of(path).map_err(Failure::from_error);
    outputs.iter().map(|path| Ok((path, format(path)?))).collect()
}

/// Renders with a progress bar.
pub fn picture(
    studio: &PreparedScene<'_>,
    wanted: ChannelSet,
    what: &str,
    stop: &AtomicBool,
) -> Result<Rendered, Failure> {
    let bar = progress::bar(studio.rows(), what);
    let supervision = Supervision { rows_done: &|rows| bar.inc(rows), stop };
    let rendered = render::render(studio, wanted, &supervision);
    bar.finish_and_clear();
    rendered.map_err(failed)
}

fn failed(error: RenderError) -> Failure {
    match error {
        RenderError::Stopped => Failure::Interrupted,
        RenderError::TooLarge { .. } => Failure::from_error(error),
    }
}

/// What a PNG of the scene shows: the image, or the map of one channel.
pub fn rgb(scene: &Scene, picture: &Picture) -> Result<output::RgbImage, Failure> {
    match scene.picture.map.name() {
        None => output::to_srgb(picture).map_err(Failure::from_error),
        Some(channel) => ScalarMap::new(picture, channel, None)
            .and_then(|map| map.into_image(scene.picture.color_bar))
            .map_err(Failure::from_error),
    }
}

/// Says what was rare, if anything was.
pub fn tell_rarities(stats: &TraceStats) {
    if stats.endless > 0 {
        say(&format!(
            "note: {} branches of ray trees without end were cut, the weakest first; their power is in `pruned`",
            stats.endless
        ));
    }
    if stats.lost > 0 {
        say(&format!(
            "note: {} branches could not be followed through a device; their power is in `pruned`",
            stats.lost
        ));
    }
}
