//! Images that have been read, kept for the next scene that shows them.

use super::PreparedSceneError;
use super::prepared_scene::Surroundings;
use crate::photograph::{
    self, Edges, Equirectangular, ImageSource, LinearImage, LoadError, Pyramid,
};
use crate::scene::Scene;
use std::sync::Arc;

/// Images by their names.
type Named<T> = Vec<(ImageSource, Arc<T>)>;

/// The photograph, the surroundings and the images on bodies that were read last. Scenes that are looked at one after
/// the other mostly show the same.
#[derive(Clone, Debug, Default)]
pub struct Images {
    photograph: Named<Pyramid>,
    surroundings: Named<Equirectangular>,
    bodies: BodyImages,
}

/// The images on opaque bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct BodyImages {
    faces: Named<Pyramid>,
    sides: Named<Pyramid>,
    balls: Named<Equirectangular>,
}

impl Images {
    /// Hangs an image up as the photograph of that name: scenes that name it show this, and no file is read.
    pub fn hang(&mut self, name: ImageSource, image: LinearImage) {
        self.photograph = vec![(name, Arc::new(flat(image)))];
    }

    /// The photograph of a scene.
    pub(super) fn photograph(&mut self, scene: &Scene) -> Result<Arc<Pyramid>, PreparedSceneError> {
        last(&mut self.photograph, &scene.photograph.image, flat)
            .map_err(PreparedSceneError::Photograph)
    }

    /// The surroundings of a scene.
    pub(super) fn surroundings(
        &mut self,
        scene: &Scene,
    ) -> Result<Surroundings, PreparedSceneError> {
        match &scene.surroundings.image {
            None => Ok(Surroundings::Color(scene.surroundings.color.value)),
            Some(source) => {
                let image = last(&mut self.surroundings, source, Equirectangular::new);
                image.map(Surroundings::Image).map_err(PreparedSceneError::Surroundings)
            }
        }
    }

    /// The images on bodies.
    pub(super) fn bodies(&mut self) -> &mut BodyImages {
        &mut self.bodies
    }
}

impl BodyImages {
    /// An image for flat faces, which ends at their edges.
    pub fn face(&mut self, source: &ImageSource) -> Result<Arc<Pyramid>, LoadError> {
        known(&mut self.faces, source, flat)
    }

    /// An image that goes once around the side of a cylinder.
    pub fn side(&mut self, source: &ImageSource) -> Result<Arc<Pyramid>, LoadError> {
        known(&mut self.sides, source, |image| Pyramid::new(image, Edges::WrapHorizontally))
    }

    /// An image that covers a ball.
    pub fn ball(&mut self, source: &ImageSource) -> Result<Arc<Equirectangular>, LoadError> {
        known(&mut self.balls, source, Equirectangular::new)
    }

    /// Forgets all images but these, unless there are none: the next scene may show them again.
    pub fn keep(&mut self, shown: &[ImageSource]) {
        if !shown.is_empty() {
            self.faces.retain(|(name, _)| shown.contains(name));
            self.sides.retain(|(name, _)| shown.contains(name));
            self.balls.retain(|(name, _)| shown.contains(name));
        }
    }
}

/// An image that ends at its edges.
fn flat(image: LinearImage) -> Pyramid {
    Pyramid::new(image, Edges::Clamp)
}

/// The image that was read last, if it is this one, or read now instead of it.
fn last<T>(
    images: &mut Named<T>,
    source: &ImageSource,
    make: impl FnOnce(LinearImage) -> T,
) -> Result<Arc<T>, LoadError> {
    let image = known(images, source, make)?;
    images.retain(|(name, _)| name == source);
    Ok(image)
}

/// An image among those that are known, or read now.
fn known<T>(
    images: &mut Named<T>,
    source: &ImageSource,
    make: impl FnOnce(LinearImage) -> T,
) -> Result<Arc<T>, LoadError> {
    if let Some((_, image)) = images.iter().find(|(name, _)| name == source) {
        return Ok(image.clone());
    }
    let image = Arc::new(make(photograph::load(source)?));
    images.push((source.clone(), image.clone()));
    Ok(image)
}
