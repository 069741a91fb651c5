//! `cloakroom merge`: tiles into the picture that they are parts of.

use crate::arguments::MergeArguments;
use crate::render::rgb;
use crate::report::Failure;
use cloakroom::output::{self, Format, Picture};
use cloakroom::render;
use cloakroom::scene_file;
use std::path::{Path, PathBuf};

/// Puts tiles together and writes every file asked for.
pub fn run(arguments: &MergeArguments) -> Result<(), Failure> {
    let format = |path: &PathBuf| Format::of(path).map_err(Failure::from_error);
    let tiles = arguments.tiles.iter().map(format).collect::<Result<Vec<_>, _>>()?;
    let outputs = arguments.outputs.iter().map(format).collect::<Result<Vec<_>, _>>()?;
    for path in &arguments.outputs {
        output::check_writable(path).map_err(Failure::from_error)?;
    }
    let all = |formats: &[Format], format| formats.iter().all(|f| *f == format);
    if all(&tiles, Format::Npz) {
        data(arguments)
    } else if all(&tiles, Format::Png) && all(&outputs, Format::Png) {
        images(arguments)
    } else {
        Err(Failure::Failed("tiles must be all .npz, or all .png to make a .png of".to_owned()))
    }
}

fn data(arguments: &MergeArguments) -> Result<(), Failure> {
    let read = |path: &PathBuf| {
        let picture = output::read_npz(path).map_err(Failure::from_error)?;
        Ok((path.display().to_string(), picture.metadata.clone(), picture))
    };
    let tiles = arguments.tiles.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let picture = render::merge(&tiles).map_err(Failure::from_error)?;
    for path in &arguments.outputs {
        write(&picture, path)?;
    }
    Ok(())
}

fn write(picture: &Picture, path: &Path) -> Result<(), Failure> {
    if Format::of(path).map_err(Failure::from_error)? != Format::Png {
        return output::write(picture, path).map_err(Failure::from_error);
    }
    // The scene says whether a PNG shows the image or a map.
    let scene = picture.metadata.iter().find(|(key, _)| key == "scene");
    let text = scene.map_or("", |(_, text)| text);
    let loaded = scene_file::parse(text, "the scene of the tiles", Path::new(""), &[])
        .map_err(Failure::from_error)?;
    let image = rgb(&loaded.scene, picture)?;
    output::write_png(&image, &picture.metadata, path).map_err(Failure::from_error)
}

fn images(arguments: &MergeArguments) -> Result<(), Failure> {
    let read = |path: &PathBuf| {
        let (image, metadata) = output::read_png(path).map_err(Failure::from_error)?;
        Ok((path.display().to_string(), metadata, image))
    };
    let tiles = arguments.tiles.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let (image, metadata) = render::merge_images(&tiles).map_err(Failure::from_error)?;
    for path in &arguments.outputs {
        output::write_png(&image, &metadata, path).map_err(Failure::from_error)?;
    }
    Ok(())
}
