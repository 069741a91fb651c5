//! Lettering: lines of text in Noto Sans Mono, antialiased onto any background.
//!
//! The font comes rasterized in heights of 16, 20, 24 and 32 pixels; these are used as they are, and
//! larger text is enlarged from the largest of them. Text is printed in ASCII and Latin-1, with the
//! minus sign and dashes; other characters are spelled with those where there is a usual way, and
//! appear as question marks otherwise.

use crate::output::RgbImage;
use image::imageops::{self, FilterType};
use image::{GrayImage, Luma, Rgb};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// How bold letters are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// For running text.
    Regular,
    /// For titles and labels.
    Bold,
}

/// Letters of one size and weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lettering {
    raster: RasterHeight,
    height: u32,
    weight: FontWeight,
}

/// The rasters of the font, from small to large.
const RASTERS: [RasterHeight; 4] =
    [RasterHeight::Size16, RasterHeight::Size20, RasterHeight::Size24, RasterHeight::Size32];

/// The largest lines, in pixels: those of a picture of the largest size.
const MAX_HEIGHT: u32 = 2048;

/// The minus sign, which the font lacks.
const MINUS: char = '\u{2212}';

impl Lettering {
    /// Letters for lines of about that many pixels in height: from 32 on exactly that many, below
    /// the next smaller height in which the font is there, at least 16 and at most 2048.
    #[must_use]
    pub fn new(line_height: u32, weight: Weight) -> Self {
        let line_height = line_height.min(MAX_HEIGHT);
        let raster = RASTERS
            .into_iter()
            .rfind(|raster| raster.val() as u32 <= line_height)
            .unwrap_or(RasterHeight::Size16);
        let height = match raster {
            RasterHeight::Size32 => line_height,
            smaller => smaller.val() as u32,
        };
        let weight = match weight {
            Weight::Regular => FontWeight::Regular,
            Weight::Bold => FontWeight::Bold,
        };
        Self { raster, height, weight }
    }

    /// The height of a line in pixels, which is the distance between lines.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The width of a text on one line in pixels.
    #[must_use]
    pub fn width(&self, text: &str) -> u32 {
        self.scaled(spell(text).chars().count() as u32 * self.raster_width())
    }

    /// Writes a line whose box has its top left corner at `(left, top)`; what lies beside the canvas
    /// is left out.
    pub fn draw(&self, canvas: &mut RgbImage, left: i64, top: i64, color: Rgb<u8>, text: &str) {
        blend(canvas, &self.coverage(text), left, top, color);
    }

    /// Writes a line that runs upwards, its box as high as the text is wide, with its top left corner
    /// at `(left, top)`.
    pub fn draw_upwards(
        &self,
        canvas: &mut RgbImage,
        left: i64,
        top: i64,
        color: Rgb<u8>,
        text: &str,
    ) {
        blend(canvas, &imageops::rotate270(&self.coverage(text)), left, top, color);
    }

    /// Breaks a text into lines of at most that many pixels, between words where it can; there is
    /// always room for one character.
    #[must_use]
    pub fn wrap(&self, text: &str, width: u32) -> Vec<String> {
        let raster = u64::from(self.raster_width()) * u64::from(self.height);
        let room = (u64::from(width) * self.raster.val() as u64 / raster).max(1) as usize;
        let mut lines: Vec<String> = Vec::new();
        let mut line = String::new();
        let mut used = 0;
        for word in spell(text).split_whitespace() {
            let mut rest: Vec<char> = word.chars().collect();
            if used > 0 && used + 1 + rest.len() <= room {
                line.push(' ');
                used += 1;
            } else if used > 0 {
                lines.push(std::mem::take(&mut line));
                used = 0;
            }
            while rest.len() > room {
                let tail = rest.split_off(room);
                lines.push(rest.into_iter().collect());
                rest = tail;
            }
            used += rest.len();
            line.extend(rest);
        }
        if !line.is_empty() {
            lines.push(line);
        }
        lines
    }

    /// The advance from character to character in the font's raster.
    fn raster_width(&self) -> u32 {
        get_raster_width(self.weight, self.raster) as u32
    }

    /// A length in the font's raster as pixels.
    fn scaled(&self, length: u32) -> u32 {
        let raster = self.raster.val() as u64;
        ((u64::from(length) * u64::from(self.height) + raster / 2) / raster) as u32
    }

    /// How much of each pixel of a line its letters cover, 255 being all of it.
    fn coverage(&self, text: &str) -> GrayImage {
        let text = spell(text);
        let advance = self.raster_width();
        let width = text.chars().count() as u32 * advance;
        let mut line = GrayImage::new(width, self.raster.val() as u32);
        for (i, letter) in text.chars().enumerate() {
            for (y, row) in self.glyph(letter).chunks_exact(advance as usize).enumerate() {
                for (x, ink) in row.iter().enumerate() {
                    line.put_pixel(i as u32 * advance + x as u32, y as u32, Luma([*ink]));
                }
            }
        }
        if self.height == line.height() || width == 0 {
            return line;
        }
        let mut large =
            imageops::resize(&line, self.scaled(width), self.height, FilterType::CatmullRom);
        // Enlarging spreads the letters' edges over more pixels; draw them together again.
        let steepness = self.height as f32 / line.height() as f32;
        for Luma([ink]) in large.pixels_mut() {
            *ink = ((f32::from(*ink) - 127.5) * steepness + 127.5).round().clamp(0.0, 255.0) as u8;
        }
        large
    }

    /// The raster of a character, row by row.
    fn glyph(&self, letter: char) -> Vec<u8> {
        let find = |letter| get_raster(letter, self.weight, self.raster);
        if letter == MINUS {
            // A plus without its upright: the rows that have ink left of the middle.
            return find('+').map_or_else(Vec::new, |plus| {
                let side = plus.width() / 4;
                let is_bar = |row: &[u8]| row.get(side).is_some_and(|ink| *ink > 0);
                plus.rows()
                    .flat_map(|row| {
                        let bar = if is_bar(row) { row[side] } else { 0 };
                        row.iter().map(move |ink| *ink.min(&bar))
                    })
                    .collect()
            });
        }
        find(letter).or_else(|| find('?')).map_or_else(Vec::new, |raster| raster.pixels().to_vec())
    }
}

/// A text in characters that can be printed.
fn spell(text: &str) -> String {
    let mut spelled = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '\u{2010}' | '\u{2011}' => spelled.push('-'),
            '\u{2012}'..='\u{2015}' => spelled.push(MINUS),
            '\u{3bc}' => spelled.push('\u{b5}'),
            '\u{2018}' | '\u{2019}' | '\u{2032}' => spelled.push('\''),
            '\u{201c}' | '\u{201d}' | '\u{2033}' => spelled.push('"'),
            '\u{2026}' => spelled.push_str("..."),
            '\u{2264}' => spelled.push_str("<="),
            '\u{2265}' => spelled.push_str(">="),
            '\u{2248}' => spelled.push('~'),
            '\u{2192}' => spelled.push_str("->"),
            '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{feff}' | '\u{300}'..='\u{36f}' => {}
            space if space.is_whitespace() || space.is_control() => spelled.push(' '),
            other => spelled.push(other),
        }
    }
    spelled
}

/// Lays a colour over the canvas where letters cover it.
fn blend(canvas: &mut RgbImage, coverage: &GrayImage, left: i64, top: i64, color: Rgb<u8>) {
    for (x, y, Luma([ink])) in coverage.enumerate_pixels() {
        let (x, y) = (left + i64::from(x), top + i64::from(y));
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { continue };
        let Some(Rgb(under)) = canvas.get_pixel_mut_checked(x, y) else { continue };
        let ink = u32::from(*ink);
        for (below, above) in under.iter_mut().zip(color.0) {
            let mixed = u32::from(*below) * (255 - ink) + u32::from(above) * ink;
            *below = ((mixed + 127) / 255) as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLACK: Rgb<u8> = Rgb([0, 0, 0]);

    fn written(height: u32, text: &str) -> RgbImage {
        let letters = Lettering::new(height, Weight::Regular);
        let mut canvas =
            RgbImage::from_pixel(letters.width(text), letters.height(), Rgb([255, 255, 255]));
        letters.draw(&mut canvas, 0, 0, BLACK, text);
        canvas
    }

    #[test]
    fn sizes_are_those_of_the_font_or_larger() {
        let height = |wanted| Lettering::new(wanted, Weight::Bold).height();
        assert_eq!([0, 16, 19, 20, 31, 32, 33, 100].map(height), [16, 16, 16, 20, 24, 32, 33, 100]);
        assert_eq!(height(u32::MAX), 2048);
    }

    #[test]
    fn every_character_has_a_shape() {
        let unknown = Lettering::new(16, Weight::Regular).glyph('?');
        for weight in [Weight::Regular, Weight::Bold] {
            for height in [16, 20, 24, 32] {
                let letters = Lettering::new(height, weight);
                let shape = letters.glyph('?');
                for letter in ('!'..='~').chain(['°', 'µ', '×', '±', MINUS]) {
                    let glyph = letters.glyph(letter);
                    assert_eq!(glyph.len(), shape.len());
                    assert!(glyph.iter().any(|ink| *ink > 128), "{letter}");
                    assert!(letter == '?' || glyph != shape, "{letter}");
                }
            }
        }
        assert_eq!(Lettering::new(16, Weight::Regular).glyph('\u{4e00}'), unknown);
    }

    #[test]
    fn unusual_characters_are_spelled() {
        assert_eq!(spell("μ ≤ 3…\n“a”–b\u{ad}"), "µ <= 3... \"a\"−b");
        assert_eq!(written(16, "\u{4e00}"), written(16, "?"));
        assert_eq!(written(16, "").width(), 0);
        assert_eq!(written(90, "").width(), 0);
    }

    #[test]
    fn a_minus_is_the_bar_of_a_plus() {
        let minus = written(32, "−");
        let plus = written(32, "+");
        let ink = |image: &RgbImage| image.pixels().filter(|p| p.0[0] < 128).count();
        assert!(ink(&minus) > 10 && ink(&minus) < ink(&plus));
        assert!(minus.pixels().zip(plus.pixels()).all(|(m, p)| m.0[0] >= p.0[0]));
    }

    #[test]
    fn letters_have_soft_edges_on_any_ground() {
        let letters = Lettering::new(20, Weight::Regular);
        let mut canvas = RgbImage::from_pixel(20, 20, Rgb([0, 0, 200]));
        letters.draw(&mut canvas, 3, 0, Rgb([255, 255, 0]), "o");
        assert!(canvas.pixels().any(|p| p.0[0] > 40 && p.0[0] < 215));
        assert!(canvas.pixels().all(|p| p.0[0] == p.0[1] && p.0[2] <= 200));
    }

    #[test]
    fn lines_beside_the_canvas_are_cut() {
        let letters = Lettering::new(16, Weight::Bold);
        let mut canvas = RgbImage::new(5, 5);
        for (left, top) in [(-3, -4), (4, 4), (-1000, 0), (0, 1000)] {
            letters.draw(&mut canvas, left, top, BLACK, "cloak");
            letters.draw_upwards(&mut canvas, left, top, BLACK, "cloak");
        }
    }

    #[test]
    fn large_letters_keep_their_proportions_and_edges() {
        let (small, large) = (written(32, "Wg8"), written(96, "Wg8"));
        assert_eq!((large.width(), large.height()), (3 * small.width(), 96));
        let darkness = |image: &RgbImage| {
            let sum: f64 = image.pixels().map(|p| 1.0 - f64::from(p.0[0]) / 255.0).sum();
            sum / f64::from(image.width() * image.height())
        };
        assert!((darkness(&small) / darkness(&large) - 1.0).abs() < 0.1);
        let gray = large.pixels().filter(|p| p.0[0] > 20 && p.0[0] < 235).count();
        let black = large.pixels().filter(|p| p.0[0] <= 20).count();
        assert!(gray < black / 2, "{gray} gray pixels, {black} black ones");
    }

    #[test]
    fn words_are_wrapped() {
        let letters = Lettering::new(16, Weight::Regular);
        let wrap = |text: &str, letters_wide: u32| letters.wrap(text, 7 * letters_wide + 3);
        assert_eq!(wrap("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrap("a abcdefgh ij", 3), ["a", "abc", "def", "gh", "ij"]);
        assert_eq!(wrap("ab", 0), ["a", "b"]);
        assert!(wrap(" ", 9).is_empty());
    }
}
