//! Images that have been read, kept for the next scene that shows them.

use crate::input::Digest;
use crate::photograph::{
    self, Edges, Equirectangular, ImageSource, LinearImage, LoadError, Pyramid,
};
use std::path::{Path, PathBuf};
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
    /// The contents of the files that have been read.
    digests: Vec<(PathBuf, Digest)>,
}

impl Images {
    /// Hangs an image up as the photograph of that name: scenes that name it show this, and no file
    /// is read.
    pub fn hang(&mut self, name: ImageSource, image: LinearImage) {
        self.photograph = vec![(name, Arc::new(flat(image)))];
    }

    /// What was read from a file.
    pub(super) fn digest_of(&self, path: &Path) -> Option<Digest> {
        Some(self.digests.iter().find(|(known, _)| known == path)?.1)
    }

    /// The image of a photograph.
    ///
    /// # Errors
    ///
    /// If it cannot be read.
    pub fn photograph(&mut self, source: &ImageSource) -> Result<Arc<Pyramid>, LoadError> {
        let image = known((&mut self.photograph, &mut self.digests), source, flat)?;
        self.photograph.retain(|(name, _)| name == source);
        Ok(image)
    }

    /// The image of surroundings.
    pub(super) fn around(
        &mut self,
        source: &ImageSource,
    ) -> Result<Arc<Equirectangular>, LoadError> {
        let known_images = (&mut self.surroundings, &mut self.digests);
        let image = known(known_images, source, Equirectangular::new)?;
        self.surroundings.retain(|(name, _)| name == source);
        Ok(image)
    }

    /// An image for flat faces of a body, which ends at their edges.
    pub(super) fn face(&mut self, source: &ImageSource) -> Result<Arc<Pyramid>, LoadError> {
        known((&mut self.faces, &mut self.digests), source, flat)
    }

    /// An image that goes once around the side of a cylinder.
    pub(super) fn side(&mut self, source: &ImageSource) -> Result<Arc<Pyramid>, LoadError> {
        known((&mut self.sides, &mut self.digests), source, |image| {
            Pyramid::new(image, Edges::WrapHorizontally)
        })
    }

    /// An image that covers a ball.
    pub(super) fn ball(&mut self, source: &ImageSource) -> Result<Arc<Equirectangular>, LoadError> {
        known((&mut self.balls, &mut self.digests), source, Equirectangular::new)
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
    (images, digests): (&mut Named<T>, &mut Vec<(PathBuf, Digest)>),
    source: &ImageSource,
    make: impl FnOnce(LinearImage) -> T,
) -> Result<Arc<T>, LoadError> {
    if let Some((_, image)) = images.iter().find(|(name, _)| name == source) {
        return Ok(image.clone());
    }
    let (image, digest) = photograph::load_with_digest(source)?;
    if let (ImageSource::File(path), Some(digest)) = (source, digest) {
        digests.retain(|(known, _)| known != path);
        digests.push((path.clone(), digest));
    }
    let image = Arc::new(make(image));
    images.push((source.clone(), image.clone()));
    Ok(image)
}
