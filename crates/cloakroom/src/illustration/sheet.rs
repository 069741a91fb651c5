//! Labelled sheets of panels, like the figures of a paper.

use super::color_bar::ColorBar;
use super::lettering::{Lettering, Weight};
use super::shrink::shrink;
use super::{INK, PAPER, frame, line_width, text_height};
use crate::output::RgbImage;

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

/// The narrowest column in heights of the text, so that captions have room.
const MIN_COLUMN: u32 = 12;

/// Where everything is on a sheet, in pixels.
struct Grid {
    /// The height of the text.
    text: u32,
    /// The left edge of each column.
    columns: Vec<u32>,
    /// The size of the panels' cells.
    cell: (u32, u32),
    /// The width of the sheet.
    width: u32,
}

/// A labelled sheet: the title, and below it the panels in two columns (one if there is one panel), each
/// with its colour bar beside it and its label and caption under it.
///
/// Panels should be of one size; smaller ones stand in the middle of their place. Panels wider than
/// 800 or higher than 1200 pixels are shrunk. Lettering and margins grow with the panels.
#[must_use]
pub fn sheet(title: &str, panels: &[SheetPanel]) -> RgbImage {
    let images: Vec<RgbImage> =
        panels.iter().map(|panel| shrink(&panel.image, MAX_PANEL.0, MAX_PANEL.1)).collect();
    let grid = Grid::new(panels, &images);
    let text = grid.text;
    let heading = Lettering::new(text * 5 / 4, Weight::Bold);
    let heading_lines = heading.wrap(title, grid.width - 2 * grid.margin());
    let captions: Vec<Caption> =
        panels.iter().map(|panel| Caption::new(panel, text, grid.cell.0)).collect();

    let mut bottom = grid.margin();
    if !heading_lines.is_empty() {
        bottom += heading_lines.len() as u32 * heading.height() + text;
    }
    // The top of each row of panels.
    let mut rows = Vec::new();
    for row in captions.chunks(grid.columns.len()) {
        rows.push(bottom);
        let lines = row.iter().map(Caption::lines).max().unwrap_or(0);
        bottom += grid.cell.1 + grid.caption_gap() + lines * text + grid.row_gap();
    }
    if !rows.is_empty() {
        bottom -= grid.row_gap();
    }

    let mut canvas = RgbImage::from_pixel(grid.width, bottom + grid.margin(), PAPER);
    for (i, line) in heading_lines.iter().enumerate() {
        let top = i64::from(grid.margin() + i as u32 * heading.height());
        heading.draw(&mut canvas, i64::from(grid.margin()), top, INK, line);
    }
    for (i, ((panel, image), caption)) in panels.iter().zip(&images).zip(&captions).enumerate() {
        let left = grid.columns[i % grid.columns.len()];
        let top = rows[i / grid.columns.len()];
        let (width, height) = grid.cell;
        let x = left + (width - image.width()) / 2;
        let y = top + (height - image.height()) / 2;
        frame(&mut canvas, image, x, y, line_width(text));
        if let Some(bar) = &panel.bar {
            bar.draw(&mut canvas, left + width + text, top, height, text);
        }
        caption.draw(&mut canvas, left, top + height + grid.caption_gap());
    }
    canvas
}

impl Grid {
    fn new(panels: &[SheetPanel], images: &[RgbImage]) -> Self {
        let width = images.iter().map(RgbImage::width).max().unwrap_or(0);
        let height = images.iter().map(RgbImage::height).max().unwrap_or(0);
        let text = Lettering::new(text_height(width, height), Weight::Regular).height();
        let cell = (width.max(MIN_COLUMN * text), height.max(2 * text));
        let mut grid = Self { text, columns: Vec::new(), cell, width: 0 };
        let count = if panels.len() > 1 { 2 } else { 1 };
        let mut left = grid.margin();
        for column in 0..count {
            grid.columns.push(left);
            let bars = panels.iter().skip(column).step_by(count).filter_map(|p| p.bar.as_ref());
            let room = bars.map(|bar| text + bar.width(cell.1, text)).max().unwrap_or(0);
            grid.width = left + cell.0 + room + grid.margin();
            left += cell.0 + room + 3 * text / 2;
        }
        grid
    }

    /// The space around everything.
    fn margin(&self) -> u32 {
        3 * self.text / 2
    }

    /// The space between a panel and its caption.
    fn caption_gap(&self) -> u32 {
        self.text / 2
    }

    /// The space between a caption and the next row of panels.
    fn row_gap(&self) -> u32 {
        5 * self.text / 4
    }
}

/// A label with what follows it, broken into lines.
struct Caption<'a> {
    label: &'a str,
    bold: Lettering,
    regular: Lettering,
    /// How far the lines stand in from the label.
    indent: u32,
    words: Vec<String>,
}

impl<'a> Caption<'a> {
    fn new(panel: &'a SheetPanel, text: u32, width: u32) -> Self {
        let bold = Lettering::new(text, Weight::Bold);
        let regular = Lettering::new(text, Weight::Regular);
        let label = panel.label.trim();
        let indent = if label.is_empty() { 0 } else { bold.width(label) + text / 2 };
        let words = regular.wrap(&panel.caption, width.saturating_sub(indent));
        Self { label, bold, regular, indent, words }
    }

    /// How many lines it takes.
    fn lines(&self) -> u32 {
        self.words.len().max(usize::from(!self.label.is_empty())) as u32
    }

    fn draw(&self, canvas: &mut RgbImage, left: u32, top: u32) {
        let (x, mut y) = (i64::from(left), i64::from(top));
        self.bold.draw(canvas, x, y, INK, self.label);
        for line in &self.words {
            self.regular.draw(canvas, x + i64::from(self.indent), y, INK, line);
            y += i64::from(self.regular.height());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ColorScale, Quantity};
    use super::*;
    use image::Rgb;

    const BLUE: Rgb<u8> = Rgb([0, 0, 255]);

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
        assert!(sheet.width() < 1800);
    }

    #[test]
    fn odd_sheets_do_no_harm() {
        assert!(sheet("", &[]).width() > 0);
        assert!(sheet("a title longer than the sheet is wide", &[]).height() > 0);
        let odd = SheetPanel { label: "a very long label".repeat(9), ..panel(0, 0, true) };
        assert!(sheet("odd", &[odd, panel(1, 300, true), panel(300, 1, false)]).width() > 300);
    }
}
