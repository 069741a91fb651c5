//! Drawings as SVG.

use super::super::quantity::short;
use super::typeface::Piece;
use super::{Drawing, Element, Ink, Shape, contours, line};
use base64::Engine;
use cloakroom::output::RgbImage;
use glam::{DAffine2, DVec2};
use svg::node::element::{ClipPath, Description, Group, Image, Path, Rectangle, Title};
use svg::{Document, Node};

impl Drawing {
    /// The drawing as SVG, as large as on paper. `description` becomes its title, and `metadata` is
    /// set down in it.
    #[must_use]
    pub fn to_svg(&self, description: &str, metadata: &[(String, String)]) -> String {
        let size = (self.size * self.mm).to_array().map(|side| format!("{}mm", number(side)));
        self.markup(size, description, metadata, &embedded)
    }

    /// The SVG of a size, with images where `source` says that they are, given their place among
    /// the elements.
    pub(super) fn markup(
        &self,
        [width, height]: [String; 2],
        description: &str,
        metadata: &[(String, String)],
        source: &dyn Fn(usize, &RgbImage) -> Option<String>,
    ) -> String {
        let (w, h) = (number(self.size.x), number(self.size.y));
        let mut document = Document::new()
            .set("width", width)
            .set("height", height)
            .set("viewBox", format!("0 0 {w} {h}"))
            .set("preserveAspectRatio", "none")
            .add(Title::new(description));
        for (key, text) in metadata {
            let text = svg::node::Text::new(text.as_str());
            document = document.add(Description::new().set("class", key.as_str()).add(text));
        }
        let paper = Rectangle::new().set("width", w).set("height", h).set("fill", "#ffffff");
        document = document.add(paper);
        // Neighbours share their clip.
        let (mut clipped, mut last) = (0, None);
        for (index, element) in self.elements.iter().enumerate() {
            if let Some(clip) = element.clip.as_ref().filter(|clip| last != Some(*clip)) {
                let path = path(contours(clip)).set("clip-rule", "evenodd");
                let id = format!("clip{index}");
                document = document.add(ClipPath::new().set("id", id).add(path));
                (clipped, last) = (index, Some(clip));
            }
            document = document.add(node(element, clipped, index, source));
        }
        format!("{document}\n")
    }
}

fn node(
    element: &Element,
    clip: usize,
    index: usize,
    source: &dyn Fn(usize, &RgbImage) -> Option<String>,
) -> Group {
    let mut group = Group::new().set("class", element.class);
    if element.clip.is_some() {
        // The clip is in the coordinates of the sheet: it belongs to the group, not to an image in
        // it.
        group = group.set("clip-path", format!("url(#clip{clip})"));
    }
    match &element.shape {
        Shape::Area(loops) => {
            let path = path(contours(loops)).set("fill-rule", "evenodd");
            group.add(painted(path, element))
        }
        Shape::Line(points) => group.add(painted(path(line(points)), element)),
        Shape::Circle { centre, radius } => {
            let circle = svg::node::element::Circle::new()
                .set("cx", number(centre.x))
                .set("cy", number(centre.y))
                .set("r", number(*radius));
            group.add(painted(circle, element))
        }
        Shape::Image { image, cells, place } => match source(index, image) {
            Some(href) => group.add(picture(image, *cells, place).set("href", href)),
            None => group,
        },
        Shape::Words(words) => {
            group.set("aria-label", words.text()).add(painted(path(words.outline()), element))
        }
    }
}

/// Sets fill and stroke.
fn painted<T: Node>(mut node: T, element: &Element) -> T {
    node.assign("fill", "none");
    for (name, ink) in [("fill", element.fill), ("stroke", element.stroke.map(|s| s.ink))] {
        let Some(Ink { rgb: [r, g, b], opacity }) = ink else { continue };
        node.assign(name, format!("#{r:02x}{g:02x}{b:02x}"));
        if opacity < 1.0 {
            node.assign(format!("{name}-opacity"), number(opacity));
        }
    }
    if let Some(stroke) = element.stroke {
        node.assign("stroke-width", number(stroke.width));
        node.assign("stroke-linejoin", "round");
        if let Some([dash, gap]) = stroke.dash {
            node.assign("stroke-dasharray", format!("{} {}", number(dash), number(gap)));
        }
    }
    node
}

/// A number with as many decimals as matter: a thousandth of a unit.
fn number(value: f64) -> String {
    short(value, 3)
}

fn point(p: DVec2) -> String {
    format!("{},{}", number(p.x), number(p.y))
}

/// What pieces of an outline are together.
fn path(pieces: impl IntoIterator<Item = Piece>) -> Path {
    let data = pieces.into_iter().map(|piece| match piece {
        Piece::Move(p) => format!("M{}", point(p)),
        Piece::Line(p) => format!("L{}", point(p)),
        Piece::Quadratic(a, p) => format!("Q{} {}", point(a), point(p)),
        Piece::Cubic(a, b, p) => format!("C{} {} {}", point(a), point(b), point(p)),
        Piece::Close => "Z".to_owned(),
    });
    Path::new().set("d", data.collect::<String>())
}

/// An image as a PNG within the SVG; none if it has no pixels.
fn embedded(_: usize, image: &RgbImage) -> Option<String> {
    let data = base64::engine::general_purpose::STANDARD.encode(png(image)?);
    Some(format!("data:image/png;base64,{data}"))
}

/// An image as a PNG; none if it has no pixels.
pub(super) fn png(image: &RgbImage) -> Option<Vec<u8>> {
    let mut png = std::io::Cursor::new(Vec::new());
    image.write_to(&mut png, image::ImageFormat::Png).ok()?;
    Some(png.into_inner())
}

/// An image at its place, its source to be said.
fn picture(image: &RgbImage, cells: bool, place: &DAffine2) -> Image {
    // One unit for each pixel, so that the transform holds no tiny numbers.
    let (width, height) = (f64::from(image.width()), f64::from(image.height()));
    let (across, down) = (place.x_axis / width, place.y_axis / height);
    let matrix = [across.x, across.y, down.x, down.y].map(|entry| format!("{entry:.9}"));
    let transform = format!("matrix({} {})", matrix.join(" "), point(place.translation));
    let image = Image::new()
        .set("width", number(width))
        .set("height", number(height))
        .set("preserveAspectRatio", "none")
        .set("transform", transform);
    if cells { image.set("style", "image-rendering:pixelated") } else { image }
}
