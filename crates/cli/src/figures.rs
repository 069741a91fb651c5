//! `cloakroom figures`: the figures of the paper, drawn and rendered.

use crate::arguments::FiguresArguments;
use crate::interruption;
use crate::panels::{self, merge, write_drawing, write_png};
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
    let sheets = chosen.iter().map(|panel| file(&panel.figure.to_string(), arguments));
    let names = chosen.iter().map(|panel| file(panel.name, arguments)).chain(sheets);
    let mut images = panels::prepare(&arguments.panels, &arguments.out, names)?;
    let _busy = interruption::busy();
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
        let name = file(&number.to_string(), arguments);
        write_drawing(&drawing, &title, &metadata, drawing.pixels(), &name)?;
    }
    Ok(())
}

/// A panel that has been written, for its sheet: what it shows, the colors of a map, and the
/// metadata.
type Shown = (RgbImage, Option<ColorBar>, Vec<(String, String)>);

/// Renders a panel and writes it; a map is drawn.
fn rendered(
    views: &mut Views,
    index: usize,
    arguments: &FiguresArguments,
    images: &mut Images,
) -> Result<Shown> {
    let picture = views.picture(index, images)?;
    let Subject { panel, loaded, .. } = &views.subjects[index];
    let name = file(panel.name, arguments);
    let Some(channel) = loaded.scene.picture.map.name() else {
        let image = rgb(&loaded.scene, &picture)?;
        write_png(&image, &picture.metadata, &name.with_extension("png"))?;
        return Ok((image, None, picture.metadata));
    };
    let map = ScalarMap::new(&picture, channel, &loaded.scene.picture)?;
    let drawing = map.draw(loaded.scene.picture.color_bar);
    let metadata = picture.metadata;
    let image = write_drawing(&drawing, panel.caption, &metadata, drawing.pixels(), &name)?;
    Ok((image, Some(map.bar), metadata))
}

/// Draws the setting of a panel and writes it.
fn drawn(panel: &Panel, loaded: &Loaded, arguments: &FiguresArguments) -> Result<Shown> {
    let Setting { drawing, metadata, .. } =
        cloakroom_figures::setting(&loaded.scene).map_err(|e| scene::located(loaded, &e))?;
    let (size, name) = (arguments.panels.size, file(panel.name, arguments));
    let image = write_drawing(&drawing, panel.caption, &metadata, size, &name)?;
    Ok((image, None, metadata))
}

/// The files of a panel or of a sheet, without their endings.
fn file(name: &str, arguments: &FiguresArguments) -> PathBuf {
    arguments.out.join(format!("fig{name}"))
}
