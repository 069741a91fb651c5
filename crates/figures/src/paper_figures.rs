//! The figures of the paper, rendered and drawn. Panels that differ in nothing but the polarizer, or
//! in that one of them shows a map of their figure, share their rays, which are traced once.

use crate::panels::{PanelMaker, merge_metadata};
use crate::paper::{PANELS, Panel, Shows, TITLES};
use crate::{ColorBar, IllustrationError, ScalarMap, Setting, SheetPanel, setting, sheet};
use cloakroom::output::{OutputError, Picture, RgbImage};
use cloakroom::render::{ChannelSet, INPUTS, metadata};
use cloakroom::scene::Polarizer;
use cloakroom::scene_file::{Loaded, SceneFileError};
use std::collections::HashMap;

/// The names of the files of chosen panels and their sheets, without endings.
pub fn names(chosen: &[&'static Panel]) -> impl Iterator<Item = String> {
    let sheets = chosen.iter().map(|panel| file(&panel.figure.to_string()));
    chosen.iter().map(|panel| file(panel.name)).chain(sheets)
}

/// The file of a panel or of a sheet, without its ending.
fn file(name: &str) -> String {
    format!("fig{name}")
}

/// Makes chosen panels, and the sheets of the figures of which all are chosen.
///
/// # Errors
///
/// If a scene cannot be, something cannot be rendered or drawn, or a file not be written.
pub fn make<E>(chosen: &[&'static Panel], maker: &mut PanelMaker<'_, E>) -> Result<(), E>
where
    E: From<SceneFileError> + From<IllustrationError> + From<OutputError>,
{
    let mut views = Views::new(chosen, maker)?;
    let mut first = 0;
    for panels in chosen.chunk_by(|one, next| one.figure == next.figure) {
        make_figure(panels, first, &mut views, maker)?;
        first += panels.len();
    }
    Ok(())
}

/// Makes the chosen panels of one figure, the first of which has that place among all, and its sheet
/// if all of them are chosen.
fn make_figure<E>(
    chosen: &[&'static Panel],
    first: usize,
    views: &mut Views,
    maker: &mut PanelMaker<'_, E>,
) -> Result<(), E>
where
    E: From<SceneFileError> + From<IllustrationError> + From<OutputError>,
{
    let mut on_sheet = Vec::new();
    let mut metadata: Vec<(String, String)> = Vec::new();
    for (index, panel) in (first..).zip(chosen) {
        let (image, bar, of_panel) = match panel.shows {
            Shows::Picture => rendered(views, index, maker)?,
            Shows::Setting => drawn(panel, &views.subjects[index].loaded, maker)?,
        };
        merge_metadata(&mut metadata, &of_panel);
        let (label, caption) = (format!("({})", panel.letter), panel.caption.to_owned());
        on_sheet.push(SheetPanel { image, label, caption, bar });
    }
    let number = chosen[0].figure;
    if chosen.len() == PANELS.iter().filter(|panel| panel.figure == number).count() {
        let title = format!("Figure {number}. {}", TITLES[number - 1]);
        let drawing = sheet(&title, &on_sheet);
        let name = file(&number.to_string());
        maker.write_drawing(&drawing, &title, &metadata, drawing.pixels(), &name)?;
    }
    Ok(())
}

/// A panel that has been written, for its sheet: what it shows, the colors of a map, and the
/// metadata.
type Shown = (RgbImage, Option<ColorBar>, Vec<(String, String)>);

/// Renders a panel and writes it; a map is drawn.
fn rendered<E>(views: &mut Views, index: usize, maker: &mut PanelMaker<'_, E>) -> Result<Shown, E>
where
    E: From<SceneFileError> + From<IllustrationError> + From<OutputError>,
{
    let picture = views.picture(index, maker)?;
    let Subject { panel, loaded, .. } = &views.subjects[index];
    let name = file(panel.name);
    let Some(channel) = loaded.scene.picture.map.name() else {
        let image = maker.write_shown(loaded, &picture, &name)?;
        return Ok((image, None, picture.metadata));
    };
    let map = ScalarMap::new(&picture, channel, &loaded.scene.picture)?;
    let drawing = map.draw(loaded.scene.picture.color_bar);
    let metadata = picture.metadata;
    let image = maker.write_drawing(&drawing, panel.caption, &metadata, drawing.pixels(), &name)?;
    Ok((image, Some(map.bar), metadata))
}

/// Draws the setting of a panel and writes it.
fn drawn<E>(panel: &Panel, loaded: &Loaded, maker: &mut PanelMaker<'_, E>) -> Result<Shown, E>
where
    E: From<SceneFileError> + From<IllustrationError> + From<OutputError>,
{
    let drawn = setting(&loaded.scene, loaded.scene.camera.resolution);
    let Setting { drawing, metadata, .. } =
        drawn.map_err(|error| loaded.locations.error_at(&error.key(), error.to_string()))?;
    let (size, name) = (maker.settings.size, file(panel.name));
    let image = maker.write_drawing(&drawing, panel.caption, &metadata, size, &name)?;
    Ok((image, None, metadata))
}

/// A panel and its scene.
struct Subject {
    panel: &'static Panel,
    loaded: Loaded,
    /// Its scene without polarizer and with the figure's map: the same text for panels that share
    /// their rays. `None` if it shares them with no other.
    view: Option<Loaded>,
}

/// The chosen panels, and the pictures of the views that they share, as long as they are needed.
struct Views {
    subjects: Vec<Subject>,
    /// By the text of their scenes.
    pictures: HashMap<String, Picture>,
}

impl Subject {
    /// What must be rendered of a view for it.
    fn wanted_of_view(&self) -> ChannelSet {
        let own = ChannelSet::for_image(&self.loaded.scene.picture);
        let polarizer = self.loaded.scene.camera.polarizer;
        if polarizer == Polarizer::None { own } else { own.max(ChannelSet::Polarizers) }
    }

    fn view_text(&self) -> Option<&str> {
        self.view.as_ref().map(|view| view.scene.source.as_str())
    }

    /// Its own picture out of that of its view.
    fn of_view(&self, view: &Picture) -> Option<Picture> {
        let polarizer = self.loaded.scene.camera.polarizer;
        let own = match (self.loaded.scene.picture.map.name(), polarizer) {
            (Some(_), _) => view.clone(),
            (None, Polarizer::None) => view.image_through("")?,
            (None, _) => view.image_through(&polarizer.to_string())?,
        };
        let mut metadata = metadata(&self.loaded.scene);
        metadata.extend(own.metadata.into_iter().filter(|(key, _)| key == INPUTS));
        Some(Picture { metadata, ..own })
    }
}

impl Views {
    /// Reads the scenes of panels.
    fn new<E>(panels: &[&'static Panel], maker: &PanelMaker<'_, E>) -> Result<Self, SceneFileError>
    where
        E: From<SceneFileError> + From<IllustrationError> + From<OutputError>,
    {
        let load = |panel: &Panel, overrides: &[&str]| {
            maker.load(panel.scene, &format!("fig{}", panel.name), overrides)
        };
        let subject = |panel: &&'static Panel| {
            Ok::<_, SceneFileError>(Subject { panel, loaded: load(panel, &[])?, view: None })
        };
        let mut subjects = panels.iter().map(subject).collect::<Result<Vec<_>, _>>()?;
        for figure in subjects.chunk_by_mut(|one, next| one.panel.figure == next.panel.figure) {
            let map = figure.iter().find_map(|subject| subject.loaded.scene.picture.map.name());
            let map_override = map.map(|map| format!("picture.map={map}"));
            let overrides: Vec<&str> =
                std::iter::once("camera.polarizer=none").chain(map_override.as_deref()).collect();
            for Subject { panel, loaded, view } in figure {
                let (own_map, polarizer) =
                    (loaded.scene.picture.map.name(), loaded.scene.camera.polarizer);
                let shares = match polarizer {
                    Polarizer::None => own_map.is_none() || own_map == map,
                    Polarizer::Horizontal | Polarizer::Vertical => map.is_none(),
                    Polarizer::Angle(_) => false,
                };
                if panel.shows == Shows::Picture && shares {
                    *view = Some(load(panel, &overrides)?);
                }
            }
        }
        Ok(Self { subjects, pictures: HashMap::new() })
    }

    /// The picture of a panel, given its place among the panels.
    fn picture<E>(&mut self, index: usize, maker: &mut PanelMaker<'_, E>) -> Result<Picture, E>
    where
        E: From<SceneFileError> + From<IllustrationError> + From<OutputError>,
    {
        let subject = &self.subjects[index];
        let what = format!("figure {}", subject.panel.name);
        let mut render = |loaded: &Loaded, wanted| maker.picture(loaded, wanted, &what);
        let sharing = || self.subjects.iter().filter(|s| s.view_text() == subject.view_text());
        if let Some(view) = &subject.view
            && sharing().nth(1).is_some()
        {
            let text = &view.scene.source;
            if !self.pictures.contains_key(text) {
                let wanted =
                    sharing().map(Subject::wanted_of_view).fold(ChannelSet::Image, ChannelSet::max);
                self.pictures.insert(text.clone(), render(view, wanted)?);
            }
            if let Some(picture) = self.pictures.get(text).and_then(|view| subject.of_view(view)) {
                let mut later = self.subjects[index + 1..].iter();
                if later.all(|later| later.view_text() != Some(text)) {
                    self.pictures.remove(text);
                }
                return Ok(picture);
            }
        }
        render(&subject.loaded, ChannelSet::for_image(&subject.loaded.scene.picture))
    }
}
