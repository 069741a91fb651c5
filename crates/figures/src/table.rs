//! Tables of words and pictures.

use super::axes::Frame;
use super::color_bar::ColorBar;
use super::drawing::{Drawing, Face, INK, LINE, Words};
use super::scalar_map::ScalarMap;
use super::shrink::shrink;
use cloakroom::output::RgbImage;
use glam::DVec2;

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct TableRow {
    /// What it is about; printed in bold.
    pub title: String,
    /// What is said about it: a word for it, printed in bold, and what there is to say.
    pub words: Vec<(&'static str, String)>,
    /// The pictures beside the words.
    pub pictures: Vec<TablePicture>,
}

/// A picture in a table.
#[derive(Clone, Debug, PartialEq)]
pub enum TablePicture {
    /// With its colour bar, if it is a map.
    Picture(RgbImage, Option<ColorBar>),
    /// Words instead.
    Words(String),
}

impl TablePicture {
    /// A picture, shrunk to 320 x 240 pixels.
    #[must_use]
    pub fn new(image: &RgbImage) -> Self {
        Self::Picture(shrink(image, PICTURE.0, PICTURE.1), None)
    }

    /// A map with its colour bar, shrunk to 320 x 240 pixels; those words instead if no number of
    /// it is finite.
    #[must_use]
    pub fn of_map(map: &ScalarMap, instead: &str) -> Self {
        if map.bar.scale.range.is_none() {
            return Self::Words(instead.to_owned());
        }
        Self::Picture(shrink(&map.image, PICTURE.0, PICTURE.1), Some(map.bar.clone()))
    }

    /// The size of the picture itself.
    fn picture(&self) -> DVec2 {
        let (width, height) = match self {
            Self::Picture(image, _) => image.dimensions(),
            Self::Words(_) => PICTURE,
        };
        DVec2::new(f64::from(width), f64::from(height))
    }

    /// The size that it takes up with its colour bar.
    fn size(&self) -> DVec2 {
        let size = self.picture();
        let Self::Picture(_, Some(bar)) = self else { return size };
        let height = size.y.max(LEAST_BAR);
        DVec2::new((size.x + GAP + bar.width(height, BAR_TEXT)).ceil(), height)
    }

    fn draw(&self, drawing: &mut Drawing, at: DVec2) {
        let size = self.picture();
        match self {
            Self::Picture(image, bar) => {
                drawing.add_framed(image.clone(), bar.is_some(), at, RULE);
                if let Some(bar) = bar {
                    bar.draw(drawing, at + DVec2::X * (size.x + GAP), self.size().y, BAR_TEXT);
                }
            }
            Self::Words(words) => {
                let frame = Frame { corner: at, size, text: TEXT };
                frame.draw(drawing);
                let lines = Face::Regular.wrap(words, TEXT, size.x - 2.0 * GAP);
                let top = frame.place(DVec2::splat(0.5)).y
                    - 0.5 * LINE * TEXT * (lines.len() as f64 - 1.0);
                let at = DVec2::new(at.x + 0.5 * size.x, top);
                drawing.add_lines("words", (Face::Regular, TEXT), (at, 0.5), &lines);
            }
        }
    }
}

/// The largest pictures, in pixels, which are the units of the sheet.
const PICTURE: (u32, u32) = (320, 240);
/// The size of the type, and of that at colour bars and of the title.
const TEXT: f64 = 18.0;
const BAR_TEXT: f64 = 14.0;
const TITLE: f64 = 36.0;
/// The size of the type that would be one of 8 points: a table is as large as a poster.
const PRINT: f64 = 28.0;
/// The least height of a colour bar, which leaves room for ticks.
const LEAST_BAR: f64 = 7.0 * BAR_TEXT;
/// The width of the words.
const WORDS: f64 = 330.0;
/// The space between a picture and its colour bar, and above and below rules.
const GAP: f64 = 10.0;
/// The thickness of rules and frames.
const RULE: f64 = 1.0;
/// The space around everything.
const MARGIN: f64 = 40.0;
/// Tables of more rows than this stand in two halves beside each other.
const MOST_ROWS: usize = 8;

/// A table under its title, in two halves if it is long: in each row its title and what is said
/// about it, one under the other, and beside them the pictures.
#[must_use]
pub fn table(title: &str, rows: &[TableRow]) -> Drawing {
    let blocks: Vec<_> = rows.iter().map(lines).collect();
    let halves = if rows.len() > MOST_ROWS { 2 } else { 1 };
    let count = rows.len().div_ceil(halves).max(1);
    // The left edges of the columns of pictures in a half, and its width.
    let (mut columns, mut half) = (Vec::new(), WORDS);
    for column in 0..rows.iter().map(|row| row.pictures.len()).max().unwrap_or(0) {
        columns.push(half + TEXT);
        let pictures = rows.iter().filter_map(|row| row.pictures.get(column));
        half += TEXT + pictures.map(|picture| picture.size().x).fold(0.0, f64::max);
    }
    let mut heights = vec![0.0_f64; count.min(rows.len())];
    for (i, (row, block)) in rows.iter().zip(&blocks).enumerate() {
        let words = block.last().map_or(0.0, |(_, below)| below + LINE * TEXT);
        let pictures = row.pictures.iter().map(|picture| picture.size().y);
        heights[i % count] = heights[i % count].max(pictures.fold(words, f64::max).ceil());
    }
    let width = 2.0 * MARGIN + halves as f64 * half + (halves - 1) as f64 * MARGIN;
    let title = Face::Bold.wrap(title, TITLE, width - 2.0 * MARGIN);
    let first = MARGIN + (title.len() as f64 * LINE * TITLE).ceil() + GAP;
    let body: f64 = heights.iter().map(|height| height + 2.0 * GAP + RULE).sum();
    let size = DVec2::new(width, first + body + RULE + MARGIN).ceil();
    let mut drawing = Drawing::new(size, PRINT);
    let at = DVec2::new(MARGIN, MARGIN + 0.5 * TITLE);
    drawing.add_lines("title", (Face::Bold, TITLE), (at, 0.0), &title);
    for (number, (rows, blocks)) in (0..).zip(rows.chunks(count).zip(blocks.chunks(count))) {
        let mut at = DVec2::new(MARGIN + f64::from(number) * (half + MARGIN), first);
        for ((row, block), height) in rows.iter().zip(blocks).zip(&heights) {
            add_rule(&mut drawing, at, half);
            at.y += RULE + GAP;
            for (runs, below) in block {
                let at = at + DVec2::Y * (0.5 * TEXT + below);
                let words = Words::of_runs(runs.clone(), at, TEXT);
                drawing.add_words("words", words.anchored(0.0));
            }
            for (picture, column) in row.pictures.iter().zip(&columns) {
                picture.draw(&mut drawing, at + DVec2::X * *column);
            }
            at.y += height + GAP;
        }
        add_rule(&mut drawing, at, half);
    }
    drawing
}

fn add_rule(drawing: &mut Drawing, at: DVec2, width: f64) {
    let from = at + DVec2::Y * 0.5 * RULE;
    drawing.add_line("rule", [from, from + DVec2::X * width], (INK, RULE));
}

/// The words of a row, broken into lines: each in pieces of one face, and how far it is below the
/// first.
fn lines(row: &TableRow) -> Vec<(Vec<(Face, String)>, f64)> {
    let mut lines = Vec::new();
    let mut below = 0.0;
    for line in Face::Bold.wrap(&row.title, TEXT, WORDS) {
        lines.push((vec![(Face::Bold, line)], below));
        below += LINE * TEXT;
    }
    for (name, words) in &row.words {
        below += 0.25 * TEXT;
        // Further lines stand in, and all leave room for the name, which is in the first.
        let indent = "  ";
        let name = if name.is_empty() { String::new() } else { format!("{name} ") };
        let taken = Face::Bold.width(&name, TEXT).max(Face::Bold.width(indent, TEXT));
        for (i, words) in Face::Regular.wrap(words, TEXT, WORDS - taken).into_iter().enumerate() {
            let first = if i == 0 { name.as_str() } else { indent };
            let runs = vec![(Face::Bold, first.to_owned()), (Face::Regular, words)];
            lines.push((runs, below));
            below += LINE * TEXT;
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloakroom::output::{Channel, Picture, Samples};
    use cloakroom::scene::PictureSettings;
    use image::Rgb;

    fn table(title: &str, rows: &[TableRow]) -> RgbImage {
        let drawing = super::table(title, rows);
        drawing.to_image(drawing.pixels()).expect("an image")
    }

    /// A map of 160 x 120 pixels that are all of one colour but the first.
    fn map(first: f64, others: f64) -> ScalarMap {
        let mut numbers = vec![others; 160 * 120];
        numbers[0] = first;
        let channels =
            vec![Channel { name: "delivered".to_owned(), samples: Samples::F64(numbers) }];
        let picture = Picture { width: 160, height: 120, channels, metadata: Vec::new() };
        ScalarMap::new(&picture, "delivered", &PictureSettings::default()).expect("a map")
    }

    fn row(title: &str, color: u8) -> TableRow {
        let image = RgbImage::from_pixel(160, 120, Rgb([0, 0, color]));
        TableRow {
            title: title.to_owned(),
            words: vec![("Map:", "conformal".to_owned()), ("", "a reference".to_owned())],
            pictures: vec![TablePicture::new(&image), TablePicture::of_map(&map(0.0, 1.0), "")],
        }
    }

    /// Where the first pixel of a colour is.
    fn first(table: &RgbImage, color: u8) -> Option<(u32, u32)> {
        let pixel = table.enumerate_pixels().find(|pixel| *pixel.2 == Rgb([0, 0, color]));
        pixel.map(|(x, y, _)| (x, y))
    }

    #[test]
    fn every_picture_is_there_in_its_row() {
        let drawn = table("All of them", &[row("sphere", 200), row("slab", 100)]);
        for color in [200, 100] {
            let count = drawn.pixels().filter(|pixel| **pixel == Rgb([0, 0, color])).count();
            assert_eq!(count, 160 * 120);
        }
        // The maps: their pixels, and those of their bars.
        let most = map(0.0, 1.0).bar.scale.color(1.0);
        let count = drawn.pixels().filter(|pixel| **pixel == most).count();
        assert!(count >= 2 * (160 * 120 - 1), "{count}");
        assert!(first(&drawn, 200).map(|at| at.1) < first(&drawn, 100).map(|at| at.1));
        assert_eq!(first(&drawn, 200).map(|at| at.0), first(&drawn, 100).map(|at| at.0));
    }

    #[test]
    fn long_tables_stand_in_two_halves() {
        let rows: Vec<TableRow> = (0..11).map(|i| row("a ball", 100 + i)).collect();
        let drawn = table("Many", &rows);
        assert!(drawn.width() > 2 * table("One", &rows[..1]).width() - 3 * MARGIN as u32);
        let at: Vec<_> = (0..11).map(|i| first(&drawn, 100 + i).expect("a picture")).collect();
        // Six on the left, five on the right, each beside one on the left.
        for i in 0..5 {
            assert!(at[i].0 < at[i + 6].0 && at[i].1 == at[i + 6].1);
            assert!(at[i].1 < at[i + 1].1 && at[i].0 == at[i + 1].0);
        }
    }

    #[test]
    fn many_words_make_a_row_higher() {
        let short = table("", &[row("short", 1)]);
        let long = table("", &[row(&"many words ".repeat(40), 1)]);
        assert!(long.height() > short.height() && long.width() == short.width());
    }

    #[test]
    fn words_keep_to_their_column() {
        let words = (1..12)
            .flat_map(|n| [("", n), ("A name:", n)])
            .map(|(name, n)| (name, format!("{} ", "x".repeat(n)).repeat(60)));
        let row = TableRow {
            words: words.collect(),
            ..row("w ww www wwww wwwww ".repeat(9).as_str(), 1)
        };
        for (runs, _) in lines(&row) {
            let words = Words::of_runs(runs, DVec2::ZERO, TEXT);
            assert!(words.width() <= WORDS, "{words:?}");
        }
    }

    #[test]
    fn large_pictures_are_shrunk() {
        let image = RgbImage::from_pixel(4096, 64, Rgb([9, 9, 9]));
        let picture = TablePicture::new(&image);
        assert_eq!(picture.size(), DVec2::new(320.0, 5.0));
    }

    #[test]
    fn words_stand_where_there_is_no_number() {
        let picture = TablePicture::of_map(&map(f64::NAN, f64::NAN), "no light arrives");
        let row = TableRow { title: String::new(), words: Vec::new(), pictures: vec![picture] };
        let drawing = super::table("", &[row]);
        let words = |element: &super::super::Element| match &element.shape {
            super::super::Shape::Words(words) => Some(words.text()),
            _ => None,
        };
        let words: Vec<String> = drawing.elements.iter().filter_map(words).collect();
        assert_eq!(words, ["no light arrives"]);
        assert_eq!(drawing.of_class("color-bar").count(), 0);
    }

    #[test]
    fn odd_tables_do_no_harm() {
        assert!(table("", &[]).width() > 0);
        let bare = TableRow { title: String::new(), words: Vec::new(), pictures: Vec::new() };
        let nothing = TablePicture::new(&RgbImage::new(0, 0));
        let ragged = TableRow { pictures: vec![nothing; 3], ..bare.clone() };
        assert!(table(&"a long title ".repeat(50), &[bare, ragged]).height() > 0);
    }
}
