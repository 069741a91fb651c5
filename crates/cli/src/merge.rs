//! `cloakroom merge`: tiles into the picture that they are parts of.

use crate::arguments::MergeArguments;
use crate::files::{check_writable, formats};
use crate::render::rgb;
use crate::report::{Failure, Result};
use cloakroom::output::{self, Format};
use cloakroom::render;
use cloakroom::scene_file;
use std::path::Path;

/// Puts tiles together and writes every file asked for.
pub fn run(arguments: &MergeArguments) -> Result<()> {
    let tiles = formats(&arguments.tiles, Format::of)?;
    let outputs = formats(&arguments.outputs, Format::of)?;
    check_writable(&arguments.outputs)?;
    let all = |files: &[(&Path, Format)], format| files.iter().all(|(_, own)| *own == format);
    if all(&tiles, Format::Npz) {
        let mut parts = Vec::new();
        for (path, _) in tiles {
            let picture = output::read_npz(path)?;
            parts.push((path.display().to_string(), picture.metadata.clone(), picture));
        }
        let picture = render::merge(&parts)?;
        for (path, format) in outputs {
            if format != Format::Png {
                output::write(&picture, path)?;
                continue;
            }
            // The scene says whether a PNG shows the image or a map.
            let scene = picture.metadata.iter().find(|(key, _)| key == "scene");
            let text = scene.map_or("", |(_, text)| text);
            let loaded = scene_file::parse(text, "the scene of the tiles", Path::new(""), &[])?;
            output::write_png(&rgb(&loaded.scene, &picture)?, &picture.metadata, path)?;
        }
        Ok(())
    } else if all(&tiles, Format::Png) && all(&outputs, Format::Png) {
        let mut parts = Vec::new();
        for (path, _) in tiles {
            let (image, metadata) = output::read_png(path)?;
            parts.push((path.display().to_string(), metadata, image));
        }
        let (image, metadata) = render::merge_images(&parts)?;
        outputs.iter().try_for_each(|(path, _)| Ok(output::write_png(&image, &metadata, path)?))
    } else {
        Err(Failure::Failed("tiles must be all .npz, or all .png to make a .png of".to_owned()))
    }
}
