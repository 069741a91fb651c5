//! `cloakroom figures`: the figures of the paper, drawn and rendered.

use crate::arguments::FiguresArguments;
use crate::interruption;
use crate::render::{picture, rgb, tell_rarities};
use crate::report::{Failure, say};
use crate::scene;
use cloakroom::illustration::{self, ColorBar, ScalarMap, Setting, SheetPanel, sheet};
use cloakroom::output::{self, RgbImage};
use cloakroom::paper::{self, Figure, Panel, Shows};
use cloakroom::render::{Rendered, Studio, Wanted};
use cloakroom::scene_file::{self, Loaded};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Makes panels and sheets.
pub fn run(arguments: &FiguresArguments, stop: &AtomicBool) -> Result<(), Failure> {
    let chosen = paper::select(&arguments.only).map_err(Failure::Usage)?;
    scene::use_threads(arguments.threads)?;
    std::fs::create_dir_all(&arguments.out).map_err(|error| {
        Failure::Failed(format!("cannot make the folder {}: {error}", arguments.out.display()))
    })?;
    let _busy = interruption::busy();
    for (figure, panels) in chosen {
        make(figure, &panels, arguments, stop)?;
    }
    Ok(())
}

/// Makes the chosen panels of one figure, and its sheet if all of them are chosen.
fn make(
    figure: &Figure,
    panels: &[&Panel],
    arguments: &FiguresArguments,
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let mut on_sheet = Vec::new();
    let mut metadata: Vec<(String, String)> = Vec::new();
    for panel in panels {
        let loaded = scene_file::parse(
            panel.scene,
            &format!("fig{}.toml", panel.name),
            Path::new(""),
            &overrides(arguments),
        )
        .map_err(Failure::from_error)?;
        let shown = match panel.shows {
            Shows::Picture => rendered(panel, &loaded, arguments, stop)?,
            Shows::Setting => drawn(panel, &loaded, arguments)?,
        };
        merge(&mut metadata, &shown.metadata);
        on_sheet.push(SheetPanel {
            image: shown.image,
            label: format!("({})", panel.letter()),
            caption: panel.caption.to_owned(),
            bar: shown.bar,
        });
    }
    if panels.len() == figure.panels.len() {
        let title = format!("Figure {}. {}", figure.number, figure.title);
        let path = arguments.out.join(format!("fig{}.png", figure.number));
        write_png(&sheet(&title, &on_sheet), &metadata, &path)?;
    }
    Ok(())
}

/// A panel that has been written, for its sheet.
struct Shown {
    image: RgbImage,
    bar: Option<ColorBar>,
    metadata: Vec<(String, String)>,
}

/// Renders a panel and writes it.
fn rendered(
    panel: &Panel,
    loaded: &Loaded,
    arguments: &FiguresArguments,
    stop: &AtomicBool,
) -> Result<Shown, Failure> {
    let scene = &loaded.scene;
    let studio = Studio::new(scene).map_err(|e| scene::located(loaded, &e))?;
    let wanted = if scene.picture.map.is_some() { Wanted::Everything } else { Wanted::Image };
    let what = format!("figure {}", panel.name);
    let Rendered { picture, rarities } = picture(&studio, wanted, &what, stop)?;
    tell_rarities(&rarities);
    let image = rgb(scene, &picture)?;
    let bar = match scene.picture.map {
        Some(channel) => Some(ScalarMap::new(&picture, channel).map_err(Failure::from_error)?.bar),
        None => None,
    };
    write_png(&image, &picture.metadata, &file(panel, "png", arguments))?;
    Ok(Shown { image, bar, metadata: picture.metadata })
}

/// Draws the setting of a panel and writes it, in pixels and as lines.
fn drawn(panel: &Panel, loaded: &Loaded, arguments: &FiguresArguments) -> Result<Shown, Failure> {
    let Setting { drawing, metadata, .. } =
        illustration::setting(&loaded.scene).map_err(|e| scene::located(loaded, &e))?;
    let image = drawing.to_image(arguments.size).map_err(Failure::from_error)?;
    let svg = drawing.to_svg(arguments.size, panel.caption, &metadata);
    write_png(&image, &metadata, &file(panel, "png", arguments))?;
    let path = file(panel, "svg", arguments);
    output::write_whole(&path, |out| out.write_all(svg.as_bytes())).map_err(Failure::from_error)?;
    say(&format!("{}", path.display()));
    Ok(Shown { image, bar: None, metadata })
}

/// The file of a panel.
fn file(panel: &Panel, ending: &str, arguments: &FiguresArguments) -> PathBuf {
    arguments.out.join(format!("fig{}.{ending}", panel.name))
}

/// Writes a PNG and says so.
fn write_png(image: &RgbImage, metadata: &[(String, String)], path: &Path) -> Result<(), Failure> {
    output::write_png(image, metadata, path).map_err(Failure::from_error)?;
    say(&format!("{}", path.display()));
    Ok(())
}

/// Adds a panel's metadata to that of its sheet: what differs from panel to panel, one after the other.
fn merge(sheet: &mut Vec<(String, String)>, panel: &[(String, String)]) {
    for (key, text) in panel {
        match sheet.iter_mut().find(|(known, _)| known == key) {
            Some((_, all)) if all != text => {
                all.push('\n');
                all.push_str(text);
            }
            Some(_) => {}
            None => sheet.push((key.clone(), text.clone())),
        }
    }
}

/// What the command line changes in every panel's scene.
fn overrides(arguments: &FiguresArguments) -> Vec<String> {
    let [width, height] = arguments.size;
    let mut list = vec![
        format!("camera.resolution=[{width}, {height}]"),
        format!("camera.samples={}", arguments.samples),
        // Panels carry no lettering.
        "picture.color_bar=false".to_owned(),
    ];
    if let Some(photo) = &arguments.photo {
        list.push(format!("photograph.image={}", photo.display()));
    }
    list
}
