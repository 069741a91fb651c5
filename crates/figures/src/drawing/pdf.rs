//! Drawings as PDF: one page, as large as the drawing is on paper.

use super::typeface::Piece;
use super::{Drawing, Element, Ink, Shape, Stroke, contours, line};
use cloakroom::output::RgbImage;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::{DAffine2, DVec2};
use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use std::f64::consts::FRAC_PI_2;
use std::io::Write;

/// The page, and what it consists of.
const CATALOG: i32 = 1;
const PAGES: i32 = 2;
const PAGE: i32 = 3;
const CONTENTS: i32 = 4;
const INFO: i32 = 5;
/// The first number of images and opacities.
const RESOURCES: i32 = 6;

/// How far the ends of a quarter of a circle of radius 1 are from the control points of the curve
/// for it.
const QUARTER: f64 = 0.552_284_749_830_793_6;

impl Drawing {
    /// The drawing as a PDF. `title` and `metadata` are among what it says about itself.
    #[must_use]
    pub fn to_pdf(&self, title: &str, metadata: &[(String, String)]) -> Vec<u8> {
        let mut sheet =
            Sheet { content: Content::new(), images: Vec::new(), opacities: Vec::new() };
        let points = self.mm * 72.0 / 25.4;
        let size = self.size * points;
        sheet.transform(DAffine2::from_cols(
            DVec2::X * points,
            DVec2::NEG_Y * points,
            DVec2::Y * size.y,
        ));
        for element in &self.elements {
            sheet.draw(element);
        }
        let mut pdf = Pdf::new();
        let id = Ref::new;
        pdf.catalog(id(CATALOG)).pages(id(PAGES));
        pdf.pages(id(PAGES)).kids([id(PAGE)]).count(1);
        let mut page = pdf.page(id(PAGE));
        page.parent(id(PAGES)).contents(id(CONTENTS));
        page.media_box(Rect::new(0.0, 0.0, size.x as f32, size.y as f32));
        let mut resources = page.resources();
        let mut names = resources.x_objects();
        for (i, _) in (0..).zip(&sheet.images) {
            names.pair(Name(format!("i{i}").as_bytes()), id(RESOURCES + i));
        }
        names.finish();
        let first_opacity = RESOURCES + sheet.images.len() as i32;
        let mut names = resources.ext_g_states();
        for (i, _) in (0..).zip(&sheet.opacities) {
            names.pair(Name(format!("o{i}").as_bytes()), id(first_opacity + i));
        }
        names.finish();
        resources.finish();
        page.finish();
        for (i, (image, cells)) in (0..).zip(&sheet.images) {
            let data = deflated(image.as_raw());
            let mut object = pdf.image_xobject(id(RESOURCES + i), &data);
            object.filter(Filter::FlateDecode);
            object.width(image.width() as i32).height(image.height() as i32);
            object.color_space().device_rgb();
            object.bits_per_component(8).interpolate(!cells);
        }
        for (i, [fill, stroke]) in (0..).zip(&sheet.opacities) {
            let mut state = pdf.ext_graphics(id(first_opacity + i));
            state.non_stroking_alpha(*fill as f32).stroking_alpha(*stroke as f32);
        }
        let content = deflated(&sheet.content.finish());
        pdf.stream(id(CONTENTS), &content).filter(Filter::FlateDecode);
        let mut info = pdf.document_info(id(INFO));
        info.title(TextStr(title));
        for (key, text) in metadata {
            info.insert(Name(key.as_bytes())).primitive(TextStr(text));
        }
        info.finish();
        pdf.finish()
    }
}

fn deflated(data: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    // Memory takes everything.
    encoder.write_all(data).and_then(|()| encoder.finish()).unwrap_or_default()
}

/// A page while it is drawn on.
struct Sheet<'d> {
    content: Content,
    /// Images, and whether their pixels are cells with sharp edges.
    images: Vec<(&'d RgbImage, bool)>,
    /// Opacities of fills and strokes.
    opacities: Vec<[f64; 2]>,
}

impl<'d> Sheet<'d> {
    fn transform(&mut self, place: DAffine2) {
        self.content.transform(place.to_cols_array().map(|entry| entry as f32));
    }

    fn draw(&mut self, element: &'d Element) {
        self.content.save_state();
        if let Some(clip) = &element.clip {
            self.path(contours(clip));
            self.content.clip_even_odd().end_path();
        }
        if element.fill.is_some() || element.stroke.is_some() {
            self.set_colors(element.fill, element.stroke);
        }
        match &element.shape {
            Shape::Area(loops) => self.paint(element, contours(loops)),
            Shape::Line(points) => self.paint(element, line(points)),
            Shape::Circle { centre, radius } => self.paint(element, circle(*centre, *radius)),
            Shape::Words(words) => self.paint(element, words.outline()),
            Shape::Image { image, cells, place } if image.width() > 0 && image.height() > 0 => {
                let number = self.images.len();
                self.images.push((image, *cells));
                // In a PDF images are one unit large, and y is up in them.
                let flip = DAffine2::from_cols(DVec2::X, DVec2::NEG_Y, DVec2::Y);
                self.transform(*place * flip);
                self.content.x_object(Name(format!("i{number}").as_bytes()));
            }
            Shape::Image { .. } => {}
        }
        self.content.restore_state();
    }

    fn set_colors(&mut self, fill: Option<Ink>, stroke: Option<Stroke>) {
        let opacities = [fill, stroke.map(|stroke| stroke.ink)]
            .map(|ink| ink.map_or(1.0, |ink| ink.opacity.clamp(0.0, 1.0)));
        if opacities != [1.0, 1.0] {
            let known = self.opacities.iter().position(|known| *known == opacities);
            let number = known.unwrap_or(self.opacities.len());
            if known.is_none() {
                self.opacities.push(opacities);
            }
            self.content.set_parameters(Name(format!("o{number}").as_bytes()));
        }
        let shares = |ink: Ink| ink.rgb.map(|code| f32::from(code) / 255.0);
        if let Some([r, g, b]) = fill.map(shares) {
            self.content.set_fill_rgb(r, g, b);
        }
        if let Some(stroke) = stroke {
            let [r, g, b] = shares(stroke.ink);
            self.content.set_stroke_rgb(r, g, b).set_line_width(stroke.width as f32);
            self.content.set_line_join(LineJoinStyle::RoundJoin);
            if let Some(dash) = stroke.dash {
                self.content.set_dash_pattern(dash.map(|length| length as f32), 0.0);
            }
        }
    }

    /// Paints a path with what has been called on its element.
    fn paint(&mut self, element: &Element, pieces: impl IntoIterator<Item = Piece>) {
        self.path(pieces);
        let content = &mut self.content;
        let even_odd = matches!(element.shape, Shape::Area(_));
        match (element.fill.is_some(), element.stroke.is_some(), even_odd) {
            (true, true, true) => content.fill_even_odd_and_stroke(),
            (true, true, false) => content.fill_nonzero_and_stroke(),
            (true, false, true) => content.fill_even_odd(),
            (true, false, false) => content.fill_nonzero(),
            (false, true, _) => content.stroke(),
            (false, false, _) => content.end_path(),
        };
    }

    fn path(&mut self, pieces: impl IntoIterator<Item = Piece>) {
        let content = &mut self.content;
        let mut pen = DVec2::ZERO;
        for piece in pieces {
            let curve = match piece {
                Piece::Close => [pen; 3],
                Piece::Move(p) | Piece::Line(p) => [p; 3],
                // The cubic curve that is the quadratic one.
                Piece::Quadratic(a, p) => [pen.lerp(a, 2.0 / 3.0), p.lerp(a, 2.0 / 3.0), p],
                Piece::Cubic(a, b, p) => [a, b, p],
            };
            pen = curve[2];
            let [a, b, p] = curve.map(DVec2::as_vec2);
            match piece {
                Piece::Close => content.close_path(),
                Piece::Move(_) => content.move_to(p.x, p.y),
                Piece::Line(_) => content.line_to(p.x, p.y),
                _ => content.cubic_to(a.x, a.y, b.x, b.y, p.x, p.y),
            };
        }
    }
}

/// A circle of four curves.
fn circle(centre: DVec2, radius: f64) -> impl Iterator<Item = Piece> {
    let quarters = (0..4).map(move |quarter| {
        let from = DVec2::X.rotate(DVec2::from_angle(f64::from(quarter) * FRAC_PI_2));
        let to = from.perp();
        let [a, b, p] =
            [from + QUARTER * to, to + QUARTER * from, to].map(|point| centre + radius * point);
        Piece::Cubic(a, b, p)
    });
    [Piece::Move(centre + DVec2::X * radius)].into_iter().chain(quarters).chain([Piece::Close])
}
