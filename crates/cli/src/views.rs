//! What the panels of a figure look at: panels that differ in nothing but the polarizer, or in that
//! one of them shows a map, share their rays, which are traced once.

use crate::arguments::FiguresArguments;
use crate::panels;
use crate::render::picture;
use crate::report::{Failure, Result};
use crate::scene;
use cloakroom::output::Picture;
use cloakroom::render::{ChannelSet, INPUTS, Images, metadata};
use cloakroom::scene::Polarizer;
use cloakroom::scene_file::Loaded;
use cloakroom_figures::paper::{Panel, Shows};
use std::collections::HashMap;

/// A panel and its scene.
pub struct Subject {
    pub panel: &'static Panel,
    pub loaded: Loaded,
    /// Its scene without polarizer and with the figure's map: the same text for panels that share
    /// their rays. `None` if it shares them with no other.
    view: Option<Loaded>,
}

/// The panels of a figure, and the pictures of the views that they share, as far as they have been
/// needed.
pub struct Views {
    pub subjects: Vec<Subject>,
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
    pub fn new(panels: &[&'static Panel], arguments: &FiguresArguments) -> Result<Self> {
        let load = |panel: &Panel, overrides: &[&str]| {
            panels::load(panel.scene, &format!("fig{}", panel.name), &arguments.panels, overrides)
        };
        let subject = |panel: &&'static Panel| {
            Ok::<_, Failure>(Subject { panel, loaded: load(panel, &[])?, view: None })
        };
        let mut subjects = panels.iter().map(subject).collect::<Result<Vec<_>, _>>()?;
        let map = subjects.iter().find_map(|subject| subject.loaded.scene.picture.map.name());
        let map_override = map.map(|map| format!("picture.map={map}"));
        let overrides: Vec<&str> =
            std::iter::once("camera.polarizer=none").chain(map_override.as_deref()).collect();
        for Subject { panel, loaded, view } in &mut subjects {
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
        Ok(Self { subjects, pictures: HashMap::new() })
    }

    /// The picture of a panel, given its place among the panels.
    pub fn picture(&mut self, index: usize, images: &mut Images) -> Result<Picture> {
        let subject = &self.subjects[index];
        let what = format!("figure {}", subject.panel.name);
        let mut render =
            |loaded: &Loaded, wanted| picture(&scene::prepared(loaded, images)?, wanted, &what);
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
                return Ok(picture);
            }
        }
        render(&subject.loaded, ChannelSet::for_image(&subject.loaded.scene.picture))
    }
}
