//! stub
use crate::output::{OutputError, Picture, RgbImage};
/// a
pub fn scalar_map(picture: &Picture, channel: &str, color_bar: bool) -> Result<RgbImage, OutputError> { let _ = (channel, color_bar); crate::output::to_srgb(picture) }
/// a
pub struct SheetPanel { /// a
 pub image: RgbImage, /// a
 pub label: String, /// a
 pub caption: String }
/// a
pub fn sheet(title: &str, panels: &[SheetPanel]) -> RgbImage { let _ = title; panels[0].image.clone() }
