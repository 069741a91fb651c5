//! `cloakroom figures`: the figures of the paper, drawn and rendered.

use crate::arguments::FiguresArguments;
use crate::interruption;
use crate::panels::{self, merge, write_png};
use crate::render::{picture, rgb, tell_rarities};
use crate::report::{Failure, say};
use crate::scene;
use cloakroom::illustration::{self, ColorBar, ScalarMap, Setting, SheetPanel, sheet};
use cloakroom::output::{self, RgbImage};
use cloakroom::paper::{self, Figure, Panel, Shows};
use cloakroom::render::{Rendered, Studio, Wanted};
use cloakroom::scene_file::Loaded;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// Makes panels and sheets.
pub fn run(arguments: &FiguresArguments, stop: &AtomicBool) -> Result<(), Failure> {
    let chosen = paper::select(&arguments.only).map_err(Failure::Usage)?;
    scene::use_threads(arguments.panels.threads)?;
    panels::make_folder(&arguments.out)?;
    let _busy = interruption::busy();
    for (figure, panels) in chosen {
        make(figure, &panels, arguments, stop)?;
    }
    Ok(())
}

/// Makes the chosen panels of one figure, and its sheet if all of them are chosen.
fn make(
    figure: &Figure,
    chosen: &[&Panel],
    arguments: &FiguresArguments,
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let mut on_sheet = Vec::new();
    let mut metadata: Vec<(String, String)> = Vec::new();
    for panel in chosen {
        let name = format!("fig{}", panel.name);
        let loaded = panels::load(panel.scene, &name, &arguments.panels)?;
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
    if chosen.len() == figure.panels.len() {
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
    let image = drawing.to_image(arguments.panels.size).map_err(Failure::from_error)?;
    let svg = drawing.to_svg(arguments.panels.size, panel.caption, &metadata);
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
