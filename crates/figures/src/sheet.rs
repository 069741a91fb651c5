//! Labelled sheets of panels, like the figures of a paper.

use super::axes::Frame;
use super::color_bar::ColorBar;
use super::drawing::{Drawing, Face, LINE};
use super::shrink::shrink;
use super::type_size;
use cloakroom::output::RgbImage;
use glam::DVec2;

/// A panel of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetPanel {
    /// What it shows.
    pub image: RgbImage,
    /// What it is called, as in `(a)`; printed in bold.
    pub label: String,
    /// A few words that follow the label under the panel.
    pub caption: String,
    /// The colour bar to its right, if it is a map.
    pub bar: Option<ColorBar>,
}

/// Panels wider or higher than this many pixels are shrunk.
const MAX_PANEL: (u32, u32) = (800, 1200);

/// In type of size 1: the narrowest column, so that captions have room; the space around
/// everything; that between a panel and its caption; that between a caption and the next row of
/// panels; the size of the title.
const MIN_COLUMN: f64 = 16.0;
const MARGIN: f64 = 1.6;
const CAPTION_GAP: f64 = 0.5;
const ROW_GAP: f64 = 1.4;
const TITLE: f64 = 1.25;

/// A labelled sheet, a unit a pixel: the title, and below it the panels in two columns (one if
/// there is one panel), each with its colour bar beside it and its label and caption under it.
///
/// Panels should be of one size; smaller ones stand in the middle of their place. Panels wider than
/// 800 or higher than 1200 pixels are shrunk. Lettering and margins grow with the panels.
#[must_use]
pub fn sheet(title: &str, panels: &[SheetPanel]) -> Drawing {
    let images: Vec<RgbImage> =
        panels.iter().map(|panel| shrink(&panel.image, MAX_PANEL.0, MAX_PANEL.1)).collect();
    let width = images.iter().map(RgbImage::width).max().unwrap_or(0);
    let height = images.iter().map(RgbImage::height).max().unwrap_or(0);
    // On a page two columns of panels are narrow: their type is larger than that of a single map.
    let text = (1.4 * type_size(width, height)).round();
    let cell =
        DVec2::new(f64::from(width), f64::from(height)).max(DVec2::new(MIN_COLUMN, 2.0) * text);
    let (columns, width) = columns(panels, cell, text);
    let margin = (MARGIN * text).round();
    let title = Face::Bold.wrap(title, TITLE * text, width - 2.0 * margin);
    // How far captions stand in from their labels, and their lines.
    let caption = |panel: &SheetPanel| {
        let label = panel.label.trim();
        let indent =
            if label.is_empty() { 0.0 } else { Face::Bold.width(label, text) + 0.4 * text };
        (indent, Face::Regular.wrap(&panel.caption, text, cell.x - indent))
    };
    let captions: Vec<(f64, Vec<String>)> = panels.iter().map(caption).collect();

    let mut bottom = margin;
    if !title.is_empty() {
        bottom += ((title.len() as f64 * LINE * TITLE + 0.6) * text).round();
    }
    // The top of each row of panels.
    let mut rows = Vec::new();
    for row in captions.chunks(columns.len()) {
        rows.push(bottom);
        let lines = |(indent, words): &(f64, Vec<String>)| words.len().max((*indent > 0.0).into());
        let lines = row.iter().map(lines).max().unwrap_or(0);
        bottom += cell.y + ((CAPTION_GAP + LINE * lines as f64 + ROW_GAP) * text).round();
    }
    if !rows.is_empty() {
        bottom -= ROW_GAP * text;
    }
    let mut drawing = Drawing::new(DVec2::new(width, bottom + margin).ceil(), text);
    let title_at = DVec2::new(margin, margin + 0.5 * TITLE * text);
    drawing.add_lines("title", (Face::Bold, TITLE * text), (title_at, 0.0), &title);
    for (i, ((panel, image), (indent, words))) in
        panels.iter().zip(images).zip(&captions).enumerate()
    {
        let corner = DVec2::new(columns[i % columns.len()], rows[i / columns.len()]);
        let size = DVec2::new(f64::from(image.width()), f64::from(image.height()));
        let at = corner + ((cell - size) / 2.0).floor();
        drawing.add_framed(image, panel.bar.is_some(), at, Frame::thin(text).round().max(1.0));
        if let Some(bar) = &panel.bar {
            bar.draw(&mut drawing, corner + DVec2::X * (cell.x + text), cell.y, text);
        }
        let at = corner + DVec2::Y * (cell.y + (CAPTION_GAP + 0.5) * text);
        let label = vec![panel.label.trim().to_owned()];
        drawing.add_lines("label", (Face::Bold, text), (at, 0.0), &label);
        let at = at + DVec2::X * *indent;
        drawing.add_lines("caption", (Face::Regular, text), (at, 0.0), words);
    }
    drawing
}

/// The left edge of each column, and the width of the sheet.
fn columns(panels: &[SheetPanel], cell: DVec2, text: f64) -> (Vec<f64>, f64) {
    let count = if panels.len() > 1 { 2 } else { 1 };
    let margin = (MARGIN * text).round();
    let (mut columns, mut left, mut right) = (Vec::new(), margin, 0.0);
    for column in 0..count {
        columns.push(left);
        let bars = panels.iter().skip(column).step_by(count).filter_map(|p| p.bar.as_ref());
        let room = bars.map(|bar| (text + bar.width(cell.y, text)).ceil()).fold(0.0, f64::max);
        right = left + cell.x + room;
        left = (right + 1.5 * text).round();
    }
    (columns, right + margin)
}

#[cfg(test)]
mod tests {
    use super::super::{ColorScale, Quantity};
    use super::*;
    use image::Rgb;

    const BLUE: Rgb<u8> = Rgb([0, 0, 255]);

    fn sheet(title: &str, panels: &[SheetPanel]) -> RgbImage {
        let drawing = super::sheet(title, panels);
        drawing.to_image(drawing.pixels()).expect("an image")
    }

    fn panel(width: u32, height: u32, bar: bool) -> SheetPanel {
        SheetPanel {
            image: RgbImage::from_pixel(width, height, BLUE),
            label: "(a)".to_owned(),
            caption: "a square cloak turned by 5° about its axis, behind it a photograph"
                .to_owned(),
            bar: bar.then(|| ColorBar {
                scale: ColorScale::new([-1e-15, 1e-15].into_iter(), 0.0),
                quantity: Quantity::of_channel("time_of_flight_difference"),
            }),
        }
    }

    /// The columns and the rows in which panels begin.
    fn corners(sheet: &RgbImage) -> (Vec<u32>, Vec<u32>) {
        let is_blue = |x: u32, y: u32| *sheet.get_pixel(x, y) == BLUE;
        let corners: Vec<(u32, u32)> = (1..sheet.height())
            .flat_map(|y| (1..sheet.width()).map(move |x| (x, y)))
            .filter(|(x, y)| is_blue(*x, *y) && !is_blue(x - 1, *y) && !is_blue(*x, y - 1))
            .collect();
        let mut columns: Vec<u32> = corners.iter().map(|corner| corner.0).collect();
        let mut rows: Vec<u32> = corners.iter().map(|corner| corner.1).collect();
        columns.sort_unstable();
        columns.dedup();
        rows.sort_unstable();
        rows.dedup();
        (columns, rows)
    }

    #[test]
    fn panels_stand_in_two_columns() {
        let panels: Vec<SheetPanel> = (0..5).map(|i| panel(320, 240, i == 3)).collect();
        let sheet = sheet("Figure 6. A cloak", &panels);
        let (columns, rows) = corners(&sheet);
        assert_eq!((columns.len(), rows.len()), (2, 3));
        assert_eq!(rows[1] - rows[0], rows[2] - rows[1]);
        let blue = sheet.pixels().filter(|pixel| **pixel == BLUE).count();
        assert_eq!(blue, 5 * 320 * 240);
    }

    #[test]
    fn a_bar_in_the_left_column_moves_the_right_one() {
        let plain = sheet("", &[panel(320, 240, false), panel(320, 240, false)]);
        let left = sheet("", &[panel(320, 240, true), panel(320, 240, false)]);
        let right = sheet("", &[panel(320, 240, false), panel(320, 240, true)]);
        assert_eq!(left.dimensions(), right.dimensions());
        assert!(right.width() > plain.width());
        assert_eq!(right.height(), plain.height());
        assert_eq!(corners(&plain), corners(&right));
        let distance = |sheet: &RgbImage| {
            let columns = corners(sheet).0;
            columns[1] - columns[0]
        };
        assert_eq!(distance(&left) - distance(&plain), left.width() - plain.width());
    }

    #[test]
    fn one_panel_has_one_column() {
        let sheet = sheet("One", &[panel(640, 480, true)]);
        assert_eq!(corners(&sheet).0.len(), 1);
        assert!(sheet.width() < 2 * 640);
    }

    #[test]
    fn large_panels_are_shrunk() {
        let sheet = sheet("Large", &[panel(4096, 64, false), panel(4096, 64, false)]);
        assert!(sheet.width() < 1800, "{}", sheet.width());
    }

    #[test]
    fn odd_sheets_do_no_harm() {
        assert!(sheet("", &[]).width() > 0);
        assert!(sheet("a title longer than the sheet is wide", &[]).height() > 0);
        let odd = SheetPanel { label: "a very long label".repeat(9), ..panel(0, 0, true) };
        assert!(sheet("odd", &[odd, panel(1, 300, true), panel(300, 1, false)]).width() > 300);
    }
}
