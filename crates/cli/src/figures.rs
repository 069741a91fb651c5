//! `cloakroom figures`: the figures of the paper, drawn and rendered.

use crate::arguments::FiguresArguments;
use crate::files::make_folder;
use crate::interruption;
use crate::panels::{merge, write_drawing, write_png};
use crate::render::rgb;
use crate::report::{Failure, Result};
use crate::scene;
use crate::views::{Subject, Views};
use cloakroom::output::RgbImage;
use cloakroom::render::Images;
use cloakroom::scene_file::Loaded;
use cloakroom_figures::paper::{self, PANELS, Panel, Shows, TITLES};
use cloakroom_figures::{ColorBar, ScalarMap, Setting, SheetPanel, sheet};
use std::path::PathBuf;

/// Makes panels and sheets.
pub fn run(arguments: &FiguresArguments) -> Result<()> {
    let chosen = paper::select(&arguments.only).map_err(Failure::Usage)?;
    scene::use_threads(&arguments.panels.threads)?;
    make_folder(&arguments.out)?;
    let _busy = interruption::busy();
    let mut images = Images::default();
    for panels in chosen.chunk_by(|one, next| one.figure == next.figure) {
        make(panels, arguments, &mut images)?;
    }
    Ok(())
}

/// Makes the chosen panels of one figure, and its sheet if all of them are chosen.
fn make(
    chosen: &[&'static Panel],
    arguments: &FiguresArguments,
    images: &mut Images,
) -> Result<()> {
    let mut on_sheet = Vec::new();
    let mut metadata: Vec<(String, String)> = Vec::new();
    let mut views = Views::new(chosen, arguments)?;
    for (index, panel) in chosen.iter().enumerate() {
        let (image, bar, of_panel) = match panel.shows {
            Shows::Picture => rendered(&mut views, index, arguments, images)?,
            Shows::Setting => drawn(panel, &views.subjects[index].loaded, arguments)?,
        };
        merge(&mut metadata, &of_panel);
        let (label, caption) = (format!("({})", panel.letter), panel.caption.to_owned());
        on_sheet.push(SheetPanel { image, label, caption, bar });
    }
    let number = chosen[0].figure;
    if chosen.len() == PANELS.iter().filter(|panel| panel.figure == number).count() {
        let title = format!("Figure {number}. {}", TITLES[number - 1]);
        let drawing = sheet(&title, &on_sheet);
        let files = ["png", "pdf"].map(|ending| file(&number.to_string(), ending, arguments));
        write_drawing(&drawing, &title, &metadata, drawing.pixels(), &files)?;
    }
    Ok(())
}

/// A panel that has been written, for its sheet: what it shows, the colors of a map, and the metadata.
type Shown = (RgbImage, Option<ColorBar>, Vec<(String, String)>);

/// Renders a panel and writes it.
fn rendered(
    views: &mut Views,
    index: usize,
    arguments: &FiguresArguments,
    images: &mut Images,
) -> Result<Shown> {
    let picture = views.picture(index, images)?;
    let Subject { panel, loaded, .. } = &views.subjects[index];
    let image = rgb(&loaded.scene, &picture)?;
    let map = loaded.scene.picture.map.name();
    let map = map.map(|channel| ScalarMap::new(&picture, channel, None)).transpose()?;
    write_png(&image, &picture.metadata, &file(panel.name, "png", arguments))?;
    Ok((image, map.map(|map| map.bar), picture.metadata))
}

/// Draws the setting of a panel and writes it, in pixels and as lines.
fn drawn(panel: &Panel, loaded: &Loaded, arguments: &FiguresArguments) -> Result<Shown> {
    let Setting { drawing, metadata, .. } =
        cloakroom_figures::setting(&loaded.scene).map_err(|e| scene::located(loaded, &e))?;
    let size = arguments.panels.size;
    let image = drawing.to_image(size)?;
    write_png(&image, &metadata, &file(panel.name, "png", arguments))?;
    let files = ["svg", "pdf"].map(|ending| file(panel.name, ending, arguments));
    write_drawing(&drawing, panel.caption, &metadata, size, &files)?;
    Ok((image, None, metadata))
}

/// The file of a panel or of a sheet.
fn file(name: &str, ending: &str, arguments: &FiguresArguments) -> PathBuf {
    arguments.out.join(format!("fig{name}.{ending}"))
}
