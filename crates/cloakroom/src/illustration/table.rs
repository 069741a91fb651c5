//! Tables of words and pictures.

use super::color_bar::ColorBar;
use super::lettering::{Lettering, Weight};
use super::scalar_map::ScalarMap;
use super::shrink::shrink;
use super::{INK, PAPER, fill, frame, line_width};
use crate::output::RgbImage;

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
pub struct TablePicture {
    image: RgbImage,
    bar: Option<ColorBar>,
}

impl TablePicture {
    /// A picture, shrunk to 320 x 240 pixels.
    #[must_use]
    pub fn new(image: &RgbImage) -> Self {
        Self { image: shrink(image, PICTURE.0, PICTURE.1), bar: None }
    }

    /// A map with its colour bar, shrunk to 320 x 240 pixels; those words instead if no number of it
    /// is finite.
    #[must_use]
    pub fn of_map(map: &ScalarMap, instead: &str) -> Self {
        match map.range() {
            Some(_) => Self { bar: Some(map.bar.clone()), ..Self::new(&map.image) },
            None => Self::of_words(instead),
        }
    }

    /// Words in the place of a picture.
    #[must_use]
    pub fn of_words(words: &str) -> Self {
        let letters = Lettering::new(TEXT, Weight::Regular);
        let mut image = RgbImage::from_pixel(PICTURE.0, PICTURE.1, PAPER);
        let lines = letters.wrap(words, PICTURE.0 - 2 * GAP);
        let above = (i64::from(PICTURE.1) - lines.len() as i64 * i64::from(TEXT)) / 2;
        for (i, line) in (0..).zip(&lines) {
            let left = i64::from(PICTURE.0 - letters.width(line)) / 2;
            letters.draw(&mut image, left, above + i * i64::from(TEXT), INK, line);
        }
        Self { image, bar: None }
    }

    /// The height that it takes up.
    fn height(&self) -> u32 {
        let least = if self.bar.is_some() { LEAST_BAR } else { 0 };
        self.image.height().max(least)
    }

    /// The width that it takes up.
    fn width(&self) -> u32 {
        let bar = self.bar.as_ref().map_or(0, |bar| GAP + bar.width(self.height(), BAR_TEXT));
        self.image.width() + bar
    }
}

/// The largest pictures, in pixels.
const PICTURE: (u32, u32) = (320, 240);
/// The height of the text, and of that at colour bars.
const TEXT: u32 = 20;
const BAR_TEXT: u32 = 16;
/// The least height of a colour bar, which leaves room for ticks.
const LEAST_BAR: u32 = 6 * BAR_TEXT;
/// The width of the words, in letters.
const LETTERS: u32 = 33;
/// The space between a picture and its colour bar, and above and below rules.
const GAP: u32 = TEXT / 2;
/// The space around everything.
const MARGIN: u32 = 2 * TEXT;
/// Tables of more rows than this stand in two halves beside each other.
const MOST_ROWS: usize = 8;

/// Where everything is, in pixels.
struct Grid {
    /// The left edges of the columns of pictures in a half, and the width of the half.
    columns: Vec<u32>,
    half: u32,
    /// How many rows a half has, and their heights.
    heights: Vec<u32>,
    /// How many halves there are.
    halves: u32,
}

/// A table under its title, in two halves if it is long: in each row its title and what is said about it, one
/// under the other, and beside them the pictures.
#[must_use]
pub fn table(title: &str, rows: &[TableRow]) -> RgbImage {
    let blocks: Vec<Vec<Line>> = rows.iter().map(lines).collect();
    let grid = Grid::new(rows, &blocks);
    let heading = Lettering::new(2 * TEXT, Weight::Bold);
    let width = 2 * MARGIN + grid.halves * grid.half + (grid.halves - 1) * MARGIN;
    let title = heading.wrap(title, width - 2 * MARGIN);
    let first = MARGIN + title.len() as u32 * heading.height() + GAP;
    let rule = line_width(2 * TEXT);
    let body: u32 = grid.heights.iter().map(|height| height + 2 * GAP + rule).sum();
    let mut canvas = RgbImage::from_pixel(width, first + body + rule + MARGIN, PAPER);
    for (i, words) in title.iter().enumerate() {
        let top = i64::from(MARGIN + i as u32 * heading.height());
        heading.draw(&mut canvas, i64::from(MARGIN), top, INK, words);
    }
    let count = grid.heights.len().max(1);
    for (half, rows) in (0..).zip(rows.chunks(count).zip(blocks.chunks(count))) {
        let left = MARGIN + half * (grid.half + MARGIN);
        let mut top = first;
        for ((row, block), height) in rows.0.iter().zip(rows.1).zip(&grid.heights) {
            fill(&mut canvas, i64::from(left), i64::from(top), grid.half, rule, INK);
            top += rule + GAP;
            draw_row(&mut canvas, (left, top), &grid.columns, row, block);
            top += height + GAP;
        }
        fill(&mut canvas, i64::from(left), i64::from(top), grid.half, rule, INK);
    }
    canvas
}

fn draw_row(
    canvas: &mut RgbImage,
    (left, top): (u32, u32),
    columns: &[u32],
    row: &TableRow,
    block: &[Line],
) {
    let mut y = i64::from(top);
    for line in block {
        let mut x = i64::from(left);
        for (weight, words) in &line.runs {
            let letters = Lettering::new(TEXT, *weight);
            letters.draw(canvas, x, y, INK, words);
            x += i64::from(letters.width(words));
        }
        y += i64::from(TEXT) + i64::from(line.gap);
    }
    for (picture, column) in row.pictures.iter().zip(columns) {
        let left = left + column;
        frame(canvas, &picture.image, left, top, 1);
        if let Some(bar) = &picture.bar {
            let left = left + picture.image.width() + GAP;
            bar.draw(canvas, left, top, picture.height(), BAR_TEXT);
        }
    }
}

impl Grid {
    fn new(rows: &[TableRow], blocks: &[Vec<Line>]) -> Self {
        let halves = if rows.len() > MOST_ROWS { 2 } else { 1 };
        let count = rows.len().div_ceil(halves);
        let mut heights = vec![0; count];
        for (i, (row, block)) in rows.iter().zip(blocks).enumerate() {
            let words: u32 = block.iter().map(|line| TEXT + line.gap).sum();
            let pictures = row.pictures.iter().map(TablePicture::height).max().unwrap_or(0);
            heights[i % count] = heights[i % count].max(words).max(pictures);
        }
        let mut half = Lettering::new(TEXT, Weight::Regular).width("m") * LETTERS;
        let mut columns = Vec::new();
        let most = rows.iter().map(|row| row.pictures.len()).max().unwrap_or(0);
        for column in 0..most {
            columns.push(half + TEXT);
            let pictures = rows.iter().filter_map(|row| row.pictures.get(column));
            half += TEXT + pictures.map(TablePicture::width).max().unwrap_or(0);
        }
        Self { columns, half, heights, halves: halves as u32 }
    }
}

/// A line of a row's words.
struct Line {
    runs: Vec<(Weight, String)>,
    /// The space below it.
    gap: u32,
}

/// The words of a row, broken into lines.
fn lines(row: &TableRow) -> Vec<Line> {
    let [bold, regular] =
        [Weight::Bold, Weight::Regular].map(|weight| Lettering::new(TEXT, weight));
    let room = regular.width("m") * LETTERS;
    let single = |weight, words| Line { runs: vec![(weight, words)], gap: 0 };
    let mut lines: Vec<Line> =
        bold.wrap(&row.title, room).into_iter().map(|line| single(Weight::Bold, line)).collect();
    for (name, words) in &row.words {
        if let Some(last) = lines.last_mut() {
            last.gap = TEXT / 4;
        }
        // Further lines stand in, and all leave room for the name, which is in the first.
        let indent = "  ";
        let name = if name.is_empty() { String::new() } else { format!("{name} ") };
        let taken = bold.width(&name).max(regular.width(indent));
        for (i, words) in regular.wrap(words, room.saturating_sub(taken)).into_iter().enumerate() {
            let first = if i == 0 { name.as_str() } else { indent };
            let runs = vec![(Weight::Bold, first.to_owned()), (Weight::Regular, words)];
            lines.push(Line { runs, gap: 0 });
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{Channel, Picture, Samples};
    use image::Rgb;

    /// A map of 160 x 120 pixels that are all of one colour but the first.
    fn map(first: f64, others: f64) -> ScalarMap {
        let mut numbers = vec![others; 160 * 120];
        numbers[0] = first;
        let channels =
            vec![Channel { name: "delivered".to_owned(), samples: Samples::F64(numbers) }];
        let picture = Picture { width: 160, height: 120, channels, metadata: Vec::new() };
        ScalarMap::new(&picture, "delivered").expect("a map")
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
        assert!(drawn.width() > 2 * table("One", &rows[..1]).width() - 3 * MARGIN);
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
        let most = Lettering::new(TEXT, Weight::Regular).width("m") * LETTERS;
        for line in lines(&row) {
            let width: u32 = line
                .runs
                .iter()
                .map(|(weight, text)| Lettering::new(TEXT, *weight).width(text))
                .sum();
            assert!(width <= most, "{:?}", line.runs);
        }
    }

    #[test]
    fn large_pictures_are_shrunk() {
        let image = RgbImage::from_pixel(4096, 64, Rgb([9, 9, 9]));
        let picture = TablePicture::new(&image);
        assert_eq!(picture.image.dimensions(), (320, 5));
    }

    #[test]
    fn words_stand_where_there_is_no_number() {
        let picture = TablePicture::of_map(&map(f64::NAN, f64::NAN), "no light arrives");
        assert_eq!((picture.image.dimensions(), &picture.bar), (PICTURE, &None));
        let inked = picture.image.pixels().filter(|pixel| **pixel != PAPER).count();
        assert!(inked > 100 && inked < 6000, "{inked}");
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
