//! The setting of a scene: camera, photograph and devices in the xy-plane, drawn to scale from the
//! scene itself, as in Fig. 1 of Halimeh & Wegener, Opt. Express 21, 9457 (2013).

mod body;
mod device;
mod dimension;
mod index_map;
mod layout;
mod legend;
mod medium_axes;
mod stage;
mod subject;
mod view;

pub(super) use dimension::{HEAD, arrow_head};
pub(super) use stage::{AXES, draw_axes};
pub use view::View;
pub(super) use view::corners;

use super::color_bar::ColorBar;
pub(super) use super::drawing::INK;
use super::drawing::{Drawing, Ink, Shape, Words};
use super::quantity::{short, with_minus};
use cloakroom::assembly::Assembly;
use cloakroom::render::{PreparedScene, PreparedSceneError, metadata};
use cloakroom::scene::Scene;
use device::{Neighbours, Sketch};
use glam::DVec2;
use layout::Layout;
use stage::Stage;
use subject::Subject;

/// The drawing of a setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The drawing.
    pub drawing: Drawing,
    /// Where on it the points of the scene are, for whoever wants to draw more.
    pub view: View,
    /// Scene and version, for files.
    pub metadata: Vec<(String, String)>,
}

/// The size of lettering. All lengths are for a sheet as large as 1024 x 768.
pub(super) const TEXT: f64 = 24.0;
/// The margin of the sheet.
pub(super) const MARGIN: f64 = 14.0;
/// The room that a colour bar takes.
pub(super) const BAR: f64 = 5.2 * TEXT;
/// The width of thin lines.
pub(super) const THIN: f64 = 1.5;
/// The width of the lines that matter.
pub(super) const THICK: f64 = 2.6;

pub(super) const GRAY: Ink = Ink::new([120, 120, 120]);
pub(super) const PAPER: Ink = Ink::new([255, 255, 255]);
pub(super) const METAL: Ink = Ink::new([196, 196, 196]);
pub(super) const MEDIUM: Ink = Ink::new([222, 235, 247]);
const OPAQUE: Ink = Ink::new([122, 92, 66]).faint(0.55);
/// Colours that most people tell apart (Okabe & Ito, Color universal design, 2008).
pub(super) const BLUE: Ink = Ink::new([0, 114, 178]);
pub(super) const VERMILION: Ink = Ink::new([213, 94, 0]);
const SKY: Ink = Ink::new([86, 180, 233]);

/// Draws the setting of a scene: a projection on the xy-plane (x to the right, y up, z out of the
/// page), to scale. Every device is cut in the plane z = 0 of its own frame; one that would be
/// small is drawn once more, magnified. The sheet is of the aspect of `size`, in pixels.
///
/// # Errors
///
/// If the scene cannot be looked at, as [`PreparedScene::new`] says.
///
/// # Example
///
/// ```
/// use cloakroom_figures::setting;
/// use std::path::Path;
///
/// let text = "[[device]]\nkind = \"square-cloak\"";
/// let scene = cloakroom::scene_file::parse(text, "scene", Path::new(""), &[])?.scene;
/// let setting = setting(&scene, scene.camera.resolution)?;
/// let svg = setting.drawing.to_svg("A square cloak", &setting.metadata);
/// assert!(svg.contains("aria-label=\"14.1 cm\""));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn setting(scene: &Scene, size: [u32; 2]) -> Result<Setting, PreparedSceneError> {
    let prepared = PreparedScene::new(scene)?;
    let devices = Devices::new(&prepared.assembly);
    let subjects = &devices.subjects;
    let stage = Stage::new(scene, &prepared);
    let sheet = sheet(size);
    let layout = Layout::new(sheet, &stage, subjects, devices.has_bar());
    let mut drawing = Drawing::new(sheet, TEXT);
    stage.draw_behind(&mut drawing, &layout.view);
    let order = Subject::from_back(subjects);
    let whole: Vec<_> =
        order.iter().map(|index| (&subjects[*index], !layout.is_magnified(*index))).collect();
    let labels = stage.labels(&layout.view);
    let photograph = [layout.view.places(&stage.photograph())];
    devices.draw_measured(&mut drawing, &layout.view, &whole, (&labels, &photograph));
    for inset in &layout.insets {
        inset.draw_frame(&mut drawing, &layout.view);
    }
    stage.draw_before(&mut drawing, &layout.view);
    stage.draw_distances(&mut drawing, &layout.view, subjects);
    draw_axes(&mut drawing, layout.axes);
    for inset in &layout.insets {
        let is_in = |index: &&usize| inset.group.subjects.contains(*index);
        let shown: Vec<_> =
            order.iter().filter(is_in).map(|index| (&subjects[*index], true)).collect();
        devices.draw_measured(&mut drawing, &inset.view, &shown, (&[], &[]));
        legend::draw(&mut drawing, inset.legend, &shown);
    }
    devices.draw_bar(&mut drawing, layout.bar);
    Ok(Setting { drawing, view: layout.view, metadata: metadata(scene) })
}

/// The devices of a scene in cross-section, to be drawn in any view.
pub(super) struct Devices<'s> {
    subjects: Vec<Subject<'s>>,
    /// The colours of the index of graded media, if there are any.
    bar: Option<ColorBar>,
}

impl<'s> Devices<'s> {
    pub fn new(assembly: &'s Assembly) -> Self {
        let subjects = Subject::all(assembly);
        let bar = index_map::bar(&subjects);
        Self { subjects, bar }
    }

    /// Least and greatest x and y of all that has an end, cm.
    pub fn bounds(&self) -> Option<[DVec2; 2]> {
        subject::bounds(self.subjects.iter().filter_map(Subject::bounds).flatten())
    }

    /// Whether the index of graded media is drawn in colours, which a bar explains.
    pub fn has_bar(&self) -> bool {
        self.bar.is_some()
    }

    /// Draws the devices with the axes of their media.
    pub fn draw(&self, drawing: &mut Drawing, view: &View) {
        let order = Subject::from_back(&self.subjects);
        let shown: Vec<_> = order.iter().map(|index| (&self.subjects[*index], true)).collect();
        self.draw_shapes(drawing, view, &shown);
    }

    /// Draws the bar of the colours with its top left corner at a point, as high as told.
    pub fn draw_bar(&self, drawing: &mut Drawing, (at, height): (DVec2, f64)) {
        if let Some(bar) = &self.bar {
            bar.draw(drawing, at, height, TEXT);
        }
    }

    /// Draws devices from back to front, and where it says so in detail: with the axes of their
    /// media and, before everything else so that they can be read, their dimensions, where there is room
    /// between them and beside labels and shapes.
    fn draw_measured(
        &self,
        drawing: &mut Drawing,
        view: &View,
        shown: &[(&Subject<'_>, bool)],
        (labels, shapes): (&[Words], &[Vec<DVec2>]),
    ) {
        self.draw_shapes(drawing, view, shown);
        for (place, (subject, _)) in shown.iter().enumerate().filter(|(_, (_, detail))| *detail) {
            let is_inner = |(other, (around, _)): (usize, &(&Subject<'_>, bool))| {
                other != place && subject.is_within(around, other > place)
            };
            let crowds = |(other, _): &(&Subject<'_>, bool)| {
                !std::ptr::eq(*other, *subject) && subject.is_crowded_by(other, view)
            };
            if !shown.iter().enumerate().any(is_inner) && !shown.iter().any(crowds) {
                let devices = shown.iter().map(|(other, _)| *other);
                let devices = devices.filter(|other| !std::ptr::eq(*other, *subject)).collect();
                let others = Neighbours { devices, labels, shapes };
                Sketch { drawing, view, subject }.draw_dimensions(&others);
            }
        }
    }

    /// Draws devices from back to front, without their dimensions.
    fn draw_shapes(&self, drawing: &mut Drawing, view: &View, shown: &[(&Subject<'_>, bool)]) {
        for (subject, _) in shown {
            let scale = self.bar.as_ref().map(|bar| &bar.scale);
            Sketch { drawing, view, subject }.draw(scale);
        }
        // What is written on one may reach over its neighbour.
        for (place, (subject, _)) in shown.iter().enumerate().filter(|(_, (_, detail))| *detail) {
            Sketch { drawing, view, subject }.draw_media(&shown[place + 1..]);
        }
    }
}

/// The sheet for a picture of that many pixels: of its aspect, and as large as one of 1024 x 768.
pub(super) fn sheet(resolution: [u32; 2]) -> DVec2 {
    let pixels = DVec2::from(resolution.map(f64::from));
    pixels * (1024.0 * 768.0 / (pixels.x * pixels.y)).sqrt()
}

/// Writes a label that can be read whatever lies behind it: its letters have a rim of the colour of
/// the ground.
fn write(drawing: &mut Drawing, class: &'static str, words: Words, ground: Ink) {
    drawing.add("rim", Shape::Words(words.clone())).stroked(ground.faint(0.85), 6.0);
    drawing.add(class, Shape::Words(words)).filled(INK);
}

/// A length in cm with two decimals at most.
fn centimetres(length: f64) -> String {
    format!("{} cm", rounded(length))
}

/// A number with two decimals at most.
fn rounded(number: f64) -> String {
    with_minus(&short(number, 2))
}

#[cfg(test)]
mod tests;
