//! Line drawings: shapes and words on a sheet, written as SVG and rasterized from that.
//!
//! Lengths are in units of the sheet, x to the right and y down. Lettering is drawn as outlines of
//! Noto Sans, so that a drawing looks the same wherever it is shown.

mod markup;
mod raster;

mod typeface;

pub use typeface::Face;

use crate::output::RgbImage;
use glam::{DAffine2, DVec2};

/// A drawing: its elements from back to front on white.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Width and height of the sheet.
    pub size: DVec2,
    /// What is on it, from back to front.
    pub elements: Vec<Element>,
}

/// One thing of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// What it stands for, as in `photograph`: the class in an SVG.
    pub class: &'static str,
    /// Its form.
    pub shape: Shape,
    /// The colour of its inside.
    pub fill: Option<Ink>,
    /// Its line.
    pub stroke: Option<Stroke>,
    /// Closed contours outside of which it is not drawn (even-odd).
    pub clip: Option<Vec<Vec<DVec2>>>,
}

/// The form of an element.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Closed contours; what is inside an odd number of them is inside.
    Area(Vec<Vec<DVec2>>),
    /// A line from point to point.
    Line(Vec<DVec2>),
    /// A circle.
    Circle {
        /// Its centre.
        centre: DVec2,
        /// Its radius.
        radius: f64,
    },
    /// An image.
    Image {
        /// Its pixels.
        image: RgbImage,
        /// Takes (0, 0) to its top left and (1, 1) to its bottom right corner.
        place: DAffine2,
    },
    /// A line of text.
    Words(Words),
}

/// A line of text.
#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    /// Pieces in one face each.
    pub runs: Vec<(Face, String)>,
    /// Where it is: on the line half way up its capitals.
    pub at: DVec2,
    /// Which part of it is there: 0 its beginning, 0.5 its middle, 1 its end.
    pub anchor: f64,
    /// The size of the type.
    pub size: f64,
    /// Degrees by which it is turned, counterclockwise as seen.
    pub angle: f64,
}

/// A colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink {
    /// sRGB.
    pub rgb: [u8; 3],
    /// From 0, invisible, to 1.
    pub opacity: f64,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub ink: Ink,
    /// Its width.
    pub width: f64,
    /// Lengths of dashes and gaps, if it is not whole.
    pub dash: Option<[f64; 2]>,
}

impl Drawing {
    /// An empty sheet.
    #[must_use]
    pub fn new(size: DVec2) -> Self {
        Self { size, elements: Vec::new() }
    }

    /// Adds an element in front of all others, to be coloured by what is called on it.
    pub fn add(&mut self, class: &'static str, shape: Shape) -> &mut Element {
        let index = self.elements.len();
        self.elements.push(Element { class, shape, fill: None, stroke: None, clip: None });
        &mut self.elements[index]
    }

    /// The elements of a class.
    pub fn of_class(&self, class: &str) -> impl Iterator<Item = &Element> {
        self.elements.iter().filter(move |element| element.class == class)
    }
}

impl Element {
    /// Fills it.
    pub fn filled(&mut self, ink: Ink) -> &mut Self {
        self.fill = Some(ink);
        self
    }

    /// Draws its line.
    pub fn stroked(&mut self, ink: Ink, width: f64) -> &mut Self {
        self.stroke = Some(Stroke { ink, width, dash: None });
        self
    }

    /// Breaks its line into dashes.
    pub fn dashed(&mut self, dash: f64, gap: f64) -> &mut Self {
        if let Some(stroke) = &mut self.stroke {
            stroke.dash = Some([dash, gap]);
        }
        self
    }

    /// Draws it only within closed contours.
    pub fn within(&mut self, contours: Vec<Vec<DVec2>>) -> &mut Self {
        self.clip = Some(contours);
        self
    }
}

impl Ink {
    /// An opaque colour.
    #[must_use]
    pub const fn new(rgb: [u8; 3]) -> Self {
        Self { rgb, opacity: 1.0 }
    }

    /// The colour, less opaque.
    #[must_use]
    pub const fn faint(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

impl Words {
    /// A horizontal line of text in the regular face, its middle at a point.
    #[must_use]
    pub fn new(text: impl Into<String>, at: DVec2, size: f64) -> Self {
        Self::of_runs(vec![(Face::Regular, text.into())], at, size)
    }

    /// A horizontal line of text in several faces, its middle at a point.
    #[must_use]
    pub fn of_runs(runs: Vec<(Face, String)>, at: DVec2, size: f64) -> Self {
        Self { runs, at, anchor: 0.5, size, angle: 0.0 }
    }

    /// The text with that part of it at its point: 0 its beginning, 1 its end.
    #[must_use]
    pub fn anchored(self, anchor: f64) -> Self {
        Self { anchor, ..self }
    }

    /// The text turned counterclockwise about its point, degrees.
    #[must_use]
    pub fn turned(self, angle: f64) -> Self {
        Self { angle, ..self }
    }

    /// The text without its faces.
    #[must_use]
    pub fn text(&self) -> String {
        self.runs.iter().map(|(_, text)| text.as_str()).collect()
    }

    /// Its width.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.runs.iter().map(|(face, text)| face.width(text, self.size)).sum()
    }

    /// The corners of its box.
    #[must_use]
    pub fn corners(&self) -> [DVec2; 4] {
        let turn = DVec2::from_angle(-self.angle.to_radians());
        let (left, height) = (-self.anchor * self.width(), 0.5 * self.size);
        let right = left + self.width();
        [(left, -height), (right, -height), (right, height), (left, height)]
            .map(|corner| self.at + turn.rotate(DVec2::from(corner)))
    }
}

#[cfg(test)]
mod tests;
