//! Panels: scenes that the program carries along, as the command line wants them.

use crate::arguments::PanelArguments;
use crate::files::{check_writable, make_folder};
use crate::interruption;
use crate::render::picture;
use crate::report::{Failure, Result, wrote};
use crate::scene;
use cloakroom::render::{ChannelSet, PreparedScene};
use cloakroom_figures::panels::{PanelMaker, PanelSettings};
use std::path::Path;

/// Makes panels in a folder, which is made if it is not there; `names` are those of their files
/// without endings, none of which may be the photograph.
pub fn made(
    arguments: &PanelArguments,
    folder: &Path,
    names: impl IntoIterator<Item = String>,
    make: impl FnOnce(&mut PanelMaker<'_, Failure>) -> Result<()>,
) -> Result<()> {
    scene::use_threads(&arguments.threads)?;
    let PanelArguments { size, samples, photo, .. } = arguments;
    let settings = PanelSettings { size: *size, samples: *samples, photo: photo.clone() };
    let render = &mut |what: &str, prepared: &PreparedScene<'_>, wanted: ChannelSet| {
        picture(prepared, wanted, what)
    };
    let wrote = &mut |path: &Path| wrote(path);
    let mut maker = PanelMaker::new(&settings, folder, render, wrote)?;
    make_folder(folder)?;
    let endings =
        |name: String| ["png", "svg", "pdf"].map(|end| folder.join(format!("{name}.{end}")));
    let inputs: Vec<_> = photo.iter().cloned().collect();
    check_writable(names.into_iter().flat_map(endings), &inputs)?;
    let _busy = interruption::busy();
    make(&mut maker)
}
