//! Drawings: shapes, words and images on a sheet, written as SVG, PDF and, rasterized from the SVG,
//! PNG.
//!
//! Lengths are in units of the sheet, x to the right and y down. Lettering is drawn as outlines of
//! Noto Sans, so that a drawing looks the same wherever it is shown.

mod file;
mod markup;
mod pdf;
mod raster;
mod typeface;

pub use file::DrawingFormat;
pub use typeface::Face;

use cloakroom::output::RgbImage;
use glam::{DAffine2, DVec2};
use typeface::Piece;

/// The height of the type on paper, mm: 8 points.
const TYPE_MM: f64 = 2.8;

/// The distance of lines of text, in type of size 1.
pub(super) const LINE: f64 = 1.25;

/// The colour of lettering, ticks and frames.
pub(super) const INK: Ink = Ink::new([24, 24, 24]);

/// A drawing: its elements from back to front on white.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Width and height of the sheet.
    pub size: DVec2,
    /// Millimetres of paper in a unit.
    pub mm: f64,
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
        /// Whether each of them is a number in colour, to be seen as a cell with sharp edges.
        cells: bool,
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
    /// An empty sheet on which type of the size `text` is one of 8 points when it is printed.
    #[must_use]
    pub fn new(size: DVec2, text: f64) -> Self {
        Self { size, mm: TYPE_MM / text, elements: Vec::new() }
    }

    /// Width and height in pixels, one for each unit.
    #[must_use]
    pub fn pixels(&self) -> [u32; 2] {
        self.size.ceil().to_array().map(|side| side as u32)
    }

    /// Adds an image whose top left corner is at a point, a unit for each of its pixels, in a frame
    /// of that width that lies around it.
    pub fn add_framed(&mut self, image: RgbImage, cells: bool, at: DVec2, line: f64) {
        let size = DVec2::new(f64::from(image.width()), f64::from(image.height()));
        let place = DAffine2::from_cols(DVec2::X * size.x, DVec2::Y * size.y, at);
        self.add("picture", Shape::Image { image, cells, place });
        let [low, high] = [at - line / 2.0, at + size + line / 2.0];
        let frame = [low, DVec2::new(low.x, high.y), high, DVec2::new(high.x, low.y)];
        self.add_area("frame", frame).stroked(INK, line);
    }

    /// Writes lines of text in ink, one under the other, that part of them at a point on the middle
    /// of the first one.
    pub fn add_lines(
        &mut self,
        class: &'static str,
        (face, size): (Face, f64),
        (at, anchor): (DVec2, f64),
        lines: &[String],
    ) {
        for (line, below) in lines.iter().zip(0..) {
            let at = at + DVec2::Y * LINE * size * f64::from(below);
            self.add_words(class, Words::of(face, line.as_str(), at, size).anchored(anchor));
        }
    }

    /// Adds a line of text in ink.
    pub fn add_words(&mut self, class: &'static str, words: Words) -> &mut Element {
        self.add(class, Shape::Words(words)).filled(INK)
    }

    /// Adds a line from point to point in a colour of a width.
    pub fn add_line(
        &mut self,
        class: &'static str,
        points: impl Into<Vec<DVec2>>,
        (ink, width): (Ink, f64),
    ) -> &mut Element {
        self.add(class, Shape::Line(points.into())).stroked(ink, width)
    }

    /// Adds what is within one closed contour.
    pub fn add_area(
        &mut self,
        class: &'static str,
        contour: impl Into<Vec<DVec2>>,
    ) -> &mut Element {
        self.add(class, Shape::Area(vec![contour.into()]))
    }

    /// Adds an element in front of all others, to be coloured by what is called on it.
    pub fn add(&mut self, class: &'static str, shape: Shape) -> &mut Element {
        let index = self.elements.len();
        self.elements.push(Element { class, shape, fill: None, stroke: None, clip: None });
        &mut self.elements[index]
    }

    /// The elements of a class.
    pub(crate) fn of_class(&self, class: &str) -> impl Iterator<Item = &Element> {
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
    /// The corners of its box.
    pub(crate) fn corners(&self) -> [DVec2; 4] {
        let turn = DVec2::from_angle(-self.angle.to_radians());
        let (left, height) = (-self.anchor * self.width(), 0.5 * self.size);
        let right = left + self.width();
        [(left, -height), (right, -height), (right, height), (left, height)]
            .map(|corner| self.at + turn.rotate(DVec2::from(corner)))
    }

    /// A horizontal line of text in the regular face, its middle at a point.
    #[must_use]
    pub fn new(text: impl Into<String>, at: DVec2, size: f64) -> Self {
        Self::of(Face::Regular, text, at, size)
    }

    /// A horizontal line of text in a face, its middle at a point.
    #[must_use]
    pub fn of(face: Face, text: impl Into<String>, at: DVec2, size: f64) -> Self {
        Self::of_runs(vec![(face, text.into())], at, size)
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

    /// The pieces of the outlines of its letters, in place.
    fn outline(&self) -> Vec<Piece> {
        let turn = DVec2::from_angle(-self.angle.to_radians());
        let mut x = -self.anchor * self.width();
        let mut pieces = Vec::new();
        for (face, text) in &self.runs {
            let place = |p: DVec2| {
                let on_line =
                    DVec2::new(x + p.x * self.size, (face.half_capital() - p.y) * self.size);
                self.at + turn.rotate(on_line)
            };
            pieces.extend(face.outline(text, &place));
            x += face.width(text, self.size);
        }
        pieces
    }
}

/// A line from point to point.
fn line(points: &[DVec2]) -> impl Iterator<Item = Piece> {
    points.iter().enumerate().map(|(i, p)| if i == 0 { Piece::Move(*p) } else { Piece::Line(*p) })
}

/// Closed contours.
fn contours(loops: &[Vec<DVec2>]) -> impl Iterator<Item = Piece> {
    let loops = loops.iter().filter(|points| !points.is_empty());
    loops.flat_map(|points| line(points).chain([Piece::Close]))
}

#[cfg(test)]
mod tests;
