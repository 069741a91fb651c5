//! `cloakroom figures`: the pictures of the paper.

use crate::arguments::FiguresArguments;
use crate::render::{picture, rgb, tell_rarities};
use crate::report::{say, Failure};
use crate::scene;
use cloakroom::illustration::figures::{self, Figure, Panel};
use cloakroom::illustration::{sheet, SheetPanel};
use cloakroom::output;
use cloakroom::photograph::ImageSource;
use cloakroom::render::{Rendered, Studio, Wanted};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Makes panels and sheets.
pub fn run(arguments: &FiguresArguments, stop: &AtomicBool) -> Result<(), Failure> {
    let chosen = figures::select(&arguments.only).map_err(Failure::Usage)?;
    scene::use_threads(arguments.threads)?;
    std::fs::create_dir_all(&arguments.out).map_err(|error| {
        Failure::Failed(format!("cannot make the folder {}: {error}", arguments.out.display()))
    })?;
    for (figure, panels) in chosen {
        make(figure, &panels, arguments, stop)?;
    }
    Ok(())
}
