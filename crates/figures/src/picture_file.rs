//! Pictures as files: data, images, and maps drawn with their colour bars.

use super::drawing::DrawingFormat;
use super::{IllustrationError, ScalarMap};
use cloakroom::output::{
    Format, OutputError, Picture, RgbImage, format_of, to_srgb, write, write_png,
};
use cloakroom::scene::PictureSettings;
use std::path::Path;

/// A format of files of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Pixels or data.
    Pixels(Format),
    /// The map of a channel, drawn.
    Map(DrawingFormat),
}

impl PictureFormat {
    /// The format that the ending of a file's name asks for.
    ///
    /// # Errors
    ///
    /// [`OutputError::UnknownFormat`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        let [png, exr, npz] = [Format::Png, Format::Exr, Format::Npz].map(Self::Pixels);
        let [svg, pdf] = [DrawingFormat::Svg, DrawingFormat::Pdf].map(Self::Map);
        let known = ".png, .exr or .npz, for a map also .svg or .pdf".to_owned();
        format_of(path, &[("png", png), ("exr", exr), ("npz", npz), ("svg", svg), ("pdf", pdf)])
            .map_err(|_| OutputError::UnknownFormat { path: path.to_owned(), known })
    }

    /// Whether a file of the format shows what people see, and is no data.
    #[must_use]
    pub fn is_shown(self) -> bool {
        matches!(self, Self::Pixels(Format::Png) | Self::Map(_))
    }
}

/// What an image of a picture shows: what the camera sees, or the map of a channel, if the settings
/// name one.
///
/// # Errors
///
/// If the picture has no image, the map is impossible, or does not fit into the memory.
pub fn shown(picture: &Picture, settings: &PictureSettings) -> Result<RgbImage, IllustrationError> {
    match settings.map.name() {
        None => Ok(to_srgb(picture)?),
        Some(channel) => ScalarMap::new(picture, channel, settings)?.into_image(settings.color_bar),
    }
}

/// Writes a picture; the settings say what is to be seen.
///
/// # Errors
///
/// If a map is impossible, or not asked for and the format holds nothing else, or the file cannot
/// be written.
pub fn write_picture(
    picture: &Picture,
    settings: &PictureSettings,
    format: PictureFormat,
    path: &Path,
) -> Result<(), IllustrationError> {
    match (format, settings.map.name()) {
        (PictureFormat::Map(format), Some(channel)) => {
            let map = ScalarMap::new(picture, channel, settings)?;
            let drawing = map.draw(settings.color_bar);
            let title = &map.bar.quantity.title;
            drawing.write(format, title, &picture.metadata, drawing.pixels(), path)
        }
        (PictureFormat::Map(_), _) => Err(IllustrationError::NoMap { path: path.to_owned() }),
        (PictureFormat::Pixels(Format::Png), _) => {
            Ok(write_png(&shown(picture, settings)?, &picture.metadata, path)?)
        }
        (PictureFormat::Pixels(_), _) => Ok(write(picture, path)?),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloakroom::output::{Channel, Samples};
    use cloakroom::scene::MapChannel;

    #[test]
    fn maps_are_drawn_and_images_are_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let names = ["R", "G", "B", "delivered"];
        let channels = names.map(|name| Channel {
            name: name.to_owned(),
            samples: Samples::F32(vec![0.0, 0.25, 0.5, 1.0]),
        });
        let channels = channels.to_vec();
        let picture = Picture { width: 2, height: 2, channels, metadata: Vec::new() };
        let written = |name: &str, (map, color_bar)| {
            let settings = PictureSettings { map, color_bar, ..PictureSettings::default() };
            let path = folder.path().join(name);
            let format = PictureFormat::of(&path).expect(name);
            write_picture(&picture, &settings, format, &path)?;
            Ok::<_, IllustrationError>(std::fs::read(path).expect(name))
        };
        let map = (MapChannel::Delivered, true);
        let svg = String::from_utf8(written("a.svg", map).expect("a file")).expect("text");
        assert!(svg.contains("aria-label=\"power delivered (%)\""), "{svg}");
        assert!(written("a.pdf", map).expect("a file").starts_with(b"%PDF"));
        let bare = String::from_utf8(written("b.svg", (map.0, false)).expect("a file"));
        assert!(!bare.expect("text").contains("aria-label"));
        let error = written("c.pdf", (MapChannel::None, true)).expect_err("no map").to_string();
        assert!(error.contains("c.pdf would be a map") && !folder.path().join("c.pdf").exists());
        for (name, map) in [("d.png", (MapChannel::None, true)), ("e.png", (map.0, false))] {
            written(name, map).expect(name);
            let image = image::open(folder.path().join(name)).expect("an image");
            assert_eq!((image.width(), image.height()), (2, 2));
        }
        assert!(written("f.npz", map).is_ok());
        let message = PictureFormat::of("a.jpg".as_ref()).expect_err("unknown").to_string();
        assert!(message.contains(".png, .exr or .npz, for a map also .svg or .pdf"), "{message}");
    }
}
