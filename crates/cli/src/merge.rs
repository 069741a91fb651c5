//! `cloakroom merge`: tiles into the picture that they are parts of.

use crate::arguments::MergeArguments;
use crate::files::{check_outputs, formats, write_each};
use crate::report::{Failure, Result};
use cloakroom::output::{self, Format};
use cloakroom::render;
use cloakroom::scene_file;
use cloakroom_figures::{PictureFormat, write_picture};
use std::path::Path;

/// Puts tiles together and writes every file asked for.
pub fn run(arguments: &MergeArguments) -> Result<()> {
    let tiles = formats(&arguments.tiles, Format::of)?;
    let outputs = formats(&arguments.outputs, PictureFormat::of)?;
    check_outputs(&arguments.outputs, &arguments.tiles)?;
    let all = |wanted| tiles.iter().all(|(_, format)| *format == wanted);
    let png = PictureFormat::Pixels(Format::Png);
    if all(Format::Npz) {
        let mut parts = Vec::new();
        for (path, _) in tiles {
            let picture = output::read_npz(path)?;
            parts.push((path.display().to_string(), picture.metadata.clone(), picture));
        }
        let picture = render::merge(&parts)?;
        write_each(outputs, |path, format| {
            if !format.is_shown() {
                return Ok(output::write(&picture, path)?);
            }
            // The scene says whether the image or a map is to be seen.
            let scene = picture.metadata.iter().find(|(key, _)| key == "scene");
            let text = scene.map_or("", |(_, text)| text);
            let loaded = scene_file::parse(text, "the scene of the tiles", Path::new(""), &[])?;
            let shown = &loaded.scene.picture;
            Ok(write_picture(&picture, shown, format, path)?)
        })
    } else if all(Format::Png) && outputs.iter().all(|(_, format)| *format == png) {
        let mut parts = Vec::new();
        for (path, _) in tiles {
            let (image, metadata) = output::read_png(path)?;
            parts.push((path.display().to_string(), metadata, image));
        }
        let (image, metadata) = render::merge_images(&parts)?;
        write_each(outputs, |path, _| Ok(output::write_png(&image, &metadata, path)?))
    } else {
        Err(Failure::Failed("tiles must be all .npz, or all .png to make a .png of".to_owned()))
    }
}
