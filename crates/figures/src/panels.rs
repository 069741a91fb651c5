//! Panels: scenes that the program carries along, rendered and drawn into a folder.

use crate::{Drawing, DrawingFormat, IllustrationError, shown};
use cloakroom::output::{OutputError, Picture, RgbImage, write_png};
use cloakroom::photograph::{ImageSource, LoadError};
use cloakroom::render::{ChannelSet, Images, PreparedScene};
use cloakroom::scene_file::{self, Loaded, Override, SceneFileError};
use std::path::{Path, PathBuf};

/// What panels have in common.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PanelSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Camera rays per pixel.
    pub samples: u32,
    /// What hangs behind the devices instead of the builtin photograph.
    pub photo: Option<PathBuf>,
}

/// Renders what is called so of a prepared scene.
pub type RenderPanel<'a, E> =
    dyn FnMut(&str, &PreparedScene<'_>, ChannelSet) -> Result<Picture, E> + 'a;

/// Makes panels; `E` is what failures become.
pub struct PanelMaker<'a, E> {
    /// What they have in common.
    pub settings: &'a PanelSettings,
    /// Where they are written.
    pub folder: &'a Path,
    /// Images that have been read.
    pub images: Images,
    /// Who renders them.
    pub render: &'a mut RenderPanel<'a, E>,
    /// Who is told of the files that have been written.
    pub wrote: &'a mut (dyn FnMut(&Path) + 'a),
}

impl<'a, E> PanelMaker<'a, E>
where
    E: From<SceneFileError> + From<IllustrationError> + From<OutputError>,
{
    /// One for a folder. The photograph, if another one is given, is read.
    ///
    /// # Errors
    ///
    /// If that cannot be read.
    pub fn new(
        settings: &'a PanelSettings,
        folder: &'a Path,
        render: &'a mut RenderPanel<'a, E>,
        wrote: &'a mut (dyn FnMut(&Path) + 'a),
    ) -> Result<Self, LoadError> {
        let mut images = Images::default();
        if let Some(photo) = &settings.photo {
            images.photograph(&ImageSource::named(photo))?;
        }
        Ok(Self { settings, folder, images, render, wrote })
    }

    /// Reads the scene of a panel, with what they have in common and with more overrides.
    ///
    /// # Errors
    ///
    /// If it says something a scene cannot say.
    pub fn load(&self, scene: &str, name: &str, more: &[&str]) -> Result<Loaded, SceneFileError> {
        let PanelSettings { size: [width, height], samples, photo } = self.settings;
        let mut overrides: Vec<Override> = vec![
            format!("camera.resolution=[{width}, {height}]").into(),
            format!("camera.samples={samples}").into(),
            // Panels carry no lettering.
            "picture.color_bar=false".into(),
        ];
        if let Some(photo) = photo {
            overrides.push(format!("photograph.image={}", photo.display()).into());
        }
        overrides.extend(more.iter().map(|more| Override::from(*more)));
        scene_file::parse(scene, &format!("{name}.toml"), Path::new(""), &overrides)
    }

    /// Renders a scene that has been loaded; progress calls it `what`.
    ///
    /// # Errors
    ///
    /// If the scene cannot be, or it cannot be rendered.
    pub fn picture(
        &mut self,
        loaded: &Loaded,
        wanted: ChannelSet,
        what: &str,
    ) -> Result<Picture, E> {
        let prepared = PreparedScene::with_images(&loaded.scene, &mut self.images);
        let prepared =
            prepared.map_err(|error| loaded.locations.error_at(&error.key(), error.to_string()))?;
        (self.render)(what, &prepared, wanted)
    }

    /// Writes what a PNG of a scene shows, and gives it back.
    ///
    /// # Errors
    ///
    /// If a channel is missing, or the file cannot be written.
    pub fn write_shown(
        &mut self,
        loaded: &Loaded,
        picture: &Picture,
        name: &str,
    ) -> Result<RgbImage, E> {
        let image = shown(picture, &loaded.scene.picture)?;
        self.write_image(&image, &picture.metadata, name)?;
        Ok(image)
    }

    fn write_image(
        &mut self,
        image: &RgbImage,
        metadata: &[(String, String)],
        name: &str,
    ) -> Result<(), E> {
        let path = self.folder.join(format!("{name}.png"));
        write_png(image, metadata, &path)?;
        (self.wrote)(&path);
        Ok(())
    }

    /// Writes a drawing in all formats; the PNG, which is given back, has so many pixels.
    ///
    /// # Errors
    ///
    /// If the pixels do not fit into the memory, or a file cannot be written.
    pub fn write_drawing(
        &mut self,
        drawing: &Drawing,
        title: &str,
        metadata: &[(String, String)],
        pixels: [u32; 2],
        name: &str,
    ) -> Result<RgbImage, E> {
        let image = drawing.to_image(pixels)?;
        self.write_image(&image, metadata, name)?;
        for (ending, format) in [("svg", DrawingFormat::Svg), ("pdf", DrawingFormat::Pdf)] {
            let path = self.folder.join(format!("{name}.{ending}"));
            drawing.write(format, title, metadata, pixels, &path)?;
            (self.wrote)(&path);
        }
        Ok(image)
    }
}

/// Adds a panel's metadata to that of its sheet: what differs from panel to panel, one after the
/// other.
pub fn merge_metadata(sheet: &mut Vec<(String, String)>, panel: &[(String, String)]) {
    for (key, text) in panel {
        match sheet.iter_mut().find(|(known, _)| known == key) {
            Some((_, all)) if all != text => {
                all.push('\n');
                all.push_str(text);
            }
            Some(_) => {}
            None => sheet.push((key.clone(), text.clone())),
        }
    }
}
