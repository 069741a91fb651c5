//! The page of `cloakroom view` without its server: what the server does is done by workers of the
//! page. One leads ([`Lead`]): it hears what the page says, and shares the work out among as many hands ([`Hand`]) as
//! there are processors. They have no memory in common, for most hosts do not allow it; so each has this
//! module for itself, renders bands of pictures, and looks for the next order between two of them.
//!
//! The functions that it calls are those of `web/worker.js`.

mod hand;
mod lead;
mod order;

pub use hand::Hand;
pub use lead::Lead;

use cloakroom::output::{encode_png, to_srgb};
use cloakroom::photograph::ImageSource;
use cloakroom::render::{ChannelSet, PreparedScene, Supervision, render};
use cloakroom::scene_file::{self, Override};
use cloakroom_figures::examples;
use cloakroom_viewer::Opened;
use std::io::Cursor;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use wasm_bindgen::prelude::wasm_bindgen;

/// The scene that pages begin with, and its photograph.
fn first() -> Result<(Opened, ImageSource), String> {
    let folder = Path::new("");
    let loaded = scene_file::parse(examples::FIRST, "the first scene", folder, &[]);
    let loaded = loaded.map_err(|error| error.to_string())?;
    Ok((Opened::new(&loaded, "", folder)?, loaded.scene.photograph.image))
}

/// Renders a scene file: the PNG that `cloakroom render` makes. Each of `set` is as after `--set`.
///
/// # Errors
///
/// One message: what is wrong in the scene. It can open no file.
#[wasm_bindgen]
pub fn picture(text: &str, set: Vec<String>) -> Result<Vec<u8>, String> {
    let set: Vec<Override> = set.into_iter().map(Override::from).collect();
    let loaded = scene_file::parse(text, "scene", Path::new(""), &set);
    let scene = loaded.map_err(|error| error.to_string())?.scene;
    let prepared = PreparedScene::new(&scene).map_err(|error| error.to_string())?;
    let supervision = Supervision { rows_done: &|_| {}, stop: &AtomicBool::new(false) };
    let rendered = render(&prepared, ChannelSet::Image, &supervision);
    let picture = rendered.map_err(|error| error.to_string())?.picture;
    let image = to_srgb(&picture).map_err(|error| error.to_string())?;
    let mut file = Cursor::new(Vec::new());
    encode_png(&image, &picture.metadata, &mut file).map_err(|error| error.to_string())?;
    Ok(file.into_inner())
}
