//! Images that have been read, kept for the next scene that shows them.

use crate::photograph::{
    self, Edges, Equirectangular, ImageSource, LinearImage, LoadError, Pyramid,
};
use std::sync::Arc;

/// Images by their names.
type Named<T> = Vec<(ImageSource, Arc<T>)>;

/// The photograph, the surroundings and the images on bodies that were read last. Scenes that are
/// looked at one after the other mostly show the same.
#[derive(Clone, Debug, Default)]
pub struct Images {
    photograph: Named<Pyramid>,
    surroundings: Named<Equirectangular>,
    /// Those on opaque bodies.
    faces: Named<Pyramid>,
    sides: Named<Pyramid>,
    balls: Named<Equirectangular>,
}

impl Images {
    /// Hangs an image up as the photograph of that name: scenes that name it show this, and no file
    /// is read.
    pub fn hang(&mut self, name: ImageSource, image: LinearImage) {
        self.photograph = vec![(name, Arc::new(flat(image)))];
    }

    /// The image of a photograph.
    pub(super) fn photograph(&mut self, source: &ImageSource) -> Result<Arc<Pyramid>, LoadError> {
        let image = known(&mut self.photograph, source, flat)?;
        self.photograph.retain(|(name, _)| name == source);
        Ok(image)
    }

    /// The image of surroundings.
    pub(super) fn around(
        &mut self,
        source: &ImageSource,
    ) -> Result<Arc<Equirectangular>, LoadError> {
        let image = known(&mut self.surroundings, source, Equirectangular::new)?;
        self.surroundings.retain(|(name, _)| name == source);
        Ok(image)
    }

    /// An image for flat faces of a body, which ends at their edges.
    pub(super) fn face(&mut self, source: &ImageSource) -> Result<Arc<Pyramid>, LoadError> {
        known(&mut self.faces, source, flat)
    }

    /// An image that goes once around the side of a cylinder.
    pub(super) fn side(&mut self, source: &ImageSource) -> Result<Arc<Pyramid>, LoadError> {
        known(&mut self.sides, source, |image| Pyramid::new(image, Edges::WrapHorizontally))
    }

    /// An image that covers a ball.
    pub(super) fn ball(&mut self, source: &ImageSource) -> Result<Arc<Equirectangular>, LoadError> {
        known(&mut self.balls, source, Equirectangular::new)
    }

    /// Forgets all images on bodies but these, unless there are none: the next scene may show them
    /// again.
    pub(super) fn keep(&mut self, shown: &[ImageSource]) {
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
