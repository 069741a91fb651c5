//! Images that have been read, kept for the next scene that shows them.

use super::StudioError;
use super::studio::Surroundings;
use crate::photograph::{self, Edges, Equirectangular, ImageSource, LinearImage, Pyramid};
use crate::scene::{Scene, SurroundingsSettings};
use std::sync::Arc;

/// The photograph and the surroundings that were read last. Scenes that are looked at one after the other mostly show
/// the same.
#[derive(Clone, Debug, Default)]
pub struct Images {
    photograph: Option<(ImageSource, Arc<Pyramid>)>,
    surroundings: Option<(ImageSource, Arc<Equirectangular>)>,
}

impl Images {
    /// Hangs an image up as the photograph of that name: scenes that name it show this, and no file is read.
    pub fn hang(&mut self, name: ImageSource, image: LinearImage) {
        self.photograph = Some((name, Arc::new(Pyramid::new(image, Edges::Clamp))));
    }

    /// The photograph of a scene.
    pub(super) fn photograph(&mut self, scene: &Scene) -> Result<Arc<Pyramid>, StudioError> {
        let source = &scene.photograph.image;
        match &self.photograph {
            Some((known, image)) if known == source => Ok(image.clone()),
            _ => {
                let image = photograph::load(source).map_err(StudioError::Photograph)?;
                let image = Arc::new(Pyramid::new(image, Edges::Clamp));
                self.photograph = Some((source.clone(), image.clone()));
                Ok(image)
            }
        }
    }

    /// The surroundings of a scene.
    pub(super) fn surroundings(&mut self, scene: &Scene) -> Result<Surroundings, StudioError> {
        let source = match &scene.surroundings {
            SurroundingsSettings::Color(color) => return Ok(Surroundings::Color(*color)),
            SurroundingsSettings::Image(source) => source,
        };
        match &self.surroundings {
            Some((known, image)) if known == source => Ok(Surroundings::Image(image.clone())),
            _ => {
                let image = photograph::load(source).map_err(StudioError::Surroundings)?;
                let image = Arc::new(Equirectangular::new(image));
                self.surroundings = Some((source.clone(), image.clone()));
                Ok(Surroundings::Image(image))
            }
        }
    }
}
