//! `cloakroom render`: a scene to pictures and data.

use crate::arguments::RenderArguments;
use crate::files::{check_outputs, formats, write_each};
use crate::interruption;
use crate::progress::supervised;
use crate::report::{Failure, Result, say, wrote};
use crate::scene;
use crate::strips::Strips;
use cloakroom::output::{self, Format, Picture};
use cloakroom::render::{self, ChannelSet, Images, PreparedScene, Rendered, Tile};
use cloakroom::scene::Scene;
use cloakroom::scene_file::Override;
use cloakroom::trace::TraceStats;
use cloakroom_figures::{IllustrationError, PictureFormat, write_picture};
use std::io;
use std::path::{Path, PathBuf};

/// Renders a scene and writes every file asked for.
pub fn run(arguments: &RenderArguments) -> Result<()> {
    let outputs = outputs(arguments)?;
    let formats = formats(&outputs, PictureFormat::of)?;
    scene::use_threads(&arguments.threads)?;
    let data = formats.iter().any(|(_, format)| !format.is_shown());
    let text = scene::text(&arguments.scene.scene)?;
    let mut overrides = scene::overrides(&text, &arguments.scene, &arguments.picture)?;
    overrides.extend(channels(&arguments.channels, data)?.map(Override::from));
    let loaded = scene::load_with(&arguments.scene, &text, &overrides)?;
    let prepared = scene::prepared(&loaded, &mut Images::default())?;
    let shown = &loaded.scene.picture;
    let wanted = if data { ChannelSet::Everything } else { ChannelSet::for_image(shown) };
    for (path, format) in &formats {
        if matches!(format, PictureFormat::Map(_)) && shown.map.name().is_none() {
            return Err(IllustrationError::NoMap { path: path.to_path_buf() }.into());
        }
    }
    check_outputs(&outputs, &scene::inputs(&arguments.scene, &loaded))?;
    let _busy = interruption::busy();
    if let Some(tile) = arguments.tile {
        let tile = check_tile(tile, &loaded.scene, &formats)?;
        let picture = supervised(tile.height.into(), "rendering", |_, supervision| {
            render::render_tile(&prepared, wanted, tile, supervision)
        });
        let picture = told(picture?);
        return write_each(formats, |path, _| Ok(output::write(&picture, path)?));
    }
    let is_image = matches!(formats[..], [(_, PictureFormat::Pixels(Format::Png))])
        && shown.map.name().is_none();
    let strips = arguments.resume.then(|| Strips::beside(formats[0].0, &prepared, wanted));
    let strips = strips.transpose()?;
    if is_image && render::strips(&prepared).nth(1).is_some() {
        in_strips(&prepared, strips.as_ref(), formats[0].0)?;
    } else {
        let picture = match &strips {
            Some(strips) => merged(&prepared, wanted, strips)?,
            None => picture(&prepared, wanted, "rendering")?,
        };
        write_each(formats, |path, format| Ok(write_picture(&picture, shown, format, path)?))?;
    }
    if let Some(strips) = strips {
        strips.remove();
    }
    if arguments.outputs.is_empty() {
        outputs.iter().for_each(|path| wrote(path));
    }
    Ok(())
}

/// The files asked for, or the picture that goes beside the scene and has its name: `cloak.png` for
/// `cloak.toml`, in the working folder for an example that is no file.
fn outputs(arguments: &RenderArguments) -> Result<Vec<PathBuf>> {
    let scene = &arguments.scene.scene;
    if !arguments.outputs.is_empty() {
        return Ok(arguments.outputs.clone());
    }
    if scene == Path::new("-") {
        let message = "a scene from standard input has no name for its picture; give one: -o FILE";
        return Err(Failure::Usage(message.to_owned()));
    }
    let beside = scene.with_extension("png");
    let name = beside.file_name().map(PathBuf::from);
    Ok(vec![name.filter(|_| scene::example(scene).is_some()).unwrap_or(beside)])
}

/// The picture of its strips, those that are there and the others, rendered one after the other.
fn merged(
    prepared: &PreparedScene<'_>,
    wanted: ChannelSet,
    strips: &Strips<'_>,
) -> Result<Picture> {
    // The strips are there beside the picture for a moment.
    let [width, height] = prepared.scene.camera.resolution;
    render::check_memory(prepared, wanted, Tile { left: 0, top: 0, width, height })?;
    let (mut parts, mut stats, mut most) = (Vec::new(), TraceStats::default(), 0.0);
    supervised(prepared.rows(), "rendering", |_, supervision| {
        for part in render::small_strips(prepared) {
            let Rendered { picture, stats: of_part, most_pruned } =
                strips.strip(part, supervision)?;
            stats += of_part;
            most = f64::max(most, most_pruned);
            parts.push((part.to_string(), picture.metadata.clone(), picture));
        }
        Ok::<_, Failure>(())
    })?;
    warn_of_cut_branches(&stats);
    warn_of_pruned_light(most);
    Ok(render::merge(&parts)?)
}

/// The tile, if the picture has one there and its files can be tiles.
fn check_tile(tile: Tile, scene: &Scene, formats: &[(&Path, PictureFormat)]) -> Result<Tile> {
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
    Ok(tile.check(scene.camera.resolution)?)
}

/// Renders a large image strip by strip into its file; finished ones may be kept.
fn in_strips(prepared: &PreparedScene<'_>, kept: Option<&Strips<'_>>, path: &Path) -> Result<()> {
    let (mut stats, mut most, mut failure) = (TraceStats::default(), 0.0, None);
    let written = supervised(prepared.rows(), "rendering", |_, supervision| {
        let strip = |part| match kept {
            Some(strips) => strips.strip(part, supervision),
            None => Ok(render::render_part(prepared, ChannelSet::Image, part, supervision)?),
        };
        let parts: Vec<Tile> = match kept {
            Some(_) => render::small_strips(prepared).collect(),
            None => render::strips(prepared).collect(),
        };
        let images = parts.into_iter().map(|part| {
            let image = strip(part).and_then(|strip| {
                stats += strip.stats;
                most = f64::max(most, strip.most_pruned);
                Ok(output::to_srgb(&strip.picture)?)
            });
            image.map_err(|error| {
                failure = Some(error);
                io::Error::other("no strip")
            })
        });
        let (size, metadata) = (prepared.scene.camera.resolution, prepared.metadata());
        output::write_png_in_strips(size, &metadata, path, images)
    });
    failure.map_or(Ok(()), Err)?;
    written?;
    warn_of_cut_branches(&stats);
    warn_of_pruned_light(most);
    Ok(())
}

/// The override that asks for more channels; only files of data hold them.
fn channels(names: &[String], data: bool) -> Result<Option<String>> {
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

/// Renders with a progress bar, and says what was rare.
pub fn picture(prepared: &PreparedScene<'_>, wanted: ChannelSet, what: &str) -> Result<Picture> {
    let rendered = supervised(prepared.rows(), what, |_, supervision| {
        render::render(prepared, wanted, supervision)
    });
    Ok(told(rendered?))
}

/// The picture, once it has been said what was rare in it.
fn told(rendered: Rendered) -> Picture {
    warn_of_cut_branches(&rendered.stats);
    warn_of_pruned_light(rendered.most_pruned);
    rendered.picture
}

/// Up to this share of a pixel's light in branches too weak to follow is not worth a word.
const MUCH_PRUNED: f64 = 0.01;

/// Says how much light was not followed, if it was much.
fn warn_of_pruned_light(most: f64) {
    if most > MUCH_PRUNED {
        say(&format!(
            "note: of the light of a pixel up to {:.0} % is in branches too weak to follow, and missing; a smaller trace.min_power \
             follows them, and map = \"pruned\" shows where",
            100.0 * most
        ));
    }
}

/// Says what was rare, if anything was.
pub fn warn_of_cut_branches(stats: &TraceStats) {
    for (count, what) in [
        (stats.endless, "of ray trees without end were cut, the weakest first"),
        (stats.lost, "could not be followed through a device"),
    ] {
        if count > 0 {
            say(&format!("note: {count} branches {what}; their power is in `pruned`"));
        }
    }
}
