//! Panels: scenes that the program carries along, as the command line wants them, and their files.

use crate::arguments::PanelArguments;
use crate::files::{check_writable, make_folder};
use crate::report::{Result, wrote};
use cloakroom::output::{self, RgbImage};
use cloakroom::photograph::ImageSource;
use cloakroom::render::Images;
use cloakroom::scene_file::{self, Loaded, Override};
use cloakroom_figures::{Drawing, DrawingFormat};
use std::path::{Path, PathBuf};

/// Reads the scene of a panel, with what the command line changes in it, and with more overrides.
pub fn load(scene: &str, name: &str, arguments: &PanelArguments, more: &[&str]) -> Result<Loaded> {
    let [width, height] = arguments.size;
    let mut overrides: Vec<Override> = vec![
        format!("camera.resolution=[{width}, {height}]").into(),
        format!("camera.samples={}", arguments.samples).into(),
        // Panels carry no lettering.
        "picture.color_bar=false".into(),
    ];
    if let Some(photo) = &arguments.photo {
        overrides.push(format!("photograph.image={}", photo.display()).into());
    }
    overrides.extend(more.iter().map(|more| Override::from(*more)));
    Ok(scene_file::parse(scene, &format!("{name}.toml"), Path::new(""), &overrides)?)
}

/// Reads the photograph, if another one is given, and makes the folder of panels, none of which may
/// be that photograph; `names` are theirs without endings.
pub fn prepare(
    arguments: &PanelArguments,
    folder: &Path,
    names: impl IntoIterator<Item = PathBuf>,
) -> Result<Images> {
    let mut images = Images::default();
    let photo = arguments.photo.as_deref();
    if let Some(photo) = photo {
        images.photograph(&ImageSource::named(photo))?;
    }
    make_folder(folder)?;
    let endings = |name: PathBuf| ["png", "svg", "pdf"].map(|ending| name.with_extension(ending));
    let inputs: Vec<_> = photo.map(Path::to_owned).into_iter().collect();
    check_writable(names.into_iter().flat_map(endings), &inputs)?;
    Ok(images)
}

/// Writes a PNG and says so.
pub fn write_png(image: &RgbImage, metadata: &[(String, String)], path: &Path) -> Result<()> {
    output::write_png(image, metadata, path)?;
    wrote(path);
    Ok(())
}

/// Writes a drawing in all formats under one name without an ending, and says so; the PNG, which is
/// given back, has so many pixels.
pub fn write_drawing(
    drawing: &Drawing,
    title: &str,
    metadata: &[(String, String)],
    pixels: [u32; 2],
    name: &Path,
) -> Result<RgbImage> {
    let image = drawing.to_image(pixels)?;
    write_png(&image, metadata, &name.with_extension("png"))?;
    for (ending, format) in [("svg", DrawingFormat::Svg), ("pdf", DrawingFormat::Pdf)] {
        let path = name.with_extension(ending);
        drawing.write(format, title, metadata, pixels, &path)?;
        wrote(&path);
    }
    Ok(image)
}

/// Adds a panel's metadata to that of its sheet: what differs from panel to panel, one after the
/// other.
pub fn merge(sheet: &mut Vec<(String, String)>, panel: &[(String, String)]) {
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
